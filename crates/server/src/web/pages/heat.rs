//! Students by scenes.
use crate::access::{AttemptChange, FailedScenes, Standing};
use std::{cmp::Reverse, collections::BTreeMap, fmt::Write};

/// The greatest number of scenes that are named in a sentence.
const NAMED: usize = 3;

/// The scenes that students on a page have wrong.
#[derive(Default)]
pub(super) struct Heat {
    /// Scenes that somebody has wrong, and those who have, most of them first.
    pub(super) scenes: Vec<(String, Vec<String>)>,
    /// A row for each student: markup.
    strips: BTreeMap<String, String>,
}

impl Heat {
    /// Of the results that count, where their scenes are known.
    pub(super) fn of(standings: &[Standing], failed: &BTreeMap<i64, FailedScenes>) -> Self {
        let known = |standing: &Standing| {
            let grade = standing.counts.as_ref()?.grade.as_ref()?;
            Some((standing.login.clone(), failed.get(&grade.result)?))
        };
        let rows: Vec<(String, &FailedScenes)> = standings.iter().filter_map(known).collect();
        let mut logins: BTreeMap<&str, Vec<String>> = BTreeMap::new();
        for (login, failed) in &rows {
            for scene in failed.keys() {
                logins.entry(scene).or_default().push(login.clone());
            }
        }
        let mut scenes: Vec<(&str, Vec<String>)> = logins.into_iter().collect();
        scenes.sort_by_key(|(_, logins)| Reverse(logins.len()));
        let names: Vec<&str> = scenes.iter().map(|(scene, _)| *scene).collect();
        let strips = rows.iter().map(|(login, failed)| (login.clone(), strip(&names, failed))).collect();
        Self { scenes: scenes.into_iter().map(|(scene, logins)| (scene.to_owned(), logins)).collect(), strips }
    }

    /// The row of a student; empty where nothing is known.
    pub(super) fn strip(&self, login: &str) -> &str {
        self.strips.get(login).map_or("", String::as_str)
    }
}

/// A row of scenes, in which those that a result does not accept are drawn.
fn strip(names: &[&str], failed: &FailedScenes) -> String {
    let mut out = format!(
        "<svg viewBox=\"0 0 {} 1\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{}\">",
        names.len().max(1),
        match failed.len() {
            0 => "no scene is wrong".to_owned(),
            1 => "one scene is wrong".to_owned(),
            count => format!("{count} scenes are wrong"),
        }
    );
    for class in ["h-w", "h-e", "h-n"] {
        let mut path = String::new();
        for (place, name) in names.iter().enumerate() {
            if failed.get(*name).is_some_and(|code| class_of(code) == class) {
                let _ = write!(path, "M{place} .5h1");
            }
        }
        if !path.is_empty() {
            let _ = write!(out, "<path class=\"{class}\" d=\"{path}\"/>");
        }
    }
    out + "</svg>"
}

/// How a verdict is drawn: wrong, not run, or failed.
fn class_of(code: &str) -> &'static str {
    match code {
        "WA" | "NW" => "h-w",
        "--" => "h-n",
        _ => "h-e",
    }
}

/// The change that an attempt has made, in a sentence.
pub(super) fn change(change: &AttemptChange) -> String {
    let list = |scenes: &[String]| {
        let more = scenes.len().saturating_sub(NAMED);
        let named = scenes[..scenes.len() - more].join(", ");
        if more > 0 { format!("{named} and {more} more") } else { named }
    };
    let since = format!("Since submission {}", change.since);
    match (&change.right[..], &change.wrong[..]) {
        ([], []) => format!("{since} no scene became right, and none wrong."),
        (right, []) => format!("{since} became right: {}.", list(right)),
        ([], wrong) => format!("{since} no longer right: {}.", list(wrong)),
        (right, wrong) => format!("{since} became right: {}. No longer right: {}.", list(right), list(wrong)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_shows_each_kind_of_failure_in_its_place() {
        let failed: FailedScenes =
            [("b", "WA"), ("c", "TLE"), ("d", "--")].map(|(scene, code)| (scene.to_owned(), code.to_owned())).into();
        let strip = strip(&["a", "b", "c", "d"], &failed);
        for part in
            ["0 0 4 1", "3 scenes are wrong", "h-w\" d=\"M1 .5h1\"", "h-e\" d=\"M2 .5h1\"", "h-n\" d=\"M3 .5h1\""]
        {
            assert!(strip.contains(part), "{strip}");
        }
    }

    #[test]
    fn a_change_names_few_scenes() {
        let names = |count: usize| (0..count).map(|number| format!("s{number}")).collect::<Vec<_>>();
        let of = |right, wrong| change(&AttemptChange { since: 2, right: names(right), wrong: names(wrong) });
        assert_eq!(of(0, 0), "Since submission 2 no scene became right, and none wrong.");
        assert_eq!(of(1, 1), "Since submission 2 became right: s0. No longer right: s0.");
        assert_eq!(of(0, 8), "Since submission 2 no longer right: s0, s1, s2 and 5 more.");
    }
}
