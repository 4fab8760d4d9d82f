//! How many things of a kind somebody may do at one time.
use std::{
    collections::HashMap,
    hash::Hash,
    sync::{Arc, Mutex, PoisonError},
};

/// Counts what is being done, by whom.
#[derive(Debug)]
pub(super) struct KeyLimit<K>(Arc<Mutex<HashMap<K, usize>>>);

impl<K> Default for KeyLimit<K> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

/// Leave to do one thing, until it is dropped.
#[derive(Debug)]
pub(super) struct Permit<K: Hash + Eq> {
    who: K,
    counts: Arc<Mutex<HashMap<K, usize>>>,
}

impl<K: Hash + Eq + Clone> KeyLimit<K> {
    /// Leave for one more, if fewer than `most` are being done.
    pub(super) fn pass(&self, who: K, most: usize) -> Option<Permit<K>> {
        let mut counts = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let count = counts.entry(who.clone()).or_insert(0);
        if *count >= most {
            return None;
        }
        *count += 1;
        Some(Permit { who, counts: self.0.clone() })
    }
}

impl<K: Hash + Eq> Drop for Permit<K> {
    fn drop(&mut self) {
        let mut counts = self.counts.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(count) = counts.get_mut(&self.who) {
            *count -= 1;
            if *count == 0 {
                counts.remove(&self.who);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_are_counted_and_given_back() {
        let limit = KeyLimit::default();
        let one = limit.pass("ada", 2);
        let two = limit.pass("ada", 2);
        assert!(one.is_some() && two.is_some() && limit.pass("ada", 2).is_none());
        assert!(limit.pass("bob", 2).is_some(), "another one's are their own");
        drop(one);
        assert!(limit.pass("ada", 2).is_some());
    }
}
