//! Theme 2, Milestone 2: continuous-time detection, impulses, impact zones and the rigid failsafe.
pub mod catalogue;
pub mod exchanges;
pub mod extras;
pub mod formulas;
pub mod ingredients;
mod inputs;
pub(super) mod probes;
mod reading;
pub mod specials;

pub use catalogue::{CATALOGUE, Mistake, Row};
pub use exchanges::{EXCHANGES, Exchange, find_exchange};
pub use formulas::Letter;
pub use fosssim_findings::explanation::{Input, Reading, Subject};
pub use inputs::Inputs;
pub use reading::letter;
pub use specials::{SPECIALS, Special, find_special};
