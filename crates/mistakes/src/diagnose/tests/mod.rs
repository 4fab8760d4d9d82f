//! Programs with several mistakes, asked about on the probe scenes.
use super::{
    About, Explanation, Keep, examine, explain,
    outside::{Rating, rating, told_of},
    probe_scenes, several,
};
use crate::student::{
    self, Area, CATALOGUE, Row, RowKind, Student,
    mutants::{Mutant, mutants},
};
use fosssim_judge::replay::Options;
use fosssim_model::{assignments::Assignment, sim::PairKind};
use rayon::prelude::*;

/// So many programs with a mistake that nobody knows and one of the catalogue.
const PROGRAMS: usize = 14;

mod heads;
mod not_finite;
mod probes;

/// What is said of a program that makes several mistakes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Said {
    /// All of them, by name or by what is wrong, and nothing else.
    All,
    /// Some of them, and nothing else.
    Some,
    /// That nothing is known.
    Nothing,
    /// Something that the program does not do.
    Wrong,
}

/// Programs with two or three mistakes of different parts of the assignment, every tenth of a long list.
fn programs() -> Vec<Vec<&'static Row>> {
    let rows: Vec<&Row> =
        CATALOGUE.iter().filter(|row| row.kind == RowKind::Wrong && row.area != Area::Trace).collect();
    let mut programs = Vec::new();
    for number in 0..48_usize {
        let one = rows[(number * 37) % rows.len()];
        let two = rows[(number * 101 + 13) % rows.len()];
        let three = rows[(number * 53 + 7) % rows.len()];
        let mut program = vec![one];
        for row in [two, three].into_iter().take(if number % 4 == 3 { 2 } else { 1 }) {
            if program.iter().all(|other| other.area != row.area) {
                program.push(row);
            }
        }
        if program.len() > 1 {
            programs.push(program);
        }
    }
    programs
}

/// What is said of a program with these mistakes.
fn said_of(program: &[&Row]) -> (Said, String) {
    let student = program.iter().fold(Student::default(), |student, row| student.and(Some(row.mistake)));
    let mut told = told_of(student);
    // That numbers end is no mistake, but what one leads to.
    told.retain(|one| !one.is_not_finite());
    let keys: Vec<String> =
        told.iter().flat_map(|one| std::iter::once(&one.key).chain(&one.same_as)).cloned().collect();
    // What is said of polynomials and stages in general.
    let is_of = |one: &Explanation, row: &Row| {
        let is_of_kind = |kinds: &[PairKind]| row.kind_of_pair().is_some_and(|kind| kinds.contains(&kind));
        let is_there = match &one.about {
            About::Stage(fault) => fault.areas().contains(&row.area) || is_of_kind(fault.kind().as_slice()),
            about => is_of_kind(&about.kinds()),
        };
        matches!(row.area, Area::Handover) || is_there
    };
    let is_made = |one: &Explanation| match student::find(&one.key) {
        Some(_) => program.iter().any(|row| row.id == one.key || one.same_as.iter().any(|id| id == row.id)),
        None if one.key == Explanation::UNFINISHED => {
            one.same_as.iter().all(|id| program.iter().any(|row| row.id == id))
        }
        None => program.iter().any(|row| is_of(one, row)),
    };
    let is_named = |row: &&&Row| {
        let in_general = |one: &&Explanation| student::find(&one.key).is_none() && !one.is_unfinished();
        keys.iter().any(|key| key == row.id) || told.iter().filter(in_general).any(|one| is_of(one, row))
    };
    let named = program.iter().filter(is_named).count();
    let said = match () {
        () if told.is_empty() => Said::Nothing,
        // What does the same everywhere can't be told apart.
        () if !told.iter().all(is_made) => {
            if does_the_same(program, &told) {
                Said::Some
            } else {
                Said::Wrong
            }
        }
        () if named == program.len() => Said::All,
        () => Said::Some,
    };
    let ids: Vec<&str> = program.iter().map(|row| row.id).collect();
    (said, format!("{ids:?}: {said:?}: {:?}", told.iter().map(|one| (&one.key, &one.same_as)).collect::<Vec<_>>()))
}

