//! The command `suite`, which writes, checks and explains suites.
use super::{
    suite_report::{SuiteContents, UndecidedScene, list_json, list_suites, render_text},
    visible_mistakes::find_visible_mistakes,
};
use crate::{
    cli::{
        arguments::grade::{SuiteCheckArguments, SuiteCommand, SuiteInitArguments, SuiteListArguments},
        console,
        output::Output,
    },
    judge::fair::find_borderline,
    suite::{config, coverage::Coverage, plan},
};
use anyhow::{Context, Result, bail};
use rayon::prelude::*;

pub(super) fn run(suite: &SuiteCommand) -> Result<()> {
    match suite {
        SuiteCommand::Init(SuiteInitArguments { name, output }) => {
            let text = suite_template(name.as_deref())?;
            match output {
                Some(file) if file.is_file() => {
                    bail!("{} exists, and may contain your changes; choose another file, or remove it", file.display())
                }
                Some(file) => Output::create(file, &[])?.finish_and_print(text.as_bytes(), false),
                None => console::print(&text),
            }
        }
        SuiteCommand::Check(SuiteCheckArguments { suite, missing, mistakes }) => {
            let plan = plan::find_suite(suite)?;
            let parts = if *mistakes { find_visible_mistakes(&plan) } else { Vec::new() };
            let contents =
                SuiteContents { coverage: measure_coverage(&plan), lists_missing: *missing, visible_parts: parts };
            console::report(&render_text(&plan, &contents, &find_undecided(&plan), console::style()))
        }
        SuiteCommand::List(SuiteListArguments { format }) => {
            let suites = list_built_in()?;
            console::show(*format, || list_suites(&suites, console::style()), || list_json(&suites))
        }
    }
}

/// Returns a suite with comments, and with the groups of a built-in suite.
fn suite_template(name: Option<&str>) -> Result<String> {
    let name = name.map_or_else(plan::default_name, str::to_owned);
    config::suite_template(&name).with_context(|| {
        let suite_names: Vec<_> = plan::built_in_names().collect();
        format!("there is no built-in suite {name}; choose {}{}", suite_names.join(", "), plan::suggest(&name))
    })
}

/// Returns the names of the built-in suites, and their plans.
fn list_built_in() -> Result<Vec<(String, plan::Plan)>> {
    plan::built_in_names().map(|name| plan::find_suite(&name).map(|plan| (name, plan)).map_err(Into::into)).collect()
}

/// Runs the reference on every scene, on all cores. Returns the scenes in which round-off may change decisions.
fn find_undecided(plan: &plan::Plan) -> Vec<UndecidedScene> {
    let tasks: Vec<_> = plan.scenes().collect();
    let all = tasks.par_iter().map(|task| (task.name.clone(), find_borderline(&task.scene)));
    all.filter(|(_, found)| !matches!(found, Ok(found) if found.is_empty())).collect()
}

/// Measures what the scenes contain, on all cores. Scenes that can't be simulated to their end are left out, because
/// [`find_undecided`] reports them.
fn measure_coverage(plan: &plan::Plan) -> Coverage {
    let tasks: Vec<_> = plan.scenes().collect();
    let all = tasks.par_iter().filter_map(|task| Coverage::for_scene(&task.scene).ok());
    all.reduce(Coverage::default, |mut one, other| {
        one.add(&other);
        one
    })
}
