//! Mistakes of the forces and their derivatives, of the integrators, of the penalty force, of finding its pairs, and of
//! simple responses (simulation.md 2 to 4, collisions.md 6).
use super::{super::rows::rows, terms::Edit};

rows! {
    /// A difference of a program in a step.
    StepMistake STEPS [Edit Edit] []
    Wrong Forces {
        DragQuadratic "drag-quadratic": "Drag is multiplied by the speed."
            => "-b |v_i| v_i is used instead of -b v_i.";
        DragOfPositions "drag-of-positions": "Drag is computed from the positions instead of the velocities."
            => "-b x_i is used instead of -b v_i.";
        SpringNoStiffness "spring-no-stiffness": "The elastic part of the spring force ignores the stiffness."
            => "(l - l0) n is used instead of k (l - l0) n.";
        SpringNoRestLength "spring-no-rest-length": "The elastic part of the spring force ignores the rest length."
            => "k l n is used instead of k (l - l0) n.";
        SpringRestLengthSign "spring-rest-length-sign":
            "The rest length of a spring is added instead of subtracted."
            => "k (l + l0) n is used instead of k (l - l0) n.";
        SpringStrain "spring-strain": "The elastic part of the spring force is divided by the rest length."
            => "k (l - l0) / l0 n is used instead of k (l - l0) n.";
        SpringDirection "spring-direction": "The direction of a spring is never normalized."
            => "d = x_b - x_a is used instead of n = d / |d| in the elastic part and in the damping; \
            normalized() returns the unit vector and leaves d as it is, normalize() changes d.";
        SpringDirectionEverywhere "spring-direction-everywhere":
            "The direction of a spring is never normalized, in the force as in its derivatives."
            => "d = x_b - x_a is used instead of n = d / |d| in the force and its Hessians; normalized() \
            returns the unit vector and leaves d as it is, normalize() changes d.";
        SpringDampingNoCoefficient "spring-damping-no-coefficient": "The damping of a spring ignores its coefficient."
            => "(n . (v_b - v_a)) n is used instead of b (n . (v_b - v_a)) n.";
        SpringDampingAllDirections "spring-damping-all-directions":
            "The damping of a spring acts on the whole relative velocity, not on its part along the spring."
            => "b (v_b - v_a) is used instead of b (n . (v_b - v_a)) n.";
        SpringDampingOneVelocity "spring-damping-one-velocity":
            "The damping of a spring uses only the velocity of its second end."
            => "b (n . v_b) n is used instead of b (n . (v_b - v_a)) n.";
        SpringDampingFirstVelocity "spring-damping-first-velocity":
            "The damping of a spring uses only the velocity of its first end."
            => "b (n . v_a) n, with either sign, is used instead of b (n . (v_b - v_a)) n.";
        SpringDampingVelocitySum "spring-damping-velocity-sum":
            "The damping of a spring adds the velocities of its ends."
            => "b (n . (v_b + v_a)) n is used instead of b (n . (v_b - v_a)) n.";
        GravitationNoMasses "gravitation-no-masses": "The gravitational force ignores the masses."
            => "G / r^2 n is used instead of G m1 m2 / r^2 n.";
        GravitationOwnMass "gravitation-own-mass": "The gravitational force has the first mass twice."
            => "G m1 m1 / r^2 n is used instead of G m1 m2 / r^2 n.";
        GravitationOtherMass "gravitation-other-mass": "The gravitational force has the second mass twice."
            => "G m2 m2 / r^2 n is used instead of G m1 m2 / r^2 n.";
        GravitationNoConstant "gravitation-no-constant": "The gravitational force ignores its constant."
            => "m1 m2 / r^2 n is used instead of G m1 m2 / r^2 n.";
    }
    Wrong Jacobians {
        JacobianElasticNoProjection "jacobian-elastic-no-projection":
            "In the second derivatives of a spring's elastic part the term across the spring acts along it, too."
            => "(l - l0) / l I is used instead of (l - l0) / l (I - n n^T).";
        JacobianElasticNoRestLength "jacobian-elastic-no-rest-length":
            "The second derivatives of a spring's elastic part ignore the rest length."
            => "k I is used instead of k (n n^T + (l - l0) / l (I - n n^T)), since l / l is used \
            instead of (l - l0) / l.";
        JacobianElasticStrain "jacobian-elastic-strain":
            "In the derivatives of a spring's elastic part the stretch is divided by the rest length."
            => "(l - l0) / l0 is used instead of (l - l0) / l.";
        JacobianElasticDirection "jacobian-elastic-direction":
            "The direction in the second derivatives of a spring's elastic part is not normalized."
            => "d d^T is used instead of n n^T, with d = x_b - x_a and n = d / |d|.";
        JacobianDampingNoProjection "jacobian-damping-no-projection":
            "The derivatives of a spring's damping by positions are not projected across the spring."
            => "(I - n n^T) is missing behind n w^T + (n . w) I, with w = v_b - v_a.";
        JacobianDampingDirection "jacobian-damping-direction":
            "The direction in the derivatives of a spring's damping by positions is not normalized."
            => "d is used instead of n = d / |d| in n w^T, n . w and n n^T.";
        JacobianVelocityIdentity "jacobian-velocity-identity":
            "The derivatives of a spring's damping by velocities act in all directions, not along the spring."
            => "b I is used instead of b n n^T.";
        JacobianGravitationNoThree "jacobian-gravitation-no-three":
            "The second derivatives of the gravitational force lack a factor."
            => "I - n n^T is used instead of I - 3 n n^T.";
        JacobianGravitationDirection "jacobian-gravitation-direction":
            "The direction in the second derivatives of the gravitational force is not normalized."
            => "d d^T is used instead of n n^T, with d = x_b - x_a and n = d / |d|.";
    }
    Wrong Integrator {
        LinearForcesAtStart "linear-forces-at-start":
            "The forces are computed at the start of the step, not at the predicted positions."
            => "F(x, v) is used instead of F(x + h v, v).";
        LinearMatrixAtStart "linear-matrix-at-start":
            "The matrix is computed at the start of the step, not at the predicted positions."
            => "A(x, v) is used instead of A(x + h v, v).";
        LinearAllAtStart "linear-all-at-start":
            "Forces and matrix are computed at the start of the step, not at the predicted positions."
            => "x is used instead of x + h v.";
        LinearVelocitiesTwice "linear-velocities-twice":
            "Forces and matrix are computed with twice the velocity, which is passed as its own change."
            => "F(x + h v, 2 v) is used instead of F(x + h v, v): the change of velocities that is passed should be 0.";
        LinearIterates "linear-iterates":
            "The linearized step is repeated until nothing changes, instead of being solved once."
            => "Newton's loop is used instead of one solve of A dv = h F.";
        ImplicitPositionsKept "implicit-positions-kept": "Newton's method never moves its positions."
            => "dx = h (v + dv) is missing: dx stays h v.";
        ImplicitVelocitiesKept "implicit-velocities-kept":
            "Newton's method computes forces with the velocities at the start of the step."
            => "F(x + dx, v) is used instead of F(x + dx, v + dv).";
    }
    Wrong Penalty {
        PenaltyBothOrders "penalty-both-orders": "The penalty force is added for each pair of particles in both orders."
            => "j runs over all particles; it begins at j = i + 1.";
        PenaltyFirstHalfPlaneOnly "penalty-first-half-plane-only":
            "The penalty force is computed for the first half-plane only."
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
        NearPairsNeighborsOnly "near-pairs-neighbors-only": "The sweep compares a particle with the next one only."
            => "The sweep goes on until the next body begins behind this one's end.";
        NearPairsBoxesOfPoints "near-pairs-boxes-of-points": "The bounding boxes of particles lack their radius."
            => "Boxes from x to x are compared instead of boxes from x - r to x + r.";
        NearPairsEdgeEnds "near-pairs-edge-ends": "Edges are searched near their ends only."
            => "The box must hold the whole edge.";
        NearPairsEdgeFirstEnd "near-pairs-edge-first-end": "Edges are searched near their first end only."
            => "The box must hold both ends.";
        NearPairsOfStart "near-pairs-of-start": "Pairs are searched at the scene's first positions in every step."
            => "The positions at the scene's start are used instead of x.";
        NearPairsOfLastStep "near-pairs-of-last-step": "Pairs are searched at the positions of the step before."
            => "x - h v is used instead of x: the boxes are not brought up to date.";
        NearPairsFixedSkipped "near-pairs-fixed-skipped": "Pairs with a fixed particle are left out."
            => "A fixed particle pushes others, too.";
    }
}
