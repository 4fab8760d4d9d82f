//! Tests all sentences of explanations.
use super::*;
use fosssim_mistakes::diagnose::{
    Amount, ChangeRatio, ChangedParticles, ChangedQuantity, CoefficientGuess, GeometricPartError, Guess, ListGuess,
    LoopEnd, NanStage, NonFiniteValue, PolynomialDetail, PolynomialEvidence, Quantity, QuantityGuess, Ratios,
    RoundCountError, StageDetail, StageFault, Substitute, Weight, WrongChange, WrongDecisions, WrongMotion,
    WrongPositions, WrongResponses, WrongVectors, WrongZoneRounds, WrongZones,
};
use fosssim_model::{
    assignments::{ForceKind, Integrator, Part},
    sim::PairKind,
};
use fosssim_student::{
    all_rows,
    assignments::t2m2::{NAMED_EDITS, Reading, Subject},
};
use std::borrow::Cow;

const EDGE: Option<PairKind> = Some(PairKind::ParticleEdge);
const TWO: Ratios = Ratios::All(2.0);
const OVERLAP: Reading = Reading { subject: Subject::EdgeOverlap, number: 0 };

fn explanation(key: &str, about: ExplanationTopic, details: Vec<Detail>) -> Explanation {
    let (key, same_as) = (key.to_owned(), Vec::new());
    Explanation {
        key,
        topic: about,
        details,
        reproduced: 0,
        samples: 0,
        example: None,
        same_as,
        contradicted_keys: Vec::new(),
        claims: Vec::new(),
    }
}

/// Returns all guesses about the coefficients of a polynomial.
fn guesses() -> Vec<Guess> {
    let of_power = |power: usize| Guess::Coefficients { powers: vec![power], wrong: CoefficientGuess::Zero };
    ListGuess::ALL
        .map(Guess::List)
        .into_iter()
        .chain(QuantityGuess::ALL.map(Guess::Quantity))
        .chain(CoefficientGuess::ALL.map(|wrong| Guess::Coefficients { powers: vec![3, 2], wrong }))
        .chain((0..=5).map(of_power))
        .chain(NAMED_EDITS.iter().map(|edit| Guess::Named(edit.key.into())))
        .collect()
}

/// Returns wrong changes of states.
fn changes() -> [WrongChange; 7] {
    let velocity = Quantity::Velocity;
    let change = |parts: &[Part]| WrongChange {
        quantity: velocity,
        axis: None,
        particles: ChangedParticles::Any,
        ratio: ChangeRatio::Factor,
        parts: parts.iter().copied().collect(),
    };
    let integrator = Part::Integrator(Integrator::SymplecticEuler);
    let position = || WrongChange { quantity: Quantity::Position, ..change(&[integrator]) };
    let all = ForceKind::ALL.map(Part::Jacobians);
    let edges = change(&[Part::SimpleResponse(PairKind::ParticleEdge)]);
    [
        position(),
        WrongChange { axis: Some(1), ratio: ChangeRatio::Other, ..position() },
        WrongChange {
            particles: ChangedParticles::Fixed,
            ratio: ChangeRatio::Nothing,
            ..change(&[integrator, Part::Force(ForceKind::Spring)])
        },
        WrongChange { ratio: ChangeRatio::Opposite, ..edges },
        WrongChange { ratio: ChangeRatio::Other, ..change(&[Part::Penalty(PairKind::ParticleHalfPlane)]) },
        WrongChange { ratio: ChangeRatio::Other, ..change(&all) },
        change(&[]),
    ]
}

