//! Which walls of the sandbox hold on this host.

use super::{
    backend::Supervisor,
    layers::{Layer, LayerReport, reports},
};

/// Returns which walls hold on this host, tried once by starting this very program as a supervisor.
///
/// The program must call [`supervisor_main`](super::supervisor_main) first of all. When not even the supervisor
/// starts, every wall is reported as missing with that reason.
#[must_use]
pub fn doctor() -> Vec<LayerReport> {
    match Supervisor::this_program().probe() {
        Ok(probe) => reports(&probe),
        Err(error) => Layer::ALL
            .into_iter()
            .map(|layer| LayerReport { layer, active: false, required: true, detail: error.to_string(), remedy: None })
            .collect(),
    }
}
