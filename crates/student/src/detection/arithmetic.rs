//! The formulas of detection for a chosen type of numbers. One type uses fused multiply-adds, like a compiler that may
//! contract and reorder operations. The other type has double the usual precision, and results are rounded once at the
//! end.
//!
//! The formulas are those of collisions.md 2 in the tables of `formulas`, including the course's cubic coefficient of
//! the particle-edge approach.
use std::ops::{Add, Div, Mul, Sub};

use fosssim_num::vector::Vec2;

use crate::assignments::t2m2::{Subject, formulas::readings};
use fosssim_model::sim::{PairMotion, PointMotion};

/// The type of the numbers with which a program computes.
pub trait Number:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Returns `self * factor + addend`, rounded as by this program's compiler.
    fn multiply_add(self, factor: Self, addend: Self) -> Self;

    /// Returns the number rounded to a double.
    fn to_double(self) -> f64;
}

/// A double whose products and sums are fused, with one rounding instead of two.
pub type FusedDouble = f64;

impl Number for FusedDouble {
    #[expect(clippy::disallowed_methods, reason = "a student's compiler may fuse operations")]
    fn multiply_add(self, factor: Self, addend: Self) -> Self {
        self.mul_add(factor, addend)
    }

    fn to_double(self) -> f64 {
        self
    }
}

type Vector<N> = [N; 2];

fn to_vector<N: Number>(v: Vec2) -> Vector<N> {
    [v.x.into(), v.y.into()]
}

fn subtract<N: Number>(a: Vector<N>, b: Vector<N>) -> Vector<N> {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot<N: Number>(a: Vector<N>, b: Vector<N>) -> N {
    a[0].multiply_add(b[0], a[1] * b[1])
}

/// Returns `v + s * w`.
fn add_scaled<N: Number>(v: Vector<N>, s: N, w: Vector<N>) -> Vector<N> {
    [s.multiply_add(w[0], v[0]), s.multiply_add(w[1], v[1])]
}

fn round_vector<N: Number>(v: Vector<N>) -> Vec2 {
    Vec2::new(v[0].to_double(), v[1].to_double())
}

/// Returns the position of a body at time `t`.
fn position_at<N: Number>(body: &PointMotion, t: f64) -> Vector<N> {
    add_scaled(to_vector(body.start), N::from(t), to_vector(body.shift))
}

/// Returns the first reading of a polynomial for these values of its letters. The highest power is first.
fn evaluate<N: Number>(subject: Subject, letters: &[N]) -> Vec<f64> {
    let formula = &readings(subject)[0];
    let mut sums = vec![N::from(0.0); formula.degree + 1];
    for term in formula.terms {
        let [others @ .., last] = term.letters else { continue };
        let product = others.iter().fold(N::from(term.weight), |product, &letter| product * letters[letter]);
        let sum = &mut sums[formula.degree - term.power];
        *sum = product.multiply_add(letters[*last], *sum);
    }
    sums.iter().map(|sum| sum.to_double()).collect()
}

/// Returns the polynomials of a pair.
pub fn polynomials<N: Number>(motion: &PairMotion) -> Vec<Vec<f64>> {
    match *motion {
        PairMotion::Particles { centers, radii } => particle_particle::<N>(&centers, radii),
        PairMotion::Edge { center, ends: [first, second], radii } => {
            particle_edge::<N>(&[center, first, second], radii)
        }
        PairMotion::HalfPlane { center, radius, point, normal } => {
            particle_half_plane::<N>(&center, radius, point, normal)
        }
    }
}

/// Returns the overlap and approach of two particles.
fn particle_particle<N: Number>([one, two]: &[PointMotion; 2], radii: [f64; 2]) -> Vec<Vec<f64>> {
    let x: Vector<N> = subtract(to_vector(two.start), to_vector(one.start));
    let d: Vector<N> = subtract(to_vector(two.shift), to_vector(one.shift));
    let reach = N::from(radii[0]) + N::from(radii[1]);
    let letters = [dot(d, d), dot(x, d), dot(x, x), reach * reach];
    vec![evaluate(Subject::ParticleOverlap, &letters), evaluate(Subject::ParticleApproach, &letters)]
}

/// Returns the overlap and approach of a particle and a half-plane.
fn particle_half_plane<N: Number>(one: &PointMotion, radius: f64, point: Vec2, normal: Vec2) -> Vec<Vec<f64>> {
    let q: Vector<N> = to_vector(normal);
    let offset = subtract(to_vector(point), to_vector(one.start));
    let radius = N::from(radius);
    let letters = [dot(to_vector(one.shift), q), dot(offset, q), dot(q, q), radius * radius];
    vec![evaluate(Subject::HalfPlaneOverlap, &letters), evaluate(Subject::HalfPlaneApproach, &letters)]
}

/// Returns the overlap, alpha > 0, alpha < 1 and the approach of a particle and an edge.
fn particle_edge<N: Number>(bodies: &[PointMotion; 3], radii: [f64; 2]) -> Vec<Vec<f64>> {
    let [one, two, three] = bodies;
    let between = |a: Vec2, b: Vec2| -> Vector<N> { subtract(to_vector(a), to_vector(b)) };
    let (x12, x32) = (between(one.start, two.start), between(three.start, two.start));
    let (d12, d32) = (between(one.shift, two.shift), between(three.shift, two.shift));
    let (x13, x23) = (between(one.start, three.start), between(two.start, three.start));
    let (d13, d23) = (between(one.shift, three.shift), between(two.shift, three.shift));
    let [f, g, h] = [dot(x12, x32), dot(x12, d32) + dot(d12, x32), dot(d12, d32)];
    let [xx, dx, dd] = [dot(x12, x12), dot(d12, x12), dot(d12, d12)];
    let [a, b, c] = [dot(x32, x32), dot(x32, d32), dot(d32, d32)];
    let reach = N::from(radii[0]) + N::from(radii[1]);
    let nothing = N::from(0.0);
    vec![
        evaluate(Subject::EdgeOverlap, &[f, g, h, xx, dx, dd, a, b, c, reach * reach]),
        evaluate(Subject::AlphaLow, &[f, dot(x12, d32), dot(d12, x32), h]),
        evaluate(Subject::AlphaHigh, &[dot(x13, x23), dot(x13, d23), dot(d13, x23), dot(d13, d23)]),
        evaluate(Subject::EdgeApproach, &[a, b, c, dd, dx, f, g, h, nothing - g, nothing - h]),
    ]
}

/// Returns the vector from the first center to the second at time `t`.
pub fn vector_between_particles<N: Number>([one, two]: &[PointMotion; 2], t: f64) -> Vec2 {
    round_vector::<N>(subtract(position_at(two, t), position_at(one, t)))
}

/// Returns the vector from the particle to the closest point of the edge's line at time `t`.
pub fn vector_to_edge<N: Number>([one, two, three]: &[PointMotion; 3], t: f64) -> Vec2 {
    let edge: Vector<N> = subtract(position_at(three, t), position_at(two, t));
    let from_end = subtract(position_at(one, t), position_at(two, t));
    let alpha = dot(from_end, edge) / dot(edge, edge);
    round_vector(subtract(add_scaled(position_at(two, t), alpha, edge), position_at(one, t)))
}

/// Returns the vector from the particle to the boundary of a half-plane at time `t`.
pub fn vector_to_half_plane<N: Number>(one: &PointMotion, point: Vec2, normal: Vec2, t: f64) -> Vec2 {
    let q: Vector<N> = to_vector(normal);
    let share = dot(subtract(to_vector(point), position_at(one, t)), q) / dot(q, q);
    round_vector([share * q[0], share * q[1]])
}
