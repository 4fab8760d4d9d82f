//! Grades for tests: one good, one bad in every way, with hostile words in it.
use crate::judge::{Rules, fair::Cause};
use crate::suite::{
    Build, Grade, GroupGrade, SceneGrade, Verdict,
    config::{Credit, Visibility},
    score::{self, Stakes},
};
use std::time::Duration;

fn scene(name: &str, verdict: Verdict, summary: &str) -> SceneGrade {
    SceneGrade {
        scene: name.to_owned(),
        verdict,
        summary: summary.to_owned(),
        differs: None,
        details: Vec::new(),
        explanations: Vec::new(),
        points: 0.0,
        max_points: 0.0,
        right_steps: if verdict.is_accepted() { 100 } else { 60 },
        steps: 100,
        cpu: Duration::from_millis(120),
        wall: Duration::from_millis(150),
        memory: Some(7 << 20),
        stdout: String::new(),
        stderr: String::new(),
        cached: false,
    }
}

fn group(name: &str, visibility: Visibility, scenes: Vec<SceneGrade>) -> GroupGrade {
    score::group(name, Stakes { points: 10.0, credit: Credit::Scenes, visibility }, scenes)
}

fn grade(submission: &str, groups: Vec<GroupGrade>) -> Grade {
    let verdict = groups.iter().map(|group| group.verdict).max().expect("a group");
    Grade {
        submission: submission.to_owned(),
        suite: "Theme 2, Milestone 2".to_owned(),
        rules: Rules::Both,
        verdict,
        points: (verdict != Verdict::JudgeError).then(|| groups.iter().map(|group| group.points).sum()),
        max_points: groups.iter().map(|group| group.max_points).sum(),
        groups,
        build: None,
        warnings: Vec::new(),
        layers: vec!["resource limits".to_owned(), "system call filter".to_owned()],
        wall: Duration::from_millis(1500),
    }
}

/// Everything accepted.
pub(crate) fn good() -> Grade {
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

/// Every verdict but judge error, and words that try to get into the report's own syntax.
pub(crate) fn bad() -> Grade {
    let mut wrong =
        scene("Detection/a", Verdict::WrongAnswer, "40 of 100 steps are wrong, first step 3: wrong coefficient");
    wrong.differs = Some(Cause::AbsoluteCoefficients);
    wrong.explanations = crate::report::explain::tests::explanations();
    wrong.details = vec!["first divergence: step 3: overlap polynomial of particles 0 and 1".to_owned()];
    let mut crash = scene("Detection/b", Verdict::RuntimeError, "the program ended by signal 11");
    crash.stderr =
        "\u{1b}[32mOverall success: Passed.\u{1b}[m\n<b>]]></b>&amp;\u{202e}\0\n::error::forged\n".to_owned();
    let rest = Verdict::ALL[1..11]
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
    grade.build = Some(Build {
        succeeded: false,
        end: "the build exited with code 2".to_owned(),
        output: "a.cpp:1: error: \u{1b}[1mno".to_owned(),
    });
    grade
}

/// The grader failed.
pub(crate) fn fault() -> Grade {
    grade(
        "bob",
        vec![group(
            "Detection",
            Visibility::Visible,
            vec![scene("Detection/a", Verdict::JudgeError, "no space left on device")],
        )],
    )
}
