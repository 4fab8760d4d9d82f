//! Random traces on random scenes: polynomials with factors, roundings and lost coefficients, near the bounds of what
//! is right. Judging by the shortcuts and the full way have to say the same to the last field.
use super::{Random, lanes};
use fosssim_oracle::{
    judge::{
        fair::FairVerdict,
        replay::{self, Options},
    },
    scene::Scene,
    sim::{RootSearch, Simulation},
    student::{self, CATALOGUE, Student},
    trace::{Frame, Layout, Reader, Recorder, Writer},
};
use std::{
    process::ExitCode,
    sync::{
        Mutex,
        atomic::{AtomicU64, Ordering},
    },
};

/// Programs with other polynomials that are right; half of the traces are theirs, the others begin with the
/// reference's.
const VARIANTS: [&str; 4] = ["quintic-right", "normalised-per-pair", "rearranged-pe", "rearranged-pp"];

/// The number of differing lines that are shown, around the first place.
const SHOWN: usize = 20;

/// Compares this number of traces.
pub fn run(traces: u64, seed: u64) -> ExitCode {
    let (next, accepted) = (AtomicU64::new(0), AtomicU64::new(0));
    let differing = Mutex::new(Vec::new());
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= traces {
                return;
            }
            let mut random = Random::new(seed, number);
            let scene = lanes::draw(&mut random);
            let Some(trace) = draw(&mut random, &scene) else { continue };
            for fair in [true, false] {
                let [one, other] = [false, true].map(|one_by_one| {
                    let options = Options { threads: 1, fair, one_by_one, ..Options::default() };
                    replay::judge(&scene, &trace[..], &options, &mut ())
                });
                if one.fair.as_ref().is_some_and(|fair| fair.verdict == FairVerdict::Accepted) {
                    accepted.fetch_add(1, Ordering::Relaxed);
                }
                let [one, other] = [one, other].map(|outcome| format!("{outcome:?}"));
                if one != other {
                    let mut differing = differing.lock().expect("no other thread has panicked");
                    let first = one.bytes().zip(other.bytes()).take_while(|(one, other)| one == other).count();
                    let parts = [one, other]
                        .map(|text| text.chars().skip(first.saturating_sub(200)).take(400).collect::<String>());
                    differing
                        .push((number, format!("fair {fair}, {:?}:\n  {}\n  {}", scene.collision, parts[0], parts[1])));
                }
            }
        }
    };
    std::thread::scope(|scope| {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        (0..threads).for_each(|_| _ = scope.spawn(work));
    });
    let mut differing = differing.into_inner().expect("no thread has panicked");
    differing.sort();
    println!(
        "{traces} traces, {} accepted by the fair rules, {} outcomes differ",
        accepted.into_inner(),
        differing.len()
    );
    for (number, what) in differing.iter().take(SHOWN) {
        println!("trace {number}, {what}");
    }
    ExitCode::from(u8::from(!differing.is_empty()))
}

/// A trace; none where the scene has no result.
fn draw(random: &mut Random, scene: &Scene) -> Option<Vec<u8>> {
    let layout = Layout::of(scene);
    let own = if random.chance(2) {
        let id = VARIANTS[random.below(VARIANTS.len() as u64) as usize];
        let row = CATALOGUE.iter().find(|row| row.id == id).expect("a variant");
        student::trace(scene, Student::new(Some(row.mistake))).ok()?
    } else {
        let mut simulation = Simulation::new(scene, RootSearch::WhereNeeded);
        let mut recorder = Recorder::start(Vec::new(), layout, simulation.state());
        (0..layout.steps).try_for_each(|_| simulation.step(&mut recorder)).ok()?;
        recorder.finish().expect("memory").0
    };
    let factors = RandomFactors::draw(random);
    let noise = [0.0, 1.0, random.log(0.0, 3.0)][random.below(3) as usize];
    let every = 1 + random.below(40);
    let seed = random.bits();
    let (mut reader, mut writer) = (Reader::of_slice(&own, layout), Writer::new(Vec::new(), layout));
    let (mut frame, mut number) = (Frame::default(), 0_u64);
    while reader.next(&mut frame).ok()? {
        // Both records of a step change alike.
        let step = number.div_ceil(2);
        let log = std::mem::take(&mut frame.polynomials);
        for (index, own) in log.iter().enumerate() {
            let mut random = Random::new(seed, step.wrapping_mul(0x9E37_79B9) ^ index as u64);
            let factor = factors.of(&mut random, index);
            let sum: f64 = own.iter().map(|c| c.abs()).sum();
            let is_noisy = noise > 0.0 && random.below(every) == 0;
            let changed = own.iter().map(|c| {
                let off = if is_noisy { noise * random.uniform(-1.0, 1.0) * f64::EPSILON } else { 0.0 };
                factor * (c + off * if random.chance(2) { *c } else { sum })
            });
            let changed: Vec<f64> = changed.skip_while(|c| c.abs() < 1e-12).collect();
            frame.polynomials.push(&changed);
        }
        writer.frame(&frame);
        number += 1;
    }
    Some(writer.finish().expect("memory").0)
}

/// The factors of a program's polynomials.
enum RandomFactors {
    /// One for all.
    One(f64),
    /// One for each of several in turn.
    InTurn([f64; 6]),
    /// Another one each time.
    Each,
}

impl RandomFactors {
    fn draw(random: &mut Random) -> Self {
        match random.below(4) {
            0 => Self::One(1.0),
            1 => Self::One(if random.chance(2) { random.log(-13.0, 8.0) } else { random.log(-1.0, 1.0) }),
            2 => Self::InTurn(std::array::from_fn(|_| random.log(-2.0, 2.0))),
            _ => Self::Each,
        }
    }

    fn of(&self, random: &mut Random, index: usize) -> f64 {
        match self {
            Self::One(factor) => *factor,
            Self::InTurn(factors) => factors[index % factors.len()],
            Self::Each => random.log(-1.0, 1.0),
        }
    }
}
