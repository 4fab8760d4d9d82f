//! `detect`: one detection call, looked at closely.
use crate::{
    cli::{
        console, exit,
        input::{self, SceneInput, pair},
        output::Output,
        pictures::{Detect, DetectFormat, Points},
    },
    judge::study::Study,
    render::{detection, plot::Embedding},
    report::{
        describe::step_error,
        detect::{Detect as Report, Place},
        number::counted,
        style::Style,
    },
    sim::{Detection, Observer, Pair, PairMotion, Pass, RootSearch, Simulation, Stage, State},
    trace::{Frame, Layout, Reader},
};
use anyhow::{Context, Result, bail};
use std::path::Path;

pub(super) fn run(arguments: &Detect) -> Result<u8> {
    match &arguments.scene {
        Some(scene) => of_scene(arguments, scene)?,
        None => {
            let motion = typed(arguments)?;
            show(arguments, &study(&motion)?, None, &[])?;
        }
    }
    Ok(exit::ACCEPTED)
}

fn study(motion: &PairMotion) -> Result<Study> {
    Study::of(motion).context("there is no answer: the numbers are too large or too small, and the original hangs here")
}

fn show(arguments: &Detect, study: &Study, place: Option<Place<'_>>, inputs: &[input::Identity]) -> Result<()> {
    let target = arguments.output.as_deref().map(|name| Output::create(name, inputs)).transpose()?;
    let style = if target.is_some() { Style::Plain } else { console::style() };
    let report = Report { study, place };
    let text = match arguments.format {
        DetectFormat::Text => report.text(style),
        DetectFormat::Json => report.json(),
        DetectFormat::Svg => detection::picture(study, &report.title(), Embedding::Alone),
    };
    match target {
        Some(target) => target.finish_with(text.as_bytes()),
        None if arguments.format == DetectFormat::Text => console::report(&text),
        None => console::print(text.as_bytes()),
    }
}

/// The pair whose numbers were typed.
fn typed(arguments: &Detect) -> Result<PairMotion> {
    const NOTHING: &str = "name a pair: its points (detect pe:3,1+4,1:5,9+2,6:5,3+5,8 --radii 1,1), or where it is in a scene \
                           (--scene, --step, --pair)";
    let radii = || arguments.radii.as_deref().context("the radii are missing: add --radii, as in --radii 1,0.5");
    if let Some(word) = &arguments.word {
        return pair::motion(word, radii()?);
    }
    let Points { x1, d1, e1, x2, d2, e2, x3, d3, e3, point, normal } = &arguments.points;
    let Some(x1) = x1 else { bail!(NOTHING) };
    let words = |x: &String, d: &Option<String>, e: &Option<String>| match (d, e) {
        (Some(d), _) => format!("{x}+{d}"),
        (None, Some(e)) => format!("{x}..{e}"),
        (None, None) => x.clone(),
    };
    let first = words(x1, d1, e1);
    let word = match (x2, x3, point, normal) {
        (Some(x2), None, ..) if d3.is_none() && e3.is_none() => format!("pp:{first}:{}", words(x2, d2, e2)),
        (Some(x2), Some(x3), ..) => format!("pe:{first}:{}:{}", words(x2, d2, e2), words(x3, d3, e3)),
        (None, None, Some(point), Some(normal)) => format!("ph:{first}:{point}:{normal}"),
        (Some(_), None, ..) => bail!("the start of the edge's second end is missing: --x3"),
        _ => bail!("the second object is missing: --x2 (and --x3 for an edge), or --point and --normal"),
    };
    pair::motion(&word, radii()?)
}

