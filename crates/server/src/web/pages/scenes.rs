//! Tables of scenes, and sentences about the wrong scenes of submissions.
use crate::domain::{AttemptChange, Standing, StoredResult};
use std::{cmp::Reverse, collections::BTreeMap};

/// The maximum number of scenes that a sentence names.
const MAX_NAMED: usize = 3;

/// Returns the wrong scenes of all results that count, the most frequent first. Each is listed with the logins of the
/// students for whom it is wrong.
pub(super) fn wrong_scenes(
    standings: &[Standing],
    stored_results: &BTreeMap<i64, StoredResult>,
) -> Vec<(String, Vec<String>)> {
    let mut logins: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for standing in standings {
        let grade = standing.counts.as_ref().and_then(|counts| counts.grade.as_ref());
        let grade = grade.filter(|grade| grade.outcome.has_run());
        for scene in grade
            .and_then(|grade| stored_results.get(&grade.result))
            .into_iter()
            .flat_map(|result| result.failed.keys())
        {
            logins.entry(scene).or_default().push(standing.login.clone());
        }
    }
    let mut scenes: Vec<_> = logins.into_iter().map(|(scene, logins)| (scene.to_owned(), logins)).collect();
    scenes.sort_by_key(|(_, logins)| Reverse(logins.len()));
    scenes
}

/// Describes the scenes that changed from one attempt to the next.
pub(super) fn describe_change(change: &AttemptChange) -> String {
    let list = |scenes: &[String]| {
        let more = scenes.len().saturating_sub(MAX_NAMED);
        let named_scenes = scenes[..scenes.len() - more].join(", ");
        if more > 0 { format!("{named_scenes} and {more} more") } else { named_scenes }
    };
    let since = format!("Since submission {},", change.since);
    match (&change.newly_right[..], &change.newly_wrong[..]) {
        ([], []) => format!("{since} no scene became right, and none wrong."),
        (right, []) if right.len() > MAX_NAMED => format!("{since} {} scenes became right.", right.len()),
        (right, []) => format!("{since} these became right: {}.", list(right)),
        ([], [_, ..]) if change.is_all_wrong => format!("{since} no scene is right any more."),
        ([], wrong) => format!("{since} no longer right: {}.", list(wrong)),
        (right, wrong) => format!("{since} these became right: {}. No longer right: {}.", list(right), list(wrong)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_names_few_scenes() {
        let names = |count: usize| (0..count).map(|number| format!("s{number}")).collect::<Vec<_>>();
        let change = |right, wrong| AttemptChange {
            since: 2,
            newly_right: names(right),
            newly_wrong: names(wrong),
            is_all_wrong: false,
        };
        let describe = |right, wrong| describe_change(&change(right, wrong));
        assert_eq!(describe(0, 0), "Since submission 2, no scene became right, and none wrong.");
        assert_eq!(describe(1, 1), "Since submission 2, these became right: s0. No longer right: s0.");
        assert_eq!(describe(110, 0), "Since submission 2, 110 scenes became right.");
        assert_eq!(describe(0, 8), "Since submission 2, no longer right: s0, s1, s2 and 5 more.");
        let none = AttemptChange { is_all_wrong: true, ..change(0, 8) };
        assert_eq!(describe_change(&none), "Since submission 2, no scene is right any more.");
    }
}
