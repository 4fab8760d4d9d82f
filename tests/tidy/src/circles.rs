//! The modules of a crate must not depend on each other in circles: if a file uses a definition of another file, the
//! other one must not use the first, neither directly nor through other files. The check reads the paths in the
//! sources. A name that a module only reexports counts for the file that defines it. A file may use the definitions of
//! its parent module.
use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
};

use crate::{
    manifests::packages,
    tree::{files, name, text},
};

/// The names on the path to a module.
type Module = Vec<String>;

/// The names that a file defines and uses.
#[derive(Default)]
struct File {
    /// Names that `use` imports, each with its possible paths, and whether the file only reexports them.
    imports: BTreeMap<String, Vec<(Vec<String>, bool)>>,
    /// Modules from which everything is imported.
    globs: Vec<Vec<String>>,
    /// The names that the file defines.
    items: BTreeSet<String>,
    /// The paths in the code.
    paths: Vec<Vec<String>>,
    /// Modules of tests that have their own files.
    tests: Vec<String>,
}

/// Returns the names and symbols of a text, without comments, strings and characters; `::` is one symbol.
fn tokens(text: &str) -> Vec<String> {
    let bytes: Vec<char> = text.chars().collect();
    let (mut at, mut list) = (0, Vec::new());
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    while at < bytes.len() {
        let (c, next) = (bytes[at], bytes.get(at + 1).copied().unwrap_or(' '));
        if c == '/' && next == '/' {
            while at < bytes.len() && bytes[at] != '\n' {
                at += 1;
            }
        } else if c == 'r' && (next == '"' || (next == '#' && matches!(bytes.get(at + 2), Some('"' | '#')))) {
            let marks = bytes[at + 1..].iter().take_while(|c| **c == '#').count();
            let end: String = std::iter::once('"').chain(std::iter::repeat_n('#', marks)).collect();
            let rest: String = bytes[at + marks + 2..].iter().collect();
            let length = rest.find(&end).map_or(rest.len(), |end| rest[..end].chars().count());
            at += marks + 2 + length + end.len();
        } else if c == '"' {
            at += 1;
            while at < bytes.len() && bytes[at] != '"' {
                at += if bytes[at] == '\\' { 2 } else { 1 };
            }
            at += 1;
        } else if c == '\'' && (next == '\\' || bytes.get(at + 2) == Some(&'\'')) {
            at += if next == '\\' { 3 } else { 2 };
            while at < bytes.len() && bytes[at] != '\'' {
                at += 1;
            }
            at += 1;
        } else if is_word(c) {
            let begin = at;
            while at < bytes.len() && is_word(bytes[at]) {
                at += 1;
            }
            list.push(bytes[begin..at].iter().collect());
        } else if c == ':' && next == ':' {
            list.push("::".to_owned());
            at += 2;
        } else {
            if !c.is_whitespace() {
                list.push(c.to_string());
            }
            at += 1;
        }
    }
    list
}

/// Returns the end of the item that begins here: after its braces, or its semicolon.
fn end_of_item(tokens: &[String], begin: usize) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate().skip(begin) {
        match token.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => {
                depth -= 1;
                if depth == 0 && token == "}" {
                    return at + 1;
                }
            }
            ";" if depth == 0 => return at + 1,
            _ => {}
        }
    }
    tokens.len()
}

/// Returns the paths of a `use`, each with its name. Afterwards, `at` is the position after its end.
fn paths_of_use(tokens: &[String], at: &mut usize, before: &[String], out: &mut Vec<(Vec<String>, String)>) {
    let (mut path, mut name) = (before.to_vec(), None);
    while let Some(token) = tokens.get(*at) {
        match token.as_str() {
            "{" => {
                *at += 1;
                while tokens.get(*at).is_some_and(|token| token != "}") {
                    paths_of_use(tokens, at, &path, out);
                    *at += usize::from(tokens.get(*at).is_some_and(|token| token == ","));
                }
                *at += 1;
                return;
            }
            "," | "}" | ";" => break,
            "::" => {}
            "as" => {
                *at += 1;
                name = tokens.get(*at).cloned();
            }
            "self" if !path.is_empty() && path.len() == before.len() => {}
            word => path.push(word.to_owned()),
        }
        *at += 1;
    }
    if let Some(last) = path.last().cloned() {
        out.push((path, name.unwrap_or(last)));
    }
}

