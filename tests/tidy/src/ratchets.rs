//! Numbers that may only fall. A change that reduces one of them lowers the limit here. No change may raise a limit.
use crate::tree::{crate_of, files, is_of_tests, name, root, sources, text};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

/// The width of rustfmt's code lines (`rustfmt.toml`).
const WIDTH: usize = 120;

/// The number of types whose name also occurs in a second crate.
const MOST_SHARED_NAMES: usize = 47;

/// Participles, adverbs and pronouns that do not end in `ed`. No type may have one of them as its name.
const BARE_NAMES: [&str; 33] = [
    "After", "Again", "Alive", "Alone", "Apart", "At", "Before", "Beside", "Both", "Chosen", "Common", "Done", "Drawn",
    "Exactly", "Found", "Held", "Kept", "Known", "Late", "Left", "Made", "Nearby", "Outside", "Own", "Ran", "Said",
    "Seen", "Several", "Shown", "Told", "Unknown", "Written", "Wrong",
];

/// Names of functions that are not verbs. A function's name must also not begin with `of_` or be a participle.
const VAGUE_FUNCTIONS: [&str; 5] = ["look", "of", "stand", "told", "words"];

/// A longer file has more than one purpose.
const LONGEST_FILE: usize = 600;

/// A longer function has more than one purpose.
const LONGEST_FUNCTION: usize = 80;

/// Roots of crates that contain unsafe code, each with its purpose.
const UNSAFE: [(&str, &str); 8] = [
    ("crates/browser/src/lib.rs", "a module's functions have names that the page knows"),
    ("crates/mistakes/tests/memory.rs", "counts allocations"),
    ("crates/sandbox/src/lib.rs", "makes system calls between fork and exec"),
    ("crates/server/src/lib.rs", "makes system calls"),
    ("crates/server/tests/it/main.rs", "sends signals"),
    ("tests/it/main.rs", "counts allocations, sends signals"),
    ("benches/class.rs", "asks the kernel for processor time and memory"),
    ("benches/course.rs", "asks the kernel for processor time"),
];

/// Returns the name of the function that begins on a line.
pub fn function(line: &str) -> Option<&str> {
    let mut words = line.trim_start();
    while let Some((word, rest)) = words.split_once(' ') {
        match word {
            "fn" => return rest.split(['(', '<']).next(),
            "pub" | "const" | "async" | "unsafe" | "extern" | "\"C\"" => words = rest,
            _ if word.starts_with("pub(") => words = rest,
            _ => return None,
        }
    }
    None
}

/// Returns the functions of more than one line with their lengths. rustfmt indents the end of an item like its
/// beginning.
fn functions(text: &str) -> Vec<(&str, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (begin, line) in lines.iter().copied().enumerate() {
        let Some(name) = function(line).filter(|_| !line.ends_with(['}', ';'])) else { continue };
        let indent = &line[..line.len() - line.trim_start().len()];
        let is_end = |line: &&str| line.strip_prefix(indent).is_some_and(|rest| rest == "}" || rest.starts_with(");"));
        found.extend(lines[begin..].iter().position(is_end).map(|length| (name, length + 1)));
    }
    found
}

/// Returns the name of the type that begins on an unindented line.
fn type_name(line: &str) -> Option<&str> {
    let line = line.strip_prefix("pub").map_or(line, |rest| rest.trim_start_matches(|c| c != ' ').trim_start());
    let (kind, rest) = line.split_once(' ')?;
    let is_type = ["struct", "enum", "trait", "type", "union"].contains(&kind);
    is_type.then(|| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next())?
}

/// Returns the items that are longer than allowed.
fn too_long(found: BTreeMap<String, usize>, max_length: usize) -> Vec<String> {
    found.into_iter().filter(|(_, length)| *length > max_length).map(|(name, n)| format!("{name}: {n}")).collect()
}

/// Returns whether a file is the root of a program, a library, a test or a benchmark.
fn is_root(name: &str) -> bool {
    matches!(
        name.split('/').collect::<Vec<_>>()[..],
        ["build.rs"]
            | ["src", "lib.rs" | "main.rs"]
            | ["tests", _, "main.rs"]
            | ["benches" | "examples", _]
            | ["src", "bin", _]
            | ["src", "bin", _, "main.rs"]
            | ["crates", _, "build.rs"]
            | ["crates", _, "src", "lib.rs" | "main.rs"]
            | ["crates", _, "src", "bin", _]
            | ["crates", _, "src", "bin", _, "main.rs"]
            | ["crates", _, "benches" | "tests" | "examples", _]
            | ["crates", _, "benches" | "tests", _, "main.rs"]
            | ["tests", "tidy", "src", "lib.rs"]
    )
}

