//! The shapes of pictures, in pixels from the upper left corner. All shapes are in or near the picture, because far
//! coordinates have been clipped for the drawing libraries.
use crate::color::Rgb;

/// A point in pixels.
pub type Point = [f64; 2];

/// The color and the style of a shape's fill or stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Paint {
    /// The shape is filled, or is a plain stroke.
    Solid(Rgb),
    /// The shape is filled or a stroke, with an opacity from 0 to 1.
    Faint(Rgb, f64),
    /// The shape is a dashed outline or a dashed stroke.
    Dashed(Rgb),
}

impl Paint {
    /// Returns the shape's color.
    pub const fn color(self) -> Rgb {
        match self {
            Self::Solid(color) | Self::Faint(color, _) | Self::Dashed(color) => color,
        }
    }
}

/// An element of a picture.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// The shape is a disc. A dashed disc is an outline.
    Disc {
        /// The shape's center.
        center: Point,
        /// The shape's radius, which is positive.
        radius: f64,
        /// The paint of the shape.
        paint: Paint,
    },
    /// The shape is a line with round ends.
    Line {
        /// The shape's points. There are at least two.
        points: Vec<Point>,
        /// The shape's width, which is positive.
        width: f64,
        /// The paint of the shape.
        paint: Paint,
    },
    /// The shape is a filled polygon.
    Area {
        /// The shape's corners.
        points: Vec<Point>,
        /// The paint of the shape.
        paint: Paint,
    },
    /// The shape is a line of text.
    Text {
        /// The shape's lower left corner.
        place: Point,
        /// The shape's text.
        text: String,
        /// The shape's color.
        color: Rgb,
    },
}
