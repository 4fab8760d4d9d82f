//! Combines the explanations of all traces of one program: the likeliest statement first, then further ones for the
//! unexplained rest ([`evidence`](super::evidence)).
use super::{
    Explanation, Guess,
    evidence::{OpenTrace, Symptom, collect_symptoms, find_likeliest, generalize_fault},
    explain::is_formula_area,
    fault::{StageFault, StepStage},
    known::is_empty_stage,
    naming::{explain_zero_coefficients, is_named_in},
    near_pairs,
    student_code::may_contain,
    topic::{ExplanationTopic, PolynomialEvidence},
};
use fosssim_student::{Area, CATALOG, Mistake, Row, StepMistake, assignments::t2m2::Subject, find};
use std::collections::{BTreeMap, BTreeSet};

/// The maximum number of mistakes reported for a program. All empty stages together count as one.
const MAX_MISTAKES: usize = 3;

/// With at least this many traces, a single trace is not enough evidence for an empty stage.
const MANY_TRACES: usize = 8;

/// Returns the likely mistakes of a program that wrote several traces, at most three. Stages that are still empty count
/// as one mistake together, and come first. `refuted` are keys of mistakes that correct traces of the same program
/// contradict. The explanation of the first value that is not finite does not count toward this limit. It comes last,
/// because such values follow from the other mistakes.
///
/// A single scene often cannot distinguish mistakes. Several scenes together nearly always distinguish them.
pub fn explain_together<'a>(
    traces: impl IntoIterator<Item = &'a [Explanation]>,
    refuted: &[String],
) -> Vec<Explanation> {
    let traces: Vec<&[Explanation]> = traces.into_iter().collect();
    // A stage that is visible in one trace is not empty, even if it is not visible in other traces.
    let denied: BTreeSet<&String> =
        traces.iter().copied().flatten().flat_map(|explanation| &explanation.contradicted_keys).collect();
    let is_refuted = |key: &String| refuted.contains(key) || denied.contains(key);
    let mut open: Vec<OpenTrace> = traces
        .iter()
        .map(|list| OpenTrace { symptoms: collect_symptoms(list, &is_refuted), is_covered: false })
        .filter(|trace| !trace.symptoms.is_empty())
        .collect();
    let mut wrong: Vec<Vec<Explanation>> =
        open.iter().map(|trace| trace.symptoms.iter().map(|symptom| symptom.explanation.clone()).collect()).collect();
    drop_consequences(&mut open);
    keep_earliest_stage(&mut open);
    let (mut found, mut empty): (Vec<Explanation>, Vec<Explanation>) = (Vec::new(), Vec::new());
    while found.len() + usize::from(!empty.is_empty()) < MAX_MISTAKES {
        let Some(next) = find_likeliest(&open) else { break };
        let statement = next.statement();
        let is_empty = find(&next.key).is_some_and(is_empty_stage);
        let is_reported = if is_empty {
            is_confirmed(&open, &statement)
        } else {
            (found.is_empty() && empty.is_empty())
                || (next.is_exhaustive() && is_supported(&open, &next, &found) && !is_repetition(&found, &next, &open))
        };
        if is_reported {
            remove_explained(&mut open, &statement);
            let zeros = explain_zero_coefficients(&next);
            match (is_empty, zeros.is_empty()) {
                (true, _) => empty.push(next),
                (false, false) => empty.extend(zeros),
                (false, true) => found.push(next),
            }
        } else {
            for trace in &mut open {
                trace.symptoms.iter_mut().for_each(|symptom| _ = symptom.allowed_statements.remove(&statement));
                trace.symptoms.retain(|symptom| {
                    !symptom.allowed_statements.is_empty() && symptom.explanation.statement() != statement
                });
            }
        }
    }
    drop_disputed([&mut found, &mut empty], &traces);
    let is_unwritten = |subject: &Subject| {
        let rows = empty.iter().filter_map(|explanation| find(&explanation.key));
        rows.filter(|row| is_formula_area(row.area))
            .any(|row| row.pair_kind().is_none_or(|kind| kind == subject.kind()))
    };
    // A trace in which stages are empty shows no other mistakes.
    wrong.retain(|list| !empty.iter().any(|explanation| is_named_in(explanation, list)));
    if let Some(head) = explain_wrong_polynomials(&wrong, &found, is_unwritten) {
        // After a wrong formula, later stages are wrong as a consequence.
        found.retain(|explanation| !explanation.names_stage());
        found.insert(0, head);
    }
    found.iter_mut().for_each(|explanation| generalize_fault(explanation, &traces));
    near_pairs::merge_explanations(&mut found, &traces);
    let end = explain_non_finite_value(&traces).filter(|explanation| !refuted.contains(&explanation.key));
    unite_empty_stages(empty).into_iter().chain(found).chain(end).collect()
}

