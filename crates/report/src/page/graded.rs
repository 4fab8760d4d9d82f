//! The page of one submission: its points, its likely mistakes, and a card per scene.
use super::{
    Card,
    case::mistakes,
    document,
    markup::{note, table, text},
    room::{self, OUTPUTS, Room},
    script, smallest,
};
use crate::foreign::{one_line, without_codes};
use crate::{
    grade::{
        change_lines, difference, extra, likely_mistakes, no_points, points, reached, score, speed_words, worth,
        wrong_scenes,
    },
    number::counted,
    words,
};
use fosssim_findings::{Grade, GroupGrade, SceneGrade, Verdict, Visibility, located::LocatedFailure};
use fosssim_mistakes::diagnose::{Explanation, is_named_in};
use fosssim_mistakes::together::for_students;
use sha2::{Digest, Sha256};
use std::{borrow::Cow, fmt::Write};

/// The greatest number of characters shown of a program's output in a scene.
const OUTPUT: usize = 2_000;

/// The readers of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Audience {
    /// Staff: every group is on it, with the word who sees it.
    #[default]
    Staff,
    /// The student: the page has only groups that students see immediately, and what follows from these.
    Student,
}

/// One submission's grade with the pictures of its traces.
#[derive(Clone, Copy)]
pub struct GradePage<'a> {
    /// The grade.
    pub grade: &'a Grade,
    /// The card of this name, where it was kept.
    pub card: &'a dyn Fn(Option<&str>) -> Option<Card>,
    /// The address of the class's page, relative to this one.
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
        let told = self.cards(grade);
        let mut body = self.head(grade, &told);
        let has_scenes = grade.unfit().is_none();
        if has_scenes {
            body += &self.smallest(grade);
            body += &scenes(grade, &told);
        }
        // The viewer is most of a page without cards.
        let script = if has_scenes && !told.is_empty() { script() } else { "" };
        document(&format!("{}: {}", grade.submission, grade.verdict.name()), &body, script)
    }

    /// Renders the smallest scenes.
    fn smallest(&self, grade: &Grade) -> String {
        let all = grade.smallest.iter().zip(1..);
        let all: String = all
            .map(|(small, number)| smallest::article(small, (self.card)(small.card.as_deref()).as_ref(), number))
            .collect();
        if all.is_empty() { all } else { format!("<h2>The smallest scenes on which it is wrong</h2>\n{all}") }
    }

    /// Returns the scenes that have a card, the clearest first and the others in their order.
    fn cards<'g>(&self, grade: &'g Grade) -> Vec<(&'g SceneGrade, Option<Card>)> {
        let scenes = grade.scenes().filter(|scene| is_told(scene));
        let mut told: Vec<_> = scenes.map(|scene| (scene, (self.card)(scene.card.as_deref()))).collect();
        let likely = likely(grade);
        let first = (0..told.len()).min_by_key(|&place| telling(told[place].0, told[place].1.as_ref(), &likely));
        if let Some(first) = first {
            told[..=first].rotate_right(1);
        }
        told
    }

    fn head(&self, grade: &Grade, told: &[(&SceneGrade, Option<Card>)]) -> String {
        let look = if grade.verdict.is_accepted() { "good" } else { "bad" };
        let reached = match grade.points {
            Some(reached) => score(reached, grade.max_points) + &extra(grade),
            None => no_points(grade).unwrap_or_default(),
        };
        let mut out = String::new();
        if let Some(class) = self.class {
            let _ = writeln!(out, "<p><a href=\"{}\">The class</a></p>", text(class));
        }
        let _ = writeln!(
            out,
            "<h1>{}: <span class=\"chip {look}\">{}</span> {}</h1>\n<p class=\"names\">suite {}, {}</p>",
            text(&one_line(&grade.submission)),
            grade.verdict.name(),
            text(&reached),
            text(&one_line(&grade.suite)),
            text(&books(grade)),
        );
        for warning in &grade.warnings {
            let _ = writeln!(out, "<p class=\"bad\">Warning: {}</p>", text(warning));
        }
        if !grade.same_program.is_empty() {
            let names = one_line(&grade.same_program.join(", "));
            let _ = writeln!(out, "<p>The same program, byte for byte: {}</p>", text(&names));
        }
        if let Some(build) = grade.failed_build() {
            let _ = writeln!(out, "<h2>The build</h2>\n<p>{}</p>", text(&words::build(&build.end)));
            out += &printed("What it printed", &build.output, &mut OUTPUTS.clone());
        } else if let Some(unfit) = words::unfit(grade) {
            let _ = writeln!(out, "<p>{}</p>", text(&unfit));
        }
        if self.reader == Audience::Student && grade.groups.len() < self.grade.groups.len() {
            out += "<p class=\"hint\">Points, verdict and likely mistakes are those of the groups on this page. The grade has \
                    others, too.</p>\n";
        }
        let changes: String = change_lines(grade).iter().map(|(_, line)| format!("<li>{}</li>", text(line))).collect();
        if !changes.is_empty() {
            let _ = writeln!(out, "<h2>Since the earlier grading</h2>\n<ul class=\"card\">{changes}</ul>");
        }
        out.extend(grade.located.as_ref().map(located));
        out += "<div class=\"split halves\">\n";
        // A fault of the submission itself explains everything.
        let likely = if grade.unfit().is_some() { Vec::new() } else { likely_mistakes(grade) };
        if !likely.is_empty() {
            let wrong = wrong_scenes(grade);
            let plural = if likely.len() == 1 { "" } else { "s" };
            let _ = writeln!(out, "<section>\n<h2>Likely mistake{plural}</h2>\n<div class=\"mistakes\">");
            for (mistake, explained) in likely {
                let named: Vec<_> =
                    told.iter().filter(|(scene, _)| is_named_in(&mistake, &scene.explanations)).collect();
                let shows = named
                    .iter()
                    .min_by_key(|(scene, card)| telling(scene, card.as_ref(), std::slice::from_ref(&mistake)));
                let verb = if mistake.is_unexplained() { "In" } else { "Explains" };
                let forms = words::explanation::forms(&mistake);
                let _ = writeln!(
                    out,
                    "<section class=\"card mistake\"><p class=\"lead\">{}</p>{}<p>{verb} {explained} of \
                    {wrong}.{}{}{}</p></section>",
                    text(&words::explanation::what_or(&mistake)),
                    forms.iter().map(|form| format!("<p>{}</p>", text(form))).collect::<String>(),
                    worth(grade, &mistake).map_or_else(String::new, |worth| format!(" Mending it is {worth}.")),
                    shows.map_or_else(String::new, |(scene, _)| format!(" Look at it in {}.", link(scene))),
                    note(grade.note(&mistake)),
                );
            }
            out += "</div></section>\n";
        }
        out + &groups(&grade.groups, told, self.reader) + "</div>\n"
    }
}

