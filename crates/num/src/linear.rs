//! Gaussian elimination with complete pivoting, in the original's order of operations (simulation.md 5).
//!
//! It serves the implicit integrators, whose matrices have two rows per particle. Every product, subtraction and
//! division happens once and in the order of the specification. The order in which absolute values are compared is
//! free: each column's largest is found while its entries are computed.
use super::lanes::{Instructions, LaneWork, Lanes, Simd};

/// The number of columns that a triangular solve treats as one panel.
const PANEL_COLUMNS: usize = 8;

/// The number of columns of a panel whose products are added to the other rows at a time.
const GROUP_COLUMNS: usize = 4;

/// The scratch memory of [`solve`]. It is kept between calls, so that only the first call of each size allocates
/// memory.
#[derive(Debug, Clone, Default)]
pub struct Workspace {
    row_swaps: Vec<usize>,
    column_order: Vec<usize>,
    moduli: Vec<f64>,
    solution: Vec<f64>,
}

/// Solves `A d = rhs` in place: `matrix` is n x n **column-major** and destroyed, `rhs` becomes the solution.
///
/// n is even. A rank-deficient matrix gives zeros for the unknowns beyond its rank: elimination stops when the largest
/// remaining absolute value is below 2^-52 times the first pivot. NaN entries spread by the arithmetic; no value makes
/// it hang or panic.
///
/// # Panics
/// Panics if the length of `matrix` is not the square of that of `rhs`.
pub fn solve(matrix: &mut [f64], rhs: &mut [f64], workspace: &mut Workspace) {
    let n = rhs.len();
    assert_eq!(matrix.len(), n * n, "the matrix must be square and fit the right-hand side");
    let Workspace { row_swaps, column_order, moduli, solution } = workspace;
    let decomposition = Decomposition { matrix: &mut *matrix, n, row_swaps, column_order, moduli };
    let rank = Instructions::for_unknowns(n).run(decomposition);
    for (k, &row) in row_swaps.iter().enumerate() {
        rhs.swap(k, row);
    }
    forward_substitution(matrix, rhs);
    substitute_back(matrix, rhs, rank);
    solution.clear();
    solution.resize(n, 0.0);
    for (&column, &value) in column_order.iter().zip(&rhs[..rank]) {
        solution[column] = value;
    }
    rhs.copy_from_slice(solution);
}

/// The decomposition of a matrix, which is replaced by its unit lower and its upper triangle, both permuted. The result
/// is the rank.
///
/// `row_swaps[k]` is the row that was exchanged with row k; `column_order[k]` is the original index of the column that
/// is now column k.
struct Decomposition<'a> {
    /// The matrix of size n x n, column by column.
    matrix: &'a mut [f64],
    n: usize,
    row_swaps: &'a mut Vec<usize>,
    column_order: &'a mut Vec<usize>,
    /// For each column, the largest absolute value in the rows that have no pivot yet. NaN is ignored.
    moduli: &'a mut Vec<f64>,
}

impl LaneWork for Decomposition<'_> {
    type Output = usize;

    #[inline(always)]
    fn run<S: Simd>(mut self, simd: S) -> usize {
        let n = self.n;
        self.row_swaps.clear();
        self.row_swaps.extend(0..n);
        self.column_order.clear();
        self.column_order.extend(0..n);
        self.moduli.clear();
        self.moduli.resize(n, 0.0);
        for (modulus, column) in self.moduli.iter_mut().zip(self.matrix.chunks_exact(n.max(1))) {
            *modulus = largest_modulus(simd, column);
        }
        // Without an early exit, the compiler uses vector instructions.
        let may_skip = self.matrix.iter().fold(true, |may, entry| may & (entry.to_bits() != (-0.0_f64).to_bits()));
        let mut cutoff = 0.0;
        for k in 0..n {
            let pivot = self.pivot(k);
            if k == 0 {
                cutoff = pivot.modulus * f64::EPSILON;
            }
            // A NaN pivot does not stop the elimination.
            if pivot.modulus < cutoff {
                return k;
            }
            self.exchange(k, &pivot);
            self.eliminate(simd, k, may_skip);
        }
        n
    }
}