/// Drops different mistakes in one quantity if no trace shows them together. The program makes one other mistake there,
/// which resembles them, so the stage is reported instead.
fn drop_disputed(lists: [&mut Vec<Explanation>; 2], traces: &[&[Explanation]]) {
    let term = |explanation: &Explanation| match find(&explanation.key)?.mistake {
        Mistake::Step(StepMistake::Edit(edit)) => Some(edit.term),
        _ => None,
    };
    let is_shown =
        |list: &[Explanation], explanation: &Explanation| list.iter().any(|other| other.key == explanation.key);
    let are_rivals = |one: &Explanation, other: &Explanation| {
        let is_same_term = one.key != other.key && term(one).is_some() && term(one) == term(other);
        is_same_term && !traces.iter().any(|list| is_shown(list, one) && is_shown(list, other))
    };
    let [found, empty] = lists;
    let all = [found.as_slice(), empty.as_slice()].concat();
    let has_rival = |explanation: &Explanation| all.iter().any(|other| are_rivals(explanation, other));
    found.retain(|explanation| !has_rival(explanation));
    empty.retain(|explanation| !has_rival(explanation));
    if found.len() + empty.len() < all.len() {
        let stages = || traces.iter().copied().flatten().filter(|explanation| explanation.names_stage());
        let count_agreeing = |explanation: &Explanation| stages().filter(|other| other.key == explanation.key).count();
        found.extend(stages().max_by_key(|explanation| count_agreeing(explanation)).cloned());
    }
}

/// Returns the explanation of the first values that are not finite, for the stage in which most traces contain them.
/// Returns `None` if all values are finite.
fn explain_non_finite_value(traces: &[&[Explanation]]) -> Option<Explanation> {
    let ends =
        || traces.iter().filter_map(|list| list.iter().find(|explanation| explanation.reports_non_finite_value()));
    let agreeing =
        |explanation: &Explanation| ends().filter(|other| other.statement() == explanation.statement()).count();
    let likeliest = ends().rev().max_by_key(|explanation| agreeing(explanation))?;
    let mut likeliest = likeliest.clone();
    if let ExplanationTopic::NotFinite(found) = &mut likeliest.topic
        && ends().count() > 1
    {
        found.step = None;
        found.recovers = ends()
            .any(|explanation| matches!(&explanation.topic, ExplanationTopic::NotFinite(other) if other.recovers));
    }
    Some(likeliest)
}

/// Returns one explanation for several empty stages. Their keys are in [`Explanation::same_as`]. A stage with another
/// explanation is reported separately.
fn unite_empty_stages(empty: Vec<Explanation>) -> Vec<Explanation> {
    let has_rival = |explanation: &Explanation| {
        explanation.same_as.iter().filter_map(|key| find(key)).any(|row| !is_empty_stage(row))
    };
    let (doubted, sure): (Vec<Explanation>, Vec<Explanation>) = empty.into_iter().partition(has_rival);
    if sure.len() < 2 {
        return sure.into_iter().chain(doubted).collect();
    }
    let mut keys: Vec<String> = sure.iter().map(|explanation| explanation.key.clone()).collect();
    keys.sort_by_key(|key| CATALOG.iter().position(|row| row.id == *key));
    let all = Explanation {
        reproduced: sure.iter().map(|explanation| explanation.reproduced).sum(),
        samples: sure.iter().map(|explanation| explanation.samples).sum(),
        same_as: keys,
        ..Explanation::with_topic(Explanation::UNFINISHED, ExplanationTopic::Unfinished)
    };
    std::iter::once(all).chain(doubted).collect()
}

