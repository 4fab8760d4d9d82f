//! The serialised shapes of the reports, and their schema version.
//!
//! `schemas/check.schema.json` documents the shape of a check. A field's meaning never changes within one schema
//! version; fields may be added.
use super::number;
use fosssim_judge::{Finding, FindingDetail, FindingKind, PolynomialPlace, Rescaled};
use fosssim_model::{
    sim::{Impulse, Pair, PairKind, Pass, Stage},
    trace::LoggedImpulse,
};
use serde::{Serialize, Serializer};

/// The version of all shapes in this module, but for those below.
pub const SCHEMA: u32 = 1;

/// The version of the check report: 2 since the fair rules speak in it, whose findings have kinds of their own and may
/// lie in the first record.
pub const CHECK_SCHEMA: u32 = 2;

/// A number in JSON: values that JSON has no number for are the strings `nan`, `-nan`, `inf` and `-inf`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number(pub f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() {
            serializer.serialize_f64(self.0)
        } else {
            serializer.serialize_str(&number::general(self.0))
        }
    }
}

/// Several numbers in JSON.
#[must_use]
pub fn numbers(values: &[f64]) -> Vec<Number> {
    values.iter().copied().map(Number).collect()
}

/// A pair of objects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct PairView {
    /// `particle-particle`, `particle-edge`, `particle-half-plane`, or `unknown` in a damaged trace.
    pub kind: &'static str,
    /// Index of the particle.
    pub first: i64,
    /// Index of the second object among its kind.
    pub second: i64,
}

impl From<Pair> for PairView {
    fn from(pair: Pair) -> Self {
        Self { kind: pair.kind.name(), first: i64::from(pair.first), second: i64::from(pair.second) }
    }
}

impl From<&LoggedImpulse> for PairView {
    fn from(impulse: &LoggedImpulse) -> Self {
        let kind = impulse.kind().map_or("unknown", PairKind::name);
        Self { kind, first: i64::from(impulse.first), second: i64::from(impulse.second) }
    }
}

/// A collision.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CollisionView {
    /// The pair.
    pub pair: PairView,
    /// Contact normal, not normalised.
    pub normal: [Number; 2],
    /// Time of impact as a fraction of the step.
    pub time: Number,
}

impl From<&LoggedImpulse> for CollisionView {
    fn from(impulse: &LoggedImpulse) -> Self {
        let normal = [Number(impulse.normal.x), Number(impulse.normal.y)];
        Self { pair: impulse.into(), normal, time: Number(impulse.time) }
    }
}

impl From<&Impulse> for CollisionView {
    fn from(impulse: &Impulse) -> Self {
        (&LoggedImpulse::from(*impulse)).into()
    }
}

/// A detection pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct PassView {
    /// Number of the pass within the step, from 0.
    pub index: u32,
    /// `simple`, `continuous-time`, `impulses` or `geometric`.
    pub stage: &'static str,
    /// Round within the stage, from 0.
    pub round: u32,
}

impl From<Pass> for PassView {
    fn from(pass: Pass) -> Self {
        let (stage, round) = match pass.stage {
            Stage::Simple => ("simple", 0),
            Stage::ContinuousTime => ("continuous-time", 0),
            Stage::Impulses { round } => ("impulses", round),
            Stage::Geometric { round } => ("geometric", round),
        };
        Self { index: pass.index, stage, round }
    }
}

/// A polynomial of a step.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PolynomialView {
    /// Its number in the frame's list, from 0.
    pub index: usize,
    /// `overlap`, `alpha_above_zero`, `alpha_below_one` or `approach`.
    pub role: &'static str,
    /// The detection pass that logged it.
    pub pass: PassView,
    /// The reference's coefficients, highest power first.
    pub expected: Vec<Number>,
    /// The trace's coefficients, highest power first, six at most.
    pub actual: Vec<Number>,
}

impl PolynomialView {
    fn new(place: &PolynomialPlace, expected: &[f64], actual: &[f64]) -> Self {
        Self {
            index: place.index,
            role: place.role.key(),
            pass: place.pass.into(),
            expected: numbers(expected),
            actual: numbers(actual),
        }
    }
}

/// What a finding compares.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A number.
    Number(Number),
    /// A count.
    Count(usize),
    /// A vector or the coefficients of a polynomial.
    Numbers(Vec<Number>),
    /// A collision.
    Collision(CollisionView),
}

/// A finding.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FindingView {
    /// The step, from 1.
    pub step: u32,
    /// The frame of the trace, from 0.
    pub frame: u64,
    /// The kind's key.
    pub kind: &'static str,
    /// The pair; null for what belongs to no pair.
    pub pair: Option<PairView>,
    /// The particle, for positions and velocities.
    pub particle: Option<usize>,
    /// The polynomial; null for what is not about one.
    pub polynomial: Option<PolynomialView>,
    /// The power of t whose coefficient differs.
    pub coefficient: Option<usize>,
    /// What the reference has.
    pub expected: Option<Value>,
    /// What the trace has.
    pub actual: Option<Value>,
    /// Their distance, where there is one.
    pub residual: Option<Number>,
    /// The bound of the distance; for coefficients, of the distance after rescaling.
    pub tolerance: Option<Number>,
    /// A coefficient as the original compares it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rescaled: Option<RescaledView>,
    /// The same in words.
    pub text: String,
}

