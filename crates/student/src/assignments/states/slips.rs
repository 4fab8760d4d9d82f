//! Slips: small changes that make quantities of a program wrong. A few kinds of slips are enough for all quantities.
/// The table of slips, each with its part of a sentence, which follows the quantity's name.
macro_rules! slips {
    ($($(#[$about:meta])* $slip:ident$(($by:ty))? $words:literal;)*) => {
        /// A small change of a quantity. A row of the catalog is a slip in a [quantity](super::Term).
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Slip { $(#[doc = $words] $(#[$about])* $slip$(($by))?,)* }

        impl Slip {
            /// Returns the part of a sentence about the slip that fits any quantity.
            pub(super) const fn describe(self) -> &'static str {
                match self { $(Self::$slip { .. } => $words,)* }
            }
        }
    };
}

slips! {
    Missing "is missing";
    Sign "has the wrong sign";
    Assigned "replaces the sum so far instead of being added to it";
    Doubled "is twice the right value";
    Halved "is half of the right value";
    Absolute "loses its sign by an absolute value";
    Squared "grows with the square of the stretch or depth, whatever its sign";
    SquaredHalf "is half of a square, as in the energy";
    SquaredWithSign "grows with the square of the depth";
    /// Multiplies the term by this power of the mass.
    Mass(i8) "has another factor";
    /// Multiplies the term by this power of the step size.
    Step(i8) "has another factor";
    /// Multiplies the term by this power of the distance.
    Length(i8) "has another factor";
    FirstMass "is multiplied by the mass of the first of its two bodies";
    WholeMass "uses the mass as a whole number, as an integer variable does";
    MassIndex "reads the masses at the particles' indices, although the array holds every mass twice";
    MassOfFirst "uses the mass of the first particle for all particles";
    XOnly "loses its vertical component";
    YOnly "loses its horizontal component";
    Exchanged "exchanges its two components";
    XForBoth "uses the horizontal component for both components";
    YForBoth "uses the vertical component for both components";
    FirstOnly "acts only on the first of its bodies";
    SecondOnly "does not act on the first of its bodies";
    SameSign "has the same direction for both bodies instead of opposite ones";
    WithoutFirstParticle "omits the first particle";
    WithoutLastParticle "omits the last particle";
    OnlyFirstParticle "acts only on the first particle";
    FixedForgotten "treats fixed particles like free ones";
    FixedNotMoved "does not move fixed particles, even those with a velocity";
    FixedVelocityZeroedFirst "sets the velocity of fixed particles to zero, so they do not move";
    FixedVelocityZeroedAfter "sets the velocity of fixed particles to zero once they have moved";
    ForcesAfterMove "uses the forces after the positions have moved instead of before";
    NotCleared "contains the forces of all earlier steps, because the sum is not cleared";
    MatrixSign "has the derivatives with the wrong sign in its matrix";
    RowsOfFixed "leaves the rows and columns of fixed particles in its matrix";
    DiagonalOfFixed "sets the diagonal for fixed particles, but does not clear their rows and columns";
    RightOfFixed "leaves the entries of fixed particles in its right-hand side";
    /// Newton's method ends after this number of iterations.
    Iterations(u8) "ends after a fixed number of iterations";
    /// Newton's method ends at a change below ten to the power of minus this number.
    Loose(i8) "ends too early, at a larger change than the assignment requires";
    OtherVelocity "uses the old velocity instead of the new one";
    MeanVelocity "uses the mean of the old and the new velocity";
    DiagonalOnly "lacks the blocks off the diagonal";
    OffDiagonalSign "has the wrong sign off the diagonal";
    OneBlockOffDiagonal "lacks one of its two blocks off the diagonal";
    OtherMatrix "is added to the wrong matrix";
    NotStrict "counts equality, too";
    IgnoresSlowApproach "ignores slow approaches";
    EndRadius "uses the radius of the edge's first end instead of the edge's own";
    FirstRadius "uses the radius of the first edge for all edges";
    Unclamped "uses the closest point of the whole line, even beyond the ends of the edge";
    Mirrored "measures from the wrong end of the edge";
    Negated "measures the closest point of an edge in the wrong direction from its first end";
    Truncated "cuts alpha to a whole number, as an integer variable does";
    Rounded "uses the nearer end of the edge instead of its closest point";
    Middle "uses the middle of the edge instead of its closest point";
    NothingBeyondEnds "finds nothing beyond the ends of an edge";
    ToPoint "uses the point that defines the half-plane instead of its closest point";
    NotNormalized "does not normalize the half-plane's normal";
    SameNormalBehind "has the direction of the half-plane's normal on both sides of it";
    NormalAsGiven "uses the half-plane's normal without normalizing it, and keeps its sign behind the half-plane";
    OppositeNormalInFront "has the opposite direction of the half-plane's normal on both sides of it";
    Unit "is normalized, although its length must be the distance";
    NoFactor "uses one as the coefficient of restitution";
    Inelastic "uses zero as the coefficient of restitution";
    RestitutionTwice "uses twice the coefficient of restitution instead of adding one";
    RestitutionOnly "uses the coefficient of restitution without adding one";
    NoRadii "ignores the radii";
    NoOtherRadius "ignores the radius of the other body";
    NoThickness "ignores the thickness of the layer";
    ThicknessInTest "uses the thickness of the layer in its test, but not in the depth";
    ThicknessTwice "uses the thickness of the layer for both bodies";
    ThicknessInDepth "uses the thickness of the layer in the depth, but not in its test";
    Always "also acts on bodies that are apart";
    EqualMasses "ignores the masses";
    SwappedMasses "exchanges the masses";
    FixedFinite "uses the mass of a fixed particle instead of an infinite mass";
    OneEndFixesBoth "treats the whole edge as fixed if one of its ends is fixed";
    FixedAsFree "treats fixed particles like free ones, with their mass";
    FixedUnchanged "does not change fixed particles, which the assignment does not require here";
    Sequential "computes later changes with already changed velocities";
    AfterParticle "changes the edge with the already changed velocity of the particle";
    StartVelocity "uses the velocities before the pass instead of those after earlier pairs";
    WholeVelocity "changes the whole velocity instead of its part along the normal";
    SharesNotSquared "does not square the shares of the ends in the weighted masses";
    FullShares "acts on each end of the edge as if it were the only one";
    SharesExchanged "exchanges the shares of the edge's ends";
    EqualShares "is shared equally between the ends of the edge";
    FrontOnly "acts only in front of the half-plane";
    OneEnd "omits the second end of the edge";
}

/// The slips of quantities that are added to a sum.
pub(super) const SUM: &[Slip] = &[Slip::Missing, Slip::Sign, Slip::Doubled, Slip::Halved];
/// The slips in the components of a vector.
pub(super) const VECTOR: &[Slip] = &[Slip::XOnly, Slip::YOnly, Slip::Exchanged];
/// The slips of quantities for each particle.
pub(super) const EACH: &[Slip] = &[Slip::WithoutFirstParticle, Slip::WithoutLastParticle, Slip::OnlyFirstParticle];
/// The slips of the force on each particle.
pub(super) const FORCE: &[Slip] = &[Slip::Assigned, Slip::Mass(1), Slip::Mass(-1), Slip::Step(1)];
/// The slips of quantities for two bodies.
pub(super) const PAIR: &[Slip] = &[Slip::FirstOnly, Slip::SecondOnly, Slip::SameSign];
/// The slips of the factor of a direction.
pub(super) const NUMBER: &[Slip] = &[Slip::Absolute, Slip::Squared, Slip::SquaredHalf, Slip::FirstMass];
/// The slips of quantities that depend on the distance.
pub(super) const DISTANCE: &[Slip] = &[Slip::Length(1), Slip::Length(2), Slip::Length(-1)];
/// The slips of matrix blocks for two bodies.
pub(super) const BLOCKS: &[Slip] = &[
    Slip::DiagonalOnly,
    Slip::OffDiagonalSign,
    Slip::OneBlockOffDiagonal,
    Slip::FirstOnly,
    Slip::SecondOnly,
    Slip::Assigned,
];

impl Slip {
    /// Returns whether a penalty force with this slip acts only on pairs on which the right force acts as well.
    pub fn keeps_distance(self) -> bool {
        use Slip::{
            Always, EndRadius, FirstRadius, Middle, Mirrored, Negated, NotNormalized, Rounded, ThicknessTwice, ToPoint,
            Truncated, Unclamped,
        };
        let moves_point = matches!(self, Middle | Mirrored | Negated | Rounded | ToPoint | Truncated | Unclamped);
        !moves_point && !matches!(self, Always | EndRadius | FirstRadius | NotNormalized | ThicknessTwice)
    }
}
