//! `suite.toml`: what to grade, with what limits, points and visibility.
//!
//! Reading yields every problem at once, each with line and column. The file's grammar is documented by the template
//! that `suite init` writes ([`TEMPLATE`]).
pub use super::patience::Patience;
use super::shape;
pub use fosssim_findings::{Hints, Visibility, speed::SpeedMarking};
use fosssim_judge::Rules;
use serde::Deserialize;
use std::{ops::Range, time::Duration};
use toml::Spanned;

pub use super::assignments::TEMPLATE;

/// A validated suite: its scenes are patterns until they are looked up (see [`Plan`](super::plan::Plan)).
#[derive(Debug, Clone, PartialEq)]
pub struct Suite<Scene = Pattern> {
    /// Its name, shown in reports.
    pub name: String,
    /// How the program is run; `{program}`, `{scene}` and `{trace}` are replaced.
    pub run: Vec<String>,
    /// The rule books to ask; the official one gives verdicts and points.
    pub rules: Rules,
    /// How much reports for staff tell: everything, unless the one who grades wants less.
    pub staff_hints: Hints,
    /// Whether students see what their programs print even though some groups are not visible to them.
    pub show_output: bool,
    /// The build step.
    pub build: Option<BuildStep>,
    /// Limits of each run.
    pub limits: RunLimits,
    /// When the rest of a submission is not run any more.
    pub patience: Patience,
    /// The groups.
    pub groups: Vec<Group<Scene>>,
}

/// A group of scenes.
#[derive(Debug, Clone, PartialEq)]
pub struct Group<Scene = Pattern> {
    /// Its name.
    pub name: String,
    /// Its points, credit and visibility.
    pub marking: Marking,
    /// Its scenes, in the order of the patterns, each pattern's in alphabetical order.
    pub scenes: Vec<Scene>,
}

/// A pattern of scenes: `asset:Group/*` for embedded ones, else files relative to the suite's own folder.
#[derive(Debug, Clone, PartialEq)]
pub struct Pattern {
    /// Its text.
    pub text: String,
    /// Where it stands, for messages about patterns that match nothing.
    pub at: Position,
}

/// The settings of a group that decide its points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marking {
    /// Points of the whole group, shared evenly among its scenes.
    pub points: f64,
    /// How partial success counts.
    pub credit: Credit,
    /// The readers who see it.
    pub visibility: Visibility,
    /// How much students are told of its scenes.
    pub hints: Hints,
    /// Points for speed, once all scenes are accepted.
    pub speed: Option<SpeedMarking>,
}

/// How the sources are built.
#[derive(Debug, Clone, PartialEq)]
pub struct BuildStep {
    /// The command, run in a copy of the submission's folder.
    pub command: Vec<String>,
    /// The program that it makes, relative to the folder.
    pub program: String,
    /// Wall time.
    pub wall: Duration,
    /// Memory in bytes.
    pub memory: u64,
}

/// Limits of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunLimits {
    /// Processor time.
    pub cpu: Duration,
    /// Wall time.
    pub wall: Duration,
    /// Address space in bytes.
    pub memory: u64,
    /// Bytes of standard output and of standard error, each.
    pub output: u64,
    /// Bytes of the trace.
    pub trace: u64,
    /// Bytes in the working folder.
    pub folder: u64,
    /// Files in the working folder.
    pub files: u64,
    /// Whether programs that were built with a sanitiser may run, whose address space can't be limited.
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

/// How partial success counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Credit {
    /// The group's points times the share of accepted scenes.
    Scenes,
    /// Within each scene, the share of steps without a finding.
    Steps,
    /// All or nothing.
    All,
}

/// A place in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl Position {
    fn of(text: &str, offset: usize) -> Self {
        let before = text.get(..offset).unwrap_or(text);
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        Self { line, column }
    }
}

impl std::fmt::Display for Position {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{}:{}", self.line, self.column)
    }
}

/// A fault of a suite file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}", problems.iter().map(|(at, text)| format!("{at}: {text}")).collect::<Vec<_>>().join("\n"))]
pub struct SuiteError {
    /// Every problem with its position, in order.
    pub problems: Vec<(Position, String)>,
}

