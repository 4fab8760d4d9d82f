//! Correct programs with other arithmetic, on scenes whose traces contain states: the fair rules accept them with a
//! large margin, and reject noise. `--nocapture` prints the shares of the tolerances that they use. With
//! `FOSSSIM_CORPUS`, the course's own scenes are tried as well.
#![forbid(unsafe_code)]

mod right;

use fosssim_lab::runs::{is_accepted, judge_trace};
use fosssim_oracle::{
    assignments::{Assignment, ImpulseList},
    judge::fair::FairVerdict,
    num::vector::vector_at,
    scene::{self, Scene, original},
    sim::{RootSearch, Simulation},
    student::{Contact, State},
    suite::library,
};
use rayon::prelude::*;
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// The sizes of noise that is added to numbers of correct traces.
const NOISE_SIZES: [f64; 6] = [1e-15, 1e-14, 1e-13, 1e-12, 1e-10, 1e-8];

/// The number of correct traces of each scene to which noise is added.
const NOISY_TRACES_PER_SCENE: u64 = 8;

/// The results on the scenes of one milestone.
#[derive(Debug, Clone, Copy, Default)]
struct MilestoneTally {
    scenes: u32,
    programs: u32,
    accepted: u32,
    borderline: u64,
    /// The largest share of a tolerance.
    position: f64,
    velocity: f64,
    /// The smallest power of two by which a step's difference from the reference can be multiplied so that the step is
    /// wrong.
    room: Option<u32>,
    /// The number of traces with each noise, and the number of rejected ones.
    noisy: u64,
    refused: [u64; NOISE_SIZES.len()],
}

/// The factor by which a correct program's differences from the reference may grow in every step without becoming
/// wrong.
const MIN_ROOM: u32 = 32;

/// The index in [`NOISE_SIZES`] from which all noise is rejected.
const FIRST_REJECTED_NOISE: usize = 4;

#[test]
fn right_programs_have_room_and_noise_is_rejected() {
    let corpus = std::env::var_os("FOSSSIM_CORPUS").map(PathBuf::from);
    let results: Vec<(String, MilestoneTally, Vec<String>)> =
        scenes(corpus.as_deref()).par_iter().map(|(name, scene)| try_scene(name, scene)).collect();
    let mut rows: BTreeMap<String, MilestoneTally> = BTreeMap::new();
    let mut faults = Vec::new();
    for (milestone, tally, refused) in results {
        rows.entry(milestone).or_default().add(&tally);
        faults.extend(refused);
    }
    print(&rows);
    assert!(faults.is_empty(), "{faults:#?}");
    for (milestone, row) in rows {
        assert!(row.programs > 0 && row.room.is_some_and(|room| room > MIN_ROOM), "{milestone}: {row:?}");
        assert!(
            row.refused[FIRST_REJECTED_NOISE..].iter().all(|refused| *refused == row.noisy),
            "{milestone}: {row:?}"
        );
    }
}

/// Prints the table of docs/rules/states.md.
fn print(rows: &BTreeMap<String, MilestoneTally>) {
    println!("milestone  scenes  programs  accepted  borderline  rejected if times  largest share: position  velocity");
    for (milestone, row) in rows {
        println!(
            "{milestone:9}  {:6}  {:8}  {:8}  {:10}  {:>18}  {:23.1} %  {:6.1} %",
            row.scenes,
            row.programs,
            row.accepted,
            row.borderline,
            row.room.map_or("-".to_owned(), |room| room.to_string()),
            100.0 * row.position,
            100.0 * row.velocity
        );
    }
    println!("milestone  traces with noise on three numbers, rejected of these with {NOISE_SIZES:?}");
    for (milestone, row) in rows {
        println!("{milestone:9}  {:6}  {:?}", row.noisy, row.refused);
    }
}

impl MilestoneTally {
    fn add(&mut self, other: &Self) {
        self.scenes += other.scenes;
        self.programs += other.programs;
        self.accepted += other.accepted;
        self.borderline += other.borderline;
        self.position = self.position.max(other.position);
        self.velocity = self.velocity.max(other.velocity);
        self.room = [self.room, other.room].into_iter().flatten().min();
        self.noisy += other.noisy;
        self.refused.iter_mut().zip(other.refused).for_each(|(own, other)| *own += other);
    }
}

