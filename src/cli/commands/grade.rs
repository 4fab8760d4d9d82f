//! The command `grade`, which runs programs on a suite in the sandbox, stores every result, and writes the reports.
use super::{
    display::{Counter, LiveDisplay},
    earlier_grades,
    further_commands::FurtherCommands,
    grade_ending::{MAX_HARDEST, exit_code, render_text, scene_file_name, text_detail, to_file_name},
    host::require_backend,
    last_run::LastRun,
    pages::{self, Pages},
    probes::Drawing,
    results::{Report, Results, find_requested_pages, read_reports, reject_several},
    shard::Sharding,
    shrink,
    submissions::{FoundSubmissions, Search},
    timings, traces,
};
use crate::{
    cli::{
        arguments::grade::GradeArguments as Arguments,
        console, exit,
        interrupt::{cancellation_by_signals, record_activity},
        output,
        selection::Selection,
    },
    files::{FilePlace, Folder},
    judge::Rules,
    report::{
        grade,
        number::format_count,
        page::Audience,
        style::Style,
        untrusted_text::{clean_output, strip_control_characters},
        words,
    },
    sandbox::Backend,
    suite::{
        Cancellation, EarlierGrade, Grade, Grader, SceneTask, SkippedEntry, Submission, Verdict,
        batch::{self, BatchResult},
        cards::JudgedTrace,
        catch_panic,
        config::Visibility,
        grader::Options,
        plan::{self, Plan},
        results::FolderResults,
        smallest_scene::ShrunkScene,
        timings::Timings,
    },
};
use anyhow::{Context, Result, anyhow, bail};
use std::{
    fs,
    num::NonZeroUsize,
    path::{Path, PathBuf},
    sync::OnceLock,
    time::{Duration, SystemTime},
};

/// The default folder for results of several submissions.
const DEFAULT_OUTPUT: &str = "fosssim-grades";

/// The folder for traces on which the grader failed, if no folder for results is used.
const FAULTS_FOLDER: &str = "fosssim-faults";

pub(super) fn run(arguments: &Arguments) -> Result<u8> {
    let times = Timings::default();
    let code = grade(arguments, &times)?;
    if arguments.timings {
        timings::print(&times);
    }
    Ok(code)
}

/// Grades the submissions, and adds up the times of their runs. When this function returns, all processes of the
/// sandbox have ended.
fn grade(arguments: &Arguments, times: &Timings) -> Result<u8> {
    let mut plan = plan::find_suite(&arguments.suite)?;
    if let Some(rules) = arguments.rules {
        plan.rules = rules;
    }
    if arguments.recorded && arguments.rules == Some(Rules::Fair) {
        bail!("the fair rules follow the submission and can't judge against recordings; leave out --recorded");
    }
    match (arguments.hints, arguments.reader) {
        (None, _) => {}
        (Some(hints), Audience::Staff) => plan.limit_hints(hints),
        (Some(hints), Audience::Student) => plan.set_student_hints(hints),
    }
    let reports = read_reports(&arguments.format)?;
    // The earlier grading is read before anything is written, because its files may be in the folder for results.
    let earlier = arguments.compare.as_deref().map(earlier_grades::read).transpose()?.unwrap_or_default();
    if arguments.traces {
        return traces::run(arguments, plan, &reports, &earlier);
    }
    let output = arguments.output.clone().unwrap_or_else(|| PathBuf::from(DEFAULT_OUTPUT));
    if arguments.output.is_none() && output.is_symlink() {
        bail!("{} is a link, which is not followed unless you name it: --output {0}", output.display());
    }
    let search = Search::new(arguments, plan.build.as_ref(), &output);
    let FoundSubmissions { mut submissions, mut skipped } = search.run()?;
    let names = submissions.iter().map(|submission| submission.name.as_str());
    skipped.extend(earlier_grades::list_missing(&earlier, names));
    let sharding = arguments.shard.map(|shard| Sharding::new(shard, &plan, arguments, &submissions, &output));
    let output = sharding.as_ref().map_or(output, |sharding| sharding.folder.clone());
    if let Some(sharding) = &sharding {
        sharding.begin()?;
        submissions = sharding.select_submissions(submissions);
        if submissions.is_empty() {
            return sharding.end(&[], &skipped).map(|()| exit::ACCEPTED);
        }
    }
    let names: Vec<&str> = plan.scenes().map(|task| task.name.as_str()).collect();
    let selection = Selection::new(&arguments.scene, &names)?;
    reject_several(&reports, submissions.len(), "; a class's pages go to its --output folder")?;
    // The signal handler is installed before an output is opened. The output's own handler would end the program
    // immediately.
    let cancellation = cancellation_by_signals();
    for file in reports.iter().filter_map(|report| report.file.as_deref()) {
        // The outputs are opened first. If one cannot be written, this is reported before the work begins.
        drop(output::Output::create(file, &[])?);
    }
    let backend = require_backend(arguments.unsafe_no_sandbox)?;
    let has_folder = arguments.output.is_some() || arguments.keep_traces || submissions.len() > 1 || sharding.is_some();
    let folder = has_folder.then_some(output);
    let scene_count = plan.scenes().count();
    let mut last_run = LastRun::open(folder.as_deref(), &submissions, &plan.name);
    let failed = match (arguments.failed, last_run.failed_scenes()) {
        (false, _) => None,
        (true, Some(failed)) => Some(failed),
        (true, None) => bail!("there is no earlier run of this grading; run the same command without --failed first"),
    };
    plan = plan
        .filter_scenes(|scene| selection.selects(scene) && failed.as_ref().is_none_or(|failed| failed.contains(scene)));
    if arguments.failed {
        submissions.retain(|submission| last_run.has_failed(&submission.name));
    }
    if plan.scenes().next().is_none() {
        console::print_error("nothing to run: everything was accepted in the last run\n");
        return Ok(exit::ACCEPTED);
    }
    let is_part = plan.scenes().count() < scene_count || arguments.failed;
    let pages = find_requested_pages(arguments, folder.as_deref(), submissions.len() > 1, &reports)?;
    let (plan, backend, cancellation) = (&plan, &backend, &cancellation);
    let session =
        GradingSession { arguments, plan, backend, cancellation, folder, pages, is_part, sharding, skipped, times };
    if arguments.watch {
        return session.watch(&submissions, &reports, &mut last_run, earlier);
    }
    session.grade_and_report(&submissions, &reports, &mut last_run, &earlier).map(|(_, code)| code)
}

