//! The command `serve`, which starts the program `fosssim-server` in place of this one. This program contains no
//! server.
use crate::cli::arguments::ServeArguments;
use anyhow::{Context, Result, bail};
use std::{os::unix::process::CommandExt, process::Command};

pub(super) fn run(arguments: &ServeArguments) -> Result<()> {
    let server = std::env::current_exe().context("cannot find this program")?.with_file_name("fosssim-server");
    if !server.is_file() {
        bail!(
            "there is no {}: install the package fosssim-server (docs/install.md), or build it next to this program \
             with `cargo build --release -p fosssim-server`",
            server.display()
        );
    }
    // The call returns only if it fails.
    let error = Command::new(&server).arg("serve").args(&arguments.arguments).exec();
    Err(error).with_context(|| format!("cannot start {}", server.display()))
}
