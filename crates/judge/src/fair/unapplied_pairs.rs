//! Finds pairs whose penalty force a step omits or applies twice.
//!
//! The force of a pair changes the velocities of its particles by known amounts. Where velocities are wrong, the
//! amounts are fitted to the differences. A pair is named only if no other choice of pairs fits. The differences of all
//! its particles must also be round-off after the pair's force is subtracted or added.
//!
//! In a contest with a layer the original leaves out bodies whose layers alone are near (simulation.md 3.1). A program
//! may include them, because the contest is about layers without thickness, so such a pair is never named.
use super::{contact::Tolerances, context::Context};
use fosssim_findings::FindingDetail;
use fosssim_model::{
    scene::{Collision, CollisionDetection, Integrator, Scene},
    sim::{Pair, PairKind, PenaltyTerms, State},
};
use fosssim_num::vector::{Vec2, length, set_vector, vector_at};
use std::collections::BTreeSet;

/// The maximum number of pairs per particle; all choices of omitted and doubled pairs among them are tried.
const MAX_PAIRS_PER_PARTICLE: usize = 6;

/// The maximum number of pairs that are examined in one step.
const MAX_PAIRS: usize = 1 << 16;

/// The maximum number of choices that are tried in one step.
const MAX_CHOICES: usize = 1 << 20;

/// A pair near a particle whose velocity is wrong.
struct NearPair {
    pair: Pair,
    /// The changes of its particles' velocities by the pair's force in this step.
    changes: [(usize, Vec2); 3],
    count: usize,
    /// The number of surplus applications, which is -1, 0 or 1, or `None` if it is unknown.
    excess: Option<f64>,
}

impl NearPair {
    fn changes(&self) -> &[(usize, Vec2)] {
        &self.changes[..self.count]
    }

    fn change_of(&self, particle: usize) -> Vec2 {
        self.changes().iter().filter(|(index, _)| *index == particle).map(|(_, change)| *change).sum()
    }
}

/// Returns how often a step from `before` applied the force of each nearby pair: never, once or twice. The reference's
/// step ends in `own`, and the trace's in `logged`. Pairs whose velocities do not show the number are left out.
pub fn count_applications(scene: &Scene, before: &State, own: &State, logged: &State) -> Vec<(Pair, usize)> {
    let context = Context::new(scene);
    let tolerances = Tolerances::from_context(&context, own, None);
    let Some(near) = NearPairs::find(scene, &tolerances, before, own, logged) else { return Vec::new() };
    let wrong = near.candidates.iter().filter_map(|candidate| {
        let times = match candidate.excess? {
            excess if excess < 0.0 => 0,
            excess if excess > 0.0 => 2,
            _ => 1,
        };
        Some((candidate.pair, times))
    });
    wrong.chain(near.right_pairs.iter().map(|pair| (*pair, 1))).collect()
}

/// Returns the pairs that explain wrong velocities of a step from `before`, and the reference's result with the same
/// faults; `None` if nothing is explained.
pub(super) fn explain_velocities(
    context: &Context<'_>,
    tolerances: &Tolerances<'_>,
    before: &State,
    own: &State,
    logged: &State,
) -> Option<(Vec<FindingDetail>, State)> {
    let scene = context.scene;
    let h = scene.time_step;
    let changes_positions = scene.integrator != Integrator::ExplicitEuler;
    let NearPairs { candidates, layer, .. } = NearPairs::find(scene, tolerances, before, own, logged)?;
    let (mut faulty, mut is_explained) = (own.clone(), false);
    let mut found = Vec::new();
    for candidate in &candidates {
        let Some(excess) = candidate.excess.filter(|excess| *excess != 0.0) else { continue };
        is_explained = true;
        if layer.as_ref().is_none_or(|(_, touching)| touching.contains(&candidate.pair)) {
            found.push(FindingDetail::PairForce { pair: candidate.pair, is_doubled: excess > 0.0 });
        }
        for &(particle, change) in candidate.changes() {
            let change = excess * change;
            let velocity = vector_at(&faulty.velocities, particle) + change;
            set_vector(&mut faulty.velocities, particle, velocity);
            if changes_positions {
                let position = vector_at(&faulty.positions, particle) + h * change;
                set_vector(&mut faulty.positions, particle, position);
            }
        }
    }
    is_explained.then_some((found, faulty))
}

