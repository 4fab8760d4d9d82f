use super::*;
use fosssim_findings::Stop;
use fosssim_judge::replay::{Options, judge};
use fosssim_model::{
    assignments::Assignment,
    scene::{self, Scene},
};
use fosssim_student::{Student, assignments::probe_scenes, find, record_limited_trace};

/// Returns the observation of a program that ended normally.
fn from_trace(trace: Vec<u8>) -> Observation {
    Observation { trace, ended: fosssim_ended::RunEnd::Exited(0) }
}

/// Returns the observation of a student's program on a scene.
fn run(scene: &Scene, student: Student) -> Observation {
    from_trace(record_limited_trace(scene, student, 10_000).unwrap_or_else(|(trace, _)| trace))
}

/// Returns the largest number of significant digits of the scene's numbers: 1 for 0.05 and for 10, 2 for 1.5.
fn most_digits(scene: &Scene) -> usize {
    let significant = |value: &f64| {
        let digits: String = value.abs().to_string().chars().filter(char::is_ascii_digit).collect();
        digits.trim_matches('0').len()
    };
    size::list_numbers(&mut scene.clone()).into_iter().map(|(_, value)| significant(value)).max().unwrap_or(0)
}

/// Shrinks a probe scene on which a program with this mistake is wrong.
fn smallest(assignment: Assignment, mistake: &str) -> (WrongReason, SmallScene) {
    let student = Student::new(Some(find(mistake).expect("a row").mistake));
    for (_, scene) in probe_scenes(assignment) {
        let seen = run(&scene, student);
        let Some(reason) = WrongReason::first_reason(&scene, &seen) else { continue };
        let steps: Vec<u32> = (1..=scene.step_count()).collect();
        let mut is_reproduced =
            |scene: &Scene, is_only_reason| Some(reason.is_reproduced(scene, &run(scene, student), is_only_reason));
        let found = reduce(&step_starts(&scene, &seen.trace, &steps), assignment, &mut is_reproduced).expect("a scene");
        return (reason, found);
    }
    panic!("{mistake} shows on no probe scene");
}

#[test]
fn a_named_mistake_is_shown_by_one_step_of_few_bodies_and_round_numbers() {
    use Assignment::{T1M1, T1M2, T1M3, T2M1, T2M2};
    for (assignment, mistake, bodies) in [
        (T1M1, "gravity-no-mass", 1),
        (T1M2, "spring-sign", 2),
        (T1M3, "jacobian-spring-missing", 2),
        (T2M1, "penalty-edges-missing", 3),
        (T2M1, "respond-half-planes-missing", 1),
        (T2M2, "pp-radius-not-squared", 2),
        (T2M2, "pe-square-no-eh", 3),
        (T2M2, "failsafe-stop-keeps-position", 3),
    ] {
        let (reason, small) = smallest(assignment, mistake);
        let (scene, student) = (&small.scene, Student::new(Some(find(mistake).expect("a row").mistake)));
        assert!(small.is_minimal, "{mistake}");
        assert_eq!((scene.step_count(), scene.particles.len()), (1, bodies), "{mistake}: {}", scene::to_xml(scene));
        assert!(most_digits(scene) <= 2, "{mistake}: {}", scene::to_xml(scene));
        // The result can also be computed by hand, because it is 0.375 and does not have 17 digits.
        let (_, end) = size::simulate(scene).expect("a result");
        let short = |value: &f64| value.to_string().len() < 9;
        assert!(assignment == T1M3 || end.iter().all(short), "{mistake}: {end:?}");
        assert!(reason.is_reproduced(scene, &run(scene, student), false), "{mistake}");
        assert!(scene.unknown_features(assignment).next().is_none(), "{mistake}");
        for right in [Student::default(), Student::default().with_right_approach()] {
            assert_eq!(WrongReason::first_reason(scene, &run(scene, right)), None, "{mistake}");
        }
    }
}

