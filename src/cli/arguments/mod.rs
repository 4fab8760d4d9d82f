//! The arguments of the command line. Each command interprets its own.
pub(super) mod draw;
pub(super) mod grade;
pub(super) mod scenes;
pub(super) mod values;

use crate::{assignments::Assignment, judge::Rules, report::page::Audience, suite::config::Hints};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use draw::{DetectArguments, RenderArguments};
use grade::{DemoArguments, DoctorArguments, GradeArguments, MergeArguments, SelftestArguments, SuiteCommand};
use scenes::SceneCommand;
use std::{ffi::OsString, num::NonZeroUsize, path::PathBuf};
use values::{TextOrJson, assignment_parser, audience_parser, explanation_hints, parse_positive, rules_parser};

/// Grades the traces of FOSSSim, a course's collision simulator: right or wrong, where, and why.
#[derive(Debug, Parser)]
#[command(name = "fosssim-oracle", version, max_term_width = 100, after_help = EXIT_CODES)]
pub(super) struct Arguments {
    /// When to use colors; auto: on a terminal without NO_COLOR, and always with CLICOLOR_FORCE.
    #[arg(
        long,
        global = true,
        value_enum,
        value_name = "WHEN",
        default_value_t = ColorChoice::Auto,
        display_order = 900
    )]
    pub(super) color: ColorChoice,
    #[command(subcommand)]
    pub(super) command: Command,
}

/// The use of colors on a terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum ColorChoice {
    Auto,
    Always,
    Never,
}

const EXIT_CODES: &str = "\
Exit codes:
  0  accepted, or done
  1  graded and not accepted; traces or recordings that differ
  2  wrong usage, an input that can't be used, or the program's own fault
  130  stopped by Ctrl-C or SIGTERM; results so far are kept

SUITE is a file, or a milestone of the course: t1m1, t1m2, t1m3, t2m1, t2m2 or t2m3.
SCENE is a file, or asset:Group/name for a scene that comes with the program.
TRACE is a file (.zst and .gz files are unpacked), - for standard input, or asset:Group/name for its recording.";

// The commands. The list of commands shows the sentence about each. Other help texts are with the arguments.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Simulates a scene, and records its trace.
    Simulate(SimulateArguments),
    /// Shows the faults of a trace and their places, by the original's rules and by fair rules.
    Check(CheckArguments),
    /// Names the likely mistake of a program, from its trace or by running it.
    Explain(ExplainArguments),
    /// Finds the smallest scene on which a program is still wrong for the same reason.
    Shrink(ShrinkArguments),
    /// Computes one pair: polynomials, zeros, intervals, decision, time of impact, normal.
    Detect(Box<DetectArguments>),
    /// Draws a scene's motion: a picture per step, a GIF, or a movie.
    Render(Box<RenderArguments>),
    /// Shows what a trace contains.
    #[command(subcommand)]
    Trace(TraceCommand),
    /// Records the traces of all scenes of a folder, or checks that they are unchanged.
    Record(RecordArguments),
    /// Grades programs: runs them on a suite of scenes in a sandbox, and judges their traces.
    Grade(GradeArguments),
    /// Joins the parts of a grading that `grade --shard` has graded.
    Merge(MergeArguments),
    /// Writes and explains suites: the scenes of a grading, with limits and points.
    #[command(subcommand)]
    Suite(SuiteCommand),
    /// Lists the built-in scenes, prints one, or writes them into a folder.
    #[command(subcommand)]
    Scene(SceneCommand),
    /// Grades a right and a wrong sample program, as a demonstration.
    Demo(DemoArguments),
    /// Reports which layers of the sandbox work on this machine, and what to install.
    Doctor(DoctorArguments),
    /// Runs hostile programs in the sandbox of this machine, and prints which of its promises are kept.
    Selftest(SelftestArguments),
    /// Runs a course's grading server, which is the program fosssim-server in the same folder.
    Serve(ServeArguments),
    /// Writes the page that checks traces in any browser, without installation.
    Page(PageArguments),
    /// Behaves like the original program: same flags, same output, same files, same exit codes.
    ///
    /// The same happens when the program is called under a name that starts with FOSSSimOracle.
    Original(OriginalArguments),
    /// Prints a completion script for a shell.
    Completions(CompletionsArguments),
    /// Prints the program's manual page, or a command's.
    Man(ManArguments),
}

/// Parses the number of a step; 0 is the first record.
fn to_step(text: &str) -> Result<u32, &'static str> {
    text.trim().parse().map_err(|_| "steps are counted from 1; 0 is the first record, before any step")
}

/// The format of the report on a trace.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum CheckFormat {
    /// Readable text.
    Text,
    /// One JSON object.
    Json,
    /// A web page: one file with pictures and an animation of the expected and the actual motion.
    Html,
    /// Annotations for GitHub Actions.
    Github,
}

