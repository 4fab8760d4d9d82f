//! Slips, the small changes with which quantities of a program go wrong: the same few everywhere.
/// A small change of a quantity. A row of the catalogue is one of them at one [quantity](super::Term).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slip {
    /// The quantity is missing; where it is a whole function, that is the starter code.
    Missing,
    /// The quantity has the other sign.
    Sign,
    /// The quantity replaces a sum to which it should be added.
    Assigned,
    /// Twice of it.
    Doubled,
    /// Half of it.
    Halved,
    /// The quantity's modulus.
    Absolute,
    /// The quantity's square.
    Squared,
    /// Half of its square, as an energy has it.
    SquaredHalf,
    /// The quantity's square with its own sign.
    SquaredAway,
    /// Multiplied by this power of the mass.
    Mass(i8),
    /// Multiplied by this power of the step size.
    Step(i8),
    /// Multiplied by this power of the distance.
    Length(i8),
    /// Multiplied by the mass of the pair's first body.
    FirstMass,
    /// The mass of particle 0 instead of that of each.
    MassOfFirst,
    /// The second component is lost.
    XOnly,
    /// The first component is lost.
    YOnly,
    /// The components change places.
    Exchanged,
    /// The first component stands for both.
    XForBoth,
    /// The second component stands for both.
    YForBoth,
    /// Only the first body of a pair gets it, or counts.
    FirstOnly,
    /// Only the other bodies of a pair get it, or count.
    SecondOnly,
    /// Both bodies get the same, not opposites.
    SameSign,
    /// Particle 0 does not get it.
    FirstOut,
    /// The last particle does not get it.
    LastOut,
    /// Only particle 0 gets it.
    OnlyFirst,
    /// Fixed particles are treated as free ones.
    FixedForgotten,
    /// Fixed particles do not move.
    FixedStand,
    /// Fixed particles lose their velocity, and stand.
    FixedStopped,
    /// Fixed particles move once more, and lose their velocity then.
    FixedHalted,
    /// Forces at the positions to which the step has moved already.
    Behind,
    /// Forces are added to those of the steps before.
    NotCleared,
    /// The derivatives have the other sign in the matrix.
    MatrixSign,
    /// The rows and columns of fixed particles stay in the matrix.
    RowsOfFixed,
    /// Only the diagonal of the rows and columns of fixed particles is set.
    DiagonalOfFixed,
    /// The right-hand side has entries for fixed particles.
    RightOfFixed,
    /// Newton's method ends after this many iterations.
    Iterations(u8),
    /// Newton's method ends at a change below ten to minus this.
    Loose(i8),
    /// The old velocity instead of the new one, or the reverse.
    OtherVelocity,
    /// The mean of old and new velocity.
    MeanVelocity,
    /// A matrix has only the blocks on the diagonal.
    DiagonalOnly,
    /// A matrix has the blocks off the diagonal with the other sign.
    OffDiagonalSign,
    /// A matrix lacks one of the blocks off the diagonal.
    OneHalf,
    /// A matrix is added to the one by velocities instead of the one by positions, or the reverse.
    OtherMatrix,
    /// Equality counts, too.
    NotStrict,
    /// The radius of an edge's first end instead of the edge's.
    EndRadius,
    /// The closest point of an edge is not limited to it.
    Unclamped,
    /// The closest point is measured from the other end.
    Mirrored,
    /// The closest point has the other sign before it is limited to the edge.
    Negated,
    /// The middle of an edge instead of its closest point.
    Middle,
    /// Points beyond the ends of an edge count as no contact.
    EndsOut,
    /// The point by which a half-plane is given instead of its closest one.
    ToPoint,
    /// The normal of a half-plane as it is given: not divided by its length.
    Undivided,
    /// The direction is that of the half-plane's normal, on both of its sides.
    OneSided,
    /// The normal, with the length of the normal.
    OneSidedLong,
    /// The direction is the opposite of the half-plane's normal, on both of its sides.
    OneSidedBack,
    /// The vector has length one.
    Unit,
    /// A factor of the formula is left out: stiffness, or restitution taken as one.
    NoFactor,
    /// The coefficient of restitution taken as zero.
    Inelastic,
    /// The coefficient of restitution without the one.
    RestitutionOnly,
    /// The radii are left out.
    NoRadii,
    /// The radius of the body that is not the pair's first is left out.
    NoOtherRadius,
    /// The layer's thickness is left out.
    NoThickness,
    /// The layer's thickness is in the test only.
    ThicknessInTest,
    /// The layer's thickness is in the depth only.
    ThicknessInDepth,
    /// The test whether bodies are near is missing.
    Always,
    /// All masses are the same.
    EqualMasses,
    /// The masses change places.
    SwappedMasses,
    /// Fixed bodies count with their masses, but stay.
    FixedFinite,
    /// Fixed bodies count with their masses, and are pushed.
    FixedAsFree,
    /// Fixed bodies are left out where they are not to be.
    FixedSpared,
    /// Each body sees the velocity that the one before it has got.
    Sequential,
    /// Velocities are those before the pass.
    StartVelocity,
    /// All of the velocity is changed, not its part along the normal.
    Whole,
    /// Shares of an edge's ends are not squared.
    Unsquared,
    /// Both ends of an edge get all.
    FullShares,
    /// The shares of an edge's ends change places.
    SharesExchanged,
    /// Both ends of an edge get half.
    EqualShares,
    /// The second end of an edge is forgotten.
    OneEnd,
}

/// The slips of everything that is added to a sum.
pub(super) const SUM: &[Slip] = &[Slip::Missing, Slip::Sign, Slip::Doubled, Slip::Halved];
/// Slips of a vector.
pub(super) const VECTOR: &[Slip] = &[Slip::XOnly, Slip::YOnly, Slip::Exchanged];
/// Slips of what each particle gets.
pub(super) const EACH: &[Slip] = &[Slip::FirstOut, Slip::LastOut, Slip::OnlyFirst];
/// Slips of the force on each particle.
pub(super) const FORCE: &[Slip] = &[Slip::Assigned, Slip::Mass(1), Slip::Mass(-1), Slip::Step(1)];
/// Slips of what two bodies get.
pub(super) const PAIR: &[Slip] = &[Slip::FirstOnly, Slip::SecondOnly, Slip::SameSign];
/// Slips of the number before a direction.
pub(super) const NUMBER: &[Slip] = &[Slip::Absolute, Slip::Squared, Slip::SquaredHalf, Slip::FirstMass];
/// Slips of what depends on the distance.
pub(super) const DISTANCE: &[Slip] = &[Slip::Length(1), Slip::Length(2), Slip::Length(-1)];
/// Slips of blocks of a matrix of two bodies.
pub(super) const BLOCKS: &[Slip] =
    &[Slip::DiagonalOnly, Slip::OffDiagonalSign, Slip::OneHalf, Slip::FirstOnly, Slip::SecondOnly, Slip::Assigned];

impl Slip {
    /// Returns whether bodies at which nothing should act stay without any effect.
    pub fn keeps_distance(self) -> bool {
        use Slip::{Always, EndRadius, Middle, Mirrored, Negated, ToPoint, Unclamped, Undivided};
        !matches!(self, Always | EndRadius | Middle | Mirrored | Negated | ToPoint | Unclamped | Undivided)
    }
}
