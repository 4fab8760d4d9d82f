//! The tolerances of contacts and states, and the decisions that depend on round-off.
use super::{
    context::{Context, Records},
    formulas::{BoundedPairMotion, ExpectedPolynomials},
    ordinary_range::largest_size,
    step_judgment::StepJudgment,
};
use crate::finding::{Finding, FindingDetail};
use fosssim_model::{
    scene::Collision,
    sim::{Decision, Impulse, Pair, State},
    trace::LoggedImpulse,
};
use fosssim_num::{
    bounded::{BoundedValue, UNIT_ROUNDOFF},
    certificate::excludes_unit_interval,
    decision::{HitCertainty, decide},
    first_time::first_time,
    polynomial::{MAX_COEFFICIENTS, Polynomial},
    tolerances::{
        FAIR_LOSS_FACTOR, FAIR_ROOT_UNITS, FAIR_SENSITIVITY_FACTOR, FAIR_TIME_SHARE, FAIR_UNITS,
        MIN_LEADING_COEFFICIENT, SEARCH_MAX_COEFFICIENT, SEARCH_MIN_COEFFICIENT,
    },
    vector::{Vec2, length, vector_at},
};

fosssim_model::drops_leading!();

/// Returns a polynomial's value at time `t` and the tolerance of the value, both computed from bounded coefficients.
fn evaluate(polynomial: &[BoundedValue], t: f64) -> (f64, f64) {
    let (mut value, mut bound) = (0.0, 0.0);
    for c in polynomial {
        value = value * t + c.value;
        bound = bound * t.abs() + c.bound.max(c.value.abs());
    }
    (value, FAIR_ROOT_UNITS * UNIT_ROUNDOFF * bound)
}

/// Returns a polynomial's value and its tolerance like [`evaluate`]. The tolerance also covers leading coefficients
/// that the course's library drops if the program multiplies its polynomials by a factor near 1.
fn evaluate_without_losses(polynomial: &[BoundedValue], t: f64) -> (f64, f64) {
    let moduli = polynomial.iter().map(|c| c.value.abs());
    let missing: f64 = moduli.take_while(|c| *c < FAIR_LOSS_FACTOR * MIN_LEADING_COEFFICIENT).sum();
    let (value, tolerance) = evaluate(polynomial, t);
    (value, tolerance + missing)
}

/// A function that returns a polynomial's value at a time, and the tolerance of that value.
type EvaluateFn = fn(&[BoundedValue], f64) -> (f64, f64);

/// Returns whether a pair may come into contact at time `t`. No polynomial may be negative at `t`. Unless the step
/// starts at `t`, one polynomial must be zero there. Both conditions hold within the tolerances.
fn is_possible(expected: &ExpectedPolynomials, t: f64, value: EvaluateFn) -> bool {
    if !(0.0..=1.0).contains(&t) {
        return false;
    }
    let values = || (0..expected.count()).map(|number| value(expected.polynomial(number), t));
    let none_is_negative = values().all(|(value, tolerance)| value >= -tolerance);
    none_is_negative && (t == 0.0 || values().any(|(value, tolerance)| value.abs() <= tolerance))
}

/// Returns whether a pair may first be in contact at time `t`: `t` is near the reference's time `own`, or contact is
/// possible at `t`, and the polynomials are not all positive between the two times.
fn time_fits(expected: &ExpectedPolynomials, own: f64, t: f64, value: EvaluateFn) -> bool {
    // If contact is certain between the two times, the later one is not the time of the first contact.
    let undecided = || {
        [0.25, 0.5, 0.75].into_iter().all(|part| {
            let between = own + part * (t - own);
            (0..expected.count()).any(|number| {
                let (value, tolerance) = value(expected.polynomial(number), between);
                value <= tolerance
            })
        })
    };
    let is_near = (0.0..=1.0).contains(&t) && (own - t).abs() <= FAIR_TIME_SHARE;
    is_near || is_possible(expected, t, value) && undecided()
}

