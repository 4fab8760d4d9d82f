//! Draws shapes as pixels, with tiny-skia without vector instructions, so that the same shapes give the same pixels on
//! every run.
use crate::{
    color::Rgb,
    font,
    shape::{Paint, Point, Shape},
    size::Size,
};
use tiny_skia::{FillRule, LineCap, LineJoin, PathBuilder, Pixmap, Rect, Stroke, StrokeDash, Transform};

/// The width and height of a letter's dot, in pixels.
const DOT_SIZE: u32 = 2;

/// The lengths of dashes and gaps, in pixels.
const DASH: [f32; 2] = [6.0, 4.0];

/// An opaque picture in pixels.
#[derive(Debug, Clone)]
pub struct Raster {
    size: Size,
    pixels: Pixmap,
}

impl Raster {
    /// Creates an empty picture, which can be drawn on repeatedly.
    ///
    /// # Panics
    /// Never panics, because a pixmap can have every [`Size`].
    pub fn new(size: Size) -> Self {
        let pixels = Pixmap::new(size.width(), size.height()).expect("sizes are checked");
        Self { size, pixels }
    }

    /// Returns the size of the picture.
    pub const fn size(&self) -> Size {
        self.size
    }

    /// Returns red, green, blue and 255 of each pixel, row by row from the top.
    pub fn rgba(&self) -> &[u8] {
        self.pixels.data()
    }

    /// Replaces the picture by the given shapes.
    pub fn draw(&mut self, background: Rgb, shapes: &[Shape]) {
        let [red, green, blue] = background.0;
        self.pixels.fill(tiny_skia::Color::from_rgba8(red, green, blue, 255));
        for shape in shapes {
            match shape {
                Shape::Disc { center, radius, paint } => self.draw_disc(*center, *radius, *paint),
                Shape::Line { points, width, paint } => self.draw_line(points, *width, *paint),
                Shape::Area { points, paint } => self.fill_area(points, *paint),
                Shape::Text { place, text, color } => self.draw_text(*place, text, *color),
            }
        }
    }

    fn draw_disc(&mut self, [x, y]: Point, radius: f64, paint: Paint) {
        let mut builder = PathBuilder::new();
        builder.push_circle(to_f32(x), to_f32(y), to_f32(radius));
        let Some(path) = builder.finish() else { return };
        if matches!(paint, Paint::Dashed(_)) {
            self.stroke(&path, 2.0, paint);
        } else {
            self.pixels.fill_path(&path, &to_paint(paint), FillRule::Winding, Transform::identity(), None);
        }
    }

    fn draw_line(&mut self, points: &[Point], width: f64, paint: Paint) {
        if let Some(path) = build_path(points, false) {
            self.stroke(&path, to_f32(width), paint);
        }
    }

    fn stroke(&mut self, path: &tiny_skia::Path, width: f32, paint: Paint) {
        let dashed = matches!(paint, Paint::Dashed(_));
        let stroke = Stroke {
            width,
            line_cap: if dashed { LineCap::Butt } else { LineCap::Round },
            line_join: LineJoin::Round,
            dash: if dashed { StrokeDash::new(DASH.to_vec(), 0.0) } else { None },
            ..Stroke::default()
        };
        self.pixels.stroke_path(path, &to_paint(paint), &stroke, Transform::identity(), None);
    }

    fn fill_area(&mut self, points: &[Point], paint: Paint) {
        if let Some(path) = build_path(points, true) {
            self.pixels.fill_path(&path, &to_paint(paint), FillRule::Winding, Transform::identity(), None);
        }
    }

