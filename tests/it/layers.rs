//! The walls of the house (ARCHITECTURE.md). Between crates the compiler keeps them, as far as their manifests ask for
//! no more than they should; between the rooms that share a crate this reads the imports.
use crate::tree::{files, root};

/// The crates of the house and those that each may use, lowest first.
const CRATES: [(&str, &[&str]); 19] = [
    ("num", &[]),
    ("textdiff", &[]),
    ("files", &[]),
    ("ended", &[]),
    ("sandbox", &["files", "ended"]),
    ("testing", &[]),
    ("model", &["num"]),
    ("findings", &["num", "ended", "model"]),
    ("judge", &["num", "model", "findings"]),
    ("original", &["num", "files", "model", "judge"]),
    ("mistakes", &["num", "model", "findings", "judge"]),
    ("render", &["num", "model", "judge"]),
    ("evidence", &["model", "judge", "mistakes"]),
    (
        "grading",
        &["num", "textdiff", "files", "testing", "sandbox", "model", "findings", "judge", "mistakes", "evidence"],
    ),
    // Grading is there for its tests alone (`browsers_and_reports_know_no_processes`).
    ("report", &["num", "testing", "model", "findings", "judge", "mistakes", "render", "evidence", "grading"]),
    ("browser", &["num", "model", "judge", "mistakes", "render", "evidence", "grading", "report"]),
    (
        "oracle",
        &[
            "browser", "num", "textdiff", "files", "testing", "sandbox", "model", "original", "judge", "mistakes",
            "render", "evidence", "grading", "report",
        ],
    ),
    ("lab", &["num", "model", "judge", "oracle"]),
    ("server", &["testing"]),
];

/// Rooms that share a crate, lowest first.
const ROOMS: [(&str, &[&str]); 2] = [
    ("model", &["assignments", "scene", "sim", "trace"]),
    ("mistakes", &["plain", "assignments", "student", "diagnose", "together"]),
];

/// The first segments after every `crate::`, also those of a group `crate::{a::b, c}`.
fn imported_modules(text: &str) -> Vec<String> {
    let code: String = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let mut modules = Vec::new();
    for (position, _) in code.match_indices("crate::") {
        if code[..position].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let rest = &code[position + "crate::".len()..];
        if let Some(group) = rest.strip_prefix('{') {
            let (mut depth, mut word) = (0, String::new());
            for c in group.chars() {
                match c {
                    '{' => depth += 1,
                    '}' if depth == 0 => break,
                    '}' => depth -= 1,
                    ',' if depth == 0 => modules.push(std::mem::take(&mut word)),
                    _ if depth == 0 => word.push(c),
                    _ => {}
                }
            }
            modules.push(word);
        } else {
            modules.push(rest.to_owned());
        }
    }
    let first_segment =
        |path: &String| path.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    modules.iter().map(first_segment).filter(|module| !module.is_empty()).collect()
}

#[test]
fn groups_are_read_like_single_imports() {
    let text = "use crate::{\n    num::{a, b},\n    scene::Scene,\n};\nfn f() { crate::sim::g() }\n// crate::cli\n";
    assert_eq!(imported_modules(text), ["num", "scene", "sim"]);
    assert_eq!(imported_modules("use crate::{judge, cli as c};"), ["judge", "cli"]);
}

#[test]
fn crates_ask_only_for_what_lies_below_them() {
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for (name, allowed) in CRATES {
        let folder = if name == "oracle" { root().to_owned() } else { root().join("crates").join(name) };
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).expect("a manifest");
        // The root's manifest also declares the workspace's crates: those lines have no `.workspace`.
        let used = manifest.lines().filter_map(|line| line.strip_prefix("fosssim-")?.split_once(".workspace"));
        for (used, _) in used {
            seen += 1;
            if !allowed.contains(&used) {
                wrong.push(format!("{name} asks for {used}"));
            }
        }
    }
    assert!(seen > 20, "only {seen} dependencies were recognised: the test no longer understands the manifests");
    assert!(wrong.is_empty(), "{wrong:#?}");
    let listed = std::fs::read_dir(root().join("crates")).expect("crates").count();
    assert_eq!(listed + 1, CRATES.len(), "a crate is missing in this test's list");
}

#[test]
fn rooms_of_one_crate_import_only_from_lower_rooms() {
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for (name, rooms) in ROOMS {
        for (own, room) in rooms.iter().enumerate() {
            for file in files(&root().join("crates").join(name).join("src").join(room), ".rs") {
                for import in imported_modules(&std::fs::read_to_string(&file).expect("source text")) {
                    let Some(other) = rooms.iter().position(|room| *room == import) else { continue };
                    seen += 1;
                    if other > own {
                        wrong.push(format!("{} imports {import}", file.display()));
                    }
                }
            }
        }
    }
    assert!(seen > 20, "only {seen} imports were recognised: the test no longer understands the sources");
    assert!(wrong.is_empty(), "imports that point upwards:\n{}", wrong.join("\n"));
}

/// The rooms that judge and that write reports are good for machines without processes and files, such as a browser's.
#[test]
fn browsers_and_reports_know_no_processes() {
    let mut wanted = vec!["browser".to_owned()];
    let mut seen = Vec::new();
    while let Some(name) = wanted.pop() {
        let manifest =
            std::fs::read_to_string(root().join("crates").join(&name).join("Cargo.toml")).expect("a manifest");
        // Packages for Linux alone are in a section of their own.
        let (built, _) = manifest.split_once("[dev-dependencies]").unwrap_or((&manifest, ""));
        let (built, _) = built.split_once("[target.").unwrap_or((built, ""));
        for line in built.lines().filter_map(|line| line.split_once(".workspace")).map(|(name, _)| name) {
            assert!(!["libc", "zstd", "rustix", "tempfile"].contains(&line), "{name} asks for {line}");
            wanted.extend(line.strip_prefix("fosssim-").map(str::to_owned));
        }
        seen.push(name);
    }
    let is_above = |name: &&String| ["sandbox", "files"].contains(&name.as_str());
    assert_eq!(seen.iter().find(is_above), None);
    assert!(seen.iter().any(|name| name == "num"), "{seen:?}");
}
