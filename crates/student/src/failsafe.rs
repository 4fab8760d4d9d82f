//! The rigid failsafe: an impact zone moves as one rigid body, or stops (collisions.md 5, last part).
use fosssim_num::{
    elementary,
    vector::{Vec2, divide, length, set_vector, vector_at},
};

use super::{
    Area, Mistake,
    author::Student,
    objects::{State, Zone},
    rounding::round_to_f32,
    world::World,
};

/// The areas of the assignment whose mistakes this module simulates.
const MODULE_AREAS: &[Area] = &[Area::Failsafe];

/// The mistakes in zones that stop or should stop. The other mistakes are made in zones that move.
const STOP_MISTAKES: &[Mistake] = &[
    Mistake::FailsafeFixedForgotten,
    Mistake::FailsafeHalfPlaneForgotten,
    Mistake::FailsafeAllFixedOnly,
    Mistake::FailsafeFirstFixedOnly,
    Mistake::FailsafeLastFixedOnly,
    Mistake::FailsafeAlwaysStops,
    Mistake::FailsafeStopsFixedOnly,
    Mistake::FailsafeStopKeepsPosition,
    Mistake::FailsafeStopKeepsVelocity,
    Mistake::FailsafeFixedSkipped,
];

/// Returns the student's mistake in the motion of a zone, or `None` if there is none.
fn motion_mistake(student: Student) -> Option<Mistake> {
    student.mistakes().find(|mistake| MODULE_AREAS.contains(&mistake.area()) && !STOP_MISTAKES.contains(mistake))
}

/// Replaces the positions and velocities of the zone's particles at the end of the step. The zone moves as a rigid body
/// with the same momentum, or stops if a part of it cannot move.
pub fn move_zone(world: &World, zone: &Zone, q_start: &[f64], state: &mut State) {
    let mistake = motion_mistake(world.student);
    if mistake == Some(Mistake::FailsafeEmpty) {
        return;
    }
    let skips_fixed = world.student.makes(Mistake::FailsafeFixedSkipped);
    let is_used = |particle: &usize| !(skips_fixed && world.is_fixed(*particle));
    let zone = &Zone { particles: zone.particles.iter().copied().filter(is_used).collect(), ..*zone };
    if is_stopped(world, zone) {
        stop_zone(world, zone, q_start, state);
    } else {
        let rigid = RigidBody::new(world, zone, q_start, state);
        if mistake != Some(Mistake::FailsafeUnturnedUnmoved) || rigid.angle != 0.0 {
            rigid.move_particles(zone, state);
        }
    }
}

/// Returns whether a part of the zone cannot move according to this student's program.
fn is_stopped(world: &World, zone: &Zone) -> bool {
    let student = world.student;
    let fixed = zone_particles(world, zone).into_iter().any(|particle| world.is_fixed(particle));
    let half_plane = zone.has_half_plane && !student.makes(Mistake::FailsafeHalfPlaneForgotten);
    let fixed = match () {
        () if student.makes(Mistake::FailsafeFixedForgotten) => false,
        () if student.makes(Mistake::FailsafeFirstFixedOnly) => {
            zone.particles.first().is_some_and(|&first| world.is_fixed(first))
        }
        () if student.makes(Mistake::FailsafeLastFixedOnly) => {
            zone.particles.last().is_some_and(|&last| world.is_fixed(last))
        }
        () if student.makes(Mistake::FailsafeFixedCounter) => {
            (0..zone.particles.len()).any(|number| world.is_fixed(number))
        }
        () if student.makes(Mistake::FailsafeAllFixedOnly) => {
            zone.particles.iter().all(|&particle| world.is_fixed(particle))
        }
        () => fixed,
    };
    half_plane || fixed || student.makes(Mistake::FailsafeAlwaysStops)
}

/// Returns the particles that this student's program treats as the zone's, in ascending order.
fn zone_particles(world: &World, zone: &Zone) -> Vec<usize> {
    match (zone.particles.first(), zone.particles.last()) {
        (Some(&first), Some(&last)) if world.student.makes(Mistake::FailsafeRange) => (first..=last).collect(),
        _ => zone.particles.iter().copied().collect(),
    }
}

fn stop_zone(world: &World, zone: &Zone, q_start: &[f64], state: &mut State) {
    for particle in zone_particles(world, zone) {
        if world.student.makes(Mistake::FailsafeStopsFixedOnly) && !world.is_fixed(particle) {
            continue;
        }
        if !world.student.makes(Mistake::FailsafeStopKeepsPosition) {
            set_vector(&mut state.x, particle, vector_at(q_start, particle));
        }
        if !world.student.makes(Mistake::FailsafeStopKeepsVelocity) {
            let stopped = vector_at(&state.v, particle) * 0.0;
            set_vector(&mut state.v, particle, stopped);
        }
    }
}

