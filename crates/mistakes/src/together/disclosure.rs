//! Limits a result to the parts that hints allow. The parts are removed before a report is made, so no format can
//! reveal the rest.
use fosssim_findings::{
    Hints, SceneResult, Verdict,
    explanation::Explanation,
    result::{Reason, WrongTrace},
    smallest_scene::SmallestScene,
};
use fosssim_student::find;

/// Limits a result to a hint level. The verdict, its reason and the difference between the rule books stay at all
/// levels, but at [`Hints::None`] the fault of a wrong trace is removed.
pub fn limit_result(hints: Hints, result: &mut SceneResult) {
    if hints == Hints::Full {
        return;
    }
    if hints == Hints::None && matches!(result.verdict, Verdict::WrongAnswer | Verdict::Unwritten) {
        result.reason = Reason::Wrong(WrongTrace::Undisclosed);
    }
    result.disclosure = result.disclosure.take().and_then(|all| hints.disclose(all));
    result.explanations = limit_explanations(hints, std::mem::take(&mut result.explanations));
    result.card.clone_from(&result.card_for_students);
}

/// Returns the part of a smallest scene that a hint level shows. At [`Hints::None`] this is `None`.
pub fn limit_smallest_scene(hints: Hints, mut small: SmallestScene) -> Option<SmallestScene> {
    small.explanations = limit_explanations(hints, std::mem::take(&mut small.explanations));
    small.limit_to_hints(hints);
    (hints > Hints::None).then_some(small)
}