impl Decomposition<'_> {
    /// Returns the entry with the largest absolute value in rows and columns from k on. If several have it, the first
    /// one column by column is returned. NaN never replaces another entry, but a NaN at the start stays.
    #[inline(always)]
    fn pivot(&self, k: usize) -> Pivot {
        let n = self.n;
        let mut best = Pivot { row: k, column: k, modulus: self.matrix[k * n + k].abs() };
        let mut is_first = true;
        for (column, &modulus) in self.moduli.iter().enumerate().skip(k) {
            if modulus > best.modulus {
                best = Pivot { row: k, column, modulus };
                is_first = false;
            }
        }
        if !is_first {
            let entries = &self.matrix[best.column * n + k..(best.column + 1) * n];
            best.row += entries.iter().position(|entry| entry.abs() == best.modulus).unwrap_or(0);
        }
        best
    }

    /// Moves the pivot to row k and column k.
    #[inline(always)]
    fn exchange(&mut self, k: usize, pivot: &Pivot) {
        let n = self.n;
        self.row_swaps[k] = pivot.row;
        // With this check, the compiler can prove that both rows are in each column.
        assert!(k < n && pivot.row < n, "the pivot must be in the matrix");
        if pivot.row != k {
            for column in self.matrix.chunks_exact_mut(n) {
                column.swap(k, pivot.row);
            }
        }
        if pivot.column != k {
            self.column_order.swap(k, pivot.column);
            self.moduli.swap(k, pivot.column);
            let (before, from) = self.matrix.split_at_mut(pivot.column * n);
            // This loop uses vector instructions, unlike `swap_with_slice`.
            for (entry, other) in before[k * n..(k + 1) * n].iter_mut().zip(from) {
                (*entry, *other) = (*other, *entry);
            }
        }
    }

    /// Subtracts multiples of row k from the rows below, and leaves the multipliers in column k. A column with a zero
    /// in row k does not change, unless an entry is a negative zero. No difference of other numbers is a negative zero.
    #[inline(always)]
    fn eliminate<S: Simd>(&mut self, simd: S, k: usize, may_skip: bool) {
        let (n, width) = (self.n, Lanes::<S>::COUNT);
        let (done, rest) = self.matrix.split_at_mut((k + 1) * n);
        let Some((top, multipliers)) = done[k * n + k..].split_first_mut() else { return };
        let reciprocal = 1.0 / *top;
        for multiplier in &mut *multipliers {
            *multiplier *= reciprocal;
        }
        let may_skip = may_skip & multipliers.iter().fold(true, |may, multiplier| may & multiplier.is_finite());
        let (in_lane_multipliers, single_multipliers) = multipliers.split_at(multipliers.len() / width * width);
        for (column, largest) in rest.chunks_exact_mut(n).zip(&mut self.moduli[k + 1..]) {
            let Some((top, below)) = column[k..].split_first_mut() else { return };
            if may_skip && *top == 0.0 {
                continue;
            }
            let (tops, mut moduli) = (Lanes::splat(simd, *top), Lanes::splat(simd, 0.0));
            let (in_lanes, single_entries) = below.split_at_mut(in_lane_multipliers.len());
            for (entries, multipliers) in in_lanes.chunks_exact_mut(width).zip(in_lane_multipliers.chunks_exact(width))
            {
                let difference = Lanes::load(simd, entries) - Lanes::load(simd, multipliers) * tops;
                difference.store(entries);
                moduli = difference.abs().max(moduli);
            }
            *largest = find_largest_modulus(moduli, in_lanes);
            for (entry, multiplier) in single_entries.iter_mut().zip(single_multipliers) {
                *entry -= *multiplier * *top;
                *largest = max_modulus(*largest, *entry);
            }
        }
    }
}