/// Returns all faults that a stage can have.
fn faults() -> Vec<StageFault> {
    let changed = |body, quantity| ChangedQuantity { kind: PairKind::ParticleEdge, body, quantity };
    let position = vec![changed(0, Quantity::Position)];
    let both = vec![changed(1, Quantity::Position), changed(1, Quantity::Velocity)];
    let velocities = vec![changed(1, Quantity::Velocity), changed(2, Quantity::Velocity)];
    let all = [position.clone(), both.clone(), velocities.clone()].concat();
    let mut faults = vec![
        StageFault::Order,
        StageFault::ContactTimes,
        StageFault::ManyContacts,
        StageFault::Unresolved { all: true },
        StageFault::Unresolved { all: false },
        StageFault::FirstRound,
        StageFault::LaterRounds,
        StageFault::AfterRounds,
        StageFault::RoundsOfPrediction,
        StageFault::BehindFirstRound,
        StageFault::Geometric(GeometricPartError::Omitted { always: true }),
        StageFault::Geometric(GeometricPartError::Omitted { always: false }),
        StageFault::Geometric(GeometricPartError::Superfluous),
    ];
    for kind in [None, EDGE] {
        faults.extend(WrongDecisions::ALL.map(|wrong| StageFault::Decisions { kind, wrong }));
        faults.extend(WrongDecisions::ALL.map(|wrong| StageFault::Overlaps { kind, wrong }));
        faults.extend(WrongVectors::ALL.map(|wrong| StageFault::ContactVectors { kind, wrong }));
        let responses = [
            WrongResponses::Nothing,
            WrongResponses::Unchanged(all.clone()),
            WrongResponses::Across(position.clone()),
            WrongResponses::Across(both.clone()),
            WrongResponses::Amount(velocities.clone()),
            WrongResponses::Amount(all.clone()),
        ];
        for only_in_rounds in [false, true] {
            let all = responses.clone().into_iter();
            faults.extend(all.map(|wrong| StageFault::Responses { kind, wrong, only_in_rounds }));
        }
    }
    faults.extend(changes().map(StageFault::Change));
    faults.extend(WrongPositions::ALL.map(StageFault::ZonePositions));
    faults.extend(RoundCountError::ALL.map(StageFault::Rounds));
    for when in [None, Some(LoopEnd::RanOut), Some(LoopEnd::Settled)] {
        let quantities = [None, Some(Quantity::Position), Some(Quantity::Velocity)];
        faults.extend(quantities.map(|quantity| StageFault::HandedOver { quantity, when, or_response: false }));
        faults.push(StageFault::HandedOver { quantity: None, when, or_response: true });
    }
    faults.extend(WrongZoneRounds::ALL.map(StageFault::ZoneRounds));
    faults.extend(WrongZones::ALL.map(StageFault::Zones));
    let motions = [
        vec![],
        vec![WrongMotion::Center, WrongMotion::Distances, WrongMotion::Velocities],
        vec![WrongMotion::NoTurn, WrongMotion::Speeds],
        vec![WrongMotion::LessTurn],
        vec![WrongMotion::MoreTurn],
        vec![WrongMotion::TurnBack],
        vec![WrongMotion::Turn],
    ];
    faults.extend(motions.map(|wrong| StageFault::Motion { or_zones: wrong.len() > 2, wrong }));
    faults
}

/// Returns one explanation for each statement about polynomials and stages.
fn all() -> Vec<Explanation> {
    let edge = Subject::all_of_kind(PairKind::ParticleEdge).to_vec();
    let of =
        |subjects: Vec<Subject>, found| explanation("k", ExplanationTopic::Polynomials { subjects, found }, Vec::new());
    let mut all = vec![
        explanation("k", ExplanationTopic::Scene { has_length: true }, Vec::new()),
        explanation("k", ExplanationTopic::Scene { has_length: false }, Vec::new()),
        of(edge.clone(), PolynomialEvidence::Missing),
        of(edge.clone(), PolynomialEvidence::Nothing),
        of(vec![Subject::AlphaLow], PolynomialEvidence::Nothing),
        of(vec![Subject::HalfPlaneOverlap], PolynomialEvidence::NearlyRight),
    ];
    let empty = ["pp-empty", "pe-empty", "ph-empty", "loop-empty", "geometric-empty", "failsafe-empty"];
    let same_as = empty.map(str::to_owned).into();
    all.push(Explanation { same_as, ..explanation("k", ExplanationTopic::Unfinished, Vec::new()) });
    let stages = [
        NanStage::FirstRecord,
        NanStage::Motion,
        NanStage::Detection(Some(PairKind::ParticleEdge)),
        NanStage::Detection(None),
        NanStage::ContactVectors,
        NanStage::Responses,
        NanStage::ImpulseRounds,
        NanStage::Zones,
        NanStage::ImplicitMotion,
    ];
    let ends = stages.map(|stage| NonFiniteValue {
        step: Some(60),
        stage,
        is_nan: stage != NanStage::ContactVectors,
        recovers: false,
    });
    let together = NonFiniteValue { step: None, ..ends[7] };
    let once = NonFiniteValue { recovers: true, ..ends[1] };
    all.extend(
        ends.into_iter()
            .chain([together, once])
            .map(|end| explanation("k", ExplanationTopic::NotFinite(end), Vec::new())),
    );
    all.extend(guesses().into_iter().map(|guess| of(edge[..2].to_vec(), PolynomialEvidence::Guess(guess))));
    all.extend(faults().into_iter().map(|fault| explanation("k", ExplanationTopic::Stage(fault), Vec::new())));
    all
}

