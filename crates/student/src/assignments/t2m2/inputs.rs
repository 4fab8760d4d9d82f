//! The inputs of a detection's formulas.
use fosssim_judge::fair::formulas::BoundedPointMotion;
use fosssim_model::sim::{PairKind, PairMotion};
use fosssim_num::{
    bounded::{BoundedValue, BoundedVector},
    vector::Vec2,
};

/// The numbers used in the formulas, with error bounds. An explanation may replace them.
#[derive(Debug, Clone, Copy)]
pub struct Inputs {
    /// The start positions of the particle and of the other one or two points. For a half-plane, these are its point
    /// and its normal.
    pub x: [BoundedVector; 3],
    /// The displacements of the same points. A half-plane has none.
    pub d: [BoundedVector; 3],
    /// The radius of the particle, and that of the other object. A half-plane has the radius 0.
    pub radii: [BoundedValue; 2],
    /// The square of the sum of the radii.
    pub square: BoundedValue,
    /// The squared length of the normal, or 0 if there is no normal.
    pub normal_square: BoundedValue,
}

impl Inputs {
    /// Creates the inputs of the formulas from a pair's motion.
    pub fn new(motion: &PairMotion) -> Self {
        let way = BoundedPointMotion::from;
        let at_rest = |point: Vec2| BoundedPointMotion {
            start: BoundedVector::from_exact(point),
            shift: BoundedVector::default(),
        };
        let (ways, radii) = match *motion {
            PairMotion::Particles { centers: [one, two], radii } => {
                ([way(one), way(two), at_rest(Vec2::zeros())], radii)
            }
            PairMotion::Edge { center, ends: [first, second], radii } => ([center, first, second].map(way), radii),
            PairMotion::HalfPlane { center, radius, point, normal } => {
                ([way(center), at_rest(point), at_rest(normal)], [radius, 0.0])
            }
        };
        let radii = radii.map(BoundedValue::from_exact);
        let reach = radii[0] + radii[1];
        let (x, d) = (ways.map(|way| way.start), ways.map(|way| way.shift));
        let normal_square =
            if motion.kind() == PairKind::ParticleHalfPlane { x[2].dot(x[2]) } else { BoundedValue::default() };
        Self { x, d, radii, square: reach * reach, normal_square }
    }
}

/// Returns the square root of a nonnegative number.
pub(super) fn square_root(square: BoundedValue) -> BoundedValue {
    let value = square.value.sqrt();
    BoundedValue { value, bound: value + if value > 0.0 { square.bound / value } else { 0.0 } }
}

/// The differences are named as in the formulas: `12` is "1 minus 2", where 1 is the particle, and 2 and 3 are the
/// edge's endpoints.
impl Inputs {
    pub(crate) fn x12(&self) -> BoundedVector {
        self.x[0] - self.x[1]
    }
    pub(crate) fn x21(&self) -> BoundedVector {
        self.x[1] - self.x[0]
    }
    pub(crate) fn x32(&self) -> BoundedVector {
        self.x[2] - self.x[1]
    }
    pub(crate) fn x13(&self) -> BoundedVector {
        self.x[0] - self.x[2]
    }
    pub(crate) fn x23(&self) -> BoundedVector {
        self.x[1] - self.x[2]
    }
    pub(crate) fn d12(&self) -> BoundedVector {
        self.d[0] - self.d[1]
    }
    pub(crate) fn d21(&self) -> BoundedVector {
        self.d[1] - self.d[0]
    }
    pub(crate) fn d32(&self) -> BoundedVector {
        self.d[2] - self.d[1]
    }
    pub(crate) fn d13(&self) -> BoundedVector {
        self.d[0] - self.d[2]
    }
    pub(crate) fn d23(&self) -> BoundedVector {
        self.d[1] - self.d[2]
    }
    /// Returns the normal of the half-plane.
    pub fn normal(&self) -> BoundedVector {
        self.x[2]
    }
}
