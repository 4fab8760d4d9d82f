//! Pictures of judged traces, and the HTML pages that are put together of them.
use super::ending::file_name;
use crate::{
    cli::output,
    evidence::{self, ExaminedTrace, Focus, KeptPart, examine},
    files::Place,
    judge::{Rules, replay},
    report::{
        check::{Check, StepChoice, WrongSteps},
        page::{Audience, Card, Case, ClassPage, GradePage, WhatIf},
    },
    suite::{
        Grade, PassedOver,
        cards::{self, Cards, Draw, JudgedTrace},
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

/// The greatest number of numbers kept of a graded scene's motion: several scenes are graded at a time. The largest
/// course scene has 70,444.
const BUDGET: usize = 1 << 19;

/// The cards of a grading, and where the pages go.
pub(super) struct Pages {
    cards: Place,
    /// The folder for pages, if there is one.
    folder: Option<PathBuf>,
    /// Whether pages for students are made, too.
    for_students: bool,
    _temporary: Option<tempfile::TempDir>,
}

impl Pages {
    /// Pages in the folder for results; without one, cards that live as long as the grading.
    pub(super) fn new(folder: Option<&Path>, for_students: bool) -> Result<Self> {
        let (cards, temporary) = match folder {
            Some(folder) => (Place::new(folder, "cards"), None),
            None => {
                let made =
                    tempfile::Builder::new().prefix("fosssim-cards-").tempdir().context("no temporary folder")?;
                (Place::new(made.path(), ""), Some(made))
            }
        };
        Ok(Self { cards, folder: folder.map(Path::to_owned), for_students, _temporary: temporary })
    }

    /// Draws and keeps cards here.
    pub(super) fn drawing<'a>(&'a self, draw: &'a Draw<'a>) -> Cards<'a> {
        Cards { folder: &self.cards, draw, for_students: self.for_students }
    }

    /// Forgets the cards of earlier gradings.
    pub(super) fn forget(&self) {
        let is_card = |name: &OsString| Path::new(name).extension().is_some_and(|extension| extension == "zst");
        for name in self.cards.names().unwrap_or_default().iter().filter(|name| is_card(name)) {
            // A card that stays behind costs room and nothing else.
            drop(self.cards.join(name).remove());
        }
    }

    /// Returns the card of this name.
    pub(super) fn card(&self, name: Option<&str>) -> Option<Card> {
        Card::from_kept(&cards::read(&self.cards, name?)?)
    }

    /// Keeps a card; returns its name. One that can't be kept costs a picture and nothing else.
    pub(super) fn keep(&self, card: Option<Card>) -> Option<String> {
        cards::store(&self.cards, &card?.to_kept()).ok()
    }

    /// Returns the page of one submission.
    pub(super) fn render_one(&self, grade: &Grade, class: Option<&str>, reader: Audience) -> String {
        GradePage { grade, card: &|name| self.card(name), class, reader }.html()
    }

    /// Writes the pages for staff into the folder for results, and next to them those for students: of a class always,
    /// of one submission on request. Returns the page to begin with.
    pub(super) fn write(
        &self,
        grades: &[Grade],
        passed_over: &[PassedOver],
        reader: Audience,
    ) -> Result<Option<PathBuf>> {
        let Some(folder) = &self.folder else { return Ok(None) };
        let write = |name: &str, page: &str| {
            let place = Place::new(folder, name);
            output::write_at(&place, page.as_bytes()).map(|()| Some(place.path()))
        };
        if reader == Audience::Student || grades.len() > 1 {
            grades.par_iter().try_for_each(|grade| {
                let name = format!("students/{}.html", file_name(&grade.submission));
                write(&name, &self.render_one(grade, None, Audience::Student)).map(drop)
            })?;
        }
        if let [grade] = grades {
            return write("report.html", &self.render_one(grade, None, Audience::Staff));
        }
        grades.par_iter().try_for_each(|grade| {
            let name = format!("reports/{}.html", file_name(&grade.submission));
            write(&name, &self.render_one(grade, Some("../index.html"), Audience::Staff)).map(drop)
        })?;
        // Names of files hold nothing that an address would have to write otherwise, but blanks.
        let page = |grade: &Grade| format!("reports/{}.html", file_name(&grade.submission).replace(' ', "%20"));
        write("index.html", &ClassPage { grades, passed_over, page: &page }.html())
    }
}

/// The sentence above the card of a trace that was judged against a recording.
const RECORDED: &str = "The verdict compares with the recording, where nearly everything after the first wrong step \
                        differs. What follows judges each step from the trace's own state before it: what is wrong by \
                        itself, and what only follows from that.";

/// Draws the card of a graded scene. Of a trace that was judged against a recording each step is judged once more, from
/// the trace's own state.
pub(super) fn draw(judged: &JudgedTrace<'_>, recorded: bool) -> Option<String> {
    if judged.hints == Hints::None {
        return None;
    }
    if recorded {
        let again = catch_panic(|| {
            let options = replay::Options { threads: 1, fair: true, ..replay::Options::default() };
            examine(judged.scene, judged.trace, KeptPart::Nothing, &options, &mut ())
        });
        // A failure while drawing costs no points.
        let Ok(ExaminedTrace { outcome, rulings, .. }) = again else { return None };
        let own = JudgedTrace { outcome: &outcome, rulings: &rulings, rules: Rules::Fair, ..*judged };
        return draw(&own, false)
            .map(|kept| Card::from_kept(&kept).map_or(kept, |card| card.noting(RECORDED).to_kept()));
    }
    // A picture that can't be made costs no points.
    let card = catch_panic(|| card(judged, None, 3)).unwrap_or_else(|fault| {
        Some(Card::from_words(&format!("The pictures of this scene could not be made: {fault}; please report this.")))
    });
    let cut = "The trace is longer than what the grader keeps of it: the pictures end where that ends.";
    card.map(|card| if judged.is_cut { card.noting(cut) } else { card }.to_kept())
}

/// Returns the card of a judged trace. `trace_name` is the trace's name for the reader, `depth` the level of the
/// heading above.
pub(super) fn card(judged: &JudgedTrace<'_>, trace_name: Option<&str>, depth: usize) -> Option<Card> {
    let JudgedTrace { scene, name, trace, is_cut, outcome, rulings, explanations, rules, hints } = *judged;
    let (fair, focus) = (outcome.fair.is_some(), Focus::from_outcome(outcome));
    let evidence = evidence::gather(scene, &mut &trace[..], rulings, fair, &focus, BUDGET);
    let what_if = match (hints, explanations.first()) {
        (Hints::Full, Some(first)) => WhatIf::for_scene(scene, first, (!is_cut).then_some(trace), &evidence),
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
        audit: false,
        tables: false,
        looks_like: None,
    };
    let has_trace = trace_name.is_some();
    let case = Case { check, scene, evidence: Some(&evidence), what_if: what_if.as_ref(), hints, has_trace };
    Card::for_case(&case, depth)
}
