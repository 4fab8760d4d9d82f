//! The page about a trace that was just judged.
use super::{Case, MistakeRun};
use crate::{check::Check, words::explanation};
use fosssim_evidence::{Evidence, ExaminedTrace, Track};
use fosssim_findings::Hints;
use fosssim_mistakes::diagnose::Explanation;
use fosssim_model::scene::Scene;
use fosssim_student::{self as student};

impl MistakeRun {
    /// Runs the reference with the mistake of an explanation built in, and compares the result with the trace. Returns
    /// `None` if the explanation is about no known mistake or reproduces no step, if the trace was not kept completely,
    /// or if the evidence does not contain the whole motion.
    pub fn for_scene(scene: &Scene, named: &Explanation, trace: Option<&[u8]>, evidence: &Evidence) -> Option<Self> {
        // An incomplete motion cannot be compared.
        let trace = trace?;
        if named.reproduced == 0 || !evidence.window.is_whole(evidence.layout.steps) {
            return None;
        }
        let row = student::find(&named.key)?;
        let run =
            student::record_trace(scene, student::Student::new(Some(row.mistake))).unwrap_or_else(|(part, _)| part);
        let track = Track::read(&mut &run[..], evidence.layout, evidence.window);
        Some(Self { id: named.key.clone(), sentence: explanation::describe(named), track, equal: run == trace })
    }
}

/// Renders the page about one judged trace. It has full hints, because the author of the trace requests it.
pub fn examined_page(check: Check<'_>, examined: &ExaminedTrace<'_>, evidence: &Evidence) -> String {
    let scene = examined.scene;
    let trace = (examined.trace.is_whole() && !check.explanations.is_empty()).then(|| examined.trace.bytes());
    let what_if = check.explanations.first().and_then(|first| MistakeRun::for_scene(scene, first, trace, evidence));
    let title = format!("{}: {}", check.verdict(), check.scene);
    let (evidence, what_if) = (Some(evidence), what_if.as_ref());
    Case { check, scene, evidence, mistake_run: what_if, hints: Hints::Full, has_trace: true }.render_page(&title)
}
