#![no_main]
//! Fuzz target: see `archive` in `uploads.rs`.

#[path = "../uploads.rs"]
#[allow(dead_code)]
mod uploads;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = uploads::archive(bytes);
});
