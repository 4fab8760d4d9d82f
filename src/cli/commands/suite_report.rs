//! The text that `suite check` prints: what a suite contains, and what to know before grading. The module also renders
//! the list of suites.
use super::visible_mistakes::{MAX_LISTED_SCENES, VisibleMistakes};
use crate::{
    judge::{PairText, PassText, Rules, fair::Borderline},
    report::{
        grade::format_points,
        number::format_count,
        style::{Style, TextStyle},
        untrusted_text::to_one_line,
        view::to_key,
    },
    sim::StepError,
    suite::{
        config::{Credit, Hints, SpeedMarking},
        coverage::{Coverage, FAMILIES},
        plan::{Plan, PlannedGroup, default_name},
    },
};
use serde_json::json;
use std::{collections::BTreeSet, fmt::Write};

/// A scene, and the decisions in it that round-off may change. If the scene cannot be simulated to its end, the second
/// part is the reason.
pub(super) type UndecidedScene = (String, Result<Vec<Borderline>, StepError>);

/// The maximum number of decisions that are listed for a scene.
const MAX_LISTED: usize = 3;

/// The contents of a suite's scenes, and the choice of lists in the report.
#[derive(Debug)]
pub(super) struct SuiteContents {
    /// The events in the suite's scenes.
    pub(super) coverage: Coverage,
    /// Whether the report lists the missing pairs of properties.
    pub(super) lists_missing: bool,
    /// The mistakes that no scene shows, by area of the assignment; empty if they were not requested.
    pub(super) visible_parts: Vec<VisibleMistakes>,
}

/// Renders the whole report. `undecided` has the scenes with decisions that round-off may change.
pub(super) fn render_text(plan: &Plan, contents: &SuiteContents, undecided: &[UndecidedScene], style: Style) -> String {
    let mut text = render_head(plan, style);
    for group in &plan.groups {
        text += &describe_group(group, style);
    }
    text += &describe_contents(contents, style);
    text += &describe_mistakes(&contents.visible_parts, style);
    let unknown = describe_unknown_features(plan, style);
    text += &unknown.concat();
    for (scene, found) in undecided {
        text += &describe_note(scene, found, style);
    }
    let notes = match undecided.len() + unknown.len() {
        0 => String::new(),
        notes => format!("; {} above", format_count(notes as u64, "note")),
    };
    let _ = writeln!(text, "\n{}: {}{notes}", style.paint(TextStyle::Right, "The suite is valid"), describe_size(plan));
    text
}

/// The version of the list in JSON. It increases if the meaning of a field changes.
const SCHEMA: u32 = 2;

/// Renders the list of built-in suites, one per line.
pub(super) fn list_suites(suites: &[(String, Plan)], style: Style) -> String {
    let width = suites.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let line = |(name, plan): &(String, Plan)| {
        let size = style.paint(TextStyle::Faint, &format!("({})", describe_size(plan)));
        let default = if *name == default_name() { ", the default" } else { "" };
        format!("{name:width$}  {}{default} {size}\n", plan.name)
    };
    suites.iter().map(line).collect()
}

/// Renders the list as one JSON object. `name` is the value for `--suite`, and `default` is the name of the default
/// suite.
pub(super) fn list_json(suites: &[(String, Plan)]) -> String {
    let group = |group: &PlannedGroup| {
        let PlannedGroup { name, scenes, marking, .. } = group;
        json!({ "name": name, "scenes": scenes.len(), "points": marking.points })
    };
    let entry = |(name, plan): &(String, Plan)| {
        let (suite, version) = name.split_once('@').unwrap_or((name, "1"));
        json!({
            "name": name,
            "suite": suite,
            "version": version.parse::<u32>().unwrap_or(1),
            "title": plan.name,
            "scenes": plan.scenes().count(),
            "points": plan.max_points(),
            "groups": plan.groups.iter().map(group).collect::<Vec<_>>(),
            "default": *name == default_name(),
        })
    };
    let list = json!({ "schema": SCHEMA, "suites": suites.iter().map(entry).collect::<Vec<_>>() });
    // This cannot fail, because plain values can always be serialized.
    serde_json::to_string_pretty(&list).unwrap_or_default() + "\n"
}

