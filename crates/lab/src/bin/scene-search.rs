//! Searches small scenes that contain what the scenes of a suite lack (`suite check --missing`).
//!
//!     scene-search SUITE SCENES [TRIES] [SEED] [FOLDER]
//!
//! Random scenes of few bodies are simulated by the reference; each round keeps the one with the most missing pairs of properties
//! for its work, and takes away whatever it does not need for them. Numbers are small dyadic fractions, so that contacts fall
//! exactly on the start and the end of steps. Scenes with decisions that hang on round-off, and those that correct variants fail,
//! are not kept. What is found is printed, or written into the folder; names and descriptions are for people to give.
use anyhow::Context;
use fosssim_oracle::{
    judge::{
        fair::{FairVerdict, borderline},
        replay::{Options, judge},
    },
    num::vector::Vec2,
    scene::{self, Collision, Display, Edge, Force, HalfPlane, Integrator, Particle, Scene},
    student::{self, CATALOGUE, RowKind, Student},
    suite::{
        coverage::{Coverage, Pairing},
        plan,
    },
};
use rayon::prelude::*;
use std::path::PathBuf;

/// Marsaglia's xorshift64* (Vigna, "An experimental exploration of Marsaglia's xorshift generators", 2016).
struct Dice(u64);

impl Dice {
    fn of(seed: u64, run: u64) -> Self {
        let mut dice = Self((seed ^ run.wrapping_mul(0x9e37_79b9_7f4a_7c15)) | 1);
        for _ in 0..4 {
            dice.below(2);
        }
        dice
    }

    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        ((self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) % end.max(1) as u64) as usize
    }

    fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// A multiple of `unit` between `-most` and `most` of them.
    fn number(&mut self, most: i32, unit: f64) -> f64 {
        let whole = i32::try_from(self.below((2 * most + 1) as usize)).unwrap_or(0) - most;
        f64::from(whole) * unit
    }
}

/// A random scene: some groups of bodies far apart, numbered at random.
fn draw(dice: &mut Dice) -> Scene {
    let time_step = dice.one(&[0.25, 0.5]);
    let restitution = dice.one(&[0.0, 0.5, 1.0]);
    let collision = match dice.below(4) {
        0 => Collision::ContinuousTime { restitution },
        _ => Collision::Hybrid {
            restitution,
            max_iterations: dice.one(&[0, 0, 1, 1, 2, 2, 3, 5]),
            stiffness: dice.one(&[0.0, 0.0, 0.0, 5.0]),
            thickness: dice.one(&[0.0, 0.25]),
        },
    };
    let integrators = [
        Integrator::ExplicitEuler,
        Integrator::SymplecticEuler,
        Integrator::LinearizedImplicitEuler,
        Integrator::ImplicitEuler,
    ];
    let mut scene = Scene {
        duration: time_step * dice.one(&[1.0, 1.0, 2.0, 3.0, 4.0]),
        time_step,
        integrator: dice.one(&integrators),
        collision,
        particles: Vec::new(),
        edges: Vec::new(),
        half_planes: Vec::new(),
        forces: Vec::new(),
        description: None,
        display: Display::default(),
    };
    let same = dice.below(3) == 0;
    for group in 0..dice.one(&[1, 1, 2, 2, 3]) {
        let home = Vec2::new(16.0 * f64::from(group), 0.0);
        for _ in 0..dice.one(&[1, 2, 2, 3, 3, 4, 5]) {
            let position = home + Vec2::new(dice.number(8, 0.5), dice.number(8, 0.5));
            let velocity = Vec2::new(dice.number(8, 0.5 / time_step), dice.number(8, 0.5 / time_step));
            let still = dice.below(4) == 0;
            scene.particles.push(Particle {
                position,
                velocity: if still { Vec2::zeros() } else { velocity },
                mass: if same { 1.0 } else { dice.one(&[1.0, 2.0, 3.0]) },
                fixed: dice.below(5) == 0,
                radius: if same { 0.5 } else { dice.one(&[0.5, 0.75, 1.0]) },
                tag: None,
            });
        }
        for _ in 0..dice.below(2) {
            let point = home + Vec2::new(dice.number(4, 1.0), -4.0);
            let normal = dice.one(&[[0.0, 1.0], [0.0, -1.0], [0.0, 2.0], [1.0, 2.0], [-3.0, 4.0], [0.0, -0.5]]);
            scene.half_planes.push(HalfPlane { point, normal: normal.into() });
        }
    }
    for place in (1..scene.particles.len()).rev() {
        scene.particles.swap(place, dice.below(place + 1));
    }
    let all = scene.particles.len();
    for _ in 0..dice.below(4).min(all.saturating_sub(1)) {
        let (first, second) = (dice.below(all), dice.below(all));
        let far = scene.particles[first].position - scene.particles[second].position;
        let known = scene
            .edges
            .iter()
            .any(|edge| (edge.first, edge.second) == (first, second) || (edge.second, edge.first) == (first, second));
        if first != second && !known && far.dot(&far) < 100.0 {
            scene.edges.push(Edge { first, second, radius: dice.one(&[0.25, 0.5]) });
        }
    }
    if dice.below(3) == 0 {
        scene.forces.push(Force::SimpleGravity { acceleration: Vec2::new(0.0, -2.0) });
    }
    scene
}

