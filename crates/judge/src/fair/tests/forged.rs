//! Manipulated traces: each one tests something that the fair rules must not accept.
use crate::{
    fair::{FairRejection, FairVerdict, Judgment, context::Context},
    finding::{FindingDetail, FindingKind},
    samples::{
        BOUNCE_SCENE, ZONES_SCENE, changed_reference_trace, encode_frames, judge_by_both, replace_polynomials, scene,
        simulate,
    },
};
use fosssim_model::{
    scene::{Collision, Scene, original},
    sim::{Decision, Detection, ImpactTime, Observer, Pair, PairKind, SteeringObserver, StepController},
    trace::{Frame, PolynomialLog},
};
use fosssim_num::{polynomial::Polynomial, vector::Vec2};
use std::path::Path;

/// Returns the built-in scenes with continuous-time detection, by name.
#[expect(clippy::disallowed_methods, reason = "the built-in scenes are files")]
fn assets() -> Vec<(String, Scene)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/t2m2");
    let mut scenes = Vec::new();
    for group in std::fs::read_dir(&folder).expect("the scenes") {
        for file in std::fs::read_dir(group.expect("a group").path()).expect("a group") {
            let path = file.expect("a scene").path();
            let name = path.strip_prefix(&folder).expect("within").with_extension("").display().to_string();
            scenes.push((name, original::read(&std::fs::read(&path).expect("readable")).expect("a scene").scene));
        }
    }
    scenes.sort_by(|(one, _), (other, _)| one.cmp(other));
    scenes
}

fn fair(scene: &Scene, trace: &[u8]) -> Judgment {
    *judge_by_both(scene, trace).fair.expect("the fair rules were asked")
}

/// A program that divides its polynomials by powers of two. The course's library drops the coefficients that become
/// small, and the step continues with the others.
struct Factors<F>(F, usize);

impl<F: FnMut(usize, usize) -> i32> StepController for Factors<F> {
    fn adjust_polynomials(&mut self, _: Pair, _: &[f64], _: &[f64], polynomials: &mut [Polynomial]) {
        for (number, polynomial) in polynomials.iter_mut().enumerate() {
            let divisor = (0..(self.0)(number, self.1)).fold(1.0, |power, _| 2.0 * power);
            self.1 += 1;
            let divided: Vec<f64> = polynomial.coefficients().iter().map(|c| c / divisor).collect();
            *polynomial = Polynomial::trimmed(&divided);
        }
    }
}

/// Returns the largest distance between the coordinates of two runs, relative to the largest coordinate.
fn distance(one: &[Frame], other: &[Frame]) -> f64 {
    let (mut most, mut size) = (0.0_f64, 0.0_f64);
    for (one, other) in one.iter().zip(other) {
        for (a, b) in one.state.positions.iter().zip(&other.state.positions) {
            (most, size) = (most.max((a - b).abs()), size.max(a.abs()));
        }
    }
    most / size
}

/// Checks that the trace is rejected if factors change a decision. Returns the number of scenes with changed decisions.
/// Factors are powers of two, so they round nothing and make no decision borderline.
fn no_loss_is_accepted(exponent: impl Fn(usize, usize) -> i32 + Copy) -> usize {
    let mut changed = 0;
    for (name, scene) in assets() {
        let frames = simulate(&scene, SteeringObserver(Factors(exponent, 0)));
        let distance = distance(&simulate(&scene, ()), &frames);
        if distance > 1e-7 {
            changed += 1;
            let judged = fair(&scene, &encode_frames(&scene, &frames));
            assert_eq!(judged.verdict, FairVerdict::Rejected, "{name}: states are {distance} off");
        }
    }
    changed
}

#[test]
fn a_small_factor_must_not_change_what_happens() {
    assert!(no_loss_is_accepted(|_, _| 30) > 10);
    assert!(no_loss_is_accepted(|_, _| 20) > 0);
}

#[test]
fn a_factor_of_each_polynomial_must_not_change_what_happens() {
    // The factors are between 2^-10 and 2^-41, in no order.
    let of_each = |_, count: usize| 10 + i32::try_from((count.wrapping_mul(0x9e37_79b9) >> 7) % 32).expect("small");
    assert!(no_loss_is_accepted(of_each) > 10);
    for number in 0..4 {
        assert!(no_loss_is_accepted(|polynomial, _| if polynomial == number { 33 } else { 0 }) > 0, "{number}");
    }
}

