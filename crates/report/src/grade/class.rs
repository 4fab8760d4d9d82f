//! The statistics of a class: points, the hardest scenes, and the most frequent mistakes.
use super::{describe_likely, find_likely_mistakes, format_points, phrases::list_first, shorten_name};
use crate::untrusted_text::to_one_line;
use crate::{
    number::format_count,
    style::{Style, TextStyle},
    table::{Align, Table},
    words,
};
use fosssim_findings::{Grade, Verdict};
use fosssim_mistakes::diagnose::Explanation;
use std::{collections::BTreeMap, fmt::Write};

/// The number of submissions that were run on a scene, and the number of those that were accepted there.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct SceneShare {
    pub(crate) accepted: usize,
    pub(crate) run: usize,
}

/// Renders the report on the class. It lists at most `max_rows` scenes, mistakes, and names of submissions with the
/// same program.
pub fn render_class(grades: &[Grade], max_rows: usize, style: Style) -> String {
    let mut text = format!("{}: {}\n", style.paint(TextStyle::Strong, "Class"), render_head(grades));
    let (scenes, fully_accepted) = find_hardest(grades);
    if !scenes.is_empty() {
        let _ = writeln!(text, "{}", style.paint(TextStyle::Strong, "Scenes with the fewest correct answers"));
        let mut table = Table::new([Align::Right, Align::Right, Align::Left]);
        for (scene, share) in scenes.iter().take(max_rows) {
            let percent = 100.0 * share.accepted as f64 / share.run.max(1) as f64;
            table.add_row([
                format!("{} of {}", share.accepted, share.run).into(),
                format!("{percent:.0} %").into(),
                to_one_line(scene).into(),
            ]);
        }
        text += &table.render(style);
        if scenes.len() > max_rows {
            let _ = writeln!(text, "  and {}", format_count((scenes.len() - max_rows) as u64, "more scene"));
        }
        if fully_accepted > 0 {
            let _ = writeln!(text, "  {} accepted for all submissions", format_count(fully_accepted as u64, "scene"));
        }
    }
    let mistakes = find_frequent(grades);
    if !mistakes.is_empty() {
        let _ = writeln!(text, "{}", style.paint(TextStyle::Strong, "Most frequent mistakes"));
        let mut table = Table::new([Align::Right, Align::Left]);
        for SharedMistake { mistake, members } in mistakes.iter().take(max_rows) {
            let what = describe_likely(&grades[members[0]], mistake);
            table.add_row([format_count(members.len() as u64, "submission").into(), to_one_line(&what).into()]);
        }
        text += &table.render(style);
    }
    for (number, (change, members)) in group_by_change(grades).iter().enumerate() {
        if number == 0 {
            let _ = writeln!(text, "{}", style.paint(TextStyle::Strong, "Since the earlier grading"));
        }
        let _ = writeln!(text, "  {change}: {}", list_names(grades, members, max_rows));
    }
    let same = group_same_programs(grades);
    if !same.is_empty() {
        let _ = writeln!(text, "{}", style.paint(TextStyle::Strong, "Identical programs"));
        for members in &same {
            let _ = writeln!(text, "  {}", list_names(grades, members, max_rows));
        }
    }
    text
}

fn list_names(grades: &[Grade], members: &[usize], max_names: usize) -> String {
    let names: Vec<String> = members.iter().map(|&number| shorten_name(&grades[number].submission)).collect();
    list_first(&names, max_names)
}

/// Returns the kinds of changes since the earlier grading, each with its submissions as indices into `grades`. Kinds
/// without submissions are left out.
pub(crate) fn group_by_change(grades: &[Grade]) -> Vec<(&'static str, Vec<usize>)> {
    if grades.iter().all(|grade| grade.earlier_grade.is_none()) {
        return Vec::new();
    }
    let kind = |grade: &Grade| match (grade.points, grade.changes().map(|changes| changes.earlier_points)) {
        (_, None) => Some("new"),
        (Some(now), Some(Some(then))) if now > then => Some("more points"),
        (Some(now), Some(Some(then))) if now < then => Some("fewer points"),
        _ => None,
    };
    let kinds: Vec<_> = grades.iter().map(kind).collect();
    let members = |wanted| (0..grades.len()).filter(|&number| kinds[number] == Some(wanted)).collect();
    let all = ["more points", "fewer points", "new"].map(|change| (change, members(change)));
    all.into_iter().filter(|(_, members): &(_, Vec<usize>)| !members.is_empty()).collect()
}

