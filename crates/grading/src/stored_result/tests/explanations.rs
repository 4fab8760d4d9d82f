//! Explanations with every kind of value, and with unusual numbers.
use super::{Role, pair};
use fosssim_mistakes::diagnose::{
    Amount, ChangedQuantity, CoefficientGuess, Detail, Example, ExamplePlace, ExampleValue, Explanation,
    ExplanationTopic, GeometricPartError, Guess, ListGuess, LoopEnd, NanStage, NonFiniteValue, PolynomialDetail,
    PolynomialEvidence, Quantity, QuantityGuess, Ratios, RoundCountError, StageDetail, StageFault, StepRecord,
    Substitute, Weight, WrongDecisions, WrongMotion, WrongPositions, WrongResponses, WrongVectors, WrongZoneRounds,
    WrongZones,
};
use fosssim_model::sim::PairKind;
use fosssim_student::{
    Area,
    assignments::t2m2::{Input, Reading, Subject},
};

/// Returns at least one explanation of every kind.
pub(super) fn all() -> Vec<Explanation> {
    let guesses = [
        Guess::List(ListGuess::ReversedNegated),
        Guess::Named("end-positions".into()),
        Guess::Named("constant-alpha".into()),
        Guess::Quantity(QuantityGuess::Other),
        Guess::Coefficients { powers: vec![3, 0], wrong: CoefficientGuess::Several },
    ];
    let found = guesses.map(PolynomialEvidence::Guess).into_iter();
    let found =
        found.chain([PolynomialEvidence::Missing, PolynomialEvidence::NearlyRight, PolynomialEvidence::Nothing]);
    let subjects = vec![Subject::EdgeOverlap, Subject::HalfPlaneApproach];
    let of_polynomials = found.map(|found| ExplanationTopic::Polynomials { subjects: subjects.clone(), found });
    let others =
        [ExplanationTopic::Mistake, ExplanationTopic::Unfinished, ExplanationTopic::Scene { has_length: false }];
    let stages = [NanStage::Detection(Some(PairKind::ParticleEdge)), NanStage::FirstRecord, NanStage::Zones];
    let ends = stages.map(|stage| {
        ExplanationTopic::NotFinite(NonFiniteValue { step: Some(7), stage, is_nan: true, recovers: false })
    });
    let abouts = of_polynomials.chain(others).chain(ends).chain(faults().into_iter().map(ExplanationTopic::Stage));
    let mut all: Vec<Explanation> = abouts.map(|about| explanation(about, Vec::new(), None)).collect();
    all.extend(examples().into_iter().map(|example| explanation(ExplanationTopic::Mistake, Vec::new(), Some(example))));
    all.push(explanation(ExplanationTopic::Mistake, details(), None));
    all
}

fn explanation(about: ExplanationTopic, details: Vec<Detail>, example: Option<Example>) -> Explanation {
    let (key, same_as) = ("pp-no-two".to_owned(), vec!["other".to_owned()]);
    Explanation {
        key,
        topic: about,
        details,
        reproduced: 4,
        samples: u64::MAX,
        example,
        same_as,
        contradicted_keys: vec!["failsafe-empty".to_owned()],
        claims: vec!["EdgeOverlap/letter/0123456789abcdef".to_owned()],
    }
}

fn faults() -> Vec<StageFault> {
    let kind = Some(PairKind::ParticleHalfPlane);
    let changed = || vec![ChangedQuantity { kind: PairKind::ParticleEdge, body: 2, quantity: Quantity::Velocity }];
    vec![
        StageFault::Order,
        StageFault::Decisions { kind, wrong: WrongDecisions::Superfluous },
        StageFault::ContactTimes,
        StageFault::ContactVectors { kind: None, wrong: WrongVectors::Perpendicular },
        StageFault::Responses { kind, wrong: WrongResponses::Nothing, only_in_rounds: true },
        StageFault::Responses { kind: None, wrong: WrongResponses::Unchanged(changed()), only_in_rounds: false },
        StageFault::Responses { kind: None, wrong: WrongResponses::Across(changed()), only_in_rounds: true },
        StageFault::Responses { kind: None, wrong: WrongResponses::Amount(changed()), only_in_rounds: false },
        StageFault::ManyContacts,
        StageFault::Unresolved { all: true },
        StageFault::Rounds(RoundCountError::More),
        StageFault::HandedOver { quantity: Some(Quantity::Position), when: Some(LoopEnd::Settled), or_response: true },
        StageFault::HandedOver { quantity: None, when: None, or_response: false },
        StageFault::FirstRound,
        StageFault::LaterRounds,
        StageFault::RoundsOfPrediction,
        StageFault::BehindFirstRound,
        StageFault::Geometric(GeometricPartError::Omitted { always: true }),
        StageFault::Geometric(GeometricPartError::Superfluous),
        StageFault::ZonePositions(WrongPositions::First),
        StageFault::AfterRounds,
        StageFault::ZoneRounds(WrongZoneRounds::Later),
        StageFault::Zones(WrongZones::KeepVelocities),
        StageFault::Motion { wrong: vec![WrongMotion::Center, WrongMotion::Speeds], or_zones: true },
    ]
}

