//! Writes scenes as XML with the same meaning for both readers.
use super::{
    element::Element,
    forces,
    model::{Collision, CollisionDetection, Force, Particle, Scene},
};
use std::fmt;

/// Returns a scene as XML, one element per line, with every attribute, and every number in the shortest form that reads
/// back to the same bits.
///
/// Reading gives an equal scene if the scene is valid and its forces are in the order in which they act. A NaN or an
/// infinity has no form in XML, and a NUL in a text is written as U+FFFD.
pub fn to_xml(scene: &Scene) -> String {
    let display = &scene.display;
    let mut all = Vec::new();
    all.extend(scene.description.as_deref().map(|text| Element::new("description").text("text", text)));
    all.push(Element::new("duration").number("time", scene.duration));
    all.push(build_integrator(scene));
    all.extend(build_collision(scene.collision));
    if let Collision::Penalty { detection: CollisionDetection::Contest, .. } = scene.collision {
        all.push(Element::new("collisiondetection").with_attribute("type", "contest"));
    }
    all.extend(display.max_frequency.map(|max| Element::new("maxsimfreq").number("max", max)));
    let viewport =
        display.viewport.map(|view| Element::new("viewport").vector("cx", "cy", view.center).number("size", view.size));
    all.extend(viewport);
    all.extend(display.background.map(|color| Element::new("backgroundcolor").color(color)));
    all.extend(display.tag.as_deref().map(|tag| Element::new("scenetag").text("tag", tag)));
    all.extend(scene.particles.iter().map(particle_element));
    for edge in &scene.edges {
        let ends = Element::new("edge").particle("i", edge.first).particle("j", edge.second);
        all.push(ends.number("radius", edge.radius));
    }
    for plane in &scene.half_planes {
        all.push(Element::new("halfplane").vector("px", "py", plane.point).vector("nx", "ny", plane.normal));
    }
    all.extend(scene.forces.iter().map(forces::element));
    for (name, colors) in [
        ("particlecolor", &display.particle_colors),
        ("edgecolor", &display.edge_colors),
        ("halfplanecolor", &display.half_plane_colors),
    ] {
        all.extend(colors.iter().map(|(index, color)| Element::new(name).with_attribute("i", index).color(*color)));
    }
    for path in &display.paths {
        let trail = Element::new("particlepath").particle("i", path.particle).number("duration", path.duration);
        all.push(trail.color(path.color));
    }
    let lines: String = all.iter().map(|element| format!("  {element}\n")).collect();
    format!("<scene>\n{lines}</scene>\n")
}

fn particle_element(particle: &Particle) -> Element {
    let motion = Element::new("particle").vector("px", "py", particle.position).vector("vx", "vy", particle.velocity);
    let fixed = motion.number("m", particle.mass).with_attribute("fixed", u8::from(particle.fixed));
    let element = fixed.number("radius", particle.radius);
    match &particle.tag {
        Some(tag) => element.text("tag", tag),
        None => element,
    }
}

fn build_integrator(scene: &Scene) -> Element {
    Element::new("integrator").with_attribute("type", scene.integrator.name()).number("dt", scene.time_step)
}

/// Returns the element of a collision handling, or `None` if there is none.
fn build_collision(collision: Collision) -> Option<Element> {
    let element = Element::new("collision").with_attribute("type", collision.kind().name());
    Some(match collision {
        Collision::None => return None,
        Collision::Simple { restitution } | Collision::ContinuousTime { restitution } => {
            element.number("COR", restitution)
        }
        Collision::Penalty { stiffness, thickness, .. } => {
            element.number("k", stiffness).number("thickness", thickness)
        }
        Collision::Hybrid { restitution, max_iterations, stiffness, thickness } => {
            let impulses = element.number("COR", restitution).with_attribute("maxiters", max_iterations);
            impulses.number("k", stiffness).number("thickness", thickness)
        }
    })
}

/// Returns the element of a scene's integrator and time step.
pub fn integrator_element(scene: &Scene) -> String {
    build_integrator(scene).to_string()
}

/// Returns the element of a scene's collision handling, or an empty text if there is none.
pub fn collision_element(handling: Collision) -> String {
    build_collision(handling).map_or_else(String::new, |element| element.to_string())
}

/// The element as written in a file.
impl fmt::Display for Force {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        forces::element(self).fmt(f)
    }
}
