//! Explanations of several traces together, with artificial explanations for each trace.
use crate::{
    diagnose::is_named_in,
    diagnose::{
        Detail, Explanation, ExplanationTopic, Guess, ListGuess, NanStage, NonFiniteValue, PolynomialEvidence,
        QuantityGuess, StageFault, WrongMotion, WrongVectors, correct_trace, explain_together, mistake_is_visible,
        refuted_keys,
    },
};
use fosssim_model::{assignments::Assignment, scene::Scene, sim::PairKind};
use fosssim_student::assignments::{probe_scenes, t2m2::Subject};

fn statement(key: &str, about: ExplanationTopic, counts: (u64, u64), claims: &[&str]) -> Explanation {
    Explanation {
        key: key.to_owned(),
        topic: about,
        details: Vec::new(),
        reproduced: counts.0,
        samples: counts.1,
        example: None,
        same_as: Vec::new(),
        contradicted_keys: Vec::new(),
        claims: claims.iter().map(|&claim| claim.to_owned()).collect(),
    }
}

fn letter(subject: Subject, form: &str) -> Explanation {
    let found = PolynomialEvidence::Guess(Guess::Quantity(QuantityGuess::Other));
    let claim = format!("{subject:?}/letter/{form}");
    statement("letter", ExplanationTopic::Polynomials { subjects: vec![subject], found }, (5, 5), &[&claim])
}

fn unexplained(subject: Subject) -> Explanation {
    let about = ExplanationTopic::Polynomials { subjects: vec![subject], found: PolynomialEvidence::Nothing };
    statement("unexplained", about, (0, 5), &[&format!("{subject:?}//")])
}

fn row(id: &str, claims: &[&str]) -> Explanation {
    statement(id, ExplanationTopic::Mistake, (4, 4), claims)
}

fn stage(fault: StageFault) -> Explanation {
    statement(
        if matches!(fault, StageFault::Motion { .. }) { "stage-failsafe" } else { "stage-contact-vectors" },
        ExplanationTopic::Stage(fault),
        (0, 3),
        &[],
    )
}

/// Returns the statements of all traces together, each with the number of traces that agree.
fn heads(traces: &[Vec<Explanation>]) -> Vec<(String, usize)> {
    let heads = explain_together(traces.iter().map(Vec::as_slice), &[]);
    let count = |head: &Explanation| traces.iter().filter(|list| is_named_in(head, list)).count();
    heads.iter().map(|head| (head.statement(), count(head))).collect()
}

fn words(expected: &[(&Explanation, usize)]) -> Vec<(String, usize)> {
    expected.iter().map(|(one, count)| (one.statement(), *count)).collect()
}

#[test]
fn two_mistakes_with_one_key_are_two() {
    let (edge, plane) = (letter(Subject::EdgeOverlap, "a"), letter(Subject::HalfPlaneOverlap, "b"));
    let mut traces = vec![vec![edge.clone()]; 3];
    traces.push(vec![edge.clone(), plane.clone()]);
    traces.extend(vec![vec![plane.clone()]; 2]);
    assert_eq!(heads(&traces), words(&[(&edge, 4), (&plane, 3)]));
    // Two forms of one polynomial are not two mistakes, because a program has one formula.
    let other = letter(Subject::EdgeOverlap, "c");
    assert_eq!(heads(&[vec![edge.clone()], vec![edge.clone()], vec![other]]), words(&[(&edge, 2)]));
}

#[test]
fn the_words_are_the_majority_s_and_the_count_is_of_those_who_agree() {
    let of = |wrong| stage(StageFault::ContactVectors { kind: Some(PairKind::ParticleEdge), wrong });
    let (direction, length) = (of(WrongVectors::Direction), of(WrongVectors::Length));
    let mut traces = vec![vec![length.clone()]];
    traces.extend(vec![vec![direction.clone()]; 15]);
    assert_eq!(heads(&traces), words(&[(&direction, 15)]));
    // Vectors of another kind of pair are another mistake.
    let plane =
        stage(StageFault::ContactVectors { kind: Some(PairKind::ParticleHalfPlane), wrong: WrongVectors::Reversed });
    traces.extend(vec![vec![plane.clone()]; 4]);
    assert_eq!(heads(&traces), words(&[(&direction, 15), (&plane, 4)]));
}

