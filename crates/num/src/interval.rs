//! Sorted lists of disjoint intervals of time, in fixed storage.
//!
//! Intervals are closed where they meet: touching intervals merge, and an intersection may be a single point
//! (root-finder.md 15.4 and 16). The lists never allocate.

/// The times from `lo` to `hi`, either of which may be infinite. `lo <= hi` unless a bound is NaN.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Interval {
    /// The lower end of the interval, as a fraction of the step.
    pub lo: f64,
    /// The upper end of the interval.
    pub hi: f64,
}

impl Interval {
    /// The interval of all times.
    pub const ALL_TIMES: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    /// Returns whether the two intervals share a point. Ends that are equal count as shared, and an interval with a NaN
    /// bound shares none.
    #[inline]
    pub fn touches(self, other: Self) -> bool {
        other.lo <= self.hi && self.lo <= other.hi
    }
}

/// A list of at most `CAPACITY` intervals. It is normalized (sorted, and without intervals that touch), except while it
/// is filled.
///
/// The positive set of a polynomial of degree six has at most four intervals, and that of a parabola two. An
/// intersection with a further set adds at most one interval less than this set has.
#[derive(Debug, Clone, Copy)]
pub struct Intervals<const CAPACITY: usize> {
    length: usize,
    list: [Interval; CAPACITY],
}

impl<const CAPACITY: usize> Intervals<CAPACITY> {
    /// The empty set.
    pub const EMPTY: Self = Self { length: 0, list: [Interval { lo: 0.0, hi: 0.0 }; CAPACITY] };

    /// Returns the intervals, in order.
    #[inline]
    pub fn as_slice(&self) -> &[Interval] {
        &self.list[..self.length]
    }

    /// Appends an interval without merging it.
    ///
    /// # Panics
    /// Panics if the list already contains `CAPACITY` intervals.
    #[inline]
    pub fn push(&mut self, interval: Interval) {
        self.list[self.length] = interval;
        self.length += 1;
    }

    /// Sorts by `lo` (stable) and merges neighbors that touch (root-finder.md 15.4).
    #[inline]
    pub fn normalize(&mut self) {
        if self.length < 2 {
            return;
        }
        for i in 1..self.length {
            let moved = self.list[i];
            let mut index = i;
            while index > 0 && self.list[index - 1].lo > moved.lo {
                self.list[index] = self.list[index - 1];
                index -= 1;
            }
            self.list[index] = moved;
        }
        let mut last = 0;
        for i in 1..self.length {
            let (current, next) = (self.list[last], self.list[i]);
            if current.touches(next) {
                self.list[last] = Interval { lo: current.lo.min(next.lo), hi: current.hi.max(next.hi) };
            } else {
                last += 1;
                self.list[last] = next;
            }
        }
        self.length = last + 1;
    }

    /// Returns the times that are in both lists (root-finder.md 16.1). Intervals that only touch give a single point.
    ///
    /// # Panics
    /// Panics if the result would contain more than `CAPACITY` intervals.
    #[inline]
    pub fn intersection<const OTHER: usize>(&self, other: &Intervals<OTHER>) -> Self {
        let mut both = Self::EMPTY;
        for &a in self.as_slice() {
            for &b in other.as_slice() {
                if a.touches(b) {
                    both.push(Interval { lo: a.lo.max(b.lo), hi: a.hi.min(b.hi) });
                }
            }
        }
        both.normalize();
        both
    }

    /// Returns the first time of the set from `now` on, `+inf` if none (root-finder.md 16.2). An interval that ends
    /// exactly at `now` does not count.
    #[inline]
    pub fn next_time(&self, now: f64) -> f64 {
        for interval in self.as_slice() {
            // An interval with a NaN end is not skipped.
            if interval.hi <= now {
                continue;
            }
            return if interval.lo <= now { now } else { interval.lo };
        }
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::{Interval, Intervals};

    fn intervals(list: &[(f64, f64)]) -> Intervals<4> {
        let mut intervals = Intervals::EMPTY;
        for &(lo, hi) in list {
            intervals.push(Interval { lo, hi });
        }
        intervals.normalize();
        intervals
    }

    fn pairs(intervals: &Intervals<4>) -> Vec<(f64, f64)> {
        intervals.as_slice().iter().map(|interval| (interval.lo, interval.hi)).collect()
    }

    #[test]
    fn normalizing_sorts_and_merges_what_touches() {
        assert_eq!(pairs(&intervals(&[(3.0, 4.0), (0.0, 1.0), (1.0, 2.0)])), [(0.0, 2.0), (3.0, 4.0)]);
        assert_eq!(pairs(&intervals(&[(0.0, 5.0), (1.0, 2.0), (6.0, 7.0)])), [(0.0, 5.0), (6.0, 7.0)]);
    }

    #[test]
    fn intersections_keep_single_points() {
        let both = intervals(&[(0.0, 1.0), (2.0, 5.0)]).intersection(&intervals(&[(1.0, 3.0), (4.0, 9.0)]));
        assert_eq!(pairs(&both), [(1.0, 1.0), (2.0, 3.0), (4.0, 5.0)]);
    }

    #[test]
    fn the_next_time_skips_what_has_ended() {
        let set = intervals(&[(-2.0, 0.0), (0.5, 1.0)]);
        assert_eq!(set.next_time(0.0), 0.5);
        assert_eq!(set.next_time(0.75), 0.75);
        assert_eq!(set.next_time(1.0), f64::INFINITY);
        assert_eq!(Intervals::<4>::EMPTY.next_time(0.0), f64::INFINITY);
    }
}
