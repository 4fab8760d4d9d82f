//! Results in a folder: a journal with one JSON line per judged scene.
//!
//! A line is written and flushed before its result is told. A line cut short by a crash is dropped on the next opening.
//! Lines are what [`form`] writes; those of other versions are passed over. A lock keeps two graders out of one folder.
use super::{KeepError, Results};
use crate::{
    form::{self, Entry},
    key::Key,
    result::SceneResult,
};
use std::{
    collections::BTreeMap,
    error::Error,
    fs::{File, OpenOptions},
    io::{self, BufRead, BufReader, Seek, Write},
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// Why a folder can't be used for results.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// Another grader has it.
    #[error("another grader works in {folder}: wait for it, or give another --output folder")]
    Locked {
        /// The folder.
        folder: PathBuf,
    },
    /// The operating system refuses.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
}

/// Results in one output folder, locked while it lives.
#[derive(Debug)]
pub struct FolderResults {
    journal: Mutex<Journal>,
    _lock: File,
}

#[derive(Debug)]
struct Journal {
    path: PathBuf,
    file: File,
    found: BTreeMap<Key, SceneResult>,
}

impl FolderResults {
    /// Opens or creates the journal in an existing folder. With `fresh` earlier results are forgotten.
    ///
    /// # Errors
    /// When another grader holds the folder, or files can't be read or written.
    pub fn open(folder: &Path, fresh: bool) -> Result<Self, OpenError> {
        let lock_path = folder.join(".lock");
        let at = |path: &Path| {
            let path = path.to_owned();
            move |source| OpenError::Io { path, source }
        };
        let path = folder.join("journal.jsonl");
        for path in [&lock_path, &path] {
            // A link would have another file of ours cut and written to.
            if path.is_symlink() {
                return Err(at(path)(io::Error::other("it is a link, which is not followed: remove it")));
            }
        }
        let lock = OpenOptions::new().create(true).append(true).open(&lock_path).map_err(at(&lock_path))?;
        lock.try_lock().map_err(|error| match error {
            std::fs::TryLockError::WouldBlock => OpenError::Locked { folder: folder.to_owned() },
            std::fs::TryLockError::Error(source) => OpenError::Io { path: lock_path.clone(), source },
        })?;
        let mut file =
            OpenOptions::new().create(true).read(true).write(true).truncate(false).open(&path).map_err(at(&path))?;
        let mut found = BTreeMap::new();
        let mut sound = 0;
        if !fresh {
            let mut reader = BufReader::new(&mut file);
            let mut line = Vec::new();
            loop {
                line.clear();
                let length = reader.read_until(b'\n', &mut line).map_err(at(&path))?;
                if length == 0 || line.last() != Some(&b'\n') {
                    break;
                }
                sound += length as u64;
                // A line that somebody damaged costs its own result only.
                if let Some(entry) = read_line(&line) {
                    found.insert(entry.key, entry.result);
                }
            }
        }
        // What a crash left behind the last whole line goes away.
        file.set_len(sound).map_err(at(&path))?;
        file.seek(io::SeekFrom::Start(sound)).map_err(at(&path))?;
        Ok(Self { journal: Mutex::new(Journal { path, file, found }), _lock: lock })
    }

    fn journal(&self) -> MutexGuard<'_, Journal> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Results for FolderResults {
    fn find(&self, key: &Key) -> Option<SceneResult> {
        self.journal().found.get(key).cloned()
    }

    fn keep(&self, key: &Key, submission: &str, result: &SceneResult) -> Result<(), KeepError> {
        let line = line(key, submission, result);
        let Journal { path, file, found } = &mut *self.journal();
        append(file, &line).map_err(|source| {
            let error: Box<dyn Error + Send + Sync> = Box::new(OpenError::Io { path: path.clone(), source });
            KeepError::from(error)
        })?;
        found.insert(key.clone(), result.clone());
        Ok(())
    }
}

/// Writes a whole line or nothing.
fn append(file: &mut File, line: &[u8]) -> io::Result<()> {
    let before = file.stream_position().unwrap_or(0);
    file.write_all(line).and_then(|()| file.flush()).inspect_err(|_| {
        // Half a line must not stand before the next one; opening would drop it anyway.
        let _ = file.set_len(before);
        let _ = file.seek(io::SeekFrom::Start(before));
    })
}

