//! The arguments of the commands that run programs.
use super::values::{TextOrJson, audience_parser, hints_parser, parse_positive, rules_parser};
use crate::{
    assignments::Assignment,
    judge::Rules,
    report::{formats::Format, page::Audience},
    suite::{config::Hints, plan},
};
use clap::{Args, Subcommand};
use std::{num::NonZeroUsize, path::PathBuf, str::FromStr};

/// Returns the help text of `--format`, for the formats that the command accepts.
fn format_help(takes: impl Fn(Format) -> bool) -> String {
    format!("A report: {}; with =FILE, written to a file", Format::join_names(takes))
}

/// Returns the names of the built-in suites as a list for a help text.
fn list_built_in() -> String {
    plan::built_in_names().collect::<Vec<_>>().join(", ")
}

fn suite_help() -> String {
    format!("The suite: a file, or a built-in one ({})", list_built_in())
}

fn built_in_help() -> String {
    format!("A built-in suite ({}), instead of the commented template", list_built_in())
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle grade ./FOSSSim
  fosssim-oracle grade submissions/ --suite course.toml --output grades
  fosssim-oracle grade ./FOSSSim --format text --format gradescope=results.json
  fosssim-oracle grade ./FOSSSim --scene 'GeometricTests/*' --hints full
  fosssim-oracle grade submissions/ --suite course.toml --output grades --for student
  fosssim-oracle grade ./FOSSSim --failed
  fosssim-oracle grade submissions/ --output grades --compare grades

A folder holds one submission per entry: a program, an archive (.zip, .tar.gz, .tar), or a folder with a program of \
the name in --program. A folder that contains such a program itself is one submission; with --single, every folder is \
one. When the suite has a [build] table, folders and archives are built first. A program runs without the files next \
to it.

With --output, results are stored in the folder immediately. (For several submissions, the default folder is \
fosssim-grades.) An interrupted grading continues where it stopped. A scene is run again only if the program, the \
scene or the rules changed. The folder gets index.html (a class) or report.html to look at, grades.csv, \
grades.jsonl, scenes.csv, class.txt and a log per run. With --scene or --failed it gets only the logs: points of a \
part are not a grade.")]
pub(in crate::cli) struct GradeArguments {
    /// Programs, or folders of submissions.
    #[arg(required = true)]
    pub(in crate::cli) programs: Vec<PathBuf>,
    #[arg(long, value_name = "SUITE", default_value = Assignment::DEFAULT.key(), help = suite_help())]
    pub(in crate::cli) suite: String,
    /// The rule books; by default the suite's.
    #[arg(long, value_parser = rules_parser())]
    pub(in crate::cli) rules: Option<Rules>,
    /// The folder for results, logs and the journal.
    #[arg(short, long, value_name = "DIR")]
    pub(in crate::cli) output: Option<PathBuf>,
    #[arg(long, value_name = "FORMAT[=FILE]", help = format_help(|_| true))]
    pub(in crate::cli) format: Vec<String>,
    /// The reader of the reports. Staff see everything; students see what the suite's hints allow, without hidden
    /// groups. The output folder gets pages of both kinds; those for students are in students/.
    #[arg(long = "for", value_parser = audience_parser(), value_name = "READER", default_value = "staff")]
    pub(in crate::cli) reader: Audience,
    /// The number of parallel runs. The default is one per core.
    #[arg(short, long, value_name = "N", value_parser = parse_positive::<NonZeroUsize>)]
    pub(in crate::cli) jobs: Option<NonZeroUsize>,
    /// Run only scenes with these names, such as 'GeometricTests/*' or 'ball-*'; may be given several times.
    #[arg(long, value_name = "GLOB")]
    pub(in crate::cli) scene: Vec<String>,
    /// Run only scenes that were not accepted in the last grading of the same submissions.
    #[arg(long)]
    pub(in crate::cli) failed: bool,
    /// The level of detail in reports. By default staff see everything, and students what the suite allows. `full` may
    /// give a formula away.
    #[arg(long, value_parser = hints_parser(), value_name = "LEVEL")]
    pub(in crate::cli) hints: Option<Hints>,
    /// Find the smallest scene on which a program is still wrong, for up to four causes of each submission, with two
    /// seconds of processor time for each.
    #[arg(long)]
    pub(in crate::cli) smallest: bool,
    /// Keep the traces of scenes that are not accepted, in the output folder.
    #[arg(long)]
    pub(in crate::cli) keep_traces: bool,
    /// The file for the progress, such as `3/85`: the number of scenes with a verdict, and of all scenes. Scenes that
    /// are hidden from the reader do not count.
    #[arg(long, value_name = "FILE", env = "FOSSSIM_PROGRESS")]
    pub(in crate::cli) progress: Option<PathBuf>,
    /// Write an additional page for staff, which shows everything. Only with reports for students.
    #[arg(long, value_name = "FILE", env = "FOSSSIM_STAFF_PAGE")]
    pub(in crate::cli) staff_page: Option<PathBuf>,
    /// Write an additional page, which students see after hidden groups are published. Only with reports for
    /// students, and if groups are hidden.
    #[arg(long, value_name = "FILE", env = "FOSSSIM_PUBLISHED_PAGE")]
    pub(in crate::cli) published_page: Option<PathBuf>,
    /// Keep hidden groups in reports for students, because the platform that requests them hides the groups itself.
    #[arg(long, env = "FOSSSIM_PLATFORM_HIDES")]
    pub(in crate::cli) platform_hides: bool,
    /// Show only a line per submission.
    #[arg(short, long, conflicts_with = "verbose")]
    pub(in crate::cli) quiet: bool,
    /// Show every scene of every submission, including accepted ones.
    #[arg(short, long)]
    pub(in crate::cli) verbose: bool,
    /// The program's name in the folder of a submission.
    #[arg(long, value_name = "NAME", default_value = "FOSSSim")]
    pub(in crate::cli) program: String,
    /// Treat a folder as one submission, not as a folder of submissions.
    #[arg(long)]
    pub(in crate::cli) single: bool,
    /// An earlier grading, to show which scenes became right or wrong since then. Name its output folder, its
    /// grades.jsonl, or the output of --format json.
    #[arg(long, value_name = "OLD")]
    pub(in crate::cli) compare: Option<PathBuf>,
    /// Discard earlier results.
    #[arg(long)]
    pub(in crate::cli) fresh: bool,
    /// Stop at a submission's first scene that is not accepted. Its other scenes are not run, so it has no points.
    #[arg(long)]
    pub(in crate::cli) fail_fast: bool,
    /// Compare with the recorded traces instead of simulating from the submission's states. Everything after the first
    /// wrong step then differs.
    #[arg(long)]
    pub(in crate::cli) recorded: bool,
    /// Grade again whenever the program changes, until interrupted.
    #[arg(long)]
    pub(in crate::cli) watch: bool,
    /// Grade only the I-th of N parts of the submissions, for several machines; `merge` joins the parts. Results are
    /// written to the folder shard-I-of-N in the output folder.
    #[arg(long, value_name = "I/N", conflicts_with_all = ["watch", "failed", "scene"])]
    pub(in crate::cli) shard: Option<ShardArgument>,
    /// Print the processor time of each part at the end: programs, sandbox, judging, explaining, reports.
    #[arg(long, conflicts_with_all = ["watch", "traces"])]
    pub(in crate::cli) timings: bool,
    /// Judge existing traces, and run no program. Every path is a folder with Group/name.bin, or name.bin, for each
    /// scene.
    #[arg(long, conflicts_with_all = ["watch", "failed", "shard", "recorded", "keep_traces", "fail_fast", "single",
        "smallest"])]
    pub(in crate::cli) traces: bool,
    /// Run programs even if required layers of the sandbox are missing. The other layers remain, and every report names
    /// the missing ones.
    #[arg(long)]
    pub(in crate::cli) unsafe_no_sandbox: bool,
}

