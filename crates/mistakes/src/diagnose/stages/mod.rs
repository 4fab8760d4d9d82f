//! Which stage of a step is wrong, where no mistake that is known explains it.
//!
//! What a trace holds of a stage follows from what it holds of the one before: polynomials from the state, contacts from the
//! polynomials, the state in the middle from the contacts, zones from that state. So the first stage whose results are wrong although
//! everything before is right is the one to look at, and what its results have in common (a factor, a kind of pair, a
//! body) says where. These are observations and no guesses: nothing is said of a stage that something before it may have
//! spoilt, and nothing where a polynomial is wrong whose inputs are known.
mod contacts;
mod loops;
mod responses;
mod rigid;
mod story;

use super::{
    Explanation,
    about::{About, StepStage},
    known::{ROUND_OFF, Sample, first_difference, same_polynomial},
};
use fosssim_model::scene::{Collision, Scene};
use story::{Facts, Teller};

/// So many steps are looked at.
const MOST_STEPS: usize = 120;

/// And so many polynomials; about a microsecond each.
const WORK: usize = 200_000;

/// Ratios that are this close are the same.
const ALIKE: f64 = 1e-6;

/// What can be said of the stages of these steps; nothing when polynomials whose inputs are known are wrong, or when nothing
/// is.
pub(super) fn explain<'a>(scene: &Scene, samples: impl Iterator<Item = &'a Sample>) -> Option<Explanation> {
    if !matches!(scene.collision, Collision::ContinuousTime { .. } | Collision::Hybrid { .. }) {
        return None;
    }
    let mut teller = Teller::new(scene);
    let mut work = 0;
    let facts: Vec<Facts> = samples
        .take(MOST_STEPS)
        .take_while(|sample| {
            let goes_on = work < WORK;
            work += sample.records.end.polynomials.len();
            goes_on
        })
        .filter_map(|sample| teller.tell(sample))
        .collect();
    if facts.iter().all(|facts| !facts.is_wrong) {
        return None;
    }
    if let Some(order) = contacts::order(&facts) {
        return Some(order);
    }
    if facts.iter().any(|facts| facts.has_wrong_formula) {
        return None;
    }
    let responses = responses::Responses::new(scene, &facts);
    contacts::detection(&facts)
        .or_else(|| responses.explain(&facts))
        .or_else(|| loops::explain(scene, &facts, &responses))
        .or_else(|| rigid::explain(scene, &facts))
}

/// An observation, which reproduces nothing.
fn observation(stage: StepStage, key: &str, what: String, details: Vec<String>, samples: usize) -> Explanation {
    Explanation {
        key: key.to_owned(),
        about: About::Stage(stage),
        what,
        details,
        reproduced: 0,
        samples: samples as u64,
        example: None,
        same_as: Vec::new(),
    }
}

/// The value that all have in common, to round-off.
fn common_value(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = *sorted.get(sorted.len() / 2)?;
    let is_alike = |value: &f64| (value - middle).abs() <= ALIKE * (1.0 + middle.abs());
    (middle.is_finite() && values.iter().all(is_alike)).then_some(middle)
}

/// Ratios in words: "1.5 times" where they agree, else their range.
fn times(ratios: &[f64]) -> String {
    let short = |value: f64| {
        let text = format!("{value:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    if let Some(ratio) = common_value(ratios) {
        return format!("{} times", short(ratio));
    }
    let (low, high) =
        ratios.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &r| (low.min(r), high.max(r)));
    format!("{} to {} times", short(low), short(high))
}

/// The first letter in upper case.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    first + letters.as_str()
}
