//! Impact zones: sets of particles that collide with one another (collisions.md 5.4).
use std::collections::{BTreeMap, BTreeSet};

use super::{
    author::Student,
    catalogue::{Area, Mistake},
    mutants::Change,
    objects::{Contact, Object, Zone},
    world::World,
};

/// The parts of the assignment whose mistakes are made here.
const HERE: &[Area] = &[Area::ImpactZones];

/// The zone of one contact.
pub fn zone_of(world: &World, contact: &Contact) -> Zone {
    let student = world.student;
    let mut particles = BTreeSet::from([contact.pair.particle]);
    let mut half_plane = false;
    match contact.pair.object {
        Object::Particle(other) => {
            particles.insert(other);
        }
        Object::Edge(index) => {
            let edge = world.scene.edges[index];
            match student.mistake_in(HERE) {
                Some(Mistake::ZonesOneEndpoint) => particles.extend([edge.first]),
                Some(Mistake::ZonesOtherEndpoint) => particles.extend([edge.second]),
                Some(Mistake::ZonesNextParticle) => {
                    particles.extend([edge.first, (edge.first + 1).min(world.scene.particles.len() - 1)]);
                }
                Some(Mistake::ZonesEdgeIndex) => particles.extend([index.min(world.scene.particles.len() - 1)]),
                Some(Mistake::ZonesEdgeWithoutParticle) => particles = BTreeSet::from([edge.first, edge.second]),
                _ => particles.extend([edge.first, edge.second]),
            }
            half_plane = student.makes(Mistake::ZonesFlagOfEdges);
        }
        Object::HalfPlane(_) => half_plane = !student.makes(Mistake::ZonesNoHalfPlaneFlag),
    }
    let mut zone = Zone { particles, half_plane };
    if let Some(Change::Zone(change)) = student.change() {
        change(contact, &mut zone);
    }
    zone
}

/// Joins zones until no two share a particle.
pub fn merge(student: Student, zones: Vec<Zone>) -> Vec<Zone> {
    match student.mistake_in(HERE) {
        Some(Mistake::ZonesNotMerged) => return zones,
        Some(Mistake::ZonesAllInOne) => return everything(zones),
        Some(Mistake::ZonesUnionFind) => return disjoint_sets(&zones),
        _ => {}
    }
    if let Some(Change::Zones(change)) = student.change() {
        let mut merged = merged(student, zones);
        change(&mut merged);
        return merged;
    }
    merged(student, zones)
}

fn merged(student: Student, mut zones: Vec<Zone>) -> Vec<Zone> {
    loop {
        let before = zones.len();
        let mut merged: Vec<Zone> = Vec::new();
        for zone in zones {
            // Whoever asks for two shared particles still finds a zone of one in another.
            let shares = |other: &Zone| {
                let most = other.particles.len().min(zone.particles.len());
                let least = if student.makes(Mistake::ZonesJoinTwoShared) { most.min(2) } else { 1 };
                other.particles.intersection(&zone.particles).count() >= least
            };
            match merged.iter_mut().find(|other| shares(other)) {
                Some(other) => join(student, other, zone),
                None => merged.push(zone),
            }
        }
        zones = merged;
        if zones.len() == before || student.makes(Mistake::ZonesMergedOnce) {
            return zones;
        }
    }
}

fn join(student: Student, zone: &mut Zone, other: Zone) {
    zone.half_plane = match student.mistake_in(HERE) {
        Some(Mistake::ZonesFlagLost) => zone.half_plane,
        Some(Mistake::ZonesFlagOverwritten) => other.half_plane,
        Some(Mistake::ZonesFlagBoth) => zone.half_plane && other.half_plane,
        _ => zone.half_plane || other.half_plane,
    };
    if student.makes(Mistake::ZonesJoinOneParticle) {
        zone.particles.extend(other.particles.last());
    } else {
        zone.particles.extend(other.particles);
    }
}

fn everything(zones: Vec<Zone>) -> Vec<Zone> {
    let whole = zones.into_iter().reduce(|mut whole, zone| {
        whole.half_plane |= zone.half_plane;
        whole.particles.extend(zone.particles);
        whole
    });
    whole.into_iter().collect()
}

/// The same zones by way of disjoint sets (union and find), in the order of their first particles.
fn disjoint_sets(zones: &[Zone]) -> Vec<Zone> {
    let count = zones.iter().filter_map(|zone| zone.particles.last()).max().map_or(0, |last| last + 1);
    let mut parents: Vec<usize> = (0..count).collect();
    for zone in zones {
        let mut roots = zone.particles.iter().map(|&particle| root(&parents, particle)).collect::<BTreeSet<_>>();
        let first = roots.pop_first();
        for other in roots {
            parents[other] = first.unwrap_or(other);
        }
    }
    let mut sets: BTreeMap<usize, Zone> = BTreeMap::new();
    for zone in zones {
        for &particle in &zone.particles {
            let set = sets
                .entry(root(&parents, particle))
                .or_insert_with(|| Zone { particles: BTreeSet::new(), half_plane: false });
            set.particles.insert(particle);
            set.half_plane |= zone.half_plane;
        }
    }
    sets.into_values().collect()
}

fn root(parents: &[usize], mut particle: usize) -> usize {
    while parents[particle] != particle {
        particle = parents[particle];
    }
    particle
}

/// Whether two lists hold the same zones, in whatever order.
pub fn equal(student: Student, old: &[Zone], new: &[Zone]) -> bool {
    match student.mistake_in(HERE) {
        Some(Mistake::ZonesEqualByCount) => old.len() == new.len(),
        Some(Mistake::ZonesEqualNoFlag) => {
            old.len() == new.len() && new.iter().all(|zone| old.iter().any(|other| other.particles == zone.particles))
        }
        Some(Mistake::ZonesEqualBySize) => {
            old.len() == new.len()
                && new.iter().all(|zone| old.iter().any(|other| other.particles.len() == zone.particles.len()))
        }
        _ => old.len() == new.len() && new.iter().all(|zone| old.contains(zone)),
    }
}
