//! Impact zones: sets of particles that collide with one another (collisions.md 5.4).
use std::collections::{BTreeMap, BTreeSet};

use super::{
    Area, Mistake,
    author::Student,
    objects::{Contact, Object, Zone},
    world::World,
};

/// The areas of the assignment whose mistakes this module simulates.
const MODULE_AREAS: &[Area] = &[Area::ImpactZones];

/// Returns the zone of one contact.
pub fn contact_zone(world: &World, contact: &Contact) -> Zone {
    let (student, particle_count) = (world.student, world.scene.particles.len());
    let one = contact.pair.particle;
    let mut particles = BTreeSet::from([one]);
    let mut half_plane = false;
    match contact.pair.object {
        Object::Particle(other) => particles.extend([other]),
        Object::Edge(index) => {
            let edge = world.scene.edges[index];
            match student.mistake_in(MODULE_AREAS) {
                Some(Mistake::ZonesOneEndpoint) => particles.extend([edge.first]),
                Some(Mistake::ZonesOtherEndpoint) => particles.extend([edge.second]),
                Some(Mistake::ZonesNextParticle) => {
                    particles.extend([edge.first, (edge.first + 1).min(particle_count - 1)])
                }
                Some(Mistake::ZonesEdgeIndex) => particles.extend([index.min(particle_count - 1)]),
                Some(Mistake::ZonesEdgeWithoutParticle) => particles = BTreeSet::from([edge.first, edge.second]),
                _ => particles.extend([edge.first, edge.second]),
            }
            half_plane = student.makes(Mistake::ZonesFlagOfEdges);
        }
        Object::HalfPlane(index) => {
            half_plane = !student.makes(Mistake::ZonesNoHalfPlaneFlag);
            particles.extend(student.makes(Mistake::ZonesHalfPlaneIndex).then_some(index.min(particle_count - 1)));
        }
    }
    half_plane ^= student.makes(Mistake::ZonesFlagInverted) && !matches!(contact.pair.object, Object::Edge(_));
    Zone { particles, has_half_plane: half_plane }
}

/// Returns the zones after joining those that share a particle, until no two zones share one.
pub fn merge(student: Student, zones: Vec<Zone>) -> Vec<Zone> {
    match student.mistake_in(MODULE_AREAS) {
        Some(Mistake::ZonesNotMerged) => return zones,
        Some(Mistake::ZonesAllInOne) => return merge_all(zones),
        Some(Mistake::ZonesUnionFind) => return disjoint_sets(&zones),
        _ => {}
    }
    merge_overlapping(student, zones)
}

fn merge_overlapping(student: Student, mut zones: Vec<Zone>) -> Vec<Zone> {
    loop {
        let count_before = zones.len();
        let mut merged: Vec<Zone> = Vec::new();
        // A student who requires two shared particles still finds that a zone of one particle is part of another zone.
        let meet = |one: &Zone, other: &Zone| {
            let needed = if student.makes(Mistake::ZonesJoinTwoShared) {
                one.particles.len().min(other.particles.len()).min(2)
            } else {
                return !one.particles.is_disjoint(&other.particles);
            };
            one.particles.intersection(&other.particles).count() >= needed
        };
        for zone in zones {
            match merged.iter_mut().find(|other| meet(other, &zone)) {
                Some(other) => join(student, other, zone),
                None => merged.push(zone),
            }
        }
        zones = merged;
        let again = zones.len() != count_before;
        if !again || student.makes(Mistake::ZonesMergedOnce) {
            return zones;
        }
    }
}

fn join(student: Student, zone: &mut Zone, other: Zone) {
    zone.has_half_plane = match student.mistake_in(MODULE_AREAS) {
        Some(Mistake::ZonesFlagLost) => zone.has_half_plane,
        Some(Mistake::ZonesFlagOverwritten) => other.has_half_plane,
        Some(Mistake::ZonesFlagBoth) => zone.has_half_plane && other.has_half_plane,
        _ => zone.has_half_plane || other.has_half_plane,
    };
    if student.makes(Mistake::ZonesJoinOneParticle) {
        zone.particles.extend(other.particles.last());
    } else {
        zone.particles.extend(other.particles);
    }
}

fn merge_all(zones: Vec<Zone>) -> Vec<Zone> {
    let merged = zones.into_iter().reduce(|mut merged, zone| {
        join(Student::default(), &mut merged, zone);
        merged
    });
    merged.into_iter().collect()
}

/// Returns the joined zones in the order of their first particles. It uses a union-find structure.
fn disjoint_sets(zones: &[Zone]) -> Vec<Zone> {
    let count = zones.iter().filter_map(|zone| zone.particles.last()).max().map_or(0, |last| last + 1);
    let mut parents: Vec<usize> = (0..count).collect();
    for zone in zones {
        let mut roots = zone.particles.iter().map(|&particle| find_root(&parents, particle)).collect::<BTreeSet<_>>();
        let first = roots.pop_first();
        for other in roots {
            parents[other] = first.unwrap_or(other);
        }
    }
    let mut sets: BTreeMap<usize, Zone> = BTreeMap::new();
    for zone in zones {
        for &particle in &zone.particles {
            let set = sets
                .entry(find_root(&parents, particle))
                .or_insert_with(|| Zone { particles: BTreeSet::new(), has_half_plane: false });
            set.particles.insert(particle);
            set.has_half_plane |= zone.has_half_plane;
        }
    }
    sets.into_values().collect()
}

fn find_root(parents: &[usize], mut particle: usize) -> usize {
    while parents[particle] != particle {
        particle = parents[particle];
    }
    particle
}

/// Returns whether the student's program finds the same zones in two lists, in any order.
pub fn has_same_zones(student: Student, old: &[Zone], new: &[Zone]) -> bool {
    let same = |one: &Zone, other: &Zone| match student.mistake_in(MODULE_AREAS) {
        Some(Mistake::ZonesEqualByCount) => true,
        Some(Mistake::ZonesEqualNoFlag) => one.particles == other.particles,
        Some(Mistake::ZonesEqualBySize) => one.particles.len() == other.particles.len(),
        _ => one.particles == other.particles && one.has_half_plane == other.has_half_plane,
    };
    old.len() == new.len() && new.iter().all(|zone| old.iter().any(|other| same(zone, other)))
}
