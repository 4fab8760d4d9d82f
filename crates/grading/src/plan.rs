//! A suite with its scenes looked up: what a grading really runs.
use super::{
    assignments,
    config::{self, BuildStep, Hints, Marking, Patience, RunLimits, Suite, SuiteError},
    library,
    task::SceneTask,
};
use fosssim_files::{open_file, read_limited, read_text};
use fosssim_judge::Rules;
use fosssim_model::scene;
use std::{collections::BTreeMap, io, path::Path};

/// A suite of more bytes is none.
pub const LARGEST_SUITE: u64 = 1 << 20;

/// The greatest number of scenes of a suite, and of bytes in all of them.
pub const MOST_SCENES: usize = 10_000;
/// See [`MOST_SCENES`].
pub const MOST_SCENE_BYTES: u64 = 256 << 20;

/// A suite ready to run.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Its name.
    pub name: String,
    /// The command line.
    pub run: Vec<String>,
    /// The rule books to ask.
    pub rules: Rules,
    /// How much a report tells.
    pub hints: Hints,
    /// Whether students see what their programs print even though some groups are not visible to them.
    pub show_output: bool,
    /// The build step.
    pub build: Option<BuildStep>,
    /// Limits of each run.
    pub limits: RunLimits,
    /// When the rest of a submission is not run any more.
    pub patience: Patience,
    /// The groups.
    pub groups: Vec<PlannedGroup>,
}

/// A group with its scenes.
#[derive(Debug, Clone)]
pub struct PlannedGroup {
    /// Its name.
    pub name: String,
    /// Its points, credit and visibility.
    pub marking: Marking,
    /// Its scenes, in the order of the patterns, each pattern's in alphabetical order.
    pub scenes: Vec<SceneTask>,
}

impl Plan {
    /// All scenes in order.
    pub fn scenes(&self) -> impl Iterator<Item = &SceneTask> {
        self.groups.iter().flat_map(|group| &group.scenes)
    }

    /// The part of the plan with the scenes that `takes` takes by name. Each keeps its points; groups without any are
    /// left out, and the name says that this is a part.
    #[must_use]
    pub fn part(mut self, takes: impl Fn(&str) -> bool) -> Self {
        let all = self.scenes().count();
        for group in &mut self.groups {
            let before = group.scenes.len();
            group.scenes.retain(|task| takes(&task.name));
            #[expect(clippy::cast_precision_loss, reason = "numbers of scenes are small")]
            if group.scenes.len() < before {
                group.marking.points *= group.scenes.len() as f64 / before as f64;
            }
        }
        self.groups.retain(|group| !group.scenes.is_empty());
        let left = self.scenes().count();
        if left < all {
            self.name = format!("{} ({left} of {all} scenes)", self.name);
        }
        self
    }

    /// Points that can be reached.
    #[must_use]
    pub fn max_points(&self) -> f64 {
        self.groups.iter().map(|group| group.marking.points).sum()
    }
}

/// The text of a built-in suite: of `t2m2@1`, for example, or of the newest version of `t2m2`.
#[must_use]
pub fn built_in(name: &str) -> Option<&'static str> {
    assignments::version(name).map(|(_, version)| version.suite)
}

/// The names of the built-in suites, each with its version, the newest one of the default assignment first.
pub fn built_in_names() -> impl Iterator<Item = String> {
    assignments::names()
}

/// The name of the suite that is meant where none is named.
#[must_use]
pub fn default_name() -> String {
    assignments::default_name()
}

/// Why there is no plan.
#[derive(Debug, thiserror::Error)]
pub enum FindError {
    /// No such suite.
    #[error("no suite {name}: it is neither a file nor one of {}", built_in_names().collect::<Vec<_>>().join(", "))]
    Unknown {
        /// The name that was asked for.
        name: String,
        /// Why it is no file.
        #[source]
        why: io::Error,
    },
    /// There is one, but it can't be read.
    #[error("cannot read the suite {name}")]
    Unreadable {
        /// The file.
        name: String,
        /// Why.
        #[source]
        why: io::Error,
    },
    /// There is one, but it is not sound; each problem is a line.
    #[error("the suite has {}{}", counted(.error.problems.len()), lines(name, .error))]
    Unsound {
        /// The file.
        name: String,
        /// The fault of it.
        error: SuiteError,
    },
}

fn counted(problems: usize) -> String {
    if problems == 1 { "1 problem:".to_owned() } else { format!("{problems} problems:") }
}

fn lines(name: &str, error: &SuiteError) -> String {
    error.problems.iter().map(|(at, text)| format!("\n{name}:{at}: {text}")).collect()
}

/// Finds a suite: one that comes with the program, by its name, or a file. Its own files are looked up beside it.
///
/// # Errors
/// When there is no such suite; otherwise everything that is wrong with it.
pub fn find(name: &str) -> Result<Plan, FindError> {
    let path = Path::new(name);
    let beside = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let loaded = match built_in(name) {
        Some(text) => load(text, Path::new(".")),
        None => {
            let name = name.to_owned();
            let text = read_text(path, LARGEST_SUITE).map_err(|why| match why.kind() {
                io::ErrorKind::NotFound => FindError::Unknown { name, why },
                _ => FindError::Unreadable { name, why },
            })?;
            load(&text, beside)
        }
    };
    loaded.map_err(|error| FindError::Unsound { name: name.to_owned(), error })
}

