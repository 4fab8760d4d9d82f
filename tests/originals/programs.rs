//! Programs by other authors, linked to the course's starter libraries: right ones get all points of their milestone's
//! suite, wrong ones get fewer, and the drop-in prints the same as the original for their traces.
use fosssim_oracle::{
    assignments::Assignment::{self, T1M1, T1M2, T1M3, T2M1, T2M2, T2M3},
    suite::{library, plan},
};
use fosssim_testing::{Need, skip};
use rayon::prelude::*;
use serde_json::Value;
use std::{
    collections::BTreeMap,
    fs,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

use crate::{
    contest::timeless,
    oracle::Originals,
    workspace::{Workspace, finish},
};

/// The milestones whose programs are tested here.
const MILESTONES: [Assignment; 6] = [T1M1, T1M2, T1M3, T2M1, T2M2, T2M3];

/// Students' programs that the originals accept on every scene of the suite. All others have mistakes.
const RIGHT: [(Assignment, &str); 7] = [
    (T1M1, "real-a"),
    (T2M2, "real-f"),
    (T2M3, "real-a"),
    (T2M3, "real-b"),
    (T2M3, "real-c"),
    (T2M3, "real-h-x-69"),
    (T2M3, "real-h-x-f4"),
];

/// The contest's suite without its scenes for speed, because times do not matter here.
const CONTEST: &str = r#"
schema = 1
name = "right pairs"
milestone = "t2m3"
[[group]]
name = "right pairs"
scenes = ["asset:t2m3/NearPairTests/*"]
points = 100
"#;

/// The bytes of a program that contain the number of its variant.
const TAG: &[u8] = b"MUTTAG=000";

/// The programs of a milestone in a folder, and which of them are right.
struct Class {
    workspace: Workspace,
    milestone: Assignment,
    is_right: BTreeMap<String, bool>,
}

/// Reads one of the lists next to the programs.
fn list(programs: &Path, name: &str) -> Value {
    serde_json::from_slice(&fs::read(programs.join(name)).expect("a list")).expect("JSON")
}

impl Class {
    /// Unpacks the programs of a milestone, and writes all variants of them.
    fn unpack(programs: &Path, milestone: Assignment) -> Self {
        let workspace = Workspace::new();
        let key = milestone.key();
        let unpacked = finish(Command::new(programs.join("unpack")).arg(workspace.path("")).arg(key));
        assert_eq!(unpacked.code, Some(0), "{}", unpacked.shown());
        let mut is_right = BTreeMap::new();
        for entry in list(programs, "programs.json").as_array().expect("programs") {
            let (id, kind) = (entry["id"].as_str().expect("an id"), entry["kind"].as_str().expect("a kind"));
            if entry["milestone"] == key && kind != "mutants" {
                is_right.insert(id.to_owned(), kind == "right" || RIGHT.contains(&(milestone, id)));
            }
        }
        let mutants = workspace.path(key).join("mutants");
        if let Ok(program) = fs::read(&mutants) {
            let at = program.windows(TAG.len()).position(|bytes| bytes == TAG).expect("a number");
            let variants = list(programs, "mutants.json")[key].as_array().expect("variants").clone();
            let known = variants.iter().map(|one| (one["number"].as_u64().expect("a number"), one["kind"] == "right"));
            for (number, right) in std::iter::once((0, true)).chain(known) {
                let (name, mut variant) = (format!("variant-{number:03}"), program.clone());
                variant[at..at + TAG.len()].copy_from_slice(format!("MUTTAG={number:03}").as_bytes());
                let path = workspace.path(key).join(&name);
                fs::write(&path, variant).expect("written");
                fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("executable");
                is_right.insert(name, right);
            }
            fs::remove_file(mutants).expect("removed");
        }
        Self { workspace, milestone, is_right }
    }

    fn program(&self, name: &str) -> PathBuf {
        self.workspace.path(self.milestone.key()).join(name)
    }

    /// Grades all programs up to their first wrong scene, and returns those with unexpected points.
    fn misjudged(&self) -> Vec<String> {
        let key = self.milestone.key();
        self.workspace.write("contest.toml", CONTEST);
        let suite = if self.milestone == T2M3 { "contest.toml" } else { key };
        let run =
            self.workspace.run(["grade", key, "--suite", suite, "--fail-fast", "-q", "--format", "json=grades.json"]);
        assert!(matches!(run.code, Some(0 | 1)), "{}", run.shown());
        let report: Value = serde_json::from_slice(&self.workspace.read("grades.json")).expect("JSON");
        let grades = report["grades"].as_array().expect("grades");
        assert_eq!(grades.len(), self.is_right.len(), "each program has a grade");
        let misjudged = grades.iter().filter_map(|grade| {
            let name = grade["submission"].as_str().expect("a name");
            let (reached, most) = (&grade["points"], &grade["max_points"]);
            // Groups of extra points must be accepted, too.
            let mut groups = grade["groups"].as_array().expect("groups").iter();
            let is_right = reached == most && groups.all(|group| group["verdict"] == "accepted");
            (self.is_right[name] != is_right).then(|| format!("{key} {name}: {reached} of {most} points"))
        });
        misjudged.collect()
    }

    /// Runs a program on `scene.xml` in a workspace, where it may leave `trace.bin`.
    fn run(&self, name: &str, workspace: &Workspace) {
        let limits = "ulimit -t 2 -f 100000 -v 2000000; exec timeout 10 \"$0\" -s scene.xml -d 0 -o trace.bin";
        let mut program = Command::new("sh");
        program.args(["-c", limits]).arg(self.program(name)).current_dir(workspace.path(""));
        finish(program.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()));
    }

    /// Returns how the output of the drop-in and the original differ for a program's trace of a scene.
    fn differs(&self, originals: &Originals, name: &str, scene: &str) -> Option<String> {
        let workspace = Workspace::new();
        workspace.write("scene.xml", library::find_scene(scene).expect("a scene"));
        self.run(name, &workspace);
        if !workspace.exists("trace.bin") {
            return None;
        }
        let grade = ["-s", "scene.xml", "-d", "0", "-i", "trace.bin"];
        let theirs = originals.run(self.milestone, &workspace.path(""), grade);
        // If an original hangs or crashes, there is nothing to compare.
        let their_residuals = workspace.exists("residual.txt").then(|| workspace.read("residual.txt"))?;
        fs::remove_file(workspace.path("residual.txt")).expect("removed");
        let ours = workspace.original(grade);
        let our_residuals = workspace.exists("residual.txt").then(|| workspace.read("residual.txt"));
        // The output of a contest contains the times of steps.
        let says_the_same = match self.milestone {
            T2M3 => timeless(&theirs) == timeless(&ours),
            _ => theirs.stdout == ours.stdout,
        };
        let is_equal = says_the_same && Some(their_residuals) == our_residuals;
        (!is_equal).then(|| format!("{} {name} on {scene}:\n{}\n{}", self.milestone.key(), theirs.out(), ours.shown()))
    }
}

