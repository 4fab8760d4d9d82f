//! `health`: whether a server or a worker is well, by the exit code: for probes of containers, which have no other
//! tool.
use super::{arguments::HealthArguments, heartbeat};
use std::time::Duration;

/// The longest time that the server may take.
const PATIENCE: Duration = Duration::from_secs(5);

/// Returns whether it is.
pub(super) fn run(arguments: &HealthArguments) -> bool {
    let Some(server) = &arguments.server else {
        let alive = heartbeat::is_alive(&arguments.data);
        match alive {
            true => println!("alive"),
            false => println!("no sign of life lately of a server or worker with --data {}", arguments.data.display()),
        }
        return alive;
    };
    let agent: ureq::Agent = ureq::Agent::config_builder().timeout_global(Some(PATIENCE)).build().into();
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
