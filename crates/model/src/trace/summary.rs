//! A readable summary of a trace, for snapshot tests and for the eye.
//!
//! A pure function of scene and bytes: the same trace gives the same text everywhere. Numbers are printed with the
//! fewest digits that read back to the same bits. What a trace does not hold (passes, pair kinds, zones) is counted
//! by [`EventCounts`](super::EventCounts) while a simulation runs.
use super::{
    digest::{Digests, ShortDigest},
    error::TraceError,
    frame::{Frame, LoggedImpulse},
    histogram::Histogram,
    layout::Layout,
};
use crate::{
    scene::Scene,
    sim::{Pair, pairs},
};
use sha2::{Digest, Sha256};
use std::{fmt, io::Read};

/// The greatest number of collisions that are listed.
const COLLISIONS: usize = 40;
/// The greatest number of polynomials of a step that are listed.
const POLYNOMIALS: usize = 24;
/// The greatest number of coefficients of a polynomial that are listed.
const COEFFICIENTS: usize = 8;
/// The greatest number of groups in which steps are digested.
const GROUPS: u32 = 16;

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
/// for _ in 0..scene.steps() {
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
/// impulses       1; per step: 1 in 1 step
/// polynomials    2 (2 per detection pass); per step: 2 in 1 step
/// collisions
///   step 1: particle 0 - half-plane 0, normal (-0.0, -0.25), time 0.5
/// step 1
///   polynomial 0, pass 0, particle 0 - half-plane 0: [-0.25, 0.5, -0.1875]
///   polynomial 1, pass 0, particle 0 - half-plane 0: [-0.25, 0.25]
/// digests
///   step 0       50a85e8d0672d8cb
///   step 1       e622ef56e2388886
/// sha256         d4d3b73d3f7f86db948d525ab9b5f011469a0834e363b78b8798acb45d4fc691
/// "
/// );
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Summary {
    /// The collision type's name in scenes.
    pub collision: &'static str,
    /// The shape that the scene gives its traces.
    pub layout: Layout,
    /// Number of edges of the scene.
    pub edges: usize,
    /// Number of half-planes of the scene.
    pub half_planes: usize,
    /// Polynomials of one detection pass over all pairs (trace-format.md 2).
    pub polynomials_per_pass: u64,
    /// The trace's bytes, records, damage and digests.
    pub trace: Digests,
    /// Number of oddities that do not end the reading, and the first.
    pub notes: (u64, Option<TraceError>),
    /// Impulses per step, of end records.
    pub impulses: Histogram,
    /// Polynomials per step, of end records.
    pub polynomials: Histogram,
    /// The first collisions: step and impulse.
    pub collisions: Vec<(u32, LoggedImpulse)>,
    /// The first step.
    pub first: Option<StepView>,
    /// The step with the most impulses, among these with the most polynomials, among these the first.
    pub busiest: Option<StepView>,
    /// Digests of groups of steps: first and last step, and the digest of the steps' digests.
    pub digests: Vec<(u32, u32, ShortDigest)>,
}

/// The polynomials of one step.
#[derive(Debug, Clone, Default)]
pub struct StepView {
    /// The step, from 1.
    pub step: u32,
    /// Number of impulses.
    pub impulses: usize,
    /// Number of polynomials.
    pub polynomials: usize,
    /// The first polynomials: the pair as text, and the first coefficients.
    pub shown: Vec<(String, Vec<f64>)>,
}

impl Summary {
    /// Summarizes a trace of `scene`, in the memory of one record and eight bytes per step. A malformed trace has a
    /// summary, too: it names the place where reading ended.
    pub fn for_scene(scene: &Scene, mut trace: impl Read) -> Self {
        let layout = Layout::for_scene(scene);
        let mut summary = Self {
            collision: scene.collision.kind().name(),
            layout,
            edges: scene.edges.len(),
            half_planes: scene.half_planes.len(),
            polynomials_per_pass: if layout.polynomials { pairs(scene).polynomials() as u64 } else { 0 },
            ..Self::default()
        };
        let mut hear = |record, frame: &Frame, notes: &[TraceError]| summary.record(scene, record, frame, notes);
        summary.trace = Digests::walk(&mut trace, layout, &mut hear);
        summary.digests = groups(&summary.trace.steps, layout.steps);
        summary
    }

