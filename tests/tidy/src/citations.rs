//! The specification that the sources cite is in `docs/spec`, and every cited section exists.
use crate::tree::{files, root, sources, text};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
};

/// Returns the sections of a document: `3` and `3.2` for headings, and `3.2` for the second numbered point of section
/// 3.
fn sections(text: &str) -> BTreeSet<String> {
    let (mut sections, mut section) = (BTreeSet::new(), String::new());
    let number = |text: &str| -> String {
        let number: String = text.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
        number.trim_end_matches('.').to_owned()
    };
    for line in text.lines() {
        if let Some(heading) = line.strip_prefix('#') {
            let found = number(heading.trim_start_matches('#').trim_start());
            if line.starts_with("## ") {
                section.clone_from(&found);
            }
            sections.insert(found);
        } else if line.starts_with(|c: char| c.is_ascii_digit()) {
            let point = number(line);
            // Some points carry their section's number, others only their own.
            sections.insert(if point.contains('.') { point } else { format!("{section}.{point}") });
        } else if let Some(more) = line.trim_start().split("; ").find_map(|part| {
            // Some lists continue within a line: "1. parse; 2. load".
            part.strip_prefix(|c: char| c.is_ascii_digit()).filter(|rest| rest.starts_with(". ")).map(|_| part)
        }) {
            sections.insert(format!("{section}.{}", number(more)));
        }
    }
    sections.remove("");
    sections
}

/// Returns the sections of the specification that a text cites, with their documents.
fn citations(text: &str, documents: &BTreeMap<String, BTreeSet<String>>) -> Vec<(String, String)> {
    let mut found = Vec::new();
    // A citation may be split over two lines of a comment.
    let text = text.replace("\n//! ", " ").replace("\n/// ", " ");
    let lower = text.to_lowercase();
    for document in documents.keys() {
        for (position, _) in lower.match_indices(document.as_str()) {
            let mut rest = text[position + document.len()..].trim_start_matches('`').trim_start();
            rest = rest.strip_prefix("sections ").or_else(|| rest.strip_prefix("section ")).unwrap_or(rest);
            let number: String = rest.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
            let number = number.trim_end_matches('.');
            if !number.is_empty() {
                found.push((document.clone(), number.to_owned()));
            }
        }
    }
    found
}

fn documents() -> BTreeMap<String, BTreeSet<String>> {
    let found = files(&root().join("docs/spec"), ".md");
    let name = |path: &Path| path.file_name().expect("a name").to_string_lossy().into_owned();
    found.iter().filter(|path| name(path) != "README.md").map(|path| (name(path), sections(&text(path)))).collect()
}

#[test]
fn sections_are_headings_and_numbered_points() {
    let text = "# T\n## 1. One\n1. first\n2. second\n## 2. Two\n2.1 **a point**\n### 2.2 Heading\n";
    assert_eq!(sections(text).into_iter().collect::<Vec<_>>(), ["1", "1.1", "1.2", "2", "2.1", "2.2"]);
    let documents = BTreeMap::from([("a.md".to_owned(), sections(text))]);
    assert_eq!(citations("//! see A.md section 2.2.\n// a.md 7", &documents).len(), 2);
}

#[test]
fn every_section_that_the_sources_cite_exists() {
    let documents = documents();
    assert_eq!(documents.len(), 7, "{:?}", documents.keys());
    let (mut missing, mut seen) = (BTreeSet::new(), 0);
    for source in sources().iter().filter(|path| !path.ends_with("tests/tidy/src/citations.rs")) {
        for (document, section) in citations(&text(source), &documents) {
            seen += 1;
            if !documents[&document].contains(&section) {
                missing.insert(format!("{} cites {document} {section}", source.display()));
            }
        }
    }
    assert!(seen > 150, "only {seen} citations were recognized: the test no longer understands the sources");
    assert!(missing.is_empty(), "sections that do not exist:\n{missing:#?}");
}