/// The maximum number of parts into which a grading can be split.
pub(in crate::cli) const MAX_SHARDS: usize = 10_000;

/// A part of the submissions: the one with the given number, of `total` parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) struct ShardArgument {
    /// The number of the part, from 1.
    pub(in crate::cli) number: usize,
    /// The total number of parts.
    pub(in crate::cli) total: usize,
}

impl FromStr for ShardArgument {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let parts = text.split_once('/').and_then(|(number, total)| Some((number.parse().ok()?, total.parse().ok()?)));
        match parts {
            Some((number, total)) if (1..=total).contains(&number) && total <= MAX_SHARDS => Ok(Self { number, total }),
            _ => Err("a shard is I/N: the I-th of N parts, from 1/N to N/N, and N is 10000 at most"),
        }
    }
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle grade submissions/ --shard 1/2 --output grades    # on one machine
  fosssim-oracle grade submissions/ --shard 2/2 --output grades    # on another
  fosssim-oracle merge grades

Each shard of the grading must exist exactly once. The exit code is that of the grading.")]
pub(in crate::cli) struct MergeArguments {
    /// Folders of shards, or folders that contain such folders.
    #[arg(required = true)]
    pub(in crate::cli) folders: Vec<PathBuf>,
    /// The folder for the results. The default is the folder that contains the shards, if you name only one.
    #[arg(short, long, value_name = "DIR")]
    pub(in crate::cli) output: Option<PathBuf>,
    #[arg(long, value_name = "FORMAT[=FILE]", help = format_help(Format::takes_several))]
    pub(in crate::cli) format: Vec<String>,
    /// The reader of HTML pages. Pages for students are written to students/, next to those for staff.
    #[arg(long = "for", value_parser = audience_parser(), value_name = "READER", default_value = "staff")]
    pub(in crate::cli) reader: Audience,
    /// Show only a line per submission.
    #[arg(short, long)]
    pub(in crate::cli) quiet: bool,
}

