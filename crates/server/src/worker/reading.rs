//! The grader's words about a submission, as far as the service understands them; the rest goes to people.
use crate::{
    grade_file::{GradeFile, SceneInFile},
    store::Digest,
    task::{Outcome, WrongScene},
};
use std::{fs, path::Path};

/// The schemas of `grade.json` that are read here. While servers and workers are upgraded one after the other, a grader
/// may be older; what is read here was the same in both.
const SCHEMAS: std::ops::RangeInclusive<u32> = 3..=4;

/// Numbers keep their digits: the text that the grader wrote is what counts.
pub(super) fn read_grade(file: &Path) -> Result<Outcome, String> {
    let bytes = fs::read(file).map_err(|error| format!("the grader wrote no grade.json: {error}"))?;
    let damaged = |error: serde_json::Error| format!("grade.json can't be read: {error}");
    let report: GradeFile = serde_json::from_slice(&bytes).map_err(damaged)?;
    if !SCHEMAS.contains(&report.schema) {
        let (first, last) = SCHEMAS.into_inner();
        return Err(format!("grade.json has schema {}, this server reads {first} to {last}", report.schema));
    }
    let [grade] = report.grades.as_slice() else {
        return Err(format!("grade.json holds {} grades instead of one", report.grades.len()));
    };
    if grade.code == crate::task::JUDGE_ERROR {
        return Err("the grade is a judge error".to_owned());
    }
    let scenes = grade.scenes();
    let accepted = scenes.iter().filter(|scene| scene.code == "AC").count();
    let mut summary = format!("{accepted} of {} scenes accepted", scenes.len());
    if let Some(mistake) = grade.likely_mistakes.first() {
        summary = format!("{summary}; {}", mistake.text);
    }
    Ok(Outcome {
        verdict: grade.verdict.clone(),
        code: grade.code.clone(),
        points: grade.points.as_ref().map(ToString::to_string),
        max_points: grade.max_points.as_ref().map(ToString::to_string),
        summary,
        version: report.version,
        wrong: wrong(&scenes),
        seconds: "0".to_owned(),
        ..Outcome::default()
    })
}

/// Whether this many wrong scenes leave a submission nearly right: what it answers there may be worth a second look.
fn is_nearly_right(wrong: usize, scenes: usize) -> bool {
    wrong <= 1 || wrong * 10 <= scenes
}

/// The answers of a submission that is nearly right, where it is not.
fn wrong(scenes: &[&SceneInFile]) -> Vec<WrongScene> {
    let wrong: Vec<&&SceneInFile> = scenes.iter().filter(|scene| scene.code != "AC").collect();
    if !is_nearly_right(wrong.len(), scenes.len()) {
        return Vec::new();
    }
    // Of a program that crashed or was too slow nobody knows what it would have answered.
    let answered = wrong.into_iter().filter(|scene| scene.code == "WA");
    let answer = |scene: &SceneInFile| {
        let explained =
            scene.explanations.iter().map(|known| format!("{} {} {}", known.key, known.reproduced, known.samples));
        let first = format!("{} {} {}", scene.code, scene.right_steps, scene.summary);
        // Facts that hints hide are not told here either: then the steps that are right, and the first that is not,
        // have to do.
        [vec![first], scene.details.clone(), explained.collect()].concat().join("\n")
    };
    answered
        .map(|scene| WrongScene {
            scene: scene.scene.clone(),
            answer: Digest::of(answer(scene).as_bytes()).to_string(),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grade_file::MistakeInFile;
    use serde_json::Value;

    /// A grader of another schema would make every grading a judge error.
    #[test]
    fn grades_are_read_as_the_grader_writes_them() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../schemas/grade.schema.json");
        let schema: Value = serde_json::from_slice(&std::fs::read(file).expect("the schema")).expect("JSON");
        assert_eq!(schema["properties"]["schema"]["const"], *SCHEMAS.end());
        let text = schema.to_string();
        for name in ["right_steps", "summary", "scene"] {
            assert!(text.contains(&format!("\"{name}\"")), "the schema has no {name}");
        }
    }

    /// As `schemas/grade.schema.json` has it: a list of explanations, whose sentence is their text. One wrong scene is
    /// enough.
    #[test]
    fn the_likely_mistake_is_told_in_its_sentence() {
        let grade = r#"{"schema": 4, "version": "1", "grades": [{"verdict": "wrong answer", "code": "WA", "points": 0,
            "max_points": 1, "likely_mistake": null, "likely_mistakes": [
            {"key": "k", "text": "The impulse lacks a factor."}, {"key": "l", "text": "Another."}],
            "groups": [{"points": 0, "max_points": 1, "scenes": [{"scene": "a", "code": "WA"}]}]}]}"#;
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("grade.json");
        std::fs::write(&file, grade).expect("a file");
        let graded = read_grade(&file).expect("a grade");
        assert_eq!(graded.summary, "0 of 1 scenes accepted; The impulse lacks a factor.");
    }

    #[test]
    fn answers_are_told_of_submissions_that_are_nearly_right() {
        let scene = |code: &str, right_steps| SceneInFile {
            scene: "a".to_owned(),
            code: code.to_owned(),
            summary: "at step 3".to_owned(),
            right_steps,
            details: vec!["counts: wrong coefficient (11)".to_owned()],
            ..SceneInFile::default()
        };
        let (right, one, same, other, slow) =
            (scene("AC", 9), scene("WA", 2), scene("WA", 2), scene("WA", 3), scene("TLE", 2));
        assert_eq!(wrong(&[&right, &right]), []);
        let answer = |scenes: &[&SceneInFile]| wrong(scenes).first().map(|wrong| wrong.answer.clone());
        assert_eq!(answer(&[&right, &one]), answer(&[&right, &same]));
        assert_ne!(answer(&[&right, &one]), answer(&[&right, &other]));
        // As far right, and wrong in another way.
        let other_way = SceneInFile { details: vec!["counts: wrong coefficient (12)".to_owned()], ..scene("WA", 2) };
        let explanation = MistakeInFile { key: "a-mistake".to_owned(), reproduced: 6, samples: 6 };
        let explained = SceneInFile { explanations: vec![explanation], ..scene("WA", 2) };
        assert_ne!(answer(&[&right, &one]), answer(&[&right, &other_way]));
        assert_ne!(answer(&[&right, &one]), answer(&[&right, &explained]));
        assert_eq!(answer(&[&right, &slow]), None);
        assert_eq!(wrong(&[&one, &other, &right]), [], "two of three are not nearly right");
        assert_eq!(wrong(&[&[&one, &other], &[&right; 18][..]].concat()).len(), 2, "two of twenty are");
    }
}
