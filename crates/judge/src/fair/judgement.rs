//! The fair verdict on one trace.
use super::step_judgement::{Borderline, Pending, Scales, Shares, StepJudgement};
use crate::{
    book_findings::BookFindings,
    finding::{Finding, FindingDetail},
};

/// So many examples of borderline decisions are kept.
const EXAMPLES: usize = 8;

/// So few decisions, though they may be most of a trace's, can be all that a small scene has.
const FEW: u64 = 64;

/// The verdict of the fair rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FairVerdict {
    /// Nothing is wrong.
    Accepted,
    /// Something is.
    Rejected,
    /// Judging was cut short before its end, and nothing was wrong so far.
    #[default]
    None,
}

/// Why a trace is refused as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FairRefusal {
    /// It can't be read to its end, or a step of its states has no result.
    Stopped,
    /// It can be read only as the original reads damaged files.
    Damaged,
    /// Bytes follow the last record.
    TrailingBytes,
    /// Most of its decisions are such that round-off may flip them, and differ from the reference's: it shows nothing.
    Undecided,
}

/// Which of the two accepted forms of the particle-edge approach polynomial a trace uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Form {
    /// Nothing tells them apart.
    #[default]
    Either,
    /// The course's formula, with its slip in t^3.
    Course,
    /// What the definition gives.
    Right,
}

/// Everything that the fair rules say about a trace.
#[derive(Debug, Clone, Default)]
pub struct Judgement {
    /// The verdict.
    pub verdict: FairVerdict,
    /// Why the trace is refused as a whole, whatever its steps hold.
    pub refusal: Option<FairRefusal>,
    /// What was found.
    pub findings: BookFindings,
    /// How many decisions about pairs the trace holds, in all steps and passes.
    pub decisions: u64,
    /// How many borderline decisions the trace has the other way.
    pub borderline: u64,
    /// The first ones.
    pub borderline_examples: Vec<Borderline>,
    /// The factors of polynomials.
    pub scales: Scales,
    /// The form of the approach polynomial.
    pub form: Form,
    /// Polynomials that have lost other coefficients as too small than the reference's.
    pub lost: u64,
    /// Used shares of the tolerances.
    pub shares: Shares,
    /// What hangs on the factors of polynomials, step by step.
    pending: Vec<PendingOfStep>,
}

/// Polynomials of one step and kind that hang on the program's factors.
#[derive(Debug, Clone, Copy)]
struct PendingOfStep {
    polynomials: Pending,
    /// Whether the step is wrong anyway.
    is_wrong: bool,
}

impl Judgement {
    /// The factor of all polynomials of all kinds as an interval, where it is not 1.
    #[must_use]
    pub fn scale(&self) -> Option<[f64; 2]> {
        let all = self.scales.values().flatten().flatten();
        let range = all.copied().reduce(|[low, high], [l, h]| [low.min(l), high.max(h)])?;
        (range.iter().any(|factor| (factor - 1.0).abs() > 1e-9)).then_some(range)
    }

    /// Adds what the initial record says.
    pub(crate) fn add_initial(&mut self, initial: &StepJudgement) {
        self.add(initial);
        self.findings.wrong_steps = 0;
    }

    /// Adds a step, in the order of the steps.
    pub(crate) fn add(&mut self, step: &StepJudgement) {
        for finding in &step.findings {
            self.charge(*finding);
        }
        self.findings.counts += step.more;
        self.decisions += step.decisions;
        self.borderline += step.borderline.len() as u64;
        let room = EXAMPLES.saturating_sub(self.borderline_examples.len());
        self.borderline_examples.extend(step.borderline.iter().take(room));
        for (all, new) in self.scales.values_mut().flatten().zip(step.scales.values().flatten()) {
            *all = match (*all, *new) {
                (Some([low, high]), Some([l, h])) => Some([low.min(l), high.max(h)]),
                (known, new) => known.or(new),
            };
        }
        self.lost += step.lost;
        if step.endless {
            self.refusal = Some(FairRefusal::Stopped);
        }
        self.shares.widen(&step.shares);
        let mut is_wrong = !step.findings.is_empty() || step.endless;
        for (form, place) in [(Form::Course, step.course_form), (Form::Right, step.right_form)] {
            let Some(place) = place else { continue };
            if self.form == Form::Either {
                self.form = form;
            } else if self.form != form {
                is_wrong = true;
                self.charge(Finding {
                    step: step.step,
                    frame: step.frame,
                    detail: FindingDetail::MixedForms { place },
                });
            }
        }
        self.findings.wrong_steps += u64::from(is_wrong);
        // A range of factors that fits already will fit at the end.
        let hangs = |pending: &&Pending| {
            let (kind, number) = pending.place;
            self.scales[kind][number].is_none_or(|range| pending.finding(range).is_some())
        };
        let hanging: Vec<PendingOfStep> =
            step.pending.iter().filter(hangs).map(|&polynomials| PendingOfStep { polynomials, is_wrong }).collect();
        self.pending.extend(hanging);
    }

    /// Adds a finding.
    pub(crate) fn charge(&mut self, finding: Finding) {
        self.findings.counts.add(finding.kind(), 1);
        self.findings.keep_first(&finding);
    }

    /// Charges what is no round-off with the factors that the trace uses for polynomials of the same kind; with 1, if none tells.
    fn settle_pending(&mut self) {
        let mut last_wrong = 0;
        for PendingOfStep { polynomials, is_wrong } in std::mem::take(&mut self.pending) {
            let (kind, number) = polynomials.place;
            let Some(finding) = polynomials.finding(self.scales[kind][number].unwrap_or([1.0; 2])) else { continue };
            // Steps come in their order, so the polynomials of one stand together.
            self.findings.wrong_steps += u64::from(!is_wrong && finding.step != last_wrong);
            last_wrong = finding.step;
            if self.findings.first_divergence.is_some_and(|first| first.step > finding.step) {
                self.findings.first_divergence = None;
            }
            if let Some(place) = self.findings.examples.iter().position(|known| known.kind() == finding.kind())
                && self.findings.examples[place].step > finding.step
            {
                self.findings.examples.remove(place);
            }
            self.charge(finding);
            self.findings.counts.add(finding.kind(), polynomials.count - 1);
        }
    }

    /// Whether most decisions are borderline and not the reference's: some are in every correct program, most in none.
    fn is_undecided(&self) -> bool {
        self.borderline >= FEW && self.borderline > self.decisions / 2
    }

    /// Draws the verdict.
    pub(crate) fn conclude(&mut self, refusal: Option<FairRefusal>, complete: bool) {
        self.refusal = self.refusal.or(refusal).or(self.is_undecided().then_some(FairRefusal::Undecided));
        self.settle_pending();
        self.findings.conclude();
        self.verdict = if self.refusal.is_some() || self.findings.counts.total() > 0 {
            FairVerdict::Rejected
        } else if complete {
            FairVerdict::Accepted
        } else {
            FairVerdict::None
        };
    }
}