/// The line that keeps a result, with its end.
#[must_use]
pub fn line(key: &Key, submission: &str, result: &SceneResult) -> Vec<u8> {
    let mut line = form::write(key, submission, result);
    line.push(b'\n');
    line
}

/// The result that a line keeps; `None` where the line is damaged, or of another version.
#[must_use]
pub fn read_line(line: &[u8]) -> Option<Entry> {
    form::read(line)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Verdict, result::Reason};

    fn result(verdict: Verdict) -> SceneResult {
        SceneResult::without_run("Group/scene", 5, verdict, Reason::Right)
    }

    fn key(word: &str) -> Key {
        Key::of(&blake3::hash(b"program"), b"scene", &[word])
    }

    #[test]
    fn results_survive_and_a_line_cut_short_does_not_matter() {
        let folder = tempfile::tempdir().expect("folder");
        let journal = FolderResults::open(folder.path(), false).expect("journal");
        journal.keep(&key("a"), "sub", &result(Verdict::WrongAnswer)).expect("kept");
        journal.keep(&key("b"), "sub", &result(Verdict::Accepted)).expect("kept");
        drop(journal);
        let path = folder.path().join("journal.jsonl");
        let bytes = std::fs::read(&path).expect("bytes");
        std::fs::write(&path, &bytes[..bytes.len() - 5]).expect("cut");
        let journal = FolderResults::open(folder.path(), false).expect("journal");
        let found = journal.find(&key("a")).expect("kept");
        assert_eq!(found, result(Verdict::WrongAnswer));
        assert_eq!(journal.find(&key("b")), None);
        journal.keep(&key("b"), "sub", &result(Verdict::Accepted)).expect("kept");
        drop(journal);
        assert!(FolderResults::open(folder.path(), false).expect("journal").find(&key("b")).is_some());
    }

    #[test]
    fn two_graders_can_not_share_a_folder() {
        let folder = tempfile::tempdir().expect("folder");
        let _first = FolderResults::open(folder.path(), false).expect("journal");
        assert!(matches!(FolderResults::open(folder.path(), false), Err(OpenError::Locked { .. })));
    }

    #[test]
    fn a_journal_that_is_a_link_is_not_followed() {
        let folder = tempfile::tempdir().expect("folder");
        let other = folder.path().join("other");
        std::fs::write(&other, "something else").expect("a file");
        for name in ["journal.jsonl", ".lock"] {
            let output = tempfile::tempdir().expect("folder");
            std::os::unix::fs::symlink(&other, output.path().join(name)).expect("a link");
            let refused = FolderResults::open(output.path(), true).expect_err("it is a link").to_string();
            assert!(refused.contains(name) && refused.contains("is a link"), "{refused}");
        }
        assert_eq!(std::fs::read(&other).expect("a file"), b"something else");
    }

    #[test]
    fn fresh_forgets() {
        let folder = tempfile::tempdir().expect("folder");
        let journal = FolderResults::open(folder.path(), false).expect("journal");
        journal.keep(&key("a"), "sub", &result(Verdict::TimeLimit)).expect("kept");
        drop(journal);
        assert!(FolderResults::open(folder.path(), true).expect("journal").find(&key("a")).is_none());
    }

    #[test]
    fn a_full_disk_is_told_and_leaves_whole_lines() {
        let folder = tempfile::tempdir().expect("folder");
        let journal = FolderResults::open(folder.path(), false).expect("journal");
        journal.keep(&key("a"), "sub", &result(Verdict::Accepted)).expect("kept");
        // Whatever is written here finds no room.
        journal.journal().file = OpenOptions::new().write(true).open("/dev/full").expect("a full device");
        let error = journal.keep(&key("b"), "sub", &result(Verdict::Accepted)).expect_err("full").to_string();
        assert!(error.contains("journal.jsonl") && error.contains("No space left"), "{error}");
        assert_eq!(journal.find(&key("b")), None);
        drop(journal);
        let again = FolderResults::open(folder.path(), false).expect("journal");
        assert!(again.find(&key("a")).is_some() && again.find(&key("b")).is_none());
    }
}
