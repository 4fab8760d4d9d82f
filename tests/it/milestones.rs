//! The course's milestones: each has a suite of scenes that its programs can run, and that accepts correct programs.
use super::{
    grading,
    workspace::{Workspace, simulate},
};
use fosssim_oracle::{
    assignments::Assignment::{self, T1M1, T1M2, T1M3, T2M1, T2M2, T2M3},
    diagnose::probe_scenes,
    judge::{
        Overall,
        fair::FairVerdict,
        replay::{Options, judge},
    },
    num::vector::Vec2,
    scene::{Collision, CollisionDetection, Force, Scene},
    student::{self, Student},
    suite::plan,
};

/// Returns whether the fair rules accept the trace, and whether the original's rules do.
fn verdicts(scene: &Scene, trace: &[u8]) -> [bool; 2] {
    let outcome = judge(scene, trace, &Options { threads: 1, uses_fair_rules: true, ..Options::default() }, &mut ());
    let fair = outcome.fair.expect("the fair rules were asked").verdict == FairVerdict::Accepted;
    [fair, outcome.parity.overall == Overall::Passed]
}

/// Returns whether both rule books accept the trace.
fn accepts(scene: &Scene, trace: &[u8]) -> bool {
    let [fair, parity] = verdicts(scene, trace);
    assert_eq!(fair, parity);
    fair
}

/// Returns the scenes of a suite, without the large ones for time measurements.
fn scenes(assignment: Assignment) -> Vec<(String, Scene)> {
    let plan = plan::find_suite(assignment.key()).unwrap_or_else(|error| panic!("{assignment:?}: {error}"));
    let tasks = plan.scenes().filter(|task| task.scene.particles.len() < 1_000);
    tasks.map(|task| (task.name.clone(), task.scene.clone())).collect()
}

#[test]
fn every_scene_of_a_suite_can_be_run_by_programs_of_its_milestone() {
    for assignment in [T1M1, T1M2, T1M3, T2M1, T2M2] {
        let (scenes, probes) = (scenes(assignment), probe_scenes(assignment));
        assert!(scenes.len() > 4, "{assignment:?}");
        for (name, scene) in scenes.into_iter().chain(probes) {
            let unknown: Vec<String> = scene.unknown_features(assignment).map(|unknown| unknown.to_string()).collect();
            assert!(unknown.is_empty(), "{name}: {unknown:?}");
        }
    }
}

#[test]
fn a_right_program_is_accepted_on_every_scene_of_its_milestone() {
    for assignment in [T1M1, T1M2, T1M3, T2M1, T2M3] {
        for (name, scene) in scenes(assignment) {
            let trace = student::record_trace(&scene, Student::default()).expect("a trace");
            // Only in the reference, the order of a contest's sums continues from step to step.
            assert!(assignment == T2M3 || trace == simulate(&scene), "{name}: bit for bit");
            assert!(accepts(&scene, &trace), "{name}");
        }
    }
}

/// An additional force on every particle is noticed if a particle is free.
#[test]
fn a_force_too_much_is_never_accepted() {
    for assignment in [T1M1, T1M2, T1M3, T2M1, T2M3] {
        for (name, scene) in scenes(assignment) {
            if scene.particles.iter().all(|particle| particle.fixed) {
                continue;
            }
            let mut wrong = scene.clone();
            wrong.forces.push(Force::Constant { force: Vec2::new(0.0, -1e-3) });
            assert!(!accepts(&scene, &simulate(&wrong)), "{name}");
        }
    }
}

/// A teacher gets a message if a scene of a suite needs more than the programs of its milestone can do.
#[test]
fn scenes_beyond_a_milestone_are_reported_and_own_ones_rejected() {
    let workspace = Workspace::new();
    let old = workspace.run(["suite", "check", "t1m2@1"]);
    assert!(
        old.out().contains("note: ForcesTests/constant-force: programs of T1M2 ignore <constantforce>"),
        "{}",
        old.shown()
    );
    let newest = workspace.run(["suite", "check", "t1m2"]);
    assert!(!newest.out().contains("programs of T1M2"), "{}", newest.shown());
    let vortex = workspace.run(["scene", "show", "vortex-pair-and-third-body"]);
    workspace.write("vortex.xml", vortex.out());
    let suite = |milestone: &str| {
        let text = format!(
            "schema = 1\nname = \"one\"\nmilestone = \"{milestone}\"\n[[group]]\nname = \"a\"\n\
             scenes = [\"vortex.xml\"]\n"
        );
        workspace.write("suite.toml", text);
        workspace.run(["suite", "check", "suite.toml"])
    };
    let beyond = suite("t1m2");
    assert_eq!(beyond.code, Some(2), "{}", beyond.shown());
    assert!(beyond.err().contains("6:11: scene vortex: programs of T1M2 ignore <vortexforce>"), "{}", beyond.shown());
    let inside = suite("t1m3");
    assert!(inside.code == Some(0) && inside.out().contains("programs: Theme 1, Milestone 3\n"), "{}", inside.shown());
}

/// Implicit Euler is optional: a program without it gets all normal points, and no extra points.
#[test]
fn extra_points_are_reported_beside_the_others() {
    let Some(workspace) = grading::workspace() else { return };
    let path = &grading::submit(&workspace, &["implicit-positions-kept"])[0];
    let run = workspace.run(["grade", path, "--suite", "t1m3"]);
    assert!(run.out().contains("accepted, 100 of 100 points, 0 of 20 extra points"), "{}", run.shown());
    assert!(run.out().contains("\nImplicitEulerTests (0 of 20 extra)\n"), "{}", run.shown());
    assert_eq!(run.code, Some(0), "{}", run.shown());
}

