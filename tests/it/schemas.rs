//! The schemas of JSON documents: they are generated from the types, and fit the program's output.
use super::workspace::root;
use fosssim_oracle::report::schemas;
use serde_json::Value;

/// Returns the committed schema of a command's documents.
fn committed(command: &str) -> Value {
    let path = root().join(format!("schemas/{command}.schema.json"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Reads a command's output, and checks it against the command's schema.
#[track_caller]
pub fn valid(command: &str, document: &[u8]) -> Value {
    let document: Value = serde_json::from_slice(document).expect("JSON");
    let validator = jsonschema::validator_for(&committed(command)).expect("a schema");
    let errors: Vec<String> =
        validator.iter_errors(&document).map(|error| format!("{}: {error}", error.instance_path())).collect();
    assert!(errors.is_empty(), "{errors:#?}\n{document:#}");
    document
}

#[test]
fn schemas_are_those_of_the_types() {
    let differing: Vec<&str> = schemas::all()
        .into_iter()
        .filter(|(command, schema)| committed(command) != *schema.as_value())
        .map(|(command, _)| command)
        .collect();
    assert!(
        differing.is_empty(),
        "{differing:?}: make them again by `cargo run -p fosssim-report --example schemas -- schemas`"
    );
}

/// A schema that allows everything would check nothing.
#[test]
fn documents_with_unknown_or_missing_fields_are_rejected() {
    for (command, schema) in schemas::all() {
        let validator = jsonschema::validator_for(schema.as_value()).expect("a schema");
        assert!(!validator.is_valid(&serde_json::json!({})), "{command}: fields may be missing");
        assert_eq!(schema.get("additionalProperties"), Some(&Value::Bool(false)), "{command}: fields may be added");
    }
}
