//! The journal of a grading: one JSON line per judged scene, so that nothing is lost and nothing is done twice.
//!
//! A line is written and flushed before its result is reported. A line cut short by a crash is dropped on the next
//! opening. Results are found by a key that digests everything they depend on ([`Key`]), so a changed program, scene,
//! rule or grader is simply not found. A lock keeps two graders out of one folder.
use super::{grade::SceneResult, kept::KeptExplanation, verdict::Verdict};
use fosssim_judge::fair::Cause;
use serde::{Deserialize, Serialize};
use std::{
    collections::BTreeMap,
    fs::{File, OpenOptions},
    io::{self, BufRead, BufReader, Seek, Write},
    path::{Path, PathBuf},
    sync::OnceLock,
    time::Duration,
};

/// What a result depends on, digested.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Key(String);

impl Key {
    /// The key of a run: digests of program and scene, and words for everything else that matters (rules, limits, the
    /// command, the way of judging). What judges is always part of it.
    #[must_use]
    pub fn of(program: &blake3::Hash, scene: &[u8], words: &[&str]) -> Self {
        Self::by(judge(), program, scene, words)
    }

    /// The key of a run that this build judges.
    fn by(judge: &str, program: &blake3::Hash, scene: &[u8], words: &[&str]) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(program.as_bytes());
        hasher.update(blake3::hash(scene).as_bytes());
        for word in words.iter().chain(&[judge]) {
            hasher.update(&(word.len() as u64).to_le_bytes());
            hasher.update(word.as_bytes());
        }
        Self(hasher.finalize().to_hex().as_str()[..32].to_owned())
    }
}

/// The digest of this very program: two builds of one version may judge differently. Its version where that can't be read.
fn judge() -> &'static str {
    static JUDGE: OnceLock<String> = OnceLock::new();
    JUDGE.get_or_init(|| {
        let mut hasher = blake3::Hasher::new();
        let digested = File::open("/proc/self/exe").and_then(|file| hasher.update_reader(file).map(|_| ()));
        digested.map_or_else(|_| env!("CARGO_PKG_VERSION").to_owned(), |()| hasher.finalize().to_hex().to_string())
    })
}

/// Why the journal can't be used.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
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

/// The journal of one output folder, locked while it lives.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    found: BTreeMap<Key, SceneResult>,
    _lock: File,
}

impl Journal {
    /// Opens or creates the journal in an existing folder. With `fresh` earlier results are forgotten.
    ///
    /// # Errors
    /// When another grader holds the folder, or files can't be read or written.
    pub fn open(folder: &Path, fresh: bool) -> Result<Self, JournalError> {
        let lock_path = folder.join(".lock");
        let at = |path: &Path| {
            let path = path.to_owned();
            move |source| JournalError::Io { path, source }
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
            std::fs::TryLockError::WouldBlock => JournalError::Locked { folder: folder.to_owned() },
            std::fs::TryLockError::Error(source) => JournalError::Io { path: lock_path.clone(), source },
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
                if let Some((key, result)) = read_line(&line) {
                    found.insert(key, result);
                }
            }
        }
        // What a crash left behind the last whole line goes away.
        file.set_len(sound).map_err(at(&path))?;
        file.seek(io::SeekFrom::Start(sound)).map_err(at(&path))?;
        Ok(Self { path, file, found, _lock: lock })
    }

    /// An earlier result.
    #[must_use]
    pub fn find(&self, key: &Key) -> Option<SceneResult> {
        self.found.get(key).cloned()
    }

    /// All results that are known, by key.
    #[must_use]
    pub fn snapshot(&self) -> BTreeMap<Key, SceneResult> {
        self.found.clone()
    }

    /// Keeps a result. Faults of ours and scenes that were not run are not kept: they are tried again.
    ///
    /// # Errors
    /// When the line can't be written, for example because the disk is full.
    pub fn keep(&mut self, key: &Key, submission: &str, result: &SceneResult) -> Result<(), JournalError> {
        if matches!(result.verdict, Verdict::JudgeError | Verdict::NotRun) {
            return Ok(());
        }
        let line = line(key, submission, result);
        let before = self.file.stream_position().unwrap_or(0);
        let written = self.file.write_all(&line).and_then(|()| self.file.flush());
        written.map_err(|source| {
            // Half a line must not stand before the next one; opening would drop it anyway.
            let _ = self.file.set_len(before);
            let _ = self.file.seek(io::SeekFrom::Start(before));
            JournalError::Io { path: self.path.clone(), source }
        })?;
        self.found.insert(key.clone(), result.clone());
        Ok(())
    }
}

/// The line that keeps a result, with its end.
#[must_use]
pub fn line(key: &Key, submission: &str, result: &SceneResult) -> Vec<u8> {
    let mut line = serde_json::to_vec(&Entry::new(key, submission, result)).unwrap_or_default();
    line.push(b'\n');
    line
}

/// The result that a line keeps; `None` where the line is damaged.
#[must_use]
pub fn read_line(line: &[u8]) -> Option<(Key, SceneResult)> {
    serde_json::from_slice::<Entry>(line).ok()?.into_result()
}

/// One line of the file. Points are not part of it: they follow from the suite.
#[derive(Debug, Serialize, Deserialize)]
struct Entry {
    key: String,
    submission: String,
    scene: String,
    verdict: String,
    summary: String,
    differs: Option<String>,
    details: Vec<String>,
    #[serde(default)]
    explanations: Vec<KeptExplanation>,
    right_steps: u32,
    steps: u32,
    cpu_seconds: f64,
    wall_seconds: f64,
    memory: Option<u64>,
    stdout: String,
    stderr: String,
    #[serde(default)]
    card: Option<String>,
}

