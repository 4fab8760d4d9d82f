//! Right formulas of wrong inputs: positions at the end of the step, a displacement forgotten, radii squared apart.
use super::{Inputs, inputs::root};
use fosssim_model::sim::PairKind;
use fosssim_num::bounded::{BoundedValue, BoundedVector};

/// One input that is used instead of another.
pub struct Exchange {
    /// The explanation's key.
    pub key: &'static str,
    /// The explanation's sentence, without its full stop.
    pub sentence: &'static str,
    /// The exact form.
    pub detail: &'static str,
    /// The cost of the guess; see `study`.
    pub cost: f64,
    kinds: &'static [PairKind],
    /// Makes the exchange.
    pub apply: fn(&mut Inputs),
}

impl Exchange {
    /// Returns whether it makes sense for this kind of pair.
    #[must_use]
    pub fn concerns(&self, kind: PairKind) -> bool {
        self.kinds.contains(&kind)
    }
}

const PP: PairKind = PairKind::ParticleParticle;
const PE: PairKind = PairKind::ParticleEdge;
const PH: PairKind = PairKind::ParticleHalfPlane;
const NOTHING: BoundedVector = BoundedVector { x: BoundedValue::exact(0.0), y: BoundedValue::exact(0.0) };

/// Positions at the end of the step.
fn ends(inputs: &Inputs) -> [BoundedVector; 3] {
    std::array::from_fn(|body| inputs.x[body] + inputs.d[body])
}

fn square(value: BoundedValue) -> BoundedValue {
    value * value
}

/// Leaves one component of all vectors out.
fn without(inputs: &mut Inputs, component: fn(&mut BoundedVector) -> &mut BoundedValue) {
    inputs.x.iter_mut().chain(&mut inputs.d).for_each(|vector| *component(vector) = BoundedValue::exact(0.0));
    inputs.normal_square = inputs.normal().dot(inputs.normal());
}

/// Finds the exchange with this key.
#[must_use]
pub fn find_exchange(key: &str) -> Option<&'static Exchange> {
    EXCHANGES.iter().find(|exchange| exchange.key == key)
}

/// The table: key, kinds of pairs, how unlikely it is, and the exchange; the sentence; the exact form.
macro_rules! exchanges {
    ($($key:literal $kinds:tt $cost:literal: $apply:expr => $sentence:literal => $detail:literal;)*) => {
        /// All exchanges.
        pub const EXCHANGES: &[Exchange] = &[$(Exchange {
            key: $key,
            sentence: $sentence,
            detail: $detail,
            cost: $cost,
            kinds: &$kinds,
            apply: $apply,
        },)*];
    };
}