/// With equal radii, half of their sum is equal to one radius. The scenes with other radii show which of the two the
/// program uses.
#[test]
fn a_named_mistake_is_tried_on_all_traces_before_a_second_one() {
    let half = letter(Subject::ParticleOverlap, "half");
    let both = ["ParticleOverlap/pp-one-radius/", "ParticleOverlap/letter/half"];
    let mut traces = vec![vec![half.clone()]; 3];
    traces.extend(vec![vec![row("pp-one-radius", &both)]; 4]);
    assert_eq!(heads(&traces), words(&[(&half, 7)]));
    // Each trace names this mistake.
    let likely = explain_together(traces.iter().map(Vec::as_slice), &[]);
    assert_eq!(correct_trace(&traces[6], &likely, &[]).explanations[0].statement(), half.statement());
    // A mistake of the catalog explains the polynomials that it makes, even if they look like another mistake alone.
    let mut like = letter(Subject::ParticleOverlap, "other");
    like.claims.push("ParticleOverlap/pp-one-radius/".to_owned());
    let known = row("pp-one-radius", &both[..1]);
    assert_eq!(heads(&[vec![known.clone()], vec![like]]), words(&[(&known, 2)]));
}

#[test]
fn a_stage_may_be_the_second_mistake() {
    let first = row("pp-no-two", &["ParticleOverlap/pp-no-two/"]);
    let motion = stage(StageFault::Motion { wrong: vec![WrongMotion::Turn], or_zones: false });
    let mut traces = vec![vec![first.clone()]; 3];
    traces.extend(vec![vec![motion.clone()]; 2]);
    assert_eq!(heads(&traces), words(&[(&first, 3), (&motion, 2)]));
    // In traces that the first mistake explains, the wrong stage follows from it.
    assert_eq!(heads(&vec![vec![first.clone(), motion]; 4]), words(&[(&first, 4)]));
}

#[test]
fn mistakes_that_most_traces_contradict_are_not_reported() {
    let guess = letter(Subject::EdgeOverlap, "a");
    let mut traces = vec![vec![unexplained(Subject::EdgeOverlap)]; 6];
    traces.push(vec![guess.clone()]);
    assert_eq!(heads(&traces), [("unexplained".to_owned(), 7)], "only which polynomial it is");
    traces.extend(vec![vec![guess.clone()]; 9]);
    assert_eq!(heads(&traces), words(&[(&guess, 10)]));
    let likely = explain_together(traces.iter().map(Vec::as_slice), &[]);
    assert_eq!((likely[0].reproduced, likely[0].samples), (5, 35), "the others are counted");
}

/// A known formula is tried on every trace. If an eighth as many traces contradict it, it is dropped, even if no trace
/// reports it first.
#[test]
fn a_known_formula_is_denied_by_an_eighth_as_many_traces() {
    let both = ["ParticleOverlap/pp-one-radius/", "ParticleOverlap/pp-no-first-radius/"];
    let mut like = letter(Subject::ParticleOverlap, "other");
    like.claims.push(both[1].to_owned());
    let mut traces = vec![vec![row("pp-one-radius", &both)]; 8];
    traces.push(vec![like]);
    traces.push(vec![unexplained(Subject::ParticleOverlap)]);
    assert_eq!(heads(&traces)[0], ("pp-no-first-radius".to_owned(), 9));
    traces.push(vec![unexplained(Subject::ParticleOverlap)]);
    assert_eq!(heads(&traces), [("unexplained".to_owned(), 11)]);
}

/// A formula that some traces contradict is also not the guess of the common explanation.
#[test]
fn the_guess_of_a_head_is_denied_by_an_eighth_as_many_traces() {
    let found = PolynomialEvidence::Guess(Guess::Named("no-radius".into()));
    let about = ExplanationTopic::Polynomials { subjects: vec![Subject::ParticleOverlap], found };
    let named = statement("no-radius", about, (6, 6), &["ParticleOverlap/no-radius/"]);
    let mut traces = vec![vec![named]; 9];
    traces.extend(vec![vec![unexplained(Subject::ParticleOverlap)]; 3]);
    assert_eq!(heads(&traces), [("unexplained".to_owned(), 12)]);
}

/// If only the stage is known, or among many traces, one trace fits a known mistake by chance.
#[test]
fn a_known_mistake_of_one_trace_is_no_second_one() {
    let behind = stage(StageFault::FirstRound);
    let mut traces = vec![vec![behind]; 4];
    traces.push(vec![row("loop-first-only", &[])]);
    assert_eq!(heads(&traces).len(), 1, "{:?}", heads(&traces));
}

