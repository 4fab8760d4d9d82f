//! Examines the impulse rounds of `hybrid`: their number, the positions that they use, and their result.
//!
//! The polynomials of a round show the positions at its beginning, which are the result of the previous round.
use super::{Explanation, RATIO_TOLERANCE, events::StepFacts, new_observation, responses::Responses};
use crate::diagnose::{
    GeometricPartError, LoopEnd, Quantity, RoundCountError, StageDetail, StageFault,
    sampling::{ROUND_OFF, pair_particles},
};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{Pair, Stage},
};
use std::cmp::Ordering;

/// Returns the fault in the impulse rounds, if their single contacts are right.
pub(super) fn explain_impulse_rounds(scene: &Scene, facts: &[StepFacts], responses: &Responses) -> Option<Explanation> {
    let Collision::Hybrid { max_iterations, .. } = scene.collision else { return None };
    let wrong: Vec<&StepFacts> = facts.iter().filter(|facts| facts.is_wrong && !facts.has_right_mid_state()).collect();
    if wrong.is_empty() {
        return None;
    }
    explain_rounds(&wrong, max_iterations)
        .or_else(|| explain_prediction(scene, &wrong))
        .or_else(|| explain_handover(&wrong, responses))
        .or_else(|| explain_later_rounds(scene, &wrong))
}

/// Returns the fault in the decision whether the geometric part follows, if the impulse rounds are right.
pub(super) fn explain_geometric(facts: &[StepFacts]) -> Option<Explanation> {
    let (mut omitted, mut superfluous, mut followed) = (0, 0, 0);
    for facts in facts.iter().filter(|facts| facts.has_right_mid_state()) {
        let ran_out = facts.passes.iter().any(|pass| matches!(pass.stage, Stage::Geometric { .. }));
        match (ran_out, facts.logged_passes()) {
            (true, Some((_, 0))) => omitted += 1,
            (true, Some(_)) => followed += 1,
            (false, Some((_, passes))) if passes > 0 => superfluous += 1,
            _ => {}
        }
    }
    let (wrong, count) = match (omitted, superfluous) {
        (0, 0) => return None,
        (0, _) => (GeometricPartError::Superfluous, superfluous),
        _ => (GeometricPartError::Omitted { always: followed == 0 }, omitted),
    };
    Some(new_observation(StageFault::Geometric(wrong), Vec::new(), count))
}

/// Returns the explanation of steps that log right polynomials, but too many or too few of them. Returns `None` if
/// these are less than half of the wrong steps.
fn explain_rounds(wrong: &[&StepFacts], max_iterations: i32) -> Option<Explanation> {
    let mut seen_counts: Vec<(usize, usize)> = Vec::new();
    for facts in wrong {
        let (Some((passes, _)), Some((expected, actual))) = (facts.logged_passes(), facts.mid_states()) else {
            continue;
        };
        let counts = (expected.polynomials.len() / facts.pass_size(), passes);
        if counts.0 != counts.1 && facts.right_polynomials >= expected.polynomials.len().min(actual.polynomials.len()) {
            seen_counts.push(counts);
        }
    }
    let count_steps =
        |ordering: Ordering| seen_counts.iter().filter(|(ours, theirs)| theirs.cmp(ours) == ordering).count();
    // At least half of the wrong steps must have this fault. The faults of the other steps may follow from it.
    if seen_counts.is_empty() || 2 * seen_counts.len() < wrong.len() {
        return None;
    }
    let number = match (count_steps(Ordering::Less), count_steps(Ordering::Greater)) {
        (_, 0) => RoundCountError::Fewer,
        (0, _) => RoundCountError::More,
        _ => RoundCountError::Other,
    };
    let mut details: Vec<StageDetail> = Vec::new();
    for &(expected, actual) in &seen_counts {
        let line = StageDetail::Passes { expected, actual, most: max_iterations };
        if !details.contains(&line) && details.len() < 3 {
            details.push(line);
        }
    }
    Some(new_observation(StageFault::Rounds(number), details, seen_counts.len()))
}

/// Returns the explanation of steps whose later rounds use the integrator's positions instead of those after the first
/// round. Returns `None` unless all wrong steps with several passes show this.
fn explain_prediction(scene: &Scene, wrong: &[&StepFacts]) -> Option<Explanation> {
    let mut count = 0;
    for facts in wrong {
        let (Some((passes, _)), Some((_, middle))) = (facts.logged_passes(), facts.mid_states()) else { return None };
        if passes < 2 {
            continue;
        }
        let prediction = &facts.prediction.positions;
        let is_again = |pass| facts.fits_motion(scene, pass, prediction, |_| true);
        let is_right = facts.right_polynomials >= 2 * facts.pass_size();
        if is_right || !(1..passes).all(is_again) || find_difference(prediction, &middle.state.positions).is_none() {
            return None;
        }
        count += 1;
    }
    (count > 0).then(|| new_observation(StageFault::RoundsOfPrediction, Vec::new(), count))
}

