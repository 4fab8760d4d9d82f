//! The pictures of `-g 1` and `-m DIR`: one per step, as PNG in the folder `pngs`, as SVG in a folder of choice.
use super::arguments::Arguments;
use crate::{
    cli::output::Folder,
    render::{Extent, Painter, PictureOptions, Raster, Size, film::png, svg},
    report::original::NO_PICTURE_FOLDER,
    scene::Scene,
};
use anyhow::Result;
use std::path::Path;

/// The folder of `-g 1`.
const PNGS: &str = "pngs";

/// Width and height of the pictures.
const SIDE: u32 = 512;

/// Draws after each step.
pub(super) struct Pictures {
    painter: Painter,
    raster: Raster,
    png: Option<Folder>,
    svg: Option<Folder>,
}

impl Pictures {
    /// What is asked for; nothing if no pictures are.
    ///
    /// # Errors
    /// What to print, when a folder is missing.
    pub(super) fn new(arguments: &Arguments, scene: &Scene) -> Result<Option<Self>, String> {
        let png = match Folder::existing(Path::new(PNGS)) {
            _ if !arguments.generate => None,
            // The original aborts here.
            None => {
                return Err(format!("Error opening {PNGS}/frame00001.png: there is no folder {PNGS}; make it first\n"));
            }
            found => found,
        };
        let svg = match &arguments.movie {
            None => None,
            Some(folder) => Some(Folder::existing(Path::new(folder)).ok_or_else(|| NO_PICTURE_FOLDER.to_owned())?),
        };
        if png.is_none() && svg.is_none() {
            return Ok(None);
        }
        let size = Size::new(SIDE, SIDE).map_err(|error| error.to_string())?;
        let start: Vec<f64> = scene.particles.iter().flat_map(|p| [p.position.x, p.position.y]).collect();
        let painter = Painter::new(scene, &Extent::of(scene, &start), PictureOptions { size, label: false });
        Ok(Some(Self { painter, raster: Raster::new(size), png, svg }))
    }

    /// Draws the state after a step, from 1.
    ///
    /// # Errors
    /// When a picture can't be written.
    pub(super) fn step(&mut self, step: u32, positions: &[f64]) -> Result<()> {
        let shapes = self.painter.picture(step, positions, None);
        let background = self.painter.background();
        if let Some(folder) = &self.png {
            self.raster.draw(background, &shapes);
            let mut bytes = Vec::new();
            png(&self.raster, &mut bytes)?;
            folder.write(&format!("frame{step:05}.png"), &bytes)?;
        }
        if let Some(folder) = &self.svg {
            let picture = svg::document(self.raster.size(), background, &format!("step {step}"), &shapes);
            folder.write(&format!("frame{step:020}.svg"), picture.as_bytes())?;
        }
        Ok(())
    }
}
