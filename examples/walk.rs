//! Prints a trace, record by record: `cargo run --example walk -- SCENE.xml TRACE.bin`.
#![forbid(unsafe_code)]
use fosssim_oracle::{
    scene,
    trace::{Frame, Layout, Reader},
};
use std::{env, error::Error, fs};

/// Returns one line per record with impulses: their number, and the position of the first particle.
pub fn run(scene: &[u8], trace: &[u8]) -> Result<String, Box<dyn Error>> {
    let layout = Layout::for_scene(&scene::read("scene", scene)?.scene);
    let mut reader = Reader::from_slice(trace, layout);
    let (mut frame, mut record, mut text) = (Frame::default(), 0, String::new());
    while reader.next(&mut frame)? {
        if !frame.impulses.is_empty() {
            let place = &frame.state.positions[..2];
            text += &format!("record {record}: {} impulses, particle 0 at {place:?}\n", frame.impulses.len());
        }
        record += 1;
    }
    Ok(text)
}

fn main() -> Result<(), Box<dyn Error>> {
    let [scene, trace] = [1, 2].map(|number| env::args().nth(number).unwrap_or_default());
    print!("{}", run(&fs::read(scene)?, &fs::read(trace)?)?);
    Ok(())
}
