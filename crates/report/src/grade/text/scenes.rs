//! The scenes of a submission, group by group: what is accepted is counted, what is not is told, and what is told of
//! many scenes in the same words is told once.
use super::{Text, TextDetail, look, output, some};
use crate::foreign::one_line;
use crate::{
    explain,
    grade::{difference, points, reached, text::SHOWN_LINES},
    number::counted,
    style::Look,
    words,
    wrap::columns,
};
use fosssim_findings::{Grade, GroupGrade, SceneGrade, Verdict};
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Write,
};

/// The greatest number of scenes named that end the same way.
const NAMED: usize = 3;

/// The groups that have something to show.
pub(super) fn render(options: &Text<'_>, grade: &Grade) -> String {
    // A fault of the submission itself is not said of each scene.
    if options.shown < TextDetail::Wrong || grade.unfit().is_some() {
        return String::new();
    }
    let shown = |scene: &SceneGrade| options.shown == TextDetail::All || !scene.verdict.is_accepted();
    let names = grade.scenes().filter(|scene| shown(scene)).map(|scene| columns(&one_line(&scene.scene)));
    let width = names.max().unwrap_or(0);
    let mut scenes = Scenes { options, width, mistakes: BTreeSet::new(), alike: alike(grade) };
    let groups = grade.groups.iter().filter(|group| group.scenes.iter().any(shown));
    groups.map(|group| scenes.group(group)).collect()
}

/// The words about a scene whose program failed: scenes with the same words are listed once.
type Words = (Verdict, String, Vec<String>);

/// A wrong trace differs from scene to scene; a program that does not run ends in the same words each time.
fn told(scene: &SceneGrade) -> Option<Words> {
    let fails = !matches!(scene.verdict, Verdict::Accepted | Verdict::WrongAnswer | Verdict::BadTrace);
    // Where nothing is logged, it does not matter where that shows first.
    let details = || if scene.verdict == Verdict::Unwritten { Vec::new() } else { words::details(scene) };
    fails.then(|| (scene.verdict, words::ending(scene), details()))
}

/// The scenes of which the same is told.
fn alike(grade: &Grade) -> BTreeMap<Words, Vec<&str>> {
    let mut alike: BTreeMap<Words, Vec<&str>> = BTreeMap::new();
    for scene in grade.scenes() {
        if let Some(words) = told(scene) {
            alike.entry(words).or_default().push(&scene.scene);
        }
    }
    alike
}

struct Scenes<'a, 'b> {
    options: &'b Text<'b>,
    /// Columns of the longest name.
    width: usize,
    /// Sentences of mistakes that have been told in full.
    mistakes: BTreeSet<String>,
    alike: BTreeMap<Words, Vec<&'a str>>,
}

impl<'a> Scenes<'a, '_> {
    fn group(&mut self, group: &'a GroupGrade) -> String {
        let style = self.options.style;
        let name = style.paint(Look::Strong, &one_line(&group.name));
        let extra = if group.extra { " extra" } else { "" };
        let mut text = format!("\n{name} ({} of {}{extra})\n", reached(group.points), points(group.max_points));
        let accepted = group.scenes.iter().filter(|scene| scene.verdict.is_accepted()).count();
        let folds = self.options.shown < TextDetail::All;
        if folds && accepted > 0 {
            let code = style.paint(Look::Good, "AC ");
            let _ = writeln!(text, "  {code} {}", counted(accepted as u64, "scene"));
        }
        for scene in &group.scenes {
            if !(folds && scene.verdict.is_accepted()) {
                text += &self.scene(scene, folds);
            }
        }
        text
    }

    fn scene(&mut self, scene: &'a SceneGrade, folds: bool) -> String {
        // The first one tells it for all that are alike.
        let first = told(scene).and_then(|words| self.alike.get(&words)?.first().copied());
        let is_first = first.is_none_or(|first| std::ptr::eq(first, scene.scene.as_str()));
        let mut text = String::new();
        if is_first || !folds {
            text += &self.row(scene);
        }
        if is_first {
            text += &self.details(scene);
        }
        text
    }

    fn row(&self, scene: &SceneGrade) -> String {
        let (name, style) = (one_line(&scene.scene), self.options.style);
        let code = style.paint(look(scene.verdict), &format!("{:<3}", scene.verdict.code()));
        let blanks = " ".repeat(self.width.saturating_sub(columns(&name)));
        format!("  {code} {name}{blanks}  {} of {}\n", reached(scene.points), points(scene.max_points))
    }

    fn details(&mut self, scene: &SceneGrade) -> String {
        let mut lines = Vec::new();
        if !scene.verdict.is_accepted() {
            lines.push(one_line(&words::summary(scene)));
        }
        lines.extend(difference(scene));
        if scene.verdict != Verdict::Unwritten {
            lines.extend(words::details(scene).iter().map(|line| one_line(line)));
        }
        lines.extend(explain::lines_once(&scene.settled, &mut self.mistakes).iter().map(|line| one_line(line)));
        let alike = told(scene).and_then(|words| self.alike.get(&words)).map_or(&[][..], |names| &names[1..]);
        if !alike.is_empty() {
            let (many, names) = (counted(alike.len() as u64, "more scene"), some(alike, NAMED));
            lines.push(format!("the same in {many}: {names}"));
        }
        let mut text: String = lines.iter().map(|line| format!("      {line}\n")).collect();
        if scene.verdict >= Verdict::NoOutput && !scene.stderr.trim().is_empty() {
            let _ = writeln!(text, "      its error output:\n{}", output(&scene.stderr, SHOWN_LINES));
        }
        text
    }
}
