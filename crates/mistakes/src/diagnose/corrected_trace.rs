//! Corrects the explanations of one trace with those of all traces of its program.
use super::{
    Explanation, ExplanationTopic, WrongPairs, is_named_in, naming::explain_by_row, topic::PolynomialEvidence,
};
use fosssim_student::{assignments::t2m2::Subject, find};
use std::collections::BTreeSet;

/// The explanations of one trace, after all traces of its program are known.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CorrectedTrace {
    /// The explanations, the likeliest first.
    pub explanations: Vec<Explanation>,
    /// The number of explanations at the front that come from all traces together. The others come from this trace
    /// alone.
    pub agreed_count: usize,
}

/// Returns the explanations of one trace, corrected by those of all traces together
/// ([`explain_together`](super::explain_together)). If one of `likely` applies to the trace, it replaces the trace's
/// own explanations `own`, but the counts and the example of the trace are kept. If none applies, the explanations that
/// are `refuted` are removed. If all traces together leave a polynomial unexplained, the trace's guess about it is
/// removed, because other traces contradict it.
pub fn correct_trace(own: &[Explanation], likely: &[Explanation], refuted: &[String]) -> CorrectedTrace {
    let own = &replace_contradicted(own, likely);
    let agreements = likely
        .iter()
        .filter(|explanation| !explanation.reports_non_finite_value())
        .flat_map(|explanation| find_agreement(own, explanation));
    let mut explanations: Vec<Explanation> = agreements.collect();
    if explanations.is_empty() {
        return CorrectedTrace {
            explanations: own.iter().filter_map(|explanation| remove_refuted(explanation, refuted)).collect(),
            agreed_count: 0,
        };
    }
    // The step from which values are not finite is reported for each trace.
    explanations.extend(own.iter().find(|explanation| explanation.reports_non_finite_value()).cloned());
    CorrectedTrace { agreed_count: explanations.len(), explanations }
}

/// Returns the explanations of a trace. The guesses about polynomials that all traces together leave unexplained are
/// replaced by one explanation. It only says that these polynomials are wrong.
fn replace_contradicted(own: &[Explanation], likely: &[Explanation]) -> Vec<Explanation> {
    let unexplained = likely.iter().find_map(|explanation| match &explanation.topic {
        ExplanationTopic::Polynomials { subjects, found: PolynomialEvidence::Nothing } => Some(subjects),
        _ => None,
    });
    let is_contradicted = |explanation: &Explanation| {
        let subjects = explanation.subjects();
        !subjects.is_empty() && unexplained.is_some_and(|all| subjects.iter().all(|subject| all.contains(subject)))
    };
    let (contradicted, mut remaining_explanations): (Vec<Explanation>, Vec<Explanation>) =
        own.iter().cloned().partition(is_contradicted);
    if let Some(first) = contradicted.first() {
        let subjects: BTreeSet<Subject> = contradicted.iter().flat_map(Explanation::subjects).collect();
        let all = Explanation::for_wrong_polynomials(subjects.into_iter().collect(), PolynomialEvidence::Nothing);
        remaining_explanations.insert(0, Explanation { samples: first.samples, example: first.example.clone(), ..all });
    }
    remaining_explanations
}

/// Returns the explanation without its refuted parts, or `None` if no part is left.
fn remove_refuted(one: &Explanation, refuted: &[String]) -> Option<Explanation> {
    let mut same_as = one.same_as.iter().filter(|key| !refuted.contains(key)).cloned();
    if !refuted.contains(&one.key) || one.reports_non_finite_value() {
        return Some(Explanation { same_as: same_as.collect(), ..one.clone() });
    }
    let row = find(&same_as.next()?)?;
    Some(explain_by_row(one, row, same_as.collect()))
}

