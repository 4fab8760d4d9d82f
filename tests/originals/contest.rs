//! Random scenes of the contest: the original records and grades them exactly as this project does.
use fosssim_oracle::{assignments::Assignment::T2M3, scene::original};
use rayon::prelude::*;
use std::fmt::Write;

use crate::{
    oracle::Originals,
    workspace::{Run, Workspace, simulate},
};

const SCENES: u64 = 500;

/// A generator of random numbers (SplitMix64).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, count: u64) -> u64 {
        self.next() % count
    }

    fn is(&mut self, of: u64) -> bool {
        self.below(of) == 0
    }

    /// Returns a number between -1 and 1.
    fn real(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Returns a scene with clouds, grids, columns, ribbons or long edges. Many bodies begin at the same place.
fn scene(seed: u64) -> String {
    let mut numbers = Numbers(seed);
    let largest = [4, 16, 40, 120, 400][numbers.below(5) as usize];
    let count = 1 + numbers.below(largest);
    let integrators: &[&str] = &["explicit-euler", "forward-backward-euler", "linearized-implicit-euler"];
    let integrator = integrators[numbers.below(if count < 30 { 3 } else { 2 }) as usize];
    let thickness = if numbers.is(2) { 0.0 } else { 0.1 * numbers.real().abs() };
    let (steps, time_step) = (2 + numbers.below(6), [0.01, 0.125][numbers.below(2) as usize]);
    let mut text = format!(
        "<scene><duration time=\"{}\"/><integrator type=\"{integrator}\" dt=\"{time_step}\"/>\
         <collision type=\"penalty\" k=\"{}\" thickness=\"{thickness}\"/><collisiondetection type=\"contest\"/>",
        time_step * (steps as f64 - 0.5),
        1 + numbers.below(200)
    );
    let (shape, one_size, still) = (numbers.below(6), numbers.is(2), numbers.is(3));
    let wide = (count as f64).sqrt().ceil() as u64;
    let mut place = [0.0, 0.0];
    for index in 0..count {
        let (column, row) = ((index % wide) as f64, (index / wide) as f64);
        place = match shape {
            0 => [numbers.real() * wide as f64 * 0.25, numbers.real() * wide as f64 * 0.25],
            // Neighbors in the grid overlap, touch, or are apart by round-off.
            1 => [0.25 * column, 0.25 * row],
            2 => [0.2 * column, 0.2 * row],
            3 => [0.5 * (index % 3) as f64, 0.125 * index as f64],
            4 if index > 0 && numbers.is(3) => place,
            4 => [numbers.real(), numbers.real()],
            _ => [0.1 * index as f64, if numbers.is(2) { 0.0 } else { 0.05 * numbers.real() }],
        };
        let mut speed = || if still { 0.0 } else { numbers.real() };
        let (vx, vy) = (speed(), speed());
        let radius = if one_size { 0.125 } else { 0.02 + 0.2 * numbers.real().abs() };
        let fixed = u8::from(numbers.is(8));
        let mass = [1.0, 0.1, 3.0][numbers.below(3) as usize];
        let [x, y] = place;
        write!(
            text,
            "<particle m=\"{mass}\" px=\"{x}\" py=\"{y}\" vx=\"{vx}\" vy=\"{vy}\" fixed=\"{fixed}\" \
             radius=\"{radius}\"/>"
        )
        .expect("memory");
    }
    // An edge without length gives NaN, and the original's searches then lose pairs.
    let edges =
        if count > 1 && shape != 4 { [0, 1, count / 50, count / 2, count - 1][numbers.below(5) as usize] } else { 0 };
    let is_chain = numbers.is(2);
    for index in 0..edges {
        let first = if is_chain { index } else { numbers.below(count) };
        let second = if is_chain { index + 1 } else { (first + 1 + numbers.below(count - 1)) % count };
        let radius = [0.05, 0.01 + 0.05 * numbers.real().abs()][numbers.below(2) as usize];
        write!(text, "<edge i=\"{first}\" j=\"{second}\" radius=\"{radius}\"/>").expect("memory");
        if numbers.is(4) {
            write!(text, "<springforce edge=\"{index}\" k=\"5\" l0=\"0.3\" b=\"0.1\"/>").expect("memory");
        }
    }
    for _ in 0..numbers.below(4) {
        let mut real = || numbers.real();
        let (px, py, nx, ny) = (real(), -real().abs(), real(), 0.1 + real().abs());
        write!(text, "<halfplane px=\"{px}\" py=\"{py}\" nx=\"{nx}\" ny=\"{ny}\"/>").expect("memory");
    }
    if numbers.is(2) {
        text += "<simplegravity fx=\"0\" fy=\"-9.8\"/>";
    }
    text + "</scene>"
}

/// Returns a submission: the recording, or a wrong copy of it.
fn submission(seed: u64, trace: &[u8]) -> Vec<u8> {
    let mut numbers = Numbers(!seed);
    let (mut own, doubles) = (trace.to_vec(), trace.len() as u64 / 8);
    let mut change = |numbers: &mut Numbers, change: &dyn Fn(f64) -> f64| {
        let at = 8 * numbers.below(doubles) as usize;
        let value = f64::from_le_bytes(own[at..at + 8].try_into().expect("eight bytes"));
        own[at..at + 8].copy_from_slice(&change(value).to_le_bytes());
    };
    match numbers.below(8) {
        0 => {}
        1 => change(&mut numbers, &|value| value + 5e-11),
        2 => change(&mut numbers, &|value| value + 1e-3),
        // This changes the last record, after which there is no search.
        3 => own.splice(trace.len() - 8.., f64::NAN.to_le_bytes()).for_each(drop),
        4 => change(&mut numbers, &|_| f64::INFINITY),
        5 => (0..doubles).for_each(|_| change(&mut numbers, &|value| value + 1e-9)),
        6 => own.truncate(numbers.below(trace.len() as u64) as usize),
        // The order of ties continues from states that no program has computed.
        _ => (0..20).for_each(|_| change(&mut numbers, &|value| (4.0 * value).round() / 4.0)),
    }
    own
}

/// Returns standard output without the times of steps.
pub fn timeless(run: &Run) -> String {
    let mut text = String::new();
    for line in run.out().lines() {
        let names = ["Preparation: ", "Collision detection: ", "Collision handling: ", "Frame run time: "];
        let end = names.iter().find_map(|name| Some(line.find(name)? + name.len()));
        writeln!(text, "{}", &line[..end.unwrap_or(line.len())]).expect("memory");
    }
    text
}

fn fault(originals: &Originals, seed: u64) -> Result<(), String> {
    let workspace = Workspace::new();
    let scene = scene(seed);
    workspace.write("scene.xml", &scene);
    let folder = workspace.path("");
    let own = simulate(&original::read(scene.as_bytes()).expect("a scene").scene);
    let run = originals.run(T2M3, &folder, ["-s", "scene.xml", "-d", "0", "-o", "trace.bin"]);
    if !workspace.exists("trace.bin") {
        return Err(run.shown());
    }
    let trace = workspace.read("trace.bin");
    if own != trace {
        let first = own.iter().zip(&trace).position(|(own, other)| own != other);
        return Err(format!("other bytes: {} and {}, from {first:?}", own.len(), trace.len()));
    }
    workspace.write("trace.bin", submission(seed, &trace));
    let grade = ["-s", "scene.xml", "-d", "0", "-i", "trace.bin"];
    let graded = |run: Run| {
        let residuals = workspace.exists("residual.txt").then(|| workspace.read("residual.txt"));
        drop(std::fs::remove_file(workspace.path("residual.txt")));
        (timeless(&run), residuals.map(|bytes| String::from_utf8_lossy(&bytes).into_owned()))
    };
    let [theirs, ours] = [graded(originals.run(T2M3, &folder, grade)), graded(workspace.original(grade))];
    let line = theirs.0.lines().zip(ours.0.lines()).find(|(theirs, ours)| theirs != ours);
    let lengths = [&theirs, &ours].map(|run| run.0.len());
    if theirs == ours { Ok(()) } else { Err(format!("{line:?} {lengths:?} {:?} {:?}", theirs.1, ours.1)) }
}

#[test]
fn random_scenes_are_recorded_and_graded_as_the_original_does() {
    let Some(originals) = Originals::find() else { return };
    let faults: Vec<String> = (0..SCENES)
        .into_par_iter()
        .filter_map(|seed| Some(format!("{seed}: {}", fault(&originals, seed).err()?)))
        .collect();
    let shown = faults.iter().take(20).map(String::as_str).collect::<Vec<_>>().join("\n");
    assert!(faults.is_empty(), "{} of {SCENES} scenes differ:\n{shown}", faults.len());
}
