//! Removes unreferenced artifacts in batches, so that the memory needed does not depend on the number of artifacts.
use super::{Digest, KEPT_FOLDER, Key, Store, StoreError, TRASH_FOLDER, age};
use futures_util::{StreamExt, TryStreamExt};
use object_store::ObjectStoreExt;
use std::{
    collections::HashSet,
    fs,
    path::Path,
    time::{Duration, SystemTime},
};

/// The number of artifacts that are handled in one batch.
const BATCH_SIZE: usize = 500;

impl Store {
    /// Removes every artifact that is older than `min_age` and to which nothing refers. Returns the number of removed
    /// artifacts. `named` returns those of the given digests to which something refers.
    ///
    /// An artifact that is being stored at the same time is not lost. It is first moved to the trash, where it can
    /// still be read. There it is checked again, immediately and in every later run. If the database refers to it by
    /// then, it is moved back. It is removed only after it was in the trash for the time `min_age`. Therefore a server
    /// that was started with the wrong database by mistake removes nothing within that time.
    ///
    /// # Errors
    ///
    /// Fails if the store cannot be listed or changed, or if the referenced digests can't be found. Artifacts in the
    /// trash are checked again in the next run.
    pub async fn remove_unreferenced<E: From<StoreError>, F: Future<Output = Result<HashSet<Digest>, E>>>(
        &self,
        min_age: Duration,
        mut named: impl FnMut(Vec<Digest>) -> F,
    ) -> Result<usize, E> {
        let mut batches = self.list(KEPT_FOLDER).try_chunks(BATCH_SIZE);
        while let Some(batch) = batches.next().await {
            let mut batch = batch.map_err(|error| error.1)?;
            batch.retain(|(_, age)| *age >= min_age);
            let digests: Vec<Digest> = batch.into_iter().map(|(digest, _)| digest).collect();
            let referenced = named(digests.clone()).await?;
            for digest in digests.iter().filter(|digest| !referenced.contains(digest)) {
                self.rename(&digest.key(KEPT_FOLDER), &digest.key(TRASH_FOLDER)).await?;
                // In a bucket, a moved object is a new copy with a new age.
                if let Some(folder) = &self.folder {
                    reset_age(&folder.join(digest.key(TRASH_FOLDER).as_ref()));
                }
            }
        }
        let mut removed = 0;
        let mut batches = self.list(TRASH_FOLDER).try_chunks(BATCH_SIZE);
        while let Some(batch) = batches.next().await {
            let batch = batch.map_err(|error| error.1)?;
            let referenced = named(batch.iter().map(|(digest, _)| digest.clone()).collect()).await?;
            for (digest, age) in batch {
                if referenced.contains(&digest) {
                    self.rename(&digest.key(TRASH_FOLDER), &digest.key(KEPT_FOLDER)).await?;
                } else if age >= min_age {
                    match self.objects.delete(&digest.key(TRASH_FOLDER)).await {
                        Ok(()) => removed += 1,
                        Err(object_store::Error::NotFound { .. }) => {}
                        Err(error) => return Err(StoreError::from(error).into()),
                    }
                }
            }
        }
        if let Some(folder) = self.folder.clone() {
            let parts = tokio::task::spawn_blocking(move || remove_parts(&folder, min_age)).await;
            removed += parts.map_err(|error| StoreError::Failed(error.to_string()))?;
        }
        Ok(removed)
    }

    /// Returns the digests of all artifacts. If an artifact is moved to the trash during the listing, its digest may be
    /// returned twice.
    pub fn digests(&self) -> impl futures_util::Stream<Item = Result<Digest, StoreError>> + Unpin {
        self.list(KEPT_FOLDER).chain(self.list(TRASH_FOLDER)).map_ok(|(digest, _)| digest)
    }

    /// Moves an object. Does nothing if another server has moved it.
    async fn rename(&self, from: &Key, to: &Key) -> Result<(), StoreError> {
        match self.objects.rename(from, to).await {
            Ok(()) | Err(object_store::Error::NotFound { .. }) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    /// Returns the artifacts in one of the store's two folders, with their ages.
    fn list(&self, prefix: &str) -> impl futures_util::Stream<Item = Result<(Digest, Duration), StoreError>> + Unpin {
        let listing = self.objects.list(Some(&Key::from(prefix))).map_err(StoreError::from);
        let found = listing.try_filter_map(async |meta| {
            let parts: Vec<String> = meta.location.parts().map(|part| part.as_ref().to_owned()).collect();
            // Other files are skipped, because this store did not write them.
            let [_, first, rest] = parts.as_slice() else { return Ok(None) };
            Ok(format!("{first}{rest}").parse().ok().map(|digest| (digest, age(&meta))))
        });
        found.boxed()
    }
}

/// Sets a file's modification time to now. Errors are ignored.
fn reset_age(file: &Path) {
    let touched = fs::File::options().write(true).open(file).and_then(|file| file.set_modified(SystemTime::now()));
    if let Err(error) = touched {
        tracing::debug!(%error, "the age of a file in the trash could not be reset");
    }
}

/// Removes incomplete artifacts that a killed server left behind, and returns their number. Until they are complete,
/// artifacts are called `NAME#NUMBER`, and listings leave them out.
fn remove_parts(folder: &Path, min_age: Duration) -> usize {
    let below = |folder: &Path| fs::read_dir(folder).into_iter().flatten().flatten();
    let folders =
        [KEPT_FOLDER, TRASH_FOLDER].into_iter().flat_map(|kept| below(&folder.join(kept)).map(|entry| entry.path()));
    let mut removed = 0;
    for entry in folders.filter(|path| path.is_dir()).flat_map(|path| below(&path)) {
        let is_part = entry.file_name().to_str().is_some_and(|name| name.contains('#'));
        let is_old = || {
            let written = entry.metadata().and_then(|data| data.modified());
            written.is_ok_and(|written| written.elapsed().is_ok_and(|age| age >= min_age))
        };
        if is_part && is_old() && fs::remove_file(entry.path()).is_ok() {
            removed += 1;
        }
    }
    removed
}
