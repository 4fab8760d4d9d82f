//! The shapes of pictures, in pixels from the upper left corner. All shapes are in or near the picture, because far
//! coordinates have been clipped for the drawing libraries.
use crate::color::Rgb;

/// A point in pixels.
pub type Point = [f64; 2];

/// The paint of a shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Paint {
    /// A filled shape, or a plain stroke.
    Solid(Rgb),
    /// A filled shape or stroke with an opacity from 0 to 1.
    Faint(Rgb, f64),
    /// A dashed outline, or a dashed stroke.
    Dashed(Rgb),
}

impl Paint {
    /// Returns the shape's color.
    #[must_use]
    pub const fn color(self) -> Rgb {
        match self {
            Self::Solid(color) | Self::Faint(color, _) | Self::Dashed(color) => color,
        }
    }
}

/// An element of a picture.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A disc; a dashed disc is an outline.
    Disc {
        /// The shape's center.
        center: Point,
        /// The shape's radius, positive.
        radius: f64,
        /// The paint of the shape.
        paint: Paint,
    },
    /// A line with round ends.
    Line {
        /// The shape's points, at least two.
        points: Vec<Point>,
        /// The shape's width, positive.
        width: f64,
        /// The paint of the shape.
        paint: Paint,
    },
    /// A filled polygon.
    Area {
        /// The shape's corners.
        points: Vec<Point>,
        /// The paint of the shape.
        paint: Paint,
    },
    /// A line of text.
    Text {
        /// The shape's lower left corner.
        place: Point,
        /// The shape's text.
        text: String,
        /// The shape's color.
        color: Rgb,
    },
}
