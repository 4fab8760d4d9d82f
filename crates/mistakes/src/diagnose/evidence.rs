//! The evidence for a mistake: the symptoms in all traces that it would explain.
//!
//! Each explanation of a trace is a symptom. Its alternatives are all statements ([`Explanation::statement`]) that
//! would explain the trace as well. The statement that most traces allow is the likeliest. Statements allowed by
//! exactly the same symptoms cannot be distinguished, unless another trace with wrong polynomials of the same kind
//! rules out one of them.
use super::{
    Detail, Explanation, Guess, PolynomialDetail, Weight,
    explain::is_formula_area,
    fault::{ChangeRatio, ChangedParticles, Quantity, StageFault, WrongChange, WrongVectors},
    naming::{alternative_statements, explain_by_row},
    polynomial::claim_of_form,
    student_code::changed_term,
    topic::{ExplanationTopic, PolynomialEvidence},
};
use fosssim_model::assignments::Part;
use fosssim_student::{Mistake, Term, find};
use std::collections::{BTreeMap, BTreeSet};

/// An explanation of a trace, and the statements that would explain it as well. The flag of a statement is true if it
/// explains the whole trace.
#[derive(Clone)]
pub(super) struct Symptom {
    pub(super) explanation: Explanation,
    pub(super) allowed_statements: BTreeMap<String, bool>,
}

/// A trace, and the part of it that is still unexplained.
pub(super) struct OpenTrace {
    pub(super) symptoms: Vec<Symptom>,
    /// Whether a reported explanation covers a part of the trace.
    pub(super) is_covered: bool,
}

impl OpenTrace {
    pub(super) fn allows_statement(&self, statement: &str) -> bool {
        self.symptoms.iter().any(|symptom| symptom.allowed_statements.contains_key(statement))
    }

    pub(super) fn allows_complete_statement(&self, statement: &str) -> bool {
        self.symptoms.iter().any(|symptom| symptom.allowed_statements.get(statement) == Some(&true))
    }

    /// Returns whether the trace needs this mistake in addition to others: they reproduce it together, but not
    /// separately.
    pub(super) fn requires_statement(&self, statement: &str) -> bool {
        self.symptoms.iter().any(|symptom| symptom.explanation.is_complete() && symptom.explanation.key == statement)
    }
}

/// Returns the symptoms of a trace without the refuted statements.
pub(super) fn collect_symptoms(list: &[Explanation], is_refuted: &impl Fn(&String) -> bool) -> Vec<Symptom> {
    let to_symptom = |explanation: &Explanation| {
        if is_refuted(&explanation.key) && find(&explanation.key).is_none() {
            return None;
        }
        let mut allowed = alternative_statements(explanation);
        allowed.retain(|statement, _| !is_refuted(statement));
        let mut same_as: Vec<String> = explanation.same_as.iter().filter(|key| !is_refuted(key)).cloned().collect();
        let is_reported = allowed.contains_key(&explanation.statement());
        let explanation = match same_as.iter().position(|key| find(key).is_some()) {
            _ if is_reported => Explanation { same_as, ..explanation.clone() },
            Some(place) => explain_by_row(explanation, find(&same_as.remove(place))?, same_as),
            None => match allowed.keys().find_map(|statement| find(statement)) {
                Some(row) => explain_by_row(explanation, row, same_as),
                None => {
                    let part = explain_by_part(explanation)?;
                    allowed.insert(part.statement(), true);
                    part
                }
            },
        };
        Some(Symptom { explanation, allowed_statements: allowed })
    };
    list.iter()
        .filter(|explanation| explanation.is_about_program() || !explanation.claims.is_empty())
        .filter_map(to_symptom)
        .collect()
}

