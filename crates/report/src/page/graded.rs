//! The page of one submission: what it got, its likely mistakes, and a card per scene.
use super::{Card, SCRIPT, case::mistakes, document, markup::text};
use crate::{
    grade::{difference, likely_mistakes, no_points, one_line, points, reached, score},
    number::counted,
    words,
};
use fosssim_grading::{Grade, GroupGrade, SceneGrade, Verdict, config::Visibility};
use fosssim_mistakes::diagnose::Explanation;
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// A page is to stay below so many bytes: it is mailed, and opened on old machines.
pub const BUDGET: usize = 2_950_000;

/// So much of it may go to pictures and tables before the first motion has room.
const STILL: usize = BUDGET / 3 * 2;

/// So many characters of what a program printed are shown of a scene, and so many bytes of the page go to all scenes'.
const OUTPUT: usize = 2_000;
const OUTPUTS: usize = 200_000;

/// One submission's grade with what was drawn of its traces.
#[derive(Clone, Copy)]
pub struct Graded<'a> {
    /// The grade.
    pub grade: &'a Grade,
    /// The card of a scene, where one was drawn.
    pub card: &'a dyn Fn(&SceneGrade) -> Option<Card>,
    /// The address of the class's page, seen from this one.
    pub class: Option<&'a str>,
}

/// What of a scene has room on the page.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Room {
    Words,
    Pictures,
    All,
}

impl Graded<'_> {
    /// The file.
    #[must_use]
    pub fn html(&self) -> String {
        let grade = self.grade;
        let mut body = self.head();
        if grade.unfit().is_none() {
            body += &self.scenes();
        }
        document(&format!("{}: {}", grade.submission, grade.verdict.words()), &body, SCRIPT)
    }

    fn head(&self) -> String {
        let grade = self.grade;
        let look = if grade.verdict.is_accepted() { "good" } else { "bad" };
        let reached = match grade.points {
            Some(reached) => score(reached, grade.max_points),
            None => no_points(grade).unwrap_or_default(),
        };
        let mut out = String::new();
        if let Some(class) = self.class {
            let _ = writeln!(out, "<p><a href=\"{}\">The class</a></p>", text(class));
        }
        let _ = writeln!(
            out,
            "<h1>{}: <span class=\"{look}\">{}</span>, {}</h1>\n<p class=\"names\">suite {}, {}</p>",
            text(&one_line(&grade.submission)),
            text(&grade.verdict.words().to_uppercase()),
            text(&reached),
            text(&one_line(&grade.suite)),
            text(&books(grade)),
        );
        for warning in &grade.warnings {
            let _ = writeln!(out, "<p class=\"bad\">Warning: {}</p>", text(warning));
        }
        if let Some(build) = grade.build.as_ref().filter(|build| !build.end.is_success()) {
            let _ = writeln!(out, "<h2>The build</h2>\n<p>{}</p>", text(&words::build(&build.end)));
            out += &printed("What it printed", &build.output, &mut OUTPUTS.clone());
        } else if let Some(unfit) = words::unfit(grade) {
            let _ = writeln!(out, "<p>{}</p>", text(&unfit));
        }
        let likely = likely_mistakes(grade);
        if !likely.is_empty() {
            let wrong = |scene: &&SceneGrade| matches!(scene.verdict, Verdict::WrongAnswer | Verdict::BadTrace);
            let wrong = counted(grade.scenes().filter(wrong).count() as u64, "wrong scene");
            let plural = if likely.len() == 1 { "" } else { "s" };
            let _ = writeln!(out, "<h2>Likely mistake{plural}</h2>");
            for (mistake, explained) in likely {
                let _ = writeln!(
                    out,
                    "<div class=\"mistake\"><p>{} <span class=\"hint\">(explains {explained} of {wrong})</span></p></div>",
                    text(&mistake.what)
                );
            }
        }
        out + &groups(&grade.groups)
    }

    fn scenes(&self) -> String {
        let told: Vec<&SceneGrade> = self.grade.scenes().filter(|scene| is_told(scene)).collect();
        let cards: Vec<Option<Card>> = told.iter().map(|scene| (self.card)(scene)).collect();
        let rooms = share_out(&cards);
        let mut out = String::new();
        if !told.is_empty() {
            out += "<h2>Scenes to look at</h2>\n";
        }
        out += &left_out(&cards, &rooms);
        let likely: Vec<Explanation> = likely_mistakes(self.grade).into_iter().map(|(mistake, _)| mistake).collect();
        let mut outputs = if self.grade.shows_output { OUTPUTS } else { 0 };
        for (number, ((scene, card), room)) in told.iter().zip(&cards).zip(&rooms).enumerate() {
            out += &article(scene, &likely, (card.as_ref(), *room), number == 0, &mut outputs);
        }
        let rest: Vec<&SceneGrade> = self.grade.scenes().filter(|scene| !is_told(scene)).collect();
        if !rest.is_empty() {
            let accepted = rest.iter().filter(|scene| scene.verdict.is_accepted()).count() as u64;
            let missing = rest.len() as u64 - accepted;
            let mut words = format!("{} accepted", counted(accepted, "scene"));
            if missing > 0 {
                let _ = write!(words, ", {missing} not run");
            }
            let _ = write!(
                out,
                "<h2>The other scenes</h2>\n<details class=\"table\"><summary>{words}</summary>\n\
                 <table><thead><tr><th scope=\"col\">scene</th><th scope=\"col\">verdict</th><th scope=\"col\">points</th>\
                 </tr></thead><tbody>\n"
            );
            for scene in rest {
                let _ = writeln!(
                    out,
                    "<tr><th scope=\"row\">{}</th><td>{}</td><td class=\"num\">{} of {}</td></tr>",
                    text(&one_line(&scene.scene)),
                    scene.verdict.words(),
                    reached(scene.points),
                    points(scene.max_points)
                );
            }
            out += "</tbody></table></details>\n";
        }
        out
    }
}

