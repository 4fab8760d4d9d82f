//! The serialised form of explanations. What stands in the data of an assignment is written by its key, and what the
//! data do not hold is not read.
use super::*;
use fosssim_mistakes::{
    assignments::t2m2::{Input, Reading, Subject, find_exchange, find_special, ingredient_name, letter_name},
    diagnose::{
        About, Amount, Changed, CoefficientGuess, Detail, Example, ExamplePlace, ExampleValue, Explanation, Guess,
        ListGuess, LoopEnd, NanStage, NotFinite, OfPolynomials, PolynomialDetail, Quantity, QuantityGuess, Ratios,
        StageDetail, StageFault, Stand, StepRecord, Weight, WrongDecisions, WrongGeometric, WrongMotion, WrongNumber,
        WrongPositions, WrongResponses, WrongVectors, WrongZoneRounds, WrongZones,
    },
    student::{Area, CATALOGUE, find},
};

/// A module for `with` that writes lists of types of other rooms.
macro_rules! list_of {
    ($name:ident, $one:ident, $type:ty, $form:tt) => {
        #[derive(Serialize, Deserialize)]
        struct $one(#[serde(with = $form)] $type);

        written_as!($name, Vec<$type>, Vec<$one>, |list| list.iter().cloned().map($one).collect(), |form| Some(
            form.into_iter().map(|one| one.0).collect()
        ));
    };
}

/// A module for `with` that writes a type of another room, or nothing.
macro_rules! option_of {
    ($name:ident, $one:ident, $type:ty, $form:tt) => {
        #[derive(Serialize, Deserialize)]
        struct $one(#[serde(with = $form)] $type);

        written_as!($name, Option<$type>, Option<$one>, |value| value.clone().map($one), |form| Some(
            form.map(|one| one.0)
        ));
    };
}

list_of!(explanations, OneExplanation, Explanation, "ExplanationForm");
list_of!(details, OneDetail, Detail, "DetailForm");
list_of!(example_values, OneValue, ExampleValue, "ExampleValueForm");
list_of!(kinds, OneKind, PairKind, "PairKindForm");
list_of!(subjects, OneSubject, Subject, "SubjectForm");
list_of!(changes, OneChanged, Changed, "ChangedForm");
list_of!(motions, OneMotion, WrongMotion, "WrongMotionForm");
list_of!(weights, OneWeight, Weight, "WeightForm");
option_of!(example, SomeExample, Example, "ExampleForm");
option_of!(kind_or_none, SomeKind, PairKind, "PairKindForm");
option_of!(subject_or_none, SomeSubject, Subject, "SubjectForm");
option_of!(quantity_or_none, SomeQuantity, Quantity, "QuantityForm");
option_of!(end_or_none, SomeEnd, LoopEnd, "LoopEndForm");

written_as!(mistake_key, &'static str, String, |key| (*key).to_owned(), |key| find(&key).map(|row| row.id));
written_as!(exchange_key, &'static str, String, |key| (*key).to_owned(), |key| find_exchange(&key).map(|one| one.key));
written_as!(special_key, &'static str, String, |key| (*key).to_owned(), |key| find_special(&key).map(|one| one.key));
written_as!(letter, &'static str, String, |name| (*name).to_owned(), |name| letter_name(&name));
written_as!(
    letters,
    Vec<&'static str>,
    Vec<String>,
    |names| names.iter().map(|name| (*name).to_owned()).collect(),
    |names| names.iter().map(|name| letter_name(name)).collect()
);
written_as!(vectors, [&'static str; 2], [String; 2], |names| names.map(str::to_owned), |[one, two]| Some([
    ingredient_name(&one)?,
    ingredient_name(&two)?
]));
written_as!(area, Area, String, |area| area.name().to_owned(), |name| {
    CATALOGUE.iter().map(|row| row.area).find(|area| area.name() == name)
});
written_as!(input, Input, String, |input| input.letter().to_owned(), |letter| {
    Input::ALL.into_iter().find(|input| input.letter() == letter)
});

/// A name or a key in the data of an assignment. Under its own type, it would be taken for a part of what is read.
type Name = &'static str;

#[derive(Serialize, Deserialize)]
#[serde(remote = "Explanation")]
struct ExplanationForm {
    key: String,
    #[serde(with = "AboutForm")]
    about: About,
    #[serde(with = "details")]
    details: Vec<Detail>,
    reproduced: u64,
    samples: u64,
    #[serde(with = "example")]
    example: Option<Example>,
    same_as: Vec<String>,
    #[serde(default)]
    denies: Vec<String>,
    #[serde(default)]
    claims: Vec<String>,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "About")]
enum AboutForm {
    Mistake,
    Unfinished,
    Scene {
        has_length: bool,
    },
    Polynomials {
        #[serde(with = "subjects")]
        subjects: Vec<Subject>,
        #[serde(with = "OfPolynomialsForm")]
        found: OfPolynomials,
    },
    Stage(#[serde(with = "StageFaultForm")] StageFault),
    NotFinite(#[serde(with = "NotFiniteForm")] NotFinite),
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "NotFinite")]
struct NotFiniteForm {
    step: Option<u32>,
    #[serde(with = "NanStageForm")]
    stage: NanStage,
    is_nan: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "NanStage")]
enum NanStageForm {
    FirstRecord,
    Motion,
    Detection(#[serde(with = "kind_or_none")] Option<PairKind>),
    ContactVectors,
    Responses,
    ImpulseRounds,
    Zones,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Subject")]
enum SubjectForm {
    ParticleOverlap,
    ParticleApproach,
    EdgeOverlap,
    AlphaLow,
    AlphaHigh,
    EdgeApproach,
    HalfPlaneOverlap,
    HalfPlaneApproach,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "OfPolynomials")]
enum OfPolynomialsForm {
    Guess(#[serde(with = "GuessForm")] Guess),
    Missing,
    NearlyRight,
    Nothing,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Guess")]
enum GuessForm {
    List(#[serde(with = "ListGuessForm")] ListGuess),
    Exchange(#[serde(with = "exchange_key")] Name),
    Special(#[serde(with = "special_key")] Name),
    Quantity(#[serde(with = "QuantityGuessForm")] QuantityGuess),
    Coefficients {
        powers: Vec<usize>,
        #[serde(with = "CoefficientGuessForm")]
        wrong: CoefficientGuess,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "ListGuess")]
enum ListGuessForm {
    AllZero,
    Constant,
    AllEqual,
    SinglePrecision,
    Monic,
    TooLong,
    Reversed,
    Negated,
    ReversedNegated,
    TrailingZero,
    OtherPolynomial,
    OtherPolynomialNegated,
    ConstantOnly,
    Cut,
    CutEnd,
    DisplacementScale,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "QuantityGuess")]
enum QuantityGuessForm {
    Sign,
    Zero,
    Factor,
    Other,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "CoefficientGuess")]
enum CoefficientGuessForm {
    Several,
    Zero,
    Sign,
    Factor,
    TermForeign,
    TermMissing,
    TermSign,
    TermFactor,
    Terms,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "StageFault")]
enum StageFaultForm {
    Order,
    Decisions {
        #[serde(with = "kind_or_none")]
        kind: Option<PairKind>,
        #[serde(with = "WrongDecisionsForm")]
        wrong: WrongDecisions,
    },
    ContactTimes,
    ContactVectors {
        #[serde(with = "kind_or_none")]
        kind: Option<PairKind>,
        #[serde(with = "WrongVectorsForm")]
        wrong: WrongVectors,
    },
    Responses {
        #[serde(with = "kind_or_none")]
        kind: Option<PairKind>,
        #[serde(with = "WrongResponsesForm")]
        wrong: WrongResponses,
        in_rounds: bool,
    },
    ManyContacts,
    Unresolved {
        all: bool,
    },
    Rounds(#[serde(with = "WrongNumberForm")] WrongNumber),
    HandedOver {
        #[serde(with = "quantity_or_none")]
        quantity: Option<Quantity>,
        #[serde(with = "end_or_none")]
        when: Option<LoopEnd>,
        or_response: bool,
    },
    FirstRound,
    LaterRounds,
    RoundsOfPrediction,
    BehindFirstRound,
    Geometric(#[serde(with = "WrongGeometricForm")] WrongGeometric),
    ZonePositions(#[serde(with = "WrongPositionsForm")] WrongPositions),
    AfterRounds,
    ZoneRounds(#[serde(with = "WrongZoneRoundsForm")] WrongZoneRounds),
    Zones(#[serde(with = "WrongZonesForm")] WrongZones),
    Motion {
        #[serde(with = "motions")]
        wrong: Vec<WrongMotion>,
        or_zones: bool,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "WrongGeometric")]
enum WrongGeometricForm {
    Left { always: bool },
    Superfluous,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "WrongPositions")]
enum WrongPositionsForm {
    Prediction,
    First,
    BeforeFailsafe,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "WrongDecisions")]
enum WrongDecisionsForm {
    Missed,
    Superfluous,
    Both,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "WrongVectors")]
enum WrongVectorsForm {
    Perpendicular,
    Direction,
    Zero,
    Inexact,
    Reversed,
    Length,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "WrongResponses")]
enum WrongResponsesForm {
    Nothing,
    Unchanged(#[serde(with = "changes")] Vec<Changed>),
    Across(#[serde(with = "changes")] Vec<Changed>),
    Amount(#[serde(with = "changes")] Vec<Changed>),
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Changed")]
struct ChangedForm {
    #[serde(with = "PairKindForm")]
    kind: PairKind,
    body: usize,
    #[serde(with = "QuantityForm")]
    quantity: Quantity,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Quantity")]
enum QuantityForm {
    Position,
    Velocity,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "WrongNumber")]
enum WrongNumberForm {
    Fewer,
    More,
    Other,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "LoopEnd")]
enum LoopEndForm {
    RanOut,
    Settled,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "WrongZoneRounds")]
enum WrongZoneRoundsForm {
    Growth,
    Fewer,
    More,
    Later,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "WrongZones")]
enum WrongZonesForm {
    Partly,
    PartlyStopped,
    Unmoved,
    Stop,
    NotMerged,
    Joined,
    Others,
    MoveOn,
    KeepPositions,
    KeepVelocities,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "WrongMotion")]
enum WrongMotionForm {
    Centre,
    Distances,
    NoTurn,
    LessTurn,
    MoreTurn,
    TurnBack,
    Turn,
    Velocities,
    Speeds,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Detail")]
enum DetailForm {
    Term(#[serde(with = "mistake_key")] Name),
    Look(#[serde(with = "area")] Area),
    Letters(#[serde(with = "kinds")] Vec<PairKind>),
    Polynomial(#[serde(with = "PolynomialDetailForm")] PolynomialDetail),
    Stage(#[serde(with = "StageDetailForm")] StageDetail),
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "PolynomialDetail")]
enum PolynomialDetailForm {
    Logged {
        logged: usize,
        of: usize,
    },
    RightUpTo(#[serde(with = "number")] f64),
    Differs {
        #[serde(with = "subject_or_none")]
        subject: Option<Subject>,
        power: usize,
        count: usize,
        of: usize,
    },
    Holds(#[serde(with = "number")] f64),
    Every(#[serde(with = "number")] f64),
    SinglePrecision,
    InPlaceOf {
        #[serde(with = "SubjectForm")]
        stands: Subject,
        #[serde(with = "SubjectForm")]
        belongs: Subject,
    },
    LastOnly(usize),
    FirstOnly(usize),
    Displacements(#[serde(with = "number")] f64),
    Exchange {
        #[serde(with = "exchange_key")]
        key: Name,
        of_edges: bool,
    },
    Special(#[serde(with = "special_key")] Name),
    StandsFor {
        #[serde(with = "ReadingForm")]
        reading: Reading,
        #[serde(with = "letter")]
        letter: Name,
        #[serde(with = "StandForm")]
        stand: Stand,
    },
    Factor {
        power: usize,
        #[serde(with = "number")]
        factor: f64,
    },
    Unknown {
        power: usize,
    },
    Weight(#[serde(with = "WeightForm")] Weight),
    Alternative(#[serde(with = "weights")] Vec<Weight>),
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Reading")]
struct ReadingForm {
    #[serde(with = "SubjectForm")]
    subject: Subject,
    number: usize,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Stand")]
enum StandForm {
    Scaled(#[serde(with = "number")] f64),
    Letter(#[serde(with = "letter")] Name),
    Dot {
        #[serde(with = "vectors")]
        vectors: [Name; 2],
        negated: bool,
    },
    One,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Weight")]
struct WeightForm {
    #[serde(with = "ReadingForm")]
    reading: Reading,
    power: usize,
    #[serde(with = "letters")]
    letters: Vec<Name>,
    #[serde(with = "number")]
    expected: f64,
    #[serde(with = "number")]
    actual: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "StageDetail")]
enum StageDetailForm {
    Order,
    Impacts {
        right: bool,
        count: usize,
        #[serde(with = "number")]
        low: f64,
        #[serde(with = "number")]
        high: f64,
    },
    Vectors(#[serde(with = "RatiosForm")] Ratios),
    VectorsOff(#[serde(with = "number")] f64),
    Times(#[serde(with = "RatiosForm")] Ratios),
    TimesOff(#[serde(with = "number")] f64),
    TimesUsed,
    Passes {
        expected: usize,
        actual: usize,
        most: i32,
    },
    Change {
        #[serde(with = "ChangedForm")]
        changed: Changed,
        #[serde(with = "AmountForm")]
        amount: Amount,
        across: bool,
        wrong: usize,
        of: usize,
    },
    OfZones {
        count: usize,
        of: usize,
    },
    Stopped(#[serde(with = "RatiosForm")] Ratios),
    CentreMoves(#[serde(with = "RatiosForm")] Ratios),
    CentreDirection,
    Turns(#[serde(with = "RatiosForm")] Ratios),
    Velocities(#[serde(with = "RatiosForm")] Ratios),
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Amount")]
enum AmountForm {
    Unwanted,
    Right,
    Ratio(#[serde(with = "RatiosForm")] Ratios),
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Ratios")]
enum RatiosForm {
    All(#[serde(with = "number")] f64),
    Between(#[serde(with = "number")] f64, #[serde(with = "number")] f64),
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Example")]
struct ExampleForm {
    step: u32,
    #[serde(with = "ExamplePlaceForm")]
    place: ExamplePlace,
    #[serde(with = "example_values")]
    given: Vec<ExampleValue>,
    #[serde(with = "numbers")]
    expected: Vec<f64>,
    #[serde(with = "numbers")]
    actual: Vec<f64>,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "ExamplePlace")]
enum ExamplePlaceForm {
    Given {
        #[serde(with = "PairForm")]
        pair: Pair,
        pass: u32,
        #[serde(with = "SubjectForm")]
        subject: Subject,
    },
    Polynomial {
        #[serde(with = "PairForm")]
        pair: Pair,
        pass: u32,
        #[serde(with = "RoleForm")]
        role: Role,
    },
    NumberedPolynomial(usize),
    PolynomialCount,
    Contact {
        #[serde(with = "kind_or_none")]
        kind: Option<PairKind>,
        first: i32,
        second: i32,
    },
    ContactCount,
    Particle {
        particle: usize,
        #[serde(with = "StepRecordForm")]
        record: StepRecord,
    },
    MidParticle(usize),
    MidLists,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "StepRecord")]
enum StepRecordForm {
    Mid,
    End,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "ExampleValue")]
struct ExampleValueForm {
    #[serde(with = "input")]
    input: Input,
    #[serde(with = "numbers")]
    value: Vec<f64>,
}
