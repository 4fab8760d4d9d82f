//! Small plots for terminals, in Braille dots: two by four to a character.
//!
//! They accompany a report and never replace it: nothing is said by them alone.
use crate::number::{decades, short};
use fosssim_num::polynomial::evaluate;

/// Columns of dots that a plot of a terminal this wide may have, half of which are characters.
const WIDEST: usize = 72;

/// The number of columns of dots for a step, where there is room.
const BROADEST: usize = 4;

/// Rows of characters.
const ROWS: usize = 5;

/// A field of dots.
struct Dots {
    columns: usize,
    rows: usize,
    cells: Vec<u8>,
}

impl Dots {
    fn new(columns: usize, rows: usize) -> Self {
        Self { columns, rows, cells: vec![0; columns * rows] }
    }

    /// Sets the dot `x` from the left and `y` from the top.
    fn set(&mut self, x: usize, y: usize) {
        /// The bit of each dot of a character, by row and column (Unicode 2800 and following).
        const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        let (column, row) = (x / 2, y / 4);
        if column < self.columns && row < self.rows {
            self.cells[row * self.columns + column] |= BITS[y % 4][x % 2];
        }
    }

    fn line(&self, row: usize) -> String {
        let cells = &self.cells[row * self.columns..(row + 1) * self.columns];
        cells.iter().map(|&cell| char::from_u32(0x2800 + u32::from(cell)).unwrap_or(' ')).collect()
    }

    /// The rows with labels in front and after.
    fn lines(&self, labels: &[(usize, String)], remarks: &[(usize, String)]) -> String {
        let of = |list: &[(usize, String)], row| {
            list.iter().find(|(place, _)| *place == row).map(|(_, text)| text.clone()).unwrap_or_default()
        };
        let width = labels.iter().map(|(_, text)| text.chars().count()).max().unwrap_or(0);
        (0..self.rows)
            .map(|row| {
                let (label, remark) = (of(labels, row), of(remarks, row));
                let line = format!("  {label:>width$} {} {remark}", self.line(row));
                format!("{}\n", line.trim_end())
            })
            .collect()
    }
}

/// Residuals over the steps on a logarithmic scale: a column of dots up to the largest of the steps that it stands for,
/// and the tolerance as a dotted line. Nothing where there is nothing to see: no step, or all zero.
#[must_use]
pub fn residuals(values: &[f64], tolerance: f64, columns: usize) -> Option<String> {
    let rank = |value: f64| if value.is_nan() { f64::INFINITY } else { value.abs() };
    let most = values.iter().copied().map(rank).fold(0.0, f64::max);
    if !(most > 0.0) {
        return None;
    }
    let shown = values.iter().copied().map(rank).filter(|value| *value > 0.0 && value.is_finite());
    let (least, most) = shown.fold((tolerance, tolerance), |(least, most), value| (least.min(value), most.max(value)));
    let (low, high) = decades(least, most);
    let columns = columns.min(WIDEST);
    let broad = (2 * columns / values.len()).clamp(1, BROADEST);
    let columns = columns.min((broad * values.len()).div_ceil(2)).max(1);
    let mut dots = Dots::new(columns, ROWS);
    let height = 4 * ROWS - 1;
    let place = |value: f64| {
        if !value.is_finite() {
            return 0;
        }
        let share = (value.log10() - f64::from(low)) / f64::from(high - low);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "some dots"
        )]
        let up = (share.clamp(0.0, 1.0) * height as f64).round() as usize;
        height - up
    };
    let across = (2 * columns).min(broad * values.len());
    for x in 0..across {
        // A column stands for several steps, or for a part of one.
        let first = x * values.len() / across;
        let range = first..((x + 1) * values.len() / across).max(first + 1);
        let value = values[range].iter().copied().map(rank).fold(0.0, f64::max);
        if value > 0.0 {
            (place(value)..=height).for_each(|y| dots.set(x, y));
        }
    }
    let bound = place(tolerance);
    (0..2 * columns).step_by(2).for_each(|x| dots.set(x, bound));
    let labels = [(0, format!("1e{high}")), (ROWS - 1, format!("1e{low}"))];
    let remarks = [(bound / 4, format!("- tolerance {}", short(tolerance)))];
    Some(dots.lines(&labels, &remarks))
}

