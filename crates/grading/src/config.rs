//! Reads `suite.toml`, which contains the scenes to grade, the limits, the points and the visibility.
//!
//! All problems are reported together, each with its line and column. The template that `suite init` writes documents
//! the keys of the file ([`suite_template`]).
use super::{
    suggestions::find_closest,
    suite_shape::{self, Problem, RawBuild, RawGroup, RawLimits, RawMistake, RawSpeed, RawSuite},
};
use fosssim_findings::explanation::Explanation;
pub use fosssim_findings::{CourseNote, Hints, Visibility, speed::SpeedMarking};
use fosssim_judge::Rules;
use fosssim_model::assignments::Assignment;
use fosssim_student::{all_rows, assignments::t2m2::find_edit, find};
use serde::Deserialize;
use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};
use toml::Spanned;

pub use super::{
    assignments::suite_template,
    suite_shape::{Credit, POINTS_RANGE},
};

/// A suite that was read from its file and is valid. Its scenes are patterns until the scenes are found (see
/// [`Plan`](super::plan::Plan)).
#[derive(Debug, Clone, PartialEq)]
pub struct Suite<Scene = Pattern> {
    /// The name of the suite, which reports show.
    pub name: String,
    /// The milestone whose programs the suite grades, if the file names one.
    pub milestone: Option<Assignment>,
    /// The command that runs a program. `{program}`, `{scene}` and `{trace}` in it are replaced.
    pub command: Vec<String>,
    /// The rule books by which traces are judged. The official one gives verdicts and points.
    pub rules: Rules,
    /// The level of detail for staff. By default they see everything.
    pub staff_hints: Hints,
    /// Whether students see the output of their programs even if the suite has groups that are hidden from them.
    pub show_output: bool,
    /// The command that builds submissions; `None` if submissions are programs.
    pub build: Option<BuildStep>,
    /// The limits that apply to each run.
    pub limits: RunLimits,
    /// The limits after which the remaining scenes of a submission are skipped.
    pub skip_limits: SkipLimits,
    /// The course's notes on mistakes, by the mistakes' keys.
    pub notes: BTreeMap<String, CourseNote>,
    /// The groups of scenes, in the order of the file.
    pub groups: Vec<Group<Scene>>,
}

/// A group of scenes, which are graded together.
#[derive(Debug, Clone, PartialEq)]
pub struct Group<Scene = Pattern> {
    /// The name of the group.
    pub name: String,
    /// The points that the group is worth, the rule for partial success, and the readers of its results.
    pub marking: Marking,
    /// The course's note on the group, if there is one.
    pub note: Option<CourseNote>,
    /// The group's scenes, in the order of the patterns. The scenes of one pattern are in alphabetical order.
    pub scenes: Vec<Scene>,
}

/// A pattern that selects scenes: `asset:Group/*` for embedded scenes, or a path of files relative to the suite's
/// folder.
#[derive(Debug, Clone, PartialEq)]
pub struct Pattern {
    /// The text of the pattern.
    pub text: String,
    /// The position of the pattern in the file, for messages about patterns that match nothing.
    pub position: Position,
}

/// The settings of a group that concern its points and its visibility.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marking {
    /// The points that the whole group is worth. They are shared evenly among its scenes.
    pub points: f64,
    /// The rule for partial success within the group.
    pub credit: Credit,
    /// The readers who see the results of the group, and when.
    pub visibility: Visibility,
    /// The level of detail for students about the group's scenes.
    pub hints: Hints,
    /// Whether the points are extra points. They are shown with the others, but count in neither the sum nor the
    /// maximum.
    pub is_extra: bool,
    /// The points for speed, which a submission can get only if all scenes of the group are accepted.
    pub speed: Option<SpeedMarking>,
}

/// The build of a submission that consists of sources.
#[derive(Debug, Clone, PartialEq)]
pub struct BuildStep {
    /// The command, which is run in a copy of the submission's folder.
    pub command: Vec<String>,
    /// The path of the program that the build produces, relative to the folder.
    pub program: String,
    /// The limit on the wall time of the build.
    pub wall: Duration,
    /// The limit on the memory of the build, in bytes.
    pub memory: u64,
}