#[test]
fn functions_and_types_are_found_in_sources() {
    let text = "impl A {\n    pub(crate) const fn a() -> u8 {\n        1\n    }\n    fn b();\n    fn c() {}\n}\n";
    assert_eq!(functions(text), [("a", 3)]);
    assert_eq!(type_name("pub(super) struct State<'a> {"), Some("State"));
    assert_eq!([type_name("enum A {"), type_name("use b::type"), type_name("    struct C;")], [Some("A"), None, None]);
}

#[test]
fn functions_are_short() {
    let mut found = BTreeMap::new();
    for source in sources() {
        for (function, length) in functions(&text(&source)) {
            let longest =
                found.entry(format!("{} {function}", source.file_name().expect("a name").display())).or_insert(0);
            *longest = length.max(*longest);
        }
    }
    assert!(found.len() > 3_000, "{}: the test no longer understands the sources", found.len());
    let long = too_long(found, LONGEST_FUNCTION);
    assert!(long.is_empty(), "longer than {LONGEST_FUNCTION} lines: {long:#?}");
}

#[test]
fn files_are_short() {
    let lines = sources().iter().map(|source| (name(source).to_owned(), text(source).lines().count())).collect();
    let long = too_long(lines, LONGEST_FILE);
    assert!(long.is_empty(), "longer than {LONGEST_FILE} lines: {long:#?}");
}

#[test]
fn lines_are_as_wide_as_rustfmt_makes_code() {
    let mut wide: Vec<String> = Vec::new();
    for source in sources() {
        let text = text(&source);
        let lines = text.lines().enumerate().filter(|(_, line)| line.chars().count() > WIDTH);
        wide.extend(lines.map(|(index, _)| format!("{}:{}", name(&source), index + 1)));
    }
    assert!(wide.is_empty(), "wider than {WIDTH} columns: {wide:#?}");
}

/// A reader of `Place` should not have to find out which of twelve types it is.
#[test]
fn names_of_types_stand_in_one_crate() {
    let mut crates: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for source in sources().iter().filter(|source| !is_of_tests(name(source))) {
        for found in text(source).lines().filter_map(type_name) {
            crates.entry(found.to_owned()).or_default().insert(crate_of(name(source)).to_owned());
        }
    }
    assert!(crates.len() > 800, "{}: the test no longer understands the sources", crates.len());
    crates.retain(|_, crates| crates.len() > 1);
    assert!(crates.len() <= MOST_SHARED_NAMES, "{} names stand in several crates: {crates:#?}", crates.len());
}

/// Returns whether a type name is one word, and a participle or a similar word.
fn is_bare(name: &str) -> bool {
    let is_one_word = !name.chars().skip(1).any(|letter| letter.is_uppercase() || letter == '_');
    is_one_word && name.ends_with("ed") && !name.ends_with("eed") || BARE_NAMES.contains(&name)
}

/// The name of a type is a noun, not a participle.
#[test]
fn types_have_nouns_for_names() {
    let mut bare = Vec::new();
    for source in sources().iter().filter(|source| !is_of_tests(name(source))) {
        let text = text(source);
        let found = text.lines().filter_map(type_name).filter(|found| is_bare(found));
        bare.extend(found.map(|found| format!("{}: {found}", name(source))));
    }
    assert!(bare.is_empty(), "these names lack a noun, as `BatchResult` instead of `Graded`: {bare:#?}");
}

/// The name of a function describes what it does; a constructor is `new`, `from_x`, `with_x`, `read` or `parse`. The
/// names `rounded` and `shifted` in `num`, and `at` for a motion at a time, are common in mathematics.
#[test]
fn functions_have_verbs_for_names() {
    let is_participle = |name: &str| name != "at" && is_bare(&(name[..1].to_uppercase() + &name[1..]));
    let mut vague = Vec::new();
    for source in sources().iter().filter(|source| !is_of_tests(name(source))) {
        let (text, is_number) = (text(source), crate_of(name(source)) == "num");
        let product = text.split("#[cfg(test)]").next().expect("a part");
        let is_vague = |name: &str| VAGUE_FUNCTIONS.contains(&name) || name.starts_with("of_");
        let found =
            product.lines().filter_map(function).filter(|name| is_vague(name) || !is_number && is_participle(name));
        vague.extend(found.map(|found| format!("{}: {found}", name(source))));
    }
    assert!(vague.is_empty(), "these names are no verbs: {vague:#?}");
}

