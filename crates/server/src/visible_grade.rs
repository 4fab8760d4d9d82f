//! The part of a grade that students see while the suite's hidden groups are withheld. To students, the grade looks as
//! if these groups did not exist.
use crate::{
    grade_file::{GradeFile, GradeInFile, GroupInFile, SceneInFile},
    store::{Store, StoreError},
    task::{Outcome, OutputFile},
};
use futures_util::StreamExt;
use serde::{Deserialize, Serialize};
use serde_json::Number;
use std::io;
use tokio_util::io::{StreamReader, SyncIoBridge};

/// The verdicts from best to worst. Each has a code, a text, and a letter for tables that show all scenes in a row. A
/// submission's verdict is the worst of its scenes' verdicts.
const VERDICT_TEXTS: [(&str, &str, char); 14] = [
    ("AC", "accepted", 'r'),
    ("--", "not run", 'n'),
    ("NW", "nothing written", 'w'),
    ("WA", "wrong answer", 'w'),
    ("BT", "bad trace", 'e'),
    ("NO", "no output", 'e'),
    ("OLE", "output limit", 'e'),
    ("MLE", "memory limit", 'e'),
    ("TLE", "time limit", 'e'),
    ("RTE", "run-time error", 'e'),
    ("US", "unusable submission", 'n'),
    ("CE", "compile error", 'n'),
    ("SV", "sandbox violation", 'e'),
    ("JE", "judge error", 'e'),
];

/// Returns the text for a verdict's code. A grader of another version may report codes that are unknown here.
pub fn verdict(code: &str) -> &str {
    let found = VERDICT_TEXTS.iter().find(|verdict| verdict.0 == code);
    found.map_or(if code == "NR" { "not shown yet" } else { code }, |verdict| verdict.1)
}

/// A grade without the withheld groups.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct VisibleGrade {
    verdict: String,
    pub(crate) code: String,
    pub(crate) points: Option<String>,
    pub(crate) max_points: Option<String>,
    summary: String,
}

/// The texts about an outcome's scenes that the database stores.
#[derive(Debug, Default)]
pub struct StoredTexts {
    /// The [`VisibleGrade`] while groups are withheld; empty if the suite hides no groups.
    pub shown: String,
    /// The scenes that are not accepted, one per line after the verdict's code; `None` if they are unknown.
    pub failed: Option<String>,
    /// The grade's [`GradeParts`]; `None` if they are unknown.
    pub parts: Option<String>,
}

/// The parts of a grade that have their own columns in tables of a class.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct GradeParts {
    /// The name and the points of each group. The points are `None` if the grader failed.
    pub groups: Vec<(String, Option<f64>)>,
    /// The likely mistakes, as sentences.
    pub mistakes: Vec<String>,
    /// One letter per scene, with `|` between groups; empty for results that an older version stored.
    #[serde(default)]
    pub scenes: String,
}

/// Reads the texts about an outcome's scenes from its `grade.json`.
///
/// # Errors
/// Fails if the stored report cannot be read.
pub async fn read_texts(store: &Store, files: &[OutputFile]) -> Result<StoredTexts, StoreError> {
    let Some(file) = files.iter().find(|file| file.name == "grade.json") else { return Ok(StoredTexts::default()) };
    let opened = store.open(&file.artifact.digest).await?;
    let pieces = StreamReader::new(opened.pieces.map(|piece| piece.map_err(io::Error::other)));
    let reading = move || read(SyncIoBridge::new(Box::pin(pieces)));
    let report = tokio::task::spawn_blocking(reading).await.unwrap_or_default();
    let visible = report.as_ref().map_or_else(|| Some(empty_grade()), visible_grade);
    Ok(StoredTexts {
        shown: visible.as_ref().map(to_text).unwrap_or_default(),
        failed: report.as_ref().map(list_failed),
        parts: report.as_ref().map(list_parts),
    })
}

/// Parses a `grade.json`; `None` if it is invalid.
fn read(grade: impl io::Read) -> Option<GradeFile> {
    serde_json::from_reader(io::BufReader::new(grade)).ok()
}

