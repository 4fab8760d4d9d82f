//! Examines the changes that isolated contacts cause, body by body.
use super::{
    Explanation, RATIO_TOLERANCE, common_value,
    events::{Hit, StepFacts},
    new_observation, ratios,
};
use crate::diagnose::{
    Amount, ChangedQuantity, Quantity, StageDetail, StageFault, WrongResponses, sampling::pair_particles,
};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{PairKind, Stage, State},
};
use fosssim_num::vector::{Vec2, length, unit, vector_at};
use std::collections::BTreeMap;

/// The size below which changes count as round-off, relative to the numbers or 1, whichever is larger.
const ROUND_OFF_LIMIT: f64 = 1e-11;

/// The change caused by a contact.
#[derive(Debug, Clone, Copy)]
struct Change {
    /// The ratio of the actual to the expected change along the contact vector, or `None` if no change is expected.
    ratio: Option<f64>,
    /// Whether the component perpendicular to the contact vector also changed.
    changes_across: bool,
    is_right: bool,
}

/// The changes caused by isolated contacts, whose bodies have no other contact in the step.
pub(super) struct Responses {
    changes: BTreeMap<ChangedQuantity, Vec<Change>>,
    contacts: usize,
    /// The number of contacts of impulse rounds that changed nothing. It is unknown whether the program found them.
    unresolved: usize,
    has_rounds: bool,
}

impl Responses {
    pub(super) fn new(scene: &Scene, facts: &[StepFacts]) -> Self {
        let has_rounds = matches!(scene.collision, Collision::Hybrid { .. });
        let mut all = Self { changes: BTreeMap::new(), contacts: 0, unresolved: 0, has_rounds };
        for facts in facts {
            for (hit, expected, actual) in find_isolated(scene, facts) {
                let mut changes: Vec<(ChangedQuantity, Change)> = Vec::new();
                for (body, particle) in pair_particles(scene, hit.pair).into_iter().enumerate() {
                    for quantity in [Quantity::Position, Quantity::Velocity] {
                        let states = [&facts.prediction, expected, actual];
                        let change = measure_change(particle, quantity, states, unit(hit.normal));
                        changes.push((ChangedQuantity { kind: hit.pair.kind, body, quantity }, change));
                    }
                }
                let is_nothing =
                    |change: &Change| !change.changes_across && change.ratio.is_none_or(|ratio| ratio == 0.0);
                if !facts.is_continuous() && changes.iter().all(|(_, change)| is_nothing(change)) {
                    all.unresolved += 1;
                    continue;
                }
                all.contacts += 1;
                for (quantity, change) in changes {
                    all.changes.entry(quantity).or_default().push(change);
                }
            }
        }
        all
    }

    /// Returns whether there are isolated contacts of this kind, and all are right.
    pub(super) fn are_right(&self, kind: PairKind) -> bool {
        let kind_changes = || self.changes.iter().filter(|(changed, _)| changed.kind == kind);
        kind_changes().next().is_some()
            && kind_changes().all(|(_, changes)| changes.iter().all(|change| change.is_right))
    }

    /// Returns the fault in responses, or `None` if all visible responses are right.
    pub(super) fn explain(&self, facts: &[StepFacts]) -> Option<Explanation> {
        let changes = &self.changes;
        let wrong: BTreeMap<ChangedQuantity, Vec<Change>> = changes
            .iter()
            .map(|(place, all)| (*place, all.iter().filter(|change| !change.is_right).copied().collect::<Vec<_>>()))
            .filter(|(_, wrong)| !wrong.is_empty())
            .collect();
        if wrong.is_empty() {
            return explain_several_contacts(facts).or_else(|| self.explain_unresolved());
        }
        let mut kinds: Vec<PairKind> = wrong.keys().map(|changed| changed.kind).collect();
        kinds.dedup();
        let kind = match kinds[..] {
            [kind] if changes.keys().any(|other| other.kind != kind) => Some(kind),
            _ => None,
        };
        let whose = || wrong.keys().copied().collect();
        let what = if wrong.values().flatten().all(|change| !change.changes_across && change.ratio == Some(0.0)) {
            let are_all_wrong = wrong.len() == changes.keys().filter(|changed| kinds.contains(&changed.kind)).count();
            if are_all_wrong { WrongResponses::Nothing } else { WrongResponses::Unchanged(whose()) }
        } else if wrong.values().flatten().any(|change| change.changes_across) {
            WrongResponses::Across(whose())
        } else {
            WrongResponses::Amount(whose())
        };
        let details =
            wrong.iter().map(|(changed, wrong)| describe_change(*changed, wrong, changes[changed].len())).collect();
        Some(new_observation(
            StageFault::Responses { kind, wrong: what, only_in_rounds: self.has_rounds },
            details,
            self.contacts,
        ))
    }

