//! The impulse rounds of `hybrid`: how many there are, and what they hand over.
use super::{ALIKE, Explanation, events::Facts, observation, responses::Responses};
use crate::diagnose::{LoopEnd, Quantity, StageDetail, StageFault, WrongNumber, known::ROUND_OFF};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::Stage,
};
use std::cmp::Ordering;

/// What is wrong with the impulse rounds, whose single contacts are right.
pub(super) fn explain(scene: &Scene, facts: &[Facts], responses: &Responses) -> Option<Explanation> {
    let Collision::Hybrid { max_iterations, .. } = scene.collision else { return None };
    let wrong: Vec<&Facts> = facts.iter().filter(|facts| facts.is_wrong && !facts.has_right_middle()).collect();
    if wrong.is_empty() {
        return None;
    }
    rounds(&wrong, max_iterations).or_else(|| handed_over(&wrong)).or_else(|| later(&wrong, responses))
}

/// Expected and actual numbers of detection passes in the loop.
fn counts(facts: &Facts) -> Option<(usize, usize)> {
    let (expected, actual) = facts.middles()?;
    let size = facts.pass_size().max(1);
    if !actual.polynomials.len().is_multiple_of(size) {
        return None;
    }
    Some((expected.polynomials.len() / size, actual.polynomials.len() / size))
}

/// Steps whose polynomials are right as far as they go, but of which there are too many or too few.
fn rounds(wrong: &[&Facts], max_iterations: i32) -> Option<Explanation> {
    let mut seen: Vec<(usize, usize)> = Vec::new();
    for facts in wrong {
        let (Some(counts), Some((expected, actual))) = (counts(facts), facts.middles()) else { continue };
        if counts.0 != counts.1 && facts.right_polynomials >= expected.polynomials.len().min(actual.polynomials.len()) {
            seen.push(counts);
        }
    }
    let sort = |ordering: Ordering| seen.iter().filter(|(ours, theirs)| theirs.cmp(ours) == ordering).count();
    // Most of what is wrong has to be of this sort; the rest may follow from it.
    if seen.is_empty() || 2 * seen.len() < wrong.len() {
        return None;
    }
    let number = match (sort(Ordering::Less), sort(Ordering::Greater)) {
        (_, 0) => WrongNumber::Fewer,
        (0, _) => WrongNumber::More,
        _ => WrongNumber::Other,
    };
    let mut details: Vec<StageDetail> = Vec::new();
    for &(expected, actual) in &seen {
        let line = StageDetail::Passes { expected, actual, most: max_iterations };
        if !details.contains(&line) && details.len() < 3 {
            details.push(line);
        }
    }
    Some(observation(StageFault::Rounds(number), details, seen.len()))
}

/// Steps whose polynomials are all right, but not the state behind the loop.
fn handed_over(wrong: &[&Facts]) -> Option<Explanation> {
    let (mut ran_out, mut ended, mut positions, mut velocities) = (0, 0, false, false);
    for facts in wrong {
        let Some((expected, actual)) = facts.middles() else { continue };
        let all = expected.polynomials.len();
        if actual.polynomials.len() != all || facts.right_polynomials < all {
            continue;
        }
        let differs = |ours: &[f64], theirs: &[f64]| {
            let within = ROUND_OFF.state.max(ALIKE * 1e-3);
            ours.iter().zip(theirs).any(|(ours, theirs)| !((ours - theirs).abs() <= within * (1.0 + ours.abs())))
        };
        positions |= differs(&expected.state.positions, &actual.state.positions);
        velocities |= differs(&expected.state.velocities, &actual.state.velocities);
        let has_geometric = facts.passes.iter().any(|pass| matches!(pass.stage, Stage::Geometric { .. }));
        *(if has_geometric { &mut ran_out } else { &mut ended }) += 1;
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
    Some(observation(StageFault::HandedOver { quantity, when }, Vec::new(), count))
}

/// Steps whose later rounds are wrong though their first one is right.
fn later(wrong: &[&Facts], responses: &Responses) -> Option<Explanation> {
    let is_later = |facts: &&Facts| facts.right_polynomials >= facts.pass_size() && !facts.hits.is_empty();
    if !wrong.iter().all(is_later) {
        return None;
    }
    let is_right = |facts: &&Facts| facts.hits.iter().all(|hit| responses.is_right(hit.pair.kind));
    let fault = if wrong.iter().any(is_right) { StageFault::LaterRounds } else { StageFault::FirstRound };
    Some(observation(fault, Vec::new(), wrong.len()))
}
