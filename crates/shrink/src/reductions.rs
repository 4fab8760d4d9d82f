//! Makes the attempts to reduce a scene: fewer parts, plainer features, rounder numbers.
use crate::size::{NumberKind, list_numbers, set_steps};
use fosssim_model::{
    assignments::Assignment,
    scene::{Collision, Force, Integrator, Scene},
};
use std::ops::Range;

/// A kind of reduction: a function that returns the scenes of attempt `index`, the best first, or `None` after the last
/// attempt.
pub(crate) type Reduction = fn(&Scene, Assignment, usize) -> Option<Vec<Scene>>;

/// All kinds of reductions, in the order in which they are tried.
pub(crate) const REDUCTIONS: [Reduction; 4] = [remove_parts, simplify, move_and_round, round_number];

/// Returns attempt `index` at removing parts (bodies, edges, half-planes and forces). The first attempt removes all
/// parts except the first body. Later ones remove half of the parts, then a quarter, and finally single parts.
fn remove_parts(scene: &Scene, _: Assignment, index: usize) -> Option<Vec<Scene>> {
    let count = scene.particles.len() + scene.edges.len() + scene.half_planes.len() + scene.forces.len();
    let lengths = std::iter::successors(Some(count / 2), |length| Some(length / 2)).take_while(|length| *length > 0);
    // Parts are removed from the end, so that the rest keeps its numbers as long as possible.
    let ranges = lengths.flat_map(|length| (0..count).step_by(length).rev().map(move |start| start..start + length));
    std::iter::once(1..count).chain(ranges).skip(index).map(|range| vec![without_parts(scene, &range)]).next()
}

/// Returns the scene without these parts and without everything that depends on them. An edge depends on its ends, and
/// a force on its bodies or its edge.
fn without_parts(scene: &Scene, parts: &Range<usize>) -> Scene {
    let (mut scene, mut part) = (scene.clone(), 0..);
    let mut is_kept = || part.next().is_some_and(|part| !parts.contains(&part));
    let set = |new: &[Option<usize>], index: &mut usize| new[*index].inspect(|new| *index = *new).is_some();
    let bodies = retain(&mut scene.particles, |_| is_kept());
    let edges =
        retain(&mut scene.edges, |edge| is_kept() && set(&bodies, &mut edge.first) && set(&bodies, &mut edge.second));
    scene.half_planes.retain(|_| is_kept());
    scene.forces.retain_mut(|force| {
        is_kept()
            && match force {
                Force::Spring { edge, .. } => set(&edges, edge),
                Force::Gravitation { first, second, .. } | Force::Vortex { first, second, .. } => {
                    set(&bodies, first) && set(&bodies, second)
                }
                Force::SimpleGravity { .. } | Force::Constant { .. } | Force::Drag { .. } => true,
            }
    });
    scene
}

/// Keeps the parts for which `stays` is true. Returns the new index of each part, or `None` for a removed one.
fn retain<Part>(parts: &mut Vec<Part>, mut stays: impl FnMut(&mut Part) -> bool) -> Vec<Option<usize>> {
    let (mut numbers, mut next) = (Vec::new(), 0..);
    parts.retain_mut(|part| {
        numbers.push(stays(part).then(|| next.next()).flatten());
        numbers.last().is_some_and(Option::is_some)
    });
    numbers
}

/// Returns scenes in which one feature is simplified, the collision handling first. There is only one attempt. The
/// integrators are those of the assignment's library.
fn simplify(scene: &Scene, assignment: Assignment, index: usize) -> Option<Vec<Scene>> {
    let with = |collision: Collision| Scene { collision, ..scene.clone() };
    let mut all = Vec::new();
    if let Collision::Hybrid { restitution, .. } = scene.collision {
        all.push(with(Collision::ContinuousTime { restitution }));
    }
    all.push(with(Collision::None));
    let plain = [Integrator::ExplicitEuler, Integrator::SymplecticEuler, Integrator::LinearizedImplicitEuler];
    let allowed =
        plain.into_iter().filter(|integrator| assignment.definition().library.integrators.contains(integrator));
    all.extend(allowed.map(|integrator| Scene { integrator, ..scene.clone() }));
    for body in 0..scene.particles.len() {
        all.push(scene.clone());
        all.last_mut()?.particles[body].fixed = false;
    }
    (index == 0).then_some(all)
}

/// Returns scenes in which a body or a half-plane is at the origin and all numbers are rounded. There is only one
/// attempt.
fn move_and_round(scene: &Scene, _: Assignment, index: usize) -> Option<Vec<Scene>> {
    let bodies = scene.particles.iter().map(|particle| particle.position);
    let positions = bodies.chain(scene.half_planes.iter().map(|plane| plane.point)).take(4);
    let mut all = Vec::new();
    for decimals in 0..=2 {
        for origin in positions.clone() {
            let mut components = [origin.x, origin.y].into_iter().cycle();
            all.push(map_numbers(scene, |kind, value| {
                let is_position = kind == NumberKind::Place;
                let origin = if is_position { components.next().unwrap_or_default() } else { 0.0 };
                round(value - origin, decimals)
            }));
        }
    }
    (index == 0).then_some(all)
}

/// Returns the scene with each number replaced.
fn map_numbers(scene: &Scene, mut replace: impl FnMut(NumberKind, f64) -> f64) -> Scene {
    let (mut scene, steps) = (scene.clone(), scene.step_count());
    list_numbers(&mut scene).into_iter().for_each(|(kind, value)| *value = replace(kind, *value));
    set_steps(&mut scene, steps);
    scene
}

/// Returns the number with this number of decimals, without the sign of a zero.
fn round(value: f64, decimals: usize) -> f64 {
    format!("{value:.decimals$}").parse().unwrap_or(value) + 0.0
}

/// Returns scenes in which number `index` of the scene is rounder, the roundest first.
fn round_number(scene: &Scene, _: Assignment, index: usize) -> Option<Vec<Scene>> {
    let mut copy = scene.clone();
    let (kind, value) = list_numbers(&mut copy).into_iter().nth(index).map(|(kind, value)| (kind, *value))?;
    let plain = [kind.simplest_value(), 0.0, 1.0, 2.0, 0.5, 3.0, 4.0, -value, -1.0, -2.0];
    // Masses, radii and other factors keep their sign: a negative one is no simplification.
    let is_odd = |new: &f64| kind == NumberKind::Factor && *new < 0.0 && value >= 0.0;
    let new = plain.into_iter().filter(|new| !is_odd(new)).chain((0..=4).map(|decimals| round(value, decimals)));
    let with = |new: f64| {
        let mut number = 0..;
        map_numbers(scene, |_, value| if number.next() == Some(index) { new } else { value })
    };
    Some(new.map(with).collect())
}