fn read(text: &str) -> File {
    let tokens = tokens(text);
    let (mut file, mut at) = (File::default(), 0);
    let is = |at: usize, words: &[&str]| {
        words.iter().enumerate().all(|(n, word)| tokens.get(at + n).is_some_and(|t| t == word))
    };
    while at < tokens.len() {
        if is(at, &["#", "[", "cfg", "(", "test", ")", "]"]) {
            at += 7;
            if is(at, &["mod"]) || is(at, &["pub", "mod"]) || is(at, &["pub", "(", "crate", ")", "mod"]) {
                let mut name = at;
                while tokens[name] != "mod" {
                    name += 1;
                }
                file.tests.push(tokens[name + 1].clone());
            }
            at = end_of_item(&tokens, at);
            continue;
        }
        let token = tokens[at].as_str();
        // `use<>` names the captured lifetimes of a type.
        if token == "use" && !is(at + 1, &["<"]) {
            let passes_on = at > 0 && (tokens[at - 1] == "pub" || tokens[at - 1] == ")");
            at += 1;
            let mut found = Vec::new();
            paths_of_use(&tokens, &mut at, &[], &mut found);
            for (mut path, name) in found {
                if name == "*" {
                    path.pop();
                    file.globs.push(path);
                } else {
                    file.imports.entry(name).or_default().push((path, passes_on));
                }
            }
            continue;
        }
        if matches!(token, "struct" | "enum" | "trait" | "fn" | "type" | "const" | "static" | "macro_rules" | "union") {
            let name = at + 1 + usize::from(token == "macro_rules");
            file.items.extend(tokens.get(name).cloned());
        }
        let is_word =
            |at: usize| tokens.get(at).is_some_and(|token| token.starts_with(|c: char| c.is_alphabetic() || c == '_'));
        if is_word(at) && is(at + 1, &["::"]) && (at == 0 || tokens[at - 1] != "::") {
            let mut path = vec![tokens[at].clone()];
            while is(at + 1, &["::"]) && is_word(at + 2) {
                path.push(tokens[at + 2].clone());
                at += 2;
            }
            file.paths.push(path);
        }
        at += 1;
    }
    file
}

/// The files of a crate, by module.
struct Room(BTreeMap<Module, File>);

impl Room {
    fn read(folder: &Path) -> Self {
        let mut modules = BTreeMap::new();
        for path in files(folder, ".rs") {
            let relative = path.strip_prefix(folder).expect("below").with_extension("");
            let mut module: Module = relative.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            if module.last().is_some_and(|last| last == "mod") || module == ["lib"] {
                module.pop();
            }
            if !matches!(module.first().map(String::as_str), Some("bin" | "main")) {
                modules.insert(module, read(&text(&path)));
            }
        }
        let tests: Vec<Module> = modules
            .iter()
            .flat_map(|(module, file): (&Module, &File)| {
                file.tests.iter().map(move |name| module.iter().cloned().chain([name.clone()]).collect())
            })
            .collect();
        modules.retain(|module, _| !tests.iter().any(|test| module.starts_with(test)));
        Self(modules)
    }

    /// Returns the module whose file defines the item of a path in another module, or `None` if it is in another crate.
    fn resolve(&self, module: &[String], path: &[String], depth: usize) -> Option<Module> {
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => self.walk(&[], rest, depth),
            "self" => self.walk(module, rest, depth),
            "super" => {
                let ups = path.iter().take_while(|name| *name == "super").count();
                self.walk(module.get(..module.len().checked_sub(ups)?)?, &path[ups..], depth)
            }
            name => {
                let child: Module = module.iter().cloned().chain([name.to_owned()]).collect();
                if self.0.contains_key(&child) {
                    return self.walk(&child, rest, depth);
                }
                let imports = self.0.get(module)?.imports.get(name)?;
                let through = |(import, _): &(Vec<String>, bool)| {
                    let whole: Vec<String> = import.iter().chain(rest).cloned().collect();
                    (depth < 8 && import.first() != Some(first)).then(|| self.resolve(module, &whole, depth + 1))?
                };
                imports.iter().find_map(through)
            }
        }
    }

    fn walk(&self, module: &[String], path: &[String], depth: usize) -> Option<Module> {
        let file = self.0.get(module)?;
        let Some((name, rest)) = path.split_first() else { return Some(module.to_vec()) };
        let child: Module = module.iter().cloned().chain([name.clone()]).collect();
        if self.0.contains_key(&child) {
            return self.walk(&child, rest, depth);
        }
        if file.items.contains(name) || depth > 8 {
            return Some(module.to_vec());
        }
        let through = |(import, _): &(Vec<String>, bool)| self.resolve(module, import, depth + 1);
        if let Some(found) = file.imports.get(name).and_then(|imports| imports.iter().find_map(through)) {
            return Some(found);
        }
        let defines = |glob: &Vec<String>| {
            let found = self.resolve(module, glob, depth + 1)?;
            self.0.get(&found).filter(|file| file.items.contains(name)).map(|_| found)
        };
        Some(file.globs.iter().find_map(defines).unwrap_or_else(|| module.to_vec()))
    }

    /// Returns the modules whose definitions each file uses.
    fn uses(&self) -> BTreeMap<&Module, BTreeSet<Module>> {
        let of = |(module, file): (&'_ Module, &File)| -> BTreeSet<Module> {
            let imported = file.imports.values().flatten().filter(|(_, passes_on)| !passes_on).map(|(path, _)| path);
            let paths = imported.chain(&file.paths).chain(&file.globs);
            let found = paths.filter_map(|path| self.resolve(module, path, 0));
            found.filter(|other| self.0.contains_key(other) && !module.starts_with(other)).collect()
        };
        self.0.iter().map(|entry| (entry.0, of(entry))).collect()
    }

    /// Returns the files that use each other.
    fn circles(&self) -> BTreeSet<Vec<String>> {
        circles(&self.uses().into_iter().map(|(module, uses)| (module.join("/"), names(&uses))).collect())
    }

    /// Returns the top-level files and folders of the crate that use each other, as names of modules of the first
    /// level.
    fn folder_circles(&self) -> BTreeSet<Vec<String>> {
        let mut folders: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        let first = |module: &Module| module.first().cloned();
        for (module, uses) in self.uses() {
            let Some(folder) = first(module) else { continue };
            let uses = uses.iter().filter_map(first).filter(|other| *other != folder);
            folders.entry(folder.clone()).or_default().extend(uses);
        }
        circles(&folders)
    }
}