/// Returns whether the time of impact `t` is right. It is right if it is near the reference's time `own`, whose
/// polynomials may have lost coefficients, or if it fits the complete polynomials.
pub(super) fn is_right_time_without_losses(expected: &ExpectedPolynomials, own: f64, t: f64) -> bool {
    let is_near = (own - t).abs() <= FAIR_TIME_SHARE;
    is_near || time_fits(expected, possible_time(expected), t, evaluate_without_losses)
}

/// Compares a logged contact with the reference's contact `own`, and returns the finding if it is wrong. `before` is
/// the state at the start of the step.
pub(super) fn compare_hit(
    before: &State,
    known: Option<&(BoundedPairMotion, ExpectedPolynomials)>,
    own: Impulse,
    actual: &LoggedImpulse,
    step_judgment: &mut StepJudgment,
) -> Option<FindingDetail> {
    if actual.time != own.time {
        let is_right_time = known.is_some_and(|(_, expected)| time_fits(expected, own.time, actual.time, evaluate));
        if !is_right_time {
            return Some(FindingDetail::ContactTime { expected: own, actual: *actual });
        }
    }
    let (normal, tolerance) = match known {
        Some((motion, _)) => normal(motion, actual.time),
        None => (own.normal, simple_tolerance(before)),
    };
    compare_normal(Impulse { normal, time: actual.time, ..own }, tolerance, actual, step_judgment)
}

/// Compares a logged contact with the expected one, for a pair whose collision is uncertain, and returns the finding if
/// it is wrong.
pub(super) fn compare_possible_hit(
    context: &Context<'_>,
    records: &Records<'_>,
    known: Option<&(BoundedPairMotion, ExpectedPolynomials)>,
    pair: Pair,
    actual: &LoggedImpulse,
    judged: &mut StepJudgment,
) -> Option<FindingDetail> {
    let Some((motion, expected)) = known else {
        // An overlap at the end of the step has no time of impact, and its normal is computed at the end.
        let normal = overlap_normal(context, pair, &records.end.state.positions);
        let expected = Impulse { pair, normal, time: 0.0 };
        if actual.time != 0.0 {
            return Some(FindingDetail::ContactTime { expected, actual: *actual });
        }
        return compare_normal(expected, simple_tolerance(records.before), actual, judged);
    };
    if !is_possible(expected, actual.time, evaluate) {
        let time = possible_time(expected);
        let (normal, _) = normal(motion, time);
        return Some(FindingDetail::ContactTime { expected: Impulse { pair, normal, time }, actual: *actual });
    }
    let (normal, tolerance) = normal(motion, actual.time);
    compare_normal(Impulse { pair, normal, time: actual.time }, tolerance, actual, judged)
}

/// Returns the contact normal at a time, and its tolerance. The tolerance is for the whole vector: a program with
/// rotated axes spreads the round-off of one component over both. The assignment requires the shortest vector. If the
/// round-off of the time leads beyond an edge's end, the vector to the end is as right as the vector to the line.
fn normal(motion: &BoundedPairMotion, t: f64) -> (Vec2, f64) {
    let normal = motion.normal(t);
    let bound = length(Vec2::new(normal.x.bound, normal.y.bound));
    let value = Vec2::new(normal.x.value, normal.y.value);
    (value, FAIR_UNITS * UNIT_ROUNDOFF * bound + length(motion.vector_to_nearest_point(t) - value))
}

/// Returns the tolerance of contact normals that are computed directly from positions. Their rounding errors are those
/// of the largest position.
fn simple_tolerance(before: &State) -> f64 {
    FAIR_UNITS * UNIT_ROUNDOFF * largest_size(&before.positions)
}

fn compare_normal(
    expected: Impulse,
    tolerance: f64,
    actual: &LoggedImpulse,
    judged: &mut StepJudgment,
) -> Option<FindingDetail> {
    let residual = length(actual.normal - expected.normal);
    if !(residual <= tolerance) {
        return Some(FindingDetail::WrongNormal { expected, actual: *actual, residual });
    }
    if residual > 0.0 {
        judged.shares.normal = judged.shares.normal.max(residual / tolerance);
    }
    None
}

/// Returns the vector from a pair's first object to the nearest point of the second at `positions` (collisions.md 6).
fn overlap_normal(context: &Context<'_>, pair: Pair, positions: &[f64]) -> Vec2 {
    BoundedPairMotion::for_pair(context.scene, pair, positions, positions).vector_to_nearest_point(1.0)
}

