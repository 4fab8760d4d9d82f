//! The first step of a scene by hand: what each force adds, what the integrator makes of it, and how collisions are
//! found and answered.
mod collisions;
#[cfg(test)]
mod tests;

use crate::{
    number::{exact, fraction, general},
    style::Style,
    table::{Align, Table},
};
use collisions::CollisionWalk;
use fosssim_findings::PairWords;
use fosssim_model::{
    scene::{Collision, CollisionDetection, Force, Integrator, Scene},
    sim::{Pair, PairKind, Pass, PenaltyTerms, RootSearch, Simulation, State, Steer, Steering, gradients, pairs},
};
use fosssim_num::{
    linear,
    vector::{Vec2, at, length},
};

/// Matrices with more rows are not printed, nor more of Newton's iterations.
const MOST_ROWS: usize = 8;
const MOST_ITERATIONS: usize = 3;
/// Smaller numbers are round-off of a zero, where numbers are near 1.
const NOTHING: f64 = 1e-13;

/// Renders a scene's first step: forces and integrator where there are forces, then passes and responses, with all of
/// one pair's detection if one is named. `None` if the step has no result, or nothing to compute.
#[must_use]
pub fn first_step(scene: &Scene, pair: Option<(Pair, Option<Pass>)>) -> Option<String> {
    let mut walk = CollisionWalk::new(scene, pair);
    Simulation::new(scene, RootSearch::WhereNeeded).step(&mut walk).ok()?;
    match (integration(scene), walk.finish()) {
        (Some(forces), Some(collisions)) => Some(format!("{forces}\n{collisions}")),
        (None, None) if pair.is_none() => first_step(scene, Some((pairs(scene).iter().next()?, None))),
        (forces, collisions) => forces.or(collisions),
    }
}

/// Renders the forces at the beginning of a scene, and the integrator's step.
fn integration(scene: &Scene) -> Option<String> {
    let has_handling = !matches!(scene.collision, Collision::None | Collision::Penalty { .. });
    let collision = match scene.collision {
        Collision::Hybrid { stiffness, thickness, .. } => {
            Collision::Penalty { stiffness, thickness, detection: CollisionDetection::AllPairs }
        }
        penalty @ Collision::Penalty { .. } => penalty,
        _ => Collision::None,
    };
    let scene = &Scene { collision, ..scene.clone() };
    let (State { positions: x, velocities: v }, h) = (State::for_scene(scene), scene.time_step);
    let predicted: Vec<f64> = x.iter().zip(&v).map(|(x, v)| x + h * v).collect();
    let is_implicit = scene.integrator.is_implicit();
    let (place, at_which) = if is_implicit { (&predicted, "x + h v") } else { (&x, "x") };
    let all = gradients(scene, place, &v);
    let has_forces = all.iter().flatten().any(|value| *value != 0.0);
    if !has_forces && has_handling {
        return None;
    }
    let (mut systems, mut simulation) =
        (Steering(StepSystems::default()), Simulation::new(scene, RootSearch::WhereNeeded));
    simulation.step(&mut systems).ok()?;
    let (end, sum, particles) = (simulation.state(), sum(&all), 0..scene.particles.len());
    let names = scene.forces.iter().map(force_name).chain(["penalty".to_owned()]);
    let together = (all.len() > 1).then(|| ("together".to_owned(), &sum));
    let parts = names.zip(&all).chain(together).flat_map(|(name, gradient)| {
        let acting = particles.clone().filter(|particle| at(gradient, *particle) != Vec2::zeros());
        acting.map(move |particle| [name.clone(), particle.to_string(), vector(at(gradient, particle))])
    });
    let mut text = format!("Forces at {at_which}\n");
    text += &if has_forces { table(["", "particle", "gradient"], parts) } else { "  none\n".to_owned() };
    text.extend(penalty(scene, place));
    let words = match scene.integrator {
        Integrator::ExplicitEuler => "x becomes x + h v, v becomes v + h a",
        Integrator::SymplecticEuler | Integrator::ForwardBackwardEuler => "v becomes v + h a, then x becomes x + h v",
        Integrator::LinearizedImplicitEuler => "A d = b, v becomes v + d, then x becomes x + h v",
        Integrator::ImplicitEuler => {
            "Newton's method for d; v becomes v + d, then x becomes x + h v\n  \
             b = -M d - h gradient at x + h (v + d) and v + d, first with d = 0; A delta = b, and d becomes d + delta"
        }
    };
    text += &format!("\nStep 1, h = {}: {words}\n", short(h));
    let rows = particles.map(|particle| {
        let [v, x] = [&end.velocities, &end.positions].map(|values| vector(at(values, particle)));
        let body = &scene.particles[particle];
        let a = if body.fixed { Vec2::zeros() } else { (-1.0 / body.mass) * at(&sum, particle) };
        [particle.to_string(), v, x, if is_implicit { String::new() } else { vector(a) }]
    });
    let a = if is_implicit { "" } else { "with a = -gradient / m" };
    Some(text + &solves(scene, &systems.0.0) + &table(["particle", "v", "x", a], rows))
}

