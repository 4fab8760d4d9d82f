//! Runs the fixed-shift stage, and chooses between the two variable-shift iterations (root-finder.md 11 and 12).
use super::{
    Coefficients, SearchResult, linear_iteration, quadratic_iteration,
    scalars::{Division, ScalarKind, Scalars},
};

/// The convergence tests of one sequence of estimates, which are those of the factor's `v` or of the real zero `s`.
#[derive(Clone, Copy)]
struct Convergence {
    previous: f64,
    previous_change: f64,
    threshold: f64,
}

/// The measure of convergence of a sequence after one step.
#[derive(Clone, Copy)]
struct Measure {
    change: f64,
    product: f64,
    passes: bool,
}

impl Convergence {
    const START: Self = Self { previous: 0.0, previous_change: 1.0, threshold: 0.25 };

    /// Returns the measure, which passes after two successive small relative changes.
    #[inline(always)]
    fn measure(&self, estimate: f64) -> Measure {
        let change = if estimate == 0.0 { 1.0 } else { ((estimate - self.previous) / estimate).abs() };
        let product = if change < self.previous_change { change * self.previous_change } else { 1.0 };
        Measure { change, product, passes: product < self.threshold }
    }

    #[inline(always)]
    fn remember(&mut self, estimate: f64, change: f64) {
        self.previous = estimate;
        self.previous_change = change;
    }

    /// Tightens the threshold. After a failed iteration, convergence must be clearer before the next attempt.
    #[inline(always)]
    fn tighten(&mut self) {
        self.threshold *= 0.25;
    }
}

/// Iterates with the fixed factor `z² + u z + v` until a variable-shift iteration from the estimates succeeds. Returns
/// `None` after `limit` steps. All steps, including those of the iterations, are added to `steps`.
pub(super) fn run<const N: usize>(
    polynomial: &Coefficients,
    mut k: Coefficients,
    u: f64,
    v: f64,
    limit: usize,
    steps: &mut u32,
) -> Option<SearchResult> {
    let mut factor = Convergence::START;
    let mut real = Convergence::START;
    let division = Division::<N>::new(polynomial, u, v);
    let mut scalars = Scalars::new(&k, &division);
    for step in 0..limit {
        *steps += 1;
        k = scalars.next_k(&division);
        scalars = Scalars::new(&k, &division);
        let estimate = scalars.estimate(&k, polynomial, &division);
        let zero = if k[N - 1] == 0.0 { 0.0 } else { -polynomial[N] / k[N - 1] };
        let (mut factor_change, mut real_change) = (1.0, 1.0);
        if step > 0 && scalars.kind != ScalarKind::Divides {
            let factor_measure = factor.measure(estimate.1);
            let zero_measure = real.measure(zero);
            (factor_change, real_change) = (factor_measure.change, zero_measure.change);
            if factor_measure.passes || zero_measure.passes {
                let attempt = Attempt { polynomial, k, estimate, zero, factor_measure, zero_measure };
                let found = attempt.run::<N>(&mut factor, &mut real, steps);
                if found.is_some() {
                    return found;
                }
            }
        }
        factor.remember(estimate.1, factor_change);
        real.remember(zero, real_change);
    }
    None
}

/// The state of the fixed-shift stage when a sequence passes its convergence test.
struct Attempt<'a> {
    polynomial: &'a Coefficients,
    k: Coefficients,
    estimate: (f64, f64),
    zero: f64,
    factor_measure: Measure,
    zero_measure: Measure,
}

/// The position in the chain of iterations.
enum Stage {
    Quadratic,
    Linear,
    Restore,
}

impl Attempt<'_> {
    /// Tries the variable-shift iterations one after the other. Each failure tightens the threshold of its sequence.
    /// Returns `None` if all of them fail.
    #[inline(never)]
    fn run<const N: usize>(
        &self,
        factor: &mut Convergence,
        real: &mut Convergence,
        steps: &mut u32,
    ) -> Option<SearchResult> {
        let mut k = self.k;
        let (mut u, mut v) = self.estimate;
        let (mut factor_tried, mut zero_tried) = (false, false);
        let linear_first = (self.zero_measure.passes && !self.factor_measure.passes)
            || self.zero_measure.product < self.factor_measure.product;
        let mut stage = if linear_first { Stage::Linear } else { Stage::Quadratic };
        loop {
            stage = match stage {
                Stage::Quadratic => {
                    if let Some((zeros, quotient)) = quadratic_iteration::run::<N>(self.polynomial, &mut k, u, v, steps)
                    {
                        return Some(SearchResult::Two { zeros, quotient });
                    }
                    factor_tried = true;
                    factor.tighten();
                    if zero_tried || !self.zero_measure.passes {
                        Stage::Restore
                    } else {
                        k = self.k;
                        Stage::Linear
                    }
                }
                Stage::Linear => {
                    let outcome = linear_iteration::run::<N>(self.polynomial, &mut k, self.zero, steps);
                    if let linear_iteration::Outcome::Zero(zero, quotient) = outcome {
                        return Some(SearchResult::One { zero, quotient });
                    }
                    zero_tried = true;
                    real.tighten();
                    if let linear_iteration::Outcome::Cluster(s) = outcome {
                        // The factor has a double zero at s, and K is unchanged since the linear iteration.
                        u = -(s + s);
                        v = s * s;
                        Stage::Quadratic
                    } else {
                        Stage::Restore
                    }
                }
                Stage::Restore => {
                    k = self.k;
                    if self.factor_measure.passes && !factor_tried {
                        Stage::Quadratic
                    } else {
                        return None;
                    }
                }
            };
        }
    }
}
