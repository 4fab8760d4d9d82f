//! Lanes against single pairs: random scenes are stepped both ways, and every bit has to be the same.
use super::Random;
use fosssim_oracle::{
    num::vector::Vec2,
    scene::{Collision, Display, Edge, HalfPlane, Integrator, Particle, Scene},
    sim::{RootSearch, SearchCounts, Simulation},
    trace::{Layout, StepBytes},
};
use rayon::prelude::*;
use std::process::ExitCode;

/// Scenes that are drawn before it is asked whether they are enough.
const BLOCK: u64 = 256;

/// Counts of the comparison so far.
#[derive(Default)]
struct Compared {
    scenes: u64,
    pairs: u64,
    steps: u64,
    failed: u64,
    searched: u64,
    bytes: u64,
    /// The first scene, by its number, that differs.
    first: Option<(u64, String)>,
}

impl Compared {
    fn and(self, other: Self) -> Self {
        Self {
            scenes: self.scenes + other.scenes,
            pairs: self.pairs + other.pairs,
            steps: self.steps + other.steps,
            failed: self.failed + other.failed,
            searched: self.searched + other.searched,
            bytes: self.bytes + other.bytes,
            first: [self.first, other.first].into_iter().flatten().min(),
        }
    }
}

/// Compares steps until this number of pairs has been compared.
pub fn run(pairs: u64, seed: u64) -> ExitCode {
    let mut total = Compared::default();
    while total.pairs < pairs {
        let numbers = total.scenes..total.scenes + BLOCK;
        let compared = numbers.into_par_iter().map(|number| compare(number, &draw(&mut Random::new(seed, number))));
        total = total.and(compared.reduce(Compared::default, Compared::and));
    }
    let Compared { scenes, pairs, steps, failed, searched, bytes, first } = total;
    println!("{pairs} pairs in {steps} steps of {scenes} scenes, {failed} of them without a result");
    println!("{searched} root searches, {bytes} bytes compared");
    let differs = first.is_some();
    match first {
        Some((number, what)) => println!("first difference: scene {number}, {what}"),
        None => println!("no bit differs"),
    }
    ExitCode::from(u8::from(differs))
}

/// Steps a scene both ways.
fn compare(number: u64, scene: &Scene) -> Compared {
    let mut compared = Compared { scenes: 1, ..Compared::default() };
    let [mut lanes, mut single] = [(); 2].map(|()| Simulation::new(scene, RootSearch::WhereNeeded));
    single.forgo_lanes();
    let [mut quick, mut slow] = [(); 2].map(|()| StepBytes::new(Layout::of(scene)));
    for step in 1..=scene.steps() {
        let results = [lanes.step(&mut quick), single.step(&mut slow)];
        compared.steps += 1;
        let has_failed = results[0].is_err();
        compared.failed += u64::from(has_failed);
        let same = results[0] == results[1] && lanes.search_counts() == single.search_counts();
        let same = same && (has_failed || quick.records().eq(slow.records()));
        if !same {
            compared.first = Some((number, format!("step {step}: {results:?}\n{scene:?}")));
        }
        if has_failed || !same {
            break;
        }
        compared.bytes += quick.len() as u64;
    }
    // A simulation that nobody listens to computes the same.
    let mut unheard = Simulation::new(scene, RootSearch::WhereNeeded);
    let is_over = (0..scene.steps()).all(|_| unheard.step(&mut ()).is_ok());
    if is_over && unheard.search_counts() != lanes.search_counts() {
        compared.first = compared.first.take().or(Some((number, format!("unheard: {scene:?}"))));
    }
    let SearchCounts { calls, searched, .. } = lanes.search_counts();
    Compared { pairs: calls, searched, ..compared }
}

/// A scene: sizes, places and motions from wide and nasty distributions.
pub(super) fn draw(random: &mut Random) -> Scene {
    let scale = random.log(-3.0, 4.0) * if random.chance(50) { random.log(30.0, 160.0) } else { 1.0 };
    let grid = random.chance(4);
    let common = random.direction() * (scale * random.log(-6.0, 0.0));
    let particles: Vec<Particle> = (0..1 + random.below(24))
        .map(|_| {
            let position = if grid { random.grid(8, 0.125 * scale) } else { random.point(scale) };
            let own = random.direction() * (scale * random.log(-14.0, 0.0));
            let mut velocity = match random.below(4) {
                0 => Vec2::zeros(),
                1 => common,
                2 if grid => random.grid(4, 0.125 * scale),
                _ => own,
            };
            let radius = if grid { 0.125 * scale } else { scale * random.log(-4.0, -0.5) };
            if random.chance(5000) {
                velocity.x = f64::NAN;
            }
            Particle { position, velocity, mass: random.log(-1.0, 1.0), fixed: random.chance(3), radius, tag: None }
        })
        .collect();
    let count = particles.len() as u64;
    let end = |random: &mut Random| random.below(count) as usize;
    let edges = (0..random.below(7))
        .map(|_| Edge { first: end(random), second: end(random), radius: scale * random.log(-4.0, -1.0) })
        .collect();
    let half_planes = (0..random.below(4))
        .map(|_| {
            let point = if grid { random.grid(8, 0.125 * scale) } else { random.point(scale) };
            let normal = if grid { random.grid(2, 1.0) } else { random.direction() * random.log(-2.0, 2.0) };
            HalfPlane { point, normal }
        })
        .collect();
    let restitution = random.uniform(0.0, 1.0);
    let collision = if random.chance(2) {
        Collision::ContinuousTime { restitution }
    } else {
        let max_iterations = random.below(4) as i32;
        Collision::Hybrid { restitution, max_iterations, stiffness: 0.0, thickness: 0.0 }
    };
    Scene {
        duration: 3.0,
        time_step: 1.0,
        integrator: Integrator::ExplicitEuler,
        collision,
        particles,
        edges,
        half_planes,
        forces: Vec::new(),
        description: None,
        display: Display::default(),
    }
}
