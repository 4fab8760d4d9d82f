//! Polynomials with integer coefficients, with the operations for the exact decision.
//!
//! Greatest common divisors use primitive pseudo-remainders (Knuth, *The Art of Computer Programming* 2, 4.6.1). They
//! are nearly always constant, which one computation modulo a prime shows at a fraction of the cost.
use super::{super::short_numbers::split_double, dyadic::DyadicNumber};
use num_bigint::{BigInt, Sign};

/// The prime modulus `2^61 - 1`, for a quick test whether polynomials have a common zero.
const MODULUS: u64 = (1 << 61) - 1;

/// The coefficients, lowest power first. The last is not zero, and the zero polynomial has none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct IntegerPolynomial(Vec<BigInt>);

/// Returns the sign of a number, which is -1, 0 or 1.
fn sign(value: &BigInt) -> i8 {
    match value.sign() {
        Sign::Minus => -1,
        Sign::NoSign => 0,
        Sign::Plus => 1,
    }
}

impl IntegerPolynomial {
    /// Creates the polynomial with the given coefficients.
    pub(super) fn new(mut coefficients: Vec<BigInt>) -> Self {
        while coefficients.last().is_some_and(|last| last.sign() == Sign::NoSign) {
            coefficients.pop();
        }
        Self(coefficients)
    }

    /// Returns the constant 1.
    pub(super) fn one() -> Self {
        Self(vec![BigInt::from(1)])
    }

    /// Returns a positive multiple of the polynomial with the finite coefficients `list`, highest power first.
    pub(super) fn from_doubles(list: &[f64]) -> Self {
        let lowest = |&value: &f64| {
            let (mantissa, exponent) = split_double(value);
            exponent + mantissa.trailing_zeros().cast_signed()
        };
        let lowest_bit = list.iter().filter(|value| **value != 0.0).map(lowest).min().unwrap_or(0);
        let integer = |&value: &f64| {
            let (mantissa, exponent) = split_double(value);
            let shift = exponent - lowest_bit;
            let modulus = if mantissa == 0 {
                BigInt::ZERO
            } else if shift >= 0 {
                BigInt::from(mantissa) << shift
            } else {
                BigInt::from(mantissa) >> -shift
            };
            if value < 0.0 { -modulus } else { modulus }
        };
        Self::new(list.iter().rev().map(integer).collect())
    }

    /// Returns the coefficients, lowest power first.
    pub(super) fn coefficients(&self) -> &[BigInt] {
        &self.0
    }

