//! Prints completion scripts and manual pages.
use crate::{
    cli::{
        arguments::{Arguments, CompletionsArguments, ManArguments},
        console,
    },
    report::formats::Format,
    student::all_rows,
    suite::{library, plan},
};
use anyhow::{Context, Result, bail};
use clap::{Command, CommandFactory};
use clap_complete::{
    CompleteEnv, Shell,
    engine::{ArgValueCompleter, CompletionCandidate, PathCompleter, ValueCompleter},
    env::Shells,
};
use std::ffi::OsStr;

/// The name under which this program is installed.
const PROGRAM_NAME: &str = "fosssim-oracle";

/// The environment variable by which a completion script asks for completions.
const COMPLETION_VARIABLE: &str = "FOSSSIM_COMPLETE";

/// Replacements in the script for bash. Bash splits `asset:Group/name` into three words, and the new parts join them.
const BASH_REPLACEMENTS: [(&str, &str); 2] = [
    (
        r#"    local words=("${COMP_WORDS[@]}")
    if [[ "${BASH_VERSINFO[0]}" -ge 4 ]]; then
        words[COMP_CWORD]="$2"
    fi
"#,
        r#"    local words=() word last=
    for word in "${COMP_WORDS[@]:0:COMP_CWORD+1}"; do
        if [[ ${#words[@]} -gt 0 && ($word == : || $last == :) ]]; then
            words[${#words[@]}-1]+=$word
        else
            words+=("$word")
        fi
        last=$word
    done
    last=${words[${#words[@]}-1]}
    _CLAP_COMPLETE_INDEX=$((${#words[@]} - 1))
"#,
    ),
    (
        "        compopt -o nospace\n    fi\n}",
        "        compopt -o nospace\n    fi\n    COMPREPLY=(\"${COMPREPLY[@]#\"${last%\"${last##*:}\"}\"}\")\n}",
    ),
];

/// Prints completions and ends the program, if a completion script asks for them.
pub(in crate::cli) fn complete_if_requested() {
    CompleteEnv::with_factory(|| add_completions(Arguments::command()))
        .var(COMPLETION_VARIABLE)
        .bin(PROGRAM_NAME)
        .complete();
}

/// Returns the command line, with completions for the names of suites, scenes, traces, mistakes and formats.
fn add_completions(command: Command) -> Command {
    let completed = command.mut_args(|argument| match argument.get_id().as_str() {
        "suite" => argument.add(ArgValueCompleter::new(|typed: &OsStr| {
            let names = plan::built_in_names().filter_map(|name| name.strip_suffix("@1").map(str::to_owned));
            complete_names(typed, names).into_iter().chain(PathCompleter::file().complete(typed)).collect()
        })),
        // A filter of scenes has their bare names.
        "scene" if !argument.is_positional() => argument.add(ArgValueCompleter::new(|typed: &OsStr| {
            complete_names(typed, library::all_names().map(|name| name.to_string()))
        })),
        "format" if argument.get_possible_values().is_empty() => {
            argument.add(ArgValueCompleter::new(|typed: &OsStr| {
                complete_names(typed, Format::ALL.iter().map(|format| format.name().to_owned()))
            }))
        }
        "scene" | "trace" => argument.add(ArgValueCompleter::new(|typed: &OsStr| {
            let names = library::all_names().map(|name| format!("asset:{name}"));
            complete_names(typed, names).into_iter().chain(PathCompleter::file().complete(typed)).collect()
        })),
        "mistake" => argument.add(ArgValueCompleter::new(|typed: &OsStr| {
            complete_names(typed, all_rows().map(|row| row.id.to_owned()))
        })),
        _ => argument,
    });
    completed.mut_subcommands(add_completions)
}

fn complete_names(typed: &OsStr, names: impl Iterator<Item = String>) -> Vec<CompletionCandidate> {
    let typed = typed.to_string_lossy();
    names.filter(|name| name.starts_with(&*typed)).map(CompletionCandidate::new).collect()
}

pub(super) fn print_completions(arguments: &CompletionsArguments) -> Result<()> {
    let (shells, mut script) = (Shells::builtins(), Vec::new());
    let shell = shells.completer(&arguments.shell.to_string()).context("there is no script for this shell")?;
    shell.write_registration(COMPLETION_VARIABLE, PROGRAM_NAME, PROGRAM_NAME, PROGRAM_NAME, &mut script)?;
    let mut script = String::from_utf8(script)?;
    if arguments.shell == Shell::Bash {
        for (split, whole) in BASH_REPLACEMENTS {
            script = script.replace(split, whole);
        }
    }
    console::print(script)
}

pub(super) fn write_manual(arguments: &ManArguments) -> Result<()> {
    let mut command = Arguments::command().disable_help_subcommand(true);
    // This sets the full names of the subcommands.
    command.build();
    for name in &arguments.command {
        let Some(found) = command.find_subcommand(name) else {
            let subcommands: Vec<_> = command.get_subcommands().map(clap::Command::get_name).collect();
            let full_name = command.get_bin_name().unwrap_or(PROGRAM_NAME);
            if subcommands.is_empty() {
                bail!("{full_name} has no subcommand `{name}`");
            }
            bail!("{full_name} has no command `{name}`; it has {}", subcommands.join(", "));
        };
        command = found.clone();
    }
    let mut page = Vec::new();
    // The last line of a page contains the version, which clap does not set for subcommands.
    let source = format!("{PROGRAM_NAME} {}", env!("CARGO_PKG_VERSION"));
    clap_mangen::Man::new(command).source(source).manual("Manual of fosssim-oracle").render(&mut page)?;
    let page = String::from_utf8_lossy(&page).replace("\n.SH EXTRA\n", "\n.SH EXAMPLES AND NOTES\n");
    console::print(&page)
}
