//! Options and counts of root searches.

/// When root searches run, although certificates may make them unnecessary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RootSearch {
    /// A search runs only if no certificate excludes an impact. The traces are the same as with all searches.
    #[default]
    OnDemand,
    /// A search runs for every pair.
    Always,
    /// A search runs for every pair. The certificate is computed as well, and disagreements are counted.
    Audit,
}

/// Counts of the root searches so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SearchCounts {
    /// The number of detection calls.
    pub calls: u64,
    /// The number of calls with a root search.
    pub searched: u64,
    /// The number of calls in which a certificate excluded an impact that the root finder found (audit only). It must
    /// stay zero.
    pub disagreements: u64,
    /// The number of steps of root searches ([`Zeros::steps`](fosssim_num::rpoly::Zeros::steps)).
    pub steps: u64,
    /// The additional work of passes with subnormal numbers, beyond the counted work.
    pub subnormal: u64,
}

impl SearchCounts {
    /// Returns the work of the calls, in units of a call that a certificate excludes. It is the same on every machine.
    pub const fn work(&self) -> u64 {
        self.calls + SEARCH_WORK * self.searched + self.steps + self.subnormal
    }
}

/// The cost of a root search in units of a detection call without one, in addition to its steps.
const SEARCH_WORK: u64 = 16;

/// The factor by which processors are slower with subnormal products (Intel's optimization manual: an assist of about
/// 150 cycles for an operation of 4; measured by `audit cost`).
pub(crate) const SUBNORMAL_WORK: u64 = 32;

/// The minimum absolute value for which powers up to the fifth, and powers of differences with it, are normal numbers.
const MIN_NORMAL_BASE: f64 = 1e-40;

/// Returns whether products of `numbers` may be subnormal.
pub(crate) fn have_subnormal_products(numbers: &[f64]) -> bool {
    numbers.iter().any(|number| *number != 0.0 && number.abs() < MIN_NORMAL_BASE)
}