/// A suite whose shape has been checked: what is missing has been told.
#[derive(Deserialize, Default)]
struct RawSuite {
    schema: Option<Spanned<u32>>,
    name: Option<Spanned<String>>,
    rules: Option<String>,
    hints: Option<Hints>,
    show_output: Option<bool>,
    run: Option<Spanned<Vec<String>>>,
    build: Option<Spanned<RawBuild>>,
    limits: Option<RawLimits>,
    group: Option<Vec<Spanned<RawGroup>>>,
}

#[derive(Deserialize)]
struct RawBuild {
    command: Option<Vec<String>>,
    program: Option<String>,
    wall_seconds: Option<Spanned<f64>>,
    memory_mib: Option<Spanned<f64>>,
}

#[derive(Deserialize, Default)]
struct RawLimits {
    cpu_seconds: Option<Spanned<f64>>,
    wall_seconds: Option<Spanned<f64>>,
    memory_mib: Option<Spanned<f64>>,
    output_mib: Option<Spanned<f64>>,
    trace_mib: Option<Spanned<f64>>,
    folder_mib: Option<Spanned<f64>>,
    files: Option<Spanned<f64>>,
    sanitizers: Option<bool>,
    time_outs: Option<Spanned<f64>>,
    total_seconds: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
struct RawGroup {
    name: Option<Spanned<String>>,
    scenes: Option<Spanned<Vec<Spanned<String>>>>,
    points: Option<Spanned<f64>>,
    credit: Option<Credit>,
    visibility: Option<Visibility>,
    hints: Option<Hints>,
    speed: Option<Spanned<RawSpeed>>,
}

#[derive(Deserialize)]
struct RawSpeed {
    points: Option<Spanned<f64>>,
    full_at: Option<Spanned<f64>>,
    none_at: Option<Spanned<f64>>,
    runs: Option<Spanned<f64>>,
}

/// Collects problems with their positions while values are checked.
struct Checker<'a> {
    text: &'a str,
    problems: Vec<(Position, String)>,
}

impl Checker<'_> {
    fn problem(&mut self, span: Range<usize>, text: String) {
        self.problems.push((Position::of(self.text, span.start), text));
    }

    /// A number in a range; the default when it is absent or wrong.
    fn number(&mut self, name: &str, value: Option<&Spanned<f64>>, default: f64, range: Range<f64>) -> f64 {
        match value {
            None => default,
            Some(value) if range.contains(value.get_ref()) => *value.get_ref(),
            Some(value) => {
                let text =
                    format!("{name} is {}: it has to lie between {} and {}", value.get_ref(), range.start, range.end);
                self.problem(value.span(), text);
                default
            }
        }
    }
}

/// The greatest number of points of a group.
pub const MOST_POINTS: Range<f64> = 0.0..1e6;

const MIB: f64 = 1024.0 * 1024.0;

/// Reads and validates a suite.
///
/// # Errors
/// Every problem with line and column: syntax, unknown keys, values out of range, groups without scenes.
pub fn read(text: &str) -> Result<Suite, SuiteError> {
    let (suite, problems) = read_all(text);
    if problems.is_empty() { Ok(suite) } else { Err(SuiteError { problems }) }
}

