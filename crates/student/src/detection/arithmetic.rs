//! The formulas of detection over a chosen kind of number: with fused multiply-adds, as a compiler makes them that may
//! contract and reorder, or in twice the usual precision and rounded once at the end.
//!
//! The mathematics is that of collisions.md 2 in the tables of `formulas`, the course's cubic coefficient of the
//! particle-edge approach included.
use std::ops::{Add, Div, Mul, Sub};

use fosssim_num::vector::Vec2;

use crate::assignments::t2m2::{Subject, formulas::readings};
use fosssim_model::sim::PointMotion;

/// The numbers of a program.
pub trait Number:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Returns `self * factor + addend`, in the way in which this program's compiler does it.
    fn multiply_add(self, factor: Self, addend: Self) -> Self;

    /// Returns the double that is handed over.
    fn to_double(self) -> f64;
}

/// A double whose products and sums are fused: one rounding instead of two.
pub type FusedDouble = f64;

impl Number for FusedDouble {
    #[expect(clippy::disallowed_methods, reason = "a student's compiler fuses what it likes")]
    fn multiply_add(self, factor: Self, addend: Self) -> Self {
        self.mul_add(factor, addend)
    }

    fn to_double(self) -> f64 {
        self
    }
}

type Vector<N> = [N; 2];

fn vector<N: Number>(v: Vec2) -> Vector<N> {
    [v.x.into(), v.y.into()]
}

fn minus<N: Number>(a: Vector<N>, b: Vector<N>) -> Vector<N> {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot<N: Number>(a: Vector<N>, b: Vector<N>) -> N {
    a[0].multiply_add(b[0], a[1] * b[1])
}

/// Returns `v + s * w`.
fn plus<N: Number>(v: Vector<N>, s: N, w: Vector<N>) -> Vector<N> {
    [s.multiply_add(w[0], v[0]), s.multiply_add(w[1], v[1])]
}

fn rounded_vector<N: Number>(v: Vector<N>) -> Vec2 {
    Vec2::new(v[0].to_double(), v[1].to_double())
}

/// Returns a center at the time `t`.
fn at<N: Number>(body: &PointMotion, t: f64) -> Vector<N> {
    plus(vector(body.start), N::from(t), vector(body.shift))
}

/// Returns a polynomial, highest power first, from the letters of its first formula.
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

/// Returns the overlap and approach of two particles.
pub fn particle_particle<N: Number>([one, two]: &[PointMotion; 2], radii: [f64; 2]) -> Vec<Vec<f64>> {
    let x: Vector<N> = minus(vector(two.start), vector(one.start));
    let d: Vector<N> = minus(vector(two.shift), vector(one.shift));
    let reach = N::from(radii[0]) + N::from(radii[1]);
    let letters = [dot(d, d), dot(x, d), dot(x, x), reach * reach];
    vec![evaluate(Subject::ParticleOverlap, &letters), evaluate(Subject::ParticleApproach, &letters)]
}

/// Returns the overlap and approach of a particle and a half-plane.
pub fn particle_half_plane<N: Number>(one: &PointMotion, radius: f64, point: Vec2, normal: Vec2) -> Vec<Vec<f64>> {
    let q: Vector<N> = vector(normal);
    let offset = minus(vector(point), vector(one.start));
    let radius = N::from(radius);
    let letters = [dot(vector(one.shift), q), dot(offset, q), dot(q, q), radius * radius];
    vec![evaluate(Subject::HalfPlaneOverlap, &letters), evaluate(Subject::HalfPlaneApproach, &letters)]
}

/// Returns overlap, alpha > 0, alpha < 1 and approach of a particle and an edge.
pub fn particle_edge<N: Number>(bodies: &[PointMotion; 3], radii: [f64; 2]) -> Vec<Vec<f64>> {
    let [one, two, three] = bodies;
    let between = |a: Vec2, b: Vec2| -> Vector<N> { minus(vector(a), vector(b)) };
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
    rounded_vector::<N>(minus(at(two, t), at(one, t)))
}

/// Returns the vector from the particle to the closest point of the edge's line at time `t`.
pub fn vector_to_edge<N: Number>([one, two, three]: &[PointMotion; 3], t: f64) -> Vec2 {
    let along: Vector<N> = minus(at(three, t), at(two, t));
    let beside = minus(at(one, t), at(two, t));
    let alpha = dot(beside, along) / dot(along, along);
    rounded_vector(minus(plus(at(two, t), alpha, along), at(one, t)))
}

/// Returns the vector from the particle to the boundary of a half-plane at time `t`.
pub fn to_half_plane<N: Number>(one: &PointMotion, point: Vec2, normal: Vec2, t: f64) -> Vec2 {
    let q: Vector<N> = vector(normal);
    let share = dot(minus(vector(point), at(one, t)), q) / dot(q, q);
    rounded_vector([share * q[0], share * q[1]])
}
