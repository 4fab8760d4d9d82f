//! A readable summary of a trace, for snapshot tests and for readers.
//!
//! The text depends only on the scene and the bytes, so the same trace gives the same text everywhere. Numbers are
//! printed with the fewest digits that read back to the same bits. Passes, pair kinds and zones, which a trace does not
//! contain, are counted by [`EventCounts`](super::EventCounts) while a simulation runs.
use super::{
    digest::Digests,
    error::TraceError,
    frame::{Frame, LoggedImpulse},
    layout::Layout,
};
use crate::{scene::Scene, sim::pairs};
use std::{fmt, io::Read};

/// The maximum number of collisions that are listed.
const MAX_COLLISIONS: usize = 40;

/// The contents of a trace. Its `Display` is the text that a snapshot test keeps.
///
/// ```
/// use fosssim_model::{
///     scene::original,
///     sim::{RootSearch, Simulation},
///     trace::{Layout, Recorder, Summary},
/// };
///
/// let xml = br#"<scene><duration time="0.5"/><integrator type="explicit-euler" dt="0.5"/>
///     <collision type="continuous-time" COR="1"/>
///     <particle m="1" px="0" py="0.5" vx="0" vy="-1" fixed="0" radius="0.25"/>
///     <halfplane px="0" py="0" nx="0" ny="1"/></scene>"#;
/// let scene = original::read(xml).expect("a scene").scene;
/// let mut simulation = Simulation::new(&scene, RootSearch::default());
/// let mut recorder = Recorder::start(Vec::new(), Layout::for_scene(&scene), simulation.state());
/// for _ in 0..scene.step_count() {
///     simulation.step(&mut recorder)?;
/// }
/// let (trace, _) = recorder.finish()?;
///
/// // A course's own test would hand this to `insta::assert_snapshot!`.
/// let summary = Summary::for_scene(&scene, &trace[..]);
/// assert_eq!(
///     summary.to_string(),
///     "\
/// scene          continuous-time, 1 step, 1 particle, 0 edges, 1 half-plane
/// trace          288 bytes, 3 of 3 records
/// impulses       1
/// polynomials    2 (2 per detection pass)
/// collisions
///   step 1: particle 0 - half-plane 0, normal (-0.0, -0.25), time 0.5
/// sha256         d4d3b73d3f7f86db948d525ab9b5f011469a0834e363b78b8798acb45d4fc691
/// "
/// );
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Summary {
    /// The collision type's name in scenes.
    pub collision: &'static str,
    /// The layout of the scene's traces.
    pub layout: Layout,
    /// The number of edges of the scene.
    pub edges: usize,
    /// The number of half-planes of the scene.
    pub half_planes: usize,
    /// The number of polynomials of one detection pass over all pairs (trace-format.md 2).
    pub polynomials_per_pass: u64,
    /// The trace's bytes, records, damage and digests.
    pub trace: Digests,
    /// The number of oddities that do not stop the reading, and the first oddity.
    pub notes: (u64, Option<TraceError>),
    /// The number of impulses of all end records.
    pub impulses: u64,
    /// The number of polynomials of all end records.
    pub polynomials: u64,
    /// The first collisions, each with its step.
    pub collisions: Vec<(u32, LoggedImpulse)>,
}

impl Summary {
    /// Summarizes a trace of `scene`, with the memory of one record and eight bytes per step. A malformed trace has a
    /// summary as well, which names the place where reading stopped.
    pub fn for_scene(scene: &Scene, mut trace: impl Read) -> Self {
        let layout = Layout::for_scene(scene);
        let mut summary = Self {
            collision: scene.collision.kind().name(),
            layout,
            edges: scene.edges.len(),
            half_planes: scene.half_planes.len(),
            polynomials_per_pass: if layout.has_polynomials { pairs(scene).polynomial_count() as u64 } else { 0 },
            ..Self::default()
        };
        let mut visit = |record, frame: &Frame, notes: &[TraceError]| summary.add_record(record, frame, notes);
        summary.trace = Digests::walk(&mut trace, layout, &mut visit);
        summary
    }

    /// Adds a record.
    fn add_record(&mut self, record: u64, frame: &Frame, notes: &[TraceError]) {
        self.notes.0 += notes.len() as u64;
        if self.notes.1.is_none() {
            self.notes.1 = notes.first().cloned();
        }
        if record == 0 || self.layout.is_mid_record(record) {
            return;
        }
        let step = self.layout.step_of_record(record);
        self.impulses += frame.impulses.len() as u64;
        self.polynomials += frame.polynomials.len() as u64;
        let room = MAX_COLLISIONS - self.collisions.len();
        self.collisions.extend(frame.impulses.iter().take(room).map(|impulse| (step, *impulse)));
    }
}

/// Returns a count with its unit, such as `1 particle` or `2 particles`.
fn format_count(count: impl Into<u64>, thing: &str) -> String {
    let count = count.into();
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let steps = format_count(self.layout.steps, "step");
        let particles = format_count(self.layout.particles as u64, "particle");
        let (edges, planes) =
            (format_count(self.edges as u64, "edge"), format_count(self.half_planes as u64, "half-plane"));
        writeln!(f, "scene          {}, {steps}, {particles}, {edges}, {planes}", self.collision)?;
        let Digests { bytes, records, trailing_bytes: trailing, has_more_bytes, stop_error, sha256, .. } = &self.trace;
        let bytes = format_count(*bytes, "byte");
        let more = if *has_more_bytes { "more than " } else { "" };
        writeln!(f, "trace          {more}{bytes}, {records} of {}", format_count(self.layout.records(), "record"))?;
        if let Some(error) = stop_error {
            writeln!(f, "damage         {error}")?;
        }
        if *trailing > 0 {
            writeln!(f, "trailing       {more}{}", format_count(*trailing, "byte"))?;
        }
        if let (count, Some(first)) = &self.notes {
            writeln!(f, "unusual        {}, the first: {first}", format_count(*count, "value"))?;
        }
        if self.layout.has_impulses {
            writeln!(f, "impulses       {}", self.impulses)?;
        }
        if self.layout.has_polynomials {
            writeln!(f, "polynomials    {} ({} per detection pass)", self.polynomials, self.polynomials_per_pass)?;
        }
        self.write_collisions(f)?;
        if *has_more_bytes {
            return writeln!(f, "sha256         unknown, because not all bytes were read");
        }
        writeln!(f, "sha256         {sha256}")
    }
}

impl Summary {
    fn write_collisions(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.collisions.is_empty() {
            return Ok(());
        }
        writeln!(f, "collisions")?;
        for (step, impulse) in &self.collisions {
            writeln!(f, "  step {step}: {impulse}")?;
        }
        match self.impulses - self.collisions.len() as u64 {
            0 => Ok(()),
            more => writeln!(f, "  and {more} more"),
        }
    }
}
