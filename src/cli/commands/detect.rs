//! The command `detect`, which shows one detection call in detail.
use crate::files::Identity;
use crate::{
    cli::{
        arguments::draw::{DetectArguments, DetectFormat},
        console,
        input::{self, SceneInput, pair},
        output::Output,
    },
    evidence::{self, CallLog, InspectedPair},
    judge::{overlap::OverlapCheck, study::Study},
    render::{detection, plot::PlotTarget},
    report::{
        describe::describe_step_error,
        detect::{CallPlace, DetectReport, Overlap},
        style::Style,
    },
    scene::Collision,
    sim::{PairMotion, RootSearch, Simulation, State},
    trace::{Frame, Layout},
};
use anyhow::{Context, Result, bail};
use std::path::Path;

const NO_ANSWER: &str = "no result: the numbers are too large or too small, and the original would hang";

pub(super) fn run(arguments: &DetectArguments) -> Result<()> {
    match &arguments.scene {
        Some(scene) => detect_in_scene(arguments, scene),
        None => show(arguments, &study_motion(&parse_typed(arguments)?)?, None, &[]),
    }
}

fn study_motion(motion: &PairMotion) -> Result<Study> {
    Study::for_motion(motion).context(NO_ANSWER)
}

fn show(arguments: &DetectArguments, study: &Study, place: Option<CallPlace<'_>>, inputs: &[Identity]) -> Result<()> {
    let report = DetectReport { study, place };
    write_output(arguments, inputs, |style| match arguments.format {
        DetectFormat::Text => report.render_text(style),
        DetectFormat::Json => report.json(),
        DetectFormat::Svg => detection::render_picture(study, &report.title(), PlotTarget::File),
    })
}

/// Prints the report on a decision of `simple` collision handling.
fn print(arguments: &DetectArguments, report: &Overlap<'_>, inputs: &[Identity]) -> Result<()> {
    if arguments.format == DetectFormat::Svg {
        bail!("a picture shows polynomials, and this scene's detection has none: use --format text or json");
    }
    if arguments.pass > 1 {
        bail!("step {} has 1 detection pass; there is no pass {}", report.step, arguments.pass);
    }
    write_output(arguments, inputs, |style| match arguments.format {
        DetectFormat::Json => report.json(),
        _ => report.render_text(style),
    })
}

/// Writes a report to standard output, or to the file that was requested.
fn write_output(arguments: &DetectArguments, inputs: &[Identity], text: impl FnOnce(Style) -> String) -> Result<()> {
    let target = arguments.output.as_deref().map(|name| Output::create(name, inputs)).transpose()?;
    let text = text(if target.is_some() { Style::Plain } else { console::style() });
    match target {
        Some(target) => target.finish_with(text.as_bytes()),
        None if arguments.format == DetectFormat::Text => console::report(&text),
        None => console::print(&text),
    }
}

/// Returns the pair whose numbers were typed.
fn parse_typed(arguments: &DetectArguments) -> Result<PairMotion> {
    const NO_PAIR: &str = "name a pair: its points (detect pe:3,1+4,1:5,9+2,6:5,3+5,8 --radii 1,1), or where it is in \
                           a scene (--scene, --step, --pair)";
    let pair = arguments.word.as_deref().context(NO_PAIR)?;
    pair::parse_motion(pair, arguments.radii.as_deref())
}

