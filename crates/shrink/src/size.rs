//! Measures the complexity of a scene, which is the number of parts, numbers and digits that its reader must follow.
use fosssim_model::{
    assignments::Assignment,
    scene::{self, Collision, Force, Integrator, Scene},
    sim::{RootSearch, Simulation},
    trace::EventCounts,
};

/// The maximum number of digits of a number that people compute by hand.
const HAND_DIGITS: usize = 3;
/// The relative and absolute change of numbers that must not change the result, and the factor by which the change may
/// grow.
const NUMBER_SHIFT: f64 = 1e-9;
const MAX_GROWTH: f64 = 1e4;

/// The kind of a number in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NumberKind {
    /// The number is a coordinate of a position. A scene may be moved, so no coordinate is special.
    Place,
    /// The number is 0 in the simplest case, such as a thickness or a component of a velocity.
    Addition,
    /// The number is 1 in the simplest case, such as a mass or the time step.
    Factor,
}

impl NumberKind {
    /// Returns the simplest value, with which a reader need not compute.
    pub(crate) fn simplest_value(self) -> f64 {
        f64::from(u8::from(self == Self::Factor))
    }
}

/// Returns all numbers of a scene in its order, the time step first. A caller that changes the time step sets the
/// duration as well.
pub(crate) fn list_numbers(scene: &mut Scene) -> Vec<(NumberKind, &mut f64)> {
    use NumberKind::{Addition, Factor, Place};
    let mut all = vec![(Factor, &mut scene.time_step)];
    match &mut scene.collision {
        Collision::None => {}
        Collision::Simple { restitution } | Collision::ContinuousTime { restitution } => {
            all.push((Factor, restitution));
        }
        Collision::Penalty { stiffness, thickness, .. } => all.extend([(Factor, stiffness), (Addition, thickness)]),
        // The penalty force of `hybrid` is an addition.
        Collision::Hybrid { restitution, stiffness, thickness, .. } => {
            all.extend([(Factor, restitution), (Addition, stiffness), (Addition, thickness)]);
        }
    }
    for particle in &mut scene.particles {
        all.extend(particle.position.iter_mut().map(|value| (Place, value)));
        all.extend(particle.velocity.iter_mut().map(|value| (Addition, value)));
        all.extend([(Factor, &mut particle.mass), (Factor, &mut particle.radius)]);
    }
    all.extend(scene.edges.iter_mut().map(|edge| (Factor, &mut edge.radius)));
    for plane in &mut scene.half_planes {
        all.extend(plane.point.iter_mut().map(|value| (Place, value)));
        all.extend(plane.normal.iter_mut().map(|value| (Addition, value)));
    }
    for force in &mut scene.forces {
        match force {
            Force::Spring { stiffness, rest_length, damping, .. } => {
                all.extend([(Factor, stiffness), (Addition, rest_length), (Addition, damping)]);
            }
            Force::SimpleGravity { acceleration: vector } | Force::Constant { force: vector } => {
                all.extend(vector.iter_mut().map(|value| (Addition, value)));
            }
            Force::Gravitation { constant: factor, .. } | Force::Drag { coefficient: factor } => {
                all.push((Factor, factor));
            }
            Force::Vortex { strength, coupling, .. } => all.extend([(Factor, strength), (Factor, coupling)]),
        }
    }
    all
}

/// Sets the duration to this number of steps.
pub(crate) fn set_steps(scene: &mut Scene, steps: u32) {
    scene.duration = scene.time_step * f64::from(steps);
    if scene.step_count() != steps {
        scene.duration = scene.time_step * (f64::from(steps) - 0.5);
    }
}

/// The size of a scene: the first number that differs decides which of two is smaller.
pub(crate) type Size = ([usize; 9], f64);

