//! What students see of a grade while groups that its suite hides are withheld: as if there were no such groups.
use crate::{
    store::{Store, StoreError},
    task::{Outcome, OutputFile},
};
use futures_util::StreamExt;
use serde::{Deserialize, Serialize};
use serde_json::Number;
use std::io;
use tokio_util::io::{StreamReader, SyncIoBridge};

/// Verdicts in short, from the best to the worst: the worst of the scenes is the grade's.
const CODES: [&str; 14] = ["AC", "--", "NW", "WA", "BT", "NO", "OLE", "MLE", "TLE", "RTE", "US", "CE", "SV", "JE"];

/// A grade without the groups that are withheld.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shown {
    verdict: String,
    code: String,
    points: Option<String>,
    max_points: Option<String>,
    summary: String,
    /// Scenes that are not accepted, by their names.
    wrong: Vec<String>,
}

/// What the database keeps about an outcome: empty where its suite hides nothing.
///
/// # Errors
/// When the store fails.
pub async fn of_outcome(store: &Store, files: &[OutputFile]) -> Result<String, StoreError> {
    let Some(file) = files.iter().find(|file| file.name == "grade.json") else { return Ok(String::new()) };
    let opened = store.open(&file.artefact.digest, None).await?;
    let pieces = StreamReader::new(opened.pieces.map(|piece| piece.map_err(io::Error::other)));
    let reading = move || of_grade(SyncIoBridge::new(Box::pin(pieces)));
    let shown = tokio::task::spawn_blocking(reading).await.unwrap_or_else(|_| Some(nothing()));
    Ok(shown.as_ref().map(text).unwrap_or_default())
}

fn text(shown: &Shown) -> String {
    serde_json::to_string(shown).unwrap_or_default()
}

/// A grade of which nothing is shown.
fn nothing() -> Shown {
    Shown {
        verdict: "graded".to_owned(),
        code: "NR".to_owned(),
        points: None,
        max_points: None,
        summary: "what counts is not shown yet".to_owned(),
        wrong: Vec::new(),
    }
}

#[derive(Deserialize)]
struct Report {
    #[serde(default)]
    grades: Vec<Grade>,
}

#[derive(Deserialize)]
struct Grade {
    #[serde(default)]
    groups: Vec<Group>,
}

#[derive(Deserialize)]
struct Group {
    visibility: Option<String>,
    points: Option<f64>,
    max_points: Option<f64>,
    #[serde(default)]
    scenes: Vec<Scene>,
}

#[derive(Deserialize)]
struct Scene {
    #[serde(default)]
    scene: String,
    code: String,
    #[serde(default)]
    verdict: String,
}

/// What is left of a `grade.json` without hidden groups; nothing where it hides none, and [`nothing`] where it can't be
/// read. Of what it says besides nothing is kept in memory.
fn of_grade(grade: impl io::Read) -> Option<Shown> {
    let Ok(report) = serde_json::from_reader::<_, Report>(io::BufReader::new(grade)) else { return Some(nothing()) };
    let groups: Vec<&Group> = report.grades.iter().flat_map(|grade| &grade.groups).collect();
    let is_visible = |group: &&&Group| group.visibility.as_deref().is_none_or(|visibility| visibility == "visible");
    let visible: Vec<&Group> = groups.iter().filter(is_visible).copied().collect();
    if visible.len() == groups.len() {
        return None;
    }
    let scenes: Vec<&Scene> = visible.iter().flat_map(|group| &group.scenes).collect();
    let rank = |scene: &&&Scene| CODES.iter().position(|code| scene.code == *code);
    let Some(worst) = scenes.iter().max_by_key(rank) else { return Some(nothing()) };
    let wrong: Vec<String> =
        scenes.iter().filter(|scene| scene.code != "AC").map(|scene| scene.scene.clone()).collect();
    let sum = |of: fn(&Group) -> Option<f64>| {
        let numbers: Option<Vec<f64>> = visible.iter().map(|group| of(group)).collect();
        numbers.and_then(|numbers| Number::from_f64(numbers.iter().sum())).map(|sum| sum.to_string())
    };
    let accepted = scenes.len() - wrong.len();
    Some(Shown {
        verdict: worst.verdict.clone(),
        // A code has letters: of what was not run nothing is known.
        code: if worst.code == "--" { "NR".to_owned() } else { worst.code.clone() },
        points: sum(|group| group.points),
        max_points: sum(|group| group.max_points),
        summary: format!("{accepted} of {} scenes accepted; what else counts is not shown yet", scenes.len()),
        wrong,
    })
}

impl Shown {
    /// What the database keeps; nothing where nothing is withheld.
    pub fn read(text: &str) -> Option<Self> {
        match text {
            "" => None,
            text => Some(serde_json::from_str(text).unwrap_or_else(|_| nothing())),
        }
    }

    /// The points, and of how many.
    pub fn points(self) -> (Option<String>, Option<String>) {
        (self.points, self.max_points)
    }

    /// The verdict in short, and the points.
    pub fn line(self) -> (String, Option<String>) {
        (self.code, self.points)
    }

    /// Whether a scene is among those that are not accepted, and not withheld.
    pub fn tells_of(&self, scene: &str) -> bool {
        self.wrong.iter().any(|wrong| wrong == scene)
    }

    /// Makes an outcome what is shown of it. Digests, sizes and times of what is withheld would tell when it changes.
    pub fn cover(self, outcome: &mut Outcome, page: &str) {
        (outcome.verdict, outcome.code, outcome.summary) = (self.verdict, self.code, self.summary);
        (outcome.points, outcome.max_points) = (self.points, self.max_points);
        outcome.essence = String::new();
        outcome.seconds = "0".to_owned();
        outcome.files.retain(|file| file.name == page);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(groups: &str) -> Option<Shown> {
        of_grade(format!(r#"{{"grades": [{{"code": "RTE", "points": 45, "groups": [{groups}]}}]}}"#).as_bytes())
    }

    #[test]
    fn what_is_hidden_changes_nothing_of_what_is_shown() {
        let seen = r#"{"visibility": "visible", "points": 7.5, "max_points": 10, "scenes": [
            {"scene": "a", "code": "AC", "verdict": "accepted"}, {"scene": "b", "code": "WA", "verdict": "wrong answer"}]}"#;
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
        assert!(one.tells_of("b") && !one.tells_of("secret"));
        assert_eq!(Shown::read(&text(&one)), Some(one));
        assert_eq!(shown(&hidden("AC", 90)), Some(nothing()));
        assert_eq!(of_grade(&b"{"[..]), Some(nothing()), "what can't be read is not shown");
    }
}
