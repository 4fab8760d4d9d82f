//! Completion scripts and the manual page.
use crate::cli::{
    arguments::{Arguments, Completions},
    console, exit,
};
use anyhow::Result;
use clap::CommandFactory;

pub(super) fn completions(arguments: &Completions) -> Result<u8> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "fosssim-oracle", &mut script);
    console::print(&script)?;
    Ok(exit::ACCEPTED)
}

pub(super) fn manual() -> Result<u8> {
    let mut page = Vec::new();
    clap_mangen::Man::new(Arguments::command()).render(&mut page)?;
    console::print(&page)?;
    Ok(exit::ACCEPTED)
}
