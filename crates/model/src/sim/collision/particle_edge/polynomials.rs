//! The detection polynomials of particle-edge pairs (collisions.md 2), for one pair or several at a time.
use fosssim_num::lanes::{Number, Plane};
use std::ops::Mul;

/// The values that an edge's polynomials with all particles share: its motion, and the products without a particle.
///
/// Every value is computed by the operations that the formulas prescribe, so it can be shared. `x23` is computed
/// instead of `-x32`, because zero components of both have the same sign.
#[derive(Debug, Clone, Copy)]
pub struct EdgeMotions<N> {
    x2: Plane<N>,
    d2: Plane<N>,
    x3: Plane<N>,
    d3: Plane<N>,
    x32: Plane<N>,
    d32: Plane<N>,
    x23: Plane<N>,
    d23: Plane<N>,
    /// The product `dot(x32, x32)`.
    g: N,
    /// The product `dot(d32, x32)`.
    h: N,
    /// The product `dot(d32, d32)`.
    i: N,
}

impl<N: Number> EdgeMotions<N> {
    /// Creates the motions of edges whose endpoints start at `x2`, `x3` and move by `d2`, `d3` in the step.
    #[inline(always)]
    pub fn new(x2: Plane<N>, d2: Plane<N>, x3: Plane<N>, d3: Plane<N>) -> Self {
        let (x32, d32) = (x3 - x2, d3 - d2);
        let (g, h, i) = (x32.dot(x32), d32.dot(x32), d32.dot(d32));
        Self { x2, d2, x3, d3, x32, d32, x23: x2 - x3, d23: d2 - d3, g, h, i }
    }
}

/// The coefficients of particle-edge pairs before small leading coefficients are dropped, highest power first.
#[derive(Debug, Clone, Copy)]
pub struct EdgePolynomials<N> {
    /// The polynomial "closer to the line than the radii".
    pub distance: [N; 5],
    /// The polynomial "beyond the first end".
    pub beyond_first: [N; 3],
    /// The polynomial "before the second end".
    pub before_second: [N; 3],
    /// The polynomial "approaching".
    pub approach: [N; 6],
}

/// Returns the coefficients for several edges and one disc. The disc starts at `x1` and moves by `d1` in the step;
/// `radii` is the sum of the disc's and the edge's radius. Letters are those of collisions.md 2.
///
/// The t³ coefficient of the last polynomial is mathematically wrong (it has `g` instead of `h`), but this is the
/// formula that every student was given.
#[inline(always)]
pub fn coefficients<N: Number>(x1: Plane<N>, d1: Plane<N>, edges: &EdgeMotions<N>, radii: N) -> EdgePolynomials<N>
where
    f64: Mul<N, Output = N>,
{
    coefficients_and_right_cubic(x1, d1, edges, radii).0
}

/// Returns the [`coefficients`], and the t³ coefficient of the last polynomial by the definition (numerics.md 1.1).
#[inline(always)]
#[expect(clippy::many_single_char_names, reason = "the letters of the specification")]
pub fn coefficients_and_right_cubic<N: Number>(
    x1: Plane<N>,
    d1: Plane<N>,
    edges: &EdgeMotions<N>,
    radii: N,
) -> (EdgePolynomials<N>, N)
where
    f64: Mul<N, Output = N>,
{
    let EdgeMotions { x2, d2, x3, d3, x32, d32, x23, d23, g, h, i } = *edges;
    let s = radii * radii;
    let (x12, x21, x13) = (x1 - x2, x2 - x1, x1 - x3);
    let (d12, d21, d13) = (d1 - d2, d2 - d1, d1 - d3);

    let a = x12.dot(x32);
    let b = x12.dot(d32) + d12.dot(x32);
    let c = d12.dot(d32);
    let d = x21.dot(x21);
    let e = d21.dot(x21);
    let f = d21.dot(d21);
    let distance = [
        c * c - f * i,
        2.0 * b * c - 2.0 * e * i - 2.0 * f * h,
        2.0 * c * a + b * b - d * i - f * g - 4.0 * e * h + s * i,
        2.0 * a * b - 2.0 * d * h - 2.0 * e * g + 2.0 * s * h,
        a * a - d * g + s * g,
    ];
    let before_second = [d13.dot(d23), d13.dot(x23) + x13.dot(d23), x13.dot(x23)];
    // Products are commutative bit for bit, so `dot(x32, d32)` is `h`.
    let (approach, right_cubic) = approach([g, h, i, f, e, a, b, c], d32.dot(x21) + d21.dot(x32), d32.dot(d21));
    (EdgePolynomials { distance, beyond_first: [c, b, a], before_second, approach }, right_cubic)
}