/// Multiplying all polynomials of a trace by a factor near 1 changes nothing important.
#[test]
fn ordinary_factors_are_accepted() {
    for (name, scene) in assets() {
        let judged = fair(&scene, &encode_frames(&scene, &simulate(&scene, SteeringObserver(Factors(|_, _| 1, 0)))));
        assert_eq!(judged.verdict, FairVerdict::Accepted, "{name}: {:?}", judged.findings.first_divergence);
    }
}

/// A ball that moves in the first step and touches a slope at its end, except for a rounding error.
const TOUCH: &str = r#"<scene><duration time="1"/><integrator type="explicit-euler" dt="0.5"/>
    <collision type="continuous-time" COR="1"/>
    <particle m="1" px="0.6" py="0.8" vx="-1.08" vy="-1.44" fixed="0" radius="0.1"/>
    <halfplane px="0" py="0" nx="0.3" ny="0.4"/></scene>"#;

/// Replaces the first decision with the given one.
struct Answer(Option<Decision>);

impl StepController for Answer {
    fn adjust_decision(&mut self, _: Pair, decision: Decision) -> Decision {
        self.0.take().unwrap_or(decision)
    }
}

/// A ball hits a resting edge exactly at the end of the third step. The numbers are short, so nothing is rounded, and a
/// missed collision is not a borderline decision.
#[test]
fn an_impact_in_short_numbers_on_an_edge_at_rest_is_certain() {
    let text = r#"<scene><duration time="1"/><integrator type="symplectic-euler" dt="0.25"/>
        <collision type="continuous-time" COR="1"/>
        <particle m="3" px="0" py="7" vx="0" vy="-4" fixed="0" radius="1.25"/>
        <particle m="1" px="-1" py="2.5" vx="0" vy="0" fixed="1" radius="0.25"/>
        <particle m="1" px="1" py="2.5" vx="0" vy="0" fixed="1" radius="0.25"/>
        <edge i="1" j="2" radius="0.25"/></scene>"#;
    struct Early;
    impl StepController for Early {
        fn adjust_decision(&mut self, _: Pair, decision: Decision) -> Decision {
            match decision {
                Decision::Hit { time, .. } if time >= 1.0 => Decision::Miss { time: ImpactTime::Found(time) },
                other => other,
            }
        }
    }
    let scene = scene(text);
    let early = fair(&scene, &encode_frames(&scene, &simulate(&scene, SteeringObserver(Early))));
    assert_eq!(early.findings.counts.get(FindingKind::MissedCollision), 1, "{early:?}");
    assert_eq!(fair(&scene, &encode_frames(&scene, &simulate(&scene, ()))).verdict, FairVerdict::Accepted);
}

/// Round-off may change whether the pair collides, but not the normal and the time of the contact.
#[test]
fn a_borderline_contact_is_where_and_when_it_has_to_be() {
    let scene = scene(TOUCH);
    let with = |time, x, y| {
        let hit = Decision::Hit { time, normal: Vec2::new(x, y) };
        fair(&scene, &encode_frames(&scene, &simulate(&scene, SteeringObserver(Answer(Some(hit))))))
    };
    let miss = Decision::Miss { time: ImpactTime::None };
    let without = fair(&scene, &encode_frames(&scene, &simulate(&scene, SteeringObserver(Answer(Some(miss))))));
    let right = with(1.0, -0.06, -0.08);
    assert_eq!(
        (without.verdict, right.verdict),
        (FairVerdict::Accepted, FairVerdict::Accepted),
        "{without:?} {right:?}"
    );
    assert_eq!(without.borderline + right.borderline, 1, "one of them is the reference's");
    for (time, x, y) in [(1.0, 0.5, -0.08), (1.0, 0.06, 0.08), (1.0, f64::NAN, -0.08), (1.0, -0.07, -0.08)] {
        let judged = with(time, x, y);
        assert_eq!(judged.findings.counts.get(FindingKind::WrongNormal), 1, "{x} {y}: {judged:?}");
    }
    for time in [0.0, 0.44, 0.999, 1.001, f64::NAN, -1.0] {
        let judged = with(time, -0.06, -0.08);
        assert_eq!(judged.findings.counts.get(FindingKind::ContactTime), 1, "{time}: {judged:?}");
    }
}

