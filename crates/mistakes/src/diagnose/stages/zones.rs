//! Finds the result of one impact zone in the first round of the geometric part. The particles that moved as one body
//! show the actual zones.
use super::events::StepFacts;
use crate::diagnose::{WrongZones, sampling::pair_particles};
use fosssim_model::{
    scene::Scene,
    sim::{PairKind, Stage, State},
};
use fosssim_num::{
    elementary,
    vector::{Vec2, divide, length, set_vector, vector_at},
};

/// The size below which differences count as round-off, relative to the numbers or 1, whichever is larger.
pub(super) const ROUND_OFF_LIMIT: f64 = 1e-9;
/// The maximum number of particles of a zone for which every subset is tried.
const MAX_PARTICLES: usize = 8;
const MAX_CONTACTS: usize = 5;

/// A set of particles that move together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ParticleGroup {
    /// The particles' indices, ascending.
    pub(super) particles: Vec<usize>,
    /// Whether the set contains a half-plane.
    pub(super) has_half_plane: bool,
}

impl ParticleGroup {
    fn from_particles(mut particles: Vec<usize>, half_plane: bool) -> Self {
        particles.sort_unstable();
        particles.dedup();
        Self { particles, has_half_plane: half_plane }
    }

    fn union(groups: &[&Self]) -> Self {
        let particles = groups.iter().flat_map(|group| group.particles.iter().copied()).collect();
        Self::from_particles(particles, groups.iter().any(|group| group.has_half_plane))
    }

    /// Returns whether the zone must end where it started: it contains a half-plane or a fixed particle.
    pub(super) fn must_stop(&self, scene: &Scene) -> bool {
        self.has_half_plane || self.particles.iter().any(|&particle| scene.particles[particle].fixed)
    }

    fn contains(&self, other: &Self) -> bool {
        other.particles.iter().all(|particle| self.particles.contains(particle))
    }
}

/// The motion of a zone, compared with the expected motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ZoneResult {
    /// The zone moved or stopped as expected.
    Right,
    /// The zone was not moved or stopped as expected.
    Wrong(WrongZones),
    /// The zone moved as one rigid body, but not as expected.
    Rigid,
    /// The zone's particles did not keep their distances, or did not stop as a whole.
    Deformed,
}

/// The first round of the geometric part of a step whose mid state and first geometric pass are right.
pub(super) struct FirstRound<'a> {
    scene: &'a Scene,
    pub(super) facts: &'a StepFacts,
    pub(super) middle: &'a State,
    /// The end state of the step, which shows the first round's effect on the examined zones.
    pub(super) end: &'a State,
    pub(super) zones: Vec<ParticleGroup>,
    /// The contacts, each as a zone of its own.
    contacts: Vec<ParticleGroup>,
    /// The index of the second geometric pass among the logged passes.
    second: usize,
    /// The number of rounds in which zones moved.
    rounds: usize,
}

impl<'a> FirstRound<'a> {
    /// Collects the facts about the first geometric round of a step. Returns `None` if the step has no such round, or
    /// if the mid state or a polynomial of the first geometric pass or earlier is wrong.
    pub(super) fn for_scene(scene: &'a Scene, facts: &'a StepFacts) -> Option<Self> {
        let (loop_passes, passes) = facts.logged_passes().filter(|_| facts.has_right_mid_state())?;
        let is_right = facts.right_polynomials >= (loop_passes + 1) * facts.pass_size();
        let (_, middle) = facts.mid_states()?;
        let first = facts.passes.iter().position(|pass| pass.stage == Stage::Geometric { round: 0 })?;
        let round = facts.zones.iter().map(|zone| zone.round).min()?;
        if passes == 0 || !is_right {
            return None;
        }
        let zones = facts.zones.iter().filter(|zone| zone.round == round);
        let zones =
            zones.map(|zone| ParticleGroup::from_particles(zone.particles.clone(), zone.has_half_plane)).collect();
        let contacts = facts.hits.iter().filter(|hit| hit.pass == first).map(|hit| {
            let is_half_plane = hit.pair.kind == PairKind::ParticleHalfPlane;
            ParticleGroup::from_particles(pair_particles(scene, hit.pair), is_half_plane)
        });
        let (contacts, end) = (contacts.collect(), &facts.actual.end.state);
        let (middle, second, rounds) = (&middle.state, loop_passes + 1, passes.max(2) - 1);
        Some(Self { scene, facts, middle, end, zones, contacts, second, rounds })
    }