/// Returns the milestone, its results on a scene, and the rejected correct programs.
fn try_scene(name: &str, scene: &Scene) -> (String, MilestoneTally, Vec<String>) {
    let mut tally = MilestoneTally { scenes: 1, ..MilestoneTally::default() };
    let mut faults = Vec::new();
    let milestone = name.split('/').next().unwrap_or_default().to_owned();
    for (number, arithmetic) in right::ALL.iter().enumerate() {
        // Programs whose step has no result are not right.
        let mut single = SingleSteps::new(scene);
        let Ok(trace) = arithmetic.trace(scene, |state, contacts| single.visit(state, contacts)) else { continue };
        tally.room = [tally.room, single.room].into_iter().flatten().min();
        let outcome = judge_trace(scene, &trace);
        let is_accepted = is_accepted(&outcome);
        let Some(fair) = outcome.fair else { continue };
        tally.programs += 1;
        tally.borderline += fair.borderline;
        if is_accepted {
            tally.accepted += 1;
            tally.position = tally.position.max(fair.shares.position);
            tally.velocity = tally.velocity.max(fair.shares.velocity);
        } else {
            let first = fair.findings.first_divergence;
            faults.push(format!("{name}, {}: {first:?}", arithmetic.name));
        }
        if number == 0 {
            add_noise(name, scene, &trace, &mut tally);
        }
    }
    (milestone, tally, faults)
}

/// Judges single steps of a correct program with enlarged differences from the reference.
struct SingleSteps<'a> {
    scene: &'a Scene,
    /// The scene with a single step.
    one: Scene,
    before: State,
    steps: u32,
    room: Option<u32>,
}

impl<'a> SingleSteps<'a> {
    /// The maximum number of steps of a scene that are tried.
    const MAX_STEPS: u32 = 24;

    fn new(scene: &'a Scene) -> Self {
        let one = Scene { duration: scene.time_step, ..scene.clone() };
        Self { scene, one, before: right::start(scene), steps: 0, room: None }
    }

    fn visit(&mut self, after: &State, contacts: &[Contact]) {
        let before = std::mem::replace(&mut self.before, after.clone());
        self.steps += 1;
        let is_tried = self.steps.is_multiple_of(self.scene.step_count().div_ceil(Self::MAX_STEPS).max(1));
        if !is_tried || self.scene.particles.len() > 200 {
            return;
        }
        for (index, particle) in self.one.particles.iter_mut().enumerate() {
            (particle.position, particle.velocity) = (vector_at(&before.x, index), vector_at(&before.v, index));
        }
        let mut simulation = Simulation::new(&self.one, RootSearch::OnDemand);
        if simulation.step(&mut ()).is_err() {
            return;
        }
        let own = simulation.state();
        let mut factor = 2;
        while factor <= 1 << 20 && self.room.is_none_or(|room| factor < room) {
            let farther = |own: &[f64], other: &[f64]| {
                own.iter().zip(other).map(|(own, other)| own + f64::from(factor) * (other - own)).collect()
            };
            let state = State { x: farther(&own.positions, &after.x), v: farther(&own.velocities, &after.v) };
            let mut trace = Vec::new();
            right::record(&self.one, &before, &[], &mut trace);
            right::record(&self.one, &state, contacts, &mut trace);
            if !is_accepted(&judge_trace(&self.one, &trace)) {
                self.room = Some(factor);
            }
            factor *= 2;
        }
    }
}

