//! A separate folder for every test of the command line, in which the program runs with a cleaned environment.
use fosssim_oracle::{
    sample::pinned_mistake,
    scene::{self, Scene},
    sim::{RootSearch, Simulation},
    suite::library,
    trace::{Layout, Recorder},
};
use std::{
    ffi::OsStr,
    fs,
    io::Write,
    os::unix::process::CommandExt,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

/// Returns the top folder of the checkout.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns a program like a student's: a copy of the sample with a mistake, or a "right" one.
pub fn submission(mistake: &str) -> Vec<u8> {
    let sample = fs::read(env!("CARGO_BIN_EXE_fosssim-sample")).expect("the sample");
    pinned_mistake::write(&sample, mistake).expect("a place for the mistake")
}

/// A temporary folder, which is removed at the end of the test.
pub struct Workspace {
    folder: tempfile::TempDir,
}

/// A run of the program.
#[derive(Debug)]
pub struct Run {
    pub code: Option<i32>,
    pub stdout: Vec<u8>,
    pub stderr: Vec<u8>,
}

impl Workspace {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a temporary folder") }
    }

    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file, and creates its parent folders.
    pub fn write(&self, name: impl AsRef<Path>, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }

    pub fn read(&self, name: impl AsRef<Path>) -> Vec<u8> {
        let path = self.path(name);
        fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    pub fn exists(&self, name: impl AsRef<Path>) -> bool {
        self.path(name).symlink_metadata().is_ok()
    }

    /// Returns the names of all entries of the folder, including hidden files.
    pub fn list(&self) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(self.folder.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Returns a command that runs the program here under the name `name`. Nothing depends on the place of the
    /// checkout.
    pub fn command_as(&self, name: impl AsRef<OsStr>) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fosssim-oracle"));
        command.arg0(name).current_dir(self.folder.path()).env_clear().env("TMPDIR", self.folder.path());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    pub fn command(&self) -> Command {
        self.command_as("fosssim-oracle")
    }

    /// Runs the program.
    pub fn run<S: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = S>) -> Run {
        finish(self.command().args(arguments))
    }

    /// Runs the program with the given standard input.
    pub fn run_with_input<S: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = S>, input: &[u8]) -> Run {
        let mut child = self.command().args(arguments).stdin(Stdio::piped()).spawn().unwrap();
        let mut stdin = child.stdin.take().unwrap();
        let output = std::thread::scope(|scope| {
            // The program may stop reading early.
            scope.spawn(move || drop(stdin.write_all(input)));
            child.wait_with_output().unwrap()
        });
        output.into()
    }

    /// Runs the drop-in under its own name.
    pub fn original<S: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = S>) -> Run {
        finish(self.command_as("./FOSSSimOracle").args(arguments))
    }
}

/// Runs a prepared command.
pub fn finish(command: &mut Command) -> Run {
    command.output().unwrap().into()
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        Self { code: output.status.code(), stdout: output.stdout, stderr: output.stderr }
    }
}

impl Run {
    pub fn out(&self) -> String {
        String::from_utf8_lossy(&self.stdout).into_owned()
    }

    pub fn err(&self) -> String {
        String::from_utf8_lossy(&self.stderr).into_owned()
    }

    /// Returns the results of the run as one text, for snapshots.
    pub fn shown(&self) -> String {
        let code = self.code.map_or_else(|| "killed by a signal".to_owned(), |code| code.to_string());
        format!("exit code: {code}\n----- stdout -----\n{}----- stderr -----\n{}", self.out(), self.err())
    }
}

/// A scene in which a ball falls on a half-plane: two steps, with a collision in the first (the example of the format's
/// description).
pub const BOUNCE: &str = r#"<scene>
  <description text="A ball bounces."/>
  <duration time="1"/>
  <integrator type="explicit-euler" dt="0.5"/>
  <collision type="continuous-time" COR="1"/>
  <particle m="1" px="0" py="0.5" vx="0" vy="-1" fixed="0" radius="0.25"/>
  <halfplane px="0" py="0" nx="0" ny="1"/>
</scene>
"#;

/// A scene with two balls and an edge, hybrid handling and three steps.
pub const BEAM: &str = r#"<scene>
  <duration time="0.3"/>
  <integrator type="symplectic-euler" dt="0.1"/>
  <collision type="hybrid" COR="0.5" maxiters="2" k="0" thickness="0"/>
  <simplegravity fx="0" fy="-1"/>
  <particle m="1" px="-1" py="0" vx="0" vy="0" fixed="1" radius="0.1"/>
  <particle m="1" px="1" py="0" vx="0" vy="0" fixed="1" radius="0.1"/>
  <particle m="2" px="0.25" py="0.4" vx="0" vy="-2" fixed="0" radius="0.1"/>
  <edge i="0" j="1" radius="0.05"/>
</scene>
"#;

/// A scene with a drifting ball, no collision handling and four steps.
pub const DRIFT: &str = r#"<scene>
  <duration time="1"/>
  <integrator type="explicit-euler" dt="0.25"/>
  <particle m="1" px="0" py="0" vx="1" vy="0.5" fixed="0"/>
</scene>
"#;

impl Workspace {
    /// Creates a folder with `scene.xml` and its own trace `trace.bin`.
    pub fn with_trace(scene: &str) -> Self {
        let workspace = Self::new();
        workspace.write("scene.xml", scene);
        workspace.write("trace.bin", trace_of(scene));
        workspace
    }
}

/// Returns the reference trace of a scene.
pub fn trace_of(scene: &str) -> Vec<u8> {
    fosssim_oracle::suite::recording::Recording::for_scene("scene", scene.as_bytes()).unwrap().trace
}

/// Returns a scene that comes with the program.
pub fn embedded(name: &str) -> Scene {
    scene::read(name, library::find_scene(name).expect("an embedded scene")).expect("a sound scene").scene
}

/// Returns the reference trace of a scene that has already been read.
pub fn simulate(scene: &Scene) -> Vec<u8> {
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    let mut recorder = Recorder::start(Vec::new(), Layout::for_scene(scene), simulation.state());
    for _ in 0..scene.step_count() {
        simulation.step(&mut recorder).expect("a step");
    }
    recorder.finish().expect("memory").0
}
