//! The page of a class: the points of all submissions, the hardest scenes, and the submissions with the same mistake.
use super::{
    grade_page::scene_key,
    heat, histogram,
    markup::{format_scene_count, render_data, render_note},
    render_document, render_template,
    smallest::{format_pre, list_parts},
};
use crate::untrusted_text::to_one_line;
use crate::{
    grade::{
        ClassFigures, SharedMistake, clearest_scene, describe_likely, find_frequent, find_hardest,
        find_likely_mistakes, format_optional_points, format_points, group_by_change, group_same_programs,
        has_never_run,
    },
    smallest::title,
    words,
};
use askama::Template;
use fosssim_findings::{CourseNote, Grade, SceneGrade, SkippedEntry, Verdict, smallest_scene::SmallestScene};
use fosssim_mistakes::diagnose::is_named_in;
use std::collections::BTreeMap;

const SCRIPT: &str = include_str!("class.js");

/// The maximum number of characters of a likely mistake or a summary in the table.
const MAX_SUMMARY_LENGTH: usize = 120;

/// The maximum number of shared mistakes that are shown unfolded, so that the table begins on the first screen.
const MAX_UNFOLDED: usize = 5;

/// The maximum number of names of submissions that are listed for one mistake.
const MAX_NAMES: usize = 400;

/// The page of a class, which shows these grades.
#[derive(Clone, Copy)]
pub struct ClassPage<'a> {
    /// The grades of all submissions.
    pub grades: &'a [Grade],
    /// The skipped entries of the class's folder, which are not submissions.
    pub skipped_entries: &'a [SkippedEntry],
    /// A function that returns the URL of a submission's page, relative to the class's page.
    pub page_url: &'a dyn Fn(&Grade) -> String,
}

impl ClassPage<'_> {
    /// Renders the page as one HTML file.
    pub fn html(&self) -> String {
        let content = ClassContent {
            class: self,
            mistakes: find_frequent(self.grades),
            is_compared: self.grades.iter().any(|grade| grade.earlier_grade.is_some()),
        };
        render_document(&format!("Class: {}", suite_name(self.grades)), &render_template(&content), SCRIPT)
    }
}

/// The content of the page, for the template.
#[derive(Template)]
#[template(path = "class.html")]
struct ClassContent<'a> {
    class: &'a ClassPage<'a>,
    mistakes: Vec<SharedMistake>,
    /// Whether the grades contain points of an earlier grading.
    is_compared: bool,
}

/// Submissions with something in common.
#[derive(Default)]
struct Cluster<'a> {
    heading: String,
    members: Vec<usize>,
    /// A scene in which the members' mistake is visible, and the scene's URL.
    scene: Option<(String, String)>,
    note: Option<&'a CourseNote>,
    /// The smallest scene in which a member's program shows the mistake. Teachers can demonstrate it in class.
    smallest: Option<&'a SmallestScene>,
    /// The first scene that all members fail, if they share no named mistake.
    first_failed_scene: Option<String>,
    /// The number of the members' mistake, with which the table can be filtered.
    mistake: Option<usize>,
}

