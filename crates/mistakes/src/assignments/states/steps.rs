//! Mistakes of the forces and their derivatives, of the integrators, of the penalty force, of finding its pairs, and of
//! simple responses (simulation.md 2 to 4, collisions.md 6).
use super::{super::rows::rows, terms::Edit};

rows! {
    /// Something that a program does differently in a step.
    StepMistake STEPS [Edit Edit]
    Wrong Forces {
        DragQuadratic "drag-quadratic": "Drag is multiplied by the speed."
            => "-b |v_i| v_i stands where -b v_i belongs.";
        DragOfPositions "drag-of-positions": "Drag is computed from the positions instead of the velocities."
            => "-b x_i is used instead of -b v_i.";
        SpringNoStiffness "spring-no-stiffness": "The elastic part of the spring force ignores the stiffness."
            => "(l - l0) n stands where k (l - l0) n belongs.";
        SpringNoRestLength "spring-no-rest-length": "The elastic part of the spring force ignores the rest length."
            => "k l n stands where k (l - l0) n belongs.";
        SpringRestLengthSign "spring-rest-length-sign":
            "The rest length of a spring is added where it is to be subtracted."
            => "k (l + l0) n stands where k (l - l0) n belongs.";
        SpringStrain "spring-strain": "The elastic part of the spring force is divided by the rest length."
            => "k (l - l0) / l0 n is used instead of k (l - l0) n.";
        SpringDirection "spring-direction": "The direction of a spring is never normalised."
            => "d = x_b - x_a stands where n = d / |d| belongs in the elastic part and in the damping; normalized() \
            returns the unit vector and leaves d as it is, normalize() changes d.";
        SpringDirectionEverywhere "spring-direction-everywhere":
            "The direction of a spring is never normalised, in the force as in its derivatives."
            => "d = x_b - x_a stands where n = d / |d| belongs in the force and its Hessians; normalized() returns the \
            unit vector and leaves d as it is, normalize() changes d.";
        SpringDampingNoCoefficient "spring-damping-no-coefficient": "The damping of a spring ignores its coefficient."
            => "(n . (v_b - v_a)) n stands where b (n . (v_b - v_a)) n belongs.";
        SpringDampingAllDirections "spring-damping-all-directions":
            "The damping of a spring acts on the whole relative velocity, not on its part along the spring."
            => "b (v_b - v_a) stands where b (n . (v_b - v_a)) n belongs.";
        SpringDampingOneVelocity "spring-damping-one-velocity":
            "The damping of a spring looks at the velocity of its second end only."
            => "b (n . v_b) n stands where b (n . (v_b - v_a)) n belongs.";
        SpringDampingFirstVelocity "spring-damping-first-velocity":
            "The damping of a spring looks at the velocity of its first end only."
            => "b (n . v_a) n, with either sign, is used instead of b (n . (v_b - v_a)) n.";
        SpringDampingVelocitySum "spring-damping-velocity-sum":
            "The damping of a spring adds the velocities of its ends."
            => "b (n . (v_b + v_a)) n stands where b (n . (v_b - v_a)) n belongs.";
        GravitationNoMasses "gravitation-no-masses": "The gravitational force ignores the masses."
            => "G / r^2 n stands where G m1 m2 / r^2 n belongs.";
        GravitationOwnMass "gravitation-own-mass": "The gravitational force has the first mass twice."
            => "G m1 m1 / r^2 n stands where G m1 m2 / r^2 n belongs.";
        GravitationOtherMass "gravitation-other-mass": "The gravitational force has the second mass twice."
            => "G m2 m2 / r^2 n is used instead of G m1 m2 / r^2 n.";
        GravitationNoConstant "gravitation-no-constant": "The gravitational force ignores its constant."
            => "m1 m2 / r^2 n stands where G m1 m2 / r^2 n belongs.";
    }
    Wrong Jacobians {
        JacobianElasticNoProjection "jacobian-elastic-no-projection":
            "In the second derivatives of a spring's elastic part the term across the spring acts along it, too."
            => "(l - l0) / l I stands where (l - l0) / l (I - n n^T) belongs.";
        JacobianElasticNoRestLength "jacobian-elastic-no-rest-length":
            "The second derivatives of a spring's elastic part ignore the rest length."
            => "k I stands where k (n n^T + (l - l0) / l (I - n n^T)) belongs, since l / l stands where (l - l0) / l \
            belongs.";
        JacobianElasticStrain "jacobian-elastic-strain":
            "In the derivatives of a spring's elastic part the stretch is divided by the rest length."
            => "(l - l0) / l0 is used instead of (l - l0) / l.";
        JacobianElasticDirection "jacobian-elastic-direction":
            "The direction in the second derivatives of a spring's elastic part is not normalised."
            => "d d^T stands where n n^T belongs, with d = x_b - x_a and n = d / |d|.";
        JacobianDampingNoProjection "jacobian-damping-no-projection":
            "The derivatives of a spring's damping by positions are not projected across the spring."
            => "(I - n n^T) is missing behind n w^T + (n . w) I, with w = v_b - v_a.";
        JacobianDampingDirection "jacobian-damping-direction":
            "The direction in the derivatives of a spring's damping by positions is not normalised."
            => "d stands where n = d / |d| belongs in n w^T, n . w and n n^T.";
        JacobianVelocityIdentity "jacobian-velocity-identity":
            "The derivatives of a spring's damping by velocities act in all directions, not along the spring."
            => "b I stands where b n n^T belongs.";
        JacobianGravitationNoThree "jacobian-gravitation-no-three":
            "The second derivatives of the gravitational force lack a factor."
            => "I - n n^T stands where I - 3 n n^T belongs.";
        JacobianGravitationDirection "jacobian-gravitation-direction":
            "The direction in the second derivatives of the gravitational force is not normalised."
            => "d d^T stands where n n^T belongs, with d = x_b - x_a and n = d / |d|.";
    }
    Wrong Integrator {
        LinearForcesAtStart "linear-forces-at-start":
            "The forces are computed at the start of the step, not at the predicted positions."
            => "F(x, v) stands where F(x + h v, v) belongs.";
        LinearMatrixAtStart "linear-matrix-at-start":
            "The matrix is computed at the start of the step, not at the predicted positions."
            => "A(x, v) stands where A(x + h v, v) belongs.";
        LinearAllAtStart "linear-all-at-start":
            "Forces and matrix are computed at the start of the step, not at the predicted positions."
            => "x stands where x + h v belongs.";
        LinearVelocitiesTwice "linear-velocities-twice":
            "Forces and matrix are computed with twice the velocity, which is passed as its own change."
            => "F(x + h v, 2 v) is used instead of F(x + h v, v): the change of velocities that is passed should be 0.";
        LinearIterates "linear-iterates":
            "The linearised step is repeated until nothing changes, where one solve belongs."
            => "Newton's loop stands where one solve of A dv = h F belongs.";
        ImplicitPositionsKept "implicit-positions-kept": "Newton's method never moves its positions."
            => "dx = h (v + dv) is missing: dx stays h v.";
        ImplicitVelocitiesKept "implicit-velocities-kept":
            "Newton's method computes forces with the velocities at the start of the step."
            => "F(x + dx, v) stands where F(x + dx, v + dv) belongs.";
    }
    Wrong Penalty {
        PenaltyBothOrders "penalty-both-orders": "The penalty force is added for each pair of particles in both orders."
            => "j runs over all particles; it begins at j = i + 1.";
        PenaltyFirstHalfPlaneOnly "penalty-first-half-plane-only":
            "The penalty force looks at the first half-plane only."
            => "The loop over half-planes ends after index 0.";
    }
    Wrong NearPairs {
        NearPairsFirstMissing "near-pairs-first-missing": "Pairs of the first particle are never found."
            => "The loop over the particles begins at i = 1.";
        NearPairsLastMissing "near-pairs-last-missing": "Pairs of the last particle are never found."
            => "The loop over the particles ends at i = N - 2.";
        NearPairsLastEdgeMissing "near-pairs-last-edge-missing": "Pairs of the last edge are never found."
            => "The loop over the edges ends at its number - 2.";
        NearPairsLastHalfPlaneMissing "near-pairs-last-half-plane-missing":
            "Pairs of the last half-plane are never found."
            => "The loop over the half-planes ends at its number - 2.";
        NearPairsDoubled "near-pairs-doubled": "Each pair is reported twice."
            => "A pair that two cells or two sweeps find counts 1 time.";
        NearPairsEdgesDoubled "near-pairs-edges-doubled": "Each pair of a particle and an edge is reported twice."
            => "A pair that two cells find counts 1 time.";
        NearPairsHalfPlanesDoubled "near-pairs-half-planes-doubled":
            "Each pair of a particle and a half-plane is reported twice."
            => "A pair counts 1 time.";
        NearPairsNeighboursOnly "near-pairs-neighbours-only": "The sweep compares a particle with the next one only."
            => "The sweep goes on until the next body begins behind this one's end.";
        NearPairsBoxesOfPoints "near-pairs-boxes-of-points": "The bounding boxes of particles lack their radius."
            => "Boxes from x to x are compared, where boxes from x - r to x + r belong.";
        NearPairsEdgeEnds "near-pairs-edge-ends": "An edge is looked for near its ends only."
            => "The box around the whole edge belongs there.";
        NearPairsEdgeFirstEnd "near-pairs-edge-first-end": "An edge is looked for near its first end only."
            => "The box around both ends belongs there.";
        NearPairsOfStart "near-pairs-of-start": "Pairs are looked for at the scene's first positions in every step."
            => "The positions at the scene's start stand where x belongs.";
        NearPairsOfLastStep "near-pairs-of-last-step": "Pairs are looked for at the positions of the step before."
            => "x - h v stands where x belongs: the boxes are not brought up to date.";
        NearPairsFixedSkipped "near-pairs-fixed-skipped": "Pairs with a fixed particle are left out."
            => "A fixed particle pushes others, too.";
    }
}
