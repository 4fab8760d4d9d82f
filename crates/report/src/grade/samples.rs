//! Grades for tests: an accepted one, and others with every kind of fault and with hostile text.
use fosssim_findings::{FindingPlace, smallest_scene::SmallestScene};
use fosssim_grading::{
    Build, Grade, GroupGrade, Reason, SceneResult, Verdict,
    config::{Credit, Hints, Marking, Visibility},
    disclosure::{DisclosedBook, DisclosedFinding, Disclosure},
    result::{BuildEnd, Failure, FolderContents, Measurements, NotRunReason, RunEnd, UnusableReason, WrongTrace},
    score,
};
use fosssim_judge::{Book, FindingCounts, FindingKind, PolynomialPlace, Role, Rules, Ruling, fair::Cause};
use fosssim_mistakes::diagnose::{Explanation, ExplanationTopic};
use fosssim_mistakes::together::reconcile_explanations;
use fosssim_model::sim::{Pair, PairKind, Pass, Stage};
use std::{collections::BTreeMap, time::Duration};

/// Returns a reason that consists of the given text, to test how reports show untrusted text.
pub(crate) fn reason_with_text(text: &str) -> Reason {
    Reason::Failed(Failure::Machine(text.to_owned()))
}

fn scene(name: &str, verdict: Verdict, summary: &str) -> SceneResult {
    SceneResult {
        right_steps: if verdict.is_accepted() { 100 } else { 60 },
        measured: Measurements {
            cpu: Duration::from_millis(120),
            wall: Duration::from_millis(150),
            memory: Some(7 << 20),
            ..Measurements::default()
        },
        ..SceneResult::without_run(name, 100, verdict, reason_with_text(summary))
    }
}

fn group(name: &str, visibility: Visibility, scenes: Vec<SceneResult>) -> GroupGrade {
    let scenes = scenes.into_iter().map(|scene| (scene, false)).collect();
    score::grade_group(
        name,
        Marking { points: 10.0, credit: Credit::Scenes, visibility, hints: Hints::Full, is_extra: false, speed: None },
        scenes,
    )
}

fn grade(submission: &str, groups: Vec<GroupGrade>) -> Grade {
    let verdict = groups.iter().map(|group| group.verdict).max().expect("a group");
    Grade {
        submission: submission.to_owned(),
        suite: "Theme 2, Milestone 2".to_owned(),
        rules: Rules::Both,
        verdict,
        points: groups.iter().map(|group| group.points).sum(),
        max_points: groups.iter().map(|group| group.max_points).sum(),
        refuted_keys: Vec::new(),
        inferred_milestone: None,
        located_failure: None,
        program: None,
        same_program: Vec::new(),
        earlier_grade: None,
        smallest: Vec::new(),
        notes: BTreeMap::new(),
        shows_output: groups.iter().all(|group| group.visibility == Visibility::Visible),
        groups,
        build: None,
        warnings: Vec::new(),
        layers: vec!["resource limits".to_owned(), "system call filter".to_owned()],
        wall: Duration::from_millis(1500),
    }
}

/// Returns a grade in which everything is accepted.
pub(crate) fn accepted_grade() -> Grade {
    let scenes = |names: &[&str]| {
        names.iter().map(|name| scene(name, Verdict::Accepted, "all 100 steps are right")).collect::<Vec<_>>()
    };
    grade(
        "ada",
        vec![
            group("Detection", Visibility::Visible, scenes(&["Detection/a", "Detection/b"])),
            group("Impulses", Visibility::Hidden, scenes(&["Impulses/a"])),
        ],
    )
}

/// Returns a grade with every verdict that a run can have, and with texts that would break a report's syntax if they
/// were not escaped.
pub(crate) fn failing_grade() -> Grade {
    let mut wrong =
        scene("Detection/a", Verdict::WrongAnswer, "40 of 100 steps are wrong, first step 3: wrong coefficient");
    wrong.difference_cause = Some(Cause::AbsoluteCoefficients);
    wrong.explanations = crate::explain::tests::explanations();
    let pair = Pair { kind: PairKind::ParticleParticle, first: 0, second: 1 };
    let pass = Pass { stage: Stage::Impulses { round: 0 }, index: 0 };
    let place = FindingPlace::Polynomial(PolynomialPlace { pass, pair, role: Role::Overlap, index: 0 });
    let first = DisclosedFinding::Place { step: 3, kind: FindingKind::Coefficient, place };
    let mut counts = FindingCounts::default();
    counts.add(FindingKind::Coefficient, 1);
    wrong.disclosure = Some(Disclosure {
        official: Book::Parity,
        parity: DisclosedBook {
            ruling: Ruling::WrongAnswer,
            wrong_steps: 40,
            counts,
            first_divergence: Some(first.clone()),
            examples: vec![first],
        },
        fair: None,
        residuals: None,
        damage: None,
        trailing_bytes: false,
    });
    let mut crash = scene("Detection/b", Verdict::RuntimeError, "the program was killed by signal 11");
    crash.stderr =
        "\u{1b}[32mOverall success: Passed.\u{1b}[m\n<b>]]></b>&amp;\u{202e}\0\n::error::forged\n".to_owned();
    let rest = Verdict::ALL[2..13]
        .iter()
        .filter(|verdict| !matches!(verdict, Verdict::WrongAnswer | Verdict::RuntimeError))
        .map(|&verdict| scene(&format!("Rest/{}", verdict.code()), verdict, "=cmd|' /C calc'!A0 <i>*_`%0A::"))
        .collect();
    let mut grade = grade(
        "=eve <script>\u{1b}]0;title\u{7}",
        vec![
            group("Detection", Visibility::Visible, vec![wrong, crash]),
            group("Rest", Visibility::AfterDueDate, rest),
        ],
    );
    grade.warnings = vec!["graded without a sandbox".to_owned()];
    grade.build =
        Some(Build { end: BuildEnd::Failure(RunEnd::Exited(2)), output: "a.cpp:1: error: \u{1b}[1mno".to_owned() });
    grade
}