/// Lists the scenes that are not accepted, including those in hidden groups, as text for the database.
fn list_failed(report: &GradeFile) -> String {
    let scenes = report.grades.iter().flat_map(GradeInFile::scenes).filter(|scene| scene.code != "AC");
    // A line break in a name is replaced, because it would be read as the end of the line.
    scenes.map(|scene| format!("{} {}\n", scene.code, scene.scene.replace('\n', " "))).collect()
}

/// Returns the parts of a grade as text for the database. Hidden groups are included.
fn list_parts(report: &GradeFile) -> String {
    let groups = report.grades.iter().flat_map(|grade| &grade.groups);
    let mistakes = report.grades.iter().flat_map(|grade| &grade.likely_mistakes);
    let find_text = |scene: &SceneInFile| VERDICT_TEXTS.iter().find(|verdict| scene.code == verdict.0);
    let letter = |scene: &SceneInFile| find_text(scene).map_or('e', |verdict| verdict.2);
    let rows = groups.clone().map(|group| group.scenes.iter().map(letter).collect::<String>());
    let parts = GradeParts {
        groups: groups.map(|group| (group.name.clone(), group.points)).collect(),
        mistakes: mistakes.map(|mistake| mistake.text.clone()).collect(),
        scenes: rows.collect::<Vec<_>>().join("|"),
    };
    serde_json::to_string(&parts).unwrap_or_default()
}

fn to_text(grade: &VisibleGrade) -> String {
    serde_json::to_string(grade).unwrap_or_default()
}

/// Returns the grade that students see if all groups are withheld.
fn empty_grade() -> VisibleGrade {
    VisibleGrade {
        verdict: "graded".to_owned(),
        code: "NR".to_owned(),
        points: None,
        max_points: None,
        summary: "the grade is not shown yet".to_owned(),
    }
}

/// Returns the part of a `grade.json` that students see without hidden groups; `None` if the suite hides no groups.
fn visible_grade(report: &GradeFile) -> Option<VisibleGrade> {
    let groups: Vec<&GroupInFile> = report.grades.iter().flat_map(|grade| &grade.groups).collect();
    let is_visible =
        |group: &&&GroupInFile| group.visibility.as_deref().is_none_or(|visibility| visibility == "visible");
    let visible: Vec<&GroupInFile> = groups.iter().filter(is_visible).copied().collect();
    if visible.len() == groups.len() {
        return None;
    }
    let scenes: Vec<&SceneInFile> = visible.iter().flat_map(|group| &group.scenes).collect();
    // A code of a newer grader that is unknown here counts as worse than all known ones.
    let rank = |scene: &&SceneInFile| {
        VERDICT_TEXTS.iter().position(|verdict| scene.code == verdict.0).unwrap_or(VERDICT_TEXTS.len())
    };
    let counted = visible.iter().filter(|group| !group.extra).flat_map(|group| &group.scenes);
    let Some(worst) = counted.max_by_key(rank).or_else(|| scenes.first().copied()) else { return Some(empty_grade()) };
    let sum = |of: fn(&GroupInFile) -> Option<f64>| {
        let numbers: Option<Vec<f64>> = visible.iter().filter(|group| !group.extra).map(|group| of(group)).collect();
        numbers.and_then(|numbers| Number::from_f64(numbers.iter().sum())).map(|sum| sum.to_string())
    };
    let accepted_count = scenes.iter().filter(|scene| scene.code == "AC").count();
    Some(VisibleGrade {
        verdict: worst.verdict.clone(),
        // The code "--" means that no group was run; shown codes consist of letters.
        code: if worst.code == "--" { "NR".to_owned() } else { worst.code.clone() },
        points: sum(|group| group.points),
        max_points: sum(|group| group.max_points),
        summary: format!("{accepted_count} of {} scenes accepted; the other groups are not shown yet", scenes.len()),
    })
}

impl VisibleGrade {
    /// Reads the shown grade from a text of the database; `None` if nothing is withheld.
    pub fn from_text(text: &str) -> Option<Self> {
        match text {
            "" => None,
            text => Some(serde_json::from_str(text).unwrap_or_else(|_| empty_grade())),
        }
    }