/// The polynomials of all steps are empty, except for one that is multiplied by a factor. It proves nothing about the
/// others.
#[test]
fn one_factor_does_not_vouch_for_empty_logs() {
    for (name, scene) in assets() {
        let reference = changed_reference_trace(&scene, |_| {});
        let forged = changed_reference_trace(&scene, |frames| {
            for frame in frames {
                replace_polynomials(frame, |index, list| {
                    if index == 0 {
                        list.iter().map(|c| 1e-11 * c).filter(|c| c.abs() >= 1e-12).collect()
                    } else {
                        vec![]
                    }
                });
            }
        });
        if forged != reference {
            assert_eq!(fair(&scene, &forged).verdict, FairVerdict::Rejected, "{name}");
        }
    }
}

/// The coefficients are random numbers of ordinary size, and one polynomial has such a large factor that they could be
/// its round-off.
#[test]
fn a_large_factor_does_not_vouch_for_garbage() {
    for (name, scene) in assets() {
        let forged = changed_reference_trace(&scene, |frames| {
            for frame in frames {
                replace_polynomials(frame, |index, list| {
                    if index == 0 {
                        list.iter().map(|c| 1e15 * c).collect()
                    } else {
                        list.iter().map(|_| 0.125).collect()
                    }
                });
            }
        });
        assert_eq!(fair(&scene, &forged).verdict, FairVerdict::Rejected, "{name}");
    }
}

/// Factors that are zero, subnormal, negative or not finite are rejected.
#[test]
fn factors_must_be_positive_numbers() {
    let scene = scene(BOUNCE_SCENE);
    for factor in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, -1e-9, 0.0, 5e-324, 1e-320] {
        let forged = changed_reference_trace(&scene, |frames| {
            for frame in frames {
                replace_polynomials(frame, |_, list| {
                    Polynomial::trimmed(&list.iter().map(|c| factor * c).collect::<Vec<_>>()).coefficients().to_vec()
                });
            }
        });
        assert_eq!(fair(&scene, &forged).verdict, FairVerdict::Rejected, "{factor}");
    }
}

/// A scene with a ball that moves away from a half-plane.
const LEAVE: &str = r#"<scene><duration time="2"/><integrator type="explicit-euler" dt="0.5"/>
    <collision type="continuous-time" COR="1"/>
    <particle m="1" px="0.3" py="0.5" vx="0.1" vy="1" fixed="0" radius="0.25"/>
    <halfplane px="0" py="0" nx="0" ny="1"/></scene>"#;

/// Polynomials that are right only with some factors are reported in their own steps.
#[test]
fn polynomials_that_hang_on_factors_count_in_their_steps() {
    let scene = scene(LEAVE);
    let empty = |frames: &mut [Frame]| frames.iter_mut().for_each(|frame| replace_polynomials(frame, |_, _| vec![]));
    let judged = fair(&scene, &changed_reference_trace(&scene, |frames| empty(frames)));
    let first = judged.findings.first_divergence.expect("the first empty polynomial");
    assert_eq!((judged.findings.wrong_steps, first.step), (4, 1), "{judged:?}");
    assert!(matches!(first.detail, FindingDetail::Coefficient { .. }), "{first:?}");
    // The end of the fourth step is wrong as well, but the empty polynomial of the second step comes first.
    let judged = fair(
        &scene,
        &changed_reference_trace(&scene, |frames| {
            empty(&mut frames[3..5]);
            frames[8].state.positions[0] += 0.25;
        }),
    );
    assert_eq!(
        (judged.findings.wrong_steps, judged.findings.first_divergence.map(|first| first.step)),
        (2, Some(2)),
        "{judged:?}"
    );
}

const NOWHERE: [f64; 7] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e100, -1e100, 1e-160, 0.0];

