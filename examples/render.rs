//! Draws the end of a scene as SVG: `cargo run --example render -- SCENE.xml > end.svg`.
#![forbid(unsafe_code)]
use fosssim_oracle::{
    render::{Extent, Painter, PictureOptions, Size, svg},
    scene,
    sim::{RootSearch, Simulation},
};
use std::{env, error::Error, fs};

/// Returns the reference's last state as a picture.
pub fn run(scene: &[u8]) -> Result<String, Box<dyn Error>> {
    let scene = scene::read("scene", scene)?.scene;
    let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
    let mut extent = Extent::for_scene(&scene, &simulation.state().positions);
    for _ in 0..scene.step_count() {
        simulation.step(&mut ())?;
        extent.add(&scene, &simulation.state().positions);
    }
    let size = Size::new(640, 480)?;
    let mut painter = Painter::new(&scene, &extent, PictureOptions { size, label: true });
    let shapes = painter.picture(scene.step_count(), &simulation.state().positions, None);
    Ok(svg::render_document(size, painter.background(), "the last step", &shapes))
}

fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", run(&fs::read(env::args().nth(1).unwrap_or_default())?)?);
    Ok(())
}
