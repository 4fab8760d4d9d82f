//! Finds mistakes that a program does not make, although its wrong traces suggest them.
use super::{
    Explanation,
    corrected_trace::correct_trace,
    explain::is_formula_area,
    joint_explanation::{area_stage, explain_together},
    known::{MistakeEffect, find_effect, is_empty_stage},
    naming::alternative_statements,
    non_finite::explain_source,
    sampling::Source,
    student_code::is_written_by_student,
    topic::ExplanationTopic,
};
use fosssim_model::{assignments::Assignment, scene::Scene};
use fosssim_student::{Area, Mistake, Student, find, record_limited_trace};
use std::{
    cell::Cell,
    collections::{BTreeMap, BTreeSet},
};

/// The maximum number of traces that are simulated to find out whether a mistake leads to values that are not finite.
const MAX_TRACES: usize = 6;

/// The maximum number of polynomials in a step. A program that computes more counts as endless.
const MAX_STEP_POLYNOMIALS: usize = 200_000;

/// Returns the keys of mistakes that the traces suggest, but that are in code that a student of this milestone does not
/// write.
fn find_supplied_keys(assignment: Assignment, wrong: &[(&Scene, &[Explanation])]) -> Vec<String> {
    let mut named_keys: BTreeMap<String, bool> = BTreeMap::new();
    for (_, list) in wrong {
        for key in list
            .iter()
            .flat_map(|explanation| alternative_statements(explanation).into_keys().chain([explanation.key.clone()]))
        {
            let is_own = match find(&key) {
                Some(row) => is_written_by_student(row, assignment),
                None => continue,
            };
            *named_keys.entry(key).or_default() |= is_own;
        }
    }
    named_keys.into_iter().filter(|(_, is_own)| !is_own).map(|(key, _)| key).collect()
}

/// Returns whether, for each trace with values that are not finite, one of the likely mistakes alone leads to such
/// values.
fn are_non_finite_values_explained(likely: &[Explanation], wrong: &[(&Scene, &[Explanation])]) -> bool {
    let mistakes =
        likely.iter().filter(|explanation| explanation.is_proven()).filter_map(|explanation| find(&explanation.key));
    let students: Vec<Student> = mistakes.map(|row| Student::new(Some(row.mistake))).collect();
    let is_explained =
        |scene: &Scene, student: Student| match record_limited_trace(scene, student, MAX_STEP_POLYNOMIALS) {
            Ok(trace) | Err((trace, _)) => !explain_source(scene, Source::from_trace(&trace)).is_empty(),
        };
    let mut non_finite =
        wrong.iter().filter(|(_, list)| list.iter().any(Explanation::reports_non_finite_value)).take(MAX_TRACES);
    non_finite.all(|(scene, _)| students.iter().any(|student| is_explained(scene, *student)))
}

/// The number of explained traces that one contradicting trace outweighs. A mistake that explains up to 8 traces is
/// dropped after one contradiction, up to 16 after two, and so on.
const NAMED_PER_CONTRADICTION: usize = 8;

/// Returns whether traces contradict a mistake of a stage. A trace contradicts the mistake if the same stage is wrong
/// in another way, although the mistake would show there. No other known mistake may explain this trace. If one of the
/// other likely mistakes (`others`) would show as well, the program may make both. A mistake in a formula is
/// contradicted by its own polynomials instead ([`evidence`](super::evidence)).
fn is_contradicted(key: &str, others: &[&str], wrong: &[(&Scene, &[Explanation])], refuted: &[String]) -> bool {
    let Some(row) = find(key).filter(|row| !is_formula_area(row.area)) else { return false };
    let (stage, concerns_state) = (area_stage(row.area), matches!(row.mistake, Mistake::Step(_)));
    if !concerns_state && (stage.is_none() || is_empty_stage(row)) {
        return false;
    }
    let names_mistake = |list: &[Explanation]| {
        list.iter().any(|explanation| alternative_statements(explanation).get(key) == Some(&true))
    };
    let has_same_stage =
        |explanation: &Explanation| explanation.names_stage() && (stage.is_none() || explanation.stage() == stage);
    let is_refuted = |explanation: &Explanation| {
        find(&explanation.key).is_some_and(|row| refuted.contains(&explanation.key) && area_stage(row.area) == stage)
    };
    let is_other = |explanation: &Explanation| explanation.is_complete() && !is_refuted(explanation);
    let is_open = |list: &[Explanation]| {
        let is_wrong = |explanation: &Explanation| {
            has_same_stage(explanation) || is_refuted(explanation) || explanation.key == key
        };
        !names_mistake(list) && list.iter().any(is_wrong) && !list.iter().any(is_other)
    };
    let explained_count = wrong.iter().filter(|(_, list)| names_mistake(list)).count();
    let needed = explained_count.div_ceil(NAMED_PER_CONTRADICTION);
    let work = Cell::new(0);
    let is_visible = |scene: &Scene, key: &str| find_effect(scene, key, &work) == MistakeEffect::Visible;
    // Two mistakes in the same force or integrator, whose keys begin with the same word, are rivals: a program makes
    // one of them.
    let is_rival = |other: &str| concerns_state && other.split('-').next() == key.split('-').next();
    let is_alone =
        |scene: &Scene| !others.iter().any(|other| !is_rival(other) && *other != key && is_visible(scene, other));
    let against = wrong.iter().filter(|(scene, list)| is_open(list) && is_visible(scene, key) && is_alone(scene));
    explained_count > 0 && against.take(needed).count() == needed
}

