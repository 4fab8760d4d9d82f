//! Sparse least squares: finds few columns whose weighted sum is a given vector.
//!
//! Small supports (sets of columns) are tried exhaustively with the normal equations of unit columns, larger ones by
//! orthogonal matching pursuit (Pati, Rezaiifar and Krishnaprasad, *Orthogonal matching pursuit*, 27th Asilomar
//! Conference, 1993). The result is a proposal, which the caller must check against every sample.
//!
//! `fosssim-mistakes` uses it. The code is in this crate, and not generic, so that it is optimized in tests too.

use nalgebra::{DMatrix, DVector};

/// A proposal, which consists of ascending column indices and their weights.
pub type WeightedColumns = Vec<(usize, f64)>;

/// The squared residual that counts as zero, relative to the target. The normal equations are not more accurate.
const SMALL_RESIDUAL: f64 = 1e-10;

/// The minimum distance from linear dependence of columns that are used together.
const MIN_INDEPENDENCE: f64 = 1e-10;

/// The maximum number of columns for which all triples are tried.
const MAX_FOR_TRIPLES: usize = 110;

/// The maximum number of likely columns for which all quadruples are tried.
const MAX_FOR_QUADRUPLES: usize = 26;

/// The maximum size of a support in matching pursuit.
const MAX_SUPPORT: usize = 8;

/// The nonzero columns of a least-squares problem, normalized, with their Gram matrix.
pub struct DesignMatrix {
    /// The original indices of the nonzero columns, the likely columns first.
    indices: Vec<usize>,
    unit: Vec<Vec<f64>>,
    norms: Vec<f64>,
    gram: Vec<f64>,
    likely_count: usize,
}

impl DesignMatrix {
    /// Prepares the columns. Likely columns are also tried in larger combinations.
    pub fn new(columns: &[Vec<f64>], is_likely: &dyn Fn(usize) -> bool) -> Self {
        let norm = |column: &[f64]| column.iter().map(|value| value * value).sum::<f64>().sqrt();
        let usable: Vec<usize> = (0..columns.len())
            .filter(|&index| {
                let norm = norm(&columns[index]);
                norm > 0.0 && norm.is_finite()
            })
            .collect();
        let mut indices: Vec<usize> = usable.iter().copied().filter(|&index| is_likely(index)).collect();
        let likely_count = indices.len();
        indices.extend(usable.into_iter().filter(|&index| !is_likely(index)));
        let norms: Vec<f64> = indices.iter().map(|&index| norm(&columns[index])).collect();
        let unit: Vec<Vec<f64>> = indices
            .iter()
            .zip(&norms)
            .map(|(&index, norm)| columns[index].iter().map(|value| value / norm).collect())
            .collect();
        let count = unit.len();
        let mut gram = vec![1.0; count * count];
        for one in 0..count {
            for two in 0..one {
                let product = dot(&unit[one], &unit[two]);
                gram[one * count + two] = product;
                gram[two * count + one] = product;
            }
        }
        Self { indices, unit, norms, gram, likely_count }
    }

    /// Returns the accepted proposals of the smallest size whose weighted sum is `target`. `accept` is called with each
    /// proposal, in the order of sizes, and returns whether the proposal is correct.
    pub fn find_supports(
        &self,
        target: &[f64],
        accept: &mut dyn FnMut(&WeightedColumns) -> bool,
    ) -> Vec<WeightedColumns> {
        let square = dot(target, target);
        if !(square > 0.0 && square.is_finite()) {
            return Vec::new();
        }
        let fits: Vec<f64> = self.unit.iter().map(|column| dot(column, target)).collect();
        let problem = FitProblem { columns: self, fits: &fits, square };
        let total = self.indices.len();
        let triple_columns = if total > MAX_FOR_TRIPLES { self.likely_count.min(MAX_FOR_TRIPLES) } else { total };
        for (size, among) in
            [(1, total), (2, total), (3, triple_columns), (4, self.likely_count.min(MAX_FOR_QUADRUPLES))]
        {
            let mut accepted = Vec::new();
            problem.search(&mut PartialSelection::default(), 0, among, size, &mut |columns| {
                if let Some(support) = self.solve(columns, &fits)
                    && accept(&support)
                {
                    accepted.push(support);
                }
            });
            if !accepted.is_empty() {
                return accepted;
            }
        }
        let pursued = [self.likely_count, self.indices.len()].map(|among| self.find_by_pursuit(target, &fits, among));
        pursued.into_iter().flatten().find(|support| accept(support)).into_iter().collect()
    }

    /// Returns columns that matching pursuit chooses among the first `among` columns, with their weights. Returns
    /// `None` if they leave a residual, or if they are nearly dependent.
    fn find_by_pursuit(&self, target: &[f64], fits: &[f64], among: usize) -> Option<WeightedColumns> {
        let mut columns: Vec<usize> = Vec::new();
        let mut residual = target.to_vec();
        while columns.len() < MAX_SUPPORT {
            let best = (0..among)
                .filter(|column| !columns.contains(column))
                .map(|column| (column, dot(&self.unit[column], &residual).abs()))
                .max_by(|one, two| one.1.total_cmp(&two.1))?;
            columns.push(best.0);
            let weights = self.weights(&columns, fits)?;
            residual.copy_from_slice(target);
            for (&column, weight) in columns.iter().zip(&weights) {
                residual.iter_mut().zip(&self.unit[column]).for_each(|(rest, value)| *rest -= weight * value);
            }
            if dot(&residual, &residual) <= SMALL_RESIDUAL * dot(target, target) {
                return self.solve(&columns, fits);
            }
        }
        None
    }

