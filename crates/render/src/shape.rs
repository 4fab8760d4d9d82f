//! The shapes that pictures are made of, in pixels from the upper left corner. Everything lies in or near the picture:
//! far coordinates have been clipped, so that no drawing library sees numbers it can't handle.
use crate::colour::Colour;

/// A point in pixels.
pub type Point = [f64; 2];

/// How a shape is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Paint {
    /// Filled, or a plain stroke.
    Solid(Colour),
    /// As solid, with this opacity: 0 to 1.
    Faint(Colour, f64),
    /// A dashed outline, or a dashed stroke.
    Dashed(Colour),
}

impl Paint {
    /// Returns the shape's colour.
    #[must_use]
    pub const fn colour(self) -> Colour {
        match self {
            Self::Solid(colour) | Self::Faint(colour, _) | Self::Dashed(colour) => colour,
        }
    }
}

/// One thing in a picture.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A disc; dashed ones are outlines.
    Disc {
        /// The shape's centre.
        center: Point,
        /// The shape's radius, positive.
        radius: f64,
        /// How it is drawn.
        paint: Paint,
    },
    /// A line with round ends.
    Line {
        /// The shape's points, at least two.
        points: Vec<Point>,
        /// The shape's width, positive.
        width: f64,
        /// How it is drawn.
        paint: Paint,
    },
    /// A filled polygon.
    Area {
        /// The shape's corners.
        points: Vec<Point>,
        /// How it is drawn.
        paint: Paint,
    },
    /// A line of text.
    Text {
        /// The shape's lower left corner.
        place: Point,
        /// The shape's text.
        text: String,
        /// The shape's colour.
        colour: Colour,
    },
}