/// The limits that apply to one run of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunLimits {
    /// The limit on processor time.
    pub cpu: Duration,
    /// The limit on wall time.
    pub wall: Duration,
    /// The limit on address space, in bytes.
    pub memory: u64,
    /// The limit on standard output, and separately on standard error, in bytes.
    pub output: u64,
    /// The limit on the size of the trace, in bytes.
    pub trace: u64,
    /// The limit on the bytes of all files in the working folder.
    pub folder: u64,
    /// The limit on the number of files in the working folder.
    pub files: u64,
    /// Whether programs that were built with a sanitizer may run. The address space of such programs cannot be limited.
    pub sanitizers: bool,
}

impl Default for RunLimits {
    fn default() -> Self {
        Self {
            cpu: Duration::from_secs(10),
            wall: Duration::from_secs(20),
            memory: 512 << 20,
            output: 1 << 20,
            trace: 256 << 20,
            folder: 64 << 20,
            files: 100,
            sanitizers: false,
        }
    }
}

/// The limits after which the remaining scenes of a submission are skipped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkipLimits {
    /// The number of consecutive scenes that may exceed a limit of time, memory or output. Four times as many may
    /// exceed it in all. With 0 there is no limit.
    pub time_outs: u32,
    /// The limit on the wall time of all runs of a submission together, which includes judging.
    pub total: Duration,
}

impl Default for SkipLimits {
    fn default() -> Self {
        Self { time_outs: 3, total: Duration::from_secs(600) }
    }
}

/// A position in the suite file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Position {
    /// The line number, from 1.
    pub line: usize,
    /// The number of the character in its line, from 1.
    pub column: usize,
}

/// Computes lines and columns, counting from the last position. Many positions in a long line then take no longer than
/// one.
struct PositionCounter<'a> {
    text: &'a str,
    offset: usize,
    position: Position,
}

impl<'a> PositionCounter<'a> {
    fn new(text: &'a str) -> Self {
        Self { text, offset: 0, position: Position { line: 1, column: 1 } }
    }

    fn position(&mut self, offset: usize) -> Position {
        if offset < self.offset {
            *self = Self::new(self.text);
        }
        for c in self.text.get(self.offset..offset).unwrap_or_default().chars() {
            let Position { line, column } = self.position;
            self.position =
                if c == '\n' { Position { line: line + 1, column: 1 } } else { Position { line, column: column + 1 } };
        }
        self.offset = offset;
        self.position
    }
}

impl std::fmt::Display for Position {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{}:{}", self.line, self.column)
    }
}

/// The problems of a suite file that cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}", problems.iter().map(|(at, text)| format!("{at}: {text}")).collect::<Vec<_>>().join("\n"))]
pub struct SuiteError {
    /// Each problem with its position, in the order of the file.
    pub problems: Vec<(Position, String)>,
}

/// Reads and validates a suite.
///
/// # Errors
/// Fails with all problems and their positions. Problems are wrong syntax, unknown keys, values out of range, and
/// groups without scenes.
pub fn read(text: &str) -> Result<Suite, SuiteError> {
    let (suite, problems) = read_with_problems(text);
    if problems.is_empty() { Ok(suite) } else { Err(SuiteError { problems }) }
}

/// Reads a suite and returns all problems, in the order of the file. Invalid parts are left out or get their default
/// values.
pub(super) fn read_with_problems(text: &str) -> (Suite, Vec<(Position, String)>) {
    let (table, mut problems, is_readable) = suite_shape::check_shape(text);
    let raw = RawSuite::deserialize(toml::Deserializer::from(table)).unwrap_or_else(|error| {
        problems.push((error.span().unwrap_or(0..0), error.message().trim().replace('\n', " ")));
        RawSuite::default()
    });
    if let Some(schema) = raw.schema.filter(|schema| *schema.get_ref() != 1) {
        let text = format!("schema {} is not known: this version reads schema 1", schema.get_ref());
        problems.push((schema.span(), text));
    }
    if let Some(name) = raw.name.as_ref().filter(|name| name.get_ref().trim().is_empty()) {
        problems.push((name.span(), "the suite's name is empty".to_owned()));
    }
    let run = read_command(&mut problems, raw.run);
    let raw_limits = raw.limits.unwrap_or_default();
    let (limits, skip_limits) = (read_limits(&raw_limits), read_skip_limits(&raw_limits));
    let build = raw.build.map(|build| read_build(&mut problems, build));
    let is_without_groups = raw.group.as_ref().is_none_or(Vec::is_empty);
    if is_without_groups && is_readable {
        problems.push((0..0, "the suite has no [[group]], so there is nothing to grade".to_owned()));
    }
    let notes = raw.mistake.unwrap_or_default().into_iter();
    let notes = notes.filter_map(|mistake| read_mistake(&mut problems, mistake)).collect();
    let groups = raw.group.unwrap_or_default().into_iter();
    let hints = raw.hints.unwrap_or(Hints::What);
    let mut positions = PositionCounter::new(text);
    let read = |group: Spanned<RawGroup>| read_group(&mut positions, &mut problems, group.into_inner(), hints);
    let groups: Vec<Group> = groups.map(read).collect();
    problems.sort_by_key(|(span, _)| span.start);
    let locate = |(span, message): Problem| (positions.position(span.start), message);
    let mut problems: Vec<(Position, String)> = problems.into_iter().map(locate).collect();
    let mut names = BTreeSet::new();
    for group in &groups {
        if !group.name.is_empty() && !names.insert(&group.name) {
            problems.push((
                group.scenes.first().map(|pattern| pattern.position).unwrap_or_default(),
                format!("two groups have the name \"{}\"", group.name),
            ));
        }
    }
    let suite = Suite {
        name: raw.name.map(Spanned::into_inner).unwrap_or_default(),
        milestone: raw.milestone.as_deref().and_then(Assignment::from_key),
        command: run,
        rules: raw.rules.unwrap_or(Rules::Fair),
        staff_hints: Hints::Full,
        show_output: raw.show_output.unwrap_or(false),
        build,
        limits,
        skip_limits,
        notes,
        groups,
    };
    problems.sort_by_key(|(at, _)| (at.line, at.column));
    (suite, problems)
}

