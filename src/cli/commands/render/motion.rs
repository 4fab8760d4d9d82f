//! The motion that is drawn, as the positions of all bodies after each requested step.
//!
//! A motion is read or simulated only once. Its numbers are kept in memory, or in an unnamed temporary file if it is
//! large. Therefore the view can include all positions, even if the trace comes from a pipe.
use crate::{
    cli::{console, input},
    render::Extent,
    report::describe::describe_step_error,
    scene::Scene,
    sim::{RootSearch, Simulation},
    trace::{Frame, Layout},
};
use anyhow::{Context, Result};
use std::{
    io::{BufRead, BufReader, BufWriter, Read, Seek, Write},
    path::Path,
};
use tempfile::SpooledTempFile;

/// The maximum size of a motion that is kept in memory, in bytes.
const MAX_MEMORY_BYTES: usize = 32 << 20;

/// The steps that are drawn: `first`, `first + every` and so on up to `last`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct StepRange {
    pub(super) first: u32,
    /// The number of steps from one drawn step to the next, at least 1.
    pub(super) every: u32,
    pub(super) last: u32,
}

impl StepRange {
    /// Returns the number of drawn steps.
    pub(super) fn count(self) -> u32 {
        if self.first > self.last { 0 } else { (self.last - self.first) / self.every + 1 }
    }

    /// Returns the step of the picture with this number, which starts at 1.
    pub(super) fn step(self, number: u32) -> u32 {
        self.first + (number - 1) * self.every
    }

    fn contains(self, step: u32) -> bool {
        (self.first..=self.last).contains(&step) && (step - self.first).is_multiple_of(self.every)
    }
}

/// The positions of all particles after each drawn step.
pub(super) struct Motion {
    /// The name of the scene or the trace, for messages.
    pub(super) name: String,
    /// The number of steps whose positions are stored.
    pub(super) pictures: u32,
    /// The rectangle that contains all positions.
    pub(super) extent: Extent,
    /// The reason why the motion ends earlier than the scene.
    pub(super) stop_reason: Option<String>,
    rows: BufReader<SpooledTempFile>,
    width: usize,
}

impl Motion {
    /// Replaces the contents of `row` by the next positions. Returns `false` after the last ones.
    ///
    /// # Errors
    ///
    /// Fails if the temporary file can't be read.
    pub(super) fn next(&mut self, row: &mut Vec<f64>) -> Result<bool> {
        row.clear();
        for column in 0..self.width {
            let (mut bytes, context) = ([0; 8], "cannot read the temporary file again");
            if column == 0 && self.rows.fill_buf().context(context)?.is_empty() {
                return Ok(false);
            }
            self.rows.read_exact(&mut bytes).context(context)?;
            row.push(f64::from_le_bytes(bytes));
        }
        Ok(true)
    }
}

/// A motion whose positions are still being stored.
struct MotionWriter<'a> {
    scene: &'a Scene,
    steps: StepRange,
    file: BufWriter<SpooledTempFile>,
    pictures: u32,
    extent: Extent,
}

impl<'a> MotionWriter<'a> {
    fn new(scene: &'a Scene, picks: StepRange) -> Self {
        let file = BufWriter::new(tempfile::spooled_tempfile(MAX_MEMORY_BYTES));
        Self { scene, steps: picks, file, pictures: 0, extent: Extent::default() }
    }

    fn step(&mut self, step: u32, positions: &[f64]) -> Result<()> {
        if self.steps.contains(step) {
            self.extent.add(self.scene, positions);
            for value in positions {
                self.file.write_all(&value.to_le_bytes()).context("cannot write a temporary file")?;
            }
            self.pictures += 1;
        }
        Ok(())
    }

    fn finish(self, name: String, stopped: Option<String>) -> Result<Motion> {
        let context = "cannot write a temporary file";
        let mut file = self.file.into_inner().map_err(std::io::IntoInnerError::into_error).context(context)?;
        file.rewind().context(context)?;
        let (rows, width) = (BufReader::new(file), 2 * self.scene.particles.len());
        Ok(Motion { name, pictures: self.pictures, extent: self.extent, stop_reason: stopped, rows, width })
    }
}

/// Simulates the reference, and returns its motion.
///
/// # Errors
///
/// Fails if the motion can't be stored.
pub(super) fn simulate_reference(scene: &Scene, picks: StepRange) -> Result<Motion> {
    let mut keeper = MotionWriter::new(scene, picks);
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    keeper.step(0, &simulation.state().positions)?;
    let mut bar = console::Bar::new(picks.last);
    let mut stopped = None;
    for step in 1..=picks.last {
        if let Err(error) = simulation.step(&mut ()) {
            stopped = Some(describe_step_error(&error));
            break;
        }
        keeper.step(step, &simulation.state().positions)?;
        bar.show_step(step);
    }
    drop(bar);
    keeper.finish("the reference's run".to_owned(), stopped)
}

/// Reads a trace, and returns its motion.
///
/// # Errors
///
/// Fails if the trace can't be opened or stored, or the operating system fails while it is read. If the trace is
/// damaged, the motion only ends there.
pub(super) fn read_motion(scene: &Scene, name: &Path, picks: StepRange) -> Result<Motion> {
    let mut trace = input::open_trace(name)?;
    let layout = Layout::for_scene(scene);
    let mut reader = trace.records(scene);
    let mut keeper = MotionWriter::new(scene, picks);
    let mut frame = Frame::default();
    let mut stopped = None;
    loop {
        match reader.next(&mut frame) {
            Ok(true) => {}
            Ok(false) => break,
            Err(error) => {
                stopped = Some(error.to_string());
                break;
            }
        }
        let record = reader.record_count() - 1;
        let step = layout.step_of_record(record);
        if record == layout.end_record(step) {
            keeper.step(step, &frame.state.positions)?;
            if step == picks.last {
                break;
            }
        }
    }
    trace.ensure_not_failed()?;
    keeper.finish(format!("the trace {}", trace.name), stopped)
}

#[cfg(test)]
mod tests {
    use super::StepRange;

    #[test]
    fn picks_are_counted_without_overflow() {
        let picks = StepRange { first: 0, every: 3, last: 10 };
        assert_eq!((picks.count(), picks.step(4)), (4, 9));
        assert_eq!((0..=10).filter(|&step| picks.contains(step)).collect::<Vec<_>>(), [0, 3, 6, 9]);
        assert_eq!(StepRange { first: 5, every: 5, last: 4 }.count(), 0);
        let all = StepRange { first: 1, every: 1, last: i32::MAX as u32 };
        assert_eq!((all.count(), all.step(all.count())), (i32::MAX as u32, i32::MAX as u32));
    }
}
