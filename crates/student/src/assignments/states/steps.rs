//! Mistakes in the forces and their derivatives, the integrators, the penalty force and the search for its pairs,
//! and the simple responses (simulation.md 2 to 4, collisions.md 6).
use super::{super::rows::rows, terms::Edit};

rows! {
    /// A difference between a student's program and the reference in the computation of a step's states.
    StepMistake STEPS [Edit Edit] []
    Wrong Forces "steps.txt" {
        DragQuadratic "drag-quadratic";
        DragSquares "drag-squares";
        DragOfPositions "drag-of-positions";
        SpringNoStiffness "spring-no-stiffness";
        SpringNoRestLength "spring-no-rest-length";
        SpringRestLengthSign "spring-rest-length-sign";
        SpringStrain "spring-strain";
        SpringRestLengthInteger "spring-rest-length-integer";
        SpringPullsOnly "spring-pulls-only";
        SpringDirection "spring-direction";
        SpringDirectionEverywhere "spring-direction-everywhere";
        SpringDampingNoCoefficient "spring-damping-no-coefficient";
        SpringDampingAllDirections "spring-damping-all-directions";
        SpringDampingOneVelocity "spring-damping-one-velocity";
        SpringDampingFirstVelocity "spring-damping-first-velocity";
        SpringDampingSpeed "spring-damping-speed";
        SpringDampingVelocitySum "spring-damping-velocity-sum";
        GravitationNoMasses "gravitation-no-masses";
        GravitationOwnMass "gravitation-own-mass";
        GravitationOtherMass "gravitation-other-mass";
        GravitationMassSum "gravitation-mass-sum";
        GravitationMassIndex "gravitation-mass-index";
        GravitationNoConstant "gravitation-no-constant";
    }
    Wrong Jacobians {
        JacobianElasticNoProjection "jacobian-elastic-no-projection";
        JacobianElasticNoRestLength "jacobian-elastic-no-rest-length";
        JacobianElasticStrain "jacobian-elastic-strain";
        JacobianElasticDirection "jacobian-elastic-direction";
        JacobianDampingNoProjection "jacobian-damping-no-projection";
        JacobianDampingDirection "jacobian-damping-direction";
        JacobianVelocityIdentity "jacobian-velocity-identity";
        JacobianGravitationNoThree "jacobian-gravitation-no-three";
        JacobianGravitationDirection "jacobian-gravitation-direction";
    }
    Wrong Integrator {
        LinearForcesAtStart "linear-forces-at-start";
        LinearMatrixAtStart "linear-matrix-at-start";
        LinearAllAtStart "linear-all-at-start";
        LinearVelocitiesTwice "linear-velocities-twice";
        LinearIterates "linear-iterates";
        ImplicitPositionsKept "implicit-positions-kept";
        ImplicitVelocitiesKept "implicit-velocities-kept";
    }
    Wrong Penalty {
        PenaltyBothOrders "penalty-both-orders";
        PenaltyFirstHalfPlaneOnly "penalty-first-half-plane-only";
    }
    Wrong NearPairs {
        NearPairsFirstMissing "near-pairs-first-missing";
        NearPairsLastMissing "near-pairs-last-missing";
        NearPairsLastEdgeMissing "near-pairs-last-edge-missing";
        NearPairsLastHalfPlaneMissing "near-pairs-last-half-plane-missing";
        NearPairsDoubled "near-pairs-doubled";
        NearPairsEdgesDoubled "near-pairs-edges-doubled";
        NearPairsHalfPlanesDoubled "near-pairs-half-planes-doubled";
        NearPairsNeighborsOnly "near-pairs-neighbors-only";
        NearPairsBoxesOfPoints "near-pairs-boxes-of-points";
        NearPairsEdgeEnds "near-pairs-edge-ends";
        NearPairsEdgeFirstEnd "near-pairs-edge-first-end";
        NearPairsOfStart "near-pairs-of-start";
        NearPairsOfLastStep "near-pairs-of-last-step";
        NearPairsFixedSkipped "near-pairs-fixed-skipped";
    }
}
