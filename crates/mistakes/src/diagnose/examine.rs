//! Judges a trace that comes once, and keeps of it what explanations need.
use super::{Explanation, explain::explain_source};
use fosssim_judge::{
    Outcome,
    kept::{Keeper, KeptTrace, LONGEST},
    replay::{Options, Progress},
};
use fosssim_model::scene::Scene;
use std::io::Read;

/// What is kept of a trace while it is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Keep {
    /// The greatest number of bytes kept of its beginning, the reference's own steps not counted; with 0 nothing is
    /// kept, and nothing explained.
    pub most: usize,
    /// Whether what follows is read, too, where judging stops before the trace's end. A program that writes a trace may
    /// write no more.
    pub reads_on: bool,
}

impl Keep {
    /// Nothing.
    pub const NOTHING: Self = Self { most: 0, reads_on: false };
    /// All that explanations look at.
    pub const EXPLAINED: Self = Self { most: LONGEST as usize, reads_on: true };
}

/// A trace that has been judged.
#[derive(Debug)]
pub struct Examined<'a> {
    /// The verdict.
    pub outcome: Outcome,
    /// What was kept.
    pub trace: KeptTrace<'a>,
}

/// Judges a trace, and keeps what its explanation needs: the trace is read once.
#[must_use]
pub fn examine<'a, R: Read + Send>(
    scene: &'a Scene,
    mut trace: R,
    keep: Keep,
    options: &Options,
    progress: &mut dyn Progress,
) -> Examined<'a> {
    let keeper = Keeper::new(scene, keep.most);
    let outcome = keeper.judge(&mut trace, options, progress);
    if keep.reads_on && outcome.stop.is_some() {
        keeper.read_on(trace);
    }
    Examined { outcome, trace: keeper.into_kept() }
}

impl Examined<'_> {
    /// What is likely wrong with the program that left the trace ([`explain_kept`]).
    #[must_use]
    pub fn explain(&self) -> Vec<Explanation> {
        explain_kept(&self.trace)
    }
}

/// As [`explain`](super::explain), of what was kept of a trace: its beginning, and the steps beyond in which a book has
/// found something.
#[must_use]
pub fn explain_kept(trace: &KeptTrace<'_>) -> Vec<Explanation> {
    explain_source(trace.scene(), trace.into())
}
