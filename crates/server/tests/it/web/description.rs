//! Tests that the description of the API is consistent: it satisfies a validator, and states the rights for each
//! operation.
use super::roles::{For, ROUTES};
use fosssim_server::web;
use serde_json::{Map, Value};
use std::collections::BTreeSet;

fn description() -> Value {
    serde_json::from_str(&web::openapi()).expect("JSON")
}

/// Returns every operation, with its method and path.
fn operations(api: &Value) -> impl Iterator<Item = (&str, &str, &Value)> {
    let paths = api["paths"].as_object().expect("paths").iter();
    paths.flat_map(|(path, item)| {
        item.as_object().expect("operations").iter().map(|(method, of)| (method.as_str(), path.as_str(), of))
    })
}

/// Collects every value with this name, at any depth.
fn all<'a>(value: &'a Value, name: &str, found: &mut Vec<&'a Value>) {
    match value {
        Value::Object(fields) => {
            found.extend(fields.get(name));
            fields.values().for_each(|value| all(value, name, found));
        }
        Value::Array(values) => values.iter().for_each(|value| all(value, name, found)),
        _ => {}
    }
}

#[test]
fn every_operation_is_described_to_the_end() {
    let api = description();
    let mut ids = BTreeSet::new();
    for (method, path, operation) in operations(&api) {
        assert!(operation["summary"].is_string(), "{method} {path} has no summary");
        assert!(ids.insert(operation["operationId"].as_str().expect("a name")), "{method} {path}: a name twice");
        let tag = operation["tags"][0].as_str().expect("a tag");
        let tags = api["tags"].as_array().expect("tags");
        assert!(tags.iter().any(|known| known["name"] == tag), "{method} {path}: {tag} is not described");
        for (status, response) in operation["responses"].as_object().expect("responses") {
            let text = response["description"].as_str().unwrap_or_default();
            assert!(!text.is_empty(), "{method} {path}: {status} has no description");
        }
        // Parameters in braces are described, and no others are.
        let parameters: Vec<&Value> = operation["parameters"].as_array().into_iter().flatten().collect();
        for parameter in &parameters {
            assert!(parameter["description"].is_string(), "{method} {path}: {parameter}");
        }
        let described: BTreeSet<&str> = parameters
            .iter()
            .filter(|parameter| parameter["in"] == "path" && parameter["required"] == true)
            .filter_map(|parameter| parameter["name"].as_str())
            .collect();
        let named: BTreeSet<&str> =
            path.split('/').filter_map(|part| part.strip_prefix('{')?.strip_suffix('}')).collect();
        assert_eq!(described, named, "{method} {path}");
        if let Some(body) = operation["requestBody"]["content"].as_object() {
            for (kind, content) in body {
                let schema = &content["schema"];
                let is_told = schema["$ref"].is_string() || schema["format"] == "binary" || kind == "text/csv";
                assert!(is_told, "{method} {path}: {kind} {schema}");
            }
        }
    }
}

#[test]
fn whatever_is_referred_to_is_there() {
    let api = description();
    let mut found = Vec::new();
    all(&api, "$ref", &mut found);
    assert!(found.len() > 50);
    for reference in found {
        let place = reference.as_str().and_then(|text| text.strip_prefix('#')).expect("a place in this document");
        assert!(api.pointer(place).is_some(), "{reference}");
    }
    let schemas = api["components"]["schemas"].as_object().expect("schemas");
    for (name, schema) in schemas {
        let mut bare = Vec::new();
        all(schema, "properties", &mut bare);
        for field in bare.into_iter().filter_map(Value::as_object).flat_map(Map::iter) {
            assert_ne!(field.1, &serde_json::json!({"type": "object"}), "{name}.{} says nothing", field.0);
        }
    }
}

#[test]
fn it_says_who_gets_in() {
    let api = description();
    let schemes = api["components"]["securitySchemes"].as_object().expect("schemes");
    let routes = ROUTES.iter().filter(|(_, path, _)| !api["paths"][*path].is_null());
    for (method, path, whom) in routes {
        let security = api["paths"][*path][*method]["security"].as_array().expect("security");
        let names: Vec<&str> =
            security.iter().flat_map(|way| way.as_object().expect("a way")).map(|(name, _)| name.as_str()).collect();
        assert!(names.iter().all(|name| schemes.contains_key(*name)), "{method} {path}: {names:?}");
        match whom {
            For::All => assert!(names.is_empty(), "{method} {path}: {names:?}"),
            For::Workers => assert_eq!(names, ["worker"], "{method} {path}"),
            // Tokens have fewer rights than a person at a browser.
            _ => assert!(names.contains(&"session") && !names.contains(&"worker"), "{method} {path}: {names:?}"),
        }
    }
}
