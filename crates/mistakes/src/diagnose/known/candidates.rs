//! Tries the rows of the catalog on the kept steps.
use super::{
    applicable_rows::applicable_rows,
    resimulate::ApproachForm,
    trials::{Program, Trials},
};
use crate::diagnose::sampling::{KeptStep, Reference, Scan};
use fosssim_model::scene::Scene;
use fosssim_student::{Edit, Mistake, Row, Slip, StepMistake};

/// The number of steps on which all rows are tried if no row reproduces everything.
const MAX_PARTIAL_STEPS: usize = 16;
/// The maximum number of computed polynomials. Computing one takes about a microsecond.
const MAX_WORK: u64 = 1_500_000;
/// A row, and the number of wrong steps that it reproduces.
#[derive(Debug, Clone, Copy)]
pub(super) struct Score {
    pub(super) row: &'static Row,
    pub(super) reproduced: u64,
    pub(super) samples: u64,
}

/// A row, and a program whose only mistake is that of the row.
type Candidate = (&'static Row, Program);

/// The programs with one mistake each, and the steps in the order in which the programs are tried on them.
pub(super) struct Candidates<'a> {
    candidates: Vec<Candidate>,
    scan: &'a Scan,
    probe_steps: Vec<&'a KeptStep>,
    /// The wrong steps that are not probes.
    other_steps: Vec<&'a KeptStep>,
    trials: Trials<'a>,
}

impl<'a> Candidates<'a> {
    /// Creates a program for each row that applies to the scene. The row's mistake is added to the program `correct`.
    pub(super) fn new(reference: &'a Reference<'_>, scene: &Scene, scan: &'a Scan, correct: ApproachForm) -> Self {
        let trials = Trials::new(reference, scene, correct);
        let candidates = applicable_rows(scene).map(|row| (row, trials.program(&[row]))).collect();
        let probes = scan.probes();
        let is_probe = |sample: &KeptStep| probes.iter().any(|probe| std::ptr::eq(*probe, sample));
        let others = scan.wrong_steps.iter().filter(|sample| !is_probe(sample)).collect();
        Self { candidates, scan, probe_steps: probes, other_steps: others, trials }
    }

    /// Returns the rows that reproduce the most wrong steps, in the order of the catalog. All of them reproduce the
    /// same number. The list is empty if that is less than half of the steps.
    pub(super) fn best_scores(&self) -> Vec<Score> {
        let complete = self.complete_scores();
        if complete.is_empty() { self.partial_scores() } else { complete }
    }

    /// Returns the rows that reproduce every step.
    fn complete_scores(&self) -> Vec<Score> {
        let mut remaining: Vec<&Candidate> = self.candidates.iter().collect();
        let mut samples = 0;
        for sample in
            self.probe_steps.iter().copied().chain(&self.scan.right_steps).chain(self.other_steps.iter().copied())
        {
            if self.trials.exceeds_limit(MAX_WORK) && samples > 0 {
                break;
            }
            remaining.retain(|candidate| self.reproduces(candidate, sample));
            if remaining.is_empty() {
                break;
            }
            samples += u64::from(sample.difference.is_some());
        }
        remaining.iter().map(|(row, _)| Score { row, reproduced: samples, samples }).collect()
    }

    /// Returns the rows that reproduce the most wrong steps, at least half of them, and all right ones.
    fn partial_scores(&self) -> Vec<Score> {
        self.trials.restart();
        let wrong = [self.probe_steps.as_slice(), &self.other_steps].concat();
        let stride = wrong.len().div_ceil(MAX_PARTIAL_STEPS).max(1);
        let spread: Vec<&KeptStep> = wrong.iter().step_by(stride).copied().collect();
        let rest = wrong.iter().enumerate().filter(|(index, _)| !index.is_multiple_of(stride));
        let rest: Vec<&KeptStep> = rest.map(|(_, sample)| *sample).collect();
        let mut remaining: Vec<(&Candidate, usize)> = self.candidates.iter().map(|candidate| (candidate, 0)).collect();
        let mut tried = 0;
        for (number, sample) in spread.iter().chain(&rest).enumerate() {
            if self.trials.exceeds_limit(MAX_WORK) {
                break;
            }
            tried = number + 1;
            // A candidate that fails on more than half of the sampled steps is dropped.
            let allowed = spread.len().max(tried) / 2;
            remaining.retain_mut(|(candidate, reproduced)| {
                *reproduced += usize::from(self.reproduces(candidate, sample));
                tried - *reproduced <= allowed
            });
        }
        // A mistake that does not reproduce the first difference is not the right one.
        remaining.retain(|(candidate, reproduced)| {
            2 * reproduced >= tried
                && self.scan.wrong_steps.first().is_none_or(|first| self.reproduces(candidate, first))
                && self.scan.right_steps.iter().all(|sample| self.reproduces(candidate, sample))
        });
        let max_reproduced = remaining.iter().map(|(_, reproduced)| *reproduced).max().unwrap_or(0);
        remaining.retain(|(_, reproduced)| *reproduced == max_reproduced && max_reproduced > 0);
        let (reproduced, samples) = (max_reproduced as u64, tried as u64);
        remaining.into_iter().map(|((row, _), _)| Score { row, reproduced, samples }).collect()
    }

    /// Returns whether the program logs the same as the submission in this step. Values that are kept from earlier
    /// steps, and single precision, are recognized from the step's context instead.
    fn reproduces(&self, (row, program): &Candidate, sample: &KeptStep) -> bool {
        match row.mistake {
            Mistake::LogPolynomialsKept if sample.difference.is_some() => return sample.context.keeps_polynomials,
            Mistake::LogImpulsesKept if sample.difference.is_some() => return sample.context.keeps_impulses,
            Mistake::LogSinglePrecision if sample.difference.is_some() => return sample.context.has_single_precision,
            Mistake::Step(StepMistake::Edit(Edit { slip: Slip::NotCleared, .. })) if sample.difference.is_some() => {
                return sample.context.keeps_forces;
            }
            _ => {}
        }
        self.trials.reproduced_share(program, sample) >= 1.0
    }
}
