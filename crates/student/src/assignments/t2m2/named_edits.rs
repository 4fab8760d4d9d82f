//! Changes of formulas that have a name. Most are right formulas with wrong inputs, such as positions at the end of the
//! step, a missing displacement, or radii squared separately. The others are wrong formulas.
use super::{
    Inputs, Subject,
    edits::{
        FormulaEdit::{Formula, OtherInputs},
        NamedEdit,
    },
    inputs::square_root,
    special_formulas::*,
};
use fosssim_model::sim::PairKind;
use fosssim_num::bounded::{BoundedValue, BoundedVector};

const PP: PairKind = PairKind::ParticleParticle;
const PE: PairKind = PairKind::ParticleEdge;
const PH: PairKind = PairKind::ParticleHalfPlane;
const ZERO_VECTOR: BoundedVector = BoundedVector { x: BoundedValue::from_exact(0.0), y: BoundedValue::from_exact(0.0) };

/// Returns the positions at the end of the step.
fn end_positions(inputs: &Inputs) -> [BoundedVector; 3] {
    std::array::from_fn(|body| inputs.x[body] + inputs.d[body])
}

fn square(value: BoundedValue) -> BoundedValue {
    value * value
}

/// Sets one component of all vectors to 0.
fn drop_component(inputs: &mut Inputs, component: fn(&mut BoundedVector) -> &mut BoundedValue) {
    inputs.x.iter_mut().chain(&mut inputs.d).for_each(|vector| *component(vector) = BoundedValue::from_exact(0.0));
    inputs.normal_square = inputs.normal().dot(inputs.normal());
}

/// Returns the change with the given key, or `None` if there is none.
pub fn find_edit(key: &str) -> Option<&'static NamedEdit> {
    NAMED_EDITS.iter().find(|edit| edit.key == key)
}

/// Declares the named changes. A row contains the name of the constant, the key, the kinds of pairs, the cost, the
/// change, the sentence and the detail.
macro_rules! named_edits {
    ($($name:ident $key:literal $kinds:tt $cost:literal: $edit:expr => $sentence:literal => $detail:literal;)*) => {
        $(#[doc = $sentence]
        pub(super) const $name: NamedEdit = NamedEdit {
            key: $key,
            sentence: $sentence,
            detail: $detail,
            cost: $cost,
            kinds: &$kinds,
            edit: $edit,
        };)*

        /// All named changes, in the order of the table.
        pub const NAMED_EDITS: &[NamedEdit] = &[$($name,)*];
    };
}

