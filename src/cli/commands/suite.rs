//! `suite`: writes, checks and explains suites.
use super::grade::load_suite;
use crate::{
    cli::{
        console, exit,
        grading::{Suite, SuiteCheck, SuiteInit},
    },
    judge::{
        PairWords, PassWords, Rules,
        fair::{Borderline, borderline},
    },
    report::grade::points,
    sim::StepError,
    suite::{config, library, plan},
};
use anyhow::{Result, bail};
use rayon::prelude::*;
use std::fmt::Write;

pub(super) fn run(suite: &Suite) -> Result<u8> {
    let text = match suite {
        Suite::Init(SuiteInit { name: None }) => config::TEMPLATE.to_owned(),
        Suite::Init(SuiteInit { name: Some(name) }) => match plan::built_in(name) {
            Some(text) => text.to_owned(),
            None => {
                let known: Vec<_> = plan::built_in_names().collect();
                bail!("no suite {name} comes with the program; there are {}", known.join(", "));
            }
        },
        Suite::Check(SuiteCheck { suite }) => {
            let plan = load_suite(suite)?;
            explain(&plan) + &notes(&undecided(&plan))
        }
        Suite::Scenes(_) => library::names().fold(String::new(), |text, name| text + "asset:" + name + "\n"),
    };
    console::print(text.as_bytes())?;
    Ok(exit::ACCEPTED)
}

/// What the choice of rule books means.
const fn rules(rules: Rules) -> &'static str {
    match rules {
        Rules::Parity => "parity: the original's verdict counts, the fair rules are not asked",
        Rules::Fair => "fair: the fair rules' verdict counts",
        Rules::Both => "both: the original's verdict counts, reports say where the fair rules differ and why",
    }
}

/// A scene and those of the reference's decisions that round-off may flip, or why it has no run.
type Undecided = (String, std::result::Result<Vec<Borderline>, StepError>);

/// Runs the reference on every scene, on all cores, and keeps those with something to say.
fn undecided(plan: &plan::Plan) -> Vec<Undecided> {
    let tasks: Vec<_> = plan.scenes().collect();
    let all = tasks.par_iter().map(|task| (task.name.clone(), borderline(&task.scene)));
    all.filter(|(_, found)| !matches!(found, Ok(found) if found.is_empty())).collect()
}

/// So many decisions of a scene are listed.
const LISTED: usize = 3;

/// What is no error, but worth knowing before a class is graded.
fn notes(undecided: &[Undecided]) -> String {
    let mut text = String::new();
    for (scene, found) in undecided {
        let found = match found {
            Ok(found) => found,
            Err(error) => {
                let _ = writeln!(text, "\nnote: {scene} can't be simulated to its end: {error}");
                continue;
            }
        };
        let plural = if found.len() == 1 { "a decision" } else { "decisions" };
        let _ = writeln!(
            text,
            "\nnote: {scene} has {plural} that round-off may flip; by the original's rules correct programs may fail"
        );
        for decision in found.iter().take(LISTED) {
            let word = if decision.collides { "collide" } else { "do not collide" };
            let (pair, pass) = (PairWords(decision.pair), PassWords(decision.pass));
            let _ = writeln!(text, "  step {}: {pair} {word} ({pass})", decision.step);
        }
        if found.len() > LISTED {
            let _ = writeln!(text, "  and {} more", found.len() - LISTED);
        }
    }
    text
}

fn explain(plan: &plan::Plan) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "{}: {} scenes, {} points", plan.name, plan.scenes().count(), points(plan.max_points()));
    let _ = writeln!(text, "run: {}", plan.run.join(" "));
    if let Some(build) = &plan.build {
        let _ = writeln!(
            text,
            "build: {} (makes {}), {} s, {} MiB",
            build.command.join(" "),
            build.program,
            build.wall.as_secs_f64(),
            build.memory >> 20
        );
    }
    let limits = &plan.limits;
    let _ = writeln!(
        text,
        "limits: {} s of processor, {} s on the clock, {} MiB of memory, {} MiB of output, {} MiB of trace",
        limits.cpu.as_secs_f64(),
        limits.wall.as_secs_f64(),
        limits.memory >> 20,
        limits.output >> 20,
        limits.trace >> 20,
    );
    let _ = writeln!(text, "rules: {}", rules(plan.rules));
    let (hints, meaning) = plan.hints.words();
    let _ = writeln!(text, "hints: {hints}: {meaning}");
    for group in &plan.groups {
        let _ = writeln!(
            text,
            "\n{}: {} points, {:?} credit, {}",
            group.name,
            points(group.stakes.points),
            group.stakes.credit,
            group.stakes.visibility.key().replace('_', " "),
        );
        for task in &group.scenes {
            let _ = writeln!(
                text,
                "  {} ({} particles, {} steps)",
                task.name,
                task.scene.particles.len(),
                task.scene.steps()
            );
        }
    }
    text
}