/// Looks up the scenes of a suite; files are relative to `folder`.
///
/// # Errors
/// Patterns that match nothing, scenes that can't be read or are not sound, each at the pattern's position.
pub fn resolve(suite: &Suite, folder: &Path) -> Result<Plan, SuiteError> {
    let mut problems = Vec::new();
    let mut seen = BTreeMap::new();
    let mut groups = Vec::new();
    let mut room = Room { scenes: MOST_SCENES, bytes: MOST_SCENE_BYTES };
    for group in &suite.groups {
        let mut scenes = Vec::new();
        for (pattern, &position) in group.scenes.iter().zip(&group.positions) {
            let found = match pattern.strip_prefix("asset:") {
                Some(pattern) => embedded(pattern),
                None => files(pattern, folder, &mut room),
            };
            match found {
                Ok(found) => {
                    for (name, xml) in found {
                        match seen.insert(name.clone(), group.name.clone()) {
                            Some(other) => {
                                problems.push((position, format!("scene {name} is in group \"{other}\" already")));
                            }
                            None => match scene::read(&name, &xml) {
                                Ok(loaded) => {
                                    // A file of an embedded scene's name has a recording only if it is that scene.
                                    let known = library::scene(&name).is_some_and(|embedded| embedded == xml);
                                    let recording = known.then(|| library::recording(&name)).flatten();
                                    scenes.push(SceneTask { name, xml, scene: loaded.scene, recording });
                                }
                                Err(error) => problems.push((position, format!("scene {name} is not sound:\n{error}"))),
                            },
                        }
                    }
                }
                Err(message) => problems.push((position, message)),
            }
        }
        let marking = Marking { points: group.points, credit: group.credit, visibility: group.visibility };
        groups.push(PlannedGroup { name: group.name.clone(), marking, scenes });
    }
    if !problems.is_empty() {
        return Err(SuiteError { problems });
    }
    Ok(Plan {
        name: suite.name.clone(),
        run: suite.run.clone(),
        rules: suite.rules,
        hints: suite.hints,
        show_output: suite.show_output,
        build: suite.build.clone(),
        limits: suite.limits,
        patience: suite.patience,
        groups,
    })
}

/// Reads, validates and looks up a suite in one go.
///
/// # Errors
/// As [`config::read`] and [`resolve`].
pub fn load(text: &str, folder: &Path) -> Result<Plan, SuiteError> {
    let (suite, mut problems) = config::read_all(text);
    // Patterns are looked up although something else is wrong: everything is told at once.
    let resolved = resolve(&suite, folder);
    if problems.is_empty() {
        return resolved;
    }
    problems.extend(resolved.err().into_iter().flat_map(|error| error.problems));
    problems.sort_by_key(|(at, _)| (at.line, at.column));
    Err(SuiteError { problems })
}

type Found = Vec<(String, Vec<u8>)>;

fn embedded(pattern: &str) -> Result<Found, String> {
    let glob = glob::Pattern::new(pattern).map_err(|error| format!("pattern asset:{pattern}: {error}"))?;
    let found: Found = library::names()
        .filter(|name| library::takes(&glob, name))
        .filter_map(|name| Some((name.to_owned(), library::scene(name)?.to_vec())))
        .collect();
    if found.is_empty() {
        return Err(format!("no embedded scene matches asset:{pattern}; `fosssim-oracle suite scenes` lists them"));
    }
    Ok(found)
}

/// The room that is left for a suite's files.
struct Room {
    scenes: usize,
    bytes: u64,
}

fn files(pattern: &str, folder: &Path, room: &mut Room) -> Result<Found, String> {
    let path = folder.join(pattern);
    let text = path.to_str().ok_or_else(|| format!("{}: the folder's name is not UTF-8", folder.display()))?;
    let paths = glob::glob(text).map_err(|error| format!("pattern {pattern}: {error}"))?;
    let mut found = Found::new();
    for path in paths {
        let path = path.map_err(|error| format!("{}: {}", error.path().display(), error.error()))?;
        let relative = path.strip_prefix(folder).unwrap_or(&path);
        let name = relative.with_extension("").to_string_lossy().into_owned();
        let xml = scene_file(&path)?;
        room.scenes = room.scenes.checked_sub(1).ok_or_else(|| {
            format!("pattern {pattern} takes the suite beyond {MOST_SCENES} scenes, which is the limit")
        })?;
        room.bytes = room.bytes.checked_sub(xml.len() as u64).ok_or_else(|| {
            format!("pattern {pattern} takes the suite's scenes beyond {MOST_SCENE_BYTES} bytes, which is the limit")
        })?;
        found.push((name, xml));
    }
    if found.is_empty() {
        return Err(format!("no scene file matches {pattern} (files are looked up beside the suite)"));
    }
    Ok(found)
}

