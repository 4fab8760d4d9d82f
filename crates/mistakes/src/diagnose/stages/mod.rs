//! Finds the wrong stage of a step if no known mistake explains it.
//!
//! In a trace the results of a stage follow from those of the previous stage. Polynomials follow from the state,
//! contacts from the polynomials, the state in the middle from the contacts, and zones from that state. Therefore the
//! stage to check is the first one whose results are wrong although everything before is right. The features that its
//! wrong results have in common (a factor, a kind of pair, a body) show what to check. The results are observations,
//! not guesses. No stage is reported if an earlier one may have affected it, or if a polynomial with known inputs is
//! wrong.
mod contacts;
mod events;
mod responses;
mod rigid;
mod rounds;
mod states;
mod zones;

use super::{
    Detail, Explanation, Ratios, StageDetail,
    fault::StageFault,
    sampling::{KeptStep, Reference},
    topic::ExplanationTopic,
};
use events::StepFacts;
use fosssim_model::scene::{Collision, Scene};

/// The maximum number of steps that are compared.
const MAX_STEPS: usize = 120;

/// The maximum number of polynomials that are compared. Comparing one takes about a microsecond.
const MAX_POLYNOMIALS: usize = 200_000;

/// The relative difference below which ratios are equal.
const RATIO_TOLERANCE: f64 = 1e-6;

/// Returns the observation about the stages of `steps`. Returns `None` if polynomials with known inputs are wrong, or
/// if nothing is wrong.
pub(super) fn explain<'a>(
    reference: &mut Reference<'_>,
    scene: &Scene,
    steps: impl Iterator<Item = &'a KeptStep>,
) -> Option<Explanation> {
    if !matches!(scene.collision, Collision::ContinuousTime { .. } | Collision::Hybrid { .. }) {
        return states::explain(reference, scene, steps);
    }
    let mut work = 0;
    let facts: Vec<StepFacts> = steps
        .take(MAX_STEPS)
        .take_while(|kept| {
            let goes_on = work < MAX_POLYNOMIALS;
            work += kept.records.end.polynomials.len();
            goes_on
        })
        .filter_map(|kept| StepFacts::for_step(reference, scene, kept))
        .collect();
    if facts.iter().all(|facts| !facts.is_wrong) {
        return None;
    }
    if let Some(pairs) = contacts::explain_order(&facts).or_else(|| contacts::explain_skipped_pairs(&facts)) {
        return Some(pairs);
    }
    if facts.iter().any(|facts| facts.has_wrong_formula()) {
        return None;
    }
    let responses = responses::Responses::new(scene, &facts);
    contacts::explain_detection(&facts)
        .or_else(|| responses.explain(&facts))
        .or_else(|| rounds::explain_impulse_rounds(scene, &facts, &responses))
        .or_else(|| rigid::explain_geometric_part(scene, &facts))
}

/// Returns an observation, which reproduces nothing.
fn new_observation(fault: StageFault, details: Vec<StageDetail>, samples: usize) -> Explanation {
    Explanation {
        details: details.into_iter().map(Detail::Stage).collect(),
        samples: samples as u64,
        ..Explanation::with_topic(fault.key(), ExplanationTopic::Stage(fault))
    }
}

/// Returns the value to which all of `values` are equal up to round-off, if there is one.
fn common_value(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = *sorted.get(sorted.len() / 2)?;
    let is_alike = |value: &f64| (value - middle).abs() <= RATIO_TOLERANCE * (1.0 + middle.abs());
    (middle.is_finite() && values.iter().all(is_alike)).then_some(middle)
}

/// Returns the ratio that all values share, or otherwise the range of the ratios.
fn ratios(values: &[f64]) -> Ratios {
    let (low, high) = range(values.iter().copied());
    common_value(values).map_or(Ratios::Between(low, high), Ratios::All)
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}
