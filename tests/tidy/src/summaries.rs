//! The first words of doc comments: the summary of a function begins with a verb, and every description has a subject.
use crate::{
    ratchets::function,
    tree::{is_of_tests, name, sources, text},
};

/// Words, such as plurals, that end like verbs.
const NO_VERBS: [&str; 9] =
    ["This", "Its", "As", "Always", "Lines", "Words", "Sentences", "Insertions", "Explanations"];

/// Beginnings that depend on an earlier sentence. Schemas and the API's description are generated from these comments.
const WITHOUT_SUBJECT: [&str; 8] = ["The same", "It", "Its", "They", "Their", "Nor", "Of", "So"];

/// Returns whether a summary begins with a verb in the third person.
fn begins_with_verb(summary: &str) -> bool {
    let first = summary.split(|c: char| !c.is_ascii_alphabetic()).next().unwrap_or_default();
    first.starts_with(|c: char| c.is_ascii_uppercase()) && first.ends_with('s') && !NO_VERBS.contains(&first)
}

/// Returns whether a description cannot be understood on its own.
fn lacks_subject(summary: &str) -> bool {
    let is_cut = |rest: &str| !rest.starts_with(char::is_alphanumeric);
    WITHOUT_SUBJECT.iter().any(|words| summary.strip_prefix(words).is_some_and(is_cut))
}

/// Returns the first lines of doc comments outside tests, each with the line of code after the comment and its
/// attributes.
fn summaries(text: &str) -> Vec<(&str, &str)> {
    let lines: Vec<&str> = text.lines().map(str::trim_start).collect();
    let is_doc = |index: usize| lines.get(index).is_some_and(|line| line.starts_with("///"));
    let begins = |&index: &usize| is_doc(index) && (index == 0 || !is_doc(index - 1));
    let found = (0..lines.len()).filter(begins).filter_map(|begin| {
        let code = lines[begin..].iter().skip_while(|line| line.starts_with("///"));
        let is_attribute = |line: &&str| line.starts_with("#[") && line.ends_with(']') && *line != "#[test]";
        let code = code.copied().find(|line| !is_attribute(line)).unwrap_or_default();
        (code != "#[test]").then(|| (lines[begin].trim_start_matches('/').trim_start(), code))
    });
    found.collect()
}

/// Returns the failing summaries of all sources except tests, with the names of their files.
fn failing(fails: impl Fn(&str, &str) -> bool) -> Vec<String> {
    let mut all = Vec::new();
    for source in sources().iter().filter(|source| !is_of_tests(name(source))) {
        let text = text(source);
        let found = summaries(&text).into_iter().filter(|(summary, code)| fails(summary, code));
        all.extend(found.map(|(summary, _)| format!("{}: {summary}", name(source))));
    }
    all
}

#[test]
fn summaries_are_distinguished() {
    let text = "/// Returns one.\n/// More.\n#[must_use]\npub fn one() {}\n\n    /// The same in short.\n    two: u8,\n\
                /// A test.\n#[test]\nfn a()";
    let found = [("Returns one.", "pub fn one() {}"), ("The same in short.", "two: u8,")];
    assert_eq!(summaries(text), found);
    assert_eq!(["Returns one.", "As one.", "The one.", "`one`."].map(begins_with_verb), [true, false, false, false]);
    assert_eq!(
        ["It is.", "Its name.", "Items.", "Offers.", "The same."].map(lacks_subject),
        [true, true, false, false, true]
    );
}

#[test]
fn functions_are_described_by_verbs() {
    let without = failing(|summary, code| function(code).is_some() && !begins_with_verb(summary));
    assert!(without.is_empty(), "begin with a verb, as `Returns ...`: {without:#?}");
}

#[test]
fn descriptions_can_be_read_alone() {
    let without = failing(|summary, _| lacks_subject(summary));
    assert!(without.is_empty(), "name the subject: {without:#?}");
}
