//! The licenses and minimum Rust versions of external packages, from cargo's own data.
use crate::workspace::root;
use serde_json::Value;
use std::{
    collections::{BTreeMap, BTreeSet},
    sync::OnceLock,
};

/// Programs run only on this platform. Packages for other platforms are not downloaded.
const PLATFORM: &str = "x86_64-unknown-linux-gnu";

/// Returns cargo's metadata of the packages, with their licenses.
#[expect(clippy::disallowed_types, reason = "cargo is a program")]
fn metadata() -> &'static Value {
    static METADATA: OnceLock<Value> = OnceLock::new();
    METADATA.get_or_init(|| {
        let mut cargo = std::process::Command::new(env!("CARGO"));
        cargo.args(["metadata", "--locked", "--format-version=1", "--filter-platform", PLATFORM]);
        let output = cargo.current_dir(root()).output().expect("cargo starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).expect("JSON")
    })
}

/// Returns all packages by their ids.
fn packages() -> BTreeMap<&'static str, &'static Value> {
    let packages = metadata()["packages"].as_array().expect("packages");
    packages.iter().map(|package| (string(&package["id"]), package)).collect()
}

fn string(value: &'static Value) -> &'static str {
    value.as_str().unwrap_or_default()
}

/// Returns the licenses that `deny.toml` allows. This test and cargo-deny both read them there.
fn allowed() -> BTreeSet<String> {
    let rules = std::fs::read_to_string(root().join("deny.toml")).expect("rules");
    let list =
        rules.split_once("\nallow = [").and_then(|(_, rest)| rest.split_once(']')).expect("a list of licenses").0;
    list.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Returns whether one of the choices of an SPDX expression is allowed.
fn is_allowed(expression: &str, allowed: &BTreeSet<String>) -> bool {
    // No expression in use is nested more deeply than `(A OR B) AND C`.
    let any = |group: &str| {
        let group = group.trim_matches(['(', ')', ' ']);
        group.split(" OR ").any(|license| license.split(" AND ").all(|license| allowed.contains(license)))
    };
    let expression = expression.replace(" / ", " OR ").replace('/', " OR ");
    if expression.contains('(') { expression.split(" AND ").all(any) } else { any(&expression) }
}

/// Returns the first two numbers of a version, which compare like versions.
fn version(text: &str) -> Vec<u32> {
    text.split('.').take(2).map(|part| part.parse().expect("a number")).collect()
}

#[test]
fn licenses_are_read_as_choices() {
    let allowed = ["MIT", "Zlib"].map(str::to_owned).into();
    for (expression, expected) in [
        ("MIT", true),
        ("MIT/Apache-2.0", true),
        ("GPL-3.0 OR MIT", true),
        ("GPL-3.0 AND MIT", false),
        ("(MIT OR Apache-2.0) AND Zlib", true),
        ("(MIT OR Apache-2.0) AND GPL-3.0", false),
        ("", false),
    ] {
        assert_eq!(is_allowed(expression, &allowed), expected, "{expression}");
    }
}

#[test]
fn everybody_may_use_what_is_compiled() {
    let (packages, allowed) = (packages(), allowed());
    assert!(packages.len() > 100 && !allowed.is_empty(), "{} packages, {allowed:?}", packages.len());
    let license = |package: &Value| package["license"].as_str().unwrap_or_default().to_owned();
    let refused = packages.values().filter(|package| !is_allowed(&license(package), &allowed));
    let refused: Vec<_> = refused.map(|package| format!("{} {}", package["name"], license(package))).collect();
    assert!(refused.is_empty(), "not in deny.toml: {refused:#?}");
}

/// The Rust version in a manifest can compile all dependencies.
#[test]
fn the_promised_rust_compiles_all_dependencies() {
    let packages = packages();
    let nodes = metadata()["resolve"]["nodes"].as_array().expect("nodes");
    let nodes: BTreeMap<_, _> = nodes.iter().map(|node| (string(&node["id"]), node)).collect();
    for name in ["fosssim-oracle", "fosssim-server"] {
        let (top, package) = packages.iter().find(|(_, package)| package["name"] == name).expect("a crate of ours");
        let promised = version(string(&package["rust_version"]));
        let (mut open, mut seen) = (vec![*top], BTreeSet::new());
        while let Some(id) = open.pop() {
            if !seen.insert(id) {
                continue;
            }
            let asked = string(&packages[id]["rust_version"]);
            assert!(asked.is_empty() || version(asked) <= promised, "{id} asks for {asked}, more than {name} promises");
            for dependency in nodes[id]["deps"].as_array().expect("dependencies") {
                let kinds = dependency["dep_kinds"].as_array().expect("kinds");
                if kinds.iter().any(|kind| kind["kind"] != "dev") {
                    open.push(string(&dependency["pkg"]));
                }
            }
        }
        assert!(seen.len() > 50, "{name}: {} packages", seen.len());
    }
}
