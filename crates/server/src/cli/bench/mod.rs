//! `bench`: a server of its own, and as many simulated students as it bears, on this one machine.
mod attack;
mod client;
mod ladder;
mod measure;
mod million;
mod stage;

use super::arguments::{Bench, What};
use anyhow::Result;

/// Runs what was asked for, and prints its numbers.
pub(super) async fn run(arguments: &Bench) -> Result<()> {
    match arguments.what {
        What::Ladder => ladder::climb(arguments).await,
        What::SlowReaders => attack::slow_readers(arguments).await,
        What::HalfOpen => attack::half_open(arguments).await,
        What::Million => million::run(arguments).await,
    }
}
