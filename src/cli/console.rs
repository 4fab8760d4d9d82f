//! The terminal: standard output that survives a closed pipe, the decision about colours, and the progress bar.
use crate::{
    judge::parity::{Progress, Remark},
    report::style::Style,
};
use anyhow::{Context, Result};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::{
    io::{self, IsTerminal, Write},
    time::{Duration, Instant},
};

/// The style of reports on standard output: colours only on a terminal, and only when nobody objects (`NO_COLOR`,
/// `TERM=dumb`).
pub(super) fn style() -> Style {
    let objected = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
        || std::env::var_os("TERM").is_some_and(|value| value == "dumb");
    if io::stdout().is_terminal() && !objected { Style::Colour } else { Style::Plain }
}

/// Prints to standard output. Nobody listening any more is no error: the verdict is in the exit code.
///
/// # Errors
/// Anything else, such as a full disk.
pub(super) fn print(text: &[u8]) -> Result<()> {
    let mut stdout = io::stdout().lock();
    unless_closed(stdout.write_all(text).and_then(|()| stdout.flush())).context("cannot write to standard output")
}

/// Prints to standard error; there is nowhere left to report a failure.
pub(super) fn complain(text: &[u8]) {
    drop(io::stderr().lock().write_all(text));
}

/// A closed pipe is no error.
pub(super) fn unless_closed(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// How long a command may take before a bar appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// A bar on standard error, when that is a terminal and the command takes longer than a second.
pub(super) struct Bar {
    steps: u64,
    begun: Option<Instant>,
    shown: Option<ProgressBar>,
}

impl Bar {
    /// A bar over so many steps.
    pub(super) fn new(steps: u32) -> Self {
        Self { steps: u64::from(steps), begun: io::stderr().is_terminal().then(Instant::now), shown: None }
    }

    /// So many steps are done.
    pub(super) fn at(&mut self, step: u32) {
        if let Some(bar) = &self.shown {
            bar.set_position(u64::from(step));
        } else if self.begun.is_some_and(|begun| begun.elapsed() >= PATIENCE) {
            let bar = ProgressBar::with_draw_target(Some(self.steps), ProgressDrawTarget::stderr());
            if let Ok(style) = ProgressStyle::with_template("{wide_bar} step {pos} of {len}, {eta} left") {
                bar.set_style(style);
            }
            bar.set_position(u64::from(step));
            self.shown = Some(bar);
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some(bar) = &self.shown {
            bar.finish_and_clear();
        }
    }
}

impl Progress for Bar {
    fn step_judged(&mut self, step: u32, _remarks: &[Remark]) {
        self.at(step);
    }
}