    /// Returns the explanation that impulse rounds do not resolve some contacts, or `None` if they resolve all.
    fn explain_unresolved(&self) -> Option<Explanation> {
        let fault = StageFault::Unresolved { all: self.contacts == 0 };
        (self.unresolved > 0).then(|| new_observation(fault, Vec::new(), self.unresolved))
    }
}

/// Returns the contacts of a step whose bodies have no other contact, with the expected and the actual state after
/// them.
fn find_isolated<'a>(scene: &'a Scene, facts: &'a StepFacts) -> Vec<(&'a Hit, &'a State, &'a State)> {
    let round_count = facts.passes.iter().filter(|pass| !matches!(pass.stage, Stage::Geometric { .. })).count();
    let hits = || facts.hits.iter().filter(move |hit| hit.pass < round_count);
    let is_alone = |hit: &&Hit| {
        let own = pair_particles(scene, hit.pair);
        let touches = |other: &Hit| {
            other.detection_index != hit.detection_index
                && pair_particles(scene, other.pair).iter().any(|particle| own.contains(particle))
        };
        !hits().any(touches) && is_final(scene, facts, hit)
    };
    let (expected, actual) = match facts.passes.first().map(|pass| pass.stage) {
        Some(Stage::ContinuousTime) if !facts.has_right_impulses() => return Vec::new(),
        Some(Stage::ContinuousTime) => (&facts.expected.end.state, &facts.actual.end.state),
        Some(Stage::Impulses { .. }) => {
            let Some((expected, actual)) = facts.mid_states() else { return Vec::new() };
            // If a loop has used all its rounds, its result is checked separately.
            let ran_out = round_count < facts.passes.len();
            if ran_out || expected.polynomials.len() != actual.polynomials.len() {
                return Vec::new();
            }
            (&expected.state, &actual.state)
        }
        _ => return Vec::new(),
    };
    hits().filter(is_alone).map(|hit| (hit, expected, actual)).collect()
}

/// Returns whether the bodies of an impulse round's contact do not change again: all later passes use the positions
/// after the loop. The result is also `true` if the trace does not contain these positions.
fn is_final(scene: &Scene, facts: &StepFacts, hit: &Hit) -> bool {
    let (Some((passes, _)), Some((_, middle))) = (facts.logged_passes(), facts.mid_states()) else { return true };
    facts.is_continuous()
        || (hit.pass + 1..passes)
            .all(|pass| facts.fits_motion(scene, pass, &middle.state.positions, |pair| pair == hit.pair))
}

/// Returns the explanation of steps with several contacts, if each contact alone is right but the state is wrong.
fn explain_several_contacts(facts: &[StepFacts]) -> Option<Explanation> {
    let is_right = |facts: &&StepFacts| {
        facts.is_wrong
            && facts.is_continuous()
            && !facts.expected.end.impulses.is_empty()
            && facts.right_polynomials >= facts.expected.end.polynomials.len()
            && facts.has_right_impulses()
    };
    let count = facts.iter().filter(is_right).count();
    (count > 0).then(|| new_observation(StageFault::ManyContacts, Vec::new(), count))
}

fn measure_change(particle: usize, quantity: Quantity, states: [&State; 3], u: Vec2) -> Change {
    let [before, expected, actual] = states.map(|state: &State| match quantity {
        Quantity::Position => vector_at(&state.positions, particle),
        Quantity::Velocity => vector_at(&state.velocities, particle),
    });
    let (ours, theirs) = (expected - before, actual - before);
    let small = ROUND_OFF_LIMIT * (1.0 + length(before) + length(expected));
    let component = theirs.dot(&u);
    Change {
        ratio: (length(ours) > 100.0 * small).then(|| {
            let ratio = component / ours.dot(&u);
            if component.abs() <= small { 0.0 } else { ratio }
        }),
        changes_across: length(theirs - component * u) > small.max(RATIO_TOLERANCE * length(ours)),
        is_right: length(theirs - ours) <= small.max(RATIO_TOLERANCE * length(ours)),
    }
}

fn describe_change(changed: ChangedQuantity, wrong: &[Change], contacts: usize) -> StageDetail {
    let component_ratios: Vec<f64> = wrong.iter().filter_map(|change| change.ratio).collect();
    let amount = match common_value(&component_ratios) {
        _ if component_ratios.is_empty() => Amount::Unwanted,
        Some(ratio) if ratio == 1.0 || (ratio - 1.0).abs() <= RATIO_TOLERANCE => Amount::Right,
        _ => Amount::Ratio(ratios(&component_ratios)),
    };
    let across = wrong.iter().any(|change| change.changes_across);
    StageDetail::Change { changed, amount, across, wrong: wrong.len(), of: contacts }
}
