//! The command line (follows).

/// Runs the command.
#[must_use]
pub fn main() -> std::process::ExitCode {
    // Before anything else and before any thread: this process may be a sandbox's supervisor.
    if let Some(code) = crate::sandbox::supervisor_main(std::env::args_os()) {
        return code;
    }
    std::process::ExitCode::from(2)
}