impl ClassContent<'_> {
    /// Returns the URL of a scene on a submission's page.
    fn scene_url(&self, grade: &Grade, scene: &str) -> String {
        format!("{}#scene-{}", (self.class.page_url)(grade), scene_key(scene))
    }

    /// Returns the names of submissions as text, to be copied into a letter.
    fn join_names(&self, members: &[usize]) -> String {
        let names = members.iter().map(|&number| to_one_line(&self.class.grades[number].submission));
        names.collect::<Vec<_>>().join(", ")
    }

    /// Returns the filters by verdict that match at least one submission, and how many each matches.
    fn states(&self) -> impl Iterator<Item = (&'static str, &'static str, usize)> {
        let count = |wanted: &str| self.class.grades.iter().filter(|grade| submission_state(grade) == wanted).count();
        let states = [
            ("good", "accepted", count("good")),
            ("bad", "not accepted", count("bad")),
            ("none", "never ran", count("none")),
            ("left", "not graded", self.class.skipped_entries.len()),
        ];
        states.into_iter().filter(|(.., count)| *count > 0)
    }

    /// Returns the numbers of a submission's mistakes, in the form that the filter reads.
    fn mistake_numbers(&self, number: usize) -> String {
        let mistakes = self.mistakes.iter().enumerate().filter(|(_, mistake)| mistake.members.contains(&number));
        mistakes.map(|(mistake, _)| format!("m{mistake}")).collect::<Vec<_>>().join(" ")
    }

    /// Returns the mistakes that several submissions make, the most frequent first. Then come groups of submissions
    /// that no mistake explains, and that fail the same scenes for the same reasons.
    fn clusters(&self) -> Vec<Cluster<'_>> {
        let grades = self.class.grades;
        let named = self.mistakes.iter().enumerate().filter(|(_, mistake)| mistake.members.len() > 1);
        let named = named.map(|(number, SharedMistake { mistake, members })| {
            let first = &grades[members[0]];
            let scene = clearest_scene(first, mistake);
            let smallest = members.iter().flat_map(|&number| &grades[number].smallest);
            Cluster {
                heading: to_one_line(&describe_likely(first, mistake)),
                members: members.clone(),
                scene: scene.map(|scene| (to_one_line(&scene.scene), self.scene_url(first, &scene.scene))),
                note: first.course_note(mistake),
                smallest: smallest
                    .filter(|small| is_named_in(mistake, &small.explanations))
                    .min_by_key(|small| small.size()),
                first_failed_scene: None,
                mistake: Some(number),
            }
        });
        let same = group_by_signature(grades).into_iter().map(|members| {
            let wrong: Vec<&SceneGrade> = grades[members[0]].scenes().filter(|scene| is_failed(scene)).collect();
            let first = format!("{}: {}", wrong[0].scene, words::summarize(wrong[0]));
            let heading = match wrong.len() {
                1 => "No known mistake fits, but these submissions fail the same scene for the same reason".to_owned(),
                count => format!(
                    "No known mistake fits, but these submissions fail the same {count} scenes for the same reason"
                ),
            };
            Cluster { heading, members, first_failed_scene: Some(shorten(&to_one_line(&first))), ..Cluster::default() }
        });
        named.chain(same).collect()
    }

    /// Returns the changes since the earlier grading, with the submissions concerned.
    fn changes(&self) -> Vec<Cluster<'_>> {
        let cluster =
            |(change, members): (&str, _)| Cluster { heading: change.to_owned(), members, ..Cluster::default() };
        group_by_change(self.class.grades).into_iter().map(cluster).collect()
    }

    /// Returns groups of submissions with the same program.
    fn same_programs(&self) -> Vec<Cluster<'_>> {
        let cluster = |members: Vec<usize>| {
            let heading = shorten(&self.join_names(&members));
            Cluster { heading, members, ..Cluster::default() }
        };
        group_same_programs(self.class.grades).into_iter().map(cluster).collect()
    }

    /// Returns the URL of the scene on the page of the first submission that fails it; `None` if no submission fails
    /// it.
    fn find_scene_with_mistake(&self, name: &str) -> Option<String> {
        let fails = |grade: &&Grade| grade.scenes().any(|scene| scene.scene == name && is_failed(scene));
        self.class.grades.iter().find(fails).map(|grade| self.scene_url(grade, name))
    }
}

/// Returns the name of the suite of these grades.
fn suite_name(grades: &[Grade]) -> &str {
    grades.first().map_or("", |grade| grade.suite.as_str())
}

/// Returns the names of the scenes in the form that the page's script reads.
fn scene_names(grades: &[Grade]) -> String {
    let names: Vec<&str> =
        grades.first().iter().flat_map(|grade| grade.scenes()).map(|scene_grade| scene_grade.scene.as_str()).collect();
    render_data(&serde_json::json!(names))
}

/// Returns points in a form by which the page's script can sort.
fn sort_key(points: Option<f64>) -> String {
    points.map_or_else(String::new, |points| points.to_string())
}

/// Returns the points of the earlier grading, if there is one.
fn earlier_points(grade: &Grade) -> Option<f64> {
    grade.changes()?.earlier_points
}

/// Returns the first likely mistake of a submission, or the reason why it is not accepted.
fn describe_reason(grade: &Grade) -> String {
    let likely = find_likely_mistakes(grade).into_iter().map(|(mistake, _)| describe_likely(grade, &mistake));
    let likely: Vec<String> = grade.located_failure.iter().map(words::describe_located).chain(likely).collect();
    match likely.as_slice() {
        [] => words::describe_reason(grade).unwrap_or_default(),
        [only] => only.clone(),
        [first, others @ ..] => format!("{first} And {} more.", others.len()),
    }
}

