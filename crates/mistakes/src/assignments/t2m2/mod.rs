//! Theme 2, Milestone 2: continuous-time detection, impulses, impact zones and the rigid failsafe.
pub(crate) mod catalogue;
pub(crate) mod exchanges;
pub(crate) mod extras;
pub(crate) mod formulas;
pub(crate) mod ingredients;
mod inputs;
pub(super) mod probes;
mod reading;
pub(crate) mod specials;

pub use catalogue::{CATALOGUE, Mistake, Row};
pub use exchanges::{EXCHANGES, Exchange, find_exchange};
pub use formulas::Letter;
pub use fosssim_findings::explanation::{Input, Reading, Subject};
pub(crate) use inputs::Inputs;
pub use reading::letter;
pub use specials::{SPECIALS, Special, find_special};
