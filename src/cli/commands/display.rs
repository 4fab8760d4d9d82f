//! The progress display of a grading, on standard error. It consists of bars on a terminal, and otherwise of one line
//! per finished submission.
use crate::{
    cli::{console, progress_bars},
    files::FilePlace,
    report::{
        grade::{describe_missing_points, format_score, shorten_name},
        untrusted_text::to_one_line,
    },
    suite::{Submission, batch::Event, plan::Plan},
};
use indicatif::{MultiProgress, ProgressBar};
use std::{collections::BTreeMap, io, path::Path};

/// The progress display of one grading. It disappears when the value is dropped.
pub(super) struct LiveDisplay<'a> {
    plan: &'a Plan,
    submissions: &'a [Submission],
    bars: Option<Bars>,
    graded: usize,
}

struct Bars {
    all: MultiProgress,
    overall: ProgressBar,
    running: BTreeMap<(usize, usize), ProgressBar>,
}

impl<'a> LiveDisplay<'a> {
    /// Creates the display for a grading of these submissions.
    pub(super) fn new(plan: &'a Plan, submissions: &'a [Submission]) -> Self {
        let bars = console::wants_bars().then(|| {
            let all = console::show_bars();
            let run_count = submissions.len() * plan.scenes().count();
            let overall = console::add_bar(&all, run_count as u64, "{wide_bar} {pos} of {len} runs, {eta} left");
            Bars { all, overall, running: BTreeMap::new() }
        });
        Self { plan, submissions, bars, graded: 0 }
    }

    /// Updates the display after an event.
    pub(super) fn show_event(&mut self, event: &Event<'_>) {
        match *event {
            Event::SceneBegins { submission, scene } => self.begin_scene(submission, scene),
            Event::Step { submission, scene, step } => {
                if let Some(bar) = self.bars.as_ref().and_then(|bars| bars.running.get(&(submission, scene))) {
                    bar.set_position(u64::from(step));
                }
            }
            Event::SceneDone { submission, scene, is_reused: cached, .. } => {
                if let Some(bars) = &mut self.bars {
                    if let Some(bar) = bars.running.remove(&(submission, scene)) {
                        bar.finish_and_clear();
                    }
                    match cached {
                        // Reused results are left out, because they do not show how long the rest will take.
                        true => bars.overall.set_length(bars.overall.length().unwrap_or(1).saturating_sub(1)),
                        false => bars.overall.inc(1),
                    }
                }
            }
            Event::GradeDone { grade, .. } => {
                self.graded += 1;
                if self.submissions.len() == 1 {
                    return;
                }
                let reached = grade.points.map(|reached| format_score(reached, grade.max_points));
                let line = format!(
                    "[{}/{}] {}: {}, {}",
                    self.graded,
                    self.submissions.len(),
                    shorten_name(&to_one_line(&grade.submission)),
                    grade.verdict,
                    reached.or_else(|| describe_missing_points(grade)).unwrap_or_default(),
                );
                match &self.bars {
                    Some(bars) => drop(bars.all.println(line)),
                    None => console::print_remark(format!("{line}\n")),
                }
            }
        }
    }

    fn begin_scene(&mut self, submission: usize, scene: usize) {
        let Some(bars) = &mut self.bars else { return };
        let Some(task) = self.plan.scenes().nth(scene) else { return };
        let bar = console::add_bar(&bars.all, task.scene.step_count().into(), "  {msg:<60!} step {pos} of {len}");
        bar.set_message(format!("{} {}", shorten_name(&to_one_line(&self.submissions[submission].name)), task.name));
        bars.running.insert((submission, scene), bar);
    }
}

/// A file with the number of scenes that have a verdict. Programs that wait for the grading can read it.
pub(super) struct Counter {
    place: FilePlace,
    /// Whether each scene of the plan counts, in the order of the plan.
    is_counted: Vec<bool>,
    done: usize,
    total: usize,
}

impl Counter {
    /// Creates the file with a count of zero, for a number of submissions.
    ///
    /// # Errors
    ///
    /// Fails if the file can't be written.
    pub(super) fn new(file: &Path, submissions: usize, counts: Vec<bool>) -> io::Result<Self> {
        let total = submissions * counts.iter().filter(|counts| **counts).count();
        let place = FilePlace::new(file.parent().unwrap_or(Path::new("")), file.file_name().unwrap_or_default());
        let counter = Self { place, is_counted: counts, done: 0, total };
        counter.write()?;
        Ok(counter)
    }

    fn write(&self) -> io::Result<()> {
        self.place.write(format!("{}/{}\n", self.done, self.total).as_bytes())
    }

    /// Counts a scene that has its verdict. If the file cannot be written, the grading still continues.
    pub(super) fn count_event(&mut self, event: &Event<'_>) {
        if let Event::SceneDone { scene, .. } = *event
            && self.is_counted.get(scene).copied().unwrap_or_default()
        {
            self.done += 1;
            drop(self.write());
        }
    }
}

impl Drop for LiveDisplay<'_> {
    fn drop(&mut self) {
        if let Some(bars) = &self.bars {
            bars.overall.finish_and_clear();
            progress_bars::clear_bars();
        }
    }
}