/// Describes the size of a plan, such as `12 scenes, 100 points`.
fn describe_size(plan: &Plan) -> String {
    format!("{}, {}", format_count(plan.scenes().count() as u64, "scene"), format_points_with_unit(plan.max_points()))
}

/// Formats points, such as `1 point` or `12.5 points`.
fn format_points_with_unit(value: f64) -> String {
    let number = format_points(value);
    let plural = if number == "1" { "" } else { "s" };
    format!("{number} point{plural}")
}

/// Describes what the choice of rule books means.
const fn describe_rules(rules: Rules) -> &'static str {
    match rules {
        Rules::Parity => "parity: the original's verdict counts, the fair rules are not applied",
        Rules::Fair => "fair: the fair rules' verdict counts",
        Rules::Both => "both: the original's verdict counts, reports say where the fair rules differ and why",
    }
}

/// Describes what the rule for partial credit means.
const fn describe_credit(credit: Credit) -> &'static str {
    match credit {
        Credit::Scenes => "credit per scene",
        Credit::Steps => "credit per step",
        Credit::All => "all or nothing",
    }
}

fn render_head(plan: &Plan, style: Style) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "{}: {}", style.paint(TextStyle::Strong, &to_one_line(&plan.name)), describe_size(plan));
    let _ = writeln!(text, "run: {}", to_one_line(&plan.command.join(" ")));
    if let Some(build) = &plan.build {
        let _ = writeln!(
            text,
            "build: {} (makes {}), {} s, {} MiB",
            to_one_line(&build.command.join(" ")),
            to_one_line(&build.program),
            build.wall.as_secs_f64(),
            build.memory >> 20
        );
    }
    let limits = &plan.limits;
    let _ = writeln!(
        text,
        "limits: {} s of processor, {} s on the clock, {} MiB of memory, {} MiB of output, {} MiB of trace",
        limits.cpu.as_secs_f64(),
        limits.wall.as_secs_f64(),
        limits.memory >> 20,
        limits.output >> 20,
        limits.trace >> 20,
    );
    let _ = writeln!(text, "programs: {}", plan.assignment().definition().title);
    let _ = writeln!(text, "rules: {}", describe_rules(plan.rules));
    let levels: BTreeSet<Hints> = plan.groups.iter().map(|group| group.marking.hints).collect();
    let several = levels.len() > 1;
    for level in levels {
        let (hints, meaning) = level.describe();
        let groups = plan.groups.iter().filter(|group| group.marking.hints == level);
        let groups: Vec<String> = groups.map(|group| to_one_line(&group.name)).collect();
        let suffix = if several { format!(" of {}", groups.join(", ")) } else { String::new() };
        let _ = writeln!(text, "hints for students{suffix}: {hints}: {meaning}");
    }
    text
}

fn describe_group(group: &PlannedGroup, style: Style) -> String {
    let marking = &group.marking;
    let (points, visibility) = (format_points_with_unit(marking.points), to_key(&marking.visibility).replace('_', " "));
    let name = style.paint(TextStyle::Strong, &to_one_line(&group.name));
    let (credit, hints) = (describe_credit(marking.credit), marking.hints.describe().0);
    let extra = if marking.is_extra { " extra" } else { "" };
    let mut text = format!("\n{name}: {points}{extra}, {credit}, {visibility}, hints {hints}\n");
    if let Some(SpeedMarking { points, full_at, none_at, runs }) = marking.speed {
        let (points, runs) = (format_points_with_unit(points), format_count(runs.into(), "run"));
        let _ = writeln!(
            text,
            "  speed: {points}, full points up to {full_at} times the reference's processor time, none from \
             {none_at} times; {runs}"
        );
    }
    for task in &group.scenes {
        let particles = format_count(task.scene.particles.len() as u64, "particle");
        let steps = format_count(task.scene.step_count().into(), "step");
        let _ = writeln!(text, "  {} ({particles}, {steps})", to_one_line(&task.name));
    }
    text
}

