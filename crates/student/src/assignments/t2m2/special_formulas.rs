//! Wrong formulas that are not edits of a correct one. Here, overlap and approach are the names of polynomials
//! (collisions.md 2).
use super::{Inputs, Subject, formulas::readings, inputs::square_root};
use fosssim_num::bounded::{BoundedValue, BoundedVector};

/// Returns the approach of the particle to the point of the edge that was closest at the start.
pub(super) fn constant_alpha(inputs: &Inputs) -> Vec<BoundedValue> {
    let (closing, n) = closest_at_start(inputs);
    vec![-closing.dot(closing), closing.dot(n)]
}

/// Returns the overlap with the point of the edge that was closest at the start.
pub(super) fn overlap_constant_alpha(inputs: &Inputs) -> Vec<BoundedValue> {
    let (closing, n) = closest_at_start(inputs);
    vec![-closing.dot(closing), 2.0 * closing.dot(n), inputs.square - n.dot(n)]
}

/// Returns two vectors for the point of the edge's line that is closest at the start. They are the particle's
/// displacement relative to this point, and the vector from the particle to the point at the start.
fn closest_at_start(inputs: &Inputs) -> (BoundedVector, BoundedVector) {
    let edge = inputs.x32();
    let alpha = inputs.x12().dot(edge) / edge.dot(edge);
    (inputs.d12() - alpha * inputs.d32(), alpha * edge - inputs.x12())
}

/// Returns the overlap with an edge, in which the squared radii are not multiplied by the edge's squared length.
pub(super) fn unscaled_radius(inputs: &Inputs) -> Vec<BoundedValue> {
    let quartic = &readings(Subject::EdgeOverlap)[0];
    let mut list = quartic.polynomial(&Inputs { square: BoundedValue::from_exact(0.0), ..*inputs });
    list[quartic.degree] = list[quartic.degree] + inputs.square;
    list
}

/// Returns the polynomial alpha < 1, in which the constant 1 is not multiplied by the edge's squared length.
pub(super) fn unscaled_alpha_below_one(inputs: &Inputs) -> Vec<BoundedValue> {
    let (w0, w1, e0, e1) = (inputs.x12(), inputs.d12(), inputs.x32(), inputs.d32());
    vec![-w1.dot(e1), -(w0.dot(e1) + w1.dot(e0)), BoundedValue::from_exact(1.0) - w0.dot(e0)]
}

/// Returns the overlap with a half-plane as a difference of lengths.
pub(super) fn signed_distance(inputs: &Inputs) -> Vec<BoundedValue> {
    let n = inputs.normal();
    vec![-inputs.d[0].dot(n), inputs.radii[0] * square_root(n.dot(n)) + inputs.x21().dot(n)]
}

/// Returns the overlap with the half-plane's point, as if it were a particle without a radius.
pub(super) fn overlap_to_point(inputs: &Inputs) -> Vec<BoundedValue> {
    let (d, x) = (inputs.d[0], inputs.x21());
    vec![-d.dot(d), 2.0 * x.dot(d), inputs.square - x.dot(x)]
}

/// Returns the approach to a half-plane, in which the factor of the speed along the normal is missing.
pub(super) fn approach_without_speed(inputs: &Inputs) -> Vec<BoundedValue> {
    let n = inputs.normal();
    vec![-inputs.d[0].dot(n), inputs.x21().dot(n)]
}

/// Returns only the speed along the normal.
pub(super) fn normal_speed(inputs: &Inputs) -> Vec<BoundedValue> {
    vec![inputs.d[0].dot(inputs.normal())]
}

/// Returns the overlap with a half-plane whose distance is not squared.
pub(super) fn unsquared_offset(inputs: &Inputs) -> Vec<BoundedValue> {
    let (speed, offset) = (inputs.d[0].dot(inputs.normal()), inputs.x21().dot(inputs.normal()));
    vec![-(speed * speed), 2.0 * (speed * offset), inputs.square * inputs.normal_square - offset]
}

/// Returns the approach to a half-plane whose constant term lacks the speed.
pub(super) fn constant_without_speed(inputs: &Inputs) -> Vec<BoundedValue> {
    let speed = inputs.d[0].dot(inputs.normal());
    vec![-(speed * speed), inputs.x21().dot(inputs.normal())]
}

/// Returns only the negative speed along the normal.
pub(super) fn negative_normal_speed(inputs: &Inputs) -> Vec<BoundedValue> {
    vec![-inputs.d[0].dot(inputs.normal())]
}
