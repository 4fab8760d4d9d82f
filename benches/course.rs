//! Measures speed as ratios: whole processes compared with the original's figures, and parts compared with each other.
//!
//! `cargo bench` prints Markdown. The comparison with the original needs the ground-truth corpus (scenes, and the
//! original's own figures in `baseline.json`, taken on a 2.5 GHz Xeon); without it the comparison is skipped.
use fosssim_oracle::{
    judge::replay::{self, Options},
    scene::{self, Scene},
    sim::{RootSearch, Simulation},
    suite::library,
    trace::{Frame, Layout, Reader, Recorder, Writer},
};
use std::{
    path::{Path, PathBuf},
    process::{Command, Stdio},
    time::{Duration, Instant},
};

const ROUNDS: usize = 5;

fn main() {
    // `cargo test --benches` only checks that the benchmark builds and starts.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    println!("Medians of {ROUNDS} rounds.\n");
    against_the_original();
    parts();
    sandbox();
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort();
    times[times.len() / 2]
}

fn time(mut work: impl FnMut()) -> Duration {
    let round = |_| {
        let start = Instant::now();
        work();
        start.elapsed()
    };
    median((0..ROUNDS).map(round).collect())
}

/// Returns the corpus folder, if it exists.
fn corpus() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/corpus");
    let folder = std::env::var_os("FOSSSIM_CORPUS").map_or(beside, PathBuf::from);
    folder.is_dir().then_some(folder)
}

/// Measures whole processes of the drop-in command, on the available course scenes.
fn against_the_original() {
    let Some(corpus) = corpus() else {
        println!("No corpus: the comparison with the original is skipped.\n");
        return;
    };
    let read = |name: &str| std::fs::read_to_string(corpus.join(name)).expect(name);
    let baseline: serde_json::Value = serde_json::from_str(&read("baseline.json")).expect("JSON");
    let manifest: serde_json::Value = serde_json::from_str(&read("manifest.json")).expect("JSON");
    let folder = tempfile::tempdir().expect("a folder");
    let trace = folder.path().join("trace.bin");
    let (mut record, mut grade) = ([0.0; 2], [0.0; 2]);
    println!("| scene | record: original | ours | ratio | grade: original | ours | ratio |");
    println!("|---|---:|---:|---:|---:|---:|---:|");
    let scenes = manifest["scenes"].as_array().expect("scenes");
    let mut count = 0;
    for entry in scenes {
        let name = entry["scene"].as_str().expect("a name").trim_start_matches("t2m2/").replace('/', "_");
        let file = corpus.join(entry["scene_file"].as_str().expect("a file"));
        let original = |what: &str| baseline["scenes"][&name][what]["wall"].as_f64().expect("seconds");
        let run = |flag: &str| {
            let mut command = Command::new(env!("CARGO_BIN_EXE_fosssim-oracle"));
            command.args(["original", "-d", "0", "-s"]).arg(&file).arg(flag).arg(&trace);
            command.current_dir(folder.path()).stdout(Stdio::null());
            assert!(command.status().expect("a process").success());
        };
        let ours = [time(|| run("-o")).as_secs_f64(), time(|| run("-i")).as_secs_f64()];
        let theirs = [original("record"), original("grade")];
        for (sum, (theirs, ours)) in [&mut record, &mut grade].into_iter().zip(theirs.into_iter().zip(ours)) {
            sum[0] += theirs;
            sum[1] += ours;
        }
        if theirs[1] > 0.1 {
            row(&name, theirs, ours);
        }
        count += 1;
    }
    row(&format!("all {count} scenes"), [record[0], grade[0]], [record[1], grade[1]]);
    println!();
}

fn row(name: &str, theirs: [f64; 2], ours: [f64; 2]) {
    println!(
        "| {name} | {:.3} s | {:.4} s | {:.1} | {:.3} s | {:.4} s | {:.1} |",
        theirs[0],
        ours[0],
        theirs[0] / ours[0],
        theirs[1],
        ours[1],
        theirs[1] / ours[1],
    );
}