/// Wrong traces of the same stage contradict a mistake that would be visible in them: one trace in eight is too few.
#[test]
fn traces_of_the_same_stage_contradict_a_mistake() {
    let scenes = probe_scenes(Assignment::T2M2);
    let is_visible = |(_, scene): &&(String, Scene)| mistake_is_visible(scene, "zones-all-in-one");
    let (_, scene) = scenes.iter().find(is_visible).expect("a scene with zones");
    let named = [row("zones-all-in-one", &[])];
    let fault = |fault| vec![stage(fault)];
    let of_zones = fault(StageFault::Motion { wrong: vec![WrongMotion::Turn], or_zones: true });
    let refuted = |named_in: usize, other: &[Explanation]| {
        let wrong: Vec<(&Scene, &[Explanation])> =
            std::iter::repeat_n((scene, &named[..]), named_in).chain([(scene, other)]).collect();
        refuted_keys(None, &wrong, &[])
    };
    assert_eq!(refuted(8, &of_zones), ["zones-all-in-one"]);
    assert!(refuted(9, &of_zones).is_empty());
    assert!(refuted(3, &[row("failsafe-degrees", &[])]).is_empty(), "another mistake explains the trace");
    let partner = [row("failsafe-empty", &[])];
    let wrong = [&named[..], &partner, &partner, &of_zones].map(|list| (scene, list));
    assert!(refuted_keys(None, &wrong, &[]).is_empty(), "the program makes both mistakes");
    let of_rounds = StageFault::FirstRound;
    assert!(refuted(3, &fault(of_rounds)).is_empty(), "another stage");
}

/// If traces show the same mistake in different forms, the common explanation gives their common part, and each trace
/// keeps its form.
#[test]
fn forms_that_differ_have_their_polynomial_in_common() {
    let forms = ["a", "b", "c"].map(|form| letter(Subject::HalfPlaneOverlap, form));
    let behind = stage(StageFault::AfterRounds);
    let mut traces: Vec<Vec<Explanation>> = forms.iter().map(|one| vec![one.clone()]).collect();
    traces.push(vec![behind]);
    let likely = explain_together(traces.iter().map(Vec::as_slice), &[]);
    assert_eq!(likely.len(), 1, "what is wrong behind a wrong formula follows: {likely:?}");
    assert!(likely[0].is_unexplained());
    let ExplanationTopic::Polynomials { subjects, found } = &likely[0].topic else { panic!("{likely:?}") };
    assert_eq!(*subjects, [Subject::HalfPlaneOverlap]);
    assert_eq!(*found, PolynomialEvidence::Guess(Guess::Quantity(QuantityGuess::Other)));
    assert_eq!(correct_trace(&traces[1], &likely, &[]).explanations[0].statement(), forms[1].statement());
}

/// Polynomials that are reported with another mistake are not reported again.
#[test]
fn a_second_mistake_is_not_reported_twice() {
    let (empty, cut) = (row("failsafe-empty", &[]), letter(Subject::EdgeOverlap, "a"));
    let mut traces = vec![vec![empty]; 6];
    traces.extend(vec![vec![cut.clone()]; 7]);
    let told = heads(&traces);
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(told.contains(&(cut.statement(), 7)), "{told:?}");
}

/// If a stage looks wrong in only one trace, the error follows from the formula that the other traces name.
#[test]
fn a_stage_of_one_trace_is_no_second_mistake() {
    let first = letter(Subject::EdgeOverlap, "a");
    let motion = stage(StageFault::Motion { wrong: vec![WrongMotion::Turn], or_zones: false });
    let mut traces = vec![vec![first.clone()]; 5];
    traces.push(vec![motion]);
    assert_eq!(heads(&traces), words(&[(&first, 5)]));
}

/// A trace that needs two mistakes is not explained by the single mistake that the others name.
#[test]
fn additional_mistakes_of_a_trace_are_reported() {
    let (spring, drag) = (row("spring-no-rest-length", &[]), row("drag-mass", &[]));
    let mut traces = vec![vec![spring.clone()]; 3];
    traces.push(vec![spring.clone(), drag.clone()]);
    assert_eq!(heads(&traces), words(&[(&spring, 4), (&drag, 1)]));
}

