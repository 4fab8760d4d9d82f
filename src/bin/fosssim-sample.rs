//! The program `fosssim-sample`: the [sample](fosssim_oracle::sample) as a separate program, for tests and for
//! developers.
#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    fosssim_oracle::sample::main(std::env::args_os(), None)
}
