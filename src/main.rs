//! The command `fosssim-oracle`, which calls [`fosssim_oracle::cli`].
#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    fosssim_oracle::cli::main()
}
