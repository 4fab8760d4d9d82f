//! The pictures of judged traces, and the HTML pages that contain them.
use super::grade_ending::to_file_name;
use crate::{
    cli::output,
    evidence::{self, ExaminedTrace, Focus, KeptPart, examine},
    files::FilePlace,
    judge::{Rules, replay},
    report::{
        check::{Check, StepChoice, WrongSteps},
        page::{Audience, Card, Case, ClassPage, GradePage, MistakeRun},
    },
    suite::{
        Grade, SkippedEntry,
        cards::{self, Cards, DrawCard, JudgedTrace},
        catch_panic,
        config::Hints,
    },
};
use anyhow::{Context, Result};
use rayon::prelude::*;
use std::{
    ffi::OsString,
    path::{Path, PathBuf},
};

/// The maximum number of values of a scene's motion that are kept. Several scenes are graded in parallel, so it is
/// limited. The largest course scene has 70,444 values.
const MAX_MOTION_VALUES: usize = 1 << 19;

/// The cards of a grading, and the folder in which its pages are written.
pub(super) struct Pages {
    cards: FilePlace,
    /// The folder for pages; `None` if none are written.
    folder: Option<PathBuf>,
    /// Whether pages for students are written as well.
    for_students: bool,
    _temporary: Option<tempfile::TempDir>,
}

impl Pages {
    /// Prepares pages in the folder for results. Without such a folder, no pages are written, and cards are kept only
    /// during the grading.
    pub(super) fn new(folder: Option<&Path>, for_students: bool) -> Result<Self> {
        let (cards, temporary) = match folder {
            Some(folder) => (FilePlace::new(folder, "cards"), None),
            None => {
                let temporary =
                    tempfile::Builder::new().prefix("fosssim-cards-").tempdir().context("no temporary folder")?;
                (FilePlace::new(temporary.path(), ""), Some(temporary))
            }
        };
        Ok(Self { cards, folder: folder.map(Path::to_owned), for_students, _temporary: temporary })
    }

    /// Returns a storage of cards that uses this folder. `draw` draws each card.
    pub(super) fn new_cards<'a>(&'a self, draw: &'a DrawCard<'a>) -> Cards<'a> {
        Cards { folder: &self.cards, draw, for_students: self.for_students }
    }

    /// Removes the cards of earlier gradings.
    pub(super) fn remove_cards(&self) {
        let is_card = |name: &OsString| Path::new(name).extension().is_some_and(|extension| extension == "zst");
        for name in self.cards.list_names().unwrap_or_default().iter().filter(|name| is_card(name)) {
            // If a card can't be removed, it only uses space.
            drop(self.cards.join(name).remove());
        }
    }

    /// Returns the stored card of this name, if there is one.
    pub(super) fn card(&self, name: Option<&str>) -> Option<Card> {
        Card::from_stored(&cards::read_card(&self.cards, name?)?)
    }

    /// Stores a card, and returns its name. Returns `None` if there is no card or it can't be stored; then only the
    /// picture is missing.
    pub(super) fn store_card(&self, card: Option<Card>) -> Option<String> {
        cards::store_card_file(&self.cards, &card?.to_stored()).ok()
    }

    /// Renders the page of one submission.
    pub(super) fn render_grade(&self, grade: &Grade, class: Option<&str>, reader: Audience) -> String {
        GradePage { grade, card: &|name| self.card(name), class, reader }.html()
    }

    /// Writes the pages for staff into the folder for results. The pages for students are written next to them, always
    /// for a class, and for a single submission if requested. Returns the page that a reader should open first.
    pub(super) fn write(
        &self,
        grades: &[Grade],
        skipped: &[SkippedEntry],
        reader: Audience,
    ) -> Result<Option<PathBuf>> {
        let Some(folder) = &self.folder else { return Ok(None) };
        let write = |name: &str, page: &str| {
            let place = FilePlace::new(folder, name);
            output::write_below(&place, page.as_bytes()).map(|()| Some(place.path()))
        };
        if reader == Audience::Student || grades.len() > 1 {
            grades.par_iter().try_for_each(|grade| {
                let name = format!("students/{}.html", to_file_name(&grade.submission));
                write(&name, &self.render_grade(grade, None, Audience::Student)).map(drop)
            })?;
        }
        if let [grade] = grades {
            return write("report.html", &self.render_grade(grade, None, Audience::Staff));
        }
        grades.par_iter().try_for_each(|grade| {
            let name = format!("reports/{}.html", to_file_name(&grade.submission));
            write(&name, &self.render_grade(grade, Some("../index.html"), Audience::Staff)).map(drop)
        })?;
        // File names are already safe in a URL, except for blanks.
        let page_url = |grade: &Grade| format!("reports/{}.html", to_file_name(&grade.submission).replace(' ', "%20"));
        write("index.html", &ClassPage { grades, skipped_entries: skipped, page_url: &page_url }.html())
    }
}

