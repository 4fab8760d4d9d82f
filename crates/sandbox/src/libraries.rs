//! Which of the system's libraries a program may read: those that the loader opens for it, and few more.
//!
//! Thousands of other files lie beside them that nobody has read for long. Whether one is in memory, and when it was
//! last read, would be a store in which one run leaves data for another. The search is the loader's (`ld.so(8)`), but
//! takes every file that it might choose. What a program names itself counts within the system's folders only.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs::File,
    io::Read,
    path::{Path, PathBuf},
};

use super::{
    elf::{self, Dynamic},
    machine, own,
};

/// Where shared libraries lie.
pub(super) const FOLDERS: [&str; 5] = ["/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib"];
/// Libraries that the C library opens by itself: to end a thread on request, or to unwind.
const BY_ITSELF: [&str; 1] = ["libgcc_s.so.1"];
/// Its lists of conversions between character sets, and the modules for usual ones that are not built in.
const CONVERSIONS: [&str; 8] = [
    "gconv-modules.cache",
    "gconv-modules",
    "gconv-modules.d",
    "ISO8859-1.so",
    "ISO8859-15.so",
    "CP1252.so",
    "UTF-16.so",
    "UTF-32.so",
];
/// The loader's list of libraries, and the files that it loads into every program.
pub(super) const LOADERS: [&str; 2] = ["/etc/ld.so.cache", "/etc/ld.so.preload"];
/// The machine's time zone, which runtimes ask for.
pub(super) const TIME_ZONE: &str = "/etc/localtime";
/// No program needs more, nor does an interpreter's own library hold more files.
const MOST: usize = 5_000;

/// The files of the system that a program may read.
#[derive(Debug, Default)]
pub(super) struct Readable {
    /// Files and folders, with real paths.
    pub(super) files: Vec<PathBuf>,
    /// Links by which the loader asks for some of them.
    pub(super) named: Vec<PathBuf>,
    /// Libraries that the program needs and the system lacks.
    pub(super) missing: Vec<String>,
}

/// The files that the loader and the C library open for a program. `dynamic` is what the program asks for, `loader` is
/// its loader, and `interpreter` is the program that runs it if it is a script.
pub(super) fn readable(
    dynamic: Dynamic,
    loader: Option<&Path>,
    interpreter: Option<&Path>,
    own: &[PathBuf],
) -> Readable {
    let cache = File::open(LOADERS[0]).ok().and_then(|mut file| {
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).ok().map(|_| bytes)
    });
    let mut search = Search {
        system: FOLDERS.iter().filter_map(|folder| Path::new(folder).canonicalize().ok()).collect(),
        listed: cache.as_deref().map(listed).unwrap_or_default(),
        own,
        ..Search::default()
    };
    search.folders.extend(search.system.clone());
    search.folders.extend(loader.and_then(Path::parent).map(Path::to_path_buf));
    search.take(loader.into_iter().map(Path::to_path_buf).collect());
    let mut waiting = vec![dynamic];
    waiting.push(Dynamic { needed: BY_ITSELF.map(str::to_owned).into(), folders: Vec::new() });
    let preloaded = std::fs::read_to_string(LOADERS[1]).unwrap_or_default();
    let words = preloaded.split(|c: char| c.is_whitespace() || c == ':').filter(|word| !word.is_empty());
    waiting.push(Dynamic { needed: words.map(str::to_owned).collect(), folders: Vec::new() });
    let folders = interpreter.map(|interpreter| search.folders_of(interpreter)).unwrap_or_default();
    waiting.extend(folders.iter().flat_map(|folder| libraries_in(folder)).filter_map(|path| elf::dynamic(&path)));
    while let Some(dynamic) = waiting.pop() {
        waiting.extend(search.follow(dynamic));
    }
    let conversions: Vec<PathBuf> = search.conversions();
    conversions.iter().filter_map(|path| elf::dynamic(path)).for_each(|dynamic| drop(search.follow(dynamic)));
    let (named, missing) = (search.links.into_iter().collect(), search.missing);
    let mut files: Vec<PathBuf> = search.found.into_iter().chain(conversions).collect();
    files.extend(LOADERS.map(PathBuf::from));
    // Names of locales; a program that asks for none has the C library's own.
    files.extend(Path::new("/usr/lib/locale").canonicalize().ok());
    // Read now, none of them has a page that is not in memory, or a time that a run could change.
    files.iter().map(PathBuf::as_path).chain([Path::new(TIME_ZONE)]).for_each(machine::load);
    // An interpreter's own library holds too many files to read them all.
    files.extend(folders);
    Readable { files, named, missing }
}

#[derive(Default)]
struct Search<'a> {
    /// The system's folders.
    system: Vec<PathBuf>,
    /// Where the loader's cache says that libraries lie, by name.
    listed: BTreeMap<String, Vec<PathBuf>>,
    own: &'a [PathBuf],
    /// Where else to look.
    folders: BTreeSet<PathBuf>,
    found: BTreeSet<PathBuf>,
    /// Links to the files that were found.
    links: BTreeSet<PathBuf>,
    names: BTreeSet<String>,
    missing: Vec<String>,
}