/// Returns one detail of each kind.
fn lines_of_all_sorts() -> Vec<Detail> {
    let subject = Subject::EdgeOverlap;
    let weight = |letters: &[&'static str], power| Weight {
        reading: OVERLAP,
        power,
        letters: letters.iter().map(|&letter| letter.into()).collect(),
        expected: 1.0,
        actual: -0.25,
    };
    let stands = |letter, stand| PolynomialDetail::StandsFor { reading: OVERLAP, letter: Cow::Borrowed(letter), stand };
    let polynomials = [
        PolynomialDetail::Logged { logged: 3, of: 4 },
        PolynomialDetail::RightUpTo(3.4e-12),
        PolynomialDetail::Differs { subject: Some(subject), power: 2, count: 3, of: 7 },
        PolynomialDetail::Differs { subject: None, power: 0, count: 7, of: 7 },
        PolynomialDetail::Holds(1.5),
        PolynomialDetail::Every(1e-11),
        PolynomialDetail::SinglePrecision,
        PolynomialDetail::InPlaceOf { used: Subject::AlphaHigh, expected: Subject::AlphaLow },
        PolynomialDetail::Exchanged { powers: [3, 1] },
        PolynomialDetail::LastOnly(1),
        PolynomialDetail::LastOnly(2),
        PolynomialDetail::FirstOnly(2),
        PolynomialDetail::Displacements(100.0),
        PolynomialDetail::Reach { kind: PairKind::ParticleEdge, used: 0.25, expected: 0.45 },
        PolynomialDetail::Reach { kind: PairKind::ParticleHalfPlane, used: 0.0, expected: 0.1 },
        PolynomialDetail::Named { key: "first-radius-only".into(), has_only_edge_pairs: true },
        PolynomialDetail::Named { key: "first-radius-only".into(), has_only_edge_pairs: false },
        PolynomialDetail::Named { key: "radius-unscaled".into(), has_only_edge_pairs: false },
        stands("h", Substitute::Scaled(0.5)),
        stands("R^2", Substitute::Letter("a".into())),
        stands("d", Substitute::Dot { vectors: ["x21".into(), "d21".into()], negated: true }),
        stands("R^2", Substitute::One),
        PolynomialDetail::Factor { power: 3, factor: 0.0 },
        PolynomialDetail::Factor { power: 3, factor: 1.5 },
        PolynomialDetail::Unknown { power: 4 },
        PolynomialDetail::Weight(weight(&["i", "R^2"], 2)),
        PolynomialDetail::Weight(weight(&["b", "b"], 2)),
        PolynomialDetail::Alternative(vec![weight(&["e", "h"], 2), weight(&["R"], 1)]),
    ];
    let changed = ChangedQuantity { kind: PairKind::ParticleEdge, body: 2, quantity: Quantity::Velocity };
    let change = |amount, across| StageDetail::Change { changed, amount, across, wrong: 3, of: 4 };
    let stages = [
        StageDetail::Order,
        StageDetail::Impacts { right: false, count: 3, low: 0.25, high: 0.75 },
        StageDetail::Impacts { right: true, count: 5, low: 0.125, high: 1.0 },
        StageDetail::Vectors(Ratios::Between(-1.0, 0.33333)),
        StageDetail::VectorError(3.4e-8),
        StageDetail::ZoneCount { count: 1, of: 3 },
        StageDetail::Vectors(Ratios::All(1.0 + 1e-6)),
        StageDetail::Times(TWO),
        StageDetail::TimeError(0.1),
        StageDetail::TimeUse,
        StageDetail::Passes { expected: 4, actual: 2, most: 10 },
        change(Amount::Unwanted, false),
        change(Amount::Right, true),
        change(Amount::Ratio(TWO), false),
        StageDetail::StoppedVelocities(TWO),
        StageDetail::CenterMotion(TWO),
        StageDetail::CenterDirection,
        StageDetail::Rotations(Ratios::Between(0.5, 0.75)),
        StageDetail::Velocities(TWO),
    ];
    let polynomials = polynomials.map(Detail::Polynomial).into_iter();
    let others = [Detail::Letters(vec![PairKind::ParticleEdge])];
    polynomials.chain(others).chain(stages.map(Detail::Stage)).collect()
}