fn names(modules: &BTreeSet<Module>) -> BTreeSet<String> {
    modules.iter().map(|module| module.join("/")).collect()
}

/// Returns the names that use each other; each circle is a sorted list.
fn circles(uses: &BTreeMap<String, BTreeSet<String>>) -> BTreeSet<Vec<String>> {
    let reached = |from: &String| {
        let (mut open, mut reached) = (vec![from], BTreeSet::new());
        while let Some(name) = open.pop() {
            open.extend(uses.get(name).into_iter().flatten().filter(|other| reached.insert((*other).clone())));
        }
        reached
    };
    let all: BTreeMap<&String, BTreeSet<String>> = uses.keys().map(|name| (name, reached(name))).collect();
    let circle = |(name, reached): (&&String, &BTreeSet<String>)| {
        let back = |other: &&String| all.get(other).is_some_and(|back| back.contains(*name));
        reached.contains(*name).then(|| reached.iter().filter(back).cloned().collect())
    };
    all.iter().filter_map(circle).collect()
}

#[test]
fn imports_are_followed_to_the_file_that_defines_a_name() {
    let room = |files: &[(&str, &str)]| {
        Room(
            files
                .iter()
                .map(|(name, text)| (name.split_terminator('/').map(str::to_owned).collect(), read(text)))
                .collect(),
        )
    };
    // The circle goes through a reexported name and a group, and strings, comments and tests are skipped.
    let circles = room(&[
        ("", "mod a; mod b; pub use b::{B, other as Other};"),
        ("a/", "use super::{B, c::C as D}; pub struct A;"),
        ("b/", "pub struct B(crate::a::A); pub fn other() {}"),
        (
            "c/",
            "pub struct C; // use super::a::A;\nconst TEXT: &str = \"crate::a::A\";\n#[cfg(test)] mod tests \
            { use crate::a::A; }",
        ),
    ]);
    assert_eq!(circles.circles(), BTreeSet::from([vec!["a".to_owned(), "b".to_owned()]]));
    // A module may use its parent.
    let whole =
        room(&[("", "mod a;"), ("a/", "mod b; use b::B; pub struct A;"), ("a/b/", "use super::A; pub struct B;")]);
    assert!(whole.circles().is_empty());
}

/// Reads the sources of all packages of the workspace, each with the name of its folder.
fn rooms() -> Vec<(String, Room)> {
    let folders = packages().into_iter().map(|package| package.sources()).filter(|folder| folder.is_dir());
    folders.map(|folder| (name(&folder).to_owned(), Room::read(&folder))).collect()
}

#[test]
fn no_files_of_a_room_use_one_another_in_a_circle() {
    let (mut circles, mut uses) = (Vec::new(), 0);
    for (folder, room) in rooms() {
        uses += room.uses().values().map(BTreeSet::len).sum::<usize>();
        circles.extend(room.circles().into_iter().map(|circle| format!("{folder}: {}", circle.join(", "))));
    }
    assert!(uses > 500, "only {uses} uses were recognized: the test no longer understands the sources");
    assert!(circles.is_empty(), "files that use one another:\n{}", circles.join("\n"));
}

#[test]
fn no_folders_of_a_room_use_one_another_in_a_circle() {
    let circles = |(folder, room): (String, Room)| {
        let told = move |circle: Vec<String>| format!("{folder}: {}", circle.join(", "));
        room.folder_circles().into_iter().map(told).collect::<Vec<_>>()
    };
    let found: Vec<String> = rooms().into_iter().flat_map(circles).collect();
    assert!(found.is_empty(), "folders that use one another:\n{}", found.join("\n"));
}
