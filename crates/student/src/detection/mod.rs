//! Continuous-time detection of one pair: its polynomials, the time of impact, the contact vector and the decision.
//!
//! The root finder is the one supplied by the course (`num::first_time`); everything else is the student's.
use fosssim_model::sim::{PairMotion, PointMotion};
use fosssim_num::{
    first_time::first_time_with_steps,
    polynomial::Polynomial,
    vector::{Vec2, length, unit, vector_at},
};

use crate::{
    Area, Mistake,
    assignments::t2m2::{Inputs, Subject},
    author::Student,
    logged_polynomials::logged_polynomial,
    objects::{Contact, Object, Pair},
    rounding::round_to_f32,
    step_failure::StepFailure,
    world::{StepLog, World},
};

mod arithmetic;
mod basis;
mod factorized;
mod frame;
mod handover;
mod normalization;
mod particle_edge;
mod particle_half_plane;
mod particle_particle;
mod variants;
mod wide_numbers;

use frame::Axes;
use particle_edge::alpha;

fosssim_model::drops_leading!();

/// The areas of the mistakes that are made in contact vectors.
const VECTOR_AREAS: &[Area] = &[Area::ContactVector, Area::Handover];

/// The mistakes that reject a contact with a right time.
const REJECTION_MISTAKES: &[Mistake] = &[
    Mistake::DecisionOverlapAtEnd,
    Mistake::DecisionOverlapAtStart,
    Mistake::DecisionAlphaAtStart,
    Mistake::DecisionAlphaAtEnd,
    Mistake::DecisionAlphaMargin,
    Mistake::DecisionApproachMargin,
    Mistake::DecisionHalfPlaneOneSided,
    Mistake::DecisionFixedEdges,
    Mistake::DecisionFixedAtEdges,
    Mistake::DecisionFixedAtHalfPlanes,
];

/// The usual maximum number of steps in the root searches of one pair.
const USUAL_SEARCH_STEPS: u64 = 128;

/// The number of steps after which an endless search is stopped (`num::rpoly`).
const MAX_SEARCH_STEPS: u64 = 1000;

/// The areas of the mistakes in the formulas of each kind of pair.
const FORMULA_AREAS: [Area; 3] = [Area::ParticleParticle, Area::ParticleEdge, Area::ParticleHalfPlane];

/// Returns the motion of a pair, as this student's program reads it from its lists.
fn read_motion(world: &World, pair: Pair, q_start: &[f64], q_end: &[f64]) -> PairMotion {
    let frame = pair_axes(world.student, pair);
    let (student, particle_count) = (world.student, world.scene.particles.len());
    let (kind, number) = pair.object.numbers();
    let slip = IndexSlip::for_student(student, kind);
    let body = |index: usize| {
        let position = |list: &[f64]| {
            if slip.uses_particle_number { Vec2::new(list[index], list[index + 1]) } else { vector_at(list, index) }
        };
        let start = frame.transform_point(position(q_start), vector_at(q_start, pair.particle));
        let end = frame.transform_point(position(q_end), vector_at(q_end, pair.particle));
        PointMotion { start, shift: end - start }
    };
    let radius_of = |role: usize, index: usize| {
        let index = match slip.radius {
            Some(RadiusSlip::Next) => (index + 1) % particle_count,
            Some(RadiusSlip::OfObject) if role == 0 => number % particle_count,
            _ => index,
        };
        world.scene.particles[index].radius
    };
    let (center, radius) = (body(pair.particle), radius_of(0, pair.particle));
    match pair.object {
        Object::Particle(other) => {
            PairMotion::Particles { centers: [center, body(other)], radii: [radius, radius_of(1, other)] }
        }
        Object::Edge(index) => {
            let edge = world.scene.edges[index];
            let measured = if student.makes(Mistake::ParticleEdgeFirstEdgeRadius) { 0 } else { index };
            let edge_radius = match student.mistake_in(&[Area::ParticleEdge]) {
                Some(Mistake::ParticleEdgeFirstEndRadius) => radius_of(1, edge.first),
                Some(Mistake::ParticleEdgeSecondEndRadius) => radius_of(2, edge.second),
                _ => world.scene.edges[measured].radius,
            };
            PairMotion::Edge { center, ends: [body(edge.first), body(edge.second)], radii: [radius, edge_radius] }
        }
        Object::HalfPlane(index) => {
            let index = if student.makes(Mistake::HalfPlaneFirst) { 0 } else { index };
            let plane = world.scene.half_planes[index];
            let point = frame.transform_point(plane.point, vector_at(q_start, pair.particle));
            PairMotion::HalfPlane { center, radius, point, normal: frame.transform_direction(plane.normal) }
        }
    }
}