/// The tolerances of the state at the end of a step.
pub(super) struct Tolerances<'a> {
    position: f64,
    velocity: f64,
    sensitivity: Option<&'a State>,
}

impl<'a> Tolerances<'a> {
    /// Returns the tolerances around the reference's state `own`.
    pub fn from_context(context: &Context<'_>, own: &State, sensitivity: Option<&'a State>) -> Self {
        let roundings = FAIR_UNITS * UNIT_ROUNDOFF;
        let size = largest_size(&own.positions);
        let speed = largest_size(&own.velocities);
        // These two collision types compute velocities from displacements over the time step.
        let displacement_speed = match context.scene.collision {
            Collision::ContinuousTime { .. } | Collision::Hybrid { .. } => size / context.scene.time_step,
            Collision::None | Collision::Penalty { .. } | Collision::Simple { .. } => 0.0,
        };
        Self { position: roundings * size, velocity: roundings * (speed + displacement_speed), sensitivity }
    }

    /// Returns the tolerance of a particle's position at the end of the step.
    pub fn position(&self, particle: usize) -> f64 {
        self.add_sensitivity(self.position, particle, |known| &known.positions)
    }

    /// Returns the tolerance of a particle's velocity at the end of the step.
    pub fn velocity(&self, particle: usize) -> f64 {
        self.add_sensitivity(self.velocity, particle, |known| &known.velocities)
    }

    fn add_sensitivity(&self, floor: f64, particle: usize, select: fn(&State) -> &Vec<f64>) -> f64 {
        let sensitivity = self.sensitivity.map_or(0.0, |sensitivity| length(vector_at(select(sensitivity), particle)));
        floor + FAIR_SENSITIVITY_FACTOR * sensitivity
    }
}

/// Compares a logged state with the reference's. A wrong velocity is not reported if the position is wrong, because
/// both have the same cause.
pub(super) fn compare_states(
    judged: &mut StepJudgment,
    frame: u64,
    own: &State,
    logged: &State,
    tolerances: &Tolerances<'_>,
) {
    for particle in 0..own.positions.len() / 2 {
        let position_tolerance = tolerances.position(particle);
        let (expected, actual) = (vector_at(&own.positions, particle), vector_at(&logged.positions, particle));
        let residual = distance(expected, actual);
        if !(residual <= position_tolerance) {
            let detail =
                FindingDetail::Position { particle, expected: expected.into(), actual: actual.into(), residual };
            judged.add_finding(Finding { step: judged.step, frame, detail });
            continue;
        }
        let velocity_tolerance = tolerances.velocity(particle);
        let (expected, actual) = (vector_at(&own.velocities, particle), vector_at(&logged.velocities, particle));
        let velocity_residual = distance(expected, actual);
        if !(velocity_residual <= velocity_tolerance) {
            let (expected, actual, residual) = (expected.into(), actual.into(), velocity_residual);
            let detail = FindingDetail::Velocity { particle, expected, actual, residual };
            judged.add_finding(Finding { step: judged.step, frame, detail });
            continue;
        }
        if residual > 0.0 {
            judged.shares.position = judged.shares.position.max(residual / position_tolerance);
        }
        if velocity_residual > 0.0 {
            judged.shares.velocity = judged.shares.velocity.max(velocity_residual / velocity_tolerance);
        }
    }
}

/// Returns the distance between two vectors. If the reference itself has NaN or infinity from the trace's own state, a
/// trace with the same value is right: the component counts as equal. If only one side has NaN, the result is NaN.
fn distance(expected: Vec2, actual: Vec2) -> f64 {
    let subtract = |expected: f64, actual: f64| {
        let is_same = expected == actual || expected.is_nan() && actual.is_nan();
        if is_same { 0.0 } else { expected - actual }
    };
    length(Vec2::new(subtract(expected.x, actual.x), subtract(expected.y, actual.y)))
}

