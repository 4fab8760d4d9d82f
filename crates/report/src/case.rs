//! The report on one trace of a program.
use fosssim_findings::disclosure::DisclosedFinding;
use fosssim_mistakes::diagnose::Explanation;

/// A trace, and everything that a report shows about it.
#[derive(Debug, Clone)]
pub struct Case {
    /// The scene's name.
    pub scene: String,
    /// The file of the trace, or the program that wrote it.
    pub trace: String,
    /// Whether the fair rules accept the trace.
    pub accepted: bool,
    /// A remark, such as how the program ended, or why the trace can't be read.
    pub note: Option<String>,
    /// The first fault; `None` if there is none, or if the hints hide it.
    pub first: Option<DisclosedFinding>,
    /// Likely mistakes, the likeliest first.
    pub explanations: Vec<Explanation>,
}
