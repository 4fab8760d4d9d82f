use super::{
    super::{
        bounded::{BoundedValue, UNIT_ROUNDOFF},
        first_time::first_time_of_lists,
    },
    CertifiedDecision, HitCertainty, Level, decide,
    exact::{ExactAnswer, find_exact_first_time},
    range::slack,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

type Lists = Vec<Vec<f64>>;

/// The polynomials of an example. If `tau` is at most 1, its value and whether the polynomials only touch follow.
type Example<'a> = (&'a [&'a [f64]], Option<(f64, bool)>);

/// Returns the decision for coefficients whose terms add up to their absolute value: bound = |value|.
fn decided(lists: &[Vec<f64>], units: f64) -> CertifiedDecision {
    let bounded: Vec<Vec<BoundedValue>> =
        lists.iter().map(|list| list.iter().map(|&value| BoundedValue::from_rounded(value)).collect()).collect();
    let slices: Vec<&[BoundedValue]> = bounded.iter().map(Vec::as_slice).collect();
    decide(&slices, units)
}

fn exactly(lists: &[Vec<f64>]) -> ExactAnswer {
    let slices: Vec<&[f64]> = lists.iter().map(Vec::as_slice).collect();
    find_exact_first_time(&slices)
}

fn hits(lists: &[Vec<f64>]) -> bool {
    matches!(exactly(lists), ExactAnswer::First { .. })
}

fn owned(lists: &[&[f64]]) -> Lists {
    lists.iter().map(|list| list.to_vec()).collect()
}

/// Returns the polynomials of a particle at rest at the origin and a passing one, by collisions.md 2, with their
/// bounds.
fn particle_pair(x: [f64; 2], d: [f64; 2], reach: f64) -> [Vec<BoundedValue>; 2] {
    let [x0, x1, d0, d1] = [x[0], x[1], d[0], d[1]].map(BoundedValue::from_rounded);
    let (xx, xd, dd) = (x0 * x0 + x1 * x1, x0 * d0 + x1 * d1, d0 * d0 + d1 * d1);
    let reach = BoundedValue::from_rounded(reach);
    [vec![-dd, -2.0 * xd, reach * reach - xx], vec![-dd, -xd]]
}

fn decide_pair(pair: &[Vec<BoundedValue>; 2]) -> CertifiedDecision {
    decide(&[&pair[0], &pair[1]], 64.0)
}

#[test]
fn particles_that_hit_miss_leave_and_graze() {
    // From a distance of 3 with speed 4, the particles touch at distance 1, after half the step.
    let hit = decide_pair(&particle_pair([3.0, 0.0], [-4.0, 0.0], 1.0));
    assert_eq!(hit.certainty, HitCertainty::Hits);
    let [lo, hi] = hit.time.expect("a time");
    assert!(lo < 0.5 && 0.5 < hi && hi - lo < 1e-12, "{lo} {hi}");
    assert!(hit.margin > 1e12);
    // The particle stops too early, moves away, or passes at a distance of two radii.
    let short = decide_pair(&particle_pair([3.0, 0.0], [-1.0, 0.0], 1.0));
    let leaving = decide_pair(&particle_pair([0.5, 0.0], [1.0, 0.0], 1.0));
    let passing = decide_pair(&particle_pair([-3.0, 2.0], [6.0, 0.0], 1.0));
    assert_eq!((short.certainty, short.time, short.level), (HitCertainty::Misses, None, Level::Range));
    assert_eq!((leaving.certainty, leaving.level), (HitCertainty::Misses, Level::Range));
    assert_eq!(passing.certainty, HitCertainty::Misses);
    // The particle grazes the other one, or arrives exactly at the end, so a rounding error decides.
    let graze = decide_pair(&particle_pair([-3.0, 1.0], [6.0, 0.0], 1.0));
    let arriving = decide_pair(&particle_pair([3.0, 0.0], [-2.0, 0.0], 1.0));
    assert_eq!((graze.certainty, graze.margin), (HitCertainty::Borderline, 0.0));
    assert_eq!(arriving.certainty, HitCertainty::Borderline);
    let [lo, hi] = arriving.time.expect("the earliest time");
    assert!(1.0 - 1e-12 < lo && lo <= hi && hi <= 1.0, "{lo} {hi}");
    // The particles already overlap and approach each other.
    let overlapping = decide_pair(&particle_pair([0.5, 0.0], [-1.0, 0.0], 1.0));
    assert_eq!((overlapping.certainty, overlapping.time), (HitCertainty::Hits, Some([0.0; 2])));
}

/// A decision near its limit changes from Yes over Borderline to No, and the margin shows how far away the limit is.
#[test]
fn the_decision_is_right_within_its_margin() {
    let at = |gap: f64| decide_pair(&particle_pair([3.0 + gap, 0.0], [-2.0, 0.0], 1.0));
    let step = 1e-16;
    assert_eq!(at(-1e5 * step).certainty, HitCertainty::Hits);
    assert_eq!(at(0.0).certainty, HitCertainty::Borderline);
    assert_eq!(at(1e5 * step).certainty, HitCertainty::Misses);
    let (near, far) = (at(1e6 * step).margin, at(1e8 * step).margin);
    assert!(64.0 < near && near < far, "{near} {far}");
    let pair = particle_pair([3.0 + 1e8 * step, 0.0], [-2.0, 0.0], 1.0);
    assert_eq!(decide(&[&pair[0], &pair[1]], far * 0.999).certainty, HitCertainty::Misses);
}

#[test]
fn the_exact_examples() {
    let cases: [Example; 21] = [
        (&[], None),
        (&[&[]], None),
        (&[&[0.0, 0.0]], None),
        (&[&[1.0, -0.5], &[]], None),
        (&[&[1.0, -0.5]], Some((0.5, false))),
        (&[&[-1.0, 0.25]], Some((0.0, false))),
        (&[&[3.0]], Some((0.0, false))),
        (&[&[-3.0]], None),
        // The intervals start at exactly 1 or later, or end at exactly 0.
        (&[&[1.0, -1.0]], Some((1.0, true))),
        (&[&[1.0, -1.0, 0.0]], Some((1.0, true))),
        (&[&[1.0, -1.25]], None),
        (&[&[-1.0, 0.0]], None),
        // The polynomial is positive after 0, but counts as nowhere positive in the original.
        (&[&[1.0, 0.0]], Some((0.0, false))),
        // The two sets have only one point in common, or not even that.
        (&[&[1.0, -0.5], &[-1.0, 0.5]], Some((0.5, true))),
        (&[&[1.0, -0.5], &[-1.0, 0.5], &[1.0, -1.0, 0.25]], Some((0.5, true))),
        (&[&[1.0, -0.5], &[-1.0, 0.5], &[-1.0, 1.0, -0.25]], None),
        // A double zero makes no gap and no peak.
        (&[&[1.0, -1.0, 0.25]], Some((0.0, false))),
        (&[&[-1.0, 1.0, -0.25]], None),
        // The polynomials first touch, and later overlap.
        (&[&[1.0, -0.75, 0.125], &[16.0, -16.0, 3.0]], Some((0.0, false))),
        (&[&[-1.0, 1.0, -0.1875], &[16.0, -20.0, 4.0]], Some((0.25, true))),
        (&[&[1e-300, -1e300]], None),
    ];
    for (lists, expected) in cases {
        let answer = find_exact_first_time(lists);
        match (answer, expected) {
            (ExactAnswer::Never, None) => {}
            (ExactAnswer::First { time: [lo, hi], touching }, Some((time, touches))) => {
                assert!(lo <= time && time <= hi && hi - lo < 1e-15, "{lists:?}: {answer:?}");
                assert_eq!(touching, touches, "{lists:?}");
            }
            _ => panic!("{lists:?}: {answer:?}, expected {expected:?}"),
        }
        assert_eq!(decided(&owned(lists), 0.0).certainty == HitCertainty::Hits, expected.is_some(), "{lists:?}");
    }
    assert_eq!(find_exact_first_time(&[&[1.0], &[f64::NAN]]), ExactAnswer::NotFinite);
}

#[test]
fn values_that_are_not_finite_are_borderline() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for lists in [owned(&[&[bad, 1.0]]), owned(&[&[-1.0], &[1.0, 2.0, bad]])] {
            for units in [0.0, 64.0] {
                assert_eq!(decided(&lists, units).certainty, HitCertainty::Borderline);
            }
        }
    }
    let unbounded = [BoundedValue { value: -1.0, bound: f64::INFINITY }];
    assert_eq!(decide(&[&unbounded], 64.0).certainty, HitCertainty::Borderline);
    assert_eq!(decided(&owned(&[&[1.0]]), f64::NAN).certainty, HitCertainty::Borderline);
}

