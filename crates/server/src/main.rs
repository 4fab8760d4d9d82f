//! The command `fosssim-server`, which calls [`fosssim_server::cli`].
#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    fosssim_server::cli::main()
}
