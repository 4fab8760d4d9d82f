//! The command `fosssim-server`: a shim around [`fosssim_server::cli`].

fn main() -> std::process::ExitCode {
    fosssim_server::cli::main()
}
