//! Prints the explanations of programs whose mistake the catalogue does not have (`mutants`): a line on each, and the
//! figures that `docs/fair.md` names. Ends with status 1 when something misleads.
//!
//! usage: `outside-table [PART-OF-A-NAME]`
#![forbid(unsafe_code)]
use std::process::ExitCode;

use fosssim_lab::outside::{Rated, Rating, rated};
use fosssim_oracle::report::words::explanation::{details, what};

fn main() -> ExitCode {
    let part = std::env::args().nth(1).unwrap_or_default();
    let all: Vec<Rated> = rated(|_, mutant| mutant.id.contains(&part));
    for one in &all {
        println!("{:<32} {:<10} ({})", one.id, format!("{:?}", one.rating), one.what);
        for told in &one.told {
            println!("    {} [{}] {}", what(told), told.key, details(told).join(" | "));
        }
    }
    let count = |rating: Rating| all.iter().filter(|one| one.rating == rating).count();
    println!(
        "\n{} mistakes: {} right, {} partly right, {} unknown, {} misleading",
        all.len(),
        count(Rating::Right),
        count(Rating::Partly),
        count(Rating::Unknown),
        count(Rating::Misleading)
    );
    ExitCode::from(u8::from(count(Rating::Misleading) > 0))
}