    /// Takes in a record.
    fn record(&mut self, scene: &Scene, record: u64, frame: &Frame, notes: &[TraceError]) {
        self.notes.0 += notes.len() as u64;
        if self.notes.1.is_none() {
            self.notes.1 = notes.first().cloned();
        }
        if record == 0 || self.layout.is_mid(record) {
            return;
        }
        let step = self.layout.step_of(record);
        self.impulses.add(frame.impulses.len() as u64);
        self.polynomials.add(frame.polynomials.len() as u64);
        let room = COLLISIONS - self.collisions.len();
        self.collisions.extend(frame.impulses.iter().take(room).map(|impulse| (step, *impulse)));
        let events = (frame.impulses.len(), frame.polynomials.len());
        if self.busiest.as_ref().is_none_or(|busiest| events > (busiest.impulses, busiest.polynomials)) {
            let view = StepView::for_step(scene, step, frame);
            self.first.get_or_insert_with(|| view.clone());
            self.busiest = Some(view);
        }
    }
}

impl StepView {
    fn for_step(scene: &Scene, step: u32, frame: &Frame) -> Self {
        let (log, pairs) = (&frame.polynomials, pairs(scene));
        let shown = log.iter().take(POLYNOMIALS).enumerate().filter_map(|(index, coefficients)| {
            let (pass, Pair { kind, first, second }, _) = pairs.polynomial(index)?;
            let label = format!("pass {pass}, particle {first} - {} {second}", kind.second());
            Some((label, coefficients.iter().copied().take(COEFFICIENTS).collect()))
        });
        let shown = shown.collect();
        Self { step, impulses: frame.impulses.len(), polynomials: log.len(), shown }
    }
}

/// Returns the digests of steps in groups of equal length, of which a trace of `all` steps has few. The initial record
/// is by itself. A single step keeps its own digest, the one that a listing of all steps shows.
fn groups(steps: &[ShortDigest], all: u32) -> Vec<(u32, u32, ShortDigest)> {
    let (initial, later) = steps.split_at(steps.len().min(1));
    let mut first = 0;
    let group = |steps: &[ShortDigest]| {
        let last = first + steps.len() as u32 - 1;
        let digest = match steps {
            [single] => *single,
            _ => ShortDigest::from_digest(
                steps.iter().fold(Sha256::new(), |all, step| all.chain_update(step.0.to_be_bytes())),
            ),
        };
        (std::mem::replace(&mut first, last + 1), last, digest)
    };
    initial.chunks(1).chain(later.chunks(all.div_ceil(GROUPS).max(1) as usize)).map(group).collect()
}

/// Returns `1 particle`, `2 particles`.
fn number(count: impl Into<u64>, thing: &str) -> String {
    let count = count.into();
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let steps = number(self.layout.steps, "step");
        let particles = number(self.layout.particles as u64, "particle");
        let (edges, planes) = (number(self.edges as u64, "edge"), number(self.half_planes as u64, "half-plane"));
        writeln!(f, "scene          {}, {steps}, {particles}, {edges}, {planes}", self.collision)?;
        let Digests { bytes, records, trailing, unread, stopped, sha256, .. } = &self.trace;
        let bytes = number(*bytes, "byte");
        let more = if *unread { "more than " } else { "" };
        writeln!(f, "trace          {more}{bytes}, {records} of {}", number(self.layout.records(), "record"))?;
        if let Some(error) = stopped {
            writeln!(f, "damage         {error}")?;
        }
        if *trailing > 0 {
            writeln!(f, "trailing       {more}{}", number(*trailing, "byte"))?;
        }
        if let (count, Some(first)) = &self.notes {
            writeln!(f, "odd            {}, the first: {first}", number(*count, "value"))?;
        }
        if self.layout.impulses {
            writeln!(f, "impulses       {}; per step: {}", self.impulses.total(), self.impulses)?;
        }
        if self.layout.polynomials {
            let (total, per_pass) = (self.polynomials.total(), self.polynomials_per_pass);
            writeln!(f, "polynomials    {total} ({per_pass} per detection pass); per step: {}", self.polynomials)?;
        }
        self.write_collisions(f)?;
        for (index, view) in [&self.first, &self.busiest].into_iter().flatten().enumerate() {
            let again = index == 1 && self.first.as_ref().is_some_and(|first| first.step == view.step);
            if !again && !view.shown.is_empty() {
                write!(f, "{view}")?;
            }
        }
        writeln!(f, "digests")?;
        for (first, last, digest) in &self.digests {
            let steps = if first == last { format!("step {first}") } else { format!("steps {first}-{last}") };
            writeln!(f, "  {steps:<12} {digest}")?;
        }
        if *unread {
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
        match self.impulses.total() - self.collisions.len() as u64 {
            0 => Ok(()),
            more => writeln!(f, "  and {more} more"),
        }
    }
}

impl fmt::Display for StepView {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "step {}", self.step)?;
        for (index, (label, coefficients)) in self.shown.iter().enumerate() {
            writeln!(f, "  polynomial {index}, {label}: {coefficients:?}")?;
        }
        match self.polynomials - self.shown.len() {
            0 => Ok(()),
            more => writeln!(f, "  and {more} more"),
        }
    }
}