fn add_noise(name: &str, scene: &Scene, trace: &[u8], tally: &mut MilestoneTally) {
    // Other records have integers between their numbers.
    if !matches!(scene.collision.handling().records.impulses, ImpulseList::Absent) {
        return;
    }
    let mut random = name.bytes().fold(0x9e37_79b9_7f4a_7c15_u64, |seed, byte| seed.rotate_left(7) ^ u64::from(byte));
    for _ in 0..NOISY_TRACES_PER_SCENE {
        let places: [usize; 3] = std::array::from_fn(|_| {
            // Xorshift (Marsaglia, J. Stat. Softw. 8(14), 2003).
            random ^= random << 13;
            random ^= random >> 7;
            random ^= random << 17;
            usize::try_from(random % (trace.len() as u64 / 8)).unwrap_or(0) * 8
        });
        tally.noisy += 1;
        for (noise, refused) in NOISE_SIZES.iter().zip(&mut tally.refused) {
            let mut damaged = trace.to_vec();
            for place in places {
                let number = &mut damaged[place..place + 8];
                let value = f64::from_le_bytes(number.try_into().unwrap_or_default());
                number.copy_from_slice(&(value + noise).to_le_bytes());
            }
            *refused += u64::from(!is_accepted(&judge_trace(scene, &damaged)));
        }
    }
}

fn scenes(corpus: Option<&Path>) -> Vec<(String, Scene)> {
    let own = library::scene_names().filter_map(|name| {
        let milestone = library::find_assignment(name).filter(|assignment| *assignment != Assignment::T2M2)?;
        Some((format!("{}/{name}", milestone.key()), library::find_scene(name)?.to_vec()))
    });
    let mut all: Vec<(String, Vec<u8>)> = own.collect();
    for folder in ["scenes/t1m1", "scenes/t1m2", "scenes/t1m3", "scenes/t2m1", "t2m3"] {
        let Some(corpus) = corpus else { continue };
        for path in scene_files(&corpus.join(folder)) {
            let name = path.strip_prefix(corpus).unwrap_or(&path).display().to_string();
            let name = name.strip_prefix("scenes/").unwrap_or(&name).to_owned();
            all.extend(std::fs::read(&path).ok().map(|bytes| (format!("corpus-{name}"), bytes)));
        }
    }
    all.into_iter().filter_map(|(name, bytes)| Some((name, original::read(&bytes).ok()?.scene))).collect()
}

/// Returns all scenes below a folder.
fn scene_files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for path in std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            found.extend(scene_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "xml") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Returns a scene of linearized implicit steps whose bodies have these masses.
fn springs(masses: [f64; 3]) -> Scene {
    let [a, b, c] = masses;
    let text = format!(
        r#"<scene><duration time="1"/><integrator type="linearized-implicit-euler" dt="0.01"/>
        <particle m="{a}" px="0" py="0" vx="0" vy="0.1" fixed="0" radius="0.1"/>
        <particle m="{b}" px="1" py="0.1" vx="0.3" vy="-6.3" fixed="0" radius="0.1"/>
        <particle m="{c}" px="2" py="-0.2" vx="0.1" vy="0" fixed="0" radius="0.1"/>
        <edge i="0" j="1" radius="0.01"/><edge i="1" j="2" radius="0.01"/>
        <springforce edge="0" k="900" l0="0.9"/><springforce edge="1" k="3" l0="1.2"/>
        <gravitationalforce i="0" j="2" G="0.0001"/></scene>"#
    );
    scene::read("scene", text.as_bytes()).expect("a scene").scene
}

/// Returns the verdict of the fair rules on the trace that a program writes.
fn verdict(scene: &Scene, arithmetic: right::Arithmetic) -> FairVerdict {
    let trace = arithmetic.trace(scene, |_, _| ()).unwrap_or_else(|_| panic!("{} ends early", arithmetic.name));
    judge_trace(scene, &trace).fair.expect("the fair rules were asked").verdict
}

#[test]
fn whatever_solves_the_system_of_an_implicit_step_is_right() {
    // If masses differ, the error of some solvers is small compared with the largest entry, but not with those of each
    // row.
    let mut scenes = vec![springs([1e7, 1.0, 4.0]), springs([1e6, 1.0, 1e2])];
    let of_milestone = library::scene_names().filter(|name| library::find_assignment(name) == Some(Assignment::T1M3));
    scenes.extend(
        of_milestone
            .map(|name| scene::read(name, library::find_scene(name).expect("its text")).expect("a scene").scene),
    );
    assert!(scenes.len() > 5);
    for (number, scene) in scenes.iter().enumerate() {
        for arithmetic in right::ALL {
            let verdict = verdict(scene, arithmetic);
            assert_eq!(verdict, FairVerdict::Accepted, "scene {number}, {}", arithmetic.name);
        }
    }
}
