//! Tests the layers of the sandbox on this host.

use super::{
    backend::Supervisor,
    layers::{Layer, LayerReport, reports},
};

/// Tests every layer once on this host and returns the results. Starts the current program as a supervisor.
///
/// The program must call [`supervisor_main`](super::supervisor_main) first in its `main`. If the supervisor does not
/// start, every layer is reported as missing for that reason.
#[must_use]
pub fn check_host() -> Vec<LayerReport> {
    match Supervisor::this_program().probe() {
        Ok(probe) => reports(&probe),
        Err(error) => Layer::ALL
            .into_iter()
            .map(|layer| LayerReport { layer, active: false, required: true, detail: error.to_string(), remedy: None })
            .collect(),
    }
}
