//! The scalars of a K polynomial, the next K polynomial, and the new estimate of the quadratic factor (root-finder.md 6
//! and 7).
//!
//! The division of P gives `a` and `b`, and that of K gives `c` and `d`. The published formulas use `bc - ad`, `a² +
//! uab + vb²` and `ac + uad + vbd`, divided by `c` or by `d`, whichever has the larger modulus.
use super::{Coefficients, constants::UNIT_ERROR, quadratic};

/// The quadratic factor `z² + u z + v`, and the polynomial of degree `N` divided by it.
#[derive(Clone, Copy)]
pub(super) struct Division<const N: usize> {
    pub(super) u: f64,
    pub(super) v: f64,
    /// The quotient, followed by the two entries of the remainder.
    pub(super) q: Coefficients,
}

impl<const N: usize> Division<N> {
    #[inline(always)]
    pub(super) fn new(polynomial: &Coefficients, u: f64, v: f64) -> Self {
        Self { u, v, q: quadratic::divide::<N>(polynomial, u, v) }
    }

    #[inline(always)]
    pub(super) fn a(&self) -> f64 {
        self.q[N]
    }

    #[inline(always)]
    pub(super) fn b(&self) -> f64 {
        self.q[N - 1]
    }
}

/// The entry of the remainder by which the formulas are divided.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum ScalarKind {
    /// The formulas are divided by `c`, which is larger.
    DividedByC,
    /// The formulas are divided by `d`.
    DividedByD,
    /// The factor nearly divides K, and the other scalars are not computed.
    Divides,
}

/// The scalars of one K polynomial (degree `N - 1`) with one division of P.
#[derive(Clone, Copy)]
pub(super) struct Scalars<const N: usize> {
    pub(super) kind: ScalarKind,
    w: Coefficients,
    c: f64,
    d: f64,
    s: f64,
    g: f64,
    y: f64,
    phi: f64,
    delta: f64,
    psi: f64,
}

impl<const N: usize> Scalars<N> {
    /// Divides K by the quadratic factor and evaluates the scalars.
    #[inline(always)]
    pub(super) fn new(k: &Coefficients, division: &Division<N>) -> Self {
        let (u, v, a, b) = (division.u, division.v, division.a(), division.b());
        // K has degree N - 1.
        let mut w = Coefficients::default();
        w[0] = k[0];
        w[1] = k[1] - w[0] * u;
        for i in 2..N {
            w[i] = (k[i] - w[i - 1] * u) - w[i - 2] * v;
        }
        let (c, d) = (w[N - 1], w[N - 2]);
        let mut scalars =
            Self { kind: ScalarKind::Divides, w, c, d, s: 0.0, g: 0.0, y: 0.0, phi: 0.0, delta: 0.0, psi: 0.0 };
        let stands_out =
            c.abs() > ((k[N - 1] * 100.0) * UNIT_ERROR).abs() || d.abs() > ((k[N - 2] * 100.0) * UNIT_ERROR).abs();
        if !stands_out {
            return scalars;
        }
        let y = v * b;
        scalars.y = y;
        if d.abs() < c.abs() {
            let r = a / c;
            let s = d / c;
            let g = u * r;
            scalars.kind = ScalarKind::DividedByC;
            scalars.s = s;
            scalars.g = g;
            scalars.phi = a * r + (y / c + g) * b;
            scalars.delta = b - a * s;
            scalars.psi = (a + g * d) + y * s;
        } else {
            let r = a / d;
            let s = c / d;
            let g = u * b;
            scalars.kind = ScalarKind::DividedByD;
            scalars.s = s;
            scalars.g = g;
            scalars.phi = (a + g) * r + y * (b / d);
            scalars.delta = b * s - a;
            scalars.psi = (s + u) * a + y;
        }
        scalars
    }

    /// Returns the next K polynomial.
    #[inline(always)]
    pub(super) fn next_k(&self, division: &Division<N>) -> Coefficients {
        let (q, w) = (&division.q, &self.w);
        let mut k = Coefficients::default();
        let reference = match self.kind {
            ScalarKind::DividedByC => division.b(),
            ScalarKind::DividedByD => division.a(),
            ScalarKind::Divides => {
                k[2..N].copy_from_slice(&w[..N - 2]);
                return k;
            }
        };
        if self.delta.abs() <= (reference.abs() * UNIT_ERROR) * 10.0 {
            k[1] = -self.psi * q[0];
            for i in 2..N {
                k[i] = self.phi * w[i - 2] - self.psi * q[i - 1];
            }
        } else {
            let psi = self.psi / self.delta;
            let phi = self.phi / self.delta;
            k[0] = q[0];
            k[1] = q[1] - psi * q[0];
            for i in 2..N {
                k[i] = (phi * w[i - 2] - psi * q[i - 1]) + q[i];
            }
        }
        k
    }

    /// Returns the new estimate `(u, v)` of the quadratic factor, or `(0, 0)` if there is none.
    #[inline(always)]
    pub(super) fn estimate(&self, k: &Coefficients, polynomial: &Coefficients, division: &Division<N>) -> (f64, f64) {
        let Self { c, d, s, g, y, phi, delta, psi, .. } = *self;
        let (u, v, a, b) = (division.u, division.v, division.a(), division.b());
        let (alpha, gamma) = match self.kind {
            ScalarKind::Divides => return (0.0, 0.0),
            ScalarKind::DividedByD => ((a + g) * s + y, (s + u) * c + v * d),
            ScalarKind::DividedByC => (a + u * b + y * s, c + (u + v * s) * d),
        };
        let rho_1 = -k[N - 1] / polynomial[N];
        let rho_2 = -(k[N - 2] + rho_1 * polynomial[N - 1]) / polynomial[N];
        let theta_1 = (v * rho_2) * delta;
        let theta_2 = rho_1 * psi;
        let theta_3 = (rho_1 * rho_1) * phi;
        let theta = (theta_1 - theta_2) - theta_3;
        let total = (gamma + rho_1 * alpha) - theta;
        if total == 0.0 {
            return (0.0, 0.0);
        }
        let new_u = u - (u * (theta_3 + theta_2) + v * (rho_1 * delta + rho_2 * psi)) / total;
        let new_v = v * (1.0 + theta / total);
        (new_u, new_v)
    }
}
