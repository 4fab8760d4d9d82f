//! `look-through`: looks through a stranger's file in a process of its own, which may be ended at any moment.
use super::arguments::LookThrough;
use crate::{
    archive::{self, ArchiveLimits},
    web,
};
use anyhow::Result;

/// Prints what the file is, or why it is refused, as JSON.
pub(super) fn run(arguments: &LookThrough) -> Result<()> {
    let answer = match &arguments.into {
        Some(folder) => archive::unpack(&arguments.file, folder, ArchiveLimits::USUAL)
            .map(|_| None)
            .map_err(|error| error.to_string()),
        None => web::look_through(&arguments.file, arguments.form.as_deref(), &arguments.wanted).map(Some),
    };
    println!("{}", serde_json::to_string(&answer)?);
    Ok(())
}
