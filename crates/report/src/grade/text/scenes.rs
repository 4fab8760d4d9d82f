//! The scenes of a submission, group by group. Accepted scenes are counted. Scenes that fail for the same cause are
//! described once.
use super::{super::phrases::some, Text, TextDetail, output, verdict_look};
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
use std::{collections::BTreeMap, fmt::Write};

/// The greatest number of scenes named that end the same way.
const NAMED: usize = 3;

/// Renders the groups that have something to show.
pub(super) fn render(options: &Text<'_>, grade: &Grade) -> String {
    // A fault of the submission itself is not repeated for each scene.
    if options.shown < TextDetail::Wrong || grade.unfit().is_some() {
        return String::new();
    }
    let shown = |scene: &SceneGrade| options.shown == TextDetail::All || !scene.verdict.is_accepted();
    let names = grade.scenes().filter(|scene| shown(scene)).map(|scene| columns(&one_line(&scene.scene)));
    let width = names.max().unwrap_or(0);
    let scenes = Scenes { options, width, by_cause: by_cause(grade) };
    let groups = grade.groups.iter().filter(|group| group.scenes.iter().any(shown));
    groups.map(|group| scenes.group(group)).collect()
}

/// The cause of a scene's verdict, in words. Scenes with the same cause are described once.
type SceneCause = (Verdict, Vec<String>);

/// Returns the cause of a scene that is not accepted: the end of its program, its likely mistakes, or the kind of the
/// first finding. A scene that the rule books judge differently has a cause of its own.
fn cause(scene: &SceneGrade) -> Option<SceneCause> {
    if scene.verdict.is_accepted() || scene.differs.is_some() {
        return None;
    }
    if !matches!(scene.verdict, Verdict::WrongAnswer | Verdict::BadTrace) {
        // If nothing is logged, the first place where that shows does not matter.
        let details = if scene.verdict == Verdict::Unwritten { Vec::new() } else { words::details(scene) };
        return Some((scene.verdict, std::iter::once(words::ending(scene)).chain(details).collect()));
    }
    if scene.settled.is_empty() {
        let first = scene.disclosure.as_ref()?.official().first_divergence.as_ref()?;
        return Some((scene.verdict, vec![format!("{:?}", first.kind())]));
    }
    Some((scene.verdict, scene.settled.iter().map(words::explanation::what).collect()))
}

/// Returns the scenes of each cause.
fn by_cause(grade: &Grade) -> BTreeMap<SceneCause, Vec<&str>> {
    let mut scenes: BTreeMap<SceneCause, Vec<&str>> = BTreeMap::new();
    for scene in grade.scenes() {
        if let Some(cause) = cause(scene) {
            scenes.entry(cause).or_default().push(&scene.scene);
        }
    }
    scenes
}

struct Scenes<'a, 'b> {
    options: &'b Text<'b>,
    /// Columns of the longest name.
    width: usize,
    by_cause: BTreeMap<SceneCause, Vec<&'a str>>,
}

impl<'a> Scenes<'a, '_> {
    fn group(&self, group: &'a GroupGrade) -> String {
        let style = self.options.style;
        let name = style.paint(Look::Strong, &one_line(&group.name));
        let extra = if group.extra { " extra" } else { "" };
        let mut text = format!("\n{name} ({} of {}{extra})\n", reached(group.points), points(group.max_points));
        if let Some(note) = &group.note {
            text += &format!("  {}\n", one_line(&note.to_string()));
        }
        let mut folded: BTreeMap<Verdict, u64> = BTreeMap::new();
        for scene in group.scenes.iter().filter(|scene| self.is_folded(scene)) {
            *folded.entry(scene.verdict).or_default() += 1;
        }
        let row = |verdict: Verdict, count: u64, above: &str| {
            let code = style.paint(verdict_look(verdict), &format!("{:<3}", verdict.code()));
            format!("  {code} {}{above}\n", counted(count, "scene"))
        };
        if let Some(accepted) = folded.remove(&Verdict::Accepted) {
            text += &row(Verdict::Accepted, accepted, "");
        }
        for scene in group.scenes.iter().filter(|scene| !self.is_folded(scene)) {
            text += &self.row(scene);
            text += &self.details(scene);
        }
        text.extend(folded.into_iter().map(|(verdict, count)| row(verdict, count, " as above")));
        text
    }

    /// Returns whether a scene is only counted: it is accepted, or another one with its cause is described.
    fn is_folded(&self, scene: &SceneGrade) -> bool {
        self.options.shown < TextDetail::All
            && (scene.verdict.is_accepted() || self.alike(scene).first().is_some_and(|first| *first != scene.scene))
    }

    /// Returns the scenes with the cause of this one, in order.
    fn alike(&self, scene: &SceneGrade) -> &[&'a str] {
        cause(scene).and_then(|cause| self.by_cause.get(&cause)).map_or(&[][..], Vec::as_slice)
    }

    fn row(&self, scene: &SceneGrade) -> String {
        let (name, style) = (one_line(&scene.scene), self.options.style);
        let code = style.paint(verdict_look(scene.verdict), &format!("{:<3}", scene.verdict.code()));
        let blanks = " ".repeat(self.width.saturating_sub(columns(&name)));
        format!("  {code} {name}{blanks}  {} of {}\n", reached(scene.points), points(scene.max_points))
    }

    fn details(&self, scene: &SceneGrade) -> String {
        let mut lines = Vec::new();
        if !scene.verdict.is_accepted() {
            lines.push(one_line(&words::summary(scene)));
        }
        lines.extend(difference(scene));
        if scene.verdict != Verdict::Unwritten {
            lines.extend(words::details(scene).iter().map(|line| one_line(line)));
        }
        lines.extend(explain::lines(&scene.settled, self.options.style).iter().map(|line| one_line(line)));
        if let [first, alike @ ..] = self.alike(scene)
            && *first == scene.scene
            && !alike.is_empty()
        {
            let (many, names) = (counted(alike.len() as u64, "more scene"), some(alike, NAMED));
            lines.push(format!("the same in {many}: {names}"));
        }
        let mut text: String = lines.iter().map(|line| format!("      {line}\n")).collect();
        if scene.verdict >= Verdict::NoOutput && !scene.stderr.trim().is_empty() {
            let _ = writeln!(text, "      its standard error:\n{}", output(&scene.stderr, SHOWN_LINES));
        }
        text
    }
}
