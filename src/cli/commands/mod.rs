//! The commands. Each reads its inputs, calls the libraries, and prints what a renderer returns.

mod check;
mod detect;
mod display;
mod earlier_grades;
mod explain;
mod further_commands;
mod grade;
mod grade_ending;
mod host;
mod last_run;
mod merge;
mod page;
mod pages;
mod probes;
mod record;
mod render;
mod results;
mod scene;
mod serve;
mod shard;
pub(super) mod shell;
mod shrink;
mod simulate;
mod submissions;
mod suite;
mod suite_report;
mod timings;
mod trace;
mod traces;
mod visible_mistakes;

use super::{
    arguments::{Command, TraceCommand},
    console, exit,
};
use anyhow::Result;

/// Runs a command and returns its exit code.
///
/// # Errors
///
/// Fails if the command is used wrongly, if an input is bad, or if this program has an error. The error is the reason.
pub(super) fn run(command: &Command) -> Result<u8> {
    console::set_quiet(is_quiet(command));
    let done = match command {
        // The exit codes of these commands are verdicts.
        Command::Check(arguments) => return check::run(arguments),
        Command::Explain(arguments) => return explain::run(arguments),
        Command::Shrink(arguments) => return shrink::run(arguments),
        Command::Render(arguments) => return render::run(arguments),
        Command::Record(arguments) => return record::run(arguments),
        Command::Grade(arguments) => return grade::run(arguments),
        Command::Merge(arguments) => return merge::run(arguments),
        Command::Demo(arguments) => return host::demo(arguments),
        Command::Doctor(_) => return host::doctor(),
        Command::Selftest(arguments) => return host::selftest(arguments),
        // This arm is never reached, because the command ends the process itself.
        Command::Original(_) => return Ok(exit::FAULT),
        Command::Simulate(arguments) => simulate::run(arguments),
        Command::Detect(arguments) => detect::run(arguments),
        Command::Trace(TraceCommand::Show(arguments)) => trace::show(arguments),
        Command::Suite(arguments) => suite::run(arguments),
        Command::Scene(arguments) => scene::run(arguments),
        Command::Serve(arguments) => serve::run(arguments),
        Command::Page(arguments) => page::run(arguments),
        Command::Completions(arguments) => shell::print_completions(arguments),
        Command::Man(arguments) => shell::write_manual(arguments),
    };
    done.map(|()| exit::ACCEPTED)
}

fn is_quiet(command: &Command) -> bool {
    match command {
        Command::Simulate(arguments) => arguments.quiet.quiet,
        Command::Check(arguments) => arguments.quiet.quiet,
        Command::Explain(arguments) => arguments.quiet.quiet,
        Command::Record(arguments) => arguments.quiet.quiet,
        Command::Shrink(arguments) => arguments.quiet.quiet,
        _ => false,
    }
}
