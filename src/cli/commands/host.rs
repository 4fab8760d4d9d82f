//! The commands `doctor`, `selftest` and `demo`, which show what this machine can do.
use super::pages::{self, Pages};
use crate::{
    cli::{
        arguments::grade::{DemoArguments, SelftestArguments},
        console, exit,
        interrupt::cancellation_by_signals,
        output,
    },
    files::{self, FilePlace},
    report::{formats::Format, number::format_count, page::Audience},
    sample::pinned_mistake,
    sandbox::{self, Backend, Supervisor, selftest},
    student::{self, RowKind},
    suite::{Grader, Submission, Verdict, batch, cards::JudgedTrace, grader::Options, plan, suggestions},
};
use anyhow::{Context, Result, bail};
use std::{
    fmt::Write,
    fs::{self, Permissions},
    num::NonZeroUsize,
    os::unix::fs::PermissionsExt,
    path::Path,
};

/// The maximum size of this program, in bytes.
const MAX_PROGRAM_BYTES: u64 = 1 << 30;

/// The mistake that the wrong sample program makes in the demo, unless the user chooses another.
const DEMO_MISTAKE: &str = "pe-square-no-eh";

/// The suite of the demo. It has few scenes, but all kinds of collisions.
const DEMO_SUITE: &str = include_str!("demo.toml");

pub(super) fn doctor() -> Result<u8> {
    let reports = sandbox::check_host();
    let mut text = String::new();
    for report in &reports {
        let state = match (report.active, report.required) {
            (true, _) => "works",
            (false, true) => "MISSING",
            (false, false) if report.remedy.is_none() => "unused",
            (false, false) => "missing",
        };
        let _ = writeln!(text, "{state:<8} {:<24} {}", report.layer.name(), report.detail);
        if let Some(remedy) = report.remedy {
            let _ = writeln!(text, "{:<33} to do: {remedy}", "");
        }
    }
    let safe = reports.iter().all(|report| report.active || !report.required);
    text += if safe {
        "\nPrograms can be graded safely on this machine.\n"
    } else {
        "\nA required layer is missing: `grade` runs no program without --unsafe-no-sandbox.\n"
    };
    console::report(&text)?;
    Ok(if safe { exit::ACCEPTED } else { exit::NOT_ACCEPTED })
}

pub(super) fn demo(arguments: &DemoArguments) -> Result<u8> {
    let mistake = arguments.mistake.as_deref().unwrap_or(DEMO_MISTAKE);
    for id in mistake.split(',') {
        // A variant is right, so a program that uses a variant would be a correct submission.
        if student::find(id).is_none_or(|row| row.kind == RowKind::Variant) {
            let mistakes = student::all_rows().filter(|row| row.kind != RowKind::Variant);
            let suggestion = suggestions::suggest(id, mistakes.map(|row| row.id));
            bail!("there is no mistake '{id}'; `fosssim-oracle sample --list` lists them{suggestion}");
        }
    }
    if let Some(program) = &arguments.program {
        write_sample(mistake, program)?;
        let message =
            format!("A program that makes the mistake {}: {}\n", mistake.replace(',', " and "), program.display());
        console::print(&message)?;
        return Ok(exit::ACCEPTED);
    }
    let folder = tempfile::Builder::new().prefix("fosssim-demo-").tempdir().context("cannot create a folder")?;
    let plan = plan::load_suite(DEMO_SUITE, Path::new(".")).context("cannot load the demo's suite")?;
    let backend = require_backend(false)?;
    let cancellation = cancellation_by_signals();
    let jobs = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let pages = Pages::new(None, false)?;
    let draw = |judged: &JudgedTrace<'_>| pages::draw_card(judged, false);
    let (mut verdicts, mut last) = (Vec::new(), None);
    for (name, pinned) in
        [("right sample".to_owned(), pinned_mistake::RIGHT_ID), (format!("sample with mistake {mistake}"), mistake)]
    {
        let path = folder.path().join("FOSSSim");
        write_sample(pinned, &path)?;
        let submission = Submission { name, path, program: None, file: None };
        let grader = Grader {
            plan: &plan,
            backend: &backend,
            program: "",
            options: Options { jobs, fail_fast: false, uses_recordings: false },
            fault_folder: &FilePlace::new("", "fosssim-faults"),
            trace_file: None,
            cards: Some(pages.new_cards(&draw)),
            smallest: None,
            receive_grade: None,
            timings: None,
            reference: None,
        };
        let grades = batch::grade_all(&grader, &[submission], None, &cancellation, &mut |_| {}).grades;
        console::report(&Format::Text.render(&grades))?;
        if cancellation.is_canceled() {
            return Ok(exit::INTERRUPTED);
        }
        verdicts.push(grades.iter().map(|grade| grade.verdict).max());
        // The last grade is that of the wrong sample program.
        last = grades.into_iter().next();
    }
    if verdicts == [Some(Verdict::Accepted), Some(Verdict::WrongAnswer)] {
        console::print("The right sample is accepted, the wrong one is not: everything works on this machine.\n")?;
        if let Some(grade) = &last {
            output::write(&arguments.output, pages.render_grade(grade, None, Audience::Staff).as_bytes())?;
            let message = format!("The report on the wrong sample, for a browser: {}\n", arguments.output.display());
            console::print(&message)?;
        }
        Ok(exit::ACCEPTED)
    } else {
        bail!("the demo failed: the correct sample must be accepted, and the wrong one rejected")
    }
}