fn details() -> Vec<Detail> {
    let reading = Reading { subject: Subject::EdgeOverlap, number: 0 };
    let weight = |actual| Weight {
        reading,
        power: 2,
        letters: vec!["(x12.d32)".into(), "R^2".into()],
        expected: f64::INFINITY,
        actual,
    };
    let stands = |stand| PolynomialDetail::StandsFor { reading, letter: "R^2".into(), stand };
    let polynomials = [
        PolynomialDetail::Logged { logged: 0, of: 4 },
        PolynomialDetail::RightUpTo(5e-324),
        PolynomialDetail::Differs { subject: Some(Subject::AlphaLow), power: 2, count: 1, of: usize::MAX },
        PolynomialDetail::Differs { subject: None, power: 2, count: 1, of: 3 },
        PolynomialDetail::Holds(f64::NEG_INFINITY),
        PolynomialDetail::Every(-0.0),
        PolynomialDetail::SinglePrecision,
        PolynomialDetail::InPlaceOf { used: Subject::AlphaHigh, expected: Subject::EdgeApproach },
        PolynomialDetail::LastOnly(1),
        PolynomialDetail::FirstOnly(2),
        PolynomialDetail::Displacements(1.0 / 3.0),
        PolynomialDetail::Reach { kind: PairKind::ParticleEdge, used: 0.1, expected: 1e-320 },
        PolynomialDetail::Named { key: "end-positions".into(), has_only_edge_pairs: true },
        PolynomialDetail::Named { key: "one-unscaled".into(), has_only_edge_pairs: false },
        stands(Substitute::Scaled(-0.0)),
        stands(Substitute::Letter("a".into())),
        stands(Substitute::Dot { vectors: ["x21".into(), "(p-x-dx)".into()], negated: true }),
        stands(Substitute::One),
        PolynomialDetail::Factor { power: 3, factor: 0.1 },
        PolynomialDetail::Unknown { power: 0 },
        PolynomialDetail::Weight(weight(1e308)),
        PolynomialDetail::Alternative(vec![weight(0.1), weight(-0.0)]),
    ];
    let changed = ChangedQuantity { kind: PairKind::ParticleParticle, body: 0, quantity: Quantity::Position };
    let change = |amount| StageDetail::Change { changed, amount, across: true, wrong: 1, of: 2 };
    let stages = [
        StageDetail::Order,
        StageDetail::Impacts { right: true, count: 3, low: f64::INFINITY, high: f64::NEG_INFINITY },
        StageDetail::Vectors(Ratios::All(-0.0)),
        StageDetail::Times(Ratios::Between(f64::NEG_INFINITY, 0.3)),
        StageDetail::VectorError(1e-300),
        StageDetail::ZoneCount { count: 1, of: 3 },
        StageDetail::TimeError(-1e-300),
        StageDetail::TimeUse,
        StageDetail::Passes { expected: 1, actual: 2, most: i32::MIN },
        change(Amount::Unwanted),
        change(Amount::Right),
        change(Amount::Ratio(Ratios::All(1.5))),
        StageDetail::StoppedVelocities(Ratios::All(0.5)),
        StageDetail::CenterMotion(Ratios::All(0.5)),
        StageDetail::CenterDirection,
        StageDetail::Rotations(Ratios::All(0.5)),
        StageDetail::Velocities(Ratios::All(0.5)),
    ];
    let known = [
        Detail::Term("pp-no-two".into()),
        Detail::SearchArea(Area::Failsafe),
        Detail::Letters(vec![PairKind::ParticleEdge, PairKind::ParticleParticle]),
    ];
    let polynomials = polynomials.map(Detail::Polynomial);
    known.into_iter().chain(polynomials).chain(stages.map(Detail::Stage)).collect()
}

fn examples() -> Vec<Example> {
    let pair = pair(PairKind::ParticleHalfPlane);
    let places = [
        ExamplePlace::Given { pair, pass: 2, subject: Subject::HalfPlaneOverlap },
        ExamplePlace::Polynomial { pair, pass: u32::MAX, role: Role::AlphaBelowOne },
        ExamplePlace::NumberedPolynomial(7),
        ExamplePlace::PolynomialCount,
        ExamplePlace::Contact { kind: None, first: i32::MIN, second: -1 },
        ExamplePlace::Contact { kind: Some(PairKind::ParticleEdge), first: 0, second: 1 },
        ExamplePlace::ContactCount,
        ExamplePlace::Particle { particle: 3, record: StepRecord::Mid },
        ExamplePlace::Particle { particle: 3, record: StepRecord::End },
        ExamplePlace::MidParticle(4),
        ExamplePlace::MidLists,
    ];
    let given = [Input::X1, Input::Re, Input::P].map(|input| ExampleValue { input, value: vec![0.1, -1e-300] });
    let example = |place| Example {
        step: 7,
        place,
        given: given.to_vec(),
        expected: vec![f64::INFINITY, 1.0 / 3.0],
        actual: vec![f64::NEG_INFINITY, -0.0],
    };
    places.map(example).into()
}