#[test]
fn a_search_that_is_stopped_keeps_the_best_so_far() {
    let scene = &probe_scenes(Assignment::T1M1)[0].1;
    let student = Student::new(Some(find("gravity-doubled").expect("a row").mistake));
    let reason = WrongReason::first_reason(scene, &run(scene, student)).expect("wrong");
    let mut is_reproduced =
        |scene: &Scene, is_only_reason| Some(reason.is_reproduced(scene, &run(scene, student), is_only_reason));
    let begin = step_starts(scene, &run(scene, student).trace, &[1]);
    let all = reduce(&begin, Assignment::T1M1, &mut is_reproduced).expect("a scene");
    let mut runs = 0..2;
    let mut few = |scene: &Scene, is_only_reason| runs.next().and_then(|_| is_reproduced(scene, is_only_reason));
    let some = reduce(&begin, Assignment::T1M1, &mut few).expect("one");
    assert!(all.is_minimal && !some.is_minimal);
    let [all, some_size] = [&all, &some].map(|small| size::measure_size(&small.scene, Assignment::T1M1));
    assert!(all < some_size);
    assert!(reason.is_reproduced(&some.scene, &run(&some.scene, student), false));
}

/// If a program fails on every scene, a scene with one body is tried before all others.
#[test]
fn one_body_is_tried_first() {
    let scene = &probe_scenes(Assignment::T2M2)[0].1;
    let mut runs = 0..2;
    let mut is_reproduced = |_: &Scene, _| runs.next().map(|_| true);
    let small = reduce(&step_starts(scene, &[], &[1]), Assignment::T2M2, &mut is_reproduced).expect("a scene");
    assert!(scene.particles.len() > 1 && small.scene.particles.len() == 1);
}

#[test]
fn a_crash_is_the_same_by_its_signal_and_a_loop_by_its_limit() {
    use fosssim_ended::RunEnd::{CpuLimit, MemoryLimit, Signaled, WallLimit};
    let scene = &probe_scenes(Assignment::T1M1)[0].1;
    let seen = |ended| Observation { trace: Vec::new(), ended };
    let reason = |ended| WrongReason::first_reason(scene, &seen(ended)).expect("wrong");
    assert!(reason(Signaled(11)).is_reproduced(scene, &seen(Signaled(11)), false));
    assert!(!reason(Signaled(11)).is_reproduced(scene, &seen(Signaled(8)), false));
    assert!(reason(CpuLimit).is_reproduced(scene, &seen(WallLimit), false));
    assert!(!reason(CpuLimit).is_reproduced(scene, &seen(MemoryLimit), false));
    assert_eq!(WrongReason::first_reason(scene, &from_trace(Vec::new())), Some(WrongReason::BrokenTrace));
}

/// A ball between two posts is thrown from one to the other in each round of impulses: judging stops there, although
/// the trace is whole.
#[test]
fn a_judgment_that_stops_is_no_broken_trace() {
    let posts = |y: f64, fixed: u8| {
        let post = |x| format!(r#"<particle m="1" px="{x}" py="0" vx="0" vy="0" fixed="1" radius="0.2"/>"#);
        let text = format!(
            r#"<scene><duration time="2"/><integrator type="symplectic-euler" dt="0.1"/>
            <collision type="hybrid" COR="1" maxiters="2000000000" k="0" thickness="0.01"/>
            <particle m="1" px="0" py="{y}" vx="0" vy="0" fixed="{fixed}" radius="0.2"/>{}{}
            <simplegravity fx="10" fy="0"/></scene>"#,
            post(-0.25),
            post(0.25)
        );
        scene::read("posts", text.as_bytes()).expect("a scene").scene
    };
    let trace = |scene: &Scene| run(scene, Student::default()).trace;
    let (far, between) = (posts(100.0, 0), posts(0.0, 1));
    let initial = trace(&Scene { duration: 0.0, ..far.clone() }).len();
    let trace = [&trace(&far)[..initial], &trace(&between)[initial..]].concat();
    let outcome =
        judge(&far, &trace[..], &Options { threads: 1, uses_fair_rules: true, ..Options::default() }, &mut ());
    assert!(matches!(outcome.stop, Some(Stop::Step(_))), "{:?}", outcome.stop);
    let reason = WrongReason::first_reason(&far, &from_trace(trace));
    assert!(reason.is_some() && reason != Some(WrongReason::BrokenTrace), "{reason:?}");
}

#[test]
fn no_attempt_makes_a_mass_or_a_radius_negative() {
    let (_, scene) = probe_scenes(Assignment::T2M2).into_iter().next().expect("a probe scene");
    let attempts = reductions::REDUCTIONS.iter().flat_map(|reduction| {
        (0..).map_while(|index| reduction(&scene, Assignment::T2M2, index)).flatten().collect::<Vec<_>>()
    });
    let is_real = |scene: &Scene| scene.particles.iter().all(|body| body.mass >= 0.0 && body.radius >= 0.0);
    for attempt in attempts {
        assert!(is_real(&attempt), "{}", scene::to_xml(&attempt));
    }
}
