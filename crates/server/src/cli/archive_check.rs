//! The command `look-through`, which checks an uploaded file in a separate process that can be killed at any time.
use super::arguments::ArchiveCheckArguments;
use crate::web;
use anyhow::Result;
use fosssim_intake::ArchiveLimits;
use std::fs::File;

/// Prints the kind of the file, or the reason for rejecting it, as JSON. With `--into`, the archive is also unpacked,
/// and its kind is not printed.
pub(super) fn run(arguments: &ArchiveCheckArguments) -> Result<()> {
    let answer = match &arguments.into {
        Some(folder) => fosssim_intake::unpack(File::open(&arguments.file)?, folder, ArchiveLimits::DEFAULT)
            .map(|_| None)
            .map_err(|error| error.to_string()),
        None => {
            let (form, program) = (arguments.form.as_deref(), arguments.program.as_deref());
            web::check_archive(&arguments.file, form, &arguments.wanted, program).map(Some)
        }
    };
    println!("{}", serde_json::to_string(&answer)?);
    Ok(())
}
