//! An animated PNG, which browsers play and other programs show the first picture of.
use super::{Rate, changed::ChangedArea, png::rgb};
use crate::{raster::Raster, size::Size};
use std::io::{self, Write};

/// An animated PNG that is being written. How many pictures it holds is said at its beginning.
pub struct Apng<'a> {
    writer: png::Writer<&'a mut dyn Write>,
    size: Size,
    before: Vec<u8>,
}

impl<'a> Apng<'a> {
    /// Begins a film of exactly this number of pictures, played for ever.
    ///
    /// # Errors
    /// When `out` can't be written, or there is no picture.
    pub fn new(out: &'a mut dyn Write, size: Size, rate: Rate, pictures: u32) -> io::Result<Self> {
        let mut encoder = png::Encoder::new(out, size.width(), size.height());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_animated(pictures, 0)?;
        encoder.set_frame_delay(1, rate.per_second())?;
        Ok(Self { writer: encoder.write_header()?, size, before: Vec::new() })
    }

    /// Appends a picture.
    ///
    /// # Errors
    /// When it can't be written, or is one more than was said.
    pub fn picture(&mut self, raster: &Raster) -> io::Result<()> {
        let after = rgb(raster);
        let part = ChangedArea::of::<3>(self.size, &self.before, &after);
        if !self.before.is_empty() {
            self.writer.reset_frame_position()?;
            self.writer.set_frame_dimension(part.width, part.height)?;
            self.writer.set_frame_position(part.left, part.top)?;
        }
        self.writer.write_image_data(&part.cut::<3>(self.size, &after))?;
        self.before = after;
        Ok(())
    }

    /// Ends the film.
    ///
    /// # Errors
    /// When it can't be written, or pictures are missing.
    pub fn finish(self) -> io::Result<()> {
        Ok(self.writer.finish()?)
    }
}