/// All records after the first contain meaningless numbers. Later steps show no mistake, because no value can be right.
#[test]
fn steps_that_lead_nowhere_are_never_right() {
    for text in [BOUNCE_SCENE, ZONES_SCENE] {
        let scene = scene(text);
        for value in NOWHERE {
            if text == BOUNCE_SCENE && value.abs() < 1.0 {
                // A single ball may be anywhere in the neighborhood.
                continue;
            }
            let forged = changed_reference_trace(&scene, |frames| {
                for frame in &mut frames[1..] {
                    frame.state.positions.fill(value);
                    frame.state.velocities.fill(value);
                    frame.impulses.clear();
                    replace_polynomials(frame, |_, list| vec![f64::NAN; list.len()]);
                }
            });
            let outcome = judge_by_both(&scene, &forged);
            let right = outcome.right_steps(crate::Book::Fair);
            assert_eq!(right, 0, "{value}: {:?}", outcome.fair);
        }
    }
}

/// A single record with a meaningless number makes both the step before it and the step after it wrong.
#[test]
fn a_lost_record_spoils_two_steps() {
    let scene = scene(
        r#"<scene><duration time="1"/><integrator type="explicit-euler" dt="0.1"/><collision type="none"/>
        <particle m="1" px="0" py="0" vx="1" vy="2" fixed="0" radius="0.1"/></scene>"#,
    );
    for value in [f64::NAN, f64::INFINITY, 1e200] {
        let forged = changed_reference_trace(&scene, |frames| frames[5].state.velocities[1] = value);
        assert_eq!(fair(&scene, &forged).findings.wrong_steps, 2, "{value}");
        let forged = changed_reference_trace(&scene, |frames| {
            for frame in &mut frames[5..] {
                frame.state.positions.fill(value);
                frame.state.velocities.fill(value);
            }
        });
        assert_eq!(fair(&scene, &forged).findings.wrong_steps, 6, "{value}");
    }
}

/// The mid record of a step logs exactly the passes before it, even if nothing else shows this.
#[test]
fn the_mid_record_logs_the_passes_before_it() {
    for (name, scene) in assets() {
        let wrong_steps = |trace: &[u8]| fair(&scene, trace).findings.wrong_steps;
        let own = simulate(&scene, ());
        let steps = own[1..].chunks_exact(2);
        let is_hybrid = matches!(scene.collision, Collision::Hybrid { .. });
        let logging = steps.clone().filter(|step| is_hybrid && !step[0].polynomials.is_empty()).count();
        let emptied = changed_reference_trace(&scene, |frames| {
            frames[1..]
                .iter_mut()
                .step_by(2)
                .filter(|_| is_hybrid)
                .for_each(|mid| mid.polynomials = PolynomialLog::default());
        });
        assert_eq!(wrong_steps(&emptied) as usize, logging, "{name}, without passes");
        let longer = steps.filter(|step| step[0].polynomials.len() < step[1].polynomials.len()).count();
        let filled = changed_reference_trace(&scene, |frames| {
            for step in frames[1..].chunks_exact_mut(2) {
                step[0].polynomials = step[1].polynomials.clone();
            }
        });
        assert_eq!(wrong_steps(&filled) as usize, longer, "{name}, with all passes");
    }
}

/// If the scene itself leads to NaN, a trace with the same NaN is right.
#[test]
fn the_references_own_way_is_right_wherever_it_leads() {
    let scene = scene(
        r#"<scene><duration time="1"/><integrator type="explicit-euler" dt="0.1"/><collision type="none"/>
        <particle m="1" px="0" py="0" vx="1e300" vy="2" fixed="0" radius="0.1"/>
        <particle m="1" px="1" py="0" vx="0" vy="2" fixed="0" radius="0.1"/>
        <edge i="0" j="1" radius="0.1"/><springforce edge="0" k="1e300" l0="1" b="0"/></scene>"#,
    );
    let frames = simulate(&scene, ());
    assert!(frames.iter().any(|frame| !frame.state.velocities.iter().all(|v| v.is_finite())));
    assert_eq!(fair(&scene, &encode_frames(&scene, &frames)).verdict, FairVerdict::Accepted);
}

