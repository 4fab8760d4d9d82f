//! A suite whose scenes have been found, so that it can be run.
pub use super::assignments::{default_name, suggest, suite_names as built_in_names};
use super::{
    assignments,
    config::{self, Group, Hints, Marking, Pattern, Position, Suite, SuiteError},
    library,
    task::SceneTask,
};
use fosssim_model::{assignments::Assignment, scene};
use std::collections::BTreeMap;

#[cfg(target_os = "linux")]
mod suite_files;
#[cfg(target_os = "linux")]
pub use suite_files::{FindError, MAX_SCENE_BYTES, MAX_SCENES, MAX_SUITE_BYTES, find_suite, load_suite};

/// A suite whose scenes have been found.
pub type Plan = Suite<SceneTask>;

/// A group of a suite whose scenes have been found.
pub type PlannedGroup = Group<SceneTask>;

impl Plan {
    /// Returns all scenes, in the order of the suite.
    pub fn scenes(&self) -> impl Iterator<Item = &SceneTask> {
        self.groups.iter().flat_map(|group| &group.scenes)
    }

    /// Returns a plan that contains only the scenes whose names `takes` selects. Each scene keeps its points. Empty
    /// groups are removed, and the plan's name says that it is only a part.
    #[must_use]
    pub fn filter_scenes(mut self, takes: impl Fn(&str) -> bool) -> Self {
        let scene_count = self.scenes().count();
        for group in &mut self.groups {
            let count_before = group.scenes.len();
            group.scenes.retain(|task| takes(&task.name));
            #[expect(clippy::cast_precision_loss, reason = "numbers of scenes are small")]
            if group.scenes.len() < count_before {
                // Speed gives points only if all scenes of the group are accepted, so it gives none here.
                group.marking.speed = None;
                group.marking.points *= group.scenes.len() as f64 / count_before as f64;
            }
        }
        self.groups.retain(|group| !group.scenes.is_empty());
        let kept_count = self.scenes().count();
        if kept_count < scene_count {
            self.name = format!("{} ({kept_count} of {scene_count} scenes)", self.name);
        }
        self
    }

    /// Returns the level of detail for students about a scene.
    pub fn student_hints(&self, scene: &str) -> Hints {
        let group = self.groups.iter().find(|group| group.scenes.iter().any(|task| task.name == scene));
        group.map_or(Hints::None, |group| group.marking.hints)
    }

    /// Limits the level of detail for all readers to `hints`.
    pub fn limit_hints(&mut self, hints: Hints) {
        self.staff_hints = hints;
        self.set_student_hints(hints);
    }

    /// Sets the level of detail for students in all groups.
    pub fn set_student_hints(&mut self, hints: Hints) {
        self.groups.iter_mut().for_each(|group| group.marking.hints = hints);
    }

    /// Returns the milestone whose programs the suite grades. If the file does not name it, this is the milestone whose
    /// programs can run the most scenes, or the first of several such milestones.
    pub fn assignment(&self) -> Assignment {
        let count_runnable_scenes = |assignment: &Assignment| {
            self.scenes().filter(|task| task.scene.unknown_features(*assignment).next().is_none()).count()
        };
        // If several values are equal, `max_by_key` returns the last one.
        let by_scenes = || Assignment::ALL.into_iter().rev().max_by_key(count_runnable_scenes);
        self.milestone.or_else(by_scenes).unwrap_or(Assignment::DEFAULT)
    }

    /// Returns the points that the suite is worth, without extra points.
    pub fn max_points(&self) -> f64 {
        let speed_points = |marking: &Marking| marking.speed.map_or(0.0, |speed| speed.points);
        let markings = self.groups.iter().map(|group| &group.marking).filter(|marking| !marking.is_extra);
        markings.map(|marking| marking.points + speed_points(marking)).sum()
    }
}

/// Returns the text of a built-in suite; `None` if there is no such suite. For example, `t2m2@1` is version 1, and
/// `t2m2` is the newest version.
pub fn find_built_in_suite(name: &str) -> Option<&'static str> {
    assignments::find_version(name).map(|(_, version)| version.suite)
}

/// The name and the file content of each scene that a pattern matches.
pub type MatchingScenes = Vec<(String, Vec<u8>)>;

/// Finds the scenes of a suite. `files` finds those for patterns that name files. If a pattern matches nothing, or a
/// scene can't be read or is invalid, this is reported at the position of the pattern.
fn resolve(
    suite: Suite,
    files: &mut dyn FnMut(&str) -> Result<MatchingScenes, String>,
    problems: &mut Vec<(Position, String)>,
) -> Plan {
    let Suite {
        name,
        milestone,
        command,
        rules,
        staff_hints,
        show_output,
        build,
        limits,
        skip_limits,
        notes,
        groups: patterns,
    } = suite;
    let mut seen_scenes = BTreeMap::new();
    let mut groups = Vec::new();
    for group in patterns {
        let mut scenes = Vec::new();
        for Pattern { text, position: at } in group.scenes {
            let found = match text.strip_prefix("asset:") {
                Some(pattern) => find_embedded(pattern),
                None => files(&text),
            };
            let found = found.unwrap_or_else(|message| {
                problems.push((at, message));
                Vec::new()
            });
            for (name, xml) in found {
                if let Some(other) = seen_scenes.insert(name.clone(), group.name.clone()) {
                    problems.push((at, format!("scene {name} is already in group \"{other}\"")));
                    continue;
                }
                match scene::read(&name, &xml) {
                    Ok(loaded) => {
                        // If a file has the name of an embedded scene, the recording of that scene is used only if
                        // their contents are the same.
                        let is_unchanged = library::find_scene(&name).is_some_and(|embedded| embedded == xml);
                        let recording = is_unchanged.then(|| library::recording(&name)).flatten();
                        let beyond = milestone.filter(|_| !is_unchanged).into_iter();
                        for unknown in beyond.flat_map(|milestone| loaded.scene.unknown_features(milestone)) {
                            problems.push((at, format!("scene {name}: {unknown}")));
                        }
                        scenes.push(SceneTask { name, xml, scene: loaded.scene, recording });
                    }
                    Err(error) => problems.push((at, format!("scene {name} is not valid:\n{error}"))),
                }
            }
        }
        groups.push(Group { name: group.name, marking: group.marking, note: group.note, scenes });
    }
    Suite { name, milestone, command, rules, staff_hints, show_output, build, limits, skip_limits, notes, groups }
}

