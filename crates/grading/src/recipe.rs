//! Turns a submission into a program that can be run. The submission is a program, an archive that contains one, or
//! sources.
use super::{
    cancellation::Cancellation,
    config::BuildStep,
    program_file::{FILE_OF_ANOTHER, ProgramFile, belongs_to_another},
    result::UnusableReason,
    staging::{
        CopyError, MAX_FOLDER_BYTES, StagedProgram, build, classify_error, copy_program, describe_error_at,
        open_in_folder,
    },
    temporary_folders::TemporaryFolder,
    upload,
};
use fosssim_intake::{ArchiveError, ArchiveLimits, FileKind};
use fosssim_sandbox::{
    Backend, StartProblem,
    collect::{self, CollectError, OpenFolder},
};
use std::{
    ffi::OsString,
    fs::{self, File},
    io::{self, Read, Seek},
    os::unix::fs::DirBuilderExt,
    path::Path,
};

/// The settings with which a submission is turned into a program: copied, unpacked or built.
#[derive(Clone, Copy)]
pub struct Recipe<'a> {
    /// The name of the program in folders and archives.
    pub program: &'a str,
    /// The build of sources, if the suite builds them.
    pub build: Option<&'a BuildStep>,
    /// The sandbox in which sources are built.
    pub backend: &'a Backend,
    /// The switch that stops builds.
    pub cancellation: &'a Cancellation,
}

impl Recipe<'_> {
    /// Copies the program from a file that a user names. The file is a program, or an archive. If it is of a kind that
    /// can't be run, the result contains the reason.
    ///
    /// # Errors
    /// Fails if the machine cannot read the file, or cannot write the copy.
    pub fn stage_file(&self, path: &Path) -> Result<StagedProgram, String> {
        let reason = match collect::open_file(path, true) {
            Ok((file, _)) => return self.stage_opened(file, path),
            Err(CollectError::NotRegular { what: "a folder", .. }) => {
                UnusableReason::CouldNotStart(StartProblem::IsFolder)
            }
            Err(CollectError::NotRegular { .. }) => UnusableReason::CouldNotStart(StartProblem::NotAFile),
            Err(CollectError::Missing { .. }) => UnusableReason::CouldNotStart(StartProblem::NotFound),
            Err(CollectError::System { source, .. }) => match classify_error(path, source) {
                CopyError::Submission(reason) => UnusableReason::Unreadable(reason),
                CopyError::Grader(reason) => return Err(reason),
            },
            Err(error) => UnusableReason::Unreadable(error.to_string()),
        };
        Ok(StagedProgram::from_unusable(path, reason))
    }

    /// Copies the program from the file called `name` in a folder whose contents are not trusted. A link out of the
    /// folder is rejected. A file is also rejected if `noted` says that it belongs to another submission. If there is
    /// no file with this name, the only archive in the folder is used.
    ///
    /// # Errors
    /// Fails like [`Recipe::stage_file`].
    pub fn stage_file_in(
        &self,
        folder: &Path,
        name: &str,
        noted: Option<&ProgramFile>,
    ) -> Result<StagedProgram, String> {
        let path = folder.join(name);
        let reason = match open_in_folder(folder, name) {
            Ok(file) if belongs_to_another(&file, noted).map_err(describe_error_at(&path))? => {
                UnusableReason::Unreadable(FILE_OF_ANOTHER.to_owned())
            }
            Ok(file) => return self.stage_opened(file, &path),
            Err(CollectError::Missing { .. }) => match open_only_archive(folder, false)? {
                Some(file) => return self.stage_unpacked(file, &path),
                None => upload::explain_missing_program(name, folder),
            },
            Err(CollectError::System { source, .. })
                if matches!(classify_error(&path, io::Error::from(source.kind())), CopyError::Grader(_)) =>
            {
                return Err(describe_error_at(&path)(source));
            }
            Err(error) => UnusableReason::Unreadable(error.to_string()),
        };
        Ok(StagedProgram::from_unusable(&path, reason))
    }

    /// Builds the sources in a folder, or in the only archive in it, and copies the resulting program.
    ///
    /// # Errors
    ///
    /// Fails if the grader or the machine fails. The error is the reason, as text.
    pub fn stage_folder(&self, path: &Path) -> Result<StagedProgram, String> {
        match (self.build, open_only_archive(path, true)?) {
            (None, _) => self.stage_file(path),
            (_, Some(archive)) => self.stage_unpacked(archive, path),
            (Some(step), None) => build(path, step, self.backend, self.cancellation),
        }
    }

    /// Copies the program from an open file, which is an archive or the program itself.
    fn stage_opened(&self, mut file: File, path: &Path) -> Result<StagedProgram, String> {
        match read_file_kind(&mut file) {
            Ok(FileKind::Archive(_)) => self.stage_unpacked(file, path),
            // An error of reading is reported later, when the file is copied.
            _ => copy_program(file, path, self.backend),
        }
    }

    /// Unpacks an archive. If the suite builds sources, they are built; otherwise the program is copied from the
    /// archive.
    fn stage_unpacked(&self, archive: File, path: &Path) -> Result<StagedProgram, String> {
        let folder = TemporaryFolder::create("upload").map_err(describe_error_at(&std::env::temp_dir()))?;
        let inside = folder.path().join("submission");
        fs::DirBuilder::new().mode(0o700).create(&inside).map_err(describe_error_at(&inside))?;
        let files = match fosssim_intake::unpack(archive, &inside, ArchiveLimits::DEFAULT) {
            Ok(files) => files,
            Err(error @ (ArchiveError::Read(_) | ArchiveError::Folder(_))) => {
                return Err(format!("{}: {error}", path.display()));
            }
            Err(error) => return Ok(StagedProgram::from_unusable(path, UnusableReason::Unreadable(error.to_string()))),
        };
        let top = fosssim_intake::top_folder(&inside, &files);
        if let Some(step) = self.build {
            return build(&top, step, self.backend, self.cancellation);
        }
        match open_in_folder(&top, self.program) {
            Ok(file) => copy_program(file, &top.join(self.program), self.backend),
            Err(_) => Ok(StagedProgram::from_unusable(path, upload::explain_missing_program(self.program, &top))),
        }
    }
}

