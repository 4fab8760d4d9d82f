//! The command `fosssim-server`: a shim around [`fosssim_server::cli`].
#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    fosssim_server::cli::main()
}
