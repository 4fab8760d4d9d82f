//! The fuzzer's seeds, replayed as ordinary tests through the fuzz targets' own functions.
use fosssim_oracle::{
    scene::original,
    suite::{config, results},
};
use std::path::{Path, PathBuf};

#[path = "../../fuzz/entries.rs"]
mod entries;

/// Returns the seeds of a target, in the order of their names.
fn seeds(target: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds").join(target);
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(&folder).expect("a folder of seeds").map(|entry| entry.expect("a seed").path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "{} holds no seed", folder.display());
    paths.into_iter().map(|path| (path.clone(), std::fs::read(path).expect("a readable seed"))).collect()
}

#[test]
fn scene_seeds_do_no_harm() {
    let mut accepted = 0;
    for (path, bytes) in seeds("scene") {
        eprintln!("{}", path.display());
        entries::scene(&bytes);
        accepted += usize::from(original::read(&bytes).is_ok());
    }
    assert!(accepted > 0, "seeds that are all rejected do not reach the simulator");
}

#[test]
fn trace_seeds_do_no_harm() {
    for (path, bytes) in seeds("trace") {
        eprintln!("{}", path.display());
        entries::trace(&bytes);
    }
}

#[test]
fn judge_seeds_do_no_harm() {
    for (path, bytes) in seeds("judge") {
        eprintln!("{}", path.display());
        entries::judge(&bytes);
        entries::explain(&bytes);
    }
}

#[test]
fn suite_seeds_do_no_harm() {
    let mut accepted = 0;
    for (path, bytes) in seeds("suite") {
        eprintln!("{}", path.display());
        entries::suite(&bytes);
        accepted += usize::from(std::str::from_utf8(&bytes).is_ok_and(|text| config::read(text).is_ok()));
    }
    assert!(accepted > 1, "{accepted} seeds are suites");
}

#[test]
fn journal_seeds_do_no_harm() {
    let mut kept = 0;
    for (path, bytes) in seeds("journal") {
        eprintln!("{}", path.display());
        entries::journal(&bytes);
        kept += usize::from(results::read_line(&bytes).is_some());
    }
    assert!(kept > 1, "{kept} seeds keep a result");
}

#[test]
fn wire_seeds_do_no_harm() {
    let messages: usize = seeds("wire").iter().map(|(_, bytes)| entries::wire(bytes)).sum();
    assert!(messages > 4, "{messages} messages in all seeds");
}

/// The judge's seeds include every collision type with extreme states of all sizes.
#[test]
fn every_extreme_of_every_collision_type_is_a_seed() {
    let seeds = seeds("judge");
    for choice in 0..entries::SCENES.len() {
        for value in entries::EXTREMES {
            let seed = [&[u8::try_from(choice).expect("few scenes")], &entries::extreme(choice, value)[..]].concat();
            assert!(seeds.iter().any(|(_, bytes)| *bytes == seed), "no seed has {value} in scene {choice}");
        }
    }
}

/// The valid seeds are recordings of the target's scenes, so that mutations start from accepted traces.
#[test]
fn every_scene_of_the_trace_target_has_its_recording_as_a_seed() {
    let seeds = seeds("trace");
    for (choice, xml) in entries::SCENES.iter().enumerate() {
        let scene = original::read(xml.as_bytes()).expect("a scene").scene;
        let (_, trace, sound) = entries::record(&scene, usize::MAX).expect("writing to memory");
        assert!(sound);
        let seed = [&[u8::try_from(choice).expect("few scenes")], &trace[..]].concat();
        assert!(seeds.iter().any(|(_, bytes)| *bytes == seed), "no seed is the recording of scene {choice}");
    }
}
