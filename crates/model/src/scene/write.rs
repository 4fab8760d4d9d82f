//! Scenes as XML that both readers understand alike.
use std::fmt::{self, Write as _};

use super::forces::{self, Sink};
use super::model::{Collision, CollisionDetection, Color, Force, Integrator, Scene};

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
    writeln!(out, "  {}", integrator_element(scene))?;
    if scene.collision != Collision::None {
        writeln!(out, "  {}", collision_element(scene.collision))?;
    }
    if let Collision::Penalty { detection: CollisionDetection::Contest, .. } = scene.collision {
        writeln!(out, r#"  <collisiondetection type="contest"/>"#)?;
    }
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
    scene.forces.iter().try_for_each(|force| writeln!(out, "  {force}"))?;
    colors(out, scene)
}

/// The element of a scene's integrator and time step.
#[must_use]
pub fn integrator_element(scene: &Scene) -> String {
    let name = match scene.integrator {
        Integrator::ExplicitEuler => "explicit-euler",
        Integrator::ForwardBackwardEuler => "forward-backward-euler",
        Integrator::SymplecticEuler => "symplectic-euler",
        Integrator::ImplicitEuler => "implicit-euler",
        Integrator::LinearizedImplicitEuler => "linearized-implicit-euler",
    };
    format!(r#"<integrator type="{name}" dt="{}"/>"#, Number(scene.time_step))
}

/// The element of a scene's collision handling; empty where there is none.
#[must_use]
pub fn collision_element(collision: Collision) -> String {
    let name = collision.kind().name();
    match collision {
        Collision::None => String::new(),
        Collision::Simple { restitution } | Collision::ContinuousTime { restitution } => {
            format!(r#"<collision type="{name}" COR="{}"/>"#, Number(restitution))
        }
        Collision::Penalty { stiffness, thickness, .. } => {
            format!(r#"<collision type="{name}" k="{}" thickness="{}"/>"#, Number(stiffness), Number(thickness))
        }
        Collision::Hybrid { restitution, max_iterations, stiffness, thickness } => {
            let (cor, k, thickness) = (Number(restitution), Number(stiffness), Number(thickness));
            format!(
                r#"<collision type="{name}" COR="{cor}" maxiters="{max_iterations}" k="{k}" thickness="{thickness}"/>"#
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
        writeln!(out, "  <backgroundcolor {}/>", ColorText(background))?;
    }
    if let Some(tag) = &display.tag {
        writeln!(out, r#"  <scenetag tag="{}"/>"#, Text(tag))?;
    }
    Ok(())
}

/// The element as a file has it.
impl fmt::Display for Force {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut attributes = Attributes(String::new());
        let element = forces::tell(self, &mut attributes);
        write!(f, "<{element}{}/>", attributes.0)
    }
}

/// Attributes as they are written, each behind a space.
struct Attributes(String);

impl Sink for Attributes {
    fn edge(&mut self, name: &str, index: usize) {
        self.particle(name, index);
    }

    fn particle(&mut self, name: &str, index: usize) {
        self.0 += &format!(r#" {name}="{index}""#);
    }

    fn number(&mut self, name: &str, value: f64) {
        self.0 += &format!(r#" {name}="{}""#, Number(value));
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
            writeln!(out, r#"  <{name} i="{index}" {}/>"#, ColorText(*color))?;
        }
    }
    for path in &display.paths {
        let (duration, color) = (Number(path.duration), ColorText(path.color));
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
struct ColorText(Color);

impl fmt::Display for ColorText {
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