/// The nearby pairs of a step.
struct NearPairs {
    /// The pairs whose particles all have wrong velocities.
    candidates: Vec<NearPair>,
    /// The pairs whose force was provably applied once, because a particle has a right velocity and its forces do not
    /// cancel out.
    right_pairs: Vec<Pair>,
    /// The result of [`contest_layer`].
    layer: Option<(Scene, BTreeSet<Pair>)>,
}

impl NearPairs {
    /// Returns the pairs whose force may have been omitted or repeated, and those whose force was provably applied
    /// once. Returns `None` for an implicit integrator, for a scene without penalty forces, and for too many pairs.
    fn find(scene: &Scene, tolerances: &Tolerances<'_>, before: &State, own: &State, logged: &State) -> Option<Self> {
        if scene.integrator.is_implicit() {
            // An implicit integrator combines all forces, so the effect of one force cannot be separated.
            return None;
        }
        let h = scene.time_step;
        let layer = contest_layer(scene, &before.positions);
        let mut terms = match &layer {
            Some((all_pairs, _)) => PenaltyTerms::for_scene(all_pairs)?,
            None => PenaltyTerms::for_scene(scene)?,
        };
        let particle_count = scene.particles.len();
        let mut rest: Vec<Vec2> = (0..particle_count)
            .map(|index| vector_at(&logged.velocities, index) - vector_at(&own.velocities, index))
            .collect();
        let is_settled = |rest: &[Vec2], particle: usize| length(rest[particle]) <= tolerances.velocity(particle);
        let wrong: Vec<bool> = (0..particle_count).map(|particle| !is_settled(&rest, particle)).collect();
        let mut near_pairs: Vec<NearPair> = Vec::new();
        let mut sums = vec![Vec2::zeros(); particle_count];
        terms.visit_pairs(&before.positions, |pair, forces| {
            let mut candidate = NearPair { pair, changes: [(0, Vec2::zeros()); 3], count: 0, excess: None };
            for &(particle, force) in forces.iter().filter(|(particle, _)| !scene.particles[*particle].fixed) {
                let change = (h / scene.particles[particle].mass) * force;
                candidate.changes[candidate.count] = (particle, change);
                candidate.count += 1;
            }
            candidate.changes().iter().for_each(|&(particle, change)| sums[particle] += change);
            near_pairs.push(candidate);
        });
        let (mut candidates, mut right) = (Vec::new(), Vec::new());
        for one in near_pairs {
            let is_felt = |(particle, change): &&(usize, Vec2)| length(*change) > tolerances.velocity(*particle);
            let felt: Vec<usize> = one.changes().iter().filter(is_felt).map(|(particle, _)| *particle).collect();
            let is_right =
                |particle: &usize| !wrong[*particle] && length(sums[*particle]) > tolerances.velocity(*particle);
            if felt.iter().any(is_right) {
                right.push(one.pair);
            } else if !felt.is_empty() && felt.iter().all(|particle| wrong[*particle]) {
                candidates.push(one);
            }
        }
        if candidates.len() > MAX_PAIRS {
            return None;
        }
        let mut particle_candidates: Vec<Vec<usize>> = vec![Vec::new(); particle_count];
        for (index, candidate) in candidates.iter().enumerate() {
            candidate.changes().iter().for_each(|(particle, _)| particle_candidates[*particle].push(index));
        }
        find_unique_choice(&mut candidates, &particle_candidates, &mut rest, &wrong, tolerances);
        // A pair is kept only if it explains all its particles, and its removal may affect its neighbors.
        while let Some(index) = candidates.iter().position(|candidate| {
            let is_named = candidate.excess.is_some_and(|excess| excess != 0.0);
            is_named && !candidate.changes().iter().all(|(particle, _)| is_settled(&rest, *particle))
        }) {
            let excess = candidates[index].excess.take().unwrap_or(0.0);
            candidates[index].changes().iter().for_each(|&(particle, change)| rest[particle] += excess * change);
        }
        Some(Self { candidates, right_pairs: right, layer })
    }
}

