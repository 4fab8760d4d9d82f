//! The first step of a scene by hand, without its collisions: what each force adds, and what the integrator makes of it.
use crate::{
    number::exact,
    style::Style,
    table::{Align, Table},
};
use fosssim_model::{
    scene::{Force, Integrator, Scene},
    sim::{RootSearch, Simulation, State, Steer, Steering, gradients},
};
use fosssim_num::vector::{Vec2, at};

/// Matrices with more rows are not printed.
const MOST_ROWS: usize = 8;

/// Renders the forces at the beginning of a scene, and its first step with an explicit or linearized implicit
/// integrator; nothing where there are no forces, the integrator is another one, or the step has no result.
#[must_use]
pub fn first_step(scene: &Scene, name: &str) -> Option<String> {
    let (State { positions: x, velocities: v }, h) = (State::for_scene(scene), scene.time_step);
    let predicted: Vec<f64> = x.iter().zip(&v).map(|(x, v)| x + h * v).collect();
    let (words, place, at_which) = match scene.integrator {
        Integrator::ExplicitEuler => ("x becomes x + h v, v becomes v + h a", &x, "x"),
        Integrator::SymplecticEuler | Integrator::ForwardBackwardEuler => {
            ("v becomes v + h a, then x becomes x + h v", &x, "x")
        }
        Integrator::LinearizedImplicitEuler => {
            ("A d = b, v becomes v + d, then x becomes x + h v", &predicted, "x + h v")
        }
        Integrator::ImplicitEuler => return None,
    };
    let all = gradients(scene, place, &v);
    let mut sum = vec![0.0; x.len()];
    all.iter().for_each(|one| sum.iter_mut().zip(one).for_each(|(sum, part)| *sum += part));
    if all.is_empty() {
        return None;
    }
    let (mut steering, mut simulation) =
        (Steering(FirstSystem::default()), Simulation::new(scene, RootSearch::WhereNeeded));
    simulation.step(&mut steering).ok()?;
    let FirstSystem(matrix) = steering.0;

    let mut forces = Table::new([Align::Left, Align::Left, Align::Left]);
    forces.heading(["", "particle", "gradient"]);
    let names = scene.forces.iter().map(force_name).chain(["penalty".to_owned()]);
    let together = (all.len() > 1).then(|| ("together".to_owned(), &sum));
    for (name, gradient) in names.zip(&all).chain(together) {
        for particle in (0..scene.particles.len()).filter(|particle| at(gradient, *particle) != Vec2::zeros()) {
            forces.row([name.clone().into(), particle.to_string().into(), vector(at(gradient, particle)).into()]);
        }
    }
    let mut text = format!("Forces at {at_which}, scene {name}\n{}", forces.render(Style::Plain));
    text += &format!("\nStep 1, h = {}: {words}\n", exact(h));
    let mut results = Table::new([Align::Left; 4]);
    let is_implicit = scene.integrator.is_implicit();
    results.heading(["particle", if is_implicit { "b = -h gradient" } else { "a = -gradient / m" }, "v", "x"]);
    for (particle, body) in scene.particles.iter().enumerate() {
        let factor = if is_implicit { -h } else { -1.0 / body.mass };
        let own = if body.fixed { Vec2::zeros() } else { factor * at(&sum, particle) };
        let end = simulation.state();
        let [v, x] = [&end.velocities, &end.positions].map(|values| vector(at(values, particle)));
        results.row([particle.to_string().into(), vector(own).into(), v.into(), x.into()]);
    }
    if is_implicit && x.len() <= MOST_ROWS {
        text += "  A = M + h Hv + h^2 Hx\n";
        for row in 0..x.len() {
            let entries: Vec<String> = (0..x.len()).map(|column| short(matrix[column * x.len() + row])).collect();
            text += &format!("    {}\n", entries.join("  "));
        }
    }
    Some(text + &results.render(Style::Plain))
}

/// The system matrix of a step's first solve, column by column.
#[derive(Default)]
struct FirstSystem(Vec<f64>);

impl Steer for FirstSystem {
    fn system(&mut self, matrix: &mut [f64]) {
        self.0 = matrix.to_vec();
    }
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

fn short(value: f64) -> String {
    // Without the sign of a zero, which nobody computes by hand.
    exact(value + 0.0)
}

fn vector(value: Vec2) -> String {
    format!("({}, {})", short(value.x), short(value.y))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(integrator: &str, force: &str) -> Option<String> {
        let xml = format!(
            r#"<scene> <duration time="1"/> <integrator type="{integrator}" dt="0.5"/> <collision type="none"/>
            <particle m="2" px="0" py="0" vx="1" vy="0" fixed="0"/> <particle m="1" px="4" py="0" vx="0" vy="0" fixed="1"/>
            <edge i="0" j="1" radius="1"/> {force} </scene>"#
        );
        first_step(&fosssim_model::scene::read("pair", xml.as_bytes()).expect("a scene").scene, "small.xml")
    }

    #[test]
    fn an_explicit_step_has_its_forces_accelerations_and_result() {
        let spring = r#"<springforce edge="0" k="2" l0="3"/> <dragdamping b="2"/>"#;
        let expected = "\
Forces at x, scene small.xml
                          particle   gradient
  springforce on edge 0   0          (-2, 0)
  springforce on edge 0   1          (2, 0)
  dragdamping             0          (2, 0)
  together                1          (2, 0)

Step 1, h = 0.5: x becomes x + h v, v becomes v + h a
  particle   a = -gradient / m   v        x
  0          (0, 0)              (1, 0)   (0.5, 0)
  1          (0, 0)              (0, 0)   (4, 0)
";
        assert_eq!(text("explicit-euler", spring).as_deref(), Some(expected));
    }

    #[test]
    fn a_linearized_step_has_its_system() {
        let found = text("linearized-implicit-euler", r#"<dragdamping b="2"/>"#).expect("a step");
        for part in ["Forces at x + h v", "    3  0  0  0\n", "b = -h gradient", "0          (-1, 0)"] {
            assert!(found.contains(part), "{part}: {found}");
        }
        assert_eq!(text("implicit-euler", r#"<dragdamping b="2"/>"#), None);
        assert_eq!(text("explicit-euler", ""), None);
    }
}
