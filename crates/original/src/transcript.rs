//! The original's standard output, as a state machine over events (oracle-behavior.md 3, 5, 6).
use crate::{
    collisions,
    messages::{BLUE, GREEN, PINK, RED, RESET},
    verdict,
};
use fosssim_judge::{
    Book, Outcome, ReadFailure, Residuals, Stop,
    replay::{Progress, Remark},
};
use fosssim_model::scene::{Integrator, Scene};
use fosssim_num::number_format::format_g;
use std::{
    io::{self, Write},
    time::Instant,
};

/// The lines that the original prints above a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Heading<'a> {
    /// The scene argument as typed.
    pub(crate) scene_name: &'a [u8],
    /// The scene that is simulated.
    pub(crate) scene: &'a Scene,
    /// The description, as written in the file.
    pub(crate) description: &'a [u8],
    /// The task of the run.
    pub(crate) task: Task<'a>,
}

/// A task of the original.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Task<'a> {
    /// The scene is simulated without output files.
    Run,
    /// A trace is recorded in this file.
    Record(&'a [u8]),
    /// The trace in this file is graded.
    Grade(&'a [u8]),
}

/// A writer of the original's standard output, event by event.
///
/// For grading, pass it to `judge` as its [`Progress`], then call [`Transcript::print_end`]. For recording and plain
/// runs, call `observe_begin`, `observe_step_begin` and [`Transcript::end_step`] per step, then
/// [`Transcript::print_completion`] and [`Transcript::print_exit_line`]. The first error of the stream is kept until
/// [`Transcript::finish`]; later text is dropped.
#[derive(Debug)]
pub(crate) struct Transcript<'a, W: Write> {
    stream: W,
    heading: Heading<'a>,
    steps: u32,
    threshold: f64,
    /// The clock of the steps, if the original prints their times.
    clock: Option<Clock>,
    error: Option<io::Error>,
}

/// The times at which the run and its last step began.
#[derive(Debug, Clone, Copy)]
struct Clock {
    start: Instant,
    frame: Instant,
}

/// The share of the steps after which the next dot is printed.
const DOT_INTERVAL: f64 = 0.02;

const BANNER: [&str; 7] = [
    "------------------------------------------    ",
    "  _____ ___  ____ ____ ____  _                ",
    " |  ___/ _ \\/ ___/ ___/ ___|(_)_ __ ___      ",
    " | |_ | | | \\___ \\___ \\___ \\| | '_ ` _ \\ ",
    " |  _|| |_| |___) |__) |__) | | | | | | |     ",
    " |_|   \\___/|____/____/____/|_|_| |_| |_|    ",
    "------------------------------------------    ",
];

impl<'a, W: Write> Transcript<'a, W> {
    /// Creates an empty transcript.
    pub(crate) fn new(stream: W, heading: Heading<'a>) -> Self {
        Self { stream, heading, steps: heading.scene.step_count(), threshold: DOT_INTERVAL, clock: None, error: None }
    }

    /// Prints that all steps are completed.
    pub(crate) fn print_completion(&mut self) {
        self.print_dot(self.steps);
        let time = f64::from(self.steps) * self.heading.scene.time_step;
        self.print_message(&format!("Simulation complete at time {}. Exiting.", format_g(time)));
    }

    /// Prints the exit handler's line of a run without a verdict, after the file is closed.
    pub(crate) fn print_exit_line(&mut self) {
        match self.heading.task {
            Task::Run => {}
            Task::Record(file) => self.print_message_about("Saved simulation to file '", file, "'."),
            Task::Grade(file) => {
                self.print_message_about("Colsing benchmarked simulation file '", file, "'.");
                self.print_open_failure();
            }
        }
    }

