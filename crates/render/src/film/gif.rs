//! A GIF film with 256 colors, chosen from the scene's own colors.
//!
//! Edges of shapes are blends of two colors. The palette contains steps from each color to the background, and a cube
//! of all colors if there is room. Other colors are replaced by the nearest one in the palette.
use super::{Rate, changed_area::ChangedArea};
use crate::{color::Rgb, raster::Raster, size::Size};
use std::{
    collections::{BTreeSet, HashMap},
    io::{self, Write},
};

/// The number of steps from a color to the background.
const COLOR_STEPS: u8 = 8;

/// A GIF film that is being written.
pub struct Gif<'a> {
    encoder: gif::Encoder<&'a mut dyn Write>,
    size: Size,
    rate: Rate,
    palette: Vec<Rgb>,
    /// The palette indices of known colors.
    known_indices: HashMap<[u8; 3], u8>,
    previous_picture: Vec<u8>,
    pictures: u64,
}

impl<'a> Gif<'a> {
    /// Begins a film that repeats forever, in the given colors, with the background first.
    ///
    /// # Errors
    /// Fails if `out` cannot be written, or the pictures are larger than a GIF allows.
    pub fn new(out: &'a mut dyn Write, size: Size, rate: Rate, colors: &[Rgb]) -> io::Result<Self> {
        let palette = build_palette(colors);
        let bytes: Vec<u8> = palette.iter().flat_map(|color| color.0).collect();
        let mut encoder =
            gif::Encoder::new(out, side(size.width()), side(size.height()), &bytes).map_err(to_io_error)?;
        encoder.set_repeat(gif::Repeat::Infinite).map_err(to_io_error)?;
        Ok(Self {
            encoder,
            size,
            rate,
            palette,
            known_indices: HashMap::new(),
            previous_picture: Vec::new(),
            pictures: 0,
        })
    }

    /// Appends a picture to the film.
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub fn write_picture(&mut self, raster: &Raster) -> io::Result<()> {
        let (palette, known) = (&self.palette, &mut self.known_indices);
        let after: Vec<u8> = raster
            .rgba()
            .chunks_exact(4)
            .map(|pixel| {
                let color = [pixel[0], pixel[1], pixel[2]];
                *known.entry(color).or_insert_with(|| nearest_index(palette, color))
            })
            .collect();
        let part = ChangedArea::from_pictures(self.size, &self.previous_picture, &after);
        // Delays are hundredths of a second, chosen so that their sum is right at every rate.
        let at = |pictures: u64| 100 * pictures / u64::from(self.rate.per_second());
        let delay = at(self.pictures + 1) - at(self.pictures);
        let frame = gif::Frame {
            delay: u16::try_from(delay).unwrap_or(u16::MAX),
            dispose: gif::DisposalMethod::Keep,
            left: side(part.left),
            top: side(part.top),
            width: side(part.width),
            height: side(part.height),
            buffer: part.extract(self.size, &after).into(),
            ..gif::Frame::default()
        };
        self.encoder.write_frame(&frame).map_err(to_io_error)?;
        self.previous_picture = after;
        self.pictures += 1;
        Ok(())
    }

    /// Ends the film.
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub fn finish(self) -> io::Result<()> {
        self.encoder.into_inner().map_err(to_io_error)?.flush()
    }
}

/// Returns a side of a picture, or a position in it. Sizes are far below the limit.
fn side(pixels: u32) -> u16 {
    u16::try_from(pixels).unwrap_or(u16::MAX)
}

fn to_io_error(error: gif::EncodingError) -> io::Error {
    match error {
        gif::EncodingError::Io(error) => error,
        other => io::Error::other(other),
    }
}

/// Returns at most 256 colors: the given ones first, then steps toward the first one, then a cube of all colors.
fn build_palette(colors: &[Rgb]) -> Vec<Rgb> {
    let background = colors.first().copied().unwrap_or(Rgb::WHITE);
    let mut palette = Vec::new();
    let mut seen = BTreeSet::new();
    let mut add = |color: Rgb| {
        if palette.len() < 256 && seen.insert(color) {
            palette.push(color);
        }
    };
    colors.iter().copied().for_each(&mut add);
    // The middle step comes first, because with many colors a few steps of each are better than all steps of a few.
    for step in [4, 2, 6, 1, 3, 5, 7] {
        debug_assert!(step < COLOR_STEPS);
        colors.iter().for_each(|&color| add(color.mix(background, step)));
    }
    for levels in [6_u8, 4] {
        let part = |index: u8| u8::try_from(255 * u32::from(index) / u32::from(levels - 1)).unwrap_or(u8::MAX);
        for red in 0..levels {
            for green in 0..levels {
                (0..levels).for_each(|blue| add(Rgb([red, green, blue].map(part))));
            }
        }
    }
    palette
}

fn nearest_index(palette: &[Rgb], color: [u8; 3]) -> u8 {
    let distance = |other: &Rgb| -> u32 {
        other.0.iter().zip(color).map(|(&own, other)| u32::from(own.abs_diff(other)).pow(2)).sum()
    };
    let nearest = palette.iter().enumerate().min_by_key(|(_, other)| distance(other));
    nearest.map_or(0, |(index, _)| u8::try_from(index).unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scenes_colors_are_exact() {
        let many: Vec<Rgb> = (0..200).map(|k| Rgb([k, 255 - k, 7])).collect();
        let palette = build_palette(&many);
        assert_eq!(palette.len(), 256);
        for color in many {
            assert_eq!(palette[usize::from(nearest_index(&palette, color.0))], color);
        }
        assert!(super::build_palette(&[]).len() <= 256);
    }
}
