//! Impact zones, which are groups of connected collisions (collisions.md 5).
//!
//! The original merges lists of sets until no two sets share a particle; each set joins the first set that it meets.
//! The result is the connected components, in the order of the first list entry of each. A union-find structure
//! computes them in nearly linear time.
use super::super::{
    bodies::Bodies,
    observer::{Impulse, Zone},
    pair::PairKind,
};

/// Disjoint zones in order, with their ascending particles in one array.
#[derive(Debug, Clone, Default)]
pub(super) struct Zones {
    particles: Vec<u32>,
    particle_ends: Vec<usize>,
    has_half_plane: Vec<bool>,
    /// The zone of each particle of the scene, or [`NO_ZONE`].
    zone_by_particle: Vec<u32>,
}

const NO_ZONE: u32 = u32::MAX;

impl Zones {
    /// Returns the number of zones.
    pub fn len(&self) -> usize {
        self.particle_ends.len()
    }

    /// Returns zone number `index`.
    pub fn get(&self, index: usize) -> Zone<'_> {
        let start = if index == 0 { 0 } else { self.particle_ends[index - 1] };
        Zone { particles: &self.particles[start..self.particle_ends[index]], half_plane: self.has_half_plane[index] }
    }

    /// Returns all zones in order.
    pub fn iter(&self) -> impl Iterator<Item = Zone<'_>> {
        (0..self.len()).map(|index| self.get(index))
    }

    /// Calls `visit` with the list of all zones; the list is built in `memory`.
    pub fn visit_all(&self, memory: &mut Vec<Zone<'static>>, visit: impl FnOnce(&[Zone<'_>])) {
        let mut list: Vec<Zone<'_>> = std::mem::take(memory);
        list.extend(self.iter());
        visit(&list);
        list.clear();
        // The list is empty now; collecting in place returns the allocation with the longer lifetime.
        *memory = list.into_iter().map(|_| Zone { particles: &[], half_plane: false }).collect();
    }
}

/// Zones are equal in any order, if each zone of one list occurs in the other.
impl PartialEq for Zones {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len()
            && other.iter().all(|zone| {
                let here = zone.particles.first().map_or(NO_ZONE, |&particle| self.zone_by_particle[particle as usize]);
                here != NO_ZONE && self.get(here as usize) == zone
            })
    }
}

/// Joins zones and hits into connected components. Its memory is O(particles + hits).
#[derive(Debug, Clone, Default)]
pub(super) struct ZoneBuilder {
    /// The union-find structure of the scene's particles.
    parents: Vec<u32>,
    /// One particle and the half-plane flag of each set so far, in order.
    sets: Vec<(u32, bool)>,
}

impl ZoneBuilder {
    /// Removes all sets, for a scene with `particles` particles.
    pub fn begin(&mut self, particles: usize) {
        self.sets.clear();
        self.parents.clear();
        #[expect(clippy::cast_possible_truncation, reason = "particle indices fit into 32 bits")]
        self.parents.extend(0..particles as u32);
    }

    /// Appends a list of zones.
    pub fn add_zones(&mut self, zones: &Zones) {
        for zone in zones.iter() {
            for &particle in zone.particles {
                self.join(zone.particles[0], particle);
            }
            self.sets.push((zone.particles[0], zone.half_plane));
        }
    }

    /// Appends one zone per hit: the particles of the pair, and the half-plane flag.
    pub fn add_hits(&mut self, bodies: &Bodies, hits: &[Impulse]) {
        for Impulse { pair, .. } in hits {
            for particle in bodies.pair_particles(*pair) {
                #[expect(clippy::cast_possible_truncation, reason = "particle indices fit into 32 bits")]
                self.join(pair.first, particle as u32);
            }
            self.sets.push((pair.first, pair.kind == PairKind::ParticleHalfPlane));
        }
    }