/// Balls rest on each other, so every approach polynomial is zero except for round-off. A trace in which all signs are
/// the opposite proves nothing.
#[test]
fn a_trace_that_is_mostly_borderline_is_not_accepted() {
    let ball = |x: f64| format!(r#"<particle m="1" px="{x}" py="0.3" vx="0.1" vy="0.3" fixed="0" radius="0.6"/>"#);
    let balls: String = (0..12).map(|number| ball(0.1 * f64::from(number))).collect();
    let scene = scene(&format!(
        r#"<scene><duration time="0.4"/><integrator type="explicit-euler" dt="0.1"/>
        <collision type="continuous-time" COR="1"/>{balls}</scene>"#
    ));
    struct Push;
    impl StepController for Push {
        fn adjust_polynomials(&mut self, _: Pair, _: &[f64], _: &[f64], polynomials: &mut [Polynomial]) {
            polynomials[1] = Polynomial::trimmed(&[1.0]);
        }
    }
    let plain = fair(&scene, &encode_frames(&scene, &simulate(&scene, ())));
    assert_eq!(plain.verdict, FairVerdict::Accepted);
    let forged = fair(&scene, &encode_frames(&scene, &simulate(&scene, SteeringObserver(Push))));
    assert_eq!(forged.rejection, Some(FairRejection::Undecided), "{:?} of {}", forged.borderline, forged.decisions);
    assert_eq!(forged.findings.counts.total(), 0, "{:?}", forged.findings.first_divergence);
}

/// Records which polynomials of each step belong to pairs that an earlier response has moved.
struct Moved<'a> {
    context: Context<'a>,
    is_moved: Vec<bool>,
    steps: Vec<Vec<bool>>,
}

impl Observer for Moved<'_> {
    fn begin_step(&mut self, _: u32) {
        self.is_moved.fill(false);
        self.steps.push(Vec::new());
    }

    fn observe_detection(&mut self, detection: &Detection<'_>) {
        let particles = self.context.particles(detection.pair);
        let is_moved = particles.iter().flatten().any(|&particle| self.is_moved[particle]);
        let step = self.steps.last_mut().expect("a step has begun");
        step.extend(detection.polynomials.iter().map(|_| is_moved));
        if matches!(detection.decision, Decision::Hit { .. }) {
            particles.iter().flatten().for_each(|&particle| self.is_moved[particle] = true);
        }
    }
}

/// The program skips the bodies that have collided in this step, so the polynomials of their pairs are empty.
#[test]
fn moved_bodies_may_not_be_skipped() {
    let mut told = 0;
    for (name, scene) in assets() {
        if !matches!(scene.collision, fosssim_model::scene::Collision::ContinuousTime { .. }) {
            continue;
        }
        let is_moved = vec![false; scene.particles.len()];
        let mut moved = Moved { context: Context::new(&scene), is_moved, steps: vec![vec![]] };
        simulate(&scene, &mut moved);
        let reference = changed_reference_trace(&scene, |_| {});
        let forged = changed_reference_trace(&scene, |frames| {
            for (number, frame) in frames.iter_mut().enumerate() {
                let left_out = &moved.steps[number.div_ceil(2)];
                replace_polynomials(frame, |index, list| if left_out[index] { vec![] } else { list.to_vec() });
            }
        });
        if forged != reference {
            let judged = fair(&scene, &forged);
            assert_eq!(judged.verdict, FairVerdict::Rejected, "{name}");
            let first = judged.findings.first_divergence.expect("a finding");
            // Missing polynomials are named before their consequences.
            assert!(matches!(first.kind(), FindingKind::Coefficient | FindingKind::MissedCollision), "{name}: {first}");
            told += u32::from(first.kind() == FindingKind::Coefficient);
        }
    }
    assert!(told > 5, "{told}");
}