/// Programs of the contest may sum their forces in any order, and may include layers that the original leaves out. A
/// program that leaves out a pair is rejected.
#[test]
fn forces_of_the_contest_may_be_summed_in_any_order() {
    for (name, scene) in scenes(T2M3) {
        let Collision::Penalty { stiffness, thickness, .. } = scene.collision else { panic!("{name}") };
        let other = Collision::Penalty { stiffness, thickness, detection: CollisionDetection::AllPairs };
        let trace = simulate(&Scene { collision: other, ..scene.clone() });
        assert_eq!(verdicts(&scene, &trace), [true, thickness == 0.0], "{name}");
        let mut fewer = scene.clone();
        fewer.edges.clear();
        fewer.half_planes.clear();
        if fewer.edges.len() + fewer.half_planes.len() < scene.edges.len() + scene.half_planes.len()
            && !scene.forces.iter().any(|force| matches!(force, Force::Spring { .. }))
        {
            assert!(!accepts(&scene, &simulate(&fewer)), "{name}");
        }
    }
}

/// The original of that milestone prints its own texts, with its own times.
#[test]
fn the_drop_in_speaks_as_the_contests_original() {
    let workspace = Workspace::new();
    let (_, scene) = &scenes(T2M3)[0];
    workspace.write("scene.xml", fosssim_oracle::scene::to_xml(scene));
    workspace.write("trace.bin", simulate(scene));
    let run = workspace.original(["-s", "scene.xml", "-d", "0", "-i", "trace.bin"]);
    let text = run.out();
    assert!(text.contains("\nHybrid Collisions Passed: Yes.\nOverall success: Passed.\n"), "{text}");
    let steps = "Preparation: 0s\nCollision detection: 0s\nCollision handling: 0s\nT: ";
    assert_eq!(text.matches(steps).count(), scene.step_count() as usize);
    assert!(text.contains("T: 0\nFrame run time: 0s. Total run time: 0s. \n"), "{text}");
    assert_eq!(text.matches("s. Total run time: ").count(), scene.step_count() as usize + 1);
    let recorded = workspace.original(["-s", "scene.xml", "-d", "0", "-o", "new.bin"]);
    assert_eq!(recorded.out().matches(steps).count(), scene.step_count() as usize);
}

/// A teacher sees the known mistakes that a suite does not detect, according to the sample program's traces.
#[test]
fn a_suite_says_which_known_mistakes_no_scene_of_it_shows() {
    let workspace = Workspace::new();
    let check = |suite: &str| {
        let run = workspace.run(["suite", "check", suite, "--mistakes"]);
        assert_eq!(run.code, Some(0), "{}", run.shown());
        run.out()
    };
    let part = |text: &str, name: &str| -> (usize, usize) {
        let line = text.lines().find(|line| line.trim_start().starts_with(name)).unwrap_or_else(|| panic!("{text}"));
        let numbers: Vec<usize> = line.split(' ').filter_map(|word| word.parse().ok()).collect();
        (numbers[0], numbers[1])
    };
    let contest = check("t2m3@1");
    let (seen, all) = part(&contest, "near-pairs");
    let seen_by_all = seen;
    assert!(seen == all && all > 10, "{contest}");
    for other in ["jacobians", "penalty"] {
        assert!(!contest.contains(other), "of what students do not write it says nothing: {contest}");
    }
    let implicit = check("t1m3");
    assert!(!implicit.contains("log-") && part(&implicit, "together").1 > 100, "{implicit}");
    let (seen, all) = part(&implicit, "jacobians");
    assert!(10 * seen > 9 * all, "{implicit}");
    // One scene alone shows less.
    let scene = "ContestTests/two-balls-of-different-size";
    let text = format!("schema = 1\nname = \"one\"\n[[group]]\nname = \"one\"\nscenes = [\"asset:t2m3@1/{scene}\"]\n");
    workspace.write("one.toml", text);
    let one = check("one.toml");
    assert!(part(&one, "near-pairs").0 < seen_by_all && one.contains("not shown: "), "{one}");
}

/// Scenes with correct traces also count, and a mistake that only one scene shows is reported next to the most frequent
/// one.
#[test]
fn a_grade_names_what_its_scenes_show_together() {
    let Some(workspace) = grading::workspace() else { return };
    let cases = [
        ("penalty-first-half-plane-only", "t2m1", "The penalty force is computed for the first half-plane only."),
        ("near-pairs-half-planes-doubled", "t2m3@1", "all pairs of a particle and a half-plane are reported twice."),
        (
            "jacobian-drag-missing",
            "t1m3",
            "The derivative of drag with respect to velocities is not written yet, or adds nothing.",
        ),
        ("gravitation-no-masses,spring-no-rest-length", "t1m3", "The gravitational force ignores the masses."),
        ("gravity-missing", "t1m1", "The update of velocities in explicit Euler is missing."),
    ];
    let paths = grading::submit(&workspace, &cases.map(|(mistake, ..)| mistake));
    for ((mistake, suite, sentence), path) in cases.into_iter().zip(paths) {
        let run = workspace.run(["grade", &path, "--suite", suite]);
        let text = run.out();
        let (_, told) = text.split_once("\nLikely mistake").unwrap_or_else(|| panic!("{}", run.shown()));
        assert!(told.contains(sentence), "{mistake}: {}", run.shown());
    }
}
