//! Encodes one picture as PNG.
use crate::raster::Raster;
use std::io::{self, Write};

/// Writes a picture as the bytes of a PNG file, without transparency.
///
/// # Errors
/// Fails if `out` cannot be written.
pub fn write_png(raster: &Raster, out: impl Write) -> io::Result<()> {
    let size = raster.size();
    let mut encoder = ::png::Encoder::new(out, size.width(), size.height());
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    let rgb: Vec<u8> = raster.rgba().chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(())
}
