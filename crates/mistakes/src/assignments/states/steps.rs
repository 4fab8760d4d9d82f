//! Mistakes of the forces and their derivatives, of the integrators, of the penalty force, of finding its pairs, and of
//! simple responses (simulation.md 2 to 4, collisions.md 6).
use super::super::rows::rows;

rows! {
    /// Something that a program does differently in a step.
    StepMistake STEPS []
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
        SpringDirection "spring-direction": "The direction of a spring is never normalised."
            => "d = x_b - x_a stands where n = d / |d| belongs in the elastic part and in the damping; normalized() \
            returns the unit vector and leaves d as it is, normalize() changes d.";
        SpringDirectionEverywhere "spring-direction-everywhere":
            "The direction of a spring is never normalised, in the force as in its derivatives."
            => "d = x_b - x_a stands where n = d / |d| belongs in the force and its Hessians; normalized() returns the \
            unit vector and leaves d as it is, normalize() changes d.";
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
        SpringDampingSign "spring-damping-sign": "The damping of a spring has the wrong sign."
            => "-b (n . (v_b - v_a)) n stands where b (n . (v_b - v_a)) n belongs on the first end, and likewise on \
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
        GravitationSign "gravitation-sign": "The gravitational force pushes apart."
            => "-G m1 m2 / r^2 n stands where G m1 m2 / r^2 n belongs on the first particle, and likewise on the \
            second.";
        GravitationDistanceOnce "gravitation-distance-once":
            "The gravitational force is divided by the distance, not by its square, or its direction is not normalised."
            => "G m1 m2 / r n stands where G m1 m2 / r^2 n belongs: d / r^2, with d = x_b - x_a, is n / r, and \
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
        VortexSign "vortex-sign": "The vortex force has the wrong sign."
            => "-kvc / r^2 (kbs n' - (v_b - v_a)) stands where the same without the minus belongs, with n' = (-n.y, \
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
            => "-k (n n^T + (l - l0) / l (I - n n^T)) stands where the same without the minus belongs on (a, a) and \
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
            => "k I stands where k (n n^T + (l - l0) / l (I - n n^T)) belongs, since l / l stands where (l - l0) / l \
            belongs.";
        JacobianElasticDirection "jacobian-elastic-direction":
            "The direction in the second derivatives of a spring's elastic part is not normalised."
            => "d d^T stands where n n^T belongs, with d = x_b - x_a and n = d / |d|.";
        JacobianElasticDoubled "jacobian-elastic-doubled":
            "The second derivatives of a spring's elastic part are added twice."
            => "2 k stands where k belongs.";
        JacobianDampingMissing "jacobian-damping-missing": "The damping of a spring has no derivatives by positions."
            => "-D is missing on (a, a) and (b, b), +D beside the diagonal, with D = -b / l ((n w^T + (n . w) I) (I - \
            n n^T)) and w = v_b - v_a.";
        JacobianDampingSign "jacobian-damping-sign":
            "The derivatives of a spring's damping by positions have the wrong sign."
            => "+D stands where -D belongs on (a, a) and (b, b), with D = -b / l ((n w^T + (n . w) I) (I - n n^T)) and \
            w = v_b - v_a.";
        JacobianDampingNoScalar "jacobian-damping-no-scalar":
            "The derivatives of a spring's damping by positions lack the term of the speed along the spring."
            => "n w^T stands where n w^T + (n . w) I belongs, with w = v_b - v_a.";
        JacobianDampingNoOuter "jacobian-damping-no-outer":
            "The derivatives of a spring's damping by positions lack the term of the velocity's outer product."
            => "(n . w) I stands where n w^T + (n . w) I belongs, with w = v_b - v_a; w n^T comes to nothing, too, \
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
    Wrong Integrator {
        IntegratorEmpty "integrator-empty": "A step changes nothing."
            => "x and v stay as they are.";
        IntegratorPositionsEmpty "integrator-positions-empty": "Positions never change."
            => "x += h v is missing.";
        IntegratorVelocitiesEmpty "integrator-velocities-empty": "Velocities never change."
            => "v += h F / m is missing.";
        IntegratorVelocityFirst "integrator-velocity-first":
            "Positions are moved by the new velocities, where the old ones belong."
            => "v += h F / m stands before x += h v; explicit Euler moves x by the old v.";
        IntegratorPositionFirst "integrator-position-first":
            "Positions are moved by the old velocities, where the new ones belong."
            => "x += h v stands before v += h F / m; symplectic Euler moves x by the new v.";
        IntegratorForceBehindPositions "integrator-force-behind-positions":
            "The forces are computed after the positions have moved, where those before belong."
            => "F(x + h v, v) stands where F(x, v) belongs.";
        IntegratorMeanVelocity "integrator-mean-velocity": "Positions are moved by the mean of old and new velocities."
            => "x += h (v_old + v_new) / 2 stands where one of the two belongs.";
        IntegratorNoMass "integrator-no-mass": "Forces are not divided by the mass."
            => "F stands where F / m belongs.";
        IntegratorMassMultiplied "integrator-mass-multiplied":
            "Forces are multiplied by the mass, where they are to be divided by it."
            => "F m stands where F / m belongs.";
        IntegratorForceSign "integrator-force-sign": "The gradient of the energy is taken for the force."
            => "F = gradient stands where F = -gradient belongs.";
        IntegratorNoStepForVelocities "integrator-no-step-for-velocities":
            "The change of velocity is not multiplied by the step size."
            => "v += F / m stands where v += h F / m belongs.";
        IntegratorNoStepForPositions "integrator-no-step-for-positions":
            "The change of position is not multiplied by the step size."
            => "x += v stands where x += h v belongs.";
        IntegratorFixedForgotten "integrator-fixed-forgotten": "Forces act on fixed particles, too."
            => "F_i = 0 is missing for fixed particles; of implicit integrators the right-hand side's entries are to \
            be 0 and the rows of the matrix those of the identity.";
        IntegratorFixedStand "integrator-fixed-stand": "Fixed particles stand still, even those with a velocity."
            => "x += h v is left out for fixed particles; only their force is 0.";
        IntegratorFixedStopped "integrator-fixed-stopped": "Fixed particles lose their velocity."
            => "v = 0 stands for fixed particles, whose v stays as it is.";
        LinearForcesAtStart "linear-forces-at-start":
            "The forces are computed at the start of the step, not at the predicted positions."
            => "F(x, v) stands where F(x + h v, v) belongs.";
        LinearMatrixAtStart "linear-matrix-at-start":
            "The matrix is computed at the start of the step, not at the predicted positions."
            => "A(x, v) stands where A(x + h v, v) belongs.";
        LinearAllAtStart "linear-all-at-start":
            "Forces and matrix are computed at the start of the step, not at the predicted positions."
            => "x stands where x + h v belongs.";
        LinearIterates "linear-iterates":
            "The linearised step is repeated until nothing changes, where one solve belongs."
            => "Newton's loop stands where one solve of A dv = h F belongs.";
        LinearOverwrites "linear-overwrites":
            "The solution of the system replaces the velocities, where it is to be added."
            => "v = dv stands where v += dv belongs.";
        ImplicitOneIteration "implicit-one-iteration": "Newton's method ends after one iteration."
            => "The loop runs once; it runs until |dv's change| < 1e-9.";
        ImplicitLoose "implicit-loose": "Newton's method ends too early."
            => "A larger bound stands where |dv's change| < 1e-9 belongs.";
        ImplicitPositionsKept "implicit-positions-kept": "Newton's method never moves its positions."
            => "dx = h (v + dv) is missing: dx stays h v.";
        ImplicitVelocitiesKept "implicit-velocities-kept":
            "Newton's method computes forces with the velocities at the start of the step."
            => "F(x + dx, v) stands where F(x + dx, v + dv) belongs.";
        ImplicitPositionWithoutChange "implicit-position-without-change":
            "Positions are moved by the velocities from before the system was solved."
            => "x += h v stands where x += h (v + dv) belongs.";
        MatrixNoMass "matrix-no-mass": "The system matrix lacks the masses."
            => "A = h Hv + h^2 Hx stands where A = M + h Hv + h^2 Hx belongs.";
        MatrixNoPositions "matrix-no-positions": "The system matrix lacks the derivatives by positions."
            => "h^2 Hx is missing in A = M + h Hv + h^2 Hx.";
        MatrixNoVelocities "matrix-no-velocities": "The system matrix lacks the derivatives by velocities."
            => "h Hv is missing in A = M + h Hv + h^2 Hx.";
        MatrixPositionsOnce "matrix-positions-once":
            "In the system matrix the derivatives by positions lack a factor of the step size."
            => "h Hx stands where h^2 Hx belongs.";
        MatrixVelocitiesUnscaled "matrix-velocities-unscaled":
            "In the system matrix the derivatives by velocities are not multiplied by the step size."
            => "Hv stands where h Hv belongs.";
        MatrixVelocitiesSquared "matrix-velocities-squared":
            "In the system matrix the derivatives by velocities are multiplied by the step size once too often."
            => "h^2 Hv stands where h Hv belongs.";
        MatrixSigns "matrix-signs": "The system matrix subtracts the derivatives of the forces."
            => "A = M - h Hv - h^2 Hx stands where A = M + h Hv + h^2 Hx belongs.";
        MatrixRowsOfFixed "matrix-rows-of-fixed": "The rows of fixed particles are left in the system matrix."
            => "Rows and columns of fixed particles are to be those of the identity.";
        RightSideSign "right-side-sign": "The right-hand side of the system has the wrong sign."
            => "-h F stands where h F belongs.";
        RightSideNoStep "right-side-no-step": "The right-hand side of the system is not multiplied by the step size."
            => "F stands where h F belongs.";
        RightSideOfFixed "right-side-of-fixed": "The right-hand side of the system has entries for fixed particles."
            => "The entries of fixed particles are to be 0.";
    }
    Wrong Penalty {
        PenaltyMissing "penalty-missing": "The penalty force adds nothing."
            => "The whole sum over the pairs is missing.";
        PenaltySign "penalty-sign": "The penalty force pulls together."
            => "The gradient has the other sign: g_i += ... stands where g_i -= k (|n| - r - h) u belongs.";
        PenaltyNoStiffness "penalty-no-stiffness": "The penalty force ignores its stiffness."
            => "(|n| - r - h) stands where k (|n| - r - h) belongs.";
        PenaltyNoThickness "penalty-no-thickness": "The penalty force ignores the thickness of the layer."
            => "r1 + r2 stands where r1 + r2 + h belongs, in the test as in the depth.";
        PenaltyThicknessInTestOnly "penalty-thickness-in-test-only":
            "The depth of the penalty force ignores the thickness of the layer."
            => "k (|n| - r1 - r2) stands where k (|n| - r1 - r2 - h) belongs.";
        PenaltyThicknessInDepthOnly "penalty-thickness-in-depth-only":
            "The penalty force tests without the thickness of the layer whether bodies are near."
            => "|n| < r1 + r2 stands where |n| < r1 + r2 + h belongs.";
        PenaltyNoRadii "penalty-no-radii": "The penalty force ignores the radii."
            => "h stands where r1 + r2 + h belongs.";
        PenaltyFirstRadiusOnly "penalty-first-radius-only": "The penalty force ignores the radius of the second body."
            => "r1 + h stands where r1 + r2 + h belongs.";
        PenaltyAlways "penalty-always": "The penalty force acts on pairs that are apart, too, and pulls these together."
            => "The test |n| < r1 + r2 + h is missing.";
        PenaltyDirection "penalty-direction": "The direction of the penalty force is not normalised."
            => "n stands where u = n / |n| belongs; normalized() returns the unit vector and leaves n as it is.";
        PenaltyFirstOnly "penalty-first-only": "The penalty force acts on the first body of a pair only."
            => "The other bodies' g += ... is missing.";
        PenaltySameSign "penalty-same-sign": "The penalty force pushes both bodies of a pair in the same direction."
            => "The same sign stands for all bodies of a pair.";
        PenaltyDepthSquared "penalty-depth-squared": "The penalty force grows with the square of the depth."
            => "k (|n| - r - h)^2 stands where k (|n| - r - h) belongs.";
        PenaltyNoParticles "penalty-no-particles": "The penalty force leaves pairs of particles out."
            => "The particle-particle part is missing.";
        PenaltyNoEdges "penalty-no-edges": "The penalty force leaves edges out."
            => "The particle-edge part is missing.";
        PenaltyNoHalfPlanes "penalty-no-half-planes": "The penalty force leaves half-planes out."
            => "The particle-half-plane part is missing.";
        PenaltyEdgeMiddle "penalty-edge-middle": "The penalty force of an edge goes to its middle."
            => "alpha = 1/2 stands where the closest point's alpha belongs.";
        PenaltyEdgeUnclamped "penalty-edge-unclamped":
            "The penalty force looks for the closest point of an edge on the whole line."
            => "alpha is not clamped to 0 <= alpha <= 1.";
        PenaltyEdgeSharesSwapped "penalty-edge-shares-swapped":
            "The penalty force exchanges the shares of an edge's ends."
            => "alpha and 1 - alpha stand in each other's places in the gradient.";
        PenaltyEdgeEqualShares "penalty-edge-equal-shares":
            "The penalty force is shared equally between the ends of an edge."
            => "1/2 stands where 1 - alpha and alpha belong in the gradient.";
        PenaltyEdgeFullShares "penalty-edge-full-shares":
            "The penalty force acts on each end of an edge as if it were the only one."
            => "1 stands where 1 - alpha and alpha belong in the gradient.";
        PenaltyEdgeOneEnd "penalty-edge-one-end": "The penalty force forgets the second end of an edge."
            => "g_second += k alpha D u is missing.";
        PenaltyEdgeNoRadius "penalty-edge-no-radius": "The penalty force ignores the radius of edges."
            => "r_i + h stands where r_i + r_e + h belongs for a particle and an edge.";
        PenaltyNormalUndivided "penalty-normal-undivided":
            "The penalty force ignores the length of a half-plane's normal, which is right for unit normals only."
            => "n = ((p - x) . q) q stands where n = ((p - x) . q) / (q . q) q belongs.";
        PenaltyHalfPlaneSign "penalty-half-plane-sign": "The penalty force of half-planes pulls."
            => "g_i += ... stands where g_i -= k (|n| - r_i - h) u belongs.";
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
    Wrong Response {
        SimpleSeparating "simple-separating": "Bodies that overlap are pushed even when they move apart."
            => "The test (v1 - v2) . n > 0 is missing.";
        SimpleApproachSign "simple-approach-sign": "Only bodies that move apart are pushed."
            => "(v1 - v2) . n < 0 stands where (v1 - v2) . n > 0 belongs.";
        SimpleAlways "simple-always": "All pairs that approach each other are pushed, also distant ones."
            => "The test |n| < r1 + r2 is missing.";
        SimpleTouching "simple-touching": "Bodies that touch without overlap are pushed, too."
            => "|n| <= r1 + r2 stands where |n| < r1 + r2 belongs.";
        SimpleFirstRadiusOnly "simple-first-radius-only": "The radius of the second body is forgotten."
            => "r1 stands where r1 + r2 belongs.";
        SimpleNoParticles "simple-no-particles": "Pairs of particles are not handled."
            => "The particle-particle part is missing.";
        SimpleNoEdges "simple-no-edges": "Pairs of a particle and an edge are not handled."
            => "The particle-edge part is missing.";
        SimpleNoHalfPlanes "simple-no-half-planes": "Pairs of a particle and a half-plane are not handled."
            => "The particle-half-plane part is missing.";
        SimpleEdgeUnclamped "simple-edge-unclamped": "The closest point of an edge is looked for on the whole line."
            => "alpha is not clamped to 0 <= alpha <= 1.";
        SimpleEdgeWeights "simple-edge-weights":
            "The shares of an edge's ends are not squared where the masses are weighed."
            => "1 - alpha and alpha stand where (1 - alpha)^2 and alpha^2 belong in the denominators.";
        SimpleNormalLength "simple-normal-length": "The half-plane's normal is not normalised."
            => "q stands where q / |q| belongs in n = ((p - x) . q) q.";
        SimpleAllFromStart "simple-all-from-start":
            "All impulses are computed from the velocities before the pass, where those of earlier pairs count."
            => "The velocities before the first pair stand where the current v belongs.";
    }
}