/// A scene with an edge that turns under a ball, and another edge that is stretched along its line, with a ball on it.
/// For the second edge the right form is zero, and the course's form has a tiny t^3 coefficient.
const STRETCHED: &str = r#"<scene><duration time="0.4"/><integrator type="explicit-euler" dt="0.1"/>
    <collision type="continuous-time" COR="1"/>
    <particle m="1" px="0" py="0" vx="0" vy="0" fixed="0" radius="0.1"/>
    <particle m="1" px="1" py="0" vx="0.002" vy="0" fixed="0" radius="0.1"/>
    <particle m="1" px="2" py="0" vx="0.001" vy="0" fixed="0" radius="0.1"/>
    <particle m="1" px="0" py="5" vx="0.3" vy="-1" fixed="0" radius="0.1"/>
    <particle m="1" px="1" py="5" vx="0.1" vy="1.3" fixed="0" radius="0.1"/>
    <particle m="1" px="0.4" py="7" vx="0.1" vy="0.3" fixed="0" radius="0.1"/>
    <edge i="0" j="1" radius="0.1"/><edge i="3" j="4" radius="0.1"/></scene>"#;

/// The two forms of the approach polynomial differ only in t^3, and a small factor makes the library drop this
/// coefficient.
#[test]
fn dropped_coefficients_do_not_mix_forms() {
    struct Edges(f64);
    impl StepController for Edges {
        fn adjust_polynomials(&mut self, pair: Pair, _: &[f64], _: &[f64], polynomials: &mut [Polynomial]) {
            for polynomial in polynomials.iter_mut().filter(|_| pair.kind == PairKind::ParticleEdge) {
                let scaled: Vec<f64> = polynomial.coefficients().iter().map(|c| self.0 * c).collect();
                *polynomial = Polynomial::trimmed(&scaled);
            }
        }
    }
    let stretched = scene(STRETCHED);
    let is_slip = |list: &[f64]| list.len() == 4 && list[1..].iter().all(|c| c.abs() < 1e-12);
    assert!(simulate(&stretched, ()).iter().any(|frame| frame.polynomials.iter().any(is_slip)));
    for (name, scene) in assets().into_iter().chain([("stretched".to_owned(), stretched)]) {
        for factor in [1e-2, 1e-4, 1e-6, 1e-8] {
            let judged = fair(&scene, &encode_frames(&scene, &simulate(&scene, SteeringObserver(Edges(factor)))));
            let counts = &judged.findings.counts;
            let lost = counts.get(FindingKind::TrimmedDecision);
            assert_eq!(counts.total(), lost, "{factor} in {name}: {:?}", judged.findings.first_divergence);
        }
    }
}

/// In the first round of a hybrid step no response has moved a body, so a wrong formula is reported there.
#[test]
fn formulas_are_reported_in_the_first_pass_of_a_hybrid_step() {
    let mut told = 0;
    for (name, scene) in assets() {
        if !matches!(scene.collision, fosssim_model::scene::Collision::Hybrid { .. }) {
            continue;
        }
        let context = Context::new(&scene);
        let is_moved = vec![false; scene.particles.len()];
        let mut moved = Moved { context, is_moved, steps: vec![vec![]] };
        simulate(&scene, &mut moved);
        // In the first pass of each step, the polynomials of pairs whose bodies have already collided are changed.
        let trace = changed_reference_trace(&scene, |frames| {
            for (number, frame) in frames.iter_mut().enumerate() {
                let collided = &moved.steps[number.div_ceil(2)];
                replace_polynomials(frame, |index, list| {
                    let is_wrong = index < context.polynomials_per_pass && collided[index];
                    let factors = if is_wrong { [1.0, 2.0, 1.0, 2.0, 1.0, 2.0] } else { [1.0; 6] };
                    list.iter().zip(factors).map(|(c, factor)| factor * c).collect()
                });
            }
        });
        let judged = fair(&scene, &trace);
        let Some(first) = judged.findings.first_divergence else { continue };
        assert_ne!(first.kind(), FindingKind::PassPositions, "{name}: {first}");
        told += 1;
    }
    assert!(told > 20, "{told}");
}

