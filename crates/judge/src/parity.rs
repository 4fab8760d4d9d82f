//! The original's rule book: lock-step comparison (oracle-behaviour.md 4 to 6).
pub use super::{
    options::Options,
    progress::{Progress, Remark, StepFindings, StepPlace, WrongStep},
};

use super::outcome::Outcome;
use fosssim_model::scene::Scene;

/// Judges a trace as the original does, in lock step with the reference: each step starts from the trace's own state,
/// takes over its mid record, and is compared with its end record (oracle-behaviour.md 4 to 6). Memory does not depend
/// on the trace's length. What follows the last record is not read, save for one byte that tells whether it is there.
pub fn judge<R: std::io::Read + Send>(
    scene: &Scene,
    mut trace: R,
    options: &Options,
    progress: &mut dyn Progress,
) -> Outcome {
    super::replay::judge(scene, &mut trace, options, progress)
}
