//! The last words of `cargo test`: which tests did not run on this machine, and why. A program of its own, because the
//! usual harness keeps what tests print to itself.
#![forbid(unsafe_code)]

fn main() {
    // A program that lists tests, such as cargo nextest, finds none here.
    if std::env::args().any(|word| word == "--list") {
        return;
    }
    let Some(path) = fosssim_testing::list() else { return };
    let list = std::fs::read_to_string(&path).unwrap_or_default();
    print!("\n{}", fosssim_testing::summary(&list));
    // A list that somebody asked for stays; ours has been read.
    if std::env::var_os(fosssim_testing::LIST).is_none() {
        drop(std::fs::remove_file(path));
    }
}
