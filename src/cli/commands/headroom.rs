//! `check --self`: how much room the original's rules leave in scenes.
use crate::{
    assignments::Assignment,
    cli::{
        arguments::{CheckArguments, CheckFormat},
        console, exit, input,
        output::Output,
    },
    report::{headroom as report, style::Style},
    scene::Scene,
    suite::{headroom::headroom, plan},
};
use anyhow::{Context, Result, bail};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

pub(super) fn run(scenes: &[PathBuf], arguments: &CheckArguments) -> Result<u8> {
    if matches!(arguments.format, CheckFormat::Html | CheckFormat::Github) {
        bail!("check --self has no trace to show; use --format text or json");
    }
    let target = arguments.output.as_deref().map(|name| Output::create(name, &[])).transpose()?;
    let scenes = if scenes.is_empty() { built_in()? } else { files(scenes)? };
    let measured = scenes
        .par_iter()
        .map(|(name, scene)| Ok((name.clone(), headroom(scene).with_context(|| format!("the scene {name}"))?)))
        .collect::<Result<Vec<_>>>()?;
    let style = if target.is_some() { Style::Plain } else { console::style() };
    let text = match arguments.format {
        CheckFormat::Json => report::json(&measured),
        _ => report::text(&measured, style),
    };
    match (target, arguments.format) {
        (Some(target), _) => target.finish_with(text.as_bytes())?,
        (None, CheckFormat::Text) => console::report(&text)?,
        (None, _) => console::print(&text)?,
    }
    let is_fair = measured.iter().all(|(_, headroom)| headroom.is_fair());
    Ok(if is_fair { exit::ACCEPTED } else { exit::NOT_ACCEPTED })
}

fn built_in() -> Result<Vec<(String, Scene)>> {
    let text = plan::built_in(Assignment::DEFAULT.key()).context("the built-in suite")?;
    let plan = plan::load(text, Path::new("."))?;
    Ok(plan.scenes().map(|task| (task.name.clone(), task.scene.clone())).collect())
}

fn files(scenes: &[PathBuf]) -> Result<Vec<(String, Scene)>> {
    scenes
        .iter()
        .map(|path| {
            let loaded = input::scene(path)?;
            Ok((loaded.name, loaded.scene))
        })
        .collect()
}