/// A rigid body made of a zone's particles.
struct RigidBody<'a> {
    world: &'a World,
    q_start: &'a [f64],
    /// The center of mass at the start of the step.
    center: Vec2,
    /// The displacement of the center of mass within the step.
    shift: Vec2,
    /// The zone's angular momentum about the center, times the step size.
    angular_momentum: f64,
    /// The angle by which the body turns within the step, in radians.
    angle: f64,
    /// The zone's moment of inertia.
    inertia: f64,
}

impl<'a> RigidBody<'a> {
    fn new(world: &'a World, zone: &Zone, q_start: &'a [f64], state: &State) -> Self {
        let (center, shift) = (Vec2::zeros(), Vec2::zeros());
        let mut rigid = Self { world, q_start, center, shift, angular_momentum: 0.0, angle: 0.0, inertia: 0.0 };
        rigid.compute_translation(zone, state);
        rigid.compute_rotation(zone, state);
        rigid
    }

    fn mistake(&self) -> Option<Mistake> {
        motion_mistake(self.world.student)
    }

    /// Returns the mass of a particle; `number` is its number in the zone.
    fn mass(&self, number: usize, particle: usize) -> f64 {
        if self.mistake() == Some(Mistake::FailsafeUnweighted) {
            return 1.0;
        }
        let index = match self.mistake() {
            Some(Mistake::FailsafeMassIndex) => particle,
            Some(Mistake::FailsafeMassCounter) => 2 * number,
            _ => 2 * particle,
        };
        self.world.masses[index]
    }

