//! Particles of similar radii in strips, which are rows of the plane as high as the reach of two particles, each sorted
//! by x.
//!
//! Rows are numbered by a cast, which rounds toward zero. The strip around zero is therefore twice as high, and row
//! numbers differ by no more than with floors. Few particles change their order between searches, so sorting takes few
//! insertions.
use super::MIN_REACH;
use fosssim_num::vector::{Vec2, vector_at};
use std::cmp::Ordering;

/// The factor by which strips are higher than the reach of two particles, so that rounding never puts two particles in
/// reach more than one row apart.
const HEIGHT_FACTOR: f64 = 1.0 + 1e-6;

/// The first row at which the rounding error of a position may be a noticeable part of the height of a row.
const ROUNDED_ROW: i64 = 1 << 30;

/// The first row, which contains all lower particles. The last row contains all higher ones.
const FIRST_ROW: i64 = -LAST_ROW;
const LAST_ROW: i64 = i64::MAX - 8;

/// A particle at the last search.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlacedParticle {
    row: i64,
    pub position: Vec2,
    pub particle: u32,
}

/// The particles of one row, from `start` to `end` in the list of all particles.
#[derive(Debug, Clone, Copy)]
struct Strip {
    number: i64,
    start: usize,
    end: usize,
}

/// Particles of similar radii, sorted.
#[derive(Debug, Clone)]
pub(super) struct Strips {
    entries: Vec<PlacedParticle>,
    /// The rows that have particles, in order.
    rows: Vec<Strip>,
    /// The largest radius.
    radius: f64,
    /// The maximum reach of any two particles.
    reach: f64,
    /// The distance along x beyond which two particles are not in reach. It is not so small that its square underflows.
    width: f64,
    /// The number of rows per length.
    density: f64,
}

/// An axis-aligned rectangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rectangle {
    pub low: Vec2,
    pub high: Vec2,
}

impl Strips {
    /// Creates strips for particles with their radii. Two particles are in reach if they are closer than the sum of
    /// their radii and `margin`.
    pub fn new(members: &[(u32, f64)], margin: f64) -> Self {
        let radius = members.iter().map(|member| member.1).fold(f64::NEG_INFINITY, f64::max);
        let reach = (radius + radius) + margin;
        let zero = Vec2::zeros();
        let entry = |&(particle, _): &(u32, f64)| PlacedParticle { row: 0, position: zero, particle };
        Self {
            entries: members.iter().map(entry).collect(),
            rows: Vec::new(),
            radius,
            reach,
            width: reach.max(MIN_REACH),
            density: 1.0 / (reach * HEIGHT_FACTOR).max(MIN_REACH),
        }
    }

    /// Returns the largest radius.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns all particles with a finite position.
    pub fn entries(&self) -> &[PlacedParticle] {
        let end = self.rows.last().map_or(0, |row| row.end);
        &self.entries[..end]
    }

    /// Sorts the particles by their current positions. Particles without a finite position are left out.
    pub fn update(&mut self, x: &[f64]) {
        for entry in &mut self.entries {
            let position = vector_at(x, entry.particle as usize);
            (entry.row, entry.position) = if position.x.is_finite() && position.y.is_finite() {
                (row_of(position.y, self.density), position)
            } else {
                (i64::MAX, Vec2::new(f64::INFINITY, f64::INFINITY))
            };
        }
        sort_nearly_sorted(&mut self.entries, |one, other| {
            one.row.cmp(&other.row).then(one.position.x.total_cmp(&other.position.x))
        });
        let placed = self.entries.iter().rposition(|entry| entry.position.x.is_finite()).map_or(0, |last| last + 1);
        self.rows.clear();
        for (index, entry) in self.entries[..placed].iter().enumerate() {
            match self.rows.last_mut() {
                Some(row) if row.number == entry.row => row.end = index + 1,
                _ => self.rows.push(Strip { number: entry.row, start: index, end: index + 1 }),
            }
        }
    }