#[test]
fn each_decision_says_which_level_made_it() {
    let all = [owned(&[&[-1.0]]), owned(&[&[1.0, -2.0]]), owned(&[&[1.0, -0.5], &[-1.0, 0.5]])];
    assert_eq!(all.map(|lists| decided(&lists, 0.0).level), [Level::Range, Level::Range, Level::Exact]);
}

/// A polynomial with zeros on a grid of quarters, a sign, and possibly a factor that is always positive.
#[derive(Debug, Clone)]
struct Factored {
    zeros: Vec<i32>,
    positive: bool,
    bump: Option<i32>,
}

impl Factored {
    /// Returns the exact integer coefficients of the product of `4 t - zero`.
    fn coefficients(&self) -> Vec<f64> {
        let mut list = vec![if self.positive { 1.0 } else { -1.0 }];
        let mut times = |factor: &[f64]| {
            let mut product = vec![0.0; list.len() + factor.len() - 1];
            for (i, a) in list.iter().enumerate() {
                for (j, b) in factor.iter().enumerate() {
                    product[i + j] += a * b;
                }
            }
            list = product;
        };
        for &zero in &self.zeros {
            times(&[4.0, -f64::from(zero)]);
        }
        if let Some(place) = self.bump {
            // This is (4 t - place)^2 + 1.
            times(&[16.0, -8.0 * f64::from(place), f64::from(place * place + 1)]);
        }
        list
    }

