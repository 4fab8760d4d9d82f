//! Builds again when a scene or a recording appears: both are embedded.

fn main() {
    println!("cargo:rerun-if-changed=../../assets");
    println!("cargo:rerun-if-changed=../../references");
}