/// The book that counts.
fn books(grade: &Grade) -> String {
    let other = counted(grade.differing() as u64, "scene");
    match (grade.rules, grade.differing()) {
        (fosssim_judge::Rules::Parity, _) => "by the original's rules".to_owned(),
        (fosssim_judge::Rules::Fair, 0) => "by the fair rules".to_owned(),
        (fosssim_judge::Rules::Both, 0) => "by the original's rules; the fair ones agree".to_owned(),
        (fosssim_judge::Rules::Fair, _) => format!("by the fair rules; the original's differ in {other}"),
        (fosssim_judge::Rules::Both, _) => format!("by the original's rules; the fair ones differ in {other}"),
    }
}

/// Whether a scene has something to tell.
fn is_told(scene: &SceneGrade) -> bool {
    scene.verdict != Verdict::NotRun && (!scene.verdict.is_accepted() || scene.differs.is_some())
}

fn groups(groups: &[GroupGrade]) -> String {
    let mut out = String::from(
        "<h2>Groups</h2>\n<table><thead><tr><th scope=\"col\">group</th><th scope=\"col\">verdict</th>\
         <th scope=\"col\">points</th><th scope=\"col\">scenes accepted</th><th scope=\"col\">who sees it</th></tr></thead><tbody>\n",
    );
    for group in groups {
        let accepted = group.scenes.iter().filter(|scene| scene.verdict.is_accepted()).count();
        let _ = writeln!(
            out,
            "<tr><th scope=\"row\">{}</th><td class=\"{}\">{}</td><td class=\"num\">{} of {}</td><td class=\"num\">{accepted} \
             of {}</td><td>{}</td></tr>",
            text(&one_line(&group.name)),
            if group.verdict.is_accepted() { "good" } else { "bad" },
            group.verdict.words(),
            reached(group.points),
            points(group.max_points),
            group.scenes.len(),
            match group.visibility {
                Visibility::Visible => "everybody",
                Visibility::Hidden => "staff",
                Visibility::AfterDueDate => "students after the due date",
                Visibility::AfterPublished => "students once grades are out",
            }
        );
    }
    out + "</tbody></table>\n"
}

/// What of each card has room: words always, then pictures in the order of the scenes, then motions.
fn share_out(cards: &[Option<Card>]) -> Vec<Room> {
    let mut rooms = vec![Room::Words; cards.len()];
    let mut left = BUDGET - 2 * super::SCRIPT.len() - OUTPUTS - 1_000 * cards.len().min(1_000);
    let mut still = STILL.min(left);
    for (card, room) in cards.iter().zip(&mut rooms) {
        let Some((html, _)) = card.as_ref().map(Card::sizes) else { continue };
        if html <= still {
            (still, left, *room) = (still - html, left - html, Room::Pictures);
        }
    }
    for (card, room) in cards.iter().zip(&mut rooms).filter(|(_, room)| **room == Room::Pictures) {
        let Some((_, data)) = card.as_ref().map(Card::sizes) else { continue };
        if data <= left {
            (left, *room) = (left - data, Room::All);
        }
    }
    rooms
}

