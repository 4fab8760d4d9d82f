//! The part of this program that the drop-in for the original needs. It draws the pictures.
use crate::original::{NO_PICTURE_FOLDER, Pictures, Services};
use crate::{
    cli::output::Folder,
    render::{Extent, Painter, PictureOptions, Raster, Size, film::write_png, svg},
    sandbox,
    scene::Scene,
};
use anyhow::Result;
use std::path::Path;

/// The folder for the pictures that `-g 1` requests.
const PNG_FOLDER: &str = "pngs";

/// The width and the height of the pictures, in pixels.
const PICTURE_SIDE: u32 = 512;

/// The part of the drop-in that this program implements.
pub(super) struct CliServices;

impl Services for CliServices {
    fn prepare(&self) {
        sandbox::let_large_writes_fail();
    }

    fn pictures(&self, png: bool, svg: Option<&Path>, scene: &Scene) -> Result<Box<dyn Pictures>, String> {
        let png = match Folder::open_existing(Path::new(PNG_FOLDER)) {
            _ if !png => None,
            // The original aborts in this case.
            None => {
                return Err(format!(
                    "Error opening {PNG_FOLDER}/frame00001.png: there is no folder {PNG_FOLDER}; create it first\n"
                ));
            }
            found => found,
        };
        let svg = match svg {
            None => None,
            Some(folder) => Some(Folder::open_existing(folder).ok_or_else(|| NO_PICTURE_FOLDER.to_owned())?),
        };
        let size = Size::new(PICTURE_SIDE, PICTURE_SIDE).map_err(|error| error.to_string())?;
        let start: Vec<f64> = scene.particles.iter().flat_map(|p| [p.position.x, p.position.y]).collect();
        let painter = Painter::new(scene, &Extent::for_scene(scene, &start), PictureOptions { size, label: false });
        Ok(Box::new(PictureFolders { painter, raster: Raster::new(size), png, svg }))
    }
}

/// The folders for the pictures of `-g 1` and `-m DIR`, with one picture per step. `-g 1` writes PNG into the folder
/// `pngs`, and `-m` writes SVG into the given folder.
struct PictureFolders {
    painter: Painter,
    raster: Raster,
    png: Option<Folder>,
    svg: Option<Folder>,
}

impl PictureFolders {
    fn draw(&mut self, step: u32, positions: &[f64]) -> Result<()> {
        let shapes = self.painter.picture(step, positions, None);
        let background = self.painter.background();
        if let Some(folder) = &self.png {
            self.raster.draw(background, &shapes);
            let mut bytes = Vec::new();
            write_png(&self.raster, &mut bytes)?;
            folder.write(&format!("frame{step:05}.png"), &bytes)?;
        }
        if let Some(folder) = &self.svg {
            let picture = svg::render_document(self.raster.size(), background, &format!("step {step}"), &shapes);
            folder.write(&format!("frame{step:020}.svg"), picture.as_bytes())?;
        }
        Ok(())
    }
}

impl Pictures for PictureFolders {
    fn step(&mut self, step: u32, positions: &[f64]) -> Result<(), String> {
        self.draw(step, positions).map_err(|error| format!("{error:#}\n"))
    }
}
