//! The page of one submission, with its points, its likely mistakes, and a card for each scene.
use super::{
    Card, card,
    card_details::{self, CardDetail, OUTPUT_BUDGET},
    case::mistakes,
    markup::{escape, format_scene_count, render_note},
    render_document, render_template, script, smallest,
};
use crate::untrusted_text::{remove_escape_codes, to_one_line};
use crate::{
    grade::{
        change_lines, clearest_scene, describe_difference, describe_extra_points, describe_likely,
        describe_missing_points, describe_shared_worth, describe_speed, describe_worth, describe_wrong_count,
        describe_wrong_state, detail_likely, find_likely_mistakes, format_optional_points, format_points, format_score,
        group_by_cause, is_listed, likely_heading,
    },
    number::format_count,
    words::{self, explanation::capitalize},
};
use askama::Template;
use fosssim_findings::{
    Build, Grade, GroupGrade, SceneGrade, Verdict, Visibility, located_failure::LocatedFailure,
    smallest_scene::SmallestScene,
};
use fosssim_mistakes::diagnose::Explanation;
use fosssim_mistakes::together::immediate_grade;
use sha2::{Digest, Sha256};
use std::borrow::Cow;

/// The maximum number of characters of a program's output that the page shows for a scene.
const MAX_OUTPUT_LENGTH: usize = 2_000;

/// The reader for whom a report is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Audience {
    /// Staff, who see every group and how visible it is to students.
    #[default]
    Staff,
    /// The student. A student sees only groups that are visible immediately, and only conclusions from these.
    Student,
}

/// The page of one submission's grade, with pictures of its traces.
#[derive(Clone, Copy)]
pub struct GradePage<'a> {
    /// The grade that the page shows.
    pub grade: &'a Grade,
    /// A function that returns the stored card of this name, if there is one.
    pub card: &'a dyn Fn(Option<&str>) -> Option<Card>,
    /// The URL of the class's page, relative to this page; `None` if there is no such page.
    pub class: Option<&'a str>,
    /// The reader for whom the page is made.
    pub reader: Audience,
}

impl GradePage<'_> {
    /// Renders the page as one HTML file.
    pub fn html(&self) -> String {
        let visible_grade = match self.reader {
            Audience::Student => immediate_grade(self.grade),
            Audience::Staff => Cow::Borrowed(self.grade),
        };
        let grade = visible_grade.as_ref();
        let causes = group_by_cause(grade);
        let rows: Vec<_> = causes.iter().flatten().map(|&scene| (scene, (self.card)(scene.card.as_deref()))).collect();
        let is_accepted = rows.iter().all(|(scene, _)| scene.verdict.is_accepted());
        let content = GradeContent {
            page: self,
            grade,
            card_details: card_details::distribute(rows.iter().map(|(_, card)| card.as_ref())),
            has_scenes: grade.submission_fault().is_none(),
            has_groups: grade.submission_fault().is_none() || grade.points > Some(0.0),
            is_accepted,
            columns: 4 + usize::from(!is_accepted),
            cause_sizes: causes.iter().map(Vec::len).collect(),
            listed: rows,
        };
        // Without cards, the viewer is left out, because it would be most of the page.
        let script = if content.has_scenes && !content.listed.is_empty() { script() } else { "" };
        render_document(&format!("{}: {}", grade.submission, grade.verdict.name()), &render_template(&content), script)
    }
}

/// The content of the page, for the template.
#[derive(Template)]
#[template(path = "graded.html")]
struct GradeContent<'a> {
    page: &'a GradePage<'a>,
    /// The part of the grade that the reader may see.
    grade: &'a Grade,
    /// The listed scenes, ordered by cause. Each has the parts of its card that fit on the page.
    listed: Vec<(&'a SceneGrade, Option<Card>)>,
    card_details: Vec<CardDetail>,
    /// The number of scenes with each cause, in the same order.
    cause_sizes: Vec<usize>,
    has_scenes: bool,
    /// Whether the table of groups holds more than zeros.
    has_groups: bool,
    /// Whether nothing is wrong. Scenes are then listed only because the rule books judge them differently.
    is_accepted: bool,
    /// The number of columns of the table of groups.
    columns: usize,
}