/// Returns the common properties of scenes in which a program fails.
pub(super) fn located(found: &LocatedFailure) -> String {
    let words = text(&one_line(&words::located(found)));
    format!("<h2>Where it fails</h2>\n<div class=\"card mistake\"><p class=\"lead\">{words}</p></div>\n")
}

/// Returns the likely mistakes of all scenes together.
fn likely(grade: &Grade) -> Vec<Explanation> {
    likely_mistakes(grade).into_iter().map(|(mistake, _)| mistake).collect()
}

/// Returns the rank of a scene among those to read first; the smallest rank comes first. The rank counts in this order:
/// whether nothing was drawn; whether the rule books differ, so that it may be a consequence or round-off; which of the
/// likely mistakes explains it, if any; how many other mistakes would have the same effect there; how large its motion
/// is.
fn telling(scene: &SceneGrade, card: Option<&Card>, likely: &[Explanation]) -> (bool, bool, usize, usize, usize) {
    let own = &scene.explanations;
    (card.is_none(), scene.differs.is_some(), rank(likely, own), own.len(), card.map_or(0, |card| card.sizes().1))
}

/// Returns the rank of the first of the likely mistakes among some explanations; other explanations come after all of
/// them, and none at all comes last.
pub(super) fn rank(likely: &[Explanation], own: &[Explanation]) -> usize {
    let named = likely.iter().position(|one| is_named_in(one, own));
    named.unwrap_or(likely.len() + usize::from(own.is_empty()))
}

