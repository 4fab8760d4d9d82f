//! The options for judging traces.
use super::rules::Book;
use fosssim_model::sim::RootSearch;

/// The options for judging.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// Number of threads that judge steps; the results do not depend on it. 0 takes one per core, eight at most.
    pub threads: usize,
    /// Whether certificates may replace root searches.
    pub root_search: RootSearch,
    /// Stop after the first step with a finding (a hopeless run is cut short; the outcome then has no verdict).
    pub stop_at_first: bool,
    /// The book that decides where that is.
    pub stop_by: Book,
    /// Judge by the fair rules as well ([`Outcome::fair`](super::Outcome::fair)).
    pub fair: bool,
    /// Look at every step and every call by itself, the long way. The outcome is the same; it shows that it is.
    pub one_by_one: bool,
}