/// Compares parts of the program with each other, on all embedded scenes.
fn parts() {
    let scenes: Vec<(Scene, Vec<u8>)> = library::scene_names()
        .map(|name| {
            let xml = library::find_scene(name).expect("a scene");
            let scene = scene::read(name, xml).expect("a sound scene").scene;
            let trace = simulate(&scene, RootSearch::OnDemand);
            (scene, trace)
        })
        .collect();
    let simulated = |search| time(|| scenes.iter().for_each(|(scene, _)| drop(simulate(scene, search))));
    let (with, without) = (simulated(RootSearch::OnDemand), simulated(RootSearch::Always));
    println!("- Recording with certificates: {:.1} times faster than without.", ratio(without, with));
    let judged = |threads| {
        let options = Options { threads, ..Options::default() };
        time(|| scenes.iter().for_each(|(scene, trace)| drop(replay::judge(scene, &trace[..], &options, &mut ()))))
    };
    println!("- Judging on two threads: {:.1} times faster than on one.", ratio(judged(1), judged(2)));
    println!("- Judging on one thread takes {:.2} of the time of recording.", ratio(judged(1), with));
    let rescaled: Vec<Vec<u8>> = scenes.iter().map(|(scene, trace)| rescaled(scene, trace)).collect();
    let by_both = |traces: &[&[u8]]| {
        let options = Options { threads: 1, uses_fair_rules: true, ..Options::default() };
        time(|| {
            for ((scene, _), trace) in scenes.iter().zip(traces) {
                drop(replay::judge(scene, *trace, &options, &mut ()));
            }
        })
    };
    let own = by_both(&scenes.iter().map(|(_, trace)| &trace[..]).collect::<Vec<_>>());
    let other = by_both(&rescaled.iter().map(Vec::as_slice).collect::<Vec<_>>());
    println!(
        "- Judging correct traces with a factor by both books takes {:.1} times as long as identical ones.",
        ratio(other, own)
    );
}

/// Returns the trace with every coefficient divided by three.
fn rescaled(scene: &Scene, trace: &[u8]) -> Vec<u8> {
    let layout = Layout::for_scene(scene);
    let (mut reader, mut writer) = (Reader::from_slice(trace, layout), Writer::new(Vec::new(), layout));
    let mut frame = Frame::default();
    while reader.next(&mut frame).expect("a sound trace") {
        frame.polynomials.coefficients.iter_mut().for_each(|coefficient| *coefficient /= 3.0);
        writer.write_frame(&frame);
    }
    writer.finish().expect("memory").0
}

fn simulate(scene: &Scene, search: RootSearch) -> Vec<u8> {
    let mut simulation = Simulation::new(scene, search);
    let mut recorder = Recorder::start(Vec::new(), Layout::for_scene(scene), simulation.state());
    for _ in 0..scene.step_count() {
        simulation.step(&mut recorder).expect("a step");
    }
    recorder.finish().expect("memory").0
}

fn ratio(slow: Duration, fast: Duration) -> f64 {
    slow.as_secs_f64() / fast.as_secs_f64()
}

/// Measures the processor time that grading adds to that of the graded program.
fn sandbox() {
    let (grader, sample) = (env!("CARGO_BIN_EXE_fosssim-oracle"), env!("CARGO_BIN_EXE_fosssim-sample"));
    let folder = tempfile::tempdir().expect("a folder");
    // The largest available course scene, or the largest embedded one without the corpus.
    let xml = corpus()
        .and_then(|corpus| std::fs::read(corpus.join("scenes/t2m2/HolisticTests/test00.xml")).ok())
        .or_else(|| library::find_scene("HolisticTests/crowd-of-twenty-balls").map(<[u8]>::to_vec))
        .expect("a scene");
    std::fs::write(folder.path().join("scene.xml"), xml).expect("written");
    let suite = "schema = 1\nname = \"bench\"\n[[group]]\nname = \"one\"\nscenes = [\"scene.xml\"]\n";
    std::fs::write(folder.path().join("suite.toml"), suite).expect("written");
    let cpu = |command: &mut Command| {
        let before = children();
        assert!(command.current_dir(folder.path()).stdout(Stdio::null()).status().expect("a process").success());
        children() - before
    };
    let middle = |mut work: Box<dyn FnMut() -> Duration + '_>| median((0..ROUNDS).map(|_| work()).collect());
    let alone = middle(Box::new(|| cpu(Command::new(sample).args(["-s", "scene.xml", "-d", "0", "-o", "trace.bin"]))));
    let graded = middle(Box::new(|| cpu(Command::new(grader).args(["grade", sample, "--suite", "suite.toml"]))));
    let checked = middle(Box::new(|| cpu(Command::new(grader).args(["check", "scene.xml", "trace.bin"]))));
    println!(
        "- A sample submission needs {:.0} ms of processor time, {:.0} ms when graded (of which judging the trace \
         takes {:.0} ms): the sandbox adds {:.0} %.",
        ms(alone),
        ms(graded),
        ms(checked),
        100.0 * (ms(graded) - ms(checked) - ms(alone)) / ms(alone),
    );
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// Returns the processor time of all children so far.
fn children() -> Duration {
    // SAFETY: a zeroed rusage is a valid value, and getrusage only writes to it.
    let usage = unsafe {
        let mut usage: libc::rusage = std::mem::zeroed();
        libc::getrusage(libc::RUSAGE_CHILDREN, &raw mut usage);
        usage
    };
    let time = |t: libc::timeval| Duration::new(t.tv_sec.unsigned_abs(), t.tv_usec.unsigned_abs() as u32 * 1000);
    time(usage.ru_utime) + time(usage.ru_stime)
}