named_edits! {
    END_POSITIONS "end-positions" [PP, PE, PH] 4.0: OtherInputs(|inputs| inputs.x = end_positions(inputs))
        => "The formulas use positions at the end of the step"
        => "the positions x are those at the end of the step instead of the start";
    END_FOR_DISPLACEMENT "end-for-displacement" [PP, PE, PH] 4.0: OtherInputs(|inputs| inputs.d = end_positions(inputs))
        => "Positions at the end of the step are used instead of displacements"
        => "the displacements dx are end positions instead of end minus start";
    DISPLACEMENT_REVERSED "displacement-reversed" [PP, PE, PH] 4.2:
        OtherInputs(|inputs| inputs.d = inputs.d.map(|d| ZERO_VECTOR - d))
        => "All displacements have the wrong sign"
        => "the displacements dx are start minus end instead of end minus start";
    PARTICLE_STILL "particle-still" [PP, PE] 4.0: OtherInputs(|inputs| inputs.d[0] = ZERO_VECTOR)
        => "The first particle's displacement is missing" => "dx1 is 0 in the formulas";
    SECOND_PARTICLE_STILL "second-particle-still" [PP] 4.0: OtherInputs(|inputs| inputs.d[1] = ZERO_VECTOR)
        => "The second particle's displacement is missing" => "dx2 is 0 in the formulas";
    EDGE_STILL "edge-still" [PE] 4.0: OtherInputs(|inputs| (inputs.d[1], inputs.d[2]) = (ZERO_VECTOR, ZERO_VECTOR))
        => "The edge is treated as if it did not move" => "dx2 and dx3 are 0 in the formulas";
    FIRST_END_STILL "first-end-still" [PE] 4.1: OtherInputs(|inputs| inputs.d[1] = ZERO_VECTOR)
        => "The displacement of the edge's first endpoint is missing" => "dx2 is 0 in the formulas";
    SECOND_END_STILL "second-end-still" [PE] 4.1: OtherInputs(|inputs| inputs.d[2] = ZERO_VECTOR)
        => "The displacement of the edge's second endpoint is missing" => "dx3 is 0 in the formulas";
    FIRST_DISPLACEMENT_TWICE "first-displacement-twice" [PE] 4.2: OtherInputs(|inputs| inputs.d[2] = inputs.d[1])
        => "The first endpoint's displacement is used for both endpoints" => "dx2 is used instead of dx3";
    SECOND_DISPLACEMENT_TWICE "second-displacement-twice" [PE] 4.2: OtherInputs(|inputs| inputs.d[1] = inputs.d[2])
        => "The second endpoint's displacement is used for both endpoints" => "dx3 is used instead of dx2";
    DISPLACEMENTS_SWAPPED "displacements-swapped" [PE] 4.2: OtherInputs(|inputs| inputs.d.swap(1, 2))
        => "The endpoints' displacements are exchanged" => "dx2 and dx3 are exchanged";
    ENDPOINTS_SWAPPED "endpoints-swapped" [PE] 4.3: OtherInputs(|inputs| { inputs.x.swap(1, 2); inputs.d.swap(1, 2); })
        => "The edge's endpoints are exchanged" => "x2 and x3 are exchanged, and dx2 and dx3";
    END_PARTICLE_POSITION "end-particle-position" [PP, PE] 4.5:
        OtherInputs(|inputs| inputs.x[0] = inputs.x[0] + inputs.d[0])
        => "The first particle's position is the one at the end of the step"
        => "x1 is the position at the end of the step";
    SECOND_PARTICLE_AT_END "second-particle-at-end" [PP] 4.6:
        OtherInputs(|inputs| inputs.x[1] = inputs.x[1] + inputs.d[1])
        => "The second particle's position is the one at the end of the step"
        => "x2 is the position at the end of the step";
    FIRST_END_AT_END "first-end-at-end" [PE] 4.6: OtherInputs(|inputs| inputs.x[1] = inputs.x[1] + inputs.d[1])
        => "The position of the edge's first endpoint is the one at the end of the step"
        => "x2 is the position at the end of the step";
    SECOND_END_AT_END "second-end-at-end" [PE] 4.6: OtherInputs(|inputs| inputs.x[2] = inputs.x[2] + inputs.d[2])
        => "The position of the edge's second endpoint is the one at the end of the step"
        => "x3 is the position at the end of the step";
    RADII_SQUARED_APART "radii-squared-apart" [PP, PE] 2.6:
        OtherInputs(|inputs| inputs.square = square(inputs.radii[0]) + square(inputs.radii[1]))
        => "The radii are squared separately" => "r1^2 + r2^2 is used instead of R^2 = (r1 + r2)^2";
    RADIUS_NOT_SQUARED "radius-not-squared" [PP, PE, PH] 2.7:
        OtherInputs(|inputs| inputs.square = inputs.radii[0] + inputs.radii[1])
        => "The radius, or the sum of the radii, is not squared" => "R is used instead of R^2";
    NO_RADIUS "no-radius" [PP, PE, PH] 2.9: OtherInputs(|inputs| inputs.square = BoundedValue::from_exact(0.0))
        => "The radii are missing" => "0 is used instead of R^2";
    FIRST_RADIUS_ONLY "first-radius-only" [PP, PE] 2.75: OtherInputs(|inputs| inputs.square = square(inputs.radii[0]))
        => "The second object's radius is missing" => "r1^2 is used instead of R^2 = (r1 + r2)^2";
    SECOND_RADIUS_ONLY "second-radius-only" [PP, PE] 2.8: OtherInputs(|inputs| inputs.square = square(inputs.radii[1]))
        => "The first particle's radius is missing" => "r2^2 is used instead of R^2 = (r1 + r2)^2";
    FIRST_RADIUS_TWICE "first-radius-twice" [PP, PE] 3.1:
        OtherInputs(|inputs| inputs.square = 4.0 * square(inputs.radii[0]))
        => "The first object's radius is used for both objects" => "(r1 + r1)^2 is used instead of R^2 = (r1 + r2)^2";
    SECOND_RADIUS_TWICE "second-radius-twice" [PP, PE] 3.1:
        OtherInputs(|inputs| inputs.square = 4.0 * square(inputs.radii[1]))
        => "The second object's radius is used for both objects" => "(r2 + r2)^2 is used instead of R^2 = (r1 + r2)^2";
    RADII_SUBTRACTED "radii-subtracted" [PP, PE] 4.5:
        OtherInputs(|inputs| inputs.square = square(inputs.radii[0] - inputs.radii[1]))
        => "The radii are subtracted instead of added" => "(r1 - r2)^2 is used instead of R^2 = (r1 + r2)^2";
    DIAMETERS "diameters" [PP, PE, PH] 3.05: OtherInputs(|inputs| inputs.square = 4.0 * inputs.square)
        => "Diameters are used instead of radii" => "(2 R)^2 is used instead of R^2";
    RADIUS_SUBTRACTED "radius-subtracted" [PP, PE, PH] 4.4: OtherInputs(|inputs| inputs.square = -inputs.square)
        => "The radius terms have the wrong sign" => "-R^2 is used instead of R^2";
    RADIUS_HALVED "radius-halved" [PP, PE, PH] 4.2: OtherInputs(|inputs| inputs.square = 0.25 * inputs.square)
        => "Half the radius is used" => "(R/2)^2 is used instead of R^2";
    NO_POINT "no-point" [PH] 4.0: OtherInputs(|inputs| inputs.x[1] = ZERO_VECTOR)
        => "The half-plane's point is forgotten, as if the boundary went through the origin"
        => "-x is used instead of p - x";
    POINT_AND_NORMAL_SWAPPED "point-and-normal-swapped" [PH] 4.2: OtherInputs(|inputs| {
        inputs.x.swap(1, 2);
        inputs.normal_square = inputs.normal().dot(inputs.normal());
    })
        => "The half-plane's point and its normal are exchanged" => "p and n are exchanged";
    NO_NORMAL_SQUARE "no-normal-square" [PH] 2.6: OtherInputs(|inputs| {
        inputs.normal_square = BoundedValue::from_exact(1.0);
    })
        => "The radius term is right only for unit normals" => "r^2 is used instead of r^2 (n.n)";
    NORMAL_LENGTH "normal-length" [PH] 2.7: OtherInputs(|inputs| {
        inputs.normal_square = square_root(inputs.normal_square);
    })
        => "The radius term has the length of the normal instead of its square"
        => "r^2 |n| is used instead of r^2 (n.n)";
    REVERSED_OFFSET "reversed-offset" [PH] 4.1: OtherInputs(|inputs| inputs.x.swap(0, 1))
        => "The vector from the particle to the half-plane is reversed"
        => "x - p is used instead of p - x";
    X_ONLY "x-only" [PP, PE, PH] 5.0: OtherInputs(|inputs| drop_component(inputs, |vector| &mut vector.y))
        => "The second components of all vectors are missing"
        => "x x' is used instead of x x' + y y' in all dot products";
    Y_ONLY "y-only" [PP, PE, PH] 5.0: OtherInputs(|inputs| drop_component(inputs, |vector| &mut vector.x))
        => "The first components of all vectors are missing"
        => "y y' is used instead of x x' + y y' in all dot products";
    CONSTANT_ALPHA "constant-alpha" [PE] 2.5: Formula(Subject::EdgeApproach, constant_alpha)
        => "alpha is treated as constant during the step"
        => "alpha is (x12.x32)/(x32.x32) at the start of the step and does not depend on t";
    OVERLAP_CONSTANT_ALPHA "overlap-constant-alpha" [PE] 2.5: Formula(Subject::EdgeOverlap, overlap_constant_alpha)
        => "alpha is treated as constant in the overlap, so the point of the edge that is closest at the start counts"
        => "alpha is (x12.x32)/(x32.x32) at the start of the step and does not depend on t";
    RADIUS_UNSCALED "radius-unscaled" [PE] 2.5: Formula(Subject::EdgeOverlap, unscaled_radius)
        => "The radii are not multiplied by the edge's squared length when the denominator is cleared"
        => "R^2 is used instead of R^2 (x32 + t d32).(x32 + t d32)";
    ONE_UNSCALED "one-unscaled" [PE] 2.5: Formula(Subject::AlphaHigh, unscaled_alpha_below_one)
        => "The constant in alpha < 1 is not multiplied by the edge's squared length when the denominator is cleared"
        => "1 is used instead of (x32 + t d32).(x32 + t d32)";
    SIGNED_DISTANCE "signed-distance" [PH] 2.5: Formula(Subject::HalfPlaneOverlap, signed_distance)
        => "The overlap is a signed distance, which is right only on one side of the boundary"
        => "the polynomial is -(dx.n) t + r |n| + (p-x).n, a difference of lengths instead of squares";
    NO_SPEED_FACTOR "no-speed-factor" [PH] 2.5: Formula(Subject::HalfPlaneApproach, approach_without_speed)
        => "The approach does not take the side of the half-plane into account: it is right only on one side"
        => "the factor (dx.n) is missing";
    SPEED_ONLY "speed-only" [PH] 2.5: Formula(Subject::HalfPlaneApproach, normal_speed)
        => "The approach uses only the velocity, not the side of the half-plane"
        => "the polynomial is (dx.n), a constant";
}