/// Returns an explanation that names the polynomials that are wrong in the most traces. It contains the most frequent
/// guess about them, unless too many traces contradict this guess. Returns `None` if they are wrong in at most half of
/// the traces, or if `found` covers them.
fn explain_wrong_polynomials(
    traces: &[Vec<Explanation>],
    found: &[Explanation],
    is_unwritten: impl Fn(&Subject) -> bool,
) -> Option<Explanation> {
    let mut wrong: BTreeMap<Subject, usize> = BTreeMap::new();
    for list in traces {
        let is_formula_row =
            |explanation: &&Explanation| find(&explanation.key).is_some_and(|row| is_formula_area(row.area));
        let polynomial_explanations = list.iter().filter(|explanation| {
            matches!(explanation.topic, ExplanationTopic::Polynomials { .. }) || is_formula_row(explanation)
        });
        let subjects: BTreeSet<Subject> = polynomial_explanations.flat_map(Explanation::subjects).collect();
        let subjects = subjects.into_iter().filter(|subject| !is_unwritten(subject));
        subjects.for_each(|subject| *wrong.entry(subject).or_default() += 1);
    }
    let max_count = wrong.values().copied().max()?;
    let count_traces = |explanation: &Explanation| traces.iter().filter(|list| is_named_in(explanation, list)).count();
    let is_reported = found.iter().any(|explanation| !explanation.subjects().is_empty())
        || found.first().is_some_and(|first| count_traces(first) >= max_count);
    // A fault in only a few traces may follow from another mistake.
    if is_reported || max_count * 2 <= traces.len() {
        return None;
    }
    let subjects: Vec<Subject> =
        wrong.into_iter().filter(|(_, count)| *count == max_count).map(|(subject, _)| subject).collect();
    let guesses = traces.iter().flatten().filter_map(|explanation| match &explanation.topic {
        ExplanationTopic::Polynomials { subjects: theirs, found: PolynomialEvidence::Guess(guess) }
            if *theirs == subjects =>
        {
            Some(guess)
        }
        _ => None,
    });
    let is_known = |head: &Explanation| {
        matches!(&head.topic, ExplanationTopic::Polynomials { found: PolynomialEvidence::Guess(Guess::Named(_)), .. })
    };
    let heads = guesses
        .map(|guess| Explanation::for_wrong_polynomials(subjects.clone(), PolynomialEvidence::Guess(guess.clone())));
    let likeliest = heads.map(|head| (count_traces(&head), head)).max_by_key(|(named, _)| *named);
    match likeliest {
        // A known formula is tried on every trace, so only few traces may contradict it.
        Some((named, head)) if max_count.saturating_sub(named) * if is_known(&head) { 8 } else { 2 } < max_count => {
            Some(head)
        }
        _ => Some(Explanation::for_wrong_polynomials(subjects, PolynomialEvidence::Nothing)),
    }
}

/// Returns whether an explained trace also needs this known mistake.
fn is_needed(next: &Explanation, traces: &[OpenTrace]) -> bool {
    let statement = next.statement();
    traces.iter().any(|trace| trace.is_covered && trace.requires_statement(&statement))
}