/// The format of an explanation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum ExplainFormat {
    /// Readable text.
    Text,
    /// One JSON object.
    Json,
    /// A web page: one file with pictures and an animation of the expected and the actual motion.
    Html,
}

/// The option `--quiet`, for commands whose main result is an exit code or a file.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct QuietArguments {
    /// Show only errors: no report, no warnings and no progress. Files are still written.
    #[arg(short, long)]
    pub(super) quiet: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle simulate asset:ContinuousTimeTests/head-on-equal-masses --output reference.bin")]
pub(super) struct SimulateArguments {
    /// The scene, a file or asset:Group/name.
    pub(super) scene: PathBuf,
    /// The file for the trace, or - for standard output. By default no trace is written.
    #[arg(short, long, value_name = "TRACE")]
    pub(super) output: Option<PathBuf>,
    /// The format of the summary.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub(super) format: TextOrJson,
    #[command(flatten)]
    pub(super) quiet: QuietArguments,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle check scenes/test00.xml submission.bin
  fosssim-oracle check scenes/test00.xml submission.bin --step 14
  fosssim-oracle check scenes/test00.xml submission.bin --format html --output report.html
  fosssim-oracle check scenes/test00.xml submission.bin --format json --output report.json")]
pub(super) struct CheckArguments {
    /// The scene, a file or asset:Group/name.
    pub(super) scene: PathBuf,
    /// The trace, a file, - for standard input, or asset:Group/name.
    pub(super) trace: PathBuf,
    /// The rule books.
    #[arg(long, value_parser = rules_parser(), default_value = "both")]
    pub(super) rules: Rules,
    /// The format of the report.
    #[arg(long, value_enum, default_value_t = CheckFormat::Text)]
    pub(super) format: CheckFormat,
    /// The file for the report, instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// Show all wrong steps, not only the first one, with expected and actual values.
    #[arg(long, conflicts_with = "step")]
    pub(super) all: bool,
    /// Show only these steps, from 1; 0 is the first record. Several are separated by commas.
    #[arg(long, short, value_name = "N", value_delimiter = ',', allow_negative_numbers = true, value_parser = to_step)]
    pub(super) step: Vec<u32>,
    /// Do not search for the mistake that explains a wrong trace.
    #[arg(long)]
    pub(super) no_explain: bool,
    /// The number of threads, at most eight; the report does not depend on it. One per core by default.
    #[arg(long, value_name = "N", value_parser = parse_positive::<NonZeroUsize>)]
    pub(super) threads: Option<NonZeroUsize>,
    #[command(flatten)]
    pub(super) quiet: QuietArguments,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle explain scenes/test00.xml submission.bin
  fosssim-oracle explain --program ./FOSSSim
  fosssim-oracle explain --program ./FOSSSim --suite t1m3
  fosssim-oracle explain --program ./FOSSSim scenes/test00.xml

With --program, the program runs in the sandbox on small scenes that make every term of every formula visible. \
The exit code is 0 if the fair rules accept everything, otherwise 1.")]
pub(super) struct ExplainArguments {
    /// The scene and the trace; with --program, scenes to run in addition to the built-in ones.
    #[arg(value_name = "SCENE TRACE")]
    pub(super) inputs: Vec<PathBuf>,
    /// The program to run.
    #[arg(long, value_name = "PROGRAM")]
    pub(super) program: Option<PathBuf>,
    /// The milestone of the program. It decides which small scenes the program runs. By default it is inferred from the
    /// scenes that the program accepts.
    #[arg(
        long,
        alias = "assignment",
        value_parser = assignment_parser(),
        ignore_case = true,
        value_name = "MILESTONE",
        requires = "program"
    )]
    pub(super) suite: Option<Assignment>,
    /// The level of detail of the explanation.
    #[arg(long, value_parser = explanation_hints(), default_value = "full")]
    pub(super) hints: Hints,
    /// The format of the report.
    #[arg(long, value_enum, default_value_t = ExplainFormat::Text)]
    pub(super) format: ExplainFormat,
    /// The file for the report, instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// Run the program without the sandbox if layers are missing. Never do this with other people's programs.
    #[arg(long)]
    pub(super) unsafe_no_sandbox: bool,
    #[command(flatten)]
    pub(super) quiet: QuietArguments,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle shrink ./FOSSSim --output small.xml
  fosssim-oracle shrink ./FOSSSim scenes/test00.xml --step 14
  fosssim-oracle shrink ./FOSSSim --suite t2m1 --format html > small.html

The program runs in the sandbox. Without a scene there is one smallest scene for each cause; further ones go to \
small.2.xml and so on. The exit code is 0 if nothing is wrong, otherwise 1.")]
pub(super) struct ShrinkArguments {
    /// The program to run.
    pub(super) program: PathBuf,
    /// The scene to begin with, a file or asset:Group/name. The default is the suite's scenes, or small scenes of the
    /// milestone.
    pub(super) scene: Option<PathBuf>,
    /// The suite whose scenes are tried. The default is the scenes of the program's milestone.
    #[arg(long, value_name = "SUITE")]
    pub(super) suite: Option<String>,
    /// The wrong step of the scene to begin with, from 1. The default is the first one that shows only one cause.
    #[arg(long, value_name = "N", requires = "scene", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) step: Option<u32>,
    /// The file for the smallest scene.
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// The maximum number of runs for one cause.
    #[arg(long, value_name = "N", default_value_t = 2_000)]
    pub(super) runs: u32,
    /// The maximum processor time for one cause, in seconds.
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub(super) seconds: u32,
    /// The format of the report.
    #[arg(long, value_enum, default_value_t = ExplainFormat::Text)]
    pub(super) format: ExplainFormat,
    /// Run the program without the sandbox if layers are missing. Never do this with other people's programs.
    #[arg(long)]
    pub(super) unsafe_no_sandbox: bool,
    #[command(flatten)]
    pub(super) quiet: QuietArguments,
}

#[derive(Debug, Subcommand)]
#[command(after_help = "\
Example:
  fosssim-oracle trace show scenes/test00.xml submission.bin --step 14")]
pub(super) enum TraceCommand {
    Show(TraceShowArguments),
}

/// Shows the log of one step, as text or JSON.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle trace show scenes/test00.xml submission.bin --step 14")]
pub(super) struct TraceShowArguments {
    /// The scene of the trace, which is needed to read it.
    pub(super) scene: PathBuf,
    /// The trace file.
    pub(super) trace: PathBuf,
    /// The step, from 1; 0 is the initial record.
    #[arg(long, short, value_name = "N", allow_negative_numbers = true, value_parser = to_step)]
    pub(super) step: u32,
    /// The format of the report.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub(super) format: TextOrJson,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle record --check
  fosssim-oracle record --assets my-scenes --references my-references

Scenes are read from ASSETS/<Group>/<name>.xml and ASSETS/<assignment>/<Group>/<name>.xml. REFERENCES gets the same \
folders, with <name>.bin.zst, a digest per step in <name>.steps, and manifest.txt.")]
pub(super) struct RecordArguments {
    /// Write nothing; simulate in memory, and fail with a diff if a byte differs. By default this checks the built-in
    /// scenes.
    #[arg(long)]
    pub(super) check: bool,
    /// The folder of scenes.
    #[arg(long, value_name = "DIR", default_value = "assets")]
    pub(super) assets: PathBuf,
    /// The folder of recordings.
    #[arg(long, value_name = "DIR", default_value = "references")]
    pub(super) references: PathBuf,
    #[command(flatten)]
    pub(super) quiet: QuietArguments,
}

#[derive(Debug, Args)]
#[command(
    disable_help_flag = true,
    after_help = "\
Example:
  fosssim-oracle original -s scenes/test00.xml -d 0 -i submission.bin"
)]
pub(super) struct OriginalArguments {
    /// The original's own flags; original --help lists them.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "FLAGS")]
    pub(super) arguments: Vec<OsString>,
}