/// The sentence above the card of a trace that was compared with a recording.
const RECORDING_NOTE: &str = "The verdict compares with the recording, where nearly everything after the first wrong \
    step differs. The steps below are judged from the trace's own state before each step, to show which ones are \
    wrong by themselves, and which only follow from others.";

/// Draws the card of a graded scene. If the trace was compared with a recording, each step is judged again for the
/// card, from the trace's own state. Returns `None` if the hints show only the verdict, or if this judgment fails.
pub(super) fn draw_card(judged_trace: &JudgedTrace<'_>, recorded: bool) -> Option<String> {
    if judged_trace.hints == Hints::None {
        return None;
    }
    if recorded {
        let examined = catch_panic(|| {
            let options = replay::Options { threads: 1, uses_fair_rules: true, ..replay::Options::default() };
            examine(judged_trace.scene, judged_trace.trace, KeptPart::Nothing, &options, &mut ())
        });
        // A failure while drawing must not cost points.
        let Ok(ExaminedTrace { outcome, rulings, .. }) = examined else { return None };
        let own = JudgedTrace { outcome: &outcome, rulings: &rulings, rules: Rules::Fair, ..*judged_trace };
        return draw_card(&own, false)
            .map(|kept| Card::from_stored(&kept).map_or(kept, |card| card.with_remark(RECORDING_NOTE).to_stored()));
    }
    // A failure while drawing must not cost points.
    let card = catch_panic(|| card(judged_trace, None, 3)).unwrap_or_else(|fault| {
        Some(Card::from_text(&format!("The pictures of this scene could not be made: {fault}; please report this.")))
    });
    let cut = "The trace is longer than the part that the grader keeps, so the pictures end early.";
    card.map(|card| if judged_trace.is_cut { card.with_remark(cut) } else { card }.to_stored())
}

/// Draws the card of a judged trace. `trace_name` is the name by which the reader can use the trace, and `depth` is the
/// level of the heading above the card.
pub(super) fn card(judged: &JudgedTrace<'_>, trace_name: Option<&str>, depth: usize) -> Option<Card> {
    let JudgedTrace { scene, name, trace, is_cut, outcome, rulings, explanations, rules, hints } = *judged;
    let (fair, focus) = (outcome.fair.is_some(), Focus::from_outcome(outcome));
    let evidence = evidence::gather(scene, &mut &trace[..], rulings, fair, &focus, MAX_MOTION_VALUES);
    let what_if = match (hints, explanations.first()) {
        (Hints::Full, Some(first)) => MistakeRun::for_scene(scene, first, (!is_cut).then_some(trace), &evidence),
        _ => None,
    };
    let steps = WrongSteps::new(StepChoice::None);
    let check = Check {
        scene: name,
        trace: trace_name.unwrap_or_default(),
        outcome,
        explanations,
        rules,
        steps: &steps,
        other_file_kind: None,
    };
    let has_trace = trace_name.is_some();
    let case = Case { check, scene, evidence: Some(&evidence), mistake_run: what_if.as_ref(), hints, has_trace };
    Card::for_case(&case, depth)
}
