//! Encodes pictures to files: one PNG, or a GIF. Encoders receive one picture at a time and keep at most two.
mod changed_area;
mod gif;
mod png;

pub use self::{gif::Gif, png::write_png};

/// The frame rate of a film, in pictures per second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rate(u16);

/// The maximum frame rate, in pictures per second.
pub const MAX_RATE: u16 = 240;

impl Rate {
    /// Creates a frame rate from 1 to [`MAX_RATE`], or returns `None` for other values.
    pub const fn new(per_second: u16) -> Option<Self> {
        if per_second == 0 || per_second > MAX_RATE { None } else { Some(Self(per_second)) }
    }

    /// Returns the number of pictures per second.
    pub const fn per_second(self) -> u16 {
        self.0
    }
}
