//! The vectors from which students form dot products.
use super::Inputs;
use fosssim_model::sim::PairKind;
use fosssim_num::bounded::BoundedVector;

/// A vector that a student may have used in a dot product.
pub struct Ingredient {
    /// The vector's name in messages.
    pub name: &'static str,
    /// The function that returns the vector for the inputs of a formula.
    pub value: fn(&Inputs) -> BoundedVector,
    /// The amount that this vector adds to the cost of a guess. Guesses with lower costs are preferred.
    pub cost: f64,
}

const fn ingredient(name: &'static str, cost: f64, value: fn(&Inputs) -> BoundedVector) -> Ingredient {
    Ingredient { name, value, cost }
}

const PARTICLE_VECTORS: &[Ingredient] = &[
    ingredient("x21", 0.0, Inputs::x21),
    ingredient("d21", 0.0, Inputs::d21),
    ingredient("x1", 0.5, |inputs| inputs.x[0]),
    ingredient("x2", 0.5, |inputs| inputs.x[1]),
    ingredient("d1", 0.5, |inputs| inputs.d[0]),
    ingredient("d2", 0.5, |inputs| inputs.d[1]),
    ingredient("(x21+d21)", 0.8, |inputs| inputs.x21() + inputs.d21()),
];

const EDGE_VECTORS: &[Ingredient] = &[
    ingredient("x21", 0.0, Inputs::x21),
    ingredient("d21", 0.0, Inputs::d21),
    ingredient("x32", 0.0, Inputs::x32),
    ingredient("d32", 0.0, Inputs::d32),
    ingredient("x13", 0.2, Inputs::x13),
    ingredient("d13", 0.2, Inputs::d13),
    ingredient("x1", 0.5, |inputs| inputs.x[0]),
    ingredient("x2", 0.5, |inputs| inputs.x[1]),
    ingredient("x3", 0.5, |inputs| inputs.x[2]),
    ingredient("d1", 0.5, |inputs| inputs.d[0]),
    ingredient("d2", 0.5, |inputs| inputs.d[1]),
    ingredient("d3", 0.5, |inputs| inputs.d[2]),
    ingredient("(x21+d21)", 0.8, |inputs| inputs.x21() + inputs.d21()),
    ingredient("(x32+d32)", 0.8, |inputs| inputs.x32() + inputs.d32()),
];

const HALF_PLANE_VECTORS: &[Ingredient] = &[
    ingredient("dx", 0.0, |inputs| inputs.d[0]),
    ingredient("n", 0.0, Inputs::normal),
    ingredient("(p-x)", 0.0, Inputs::x21),
    ingredient("x", 0.5, |inputs| inputs.x[0]),
    ingredient("p", 0.5, |inputs| inputs.x[1]),
    ingredient("(p-x-dx)", 0.8, |inputs| inputs.x21() - inputs.d[0]),
];

/// Returns the vectors that are available in a detection of the given kind.
pub const fn ingredients(kind: PairKind) -> &'static [Ingredient] {
    match kind {
        PairKind::ParticleParticle => PARTICLE_VECTORS,
        PairKind::ParticleEdge => EDGE_VECTORS,
        PairKind::ParticleHalfPlane => HALF_PLANE_VECTORS,
    }
}