/// After a response, fixed particles are at their old positions without round-off, so a zero polynomial must stay zero.
#[test]
fn fixed_particles_are_not_moved_by_a_response() {
    let scene = scene(
        r#"<scene><duration time="1"/><integrator type="explicit-euler" dt="0.5"/>
        <collision type="continuous-time" COR="1"/>
        <particle m="1" px="0.3" py="0.7" vx="0" vy="0" fixed="1" radius="0.1"/>
        <particle m="1" px="0.31" py="2" vx="0" vy="-3" fixed="0" radius="0.1"/>
        <halfplane px="0.1" py="-0.3" nx="0.3" ny="1.7"/></scene>"#,
    );
    let frames = simulate(&scene, ());
    assert!(!frames[2].impulses.is_empty() && frames[2].polynomials.get(3).is_empty());
    let forged = changed_reference_trace(&scene, |frames| {
        for frame in &mut frames[1..3] {
            replace_polynomials(frame, |index, list| if index == 3 { vec![0.25] } else { list.to_vec() });
        }
    });
    assert_eq!(fair(&scene, &forged).verdict, FairVerdict::Rejected);
}

/// Makes the opposite of the reference's decision about the pair with the edge.
struct OtherWay;

impl StepController for OtherWay {
    fn adjust_decision(&mut self, pair: Pair, decision: Decision) -> Decision {
        match decision {
            _ if pair.kind != PairKind::ParticleEdge => decision,
            Decision::Hit { .. } => Decision::Miss { time: ImpactTime::None },
            // The normal goes from the ball to its nearest point of the edge.
            Decision::Miss { .. } => Decision::Hit { time: 0.0, normal: Vec2::new(0.6, -0.8) },
        }
    }
}

/// A ball ends a step of `simple` at a point of a slanted edge, as near as rounding allows. Both decisions are right,
/// and the normal of a contact must fit this point.
#[test]
fn a_ball_that_just_touches_an_edge_may_collide_or_not() {
    let mut decided = [0, 0];
    for off in -3_i32..=3 {
        // The ball is two fifths along the edge from the origin to (4, 3), at a distance equal to the sum of the radii.
        let (x, y) = (1.6 - 0.6 + f64::from(off) * f64::EPSILON, 1.2 + 0.8);
        let text = format!(
            r#"<scene><duration time="1"/><integrator type="explicit-euler" dt="1"/><collision type="simple" COR="1"/>
            <particle m="1" px="{}" py="{}" vx="0.6" vy="-0.8" fixed="0" radius="0.75"/>
            <particle m="1" px="0" py="0" vx="0" vy="0" fixed="1" radius="0.1"/>
            <particle m="1" px="4" py="3" vx="0" vy="0" fixed="1" radius="0.1"/>
            <edge i="1" j="2" radius="0.25"/></scene>"#,
            x - 0.6,
            y + 0.8
        );
        let scene = scene(&text);
        let contacts = |frames: &[Frame]| frames.last().expect("a record").impulses.len();
        let mut frames = simulate(&scene, SteeringObserver(OtherWay));
        let count = contacts(&frames);
        assert_eq!(contacts(&simulate(&scene, ())), 1 - count);
        decided[count] += 1;
        assert_eq!(fair(&scene, &encode_frames(&scene, &frames)).verdict, FairVerdict::Accepted, "{text}");
        for impulse in frames.iter_mut().flat_map(|frame| &mut frame.impulses) {
            impulse.normal.x += 1e-9;
        }
        let is_rejected = fair(&scene, &encode_frames(&scene, &frames)).verdict == FairVerdict::Rejected;
        assert_eq!(is_rejected, count == 1, "with another normal: {text}");
    }
    assert!(decided.iter().all(|count| *count > 0), "{decided:?}");
}

/// No collision happens before the first step.
#[test]
fn the_initial_record_has_no_lists() {
    let scene = scene(BOUNCE_SCENE);
    let frames = simulate(&scene, ());
    let later = frames.iter().find(|frame| !frame.impulses.is_empty()).expect("a contact");
    for (impulses, polynomials) in [(true, false), (false, true), (true, true)] {
        let forged = changed_reference_trace(&scene, |frames| {
            if impulses {
                frames[0].impulses.clone_from(&later.impulses);
            }
            if polynomials {
                frames[0].polynomials.clone_from(&later.polynomials);
            }
        });
        assert_eq!(fair(&scene, &forged).verdict, FairVerdict::Rejected, "{impulses} {polynomials}");
    }
}
