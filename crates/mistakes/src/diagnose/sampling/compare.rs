//! The log of one step, and its comparison with another log up to round-off.
//!
//! Polynomials are compared up to a positive factor, because only their signs matter. Contacts are compared in any
//! order. The tolerances of states and contact vectors are relative to the size of the numbers around them. NaN equals
//! only NaN.
use fosssim_model::{
    scene::{Integrator, Scene},
    sim::State,
    trace::{Layout, LenientFrame, LoggedImpulse, PolynomialLog},
};
use fosssim_num::{
    bounded::BoundedValue,
    polynomial::trim,
    tolerances::{
        KNOWN_COEFFICIENT_ERROR, KNOWN_COEFFICIENT_FLOOR, KNOWN_DROPPED_COEFFICIENT, KNOWN_NEWTON_STATE_ERROR,
        KNOWN_NORMAL_ERROR, KNOWN_STATE_ERROR, KNOWN_TIME_ERROR,
    },
    vector::Vec2,
};
use fosssim_student::{Contact, Record};

fosssim_model::drops_leading!();

/// The largest differences between numbers that count as equal.
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    /// The tolerance of a coefficient, relative to itself.
    pub coefficient: f64,
    /// The tolerance of a coefficient, relative to the largest one of its polynomial. If the terms of a coefficient
    /// cancel, its round-off is as large as that of the terms.
    pub floor: f64,
    /// The tolerance of a coordinate or a velocity, relative to the largest one of its kind plus 1.
    pub state: f64,
    /// The tolerance of a contact vector, relative to its length plus 1.
    pub normal: f64,
    /// The tolerance of a time of impact, as a fraction of the step. A double zero is known to about the square root of
    /// the unit roundoff.
    pub time: f64,
}

/// The tolerance of round-off.
pub const ROUND_OFF: Tolerance = Tolerance {
    coefficient: KNOWN_COEFFICIENT_ERROR,
    floor: KNOWN_COEFFICIENT_FLOOR,
    state: KNOWN_STATE_ERROR,
    normal: KNOWN_NORMAL_ERROR,
    time: KNOWN_TIME_ERROR,
};

impl Tolerance {
    /// Returns the tolerance of round-off in steps of a scene.
    pub fn for_scene(scene: &Scene) -> Self {
        let is_newton = scene.integrator == Integrator::ImplicitEuler && !Layout::for_scene(scene).has_polynomials;
        Self { state: if is_newton { KNOWN_NEWTON_STATE_ERROR } else { KNOWN_STATE_ERROR }, ..ROUND_OFF }
    }
}

/// The tolerance above which a difference is clearly not round-off.
pub const CLEAR_TOLERANCE: Tolerance =
    Tolerance { coefficient: 1e-7, floor: 1e-9, state: 1e-8, normal: 1e-8, time: 1e-6 };

/// The tolerance for a step whose start and end states were rounded to single precision.
pub const SINGLE_PRECISION_TOLERANCE: Tolerance =
    Tolerance { coefficient: 1e-4, floor: 1e-4, state: 1e-5, normal: 1e-2, time: 1e-1 };

/// The numbers of one record.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LoggedNumbers {
    /// Positions and velocities.
    pub state: State,
    /// The impulse list.
    pub impulses: Vec<LoggedImpulse>,
    /// The polynomial list, without small leading coefficients.
    pub polynomials: PolynomialLog,
}

impl LoggedNumbers {
    fn values(&self) -> impl Iterator<Item = f64> {
        let impulse_values = |impulse: &LoggedImpulse| [impulse.normal.x, impulse.normal.y, impulse.time];
        let numbers = self.state.positions.iter().chain(&self.state.velocities).chain(&self.polynomials.coefficients);
        numbers.copied().chain(self.impulses.iter().flat_map(impulse_values))
    }

    /// Returns the memory that the numbers use, in bytes.
    pub fn memory_size(&self) -> usize {
        16 * self.state.positions.len()
            + size_of::<LoggedImpulse>() * self.impulses.len()
            + 8 * (self.polynomials.coefficients.len() + self.polynomials.coefficient_ends.len())
    }
}

/// The records of one step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StepRecords {
    /// The numbers of the mid record, if the scene has one.
    pub mid: Option<LoggedNumbers>,
    /// The numbers of the end record.
    pub end: LoggedNumbers,
}

impl StepRecords {
    /// Returns whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.end.values().chain(self.mid.iter().flat_map(LoggedNumbers::values)).all(f64::is_finite)
    }
}

/// The first difference between the records of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepDifference {
    /// A polynomial of the end record differs. The value is its index.
    Polynomial(usize),
    /// The number of polynomials differs.
    PolynomialCount,
    /// The state in the middle differs. The value is the number of the particle.
    MidState(usize),
    /// The impulse list of the end record differs.
    Impulses,
    /// The end state differs. The value is the number of the particle.
    EndState(usize),
    /// The lists of the mid record differ.
    MidLists,
}