/// The part of the page about one scene.
struct Article<'a> {
    scene: &'a SceneGrade,
    key: String,
    lines: Vec<String>,
    /// The parts of the card that fit on the page, and the program's output.
    shown: String,
    outputs: String,
    motion: String,
}

impl GradeContent<'_> {
    /// Returns the likely mistakes, and how many scenes each explains. The list is empty if a fault of the whole
    /// submission explains everything.
    fn likely(&self) -> Vec<(Explanation, usize)> {
        if self.has_scenes { find_likely_mistakes(self.grade) } else { Vec::new() }
    }

    /// Returns the scene that shows the first cause best, and the number of scenes with this cause. Returns `None` if
    /// nothing is wrong, or if the page already says where the program fails.
    fn common_cause(&self) -> Option<(&SceneGrade, usize)> {
        let (first, _) = self.listed.first().filter(|_| self.has_scenes && self.grade.located_failure.is_none())?;
        (!self.is_accepted).then_some((*first, self.cause_sizes[0]))
    }

    /// Returns the first scene of a group that the page lists.
    fn first_listed_scene(&self, group: &GroupGrade) -> Option<&SceneGrade> {
        let is_here = |scene: &SceneGrade| group.scenes.iter().any(|scene_grade| scene_grade.scene == scene.scene);
        self.listed.iter().map(|(scene, _)| *scene).find(|scene| self.has_scenes && is_here(scene))
    }

    /// Renders an article for each smallest scene.
    fn smallest(&self) -> String {
        let card = |small: &SmallestScene| (self.page.card)(small.card.as_deref());
        let all = self.grade.smallest.iter().zip(1..);
        all.map(|(small, number)| smallest::render_article(small, card(small).as_ref(), number)).collect()
    }

    /// Returns the cards of the listed scenes.
    fn shown_cards(&self) -> impl Iterator<Item = Option<&Card>> {
        self.listed.iter().map(|(_, card)| card.as_ref())
    }

    /// Returns the parts of the page about the listed scenes, grouped by cause.
    fn articles(&self) -> Vec<Vec<Article<'_>>> {
        let mut outputs = if self.grade.shows_output { OUTPUT_BUDGET } else { 0 };
        let scenes = self.listed.iter().zip(&self.card_details);
        let mut articles = scenes.map(|((scene, card), room)| Article::new(scene, card.as_ref(), *room, &mut outputs));
        self.cause_sizes.iter().map(|&count| articles.by_ref().take(count).collect()).collect()
    }

    /// Returns the scenes that are not listed, and how many of them are accepted.
    fn unlisted_scenes(&self) -> (usize, Vec<&SceneGrade>) {
        let rest: Vec<&SceneGrade> = self.grade.scenes().filter(|scene| !is_listed(scene)).collect();
        (rest.iter().filter(|scene| scene.verdict.is_accepted()).count(), rest)
    }
}

/// Describes as HTML what the scenes in which a program fails have in common.
pub(super) fn render_located(found: &LocatedFailure) -> String {
    let description = escape(&to_one_line(&words::describe_located(found)));
    format!("<h2>Where it fails</h2>\n<div class=\"card mistake\"><p class=\"lead\">{description}</p></div>\n")
}

/// Describes which rule book gives the verdict.
fn describe_books(grade: &Grade) -> String {
    let other = format_count(grade.count_differing() as u64, "scene");
    match (grade.rules, grade.count_differing()) {
        (fosssim_judge::Rules::Parity, _) => "by the original's rules".to_owned(),
        (fosssim_judge::Rules::Fair, 0) => "by the fair rules".to_owned(),
        (fosssim_judge::Rules::Both, 0) => "by the original's rules; the fair rules agree".to_owned(),
        (fosssim_judge::Rules::Fair, _) => format!("by the fair rules; the original's rules differ in {other}"),
        (fosssim_judge::Rules::Both, _) => format!("by the original's rules; the fair rules differ in {other}"),
    }
}

/// Describes the points of a grade, or why there are none.
fn describe_score(grade: &Grade) -> String {
    match grade.points {
        Some(reached) => format_score(reached, grade.max_points) + &describe_extra_points(grade),
        None => describe_missing_points(grade).unwrap_or_default(),
    }
}

