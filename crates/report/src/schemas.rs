//! The schemas of the reports in JSON. They are generated from the types of the reports.
use super::{check::CheckView, detect::DetectView, diagnosis::DiagnosisView, grade::GradeDocument};
use schemars::{JsonSchema, Schema, generate::SchemaSettings, transform::RecursiveTransform};
use serde_json::Value;

/// Returns the schemas. Each has the name of the command that writes such documents, and is stored as
/// `<command>.schema.json` in the folder `schemas`.
pub fn all() -> [(&'static str, Schema); 4] {
    [
        ("check", command_schema::<CheckView<'_>>("check --format json")),
        ("detect", command_schema::<DetectView<'_>>("detect --format json")),
        ("explain", command_schema::<DiagnosisView<'_>>("explain --format json")),
        ("grade", command_schema::<GradeDocument>("grade --format json")),
    ]
}

fn command_schema<Document: JsonSchema>(command: &str) -> Schema {
    let settings = SchemaSettings::draft2020_12().for_serialize().with_transform(RecursiveTransform(join_lines));
    let generator = settings.into_generator();
    let mut schema = generator.into_root_schema_for::<Document>();
    schema.insert("title".to_owned(), format!("fosssim-oracle {command}").into());
    schema
}

/// Joins the lines of descriptions, which are wrapped in the source code.
fn join_lines(schema: &mut Schema) {
    if let Some(Value::String(description)) = schema.get_mut("description") {
        *description = description.replace('\n', " ");
    }
}
