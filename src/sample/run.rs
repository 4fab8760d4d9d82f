//! One run of the sample: it loads the scene, simulates the steps, and writes the trace.
use std::hint::black_box;

use super::arguments::Options;
use crate::student::{self, Student};
use anyhow::Context;

/// The exit status for a run that would never end in the course's program.
const ENDLESS_STATUS: u8 = 3;

/// Simulates a scene, and returns the exit status of the program.
pub fn run(options: &Options, student: Student) -> anyhow::Result<u8> {
    for round in 0..u64::from(options.busy) * 1_000_000 {
        black_box(round);
    }
    let scene = options.scene.as_deref().context("-s is missing: name a scene file")?;
    let text = std::fs::read(scene).with_context(|| format!("{}: can't be read", scene.display()))?;
    let scene = crate::scene::original::read(&text).with_context(|| format!("{}: not a scene", scene.display()))?.scene;
    let (trace, failure) = match student::record_trace(&scene, student) {
        Ok(trace) => (trace, None),
        Err((trace, failure)) => (trace, Some(failure)),
    };
    if let Some(path) = &options.output {
        std::fs::write(path, trace).with_context(|| format!("{}: can't be written", path.display()))?;
    }
    if let Some(failure) = failure {
        eprintln!("{failure}");
        return Ok(ENDLESS_STATUS);
    }
    println!("Simulation complete at time {}. Exiting.", f64::from(scene.step_count()) * scene.time_step);
    Ok(0)
}