/// Returns groups of submissions with the same program. The numbers are indices into `grades`.
pub(crate) fn group_same_programs(grades: &[Grade]) -> Vec<Vec<usize>> {
    let mut found: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (number, grade) in grades.iter().enumerate().filter(|(_, grade)| !grade.same_program.is_empty()) {
        found.entry(grade.program.as_deref().unwrap_or_default()).or_default().push(number);
    }
    let mut groups: Vec<Vec<usize>> = found.into_values().collect();
    groups.sort();
    groups
}

/// The statistics of a class. Those about points count only submissions that were run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct ClassFigures {
    pub(crate) submissions: usize,
    /// The number of submissions that were run on at least one scene.
    pub(crate) run_submissions: usize,
    pub(crate) accepted: usize,
    /// The number of submissions that were run but have no points.
    pub(crate) without_points: usize,
    /// The mean, the median, the minimum and the maximum of the points.
    pub(crate) points: Option<[f64; 4]>,
    /// The maximum number of points of the suite.
    pub(crate) max_points: f64,
}

impl ClassFigures {
    pub(crate) fn from_grades(grades: &[Grade]) -> Self {
        let judged = || grades.iter().filter(|grade| !has_never_run(grade));
        let mut reached: Vec<f64> = judged().filter_map(|grade| grade.points).collect();
        reached.sort_by(f64::total_cmp);
        #[expect(clippy::cast_precision_loss, reason = "classes are small")]
        let mean = reached.iter().sum::<f64>() / reached.len() as f64;
        let middle = || f64::midpoint(reached[(reached.len() - 1) / 2], reached[reached.len() / 2]);
        let points = match &reached[..] {
            [] => None,
            [lowest, .., highest] => Some([mean, middle(), *lowest, *highest]),
            [one] => Some([*one; 4]),
        };
        Self {
            submissions: grades.len(),
            run_submissions: judged().count(),
            accepted: grades.iter().filter(|grade| grade.verdict.is_accepted()).count(),
            without_points: judged().count() - reached.len(),
            points,
            max_points: grades.first().map_or(0.0, |grade| grade.max_points),
        }
    }
}

/// Describes the class in one line, such as `30 submissions, 28 ran, 12 accepted; of those that ran mean 63.2, median
/// 71, from 0 to 100 of 100 points`.
fn render_head(grades: &[Grade]) -> String {
    let figures = ClassFigures::from_grades(grades);
    let all = format_count(figures.submissions as u64, "submission");
    let mut text = format!("{all}, {} ran, {} accepted", figures.run_submissions, figures.accepted);
    if let Some(reached) = figures.points {
        let ([mean, middle, lowest, highest], max_points) =
            (reached.map(format_points), format_points(figures.max_points));
        let _ = write!(
            text,
            "; of those that ran mean {mean}, median {middle}, from {lowest} to {highest} of {max_points} points"
        );
    }
    if figures.without_points > 0 {
        let _ = write!(text, "; {} without points", figures.without_points);
    }
    text
}

/// Returns whether the submission was run on no scene, because it has no program or could not be built.
pub(crate) fn has_never_run(grade: &Grade) -> bool {
    grade.scenes().all(|scene| matches!(scene.verdict, Verdict::NotRun | Verdict::Unusable | Verdict::CompileError))
}

/// Returns the scenes on which not all submissions are right, the hardest first, and the number of scenes on which all
/// are right. Submissions that were never run are not counted. Scenes that were not run, or on which the grader failed,
/// are not counted either.
pub(crate) fn find_hardest(grades: &[Grade]) -> (Vec<(&str, SceneShare)>, usize) {
    let mut shares: BTreeMap<&str, SceneShare> = BTreeMap::new();
    let mut order = Vec::new();
    for scene in grades.iter().filter(|grade| !has_never_run(grade)).flat_map(Grade::scenes) {
        let share = shares.entry(&scene.scene).or_insert_with(|| {
            order.push(scene.scene.as_str());
            SceneShare::default()
        });
        if !matches!(scene.verdict, Verdict::NotRun | Verdict::JudgeError) {
            share.run += 1;
            share.accepted += usize::from(scene.verdict.is_accepted());
        }
    }
    let judged = order.into_iter().map(|scene| (scene, shares[scene])).filter(|(_, share)| share.run > 0);
    let (fully_accepted, mut wrong): (Vec<_>, Vec<_>) = judged.partition(|(_, share)| share.accepted == share.run);
    // Shares are compared as fractions. The sort is stable, so that equal shares stay in the suite's order.
    wrong.sort_by(|(_, a), (_, b)| (a.accepted * b.run).cmp(&(b.accepted * a.run)));
    (wrong, fully_accepted.len())
}

/// A likely mistake, and the submissions that make it, as indices into the grades.
pub(crate) struct SharedMistake {
    pub(crate) mistake: Explanation,
    pub(crate) members: Vec<usize>,
}