/// An entry of the matrix.
struct Pivot {
    row: usize,
    column: usize,
    modulus: f64,
}

/// Returns the largest absolute value of a column's entries. NaN is ignored.
#[inline(always)]
fn largest_modulus<S: Simd>(simd: S, entries: &[f64]) -> f64 {
    let (in_lanes, single_entries) = entries.split_at(entries.len() / Lanes::<S>::COUNT * Lanes::<S>::COUNT);
    let mut moduli = Lanes::splat(simd, 0.0);
    for entries in in_lanes.chunks_exact(Lanes::<S>::COUNT) {
        moduli = Lanes::load(simd, entries).abs().max(moduli);
    }
    single_entries.iter().fold(find_largest_modulus(moduli, in_lanes), |largest, entry| max_modulus(largest, *entry))
}

/// Returns the largest absolute value of the entries. With some instructions the larger of a number and NaN is NaN.
#[inline(always)]
fn find_largest_modulus<S: Simd>(moduli: Lanes<S>, entries: &[f64]) -> f64 {
    let largest = moduli.largest();
    if largest.is_nan() { entries.iter().fold(0.0, |largest, entry| max_modulus(largest, *entry)) } else { largest }
}

/// Returns the larger of `modulus` and |entry|. A NaN entry is ignored.
#[inline(always)]
fn max_modulus(modulus: f64, entry: f64) -> f64 {
    if entry.abs() > modulus { entry.abs() } else { modulus }
}

/// Solves with the unit lower triangle, panel by panel.
fn forward_substitution(matrix: &[f64], c: &mut [f64]) {
    let n = c.len();
    for start in (0..n).step_by(PANEL_COLUMNS) {
        let end = n.min(start + PANEL_COLUMNS);
        for i in start..end {
            let value = c[i];
            let column = &matrix[i * n..(i + 1) * n];
            for s in i + 1..end {
                c[s] -= value * column[s];
            }
        }
        if end < n {
            let (panel, below) = c[start..].split_at_mut(PANEL_COLUMNS);
            subtract_panel(&matrix[start * n..end * n], n, end, panel, below);
        }
    }
}

/// Solves with the upper triangle of size `rank`, panel by panel from the end.
fn substitute_back(matrix: &[f64], c: &mut [f64], rank: usize) {
    let n = c.len();
    let mut end = rank;
    while end > 0 {
        let start = end.saturating_sub(PANEL_COLUMNS);
        for i in (start..end).rev() {
            let column = &matrix[i * n..(i + 1) * n];
            c[i] /= column[i];
            let value = c[i];
            for s in start..i {
                c[s] -= value * column[s];
            }
        }
        if start > 0 {
            let (above, panel) = c[..end].split_at_mut(start);
            subtract_panel(&matrix[start * n..end * n], n, 0, panel, above);
        }
        end = start;
    }
}

