//! `trace info`, `trace show`, `trace diff`: what traces hold.
use crate::{
    cli::{
        arguments::{TraceDiff, TraceInfo, TraceShow},
        console, exit,
        input::{self, SceneInput, TraceInput},
        values::TextOrJson,
    },
    report::{
        number::counted,
        trace::{self as report, ShownRecord, ShownStep},
    },
    trace::{Frame, Layout, Reader, Summary, compare, labels},
};
use anyhow::{Context, Result, bail};
use std::io::Read;

/// Prints the contents of a trace. Exit code 1 when it can't be read to its end.
pub(super) fn info(arguments: &TraceInfo) -> Result<u8> {
    let scene = input::scene(&arguments.scene)?;
    let mut trace = input::trace(&arguments.trace)?;
    let summary = Summary::of(&scene.scene, &mut trace.reader);
    no_failure(&trace)?;
    let text = match arguments.format {
        TextOrJson::Text => summary.to_string(),
        TextOrJson::Json => report::info_json(&scene.name, &trace.name, &summary),
    };
    console::show(&text, arguments.format)?;
    Ok(if summary.trace.stopped.is_none() { exit::ACCEPTED } else { exit::NOT_ACCEPTED })
}

/// One step of a trace.
pub(super) fn show(arguments: &TraceShow) -> Result<u8> {
    let scene = input::scene(&arguments.scene)?;
    let mut trace = input::trace(&arguments.trace)?;
    let steps = scene.scene.steps();
    let step = arguments.step;
    if step > steps {
        bail!("the scene {} has {}; there is no step {step}", scene.name, counted(steps.into(), "step"));
    }
    let layout = Layout::of(&scene.scene);
    let mut reader = reader(&scene, &mut trace);
    let (mut frame, mut before) = (Frame::default(), Frame::default());
    let mut records = Vec::new();
    loop {
        match reader.next(&mut frame) {
            Ok(true) => {}
            Ok(false) => break,
            Err(error) => {
                no_failure(&trace)?;
                bail!("cannot show step {step} of the trace {}: {error}", trace.name);
            }
        }
        let number = reader.records() - 1;
        if layout.step_of(number) == step {
            records.push(ShownRecord {
                number,
                offset: reader.record_offset(),
                mid: layout.is_mid(number),
                frame: frame.clone(),
                notes: reader.notes().iter().map(ToString::to_string).collect(),
            });
        }
        if number == layout.end_record(step) {
            break;
        }
        if !layout.is_mid(number) {
            std::mem::swap(&mut frame, &mut before);
        }
    }
    let labels = if step > 0 { labels(&scene.scene, &before.state) } else { Vec::new() };
    let shown = ShownStep { step, steps, records: &records, labels: &labels };
    let text = match arguments.format {
        TextOrJson::Text => shown.text(console::style()),
        TextOrJson::Json => shown.json(&scene.name, &trace.name),
    };
    console::show(&text, arguments.format)?;
    Ok(exit::ACCEPTED)
}

/// Two traces side by side. Exit code 1 when they differ.
pub(super) fn diff(arguments: &TraceDiff) -> Result<u8> {
    let scene = input::scene(&arguments.scene)?;
    let mut left = input::trace(&arguments.left)?;
    let mut right = input::trace(&arguments.right)?;
    let comparison = compare(reader(&scene, &mut left), reader(&scene, &mut right));
    no_failure(&left)?;
    no_failure(&right)?;
    let names = report::TraceNames { scene: &scene.name, left: &left.name, right: &right.name };
    let text = match arguments.format {
        TextOrJson::Text => report::diff_text(&names, &comparison, console::style()),
        TextOrJson::Json => report::diff_json(&names, &comparison),
    };
    console::show(&text, arguments.format)?;
    Ok(if report::same(&comparison) { exit::ACCEPTED } else { exit::NOT_ACCEPTED })
}

fn reader<'a>(scene: &SceneInput, trace: &'a mut TraceInput) -> Reader<&'a mut Box<dyn Read + Send>> {
    let reader = Reader::new(&mut trace.reader, Layout::of(&scene.scene)).with_scene(&scene.scene);
    match trace.length {
        Some(length) => reader.with_length(length),
        None => reader,
    }
}

/// An error of the operating system is not the trace's fault.
fn no_failure(trace: &TraceInput) -> Result<()> {
    trace
        .failure()
        .map_or(Ok(()), |message| Err(anyhow::anyhow!(message)))
        .with_context(|| format!("cannot read the trace {}", trace.name))
}
