//! Judges and explains millions of traces that were made wrong at random: the fuzz targets' own functions, on all
//! processors and without a fuzzer's coverage, some hundred times faster than with it.
//!
//!     storm [TARGET] [RUNS] [SEED]        TARGET judge (default), explain or trace; RUNS 1,000,000
//!
//! Every trace is made from a seed of the target by one to eight changes: a number replaced by an extreme one, by its
//! neighbour, its negative or another number of the trace; a bit turned; a count changed; bytes cut out, doubled, moved
//! or left off. The same seed makes the same traces. A panic ends the storm and leaves the trace as `storm-TARGET-RUN`
//! in the working folder.
#![forbid(unsafe_code)]
use fosssim_lab::dice::Dice;
use rayon::prelude::*;
use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    path::Path,
    process::ExitCode,
    sync::atomic::{AtomicU64, Ordering},
    time::Instant,
};

#[path = "../../../../fuzz/entries.rs"]
#[expect(dead_code, reason = "targets that read other things than traces")]
mod entries;

/// Runs between two lines of progress.
const BLOCK: u64 = 250_000;

/// One change. The first byte chooses the scene and stays.
fn change(bytes: &mut Vec<u8>, dice: &mut Dice) {
    let length = bytes.len() - 1;
    if length < 8 {
        bytes.extend_from_slice(&dice.throw().to_le_bytes());
        return;
    }
    // Numbers lie behind the first byte, mostly at multiples of four.
    let at = 1 + dice.below(length / 4) * 4;
    let room = |size: usize| at + size <= bytes.len();
    match dice.below(10) {
        0..=2 if room(8) => {
            let extreme = entries::EXTREMES[dice.below(entries::EXTREMES.len())];
            bytes[at..at + 8].copy_from_slice(&extreme.to_le_bytes());
        }
        3 | 4 if room(8) => {
            let mut word = [0; 8];
            word.copy_from_slice(&bytes[at..at + 8]);
            let number = f64::from_le_bytes(word);
            let new = match dice.below(5) {
                0 => -number,
                1 => number * 1e3,
                2 => number + 1e-9,
                3 => f64::from_bits(number.to_bits() ^ 1),
                _ => number * f64::from_bits(0x3fe0_0000_0000_0000 + (dice.throw() >> 12)),
            };
            bytes[at..at + 8].copy_from_slice(&new.to_le_bytes());
        }
        5 if room(8) => {
            let from = 1 + dice.below((length - 7) / 4) * 4;
            bytes.copy_within(from..from + 8, at);
        }
        6 => {
            let bit = dice.below(length * 8);
            bytes[1 + bit / 8] ^= 1 << (bit % 8);
        }
        7 if room(4) => {
            let count = [0, 1, 2, 3, 5, 255, 65_536, u32::MAX][dice.below(8)];
            bytes[at..at + 4].copy_from_slice(&count.to_le_bytes());
        }
        8 => {
            let size = (dice.below(12) + 1) * 4;
            let piece = bytes[at..(at + size).min(bytes.len())].to_vec();
            let to = 1 + dice.below(length / 4) * 4;
            match dice.below(2) {
                0 => drop(bytes.splice(to..to, piece)),
                _ => drop(bytes.drain(at..(at + size).min(bytes.len()))),
            }
        }
        _ => bytes.truncate(1 + dice.below(length)),
    }
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let target = words.first().map_or("judge", String::as_str);
    let number = |index: usize, otherwise: u64| words.get(index).map_or(Some(otherwise), |word| word.parse().ok());
    let run: fn(&[u8]) = match target {
        "judge" => entries::judge,
        "explain" => entries::explain,
        "trace" => entries::trace,
        _ => return usage(),
    };
    let (Some(runs), Some(seed)) = (number(1, 1_000_000), number(2, 1)) else { return usage() };
    let folder = if target == "trace" { "trace" } else { "judge" };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds").join(folder);
    let mut seeds: Vec<(String, Vec<u8>)> = Vec::new();
    for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
        seeds.extend(
            std::fs::read(entry.path()).ok().map(|bytes| (entry.file_name().to_string_lossy().into_owned(), bytes)),
        );
    }
    seeds.retain(|(_, bytes)| bytes.len() > 1);
    seeds.sort();
    if seeds.is_empty() {
        eprintln!("error: {} holds no seeds", folder.display());
        return ExitCode::from(2);
    }
    let (begin, failed) = (Instant::now(), AtomicU64::new(u64::MAX));
    for block in (0..runs).step_by(BLOCK as usize) {
        let end = (block + BLOCK).min(runs);
        (block..end).into_par_iter().for_each(|number| {
            let mut dice = Dice::of(seed, number);
            let mut bytes = seeds[dice.below(seeds.len())].1.clone();
            for _ in 0..=dice.below(8) {
                change(&mut bytes, &mut dice);
            }
            if catch_unwind(AssertUnwindSafe(|| run(&bytes))).is_err() {
                failed.fetch_min(number, Ordering::Relaxed);
                let name = format!("storm-{target}-{number}");
                match std::fs::write(&name, &bytes) {
                    Ok(()) => eprintln!("run {number} failed: {name}"),
                    Err(error) => eprintln!("run {number} failed, and {name} can't be written: {error}"),
                }
            }
        });
        println!("{target}: {end} runs, {:.0} per second", end as f64 / begin.elapsed().as_secs_f64());
        if failed.load(Ordering::Relaxed) < u64::MAX {
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn usage() -> ExitCode {
    eprintln!("usage: storm [judge|explain|trace] [RUNS] [SEED]");
    ExitCode::from(2)
}
