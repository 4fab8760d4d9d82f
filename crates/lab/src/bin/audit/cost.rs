//! The highest cost of judging: traces whose states make the reference work as long as can be, on all scenes that come
//! with the program and on those of a corpus.
//!
//! A trace chooses the state that each step starts from. Here whole states are drawn: small and subnormal numbers,
//! crowds of bodies in one place, numbers of very different sizes. For each scene the slowest trace is shown, with the
//! processor time of judging it by both rule books and of explaining it.
use super::Random;
use fosssim_oracle::{
    diagnose,
    judge::replay::{self, Options},
    scene::{Scene, original},
    sim::{RootSearch, Simulation},
    trace::{Frame, Layout, Reader, Recorder, Writer},
};
use std::{
    path::Path,
    process::ExitCode,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    time::Duration,
};

/// The number of scenes that are shown, the slowest first.
const SHOWN: usize = 25;

/// Sizes of states, as powers of ten.
const SIZES: [f64; 16] =
    [-320.0, -250.0, -160.0, -156.0, -155.0, -154.0, -150.0, -110.0, -80.0, -52.0, -30.0, -8.0, 0.0, 8.0, 60.0, 150.0];

/// The slowest trace of a scene.
struct Slowest {
    time: Duration,
    name: String,
    what: String,
}

/// Tries this number of traces of each scene.
pub fn run(of_each: u64, seed: u64, corpus: Option<&Path>) -> ExitCode {
    let mut scenes = super::forged::scenes(corpus);
    if let Ok(part) = std::env::var("SCENE") {
        scenes.retain(|(name, _)| name.contains(&part));
    }
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some((name, bytes)) = scenes.get(number) else { return };
            let Ok(read) = original::read(bytes) else { continue };
            let Some(frames) = own(&read.scene) else { continue };
            let mut random = Random::new(seed, number as u64);
            let mut slowest: Option<Slowest> = None;
            for _ in 0..of_each {
                let (trace, what) = drawn(&mut random, &read.scene, &frames);
                let begin = processor_time();
                let options = Options { threads: 1, fair: true, ..Options::default() };
                let outcome = replay::judge(&read.scene, &trace[..], &options, &mut ());
                let judged = processor_time().saturating_sub(begin);
                drop(diagnose::explain(&read.scene, &trace));
                let time = processor_time().saturating_sub(begin);
                if slowest.as_ref().is_none_or(|slowest| slowest.time < time) {
                    let what = format!(
                        "judging {:.3} s; {what}; {} steps judged, {:?}",
                        judged.as_secs_f64(),
                        outcome.steps_judged,
                        outcome.stop
                    );
                    slowest = Some(Slowest { time, name: name.clone(), what });
                }
            }
            found.lock().expect("no other thread has panicked").extend(slowest);
        }
    };
    std::thread::scope(|scope| {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        (0..threads).for_each(|_| _ = scope.spawn(work));
    });
    let mut found = found.into_inner().expect("no thread has panicked");
    found.sort_by_key(|slowest| std::cmp::Reverse(slowest.time));
    for Slowest { time, name, what } in found.iter().take(SHOWN) {
        println!("{:>9.3} s  {name}: {what}", time.as_secs_f64());
    }
    ExitCode::SUCCESS
}

/// The processor time of this thread so far.
fn processor_time() -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    Duration::from_nanos(text.split(' ').next().and_then(|word| word.parse().ok()).unwrap_or(0))
}

/// The reference's own records.
fn own(scene: &Scene) -> Option<Vec<Frame>> {
    let layout = Layout::of(scene);
    let mut simulation = Simulation::new(scene, RootSearch::WhereNeeded);
    let mut recorder = Recorder::start(Vec::new(), layout, simulation.state());
    (0..layout.steps).try_for_each(|_| simulation.step(&mut recorder)).ok()?;
    let trace = recorder.finish().ok()?.0;
    let (mut reader, mut frames) = (Reader::of_slice(&trace, layout), Vec::new());
    let mut frame = Frame::default();
    while reader.next(&mut frame).ok()? {
        frames.push(std::mem::take(&mut frame));
    }
    Some(frames)
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
