//! The report on one trace of a program.
use fosssim_findings::disclosure::DisclosedFinding;
use fosssim_mistakes::diagnose::Explanation;

/// A trace, with everything that a report shows of it.
#[derive(Debug, Clone)]
pub struct Case {
    /// The scene's name.
    pub scene: String,
    /// The origin of the trace.
    pub trace: String,
    /// Whether the fair rules accept the trace.
    pub accepted: bool,
    /// A note, such as the end of the program, or the reason why the trace can't be read.
    pub note: Option<String>,
    /// The first fault, if hints show it.
    pub first: Option<DisclosedFinding>,
    /// Likely mistakes, the likeliest first.
    pub explanations: Vec<Explanation>,
}