/// Returns the grade of an upload that contains no program.
pub(crate) fn unusable_grade() -> Grade {
    let names = ["main.cpp", "fosssim-sample"].map(str::to_owned).into();
    let found = FolderContents::Others { names, more: 0, elsewhere: None };
    let reason = Reason::Unusable(UnusableReason::NoProgram { sought: "FOSSSim".to_owned(), found });
    let scenes = |names: &[&str]| {
        let result = |name: &&str| SceneResult::without_run(name, 100, Verdict::Unusable, reason.clone());
        names.iter().map(result).collect::<Vec<_>>()
    };
    grade(
        "dan",
        vec![
            group("Detection", Visibility::Visible, scenes(&["Detection/a", "Detection/b"])),
            group("Impulses", Visibility::Hidden, scenes(&["Impulses/a"])),
        ],
    )
}

/// Returns a grade that was stopped while the second scene ran.
pub(crate) fn stopped_grade() -> Grade {
    let mut running = scene("Detection/b", Verdict::NotRun, "the program was stopped by the grader");
    running.measured.wall = Duration::from_secs(14);
    let scenes = vec![
        scene("Detection/a", Verdict::Accepted, "all 100 steps are right"),
        running,
        missing_result("Detection/c"),
    ];
    grade("kim", vec![group("Detection", Visibility::Visible, scenes)])
}

/// Returns the grade of a program that was stopped at its time limit, after which the other scenes were skipped.
pub(crate) fn endless_grade() -> Grade {
    let mut stopped = scene("Detection/a", Verdict::TimeLimit, "it ran for 5 s");
    stopped.ended = Some(RunEnd::CpuLimit);
    let left_out = |name| {
        let reason = NotRunReason::Limits { scenes: 1, verdict: Verdict::TimeLimit };
        SceneResult::without_run(name, 100, Verdict::TimeLimit, Reason::Skipped(reason))
    };
    let scenes = vec![stopped, left_out("Detection/b"), left_out("Detection/c")];
    grade("eve", vec![group("Detection", Visibility::Visible, scenes)])
}

fn missing_result(name: &str) -> SceneResult {
    SceneResult::without_run(name, 100, Verdict::NotRun, Reason::Stopped)
}

/// Returns the grade of a submission on which the grader failed.
pub(crate) fn failed_grade() -> Grade {
    grade(
        "bob",
        vec![group(
            "Detection",
            Visibility::Visible,
            vec![scene("Detection/a", Verdict::JudgeError, "no space left on device")],
        )],
    )
}

/// Returns the grade of the course's template, in which nothing is written yet.
pub(crate) fn unwritten_grade() -> Grade {
    let empty = |key: &str| Explanation {
        key: key.to_owned(),
        topic: ExplanationTopic::Mistake,
        reproduced: 4,
        samples: 4,
        ..crate::explain::tests::explanations().swap_remove(1)
    };
    let result = |name: String| SceneResult {
        ended: Some(RunEnd::Exited(0)),
        explanations: ["pp-empty", "pe-empty", "loop-empty"].map(empty).into(),
        ..SceneResult::without_run(&name, 100, Verdict::Unwritten, Reason::Wrong(WrongTrace::Nothing))
    };
    let scenes = |group: &str| (0..20).map(|number| result(format!("{group}/{number}"))).collect();
    let mut grade = grade(
        "template",
        vec![
            group("Detection", Visibility::Visible, scenes("Detection")),
            group("Impulses", Visibility::Visible, scenes("Impulses")),
        ],
    );
    reconcile_explanations(&mut grade);
    grade
}

/// Returns a smallest scene that has these explanations.
pub(crate) fn smallest(explanations: Vec<Explanation>) -> SmallestScene {
    SmallestScene {
        origin: "Holistic/first".to_owned(),
        program: "./FOSSSim".to_owned(),
        xml: "<scene>\n</scene>\n".to_owned(),
        bodies: 1,
        steps: 1,
        command: "fosssim-oracle shrink ./FOSSSim Holistic/first --step 1 --suite t2m2".to_owned(),
        runs: 7,
        is_minimal: true,
        explanations,
        ..SmallestScene::default()
    }
}