/// The data that all gradings with `--watch` share.
struct GradingSession<'a> {
    arguments: &'a Arguments,
    plan: &'a Plan,
    backend: &'a Backend,
    cancellation: &'a Cancellation,
    folder: Option<PathBuf>,
    pages: Option<Pages>,
    /// Whether the user left out scenes of the suite.
    is_part: bool,
    /// The shard of this grading; `None` without `--shard`.
    sharding: Option<Sharding>,
    /// The skipped entries, which are not submissions.
    skipped: Vec<SkippedEntry>,
    /// The sums of the processor times of all runs, for `--timings`.
    times: &'a Timings,
}

impl GradingSession<'_> {
    fn grade_and_report(
        &self,
        submissions: &[Submission],
        reports: &[Report],
        last_run: &mut LastRun,
        earlier: &[EarlierGrade],
    ) -> Result<(Vec<Grade>, u8)> {
        let (mut grades, fault) = self.grade(submissions, self.arguments.fresh)?;
        earlier_grades::add_earlier_grades(earlier, &mut grades);
        last_run.remember(&grades);
        self.report(&grades, submissions, reports)?;
        self.report_kept_results(&grades);
        match fault {
            Some(fault) => Err(fault),
            None => {
                if let Some(sharding) = self.sharding.as_ref().filter(|_| !self.cancellation.is_canceled()) {
                    sharding.end(&grades, &self.skipped)?;
                }
                let code = if self.cancellation.is_canceled() { exit::INTERRUPTED } else { exit_code(&grades) };
                Ok((grades, code))
            }
        }
    }

    /// Prints how many results were reused, and how a grading that was stopped can be continued.
    fn report_kept_results(&self, grades: &[Grade]) {
        let reused_count: usize = grades.iter().map(Grade::count_reused).sum();
        let scene_count = grades.iter().flat_map(Grade::scenes).count();
        if let Some(folder) = &self.folder {
            if reused_count > 0 {
                let (folder, results) = (folder.display(), format_count(scene_count as u64, "result"));
                console::print_error(format!(
                    "reused {reused_count} of {results} from {folder} (--fresh regrades everything)\n"
                ));
            }
            if self.cancellation.is_canceled() {
                let folder = folder.display();
                let line = format!("stopped; results are kept in {folder}: the same command continues from there\n");
                console::print_error(&line);
            }
        }
    }

    /// Returns the file for the trace of a scene that is not accepted; `None` if traces are not kept.
    fn trace_place(&self, submission: &str, scene: &str) -> Option<FilePlace> {
        let folder = self.folder.as_ref().filter(|_| self.arguments.keep_traces)?;
        Some(FilePlace::new(folder, format!("traces/{}/{}.bin", to_file_name(submission), scene_file_name(scene))))
    }

    /// Grades the submissions. Also returns the error that stopped the grading or the storing of results, if there was
    /// one.
    fn grade(&self, submissions: &[Submission], fresh: bool) -> Result<(Vec<Grade>, Option<anyhow::Error>)> {
        let folder_results = match &self.folder {
            Some(folder) => {
                Folder::create(folder).with_context(|| format!("cannot create the folder {}", folder.display()))?;
                Some(FolderResults::open(folder, fresh)?)
            }
            None => None,
        };
        let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
        let options = Options {
            jobs: self.arguments.jobs.map_or(cores, NonZeroUsize::get),
            fail_fast: self.arguments.fail_fast,
            uses_recordings: self.arguments.recorded,
        };
        let faults = self
            .folder
            .as_deref()
            .map_or_else(|| FilePlace::new("", FAULTS_FOLDER), |folder| FilePlace::new(folder, "faults"));
        let trace = |submission: &Submission, scene: &SceneTask| {
            self.trace_place(&submission.name, &scene.name).unwrap_or_else(|| faults.clone())
        };
        if let (Some(pages), true) = (&self.pages, fresh) {
            pages.remove_cards();
        }
        let draw = |judged: &JudgedTrace<'_>| pages::draw_card(judged, self.arguments.recorded);
        let program = format!("./{}", self.arguments.program);
        let smallest = |small: &ShrunkScene| {
            let drawing = Drawing { hints: self.plan.staff_hints, has_pictures: self.pages.is_some() };
            let (mut description, card) = shrink::describe(small, &program, &self.arguments.suite, drawing);
            description.card = self.pages.as_ref().and_then(|pages| pages.store_card(card));
            description
        };
        let log_error = OnceLock::new();
        let finish = |grade: &Grade| {
            if let (Some(folder), None) = (&self.folder, log_error.get())
                && let Err(error) =
                    catch_panic(|| write_logs(folder, grade)).unwrap_or_else(|fault| Err(anyhow!(fault)))
            {
                let _ = log_error.set(error);
            }
        };
        // If this program is called by the original's name, it acts as the original.
        let reference = std::env::current_exe().ok();
        let grader = Grader {
            plan: self.plan,
            backend: self.backend,
            program: &self.arguments.program,
            options,
            fault_folder: &faults,
            trace_file: if self.arguments.keep_traces { Some(&trace) } else { None },
            cards: self.pages.as_ref().map(|pages| pages.new_cards(&draw)),
            smallest: if self.arguments.smallest { Some(&smallest) } else { None },
            receive_grade: Some(&finish),
            timings: self.arguments.timings.then_some(self.times),
            reference: reference.as_deref(),
        };
        let mut display = LiveDisplay::new(self.plan, submissions);
        let mut counter =
            self.arguments.progress.as_deref().map(|file| self.new_counter(file, submissions)).transpose()?;
        let mut on_event = |event: batch::Event<'_>| {
            record_activity();
            display.show_event(&event);
            if let Some(counter) = &mut counter {
                counter.count_event(&event);
            }
        };
        let results = folder_results.as_ref().map(|results| results as &dyn crate::suite::results::Results);
        let BatchResult { mut grades, fault } =
            batch::grade_all(&grader, submissions, results, self.cancellation, &mut on_event);
        drop(display);
        grade::add_warnings(&mut grades, self.skipped_entries());
        Ok((grades, fault.map(anyhow::Error::from).or(log_error.into_inner())))
    }

    /// Returns the counter for `--progress`. It counts the scenes that the reader of the pages may see.
    fn new_counter(&self, file: &Path, submissions: &[Submission]) -> Result<Counter> {
        let sees_all = self.arguments.reader == Audience::Staff;
        let groups = self.plan.groups.iter();
        let counts = groups.flat_map(|group| {
            let is_seen = sees_all || group.marking.visibility == Visibility::Visible;
            group.scenes.iter().map(move |_| is_seen)
        });
        Counter::new(file, submissions.len(), counts.collect())
            .with_context(|| format!("cannot write the progress to {}", file.display()))
    }

    /// Returns the skipped entries. For a shard there are none, because `merge` reports them.
    fn skipped_entries(&self) -> &[SkippedEntry] {
        if self.sharding.is_some() { &[] } else { &self.skipped }
    }

    /// Writes the reports, and the files in the output folder.
    fn report(&self, grades: &[Grade], submissions: &[Submission], reports: &[Report]) -> Result<()> {
        let (folder, pages, reader) = (self.folder.as_deref(), self.pages.as_ref(), self.arguments.reader);
        let skipped = self.skipped_entries();
        let arguments = self.arguments;
        let (staff_page, published_page) = (arguments.staff_page.as_deref(), arguments.published_page.as_deref());
        let (platform_hides, is_part) = (arguments.platform_hides, self.is_part);
        let results =
            Results { folder, pages, reader, platform_hides, staff_page, published_page, is_part, grades, skipped };
        results.write(reports, |grades| self.render_text(grades, submissions))
    }

    /// Renders the report for a terminal. For a class, it is a table and the result of the class.
    fn render_text(&self, grades: &[Grade], submissions: &[Submission]) -> String {
        let detail = text_detail(self.arguments, grades.len() > 1);
        let trace = |submission: &str, scene: &str| self.trace_place(submission, scene).map(|place| place.path());
        let closer = FurtherCommands { arguments: self.arguments, plan: self.plan, submissions, trace: &trace };
        let closer = |grade: &Grade, scene: Option<&_>| closer.list_commands(grade, scene);
        render_text(grades, self.skipped_entries(), detail, MAX_HARDEST, Some(&closer), self.arguments.failed)
    }

    /// Grades again whenever a program changes, until the user interrupts it.
    fn watch(
        &self,
        submissions: &[Submission],
        reports: &[Report],
        last_run: &mut LastRun,
        earlier: Vec<EarlierGrade>,
    ) -> Result<u8> {
        let mut earlier = earlier;
        loop {
            let graded_stamps = find_change_stamps(submissions);
            let (grades, code) = self.grade_and_report(submissions, reports, last_run, &earlier)?;
            if self.cancellation.is_canceled() {
                return Ok(code);
            }
            earlier = grades.iter().map(EarlierGrade::from).collect();
            console::print_error("waiting for a change; press Ctrl-C to end\n");
            // A file is used only after it has stopped changing, because a linker writes in several steps.
            let mut previous_stamps = graded_stamps.clone();
            loop {
                std::thread::sleep(Duration::from_millis(300));
                if self.cancellation.is_canceled() {
                    return Ok(exit::INTERRUPTED);
                }
                let stamps = find_change_stamps(submissions);
                if stamps == previous_stamps && stamps != graded_stamps && stamps.iter().all(Option::is_some) {
                    break;
                }
                previous_stamps = stamps;
            }
        }
    }
}

