//! The scenes that are inside.
use crate::dropped::Host;
use fosssim_model::assignments::Assignment;
use fosssim_model::{
    scene,
    sim::{RootSearch, Simulation},
    trace::{Layout, Recorder},
};
use include_dir::{Dir, File, include_dir};
use serde_json::{Value, json};

static ASSETS: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/../../assets");

/// Their names by assignment and group, in alphabetical order.
pub(crate) fn list() -> Value {
    let groups = |assignment: &Assignment| -> Vec<Value> {
        let folder = ASSETS.get_dir(assignment.key());
        let mut groups: Vec<_> = folder.into_iter().flat_map(Dir::dirs).collect();
        groups.sort_by_key(|group| group.path());
        groups
            .into_iter()
            .map(|group| {
                let mut names: Vec<_> =
                    group.files().filter_map(|file| file.path().file_name()?.to_str()?.strip_suffix(".xml")).collect();
                names.sort_unstable();
                json!({ "group": group.path().file_name().and_then(|name| name.to_str()), "names": names })
            })
            .collect()
    };
    let all = Assignment::ALL.iter();
    all.map(|one| json!({ "title": one.definition().title, "groups": groups(one) })).collect()
}

/// The XML of a scene, `Group/name`.
pub(crate) fn xml(name: &str) -> Result<&'static [u8], String> {
    let file = |assignment: Assignment| ASSETS.get_file(format!("{}/{name}.xml", assignment.key()));
    let found = Assignment::ALL.into_iter().find_map(file);
    found.map(File::contents).ok_or_else(|| format!("there is no scene asset:{name}"))
}

/// The names of the scenes with whose first record a dropped trace begins.
pub(crate) fn beginning(file: u32, host: &dyn Host) -> Vec<String> {
    let mut start = vec![0; 1 << 16];
    let Some(count) = host.read(file, 0, &mut start) else { return Vec::new() };
    start.truncate(count);
    let groups = ASSETS.dirs().flat_map(Dir::dirs);
    let files = groups.flat_map(Dir::files).filter(|file| is_beginning(file, &start));
    let name = |file: &File<'_>| {
        let path = file.path();
        let group = path.parent()?.file_name()?.to_str()?;
        Some(format!("{group}/{}", path.file_stem()?.to_str()?))
    };
    files.filter_map(name).collect()
}

/// Whether a trace with this beginning may be one of the scene.
fn is_beginning(file: &File<'_>, start: &[u8]) -> bool {
    let Ok(loaded) = scene::read("", file.contents()) else { return false };
    let simulation = Simulation::new(&loaded.scene, RootSearch::WhereNeeded);
    let recorder = Recorder::start(Vec::new(), Layout::of(&loaded.scene), simulation.state());
    recorder.finish().is_ok_and(|(record, _)| start.starts_with(&record))
}
