//! Finds the stage of a step whose results are wrong although its contacts are right: the responses of
//! `continuous-time`, and the impulse rounds and the geometric part of `hybrid`.
//!
//! The polynomials of a round show the positions at its beginning, which are the result of the previous round.
use super::{Explanation, events::StepFacts, new_observation};
use crate::diagnose::{StageDetail, StageFault, WrongGeometric, WrongNumber};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::Stage,
};
use std::cmp::Ordering;

/// Returns the explanation of steps of `continuous-time` whose contacts are right, but not the states after them.
pub(super) fn explain_responses(facts: &[StepFacts]) -> Option<Explanation> {
    let is_seen = |facts: &&StepFacts| {
        facts.is_wrong && facts.is_continuous() && !facts.expected.end.impulses.is_empty() && facts.has_right_impulses()
    };
    let count = facts.iter().filter(is_seen).count();
    (count > 0).then(|| new_observation(StageFault::Responses, Vec::new(), count))
}

/// Returns the fault in the impulse rounds of `hybrid`, or in the part of the step after them.
pub(super) fn explain(scene: &Scene, facts: &[StepFacts]) -> Option<Explanation> {
    let Collision::Hybrid { max_iterations, .. } = scene.collision else { return None };
    let (after, wrong): (Vec<&StepFacts>, Vec<&StepFacts>) =
        facts.iter().filter(|facts| facts.is_wrong).partition(|facts| facts.has_right_mid_state());
    if !wrong.is_empty() {
        return explain_number(&wrong, max_iterations).or_else(|| explain_rounds(&wrong));
    }
    let after = after.iter().filter(|facts| !may_be_round_off(scene, facts)).count();
    if after == 0 {
        return None;
    }
    explain_geometric(facts).or_else(|| Some(new_observation(StageFault::AfterRounds, Vec::new(), after)))
}

/// Returns the explanation of steps that log right polynomials, but too many or too few of them.
fn explain_number(wrong: &[&StepFacts], max_iterations: i32) -> Option<Explanation> {
    let mut seen: Vec<(usize, usize)> = Vec::new();
    for facts in wrong {
        let (Some((passes, _)), Some((expected, actual))) = (facts.logged_passes(), facts.mid_states()) else {
            continue;
        };
        let counts = (expected.polynomials.len() / facts.pass_size(), passes);
        if counts.0 != counts.1 && facts.right_polynomials >= expected.polynomials.len().min(actual.polynomials.len()) {
            seen.push(counts);
        }
    }
    let sort = |ordering: Ordering| seen.iter().filter(|(ours, theirs)| theirs.cmp(ours) == ordering).count();
    // Most of the faults must be of this kind; the other faults may follow from it.
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
    Some(new_observation(StageFault::Rounds(number), details, seen.len()))
}

/// Returns the explanation of wrong states after the rounds, by the first round whose polynomials are wrong.
fn explain_rounds(wrong: &[&StepFacts]) -> Option<Explanation> {
    let is_handed_over = |facts: &&&StepFacts| {
        facts.mid_states().is_some_and(|(expected, actual)| {
            let count = expected.polynomials.len();
            actual.polynomials.len() == count && facts.right_polynomials >= count
        })
    };
    let reaches = |passes: usize| wrong.iter().all(|facts| facts.right_polynomials >= passes * facts.pass_size());
    let has_contacts = wrong.iter().all(|facts| !facts.hits.is_empty());
    let fault = match () {
        () if 2 * wrong.iter().filter(is_handed_over).count() >= wrong.len() => StageFault::HandedOver,
        () if has_contacts && reaches(2) => StageFault::LaterRounds,
        () if has_contacts && reaches(1) => StageFault::FirstRound,
        () => return None,
    };
    Some(new_observation(fault, Vec::new(), wrong.len()))
}

/// Returns the fault in the decision whether the geometric part follows, if the impulse rounds are right.
fn explain_geometric(facts: &[StepFacts]) -> Option<Explanation> {
    let (mut left, mut superfluous, mut followed) = (0, 0, 0);
    for facts in facts.iter().filter(|facts| facts.has_right_mid_state()) {
        let ran_out = facts.passes.iter().any(|pass| matches!(pass.stage, Stage::Geometric { .. }));
        match (ran_out, facts.logged_passes()) {
            (true, Some((_, 0))) => left += 1,
            (true, Some(_)) => followed += 1,
            (false, Some((_, passes))) if passes > 0 => superfluous += 1,
            _ => {}
        }
    }
    let (wrong, count) = match (left, superfluous) {
        (0, 0) => return None,
        (0, _) => (WrongGeometric::Superfluous, superfluous),
        _ => (WrongGeometric::Left { always: followed == 0 }, left),
    };
    Some(new_observation(StageFault::Geometric(wrong), Vec::new(), count))
}

/// Returns whether the first geometric pass differs only by round-off. It is right for the positions after the rounds.
/// These are right up to round-off, on which small coefficients depend.
fn may_be_round_off(scene: &Scene, facts: &StepFacts) -> bool {
    let Some((_, middle)) = facts.mid_states().filter(|_| facts.logged_passes().is_some()) else { return false };
    let (rounds, pass) = (middle.polynomials.len(), facts.pass_size());
    let differs = facts.right_polynomials < (rounds + pass).min(facts.expected.end.polynomials.len());
    differs && facts.fits_motion(scene, rounds / pass, &middle.state.positions)
}