exchanges! {
    "end-positions" [PP, PE, PH] 4.0: |inputs| inputs.x = ends(inputs)
        => "The formulas use positions at the end of the step"
        => "the positions x are those at the end of the step, expected those at its start";
    "end-for-displacement" [PP, PE, PH] 4.0: |inputs| inputs.d = ends(inputs)
        => "Positions at the end of the step are used instead of displacements"
        => "the displacements dx are end positions, expected end minus start";
    "displacement-reversed" [PP, PE, PH] 4.2: |inputs| inputs.d = inputs.d.map(|d| NOTHING - d)
        => "All displacements have the wrong sign"
        => "the displacements dx are start minus end, expected end minus start";
    "particle-still" [PP, PE] 4.0: |inputs| inputs.d[0] = NOTHING
        => "The first particle's displacement is forgotten" => "dx1 is 0 in the formulas";
    "second-particle-still" [PP] 4.0: |inputs| inputs.d[1] = NOTHING
        => "The second particle's displacement is forgotten" => "dx2 is 0 in the formulas";
    "edge-still" [PE] 4.0: |inputs| (inputs.d[1], inputs.d[2]) = (NOTHING, NOTHING)
        => "The edge is treated as if it did not move" => "dx2 and dx3 are 0 in the formulas";
    "first-end-still" [PE] 4.1: |inputs| inputs.d[1] = NOTHING
        => "The displacement of the edge's first endpoint is forgotten" => "dx2 is 0 in the formulas";
    "second-end-still" [PE] 4.1: |inputs| inputs.d[2] = NOTHING
        => "The displacement of the edge's second endpoint is forgotten" => "dx3 is 0 in the formulas";
    "first-displacement-twice" [PE] 4.2: |inputs| inputs.d[2] = inputs.d[1]
        => "The first endpoint's displacement is used for both endpoints" => "dx2 is used instead of dx3";
    "second-displacement-twice" [PE] 4.2: |inputs| inputs.d[1] = inputs.d[2]
        => "The second endpoint's displacement is used for both endpoints" => "dx3 is used instead of dx2";
    "displacements-swapped" [PE] 4.2: |inputs| inputs.d.swap(1, 2)
        => "The endpoints' displacements are exchanged" => "dx2 and dx3 are exchanged";
    "endpoints-swapped" [PE] 4.3: |inputs| { inputs.x.swap(1, 2); inputs.d.swap(1, 2); }
        => "The edge's endpoints are exchanged" => "x2 and x3 are exchanged, and dx2 and dx3";
    "end-particle-position" [PP, PE] 4.5: |inputs| inputs.x[0] = inputs.x[0] + inputs.d[0]
        => "The first particle's position is the one at the end of the step"
        => "x1 is the position at the end of the step";
    "radii-squared-apart" [PP, PE] 2.6: |inputs| inputs.square = square(inputs.radii[0]) + square(inputs.radii[1])
        => "Each radius is squared for itself" => "r1^2 + r2^2 is used instead of R^2 = (r1 + r2)^2";
    "radius-not-squared" [PP, PE, PH] 2.7: |inputs| inputs.square = inputs.radii[0] + inputs.radii[1]
        => "The radius, or the sum of the radii, is not squared" => "R is used instead of R^2";
    "no-radius" [PP, PE, PH] 2.9: |inputs| inputs.square = BoundedValue::exact(0.0)
        => "The radii are forgotten" => "0 is used instead of R^2";
    "first-radius-only" [PP, PE] 2.75: |inputs| inputs.square = square(inputs.radii[0])
        => "The second object's radius is forgotten" => "r1^2 is used instead of R^2 = (r1 + r2)^2";
    "second-radius-only" [PP, PE] 2.8: |inputs| inputs.square = square(inputs.radii[1])
        => "The first particle's radius is forgotten" => "r2^2 is used instead of R^2 = (r1 + r2)^2";
    "first-radius-twice" [PP, PE] 3.1: |inputs| inputs.square = 4.0 * square(inputs.radii[0])
        => "The first object's radius is used for both objects" => "(r1 + r1)^2 is used instead of R^2 = (r1 + r2)^2";
    "second-radius-twice" [PP, PE] 3.1: |inputs| inputs.square = 4.0 * square(inputs.radii[1])
        => "The second object's radius is used for both objects" => "(r2 + r2)^2 is used instead of R^2 = (r1 + r2)^2";
    "radii-subtracted" [PP, PE] 4.5: |inputs| inputs.square = square(inputs.radii[0] - inputs.radii[1])
        => "The radii are subtracted instead of added" => "(r1 - r2)^2 is used instead of R^2 = (r1 + r2)^2";
    "diameters" [PP, PE, PH] 3.05: |inputs| inputs.square = 4.0 * inputs.square
        => "Diameters are used instead of radii" => "(2 R)^2 is used instead of R^2";
    "radius-subtracted" [PP, PE, PH] 4.4: |inputs| inputs.square = -inputs.square
        => "The radius terms have the wrong sign" => "-R^2 is used instead of R^2";
    "radius-halved" [PP, PE, PH] 4.2: |inputs| inputs.square = 0.25 * inputs.square
        => "Half the radius is used" => "(R/2)^2 is used instead of R^2";
    "no-point" [PH] 4.0: |inputs| inputs.x[1] = NOTHING
        => "The half-plane's point is forgotten, as if the boundary went through the origin"
        => "-x is used instead of p - x";
    "point-and-normal-swapped" [PH] 4.2: |inputs| {
        inputs.x.swap(1, 2);
        inputs.normal_square = inputs.normal().dot(inputs.normal());
    }
        => "The half-plane's point and its normal are exchanged" => "p and n are exchanged";
    "no-normal-square" [PH] 2.6: |inputs| inputs.normal_square = BoundedValue::exact(1.0)
        => "The radius term is right for unit normals only" => "r^2 is used instead of r^2 (n.n)";
    "normal-length" [PH] 2.7: |inputs| inputs.normal_square = root(inputs.normal_square)
        => "The radius term has the length of the normal instead of its square"
        => "r^2 |n| is used instead of r^2 (n.n)";
    "reversed-offset" [PH] 4.1: |inputs| inputs.x.swap(0, 1)
        => "The vector from the particle to the half-plane is taken the other way round"
        => "x - p is used instead of p - x";
    "x-only" [PP, PE, PH] 5.0: |inputs| without(inputs, |vector| &mut vector.y)
        => "The second components of all vectors are left out" => "all dot products are x x' without y y'";
    "y-only" [PP, PE, PH] 5.0: |inputs| without(inputs, |vector| &mut vector.x)
        => "The first components of all vectors are left out" => "all dot products are y y' without x x'";
}