/// A suite and everything that is wrong with it, in order: what is wrong is left out or has its default.
pub(super) fn read_all(text: &str) -> (Suite, Vec<(Position, String)>) {
    let (table, problems, is_readable) = shape::checked(text);
    let place = |(span, text_of): (Range<usize>, String)| (Position::of(text, span.start), text_of);
    let mut checker = Checker { text, problems: problems.into_iter().map(place).collect() };
    let raw = RawSuite::deserialize(toml::Deserializer::from(table)).unwrap_or_else(|error| {
        checker.problem(error.span().unwrap_or(0..0), error.message().trim().replace('\n', " "));
        RawSuite::default()
    });
    if let Some(schema) = raw.schema.filter(|schema| *schema.get_ref() != 1) {
        let text = format!("schema {} is not known: this version reads schema 1", schema.get_ref());
        checker.problem(schema.span(), text);
    }
    if let Some(name) = raw.name.as_ref().filter(|name| name.get_ref().trim().is_empty()) {
        checker.problem(name.span(), "the suite's name is empty".to_owned());
    }
    let run = read_run(&mut checker, raw.run);
    let raw_limits = raw.limits.unwrap_or_default();
    let limits = read_limits(&mut checker, &raw_limits);
    let patience = read_patience(&mut checker, &raw_limits);
    let build = raw.build.map(|build| read_build(&mut checker, build));
    let is_without_groups = raw.group.as_ref().is_none_or(Vec::is_empty);
    if is_without_groups && is_readable {
        checker.problem(0..0, "the suite has no [[group]], so there is nothing to grade".to_owned());
    }
    let groups = raw.group.unwrap_or_default().into_iter();
    let hints = raw.hints.unwrap_or(Hints::What);
    let groups: Vec<Group> = groups.map(|group| read_group(&mut checker, group.into_inner(), hints)).collect();
    for (number, group) in groups.iter().enumerate() {
        if !group.name.is_empty() && groups[..number].iter().any(|other| other.name == group.name) {
            checker.problems.push((
                group.scenes.first().map(|pattern| pattern.at).unwrap_or_default(),
                format!("two groups have the name \"{}\"", group.name),
            ));
        }
    }
    let suite = Suite {
        name: raw.name.map(Spanned::into_inner).unwrap_or_default(),
        run,
        rules: raw.rules.as_deref().and_then(Rules::from_name).unwrap_or(Rules::Fair),
        staff_hints: Hints::Full,
        show_output: raw.show_output.unwrap_or(false),
        build,
        limits,
        patience,
        groups,
    };
    checker.problems.sort_by_key(|(at, _)| (at.line, at.column));
    (suite, checker.problems)
}

/// The course's protocol.
pub(super) fn default_run() -> Vec<String> {
    ["{program}", "-s", "{scene}", "-d", "0", "-o", "{trace}"].map(str::to_owned).into()
}

fn read_run(checker: &mut Checker<'_>, run: Option<Spanned<Vec<String>>>) -> Vec<String> {
    let Some(run) = run else { return default_run() };
    for part in ["{program}", "{scene}", "{trace}"] {
        if !run.get_ref().iter().any(|word| word.contains(part)) {
            checker.problem(run.span(), format!("run has no {part}: the program would not get it"));
        }
    }
    if run.get_ref().first().is_some_and(|word| word != "{program}") {
        checker.problem(run.span(), "run has to begin with {program}".to_owned());
    }
    run.into_inner()
}

fn read_limits(checker: &mut Checker<'_>, raw: &RawLimits) -> RunLimits {
    let default = RunLimits::default();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range has been checked")]
    let mut mib = |name: &str, value: Option<&Spanned<f64>>, default: u64| {
        #[expect(clippy::cast_precision_loss, reason = "defaults are small powers of two")]
        let default = default as f64 / MIB;
        (checker.number(name, value, default, 0.001..1e6) * MIB) as u64
    };
    let memory = mib("memory_mib", raw.memory_mib.as_ref(), default.memory);
    let output = mib("output_mib", raw.output_mib.as_ref(), default.output);
    let trace = mib("trace_mib", raw.trace_mib.as_ref(), default.trace);
    let folder = mib("folder_mib", raw.folder_mib.as_ref(), default.folder);
    let cpu = checker.number("cpu_seconds", raw.cpu_seconds.as_ref(), default.cpu.as_secs_f64(), 0.01..86_400.0);
    let wall = checker.number(
        "wall_seconds",
        raw.wall_seconds.as_ref(),
        default.wall.as_secs_f64().max(2.0 * cpu),
        0.01..86_400.0,
    );
    #[expect(clippy::cast_precision_loss, reason = "the default is small")]
    let files = checker.number("files", raw.files.as_ref(), default.files as f64, 1.0..1e6);
    RunLimits {
        cpu: Duration::from_secs_f64(cpu),
        wall: Duration::from_secs_f64(wall),
        memory,
        output,
        trace,
        folder,
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range has been checked")]
        files: files as u64,
        sanitizers: raw.sanitizers.unwrap_or(default.sanitizers),
    }
}

