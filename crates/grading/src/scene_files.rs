//! Folders that contain scenes or recordings. Paths are `<assignment>/<Group>/<name>`, or `<Group>/<name>` without
//! assignments.
use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// A file in a folder of scenes or recordings.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct SceneFile {
    /// The name of the scene, as `Group/name`.
    pub name: String,
    /// The path of the scene in its folder, without the ending. The recording has the same path in the folder of
    /// recordings.
    pub stem: String,
    /// The path of the file.
    pub path: PathBuf,
}

/// Returns the files with an ending such as `.xml` in the groups of a folder, sorted by the names of the scenes. Files
/// elsewhere in the folder, and files whose names are not UTF-8, are left out.
///
/// # Errors
/// Fails if a folder can't be read.
pub fn list_files(folder: &Path, extension: &str) -> io::Result<Vec<SceneFile>> {
    let mut files = Vec::new();
    for first in list_folders(folder)? {
        gather(folder, &first, extension, &mut files)?;
        for second in list_folders(&first)? {
            gather(folder, &second, extension, &mut files)?;
        }
    }
    files.sort();
    Ok(files)
}

fn list_entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect()
}

fn list_folders(folder: &Path) -> io::Result<Vec<PathBuf>> {
    Ok(list_entries(folder)?.into_iter().filter(|path| path.is_dir()).collect())
}

fn gather(root: &Path, group: &Path, extension: &str, files: &mut Vec<SceneFile>) -> io::Result<()> {
    for path in list_entries(group)? {
        let stem = |above: Option<&Path>| path.strip_prefix(above?).ok()?.to_str()?.strip_suffix(extension);
        if let (Some(name), Some(stem), true) = (stem(group.parent()), stem(Some(root)), path.is_file()) {
            files.push(SceneFile { name: name.to_owned(), stem: stem.to_owned(), path: path.clone() });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_of_groups_are_listed_with_and_without_assignments() {
        let folder = tempfile::tempdir().expect("a folder");
        for path in ["t2m2/Balls/b.xml", "Balls/a.xml", "t2m2/x.xml/c.xml", "a/b/c/d.xml", "top.xml", "Balls/a.txt"] {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            fs::write(path, "").expect("written");
        }
        let files = list_files(folder.path(), ".xml").expect("readable");
        let found: Vec<_> = files.iter().map(|file| (file.name.as_str(), file.stem.as_str())).collect();
        let expected = [("Balls/a", "Balls/a"), ("Balls/b", "t2m2/Balls/b"), ("x.xml/c", "t2m2/x.xml/c")];
        assert_eq!(found, expected);
        assert!(files.iter().all(|file| file.path == folder.path().join(format!("{}.xml", file.stem))));
        assert!(list_files(&folder.path().join("none"), ".xml").is_err());
    }
}
