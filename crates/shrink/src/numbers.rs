//! The numbers of a scene, and rounder numbers to replace them.
use crate::beginnings::set_steps;
use fosssim_model::scene::{Collision, Force, Scene};

/// The meaning of a number in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SceneNumber {
    /// A coordinate of a place; a scene has no origin of its own.
    Place,
    /// A component of a velocity.
    Velocity,
    /// A component of a half-plane's normal or of a force.
    Direction,
    /// A mass or a radius.
    Body,
    /// A constant of a force or of the collision handling.
    Constant,
    /// A thickness, a damping or a rest length.
    Extra,
    /// The time step.
    TimeStep,
}

impl SceneNumber {
    /// Returns the simplest value, which needs no thought.
    pub(crate) const fn plain(self) -> f64 {
        match self {
            Self::Place | Self::Velocity | Self::Direction | Self::Extra => 0.0,
            Self::Body | Self::Constant | Self::TimeStep => 1.0,
        }
    }
}

/// The powers of length and of time in a unit; those of mass stay as they are.
type Unit = [i32; 2];

const NUMBER: Unit = [0, 0];
const LENGTH: Unit = [1, 0];
const PER_TIME: Unit = [0, -1];
const PER_TIME_SQUARED: Unit = [0, -2];

/// Returns all numbers of a scene with their units, in its order. A caller that changes the time step sets the
/// duration, too.
pub(crate) fn numbers(scene: &mut Scene) -> Vec<(SceneNumber, Unit, &mut f64)> {
    use SceneNumber::{Body, Constant, Direction, Extra, Place, TimeStep, Velocity};
    let mut all = vec![(TimeStep, [0, 1], &mut scene.time_step)];
    match &mut scene.collision {
        Collision::None => {}
        Collision::Simple { restitution } | Collision::ContinuousTime { restitution } => {
            all.push((Constant, NUMBER, restitution));
        }
        Collision::Penalty { stiffness, thickness, .. } => {
            all.extend([(Constant, PER_TIME_SQUARED, stiffness), (Extra, LENGTH, thickness)]);
        }
        Collision::Hybrid { restitution, stiffness, thickness, .. } => {
            // The penalty force of `hybrid` is an addition.
            all.push((Constant, NUMBER, restitution));
            all.extend([(Extra, PER_TIME_SQUARED, stiffness), (Extra, LENGTH, thickness)]);
        }
    }
    for particle in &mut scene.particles {
        all.extend(particle.position.iter_mut().map(|value| (Place, LENGTH, value)));
        all.extend(particle.velocity.iter_mut().map(|value| (Velocity, [1, -1], value)));
        all.extend([(Body, NUMBER, &mut particle.mass), (Body, LENGTH, &mut particle.radius)]);
    }
    all.extend(scene.edges.iter_mut().map(|edge| (Body, LENGTH, &mut edge.radius)));
    for plane in &mut scene.half_planes {
        all.extend(plane.point.iter_mut().map(|value| (Place, LENGTH, value)));
        all.extend(plane.normal.iter_mut().map(|value| (Direction, NUMBER, value)));
    }
    for force in &mut scene.forces {
        match force {
            Force::Spring { stiffness, rest_length, damping, .. } => {
                all.extend([(Constant, PER_TIME_SQUARED, stiffness), (Extra, LENGTH, rest_length)]);
                all.push((Extra, PER_TIME, damping));
            }
            Force::SimpleGravity { acceleration: vector } | Force::Constant { force: vector } => {
                all.extend(vector.iter_mut().map(|value| (Direction, [1, -2], value)));
            }
            Force::Gravitation { constant, .. } => all.push((Constant, [3, -2], constant)),
            Force::Drag { coefficient } => all.push((Constant, PER_TIME, coefficient)),
            Force::Vortex { strength, coupling, .. } => {
                all.extend([(Constant, [1, -1], strength), (Constant, [2, -1], coupling)]);
            }
        }
    }
    all
}

/// Returns the scene with each number replaced.
fn map_numbers(scene: &Scene, mut replace: impl FnMut(SceneNumber, Unit, f64) -> f64) -> Scene {
    let (mut scene, steps) = (scene.clone(), scene.steps());
    numbers(&mut scene).into_iter().for_each(|(quantity, unit, value)| *value = replace(quantity, unit, *value));
    set_steps(&mut scene, steps);
    scene
}

/// Returns the number with this number of decimals.
fn round_to(value: f64, decimals: usize) -> f64 {
    let rounded: f64 = format!("{value:.decimals$}").parse().unwrap_or(value);
    // Without the sign of a zero.
    rounded + 0.0
}