/// Whether a program with the mistakes that are told leaves the same traces.
fn does_the_same(program: &[&Row], told: &[Explanation]) -> bool {
    let stages = told.iter().filter(|one| one.key == Explanation::UNFINISHED).flat_map(|one| &one.same_as);
    let rows: Vec<&Row> = told.iter().map(|one| &one.key).chain(stages).filter_map(|key| student::find(key)).collect();
    let traces = |rows: &[&Row]| -> Vec<Vec<u8>> {
        let student = rows.iter().fold(Student::default(), |student, row| student.and(Some(row.mistake)));
        let bytes = |scene| student::trace(scene, student).unwrap_or_else(|(bytes, _)| bytes);
        probe_scenes(Assignment::T2M2).iter().map(|(_, scene)| bytes(scene)).collect()
    };
    traces(&rows) == traces(program)
}

/// Two or three mistakes of different parts of the assignment: nothing is named that the program does not do, and in
/// eight of ten all of them are, by name or by what is wrong.
#[test]
fn of_several_mistakes_some_are_named_and_no_other() {
    let said: Vec<(Said, String)> = programs().par_iter().map(|program| said_of(program)).collect();
    let count = |what: Said| said.iter().filter(|(said, _)| *said == what).count();
    let (all, some, nothing, wrong) = (count(Said::All), count(Said::Some), count(Said::Nothing), count(Said::Wrong));
    let lines: Vec<&String> = said.iter().filter(|(said, _)| *said != Said::All).map(|(_, line)| line).collect();
    assert_eq!(wrong, 0, "of {}: {all} all, {some} some, {nothing} nothing, {wrong} wrong\n{lines:#?}", said.len());
    assert!(10 * all >= 8 * said.len(), "{all} all, {some} some, {nothing} nothing: {lines:#?}");
}

/// A mistake that nobody knows beside one of the catalogue: what is told is of one of the two.
#[test]
fn beside_an_unknown_mistake_nothing_else_is_told() {
    let rows: Vec<&Row> =
        CATALOGUE.iter().filter(|row| row.kind == RowKind::Wrong && row.area != Area::Trace).collect();
    let mutants: Vec<&'static Mutant> = mutants().collect();
    let programs: Vec<(&'static Mutant, &Row)> = (0..PROGRAMS)
        .map(|number| (mutants[number * 29 % mutants.len()], rows[(number * 61 + 5) % rows.len()]))
        .filter(|(mutant, row)| mutant.area != row.area)
        .collect();
    let said = |(mutant, row): &(&'static Mutant, &Row)| {
        let told = told_of(Student::new(Some(row.mistake)).with_mutant(mutant));
        let is_false = |one: &&Explanation| {
            let is_row = one.key == row.id || one.same_as.iter().any(|id| id == row.id);
            let is_of_row = match &one.about {
                About::Stage(fault) => fault.areas().contains(&row.area),
                About::NotFinite(_) => true,
                about => {
                    row.area == Area::Handover || about.kinds().iter().any(|kind| Some(*kind) == row.kind_of_pair())
                }
            };
            !is_row && !is_of_row && rating(mutant, one, "") == Rating::Misleading
        };
        let wrong: Vec<&String> = told.iter().filter(is_false).map(|one| &one.key).collect();
        let all: Vec<&String> = told.iter().map(|one| &one.key).collect();
        (!wrong.is_empty()).then(|| format!("{} + {}: {wrong:?} of {all:?}", mutant.id, row.id))
    };
    let wrong: Vec<String> = programs.par_iter().filter_map(said).collect();
    assert!(wrong.is_empty(), "{} of {}: {wrong:#?}", wrong.len(), programs.len());
}

/// What is found in all polynomials and what reproduces the steps that no other mistake touches is one mistake, not
/// two.
#[test]
fn a_mistake_beside_another_is_told_once() {
    let rows = ["pe-radii-squared-apart", "failsafe-empty"].map(|id| student::find(id).expect("it is known"));
    let author = rows.iter().fold(Student::default(), |student, row| student.and(Some(row.mistake)));
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/t2m2/HolisticTests");
    let explained = ["funnel-of-fractional-masses", "rope-bridge", "pendulum-into-a-wall-of-balls"].map(|name| {
        #[expect(clippy::disallowed_methods, reason = "a test reads the scenes that come with the program")]
        let xml = std::fs::read(folder.join(name).with_extension("xml")).expect("a bundled scene");
        let scene = fosssim_model::scene::original::read(&xml).expect("a scene").scene;
        explain(&scene, &student::trace(&scene, author).unwrap_or_else(|(bytes, _)| bytes))
    });
    for list in &explained {
        let twice = |one: &&Explanation| rows.iter().any(|row| one.is_in_other_words(row));
        let named = list.iter().filter(|one| one.key == rows[0].id).chain(list.iter().filter(twice)).count();
        assert!(named <= 1, "{list:#?}");
    }
    let told = several(explained.iter().map(Vec::as_slice), &[]);
    let mut keys: Vec<&str> = told.iter().map(|one| one.key.as_str()).collect();
    keys.sort_unstable();
    assert_eq!(keys, ["failsafe-empty", "pe-radii-squared-apart"], "{told:#?}");
}

/// One of many traces that looks as if a stage were empty, beside a mistake that all of them show.
#[test]
fn one_of_many_traces_makes_no_stage_empty() {
    let said = |ids: &[&str]| {
        let of = |id: &&str| student::find(id).expect("it is known");
        let told = |row: &'static Row| Explanation {
            key: row.id.to_owned(),
            about: About::Mistake,
            details: Vec::new(),
            reproduced: 3,
            samples: 3,
            example: None,
            same_as: Vec::new(),
            denies: Vec::new(),
            claims: Vec::new(),
        };
        ids.iter().map(of).map(told).collect::<Vec<_>>()
    };
    let keys = |traces: &[Vec<Explanation>]| {
        several(traces.iter().map(Vec::as_slice), &[]).into_iter().map(|one| one.key).collect::<Vec<_>>()
    };
    let mut traces = vec![said(&["pp-linear-sign"]); 10];
    traces[3] = said(&["pp-linear-sign", "failsafe-empty"]);
    assert_eq!(keys(&traces)[0], "pp-linear-sign");
    traces[5] = traces[3].clone();
    assert_eq!(keys(&traces)[0], "failsafe-empty");
}