/// Reads and validates a suite, and finds its scenes.
///
/// # Errors
///
/// Fails like [`config::read`]. Also fails if a pattern matches nothing, or if a scene can't be read or is invalid.
pub fn load_with(
    text: &str,
    files: &mut dyn FnMut(&str) -> Result<MatchingScenes, String>,
) -> Result<Plan, SuiteError> {
    let (suite, mut problems) = config::read_with_problems(text);
    // The search for scenes runs even if there are other errors, so that all errors are reported together.
    let plan = resolve(suite, files, &mut problems);
    if problems.is_empty() {
        return Ok(plan);
    }
    problems.sort_by_key(|(at, _)| (at.line, at.column));
    Err(SuiteError { problems })
}

fn find_embedded(pattern: &str) -> Result<MatchingScenes, String> {
    let glob = glob::Pattern::new(pattern).map_err(|error| format!("pattern asset:{pattern}: {error}"))?;
    let found: MatchingScenes = library::all_names()
        .filter(|name| library::matches_pattern(&glob, name))
        .filter_map(|name| Some((name.to_owned(), library::find_scene(name)?.to_vec())))
        .collect();
    if found.is_empty() {
        return Err(format!("no embedded scene matches asset:{pattern}; `fosssim-oracle scene list` lists them"));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{collections::BTreeSet, path::Path};

    #[test]
    fn every_built_in_suite_finds_its_scenes() {
        for name in &built_in_names().collect::<Vec<_>>() {
            let plan = load_suite(find_built_in_suite(name).expect("its text"), Path::new("nowhere")).expect(name);
            let (assignment, version) = assignments::find_version(name).expect("a suite is an assignment's");
            assert!(plan.scenes().count() > 4, "{name}");
            assert!(plan.max_points() > 0.0);
            assert_eq!(plan.rules, fosssim_judge::Rules::Fair, "{name}");
            assert_eq!(plan.name, format!("{} ({name})", assignment.definition().title));
            let is_own = |name: &&str| library::find_assignment(name) == Some(assignment) && version.has_scene(name);
            let own: BTreeSet<&str> = library::all_names().filter(is_own).collect();
            let planned: BTreeSet<&str> = plan.scenes().map(|task| task.name.as_str()).collect();
            assert_eq!(planned, own, "{name} grades what lies in its folder");
            let all = format!("schema = 1\nname = \"x\"\n[[group]]\nname = \"a\"\nscenes = [\"asset:{name}/*\"]\n");
            assert_eq!(load_suite(&all, Path::new("nowhere")).expect(name).scenes().count(), own.len());
        }
    }

    #[test]
    fn a_part_of_a_suite_keeps_each_scenes_worth_and_says_that_it_is_a_part() {
        let plan = || load_suite(find_built_in_suite("t2m2").expect("its text"), Path::new("nowhere")).expect("sound");
        let (whole_suite, name) = (plan(), plan().scenes().nth(3).expect("a scene").name.clone());
        let part = plan().filter_scenes(|scene| scene == name);
        let scene_count = whole_suite.scenes().count();
        assert_eq!((part.groups.len(), part.scenes().count()), (1, 1));
        let group = whole_suite.groups.iter().find(|group| group.name == part.groups[0].name).expect("its group");
        #[expect(clippy::cast_precision_loss, reason = "numbers of scenes are small")]
        let worth = group.marking.points / group.scenes.len() as f64;
        assert!((part.max_points() - worth).abs() < 1e-12);
        assert_eq!(part.name, format!("{} (1 of {scene_count} scenes)", whole_suite.name));
        assert_eq!(plan().filter_scenes(|_| true).name, whole_suite.name);
    }

    #[test]
    fn missing_and_repeated_scenes_are_reported_at_their_patterns() {
        let text = "schema = 1\nname = \"x\"\n[[group]]\nname = \"a\"\nscenes = [\"asset:NoSuchTests/*\",\n \
                    \"no/*.xml\"]\n                    [[group]]\nname = \"b\"\n\
                    scenes = [\"asset:SimpleTests/*\", \"asset:SimpleTests/*\"]\n";
        let error = load_suite(text, Path::new("nowhere")).expect_err("wrong").to_string();
        assert!(error.contains("5:11: no embedded scene matches asset:NoSuchTests/*"), "{error}");
        assert!(error.contains("6:2: no scene file matches no/*.xml"), "{error}");
        assert!(error.contains("9:34: scene SimpleTests/"), "{error}");
        assert!(error.contains("is already in group \"b\""), "{error}");
        // The search for scenes runs even if another part is wrong.
        let both = text.replacen("name = \"x\"", "name = \"x\"\nhint = \"what\"", 1);
        let error = load_suite(&both, Path::new("nowhere")).expect_err("wrong").to_string();
        assert!(error.starts_with("3:1: unknown key `hint` in the suite: did you mean `hints`?\n6:11: no "), "{error}");
    }
}
