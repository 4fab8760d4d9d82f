//! The terminal: standard output that accepts a closed pipe, the choice of colors, line breaks, and progress bars that
//! other output does not overwrite.
use super::{
    arguments::ColorChoice,
    arguments::values::TextOrJson,
    interrupt,
    progress_bars::{clear_bars, lock_visible_bars, write_above_bars},
};
use crate::{
    judge::replay::{Progress, Remark},
    report::{line_width, style::Style},
};
use anyhow::{Context, Result};
use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use std::{
    io::{self, IsTerminal, Write},
    sync::{
        OnceLock,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};
use terminal_size::{Width, terminal_size_of};

/// The value of the option `--color`.
static COLOR: OnceLock<ColorChoice> = OnceLock::new();

/// Stores the value of `--color`. Only the first call has an effect.
pub(super) fn choose_color(color: ColorChoice) {
    let _ = COLOR.set(color);
}

/// Whether the option `--quiet` was given.
static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// Turns off reports on standard output, bars and warnings; errors are still printed.
pub(super) fn set_quiet(quiet: bool) {
    IS_QUIET.store(quiet, Ordering::Relaxed);
}

fn is_quiet() -> bool {
    IS_QUIET.load(Ordering::Relaxed)
}

/// Returns the style of reports on standard output. If `--color` is not given, colors are off with `NO_COLOR`.
/// Otherwise they are on with `CLICOLOR_FORCE`, and on a terminal that shows them (not with `TERM=dumb` or
/// `CLICOLOR=0`).
pub(super) fn style() -> Style {
    let has_value = |name: &str, value: &str| std::env::var_os(name).is_some_and(|found| found == value);
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let uses_color = match COLOR.get().copied().unwrap_or(ColorChoice::Auto) {
        ColorChoice::Always => true,
        ColorChoice::Never => false,
        ColorChoice::Auto if is_set("NO_COLOR") => false,
        ColorChoice::Auto if is_set("CLICOLOR_FORCE") && !has_value("CLICOLOR_FORCE", "0") => true,
        ColorChoice::Auto => io::stdout().is_terminal() && !has_value("TERM", "dumb") && !has_value("CLICOLOR", "0"),
    };
    match (uses_color, io::stdout().is_terminal() && shows_signs()) {
        (false, _) => Style::Plain,
        (true, false) => Style::Color,
        (true, true) => Style::ColorAndSigns,
    }
}

/// Returns whether the locale uses UTF-8. The first of its environment variables that is set decides.
fn shows_signs() -> bool {
    let mut set = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().filter_map(|name| std::env::var(name).ok());
    let name = set.find(|value| !value.is_empty()).unwrap_or_default().to_lowercase();
    name.contains("utf-8") || name.contains("utf8")
}

/// The minimum width for line breaks. If a terminal reports less, it does not know its size.
const MIN_WIDTH: u16 = 20;

/// Returns the width of the terminal in columns; `None` if standard output is not a terminal.
pub(super) fn width() -> Option<usize> {
    match terminal_size_of(io::stdout()) {
        Some((Width(width), _)) if width >= MIN_WIDTH => Some(width.into()),
        _ => None,
    }
}

/// Prints a report as text. On a terminal, long lines are broken between words.
///
/// # Errors
///
/// Fails like [`print()`].
pub(super) fn report(text: &str) -> Result<()> {
    match width() {
        Some(width) => print(line_width::wrap(text, width)),
        None => print(text),
    }
}

/// Prints a report in the requested format.
///
/// # Errors
///
/// Fails like [`print()`].
pub(super) fn show(format: TextOrJson, text: impl FnOnce() -> String, json: impl FnOnce() -> String) -> Result<()> {
    match format {
        TextOrJson::Text => report(&text()),
        TextOrJson::Json => print(json()),
    }
}

/// Prints to standard output. If the reader has closed the pipe, that is not an error, because the exit code contains
/// the verdict.
///
/// # Errors
///
/// Fails if there is another error, such as a full disk.
pub(super) fn print(text: impl AsRef<[u8]>) -> Result<()> {
    if is_quiet() {
        return Ok(());
    }
    let mut stdout = io::stdout().lock();
    ignore_closed_pipe(stdout.write_all(text.as_ref()).and_then(|()| stdout.flush()))
        .context("cannot write to standard output")
}

/// Prints to standard error, above the progress bars. Its own errors cannot be reported.
pub(super) fn print_error(text: impl AsRef<[u8]>) {
    write_above_bars(text.as_ref());
}

/// Prints a remark to standard error. A remark is not an error, and is left out with `--quiet`.
pub(super) fn print_remark(text: impl AsRef<[u8]>) {
    if !is_quiet() {
        print_error(text);
    }
}

/// Turns the error that a pipe was closed into success.
pub(super) fn ignore_closed_pipe(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// Returns whether progress bars are useful: standard error is a terminal, and they are not switched off.
pub(super) fn wants_bars() -> bool {
    io::stderr().is_terminal() && !is_quiet()
}

/// Returns a place for progress bars on standard error. Until [`clear_bars`] is called, all other output appears above
/// them, and an interrupt removes them.
pub(super) fn show_bars() -> MultiProgress {
    interrupt::clean_up_when_interrupted();
    lock_visible_bars().get_or_insert_with(MultiProgress::new).clone()
}

/// Adds a progress bar with this length and this template.
pub(super) fn add_bar(bars: &MultiProgress, length: u64, template: &str) -> ProgressBar {
    let bar = bars.add(ProgressBar::new(length));
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

/// The time after which a progress bar appears, if the command still runs.
const BAR_DELAY: Duration = Duration::from_secs(1);

/// The time between two movements of a bar.
const BAR_INTERVAL: Duration = Duration::from_millis(200);

/// A progress bar on standard error. It is shown only on a terminal, and only if the command runs for more than a
/// second.
pub(super) struct Bar {
    steps: u64,
    start_time: Option<Instant>,
    progress_bar: Option<ProgressBar>,
}

impl Bar {
    /// Creates a progress bar for a number of steps.
    pub(super) fn new(steps: u32) -> Self {
        Self { steps: u64::from(steps), start_time: wants_bars().then(Instant::now), progress_bar: None }
    }

    /// Creates a progress bar for a number of runs, each of which may take long. The bar is shown immediately, with the
    /// elapsed time.
    pub(super) fn for_runs(runs: u64) -> Self {
        let bar = |runs| {
            let bar = add_bar(&show_bars(), runs, "{spinner} {elapsed}: run {pos} of {len}, {wide_msg}");
            bar.enable_steady_tick(BAR_INTERVAL);
            bar
        };
        Self { steps: runs, start_time: None, progress_bar: wants_bars().then(|| bar(runs)) }
    }

    /// Shows on the bar that a run begins.
    pub(super) fn next_run(&self, name: &str) {
        if let Some(bar) = &self.progress_bar {
            bar.inc(1);
            bar.set_message(name.to_owned());
        }
    }

    /// Shows on the bar how many steps are finished.
    pub(super) fn show_step(&mut self, step: u32) {
        if self.progress_bar.is_none() && self.start_time.is_some_and(|start| start.elapsed() >= BAR_DELAY) {
            self.progress_bar = Some(add_bar(&show_bars(), self.steps, "{wide_bar} step {pos} of {len}, {eta} left"));
        }
        if let Some(bar) = &self.progress_bar {
            bar.set_position(u64::from(step));
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some(bar) = &self.progress_bar {
            bar.finish_and_clear();
            clear_bars();
        }
    }
}

impl Progress for Bar {
    fn observe_step_end(&mut self, step: u32, _remarks: &[Remark]) {
        self.show_step(step);
    }
}