/// Returns `likely`, an explanation of all traces together, with the counts and the example of this trace. For
/// unfinished stages, returns the trace's own explanations. The list is empty if no explanation of this trace names the
/// same mistake.
fn find_agreement(own: &[Explanation], likely: &Explanation) -> Vec<Explanation> {
    if likely.is_unexplained() {
        // A trace may show several of the mistakes.
        return Vec::new();
    }
    if likely.is_unfinished() {
        // Each stage is checked separately, because a trace may not show all of them.
        return own.iter().filter(|explanation| likely.same_as.contains(&explanation.key)).cloned().collect();
    }
    let own_explanation = own.iter().find(|explanation| is_named_in(likely, std::slice::from_ref(explanation)));
    let as_shown = |explanation: &Explanation| {
        // Steps are counted for known mistakes, and polynomials for guesses about polynomials.
        let has_same_counts =
            matches!(explanation.topic, ExplanationTopic::Mistake) == matches!(likely.topic, ExplanationTopic::Mistake);
        let (reproduced, samples) =
            if has_same_counts { (explanation.reproduced, explanation.samples) } else { (0, 0) };
        let about = match (&explanation.topic, &likely.topic) {
            (ExplanationTopic::Pairs(own), ExplanationTopic::Pairs(all)) => {
                ExplanationTopic::Pairs(WrongPairs { first: own.first, ..all.clone() })
            }
            (_, about) => about.clone(),
        };
        Explanation { reproduced, samples, topic: about, example: explanation.example.clone(), ..likely.clone() }
    };
    own_explanation.map(as_shown).into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::explain_together;

    fn named(key: &str, same_as: &[&str], counts: (u64, u64)) -> Explanation {
        Explanation {
            key: key.to_owned(),
            topic: ExplanationTopic::Mistake,
            details: Vec::new(),
            reproduced: counts.0,
            samples: counts.1,
            example: None,
            same_as: same_as.iter().map(|&key| key.to_owned()).collect(),
            contradicted_keys: Vec::new(),
            claims: Vec::new(),
        }
    }

    /// In one scene alone, a loop that runs one round too few looks empty. All scenes together distinguish the two, and
    /// the scene's explanation must agree with them.
    #[test]
    fn a_scene_says_what_all_scenes_together_know() {
        let short = named("loop-one-fewer", &[], (7, 7));
        let alone = named("loop-empty", &["loop-one-fewer"], (2, 2));
        let other = named("pp-no-two", &[], (1, 4));
        let traces = [vec![alone.clone()], vec![short.clone()], vec![short.clone()]];
        let likely = explain_together(traces.iter().map(Vec::as_slice), &[]);
        assert_eq!(likely.iter().map(|explanation| explanation.key.as_str()).collect::<Vec<_>>(), ["loop-one-fewer"]);
        let of_first = correct_trace(&traces[0], &likely, &[]);
        assert_eq!((of_first.agreed_count, of_first.explanations.len()), (1, 1));
        let explanation = &of_first.explanations[0];
        assert_eq!((explanation.key.as_str(), explanation.reproduced, explanation.samples), ("loop-one-fewer", 2, 2));
        // A trace that the joint explanations do not fit keeps its own explanations.
        assert_eq!(
            correct_trace(std::slice::from_ref(&other), &likely, &[]),
            CorrectedTrace { explanations: vec![other], agreed_count: 0 }
        );
        assert_eq!(correct_trace(&[], &likely, &[]), CorrectedTrace::default());
    }

    #[test]
    fn a_scene_names_what_it_shows_of_what_is_not_written() {
        let traces = [vec![named("pp-empty", &[], (3, 3))], vec![named("ph-empty", &[], (3, 3))]];
        let likely = explain_together(traces.iter().map(Vec::as_slice), &[]);
        assert_eq!(likely[0].key, Explanation::UNFINISHED);
        let of_second = correct_trace(&traces[1], &likely, &[]);
        assert_eq!((of_second.agreed_count, of_second.explanations), (1, traces[1].clone()));
    }
}
