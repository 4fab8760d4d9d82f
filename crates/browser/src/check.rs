//! Answers the request `check` with the same reports as the command.
use crate::{
    dropped::{PageHost, PageProgress, ReadFault, open},
    parts::PageAnswer,
    scenes,
};
use fosssim_evidence::{self as evidence, KeptPart, examine};
use fosssim_judge::{
    Rules,
    replay::{ObserverPair, Options},
};
use fosssim_model::scene::{self, Scene};
use fosssim_report::{
    check::{
        Check, SNIFFED_BYTES, StepChoice, WrongSteps, describe_no_verdict, describe_unread, detect_file_kind,
        needs_explanation,
    },
    page, scene_problems,
};
use serde::Deserialize;
use serde_json::json;
use std::io::{Cursor, Read};

/// A request to judge a trace.
#[derive(Debug, Deserialize)]
pub(crate) struct CheckRequest {
    /// The name of the scene. For an embedded scene it is `asset:Group/name`, otherwise the name of the scene's file.
    scene: String,
    /// The name of the file with the trace.
    trace: String,
    /// The number of the file among the dropped files.
    #[serde(default)]
    file: u32,
    #[serde(default)]
    rules: Rules,
    /// Whether the answer contains the HTML page as well as the JSON.
    #[serde(default)]
    html: bool,
}

/// Judges a trace. The second part of the answer is what `check --format json` prints, and the third what `check
/// --format html` prints.
pub(crate) fn answer(request: &CheckRequest, xml: Option<&[u8]>, host: &dyn PageHost) -> PageAnswer {
    let scene = read_scene(&request.scene, xml)?;
    let fault = ReadFault::new();
    let (mut trace, mut start) = (open(host, request.file, &fault), Vec::new());
    // If bytes can't be read, this is noticed below.
    let _ = trace.by_ref().take(SNIFFED_BYTES).read_to_end(&mut start);
    let file_kind = detect_file_kind(&start);
    let options = Options { threads: 1, uses_fair_rules: request.rules.includes_fair(), ..Options::default() };
    let (mut progress, mut wrong) = (PageProgress { host, all: scene.step_count() }, WrongSteps::new(StepChoice::None));
    let observers = &mut ObserverPair(&mut progress, &mut wrong);
    let examination = examine(&scene, Cursor::new(start).chain(trace), KeptPart::All, &options, observers);
    let outcome = &examination.outcome;
    // Judging is reported as complete here. The search for the mistake follows, and may take as long.
    host.progress(scene.step_count(), scene.step_count());
    if let Some(message) = describe_no_verdict(outcome, &request.scene) {
        return Err(message);
    }
    if let Some(error) = fault.get() {
        return Err(describe_unread(outcome, &request.trace, error));
    }
    let explanations = if needs_explanation(outcome) { examination.explain() } else { Vec::new() };
    let check = Check {
        scene: &request.scene,
        trace: &request.trace,
        outcome,
        explanations: &explanations,
        rules: request.rules,
        steps: &wrong,
        other_file_kind: file_kind,
    };
    let mut parts = vec![check.json().into_bytes()];
    if request.html {
        let mut second_reading = (!examination.trace.is_whole()).then(|| open(host, request.file, &fault));
        let evidence = examination
            .gather_evidence(second_reading.as_mut().map(|trace| trace as &mut dyn Read), evidence::MAX_NUMBERS);
        parts.push(page::examined_page(check, &examination, &evidence).into_bytes());
    }
    let value = json!({
        "accepted": check.is_accepted(), "verdict": check.verdict(), "difference": check.difference(),
    });
    Ok((value, parts))
}

/// Reads a scene that was dropped or is embedded.
pub(crate) fn read_scene(name: &str, xml: Option<&[u8]>) -> Result<Scene, String> {
    let xml = match (xml, name.strip_prefix("asset:")) {
        (Some(xml), _) => xml,
        (None, Some(asset)) => scenes::find_xml(asset)?,
        (None, None) => return Err("the scene is missing".to_owned()),
    };
    match scene::read(name, xml) {
        Ok(loaded) => Ok(loaded.scene),
        Err(errors) => Err(scene_problems::render_errors(name, xml, &errors)),
    }
}
