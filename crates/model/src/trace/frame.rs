//! One record in memory.
use crate::sim::{Impulse, Pair, PairKind, State};
use fosssim_num::vector::{Vec2, has_same_bits};
use serde::{Deserialize, Serialize};
use std::{borrow::Cow, fmt};

/// A frame: one saved state with its logs. Buffers are reused from record to record.
#[derive(Debug, Clone, Default)]
pub struct Frame {
    /// Positions and velocities.
    pub state: State,
    /// The impulse list; empty if the layout has none.
    pub impulses: Vec<LoggedImpulse>,
    /// The polynomial list; empty if the layout has none.
    pub polynomials: PolynomialLog,
}

impl Frame {
    /// Returns whether both frames are identical, bit for bit.
    pub fn is_same(&self, other: &Self) -> bool {
        has_same_bits(&self.state.positions, &other.state.positions)
            && has_same_bits(&self.state.velocities, &other.state.velocities)
            && self.impulses.len() == other.impulses.len()
            && self.impulses.iter().zip(&other.impulses).all(|(one, another)| one.is_same(another))
            && self.polynomials.coefficient_ends == other.polynomials.coefficient_ends
            && has_same_bits(&self.polynomials.coefficients, &other.polynomials.coefficients)
    }
}

/// An impulse as in the trace; nothing about it is checked.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(try_from = "ImpulseForm", into = "ImpulseForm")]
pub struct LoggedImpulse {
    /// The number of the pair's kind: 0 for particle-particle, 1 for particle-edge, 2 for particle-half-plane. In a
    /// damaged trace it may be any other number.
    pub kind: i32,
    /// The index of the particle.
    pub first: i32,
    /// The index of the second particle, edge or half-plane.
    pub second: i32,
    /// The contact normal.
    pub normal: Vec2,
    /// The time of impact as a fraction of the step.
    pub time: f64,
}

/// The objects that a logged impulse names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ImpulsePair {
    /// The name of the kind, or `unknown` in a damaged trace.
    kind: Cow<'static, str>,
    /// The number of an unknown kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    code: Option<i32>,
    /// The index of the particle.
    first: i64,
    /// The index of the second particle, edge or half-plane.
    second: i64,
}

/// A logged impulse in the serialized form of an [`Impulse`].
#[derive(Serialize, Deserialize, schemars::JsonSchema)]
struct ImpulseForm {
    /// The objects that collide.
    pair: ImpulsePair,
    /// The contact normal, from the first object to the second, not normalized.
    #[serde(with = "fosssim_num::number_serde")]
    #[schemars(with = "[fosssim_num::number_serde::WrittenNumber; 2]")]
    normal: Vec2,
    /// The time of impact as a fraction of the step.
    #[serde(with = "fosssim_num::number_serde")]
    #[schemars(with = "fosssim_num::number_serde::WrittenNumber")]
    time: f64,
}

impl From<&LoggedImpulse> for ImpulsePair {
    fn from(impulse: &LoggedImpulse) -> Self {
        let (kind, code) = impulse.kind().map_or(("unknown", Some(impulse.kind)), |kind| (kind.name(), None));
        Self { kind: kind.into(), code, first: impulse.first.into(), second: impulse.second.into() }
    }
}

impl From<Pair> for ImpulsePair {
    fn from(Pair { kind, first, second }: Pair) -> Self {
        Self { kind: kind.name().into(), code: None, first: first.into(), second: second.into() }
    }
}

impl From<LoggedImpulse> for ImpulseForm {
    fn from(impulse: LoggedImpulse) -> Self {
        Self { pair: (&impulse).into(), normal: impulse.normal, time: impulse.time }
    }
}

impl TryFrom<ImpulseForm> for LoggedImpulse {
    type Error = &'static str;

    fn try_from(ImpulseForm { pair, normal, time }: ImpulseForm) -> Result<Self, Self::Error> {
        let code = PairKind::ALL.into_iter().find(|kind| kind.name() == pair.kind).map(PairKind::code);
        let kind = code.or(pair.code).ok_or("unknown kind of pair")?;
        let [first, second] =
            [pair.first, pair.second].map(|index| i32::try_from(index).map_err(|_| "the index is out of range"));
        Ok(Self { kind, first: first?, second: second?, normal, time })
    }
}

impl LoggedImpulse {
    /// Returns the kind of the impulse's pair, or `None` in a damaged trace.
    pub fn kind(&self) -> Option<PairKind> {
        PairKind::from_code(self.kind)
    }

    /// Returns the impulse's pair, or `None` if its kind is unknown or an index is negative.
    pub fn pair(&self) -> Option<Pair> {
        let (first, second) = (u32::try_from(self.first).ok()?, u32::try_from(self.second).ok()?);
        Some(Pair { kind: self.kind()?, first, second })
    }

    /// Returns whether both impulses are identical, bit for bit.
    pub fn is_same(&self, other: &Self) -> bool {
        let numbers = |impulse: &Self| [impulse.normal.x, impulse.normal.y, impulse.time];
        (self.kind, self.first, self.second) == (other.kind, other.first, other.second)
            && has_same_bits(&numbers(self), &numbers(other))
    }
}

impl From<Impulse> for LoggedImpulse {
    fn from(impulse: Impulse) -> Self {
        #[expect(clippy::cast_possible_wrap, reason = "the format has 32 signed bits for an index")]
        let (first, second) = (impulse.pair.first as i32, impulse.pair.second as i32);
        Self { kind: impulse.pair.kind.code(), first, second, normal: impulse.normal, time: impulse.time }
    }
}

impl fmt::Display for LoggedImpulse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, first, second, normal, time } = self;
        match self.kind() {
            Some(kind) => write!(f, "particle {first} - {} {second}", kind.second_name())?,
            None => write!(f, "unknown type {kind} {first} {second}")?,
        }
        write!(f, ", normal ({:?}, {:?}), time {time:?}", normal.x, normal.y)
    }
}

/// The polynomials of a frame, in one array.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PolynomialLog {
    /// All coefficients, polynomial by polynomial, highest power first, as logged.
    pub coefficients: Vec<f64>,
    /// The end of each polynomial's coefficients in `coefficients`.
    pub coefficient_ends: Vec<usize>,
}

impl PolynomialLog {
    /// Returns the number of polynomials.
    #[inline]
    pub fn len(&self) -> usize {
        self.coefficient_ends.len()
    }

    /// Returns whether there are no polynomials.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.coefficient_ends.is_empty()
    }

    /// Empties the log, and keeps its memory.
    pub fn clear(&mut self) {
        self.coefficients.clear();
        self.coefficient_ends.clear();
    }

    /// Appends a polynomial with these coefficients.
    pub fn push(&mut self, coefficients: &[f64]) {
        self.coefficients.extend_from_slice(coefficients);
        self.coefficient_ends.push(self.coefficients.len());
    }

    /// Returns the coefficients of polynomial `index`.
    ///
    /// # Panics
    /// Panics if there is no such polynomial.
    #[inline]
    pub fn get(&self, index: usize) -> &[f64] {
        let start = if index == 0 { 0 } else { self.coefficient_ends[index - 1] };
        &self.coefficients[start..self.coefficient_ends[index]]
    }

    /// Returns all polynomials in order.
    pub fn iter(&self) -> impl Iterator<Item = &[f64]> {
        (0..self.len()).map(|index| self.get(index))
    }
}
