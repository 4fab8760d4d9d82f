//! The parts of grading that depend on an assignment: the versions of its suite, and the template of suites. Each
//! assignment has a folder.
use super::suggestions;
use fosssim_model::assignments::{Assignment, Definition};

#[path = "t2m3/timing.rs"]
mod timing;

pub use timing::{GeneratedScene, TIMING_SCENES};

/// The beginning of the suite template, before its groups. It contains the settings, with comments.
const SETTINGS_TEMPLATE: &str = include_str!("settings.toml");

/// Returns a suite file with comments, as a starting point. It has the settings of the template, and the groups of the
/// built-in suite `name`. Returns `None` if there is no such suite.
pub fn suite_template(name: &str) -> Option<String> {
    let (assignment, SuiteVersion { suite, .. }) = find_version(name)?;
    let groups = suite.split_once("rules = \"fair\"\n")?.1.trim_start();
    let Definition { key, title, .. } = assignment.definition();
    Some(SETTINGS_TEMPLATE.replace("TITLE", title).replace("MILESTONE", key) + groups)
}

/// A version of an assignment's suite. A published version never changes. Additional scenes would change the points of
/// all scenes, so they need a new version.
#[derive(Debug, Clone, Copy)]
pub struct SuiteVersion {
    /// The text of the version's suite file.
    pub suite: &'static str,
    /// The names of the version's scenes, one per line; `None` if it has all scenes in the assignment's folder.
    scenes: Option<&'static str>,
}

impl SuiteVersion {
    /// Returns whether the version contains a scene of its assignment.
    pub fn has_scene(&self, scene: &str) -> bool {
        self.scenes.is_none_or(|scenes| scenes.lines().any(|line| line == scene))
    }
}

/// The suite for the milestones before t2m2. Existing servers and courses may still use its name.
const EARLIER_VERSION: SuiteVersion = SuiteVersion { suite: include_str!("earlier/suite.toml"), scenes: None };

/// Includes the versions from an assignment's folder: the files of the published ones, and then of the newest.
macro_rules! include_versions {
    ($key:literal, $($published:literal)+, $newest:literal) => {
        [
            $(SuiteVersion {
                suite: include_str!(concat!($key, "/suite-", $published, ".toml")),
                scenes: Some(include_str!(concat!($key, "/version-", $published, ".txt"))),
            },)+
            SuiteVersion {
                suite: include_str!(concat!($key, "/suite.toml")),
                scenes: Some(include_str!(concat!($key, "/version-", $newest, ".txt"))),
            },
        ]
    };
}

/// Returns the versions of an assignment's suite, the oldest first.
pub const fn versions(assignment: Assignment) -> &'static [SuiteVersion] {
    match assignment {
        Assignment::T1M1 => &include_versions!("t1m1", 1, 2),
        Assignment::T1M2 => &include_versions!("t1m2", 1, 2),
        Assignment::T1M3 => &include_versions!("t1m3", 1, 2),
        Assignment::T2M1 => &include_versions!("t2m1", 1 2, 3),
        Assignment::T2M2 => &include_versions!("t2m2", 1 2, 3),
        Assignment::T2M3 => &include_versions!("t2m3", 1, 2),
    }
}

/// Returns the assignment and the version to which a suite name refers. For example, `t2m2@1` is version 1, and `t2m2`
/// is the newest version. Case is ignored. Returns `None` for an unknown name.
pub fn find_version(name: &str) -> Option<(Assignment, SuiteVersion)> {
    if matches!(name, "earlier" | "earlier@1") {
        return Some((Assignment::T2M1, EARLIER_VERSION));
    }
    let (key, number) = name.split_once('@').map_or((name, None), |(key, number)| (key, Some(number)));
    let assignment = Assignment::from_key(&key.to_ascii_lowercase())?;
    let all = versions(assignment);
    let number = match number {
        Some(number) => all.iter().enumerate().position(|(index, _)| number == (index + 1).to_string())?,
        None => all.len().checked_sub(1)?,
    };
    Some((assignment, all[number]))
}

/// Returns the names of the built-in suites with their versions, such as `t2m2@3`. The newest version for the default
/// assignment comes first.
pub fn suite_names() -> impl Iterator<Item = String> {
    Assignment::list_default_first().into_iter().flat_map(|assignment| {
        (1..=versions(assignment).len()).rev().map(move |number| format!("{}@{number}", assignment.key()))
    })
}

/// Returns the end of a message about an unknown suite, which suggests similar names ([`suggestions::suggest`]).
pub fn suggest(name: &str) -> String {
    let suites: Vec<String> = suite_names().collect();
    suggestions::suggest(name, suites.iter().filter_map(|suites| suites.split('@').next()))
}

/// Returns the name of the default suite.
pub fn default_name() -> String {
    format!("{}@{}", Assignment::DEFAULT.key(), versions(Assignment::DEFAULT).len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{config, library};

    #[test]
    fn versions_are_named_and_the_newest_is_meant_without_a_number() {
        let all: Vec<String> = suite_names().collect();
        let names = [
            "t2m2@3", "t2m2@2", "t2m2@1", "t1m1@2", "t1m1@1", "t1m2@2", "t1m2@1", "t1m3@2", "t1m3@1", "t2m1@3",
            "t2m1@2", "t2m1@1", "t2m3@2", "t2m3@1",
        ];
        assert_eq!(all, names);
        assert!(find_version("earlier@1").is_some() && find_version("earlier").is_some(), "the name is in use");
        assert_eq!(default_name(), all[0]);
        let suite = |name: &str| find_version(name).map(|(_, version)| version.suite);
        assert_eq!(suite("t2m2"), suite("t2m2@3"));
        assert_eq!((suite("T1M3"), suite("T2M2@1")), (suite("t1m3"), suite("t2m2@1")));
        assert_ne!(suite("t2m2@1"), suite("t2m2@2"));
        for unknown in ["t2m2@0", "t2m2@4", "t2m2@", "t2m2@01", "t9m9@1", "@1", ""] {
            assert!(suite(unknown).is_none(), "{unknown}");
        }
    }

    #[test]
    fn published_versions_have_their_scenes_still() {
        let published = [
            ("t1m1@1", 6),
            ("t1m2@1", 11),
            ("t1m3@1", 5),
            ("t2m1@1", 13),
            ("t2m1@2", 77),
            ("t2m2@1", 85),
            ("t2m2@2", 116),
            ("t2m3@1", 6),
        ];
        for (name, scenes) in published {
            let (assignment, first) = find_version(name).expect("a version");
            let listed: Vec<&str> = first.scenes.expect("a list").lines().collect();
            assert_eq!(listed.len(), scenes, "{name}");
            for scene in listed {
                assert_eq!(library::find_assignment(scene), Some(assignment), "{scene}");
            }
        }
    }

    #[test]
    fn a_template_has_the_groups_of_the_suite_that_it_is_made_from() {
        for name in suite_names() {
            let (template, suite) =
                (suite_template(&name).expect("a template"), find_version(&name).expect("a suite").1.suite);
            let [of_template, of_suite] = [&template, suite].map(|text| config::read(text).expect("a sound suite"));
            let marks = |suite: config::Suite| suite.groups.into_iter().map(|group| (group.name, group.marking));
            assert!(marks(of_template).eq(marks(of_suite)), "{template}");
        }
    }
}
