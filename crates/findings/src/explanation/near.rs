//! Faults of a contest's search for near pairs.
use fosssim_model::sim::{Pair, PairKind};
use serde::{Deserialize, Serialize};

/// The near pairs that a search misses or reports twice, and those that it reports once.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct WrongPairs {
    /// The first wrong pair and its step, in one trace.
    pub first: Option<(Pair, u32)>,
    /// The numbers of pairs, by kind.
    pub kinds: Vec<PairCounts>,
}

/// The near pairs of a kind.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PairCounts {
    /// The kind of the pairs.
    pub kind: PairKind,
    /// The numbers of pairs that are reported zero times, once and twice.
    pub times: [u64; 3],
    /// The numbers of pairs with each trait, in the order of the table of traits.
    pub traits: Vec<[u64; 3]>,
}

impl WrongPairs {
    /// Adds the counts of another trace.
    pub fn add(&mut self, other: &Self) {
        let add = |one: &mut [u64; 3], other: &[u64; 3]| one.iter_mut().zip(other).for_each(|(one, more)| *one += more);
        self.first = None;
        for (one, other) in self.kinds.iter_mut().zip(&other.kinds) {
            add(&mut one.times, &other.times);
            one.traits.iter_mut().zip(&other.traits).for_each(|(one, other)| add(one, other));
        }
    }
}
