//! The command `trace show`, which shows one step of a trace.
use crate::{
    cli::{arguments::TraceShowArguments, console, input},
    report::{
        number::format_count,
        trace::{ShownRecord, ShownStep},
    },
    trace::{Frame, Layout, collect_labels},
};
use anyhow::{Result, bail};

/// Shows one step of a trace.
pub(super) fn show(arguments: &TraceShowArguments) -> Result<()> {
    let scene = input::read_scene(&arguments.scene)?;
    let mut trace = input::open_trace(&arguments.trace)?;
    let steps = scene.scene.step_count();
    let step = arguments.step;
    if step > steps {
        bail!("the scene {} has {}; there is no step {step}", scene.name, format_count(steps.into(), "step"));
    }
    let layout = Layout::for_scene(&scene.scene);
    let mut reader = trace.records(&scene.scene);
    let (mut frame, mut before) = (Frame::default(), Frame::default());
    let mut records = Vec::new();
    loop {
        match reader.next(&mut frame) {
            Ok(true) => {}
            Ok(false) => break,
            Err(error) => {
                trace.ensure_not_failed()?;
                bail!("cannot show step {step} of the trace {}: {error}", trace.name);
            }
        }
        let number = reader.record_count() - 1;
        if layout.step_of_record(number) == step {
            records.push(ShownRecord {
                number,
                offset: reader.record_offset(),
                is_mid: layout.is_mid_record(number),
                frame: frame.clone(),
                notes: reader.notes().iter().map(ToString::to_string).collect(),
            });
        }
        if number == layout.end_record(step) {
            break;
        }
        if !layout.is_mid_record(number) {
            std::mem::swap(&mut frame, &mut before);
        }
    }
    let labels = if step > 0 { collect_labels(&scene.scene, &before.state) } else { Vec::new() };
    let shown = ShownStep { step, steps, records: &records, labels: &labels };
    console::show(arguments.format, || shown.render_text(console::style()), || shown.json(&scene.name, &trace.name))
}