/// Returns the size of a scene, with the most important part first:
///
/// 1. whether the result depends on round-off;
/// 2. warnings, and parts that programs of the assignment do not support;
/// 3. steps;
/// 4. bodies;
/// 5. edges and half-planes;
/// 6. forces;
/// 7. features that are not the plainest;
/// 8. collisions that the reference detects;
/// 9. digits of numbers that are not plain (a mass of 1 is plain), and of results that are too long to compute by hand;
/// 10. magnitudes and signs, where 1 is before 7 and 7 before -7.
pub(crate) fn measure_size(scene: &Scene, assignment: Assignment) -> Size {
    use Integrator::{ExplicitEuler, ForwardBackwardEuler, ImplicitEuler, LinearizedImplicitEuler, SymplecticEuler};
    let mut copy = scene.clone();
    let not_plain = list_numbers(&mut copy).into_iter().filter(|(kind, value)| **value != kind.simplest_value());
    let (mut written, mut magnitude) = (0, 0.0);
    for (_, value) in not_plain {
        written += count_digits(*value);
        magnitude += value.abs() + if *value < 0.0 { 0.01 } else { 0.0 };
    }
    let efforts = [ExplicitEuler, SymplecticEuler, ForwardBackwardEuler, LinearizedImplicitEuler, ImplicitEuler];
    let effort_index = efforts.iter().position(|integrator| *integrator == scene.integrator).unwrap_or_default();
    let handling = match scene.collision {
        Collision::None => 0,
        Collision::Simple { .. } | Collision::Penalty { .. } | Collision::ContinuousTime { .. } => 1,
        Collision::Hybrid { .. } => 2,
    };
    let fixed_count = scene.particles.iter().filter(|particle| particle.fixed).count();
    let (events, end) = simulate(scene).unwrap_or_default();
    let hits = events.hits.values().sum::<u64>() as usize;
    let extra_digits: usize = end.iter().map(|value| count_digits(*value).saturating_sub(HAND_DIGITS)).sum();
    let (steps, bodies) = (scene.step_count() as usize, scene.particles.len());
    let (objects, features) = (scene.edges.len() + scene.half_planes.len(), effort_index + handling + fixed_count);
    let (unclear, oddities) = (usize::from(!is_clear(scene)), count_oddities(scene, assignment));
    ([unclear, oddities, steps, bodies, objects, scene.forces.len(), features, hits, written + extra_digits], magnitude)
}

/// Returns the number of warnings about a scene, and of its parts that programs of the assignment do not support. For a
/// scene that cannot be read back, returns the largest number.
fn count_oddities(scene: &Scene, assignment: Assignment) -> usize {
    let loaded = scene::read("", scene::to_xml(scene).as_bytes()).ok().filter(|loaded| loaded.scene == *scene);
    loaded.map_or(usize::MAX, |loaded| loaded.warnings.len() + scene.unknown_features(assignment).count())
}

/// Returns the number of digits of a number as it is written, without the zero before its point: 2 for 0.05, for 1.5
/// and for 10.
fn count_digits(value: f64) -> usize {
    let text = value.abs().to_string();
    text.strip_prefix("0.").unwrap_or(&text).chars().filter(char::is_ascii_digit).count()
}

/// Returns whether the reference has a result, and round-off cannot change the result.
pub(crate) fn is_clear(scene: &Scene) -> bool {
    let Some((events, end)) = simulate(scene) else { return false };
    (1..=2_usize).all(|seed| {
        let mut shifted = scene.clone();
        for (index, (_, value)) in list_numbers(&mut shifted).into_iter().enumerate().skip(1) {
            // The number moves up or down, as if by chance (Knuth's multiplicative hashing).
            let is_up = (seed * 64 + index).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 63 == 0;
            *value += if is_up { NUMBER_SHIFT } else { -NUMBER_SHIFT } * (1.0 + value.abs());
        }
        let is_near = |(one, other): (&f64, &f64)| (one - other).abs() <= NUMBER_SHIFT * MAX_GROWTH * (1.0 + one.abs());
        simulate(&shifted).is_some_and(|(others, other)| others == events && end.iter().zip(&other).all(is_near))
    })
}

/// Runs the reference, and returns its events and all numbers of its last state, or `None` if a step has no result.
pub(crate) fn simulate(scene: &Scene) -> Option<(EventCounts, Vec<f64>)> {
    let (mut events, mut simulation) = (EventCounts::new(scene), Simulation::new(scene, RootSearch::OnDemand));
    for _ in 0..scene.step_count() {
        simulation.step(&mut events).ok()?;
    }
    let state = simulation.state();
    state.is_finite().then(|| (events, [&state.positions[..], &state.velocities].concat()))
}