    /// Returns whether the polynomial is positive at `eighth / 8`, which is not a zero.
    fn is_positive(&self, eighth: i32) -> bool {
        let negative = self.zeros.iter().filter(|&&zero| eighth < 2 * zero).count();
        (negative % 2 == 0) == self.positive
    }
}

/// Returns where the polynomials are first all positive or touch in `(0, 1]`, and whether they only touch. All cells of
/// the grid are tested. Returns `None` if there is no such time.
fn grid_answer(polynomials: &[Factored]) -> Option<(i32, bool)> {
    let positive = |polynomial: &Factored, eighth| polynomial.is_positive(eighth);
    let open = |eighth| polynomials.iter().all(|polynomial| positive(polynomial, eighth));
    if open(1) {
        return Some((0, false));
    }
    let meets =
        |&quarter: &i32| polynomials.iter().all(|one| positive(one, 2 * quarter - 1) || positive(one, 2 * quarter + 1));
    let first = (1..=4).find(meets)?;
    Some((first, ![1, 3, 5, 7].into_iter().any(open)))
}

fn factored() -> impl Strategy<Value = Factored> {
    (prop::collection::vec(-3..8_i32, 0..=5), any::<bool>(), prop::option::of(-2..6_i32)).prop_map(
        |(mut zeros, positive, bump)| {
            let bump = bump.filter(|_| zeros.len() <= 3);
            if zeros.len() >= 3 && zeros[0] % 2 == 0 {
                zeros[1] = zeros[0];
            }
            Factored { zeros, positive, bump }
        },
    )
}

/// Returns numbers of very different sizes, between `2^-reach` and `2^reach`, and zeros.
fn number(reach: i32) -> impl Strategy<Value = f64> {
    (1.0..2.0_f64, -reach..=reach, -4..=4_i32).prop_map(|(mantissa, exponent, sign)| {
        // There are two factors, so that the result may be subnormal.
        let power = |exponent: i32| f64::from_bits(u64::try_from(1023 + exponent).unwrap_or(0) << 52);
        f64::from(sign.signum()) * mantissa * power(exponent / 2) * power(exponent - exponent / 2)
    })
}

