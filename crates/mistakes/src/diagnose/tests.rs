//! Programs with several mistakes, asked about on the probe scenes.
use super::{Explanation, explain, probe_scenes, refuted, several};
use crate::student::{self, Area, CATALOGUE, Kind, Row, Student};
use fosssim_judge::{
    fair::Verdict,
    parity::{Options, judge},
};
use fosssim_model::scene::Scene;

/// What is said of a program that makes several mistakes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Said {
    /// All of them, and nothing else.
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
    let rows: Vec<&Row> = CATALOGUE.iter().filter(|row| row.kind == Kind::Wrong && row.area != Area::Trace).collect();
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

/// What is said of such a program after it has run on the probe scenes.
fn said_of(program: &[&Row]) -> (Said, String) {
    let student = program.iter().fold(Student::default(), |student, row| student.and(Some(row.mistake)));
    let options = Options { threads: 1, fair: true, ..Options::default() };
    let (mut explained, mut right): (Vec<Vec<Explanation>>, Vec<Scene>) = (Vec::new(), Vec::new());
    for (_, scene) in probe_scenes() {
        let trace = student::trace(&scene, student).unwrap_or_else(|(bytes, _)| bytes);
        let fair = judge(&scene, &trace[..], &options, &mut ()).fair.expect("the fair rules were asked");
        if fair.verdict == Verdict::Accepted {
            right.push(scene);
        } else {
            explained.push(explain(&scene, &trace));
        }
    }
    let traces: Vec<&[Explanation]> = explained.iter().map(Vec::as_slice).collect();
    let refuted = refuted(&traces, &right.iter().collect::<Vec<_>>());
    let told = several(traces, &refuted);
    let keys: Vec<String> =
        told.iter().flat_map(|one| std::iter::once(&one.key).chain(&one.same_as)).cloned().collect();
    let is_made = |one: &Explanation| match student::find(&one.key) {
        Some(_) => program.iter().any(|row| row.id == one.key || one.same_as.iter().any(|id| id == row.id)),
        None if one.key == Explanation::UNFINISHED => {
            one.same_as.iter().all(|id| program.iter().any(|row| row.id == id))
        }
        // What is said of polynomials in general.
        None => program.iter().any(|row| {
            let place = row.place();
            matches!(row.area, Area::Handover) || one.what.contains(place) || one.what.contains(&place.to_lowercase())
        }),
    };
    let named = program.iter().filter(|row| keys.iter().any(|key| key == row.id)).count();
    let said = match () {
        () if told.is_empty() => Said::Nothing,
        () if !told.iter().all(is_made) => Said::Wrong,
        () if named == program.len() => Said::All,
        () => Said::Some,
    };
    let ids: Vec<&str> = program.iter().map(|row| row.id).collect();
    (said, format!("{ids:?}: {said:?}: {:?}", told.iter().map(|one| (&one.key, &one.same_as)).collect::<Vec<_>>()))
}

/// Two or three mistakes of different parts of the assignment: nothing is named that the program does not do, and in eight of
/// ten something is.
#[test]
fn of_several_mistakes_some_are_named_and_no_other() {
    let said: Vec<(Said, String)> = programs().iter().map(|program| said_of(program)).collect();
    let count = |what: Said| said.iter().filter(|(said, _)| *said == what).count();
    let (all, some, nothing, wrong) = (count(Said::All), count(Said::Some), count(Said::Nothing), count(Said::Wrong));
    let lines: Vec<&String> = said.iter().filter(|(said, _)| *said != Said::All).map(|(_, line)| line).collect();
    assert_eq!(wrong, 0, "of {}: {all} all, {some} some, {nothing} nothing, {wrong} wrong\n{lines:#?}", said.len());
    assert!(10 * (all + some) >= 8 * said.len(), "{lines:#?}");
}
