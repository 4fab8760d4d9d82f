//! Certified decisions compared with those of the root finder: the number of decisions of each level, and the number
//! and reasons of differences.
use std::fmt::Write as _;

use fosssim_oracle::num::{
    bounded::BoundedValue,
    decision::{Certainty, Level, decide},
    polynomial::Polynomial,
};

/// Units of rounding that the fair rules allow for.
const UNITS: f64 = 64.0;

/// The reasons why root finder and certified decision differ: intentions of the original, or its rounding.
const REASONS: [&str; 3] = ["c t^m", "dropped terms", "rounding"];

/// Certified decisions of one pair type, compared with those of the root finder.
#[derive(Default)]
pub(super) struct Decisions {
    levels: [u64; Level::ALL.len()],
    certainties: [u64; 3],
    /// By reason; `[certainly no, but the search hits; certainly yes, but it does not]`.
    differ: [[u64; 2]; REASONS.len()],
    first: [Option<(u64, String)>; REASONS.len()],
}

impl Decisions {
    /// Decides about one detection, whose polynomials the root finder has solved with this result, if it ended.
    pub(super) fn compare(
        &mut self,
        index: u64,
        geometry: &str,
        lists: &[Vec<BoundedValue>],
        polynomials: &[Polynomial],
        time: Option<f64>,
    ) {
        let slices: Vec<&[BoundedValue]> = lists.iter().map(Vec::as_slice).collect();
        let decision = decide(&slices, UNITS);
        self.levels[decision.level as usize] += 1;
        self.certainties[decision.certainty as usize] += 1;
        let Some(time) = time else { return };
        if decision.certainty == Certainty::Borderline || (time <= 1.0) == (decision.certainty == Certainty::Yes) {
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
        self.differ[reason][usize::from(decision.certainty == Certainty::Yes)] += 1;
        if self.first[reason].as_ref().is_none_or(|&(first, _)| index < first) {
            let coefficients: Vec<&[f64]> = polynomials.iter().map(Polynomial::coefficients).collect();
            self.first[reason] = Some((index, format!("{geometry}: {decision:?} but {time:?}\n    {coefficients:?}")));
        }
    }

    /// Adds another worker's table.
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
        let _ = writeln!(text, "{name}, certified: {yes} yes, {no} no, {borderline} borderline");
        for level in Level::ALL {
            let _ = writeln!(text, "  {:<12} {:>12}", format!("{level:?}"), self.levels[level as usize]);
        }
        for ((reason, [hits, misses]), first) in REASONS.iter().zip(self.differ).zip(&self.first) {
            let _ = writeln!(text, "  search differs, {reason}: {hits} no but hit, {misses} yes but not");
            if let Some((index, what)) = first {
                let _ = writeln!(text, "    first: detection {index}, {what}");
            }
        }
    }
}
