//! Makes scenes of wrong steps: the state before a step becomes the initial state.
use crate::size::set_steps;
use fosssim_model::{
    scene::{Display, Scene},
    sim::State,
    trace::{Layout, LenientFrame, LenientReader},
};
use fosssim_num::vector::vector_at;

/// The maximum number of wrong steps that are tried. A later step may show one cause alone that the first one shows
/// together with others.
const MAX_STEPS: usize = 6;

/// Returns scenes to begin with, each with its wrong step, in the order in which they are tried. First is each of the
/// wrong steps alone. Then comes the first wrong step with the step before it, and finally the whole run up to it.
/// `trace` is the program's trace of the scene; steps count from 1 and ascend. Parts that only a display uses are
/// removed.
pub fn step_starts(scene: &Scene, trace: &[u8], wrong: &[u32]) -> Vec<(u32, Scene)> {
    let wrong = &wrong[..wrong.len().min(MAX_STEPS)];
    let (Some(&first), Some(&last)) = (wrong.first(), wrong.last()) else { return Vec::new() };
    let layout = Layout::for_scene(scene);
    let (mut reader, mut frame) = (LenientReader::from_slice(trace, layout), LenientFrame::default());
    // The state before each step, if the trace has it.
    let mut states = vec![State::for_scene(scene)];
    while states.len() < last as usize && reader.next(&mut frame).is_ok() {
        let record = reader.record_count() - 1;
        if record > 0 && !layout.is_mid_record(record) {
            states.push(frame.state.clone());
        }
    }
    let from = |step: u32, steps: u32| {
        let state = states.get(step.checked_sub(1)? as usize).filter(|state| state.is_finite())?;
        let mut scene = Scene { description: None, display: Display::default(), ..scene.clone() };
        for (index, particle) in scene.particles.iter_mut().enumerate() {
            (particle.position, particle.velocity) =
                (vector_at(&state.positions, index), vector_at(&state.velocities, index));
            particle.tag = None;
        }
        set_steps(&mut scene, steps);
        Some(scene)
    };
    let single_steps = wrong.iter().map(|&step| (step, from(step, 1)));
    let longer = [(first, from(first - 1, 2)), (first, from(1, first))];
    single_steps.chain(longer).filter_map(|(step, scene)| Some((step, scene?))).collect()
}
