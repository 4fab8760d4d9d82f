//! Tests the fuzzer's seeds of uploads, and changed seeds, with the fuzz target's own function.
use std::path::Path;

#[path = "../../../../fuzz/uploads.rs"]
mod entries;

/// The number of changed seeds that are tried. `FOSSSIM_FUZZ` sets a larger number.
const TRIES: usize = 4000;

/// Returns the same random numbers on every run, so that failures are reproducible.
fn random() -> impl FnMut(usize) -> usize {
    let mut state: u64 = 0x9e37_79b9_7f4a_7c15;
    move |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        usize::try_from(state >> 33).expect("31 bits") % below.max(1)
    }
}

fn tries() -> usize {
    std::env::var("FOSSSIM_FUZZ").ok().and_then(|number| number.parse().ok()).unwrap_or(TRIES)
}

/// Returns the seeds of a target, by name.
fn seeds(target: &str) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds").join(target);
    let mut paths: Vec<_> =
        std::fs::read_dir(folder).expect("a folder of seeds").map(|entry| entry.expect("a seed").path()).collect();
    paths.sort();
    let name = |path: &Path| path.file_name().expect("a name").to_string_lossy().into_owned();
    paths.iter().map(|path| (name(path), std::fs::read(path).expect("a seed"))).collect()
}

#[test]
fn forms_of_strangers_do_no_harm() {
    let seeds = seeds("upload");
    let accepted: Vec<&str> =
        seeds.iter().filter(|(_, bytes)| entries::form(bytes)).map(|(name, _)| name.as_str()).collect();
    assert_eq!(accepted, ["file-alone", "file-first", "name-encoded", "usual"]);
    let mut random = random();
    let tries = tries();
    let mut sound = 0;
    for _ in 0..tries {
        let mut bytes = seeds[random(seeds.len())].1.clone();
        for _ in 0..=random(4) {
            let at = random(bytes.len());
            match random(6) {
                0 => bytes[at] ^= 1 << random(8),
                1 => bytes[at] = u8::try_from(random(256)).expect("a byte"),
                2 => bytes.truncate(at.max(1)),
                // The size of the pieces decides where boundaries are cut.
                3 => bytes[0] = u8::try_from(random(256)).expect("a byte"),
                4 => {
                    let other = &seeds[random(seeds.len())].1;
                    let from = random(other.len());
                    bytes.splice(at..at, other[from..(from + 90).min(other.len())].iter().copied());
                }
                _ => {
                    let word = [&b"\r\n--x"[..], b"\r\n\r\n", b"--x--\r\n", b"\"", b"filename=", b"\0"][random(6)];
                    bytes.splice(at..at, word.iter().copied());
                }
            }
        }
        sound += usize::from(entries::form(&bytes));
    }
    assert!(sound > tries / 50, "{sound} of {tries} are forms: changes that are all rejected reach nothing");
}

#[test]
fn archives_of_strangers_do_no_harm() {
    let named = seeds("archive");
    let accepted: Vec<&str> =
        named.iter().filter(|(_, bytes)| entries::archive(bytes)).map(|(name, _)| name.as_str()).collect();
    let seeds: Vec<Vec<u8>> = named.iter().map(|(_, bytes)| bytes.clone()).collect();
    assert_eq!(accepted, ["sources.tar", "sources.tar.gz", "sources.zip"]);
    let mut random = random();
    let tries = tries();
    let mut sound = 0;
    for _ in 0..tries {
        let mut bytes = seeds[random(seeds.len())].clone();
        for _ in 0..=random(4) {
            let at = random(bytes.len());
            match random(6) {
                0 => bytes[at] ^= 1 << random(8),
                1 => bytes[at] = u8::try_from(random(256)).expect("a byte"),
                2 => bytes.truncate(at.max(4)),
                // Names and sizes of one archive in another.
                3 => {
                    let other = &seeds[random(seeds.len())];
                    let from = random(other.len());
                    let count = random(64).min(other.len() - from).min(bytes.len() - at);
                    bytes[at..at + count].copy_from_slice(&other[from..from + count]);
                }
                4 => {
                    let piece = bytes[at..(at + 64).min(bytes.len())].to_vec();
                    bytes.splice(at..at, piece);
                }
                _ => {
                    for word in [&b"../"[..], b"/", b"..\\", b"\0", b"C:"].into_iter().skip(random(5)).take(1) {
                        let count = word.len().min(bytes.len() - at);
                        bytes[at..at + count].copy_from_slice(&word[..count]);
                    }
                }
            }
        }
        sound += usize::from(entries::archive(&bytes));
    }
    assert!(sound > tries / 50, "{sound} of {tries} are archives: changes that are all rejected reach nothing");
}
