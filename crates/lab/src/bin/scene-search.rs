//! Searches small scenes that contain what the scenes of a suite lack (`suite check --missing`), and that refuse wrong
//! programs which fewer than three of them refuse (`sight-matrix`).
//!
//!     scene-search SUITE SCENES [TRIES] [SEED] [FOLDER]
//!
//! Random scenes of few bodies are simulated by the reference; each round keeps the one with the most missing pairs of
//! properties and wrong programs for its work, and takes away whatever it does not need for them. Numbers are small
//! dyadic fractions, so that contacts fall exactly on the start and the end of steps. Scenes with decisions that hang
//! on round-off, and those that correct variants fail, are not kept. What is found is printed, or written into the
//! folder; names and descriptions are for people to give.
#![forbid(unsafe_code)]
use anyhow::Context;
use fosssim_lab::{
    dice::Dice,
    runs::{Watched, frames, is_accepted, judged},
    sight::{WrongProgram, witnesses, wrong_programs},
};
use fosssim_oracle::{
    judge::{Overall, fair::borderline},
    num::vector::Vec2,
    scene::{self, Collision, Display, Edge, Force, HalfPlane, Integrator, Particle, Scene},
    student::{self, CATALOGUE, Row, RowKind, Student},
    suite::coverage::{Coverage, Pairing},
};
use rayon::prelude::*;
use std::path::PathBuf;

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
            scene.edges.push(Edge { first, second, radius: dice.one(&[0.25, 0.5, 0.75]) });
        }
    }
    match dice.below(6) {
        0 => scene.forces.push(Force::SimpleGravity { acceleration: Vec2::new(0.0, -2.0) }),
        1 => scene.forces.push(Force::Drag { coefficient: 0.5 }),
        2 => scene.forces.push(Force::Constant { force: Vec2::new(2.0, -1.0) }),
        _ => {}
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

/// The properties that the scenes lack.
#[derive(Clone, Default)]
struct WantedEvents {
    pairings: Vec<Pairing>,
    /// Wrong programs, by their numbers, and how many more scenes have to refuse each.
    programs: Vec<(usize, usize)>,
}

impl WantedEvents {
    /// The wanted properties that a scene has; without the programs where only `pairings` are asked for.
    fn of(&self, scene: &Scene, programs: &[WrongProgram]) -> Self {
        let Some(pairings) = gain(scene, &self.pairings) else { return Self::default() };
        let watched = Watched::new(String::new(), scene.clone());
        let refused = self.programs.iter().filter(|(number, _)| watched.refuses(programs[*number].student));
        Self { pairings, programs: refused.copied().collect() }
    }

    fn worth(&self) -> f64 {
        self.pairings.len() as f64 + PROGRAM * self.programs.len() as f64
    }
}

/// The worth of a wrong program, in pairs of properties.
const PROGRAM: f64 = 6.0;

/// The number of scenes of a round on which wrong programs run: those with the most pairs of properties, and as many
/// others.
const SHOWN: usize = 500;

/// The missing pairs of properties that a scene has; nothing of one that is of no use.
fn gain(scene: &Scene, missing: &[Pairing]) -> Option<Vec<Pairing>> {
    if scene.particles.is_empty() || !is_tidy(scene) {
        return None;
    }
    let coverage = Coverage::of(scene).ok()?;
    Some(missing.iter().copied().filter(|one| coverage.has(*one)).collect())
}

/// Variants whose own roundings decide whether something touches exactly at a step's end (`tests/it/samples.rs`).
const ROUNDING: [&str; 3] = ["normalised-norm", "through-bernstein", "frame-rotated"];

/// Whether nothing hangs on round-off: correct programs move everything alike, whatever the order of their operations,
/// and are accepted; the reference's own trace by the original's rules, too.
fn is_fair(scene: &Scene) -> bool {
    let right = student::trace(scene, Student::default());
    let (Ok(right), true) = (right, borderline(scene).is_ok_and(|found| found.is_empty())) else { return false };
    let states = ends(scene, &right);
    let passes = judged(scene, &right).parity.overall == Overall::Passed;
    let is_alike = |row: &Row| {
        let Ok(trace) = student::trace(scene, Student::new(Some(row.mistake))) else { return false };
        let ends = ends(scene, &trace);
        let close =
            ends.len() == states.len() && ends.iter().zip(&states).all(|(one, other)| (one - other).abs() < 1e-9);
        is_accepted(&judged(scene, &trace)) && (close || ROUNDING.contains(&row.id))
    };
    let mut variants = CATALOGUE.iter().filter(|row| row.kind == RowKind::Variant && row.id != "scale-1e-6");
    passes && states.iter().all(|number| number.abs() < 1e3) && variants.all(is_alike)
}

/// Positions and velocities of all records of a trace.
fn ends(scene: &Scene, trace: &[u8]) -> Vec<f64> {
    frames(scene, trace)
        .into_iter()
        .flat_map(|frame| [frame.state.positions, frame.state.velocities].concat())
        .collect()
}

/// How long it takes to look at a scene, roughly.
fn work(scene: &Scene) -> f64 {
    let all = scene.particles.len();
    let pairs = all * (all + 2 * scene.edges.len() + scene.half_planes.len());
    f64::from(scene.steps()) * (20 + pairs) as f64
}

/// The scene without what it does not need for what it is kept for.
fn smaller(mut scene: Scene, kept: &WantedEvents, programs: &[WrongProgram]) -> Scene {
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
        let keeps = |other: &Scene| {
            let has = kept.of(other, programs);
            has.pairings.len() == kept.pairings.len() && has.programs.len() == kept.programs.len()
        };
        match tries.into_iter().find(keeps) {
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
    let scenes: usize = arguments.next().context("how many scenes?")?.parse()?;
    let tries: u64 = arguments.next().map_or(Ok(200_000), |text| text.parse())?;
    let seed: u64 = arguments.next().map_or(Ok(1), |text| text.parse())?;
    let folder: Option<PathBuf> = arguments.next().map(PathBuf::from);
    let (watched, mut coverage) = (Watched::of_suite(&suite)?, Coverage::default());
    for watched in &watched {
        coverage.add(&Coverage::of(&watched.scene)?);
    }
    let programs = wrong_programs();
    let lacking = |number: usize| {
        let refusing = witnesses(&watched, programs[number].student, WITNESSES).len();
        (refusing < WITNESSES).then_some((number, WITNESSES - refusing))
    };
    let lacking = (0..programs.len()).into_par_iter().filter_map(lacking).collect();
    let mut wanted = WantedEvents { pairings: coverage.missing().collect(), programs: lacking };
    for number in 0..scenes as u64 {
        let Some((scene, kept)) = round(&wanted, &programs, tries, seed + number) else { break };
        wanted.pairings.retain(|one| !kept.pairings.contains(one));
        for (program, left) in &mut wanted.programs {
            *left -= usize::from(kept.programs.iter().any(|(other, _)| other == program));
        }
        wanted.programs.retain(|(_, left)| *left > 0);
        let names: Vec<&str> = kept.programs.iter().map(|(program, _)| programs[*program].name.as_str()).collect();
        println!(
            "scene {number}: {} pairs of properties, {} are missing yet; {} wrong programs, {} are seen too little: {}",
            kept.pairings.len(),
            wanted.pairings.len(),
            names.len(),
            wanted.programs.len(),
            names.join(", ")
        );
        let gained: Vec<String> = kept.pairings.iter().map(|one| format!("  {}\n", one.words())).collect();
        print!("{}", gained.concat());
        match &folder {
            Some(folder) => std::fs::write(folder.join(format!("found-{number}.xml")), scene::write(&scene))?,
            None => println!("{}", scene::write(&scene)),
        }
    }
    for one in &wanted.pairings {
        println!("missing: {}", one.words());
    }
    for (program, left) in &wanted.programs {
        println!("seen too little: {} ({left})", programs[*program].name);
    }
    Ok(())
}

/// The number of scenes that have to refuse each wrong program.
const WITNESSES: usize = 3;

/// The best of many random scenes, made small, with what it has of what is wanted.
fn round(wanted: &WantedEvents, programs: &[WrongProgram], tries: u64, seed: u64) -> Option<(Scene, WantedEvents)> {
    let of = |run: u64| draw(&mut Dice::of(seed, run));
    let mut found: Vec<(f64, u64)> = (0..tries)
        .into_par_iter()
        .map(|run| {
            let scene = of(run);
            (gain(&scene, &wanted.pairings).map_or(0, |has| has.len()) as f64 / (300.0 + work(&scene)), run)
        })
        .collect();
    let by_worth = |one: &(f64, u64), other: &(f64, u64)| other.0.total_cmp(&one.0).then(one.1.cmp(&other.1));
    found.sort_by(by_worth);
    let (best, others) = found.split_at(SHOWN.min(found.len()));
    let shown: Vec<u64> =
        best.iter().chain(others.iter().filter(|(_, run)| run % 16 == 0).take(SHOWN)).map(|one| one.1).collect();
    let mut worth: Vec<(f64, u64, WantedEvents)> = shown
        .into_par_iter()
        .map(|run| {
            let scene = of(run);
            let has = wanted.of(&scene, programs);
            (has.worth() / (300.0 + work(&scene)), run, has)
        })
        .filter(|(worth, ..)| *worth > 0.0)
        .collect();
    worth.sort_by(|one, other| by_worth(&(one.0, one.1), &(other.0, other.1)));
    let small = |(_, run, has): &(f64, u64, WantedEvents)| (smaller(of(*run), has, programs), has.clone());
    worth.iter().map(small).find(|(scene, _)| is_fair(scene))
}
