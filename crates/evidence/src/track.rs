//! A motion, as the exact positions and velocities of consecutive records.
use fosssim_model::{
    sim::State,
    trace::{Layout, LenientFrame, LenientReader},
};
use std::io::Read;

/// The maximum number of kept numbers of a motion (16 MB). The largest course scene has 70,444 (11 particles, 1,601
/// records). With a lower limit, long scenes show only a part of their motion; with a higher limit, memory and pages
/// grow.
pub const MAX_NUMBERS: usize = 1 << 21;

/// The kept records, which are those of steps `first` to `last`. Step 0 is the initial record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// The first step, whose end record is the first kept record.
    pub first: u32,
    /// The last step.
    pub last: u32,
}

impl Window {
    /// Returns all steps if a motion of that length fits into the budget. Otherwise returns the steps around `focus`, a
    /// third of them before it.
    pub fn for_focus(focus: u32, layout: Layout, budget: usize) -> Self {
        let per_step = 4 * layout.particles.max(1) * layout.records_per_step() as usize;
        let room = u32::try_from((budget / per_step).max(1)).unwrap_or(u32::MAX);
        if room > layout.steps {
            return Self { first: 0, last: layout.steps };
        }
        let first = focus.saturating_sub(room / 3).min(layout.steps - room);
        Self { first, last: first + room }
    }

    /// Returns whether the scene's whole motion is kept.
    pub const fn is_whole(&self, steps: u32) -> bool {
        self.first == 0 && self.last >= steps
    }

    /// Returns whether a record of a step is kept.
    pub const fn contains(&self, step: u32, is_mid: bool) -> bool {
        (self.first < step || self.first == step && !is_mid) && step <= self.last
    }
}

/// Consecutive records of a motion, starting with the end record of a window's first step.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Track {
    /// The positions and velocities of each record in trace order, with two components per particle.
    pub values: Vec<f64>,
    /// The number of records. It is smaller than the window's if the motion ends early.
    pub records: usize,
}

impl Track {
    /// Reads the records of a trace in a window, up to the first record that cannot be read.
    pub fn read(trace: &mut dyn Read, layout: Layout, window: Window) -> Self {
        let mut reader = LenientReader::new(trace, layout);
        let (mut frame, mut track) = (LenientFrame::default(), Self::default());
        for record in 0..layout.records() {
            if layout.step_of_record(record) > window.last || reader.next(&mut frame).is_err() {
                break;
            }
            if window.contains(layout.step_of_record(record), layout.is_mid_record(record)) {
                track.push(&frame.state);
            }
        }
        track
    }

    /// Appends a state to the motion.
    pub(crate) fn push(&mut self, state: &State) {
        self.values.extend_from_slice(&state.positions);
        self.values.extend_from_slice(&state.velocities);
        self.records += 1;
    }
}
