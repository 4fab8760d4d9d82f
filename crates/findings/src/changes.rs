//! The changes of a submission since an earlier grading.
use super::{
    earlier_grade::{EarlierGrade, EarlierGroup, EarlierScene},
    grade::{Grade, SceneGrade},
    verdict::Verdict,
};
use std::collections::BTreeMap;

impl From<&Grade> for EarlierGrade {
    fn from(grade: &Grade) -> Self {
        let scene =
            |scene: &SceneGrade| EarlierScene { scene: scene.scene.clone(), code: scene.verdict.code().to_owned() };
        let groups = grade.groups.iter().map(|group| EarlierGroup {
            name: group.name.clone(),
            points: group.points,
            max_points: group.max_points,
            extra: group.extra,
            scenes: group.scenes.iter().map(scene).collect(),
        });
        Self { submission: grade.submission.clone(), groups: groups.collect() }
    }
}

/// The changes of a submission since an earlier grading. Only groups of its present grade are compared.
#[derive(Debug, Clone, PartialEq)]
pub struct GradeChanges<'a> {
    /// The points of the compared groups in the earlier grading, without extra points; `None` if that grading gave no
    /// points.
    pub earlier_points: Option<f64>,
    /// The points that the compared groups are worth.
    pub compared_points: f64,
    /// The scenes that were not accepted before and are now.
    pub newly_right: Vec<&'a SceneGrade>,
    /// The scenes that were accepted before and are not now.
    pub newly_wrong: Vec<&'a SceneGrade>,
    /// The scenes that were not accepted before and are not now, but have another verdict, each with its earlier
    /// verdict.
    pub other_changes: Vec<(&'a SceneGrade, Verdict)>,
}

impl Grade {
    /// Returns the changes since the earlier grading, if there is one. A scene that was not run in one of the gradings
    /// counts as unchanged. Groups that are left out of this grade are not compared.
    pub fn changes(&self) -> Option<GradeChanges<'_>> {
        let before = self.earlier_grade.as_ref()?;
        let is_here = |group: &&EarlierGroup| self.groups.iter().any(|own| own.name == group.name);
        let groups: Vec<&EarlierGroup> = before.groups.iter().filter(is_here).collect();
        let regular_groups = || groups.iter().filter(|group| !group.extra);
        let scenes = groups.iter().flat_map(|group| &group.scenes);
        let verdicts: BTreeMap<&str, &str> = scenes.map(|scene| (&*scene.scene, &*scene.code)).collect();
        let mut changes = GradeChanges {
            earlier_points: regular_groups().map(|group| group.points).sum(),
            compared_points: regular_groups().map(|group| group.max_points).sum(),
            newly_right: Vec::new(),
            newly_wrong: Vec::new(),
            other_changes: Vec::new(),
        };
        for scene in self.scenes().filter(|scene| scene.verdict != Verdict::NotRun) {
            let then = verdicts.get(&*scene.scene).and_then(|code| Verdict::from_code(code));
            match then.filter(|then| ![Verdict::NotRun, scene.verdict].contains(then)) {
                None => {}
                Some(_) if scene.verdict.is_accepted() => changes.newly_right.push(scene),
                Some(Verdict::Accepted) => changes.newly_wrong.push(scene),
                Some(then) => changes.other_changes.push((scene, then)),
            }
        }
        Some(changes)
    }
}