impl Entry {
    fn new(key: &Key, submission: &str, result: &SceneResult) -> Self {
        Self {
            key: key.0.clone(),
            submission: submission.to_owned(),
            scene: result.scene.clone(),
            verdict: result.verdict.words().to_owned(),
            summary: result.summary.clone(),
            differs: result.differs.map(|cause| cause.key().to_owned()),
            details: result.details.clone(),
            explanations: result.explanations.iter().map(KeptExplanation::from).collect(),
            right_steps: result.right_steps,
            steps: result.steps,
            cpu_seconds: result.cpu.as_secs_f64(),
            wall_seconds: result.wall.as_secs_f64(),
            memory: result.memory,
            stdout: result.stdout.clone(),
            stderr: result.stderr.clone(),
            card: result.card.clone(),
        }
    }

    fn into_result(self) -> Option<(Key, SceneResult)> {
        let verdict = Verdict::from_words(&self.verdict)?;
        let seconds = |value: f64| Duration::try_from_secs_f64(value).unwrap_or_default();
        let result = SceneResult {
            scene: self.scene,
            verdict,
            summary: self.summary,
            differs: self.differs.as_deref().and_then(Cause::from_key),
            details: self.details,
            explanations: self.explanations.into_iter().map(Into::into).collect(),
            right_steps: self.right_steps,
            steps: self.steps,
            cpu: seconds(self.cpu_seconds),
            wall: seconds(self.wall_seconds),
            memory: self.memory,
            stdout: self.stdout,
            stderr: self.stderr,
            card: self.card,
        };
        Some((Key(self.key), result))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn result(verdict: Verdict) -> SceneResult {
        SceneResult {
            scene: "Group/scene".to_owned(),
            verdict,
            summary: "a summary".to_owned(),
            differs: Some(Cause::ContactTime),
            details: vec!["a detail".to_owned()],
            explanations: Vec::new(),
            right_steps: 3,
            steps: 5,
            cpu: Duration::from_millis(5),
            wall: Duration::from_millis(7),
            memory: Some(4096),
            stdout: "out\u{1b}[31m".to_owned(),
            stderr: String::new(),
            card: Some("0123".to_owned()),
        }
    }

    fn key(word: &str) -> Key {
        Key::of(&blake3::hash(b"program"), b"scene", &[word])
    }

    #[test]
    fn results_survive_and_a_line_cut_short_does_not_matter() {
        let folder = tempfile::tempdir().expect("folder");
        let mut journal = Journal::open(folder.path(), false).expect("journal");
        journal.keep(&key("a"), "sub", &result(Verdict::WrongAnswer)).expect("kept");
        journal.keep(&key("b"), "sub", &result(Verdict::Accepted)).expect("kept");
        drop(journal);
        let path = folder.path().join("journal.jsonl");
        let bytes = std::fs::read(&path).expect("bytes");
        std::fs::write(&path, &bytes[..bytes.len() - 5]).expect("cut");
        let mut journal = Journal::open(folder.path(), false).expect("journal");
        let found = journal.find(&key("a")).expect("kept");
        assert_eq!(found, result(Verdict::WrongAnswer));
        assert_eq!(journal.find(&key("b")), None);
        journal.keep(&key("b"), "sub", &result(Verdict::Accepted)).expect("kept");
        drop(journal);
        assert!(Journal::open(folder.path(), false).expect("journal").find(&key("b")).is_some());
    }

    #[test]
    fn two_graders_can_not_share_a_folder() {
        let folder = tempfile::tempdir().expect("folder");
        let _first = Journal::open(folder.path(), false).expect("journal");
        assert!(matches!(Journal::open(folder.path(), false), Err(JournalError::Locked { .. })));
    }

    #[test]
    fn a_journal_that_is_a_link_is_not_followed() {
        let folder = tempfile::tempdir().expect("folder");
        let other = folder.path().join("other");
        std::fs::write(&other, "something else").expect("a file");
        for name in ["journal.jsonl", ".lock"] {
            let output = tempfile::tempdir().expect("folder");
            std::os::unix::fs::symlink(&other, output.path().join(name)).expect("a link");
            let refused = Journal::open(output.path(), true).expect_err("it is a link").to_string();
            assert!(refused.contains(name) && refused.contains("is a link"), "{refused}");
        }
        assert_eq!(std::fs::read(&other).expect("a file"), b"something else");
    }

    #[test]
    fn faults_of_ours_are_tried_again_and_fresh_forgets() {
        let folder = tempfile::tempdir().expect("folder");
        let mut journal = Journal::open(folder.path(), false).expect("journal");
        journal.keep(&key("a"), "sub", &result(Verdict::JudgeError)).expect("no error");
        assert_eq!(journal.find(&key("a")), None);
        journal.keep(&key("a"), "sub", &result(Verdict::TimeLimit)).expect("kept");
        drop(journal);
        assert!(Journal::open(folder.path(), true).expect("journal").find(&key("a")).is_none());
    }

    #[test]
    fn keys_differ_when_anything_differs() {
        let program = blake3::hash(b"program");
        assert_ne!(Key::of(&program, b"scene", &["ab", "c"]), Key::of(&program, b"scene", &["a", "bc"]));
        assert_ne!(Key::of(&program, b"scene", &[]), Key::of(&program, b"scen", &[]));
        assert_ne!(Key::of(&blake3::hash(b"x"), b"scene", &[]), Key::of(&program, b"scene", &[]));
        // Two builds of one version are two judges.
        assert_ne!(Key::by("one build", &program, b"scene", &[]), Key::by("another", &program, b"scene", &[]));
        assert_eq!(Key::by(judge(), &program, b"scene", &[]), Key::of(&program, b"scene", &[]));
        assert_eq!(judge().len(), 64, "a digest, and no version");
    }
}
