//! The page that compares two submissions to an assignment, by the scenes in which they differ.
use super::{
    super::input::{QueryInput, UrlPathParts},
    Page, PageFrame, grades, render, text,
};
use crate::{
    domain::{FailedScenes, Staff, Submission},
    problem::Problem,
};
use askama::Template;
use serde::Deserialize;
use std::collections::BTreeSet;
use url::form_urlencoded::byte_serialize;

/// The submission to compare with: a login means this student's last graded submission, and a number means the same
/// student's submission of this number.
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
    submissions: [Submission; 2],
    scenes: Vec<DifferingScene>,
}

/// A scene for which two results differ: the codes of both verdicts, and the scene's name.
type DifferingScene = ([String; 2], String);

/// Returns the fragment of a URL that leads to a scene in a report.
fn scene_place(scene: &str) -> String {
    byte_serialize(scene.as_bytes()).collect()
}

/// Returns the scenes for which two results have different verdicts. Equal pairs of verdicts are next to each other.
fn find_differing(one: &FailedScenes, other: &FailedScenes) -> Vec<DifferingScene> {
    let names: BTreeSet<&String> = one.keys().chain(other.keys()).collect();
    let code = |failed: &FailedScenes, scene: &String| failed.get(scene).map_or("AC", String::as_str).to_owned();
    let pairs = names.into_iter().map(|scene| ([code(one, scene), code(other, scene)], scene.clone()));
    let mut scenes: Vec<DifferingScene> = pairs.filter(|(codes, _)| codes[0] != codes[1]).collect();
    scenes.sort();
    scenes
}

pub(super) async fn show_page(
    staff: Staff,
    UrlPathParts { course: slug, id, .. }: UrlPathParts,
    QueryInput(query): QueryInput<OtherSubmission>,
) -> Page {
    let first = staff.submission(id).await?;
    let assignment = staff.assignment(&first.assignment).await?;
    let number: Option<i64> = query.with.trim().parse().ok();
    let login = if number.is_some() { &first.login } else { query.with.trim() };
    let mut history = staff.student_history(&assignment.slug, login).await?.submissions.into_iter();
    let other = history.find(|attempt| attempt.grade.is_some() && number.is_none_or(|number| attempt.number == number));
    let missing = || Problem::not_found("graded submission");
    let other = other.ok_or_else(missing)?;
    let find_result = |submission: &Submission| submission.grade.as_ref().map(|grade| grade.result).ok_or_else(missing);
    let results = [find_result(&first)?, find_result(&other)?];
    let stored_results = staff.stored_results(&results).await?;
    let [Some(result), Some(other_result)] = results.map(|number| stored_results.get(&number)) else {
        return Err(missing());
    };
    let scenes = find_differing(&result.failed, &other_result.failed);
    let address = format!("/c/{slug}/s/{id}/beside");
    let frame = grades::class_frame(&staff, &assignment).with_parent(address, "Side by side");
    render(&ComparisonPage { frame, slug, submissions: [first, other], scenes })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_that_both_judge_alike_are_left_out() {
        let list = |scenes: &[(&str, &str)]| -> FailedScenes {
            scenes.iter().map(|(scene, code)| ((*scene).to_owned(), (*code).to_owned())).collect()
        };
        let (one, other) = (
            list(&[("a", "WA"), ("b", "WA"), ("c", "TLE"), ("e", "WA")]),
            list(&[("b", "WA"), ("c", "WA"), ("d", "WA")]),
        );
        let scenes = find_differing(&one, &other);
        let descriptions: Vec<String> =
            scenes.iter().map(|(codes, scene)| format!("{}: {scene}", codes.join(" "))).collect();
        assert_eq!(descriptions, ["AC WA: d", "TLE WA: c", "WA AC: a", "WA AC: e"]);
    }
}