fn read_patience(checker: &mut Checker<'_>, raw: &RawLimits) -> Patience {
    let default = Patience::default();
    let time_outs = checker.number("time_outs", raw.time_outs.as_ref(), f64::from(default.time_outs), 0.0..1e6);
    let total =
        checker.number("total_seconds", raw.total_seconds.as_ref(), default.total.as_secs_f64(), 0.01..86_400_000.0);
    Patience {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range has been checked")]
        time_outs: time_outs as u32,
        total: Duration::from_secs_f64(total),
    }
}

fn read_build(checker: &mut Checker<'_>, build: Spanned<RawBuild>) -> BuildStep {
    let span = build.span();
    let raw = build.into_inner();
    if raw.command.as_ref().is_some_and(Vec::is_empty) {
        checker.problem(span.clone(), "build.command is empty: say what builds the program".to_owned());
    }
    let leads_out = |program: &&String| {
        program.is_empty() || program.starts_with('/') || program.split('/').any(|part| part == "..")
    };
    if let Some(program) = raw.program.as_ref().filter(leads_out) {
        let text = format!("build.program \"{program}\" has to be a path inside the submission's folder");
        checker.problem(span, text);
    }
    let wall = checker.number("build.wall_seconds", raw.wall_seconds.as_ref(), 120.0, 0.01..86_400.0);
    let memory = checker.number("build.memory_mib", raw.memory_mib.as_ref(), 2048.0, 1.0..1e6);
    BuildStep {
        command: raw.command.unwrap_or_default(),
        program: raw.program.unwrap_or_default(),
        wall: Duration::from_secs_f64(wall),
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range has been checked")]
        memory: (memory * MIB) as u64,
    }
}

/// A group; `hints` are those of a group that says nothing of them.
fn read_group(checker: &mut Checker<'_>, raw: RawGroup, hints: Hints) -> Group {
    let name = raw.name.as_ref().map(|name| name.get_ref().clone()).unwrap_or_default();
    if let Some(empty) = raw.name.filter(|name| name.get_ref().trim().is_empty()) {
        checker.problem(empty.span(), "the group's name is empty".to_owned());
    }
    if let Some(none) = raw.scenes.as_ref().filter(|scenes| scenes.get_ref().is_empty()) {
        checker.problem(none.span(), format!("group \"{name}\" has no scenes"));
    }
    let points = checker.number("points", raw.points.as_ref(), 1.0, MOST_POINTS);
    let scenes = raw.scenes.map(Spanned::into_inner).unwrap_or_default().into_iter();
    let pattern = |pattern: Spanned<String>| {
        let at = Position::of(checker.text, pattern.span().start);
        Pattern { text: pattern.into_inner(), at }
    };
    let (credit, visibility) = (raw.credit.unwrap_or(Credit::Scenes), raw.visibility.unwrap_or(Visibility::Visible));
    let speed = raw.speed.map(|speed| read_speed(checker, speed));
    let marking = Marking { points, credit, visibility, hints: raw.hints.unwrap_or(hints), speed };
    Group { name, scenes: scenes.map(pattern).collect(), marking }
}

