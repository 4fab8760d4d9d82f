//! Records and grades like the original (oracle-behavior.md 2).
use crate::{
    Pictures, Services,
    arguments::Arguments,
    messages::{INPUT_AND_OUTPUT, NO_PICTURE_FOLDER, NO_VORTEX_HESSIAN, open_failure},
    transcript::{Heading, Task, Transcript},
    verdict::residual_file,
};
use fosssim_files::{Identity, open_for_reading, open_for_writing, read_limited, with_timeout};
use fosssim_judge::{MissingResult, ReadFailure, Stop, replay, replay::Progress};
use fosssim_model::{
    scene::{
        MAX_IMPLICIT_PARTICLES, MAX_SCENE_BYTES, Scene,
        original::{self, OriginalScene, Rejection, RejectionKind},
    },
    sim::{RootSearch, Simulation, State, StepError},
    trace::{Frame, Layout, Reader, Recorder},
};
use std::{
    fs::{self, File, OpenOptions},
    io::{self, BufWriter, Read, Write},
    os::unix::ffi::OsStrExt,
    path::Path,
};

/// The exit code of every failure.
const FAILURE_CODE: u8 = 1;

/// Runs with parsed arguments, and returns the exit code. `raw_arguments` are the raw arguments.
pub(crate) fn run(arguments: &Arguments, raw_arguments: &[Vec<u8>], outside: &dyn Services) -> u8 {
    if arguments.input.is_some() && arguments.output.is_some() {
        return print_error(INPUT_AND_OUTPUT);
    }
    let (scene, identity) = match load(arguments) {
        Ok(loaded) => loaded,
        Err(rejection) => return reject_scene(arguments, &rejection),
    };
    if let Some(message) = find_unsupported(arguments, &scene.scene) {
        return print_error(message);
    }
    let draws_pictures = arguments.generate || arguments.movie.is_some();
    let pictures = draws_pictures
        .then(|| outside.pictures(arguments.generate, arguments.movie.as_deref().map(Path::new), &scene.scene));
    let task = match (&arguments.output, &arguments.input) {
        (Some(file), _) => Task::Record(file.as_bytes()),
        (None, Some(file)) => Task::Grade(file.as_bytes()),
        (None, None) => Task::Run,
    };
    let scene_name = arguments.scene.as_bytes();
    let heading = Heading { scene_name, scene: &scene.scene, description: &scene.description, task };
    let mut transcript = Transcript::new(BufWriter::new(io::stdout()), heading);
    let pictures = match pictures.transpose() {
        Ok(pictures) => pictures,
        Err(message) if message == NO_PICTURE_FOLDER => {
            return end_without_folder(arguments, identity, &scene.scene, transcript);
        }
        Err(message) => return print_error(message),
    };
    match (&arguments.output, &arguments.input) {
        (Some(file), _) => match create(Path::new(file), identity) {
            Ok(file) => simulate(&scene.scene, file, transcript, pictures),
            Err(message) => print_error(message),
        },
        (None, Some(file)) => {
            if let Ok(trace) = open_input(Path::new(file)) {
                if let Some(pictures) = pictures
                    && let Err(message) = draw(&scene.scene, Path::new(file), pictures)
                {
                    return print_error(message);
                }
                return grade(&scene.scene, trace, transcript);
            }
            // The original prints the third argument of the command line instead of the file's name.
            let third_argument = raw_arguments.get(2).map(Vec::as_slice).unwrap_or_default();
            crate::print_error(&open_failure("input", third_argument));
            transcript.print_open_failure();
            drop(transcript.finish());
            FAILURE_CODE
        }
        (None, None) => simulate(&scene.scene, io::sink(), transcript, pictures),
    }
}

/// Ends a run whose folder for pictures is missing. The original detects this after the first record.
fn end_without_folder(
    arguments: &Arguments,
    identity: Identity,
    scene: &Scene,
    mut transcript: Transcript<'_, impl Write>,
) -> u8 {
    if let Some(file) = &arguments.output {
        match create(Path::new(file), identity) {
            Ok(file) => drop(Recorder::start(file, Layout::for_scene(scene), &State::for_scene(scene)).finish()),
            Err(message) => return print_error(message),
        }
    }
    transcript.observe_begin();
    transcript.print_exit_line();
    drop(transcript.finish());
    print_error(NO_PICTURE_FOLDER)
}

fn print_error(text: impl AsRef<[u8]>) -> u8 {
    crate::print_error(text.as_ref());
    FAILURE_CODE
}

/// Reads the scene like the original. A directory can be opened, and is read as an empty text.
fn load(arguments: &Arguments) -> Result<(OriginalScene, Identity), Rejection> {
    let name = Path::new(&arguments.scene);
    let unreadable = || Rejection::from_unreadable_file(arguments.scene.as_bytes());
    let (file, metadata) = open_for_reading(name).map_err(|_| unreadable())?;
    let bytes = if metadata.is_dir() {
        Vec::new()
    } else {
        read_limited(file, &metadata, MAX_SCENE_BYTES as u64).map_err(|error| Rejection {
            kind: RejectionKind::Undefined,
            stderr: format!("cannot read the scene {}: {error}\n", name.display()).into_bytes(),
            exit_code: FAILURE_CODE,
            explanation: error.to_string(),
        })?
    };
    Ok((original::read(&bytes)?, Identity::from_metadata(&metadata)))
}

fn reject_scene(arguments: &Arguments, rejection: &Rejection) -> u8 {
    if rejection.kind == RejectionKind::Crash {
        // The original crashes with an uncaught exception in this case.
        let name = arguments.scene.display();
        return print_error(format!(
            "{name}: {}; `fosssim-oracle simulate {name}` says where\n",
            rejection.explanation
        ));
    }
    crate::print_error(&rejection.stderr);
    rejection.exit_code
}

