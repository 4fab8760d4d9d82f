//! Mistakes and variants of a student's program in collision handling and in its trace.
use super::{
    super::{
        rows::{MistakeRow, rows},
        states::StepMistake,
    },
    Subject::*,
    edits::{
        FormulaEdit::{self, *},
        *,
    },
    inputs::square_root,
    named_edits::*,
    special_formulas::*,
};

/// A row of the catalog, with the mistake as a [`Mistake`].
pub type Row = MistakeRow<Mistake>;

impl From<StepMistake> for Mistake {
    fn from(mistake: StepMistake) -> Self {
        Self::Step(mistake)
    }
}

rows! {
    /// A difference between a student's program and the reference.
    Mistake CATALOG [Step StepMistake] [FormulaEdit]
    Wrong ParticleParticle "sentences/particle-particle.txt" {
        ParticleParticleEmpty "pp-empty" [Lists(Vec::clear)];
        ParticleParticleZero "pp-zero" [Lists(|lists| lists.iter_mut().for_each(|list| list.fill(0.0)))];
        ParticleParticleReversed "pp-reversed" [Lists(|lists| lists.iter_mut().for_each(|list| list.reverse()))];
        ParticleParticleSwapped "pp-swapped" [Lists(|lists| lists.swap(0, 1))];
        ParticleParticleNoTwo "pp-no-two" [Weight(ParticleOverlap, 1, &[1], 0.5)];
        ParticleParticleLinearSign "pp-linear-sign" [Weight(ParticleOverlap, 1, &[1], -1.0)];
        ParticleParticleQuadraticSign "pp-quadratic-sign" [Weight(ParticleOverlap, 2, &[0], -1.0)];
        ParticleParticleNoQuadratic "pp-no-quadratic" [Weight(ParticleOverlap, 2, &[0], 0.0)];
        ParticleParticleConstantSign "pp-constant-sign" [List(ParticleOverlap, negate_at::<2>)];
        ParticleParticleRadiiSquaredApart "pp-radii-squared-apart" [Named(&RADII_SQUARED_APART)];
        ParticleParticleRadiusNotSquared "pp-radius-not-squared" [Named(&RADIUS_NOT_SQUARED)];
        ParticleParticleDistanceNotSquared "pp-distance-not-squared"
            [Letters(ParticleOverlap, |letters, _| letters[2] = square_root(letters[2]))];
        ParticleParticleFirstRadiusTwice "pp-first-radius-twice" [Named(&FIRST_RADIUS_TWICE)];
        ParticleParticleSecondRadiusTwice "pp-second-radius-twice" [Named(&SECOND_RADIUS_TWICE)];
        ParticleParticleDiameters "pp-diameters" [Named(&DIAMETERS)];
        ParticleParticleOneRadius "pp-one-radius" [Named(&FIRST_RADIUS_ONLY)];
        ParticleParticleNoFirstRadius "pp-no-first-radius" [Named(&SECOND_RADIUS_ONLY)];
        ParticleParticleEndPositions "pp-end-positions" [Named(&END_POSITIONS)];
        ParticleParticleFirstStill "pp-first-still" [Letters(ParticleOverlap, omit_first_displacement)];
        ParticleParticleSecondStill "pp-second-still" [Named(&SECOND_PARTICLE_STILL)];
        ParticleParticleEndForDisplacement "pp-end-for-displacement" [Letters(ParticleOverlap, use_end_positions)];
        ParticleParticleDisplacementsSwapped "pp-displacements-swapped" [Named(&DISPLACEMENT_REVERSED)];
        ParticleParticlePositionIndex "pp-position-index";
        ParticleParticleNextRadius "pp-next-radius";
        ParticleParticleXOnly "pp-x-only" [Letters(ParticleOverlap, omit_second_component)];
        ParticleParticleTinyError "pp-tiny-error" [List(ParticleOverlap, |list| list[2] *= 1.0 + 1e-9)];
        ParticleParticleOverlapNegated "pp-overlap-negated" [List(ParticleOverlap, negate_list)];
        ParticleParticleApproachNegated "pp-approach-negated" [List(ParticleApproach, negate_list)];
        ParticleParticleSeparating "pp-separating" [List(ParticleApproach, negate_at::<1>)];
        ParticleParticleApproachSlopeSign "pp-approach-slope-sign" [List(ParticleApproach, negate_at::<0>)];
        ParticleParticleApproachSlopeTwice "pp-approach-slope-twice" [List(ParticleApproach, |list| list[0] *= 2.0)];
        ParticleParticleApproachAtStart "pp-approach-at-start" [List(ParticleApproach, keep_last::<1>)];
        ParticleParticleNoApproach "pp-no-approach" [List(ParticleApproach, replace_by_one)];
    }
    Wrong ParticleEdge "sentences/particle-edge.txt" {
        ParticleEdgeEmpty "pe-empty" [Lists(Vec::clear)];
        ParticleEdgeZero "pe-zero" [Lists(|lists| lists[..3].iter_mut().for_each(|list| list.fill(0.0)))];
        ParticleEdgeReversed "pe-reversed" [Lists(|lists| lists.iter_mut().for_each(|list| list.reverse()))];
        ParticleEdgeSwapped "pe-swapped" [Lists(|lists| lists.swap(0, 1))];
        ParticleEdgeStill "pe-edge-still" [Named(&EDGE_STILL)];
        ParticleEdgeParticleStill "pe-particle-still" [Named(&PARTICLE_STILL)];
        ParticleEdgeFirstEndStill "pe-first-end-still" [Named(&FIRST_END_STILL)];
        ParticleEdgeSecondEndStill "pe-second-end-still" [Named(&SECOND_END_STILL)];
        ParticleEdgeOneDisplacement "pe-one-displacement" [Named(&FIRST_DISPLACEMENT_TWICE)];
        ParticleEdgeOtherDisplacement "pe-other-displacement" [Named(&SECOND_DISPLACEMENT_TWICE)];
        ParticleEdgeDisplacementsSwapped "pe-displacements-swapped" [Named(&DISPLACEMENTS_SWAPPED)];
        ParticleEdgeEndPositions "pe-end-positions" [Named(&END_POSITIONS)];
        ParticleEdgeEndForDisplacement "pe-end-for-displacement" [Named(&END_FOR_DISPLACEMENT)];
        ParticleEdgeEndpointsSwapped "pe-endpoints-swapped" [Named(&ENDPOINTS_SWAPPED)];
        ParticleEdgeRadiiSquaredApart "pe-radii-squared-apart" [Named(&RADII_SQUARED_APART)];
        ParticleEdgeRadiusNotSquared "pe-radius-not-squared" [Named(&RADIUS_NOT_SQUARED)];
        ParticleEdgeNoEdgeRadius "pe-no-edge-radius" [Named(&FIRST_RADIUS_ONLY)];
        ParticleEdgeNoParticleRadius "pe-no-particle-radius" [Named(&SECOND_RADIUS_ONLY)];
        ParticleEdgeParticleRadiusTwice "pe-particle-radius-twice" [Named(&FIRST_RADIUS_TWICE)];
        ParticleEdgeEdgeRadiusTwice "pe-edge-radius-twice" [Named(&SECOND_RADIUS_TWICE)];
        ParticleEdgeDiameters "pe-diameters" [Named(&DIAMETERS)];
        ParticleEdgeFirstEdgeRadius "pe-first-edge-radius";
        ParticleEdgeFirstEndRadius "pe-first-end-radius";
        ParticleEdgeSecondEndRadius "pe-second-end-radius";
        ParticleEdgeRadiusIndex "pe-radius-index";
        ParticleEdgePositionIndex "pe-position-index";
        ParticleEdgeRadiusUnscaled "pe-radius-unscaled" [Named(&RADIUS_UNSCALED)];
        ParticleEdgeQuarticNegated "pe-quartic-negated" [List(EdgeOverlap, negate_list)];
        ParticleEdgeThreeTerms "pe-three-terms" [List(EdgeOverlap, keep_last::<3>)];
        ParticleEdgeQuarticNoFi "pe-quartic-no-fi" [Weight(EdgeOverlap, 4, &[5, 8], 0.0)];
        ParticleEdgeQuarticPlusFi "pe-quartic-plus-fi" [Weight(EdgeOverlap, 4, &[5, 8], -1.0)];
        ParticleEdgeNoCubic "pe-no-cubic" [List(EdgeOverlap, |list| list[1] = 0.0)];
        ParticleEdgeCubicOneBc "pe-cubic-one-bc" [Weight(EdgeOverlap, 3, &[1, 2], 0.5)];
        ParticleEdgeCubicOneEi "pe-cubic-one-ei" [Weight(EdgeOverlap, 3, &[4, 8], 0.5)];
        ParticleEdgeCubicNoFh "pe-cubic-no-fh" [Weight(EdgeOverlap, 3, &[5, 7], 0.0)];
        ParticleEdgeCubicParentheses "pe-cubic-parentheses" [Weight(EdgeOverlap, 3, &[5, 7], -1.0)];
        ParticleEdgeSquareNoEh "pe-square-no-eh" [Weight(EdgeOverlap, 2, &[4, 7], 0.0)];
        ParticleEdgeSquareTwoEh "pe-square-two-eh" [Weight(EdgeOverlap, 2, &[4, 7], 0.5)];
        ParticleEdgeSquareNoBb "pe-square-no-bb" [Weight(EdgeOverlap, 2, &[1, 1], 0.0)];
        ParticleEdgeSquareOneCa "pe-square-one-ca" [Weight(EdgeOverlap, 2, &[0, 2], 0.5)];
        ParticleEdgeSquareNoDi "pe-square-no-di" [Weight(EdgeOverlap, 2, &[3, 8], 0.0)];
        ParticleEdgeSquarePlusFg "pe-square-plus-fg" [Weight(EdgeOverlap, 2, &[5, 6], -1.0)];
        ParticleEdgeSquareRadiusTwice "pe-square-radius-twice" [Weight(EdgeOverlap, 2, &[8, 9], 2.0)];
        ParticleEdgeLinearOneAb "pe-linear-one-ab" [Weight(EdgeOverlap, 1, &[0, 1], 0.5)];
        ParticleEdgeLinearNoDh "pe-linear-no-dh" [Weight(EdgeOverlap, 1, &[3, 7], 0.0)];
        ParticleEdgeLinearNoEg "pe-linear-no-eg" [Weight(EdgeOverlap, 1, &[4, 6], 0.0)];
        ParticleEdgeLinearOneSh "pe-linear-one-sh" [Weight(EdgeOverlap, 1, &[7, 9], 0.5)];
        ParticleEdgeLinearMinusSh "pe-linear-minus-sh" [Weight(EdgeOverlap, 1, &[7, 9], -1.0)];
        ParticleEdgeConstantNoDg "pe-constant-no-dg" [Weight(EdgeOverlap, 0, &[3, 6], 0.0)];
        ParticleEdgeConstantMinusAa "pe-constant-minus-aa" [Weight(EdgeOverlap, 0, &[0, 0], -1.0)];
        AlphaLowSlopeSign "pe-alpha-low-slope-sign" [List(AlphaLow, negate_at::<1>)];
        AlphaLowNegated "pe-alpha-low-negated" [List(AlphaLow, negate_list)];
        AlphaLowNoQuadratic "pe-alpha-low-no-quadratic" [List(AlphaLow, keep_last::<2>)];
        AlphaLowHalfSlope "pe-alpha-low-half-slope" [Weight(AlphaLow, 1, &[1], 0.0)];
        AlphaLowIsHigh "pe-alpha-low-is-high" [Lists(|lists| lists[1] = lists[2].clone())];
        AlphaLowAtStart "pe-alpha-low-at-start" [List(AlphaLow, keep_last::<1>)];
        AlphaLowMissing "pe-alpha-low-missing" [List(AlphaLow, replace_by_one)];
        AlphaHighIsLow "pe-alpha-high-is-low" [Lists(|lists| lists[2] = lists[1].clone())];
        AlphaHighUnscaled "pe-alpha-high-unscaled" [Named(&ONE_UNSCALED)];
        AlphaHighNegated "pe-alpha-high-negated" [List(AlphaHigh, negate_list)];
        AlphaHighHalfSlope "pe-alpha-high-half-slope" [Weight(AlphaHigh, 1, &[2], 0.0)];
        AlphaHighSlopeSign "pe-alpha-high-slope-sign" [List(AlphaHigh, negate_at::<1>)];
        AlphaHighNoQuadratic "pe-alpha-high-no-quadratic" [List(AlphaHigh, keep_last::<2>)];
        AlphaHighAtStart "pe-alpha-high-at-start" [List(AlphaHigh, keep_last::<1>)];
        AlphaHighMissing "pe-alpha-high-missing" [List(AlphaHigh, replace_by_one)];
        QuinticConstantAlpha "pe-approach-constant-alpha" [Named(&CONSTANT_ALPHA)];
        QuinticNegated "pe-approach-negated" [List(EdgeApproach, negate_list)];
        QuinticMissing "pe-approach-missing" [List(EdgeApproach, replace_by_one)];
        QuinticLowestFirst "pe-approach-lowest-first" [List(EdgeApproach, |list| list.reverse())];
        QuinticNoConstant "pe-approach-no-constant" [List(EdgeApproach, |list| list[5] = 0.0)];
        QuinticCutToLinear "pe-approach-cut" [List(EdgeApproach, keep_last::<2>)];
        QuinticOldLetter "pe-approach-old-letter"
            [Letters(EdgeApproach, |letters, inputs| letters[3] = inputs.x21().dot(inputs.x21()))];
    }
    Wrong ParticleHalfPlane "sentences/particle-half-plane.txt" {
        HalfPlaneEmpty "ph-empty" [Lists(Vec::clear)];
        HalfPlaneZero "ph-zero" [Lists(|lists| lists.iter_mut().for_each(|list| list.fill(0.0)))];
        HalfPlaneReversed "ph-reversed" [Lists(|lists| lists.iter_mut().for_each(|list| list.reverse()))];
        HalfPlaneSwapped "ph-swapped" [Lists(|lists| lists.swap(0, 1))];
        HalfPlaneNoNormalSquare "ph-no-normal-square" [Named(&NO_NORMAL_SQUARE)];
        HalfPlaneNormalLength "ph-normal-length" [Named(&NORMAL_LENGTH)];
        HalfPlaneRadiusNotSquared "ph-radius-not-squared" [Named(&RADIUS_NOT_SQUARED)];
        HalfPlaneNoRadius "ph-no-radius" [Named(&NO_RADIUS)];
        HalfPlaneDiameter "ph-diameter" [Named(&DIAMETERS)];
        HalfPlaneRadiusIndex "ph-radius-index";
        HalfPlaneNoTwo "ph-no-two" [Weight(HalfPlaneOverlap, 1, &[0, 1], 0.5)];
        HalfPlaneLinearSign "ph-linear-sign" [Weight(HalfPlaneOverlap, 1, &[0, 1], -1.0)];
        HalfPlaneQuadraticSign "ph-quadratic-sign" [Weight(HalfPlaneOverlap, 2, &[0, 0], -1.0)];
        HalfPlaneNoQuadratic "ph-no-quadratic" [Weight(HalfPlaneOverlap, 2, &[0, 0], 0.0)];
        HalfPlaneConstantSign "ph-constant-sign" [Weight(HalfPlaneOverlap, 0, &[1, 1], -1.0)];
        HalfPlaneOffsetNotSquared "ph-offset-not-squared" [Formula(HalfPlaneOverlap, unsquared_offset)];
        HalfPlaneOverlapNegated "ph-overlap-negated" [List(HalfPlaneOverlap, negate_list)];
        HalfPlaneOverlapSigned "ph-overlap-signed" [Named(&SIGNED_DISTANCE)];
        HalfPlaneOverlapToPoint "ph-overlap-to-point" [Formula(HalfPlaneOverlap, overlap_to_point)];
        HalfPlaneFirst "ph-first-half-plane";
        HalfPlanePositionIndex "ph-position-index";
        HalfPlaneNoPoint "ph-no-point" [Named(&NO_POINT)];
        HalfPlaneEndPosition "ph-end-position" [Named(&END_POSITIONS)];
        HalfPlaneEndForDisplacement "ph-end-for-displacement" [Named(&END_FOR_DISPLACEMENT)];
        HalfPlaneReversedOffset "ph-reversed-offset" [Named(&REVERSED_OFFSET)];
        HalfPlaneApproachNoSpeed "ph-approach-no-speed" [Named(&NO_SPEED_FACTOR)];
        HalfPlaneApproachConstantNoSpeed "ph-approach-constant-no-speed"
            [Formula(HalfPlaneApproach, constant_without_speed)];
        HalfPlaneApproachNegated "ph-approach-negated" [List(HalfPlaneApproach, negate_list)];
        HalfPlaneApproachSlopeSign "ph-approach-slope-sign" [List(HalfPlaneApproach, negate_at::<0>)];
        HalfPlaneApproachSlopeTwice "ph-approach-slope-twice" [List(HalfPlaneApproach, |list| list[0] *= 2.0)];
        HalfPlaneApproachAtStart "ph-approach-at-start" [List(HalfPlaneApproach, keep_last::<1>)];
        HalfPlaneApproachSpeedOnly "ph-approach-speed-only" [Named(&SPEED_ONLY)];
        HalfPlaneApproachClosingOnly "ph-approach-closing-only" [Formula(HalfPlaneApproach, negative_normal_speed)];
        HalfPlaneNoApproach "ph-no-approach" [List(HalfPlaneApproach, replace_by_one)];
    }
    Wrong Handover "sentences/handover.txt" {
        HandoverLowestFirst "handover-lowest-first";
        HandoverNegated "handover-negated";
        HandoverSwapped "handover-swapped";
        HandoverAlphaSwapped "handover-alpha-swapped";
        HandoverSinglePrecision "handover-single-precision";
        HandoverPositionOnly "handover-position-only";
        HandoverApproachOnly "handover-approach-only";
        HandoverMonic "handover-monic";
    }
    Wrong ContactVector "sentences/contact-vector.txt" {
        ParticleParticleContactAtStart "pp-contact-at-start";
        ParticleParticleContactAtEnd "pp-contact-at-end";
        ParticleParticleContactReversed "pp-contact-reversed";
        ParticleParticleContactFirstStill "pp-contact-first-still";
        ParticleParticleContactSecondStill "pp-contact-second-still";
        ParticleParticleContactFirstAdded "pp-contact-first-added";
        ParticleParticleContactDisplacementsSwapped "pp-contact-displacements-swapped";
        ParticleParticleContactFirstAtEnd "pp-contact-first-at-end";
        ParticleParticleContactSecondAtEnd "pp-contact-second-at-end";
        ParticleEdgeContactAtStart "pe-contact-at-start";
        ParticleEdgeContactAtEnd "pe-contact-at-end";
        ParticleEdgeContactAlphaAtStart "pe-contact-alpha-at-start";
        ParticleEdgeContactAlphaAtEnd "pe-contact-alpha-at-end";
        ParticleEdgeContactAlphaMiddle "pe-contact-alpha-middle";
        ParticleEdgeContactAlphaOverLength "pe-contact-alpha-over-length";
        ParticleEdgeContactAlphaTimesEnd "pe-contact-alpha-times-end";
        ParticleEdgeContactFirstEnd "pe-contact-first-end";
        ParticleEdgeContactSecondEnd "pe-contact-second-end";
        ParticleEdgeContactFromOtherEnd "pe-contact-other-end";
        ParticleEdgeContactReversed "pe-contact-reversed";
        ParticleEdgeContactParticleStill "pe-contact-particle-still";
        ParticleEdgeContactParticleAdded "pe-contact-particle-added";
        ParticleEdgeContactEdgeStill "pe-contact-edge-still";
        ParticleEdgeContactParticleAtEnd "pe-contact-particle-at-end";
        ParticleEdgeContactEdgeAtEnd "pe-contact-edge-at-end";
        ParticleEdgeContactNearestEnd "pe-contact-nearest-end";
        HalfPlaneContactUndivided "ph-contact-undivided";
        HalfPlaneContactDividedByLength "ph-contact-divided-by-length";
        HalfPlaneContactIsNormal "ph-contact-is-normal";
        HalfPlaneContactReversed "ph-contact-reversed";
        HalfPlaneContactAdded "ph-contact-added";
        HalfPlaneContactAtStart "ph-contact-at-start";
        HalfPlaneContactAtEnd "ph-contact-at-end";
        HalfPlaneContactToPoint "ph-contact-to-point";
        ContactUnitLength "contact-unit-length";
        ContactSingle "contact-float";
        ContactNoise "contact-noise";
        ContactTimeScaled "contact-time-scaled";
        ContactTimeZero "contact-time-zero";
        ContactTimeSingle "contact-time-float";
    }
    Wrong Decision "sentences/decision.txt" {
        DecisionOpenEnd "decision-open-end";
        DecisionOpenEndParticles "pp-open-end";
        DecisionOpenEndHalfPlanes "ph-open-end";
        DecisionOpenStart "decision-open-start";
        DecisionOpenInterval "decision-open-interval";
        DecisionNoUpperBound "decision-no-upper-bound";
        DecisionSeconds "decision-seconds";
        DecisionHalfStep "decision-half-step";
        DecisionTolerance "decision-tolerance";
        DecisionTruth "decision-truth";
        DecisionNever "decision-never";
        DecisionOverlapAtEnd "decision-overlap-at-end";
        DecisionOverlapAtStart "decision-overlap-at-start";
        DecisionAlphaAtStart "decision-alpha-at-start";
        DecisionAlphaAtEnd "decision-alpha-at-end";
        DecisionAlphaMargin "decision-alpha-margin";
        DecisionApproachMargin "decision-approach-margin";
        DecisionHalfPlaneOneSided "decision-half-plane-one-sided";
        DecisionFixedEdges "decision-fixed-edges";
        DecisionFixedAtEdges "decision-fixed-at-edges";
        DecisionFixedAtHalfPlanes "decision-fixed-at-half-planes";
        ParticleParticlePrediction "pp-detects-prediction";
        ParticleEdgePrediction "pe-detects-prediction";
        HalfPlanePrediction "ph-detects-prediction";
        PairsBothOrders "pairs-both-orders";
        PairsNeighborsOnly "pairs-neighbors-only";
        PairsEndpointsToo "pairs-endpoints-too";
        PairsFixedSkipped "pairs-fixed-skipped";
        PairsFixedEdgesSkipped "pairs-fixed-edges-skipped";
        PairsConnectedSkipped "pairs-connected-skipped";
        PairsPruned "pairs-pruned";
        PairsFirstHalfPlaneOnly "pairs-first-half-plane-only";
        PairsHalfPlanesFirst "pairs-half-planes-first";
    }
    Wrong Response "sentences/response.txt" {
        ResponseSign "response-sign";
        ResponseHalved "response-halved";
        ResponseNoRestitution "response-no-restitution";
        ResponseInelastic "response-inelastic";
        ResponseRestitutionOnly "response-restitution-only";
        ResponseNotNormalized "response-not-normalized";
        ResponseEndVelocity "response-end-velocity";
        ResponseVelocitiesOnly "response-velocities-only";
        ResponsePositionsOnly "response-positions-only";
        ResponsePositionNoStep "response-position-no-step";
        ResponseMassesSwapped "response-masses-swapped";
        ResponseEqualMasses "response-equal-masses";
        ResponseFixedMassFinite "response-fixed-mass-finite";
        ResponseMovesFixed "response-moves-fixed";
        ResponseFirstOnly "response-first-only";
        ResponseEdgeAtStart "response-edge-at-start";
        ResponseEdgeMiddle "response-edge-middle";
        ResponseEdgeSwapped "response-edge-swapped";
        ResponseEdgeStill "response-edge-still";
        ResponseOneEndpoint "response-one-endpoint";
        ResponseHalfPlaneHalved "response-half-plane-halved";
        ResponseHalfPlaneSparesFixed "response-half-plane-spares-fixed";
        ResponseSinglePrecision "response-float";
    }
    Wrong ContinuousTime "sentences/continuous-time.txt" {
        ContinuousDetectAllFirst "ct-detect-all-first";
        ContinuousOldPrediction "ct-old-prediction";
        ContinuousFirstOnly "ct-first-only";
        ContinuousTwoPasses "ct-two-passes";
        ContinuousNoResponse "ct-no-response";
    }
    Wrong ImpulseLoop "sentences/impulse-loop.txt" {
        ImpulsesEmpty "loop-empty";
        ImpulsesEmptySuccess "loop-empty-succeeds";
        ImpulsesOneFewer "loop-one-fewer";
        ImpulsesOneMore "loop-one-more";
        ImpulsesOnlyOne "loop-only-one";
        ImpulsesAlwaysTen "loop-always-ten";
        ImpulsesDouble "loop-double";
        ImpulsesCountContacts "loop-counts-contacts";
        ImpulsesCountTwice "loop-counts-twice";
        ImpulsesDetectAfterLast "loop-detects-after-last";
        ImpulsesDetectBefore "loop-detects-before";
        ImpulsesTestBefore "loop-tests-before";
        ImpulsesPassWhenZero "loop-pass-when-zero";
        ImpulsesTestWhenZero "loop-test-when-zero";
        ImpulsesSuccessWhenZero "loop-success-when-zero";
        ImpulsesOnceWhenZero "loop-once-when-zero";
        ImpulsesAlwaysFail "loop-always-fails";
        ImpulsesAlwaysSucceed "loop-always-succeeds";
        ImpulsesOneLeftSucceeds "loop-one-left-succeeds";
        ImpulsesSucceedAfterOne "loop-succeeds-after-one";
        ImpulsesLastNotApplied "loop-last-not-applied";
        ImpulsesDetectOnce "loop-detects-once";
        ImpulsesInverted "loop-inverted";
        ImpulsesFromPrediction "loop-from-prediction";
        ImpulsesPredictedVelocities "loop-predicted-velocities";
        ImpulsesResultNotAccumulated "loop-not-accumulated";
        ImpulsesAnew "loop-anew";
        ImpulsesOneByOne "loop-one-by-one";
        ImpulsesLastWins "loop-last-wins";
        ImpulsesFirstOnly "loop-first-only";
        ImpulsesLastOnly "loop-last-only";
        ImpulsesFirstSkipped "loop-first-skipped";
        ImpulsesLastSkipped "loop-last-skipped";
        ImpulsesListKept "loop-list-kept";
        ImpulsesDetectPrediction "loop-detects-prediction";
        ImpulsesStartAdvances "loop-start-advances";
        ImpulsesStartFollows "loop-start-follows";
        ImpulsesFromEnd "loop-from-end";
        ImpulsesPositionsFromVelocities "loop-positions-from-velocities";
        ImpulsesSameCountFails "loop-same-count-fails";
        ImpulsesCapped "loop-capped";
        ImpulsesReset "loop-reset";
        ImpulsesVelocityRestored "loop-velocity-restored";
        ImpulsesPositionsRestored "loop-positions-restored";
    }
    Wrong ImpactZones "sentences/impact-zones.txt" {
        GeometricEmpty "geometric-empty";
        GeometricOneRound "geometric-one-round";
        GeometricFindsInVain "geometric-finds-in-vain";
        GeometricCapped "geometric-capped";
        GeometricTwoRounds "geometric-two-rounds";
        GeometricRestarts "geometric-restarts";
        GeometricDetectsPrediction "geometric-detects-prediction";
        GeometricForgetsZones "geometric-forgets-zones";
        GeometricStopsWhenEmpty "geometric-stops-when-empty";
        GeometricExtraPass "geometric-extra-pass";
        GeometricFirstZoneOnly "geometric-first-zone-only";
        GeometricLastZoneOnly "geometric-last-zone-only";
        GeometricFirstZoneSkipped "geometric-first-zone-skipped";
        GeometricLastZoneSkipped "geometric-last-zone-skipped";
        GeometricMovesPrediction "geometric-moves-prediction";
        GeometricNewZonesOnly "geometric-new-zones-only";
        GeometricGrownStay "geometric-grown-stay";
        GeometricVelocitiesKept "geometric-velocities-kept";
        GeometricHalfPlanesDropped "geometric-half-planes-dropped";
        ZonesOneEndpoint "zones-one-endpoint";
        ZonesOtherEndpoint "zones-other-endpoint";
        ZonesNextParticle "zones-next-particle";
        ZonesFlagOfEdges "zones-flag-of-edges";
        ZonesHalfPlaneIndex "zones-half-plane-index";
        ZonesEdgeIndex "zones-edge-index";
        ZonesEdgeWithoutParticle "zones-edge-without-particle";
        ZonesNotMerged "zones-not-merged";
        ZonesMergedOnce "zones-merged-once";
        ZonesAllInOne "zones-all-in-one";
        ZonesJoinOneParticle "zones-join-one-particle";
        ZonesJoinTwoShared "zones-join-two-shared";
        ZonesNoHalfPlaneFlag "zones-no-flag";
        ZonesFlagInverted "zones-flag-inverted";
        ZonesFlagShared "zones-flag-shared";
        ZonesFlagLost "zones-flag-lost";
        ZonesFlagOverwritten "zones-flag-overwritten";
        ZonesFlagBoth "zones-flag-both";
        ZonesEqualByCount "zones-equal-by-count";
        ZonesEqualBySize "zones-equal-by-size";
        ZonesEqualNoFlag "zones-equal-no-flag";
    }
    Wrong Failsafe "sentences/failsafe.txt" {
        FailsafeEmpty "failsafe-empty";
        FailsafeUnweighted "failsafe-unweighted";
        FailsafeMeansUnweighted "failsafe-means-unweighted";
        FailsafeCenterUnweighted "failsafe-center-unweighted";
        FailsafeCenterAtEnd "failsafe-center-at-end";
        FailsafeNoCenter "failsafe-no-center";
        FailsafeMomentumUnweighted "failsafe-momentum-unweighted";
        FailsafeMomentumVelocity "failsafe-momentum-velocity";
        FailsafeAngularVelocity "failsafe-angular-velocity";
        FailsafeNoTranslation "failsafe-no-translation";
        FailsafeShiftTwice "failsafe-shift-twice";
        FailsafeRange "failsafe-range";
        FailsafeAngularUnweighted "failsafe-angular-unweighted";
        FailsafeAngularOverwritten "failsafe-angular-overwritten";
        FailsafeAngularDoubled "failsafe-angular-doubled";
        FailsafeCrossSum "failsafe-cross-sum";
        FailsafeDotProduct "failsafe-dot-product";
        FailsafeAboutOrigin "failsafe-about-origin";
        FailsafeInertiaUnweighted "failsafe-inertia-unweighted";
        FailsafeInertiaDistance "failsafe-inertia-distance";
        FailsafeInertiaAboutOrigin "failsafe-inertia-about-origin";
        FailsafeInertiaAtEnd "failsafe-inertia-at-end";
        FailsafeNoInertia "failsafe-no-inertia";
        FailsafeRotationAbsolute "failsafe-rotation-absolute";
        FailsafeRotationSign "failsafe-rotation-sign";
        FailsafeNoRotation "failsafe-no-rotation";
        FailsafeSmallAngle "failsafe-small-angle";
        FailsafeSeries "failsafe-series";
        FailsafeTinyTurnIgnored "failsafe-tiny-turn-ignored";
        FailsafeUnturnedUnmoved "failsafe-unturned-unmoved";
        FailsafeMassInteger "failsafe-mass-integer";
        FailsafeAngularInteger "failsafe-angular-integer";
        FailsafeInertiaInteger "failsafe-inertia-integer";
        FailsafeSumsSingle "failsafe-float-sums";
        FailsafeDegrees "failsafe-degrees";
        FailsafeAnglePerStep "failsafe-angle-per-step";
        FailsafePerpendicular "failsafe-perpendicular";
        FailsafeCosineSine "failsafe-cos-sin";
        FailsafeTurnsEnd "failsafe-turns-end";
        FailsafeMassIndex "failsafe-mass-index";
        FailsafeMassCounter "failsafe-mass-counter";
        FailsafeFixedSkipped "failsafe-fixed-skipped";
        FailsafeFixedForgotten "failsafe-fixed-forgotten";
        FailsafeHalfPlaneForgotten "failsafe-half-plane-forgotten";
        FailsafeAllFixedOnly "failsafe-all-fixed-only";
        FailsafeFirstFixedOnly "failsafe-first-fixed-only";
        FailsafeLastFixedOnly "failsafe-last-fixed-only";
        FailsafeFixedCounter "failsafe-fixed-counter";
        FailsafeAlwaysStops "failsafe-always-stops";
        FailsafeStopsFixedOnly "failsafe-stops-fixed-only";
        FailsafeStopKeepsPosition "failsafe-stop-keeps-position";
        FailsafeStopKeepsVelocity "failsafe-stop-keeps-velocity";
        FailsafeVelocityKept "failsafe-velocity-kept";
        FailsafeVelocityAdded "failsafe-velocity-added";
        FailsafeVelocityTimesStep "failsafe-velocity-times-step";
        FailsafeVelocityNoStep "failsafe-velocity-no-step";
        FailsafeVelocityFromPrediction "failsafe-velocity-from-prediction";
        FailsafeVelocityOfCenter "failsafe-velocity-of-center";
    }
    Wrong Trace "sentences/trace.txt" {
        LogLowestFirst "log-lowest-first";
        LogNegated "log-negated";
        LogNan "log-nan";
        LogTiny "log-tiny";
        LogSwapped "log-swapped";
        LogTrailingZero "log-trailing-zero";
        LogRounded "log-rounded";
        LogPolynomialsKept "log-polynomials-kept";
        LogImpulsesKept "log-impulses-kept";
        LogNoImpulses "log-no-impulses";
        LogDuplicateImpulses "log-duplicate-impulses";
        LogNanContacts "log-nan-contacts";
        LogHybridImpulses "log-hybrid-impulses";
        LogMidIsEnd "log-mid-is-end";
        LogNoMid "log-no-mid";
        LogNoInitial "log-no-initial";
        LogSinglePrecision "log-single-precision";
        LogPadded "log-padded";
    }
    Variant Handover "sentences/variants.txt" {
        ScaleTwo "scale-2";
        ScaleHalf "scale-half";
        ScaleThree "scale-3";
        ScaleThousand "scale-1000";
        ScaleMillionth "scale-1e-6";
        ScaleParticleParticleTwo "scale-pp-2";
        ScaleParticleEdgeThree "scale-pe-3";
        ScaleHalfPlaneThree "scale-ph-3";
        NormalizedLargest "normalized-largest";
        NormalizedNorm "normalized-norm";
        NormalizedPerPair "normalized-per-pair";
        ThroughBernstein "through-bernstein";
        InterpolatedAll "interpolated-all";
        FrameShifted "frame-shifted";
        FrameComoving "frame-comoving";
        FrameRotated "frame-rotated";
        ExtendedPrecision "extended-precision";
        FusedArithmetic "fused-arithmetic";
    }
    Variant ParticleParticle {
        RearrangedParticleParticle "rearranged-pp";
    }
    Variant ParticleEdge {
        RearrangedParticleEdge "rearranged-pe";
        FactorizedQuartic "factorized-quartic";
        FactorizedAll "factorized-all";
        InterpolatedQuartic "interpolated-quartic";
        QuinticRight "quintic-right";
        QuinticRightRearranged "quintic-mended";
    }
    Variant ParticleHalfPlane {
        RearrangedHalfPlane "rearranged-ph";
        HalfPlaneUnitNormal "unit-normal";
    }
    Variant ContactVector {
        WideArithmetic "wide-arithmetic";
        ContactOtherFormula "contact-other-formula";
        ParticleEdgeContactClamped "pe-contact-clamped";
    }
    Variant Response {
        ResponseInverseMasses "inverse-masses";
    }
    Variant ImpactZones {
        ZonesUnionFind "zones-union-find";
        GeometricStopsWhenClear "stops-when-clear";
        ZonesReversed "zones-reversed";
    }
    Variant Failsafe {
        FailsafeMomentumFromEnd "momentum-from-end";
        FailsafeWholeDisplacement "whole-displacement";
        FailsafeHalfAngle "half-angle";
        FailsafeRotationMatrix "rotation-matrix";
    }
    Variant Trace {
        LogImpulsesReversed "impulses-reversed";
    }
}

#[cfg(test)]
mod families;