/// The bytes of a scene: of a regular file, which nobody has to wait for.
fn scene_file(path: &Path) -> Result<Vec<u8>, String> {
    const LARGEST: u64 = scene::LARGEST_SCENE as u64;
    let (file, size) = open_file(path, true).map_err(|error| error.to_string())?;
    if size > LARGEST {
        return Err(format!("{} is too large for a scene ({size} bytes, the limit is {LARGEST})", path.display()));
    }
    let read = file.metadata().and_then(|metadata| read_limited(file, &metadata, LARGEST));
    read.map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_built_in_suite_finds_its_scenes() {
        for name in &built_in_names().collect::<Vec<_>>() {
            let plan = load(built_in(name).expect("its text"), Path::new("nowhere")).expect(name);
            let (assignment, version) = assignments::version(name).expect("a suite is an assignment's");
            assert!(plan.scenes().count() > 10, "{name}");
            assert!(plan.max_points() > 0.0);
            assert_eq!(plan.rules, Rules::Fair, "{name}");
            assert_eq!(plan.name, format!("{} ({name})", assignment.definition().title));
            let is_own = |name: &&str| library::assignment(name) == Some(assignment) && version.has(name);
            let own: BTreeSet<&str> = library::names().filter(is_own).collect();
            let planned: BTreeSet<&str> = plan.scenes().map(|task| task.name.as_str()).collect();
            assert_eq!(planned, own, "{name} grades what lies in its folder");
            let all = format!("schema = 1\nname = \"x\"\n[[group]]\nname = \"a\"\nscenes = [\"asset:{name}/*\"]\n");
            assert_eq!(load(&all, Path::new("nowhere")).expect(name).scenes().count(), own.len());
        }
        load(config::TEMPLATE, Path::new("nowhere")).expect("the template");
    }

    #[test]
    fn a_part_of_a_suite_keeps_each_scenes_worth_and_says_that_it_is_a_part() {
        let plan = || load(built_in("t2m2").expect("its text"), Path::new("nowhere")).expect("sound");
        let (whole, name) = (plan(), plan().scenes().nth(3).expect("a scene").name.clone());
        let part = plan().part(|scene| scene == name);
        let all = whole.scenes().count();
        assert_eq!((part.groups.len(), part.scenes().count()), (1, 1));
        let group = whole.groups.iter().find(|group| group.name == part.groups[0].name).expect("its group");
        #[expect(clippy::cast_precision_loss, reason = "numbers of scenes are small")]
        let worth = group.marking.points / group.scenes.len() as f64;
        assert!((part.max_points() - worth).abs() < 1e-12);
        assert_eq!(part.name, format!("{} (1 of {all} scenes)", whole.name));
        assert_eq!(plan().part(|_| true).name, whole.name);
    }

    #[test]
    fn files_of_a_suite_are_regular_and_limited() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["a.xml", "b.xml", "c.xml"] {
            std::fs::write(folder.path().join(name), "<scene/>").expect("written");
        }
        let found = |pattern: &str, scenes, bytes| {
            let found = files(pattern, folder.path(), &mut Room { scenes, bytes });
            found.map(|found| found.len())
        };
        assert_eq!(found("*.xml", 3, 24), Ok(3));
        assert!(found("*.xml", 2, 24).expect_err("one too many").contains("beyond 10000 scenes"));
        assert!(found("*.xml", 3, 23).expect_err("too large").contains("beyond 268435456 bytes"));
        std::fs::File::create(folder.path().join("hole")).expect("a file").set_len(1 << 40).expect("a hole");
        std::os::unix::fs::symlink("/dev/zero", folder.path().join("zero")).expect("a link");
        assert!(found("hole", 3, 24).expect_err("a hole").contains("too large for a scene"));
        assert!(found("zero", 3, 24).expect_err("a device").contains("a device"));
    }

    #[test]
    fn missing_and_doubled_scenes_are_told_at_their_patterns() {
        let text = "schema = 1\nname = \"x\"\n[[group]]\nname = \"a\"\nscenes = [\"asset:NoSuchTests/*\",\n \"no/*.xml\"]\n\
                    [[group]]\nname = \"b\"\nscenes = [\"asset:SimpleTests/*\", \"asset:SimpleTests/*\"]\n";
        let error = load(text, Path::new("nowhere")).expect_err("wrong").to_string();
        assert!(error.contains("5:11: no embedded scene matches asset:NoSuchTests/*"), "{error}");
        assert!(error.contains("6:2: no scene file matches no/*.xml"), "{error}");
        assert!(error.contains("9:34: scene SimpleTests/"), "{error}");
        assert!(error.contains("is in group \"b\" already"), "{error}");
        // Also where something else is wrong.
        let both = text.replacen("name = \"x\"", "name = \"x\"\nhint = \"what\"", 1);
        let error = load(&both, Path::new("nowhere")).expect_err("wrong").to_string();
        assert!(error.starts_with("3:1: unknown key `hint` in the suite: did you mean `hints`?\n6:11: no "), "{error}");
    }
}
