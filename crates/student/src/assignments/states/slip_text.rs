//! Writes the sentences of rows. They describe a slip of a quantity, and its changed and right formula.
use super::{slips::Slip, terms::TermRow};
use crate::assignments::rows::Area;

impl Slip {
    /// Returns the slip's part of a row's id.
    pub(super) fn id(self) -> String {
        let power = |name: &str, power: i8| match power {
            1 => name.to_owned(),
            -1 => format!("no-{name}"),
            2.. => format!("{name}-{power}"),
            _ => format!("no-{name}-{}", -power),
        };
        match self {
            Self::Mass(by) => power("mass", by),
            Self::Step(by) => power("step", by),
            Self::Length(by) => power("length", by),
            Self::Iterations(count) => format!("iterations-{count}"),
            Self::Loose(digits) => format!("loose-{digits}"),
            // Published ids stay the same if a variant is renamed.
            Self::FixedNotMoved => "fixed-stand".to_owned(),
            Self::FixedVelocityZeroedFirst => "fixed-stopped".to_owned(),
            Self::FixedVelocityZeroedAfter => "fixed-halted".to_owned(),
            Self::NotNormalized => "undivided".to_owned(),
            Self::SameNormalBehind => "one-sided".to_owned(),
            Self::NormalAsGiven => "one-sided-long".to_owned(),
            Self::OppositeNormalInFront => "one-sided-back".to_owned(),
            Self::SquaredWithSign => "squared-away".to_owned(),
            Self::WithoutFirstParticle => "first-out".to_owned(),
            Self::WithoutLastParticle => "last-out".to_owned(),
            Self::OnlyFirstParticle => "only-first".to_owned(),
            Self::WholeVelocity => "whole".to_owned(),
            Self::IgnoresSlowApproach => "margin".to_owned(),
            Self::SharesNotSquared => "unsquared".to_owned(),
            Self::FixedUnchanged => "fixed-spared".to_owned(),
            Self::OneBlockOffDiagonal => "one-half".to_owned(),
            Self::ForcesAfterMove => "behind".to_owned(),
            Self::NothingBeyondEnds => "ends-out".to_owned(),
            other => format!("{other:?}").chars().enumerate().fold(String::new(), |mut id, (index, letter)| {
                if letter.is_uppercase() && index > 0 {
                    id.push('-');
                }
                id.push(letter.to_ascii_lowercase());
                id
            }),
        }
    }

    /// Returns the part of a sentence about the slip, which follows the quantity's name.
    pub(super) fn predicate(self, row: &TermRow) -> String {
        let text = match self {
            Self::Missing if row.is_function => match row.area() {
                Area::Integrator => "is not written yet: a step changes nothing",
                Area::SimpleDetection => "is not written yet, or finds nothing",
                Area::Response => "is not written yet, or changes nothing",
                _ => "is not written yet, or adds nothing",
            },
            Self::Sign if row.id.starts_with("normal") => "points in exactly the opposite direction",
            Self::Sign if row.area() == Area::SimpleDetection => "is reversed",
            Self::Mass(-1) if row.id.ends_with("-mass") => "is taken as one for every particle",
            Self::Mass(by) => return describe_power(row.mass, by, "the mass"),
            Self::Step(by) => return describe_power(row.step, by, "the step size"),
            Self::Length(1) if row.length == 0 => "has a direction that is not normalized",
            Self::Length(2) if row.length == 0 => "has a direction that is not normalized in both places",
            Self::Length(1) if row.length < -1 => {
                "lacks one division by the distance, or its direction is not normalized"
            }
            Self::Length(by) => return describe_power(row.length, by, "the distance"),
            Self::FirstOnly if row.area() == Area::SimpleDetection => {
                "takes only the first of the two bodies into account"
            }
            Self::SecondOnly if row.area() == Area::SimpleDetection => {
                "does not take the first of the two bodies into account"
            }
            Self::FirstOnly if row.area() == Area::Jacobians => "lacks the second particle's block on the diagonal",
            Self::SecondOnly if row.area() == Area::Jacobians => "lacks the first particle's block on the diagonal",
            Self::OtherVelocity if row.id.starts_with("explicit") => "uses the new velocity instead of the old one",
            Self::NoFactor if row.id.starts_with("penalty") => "ignores the stiffness",
            other => other.describe(),
        };
        text.to_owned()
    }

    /// Returns the exact form of the slip: the changed and the right formula of the quantity.
    pub(super) fn exact_form(self, row: &TermRow) -> String {
        let formula = row.formula;
        let with = |factor: &str| format!("{factor} ({formula}) is used instead of {formula}.");
        let times = |letter: &str, by: i8| match by {
            1 => with(letter),
            -1 => with(&format!("1 / {letter} times")),
            2.. => with(&format!("{letter}^{by}")),
            _ => with(&format!("1 / {letter}^{} times", -by)),
        };
        match self {
            Self::Missing => format!("{formula} is missing."),
            Self::Sign => with("-"),
            Self::Assigned => format!("= is used instead of += or -= to add {formula}."),
            Self::Doubled => with("2"),
            Self::Halved => with("1 / 2 times"),
            Self::Mass(by) => times("m", by),
            Self::Step(by) => times("h", by),
            Self::Length(by) => times("|d|", by),
            Self::XOnly => format!("Only the x component of {formula} is used."),
            Self::YOnly => format!("Only the y component of {formula} is used."),
            Self::Iterations(count) => format!("The loop ends after iteration {count}; it should be {formula}."),
            Self::Loose(digits) => format!("The loop ends at about 1e-{digits}; it should be {formula}."),
            _ => format!("It should be {formula}."),
        }
    }
}

/// Returns the description of a quantity that contains a further power of `factor`. The right formula contains the
/// power `right_power`.
fn describe_power(right_power: i8, further_power: i8, factor: &str) -> String {
    match (right_power.signum(), (right_power + further_power).signum()) {
        (0, 1) => format!("is multiplied by {factor}"),
        (0, _) => format!("is divided by {factor}"),
        (1, 0) => format!("is not multiplied by {factor}"),
        (1, 1) if further_power > 0 => format!("is multiplied by {factor} one time too many"),
        (1, 1) => format!("is multiplied by {factor} one time too few"),
        (1, _) => format!("is divided by {factor} instead of multiplied by it"),
        (_, 0) => format!("is not divided by {factor}"),
        (_, 1) => format!("is multiplied by {factor} instead of divided by it"),
        _ if further_power < 0 => format!("is divided by {factor} one time too many"),
        _ => format!("is divided by {factor} one time too few"),
    }
}
