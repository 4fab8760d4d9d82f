//! Describes explanations in sentences.
//!
//! Sentences that depend on an assignment are found by their keys in the assignment's data: the known mistakes, and the
//! meanings of letters. All other sentences are in this module.
mod letters;
mod non_finite;
mod places;
mod polynomials;
mod stages;
mod wrong_pairs;

use fosssim_mistakes::diagnose::{
    Detail, Explanation, ExplanationTopic, PolynomialDetail, PolynomialEvidence, find_formula,
};
use fosssim_student::{Area, Mistake, Row, StepMistake, find};

pub(crate) use letters::explain_letters;
pub(crate) use places::describe_place;

/// Describes the mistake in one sentence for the student. The sentence does not reveal a formula.
pub fn describe(explanation: &Explanation) -> String {
    let sentence = match &explanation.topic {
        ExplanationTopic::Mistake => {
            known_sentence(&explanation.key).unwrap_or_else(|| format!("{}.", explanation.key))
        }
        ExplanationTopic::Unfinished => format!("Not written yet: {}.", describe_unfinished(&explanation.same_as)),
        ExplanationTopic::Scene { has_length } => {
            let length = if *has_length { "" } else { ", and its length does not match the scene" };
            format!("Does this trace belong to this scene? Its first record differs from the scene's start{length}.")
        }
        ExplanationTopic::Polynomials { subjects, found } => polynomials::describe_evidence(subjects, found),
        ExplanationTopic::Stage(fault) => stages::describe(fault),
        ExplanationTopic::Pairs(wrong) => wrong_pairs::describe(wrong),
        ExplanationTopic::NotFinite(found) => non_finite::describe(found),
    };
    debug_assert!(find_formula(&sentence).is_none(), "a sentence gives a formula away: {sentence}");
    sentence
}

/// Describes the mistake, together with other mistakes that the traces can't distinguish from it. The text is for lists
/// of a program's mistakes.
pub fn describe_with_alternatives(explanation: &Explanation) -> String {
    let rivals = explanation.same_as.iter().filter(|_| explanation.topic == ExplanationTopic::Mistake);
    let rivals: Vec<String> = rivals.filter_map(|key| known_sentence(key)).collect();
    let sentence = describe(explanation);
    match rivals.as_slice() {
        [] => sentence,
        [one] => format!("{sentence} Another mistake gives the same traces: {one}"),
        [one, other] => format!("{sentence} Two other mistakes give the same traces: {one} {other}"),
        [one, others @ ..] => {
            format!("{sentence} Another mistake gives the same traces: {one} So do {} more mistakes.", others.len())
        }
    }
}

/// Returns lines with the exact form of the mistake: the terms of each coefficient, and the weights of the terms. The
/// exact form may reveal the right formula. If the mistake is a known one that the reference has reproduced, its term
/// is enough, and lines about weights are left out.
pub fn list_details(explanation: &Explanation) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let is_exact = explanation.details.iter().any(|detail| matches!(detail, Detail::Term(_)));
    if let (ExplanationTopic::Pairs(wrong), [_, ..]) = (&explanation.topic, &explanation.details[..]) {
        lines.extend(wrong_pairs::list_details(wrong));
    }
    for detail in &explanation.details {
        let line = match detail {
            Detail::Term(key) => find(key).map(|row| row.term.to_owned()),
            Detail::SearchArea(Area::Integrator) => Some(describe_step_area(&explanation.key).to_owned()),
            Detail::SearchArea(area) => Some(area.advice().to_owned()),
            Detail::Letters(kinds) => letters::explain_letters(&lines, kinds),
            Detail::Polynomial(PolynomialDetail::Weight(_) | PolynomialDetail::Alternative(_)) if is_exact => None,
            Detail::Polynomial(detail) => Some(polynomials::describe_detail(detail)),
            Detail::Stage(detail) => stages::describe_detail(detail),
        };
        lines.extend(line);
    }
    lines
}