    /// Reduces an outcome to the part that students see. Digests, sizes and exact times are also removed, because they
    /// would reveal changes in the withheld parts.
    pub fn limit_to_students(self, outcome: &mut Outcome, page: &str) {
        (outcome.verdict, outcome.code, outcome.summary) = (self.verdict, self.code, self.summary);
        (outcome.points, outcome.max_points) = (self.points, self.max_points);
        outcome.seconds = String::new();
        outcome.files.retain(|file| file.name == page);
    }
}

/// Returns a time rounded down to the hour. The exact time of a grade would reveal how long hidden groups took.
pub fn round_to_hour(milliseconds: i64) -> i64 {
    milliseconds - milliseconds.rem_euclid(3_600_000)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(groups: &str) -> Option<VisibleGrade> {
        visible_grade(&file(groups))
    }

    fn file(groups: &str) -> GradeFile {
        let grade = format!(r#"{{"verdict": "x", "code": "RTE", "points": 45, "groups": [{groups}]}}"#);
        read(format!(r#"{{"schema": 4, "version": "1.0", "grades": [{grade}]}}"#).as_bytes()).expect("a file")
    }

    #[test]
    fn codes_are_those_of_the_schema_in_the_order_of_severity() {
        let schema: serde_json::Value =
            serde_json::from_str(include_str!("../../../schemas/grade.schema.json")).expect("JSON");
        let known = |words: [&str; 14], of: &str| {
            assert_eq!(schema["$defs"]["SceneView"]["properties"][of]["enum"], serde_json::json!(words));
        };
        known(VERDICT_TEXTS.map(|verdict| verdict.0), "code");
        known(VERDICT_TEXTS.map(|verdict| verdict.1), "verdict");
        assert_eq!([verdict("RTE"), verdict("XX")], ["run-time error", "XX"]);
    }

    #[test]
    fn an_unknown_code_is_not_better_than_a_known_one() {
        let group = |scenes: &str| format!(r#"{{"visibility": "visible", "scenes": [{scenes}]}}"#);
        let scene = |code: &str| format!(r#"{{"scene": "{code}", "code": "{code}", "verdict": "v"}}"#);
        let hidden = r#"{"visibility": "hidden", "scenes": []}"#;
        let groups = format!("{}, {hidden}", group(&[scene("XX"), scene("AC")].join(", ")));
        assert_eq!(shown(&groups).expect("something is hidden").code, "XX");
    }

    #[test]
    fn what_is_hidden_changes_nothing_of_what_is_shown() {
        let seen = r#"{"visibility": "visible", "points": 7.5, "max_points": 10, "scenes": [
            {"scene": "a", "code": "AC", "verdict": "accepted"},
            {"scene": "b", "code": "WA", "verdict": "wrong answer"}]}"#;
        let hidden = |code: &str, points: u32| {
            format!(
                r#"{{"visibility": "after_published", "points": {points}, "max_points": 90,
                    "scenes": [{{"scene": "secret", "code": "{code}", "verdict": "x"}}]}}"#
            )
        };
        assert_eq!(shown(seen), None);
        let one = shown(&format!("{seen}, {}", hidden("RTE", 0))).expect("something is hidden");
        assert_eq!(Some(&one), shown(&format!("{}, {seen}", hidden("AC", 90))).as_ref());
        assert_eq!((one.code.as_str(), one.verdict.as_str()), ("WA", "wrong answer"));
        assert_eq!((one.points.as_deref(), one.max_points.as_deref()), (Some("7.5"), Some("10.0")));
        assert!(one.summary.starts_with("1 of 2 scenes accepted"), "{}", one.summary);
        assert_eq!(VisibleGrade::from_text(&to_text(&one)), Some(one));
        assert_eq!(shown(&hidden("AC", 90)), Some(empty_grade()));
        assert!(read(&b"{"[..]).is_none(), "what can't be read is not shown");
        let both = file(&format!("{seen}, {}", hidden("RTE", 0)));
        assert_eq!(list_failed(&both), "WA b\nRTE secret\n", "staff see hidden scenes, too");
        assert_eq!(list_parts(&both), r#"{"groups":[["",7.5],["",0.0]],"mistakes":[],"scenes":"rw|e"}"#);
    }
}
