//! The page of one submission: its points, its likely mistakes, and a card per scene.
use super::{
    Card,
    case::mistakes,
    markup::{count_scenes, note, text},
    render_document, render_template,
    room::{self, OUTPUT_BUDGET, Room},
    script, smallest,
};
use crate::foreign::{one_line, without_codes};
use crate::{
    grade::{
        by_cause, change_lines, clearest_scene, count_wrong, describe_difference, describe_speed, describe_worth,
        extra, format_optional_points, format_points, format_score, is_listed, likely_mistakes, no_points,
    },
    number::format_count,
    words,
};
use askama::Template;
use fosssim_findings::{
    Build, Grade, GroupGrade, SceneGrade, Visibility, located::LocatedFailure, smallest::SmallestScene,
};
use fosssim_mistakes::diagnose::Explanation;
use fosssim_mistakes::together::for_students;
use sha2::{Digest, Sha256};
use std::borrow::Cow;

/// The maximum number of characters of a program's output in a scene.
const MAX_OUTPUT_LENGTH: usize = 2_000;

/// The readers of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Audience {
    /// Staff, who see every group, with its visibility.
    #[default]
    Staff,
    /// The student, who sees only groups that are visible immediately, and conclusions from these.
    Student,
}

/// One submission's grade, with the pictures of its traces.
#[derive(Clone, Copy)]
pub struct GradePage<'a> {
    /// The grade.
    pub grade: &'a Grade,
    /// A function that returns the stored card with a name.
    pub card: &'a dyn Fn(Option<&str>) -> Option<Card>,
    /// The address of the class's page, relative to the page.
    pub class: Option<&'a str>,
    /// The reader of the page.
    pub reader: Audience,
}

impl GradePage<'_> {
    /// Renders the file.
    #[must_use]
    pub fn html(&self) -> String {
        let shown = match self.reader {
            Audience::Student => for_students(self.grade),
            Audience::Staff => Cow::Borrowed(self.grade),
        };
        let grade = shown.as_ref();
        let causes = by_cause(grade);
        let told: Vec<_> = causes.iter().flatten().map(|&scene| (scene, (self.card)(scene.card.as_deref()))).collect();
        let tells_who =
            self.reader == Audience::Staff && grade.groups.iter().any(|group| group.visibility != Visibility::Visible);
        let content = GradeContent {
            page: self,
            grade,
            rooms: room::distribute(told.iter().map(|(_, card)| card.as_ref())),
            has_scenes: grade.unfit().is_none(),
            is_accepted: told.iter().all(|(scene, _)| scene.verdict.is_accepted()),
            tells_who,
            columns: if tells_who { 6 } else { 5 },
            alike: causes.iter().map(Vec::len).collect(),
            told,
        };
        // The viewer is left out if there are no cards, because it would be most of the page.
        let script = if content.has_scenes && !content.told.is_empty() { script() } else { "" };
        render_document(&format!("{}: {}", grade.submission, grade.verdict.name()), &render_template(&content), script)
    }
}

/// The content of the file.
#[derive(Template)]
#[template(path = "graded.html")]
struct GradeContent<'a> {
    page: &'a GradePage<'a>,
    /// The part of the grade that the reader may see.
    grade: &'a Grade,
    /// The listed scenes by cause, each with the parts of its card that fit on the page.
    told: Vec<(&'a SceneGrade, Option<Card>)>,
    rooms: Vec<Room>,
    /// The number of scenes with each cause.
    alike: Vec<usize>,
    has_scenes: bool,
    /// Whether nothing is wrong, so that all listed scenes are listed only because the rule books differ.
    is_accepted: bool,
    /// Whether the table of groups has a column with the readers of each group.
    tells_who: bool,
    columns: usize,
}

/// The details of a scene.
struct Article<'a> {
    scene: &'a SceneGrade,
    key: String,
    lines: Vec<String>,
    /// The parts of the card that fit, and the program's output.
    shown: String,
    outputs: String,
    motion: String,
}

impl GradeContent<'_> {
    /// Returns the likely mistakes, each with the number of scenes that it explains; empty if a fault of the whole
    /// submission explains everything.
    fn likely(&self) -> Vec<(Explanation, usize)> {
        if self.has_scenes { likely_mistakes(self.grade) } else { Vec::new() }
    }

    /// Returns the first listed scene of a group.
    fn first_of(&self, group: &GroupGrade) -> Option<&SceneGrade> {
        let is_here = |scene: &SceneGrade| group.scenes.iter().any(|one| one.scene == scene.scene);
        self.told.iter().map(|(scene, _)| *scene).find(|scene| self.has_scenes && is_here(scene))
    }

    /// Renders the smallest scenes.
    fn smallest(&self) -> String {
        let card = |small: &SmallestScene| (self.page.card)(small.card.as_deref());
        let all = self.grade.smallest.iter().zip(1..);
        all.map(|(small, number)| smallest::render_article(small, card(small).as_ref(), number)).collect()
    }

    /// Returns the cards of the listed scenes.
    fn told_cards(&self) -> impl Iterator<Item = Option<&Card>> {
        self.told.iter().map(|(_, card)| card.as_ref())
    }

    /// Returns the details of each listed scene, by cause.
    fn articles(&self) -> Vec<Vec<Article<'_>>> {
        let mut outputs = if self.grade.shows_output { OUTPUT_BUDGET } else { 0 };
        let told = self.told.iter().zip(&self.rooms);
        let mut articles = told.map(|((scene, card), room)| Article::new(scene, card.as_ref(), *room, &mut outputs));
        self.alike.iter().map(|&count| articles.by_ref().take(count).collect()).collect()
    }

    /// Returns the number of accepted scenes that are not listed, and all scenes that are not listed.
    fn rest(&self) -> (usize, Vec<&SceneGrade>) {
        let rest: Vec<&SceneGrade> = self.grade.scenes().filter(|scene| !is_listed(scene)).collect();
        (rest.iter().filter(|scene| scene.verdict.is_accepted()).count(), rest)
    }
}

