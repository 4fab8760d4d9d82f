//! Judges a trace by both rule books: `cargo run --example judge -- SCENE.xml TRACE.bin`.
#![forbid(unsafe_code)]
use fosssim_oracle::{
    judge::{Book, replay},
    scene,
};
use std::{env, error::Error, fs};

/// Returns the two verdicts, and the place of the first difference between trace and reference.
pub fn run(scene: &[u8], trace: &[u8]) -> Result<String, Box<dyn Error>> {
    let scene = scene::read("scene", scene)?.scene;
    let options = replay::Options { uses_fair_rules: true, ..replay::Options::default() };
    let outcome = replay::judge(&scene, trace, &options, &mut ());
    let mut text = String::new();
    for (name, book) in [("original", Book::Parity), ("fair", Book::Fair)] {
        text += &format!("{name}: {}\n", outcome.ruling(book).name());
    }
    let first = outcome.findings_by(Book::Fair).first_divergence;
    Ok(text + &first.map_or(String::new(), |finding| format!("{finding}\n")))
}

fn main() -> Result<(), Box<dyn Error>> {
    let [scene, trace] = [1, 2].map(|number| env::args().nth(number).unwrap_or_default());
    print!("{}", run(&fs::read(scene)?, &fs::read(trace)?)?);
    Ok(())
}
