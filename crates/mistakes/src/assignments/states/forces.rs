//! Mistakes of the forces, and of their derivatives for implicit integrators (simulation.md 2 and 3).
use super::super::rows::rows;

rows! {
    /// Something that a program does differently where it computes a force or its derivatives.
    ForceMistake FORCES []
    Wrong Forces {
        GravityMissing "gravity-missing": "Simple gravity adds nothing."
            => "m_i g is missing for every particle i.";
        GravitySign "gravity-sign": "Simple gravity acts in the wrong direction."
            => "-m_i g stands where the force m_i g belongs: the gradient is -m_i g.";
        GravityNoMass "gravity-no-mass": "Simple gravity is not multiplied by the mass."
            => "g stands where m_i g belongs.";
        GravityLastMissing "gravity-last-missing": "Simple gravity leaves the last particle out."
            => "The loop ends before i = N - 1.";
        ConstantMissing "constant-missing": "The constant force adds nothing."
            => "f is missing for every particle i.";
        ConstantSign "constant-sign": "The constant force acts in the wrong direction."
            => "-f stands where the force f belongs: the gradient is -f.";
        ConstantMass "constant-mass": "The constant force is multiplied by the mass."
            => "m_i f stands where f belongs.";
        DragMissing "drag-missing": "Drag adds nothing."
            => "-b v_i is missing for every particle i.";
        DragSign "drag-sign": "Drag accelerates."
            => "b v_i stands where the force -b v_i belongs: the gradient is b v_i.";
        DragMass "drag-mass": "Drag is multiplied by the mass."
            => "-b m_i v_i stands where -b v_i belongs.";
        DragQuadratic "drag-quadratic": "Drag is multiplied by the speed."
            => "-b |v_i| v_i stands where -b v_i belongs.";
        SpringMissing "spring-missing": "The spring force adds nothing."
            => "Elastic part and damping are missing.";
        SpringElasticMissing "spring-elastic-missing": "The elastic part of the spring force is missing."
            => "k (l - l0) n is missing.";
        SpringElasticSign "spring-elastic-sign": "The elastic part of the spring force has the wrong sign."
            => "-k (l - l0) n stands where k (l - l0) n belongs on the first end, and likewise on the second.";
        SpringNoStiffness "spring-no-stiffness": "The elastic part of the spring force ignores the stiffness."
            => "(l - l0) n stands where k (l - l0) n belongs.";
        SpringNoRestLength "spring-no-rest-length": "The elastic part of the spring force ignores the rest length."
            => "k l n stands where k (l - l0) n belongs.";
        SpringRestLengthSign "spring-rest-length-sign":
            "The rest length of a spring is added where it is to be subtracted."
            => "k (l + l0) n stands where k (l - l0) n belongs.";
        SpringElasticHalved "spring-elastic-halved":
            "The elastic part of the spring force carries a factor that belongs to the energy."
            => "k / 2 (l - l0) n stands where k (l - l0) n belongs.";
        SpringElasticDoubled "spring-elastic-doubled": "The elastic part of the spring force is added twice."
            => "2 k (l - l0) n stands where k (l - l0) n belongs.";
        SpringStretchSquared "spring-stretch-squared":
            "The elastic part of the spring force has the square of the stretch, as the energy has."
            => "k / 2 (l - l0)^2 n stands where k (l - l0) n belongs.";
        SpringDirection "spring-direction":
            "The direction of a spring is never normalised."
            =>
            "d = x_b - x_a stands where n = d / |d| belongs in the elastic part and in the damping; normalized() \
            returns the unit vector and leaves d as it is, normalize() changes d.";
        SpringDirectionEverywhere "spring-direction-everywhere":
            "The direction of a spring is never normalised, in the force as in its derivatives."
            =>
            "d = x_b - x_a stands where n = d / |d| belongs in the force and its Hessians; normalized() returns \
            the unit vector and leaves d as it is, normalize() changes d.";
        SpringElasticDirection "spring-elastic-direction":
            "The direction in the elastic part of the spring force is not normalised."
            => "k (l - l0) d stands where k (l - l0) n belongs, with d = x_b - x_a and n = d / |d|.";
        SpringDampingDirection "spring-damping-direction": "The direction in the damping of a spring is not normalised."
            => "b (d . (v_b - v_a)) d stands where b (n . (v_b - v_a)) n belongs, with d = x_b - x_a and n = d / |d|.";
        SpringFirstOnly "spring-first-only": "Only the first end of a spring is pulled."
            => "g_b += ... is missing.";
        SpringSecondOnly "spring-second-only": "Only the second end of a spring is pulled."
            => "g_a -= ... is missing.";
        SpringSameSign "spring-same-sign": "Both ends of a spring are pulled in the same direction."
            => "The same force stands on a and on b, where opposite ones belong.";
        SpringDampingMissing "spring-damping-missing": "The damping of a spring is missing."
            => "b (n . (v_b - v_a)) n is missing.";
        SpringDampingSign "spring-damping-sign":
            "The damping of a spring has the wrong sign."
            =>
            "-b (n . (v_b - v_a)) n stands where b (n . (v_b - v_a)) n belongs on the first end, and likewise on \
            the second.";
        SpringDampingNoCoefficient "spring-damping-no-coefficient": "The damping of a spring ignores its coefficient."
            => "(n . (v_b - v_a)) n stands where b (n . (v_b - v_a)) n belongs.";
        SpringDampingAllDirections "spring-damping-all-directions":
            "The damping of a spring acts on the whole relative velocity, not on its part along the spring."
            => "b (v_b - v_a) stands where b (n . (v_b - v_a)) n belongs.";
        SpringDampingFirstOnly "spring-damping-first-only": "The damping of a spring acts on its first end only."
            => "g_b += b (n . (v_b - v_a)) n is missing.";
        SpringDampingOneVelocity "spring-damping-one-velocity":
            "The damping of a spring looks at the velocity of its second end only."
            => "b (n . v_b) n stands where b (n . (v_b - v_a)) n belongs.";
        SpringDampingVelocitySum "spring-damping-velocity-sum":
            "The damping of a spring adds the velocities of its ends."
            => "b (n . (v_b + v_a)) n stands where b (n . (v_b - v_a)) n belongs.";
        GravitationMissing "gravitation-missing": "The gravitational force adds nothing."
            => "G m1 m2 / r^2 n is missing.";
        GravitationSign "gravitation-sign":
            "The gravitational force pushes apart."
            =>
            "-G m1 m2 / r^2 n stands where G m1 m2 / r^2 n belongs on the first particle, and likewise on the \
            second.";
        GravitationDistanceOnce "gravitation-distance-once":
            "The gravitational force is divided by the distance, not by its square, or its direction is not \
            normalised."
            =>
            "G m1 m2 / r n stands where G m1 m2 / r^2 n belongs: d / r^2, with d = x_b - x_a, is n / r, and \
            normalized() returns the unit vector and leaves d as it is.";
        GravitationDistanceCubed "gravitation-distance-cubed":
            "The gravitational force is divided by the distance once too often."
            => "G m1 m2 / r^3 n stands where G m1 m2 / r^2 n belongs.";
        GravitationNoMasses "gravitation-no-masses": "The gravitational force ignores the masses."
            => "G / r^2 n stands where G m1 m2 / r^2 n belongs.";
        GravitationOwnMass "gravitation-own-mass": "The gravitational force has the first mass twice."
            => "G m1 m1 / r^2 n stands where G m1 m2 / r^2 n belongs.";
        GravitationNoConstant "gravitation-no-constant": "The gravitational force ignores its constant."
            => "m1 m2 / r^2 n stands where G m1 m2 / r^2 n belongs.";
        GravitationFirstOnly "gravitation-first-only": "Only the first particle of a gravitational pair is attracted."
            => "g_b += ... is missing.";
        GravitationSecondOnly "gravitation-second-only":
            "Only the second particle of a gravitational pair is attracted."
            => "g_a -= ... is missing.";
        GravitationSameSign "gravitation-same-sign":
            "Both particles of a gravitational pair are pulled in the same direction."
            => "The same force stands on a and on b, where opposite ones belong.";
        VortexMissing "vortex-missing": "The vortex force adds nothing."
            => "kvc / r^2 (kbs n' - (v_b - v_a)) is missing, with n' = (-n.y, n.x).";
        VortexSign "vortex-sign":
            "The vortex force has the wrong sign."
            =>
            "-kvc / r^2 (kbs n' - (v_b - v_a)) stands where the same without the minus belongs, with n' = (-n.y, \
            n.x).";
        VortexTurn "vortex-turn": "The vortex turns the wrong way."
            => "(n.y, -n.x) stands where n' = (-n.y, n.x) belongs.";
        VortexAlong "vortex-along": "The vortex force acts along the line between the particles, not across it."
            => "n stands where n' = (-n.y, n.x) belongs.";
        VortexNoVelocity "vortex-no-velocity": "The vortex force forgets the relative velocity."
            => "kbs n' stands where kbs n' - (v_b - v_a) belongs.";
        VortexVelocitySign "vortex-velocity-sign":
            "The vortex force adds the relative velocity where it is to be subtracted."
            => "kbs n' + (v_b - v_a) stands where kbs n' - (v_b - v_a) belongs.";
        VortexDistanceOnce "vortex-distance-once": "The vortex force is divided by the distance, not by its square."
            => "1 / r stands where 1 / r^2 belongs.";
        VortexNoDistance "vortex-no-distance": "The vortex force is not divided by the square of the distance."
            => "1 / r^2 is missing.";
        VortexStrengthDivided "vortex-strength-divided":
            "Only the turning part of the vortex force is divided by the square of the distance."
            => "kbs / r^2 n' - (v_b - v_a) stands where (kbs n' - (v_b - v_a)) / r^2 belongs.";
        VortexFirstOnly "vortex-first-only": "Only the first particle of a vortex pair is pushed."
            => "g_b += ... is missing.";
        VortexSameSign "vortex-same-sign": "Both particles of a vortex pair are pushed in the same direction."
            => "The same force stands on a and on b, where opposite ones belong.";
        VortexDirection "vortex-direction": "The direction of the vortex force is not normalised."
            => "d stands where n = d / |d| belongs; normalized() returns the unit vector and leaves d as it is.";
    }
    Wrong Jacobians {
        JacobianElasticMissing "jacobian-elastic-missing": "The elastic part of a spring has no second derivatives."
            => "k (n n^T + (l - l0) / l (I - n n^T)) is missing.";
        JacobianElasticSign "jacobian-elastic-sign":
            "The second derivatives of a spring's elastic part have the wrong sign."
            =>
            "-k (n n^T + (l - l0) / l (I - n n^T)) stands where the same without the minus belongs on (a, a) and \
            (b, b).";
        JacobianElasticNoOuter "jacobian-elastic-no-outer":
            "The second derivatives of a spring's elastic part lack the term along the spring."
            => "k n n^T is missing: only k (l - l0) / l (I - n n^T) is there.";
        JacobianElasticNoTangent "jacobian-elastic-no-tangent":
            "The second derivatives of a spring's elastic part lack the term across the spring."
            => "k (l - l0) / l (I - n n^T) is missing: only k n n^T is there.";
        JacobianElasticTangentSign "jacobian-elastic-tangent-sign":
            "In the second derivatives of a spring's elastic part the term across the spring has the wrong sign."
            => "-k (l - l0) / l (I - n n^T) stands where k (l - l0) / l (I - n n^T) belongs.";
        JacobianElasticNoProjection "jacobian-elastic-no-projection":
            "In the second derivatives of a spring's elastic part the term across the spring acts along it, too."
            => "(l - l0) / l I stands where (l - l0) / l (I - n n^T) belongs.";
        JacobianElasticNoLength "jacobian-elastic-no-length":
            "The second derivatives of a spring's elastic part are not divided by the length."
            => "(l - l0) (I - n n^T) stands where (l - l0) / l (I - n n^T) belongs.";
        JacobianElasticNoRestLength "jacobian-elastic-no-rest-length":
            "The second derivatives of a spring's elastic part ignore the rest length."
            =>
            "k I stands where k (n n^T + (l - l0) / l (I - n n^T)) belongs, since l / l stands where (l - l0) / \
            l belongs.";
        JacobianElasticDirection "jacobian-elastic-direction":
            "The direction in the second derivatives of a spring's elastic part is not normalised."
            => "d d^T stands where n n^T belongs, with d = x_b - x_a and n = d / |d|.";
        JacobianElasticDoubled "jacobian-elastic-doubled":
            "The second derivatives of a spring's elastic part are added twice."
            => "2 k stands where k belongs.";
        JacobianDampingMissing "jacobian-damping-missing":
            "The damping of a spring has no derivatives by positions."
            =>
            "-D is missing on (a, a) and (b, b), +D beside the diagonal, with D = -b / l ((n w^T + (n . w) I) (I \
            - n n^T)) and w = v_b - v_a.";
        JacobianDampingSign "jacobian-damping-sign":
            "The derivatives of a spring's damping by positions have the wrong sign."
            =>
            "+D stands where -D belongs on (a, a) and (b, b), with D = -b / l ((n w^T + (n . w) I) (I - n n^T)) \
            and w = v_b - v_a.";
        JacobianDampingNoScalar "jacobian-damping-no-scalar":
            "The derivatives of a spring's damping by positions lack the term of the speed along the spring."
            => "n w^T stands where n w^T + (n . w) I belongs, with w = v_b - v_a.";
        JacobianDampingNoOuter "jacobian-damping-no-outer":
            "The derivatives of a spring's damping by positions lack the term of the velocity's outer product."
            =>
            "(n . w) I stands where n w^T + (n . w) I belongs, with w = v_b - v_a; w n^T comes to nothing, too, \
            since it vanishes before I - n n^T.";
        JacobianDampingNoProjection "jacobian-damping-no-projection":
            "The derivatives of a spring's damping by positions are not projected across the spring."
            => "(I - n n^T) is missing behind n w^T + (n . w) I, with w = v_b - v_a.";
        JacobianDampingNoLength "jacobian-damping-no-length":
            "The derivatives of a spring's damping by positions are not divided by the length."
            => "b stands where b / l belongs.";
        JacobianDampingDirection "jacobian-damping-direction":
            "The direction in the derivatives of a spring's damping by positions is not normalised."
            => "d stands where n = d / |d| belongs in n w^T, n . w and n n^T.";
        JacobianVelocityMissing "jacobian-velocity-missing": "The damping of a spring has no derivatives by velocities."
            => "b n n^T is missing.";
        JacobianVelocitySign "jacobian-velocity-sign":
            "The derivatives of a spring's damping by velocities have the wrong sign."
            => "-b n n^T stands where b n n^T belongs on (a, a) and (b, b).";
        JacobianVelocityIdentity "jacobian-velocity-identity":
            "The derivatives of a spring's damping by velocities act in all directions, not along the spring."
            => "b I stands where b n n^T belongs.";
        JacobianVelocityDirection "jacobian-velocity-direction":
            "The direction in the derivatives of a spring's damping by velocities is not normalised."
            => "b d d^T stands where b n n^T belongs, with d = x_b - x_a and n = d / |d|.";
        JacobianGravitationMissing "jacobian-gravitation-missing": "The gravitational force has no second derivatives."
            => "G m1 m2 / r^3 (I - 3 n n^T) is missing.";
        JacobianGravitationSign "jacobian-gravitation-sign":
            "The second derivatives of the gravitational force have the wrong sign."
            => "-G m1 m2 / r^3 (I - 3 n n^T) stands where G m1 m2 / r^3 (I - 3 n n^T) belongs on (a, a) and (b, b).";
        JacobianGravitationNoThree "jacobian-gravitation-no-three":
            "The second derivatives of the gravitational force lack a factor."
            => "I - n n^T stands where I - 3 n n^T belongs.";
        JacobianGravitationDistance "jacobian-gravitation-distance":
            "The second derivatives of the gravitational force are divided by the distance once too seldom."
            => "1 / r^2 stands where 1 / r^3 belongs.";
        JacobianGravitationNoOuter "jacobian-gravitation-no-outer":
            "The second derivatives of the gravitational force lack the term along the line of the particles."
            => "-3 n n^T is missing.";
        JacobianGravitationDirection "jacobian-gravitation-direction":
            "The direction in the second derivatives of the gravitational force is not normalised."
            => "d d^T stands where n n^T belongs, with d = x_b - x_a and n = d / |d|.";
        JacobianDragMissing "jacobian-drag-missing": "Drag has no derivatives by velocities."
            => "b is missing on the diagonal.";
        JacobianDragSign "jacobian-drag-sign": "The derivatives of drag by velocities have the wrong sign."
            => "-b stands where b belongs on the diagonal.";
        JacobianDiagonalOnly "jacobian-diagonal-only":
            "The second derivatives of forces between two particles lack the blocks beside the diagonal."
            => "-B is missing on (a, b) and (b, a).";
        JacobianOffDiagonalSign "jacobian-off-diagonal-sign":
            "The second derivatives of forces between two particles have the wrong sign beside the diagonal."
            => "+B stands where -B belongs on (a, b) and (b, a).";
        JacobianOneHalf "jacobian-one-half": "Of the symmetric halves of the second derivatives only one is filled in."
            => "-B is missing on (b, a).";
        JacobianFirstOnly "jacobian-first-only":
            "The second derivatives of forces between two particles lack the second particle's block."
            => "+B is missing on (b, b).";
    }
}
