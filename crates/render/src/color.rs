//! The colors of scenes, and contrasting colors.
use fosssim_model::scene;

/// A color with eight bits per component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Rgb(pub [u8; 3]);

impl Rgb {
    /// White, the default background of scenes.
    pub const WHITE: Self = Self([255; 3]);
    /// Black, the default color of half-planes.
    pub const BLACK: Self = Self([0; 3]);
    /// The default color of particles (scene-format.md 4).
    pub const PARTICLE: Self = Self([166, 75, 0]);
    /// The default color of edges (scene-format.md 4).
    pub const EDGE: Self = Self([0, 99, 99]);

    /// Returns a mixture of this color and `other`, with `share` of 8 parts from `other`.
    #[must_use]
    pub fn mix(self, other: Self, share: u8) -> Self {
        let part = |own: u8, other: u8| {
            let sum = u32::from(own) * u32::from(8 - share.min(8)) + u32::from(other) * u32::from(share.min(8));
            u8::try_from((sum + 4) / 8).unwrap_or(u8::MAX)
        };
        Self(std::array::from_fn(|k| part(self.0[k], other.0[k])))
    }

    /// Returns the apparent brightness, 0 to 255 (Rec. 709 weights).
    pub fn brightness(self) -> u32 {
        let [red, green, blue] = self.0.map(u32::from);
        (2126 * red + 7152 * green + 722 * blue) / 10_000
    }

    /// Returns black or white. The color that is readable on this background is chosen.
    #[must_use]
    pub fn contrasting_ink(self) -> Self {
        if self.brightness() > 127 { Self::BLACK } else { Self::WHITE }
    }

    /// Returns the color as `#rrggbb`.
    pub fn hex(self) -> String {
        let [red, green, blue] = self.0;
        format!("#{red:02x}{green:02x}{blue:02x}")
    }
}

impl From<scene::Color> for Rgb {
    fn from(color: scene::Color) -> Self {
        // A reader returns no NaN and no value out of range, but other values are clamped.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a byte")]
        let part = |value: f64| (value.clamp(0.0, 1.0) * 255.0).round() as u8;
        Self([part(color.red), part(color.green), part(color.blue)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ink_can_be_read_on_its_background() {
        assert_eq!(Rgb::WHITE.contrasting_ink(), Rgb::BLACK);
        assert_eq!(Rgb([20, 20, 60]).contrasting_ink(), Rgb::WHITE);
        assert_eq!(Rgb([255, 230, 0]).contrasting_ink(), Rgb::BLACK);
    }

    #[test]
    fn parts_of_the_way_begin_and_end_at_the_colors() {
        let (one, two) = (Rgb([0, 10, 255]), Rgb([255, 10, 0]));
        assert_eq!((one.mix(two, 0), one.mix(two, 8), one.mix(two, 4)), (one, two, Rgb([128, 10, 128])));
        assert_eq!(Rgb::PARTICLE.hex(), "#a64b00");
    }
}