/// Reports on a pair of a scene, in a step of a trace or of the reference's own run.
fn detect_in_scene(arguments: &DetectArguments, name: &Path) -> Result<()> {
    let scene = input::read_scene(name)?;
    let (Some(step), Some(typed)) = (arguments.step, &arguments.pair) else { bail!("name a step and a pair") };
    let steps = scene.scene.step_count();
    if step == 0 || step > steps {
        bail!("there is no step {step}; the steps of the scene {} are 1 to {steps}", scene.name);
    }
    let pair = pair::find_pair(typed, &scene.scene).with_context(|| format!("the pair {typed}"))?;
    let mut inputs: Vec<_> = scene.identity.into_iter().collect();
    let (before, traced) = match &arguments.trace {
        Some(trace) => {
            let traced = read_traced(&scene, trace, step)?;
            inputs.extend(traced.identity);
            (traced.before.clone(), Some(traced))
        }
        None => (simulate_to(&scene, step)?, None),
    };
    if matches!(scene.scene.collision, Collision::Simple { .. }) {
        let found = OverlapCheck::for_pair(&scene.scene, step, &before, pair);
        let study = found
            .map_err(|error| anyhow::Error::msg(describe_step_error(&error)))?
            .context("detection never tests this pair")?;
        let (scene, trace) = (scene.name.as_str(), traced.as_ref().map(|traced| traced.name.as_str()));
        let logged = traced.as_ref().map(|traced| traced.end.impulses.iter().any(|logged| logged.pair() == Some(pair)));
        return print(arguments, &Overlap { study: &study, scene, trace, step, pair, logged }, &inputs);
    }
    let records = traced.as_ref().map(|traced| (&traced.mid, &traced.end.polynomials));
    let InspectedPair { step: inspected, end, error: failed } =
        evidence::inspect(&scene.scene, step, &before, records, pair);
    let pass_count = inspected.calls.len();
    let call = inspected.calls.get(arguments.pass as usize - 1);
    match (call, failed) {
        (None, Some(error)) => bail!(describe_step_error(&error)),
        (None, None) if pass_count > 0 => {
            let plural = if pass_count == 1 { "pass" } else { "passes" };
            bail!("step {step} has {pass_count} detection {plural}; there is no pass {}", arguments.pass)
        }
        _ => {}
    }
    let study = match call.map(|call| &call.study) {
        Some(Ok(seen)) => seen.clone(),
        Some(Err(error)) => return Err(*error).context(NO_ANSWER),
        None => study_motion(&PairMotion::from_positions(&scene.scene, pair, &before.positions, &end.positions))?,
    };
    let pass = call.filter(|call| call.polynomials > 0).map(|call| call.pass);
    let logged = call.map_or(&CallLog::Unknown, |call| &call.logged);
    let (scene, trace) = (scene.name.as_str(), traced.as_ref().map(|traced| traced.name.as_str()));
    let place = CallPlace { scene, trace, step, pair, pass, passes: pass_count, logged };
    show(arguments, &study, Some(place), &inputs)
}

/// Simulates the reference, and returns the state before a step.
fn simulate_to(scene: &SceneInput, step: u32) -> Result<State> {
    let mut simulation = Simulation::new(&scene.scene, RootSearch::OnDemand);
    for _ in 1..step {
        if let Err(error) = simulation.step(&mut ()) {
            bail!("the scene {} can't be simulated: {}", scene.name, describe_step_error(&error));
        }
    }
    Ok(simulation.state().clone())
}

/// The records of one step in a trace.
struct TracedStep {
    before: State,
    /// The state of the mid record. Without mid records, that of the record before the step's end record.
    mid: State,
    end: Frame,
    name: String,
    identity: Option<Identity>,
}

fn read_traced(scene: &SceneInput, name: &Path, step: u32) -> Result<TracedStep> {
    let mut trace = input::open_trace(name)?;
    let layout = Layout::for_scene(&scene.scene);
    let mut reader = trace.records(&scene.scene);
    let (mut frame, mut before, mut mid) = (Frame::default(), State::default(), State::default());
    loop {
        let read = reader.next(&mut frame);
        let record = reader.record_count();
        match read {
            Ok(true) if record - 1 == layout.end_record(step) => break,
            Ok(true) => {
                if record - 1 == layout.end_record(step - 1) {
                    before.clone_from(&frame.state);
                }
                if record == layout.end_record(step) {
                    mid.clone_from(&frame.state);
                }
            }
            Ok(false) => bail!("the trace {} has no step {step}", trace.name),
            Err(error) => {
                trace.ensure_not_failed()?;
                bail!("cannot read step {step} of the trace {}: {error}", trace.name);
            }
        }
    }
    Ok(TracedStep { before, mid, end: frame, name: trace.name, identity: trace.identity })
}
