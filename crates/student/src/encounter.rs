//! The two objects of a pair on their way through a step.
use fosssim_num::vector::Vec2;

/// A round body on its way through the step: it moves from `start` by `displacement`, evenly.
#[derive(Clone, Copy)]
pub struct MovingBody {
    /// The position of its center at the start of the step.
    pub start: Vec2,
    /// The displacement within the step.
    pub displacement: Vec2,
    /// The body's radius.
    pub radius: f64,
}

impl MovingBody {
    /// Returns the position of its center at time `t`, a fraction of the step.
    pub fn at(&self, t: f64) -> Vec2 {
        self.start + t * self.displacement
    }

    /// Returns the position of its center at the end of the step.
    pub fn end(&self) -> Vec2 {
        self.at(1.0)
    }
}

/// The two objects of a pair, ready for the formulas.
pub enum Encounter {
    /// Two particles.
    Particles(MovingBody, MovingBody),
    /// A particle, the edge's two endpoints, and the edge's radius.
    Edge([MovingBody; 3], f64),
    /// A particle, and the half-plane's point and normal.
    HalfPlane(MovingBody, Vec2, Vec2),
}

/// Returns the parameter of the closest point on the infinite line at time `t`: 0 at the first endpoint, 1 at the
/// second.
pub fn alpha([one, two, three]: &[MovingBody; 3], t: f64) -> f64 {
    let to_particle = one.start + t * one.displacement - two.start - t * two.displacement;
    let along = three.start + t * three.displacement - two.start - t * two.displacement;
    to_particle.dot(&along) / along.dot(&along)
}
