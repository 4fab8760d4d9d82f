//! A trace that is judged once, with all that may be asked of it afterwards.
use crate::{
    gather::{Evidence, Focus, gather},
    rulings::{StepRuling, StepRulings},
};
use fosssim_judge::{
    Outcome,
    kept::{KeptTrace, LONGEST, TraceKeeper},
    replay::{Both, Options, Progress},
};
use fosssim_mistakes::diagnose::{Explanation, explain_kept};
use fosssim_model::scene::Scene;
use std::io::Read;

/// The part of a trace that is kept while it is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// Nothing: the trace is neither explained nor shown.
    Nothing,
    /// Its beginning and wrong steps beyond; where judging stops, nothing more is read. The writer of a trace that
    /// comes once may write no more.
    Read,
    /// The same, with what follows the place where judging stops.
    All,
}

/// A trace that has been judged.
#[derive(Debug)]
pub struct Examined<'a> {
    /// The verdict.
    pub outcome: Outcome,
    /// The rulings on its steps.
    pub rulings: Vec<StepRuling>,
    /// The trace that was kept.
    pub trace: KeptTrace<'a>,
}

/// Judges a trace, and keeps what its explanation and its evidence need: the trace is read once.
#[must_use]
pub fn examine<'a, R: Read + Send>(
    scene: &'a Scene,
    mut trace: R,
    keep: Keep,
    options: &Options,
    progress: &mut dyn Progress,
) -> Examined<'a> {
    let keeper = TraceKeeper::new(scene, if keep == Keep::Nothing { 0 } else { LONGEST as usize });
    let mut rulings = StepRulings::default();
    let outcome = keeper.judge(&mut trace, options, &mut Both(&mut rulings, progress));
    if keep == Keep::All && outcome.stop.is_some() {
        keeper.read_on(trace);
    }
    Examined { rulings: rulings.into_steps(&outcome), outcome, trace: keeper.into_kept() }
}

impl Examined<'_> {
    /// Likely mistakes of the program that left the trace ([`explain_kept`]).
    #[must_use]
    pub fn explain(&self) -> Vec<Explanation> {
        explain_kept(&self.trace)
    }

    /// The trace's beginning, as it was read.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        self.trace.bytes(LONGEST as usize)
    }

    /// The evidence, with at most `budget` numbers of each motion: of the whole trace, where it can be read again, else
    /// of what was kept.
    #[must_use]
    pub fn evidence(&self, again: Option<&mut dyn Read>, budget: usize) -> Evidence {
        let (fair, focus) = (self.outcome.fair.is_some(), Focus::of(&self.outcome));
        let gathered = |trace: &mut dyn Read| gather(self.trace.scene(), trace, &self.rulings, fair, &focus, budget);
        match again {
            Some(trace) => gathered(trace),
            None => gathered(&mut self.trace.beginning()),
        }
    }
}
