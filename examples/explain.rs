//! Names the likely mistake behind a wrong trace: `cargo run --example explain -- SCENE.xml TRACE.bin`.
#![forbid(unsafe_code)]
use fosssim_oracle::{diagnose, report::words::explanation, scene};
use std::{env, error::Error, fs};

/// Returns one line per mistake, the likeliest first, with the share of the samples that it reproduces.
pub fn run(scene: &[u8], trace: &[u8]) -> Result<String, Box<dyn Error>> {
    let scene = scene::read("scene", scene)?.scene;
    let line = |found: &diagnose::Explanation| {
        format!("{} ({} of {}): {}\n", found.key, found.reproduced, found.samples, explanation::describe(found))
    };
    Ok(diagnose::explain(&scene, trace).iter().map(line).collect())
}

fn main() -> Result<(), Box<dyn Error>> {
    let [scene, trace] = [1, 2].map(|number| env::args().nth(number).unwrap_or_default());
    print!("{}", run(&fs::read(scene)?, &fs::read(trace)?)?);
    Ok(())
}
