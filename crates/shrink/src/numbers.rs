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

/// Returns all numbers of a scene, in its order. A caller that changes the time step sets the duration, too.
pub(crate) fn numbers(scene: &mut Scene) -> Vec<(SceneNumber, &mut f64)> {
    use SceneNumber::{Body, Constant, Direction, Extra, Place, TimeStep, Velocity};
    let mut all = vec![(TimeStep, &mut scene.time_step)];
    match &mut scene.collision {
        Collision::None => {}
        Collision::Simple { restitution } | Collision::ContinuousTime { restitution } => {
            all.push((Constant, restitution));
        }
        Collision::Penalty { stiffness, thickness, .. } => all.extend([(Constant, stiffness), (Extra, thickness)]),
        Collision::Hybrid { restitution, stiffness, thickness, .. } => {
            // The penalty force of `hybrid` is an addition.
            all.extend([(Constant, restitution), (Extra, stiffness), (Extra, thickness)]);
        }
    }
    for particle in &mut scene.particles {
        all.extend(particle.position.iter_mut().map(|value| (Place, value)));
        all.extend(particle.velocity.iter_mut().map(|value| (Velocity, value)));
        all.extend([(Body, &mut particle.mass), (Body, &mut particle.radius)]);
    }
    all.extend(scene.edges.iter_mut().map(|edge| (Body, &mut edge.radius)));
    for plane in &mut scene.half_planes {
        all.extend(plane.point.iter_mut().map(|value| (Place, value)));
        all.extend(plane.normal.iter_mut().map(|value| (Direction, value)));
    }
    for force in &mut scene.forces {
        match force {
            Force::Spring { stiffness, rest_length, damping, .. } => {
                all.extend([(Constant, stiffness), (Extra, rest_length), (Extra, damping)]);
            }
            Force::SimpleGravity { acceleration: vector } | Force::Constant { force: vector } => {
                all.extend(vector.iter_mut().map(|value| (Direction, value)));
            }
            Force::Gravitation { constant: value, .. } | Force::Drag { coefficient: value } => {
                all.push((Constant, value));
            }
            Force::Vortex { strength, coupling, .. } => all.extend([(Constant, strength), (Constant, coupling)]),
        }
    }
    all
}

/// Returns the scene with each number replaced.
fn map_numbers(scene: &Scene, mut replace: impl FnMut(SceneNumber, f64) -> f64) -> Scene {
    let (mut scene, steps) = (scene.clone(), scene.steps());
    numbers(&mut scene).into_iter().for_each(|(quantity, value)| *value = replace(quantity, *value));
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
        map_numbers(scene, |quantity, value| if is_velocity(quantity) { factor * value } else { value })
    };
    let hurried: Vec<Scene> = all.iter().flat_map(|one| [2.0, 10.0, 100.0].map(|by| faster(one, by))).collect();
    all.extend(hurried);
    let moved = all.iter().flat_map(|one| origins(one).into_iter().map(|origin| translate(one, origin)));
    let all: Vec<Scene> = moved.collect();
    let round = |scene: &Scene, decimals| map_numbers(scene, |_, value| round_to(value, decimals));
    (0..=2).flat_map(|decimals| all.iter().map(move |one| round(one, decimals))).collect()
}

/// Returns the places that may become the origin.
fn origins(scene: &Scene) -> Vec<[f64; 2]> {
    let bodies = scene.particles.iter().map(|particle| particle.position);
    let places = bodies.chain(scene.half_planes.iter().map(|plane| plane.point)).take(4);
    places.map(|place| [place.x, place.y]).collect()
}

fn translate(scene: &Scene, origin: [f64; 2]) -> Scene {
    let mut component = 0;
    map_numbers(scene, |quantity, value| {
        if quantity != SceneNumber::Place {
            return value;
        }
        component = 1 - component;
        value - origin[1 - component]
    })
}

/// Returns the scene turned by right angles, and mirrored.
pub(crate) fn turned_scenes(scene: &Scene) -> Vec<Scene> {
    let turn = |[[xx, xy], [yx, yy]]: [[f64; 2]; 2]| {
        let (mut turned, mut before) = (scene.clone(), scene.clone());
        let mut vectors: Vec<f64> = Vec::new();
        let is_vector = |quantity: SceneNumber| {
            matches!(quantity, SceneNumber::Place | SceneNumber::Velocity | SceneNumber::Direction)
        };
        let old = numbers(&mut before).into_iter().filter(|(quantity, _)| is_vector(*quantity));
        let old: Vec<f64> = old.map(|(_, value)| *value).collect();
        for vector in old.chunks(2) {
            vectors.extend([xx * vector[0] + xy * vector[1] + 0.0, yx * vector[0] + yy * vector[1] + 0.0]);
        }
        let new = numbers(&mut turned).into_iter().filter(|(quantity, _)| is_vector(*quantity));
        new.zip(vectors).for_each(|((_, value), vector)| *value = vector);
        turned
    };
    let (x, y) = ([1.0, 0.0], [0.0, 1.0]);
    let (left, down) = ([-1.0, 0.0], [0.0, -1.0]);
    [[y, left], [down, x], [left, down], [left, y], [x, down], [y, x], [down, left]].map(turn).into()
}

/// Returns the scene with other units of length and of time; masses stay.
fn scale(scene: &Scene, length: f64, time: f64) -> Scene {
    let mut scene = scene.clone();
    let steps = scene.steps();
    let pace = 1.0 / (time * time);
    scene.time_step *= time;
    match &mut scene.collision {
        Collision::Penalty { stiffness, thickness, .. } | Collision::Hybrid { stiffness, thickness, .. } => {
            (*stiffness, *thickness) = (*stiffness * pace, *thickness * length);
        }
        _ => {}
    }
    for particle in &mut scene.particles {
        particle.position *= length;
        particle.velocity *= length / time;
        particle.radius *= length;
    }
    scene.edges.iter_mut().for_each(|edge| edge.radius *= length);
    scene.half_planes.iter_mut().for_each(|plane| plane.point *= length);
    for force in &mut scene.forces {
        match force {
            Force::Spring { stiffness, rest_length, damping, .. } => {
                (*stiffness, *rest_length) = (*stiffness * pace, *rest_length * length);
                *damping /= time;
            }
            Force::SimpleGravity { acceleration: vector } | Force::Constant { force: vector } => {
                *vector *= length * pace;
            }
            Force::Gravitation { constant, .. } => *constant *= length * length * length * pace,
            Force::Drag { coefficient } => *coefficient /= time,
            Force::Vortex { strength, .. } => *strength *= length * length / time,
        }
    }
    set_steps(&mut scene, steps);
    scene
}

/// Returns the scene with rounder numbers for its `index`-th, the roundest first; none after the last one.
pub(crate) fn rounder(scene: &Scene, index: usize) -> Option<Vec<Scene>> {
    let mut copy = scene.clone();
    let (quantity, value) = numbers(&mut copy).into_iter().nth(index).map(|(quantity, value)| (quantity, *value))?;
    let whole = [value.trunc(), value.trunc() + value.signum()];
    let plain = [quantity.plain(), 0.0, 1.0, 2.0, 0.5, 3.0, 4.0, -value, -1.0, -2.0];
    let round = (0..=4).map(|decimals| round_to(value, decimals));
    let with = |new: f64| {
        let (mut scene, steps) = (scene.clone(), scene.steps());
        *numbers(&mut scene).swap_remove(index).1 = new;
        set_steps(&mut scene, steps);
        scene
    };
    Some(plain.into_iter().chain(whole).chain(round).map(with).collect())
}
