//! The option `grade --traces`, which judges existing traces. Each submission is a folder of traces. No program is run,
//! so no sandbox is needed. The duration of the run and its result are unknown.
use super::{
    earlier_grades,
    grade_ending::{MAX_HARDEST, exit_code, render_text, text_detail},
    pages::{self, Pages},
    results::{Report, Results, find_requested_pages, reject_several},
    submissions::distinct_names,
};
use crate::{
    cli::{arguments::grade::GradeArguments as Arguments, console, input::unpack, selection::Selection},
    files::{FileError, Folder},
    report::{number::format_count, untrusted_text::to_one_line},
    suite::{
        EarlierGrade, Grade, SceneResult, SceneTask, cards::JudgedTrace, catch_panic, plan::Plan, result::Failure,
        traces,
    },
};
use anyhow::{Context, Result, bail};
use rayon::prelude::*;
use std::{
    ffi::OsStr,
    io,
    path::{Path, PathBuf},
};

pub(super) fn run(arguments: &Arguments, plan: Plan, reports: &[Report], earlier: &[EarlierGrade]) -> Result<u8> {
    let names: Vec<&str> = plan.scenes().map(|task| task.name.as_str()).collect();
    let selection = Selection::new(&arguments.scene, &names)?;
    let names: Vec<String> = names.into_iter().map(str::to_owned).collect();
    let plan = plan.filter_scenes(|scene| selection.selects(scene));
    let is_part = plan.scenes().count() < names.len();
    for folder in &arguments.programs {
        if !folder.is_dir() {
            bail!(
                "{} is not a folder: with --traces a submission is a folder of traces, Group/name.bin",
                folder.display()
            );
        }
    }
    reject_several(reports, arguments.programs.len(), "")?;
    let folder = arguments.output.as_deref();
    if let Some(output) = folder {
        Folder::create(output).with_context(|| format!("cannot create the folder {}", output.display()))?;
    }
    let pages = find_requested_pages(arguments, folder, arguments.programs.len() > 1, reports)?;
    let paths: Vec<&Path> = arguments.programs.iter().map(PathBuf::as_path).collect();
    let named = paths.iter().zip(distinct_names(&paths));
    let mut grades: Vec<Grade> = named.map(|(folder, name)| grade(&plan, folder, name, pages.as_ref())).collect();
    earlier_grades::add_earlier_grades(earlier, &mut grades);
    let skipped = earlier_grades::list_missing(earlier, grades.iter().map(|grade| grade.submission.as_str()));
    for folder in &paths {
        if let Some(strays) = Folder::open(folder).ok().and_then(|folder| describe_other_traces(&folder, &names)) {
            console::print_remark(format!("warning: {}\n", to_one_line(&format!("{}: {strays}", folder.display()))));
        }
    }
    let (reader, platform_hides) = (arguments.reader, arguments.platform_hides);
    let (staff_page, published_page) = (arguments.staff_page.as_deref(), arguments.published_page.as_deref());
    let pages = pages.as_ref();
    let results = Results {
        folder,
        pages,
        reader,
        platform_hides,
        staff_page,
        published_page,
        is_part,
        grades: &grades,
        skipped: &skipped,
    };
    results.write(reports, |grades| {
        render_text(grades, &skipped, text_detail(arguments, grades.len() > 1), MAX_HARDEST, None, false)
    })?;
    Ok(exit_code(&grades))
}

/// Grades a folder of traces.
fn grade(plan: &Plan, folder: &Path, submission: String, pages: Option<&Pages>) -> Grade {
    let tasks: Vec<&SceneTask> = plan.scenes().collect();
    // With any number of threads, the results are in the order of the plan.
    let opened = Folder::open(folder);
    let judged_scenes: Vec<JudgedScene> =
        tasks.par_iter().map(|task| judge_scene(plan, task, &opened, pages)).collect();
    let (results, warnings): (Vec<_>, Vec<_>) = judged_scenes.into_iter().unzip();
    traces::grade(plan, submission, results, warnings.into_iter().flatten().collect())
}

/// The maximum number of traces that a warning names.
const MAX_NAMED: usize = 5;