/// Returns random, spread, grid, touching and nearly touching lists.
fn lists() -> impl Strategy<Value = Lists> {
    let random = prop::collection::vec(-1.0..1.0_f64, 0..=6);
    let integers = prop::collection::vec((-6..7_i32).prop_map(f64::from), 0..=6);
    let near = (factored(), 1..60_i32, -3..4_i32, 0..6_usize).prop_map(|(polynomial, bits, amount, place)| {
        let mut list = polynomial.coefficients();
        let place = place % list.len();
        list[place] += f64::from(amount) * f64::from_bits(u64::try_from(1023 - bits).unwrap_or(0) << 52);
        list
    });
    let squared = (prop::collection::vec(-0.2..1.2_f64, 1..=2), -1.0..1.0_f64).prop_map(|(zeros, sign)| {
        let mut list = vec![sign];
        for zero in zeros.into_iter().flat_map(|zero| [zero, zero]) {
            list.push(0.0);
            for i in (1..list.len()).rev() {
                list[i] -= zero * list[i - 1];
            }
        }
        list
    });
    let spread = prop::collection::vec(number(100), 1..=6);
    let one = prop_oneof![random, spread, integers, factored().prop_map(|one| one.coefficients()), near, squared];
    prop::collection::vec(one, 1..=4)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 8_000,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// The zeros are on a grid, so counting gives the exact answer.
    #[test]
    fn exact_answers_on_a_grid(polynomials in prop::collection::vec(factored(), 1..=4)) {
        let lists: Lists = polynomials.iter().map(Factored::coefficients).collect();
        let answer = exactly(&lists);
        match grid_answer(&polynomials) {
            None => prop_assert_eq!(answer, ExactAnswer::Never),
            Some((quarter, touches)) => {
                let ExactAnswer::First { time: [lo, hi], touching } = answer else {
                    return Err(TestCaseError::fail(format!("{answer:?} instead of {quarter}/4")));
                };
                let time = 0.25 * f64::from(quarter);
                prop_assert!(lo <= time && time <= hi && hi - lo < 1e-15, "{} {} {}", lo, time, hi);
                prop_assert_eq!(touching, touches);
            }
        }
    }

    #[test]
    fn without_errors_the_decision_is_the_exact_one(lists in lists()) {
        let decision = decided(&lists, 0.0);
        prop_assert_ne!(decision.certainty, HitCertainty::Borderline);
        prop_assert_eq!(decision.certainty == HitCertainty::Hits, hits(&lists), "{:?}", decision);
        if let (Some([lo, hi]), ExactAnswer::First { time: [first, last], .. }) = (decision.time, exactly(&lists)) {
            prop_assert!(lo <= last && first <= hi && 0.0 <= lo && hi <= 1.0, "{:?} {} {}", decision, first, last);
        }
    }

    /// More units never reverse a decision, and fewer units never make it uncertain.
    #[test]
    fn decisions_are_monotone_in_the_units(lists in lists(), units in 0.0..1e6_f64) {
        let (loose, tight) = (decided(&lists, units), decided(&lists, units * 0.25));
        if loose.certainty == HitCertainty::Borderline {
            prop_assert_eq!(loose.margin, 0.0);
            prop_assert!(loose.time.is_some());
            // The extreme choices, enlarged a little because the decision rounds outwards, give different answers.
            let choice = |sign: f64| -> Lists {
                let end = |value: &f64| value + sign * (units + 8.0) * UNIT_ROUNDOFF * value.abs() + sign * 1e-300;
                lists.iter().map(|list| list.iter().map(end).collect()).collect()
            };
            prop_assert!(hits(&choice(1.0)) && !hits(&choice(-1.0)));
        } else {
            prop_assert_eq!(loose.certainty, tight.certainty);
            prop_assert!(loose.margin >= units);
            prop_assert_eq!(decided(&lists, (loose.margin * 0.99).max(units)).certainty, loose.certainty);
        }
    }

    #[test]
    fn powers_of_two_change_nothing(lists in lists(), exponents in prop::array::uniform4(-200..200_i32)) {
        let scaled: Lists = lists.iter().zip(exponents).map(|(list, exponent)| {
            let factor = f64::from_bits(u64::try_from(1023 + exponent).unwrap_or(0) << 52);
            list.iter().map(|value| value * factor).collect()
        }).collect();
        prop_assert_eq!(exactly(&lists), exactly(&scaled));
        let (one, other) = (decided(&lists, 64.0), decided(&scaled, 64.0));
        prop_assert_eq!((one.certainty, one.time), (other.certainty, other.time));
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1_000,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// The sizes range from subnormal numbers to the largest: overflow and underflow never cause a wrong decision.
    #[test]
    fn extreme_sizes_are_decided_correctly(
        lists in prop::collection::vec(
            prop::collection::vec(number(1070).prop_filter("finite", |value| value.is_finite()), 1..=6),
            1..=3,
        ),
        scale in 0..1000_i32,
    ) {
        let power = f64::from_bits(u64::try_from(1023 - scale).unwrap_or(0) << 52);
        let lists: Lists = lists.iter().map(|list| list.iter().map(|value| value * power).collect()).collect();
        let answer = hits(&lists);
        prop_assert_eq!(decided(&lists, 0.0).certainty == HitCertainty::Hits, answer);
        let decision = decided(&lists, 64.0);
        let is_borderline = decision.certainty == HitCertainty::Borderline;
        prop_assert!(is_borderline || (decision.certainty == HitCertainty::Hits) == answer);
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// A certain decision holds for 100 choices of coefficients within the bounds, including the extreme ones.
    #[test]
    fn certain_decisions_hold_for_all_choices(
        lists in lists(),
        coarse in any::<bool>(),
        choices in prop::collection::vec(prop::array::uniform24(-1.0..1.0_f64), 100),
    ) {
        let units = if coarse { 1e13 } else { 64.0 };
        let decision = decided(&lists, units);
        if decision.certainty == HitCertainty::Borderline {
            return Ok(());
        }
        for (round, choice) in choices.iter().enumerate() {
            let mut weights = choice.iter();
            let chosen: Lists = lists.iter().map(|list| list.iter().map(|value| {
                let weight = *weights.next().unwrap_or(&0.0);
                let weight = if round % 2 == 0 { weight.signum() } else { weight };
                value + weight * units * UNIT_ROUNDOFF * value.abs() * (1.0 - 1e-15)
            }).collect()).collect();
            let answer = exactly(&chosen);
            prop_assert_eq!(decision.certainty == HitCertainty::Hits, answer != ExactAnswer::Never, "{:?}", chosen);
            if let (Some([lo, hi]), ExactAnswer::First { time: [first, last], .. }) = (decision.time, answer) {
                prop_assert!(lo <= last && first <= hi);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 5_000,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Far from any limit the original's root finder gives the same answer, except for `c t^m`.
    #[test]
    fn clear_decisions_are_those_of_the_root_finder(
        lists in prop::collection::vec(prop::collection::vec(-1.0..1.0_f64, 2..=6), 1..=4),
    ) {
        let decision = decided(&lists, 64.0);
        if decision.certainty != HitCertainty::Borderline && decision.margin > 1e10 {
            let time = first_time_of_lists(lists.iter().map(Vec::as_slice)).expect("ends");
            prop_assert_eq!(decision.certainty == HitCertainty::Hits, time <= 1.0, "{:?} {}", decision, time);
            if let Some([lo, hi]) = decision.time {
                prop_assert!(lo - 1e-6 <= time && time <= hi + 1e-6, "{:?} {}", decision, time);
            }
        }
    }
}

#[test]
fn without_a_bound_any_distance_is_enough() {
    assert_eq!([slack(0.0, 0.0), slack(1.0, 0.0)], [f64::INFINITY; 2]);
    assert_eq!(slack(-1.0, 2.0), 0.0);
}
