//! Correct programs that compute in other coordinates than the scene's. The choice of coordinates changes no event.
use fosssim_num::vector::Vec2;

use crate::{Area, Mistake, author::Student};

/// The areas of the assignment whose mistakes this module simulates.
const MODULE_AREAS: &[Area] = &[Area::Handover];

/// The origin of a program whose coordinates are shifted.
const ORIGIN: Vec2 = Vec2::new(2.7, -1.3);

/// The cosine and sine of the angle by which a program rotates its coordinates. The angle of the right triangle with
/// the sides 3, 4 and 5 is unsuitable, because products with its cosine and sine are often exact.
const ROTATION: (f64, f64) = (0.764_842_187_284_488_5, 0.644_217_687_237_691);

/// The coordinate axes in which a program computes.
#[derive(Clone, Copy)]
pub enum Axes {
    /// The axes are those of the scene.
    Scene,
    /// The axes have another origin.
    Shifted,
    /// The origin is the first particle of the pair in each detection, and moves with it.
    Comoving,
    /// The axes have other directions.
    Rotated,
}

impl Axes {
    /// Returns the axes in which a student computes.
    pub fn for_student(student: Student) -> Self {
        match student.mistake_in(MODULE_AREAS) {
            Some(Mistake::FrameShifted) => Self::Shifted,
            Some(Mistake::FrameComoving) => Self::Comoving,
            Some(Mistake::FrameRotated) => Self::Rotated,
            _ => Self::Scene,
        }
    }

    /// Returns a point of the scene in these axes. `particle` is the position of the pair's first particle at the same
    /// time.
    pub fn transform_point(self, point: Vec2, particle: Vec2) -> Vec2 {
        match self {
            Self::Scene => point,
            Self::Shifted => point - ORIGIN,
            Self::Comoving => point - particle,
            Self::Rotated => self.transform_direction(point),
        }
    }

    /// Returns a difference of points of the scene in these axes.
    pub fn transform_direction(self, v: Vec2) -> Vec2 {
        let (cosine, sine) = ROTATION;
        match self {
            Self::Rotated => Vec2::new(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y),
            _ => v,
        }
    }

    /// Returns, in the scene's axes, a difference of points that is given in these axes.
    pub fn transform_back(self, v: Vec2) -> Vec2 {
        let (cosine, sine) = ROTATION;
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
        let (cosine, sine) = ROTATION;
        assert!((cosine * cosine + sine * sine - 1.0).abs() < f64::EPSILON);
        let v = Vec2::new(3.0, -7.0);
        assert!(length(Axes::Rotated.transform_back(Axes::Rotated.transform_direction(v)) - v) < 1e-14);
    }
}