/// Returns a link to a scene's card.
fn link(scene: &SceneGrade) -> String {
    format!("<a href=\"#scene-{}\">{}</a>", key(&scene.scene), text(&one_line(&scene.scene)))
}

fn scenes(grade: &Grade, told: &[(&SceneGrade, Option<Card>)]) -> String {
    let rooms = room::share_out(told.iter().map(|(_, card)| card.as_ref()));
    let mut out = String::new();
    if !told.is_empty() {
        out += "<h2>Scenes to look at</h2>\n";
    }
    out += &room::left_out(told.iter().map(|(_, card)| card.as_ref()), &rooms);
    let mut outputs = if grade.shows_output { OUTPUTS } else { 0 };
    for (number, ((scene, card), room)) in told.iter().zip(&rooms).enumerate() {
        out += &article(scene, (card.as_ref(), *room), number == 0, &mut outputs);
    }
    let rest: Vec<&SceneGrade> = grade.scenes().filter(|scene| !is_told(scene)).collect();
    if rest.is_empty() {
        return out;
    }
    let accepted = rest.iter().filter(|scene| scene.verdict.is_accepted()).count() as u64;
    let missing = rest.len() as u64 - accepted;
    let mut words = format!("{} accepted", counted(accepted, "scene"));
    if missing > 0 {
        let _ = write!(words, ", {missing} not run");
    }
    let _ = writeln!(out, "<h2>The other scenes</h2>\n<details class=\"table\"><summary>{words}</summary>");
    out += &table("scroll", "Other scenes", "", &["scene", "verdict", "points"]);
    for scene in rest {
        let _ = writeln!(
            out,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td class=\"num\">{} of {}</td></tr>",
            text(&one_line(&scene.scene)),
            scene.verdict.name(),
            reached(scene.points),
            points(scene.max_points)
        );
    }
    out + "</tbody></table></div></details>\n"
}

/// Returns the book that counts.
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

/// Returns whether a scene has details to show.
fn is_told(scene: &SceneGrade) -> bool {
    scene.verdict != Verdict::NotRun && (!scene.verdict.is_accepted() || scene.differs.is_some())
}

fn groups(groups: &[GroupGrade], told: &[(&SceneGrade, Option<Card>)], reader: Audience) -> String {
    let tells_who = reader == Audience::Staff && groups.iter().any(|group| group.visibility != Visibility::Visible);
    let headings = ["group", "verdict", "#points", "#scenes accepted", "to look at", "who sees it"];
    let headings = if tells_who { &headings[..] } else { &headings[..5] };
    let mut out = "<section>\n<h2>Groups</h2>\n".to_owned() + &table("card scroll", "Groups", "stack", headings);
    for group in groups {
        let is_here = |scene: &SceneGrade| group.scenes.iter().any(|one| one.scene == scene.scene);
        let first = told.iter().find(|(scene, _)| is_here(scene)).map_or_else(String::new, |(scene, _)| link(scene));
        let who = match group.visibility {
            _ if !tells_who => String::new(),
            Visibility::Visible => "<td>everybody</td>".to_owned(),
            Visibility::Hidden => "<td>staff</td>".to_owned(),
            Visibility::AfterDueDate => "<td>students after the due date</td>".to_owned(),
            Visibility::AfterPublished => "<td>students once grades are out</td>".to_owned(),
        };
        let accepted = group.scenes.iter().filter(|scene| scene.verdict.is_accepted()).count();
        let _ = writeln!(
            out,
            "<tr><th scope=\"row\">{}</th><td><span class=\"chip {}\">{}</span></td>\
             <td class=\"num\" data-label=\"points\">{} of {}{}</td><td class=\"num\" data-label=\"scenes \
                 accepted\">{accepted} of {}</td><td class=\"to\">{first}</td>{who}</tr>",
            text(&one_line(&group.name)),
            if group.verdict.is_accepted() { "good" } else { "bad" },
            group.verdict.name(),
            reached(group.points),
            points(group.max_points),
            if group.extra { " extra" } else { "" },
            group.scenes.len(),
        );
        let columns = headings.len();
        if group.note.is_some() {
            let _ = writeln!(out, "<tr><td colspan=\"{columns}\">{}</td></tr>", note(group.note.as_ref()));
        }
        if let Some(speed) = &group.speed {
            let _ = writeln!(out, "<tr><td colspan=\"{columns}\">{}</td></tr>", text(&speed_words(speed)));
        }
    }
    out + "</tbody></table></div></section>\n"
}

