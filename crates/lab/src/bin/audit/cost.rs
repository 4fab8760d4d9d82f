//! The highest cost of judging: traces whose states make the reference work as long as can be, on all scenes that come
//! with the program and on those of a corpus.
//!
//! A trace chooses the state that each step starts from. Here whole states are drawn: small and subnormal numbers,
//! crowds of bodies in one place, numbers of very different sizes. For each scene the slowest trace is shown, with the
//! processor time of judging it by both rule books and of explaining it.
use super::{Random, forged::scenes};
use fosssim_lab::runs::{frames, judged, reference};
use fosssim_oracle::{
    diagnose,
    scene::{Scene, original},
    trace::{Frame, Layout, Writer},
};
use rayon::prelude::*;
use std::{path::Path, process::ExitCode, time::Duration};

/// The number of scenes that are shown, the slowest first.
const SHOWN: usize = 25;

/// Sizes of states, as powers of ten.
const SIZES: [f64; 16] =
    [-320.0, -250.0, -160.0, -156.0, -155.0, -154.0, -150.0, -110.0, -80.0, -52.0, -30.0, -8.0, 0.0, 8.0, 60.0, 150.0];

/// The slowest trace of a scene: how long it took, the scene's name, and how it was drawn and judged.
type Slowest = (Duration, String, String);

/// Tries this number of traces of each scene.
pub fn run(of_each: u64, seed: u64, corpus: Option<&Path>) -> ExitCode {
    let mut scenes = scenes(corpus);
    if let Ok(part) = std::env::var("SCENE") {
        scenes.retain(|(name, _)| name.contains(&part));
    }
    let slowest = |(number, (name, bytes)): (usize, &(String, Vec<u8>))| {
        let scene = original::read(bytes).ok()?.scene;
        let frames = frames(&scene, &reference(&scene)?);
        let mut random = Random::new(seed, number as u64);
        let tried = (0..of_each).map(|_| tried(&mut random, name, &scene, &frames));
        tried.max_by_key(|one| one.0)
    };
    let mut found: Vec<Slowest> = scenes.par_iter().enumerate().filter_map(slowest).collect();
    found.sort_by_key(|one| std::cmp::Reverse(one.0));
    for (time, name, what) in found.iter().take(SHOWN) {
        println!("{:>9.3} s  {name}: {what}", time.as_secs_f64());
    }
    ExitCode::SUCCESS
}

/// Judges and explains a drawn trace.
fn tried(random: &mut Random, name: &str, scene: &Scene, frames: &[Frame]) -> Slowest {
    let (trace, what) = drawn(random, scene, frames);
    let begin = processor_time();
    let outcome = judged(scene, &trace);
    let seconds = processor_time().saturating_sub(begin).as_secs_f64();
    drop(diagnose::explain(scene, &trace));
    let time = processor_time().saturating_sub(begin);
    let (steps, stop) = (outcome.steps_judged, outcome.stop);
    (time, name.to_owned(), format!("judging {seconds:.3} s; {what}; {steps} steps judged, {stop:?}"))
}

/// The processor time of this thread so far.
fn processor_time() -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    Duration::from_nanos(text.split(' ').next().and_then(|word| word.parse().ok()).unwrap_or(0))
}

/// A trace with drawn states, and how they were drawn.
fn drawn(random: &mut Random, scene: &Scene, frames: &[Frame]) -> (Vec<u8>, String) {
    let layout = Layout::of(scene);
    let size = |random: &mut Random| match random.chance(2) {
        true => random.uniform(-162.0, -145.0),
        false => SIZES[random.below(SIZES.len() as u64) as usize],
    };
    let places = size(random);
    let speeds = if random.chance(2) { places } else { size(random) };
    let spread = [0.0, 0.5, 3.0, 40.0][random.below(4) as usize];
    let way = random.below(4);
    let mut writer = Writer::new(Vec::new(), layout);
    for (number, own) in frames.iter().enumerate() {
        let mut frame = own.clone();
        if number > 0 {
            let mut change = |values: &mut Vec<f64>, size: f64| {
                for value in values.iter_mut() {
                    let drawn = random.uniform(-1.0, 1.0) * 10.0_f64.powf(size + spread * random.uniform(-1.0, 1.0));
                    *value = match way {
                        0 => *value * 10.0_f64.powf(size),
                        1 => drawn,
                        2 => *value + drawn,
                        _ if random.chance(2) => drawn,
                        _ => 0.0,
                    };
                }
            };
            change(&mut frame.state.positions, places);
            change(&mut frame.state.velocities, speeds);
        }
        writer.frame(&frame);
    }
    let what = format!("way {way}, places 1e{places:.1}, speeds 1e{speeds:.1}, spread {spread}");
    (writer.finish().expect("memory").0, what)
}