/// Subtracts a full panel's products from other rows, the first of which is `row`: four columns at a time, in two
/// pairs. A panel that is not full is the last one, with no rows left.
fn subtract_panel(columns: &[f64], n: usize, row: usize, panel: &[f64], rows: &mut [f64]) {
    for (values, columns) in panel.chunks_exact(GROUP_COLUMNS).zip(columns.chunks_exact(GROUP_COLUMNS * n)) {
        let negative: [f64; GROUP_COLUMNS] = std::array::from_fn(|i| -values[i]);
        let [a, b, c, d]: [&[f64]; GROUP_COLUMNS] = std::array::from_fn(|i| &columns[i * n + row..][..rows.len()]);
        for (s, entry) in rows.iter_mut().enumerate() {
            let first = a[s] * negative[0] + b[s] * negative[1];
            let second = c[s] * negative[2] + d[s] * negative[3];
            *entry += first + second;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Workspace, solve};

    /// A small generator of reproducible numbers in (-1, 1).
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    /// Computes the specification literally, with a matrix of rows: slow but simple.
    fn literal(a: &mut [Vec<f64>], rhs: &[f64]) -> Vec<f64> {
        let n = rhs.len();
        let mut c = rhs.to_vec();
        let mut order: Vec<usize> = (0..n).collect();
        let (mut rank, mut cutoff) = (n, 0.0);
        for k in 0..n {
            let (mut row, mut column) = (k, k);
            for j in k..n {
                for i in k..n {
                    if a[i][j].abs() > a[row][column].abs() {
                        (row, column) = (i, j);
                    }
                }
            }
            let pivot = a[row][column].abs();
            if k == 0 {
                cutoff = pivot * f64::from_bits((1023 - 52) << 52);
            }
            if pivot < cutoff {
                rank = k;
                break;
            }
            a.swap(k, row);
            c.swap(k, row);
            a.iter_mut().for_each(|line| line.swap(k, column));
            order.swap(k, column);
            let r = 1.0 / a[k][k];
            for i in k + 1..n {
                a[i][k] *= r;
                for j in k + 1..n {
                    a[i][j] -= a[i][k] * a[k][j];
                }
            }
        }
        let group = |a: &[Vec<f64>], c: &mut [f64], s: usize, q: usize| {
            c[s] += (a[s][q] * -c[q] + a[s][q + 1] * -c[q + 1]) + (a[s][q + 2] * -c[q + 2] + a[s][q + 3] * -c[q + 3]);
        };
        for p in (0..n).step_by(8) {
            let end = n.min(p + 8);
            for i in p..end {
                for s in i + 1..end {
                    c[s] -= c[i] * a[s][i];
                }
            }
            for s in end..n {
                group(a, &mut c, s, p);
                group(a, &mut c, s, p + 4);
            }
        }
        let mut p = rank;
        while p > 0 {
            let start = p - p.min(8);
            for i in (start..p).rev() {
                c[i] /= a[i][i];
                for s in start..i {
                    c[s] -= c[i] * a[s][i];
                }
            }
            for s in 0..start {
                group(a, &mut c, s, start);
                group(a, &mut c, s, start + 4);
            }
            p = start;
        }
        let mut solution = vec![0.0; n];
        for i in 0..rank {
            solution[order[i]] = c[i];
        }
        solution
    }

    fn columns(rows: &[Vec<f64>]) -> Vec<f64> {
        (0..rows.len()).flat_map(|j| rows.iter().map(move |row| row[j])).collect()
    }

    fn bits(numbers: &[f64]) -> Vec<u64> {
        numbers.iter().map(|x| if x.is_nan() { u64::MAX } else { x.to_bits() }).collect()
    }

    #[test]
    fn every_size_has_the_bits_of_the_specification() {
        let mut numbers = Numbers(7);
        let mut workspace = Workspace::default();
        for n in (0..=44).step_by(2) {
            let mut rows: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| numbers.next()).collect()).collect();
            let mut rhs: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
            let (original, target) = (rows.clone(), rhs.clone());
            let mut matrix = columns(&rows);
            solve(&mut matrix, &mut rhs, &mut workspace);
            for (row, target) in original.iter().zip(&target) {
                let product: f64 = row.iter().zip(&rhs).map(|(a, x)| a * x).sum();
                assert!((product - target).abs() < 1e-10, "n = {n}: {product} is not {target}");
            }
            assert_eq!(bits(&rhs), bits(&literal(&mut rows, &target)), "n = {n}");
        }
    }

    #[test]
    fn ties_of_moduli_and_integers_pivot_as_specified() {
        let mut numbers = Numbers(99);
        let mut workspace = Workspace::default();
        for n in [2, 6, 10, 18] {
            for _ in 0..50 {
                let mut small = || (numbers.next() * 2.5).round();
                let mut rows: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| small()).collect()).collect();
                let mut rhs: Vec<f64> = (0..n).map(|_| small()).collect();
                let mut matrix = columns(&rows);
                let expected = literal(&mut rows, &rhs);
                solve(&mut matrix, &mut rhs, &mut workspace);
                assert_eq!(bits(&rhs), bits(&expected));
            }
        }
    }

    /// NaN and infinity are below the pivots: comparisons and results are as in the specified order.
    #[test]
    fn values_that_are_no_numbers_are_passed_over_where_pivots_are_chosen() {
        let mut numbers = Numbers(5);
        let mut workspace = Workspace::default();
        for n in [2, 6, 12, 22] {
            for value in [f64::NAN, f64::INFINITY, -0.0] {
                let mut rows: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| numbers.next()).collect()).collect();
                rows[n - 1][n / 2] = value;
                rows[n / 2][0] = value;
                let mut rhs: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
                let (target, mut matrix) = (rhs.clone(), columns(&rows));
                solve(&mut matrix, &mut rhs, &mut workspace);
                assert_eq!(bits(&rhs), bits(&literal(&mut rows, &target)), "n = {n}, {value}");
            }
        }
    }

    /// In matrices of few springs, whole columns stay unchanged, unless a zero has a sign or a value is not finite.
    #[test]
    fn zeros_have_the_bits_of_the_specification() {
        let mut numbers = Numbers(11);
        let mut workspace = Workspace::default();
        for n in (2..=30).step_by(4) {
            for zero in [0.0, -0.0, f64::INFINITY, f64::NAN, 1e-310] {
                let entry = |i: usize, j: usize, value: f64| if i.abs_diff(j) < 3 { value } else { 0.0 };
                let mut rows: Vec<Vec<f64>> =
                    (0..n).map(|i| (0..n).map(|j| entry(i, j, numbers.next())).collect()).collect();
                rows[0][n - 1] = zero;
                rows[n / 2][0] = zero;
                let mut rhs: Vec<f64> = (0..n).map(|i| if i % 3 == 0 { -0.0 } else { numbers.next() }).collect();
                let (target, mut matrix) = (rhs.clone(), columns(&rows));
                solve(&mut matrix, &mut rhs, &mut workspace);
                assert_eq!(bits(&rhs), bits(&literal(&mut rows, &target)), "n = {n}, {zero}");
            }
        }
    }

    #[test]
    fn unknowns_beyond_the_rank_are_zero() {
        let mut workspace = Workspace::default();
        // Two rows are equal: x + y = 2 leaves y free, and the first column is chosen.
        let mut rhs = [2.0, 2.0];
        solve(&mut [1.0, 1.0, 1.0, 1.0], &mut rhs, &mut workspace);
        assert_eq!(rhs, [2.0, 0.0]);
        // A value of 1e-17 times the first pivot does not count as a pivot, but 1e-15 does.
        let mut rhs = [1.0, 1.0];
        solve(&mut [1.0, 0.0, 0.0, 1e-17], &mut rhs, &mut workspace);
        assert_eq!(rhs, [1.0, 0.0]);
        let mut rhs = [1.0, 1.0];
        solve(&mut [1.0, 0.0, 0.0, 1e-15], &mut rhs, &mut workspace);
        assert_eq!(rhs, [1.0, 1.0 / 1e-15]);
    }

    #[test]
    fn values_that_are_no_numbers_spread_without_a_panic() {
        let mut workspace = Workspace::default();
        let mut rhs = [1.0, 2.0];
        solve(&mut [f64::NAN, 1.0, 1.0, 1.0], &mut rhs, &mut workspace);
        assert!(rhs.iter().all(|x| x.is_nan()));
        let mut rhs = [1.0, 1.0];
        solve(&mut [0.0; 4], &mut rhs, &mut workspace);
        assert!(rhs.iter().all(|x| !x.is_finite()));
    }
}
