//! The command line: that of the course's program, and what is our own.
use std::path::{Path, PathBuf};

use clap::Parser;
use fosssim_oracle::{
    pin,
    student::{self, CATALOGUE, Mistake, Student},
};

/// The environment variable that names a mistake.
const VARIABLE: &str = "FOSSSIM_SAMPLE_MISTAKE";

/// Where a mistake is pinned to a copy of this program: nothing else is asked then.
static PINNED: pin::Place = pin::empty();

/// A copy or link of the program with this prefix makes the mistake that follows it.
const NAME_PREFIX: &str = "fosssim-sample.";

/// A sample submission: simulates a scene as a student's program would, with one documented mistake if asked for.
#[derive(Debug, Parser)]
#[command(
    name = "fosssim-sample",
    version,
    after_help = "The mistake may also be given by the environment variable FOSSSIM_SAMPLE_MISTAKE, or by a copy or \
                  link of this program that is called fosssim-sample.ID. --mistake wins over the name, the name over \
                  the variable. `fosssim-oracle demo --program FILE` writes a copy that makes its mistake in any case.\n\nExit status: 0 done, 1 it could not be done, 2 usage, 3 the course's program would \
                  never have ended here."
)]
struct Typed {
    /// The scene, an XML file.
    #[arg(short, long, required_unless_present = "list", value_name = "FILE")]
    scene: Option<PathBuf>,
    /// Where to write the trace, a file or a pipe. Without it nothing is saved.
    #[arg(short, long = "outputfile", value_name = "FILE")]
    output: Option<PathBuf>,
    /// Only 0 is accepted: there is no window.
    #[arg(short, long, default_value = "0", value_parser = ["0"], value_name = "0")]
    display: String,
    /// Accepted for the sake of the protocol; no effect without a window.
    #[arg(short, long, default_value = "1", value_parser = ["0", "1"], value_name = "0|1")]
    paused: String,
    /// Makes the mistake with this id.
    #[arg(long, value_name = "ID")]
    mistake: Option<String>,
    /// Lists the mistakes, with one sentence for each.
    #[arg(long)]
    list: bool,
    /// Lists them as JSON.
    #[arg(long, requires = "list")]
    json: bool,
}

/// What is to be done.
pub enum Task {
    /// Print the catalogue.
    List {
        /// As JSON.
        json: bool,
    },
    /// Simulate.
    Run(Options),
}

/// A run, validated.
pub struct Options {
    /// The scene file.
    pub scene: PathBuf,
    /// The trace file.
    pub output: Option<PathBuf>,
    /// The program's author.
    pub student: Student,
}

/// Reads the command line; on a fault of syntax the program ends with status 2.
///
/// # Errors
/// A sentence about a mistake that does not exist.
pub fn parse() -> Result<Task, String> {
    let typed = Typed::parse();
    if typed.list {
        return Ok(Task::List { json: typed.json });
    }
    let student = Student::new(mistake(typed.mistake)?);
    let Some(scene) = typed.scene else { return Err("-s is missing: name a scene file".to_owned()) };
    Ok(Task::Run(Options { scene, output: typed.output, student }))
}

/// The mistake that the command line, the program's name or the environment asks for.
fn mistake(option: Option<String>) -> Result<Option<Mistake>, String> {
    let (source, id) = if let Some(id) = pin::read(&PINNED) {
        ("this copy of the program", id.to_owned())
    } else if let Some(id) = option {
        ("--mistake", id)
    } else if let Some(id) = mistake_of_name(std::env::args_os().next().as_deref().map(Path::new)) {
        ("the program's name", id)
    } else if let Some(id) = std::env::var(VARIABLE).ok().filter(|id| !id.is_empty()) {
        (VARIABLE, id)
    } else {
        return Ok(None);
    };
    match student::find(&id) {
        Some(row) => Ok(Some(row.mistake)),
        None => Err(format!("{source} asks for the mistake '{id}', which does not exist{}", hint(&id))),
    }
}

fn mistake_of_name(program: Option<&Path>) -> Option<String> {
    let name = program?.file_name()?.to_str()?;
    name.strip_prefix(NAME_PREFIX).map(str::to_owned)
}

/// The ids that a misspelt one may have meant.
fn hint(id: &str) -> String {
    let alike: Vec<&str> =
        CATALOGUE.iter().map(|row| row.id).filter(|known| known.contains(id) || id.contains(known)).take(5).collect();
    if alike.is_empty() {
        "; fosssim-sample --list shows all".to_owned()
    } else {
        format!("; did you mean {}?", alike.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        <Typed as clap::CommandFactory>::command().debug_assert();
    }

    #[test]
    fn a_link_may_name_the_mistake() {
        let name = |path: &str| mistake_of_name(Some(Path::new(path)));
        assert_eq!(name("bin/fosssim-sample.pp-no-two").as_deref(), Some("pp-no-two"));
        assert_eq!(name("bin/fosssim-sample"), None);
        assert_eq!(name("bin/submission"), None);
    }

    #[test]
    fn a_misspelt_mistake_is_named_with_what_comes_close() {
        let message = mistake(Some("no-two".to_owned())).unwrap_err();
        assert!(message.contains("'no-two'") && message.contains("pp-no-two"), "{message}");
    }
}
