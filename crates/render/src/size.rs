//! The size of pictures.
use std::{fmt, str::FromStr};

/// The smallest width and height.
pub const MIN_SIDE: u32 = 16;

/// The largest width and height.
pub const MAX_SIDE: u32 = 7680;

/// The width and height of a picture, in pixels and within limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    width: u32,
    height: u32,
}

/// The reason why a size is rejected.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SizeError {
    /// The text does not consist of two numbers.
    #[error("`{0}` is not a size; write WIDTHxHEIGHT, for example 640x480")]
    Unreadable(String),
    /// A side is too small or too large.
    #[error("{0}x{1} is out of range; width and height must be between {MIN_SIDE} and {MAX_SIDE} pixels")]
    OutOfRange(u32, u32),
}

impl Size {
    /// Creates a size.
    ///
    /// # Errors
    /// Fails if a side is below [`MIN_SIDE`] or above [`MAX_SIDE`].
    pub const fn new(width: u32, height: u32) -> Result<Self, SizeError> {
        if width < MIN_SIDE || width > MAX_SIDE || height < MIN_SIDE || height > MAX_SIDE {
            return Err(SizeError::OutOfRange(width, height));
        }
        Ok(Self { width, height })
    }

    /// Returns the width in pixels.
    pub const fn width(self) -> u32 {
        self.width
    }

    /// Returns the height in pixels.
    pub const fn height(self) -> u32 {
        self.height
    }

    /// Returns the number of pixels.
    pub const fn pixels(self) -> usize {
        self.width as usize * self.height as usize
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

impl FromStr for Size {
    type Err = SizeError;

    fn from_str(text: &str) -> Result<Self, SizeError> {
        let unreadable = || SizeError::Unreadable(text.to_owned());
        let (width, height) = text.split_once(['x', 'X']).ok_or_else(unreadable)?;
        let side = |side: &str| side.trim().parse::<u32>().map_err(|_| unreadable());
        Self::new(side(width)?, side(height)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_input_is_rejected_with_a_message() {
        assert_eq!("640x480".parse(), Size::new(640, 480));
        let refused = |text: &str| text.parse::<Size>().unwrap_err().to_string();
        assert_eq!(refused("640"), "`640` is not a size; write WIDTHxHEIGHT, for example 640x480");
        assert_eq!(refused("-640x480"), "`-640x480` is not a size; write WIDTHxHEIGHT, for example 640x480");
        let range = "is out of range; width and height must be between 16 and 7680 pixels";
        assert_eq!(refused("0x480"), format!("0x480 {range}"));
        assert_eq!(refused("640x4294967295"), format!("640x4294967295 {range}"));
    }
}