/// Polynomials on the step, each scaled to its largest modulus: the first one solid, a second one dotted, and the line
/// of zero. The rows reach as far as the curves do, and to zero. `None` where there is nothing to draw.
#[must_use]
pub fn curves(lists: &[&[f64]], columns: usize) -> Option<String> {
    let columns = columns.clamp(4, WIDEST / 2);
    let mut dots = Dots::new(columns, ROWS);
    let height = 4 * ROWS - 1;
    let across = 2 * columns;
    #[expect(clippy::cast_precision_loss, reason = "some dots")]
    let time = |x: usize| x as f64 / (across - 1) as f64;
    let scaled = |list: &&[f64]| {
        let values: Vec<f64> = (0..across).map(|x| evaluate(list, time(x))).collect();
        let most = values.iter().filter(|value| value.is_finite()).fold(0.0_f64, |most, value| most.max(value.abs()));
        (most > 0.0).then(|| values.into_iter().map(|value| value / most).collect::<Vec<f64>>())
    };
    let lines: Vec<Option<Vec<f64>>> = lists.iter().map(scaled).collect();
    let finite = || lines.iter().flatten().flatten().copied().filter(|value| value.is_finite());
    let (low, high) = finite().fold((0.0_f64, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    if high <= low {
        return None;
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "some dots"
    )]
    let row = |value: f64| ((high - value) / (high - low) * height as f64).round() as usize;
    for (number, values) in lines.iter().enumerate() {
        let mut before = None;
        for (x, &value) in values.iter().flatten().enumerate() {
            if !value.is_finite() {
                before = None;
                continue;
            }
            let y = row(value);
            // The line goes on without gaps; a second one is dotted.
            let from = before.filter(|_| number == 0).unwrap_or(y);
            if number == 0 || x % 3 == 0 {
                (y.min(from)..=y.max(from)).for_each(|y| dots.set(x, y));
            }
            before = Some(y);
        }
    }
    let zero = row(0.0);
    (0..across).step_by(4).for_each(|x| dots.set(x, zero));
    let labels = [(zero / 4, "0".to_owned()), (0, "+".to_owned()), (ROWS - 1, "-".to_owned())];
    let remarks = [(ROWS - 1, "t = 0 to 1".to_owned())];
    Some(dots.lines(&labels, &remarks))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn residuals_show_their_peak_and_the_tolerance() {
        let mut values = vec![0.0; 40];
        values[20] = 1e-3;
        values[21] = 1e-12;
        insta::assert_snapshot!(residuals(&values, 1e-10, 60).unwrap());
    }

    #[test]
    fn a_polynomial_and_a_second_one() {
        insta::assert_snapshot!(curves(&[&[-0.25, 0.5, -0.1875], &[-0.25, 0.125, 0.1]], 30).unwrap());
    }

    #[test]
    fn nothing_to_see_is_nothing() {
        assert_eq!(residuals(&[], 1e-10, 60), None);
        assert_eq!(residuals(&[0.0; 9], 1e-10, 60), None);
        assert_eq!(curves(&[&[], &[0.0]], 60), None);
        for values in [&[f64::NAN][..], &[f64::INFINITY, 1.0], &[5e-324, f64::MAX]] {
            let text = residuals(values, 1e-10, 60).unwrap();
            assert_eq!(text.lines().count(), ROWS);
            assert!(text.lines().all(|line| line.chars().count() < 60 + 40));
        }
        assert!(curves(&[&[f64::NAN, 1.0], &[1.0, 2.0]], 0).is_some());
        let long = vec![1e-3; 100_000];
        assert!(residuals(&long, 1e-10, 1000).unwrap().lines().all(|line| line.chars().count() < 110));
    }
}
