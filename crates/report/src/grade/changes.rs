//! Describes how a submission changed since an earlier grading.
use super::{format_points, phrases::list_first};
use crate::{number::format_count, style::TextStyle};
use fosssim_findings::{Grade, SceneGrade, Verdict, changes::GradeChanges};

/// The maximum number of scenes that one line names.
const MAX_NAMED: usize = 5;

/// Returns lines about the changes of points, and about the scenes with each kind of change. Each line has its style.
pub(crate) fn change_lines(grade: &Grade) -> Vec<(TextStyle, String)> {
    let Some(changes) = grade.changes() else { return Vec::new() };
    let name = |scene: &&SceneGrade| scene.scene.clone();
    let now = |scene: &&SceneGrade| format!("{} ({})", scene.scene, scene.verdict.code());
    let both = |(scene, then): &(&SceneGrade, Verdict)| {
        format!("{} ({}, was {})", scene.scene, scene.verdict.code(), then.code())
    };
    let GradeChanges { newly_right: right, newly_wrong: broke, other_changes: others, .. } = &changes;
    let kinds: [(TextStyle, &str, Vec<String>); 3] = [
        (TextStyle::Right, "became right", right.iter().map(name).collect()),
        (TextStyle::Wrong, "broke", broke.iter().map(now).collect()),
        (
            TextStyle::Notice,
            if others.len() == 1 { "fails otherwise" } else { "fail otherwise" },
            others.iter().map(both).collect(),
        ),
    ];
    let named = kinds.into_iter().filter(|(_, _, names)| !names.is_empty());
    let mut lines: Vec<(TextStyle, String)> = named
        .map(|(look, verb, names)| {
            (look, format!("{} {verb}: {}", format_count(names.len() as u64, "scene"), list_first(&names, MAX_NAMED)))
        })
        .collect();
    if lines.is_empty() {
        lines.push((TextStyle::Faint, "no scene changed".to_owned()));
    }
    // A grading that did not run all scenes gives no points.
    if let (Some(then), Some(now)) = (changes.earlier_points, grade.points) {
        let (then, now, compared) = (format_points(then), format_points(now), format_points(changes.compared_points));
        let of = if compared == format_points(grade.max_points) { String::new() } else { format!(" of {compared}") };
        lines.insert(0, (TextStyle::Strong, format!("{then}{of} points before, {now} now")));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::{super::samples, *};
    use fosssim_mistakes::together::immediate_grade;

    #[test]
    fn changes_of_hidden_groups_are_hidden_from_students() {
        let mut then = samples::accepted_grade();
        then.groups[1].points = Some(0.0);
        then.groups[1].scenes[0].result.verdict = Verdict::TimeLimit;
        let mut now = samples::accepted_grade();
        now.groups[0].points = Some(5.0);
        now.groups[0].scenes[0].result.verdict = Verdict::WrongAnswer;
        (now.points, now.earlier_grade) = (Some(15.0), Some((&then).into()));
        let words = |grade: &Grade| change_lines(grade).into_iter().map(|(_, line)| line).collect::<Vec<_>>();
        let expected =
            ["10 points before, 15 now", "1 scene became right: Impulses/a", "1 scene broke: Detection/a (WA)"];
        assert_eq!(words(&now), expected);
        assert_eq!(words(&immediate_grade(&now)), ["10 points before, 5 now", expected[2]]);
        now.points = None;
        assert_eq!(words(&now), expected[1..]);
    }
}