    /// Returns the degree, or 0 for the zero polynomial.
    pub(super) fn degree(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    /// Returns whether no coefficient is positive, so that the polynomial is not positive at any time after 0.
    pub(super) fn is_never_positive_after_zero(&self) -> bool {
        self.0.iter().all(|value| sign(value) <= 0)
    }

    /// Returns whether no coefficient is negative and one is positive, so that the polynomial is positive after 0.
    pub(super) fn is_always_positive_after_zero(&self) -> bool {
        !self.0.is_empty() && self.0.iter().all(|value| sign(value) >= 0)
    }

    /// Returns the sign of the polynomial at a time.
    pub(super) fn sign_at(&self, time: &DyadicNumber) -> i8 {
        // Horner's rule, with everything multiplied by 2^(exponent * degree).
        let mut value = BigInt::ZERO;
        for (step, coefficient) in (0_u64..).zip(self.0.iter().rev()) {
            value = value * &time.numerator + (coefficient << (time.exponent * step));
        }
        sign(&value)
    }

    /// Returns the sign right after a time, which is that of the first nonzero derivative.
    pub(super) fn sign_after(&self, time: &DyadicNumber) -> i8 {
        let mut derivative = self.clone();
        while !derivative.0.is_empty() {
            let sign = derivative.sign_at(time);
            if sign != 0 {
                return sign;
            }
            derivative = derivative.derivative();
        }
        0
    }

    /// Returns whether the polynomial is positive right after 1.
    pub(super) fn is_positive_right_of_one(&self) -> bool {
        self.sign_after(&DyadicNumber::one()) > 0
    }

    /// Returns the polynomial in `t + 1`.
    pub(super) fn shift_by_one(&self) -> Self {
        let mut coefficients = self.0.clone();
        for row in 1..coefficients.len() {
            for i in (row - 1..coefficients.len() - 1).rev() {
                let (low, high) = coefficients.split_at_mut(i + 1);
                low[i] += &high[0];
            }
        }
        Self::new(coefficients)
    }

    /// Returns the polynomial in `t / 2`, times `2^degree`.
    pub(super) fn halve_argument(&self) -> Self {
        let degree = self.degree();
        Self(self.0.iter().enumerate().map(|(i, value)| value << (degree - i)).collect())
    }

    fn derivative(&self) -> Self {
        Self::new(self.0.iter().enumerate().skip(1).map(|(i, value)| value * BigInt::from(i)).collect())
    }

    /// Returns the product of both polynomials.
    fn multiply(&self, other: &Self) -> Self {
        let mut product = vec![BigInt::ZERO; (self.0.len() + other.0.len()).saturating_sub(1)];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        Self::new(product)
    }

    /// Returns the polynomial divided by the greatest common divisor of its coefficients.
    fn primitive_part(self) -> Self {
        let content = self.0.iter().fold(BigInt::ZERO, |divisor, value| common_divisor(divisor, value.clone()));
        if content.sign() == Sign::NoSign || content == BigInt::from(1) {
            return self;
        }
        Self(self.0.iter().map(|value| value / &content).collect())
    }

    /// Returns the remainder of a nonzero multiple of `self`. The divisor must not be zero.
    fn pseudo_remainder(&self, divisor: &Self) -> Self {
        let mut rest = self.clone();
        let leading = &divisor.0[divisor.degree()];
        while rest.0.len() >= divisor.0.len() {
            let shift = rest.0.len() - divisor.0.len();
            let top = rest.0[rest.degree()].clone();
            for value in &mut rest.0 {
                *value *= leading;
            }
            for (i, value) in divisor.0.iter().enumerate() {
                rest.0[i + shift] -= &top * value;
            }
            rest = Self::new(rest.0);
        }
        rest
    }

    /// Returns the primitive greatest common divisor. Neither polynomial may be zero.
    fn common_factor(&self, other: &Self) -> Self {
        if self.is_coprime_modulo_prime(other) {
            return Self::one();
        }
        let (mut a, mut b) = (self.clone().primitive_part(), other.clone().primitive_part());
        while !b.0.is_empty() {
            let rest = a.pseudo_remainder(&b).primitive_part();
            a = std::mem::replace(&mut b, rest);
        }
        if a.degree() == 0 { Self::one() } else { a }
    }

    /// Returns whether the two have no common zero modulo [`MODULUS`]. This proves that they have none at all, because
    /// reduction keeps a common factor's degree if it keeps a leading coefficient. If it does not, returns `false`.
    fn is_coprime_modulo_prime(&self, other: &Self) -> bool {
        let reduced = |polynomial: &Self| -> Vec<u64> { polynomial.0.iter().map(reduce_modulo_prime).collect() };
        let (mut a, mut b) = (reduced(self), reduced(other));
        if a.last() == Some(&0) || b.last() == Some(&0) {
            return false;
        }
        while !b.is_empty() {
            reduce_polynomial(&mut a, &b);
            std::mem::swap(&mut a, &mut b);
        }
        a.len() == 1
    }

    /// Returns the quotient by a primitive divisor that leaves no remainder.
    fn divide_by(&self, divisor: &Self) -> Self {
        if divisor.degree() == 0 {
            return self.clone();
        }
        let leading = &divisor.0[divisor.degree()];
        let mut rest = self.0.clone();
        let mut quotient = vec![BigInt::ZERO; rest.len() + 1 - divisor.0.len()];
        for shift in (0..quotient.len()).rev() {
            let factor = &rest[shift + divisor.degree()] / leading;
            for (i, value) in divisor.0.iter().enumerate() {
                rest[i + shift] -= &factor * value;
            }
            quotient[shift] = factor;
        }
        debug_assert!(rest.iter().all(|value| value.sign() == Sign::NoSign), "not a divisor");
        Self::new(quotient)
    }

    /// Returns a polynomial with the same zeros, each of them simple. `self` must not be zero.
    pub(super) fn square_free_part(&self) -> Self {
        let derivative = self.derivative();
        if derivative.0.is_empty() { self.clone() } else { self.divide_by(&self.common_factor(&derivative)) }
    }

    /// Returns a square-free polynomial with the zeros of both polynomials. Both must be square-free and not zero.
    pub(super) fn unite(&self, other: &Self) -> Self {
        self.multiply(&other.divide_by(&self.common_factor(other)))
    }
}

/// Returns the nonnegative greatest common divisor, by Euclid's algorithm.
fn common_divisor(mut a: BigInt, mut b: BigInt) -> BigInt {
    while b.sign() != Sign::NoSign {
        let rest = &a % &b;
        a = std::mem::replace(&mut b, rest);
    }
    if a.sign() == Sign::Minus { -a } else { a }
}

fn reduce_modulo_prime(value: &BigInt) -> u64 {
    let rest = u64::try_from(BigInt::from(value.magnitude() % MODULUS)).unwrap_or(0);
    if value.sign() == Sign::Minus && rest != 0 { MODULUS - rest } else { rest }
}

fn multiply_modulo_prime(a: u64, b: u64) -> u64 {
    u64::try_from(u128::from(a) * u128::from(b) % u128::from(MODULUS)).unwrap_or(0)
}

/// Replaces `a` by its remainder after division by `b` (last entry not 0), up to a factor and modulo [`MODULUS`].
fn reduce_polynomial(a: &mut Vec<u64>, b: &[u64]) {
    while a.len() >= b.len() {
        let (top, leading, shift) = (a[a.len() - 1], b[b.len() - 1], a.len() - b.len());
        for value in a.iter_mut() {
            *value = multiply_modulo_prime(*value, leading);
        }
        for (i, &value) in b.iter().enumerate() {
            a[i + shift] = (a[i + shift] + MODULUS - multiply_modulo_prime(top, value)) % MODULUS;
        }
        while a.last() == Some(&0) {
            a.pop();
        }
    }
}
