//! Judges traces with numbers that no simulation should contain. Judging must end, with a verdict.
use crate::{
    fair::FairVerdict,
    samples::{BOUNCE_SCENE, ZONES_SCENE, changed_reference_trace, judge_by_both, scene},
};
use fosssim_model::trace::Frame;

/// Numbers that overflow, underflow or are not finite.
const EXTREMES: [f64; 9] = [1e100, -1e100, 1e155, 1e-160, 5e-324, f64::MAX, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// Sets all coordinates and velocities of some records to one number.
fn blown_up(frames: &mut [Frame], from: usize, to: usize, value: f64) {
    for frame in &mut frames[from..to] {
        frame.state.positions.fill(value);
        frame.state.velocities.fill(value);
    }
}

/// The simulation diverges within a step: its records contain extreme numbers, while its polynomials are still small.
#[test]
fn states_of_any_size_are_judged_without_a_panic() {
    for text in [BOUNCE_SCENE, ZONES_SCENE] {
        let scene = scene(text);
        let records = changed_reference_trace(&scene, |_| {}).len();
        assert!(records > 0);
        for value in EXTREMES {
            for from in 0..5 {
                for to in from + 1..=5 {
                    let trace = changed_reference_trace(&scene, |frames| blown_up(frames, from, to, value));
                    let outcome = judge_by_both(&scene, &trace);
                    let fair = outcome.fair.expect("the fair rules were asked");
                    assert_eq!(fair.verdict, FairVerdict::Rejected, "{value} in {from}..{to}");
                }
            }
        }
    }
}
