//! The changes between two gradings of the same submissions: what became right and what became wrong.
use super::some;
use crate::{
    number::counted,
    style::{Look, Style},
};
use fosssim_findings::{Grade, SceneGrade, Verdict};
use std::collections::BTreeMap;

/// The greatest number of scenes that are named.
const NAMED: usize = 5;

/// Returns the lines about what changed since `before`; scenes that were not run, now or then, say nothing.
#[must_use]
pub fn changes(before: &[Grade], after: &[Grade], style: Style) -> String {
    let verdicts: BTreeMap<(&str, &str), Verdict> = run(before).map(|(key, scene)| (key, scene.verdict)).collect();
    let (mut right, mut wrong, mut other, mut same) = (Vec::new(), Vec::new(), Vec::new(), 0);
    for ((submission, name), scene) in run(after) {
        let shown = if after.len() > 1 { format!("{submission} {name}") } else { name.to_owned() };
        match (verdicts.get(&(submission, name)).copied(), scene.verdict) {
            (None, _) => {}
            (Some(then), now) if then == now => same += 1,
            (Some(_), Verdict::Accepted) => right.push(shown),
            (Some(Verdict::Accepted), now) => wrong.push(format!("{shown} ({})", now.code())),
            (Some(then), now) => other.push(format!("{shown} ({}, was {})", now.code(), then.code())),
        }
    }
    let mut text = String::new();
    for (look, word, names) in
        [(Look::Good, "became right", &right), (Look::Bad, "became wrong", &wrong), (Look::Notice, "changed", &other)]
    {
        if !names.is_empty() {
            let count = style.paint(look, &format!("{} {word}", counted(names.len() as u64, "scene")));
            text += &format!("{count} since the last run: {}\n", some(names, NAMED));
        }
    }
    if text.is_empty() && same > 0 {
        text = "no scene changed since the last run\n".to_owned();
    }
    text
}

/// Returns the scenes that were run.
fn run(grades: &[Grade]) -> impl Iterator<Item = ((&str, &str), &SceneGrade)> {
    let scenes = grades.iter().flat_map(|grade| grade.scenes().map(|scene| (grade.submission.as_str(), scene)));
    let ran = scenes.filter(|(_, scene)| scene.verdict != Verdict::NotRun);
    ran.map(|(submission, scene)| ((submission, scene.scene.as_str()), scene))
}
