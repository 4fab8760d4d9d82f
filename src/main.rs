//! The command `fosssim-oracle`: a shim around [`fosssim_oracle::cli`].
#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    fosssim_oracle::cli::main()
}
