//! Quantities that do not belong in a formula, but that students may use there.
use super::{Inputs, Subject, formulas::Letter, inputs::square_root};
use fosssim_num::bounded::{BoundedValue, BoundedVector};

/// Returns letters that do not belong in the formulas of a polynomial, but that students may use there.
pub fn extra_letters(subject: Subject) -> &'static [Letter] {
    match subject {
        Subject::ParticleOverlap | Subject::ParticleApproach => PARTICLE_EXTRAS,
        Subject::EdgeOverlap => QUARTIC_EXTRAS,
        Subject::AlphaLow | Subject::AlphaHigh => ALPHA_EXTRAS,
        Subject::EdgeApproach => &[],
        Subject::HalfPlaneOverlap | Subject::HalfPlaneApproach => HALF_PLANE_EXTRAS,
    }
}

fn length(vector: BoundedVector) -> BoundedValue {
    square_root(vector.dot(vector))
}

const fn letter(name: &'static str, order: u8, value: fn(&Inputs) -> BoundedValue) -> Letter {
    Letter { name, meaning: "", order, value }
}

const PARTICLE_EXTRAS: &[Letter] = &[
    letter("r1^2", 0, |inputs| inputs.radii[0] * inputs.radii[0]),
    letter("r2^2", 0, |inputs| inputs.radii[1] * inputs.radii[1]),
    letter("r1 r2", 0, |inputs| inputs.radii[0] * inputs.radii[1]),
    letter("r1", 0, |inputs| inputs.radii[0]),
    letter("r2", 0, |inputs| inputs.radii[1]),
    letter("|x21|", 0, |inputs| length(inputs.x21())),
    letter("|d21|", 1, |inputs| length(inputs.d21())),
    letter("1", 0, |_| BoundedValue::from_exact(1.0)),
    letter("x1.x1", 0, |inputs| inputs.x[0].dot(inputs.x[0])),
    letter("x1.x2", 0, |inputs| inputs.x[0].dot(inputs.x[1])),
    letter("x2.x2", 0, |inputs| inputs.x[1].dot(inputs.x[1])),
    letter("x1.d1", 1, |inputs| inputs.x[0].dot(inputs.d[0])),
    letter("x1.d2", 1, |inputs| inputs.x[0].dot(inputs.d[1])),
    letter("x2.d1", 1, |inputs| inputs.x[1].dot(inputs.d[0])),
    letter("x2.d2", 1, |inputs| inputs.x[1].dot(inputs.d[1])),
    letter("d1.d1", 2, |inputs| inputs.d[0].dot(inputs.d[0])),
    letter("d1.d2", 2, |inputs| inputs.d[0].dot(inputs.d[1])),
    letter("d2.d2", 2, |inputs| inputs.d[1].dot(inputs.d[1])),
    letter("x21.x x21.x", 0, |inputs| inputs.x21().x * inputs.x21().x),
    letter("x21.x d21.x", 1, |inputs| inputs.x21().x * inputs.d21().x),
    letter("d21.x d21.x", 2, |inputs| inputs.d21().x * inputs.d21().x),
];

const QUARTIC_EXTRAS: &[Letter] = &[
    letter("(x12.d32)", 1, |inputs| inputs.x12().dot(inputs.d32())),
    letter("(d12.x32)", 1, |inputs| inputs.d12().dot(inputs.x32())),
    letter("R", 0, |inputs| inputs.radii[0] + inputs.radii[1]),
    letter("r1^2", 0, |inputs| inputs.radii[0] * inputs.radii[0]),
    letter("re^2", 0, |inputs| inputs.radii[1] * inputs.radii[1]),
    letter("r1 re", 0, |inputs| inputs.radii[0] * inputs.radii[1]),
];

const ALPHA_EXTRAS: &[Letter] = &[
    letter("1", 0, |_| BoundedValue::from_exact(1.0)),
    letter("x21.x21", 0, |inputs| inputs.x21().dot(inputs.x21())),
    letter("d21.x21", 1, |inputs| inputs.d21().dot(inputs.x21())),
    letter("d21.d21", 2, |inputs| inputs.d21().dot(inputs.d21())),
    letter("(x32.x32)", 0, |inputs| inputs.x32().dot(inputs.x32())),
    letter("(d32.x32)", 1, |inputs| inputs.d32().dot(inputs.x32())),
    letter("(d32.d32)", 2, |inputs| inputs.d32().dot(inputs.d32())),
    letter("(x12.x32)", 0, |inputs| inputs.x12().dot(inputs.x32())),
    letter("(x12.d32)", 1, |inputs| inputs.x12().dot(inputs.d32())),
    letter("(d12.x32)", 1, |inputs| inputs.d12().dot(inputs.x32())),
    letter("(d12.d32)", 2, |inputs| inputs.d12().dot(inputs.d32())),
    letter("R^2", 0, |inputs| inputs.square),
    letter("x1.x2", 0, |inputs| inputs.x[0].dot(inputs.x[1])),
    letter("x1.x3", 0, |inputs| inputs.x[0].dot(inputs.x[2])),
    letter("x2.x3", 0, |inputs| inputs.x[1].dot(inputs.x[2])),
    letter("x2.x2", 0, |inputs| inputs.x[1].dot(inputs.x[1])),
    letter("x3.x3", 0, |inputs| inputs.x[2].dot(inputs.x[2])),
];

/// Letters that do not belong in the formulas of a particle and a half-plane, but that students may use there.
pub const HALF_PLANE_EXTRAS: &[Letter] = &[
    letter("|n|", 0, |inputs| length(inputs.normal())),
    letter("r", 0, |inputs| inputs.radii[0]),
    letter("1", 0, |_| BoundedValue::from_exact(1.0)),
    letter("(x.n)", 0, |inputs| inputs.x[0].dot(inputs.normal())),
    letter("(p.n)", 0, |inputs| inputs.x[1].dot(inputs.normal())),
    letter("(dx.dx)", 2, |inputs| inputs.d[0].dot(inputs.d[0])),
    letter("((p-x).(p-x))", 0, |inputs| inputs.x21().dot(inputs.x21())),
    letter("((p-x).dx)", 1, |inputs| inputs.x21().dot(inputs.d[0])),
];