/// Returns the index of the first number that differs by more than round-off, or `None` if no number does.
fn find_difference(ours: &[f64], theirs: &[f64]) -> Option<usize> {
    let within = ROUND_OFF.state.max(RATIO_TOLERANCE * 1e-3);
    ours.iter().zip(theirs).position(|(ours, theirs)| !((ours - theirs).abs() <= within * (1.0 + ours.abs())))
}

/// Returns the explanation of steps whose polynomials are right but whose state after the loop is wrong. Returns `None`
/// if these are less than half of the wrong steps.
fn explain_handover(wrong: &[&StepFacts], responses: &Responses) -> Option<Explanation> {
    let (mut ran_out, mut ended, mut positions, mut velocities) = (0, 0, false, false);
    let mut or_response = false;
    for facts in wrong {
        let Some((expected, actual)) = facts.mid_states() else { continue };
        let polynomial_count = expected.polynomials.len();
        if actual.polynomials.len() != polynomial_count || facts.right_polynomials < polynomial_count {
            continue;
        }
        positions |= find_difference(&expected.state.positions, &actual.state.positions).is_some();
        velocities |= find_difference(&expected.state.velocities, &actual.state.velocities).is_some();
        let has_geometric = facts.passes.iter().any(|pass| matches!(pass.stage, Stage::Geometric { .. }));
        *(if has_geometric { &mut ran_out } else { &mut ended }) += 1;
        // The polynomials depend on the positions before the last pass, but not on velocities.
        or_response |= !facts.hits.iter().all(|hit| responses.are_right(hit.pair.kind));
    }
    let count = ran_out + ended;
    if count == 0 || 2 * count < wrong.len() {
        return None;
    }
    let quantity = match (positions, velocities) {
        (true, false) => Some(Quantity::Position),
        (false, true) => Some(Quantity::Velocity),
        _ => None,
    };
    let when = match (ran_out, ended) {
        (_, 0) => Some(LoopEnd::RanOut),
        (0, _) => Some(LoopEnd::Settled),
        _ => None,
    };
    Some(new_observation(StageFault::HandedOver { quantity, when, or_response }, Vec::new(), count))
}

/// The contacts of the first round, as the second pass of each step shows them.
#[derive(Default)]
struct SecondPass {
    /// The number of isolated contacts with right velocities afterwards.
    right: usize,
    /// The number of isolated contacts with wrong velocities afterwards.
    wrong: usize,
    /// The number of isolated contacts that changed nothing.
    unresolved: usize,
    contacts: usize,
}

impl SecondPass {
    fn compare(&mut self, scene: &Scene, facts: &StepFacts) {
        let Some(second) = facts.passes.get(1) else { return };
        let first: Vec<Pair> = facts.hits.iter().filter(|hit| hit.pass == 0).map(|hit| hit.pair).collect();
        for pair in &first {
            let own = pair_particles(scene, *pair);
            let touches = |other: &Pair| {
                other != pair && pair_particles(scene, *other).iter().any(|particle| own.contains(particle))
            };
            let leads_to = |positions: &[f64]| facts.fits_motion(scene, 1, positions, |other| other == *pair);
            self.contacts += 1;
            if leads_to(&second.end_positions) {
                self.right += usize::from(!first.iter().any(touches));
            } else if leads_to(&facts.prediction.positions) {
                self.unresolved += 1;
            } else {
                self.wrong += usize::from(!first.iter().any(touches));
            }
        }
    }
}

/// Returns the explanation of steps whose later rounds are wrong although the first one is right. Returns `None` if, in
/// one of the steps, the first pass is wrong or nothing collides.
fn explain_later_rounds(scene: &Scene, wrong: &[&StepFacts]) -> Option<Explanation> {
    let reaches = |passes: usize| {
        let is_right = |facts: &&StepFacts| facts.right_polynomials >= passes * facts.pass_size();
        wrong.iter().all(is_right) && wrong.iter().all(|facts| !facts.hits.is_empty())
    };
    if !reaches(1) {
        return None;
    }
    if reaches(2) {
        return Some(new_observation(StageFault::BehindFirstRound, Vec::new(), wrong.len()));
    }
    let mut second_pass = SecondPass::default();
    wrong.iter().filter(|facts| facts.logged_passes().is_some_and(|(passes, _)| passes > 1)).for_each(|facts| {
        second_pass.compare(scene, facts);
    });
    let fault = match second_pass {
        SecondPass { unresolved, contacts, .. } if unresolved > 0 => {
            StageFault::Unresolved { all: unresolved == contacts }
        }
        SecondPass { wrong: 0, right, .. } if right > 0 => StageFault::LaterRounds,
        _ => StageFault::FirstRound,
    };
    Some(new_observation(fault, Vec::new(), wrong.len()))
}