impl Search<'_> {
    /// Finds these libraries; the answer is the libraries that they need in turn.
    fn follow(&mut self, dynamic: Dynamic) -> Vec<Dynamic> {
        self.folders.extend(dynamic.folders);
        let mut fresh = Vec::new();
        for name in dynamic.needed {
            if self.names.len() < MOST && self.names.insert(name.clone()) {
                let listed = self.listed.get(&name).into_iter().flatten().cloned();
                let places: Vec<PathBuf> = listed.chain(self.folders.iter().map(|folder| folder.join(&name))).collect();
                if !places.iter().any(|place| place.exists()) {
                    self.missing.push(name);
                }
                fresh.extend(self.take(places));
            }
        }
        fresh.iter().filter_map(|path| elf::dynamic(path)).collect()
    }

    /// Keeps those of these files that exist, with real paths; the answer is the new ones.
    fn take(&mut self, places: Vec<PathBuf>) -> Vec<PathBuf> {
        let mut fresh = Vec::new();
        for place in places {
            let Some(real) = place.canonicalize().ok().filter(|real| self.is_systems(real)) else { continue };
            let folder = place.parent().and_then(|folder| folder.canonicalize().ok());
            let link = folder.zip(place.file_name()).map(|(folder, name)| folder.join(name));
            self.links.extend(link.filter(|link| *link != real));
            if self.found.insert(real.clone()) {
                fresh.push(real);
            }
        }
        fresh
    }

    /// Whether it is a file of the system's, and not the grader's.
    fn is_systems(&self, path: &Path) -> bool {
        let beneath = self.system.iter().any(|folder| path.starts_with(folder));
        beneath && path.is_file() && !self.own.iter().any(|own| own == path) && !own::is_name(path)
    }

    fn conversions(&self) -> Vec<PathBuf> {
        let folders: BTreeSet<&Path> = self.found.iter().filter_map(|path| path.parent()).collect();
        let all = folders.iter().flat_map(|folder| CONVERSIONS.map(|name| folder.join("gconv").join(name)));
        all.filter_map(|path| path.canonicalize().ok()).collect()
    }

    /// The folders of an interpreter's own library: those beside the system's libraries that are named after it, as
    /// `python3.12` is after `python3`.
    fn folders_of(&self, interpreter: &Path) -> Vec<PathBuf> {
        let name = interpreter.file_name().unwrap_or_default().to_string_lossy();
        let stem: String = name.chars().take_while(char::is_ascii_alphabetic).collect();
        if stem.len() < 3 {
            return Vec::new();
        }
        let entries = self.folders.iter().flat_map(|folder| std::fs::read_dir(folder).into_iter().flatten().flatten());
        let named = entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(&stem));
        let real = named.filter_map(|entry| entry.path().canonicalize().ok());
        real.filter(|path| path.is_dir() && self.system.iter().any(|folder| path.starts_with(folder))).collect()
    }
}

/// The shared libraries beneath a folder.
fn libraries_in(folder: &Path) -> Vec<PathBuf> {
    let (mut folders, mut found, mut seen) = (vec![folder.to_path_buf()], Vec::new(), 0);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            seen += 1;
            match entry.file_type() {
                _ if seen > MOST => return found,
                Ok(kind) if kind.is_dir() => folders.push(entry.path()),
                Ok(kind) if kind.is_file() && entry.path().extension().is_some_and(|end| end == "so") => {
                    found.push(entry.path());
                }
                _ => {}
            }
        }
    }
    found
}

/// The libraries in the loader's cache, by name: `struct cache_file_new` of the C library.
fn listed(cache: &[u8]) -> BTreeMap<String, Vec<PathBuf>> {
    const MAGIC: &[u8] = b"glibc-ld.so.cache1.1";
    const HEADER: usize = 48;
    const ENTRY: usize = 24;
    let mut listed: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    // An older form may come before it.
    let Some(start) = cache.windows(MAGIC.len()).position(|window| window == MAGIC) else { return listed };
    let cache = &cache[start..];
    let word = |at: usize| Some(u32::from_le_bytes(cache.get(at..at + 4)?.try_into().ok()?) as usize);
    let text = |at: usize| {
        let bytes = cache.get(at..)?.split(|&byte| byte == 0).next()?;
        Some(String::from_utf8_lossy(bytes).into_owned())
    };
    for entry in 0..word(MAGIC.len()).unwrap_or(0) {
        let at = HEADER + entry * ENTRY;
        let (Some(name), Some(place)) = (word(at + 4).and_then(text), word(at + 8).and_then(text)) else { break };
        listed.entry(name).or_default().push(place.into());
    }
    listed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cache_is_read_entry_by_entry_and_distrusted() {
        let mut cache = b"glibc-ld.so.cache1.1".to_vec();
        let strings = b"liba.so\0/x/liba.so\0/y/liba.so\0";
        let start = 48 + 2 * 24;
        cache.extend(2_u32.to_le_bytes());
        cache.resize(48, 0);
        for place in [8, 19] {
            cache.extend([0_u32, start, start + place, 0, 0, 0].iter().flat_map(|word| word.to_le_bytes()));
        }
        cache.extend(strings);
        let found = listed(&[b"before".as_slice(), &cache].concat());
        assert_eq!(found["liba.so"], [PathBuf::from("/x/liba.so"), "/y/liba.so".into()]);
        for length in 0..cache.len() {
            assert!(listed(&cache[..length]).len() <= 1);
        }
    }

    #[test]
    fn what_a_program_names_counts_within_the_systems_folders_only() {
        let folder = tempfile::tempdir().unwrap();
        let outside = folder.path().join("libevil.so");
        std::fs::write(&outside, "x").unwrap();
        let needed = ["/etc/passwd", "../../etc/passwd", "libevil.so", outside.to_str().unwrap()].map(str::to_owned);
        let asked = Dynamic { needed: needed.into(), folders: vec![folder.path().into(), "/etc".into()] };
        let readable = readable(asked, None, None, &[]);
        let mut named = readable.files.iter().chain(&readable.named);
        assert!(!named.any(|path| path.ends_with("passwd") || path.ends_with("libevil.so")), "{readable:?}");
    }
}
