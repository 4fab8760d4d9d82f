//! The boundaries between the project's modules, as in the module table of ARCHITECTURE.md. Between crates the compiler
//! enforces them, because the manifests list no more dependencies than the table allows. Between the modules of one
//! crate this test reads the imports.
use crate::{
    manifests::{Package, packages},
    tree::{files, name, root, text},
};
use std::path::PathBuf;

/// A row of the table in ARCHITECTURE.md: a module, its layer, and the folder of its crate.
struct Room {
    layer: usize,
    name: String,
    folder: PathBuf,
}

/// Reads the table of modules.
fn rooms() -> Vec<Room> {
    let page = text(&root().join("ARCHITECTURE.md"));
    let row = |line: &str| -> Option<Room> {
        let cells: Vec<&str> = line.split('|').map(|cell| cell.trim().trim_matches('`')).collect();
        let [_, layer, name, folder, ..] = cells[..] else { return None };
        let layer = layer.parse().ok()?;
        // One cell names both the program's own package and Python's.
        let folder = if folder == "src" { root().to_owned() } else { root().join(folder) };
        Some(Room { layer, name: name.to_owned(), folder })
    };
    page.lines().filter_map(row).collect()
}

/// Returns the first segments after every `crate::`, also those of a group `crate::{a::b, c}`.
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
fn packages_ask_only_for_what_lies_below_them() {
    let (packages, rooms) = (packages(), rooms());
    let (mut wrong, mut seen) = (Vec::new(), 0);
    let layers_of = |package: &Package| -> Vec<usize> {
        rooms.iter().filter(|room| room.folder == package.folder).map(|room| room.layer).collect()
    };
    for package in packages.iter().filter(|package| package.name != "tidy") {
        let Some(lowest) = layers_of(package).into_iter().min() else {
            wrong.push(format!("{} is missing in the map", package.name));
            continue;
        };
        for used in package.dependencies().iter().filter_map(|name| name.strip_prefix("fosssim-")) {
            seen += 1;
            let used = packages.iter().find(|package| package.name == used).expect("a package of ours");
            if layers_of(used).into_iter().max() >= Some(lowest) {
                wrong.push(format!("{} asks for {}", package.name, used.name));
            }
        }
    }
    assert!(seen > 20, "only {seen} dependencies were recognized: the test no longer understands the manifests");
    assert!(wrong.is_empty(), "ARCHITECTURE.md's map of rooms does not have it so: {wrong:#?}");
}

#[test]
fn rooms_of_one_crate_import_only_from_lower_rooms() {
    let rooms = rooms();
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for room in &rooms {
        let beside: Vec<&Room> = rooms.iter().filter(|other| other.folder == room.folder).collect();
        let folder = room.folder.join("src").join(&room.name);
        if beside.len() < 2 || !folder.is_dir() {
            continue;
        }
        for file in files(&folder, ".rs") {
            for import in imported_modules(&text(&file)) {
                let Some(other) = beside.iter().find(|other| other.name == import) else { continue };
                seen += 1;
                if other.layer > room.layer {
                    wrong.push(format!("{} imports {import}", name(&file)));
                }
            }
        }
    }
    assert!(seen > 20, "only {seen} imports were recognized: the test no longer understands the sources");
    assert!(wrong.is_empty(), "imports that point upwards:\n{}", wrong.join("\n"));
}

/// The modules that judge and write reports also work on machines without processes and files, such as browsers.
#[test]
fn browsers_and_reports_know_no_processes() {
    let packages = packages();
    let mut wanted = vec!["browser".to_owned()];
    let mut seen = Vec::new();
    while let Some(name) = wanted.pop() {
        let package = packages.iter().find(|package| package.name == name).expect("a package");
        for line in package.built_with() {
            assert!(!["libc", "zstd", "rustix", "tempfile"].contains(&line), "{name} asks for {line}");
            wanted.extend(line.strip_prefix("fosssim-").map(str::to_owned));
        }
        seen.push(name);
    }
    let is_above = |name: &&String| ["sandbox", "files"].contains(&name.as_str());
    assert_eq!(seen.iter().find(is_above), None);
    assert!(seen.iter().any(|name| name == "num"), "{seen:?}");
}
