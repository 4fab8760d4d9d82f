//! Computes the part of the plane that a picture shows.
use crate::size::Size;
use fosssim_model::scene::{Scene, Viewport};
use fosssim_num::vector::Vec2;

/// The ratio of the picture's width to that of the bodies.
const MARGIN: f64 = 1.1;

/// The largest coordinate for which a view is fitted. The squares and sums of larger ones are infinite.
const MAX_COORDINATE: f64 = 1e100;

/// The maximum factor by which bodies that leave the scene widen the initial view.
const MAX_WIDENING: f64 = 4.0;

/// The smallest box around discs, which is empty at first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    low: Vec2,
    high: Vec2,
}

impl Default for Extent {
    fn default() -> Self {
        Self { low: Vec2::new(f64::INFINITY, f64::INFINITY), high: Vec2::new(f64::NEG_INFINITY, f64::NEG_INFINITY) }
    }
}

impl Extent {
    /// Returns the box around a scene's particles at `positions`, in trace order.
    pub fn for_scene(scene: &Scene, positions: &[f64]) -> Self {
        let mut extent = Self::default();
        extent.add(scene, positions);
        extent
    }

    /// Widens the box to contain the particles at `positions`.
    pub fn add(&mut self, scene: &Scene, positions: &[f64]) {
        for (particle, position) in scene.particles.iter().zip(positions.chunks_exact(2)) {
            let radius = particle.radius.clamp(0.0, MAX_COORDINATE);
            // Bodies without a position in the plane (NaN) are not drawn.
            if position.iter().all(|coordinate| coordinate.abs() < MAX_COORDINATE) {
                self.low = Vec2::new(self.low.x.min(position[0] - radius), self.low.y.min(position[1] - radius));
                self.high = Vec2::new(self.high.x.max(position[0] + radius), self.high.y.max(position[1] + radius));
            }
        }
    }

    /// Widens the box to contain another box.
    pub fn join(&mut self, other: &Self) {
        self.low = Vec2::new(self.low.x.min(other.low.x), self.low.y.min(other.low.y));
        self.high = Vec2::new(self.high.x.max(other.high.x), self.high.y.max(other.high.y));
    }

    fn is_empty(&self) -> bool {
        !(self.low.x <= self.high.x)
    }

    fn center(&self) -> Vec2 {
        0.5 * (self.low + self.high)
    }

    fn half_size(&self) -> Vec2 {
        0.5 * (self.high - self.low)
    }

    /// Returns this box, limited to a few times the size of `start` around it, so that a body that flies away does not
    /// reduce the others to dots.
    pub fn limit_to(&self, start: &Self) -> Self {
        if start.is_empty() || self.is_empty() {
            return *self;
        }
        let half = start.half_size();
        let max_reach = MAX_WIDENING * half.x.max(half.y);
        let (center, reach) = (start.center(), Vec2::new(max_reach, max_reach));
        if !(max_reach > 0.0) {
            return *self;
        }
        let (low, high) = (center - reach, center + reach);
        Self {
            low: Vec2::new(self.low.x.max(low.x), self.low.y.max(low.y)),
            high: Vec2::new(self.high.x.min(high.x), self.high.y.min(high.y)),
        }
    }
}

/// The map from the plane to pixels. In the plane y points up, and in the picture it points down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    size: Size,
    center: Vec2,
    /// The number of pixels per length unit, which is positive and finite.
    scale: f64,
}

impl View {
    /// Returns the view of a scene: its own viewport, or the box of its bodies with a margin.
    pub fn for_scene(scene: &Scene, extent: &Extent, size: Size) -> Self {
        match scene.display.viewport {
            // Zero and negative sizes mean that the view fits the scene.
            Some(Viewport { center, size: half }) if half > 0.0 => Self::new(center, [half, half], size),
            _ if extent.is_empty() => Self::new(Vec2::zeros(), [1.0, 1.0], size),
            _ => {
                let half = MARGIN * extent.half_size();
                Self::new(extent.center(), [half.x, half.y], size)
            }
        }
    }

