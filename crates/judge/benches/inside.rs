//! The cost of recording and judging inside one process, on one thread: the minimum time of several rounds.
//!
//! `cargo bench -p fosssim-judge --bench inside -- [rounds] [what] SCENE...` prints a line per scene and the sum.
//! `what` is `all`, or one of `step` (without an observer), `record` (into nothing), `parity` and `fair` (the scene's
//! own trace), `half` and `third` (the same trace with every coefficient times 0.5 or divided by 3, by both books),
//! `rounded` (with an additional rounding error in every third coefficient), `trace` (each scene is followed by the
//! file of a trace, judged by both books).
//!
//! `... --bench inside -- instructions` counts instructions under callgrind, and compares them with the counts in
//! `instructions.txt`. No other load on the machine changes these counts. With `store` they are written to the file.
//!
//! `... -- growth` shows the cost of a pair and the memory from 10 to 3,000 particles. `... -- crowd` shows the
//! instructions of a ball and step of a penalty scene from 100 to 100,000 balls. `... -- hits` shows the instructions
//! of scenes with many hits in a step of `continuous-time`.
#![forbid(unsafe_code)]
use fosssim_judge::replay::{self, Options};
use fosssim_model::{
    scene::{Scene, original},
    sim::{RootSearch, Simulation},
    trace::{Frame, Layout, Reader, Recorder, Writer},
};
use std::{fmt::Write as _, hint::black_box, process::Command, time::Instant};

/// The built-in scenes whose instructions are counted.
const COUNTED: [&str; 3] = [
    "HolisticTests/crowd-of-twenty-balls",
    "ContinuousTimeTests/spinning-edge-sweeps-balls",
    "GeometricTests/rows-collected-over-many-rounds",
];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["instructions"] => return instructions(false),
        ["instructions", "store"] => return instructions(true),
        ["growth"] => return growth(),
        ["crowd"] => return crowd(),
        ["hits"] => return hits(),
        _ => {}
    }
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
    if is_wanted("rounded") {
        let rounded = rounded(scene, &own);
        times.push(("rounded fair", least(rounds, || judge(scene, &rounded, true))));
    }
    if let Some(trace) = given {
        times.push(("parity", least(rounds, || judge(scene, &trace, false))));
        times.push(("fair", least(rounds, || judge(scene, &trace, true))));
    }
    times
}

/// Returns the minimum time of several rounds, in milliseconds. The single thread never waits, so this is processor
/// time.
fn least(rounds: u32, mut work: impl FnMut()) -> f64 {
    let round = |_| {
        let begin = Instant::now();
        work();
        begin.elapsed().as_secs_f64() * 1e3
    };
    (0..rounds).map(round).fold(f64::INFINITY, f64::min)
}

fn step(scene: &Scene) {
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    for _ in 0..scene.step_count() {
        simulation.step(&mut ()).expect("a step");
    }
    black_box(simulation.state());
}

fn record<W: std::io::Write>(scene: &Scene, target: W) -> W {
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    let mut recorder = Recorder::start(target, Layout::for_scene(scene), simulation.state());
    for _ in 0..scene.step_count() {
        simulation.step(&mut recorder).expect("a step");
    }
    recorder.finish().expect("written").0
}

fn judge(scene: &Scene, trace: &[u8], fair: bool) {
    let options = Options { threads: 1, uses_fair_rules: fair, ..Options::default() };
    black_box(replay::judge(scene, trace, &options, &mut ()));
}

/// Returns the trace with every coefficient multiplied by a factor.
fn scaled(scene: &Scene, trace: &[u8], factor: f64) -> Vec<u8> {
    with(scene, trace, |coefficient, _| factor * coefficient)
}

/// Returns the trace with an additional rounding error in every third coefficient.
fn rounded(scene: &Scene, trace: &[u8]) -> Vec<u8> {
    with(
        scene,
        trace,
        |coefficient, number| {
            if number.is_multiple_of(3) { coefficient * (1.0 + f64::EPSILON) } else { coefficient }
        },
    )
}

/// Returns the trace with new coefficients, computed from each coefficient and its index in the record.
fn with(scene: &Scene, trace: &[u8], coefficient: impl Fn(f64, usize) -> f64) -> Vec<u8> {
    let layout = Layout::for_scene(scene);
    let (mut reader, mut writer) = (Reader::from_slice(trace, layout), Writer::new(Vec::new(), layout));
    let mut frame = Frame::default();
    while reader.next(&mut frame).expect("a sound trace") {
        for (number, place) in frame.polynomials.coefficients.iter_mut().enumerate() {
            *place = coefficient(*place, number);
        }
        writer.write_frame(&frame);
    }
    writer.finish().expect("memory").0
}

