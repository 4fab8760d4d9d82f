//! Every format: against its schema, and as a snapshot that people read.
use super::{Format, csv_of_submissions, json_line, samples};
use crate::suite::Grade;
use std::path::Path;

fn all() -> [Grade; 3] {
    [samples::good(), samples::bad(), samples::fault()]
}

fn schema(name: &str) -> serde_json::Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).expect("a schema")).expect("JSON")
}

fn assert_valid(name: &str, document: &str) {
    let document: serde_json::Value = serde_json::from_str(document).expect("JSON");
    if let Err(error) = jsonschema::validate(&schema(name), &document) {
        panic!("{name}: {error}\n{document:#}");
    }
}

/// No control character but line break and tab, whatever a program or a name holds.
fn assert_harmless(document: &str) {
    let bad: Vec<char> = document.chars().filter(|c| c.is_control() && !matches!(c, '\n' | '\t' | '\r')).collect();
    assert!(bad.is_empty(), "{bad:?} in\n{document}");
    assert!(!document.contains('\u{202e}'));
}

#[test]
fn nothing_hostile_gets_through_any_format() {
    for (format, name) in Format::ALL {
        for grade in all() {
            let document = format.render(std::slice::from_ref(&grade));
            assert_harmless(&document);
            assert!(!document.is_empty() || name == "github", "{name}");
        }
    }
    assert_harmless(&csv_of_submissions(&all()));
    let annotations = Format::Github.render(&[samples::bad()]);
    assert!(annotations.lines().all(|line| line.starts_with("::error ") || line.starts_with("::warning ")));
    let csv = Format::Csv.render(&all());
    assert!(!csv.contains(",=") && !csv.contains("\n="), "{csv}");
}

#[test]
fn json_follows_its_schema() {
    assert_valid("grade.schema.json", &Format::Json.render(&all()));
    insta::assert_snapshot!("grade_json", Format::Json.render(&all()).replace(env!("CARGO_PKG_VERSION"), "VERSION"));
    assert_eq!(json_line(&samples::good()).lines().count(), 1);
}

#[test]
fn gradescope_follows_its_schema() {
    for grade in all() {
        assert_valid("gradescope.schema.json", &Format::Gradescope.render(&[grade]));
    }
    let document: serde_json::Value =
        serde_json::from_str(&Format::Gradescope.render(&[samples::fault()])).expect("JSON");
    assert!(document.get("score").is_none(), "a fault of ours is nobody's zero");
    insta::assert_snapshot!(
        "grade_gradescope",
        Format::Gradescope.render(&[samples::bad()]).replace(env!("CARGO_PKG_VERSION"), "VERSION")
    );
}

#[test]
fn prairielearn_follows_its_schema() {
    for grade in all() {
        assert_valid("prairielearn.schema.json", &Format::Prairielearn.render(&[grade]));
    }
    let document: serde_json::Value =
        serde_json::from_str(&Format::Prairielearn.render(&[samples::fault()])).expect("JSON");
    assert_eq!(document["gradable"], false);
    insta::assert_snapshot!("grade_prairielearn", Format::Prairielearn.render(&[samples::bad()]));
}

#[test]
fn junit_follows_its_schema() {
    let document = Format::Junit.render(&all());
    insta::assert_snapshot!("grade_junit", document);
    let folder = tempfile::tempdir().expect("folder");
    let file = folder.path().join("junit.xml");
    std::fs::write(&file, &document).expect("written");
    let schema = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/junit.xsd");
    match std::process::Command::new("xmllint").arg("--noout").arg("--schema").arg(schema).arg(&file).output() {
        Ok(output) => assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr)),
        Err(error) => eprintln!("skipped: xmllint is not here ({error})"),
    }
}

#[test]
fn text_csv_and_github_read_well() {
    insta::assert_snapshot!("grade_text", Format::Text.render(&all()));
    insta::assert_snapshot!("grade_csv", Format::Csv.render(&all()));
    insta::assert_snapshot!("grade_submissions_csv", csv_of_submissions(&[samples::good(), samples::good()]));
    insta::assert_snapshot!("grade_github", Format::Github.render(&all()));
    insta::assert_snapshot!("grade_markdown", Format::Markdown.render(&all()));
}
