//! Judges a trace once, and keeps all data for later requests.
use crate::{
    evidence::{Evidence, Focus, gather},
    rulings::{StepRuling, StepRulings},
};
use fosssim_judge::{
    Outcome,
    kept_trace::{KeptTrace, MAX_KEPT_BYTES},
    replay::{self, ObserverPair, Options, Progress},
};
use fosssim_mistakes::diagnose::{Explanation, explain_kept_trace};
use fosssim_model::scene::Scene;
use std::io::{self, Read};

/// The part of a trace that is kept during judging.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeptPart {
    /// Nothing is kept, because the trace is neither explained nor shown.
    Nothing,
    /// The beginning of the trace is kept. Reading stops when judging stops, because the program at the other end of a
    /// pipe may write nothing more.
    Read,
    /// The beginning of the trace is kept, including the steps after judging has stopped.
    All,
}

/// A trace that has been judged.
#[derive(Debug)]
pub struct ExaminedTrace<'a> {
    /// The scene of the trace.
    pub scene: &'a Scene,
    /// The verdict on the trace.
    pub outcome: Outcome,
    /// The rulings on the trace's steps.
    pub rulings: Vec<StepRuling>,
    /// The kept part of the trace.
    pub trace: KeptTrace,
}

/// Judges a trace, and keeps the data for its explanation and its evidence, so that the trace is read only once.
pub fn examine<'a, R: Read + Send>(
    scene: &'a Scene,
    mut trace: R,
    keep: KeptPart,
    options: &Options,
    progress: &mut dyn Progress,
) -> ExaminedTrace<'a> {
    let mut kept_trace = KeptTrace::new(if keep == KeptPart::Nothing { 0 } else { MAX_KEPT_BYTES });
    let mut rulings = StepRulings::default();
    let outcome =
        replay::judge(scene, kept_trace.keep_from(&mut trace), options, &mut ObserverPair(&mut rulings, progress));
    if keep == KeptPart::All && outcome.stop.is_some() {
        let room = (MAX_KEPT_BYTES - kept_trace.bytes().len()) as u64;
        // After an error of reading, no more bytes are kept.
        let _ = io::copy(&mut kept_trace.keep_from(trace.take(room)), &mut io::sink());
    }
    ExaminedTrace { scene, rulings: rulings.into_steps(&outcome), outcome, trace: kept_trace }
}

impl ExaminedTrace<'_> {
    /// Returns the likely mistakes of the program that wrote the trace ([`explain_kept_trace`]).
    pub fn explain(&self) -> Vec<Explanation> {
        explain_kept_trace(self.scene, &self.trace)
    }

    /// Returns the evidence, with at most `budget` numbers of each motion. It covers the whole trace if `again` reads
    /// the trace once more, otherwise the kept part.
    pub fn gather_evidence(&self, again: Option<&mut dyn Read>, budget: usize) -> Evidence {
        let (fair, focus) = (self.outcome.fair.is_some(), Focus::from_outcome(&self.outcome));
        let gathered = |trace: &mut dyn Read| gather(self.scene, trace, &self.rulings, fair, &focus, budget);
        match again {
            Some(trace) => gathered(trace),
            None => gathered(&mut self.trace.bytes()),
        }
    }
}
