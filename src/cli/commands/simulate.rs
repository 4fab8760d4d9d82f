//! The command `simulate`, which simulates a scene and records its trace.
use crate::{
    cli::{
        arguments::{SimulateArguments, values::TextOrJson},
        console, input,
        output::Output,
    },
    report::{describe::describe_step_error, simulate::SimulationSummary, style::Style},
    sim::{RootSearch, Simulation},
    trace::{EventCounts, Layout, Recorder},
};
use anyhow::{Context, Result, bail};

pub(super) fn run(arguments: &SimulateArguments) -> Result<()> {
    let scene = input::read_scene(&arguments.scene)?;
    let inputs: Vec<_> = scene.identity.into_iter().collect();
    let output = match &arguments.output {
        Some(name) => Output::create(name, &inputs)?,
        None => Output::Discarded,
    };
    let to_stdout = output.is_stdout();
    let mut simulation = Simulation::new(&scene.scene, RootSearch::OnDemand);
    let mut recorder = Recorder::start(output, Layout::for_scene(&scene.scene), simulation.state());
    let mut counts = EventCounts::new(&scene.scene);
    let steps = scene.scene.step_count();
    let mut bar = console::Bar::new(steps);
    for step in 1..=steps {
        if let Err(error) = simulation.step(&mut (&mut recorder, &mut counts)) {
            bail!("the scene {} can't be simulated: {}", scene.name, describe_step_error(&error));
        }
        if recorder.has_failed() {
            break;
        }
        bar.show_step(step);
    }
    drop(bar);
    let (output, written) = recorder.finish().context("the trace could not be written")?;
    output.finish()?;
    let name = arguments.output.as_ref().map(|name| input::printable_name(name));
    let summary =
        SimulationSummary { scene: &scene.name, output: name.as_deref(), steps, counts, written_trace: written };
    match (to_stdout, arguments.format) {
        (true, TextOrJson::Text) => console::print_remark(summary.render_text(Style::Plain)),
        (true, TextOrJson::Json) => console::print_remark(summary.json()),
        (false, format) => console::show(format, || summary.render_text(console::style()), || summary.json())?,
    }
    Ok(())
}
