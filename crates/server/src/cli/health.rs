//! The command `health`, for probes in containers without other tools. Its exit code reports whether a server or a
//! worker is healthy.
use super::{arguments::HealthArguments, heartbeat};
use std::time::Duration;

/// The maximum time to wait for the server's answer.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(5);

/// Prints the state of the server or worker, and returns whether it is healthy.
pub(super) fn run(arguments: &HealthArguments) -> bool {
    let Some(server) = &arguments.server else {
        let alive = heartbeat::is_alive(&arguments.data);
        match alive {
            true => println!("alive"),
            false => println!("no recent heartbeat of a server or worker with --data {}", arguments.data.display()),
        }
        return alive;
    };
    let agent: ureq::Agent = ureq::Agent::config_builder().timeout_global(Some(ANSWER_TIMEOUT)).build().into();
    match agent.get(format!("{server}/ready")).call() {
        Ok(_) => {
            println!("ready");
            true
        }
        Err(error) => {
            println!("not ready: {error}");
            false
        }
    }
}
