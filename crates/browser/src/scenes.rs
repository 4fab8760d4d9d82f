//! Answers requests about the embedded scenes.
use crate::{
    dropped::{PageHost, ReadFault, open},
    parts::PageAnswer,
};
use fosssim_grading::{library, suggestions};
use fosssim_model::{
    assignments::Assignment,
    scene,
    sim::{RootSearch, Simulation},
    trace::{Layout, Recorder},
};
use fosssim_report::check::{SNIFFED_BYTES, detect_file_kind};
use serde_json::{Value, json};
use std::{collections::BTreeMap, io::Read};

/// The number of bytes of a trace that are compared with the first records of scenes. Scenes with longer first records
/// are not recognized.
const MAX_FIRST_RECORD_BYTES: u64 = 1 << 16;

/// Lists the names of the scenes by assignment and group, in alphabetical order.
pub(crate) fn list_scenes() -> Value {
    let list_groups = |assignment: Assignment| {
        let mut groups = BTreeMap::<&str, Vec<&str>>::new();
        for name in library::scene_names().filter(|name| library::find_assignment(name) == Some(assignment)) {
            let (group, rest) = name.split_once('/').unwrap_or(("", name));
            groups.entry(group).or_default().push(rest);
        }
        let groups = groups.into_iter().map(|(group, names)| json!({ "group": group, "names": names }));
        json!({ "title": assignment.definition().title, "groups": groups.collect::<Vec<_>>() })
    };
    Assignment::list_default_first().into_iter().map(list_groups).collect()
}

/// Returns the name of an embedded suite, such as `t2m2@3`, and its title.
pub(crate) fn describe_suite(name: &str) -> Value {
    let assignment = Assignment::from_key(name.split('@').next().unwrap_or_default()).unwrap_or(Assignment::DEFAULT);
    json!({ "name": name, "title": format!("{} ({name})", assignment.definition().title) })
}

/// Returns the XML of a scene. The name is `Group/name`.
pub(crate) fn find_xml(name: &str) -> Result<&'static [u8], String> {
    library::find_scene(name).ok_or_else(|| {
        let nearest = suggestions::find_nearest(name, library::all_names(), 3).join(", asset:");
        format!("there is no scene asset:{name}; the nearest are asset:{nearest}")
    })
}

/// Returns the names of the scenes to which a dropped trace may belong, according to its first record. If the file
/// cannot be a trace, also returns its probable kind.
pub(crate) fn recognize_scenes(file: u32, host: &dyn PageHost) -> PageAnswer {
    let (fault, mut start) = (ReadFault::new(), Vec::new());
    // If there is an error, its message is in `fault`.
    let _ = open(host, file, &fault).take(MAX_FIRST_RECORD_BYTES).read_to_end(&mut start);
    if let Some(error) = fault.get() {
        return Err(format!("cannot read the trace: {error}"));
    }
    let is_possible_scene = |name: &&str| library::find_scene(name).is_some_and(|xml| may_begin_trace(xml, &start));
    let scenes: Vec<_> = library::scene_names().filter(is_possible_scene).collect();
    let kind = detect_file_kind(&start[..start.len().min(SNIFFED_BYTES as usize)])
        .or_else(|| (!begins_with_positions(&start)).then_some("begins with numbers that cannot be positions"));
    Ok((json!({ "scenes": scenes, "looks_like": kind }), Vec::new()))
}

/// Returns whether at least half of the first numbers have the size of positions and velocities. Arbitrary bytes are
/// mostly extremely large or small numbers.
fn begins_with_positions(start: &[u8]) -> bool {
    let numbers = start.as_chunks::<8>().0.iter().take(4).map(|bytes| f64::from_le_bytes(*bytes).abs());
    let (usual, others): (Vec<f64>, Vec<f64>) = numbers.partition(|size| *size == 0.0 || (1e-9..1e9).contains(size));
    usual.len() >= others.len()
}

/// Returns whether a trace that begins with these bytes may belong to the scene.
fn may_begin_trace(xml: &[u8], start: &[u8]) -> bool {
    let Ok(loaded) = scene::read("", xml) else { return false };
    let simulation = Simulation::new(&loaded.scene, RootSearch::OnDemand);
    let recorder = Recorder::start(Vec::new(), Layout::for_scene(&loaded.scene), simulation.state());
    recorder.finish().is_ok_and(|(record, _)| start.starts_with(&record))
}
