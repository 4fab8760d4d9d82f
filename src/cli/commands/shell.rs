//! Completion scripts and the manual page.
use crate::cli::{
    arguments::{Arguments, CompletionsArguments, ManArguments},
    console,
};
use anyhow::{Result, bail};
use clap::CommandFactory;
use clap_complete::Shell;

/// The name under which the program is installed.
const NAME: &str = "fosssim-oracle";

pub(super) fn completions(arguments: &CompletionsArguments) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), NAME, &mut script);
    if arguments.shell == Shell::Bash {
        script = mend(&script);
    }
    console::print(&script)
}

/// Returns a bash script whose labels match their uses. clap writes a hyphen in the program's name once as `__` and
/// once as the mark of a command, so that nothing is completed behind a command (clap issue 6421). Without a hyphen, or
/// when clap is mended, nothing changes.
fn mend(script: &[u8]) -> Vec<u8> {
    let (asked, written) = (NAME.replace('-', "__"), NAME.replace('-', "__subcmd__"));
    String::from_utf8_lossy(script).replace(&written, &asked).into_bytes()
}

pub(super) fn write_manual(arguments: &ManArguments) -> Result<()> {
    let mut command = Arguments::command().disable_help_subcommand(true);
    // Sets the full names of the commands.
    command.build();
    for name in &arguments.command {
        let Some(found) = command.find_subcommand(name) else {
            let known: Vec<_> = command.get_subcommands().map(clap::Command::get_name).collect();
            let whole = command.get_bin_name().unwrap_or(NAME);
            if known.is_empty() {
                bail!("{whole} has no commands of its own, and so no `{name}`");
            }
            bail!("{whole} has no command `{name}`; it has {}", known.join(", "));
        };
        command = found.clone();
    }
    let mut page = Vec::new();
    // The foot of a page has the version; clap knows none for a command.
    let source = format!("{NAME} {}", env!("CARGO_PKG_VERSION"));
    clap_mangen::Man::new(command).source(source).manual("Manual of fosssim-oracle").render(&mut page)?;
    let page = String::from_utf8_lossy(&page).replace("\n.SH EXTRA\n", "\n.SH EXAMPLES AND NOTES\n");
    console::print(&page)
}
