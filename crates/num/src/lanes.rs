//! Several numbers that undergo the same operations together, as in vector instructions: the formulas of several pairs
//! take the time of one.
//!
//! Each lane rounds like a single number (IEEE 754, no fused operations), so no bit depends on the grouping of numbers.
//! Only the sign of a NaN may differ, because the compiler chooses it, so code that needs its bits must exclude NaN.
//! The number of lanes depends on the machine ([`Instructions`]); it is one without wide instructions.
use super::vector::Vec2;
use pulp::Arch;
pub use pulp::Simd;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// The number type of the detection formulas: one number, or a lane for each of several pairs. It can be multiplied by
/// an `f64` on its left.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> {}

impl<N> Number for N where N: Copy + Add<Output = N> + Sub<Output = N> + Mul<Output = N> + Neg<Output = N> {}

/// A number that has an absolute value.
pub trait Modulus {
    /// Returns the absolute value.
    #[must_use]
    fn modulus(self) -> Self;
}

impl Modulus for f64 {
    #[inline(always)]
    fn modulus(self) -> Self {
        self.abs()
    }
}

/// A vector in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Plane<N> {
    /// The component to the right.
    pub x: N,
    /// The component upward.
    pub y: N,
}

impl<N: Number> Plane<N> {
    /// Returns the inner product `x*x' + y*y'`.
    #[inline(always)]
    pub fn dot(self, other: Self) -> N {
        self.x * other.x + self.y * other.y
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

/// The maximum number of lanes of any machine.
pub const MAX_LANES: usize = 8;

/// The widest instructions of this machine.
#[derive(Debug, Clone, Copy)]
pub struct Instructions(Arch);

impl Default for Instructions {
    fn default() -> Self {
        Self(Arch::new())
    }
}

/// The minimum number of pairs, in all steps of a scene, for which wide instructions are worth a check. A virtual
/// machine may take 0.1 ms to list its processor's instructions.
const MIN_PAIRS: u64 = 1000;

/// The minimum number of unknowns of a system of linear equations for which wide instructions are worth a check.
const MIN_UNKNOWNS: usize = 8;

impl Instructions {
    /// Returns the widest instructions for `pairs` pairs in all steps of a scene, if the check is worth the time.
    pub fn for_pairs(pairs: u64) -> Self {
        if pairs < MIN_PAIRS { Self::scalar() } else { Self::default() }
    }

    /// Returns the widest instructions for systems of linear equations with `unknowns` unknowns, if the check is worth
    /// the time.
    pub fn for_unknowns(unknowns: usize) -> Self {
        if unknowns < MIN_UNKNOWNS { Self::scalar() } else { Self::default() }
    }

    /// Returns instructions with one lane, on every machine.
    pub const fn scalar() -> Self {
        Self(Arch::Scalar)
    }

    /// Runs the work with these instructions, and returns its result.
    #[inline]
    pub fn run<W: LaneWork>(self, work: W) -> W::Output {
        self.0.dispatch(DispatchedWork(work))
    }
}

/// Work that is done in lanes.
pub trait LaneWork {
    /// The type of the result.
    type Output;
    /// Runs the work, and returns its result. Callers of this function are compiled once for each set of instructions.
    /// It must therefore be inlined, like everything that it calls. It must not use closures, because these would be
    /// compiled for other instructions.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

struct DispatchedWork<W>(W);

impl<W: LaneWork> pulp::WithSimd for DispatchedWork<W> {
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
    /// The number of lanes.
    pub const COUNT: usize = S::F64_LANES;

    /// Returns one number in all lanes.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self { simd, values: simd.splat_f64s(value) }
    }

    /// Returns one number in as many lanes as `self` has.
    #[inline(always)]
    pub fn splat_like(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }

    /// Reads the first numbers of a slice.
    ///
    /// # Panics
    /// Panics if the slice has too few numbers.
    #[inline(always)]
    pub fn load(simd: S, numbers: &[f64]) -> Self {
        Self { simd, values: S::as_simd_f64s(&numbers[..Self::COUNT]).0[0] }
    }

    /// Writes the lanes to the front of a slice.
    ///
    /// # Panics
    /// Panics if the slice is too short.
    #[inline(always)]
    pub fn store(self, numbers: &mut [f64]) {
        S::as_mut_simd_f64s(&mut numbers[..Self::COUNT]).0[0] = self.values;
    }

    /// Writes the numbers of each lane one after the other, four at a time; the numbers of the next lane begin `stride`
    /// later.
    ///
    /// # Panics
    /// Panics if the slice is too short.
    #[inline(always)]
    pub fn store_by_lane<const FOURS: usize>(numbers: &[[Self; 4]; FOURS], stride: usize, rows: &mut [f64]) {
        for (four, [a, b, c, d]) in numbers.iter().enumerate() {
            if Self::COUNT == 4 {
                // If there are as many vectors as lanes, this is a transposition, which takes four instructions for
                // eight.
                let turned = a.simd.interleave_shfl_f64s([a.values, b.values, c.values, d.values]);
                for (lane, values) in turned.into_iter().enumerate() {
                    let begin = lane * stride + 4 * four;
                    S::as_mut_simd_f64s(&mut rows[begin..begin + 4]).0[0] = values;
                }
            } else {
                for (number, lanes) in [a, b, c, d].into_iter().enumerate() {
                    let mut single = [0.0; MAX_LANES];
                    lanes.store(&mut single);
                    for (lane, value) in single[..Self::COUNT].iter().enumerate() {
                        rows[lane * stride + 4 * four + number] = *value;
                    }
                }
            }
        }
    }

    /// Returns the absolute values.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self { values: self.simd.abs_f64s(self.values), ..self }
    }

    /// Returns the larger number of each lane. No number may be NaN.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self { values: self.simd.max_f64s(self.values, other.values), ..self }
    }