/// Whether no bodies lie in one another at the start, and all is of a sensible size.
fn is_tidy(scene: &Scene) -> bool {
    let apart = |one: &Particle, other: &Particle| {
        let far = other.position - one.position;
        far.dot(&far) >= (one.radius + other.radius) * (one.radius + other.radius)
    };
    let particles = &scene.particles;
    let no_overlaps = (0..particles.len()).all(|one| (0..one).all(|other| apart(&particles[one], &particles[other])));
    let off_planes = particles.iter().all(|one| {
        scene.half_planes.iter().all(|plane| {
            let far = (one.position - plane.point).dot(&plane.normal);
            far * far >= one.radius * one.radius * plane.normal.dot(&plane.normal)
        })
    });
    let off_edges = scene.edges.iter().all(|edge| {
        let [two, three] = [edge.first, edge.second].map(|end| particles[end].position);
        let along = three - two;
        particles.iter().enumerate().all(|(index, one)| {
            let alpha = ((one.position - two).dot(&along) / along.dot(&along)).clamp(0.0, 1.0);
            let far = one.position - two - alpha * along;
            let reach = one.radius + edge.radius;
            index == edge.first || index == edge.second || far.dot(&far) >= reach * reach
        })
    });
    no_overlaps && off_planes && off_edges
}

/// What a scene has of what is missing.
fn gain(scene: &Scene, missing: &[Pairing]) -> Vec<Pairing> {
    if scene.particles.is_empty() || !is_tidy(scene) {
        return Vec::new();
    }
    let Ok(coverage) = Coverage::of(scene) else { return Vec::new() };
    missing.iter().copied().filter(|one| coverage.has(*one)).collect()
}

/// Whether nothing hangs on round-off, and correct programs pass whatever the order of their operations.
fn is_fair(scene: &Scene) -> bool {
    let decided = borderline(scene).is_ok_and(|found| found.is_empty());
    let variants = CATALOGUE.iter().filter(|row| row.kind == RowKind::Variant);
    decided && variants.filter(|row| row.id != "scale-1e-6").all(|row| accepts(scene, Student::new(Some(row.mistake))))
}

fn accepts(scene: &Scene, student: Student) -> bool {
    let Ok(trace) = student::trace(scene, student) else { return false };
    let options = Options { threads: 1, fair: true, ..Options::default() };
    judge(scene, &trace[..], &options, &mut ()).fair.is_some_and(|fair| fair.verdict == FairVerdict::Accepted)
}

/// How long it takes to look at a scene, roughly.
fn work(scene: &Scene) -> f64 {
    let all = scene.particles.len();
    let pairs = all * (all + 2 * scene.edges.len() + scene.half_planes.len());
    f64::from(scene.steps()) * (20 + pairs) as f64
}

/// The scene without what it does not need for what it is kept for.
fn smaller(mut scene: Scene, kept: &[Pairing]) -> Scene {
    loop {
        let mut tries = Vec::new();
        for index in 0..scene.particles.len() {
            tries.extend(without(&scene, index));
        }
        for index in 0..scene.edges.len() {
            let mut other = scene.clone();
            other.edges.remove(index);
            tries.push(other);
        }
        for index in 0..scene.half_planes.len() {
            let mut other = scene.clone();
            other.half_planes.remove(index);
            tries.push(other);
        }
        if scene.steps() > 1 {
            tries.push(Scene { duration: scene.duration - scene.time_step, ..scene.clone() });
        }
        if !scene.forces.is_empty() {
            tries.push(Scene { forces: Vec::new(), ..scene.clone() });
        }
        match tries.into_iter().find(|other| gain(other, kept).len() == kept.len()) {
            Some(other) => scene = other,
            None => return scene,
        }
    }
}

/// The scene without a particle that no edge needs.
fn without(scene: &Scene, particle: usize) -> Option<Scene> {
    if scene.edges.iter().any(|edge| edge.first == particle || edge.second == particle) {
        return None;
    }
    let mut other = scene.clone();
    other.particles.remove(particle);
    let moved = |end: usize| if end > particle { end - 1 } else { end };
    for edge in &mut other.edges {
        (edge.first, edge.second) = (moved(edge.first), moved(edge.second));
    }
    Some(other)
}

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let suite = arguments.next().context("usage: scene-search SUITE SCENES [TRIES] [SEED] [FOLDER]")?;
    let wanted: usize = arguments.next().context("how many scenes?")?.parse()?;
    let tries: u64 = arguments.next().map_or(Ok(200_000), |text| text.parse())?;
    let seed: u64 = arguments.next().map_or(Ok(1), |text| text.parse())?;
    let folder: Option<PathBuf> = arguments.next().map(PathBuf::from);
    let mut coverage = Coverage::default();
    for task in plan::find(&suite)?.scenes() {
        coverage.add(&Coverage::of(&task.scene)?);
    }
    let mut missing: Vec<Pairing> = coverage.missing().collect();
    for number in 0..wanted as u64 {
        let of = |run: u64| draw(&mut Dice::of(seed + number, run));
        let mut found: Vec<(f64, u64)> = (0..tries)
            .into_par_iter()
            .filter_map(|run| {
                let scene = of(run);
                let gained = gain(&scene, &missing).len();
                (gained > 0).then(|| (gained as f64 / (300.0 + work(&scene)), run))
            })
            .collect();
        found.sort_by(|one, other| other.0.total_cmp(&one.0).then(one.1.cmp(&other.1)));
        let small = |run: u64| {
            let scene = of(run);
            let kept = gain(&scene, &missing);
            (smaller(scene, &kept), kept)
        };
        let best = found.iter().map(|(_, run)| small(*run)).find(|(scene, _)| is_fair(scene));
        let Some((scene, kept)) = best else { break };
        missing.retain(|one| !kept.contains(one));
        println!("scene {number}: {} pairs of properties, {} are missing yet", kept.len(), missing.len());
        match &folder {
            Some(folder) => std::fs::write(folder.join(format!("found-{number}.xml")), scene::write(&scene))?,
            None => println!("{}", scene::write(&scene)),
        }
    }
    for one in &missing {
        println!("missing: {}", one.words());
    }
    Ok(())
}