/// Returns the reasons why the rule books differ, each with the submissions that it concerns and the number of scenes
/// in each submission.
fn find_disagreements(grades: &[Grade]) -> Vec<(String, Vec<(usize, usize)>)> {
    let mut found: BTreeMap<String, BTreeMap<usize, usize>> = BTreeMap::new();
    for (number, grade) in grades.iter().enumerate() {
        for cause in grade.scenes().filter_map(|scene| scene.difference_cause) {
            let verdict = if cause.is_original_too_strict() { "rejects" } else { "accepts" };
            let reason = format!("The original {verdict} them: {cause}");
            *found.entry(reason).or_default().entry(number).or_default() += 1;
        }
    }
    let mut found: Vec<_> = found.into_iter().map(|(reason, members)| (reason, Vec::from_iter(members))).collect();
    found.sort_by_key(|(_, members)| std::cmp::Reverse(members.len()));
    found
}

/// Cuts a long text, between two words if possible.
fn shorten(text: &str) -> String {
    let Some((end, _)) = text.char_indices().nth(MAX_SUMMARY_LENGTH) else { return text.to_owned() };
    let cut = &text[..end];
    format!("{} ...", cut.rsplit_once(' ').map_or(cut, |(whole, _)| whole))
}

/// Returns whether the submission failed on a scene. Scenes that were not run, or on which the grader failed, are
/// excluded.
fn is_failed(scene: &SceneGrade) -> bool {
    !matches!(scene.verdict, Verdict::Accepted | Verdict::NotRun | Verdict::JudgeError)
}

/// Returns the state of a submission. Rows are filtered and colored by it.
fn submission_state(grade: &Grade) -> &'static str {
    match grade {
        _ if grade.verdict.is_accepted() => "good",
        _ if has_never_run(grade) => "none",
        _ => "bad",
    }
}

/// Returns one letter for each of a submission's scenes.
fn render_scene_letters(grade: &Grade) -> String {
    let letters = grade.groups.iter().map(|group| group.scenes.iter().map(scene_letter).collect::<String>());
    heat::render_cells(&letters.collect::<Vec<_>>().join("|"))
}

/// Returns the letter for a scene: accepted, wrong, not run, or without a trace that can be judged.
fn scene_letter(scene: &SceneGrade) -> char {
    match scene.verdict {
        Verdict::Accepted => 'r',
        Verdict::NotRun | Verdict::Unusable | Verdict::CompileError => 'n',
        Verdict::WrongAnswer | Verdict::Unwritten => 'w',
        _ => 'e',
    }
}

/// Returns the names and the values of the class's statistics.
fn list_figures(grades: &[Grade]) -> Vec<(String, String)> {
    let figures = ClassFigures::from_grades(grades);
    let [mean, median, ..] = figures.points.map_or([None; 4], |all| all.map(Some)).map(format_optional_points);
    let unsolved_count = find_hardest(grades).0.iter().filter(|(_, share)| share.accepted == 0).count();
    vec![
        (format!("{} of {}", figures.run_submissions, figures.submissions), "ran".to_owned()),
        (figures.accepted.to_string(), "accepted".to_owned()),
        (mean, format!("mean of {} points", format_points(figures.max_points))),
        (median, "median, of submissions that were run".to_owned()),
        (unsolved_count.to_string(), "scenes without a correct answer".to_owned()),
    ]
}

/// Returns groups of submissions that fail the same scenes for the same reasons, the largest first. Submissions with a
/// likely mistake are left out.
fn group_by_signature(grades: &[Grade]) -> Vec<Vec<usize>> {
    let mut found: BTreeMap<Vec<(&str, Verdict, String)>, Vec<usize>> = BTreeMap::new();
    for (number, grade) in grades.iter().enumerate().filter(|(_, grade)| find_likely_mistakes(grade).is_empty()) {
        let failed = grade.scenes().filter(|scene| is_failed(scene));
        let signature: Vec<_> =
            failed.map(|scene| (scene.scene.as_str(), scene.verdict, words::summarize(scene))).collect();
        if !signature.is_empty() {
            found.entry(signature).or_default().push(number);
        }
    }
    let mut several: Vec<_> = found.into_values().filter(|members| members.len() > 1).collect();
    several.sort_by_key(|members| std::cmp::Reverse(members.len()));
    several
}

