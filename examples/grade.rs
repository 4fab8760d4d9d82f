//! Grades every program of a folder in the sandbox: `cargo run --example grade -- FOLDER [SUITE]`.
#![forbid(unsafe_code)]
use fosssim_oracle::{
    files::FilePlace,
    sandbox::{Backend, Supervisor, supervisor_main},
    suite::{
        Cancellation, batch,
        grader::{Grader, Options, Submission},
        plan,
    },
};
use std::{env, error::Error, fs, path::Path, process::ExitCode};

/// Returns one line per program, with its verdict and its points.
pub fn run(folder: &Path, suite: &str, supervisor: Supervisor) -> Result<String, Box<dyn Error>> {
    let mut submissions = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        submissions.push(Submission { name, path: entry.path(), program: None, file: None });
    }
    let grader = Grader {
        plan: &plan::find_suite(suite)?,
        backend: &Backend::with_all_layers(supervisor)?,
        program: "FOSSSim",
        options: Options { jobs: 2, fail_fast: false, uses_recordings: false },
        fault_folder: &FilePlace::new(folder, "faults"),
        trace_file: None,
        cards: None,
        smallest: None,
        receive_grade: None,
        timings: None,
        reference: None,
    };
    let graded = batch::grade_all(&grader, &submissions, None, &Cancellation::default(), &mut |_| {});
    let line = |grade: &fosssim_oracle::suite::Grade| {
        format!("{}: {:?}, {:?} of {} points\n", grade.submission, grade.verdict, grade.points, grade.max_points)
    };
    Ok(graded.grades.iter().map(line).collect())
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    // The sandbox starts this program again as its supervisor.
    if let Some(code) = supervisor_main(env::args_os()) {
        return Ok(code);
    }
    let words: Vec<String> = env::args().skip(1).collect();
    let [folder, suite @ ..] = &words[..] else { return Err("which folder?".into()) };
    let suite = suite.first().cloned().unwrap_or_else(plan::default_name);
    print!("{}", run(Path::new(folder), &suite, Supervisor::this_program())?);
    Ok(ExitCode::SUCCESS)
}