/// A list next to its enum may lack new variants; `fosssim_num::closed_set` generates both.
#[test]
fn lists_of_all_variants_are_generated() {
    let by_hand = |line: &str| {
        let length = line.split_once("const ALL: [Self; ").map(|(_, rest)| rest);
        length.is_some_and(|length| length.starts_with(|c: char| c.is_ascii_digit()))
    };
    let has_one = |source: &PathBuf| text(source).lines().any(by_hand);
    let sources: Vec<PathBuf> = sources().into_iter().filter(has_one).collect();
    assert!(sources.is_empty(), "lists by hand: {sources:#?}");
}

#[test]
fn no_crate_without_a_reason_may_hold_unsafe_code() {
    let sources = sources();
    let roots = sources.iter().map(|source| name(source)).filter(|name| is_root(name));
    let free = |root_of: &&str| !text(&root().join(root_of)).contains("#![forbid(unsafe_code)]");
    let without: Vec<&str> = roots.filter(free).collect();
    let listed: Vec<&str> = UNSAFE.iter().map(|(root, _)| *root).collect();
    assert_eq!(without, listed, "forbid unsafe code, or say here what it is for");
}

/// Returns the files to which a source's `mod name;` and `#[path = "..."]` may refer.
pub fn modules(source: &Path) -> Vec<PathBuf> {
    let (folder, own) = (source.parent().expect("a folder"), source.with_extension(""));
    let mut files = Vec::new();
    for line in text(source).lines().map(str::trim_start) {
        if let Some(path) = line.strip_prefix("#[path = \"").and_then(|rest| rest.strip_suffix("\"]")) {
            files.extend(folder.join(path).canonicalize());
        }
        let Some((_, name)) = line.strip_suffix(';').and_then(|line| line.split_once("mod ")) else { continue };
        for above in [folder, &own] {
            files.extend([above.join(format!("{name}.rs")), above.join(name).join("mod.rs")]);
        }
    }
    files
}

/// The compiler does not report a module that is not declared.
#[test]
fn every_source_is_compiled() {
    let sources = sources();
    let declared: BTreeSet<PathBuf> = sources.iter().flat_map(|source| modules(source)).collect();
    let is_target = |source: &PathBuf| is_root(name(source)) || name(source).starts_with("fuzz/fuzz_targets/");
    let unused: Vec<_> = sources.iter().filter(|source| !declared.contains(*source) && !is_target(source)).collect();
    assert!(unused.is_empty(), "nobody declares {unused:#?}");
}

/// A test names every snapshot, or the snapshot has the name of a scene.
#[test]
fn every_snapshot_is_compared() {
    let all: String = sources().iter().map(|source| text(source)).collect();
    let words: BTreeSet<&str> = all.split(['"', '(', ' ', '\n']).collect();
    let snapshots = ["src", "crates", "tests"].map(|folder| files(&root().join(folder), ".snap")).concat();
    let scenes = files(&root().join("assets"), ".xml");
    let is_scene = |short: &str| scenes.iter().any(|scene| scene.ends_with(short.replace("--", "/") + ".xml"));
    let is_used = |snapshot: &PathBuf| {
        // The form of the names is `crate__module__tests__name@input.snap_weights`.
        let stem = snapshot.file_stem().expect("a name").to_str().expect("a name");
        let short = stem.split('@').next().and_then(|stem| stem.rsplit("__").next()).expect("a name");
        let numbered = short.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('-');
        let formatted = format!("{}_{{}}", short.split('_').next().expect("a part"));
        [short, numbered, &formatted].iter().any(|name| words.contains(name)) || is_scene(short)
    };
    assert!(snapshots.len() > 100, "{} snapshots: is this where they lie?", snapshots.len());
    let unused: Vec<_> = snapshots.iter().filter(|snapshot| !is_used(snapshot)).collect();
    assert!(unused.is_empty(), "no test compares {unused:#?}");
}