/// Writes the sample as a separate program that always makes this mistake.
fn write_sample(mistake: &str, program: &Path) -> Result<()> {
    let this = Path::new("/proc/self/exe").canonicalize().context("cannot find this program")?;
    let bytes = files::read(&this, MAX_PROGRAM_BYTES).with_context(|| format!("cannot read {}", this.display()))?;
    output::write(
        program,
        &pinned_mistake::write(&bytes, mistake).context("there are too many mistakes for one program")?,
    )?;
    fs::set_permissions(program, Permissions::from_mode(0o755))
        .with_context(|| format!("cannot set the execute permission of {}", program.display()))
}

pub(super) fn selftest(arguments: &SelftestArguments) -> Result<u8> {
    let mut backend = require_backend(false)?;
    for name in &arguments.without {
        let layer = sandbox::Layer::ALL.into_iter().find(|layer| layer.name() == name);
        let names = sandbox::Layer::ALL.into_iter().map(sandbox::Layer::name);
        let unknown = || format!("`doctor` lists no layer {name}{}", suggestions::suggest(name, names));
        backend = backend.without_layer(layer.with_context(unknown)?)?;
    }
    let folder = tempfile::Builder::new().prefix("fosssim-selftest-").tempdir().context("cannot create a folder")?;
    // If this process is root, programs run as another user. That user must be able to reach the folder.
    fs::set_permissions(folder.path(), Permissions::from_mode(0o755)).context("cannot make the folder readable")?;
    let mut attack_count = 0;
    let is_chosen = |name: &str| arguments.only.as_ref().is_none_or(|text| name.contains(text.as_str()));
    let table =
        selftest::run_selected(&backend, Path::new(&arguments.compiler), folder.path(), is_chosen, |promise| {
            attack_count += 1;
            if let selftest::PromiseState::Broken(how) = &promise.state {
                console::print_error(format!("broken: {}: {how}\n", promise.attack));
            } else if attack_count % 20 == 0 {
                console::print_error(format!("{attack_count} attacks so far\n"));
            }
        })?;
    let mut text = String::new();
    for promise in &table.promises {
        let (state, note) = match &promise.state {
            selftest::PromiseState::Kept => ("kept", String::new()),
            selftest::PromiseState::Broken(how) => ("BROKEN", format!(" [{how}]")),
            selftest::PromiseState::NotTested(note) => ("not tested", format!(" [{note}]")),
        };
        let _ = writeln!(text, "{state:<11} {:<28} {}{note}", promise.attack, promise.promise);
    }
    let broken_count = table.broken_promises().count();
    let kept_promises = format_count(table.count_kept() as u64, "promise");
    let untested = table.promises.len() - table.count_kept() - broken_count;
    let _ = writeln!(text, "\n{kept_promises} kept, {broken_count} broken, {untested} not tested here");
    console::report(&text)?;
    Ok(if broken_count == 0 && table.count_kept() > 0 { exit::ACCEPTED } else { exit::NOT_ACCEPTED })
}

/// Returns the sandbox. If required layers are missing, the error names them.
pub(super) fn require_backend(unsafe_no_sandbox: bool) -> Result<Backend> {
    let supervisor = Supervisor::this_program();
    if unsafe_no_sandbox {
        return Backend::without_sandbox(supervisor)
            .context("programs can't be run on this machine, not even without the sandbox");
    }
    Backend::with_all_layers(supervisor).context(
        "programs can't be run safely on this machine; `fosssim-oracle doctor` says what to do; --unsafe-no-sandbox \
         runs them anyway",
    )
}
