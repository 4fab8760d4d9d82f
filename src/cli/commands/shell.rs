//! Completion scripts and the manual page.
use crate::cli::{
    arguments::{Arguments, Completions, Man},
    console, exit,
};
use anyhow::{Result, bail};
use clap::CommandFactory;

pub(super) fn completions(arguments: &Completions) -> Result<u8> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "fosssim-oracle", &mut script);
    console::print(&script)?;
    Ok(exit::ACCEPTED)
}

pub(super) fn manual(arguments: &Man) -> Result<u8> {
    let mut command = Arguments::command().disable_help_subcommand(true);
    // Gives the commands their full names.
    command.build();
    for name in &arguments.command {
        let Some(found) = command.find_subcommand(name) else {
            let known: Vec<_> = command.get_subcommands().map(clap::Command::get_name).collect();
            let whole = command.get_bin_name().unwrap_or("fosssim-oracle");
            if known.is_empty() {
                bail!("{whole} has no commands of its own, and so no `{name}`");
            }
            bail!("{whole} has no command `{name}`; it has {}", known.join(", "));
        };
        command = found.clone();
    }
    let mut page = Vec::new();
    clap_mangen::Man::new(command).render(&mut page)?;
    console::print(&page)?;
    Ok(exit::ACCEPTED)
}