    /// Returns whether the end of the step shows the positions of the group after the first round.
    pub(super) fn is_visible(&self, group: &ParticleGroup) -> bool {
        let is_own = |pair| pair_particles(self.scene, pair).iter().all(|particle| group.particles.contains(particle));
        self.rounds == 1 || self.facts.fits_motion(self.scene, self.second, &self.end.positions, is_own)
    }

    /// Returns whether a zone's particles end in the expected state, so that the zone proves nothing.
    pub(super) fn is_as_expected(&self, zone: &ParticleGroup) -> bool {
        self.are_at(&self.expected_state(zone), &zone.particles)
    }

    /// Returns the contacts of a zone, without repetitions.
    pub(super) fn zone_contacts(&self, zone: &ParticleGroup) -> Vec<&ParticleGroup> {
        let mut own: Vec<&ParticleGroup> = Vec::new();
        for contact in self.contacts.iter().filter(|contact| zone.contains(contact)) {
            if !own.contains(&contact) {
                own.push(contact);
            }
        }
        own
    }

    /// Returns the state after `groups` have moved, one after the other.
    fn moved_state(&self, groups: &[&ParticleGroup]) -> State {
        let mut state = self.middle.clone();
        self.move_groups(groups, &mut state);
        state
    }

    fn move_groups(&self, groups: &[&ParticleGroup], state: &mut State) {
        for group in groups {
            move_group(self.scene, group, group.must_stop(self.scene), &self.facts.before, state);
        }
    }

    /// Returns whether a zone's particles end where they would if its contacts formed several zones, which move one
    /// after the other in every round.
    pub(super) fn is_split(&self, zone: &ParticleGroup) -> bool {
        self.partitions(zone).into_iter().any(|groups| {
            let groups: Vec<&ParticleGroup> = groups.iter().collect();
            let mut state = self.middle.clone();
            (0..self.rounds).for_each(|_| self.move_groups(&groups, &mut state));
            self.are_at(&state, &zone.particles)
        })
    }

    fn is_at(&self, state: &State, particle: usize) -> bool {
        are_near(vector_at(&self.end.positions, particle), vector_at(&state.positions, particle))
            && are_near(vector_at(&self.end.velocities, particle), vector_at(&state.velocities, particle))
    }

    fn are_at(&self, state: &State, particles: &[usize]) -> bool {
        particles.iter().all(|&particle| self.is_at(state, particle))
    }

    /// Returns the state after only this zone has moved.
    pub(super) fn expected_state(&self, zone: &ParticleGroup) -> State {
        self.moved_state(&[zone])
    }

    /// Returns the result of a visible zone.
    pub(super) fn zone_result(&self, zone: &ParticleGroup) -> ZoneResult {
        let all = &zone.particles;
        let expected = self.expected_state(zone);
        if self.are_at(&expected, all) {
            return ZoneResult::Right;
        }
        if self.are_at(self.middle, all) {
            return ZoneResult::Wrong(WrongZones::Unmoved);
        }
        let mut stopped = self.middle.clone();
        move_group(self.scene, zone, true, &self.facts.before, &mut stopped);
        let must_stop = zone.must_stop(self.scene);
        if !must_stop && self.are_at(&stopped, all) {
            return ZoneResult::Wrong(WrongZones::Stop);
        }
        if let Some(fate) = self.find_other_zones(zone) {
            return fate;
        }
        if must_stop { self.stop_result(zone, &stopped) } else { self.motion_result(zone) }
    }

