//! Compares every decision of whole simulations with the certified and the exact decision.
use super::built_in;
use fosssim_oracle::{
    num::{
        bounded::BoundedValue,
        decision::{
            HitCertainty, decide,
            exact::{ExactAnswer, find_exact_first_time},
        },
        polynomial::Polynomial,
        tolerances::FAIR_UNITS,
    },
    scene::Scene,
    sim::{Decision, Detection, Observer, RootSearch, Simulation},
};
use rayon::prelude::*;

/// The counts of how the decisions of a scene compare.
#[derive(Debug, Default, Clone)]
struct Tally {
    /// The decisions are certainly the same.
    same: u64,
    /// The decisions depend on round-off.
    borderline: u64,
    /// The answers differ because `c t^m` counts as nowhere positive in the original (root-finder.md 17.1).
    alone: u64,
    /// The number of decisions that were computed with integers.
    exact: u64,
    /// Answers that differ without an explanation.
    unexplained: Vec<String>,
    /// Cases in which the certified and the exact decision differ.
    contradictions: Vec<String>,
}

/// Returns whether the polynomial is one term with a power of t.
fn is_alone(polynomial: &Polynomial) -> bool {
    let list = polynomial.coefficients();
    list.len() > 1 && list[1..].iter().all(|&c| c == 0.0)
}

impl Observer for Tally {
    fn observe_detection(&mut self, detection: &Detection<'_>) {
        let polynomials = detection.polynomials;
        if polynomials.is_empty() {
            return;
        }
        let is_hit = matches!(detection.decision, Decision::Hit { .. });
        let lists: Vec<Vec<BoundedValue>> = polynomials
            .iter()
            .map(|polynomial| {
                polynomial.coefficients().iter().map(|&c| BoundedValue { value: c, bound: c.abs() }).collect()
            })
            .collect();
        let slices: Vec<&[BoundedValue]> = lists.iter().map(|list| &list[..]).collect();
        let certainty = decide(&slices, FAIR_UNITS).certainty;
        // Integers take long, so only near cases, hits and a few others are computed.
        let number = self.same + self.borderline;
        if is_hit || certainty != HitCertainty::Misses || number.is_multiple_of(64) {
            self.exact += 1;
            let slices: Vec<&[f64]> = polynomials.iter().map(Polynomial::coefficients).collect();
            let exact = matches!(find_exact_first_time(&slices), ExactAnswer::First { .. });
            if certainty == HitCertainty::Hits && !exact || certainty == HitCertainty::Misses && exact {
                self.contradictions.push(format!("{:?} {slices:?}", detection.pair));
            }
        }
        match certainty {
            HitCertainty::Borderline => self.borderline += 1,
            certainty if (certainty == HitCertainty::Hits) == is_hit => self.same += 1,
            HitCertainty::Hits if polynomials.iter().any(is_alone) => self.alone += 1,
            certainty => {
                let lists: Vec<&[f64]> = polynomials.iter().map(Polynomial::coefficients).collect();
                self.unexplained.push(format!("{:?} {certainty:?} {:?} {lists:?}", detection.pair, detection.decision));
            }
        }
    }
}

fn tally(scene: &Scene) -> Tally {
    let mut tally = Tally::default();
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    for _ in 0..scene.step_count() {
        simulation.step(&mut tally).expect("an ordinary step");
    }
    tally
}

#[test]
fn decisions_of_whole_simulations_are_the_exact_ones() {
    let tallies: Vec<(&str, Tally)> = built_in().par_iter().map(|(name, scene)| (*name, tally(scene))).collect();
    for (name, tally) in &tallies {
        assert!(tally.contradictions.is_empty(), "{name}: {:#?}", tally.contradictions);
        assert!(tally.unexplained.is_empty(), "{name}: {:#?}", tally.unexplained);
    }
    let sum = |part: fn(&Tally) -> u64| tallies.iter().map(|(_, tally)| part(tally)).sum::<u64>();
    let (same, borderline, exact) = (sum(|one| one.same), sum(|one| one.borderline), sum(|one| one.exact));
    let alone = sum(|one| one.alone);
    assert!(same > 30_000 && exact > 1000, "{same} {exact}");
    assert!((borderline + alone) * 100 < same, "{borderline} borderline and {alone} alone of {same}");
}
