//! Theme 2, Milestone 2: continuous-time detection, impulses, impact zones and the rigid failsafe.
pub mod catalogue;
mod edits;
pub mod extras;
pub mod formulas;
pub mod ingredients;
mod inputs;
mod named;
pub(super) mod probes;
mod reading;
mod specials;

pub use catalogue::{CATALOGUE, Mistake, Row};
pub use edits::{FormulaEdit, NamedEdit};
pub use formulas::Letter;
pub use fosssim_findings::explanation::{Input, Reading, Subject};
pub use inputs::Inputs;
pub use named::{NAMED_EDITS, find_edit};
pub use reading::letter;
