//! One trace of a program, and the report on it.
use fosssim_findings::disclosure::DisclosedFinding;
use fosssim_mistakes::diagnose::Explanation;

/// A trace, and all that a report shows of it.
#[derive(Debug, Clone)]
pub struct Case {
    /// The scene's name.
    pub scene: String,
    /// The origin of the trace.
    pub trace: String,
    /// Whether the fair rules accept the trace.
    pub accepted: bool,
    /// A further remark, such as how its program ended, or why it can't be read.
    pub note: Option<String>,
    /// The first thing that is wrong, if hints show it.
    pub first: Option<DisclosedFinding>,
    /// Likely mistakes, the likeliest first.
    pub explanations: Vec<Explanation>,
}