/// Returns whether a further mistake repeats a reported one under another name. A program has one formula for each
/// polynomial and contact vector. The symptoms of a stage may follow from a mistake that is reported for this stage or
/// for an earlier one.
fn is_repetition(found: &[Explanation], next: &Explanation, traces: &[OpenTrace]) -> bool {
    let are_needed = is_needed(next, traces);
    let subjects = next.subjects();
    let has_details = |explanation: &Explanation| {
        if are_needed && matches!(explanation.topic, ExplanationTopic::Mistake) {
            return false;
        }
        let theirs = explanation.subjects();
        // If a trace does not show a polynomial of a known mistake, that mistake may be the cause of a reported guess.
        let is_guess = matches!(explanation.topic, ExplanationTopic::Polynomials { .. });
        let kind = find(&next.key).filter(|row| is_formula_area(row.area)).and_then(Row::pair_kind);
        let share_formula = match kind.filter(|_| is_guess && subjects.is_empty()) {
            Some(kind) => theirs.iter().any(|subject| subject.kind() == kind),
            None => !subjects.is_empty() && subjects.iter().all(|subject| theirs.contains(subject)),
        };
        let share_stage = match (&explanation.topic, &next.topic) {
            (ExplanationTopic::Stage(explanation), ExplanationTopic::Stage(next)) => {
                let are_apart = match (explanation, next) {
                    (StageFault::Change(explanation), StageFault::Change(next)) => !explanation.may_share_part(next),
                    _ => explanation.kind().zip(next.kind()).is_some_and(|(explanation, next)| explanation != next),
                };
                explanation.stage() == next.stage() && !are_apart
            }
            (_, ExplanationTopic::Stage(fault)) => find(&explanation.key).is_some_and(|row| {
                may_contain(fault, row) || area_stage(row.area).is_some_and(|stage| stage <= fault.stage())
            }),
            (ExplanationTopic::Stage(fault), _) => find(&next.key).is_some_and(|row| may_contain(fault, row)),
            _ => false,
        };
        let is_vector_row = |row: &&Row| row.area == Area::ContactVector && row.pair_kind().is_some();
        let vector_rows = find(&explanation.key).filter(is_vector_row).zip(find(&next.key).filter(is_vector_row));
        let share_vector = vector_rows.is_some_and(|(explanation, next)| explanation.pair_kind() == next.pair_kind());
        share_formula || share_stage || share_vector
    };
    found.iter().any(has_details)
}

/// Drops explanations that name a stage, if one of the traces is explained by a mistake that is visible only in states.
/// The faults of stages may be consequences of this mistake.
fn drop_consequences(traces: &mut Vec<OpenTrace>) {
    let is_state_mistake =
        |statement: &String| find(statement).is_some_and(|row| matches!(row.mistake, Mistake::Step(_)));
    let names_one = |symptom: &Symptom| {
        symptom.allowed_statements.iter().any(|(statement, is_whole)| *is_whole && is_state_mistake(statement))
    };
    if traces.iter().flat_map(|trace| &trace.symptoms).any(names_one) {
        traces.iter_mut().for_each(|trace| trace.symptoms.retain(|symptom| !symptom.explanation.names_stage()));
        traces.retain(|trace| !trace.symptoms.is_empty());
    }
}