/// Returns the coefficients of the velocity quintic as given to students, and the corrected coefficient of t³. The
/// letters `a..h`, `i`, `j` are the quintic's own.
#[inline(always)]
#[expect(clippy::many_single_char_names, reason = "the letters of the specification")]
fn approach<N: Number>([a, b, c, d, e, f, g, h]: [N; 8], i: N, j: N) -> ([N; 6], N)
where
    f64: Mul<N, Output = N>,
{
    let k = a * f;
    let l = a * g + 2.0 * b * f;
    let m = a * h + 2.0 * b * g + c * f;
    let n = c * g + 2.0 * b * h;
    let o = c * h;
    let p = b;
    let q = c;
    let others = [g * g * q, 2.0 * a * c * d, 4.0 * b * b * d, 4.0 * b * c * e, n * i, 2.0 * m * j];
    let quintic = [
        -h * h * q - c * c * d - 2.0 * o * j,
        -h * h * p - 2.0 * g * h * q - 4.0 * b * c * d - c * c * e - o * i - 2.0 * n * j,
        subtract_all(-2.0 * g * h * p - 2.0 * f * g * q, others),
        -2.0 * f * h * p
            - g * g * p
            - 2.0 * f * g * q
            - 4.0 * a * b * d
            - 2.0 * a * c * e
            - 4.0 * b * b * e
            - m * i
            - 2.0 * l * j,
        -2.0 * f * g * p - f * f * q - a * a * d - 4.0 * a * b * e - l * i - 2.0 * k * j,
        -f * f * p - a * a * e - k * i,
    ];
    (quintic, subtract_all(-2.0 * g * h * p - 2.0 * f * h * q, others))
}

