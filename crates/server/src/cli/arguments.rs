//! The command line as typed.
use crate::db::Address;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::{num::NonZeroUsize, path::PathBuf};

/// The service of fosssim-oracle: takes submissions, grades them, keeps the grades.
#[derive(Debug, Parser)]
#[command(name = "fosssim-server", version, max_term_width = 100)]
pub(super) struct Arguments {
    /// How the log is written.
    #[arg(long, value_enum, default_value_t = LogFormat::Text, global = true)]
    pub(super) log_format: LogFormat,
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum LogFormat {
    /// For people.
    Text,
    /// One JSON object per line.
    Json,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    Worker(Worker),
}

/// Where everything is kept.
#[derive(Debug, Args)]
pub(super) struct Place {
    /// The folder of the database, the artefacts and the jobs' working folders.
    #[arg(long, value_name = "DIR", default_value = "fosssim-data")]
    pub(super) data: PathBuf,
    /// The database: sqlite:FILE or postgres://USER:PASSWORD@HOST/NAME. A SQLite file in the data folder by default.
    #[arg(long, value_name = "ADDRESS", env = "FOSSSIM_DATABASE", hide_env_values = true)]
    pub(super) database: Option<Address>,
}

/// How workers work.
#[derive(Debug, Args)]
pub(super) struct Work {
    /// Gradings at one time. One per core by default.
    #[arg(long, value_name = "N")]
    pub(super) slots: Option<NonZeroUsize>,
    /// Scenes of one grading at one time.
    #[arg(long, value_name = "N", default_value = "1")]
    pub(super) threads: NonZeroUsize,
    /// The grader; by default the program fosssim-oracle beside this one.
    #[arg(long, value_name = "PROGRAM")]
    pub(super) grader: Option<PathBuf>,
    /// After so many seconds without a sign of a worker its jobs are given to others.
    #[arg(long, value_name = "SECONDS", default_value_t = 30, value_parser = clap::value_parser!(u64).range(1..=3600))]
    pub(super) lease: u64,
    /// A job that failed so often is given up.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub(super) tries: u32,
}

/// Grades what waits in the queue.
#[derive(Debug, Args)]
pub(super) struct Worker {
    #[command(flatten)]
    pub(super) place: Place,
    #[command(flatten)]
    pub(super) work: Work,
    /// What this worker is called. Host and process by default.
    #[arg(long)]
    pub(super) name: Option<String>,
}
