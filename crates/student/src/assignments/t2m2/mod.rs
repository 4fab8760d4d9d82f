//! Theme 2, Milestone 2: continuous-time detection, impulses, impact zones and the rigid failsafe.
pub mod catalog;
mod edits;
pub mod extra_letters;
pub mod formulas;
pub mod ingredients;
mod inputs;
mod named_edits;
pub(super) mod probes;
mod reading;
mod special_formulas;

pub use catalog::{CATALOG, Mistake, Row};
pub use edits::{FormulaEdit, NamedEdit};
pub use formulas::Letter;
pub use fosssim_findings::explanation::{Input, Reading, Subject};
pub use inputs::Inputs;
pub use named_edits::{NAMED_EDITS, find_edit};
pub use reading::letter;