impl From<&LenientFrame> for LoggedNumbers {
    fn from(frame: &LenientFrame) -> Self {
        Self { state: frame.state.clone(), impulses: frame.impulses.clone(), polynomials: frame.polynomials.clone() }
    }
}

impl From<Record> for LoggedNumbers {
    fn from(record: Record) -> Self {
        let mut polynomials = PolynomialLog::default();
        record.polynomials.iter().flatten().for_each(|coefficients| polynomials.push(trim(coefficients)));
        #[expect(clippy::cast_possible_wrap, clippy::cast_possible_truncation, reason = "an index of the format")]
        let impulse = |contact: &Contact| {
            let ((kind, second), first) = (contact.pair.object.numbers(), contact.pair.particle);
            let [kind, first, second] = [kind, first, second].map(|number| number as i32);
            LoggedImpulse { kind, first, second, normal: contact.n, time: contact.time }
        };
        let impulses = record.impulses.iter().flatten().map(impulse).collect();
        Self { state: State { positions: record.x, velocities: record.v }, impulses, polynomials }
    }
}

/// Returns the first difference in the order of a step's computation, or `None` if the records are equal up to
/// round-off.
pub fn find_first_difference(
    expected: &StepRecords,
    actual: &StepRecords,
    tolerance: &Tolerance,
) -> Option<StepDifference> {
    let (ours, theirs) = (&expected.end.polynomials, &actual.end.polynomials);
    let wrong = ours.iter().zip(theirs.iter()).position(|(ours, theirs)| !polynomial_matches(ours, theirs, tolerance));
    if let Some(index) = wrong {
        return Some(StepDifference::Polynomial(index));
    }
    if ours.len() != theirs.len() {
        return Some(StepDifference::PolynomialCount);
    }
    if let (Some(ours), Some(theirs)) = (&expected.mid, &actual.mid)
        && let Some(particle) = find_state_difference(&ours.state, &theirs.state, tolerance)
    {
        return Some(StepDifference::MidState(particle));
    }
    if !impulses_match(&expected.end.impulses, &actual.end.impulses, tolerance) {
        return Some(StepDifference::Impulses);
    }
    if let Some(particle) = find_state_difference(&expected.end.state, &actual.end.state, tolerance) {
        return Some(StepDifference::EndState(particle));
    }
    let same_mid = match (&expected.mid, &actual.mid) {
        (Some(ours), Some(theirs)) => {
            impulses_match(&ours.impulses, &theirs.impulses, tolerance)
                && polynomials_match(&ours.polynomials, &theirs.polynomials, tolerance)
        }
        (ours, theirs) => ours.is_none() == theirs.is_none(),
    };
    (!same_mid).then_some(StepDifference::MidLists)
}

/// Returns whether two lists contain the same polynomials in the same order.
pub fn polynomials_match(ours: &PolynomialLog, theirs: &PolynomialLog, tolerance: &Tolerance) -> bool {
    ours.len() == theirs.len()
        && ours.iter().zip(theirs.iter()).all(|(ours, theirs)| polynomial_matches(ours, theirs, tolerance))
}

/// Returns whether one polynomial is a positive multiple of the other (both with the highest power first and without
/// small leading coefficients).
pub fn polynomial_matches(expected: &[f64], actual: &[f64], tolerance: &Tolerance) -> bool {
    if is_multiple(expected, actual, 1.0, tolerance) {
        return true;
    }
    let length = expected.len().max(actual.len());
    let dot = |a: &[f64], b: &[f64]| -> f64 {
        (0..length).map(|power| coefficient_of_power(a, power) * coefficient_of_power(b, power)).sum()
    };
    let factor = dot(actual, expected) / dot(expected, expected);
    factor > 0.0 && factor.is_finite() && is_multiple(expected, actual, factor, tolerance)
}

/// Returns whether a logged polynomial is a positive multiple of a formula's complete result, without the result's
/// small leading coefficients.
pub fn formula_matches(expected: &[BoundedValue], actual: &[f64], tolerance: &Tolerance) -> bool {
    let values: Vec<f64> = expected.iter().map(|coefficient| coefficient.value).collect();
    polynomial_matches(trim(&values), actual, tolerance)
}

/// Returns whether `actual` is `factor * expected`.
fn is_multiple(expected: &[f64], actual: &[f64], factor: f64, tolerance: &Tolerance) -> bool {
    let largest = expected.iter().fold(0.0_f64, |largest, c| largest.max((factor * c).abs()));
    let length = expected.len().max(actual.len());
    (0..length).all(|power| {
        let (e, a) = (factor * coefficient_of_power(expected, power), coefficient_of_power(actual, power));
        // A coefficient that was dropped on one side is at most as large as the limit for dropping.
        let dropped =
            if power < expected.len().min(actual.len()) { 0.0 } else { KNOWN_DROPPED_COEFFICIENT * factor.max(1.0) };
        number_matches(e, a, tolerance.coefficient * e.abs() + tolerance.floor * largest + dropped)
    })
}

