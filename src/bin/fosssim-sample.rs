//! `fosssim-sample`: the [sample](fosssim_oracle::sample) as a program of its own, for tests and for developers.
#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    fosssim_oracle::sample::main(std::env::args_os(), None)
}
