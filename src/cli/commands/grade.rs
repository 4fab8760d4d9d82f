//! `grade`: runs programs on a suite in the sandbox, keeps every result, and writes the reports.
use super::{display::Display, submissions};
use crate::{
    cli::{console, exit, grading::Grade as Arguments, output},
    judge::Rules,
    report::{
        explain,
        grade::{self, Format},
        number::counted,
    },
    sandbox::{Backend, Supervisor},
    suite::{
        Cancellation, Grade, Verdict,
        batch::{self, Batch, BatchOptions, Submission},
        config, guarded,
        journal::Journal,
        plan::{self, Plan},
    },
};
use anyhow::{Context, Result, bail};
use std::{
    fs,
    num::NonZeroUsize,
    path::{Path, PathBuf},
    sync::{Arc, OnceLock},
    time::{Duration, Instant, SystemTime},
};

/// Where results go when several submissions are graded and no folder is named.
const DEFAULT_OUTPUT: &str = "fosssim-grades";

/// Where traces on which the grader itself failed go when there is no folder for results.
const FAULTS: &str = "fosssim-faults";

pub(super) fn run(arguments: &Arguments) -> Result<u8> {
    let mut plan = load_suite(&arguments.suite)?;
    if let Some(rules) = arguments.rules {
        plan.rules = rules.into();
    }
    if arguments.recorded && plan.rules == Rules::Fair {
        bail!("the fair rules follow the submission, so they can't judge against recordings: leave --recorded out");
    }
    let reports = reports(&arguments.format)?;
    let submissions = submissions::find(arguments, plan.build.is_some())?;
    if submissions.len() > 1
        && let Some(report) = reports.iter().find(|report| !report.format.takes_several())
    {
        bail!("--format {} holds one submission, and there are {}", report.name, submissions.len());
    }
    // Before any output is touched, whose own handler would end the program at once.
    let cancellation = cancelled_by_signals();
    for file in reports.iter().filter_map(|report| report.file.as_deref()) {
        // An output that can't be written is said before the work is done, not after.
        drop(output::Output::create(file, &[])?);
    }
    let backend = backend(arguments.unsafe_no_sandbox)?;
    let folder = match &arguments.output {
        Some(folder) => Some(folder.clone()),
        None => (submissions.len() > 1).then(|| PathBuf::from(DEFAULT_OUTPUT)),
    };
    let session = Session { arguments, plan: &plan, backend: &backend, cancellation: &cancellation, folder };
    if arguments.watch {
        return session.watch(&submissions, &reports);
    }
    session.grade_and_report(&submissions, &reports)
}

/// Finds a suite by name or file.
///
/// # Errors
/// When there is none, or with everything that is wrong with it.
pub(super) fn load_suite(name: &str) -> Result<Plan> {
    if let Some(text) = plan::built_in(name) {
        return plan::load(text, Path::new(".")).with_context(|| format!("suite {name}"));
    }
    let known: Vec<_> = plan::built_in_names().collect();
    let text = fs::read_to_string(name)
        .with_context(|| format!("no suite {name}: it is neither a file nor one of {}", known.join(", ")))?;
    let folder = Path::new(name).parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let suite = config::read(&text).map_err(|error| in_file(name, &error))?;
    plan::resolve(&suite, folder).map_err(|error| in_file(name, &error))
}

fn in_file(name: &str, error: &config::SuiteError) -> anyhow::Error {
    let lines: Vec<String> = error.problems.iter().map(|(at, text)| format!("{name}:{at}: {text}")).collect();
    anyhow::anyhow!("the suite has {}:\n{}", counted(lines.len() as u64, "problem"), lines.join("\n"))
}

/// The sandbox, or a refusal that says what is missing.
pub(super) fn backend(unsafe_no_sandbox: bool) -> Result<Backend> {
    let supervisor = Supervisor::this_program();
    if unsafe_no_sandbox {
        return Backend::unsandboxed(supervisor).context("programs can't be run on this machine, not even unsafely");
    }
    Backend::best(supervisor).context(
        "programs can't be run safely on this machine; `fosssim-oracle doctor` says what to do, \
         --unsafe-no-sandbox runs them all the same",
    )
}

