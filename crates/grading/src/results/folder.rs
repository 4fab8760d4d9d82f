//! Stores results in a folder. A journal has one line of JSON for each scene that was judged.
//!
//! A line is written and flushed before its result is reported. If a crash cuts a line short, the line is removed when
//! the journal is next opened. Lines of other versions are ignored. A lock prevents two graders from using the same
//! folder.
use super::{Results, StoreError, format_line, read_line};
use crate::{key::ResultKey, result::SceneResult};
use fosssim_files::{FileError, Folder};
use std::{
    collections::BTreeMap,
    ffi::OsStr,
    fs::File,
    io::{self, BufRead, BufReader, Read, Seek, Write},
    os::unix::fs::MetadataExt,
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// The name of the journal file.
pub const JOURNAL_NAME: &str = "journal.jsonl";

/// The name of the file that a grader keeps locked while it uses the folder.
pub const LOCK_FILE: &str = ".lock";

/// The maximum size of a journal, in bytes. It is four times the size for 10,000 submissions with 85 scenes each, if
/// all scenes are wrong and have long explanations.
pub const MAX_JOURNAL_BYTES: u64 = 16 << 30;

/// The maximum length of a line, in bytes. A result has a few thousand bytes. If a line is longer, the journal is
/// damaged.
pub const MAX_LINE_BYTES: usize = 16 << 20;

/// The results in an output folder. The folder is locked as long as this value exists.
#[derive(Debug)]
pub struct FolderResults {
    journal: Mutex<Journal>,
    _lock: File,
}

#[derive(Debug)]
struct Journal {
    path: PathBuf,
    file: File,
    results: BTreeMap<ResultKey, SceneResult>,
}

impl FolderResults {
    /// Opens the journal in an existing folder, or creates it. With `discards_old`, earlier results are discarded.
    ///
    /// # Errors
    ///
    /// Fails if another grader has locked the folder, or files can't be read or written.
    pub fn open(folder: &Path, discards_old: bool) -> io::Result<Self> {
        let at = |name: &str| {
            let path = folder.join(name);
            move |reason: io::Error| io::Error::new(reason.kind(), format!("{}: {reason}", path.display()))
        };
        let opened = Folder::open_to_write(folder).map_err(at(""))?;
        let lock = open_own_file(&opened, LOCK_FILE).map_err(at(LOCK_FILE))?;
        lock.try_lock().map_err(|error| match error {
            std::fs::TryLockError::WouldBlock => io::Error::other(format!(
                "another grader is using {}: wait for it, or choose another --output folder",
                folder.display()
            )),
            std::fs::TryLockError::Error(reason) => at(LOCK_FILE)(reason),
        })?;
        let mut file = open_own_file(&opened, JOURNAL_NAME).map_err(at(JOURNAL_NAME))?;
        let metadata = file.metadata().map_err(at(JOURNAL_NAME))?;
        if metadata.len() > MAX_JOURNAL_BYTES && !discards_old {
            let text = format!("the journal has more than {MAX_JOURNAL_BYTES} bytes; --fresh starts a new one");
            return Err(at(JOURNAL_NAME)(io::Error::other(text)));
        }
        let mut found = BTreeMap::new();
        let sound = if discards_old { 0 } else { read(&file, &mut found).map_err(at(JOURNAL_NAME))? };
        if metadata.nlink() > 1 {
            // The journal has several names (hard links), because of a backup or a student. It is copied, so that the
            // file under the other name does not change.
            file = copy_journal_start(&file, sound, &opened).map_err(at(JOURNAL_NAME))?;
        }
        // The bytes after the last whole line are removed; a crash left them.
        file.set_len(sound).map_err(at(JOURNAL_NAME))?;
        file.seek(io::SeekFrom::Start(sound)).map_err(at(JOURNAL_NAME))?;
        let path = folder.join(JOURNAL_NAME);
        Ok(Self { journal: Mutex::new(Journal { path, file, results: found }), _lock: lock })
    }

    fn journal(&self) -> MutexGuard<'_, Journal> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn open_own_file(folder: &Folder, name: &str) -> io::Result<File> {
    folder.own_file(name).map_err(|error| match error {
        FileError::System { source, .. } => source,
        FileError::NotRegular { what, .. } => {
            io::Error::other(format!("this is {what}, not a file that the grader wrote; remove it"))
        }
        error => io::Error::other(error),
    })
}

/// Reads the results in a journal. Returns the position after the last whole line.
fn read(file: &File, found: &mut BTreeMap<ResultKey, SceneResult>) -> io::Result<u64> {
    let mut sound = 0;
    for_each_line(BufReader::new(file), |line| -> io::Result<()> {
        sound += line.len() as u64;
        // A damaged line is skipped. The other lines are still valid.
        if let Some(entry) = read_line(line) {
            found.insert(entry.key, entry.result);
        }
        Ok(())
    })?;
    Ok(sound)
}

/// Calls `take` for each whole line of a journal.
///
/// # Errors
///
/// Fails if the journal can't be read, if it has a line that is longer than any result, or if `take` fails.
pub fn for_each_line<E: From<io::Error>>(
    mut journal: impl BufRead,
    mut take: impl FnMut(&[u8]) -> Result<(), E>,
) -> Result<(), E> {
    let mut line = Vec::new();
    loop {
        line.clear();
        let read = journal.by_ref().take(MAX_LINE_BYTES as u64).read_until(b'\n', &mut line)?;
        if line.last() == Some(&b'\n') {
            take(&line)?;
        } else if read < MAX_LINE_BYTES {
            return Ok(());
        } else {
            let text = format!(
                "a line of the journal exceeds the limit of {MAX_LINE_BYTES} bytes; remove the line, and its scenes \
                    are graded again"
            );
            return Err(io::Error::other(text).into());
        }
    }
}

/// Creates a new journal with the first `length` bytes of another.
fn copy_journal_start(mut file: &File, length: u64, folder: &Folder) -> io::Result<File> {
    let mut own = folder.replacement(OsStr::new(JOURNAL_NAME), None)?;
    file.rewind()?;
    io::copy(&mut file.take(length), &mut own)?;
    own.finish_open()
}

impl Results for FolderResults {
    fn find(&self, key: &ResultKey) -> Option<SceneResult> {
        self.journal().results.get(key).cloned()
    }

    fn store(&self, key: &ResultKey, submission: &str, result: &SceneResult) -> Result<(), StoreError> {
        let line = format_line(key, submission, result);
        let Journal { path, file, results: found } = &mut *self.journal();
        append(file, &line).map_err(|reason| StoreError(format!("{}: {reason}", path.display())))?;
        found.insert(key.clone(), result.clone());
        Ok(())
    }
}

/// Appends a line. If that fails, the file is as long as before.
fn append(file: &mut File, line: &[u8]) -> io::Result<()> {
    let before = file.stream_position().unwrap_or(0);
    file.write_all(line).and_then(|()| file.flush()).inspect_err(|_| {
        // The file is cut to its earlier length, so that the next line does not follow half a line.
        let _ = file.set_len(before);
        let _ = file.seek(io::SeekFrom::Start(before));
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Verdict, result::Reason};

    fn result(verdict: Verdict) -> SceneResult {
        SceneResult::without_run("Group/scene", 5, verdict, Reason::Right)
    }

    fn key(word: &str) -> ResultKey {
        ResultKey::from_program(&blake3::hash(b"program"), b"scene", &[word])
    }

    #[test]
    fn results_survive_and_a_line_cut_short_does_not_matter() {
        let folder = tempfile::tempdir().expect("folder");
        let journal = FolderResults::open(folder.path(), false).expect("journal");
        journal.store(&key("a"), "sub", &result(Verdict::WrongAnswer)).expect("kept");
        journal.store(&key("b"), "sub", &result(Verdict::Accepted)).expect("kept");
        drop(journal);
        let path = folder.path().join("journal.jsonl");
        let bytes = std::fs::read(&path).expect("bytes");
        std::fs::write(&path, &bytes[..bytes.len() - 5]).expect("cut");
        let journal = FolderResults::open(folder.path(), false).expect("journal");
        let found = journal.find(&key("a")).expect("kept");
        assert_eq!(found, result(Verdict::WrongAnswer));
        assert_eq!(journal.find(&key("b")), None);
        journal.store(&key("b"), "sub", &result(Verdict::Accepted)).expect("kept");
        drop(journal);
        assert!(FolderResults::open(folder.path(), false).expect("journal").find(&key("b")).is_some());
    }

    #[test]
    fn two_graders_can_not_share_a_folder() {
        let folder = tempfile::tempdir().expect("folder");
        let _first = FolderResults::open(folder.path(), false).expect("journal");
        let refused = FolderResults::open(folder.path(), false).expect_err("it is locked").to_string();
        assert!(refused.starts_with("another grader is using "), "{refused}");
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
            assert!(refused.contains(name) && refused.contains("is a symbolic link"), "{refused}");
        }
        assert_eq!(std::fs::read(&other).expect("a file"), b"something else");
    }

    #[test]
    fn a_journal_with_a_second_name_is_read_and_not_changed() {
        let folder = tempfile::tempdir().expect("folder");
        let journal = FolderResults::open(folder.path(), false).expect("journal");
        journal.store(&key("a"), "sub", &result(Verdict::TimeLimit)).expect("kept");
        drop(journal);
        let (path, backup) = (folder.path().join(JOURNAL_NAME), folder.path().join("backup"));
        std::fs::hard_link(&path, &backup).expect("a backup");
        let before = std::fs::read(&backup).expect("bytes");
        let journal = FolderResults::open(folder.path(), false).expect("journal");
        assert!(journal.find(&key("a")).is_some());
        journal.store(&key("b"), "sub", &result(Verdict::Accepted)).expect("kept");
        drop(journal);
        assert_eq!(std::fs::read(&backup).expect("bytes"), before);
        assert!(FolderResults::open(folder.path(), false).expect("journal").find(&key("b")).is_some());
        drop(FolderResults::open(folder.path(), true).expect("journal"));
        assert_eq!(std::fs::read(&backup).expect("bytes"), before);
    }

    #[test]
    fn foreign_lines_take_no_memory_and_no_time() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join(JOURNAL_NAME);
        let journal = File::create(&path).expect("a file");
        journal.set_len(MAX_JOURNAL_BYTES + 1).expect("a hole");
        let refused = FolderResults::open(folder.path(), false).expect_err("too large").to_string();
        assert!(refused.contains("journal.jsonl") && refused.contains("--fresh"), "{refused}");
        // A line without an end uses neither memory nor time, and nothing is changed.
        journal.set_len(4 << 30).expect("a hole");
        let refused = FolderResults::open(folder.path(), false).expect_err("damaged").to_string();
        assert!(refused.contains("the limit of 16777216 bytes"), "{refused}");
        assert_eq!(journal.metadata().expect("data").len(), 4 << 30);
        assert!(FolderResults::open(folder.path(), true).is_ok(), "what is forgotten is not read");
    }

    #[test]
    fn fresh_forgets() {
        let folder = tempfile::tempdir().expect("folder");
        let journal = FolderResults::open(folder.path(), false).expect("journal");
        journal.store(&key("a"), "sub", &result(Verdict::TimeLimit)).expect("kept");
        drop(journal);
        assert!(FolderResults::open(folder.path(), true).expect("journal").find(&key("a")).is_none());
    }

    #[test]
    fn a_full_disk_is_reported_and_leaves_complete_lines() {
        let folder = tempfile::tempdir().expect("folder");
        let journal = FolderResults::open(folder.path(), false).expect("journal");
        journal.store(&key("a"), "sub", &result(Verdict::Accepted)).expect("kept");
        // There is no space for this write.
        journal.journal().file = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("a full device");
        let error = journal.store(&key("b"), "sub", &result(Verdict::Accepted)).expect_err("full").to_string();
        assert!(error.contains("journal.jsonl") && error.contains("No space left"), "{error}");
        assert_eq!(journal.find(&key("b")), None);
        drop(journal);
        let again = FolderResults::open(folder.path(), false).expect("journal");
        assert!(again.find(&key("a")).is_some() && again.find(&key("b")).is_none());
    }
}