fn classes(originals: &Originals) -> Vec<Class> {
    let programs = originals.programs();
    MILESTONES.into_iter().map(|milestone| Class::unpack(&programs, milestone)).collect()
}

#[test]
fn right_programs_get_all_points_and_wrong_ones_less() {
    let Some(originals) = Originals::find() else { return };
    let doctor = Workspace::new().run(["doctor"]);
    if doctor.code != Some(0) {
        skip(Need::Sandbox, doctor.out().lines().last().unwrap_or_default());
        return;
    }
    let misjudged: Vec<String> = classes(&originals).iter().flat_map(Class::misjudged).collect();
    assert!(misjudged.is_empty(), "{misjudged:#?}");
}

/// A smallest scene is wrong for the same reason in a second run, and right for every correct program.
#[test]
fn smallest_scenes_show_what_they_were_made_for() {
    let Some(originals) = Originals::find() else { return };
    let doctor = Workspace::new().run(["doctor"]);
    if doctor.code != Some(0) {
        skip(Need::Sandbox, doctor.out().lines().last().unwrap_or_default());
        return;
    }
    for class in classes(&originals) {
        let (workspace, key) = (&class.workspace, class.milestone.key());
        let is_slip = |name: &str| name.starts_with("variant") || name.starts_with('w');
        let wrong = class.is_right.iter().filter(|(name, right)| is_slip(name) && !**right);
        for (name, _) in wrong.take(2) {
            let program = class.program(name).to_string_lossy().into_owned();
            let run = workspace.run(["shrink", &program, "--suite", key, "--format", "json", "--runs", "300"]);
            let report: Value = serde_json::from_slice(&run.stdout).expect("JSON");
            let small = &report["smallest"][0];
            let reason = small["explanations"][0]["key"].as_str().unwrap_or_else(|| panic!("{key} {name}: no cause"));
            workspace.write("scene.xml", small["scene"].as_str().expect("a scene"));
            class.run(name, workspace);
            // On this scene alone another mistake may have the same effect, and be named first.
            let again = workspace.run(["explain", "scene.xml", "trace.bin", "--format", "json"]);
            assert!(again.out().contains(&format!("\"{reason}\"")), "{key} {name}: {reason}\n{}", again.shown());
            let group = "[[group]]\nname = \"small\"\nscenes = [\"scene.xml\"]";
            let suite = format!("schema = 1\nname = \"small\"\nmilestone = \"{key}\"\n{group}\n");
            workspace.write("small.toml", suite);
            // The program's solver needs symmetric matrices: the original rejects it on other scenes
            // (docs/rules/states.md).
            let is_limited = |name: &str| (class.milestone, name) == (T1M3, "variant-105");
            let right = class.is_right.iter().filter(|(name, right)| **right && !is_limited(name));
            let right = right.map(|(name, _)| class.program(name).to_string_lossy().into_owned());
            let words = ["grade", "--suite", "small.toml", "--quiet", "--output", "out"].map(str::to_owned);
            let run = workspace.run(words.into_iter().chain(right));
            assert_eq!(run.code, Some(0), "{key} {name}: {}", run.shown());
        }
    }
}

/// Each program runs every twentieth scene of its suite, and the next program runs the scenes after those.
#[test]
fn the_drop_in_says_of_every_program_what_the_original_says() {
    const EVERY: usize = 20;
    let Some(originals) = Originals::find() else { return };
    let differing: Vec<String> = classes(&originals)
        .iter()
        .flat_map(|class| {
            let plan = plan::find_suite(class.milestone.key()).expect("a suite");
            let all = plan.scenes().map(|task| task.name.clone());
            let scenes: Vec<String> = all.filter(|name| !name.contains("TimingTests")).collect();
            let names: Vec<&String> = class.is_right.keys().collect();
            let chosen: Vec<(&String, &String)> = names
                .iter()
                .enumerate()
                .flat_map(|(number, name)| {
                    scenes.iter().skip(number % EVERY).step_by(EVERY).map(move |one| (*name, one))
                })
                .collect();
            let differing = chosen.par_iter().filter_map(|(name, scene)| class.differs(&originals, name, scene));
            differing.collect::<Vec<_>>()
        })
        .collect();
    assert!(differing.is_empty(), "{} differ:\n{}", differing.len(), differing.join("\n"));
}