/// Returns the reason why a run is not supported, or `None` if it is supported. A run may need a window or too much
/// memory.
fn find_unsupported(arguments: &Arguments, scene: &Scene) -> Option<String> {
    if arguments.display {
        return Some("there is no window to simulate in (the default); add -d 0 to run without one\n".to_owned());
    }
    let particles = scene.particles.len();
    (scene.integrator.is_implicit() && particles > MAX_IMPLICIT_PARTICLES).then(|| {
        format!(
            "{particles} particles are too many for an implicit integrator, which can have {MAX_IMPLICIT_PARTICLES}\n"
        )
    })
}

/// Creates the file of the trace, unless it is the scene's own file.
fn create(name: &Path, scene: Identity) -> Result<File, Vec<u8>> {
    if fs::metadata(name).is_ok_and(|metadata| Identity::from_metadata(&metadata) == scene) {
        let text = format!("{} is the scene itself; choose another name for the trace\n", name.display());
        return Err(text.into_bytes());
    }
    create_file(name).map_err(|_| open_failure("output", name.as_os_str().as_bytes()))
}

/// Creates or truncates a file. A pipe without a reader is an error and does not block.
fn create_file(name: &Path) -> io::Result<File> {
    open_for_writing(OpenOptions::new().write(true).create(true).truncate(true), name)
}

/// Opens the trace. A directory can be opened, and is read as an empty file.
fn open_input(name: &Path) -> io::Result<Box<dyn Read + Send>> {
    let (file, metadata) = open_for_reading(name)?;
    if metadata.is_dir() { Ok(Box::new(io::empty())) } else { with_timeout(file, &metadata) }
}

/// Simulates a scene, and records it into `file`.
fn simulate<W: Write>(
    scene: &Scene,
    file: W,
    mut transcript: Transcript<'_, impl Write>,
    mut pictures: Option<Box<dyn Pictures>>,
) -> u8 {
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    let mut recorder = Recorder::start(file, Layout::for_scene(scene), simulation.state());
    transcript.observe_begin();
    let mut stopped = None;
    for step in 1..=scene.step_count() {
        transcript.observe_step_begin(step);
        stopped = simulation.step(&mut recorder).err();
        if stopped.is_some() || recorder.has_failed() {
            break;
        }
        transcript.end_step(step);
        if let Some(pictures) = &mut pictures
            && let Err(error) = pictures.step(step, &simulation.state().positions)
        {
            drop(transcript.finish());
            return print_error(error);
        }
    }
    let written = recorder.finish();
    if stopped.is_none() && written.is_ok() {
        transcript.print_completion();
    }
    transcript.print_exit_line();
    drop(transcript.finish());
    match (stopped, written) {
        (Some(error), _) => end_after_failed_step(&error),
        // The original would continue and claim that the trace was saved.
        (None, Err(error)) => print_error(format!("the trace could not be written: {error}\n")),
        (None, Ok(_)) => 0,
    }
}

/// Draws the readable states of a trace; the grading reports its faults.
fn draw(scene: &Scene, name: &Path, mut pictures: Box<dyn Pictures>) -> Result<(), String> {
    if !fs::metadata(name).is_ok_and(|data| data.is_file()) {
        return Err("pictures of a trace (-g, -m with -i) need a file, which can be read twice\n".to_owned());
    }
    let trace = open_input(name).map_err(|error| format!("cannot read {}: {error}\n", name.display()))?;
    let layout = Layout::for_scene(scene);
    let mut reader = Reader::new(trace, layout);
    let mut frame = Frame::default();
    while let Ok(true) = reader.next(&mut frame) {
        let record = reader.record_count() - 1;
        let step = layout.step_of_record(record);
        if step > 0 && record == layout.end_record(step) {
            pictures.step(step, &frame.state.positions)?;
        }
    }
    Ok(())
}

/// Grades a trace and writes `residual.txt`.
fn grade(scene: &Scene, trace: Box<dyn Read + Send>, mut transcript: Transcript<'_, impl Write>) -> u8 {
    let outcome = replay::judge(scene, trace, &replay::Options::default(), &mut transcript);
    transcript.print_end(&outcome);
    drop(transcript.finish());
    if let Some(residuals) = residual_file(&outcome, scene.assignment().definition())
        && let Ok(mut file) = create_file(Path::new("residual.txt"))
    {
        // The original follows links, truncates the file and ignores failures, so this does as well.
        drop(file.write_all(residuals.as_bytes()));
    }
    if let Some(error) = &outcome.parity.endless_step {
        return end_after_failed_step(error);
    }
    match &outcome.stop {
        None => 0,
        Some(Stop::Step(error)) => end_after_failed_step(error),
        Some(Stop::Trace { cause: ReadFailure::State | ReadFailure::Impulses, .. }) => FAILURE_CODE,
        Some(Stop::Trace {
            cause: ReadFailure::Memory | ReadFailure::Limit | ReadFailure::Io,
            frame,
            step,
            offset,
            what,
        }) => print_error(format!("the trace can't be read at byte {offset} (record {frame}, step {step}): {what}\n")),
    }
}

/// Ends a run in which the original computes endlessly or fails.
fn end_after_failed_step(error: &StepError) -> u8 {
    match error {
        StepError::VortexHessian { .. } => print_error(NO_VORTEX_HESSIAN),
        StepError::RootSearch { .. } | StepError::Newton { .. } | StepError::Work { .. } => {
            print_error(format!("step {} has no result: {}\n", error.step(), MissingResult(*error)))
        }
    }
}
