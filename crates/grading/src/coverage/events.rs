//! Computes the properties of two kinds of events that an observer sees: a detection call, and a zone before it is
//! moved.
use super::axes::{
    ContactTime, DetectionPass, EdgeMotion, Ends, FixedOfThree, FixedOfTwo, FixedOne, Integrator, Kind, Limit,
    MassRatio, Motion, NoContactReason, Normal, Place, Radii, Restitution, Side, SomeFixed,
};
use fosssim_model::{
    scene::{self, Collision, Edge, Scene},
    sim::{Detection, Pair, PairKind, Stage},
};
use fosssim_num::{
    polynomial::Polynomial,
    vector::{Vec2, divide, vector_at},
};

/// The share of an edge's length, at each end, within which a position counts as near the end.
const NEAR_END: f64 = 0.05;

/// Returns the stage in which a pair is checked, as a value of a property.
pub(super) const fn stage_value(stage: Stage) -> DetectionPass {
    match stage {
        Stage::Simple | Stage::ContinuousTime => DetectionPass::Continuous,
        Stage::Impulses { round: 0 } => DetectionPass::First,
        Stage::Impulses { .. } => DetectionPass::Later,
        Stage::Geometric { round: 0 } => DetectionPass::Zones,
        Stage::Geometric { .. } => DetectionPass::Grown,
    }
}

pub(super) fn time_range(time: f64) -> ContactTime {
    match time {
        0.0 => ContactTime::Start,
        1.0 => ContactTime::End,
        _ => ContactTime::Within,
    }
}

pub(super) fn restitution(scene: &Scene) -> Restitution {
    match scene.collision {
        Collision::Simple { restitution }
        | Collision::ContinuousTime { restitution }
        | Collision::Hybrid { restitution, .. } => match restitution {
            0.0 => Restitution::Zero,
            1.0 => Restitution::One,
            _ => Restitution::Between,
        },
        Collision::None | Collision::Penalty { .. } => Restitution::One,
    }
}

pub(super) const fn integrator(scene: &Scene) -> Integrator {
    match scene.integrator {
        scene::Integrator::ExplicitEuler => Integrator::Explicit,
        scene::Integrator::ForwardBackwardEuler | scene::Integrator::SymplecticEuler => Integrator::ForwardBackward,
        scene::Integrator::ImplicitEuler => Integrator::Implicit,
        scene::Integrator::LinearizedImplicitEuler => Integrator::Linearized,
    }
}

pub(super) const fn limit(scene: &Scene) -> Limit {
    match scene.collision {
        Collision::Hybrid { max_iterations: ..=0, .. } => Limit::Zero,
        Collision::Hybrid { max_iterations: 1, .. } => Limit::One,
        _ => Limit::More,
    }
}

/// Returns the particles of a pair: both particles, or the particle and both endpoints of the edge.
pub(super) fn bodies(scene: &Scene, pair: Pair) -> Vec<usize> {
    let (one, other) = (pair.first as usize, pair.second as usize);
    match pair.kind {
        PairKind::ParticleParticle => vec![one, other],
        PairKind::ParticleEdge => vec![one, scene.edges[other].first, scene.edges[other].second],
        PairKind::ParticleHalfPlane => vec![one],
    }
}

pub(super) fn count_fixed_of_two(scene: &Scene, bodies: &[usize]) -> FixedOfTwo {
    match (scene.particles[bodies[0]].fixed, scene.particles[bodies[1]].fixed) {
        (false, false) => FixedOfTwo::None,
        (true, false) => FixedOfTwo::First,
        (false, true) => FixedOfTwo::Second,
        (true, true) => FixedOfTwo::Both,
    }
}

pub(super) fn count_fixed_of_three(scene: &Scene, bodies: &[usize]) -> FixedOfThree {
    let fixed = |index: usize| scene.particles[bodies[index]].fixed;
    match (fixed(0), fixed(1), fixed(2)) {
        (false, false, false) => FixedOfThree::None,
        (true, false, false) => FixedOfThree::Particle,
        (false, true, false) => FixedOfThree::First,
        (false, false, true) => FixedOfThree::Second,
        (false, true, true) => FixedOfThree::Ends,
        (true, true, true) => FixedOfThree::All,
        (true, ..) => FixedOfThree::ParticleAndEnd,
    }
}

pub(super) fn fixed_single(scene: &Scene, bodies: &[usize]) -> FixedOne {
    if scene.particles[bodies[0]].fixed { FixedOne::Fixed } else { FixedOne::Free }
}

pub(super) fn any_fixed(scene: &Scene, bodies: &[usize]) -> SomeFixed {
    match bodies.iter().filter(|&&body| scene.particles[body].fixed).count() {
        0 => SomeFixed::None,
        all if all == bodies.len() => SomeFixed::All,
        _ => SomeFixed::Some,
    }
}

pub(super) fn masses(scene: &Scene, bodies: &[usize]) -> MassRatio {
    let first = scene.particles[bodies[0]].mass;
    if bodies.iter().all(|&body| scene.particles[body].mass == first) { MassRatio::Equal } else { MassRatio::Unequal }
}

/// Compares the radii of a pair, and returns whether they are equal. They are those of two particles, or those of a
/// particle and an edge.
pub(super) fn radii(scene: &Scene, bodies: &[usize], edge: Option<&Edge>) -> Radii {
    let first = scene.particles[bodies[0]].radius;
    let equal = match edge {
        Some(edge) => edge.radius == first,
        None => bodies.iter().all(|&body| scene.particles[body].radius == first),
    };
    if equal { Radii::Equal } else { Radii::Unequal }
}