/// Prints the number of instructions of each task, compared with the stored count. With `store`, replaces the stored
/// counts.
fn instructions(store: bool) {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/t2m2");
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.txt");
    let stored = std::fs::read_to_string(file).unwrap_or_default();
    let mut text = String::new();
    println!("| work | instructions | stored | ratio |\n|---|---:|---:|---:|");
    for scene in COUNTED {
        for what in ["step", "record", "parity", "fair", "half", "rounded"] {
            let count = counted(what, &format!("{folder}/{scene}.xml"));
            let name = format!("{what} {scene}");
            _ = writeln!(text, "{name} {count}");
            let before = stored.lines().find_map(|line| line.strip_prefix(&name)?.trim().parse::<f64>().ok());
            match before {
                Some(before) => println!("| {name} | {count} | {before} | {:.3} |", count / before),
                None => println!("| {name} | {count} | - | - |"),
            }
        }
    }
    if store {
        std::fs::write(file, text).expect("written");
    }
}

/// Returns the number of instructions of one round of work on a scene, including the start of this program.
fn counted(what: &str, scene: &str) -> f64 {
    let program = std::env::current_exe().expect("this program");
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(&program);
    let output = command.args(["1", what, scene]).output().expect("valgrind");
    let said = String::from_utf8_lossy(&output.stderr);
    let (_, count) = said.rsplit_once("Collected :").unwrap_or_else(|| panic!("{said}"));
    count.split_whitespace().next().and_then(|word| word.parse().ok()).expect("a number")
}

/// Prints the cost of a step in penalty scenes with increasing numbers of balls at the same density.
fn crowd() {
    println!("| balls | instructions of a step, a ball |\n|---:|---:|");
    let file = std::env::temp_dir().join(format!("fosssim-crowd-{}.xml", std::process::id()));
    let name = file.to_str().expect("a name in UTF-8");
    for balls in [100_u32, 1_000, 10_000, 100_000] {
        let of = |steps: u32| {
            std::fs::write(&file, box_of(balls, steps)).expect("a file");
            counted("step", name)
        };
        println!("| {balls} | {:.0} |", (of(11) - of(1)) / 10.0 / f64::from(balls));
    }
    std::fs::remove_file(&file).expect("removed");
}

/// Returns a scene in which balls move and repel each other, with the contest's order of sums.
fn box_of(balls: u32, steps: u32) -> String {
    let half = 0.5 * (f64::from(balls) / 150.0).sqrt();
    let mut xml = format!(
        r#"<scene><duration time="{}"/><integrator type="symplectic-euler" dt="0.005"/>
        <collision type="penalty" k="100" thickness="0"/><collisiondetection type="contest"/>"#,
        f64::from(steps) * 0.005
    );
    let mut state = 1_u32;
    let mut number = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state) / f64::from(u32::MAX) * 2.0 - 1.0
    };
    for _ in 0..balls {
        let [x, y, vx, vy] = [half, half, 0.5, 0.5].map(|scale| scale * number());
        _ = write!(xml, r#"<particle m="1" px="{x}" py="{y}" vx="{vx}" vy="{vy}" fixed="0" radius="0.02"/>"#);
    }
    xml + "</scene>"
}

/// Prints the cost of recording scenes with several hits in each step.
fn hits() {
    println!("| scene | steps | hits | trace, MB | record, millions of instructions |\n|---|---:|---:|---:|---:|");
    let file = std::env::temp_dir().join(format!("fosssim-hits-{}.xml", std::process::id()));
    for (name, xml) in [("balls rest in a bowl", bowl()), ("a ring of edges rests on an edge", ring())] {
        let scene = original::read(xml.as_bytes()).expect("a scene").scene;
        let trace = record(&scene, Vec::new());
        let (mut reader, mut frame, mut impulses) =
            (Reader::new(&trace[..], Layout::for_scene(&scene)), Frame::default(), 0);
        while reader.next(&mut frame).expect("a sound trace") {
            impulses += frame.impulses.len();
        }
        std::fs::write(&file, xml).expect("a file");
        let (steps, size) = (scene.step_count(), trace.len() as f64 / 1e6);
        let counted = counted("record", file.to_str().expect("a name in UTF-8")) / 1e6;
        // Both records of a step contain its impulses.
        println!("| {name} | {steps} | {} | {size:.1} | {counted:.1} |", impulses / 2);
    }
    std::fs::remove_file(&file).expect("removed");
}

/// Returns the beginning of a scene of `steps` steps of 0.01 seconds, with gravity and `continuous-time`.
fn falling(steps: u32, restitution: f64) -> String {
    format!(
        r#"<scene><duration time="{}"/><integrator type="symplectic-euler" dt="0.01"/>
        <collision type="continuous-time" COR="{restitution}"/><simplegravity fx="0" fy="-9.81"/>"#,
        f64::from(steps) * 0.01
    )
}

