//! Finds the faults of a contest's search for nearby pairs.
//!
//! The search is the only code that a contest's student writes, so the force and the integrator are never named. The
//! fair rules find how many times a step applied the force of each nearby pair. The [trait](trait_table) that best
//! distinguishes wrong pairs from right ones shows where the search fails. All traces of a program are counted
//! together.
mod geometry;
mod trait_table;

use super::{
    Detail, Explanation, PairCounts, WrongPairs,
    sampling::{Reference, Scan},
    topic::ExplanationTopic,
};
use fosssim_judge::fair::count_applications;
use fosssim_model::{
    scene::Scene,
    sim::{Pair, PairKind},
};
use fosssim_student::Area;
use geometry::{PlacedPair, StepGeometry};
use std::collections::BTreeSet;
use trait_table::{TraitVariant, variants};

/// The maximum number of examined wrong steps. Four times as many right steps are examined.
const MAX_STEPS: usize = 24;

/// The maximum number of pairs times bodies that are examined in a trace, because some traits depend on all bodies
/// between two.
const MAX_WORK: usize = 4_000_000;

/// The maximum probability that wrong pairs share a reported trait by chance. For each row, this limit is divided by
/// the number of the row's variants.
const MAX_CHANCE_PROBABILITY: f64 = 2e-3;

/// One in this many wrong pairs may lack a trait that the others have in common.
const PAIRS_PER_EXCEPTION: u64 = 20;

/// The maximum number of reported traits, if several distinguish pairs equally well.
const MAX_TRAITS: usize = 3;

/// A trait that wrong pairs have in common.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PairTrait {
    /// The trait in plain words.
    pub description: String,
    /// The trait as an exact condition.
    pub exact_condition: String,
    /// The number of right pairs that also have the trait.
    pub right_pairs: u64,
    /// The number of wrong pairs that lack the trait.
    pub exceptions: u64,
}

/// Returns the explanation with the nearby pairs whose force the steps omit, apply once or apply twice. Returns `None`
/// if no pair is omitted or applied twice.
pub(super) fn explain_pairs(reference: &mut Reference<'_>, scene: &Scene, scan: &Scan) -> Option<Explanation> {
    let steps = scan.wrong_steps.iter().take(MAX_STEPS).chain(scan.right_steps.iter().take(MAX_STEPS / 4));
    let mut remaining_work = MAX_WORK / (scene.particles.len() + scene.edges.len() + 1);
    let variants: Vec<TraitVariant> = variants().collect();
    let no_counts = |kind| PairCounts { kind, counts_by_times: [0; 3], traits: vec![[0; 3]; variants.len()] };
    let mut wrong = WrongPairs { first: None, counts_by_kind: PairKind::ALL.map(no_counts).into() };
    let mut seen_pairs: BTreeSet<(Pair, usize)> = BTreeSet::new();
    for kept_step in steps {
        let own = reference.step(kept_step.step, &kept_step.before, &mut ())?;
        let moment = StepGeometry::new(scene, &kept_step.before);
        for (pair, times) in count_applications(scene, &kept_step.before, own, &kept_step.records.end.state) {
            if remaining_work == 0 || !seen_pairs.insert((pair, times)) {
                continue;
            }
            remaining_work -= 1;
            if times != 1 && wrong.first.is_none_or(|(_, step)| kept_step.step < step) {
                wrong.first = Some((pair, kept_step.step));
            }
            let placed = PlacedPair { geometry: &moment, pair };
            let counts = &mut wrong.counts_by_kind[pair.kind as usize];
            counts.counts_by_times[times] += 1;
            let matching_traits = variants.iter().zip(&mut counts.traits).filter(|(variant, _)| variant.holds(&placed));
            matching_traits.for_each(|(_, counts)| counts[times] += 1);
        }
    }
    wrong.first?;
    let samples = scan.wrong_steps.len() as u64;
    Some(Explanation {
        details: vec![Detail::SearchArea(Area::NearPairs)],
        reproduced: samples,
        samples,
        ..Explanation::with_topic(Explanation::PAIRS, ExplanationTopic::Pairs(wrong))
    })
}

/// Returns the traits by which pairs that are applied `times` times (0 or 2) differ from pairs that are applied once.
/// If there are several, those with the fewest exceptions are returned.
#[expect(clippy::cast_precision_loss, reason = "a share")]
pub fn pair_traits(pairs: &PairCounts, times: usize) -> Vec<PairTrait> {
    let (wrong, right) = (pairs.counts_by_times[times], pairs.counts_by_times[1]);
    let counts = variants().zip(&pairs.traits).map(|(variant, counts)| (variant, wrong - counts[times], counts[1]));
    let is_telling = |(variant, exceptions, with): &(TraitVariant, u64, u64)| {
        // The probability that this many randomly chosen pairs all have the trait. Pairs of a scene resemble each
        // other, so the larger group counts only as much as the smaller one.
        let chance: f64 =
            (1..=(wrong - exceptions).min(right)).map(|i| (with + i) as f64 / (right + i) as f64).product();
        PAIRS_PER_EXCEPTION * exceptions <= wrong
            && 2 * with <= right
            && chance * (variant.row.variant_count() as f64) < MAX_CHANCE_PROBABILITY
    };
    let telling: Vec<_> = counts.filter(is_telling).collect();
    let Some(minimum) = telling.iter().map(|(_, exceptions, with)| exceptions + with).min() else { return Vec::new() };
    let mut reported: Vec<(TraitVariant, u64, u64)> = Vec::new();
    for one in telling.into_iter().filter(|(_, exceptions, with)| exceptions + with == minimum) {
        // Only the strictest variant of a row is reported.
        reported.retain(|other| !std::ptr::eq(other.0.row, one.0.row));
        reported.push(one);
    }
    let as_told = |(variant, exceptions, right): (TraitVariant, u64, u64)| PairTrait {
        description: variant.describe(),
        exact_condition: variant.exact_condition(),
        right_pairs: right,
        exceptions,
    };
    reported.into_iter().take(MAX_TRAITS).map(as_told).collect()
}

/// Adds the pairs of all traces together for the explanations of a program.
pub(super) fn merge_explanations(reported: &mut [Explanation], traces: &[&[Explanation]]) {
    for one in reported.iter_mut() {
        let ExplanationTopic::Pairs(sum) = &mut one.topic else { continue };
        let mut all = traces.iter().copied().flatten().filter_map(|explanation| match &explanation.topic {
            ExplanationTopic::Pairs(wrong) => Some(wrong),
            _ => None,
        });
        let Some(first) = all.next() else { continue };
        *sum = first.clone();
        all.for_each(|other| sum.add(other));
    }
}

#[cfg(test)]
mod tests;