fn article(scene: &SceneGrade, (card, room): (Option<&Card>, Room), open: bool, outputs: &mut usize) -> String {
    let key = key(&scene.scene);
    let look = if scene.verdict.is_accepted() { "good" } else { "bad" };
    let mut out = format!(
        "<article class=\"case\" id=\"scene-{key}\" data-case=\"{key}\" data-scene=\"{}\" aria-labelledby=\"title-{key}\">\n\
         <details class=\"scene\"{}><summary><h3 id=\"title-{key}\"><span class=\"chip {look}\">{}</span> {}</h3> \
         <span class=\"hint\">{} of {} points. {}</span></summary>\n",
        text(&scene.scene),
        if open { " open" } else { "" },
        scene.verdict.name(),
        text(&one_line(&scene.scene)),
        reached(scene.points),
        points(scene.max_points),
        text(&one_line(&words::summary(scene))),
    );
    // A detail that a card shows with its values is not repeated.
    let is_shown = room != Room::Words && card.is_some_and(Card::has_values);
    let details = words::details(scene).into_iter().skip(usize::from(is_shown));
    let lines: Vec<String> = difference(scene).into_iter().chain(details).collect();
    if !lines.is_empty() {
        let _ = writeln!(
            out,
            "<ul>{}</ul>",
            lines.iter().map(|line| format!("<li>{}</li>", text(line))).collect::<String>()
        );
    }
    let mistakes = mistakes(&scene.settled, is_shown);
    match (card, room) {
        (None, _) => out += &mistakes,
        (Some(card), Room::Words) if card.sizes().0 > 0 => {
            out += &mistakes;
            out += "<p class=\"hint\">This page has no room for the pictures and the motion.</p>\n";
        }
        (Some(card), _) => {
            if room == Room::Pictures && card.sizes().1 > 0 {
                out += "<p class=\"hint\">This page has no room for the motion.</p>\n";
            }
            out += &card.html(&key, &mistakes);
        }
    }
    out += &printed("Standard output", &scene.stdout, outputs);
    out += &printed("Standard error", &scene.stderr, outputs);
    out += "</details>\n";
    out += &match (card, room) {
        (Some(card), Room::Exact) => card.data(&key),
        (Some(card), Room::Rounded) => card.rounded(&key),
        _ => String::new(),
    };
    out + "</article>\n"
}

/// Returns a key that another scene's name does not have.
pub(super) fn key(name: &str) -> String {
    Sha256::digest(name.as_bytes())[..6].iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns the output of a program, cut to the room that is left.
fn printed(heading: &str, output: &str, room: &mut usize) -> String {
    if output.trim().is_empty() || *room == 0 {
        return String::new();
    }
    let output = without_codes(output);
    let shown: String = output.chars().take(OUTPUT).collect();
    let cut = if shown.len() < output.len() { "\n[cut short]" } else { "" };
    // Hostile text grows when it is written out: what counts is its length on the page.
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
