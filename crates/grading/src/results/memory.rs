//! Results that are gone when the grader is.
use super::{KeepError, Results};
use crate::{key::Key, result::SceneResult};
use std::{
    collections::BTreeMap,
    sync::{Mutex, MutexGuard, PoisonError},
};

/// Results in memory.
#[derive(Debug, Default)]
pub struct MemoryResults {
    kept: Mutex<BTreeMap<Key, SceneResult>>,
    /// The greatest number of keys; without it there is no limit.
    room: Option<usize>,
}

impl MemoryResults {
    /// A place for the results of a limited number of keys: later ones can't be kept, as on a disk that is full.
    #[must_use]
    pub fn with_room(room: usize) -> Self {
        Self { room: Some(room), ..Self::default() }
    }

    /// How many results are kept.
    #[must_use]
    pub fn len(&self) -> usize {
        self.lock().len()
    }

    /// Whether nothing is kept.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lock().is_empty()
    }

    fn lock(&self) -> MutexGuard<'_, BTreeMap<Key, SceneResult>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Results for MemoryResults {
    fn find(&self, key: &Key) -> Option<SceneResult> {
        self.lock().get(key).cloned()
    }

    fn keep(&self, key: &Key, _submission: &str, result: &SceneResult) -> Result<(), KeepError> {
        let mut kept = self.lock();
        if !kept.contains_key(key) && self.room.is_some_and(|room| kept.len() >= room) {
            return Err(KeepError::from(Box::from(format!("there is room for {} results only", kept.len()))));
        }
        kept.insert(key.clone(), result.clone());
        Ok(())
    }
}
