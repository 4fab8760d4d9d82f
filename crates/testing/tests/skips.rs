//! The last output of `cargo test`: the tests that did not run on this machine, and why. This is a separate program,
//! because the usual harness hides the output of tests.
#![forbid(unsafe_code)]

fn main() {
    // A program that lists tests, such as cargo nextest, finds no tests here.
    if std::env::args().any(|word| word == "--list") {
        return;
    }
    let Some(path) = fosssim_testing::skip_list() else { return };
    let list = std::fs::read_to_string(&path).unwrap_or_default();
    print!("\n{}", fosssim_testing::summary(&list));
    // A list with a name from the user stays. The default list has been read, and is removed.
    if std::env::var_os(fosssim_testing::LIST).is_none() {
        drop(std::fs::remove_file(path));
    }
}