/// Returns four balls between two fixed edges that form a V.
fn bowl() -> String {
    let mut xml = falling(3000, 0.0);
    for ball in 0..4 {
        let (x, y) = (f64::from(ball) * 0.6 - 1.0, f64::from(ball) * 0.3 + 1.0);
        _ = write!(xml, r#"<particle m="1" px="{x}" py="{y}" vx="0" vy="0" fixed="0" radius="0.25"/>"#);
    }
    for (x, y) in [(-3, 2), (0, 0), (3, 2)] {
        _ = write!(xml, r#"<particle m="1" px="{x}" py="{y}" vx="0" vy="0" fixed="1" radius="0.1"/>"#);
    }
    xml + r#"<edge i="4" j="5" radius="0.1"/><edge i="5" j="6" radius="0.1"/></scene>"#
}

/// Returns eight balls in a ring of edges with springs, above a fixed edge.
fn ring() -> String {
    let mut xml = falling(1000, 0.5);
    for ball in 0..8 {
        let (y, x) = (f64::from(ball) * std::f64::consts::FRAC_PI_4).sin_cos();
        let y = y + 1.2;
        _ = write!(xml, r#"<particle m="1" px="{x}" py="{y}" vx="0.1" vy="0" fixed="0" radius="0.05"/>"#);
    }
    for x in [-3, 3] {
        _ = write!(xml, r#"<particle m="1" px="{x}" py="0" vx="0" vy="0" fixed="1" radius="0.1"/>"#);
    }
    for edge in 0..8 {
        let next = (edge + 1) % 8;
        _ = write!(xml, r#"<edge i="{edge}" j="{next}" radius="0.05"/>"#);
        _ = write!(xml, r#"<springforce edge="{edge}" k="300" l0="0.77" b="2"/>"#);
    }
    xml + r#"<edge i="8" j="9" radius="0.1"/></scene>"#
}

/// Prints the cost of a pair, and the peak memory so far, in scenes with increasing numbers of particles.
fn growth() {
    println!(
        "| particles | pairs in a pass | record, ns a pair | grade, ns a pair | trace, MB | most memory so far, MB |"
    );
    println!("|---:|---:|---:|---:|---:|---:|");
    for particles in [10, 30, 100, 300, 1000, 3000] {
        let scene = original::read(heap(particles).as_bytes()).expect("a scene").scene;
        let edges = scene.edges.len();
        let pairs = particles * (particles - 1) / 2 + (particles - 2) * edges + particles * scene.half_planes.len();
        // The trace is recorded into a file and judged from it, so it is never completely in memory.
        let per_pair = |time: f64| time * 1e6 / pairs as f64 / f64::from(scene.step_count());
        let rounds = if particles < 1000 { 5 } else { 2 };
        let recorded = least(rounds, || _ = record(&scene, std::io::sink()));
        let trace = std::env::temp_dir().join(format!("fosssim-growth-{particles}.bin"));
        drop(record(&scene, std::fs::File::create(&trace).expect("a file")));
        let options = Options { threads: 1, uses_fair_rules: true, ..Options::default() };
        let graded = least(rounds, || {
            let file = std::fs::File::open(&trace).expect("the trace");
            assert!(replay::judge(&scene, file, &options, &mut ()).fair.is_some());
        });
        let size = std::fs::metadata(&trace).expect("the trace").len() as f64 / 1e6;
        std::fs::remove_file(&trace).expect("removed");
        let (recorded, graded) = (per_pair(recorded), per_pair(graded));
        println!("| {particles} | {pairs} | {recorded:.1} | {graded:.1} | {size:.1} | {:.0} |", most_memory());
    }
}

/// Returns balls in rows above a floor and next to a wall, every tenth of them at the end of an edge. The balls begin
/// to fall.
fn heap(particles: usize) -> String {
    let mut xml = String::from(
        r#"<scene><duration time="0.03"/><integrator type="symplectic-euler" dt="0.01"/>
        <collision type="hybrid" COR="0.5" maxiters="2" k="0" thickness="0.01"/><simplegravity fx="0" fy="-10"/>
        <halfplane px="0" py="-0.5" nx="0" ny="1"/><halfplane px="-0.5" py="0" nx="1" ny="0"/>"#,
    );
    for index in 0..particles {
        let (x, y) = (index % 30, index / 30);
        let speed = ((index * 7919) % 101) as f64 / 101.0 - 0.5;
        _ = write!(xml, r#"<particle m="1" px="{x}" py="{y}" vx="{speed}" vy="{speed}" fixed="0" radius="0.2"/>"#);
    }
    for first in (0..particles - 1).step_by(10) {
        _ = write!(xml, r#"<edge i="{first}" j="{}" radius="0.1"/>"#, first + 1);
    }
    xml + "</scene>"
}

/// Returns the peak memory of this process, in megabytes.
fn most_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux");
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("a peak");
    line.trim().trim_end_matches(" kB").parse::<f64>().expect("a number") / 1e3
}
