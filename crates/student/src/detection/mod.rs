//! Continuous-time detection of one pair: its polynomials, the time of impact, the contact vector, the decision.
//!
//! The root finder is the one that the course supplies (`num::first_time`); everything else is the student's.
use fosssim_model::sim::{PairMotion, PointMotion};
use fosssim_num::{
    first_time::first_time_counted,
    polynomial::Polynomial,
    vector::{Vec2, at, length, unit},
};

use crate::{
    Area, Mistake,
    author::Student,
    encounter::{Encounter, MovingBody, alpha},
    objects::{Contact, Object, Pair},
    rounding::single,
    step_failure::StepFailure,
    world::{StepLog, World},
};

mod arithmetic;
mod basis;
mod factorized;
mod frame;
mod handover;
mod normalized;
mod particle_edge;
mod particle_half_plane;
mod particle_particle;
mod quintic;
mod wide;

use frame::Axes;

fosssim_model::drops_leading!();

/// The parts of the assignment whose mistakes are made in contact vectors.
const VECTORS: &[Area] = &[Area::ContactVector, Area::Handover];

/// The mistakes that reject a contact whose time is right.
const REJECTIONS: &[Mistake] = &[
    Mistake::DecisionOverlapAtEnd,
    Mistake::DecisionOverlapAtStart,
    Mistake::DecisionAlphaAtStart,
    Mistake::DecisionAlphaAtEnd,
    Mistake::DecisionAlphaMargin,
    Mistake::DecisionApproachMargin,
    Mistake::DecisionHalfPlaneOneSided,
    Mistake::DecisionFixedEdges,
];

/// The steps that the root searches of one pair usually take at most.
const USUAL_SEARCH: u64 = 128;

/// The steps after which a search without end is given up (`num::rpoly`).
const ENDLESS_SEARCH: u64 = 1000;

impl Encounter {
    fn new(world: &World, pair: Pair, q_start: &[f64], q_end: &[f64]) -> Self {
        let frame = axes_of(world.student, pair);
        let (student, all) = (world.student, world.scene.particles.len());
        let (kind, _) = pair.object.numbers();
        let slip = IndexSlip::for_student(student, kind);
        let body = |role: usize, index: usize| {
            let place = |list: &[f64]| {
                if slip.is_single { Vec2::new(list[index], list[index + 1]) } else { at(list, index) }
            };
            let start = frame.point(place(q_start), at(q_start, pair.particle));
            let end = frame.point(place(q_end), at(q_end, pair.particle));
            let (_, number) = pair.object.numbers();
            let radius = match slip.radius {
                Some(RadiusSlip::Next) => (index + 1) % all,
                Some(RadiusSlip::OfObject) if role == 0 => number % all,
                _ => index,
            };
            MovingBody { start, displacement: end - start, radius: world.scene.particles[radius].radius }
        };
        let particle = body(0, pair.particle);
        match pair.object {
            Object::Particle(other) => Self::Particles(particle, body(1, other)),
            Object::Edge(index) => {
                let edge = world.scene.edges[index];
                let measured = if student.makes(Mistake::ParticleEdgeFirstEdgeRadius) { 0 } else { index };
                let bodies = [particle, body(1, edge.first), body(2, edge.second)];
                let radius = match student.mistake_in(&[Area::ParticleEdge]) {
                    Some(Mistake::ParticleEdgeFirstEndRadius) => bodies[1].radius,
                    Some(Mistake::ParticleEdgeSecondEndRadius) => bodies[2].radius,
                    _ => world.scene.edges[measured].radius,
                };
                Self::Edge(bodies, radius)
            }
            Object::HalfPlane(index) => {
                let index = if student.makes(Mistake::HalfPlaneFirst) { 0 } else { index };
                let plane = world.scene.half_planes[index];
                let point = frame.point(plane.point, at(q_start, pair.particle));
                Self::HalfPlane(particle, point, frame.direction(plane.normal))
            }
        }
    }

    /// Returns the coefficients that have to be positive together, highest power first.
    fn polynomials(&self, student: Student) -> Vec<Vec<f64>> {
        match self {
            Self::Particles(one, two) => particle_particle::polynomials(student, one, two),
            Self::Edge(bodies, radius) => particle_edge::polynomials(student, bodies, *radius),
            Self::HalfPlane(one, point, normal) => particle_half_plane::polynomials(student, one, *point, *normal),
        }
    }

    /// Returns the shortest vector from the particle to the object at time `t`.
    fn contact_vector(&self, student: Student, t: f64) -> Vec2 {
        match self {
            Self::Particles(one, two) => particle_particle::contact_vector(student, one, two, t),
            Self::Edge(bodies, _) => particle_edge::contact_vector(student, bodies, t),
            Self::HalfPlane(one, point, normal) => {
                particle_half_plane::contact_vector(student, one, *point, *normal, t)
            }
        }
    }