    /// Returns the fault in the choice of zones, if other zones, each moved correctly, explain the states of the zone's
    /// particles.
    fn find_other_zones(&self, zone: &ParticleGroup) -> Option<ZoneResult> {
        if self.is_split(zone) {
            return Some(ZoneResult::Wrong(WrongZones::NotMerged));
        }
        let others: Vec<&ParticleGroup> = self.zones.iter().filter(|other| *other != zone).collect();
        let is_joined = |groups: &[&ParticleGroup]| {
            let all = ParticleGroup::union(groups);
            self.is_visible(&all) && self.are_at(&self.moved_state(&[&all]), &all.particles)
        };
        let mut all_zones = others.clone();
        all_zones.insert(0, zone);
        if others.iter().any(|other| is_joined(&[zone, other])) || (others.len() > 1 && is_joined(&all_zones)) {
            return Some(ZoneResult::Wrong(WrongZones::Joined));
        }
        let foreign = self.particles_moved_outside_zones();
        if zone.particles.len() > MAX_PARTICLES {
            return None;
        }
        // Each part of the zone is tried, alone and with particles that are in no zone.
        let parts = (1..1_u32 << zone.particles.len()).map(|bits| {
            let is_in = |(bit, _): &(usize, &usize)| bits >> bit & 1 == 1;
            zone.particles.iter().enumerate().filter(is_in).map(|(_, particle)| *particle).collect::<Vec<usize>>()
        });
        for part in parts {
            let other_particles: Vec<usize> =
                zone.particles.iter().copied().filter(|particle| !part.contains(particle)).collect();
            let leads_there = |group: &ParticleGroup| {
                let is_body = group.particles.len() > 1 || group.must_stop(self.scene);
                let moved_state = self.moved_state(&[group]);
                is_body && self.are_at(&moved_state, &group.particles) && self.are_at(self.middle, &other_particles)
            };
            // A particle with the expected position was not omitted.
            let is_left = || other_particles.iter().any(|&particle| !self.is_at(&self.expected_state(zone), particle));
            if is_left()
                && [false, zone.has_half_plane]
                    .iter()
                    .any(|flag| leads_there(&ParticleGroup::from_particles(part.clone(), *flag)))
            {
                let wrong = if zone.must_stop(self.scene) { WrongZones::PartlyStopped } else { WrongZones::Partly };
                return Some(ZoneResult::Wrong(wrong));
            }
            if !foreign.is_empty() {
                let with = ParticleGroup::from_particles([part.clone(), foreign.clone()].concat(), zone.has_half_plane);
                if leads_there(&with) {
                    return Some(ZoneResult::Wrong(WrongZones::Others));
                }
            }
        }
        None
    }

    /// Returns particles that moved although they are in no zone.
    fn particles_moved_outside_zones(&self) -> Vec<usize> {
        if self.rounds > 1 {
            return Vec::new();
        }
        let is_in_zone = |particle: &usize| self.zones.iter().any(|zone| zone.particles.contains(particle));
        let all = 0..self.scene.particles.len();
        all.filter(|particle| !is_in_zone(particle) && !self.is_at(self.middle, *particle)).collect()
    }

    /// Returns the ways to form several zones from a zone's contacts, in the order of the first contact of each.
    fn partitions(&self, zone: &ParticleGroup) -> Vec<Vec<ParticleGroup>> {
        let contacts = self.zone_contacts(zone);
        if contacts.len() < 2 || contacts.len() > MAX_CONTACTS {
            return Vec::new();
        }
        let mut all: Vec<Vec<Vec<&ParticleGroup>>> = vec![Vec::new()];
        for contact in contacts {
            let grown = all.into_iter().flat_map(|parts| {
                (0..=parts.len()).map(move |into| {
                    let mut parts = parts.clone();
                    if into == parts.len() {
                        parts.push(Vec::new());
                    }
                    parts[into].push(contact);
                    parts
                })
            });
            all = grown.collect();
        }
        let several = all.into_iter().filter(|parts| parts.len() > 1);
        several.map(|parts| parts.iter().map(|part| ParticleGroup::union(part)).collect()).collect()
    }