/// A pair of a scene, in a step of the reference's run or of a trace.
fn of_scene(arguments: &Detect, name: &Path) -> Result<()> {
    let scene = input::scene(name)?;
    let (Some(step), Some(word)) = (arguments.step, &arguments.pair) else { bail!("name a step and a pair") };
    let steps = scene.scene.steps();
    if step == 0 || step > steps {
        let steps = counted(steps.into(), "step");
        bail!("the scene {} has {steps}, counted from 1; there is no step {step}", scene.name);
    }
    let pair = pair::of_scene(word, &scene.scene).with_context(|| format!("the pair {word}"))?;
    let mut inputs: Vec<_> = scene.identity.into_iter().collect();
    let (before, end, trace) = match &arguments.trace {
        Some(trace) => {
            let (before, end, trace, identity) = traced(&scene, trace, step)?;
            inputs.extend(identity);
            (before, Some(end), Some(trace))
        }
        None => (simulated(&scene, step)?, None, None),
    };
    let mut watch = Watch::new(&scene.scene, pair);
    let mut simulation = Simulation::new(&scene.scene, RootSearch::WhereNeeded);
    simulation.state_mut().clone_from(&before);
    simulation.set_steps_done(step - 1);
    let failed = simulation.step(&mut watch).err();
    let passes = watch.calls.len();
    let (motion, pass, logged) = match watch.calls.get(arguments.pass as usize - 1) {
        Some(call) => {
            (call.motion, (call.polynomials > 0).then_some(call.pass), call.logged(end.as_ref(), watch.polynomials))
        }
        None => match failed {
            Some(error) => {
                let (step, words) = step_error(&error);
                bail!("step {step} has no result, because {words}");
            }
            None if passes == 0 => {
                let end = &simulation.state().positions;
                (PairMotion::between(&scene.scene, pair, &before.positions, end), None, None)
            }
            None => {
                let plural = if passes == 1 { "pass" } else { "passes" };
                bail!("step {step} has {passes} detection {plural}; there is no pass {}", arguments.pass)
            }
        },
    };
    let (scene, trace, logged) = (scene.name.as_str(), trace.as_deref(), logged.as_deref());
    let place = Place { scene, trace, step, pair, pass, passes, logged };
    show(arguments, &study(&motion)?, Some(place), &inputs)
}

/// The state before a step of the reference's run.
fn simulated(scene: &SceneInput, step: u32) -> Result<State> {
    let mut simulation = Simulation::new(&scene.scene, RootSearch::WhereNeeded);
    for _ in 1..step {
        if let Err(error) = simulation.step(&mut ()) {
            let (step, words) = step_error(&error);
            bail!("the scene {} can't be simulated: step {step} has no result, because {words}", scene.name);
        }
    }
    Ok(simulation.state().clone())
}

/// The state of a trace before a step, the step's end record, the trace's name, and which file it is.
fn traced(scene: &SceneInput, name: &Path, step: u32) -> Result<(State, Frame, String, Option<input::Identity>)> {
    let mut trace = input::trace(name)?;
    let layout = Layout::of(&scene.scene);
    let mut reader = Reader::new(&mut trace.reader, layout).with_scene(&scene.scene);
    if let Some(length) = trace.length {
        reader = reader.with_length(length);
    }
    let (mut frame, mut before) = (Frame::default(), State::default());
    loop {
        let read = reader.next(&mut frame);
        let record = reader.records();
        match read {
            Ok(true) if record - 1 == layout.end_record(step - 1) => before.clone_from(&frame.state),
            Ok(true) if record - 1 == layout.end_record(step) => break,
            Ok(true) => {}
            Ok(false) => bail!("the trace {} has no step {step}", trace.name),
            Err(error) => {
                if let Some(message) = trace.failure() {
                    bail!("cannot read the trace {}: {message}", trace.name);
                }
                bail!("cannot read step {step} of the trace {}: {error}", trace.name);
            }
        }
    }
    Ok((before, frame, trace.name, trace.identity))
}

/// Listens for one pair.
struct Watch<'a> {
    scene: &'a crate::scene::Scene,
    pair: Pair,
    pass: Pass,
    /// The pair's calls, one per pass.
    calls: Vec<Call>,
    /// Polynomials logged so far in the step.
    polynomials: usize,
}

/// One detection call of the pair.
struct Call {
    pass: Pass,
    motion: PairMotion,
    /// Number of its first polynomial in the step's list.
    first: usize,
    /// How many it logs; none without continuous-time detection.
    polynomials: usize,
}

impl Call {
    /// What a trace has logged for this call, if it logged as many polynomials in the step as the reference.
    fn logged(&self, end: Option<&Frame>, polynomials: usize) -> Option<Vec<Vec<f64>>> {
        let log = &end?.polynomials;
        (log.len() == polynomials && self.polynomials > 0)
            .then(|| (self.first..self.first + self.polynomials).map(|index| log.get(index).to_vec()).collect())
    }
}

impl<'a> Watch<'a> {
    fn new(scene: &'a crate::scene::Scene, pair: Pair) -> Self {
        let pass = Pass { stage: Stage::Simple, index: 0 };
        Self { scene, pair, pass, calls: Vec::new(), polynomials: 0 }
    }
}

impl Observer for Watch<'_> {
    fn begin_pass(&mut self, pass: Pass) {
        self.pass = pass;
    }

    fn detection(&mut self, detection: &Detection<'_>) {
        let (first, polynomials) = (self.polynomials, detection.polynomials.len());
        self.polynomials += polynomials;
        if detection.pair == self.pair {
            let motion = PairMotion::between(self.scene, self.pair, detection.q_start, detection.q_end);
            self.calls.push(Call { pass: self.pass, motion, first, polynomials });
        }
    }
}
