//! Correct programs that compute in other coordinates than the scene's: nothing that happens depends on them.
use fosssim_num::vector::Vec2;

use crate::{Area, Mistake, author::Student};

/// The parts of the assignment whose mistakes are made here.
const HERE: &[Area] = &[Area::Handover];

/// The origin of a program whose coordinates are those of the scene with another origin.
const ORIGIN: Vec2 = Vec2::new(2.7, -1.3);

/// Cosine and sine of the angle by which a program turns its coordinates: 3-4-5 would be too good, its products are
/// often exact.
const TURN: (f64, f64) = (0.764_842_187_284_488_5, 0.644_217_687_237_691);

/// A program's coordinates.
#[derive(Clone, Copy)]
pub enum Axes {
    /// The coordinates of the scene.
    Scene,
    /// Another origin.
    Shifted,
    /// Another origin in each detection, which moves with the first particle.
    Comoving,
    /// Other directions of the axes.
    Rotated,
}

impl Axes {
    /// Returns the coordinates that this student computes in.
    pub fn for_student(student: Student) -> Self {
        match student.mistake_in(HERE) {
            Some(Mistake::FrameShifted) => Self::Shifted,
            Some(Mistake::FrameComoving) => Self::Comoving,
            Some(Mistake::FrameRotated) => Self::Rotated,
            _ => Self::Scene,
        }
    }

    /// Returns a point of the scene in these coordinates; `particle` is where the pair's first particle is at the same
    /// time.
    pub fn point(self, point: Vec2, particle: Vec2) -> Vec2 {
        match self {
            Self::Scene => point,
            Self::Shifted => point - ORIGIN,
            Self::Comoving => point - particle,
            Self::Rotated => self.direction(point),
        }
    }

    /// Returns a difference of points in these coordinates.
    pub fn direction(self, v: Vec2) -> Vec2 {
        let (cosine, sine) = TURN;
        match self {
            Self::Rotated => Vec2::new(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y),
            _ => v,
        }
    }

    /// Returns the difference of points in the scene's coordinates.
    pub fn turn_back(self, v: Vec2) -> Vec2 {
        let (cosine, sine) = TURN;
        match self {
            Self::Rotated => Vec2::new(cosine * v.x + sine * v.y, cosine * v.y - sine * v.x),
            _ => v,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_num::vector::length;

    #[test]
    fn the_turn_is_a_rotation() {
        let (cosine, sine) = TURN;
        assert!((cosine * cosine + sine * sine - 1.0).abs() < f64::EPSILON);
        let v = Vec2::new(3.0, -7.0);
        assert!(length(Axes::Rotated.turn_back(Axes::Rotated.direction(v)) - v) < 1e-14);
    }
}
