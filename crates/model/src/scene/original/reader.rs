//! Converts elements to a scene, in the original's order of evaluation (scene-format.md 3).
use super::item::Item;
use super::markup::{self, Element};
use super::single::SingleElements;
use super::{OriginalScene, Rejection};
use crate::scene::model::{Color, Display, Edge, Force, HalfPlane, Particle, ParticlePath, Scene};
use crate::{assignments::ForceKind, scene::forces::AttributeSource};

/// Reads a scene like the original.
///
/// # Errors
///
/// Fails with the original's message if the original rejects the scene or crashes, and with this program's message if
/// the original would read out of bounds. If a scene has problems of both kinds, the original's message is returned,
/// wherever its cause is in the file.
pub fn read(bytes: &[u8]) -> Result<OriginalScene, Rejection> {
    let text = markup::join_lines(bytes);
    let elements = markup::parse(&text).map_err(Rejection::from_crash)?.ok_or_else(|| {
        Rejection::from_message(b"Failed to parse xml scene file. Failed to locate root <scene> node. Exiting.", 1)
    })?;
    let singles = SingleElements(&elements);
    let duration = singles.read_duration()?;
    let max_frequency = singles.read_max_frequency()?;
    let viewport = singles.read_viewport()?;
    let background = singles.read_background()?;
    let description = singles.read_description()?;
    let tag = singles.read_tag()?;
    check_type(singles.read_simulation_type())?;

    let mut repeated = RepeatedElements { elements: &elements, undefined: None };
    let particles = repeated.read_particles()?;
    let edges = repeated.read_edges(particles.len())?;
    let half_planes = repeated.read_half_planes()?;
    let forces = repeated.read_forces(particles.len(), edges.len())?;
    let (integrator, time_step) = singles.read_integrator()?;
    let collision = singles.read_collision()?;
    let display = Display {
        max_frequency,
        viewport,
        background,
        tag: tag.map(decode_lossily),
        particle_colors: repeated.read_colors("particlecolor", "particle", particles.len())?,
        edge_colors: repeated.read_colors("edgecolor", "edge", edges.len())?,
        half_plane_colors: repeated.read_colors("halfplanecolor", "half-plane", half_planes.len())?,
        paths: repeated.read_paths(particles.len())?,
    };
    if let Some(explanation) = repeated.undefined {
        return Err(Rejection::from_undefined_input(explanation));
    }
    let scene = Scene {
        duration,
        time_step,
        integrator,
        collision,
        particles,
        edges,
        half_planes,
        forces,
        description: description.map(decode_lossily),
        display,
    };
    Ok(OriginalScene { scene, description: description.unwrap_or(b"No description specified.").to_vec() })
}

fn decode_lossily(text: &[u8]) -> String {
    String::from_utf8_lossy(text).into_owned()
}

fn check_type(written: &[u8]) -> Result<(), Rejection> {
    match written {
        b"" | b"particle-system" => Ok(()),
        b"rigid-body" => Err(Rejection::from_undefined_input(
            "simtype 'rigid-body' is an unfinished stub of the original: it makes no step and gives no verdict".into(),
        )),
        _ => {
            let mut text = b"Invalid simtype '".to_vec();
            text.extend_from_slice(written);
            text.extend_from_slice(b"' specified. Valid options are 'particle-system' and 'rigid-body'. Exiting.");
            Err(Rejection::from_message(&text, 1))
        }
    }
}

/// The elements that may be repeated, and a message about the first index with which the original would read out of
/// bounds.
struct RepeatedElements<'e> {
    elements: &'e [Element<'e>],
    undefined: Option<String>,
}

impl<'e> RepeatedElements<'e> {
    fn items(&self, name: &'static str) -> impl Iterator<Item = Item<'e>> + use<'e> {
        Item::items_named(self.elements, name, name)
    }

    /// Returns `index` if it is below `count`. Otherwise returns 0, and the scene is rejected later.
    fn check_index(&mut self, item: &Item<'_>, what: &str, index: i32, count: usize) -> usize {
        match usize::try_from(index) {
            Ok(index) if index < count => index,
            _ => {
                self.undefined.get_or_insert_with(|| {
                    format!(
                        "{} names {what} {index}, but the scene has {count}; the original would read memory that is \
                         not its own",
                        item.describe()
                    )
                });
                0
            }
        }
    }

