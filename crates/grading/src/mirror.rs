//! The serialised form of what results are made of.
//!
//! Types of this crate serialise themselves; those of other rooms, which know nothing of serialising, are mirrored here
//! field by field, and the compiler holds the mirrors to them. Numbers read back bit for bit: those that JSON can't
//! write are texts. The version in [`form`](super::form) rises when anything here changes its meaning.
use fosssim_judge::{
    Book, Damage, Finding, FindingCounts, FindingDetail, FindingKind, Part, PolynomialPlace, RecordPart, Rescaled,
    Residuals, Role, Rules, Ruling, Unreadable, fair::Cause,
};
use fosssim_model::{
    sim::{Impulse, Pair, PairKind, Pass, Stage, StepError},
    trace::LoggedImpulse,
};
use fosssim_num::{polynomial::Polynomial, vector::Vec2};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// A number that reads back bit for bit, but for the bits of a NaN.
#[derive(Clone, Copy)]
struct Number(f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0.is_finite() {
            true => serializer.serialize_f64(self.0),
            false => serializer.serialize_str(&self.0.to_string()),
        }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Either {
            Number(f64),
            Text(String),
        }
        match Either::deserialize(deserializer)? {
            Either::Number(number) => Ok(Self(number)),
            Either::Text(text) => text.parse().map(Self).map_err(D::Error::custom),
        }
    }
}

/// A module for `with` that writes one type as another one.
macro_rules! written_as {
    ($name:ident, $type:ty, $form:ty, $write:expr, $read:expr) => {
        pub(crate) mod $name {
            use super::*;

            pub(crate) fn serialize<S: Serializer>(value: &$type, serializer: S) -> Result<S::Ok, S::Error> {
                let write: fn(&$type) -> $form = $write;
                write(value).serialize(serializer)
            }

            pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<$type, D::Error> {
                let read: fn($form) -> Option<$type> = $read;
                read(<$form>::deserialize(deserializer)?).ok_or_else(|| D::Error::custom(stringify!($name)))
            }
        }
    };
}

written_as!(number, f64, Number, |value| Number(*value), |form| Some(form.0));
written_as!(numbers, Vec<f64>, Vec<Number>, |values| values.iter().copied().map(Number).collect(), |form| {
    Some(form.into_iter().map(|number| number.0).collect())
});
written_as!(point, [f64; 2], [Number; 2], |point| point.map(Number), |form| Some(form.map(|number| number.0)));
written_as!(vector, Vec2, [Number; 2], |vector| [Number(vector.x), Number(vector.y)], |[x, y]| {
    Some(Vec2::new(x.0, y.0))
});
written_as!(
    polynomial,
    Polynomial,
    Vec<Number>,
    |polynomial| polynomial.coefficients().iter().copied().map(Number).collect(),
    |form| {
        let coefficients: Vec<f64> = form.into_iter().map(|number| number.0).collect();
        let fits = coefficients.len() <= fosssim_num::polynomial::MAX_COEFFICIENTS;
        fits.then(|| Polynomial::untrimmed(&coefficients))
    }
);
written_as!(kind, FindingKind, String, |kind| kind.key().to_owned(), |key| {
    FindingKind::ALL.into_iter().find(|kind| kind.key() == key)
});
written_as!(counts, FindingCounts, Vec<(String, u64)>, pairs_of_counts, counts_of_pairs);
written_as!(cause, Option<Cause>, Option<String>, |cause| cause.map(|cause| cause.key().to_owned()), |key| {
    match key {
        Some(key) => Cause::from_key(&key).map(Some),
        None => Some(None),
    }
});

written_as!(rules, Rules, String, |rules| rules.name().to_owned(), |name| Rules::from_name(&name));

fn pairs_of_counts(counts: &FindingCounts) -> Vec<(String, u64)> {
    let found = FindingKind::ALL.into_iter().filter(|kind| counts.get(*kind) > 0);
    found.map(|kind| (kind.key().to_owned(), counts.get(kind))).collect()
}

