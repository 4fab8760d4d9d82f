//! Shows the first step of a scene as a calculation by hand: the forces, the integrator, the detection of collisions,
//! and the responses.
mod collisions;
#[cfg(test)]
mod tests;

use crate::{
    number::format_short,
    style::Style,
    table::{Align, Table},
};
use collisions::CollisionWalk;
use fosssim_findings::PairText;
use fosssim_model::{
    scene::{Collision, CollisionDetection, Force, Integrator, Scene},
    sim::{
        Pair, PairKind, Pass, PenaltyTerms, RootSearch, Simulation, State, SteeringObserver, StepController, gradients,
    },
};
use fosssim_num::{
    linear,
    vector::{Vec2, length, vector_at},
};
use std::collections::BTreeSet;

/// The maximum number of rows of a printed matrix. Larger matrices are left out.
const MAX_ROWS: usize = 8;

/// Renders a scene's first step as text: the forces and the integrator if there are forces, then the detection passes
/// and the responses. `step` is the number of this step in the run from which the scene was taken. The detection of
/// `pair` is shown completely. Returns `None` if the step has no result.
pub fn first_step(scene: &Scene, pair: Option<(Pair, Option<Pass>)>, step: u32) -> Option<String> {
    let mut walk = CollisionWalk::new(scene, pair);
    Simulation::new(scene, RootSearch::OnDemand).step(&mut walk).ok()?;
    let parts: Vec<String> = [render_integration(scene, step), walk.finish()].into_iter().flatten().collect();
    let before = (step > 1).then(|| format!("Before step {step}\n{}\n", render_states(&State::for_scene(scene))));
    Some(before.unwrap_or_default() + &parts.join("\n"))
}

/// Renders the velocity and the position of each particle as a table.
fn render_states(state: &State) -> String {
    let rows = (0..state.positions.len() / 2).map(|particle| {
        let [v, x] = [&state.velocities, &state.positions].map(|values| format_vector(vector_at(values, particle)));
        [particle.to_string(), v, x]
    });
    render_table(["particle", "v", "x"], rows)
}

/// Renders the forces at the beginning of a scene, and the integrator's step. Returns `None` if all forces are zero and
/// the scene has a collision handling other than penalty forces.
fn render_integration(scene: &Scene, step: u32) -> Option<String> {
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
    let is_implicit = scene.integrator.is_implicit();
    let position_formula = if is_implicit { "x + h v" } else { "x" };
    let force_positions: Vec<f64> = x.iter().zip(&v).map(|(x, v)| if is_implicit { x + h * v } else { *x }).collect();
    let all = gradients(scene, &force_positions, &v);
    let has_any = |values: &[f64]| values.iter().any(|value| *value != 0.0);
    if has_handling && !all.iter().any(|gradient| has_any(gradient)) {
        return None;
    }
    let sum: Vec<f64> = (0..x.len()).map(|entry| all.iter().map(|gradient| gradient[entry]).sum()).collect();
    let mut systems = SteeringObserver(FirstSystem(None));
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    simulation.step(&mut systems).ok()?;
    let (end, particles) = (simulation.state(), 0..scene.particles.len());
    let names = scene.forces.iter().map(|force| force.kind().element()).chain(["penalty"]);
    let mut parts: Vec<(&str, &Vec<f64>)> = names.zip(&all).collect();
    // A force that the scene defines is shown even if it is zero. A penalty force of zero is not shown.
    parts.retain(|(name, gradient)| *name != "penalty" || has_any(gradient));
    if parts.len() > 1 {
        parts.push(("together", &sum));
    }
    let rows = parts.iter().flat_map(|(name, gradient)| {
        let row =
            |particle: usize| [(*name).to_owned(), particle.to_string(), format_vector(vector_at(gradient, particle))];
        particles.clone().map(row)
    });
    let mut text = format!("Forces at {position_formula}\n");
    text += &if parts.is_empty() { "  none\n".to_owned() } else { render_table(["", "particle", "gradient"], rows) };
    let formulas: BTreeSet<&str> = scene.forces.iter().map(force_formula).collect();
    text.extend(formulas.iter().map(|formula| format!("  {formula}\n")));
    text.extend(render_penalty(scene, &force_positions));
    let rule = match scene.integrator {
        Integrator::ExplicitEuler => "x becomes x + h v, v becomes v + h a",
        Integrator::SymplecticEuler | Integrator::ForwardBackwardEuler => "v becomes v + h a, then x becomes x + h v",
        Integrator::LinearizedImplicitEuler => "v becomes v + d, then x becomes x + h v",
        Integrator::ImplicitEuler => {
            "v becomes v + d, then x becomes x + h v. Newton's method adds up corrections d until they are small; \
                each solves A d = b, with b = -M d - h gradient and A at x + h (v + d) and v + d. This is the first one"
        }
    };
    text += &format!("\nStep {step}, h = {}: {rule}\n", format_short(h));
    text.extend(systems.0.0.map(|matrix| render_system(scene, matrix, &sum)));
    let rows = particles.map(|particle| {
        let [v, x] = [&end.velocities, &end.positions].map(|values| format_vector(vector_at(values, particle)));
        let body = &scene.particles[particle];
        let a = if body.fixed { Vec2::zeros() } else { (-1.0 / body.mass) * vector_at(&sum, particle) };
        [particle.to_string(), v, x, if is_implicit { String::new() } else { format_vector(a) }]
    });
    let a = if is_implicit { "" } else { "with a = -gradient / m" };
    Some(text + &render_table(["particle", "v", "x", a], rows))
}

