//! Describes what a submission's folder contains, for messages about a missing program.
use super::{
    file_names,
    result::{FolderContents, UnusableReason},
};
use fosssim_sandbox::collect::{FolderEntry, OpenFolder};
use std::{ffi::OsStr, os::unix::ffi::OsStrExt, path::Path};

/// The maximum number of entries that a message names.
const MAX_NAMED_ENTRIES: usize = 6;
/// The maximum number of entries that are checked when subfolders are searched for a program.
const MAX_SCANNED_ENTRIES: u32 = 2000;
const MAX_DEPTH: u32 = 3;

/// Returns the reason why a submission has no program: the name that was expected, and what the folder contains
/// instead.
pub(super) fn explain_missing_program(program: &str, folder: &Path) -> UnusableReason {
    let found = match OpenFolder::open(folder) {
        Ok(opened) => list_contents(program, &opened),
        Err(error) => FolderContents::Unreadable(error.to_string()),
    };
    UnusableReason::NoProgram { sought: program.escape_debug().to_string(), found }
}

fn list_contents(program: &str, folder: &OpenFolder) -> FolderContents {
    let mut names = folder.list_names().unwrap_or_default();
    names.retain(|name| !name.as_bytes().starts_with(b".") && !fosssim_intake::is_generated_name(name));
    names.sort();
    if names.is_empty() {
        return FolderContents::Nothing;
    }
    let file_name = Path::new(program).file_name().unwrap_or_default();
    FolderContents::Others {
        names: names.iter().take(MAX_NAMED_ENTRIES).map(|name| format_entry(folder, name)).collect(),
        more: names.len().saturating_sub(MAX_NAMED_ENTRIES),
        elsewhere: find_below(folder, file_name, Path::new(""), MAX_DEPTH, &mut MAX_SCANNED_ENTRIES.clone())
            .map(|path| file_names::to_printable(path.as_os_str())),
    }
}

fn format_entry(folder: &OpenFolder, name: &OsStr) -> String {
    let slash = if matches!(folder.entry(name), Ok(FolderEntry::Folder(_))) { "/" } else { "" };
    file_names::to_printable(name) + slash
}

/// Returns the path of the first file called `name` below a folder. The files in a folder come before those in its
/// subfolders.
fn find_below(
    folder: &OpenFolder,
    wanted: &OsStr,
    at: &Path,
    depth: u32,
    budget: &mut u32,
) -> Option<std::path::PathBuf> {
    let mut names = folder.list_names().ok()?;
    names.sort();
    let mut folders = Vec::new();
    for name in names {
        *budget = budget.checked_sub(1)?;
        match folder.entry(&name) {
            Ok(FolderEntry::File(_)) if name == wanted => return Some(at.join(name)),
            Ok(FolderEntry::Folder(inner)) => folders.push((name, inner)),
            _ => {}
        }
    }
    if depth == 0 {
        return None;
    }
    folders.into_iter().find_map(|(name, inner)| find_below(&inner, wanted, &at.join(name), depth - 1, budget))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn files_instead_of_the_program_are_listed_and_searched() {
        let folder = tempfile::tempdir().unwrap();
        let found = || match explain_missing_program("FOSSSim", folder.path()) {
            UnusableReason::NoProgram { sought, found } if sought == "FOSSSim" => found,
            other => panic!("{other:?}"),
        };
        let others = |names: &[&str], elsewhere: Option<&str>| FolderContents::Others {
            names: names.iter().map(|&name| name.to_owned()).collect(),
            more: 0,
            elsewhere: elsewhere.map(str::to_owned),
        };
        assert_eq!(found(), FolderContents::Nothing);
        for name in ["main.cpp", "fosssim-sample", ".git"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        assert_eq!(found(), others(&["fosssim-sample", "main.cpp"], None));
        fs::create_dir_all(folder.path().join("work/build")).unwrap();
        fs::write(folder.path().join("work/build/FOSSSim"), "").unwrap();
        assert_eq!(found(), others(&["fosssim-sample", "main.cpp", "work/"], Some("work/build/FOSSSim")));
        for number in 0..9 {
            fs::write(folder.path().join(format!("a{number}\n")), "").unwrap();
        }
        let FolderContents::Others { names, more, .. } = found() else { panic!("it holds something") };
        assert_eq!((names[0].as_str(), names[1].as_str(), more), ("a0\\n", "a1\\n", 6));
        let nowhere = explain_missing_program("FOSSSim", Path::new("/nowhere"));
        assert!(matches!(nowhere, UnusableReason::NoProgram { found: FolderContents::Unreadable(_), .. }));
    }
}
