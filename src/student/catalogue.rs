//! Everything that a student's program can do differently: one row each.
//!
//! Three kinds: `wrong` programs misunderstand something and leave another trace; `variant`s are correct but for
//! round-off or a positive factor; `hostile` ones try the harness, not the physics. The place in the simulation where
//! a mistake is made asks [`Student::makes`].
/// What is to be thought of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A mistake: the result is wrong.
    Wrong,
    /// No mistake: other arithmetic, the same mathematics.
    Variant,
    /// A program that harms itself or others.
    Hostile,
}

/// The part of the assignment that a row belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Area {
    /// Polynomials of two particles.
    ParticleParticle,
    /// Polynomials of a particle and an edge.
    ParticleEdge,
    /// Polynomials of a particle and a half-plane.
    ParticleHalfPlane,
    /// What all three detections have in common: how polynomials reach the root finder.
    Handover,
    /// The vector between the objects at the time of impact.
    ContactVector,
    /// Which times count, and which pairs are looked at.
    Decision,
    /// The impulse of one contact.
    Response,
    /// The single pass of `continuous-time`.
    ContinuousTime,
    /// The impulse rounds of `hybrid`.
    ImpulseLoop,
    /// Impact zones and their growth.
    ImpactZones,
    /// The rigid motion of one zone.
    Failsafe,
    /// What is written to the trace.
    Trace,
    /// How the program behaves as a process.
    Process,
}

impl Kind {
    /// Its name in listings.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Wrong => "wrong",
            Self::Variant => "variant",
            Self::Hostile => "hostile",
        }
    }
}

impl Area {
    /// Its name in listings.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ParticleParticle => "particle-particle",
            Self::ParticleEdge => "particle-edge",
            Self::ParticleHalfPlane => "particle-half-plane",
            Self::Handover => "handover",
            Self::ContactVector => "contact-vector",
            Self::Decision => "decision",
            Self::Response => "response",
            Self::ContinuousTime => "continuous-time",
            Self::ImpulseLoop => "impulse-loop",
            Self::ImpactZones => "impact-zones",
            Self::Failsafe => "failsafe",
            Self::Trace => "trace",
            Self::Process => "process",
        }
    }
}

/// One row of the catalogue.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// The mistake, for the program.
    pub mistake: Mistake,
    /// The mistake, for the user.
    pub id: &'static str,
    /// Wrong, correct, or hostile.
    pub kind: Kind,
    /// Where it is made.
    pub area: Area,
    /// One sentence, as a teacher would say it.
    pub explanation: &'static str,
}

/// The program's author: makes one mistake, or none.
#[derive(Debug, Clone, Copy, Default)]
pub struct Student {
    mistake: Option<Mistake>,
    right_approach: bool,
}

impl Student {
    /// A student who makes this mistake.
    pub fn new(mistake: Option<Mistake>) -> Self {
        Self { mistake, right_approach: false }
    }

    /// Whether the student makes this mistake.
    pub fn makes(self, mistake: Mistake) -> bool {
        self.mistake == Some(mistake)
    }

    /// The mistake, where many are told apart in one place.
    pub fn mistake(self) -> Option<Mistake> {
        self.mistake
    }

    /// The same student, who has put the supplied particle-edge approach right (collisions.md 2). That is correct, too, and
    /// independent of the mistake.
    #[must_use]
    pub fn with_right_approach(self) -> Self {
        Self { right_approach: true, ..self }
    }

    /// Whether the particle-edge approach is mathematically right, not the supplied one.
    #[must_use]
    pub fn approach_is_right(self) -> bool {
        self.right_approach || self.makes(Mistake::QuinticRightRearranged)
    }
}

impl Row {
    /// The explanation with the kind of pair in front, where the mistake is made for one kind only.
    #[must_use]
    pub fn sentence(&self) -> String {
        let kind = match self.id.split_once('-') {
            Some(("pp", _)) => "Particle-particle: ",
            Some(("pe", _)) => "Particle-edge: ",
            Some(("ph", _)) => "Particle-half-plane: ",
            _ => "",
        };
        format!("{kind}{}", self.explanation)
    }
}

/// The row with this id.
pub fn find(id: &str) -> Option<&'static Row> {
    CATALOGUE.iter().find(|row| row.id == id)
}

