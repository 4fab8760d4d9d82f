//! Assigns the polynomials of a trace's list to the reference's if their numbers differ.
//!
//! The assignment is the shortest edit script between the two lists (R. A. Wagner and M. J. Fischer, "The
//! string-to-string correction problem", J. ACM 21, 1974). An omission or insertion costs more than half of a wrong
//! polynomial, so a wrong polynomial at the right position in the list does not count as missing. A mark is not a
//! verdict: with wrong and missing polynomials together, other scripts may be equally short.
use fosssim_model::trace::PolynomialLog;

/// The maximum number of pairs of polynomials that are compared.
const MAX_COMPARISONS: usize = 4 << 20;

/// The costs of an omitted or inserted polynomial, and of a wrong one.
const GAP_COST: u32 = 2;
const MISMATCH_COST: u32 = 3;

/// The deviation of coefficients, relative to their polynomial's largest, above which a call is marked as differing. A
/// mark is not a verdict; with a larger value, small differences are not marked.
const MARKED_DEVIATION: f64 = 1e-9;

/// Returns, for each expected polynomial, the index of its right or wrong counterpart in the trace's list, or `None` if
/// it is missing there. The whole result is `None` if the lists are too long to be compared.
pub(crate) fn match_polynomials(expected: &PolynomialLog, actual: &PolynomialLog) -> Option<Vec<Option<usize>>> {
    let is_match = |one: usize, other: usize| !are_different(actual.get(other), expected.get(one));
    let (rows, columns) = (expected.len(), actual.len());
    let shorter = rows.min(columns);
    let head_count = (0..shorter).take_while(|&index| is_match(index, index)).count();
    let tail_count =
        (0..shorter - head_count).take_while(|&back| is_match(rows - 1 - back, columns - 1 - back)).count();
    let mut found: Vec<Option<usize>> = (0..rows).map(|index| (index < head_count).then_some(index)).collect();
    for back in 0..tail_count {
        found[rows - 1 - back] = Some(columns - 1 - back);
    }
    let (tall, wide) = (rows - head_count - tail_count, columns - head_count - tail_count);
    if tall.checked_mul(wide)? > MAX_COMPARISONS {
        return None;
    }
    let mut cells = vec![0_u8; tall * wide];
    let mut above: Vec<u32> = (0..=wide).map(|column| GAP_COST * place_cost(column)).collect();
    for row in 0..tall {
        let mut corner = above[0];
        above[0] += GAP_COST;
        for column in 0..wide {
            let match_cost = corner + if is_match(head_count + row, head_count + column) { 0 } else { MISMATCH_COST };
            let (delete_cost, insert_cost) = (above[column + 1] + GAP_COST, above[column] + GAP_COST);
            corner = above[column + 1];
            (above[column + 1], cells[row * wide + column]) =
                [(match_cost, MATCH), (delete_cost, DELETE), (insert_cost, INSERT)]
                    .into_iter()
                    .min_by_key(|(cost, _)| *cost)?;
        }
    }
    let (mut row, mut column) = (tall, wide);
    while row > 0 && column > 0 {
        match cells[(row - 1) * wide + column - 1] {
            MATCH => {
                (row, column) = (row - 1, column - 1);
                found[head_count + row] = Some(head_count + column);
            }
            DELETE => row -= 1,
            _ => column -= 1,
        }
    }
    Some(found)
}

const MATCH: u8 = 0;
const DELETE: u8 = 1;
const INSERT: u8 = 2;

fn place_cost(distance: usize) -> u32 {
    u32::try_from(distance).unwrap_or(u32::MAX / GAP_COST)
}

/// Returns whether one polynomial visibly differs from every positive multiple of the other.
pub(crate) fn are_different(own: &[f64], right: &[f64]) -> bool {
    let largest = |list: &[f64]| list.iter().fold(0.0_f64, |maximum, c| maximum.max(c.abs()));
    let (maximum, scale) = (largest(own), largest(right));
    if scale == 0.0 || maximum == 0.0 || !maximum.is_finite() {
        return own.len() != right.len() && (maximum != 0.0 || scale != 0.0);
    }
    // The course's library may have dropped small leading coefficients of only one polynomial.
    let (excess, own) = own.split_at(own.len().saturating_sub(right.len()));
    let (missing, right) = right.split_at(right.len() - own.len());
    let small = |list: &[f64], size: f64| list.iter().all(|c| c.abs() <= MARKED_DEVIATION * size);
    if !(small(excess, maximum) && small(missing, scale)) {
        return true;
    }
    let power = right.iter().position(|c| c.abs() == scale).unwrap_or(0);
    let factor = own[power] / right[power];
    let is_near =
        |(own, right): (&f64, &f64)| (own - factor * right).abs() <= MARKED_DEVIATION * (factor * scale).abs();
    !(factor > 0.0 && own.iter().zip(right).all(is_near))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(polynomials: &[&[f64]]) -> PolynomialLog {
        let mut log = PolynomialLog::default();
        polynomials.iter().for_each(|polynomial| log.push(polynomial));
        log
    }

    #[test]
    fn missing_additional_and_wrong_polynomials_are_distinguished() {
        let [a, b, c, d]: [&[f64]; 4] = [&[1.0, 2.0], &[3.0, -1.0, 0.5], &[-4.0, 1.0], &[7.0]];
        let matched =
            |expected: &[&[f64]], actual: &[&[f64]]| match_polynomials(&list(expected), &list(actual)).expect("short");
        assert_eq!(matched(&[a, b, c, d], &[a, b, c, d]), [Some(0), Some(1), Some(2), Some(3)]);
        assert_eq!(matched(&[a, b, c, d], &[a, d]), [Some(0), None, None, Some(1)]);
        assert_eq!(matched(&[a, b, d], &[a, c, b, c, d]), [Some(0), Some(2), Some(4)]);
        // Small leading coefficients may be kept or dropped.
        let (kept, dropped): (&[f64], &[f64]) = (&[5e-12, -513600.0], &[-12.84]);
        assert_eq!(matched(&[dropped, b], &[c, kept, b]), [Some(1), Some(2)]);
        assert_eq!(matched(&[a, kept, b], &[dropped, b]), [None, Some(0), Some(1)]);
        // A wrong polynomial keeps its position in the list. A polynomial that is multiplied by a factor is not wrong.
        assert_eq!(matched(&[a, b, c, d], &[&[9.0, 9.0], &[30.0, -10.0, 5.0], c]), [Some(0), Some(1), Some(2), None]);
        assert_eq!(matched(&[a], &[]), [None]);
        assert!(matched(&[], &[a]).is_empty());
    }

    #[test]
    fn lists_that_are_too_long_are_not_matched() {
        let many = |value: f64, count| {
            let mut log = PolynomialLog::default();
            (0..count).for_each(|_| log.push(&[value, 1.0]));
            log
        };
        assert_eq!(match_polynomials(&many(1.0, 4000), &many(-1.0, 4001)), None);
        // If all but a few agree, the length does not matter.
        assert_eq!(match_polynomials(&many(1.0, 4000), &many(1.0, 4001)).map(|found| found.len()), Some(4000));
    }
}