/// A coefficient as the original compares it, after rescaling by sums of moduli.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RescaledView {
    /// The power of t.
    pub coefficient: usize,
    /// The reference's coefficient, rescaled to the trace's magnitude.
    pub expected: Number,
    /// The trace's coefficient.
    pub actual: Number,
    /// Their distance.
    pub residual: Number,
}

impl From<&Rescaled> for RescaledView {
    fn from(rescaled: &Rescaled) -> Self {
        let Rescaled { power, expected, actual, residual } = *rescaled;
        Self { coefficient: power, expected: Number(expected), actual: Number(actual), residual: Number(residual) }
    }
}

/// The tolerance of a kind's distance.
#[must_use]
pub const fn tolerance(kind: FindingKind) -> Option<f64> {
    use fosssim_num::tolerances::{PARITY_COEFFICIENT, PARITY_MAXIMUM, PARITY_NORMAL};
    match kind {
        FindingKind::WrongNormal => Some(PARITY_NORMAL),
        FindingKind::Coefficient => Some(PARITY_COEFFICIENT),
        FindingKind::Position | FindingKind::Velocity => Some(PARITY_MAXIMUM),
        _ => None,
    }
}

impl FindingView {
    /// A finding of the fair rules, whose tolerances depend on the values.
    #[must_use]
    pub fn fair(finding: &Finding) -> Self {
        Self { tolerance: None, ..finding.into() }
    }
}

impl From<&Finding> for FindingView {
    fn from(finding: &Finding) -> Self {
        let mut view = Self {
            step: finding.step,
            frame: finding.frame,
            kind: finding.kind().key(),
            pair: None,
            particle: None,
            polynomial: None,
            coefficient: None,
            expected: None,
            actual: None,
            residual: None,
            tolerance: tolerance(finding.kind()).map(Number),
            rescaled: None,
            text: finding.what().to_string(),
        };
        view.fill(&finding.detail);
        view
    }
}

impl FindingView {
    fn fill(&mut self, detail: &FindingDetail) {
        match detail {
            FindingDetail::MissedCollision { expected } => {
                self.pair = Some(expected.pair.into());
                self.expected = Some(Value::Collision(expected.into()));
            }
            FindingDetail::SuperfluousCollision { actual } | FindingDetail::RepeatedCollision { actual } => {
                self.pair = Some(actual.into());
                self.actual = Some(Value::Collision(actual.into()));
            }
            FindingDetail::WrongNormal { expected, actual, residual } => {
                self.pair = Some(expected.pair.into());
                self.compare(Value::Collision(expected.into()), Value::Collision(actual.into()));
                self.residual = Some(Number(*residual));
            }
            FindingDetail::ContactTime { expected, actual } => {
                self.pair = Some(expected.pair.into());
                self.compare(Value::Collision(expected.into()), Value::Collision(actual.into()));
            }
            FindingDetail::PassPositions { place }
            | FindingDetail::TrimmedDecision { place, .. }
            | FindingDetail::MixedForms { place } => {
                self.pair = Some(place.pair.into());
            }
            FindingDetail::TrimmedTime { place, expected, actual } => {
                self.pair = Some(place.pair.into());
                self.compare(Value::Number(Number(*expected)), Value::Number(Number(*actual)));
            }
            FindingDetail::BeyondReach { particle, position, .. } => {
                self.particle = Some(*particle);
                self.actual = Some(Value::Numbers(numbers(position)));
            }
            FindingDetail::RecordsDiffer { .. } | FindingDetail::ImpossibleLog => {}
            FindingDetail::PolynomialCount { expected, actual, .. }
            | FindingDetail::PassCount { expected, actual, .. } => {
                self.compare(Value::Count(*expected), Value::Count(*actual));
            }
            FindingDetail::PolynomialDegree { place, expected, actual_size, actual } => {
                self.place(place, expected.coefficients(), actual.coefficients());
                self.compare(Value::Count(expected.coefficients().len()), Value::Count(*actual_size));
            }
            FindingDetail::VanishingPolynomial { place, expected, actual } => {
                let (expected, actual) = (expected.coefficients(), actual.coefficients());
                self.place(place, expected, actual);
                self.compare(Value::Numbers(numbers(expected)), Value::Numbers(numbers(actual)));
            }
            FindingDetail::Coefficient {
                place,
                power,
                expected,
                actual,
                residual,
                rescaled,
                expected_polynomial,
                actual_polynomial,
            } => {
                self.rescaled = rescaled.as_ref().map(RescaledView::from);
                self.place(place, expected_polynomial.coefficients(), actual_polynomial.coefficients());
                self.coefficient = Some(*power);
                self.compare(Value::Number(Number(*expected)), Value::Number(Number(*actual)));
                self.residual = Some(Number(*residual));
            }
            FindingDetail::Position { particle, expected, actual, residual }
            | FindingDetail::Velocity { particle, expected, actual, residual } => {
                self.particle = Some(*particle);
                self.compare(Value::Numbers(numbers(expected)), Value::Numbers(numbers(actual)));
                self.residual = Some(Number(*residual));
            }
        }
    }

    fn place(&mut self, place: &PolynomialPlace, expected: &[f64], actual: &[f64]) {
        self.pair = Some(place.pair.into());
        self.polynomial = Some(PolynomialView::new(place, expected, actual));
    }

    fn compare(&mut self, expected: Value, actual: Value) {
        self.expected = Some(expected);
        self.actual = Some(actual);
    }
}