/// Returns the polynomials that must be positive together, highest power first.
fn polynomials(student: Student, motion: &PairMotion) -> Vec<Vec<f64>> {
    let mut lists = variants::polynomials(student, motion);
    let kind = motion.kind();
    if let Some(edit) = student.mistake_in(&[FORMULA_AREAS[kind as usize]]).and_then(Mistake::formula_edit) {
        let approach = usize::from(student.has_right_approach());
        edit.apply(&Inputs::new(motion), &mut lists, Subject::all_of_kind(kind), approach);
    }
    lists
}

/// Returns the shortest vector from the particle to the object at time `t`.
fn contact_vector(student: Student, motion: &PairMotion, t: f64) -> Vec2 {
    match motion {
        PairMotion::Particles { centers, .. } => particle_particle::contact_vector(student, centers, t),
        PairMotion::Edge { center, ends: [first, second], .. } => {
            particle_edge::contact_vector(student, &[*center, *first, *second], t)
        }
        PairMotion::HalfPlane { center, point, normal, .. } => {
            particle_half_plane::contact_vector(student, center, *point, *normal, t)
        }
    }
}

/// Returns the dot product of the objects' relative displacement and the contact vector at time `t`. It is positive if
/// the objects approach each other.
fn closing_speed(motion: &PairMotion, t: f64) -> f64 {
    let relative = match motion {
        PairMotion::Particles { centers: [one, two], .. } => one.shift - two.shift,
        PairMotion::Edge { center, ends: [first, second], .. } => {
            center.shift - first.shift - alpha(&[*center, *first, *second], t) * (second.shift - first.shift)
        }
        PairMotion::HalfPlane { center, .. } => center.shift,
    };
    relative.dot(&contact_vector(Student::default(), motion, t))
}

/// Returns the distance at which the objects touch.
fn contact_distance(motion: &PairMotion) -> f64 {
    match motion {
        PairMotion::Particles { radii, .. } | PairMotion::Edge { radii, .. } => radii[0] + radii[1],
        PairMotion::HalfPlane { radius, .. } => *radius,
    }
}

/// The slips in the indices at which a program reads the data of a pair, for pairs of one kind.
struct IndexSlip {
    /// Whether positions are read at the particle's number, as if each particle had one coordinate.
    uses_particle_number: bool,
    radius: Option<RadiusSlip>,
}

/// The index at which a radius is read.
enum RadiusSlip {
    /// The radius of the next particle is read.
    Next,
    /// The radius is read at the index of the other object.
    OfObject,
}

impl IndexSlip {
    fn for_student(student: Student, kind: usize) -> Self {
        let (uses_particle_number, radius) = match student.mistake_in(&[FORMULA_AREAS[kind]]) {
            Some(
                Mistake::ParticleParticlePositionIndex
                | Mistake::ParticleEdgePositionIndex
                | Mistake::HalfPlanePositionIndex,
            ) => (true, None),
            Some(Mistake::ParticleParticleNextRadius) => (false, Some(RadiusSlip::Next)),
            Some(Mistake::ParticleEdgeRadiusIndex | Mistake::HalfPlaneRadiusIndex) => {
                (false, Some(RadiusSlip::OfObject))
            }
            _ => (false, None),
        };
        Self { uses_particle_number, radius }
    }
}

/// Returns whether pairs of this kind are checked with the integrator's prediction.
fn uses_prediction(student: Student, kind: usize) -> bool {
    let all = [Mistake::ParticleParticlePrediction, Mistake::ParticleEdgePrediction, Mistake::HalfPlanePrediction];
    student.makes(all[kind])
}

