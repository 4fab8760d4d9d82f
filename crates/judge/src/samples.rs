//! Scenes and traces for the tests of this crate.
use super::{options::Options, outcome::Outcome, replay};
use fosssim_model::{
    scene::{Scene, original},
    sim::{Observer, RootSearch, Simulation},
    trace::{Frame, Layout, Reader, Recorder, Writer},
};

/// A ball that falls on a half-plane: `continuous-time`.
pub(crate) const BOUNCE_SCENE: &str = r#"<scene>
  <duration time="1"/><integrator type="explicit-euler" dt="0.5"/><collision type="continuous-time" COR="1"/>
  <particle m="1" px="0" py="0.5" vx="0" vy="-1" fixed="0" radius="0.25"/>
  <halfplane px="0" py="0" nx="0" ny="1"/>
</scene>"#;

/// A ball that falls through an edge to a half-plane: `hybrid`, with too few impulse rounds for the first step.
pub(crate) const ZONES_SCENE: &str = r#"<scene>
  <duration time="0.3"/><integrator type="explicit-euler" dt="0.1"/>
  <collision type="hybrid" COR="0.5" maxiters="1" k="1" thickness="0.01"/>
  <particle m="1" px="0" py="0" vx="0" vy="0" fixed="0" radius="0.1"/>
  <particle m="1" px="1" py="0" vx="0" vy="0" fixed="0" radius="0.1"/>
  <particle m="1" px="0.4" py="0.5" vx="0" vy="-4" fixed="0" radius="0.1"/>
  <edge i="0" j="1" radius="0.1"/><halfplane px="0" py="-0.15" nx="0" ny="1"/>
</scene>"#;

/// Returns the scene written in `text`, read like the original.
pub(crate) fn scene(text: &str) -> Scene {
    original::read(text.as_bytes()).expect("a scene").scene
}

/// Returns the frames of a run that `steer` may change during the run.
pub(crate) fn simulate(scene: &Scene, mut steer: impl Observer) -> Vec<Frame> {
    let layout = Layout::for_scene(scene);
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    let mut recorder = Recorder::start(Vec::new(), layout, simulation.state());
    for _ in 0..layout.steps {
        simulation.step(&mut (&mut steer, &mut recorder)).expect("a step");
    }
    let trace = recorder.finish().expect("written").0;
    let mut reader = Reader::from_slice(&trace, layout);
    let (mut frames, mut frame) = (Vec::new(), Frame::default());
    while reader.next(&mut frame).expect("sound") {
        frames.push(frame.clone());
    }
    frames
}

/// Returns the bytes of `frames`.
pub(crate) fn encode_frames(scene: &Scene, frames: &[Frame]) -> Vec<u8> {
    let mut writer = Writer::new(Vec::new(), Layout::for_scene(scene));
    frames.iter().for_each(|frame| writer.write_frame(frame));
    writer.finish().expect("written").0
}

/// Returns the reference trace with changed frames.
pub(crate) fn changed_reference_trace(scene: &Scene, change: impl FnOnce(&mut Vec<Frame>)) -> Vec<u8> {
    let mut frames = simulate(scene, ());
    change(&mut frames);
    encode_frames(scene, &frames)
}

/// Returns the outcome by both rule books.
pub(crate) fn judge_by_both(scene: &Scene, trace: &[u8]) -> Outcome {
    let options = Options { uses_fair_rules: true, threads: 1, ..Options::default() };
    replay::judge(scene, trace, &options, &mut ())
}

/// Replaces a frame's polynomials.
pub(crate) fn replace_polynomials(frame: &mut Frame, mut change: impl FnMut(usize, &[f64]) -> Vec<f64>) {
    let log = std::mem::take(&mut frame.polynomials);
    for (index, coefficients) in log.iter().enumerate() {
        frame.polynomials.push(&change(index, coefficients));
    }
}
