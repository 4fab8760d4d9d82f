//! Misunderstandings that have a formula of their own.
use super::{Inputs, Subject, formulas::readings, inputs::root};
use fosssim_num::bounded::{BoundedValue, BoundedVector};

/// A wrong polynomial, highest power first.
pub struct Special {
    /// The polynomial that it is about.
    pub subject: Subject,
    /// The explanation's key.
    pub key: &'static str,
    /// The explanation's sentence, without its full stop.
    pub sentence: &'static str,
    /// The exact form.
    pub detail: &'static str,
    /// The polynomial's coefficients.
    pub polynomial: fn(&Inputs) -> Vec<BoundedValue>,
}

/// Finds the misunderstanding with this key.
#[must_use]
pub fn find_special(key: &str) -> Option<&'static Special> {
    SPECIALS.iter().find(|special| special.key == key)
}

/// All special rows.
pub const SPECIALS: &[Special] = &[
    Special {
        subject: Subject::EdgeApproach,
        key: "constant-alpha",
        sentence: "alpha is treated as constant during the step",
        detail: "alpha is (x12.x32)/(x32.x32) at the start of the step and does not depend on t",
        polynomial: constant_alpha,
    },
    Special {
        subject: Subject::EdgeOverlap,
        key: "overlap-constant-alpha",
        sentence: "alpha is treated as constant in the overlap, so the point of the edge that is closest at the start counts",
        detail: "alpha is (x12.x32)/(x32.x32) at the start of the step and does not depend on t",
        polynomial: |inputs| {
            let (closing, n) = closest_at_start(inputs);
            vec![-closing.dot(closing), 2.0 * closing.dot(n), inputs.square - n.dot(n)]
        },
    },
    Special {
        subject: Subject::EdgeOverlap,
        key: "radius-unscaled",
        sentence: "The radii are not multiplied by the edge's squared length when the denominator is cleared",
        detail: "R^2 is used instead of R^2 (x32 + t d32).(x32 + t d32)",
        polynomial: |inputs| {
            let quartic = &readings(Subject::EdgeOverlap)[0];
            let mut list = quartic.polynomial(&Inputs { square: BoundedValue::exact(0.0), ..*inputs });
            list[quartic.degree] = list[quartic.degree] + inputs.square;
            list
        },
    },
    Special {
        subject: Subject::AlphaHigh,
        key: "one-unscaled",
        sentence: "The whole in alpha < 1 is not multiplied by the edge's squared length when the denominator is cleared",
        detail: "1 is used instead of (x32 + t d32).(x32 + t d32)",
        polynomial: |inputs| {
            let (w0, w1, e0, e1) = (inputs.x12(), inputs.d12(), inputs.x32(), inputs.d32());
            vec![-w1.dot(e1), -(w0.dot(e1) + w1.dot(e0)), BoundedValue::exact(1.0) - w0.dot(e0)]
        },
    },
    Special {
        subject: Subject::HalfPlaneOverlap,
        key: "signed-distance",
        sentence: "The overlap is a signed distance, which is right on one side of the boundary only",
        detail: "the polynomial is -(dx.n) t + r |n| + (p-x).n, the difference of two lengths, expected that of their squares",
        polynomial: |inputs| {
            let n = inputs.normal();
            vec![-inputs.d[0].dot(n), inputs.radii[0] * root(n.dot(n)) + inputs.x21().dot(n)]
        },
    },
    Special {
        subject: Subject::HalfPlaneApproach,
        key: "no-speed-factor",
        sentence: "The approach does not take the side of the half-plane into account: it is right on one side only",
        detail: "the factor (dx.n) is missing",
        polynomial: |inputs| {
            let n = inputs.normal();
            vec![-inputs.d[0].dot(n), inputs.x21().dot(n)]
        },
    },
    Special {
        subject: Subject::HalfPlaneApproach,
        key: "speed-only",
        sentence: "The approach uses only the velocity, not the side of the half-plane",
        detail: "the polynomial is (dx.n), a constant",
        polynomial: |inputs| vec![inputs.d[0].dot(inputs.normal())],
    },
];

/// Returns the approach of the particle and the point of the edge that was closest at the start.
fn constant_alpha(inputs: &Inputs) -> Vec<BoundedValue> {
    let (closing, n) = closest_at_start(inputs);
    vec![-closing.dot(closing), closing.dot(n)]
}

/// Returns the approach of the particle and the point of the edge that was closest at the start, and the vector between
/// them.
fn closest_at_start(inputs: &Inputs) -> (BoundedVector, BoundedVector) {
    let along = inputs.x32();
    let alpha = inputs.x12().dot(along) / along.dot(along);
    (inputs.d12() - alpha * inputs.d32(), alpha * along - inputs.x12())
}
