//! Writes the results of a grading: the requested reports, and tables and pages in a folder.
use super::pages::Pages;
use crate::{
    cli::{arguments::grade::GradeArguments as Arguments, console, output},
    files::{FilePlace, open_for_writing},
    report::{
        formats::Format,
        grade::{self, Text, TextDetail},
        line_width,
        page::Audience,
        style::Style,
    },
    suite::{Grade, SkippedEntry, catch_panic, suggestions},
};
use anyhow::{Context, Result, bail};
use rayon::prelude::*;
use std::{
    borrow::Cow,
    fs,
    io::Write,
    path::{Path, PathBuf},
};

/// The maximum width of the lines in class.txt, in columns.
const CLASS_WIDTH: usize = 100;

/// A report that the user requested.
pub(super) struct Report {
    pub(super) format: Format,
    pub(super) name: String,
    /// The file for the report; `None` means standard output.
    pub(super) file: Option<PathBuf>,
}

/// Returns the reports that `--format` requests.
///
/// # Errors
///
/// Fails if a format is unknown, or if two reports have the same destination.
pub(super) fn read_reports(requests: &[String]) -> Result<Vec<Report>> {
    let mut reports = Vec::new();
    for request in requests {
        let (name, file) = match request.split_once('=') {
            Some((name, file)) => (name, Some(PathBuf::from(file))),
            None => (request.as_str(), None),
        };
        let Some(format) = Format::from_name(name) else {
            let format_names: Vec<_> = Format::ALL.iter().map(|format| format.name()).collect();
            bail!(
                "there is no format {name}; the formats are {}{}",
                format_names.join(", "),
                suggestions::suggest(name, format_names.iter().copied())
            );
        };
        reports.push(Report { format, name: name.to_owned(), file });
    }
    if reports.is_empty() {
        reports.push(Report { format: Format::Text, name: "text".to_owned(), file: None });
    }
    if reports.iter().filter(|report| report.file.is_none()).count() > 1 {
        bail!("only one format can go to standard output; give the others a file: --format NAME=FILE");
    }
    let path = |file: &PathBuf| file.canonicalize().or_else(|_| std::path::absolute(file)).unwrap_or(file.clone());
    let files: Vec<PathBuf> = reports.iter().filter_map(|report| report.file.as_ref()).map(path).collect();
    if let Some((_, twice)) = files.iter().enumerate().find(|(number, file)| files[..*number].contains(file)) {
        bail!("two formats have the same file, {}; give each its own", twice.display());
    }
    Ok(reports)
}

/// Rejects formats that hold only one submission if there are several submissions.
///
/// # Errors
///
/// Fails if such a format was requested. For HTML, `html_hint` is added to the message.
pub(super) fn reject_several(reports: &[Report], submissions: usize, html_hint: &str) -> Result<()> {
    match reports.iter().find(|report| submissions > 1 && !report.format.takes_several()) {
        Some(Report { format, name, .. }) => {
            let hint = if *format == Format::Html { html_hint } else { "" };
            bail!("--format {name} is for one submission, but there are {submissions}{hint}")
        }
        None => Ok(()),
    }
}

/// Returns the pages of a grading; `None` if neither the folder for results nor a report contains pages.
///
/// # Errors
///
/// Fails if their folder can't be created.
pub(super) fn find_requested_pages(
    arguments: &Arguments,
    folder: Option<&Path>,
    is_class: bool,
    reports: &[Report],
) -> Result<Option<Pages>> {
    let is_asked = arguments.staff_page.is_some()
        || arguments.published_page.is_some()
        || reports.iter().any(|report| report.format == Format::Html);
    // Student pages of a class may be requested later, without grading it again. They are therefore always prepared.
    let for_students = arguments.reader == Audience::Student || is_class;
    (folder.is_some() || is_asked).then(|| Pages::new(folder, for_students)).transpose()
}

/// The results of a grading, and the places to which they are written.
pub(super) struct Results<'a> {
    /// The folder for results; `None` if there is none.
    pub(super) folder: Option<&'a Path>,
    pub(super) pages: Option<&'a Pages>,
    /// The reader of the reports. The files in the folder are for staff, except for the pages in students/.
    pub(super) reader: Audience,
    /// Whether the platform that requests the report itself hides the hidden groups from students.
    pub(super) platform_hides: bool,
    /// The file for a page that shows everything to staff; `None` if it was not requested.
    pub(super) staff_page: Option<&'a Path>,
    /// The file for the page that students see after the hidden groups are published; `None` if it was not requested.
    pub(super) published_page: Option<&'a Path>,
    /// Whether the user left out scenes of the suite.
    pub(super) is_part: bool,
    pub(super) grades: &'a [Grade],
    /// The skipped entries, which are not submissions.
    pub(super) skipped: &'a [SkippedEntry],
}

