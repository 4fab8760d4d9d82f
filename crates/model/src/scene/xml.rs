//! Converts elements to a scene: the attributes of each element, and their allowed values (scene-format.md 4, 5).
//!
//! Errors that involve several elements are found in `checks`.
use super::document::Document;
use super::fields::{ObjectCount, TagFields};
use super::forces::AttributeSource;
use super::model::{
    Collision, CollisionDetection, Display, Edge, Force, HalfPlane, Particle, ParticlePath, Scene, Viewport,
};
use super::problem::{Problem, Report};
use super::tag::Tag;
use crate::assignments::{CollisionType, ForceKind, Integrator};
use fosssim_num::vector::Vec2;

/// The elements that objects were read from, so that later checks can point to them.
pub(super) struct SceneParts<'d, 't> {
    pub(super) particles: Vec<ParsedElement<'d, 't, Particle>>,
    pub(super) edges: Vec<ParsedElement<'d, 't, Edge>>,
    pub(super) half_planes: Vec<ParsedElement<'d, 't, HalfPlane>>,
    pub(super) forces: Vec<ParsedElement<'d, 't, Force>>,
    pub(super) integrator: Option<ParsedElement<'d, 't, (Integrator, f64)>>,
    pub(super) duration: Option<ParsedElement<'d, 't, f64>>,
    pub(super) collision: Option<Collision>,
    pub(super) description: Option<Option<String>>,
    pub(super) display: Option<Display>,
}

/// A tag and its parsed value. The value is `None` if the tag is invalid.
pub(super) struct ParsedElement<'d, 't, T> {
    pub(super) tag: &'d Tag<'t>,
    pub(super) value: Option<T>,
}

/// Returns all values, or `None` if one is missing.
fn values<T>(parts: Vec<ParsedElement<'_, '_, T>>) -> Option<Vec<T>> {
    parts.into_iter().map(|part| part.value).collect()
}

impl SceneParts<'_, '_> {
    /// Returns the start position of a particle, if it could be read.
    pub(super) fn start_position(&self, particle: usize) -> Option<Vec2> {
        Some(self.particles.get(particle)?.value.as_ref()?.position)
    }

    /// Returns the scene, or `None` if a part is missing.
    pub(super) fn into_scene(self) -> Option<Scene> {
        let (integrator, time_step) = self.integrator?.value?;
        Some(Scene {
            duration: self.duration?.value?,
            time_step,
            integrator,
            collision: self.collision?,
            particles: values(self.particles)?,
            edges: values(self.edges)?,
            half_planes: values(self.half_planes)?,
            forces: values(self.forces)?,
            description: self.description?,
            display: self.display?,
        })
    }
}

/// Reads all elements. Returns `None` if the scene consists of rigid bodies, which are not simulated.
pub(super) fn read<'d, 't>(document: &'d Document<'t>, report: &mut Report) -> Option<SceneParts<'d, 't>> {
    let mut reading = SceneBuilder { document, report };
    if reading.has_rigid_bodies() {
        return None;
    }
    let particles = reading.read_repeated("particle", read_particle);
    let particle_count = reading.count("particle", "particle", particles.len());
    let edges = reading.read_repeated("edge", |fields| read_edge(fields, particle_count));
    let edge_count = reading.count("edge", "edge", edges.len());
    let half_planes = reading.read_repeated("halfplane", |fields| {
        let (point, normal) = (fields.vector("px", "py"), fields.vector("nx", "ny"));
        Some(HalfPlane { point: point?, normal: normal? })
    });
    let half_plane_count = reading.count("halfplane", "half-plane", half_planes.len());
    Some(SceneParts {
        forces: reading.read_forces(particle_count, edge_count),
        integrator: reading.require("integrator", "type=\"...\" dt=\"...\"", read_integrator),
        duration: reading.require("duration", "time=\"...\"", read_duration),
        collision: reading.read_collision_handling(),
        description: reading.read_optional("description", |fields| fields.text("text", "a text")),
        display: reading.read_display(particle_count, edge_count, half_plane_count),
        particles,
        edges,
        half_planes,
    })
}

struct SceneBuilder<'d, 't, 'r> {
    document: &'d Document<'t>,
    report: &'r mut Report,
}