    /// Computes the center of mass and its displacement from the particles' momenta.
    fn compute_translation(&mut self, zone: &Zone, state: &State) {
        let mut total = 0.0;
        let (student, both) = (self.world.student, self.mistake() == Some(Mistake::FailsafeMeansUnweighted));
        let is_unweighted = |alone| both || student.makes(alone);
        for (number, particle) in zone_particles(self.world, zone).into_iter().enumerate() {
            let mass = self.mass(number, particle);
            let start = vector_at(self.q_start, particle);
            let displacement = vector_at(&state.x, particle) - start;
            let position =
                if self.mistake() == Some(Mistake::FailsafeCenterAtEnd) { start + displacement } else { start };
            let weight = |forgotten| if is_unweighted(forgotten) { 1.0 } else { mass };
            let motion = match self.mistake() {
                Some(Mistake::FailsafeMomentumVelocity) => vector_at(&state.v, particle),
                _ => displacement,
            };
            self.center = student.add_scaled(self.center, weight(Mistake::FailsafeCenterUnweighted), position);
            self.shift = student.add_scaled(self.shift, weight(Mistake::FailsafeMomentumUnweighted), motion);
            total += mass;
            match self.mistake() {
                Some(Mistake::FailsafeMassInteger) => total = total.trunc(),
                Some(Mistake::FailsafeSumsSingle) => total = round_to_f32(total),
                _ => {}
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of particles")]
        let count = zone.particles.len() as f64;
        let is_unweighted_center = is_unweighted(Mistake::FailsafeCenterUnweighted);
        self.center = divide(self.center, if is_unweighted_center { count } else { total });
        let is_unweighted_shift = is_unweighted(Mistake::FailsafeMomentumUnweighted);
        self.shift = divide(self.shift, if is_unweighted_shift { count } else { total });
        if self.mistake() == Some(Mistake::FailsafeNoTranslation) {
            self.shift = Vec2::zeros();
        }
    }

    /// Computes the angle from the particles' angular momenta about the center of mass.
    fn compute_rotation(&mut self, zone: &Zone, state: &State) {
        let mut angular_momentum = 0.0;
        let mut inertia = 0.0;
        let student = self.world.student;
        for (number, particle) in zone_particles(self.world, zone).into_iter().enumerate() {
            let start = vector_at(self.q_start, particle);
            let moved = vector_at(&state.x, particle) - start;
            let arm = match self.mistake() {
                Some(Mistake::FailsafeAboutOrigin) => start,
                _ => start - self.center,
            };
            let relative = match self.mistake() {
                Some(Mistake::FailsafeWholeDisplacement) => moved,
                Some(Mistake::FailsafeAngularVelocity) => vector_at(&state.v, particle),
                Some(Mistake::FailsafeMomentumFromEnd) => vector_at(&state.x, particle) - self.center,
                _ => moved - self.shift,
            };
            let weight = |forgotten| if student.makes(forgotten) { 1.0 } else { self.mass(number, particle) };
            let turn = match self.mistake() {
                Some(Mistake::FailsafeCrossSum) => arm.x * relative.y + arm.y * relative.x,
                Some(Mistake::FailsafeDotProduct) => arm.dot(&relative),
                _ => student.add_product(arm.x * relative.y, -arm.y, relative.x),
            };
            let term = weight(Mistake::FailsafeAngularUnweighted) * turn;
            match self.mistake() {
                Some(Mistake::FailsafeAngularOverwritten) => angular_momentum = term,
                Some(Mistake::FailsafeAngularDoubled) => {
                    angular_momentum = term;
                    angular_momentum += angular_momentum;
                }
                _ => {
                    angular_momentum =
                        student.add_product(angular_momentum, weight(Mistake::FailsafeAngularUnweighted), turn)
                }
            }
            let square = match self.mistake() {
                Some(Mistake::FailsafeInertiaDistance) => length(arm),
                Some(Mistake::FailsafeInertiaAtEnd) => {
                    let arm = vector_at(&state.x, particle) - self.center - self.shift;
                    arm.dot(&arm)
                }
                Some(Mistake::FailsafeInertiaAboutOrigin) => start.dot(&start),
                _ => student.dot(arm, arm),
            };
            inertia = student.add_product(inertia, weight(Mistake::FailsafeInertiaUnweighted), square);
            match self.mistake() {
                Some(Mistake::FailsafeAngularInteger) => angular_momentum = angular_momentum.trunc(),
                Some(Mistake::FailsafeInertiaInteger) => inertia = inertia.trunc(),
                Some(Mistake::FailsafeSumsSingle) => {
                    (angular_momentum, inertia) = (round_to_f32(angular_momentum), round_to_f32(inertia))
                }
                _ => {}
            }
        }
        (self.angular_momentum, self.inertia) = (angular_momentum, inertia);
        self.angle = match self.mistake() {
            Some(Mistake::FailsafeRotationSign) => -(angular_momentum / inertia),
            Some(Mistake::FailsafeRotationAbsolute) => (angular_momentum / inertia).abs(),
            Some(Mistake::FailsafeNoRotation) => 0.0,
            Some(Mistake::FailsafeTinyTurnIgnored) if (angular_momentum / inertia).abs() < 1e-3 => 0.0,
            Some(Mistake::FailsafeAnglePerStep) => angular_momentum / inertia * self.world.scene.time_step,
            Some(Mistake::FailsafeNoInertia) => angular_momentum,
            _ => angular_momentum / inertia,
        };
    }

    /// Moves the zone's particles with the body.
    fn move_particles(&self, zone: &Zone, state: &mut State) {
        let (cosine, sine) = match self.mistake() {
            Some(Mistake::FailsafeSmallAngle) => (1.0, self.angle),
            Some(Mistake::FailsafeCosineSine) => (elementary::sin(self.angle), elementary::cos(self.angle)),
            Some(Mistake::FailsafeSeries) => {
                let square = self.angle * self.angle;
                (1.0 - square / 2.0, self.angle - square * self.angle / 6.0)
            }
            Some(Mistake::FailsafeDegrees) => {
                (elementary::cos(self.angle.to_degrees()), elementary::sin(self.angle.to_degrees()))
            }
            Some(Mistake::FailsafeHalfAngle) => {
                let (cosine, sine) = (elementary::cos(0.5 * self.angle), elementary::sin(0.5 * self.angle));
                (1.0 - 2.0 * sine * sine, 2.0 * sine * cosine)
            }
            _ => (elementary::cos(self.angle), elementary::sin(self.angle)),
        };
        let student = self.world.student;
        for particle in zone_particles(self.world, zone) {
            let start = vector_at(self.q_start, particle);
            let arm = match self.mistake() {
                Some(Mistake::FailsafeTurnsEnd) => vector_at(&state.x, particle) - self.center - self.shift,
                _ => start - self.center,
            };
            let turned_arm = match self.mistake() {
                Some(Mistake::FailsafePerpendicular) => Vec2::new(arm.y, arm.x),
                _ => Vec2::new(-arm.y, arm.x),
            };
            let x = match self.mistake() {
                Some(Mistake::FailsafeNoCenter) => self.shift + cosine * arm + sine * turned_arm,
                Some(Mistake::FailsafeShiftTwice) => self.center + 2.0 * self.shift + cosine * arm + sine * turned_arm,
                Some(Mistake::FailsafeRotationMatrix) => {
                    let turned = Vec2::new(cosine * arm.x - sine * arm.y, sine * arm.x + cosine * arm.y);
                    self.center + (self.shift + turned)
                }
                _ => {
                    let to = self.center + self.shift;
                    student.add_scaled(student.add_scaled(to, cosine, arm), sine, turned_arm)
                }
            };
            let (h, before) = (self.world.scene.time_step, vector_at(&state.v, particle));
            let v = match self.mistake() {
                Some(Mistake::FailsafeVelocityKept) => before,
                Some(Mistake::FailsafeVelocityNoStep) => x - start,
                Some(Mistake::FailsafeVelocityTimesStep) => h * (x - start),
                Some(Mistake::FailsafeVelocityAdded) => before + divide(x - start, h),
                Some(Mistake::FailsafeVelocityFromPrediction) => divide(x - vector_at(&state.x, particle), h),
                Some(Mistake::FailsafeVelocityOfCenter) => divide(self.shift, h),
                _ => divide(x - start, h),
            };
            set_vector(&mut state.x, particle, x);
            set_vector(&mut state.v, particle, v);
        }
    }
}