/// Returns the explanation that names only the part of the student's code that contains a refuted mistake. The mistake
/// reproduces the trace, so no other part is wrong in it. Returns `None` if the mistake does not change velocities.
fn explain_by_part(refuted: &Explanation) -> Option<Explanation> {
    let row = find(&refuted.key).filter(|row| matches!(row.mistake, Mistake::Step(_)))?;
    let part = changed_term(row).row().part;
    let changes_velocities = matches!(part, Part::Force(_) | Part::Penalty(_) | Part::SimpleResponse(_));
    // A row about all kinds of pairs has the part of one of them.
    if !changes_velocities || changed_term(row) == Term::Penalty || !refuted.is_complete() {
        return None;
    }
    let (quantity, particles, ratio) = (Quantity::Velocity, ChangedParticles::Any, ChangeRatio::Other);
    let wrong = WrongChange { quantity, axis: None, particles, ratio, parts: BTreeSet::from([part]) };
    let fault = StageFault::Change(wrong);
    let topic = Explanation::with_topic(fault.key(), ExplanationTopic::Stage(fault));
    Some(Explanation { samples: refuted.samples, example: refuted.example.clone(), ..topic })
}

/// The evidence for one statement.
#[derive(Default)]
struct Support<'a> {
    /// The symptoms that allow the statement. Each is the index of a trace, and an index into its symptoms.
    symptoms: BTreeSet<(usize, usize)>,
    traces: usize,
    complete_traces: usize,
    /// The number of traces whose first explanation is the statement.
    leading_traces: usize,
    /// The number of traces in which the same quantity is wrong, in any way, if the statement is about a stage.
    related_traces: usize,
    /// The number of traces in which the same polynomials are wrong in another way.
    contradicting_traces: usize,
    /// The most detailed explanation with this statement.
    reported: Option<&'a Explanation>,
    /// Whether the statement is a mistake of the catalog or a known formula. These are tried on every trace.
    is_known: bool,
}

impl Support<'_> {
    /// Returns whether at least as many traces contradict a guess about polynomials as support it. A known formula is
    /// tried on every trace, so an eighth of the supporting traces is enough.
    fn is_denied(&self) -> bool {
        self.contradicting_traces > 0
            && self.contradicting_traces * if self.is_known { 8 } else { 1 } >= self.complete_traces
    }

    /// Returns the weight of an explanation. Every symptom of a stage shows that the stage is wrong; the most frequent
    /// symptoms show how it is wrong.
    fn weight(&self) -> (usize, usize, usize) {
        (self.complete_traces.max(self.related_traces), self.traces.max(self.related_traces), self.complete_traces)
    }
}

fn collect_evidence(traces: &[OpenTrace]) -> BTreeMap<&str, Support<'_>> {
    let mut all: BTreeMap<&str, Support<'_>> = BTreeMap::new();
    for (number, trace) in traces.iter().enumerate() {
        for (index, symptom) in
            trace.symptoms.iter().enumerate().filter(|(_, symptom)| symptom.explanation.is_about_program())
        {
            let own_statement = symptom.explanation.statement();
            for statement in symptom.allowed_statements.keys() {
                let evidence = all.entry(statement.as_str()).or_default();
                evidence.symptoms.insert((number, index));
                evidence.leading_traces += usize::from(index == 0 && *statement == own_statement);
                // If several explanations have the same statement, the most detailed one is used.
                let rank_of =
                    |explanation: &Explanation| (explanation.is_exhaustive(), !explanation.details.is_empty());
                let says_more = |reported: &Explanation| rank_of(reported) < rank_of(&symptom.explanation);
                if *statement == own_statement && evidence.reported.is_none_or(says_more) {
                    evidence.reported = Some(&symptom.explanation);
                }
            }
        }
    }
    for (statement, evidence) in &mut all {
        let row = find(statement);
        let is_named = |reported: &Explanation| {
            matches!(
                &reported.topic,
                ExplanationTopic::Polynomials { found: PolynomialEvidence::Guess(Guess::Named(_)), .. }
            )
        };
        evidence.is_known = row.is_some() || evidence.reported.is_some_and(is_named);
        let first_symptom = evidence.symptoms.first().copied();
        let first = first_symptom.map(|(trace, index)| &traces[trace].symptoms[index].explanation);
        let as_told = row.zip(first).map(|(row, first)| explain_by_row(first, row, Vec::new()));
        for trace in traces {
            let reported = evidence.reported;
            let has_key = |key: &str| trace.symptoms.iter().any(|symptom| symptom.explanation.key == key);
            evidence.related_traces +=
                usize::from(reported.is_some_and(|reported| reported.names_stage() && has_key(&reported.key)));
            evidence.complete_traces += usize::from(trace.allows_complete_statement(statement));
            if trace.allows_statement(statement) {
                evidence.traces += 1;
            } else if reported.or(as_told.as_ref()).is_some_and(|reported| {
                trace.symptoms.iter().any(|symptom| contradicts(&symptom.explanation, reported))
            }) {
                evidence.contradicting_traces += 1;
            }
        }
    }
    all
}

