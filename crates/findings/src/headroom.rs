//! How much room the original's rules leave in a scene, as a value.
use super::finding::Finding;
use fosssim_num::tolerances::PARITY_COEFFICIENT;

/// The largest power of two that lengths are multiplied by.
pub const MOST_DOUBLINGS: u32 = 20;

/// A scene that fails the reference's own trace after this number of doublings or fewer can't be graded fairly by the
/// original's rules: a correct program that rounds otherwise is off by more than the last place.
pub const FAIR_DOUBLINGS: u32 = 1;

/// Where the original's rules fail the reference's own trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstFailure {
    /// The number of times that lengths were doubled; 0 is the scene as it is.
    pub doublings: u32,
    /// How many findings there are.
    pub findings: u64,
    /// The first one; `None` when only residuals fail.
    pub first: Option<Finding>,
}

/// A scene whose largest coefficient leaves less room than this many units in the last place can't be graded fairly:
/// correct programs differ by more.
pub const FAIR_ROOM: f64 = 2.0;

/// The headroom of one scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Headroom {
    /// The largest modulus of a coefficient at the scene's own size; `None` where its traces hold no polynomials: an
    /// exact copy of states passes at every size.
    pub largest: Option<f64>,
    /// The first failure up to [`MOST_DOUBLINGS`].
    pub failure: Option<FirstFailure>,
}

impl Headroom {
    /// How many units in the last place of the largest coefficient the original's bound holds; infinite without
    /// polynomials.
    #[must_use]
    pub fn room(&self) -> f64 {
        self.largest.map_or(f64::INFINITY, |largest| PARITY_COEFFICIENT / (largest.next_up() - largest))
    }

    /// Whether the original's rules can grade the scene at its own size.
    #[must_use]
    pub fn is_fair(&self) -> bool {
        self.room() >= FAIR_ROOM && self.failure.is_none_or(|failure| failure.doublings > FAIR_DOUBLINGS)
    }
}