/// Returns the likely mistakes, the most frequent first. Each is listed with the submissions that make it, and says
/// only what is true of all of them: each unwritten stage is an entry, and polynomials that nothing explains are left
/// out, because they may be wrong for different reasons.
pub(crate) fn find_frequent(grades: &[Grade]) -> Vec<SharedMistake> {
    let mut found: BTreeMap<String, SharedMistake> = BTreeMap::new();
    for (number, grade) in grades.iter().enumerate() {
        let likely = find_likely_mistakes(grade).into_iter().map(|(mistake, _)| mistake);
        for mistake in likely.filter(|mistake| !mistake.is_unexplained()).flat_map(split_stages) {
            let new = || SharedMistake { mistake: mistake.clone(), members: Vec::new() };
            let members = &mut found.entry(words::explanation::describe(&mistake)).or_insert_with(new).members;
            if members.last() != Some(&number) {
                members.push(number);
            }
        }
    }
    let mut sorted: Vec<_> = found.into_values().collect();
    sorted.sort_by_key(|cluster| std::cmp::Reverse(cluster.members.len()));
    sorted
}

/// Returns one explanation for each stage that a mistake names as unwritten; any other mistake stays as it is.
fn split_stages(mistake: Explanation) -> Vec<Explanation> {
    if !mistake.is_unfinished() {
        return vec![mistake];
    }
    let stages = mistake.same_as.iter().cloned();
    stages.map(|stage| Explanation { same_as: vec![stage], ..mistake.clone() }).collect()
}

#[cfg(test)]
mod tests {
    use super::{
        super::{csv_of_submissions, samples},
        *,
    };
    use crate::{
        formats::Format,
        page::{Audience, GradePage},
    };

    #[test]
    fn a_class_is_summed_up() {
        let grades =
            [samples::accepted_grade(), samples::failing_grade(), samples::failed_grade(), samples::stopped_grade()];
        insta::assert_snapshot!(render_class(&grades, 3, Style::Plain));
        assert!(render_class(&grades, usize::MAX, Style::Plain).contains("Rest/SV"), "the whole list");
    }

    #[test]
    fn a_shared_mistake_is_true_of_all_who_make_it() {
        let grade = |stages: &[&str]| {
            let mut grade = samples::failing_grade();
            let of_scene = |key: &&str| Explanation {
                reproduced: 5,
                samples: 5,
                ..Explanation::with_topic(*key, fosssim_findings::explanation::ExplanationTopic::Mistake)
            };
            let scene = grade.groups[0].scenes[0].clone();
            grade.groups[0].scenes = vec![scene; stages.len()];
            for (scene, key) in grade.groups[0].scenes.iter_mut().zip(stages) {
                scene.result.explanations = vec![of_scene(key)];
            }
            grade
        };
        let grades = [grade(&["pp-empty", "ph-empty"]), grade(&["ph-empty", "loop-empty-succeeds"])];
        let report = render_class(&grades, 9, Style::Plain);
        let mistakes = report.split_once("Most frequent mistakes\n").expect("a list").1;
        let first = "  2 submissions   Not written yet: particle-half-plane detection (it logs nothing).\n";
        assert!(mistakes.starts_with(first) && mistakes.lines().count() == 3, "{report}");
    }

    #[test]
    fn staff_sees_which_submissions_have_the_same_program_and_students_do_not() {
        let with = |name: &str, program: &str, same: &[&str]| Grade {
            submission: name.to_owned(),
            program: Some(program.to_owned()),
            same_program: same.iter().map(|name| (*name).to_owned()).collect(),
            ..samples::accepted_grade()
        };
        let grades = [with("zoe", "1", &["kim"]), with("ann", "2", &[]), with("kim", "1", &["zoe"])];
        assert!(render_class(&grades, 3, Style::Plain).ends_with("Identical programs\n  zoe, kim\n"));
        let shown = |reader| {
            let visible: Vec<Grade> =
                grades.iter().map(|grade| Format::Json.visible_part(grade, reader, false).into_owned()).collect();
            let page = GradePage { grade: &grades[0], card: &|_| None, class: None, reader }.html();
            let table = csv_of_submissions(&visible, &[]).contains(",kim,");
            (Format::Json.render(&visible).contains("same_program"), page.contains("kim"), table)
        };
        assert_eq!(shown(Audience::Staff), (true, true, true));
        assert_eq!(shown(Audience::Student), (false, false, false));
    }

    #[test]
    fn scenes_without_a_verdict_are_not_failures() {
        let grades = [samples::failed_grade(), samples::stopped_grade()];
        assert_eq!(find_hardest(&grades), (Vec::new(), 1));
        assert_eq!(
            find_hardest(&[samples::failing_grade(), samples::unusable_grade()]),
            find_hardest(&[samples::failing_grade()])
        );
    }
}
