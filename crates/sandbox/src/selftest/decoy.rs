//! Decoys that a hostile program tries to reach, such as secrets, a scene, another submission and a process.
//!
//! The state of all decoys is recorded before and after a run, including permission bits and times of change.

use std::{
    collections::BTreeMap,
    ffi::OsString,
    io,
    os::unix::fs::{MetadataExt, PermissionsExt},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    time::{SystemTime, UNIX_EPOCH},
};

/// The decoys for one run.
pub(super) struct Decoy {
    root: PathBuf,
    /// The working folder of the hostile program.
    pub(super) work: PathBuf,
    /// The scene, which the program may read.
    pub(super) scene: PathBuf,
    secret: String,
    victim: Child,
}

/// The state of the decoys: the metadata and the contents of each path.
pub(super) struct DecoyState(BTreeMap<PathBuf, (DecoyFacts, Vec<u8>)>);

type DecoyFacts = [i64; 7];

impl DecoyState {
    /// Returns the first path whose state differs; `None` if the states are equal.
    pub(super) fn find_difference(&self, after: &Self) -> Option<String> {
        let changed = self.0.iter().find(|(path, state)| after.0.get(*path) != Some(state)).map(|(path, _)| path);
        let added = || after.0.keys().find(|path| !self.0.contains_key(*path));
        changed.or_else(added).map(|path| path.display().to_string())
    }
}

impl Decoy {
    /// Creates decoys below `root`.
    pub(super) fn set_up(root: &Path) -> io::Result<Self> {
        if root.exists() {
            std::fs::remove_dir_all(root)?;
        }
        let (secrets, work) = (root.join("secrets"), root.join("work"));
        let (scenes, neighbor) = (root.join("scenes"), root.join("neighbor"));
        for folder in [&secrets.join("inner"), &secrets.join("empty"), &work, &scenes, &neighbor] {
            std::fs::create_dir_all(folder)?;
        }
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos();
        let secret = blake3::hash(format!("{now} {} {}", std::process::id(), root.display()).as_bytes()).to_hex();
        let scene = scenes.join("scene.xml");
        for (path, text, mode) in [
            (secrets.join("reference.bin"), secret.as_str(), 0o644),
            (secrets.join("private.txt"), secret.as_str(), 0o600),
            (secrets.join("inner/more.txt"), secret.as_str(), 0o644),
            (neighbor.join("answer.txt"), secret.as_str(), 0o644),
            (scene.clone(), "<scene/>", 0o644),
        ] {
            std::fs::write(&path, text)?;
            std::fs::set_permissions(&path, std::fs::Permissions::from_mode(mode))?;
        }
        // The umask must not be what protects the secrets, so every folder on the path is opened to all users.
        for folder in [root, &secrets, &secrets.join("inner"), &scenes, &neighbor] {
            std::fs::set_permissions(folder, std::fs::Permissions::from_mode(0o755))?;
        }
        let null = Stdio::null;
        let victim = Command::new("/bin/sleep").arg("600").stdin(null()).stdout(null()).stderr(null()).spawn()?;
        Ok(Self { root: root.into(), work, scene, secret: secret.to_string(), victim })
    }

    /// Copies the hostile program next to the decoys.
    pub(super) fn copy_program(&self, program: &Path) -> io::Result<PathBuf> {
        let own = self.root.join("program");
        std::fs::copy(program, &own)?;
        Ok(own)
    }

    /// Returns the arguments of the hostile program: the secrets, the victim's process, the scene, and the other
    /// submission.
    pub(super) fn arguments(&self) -> [OsString; 4] {
        [
            self.root.join("secrets").into(),
            self.victim.id().to_string().into(),
            self.scene.clone().into(),
            self.root.join("neighbor").into(),
        ]
    }

    /// Returns whether a text contains the secret.
    pub(super) fn contains_secret(&self, text: &[u8]) -> bool {
        text.windows(self.secret.len()).any(|window| window == self.secret.as_bytes())
    }

    /// Returns whether the process among the decoys is alive.
    pub(super) fn is_alive(&mut self) -> bool {
        matches!(self.victim.try_wait(), Ok(None))
    }

    /// Returns the state of all decoys, without the working folder.
    pub(super) fn read_state(&self) -> io::Result<DecoyState> {
        let mut state = BTreeMap::new();
        for folder in ["secrets", "scenes", "neighbor"] {
            record_state(&self.root.join(folder), &mut state)?;
        }
        Ok(DecoyState(state))
    }

    /// Removes all decoys.
    pub(super) fn clear(self) -> io::Result<()> {
        std::fs::remove_dir_all(&self.root)
    }
}

impl Drop for Decoy {
    fn drop(&mut self) {
        // The attack may have killed this process.
        let _ = self.victim.kill();
        let _ = self.victim.wait();
    }
}

fn record_state(path: &Path, state: &mut BTreeMap<PathBuf, (DecoyFacts, Vec<u8>)>) -> io::Result<()> {
    let metadata = path.symlink_metadata()?;
    let mut contents = Vec::new();
    if metadata.is_dir() {
        for entry in std::fs::read_dir(path)? {
            record_state(&entry?.path(), state)?;
        }
    } else if metadata.is_file() {
        contents = std::fs::read(path)?;
    }
    let facts = [
        i64::from(metadata.mode()),
        i64::from(metadata.uid()),
        i64::from(metadata.gid()),
        metadata.nlink().cast_signed(),
        // The kernel updates the time of change whenever the owner, the mode, the name or the contents change.
        metadata.ctime(),
        metadata.ctime_nsec(),
        metadata.ino().cast_signed(),
    ];
    state.insert(path.into(), (facts, contents));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_change_shows() {
        let folder = tempfile::tempdir().unwrap();
        let mut decoy = Decoy::set_up(&folder.path().join("run")).unwrap();
        let reference = folder.path().join("run/secrets/reference.bin");
        let before = decoy.read_state().unwrap();
        assert_eq!(before.find_difference(&decoy.read_state().unwrap()), None);
        std::fs::set_permissions(&reference, std::fs::Permissions::from_mode(0o600)).unwrap();
        std::fs::set_permissions(&reference, std::fs::Permissions::from_mode(0o644)).unwrap();
        assert!(
            before.find_difference(&decoy.read_state().unwrap()).unwrap().ends_with("reference.bin"),
            "even when undone"
        );
        let before = decoy.read_state().unwrap();
        std::fs::write(folder.path().join("run/neighbor/planted"), "x").unwrap();
        assert!(before.find_difference(&decoy.read_state().unwrap()).is_some());
        let secret = std::fs::read(&reference).unwrap();
        assert!(decoy.contains_secret(&[b"it is ", &secret[..]].concat()) && !decoy.contains_secret(b"it is"));
        assert!(decoy.is_alive());
        decoy.victim.kill().unwrap();
        decoy.victim.wait().unwrap();
        assert!(!decoy.is_alive());
    }
}
