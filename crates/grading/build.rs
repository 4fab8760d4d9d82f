//! Reruns this script when a scene or a recording is added, because both are embedded.
#![forbid(unsafe_code)]

fn main() {
    println!("cargo:rerun-if-changed=../../assets");
    println!("cargo:rerun-if-changed=../../references");
}