/// A cancellation that SIGINT and SIGTERM set off; a second signal ends the program at once.
pub(super) fn cancelled_by_signals() -> Arc<Cancellation> {
    static SHARED: OnceLock<Arc<Cancellation>> = OnceLock::new();
    SHARED
        .get_or_init(|| {
            let cancellation = Arc::new(Cancellation::default());
            let signalled = cancellation.clone();
            let mut first = None;
            // Without a handler a signal ends the program, and the sandbox ends with it.
            drop(ctrlc::set_handler(move || {
                // `timeout` and a terminal may send one stop twice.
                let first = *first.get_or_insert_with(Instant::now);
                if signalled.is_cancelled() {
                    if first.elapsed() > Duration::from_secs(1) {
                        std::process::exit(exit::INTERRUPTED.into());
                    }
                    return;
                }
                console::complain(b"stopping; results so far are kept (once more to stop at once)\n");
                signalled.cancel();
            }));
            cancellation
        })
        .clone()
}

struct Report {
    format: Format,
    name: String,
    file: Option<PathBuf>,
}

fn reports(words: &[String]) -> Result<Vec<Report>> {
    let mut reports = Vec::new();
    for word in words {
        let (name, file) = match word.split_once('=') {
            Some((name, file)) => (name, Some(PathBuf::from(file))),
            None => (word.as_str(), None),
        };
        let Some(format) = Format::from_name(name) else {
            let known: Vec<_> = Format::ALL.iter().map(|(_, name)| *name).collect();
            bail!("no format {name}; there are {}", known.join(", "));
        };
        reports.push(Report { format, name: name.to_owned(), file });
    }
    if reports.is_empty() {
        reports.push(Report { format: Format::Text, name: "text".to_owned(), file: None });
    }
    if reports.iter().filter(|report| report.file.is_none()).count() > 1 {
        bail!("only one format can go to standard output; give the others a file: --format NAME=FILE");
    }
    Ok(reports)
}

/// Everything that stays the same between two gradings of `--watch`.
struct Session<'a> {
    arguments: &'a Arguments,
    plan: &'a Plan,
    backend: &'a Backend,
    cancellation: &'a Cancellation,
    folder: Option<PathBuf>,
}

