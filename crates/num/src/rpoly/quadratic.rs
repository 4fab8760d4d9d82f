//! Divides by quadratic factors, and finds their zeros (root-finder.md 4 and 5).
use super::{Coefficients, Zero};

/// Returns the quotient of a polynomial of degree `M` by `z² + u z + v`, followed by the two entries of the remainder.
#[inline(always)]
pub(super) fn divide<const M: usize>(f: &Coefficients, u: f64, v: f64) -> Coefficients {
    let mut g = Coefficients::default();
    g[0] = f[0];
    g[1] = f[1] - g[0] * u;
    for i in 2..=M {
        g[i] = (f[i] - g[i - 1] * u) - g[i - 2] * v;
    }
    g
}

/// Returns the zeros of `a z² + b z + c`, the smaller first; for a complex pair, the one with the positive imaginary
/// part first.
///
/// `a = 0` gives the zero of the line and a second zero at the origin. Coefficients may be infinite or NaN.
#[inline]
pub(super) fn zeros(a: f64, b: f64, c: f64) -> [Zero; 2] {
    if a == 0.0 {
        return [(if b == 0.0 { 0.0 } else { -c / b }, 0.0), (0.0, 0.0)];
    }
    if c == 0.0 {
        return [(0.0, 0.0), (-b / a, 0.0)];
    }
    let half = b / 2.0;
    // The discriminant, divided by the larger of its terms.
    let (discriminant, root) = if half.abs() < c.abs() {
        let signed = if c < 0.0 { -a } else { a };
        let e = half * (half / c.abs()) - signed;
        (e, e.abs().sqrt() * c.abs().sqrt())
    } else {
        let e = 1.0 - (a / half) * (c / half);
        (e, e.abs().sqrt() * half.abs())
    };
    if discriminant < 0.0 {
        let re = -half / a;
        let im = (root / a).abs();
        return [(re, im), (re, -im)];
    }
    // A NaN discriminant also ends here.
    let root = if half >= 0.0 { -root } else { root };
    let large = (-half + root) / a;
    // The test is written like the original's, because a NaN is not zero.
    let small = if large == 0.0 { 0.0 } else { (c / large) / a };
    [(small, 0.0), (large, 0.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_its_zero_and_one_at_the_origin() {
        assert_eq!(zeros(0.0, 2.0, 4.0), [(-2.0, 0.0), (0.0, 0.0)]);
        assert_eq!(zeros(0.0, 0.0, 4.0), [(0.0, 0.0), (0.0, 0.0)]);
    }
}
