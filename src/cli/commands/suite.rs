//! `suite`: writes, checks and explains suites.
use super::grade::load_suite;
use crate::{
    cli::{
        console, exit,
        grading::{Suite, SuiteCheck, SuiteInit},
    },
    judge::Rules,
    report::grade::points,
    suite::{config, library, plan},
};
use anyhow::{Result, bail};
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
        Suite::Check(SuiteCheck { suite }) => explain(&load_suite(suite)?),
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
