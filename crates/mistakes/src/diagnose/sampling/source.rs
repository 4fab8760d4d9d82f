//! Reads the records of a trace for explanations, step by step, up to the end of the kept part.
use super::compare::LoggedNumbers;
use fosssim_judge::kept_trace::{KeptTrace, MAX_KEPT_BYTES};
use fosssim_model::{
    scene::Scene,
    sim::{RootSearch, Simulation},
    trace::{Layout, LenientFrame, LenientReader, ReadFailure, record_memory},
};
use fosssim_num::tolerances::FIRST_RECORD_ERROR;

/// The maximum number of records at the beginning of the trace that are kept.
const OPENING_RECORDS: usize = 25;
const MAX_OPENING_BYTES: usize = 4 << 20;

/// The bytes from which a trace's records are read: the whole trace, or its beginning.
pub struct Source<'a> {
    /// The beginning of the trace.
    beginning: &'a [u8],
    /// Whether the whole trace was kept.
    is_whole: bool,
}

impl<'a> Source<'a> {
    /// Creates the source of a complete trace.
    pub fn from_trace(trace: &'a [u8]) -> Self {
        Self { beginning: trace, is_whole: true }
    }
}

impl<'a> From<&'a KeptTrace> for Source<'a> {
    fn from(trace: &'a KeptTrace) -> Self {
        Self { beginning: trace.bytes(), is_whole: trace.is_whole() }
    }
}

/// The records of one step.
#[derive(Debug, Default)]
pub struct StepFrames {
    /// The record before the step.
    pub before: LenientFrame,
    /// The mid record, if the scene has one.
    pub mid: LenientFrame,
    /// The record of the state at the end of the step.
    pub end: LenientFrame,
}

/// Facts about a trace in addition to its steps.
#[derive(Debug, Default)]
pub struct Outline {
    /// The first records.
    pub opening: Vec<LoggedNumbers>,
    opening_memory: usize,
    /// The number of records that contain small leading coefficients, which the course's library would drop.
    pub padded_records: u64,
    /// The number of records of the trace, if its end was reached.
    pub records: Option<u64>,
    /// Whether the trace continues after the scene's last step.
    pub is_longer: bool,
}

impl Outline {
    /// Returns whether the first record belongs to another scene. Programs only copy this record, so it differs from
    /// the scene's initial state at most by rounding to single precision.
    pub fn belongs_to_other_scene(&self, scene: &Scene) -> bool {
        let Some(first) = self.opening.first() else { return false };
        let simulation = Simulation::new(scene, RootSearch::OnDemand);
        let differs = |ours: &[f64], theirs: &[f64]| {
            let largest = ours.iter().fold(1.0_f64, |largest, value| largest.max(value.abs()));
            // All values of a scene are finite.
            ours.iter().zip(theirs).any(|(o, t)| t.is_finite() && (o - t).abs() > FIRST_RECORD_ERROR * largest)
        };
        let initial = simulation.state();
        differs(&initial.positions, &first.state.positions) || differs(&initial.velocities, &first.state.velocities)
    }

    /// Reads a record. Returns `false` after the last undamaged record, because the rest of a damaged trace does not
    /// prove a mistake.
    fn read_record(&mut self, reader: &mut LenientReader<&[u8]>, frame: &mut LenientFrame) -> bool {
        match reader.next(frame) {
            Ok(()) if frame.note.is_some() => false,
            Ok(()) => {
                self.padded_records += u64::from(!frame.is_unchanged);
                if self.opening.len() < OPENING_RECORDS && self.opening_memory < MAX_OPENING_BYTES {
                    let logged = LoggedNumbers::from(&*frame);
                    self.opening_memory += logged.memory_size();
                    self.opening.push(logged);
                }
                true
            }
            Err(stop) => {
                if stop.cause == ReadFailure::State {
                    self.records = Some(reader.record_count());
                }
                false
            }
        }
    }
}

/// A reader of the steps in a trace's first 64 MiB, up to the first damage.
pub struct StepReader<'a> {
    layout: Layout,
    reader: LenientReader<&'a [u8]>,
    is_whole: bool,
    /// The number of the next step, or `None` after the end.
    next_step: Option<u32>,
    /// The records of the step that was read last. Before the first step, it holds the first record of the trace, if
    /// there is one.
    pub frames: StepFrames,
    /// Facts about the trace in addition to its steps.
    pub outline: Outline,
}

impl<'a> StepReader<'a> {
    /// Begins to read a trace, with its first record.
    pub fn new(scene: &Scene, source: Source<'a>) -> Self {
        let layout = Layout::for_scene(scene);
        let mut reader = LenientReader::from_slice(source.beginning, layout).with_limit(record_memory(scene));
        let (mut frames, mut outline) = (StepFrames::default(), Outline::default());
        let next = outline.read_record(&mut reader, &mut frames.before).then_some(1);
        Self { layout, reader, is_whole: source.is_whole, next_step: next, frames, outline }
    }

    /// Reads the next step, and returns its number, or `None` after the last step.
    pub fn next(&mut self) -> Option<u32> {
        if let Some(step) = self.next_step.take()
            && self.read_step(step)
        {
            self.next_step = Some(step + 1);
            return Some(step);
        }
        if !self.is_whole {
            self.outline.records = None;
        }
        None
    }

    fn read_step(&mut self, step: u32) -> bool {
        if step > self.layout.steps {
            self.outline.is_longer = self.reader.has_more();
            if !self.outline.is_longer {
                self.outline.records = Some(self.reader.record_count());
            }
            return false;
        }
        if self.reader.offset() > MAX_KEPT_BYTES as u64 {
            return false;
        }
        let StepFrames { before, mid, end } = &mut self.frames;
        if step > 1 {
            std::mem::swap(before, end);
        }
        let mut read = |frame| self.outline.read_record(&mut self.reader, frame);
        (!self.layout.has_polynomials || read(mid)) && read(end)
    }
}
