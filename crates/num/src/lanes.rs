//! Several numbers that undergo the same operations at once, as processors do: the formulas of several pairs for the time of
//! one.
//!
//! Each lane rounds like a single number (IEEE 754, no fused operations), so no bit depends on how numbers are put together.
//! Only the sign of a NaN may differ, which is the compiler's choice: whoever needs its bits keeps NaN out. How many lanes
//! there are depends on the machine ([`Instructions`]); on one without wide instructions it is one.
use super::vector::Vec2;
use pulp::Arch;
pub use pulp::Simd;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// What the formulas of detection compute with: one number, or a lane of each of several pairs. Besides, a `f64` in front
/// multiplies it.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> {}

impl<N> Number for N where N: Copy + Add<Output = N> + Sub<Output = N> + Mul<Output = N> + Neg<Output = N> {}

/// A number with a modulus.
pub trait Modulus {
    /// The modulus.
    #[must_use]
    fn modulus(self) -> Self;
}

impl Modulus for f64 {
    #[inline(always)]
    fn modulus(self) -> Self {
        self.abs()
    }
}

impl<S: Simd> Modulus for Lanes<S> {
    #[inline(always)]
    fn modulus(self) -> Self {
        self.abs()
    }
}

/// A vector in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Plane<N> {
    /// To the right.
    pub x: N,
    /// Up.
    pub y: N,
}

impl<N: Number> Plane<N> {
    /// The inner product `x*x' + y*y'`.
    #[inline(always)]
    pub fn dot(self, other: Self) -> N {
        self.x * other.x + self.y * other.y
    }

    /// The third component of the cross product, `x*y' - y*x'`.
    #[inline(always)]
    pub fn cross(self, other: Self) -> N {
        self.x * other.y - self.y * other.x
    }
}

impl From<Vec2> for Plane<f64> {
    #[inline(always)]
    fn from(v: Vec2) -> Self {
        Self { x: v.x, y: v.y }
    }
}

impl<N: Number> Add for Plane<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }
}

impl<N: Number> Sub for Plane<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }
}

/// Most lanes that any machine has.
pub const MOST_LANES: usize = 8;

/// The widest instructions of this machine.
#[derive(Debug, Clone, Copy)]
pub struct Instructions(Arch);

impl Default for Instructions {
    fn default() -> Self {
        Self(Arch::new())
    }
}

/// Fewer pairs than this are not worth looking for wide instructions.
const FEW_PAIRS: usize = 8;

impl Instructions {
    /// The widest instructions, where so many pairs are looked at together that it pays to look for them: a virtual machine may
    /// take longer to say what its processor can do than small scenes take to simulate.
    #[must_use]
    pub fn for_pairs(pairs: usize) -> Self {
        if pairs < FEW_PAIRS { Self::plain() } else { Self::default() }
    }

    /// One lane, on every machine.
    #[must_use]
    pub const fn plain() -> Self {
        Self(Arch::Scalar)
    }

    /// Does a piece of work with these instructions.
    #[inline]
    pub fn run<W: Work>(self, work: W) -> W::Output {
        self.0.dispatch(Dispatched(work))
    }
}

/// Something to be done in lanes.
pub trait Work {
    /// What it yields.
    type Output;
    /// Does it. To be inlined always, with all that it calls and without closures, which would be compiled for other
    /// instructions: the callers are compiled once for each set.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

struct Dispatched<W>(W);

impl<W: Work> pulp::WithSimd for Dispatched<W> {
    type Output = W::Output;
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> W::Output {
        self.0.run(simd)
    }
}

/// A number per lane.
#[derive(Debug, Clone, Copy)]
pub struct Lanes<S: Simd> {
    simd: S,
    values: S::f64s,
}

impl<S: Simd> Lanes<S> {
    /// How many there are.
    pub const COUNT: usize = S::F64_LANES;

    /// The same number in all lanes.
    #[inline(always)]
    pub fn all(simd: S, value: f64) -> Self {
        Self { simd, values: simd.splat_f64s(value) }
    }

    /// The same number in as many lanes as these.
    #[inline(always)]
    pub fn like(self, value: f64) -> Self {
        Self::all(self.simd, value)
    }

    /// The first numbers of a slice.
    ///
    /// # Panics
    /// When it has too few.
    #[inline(always)]
    pub fn load(simd: S, numbers: &[f64]) -> Self {
        Self { simd, values: S::as_simd_f64s(&numbers[..Self::COUNT]).0[0] }
    }