/// Renders the text that a build printed.
fn build_output(build: &Build) -> String {
    render_output("What it printed", &build.output, true, &mut OUTPUT_BUDGET.clone())
}

/// Describes how the suite hides groups with this visibility; empty if it does not.
const fn describe_visibility(visibility: Visibility) -> &'static str {
    match visibility {
        Visibility::Visible => "",
        Visibility::Hidden => "hidden by the suite",
        Visibility::AfterDueDate => "hidden by the suite until the due date",
        Visibility::AfterPublished => "hidden by the suite until grades are out",
    }
}

/// Returns the number of a group's scenes that are accepted.
fn count_accepted(group: &GroupGrade) -> usize {
    group.scenes.iter().filter(|scene| scene.verdict.is_accepted()).count()
}

impl<'a> Article<'a> {
    /// Creates the part of the page about a scene. Its card is reduced to what fits, and its output to the remaining
    /// space.
    fn new(scene: &'a SceneGrade, card: Option<&Card>, room: CardDetail, room_of_outputs: &mut usize) -> Self {
        let key = scene_key(&scene.scene);
        // A detail is left out if the card already shows it together with the values.
        let is_shown = room != CardDetail::Text && card.is_some_and(Card::has_values);
        let details = words::list_details(scene).into_iter().skip(usize::from(is_shown));
        let mistakes = mistakes(&scene.corrected_explanations, is_shown, describe_wrong_state(scene).as_deref());
        let no_room = |what: &str| format!("<p class=\"hint\">This page has no space for {what}.</p>\n");
        let shown = match (card, room) {
            (None, _) => mistakes,
            (Some(card), CardDetail::Text) if card.sizes().0 > 0 => mistakes + &no_room("the pictures and the motion"),
            (Some(card), CardDetail::Pictures) if card.sizes().1 > 0 => {
                no_room("the motion") + &card.render_with_mistakes(&key, &mistakes)
            }
            (Some(card), _) => card.render_with_mistakes(&key, &mistakes),
        };
        let motion = match (card, room) {
            (Some(card), CardDetail::Exact) => card.data(&key),
            (Some(card), CardDetail::Rounded) => card.rounded.replace(card::KEY_PLACEHOLDER, &key),
            _ => String::new(),
        };
        // Without a card, the output is all that there is to see.
        let is_open = shown.is_empty();
        let mut outputs = render_output("Standard output", &scene.stdout, is_open, room_of_outputs)
            + &render_output("Standard error", &scene.stderr, is_open, room_of_outputs);
        if outputs.is_empty() && shown.is_empty() && scene.result.ended.is_some() && *room_of_outputs > 0 {
            outputs = "<p class=\"hint\">It printed nothing.</p>\n".to_owned();
        }
        let lines = describe_difference(scene).into_iter().chain(details).collect();
        Self { scene, key, lines, shown, outputs, motion }
    }
}

/// Returns a key for a scene that is part of URLs. Scenes with different names have different keys.
pub(super) fn scene_key(name: &str) -> String {
    Sha256::digest(name.as_bytes())[..6].iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Renders a program's output, cut to the remaining space.
fn render_output(heading: &str, output: &str, is_open: bool, room: &mut usize) -> String {
    if output.trim().is_empty() || *room == 0 {
        return String::new();
    }
    let output = remove_escape_codes(output);
    let shown: String = output.chars().take(MAX_OUTPUT_LENGTH).collect();
    let cut = if shown.len() < output.len() { "\n[cut short]" } else { "" };
    // The length is measured after escaping, which makes hostile text longer.
    let shown = escape(&shown);
    if shown.len() > *room {
        *room = 0;
        return "<p class=\"hint\">This page has no space for the output of programs in this scene and the next \
            ones.</p>\n"
            .to_owned();
    }
    *room -= shown.len();
    let open = if is_open { " open" } else { "" };
    format!(
        "<details class=\"table\"{open}><summary>{heading}</summary><pre tabindex=\"0\" role=\"region\" \
         aria-label=\"{heading}\">{shown}{cut}</pre></details>\n"
    )
}