    /// Writes the components into `zones`, ordered by the first set of each.
    pub fn finish(&mut self, zones: &mut Zones) {
        let particle_count = self.parents.len();
        let Zones { particles: members, particle_ends: ends, has_half_plane: half_planes, zone_by_particle: zone_of } =
            zones;
        members.clear();
        ends.clear();
        half_planes.clear();
        zone_of.clear();
        zone_of.resize(particle_count, NO_ZONE);
        // Roots get their numbers in the order of the sets.
        for index in 0..self.sets.len() {
            let (particle, half_plane) = self.sets[index];
            let root = self.find_root(particle) as usize;
            if zone_of[root] == NO_ZONE {
                #[expect(clippy::cast_possible_truncation, reason = "at most one zone per particle")]
                let number = half_planes.len() as u32;
                zone_of[root] = number;
                half_planes.push(half_plane);
                ends.push(0);
            } else {
                half_planes[zone_of[root] as usize] |= half_plane;
            }
        }
        // Each member gets its root's number and is counted; a particle without a set is its own unnumbered root.
        for particle in 0..particle_count {
            #[expect(clippy::cast_possible_truncation, reason = "particle indices fit into 32 bits")]
            let root = self.find_root(particle as u32) as usize;
            zone_of[particle] = zone_of[root];
            if zone_of[particle] != NO_ZONE {
                ends[zone_of[particle] as usize] += 1;
            }
        }
        // A counting sort puts the particles of each zone in ascending order. `ends` then contains the ends of the
        // zones.
        let mut start = 0;
        for end in ends.iter_mut() {
            let count = *end;
            *end = start;
            start += count;
        }
        members.resize(start, 0);
        for (particle, &zone) in zone_of.iter().enumerate() {
            if zone != NO_ZONE {
                let end = &mut ends[zone as usize];
                #[expect(clippy::cast_possible_truncation, reason = "particle indices fit into 32 bits")]
                let particle = particle as u32;
                members[*end] = particle;
                *end += 1;
            }
        }
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find_root(a), self.find_root(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }

    fn find_root(&mut self, mut particle: u32) -> u32 {
        while self.parents[particle as usize] != particle {
            // Halving the path keeps later searches short.
            let above = self.parents[self.parents[particle as usize] as usize];
            self.parents[particle as usize] = above;
            particle = above;
        }
        particle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{
        pair::Pair,
        samples::{NumberSource, edge, particle, scene},
    };
    use fosssim_num::vector::Vec2;

    fn hit(kind: PairKind, first: u32, second: u32) -> Impulse {
        Impulse { pair: Pair { kind, first, second }, normal: Vec2::zeros(), time: 0.0 }
    }

    fn bodies(particles: usize, edges: &[[usize; 2]]) -> Bodies {
        let mut scene = scene((0..particles).map(|_| particle((0.0, 0.0), (0.0, 0.0), 1.0, 0.1)).collect());
        scene.edges.extend(edges.iter().map(|ends| edge(ends[0], ends[1], 0.1)));
        Bodies::new(&scene)
    }

    fn merged(bodies: &Bodies, before: &Zones, hits: &[Impulse]) -> Zones {
        let (mut builder, mut zones) = (ZoneBuilder::default(), Zones::default());
        builder.begin(bodies.particle_count());
        builder.add_zones(before);
        builder.add_hits(bodies, hits);
        builder.finish(&mut zones);
        zones
    }

    /// Returns the merge of collisions.md 5, implemented literally.
    fn merged_literally(mut zones: Vec<(Vec<u32>, bool)>) -> Vec<(Vec<u32>, bool)> {
        loop {
            let mut new: Vec<(Vec<u32>, bool)> = Vec::new();
            for (set, flag) in &zones {
                match new.iter_mut().find(|(other, _)| other.iter().any(|particle| set.contains(particle))) {
                    Some((other, other_flag)) => {
                        other.extend(set);
                        other.sort_unstable();
                        other.dedup();
                        *other_flag |= flag;
                    }
                    None => {
                        let mut set = set.clone();
                        set.sort_unstable();
                        set.dedup();
                        new.push((set, *flag));
                    }
                }
            }
            let shorter = new.len() < zones.len();
            zones = new;
            if !shorter {
                return zones;
            }
        }
    }

    fn owned(zones: &Zones) -> Vec<(Vec<u32>, bool)> {
        zones.iter().map(|zone| (zone.particles.to_vec(), zone.half_plane)).collect()
    }

    #[test]
    fn chains_become_one_zone_and_flags_spread() {
        let bodies = bodies(6, &[[3, 4]]);
        let zones = merged(
            &bodies,
            &Zones::default(),
            &[
                hit(PairKind::ParticleParticle, 4, 5),
                hit(PairKind::ParticleHalfPlane, 1, 0),
                hit(PairKind::ParticleEdge, 0, 0),
                hit(PairKind::ParticleHalfPlane, 3, 0),
            ],
        );
        assert_eq!(owned(&zones), [(vec![0, 3, 4, 5], true), (vec![1], true)]);
        assert_eq!(zones, merged(&bodies, &zones, &[]));
        assert_ne!(zones, merged(&bodies, &zones, &[hit(PairKind::ParticleHalfPlane, 2, 0)]));
    }

    #[test]
    fn a_new_flag_makes_zones_differ() {
        let bodies = bodies(2, &[]);
        let zones = merged(&bodies, &Zones::default(), &[hit(PairKind::ParticleParticle, 0, 1)]);
        assert_ne!(zones, merged(&bodies, &zones, &[hit(PairKind::ParticleHalfPlane, 1, 0)]));
    }

    #[test]
    fn components_come_in_the_order_of_the_literal_merge() {
        let mut numbers = NumberSource(5);
        let mut below = |bound: u32| ((numbers.next() + 1.0) * 0.5 * f64::from(bound)) as u32;
        for _ in 0..500 {
            let edges: Vec<[usize; 2]> = (0..4).map(|_| [below(12) as usize, below(12) as usize]).collect();
            let bodies = bodies(12, &edges);
            let mut hits = Vec::new();
            let mut sets = Vec::new();
            for _ in 0..below(9) {
                let first = below(12);
                match below(3) {
                    0 => {
                        let second = below(12);
                        hits.push(hit(PairKind::ParticleParticle, first, second));
                        sets.push((vec![first, second], false));
                    }
                    1 => {
                        let second = below(4);
                        let ends = edges[second as usize];
                        hits.push(hit(PairKind::ParticleEdge, first, second));
                        sets.push((vec![first, ends[0] as u32, ends[1] as u32], false));
                    }
                    _ => {
                        hits.push(hit(PairKind::ParticleHalfPlane, first, 0));
                        sets.push((vec![first], true));
                    }
                }
            }
            let (early, late) = hits.split_at(hits.len() / 2);
            let before = merged(&bodies, &Zones::default(), early);
            let after = merged(&bodies, &before, late);
            let expected = merged_literally(sets[..early.len()].to_vec());
            assert_eq!(owned(&before), expected);
            let all = expected.into_iter().chain(sets[early.len()..].iter().cloned()).collect();
            assert_eq!(owned(&after), merged_literally(all));
        }
    }
}