/// Two mistakes are alternatives only if they explain the same traces, not if they explain the same number of traces.
#[test]
fn mistakes_of_different_traces_are_no_rivals() {
    let (one, other) = (row("loop-one-more", &[]), row("failsafe-no-rotation", &[]));
    let told = explain_together([&[one.clone()][..], std::slice::from_ref(&other)], &[]);
    assert_eq!(told.len(), 2, "{told:#?}");
    assert!(told.iter().all(|explanation| explanation.same_as.is_empty()), "{told:#?}");
    // Mistakes that explain a trace only together are not alternatives either.
    let told = explain_together([[one.clone(), other.clone()].as_slice()], &[]);
    assert!(told.len() == 2 && told.iter().all(|explanation| explanation.same_as.is_empty()), "{told:#?}");
    // A trace that allows both mistakes lists both.
    let both = Explanation { same_as: vec![other.key.clone()], ..one.clone() };
    let told = explain_together([std::slice::from_ref(&both); 3], &[]);
    assert_eq!((told[0].key.as_str(), &told[0].same_as[..]), ("loop-one-more", std::slice::from_ref(&other.key)));
    let told = explain_together([&[both][..], std::slice::from_ref(&one)], &[]);
    assert_eq!((told.len(), told[0].same_as.len()), (1, 0), "one trace knows which: {told:#?}");
}

/// A program has one contact vector for each kind of pair, so another trace's explanation of it is not a second
/// mistake.
#[test]
fn a_contact_vector_has_one_mistake() {
    let told_beside = |first: &str, second: &str| {
        let (first, second) = (vec![row(first, &[])], vec![row(second, &[])]);
        let told = explain_together([&first, &first, &second].map(Vec::as_slice), &[]);
        told.into_iter().map(|explanation| explanation.key).collect::<Vec<_>>()
    };
    assert_eq!(told_beside("pe-contact-nearest-end", "pe-contact-second-end"), ["pe-contact-nearest-end"]);
    assert_eq!(told_beside("pe-contact-nearest-end", "ph-contact-at-start").len(), 2, "another kind of pair");
}

/// All traces together name the mistake that each of them allows.
#[test]
fn forms_are_intersected_over_traces() {
    let of = |forms: [&str; 2]| {
        let claims = forms.map(|form| format!("EdgeOverlap/terms/{form}"));
        let found = PolynomialEvidence::Guess(Guess::Quantity(QuantityGuess::Other));
        let about = ExplanationTopic::Polynomials { subjects: vec![Subject::EdgeOverlap], found };
        statement("letter", about, (5, 5), &claims.each_ref().map(String::as_str))
    };
    let traces = [of(["a", "b"]), of(["c", "b"]), of(["b", "d"])].map(|one| vec![one]);
    let told = explain_together(traces.iter().map(Vec::as_slice), &[]);
    assert_eq!(told.iter().map(Explanation::statement).collect::<Vec<_>>(), ["EdgeOverlap/terms/b"]);
    assert!(traces.iter().all(|list| is_named_in(&told[0], list)));
}

/// If every coefficient of a detection is zero, the detection is not written yet. This also applies to the loop.
#[test]
fn unchanged_starter_code_is_not_written_yet() {
    let zero = |subjects: &[Subject]| {
        let found = PolynomialEvidence::Guess(Guess::List(ListGuess::AllZero));
        statement("all-zero", ExplanationTopic::Polynomials { subjects: subjects.to_vec(), found }, (5, 5), &[])
    };
    let planes = [Subject::HalfPlaneOverlap, Subject::HalfPlaneApproach];
    let traces = [vec![row("loop-empty-succeeds", &[])], vec![zero(&planes)], vec![zero(&planes)]];
    let told = explain_together(traces.iter().map(Vec::as_slice), &[]);
    assert!(told.len() == 1 && told[0].is_unfinished(), "{told:#?}");
    assert_eq!(told[0].same_as, ["ph-zero", "loop-empty-succeeds"]);
}

/// If all traces allow that a stage is empty or has another mistake, both are reported.
#[test]
fn an_empty_stage_has_rivals_too() {
    let rival = "loop-always-succeeds".to_owned();
    let trace = [Explanation { same_as: vec![rival.clone()], ..row("geometric-empty", &[]) }];
    let told = explain_together([&trace[..]; 3], &[]);
    assert_eq!((told.len(), told[0].key.as_str(), &told[0].same_as[..]), (1, "geometric-empty", &[rival][..]));
}