/// Returns only the exact forms of polynomials that no known mistake explains, one line per term.
pub(crate) fn list_exact_forms(explanation: &Explanation) -> Vec<String> {
    let is_form = |detail: &&Detail| matches!(detail, Detail::Polynomial(_)) && !explanation.is_unexplained();
    let details = explanation.details.iter().filter(is_form).cloned().collect();
    match explanation.topic {
        ExplanationTopic::Polynomials { .. } => self::list_details(&Explanation { details, ..explanation.clone() }),
        _ => Vec::new(),
    }
}

/// Returns advice about where in the program a wrong stage probably is; `None` for explanations that are not about a
/// stage.
pub(crate) fn describe_search_area(explanation: &Explanation) -> Option<&'static str> {
    match &explanation.topic {
        ExplanationTopic::Stage(fault) => fault.areas().first().map(|area| area.advice()),
        _ => None,
    }
}

/// Returns whether an explanation says more than that something is wrong.
pub(crate) fn is_specific(explanation: &Explanation) -> bool {
    !matches!(explanation.topic, ExplanationTopic::Polynomials { found: PolynomialEvidence::Nothing, .. })
}

/// Returns the sentence about a known mistake; `None` if the key is not in a catalog.
pub(crate) fn known_sentence(key: &str) -> Option<String> {
    find(key).map(Row::sentence)
}

/// Lists the stages that are not written, in a few words each.
fn describe_unfinished(keys: &[String]) -> String {
    let mut stages: Vec<String> = Vec::new();
    let mut detections: [Vec<&str>; 2] = Default::default();
    for row in keys.iter().filter_map(|key| find(key)) {
        match row.mistake {
            Mistake::Step(StepMistake::Edit(edit)) => {
                stages.push(edit.term.row().subject[..1].to_lowercase() + &edit.term.row().subject[1..]);
            }
            Mistake::ParticleParticleEmpty => detections[0].push("particle-particle"),
            Mistake::ParticleEdgeEmpty => detections[0].push("particle-edge"),
            Mistake::HalfPlaneEmpty => detections[0].push("particle-half-plane"),
            Mistake::ParticleParticleZero => detections[1].push("particle-particle"),
            Mistake::ParticleEdgeZero => detections[1].push("particle-edge"),
            Mistake::HalfPlaneZero => detections[1].push("particle-half-plane"),
            Mistake::ImpulsesEmpty | Mistake::ImpulsesEmptySuccess => stages.push("the impulse loop".to_owned()),
            Mistake::GeometricEmpty => stages.push("the geometric part".to_owned()),
            _ => stages.push("the rigid failsafe".to_owned()),
        }
    }
    let reasons = detections.iter().zip(["it logs nothing", "all coefficients are zero"]);
    let detections = reasons.filter(|(names, _)| !names.is_empty());
    let detections = detections.map(|(names, reason)| format!("{} detection ({reason})", names.join(", ")));
    detections.chain(stages).collect::<Vec<_>>().join("; ")
}

/// Returns advice about where to look for a mistake in a step without collisions. The advice depends on words in the
/// mistake's key.
fn describe_step_area(key: &str) -> &'static str {
    let contains_any = |words: &[&str]| words.iter().any(|word| key.contains(word));
    match () {
        () if contains_any(&["fixed"]) => "Look at how a step treats fixed particles.",
        () if contains_any(&["-hx", "-hv", "matrix", "linear-mass", "implicit-mass"]) => {
            "Look at how the system matrix is built."
        }
        () if contains_any(&["-right", "-momentum"]) => "Look at how the right-hand side of the system is built.",
        () if contains_any(&["newton"]) || key.starts_with("implicit") => {
            "Look at Newton's method: the values that each iteration uses, and when it ends."
        }
        () if key.starts_with("linear") => {
            "Look at where the forces and the matrix are computed, and at how the solution of the system is applied."
        }
        () if contains_any(&["-velocity", "behind"]) => Area::Integrator.advice(),
        () => "Look at how forces change velocities, and velocities change positions.",
    }
}

/// Returns the text with its first letter in upper case.
pub(crate) fn capitalize(text: &str) -> String {
    let mut letters = text.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    first + letters.as_str()
}

#[cfg(test)]
mod tests;