macro_rules! catalogue {
    ($($kind:ident $area:ident { $($mistake:ident $id:literal: $explanation:literal;)* })*) => {
        /// Something that a program does differently.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Mistake {
            $($(#[doc = $explanation] $mistake,)*)*
        }

        /// All rows, in the order of the assignment.
        pub const CATALOGUE: &[Row] = &[$($(Row {
            mistake: Mistake::$mistake,
            id: $id,
            kind: Kind::$kind,
            area: Area::$area,
            explanation: $explanation,
        },)*)*];
    };
}

catalogue! {
    Wrong ParticleParticle {
        ParticleParticleEmpty "pp-empty": "The particle-particle detection is left empty: it never asks the root finder.";
        ParticleParticleZero "pp-zero": "The particle-particle coefficients are left at zero.";
        ParticleParticleNoTwo "pp-no-two": "The linear coefficient of the overlap lacks its factor 2.";
        ParticleParticleLinearSign "pp-linear-sign": "The linear coefficient of the overlap has the wrong sign.";
        ParticleParticleQuadraticSign "pp-quadratic-sign": "The quadratic coefficient of the overlap has the wrong sign.";
        ParticleParticleNoQuadratic "pp-no-quadratic": "The quadratic coefficient of the overlap is missing.";
        ParticleParticleConstantSign "pp-constant-sign": "Distance and radii are exchanged in the constant coefficient.";
        ParticleParticleRadiiSquaredApart "pp-radii-squared-apart": "Each radius is squared for itself: r1^2 + r2^2 is not (r1 + r2)^2.";
        ParticleParticleRadiusNotSquared "pp-radius-not-squared": "The sum of the radii is not squared.";
        ParticleParticleDistanceNotSquared "pp-distance-not-squared": "The constant coefficient has the distance where its square belongs.";
        ParticleParticleFirstRadiusTwice "pp-first-radius-twice": "The first particle's radius is used for both particles.";
        ParticleParticleOneRadius "pp-one-radius": "The second particle's radius is forgotten.";
        ParticleParticleEndPositions "pp-end-positions": "The formulas start from the positions at the end of the step.";
        ParticleParticleFirstStill "pp-first-still": "The first particle's displacement is forgotten.";
        ParticleParticleEndForDisplacement "pp-end-for-displacement": "End positions stand where displacements belong.";
        ParticleParticleXOnly "pp-x-only": "The dot products of the moving terms leave the y components out.";
        ParticleParticleTinyError "pp-tiny-error": "The constant coefficient is wrong by one part in a billion.";
        ParticleParticleSeparating "pp-separating": "The approach has the relative velocity the wrong way round in its constant term.";
        ParticleParticleApproachSlopeSign "pp-approach-slope-sign": "The approach's slope has the wrong sign.";
        ParticleParticleApproachSlopeTwice "pp-approach-slope-twice": "The approach's slope has a factor 2 that its constant lacks.";
        ParticleParticleApproachAtStart "pp-approach-at-start": "The approach is tested at the start of the step only.";
        ParticleParticleNoApproach "pp-no-approach": "The approach is not tested: a constant stands in its place.";
    }
    Wrong ParticleEdge {
        ParticleEdgeEmpty "pe-empty": "The particle-edge detection is left empty: it never asks the root finder.";
        ParticleEdgeZero "pe-zero": "The particle-edge coefficients are left at zero.";
        ParticleEdgeStill "pe-edge-still": "The edge is treated as if it did not move.";
        ParticleEdgeOneDisplacement "pe-one-displacement": "The first endpoint's displacement is used for both endpoints.";
        ParticleEdgeDisplacementsSwapped "pe-displacements-swapped": "The endpoints' displacements are exchanged.";
        ParticleEdgeEndPositions "pe-end-positions": "The formulas start from the positions at the end of the step.";
        ParticleEdgeEndpointsSwapped "pe-endpoints-swapped": "The endpoints are exchanged, so the two alpha polynomials are, too.";
        ParticleEdgeRadiiSquaredApart "pe-radii-squared-apart": "Each radius is squared for itself: r1^2 + re^2 is not (r1 + re)^2.";
        ParticleEdgeRadiusNotSquared "pe-radius-not-squared": "The sum of the radii is not squared.";
        ParticleEdgeNoEdgeRadius "pe-no-edge-radius": "The edge's radius is forgotten.";
        ParticleEdgeNoParticleRadius "pe-no-particle-radius": "The particle's radius is forgotten.";
        ParticleEdgeRadiusUnscaled "pe-radius-unscaled": "The radii are not multiplied by the edge's squared length when the denominator is cleared.";
        ParticleEdgeQuarticNegated "pe-quartic-negated": "The quartic is negative where the objects overlap.";
        ParticleEdgeThreeTerms "pe-three-terms": "The quartic is cut to its last three terms.";
        ParticleEdgeQuarticNoFi "pe-quartic-no-fi": "The t^4 coefficient lacks -f i.";
        ParticleEdgeQuarticPlusFi "pe-quartic-plus-fi": "The t^4 coefficient has +f i for -f i.";
        ParticleEdgeNoCubic "pe-no-cubic": "The t^3 coefficient is zero.";
        ParticleEdgeCubicOneBc "pe-cubic-one-bc": "The t^3 coefficient has b c for 2 b c.";
        ParticleEdgeCubicOneEi "pe-cubic-one-ei": "The t^3 coefficient has e i for 2 e i.";
        ParticleEdgeCubicNoFh "pe-cubic-no-fh": "The t^3 coefficient lacks -2 f h.";
        ParticleEdgeCubicParentheses "pe-cubic-parentheses": "Lost parentheses give the last term of t^3 the wrong sign.";
        ParticleEdgeSquareNoEh "pe-square-no-eh": "The t^2 coefficient lacks -4 e h.";
        ParticleEdgeSquareTwoEh "pe-square-two-eh": "The t^2 coefficient has -2 e h for -4 e h.";
        ParticleEdgeSquareNoBb "pe-square-no-bb": "The t^2 coefficient lacks b^2.";
        ParticleEdgeSquareOneCa "pe-square-one-ca": "The t^2 coefficient has c a for 2 c a.";
        ParticleEdgeSquareNoDi "pe-square-no-di": "The t^2 coefficient lacks -d i.";
        ParticleEdgeSquarePlusFg "pe-square-plus-fg": "The t^2 coefficient has +f g for -f g.";
        ParticleEdgeSquareRadiusTwice "pe-square-radius-twice": "The radius term of the t^2 coefficient is doubled.";
        ParticleEdgeLinearOneAb "pe-linear-one-ab": "The linear coefficient has a b for 2 a b.";
        ParticleEdgeLinearNoDh "pe-linear-no-dh": "The linear coefficient lacks -2 d h.";
        ParticleEdgeLinearNoEg "pe-linear-no-eg": "The linear coefficient lacks -2 e g.";
        ParticleEdgeLinearOneSh "pe-linear-one-sh": "The radius term of the linear coefficient lacks its factor 2.";
        ParticleEdgeLinearMinusSh "pe-linear-minus-sh": "The radius term of the linear coefficient has the wrong sign.";
        ParticleEdgeConstantNoDg "pe-constant-no-dg": "The constant coefficient lacks -d g.";
        ParticleEdgeConstantMinusAa "pe-constant-minus-aa": "The constant coefficient has -a^2 for a^2.";
        AlphaLowSlopeSign "pe-alpha-low-slope-sign": "The linear coefficient of alpha > 0 has the wrong sign.";
        AlphaLowNegated "pe-alpha-low-negated": "The polynomial says alpha < 0 instead of alpha > 0.";
        AlphaLowNoQuadratic "pe-alpha-low-no-quadratic": "The quadratic coefficient of alpha > 0 is missing.";
        AlphaLowAtStart "pe-alpha-low-at-start": "alpha > 0 is tested at the start of the step only.";
        AlphaLowMissing "pe-alpha-low-missing": "alpha > 0 is not tested: a constant stands in its place.";
        AlphaHighIsLow "pe-alpha-high-is-low": "alpha > 0 is handed over twice, alpha < 1 never.";
        AlphaHighUnscaled "pe-alpha-high-unscaled": "1 - alpha is written without multiplying the 1 by the edge's squared length.";
        AlphaHighNegated "pe-alpha-high-negated": "The polynomial says alpha > 1 instead of alpha < 1.";
        AlphaHighHalfSlope "pe-alpha-high-half-slope": "The linear coefficient of alpha < 1 lacks one of its two products.";
        AlphaHighAtStart "pe-alpha-high-at-start": "alpha < 1 is tested at the start of the step only.";
        AlphaHighMissing "pe-alpha-high-missing": "alpha < 1 is not tested: a constant stands in its place.";
        QuinticConstantAlpha "pe-approach-constant-alpha": "The approach takes alpha for constant during the step, which the assignment warns of.";
        QuinticNegated "pe-approach-negated": "The approach has the wrong sign, so only separating objects collide.";
        QuinticMissing "pe-approach-missing": "The approach is not tested: a constant stands in its place.";
        QuinticLowestFirst "pe-approach-lowest-first": "The approach's coefficients are in the wrong order.";
        QuinticNoConstant "pe-approach-no-constant": "The approach's constant coefficient is overwritten with zero.";
        QuinticCutToLinear "pe-approach-cut": "The approach is cut to its last two terms.";
        QuinticOldLetter "pe-approach-old-letter": "The approach uses the letter d of the quartic, which means another dot product there.";
    }
    Wrong ParticleHalfPlane {
        HalfPlaneEmpty "ph-empty": "The particle-half-plane detection is left empty: it never asks the root finder.";
        HalfPlaneZero "ph-zero": "The particle-half-plane coefficients are left at zero.";
        HalfPlaneNoNormalSquare "ph-no-normal-square": "The radius term is not multiplied by n.n, which is right for unit normals only.";
        HalfPlaneNormalLength "ph-normal-length": "The radius term is multiplied by the length of n, not by n.n.";
        HalfPlaneRadiusNotSquared "ph-radius-not-squared": "The radius is not squared.";
        HalfPlaneNoRadius "ph-no-radius": "The radius is forgotten.";
        HalfPlaneDiameter "ph-diameter": "The diameter stands where the radius belongs.";
        HalfPlaneNoTwo "ph-no-two": "The linear coefficient of the overlap lacks its factor 2.";
        HalfPlaneLinearSign "ph-linear-sign": "The linear coefficient of the overlap has the wrong sign.";
        HalfPlaneQuadraticSign "ph-quadratic-sign": "The quadratic coefficient of the overlap has the wrong sign.";
        HalfPlaneNoQuadratic "ph-no-quadratic": "The quadratic coefficient of the overlap is missing.";
        HalfPlaneConstantSign "ph-constant-sign": "The distance is added to the radius instead of subtracted.";
        HalfPlaneOffsetNotSquared "ph-offset-not-squared": "The constant coefficient has the distance where its square belongs.";
        HalfPlaneNoPoint "ph-no-point": "The half-plane's point is forgotten, as if it went through the origin.";
        HalfPlaneEndPosition "ph-end-position": "The formulas start from the position at the end of the step.";
        HalfPlaneReversedOffset "ph-reversed-offset": "The vector from the particle to the half-plane is taken the other way round.";
        HalfPlaneApproachNoSpeed "ph-approach-no-speed": "The approach lacks the factor (dx.n), so it is right on one side only.";
        HalfPlaneApproachNegated "ph-approach-negated": "The approach has the wrong sign, so only separating particles collide.";
        HalfPlaneApproachSlopeSign "ph-approach-slope-sign": "The approach's slope has the wrong sign.";
        HalfPlaneApproachSpeedOnly "ph-approach-speed-only": "The approach looks at the velocity alone, not at the side.";
        HalfPlaneNoApproach "ph-no-approach": "The approach is not tested: a constant stands in its place.";
    }
    Wrong Handover {
        HandoverLowestFirst "handover-lowest-first": "All coefficients are handed over lowest power first.";
        HandoverNegated "handover-negated": "All polynomials are handed over negated.";
        HandoverSwapped "handover-swapped": "The first two polynomials of each pair are handed over in the wrong order.";
        HandoverAlphaSwapped "handover-alpha-swapped": "alpha > 0 and alpha < 1 are handed over in the wrong order.";
        HandoverZeros "handover-zeros": "Every coefficient of every polynomial is zero.";
        HandoverSinglePrecision "handover-single-precision": "The coefficients are stored as float before they are handed over.";
        HandoverPositionOnly "handover-position-only": "Only the polynomials about position are handed over, not the approach.";
        HandoverApproachOnly "handover-approach-only": "Only the approach is handed over, nothing about position.";
        HandoverMonic "handover-monic": "Each polynomial is divided by its leading coefficient, which turns the inequality round where that is negative.";
    }
    Wrong ContactVector {
        ParticleParticleContactAtStart "pp-contact-at-start": "The contact vector is taken at the start of the step.";
        ParticleParticleContactAtEnd "pp-contact-at-end": "The contact vector is taken at the end of the step.";
        ParticleParticleContactReversed "pp-contact-reversed": "The contact vector points from the second particle to the first.";
        ParticleParticleContactFirstStill "pp-contact-first-still": "The contact vector forgets that the first particle moves.";
        ParticleEdgeContactAtStart "pe-contact-at-start": "The contact vector is taken at the start of the step.";
        ParticleEdgeContactAlphaAtStart "pe-contact-alpha-at-start": "The contact vector uses alpha at the start of the step.";
        ParticleEdgeContactAlphaAtEnd "pe-contact-alpha-at-end": "The contact vector uses alpha at the end of the step.";
        ParticleEdgeContactClamped "pe-contact-clamped": "alpha is clamped to the edge for the contact vector.";
        ParticleEdgeContactAlphaMiddle "pe-contact-alpha-middle": "The contact vector goes to the middle of the edge.";
        ParticleEdgeContactFirstEnd "pe-contact-first-end": "The contact vector goes to the first endpoint.";
        ParticleEdgeContactFromOtherEnd "pe-contact-other-end": "alpha is measured from the second endpoint.";
        ParticleEdgeContactReversed "pe-contact-reversed": "The contact vector points from the edge to the particle.";
        ParticleEdgeContactParticleStill "pe-contact-particle-still": "The contact vector forgets that the particle moves.";
        ParticleEdgeContactEdgeStill "pe-contact-edge-still": "The contact vector forgets that the edge moves.";
        HalfPlaneContactUndivided "ph-contact-undivided": "The contact vector is not divided by n.n.";
        HalfPlaneContactDividedByLength "ph-contact-divided-by-length": "The contact vector is divided by the length of n, not by n.n.";
        HalfPlaneContactIsNormal "ph-contact-is-normal": "The half-plane's normal is returned as the contact vector.";
        HalfPlaneContactReversed "ph-contact-reversed": "The contact vector points from the half-plane to the particle.";
        HalfPlaneContactAtStart "ph-contact-at-start": "The contact vector is taken at the start of the step.";
        HalfPlaneContactAtEnd "ph-contact-at-end": "The contact vector is taken at the end of the step.";
        HalfPlaneContactToPoint "ph-contact-to-point": "The contact vector goes to the half-plane's point, not to the closest one.";
        ContactUnitLength "contact-unit-length": "Contact vectors are normalised to unit length.";
        ContactNoise "contact-noise": "Contact vectors are wrong by one part in ten million.";
        ContactTimeZero "contact-time-zero": "The time of impact is always returned as 0.";
    }
    Wrong Decision {
        DecisionOpenEnd "decision-open-end": "An impact at the very end of the step (t = 1) does not count.";
        DecisionOpenStart "decision-open-start": "An impact at the very start of the step (t = 0) does not count.";
        DecisionOpenInterval "decision-open-interval": "The time interval is open at both ends: 0 < t < 1.";
        DecisionNoUpperBound "decision-no-upper-bound": "Any finite time of impact counts, also after the step.";
        DecisionSeconds "decision-seconds": "The time of impact is compared with the step size, as if it were in seconds.";
        DecisionHalfStep "decision-half-step": "Only impacts in the first half of the step count.";
        DecisionNever "decision-never": "The root finder is asked, but a collision is never reported.";
        DecisionOverlapAtEnd "decision-overlap-at-end": "A collision counts only if the objects still overlap at the end of the step.";
        DecisionOverlapAtStart "decision-overlap-at-start": "Objects that overlap at the start of the step are let through.";
        DecisionAlphaAtStart "decision-alpha-at-start": "Rejects the impact when alpha is outside [0, 1] at the start of the step.";
        DecisionAlphaAtEnd "decision-alpha-at-end": "Rejects the impact when alpha is outside [0, 1] at the end of the step.";
        DecisionAlphaMargin "decision-alpha-margin": "Rejects impacts close to the edge's ends.";
        DecisionHalfPlaneOneSided "decision-half-plane-one-sided": "A half-plane stops particles from the side of its normal's back only.";
        PairsBothOrders "pairs-both-orders": "Each pair of particles is looked at twice.";
        PairsNeighboursOnly "pairs-neighbours-only": "A particle is tested only against the next one in the list.";
        PairsEndpointsToo "pairs-endpoints-too": "Edges are tested against their own endpoints.";
        PairsFixedSkipped "pairs-fixed-skipped": "Pairs of fixed objects are skipped, so their polynomials are missing.";
        PairsPruned "pairs-pruned": "Distant particles are sorted out by bounding circles, so their polynomials are missing.";
        PairsFirstHalfPlaneOnly "pairs-first-half-plane-only": "Only the first half-plane is looked at.";
        PairsHalfPlanesFirst "pairs-half-planes-first": "Half-planes are looked at before everything else.";
    }
    Wrong Response {
        ResponseSign "response-sign": "The impulse pulls the objects together.";
        ResponseHalved "response-halved": "The impulse lacks its factor 2.";
        ResponseNoRestitution "response-no-restitution": "The coefficient of restitution is taken as 1.";
        ResponseInelastic "response-inelastic": "The coefficient of restitution is taken as 0.";
        ResponseRestitutionOnly "response-restitution-only": "The factor is COR / 2 where (1 + COR) / 2 belongs.";
        ResponseNotNormalised "response-not-normalised": "The impulse uses the contact vector without normalising it.";
        ResponseEndVelocity "response-end-velocity": "The impulse uses the velocity at the end of the step, not the mean velocity of the motion.";
        ResponseVelocitiesOnly "response-velocities-only": "Only velocities change, not positions.";
        ResponsePositionsOnly "response-positions-only": "Only positions change, not velocities.";
        ResponsePositionNoStep "response-position-no-step": "The change of position is not multiplied by the step size.";
        ResponseMassesSwapped "response-masses-swapped": "The masses of two particles are exchanged.";
        ResponseEqualMasses "response-equal-masses": "The impulse between two particles ignores their masses.";
        ResponseFixedMassFinite "response-fixed-mass-finite": "A fixed particle counts with its own mass, not as infinitely heavy.";
        ResponseMovesFixed "response-moves-fixed": "Fixed particles are moved.";
        ResponseFirstOnly "response-first-only": "Only the first object of a pair is pushed.";
        ResponseEdgeAtStart "response-edge-at-start": "alpha of the response is computed at the start of the step.";
        ResponseEdgeMiddle "response-edge-middle": "The impulse is shared equally between the edge's endpoints.";
        ResponseEdgeSwapped "response-edge-swapped": "The endpoints' shares of the impulse are exchanged.";
        ResponseEdgeStill "response-edge-still": "The edge's own velocity is forgotten.";
        ResponseOneEndpoint "response-one-endpoint": "The second endpoint of the edge is not pushed.";
        ResponseHalfPlaneHalved "response-half-plane-halved": "The impulse of a half-plane is half of what it should be.";
        ResponseHalfPlaneSparesFixed "response-half-plane-spares-fixed": "Half-planes let fixed particles pass, unlike the course's program.";
    }
    Wrong ContinuousTime {
        ContinuousDetectAllFirst "ct-detect-all-first": "All pairs are detected before the first is resolved.";
        ContinuousOldPrediction "ct-old-prediction": "Later pairs do not see the positions that earlier impulses left.";
        ContinuousFirstOnly "ct-first-only": "Only the first collision of a step is resolved.";
        ContinuousTwoPasses "ct-two-passes": "The detection runs twice per step.";
        ContinuousNoResponse "ct-no-response": "Collisions are logged, but not resolved.";
    }
    Wrong ImpulseLoop {
        ImpulsesEmpty "loop-empty": "The impulse loop is left empty: it reports failure at once.";
        ImpulsesOneFewer "loop-one-fewer": "The impulse loop makes one round fewer than maxiters allows.";
        ImpulsesOneMore "loop-one-more": "The impulse loop makes one round more than maxiters allows.";
        ImpulsesOnlyOne "loop-only-one": "The impulse loop makes one round only, whatever maxiters says.";
        ImpulsesAlwaysTen "loop-always-ten": "The impulse loop makes up to ten rounds, whatever maxiters says.";
        ImpulsesDouble "loop-double": "The impulse loop makes twice as many rounds as maxiters allows.";
        ImpulsesCountContacts "loop-counts-contacts": "Contacts are counted against maxiters, not rounds.";
        ImpulsesDetectAfterLast "loop-detects-after-last": "A pass after the last round decides whether it succeeded.";
        ImpulsesPassWhenZero "loop-pass-when-zero": "A detection pass is made although maxiters is 0.";
        ImpulsesTestWhenZero "loop-test-when-zero": "With maxiters 0 the loop looks for collisions and reports success when it finds none.";
        ImpulsesSuccessWhenZero "loop-success-when-zero": "With maxiters 0 the loop reports success, so the geometric part never runs.";
        ImpulsesOnceWhenZero "loop-once-when-zero": "With maxiters 0 one round runs all the same.";
        ImpulsesAlwaysFail "loop-always-fails": "The loop reports failure also when nothing collides any more.";
        ImpulsesAlwaysSucceed "loop-always-succeeds": "The loop reports success also when it has run out of rounds.";
        ImpulsesInverted "loop-inverted": "Success and failure are exchanged.";
        ImpulsesFromPrediction "loop-from-prediction": "Every round computes its impulses from the integrator's prediction, not from the last round's result.";
        ImpulsesResultNotAccumulated "loop-not-accumulated": "Every round applies its impulses to the integrator's prediction, which drops the rounds before.";
        ImpulsesOneByOne "loop-one-by-one": "Each impulse of a round is computed from the positions that the one before left.";
        ImpulsesLastWins "loop-last-wins": "The impulses of a round overwrite one another instead of adding up.";
        ImpulsesFirstOnly "loop-first-only": "Only the first collision of a round is resolved.";
        ImpulsesLastOnly "loop-last-only": "Only the last collision of a round is resolved.";
        ImpulsesStartAdvances "loop-start-advances": "Later rounds detect from the last round's positions, not from the start of the step.";
        ImpulsesCapped "loop-capped": "Changes of velocity are capped.";
        ImpulsesReset "loop-reset": "When the rounds run out, positions and velocities are reset to the prediction.";
        ImpulsesVelocityRestored "loop-velocity-restored": "The loop keeps its positions but restores the predicted velocities.";
        ImpulsesPositionsRestored "loop-positions-restored": "The loop keeps its velocities but restores the predicted positions.";
    }
    Wrong ImpactZones {
        GeometricEmpty "geometric-empty": "The geometric part is left empty.";
        GeometricOneRound "geometric-one-round": "Zones never grow: the loop ends after the first round.";
        GeometricTwoRounds "geometric-two-rounds": "Zones grow only once.";
        GeometricRestarts "geometric-restarts": "Every round starts again from the predicted positions.";
        GeometricDetectsPrediction "geometric-detects-prediction": "Later passes look at the predicted positions, not at the modified ones.";
        GeometricForgetsZones "geometric-forgets-zones": "New zones replace the old ones instead of joining them.";
        GeometricStopsWhenEmpty "geometric-stops-when-empty": "Without zones the second pass is left out.";
        GeometricExtraPass "geometric-extra-pass": "One more detection pass is made after the zones have settled.";
        GeometricFirstZoneOnly "geometric-first-zone-only": "Only the first zone is moved.";
        ZonesOneEndpoint "zones-one-endpoint": "A zone of a particle and an edge holds only one of the endpoints.";
        ZonesEdgeIndex "zones-edge-index": "A zone of a particle and an edge holds the edge's index, as if it were a particle's.";
        ZonesEdgeWithoutParticle "zones-edge-without-particle": "A zone of a particle and an edge lacks the particle.";
        ZonesNotMerged "zones-not-merged": "Zones that share particles are not merged.";
        ZonesMergedOnce "zones-merged-once": "Zones are merged in one sweep, which may leave some that share particles.";
        ZonesAllInOne "zones-all-in-one": "All colliding particles become one zone.";
        ZonesJoinOneParticle "zones-join-one-particle": "Merging takes over only one particle of the second zone.";
        ZonesNoHalfPlaneFlag "zones-no-flag": "The half-plane flag is never set.";
        ZonesFlagLost "zones-flag-lost": "Merging keeps the first zone's half-plane flag and loses the second's.";
        ZonesFlagOverwritten "zones-flag-overwritten": "Merging overwrites the half-plane flag with the second zone's.";
        ZonesFlagBoth "zones-flag-both": "A merged zone keeps the half-plane flag only if both had it.";
        ZonesEqualByCount "zones-equal-by-count": "Two lists of zones count as equal when they are equally long.";
        ZonesEqualBySize "zones-equal-by-size": "Two zones count as equal when they hold equally many particles.";
        ZonesEqualNoFlag "zones-equal-no-flag": "The comparison of zones ignores the half-plane flag.";
    }
    Wrong Failsafe {
        FailsafeEmpty "failsafe-empty": "The failsafe is left empty.";
        FailsafeCentreUnweighted "failsafe-centre-unweighted": "The centre of mass is not weighted with the masses.";
        FailsafeCentreAtEnd "failsafe-centre-at-end": "The centre of mass is taken at the end of the step.";
        FailsafeNoCentre "failsafe-no-centre": "The centre of mass is not added back.";
        FailsafeMomentumUnweighted "failsafe-momentum-unweighted": "The momentum is not weighted with the masses.";
        FailsafeMomentumVelocity "failsafe-momentum-velocity": "The momentum is made of velocities where displacements belong.";
        FailsafeNoTranslation "failsafe-no-translation": "The centre of mass does not move.";
        FailsafeAngularUnweighted "failsafe-angular-unweighted": "The angular momentum is not weighted with the masses.";
        FailsafeAngularOverwritten "failsafe-angular-overwritten": "The angular momentum is overwritten instead of summed.";
        FailsafeAngularDoubled "failsafe-angular-doubled": "The angular momentum is overwritten, then doubled.";
        FailsafeCrossSum "failsafe-cross-sum": "The cross product adds its two products.";
        FailsafeDotProduct "failsafe-dot-product": "A dot product stands where the cross product belongs.";
        FailsafeAboutOrigin "failsafe-about-origin": "The rotation is taken about the origin, not about the centre of mass.";
        FailsafeInertiaUnweighted "failsafe-inertia-unweighted": "The moment of inertia is not weighted with the masses.";
        FailsafeInertiaDistance "failsafe-inertia-distance": "The moment of inertia has distances that are not squared.";
        FailsafeInertiaAboutOrigin "failsafe-inertia-about-origin": "The moment of inertia is taken about the origin.";
        FailsafeNoInertia "failsafe-no-inertia": "The angular momentum is not divided by the moment of inertia.";
        FailsafeRotationSign "failsafe-rotation-sign": "The body turns the wrong way.";
        FailsafeNoRotation "failsafe-no-rotation": "The body does not turn.";
        FailsafeSmallAngle "failsafe-small-angle": "Sine and cosine are replaced by their values for small angles.";
        FailsafeDegrees "failsafe-degrees": "The angle is converted to degrees before sine and cosine.";
        FailsafeAnglePerStep "failsafe-angle-per-step": "The angle is multiplied by the step size once too often.";
        FailsafePerpendicular "failsafe-perpendicular": "The perpendicular of (a, b) is taken as (b, a).";
        FailsafeTurnsEnd "failsafe-turns-end": "The predicted end positions are turned, not the start positions.";
        FailsafeMassIndex "failsafe-mass-index": "The mass is read at the particle's index, although the array holds every mass twice.";
        FailsafeFixedForgotten "failsafe-fixed-forgotten": "The rule for fixed particles is forgotten.";
        FailsafeHalfPlaneForgotten "failsafe-half-plane-forgotten": "The rule for half-planes is forgotten.";
        FailsafeAllFixedOnly "failsafe-all-fixed-only": "A zone stops only if all of its particles are fixed.";
        FailsafeAlwaysStops "failsafe-always-stops": "Every zone stops, also without anything fixed.";
        FailsafeStopsFixedOnly "failsafe-stops-fixed-only": "In a zone that has to stop, only the fixed particles do.";
        FailsafeStopKeepsPosition "failsafe-stop-keeps-position": "A stopped zone loses its velocity but keeps its end positions.";
        FailsafeStopKeepsVelocity "failsafe-stop-keeps-velocity": "A stopped zone goes back to its start but keeps its velocity.";
        FailsafeVelocityKept "failsafe-velocity-kept": "A moved zone keeps its old velocities.";
        FailsafeVelocityNoStep "failsafe-velocity-no-step": "The new velocity is not divided by the step size.";
        FailsafeVelocityFromPrediction "failsafe-velocity-from-prediction": "The new velocity is measured from the predicted position.";
        FailsafeVelocityOfCentre "failsafe-velocity-of-centre": "All particles of a zone get the velocity of its centre.";
    }
    Wrong Trace {
        LogLowestFirst "log-lowest-first": "The logged coefficients are lowest power first.";
        LogNegated "log-negated": "The logged coefficients are negated.";
        LogNan "log-nan": "All logged coefficients are not a number.";
        LogTiny "log-tiny": "All logged coefficients are 1e-11.";
        LogZeros "log-zeros": "All logged coefficients are zero.";
        LogSwapped "log-swapped": "Each two neighbouring polynomials are logged in the wrong order.";
        LogTrailingZero "log-trailing-zero": "Every logged polynomial has a zero too many at the end.";
        LogRounded "log-rounded": "Logged coefficients are rounded to six digits.";
        LogPolynomialsKept "log-polynomials-kept": "The list of polynomials is never emptied.";
        LogImpulsesKept "log-impulses-kept": "The list of impulses is never emptied.";
        LogNoImpulses "log-no-impulses": "Impulses are applied but not logged.";
        LogDuplicateImpulses "log-duplicate-impulses": "Every impulse is logged twice.";
        LogNanContacts "log-nan-contacts": "The logged contact vectors are not numbers.";
        LogHybridImpulses "log-hybrid-impulses": "The impulse rounds of hybrid scenes log impulses, which the course's program does not.";
        LogMidIsEnd "log-mid-is-end": "The record in the middle of a step already holds its end.";
        LogNoMid "log-no-mid": "The record in the middle of a step is missing.";
        LogNoInitial "log-no-initial": "The initial record is missing.";
        LogSinglePrecision "log-single-precision": "Positions and velocities are logged as float.";
        LogPadded "log-padded": "Every logged polynomial has a leading zero, which the course's library never writes.";
    }
    Variant Handover {
        ScaleTwo "scale-2": "All polynomials are multiplied by 2.";
        ScaleHalf "scale-half": "All polynomials are multiplied by 0.5.";
        ScaleThree "scale-3": "All polynomials are multiplied by 3.";
        ScaleThousand "scale-1000": "All polynomials are multiplied by 1000.";
        ScaleMillionth "scale-1e-6": "All polynomials are multiplied by 1e-6, so the course's root finder drops more of their small coefficients.";
        ScaleParticleParticleTwo "scale-pp-2": "Particle-particle polynomials are multiplied by 2.";
        ScaleParticleEdgeThree "scale-pe-3": "Particle-edge polynomials are multiplied by 3.";
        ScaleHalfPlaneThree "scale-ph-3": "Particle-half-plane polynomials are multiplied by 3.";
    }
    Variant ParticleParticle {
        RearrangedParticleParticle "rearranged-pp": "The overlap is multiplied out into coordinates; the relative velocity is the negative of the relative displacement.";
    }
    Variant ParticleEdge {
        RearrangedParticleEdge "rearranged-pe": "The quartic's terms are put into other parentheses.";
        FactorisedQuartic "factorised-quartic": "The quartic comes from the cross product: R^2 e.e - (e x w)^2.";
        FactorisedAll "factorised-all": "All four polynomials come from three quadratics, the approach mathematically right.";
        InterpolatedQuartic "interpolated-quartic": "The quartic is interpolated from its values at five times.";
        QuinticRight "quintic-right": "The approach is derived anew, with the right t^3 coefficient.";
        QuinticRightRearranged "quintic-mended": "The course's quintic with its one wrong letter put right.";
    }
    Variant ParticleHalfPlane {
        RearrangedHalfPlane "rearranged-ph": "The overlap's constant is a product of sum and difference.";
        HalfPlaneUnitNormal "unit-normal": "The half-plane's normal is normalised first.";
    }
    Variant ContactVector {
        WideArithmetic "wide-arithmetic": "The overlaps are computed in twice the precision and rounded at the end.";
        ContactOtherFormula "contact-other-formula": "The contact vectors come from other, equivalent formulas.";
    }
    Variant ImpactZones {
        GeometricStopsWhenClear "stops-when-clear": "The geometric loop also ends when a pass finds nothing; the zones would be equal anyway.";
        ZonesReversed "zones-reversed": "Zones are moved in the opposite order, which changes nothing.";
    }
    Variant Failsafe {
        FailsafeMomentumFromEnd "momentum-from-end": "The angular momentum uses end positions about the centre; what the start adds is parallel to its arm.";
        FailsafeWholeDisplacement "whole-displacement": "The angular momentum uses whole displacements; the centre's part cancels.";
        FailsafeRotationMatrix "rotation-matrix": "The rotation is written as a matrix, and the sum in another order.";
    }
    Variant Trace {
        LogImpulsesReversed "impulses-reversed": "The impulses of a step are logged in the opposite order.";
    }
    Hostile Process {
        HostileExitOne "exit-one": "Ends with status 1 after a correct trace.";
        HostileExitMidway "exit-midway": "Ends with status 3 in mid-run, after flushing its trace.";
        HostileCrash "crash-midway": "Aborts in mid-run.";
        HostileLoop "endless-loop": "Computes for ever in mid-run.";
        HostileSleep "sleep-forever": "Sleeps for ever in mid-run.";
        HostileFloodStdout "flood-stdout": "Writes 256 MiB to standard output.";
        HostileFloodStderr "flood-stderr": "Writes 256 MiB to standard error.";
        HostileFloodTrace "flood-trace": "Writes 256 MiB to the trace after its end.";
        HostileEscapes "escape-codes": "Writes terminal escape codes, markup and a spreadsheet formula on standard error.";
        HostileForgedVerdict "forged-verdict": "Prints a passing verdict of the original oracle, and does wrong physics.";
        HostileTrailingBytes "trailing-bytes": "Appends eight bytes to a correct trace.";
        HostileTruncated "truncated-trace": "Stops writing in the middle of a record, and ends with status 0.";
        HostileNoOutput "no-output": "Ends at once with status 0 and writes no trace.";
        HostileEmptyTrace "empty-trace": "Creates the trace file and writes nothing.";
        HostileHugeCounts "huge-counts": "Claims two billion polynomials in each record.";
        HostileNegativeCounts "negative-counts": "Claims -1 polynomials in each record.";
        HostileNanState "nan-state": "Logs positions that are not numbers from mid-run on.";
        HostileChildren "leaves-children": "Starts three copies of itself that outlive it for a minute.";
        HostileMemory "hog-memory": "Allocates and fills 4 GiB of memory.";
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn ids_are_unique_and_kebab_case() {
        let ids: BTreeSet<&str> = CATALOGUE.iter().map(|row| row.id).collect();
        assert_eq!(ids.len(), CATALOGUE.len());
        for id in ids {
            assert!(id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'), "{id}");
            assert_eq!(find(id).map(|row| row.id), Some(id));
        }
    }

    #[test]
    fn every_explanation_is_one_sentence_and_distinct_within_its_area() {
        for (index, row) in CATALOGUE.iter().enumerate() {
            assert!(row.explanation.ends_with('.'), "{}", row.id);
            let prefix = |id: &'static str| id.split('-').next();
            let twin = CATALOGUE[..index]
                .iter()
                .find(|other| other.explanation == row.explanation && prefix(other.id) == prefix(row.id));
            assert!(twin.is_none(), "{} explains the same as {}", row.id, twin.map_or("", |row| row.id));
        }
    }
}