/// Keeps only the explanations of the earliest stage, because later faults may follow from it. Also drops known
/// mistakes of that stage or a later one if they explain fewer traces than have a fault in the stage. Such mistakes
/// only resemble the fault.
fn keep_earliest_stage(traces: &mut Vec<OpenTrace>) {
    let all = || traces.iter().flat_map(|trace| &trace.symptoms).map(|symptom| &symptom.explanation);
    let Some(earliest) = all().filter_map(Explanation::stage).min() else { return };
    let is_in_earliest = |explanation: &Explanation| explanation.stage() == Some(earliest);
    let kind_of = |explanation: &Explanation| {
        if let ExplanationTopic::Stage(fault) = &explanation.topic { fault.kind() } else { None }
    };
    let observed = |row: &Row| {
        let has_row_kind =
            |explanation: &Explanation| row.pair_kind().is_none_or(|kind| kind_of(explanation) == Some(kind));
        let is_concerned = |trace: &&OpenTrace| {
            trace
                .symptoms
                .iter()
                .any(|symptom| is_in_earliest(&symptom.explanation) && has_row_kind(&symptom.explanation))
        };
        traces.iter().filter(is_concerned).count()
    };
    let late = CATALOG.iter().filter(|row| area_stage(row.area).is_some_and(|stage| stage >= earliest));
    let count_explained = |row: &Row| traces.iter().filter(|trace| trace.allows_complete_statement(row.id)).count();
    let weak: Vec<&str> = late.filter(|row| count_explained(row) < observed(row)).map(|row| row.id).collect();
    // An explanation of a fault in the stage replaces explanations that only name the stage.
    let has_details = all().any(|explanation| is_in_earliest(explanation) && !explanation.is_vague());
    // If pairs are in another order or left out, the polynomials of one pair are compared with those of another.
    let is_misread = |explanation: &Explanation| find(&explanation.key).is_none() && explanation.stage().is_none();
    let has_order = all().any(Explanation::is_about_pairs);
    for trace in traces.iter_mut() {
        trace.symptoms.retain_mut(|symptom| {
            symptom.allowed_statements.retain(|statement, _| !weak.contains(&statement.as_str()));
            let one = &symptom.explanation;
            let is_weak = weak.contains(&one.key.as_str()) || (has_order && is_misread(one));
            !(is_weak || (has_details && one.is_vague())) && one.stage().is_none_or(|stage| stage == earliest)
        });
    }
    traces.retain(|trace| !trace.symptoms.is_empty());
}

/// Returns the stage of a step in which mistakes of an area are made, or `None` for polynomials and for the trace.
pub(super) const fn area_stage(area: Area) -> Option<StepStage> {
    match area {
        Area::Decision => Some(StepStage::Detection),
        Area::ContactVector => Some(StepStage::ContactVectors),
        Area::Response | Area::ContinuousTime | Area::ImpulseLoop => Some(StepStage::Responses),
        Area::ImpactZones | Area::Failsafe => Some(StepStage::Zones),
        _ => None,
    }
}

/// Returns whether enough traces suggest that the stage is empty.
fn is_confirmed(traces: &[OpenTrace], statement: &str) -> bool {
    traces.len() < MANY_TRACES || traces.iter().filter(|trace| trace.allows_complete_statement(statement)).count() > 1
}

/// Returns whether enough traces suggest another mistake. One of these is enough:
///
/// - A trace that is not explained yet suggests it.
/// - A trace that is already explained needs it in addition to a reported mistake.
/// - Two traces that are already explained suggest it, or one if there is no other trace.
fn is_supported(traces: &[OpenTrace], next: &Explanation, found: &[Explanation]) -> bool {
    let statement = next.statement();
    let naming = |is_covered: bool| {
        traces
            .iter()
            .filter(|trace| trace.is_covered == is_covered && trace.allows_complete_statement(&statement))
            .count()
    };
    // A wrong stage must be suggested by two traces that are not explained yet.
    if next.names_stage() {
        return naming(false) > 1 && !next.is_vague();
    }
    let is_partner = matches!(next.topic, ExplanationTopic::Mistake) && is_needed(next, traces);
    let is_formula = find(&next.key).is_none_or(|row| is_formula_area(row.area));
    // Among many traces, or if the mistake of a wrong stage is unknown, one trace may fit a known mistake by chance.
    let may_be_chance = !is_formula && (traces.len() >= MANY_TRACES || found.iter().any(Explanation::names_stage));
    // Missing polynomials may follow from an earlier mistake.
    !next.reports_missing_polynomials()
        && (naming(false) > usize::from(may_be_chance) || is_partner || naming(true) >= traces.len().min(2))
}

/// Removes everything that a mistake explains. If the mistake explains a trace, only the trace's other complete
/// explanations are kept.
fn remove_explained(traces: &mut [OpenTrace], statement: &str) {
    for trace in traces.iter_mut().filter(|trace| trace.allows_statement(statement)) {
        trace.is_covered = true;
        trace
            .symptoms
            .retain(|symptom| !symptom.allowed_statements.contains_key(statement) && symptom.explanation.is_complete());
    }
}