#[derive(Debug, Subcommand)]
#[command(after_help = "\
Example:
  fosssim-oracle suite init --output course.toml && fosssim-oracle suite check course.toml")]
pub(in crate::cli) enum SuiteCommand {
    Init(SuiteInitArguments),
    Check(SuiteCheckArguments),
    List(SuiteListArguments),
}

/// Prints a suite with comments, from which you can start.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle suite init --output course.toml")]
pub(in crate::cli) struct SuiteInitArguments {
    #[arg(help = built_in_help())]
    pub(in crate::cli) name: Option<String>,

    /// The file for the suite, instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    pub(in crate::cli) output: Option<PathBuf>,
}

/// Checks a suite: its errors, its scenes and points, and the decisions that depend on round-off.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle suite check course.toml
  fosssim-oracle suite check t1m3 --mistakes")]
pub(in crate::cli) struct SuiteCheckArguments {
    /// The suite: a file, or the name of a built-in one.
    pub(in crate::cli) suite: String,
    /// List the pairs of properties that no step of the suite's scenes has.
    #[arg(long)]
    pub(in crate::cli) missing: bool,
    /// List the known mistakes that no scene shows, by area of the assignment. This takes some seconds.
    #[arg(long)]
    pub(in crate::cli) mistakes: bool,
}

/// Lists the built-in suites. The first one is the default.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle suite list --format json")]
pub(in crate::cli) struct SuiteListArguments {
    /// The format of the list.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t = TextOrJson::Text)]
    pub(in crate::cli) format: TextOrJson,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle demo
  fosssim-oracle demo --program flawed && fosssim-oracle grade ./flawed")]
pub(in crate::cli) struct DemoArguments {
    /// The mistake of the sample program, or several mistakes separated by commas; `fosssim-oracle sample --list`
    /// lists them.
    #[arg(long, value_name = "ID")]
    pub(in crate::cli) mistake: Option<String>,
    /// The file for the HTML report on the sample program.
    #[arg(short, long, value_name = "FILE", default_value = "fosssim-demo.html")]
    pub(in crate::cli) output: PathBuf,
    /// Only write the sample program with the mistake to FILE; nothing is graded.
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) program: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle doctor")]
pub(in crate::cli) struct DoctorArguments {}

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  fosssim-oracle selftest")]
pub(in crate::cli) struct SelftestArguments {
    /// The C compiler that builds the hostile programs.
    #[arg(long, value_name = "PROGRAM", default_value = "cc")]
    pub(in crate::cli) compiler: String,
    /// Try the attacks as on a host without this layer (its name in `doctor`).
    #[arg(long, value_name = "LAYER", hide = true)]
    pub(in crate::cli) without: Vec<String>,
    /// Try only attacks whose names contain this text.
    #[arg(long, value_name = "TEXT", hide = true)]
    pub(in crate::cli) only: Option<String>,
}