/// With hints below `full`, no sentence of any explanation reveals a formula.
#[test]
fn no_sentence_gives_a_formula_away() {
    let known = all_rows().map(|row| explanation(row.id, ExplanationTopic::Mistake, Vec::new()));
    for one in all().into_iter().chain(known) {
        let sentence = describe(&one);
        assert_eq!(find_formula(&sentence), None, "{sentence}");
        assert!(sentence.ends_with(['.', '?']) && sentence.starts_with(char::is_uppercase), "{sentence}");
    }
}

#[test]
fn every_finding_has_its_sentence() {
    let sentences: Vec<String> = all().iter().map(describe).collect();
    insta::assert_snapshot!("sentences", sentences.join("\n"));
    let lines = list_details(&explanation("k", ExplanationTopic::Mistake, lines_of_all_sorts()));
    insta::assert_snapshot!("lines", lines.join("\n"));
}

/// A known mistake is explained by its row: the sentence, its exact form, and where to search, with the letters'
/// meaning between them.
#[test]
fn a_known_mistake_is_explained_by_its_row() {
    let row = find("pe-square-no-eh").expect("a row");
    let details_of_row =
        vec![Detail::Term(row.id.into()), Detail::Letters(vec![PairKind::ParticleEdge]), Detail::SearchArea(row.area)];
    let one = explanation(row.id, ExplanationTopic::Mistake, details_of_row);
    assert_eq!(describe(&one), row.sentence());
    let lines = list_details(&one);
    assert_eq!(lines[0], row.term);
    assert!(lines[1].starts_with("Here d21 is dx2 - dx1"), "{lines:?}");
    assert_eq!(lines[2], "Look at the coefficients that the particle-edge detection computes.");
}

#[test]
fn advice_on_a_step_fits_its_mistake() {
    for (key, word) in [
        ("linear-hv-step", "system matrix"),
        ("linear-right-of-fixed", "fixed particles"),
        ("implicit-right-sign", "right-hand side"),
        ("newton-iterations-1", "Newton's method"),
        ("linear-velocities-assigned", "solution of the system"),
        ("explicit-positions-other-velocity", "order"),
        ("symplectic-velocities-mass", "forces change velocities"),
    ] {
        assert!(find(key).is_some() && super::describe_step_area(key).contains(word), "{key}");
    }
}

/// Newton's method that diverges multiplies by 2^100. Nobody can read 31 digits of such a number.
#[test]
fn a_huge_ratio_has_six_digits() {
    let detail = stages::describe_detail(&StageDetail::Factor(1_267_650_600_228_229_401_496_703_205_376.0));
    assert_eq!(detail.as_deref(), Some("each change is 1.26765e+30 times the right amount"));
}
