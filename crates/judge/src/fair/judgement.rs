//! The fair verdict on one trace.
use super::{
    factors::{Factors, Scales},
    pending::{Form, Pending},
    step_judgement::{Borderline, Shares, StepJudgement},
};
use crate::{
    book_findings::BookFindings,
    finding::{Finding, FindingDetail, FindingKind},
};
use fosssim_model::sim::{ByKind, PairKind};

/// The greatest number of examples of borderline decisions that are kept.
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
    /// The factors that single coefficients claim.
    claimed: Scales,
    /// How many polynomials are the reference's bit for bit; approaches, which say nothing of objects at rest, count
    /// once a step.
    same: ByKind<[u64; PairKind::MOST_POLYNOMIALS]>,
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
        let all = self.scales.values().flatten().filter_map(Factors::range);
        let range = all.reduce(|[low, high], [l, h]| [low.min(l), high.max(h)])?;
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
            all.add(new);
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
        for (kind, &calls) in step.same.iter() {
            let approach = kind.polynomials() - 1;
            for (number, same) in self.same[kind].iter_mut().enumerate() {
                *same += if number == approach { calls.min(1) } else { calls };
            }
        }
        for claim in step.pending.iter().filter(|pending| pending.is_claim) {
            let (kind, number) = claim.place;
            self.claimed[kind][number].take(claim.least.0.midpoint(claim.most.0));
        }
        // What fits already is settled, and so is what counts in the other form only.
        let hangs = |pending: &&Pending| {
            let (kind, number) = pending.place;
            let is_of_other_form = self.form != Form::Either && !pending.is_of(self.form);
            // A claim does not vouch for itself as long as others may come.
            let is_told = self.scales[kind][number].range().is_some() || self.same[kind][number] > 0;
            !is_of_other_form && (!is_told || self.finding(pending).is_some())
        };
        let hanging: Vec<PendingOfStep> =
            step.pending.iter().filter(hangs).map(|&polynomials| PendingOfStep { polynomials, is_wrong }).collect();
        self.pending.extend(hanging);
    }

    /// What is wrong with polynomials that hang on factors, with those that are usual in the trace so far: those that
    /// others show, beside the reference's own polynomials; where there are none of either, those that all claim; or
    /// else 1.
    fn finding(&self, pending: &Pending) -> Option<Finding> {
        let (kind, number) = pending.place;
        let mut told = self.scales[kind][number];
        told.take_ones(self.same[kind][number]);
        let usual = told.usual().or_else(|| self.claimed[kind][number].usual());
        pending.finding(usual.unwrap_or([1.0; 2]))
    }

    /// Adds a finding.
    pub(crate) fn charge(&mut self, finding: Finding) {
        self.findings.counts.add(finding.kind(), 1);
        self.findings.keep_first(&finding);
    }

    /// Charges what is no round-off with the factors that are usual for polynomials of the same kind, in the form that
    /// the trace uses.
    fn settle_pending(&mut self) {
        let all = std::mem::take(&mut self.pending);
        let fails =
            |form| all.iter().any(|step| step.polynomials.is_of(form) && self.finding(&step.polynomials).is_some());
        if self.form == Form::Either && fails(Form::Course) {
            // What is gone may tell the form all the same: that in which nothing is gone that counts.
            self.form = if fails(Form::Right) { Form::Course } else { Form::Right };
        }
        let (form, mut last_wrong) = (self.form, 0);
        for PendingOfStep { polynomials, is_wrong } in all.iter().filter(|step| step.polynomials.is_of(form)) {
            let Some(finding) = self.finding(polynomials) else { continue };
            // Steps come in their order, so the polynomials of one stand together.
            self.findings.wrong_steps += u64::from(!is_wrong && finding.step != last_wrong);
            last_wrong = finding.step;
            // In a step polynomials come before what they decide.
            if self.findings.first_divergence.is_some_and(|first| follows(&first, &finding)) {
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

/// Whether a finding comes after that about a polynomial.
fn follows(finding: &Finding, polynomial: &Finding) -> bool {
    let is_decision = matches!(finding.kind(), FindingKind::TrimmedDecision);
    finding.step > polynomial.step || finding.step == polynomial.step && is_decision
}
