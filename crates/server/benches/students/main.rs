//! Measures how many students the service can serve, and what hostile clients cost it. Starts a server on this machine
//! in a temporary folder, and prints a table.
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

/// Starts a server on this machine, and measures it.
#[derive(Debug, Parser)]
pub(crate) struct Bench {
    /// The kind of measurement.
    #[arg(value_enum, default_value_t = Measurement::Ladder)]
    measurement: Measurement,
    /// The number of simulated students on each rung of the ladder.
    #[arg(long, value_name = "N,N,...", value_delimiter = ',', default_value = "50,100,200,500,1000,2000")]
    students: Vec<usize>,
    /// The duration of each rung, and of the measurements of other clients, in seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=3600))]
    seconds: u64,
    /// The number of submissions for `million`.
    #[arg(long, value_name = "N", default_value_t = 1_000_000, value_parser = clap::value_parser!(i64).range(1000..))]
    count: i64,
    /// An empty database: postgres://USER:PASSWORD@HOST/NAME. The default is a SQLite file.
    #[arg(long, value_name = "ADDRESS")]
    database: Option<String>,
    /// The grader. The default is a script that answers immediately, so that only the service is measured.
    #[arg(long, value_name = "PROGRAM")]
    grader: Option<PathBuf>,
    /// The students' program. The default is a script that does nothing.
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// The number of parallel gradings.
    #[arg(long, value_name = "N", default_value_t = 2)]
    workers: usize,
    /// An option that Cargo passes to every benchmark.
    #[arg(long, hide = true)]
    bench: bool,
}

/// The kinds of measurements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Measurement {
    /// 50 to 2,000 students sign in, open the course, submit, wait for the grade and read the report, without pauses.
    /// At the end, all submit within the last seconds before a deadline.
    Ladder,
    /// 40 connections read an upload of 120 MiB slowly.
    SlowReaders,
    /// A million submissions are exported and removed.
    Million,
}

/// Runs the measurement that the arguments select. Prints the numbers, and returns them as text.
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