/// Describes the share of possible events that the scenes contain; empty for scenes of assignments without such events.
fn describe_contents(contents: &SuiteContents, style: Style) -> String {
    let coverage = &contents.coverage;
    if coverage.is_empty() {
        return String::new();
    }
    let title = style.paint(TextStyle::Strong, "Events in the scenes' steps, by pairs of properties");
    let mut text = format!("\n{title}\n");
    let width = FAMILIES.iter().map(|family| family.name.len()).max().unwrap_or(0);
    let (mut all_seen, mut all) = (0, 0);
    for (index, family) in FAMILIES.iter().enumerate() {
        let (seen, possible) = coverage.counts(index);
        (all_seen, all) = (all_seen + seen, all + possible);
        let _ = writeln!(text, "  {:width$}  {seen:4} of {possible:4}", family.name);
        for missing in coverage.missing().filter(|pairing| contents.lists_missing && pairing.family == index) {
            let _ = writeln!(text, "    missing: {}", missing.describe());
        }
    }
    let hint = if contents.lists_missing || all_seen == all { "" } else { "; --missing lists the others" };
    let _ = writeln!(text, "  {:width$}  {all_seen:4} of {all:4}{hint}", "together");
    text
}

/// Describes how many known mistakes the scenes show, by area, and lists those that no scene or few scenes show.
fn describe_mistakes(parts: &[VisibleMistakes], style: Style) -> String {
    if parts.is_empty() {
        return String::new();
    }
    let title = style.paint(TextStyle::Strong, "Known mistakes that a scene shows, by area");
    let mut text = format!("\n{title}\n");
    let width = parts.iter().map(|part| to_key(&part.area).len()).chain(["together".len()]).max().unwrap_or(0);
    let (mut all_seen, mut together) = (0, 0);
    for VisibleMistakes { area, mistake_count: all, invisible_mistakes: unseen, rarely_visible: rare } in parts {
        (all_seen, together) = (all_seen + all - unseen.len(), together + all);
        let _ = writeln!(text, "  {:width$}  {:4} of {all:4}", to_key(area), all - unseen.len());
        if !unseen.is_empty() {
            let _ = writeln!(text, "    not shown: {}", unseen.join(", "));
        }
        if !rare.is_empty() {
            let _ = writeln!(text, "    shown by fewer than {MAX_LISTED_SCENES} scenes: {}", rare.join(", "));
        }
    }
    let _ = writeln!(text, "  {:width$}  {all_seen:4} of {together:4}", "together");
    text
}

/// Returns a note for each scene that programs of the suite's milestone cannot run completely.
fn describe_unknown_features(plan: &Plan, style: Style) -> Vec<String> {
    let milestone = plan.assignment();
    let note = style.paint(TextStyle::Notice, "note");
    let scenes = plan.scenes().filter_map(|task| {
        let unknown = task.scene.unknown_features(milestone).map(|unknown| unknown.to_string());
        Some((to_one_line(&task.name), unknown.reduce(|list, part| list + ", " + &part)?))
    });
    scenes.map(|(scene, unknown)| format!("\n{note}: {scene}: {unknown}\n")).collect()
}

/// Returns a note on a scene. It is not an error, but worth knowing before a class is graded.
fn describe_note(scene: &str, found: &Result<Vec<Borderline>, StepError>, style: Style) -> String {
    let (note, scene) = (style.paint(TextStyle::Notice, "note"), to_one_line(scene));
    let found = match found {
        Ok(found) => found,
        Err(error) => return format!("\n{note}: {scene} can't be simulated to its end: {error}\n"),
    };
    let plural = if found.len() == 1 { "a decision" } else { "decisions" };
    let mut text = format!(
        "\n{note}: {scene} has {plural} that round-off may change; by the original's rules correct programs may fail\n"
    );
    for decision in found.iter().take(MAX_LISTED) {
        let verb = if decision.collides { "collide" } else { "do not collide" };
        let (pair, pass) = (PairText(decision.pair), PassText(decision.pass));
        let _ = writeln!(text, "  step {}: {pair} {verb} ({pass})", decision.step);
    }
    if found.len() > MAX_LISTED {
        let _ = writeln!(text, "  and {} more", found.len() - MAX_LISTED);
    }
    text
}