    /// Ends grading: prints the completion message or the reason for stopping, then the exit handler's lines.
    pub(crate) fn print_end(&mut self, outcome: &Outcome) {
        match &outcome.stop_by(Book::Parity) {
            None => self.print_completion(),
            Some(Stop::Trace { cause: ReadFailure::State, .. }) => {
                let text = format!("{RED}Error in TwoDSceneSerialized: {RESET}Failed to load timestep. Exiting.\n");
                self.write(text.as_bytes());
            }
            Some(Stop::Trace { cause: ReadFailure::Impulses, .. }) => {
                // The original never resets this color.
                let text = format!("{RED}Error while trying to deserialize time step impulses. Exiting.\n");
                self.write(text.as_bytes());
            }
            // The original crashes or hangs here. The reason goes to standard error, but the run is closed normally.
            Some(
                Stop::Trace { cause: ReadFailure::Memory | ReadFailure::Limit | ReadFailure::Io, .. } | Stop::Step(_),
            ) => self.write(b"\n"),
        }
        if let Task::Grade(file) = self.heading.task {
            self.print_message_about("Colsing benchmarked simulation file '", file, "'.");
        }
        let collisions = self.heading.scene.assignment().definition().verdict;
        self.write(verdict::render_verdict(outcome, collisions).as_bytes());
    }

    /// Prints the exit handler's lines if the trace could not be opened, in which case there is no banner.
    pub(crate) fn print_open_failure(&mut self) {
        self.write(verdict::describe_incomplete(&Residuals::default()).as_bytes());
    }

    /// Flushes and returns the stream.
    ///
    /// # Errors
    /// Fails with the first error of the stream.
    pub(crate) fn finish(mut self) -> io::Result<W> {
        if let Some(error) = self.error {
            return Err(error);
        }
        self.stream.flush()?;
        Ok(self.stream)
    }

    fn print_banner(&mut self) {
        self.write(format!("{GREEN}{}{RESET}\n\n", BANNER.join("\n")).as_bytes());
        let scene = self.heading.scene;
        self.print_entry("FOSSSim Version", scene.assignment().definition().version.as_bytes());
        self.print_entry("Build type", b"Release");
        self.print_entry("Vectorization", b"Enabled");
        self.print_entry("Scene", self.heading.scene_name);
        self.print_entry("Integrator", integrator_name(scene.integrator).as_bytes());
        self.print_entry("Collision Handling", scene.collision.handling().heading.as_bytes());
        self.print_entry("Description", self.heading.description);
        match self.heading.task {
            Task::Run => {}
            Task::Record(file) => self.print_message_about("Saving simulation to: ", file, ""),
            Task::Grade(file) => self.print_message_about("Benchmarking simulation in: ", file, ""),
        }
        if scene.assignment().definition().prints_times {
            let now = Instant::now();
            self.clock = Some(Clock { start: now, frame: now });
            self.write(b"T: 0\nFrame run time: 0s. Total run time: 0s. \n");
        }
        self.write(format!("{PINK}Progress: {RESET}{}\n{}", "-".repeat(50), " ".repeat(10)).as_bytes());
    }

    /// Ends a step, and prints its duration if the original prints one.
    pub(crate) fn end_step(&mut self, step: u32) {
        let Some(clock) = &mut self.clock else { return };
        let now = Instant::now();
        let [frame, total] = [now - clock.frame, now - clock.start].map(|time| format_g(time.as_secs_f64()));
        clock.frame = now;
        let time = format_g(f64::from(step) * self.heading.scene.time_step);
        self.write(format!("T: {time}\nFrame run time: {frame}s. Total run time: {total}s. \n").as_bytes());
    }

    /// Prints a dot when the next threshold is reached, but never more than one. Without steps the quotient is NaN, and
    /// there is no dot.
    fn print_dot(&mut self, steps_done: u32) {
        if f64::from(steps_done) / f64::from(self.steps) >= self.threshold {
            self.threshold += DOT_INTERVAL;
            self.write(b".");
        }
    }

    fn print_entry(&mut self, name: &str, value: &[u8]) {
        self.write(format!("{BLUE}{name}: {RESET}").as_bytes());
        self.write(value);
        self.write(b"\n");
    }

    fn print_message(&mut self, text: &str) {
        self.print_message_about(text, b"", "");
    }

    fn print_message_about(&mut self, before: &str, file: &[u8], after: &str) {
        self.write(format!("{PINK}FOSSSim message: {RESET}{before}").as_bytes());
        self.write(file);
        self.write(after.as_bytes());
        self.write(b"\n");
    }

    fn write(&mut self, bytes: &[u8]) {
        if self.error.is_none() {
            self.error = self.stream.write_all(bytes).err();
        }
    }
}