/// Returns for each submission the newest modification time of its files, and their total size. Returns `None` for a
/// submission that cannot be read or has too many files.
fn find_change_stamps(submissions: &[Submission]) -> Vec<Option<(SystemTime, u64)>> {
    let program = |submission: &Submission| match &submission.program {
        Some(program) => submission.path.join(program),
        None => submission.path.clone(),
    };
    submissions.iter().map(|submission| find_newest(&program(submission), &mut 20_000)).collect()
}

fn find_newest(path: &Path, budget: &mut u32) -> Option<(SystemTime, u64)> {
    *budget = budget.checked_sub(1)?;
    let data = fs::symlink_metadata(path).ok()?;
    let data = if data.is_symlink() { fs::metadata(path).ok()? } else { data };
    let own = (data.modified().ok()?, data.len());
    if !data.is_dir() {
        return Some(own);
    }
    let below = fs::read_dir(path).ok()?.flatten().filter_map(|entry| find_newest(&entry.path(), budget));
    Some(below.fold(own, |(time, size), (newer, more)| (time.max(newer), size + more)))
}

/// Writes the log of a submission: its build, and for each run the verdict, the reason, and the output without control
/// characters. If the whole submission has a fault, it is written only once.
fn write_logs(folder: &Path, grade: &Grade) -> Result<()> {
    let mut text = String::new();
    if let Some(build) = &grade.build {
        text += &format!("{}\n\n{}\n", words::build(&build.end), clean_output(&build.output));
    }
    if let Some(unfit) = words::describe_unfit(grade) {
        text += &format!("{}\n", strip_control_characters(&unfit));
    }
    let never_ran = |verdict| matches!(verdict, Verdict::NotRun | Verdict::Unusable | Verdict::CompileError);
    for scene in grade.scenes().filter(|scene| !never_ran(scene.verdict)) {
        text += &format!(
            "\n=== {} ===\n{}: {}\n",
            strip_control_characters(&scene.scene),
            scene.verdict,
            strip_control_characters(&words::summarize(scene))
        );
        let details = grade::describe_difference(scene).into_iter().chain(words::list_details(scene));
        text.extend(
            details
                .chain(grade::scene_lines(scene, Style::Plain))
                .map(|line| format!("{}\n", strip_control_characters(&line))),
        );
        for (stream, printed_there) in [("output", &scene.stdout), ("error", &scene.stderr)] {
            if !printed_there.trim().is_empty() {
                text += &format!("--- standard {stream} ---\n{}\n", clean_output(printed_there));
            }
        }
    }
    let file = FilePlace::new(folder, format!("logs/{}.log", to_file_name(&grade.submission)));
    output::write_below(&file, text.trim_start().as_bytes())
}
