//! The command `scene`, which lists, prints and exports the built-in scenes.
use crate::{
    cli::{
        arguments::scenes::{SceneCommand, SceneExportArguments, SceneListArguments, SceneShowArguments},
        console,
        input::describe_missing_asset,
        output,
        selection::Selection,
    },
    files::{FileError, FilePlace},
    report::{number::format_count, scene as report},
    scene::{self, MAX_SCENE_BYTES},
    suite::library,
};
use anyhow::{Context, Result, bail};

pub(super) fn run(command: &SceneCommand) -> Result<()> {
    match command {
        SceneCommand::List(SceneListArguments { patterns, quiet }) => print_list(patterns, *quiet),
        SceneCommand::Show(SceneShowArguments { name }) => show(name),
        SceneCommand::Export(arguments) => export(arguments),
    }
}

/// Prints the names of the scenes that match the patterns. Without patterns, all scenes are listed.
fn print_list(patterns: &[String], quiet: bool) -> Result<()> {
    let names = matching_names(patterns)?;
    if quiet {
        let text: String = names.iter().map(|name| format!("asset:{name}\n")).collect();
        return console::print(&text);
    }
    let mut scenes = Vec::new();
    for name in names {
        let xml = library::find_scene(name).with_context(|| format!("cannot find the listed scene {name}"))?;
        let loaded = scene::read(name, xml).map_err(|_| anyhow::anyhow!("the embedded scene {name} is not valid"))?;
        scenes.push((name, loaded.scene));
    }
    console::report(&report::list_scenes(&scenes, console::style()))
}

fn show(name: &str) -> Result<()> {
    let name = name.strip_prefix("asset:").unwrap_or(name);
    let name = name.strip_suffix(".xml").unwrap_or(name);
    if let Some(xml) = library::find_scene(name) {
        return console::print(xml);
    }
    // A name without its group is accepted if it is unique.
    let matching: Vec<_> = library::all_names().filter(|known| known.rsplit('/').next() == Some(name)).collect();
    match (matching[..].first().and_then(|only| library::find_scene(only)), matching.len()) {
        (Some(xml), 1) => console::print(xml),
        _ => bail!("{}", describe_missing_asset("scene", name)),
    }
}

fn export(arguments: &SceneExportArguments) -> Result<()> {
    let names = matching_names(&arguments.patterns)?;
    let (mut written, mut unchanged, mut conflicts) = (0_u64, 0_u64, Vec::new());
    for name in names {
        let xml = library::find_scene(name).with_context(|| format!("cannot find the listed scene {name}"))?;
        let place = FilePlace::new(&arguments.output, format!("{name}.xml"));
        match has_contents(&place, xml) {
            Some(true) => unchanged += 1,
            Some(false) if !arguments.force => conflicts.push(place.path()),
            _ => {
                output::write_below(&place, xml)?;
                written += 1;
            }
        }
    }
    if !arguments.quiet {
        let rest =
            if unchanged > 0 { format!(", {} there already", format_count(unchanged, "scene")) } else { String::new() };
        let folder = arguments.output.display();
        console::report(&format!("{} written to {folder}{rest}\n", format_count(written, "scene")))?;
    }
    if let Some(first) = conflicts.first() {
        let others_note =
            if conflicts.len() > 1 { format!(" and {} more", conflicts.len() - 1) } else { String::new() };
        bail!("{}{others_note}: not overwritten, because the content differs; --force overwrites", first.display());
    }
    Ok(())
}

/// Returns whether a file has exactly this content; `None` if there is no such file.
fn has_contents(place: &FilePlace, bytes: &[u8]) -> Option<bool> {
    match place.read(MAX_SCENE_BYTES as u64) {
        Ok(old) => Some(old == bytes),
        Err(FileError::Missing { .. }) => None,
        Err(_) => Some(false),
    }
}

/// Returns the names of the embedded scenes that match patterns.
fn matching_names(patterns: &[String]) -> Result<Vec<&'static str>> {
    let names: Vec<_> = library::all_names().collect();
    let selection = Selection::new(patterns, &names)?;
    Ok(names.into_iter().filter(|name| selection.selects(name)).collect())
}
