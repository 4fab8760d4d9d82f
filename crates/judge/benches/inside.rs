//! What recording and judging take inside one process, on one thread: the least time of some rounds.
//!
//! `cargo bench -p fosssim-judge --bench inside -- [rounds] [what] SCENE...` prints a line per scene and the sum. `what` is
//! `all`, or one of `step` (without an observer), `record` (into nothing), `parity` and `fair` (the scene's own trace), `half`
//! and `third` (the same trace with every coefficient times 0.5 or divided by 3, by both books), `trace` (each scene is
//! followed by the file of a trace, judged by both books). One round of one of them under callgrind counts instructions,
//! which no other load on the machine changes.
use fosssim_judge::parity::{self, Options};
use fosssim_model::{
    scene::{Scene, original},
    sim::{RootSearch, Simulation},
    trace::{Frame, Layout, Reader, Recorder, Writer},
};
use std::{hint::black_box, time::Instant};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let [rounds, what, files @ ..] = &arguments[..] else { return };
    let rounds: u32 = rounds.parse().expect("a number of rounds");
    let mut sums: Vec<(&str, f64)> = Vec::new();
    let mut files = files.iter();
    while let Some(name) = files.next() {
        let xml = std::fs::read(name).expect("a scene");
        let scene = original::read(&xml).expect("a scene").scene;
        let given = (what == "trace").then(|| std::fs::read(files.next().expect("a trace")).expect("a trace"));
        let mut line = String::new();
        for (title, time) in measure(&scene, rounds, what, given) {
            line += &format!(" {title} {time:8.3}");
            match sums.iter_mut().find(|(known, _)| *known == title) {
                Some((_, sum)) => *sum += time,
                None => sums.push((title, time)),
            }
        }
        println!("{line}  {name}");
    }
    let total: String = sums.iter().map(|(title, sum)| format!(" {title} {sum:8.3}")).collect();
    println!("{total}  all, in ms");
}

fn measure(scene: &Scene, rounds: u32, what: &str, given: Option<Vec<u8>>) -> Vec<(&'static str, f64)> {
    let is_wanted = |title: &str| what == "all" || what == title;
    let own =
        if given.is_none() && !["step", "record"].contains(&what) { record(scene, Vec::new()) } else { Vec::new() };
    let mut times = Vec::new();
    if is_wanted("step") {
        times.push(("step", least(rounds, || step(scene))));
    }
    if is_wanted("record") {
        times.push(("record", least(rounds, || _ = record(scene, std::io::sink()))));
    }
    for (title, fair) in [("parity", false), ("fair", true)] {
        if is_wanted(title) {
            times.push((title, least(rounds, || judge(scene, &own, fair))));
        }
    }
    for (title, by_both, factor) in [("half", "half fair", 0.5), ("third", "third fair", 1.0 / 3.0)] {
        if is_wanted(title) {
            let scaled = scaled(scene, &own, factor);
            times.push((title, least(rounds, || judge(scene, &scaled, false))));
            times.push((by_both, least(rounds, || judge(scene, &scaled, true))));
        }
    }
    if let Some(trace) = given {
        times.push(("parity", least(rounds, || judge(scene, &trace, false))));
        times.push(("fair", least(rounds, || judge(scene, &trace, true))));
    }
    times
}

/// The least time of some rounds, in milliseconds. One thread works and waits for nothing, so this is processor time.
fn least(rounds: u32, mut work: impl FnMut()) -> f64 {
    let round = |_| {
        let begin = Instant::now();
        work();
        begin.elapsed().as_secs_f64() * 1e3
    };
    (0..rounds).map(round).fold(f64::INFINITY, f64::min)
}

fn step(scene: &Scene) {
    let mut simulation = Simulation::new(scene, RootSearch::WhereNeeded);
    for _ in 0..scene.steps() {
        simulation.step(&mut ()).expect("a step");
    }
    black_box(simulation.state());
}

fn record<W: std::io::Write>(scene: &Scene, target: W) -> W {
    let mut simulation = Simulation::new(scene, RootSearch::WhereNeeded);
    let mut recorder = Recorder::start(target, Layout::of(scene), simulation.state());
    for _ in 0..scene.steps() {
        simulation.step(&mut recorder).expect("a step");
    }
    recorder.finish().expect("written").0
}

fn judge(scene: &Scene, trace: &[u8], fair: bool) {
    let options = Options { threads: 1, fair, ..Options::default() };
    black_box(parity::judge(scene, trace, &options, &mut ()));
}

/// The same trace with other coefficients.
fn scaled(scene: &Scene, trace: &[u8], factor: f64) -> Vec<u8> {
    let layout = Layout::of(scene);
    let (mut reader, mut writer) = (Reader::of_slice(trace, layout), Writer::new(Vec::new(), layout));
    let mut frame = Frame::default();
    while reader.next(&mut frame).expect("a sound trace") {
        frame.polynomials.coefficients.iter_mut().for_each(|coefficient| *coefficient *= factor);
        writer.frame(&frame);
    }
    writer.finish().expect("memory").0
}