/// What the page says of what has no room on it.
fn left_out(cards: &[Option<Card>], rooms: &[Room]) -> String {
    let has = |card: &Option<Card>| card.as_ref().is_some_and(|card| card.sizes().1 > 0);
    let short = cards.iter().zip(rooms).filter(|(card, room)| has(card) && **room < Room::All).count() as u64;
    if short == 0 {
        return String::new();
    }
    format!(
        "<p class=\"hint\">The page would grow beyond 3 MB: {} without the motion here, which each of them says. \
         <code>grade --scene NAME --format html=FILE</code> makes a page of one scene.</p>\n",
        if short == 1 { "one scene is".to_owned() } else { format!("{short} scenes are") }
    )
}

fn article(
    scene: &SceneGrade,
    likely: &[Explanation],
    (card, room): (Option<&Card>, Room),
    open: bool,
    outputs: &mut usize,
) -> String {
    let key = key(&scene.scene);
    let look = if scene.verdict.is_accepted() { "good" } else { "bad" };
    let mut out = format!(
        "<article class=\"case\" id=\"scene-{key}\" data-case=\"{key}\" data-scene=\"{}\" aria-labelledby=\"title-{key}\">\n\
         <details class=\"card\"{}><summary><h3 id=\"title-{key}\"><span class=\"{look}\">{}</span> {}</h3> \
         <span class=\"hint\">{} of {} points. {}</span></summary>\n",
        text(&scene.scene),
        if open { " open" } else { "" },
        scene.verdict.code(),
        text(&one_line(&scene.scene)),
        reached(scene.points),
        points(scene.max_points),
        text(&one_line(&words::summary(scene))),
    );
    let lines: Vec<String> = difference(scene).into_iter().chain(words::details(scene)).collect();
    if !lines.is_empty() {
        let _ = writeln!(
            out,
            "<ul>{}</ul>",
            lines.iter().map(|line| format!("<li>{}</li>", text(line))).collect::<String>()
        );
    }
    out += &over_all(scene, likely);
    out += &mistakes(&scene.explanations);
    match (card, room) {
        (None, _) => {}
        (Some(card), Room::Words) if card.sizes().0 > 0 => {
            out += "<p class=\"hint\">The pictures and the motion have no room on this page.</p>\n";
        }
        (Some(card), _) => {
            let html = card.html(&key);
            if room == Room::Pictures && card.sizes().1 > 0 {
                out += "<p class=\"hint\">The motion has no room on this page.</p>\n";
            }
            out += &html;
        }
    }
    out += &printed("Standard output", &scene.stdout, outputs);
    out += &printed("Standard error", &scene.stderr, outputs);
    out += "</details>\n";
    if let (Some(card), Room::All) = (card, room) {
        out += &card.data(&key);
    }
    out + "</article>\n"
}

/// Which of the submission's likely mistakes is meant where a scene alone can't tell it apart from another, which is told first.
fn over_all(scene: &SceneGrade, likely: &[Explanation]) -> String {
    let meant = likely.iter().find(|one| one.is_named_in(&scene.explanations));
    let first = scene.explanations.first();
    match (meant, first) {
        (Some(meant), Some(first)) if meant.key != first.key => format!(
            "<p>All scenes together: <strong>{}</strong> This one alone does not tell it from the following:</p>\n",
            text(&meant.what)
        ),
        _ => String::new(),
    }
}

/// A key that another scene's name does not have.
pub(super) fn key(name: &str) -> String {
    Sha256::digest(name.as_bytes())[..6].iter().map(|byte| format!("{byte:02x}")).collect()
}

/// What a program printed, as far as there is room.
fn printed(heading: &str, output: &str, room: &mut usize) -> String {
    if output.trim().is_empty() || *room == 0 {
        return String::new();
    }
    let shown: String = output.chars().take(OUTPUT).collect();
    let cut = if shown.len() < output.len() { "\n[cut short]" } else { "" };
    // Hostile text grows when it is written out: what counts is its length on the page.
    let shown = text(&shown);
    if shown.len() > *room {
        *room = 0;
        return "<p class=\"hint\">What programs printed in this scene and in the next ones has no room on this page.</p>\n".to_owned();
    }
    *room -= shown.len();
    format!(
        "<details class=\"table\"><summary>{heading}</summary><pre tabindex=\"0\" role=\"region\" \
         aria-label=\"{heading}\">{shown}{cut}</pre></details>\n"
    )
}