    /// Calls `visit` for all pairs that may reach each other, each once, until it returns false. Returns the number of
    /// tested pairs.
    pub fn visit_pairs(&self, mut visit: impl FnMut(&PlacedParticle, &PlacedParticle) -> bool) -> u64 {
        // If the reach is negative or NaN, no pair is near.
        if !(self.reach > 0.0) {
            return 0;
        }
        let (mut tested, squared) = (0, self.reach * self.reach);
        for (index, row) in self.rows.iter().enumerate() {
            let own = &self.entries[row.start..row.end];
            for (number, one) in own.iter().enumerate() {
                for other in &own[number + 1..] {
                    tested += 1;
                    let n = other.position - one.position;
                    if n.x > self.width {
                        break;
                    }
                    if !(n.dot(&n) > squared) && !visit(one, other) {
                        return tested;
                    }
                }
            }
            let highest = row.number.saturating_add(if row.number.abs() < ROUNDED_ROW { 1 } else { 4 });
            for above in self.rows[index + 1..].iter().take_while(|above| above.number <= highest) {
                let others = &self.entries[above.start..above.end];
                let mut first = 0;
                for one in own {
                    while others.get(first).is_some_and(|other| one.position.x - other.position.x > self.width) {
                        first += 1;
                    }
                    for other in &others[first..] {
                        tested += 1;
                        let n = other.position - one.position;
                        if n.x > self.width {
                            break;
                        }
                        if !(n.dot(&n) > squared) && !visit(one, other) {
                            return tested;
                        }
                    }
                }
            }
        }
        tested
    }

    /// Returns bounds on y for the particles of a row. On each side they are at least one row too wide, because row
    /// numbers are rounded toward zero and y is computed with round-off.
    fn row_bounds(&self, row: i64) -> [f64; 2] {
        let edge_y = |row: i64| match row {
            ..=FIRST_ROW => f64::NEG_INFINITY,
            LAST_ROW.. => f64::INFINITY,
            #[expect(clippy::cast_precision_loss, reason = "heights of such rows are no more precise")]
            row => row as f64 / self.density,
        };
        [edge_y(row.saturating_sub(2)), edge_y(row.saturating_add(2))]
    }

    /// Calls `visit` for all particles in a rectangle, until it returns false. Returns the number of checked particles.
    ///
    /// `narrow` may shorten a row: it receives a lower and an upper bound on y in a row, and returns the part of the
    /// rectangle's width that counts there.
    pub fn visit_rectangle(
        &self,
        rectangle: Rectangle,
        narrow: impl Fn([f64; 2]) -> [f64; 2],
        mut visit: impl FnMut(&PlacedParticle) -> bool,
    ) -> u64 {
        let Rectangle { low, high } = rectangle;
        let (lowest, highest) = (row_of(low.y, self.density), row_of(high.y, self.density));
        let first = self.rows.partition_point(|row| row.number < lowest);
        let mut seen = 0;
        for row in self.rows[first..].iter().take_while(|row| row.number <= highest) {
            let entries = &self.entries[row.start..row.end];
            let [from, to] = narrow(self.row_bounds(row.number));
            let (from, to) = (low.x.max(from), high.x.min(to));
            let first = entries.partition_point(|entry| entry.position.x < from);
            for entry in entries[first..].iter().take_while(|entry| entry.position.x <= to) {
                seen += 1;
                if !visit(entry) {
                    return seen;
                }
            }
        }
        seen
    }
}

/// Returns the row at height `y`. A greater height never gives a lower row.
fn row_of(y: f64, density: f64) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "values that are too large go to the last row")]
    let row = (y * density) as i64;
    row.clamp(FIRST_ROW, LAST_ROW)
}

/// Sorts entries. Nearly sorted lists take one comparison per entry, others are sorted by the standard library.
pub fn sort_nearly_sorted<T: Copy>(entries: &mut [T], compare: impl Fn(&T, &T) -> Ordering) {
    // In a large scene a few percent of the entries change rows in a step, and pass all entries between.
    let mut remaining_moves = 8 * entries.len();
    for index in 1..entries.len() {
        let (entry, mut slot) = (entries[index], index);
        while slot > 0 && compare(&entry, &entries[slot - 1]).is_lt() {
            if remaining_moves == 0 {
                entries[slot] = entry;
                return entries.sort_unstable_by(compare);
            }
            entries[slot] = entries[slot - 1];
            (slot, remaining_moves) = (slot - 1, remaining_moves - 1);
        }
        entries[slot] = entry;
    }
}