/// Returns the keys of mistakes that [`explain_together`] would report, or name as indistinguishable, and that the
/// program does not make. Such a mistake is in code that a student of this milestone does not write, or other wrong
/// traces contradict it. The program may also be right on a scene in which the mistake would show
/// ([`mistake_is_visible`](super::known::mistake_is_visible)). Each integrator has its own file, so only scenes with an
/// integrator show its mistakes. The key of values that are not finite is included if the reported mistakes lead to
/// such values.
pub fn refuted_keys(
    assignment: Option<Assignment>,
    wrong: &[(&Scene, &[Explanation])],
    right: &[&Scene],
) -> Vec<String> {
    let traces = || wrong.iter().map(|(_, list)| *list);
    let can_show = |scene: &Scene, key: &str| {
        let is_named =
            |list: &[Explanation]| list.iter().any(|explanation| alternative_statements(explanation).contains_key(key));
        find(key).is_none_or(|row| row.area != Area::Integrator)
            || wrong.iter().any(|(other, list)| other.integrator == scene.integrator && is_named(list))
    };
    let is_denied = |key: &str, work: &Cell<u64>| {
        right.iter().any(|scene| can_show(scene, key) && find_effect(scene, key, work) != MistakeEffect::Hidden)
    };
    let mut refuted: Vec<String> = assignment.map_or_else(Vec::new, |assignment| find_supplied_keys(assignment, wrong));
    loop {
        let likely = explain_together(traces(), &refuted);
        // An explanation of unfinished work includes all its empty stages.
        let stages = likely
            .iter()
            .filter(|explanation| explanation.is_unfinished())
            .flat_map(|explanation| &explanation.same_as);
        let mut keys =
            likely.iter().map(|explanation| &explanation.key).chain(stages).filter(|key| !refuted.contains(key));
        let others: Vec<&str> = keys.clone().map(String::as_str).collect();
        let is_false = |key: &str| is_denied(key, &Cell::new(0)) || is_contradicted(key, &others, wrong, &refuted);
        match keys.find(|key| is_false(key)).cloned() {
            Some(key) => refuted.push(key),
            None => {
                let work = Cell::new(0);
                let rivals = likely
                    .iter()
                    .filter(|explanation| explanation.topic == ExplanationTopic::Mistake)
                    .flat_map(|explanation| &explanation.same_as);
                // A trace that none of the likely mistakes explains keeps its own explanations.
                let left = traces().filter(|list| correct_trace(list, &likely, &refuted).agreed_count == 0).flatten();
                let own = left.flat_map(|explanation| explanation.same_as.iter().chain([&explanation.key]));
                let named: BTreeSet<&String> = rivals.chain(own).collect();
                let mut named: Vec<String> = named.into_iter().cloned().collect();
                named.retain(|key| !refuted.contains(key) && is_denied(key, &work));
                refuted.extend(named);
                if likely.iter().any(Explanation::reports_non_finite_value)
                    && are_non_finite_values_explained(&likely, wrong)
                {
                    refuted.push(Explanation::NOT_FINITE.to_owned());
                }
                return refuted;
            }
        }
    }
}
