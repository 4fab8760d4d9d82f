//! The work of the service's fuzz target. The service's tests replay the seeds and changed seeds through the same
//! function.
use fosssim_intake::ArchiveLimits;
use fosssim_server::web;
use std::{
    collections::BTreeSet,
    fs::{self, File},
    path::Path,
};

/// The limits are so small that inputs reach them.
const LIMITS: ArchiveLimits = ArchiveLimits { bytes: 1 << 16, entries: 64 };

/// Checks and unpacks an archive from a stranger. Returns whether it is accepted.
pub fn archive(bytes: &[u8]) -> bool {
    let place = tempfile::tempdir().expect("a folder");
    let (file, outside, folder) =
        (place.path().join("upload"), place.path().join("outside"), place.path().join("in/folder"));
    fs::write(&file, bytes).expect("a file");
    fs::write(&outside, "untouched").expect("a file");
    fs::create_dir_all(&folder).expect("a folder");
    let open = || File::open(&file).expect("the file");
    let looked = fosssim_intake::list_archive(open(), LIMITS);
    let unpacked = fosssim_intake::unpack(open(), &folder, LIMITS);
    assert_eq!(looked.is_ok(), unpacked.is_ok(), "what is looked through can be unpacked: {looked:?}, {unpacked:?}");
    // In every case, no file is outside, there are no links, and the size is within the limit.
    assert_eq!(fs::read_to_string(&outside).expect("the file"), "untouched");
    let beside: Vec<_> =
        fs::read_dir(place.path()).expect("a folder").map(|entry| entry.expect("an entry").file_name()).collect();
    assert_eq!(beside.len(), 3, "{beside:?}");
    assert_eq!(fs::read_dir(place.path().join("in")).expect("a folder").count(), 1);
    let (mut found, mut size) = (BTreeSet::new(), 0);
    walk(&folder, &folder, &mut found, &mut size);
    assert!(size <= LIMITS.bytes + (64 << 10), "{size} bytes");
    let Ok(files) = looked else { return false };
    let told: BTreeSet<String> = files.iter().map(|file| file.to_string_lossy().into_owned()).collect();
    assert_eq!((told.len(), &told), (files.len(), &found), "told and unpacked are the same, each once");
    true
}

/// The largest file of a form.
const LARGEST: u64 = 1 << 12;

/// Receives a form as a browser sends it, in pieces whose size is the first byte. Returns whether it is accepted.
pub fn form(bytes: &[u8]) -> bool {
    let Some((pieces, body)) = bytes.split_first() else { return false };
    let place = tempfile::tempdir().expect("a folder");
    let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build().expect("a runtime");
    let received = runtime.block_on(web::receive_form(place.path(), body, usize::from(*pieces), LARGEST));
    // In every case the size is within the limit, and no files are left.
    assert_eq!(fs::read_dir(place.path()).expect("a folder").count(), 0);
    match received {
        Ok((size, [_, kind, key])) => {
            assert!(size <= LARGEST && size <= body.len() as u64, "{size} bytes of {}", body.len());
            assert!([kind, key].into_iter().flatten().all(|word| (1..=200).contains(&word.len())));
            true
        }
        Err(problem) => {
            assert!((400..500).contains(&problem.status), "{problem:?}");
            false
        }
    }
}

fn walk(root: &Path, folder: &Path, found: &mut BTreeSet<String>, size: &mut u64) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let entry = entry.expect("an entry");
        let kind = entry.file_type().expect("a kind");
        assert!(kind.is_file() || kind.is_dir(), "{}", entry.path().display());
        if kind.is_dir() {
            walk(root, &entry.path(), found, size);
        } else {
            *size += entry.metadata().expect("a file").len();
            found.insert(entry.path().strip_prefix(root).expect("beneath").to_string_lossy().into_owned());
        }
    }
}