/// Renders the systems that an implicit integrator solves, and their solutions.
fn solves(scene: &Scene, matrices: &[Vec<f64>]) -> String {
    let (State { positions, velocities }, h) = (State::for_scene(scene), scene.time_step);
    let (size, is_newton) = (positions.len(), scene.integrator == Integrator::ImplicitEuler);
    let (mut d, mut text, mut before) = (vec![0.0; size], String::new(), &Vec::new());
    for (matrix, iteration) in matrices.iter().zip(1..=MOST_ITERATIONS) {
        let v: Vec<f64> = velocities.iter().zip(&d).map(|(v, d)| v + d).collect();
        let x: Vec<f64> = positions.iter().zip(&v).map(|(x, v)| x + h * v).collect();
        let mut b = sum(&gradients(scene, &x, &v));
        for (entry, value) in b.iter_mut().enumerate() {
            let body = &scene.particles[entry / 2];
            *value = if body.fixed { 0.0 } else { -body.mass * d[entry] - h * *value };
        }
        let mut delta = b.clone();
        linear::solve(&mut matrix.clone(), &mut delta, &mut linear::Workspace::default());
        d.iter_mut().zip(&delta).for_each(|(d, delta)| *d += delta);
        if size <= MOST_ROWS && matrix != before {
            text += "  A = M + h Hv + h^2 Hx\n";
            let width = matrix.iter().map(|entry| short(*entry).len()).max().unwrap_or_default();
            for row in 0..size {
                let entry = |column: usize| format!("{:>width$}", short(matrix[column * size + row]));
                text += &format!("    {}\n", (0..size).map(entry).collect::<Vec<_>>().join("  "));
            }
        }
        before = matrix;
        let rows = (0..size / 2).map(|particle| {
            let [b, delta, d] = [&b, &delta, &d].map(|values| vector(at(values, particle)));
            [particle.to_string(), b, delta, if is_newton { d } else { String::new() }]
        });
        text += &if is_newton { format!("  iteration {iteration} of {}\n", matrices.len()) } else { String::new() };
        text += &table(
            if is_newton { ["particle", "b", "delta", "d"] } else { ["particle", "b = -h gradient", "d", ""] },
            rows,
        );
    }
    text
}

/// The system matrix of each solve of a step, column by column.
#[derive(Default)]
struct StepSystems(Vec<Vec<f64>>);

impl Steer for StepSystems {
    fn system(&mut self, matrix: &mut [f64]) {
        self.0.push(matrix.to_vec());
    }
}

/// Renders the penalty force between each pair, if there is one.
fn penalty(scene: &Scene, x: &[f64]) -> Option<String> {
    let Collision::Penalty { stiffness, thickness, .. } = scene.collision else { return None };
    let mut rows = Vec::new();
    PenaltyTerms::for_scene(scene)?.visit(x, |pair, terms| {
        let (first, second) = (pair.first as usize, pair.second as usize);
        let other = match pair.kind {
            PairKind::ParticleParticle => scene.particles[second].radius,
            PairKind::ParticleEdge => scene.edges[second].radius,
            PairKind::ParticleHalfPlane => 0.0,
        };
        let (reach, force) = (scene.particles[first].radius + other + thickness, length(terms[0].1));
        let [distance, reach, force] = [reach - force / stiffness, reach, -force].map(short);
        rows.push([PairWords(pair).to_string(), distance, reach, force]);
    });
    let rule =
        "the last column times -n / |n| is added to the gradient of the first particle, with n from it to the other";
    let heading = ["penalty", "|n|", "r = radii and thickness", "k (|n| - r)"];
    (!rows.is_empty()).then(|| format!("{}  {rule}\n", table(heading, rows)))
}

/// Adds arrays of equal lengths.
fn sum(all: &[Vec<f64>]) -> Vec<f64> {
    let mut sum = vec![0.0; all.first().map_or(0, Vec::len)];
    all.iter().for_each(|one| sum.iter_mut().zip(one).for_each(|(sum, part)| *sum += part));
    sum
}

/// Returns the element of a force, and what it acts on.
fn force_name(force: &Force) -> String {
    let element = force.kind().element();
    match force {
        Force::Spring { edge, .. } => format!("{element} on edge {edge}"),
        Force::Gravitation { first, second, .. } | Force::Vortex { first, second, .. } => {
            format!("{element} of {first} and {second}")
        }
        Force::SimpleGravity { .. } | Force::Constant { .. } | Force::Drag { .. } => element.to_owned(),
    }
}

/// Renders rows below a heading.
fn table<const COLUMNS: usize>(heading: [&str; COLUMNS], rows: impl IntoIterator<Item = [String; COLUMNS]>) -> String {
    let mut table = Table::new([Align::Left; COLUMNS]);
    table.heading(heading);
    rows.into_iter().for_each(|row| table.row(row.map(Into::into)));
    table.render(Style::Plain)
}

/// Returns a number as it is computed by hand: short decimals or a short fraction, else six digits.
fn short(value: f64) -> String {
    // Without the sign of a zero, which nobody computes by hand.
    let value = if value.abs() < NOTHING { 0.0 } else { value };
    let rounded = (value * 1e6).round() / 1e6;
    if (rounded - value).abs() <= NOTHING * value.abs() {
        return exact(rounded);
    }
    fraction(value).unwrap_or_else(|| general(value))
}

fn vector(value: Vec2) -> String {
    format!("({}, {})", short(value.x), short(value.y))
}