/// In one scene a zone is moved, in another one nothing is: the failsafe is not empty.
#[test]
fn a_stage_of_which_a_trace_shows_something_is_not_empty() {
    let scenes = probe_scenes(Assignment::T2M2);
    let row = |id| student::find(id).expect("it is known");
    let said = |program: &[&Row], probe: &str| {
        let author = program.iter().fold(Student::default(), |student, row| student.and(Some(row.mistake)));
        let (_, scene) = scenes.iter().find(|(name, _)| name == probe).expect("a probe scene");
        explain(scene, &student::trace(scene, author).unwrap_or_else(|(bytes, _)| bytes))
    };
    let empty = said(&[row("failsafe-empty")], "zones-turn-little-and-far");
    assert!(empty[0].key == "failsafe-empty" && empty[0].denies.contains(&"geometric-empty".to_owned()), "{empty:#?}");
    let partly = said(&[row("geometric-first-zone-only")], "zones-of-all-kinds");
    assert!(partly[0].denies.contains(&"failsafe-empty".to_owned()), "{partly:#?}");
    let told = several([empty.as_slice(), partly.as_slice()], &[]);
    assert!(told.iter().all(|one| !one.is_unfinished() && one.key != "failsafe-empty"), "{told:#?}");
}

/// Reads no more at a time than a record has.
struct Slowly<'a>(&'a [u8]);

impl std::io::Read for Slowly<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = buffer.len().min(64);
        self.0.read(&mut buffer[..count])
    }
}

/// Where a trace is too long to be kept, its wrong steps are, and are explained.
#[test]
fn mistakes_beyond_what_is_kept_are_explained() {
    let row = student::find("pe-radius-not-squared").expect("it is known");
    let (_, scene) =
        probe_scenes(Assignment::T2M2).into_iter().find(|(name, _)| name == "edges-struck").expect("a probe scene");
    let trace = student::trace(&scene, Student::new(Some(row.mistake))).expect("it comes to an end");
    let options = Options { threads: 1, fair: true, ..Options::default() };
    for most in [trace.len() / 4, Keep::EXPLAINED.most] {
        let keep = Keep { most, ..Keep::EXPLAINED };
        let examined = examine(&scene, Slowly(&trace), keep, &options, &mut ());
        assert_eq!(examined.trace.is_whole(), most > trace.len());
        let told = examined.explain();
        assert_eq!(told.first().map(|one| one.key.as_str()), Some(row.id), "{told:#?}");
    }
    let nothing = examine(&scene, &trace[..], Keep::NOTHING, &options, &mut ());
    assert!(nothing.explain().is_empty());
}
