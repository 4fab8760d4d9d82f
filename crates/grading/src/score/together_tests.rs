//! Tests the explanations of all scenes together.
use crate::{
    Grade, SceneResult, Verdict,
    config::{Credit, Hints, Marking, Visibility},
    result::Reason,
    score,
};
use fosssim_findings::{
    Rules,
    explanation::{Explanation, ExplanationTopic, NanStage, NonFiniteValue},
};
use fosssim_mistakes::together::{find_likely_mistakes, mistake_points, reconcile_explanations, shared_points};
use std::time::Duration;

fn explanation(key: &str, about: ExplanationTopic, reproduced: u64) -> Explanation {
    Explanation {
        key: key.to_owned(),
        topic: about,
        details: Vec::new(),
        reproduced,
        samples: reproduced,
        example: None,
        same_as: Vec::new(),
        contradicted_keys: Vec::new(),
        claims: Vec::new(),
    }
}

fn grade(scenes: Vec<Vec<Explanation>>) -> Grade {
    let wrong = |(number, explanations): (usize, Vec<Explanation>)| {
        let run = SceneResult::without_run(&format!("a/{number}"), 9, Verdict::WrongAnswer, Reason::Right);
        (SceneResult { explanations, ..run }, false)
    };
    let marking = Marking {
        points: 1.0,
        credit: Credit::Scenes,
        visibility: Visibility::Visible,
        hints: Hints::Full,
        is_extra: false,
        speed: None,
    };
    let results = scenes.into_iter().enumerate().map(wrong).collect();
    let mut grade = Grade {
        submission: String::new(),
        suite: String::new(),
        rules: Rules::Fair,
        verdict: Verdict::WrongAnswer,
        points: Some(0.0),
        max_points: 1.0,
        groups: vec![score::grade_group("a", marking, results)],
        shows_output: true,
        build: None,
        warnings: Vec::new(),
        layers: Vec::new(),
        wall: Duration::ZERO,
        refuted_keys: Vec::new(),
        inferred_milestone: None,
        located_failure: None,
        program: None,
        same_program: Vec::new(),
        earlier_grade: None,
        smallest: Vec::new(),
        notes: std::collections::BTreeMap::new(),
    };
    reconcile_explanations(&mut grade);
    grade
}

/// An explanation of all scenes together is reported for each scene that it explains. Values that are not finite are
/// reported for each scene separately.
#[test]
fn each_scene_says_what_all_together_say() {
    let end = |step, stage| {
        explanation(
            Explanation::NOT_FINITE,
            ExplanationTopic::NotFinite(NonFiniteValue { step: Some(step), stage, is_nan: true, recovers: false }),
            0,
        )
    };
    let short = explanation("loop-one-fewer", ExplanationTopic::Mistake, 4);
    let empty = Explanation {
        same_as: vec!["loop-one-fewer".to_owned()],
        ..explanation("loop-empty", ExplanationTopic::Mistake, 2)
    };
    let grade = grade(vec![
        vec![empty],
        vec![end(7, NanStage::Zones), short.clone()],
        vec![end(3, NanStage::Zones), short],
        vec![end(5, NanStage::Responses)],
    ]);
    let heads: Vec<(String, usize)> =
        find_likely_mistakes(&grade).into_iter().map(|(one, count)| (one.key, count)).collect();
    assert_eq!(heads, [("loop-one-fewer".to_owned(), 3), (Explanation::NOT_FINITE.to_owned(), 2)]);
    let said: Vec<Vec<&str>> =
        grade.scenes().map(|scene| scene.corrected_explanations.iter().map(|one| one.key.as_str()).collect()).collect();
    let both = ["loop-one-fewer", Explanation::NOT_FINITE];
    assert_eq!(said, [&both[..1], &both, &both, &both[1..]]);
    let steps: Vec<Option<u32>> = grade
        .scenes()
        .filter_map(|scene| match &scene.corrected_explanations.last()?.topic {
            ExplanationTopic::NotFinite(found) => Some(found.step),
            _ => None,
        })
        .collect();
    assert_eq!(steps, [Some(7), Some(3), Some(5)]);
}

/// Students should fix a mistake first, before the values that are not finite.
#[test]
fn the_first_nan_comes_last() {
    let end = || {
        explanation(
            Explanation::NOT_FINITE,
            ExplanationTopic::NotFinite(NonFiniteValue {
                step: Some(7),
                stage: NanStage::Zones,
                is_nan: true,
                recovers: false,
            }),
            0,
        )
    };
    let short =
        |reproduced| Explanation { samples: 4, ..explanation("loop-one-fewer", ExplanationTopic::Mistake, reproduced) };
    let first =
        |scenes| find_likely_mistakes(&grade(scenes)).into_iter().next().map(|(one, _)| one.key).expect("a head");
    assert_eq!(first(vec![vec![end()], vec![end()]]), Explanation::NOT_FINITE);
    assert_eq!(first(vec![vec![end()], vec![end()], vec![short(4)]]), "loop-one-fewer");
    assert_eq!(first(vec![vec![short(4), end()], vec![short(4), end()]]), "loop-one-fewer");
    assert_eq!(first(vec![vec![end(), short(3)], vec![end(), short(3)]]), "loop-one-fewer", "though it is not proven");
}

/// Fixing a mistake is worth the points of the scenes in which it is the only mistake. A group that gives all points or
/// none counts only as a whole.
#[test]
fn a_mistake_is_worth_the_points_that_it_alone_costs() {
    let one = |key: &str| explanation(key, ExplanationTopic::Mistake, 4);
    let part = Explanation { samples: 5, ..one("loop-one-fewer") };
    let scenes = vec![vec![one("loop-one-fewer")], vec![one("loop-one-fewer"), one("pp-no-two")], vec![part], vec![]];
    let mut grade = grade(scenes);
    assert_eq!([one("loop-one-fewer"), one("pp-no-two")].map(|mistake| mistake_points(&grade, &mistake)), [0.25, 0.0]);
    // The second scene needs both.
    assert_eq!(shared_points(&grade, &[one("loop-one-fewer"), one("pp-no-two")]), 0.25);
    assert_eq!(shared_points(&grade, &[one("loop-one-fewer")]), 0.0);
    grade.groups[0].all_or_nothing = true;
    assert_eq!(mistake_points(&grade, &one("loop-one-fewer")), 0.0, "other scenes stay wrong");
    grade.groups[0].scenes.truncate(1);
    assert_eq!(mistake_points(&grade, &one("loop-one-fewer")), 0.25);
    grade.groups[0].extra = true;
    assert_eq!(mistake_points(&grade, &one("loop-one-fewer")), 0.0);
}