/// Renders a histogram of the shares of points, for the submissions that were run.
fn render_bars(grades: &[Grade]) -> String {
    let judged = grades.iter().filter(|grade| !has_never_run(grade));
    histogram::render_histogram(judged.filter_map(|grade| Some(grade.points? / grade.max_points)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grade::samples;
    use fosssim_findings::smallest_scene::SmallestScene;
    use fosssim_grading::{
        GroupGrade, Reason, SceneResult,
        config::{Credit, Hints, Marking, Visibility},
        score,
    };

    fn grade(name: &str, fails: impl Fn(usize) -> Option<String>) -> Grade {
        let marking = Marking {
            points: 20.0,
            credit: Credit::Scenes,
            visibility: Visibility::Visible,
            hints: Hints::Full,
            is_extra: false,
            speed: None,
        };
        let groups: Vec<GroupGrade> = (0..5)
            .map(|group| {
                let scenes = (0..16).map(|number| {
                    let scene = 16 * group + number;
                    let (verdict, why) = match fails(scene) {
                        Some(words) => (Verdict::WrongAnswer, samples::reason_with_text(&words)),
                        None => (Verdict::Accepted, Reason::Right),
                    };
                    (SceneResult::without_run(&format!("Group/a-scene-of-number-{scene}"), 100, verdict, why), false)
                });
                score::grade_group(&format!("Group {group}"), marking, scenes.collect())
            })
            .collect();
        Grade {
            submission: name.to_owned(),
            verdict: groups.iter().map(|group| group.verdict).max().expect("groups"),
            points: groups.iter().map(|group| group.points).sum(),
            max_points: 100.0,
            groups,
            ..samples::accepted_grade()
        }
    }

    fn page(grades: &[Grade]) -> String {
        ClassPage { grades, skipped_entries: &[], page_url: &|grade| format!("reports/{}.html", grade.submission) }
            .html()
    }

    #[test]
    fn three_hundred_submissions_of_eighty_scenes_stay_small() {
        let fails = |student: usize| {
            move |scene: usize| {
                let words = || format!("{} of 100 steps are wrong, first step {student}: wrong coefficient", scene + 1);
                (scene.is_multiple_of(1 + student % 9)).then(words)
            }
        };
        let grades: Vec<Grade> = (0..300).map(|student| grade(&format!("student-{student}"), fails(student))).collect();
        let html = page(&grades);
        assert!(html.len() < 1_000_000, "{}", html.len());
        assert_eq!(html.matches("<td class=\"heat\"").count(), 300);
        assert!(html.contains("No two submissions make the same mistake."), "each fails in words of its own");
    }

    #[test]
    fn the_smallest_scene_of_a_shared_mistake_is_there_to_be_shown_in_class() {
        let explanations = crate::explain::tests::explanations();
        let mut grades = ["ada", "eve"].map(|name| grade(name, |scene| (scene == 0).then(|| "wrong".to_owned())));
        for (grade, bodies) in grades.iter_mut().zip([3, 2]) {
            grade.groups[0].scenes[0].result.explanations = explanations[..1].to_vec();
            let xml = format!("<scene> of {bodies} </scene>");
            grade.smallest = vec![SmallestScene { xml, bodies, ..samples::smallest(explanations[..1].to_vec()) }];
        }
        let html = page(&grades);
        assert!(html.contains("To show in class: The smallest scene: 2 bodies, 1 step"), "{html}");
        assert!(html.contains("&lt;scene&gt; of 2 ") && !html.contains("&lt;scene&gt; of 3 "));
    }

    #[test]
    fn equal_failures_are_found_without_a_named_mistake() {
        let crash = |scene: usize| (scene > 70).then(|| "the program was killed by signal 11".to_owned());
        let grades = [
            grade("ada", |_| None),
            grade("eve", crash),
            grade("<b>kim", crash),
            grade("bob", |_| Some("other".to_owned())),
        ];
        let html = page(&grades);
        let cluster = html.split("class=\"cluster\"").nth(1).expect("one cluster");
        let cluster = &cluster[..cluster.find("</details>").expect("its end")];
        assert!(cluster.contains("fail the same 9 scenes") && cluster.contains("<b>2</b>"), "{cluster}");
        assert!(cluster.contains("eve") && cluster.contains("&lt;b&gt;kim") && !cluster.contains("bob"), "{cluster}");
        assert!(html.contains("<td class=\"num\" data-sort=\"3\">3</td>"), "three fail the last scenes");
        let last = scene_key("Group/a-scene-of-number-75");
        assert!(html.contains(&format!("<a href=\"reports/eve.html#scene-{last}\">Group/a-scene-of-number-75</a>")));
        let bars = html.split("aria-label=\"Points of the class: ").nth(1).expect("a histogram");
        assert!(bars.starts_with("0 to 10 %: 1, ") && bars.contains("90 to 100 %: 1\""), "{bars:.300}");
    }
}
