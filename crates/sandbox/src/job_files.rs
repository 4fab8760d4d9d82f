//! Writes a job's files into its working folder on disk.
use super::{job::Job, sandbox_error::SandboxError, wire};
use std::{io, path::Path};

/// Writes all files of the job into its working folder on disk.
pub(super) fn write_files(job: &Job) -> Result<(), SandboxError> {
    for (name, content) in &job.files {
        write_file(job, name, content)?;
    }
    Ok(())
}

/// Writes one file of the job, called `name`, into its working folder on disk.
pub(super) fn write_file(job: &Job, name: &str, content: &[u8]) -> Result<(), SandboxError> {
    std::fs::write(job.folder.join(plain_name(job, name)?), content).map_err(|source| folder_fault(job, source))
}

/// Returns `name` as a path, after checking that it does not leave the folder.
pub(super) fn plain_name<'a>(job: &Job, name: &'a str) -> Result<&'a Path, SandboxError> {
    wire::entry_name(name.as_bytes()).ok_or_else(|| folder_fault(job, io::ErrorKind::InvalidInput.into()))
}

pub(super) fn folder_fault(job: &Job, source: io::Error) -> SandboxError {
    SandboxError::Folder { folder: job.folder.display().to_string(), source }
}