/// Describes the traces in a folder and its subfolders that do not belong to any scene; `None` if there are none.
fn describe_other_traces(folder: &Folder, scenes: &[String]) -> Option<String> {
    let texts = |folder: &Folder| -> Vec<String> {
        let names = folder.list_names().unwrap_or_default();
        names.iter().map(|name| name.to_string_lossy().into_owned()).collect()
    };
    let mut found = texts(folder);
    for group in found.clone() {
        let inner = folder.open_folder(OsStr::new(&group)).iter().flat_map(&texts).collect::<Vec<_>>();
        found.extend(inner.into_iter().map(|name| format!("{group}/{name}")));
    }
    let is_stray = |name: &&String| {
        let trace = [".zst", ".gz"].iter().find_map(|end| name.strip_suffix(end)).unwrap_or(name).strip_suffix(".bin");
        let is_of = |scene: &String, trace: &str| scene == trace || scene.rsplit('/').next() == Some(trace);
        trace.is_some_and(|trace| !scenes.iter().any(|scene| is_of(scene, trace)))
    };
    let mut strays: Vec<&String> = found.iter().filter(is_stray).collect();
    strays.sort_unstable();
    let named: Vec<&str> = strays.iter().take(MAX_NAMED).map(|name| name.as_str()).collect();
    let ellipsis = if strays.len() > MAX_NAMED { ", ..." } else { "" };
    let verb = if strays.len() == 1 { "belongs" } else { "belong" };
    let count = format_count(strays.len() as u64, "trace");
    (!strays.is_empty()).then(|| format!("{count} {verb} to no scene of the suite: {}{ellipsis}", named.join(", ")))
}

/// The result of a scene, and a warning if files were skipped.
type JudgedScene = (SceneResult, Option<String>);

/// Judges the trace of one scene. If this panics, the verdict on the scene is a judge error.
fn judge_scene(plan: &Plan, task: &SceneTask, folder: &io::Result<Folder>, pages: Option<&Pages>) -> JudgedScene {
    let failure = match folder.as_ref().map(|folder| catch_panic(|| judge(plan, task, folder, pages))) {
        Ok(Ok(Ok(judged))) => return judged,
        Ok(Ok(Err(error))) => Failure::Machine(error.to_string()),
        Ok(Err(fault)) => Failure::Panic { stage: None, fault: fault.to_string(), trace: None },
        Err(error) => Failure::Machine(error.to_string()),
    };
    (task.failure_result(failure), None)
}

fn judge(plan: &Plan, task: &SceneTask, folder: &Folder, pages: Option<&Pages>) -> io::Result<JudgedScene> {
    let (trace, warning) = read(folder, &task.name, plan.limits.trace)?;
    let (mut result, examined) = traces::judge_trace(plan, task, &trace[..], &mut ());
    if let Some(pages) = pages
        && !(result.verdict.is_accepted() && result.difference_cause.is_none())
    {
        let judged = JudgedTrace {
            scene: &task.scene,
            name: &task.address(),
            explanations: &result.explanations,
            outcome: &examined.outcome,
            rulings: &examined.rulings,
            trace: &trace,
            is_cut: false,
            rules: plan.rules,
            hints: plan.staff_hints,
        };
        let draw = |judged: &JudgedTrace<'_>| pages::draw_card(judged, false);
        (result.card, result.card_for_students) =
            pages.new_cards(&draw).store_cards(&judged, plan.student_hints(&task.name))?;
    }
    Ok((result, warning))
}

/// Reads the trace of a scene. The file has the scene's full name or its name without the group, and may be compressed.
/// If there is no usable trace, the warning says what is there instead: something that is not a file, a damaged file,
/// or a link, which may lead to the trace of somebody else. At most `max_bytes` bytes are read; a longer trace is cut,
/// and is therefore a bad trace.
fn read(folder: &Folder, scene: &str, max_bytes: u64) -> io::Result<(Vec<u8>, Option<String>)> {
    let mut warning = None;
    let last = scene.rsplit('/').next().unwrap_or(scene);
    let names = ["bin", "bin.zst", "bin.gz"].map(|end| [scene, last].map(|name| format!("{name}.{end}")));
    for name in names.into_iter().flatten() {
        match folder.open_file(OsStr::new(&name), u64::MAX) {
            Ok((file, _)) => match unpack(file, max_bytes)? {
                Ok(trace) => return Ok((trace, None)),
                Err(why) => warning = warning.or_else(|| Some(format!("{name} is skipped: {why}"))),
            },
            Err(FileError::Missing { .. }) => {}
            Err(FileError::System { source, .. }) => return Err(source),
            Err(error) => warning = warning.or_else(|| Some(format!("a trace was skipped: {error}"))),
        }
    }
    Ok((Vec::new(), warning))
}
