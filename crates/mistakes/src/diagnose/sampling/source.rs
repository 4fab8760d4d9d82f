//! The records of a trace as explanations read them: step by step, as far as they are at hand.
use super::compare::Logged;
use fosssim_judge::kept::{KeptTrace, LONGEST, LateStep};
use fosssim_model::{
    scene::Scene,
    sim::{RootSearch, Simulation},
    trace::{Layout, Lenient, LenientFrame, Unreadable, record_memory},
};
use fosssim_num::tolerances::FIRST_RECORD;
use std::io::Read;

/// Records at the beginning of the trace that are kept whatever they hold, and their memory.
const OPENING: usize = 25;
const OPENING_MEMORY: usize = 4 << 20;

/// The records of a trace.
pub struct Source<'a> {
    /// Its beginning.
    beginning: Box<dyn Read + 'a>,
    /// Whether that is all of it.
    is_whole: bool,
    /// Steps beyond.
    late: &'a [LateStep],
}

impl<'a> Source<'a> {
    /// All of a trace.
    pub fn whole(trace: impl Read + 'a) -> Self {
        Self { beginning: Box::new(trace), is_whole: true, late: &[] }
    }
}

impl<'a> From<&'a KeptTrace<'_>> for Source<'a> {
    fn from(trace: &'a KeptTrace<'_>) -> Self {
        Self { beginning: Box::new(trace.beginning()), is_whole: trace.is_whole(), late: trace.late() }
    }
}

/// The records of one step.
#[derive(Debug, Default)]
pub struct StepFrames {
    /// The record before it.
    pub before: LenientFrame,
    /// The one in its middle, where the scene has one.
    pub mid: LenientFrame,
    /// The one at its end.
    pub end: LenientFrame,
}

/// Facts about a trace besides its steps.
#[derive(Debug, Default)]
pub struct Outline {
    /// The first records.
    pub opening: Vec<Logged>,
    opening_memory: usize,
    /// Records whose polynomials have small leading coefficients, which the course's library drops.
    pub padded: u64,
    /// How many records the trace has, when its end was reached.
    pub records: Option<u64>,
    /// Whether the trace goes on after the scene's last step.
    pub is_longer: bool,
}

impl Outline {
    /// Whether the first record belongs to another scene. Programs do not compute it, so it differs from the scene's
    /// initial state by no more than the rounding to single precision.
    pub fn is_of_other_scene(&self, scene: &Scene) -> bool {
        let Some(first) = self.opening.first() else { return false };
        let simulation = Simulation::new(scene, RootSearch::WhereNeeded);
        let differs = |ours: &[f64], theirs: &[f64]| {
            let largest = ours.iter().fold(1.0_f64, |largest, value| largest.max(value.abs()));
            // A value that is not finite comes from no scene.
            ours.iter().zip(theirs).any(|(o, t)| t.is_finite() && (o - t).abs() > FIRST_RECORD * largest)
        };
        let initial = simulation.state();
        differs(&initial.positions, &first.state.positions) || differs(&initial.velocities, &first.state.velocities)
    }

    /// Reads a record. False behind the last sound one: nobody is to blame for the rest of a damaged record.
    fn read<R: Read>(&mut self, reader: &mut Lenient<R>, frame: &mut LenientFrame) -> bool {
        match reader.next(frame) {
            Ok(()) if frame.note.is_some() => false,
            Ok(()) => {
                self.padded += u64::from(!frame.plain);
                if self.opening.len() < OPENING && self.opening_memory < OPENING_MEMORY {
                    let logged = Logged::from(&*frame);
                    self.opening_memory += logged.bytes();
                    self.opening.push(logged);
                }
                true
            }
            Err(stop) => {
                if stop.cause == Unreadable::State {
                    self.records = Some(reader.records());
                }
                false
            }
        }
    }
}

/// Reads the steps of a trace: those of its first 64 MiB up to the first damage, then those that were kept beyond.
pub struct StepReader<'a> {
    scene: &'a Scene,
    layout: Layout,
    reader: Lenient<Box<dyn Read + 'a>>,
    is_whole: bool,
    late: &'a [LateStep],
    /// The number of the next step of the beginning; `None` behind its end.
    next: Option<u32>,
    /// The records of the step that was read last; before that the first record of the trace, if there is one.
    pub frames: StepFrames,
    /// Facts about the trace besides its steps.
    pub outline: Outline,
}

impl<'a> StepReader<'a> {
    /// Reads the first record.
    pub fn new(scene: &'a Scene, source: Source<'a>) -> Self {
        let layout = Layout::of(scene);
        let mut reader = Lenient::new(source.beginning, layout).with_limit(record_memory(scene));
        let (mut frames, mut outline) = (StepFrames::default(), Outline::default());
        let next = outline.read(&mut reader, &mut frames.before).then_some(1);
        Self { scene, layout, reader, is_whole: source.is_whole, late: source.late, next, frames, outline }
    }

    /// Reads the next step; its number.
    pub fn next(&mut self) -> Option<u32> {
        if let Some(step) = self.next.take()
            && self.read_step(step)
        {
            self.next = Some(step + 1);
            return Some(step);
        }
        if !self.is_whole {
            self.outline.records = None;
        }
        while let Some((late, rest)) = self.late.split_first() {
            self.late = rest;
            if self.read_late(late) {
                return Some(late.step);
            }
        }
        None
    }

    fn read_step(&mut self, step: u32) -> bool {
        if step > self.layout.steps {
            self.outline.is_longer = self.reader.has_more();
            if !self.outline.is_longer {
                self.outline.records = Some(self.reader.records());
            }
            return false;
        }
        if self.reader.offset() > LONGEST {
            return false;
        }
        let StepFrames { before, mid, end } = &mut self.frames;
        if step > 1 {
            std::mem::swap(before, end);
        }
        let mut read = |frame| self.outline.read(&mut self.reader, frame);
        (!self.layout.polynomials || read(mid)) && read(end)
    }

    /// Reads a step that was kept; false unless all of its records are sound.
    fn read_late(&mut self, late: &LateStep) -> bool {
        let mut reader = Lenient::of_slice(&late.records, self.layout).with_limit(record_memory(self.scene));
        let mut read = |frame: &mut LenientFrame| reader.next(frame).is_ok() && frame.note.is_none();
        let StepFrames { before, mid, end } = &mut self.frames;
        read(before) && (!self.layout.polynomials || read(mid)) && read(end)
    }
}
