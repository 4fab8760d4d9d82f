//! One run of the sample: it loads the scene, simulates the steps, and writes the trace.
use std::{
    fs::File,
    hint::black_box,
    io::{self, BufWriter, Write},
};

use super::{
    arguments::Options,
    hostile::{self, MidwayAct},
    trace::Trace,
};
use crate::student::{self, StepLog, Student, World};
use anyhow::Context;

/// The exit status for a run that would never end in the course's program.
const ENDLESS_STATUS: u8 = 3;

type Output = Trace<Box<dyn Write>>;

/// Simulates a scene, and returns the exit status of the program.
pub fn run(options: &Options, student: Student) -> anyhow::Result<u8> {
    if let Some(code) = hostile::act_at_start(student, options.output.as_deref())? {
        return Ok(code);
    }
    for round in 0..u64::from(options.busy) * 1_000_000 {
        black_box(round);
    }
    let scene = options.scene.as_deref().context("-s is missing: name a scene file")?;
    let text = std::fs::read(scene).with_context(|| format!("{}: can't be read", scene.display()))?;
    let scene = crate::scene::original::read(&text).with_context(|| format!("{}: not a scene", scene.display()))?.scene;
    let world = World::new(scene, student);
    let output: Box<dyn Write> = match &options.output {
        Some(path) => Box::new(BufWriter::new(
            File::create(path).with_context(|| format!("{}: can't be written", path.display()))?,
        )),
        None => Box::new(io::sink()),
    };
    let mut trace = Trace::new(output, &world.scene.collision, student);
    let code = simulate(&world, &mut trace)?;
    if code == 0 {
        trace.finish().context("the trace can't be written")?;
        println!(
            "Simulation complete at time {}. Exiting.",
            f64::from(world.scene.step_count()) * world.scene.time_step
        );
        return Ok(hostile::exit_status(student));
    }
    trace.flush().context("the trace can't be written")?;
    Ok(code)
}

fn simulate(world: &World, trace: &mut Output) -> anyhow::Result<u8> {
    let mut state = world.initial_state();
    let mut log = StepLog::default();
    trace.record(&state, &log)?;
    let steps = world.scene.step_count();
    for step in 1..=steps {
        if step == steps / 2 + 1 {
            match hostile::act_midway(world.student)? {
                MidwayAct::Continue => {}
                MidwayAct::Leave(code) => return Ok(code),
                MidwayAct::LeaveInsideRecord(code) => {
                    trace.write_raw(&[0; 5])?;
                    trace.flush()?;
                    std::process::exit(code.into());
                }
            }
        }
        let mut written = Ok(());
        let stepped = student::step(world, &mut state, &mut log, &mut |state, log| {
            if written.is_ok() {
                written = trace.record(state, log);
            }
        });
        written.context("the trace can't be written")?;
        if let Err(failure) = stepped {
            eprintln!("step {step}: {failure}");
            return Ok(ENDLESS_STATUS);
        }
    }
    Ok(0)
}
