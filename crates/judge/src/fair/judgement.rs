//! The fair verdict on one trace.
use super::{
    factors::{Factors, Scales},
    pending::{Pending, PendingCause},
    step_judgement::StepJudgement,
};
use fosssim_findings::{
    Finding, FindingDetail, FindingKind, Outcome, Stop,
    fair::{FairRefusal, FairVerdict, Form, Judgement},
};
use fosssim_model::sim::{PairKind, PairKindMap, StepError};

/// The maximum number of borderline decisions that are kept as examples.
const MAX_EXAMPLES: usize = 8;

/// The maximum number of decisions of a small scene.
const SMALL_SCENE_DECISIONS: u64 = 64;

/// The fair rules' judgement of a trace so far, and the polynomials that can be judged only at its end.
#[derive(Debug, Default)]
pub(crate) struct Judging {
    said: Judgement,
    /// The factors of polynomials.
    scales: Scales,
    /// The factors claimed by single coefficients.
    claimed: Scales,
    /// The number of polynomials that are identical to the reference's. Approaches count once per step, because they
    /// show nothing for objects at rest.
    same: PairKindMap<[u64; PairKind::MAX_POLYNOMIALS]>,
    /// Polynomials that depend on the program's factors, step by step.
    pending: Vec<PendingOfStep>,
}

/// Polynomials of one step and kind that depend on the program's factors.
#[derive(Debug, Clone, Copy)]
struct PendingOfStep {
    polynomials: Pending,
    /// Whether the step is wrong for another reason.
    is_wrong: bool,
}

impl Judging {
    /// Adds the findings of the initial record.
    pub(crate) fn add_initial(&mut self, initial: &StepJudgement) {
        self.add(initial);
        self.said.findings.wrong_steps = 0;
    }

    /// Adds a step, in the order of the steps.
    pub(crate) fn add(&mut self, step: &StepJudgement) {
        for finding in &step.findings {
            self.add_finding(*finding);
        }
        self.said.findings.counts += step.more;
        self.said.decisions += step.decisions;
        self.said.borderline += step.borderline.len() as u64;
        let room = MAX_EXAMPLES.saturating_sub(self.said.borderline_examples.len());
        self.said.borderline_examples.extend(step.borderline.iter().take(room));
        for (all, new) in self.scales.values_mut().flatten().zip(step.scales.values().flatten()) {
            all.add(new);
        }
        self.said.lost += step.lost;
        self.said.shares.max_with(&step.shares);
        let mut is_wrong = !step.findings.is_empty();
        for (form, place) in [(Form::Course, step.course_form), (Form::Right, step.right_form)] {
            let Some(place) = place else { continue };
            if self.said.form == Form::Either {
                self.said.form = form;
            } else if self.said.form != form {
                is_wrong = true;
                self.add_finding(Finding {
                    step: step.step,
                    frame: step.frame,
                    detail: FindingDetail::MixedForms { place },
                });
            }
        }
        self.said.findings.wrong_steps += u64::from(is_wrong);
        for (kind, &calls) in step.same.iter() {
            let approach = kind.polynomial_count() - 1;
            for (number, same) in self.same[kind].iter_mut().enumerate() {
                *same += if number == approach { calls.min(1) } else { calls };
            }
        }
        for claim in step.pending.iter().filter(|pending| pending.cause == PendingCause::Claim) {
            let (kind, number) = claim.place;
            self.claimed[kind][number].take(claim.least.0.midpoint(claim.most.0));
        }
        // Polynomials that already fit, or count only in the other form, are settled.
        let hangs = |pending: &&Pending| {
            let (kind, number) = pending.place;
            let is_of_other_form = self.said.form != Form::Either && !pending.is_of(self.said.form);
            // While other polynomials may follow, a claimed factor is not confirmed by claims.
            let is_told = match pending.cause {
                PendingCause::RoundOff => self.factors_of(kind).range().is_some_and(|range| !is_constant(range)),
                _ => self.scales[kind][number].range().is_some() || self.same[kind][number] > 0,
            };
            !is_of_other_form && (!is_told || self.finding(pending).is_some())
        };
        let hanging: Vec<PendingOfStep> =
            step.pending.iter().filter(hangs).map(|&polynomials| PendingOfStep { polynomials, is_wrong }).collect();
        self.pending.extend(hanging);
    }

    /// Returns the finding about polynomials that depend on factors, with the usual factors of the trace so far. The
    /// usual factors come from other polynomials and from identical ones. Without both, the factors are those that all
    /// polynomials claim, or otherwise 1.
    fn finding(&self, pending: &Pending) -> Option<Finding> {
        let (kind, number) = pending.place;
        if pending.cause == PendingCause::RoundOff {
            // Only a program with one factor for all polynomials of this kind cannot have another one here.
            return pending.finding(self.factors_of(kind).range().filter(|range| is_constant(*range))?);
        }
        let mut told = self.scales[kind][number];
        told.add_ones(self.same[kind][number]);
        let usual = told.usual().or_else(|| self.claimed[kind][number].usual());
        pending.finding(usual.unwrap_or([1.0; 2]))
    }

