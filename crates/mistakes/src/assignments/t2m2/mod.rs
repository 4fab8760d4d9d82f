//! Theme 2, Milestone 2: continuous-time detection, impulses, impact zones and the rigid failsafe.
pub(crate) mod catalogue;
pub(crate) mod exchanges;
pub(crate) mod extras;
pub(crate) mod formulas;
pub(crate) mod ingredients;
mod inputs;
mod motion;
pub(super) mod probes;
pub(crate) mod specials;
mod subject;

pub use catalogue::{Area, CATALOGUE, Mistake, Row, RowKind, find};
pub(crate) use inputs::Inputs;
pub use motion::{Body, Motion};
pub(crate) use subject::Subject;
