//! Two submissions to an assignment side by side: the scenes in which they differ.
use super::{
    super::input::{AddressParts, QueryInput},
    Page, PageFrame, grades, show, text,
};
use crate::{
    domain::{FailedScenes, Staff, Submission},
    problem::Problem,
};
use askama::Template;
use serde::Deserialize;
use std::collections::BTreeSet;
use url::form_urlencoded::byte_serialize;

/// The other submission: its number on this server, or the login of a student, whose last submission is meant.
#[derive(Deserialize)]
pub(super) struct OtherSubmission {
    #[serde(default)]
    with: String,
}

#[derive(Template)]
#[template(path = "beside.html")]
struct ComparisonPage {
    frame: PageFrame,
    slug: String,
    both: [Submission; 2],
    scenes: Vec<DifferingScene>,
}

/// A scene on which they differ.
struct DifferingScene {
    scene: String,
    /// Both verdicts in short.
    codes: [String; 2],
}

impl DifferingScene {
    /// Returns the part of an address that leads to the scene in a report.
    fn place(&self) -> String {
        byte_serialize(self.scene.as_bytes()).collect()
    }
}

/// Returns the scenes that two results judge differently.
fn differing(one: &FailedScenes, other: &FailedScenes) -> Vec<DifferingScene> {
    let names: BTreeSet<&String> = one.keys().chain(other.keys()).collect();
    let code = |of: &FailedScenes, scene: &String| of.get(scene).map_or("AC", String::as_str).to_owned();
    let rows = names
        .into_iter()
        .map(|scene| DifferingScene { scene: scene.clone(), codes: [code(one, scene), code(other, scene)] });
    rows.filter(|row| row.codes[0] != row.codes[1]).collect()
}

pub(super) async fn page(
    staff: Staff,
    AddressParts { course: slug, id, .. }: AddressParts,
    QueryInput(asked): QueryInput<OtherSubmission>,
) -> Page {
    let one = staff.submission(id).await?;
    let assignment = staff.assignment(&one.assignment).await?;
    let other = match asked.with.trim().parse() {
        Ok(number) => Some(staff.submission(number).await?),
        Err(_) => staff.student_history(&assignment.slug, asked.with.trim()).await?.submissions.into_iter().next(),
    };
    let missing = || Problem::not_found("graded submission of this student");
    let other = other.ok_or_else(missing)?;
    let result = |of: &Submission| of.grade.as_ref().map(|grade| grade.result).ok_or_else(missing);
    let results = [result(&one)?, result(&other)?];
    let kept = staff.kept_results(&results).await?;
    let [Some(first), Some(second)] = results.map(|result| kept.get(&result)) else { return Err(missing()) };
    let scenes = differing(&first.failed, &second.failed);
    let address = format!("/c/{slug}/s/{id}/beside");
    let frame = grades::frame(&staff, &assignment).then(address, "Side by side");
    show(&ComparisonPage { frame, slug, both: [one, other], scenes })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_that_both_judge_alike_are_left_out() {
        let of = |scenes: &[(&str, &str)]| -> FailedScenes {
            scenes.iter().map(|(scene, code)| ((*scene).to_owned(), (*code).to_owned())).collect()
        };
        let rows =
            differing(&of(&[("a", "WA"), ("b", "WA"), ("c", "TLE")]), &of(&[("b", "WA"), ("c", "WA"), ("d", "WA")]));
        let told: Vec<String> = rows.iter().map(|row| format!("{} {}", row.scene, row.codes.join(" "))).collect();
        assert_eq!(told, ["a WA AC", "c TLE WA", "d AC WA"]);
    }
}