/// Returns the axes in which the student computes with a pair. The formulas do not support a moving half-plane, so for
/// a pair with a half-plane the axes do not move with the particle.
fn pair_axes(student: Student, pair: Pair) -> Axes {
    match (Axes::for_student(student), pair.object) {
        (Axes::Comoving, Object::HalfPlane(_)) => Axes::Scene,
        (frame, _) => frame,
    }
}

/// Returns the polynomials of a pair of bodies by this student's formulas, as passed to the root finder.
pub fn body_polynomials(student: Student, motion: &PairMotion) -> Vec<Vec<f64>> {
    let object = match motion {
        PairMotion::Particles { .. } => Object::Particle(1),
        PairMotion::Edge { .. } => Object::Edge(0),
        PairMotion::HalfPlane { .. } => Object::HalfPlane(0),
    };
    let lists = handover::pass_on(student, object, polynomials(student, motion));
    lists.iter().map(|list| list.coefficients().to_vec()).collect()
}

/// Returns the contact of a pair during the linear motion from `q_start` to `q_end`, or `None` if the pair does not
/// collide. The polynomials are added to `log`. Fails if the guard of the log rejects a polynomial, or if the root
/// finder would search forever.
pub fn detect(
    world: &World,
    pair: Pair,
    q_start: &[f64],
    q_end: &[f64],
    log: &mut StepLog,
) -> Result<Option<Contact>, StepFailure> {
    let student = world.student;
    let is_old = uses_prediction(student, pair.object.numbers().0);
    let prediction = if is_old { log.prediction.clone() } else { None };
    let motion = read_motion(world, pair, q_start, prediction.as_deref().unwrap_or(q_end));
    if student.makes(Mistake::PairsPruned) && is_out_of_reach(&motion) {
        return Ok(None);
    }
    let mut lists = polynomials(student, &motion);
    normalization::normalize(student, &motion, &mut lists);
    if student.makes(Mistake::ThroughBernstein) {
        lists.iter_mut().for_each(|list| *list = basis::convert_through_bernstein(list));
    }
    let polynomials = handover::pass_on(student, pair.object, lists);
    if polynomials.is_empty() {
        return Ok(None);
    }
    let first = log.polynomials.len();
    log.polynomials.extend_from_slice(&polynomials);
    if let Some(guard) = log.guard
        && !(first..log.polynomials.len()).all(|index| guard(index, &logged_polynomial(student, log, index)))
    {
        return Err(StepFailure::Stopped);
    }
    let mut time = search_time(&polynomials, log)?;
    if student.makes(Mistake::ContactTimeSingle) {
        time = round_to_f32(time);
    }
    if !is_within_step(student, &motion, time, world.scene.time_step) {
        return Ok(None);
    }
    let time_unit = if student.makes(Mistake::ContactTimeScaled) { world.scene.time_step } else { 1.0 };
    let mut n = pair_axes(student, pair).transform_back(contact_vector(student, &motion, time_unit * time));
    if matches!(motion, PairMotion::Edge { .. }) && length(n) == 0.0 {
        return Ok(None);
    }
    if is_rejected(student, &motion, time) || rejects_fixed_pair(world, pair) {
        return Ok(None);
    }
    match student.mistake_in(&[Area::ContactVector]) {
        Some(Mistake::ContactUnitLength) => n = unit(n),
        Some(Mistake::ContactSingle) => n = Vec2::new(round_to_f32(n.x), round_to_f32(n.y)),
        Some(Mistake::ContactNoise) => n += 1e-7 * Vec2::new(n.y, n.x),
        _ => {}
    }
    let time = if student.makes(Mistake::ContactTimeZero) { 0.0 } else { time };
    Ok(Some(Contact { pair, n, time }))
}

/// Returns the time of impact. The steps beyond [`USUAL_SEARCH_STEPS`] are added to the log.
fn search_time(polynomials: &[Polynomial], log: &mut StepLog) -> Result<f64, StepFailure> {
    let mut steps = 0;
    let found = first_time_with_steps(polynomials, &mut steps);
    log.long_searches += if found.is_err() { MAX_SEARCH_STEPS } else { steps.saturating_sub(USUAL_SEARCH_STEPS) };
    Ok(found?)
}

