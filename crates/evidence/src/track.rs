//! A motion: positions and velocities of consecutive records, exact to the last bit.
use fosssim_model::{
    sim::State,
    trace::{Layout, Lenient, LenientFrame},
};
use std::io::Read;

/// The greatest number of numbers kept of a motion (16 MB). The largest course scene has 70,444 (11 particles, 1,601
/// records); lowered, long scenes show a part of their motion only; raised, memory and pages grow.
pub const BUDGET: usize = 1 << 21;

/// The kept records: those of the steps `first` to `last` (0 is the initial record).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// The first step; its end record is the first that is kept.
    pub first: u32,
    /// The last step.
    pub last: u32,
}

impl Window {
    /// Returns all steps, if a motion of that length fits in the budget; else those around `focus`, a third before it.
    #[must_use]
    pub fn for_focus(focus: u32, layout: Layout, budget: usize) -> Self {
        let per_step = 4 * layout.particles.max(1) * layout.records_per_step() as usize;
        let room = u32::try_from((budget / per_step).max(1)).unwrap_or(u32::MAX);
        if room > layout.steps {
            return Self { first: 0, last: layout.steps };
        }
        let first = focus.saturating_sub(room / 3).min(layout.steps - room);
        Self { first, last: first + room }
    }

    /// Returns whether the scene's motion is kept as a whole.
    #[must_use]
    pub const fn is_whole(&self, steps: u32) -> bool {
        self.first == 0 && self.last >= steps
    }

    /// Returns whether a record of this step is kept.
    #[must_use]
    pub const fn holds(&self, step: u32, is_mid: bool) -> bool {
        (self.first < step || self.first == step && !is_mid) && step <= self.last
    }
}

/// Consecutive records of a motion, from the end record of a window's first step on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Track {
    /// Per record positions and velocities in trace order, 2N each.
    pub values: Vec<f64>,
    /// The number of records; fewer than the window where the motion ends early.
    pub records: usize,
}

impl Track {
    /// Reads the records of a trace in a window, up to the place at which it can't be read.
    #[must_use]
    pub fn read(trace: &mut dyn Read, layout: Layout, window: Window) -> Self {
        let mut reader = Lenient::new(trace, layout);
        let (mut frame, mut track) = (LenientFrame::default(), Self::default());
        for record in 0..layout.records() {
            if layout.step_of(record) > window.last || reader.next(&mut frame).is_err() {
                break;
            }
            if window.holds(layout.step_of(record), layout.is_mid(record)) {
                track.push(&frame.state);
            }
        }
        track
    }

    /// Appends a record.
    pub(crate) fn push(&mut self, state: &State) {
        self.values.extend_from_slice(&state.positions);
        self.values.extend_from_slice(&state.velocities);
        self.records += 1;
    }
}