/// Returns a logged collision as a decision, or `None` if no response can be computed from the collision.
pub(super) fn logged_decision(logged: LoggedImpulse) -> Option<Decision> {
    let LoggedImpulse { normal, time, .. } = logged;
    let is_usable = normal.x.is_finite() && normal.y.is_finite() && time.is_finite() && normal != normal * 0.0;
    is_usable.then_some(Decision::Hit { time, normal })
}

/// Returns whether the root finder provably ends for `coefficients`.
#[inline]
pub(super) fn is_searchable(coefficients: &[f64]) -> bool {
    coefficients.len() <= MAX_COEFFICIENTS && coefficients.iter().fold(true, |all, c| all & is_ordinary(*c))
}

/// Returns whether a coefficient is zero, or so moderate that no overflow or underflow is possible.
fn is_ordinary(c: f64) -> bool {
    (c == 0.0) | (c.abs() >= SEARCH_MIN_COEFFICIENT) & (c.abs() <= SEARCH_MAX_COEFFICIENT)
}

/// Returns the time of impact of `polynomials`. The time is infinite if there is provably no impact, and `None` if the
/// root finder does not end.
pub(super) fn find_time(polynomials: &[Polynomial]) -> Option<f64> {
    if excludes_unit_interval(polynomials) {
        return Some(f64::INFINITY);
    }
    first_time(polynomials).ok()
}

/// Returns whether the pair collides according to the polynomials, or `None` if round-off may change this.
///
/// If a parabola's inputs have few digits, every way to evaluate the formulas is exact. Then no decision depends on
/// round-off, and even a contact at the very end of the step is certain.
pub fn certain_decision(motion: &BoundedPairMotion, expected: &ExpectedPolynomials) -> Option<bool> {
    let polynomials = expected.polynomials();
    if !polynomials.iter().copied().flatten().all(|c| is_ordinary(c.value)) {
        // With such extreme numbers no program is reliable, and proving certainty would take long.
        return None;
    }
    let units = if motion.is_exact(EXACT_BITS) && !motion.has_edge() { 0.0 } else { FAIR_UNITS };
    match decide(&polynomials[..expected.count()], units).certainty {
        HitCertainty::Hits => Some(true),
        HitCertainty::Misses => Some(false),
        HitCertainty::Borderline => None,
    }
}

/// The largest number of bits of the inputs with which a parabola's coefficients and discriminant are exact. The
/// coefficients are of fourth degree in the inputs.
const EXACT_BITS: u32 = 6;

/// Returns whether round-off may change the decision.
pub(super) fn is_borderline(motion: &BoundedPairMotion, expected: &ExpectedPolynomials) -> bool {
    // If the edge is at rest, the polynomials are quadratic. The submission computes them without rounding too, so the
    // decision is certain.
    let is_certain = || {
        let is_exact = motion.has_edge() && motion.is_exact(EXACT_BITS);
        is_exact && decide(&expected.polynomials()[..expected.count()], 0.0).certainty != HitCertainty::Borderline
    };
    certain_decision(motion, expected).is_none() && !is_certain()
}

/// Returns a time of impact for a pair whose collision is uncertain, or 1 if there is none.
pub(super) fn possible_time(expected: &ExpectedPolynomials) -> f64 {
    let earliest = decide(&expected.polynomials()[..expected.count()], FAIR_UNITS).time;
    earliest.map_or(1.0, |[low, high]| low.midpoint(high).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If both states contain NaN, the distance is zero. A program that ends with NaN like the reference has met the
    /// scene's requirements.
    #[test]
    fn nan_in_both_states_is_no_distance() {
        let (nan, infinite) = (f64::NAN, f64::INFINITY);
        assert_eq!(distance(Vec2::new(nan, infinite), Vec2::new(-nan, infinite)), 0.0);
        assert_eq!(distance(Vec2::new(nan, 1.0), Vec2::new(nan, 4.0)), 3.0);
        assert_eq!(distance(Vec2::new(infinite, 0.0), Vec2::new(-infinite, 0.0)), infinite);
        for (expected, actual) in [(1.0, nan), (nan, 1.0), (infinite, nan)] {
            assert!(distance(Vec2::new(0.0, expected), Vec2::new(0.0, actual)).is_nan(), "{expected} {actual}");
        }
    }
}