/// Returns, for a contest with a layer, the scene with forces between all pairs. Also returns the pairs whose force is
/// due at positions `x`: those that overlap without their layers, and those with a half-plane. Returns `None` for other
/// scenes.
fn contest_layer(scene: &Scene, x: &[f64]) -> Option<(Scene, BTreeSet<Pair>)> {
    let Collision::Penalty { stiffness, thickness, detection: CollisionDetection::Contest } = scene.collision else {
        return None;
    };
    let between_all = |thickness: f64| {
        let collision = Collision::Penalty { stiffness, thickness, detection: CollisionDetection::AllPairs };
        Scene { collision, ..scene.clone() }
    };
    let (all_pairs, mut due) = ((thickness > 0.0).then(|| between_all(thickness))?, BTreeSet::new());
    for (scene, is_bare) in [(&all_pairs, false), (&between_all(0.0), true)] {
        PenaltyTerms::for_scene(scene)?.visit_pairs(x, |pair, _| {
            if is_bare || pair.kind == PairKind::ParticleHalfPlane {
                due.insert(pair);
            }
        });
    }
    Some((all_pairs, due))
}

/// Finds, particle by particle, the unique choice of pairs that explains the particle's velocity, and stores it in
/// `candidates` and `rest`. Each explained particle reduces the choices of its neighbors.
fn find_unique_choice(
    candidates: &mut [NearPair],
    particle_candidates: &[Vec<usize>],
    rest: &mut [Vec2],
    wrong: &[bool],
    tolerances: &Tolerances<'_>,
) {
    let (mut goes_on, mut choices) = (true, 0);
    while goes_on {
        goes_on = false;
        for particle in (0..wrong.len()).filter(|particle| wrong[*particle]) {
            let open: Vec<usize> = particle_candidates[particle]
                .iter()
                .copied()
                .filter(|index| candidates[*index].excess.is_none())
                .collect();
            if open.is_empty() || open.len() > MAX_PAIRS_PER_PARTICLE {
                continue;
            }
            choices += count_choices(open.len());
            if choices > MAX_CHOICES {
                return;
            }
            let Some(choice) =
                find_only_choice(candidates, &open, particle, rest[particle], tolerances.velocity(particle))
            else {
                continue;
            };
            for (index, excess) in open.into_iter().zip(choice) {
                candidates[index].excess = Some(excess);
                candidates[index].changes().iter().for_each(|&(other, change)| rest[other] += -excess * change);
            }
            goes_on = true;
        }
    }
}

/// Returns the number of choices among `pairs` pairs, each of which is omitted, applied once or applied twice.
fn count_choices(pairs: usize) -> usize {
    (0..pairs).fold(1, |product, _| 3 * product)
}

/// Returns the number of surplus applications of each pair, if exactly one choice explains the rest of a particle's
/// velocity.
fn find_only_choice(
    candidates: &[NearPair],
    open: &[usize],
    particle: usize,
    rest: Vec2,
    tolerance: f64,
) -> Option<[f64; MAX_PAIRS_PER_PARTICLE]> {
    let mut found = None;
    for number in 0..count_choices(open.len()) {
        let (mut choice, mut left, mut digits) = ([0.0; MAX_PAIRS_PER_PARTICLE], rest, number);
        for (excess, index) in choice.iter_mut().zip(open) {
            *excess = [0.0, -1.0, 1.0][digits % 3];
            digits /= 3;
            left -= *excess * candidates[*index].change_of(particle);
        }
        if length(left) <= tolerance && found.replace(choice).is_some() {
            return None;
        }
    }
    found
}