/// Returns the scene moved, turned, mirrored and scaled in many ways, each with all numbers rounded.
pub(crate) fn transformed_scenes(scene: &Scene) -> Vec<Scene> {
    let mut all = vec![scene.clone()];
    for radius in scene.particles.iter().map(|particle| particle.radius).chain(scene.edges.iter().map(|e| e.radius)) {
        all.extend((radius != 1.0 && radius > 0.0).then(|| scale(scene, 1.0 / radius, 1.0)));
    }
    let in_seconds: Vec<Scene> = all.iter().map(|one| scale(one, 1.0, 1.0 / one.time_step)).collect();
    all.extend(in_seconds);
    // Bodies that move little in a step leave no room for round numbers.
    let is_velocity = |quantity| quantity == SceneNumber::Velocity;
    let faster = |scene: &Scene, factor: f64| {
        map_numbers(scene, |quantity, _, value| if is_velocity(quantity) { factor * value } else { value })
    };
    let hurried: Vec<Scene> = all.iter().flat_map(|one| [2.0, 10.0, 100.0].map(|by| faster(one, by))).collect();
    all.extend(hurried);
    let moved = all.iter().flat_map(|one| origins(one).into_iter().map(|origin| translate(one, origin)));
    let all: Vec<Scene> = moved.collect();
    let round = |scene: &Scene, decimals| map_numbers(scene, |_, _, value| round_to(value, decimals));
    (0..=2).flat_map(|decimals| all.iter().map(move |one| round(one, decimals))).collect()
}

/// Returns the places that may become the origin.
fn origins(scene: &Scene) -> Vec<[f64; 2]> {
    let bodies = scene.particles.iter().map(|particle| particle.position);
    let places = bodies.chain(scene.half_planes.iter().map(|plane| plane.point)).take(4);
    places.map(|place| [place.x, place.y]).collect()
}

fn translate(scene: &Scene, origin: [f64; 2]) -> Scene {
    let mut components = origin.into_iter().cycle();
    map_numbers(scene, |quantity, _, value| match quantity {
        SceneNumber::Place => value - components.next().unwrap_or_default(),
        _ => value,
    })
}

/// Returns the scene turned by right angles, and mirrored.
pub(crate) fn turned_scenes(scene: &Scene) -> Vec<Scene> {
    use SceneNumber::{Direction, Place, Velocity};
    let turn = |[[xx, xy], [yx, yy]]: [[f64; 2]; 2]| {
        let mut turned = scene.clone();
        let vectors =
            numbers(&mut turned).into_iter().filter(|(kind, ..)| matches!(kind, Place | Velocity | Direction));
        let mut components: Vec<&mut f64> = vectors.map(|(.., value)| value).collect();
        for vector in components.chunks_exact_mut(2) {
            let (x, y) = (*vector[0], *vector[1]);
            (*vector[0], *vector[1]) = (xx * x + xy * y + 0.0, yx * x + yy * y + 0.0);
        }
        turned
    };
    let (x, y) = ([1.0, 0.0], [0.0, 1.0]);
    let (left, down) = ([-1.0, 0.0], [0.0, -1.0]);
    [[y, left], [down, x], [left, down], [left, y], [x, down], [y, x], [down, left]].map(turn).into()
}

/// Returns the scene with other units of length and of time.
fn scale(scene: &Scene, length: f64, time: f64) -> Scene {
    let power = |base: f64, exponent: i32| {
        let factor = if exponent < 0 { 1.0 / base } else { base };
        (0..exponent.abs()).map(|_| factor).product::<f64>()
    };
    map_numbers(scene, |_, [of_length, of_time], value| value * power(length, of_length) * power(time, of_time))
}

/// Returns the scene with rounder numbers for its `index`-th, the roundest first; none after the last one.
pub(crate) fn rounder(scene: &Scene, index: usize) -> Option<Vec<Scene>> {
    let mut copy = scene.clone();
    let (quantity, value) = numbers(&mut copy).into_iter().nth(index).map(|(quantity, _, value)| (quantity, *value))?;
    let whole = [value.trunc(), value.trunc() + value.signum()];
    let plain = [quantity.plain(), 0.0, 1.0, 2.0, 0.5, 3.0, 4.0, -value, -1.0, -2.0];
    let round = (0..=4).map(|decimals| round_to(value, decimals));
    let with = |new: f64| {
        let (mut scene, steps) = (scene.clone(), scene.steps());
        *numbers(&mut scene).swap_remove(index).2 = new;
        set_steps(&mut scene, steps);
        scene
    };
    Some(plain.into_iter().chain(whole).chain(round).map(with).collect())
}