impl Session<'_> {
    fn grade_and_report(&self, submissions: &[Submission], reports: &[Report]) -> Result<u8> {
        let (grades, fault) = self.grade(submissions, self.arguments.fresh)?;
        self.report(&grades, reports)?;
        match fault {
            Some(fault) => Err(fault),
            None => Ok(self.exit_code(&grades)),
        }
    }

    /// The grades, and what kept the rest from being graded or kept.
    fn grade(&self, submissions: &[Submission], fresh: bool) -> Result<(Vec<Grade>, Option<anyhow::Error>)> {
        let mut journal = match &self.folder {
            Some(folder) => {
                fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
                Some(Journal::open(folder, fresh)?)
            }
            None => None,
        };
        let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
        let options = BatchOptions {
            jobs: self.arguments.jobs.map_or(cores, NonZeroUsize::get),
            fail_fast: self.arguments.fail_fast,
            recorded: self.arguments.recorded,
        };
        let faults = self.folder.as_deref().map_or_else(|| PathBuf::from(FAULTS), |folder| folder.join("faults"));
        let batch = Batch {
            plan: self.plan,
            backend: self.backend,
            options,
            cancellation: self.cancellation,
            faults: &faults,
            rehearse: &grade::rehearse,
        };
        let mut display = Display::new(self.plan, submissions);
        let mut log_error = None;
        let graded = batch.run(submissions, journal.as_mut(), &mut |event| {
            display.event(&event);
            if let (Some(folder), batch::Event::Graded { grade, .. }) = (&self.folder, &event)
                && log_error.is_none()
                && let Err(error) = write_logs(folder, grade)
            {
                log_error = Some(error);
            }
        });
        drop(display);
        let fault = graded.fault.map(anyhow::Error::from);
        Ok((graded.grades, fault.or(log_error)))
    }

    /// Writes the reports and, into the folder, the files that a batch ends with.
    fn report(&self, grades: &[Grade], reports: &[Report]) -> Result<()> {
        // One file that can't be written must not cost the others.
        let mut wrong = None;
        let mut keep = |result: Result<()>| drop(result.map_err(|error| wrong.get_or_insert(error).to_string()));
        if let Some(folder) = &self.folder {
            let lines = || grades.iter().map(grade::json_line).collect();
            keep(write(&folder.join("grades.csv"), || grade::csv_of_submissions(grades)));
            keep(write(&folder.join("scenes.csv"), || Format::Csv.render(grades)));
            keep(write(&folder.join("grades.jsonl"), lines));
        }
        for report in reports {
            let render = || report.format.render(grades);
            match &report.file {
                Some(file) => keep(write(file, render)),
                None => keep(made("the report", render).and_then(|text| console::print(text.as_bytes()))),
            }
        }
        match wrong {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    fn exit_code(&self, grades: &[Grade]) -> u8 {
        if self.cancellation.is_cancelled() {
            exit::INTERRUPTED
        } else if grades.iter().any(Grade::is_our_fault) {
            exit::FAULT
        } else if grades.iter().all(|grade| grade.verdict.is_accepted()) {
            exit::ACCEPTED
        } else {
            exit::NOT_ACCEPTED
        }
    }

    /// Grades, waits for a change of any program, grades again; until interrupted.
    fn watch(&self, submissions: &[Submission], reports: &[Report]) -> Result<u8> {
        loop {
            let seen = stamps(submissions);
            let code = self.grade_and_report(submissions, reports)?;
            if self.cancellation.is_cancelled() {
                return Ok(code);
            }
            console::complain(b"waiting for a change; Ctrl-C ends\n");
            // A file is graded when it has stopped changing: a linker writes in several goes.
            let mut last = seen.clone();
            loop {
                std::thread::sleep(Duration::from_millis(300));
                if self.cancellation.is_cancelled() {
                    return Ok(exit::INTERRUPTED);
                }
                let now = stamps(submissions);
                if now == last && now != seen && now.iter().all(Option::is_some) {
                    break;
                }
                last = now;
            }
        }
    }
}

/// Makes a text and writes it.
fn write(file: &Path, text: impl FnOnce() -> String) -> Result<()> {
    let text = made(&file.display().to_string(), text)?;
    output::write(file, &[], text.as_bytes())
}

/// A text, or what the grader failed on while it made it.
fn made(name: &str, text: impl FnOnce() -> String) -> Result<String> {
    guarded(text).map_err(|fault| anyhow::anyhow!("{name} could not be made: {fault}; please report this"))
}

/// What tells that a submission has changed: the newest change below it, and its size.
fn stamps(submissions: &[Submission]) -> Vec<Option<(SystemTime, u64)>> {
    submissions.iter().map(|submission| newest(&submission.path, &mut 20_000)).collect()
}

fn newest(path: &Path, budget: &mut u32) -> Option<(SystemTime, u64)> {
    *budget = budget.checked_sub(1)?;
    let data = fs::symlink_metadata(path).ok()?;
    let data = if data.is_symlink() { fs::metadata(path).ok()? } else { data };
    let own = (data.modified().ok()?, data.len());
    if !data.is_dir() {
        return Some(own);
    }
    let below = fs::read_dir(path).ok()?.flatten().filter_map(|entry| newest(&entry.path(), budget));
    Some(below.fold(own, |(time, size), (newer, more)| (time.max(newer), size + more)))
}

/// A log per run: what the program wrote, made harmless, and the verdict.
fn write_logs(folder: &Path, grade: &Grade) -> Result<()> {
    let folder = folder.join("logs").join(file_name(&grade.submission));
    fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    if let Some(build) = &grade.build {
        let text = format!("{}\n\n{}\n", build.end, grade::plain(&build.output));
        output::write(&folder.join("build.log"), &[], text.as_bytes())?;
    }
    for scene in grade.scenes().filter(|scene| scene.verdict != Verdict::NotRun) {
        let details: String = grade::difference(scene)
            .iter()
            .chain(&scene.details)
            .chain(&explain::lines(&scene.explanations))
            .map(|line| format!("{}\n", grade::plain(line)))
            .collect();
        let text = format!(
            "{}: {}\n{details}\n--- standard output ---\n{}\n--- standard error ---\n{}\n",
            scene.verdict,
            grade::plain(&scene.summary),
            grade::plain(&scene.stdout),
            grade::plain(&scene.stderr),
        );
        output::write(&folder.join(format!("{}.log", file_name(&scene.scene))), &[], text.as_bytes())?;
    }
    Ok(())
}

/// A name as a file name: no separators, no leading dot, not too long, and another for every other name.
fn file_name(name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.' | ' ') { c } else { '_' };
    let plain: String = name.replace('/', "_").chars().map(safe).take(100).collect();
    let plain = plain.trim_start_matches('.').trim();
    if !plain.is_empty() && plain == name.replace('/', "_") {
        return plain.to_owned();
    }
    format!("{plain}-{}", &blake3::hash(name.as_bytes()).to_hex()[..8])
}
