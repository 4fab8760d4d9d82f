//! The sentences of rows: each says a slip of a quantity, and its exact form.
use super::{slips::Slip, terms::TermRow};
use crate::assignments::rows::Area;

impl Slip {
    /// Returns the slip's part of a row's name.
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
            other => {
                let name = format!("{other:?}");
                name.chars().enumerate().fold(String::new(), |mut id, (index, letter)| {
                    if letter.is_uppercase() && index > 0 {
                        id.push('-');
                    }
                    id.push(letter.to_ascii_lowercase());
                    id
                })
            }
        }
    }

    /// Returns the words of a sentence about it, behind the quantity's name.
    pub(super) fn predicate(self, of: &TermRow) -> String {
        let text = match self {
            Self::Missing if of.is_function => match of.area() {
                Area::Integrator => "is not written yet: a step changes nothing",
                Area::SimpleDetection => "is not written yet, or finds nothing",
                Area::Response => "is not written yet, or changes nothing",
                _ => "is not written yet, or adds nothing",
            },
            Self::Sign if of.id.starts_with("normal") => "points in exactly the opposite direction",
            Self::Sign if of.area() == Area::SimpleDetection => "is reversed",
            Self::Mass(-1) if of.id.ends_with("-mass") => "is taken as one for every particle",
            Self::Mass(by) => return power(of.mass, by, "the mass"),
            Self::Step(by) => return power(of.step, by, "the step size"),
            Self::Length(1) if of.length == 0 => "has a direction that is not normalized",
            Self::Length(2) if of.length == 0 => "has a direction that is not normalized, in both of its places",
            Self::Length(1) if of.length < -1 => {
                "is divided by the distance once too seldom, or its direction is not normalized"
            }
            Self::Length(by) => return power(of.length, by, "the distance"),
            Self::FirstOnly if of.area() == Area::SimpleDetection => {
                "takes only the first of the two bodies into account"
            }
            Self::SecondOnly if of.area() == Area::SimpleDetection => {
                "does not take the first of the two bodies into account"
            }
            Self::FirstOnly if of.area() == Area::Jacobians => "lacks the second particle's block on the diagonal",
            Self::SecondOnly if of.area() == Area::Jacobians => "lacks the first particle's block on the diagonal",
            Self::OtherVelocity if of.id.starts_with("explicit") => "has the new velocity instead of the old one",
            Self::NoFactor if of.id.starts_with("penalty") => "ignores the stiffness",
            other => other.describe(),
        };
        text.to_owned()
    }

    /// Returns the words that fit any quantity.
    const fn describe(self) -> &'static str {
        match self {
            Self::Missing => "is missing",
            Self::Sign => "has the wrong sign",
            Self::Assigned => "replaces the sum so far instead of being added to it",
            Self::Doubled => "is twice what it should be",
            Self::Halved => "is half of what it should be",
            Self::Absolute => "loses its sign by an absolute value",
            Self::Squared => "grows with the square of the stretch or depth, whatever its sign",
            Self::SquaredHalf => "is half of a square, as it is in the energy",
            Self::SquaredAway => "grows with the square of the depth",
            Self::FirstMass => "is multiplied by the mass of the first of its two bodies",
            Self::MassOfFirst => "has the mass of the first particle for all",
            Self::XOnly => "loses its vertical component",
            Self::YOnly => "loses its horizontal component",
            Self::Exchanged => "has its two components exchanged",
            Self::XForBoth => "has the horizontal component in both places",
            Self::YForBoth => "has the vertical component in both places",
            Self::FirstOnly => "acts on the first of its bodies only",
            Self::SecondOnly => "does not act on the first of its bodies",
            Self::SameSign => "has the same direction for both bodies instead of opposite ones",
            Self::FirstOut => "leaves the first particle out",
            Self::LastOut => "leaves the last particle out",
            Self::OnlyFirst => "reaches the first particle only",
            Self::FixedForgotten => "treats fixed particles as free ones",
            Self::FixedStand => "leaves fixed particles where they are, even those with a velocity",
            Self::FixedStopped => "sets the velocity of fixed particles to zero, so that they stand still",
            Self::FixedHalted => "sets the velocity of fixed particles to zero once they have moved",
            Self::Behind => "has the forces after the positions have moved instead of those before",
            Self::NotCleared => "has the forces of all earlier steps in it: their sum is not cleared",
            Self::MatrixSign => "has the derivatives with the wrong sign in its matrix",
            Self::RowsOfFixed => "leaves the rows and columns of fixed particles in its matrix",
            Self::DiagonalOfFixed => "sets the diagonal for fixed particles, but does not clear their rows and columns",
            Self::RightOfFixed => "leaves the entries of fixed particles in its right-hand side",
            Self::Iterations(_) => "ends after a fixed number of iterations",
            Self::Loose(_) => "ends too early, at a larger change than the assignment asks for",
            Self::OtherVelocity => "has the old velocity instead of the new one",
            Self::MeanVelocity => "has the mean of the old and the new velocity",
            Self::DiagonalOnly => "lacks the blocks off the diagonal",
            Self::OffDiagonalSign => "has the wrong sign off the diagonal",
            Self::OneHalf => "lacks one of its two blocks off the diagonal",
            Self::OtherMatrix => "is added to the wrong one of the two matrices",
            Self::NotStrict => "counts equality, too",
            Self::EndRadius => "has the radius of the edge's first end instead of the edge's own",
            Self::Unclamped => "takes the closest point from the whole line, beyond the ends of the edge, too",
            Self::Mirrored => "measures from the wrong end of the edge",
            Self::Middle => "has the middle of the edge instead of its closest point",
            Self::EndsOut => "finds nothing beyond the ends of an edge",
            Self::ToPoint => "goes to the point that defines the half-plane instead of its closest point",
            Self::Undivided => "has the half-plane's normal with its own length instead of a unit vector",
            Self::Negated => "looks for the closest point of an edge in the wrong direction from its first end",
            Self::OneSidedLong => "is along the half-plane's normal as it is given, on both of its sides",
            Self::OneSidedBack => "has the opposite direction of the half-plane's normal, on both of its sides",
            Self::OneSided => "has the direction of the half-plane's normal, on both of its sides",
            Self::Unit => "is normalized, although its length must be the distance",
            Self::NoFactor => "takes the coefficient of restitution as one",
            Self::Inelastic => "takes the coefficient of restitution as zero",
            Self::RestitutionOnly => "has the coefficient of restitution alone, without one added to it",
            Self::NoRadii => "ignores the radii",
            Self::NoOtherRadius => "ignores the radius of the other body",
            Self::NoThickness => "ignores the thickness of the layer",
            Self::ThicknessInTest => "has the thickness of the layer in its test, but not in the depth",
            Self::ThicknessInDepth => "has the thickness of the layer in the depth, but not in its test",
            Self::Always => "also acts on bodies that are apart",
            Self::EqualMasses => "ignores the masses",
            Self::SwappedMasses => "has the masses exchanged",
            Self::FixedFinite => "counts a fixed particle with its mass instead of as infinitely heavy",
            Self::FixedAsFree => "treats fixed particles as free ones, with their mass",
            Self::FixedSpared => "leaves fixed particles as they are, which the assignment does not ask for here",
            Self::Sequential => "computes later changes with velocities that it has changed before",
            Self::StartVelocity => "has the velocities before the pass instead of those that earlier pairs left",
            Self::Whole => "changes the whole velocity instead of its part along the normal",
            Self::Unsquared => "does not square the shares of the ends where masses are weighed",
            Self::FullShares => "acts on each end of the edge as if it were the only one",
            Self::SharesExchanged => "exchanges the shares of the edge's ends",
            Self::EqualShares => "is shared equally between the ends of the edge",
            Self::OneEnd => "forgets the second end of the edge",
            Self::Mass(_) | Self::Step(_) | Self::Length(_) => "has another factor",
        }
    }

    /// Returns the exact form of a quantity with this formula, which should be there without it.
    pub(super) fn exact(self, of: &TermRow) -> String {
        let formula = of.formula;
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
            Self::Loose(digits) => format!("The loop ends at some 1e-{digits}; it should be {formula}."),
            _ => format!("It should be {formula}."),
        }
    }
}

/// Returns the meaning of a further power of a factor that stands with this power already.
fn power(has: i8, by: i8, factor: &str) -> String {
    match (has.signum(), (has + by).signum()) {
        (0, 1) => format!("is multiplied by {factor}"),
        (0, _) => format!("is divided by {factor}"),
        (1, 0) => format!("is not multiplied by {factor}"),
        (1, 1) if by > 0 => format!("is multiplied by {factor} once too often"),
        (1, 1) => format!("is multiplied by {factor} once too seldom"),
        (1, _) => format!("is divided by {factor} instead of multiplied by it"),
        (_, 0) => format!("is not divided by {factor}"),
        (_, 1) => format!("is multiplied by {factor} instead of divided by it"),
        _ if by < 0 => format!("is divided by {factor} once too often"),
        _ => format!("is divided by {factor} once too seldom"),
    }
}
