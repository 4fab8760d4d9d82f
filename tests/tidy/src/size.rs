//! The number of lines of code of each crate may only fall. A change that raises one of them states here what it
//! removed instead.
use crate::tree::{crate_of, is_of_tests, name, sources, text};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
};

/// The maximum number of lines of code of each crate, and of the program (`src`), in hundreds: without tests, comments
/// and blank lines. Crates that are not listed may contain no code.
// Names of functions became verbs, and names of constants say what they limit, so more calls take two lines.
const HUNDREDS: [(&str, usize); 22] = [
    ("browser", 10),
    ("build.rs", 1),
    ("ended", 2),
    ("evidence", 9),
    ("examples", 2),
    ("files", 6),
    // Changes since an earlier grading are values here; the comparison in `report` for --watch went.
    ("findings", 28),
    // The main thread's share of a grading went to the jobs; `--timings` says where a grading's time goes.
    // `smallest` runs programs for `shrink`, which is new; nothing was removed for it.
    // A course's own words on mistakes and groups.
    ("grading", 50),
    ("intake", 5),
    ("judge", 46),
    // Two tools became tests.
    ("lab", 5),
    // The worth of a mistake, and the smallest scenes that students see; nothing was removed for them here. Names that
    // exclude each other, and guesses that other traces contradict, are not reported; nothing was removed for it.
    // Pairs that a program leaves out, and faults that traces share; nothing was removed for them.
    // Wrong radii are reported by their values; nothing was removed for that.
    // Wrong states name the part of the student's code; the table of causes of each milestone went.
    ("mistakes", 68),
    // The least work of Newton's iterations; the search for nearby pairs without a contest went.
    ("model", 87),
    // The sparse least squares came out of `mistakes`.
    ("num", 38),
    ("original", 9),
    ("render", 17),
    // The class page has filters; the second figures, the second list of mistakes and the table of the rest went.
    // Smallest scenes in all reports; their own type went. Formulas have Unicode's signs; nothing went instead. Pages
    // are templates. The step by hand; the templates of pages took 400 lines before. Impulses, rigid motions, systems
    // and penalty by hand; drawn scenes and the second thread of `shrink`, and a shell quoter went. Formulas and
    // letters by hand; tables of units in `shrink` went.
    ("report", 78),
    ("sandbox", 57),
    // Extensions, removals and imports are not overwritten unseen, and uploads wait at a deadline; nothing went
    // instead. Classes have filters and equal programs, submissions a comparison, CSV points of groups, suites names;
    // the text of reports in pages, and the statement for changes between attempts went. Sign-in at a provider is new;
    // passwords went, with their digests and limits. Verdicts have words everywhere, and the home page and the log have
    // links; the list of verdicts in a template and the search for members in SQL went. A worker on the server's
    // machine gets its token by itself, and waiting has a reason; nothing went instead. Reports can have smallest
    // scenes; two searches of `shrink` for the same scene went.
    // The page for submitting lists groups of uploaded suites; the flag of suites that hide groups went.
    ("server", 157),
    ("shrink", 5),
    // The table of `--timings`.
    // The command `shrink`.
    // Defaults of a folder, the earlier grading and gzip; the comparison of --watch went.
    // Shells complete names; the static scripts, --sample and the sample's own search for names went.
    ("src", 63),
    // Came out of `mistakes`. Mistakes that new programs of students made; nothing was removed for them.
    ("student", 57),
];

/// Returns whether a line is an attribute of an item for tests.
fn is_for_tests(line: &str) -> bool {
    line.starts_with("#[cfg(test)]") || line.starts_with("#[cfg(all(test,")
}

/// Returns the modules that a file declares only for tests.
fn test_modules(text: &str) -> impl Iterator<Item = &str> {
    let lines = text.lines().zip(text.lines().skip(1));
    let declared = lines.filter(|(attribute, _)| is_for_tests(attribute)).map(|(_, line)| line);
    declared.filter_map(|line| line.strip_suffix(';')?.rsplit_once("mod ").map(|(_, module)| module))
}

/// Returns the number of lines of code of a file, without its items for tests. rustfmt indents the end of an item like
/// its beginning.
fn code(text: &str) -> usize {
    let mut count = 0;
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let body = line.trim_start();
        if is_for_tests(body) {
            let indent = &line[..line.len() - body.len()];
            let mut is_begun = false;
            let mut ends = |line: &str| {
                let Some(rest) = line.strip_prefix(indent).filter(|rest| !rest.starts_with([' ', '#', '/'])) else {
                    return false;
                };
                let is_end = rest.ends_with([';', '}']) || (is_begun && rest.ends_with(','));
                is_begun = true;
                is_end
            };
            lines.by_ref().find(|line| ends(line));
        } else if !body.is_empty() && !body.starts_with("//") {
            count += 1;
        }
    }
    count
}

/// Returns the number of lines of code of each crate.
fn sizes() -> BTreeMap<String, usize> {
    let sources = sources();
    let mut of_tests = BTreeSet::new();
    for source in &sources {
        let folder = match source.file_name().and_then(|name| name.to_str()) {
            Some("mod.rs" | "lib.rs" | "main.rs") => source.parent().expect("a folder").to_owned(),
            _ => source.with_extension(""),
        };
        of_tests.extend(test_modules(&text(source)).map(|module| folder.join(module)));
    }
    let is_of_test_module = |path: &Path| path.ancestors().any(|part| of_tests.contains(&part.with_extension("")));
    let mut sizes = BTreeMap::new();
    for source in sources.iter().filter(|source| !is_of_tests(name(source)) && !is_of_test_module(source)) {
        *sizes.entry(crate_of(name(source)).to_owned()).or_insert(0) += code(&text(source));
    }
    sizes
}

#[test]
fn lines_for_tests_are_no_code() {
    let text = "//! A.\nuse b;\n\n#[cfg(test)]\nuse c::{\n    d,\n};\n\nfn e() {\n    f() // g\n}\n\n#[cfg(test)]\nmod \
                tests {\n    use super::*;\n}\n#[cfg(test)]\nmod samples;\nconst H: u8 = 0;\n";
    assert_eq!((code(text), test_modules(text).collect::<Vec<_>>()), (5, vec!["samples"]));
}

#[test]
fn no_crate_grows() {
    let sizes = sizes();
    let max_hundreds: BTreeMap<&str, usize> = HUNDREDS.into_iter().collect();
    let grown: Vec<_> = sizes
        .iter()
        .filter(|(name, lines)| **lines > 100 * max_hundreds.get(name.as_str()).unwrap_or(&0))
        .map(|(name, lines)| format!("{name}: {lines} lines"))
        .collect();
    assert!(grown.is_empty(), "remove something, or raise the number and say what was removed instead: {grown:#?}");
}
