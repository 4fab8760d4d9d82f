//! The options for judging traces.
use super::rules::Book;
use fosssim_model::sim::RootSearch;

/// The options with which a trace is judged.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// The number of threads that judge steps. The results do not depend on it. The value 0 means one thread per core,
    /// but at most eight.
    pub threads: usize,
    /// Whether certificates may replace root searches.
    pub root_search: RootSearch,
    /// Whether judging stops after the first step with a finding. The outcome then has no verdict.
    pub stop_at_first: bool,
    /// The rule book that decides which finding stops judging.
    pub stopping_book: Book,
    /// Whether the trace is also judged by the fair rules
    /// ([`Outcome::fair`](super::Outcome::fair)).
    pub uses_fair_rules: bool,
    /// Whether every step and every call is judged separately, without shortcuts. The outcome is the same; tests
    /// compare both ways.
    pub judges_individually: bool,
}