    fn read_particles(&self) -> Result<Vec<Particle>, Rejection> {
        let read = |item: Item<'_>| {
            Ok(Particle {
                position: item.read_numerics("px", "py")?,
                velocity: item.read_numerics("vx", "vy")?,
                mass: item.read_numeric("m")?,
                fixed: item.read_boolean("fixed")?,
                radius: item.read_radius(0.1)?,
                tag: item.text("tag").map(decode_lossily),
            })
        };
        self.items("particle").map(read).collect()
    }

    fn read_edges(&mut self, particles: usize) -> Result<Vec<Edge>, Rejection> {
        let mut edges = Vec::new();
        for item in self.items("edge") {
            let (i, j, radius) = (item.read_integer("i")?, item.read_integer("j")?, item.read_radius(0.015)?);
            let first = self.check_index(&item, "particle", i, particles);
            let second = self.check_index(&item, "particle", j, particles);
            edges.push(Edge { first, second, radius });
        }
        Ok(edges)
    }

    fn read_half_planes(&self) -> Result<Vec<HalfPlane>, Rejection> {
        let read = |item: Item<'_>| {
            Ok(HalfPlane { point: item.read_reals("px", "py")?, normal: item.read_reals("nx", "ny")? })
        };
        self.items("halfplane").map(read).collect()
    }

    /// Returns all forces, in the order in which they act.
    fn read_forces(&mut self, particles: usize, edges: usize) -> Result<Vec<Force>, Rejection> {
        let mut forces = Vec::new();
        for kind in ForceKind::ALL {
            // The original's messages call simple gravity a constant force as well.
            let called = if kind == ForceKind::SimpleGravity { ForceKind::Constant } else { kind };
            for item in Item::items_named(self.elements, kind.element(), called.element()) {
                forces.push(kind.read(&mut ForceItem {
                    item,
                    scene: self,
                    particle_count: particles,
                    edge_count: edges,
                })?);
            }
        }
        Ok(forces)
    }

    /// Returns the colors of one kind of object. The original's check accepts an edge or half-plane whose index equals
    /// the count.
    fn read_colors(&mut self, name: &'static str, what: &str, count: usize) -> Result<Vec<(usize, Color)>, Rejection> {
        let slack = usize::from(what != "particle");
        let mut colors = Vec::new();
        for item in self.items(name) {
            let index = item.read_integer("i")?;
            if usize::try_from(index).ok().is_none_or(|index| index >= count + slack) {
                // A count of zero wraps around in the original.
                let last = (count as u64).wrapping_sub(1);
                let end = format!("Invalid {what} specified. Valid range is 0...{last}");
                return Err(item.rejection("value of ", "i", &end));
            }
            let color = item.read_color()?;
            colors.push((self.check_index(&item, what, index, count), color));
        }
        Ok(colors)
    }

    /// Returns the trails. A trail of a particle that does not exist has no effect in the original and is left out.
    fn read_paths(&self, particles: usize) -> Result<Vec<ParticlePath>, Rejection> {
        let mut paths = Vec::new();
        for item in self.items("particlepath") {
            let index = item.read_integer("i")?;
            let duration =
                item.text("duration").and_then(super::values::parse_scalar).filter(|&duration| duration >= 0.0);
            let duration =
                duration.ok_or_else(|| item.rejection("value of ", "duration", "Value must be positive scalar."))?;
            let color = item.read_color()?;
            if let Some(particle) = usize::try_from(index).ok().filter(|&index| index < particles) {
                paths.push(ParticlePath { particle, duration, color });
            }
        }
        Ok(paths)
    }
}

/// The attributes of a force.
struct ForceItem<'e, 's> {
    item: Item<'e>,
    scene: &'s mut RepeatedElements<'e>,
    particle_count: usize,
    edge_count: usize,
}

impl AttributeSource for ForceItem<'_, '_> {
    type Error = Rejection;

    fn edge(&mut self, name: &'static str) -> Result<usize, Rejection> {
        let index = self.item.read_integer(name)?;
        Ok(self.scene.check_index(&self.item, "edge", index, self.edge_count))
    }

    fn particle(&mut self, name: &'static str) -> Result<usize, Rejection> {
        let index = self.item.read_integer(name)?;
        Ok(self.scene.check_index(&self.item, "particle", index, self.particle_count))
    }

    fn number(&mut self, name: &'static str, default: Option<f64>, _: Option<&str>) -> Result<f64, Rejection> {
        default.map_or_else(
            || self.item.read_numeric(name),
            |default| self.item.read_optional(name, default, "value of ", "numeric"),
        )
    }
}