impl Results<'_> {
    /// Writes the reports and the files in the folder. `text` renders the report for a terminal.
    ///
    /// # Errors
    ///
    /// Fails if a file can't be written. The other files are still written, and the first error is returned.
    pub(super) fn write(&self, reports: &[Report], text: impl Fn(&[Grade]) -> String) -> Result<()> {
        let (grades, skipped) = (self.grades, self.skipped);
        // If one file cannot be written, the other files are still written.
        let mut wrong = None;
        let mut keep = |result: Result<()>| drop(result.map_err(|error| wrong.get_or_insert(error).to_string()));
        if self.is_part && self.folder.is_some() {
            console::print_error("only a part was graded, so grades.csv and the other tables are not changed\n");
        } else if let Some(folder) = self.folder {
            let by_submission = || grade::csv_of_submissions(grades, skipped);
            let by_scene = || Format::Csv.render_class(grades, skipped);
            let lines = || grade::json_lines(grades, skipped);
            let class = || {
                let missing = grade::list_not_graded(grades, skipped, Style::Plain);
                line_width::wrap(&(grade::render_class(grades, usize::MAX, Style::Plain) + &missing), CLASS_WIDTH)
            };
            let tables: [(&str, &(dyn Fn() -> String + Sync)); 4] = [
                ("grades.csv", &by_submission),
                ("scenes.csv", &by_scene),
                ("grades.jsonl", &lines),
                ("class.txt", &class),
            ];
            // All cores are used, because this takes long for a large class.
            let written = tables.par_iter().take(if grades.len() > 1 { 4 } else { 3 });
            let write_tables = || written.map(|(name, text)| write_in(folder, name, text)).collect::<Vec<_>>();
            let write_pages =
                |pages: &Pages| catch_render_panic("the pages", || pages.write(grades, skipped, self.reader));
            let (tables, first) = rayon::join(write_tables, || self.pages.map_or(Ok(Ok(None)), write_pages));
            tables.into_iter().for_each(&mut keep);
            keep(first.and_then(|first| first).map(|first| {
                if let Some(first) = first {
                    console::print_remark(format!("open in a browser: {}\n", first.display()));
                }
            }));
        }
        if let (Some(file), Some(pages), [grade]) = (self.staff_page, self.pages, grades) {
            keep(write(file, || pages.render_grade(grade, None, Audience::Staff)));
        }
        if let (Some(file), Some(pages), [grade]) = (self.published_page, self.pages, grades)
            && !grade.is_visible()
        {
            keep(write(file, || pages.render_grade(&grade.with_hidden_published(), None, Audience::Student)));
        }
        for report in reports {
            let visible_grades = self.visible_grades(report.format);
            let grades = visible_grades.as_ref();
            let render = || match (report.format, self.pages, grades) {
                (Format::Html, Some(pages), [grade]) => pages.render_grade(grade, None, self.reader),
                _ => report.format.render_class(grades, skipped),
            };
            match (&report.file, report.format) {
                (None, Format::Text) => {
                    keep(catch_render_panic("the report", || text(grades)).and_then(|text| console::report(&text)));
                }
                (None, _) => {
                    keep(catch_render_panic("the report", render).and_then(|text| console::print(text.as_bytes())))
                }
                (Some(file), Format::Markdown) if is_step_summary(file) => keep(append(file, render)),
                (Some(file), format) => keep(write(file, render).map(|()| {
                    if format == Format::Html && reports.iter().all(|report| report.file.is_some()) {
                        let verdict = Text { detail: TextDetail::Line, ..Text::default() };
                        console::print_remark(verdict.render(grades));
                    }
                    output::print_path(file, format == Format::Html);
                })),
            }
        }
        match wrong {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }
}

impl<'a> Results<'a> {
    /// Returns the part of the grades that this format shows to the reader.
    fn visible_grades(&self, format: Format) -> Cow<'a, [Grade]> {
        let visible_part = |grade: &'a Grade| format.visible_part(grade, self.reader, self.platform_hides);
        if self.grades.iter().all(|grade| matches!(visible_part(grade), Cow::Borrowed(_))) {
            return Cow::Borrowed(self.grades);
        }
        Cow::Owned(self.grades.iter().map(|grade| visible_part(grade).into_owned()).collect())
    }
}

/// Returns whether a file is the summary of a GitHub job, to which the steps of the job append.
fn is_step_summary(file: &Path) -> bool {
    std::env::var_os("GITHUB_STEP_SUMMARY").is_some_and(|summary| Path::new(&summary) == file)
}

/// Renders a text and appends it to a file.
fn append(file: &Path, text: impl FnOnce() -> String) -> Result<()> {
    let text = catch_render_panic(&file.display().to_string(), text)?;
    let opened = open_for_writing(fs::OpenOptions::new().create(true).append(true), file);
    let written = opened.and_then(|mut file| file.write_all(text.as_bytes()));
    written.with_context(|| format!("cannot write {}", file.display()))
}

/// Renders a text and writes it to a file.
fn write(file: &Path, text: impl FnOnce() -> String) -> Result<()> {
    let text = catch_render_panic(&file.display().to_string(), text)?;
    output::write(file, text.as_bytes())
}

/// Renders a text and writes it to a file in the folder for results.
fn write_in(folder: &Path, name: &str, text: impl FnOnce() -> String) -> Result<()> {
    let place = FilePlace::new(folder, name);
    let text = catch_render_panic(&place.path().display().to_string(), text)?;
    output::write_below(&place, text.as_bytes())
}

/// Calls `text` and returns its result. If it panics, returns an error.
fn catch_render_panic<T>(name: &str, text: impl FnOnce() -> T) -> Result<T> {
    catch_panic(text).map_err(|fault| anyhow::anyhow!("{name} could not be made: {fault}; please report this"))
}
