//! Programs of the contest that omit pairs, or count them twice.
use crate::{
    finding::{FindingDetail, FindingKind},
    replay::{Options, judge},
};
use fosssim_findings::fair::{FairVerdict, Judgment};
use fosssim_model::{
    scene::{self, Scene},
    sim::PairKind,
};

/// Returns a scene with balls in rows, each near some of the others. They repel each other within a distance of 1.05.
fn pile(radius: f64) -> Scene {
    let thickness = 1.05 - 2.0 * radius;
    let ball = |index: u32| {
        let (row, column) = (f64::from(index / 4), f64::from(index % 4));
        let (x, y) = (0.93 * column + 0.41 * row + 0.01 * column * row, 0.87 * row + 0.02 * column);
        format!(
            r#"<particle m="{}" px="{x}" py="{y}" vx="0.{index}" vy="0" fixed="0" radius="{radius}"/>"#,
            1 + index % 3
        )
    };
    let balls: String = (0..12).map(ball).collect();
    let text = format!(
        r#"<scene><duration time="0.1"/><integrator type="forward-backward-euler" dt="0.01"/>
        <collision type="penalty" k="200" thickness="{thickness}"/><collisiondetection type="contest"/>{balls}</scene>"#
    );
    scene::read("scene", text.as_bytes()).expect("a scene").scene
}

/// Returns the trace of a program that applies the force of each pair to its two balls `times` times.
fn trace(scene: &Scene, times: impl Fn(usize, usize) -> [f64; 2]) -> Vec<u8> {
    trace_within(scene, 1.05, times)
}

/// Returns the trace of a program that applies only the forces of balls that are nearer than `reach`.
fn trace_within(scene: &Scene, reach: f64, times: impl Fn(usize, usize) -> [f64; 2]) -> Vec<u8> {
    let mut x: Vec<[f64; 2]> = scene.particles.iter().map(|ball| [ball.position.x, ball.position.y]).collect();
    let mut v: Vec<[f64; 2]> = scene.particles.iter().map(|ball| [ball.velocity.x, ball.velocity.y]).collect();
    let mut bytes = Vec::new();
    let mut write = |x: &[[f64; 2]], v: &[[f64; 2]]| {
        x.iter().chain(v).flatten().for_each(|value| bytes.extend(value.to_le_bytes()));
    };
    write(&x, &v);
    for _ in 0..scene.step_count() {
        for second in 0..x.len() {
            for first in 0..second {
                let n = [x[second][0] - x[first][0], x[second][1] - x[first][1]];
                let distance = (n[0] * n[0] + n[1] * n[1]).sqrt();
                if distance < reach {
                    let [one, other] = times(first, second);
                    for k in 0..2 {
                        let push = 0.01 * 200.0 * (distance - 1.05) * n[k] / distance;
                        v[first][k] += one * push / scene.particles[first].mass;
                        v[second][k] -= other * push / scene.particles[second].mass;
                    }
                }
            }
        }
        for (x, v) in x.iter_mut().zip(&v) {
            (x[0], x[1]) = (x[0] + 0.01 * v[0], x[1] + 0.01 * v[1]);
        }
        write(&x, &v);
    }
    bytes
}

fn judged(times: impl Fn(usize, usize) -> [f64; 2]) -> Judgment {
    let scene = pile(0.525);
    let options = Options { threads: 1, uses_fair_rules: true, ..Options::default() };
    *judge(&scene, &trace(&scene, times)[..], &options, &mut ()).fair.expect("the fair rules were asked")
}

/// Returns the counts of named pairs, and of positions and velocities without an explanation.
fn counts(fair: &Judgment) -> [u64; 2] {
    let count = |kind| fair.findings.counts.get(kind);
    [count(FindingKind::PairForce), count(FindingKind::Position) + count(FindingKind::Velocity)]
}

#[test]
fn forces_may_be_summed_in_any_order() {
    let fair = judged(|_, _| [1.0; 2]);
    assert_eq!((fair.verdict, counts(&fair)), (FairVerdict::Accepted, [0, 0]), "{fair:?}");
}

/// The original omits bodies whose layers alone are near. Other programs may include them.
#[test]
fn forces_of_a_layer_alone_may_be_left_out() {
    let scene = pile(0.5);
    let options = Options { threads: 1, uses_fair_rules: true, ..Options::default() };
    for reach in [1.0, 1.05] {
        let fair =
            judge(&scene, &trace_within(&scene, reach, |_, _| [1.0; 2])[..], &options, &mut ()).fair.expect("asked");
        assert_eq!((fair.verdict, counts(&fair)), (FairVerdict::Accepted, [0, 0]), "{fair:?}");
    }
}

#[test]
fn a_pair_that_was_left_out_or_added_twice_is_named_once_a_step() {
    for (times, said) in [(0.0, false), (2.0, true)] {
        let fair = judged(|first, second| if (first, second) == (5, 6) { [times; 2] } else { [1.0; 2] });
        assert_eq!(counts(&fair), [10, 0], "{fair:?}");
        let first = fair.findings.first_divergence.expect("a finding");
        let FindingDetail::PairForce { pair, is_doubled } = first.detail else { panic!("{first}") };
        let pair = (pair.kind, pair.first, pair.second);
        assert_eq!((first.step, pair, is_doubled), (1, (PairKind::ParticleParticle, 5, 6), said));
    }
}

#[test]
fn all_pairs_of_one_ball_are_named() {
    let fair = judged(|first, second| if first == 5 || second == 5 { [0.0; 2] } else { [1.0; 2] });
    let [named, others] = counts(&fair);
    assert!(named > 20 && others == 0, "{fair:?}");
}

#[test]
fn no_pair_is_named_where_something_else_is_wrong() {
    let stiffer: fn(usize, usize) -> [f64; 2] = |_, _| [1.25; 2];
    let one_end: fn(usize, usize) -> [f64; 2] =
        |first, second| if (first, second) == (5, 6) { [0.0, 1.0] } else { [1.0; 2] };
    for times in [stiffer, one_end] {
        let fair = judged(times);
        assert_eq!((fair.verdict, counts(&fair)[0]), (FairVerdict::Rejected, 0), "{fair:?}");
    }
}
