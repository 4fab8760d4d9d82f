//! Takes a file from a working folder after the program has ended.
//!
//! A hostile program leaves a link to a reference, a pipe, a device or a terabyte of holes where its output should be.
//! Therefore the file is opened below the folder, without following links and without waiting. The open file must be a
//! regular file, must have only one hard link, and must not exceed the limit. Call this only after every process has
//! ended, which is the case when [`RunningProgram::wait`](super::RunningProgram::wait) has returned.

use std::{
    fs::File,
    io,
    os::{fd::AsFd, unix::fs::OpenOptionsExt},
    path::Path,
};

pub use fosssim_files::{FileError as CollectError, Folder as OpenFolder, FolderEntry, open_file};

use super::supervisor::open_closed_folders;

/// Removes a folder with everything that a program left in it, including folders that their owner cannot enter, and
/// folders that are nested too deeply for the available descriptors. This must be called only when no process of the
/// program is alive.
///
/// # Errors
///
/// Fails if something cannot be removed. A missing folder is not an error.
pub fn remove_folder(path: &Path) -> io::Result<()> {
    let gone = |error: io::Error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) };
    if std::fs::remove_dir_all(path).or_else(gone).is_ok() {
        return Ok(());
    }
    // If others may write into the folder, the path could have become a link in the meantime.
    open_closed_folders(
        File::options().read(true).custom_flags(libc::O_DIRECTORY | libc::O_NOFOLLOW).open(path)?.as_fd(),
    );
    std::fs::remove_dir_all(path).or_else(gone)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    fn regular_file(folder: &Path, name: &str, max_bytes: u64) -> Result<Vec<u8>, CollectError> {
        let (mut file, _) = OpenFolder::open(folder).unwrap().regular_file(name, max_bytes)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        Ok(bytes)
    }

    fn problem(folder: &Path, name: &str) -> String {
        regular_file(folder, name, 1000).unwrap_err().to_string()
    }

    #[test]
    fn a_plain_file_is_taken_whole() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("trace.bin"), vec![7; 1000]).unwrap();
        assert_eq!(regular_file(folder.path(), "trace.bin", 1000).unwrap(), vec![7; 1000]);
        assert!(regular_file(folder.path(), "trace.bin", 999).unwrap_err().to_string().contains("the limit is 999"));
        std::fs::create_dir(folder.path().join("out")).unwrap();
        std::fs::write(folder.path().join("out/trace.bin"), b"deep").unwrap();
        assert_eq!(regular_file(folder.path(), "out/trace.bin", 4).unwrap(), b"deep");
    }

    #[test]
    fn other_outputs_of_a_program_are_rejected_by_name() {
        let outside = tempfile::tempdir().unwrap();
        let secret = outside.path().join("reference.bin");
        std::fs::write(&secret, b"secret").unwrap();
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::os::unix::fs::symlink(&secret, at("link")).unwrap();
        std::os::unix::fs::symlink(outside.path(), at("way")).unwrap();
        std::fs::hard_link(&secret, at("hard")).unwrap();
        std::fs::create_dir(at("folder")).unwrap();
        std::fs::File::create(at("sparse")).unwrap().set_len(1 << 40).unwrap();
        let _socket = std::os::unix::net::UnixListener::bind(at("socket")).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(at("fifo")).status().unwrap().success());
        for (name, expected) in [
            ("link", "a symbolic link"),
            ("way/reference.bin", "a symbolic link"),
            ("hard", "2 hard links"),
            ("folder", "a folder"),
            ("sparse", "the limit is 1000"),
            ("socket", "a socket"),
            ("fifo", "a pipe"),
            ("none", "none does not exist"),
            ("new\nline", "the file new\\nline does not exist"),
            ("../reference.bin", "outside the folder"),
            (&secret.display().to_string(), "outside the folder"),
        ] {
            let problem = problem(folder.path(), name);
            assert!(problem.contains(expected), "{name}: {problem}");
        }
    }
}
