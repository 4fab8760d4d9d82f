//! Explanations of programs with several mistakes, and with mistakes that the catalogue does not have.
use super::{Rated, Rating, rated, rating, told_of};
use crate::mutants::{Mutant, mutants};
use fosssim_oracle::{
    assignments::Assignment,
    diagnose::{About, Explanation, explain, probe_scenes},
    report::words::explanation::{details, what},
    sim::PairKind,
    student::{self, Area, CATALOGUE, Row, RowKind, Student},
};
use rayon::prelude::*;

/// The number of programs with one mistake outside of the catalogue and one of it.
const PROGRAMS: usize = 14;

/// The quality of the explanations of a program that makes several mistakes.
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

/// The explanations of a program with these mistakes.
fn said_of(program: &[&Row]) -> (Said, String) {
    let student = program.iter().fold(Student::default(), |student, row| student.and(Some(row.mistake)));
    let mut told = told_of(student);
    // That numbers end is no mistake, but what one leads to.
    told.retain(|one| !one.is_not_finite());
    let keys: Vec<String> =
        told.iter().flat_map(|one| std::iter::once(&one.key).chain(&one.same_as)).cloned().collect();
    // The sentences about polynomials and stages in general.
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
        // Rows that do the same everywhere can't be told apart.
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

/// Whether a program with the named mistakes leaves the same traces.
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

/// A mistake that nobody knows beside one of the catalogue: the explanation is about one of the two.
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
        let told = told_of(Student::new(Some(row.mistake)).with_change(&mutant.change));
        let is_false = |one: &&Explanation| {
            let is_row = one.key == row.id || one.same_as.iter().any(|id| id == row.id);
            let is_of_row = match &one.about {
                About::Stage(fault) => fault.areas().contains(&row.area),
                About::NotFinite(_) => true,
                about => {
                    row.area == Area::Handover || about.kinds().iter().any(|kind| Some(*kind) == row.kind_of_pair())
                }
            };
            !is_row && !is_of_row && rating(mutant, one) == Rating::Misleading
        };
        let wrong: Vec<&String> = told.iter().filter(is_false).map(|one| &one.key).collect();
        let all: Vec<&String> = told.iter().map(|one| &one.key).collect();
        (!wrong.is_empty()).then(|| format!("{} + {}: {wrong:?} of {all:?}", mutant.id, row.id))
    };
    let wrong: Vec<String> = programs.par_iter().filter_map(said).collect();
    assert!(wrong.is_empty(), "{} of {}: {wrong:#?}", wrong.len(), programs.len());
}

/// Mistakes that the catalogue does not have, one of four: nothing misleads, and in eight of ten something is said that
/// helps. `outside-table` has all.
#[test]
fn of_unknown_mistakes_the_place_is_told_and_none_is_taken_for_another() {
    let rated: Vec<Rated> = rated(|number, _| number % 4 == 1);
    let misleading: Vec<&Rated> = rated.iter().filter(|one| one.rating == Rating::Misleading).collect();
    assert!(misleading.is_empty(), "{misleading:#?}");
    let open: Vec<&Rated> = rated.iter().filter(|one| one.rating == Rating::Unknown).collect();
    assert!(5 * open.len() <= rated.len() && rated.len() >= 15, "{open:#?}");
}

/// The explanation of a mutant's trace of one probe scene.
fn said_on(id: &str, probe: &str) -> Explanation {
    let mutant = mutants().find(|mutant| mutant.id == id).expect("a mutant");
    let (_, scene) = probe_scenes(Assignment::T2M2).into_iter().find(|(name, _)| name == probe).expect("a probe scene");
    let trace = student::trace(&scene, Student::default().with_change(&mutant.change)).expect("it comes to an end");
    explain(&scene, &trace).into_iter().next().expect("an explanation")
}

#[test]
fn the_first_wrong_stage_is_told_with_what_its_results_have_in_common() {
    let cases = [
        (
            "order-kinds-apart",
            "zones-of-all-kinds",
            "Detection: The polynomials are right, but the pairs",
            "per particle",
        ),
        ("root-time-late", "edges-struck", "Detection: The contacts are right, but not their times", "1.1 times"),
        (
            "vector-doubled",
            "edges-struck",
            "Particle-edge contact vector: It has the right direction",
            "2 times as long",
        ),
        ("response-stronger", "edges-struck", "Collision response: ", "1.5 times what it should"),
        (
            "response-friction",
            "edges-struck",
            "Collision response: Velocities change also across",
            "across the contact",
        ),
        (
            "loop-at-most-two",
            "rounds-enough",
            "Impulse loop or detection: The loop makes fewer rounds",
            "2 detection passes instead of",
        ),
        ("rigid-half-turn", "zones-turn-little-and-far", "Rigid failsafe: Zones do not turn as far", "they turn 0."),
        ("rigid-shrinks", "zones-turn-little-and-far", "Rigid failsafe: ", ""),
        (
            "rigid-velocity-halved",
            "zones-turn-little-and-far",
            "Rigid failsafe: Velocities in a zone",
            "0.5 times the motion",
        ),
    ];
    let mut others = Vec::new();
    for (id, probe, wanted, detail) in cases {
        let said = said_on(id, probe);
        let lines = details(&said);
        let has_detail = detail.is_empty() || lines.iter().any(|line| line.contains(detail));
        if !what(&said).contains(wanted) || !has_detail {
            others.push(format!("{id} on {probe}: {} {lines:?}", what(&said)));
        }
    }
    assert!(others.is_empty(), "{others:#?}");
}