    /// Returns the wrong result of a zone that must stop. The program is assumed to handle all its particles as one
    /// zone.
    fn stop_result(&self, zone: &ParticleGroup, stopped: &State) -> ZoneResult {
        let mut free = self.middle.clone();
        move_group(self.scene, zone, false, &self.facts.before, &mut free);
        if self.are_at(&free, &zone.particles) {
            return ZoneResult::Wrong(WrongZones::MoveOn);
        }
        let is_back = |particle: &usize| {
            are_near(vector_at(&self.end.positions, *particle), vector_at(&stopped.positions, *particle))
        };
        let is_at_rest = |particle: &usize| length(vector_at(&self.end.velocities, *particle)) <= ROUND_OFF_LIMIT;
        let all = || zone.particles.iter();
        if all().all(is_back) {
            ZoneResult::Wrong(WrongZones::KeepVelocities)
        } else if all().all(is_at_rest) {
            ZoneResult::Wrong(WrongZones::KeepPositions)
        } else if all().any(|particle| is_back(particle) && is_at_rest(particle) && !self.is_at(self.middle, *particle))
        {
            ZoneResult::Wrong(WrongZones::PartlyStopped)
        } else {
            ZoneResult::Deformed
        }
    }

    fn motion_result(&self, zone: &ParticleGroup) -> ZoneResult {
        let distance = |state: &State, one: usize, two: usize| {
            length(vector_at(&state.positions, one) - vector_at(&state.positions, two))
        };
        let pairs = zone.particles.iter().flat_map(|&one| zone.particles.iter().map(move |&two| (one, two)));
        let is_rigid = pairs.into_iter().all(|(one, two)| {
            let (before, after) = (distance(&self.facts.before, one, two), distance(self.end, one, two));
            (before - after).abs() <= ROUND_OFF_LIMIT * (1.0 + before)
        });
        if is_rigid { ZoneResult::Rigid } else { ZoneResult::Deformed }
    }
}

/// Moves a group as one rigid body from its start, or back to its start (collisions.md 5).
fn move_group(scene: &Scene, group: &ParticleGroup, stops: bool, start: &State, state: &mut State) {
    let all = || group.particles.iter().copied();
    if stops {
        for one in all() {
            set_vector(&mut state.positions, one, vector_at(&start.positions, one));
            set_vector(&mut state.velocities, one, Vec2::zeros());
        }
        return;
    }
    let (center, to) = (center_of_mass(scene, group, start), center_of_mass(scene, group, state));
    let angle = rotation_angle(scene, group, start, state);
    for one in all() {
        let arm = vector_at(&start.positions, one) - center;
        let turned_arm = Vec2::new(-arm.y, arm.x);
        let x = to + elementary::cos(angle) * arm + elementary::sin(angle) * turned_arm;
        set_vector(&mut state.positions, one, x);
        set_vector(&mut state.velocities, one, divide(x - vector_at(&start.positions, one), scene.time_step));
    }
}

/// Returns the angle by which the failsafe turns a group, in radians. It is the group's angular momentum divided by its
/// moment of inertia, both for the motion from the start of the step to `state` (collisions.md 5).
pub(super) fn rotation_angle(scene: &Scene, group: &ParticleGroup, start: &State, state: &State) -> f64 {
    let (center, to) = (center_of_mass(scene, group, start), center_of_mass(scene, group, state));
    let (mut angular_momentum, mut inertia) = (0.0, 0.0);
    for &one in &group.particles {
        let arm = vector_at(&start.positions, one) - center;
        let moved = vector_at(&state.positions, one) - vector_at(&start.positions, one) - (to - center);
        angular_momentum += scene.particles[one].mass * (arm.x * moved.y - arm.y * moved.x);
        inertia += scene.particles[one].mass * arm.dot(&arm);
    }
    angular_momentum / inertia
}

/// Returns the center of mass of a group.
pub(super) fn center_of_mass(scene: &Scene, group: &ParticleGroup, state: &State) -> Vec2 {
    let mass = |particle: usize| scene.particles[particle].mass;
    let sum =
        group.particles.iter().map(|&particle| mass(particle) * vector_at(&state.positions, particle)).sum::<Vec2>();
    divide(sum, group.particles.iter().map(|&particle| mass(particle)).sum())
}

pub(super) fn are_near(one: Vec2, two: Vec2) -> bool {
    length(one - two) <= ROUND_OFF_LIMIT * (1.0 + length(one))
}
