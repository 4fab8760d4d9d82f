//! Measures how grading a class scales with the number of jobs: the same submissions graded by one job and by several,
//! as ratios to one.
//!
//! `cargo bench --bench class` prints Markdown. `cargo bench --bench class -- 156 t2m2` grades 156 programs on the
//! suite `t2m2` instead. On a machine with few cores the rows of more jobs are omitted, because they would show
//! nothing.
use std::{
    path::Path,
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

/// The time, files and memory of one grading.
struct Measured {
    wall: Duration,
    user: Duration,
    system: Duration,
    /// The number of files written.
    files: usize,
    /// The peak memory of the grader or of a program, in MiB.
    memory: i64,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    // `cargo test --benches` only checks that the benchmark builds and starts.
    if !arguments.iter().any(|argument| argument == "--bench") {
        return;
    }
    let wanted = arguments.iter().find_map(|argument| argument.parse().ok());
    let suite = arguments.iter().find(|argument| argument.starts_with('t')).map_or("t2m2", String::as_str);
    let cores = thread::available_parallelism().map_or(1, usize::from);
    println!("Suite {suite}, {cores} cores. Ratios are to one job.\n");
    println!("| programs | jobs | s | times as fast | processor time | s in the kernel | files | MiB |");
    println!("|---:|---:|---:|---:|---:|---:|---:|---:|");
    for programs in wanted.map_or(vec![1, 10, 40], |count| vec![count]) {
        let folder = tempfile::tempdir().expect("a folder");
        hand_in(folder.path(), programs);
        let one = grade(folder.path(), suite, 1);
        row(programs, 1, &one, &one);
        for jobs in [2, 4, 8, 16].into_iter().filter(|jobs| *jobs <= cores) {
            row(programs, jobs, &grade(folder.path(), suite, jobs), &one);
        }
    }
    if cores < 16 {
        println!("\nMore than {cores} jobs would share the cores of this machine.");
    }
}

/// Writes correct programs, each with different bytes.
fn hand_in(folder: &Path, programs: usize) {
    let sample = std::fs::read(env!("CARGO_BIN_EXE_fosssim-sample")).expect("the sample");
    for number in 0..programs {
        let own = folder.join(format!("submissions/student-{number:03}"));
        std::fs::create_dir_all(&own).expect("a folder");
        let program = own.join("FOSSSim");
        std::fs::write(&program, [&sample[..], format!("{number}").as_bytes()].concat()).expect("a program");
        let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
        std::fs::set_permissions(program, mode).expect("permissions");
    }
}

fn grade(folder: &Path, suite: &str, jobs: usize) -> Measured {
    let results = folder.join(format!("results-{jobs}"));
    let (start, before) = (Instant::now(), children());
    let mut command = Command::new(env!("CARGO_BIN_EXE_fosssim-oracle"));
    command.current_dir(folder).args(["grade", "submissions", "--suite", suite, "--jobs", &jobs.to_string()]);
    command.arg("--output").arg(&results).stdout(Stdio::null()).stderr(Stdio::null());
    assert!(command.status().expect("a process").success(), "a correct program was not accepted");
    let (wall, after) = (start.elapsed(), children());
    let time = |t: libc::timeval| Duration::new(t.tv_sec.unsigned_abs(), t.tv_usec.unsigned_abs() as u32 * 1000);
    Measured {
        wall,
        user: time(after.ru_utime) - time(before.ru_utime),
        system: time(after.ru_stime) - time(before.ru_stime),
        files: walk(&results),
        memory: after.ru_maxrss / 1024,
    }
}

fn row(programs: usize, jobs: usize, measured: &Measured, one: &Measured) {
    let processor = |measured: &Measured| (measured.user + measured.system).as_secs_f64();
    println!(
        "| {programs} | {jobs} | {:.2} | {:.1} | {:.2} | {:.2} | {} | {} |",
        measured.wall.as_secs_f64(),
        one.wall.as_secs_f64() / measured.wall.as_secs_f64(),
        processor(measured) / processor(one),
        measured.system.as_secs_f64(),
        measured.files,
        measured.memory,
    );
}

/// Counts the files in a folder.
fn walk(folder: &Path) -> usize {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.map(|path| if path.is_dir() { walk(&path) } else { 1 }).sum()
}

/// Returns the resources that all children have used so far.
fn children() -> libc::rusage {
    // SAFETY: a zeroed rusage is a valid value, and getrusage only writes to it.
    unsafe {
        let mut usage: libc::rusage = std::mem::zeroed();
        libc::getrusage(libc::RUSAGE_CHILDREN, &raw mut usage);
        usage
    }
}
