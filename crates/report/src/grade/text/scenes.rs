//! The scenes of a submission, group by group. Accepted scenes are only counted. If scenes fail for the same cause,
//! only one of them is described.
use super::{super::phrases::list_first, Text, TextDetail, quote_output, verdict_style};
use crate::untrusted_text::to_one_line;
use crate::{
    grade::{
        AlikeScenes, describe_difference, format_optional_points, format_points, group_by_cause, scene_lines,
        scene_sentence, text::MAX_SHOWN_LINES,
    },
    line_width::count_columns,
    number::format_count,
    style::TextStyle,
    words,
};
use fosssim_findings::{Grade, GroupGrade, SceneGrade, Verdict};
use std::{collections::BTreeMap, fmt::Write};

/// The maximum number of causes that are described with an example. Further causes get only a sentence, unless every
/// scene is shown.
const MAX_DESCRIBED: usize = 3;

/// The maximum number of scenes that are named if they end in the same way.
const MAX_NAMED: usize = 3;

/// Renders the groups that have something to show.
pub(super) fn render(options: &Text<'_>, grade: &Grade) -> String {
    // A fault of the whole submission is reported once, and not for each scene.
    if options.detail < TextDetail::Wrong || grade.submission_fault().is_some() {
        return String::new();
    }
    let is_shown = |scene: &SceneGrade| options.detail == TextDetail::All || !scene.verdict.is_accepted();
    let names = grade.scenes().filter(|scene| is_shown(scene)).map(|scene| count_columns(&to_one_line(&scene.scene)));
    let width = names.max().unwrap_or(0);
    let scenes = Scenes { options, width, scenes_by_cause: group_by_cause(grade) };
    // The closing lines count the scenes that were not run.
    let has_news = |scene: &SceneGrade| is_shown(scene) && (options.detail == TextDetail::All || !was_skipped(scene));
    let groups = grade.groups.iter().filter(|group| group.scenes.iter().any(has_news));
    let mut text: String = groups.map(|group| scenes.render_group(group)).collect();
    if scenes.scenes_by_cause.len() > MAX_DESCRIBED && options.detail < TextDetail::All {
        text += "\nExamples of all causes: -v\n";
    }
    text
}

/// Returns whether the program was not started on a scene, so that only the reason can be reported.
fn was_skipped(scene: &SceneGrade) -> bool {
    scene.verdict == Verdict::NotRun && scene.measured.wall.is_zero()
}

struct Scenes<'a, 'b> {
    options: &'b Text<'b>,
    /// The width of the longest scene name, in columns.
    width: usize,
    scenes_by_cause: Vec<AlikeScenes<'a>>,
}

impl<'a> Scenes<'a, '_> {
    fn render_group(&self, group: &'a GroupGrade) -> String {
        let style = self.options.style;
        let name = style.paint(TextStyle::Strong, &to_one_line(&group.name));
        let extra = if group.extra { " extra" } else { "" };
        let mut text = format!(
            "\n{name} ({} of {}{extra})\n",
            format_optional_points(group.points),
            format_points(group.max_points)
        );
        if let Some(note) = &group.note {
            text += &format!("  {}\n", to_one_line(&note.to_string()));
        }
        let mut folded: BTreeMap<(Verdict, String), u64> = BTreeMap::new();
        for scene in group.scenes.iter().filter(|scene| self.is_folded(scene)) {
            let example = self.alike_scenes(scene).first().filter(|_| !scene.verdict.is_accepted());
            let like = match example {
                _ if was_skipped(scene) => format!(", {}", to_one_line(&words::summarize(scene))),
                example => example.map_or_else(String::new, |example| format!(" like {}", to_one_line(&example.scene))),
            };
            *folded.entry((scene.verdict, like)).or_default() += 1;
        }
        let row = |((verdict, like), count): ((Verdict, String), u64)| {
            let code = style.paint(verdict_style(verdict), &format!("{:<3}", verdict.code()));
            format!("  {code} {}{like}\n", format_count(count, "scene"))
        };
        if folded.first_key_value().is_some_and(|((verdict, _), _)| verdict.is_accepted()) {
            text.extend(folded.pop_first().map(row));
        }
        for scene in group.scenes.iter().filter(|scene| !self.is_folded(scene)) {
            text += &self.render_row(scene);
            text += &self.render_details(scene);
        }
        text.extend(folded.into_iter().map(row));
        text
    }

    /// Returns whether a scene is only counted, because it is accepted, was not run, or has the same cause as another
    /// scene that is described.
    fn is_folded(&self, scene: &SceneGrade) -> bool {
        self.options.detail < TextDetail::All
            && (scene.verdict.is_accepted()
                || was_skipped(scene)
                || self.alike_scenes(scene).first().is_some_and(|first| first.scene != scene.scene))
    }

    /// Returns the scenes whose verdicts have the same cause as this scene's.
    fn alike_scenes(&self, scene: &SceneGrade) -> &[&'a SceneGrade] {
        let is_in = |scenes: &&AlikeScenes<'_>| scenes.iter().any(|scene_grade| scene_grade.scene == scene.scene);
        self.scenes_by_cause.iter().find(is_in).map_or(&[][..], Vec::as_slice)
    }

    /// Returns whether the scene's cause is one of those that are described with an example.
    fn is_shown(&self, scene: &SceneGrade) -> bool {
        let mut causes = self.scenes_by_cause.iter().take(MAX_DESCRIBED);
        self.options.detail == TextDetail::All || causes.any(|alike| alike[0].scene == scene.scene)
    }

    fn render_row(&self, scene: &SceneGrade) -> String {
        let (name, style) = (to_one_line(&scene.scene), self.options.style);
        let code = style.paint(verdict_style(scene.verdict), &format!("{:<3}", scene.verdict.code()));
        let blanks = " ".repeat(self.width.saturating_sub(count_columns(&name)));
        format!(
            "  {code} {name}{blanks}  {} of {}\n",
            format_optional_points(scene.points),
            format_points(scene.max_points)
        )
    }

    fn render_details(&self, scene: &SceneGrade) -> String {
        let mut lines = Vec::new();
        if !scene.verdict.is_accepted() {
            lines.push(to_one_line(&words::summarize(scene)));
        }
        lines.extend(describe_difference(scene));
        if self.is_shown(scene) {
            let details = if scene.verdict == Verdict::Unwritten { Vec::new() } else { words::list_details(scene) };
            let likely = scene_lines(scene, self.options.style);
            lines.extend(details.iter().chain(&likely).map(|line| to_one_line(line)));
        } else {
            lines.extend(scene_sentence(scene).map(|sentence| to_one_line(&sentence)));
        }
        if let [first, alike @ ..] = self.alike_scenes(scene)
            && first.scene == scene.scene
            && !alike.is_empty()
        {
            let names: Vec<&str> = alike.iter().map(|scene_grade| scene_grade.scene.as_str()).collect();
            let (many, names) = (format_count(alike.len() as u64, "more scene"), list_first(&names, MAX_NAMED));
            lines.push(format!("the same in {many}: {names}"));
        }
        let mut text: String = lines.iter().map(|line| format!("      {line}\n")).collect();
        if scene.verdict >= Verdict::NoOutput && !scene.stderr.trim().is_empty() {
            let _ = writeln!(text, "      its standard error:\n{}", quote_output(&scene.stderr, MAX_SHOWN_LINES));
        }
        text
    }
}