/// Subtracts `others` from a number, one after the other.
#[inline(always)]
fn subtract_all<N: Number, const COUNT: usize>(mut number: N, others: [N; COUNT]) -> N {
    for other in others {
        number = number - other;
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::samples::NumberSource;
    use fosssim_num::{polynomial::Polynomial, vector::Vec2};

    fn vector((x, y): (f64, f64)) -> Vec2 {
        Vec2::new(x, y)
    }

    fn polynomials([x1, d1]: [Vec2; 2], edge: [Vec2; 4], radii: f64) -> [Polynomial; 4] {
        let [x2, d2, x3, d3] = edge.map(Plane::from);
        let pair = coefficients(x1.into(), d1.into(), &EdgeMotions::new(x2, d2, x3, d3), radii);
        let lists: [&[f64]; 4] = [&pair.distance, &pair.beyond_first, &pair.before_second, &pair.approach];
        lists.map(Polynomial::trimmed)
    }

    /// Returns the approach polynomial by the specification's formulas, from differences of positions and
    /// displacements.
    fn approach_by_the_formulas([x12, x32, x21]: [Vec2; 3], [d12, d32, d21]: [Vec2; 3]) -> [f64; 6] {
        let a = x32.dot(&x32);
        let b = x32.dot(&d32);
        let c = d32.dot(&d32);
        let d = d21.dot(&d21);
        let e = d21.dot(&x21);
        let f = x12.dot(&x32);
        let g = x12.dot(&d32) + d12.dot(&x32);
        let h = d12.dot(&d32);
        let i = d32.dot(&x21) + d21.dot(&x32);
        let j = d32.dot(&d21);
        let k = a * f;
        let l = (a * g) + ((2.0 * b) * f);
        let m = ((a * h) + ((2.0 * b) * g)) + (c * f);
        let n = (c * g) + ((2.0 * b) * h);
        let o = c * h;
        let (p, q) = (b, c);
        let terms: [&[f64]; 6] = [
            &[((-h) * h) * q, (c * c) * d, (2.0 * o) * j],
            &[((-h) * h) * p, ((2.0 * g) * h) * q, ((4.0 * b) * c) * d, (c * c) * e, o * i, (2.0 * n) * j],
            &[
                ((-2.0 * g) * h) * p,
                ((2.0 * f) * g) * q,
                (g * g) * q,
                ((2.0 * a) * c) * d,
                ((4.0 * b) * b) * d,
                ((4.0 * b) * c) * e,
                n * i,
                (2.0 * m) * j,
            ],
            &[
                ((-2.0 * f) * h) * p,
                (g * g) * p,
                ((2.0 * f) * g) * q,
                ((4.0 * a) * b) * d,
                ((2.0 * a) * c) * e,
                ((4.0 * b) * b) * e,
                m * i,
                (2.0 * l) * j,
            ],
            &[((-2.0 * f) * g) * p, (f * f) * q, (a * a) * d, ((4.0 * a) * b) * e, l * i, (2.0 * k) * j],
            &[((-f) * f) * p, (a * a) * e, k * i],
        ];
        terms.map(|terms| terms[1..].iter().fold(terms[0], |sum, term| sum - term))
    }

    /// Sharing values changes no bit, compared with the fully parenthesized formulas of the specification.
    #[test]
    fn shared_values_are_those_of_the_formulas() {
        let mut numbers = NumberSource(3);
        for round in 0..2000 {
            let [x1, d1, x2, d2, mut x3, mut d3] = std::array::from_fn(|_| vector(numbers.next_pair()));
            if round % 4 == 0 {
                d3 = d2;
            }
            if round % 16 == 0 {
                x3 = Vec2::new(x2.x, x3.y);
            }
            let r = numbers.next().abs();
            let s = r * r;
            let (x12, x32, x21, x13, x23) = (x1 - x2, x3 - x2, x2 - x1, x1 - x3, x2 - x3);
            let (d12, d32, d21, d13, d23) = (d1 - d2, d3 - d2, d2 - d1, d1 - d3, d2 - d3);
            let a = x12.dot(&x32);
            let b = x12.dot(&d32) + d12.dot(&x32);
            let c = d12.dot(&d32);
            let d = x21.dot(&x21);
            let e = d21.dot(&x21);
            let f = d21.dot(&d21);
            let g = x32.dot(&x32);
            let h = d32.dot(&x32);
            let i = d32.dot(&d32);
            let distance = [
                (c * c) - (f * i),
                ((((2.0 * b) * c) - ((2.0 * e) * i)) - ((2.0 * f) * h)),
                (((((((2.0 * c) * a) + (b * b)) - (d * i)) - (f * g)) - ((4.0 * e) * h)) + (s * i)),
                (((((2.0 * a) * b) - ((2.0 * d) * h)) - ((2.0 * e) * g)) + ((2.0 * s) * h)),
                (((a * a) - (d * g)) + (s * g)),
            ];
            let ends = [[c, b, a], [d13.dot(&d23), d13.dot(&x23) + x13.dot(&d23), x13.dot(&x23)]];
            let approach = approach_by_the_formulas([x12, x32, x21], [d12, d32, d21]);
            let expected = [
                Polynomial::trimmed(&distance),
                Polynomial::trimmed(&ends[0]),
                Polynomial::trimmed(&ends[1]),
                Polynomial::trimmed(&approach),
            ];
            for (actual, expected) in polynomials([x1, d1], [x2, d2, x3, d3], r).iter().zip(&expected) {
                let bits = |p: &Polynomial| p.coefficients().iter().map(|c| c.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(actual), bits(expected));
            }
        }
    }

    /// Tests that the polynomials of an edge that only translates are those of the exact definition.
    #[test]
    fn a_translating_edge_gives_the_exact_polynomials() {
        let [x1, x2, x3] = [(0.0, 1.0), (-1.0, 0.0), (1.0, 0.0)].map(vector);
        let [d1, d2, d3] = [(0.0, -0.5), (0.0, 0.5), (0.0, 0.5)].map(vector);
        let [distance, first, second, approach] = polynomials([x1, d1], [x2, d2, x3, d3], 0.25);
        // The gap along y is 1 - t and the squared length 4: 4 (1/16 - (1 - t)^2).
        assert_eq!(distance.coefficients(), [-4.0, 8.0, -3.75]);
        // Without relative motion along the edge both ends stay at distance 1 of 2, times the length.
        assert_eq!(first.coefficients(), [2.0]);
        assert_eq!(second.coefficients(), [2.0]);
        assert_eq!(approach.coefficients().len(), 2);
        assert!(approach.evaluate(0.0) > 0.0 && approach.evaluate(1.0) == 0.0);
    }
}
