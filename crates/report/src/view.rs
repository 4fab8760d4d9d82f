//! The values in the JSON reports, and the versions of these reports.
//!
//! `schemas/check.schema.json` describes the report of a check. Within one version, fields may be added, but the
//! meaning of a field never changes.
use fosssim_findings::{
    Book, Finding, FindingDetail, FindingKind, FindingPlace, PolynomialPlace, RescaledCoefficient, Role,
};
use fosssim_model::{
    sim::Pass,
    trace::{ImpulsePair, LoggedImpulse},
};
pub use fosssim_num::number_serde::WrittenNumber;
use fosssim_num::polynomial::Polynomial;
use serde::Serialize;

/// Declares a value of a report that is made from another value. Each field has its description, its type, and the
/// expression that computes it.
macro_rules! view {
    ($(#[$about:meta])* $vis:vis struct $name:ident$(<$life:lifetime>)? from $from:ident: $of:ty {
        $($(#[$field:meta])* $access:vis $part:ident: $type:ty = $value:expr,)*
    }) => {
        #[derive(serde::Serialize, schemars::JsonSchema)]
        $(#[$about])*
        $vis struct $name$(<$life>)? {
            $($(#[$field])* $access $part: $type,)*
        }

        impl$(<$life>)? From<&$($life)? $of> for $name$(<$life>)? {
            fn from($from: &$($life)? $of) -> Self {
                Self { $($part: $value,)* }
            }
        }
    };
}
pub(crate) use view;

/// The version of all reports in JSON with types from this module, except for the report of a check.
pub const SCHEMA: u32 = 1;

/// The version of the report of a check. Version 2 added the fair rules. Their findings have further kinds, and may be
/// in the first record.
pub const CHECK_SCHEMA: u32 = 2;

/// Returns the string that represents a value in JSON, for use in other formats; empty for a value with fields.
pub fn to_key(value: &impl Serialize) -> String {
    let written = serde_json::to_value(value).unwrap_or_default();
    written.as_str().unwrap_or_default().to_owned()
}

/// Renders a value as one JSON document, indented, with a line feed at its end.
pub(crate) fn to_document(value: &impl Serialize) -> String {
    // This cannot fail, because a struct of plain values can always be serialized.
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}

/// Converts several numbers to their form in JSON.
pub fn to_written_numbers(values: &[f64]) -> Vec<WrittenNumber> {
    values.iter().copied().map(WrittenNumber).collect()
}

/// A polynomial of a step, and the reference's counterpart.
#[derive(Debug, Clone, PartialEq, Serialize, schemars::JsonSchema)]
pub struct PolynomialView {
    /// The index of the polynomial in the record's list, from 0.
    pub index: usize,
    /// The condition that the polynomial describes.
    pub role: Role,
    /// The detection pass to which the polynomial belongs.
    pub pass: Pass,
    /// The coefficients of the reference's polynomial, highest power first.
    pub expected: Polynomial,
    /// The coefficients of the trace's polynomial, highest power first. At most six are listed.
    pub actual: Polynomial,
}

/// One of the values that a finding compares.
#[derive(Debug, Clone, PartialEq, Serialize, schemars::JsonSchema)]
#[serde(untagged)]
pub enum Value {
    /// A floating-point number.
    Number(WrittenNumber),
    /// A number of occurrences.
    Count(usize),
    /// A vector with two components.
    Point(
        #[serde(with = "fosssim_num::number_serde")]
        #[schemars(with = "[WrittenNumber; 2]")]
        [f64; 2],
    ),
    /// The coefficients of a polynomial.
    Polynomial(Polynomial),
    /// A logged collision.
    Collision(LoggedImpulse),
}

/// A finding. The fields are the same for every kind of finding.
#[derive(Debug, Clone, PartialEq, Serialize, schemars::JsonSchema)]
pub struct FindingView {
    /// The number of the step, from 1; 0 is the first record, which only the fair rules judge.
    pub step: u32,
    /// The index of the record in the trace, from 0.
    pub frame: u64,
    /// The kind of finding.
    pub kind: FindingKind,
    /// The pair that the finding is about; null if it is not about a pair.
    pub pair: Option<ImpulsePair>,
    /// The index of the particle, if the finding is about a position or a velocity.
    pub particle: Option<usize>,
    /// The polynomial; null if the finding is not about a polynomial.
    pub polynomial: Option<PolynomialView>,
    /// The highest power of t whose coefficient differs after division by the factor that most coefficients have in
    /// common.
    pub coefficient: Option<usize>,
    /// The reference's value. It is a collision, a number of polynomials or coefficients, a list of coefficients, a
    /// vector, or a single coefficient, which is multiplied by the factor of the trace's polynomial.
    pub expected: Option<Value>,
    /// The trace's value, in the same form as `expected`.
    pub actual: Option<Value>,
    /// The distance between the two values, if it is defined.
    pub residual: Option<WrittenNumber>,
    /// The largest distance that is accepted. For coefficients, it applies after rescaling. Null for the fair rules,
    /// whose bounds depend on the values.
    pub tolerance: Option<WrittenNumber>,
    /// The coefficient in the form in which the original compares it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rescaled: Option<RescaledCoefficient>,
    /// The finding as a sentence.
    pub text: String,
}

/// Returns the largest distance that the original accepts for this kind of finding; `None` if the kind has no distance.
pub const fn tolerance(kind: FindingKind) -> Option<f64> {
    use fosssim_num::tolerances::{PARITY_COEFFICIENT_DIFFERENCE, PARITY_MAX_RESIDUAL, PARITY_NORMAL_DISTANCE};
    match kind {
        FindingKind::WrongNormal => Some(PARITY_NORMAL_DISTANCE),
        FindingKind::Coefficient => Some(PARITY_COEFFICIENT_DIFFERENCE),
        FindingKind::Position | FindingKind::Velocity => Some(PARITY_MAX_RESIDUAL),
        _ => None,
    }
}

impl FindingView {
    /// Creates the view of a finding by a rule book. For the fair rules, the tolerance is null, because it depends on
    /// the values.
    pub fn from_finding(book: Book, finding: &Finding) -> Self {
        let (kind, detail) = (finding.kind(), &finding.detail);
        let (expected, actual, residual) = compare_values(detail);
        let (coefficient, rescaled) = match *detail {
            FindingDetail::Coefficient { power, rescaled, .. } => (Some(power), rescaled),
            _ => (None, None),
        };
        Self {
            step: finding.step,
            frame: finding.frame,
            kind,
            pair: match detail {
                FindingDetail::SuperfluousCollision { actual } | FindingDetail::RepeatedCollision { actual } => {
                    Some(actual.into())
                }
                detail => detail.pair().map(ImpulsePair::from),
            },
            particle: match detail.place() {
                FindingPlace::Particle(particle) => Some(particle),
                _ => None,
            },
            polynomial: polynomial(detail),
            coefficient,
            expected,
            actual,
            residual: residual.map(WrittenNumber),
            tolerance: tolerance(kind).filter(|_| book == Book::Parity).map(WrittenNumber),
            rescaled,
            text: finding.describe().to_string(),
        }
    }
}

/// Returns the polynomial of a finding that compares two polynomials.
fn polynomial(detail: &FindingDetail) -> Option<PolynomialView> {
    let (place, expected, actual) = match *detail {
        FindingDetail::PolynomialDegree { place, expected, actual, .. }
        | FindingDetail::VanishingPolynomial { place, expected, actual }
        | FindingDetail::Coefficient { place, expected_polynomial: expected, actual_polynomial: actual, .. } => {
            (place, expected, actual)
        }
        _ => return None,
    };
    let PolynomialPlace { pass, role, index, .. } = place;
    Some(PolynomialView { index, role, pass, expected, actual })
}

/// Returns the two values that a finding compares, with the reference's first, and the distance between them.
fn compare_values(detail: &FindingDetail) -> (Option<Value>, Option<Value>, Option<f64>) {
    let both = |expected, actual, residual| (Some(expected), Some(actual), residual);
    match *detail {
        FindingDetail::MissedCollision { expected } => (Some(Value::Collision(expected.into())), None, None),
        FindingDetail::SuperfluousCollision { actual } | FindingDetail::RepeatedCollision { actual } => {
            (None, Some(Value::Collision(actual)), None)
        }
        FindingDetail::WrongNormal { expected, actual, residual } => {
            both(Value::Collision(expected.into()), Value::Collision(actual), Some(residual))
        }
        FindingDetail::ContactTime { expected, actual } => {
            both(Value::Collision(expected.into()), Value::Collision(actual), None)
        }
        FindingDetail::TrimmedTime { expected, actual, .. } => {
            both(Value::Number(WrittenNumber(expected)), Value::Number(WrittenNumber(actual)), None)
        }
        FindingDetail::BeyondReach { position, .. } => (None, Some(Value::Point(position)), None),
        FindingDetail::PolynomialCount { expected, actual, .. } | FindingDetail::PassCount { expected, actual, .. } => {
            both(Value::Count(expected), Value::Count(actual), None)
        }
        FindingDetail::PolynomialDegree { expected, actual_size, .. } => {
            both(Value::Count(expected.coefficients().len()), Value::Count(actual_size), None)
        }
        FindingDetail::VanishingPolynomial { expected, actual, .. } => {
            both(Value::Polynomial(expected), Value::Polynomial(actual), None)
        }
        FindingDetail::Coefficient { expected, actual, residual, .. } => {
            both(Value::Number(WrittenNumber(expected)), Value::Number(WrittenNumber(actual)), Some(residual))
        }
        FindingDetail::Position { expected, actual, residual, .. }
        | FindingDetail::Velocity { expected, actual, residual, .. } => {
            both(Value::Point(expected), Value::Point(actual), Some(residual))
        }
        // All other findings compare no values.
        _ => (None, None, None),
    }
}