    /// Returns the largest of the lanes' numbers. No number may be NaN.
    #[inline(always)]
    pub fn largest(self) -> f64 {
        self.simd.reduce_max_f64s(self.values)
    }

    /// Returns the lanes in which a number is less than the other.
    #[inline(always)]
    pub fn lt(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, lanes: self.simd.less_than_f64s(self.values, other.values) }
    }

    /// Returns the lanes in which a number is at most the other.
    #[inline(always)]
    pub fn le(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, lanes: self.simd.less_than_or_equal_f64s(self.values, other.values) }
    }

    /// Returns the lanes whose number is less than `bound`.
    #[inline(always)]
    pub fn is_below(self, bound: f64) -> Mask<S> {
        self.lt(self.splat_like(bound))
    }

    /// Returns the lanes whose number is at least `bound`.
    #[inline(always)]
    pub fn is_at_least(self, bound: f64) -> Mask<S> {
        self.splat_like(bound).le(self)
    }

    /// Returns the lanes whose number is zero.
    #[inline(always)]
    pub fn is_zero(self) -> Mask<S> {
        Mask { simd: self.simd, lanes: self.simd.equal_f64s(self.values, self.splat_like(0.0).values) }
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
        Lanes::splat(other.simd, self) * other
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

/// A boolean per lane.
#[derive(Debug, Clone, Copy)]
pub struct Mask<S: Simd> {
    simd: S,
    lanes: S::m64s,
}

impl<S: Simd> Mask<S> {
    /// Returns the number in lanes that are set, and 0 in the others.
    #[inline(always)]
    pub fn select_or_zero(self, number: f64) -> Lanes<S> {
        let simd = self.simd;
        let mask = if Lanes::<S>::COUNT > 1 {
            // A lane has all bits set or none, as in a mask of several lanes. A selection would test this again.
            pulp::bytemuck::pod_read_unaligned(pulp::bytemuck::bytes_of(&self.lanes))
        } else {
            simd.select_u64s(self.lanes, simd.splat_u64s(u64::MAX), simd.splat_u64s(0))
        };
        let bits = simd.and_u64s(mask, simd.splat_u64s(number.to_bits()));
        Lanes { simd, values: simd.transmute_f64s_u64s(bits) }
    }

    /// Returns whether any lane is set.
    #[inline(always)]
    pub fn any(self) -> bool {
        self.simd.first_true_m64s(self.lanes) < S::F64_LANES
    }

    /// Returns whether all lanes are set.
    #[inline(always)]
    pub fn all(self) -> bool {
        !(!self).any()
    }
}

/// Sets lanes that are set in both masks.
impl<S: Simd> BitAnd for Mask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self { lanes: self.simd.and_m64s(self.lanes, other.lanes), ..self }
    }
}

/// Sets lanes that are set in at least one mask.
impl<S: Simd> BitOr for Mask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self { lanes: self.simd.or_m64s(self.lanes, other.lanes), ..self }
    }
}

/// Sets lanes that are not set in the mask.
impl<S: Simd> Not for Mask<S> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self { lanes: self.simd.not_m64s(self.lanes), ..self }
    }
}

/// Writes numbers as little-endian bytes, in one copy if the machine stores them in that form.
///
/// # Panics
/// Panics if there is too little room for all numbers.
#[inline(always)]
pub fn copy_little_endian(numbers: &[f64], room: &mut [u8]) {
    let room = &mut room[..8 * numbers.len()];
    if cfg!(target_endian = "little") {
        room.copy_from_slice(pulp::bytemuck::cast_slice(numbers));
    } else {
        for (bytes, number) in room.as_chunks_mut::<8>().0.iter_mut().zip(numbers) {
            *bytes = number.to_le_bytes();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Rows;

    impl LaneWork for Rows {
        type Output = (usize, Vec<f64>);
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) -> Self::Output {
            let from = |first: u32| {
                let values: [f64; MAX_LANES] = std::array::from_fn(|lane| f64::from(first) + 0.125 * lane as f64);
                Lanes::load(simd, &values)
            };
            let sum = from(4).is_at_least(4.125).select_or_zero(-2.5) + from(0).is_below(0.25).select_or_zero(1.0);
            let numbers = [[from(0), from(1), from(2), from(3)], [sum, from(5), from(6), from(7)]];
            let mut rows = vec![-1.0; 9 * Lanes::<S>::COUNT];
            Lanes::store_by_lane(&numbers, 9, &mut rows);
            (Lanes::<S>::COUNT, rows)
        }
    }

    #[test]
    fn bytes_are_little_endian() {
        let mut room = [7; 18];
        copy_little_endian(&[-0.25, 1.0], &mut room);
        assert_eq!(room, [0, 0, 0, 0, 0, 0, 0xd0, 0xbf, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f, 7, 7]);
    }

    #[test]
    fn the_numbers_of_a_lane_stand_one_behind_the_other() {
        for instructions in [Instructions::default(), Instructions::scalar()] {
            let (count, rows) = instructions.run(Rows);
            assert_eq!(rows.len(), 9 * count);
            for (lane, row) in rows.chunks(9).enumerate() {
                let sum = [1.0, -1.5, -2.5][lane.min(2)];
                let value = |number: u32| f64::from(number) + 0.125 * lane as f64;
                let expected = [value(0), value(1), value(2), value(3), sum, value(5), value(6), value(7), -1.0];
                assert_eq!(row, expected);
            }
        }
    }
}
