//! The number of students that the service bears, and what hostile clients cost it: a server of its own on this
//! machine, in a folder that goes away again. Prints a table.
//!
//!     cargo bench -p fosssim-server -- ladder --students 50,100,200
#![forbid(unsafe_code)]

mod attack;
mod client;
mod ladder;
mod measure;
mod million;
mod rush;
mod stage;

use anyhow::Result;
use clap::{Parser, ValueEnum};
use std::{ffi::OsString, path::PathBuf};

/// Measures a server of its own on this machine.
#[derive(Debug, Parser)]
pub(crate) struct Bench {
    /// The measurement.
    #[arg(value_enum, default_value_t = Measurement::Ladder)]
    measurement: Measurement,
    /// The rungs of the ladder: simulated students.
    #[arg(long, value_name = "N,N,...", value_delimiter = ',', default_value = "50,100,200,500,1000,2000")]
    students: Vec<usize>,
    /// How long each rung is, and how long others are watched.
    #[arg(long, value_name = "SECONDS", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=3600))]
    seconds: u64,
    /// Submissions of `million`.
    #[arg(long, value_name = "N", default_value_t = 1_000_000, value_parser = clap::value_parser!(i64).range(1000..))]
    count: i64,
    /// An empty database for it: postgres://USER:PASSWORD@HOST/NAME. A SQLite file by default.
    #[arg(long, value_name = "ADDRESS")]
    database: Option<String>,
    /// The grader; by default a script that answers at once, so that the service is what is measured.
    #[arg(long, value_name = "PROGRAM")]
    grader: Option<PathBuf>,
    /// The students' program; a script that does nothing by default.
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// Gradings at one time.
    #[arg(long, value_name = "N", default_value_t = 2)]
    workers: usize,
    /// Cargo says this to every benchmark.
    #[arg(long, hide = true)]
    bench: bool,
}

/// The measurements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Measurement {
    /// 50 to 2,000 students who sign in, look at the course, hand in, wait for the grade and read the report, without
    /// a pause between. At the end all hand in within the last seconds before a deadline.
    Ladder,
    /// 40 connections that read an upload of 120 MiB slowly.
    SlowReaders,
    /// A million submissions, exported and removed.
    Million,
}

/// Runs the measurement that these words ask for, and prints its numbers; the same text is the answer.
pub(crate) fn run(words: impl IntoIterator<Item = OsString>) -> Result<String> {
    let bench = Bench::parse_from(words);
    tokio::runtime::Builder::new_multi_thread().enable_all().build()?.block_on(async {
        match bench.measurement {
            Measurement::Ladder => ladder::climb(&bench).await,
            Measurement::SlowReaders => attack::slow_readers(&bench).await,
            Measurement::Million => million::run(&bench).await,
        }
    })
}

#[allow(dead_code, reason = "tests include this file, and begin elsewhere")]
fn main() -> Result<()> {
    run(std::env::args_os()).map(drop)
}