    /// Returns the speed at which the objects approach each other at time `t`: their relative displacement along the
    /// contact vector.
    fn closing(&self, t: f64) -> f64 {
        let relative = match self {
            Self::Particles(one, two) => one.displacement - two.displacement,
            Self::Edge(bodies, _) => {
                let [one, two, three] = bodies.map(|body| body.displacement);
                one - two - alpha(bodies, t) * (three - two)
            }
            Self::HalfPlane(one, ..) => one.displacement,
        };
        relative.dot(&self.contact_vector(Student::default(), t))
    }

    /// Returns the least distance of the centers.
    fn reach(&self) -> f64 {
        match self {
            Self::Particles(one, two) => one.radius + two.radius,
            Self::Edge([one, ..], radius) => one.radius + radius,
            Self::HalfPlane(one, ..) => one.radius,
        }
    }
}

/// The lists that a program reads at a wrong index for pairs of a kind.
struct IndexSlip {
    /// Positions at the particle's number, as if each had one coordinate.
    is_single: bool,
    radius: Option<RadiusSlip>,
}

/// The index at which a radius is read.
enum RadiusSlip {
    /// The next particle's.
    Next,
    /// The number of the other object.
    OfObject,
}

impl IndexSlip {
    fn for_student(student: Student, kind: usize) -> Self {
        let area = [Area::ParticleParticle, Area::ParticleEdge, Area::ParticleHalfPlane][kind];
        let (is_single, radius) = match student.mistake_in(&[area]) {
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
        Self { is_single, radius }
    }
}

/// Returns whether pairs of this kind are checked on the integrator's prediction.
fn is_on_prediction(student: Student, kind: usize) -> bool {
    let all = [Mistake::ParticleParticlePrediction, Mistake::ParticleEdgePrediction, Mistake::HalfPlanePrediction];
    student.makes(all[kind])
}

/// Returns the coordinates for this pair. A half-plane that moves has no formulas, so the coordinates do not move along
/// with its particle.
fn axes_of(student: Student, pair: Pair) -> Axes {
    match (Axes::for_student(student), pair.object) {
        (Axes::Comoving, Object::HalfPlane(_)) => Axes::Scene,
        (frame, _) => frame,
    }
}

/// Returns the polynomials that this student's formulas give for a pair of bodies, as they are handed to the root
/// finder.
#[must_use]
pub fn polynomials_of(student: Student, motion: &PairMotion) -> Vec<Vec<f64>> {
    let body = |point: &PointMotion, radius: f64| MovingBody { start: point.start, displacement: point.shift, radius };
    let (encounter, object) = match motion {
        PairMotion::Particles { centers: [one, two], radii } => {
            (Encounter::Particles(body(one, radii[0]), body(two, radii[1])), Object::Particle(1))
        }
        PairMotion::Edge { center, ends: [first, second], radii } => {
            let bodies = [body(center, radii[0]), body(first, radii[1]), body(second, radii[1])];
            (Encounter::Edge(bodies, radii[1]), Object::Edge(0))
        }
        PairMotion::HalfPlane { center, radius, point, normal } => {
            (Encounter::HalfPlane(body(center, *radius), *point, *normal), Object::HalfPlane(0))
        }
    };
    let lists = handover::hand_over(student, object, encounter.polynomials(student));
    lists.iter().map(|list| list.coefficients().to_vec()).collect()
}

/// Checks whether a pair collides while everything moves evenly from `q_start` to `q_end`, and logs its polynomials.
pub fn detect(
    world: &World,
    pair: Pair,
    q_start: &[f64],
    q_end: &[f64],
    log: &mut StepLog,
) -> Result<Option<Contact>, StepFailure> {
    let student = world.student;
    let is_old = is_on_prediction(student, pair.object.numbers().0);
    let prediction = if is_old { log.prediction.clone() } else { None };
    let encounter = Encounter::new(world, pair, q_start, prediction.as_deref().unwrap_or(q_end));
    if student.makes(Mistake::PairsPruned) && out_of_reach(&encounter) {
        return Ok(None);
    }
    let mut lists = encounter.polynomials(student);
    normalized::normalize(student, &encounter, &mut lists);
    if student.makes(Mistake::ThroughBernstein) {
        lists.iter_mut().for_each(|list| *list = basis::through_bernstein(list));
    }
    let polynomials = handover::hand_over(student, pair.object, lists);
    if polynomials.is_empty() {
        return Ok(None);
    }
    let first = log.polynomials.len();
    log.polynomials.extend_from_slice(&polynomials);
    if let Some(guard) = log.guard
        && !polynomials.iter().enumerate().all(|(number, polynomial)| guard(first + number, polynomial.coefficients()))
    {
        return Err(StepFailure::Refused);
    }
    let mut time = searched_time(&polynomials, log)?;
    if student.makes(Mistake::ContactTimeSingle) {
        time = single(time);
    }
    if !within_step(student, time, world.scene.time_step) {
        return Ok(None);
    }
    let mut n = axes_of(student, pair).back(encounter.contact_vector(student, time));
    if matches!(encounter, Encounter::Edge(..)) && length(n) == 0.0 {
        return Ok(None);
    }
    if is_rejected(student, &encounter, time) || (student.makes(Mistake::DecisionFixedEdges) && is_held(world, pair)) {
        return Ok(None);
    }
    match student.mistake_in(&[Area::ContactVector]) {
        Some(Mistake::ContactUnitLength) => n = unit(n),
        Some(Mistake::ContactSingle) => n = Vec2::new(single(n.x), single(n.y)),
        Some(Mistake::ContactNoise) => n += 1e-7 * Vec2::new(n.y, n.x),
        _ => {}
    }
    let time = if student.makes(Mistake::ContactTimeZero) { 0.0 } else { time };
    Ok(Some(Contact { pair, n, time }))
}

/// Returns the time of impact; the log counts what its search takes beyond the usual.
fn searched_time(polynomials: &[Polynomial], log: &mut StepLog) -> Result<f64, StepFailure> {
    let mut steps = 0;
    let found = first_time_counted(polynomials, &mut steps);
    log.long_searches += if found.is_err() { ENDLESS_SEARCH } else { steps.saturating_sub(USUAL_SEARCH) };
    Ok(found?)
}

/// Returns one pass over all pairs, with no response in between.
pub fn pass(world: &World, q_start: &[f64], q_end: &[f64], log: &mut StepLog) -> Result<Vec<Contact>, StepFailure> {
    let mut contacts = Vec::new();
    for pair in world.pairs() {
        contacts.extend(detect(world, pair, q_start, q_end, log)?);
    }
    Ok(contacts)
}

/// Returns whether a time of impact is within the step.
fn within_step(student: Student, time: f64, time_step: f64) -> bool {
    let is_of_time =
        |mistake: &Mistake| [Area::Decision, Area::Process].contains(&mistake.area()) && !REJECTIONS.contains(mistake);
    match student.mistakes().find(is_of_time) {
        Some(Mistake::DecisionOpenEnd) => time < 1.0,
        Some(Mistake::DecisionOpenStart) => 0.0 < time && time <= 1.0,
        Some(Mistake::DecisionOpenInterval) => 0.0 < time && time < 1.0,
        Some(Mistake::DecisionNoUpperBound) => time < f64::INFINITY,
        Some(Mistake::DecisionSeconds) => time <= time_step,
        Some(Mistake::DecisionHalfStep) => time <= 0.5,
        Some(Mistake::DecisionTolerance) => time <= 1.0 + 1e-6,
        Some(Mistake::DecisionTruth) => time != 0.0,
        Some(Mistake::DecisionNever | Mistake::HostileForgedVerdict) => false,
        _ => time <= 1.0,
    }
}

/// Returns whether a further test rejects the impact; some programs make such tests, and should not.
fn is_rejected(student: Student, encounter: &Encounter, time: f64) -> bool {
    match (student.mistake_among(REJECTIONS), encounter) {
        (Some(Mistake::DecisionOverlapAtEnd), _) => length(encounter.contact_vector(student, 1.0)) >= encounter.reach(),
        (Some(Mistake::DecisionOverlapAtStart), _) => {
            time == 0.0 && length(encounter.contact_vector(student, 0.0)) < encounter.reach()
        }
        (Some(Mistake::DecisionAlphaAtStart), Encounter::Edge(bodies, _)) => !(0.0..=1.0).contains(&alpha(bodies, 0.0)),
        (Some(Mistake::DecisionAlphaAtEnd), Encounter::Edge(bodies, _)) => !(0.0..=1.0).contains(&alpha(bodies, 1.0)),
        (Some(Mistake::DecisionAlphaMargin), Encounter::Edge(bodies, _)) => {
            !(0.05..=0.95).contains(&alpha(bodies, time))
        }
        (Some(Mistake::DecisionApproachMargin), _) => encounter.closing(time) <= 1e-6,
        (Some(Mistake::DecisionHalfPlaneOneSided), Encounter::HalfPlane(one, point, normal)) => {
            (one.start - *point).dot(normal) < 0.0
        }
        _ => false,
    }
}

/// Returns whether the pair's edge has two fixed ends.
fn is_held(world: &World, pair: Pair) -> bool {
    let Object::Edge(index) = pair.object else { return false };
    let edge = world.scene.edges[index];
    world.fixed(edge.first) && world.fixed(edge.second)
}

/// Returns whether the particles' paths stay far apart, judged by bounding circles. The assignment does not require
/// this.
fn out_of_reach(encounter: &Encounter) -> bool {
    let Encounter::Particles(one, two) = encounter else { return false };
    length(two.start - one.start) > one.radius + two.radius + length(one.displacement) + length(two.displacement)
}