/// Returns the common properties of scenes in which a program fails, as HTML.
pub(super) fn render_located(found: &LocatedFailure) -> String {
    let words = text(&one_line(&words::describe_located(found)));
    format!("<h2>Where it fails</h2>\n<div class=\"card mistake\"><p class=\"lead\">{words}</p></div>\n")
}

/// Returns the sentence about which rule book counts.
fn describe_books(grade: &Grade) -> String {
    let other = format_count(grade.differing() as u64, "scene");
    match (grade.rules, grade.differing()) {
        (fosssim_judge::Rules::Parity, _) => "by the original's rules".to_owned(),
        (fosssim_judge::Rules::Fair, 0) => "by the fair rules".to_owned(),
        (fosssim_judge::Rules::Both, 0) => "by the original's rules; the fair ones agree".to_owned(),
        (fosssim_judge::Rules::Fair, _) => format!("by the fair rules; the original's differ in {other}"),
        (fosssim_judge::Rules::Both, _) => format!("by the original's rules; the fair ones differ in {other}"),
    }
}

/// Returns the points of a grade, or the reason why there are none.
fn score_or_why(grade: &Grade) -> String {
    match grade.points {
        Some(reached) => format_score(reached, grade.max_points) + &extra(grade),
        None => no_points(grade).unwrap_or_default(),
    }
}

/// Returns the output of a build.
fn printed_by(build: &Build) -> String {
    render_output("What it printed", &build.output, &mut OUTPUT_BUDGET.clone())
}

/// Returns the readers of groups with this visibility.
const fn describe_readers(visibility: Visibility) -> &'static str {
    match visibility {
        Visibility::Visible => "everybody",
        Visibility::Hidden => "staff",
        Visibility::AfterDueDate => "students after the due date",
        Visibility::AfterPublished => "students once grades are out",
    }
}

/// Returns the number of accepted scenes of a group.
fn accepted_of(group: &GroupGrade) -> usize {
    group.scenes.iter().filter(|scene| scene.verdict.is_accepted()).count()
}

impl<'a> Article<'a> {
    /// Creates the details of a scene, reduced to the remaining space for its card and its output.
    fn new(scene: &'a SceneGrade, card: Option<&Card>, room: Room, room_of_outputs: &mut usize) -> Self {
        let key = scene_key(&scene.scene);
        // A detail is left out if the card already shows it with values.
        let is_shown = room != Room::Words && card.is_some_and(Card::has_values);
        let details = words::list_details(scene).into_iter().skip(usize::from(is_shown));
        let mistakes = mistakes(&scene.settled, is_shown);
        let no_room = |what: &str| format!("<p class=\"hint\">This page has no room for {what}.</p>\n");
        let shown = match (card, room) {
            (None, _) => mistakes,
            (Some(card), Room::Words) if card.sizes().0 > 0 => mistakes + &no_room("the pictures and the motion"),
            (Some(card), Room::Pictures) if card.sizes().1 > 0 => no_room("the motion") + &card.html(&key, &mistakes),
            (Some(card), _) => card.html(&key, &mistakes),
        };
        let motion = match (card, room) {
            (Some(card), Room::Exact) => card.data(&key),
            (Some(card), Room::Rounded) => card.round_motions(&key),
            _ => String::new(),
        };
        let outputs = render_output("Standard output", &scene.stdout, room_of_outputs)
            + &render_output("Standard error", &scene.stderr, room_of_outputs);
        let lines = describe_difference(scene).into_iter().chain(details).collect();
        Self { scene, key, lines, shown, outputs, motion }
    }
}

/// Returns a key that is different for every name of a scene.
pub(super) fn scene_key(name: &str) -> String {
    Sha256::digest(name.as_bytes())[..6].iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns the output of a program, cut to the remaining space.
fn render_output(heading: &str, output: &str, room: &mut usize) -> String {
    if output.trim().is_empty() || *room == 0 {
        return String::new();
    }
    let output = without_codes(output);
    let shown: String = output.chars().take(MAX_OUTPUT_LENGTH).collect();
    let cut = if shown.len() < output.len() { "\n[cut short]" } else { "" };
    // The length is measured after escaping, because escaping makes hostile text longer.
    let shown = text(&shown);
    if shown.len() > *room {
        *room = 0;
        return "<p class=\"hint\">This page has no room for the output of programs in this scene and the next \
            ones.</p>\n"
            .to_owned();
    }
    *room -= shown.len();
    format!(
        "<details class=\"table\"><summary>{heading}</summary><pre tabindex=\"0\" role=\"region\" \
         aria-label=\"{heading}\">{shown}{cut}</pre></details>\n"
    )
}
