//! What a submission's folder holds, in words, for whoever looks for a program in it and finds none.
use fosssim_sandbox::collect::{Entry, Folder};
use std::{ffi::OsStr, os::unix::ffi::OsStrExt, path::Path};

/// So many entries are named.
const NAMED: usize = 6;
/// So many are looked at, so deep, to find the program where it is not looked for.
const LOOKED_AT: u32 = 2000;
const DEEPEST: u32 = 3;

/// A file's name as text: bytes that are no text stay apart as `\xff`, so that two names never look the same for them.
#[must_use]
pub fn name(name: &OsStr) -> String {
    let mut text = String::new();
    for chunk in name.as_bytes().utf8_chunks() {
        text.push_str(chunk.valid());
        for byte in chunk.invalid() {
            text.push_str(&format!("\\x{byte:02x}"));
        }
    }
    text
}

/// Why there is nothing to run: what was looked for, and what is there instead.
pub(super) fn without(program: &str, folder: &Path) -> String {
    let sought = format!("no program called {} in the upload", program.escape_debug());
    let opened = match Folder::open(folder) {
        Ok(opened) => opened,
        Err(error) => return format!("{sought}: it can't be read: {error}"),
    };
    let mut names = opened.names().unwrap_or_default();
    names.retain(|name| !name.as_bytes().starts_with(b"."));
    names.sort();
    if names.is_empty() {
        return format!("{sought}; it is empty");
    }
    let shown: Vec<String> = names.iter().take(NAMED).map(|name| entry(&opened, name)).collect();
    let more = if names.len() > NAMED { format!(" and {} more", names.len() - NAMED) } else { String::new() };
    let wanted = Path::new(program).file_name().unwrap_or_default();
    let elsewhere = match deeper(&opened, wanted, Path::new(""), DEEPEST, &mut LOOKED_AT.clone()) {
        Some(path) => format!("; {} is not where it is looked for", shown_path(&path)),
        None => String::new(),
    };
    format!("{sought}; it holds {}{more}{elsewhere}", shown.join(", "))
}

fn entry(folder: &Folder, name: &OsStr) -> String {
    let slash = if matches!(folder.entry(name), Ok(Entry::Folder(_))) { "/" } else { "" };
    shown_path(Path::new(name)) + slash
}

fn shown_path(path: &Path) -> String {
    name(path.as_os_str()).chars().flat_map(|c| if c == '\\' { vec![c] } else { c.escape_debug().collect() }).collect()
}

/// The path of a file of this name beneath a folder, the shallowest of each folder first.
fn deeper(folder: &Folder, wanted: &OsStr, at: &Path, depth: u32, budget: &mut u32) -> Option<std::path::PathBuf> {
    let mut names = folder.names().ok()?;
    names.sort();
    let mut folders = Vec::new();
    for name in names {
        *budget = budget.checked_sub(1)?;
        match folder.entry(&name) {
            Ok(Entry::File(_)) if name == wanted => return Some(at.join(name)),
            Ok(Entry::Folder(inner)) => folders.push((name, inner)),
            _ => {}
        }
    }
    if depth == 0 {
        return None;
    }
    folders.into_iter().find_map(|(name, inner)| deeper(&inner, wanted, &at.join(name), depth - 1, budget))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn what_was_sought_and_what_was_found_is_one_sentence() {
        let folder = tempfile::tempdir().unwrap();
        let says = || without("FOSSSim", folder.path());
        assert_eq!(says(), "no program called FOSSSim in the upload; it is empty");
        for name in ["main.cpp", "fosssim-sample", ".git"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        assert_eq!(says(), "no program called FOSSSim in the upload; it holds fosssim-sample, main.cpp");
        fs::create_dir_all(folder.path().join("work/build")).unwrap();
        fs::write(folder.path().join("work/build/FOSSSim"), "").unwrap();
        assert_eq!(
            says(),
            "no program called FOSSSim in the upload; it holds fosssim-sample, main.cpp, work/; \
             work/build/FOSSSim is not where it is looked for"
        );
        for number in 0..9 {
            fs::write(folder.path().join(format!("a{number}\n")), "").unwrap();
        }
        assert!(says().contains("it holds a0\\n, a1\\n") && says().contains(" and 6 more;"), "{}", says());
        assert!(without("FOSSSim", Path::new("/nowhere")).contains("it can't be read"));
    }

    #[test]
    fn names_that_are_no_text_stay_apart() {
        let shown = |bytes: &[u8]| name(OsStr::from_bytes(bytes));
        assert_eq!((shown(b"a\xff"), shown(b"a\xfe")), ("a\\xff".to_owned(), "a\\xfe".to_owned()));
        assert_eq!(shown("Zoë".as_bytes()), "Zoë");
    }
}