/// If correct traces contradict a mistake, another one is reported, with its own details.
#[test]
fn another_mistake_has_its_own_exact_form() {
    let all = Explanation {
        details: vec![Detail::Term("penalty-half-planes-missing".into())],
        same_as: vec!["penalty-first-half-plane-only".to_owned()],
        ..row("penalty-half-planes-missing", &[])
    };
    let traces = [vec![all]];
    let told = explain_together(traces.iter().map(Vec::as_slice), &["penalty-half-planes-missing".to_owned()]);
    assert_eq!(told[0].key, "penalty-first-half-plane-only");
    assert_eq!(told[0].details, [Detail::Term("penalty-first-half-plane-only".into())]);
}

#[test]
fn the_first_nan_comes_after_proven_mistakes() {
    let end = |step, stage| {
        let found = NonFiniteValue { step: Some(step), stage, is_nan: true, recovers: false };
        statement(Explanation::NOT_FINITE, ExplanationTopic::NotFinite(found), (0, 0), &[])
    };
    let first = row("pp-no-two", &[]);
    let traces = [
        vec![end(3, NanStage::Zones), first.clone()],
        vec![end(7, NanStage::Responses)],
        vec![end(9, NanStage::Zones)],
    ];
    let told = explain_together(traces.iter().map(Vec::as_slice), &[]);
    assert_eq!(
        told.iter().map(Explanation::statement).collect::<Vec<_>>(),
        [first.statement(), end(1, NanStage::Zones).statement()]
    );
    assert!(matches!(told[1].topic, ExplanationTopic::NotFinite(NonFiniteValue { step: None, .. })));
    let of_third = correct_trace(&traces[2], &told, &[]).explanations;
    assert!(
        matches!(of_third[0].topic, ExplanationTopic::NotFinite(NonFiniteValue { step: Some(9), .. })),
        "{of_third:?}"
    );
}

/// Each scene alone suggests another mistake in the same quantity, so the program makes none of them.
#[test]
fn names_that_exclude_each_other_are_not_reported_together() {
    let fault = StageFault::ContactVectors { kind: None, wrong: WrongVectors::Reversed };
    let rivals = [vec![row("drag-missing", &[])], vec![row("drag-x-only", &[])], vec![stage(fault.clone())]];
    assert_eq!(heads(&rivals), words(&[(&stage(fault), 1)]));
    let both = vec![row("drag-mass", &[]), row("drag-x-only", &[])];
    let together = [both.clone(), both, vec![row("drag-x-only", &[])]];
    assert_eq!(heads(&together), words(&[(&row("drag-x-only", &[]), 3), (&row("drag-mass", &[]), 2)]));
}

/// A guess about a polynomial that the other scenes contradict is not shown on the scene that it fits, either.
#[test]
fn a_scene_alone_does_not_name_what_all_scenes_contradict() {
    let subject = Subject::ParticleOverlap;
    let (first, second) = (letter(subject, "one"), letter(subject, "other"));
    let traces = [vec![first.clone()], vec![second], vec![unexplained(subject)], vec![unexplained(subject)]];
    let likely = explain_together(traces.iter().map(Vec::as_slice), &[]);
    assert!(likely[0].is_unexplained());
    let shown = correct_trace(&traces[0], &likely, &[]).explanations;
    assert_eq!(shown.iter().map(|explanation| explanation.key.as_str()).collect::<Vec<_>>(), ["unexplained"]);
    let of_edges = letter(Subject::EdgeOverlap, "one");
    let other = [first, of_edges.clone()];
    assert_eq!(correct_trace(&other, &likely, &[]).explanations[1], of_edges, "the other polynomial keeps its guess");
}

/// If traces disagree about how a vector is wrong, the common explanation only says that its direction is wrong.
#[test]
fn faults_of_a_vector_that_differ_are_generalized() {
    let fault = |wrong| vec![stage(StageFault::ContactVectors { kind: None, wrong })];
    let [reversed, short] = [fault(WrongVectors::Reversed), fault(WrongVectors::Length)];
    let told = explain_together([&reversed[..], &reversed, &short], &[]);
    let expected = StageFault::ContactVectors { kind: None, wrong: WrongVectors::Direction };
    assert_eq!(told[0].topic, ExplanationTopic::Stage(expected));
    let told = explain_together([&reversed[..], &reversed], &[]);
    assert_eq!(told[0].topic, reversed[0].topic);
}
