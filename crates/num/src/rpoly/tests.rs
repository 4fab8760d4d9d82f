//! The examples of root-finder.md 19.1 and 19.2, and inputs that are not finite.
use super::{Coefficients, DoesNotTerminate, bound, no_shift, scaling, zeros};

type Bits = (u64, u64);

fn bits(coefficients: &[f64]) -> (i32, Vec<Bits>) {
    let zeros = zeros(coefficients).expect("terminates");
    (zeros.count(), zeros.as_slice().iter().map(|(re, im)| (re.to_bits(), im.to_bits())).collect())
}

#[test]
fn examples_of_the_specification() {
    let cases: [(&[f64], i32, &[Bits]); 15] = [
        (&[2.0, -3.0], 1, &[(0x3FF8000000000000, 0)]),
        (&[2.0, 0.0], -1, &[]),
        (&[0.0, 1.0, 1.0], -1, &[]),
        (&[5.0, 0.0, 0.0, 0.0], -1, &[]),
        (&[1.0, 2.0, 0.0], 2, &[(0, 0), (0xC000000000000000, 0)]),
        (&[1.0, 0.0, 1.0], 2, &[(0x8000000000000000, 0x3FF0000000000000), (0x8000000000000000, 0xBFF0000000000000)]),
        (&[1.0, -3.0, 2.0], 2, &[(0x3FF0000000000000, 0), (0x4000000000000000, 0)]),
        (&[1.0, -6.0, 11.0, -6.0], 3, &[(0x3FF0000000000000, 0), (0x3FFFFFFFFFFFFFFF, 0), (0x4008000000000001, 0)]),
        (
            &[1.0, 0.0, 0.0, -1.0],
            3,
            &[
                (0x3FF0000000000000, 0),
                (0xBFE0000000000000, 0x3FEBB67AE8584CAA),
                (0xBFE0000000000000, 0xBFEBB67AE8584CAA),
            ],
        ),
        (
            &[1.0, 0.0, -3.0, -3.0],
            3,
            &[
                (0xBFF0D496E0DFB380, 0x3FE216697F2F5D6F),
                (0xBFF0D496E0DFB380, 0xBFE216697F2F5D6F),
                (0x4000D496E0DFB380, 0),
            ],
        ),
        (
            &[1.0, -3.0, 2.0, 1.5, -0.5],
            4,
            &[
                (0x3FD15FB0409434B4, 0),
                (0xBFE28D0E4FF58DE2, 0),
                (0x3FFA774D8BEADCE2, 0x3FE5403EBA9CF81B),
                (0x3FFA774D8BEADCE2, 0xBFE5403EBA9CF81B),
            ],
        ),
        (
            &[1.0, -4.0, 6.0, -4.0, 1.0],
            4,
            &[(0x3FEFFFFFFFFFFFEC, 0), (0x3FEFFFFFFFFFFFF4, 0), (0x3FF0000000000008, 0), (0x3FF0000000000008, 0)],
        ),
        (
            &[1.0, -5.0, 10.0, -10.0, 5.0, -1.0],
            5,
            &[
                (0x3FF0000000000010, 0),
                (0x3FF000000000000C, 0),
                (0x3FEFFFFFFFFFFFEC, 0),
                (0x3FEFFFFFFFFFFFEE, 0),
                (0x3FEFFFFFFFFFFFEE, 0),
            ],
        ),
        (
            &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
            5,
            &[
                (0, 0),
                (0x3FE6A09E667F3BCC, 0x3FE6A09E667F3BCD),
                (0x3FE6A09E667F3BCC, 0xBFE6A09E667F3BCD),
                (0xBFE6A09E667F3BCC, 0x3FE6A09E667F3BCB),
                (0xBFE6A09E667F3BCC, 0xBFE6A09E667F3BCB),
            ],
        ),
        (&[-1.0, -1.0, -4.0, 0.0, 5e-324, 0.0], 1, &[(0, 0)]),
    ];
    for (coefficients, count, expected) in cases {
        assert_eq!(bits(coefficients), (count, expected.to_vec()), "{coefficients:?}");
    }
}

#[test]
fn a_search_that_gives_up_reports_what_it_has() {
    assert_eq!(bits(&[1.0, 0.5, 3.0, 1.5, 0.0, 5e-324]), (0, vec![]));
}

#[test]
fn the_stages_pass_the_checkpoints_of_the_specification() {
    let mut cubic: Coefficients = [1.0, -6.0, 11.0, -6.0, 0.0, 0.0, 0.0];
    scaling::scale::<3>(&mut cubic);
    assert_eq!(
        cubic.map(f64::to_bits)[..4],
        [0x3B60000000000000, 0xBB88000000000000, 0x3B96000000000000, 0xBB88000000000000]
    );
    assert_eq!(bound::lower_bound::<3>(&cubic, &mut 0).map(f64::to_bits), Ok(0x3FDBD470E3EA2231));
    assert_eq!(
        no_shift::run::<3>(&cubic).map(f64::to_bits)[..3],
        [0x3B60000000000000, 0xBB83D8F3F2E646A7, 0x3B8792FFB6BD31A2]
    );
    let quartic: Coefficients = [1.0, -3.0, 2.0, 1.5, -0.5, 0.0, 0.0];
    assert_eq!(bound::lower_bound::<4>(&quartic, &mut 0).map(f64::to_bits), Ok(0x3FCDDE43A6A408F7));
    assert_eq!(
        no_shift::run::<4>(&quartic).map(f64::to_bits)[..4],
        [0x3FF0000000000000, 0xC005ABD335ABD336, 0x3FF31CF5931CF593, 0x3FFE77B2C677B2C7]
    );
}

#[test]
fn searches_that_would_never_end_are_typed_outcomes() {
    // Newton's iteration for the bound alternates between the smallest subnormal and zero.
    assert_eq!(zeros(&[-3.0, 4.5, 0.0, -1.5, 5e-324]), Err(DoesNotTerminate));
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for place in 0..6 {
            let mut coefficients = [1.0, -2.0, 3.0, -4.0, 5.0, -6.0];
            coefficients[place] = value;
            assert_eq!(zeros(&coefficients), Err(DoesNotTerminate), "{coefficients:?}");
            if place < 3 {
                // The closed forms accept all numbers.
                assert_eq!(zeros(&coefficients[..3]).map(|zeros| zeros.count()), Ok(2), "{coefficients:?}");
            }
        }
    }
}

#[test]
fn the_steps_of_all_stages_are_counted() {
    let steps = |coefficients: &[f64]| zeros(coefficients).expect("terminates").steps();
    assert_eq!(steps(&[1.0, -3.0, 2.0]), 0, "a closed form");
    let ordinary = steps(&[1.0, -6.0, 11.0, -6.0]);
    assert!((5..100).contains(&ordinary), "{ordinary}");
    // The bound is divided by ten until it is near a zero of 1e-300.
    let small = steps(&[1.0, 1.0, 1e-300, 1e-300]);
    assert!(small > ordinary + 100, "{small}");
}

#[test]
fn extreme_but_finite_coefficients_end() {
    let values = [-0.0, 5e-324, -1e-30, 1.0, -7.5, 1e308, -f64::MAX];
    let mut tested = 0;
    for a in values {
        for b in values {
            for c in values {
                for d in values {
                    let outcome = zeros(&[a, b, c, d]);
                    assert!(outcome.is_err() || outcome.is_ok_and(|zeros| zeros.count() <= 3));
                    tested += 1;
                }
            }
        }
    }
    assert_eq!(tested, 2_401);
}
