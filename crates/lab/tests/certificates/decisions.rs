//! Compares certified decisions with those of the root finder: the number of decisions of each level, and the number
//! and reasons of differences.
use std::fmt::Write as _;

use fosssim_oracle::num::{
    bounded::BoundedValue,
    decision::{HitCertainty, Level, decide},
    polynomial::Polynomial,
};

/// The number of rounding units that the fair rules allow.
const FAIR_ROUNDING_UNITS: f64 = 64.0;

/// The reasons why the root finder and the certified decision differ: intentional rules of the original, or its
/// rounding.
const DIFFERENCE_REASONS: [&str; 3] = [
    "c t^m counts as nowhere positive in the original",
    "the original drops small leading coefficients",
    "the search rounds",
];

/// The descriptions of the decisions' levels, in order.
const LEVEL_NAMES: [&str; Level::ALL.len()] =
    ["signs of coefficients", "Bernstein coefficients", "subintervals of the step", "exact arithmetic"];

/// Returns the result of the search as text.
pub(super) fn describe_time(time: Option<f64>) -> String {
    match time {
        None => "the search never ends".to_owned(),
        Some(time) if time.is_infinite() => "the search finds no impact".to_owned(),
        Some(time) => format!("the search finds an impact at {time}"),
    }
}

/// Certified decisions of one pair type, compared with those of the root finder.
#[derive(Default)]
pub(super) struct Decisions {
    levels: [u64; Level::ALL.len()],
    certainties: [u64; 3],
    /// The differences by reason: `[certainly no, but the search hits; certainly yes, but it does not]`.
    differ: [[u64; 2]; DIFFERENCE_REASONS.len()],
    first: [Option<(u64, String)>; DIFFERENCE_REASONS.len()],
}

impl Decisions {
    /// Compares one detection with the root finder's result, which is missing if its search did not end.
    pub(super) fn compare(
        &mut self,
        index: u64,
        geometry: &str,
        lists: &[Vec<BoundedValue>],
        polynomials: &[Polynomial],
        time: Option<f64>,
    ) {
        let slices: Vec<&[BoundedValue]> = lists.iter().map(Vec::as_slice).collect();
        let decision = decide(&slices, FAIR_ROUNDING_UNITS);
        self.levels[decision.level as usize] += 1;
        self.certainties[decision.certainty as usize] += 1;
        let Some(time) = time else { return };
        if decision.certainty == HitCertainty::Borderline || (time <= 1.0) == (decision.certainty == HitCertainty::Hits)
        {
            return;
        }
        let monomial = |polynomial: &Polynomial| match polynomial.coefficients() {
            [first, rest @ ..] => !rest.is_empty() && *first > 0.0 && rest.iter().all(|&value| value == 0.0),
            [] => false,
        };
        let dropped = |(list, polynomial): (&Vec<BoundedValue>, &Polynomial)| {
            let kept = polynomial.coefficients().len();
            list[..list.len() - kept].iter().any(|coefficient| coefficient.value != 0.0)
        };
        let reason = if polynomials.iter().any(monomial) {
            0
        } else if lists.iter().zip(polynomials).any(dropped) {
            1
        } else {
            2
        };
        self.differ[reason][usize::from(decision.certainty == HitCertainty::Hits)] += 1;
        if self.first[reason].as_ref().is_none_or(|&(first, _)| index < first) {
            let coefficients: Vec<&[f64]> = polynomials.iter().map(Polynomial::coefficients).collect();
            let decided = decision.time.map_or("certainly no impact".to_owned(), |[from, to]| {
                format!("certainly an impact between {from} and {to}")
            });
            let words = format!("{geometry}: {decided}, but {}\n      {coefficients:?}", describe_time(Some(time)));
            self.first[reason] = Some((index, words));
        }
    }

    /// Adds the counts of a worker.
    pub(super) fn add(&mut self, other: Self) {
        let counts = self.levels.iter_mut().zip(other.levels);
        for (sum, count) in counts.chain(self.certainties.iter_mut().zip(other.certainties)) {
            *sum += count;
        }
        for (sum, counts) in self.differ.iter_mut().zip(other.differ) {
            *sum = [sum[0] + counts[0], sum[1] + counts[1]];
        }
        for (first, another) in self.first.iter_mut().zip(other.first) {
            *first = [first.take(), another].into_iter().flatten().min();
        }
    }

    /// Writes the table of one pair type.
    pub(super) fn report(&self, name: &str, text: &mut String) {
        let [yes, no, borderline] = self.certainties;
        let _ = writeln!(text, "{name}: an impact in {yes}, none in {no}, undecidable in {borderline}. Decided by");
        for (words, count) in LEVEL_NAMES.iter().zip(self.levels) {
            let _ = writeln!(text, "  {words:<22} {count:>12}");
        }
        for ((reason, [hits, misses]), first) in DIFFERENCE_REASONS.iter().zip(self.differ).zip(&self.first) {
            if hits + misses > 0 {
                let _ = writeln!(text, "  {reason}: it reports {hits} false impacts, and misses {misses}");
            }
            if let Some((index, what)) = first {
                let _ = writeln!(text, "    first in detection {index}, {what}");
            }
        }
    }
}
