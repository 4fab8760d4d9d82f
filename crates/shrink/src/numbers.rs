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

/// Returns the scene moved so that something is at the origin, each with all numbers rounded to 0, 1 or 2 decimals.
pub(crate) fn moved(scene: &Scene) -> Vec<Scene> {
    let all: Vec<Scene> = origins(scene).into_iter().map(|origin| translate(scene, origin)).collect();
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
pub(crate) fn turned(scene: &Scene) -> Vec<Scene> {
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