fn read_speed(checker: &mut Checker<'_>, raw: Spanned<RawSpeed>) -> SpeedMarking {
    let span = raw.span();
    let raw = raw.into_inner();
    let points = checker.number("speed.points", raw.points.as_ref(), 1.0, MOST_POINTS);
    let full_at = checker.number("speed.full_at", raw.full_at.as_ref(), 1.0, 0.001..1e6);
    let none_at = checker.number("speed.none_at", raw.none_at.as_ref(), 10.0, 0.001..1e6);
    let runs = checker.number("speed.runs", raw.runs.as_ref(), 5.0, 1.0..101.0);
    if none_at <= full_at {
        let text = format!("speed.none_at ({none_at}) has to be greater than speed.full_at ({full_at})");
        checker.problem(span, text);
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range has been checked")]
    let runs = runs as u32;
    SpeedMarking { points, full_at, none_at, runs }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_template_is_a_valid_suite() {
        let suite = read(TEMPLATE).expect("the template");
        assert_eq!((suite.limits, suite.patience), (RunLimits::default(), Patience::default()));
        assert_eq!(suite.run, default_run());
        assert_eq!(suite.rules, Rules::Fair);
        let without = TEMPLATE.replacen("rules = \"fair\"\n", "", 1);
        assert_eq!(read(&without).expect("sound").rules, Rules::Fair, "the default");
        assert!(!suite.groups.is_empty());
    }

    #[test]
    fn every_problem_is_told_with_its_position() {
        let text = "schema = 2\nname = \"\"\nrules = \"kind\"\nrun = [\"sh\", \"{scene}\"]\n[limits]\ncpu_seconds = -1.0\n\
                    [[group]]\nname = \"a\"\nscenes = []\npoints = -5.0\n";
        insta::assert_snapshot!(read(text).expect_err("wrong"), @r#"
        1:10: schema 2 is not known: this version reads schema 1
        2:8: the suite's name is empty
        3:9: rules "kind" is not known: there are "parity", "fair" and "both"
        4:7: run has no {program}: the program would not get it
        4:7: run has no {trace}: the program would not get it
        4:7: run has to begin with {program}
        6:15: cpu_seconds is -1: it has to lie between 0.01 and 86400
        9:10: group "a" has no scenes
        10:10: points is -5: it has to lie between 0 and 1000000
        "#);
    }

    #[test]
    fn misspelt_keys_are_named_with_what_was_meant() {
        let error = read("schema = 1\nnmae = \"x\"\n").expect_err("wrong").to_string();
        assert!(error.contains("2:1: unknown key `nmae` in the suite: did you mean `name`?"), "{error}");
    }

    #[test]
    fn unknown_keys_and_bad_values_are_told_all_at_once_with_what_follows_from_the_rest() {
        let text = "schema = \"1\"\nname = \"x\"\nrules = \"Fair!\"\nhints = \"half\"\nshow_output = 1\ncpu_seconds = 3\n\
                    run = \"{program}\"\n[limits]\ncpu-second = 1\nmemory_mib = \"512\"\nfiles = nan\n[build]\n\
                    comand = [\"make\"]\nprogram = \"../x\"\n[[group]]\nnam = \"a\"\nscenes = [\"asset:No/*\", 3]\n\
                    credit = \"step\"\n[[group]]\nname = \"b\"\nscenes = []\npoints = -1\nweight = 2\n";
        let error = read(text).expect_err("wrong");
        let told = error.to_string();
        for line in [
            "1:10: schema has to be a whole number that is not negative, and is a string",
            "3:9: rules \"Fair!\" is not known: there are \"parity\", \"fair\" and \"both\"; did you mean \"fair\"?",
            "4:9: hints \"half\" is not known: there are \"none\", \"where\", \"what\" and \"full\"",
            "5:15: show_output has to be true or false, and is an integer",
            "6:1: unknown key `cpu_seconds` in the suite: it belongs into [limits]",
            "7:7: run has to be a list of texts, [\"...\"], and is a string",
            "9:1: unknown key `cpu-second` in [limits]: did you mean `cpu_seconds`?",
            "10:14: memory_mib has to be a number, and is a string",
            "11:9: files is NaN: it has to lie between 1 and 1000000",
            "13:1: unknown key `comand` in [build]: did you mean `command`?",
            "build.program \"../x\" has to be a path inside the submission's folder",
            "16:1: unknown key `nam` in this [[group]]: did you mean `name`?",
            "17:25: each of scenes has to be a text in quotes, and this is an integer",
            "18:10: credit \"step\" is not known: there are \"scenes\", \"steps\" and \"all\"; did you mean \"steps\"?",
            "21:10: group \"b\" has no scenes",
            "22:10: points is -1: it has to lie between 0 and 1000000",
            "23:1: unknown key `weight` in this [[group]]: there are name, scenes, points, credit, visibility",
        ] {
            assert!(told.contains(line), "{line}\n{told}");
        }
        assert_eq!(error.problems.len(), 17, "and nothing else: {told}");
    }

    #[test]
    fn broken_lines_are_told_and_nothing_that_follows_from_them() {
        let error = read("schema = 1\nname = \n[[group]]\nscenes = [\"a\"\n").expect_err("wrong");
        assert!(error.problems.iter().all(|(at, _)| at.line >= 2), "{error}");
        assert!(!error.to_string().contains("no [[group]]"), "{error}");
        assert!(read("").expect_err("empty").to_string().contains("no [[group]]"));
    }
}
