//! The parts of grading that are bound to an assignment of the course: the versions of its suite, and the template of
//! suites. One folder each.
use fosssim_model::assignments::Assignment;

/// The commented suite to start from.
pub const TEMPLATE: &str = include_str!("t2m2/template.toml");

/// A version of an assignment's suite. More scenes change the points of all, so they make a new one; what is published
/// stays.
#[derive(Debug, Clone, Copy)]
pub struct Version {
    /// The suite, as a text.
    pub suite: &'static str,
    /// The names of its scenes, a line each; none for a version that has all that lie in the assignment's folder.
    scenes: Option<&'static str>,
}

impl Version {
    /// Whether a scene of the assignment belongs to it.
    #[must_use]
    pub fn has(&self, scene: &str) -> bool {
        self.scenes.is_none_or(|scenes| scenes.lines().any(|line| line == scene))
    }
}

/// The milestones before t2m2 in one suite, under the name by which servers and courses may know it.
const EARLIER: Version = Version { suite: include_str!("earlier/suite.toml"), scenes: None };

/// The versions of an assignment's suite: 1 comes first, the newest last.
#[must_use]
pub const fn versions(assignment: Assignment) -> &'static [Version] {
    match assignment {
        Assignment::T1M1 => &[Version { suite: include_str!("t1m1/suite.toml"), scenes: None }],
        Assignment::T1M2 => &[Version { suite: include_str!("t1m2/suite.toml"), scenes: None }],
        Assignment::T1M3 => &[Version { suite: include_str!("t1m3/suite.toml"), scenes: None }],
        Assignment::T2M1 => &[Version { suite: include_str!("t2m1/suite.toml"), scenes: None }],
        Assignment::T2M2 => &[
            Version { suite: include_str!("t2m2/suite-1.toml"), scenes: Some(include_str!("t2m2/version-1.txt")) },
            Version { suite: include_str!("t2m2/suite.toml"), scenes: Some(include_str!("t2m2/version-2.txt")) },
        ],
        Assignment::T2M3 => &[Version { suite: include_str!("t2m3/suite.toml"), scenes: None }],
    }
}

/// The assignment and the version that a name such as `t2m2@1` means; `t2m2` is the newest one.
#[must_use]
pub fn version(name: &str) -> Option<(Assignment, Version)> {
    if matches!(name, "earlier" | "earlier@1") {
        return Some((Assignment::T2M1, EARLIER));
    }
    let (key, number) = name.split_once('@').map_or((name, None), |(key, number)| (key, Some(number)));
    let assignment = Assignment::named(key)?;
    let all = versions(assignment);
    let number = match number {
        Some(number) => all.iter().enumerate().position(|(index, _)| number == (index + 1).to_string())?,
        None => all.len().checked_sub(1)?,
    };
    Some((assignment, all[number]))
}

/// The names of the built-in suites, each with its version, such as `t2m2@2`: the newest one of the default assignment
/// first.
pub fn names() -> impl Iterator<Item = String> {
    Assignment::ALL.into_iter().flat_map(|assignment| {
        (1..=versions(assignment).len()).rev().map(move |number| format!("{}@{number}", assignment.key()))
    })
}

/// The name of the suite that is meant where none is named.
#[must_use]
pub fn default_name() -> String {
    format!("{}@{}", Assignment::DEFAULT.key(), versions(Assignment::DEFAULT).len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library;

    #[test]
    fn versions_are_named_and_the_newest_is_meant_without_a_number() {
        let all: Vec<String> = names().collect();
        assert_eq!(all, ["t2m2@2", "t2m2@1", "t1m1@1", "t1m2@1", "t1m3@1", "t2m1@1", "t2m3@1"]);
        assert!(version("earlier@1").is_some() && version("earlier").is_some(), "the name is in use");
        assert_eq!(default_name(), all[0]);
        let suite = |name: &str| version(name).map(|(_, version)| version.suite);
        assert_eq!(suite("t2m2"), suite("t2m2@2"));
        assert_ne!(suite("t2m2@1"), suite("t2m2@2"));
        for unknown in ["t2m2@0", "t2m2@3", "t2m2@", "t2m2@01", "t9m9@1", "@1", ""] {
            assert!(suite(unknown).is_none(), "{unknown}");
        }
    }

    #[test]
    fn published_versions_have_their_scenes_still() {
        let (assignment, first) = version("t2m2@1").expect("a version");
        let scenes: Vec<&str> = first.scenes.expect("a list").lines().collect();
        assert_eq!(scenes.len(), 85);
        for scene in scenes {
            assert_eq!(library::assignment(scene), Some(assignment), "{scene}");
        }
    }
}
