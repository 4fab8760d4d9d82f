//! The suite of a course, which is part of the page.
use fosssim_grading::{
    SceneTask,
    config::Visibility,
    library,
    plan::{self, Plan, PlannedGroup},
};
use fosssim_report::page::Audience;
use serde_json::{Value, json};
use std::fmt::Write;

/// A suite and its own scenes, as if they had been dropped.
#[derive(Debug)]
pub struct CourseSuite(Value);

impl CourseSuite {
    /// Returns the groups of a plan that the page's readers may see. Nothing about the other groups is included.
    ///
    /// # Errors
    /// Fails if there is no visible group, or if a name cannot be written into a suite.
    pub fn from_plan(plan: &Plan, reader: Audience) -> Result<Self, String> {
        let is_shown = |visibility| reader == Audience::Staff || visibility == Visibility::Visible;
        let groups: Vec<&PlannedGroup> =
            plan.groups.iter().filter(|group| is_shown(group.marking.visibility)).collect();
        if groups.is_empty() {
            return Err("the suite hides all its groups from readers of the page".to_owned());
        }
        let scenes = || groups.iter().flat_map(|group| &group.scenes);
        let own_scenes: Vec<&SceneTask> = scenes().filter(|task| !is_embedded(task)).collect();
        let text = suite_text(plan, &groups);
        let read = plan::load_with(&text, &mut |pattern| {
            let found = own_scenes.iter().filter(|task| pattern == glob::Pattern::escape(&file_name(task)));
            Ok(found.map(|task| (task.name.clone(), task.xml.clone())).collect())
        });
        let names = |plan: &Plan| plan.scenes().map(|task| task.name.clone()).collect::<Vec<_>>();
        let names_in_plan: Vec<String> = scenes().map(|task| task.name.clone()).collect();
        if read.is_err() || read.is_ok_and(|plan| names(&plan) != names_in_plan) {
            return Err("the name of a group or scene can't be written into a suite".to_owned());
        }
        let scene = |task: &&SceneTask| -> Result<Value, String> {
            let xml = std::str::from_utf8(&task.xml).map_err(|_| format!("the scene {} is not UTF-8", task.name))?;
            Ok(json!({ "name": file_name(task), "xml": xml }))
        };
        let scenes = own_scenes.iter().map(scene).collect::<Result<Vec<_>, _>>()?;
        let is_for_students = reader == Audience::Student;
        Ok(Self(json!({ "name": plan.name, "suite": text, "scenes": scenes, "isForStudents": is_for_students })))
    }

    /// Returns the course as JSON for a data block of a page. It is escaped, so that it cannot end the block.
    pub(crate) fn to_json(&self) -> String {
        self.0.to_string().replace('<', "\\u003c")
    }
}

/// Returns whether every page contains the scene anyway.
fn is_embedded(task: &SceneTask) -> bool {
    library::find_scene(&task.name).is_some_and(|xml| xml == task.xml)
}

/// Returns the file name of a scene, as the suite names it.
fn file_name(task: &SceneTask) -> String {
    format!("{}.xml", task.name)
}

/// Returns the text of the suite, without the settings that only grading needs.
fn suite_text(plan: &Plan, groups: &[&PlannedGroup]) -> String {
    // A JSON string is also a TOML string.
    let string = |text: &str| Value::from(text).to_string();
    let milestone = plan.milestone.map(|milestone| format!("milestone = \"{}\"\n", milestone.key()));
    let milestone = milestone.unwrap_or_default();
    let mut out = format!(
        "schema = 1\nname = {}\n{milestone}rules = {}\n\n[limits]\ntrace_mib = {}\n",
        string(&plan.name),
        json!(plan.rules),
        (plan.limits.trace >> 20).max(1)
    );
    for group in groups {
        let scenes: Vec<String> = group
            .scenes
            .iter()
            .map(|task| match is_embedded(task) {
                true => string(&format!("asset:{}", task.name)),
                false => string(&glob::Pattern::escape(&file_name(task))),
            })
            .collect();
        let _ = write!(
            out,
            "\n[[group]]\nname = {}\nscenes = [{}]\npoints = {}\nextra = {}\ncredit = {}\nhints = \"{}\"\n",
            string(&group.name),
            scenes.join(", "),
            group.marking.points,
            group.marking.is_extra,
            json!(group.marking.credit),
            group.marking.hints.describe().0
        );
    }
    out
}