impl<'d, 't> SceneBuilder<'d, 't, '_> {
    fn tags(&self, name: &str) -> impl Iterator<Item = &'d Tag<'t>> + use<'d, 't> {
        let name = name.to_owned();
        self.document.tags.iter().filter(move |tag| tag.rule.name == name)
    }

    /// Reads the elements of a kind that may be repeated.
    fn read_repeated<T>(
        &mut self,
        name: &str,
        mut read: impl FnMut(&mut TagFields<'d, 't, '_>) -> Option<T>,
    ) -> Vec<ParsedElement<'d, 't, T>> {
        let tags = self.tags(name).enumerate();
        let read =
            |(number, tag)| ParsedElement { tag, value: read(&mut TagFields::new(tag, Some(number), self.report)) };
        tags.map(read).collect()
    }

    /// Reads the first element of a kind, and reports further ones. Returns `None` if there is no element.
    fn read_first<T>(
        &mut self,
        name: &str,
        read: impl FnOnce(&mut TagFields<'d, 't, '_>) -> Option<T>,
    ) -> Option<ParsedElement<'d, 't, T>> {
        let mut tags = self.tags(name);
        let tag = tags.next()?;
        for other in tags {
            self.report.add_error(|| {
                Problem::from_element(name, &other.span, format!("a second `{name}`"))
                    .with_help("the original takes the first and ignores the others; remove one")
            });
        }
        Some(ParsedElement { tag, value: read(&mut TagFields::new(tag, None, self.report)) })
    }

    /// Returns the value of a single optional element. The outer `None` means that the element could not be read.
    fn read_optional<T>(
        &mut self,
        name: &str,
        read: impl FnOnce(&mut TagFields<'d, 't, '_>) -> Option<T>,
    ) -> Option<Option<T>> {
        self.read_first(name, read).map_or(Some(None), |part| part.value.map(Some))
    }

    /// Reads a single required element, and reports its absence.
    fn require<T>(
        &mut self,
        name: &str,
        attributes: &str,
        read: impl FnOnce(&mut TagFields<'d, 't, '_>) -> Option<T>,
    ) -> Option<ParsedElement<'d, 't, T>> {
        let part = self.read_first(name, read);
        if let (None, Some(scene)) = (&part, &self.document.scene)
            && !self.document.is_broken
            && !self.document.intended_names.contains(name)
        {
            self.report.add_error(|| {
                Problem::from_element(name, scene, format!("the scene has no `{name}`"))
                    .with_help(format!("add `<{name} {attributes}/>`"))
            });
        }
        part
    }

    fn count(&self, name: &str, what: &'static str, count: usize) -> ObjectCount {
        ObjectCount {
            noun: what,
            count,
            is_certain: !self.document.is_broken && !self.document.intended_names.contains(name),
        }
    }

    /// Returns whether the scene's type is that of the unfinished rigid-body stub. Also reports wrong types, and rigid
    /// bodies in other scenes.
    fn has_rigid_bodies(&mut self) -> bool {
        let types = [("particle-system", false), ("rigid-body", true)];
        let stub = "rigid bodies are an unfinished stub of the original and are not simulated";
        let single = self.read_first("simtype", |fields| {
            // A missing or empty type means a particle system.
            let rigid = !fields.is_blank("type") && fields.choice("type", &types)?;
            if rigid {
                fields.report_bad_value("type", format!("{stub}; use `particle-system`"));
            }
            Some(rigid)
        });
        let rigid = single.and_then(|part| part.value).unwrap_or(false);
        if self.document.has_rigid_bodies && !rigid {
            let scene = self.document.scene.clone().unwrap_or(0..0);
            self.report.add_error(|| {
                Problem::new(scene, "the scene has rigid bodies").with_help(format!("{stub}; use particles and edges"))
            });
        }
        rigid
    }

    /// Returns all forces in the order in which they act.
    fn read_forces(&mut self, particles: ObjectCount, edges: ObjectCount) -> Vec<ParsedElement<'d, 't, Force>> {
        let mut forces = Vec::new();
        for kind in ForceKind::ALL {
            forces.extend(self.read_repeated(kind.element(), |fields| {
                kind.read(&mut ForceFields { fields, particles, edges, first: None }).ok()
            }));
        }
        forces
    }

    /// Returns the collision handling, with the detection that its penalty force uses.
    fn read_collision_handling(&mut self) -> Option<Collision> {
        let read = self.read_first("collision", read_collision).map_or(Some(Collision::None), |part| part.value);
        let Some(part) = self.read_first("collisiondetection", read_detection) else { return read };
        match read? {
            Collision::Penalty { stiffness, thickness, .. } => {
                Some(Collision::Penalty { stiffness, thickness, detection: part.value? })
            }
            other => {
                self.report.add_warning(|| {
                    Problem::from_element("collisiondetection", &part.tag.span, "`collisiondetection` has no effect")
                        .with_help(
                            "it says how a `penalty` scene finds its pairs; other collision handling tests all pairs",
                        )
                });
                Some(other)
            }
        }
    }

    fn read_display(
        &mut self,
        particles: ObjectCount,
        edges: ObjectCount,
        half_planes: ObjectCount,
    ) -> Option<Display> {
        let max_frequency = self.read_optional("maxsimfreq", |fields| fields.scalar("max"));
        let viewport = self.read_optional("viewport", |fields| {
            let (center, size) = (fields.vector("cx", "cy"), fields.scalar("size"));
            Some(Viewport { center: center?, size: size? })
        });
        let background = self.read_optional("backgroundcolor", |fields| fields.color());
        let tag = self.read_optional("scenetag", |fields| fields.text("tag", "a text"));
        let mut colors = |name: &str, of: ObjectCount| {
            values(self.read_repeated(name, |fields| {
                let (index, color) = (fields.index("i", of), fields.color());
                Some((index?, color?))
            }))
        };
        let particle_colors = colors("particlecolor", particles);
        let edge_colors = colors("edgecolor", edges);
        let half_plane_colors = colors("halfplanecolor", half_planes);
        let paths = values(self.read_repeated("particlepath", |fields| read_path(fields, particles)));
        Some(Display {
            max_frequency: max_frequency?,
            viewport: viewport?,
            background: background?,
            tag: tag?,
            particle_colors: particle_colors?,
            edge_colors: edge_colors?,
            half_plane_colors: half_plane_colors?,
            paths: paths?,
        })
    }
}

fn read_duration(fields: &mut TagFields<'_, '_, '_>) -> Option<f64> {
    let duration = fields.scalar("time")?;
    if duration < 0.0 {
        fields.report_bad_value("time", "the simulated time cannot be negative");
    }
    Some(duration)
}

fn read_integrator(fields: &mut TagFields<'_, '_, '_>) -> Option<(Integrator, f64)> {
    let (integrator, time_step) = (
        fields.choice("type", &Integrator::ALL.map(|integrator| (integrator.name(), integrator))),
        fields.scalar("dt"),
    );
    if time_step.is_some_and(|time_step| time_step <= 0.0) {
        fields.report_bad_value("dt", "the time step must be positive; the original makes no step");
    }
    Some((integrator?, time_step?))
}

fn read_detection(fields: &mut TagFields<'_, '_, '_>) -> Option<CollisionDetection> {
    fields.choice("type", &[("all-pairs", CollisionDetection::AllPairs), ("contest", CollisionDetection::Contest)])
}

fn read_collision(fields: &mut TagFields<'_, '_, '_>) -> Option<Collision> {
    let types = CollisionType::ALL.map(|kind| (kind.name(), kind));
    let restitution = fields.scalar_or("COR", 1.0);
    if restitution.is_some_and(|value| !(0.0..=1.0).contains(&value)) {
        fields.warn_bad_value("COR", "a coefficient of restitution must be between 0 and 1");
    }
    let kind = fields.choice("type", &types)?;
    let used: &[&str] = match kind {
        CollisionType::None | CollisionType::Simple | CollisionType::ContinuousTime => &[],
        CollisionType::Penalty => &["k", "thickness"],
        CollisionType::Hybrid => &["maxiters", "k", "thickness"],
    };
    for name in ["maxiters", "k", "thickness"] {
        if fields.has_attribute(name) && !used.contains(&name) {
            fields.warn(name, "has no effect", "this type of collision handling does not use it");
        }
    }
    let (default_stiffness, default_thickness) =
        if kind == CollisionType::Hybrid { (10.0, 0.1) } else { (100.0, 0.01) };
    let mut force = || {
        let (stiffness, thickness) =
            (fields.scalar_or("k", default_stiffness), fields.scalar_or("thickness", default_thickness));
        let (stiffness, thickness) = (stiffness?, thickness?);
        warn_negative(fields, "k", stiffness, "a negative stiffness makes bodies attract each other");
        warn_negative(fields, "thickness", thickness, "a negative thickness delays the penalty force");
        Some((stiffness, thickness))
    };
    match kind {
        CollisionType::None => restitution.map(|_| Collision::None),
        CollisionType::Simple => Some(Collision::Simple { restitution: restitution? }),
        CollisionType::ContinuousTime => Some(Collision::ContinuousTime { restitution: restitution? }),
        CollisionType::Penalty => {
            let (stiffness, thickness) = force()?;
            restitution.map(|_| Collision::Penalty { stiffness, thickness, detection: CollisionDetection::AllPairs })
        }
        CollisionType::Hybrid => {
            let force = force();
            let max_iterations = read_max_iterations(fields);
            let (stiffness, thickness) = force?;
            Some(Collision::Hybrid { restitution: restitution?, max_iterations: max_iterations?, stiffness, thickness })
        }
    }
}

/// Returns `maxiters`, which the original reads as a scalar and truncates.
fn read_max_iterations(fields: &mut TagFields<'_, '_, '_>) -> Option<i32> {
    let written = fields.scalar_or("maxiters", 10.0)?;
    if written.trunc() != written || written < f64::from(i32::MIN) || written > f64::from(i32::MAX) {
        fields.report_bad_value("maxiters", "write a whole number of at most 2147483647");
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "whole and in range")]
    let iterations = written as i32;
    if iterations < 0 {
        fields.warn_bad_value("maxiters", "it acts like 0: no impulse, only the rigid failsafe");
    }
    Some(iterations)
}

fn read_particle(fields: &mut TagFields<'_, '_, '_>) -> Option<Particle> {
    let (position, velocity) = (fields.vector("px", "py"), fields.vector("vx", "vy"));
    let mass = fields.scalar("m");
    if mass.is_some_and(|mass| mass <= 0.0) {
        fields.report_bad_value("m", "a mass must be positive; the original divides by it");
    }
    let fixed = fields.boolean("fixed");
    let radius = read_radius(fields, 0.1);
    let tag = fields.optional_text("tag");
    Some(Particle { position: position?, velocity: velocity?, mass: mass?, fixed: fixed?, radius: radius?, tag: tag? })
}

fn read_radius(fields: &mut TagFields<'_, '_, '_>, default: f64) -> Option<f64> {
    let radius = fields.scalar_or("radius", default)?;
    if radius < 0.0 {
        fields.report_bad_value("radius", "a radius cannot be negative");
    }
    Some(radius)
}

fn read_edge(fields: &mut TagFields<'_, '_, '_>, particles: ObjectCount) -> Option<Edge> {
    let (pair, radius) = (read_pair(fields, particles), read_radius(fields, 0.015));
    let (first, second) = pair?;
    Some(Edge { first, second, radius: radius? })
}

/// Returns the two different particles in `i` and `j`.
fn read_pair(fields: &mut TagFields<'_, '_, '_>, particles: ObjectCount) -> Option<(usize, usize)> {
    let first = fields.index("i", particles);
    let second = read_other_particle(fields, first, particles);
    Some((first?, second?))
}

/// Returns the particle in `j`, which must differ from the one in `i`.
fn read_other_particle(
    fields: &mut TagFields<'_, '_, '_>,
    first: Option<usize>,
    particles: ObjectCount,
) -> Option<usize> {
    let second = fields.index("j", particles)?;
    if first == Some(second) {
        fields.report_error("j", "is the same particle as `i`", "two different particles are needed");
        return None;
    }
    Some(second)
}

/// The attributes of a force.
struct ForceFields<'d, 't, 'r, 'f> {
    fields: &'f mut TagFields<'d, 't, 'r>,
    particles: ObjectCount,
    edges: ObjectCount,
    /// The particle in `i`.
    first: Option<usize>,
}

impl AttributeSource for ForceFields<'_, '_, '_, '_> {
    /// The error has been reported.
    type Error = ();

    fn edge(&mut self, name: &'static str) -> Result<usize, ()> {
        self.fields.index(name, self.edges).ok_or(())
    }

    fn particle(&mut self, name: &'static str) -> Result<usize, ()> {
        if name == "j" {
            return read_other_particle(self.fields, self.first, self.particles).ok_or(());
        }
        self.first = self.fields.index(name, self.particles);
        self.first.ok_or(())
    }

    fn number(&mut self, name: &'static str, default: Option<f64>, negative_effect: Option<&str>) -> Result<f64, ()> {
        let number = match default {
            Some(default) => self.fields.scalar_or(name, default),
            None => self.fields.scalar(name),
        };
        if let (Some(number), Some(effect)) = (number, negative_effect) {
            warn_negative(self.fields, name, number, effect);
        }
        number.ok_or(())
    }
}

fn read_path(fields: &mut TagFields<'_, '_, '_>, particles: ObjectCount) -> Option<ParticlePath> {
    let (particle, duration, color) = (fields.index("i", particles), fields.scalar("duration"), fields.color());
    if duration.is_some_and(|duration| duration < 0.0) {
        fields.report_bad_value("duration", "a duration cannot be negative");
    }
    Some(ParticlePath { particle: particle?, duration: duration?, color: color? })
}

/// Warns about a negative number that the original accepts.
fn warn_negative(fields: &mut TagFields<'_, '_, '_>, name: &str, value: f64, effect: &str) {
    if value < 0.0 {
        fields.warn_bad_value(name, effect);
    }
}