pub(super) const fn convert_kind(kind: PairKind) -> Kind {
    match kind {
        PairKind::ParticleParticle => Kind::Particles,
        PairKind::ParticleEdge => Kind::Edge,
        PairKind::ParticleHalfPlane => Kind::HalfPlane,
    }
}

pub(super) const fn classify_ends(edge: &Edge) -> Ends {
    match (edge.first, edge.second) {
        (first, second) if second == first + 1 => Ends::Next,
        (first, second) if first == second + 1 => Ends::Previous,
        (first, second) if first < second => Ends::Up,
        _ => Ends::Down,
    }
}

/// Returns a body's position at `time`, which is a fraction of the step.
fn position(detection: &Detection<'_>, body: usize, time: f64) -> Vec2 {
    let start = vector_at(detection.q_start, body);
    start + time * (vector_at(detection.q_end, body) - start)
}

pub(super) fn classify_contact_place(detection: &Detection<'_>, bodies: &[usize], time: f64) -> Place {
    let [one, two, three] = [0, 1, 2].map(|index| position(detection, bodies[index], time));
    match (one - two).dot(&(three - two)) / (three - two).dot(&(three - two)) {
        ..NEAR_END => Place::First,
        alpha if alpha > 1.0 - NEAR_END => Place::Second,
        _ => Place::Inside,
    }
}

pub(super) fn classify_edge_motion(detection: &Detection<'_>, bodies: &[usize]) -> EdgeMotion {
    let [two, three] = [1, 2].map(|index| {
        let body = bodies[index];
        vector_at(detection.q_end, body) - vector_at(detection.q_start, body)
    });
    match (two, three) {
        (two, three) if two != three => EdgeMotion::Turned,
        (two, _) if two == Vec2::zeros() => EdgeMotion::Still,
        _ => EdgeMotion::Shifted,
    }
}

pub(super) fn find_side(scene: &Scene, detection: &Detection<'_>) -> Side {
    let plane = &scene.half_planes[detection.pair.second as usize];
    let offset = vector_at(detection.q_start, detection.pair.first as usize) - plane.point;
    if offset.dot(&plane.normal) < 0.0 { Side::Behind } else { Side::Front }
}

pub(super) fn find_normal(scene: &Scene, pair: Pair) -> Normal {
    let normal = scene.half_planes[pair.second as usize].normal;
    if (normal.dot(&normal) - 1.0).abs() < 1e-6 { Normal::Unit } else { Normal::Other }
}

/// Returns why a pair does not collide. It follows from the signs of the pair's polynomials at a few times of this step
/// and the next.
pub(super) fn find_miss_reason(kind: PairKind, polynomials: &[Polynomial]) -> NoContactReason {
    const SAMPLES_PER_STEP: u32 = 8;
    let positive = |polynomial: &Polynomial, time: f64| polynomial.evaluate(time) > 0.0;
    let holds_but = |left_out: usize, range: std::ops::RangeInclusive<u32>| {
        range.map(|time| f64::from(time) / f64::from(SAMPLES_PER_STEP)).any(|time| {
            polynomials.iter().enumerate().all(|(index, polynomial)| positive(polynomial, time) != (index == left_out))
        })
    };
    let approach_index = polynomials.len().saturating_sub(1);
    let is_edge = kind == PairKind::ParticleEdge;
    match () {
        () if holds_but(approach_index, 0..=SAMPLES_PER_STEP) => NoContactReason::Parting,
        () if is_edge && holds_but(1, 0..=SAMPLES_PER_STEP) => NoContactReason::BesideFirst,
        () if is_edge && holds_but(2, 0..=SAMPLES_PER_STEP) => NoContactReason::BesideSecond,
        () if holds_but(polynomials.len(), SAMPLES_PER_STEP + 1..=2 * SAMPLES_PER_STEP) => NoContactReason::Late,
        () => NoContactReason::Never,
    }
}

/// Classifies the motion of a zone, from the start of the step to its positions before the failsafe. The arithmetic is
/// the same as in collisions.md 5, so a zone that does not rotate has an angular momentum of exactly zero.
pub(super) fn classify_zone_motion(scene: &Scene, particles: &[usize], q_start: &[f64], q_end: &[f64]) -> Motion {
    let mass = |particle: usize| scene.particles[particle].mass;
    let displacement = |particle| vector_at(q_end, particle) - vector_at(q_start, particle);
    if particles.iter().all(|&particle| displacement(particle) == Vec2::zeros()) {
        return Motion::Rests;
    }
    let total: f64 = particles.iter().map(|&particle| mass(particle)).sum();
    let mean = |value: &dyn Fn(usize) -> Vec2| {
        let sum = particles.iter().fold(Vec2::zeros(), |sum, &particle| sum + mass(particle) * value(particle));
        divide(sum, total)
    };
    let (center, shift) = (mean(&|particle| vector_at(q_start, particle)), mean(&displacement));
    let angular_momentum = particles.iter().fold(0.0, |sum, &particle| {
        let (arm, relative) = (vector_at(q_start, particle) - center, displacement(particle) - shift);
        sum + mass(particle) * (arm.x * relative.y - arm.y * relative.x)
    });
    if particles.len() == 1 || angular_momentum == 0.0 { Motion::Shifts } else { Motion::Turns }
}
