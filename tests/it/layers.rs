//! The walls of the house: a module imports only from lower layers (ARCHITECTURE.md).
use std::path::{Path, PathBuf};

/// Lowest first; modules of one line stand on one layer and must not see each other.
const LAYERS: [&[&str]; 9] = [
    &["num"],
    &["scene"],
    &["sim"],
    &["trace", "student"],
    &["judge", "sandbox"],
    &["diagnose"],
    &["suite"],
    &["report"],
    &["cli"],
];

fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|modules| modules.contains(&module))
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("source folder").map(|entry| entry.expect("entry").path()) {
        if entry.is_dir() {
            rust_files(&entry, found);
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            found.push(entry);
        }
    }
}

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
fn modules_import_only_from_lower_layers() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    rust_files(&source, &mut files);
    let mut wrong = Vec::new();
    let mut seen = 0;
    for file in files {
        let relative = file.strip_prefix(&source).expect("below src");
        let module = relative.components().next().expect("a name").as_os_str().to_string_lossy().replace(".rs", "");
        let Some(own) = layer(&module) else {
            assert!(matches!(module.as_str(), "lib" | "main" | "bin"), "{module} has no layer: add it to the list");
            continue;
        };
        for import in imported_modules(&std::fs::read_to_string(&file).expect("source text")) {
            let Some(other) = layer(&import) else { continue };
            seen += 1;
            if other > own || (other == own && import != module) {
                wrong.push(format!("{} imports {import}", relative.display()));
            }
        }
    }
    assert!(seen > 20, "only {seen} imports were recognised: the test no longer understands the sources");
    assert!(wrong.is_empty(), "imports that point upwards or sideways:\n{}", wrong.join("\n"));
}
