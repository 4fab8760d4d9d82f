//! Correct programs that compute coefficients indirectly: through the Bernstein basis, or from values at several times.
use fosssim_model::sim::PairMotion;

/// Returns the coefficients of a polynomial (highest power first) after a conversion to the Bernstein basis over the
/// step and back. The result differs from `list` only by round-off.
pub fn convert_through_bernstein(list: &[f64]) -> Vec<f64> {
    let degree = list.len() - 1;
    let power = |k: usize| list[degree - k];
    let bernstein: Vec<f64> =
        (0..=degree).map(|i| (0..=i).map(|k| binomial(i, k) / binomial(degree, k) * power(k)).sum()).collect();
    let back = |k: usize| -> f64 {
        let sum: f64 = (0..=k).map(|i| alternating_sign(k - i) * binomial(k, i) * bernstein[i]).sum();
        binomial(degree, k) * sum
    };
    (0..=degree).rev().map(back).collect()
}

fn binomial(n: usize, k: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "small whole numbers")]
    (1..=k).fold(1.0, |product, i| product * (n - k + i) as f64 / i as f64)
}

fn alternating_sign(exponent: usize) -> f64 {
    if exponent.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// Returns the coefficients (highest power first) of the polynomial that equals `value` at `degree + 1` evenly spaced
/// times of the step. They are computed by Newton's divided differences.
fn interpolate(degree: usize, value: impl Fn(f64) -> f64) -> Vec<f64> {
    #[expect(clippy::cast_precision_loss, reason = "small whole numbers")]
    let times: Vec<f64> = (0..=degree).map(|k| k as f64 / degree as f64).collect();
    let mut differences: Vec<f64> = times.iter().map(|&t| value(t)).collect();
    for order in 1..=degree {
        for k in (order..=degree).rev() {
            differences[k] = (differences[k] - differences[k - 1]) / (times[k] - times[k - order]);
        }
    }
    // Horner's scheme over polynomials, lowest power first: p = p * (t - times[k]) + differences[k].
    let mut p = vec![differences[degree]];
    for k in (0..degree).rev() {
        let mut next = vec![0.0; p.len() + 1];
        for (power, coefficient) in p.iter().enumerate() {
            next[power + 1] += coefficient;
            next[power] -= times[k] * coefficient;
        }
        next[0] += differences[k];
        p = next;
    }
    p.reverse();
    p
}

/// Returns the polynomials of a pair, computed from their values. The approach of a particle and an edge is left out.
pub fn polynomials(motion: &PairMotion) -> Vec<Vec<f64>> {
    match *motion {
        PairMotion::Particles { centers: [one, two], radii } => {
            let n = |t| two.position_at(t) - one.position_at(t);
            let (reach, closing) = (radii[0] + radii[1], one.shift - two.shift);
            vec![interpolate(2, |t| reach * reach - n(t).dot(&n(t))), interpolate(1, |t| closing.dot(&n(t)))]
        }
        PairMotion::HalfPlane { center, radius, point, normal } => {
            let away = |t| (point - center.position_at(t)).dot(&normal);
            let (reach, speed) = (radius * radius * normal.dot(&normal), center.shift.dot(&normal));
            vec![interpolate(2, |t| reach - away(t) * away(t)), interpolate(1, |t| speed * away(t))]
        }
        PairMotion::Edge { center, ends: [first, second], radii } => {
            let [x1, x2, x3] = [center, first, second].map(|body| move |t| body.position_at(t));
            let (edge, arm) = (|t| x3(t) - x2(t), |t| x1(t) - x2(t));
            let square = (radii[0] + radii[1]) * (radii[0] + radii[1]);
            let overlap = |t| {
                let cross = edge(t).x * arm(t).y - edge(t).y * arm(t).x;
                square * edge(t).dot(&edge(t)) - cross * cross
            };
            vec![
                interpolate(4, overlap),
                interpolate(2, |t| arm(t).dot(&edge(t))),
                interpolate(2, |t| (x1(t) - x3(t)).dot(&(x2(t) - x3(t)))),
            ]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bernstein_and_back_changes_nothing_but_bits() {
        for list in [vec![3.0, -2.0, 0.5], vec![1.0, 2.0, -3.0, 4.0, -5.0, 6.0], vec![-7.0]] {
            let back = convert_through_bernstein(&list);
            assert!(back.iter().zip(&list).all(|(back, list)| (back - list).abs() < 1e-13), "{back:?} of {list:?}");
        }
    }

    #[test]
    fn values_have_one_polynomial() {
        let value = |t: f64| (((2.0 * t - 1.0) * t + 3.0) * t - 5.0) * t + 0.25;
        let found = interpolate(4, value);
        let right = [2.0, -1.0, 3.0, -5.0, 0.25];
        assert!(found.iter().zip(right).all(|(found, right)| (found - right).abs() < 1e-13), "{found:?}");
    }
}