/// Returns the command line that the course prescribes for programs.
pub(super) fn default_command() -> Vec<String> {
    ["{program}", "-s", "{scene}", "-d", "0", "-o", "{trace}"].map(str::to_owned).into()
}

fn read_command(problems: &mut Vec<Problem>, run: Option<Spanned<Vec<String>>>) -> Vec<String> {
    let Some(run) = run else { return default_command() };
    for part in ["{program}", "{scene}", "{trace}"] {
        if !run.get_ref().iter().any(|word| word.contains(part)) {
            problems.push((run.span(), format!("run has no {part}, so the program would not get it; add it")));
        }
    }
    if run.get_ref().first().is_some_and(|word| word != "{program}") {
        problems.push((run.span(), "run must begin with {program}".to_owned()));
    }
    run.into_inner()
}

fn read_limits(raw: &RawLimits) -> RunLimits {
    let default = RunLimits::default();
    let cpu = raw.cpu_seconds.unwrap_or(default.cpu.as_secs_f64());
    let wall = raw.wall_seconds.unwrap_or(default.wall.as_secs_f64().max(2.0 * cpu));
    RunLimits {
        cpu: Duration::from_secs_f64(cpu),
        wall: Duration::from_secs_f64(wall),
        memory: raw.memory_mib.map_or(default.memory, mib_to_bytes),
        output: raw.output_mib.map_or(default.output, mib_to_bytes),
        trace: raw.trace_mib.map_or(default.trace, mib_to_bytes),
        folder: raw.folder_mib.map_or(default.folder, mib_to_bytes),
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range has been checked")]
        files: raw.files.map_or(default.files, |files| files as u64),
        sanitizers: raw.sanitizers.unwrap_or(default.sanitizers),
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range has been checked")]
const fn mib_to_bytes(mib: f64) -> u64 {
    (mib * (1 << 20) as f64) as u64
}

fn read_skip_limits(raw: &RawLimits) -> SkipLimits {
    let default = SkipLimits::default();
    SkipLimits {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range has been checked")]
        time_outs: raw.time_outs.map_or(default.time_outs, |number| number as u32),
        total: raw.total_seconds.map_or(default.total, Duration::from_secs_f64),
    }
}

fn read_build(problems: &mut Vec<Problem>, build: Spanned<RawBuild>) -> BuildStep {
    let span = build.span();
    let raw = build.into_inner();
    if raw.command.as_ref().is_some_and(Vec::is_empty) {
        problems.push((span.clone(), "build.command is empty: name the command that builds the program".to_owned()));
    }
    let leads_out = |program: &&String| {
        program.is_empty() || program.starts_with('/') || program.split('/').any(|part| part == "..")
    };
    if let Some(program) = raw.program.as_ref().filter(leads_out) {
        let text = format!("build.program \"{program}\" must be a path inside the submission's folder");
        problems.push((span, text));
    }
    BuildStep {
        command: raw.command.unwrap_or_default(),
        program: raw.program.unwrap_or_default(),
        wall: Duration::from_secs_f64(raw.wall_seconds.unwrap_or(120.0)),
        memory: mib_to_bytes(raw.memory_mib.unwrap_or(2048.0)),
    }
}

/// Reads a group. `hints` is the level of detail for a group that does not set its own.
fn read_group(positions: &mut PositionCounter<'_>, problems: &mut Vec<Problem>, raw: RawGroup, hints: Hints) -> Group {
    let name = raw.name.as_ref().map(|name| name.get_ref().clone()).unwrap_or_default();
    if let Some(empty) = raw.name.filter(|name| name.get_ref().trim().is_empty()) {
        problems.push((empty.span(), "the group's name is empty".to_owned()));
    }
    if let Some(none) = raw.scenes.as_ref().filter(|scenes| scenes.get_ref().is_empty()) {
        problems.push((none.span(), format!("group \"{name}\" has no scenes")));
    }
    let points = raw.points.unwrap_or(1.0);
    let scenes = raw.scenes.map(Spanned::into_inner).unwrap_or_default().into_iter();
    let pattern = |pattern: Spanned<String>| {
        let at = positions.position(pattern.span().start);
        Pattern { text: pattern.into_inner(), position: at }
    };
    let (credit, visibility) = (raw.credit.unwrap_or(Credit::Scenes), raw.visibility.unwrap_or(Visibility::Visible));
    let note = read_note(problems, raw.text, raw.link, None);
    let speed = raw.speed.map(|speed| read_speed(problems, speed));
    let (hints, extra) = (raw.hints.unwrap_or(hints), raw.extra.unwrap_or(false));
    let marking = Marking { points, credit, visibility, hints, is_extra: extra, speed };
    Group { name, scenes: scenes.map(pattern).collect(), marking, note }
}

/// Reads the course's note on a mistake of the catalog, or on a finding that is not in the catalog.
fn read_mistake(problems: &mut Vec<Problem>, raw: RawMistake) -> Option<(String, CourseNote)> {
    let key = raw.key?;
    let id = key.get_ref().as_str();
    let is_known = find(id).is_some() || find_edit(id).is_some() || Explanation::is_general_key(id);
    if !is_known {
        let remedy = find_closest(id, all_rows().map(|row| row.id)).map_or_else(
            || "; `fosssim-oracle sample --list` shows all".to_owned(),
            |meant| format!("; did you mean \"{meant}\"?"),
        );
        problems.push((key.span(), format!("no mistake has the key \"{id}\"{remedy}")));
    }
    let note = read_note(problems, raw.text, raw.link, raw.points)?;
    Some((key.into_inner(), note))
}

/// Reads a course's note; `None` if it is empty.
fn read_note(
    problems: &mut Vec<Problem>,
    text: Option<String>,
    link: Option<Spanned<String>>,
    points: Option<f64>,
) -> Option<CourseNote> {
    let leads_elsewhere = |link: &&Spanned<String>| {
        let address = link.get_ref();
        !["https://", "http://"].iter().any(|start| address.starts_with(start)) || address.contains(char::is_whitespace)
    };
    if let Some(link) = link.as_ref().filter(leads_elsewhere) {
        problems.push((link.span(), "link must be a URL that begins with https:// or http://".to_owned()));
    }
    let note = CourseNote { text, link: link.map(Spanned::into_inner), points };
    (note != CourseNote::default()).then_some(note)
}

fn read_speed(problems: &mut Vec<Problem>, raw: Spanned<RawSpeed>) -> SpeedMarking {
    let span = raw.span();
    let raw = raw.into_inner();
    let (full_at, none_at) = match (raw.full_at, raw.none_at, raw.second) {
        (Some(full_at), Some(none_at), None) => (full_at, none_at),
        // In the course, a program gets full points up to one second, and no points from one minute on.
        (None, None, Some(second)) => (second, 60.0 * second),
        _ => {
            let text = "speed needs either full_at and none_at, or only second";
            problems.push((span.clone(), text.to_owned()));
            (1.0, 60.0)
        }
    };
    if none_at <= full_at {
        let text = format!("speed.none_at ({none_at}) must be greater than speed.full_at ({full_at})");
        problems.push((span, text));
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range has been checked")]
    let runs = raw.runs.unwrap_or(5.0) as u32;
    SpeedMarking { points: raw.points.unwrap_or(1.0), full_at, none_at, runs }
}

#[cfg(test)]
mod tests;