/// Returns the kind of an open file according to its first bytes. Reading continues at its start.
fn read_file_kind(file: &mut File) -> io::Result<FileKind> {
    let mut start = Vec::new();
    file.take(fosssim_intake::START_BYTES as u64).read_to_end(&mut start)?;
    file.rewind()?;
    Ok(FileKind::from_start(&start))
}

/// Opens the archive in a folder, if there is exactly one. Learning platforms put each upload into a folder. With
/// `is_alone`, the folder must contain nothing else.
fn open_only_archive(folder: &Path, is_alone: bool) -> Result<Option<File>, String> {
    /// The maximum number of entries in a folder of a learning platform.
    const MAX_PLATFORM_ENTRIES: usize = 100;
    let Ok(opened) = OpenFolder::open(folder) else { return Ok(None) };
    let mut names = opened.list_names().map_err(describe_error_at(folder))?;
    names.retain(|name| !fosssim_intake::is_generated_name(name));
    if names.len() > MAX_PLATFORM_ENTRIES || is_alone && names.len() > 1 {
        return Ok(None);
    }
    let archive = |name: &OsString| {
        // A file with several names is left out, because its owner is unknown.
        let (mut file, _) = opened.regular_file(name.to_str()?, MAX_FOLDER_BYTES).ok()?;
        matches!(read_file_kind(&mut file), Ok(FileKind::Archive(_))).then_some(file)
    };
    let mut archives = names.iter().filter_map(archive);
    let first = archives.next();
    Ok(first.filter(|_| archives.next().is_none()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::staging::{digest_file, make_odd_entries};
    use fosssim_sandbox::{FakeRun, RunEnd};
    use std::{os::unix::fs::PermissionsExt, path::PathBuf, process::Command};

    /// Stages a submission for a suite without a build.
    fn staged(stage: impl FnOnce(Recipe<'_>) -> Result<StagedProgram, String>) -> StagedProgram {
        let (backend, cancellation) =
            (Backend::fake(|_| FakeRun::with_end(RunEnd::Exited(0))), Cancellation::default());
        stage(Recipe { program: "FOSSSim", build: None, backend: &backend, cancellation: &cancellation }).unwrap()
    }

    fn program(path: &Path) -> StagedProgram {
        staged(|recipe| recipe.stage_file(path))
    }

    #[test]
    fn a_submission_that_is_not_a_file_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let sources = folder.path().join("sources");
        let _socket = make_odd_entries(&sources);
        for name in ["pipe", "socket"] {
            let staged = program(&sources.join(name));
            assert!(staged.unusable_reason.is_some() && digest_file(&sources.join(name)).is_none(), "{name}");
        }
        assert!(
            staged(|recipe| recipe.stage_file_in(&sources, "link", None))
                .unusable_reason
                .is_some_and(|why| format!("{why:?}").contains("symbolic link"))
        );
        let staged = program(&folder.path().join("none"));
        assert_eq!(staged.unusable_reason, Some(UnusableReason::CouldNotStart(StartProblem::NotFound)));
        let staged = program(&sources);
        assert_eq!(staged.unusable_reason, Some(UnusableReason::CouldNotStart(StartProblem::IsFolder)));
    }

    /// Packs the contents of a folder under this name, next to the folder.
    fn packed(folder: &Path, name: &str) -> PathBuf {
        let archive = folder.with_file_name(name);
        let packing = Command::new("tar").arg("czf").arg(&archive).arg("-C").arg(folder).arg(".").status();
        assert!(packing.unwrap().success());
        archive
    }

    #[test]
    fn an_archive_is_unpacked_wherever_a_program_may_be() {
        let folder = tempfile::tempdir().unwrap();
        let class = folder.path().join("class");
        let hw = class.join("hw");
        std::fs::create_dir_all(hw.join("__MACOSX")).unwrap();
        std::fs::write(hw.join("FOSSSim"), "#!/bin/sh\n").unwrap();
        let archive = packed(&class, "alice.tar.gz");
        let moodle = folder.path().join("bob_assignsubmission_file");
        std::fs::create_dir(&moodle).unwrap();
        std::fs::copy(&archive, moodle.join("hw.tgz")).unwrap();
        std::fs::write(moodle.join("report.pdf"), "%PDF").unwrap();
        let same = [
            program(&hw.join("FOSSSim")),
            program(&archive),
            staged(|recipe| recipe.stage_file_in(folder.path(), "alice.tar.gz", None)),
            staged(|recipe| recipe.stage_file_in(&moodle, "FOSSSim", None)),
        ];
        for staged in &same {
            assert_eq!((&staged.unusable_reason, staged.digest), (&None, same[0].digest));
            assert_eq!(staged.program.metadata().unwrap().permissions().mode() & 0o111, 0o111, "no bit was needed");
        }
        std::fs::rename(hw.join("FOSSSim"), hw.join("main.cpp")).unwrap();
        let without = program(&packed(&class, "without.tar.gz")).unusable_reason;
        assert_eq!(
            without,
            Some(upload::explain_missing_program("FOSSSim", &hw)),
            "it says what it looked for and what it found"
        );
        std::fs::write(&archive, [0x1f, 0x8b, 8, 0, 0, 0]).unwrap();
        let damaged = program(&archive).unusable_reason.map(|why| format!("{why:?}"));
        assert!(damaged.as_ref().is_some_and(|why| why.contains("damaged")), "{damaged:?}");
        // There are two archives, and the right one is unknown.
        std::fs::copy(moodle.join("hw.tgz"), moodle.join("other.tgz")).unwrap();
        let two = staged(|recipe| recipe.stage_file_in(&moodle, "FOSSSim", None)).unusable_reason;
        assert_eq!(two, Some(upload::explain_missing_program("FOSSSim", &moodle)));
    }
}