    /// Writes the lanes to the front of a slice.
    ///
    /// # Panics
    /// When it is too short.
    #[inline(always)]
    pub fn store(self, numbers: &mut [f64]) {
        S::as_mut_simd_f64s(&mut numbers[..Self::COUNT]).0[0] = self.values;
    }

    /// The moduli.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self { values: self.simd.abs_f64s(self.values), ..self }
    }

    /// The larger number of each lane, of numbers.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self { values: self.simd.max_f64s(self.values, other.values), ..self }
    }

    /// The largest of all lanes, of numbers.
    #[inline(always)]
    pub fn largest(self) -> f64 {
        self.simd.reduce_max_f64s(self.values)
    }

    /// Where a lane is less than the other one.
    #[inline(always)]
    pub fn lt(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, lanes: self.simd.less_than_f64s(self.values, other.values) }
    }

    /// Where a lane is less than the other one or equal.
    #[inline(always)]
    pub fn le(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, lanes: self.simd.less_than_or_equal_f64s(self.values, other.values) }
    }

    /// Where a lane is equal to the other one.
    #[inline(always)]
    pub fn equals(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, lanes: self.simd.equal_f64s(self.values, other.values) }
    }

    /// Where a lane is the other one bit for bit.
    #[inline(always)]
    pub fn is_same(self, other: Self) -> Mask<S> {
        let (own, other) = (self.simd.transmute_u64s_f64s(self.values), self.simd.transmute_u64s_f64s(other.values));
        Mask { simd: self.simd, lanes: self.simd.equal_u64s(own, other) }
    }

    /// Where a lane is less than a number.
    #[inline(always)]
    pub fn below(self, bound: f64) -> Mask<S> {
        self.lt(self.like(bound))
    }

    /// Where a lane is at least as large as a number.
    #[inline(always)]
    pub fn at_least(self, bound: f64) -> Mask<S> {
        self.like(bound).le(self)
    }

    /// Where a lane is zero.
    #[inline(always)]
    pub fn is_zero(self) -> Mask<S> {
        self.equals(self.like(0.0))
    }
}

impl<S: Simd> Add for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { values: self.simd.add_f64s(self.values, other.values), ..self }
    }
}

impl<S: Simd> Sub for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { values: self.simd.sub_f64s(self.values, other.values), ..self }
    }
}

impl<S: Simd> Mul for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self { values: self.simd.mul_f64s(self.values, other.values), ..self }
    }
}

impl<S: Simd> Mul<Lanes<S>> for f64 {
    type Output = Lanes<S>;
    #[inline(always)]
    fn mul(self, other: Lanes<S>) -> Lanes<S> {
        Lanes::all(other.simd, self) * other
    }
}

impl<S: Simd> Div for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self { values: self.simd.div_f64s(self.values, other.values), ..self }
    }
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { values: self.simd.neg_f64s(self.values), ..self }
    }
}

/// Yes or no per lane.
#[derive(Debug, Clone, Copy)]
pub struct Mask<S: Simd> {
    simd: S,
    lanes: S::m64s,
}

impl<S: Simd> Mask<S> {
    /// 1 where it says yes, 0 elsewhere.
    #[inline(always)]
    pub fn as_numbers(self) -> Lanes<S> {
        let (one, zero) = (self.simd.splat_f64s(1.0), self.simd.splat_f64s(0.0));
        Lanes { simd: self.simd, values: self.simd.select_f64s(self.lanes, one, zero) }
    }

    /// The one number of each lane where it says yes, the other one elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn choose(self, yes: Lanes<S>, no: Lanes<S>) -> Lanes<S> {
        Lanes { simd: self.simd, values: self.simd.select_f64s(self.lanes, yes.values, no.values) }
    }

    /// Whether any lane says yes.
    #[inline(always)]
    pub fn any(self) -> bool {
        self.simd.first_true_m64s(self.lanes) < S::F64_LANES
    }

    /// Whether all lanes say yes.
    #[inline(always)]
    pub fn all(self) -> bool {
        !(!self).any()
    }
}

/// Where both say yes.
impl<S: Simd> BitAnd for Mask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self { lanes: self.simd.and_m64s(self.lanes, other.lanes), ..self }
    }
}

/// Where one says yes.
impl<S: Simd> BitOr for Mask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self { lanes: self.simd.or_m64s(self.lanes, other.lanes), ..self }
    }
}

/// Where it says no.
impl<S: Simd> Not for Mask<S> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self { lanes: self.simd.not_m64s(self.lanes), ..self }
    }
}
