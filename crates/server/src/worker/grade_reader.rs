//! Reads the parts of a grader's result that the service uses. The other parts are only displayed.
use crate::{
    grade_file::{GradeFile, SceneInFile},
    task::Outcome,
};
use std::{fs, path::Path};

/// The versions of the schema of `grade.json` that are supported. During an upgrade, a grader may be older than the
/// server. The parts that are read here are the same in all supported versions.
const SUPPORTED_SCHEMAS: std::ops::RangeInclusive<u32> = 3..=4;

/// Reads a `grade.json`. Numbers are kept as the text that the grader wrote.
pub(super) fn read_grade(file: &Path) -> Result<Outcome, String> {
    let bytes = fs::read(file).map_err(|error| format!("the grader wrote no grade.json: {error}"))?;
    let damaged = |error: serde_json::Error| format!("grade.json can't be read: {error}");
    let report: GradeFile = serde_json::from_slice(&bytes).map_err(damaged)?;
    if !SUPPORTED_SCHEMAS.contains(&report.schema) {
        let (first, last) = SUPPORTED_SCHEMAS.into_inner();
        return Err(format!("grade.json has schema {}, this server reads {first} to {last}", report.schema));
    }
    let [grade] = report.grades.as_slice() else {
        return Err(format!("grade.json contains {} grades instead of one", report.grades.len()));
    };
    if grade.code == crate::task::JUDGE_ERROR {
        return Err("the grade is a judge error".to_owned());
    }
    let scenes = grade.scenes();
    let accepted_count = scenes.iter().filter(|scene| scene.code == "AC").count();
    let mut summary = format!("{accepted_count} of {} scenes accepted", scenes.len());
    let likely = || grade.likely_mistakes.first().map(|mistake| &mistake.text);
    // No mistake is reported for a program that crashed or was stopped. The summary of the first scene with the grade's
    // verdict then describes how the program ended.
    let has_ended = |scene: &&&SceneInFile| scene.code == grade.code && !["AC", "WA"].contains(&scene.code.as_str());
    let ending = || scenes.iter().find(has_ended).map(|scene| &scene.summary).filter(|summary| !summary.is_empty());
    if let Some(reason) = grade.unfit.as_ref().or_else(likely).or_else(ending) {
        summary = format!("{summary}; {reason}");
    }
    Ok(Outcome {
        verdict: grade.verdict.clone(),
        code: grade.code.clone(),
        points: grade.points.as_ref().map(ToString::to_string),
        max_points: grade.max_points.as_ref().map(ToString::to_string),
        summary,
        version: report.version,
        seconds: "0".to_owned(),
        ..Outcome::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    /// A grader of another schema would make every grading a judge error.
    #[test]
    fn grades_are_read_as_the_grader_writes_them() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../schemas/grade.schema.json");
        let schema: Value = serde_json::from_slice(&std::fs::read(file).expect("the schema")).expect("JSON");
        assert_eq!(schema["properties"]["schema"]["const"], *SUPPORTED_SCHEMAS.end());
        let text = schema.to_string();
        for name in ["code", "verdict", "scene"] {
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
        // A fault of the submission itself explains everything.
        std::fs::write(&file, grade.replace("\"points\": 0,", "\"points\": 0, \"unfit\": \"no program\","))
            .expect("a file");
        assert_eq!(read_grade(&file).expect("a grade").summary, "0 of 1 scenes accepted; no program");
    }
}
