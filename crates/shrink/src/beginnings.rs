//! Wrong steps as scenes of their own: the state before a step is the initial state.
use fosssim_model::{
    scene::{Display, Scene},
    sim::State,
    trace::{Layout, Lenient, LenientFrame},
};
use fosssim_num::vector::at;

/// Wrong steps that are tried: a later one may show alone the reason that the first one shows together with others.
const MOST_STEPS: usize = 6;

/// Returns scenes to begin with, each with its wrong step, in the order in which they are tried: each of these wrong
/// steps alone, then the first one with the step before it, then the whole run up to it. `trace` is the program's trace
/// of the scene; steps count from 1 and ascend. Parts that only a display uses are removed.
#[must_use]
pub fn beginnings(scene: &Scene, trace: &[u8], wrong: &[u32]) -> Vec<(u32, Scene)> {
    let Some(&first) = wrong.first() else { return Vec::new() };
    let wanted: Vec<u32> = wrong.iter().copied().take(MOST_STEPS).collect();
    let states = states(scene, trace, wanted.last().copied().unwrap_or(first));
    let from = |step: u32, steps: u32| {
        let state = states.get(step as usize - 1).filter(|state| state.is_finite())?;
        Some(from_state(scene, state, steps))
    };
    let alone = wanted.iter().filter_map(|step| Some((*step, from(*step, 1)?)));
    let with_before = (first > 1).then(|| from(first - 1, 2)).flatten();
    let whole = (first > 2).then(|| from(1, first)).flatten();
    alone.chain([with_before, whole].into_iter().flatten().map(|scene| (first, scene))).collect()
}

/// Returns the state before each step up to this one, if the trace has them.
fn states(scene: &Scene, trace: &[u8], last: u32) -> Vec<State> {
    let layout = Layout::for_scene(scene);
    let (mut reader, mut frame) = (Lenient::from_slice(trace, layout), LenientFrame::default());
    let mut states = vec![State::for_scene(scene)];
    while states.len() < last as usize && reader.next(&mut frame).is_ok() {
        let record = reader.records() - 1;
        if record > 0 && !layout.is_mid(record) {
            states.push(frame.state.clone());
        }
    }
    states
}

/// Returns the scene that begins in this state and takes this number of steps.
fn from_state(scene: &Scene, state: &State, steps: u32) -> Scene {
    let mut scene = Scene { description: None, display: Display::default(), ..scene.clone() };
    for (index, particle) in scene.particles.iter_mut().enumerate() {
        (particle.position, particle.velocity) = (at(&state.positions, index), at(&state.velocities, index));
        particle.tag = None;
    }
    set_steps(&mut scene, steps);
    scene
}

/// Sets the duration to this number of steps.
pub(crate) fn set_steps(scene: &mut Scene, steps: u32) {
    scene.duration = scene.time_step * f64::from(steps);
    if scene.steps() != steps {
        scene.duration = scene.time_step * (f64::from(steps) - 0.5);
    }
}