/// Returns the contacts of one pass over all pairs, without responses in between.
pub fn detect_contacts(
    world: &World,
    q_start: &[f64],
    q_end: &[f64],
    log: &mut StepLog,
) -> Result<Vec<Contact>, StepFailure> {
    let mut contacts = Vec::new();
    for pair in world.pairs() {
        contacts.extend(detect(world, pair, q_start, q_end, log)?);
    }
    Ok(contacts)
}

/// Returns whether a time of impact is within the step according to this student's program.
fn is_within_step(student: Student, motion: &PairMotion, time: f64, time_step: f64) -> bool {
    let concerns_time = |mistake: &Mistake| mistake.area() == Area::Decision && !REJECTION_MISTAKES.contains(mistake);
    match student.mistakes().find(concerns_time) {
        Some(Mistake::DecisionOpenEnd) => time < 1.0,
        Some(Mistake::DecisionOpenEndParticles) if matches!(motion, PairMotion::Particles { .. }) => time < 1.0,
        Some(Mistake::DecisionOpenEndHalfPlanes) if matches!(motion, PairMotion::HalfPlane { .. }) => time < 1.0,
        Some(Mistake::DecisionOpenStart) => 0.0 < time && time <= 1.0,
        Some(Mistake::DecisionOpenInterval) => 0.0 < time && time < 1.0,
        Some(Mistake::DecisionNoUpperBound) => time < f64::INFINITY,
        Some(Mistake::DecisionSeconds) => time <= time_step,
        Some(Mistake::DecisionHalfStep) => time <= 0.5,
        Some(Mistake::DecisionTolerance) => time <= 1.0 + 1e-6,
        Some(Mistake::DecisionTruth) => time != 0.0,
        Some(Mistake::DecisionNever) => false,
        _ => time <= 1.0,
    }
}

/// Returns whether a further test rejects the impact. Some programs make such a test, which is wrong.
fn is_rejected(student: Student, motion: &PairMotion, time: f64) -> bool {
    let distance = |t: f64| length(contact_vector(student, motion, t));
    match (student.mistake_among(REJECTION_MISTAKES), motion) {
        (Some(Mistake::DecisionOverlapAtEnd), _) => distance(1.0) >= contact_distance(motion),
        (Some(Mistake::DecisionOverlapAtStart), _) => time == 0.0 && distance(0.0) < contact_distance(motion),
        (Some(mistake), PairMotion::Edge { center, ends: [first, second], .. }) => {
            let alpha = |t: f64| alpha(&[*center, *first, *second], t);
            match mistake {
                Mistake::DecisionAlphaAtStart => !(0.0..=1.0).contains(&alpha(0.0)),
                Mistake::DecisionAlphaAtEnd => !(0.0..=1.0).contains(&alpha(1.0)),
                Mistake::DecisionAlphaMargin => !(0.05..=0.95).contains(&alpha(time)),
                Mistake::DecisionApproachMargin => closing_speed(motion, time) <= 1e-6,
                _ => false,
            }
        }
        (Some(Mistake::DecisionApproachMargin), _) => closing_speed(motion, time) <= 1e-6,
        (Some(Mistake::DecisionHalfPlaneOneSided), PairMotion::HalfPlane { center, point, normal, .. }) => {
            (center.start - *point).dot(normal) < 0.0
        }
        _ => false,
    }
}

/// Returns whether this student's program rejects the impact because something is fixed.
fn rejects_fixed_pair(world: &World, pair: Pair) -> bool {
    match (world.student.mistake_among(REJECTION_MISTAKES), pair.object) {
        (Some(Mistake::DecisionFixedAtEdges), Object::Edge(_))
        | (Some(Mistake::DecisionFixedAtHalfPlanes), Object::HalfPlane(_)) => world.is_fixed(pair.particle),
        (Some(Mistake::DecisionFixedEdges), Object::Edge(index)) => {
            let edge = world.scene.edges[index];
            world.is_fixed(edge.first) && world.is_fixed(edge.second)
        }
        _ => false,
    }
}

/// Returns whether the particles' paths stay far apart, judged by bounding circles. The assignment does not require
/// this test.
fn is_out_of_reach(motion: &PairMotion) -> bool {
    let PairMotion::Particles { centers: [one, two], radii } = motion else { return false };
    length(two.start - one.start) > radii[0] + radii[1] + length(one.shift) + length(two.shift)
}