    /// Returns the factors of all polynomials of a kind so far.
    fn factors_of(&self, kind: PairKind) -> Factors {
        let mut all = Factors::default();
        for (factors, same) in self.scales[kind].iter().zip(self.same[kind]) {
            all.add(factors);
            all.add_ones(same);
        }
        all
    }

    /// Adds a finding to the judgement.
    pub(crate) fn add_finding(&mut self, finding: Finding) {
        self.said.findings.counts.add(finding.kind(), 1);
        self.said.findings.keep_first(&finding);
    }

    /// Counts pending polynomials that are wrong with the usual factors of their kind, in the form that the trace uses.
    fn settle_pending(&mut self) {
        let all = std::mem::take(&mut self.pending);
        let fails =
            |form| all.iter().any(|step| step.polynomials.is_of(form) && self.finding(&step.polynomials).is_some());
        if self.said.form == Form::Either && fails(Form::Course) {
            // If nothing else shows the form, missing coefficients may: it is the form in which no relevant coefficient
            // is missing.
            self.said.form = if fails(Form::Right) { Form::Course } else { Form::Right };
        }
        let (form, mut last_wrong) = (self.said.form, 0);
        for PendingOfStep { polynomials, is_wrong } in all.iter().filter(|step| step.polynomials.is_of(form)) {
            let Some(finding) = self.finding(polynomials) else { continue };
            // Steps are in order, so the polynomials of one step are adjacent.
            self.said.findings.wrong_steps += u64::from(!is_wrong && finding.step != last_wrong);
            last_wrong = finding.step;
            // In a step, the findings about polynomials come before those about decisions.
            if self.said.findings.first_divergence.is_some_and(|first| is_consequence(&first, &finding)) {
                self.said.findings.first_divergence = None;
            }
            if let Some(place) = self.said.findings.examples.iter().position(|known| known.kind() == finding.kind())
                && self.said.findings.examples[place].step > finding.step
            {
                self.said.findings.examples.remove(place);
            }
            self.add_finding(finding);
            self.said.findings.counts.add(finding.kind(), polynomials.count - 1);
        }
    }

    /// Returns whether most decisions are borderline and differ from the reference's. Every correct program has a few
    /// such decisions, but not most.
    fn is_undecided(&self) -> bool {
        self.said.borderline >= SMALL_SCENE_DECISIONS && self.said.borderline > self.said.decisions / 2
    }

    /// Stops judging; later steps are not judged.
    pub(crate) fn stop_judging(&mut self, step: u32) {
        self.said.given_up = Some(step);
    }

    /// Computes the verdict.
    pub(crate) fn conclude(mut self, outcome: &Outcome) -> Judgement {
        if let Some(Stop::Step(StepError::Work { step })) = outcome.stop {
            self.said.given_up.get_or_insert(step);
        }
        let refusal = if matches!(outcome.stop, Some(Stop::Trace { .. })) {
            Some(FairRefusal::Stopped)
        } else if outcome.damage.is_some() {
            Some(FairRefusal::Damaged)
        } else if outcome.trailing_bytes {
            Some(FairRefusal::TrailingBytes)
        } else {
            self.is_undecided().then_some(FairRefusal::Undecided)
        };
        self.said.refusal = refusal;
        self.settle_pending();
        let factors = self.scales.values().flatten().filter_map(Factors::range);
        let factor = factors.reduce(|[low, high], [l, h]| [low.min(l), high.max(h)]);
        let mut said = self.said;
        said.factor = factor.filter(|range| range.iter().any(|factor| (factor - 1.0).abs() > 1e-9));
        said.findings.conclude();
        said.verdict = if said.refusal.is_some() || said.findings.counts.total() > 0 {
            FairVerdict::Rejected
        } else if outcome.steps_judged == outcome.steps && said.given_up.is_none() {
            FairVerdict::Accepted
        } else {
            FairVerdict::None
        };
        said
    }
}

/// Returns whether factors are one factor, except for its roundings.
fn is_constant([least, greatest]: [f64; 2]) -> bool {
    greatest - least <= 1e-9 * least
}

/// Returns whether a finding is a consequence of the finding about a polynomial.
fn is_consequence(finding: &Finding, polynomial: &Finding) -> bool {
    let is_decision = matches!(finding.kind(), FindingKind::TrimmedDecision);
    finding.step > polynomial.step || finding.step == polynomial.step && is_decision
}