fn counts_of_pairs(pairs: Vec<(String, u64)>) -> Option<FindingCounts> {
    let mut counts = FindingCounts::default();
    for (key, count) in pairs {
        let kind = FindingKind::ALL.into_iter().find(|kind| kind.key() == key)?;
        // A kind stands here once; what somebody has made larger than any count is damage.
        counts.add(kind, count.checked_sub(counts.get(kind))?);
    }
    Some(counts)
}

mod explained;

pub(crate) use explained::explanations;

/// Types of other rooms inside of lists and options.
#[derive(Serialize, Deserialize)]
struct OneDamage(#[serde(with = "DamageForm")] Damage);

#[derive(Serialize, Deserialize)]
struct OneRescaled(#[serde(with = "RescaledForm")] Rescaled);

#[derive(Serialize, Deserialize)]
struct AllResiduals(#[serde(with = "ResidualsForm")] Residuals);

written_as!(damage, Option<Damage>, Option<OneDamage>, |damage| damage.clone().map(OneDamage), |form| {
    Some(form.map(|one| one.0))
});
written_as!(rescaled, Option<Rescaled>, Option<OneRescaled>, |rescaled| rescaled.map(OneRescaled), |form| {
    Some(form.map(|one| one.0))
});
written_as!(residuals, Option<Residuals>, Option<AllResiduals>, |residuals| residuals.map(AllResiduals), |form| {
    Some(form.map(|all| all.0))
});

#[derive(Serialize, Deserialize)]
#[serde(remote = "Book")]
pub(crate) enum BookForm {
    Parity,
    Fair,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Ruling")]
pub(crate) enum RulingForm {
    Accepted,
    WrongAnswer,
    BadTrace,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Unreadable")]
pub(crate) enum UnreadableForm {
    State,
    Impulses,
    Memory,
    Limit,
    Io,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Damage")]
struct DamageForm {
    frame: u64,
    step: u32,
    offset: u64,
    message: String,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Residuals")]
struct ResidualsForm {
    #[serde(with = "number")]
    accumulated_position: f64,
    #[serde(with = "number")]
    accumulated_velocity: f64,
    #[serde(with = "number")]
    maximum_position: f64,
    #[serde(with = "number")]
    maximum_velocity: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "StepError")]
pub(crate) enum StepErrorForm {
    RootSearch {
        step: u32,
        #[serde(with = "PairForm")]
        pair: Pair,
    },
    Newton {
        step: u32,
    },
    VortexHessian {
        step: u32,
    },
    Work {
        step: u32,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "PairKind")]
#[expect(clippy::enum_variant_names, reason = "a mirror has the names of what it mirrors")]
enum PairKindForm {
    ParticleParticle,
    ParticleEdge,
    ParticleHalfPlane,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Pair")]
pub(crate) struct PairForm {
    #[serde(with = "PairKindForm")]
    kind: PairKind,
    first: u32,
    second: u32,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Stage")]
enum StageForm {
    Simple,
    ContinuousTime,
    Impulses { round: u32 },
    Geometric { round: u32 },
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Pass")]
struct PassForm {
    #[serde(with = "StageForm")]
    stage: Stage,
    index: u32,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Role")]
enum RoleForm {
    Overlap,
    AlphaAboveZero,
    AlphaBelowOne,
    Approach,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "PolynomialPlace")]
pub(crate) struct PolynomialPlaceForm {
    #[serde(with = "PassForm")]
    pass: Pass,
    #[serde(with = "PairForm")]
    pair: Pair,
    #[serde(with = "RoleForm")]
    role: Role,
    index: usize,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Impulse")]
struct ImpulseForm {
    #[serde(with = "PairForm")]
    pair: Pair,
    #[serde(with = "vector")]
    normal: Vec2,
    #[serde(with = "number")]
    time: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "LoggedImpulse")]
struct LoggedImpulseForm {
    kind: i32,
    first: i32,
    second: i32,
    #[serde(with = "vector")]
    normal: Vec2,
    #[serde(with = "number")]
    time: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Part")]
enum PartForm {
    Impulses,
    Geometric,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "RecordPart")]
enum RecordPartForm {
    State,
    Impulses,
    Polynomials,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Rescaled")]
struct RescaledForm {
    power: usize,
    #[serde(with = "number")]
    expected: f64,
    #[serde(with = "number")]
    actual: f64,
    #[serde(with = "number")]
    residual: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Finding")]
pub(crate) struct FindingForm {
    step: u32,
    frame: u64,
    #[serde(with = "DetailForm")]
    detail: FindingDetail,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "FindingDetail")]
enum DetailForm {
    MissedCollision {
        #[serde(with = "ImpulseForm")]
        expected: Impulse,
    },
    SuperfluousCollision {
        #[serde(with = "LoggedImpulseForm")]
        actual: LoggedImpulse,
    },
    WrongNormal {
        #[serde(with = "ImpulseForm")]
        expected: Impulse,
        #[serde(with = "LoggedImpulseForm")]
        actual: LoggedImpulse,
        #[serde(with = "number")]
        residual: f64,
    },
    PolynomialCount {
        expected: usize,
        actual: usize,
        per_pass: usize,
    },
    PassCount {
        #[serde(with = "PartForm")]
        part: Part,
        expected: usize,
        actual: usize,
    },
    PolynomialDegree {
        #[serde(with = "PolynomialPlaceForm")]
        place: PolynomialPlace,
        #[serde(with = "polynomial")]
        expected: Polynomial,
        actual_size: usize,
        #[serde(with = "polynomial")]
        actual: Polynomial,
    },
    VanishingPolynomial {
        #[serde(with = "PolynomialPlaceForm")]
        place: PolynomialPlace,
        #[serde(with = "polynomial")]
        expected: Polynomial,
        #[serde(with = "polynomial")]
        actual: Polynomial,
    },
    Coefficient {
        #[serde(with = "PolynomialPlaceForm")]
        place: PolynomialPlace,
        power: usize,
        #[serde(with = "number")]
        expected: f64,
        #[serde(with = "number")]
        actual: f64,
        #[serde(with = "number")]
        residual: f64,
        #[serde(with = "rescaled")]
        rescaled: Option<Rescaled>,
        #[serde(with = "polynomial")]
        expected_polynomial: Polynomial,
        #[serde(with = "polynomial")]
        actual_polynomial: Polynomial,
    },
    Position {
        particle: usize,
        #[serde(with = "point")]
        expected: [f64; 2],
        #[serde(with = "point")]
        actual: [f64; 2],
        #[serde(with = "number")]
        residual: f64,
    },
    Velocity {
        particle: usize,
        #[serde(with = "point")]
        expected: [f64; 2],
        #[serde(with = "point")]
        actual: [f64; 2],
        #[serde(with = "number")]
        residual: f64,
    },
    ContactTime {
        #[serde(with = "ImpulseForm")]
        expected: Impulse,
        #[serde(with = "LoggedImpulseForm")]
        actual: LoggedImpulse,
    },
    RepeatedCollision {
        #[serde(with = "LoggedImpulseForm")]
        actual: LoggedImpulse,
    },
    PassPositions {
        #[serde(with = "PolynomialPlaceForm")]
        place: PolynomialPlace,
    },
    RecordsDiffer {
        #[serde(with = "RecordPartForm")]
        part: RecordPart,
    },
    ImpossibleLog,
    TrimmedDecision {
        #[serde(with = "PolynomialPlaceForm")]
        place: PolynomialPlace,
        collides: bool,
    },
    TrimmedTime {
        #[serde(with = "PolynomialPlaceForm")]
        place: PolynomialPlace,
        #[serde(with = "number")]
        expected: f64,
        #[serde(with = "number")]
        actual: f64,
    },
    BeyondReach {
        particle: usize,
        #[serde(with = "point")]
        position: [f64; 2],
        #[serde(with = "point")]
        velocity: [f64; 2],
    },
    MixedForms {
        #[serde(with = "PolynomialPlaceForm")]
        place: PolynomialPlace,
    },
}
