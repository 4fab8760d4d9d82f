//! Compares judging by the shortcuts (bytes first, right at once) with the full way, on the traces of all samples on
//! all scenes that come with the program, and on those of a corpus: outcomes have to be the same to the last field.
use std::{
    path::Path,
    process::ExitCode,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
};

use anyhow::Context;
use fosssim_oracle::{
    judge::replay::{self, Options},
    scene::{Scene, original},
    student::{self, CATALOGUE, Student},
    suite::library,
};
use serde::Deserialize;

/// A trace and where it comes from.
type Case = (String, Scene, Vec<u8>);

#[derive(Deserialize)]
struct Row {
    submission: String,
    scene: String,
    trace_file: Option<String>,
}

/// Judges all samples whose ids hold `part`; or, if that is a corpus's folder, all its traces.
pub fn run(part: &str) -> anyhow::Result<ExitCode> {
    let next = AtomicUsize::new(0);
    let differing = Mutex::new(Vec::new());
    let case: Box<dyn Fn(usize) -> anyhow::Result<Option<Case>> + Sync>;
    let count;
    if Path::new(part).join("verdicts.jsonl").exists() {
        let text = std::fs::read_to_string(Path::new(part).join("verdicts.jsonl"))?;
        let rows: Vec<Row> = text.lines().map(serde_json::from_str).collect::<Result<_, _>>()?;
        count = rows.len();
        case = Box::new(move |number| of_corpus(Path::new(part), &rows[number]));
    } else {
        let names: Vec<&str> = library::names().collect();
        let rows: Vec<_> = CATALOGUE.iter().filter(|row| row.id.contains(part)).collect();
        count = names.len() * rows.len();
        case = Box::new(move |number| {
            let (name, row) = (names[number % names.len()], rows[number / names.len()]);
            let scene = original::read(library::scene(name).context("a scene")?)?.scene;
            let trace = student::trace(&scene, Student::new(Some(row.mistake))).unwrap_or_else(|(bytes, _)| bytes);
            Ok(Some((format!("{} {name}", row.id), scene, trace)))
        });
    }
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= count {
                return Ok(());
            }
            let Some((name, scene, trace)) = case(number)? else { continue };
            for fair in [false, true] {
                let [one, other] = [false, true].map(|one_by_one| {
                    let options = Options { threads: 1, fair, one_by_one, ..Options::default() };
                    format!("{:?}", replay::judge(&scene, &trace[..], &options, &mut ()))
                });
                if one != other {
                    let mut differing = differing.lock().expect("no other thread has panicked");
                    differing.push(format!("{name}, fair {fair}:\n  {one}\n  {other}"));
                }
            }
        }
    };
    std::thread::scope(|scope| {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let all: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        all.into_iter().try_for_each(|thread| thread.join().expect("no thread panics"))
    })
    .map_err(|error: anyhow::Error| error)?;
    let differing = differing.into_inner().expect("no thread has panicked");
    println!("{count} traces, {} outcomes differ", differing.len());
    if let Some(first) = differing.first() {
        println!("{first}");
    }
    Ok(ExitCode::from(u8::from(!differing.is_empty())))
}

fn of_corpus(corpus: &Path, row: &Row) -> anyhow::Result<Option<Case>> {
    let Some(file) = &row.trace_file else { return Ok(None) };
    let scene = std::fs::read(corpus.join("scenes").join(format!("{}.xml", row.scene)))?;
    let scene = original::read(&scene).with_context(|| row.scene.clone())?.scene;
    let trace = zstd::decode_all(std::fs::File::open(corpus.join(file))?)?;
    Ok(Some((format!("{} {}", row.submission, row.scene), scene, trace)))
}
