//! A class in numbers: how many points, which scenes few have right, which mistakes many make.
use super::{likely_mistakes, points, shortened};
use crate::foreign::one_line;
use crate::{
    number::counted,
    style::{Look, Style},
    table::{Align, Table},
    words,
};
use fosssim_findings::{Grade, Verdict};
use std::{collections::BTreeMap, fmt::Write};

/// How many submissions were run on a scene, and how many of these it was accepted for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct SceneShare {
    pub(crate) accepted: usize,
    pub(crate) run: usize,
}

/// Returns the class, with at most this number of scenes, mistakes and names of one program's submissions.
#[must_use]
pub fn class(grades: &[Grade], most: usize, style: Style) -> String {
    let mut text = format!("{}: {}\n", style.paint(Look::Strong, "Class"), head(grades));
    let (scenes, whole) = hardest(grades);
    if !scenes.is_empty() {
        let _ = writeln!(text, "{}", style.paint(Look::Strong, "Scenes that fewest have right"));
        let mut table = Table::new([Align::Right, Align::Right, Align::Left]);
        for (scene, share) in scenes.iter().take(most) {
            let percent = 100 * share.accepted / share.run.max(1);
            table.row([
                format!("{} of {}", share.accepted, share.run).into(),
                format!("{percent} %").into(),
                one_line(scene).into(),
            ]);
        }
        text += &table.render(style);
        if scenes.len() > most {
            let _ = writeln!(text, "  and {}", counted((scenes.len() - most) as u64, "more scene"));
        }
        if whole > 0 {
            let _ = writeln!(text, "  {} accepted for everybody", counted(whole as u64, "scene"));
        }
    }
    let mistakes = frequent(grades);
    if !mistakes.is_empty() {
        let _ = writeln!(text, "{}", style.paint(Look::Strong, "Most frequent mistakes"));
        let mut table = Table::new([Align::Right, Align::Left]);
        for (what, count) in mistakes.iter().take(most) {
            table.row([counted(*count as u64, "submission").into(), one_line(what).into()]);
        }
        text += &table.render(style);
    }
    let same = same_programs(grades);
    if !same.is_empty() {
        let _ = writeln!(text, "{}", style.paint(Look::Strong, "The same program, byte for byte"));
        for members in &same {
            let name = |&number: &usize| shortened(&one_line(&grades[number].submission));
            let names: Vec<String> = members.iter().take(most).map(name).collect();
            let more = members.len() - names.len();
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            let _ = writeln!(text, "  {}{more}", names.join(", "));
        }
    }
    text
}

/// Returns the numbers of the submissions that have the same program as others, each group once.
pub(crate) fn same_programs(grades: &[Grade]) -> Vec<Vec<usize>> {
    let mut found: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (number, grade) in grades.iter().enumerate().filter(|(_, grade)| !grade.same_program.is_empty()) {
        found.entry(grade.program.as_deref().unwrap_or_default()).or_default().push(number);
    }
    let mut groups: Vec<Vec<usize>> = found.into_values().collect();
    groups.sort();
    groups
}

/// Returns `30 submissions, 12 accepted; mean 63.2, median 71, from 0 to 100 of 100 points; 2 without points`.
fn head(grades: &[Grade]) -> String {
    let accepted = grades.iter().filter(|grade| grade.verdict.is_accepted()).count();
    let mut text = format!("{}, {accepted} accepted", counted(grades.len() as u64, "submission"));
    let mut reached: Vec<f64> = grades.iter().filter_map(|grade| grade.points).collect();
    reached.sort_by(f64::total_cmp);
    if let ([lowest, ..], [.., highest], Some(grade)) = (&reached[..], &reached[..], grades.first()) {
        #[expect(clippy::cast_precision_loss, reason = "classes are small")]
        let mean = reached.iter().sum::<f64>() / reached.len() as f64;
        let middle = f64::midpoint(reached[(reached.len() - 1) / 2], reached[reached.len() / 2]);
        let (mean, middle, lowest, highest) = (points(mean), points(middle), points(*lowest), points(*highest));
        let most = points(grade.max_points);
        let _ = write!(text, "; mean {mean}, median {middle}, from {lowest} to {highest} of {most} points");
    }
    let without = grades.len() - reached.len();
    if without > 0 {
        let _ = write!(text, "; {without} without points");
    }
    text
}

/// Returns the scenes that are not accepted for everybody, those that fewest have right first, and how many others
/// there are. A scene that was not run, or on which the grader failed, does not count.
pub(crate) fn hardest(grades: &[Grade]) -> (Vec<(&str, SceneShare)>, usize) {
    let mut shares: BTreeMap<&str, SceneShare> = BTreeMap::new();
    let mut order = Vec::new();
    for scene in grades.iter().flat_map(Grade::scenes) {
        let share = shares.entry(&scene.scene).or_insert_with(|| {
            order.push(scene.scene.as_str());
            SceneShare::default()
        });
        if !matches!(scene.verdict, Verdict::NotRun | Verdict::JudgeError) {
            share.run += 1;
            share.accepted += usize::from(scene.verdict.is_accepted());
        }
    }
    let known = order.into_iter().map(|scene| (scene, shares[scene])).filter(|(_, share)| share.run > 0);
    let (whole, mut wrong): (Vec<_>, Vec<_>) = known.partition(|(_, share)| share.accepted == share.run);
    // Shares compared as fractions; stable, so that equal ones stay in the suite's order.
    wrong.sort_by(|(_, a), (_, b)| (a.accepted * b.run).cmp(&(b.accepted * a.run)));
    (wrong, whole.len())
}

/// Returns the likely mistakes with the number of submissions that make them, the most frequent first.
fn frequent(grades: &[Grade]) -> Vec<(String, usize)> {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for (mistake, _) in grades.iter().flat_map(likely_mistakes) {
        *counts.entry(words::explanation::what_or(&mistake)).or_default() += 1;
    }
    let mut sorted: Vec<(String, usize)> = counts.into_iter().collect();
    sorted.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    sorted
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
        let grades = [samples::good(), samples::bad(), samples::fault(), samples::stopped()];
        insta::assert_snapshot!(class(&grades, 3, Style::Plain));
        assert!(class(&grades, usize::MAX, Style::Plain).contains("Rest/SV"), "the whole list");
    }

    #[test]
    fn staff_sees_which_submissions_have_the_same_program_and_students_do_not() {
        let with = |name: &str, program: &str, same: &[&str]| Grade {
            submission: name.to_owned(),
            program: Some(program.to_owned()),
            same_program: same.iter().map(|name| (*name).to_owned()).collect(),
            ..samples::good()
        };
        let grades = [with("zoe", "1", &["kim"]), with("ann", "2", &[]), with("kim", "1", &["zoe"])];
        assert!(class(&grades, 3, Style::Plain).ends_with("The same program, byte for byte\n  zoe, kim\n"));
        let shown = |reader| {
            let told: Vec<Grade> =
                grades.iter().map(|grade| Format::Json.told(grade, reader, false).into_owned()).collect();
            let page = GradePage { grade: &grades[0], card: &|_| None, class: None, reader }.html();
            let table = csv_of_submissions(&told, &[]).contains(",kim,");
            (Format::Json.render(&told).contains("same_program"), page.contains("kim"), table)
        };
        assert_eq!(shown(Audience::Staff), (true, true, true));
        assert_eq!(shown(Audience::Student), (false, false, false));
    }

    #[test]
    fn what_was_not_run_or_not_judged_is_no_failure_of_a_scene() {
        let grades = [samples::fault(), samples::stopped()];
        assert_eq!(hardest(&grades), (Vec::new(), 1));
    }
}