    /// Creates the view that shows at least `half` on every side of `center`.
    fn new(center: Vec2, [x, y]: [f64; 2], size: Size) -> Self {
        let scale = (0.5 * f64::from(size.width()) / x).min(0.5 * f64::from(size.height()) / y);
        // If there is a single point or none, the view shows one length unit on every side.
        let fallback = 0.5 * f64::from(size.width().min(size.height()));
        let scale = if scale.is_finite() && scale > 0.0 { scale } else { fallback };
        let center =
            if center.x.abs() < MAX_COORDINATE && center.y.abs() < MAX_COORDINATE { center } else { Vec2::zeros() };
        Self { size, center, scale }
    }

    /// Returns the size of the picture.
    pub const fn size(&self) -> Size {
        self.size
    }

    /// Returns a point of the plane in pixels, from the upper left corner.
    pub fn to_pixels(&self, point: Vec2) -> [f64; 2] {
        let relative = self.scale * (point - self.center);
        [0.5 * f64::from(self.size.width()) + relative.x, 0.5 * f64::from(self.size.height()) - relative.y]
    }

    /// Returns a length in pixels.
    pub fn to_pixel_length(&self, length: f64) -> f64 {
        self.scale * length
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_model::scene::original;

    fn scene(more: &str) -> Scene {
        let xml = format!(
            r#"<scene><duration time="1"/>{more}<integrator type="explicit-euler" dt="0.1"/>
            <particle m="1" px="-2" py="0" vx="0" vy="0" fixed="0" radius="0.5"/>
            <particle m="1" px="2" py="1" vx="0" vy="0" fixed="0" radius="0.5"/></scene>"#
        );
        original::read(xml.as_bytes()).unwrap().scene
    }

    fn view(scene: &Scene, positions: &[f64]) -> View {
        View::for_scene(scene, &Extent::for_scene(scene, positions), Size::new(200, 100).unwrap())
    }

    #[test]
    fn everything_is_inside_and_up_is_up() {
        let view = view(&scene(""), &[-2.0, 0.0, 2.0, 1.0]);
        let [left, low] = view.to_pixels(Vec2::new(-2.5, -0.5));
        let [right, high] = view.to_pixels(Vec2::new(2.5, 1.5));
        assert!(0.0 <= left && left < right && right <= 200.0 && 0.0 <= high && high < low && low <= 100.0);
        assert_eq!(view.to_pixels(Vec2::new(0.0, 0.5)), [100.0, 50.0]);
    }

    #[test]
    fn the_scenes_viewport_wins_and_zero_means_fit() {
        let own = view(&scene(r#"<viewport cx="1" cy="2" size="5"/>"#), &[0.0; 4]);
        assert_eq!((own.to_pixels(Vec2::new(1.0, 2.0)), own.to_pixel_length(5.0)), ([100.0, 50.0], 50.0));
        let positions = [-2.0, 0.0, 2.0, 1.0];
        assert_eq!(view(&scene(r#"<viewport cx="1" cy="2" size="0"/>"#), &positions), view(&scene(""), &positions));
    }

    #[test]
    fn nonsense_positions_leave_a_usable_view() {
        for positions in [[f64::NAN; 4], [1e300, -1e300, f64::INFINITY, 0.0], [0.0; 4]] {
            let view = view(&scene(""), &positions);
            assert!(view.scale > 0.0 && view.scale.is_finite(), "{positions:?}");
        }
        let empty = Scene { particles: Vec::new(), ..scene("") };
        assert_eq!(view(&empty, &[]).to_pixel_length(1.0), 50.0);
    }

    #[test]
    fn a_body_that_flies_away_does_not_make_the_others_dots() {
        let scene = scene("");
        let start = Extent::for_scene(&scene, &[-2.0, 0.0, 2.0, 1.0]);
        let mut run = start;
        run.add(&scene, &[-2.0, 0.0, 5000.0, 1.0]);
        assert_eq!(run.limit_to(&start).high.x, 10.0);
        assert_eq!(start.limit_to(&start), start);
    }
}