    fn draw_text(&mut self, [left, base]: Point, text: &str, color: Rgb) {
        let paint = to_paint(Paint::Solid(color));
        let top = base - f64::from(DOT_SIZE * font::LETTER_HEIGHT);
        for (index, letter) in text.chars().enumerate() {
            let Some(rows) = font::letter_rows(letter) else { continue };
            #[expect(clippy::cast_precision_loss, reason = "labels are short")]
            let start = left + index as f64 * f64::from(DOT_SIZE * font::LETTER_WIDTH);
            for (row, bits) in (0_u32..).zip(rows) {
                for column in (0..5_u32).filter(|column| bits & (0b10000 >> column) != 0) {
                    let x = to_f32(start + f64::from(DOT_SIZE * column));
                    let y = to_f32(top + f64::from(DOT_SIZE * row));
                    #[expect(clippy::cast_precision_loss, reason = "two pixels")]
                    if let Some(dot) = Rect::from_xywh(x, y, DOT_SIZE as f32, DOT_SIZE as f32) {
                        self.pixels.fill_rect(dot, &paint, Transform::identity(), None);
                    }
                }
            }
        }
    }
}

/// Converts a coordinate for the drawing library; shapes are near the picture.
#[expect(clippy::cast_possible_truncation, reason = "pixels need no more digits")]
fn to_f32(value: f64) -> f32 {
    value as f32
}

fn build_path(points: &[Point], closed: bool) -> Option<tiny_skia::Path> {
    let (&[x, y], rest) = points.split_first()?;
    let mut builder = PathBuilder::new();
    builder.move_to(to_f32(x), to_f32(y));
    for &[x, y] in rest {
        builder.line_to(to_f32(x), to_f32(y));
    }
    if closed {
        builder.close();
    }
    builder.finish()
}

fn to_paint(paint: Paint) -> tiny_skia::Paint<'static> {
    let [red, green, blue] = paint.color().0;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a byte")]
    let alpha = match paint {
        Paint::Faint(_, share) => (share.clamp(0.0, 1.0) * 255.0).round() as u8,
        Paint::Solid(_) | Paint::Dashed(_) => 255,
    };
    let mut ink = tiny_skia::Paint { anti_alias: true, ..tiny_skia::Paint::default() };
    ink.set_color_rgba8(red, green, blue, alpha);
    ink
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shapes() -> Vec<Shape> {
        let red = Rgb([200, 0, 0]);
        vec![
            Shape::Area {
                points: vec![[0.0, 40.0], [64.0, 30.0], [64.0, 48.0], [0.0, 48.0]],
                paint: Paint::Faint(Rgb::BLACK, 0.25),
            },
            Shape::Line { points: vec![[5.0, 5.0], [40.5, 20.25]], width: 3.0, paint: Paint::Solid(Rgb::EDGE) },
            Shape::Line { points: vec![[5.0, 15.0], [50.0, 35.0]], width: 2.0, paint: Paint::Dashed(red) },
            Shape::Disc { center: [30.0, 24.0], radius: 9.5, paint: Paint::Solid(Rgb::PARTICLE) },
            Shape::Disc { center: [36.0, 24.0], radius: 9.5, paint: Paint::Dashed(red) },
            Shape::Text { place: [2.0, 46.0], text: "t 0.1".into(), color: Rgb::BLACK },
        ]
    }

    /// The product promises equal pixels in two runs, and on two machines of the same kind.
    #[test]
    fn pixels_are_equal_on_every_run() {
        let mut raster = Raster::new(Size::new(64, 48).unwrap());
        raster.draw(Rgb::BLACK, &[]);
        raster.draw(Rgb::WHITE, &shapes());
        assert!(raster.rgba().chunks(4).all(|pixel| pixel[3] == 255));
        insta::assert_snapshot!("digest", blake3::hash(raster.rgba()).to_hex());
        let mut again = Raster::new(Size::new(64, 48).unwrap());
        again.draw(Rgb::WHITE, &shapes());
        assert_eq!(raster.rgba(), again.rgba());
    }

    #[test]
    fn every_shape_leaves_its_mark() {
        let mut raster = Raster::new(Size::new(64, 48).unwrap());
        for shape in shapes() {
            raster.draw(Rgb::WHITE, &[]);
            let empty = raster.rgba().to_vec();
            raster.draw(Rgb::WHITE, std::slice::from_ref(&shape));
            assert!(raster.rgba() != empty, "{shape:?}");
        }
    }
}
