//! Tests the layers of the sandbox on this host.

use super::{
    backend::Supervisor,
    layers::{Layer, LayerReport, reports},
};

/// Tests each layer once on this host, and returns the results. For that it starts the current program as a supervisor.
///
/// The program's `main` must begin with a call of [`supervisor_main`](super::supervisor_main). If the supervisor does
/// not start, every layer is reported as missing for that reason.
pub fn check_host() -> Vec<LayerReport> {
    match Supervisor::this_program().probe() {
        Ok(probe) => reports(&probe),
        Err(error) => Layer::ALL
            .into_iter()
            .map(|layer| LayerReport { layer, active: false, required: true, detail: error.to_string(), remedy: None })
            .collect(),
    }
}
