//! The program `fosssim-sample`, which is the [sample] as a separate program, for tests and for
//! developers.
#![forbid(unsafe_code)]

use fosssim_oracle::sample;

fn main() -> std::process::ExitCode {
    sample::main(std::env::args_os(), sample::pinned_mistake::pinned_mistake())
}
