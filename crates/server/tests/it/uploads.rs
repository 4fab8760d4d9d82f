//! The fuzzer's seeds of uploads, and what becomes of them when bytes change, through the fuzz target's own function.
use std::path::Path;

#[path = "../../../../fuzz/uploads.rs"]
mod entries;

/// Changed seeds that are tried; `FOSSSIM_FUZZ` asks for more.
const TRIES: usize = 4000;

#[test]
fn archives_of_strangers_do_no_harm() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/archive");
    let mut paths: Vec<_> =
        std::fs::read_dir(folder).expect("a folder of seeds").map(|entry| entry.expect("a seed").path()).collect();
    paths.sort();
    let seeds: Vec<Vec<u8>> = paths.iter().map(|path| std::fs::read(path).expect("a seed")).collect();
    let accepted: Vec<String> = paths
        .iter()
        .zip(&seeds)
        .filter(|(_, bytes)| entries::archive(bytes))
        .map(|(path, _)| path.file_name().expect("a name").to_string_lossy().into_owned())
        .collect();
    assert_eq!(accepted, ["sources.tar", "sources.tar.gz", "sources.zip"]);
    // The same changes on every run: what fails once fails again.
    let mut state: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        usize::try_from(state >> 33).expect("31 bits") % below.max(1)
    };
    let tries = std::env::var("FOSSSIM_FUZZ").ok().and_then(|number| number.parse().ok()).unwrap_or(TRIES);
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
    assert!(sound > tries / 50, "{sound} of {tries} are archives: changes that are all refused reach nothing");
}
