//! Numbers that look random and are the same on every run.

/// Marsaglia's xorshift64* (Vigna, "An experimental exploration of Marsaglia's xorshift generators", 2016).
#[derive(Debug)]
pub struct Dice(u64);

impl Dice {
    /// The dice of one run of many.
    #[must_use]
    pub fn of(seed: u64, run: u64) -> Self {
        let mut dice = Self((seed ^ run.wrapping_mul(0x9e37_79b9_7f4a_7c15)) | 1);
        for _ in 0..4 {
            dice.throw();
        }
        dice
    }

    /// All bits.
    pub fn throw(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    /// A number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        ((self.throw() >> 33) % end.max(1) as u64) as usize
    }

    /// One of these.
    pub fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// A multiple of `unit` between `-most` and `most` of them.
    pub fn number(&mut self, most: i32, unit: f64) -> f64 {
        let whole = i32::try_from(self.below((2 * most + 1) as usize)).unwrap_or(0) - most;
        f64::from(whole) * unit
    }
}