impl<W: Write> Progress for Transcript<'_, W> {
    fn observe_begin(&mut self) {
        self.print_banner();
    }

    fn observe_step_begin(&mut self, step: u32) {
        self.print_dot(step.saturating_sub(1));
        if self.clock.is_some() {
            // The original prints these lines before it reads the step's record. The parts of a step are not measured
            // here.
            self.write(b"Preparation: 0s\nCollision detection: 0s\nCollision handling: 0s\n");
        }
    }

    fn observe_step_end(&mut self, step: u32, remarks: &[Remark]) {
        self.end_step(step);
        let mut header_due = true;
        for remark in remarks {
            if let Some(line) = collisions::describe_remark(remark) {
                if std::mem::take(&mut header_due) {
                    self.write(collisions::HEADER.as_bytes());
                }
                self.write(line.as_bytes());
            } else if let Remark::Polynomials(kind, count) = remark
                && let Some(message) = kind.original_message()
            {
                for _ in 0..*count {
                    self.write(message.as_bytes());
                    self.write(b"\n");
                }
            }
        }
    }
}

/// Returns the integrator's printed name (simulation.md 4).
const fn integrator_name(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::ExplicitEuler => "Explicit Euler",
        Integrator::ForwardBackwardEuler | Integrator::SymplecticEuler => "Forward-Backward Euler",
        Integrator::ImplicitEuler => "Implicit Euler",
        Integrator::LinearizedImplicitEuler => "Linearized Implicit Euler",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_judge::{FindingKind, Overall, parity};
    use fosssim_model::{
        scene::Collision,
        sim::{Impulse, Pair, PairKind},
        trace::TraceFormatError,
    };
    use fosssim_num::vector::Vec2;

    fn scene(steps: u32) -> Scene {
        Scene {
            duration: f64::from(steps) * 0.01,
            time_step: 0.01,
            integrator: Integrator::SymplecticEuler,
            collision: Collision::ContinuousTime { restitution: 1.0 },
            particles: Vec::new(),
            edges: Vec::new(),
            half_planes: Vec::new(),
            forces: Vec::new(),
            description: None,
            display: fosssim_model::scene::Display::default(),
        }
    }

    fn outcome(overall: Overall, stop: Option<Stop>) -> Outcome {
        let residuals =
            Residuals { accumulated_position: 0.002_828_427, maximum_position: 1e-10, ..Default::default() };
        let collisions_passed = (overall != Overall::None).then_some(false);
        Outcome {
            parity: parity::Judgment { overall, residuals, collisions_passed, ..Default::default() },
            steps_judged: 0,
            steps: 0,
            collisions: fosssim_model::assignments::CollisionType::None,
            stop,
            damage: None,
            damaged_steps: 0,
            trailing_bytes: false,
            fair: None,
        }
    }

    /// Returns the transcript of `scene` from the first event on.
    fn after_heading(scene: &Scene, task: Task<'_>, act: impl FnOnce(&mut Transcript<'_, Vec<u8>>)) -> String {
        let heading = Heading { scene_name: b"s.xml", scene, description: b"none", task };
        let mut transcript = Transcript::new(Vec::new(), heading);
        act(&mut transcript);
        let text = String::from_utf8(transcript.finish().unwrap()).unwrap();
        let at = text.find("\x1b[35;1mProgress").unwrap_or(0);
        text[at..].to_owned()
    }

    fn steps(transcript: &mut Transcript<'_, Vec<u8>>, steps: std::ops::RangeInclusive<u32>) {
        for step in steps {
            transcript.observe_step_begin(step);
            transcript.observe_step_end(step, &[]);
        }
    }

    #[test]
    fn the_banner_names_scene_integrator_and_collision_handling() {
        let scene = scene(1);
        let heading =
            Heading { scene_name: b"a/\xff.xml", scene: &scene, description: b"d\xe9", task: Task::Record(b"o") };
        let mut transcript = Transcript::new(Vec::new(), heading);
        transcript.observe_begin();
        let bytes = transcript.finish().unwrap();
        let start = "\x1b[32;1m------------------------------------------    \n\
            \x20 _____ ___  ____ ____ ____  _                \n";
        assert!(bytes.starts_with(start.as_bytes()));
        let end = b"------------------------------------------    \x1b[m\n\n\
            \x1b[34;1mFOSSSim Version: \x1b[mFall 2010 v.A\n\x1b[34;1mBuild type: \x1b[mRelease\n\
            \x1b[34;1mVectorization: \x1b[mEnabled\n\x1b[34;1mScene: \x1b[ma/\xff.xml\n\
            \x1b[34;1mIntegrator: \x1b[mForward-Backward Euler\n\
            \x1b[34;1mCollision Handling: \x1b[mContinuous-Time Collision Handling\n\
            \x1b[34;1mDescription: \x1b[md\xe9\n\x1b[35;1mFOSSSim message: \x1b[mSaving simulation to: o\n\
            \x1b[35;1mProgress: \x1b[m--------------------------------------------------\n          ";
        assert!(bytes.ends_with(end), "{}", String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn a_long_run_has_forty_nine_dots_and_a_short_one_a_dot_per_step() {
        for (count, dots) in [(200, 49), (50, 49), (34, 34), (5, 5), (0, 0)] {
            let scene = scene(count);
            let text = after_heading(&scene, Task::Run, |transcript| {
                transcript.observe_begin();
                steps(transcript, 1..=count);
                transcript.print_completion();
                transcript.print_exit_line();
            });
            let line = text.lines().nth(1).unwrap();
            let shown = line.trim_start().bytes().take_while(|&byte| byte == b'.').count();
            assert_eq!(shown, dots, "{count} steps");
        }
    }

    #[test]
    fn remarks_continue_the_line_of_dots() {
        let scene = scene(200);
        let pair = Pair { kind: PairKind::ParticleParticle, first: 0, second: 1 };
        let missed = Remark::Missed(Impulse { pair, normal: Vec2::new(0.4, 0.0), time: 0.25 });
        let text = after_heading(&scene, Task::Grade(b"m.bin"), |transcript| {
            transcript.observe_begin();
            steps(transcript, 1..=59);
            transcript.observe_step_begin(60);
            transcript.observe_step_end(60, &[missed, Remark::Polynomials(FindingKind::PolynomialDegree, 2)]);
            steps(transcript, 61..=200);
            transcript.print_end(&outcome(Overall::Failed, None));
        });
        let expected = "\x1b[35;1mProgress: \x1b[m--------------------------------------------------\n          \
            ..............Collision Detection Error: \n\
            \x20 Missed collision: Particle 0 - Particle 1 with normal = 0.4 0\n\
            Wrong polynomial degree!\nWrong polynomial degree!\n\
            ...................................\
            \x1b[35;1mFOSSSim message: \x1b[mSimulation complete at time 2. Exiting.\n\
            \x1b[35;1mFOSSSim message: \x1b[mColsing benchmarked simulation file 'm.bin'.\n\
            Accumulated Position Residual: 0.00282843   Failed.\nAccumulated Velocity Residual: 0   Passed.\n\
            Maximum Position Residual: 1e-10   Failed.\nMaximum Velocity Residual: 0   Passed.\n\
            Collisions Passed: No.\nOverall success: Failed.\n\
            \x1b[35;1mFOSSSim message: \x1b[mSaved residual to residual.txt.\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn an_unreadable_first_record_leaves_no_banner() {
        let scene = scene(3);
        let cause = ReadFailure::State;
        let stop = Stop::Trace { frame: 0, step: 0, cause, offset: 0, what: TraceFormatError::Empty };
        let text = after_heading(&scene, Task::Grade(b"e"), |transcript| {
            transcript.print_end(&outcome(Overall::None, Some(stop)));
        });
        assert!(text.starts_with("\x1b[31;1mError in TwoDSceneSerialized: \x1b[mFailed to load timestep. Exiting.\n"));
        assert!(text.contains("Colsing benchmarked simulation file 'e'.\nAccumulated Position Residual: 0.00282843\n"));
        assert!(text.ends_with("Simulation did not run to completion. No pass/fail status will be reported.\n"));
    }

    #[test]
    fn a_backward_run_completes_at_minus_zero() {
        let mut scene = scene(0);
        scene.time_step = -0.01;
        let text = after_heading(&scene, Task::Record(b"o"), |transcript| {
            transcript.observe_begin();
            transcript.print_completion();
            transcript.print_exit_line();
        });
        assert!(text.ends_with(
            "Simulation complete at time -0. Exiting.\n\x1b[35;1mFOSSSim message: \x1b[mSaved simulation to file 'o'.\n"
        ));
    }
}
