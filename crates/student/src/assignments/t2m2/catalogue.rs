//! Mistakes and variants of a student's program in collision handling, in its trace, and as a process.
use super::{
    super::{
        rows::{RowOf, rows},
        states::StepMistake,
    },
    Subject::*,
    edits::{
        FormulaEdit::{self, *},
        *,
    },
    inputs::root,
    named::*,
    specials::*,
};

/// A row of any table.
pub type Row = RowOf<Mistake>;

impl From<StepMistake> for Mistake {
    fn from(mistake: StepMistake) -> Self {
        Self::Step(mistake)
    }
}

rows! {
    /// A difference of a program.
    Mistake CATALOGUE [Step StepMistake] [FormulaEdit]
    Wrong ParticleParticle {
        ParticleParticleEmpty "pp-empty" [Lists(Vec::clear)]: "The detection is left empty: it never calls the root finder." => "No polynomial reaches the root finder; overlap (quadratic) and approach (linear) are expected for each pair.";
        ParticleParticleZero "pp-zero" [Lists(|lists| lists.iter_mut().for_each(|list| list.fill(0.0)))]:
            "The coefficients are left at zero."
            =>
            "Every coefficient is 0; expected are -d21.d21, -2 x21.d21, (r1 + r2)^2 - x21.x21 and -d21.d21, -x21.d21.";
        ParticleParticleReversed "pp-reversed" [Lists(|lists| lists.iter_mut().for_each(|list| list.reverse()))]:
            "The coefficients are handed over lowest power first."
            =>
            "Polynomial takes the coefficient of the highest power first; here 1 comes first, then t.";
        ParticleParticleSwapped "pp-swapped" [Lists(|lists| lists.swap(0, 1))]:
            "The first two polynomials are handed over in the wrong order."
            =>
            "Polynomial 2 comes before polynomial 1.";
        ParticleParticleNoTwo "pp-no-two" [Weight(ParticleOverlap, 1, &[1], 0.5)]: "The linear coefficient of the overlap lacks a factor." => "t: -x21.d21 is used instead of -2 x21.d21.";
        ParticleParticleLinearSign "pp-linear-sign" [Weight(ParticleOverlap, 1, &[1], -1.0)]: "The linear coefficient of the overlap has the wrong sign." => "t: 2 x21.d21 is used instead of -2 x21.d21.";
        ParticleParticleQuadraticSign "pp-quadratic-sign" [Weight(ParticleOverlap, 2, &[0], -1.0)]: "The quadratic coefficient of the overlap has the wrong sign." => "t^2: d21.d21 is used instead of -d21.d21.";
        ParticleParticleNoQuadratic "pp-no-quadratic" [Weight(ParticleOverlap, 2, &[0], 0.0)]: "The quadratic coefficient of the overlap is missing." => "t^2: 0 is used instead of -d21.d21.";
        ParticleParticleConstantSign "pp-constant-sign" [List(ParticleOverlap, negate_at::<2>)]: "Distance and radii are exchanged in the constant coefficient." => "1: x21.x21 - (r1 + r2)^2 is used instead of (r1 + r2)^2 - x21.x21.";
        ParticleParticleRadiiSquaredApart "pp-radii-squared-apart" [Named(&RADII_SQUARED_APART)]: "Each radius is squared for itself before they are added." => "1: r1^2 + r2^2 is used instead of (r1 + r2)^2; 2 r1 r2 is missing.";
        ParticleParticleRadiusNotSquared "pp-radius-not-squared" [Named(&RADIUS_NOT_SQUARED)]: "The sum of the radii is not squared." => "1: r1 + r2 is used instead of (r1 + r2)^2.";
        ParticleParticleDistanceNotSquared "pp-distance-not-squared" [Letters(ParticleOverlap, |letters, _| letters[2] = root(letters[2]))]: "The constant coefficient has the distance instead of its square." => "1: |x21| is used instead of x21.x21.";
        ParticleParticleFirstRadiusTwice "pp-first-radius-twice" [Named(&FIRST_RADIUS_TWICE)]: "The first particle's radius is used for both particles." => "1: (r1 + r1)^2 is used instead of (r1 + r2)^2.";
        ParticleParticleSecondRadiusTwice "pp-second-radius-twice" [Named(&SECOND_RADIUS_TWICE)]: "The second particle's radius is used for both particles." => "1: (r2 + r2)^2 is used instead of (r1 + r2)^2.";
        ParticleParticleDiameters "pp-diameters" [Named(&DIAMETERS)]: "The diameters are used instead of the radii." => "1: (2 r1 + 2 r2)^2 is used instead of (r1 + r2)^2.";
        ParticleParticleOneRadius "pp-one-radius" [Named(&FIRST_RADIUS_ONLY)]: "The second particle's radius is forgotten." => "1: r1^2 is used instead of (r1 + r2)^2.";
        ParticleParticleNoFirstRadius "pp-no-first-radius" [Named(&SECOND_RADIUS_ONLY)]: "The first particle's radius is forgotten." => "1: r2^2 is used instead of (r1 + r2)^2.";
        ParticleParticleEndPositions "pp-end-positions" [Named(&END_POSITIONS)]: "The formulas start from the positions at the end of the step." => "x1 and x2 are taken from qe instead of qs.";
        ParticleParticleFirstStill "pp-first-still" [Letters(ParticleOverlap, first_still)]: "The first particle's displacement is forgotten." => "d21 = dx2 is used instead of d21 = dx2 - dx1.";
        ParticleParticleSecondStill "pp-second-still" [Named(&SECOND_PARTICLE_STILL)]: "The second particle's displacement is forgotten." => "d21 = -dx1 is used instead of d21 = dx2 - dx1.";
        ParticleParticleEndForDisplacement "pp-end-for-displacement" [Letters(ParticleOverlap, ends_for_displacements)]: "End positions are used instead of displacements." => "dx = qe is used instead of dx = qe - qs.";
        ParticleParticleDisplacementsSwapped "pp-displacements-swapped" [Named(&DISPLACEMENT_REVERSED)]: "The displacements of the two particles are exchanged, or both have the wrong sign." => "d21 = dx1 - dx2 is used instead of d21 = dx2 - dx1.";
        ParticleParticlePositionIndex "pp-position-index": "Positions are read at the particle's number, although each particle has two coordinates." => "x[i] is used instead of x[2 i], and likewise for j.";
        ParticleParticleNextRadius "pp-next-radius": "The radius of the next particle in the list is used." => "radius[j + 1] is used instead of radius[j], and likewise for i.";
        ParticleParticleXOnly "pp-x-only" [Letters(ParticleOverlap, x_only)]: "The dot products of the moving terms leave the second component out." => "d21.d21 and x21.d21 have their x products only; the y products are missing.";
        ParticleParticleTinyError "pp-tiny-error" [List(ParticleOverlap, |list| list[2] *= 1.0 + 1e-9)]: "The constant coefficient is wrong by a tiny factor." => "1: (r1 + r2)^2 - x21.x21 is multiplied by 1 + 1e-9.";
        ParticleParticleOverlapNegated "pp-overlap-negated" [List(ParticleOverlap, negate)]: "The overlap polynomial is negative where the objects overlap." => "All three coefficients have the wrong sign.";
        ParticleParticleApproachNegated "pp-approach-negated" [List(ParticleApproach, negate)]: "The approach has the wrong sign, so only separating particles collide." => "d21.d21 t + x21.d21 is used instead of -d21.d21 t - x21.d21.";
        ParticleParticleSeparating "pp-separating" [List(ParticleApproach, negate_at::<1>)]: "The approach has the relative velocity the wrong way round in its constant term." => "1: x21.d21 is used instead of -x21.d21.";
        ParticleParticleApproachSlopeSign "pp-approach-slope-sign" [List(ParticleApproach, negate_at::<0>)]: "The approach's slope has the wrong sign." => "t: d21.d21 is used instead of -d21.d21.";
        ParticleParticleApproachSlopeTwice "pp-approach-slope-twice" [List(ParticleApproach, |list| list[0] *= 2.0)]: "The approach's slope has a factor that its constant term lacks." => "t: -2 d21.d21 is used instead of -d21.d21.";
        ParticleParticleApproachAtStart "pp-approach-at-start" [List(ParticleApproach, keep_last::<1>)]: "The approach is tested at the start of the step only." => "The term -d21.d21 t is missing; only -x21.d21 is there.";
        ParticleParticleNoApproach "pp-no-approach" [List(ParticleApproach, replace_by_one)]: "The approach is not tested: a constant is used instead." => "The polynomial 1 is used instead of -d21.d21 t - x21.d21.";
    }
    Wrong ParticleEdge {
        ParticleEdgeEmpty "pe-empty" [Lists(Vec::clear)]: "The detection is left empty: it never calls the root finder." => "No polynomial reaches the root finder; overlap, alpha > 0, alpha < 1 and approach are expected for each pair.";
        ParticleEdgeZero "pe-zero" [Lists(|lists| lists[..3].iter_mut().for_each(|list| list.fill(0.0)))]:
            "The coefficients are left at zero."
            =>
            "Every coefficient is 0, except those of the supplied approach.";
        ParticleEdgeReversed "pe-reversed" [Lists(|lists| lists.iter_mut().for_each(|list| list.reverse()))]:
            "The coefficients are handed over lowest power first."
            =>
            "Polynomial takes the coefficient of the highest power first; here 1 comes first, then t.";
        ParticleEdgeSwapped "pe-swapped" [Lists(|lists| lists.swap(0, 1))]:
            "The first two polynomials are handed over in the wrong order."
            =>
            "Polynomial 2 comes before polynomial 1.";
        ParticleEdgeStill "pe-edge-still" [Named(&EDGE_STILL)]: "The edge is treated as if it did not move." => "dx2 = dx3 = 0 in all formulas.";
        ParticleEdgeParticleStill "pe-particle-still" [Named(&PARTICLE_STILL)]: "The particle's displacement is forgotten." => "dx1 = 0 in all formulas.";
        ParticleEdgeFirstEndStill "pe-first-end-still" [Named(&FIRST_END_STILL)]: "The displacement of the edge's first endpoint is forgotten." => "dx2 = 0 in all formulas.";
        ParticleEdgeSecondEndStill "pe-second-end-still" [Named(&SECOND_END_STILL)]: "The displacement of the edge's second endpoint is forgotten." => "dx3 = 0 in all formulas.";
        ParticleEdgeOneDisplacement "pe-one-displacement" [Named(&FIRST_DISPLACEMENT_TWICE)]: "The first endpoint's displacement is used for both endpoints." => "dx2 is used instead of dx3.";
        ParticleEdgeOtherDisplacement "pe-other-displacement" [Named(&SECOND_DISPLACEMENT_TWICE)]: "The second endpoint's displacement is used for both endpoints." => "dx3 is used instead of dx2.";
        ParticleEdgeDisplacementsSwapped "pe-displacements-swapped" [Named(&DISPLACEMENTS_SWAPPED)]: "The endpoints' displacements are exchanged." => "dx2 and dx3 are exchanged.";
        ParticleEdgeEndPositions "pe-end-positions" [Named(&END_POSITIONS)]: "The formulas start from the positions at the end of the step." => "x1, x2 and x3 are taken from qe instead of qs.";
        ParticleEdgeEndForDisplacement "pe-end-for-displacement" [Named(&END_FOR_DISPLACEMENT)]: "End positions are used instead of displacements." => "dx = qe is used instead of dx = qe - qs.";
        ParticleEdgeEndpointsSwapped "pe-endpoints-swapped" [Named(&ENDPOINTS_SWAPPED)]: "The endpoints are exchanged, so the two alpha polynomials are, too." => "x2 and x3 are exchanged, and dx2 and dx3.";
        ParticleEdgeRadiiSquaredApart "pe-radii-squared-apart" [Named(&RADII_SQUARED_APART)]: "Each radius is squared for itself before they are added." => "r1^2 + re^2 is used instead of (r1 + re)^2; 2 r1 re is missing.";
        ParticleEdgeRadiusNotSquared "pe-radius-not-squared" [Named(&RADIUS_NOT_SQUARED)]: "The sum of the radii is not squared." => "r1 + re is used instead of (r1 + re)^2.";
        ParticleEdgeNoEdgeRadius "pe-no-edge-radius" [Named(&FIRST_RADIUS_ONLY)]: "The edge's radius is forgotten." => "r1^2 is used instead of (r1 + re)^2.";
        ParticleEdgeNoParticleRadius "pe-no-particle-radius" [Named(&SECOND_RADIUS_ONLY)]: "The particle's radius is forgotten." => "re^2 is used instead of (r1 + re)^2.";
        ParticleEdgeParticleRadiusTwice "pe-particle-radius-twice" [Named(&FIRST_RADIUS_TWICE)]: "The particle's radius is used for both objects." => "(r1 + r1)^2 is used instead of (r1 + re)^2.";
        ParticleEdgeEdgeRadiusTwice "pe-edge-radius-twice" [Named(&SECOND_RADIUS_TWICE)]: "The edge's radius is used for both objects." => "(re + re)^2 is used instead of (r1 + re)^2.";
        ParticleEdgeDiameters "pe-diameters" [Named(&DIAMETERS)]: "The diameters are used instead of the radii." => "(2 r1 + 2 re)^2 is used instead of (r1 + re)^2.";
        ParticleEdgeFirstEdgeRadius "pe-first-edge-radius": "The first edge's radius is used for all edges." => "radius[0] is used instead of the radius of edge e, radius[e].";
        ParticleEdgeFirstEndRadius "pe-first-end-radius": "The radius of the edge's first end particle is used instead of the edge's own." => "radius[j] of particle j is used instead of the radius of edge e, j being its first end.";
        ParticleEdgeSecondEndRadius "pe-second-end-radius": "The radius of the edge's second end particle is used instead of the edge's own." => "radius[k] of particle k is used instead of the radius of edge e, k being its second end.";
        ParticleEdgeRadiusIndex "pe-radius-index": "The particle's radius is read at the edge's number." => "radius[e] is used instead of radius[i].";
        ParticleEdgePositionIndex "pe-position-index": "Positions are read at the particle's number, although each particle has two coordinates." => "x[i] is used instead of x[2 i], and likewise for the edge's ends.";
        ParticleEdgeRadiusUnscaled "pe-radius-unscaled" [Named(&RADIUS_UNSCALED)]: "The radii are not multiplied by the edge's squared length when the denominator is cleared." => "(r1 + re)^2 is used instead of (r1 + re)^2 (x32 + t d32).(x32 + t d32).";
        ParticleEdgeQuarticNegated "pe-quartic-negated" [List(EdgeOverlap, negate)]: "The overlap polynomial is negative where the objects overlap." => "All five coefficients have the wrong sign.";
        ParticleEdgeThreeTerms "pe-three-terms" [List(EdgeOverlap, keep_last::<3>)]: "The overlap polynomial is cut to its last three terms." => "The coefficients of t^4 and t^3 are missing.";
        ParticleEdgeQuarticNoFi "pe-quartic-no-fi" [Weight(EdgeOverlap, 4, &[5, 8], 0.0)]: "A product is missing in the leading coefficient of the overlap." => "t^4 lacks -f i, with f = d21.d21 and i = d32.d32.";
        ParticleEdgeQuarticPlusFi "pe-quartic-plus-fi" [Weight(EdgeOverlap, 4, &[5, 8], -1.0)]: "A product in the leading coefficient of the overlap has the wrong sign." => "t^4 has +f i instead of -f i, with f = d21.d21 and i = d32.d32.";
        ParticleEdgeNoCubic "pe-no-cubic" [List(EdgeOverlap, |list| list[1] = 0.0)]: "The cubic coefficient of the overlap is zero." => "t^3: 0 is used instead of 2 b c - 2 e i - 2 f h, with b = (x1-x2).d32 + (dx1-dx2).x32, c = (dx1-dx2).d32, e = d21.x21, f = d21.d21, h = d32.x32 and i = d32.d32.";
        ParticleEdgeCubicOneBc "pe-cubic-one-bc" [Weight(EdgeOverlap, 3, &[1, 2], 0.5)]: "A product in the cubic coefficient of the overlap lacks its factor." => "t^3 has b c instead of 2 b c, with b = (x1-x2).d32 + (dx1-dx2).x32 and c = (dx1-dx2).d32.";
        ParticleEdgeCubicOneEi "pe-cubic-one-ei" [Weight(EdgeOverlap, 3, &[4, 8], 0.5)]: "A product in the cubic coefficient of the overlap lacks its factor." => "t^3 has -e i instead of -2 e i, with e = d21.x21 and i = d32.d32.";
        ParticleEdgeCubicNoFh "pe-cubic-no-fh" [Weight(EdgeOverlap, 3, &[5, 7], 0.0)]: "A product is missing in the cubic coefficient of the overlap." => "t^3 lacks -2 f h, with f = d21.d21 and h = d32.x32.";
        ParticleEdgeCubicParentheses "pe-cubic-parentheses" [Weight(EdgeOverlap, 3, &[5, 7], -1.0)]: "A product in the cubic coefficient of the overlap has the wrong sign." => "t^3 has +2 f h instead of -2 f h, with f = d21.d21 and h = d32.x32.";
        ParticleEdgeSquareNoEh "pe-square-no-eh" [Weight(EdgeOverlap, 2, &[4, 7], 0.0)]: "A product is missing in the quadratic coefficient of the overlap." => "t^2 lacks -4 e h, with e = d21.x21 and h = d32.x32.";
        ParticleEdgeSquareTwoEh "pe-square-two-eh" [Weight(EdgeOverlap, 2, &[4, 7], 0.5)]: "A product in the quadratic coefficient of the overlap has half its factor." => "t^2 has -2 e h instead of -4 e h, with e = d21.x21 and h = d32.x32.";
        ParticleEdgeSquareNoBb "pe-square-no-bb" [Weight(EdgeOverlap, 2, &[1, 1], 0.0)]: "A square is missing in the quadratic coefficient of the overlap." => "t^2 lacks b^2, with b = (x1-x2).d32 + (dx1-dx2).x32.";
        ParticleEdgeSquareOneCa "pe-square-one-ca" [Weight(EdgeOverlap, 2, &[0, 2], 0.5)]: "A product in the quadratic coefficient of the overlap lacks its factor." => "t^2 has c a instead of 2 c a, with a = (x1-x2).x32 and c = (dx1-dx2).d32.";
        ParticleEdgeSquareNoDi "pe-square-no-di" [Weight(EdgeOverlap, 2, &[3, 8], 0.0)]: "A product is missing in the quadratic coefficient of the overlap." => "t^2 lacks -d i, with d = x21.x21 and i = d32.d32.";
        ParticleEdgeSquarePlusFg "pe-square-plus-fg" [Weight(EdgeOverlap, 2, &[5, 6], -1.0)]: "A product in the quadratic coefficient of the overlap has the wrong sign." => "t^2 has +f g instead of -f g, with f = d21.d21 and g = x32.x32.";
        ParticleEdgeSquareRadiusTwice "pe-square-radius-twice" [Weight(EdgeOverlap, 2, &[8, 9], 2.0)]: "The radius term of the overlap's quadratic coefficient is doubled." => "t^2 has 2 (r1 + re)^2 i instead of (r1 + re)^2 i, with i = d32.d32.";
        ParticleEdgeLinearOneAb "pe-linear-one-ab" [Weight(EdgeOverlap, 1, &[0, 1], 0.5)]: "A product in the linear coefficient of the overlap lacks its factor." => "t has a b instead of 2 a b, with a = (x1-x2).x32 and b = (x1-x2).d32 + (dx1-dx2).x32.";
        ParticleEdgeLinearNoDh "pe-linear-no-dh" [Weight(EdgeOverlap, 1, &[3, 7], 0.0)]: "A product is missing in the linear coefficient of the overlap." => "t lacks -2 d h, with d = x21.x21 and h = d32.x32.";
        ParticleEdgeLinearNoEg "pe-linear-no-eg" [Weight(EdgeOverlap, 1, &[4, 6], 0.0)]: "A product is missing in the linear coefficient of the overlap." => "t lacks -2 e g, with e = d21.x21 and g = x32.x32.";
        ParticleEdgeLinearOneSh "pe-linear-one-sh" [Weight(EdgeOverlap, 1, &[7, 9], 0.5)]: "The radius term of the overlap's linear coefficient lacks its factor." => "t has (r1 + re)^2 h instead of 2 (r1 + re)^2 h, with h = d32.x32.";
        ParticleEdgeLinearMinusSh "pe-linear-minus-sh" [Weight(EdgeOverlap, 1, &[7, 9], -1.0)]: "The radius term of the overlap's linear coefficient has the wrong sign." => "t has -2 (r1 + re)^2 h instead of 2 (r1 + re)^2 h, with h = d32.x32.";
        ParticleEdgeConstantNoDg "pe-constant-no-dg" [Weight(EdgeOverlap, 0, &[3, 6], 0.0)]: "A product is missing in the constant coefficient of the overlap." => "1 lacks -d g, with d = x21.x21 and g = x32.x32.";
        ParticleEdgeConstantMinusAa "pe-constant-minus-aa" [Weight(EdgeOverlap, 0, &[0, 0], -1.0)]: "A square in the constant coefficient of the overlap has the wrong sign." => "1 has -a^2 instead of a^2, with a = (x1-x2).x32.";
        AlphaLowSlopeSign "pe-alpha-low-slope-sign" [List(AlphaLow, negate_at::<1>)]: "The linear coefficient of alpha > 0 has the wrong sign." => "t: -b is used instead of b = (x1-x2).d32 + (dx1-dx2).x32.";
        AlphaLowNegated "pe-alpha-low-negated" [List(AlphaLow, negate)]: "The alpha > 0 polynomial has the wrong sign, so it tests the opposite." => "All three coefficients are negated: the polynomial says alpha < 0.";
        AlphaLowNoQuadratic "pe-alpha-low-no-quadratic" [List(AlphaLow, keep_last::<2>)]: "The quadratic coefficient of alpha > 0 is missing." => "t^2: 0 is used instead of (dx1-dx2).d32.";
        AlphaLowHalfSlope "pe-alpha-low-half-slope" [Weight(AlphaLow, 1, &[1], 0.0)]: "The linear coefficient of alpha > 0 lacks one of its products." => "t lacks (x1-x2).d32.";
        AlphaLowIsHigh "pe-alpha-low-is-high" [Lists(|lists| lists[1] = lists[2].clone())]: "alpha < 1 is handed over twice, alpha > 0 never." => "The alpha < 1 polynomial is used instead of alpha > 0.";
        AlphaLowAtStart "pe-alpha-low-at-start" [List(AlphaLow, keep_last::<1>)]: "alpha > 0 is tested at the start of the step only." => "Only the constant (x1-x2).x32 is there.";
        AlphaLowMissing "pe-alpha-low-missing" [List(AlphaLow, replace_by_one)]: "alpha > 0 is not tested: a constant is used instead." => "The polynomial 1 is used instead of alpha > 0.";
        AlphaHighIsLow "pe-alpha-high-is-low" [Lists(|lists| lists[2] = lists[1].clone())]: "alpha > 0 is handed over twice, alpha < 1 never." => "The alpha > 0 polynomial is used instead of alpha < 1.";
        AlphaHighUnscaled "pe-alpha-high-unscaled" [Named(&ONE_UNSCALED)]: "The whole in alpha < 1 is not multiplied by the edge's squared length." => "1 - (x1-x2).x32 is used instead of x32.x32 - (x1-x2).x32, and likewise for t and t^2.";
        AlphaHighNegated "pe-alpha-high-negated" [List(AlphaHigh, negate)]: "The alpha < 1 polynomial has the wrong sign, so it tests the opposite." => "All three coefficients are negated: the polynomial says alpha > 1.";
        AlphaHighHalfSlope "pe-alpha-high-half-slope" [Weight(AlphaHigh, 1, &[2], 0.0)]: "The linear coefficient of alpha < 1 lacks one of its products." => "t lacks (dx1-dx3).(x2-x3).";
        AlphaHighSlopeSign "pe-alpha-high-slope-sign" [List(AlphaHigh, negate_at::<1>)]: "The linear coefficient of alpha < 1 has the wrong sign." => "t: -(dx1-dx3).(x2-x3) - (x1-x3).(dx2-dx3) is used instead of their sum.";
        AlphaHighNoQuadratic "pe-alpha-high-no-quadratic" [List(AlphaHigh, keep_last::<2>)]: "The quadratic coefficient of alpha < 1 is missing." => "t^2: 0 is used instead of (dx1-dx3).(dx2-dx3).";
        AlphaHighAtStart "pe-alpha-high-at-start" [List(AlphaHigh, keep_last::<1>)]: "alpha < 1 is tested at the start of the step only." => "Only the constant (x1-x3).(x2-x3) is there.";
        AlphaHighMissing "pe-alpha-high-missing" [List(AlphaHigh, replace_by_one)]: "alpha < 1 is not tested: a constant is used instead." => "The polynomial 1 is used instead of alpha < 1.";
        QuinticConstantAlpha "pe-approach-constant-alpha" [Named(&CONSTANT_ALPHA)]: "The approach treats alpha as constant during the step, which the assignment warns about." => "alpha = (x1-x2).x32 / x32.x32 at the start of the step is used instead of alpha(t).";
        QuinticNegated "pe-approach-negated" [List(EdgeApproach, negate)]: "The approach has the wrong sign, so only separating objects collide." => "All six coefficients are negated.";
        QuinticMissing "pe-approach-missing" [List(EdgeApproach, replace_by_one)]: "The approach is not tested: a constant is used instead." => "The polynomial 1 is used instead of the supplied quintic.";
        QuinticLowestFirst "pe-approach-lowest-first" [List(EdgeApproach, |list| list.reverse())]: "The approach's coefficients are in the wrong order." => "The constant coefficient comes first instead of that of t^5.";
        QuinticNoConstant "pe-approach-no-constant" [List(EdgeApproach, |list| list[5] = 0.0)]: "The approach's constant coefficient is overwritten with zero." => "1: the supplied quintic's last coefficient is 0.";
        QuinticCutToLinear "pe-approach-cut" [List(EdgeApproach, keep_last::<2>)]: "The approach is cut to its last terms." => "Only the coefficients of t and 1 are there; those of t^5 to t^2 are missing.";
        QuinticOldLetter "pe-approach-old-letter" [Letters(EdgeApproach, |letters, inputs| letters[3] = inputs.x21().dot(inputs.x21()))]: "The approach uses a letter of the overlap's formula, which means another dot product there." => "d = x21.x21 is used instead of the quintic's d = d21.d21.";
    }
    Wrong ParticleHalfPlane {
        HalfPlaneEmpty "ph-empty" [Lists(Vec::clear)]: "The detection is left empty: it never calls the root finder." => "No polynomial reaches the root finder; overlap (quadratic) and approach (linear) are expected for each pair.";
        HalfPlaneZero "ph-zero" [Lists(|lists| lists.iter_mut().for_each(|list| list.fill(0.0)))]:
            "The coefficients are left at zero."
            => "Every coefficient is 0.";
        HalfPlaneReversed "ph-reversed" [Lists(|lists| lists.iter_mut().for_each(|list| list.reverse()))]:
            "The coefficients are handed over lowest power first."
            =>
            "Polynomial takes the coefficient of the highest power first; here 1 comes first, then t.";
        HalfPlaneSwapped "ph-swapped" [Lists(|lists| lists.swap(0, 1))]:
            "The first two polynomials are handed over in the wrong order."
            =>
            "Polynomial 2 comes before polynomial 1.";
        HalfPlaneNoNormalSquare "ph-no-normal-square" [Named(&NO_NORMAL_SQUARE)]: "The radius term ignores the normal's length, which is right for unit normals only." => "1: r^2 is used instead of r^2 (n.n).";
        HalfPlaneNormalLength "ph-normal-length" [Named(&NORMAL_LENGTH)]: "The radius term has the normal's length instead of its square." => "1: r^2 |n| is used instead of r^2 (n.n).";
        HalfPlaneRadiusNotSquared "ph-radius-not-squared" [Named(&RADIUS_NOT_SQUARED)]: "The radius is not squared." => "1: r (n.n) is used instead of r^2 (n.n).";
        HalfPlaneNoRadius "ph-no-radius" [Named(&NO_RADIUS)]: "The radius is forgotten." => "1: r^2 (n.n) is missing.";
        HalfPlaneDiameter "ph-diameter" [Named(&DIAMETERS)]: "The diameter is used instead of the radius." => "1: (2 r)^2 (n.n) is used instead of r^2 (n.n).";
        HalfPlaneRadiusIndex "ph-radius-index": "The radius is read at the half-plane's number." => "radius[p] is used instead of radius[i], p being the half-plane.";
        HalfPlaneNoTwo "ph-no-two" [Weight(HalfPlaneOverlap, 1, &[0, 1], 0.5)]: "The linear coefficient of the overlap lacks a factor." => "t: ((p-x).n) (dx.n) is used instead of 2 ((p-x).n) (dx.n).";
        HalfPlaneLinearSign "ph-linear-sign" [Weight(HalfPlaneOverlap, 1, &[0, 1], -1.0)]: "The linear coefficient of the overlap has the wrong sign." => "t: -2 ((p-x).n) (dx.n) is used instead of 2 ((p-x).n) (dx.n).";
        HalfPlaneQuadraticSign "ph-quadratic-sign" [Weight(HalfPlaneOverlap, 2, &[0, 0], -1.0)]: "The quadratic coefficient of the overlap has the wrong sign." => "t^2: (dx.n)^2 is used instead of -(dx.n)^2.";
        HalfPlaneNoQuadratic "ph-no-quadratic" [Weight(HalfPlaneOverlap, 2, &[0, 0], 0.0)]: "The quadratic coefficient of the overlap is missing." => "t^2: 0 is used instead of -(dx.n)^2.";
        HalfPlaneConstantSign "ph-constant-sign" [Weight(HalfPlaneOverlap, 0, &[1, 1], -1.0)]: "The distance is added to the radius instead of subtracted." => "1: +((p-x).n)^2 is used instead of -((p-x).n)^2.";
        HalfPlaneOffsetNotSquared "ph-offset-not-squared" [Formula(HalfPlaneOverlap, offset_not_squared)]: "The constant coefficient has the distance instead of its square." => "1: -((p-x).n) is used instead of -((p-x).n)^2.";
        HalfPlaneOverlapNegated "ph-overlap-negated" [List(HalfPlaneOverlap, negate)]: "The overlap polynomial is negative where the particle overlaps." => "All three coefficients have the wrong sign.";
        HalfPlaneOverlapSigned "ph-overlap-signed" [Named(&SIGNED_DISTANCE)]: "The overlap is a signed distance, which is right on one side of the boundary only." => "-(dx.n) t + r |n| + (p-x).n is used instead of r^2 (n.n) - ((p-x).n - t (dx.n))^2.";
        HalfPlaneFirst "ph-first-half-plane": "The first half-plane is used instead of the pair's own." => "p and n of half-plane 0 are used instead of those of the pair's half-plane.";
        HalfPlanePositionIndex "ph-position-index": "Positions are read at the particle's number, although each particle has two coordinates." => "x[i] is used instead of x[2 i].";
        HalfPlaneNoPoint "ph-no-point" [Named(&NO_POINT)]: "The half-plane's point is forgotten, as if it went through the origin." => "-x is used instead of p - x.";
        HalfPlaneEndPosition "ph-end-position" [Named(&END_POSITIONS)]: "The formulas start from the position at the end of the step." => "x is taken from qe instead of qs.";
        HalfPlaneEndForDisplacement "ph-end-for-displacement" [Named(&END_FOR_DISPLACEMENT)]: "The end position is used instead of the displacement." => "dx = qe is used instead of dx = qe - qs.";
        HalfPlaneReversedOffset "ph-reversed-offset" [Named(&REVERSED_OFFSET)]: "The vector from the particle to the half-plane is taken the other way round." => "x - p is used instead of p - x.";
        HalfPlaneApproachNoSpeed "ph-approach-no-speed" [Named(&NO_SPEED_FACTOR)]: "The approach lacks a factor, so it is right on one side only." => "-(dx.n) t + ((p-x).n) lacks the factor (dx.n).";
        HalfPlaneApproachConstantNoSpeed "ph-approach-constant-no-speed" [Formula(HalfPlaneApproach, constant_without_speed)]: "The constant term of the approach lacks a factor." => "1: ((p-x).n) is used instead of ((p-x).n) (dx.n).";
        HalfPlaneApproachNegated "ph-approach-negated" [List(HalfPlaneApproach, negate)]: "The approach has the wrong sign, so only separating particles collide." => "(dx.n)^2 t - ((p-x).n) (dx.n) is used instead of -(dx.n)^2 t + ((p-x).n) (dx.n).";
        HalfPlaneApproachSlopeSign "ph-approach-slope-sign" [List(HalfPlaneApproach, negate_at::<0>)]: "The approach's slope has the wrong sign." => "t: (dx.n)^2 is used instead of -(dx.n)^2.";
        HalfPlaneApproachSlopeTwice "ph-approach-slope-twice" [List(HalfPlaneApproach, |list| list[0] *= 2.0)]: "The approach's slope has a factor that its constant term lacks." => "t: -2 (dx.n)^2 is used instead of -(dx.n)^2.";
        HalfPlaneApproachAtStart "ph-approach-at-start" [List(HalfPlaneApproach, keep_last::<1>)]: "The approach is tested at the start of the step only." => "The term -(dx.n)^2 t is missing; only ((p-x).n) (dx.n) is there.";
        HalfPlaneApproachSpeedOnly "ph-approach-speed-only" [Named(&SPEED_ONLY)]: "The approach uses only the velocity, not the side." => "The constant (dx.n) is used instead of -(dx.n)^2 t + ((p-x).n) (dx.n).";
        HalfPlaneApproachClosingOnly "ph-approach-closing-only" [Formula(HalfPlaneApproach, closing_only)]: "The approach uses only the velocity, as if the particle were always in front." => "The constant -(dx.n) is used instead of -(dx.n)^2 t + ((p-x).n) (dx.n).";
        HalfPlaneNoApproach "ph-no-approach" [List(HalfPlaneApproach, replace_by_one)]: "The approach is not tested: a constant is used instead." => "The polynomial 1 is used instead of -(dx.n)^2 t + ((p-x).n) (dx.n).";
    }
    Wrong Handover {
        HandoverLowestFirst "handover-lowest-first": "All coefficients are handed over lowest power first." => "Polynomial takes the coefficient of the highest power first; here 1 comes first, then t.";
        HandoverNegated "handover-negated": "All polynomials are handed over negated." => "Every coefficient is multiplied by -1.";
        HandoverSwapped "handover-swapped": "The first two polynomials of each pair are handed over in the wrong order." => "Polynomial 2 comes before polynomial 1.";
        HandoverAlphaSwapped "handover-alpha-swapped": "alpha > 0 and alpha < 1 are handed over in the wrong order." => "alpha < 1 comes before alpha > 0.";
        HandoverSinglePrecision "handover-single-precision": "The coefficients are stored as float before they are handed over." => "float holds 24 bits; double, with 53, is expected.";
        HandoverPositionOnly "handover-position-only": "Only the polynomials about position are handed over, not the approach." => "The last polynomial of each pair is missing.";
        HandoverApproachOnly "handover-approach-only": "Only the approach is handed over, nothing about position." => "Only the last polynomial of each pair is there.";
        HandoverMonic "handover-monic": "Each polynomial is divided by its leading coefficient, which turns the inequality round where that is negative." => "p / c is used instead of p, c being the leading coefficient; only a positive factor changes nothing.";
    }
    Wrong ContactVector {
        ParticleParticleContactAtStart "pp-contact-at-start": "The contact vector is taken at the start of the step." => "n = x2 - x1 is used instead of n = (x2 + t dx2) - (x1 + t dx1).";
        ParticleParticleContactAtEnd "pp-contact-at-end": "The contact vector is taken at the end of the step." => "n = (x2 + dx2) - (x1 + dx1) is used instead of n = (x2 + t dx2) - (x1 + t dx1).";
        ParticleParticleContactReversed "pp-contact-reversed": "The contact vector points from the second particle to the first." => "n = (x1 + t dx1) - (x2 + t dx2) is used instead of n = (x2 + t dx2) - (x1 + t dx1).";
        ParticleParticleContactFirstStill "pp-contact-first-still": "The contact vector forgets that the first particle moves." => "n = (x2 + t dx2) - x1 is used instead of n = (x2 + t dx2) - (x1 + t dx1).";
        ParticleParticleContactSecondStill "pp-contact-second-still": "The contact vector forgets that the second particle moves." => "n = x2 - (x1 + t dx1) is used instead of n = (x2 + t dx2) - (x1 + t dx1).";
        ParticleParticleContactFirstAtEnd "pp-contact-first-at-end": "The contact vector takes the first particle at the end of the step." => "n = (x2 + t dx2) - (x1 + dx1) is used instead of n = (x2 + t dx2) - (x1 + t dx1).";
        ParticleParticleContactSecondAtEnd "pp-contact-second-at-end": "The contact vector takes the second particle at the end of the step." => "n = (x2 + dx2) - (x1 + t dx1) is used instead of n = (x2 + t dx2) - (x1 + t dx1).";
        ParticleEdgeContactAtStart "pe-contact-at-start": "The contact vector is taken at the start of the step." => "t = 0 is used instead of the time of impact.";
        ParticleEdgeContactAtEnd "pe-contact-at-end": "The contact vector is taken at the end of the step." => "t = 1 is used instead of the time of impact.";
        ParticleEdgeContactAlphaAtStart "pe-contact-alpha-at-start": "The contact vector uses alpha at the start of the step." => "alpha(0) is used instead of alpha(t).";
        ParticleEdgeContactAlphaAtEnd "pe-contact-alpha-at-end": "The contact vector uses alpha at the end of the step." => "alpha(1) is used instead of alpha(t).";
        ParticleEdgeContactAlphaMiddle "pe-contact-alpha-middle": "The contact vector goes to the middle of the edge." => "1/2 is used instead of alpha(t).";
        ParticleEdgeContactFirstEnd "pe-contact-first-end": "The contact vector goes to the first endpoint." => "0 is used instead of alpha(t).";
        ParticleEdgeContactSecondEnd "pe-contact-second-end": "The contact vector goes to the second endpoint." => "1 is used instead of alpha(t).";
        ParticleEdgeContactFromOtherEnd "pe-contact-other-end": "alpha is measured from the second endpoint." => "1 - alpha(t) is used instead of alpha(t).";
        ParticleEdgeContactReversed "pe-contact-reversed": "The contact vector points from the edge to the particle." => "n is negated; expected is x2(t) + alpha (x3(t) - x2(t)) - x1(t).";
        ParticleEdgeContactParticleStill "pe-contact-particle-still": "The contact vector forgets that the particle moves." => "x1 is used instead of x1 + t dx1.";
        ParticleEdgeContactEdgeStill "pe-contact-edge-still": "The contact vector forgets that the edge moves." => "x2 and x3 are used instead of x2 + t dx2 and x3 + t dx3.";
        ParticleEdgeContactParticleAtEnd "pe-contact-particle-at-end": "The contact vector takes the particle at the end of the step." => "x1 + dx1 is used instead of x1 + t dx1.";
        ParticleEdgeContactEdgeAtEnd "pe-contact-edge-at-end": "The contact vector takes the edge at the end of the step." => "x2 + dx2 and x3 + dx3 are used instead of x2 + t dx2 and x3 + t dx3.";
        ParticleEdgeContactNearestEnd "pe-contact-nearest-end": "The contact vector goes to the nearer endpoint, not to the closest point of the edge." => "0 or 1, whichever is nearer, is used instead of alpha(t).";
        HalfPlaneContactUndivided "ph-contact-undivided": "The contact vector ignores the normal's length, which is right for unit normals only." => "((p - x(t)).n) n is used instead of ((p - x(t)).n) / (n.n) n.";
        HalfPlaneContactDividedByLength "ph-contact-divided-by-length": "The contact vector is divided by the normal's length, not by its square." => "((p - x(t)).n) / |n| n is used instead of ((p - x(t)).n) / (n.n) n.";
        HalfPlaneContactIsNormal "ph-contact-is-normal": "The half-plane's normal is returned as the contact vector." => "n is used instead of ((p - x(t)).n) / (n.n) n.";
        HalfPlaneContactReversed "ph-contact-reversed": "The contact vector points from the half-plane to the particle." => "(x(t) - p) is used instead of (p - x(t)).";
        HalfPlaneContactAtStart "ph-contact-at-start": "The contact vector is taken at the start of the step." => "x is used instead of x + t dx.";
        HalfPlaneContactAtEnd "ph-contact-at-end": "The contact vector is taken at the end of the step." => "x + dx is used instead of x + t dx.";
        HalfPlaneContactToPoint "ph-contact-to-point": "The contact vector goes to the half-plane's point, not to the closest one." => "p - x(t) is used instead of ((p - x(t)).n) / (n.n) n.";
        ContactUnitLength "contact-unit-length": "Contact vectors are normalized to unit length." => "n / |n| is returned instead of n.";
        ContactSingle "contact-float": "Contact vectors are stored as float." => "float holds 24 bits; double, with 53, is expected.";
        ContactNoise "contact-noise": "Contact vectors are wrong by a tiny part of their length." => "n is off by 1e-7 of its length.";
        ContactTimeZero "contact-time-zero": "The time of impact is always returned as zero." => "time = 0 is used instead of the root finder's result.";
        ContactTimeSingle "contact-time-float": "The time of impact is stored as float." => "float holds 24 bits; double, with 53, is expected.";
    }
    Wrong Decision {
        DecisionOpenEnd "decision-open-end": "An impact at the very end of the step does not count." => "time < 1 is tested instead of time <= 1.";
        DecisionOpenStart "decision-open-start": "An impact at the very start of the step does not count." => "0 < time is tested instead of 0 <= time.";
        DecisionOpenInterval "decision-open-interval": "The time interval is open at both ends." => "0 < time < 1 is tested instead of 0 <= time <= 1.";
        DecisionNoUpperBound "decision-no-upper-bound": "Any finite time of impact counts, also after the step." => "The test time <= 1 is missing.";
        DecisionSeconds "decision-seconds": "The time of impact is compared with the step size, as if it were in seconds." => "time <= dt is tested instead of time <= 1.";
        DecisionHalfStep "decision-half-step": "Only impacts in the first half of the step count." => "time <= 0.5 is tested instead of time <= 1.";
        DecisionTolerance "decision-tolerance": "An impact shortly after the end of the step counts, too." => "time <= 1 + 1e-6 is tested instead of time <= 1.";
        DecisionTruth "decision-truth": "The time of impact is used as a truth value: any time counts except the very start of the step." => "if (time) is tested instead of time <= 1: 0 is false, all other numbers and infinity are true.";
        DecisionNever "decision-never": "The root finder is called, but a collision is never reported." => "The detection returns false whatever the time is; time <= 1 decides.";
        DecisionOverlapAtEnd "decision-overlap-at-end": "A collision counts only if the objects still overlap at the end of the step." => "The distance at t = 1 is tested besides time <= 1.";
        DecisionOverlapAtStart "decision-overlap-at-start": "Objects that overlap at the start of the step are ignored." => "An impact at t = 0 is rejected where the objects overlap; time <= 1 decides alone.";
        DecisionAlphaAtStart "decision-alpha-at-start": "An impact is rejected if the closest point is not on the edge at the start of the step." => "0 <= alpha(0) <= 1 is tested besides time <= 1.";
        DecisionAlphaAtEnd "decision-alpha-at-end": "An impact is rejected if the closest point is not on the edge at the end of the step." => "0 <= alpha(1) <= 1 is tested besides time <= 1.";
        DecisionAlphaMargin "decision-alpha-margin": "Impacts close to the edge's ends are rejected." => "0.05 <= alpha(t) <= 0.95 is tested besides time <= 1.";
        DecisionApproachMargin "decision-approach-margin": "Objects that approach each other very slowly are ignored." => "(dx1 - dx2).n > 1e-6 is tested besides time <= 1.";
        DecisionHalfPlaneOneSided "decision-half-plane-one-sided": "A half-plane stops particles only on the side that its normal points away from." => "(x - p).n >= 0 rejects the impact; time <= 1 decides alone.";
        DecisionFixedEdges "decision-fixed-edges": "Edges with two fixed ends never collide." => "isFixed(j) && isFixed(k) rejects the impact; time <= 1 decides alone.";
        ParticleParticlePrediction "pp-detects-prediction": "Every round detects on the integrator's prediction, for pairs of particles only." => "scene.getX() is used instead of qe.";
        ParticleEdgePrediction "pe-detects-prediction": "Every round detects on the integrator's prediction, for pairs of a particle and an edge only." => "scene.getX() is used instead of qe.";
        HalfPlanePrediction "ph-detects-prediction": "Every round detects on the integrator's prediction, for half-planes only." => "scene.getX() is used instead of qe.";
        PairsBothOrders "pairs-both-orders": "Each pair of particles is tested twice." => "The inner loop begins at j = 0; it begins at j = i + 1.";
        PairsNeighborsOnly "pairs-neighbors-only": "A particle is tested only against the next one in the list." => "The inner loop ends at j = i + 1; it runs to the last particle.";
        PairsEndpointsToo "pairs-endpoints-too": "Edges are tested against their own endpoints." => "The test i != edge.first && i != edge.second is missing.";
        PairsFixedSkipped "pairs-fixed-skipped": "Pairs of fixed objects are skipped, so their polynomials are missing." => "isFixed(i) && isFixed(j) leaves a pair out; every pair is tested.";
        PairsFixedEdgesSkipped "pairs-fixed-edges-skipped": "Edges whose ends are both fixed are skipped, so their polynomials are missing." => "isFixed(j) && isFixed(k) leaves a pair out; every pair is tested.";
        PairsConnectedSkipped "pairs-connected-skipped": "Two particles that an edge connects are not tested against each other, so their polynomials are missing." => "A test for an edge between i and j leaves the pair out; every pair is tested.";
        PairsPruned "pairs-pruned": "Distant particles are skipped by their bounding circles, so their polynomials are missing." => "|x21| > r1 + r2 + |dx1| + |dx2| leaves a pair out; every pair is tested.";
        PairsFirstHalfPlaneOnly "pairs-first-half-plane-only": "Only the first half-plane is tested." => "The loop over half-planes ends after index 0.";
        PairsHalfPlanesFirst "pairs-half-planes-first": "Half-planes are tested before everything else." => "The order is, per particle: particles j > i, edges, half-planes.";
    }
    Wrong Response {
        ResponseSign "response-sign": "The impulse pulls the objects together." => "The impulse is added with the wrong sign: -I is used instead of I.";
        ResponseHalved "response-halved": "The impulse lacks a factor." => "(1 + COR) / 2 is used instead of 2 (1 + COR) / 2.";
        ResponseNoRestitution "response-no-restitution": "The coefficient of restitution is taken as for elastic collisions." => "COR = 1 is used instead of the scene's COR.";
        ResponseInelastic "response-inelastic": "The coefficient of restitution is taken as zero." => "COR = 0 is used instead of the scene's COR.";
        ResponseRestitutionOnly "response-restitution-only": "The coefficient of restitution is used instead of its mean with one." => "COR / 2 is used instead of (1 + COR) / 2.";
        ResponseNotNormalized "response-not-normalized": "The impulse uses the contact vector without normalizing it." => "n is used instead of n / |n|.";
        ResponseEndVelocity "response-end-velocity": "The impulse uses the velocity at the end of the step, not the mean velocity of the motion." => "v is used instead of (qe - qs) / dt.";
        ResponseVelocitiesOnly "response-velocities-only": "Only velocities change, not positions." => "q += dt I / m is missing.";
        ResponsePositionsOnly "response-positions-only": "Only positions change, not velocities." => "v += I / m is missing.";
        ResponsePositionNoStep "response-position-no-step": "The change of position is not multiplied by the step size." => "q += I / m is used instead of q += dt I / m.";
        ResponseMassesSwapped "response-masses-swapped": "The masses of two particles are exchanged." => "m1 and m2 are exchanged.";
        ResponseEqualMasses "response-equal-masses": "The impulse between two particles ignores their masses." => "m1 = m2 = 1 is used instead of the particles' masses.";
        ResponseFixedMassFinite "response-fixed-mass-finite": "A fixed particle counts with its own mass, not as infinitely heavy." => "m is used instead of infinity for a fixed particle.";
        ResponseMovesFixed "response-moves-fixed": "Fixed particles are moved." => "The test !isFixed(i) is missing.";
        ResponseFirstOnly "response-first-only": "Only the first object of a pair is pushed." => "v2 -= I / m2 is missing.";
        ResponseEdgeAtStart "response-edge-at-start": "The point of the edge that is pushed is computed at the start of the step." => "alpha(0) is used instead of alpha(t) in the response.";
        ResponseEdgeMiddle "response-edge-middle": "The impulse is shared equally between the edge's endpoints." => "alpha = 1/2 is used instead of alpha(t) in the response.";
        ResponseEdgeSwapped "response-edge-swapped": "The endpoints' shares of the impulse are exchanged." => "alpha and 1 - alpha are exchanged.";
        ResponseEdgeStill "response-edge-still": "The edge's own velocity is forgotten." => "-v1 is used instead of v2 + alpha (v3 - v2) - v1.";
        ResponseOneEndpoint "response-one-endpoint": "The second endpoint of the edge is not pushed." => "v3 -= alpha I / m3 is missing.";
        ResponseHalfPlaneHalved "response-half-plane-halved": "The impulse of a half-plane is half of what it should be." => "(1 + COR) / 2 is used instead of 2 (1 + COR) / 2.";
        ResponseHalfPlaneSparesFixed "response-half-plane-spares-fixed": "Half-planes let fixed particles pass, unlike the course's program." => "The response to a half-plane is inside if (!isFixed(i)).";
        ResponseSinglePrecision "response-float": "The size of the impulse is stored as float." => "float holds 24 bits; double, with 53, is expected.";
    }
    Wrong ContinuousTime {
        ContinuousDetectAllFirst "ct-detect-all-first": "All pairs are detected before the first is resolved." => "Each pair is resolved as soon as it is detected, before pair i + 1.";
        ContinuousOldPrediction "ct-old-prediction": "Later pairs do not see the positions that earlier impulses left." => "Each detection gets a copy of qe from before the loop instead of the current qe.";
        ContinuousFirstOnly "ct-first-only": "Only the first collision of a step is resolved." => "The loop over the pairs ends after 1 collision.";
        ContinuousTwoPasses "ct-two-passes": "The detection runs twice per step." => "2 passes over the pairs are made instead of 1.";
        ContinuousNoResponse "ct-no-response": "Collisions are logged, but not resolved." => "v += I / m and q += dt I / m are missing.";
    }
    Wrong ImpulseLoop {
        ImpulsesEmpty "loop-empty": "The loop is left empty: it reports failure immediately." => "return false is used instead of maxiters rounds of detection and impulses.";
        ImpulsesEmptySuccess "loop-empty-succeeds": "The loop is left empty: it reports success immediately, so the geometric part never runs." => "return true is used instead of maxiters rounds of detection and impulses.";
        ImpulsesOneFewer "loop-one-fewer": "The loop makes one round fewer than maxiters allows." => "maxiters - 1 rounds are made instead of maxiters.";
        ImpulsesOneMore "loop-one-more": "The loop makes one round more than maxiters allows." => "maxiters + 1 rounds are made instead of maxiters.";
        ImpulsesOnlyOne "loop-only-one": "The loop makes one round only, whatever maxiters says." => "1 round is made instead of maxiters.";
        ImpulsesAlwaysTen "loop-always-ten": "The loop makes a fixed number of rounds, whatever maxiters says." => "10 rounds are made instead of maxiters.";
        ImpulsesDouble "loop-double": "The loop makes twice as many rounds as maxiters allows." => "2 maxiters rounds are made instead of maxiters.";
        ImpulsesCountContacts "loop-counts-contacts": "Contacts are counted against maxiters, not rounds." => "i += collisions.size() is used instead of i += 1.";
        ImpulsesDetectAfterLast "loop-detects-after-last": "A pass after the last round decides whether it succeeded." => "Round maxiters + 1 detects once more; after maxiters rounds with collisions the loop fails without another pass.";
        ImpulsesDetectBefore "loop-detects-before": "A detection pass is made before the first round, too, whatever maxiters is." => "detectCollisions runs maxiters + 1 times at most; it runs maxiters times at most.";
        ImpulsesTestBefore "loop-tests-before": "A detection pass is made before the first round, too, and ends the loop with success when it finds nothing." => "detectCollisions runs before round 1; the pass of round 1 is the first, and with maxiters = 0 there is none.";
        ImpulsesPassWhenZero "loop-pass-when-zero": "A detection pass is made although maxiters is zero." => "With maxiters = 0 there is no pass at all in the loop.";
        ImpulsesTestWhenZero "loop-test-when-zero": "With maxiters at zero the loop looks for collisions and reports success when it finds none." => "With maxiters = 0 the loop makes no pass and returns false.";
        ImpulsesSuccessWhenZero "loop-success-when-zero": "With maxiters at zero the loop reports success, so the geometric part never runs." => "With maxiters = 0 the loop returns false.";
        ImpulsesOnceWhenZero "loop-once-when-zero": "With maxiters at zero, one round still runs." => "With maxiters = 0 there are 0 rounds; do ... while makes 1.";
        ImpulsesAlwaysFail "loop-always-fails": "The loop reports failure even when nothing collides any more." => "return false is used instead of return true when a pass finds nothing.";
        ImpulsesAlwaysSucceed "loop-always-succeeds": "The loop reports success even when it has run out of rounds." => "return true is used instead of return false after maxiters rounds with collisions.";
        ImpulsesOneLeftSucceeds "loop-one-left-succeeds": "The loop reports success when its last round had a single collision." => "return collisions.size() <= 1 is used instead of return false after maxiters rounds with collisions.";
        ImpulsesInverted "loop-inverted": "Success and failure are exchanged." => "return true and return false are exchanged.";
        ImpulsesFromPrediction "loop-from-prediction": "Every round computes its impulses from the integrator's prediction, not from the last round's result." => "applyImpulses gets qe and qdote instead of the last round's qm and qdotm.";
        ImpulsesPredictedVelocities "loop-predicted-velocities": "Every round adds its impulses to the predicted velocities, which drops those of the rounds before." => "qdote is used instead of qdotm, the loop's own velocities.";
        ImpulsesResultNotAccumulated "loop-not-accumulated": "Every round applies its impulses to the integrator's prediction, which drops the rounds before." => "qm = qe + impulses is used instead of qm += impulses.";
        ImpulsesAnew "loop-anew": "Every round starts anew from the integrator's prediction: its impulses are computed from it and applied to it." => "qm = qe + impulses(qe, qdote) is used instead of qm += impulses(qm, qdotm).";
        ImpulsesOneByOne "loop-one-by-one": "Each impulse of a round is computed from the positions that the one before left." => "The round's start (qe, qdote) is to be kept while all impulses of the round are computed.";
        ImpulsesLastWins "loop-last-wins": "The impulses of a round overwrite one another instead of adding up." => "qm = qe + I_k is used instead of qm = qe + I_1 + I_2 + ....";
        ImpulsesFirstOnly "loop-first-only": "Only the first collision of a round is resolved." => "collisions[0] is used instead of all collisions.";
        ImpulsesLastOnly "loop-last-only": "Only the last collision of a round is resolved." => "collisions.back() is used instead of all collisions.";
        ImpulsesFirstSkipped "loop-first-skipped": "The first collision of a round is left out." => "The loop over the collisions begins at index 1.";
        ImpulsesLastSkipped "loop-last-skipped": "The last collision of a round is left out." => "The loop over the collisions ends at size() - 1.";
        ImpulsesListKept "loop-list-kept": "The list of collisions is never emptied, so that every round resolves those of the rounds before again." => "collisions.clear() is missing before detectCollisions.";
        ImpulsesDetectPrediction "loop-detects-prediction": "Every round detects on the integrator's prediction, not on the positions that the last round left." => "detectCollisions(qs, qe) is used instead of detectCollisions(qs, qm).";
        ImpulsesStartAdvances "loop-start-advances": "Later rounds detect from the last round's positions, not from the start of the step." => "detectCollisions(qe_i, qe_i+1) is used instead of detectCollisions(qs, qe_i+1).";
        ImpulsesStartFollows "loop-start-follows": "Later rounds detect from where the round before detected to, not from the start of the step." => "detectCollisions(qe_i-1, qe_i) is used instead of detectCollisions(qs, qe_i).";
        ImpulsesFromEnd "loop-from-end": "Impulses are computed as if the step began where it ends, so that contacts change nothing." => "applyImpulses(qe, qe, ...) is used instead of applyImpulses(qs, qe, ...).";
        ImpulsesPositionsFromVelocities "loop-positions-from-velocities": "After a round positions are computed anew from the velocities." => "qm = qs + dt qdotm is used instead of qm += dt I / m.";
        ImpulsesSameCountFails "loop-same-count-fails": "The loop gives up when a round finds as many contacts as the one before." => "return false comes before round maxiters is over.";
        ImpulsesCapped "loop-capped": "Changes of velocity are capped." => "min(|dv|, 0.5) is used instead of |dv|.";
        ImpulsesReset "loop-reset": "When the rounds run out, positions and velocities are reset to the prediction." => "qefinal = qe and qdotefinal = qdote are used instead of the last round's result.";
        ImpulsesVelocityRestored "loop-velocity-restored": "The loop keeps its positions but restores the predicted velocities." => "qdotefinal = qdote is used instead of the last round's velocities.";
        ImpulsesPositionsRestored "loop-positions-restored": "The loop keeps its velocities but restores the predicted positions." => "qefinal = qe is used instead of the last round's positions.";
    }
    Wrong ImpactZones {
        GeometricEmpty "geometric-empty": "The geometric part is left empty." => "Steps 1 to 9 of section 3.6 are missing: the result is qm = qe, without a detection pass.";
        GeometricOneRound "geometric-one-round": "Zones never grow: the loop ends after the first round." => "Steps 5 to 9 of section 3.6 are missing.";
        GeometricFindsInVain "geometric-finds-in-vain": "Zones never grow: what the pass after the first round finds is ignored." => "Steps 6 to 9 of section 3.6 are missing: nothing follows from step 5.";
        GeometricTwoRounds "geometric-two-rounds": "Zones grow only once." => "Step 9 of section 3.6 runs 1 time; it runs until Z = Z'.";
        GeometricRestarts "geometric-restarts": "Every round starts again from the predicted positions." => "qm = qe is inside the loop; it must come before the loop.";
        GeometricDetectsPrediction "geometric-detects-prediction": "Later passes use the predicted positions instead of the modified ones." => "detectCollisions(qs, qe) is used instead of detectCollisions(qs, qm).";
        GeometricForgetsZones "geometric-forgets-zones": "New zones replace the old ones instead of joining them." => "Z' holds the new zones only; it must also hold Z.";
        GeometricStopsWhenEmpty "geometric-stops-when-empty": "Without zones the second pass is left out." => "The loop ends before step 5 when Z is empty; detectCollisions(qs, qm) must still run.";
        GeometricExtraPass "geometric-extra-pass": "One more detection pass is made after the zones have settled." => "detectCollisions runs once more after Z = Z'.";
        GeometricFirstZoneOnly "geometric-first-zone-only": "Only the first zone is moved." => "performFailsafe(Z[0]) is used instead of all zones of Z.";
        GeometricLastZoneOnly "geometric-last-zone-only": "Only the last zone is moved." => "performFailsafe(Z.back()) is used instead of all zones of Z.";
        GeometricFirstZoneSkipped "geometric-first-zone-skipped": "The first zone is not moved." => "The loop over the zones begins at index 1.";
        GeometricLastZoneSkipped "geometric-last-zone-skipped": "The last zone is not moved." => "The loop over the zones ends at size() - 1.";
        GeometricMovesPrediction "geometric-moves-prediction": "The geometric part moves what the integrator predicted, not what the impulse rounds left." => "qm = qe of the integrator is used instead of qm = qe of the impulse rounds.";
        GeometricNewZonesOnly "geometric-new-zones-only": "Zones that a round leaves as they were are not moved again." => "performFailsafe runs for zones of Z' that are not in Z; it runs for all of Z'.";
        GeometricGrownStay "geometric-grown-stay": "Zones that have grown are not moved again." => "performFailsafe runs for zones without a particle that was moved before; it runs for all of Z'.";
        GeometricVelocitiesKept "geometric-velocities-kept": "The velocities that zones get are not taken over." => "qdotm = qdote of the impulse rounds is used instead of the zones' own velocities.";
        ZonesOneEndpoint "zones-one-endpoint": "A zone of a particle and an edge holds only one of the endpoints." => "{i, j} is used instead of {i, j, k}.";
        ZonesOtherEndpoint "zones-other-endpoint": "A zone of a particle and an edge holds the second endpoint only, not the first." => "{i, k} is used instead of {i, j, k}.";
        ZonesNextParticle "zones-next-particle": "A zone of a particle and an edge holds the first endpoint and the particle behind it in the list, as if that were the second one." => "{i, j, j + 1} is used instead of {i, j, k}.";
        ZonesFlagOfEdges "zones-flag-of-edges": "Collisions with edges set the half-plane flag, too." => "halfplane = true is used instead of false for a collision with an edge; a break is missing.";
        ZonesEdgeIndex "zones-edge-index": "A zone of a particle and an edge holds the edge's index, as if it were a particle's." => "{i, e} is used instead of {i, first(e), second(e)}.";
        ZonesEdgeWithoutParticle "zones-edge-without-particle": "A zone of a particle and an edge lacks the particle." => "{j, k} is used instead of {i, j, k}.";
        ZonesNotMerged "zones-not-merged": "Zones that share particles are not merged." => "Step 2 of the merging in section 3.6 is missing.";
        ZonesMergedOnce "zones-merged-once": "Zones are merged in one sweep, which may leave some that share particles." => "Step 3 of the merging in section 3.6 is missing: repeat until all zones are disjoint.";
        ZonesAllInOne "zones-all-in-one": "All colliding particles become one zone." => "One zone is made of all collisions; only zones that share a particle are merged.";
        ZonesJoinOneParticle "zones-join-one-particle": "Merging takes over only one particle of the second zone." => "The union of both sets of particles is expected.";
        ZonesJoinTwoShared "zones-join-two-shared": "Zones are merged only if they share two particles." => "The test asks for 2 shared particles; 1 is enough.";
        ZonesNoHalfPlaneFlag "zones-no-flag": "The half-plane flag is never set." => "halfplane = false is used instead of true for a collision with a half-plane.";
        ZonesFlagLost "zones-flag-lost": "Merging keeps the first zone's half-plane flag and loses the second's." => "h1 is used instead of h1 || h2.";
        ZonesFlagOverwritten "zones-flag-overwritten": "Merging overwrites the half-plane flag with the second zone's." => "h2 is used instead of h1 || h2.";
        ZonesFlagBoth "zones-flag-both": "A merged zone keeps the half-plane flag only if both had it." => "h1 && h2 is used instead of h1 || h2.";
        ZonesEqualByCount "zones-equal-by-count": "Two lists of zones count as equal when they are equally long." => "Z.size() == Z'.size() is used instead of Z = Z'.";
        ZonesEqualBySize "zones-equal-by-size": "Two zones count as equal when they hold equally many particles." => "Sizes are compared instead of the sets of particles.";
        ZonesEqualNoFlag "zones-equal-no-flag": "The comparison of zones ignores the half-plane flag." => "h == h' is missing in the comparison of two zones.";
    }
    Wrong Failsafe {
        FailsafeEmpty "failsafe-empty": "The failsafe is left empty." => "x and v of the zone do not change; expected are x = x_cm + dx_cm + R (xs - x_cm) and v = (x - xs) / dt.";
        FailsafeUnweighted "failsafe-unweighted": "All masses are left out." => "m is missing in all four sums: x_cm, dx_cm, L and I.";
        FailsafeMeansUnweighted "failsafe-means-unweighted": "Neither the center of mass nor its motion is weighted with the masses." => "sum(xs) / N and sum(dx) / N are used instead of sum(m xs) / sum(m) and sum(m dx) / sum(m).";
        FailsafeCenterUnweighted "failsafe-center-unweighted": "The center of mass is not weighted with the masses." => "sum(xs) / N is used instead of sum(m xs) / sum(m).";
        FailsafeCenterAtEnd "failsafe-center-at-end": "The center of mass is taken at the end of the step." => "sum(m xe) / sum(m) is used instead of sum(m xs) / sum(m).";
        FailsafeNoCenter "failsafe-no-center": "The center of mass is not added back." => "dx_cm + R (xs - x_cm) lacks x_cm.";
        FailsafeMomentumUnweighted "failsafe-momentum-unweighted": "The momentum is not weighted with the masses." => "sum(dx) / N is used instead of sum(m dx) / sum(m).";
        FailsafeMomentumVelocity "failsafe-momentum-velocity": "The momentum is computed from velocities instead of displacements." => "sum(m v) is used instead of sum(m dx).";
        FailsafeAngularVelocity "failsafe-angular-velocity": "The angular momentum is computed from velocities instead of displacements." => "L = sum(m (xs - x_cm) x v) is used instead of L = sum(m (xs - x_cm) x (dx - dx_cm)).";
        FailsafeNoTranslation "failsafe-no-translation": "The center of mass does not move." => "dx_cm is missing in x_cm + dx_cm + R (xs - x_cm).";
        FailsafeShiftTwice "failsafe-shift-twice": "The center of mass moves twice as far as it should." => "x_cm + 2 dx_cm + R (xs - x_cm) is used instead of x_cm + dx_cm + R (xs - x_cm).";
        FailsafeRange "failsafe-range": "All particles between a zone's first and last one in the list are moved with it." => "The loop runs from the smallest to the largest number of Z, not over its members.";
        FailsafeAngularUnweighted "failsafe-angular-unweighted": "The angular momentum is not weighted with the masses." => "m is missing in L = sum(m (xs - x_cm) x (dx - dx_cm)).";
        FailsafeAngularOverwritten "failsafe-angular-overwritten": "The angular momentum is overwritten instead of summed." => "L = ... is used instead of L += ....";
        FailsafeAngularDoubled "failsafe-angular-doubled": "The angular momentum is overwritten, then doubled." => "L = ...; L += L is used instead of L += ...";
        FailsafeCrossSum "failsafe-cross-sum": "The cross product adds its two products." => "a d + b c is used instead of a d - b c.";
        FailsafeDotProduct "failsafe-dot-product": "A dot product is used instead of the cross product." => "a c + b d is used instead of a d - b c.";
        FailsafeAboutOrigin "failsafe-about-origin": "The rotation is taken about the origin, not about the center of mass." => "xs is used instead of xs - x_cm in the angular momentum and the moment of inertia.";
        FailsafeInertiaUnweighted "failsafe-inertia-unweighted": "The moment of inertia is not weighted with the masses." => "m is missing in I = sum(m |xs - x_cm|^2).";
        FailsafeInertiaDistance "failsafe-inertia-distance": "The moment of inertia has distances that are not squared." => "m |xs - x_cm| is used instead of m |xs - x_cm|^2.";
        FailsafeInertiaAboutOrigin "failsafe-inertia-about-origin": "The moment of inertia is taken about the origin." => "m |xs|^2 is used instead of m |xs - x_cm|^2.";
        FailsafeInertiaAtEnd "failsafe-inertia-at-end": "The moment of inertia is taken at the end of the step." => "m |xe - x_cm - dx_cm|^2 is used instead of m |xs - x_cm|^2.";
        FailsafeNoInertia "failsafe-no-inertia": "The angular momentum is not divided by the moment of inertia." => "w = L is used instead of w = L / I.";
        FailsafeRotationSign "failsafe-rotation-sign": "The body turns the wrong way." => "-w is used instead of w.";
        FailsafeNoRotation "failsafe-no-rotation": "The body does not turn." => "w = 0 is used instead of w = L / I.";
        FailsafeSmallAngle "failsafe-small-angle": "Sine and cosine are replaced by their values for small angles." => "1 and w are used instead of cos(w) and sin(w).";
        FailsafeSeries "failsafe-series": "Sine and cosine are replaced by the first terms of their series." => "1 - w^2 / 2 and w - w^3 / 6 are used instead of cos(w) and sin(w).";
        FailsafeTinyTurnIgnored "failsafe-tiny-turn-ignored": "Small angles are treated as no turn at all." => "|w| < 1e-3 is treated as w = 0.";
        FailsafeUnturnedUnmoved "failsafe-unturned-unmoved": "A zone that does not turn is not moved at all." => "if (L == 0) return; comes before x = x_cm + dx_cm + R (xs - x_cm).";
        FailsafeMassInteger "failsafe-mass-integer": "The total mass is summed as an integer, which cuts fractions off." => "int M is used instead of double M = sum(m).";
        FailsafeAngularInteger "failsafe-angular-integer": "The angular momentum is summed as an integer, which cuts fractions off." => "int L is used instead of double L = sum(m (xs - x_cm) x (dx - dx_cm)).";
        FailsafeInertiaInteger "failsafe-inertia-integer": "The moment of inertia is summed as an integer, which cuts fractions off." => "int I is used instead of double I = sum(m |xs - x_cm|^2).";
        FailsafeSumsSingle "failsafe-float-sums": "Mass, angular momentum and moment of inertia are summed as float." => "float M, L and I are used instead of double.";
        FailsafeDegrees "failsafe-degrees": "The angle is converted to degrees before sine and cosine." => "cos(w 180 / pi) is used instead of cos(w), and likewise sin.";
        FailsafeAnglePerStep "failsafe-angle-per-step": "The angle is multiplied by the step size once too often." => "w dt is used instead of w.";
        FailsafePerpendicular "failsafe-perpendicular": "The perpendicular vector has its components exchanged without a change of sign." => "(b, a) is used instead of (-b, a).";
        FailsafeCosineSine "failsafe-cos-sin": "Sine and cosine are exchanged." => "sin(w) and cos(w) are exchanged.";
        FailsafeTurnsEnd "failsafe-turns-end": "The predicted end positions are turned, not the start positions." => "xe - x_cm - dx_cm is used instead of xs - x_cm.";
        FailsafeMassIndex "failsafe-mass-index": "The mass is read at the particle's index, although the array holds every mass twice." => "m[i] is used instead of m[2 i].";
        FailsafeMassCounter "failsafe-mass-counter": "The masses are read in the order of the zone, not of its particles." => "m[2 k] is used instead of m[2 i], i being the k-th particle of the zone.";
        FailsafeFixedForgotten "failsafe-fixed-forgotten": "The rule for fixed particles is forgotten." => "A zone with a fixed particle is to get x = xs and v = 0.";
        FailsafeHalfPlaneForgotten "failsafe-half-plane-forgotten": "The rule for half-planes is forgotten." => "A zone with the half-plane flag is to get x = xs and v = 0.";
        FailsafeAllFixedOnly "failsafe-all-fixed-only": "A zone stops only if all of its particles are fixed." => "One fixed particle is enough for x = xs and v = 0.";
        FailsafeAlwaysStops "failsafe-always-stops": "Every zone stops, even if nothing in it is fixed." => "x = xs and v = 0 hold for zones with something fixed only.";
        FailsafeStopsFixedOnly "failsafe-stops-fixed-only": "In a zone that has to stop, only the fixed particles do." => "x = xs and v = 0 hold for all particles of the zone.";
        FailsafeStopKeepsPosition "failsafe-stop-keeps-position": "A stopped zone loses its velocity but keeps its end positions." => "x = xs is missing beside v = 0.";
        FailsafeStopKeepsVelocity "failsafe-stop-keeps-velocity": "A stopped zone goes back to its start but keeps its velocity." => "v = 0 is missing beside x = xs.";
        FailsafeVelocityKept "failsafe-velocity-kept": "A moved zone keeps its old velocities." => "v = (x - xs) / dt is missing.";
        FailsafeVelocityAdded "failsafe-velocity-added": "The new velocity is added to the old one." => "v += (x - xs) / dt is used instead of v = (x - xs) / dt.";
        FailsafeVelocityNoStep "failsafe-velocity-no-step": "The new velocity is not divided by the step size." => "v = x - xs is used instead of v = (x - xs) / dt.";
        FailsafeVelocityFromPrediction "failsafe-velocity-from-prediction": "The new velocity is measured from the predicted position." => "v = (x - xe) / dt is used instead of v = (x - xs) / dt.";
        FailsafeVelocityOfCenter "failsafe-velocity-of-center": "All particles of a zone get the velocity of its center." => "v = dx_cm / dt is used instead of v = (x - xs) / dt.";
    }
    Wrong Trace {
        LogLowestFirst "log-lowest-first": "The logged coefficients are lowest power first." => "The coefficient of the highest power comes first.";
        LogNegated "log-negated": "The logged coefficients are negated." => "Every logged coefficient is multiplied by -1.";
        LogNan "log-nan": "All logged coefficients are not a number." => "Every coefficient is NaN.";
        LogTiny "log-tiny": "All logged coefficients are the same number." => "Every coefficient is 1e-11.";
        LogSwapped "log-swapped": "Each two neighboring polynomials are logged in the wrong order." => "Polynomial 2 comes before polynomial 1, 4 before 3, and so on.";
        LogTrailingZero "log-trailing-zero": "Every logged polynomial has a zero too many at the end." => "A 0 after the constant coefficient multiplies the polynomial by t.";
        LogRounded "log-rounded": "Logged coefficients are rounded to a few digits." => "6 digits are written instead of all 17.";
        LogPolynomialsKept "log-polynomials-kept": "The list of polynomials is never emptied." => "Each record repeats the polynomials of steps 1, 2, ... before its own.";
        LogImpulsesKept "log-impulses-kept": "The list of impulses is never emptied." => "Each record repeats the impulses of steps 1, 2, ... before its own.";
        LogNoImpulses "log-no-impulses": "Impulses are applied but not logged." => "The impulse list has 0 entries.";
        LogDuplicateImpulses "log-duplicate-impulses": "Every impulse is logged twice." => "The impulse list holds each entry 2 times.";
        LogNanContacts "log-nan-contacts": "The logged contact vectors are not numbers." => "Every entry has n = (NaN, NaN).";
        LogHybridImpulses "log-hybrid-impulses": "The impulse rounds of hybrid scenes log impulses, which the course's program does not." => "The impulse list has 0 entries in hybrid scenes.";
        LogMidIsEnd "log-mid-is-end": "The record in the middle of a step already holds its end." => "Record 2 of each step equals record 1; the first must be taken before the geometric part.";
        LogNoMid "log-no-mid": "The record in the middle of a step is missing." => "1 record per step is written instead of 2.";
        LogNoInitial "log-no-initial": "The initial record is missing." => "Record 0, the state before the first step, must come first.";
        LogSinglePrecision "log-single-precision": "Positions or velocities are kept or logged as float." => "float holds 24 bits; double, with 53, is expected.";
        LogPadded "log-padded": "Every logged polynomial has a leading zero, which the course's library never writes." => "Leading coefficients below 1e-12 are dropped before logging.";
    }
    Variant Handover {
        ScaleTwo "scale-2": "All polynomials carry the same positive factor." => "Every coefficient is multiplied by 2.";
        ScaleHalf "scale-half": "All polynomials carry the same positive factor below one." => "Every coefficient is multiplied by 0.5.";
        ScaleThree "scale-3": "All polynomials carry the same positive factor, which rounds." => "Every coefficient is multiplied by 3.";
        ScaleThousand "scale-1000": "All polynomials carry the same large factor." => "Every coefficient is multiplied by 1000.";
        ScaleMillionth "scale-1e-6": "All polynomials carry a small factor, so the course's root finder drops more of their small coefficients." => "Every coefficient is multiplied by 1e-6.";
        ScaleParticleParticleTwo "scale-pp-2": "Particle-particle polynomials carry a positive factor." => "Every coefficient is multiplied by 2.";
        ScaleParticleEdgeThree "scale-pe-3": "Particle-edge polynomials carry a positive factor." => "Every coefficient is multiplied by 3.";
        ScaleHalfPlaneThree "scale-ph-3": "Particle-half-plane polynomials carry a positive factor." => "Every coefficient is multiplied by 3.";
        NormalizedLargest "normalized-largest": "Every polynomial is divided by its largest coefficient." => "p / max |c| is used instead of p.";
        NormalizedNorm "normalized-norm": "Every polynomial is divided by the norm of its coefficients." => "p / |p| is used instead of p.";
        NormalizedPerPair "normalized-per-pair": "Each pair's polynomials are divided by a number of its own." => "The squared motion, (dx.n)^2, or the edge's squared length.";
        ThroughBernstein "through-bernstein": "All polynomials are written in Bernstein's basis and back." => "b_i of the degree's Bernstein polynomials on [0, 1].";
        InterpolatedAll "interpolated-all": "All polynomials but the supplied approach are interpolated from values within the step." => "t = 0, 1/4, 1/2, ...";
        FrameShifted "frame-shifted": "Detection computes with another origin." => "x - o is used instead of x.";
        FrameComoving "frame-comoving": "Detection computes in coordinates that move along with the first particle." => "x - x1 - t dx1 is used instead of x.";
        FrameRotated "frame-rotated": "Detection computes in coordinates that are turned by an angle." => "R x is used instead of x.";
        ExtendedPrecision "extended-precision": "Detection computes with extended precision, from the polynomials to the contact vectors." => "106 bits for 53.";
        FusedArithmetic "fused-arithmetic": "The compiler fuses multiplications with additions everywhere, as fast arithmetic does." => "fma(a, b, c) for a b + c, as with -Ofast.";
    }
    Variant ParticleParticle {
        RearrangedParticleParticle "rearranged-pp": "The overlap is multiplied out into coordinates; the relative velocity is the negative of the relative displacement." => "-(dy dy + dx dx) t^2 + (2 px dx + 2 py dy) t + R R - px px - py py.";
    }
    Variant ParticleEdge {
        RearrangedParticleEdge "rearranged-pe": "The overlap's terms are put into other parentheses." => "For example 2 (b c - (e i + h f)) for 2 b c - 2 e i - 2 f h.";
        FactorizedQuartic "factorized-quartic": "The overlap comes from the cross product of edge and offset." => "R^2 e.e - (e x w)^2, with e = x3 - x2 and w = x1 - x2.";
        FactorizedAll "factorized-all": "All polynomials of particle and edge come from three quadratics, the approach mathematically right." => "R^2 g - q^2, a, g - a and -q (2 q' g - q g') / 2.";
        InterpolatedQuartic "interpolated-quartic": "The overlap is interpolated from its values at five times." => "t = -2, -1, 0, 1, 2.";
        QuinticRight "quintic-right": "The approach is derived anew, with the right cubic coefficient." => "-2 f h q for the supplied -2 f g q.";
        QuinticRightRearranged "quintic-mended": "The approach is the course's, with its one wrong letter corrected." => "-2 f h q for the supplied -2 f g q.";
    }
    Variant ParticleHalfPlane {
        RearrangedHalfPlane "rearranged-ph": "The overlap's constant is a product of sum and difference." => "(r |n| - w) (r |n| + w) for r^2 (n.n) - w^2.";
        HalfPlaneUnitNormal "unit-normal": "The half-plane's normal is normalized first." => "n / |n| for n.";
    }
    Variant ContactVector {
        WideArithmetic "wide-arithmetic": "The overlaps are computed with extended precision and rounded at the end." => "106 bits for 53.";
        ContactOtherFormula "contact-other-formula": "The contact vectors come from other, equivalent formulas." => "(x2 - x1) + t (dx2 - dx1) for (x2 + t dx2) - (x1 + t dx1), for example.";
        ParticleEdgeContactClamped "pe-contact-clamped": "The contact vector goes to the nearest point of the edge, not of its line." => "max(0, min(1, alpha(t))) for alpha(t).";
    }
    Variant Response {
        ResponseInverseMasses "inverse-masses": "The impulses are written with inverse masses, zero for what is fixed." => "1/m1 + 1/m2 for 1 + m1/m2, and so on.";
    }
    Variant ImpactZones {
        ZonesUnionFind "zones-union-find": "Zones are merged by union and find, which lists them in another order." => "find(i) = find(j) joins two zones.";
        GeometricStopsWhenClear "stops-when-clear": "The geometric loop also ends when a pass finds nothing; the zones would be equal anyway." => "collisions.empty() ends the loop besides Z = Z'.";
        ZonesReversed "zones-reversed": "Zones are moved in the opposite order, which changes nothing." => "The last zone of Z comes first.";
    }
    Variant Failsafe {
        FailsafeMomentumFromEnd "momentum-from-end": "The angular momentum uses end positions about the center; what the start adds is parallel to its arm." => "(xs - x_cm) x (xe - x_cm - dx_cm) for (xs - x_cm) x (dx - dx_cm).";
        FailsafeWholeDisplacement "whole-displacement": "The angular momentum uses whole displacements; the center's part cancels." => "(xs - x_cm) x dx for (xs - x_cm) x (dx - dx_cm).";
        FailsafeHalfAngle "half-angle": "The rotation is computed from sine and cosine of half of the angle." => "1 - 2 sin(w/2)^2 for cos(w), 2 sin(w/2) cos(w/2) for sin(w).";
        FailsafeRotationMatrix "rotation-matrix": "The rotation is written as a matrix, and the sum in another order." => "(c a - s b, s a + c b) for c (a, b) + s (-b, a).";
    }
    Variant Trace {
        LogImpulsesReversed "impulses-reversed": "The impulses of a step are logged in the opposite order." => "The last entry of the list comes first.";
    }
    Hostile Process {
        HostileExitOne "exit-one": "Ends with an error status after a correct trace." => "exit(1) at the end.";
        HostileExitMidway "exit-midway": "Ends with an error status in mid-run, after flushing its trace." => "exit(3) in mid-run.";
        HostileCrash "crash-midway": "Aborts in mid-run." => "abort() in mid-run.";
        HostileLoop "endless-loop": "Computes for ever in mid-run." => "while (true) {}";
        HostileSleep "sleep-forever": "Sleeps for ever in mid-run." => "sleep(infinity)";
        HostileFloodStdout "flood-stdout": "Writes far too much to standard output." => "16 MiB.";
        HostileFloodStderr "flood-stderr": "Writes far too much to standard error." => "16 MiB.";
        HostileFloodTrace "flood-trace": "Writes far too much to the trace after its end." => "256 MiB.";
        HostileEscapes "escape-codes": "Writes terminal escape codes, markup and a spreadsheet formula on standard error." => "For example =cmd|'/c calc'!A0.";
        HostileForgedVerdict "forged-verdict": "Prints a passing verdict of the original oracle, and does wrong physics." => "No collision is reported.";
        HostileTrailingBytes "trailing-bytes": "Appends a few bytes to a correct trace." => "8 bytes.";
        HostileTruncated "truncated-trace": "Stops writing in the middle of a record, and ends with success." => "exit(0) after half a record.";
        HostileNoOutput "no-output": "Ends immediately with success and writes no trace." => "exit(0) at the beginning.";
        HostileEmptyTrace "empty-trace": "Creates the trace file and writes nothing." => "0 bytes.";
        HostileHugeCounts "huge-counts": "Claims absurdly many polynomials in each record." => "2147483647 polynomials.";
        HostileNegativeCounts "negative-counts": "Claims a negative number of polynomials in each record." => "-1 polynomials.";
        HostileNanState "nan-state": "Logs positions that are not numbers from mid-run on." => "NaN.";
        HostileChildren "leaves-children": "Starts copies of itself that outlive it for a minute." => "3 copies.";
        HostileMemory "hog-memory": "Allocates and fills a great deal of memory." => "4 GiB.";
    }
}

#[cfg(test)]
mod families;
