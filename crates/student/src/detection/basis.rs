//! Correct programs that compute coefficients indirectly: through the Bernstein basis, or from values at several times.
use fosssim_num::vector::Vec2;

use fosssim_model::sim::PointMotion;

/// Converts a power basis list (highest power first) to the Bernstein basis over the step, and back.
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

/// Returns the coefficients (highest power first) of the polynomial with the values of `value` at `degree + 1` evenly
/// spaced times of the step, by Newton's divided differences.
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

/// Returns the overlap and approach of two particles, from values.
pub fn particle_particle([one, two]: &[PointMotion; 2], radii: [f64; 2]) -> Vec<Vec<f64>> {
    let n = |t| two.position_at(t) - one.position_at(t);
    let reach = radii[0] + radii[1];
    let closing = one.shift - two.shift;
    vec![interpolate(2, |t| reach * reach - n(t).dot(&n(t))), interpolate(1, |t| closing.dot(&n(t)))]
}

/// Returns the overlap and approach of a particle and a half-plane, from values.
pub fn particle_half_plane(one: &PointMotion, radius: f64, point: Vec2, normal: Vec2) -> Vec<Vec<f64>> {
    let away = |t| (point - one.position_at(t)).dot(&normal);
    let reach = radius * radius * normal.dot(&normal);
    let speed = one.shift.dot(&normal);
    vec![interpolate(2, |t| reach - away(t) * away(t)), interpolate(1, |t| speed * away(t))]
}

/// Returns the overlap of a particle and an edge, from values.
pub fn overlap_from_values(bodies: &[PointMotion; 3], square: f64) -> Vec<f64> {
    interpolate(4, |t| overlap(bodies, square, t))
}

/// Returns the overlap of a particle and an edge at one time.
fn overlap([one, two, three]: &[PointMotion; 3], square: f64, t: f64) -> f64 {
    let (along, beside) = (three.position_at(t) - two.position_at(t), one.position_at(t) - two.position_at(t));
    let cross = along.x * beside.y - along.y * beside.x;
    square * along.dot(&along) - cross * cross
}

/// Returns overlap, alpha > 0 and alpha < 1 of a particle and an edge, from values; the approach is the supplied one.
pub fn particle_edge(bodies @ [one, two, three]: &[PointMotion; 3], square: f64) -> [Vec<f64>; 3] {
    [
        overlap_from_values(bodies, square),
        interpolate(2, |t| (one.position_at(t) - two.position_at(t)).dot(&(three.position_at(t) - two.position_at(t)))),
        interpolate(2, |t| {
            (one.position_at(t) - three.position_at(t)).dot(&(two.position_at(t) - three.position_at(t)))
        }),
    ]
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
