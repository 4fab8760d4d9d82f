//! The boxes around bodies (simulation.md 3.1).
use fosssim_num::vector::Vec2;
use std::f64::consts::SQRT_2;

/// A body's extent along x, y, x + y and x - y.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct BodyExtent {
    pub body: u32,
    pub low: [f64; 4],
    pub high: [f64; 4],
}

impl BodyExtent {
    /// Returns the extent around everything between two points, widened by `radius`.
    pub fn from_points(body: u32, [one, other]: [Vec2; 2], radius: f64, has_four_axes: bool) -> Self {
        let mut own = Self { body, ..Self::default() };
        let mut extend = |axis: usize, one: f64, other: f64, radius: f64| {
            // If two numbers cannot be compared, the second is used, as in the processor's instructions.
            own.low[axis] = if one < other { one } else { other } - radius;
            own.high[axis] = if one > other { one } else { other } + radius;
        };
        extend(0, one.x, other.x, radius);
        extend(1, one.y, other.y, radius);
        if has_four_axes {
            extend(2, one.x + one.y, other.x + other.y, radius * SQRT_2);
            extend(3, one.x - one.y, other.x - other.y, radius * SQRT_2);
        }
        own
    }

    /// Returns the lower and the upper end along y.
    pub fn ends_along_y(&self) -> [f64; 2] {
        [self.low[1], self.high[1]]
    }

    /// Returns whether the ends along x and y are finite, and no upper end is below its lower end.
    pub fn is_finite(&self) -> bool {
        [0, 1].iter().all(|&axis| self.low[axis] <= self.high[axis] && (self.high[axis] - self.low[axis]).is_finite())
    }

    /// Returns whether the box begins behind the end of `other` along x.
    pub fn begins_behind(&self, other: &Self) -> bool {
        self.low[0] > other.high[0]
    }

    /// Returns whether boxes overlap or touch on all axes; x is tested last, because the sweep has already compared x.
    pub fn overlaps(&self, other: &Self) -> bool {
        [1, 2, 3, 0]
            .into_iter()
            .all(|axis| !(self.low[axis] > other.high[axis]) && !(other.low[axis] > self.high[axis]))
    }
}