/// Returns the part of explanations that a hint level shows. At [`Hints::None`] this is nothing. At [`Hints::Where`] it
/// is only the explanation of the first value that is not finite, if there is one
/// ([`Explanation::reports_non_finite_value`]). At [`Hints::What`] each explanation keeps the known mistakes that
/// cannot be distinguished from it, but loses its details and its example. These need [`Hints::Full`].
pub fn limit_explanations(hints: Hints, explanations: Vec<Explanation>) -> Vec<Explanation> {
    match hints {
        Hints::None => Vec::new(),
        // A value that is not finite shows where the fault is, but contains no guess about the mistake.
        Hints::Where => explanations.into_iter().filter(Explanation::reports_non_finite_value).collect(),
        Hints::What => explanations
            .into_iter()
            .map(|mut explanation| {
                explanation.same_as.retain(|key| find(key).is_some());
                Explanation { details: Vec::new(), example: None, ..explanation }
            })
            .collect(),
        Hints::Full => explanations,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::{self, Example, ExamplePlace, ExplanationTopic, NanStage, NonFiniteValue};
    use fosssim_findings::{
        Rules,
        disclosure::{DisclosedFinding, Disclosure},
        finding::{Finding, FindingDetail, FindingPlace},
    };
    use fosssim_judge::replay;
    use fosssim_model::assignments::Assignment;
    use fosssim_student::{self as student, CATALOG, RowKind, Student, assignments::probe_scenes};

    fn explanation() -> Explanation {
        let example = Example {
            step: 3,
            place: ExamplePlace::ContactCount,
            given: Vec::new(),
            expected: vec![1.0],
            actual: vec![2.0],
        };
        Explanation {
            key: "pe-square-no-eh".to_owned(),
            topic: ExplanationTopic::Mistake,
            details: vec![diagnose::Detail::Term("pe-square-no-eh".into())],
            reproduced: 3,
            samples: 3,
            example: Some(example),
            same_as: vec!["other".to_owned(), "pe-square-two-eh".to_owned()],
            contradicted_keys: Vec::new(),
            claims: Vec::new(),
        }
    }

    #[test]
    fn each_level_tells_more_and_formulas_come_last() {
        let told = |hints: Hints| limit_explanations(hints, vec![explanation()]);
        assert_eq!((told(Hints::None), told(Hints::Where)), (Vec::new(), Vec::new()));
        let what = told(Hints::What).remove(0);
        assert_eq!((what.topic, what.details.len(), what.example), (ExplanationTopic::Mistake, 0, None));
        assert_eq!(what.same_as, ["pe-square-two-eh"], "what is found in polynomials alone may be a formula's name");
        assert_eq!(told(Hints::Full), [explanation()]);
        for hints in [Hints::None, Hints::Where, Hints::What, Hints::Full] {
            assert_eq!(hints.explains(), !told(hints).is_empty(), "{hints:?}");
            // The first value that is not finite is an observation, not a guess.
            let end = NonFiniteValue { step: Some(3), stage: NanStage::Zones, is_nan: true, recovers: false };
            let end = Explanation { topic: ExplanationTopic::NotFinite(end), ..explanation() };
            assert_eq!(limit_explanations(hints, vec![end]).len(), usize::from(hints > Hints::None), "{hints:?}");
        }
    }

    #[test]
    fn a_result_that_is_cut_twice_keeps_the_picture_for_students() {
        let mut result = SceneResult::without_run("a", 1, Verdict::WrongAnswer, Reason::Wrong(WrongTrace::Undisclosed));
        (result.card, result.card_for_students) = (Some("all".to_owned()), Some("part".to_owned()));
        for _ in 0..2 {
            limit_result(Hints::What, &mut result);
            assert_eq!(result.card.as_deref(), Some("part"));
        }
    }

    #[test]
    fn values_are_shown_only_with_full_hints() {
        let detail = FindingDetail::Position { particle: 2, expected: [1.5, 0.0], actual: [1.25, 0.0], residual: 0.25 };
        let finding = Finding { step: 4, frame: 8, detail };
        let place = DisclosedFinding::Place { step: 4, kind: finding.kind(), place: FindingPlace::Particle(2) };
        assert_eq!(Hints::None.disclose_finding(&finding), None);
        assert_eq!(Hints::Where.disclose_finding(&finding), Some(place.clone()));
        assert_eq!(Hints::What.disclose_finding(&finding), Some(place));
        assert_eq!(Hints::Full.disclose_finding(&finding), Some(DisclosedFinding::Full(finding)));
    }

    #[test]
    fn reports_grow_with_the_hints_and_show_values_only_with_full() {
        let (_, scene) = probe_scenes(Assignment::DEFAULT).swap_remove(0);
        let row = CATALOG.iter().find(|row| row.kind == RowKind::Wrong).expect("a mistake");
        let trace = student::record_trace(&scene, Student::new(Some(row.mistake))).unwrap_or_else(|(bytes, _)| bytes);
        let options = replay::Options { uses_fair_rules: true, ..replay::Options::default() };
        let judged = replay::judge(&scene, &trace[..], &options, &mut ());
        let all = |rules| Disclosure::from_outcome(&judged, rules);
        assert_eq!(Hints::None.disclose(all(Rules::Both)), None);
        let told = |hints: Hints| hints.disclose(all(Rules::Both)).expect("something");
        assert_eq!(told(Hints::Where), Hints::Where.disclose(told(Hints::What)).expect("something"), "cut twice");
        assert_eq!(told(Hints::Where), told(Hints::What));
        let (part, full) = (told(Hints::Where), told(Hints::Full));
        assert!(part.residuals.is_none() && full.residuals.is_some());
        for (part, full) in
            [(&part.parity, &full.parity), (part.fair.as_ref().expect("asked"), full.fair.as_ref().expect("asked"))]
        {
            assert!(part.examples.iter().all(|example| matches!(example, DisclosedFinding::Place { .. })));
            assert_eq!(part.examples.len(), full.examples.len());
            assert_eq!((&part.counts, part.wrong_steps, part.ruling), (&full.counts, full.wrong_steps, full.ruling));
        }
        // The rule book that decides the verdict comes first.
        assert_eq!(told(Hints::Full).official(), &full.parity);
        assert_eq!(all(Rules::Fair).official(), full.fair.as_ref().expect("asked"));
    }
}