#[derive(Debug, Args)]
#[command(
    disable_help_flag = true,
    after_help = "\
Example:
  fosssim-oracle serve --data course --listen 127.0.0.1:8080"
)]
pub(super) struct ServeArguments {
    /// The options of fosssim-server; serve --help lists them.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "OPTIONS")]
    pub(super) arguments: Vec<OsString>,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle page --output oracle.html
  fosssim-oracle page --suite course/suite.toml --for student --output course.html")]
pub(super) struct PageArguments {
    /// The file to write; - for standard output.
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: PathBuf,
    /// The WebAssembly module for the page, instead of the built-in one; scripts/browser-page builds it.
    #[arg(long, value_name = "FILE")]
    pub(super) module: Option<PathBuf>,
    /// The suite of a course that the page contains, with its scenes.
    #[arg(long, value_name = "SUITE")]
    pub(super) suite: Option<String>,
    /// The readers of the page. A page for students contains nothing that the suite hides from them.
    #[arg(
        long = "for",
        value_parser = audience_parser(),
        value_name = "READER",
        default_value = "student",
        requires = "suite"
    )]
    pub(super) reader: Audience,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle completions bash > ~/.local/share/bash-completion/completions/fosssim-oracle")]
pub(super) struct CompletionsArguments {
    /// The shell for the script.
    pub(super) shell: Shell,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle man | man -l -
  fosssim-oracle man trace show | man -l -

The page refers to those of the commands: fosssim-oracle-trace-show(1) is what man trace show prints.")]
pub(super) struct ManArguments {
    /// A command, such as check or trace show. By default the manual page of the program is printed.
    pub(super) command: Vec<String>,
}
