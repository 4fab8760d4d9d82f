//! Scenes as XML that both readers understand alike.
use std::fmt::{self, Write as _};

use super::model::{Collision, Color, Force, Integrator, Scene};

/// Writes a scene as XML, one element a line, every attribute spelt out, every number in the shortest form that reads
/// back to the same bits.
///
/// Reading gives an equal scene, provided that its forces stand in the order in which they act and that it is valid:
/// a NaN or an infinity has no form in XML, and a NUL in a text is written as U+FFFD.
#[must_use]
pub fn write(scene: &Scene) -> String {
    let mut out = String::from("<scene>\n");
    // Writing to a string cannot fail.
    let _ = body(&mut out, scene);
    out.push_str("</scene>\n");
    out
}

fn body(out: &mut String, scene: &Scene) -> fmt::Result {
    if let Some(text) = &scene.description {
        writeln!(out, r#"  <description text="{}"/>"#, Text(text))?;
    }
    writeln!(out, r#"  <duration time="{}"/>"#, Number(scene.duration))?;
    let (name, step) = (integrator(scene.integrator), Number(scene.time_step));
    writeln!(out, r#"  <integrator type="{name}" dt="{step}"/>"#)?;
    collision(out, scene.collision)?;
    display(out, scene)?;
    for particle in &scene.particles {
        let [px, py, vx, vy] = [particle.position.x, particle.position.y, particle.velocity.x, particle.velocity.y];
        let (px, py, vx, vy) = (Number(px), Number(py), Number(vx), Number(vy));
        let (mass, radius, fixed) = (Number(particle.mass), Number(particle.radius), u8::from(particle.fixed));
        write!(
            out,
            r#"  <particle px="{px}" py="{py}" vx="{vx}" vy="{vy}" m="{mass}" fixed="{fixed}" radius="{radius}""#
        )?;
        if let Some(tag) = &particle.tag {
            write!(out, r#" tag="{}""#, Text(tag))?;
        }
        out.push_str("/>\n");
    }
    for edge in &scene.edges {
        writeln!(out, r#"  <edge i="{}" j="{}" radius="{}"/>"#, edge.first, edge.second, Number(edge.radius))?;
    }
    for plane in &scene.half_planes {
        let (px, py) = (Number(plane.point.x), Number(plane.point.y));
        let (nx, ny) = (Number(plane.normal.x), Number(plane.normal.y));
        writeln!(out, r#"  <halfplane px="{px}" py="{py}" nx="{nx}" ny="{ny}"/>"#)?;
    }
    scene.forces.iter().try_for_each(|one| force(out, one))?;
    colors(out, scene)
}

fn integrator(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::ExplicitEuler => "explicit-euler",
        Integrator::ForwardBackwardEuler => "forward-backward-euler",
        Integrator::SymplecticEuler => "symplectic-euler",
        Integrator::ImplicitEuler => "implicit-euler",
        Integrator::LinearizedImplicitEuler => "linearized-implicit-euler",
    }
}

fn collision(out: &mut String, collision: Collision) -> fmt::Result {
    match collision {
        Collision::None => Ok(()),
        Collision::Simple { restitution } => {
            writeln!(out, r#"  <collision type="simple" COR="{}"/>"#, Number(restitution))
        }
        Collision::ContinuousTime { restitution } => {
            writeln!(out, r#"  <collision type="continuous-time" COR="{}"/>"#, Number(restitution))
        }
        Collision::Penalty { stiffness, thickness } => {
            let (k, thickness) = (Number(stiffness), Number(thickness));
            writeln!(out, r#"  <collision type="penalty" k="{k}" thickness="{thickness}"/>"#)
        }
        Collision::Hybrid { restitution, max_iterations, stiffness, thickness } => {
            let (cor, k, thickness) = (Number(restitution), Number(stiffness), Number(thickness));
            writeln!(
                out,
                r#"  <collision type="hybrid" COR="{cor}" maxiters="{max_iterations}" k="{k}" thickness="{thickness}"/>"#
            )
        }
    }
}

fn display(out: &mut String, scene: &Scene) -> fmt::Result {
    let display = &scene.display;
    if let Some(max) = display.max_frequency {
        writeln!(out, r#"  <maxsimfreq max="{}"/>"#, Number(max))?;
    }
    if let Some(viewport) = display.viewport {
        let (cx, cy, size) = (Number(viewport.center.x), Number(viewport.center.y), Number(viewport.size));
        writeln!(out, r#"  <viewport cx="{cx}" cy="{cy}" size="{size}"/>"#)?;
    }
    if let Some(background) = display.background {
        writeln!(out, "  <backgroundcolor {}/>", Paint(background))?;
    }
    if let Some(tag) = &display.tag {
        writeln!(out, r#"  <scenetag tag="{}"/>"#, Text(tag))?;
    }
    Ok(())
}

fn force(out: &mut String, force: &Force) -> fmt::Result {
    match *force {
        Force::Spring { edge, stiffness, rest_length, damping } => {
            let (k, l0, b) = (Number(stiffness), Number(rest_length), Number(damping));
            writeln!(out, r#"  <springforce edge="{edge}" k="{k}" l0="{l0}" b="{b}"/>"#)
        }
        Force::SimpleGravity { acceleration } => {
            writeln!(out, r#"  <simplegravity fx="{}" fy="{}"/>"#, Number(acceleration.x), Number(acceleration.y))
        }
        Force::Gravitation { first, second, constant } => {
            writeln!(out, r#"  <gravitationalforce i="{first}" j="{second}" G="{}"/>"#, Number(constant))
        }
        Force::Constant { force } => {
            writeln!(out, r#"  <constantforce fx="{}" fy="{}"/>"#, Number(force.x), Number(force.y))
        }
        Force::Drag { coefficient } => writeln!(out, r#"  <dragdamping b="{}"/>"#, Number(coefficient)),
        Force::Vortex { first, second, strength, coupling } => {
            let (kbs, kvc) = (Number(strength), Number(coupling));
            writeln!(out, r#"  <vortexforce i="{first}" j="{second}" kbs="{kbs}" kvc="{kvc}"/>"#)
        }
    }
}

fn colors(out: &mut String, scene: &Scene) -> fmt::Result {
    let display = &scene.display;
    for (name, colors) in [
        ("particlecolor", &display.particle_colors),
        ("edgecolor", &display.edge_colors),
        ("halfplanecolor", &display.half_plane_colors),
    ] {
        for (index, color) in colors {
            writeln!(out, r#"  <{name} i="{index}" {}/>"#, Paint(*color))?;
        }
    }
    for path in &display.paths {
        let (duration, color) = (Number(path.duration), Paint(path.color));
        writeln!(out, r#"  <particlepath i="{}" duration="{duration}" {color}/>"#, path.particle)?;
    }
    Ok(())
}

/// A number in its shortest form, with an exponent where that is shorter.
struct Number(f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let written = format!("{:?}", self.0);
        f.write_str(written.strip_suffix(".0").unwrap_or(&written))
    }
}

/// A colour's three attributes.
struct Paint(Color);

impl fmt::Display for Paint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Color { red, green, blue } = self.0;
        write!(f, r#"r="{}" g="{}" b="{}""#, Number(red), Number(green), Number(blue))
    }
}

/// A text between double quotation marks. White space other than the space is written as references, since line
/// feeds vanish in the original and other programs change the rest.
struct Text<'s>(&'s str);

impl fmt::Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for c in self.0.chars() {
            match c {
                '&' => f.write_str("&amp;")?,
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                '"' => f.write_str("&quot;")?,
                '\0' => f.write_char(char::REPLACEMENT_CHARACTER)?,
                '\n' | '\r' | '\t' => write!(f, "&#{};", u32::from(c))?,
                _ => f.write_char(c)?,
            }
        }
        Ok(())
    }
}