    /// Returns the chosen columns with their weights before they were scaled to length 1. Returns `None` if the columns
    /// are nearly dependent.
    fn solve(&self, columns: &[usize], fits: &[f64]) -> Option<WeightedColumns> {
        let weights = self.weights(columns, fits)?;
        let mut support: WeightedColumns = columns
            .iter()
            .zip(weights)
            .map(|(&column, weight)| (self.indices[column], weight / self.norms[column]))
            .collect();
        support.sort_by_key(|&(index, _)| index);
        Some(support)
    }

    /// Solves the normal equations of unit columns by Cholesky's method. Returns `None` if the columns are nearly
    /// dependent.
    fn weights(&self, columns: &[usize], fits: &[f64]) -> Option<Vec<f64>> {
        let (size, count) = (columns.len(), self.indices.len());
        let gram = DMatrix::from_fn(size, size, |row, column| self.gram[columns[row] * count + columns[column]]);
        let factor = gram.cholesky()?;
        let is_dependent = |diagonal: f64| !(diagonal * diagonal > MIN_INDEPENDENCE);
        if factor.l_dirty().diagonal().iter().any(|&diagonal| is_dependent(diagonal)) {
            return None;
        }
        let fits = DVector::from_iterator(size, columns.iter().map(|&column| fits[column]));
        Some(factor.solve(&fits).as_slice().to_vec())
    }
}

struct FitProblem<'a> {
    columns: &'a DesignMatrix,
    fits: &'a [f64],
    square: f64,
}

/// An incomplete choice of columns: their indices, the Cholesky factor row by row, the forward-substituted target, and
/// the explained part of its squared length.
#[derive(Default)]
struct PartialSelection {
    columns: Vec<usize>,
    rows: Vec<[f64; 4]>,
    forward: Vec<f64>,
    explained: f64,
}

impl FitProblem<'_> {
    /// Calls `found` with all choices of `size` columns among the first `among` that leave no residual.
    fn search(
        &self,
        partial: &mut PartialSelection,
        from: usize,
        among: usize,
        size: usize,
        found: &mut dyn FnMut(&[usize]),
    ) {
        let count = self.columns.indices.len();
        let depth = partial.columns.len();
        for column in from..among {
            let mut row = [0.0; 4];
            let mut diagonal = 1.0;
            let mut forward = self.fits[column];
            for (inner, &other) in partial.columns.iter().enumerate() {
                let mut value = self.columns.gram[column * count + other];
                for (before, entry) in row.iter().enumerate().take(inner) {
                    value -= entry * partial.rows[inner][before];
                }
                row[inner] = value / partial.rows[inner][inner];
                diagonal -= row[inner] * row[inner];
                forward -= row[inner] * partial.forward[inner];
            }
            if !(diagonal > MIN_INDEPENDENCE) {
                continue;
            }
            forward /= diagonal.sqrt();
            let explained = partial.explained + forward * forward;
            if depth + 1 == size {
                if self.square - explained <= SMALL_RESIDUAL * self.square {
                    partial.columns.push(column);
                    found(&partial.columns);
                    partial.columns.pop();
                }
                continue;
            }
            row[depth] = diagonal.sqrt();
            let before = std::mem::replace(&mut partial.explained, explained);
            partial.columns.push(column);
            partial.rows.push(row);
            partial.forward.push(forward);
            self.search(partial, column + 1, among, size, found);
            partial.columns.pop();
            partial.rows.pop();
            partial.forward.pop();
            partial.explained = before;
        }
    }
}

fn dot(one: &[f64], two: &[f64]) -> f64 {
    one.iter().zip(two).map(|(one, two)| one * two).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns pseudo-random numbers between -1 and 1.
    fn columns(count: usize, rows: usize) -> Vec<Vec<f64>> {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        (0..count).map(|_| (0..rows).map(|_| next()).collect()).collect()
    }

    fn combined(columns: &[Vec<f64>], support: &[(usize, f64)]) -> Vec<f64> {
        (0..columns[0].len())
            .map(|row| support.iter().map(|&(index, weight)| weight * columns[index][row]).sum())
            .collect()
    }

    #[test]
    fn supports_of_every_size_are_found() {
        let all = columns(40, 100);
        let prepared = DesignMatrix::new(&all, &|index| index < 20);
        for support in [
            vec![(33, -2.0)],
            vec![(2, 1.0), (31, 0.25)],
            vec![(5, 1.0), (6, -1.0), (39, 4.0)],
            vec![(1, 1.0), (2, 1.0), (3, -1.0), (19, 2.0)],
            vec![(0, 3.0), (7, 1.0), (9, -2.0), (12, 1.5), (18, 2.0), (25, 1.0)],
        ] {
            let found = prepared.find_supports(&combined(&all, &support), &mut |_| true);
            assert_eq!(found.len(), 1, "{support:?}: {found:?}");
            assert_eq!(found[0].len(), support.len(), "{support:?}: {found:?}");
            for (ours, right) in found[0].iter().zip(&support) {
                assert_eq!(ours.0, right.0);
                assert!((ours.1 - right.1).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn indistinguishable_columns_are_all_reported() {
        let mut all = columns(6, 50);
        all[4] = all[1].iter().map(|value| 2.0 * value).collect();
        let found = DesignMatrix::new(&all, &|_| true).find_supports(&all[1], &mut |_| true);
        assert_eq!(found.len(), 2);
        assert_eq!((found[0][0].0, found[1][0].0), (1, 4));
        assert!((found[1][0].1 - 0.5).abs() < 1e-12);
    }

    #[test]
    fn nothing_is_proposed_for_noise() {
        let all = columns(30, 100);
        assert!(DesignMatrix::new(&all[1..], &|_| true).find_supports(&all[0], &mut |_| true).is_empty());
    }
}
