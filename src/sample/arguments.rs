//! The command line of the sample. It has the course's arguments, and some more.
use super::pinned_mistake;
use crate::{
    student::{self, Mistake, Student, all_rows},
    suite::suggestions,
};
use clap::Parser;
use std::{
    ffi::OsString,
    path::{Path, PathBuf},
};

/// The prefix of a name. If the program is called by this prefix and the id of a mistake, it makes that mistake.
const NAME_PREFIX: &str = "fosssim-sample.";

/// The maximum number of mistakes that one program makes.
const MAX_COUNT: usize = Student::MAX_MISTAKES;

/// A sample submission. It simulates a scene as a student's program does, and makes documented mistakes on request.
#[derive(Debug, Parser)]
#[command(
    name = "fosssim-sample",
    version,
    after_help = "A copy or link of this program that is called fosssim-sample.ID makes this mistake, too, unless \
                  --mistake names another. `fosssim-oracle demo --program FILE` writes a copy that makes its mistake \
                  in any case.\n\nExit status: 0 done, 1 failed, 2 wrong usage, \
                  3 the course's program would never have ended"
)]
pub struct Options {
    /// The scene, an XML file.
    #[arg(short, long, required_unless_present = "list", value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// The file or pipe for the trace. By default no trace is written.
    #[arg(short, long = "outputfile", value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// The display; only 0 is accepted, because there is no window.
    #[arg(short, long, default_value = "0", value_parser = ["0"], value_name = "0")]
    display: String,
    /// Accepted for compatibility with the protocol; it has no effect without a window.
    #[arg(short, long, default_value = "1", value_parser = ["0", "1"], value_name = "0|1")]
    paused: String,
    /// The id of a mistake to make, or several ids separated by commas.
    #[arg(long, value_name = "ID[,ID]...")]
    mistake: Option<String>,
    /// The number of useless rounds to compute first, in millions, to simulate a slow program.
    #[arg(long, value_name = "N", default_value = "0")]
    pub busy: u32,
    /// List the mistakes, with one sentence for each.
    #[arg(long)]
    pub list: bool,
    /// List the mistakes as JSON.
    #[arg(long, requires = "list")]
    pub json: bool,
}

impl Options {
    /// Returns a student who makes the selected mistakes.
    ///
    /// # Errors
    ///
    /// Fails if there is no such mistake. The error says so in a sentence.
    pub fn choose_student(&self, pinned: Option<&str>, program: Option<&OsString>) -> Result<Student, String> {
        student_from_options(pinned, self.mistake.clone(), program.map(Path::new))
    }
}

/// Returns a student who makes the pinned mistakes. If there are none, the mistakes are those that the command line
/// or the program's name selects.
fn student_from_options(
    pinned: Option<&str>,
    option: Option<String>,
    program: Option<&Path>,
) -> Result<Student, String> {
    let (source, ids) = if let Some(id) = pinned {
        if id == pinned_mistake::RIGHT_ID {
            return Ok(Student::default());
        }
        ("this copy of the program", id.to_owned())
    } else if let Some(ids) = option {
        ("--mistake", ids)
    } else if let Some(ids) = find_mistake_in_name(program) {
        ("the program's name", ids)
    } else {
        return Ok(Student::default());
    };
    let mistakes = ids.split(',').map(|id| parse_mistake(source, id)).collect::<Result<Vec<_>, _>>()?;
    if mistakes.len() > MAX_COUNT {
        return Err(format!("{source} names {} mistakes, but at most {MAX_COUNT} can be combined", mistakes.len()));
    }
    Ok(mistakes.into_iter().fold(Student::default(), |student, mistake| student.with_mistake(Some(mistake))))
}

fn parse_mistake(source: &str, id: &str) -> Result<Mistake, String> {
    let suggest = || suggestions::suggest(id, all_rows().map(|row| row.id));
    let unknown = || format!("{source} names the mistake '{id}', which does not exist; --list shows all{}", suggest());
    student::find(id).map(|row| row.mistake).ok_or_else(unknown)
}

fn find_mistake_in_name(program: Option<&Path>) -> Option<String> {
    let name = program?.file_name()?.to_str()?;
    name.strip_prefix(NAME_PREFIX).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        <Options as clap::CommandFactory>::command().debug_assert();
    }

    #[test]
    fn a_link_may_name_the_mistake() {
        let name = |path: &str| find_mistake_in_name(Some(Path::new(path)));
        assert_eq!(name("bin/fosssim-sample.pp-no-two").as_deref(), Some("pp-no-two"));
        assert_eq!(name("bin/fosssim-sample"), None);
        assert_eq!(name("bin/submission"), None);
    }

    #[test]
    fn a_misspelt_mistake_is_named_with_what_comes_close() {
        let message = student_from_options(None, Some("no-two".to_owned()), None).unwrap_err();
        assert!(message.contains("'no-two'") && message.contains("pp-no-two"), "{message}");
    }

    #[test]
    fn several_mistakes_are_made_at_once() {
        let several = student_from_options(None, Some("pp-no-two,pe-empty,geometric-empty".to_owned()), None)
            .expect("they exist");
        for id in ["pp-no-two", "pe-empty", "geometric-empty"] {
            assert!(student::find(id).is_some_and(|row| several.makes(row.mistake)), "{id}");
        }
        let message = student_from_options(None, Some(["pp-empty"; MAX_COUNT + 1].join(",")), None).unwrap_err();
        assert!(message.contains(&format!("at most {MAX_COUNT}")), "{message}");
    }
}
