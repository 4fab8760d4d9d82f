//! Faults of a contest program's search for nearby pairs.
use fosssim_model::sim::{Pair, PairKind};
use serde::{Deserialize, Serialize};

/// The nearby pairs that a search misses or reports twice, and for comparison those that it reports once.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct WrongPairs {
    /// The first wrong pair and its step; `None` if the explanation covers several traces.
    pub first: Option<(Pair, u32)>,
    /// The number of pairs for each kind.
    #[serde(rename = "kinds")]
    pub counts_by_kind: Vec<PairCounts>,
}

/// The nearby pairs of one kind, counted.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PairCounts {
    /// The kind of the pairs.
    pub kind: PairKind,
    /// The number of pairs that are reported zero times, once, and twice.
    #[serde(rename = "times")]
    pub counts_by_times: [u64; 3],
    /// For each trait, the number of pairs that have it, in the order of the table of traits. Each number is split as
    /// in `counts_by_times`.
    pub traits: Vec<[u64; 3]>,
}

impl WrongPairs {
    /// Keeps only the faults that another trace shows, and takes the first wrong pair from it.
    pub fn limit_to(&mut self, other: &Self) {
        self.first = other.first;
        for (one, other) in self.counts_by_kind.iter_mut().zip(&other.counts_by_kind) {
            for times in [0, 2].into_iter().filter(|&times| other.counts_by_times[times] == 0) {
                one.counts_by_times[times] = 0;
            }
        }
    }

    /// Adds the counts of another trace.
    pub fn add(&mut self, other: &Self) {
        let add = |one: &mut [u64; 3], other: &[u64; 3]| one.iter_mut().zip(other).for_each(|(one, more)| *one += more);
        self.first = None;
        for (one, other) in self.counts_by_kind.iter_mut().zip(&other.counts_by_kind) {
            add(&mut one.counts_by_times, &other.counts_by_times);
            one.traits.iter_mut().zip(&other.traits).for_each(|(one, other)| add(one, other));
        }
    }
}