/// Renders the first linear system that an implicit integrator solves, and its solution. A matrix with more than
/// [`MAX_ROWS`] rows is left out.
fn render_system(scene: &Scene, mut matrix: Vec<f64>, gradient: &[f64]) -> String {
    let (size, mut text) = (gradient.len(), "  A d = b with A = M + h Hv + h^2 Hx and b = -h gradient\n".to_owned());
    if size <= MAX_ROWS {
        let width = matrix.iter().map(|entry| format_short(*entry).len()).max().unwrap_or_default();
        for row in 0..size {
            let entries =
                matrix.iter().skip(row).step_by(size).map(|entry| format!("  {:>width$}", format_short(*entry)));
            text += &format!("  {}\n", entries.collect::<String>());
        }
    }
    let is_fixed = |entry: usize| scene.particles[entry / 2].fixed;
    let b = gradient.iter().enumerate().map(|(entry, g)| if is_fixed(entry) { 0.0 } else { -scene.time_step * g });
    let b: Vec<f64> = b.collect();
    let mut d = b.clone();
    linear::solve(&mut matrix, &mut d, &mut linear::Workspace::default());
    let rows = (0..size / 2)
        .map(|index| [index.to_string(), format_vector(vector_at(&b, index)), format_vector(vector_at(&d, index))]);
    text + &render_table(["particle", "b", "d"], rows)
}

/// The matrix, column by column, of the first linear system that the integrator solves in a step.
struct FirstSystem(Option<Vec<f64>>);

impl StepController for FirstSystem {
    fn observe_system(&mut self, matrix: &mut [f64]) {
        self.0.get_or_insert_with(|| matrix.to_vec());
    }
}

/// Renders the penalty forces of all pairs that are close enough. Returns `None` if there is no such pair, or if the
/// scene has no penalty forces.
fn render_penalty(scene: &Scene, x: &[f64]) -> Option<String> {
    let Collision::Penalty { stiffness, thickness, .. } = scene.collision else { return None };
    let mut rows = Vec::new();
    PenaltyTerms::for_scene(scene)?.visit_pairs(x, |pair, terms| {
        let (first, second) = (pair.first as usize, pair.second as usize);
        let other = match pair.kind {
            PairKind::ParticleParticle => scene.particles[second].radius,
            PairKind::ParticleEdge => scene.edges[second].radius,
            PairKind::ParticleHalfPlane => 0.0,
        };
        let (reach, force) = (scene.particles[first].radius + other + thickness, length(terms[0].1));
        let [distance, reach, force] = [reach - force / stiffness, reach, -force].map(format_short);
        let added = terms.iter().map(|(particle, force)| format!("{particle}: {}", format_vector(-1.0 * force)));
        rows.push([PairText(pair).to_string(), distance, reach, force, added.collect::<Vec<_>>().join(", ")]);
    });
    let rule = "n is from the first particle to the other object; -k (|n| - r) n / |n| is added for the first, and the \
                opposite for the other; an edge's ends share it by 1 - alpha and alpha";
    let heading = ["penalty", "|n|", "r = radii and thickness", "k (|n| - r)", "added"];
    (!rows.is_empty()).then(|| format!("{}  {rule}\n", render_table(heading, rows)))
}

/// Returns the formula of a force's contribution to the gradient of the potential.
const fn force_formula(force: &Force) -> &'static str {
    match force {
        Force::Spring { .. } => {
            "springforce: -(k (l - l0) + b n.(v_j - v_i)) n for i and the opposite for j, with n = (x_j - x_i) / l"
        }
        Force::SimpleGravity { .. } => "simplegravity: -m (fx, fy)",
        Force::Gravitation { .. } => {
            "gravitationalforce: -G m_i m_j / r^2 n for i and the opposite for j, with n = (x_j - x_i) / r"
        }
        Force::Constant { .. } => "constantforce: -(fx, fy)",
        Force::Drag { .. } => "dragdamping: b v",
        Force::Vortex { .. } => {
            "vortexforce: kvc / r^2 (kbs (-n_y, n_x) - v_j + v_i) for i, the opposite for j, with n = (x_j - x_i) / r"
        }
    }
}

/// Renders rows as a table below a heading.
fn render_table<const COLUMNS: usize>(
    heading: [&str; COLUMNS],
    rows: impl IntoIterator<Item = [String; COLUMNS]>,
) -> String {
    let mut table = Table::new([Align::Left; COLUMNS]);
    table.add_heading(heading);
    rows.into_iter().for_each(|row| table.add_row(row.map(Into::into)));
    table.render(Style::Plain)
}

fn format_vector(value: Vec2) -> String {
    format!("({}, {})", format_short(value.x), format_short(value.y))
}
