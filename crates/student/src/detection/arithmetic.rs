//! The formulas of detection over a chosen kind of number: with fused multiply-adds, as a compiler makes them that may
//! contract and reorder, or in twice the usual precision and rounded once at the end.
//!
//! The mathematics is that of collisions.md 2, the course's cubic coefficient of the particle-edge approach included.
use std::ops::{Add, Div, Mul, Sub};

use fosssim_num::vector::Vec2;

use crate::encounter::MovingBody;

/// The numbers of a program.
pub trait Number:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Returns `self * factor + addend`, in the way in which this program's compiler does it.
    fn multiply_add(self, factor: Self, addend: Self) -> Self;

    /// Returns the double that is handed over.
    fn rounded(self) -> f64;
}

/// A double whose products and sums are fused: one rounding instead of two.
pub type FusedDouble = f64;

impl Number for FusedDouble {
    #[expect(clippy::disallowed_methods, reason = "a student's compiler fuses what it likes")]
    fn multiply_add(self, factor: Self, addend: Self) -> Self {
        self.mul_add(factor, addend)
    }

    fn rounded(self) -> f64 {
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

fn negative<N: Number>(a: N) -> N {
    N::from(0.0) - a
}

/// Returns the sum of products, each with a small whole factor, from left to right.
fn sum<N: Number>(terms: &[(f64, N, N)]) -> N {
    terms.iter().fold(N::from(0.0), |sum, &(factor, a, b)| (N::from(factor) * a).multiply_add(b, sum))
}

fn rounded<N: Number>(list: &[N]) -> Vec<f64> {
    list.iter().map(|number| number.rounded()).collect()
}

fn rounded_vector<N: Number>(v: Vector<N>) -> Vec2 {
    Vec2::new(v[0].rounded(), v[1].rounded())
}

/// Returns a center at the time `t`.
fn at<N: Number>(body: &MovingBody, t: f64) -> Vector<N> {
    plus(vector(body.start), N::from(t), vector(body.displacement))
}

/// Returns the overlap and approach of two particles.
pub fn particle_particle<N: Number>(one: &MovingBody, two: &MovingBody) -> Vec<Vec<f64>> {
    let x: Vector<N> = minus(vector(two.start), vector(one.start));
    let d: Vector<N> = minus(vector(two.displacement), vector(one.displacement));
    let reach = N::from(one.radius) + N::from(two.radius);
    let square = dot(d, d);
    let along = dot(x, d);
    let overlap = [negative(square), N::from(-2.0) * along, reach.multiply_add(reach, negative(dot(x, x)))];
    vec![rounded(&overlap), rounded(&[negative(square), negative(along)])]
}

/// Returns the overlap and approach of a particle and a half-plane.
pub fn particle_half_plane<N: Number>(one: &MovingBody, point: Vec2, normal: Vec2) -> Vec<Vec<f64>> {
    let q: Vector<N> = vector(normal);
    let s = dot(vector(one.displacement), q);
    let w = dot(minus(vector(point), vector(one.start)), q);
    let radius = N::from(one.radius);
    let reach = radius * radius * dot(q, q);
    let overlap = [negative(s) * s, N::from(2.0) * w * s, negative(w).multiply_add(w, reach)];
    vec![rounded(&overlap), rounded(&[negative(s) * s, w * s])]
}

/// Returns overlap, alpha > 0, alpha < 1 and approach of a particle and an edge.
pub fn particle_edge<N: Number>(bodies: &[MovingBody; 3], edge_radius: f64) -> Vec<Vec<f64>> {
    let [one, two, three] = bodies;
    let between = |a: Vec2, b: Vec2| -> Vector<N> { minus(vector(a), vector(b)) };
    let (x12, x32) = (between(one.start, two.start), between(three.start, two.start));
    let (d12, d32) = (between(one.displacement, two.displacement), between(three.displacement, two.displacement));
    let (x13, x23) = (between(one.start, three.start), between(two.start, three.start));
    let (d13, d23) = (between(one.displacement, three.displacement), between(two.displacement, three.displacement));
    let along = [dot(d12, d32), dot(x12, d32) + dot(d12, x32), dot(x12, x32)];
    let back = [dot(d13, d23), dot(d13, x23) + dot(x13, d23), dot(x13, x23)];
    let beside = [dot(d12, d12), dot(d12, x12), dot(x12, x12)];
    let edge = [dot(d32, d32), dot(d32, x32), dot(x32, x32)];
    let reach = N::from(one.radius) + N::from(edge_radius);
    let overlap = quartic(along, beside, edge, reach * reach);
    vec![rounded(&overlap), rounded(&along), rounded(&back), rounded(&quintic(&x12, &x32, &d12, &d32))]
}

/// Returns `(x12.x32)^2 - |x12|^2 |x32|^2 + S |x32|^2`, each factor as a quadratic in t (`beside` and `edge` with half
/// of their linear coefficients).
fn quartic<N: Number>([c, b, a]: [N; 3], [f, e, d]: [N; 3], [i, h, g]: [N; 3], s: N) -> [N; 5] {
    [
        sum(&[(1.0, c, c), (-1.0, f, i)]),
        sum(&[(2.0, b, c), (-2.0, e, i), (-2.0, f, h)]),
        sum(&[(2.0, c, a), (1.0, b, b), (-1.0, d, i), (-1.0, f, g), (-4.0, e, h), (1.0, s, i)]),
        sum(&[(2.0, a, b), (-2.0, d, h), (-2.0, e, g), (2.0, s, h)]),
        sum(&[(1.0, a, a), (-1.0, d, g), (1.0, s, g)]),
    ]
}

/// Returns the course's quintic, term by term (collisions.md 2).
fn quintic<N: Number>(x12: &Vector<N>, x32: &Vector<N>, d12: &Vector<N>, d32: &Vector<N>) -> [N; 6] {
    let [x21, d21] = [x12, d12].map(|v| v.map(negative));
    let (a, b, c) = (dot(*x32, *x32), dot(*x32, *d32), dot(*d32, *d32));
    let (d, e) = (dot(d21, d21), dot(d21, x21));
    let (f, g, h) = (dot(*x12, *x32), dot(*x12, *d32) + dot(*d12, *x32), dot(*d12, *d32));
    let (i, j) = (dot(*d32, x21) + dot(d21, *x32), dot(*d32, d21));
    let k = a * f;
    let l = sum(&[(1.0, a, g), (2.0, b, f)]);
    let m = sum(&[(1.0, a, h), (2.0, b, g), (1.0, c, f)]);
    let n = sum(&[(1.0, c, g), (2.0, b, h)]);
    let o = c * h;
    let (p, q) = (b, c);
    [
        sum(&[(-1.0, h * h, q), (-1.0, c * c, d), (-2.0, o, j)]),
        sum(&[(-1.0, h * h, p), (-2.0, g * h, q), (-4.0, b * c, d), (-1.0, c * c, e), (-1.0, o, i), (-2.0, n, j)]),
        sum(&[
            (-2.0, g * h, p),
            (-2.0, f * g, q),
            (-1.0, g * g, q),
            (-2.0, a * c, d),
            (-4.0, b * b, d),
            (-4.0, b * c, e),
            (-1.0, n, i),
            (-2.0, m, j),
        ]),
        sum(&[
            (-2.0, f * h, p),
            (-1.0, g * g, p),
            (-2.0, f * g, q),
            (-4.0, a * b, d),
            (-2.0, a * c, e),
            (-4.0, b * b, e),
            (-1.0, m, i),
            (-2.0, l, j),
        ]),
        sum(&[(-2.0, f * g, p), (-1.0, f * f, q), (-1.0, a * a, d), (-4.0, a * b, e), (-1.0, l, i), (-2.0, k, j)]),
        sum(&[(-1.0, f * f, p), (-1.0, a * a, e), (-1.0, k, i)]),
    ]
}

/// Returns the vector from the first center to the second at time `t`.
pub fn vector_between_particles<N: Number>(one: &MovingBody, two: &MovingBody, t: f64) -> Vec2 {
    rounded_vector::<N>(minus(at(two, t), at(one, t)))
}

/// Returns the vector from the particle to the closest point of the edge's line at time `t`.
pub fn vector_to_edge<N: Number>([one, two, three]: &[MovingBody; 3], t: f64) -> Vec2 {
    let along: Vector<N> = minus(at(three, t), at(two, t));
    let beside = minus(at(one, t), at(two, t));
    let alpha = dot(beside, along) / dot(along, along);
    rounded_vector(minus(plus(at(two, t), alpha, along), at(one, t)))
}

/// Returns the vector from the particle to the boundary of a half-plane at time `t`.
pub fn to_half_plane<N: Number>(one: &MovingBody, point: Vec2, normal: Vec2, t: f64) -> Vec2 {
    let q: Vector<N> = vector(normal);
    let share = dot(minus(vector(point), at(one, t)), q) / dot(q, q);
    rounded_vector([share * q[0], share * q[1]])
}
