#![no_main]
//! Fuzz target: see `wire` in `entries.rs`.

#[path = "../entries.rs"]
#[expect(dead_code, reason = "each target uses one of the entries")]
mod entries;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    entries::wire(bytes);
});
