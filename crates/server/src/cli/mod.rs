//! The command line of the service.

mod archive_check;
mod arguments;
mod backup;
mod folders;
mod health;
mod heartbeat;
mod logging;
mod serve;
mod worker;

use anyhow::Result;
use arguments::{Arguments, Command};
use clap::{CommandFactory, Parser};
use std::process::ExitCode;
use tokio_util::sync::CancellationToken;

/// Runs the command that the program's arguments request.
pub fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &Arguments) -> Result<u8> {
    // This command uses neither threads nor a log: its memory is limited, and its output is only the answer.
    if let Command::LookThrough(arguments) = &arguments.command {
        return archive_check::run(arguments).map(|()| 0);
    }
    logging::start_log(arguments.log_format);
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    runtime.block_on(async {
        match &arguments.command {
            Command::Serve(arguments) => serve::serve(arguments).await?,
            Command::Worker(arguments) => worker::run(arguments).await?,
            Command::AdminLink(arguments) => serve::admin_link(arguments).await?,
            Command::WorkerToken(arguments) => serve::worker_token(arguments).await?,
            Command::Backup(arguments) => backup::backup(arguments).await?,
            Command::Restore(arguments) => backup::restore(arguments).await?,
            Command::Health(arguments) => return Ok(u8::from(!health::run(arguments))),
            Command::LookThrough(_) => {}
            Command::Openapi => print!("{}", crate::web::openapi()),
            Command::Man { command } => {
                let mut all = Arguments::command();
                all.build();
                let described_command =
                    command.as_ref().and_then(|name| all.find_subcommand(name)).unwrap_or(&all).clone();
                clap_mangen::Man::new(described_command).render(&mut std::io::stdout())?;
            }
            Command::Completions { shell } => {
                clap_complete::generate(*shell, &mut Arguments::command(), "fosssim-server", &mut std::io::stdout());
            }
        }
        Ok(0)
    })
}

/// Returns a token that the first SIGINT or SIGTERM cancels. The second signal ends the process immediately.
fn cancel_on_signal() -> Result<CancellationToken> {
    use tokio::signal::unix::{SignalKind, signal};
    let (mut interrupt, mut terminate) = (signal(SignalKind::interrupt())?, signal(SignalKind::terminate())?);
    let stop = CancellationToken::new();
    let cancelled = stop.clone();
    tokio::spawn(async move {
        for again in [false, true] {
            tokio::select! {
                _ = interrupt.recv() => {}
                _ = terminate.recv() => {}
            }
            if again {
                std::process::exit(130);
            }
            heartbeat::notify_stopping();
            tracing::info!("stopping; jobs are returned to the queue (press again to stop immediately)");
            cancelled.cancel();
        }
    });
    Ok(stop)
}