/// Returns whether an explanation of a trace that does not allow `reported` contradicts it: both are about the same
/// polynomials.
fn contradicts(one: &Explanation, reported: &Explanation) -> bool {
    let concerns_formula = match &reported.topic {
        ExplanationTopic::Polynomials { found, .. } => matches!(found, PolynomialEvidence::Guess(_)),
        ExplanationTopic::Mistake => {
            find(&reported.key).is_some_and(|row| row.pair_kind().is_some() && is_formula_area(row.area))
        }
        _ => false,
    };
    let subjects = reported.subjects();
    concerns_formula && one.subjects().iter().any(|subject| subjects.contains(subject))
}

/// Returns the likeliest mistake behind the open symptoms, which is the mistake that most traces allow. On a tie,
/// mistakes of the catalog come first, then the mistake that is more often the first explanation, then the earlier
/// one. Returns `None` if no mistake is likely.
pub(super) fn find_likeliest(traces: &[OpenTrace]) -> Option<Explanation> {
    let all = collect_evidence(traces);
    let is_known = |statement: &str| find(statement).is_some();
    let is_likely = |(statement, support): &(&&str, &Support<'_>)| {
        !support.is_denied() && (support.reported.is_some() || is_known(statement))
    };
    let (&statement, best) = all.iter().filter(is_likely).max_by(|(statement, a), (other, b)| {
        let known_order = is_known(statement).cmp(&is_known(other));
        let order = b.symptoms.first().cmp(&a.symptoms.first());
        a.weight().cmp(&b.weight()).then(known_order).then(a.leading_traces.cmp(&b.leading_traces)).then(order)
    })?;
    // Statements that the same symptoms allow cannot be distinguished.
    let is_rival = |(other, rival): &(&&str, &Support<'_>)| {
        **other != statement && is_known(other) && rival.symptoms == best.symptoms && rival.weight() == best.weight()
    };
    let mut rivals: Vec<(&&str, &Support<'_>)> = all.iter().filter(is_rival).collect();
    rivals.sort_by_key(|(_, rival)| std::cmp::Reverse(rival.leading_traces));
    let same_as = rivals.into_iter().map(|(other, _)| (*other).to_owned()).collect();
    let Some(reported) = best.reported else {
        let &(trace, index) = best.symptoms.first()?;
        return Some(explain_by_row(&traces[trace].symptoms[index].explanation, find(statement)?, same_as));
    };
    Some(Explanation { same_as, ..merge_explanations(reported, traces) })
}

/// Returns an explanation with the polynomials of all traces that report the same mistake. It has only those details of
/// the wrong formula that all of these traces allow.
fn merge_explanations(reported: &Explanation, traces: &[OpenTrace]) -> Explanation {
    let mut reported = reported.clone();
    let statement = reported.statement();
    // In a contradicting trace nothing is reproduced, so only its samples are counted.
    let against = traces.iter().filter(|trace| !trace.allows_statement(&statement)).flat_map(|trace| &trace.symptoms);
    reported.samples += against
        .filter(|symptom| contradicts(&symptom.explanation, &reported))
        .map(|symptom| symptom.explanation.samples)
        .sum::<u64>();
    let ExplanationTopic::Polynomials { subjects, found } = &mut reported.topic else { return reported };
    let agreeing: Vec<&Symptom> = traces
        .iter()
        .flat_map(|trace| &trace.symptoms)
        .filter(|symptom| symptom.allowed_statements.contains_key(&statement))
        .collect();
    for symptom in agreeing.iter().filter(|symptom| symptom.explanation.statement() == statement) {
        if let ExplanationTopic::Polynomials { subjects: theirs, .. } = &symptom.explanation.topic {
            subjects.extend(theirs);
        }
    }
    subjects.sort_unstable();
    subjects.dedup();
    if let ([subject], PolynomialEvidence::Guess(guess)) = (&subjects[..], found) {
        let forms = list_alternative_forms(&reported.details);
        let is_allowed = |form: &Vec<PolynomialDetail>| {
            let claim = claim_of_form(*subject, guess, form);
            agreeing.iter().all(|symptom| symptom.allowed_statements.contains_key(&claim))
        };
        let mut keep = forms.iter().map(is_allowed);
        reported.details.retain(|detail| !is_alternative(detail) || keep.next() == Some(true));
    }
    reported
}

/// Removes from a fault of contact vectors or states what other traces contradict. If the fault changes, its details
/// are removed as well, because they are those of one trace.
pub(super) fn generalize_fault(reported: &mut Explanation, traces: &[&[Explanation]]) {
    let Explanation { topic: ExplanationTopic::Stage(fault), details, .. } = reported else { return };
    let before = fault.clone();
    for one in traces.iter().copied().flatten() {
        let ExplanationTopic::Stage(other) = &one.topic else { continue };
        match (&mut *fault, other) {
            (StageFault::ContactVectors { kind, wrong }, StageFault::ContactVectors { kind: of, wrong: other })
                if kind == of && wrong != other =>
            {
                *wrong = WrongVectors::Direction;
            }
            (StageFault::Change(own), StageFault::Change(other)) if own.may_share_part(other) => {
                own.parts.retain(|part| other.parts.contains(part));
                own.axis = own.axis.filter(|_| own.axis == other.axis);
                own.particles = if own.particles == other.particles { own.particles } else { ChangedParticles::Any };
                let is_same = own.ratio == other.ratio && (own.ratio != ChangeRatio::Factor || one.details == *details);
                own.ratio = if is_same { own.ratio } else { ChangeRatio::Other };
            }
            _ => {}
        }
    }
    if *fault != before {
        details.clear();
    }
}

const fn is_alternative(detail: &Detail) -> bool {
    matches!(detail, Detail::Polynomial(PolynomialDetail::Alternative(_)))
}

/// Returns the details of a formula once with each of its alternative weights.
fn list_alternative_forms(details: &[Detail]) -> Vec<Vec<PolynomialDetail>> {
    let polynomial = |detail: &Detail| match detail {
        Detail::Polynomial(detail) => Some(detail.clone()),
        _ => None,
    };
    let all: Vec<PolynomialDetail> = details.iter().filter_map(polynomial).collect();
    let alternatives = all.iter().filter_map(|detail| match detail {
        PolynomialDetail::Alternative(weights) => Some(weights),
        _ => None,
    });
    let with = |weights: &Vec<Weight>| {
        let power = weights.first().map(|weight| weight.power);
        let mut own = Some(weights.iter().cloned().map(PolynomialDetail::Weight));
        let mut form = Vec::new();
        for detail in &all {
            match detail {
                PolynomialDetail::Alternative(_) => {}
                PolynomialDetail::Weight(weight) if Some(weight.power) == power => {
                    form.extend(own.take().into_iter().flatten());
                }
                other => form.push(other.clone()),
            }
        }
        form
    };
    alternatives.map(with).collect()
}
