//! How many scenes of a suite, and how many probe scenes, refuse each wrong program: those of the catalogue, of
//! `mutants`, and of `operators`. `scripts/sight-matrix [SUITE [PART-OF-A-NAME [ENOUGH]]]` builds and
//! calls it.
//!
//! It prints the programs that fewer than three scenes of the suite refuse, or no probe scene, with those that do, and
//! the figures that `docs/fair.md` names. It ends with status 1 when there is such a program.
#![forbid(unsafe_code)]
use fosssim_lab::{
    operators::{EQUIVALENT, mutations},
    runs::Watched,
    sight::{WrongProgram, witnesses, wrong_programs},
};
use fosssim_oracle::assignments::Assignment;
use rayon::prelude::*;
use std::process::ExitCode;

/// The number of scenes of the suite that have to refuse each wrong program.
const WANTED: usize = 3;

fn main() -> anyhow::Result<ExitCode> {
    let mut arguments = std::env::args().skip(1);
    let suite = arguments.next().unwrap_or_else(|| Assignment::DEFAULT.key().to_owned());
    let part = arguments.next().unwrap_or_default();
    let enough: usize = arguments.next().map_or(Ok(WANTED), |text| text.parse())?;
    let (scenes, probes) = (Watched::of_suite(&suite)?, Watched::probes());
    let programs: Vec<WrongProgram> = wrong_programs().into_iter().filter(|one| one.name.contains(&part)).collect();
    let seen: Vec<(Vec<&str>, Vec<&str>)> = programs
        .par_iter()
        .map(|one| {
            (witnesses(&scenes, one.student, enough), witnesses(&probes, one.student, enough.min(1).max(enough / 3)))
        })
        .collect();
    let (mut few, mut unseen) = (0, 0);
    for (program, (suite, probes)) in programs.iter().zip(&seen) {
        few += usize::from(suite.len() < WANTED);
        unseen += usize::from(probes.is_empty());
        if suite.len() < WANTED || probes.is_empty() {
            println!("{:<60} {} {} {}", program.name, suite.len(), probes.len(), suite.join(" "));
        }
    }
    let same: usize = EQUIVALENT.iter().map(|(_, operators, _)| operators.len()).sum();
    println!(
        "\n{} wrong programs: {few} are refused by fewer than {WANTED} of {} scenes, {unseen} by none of {} probe scenes\n\
         {} of them by operators; {same} more mutations change nothing",
        programs.len(),
        scenes.len(),
        probes.len(),
        mutations().len() - same,
    );
    Ok(ExitCode::from(u8::from(few > 0 || unseen > 0)))
}
