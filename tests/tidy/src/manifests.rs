//! The packages of the workspace, as their manifests describe them.
use crate::{
    ratchets::modules,
    tree::{files, root, text},
};
use std::path::PathBuf;

/// A package of the workspace.
pub struct Package {
    /// The name without `fosssim-`, such as `model`; the name of the program's own package is `oracle`.
    pub name: String,
    /// The folder of the manifest.
    pub folder: PathBuf,
    /// The manifest's text.
    manifest: String,
}

impl Package {
    /// Reads the manifest of a folder.
    fn read(folder: PathBuf) -> Self {
        let manifest = text(&folder.join("Cargo.toml"));
        let name = manifest.lines().find_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"'));
        let name = name.expect("a package's name").trim_start_matches("fosssim-").to_owned();
        Self { name, folder, manifest }
    }

    /// Returns the folder of the package's sources.
    pub fn sources(&self) -> PathBuf {
        self.folder.join("src")
    }

    /// Returns the names and values of the entries of all tables whose names are wanted.
    fn entries(&self, is_wanted: impl Fn(&str) -> bool) -> Vec<(&str, &str)> {
        let mut is_inside = false;
        let mut found = Vec::new();
        for line in self.manifest.lines() {
            if let Some(table) = line.strip_prefix('[') {
                is_inside = is_wanted(table.trim_end_matches(']'));
            } else if is_inside
                && !line.starts_with('#')
                && let Some((name, value)) = line.split_once([' ', '.', '='])
            {
                found.push((name, value));
            }
        }
        found
    }

    /// Returns the names of all packages on which the package depends, including those for tests.
    pub fn dependencies(&self) -> Vec<&str> {
        let is_table = |table: &str| table.ends_with("dependencies") && !table.starts_with("workspace");
        self.entries(is_table).into_iter().map(|(name, _)| name).collect()
    }

    /// Returns the names of the packages with which the library or program is built on every platform.
    pub fn built_with(&self) -> Vec<&str> {
        self.entries(|table| table == "dependencies").into_iter().map(|(name, _)| name).collect()
    }

    /// Returns the names of the dependencies that are not optional.
    fn required(&self) -> Vec<&str> {
        let is_table = |table: &str| table.ends_with("dependencies") && !table.starts_with("workspace");
        let all = self.entries(is_table).into_iter();
        all.filter(|(_, value)| !value.contains("optional = true")).map(|(name, _)| name).collect()
    }
}

/// Returns all packages of the workspace, the program's own first.
pub fn packages() -> Vec<Package> {
    let top = text(&root().join("Cargo.toml"));
    let members = top.split_once("\nmembers = [").and_then(|(_, rest)| rest.split_once(']')).expect("members").0;
    let members: Vec<&str> = members.split('"').skip(1).step_by(2).collect();
    let folders = members.iter().flat_map(|member| match member.strip_suffix("/*") {
        Some(above) => {
            let entries = std::fs::read_dir(root().join(above)).expect("a folder of packages");
            let mut folders: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
            folders.retain(|folder| folder.join("Cargo.toml").exists());
            folders.sort();
            folders
        }
        None => vec![root().join(member)],
    });
    std::iter::once(root().to_owned()).chain(folders).map(Package::read).collect()
}

#[test]
fn all_packages_are_read_with_their_dependencies() {
    let packages = packages();
    assert!(packages.len() > 15, "{} packages", packages.len());
    assert_eq!(packages[0].name, "oracle");
    let model = packages.iter().find(|package| package.name == "model").expect("a package");
    assert!(model.dependencies().contains(&"fosssim-num"), "{:?}", model.dependencies());
}

/// Some source must use every package in a manifest. Optional packages may exist only for their features.
#[test]
fn every_dependency_is_used() {
    let mut unused = Vec::new();
    for package in packages() {
        let own = ["src", "tests", "benches", "examples", "build.rs"].map(|part| package.folder.join(part));
        let sources = own
            .iter()
            .filter(|path| path.exists())
            .flat_map(|path| if path.is_dir() { files(path, ".rs") } else { vec![path.clone()] });
        let sources: Vec<_> = sources.flat_map(|source| [modules(&source), vec![source]].concat()).collect();
        let sources: String = sources.iter().filter(|source| source.exists()).map(|source| text(source)).collect();
        for name in package.required() {
            let name = name.replace('-', "_");
            if !sources.contains(&format!("{name}::")) && !sources.contains(&format!("use {name}")) {
                unused.push(format!("{} asks for {name}", package.name));
            }
        }
    }
    assert!(unused.is_empty(), "and no source names it: {unused:#?}");
}
