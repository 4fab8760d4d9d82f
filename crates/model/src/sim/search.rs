//! Root searches: whether they may be left out, and how many there were.
use serde::Serialize;

/// The use of certificates instead of root searches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RootSearch {
    /// Search only where no certificate excludes an impact. The traces are the same.
    #[default]
    WhereNeeded,
    /// Always search.
    Always,
    /// Search always, compute the certificate too, and count disagreements.
    Audit,
}

/// Counts of the root searches so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, schemars::JsonSchema)]
pub struct SearchCounts {
    /// Detection calls.
    pub calls: u64,
    /// Calls whose roots were searched.
    pub searched: u64,
    /// Calls excluded by a certificate.
    pub excluded: u64,
    /// Audit only: a certificate excluded an impact that the root finder found. Must stay zero.
    pub disagreements: u64,
    /// Steps of root searches ([`Zeros::steps`](fosssim_num::rpoly::Zeros::steps)).
    #[serde(skip)]
    pub steps: u64,
    /// The additional work of passes over subnormal numbers, beyond the counted one.
    pub subnormal: u64,
}

impl SearchCounts {
    /// Returns the work of these calls, in calls that a certificate excludes. It is the same on every machine.
    #[must_use]
    pub const fn work(&self) -> u64 {
        self.calls + SEARCH_WORK * self.searched + self.steps + self.subnormal
    }

    /// Combines each count of both.
    fn with(self, other: Self, made: fn(u64, u64) -> u64) -> Self {
        Self {
            calls: made(self.calls, other.calls),
            searched: made(self.searched, other.searched),
            excluded: made(self.excluded, other.excluded),
            disagreements: made(self.disagreements, other.disagreements),
            steps: made(self.steps, other.steps),
            subnormal: made(self.subnormal, other.subnormal),
        }
    }
}

impl std::ops::AddAssign for SearchCounts {
    fn add_assign(&mut self, other: Self) {
        *self = self.with(other, |one, more| one + more);
    }
}

/// The counts since `before`.
impl std::ops::Sub for SearchCounts {
    type Output = Self;
    fn sub(self, before: Self) -> Self {
        self.with(before, |all, earlier| all - earlier)
    }
}

/// The cost of a root search in detection calls without one, besides its steps.
const SEARCH_WORK: u64 = 16;

/// The factor by which processors are slower where products are subnormal (Intel's optimization manual: an assist
/// of some 150 cycles for an operation of 4; measured by `audit cost`).
pub(crate) const SUBNORMAL_WORK: u64 = 32;

/// The least modulus whose powers, and powers of differences with it, stay normal up to the fifth.
const SMALLEST_OF_NORMAL_POWERS: f64 = 1e-40;

/// Returns whether products of these numbers may be subnormal.
pub(crate) fn have_subnormal_products(numbers: &[f64]) -> bool {
    numbers.iter().any(|number| *number != 0.0 && number.abs() < SMALLEST_OF_NORMAL_POWERS)
}
