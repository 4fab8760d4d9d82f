//! Finds the impulses of a pair in a record. The impulses are sorted, because a record may have a million.
use fosssim_model::{sim::Pair, trace::LoggedImpulse};

/// The kind and the numbers of a pair, as logged.
pub(crate) type PairKey = (i32, i32, i32);

/// Returns the key of `pair`, or `None` if the format has no numbers for the pair, so that no trace can log it.
pub(crate) fn pair_key(pair: Pair) -> Option<PairKey> {
    Some((pair.kind.code(), i32::try_from(pair.first).ok()?, i32::try_from(pair.second).ok()?))
}

/// Returns the pair that a logged impulse names.
pub(crate) const fn logged_key(logged: &LoggedImpulse) -> PairKey {
    (logged.kind, logged.first, logged.second)
}

/// The impulses of one record by their pairs.
#[derive(Debug, Default)]
pub(crate) struct Contacts(Vec<(PairKey, usize)>);

impl Contacts {
    /// Sorts a record's impulses by their pairs.
    pub fn from_impulses(impulses: &[LoggedImpulse]) -> Self {
        let mut keys: Vec<_> = impulses.iter().enumerate().map(|(index, logged)| (logged_key(logged), index)).collect();
        keys.sort_unstable();
        Self(keys)
    }

    /// Returns the indices of a pair's impulses, in the order of the record.
    pub fn indices_of(&self, key: PairKey) -> impl Iterator<Item = usize> {
        let begin = self.0.partition_point(|(other, _)| *other < key);
        self.0[begin..].iter().take_while(move |(other, _)| *other == key).map(|(_, index)| *index)
    }
}