/// Returns the coefficient of `t^power`, or zero if the list is too short.
fn coefficient_of_power(coefficients: &[f64], power: usize) -> f64 {
    coefficients.len().checked_sub(power + 1).map_or(0.0, |index| coefficients[index])
}

/// Returns whether two lists contain the same contacts in any order.
fn impulses_match(ours: &[LoggedImpulse], theirs: &[LoggedImpulse], tolerance: &Tolerance) -> bool {
    if ours.len() != theirs.len() {
        return false;
    }
    let is_match = |(ours, theirs): (&LoggedImpulse, &LoggedImpulse)| impulse_matches(ours, theirs, tolerance);
    if ours.iter().zip(theirs).all(is_match) {
        return true;
    }
    let sorted = |list: &[LoggedImpulse]| {
        let mut list = list.to_vec();
        list.sort_by_key(|impulse| (impulse.kind, impulse.first, impulse.second));
        list
    };
    sorted(ours).iter().zip(&sorted(theirs)).all(is_match)
}

/// Returns whether two contacts are equal up to round-off.
pub fn impulse_matches(ours: &LoggedImpulse, theirs: &LoggedImpulse, tolerance: &Tolerance) -> bool {
    let within = tolerance.normal * (1.0 + largest_component(ours.normal));
    (ours.kind, ours.first, ours.second) == (theirs.kind, theirs.first, theirs.second)
        && number_matches(ours.normal.x, theirs.normal.x, within)
        && number_matches(ours.normal.y, theirs.normal.y, within)
        && number_matches(ours.time, theirs.time, tolerance.time)
}

fn largest_component(v: Vec2) -> f64 {
    v.x.abs().max(v.y.abs())
}

/// Returns the first particle whose position or velocity differs, or `None` if no particle does.
pub fn find_state_difference(ours: &State, theirs: &State, tolerance: &Tolerance) -> Option<usize> {
    let different = |ours: &[f64], theirs: &[f64]| {
        let largest = ours.iter().filter(|value| value.is_finite()).fold(0.0_f64, |largest, v| largest.max(v.abs()));
        let within = tolerance.state * (1.0 + largest);
        let index = ours.iter().zip(theirs).position(|(&ours, &theirs)| !number_matches(ours, theirs, within));
        index.map(|index| index / 2)
    };
    let (position, velocity) =
        (different(&ours.positions, &theirs.positions), different(&ours.velocities, &theirs.velocities));
    position.into_iter().chain(velocity).min()
}

fn number_matches(ours: f64, theirs: f64, within: f64) -> bool {
    let distance = (ours - theirs).abs();
    // An infinite number has an infinite bound, so only the same infinity counts as equal.
    ours == theirs || (ours.is_nan() && theirs.is_nan()) || (distance <= within && distance.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn same(expected: &[f64], actual: &[f64]) -> bool {
        polynomial_matches(expected, actual, &ROUND_OFF)
    }

    #[test]
    fn a_positive_factor_and_round_off_change_nothing() {
        let p = [3.0, -2.0, 1e-3];
        assert!(same(&p, &p) && same(&p, &[6.0, -4.0, 2e-3]) && same(&p, &[3.0 + 1e-14, -2.0, 1e-3]));
        assert!(!same(&p, &[-3.0, 2.0, -1e-3]), "a negative factor turns the inequality round");
        assert!(!same(&p, &[3.0, -2.0, 1e-3 * (1.0 + 1e-8)]), "a small coefficient may be wrong, too");
    }

    #[test]
    fn a_coefficient_on_the_brink_of_dropping_may_be_missing() {
        assert!(same(&[1.1e-12, 2.0, 1.0], &[2.0, 1.0]));
        assert!(!same(&[1e-6, 2.0, 1.0], &[2.0, 1.0]));
        assert!(same(&[], &[]) && !same(&[1.0], &[]) && !same(&[], &[1.0]));
    }

    #[test]
    fn nan_equals_nan_only() {
        assert!(same(&[f64::NAN, 1.0], &[f64::NAN, 1.0]) && same(&[f64::NAN], &[f64::NAN]));
        assert!(!same(&[f64::NAN, 1.0], &[1.0, 1.0]) && !same(&[f64::INFINITY, 1.0], &[1.0, 1.0]));
    }

    #[test]
    fn contacts_may_come_in_any_order() {
        let contact = |first, time| LoggedImpulse { kind: 0, first, second: 9, normal: Vec2::new(1.0, 0.0), time };
        let list = [contact(0, 0.5), contact(1, 0.25)];
        assert!(impulses_match(&list, &[list[1], list[0]], &ROUND_OFF));
        assert!(!impulses_match(&list, &list[..1], &ROUND_OFF));
        assert!(!impulses_match(&list, &[list[0], contact(1, 0.26)], &ROUND_OFF));
    }
}
