//! Builds the fair verdict on one trace.
use super::{
    factors::{FactorStatistics, FactorsByPolynomial},
    pending_polynomials::{PendingCause, PendingPolynomials},
    step_judgment::StepJudgment,
};
use fosssim_findings::{
    Finding, FindingDetail, FindingKind, Outcome, Stop,
    fair::{FairRejection, FairVerdict, Form, Judgment},
};
use fosssim_model::sim::{PairKind, PairKindMap, StepError};

/// The maximum number of borderline decisions that are kept as examples.
const MAX_EXAMPLES: usize = 8;

/// The minimum number of borderline decisions of an undecided trace, so that small scenes are never undecided.
const SMALL_SCENE_DECISIONS: u64 = 64;

/// The fair rules' judgment of a trace so far, and the polynomials that can be judged only at its end.
#[derive(Debug, Default)]
pub(crate) struct JudgmentBuilder {
    judgment: Judgment,
    /// The factors that polynomials show.
    factors: FactorsByPolynomial,
    /// The factors claimed by single coefficients.
    claimed_factors: FactorsByPolynomial,
    /// The number of polynomials that are identical to the reference's. Approach polynomials of a kind count at most
    /// once per step, because they show nothing for objects at rest.
    identical_polynomials: PairKindMap<[u64; PairKind::MAX_POLYNOMIALS]>,
    /// The polynomials that are right only with some factors, step by step.
    pending: Vec<StepPending>,
}

/// The polynomials of one step and kind that are right only with some factors.
#[derive(Debug, Clone, Copy)]
struct StepPending {
    polynomials: PendingPolynomials,
    /// Whether the step is wrong for another reason.
    is_wrong: bool,
}

impl JudgmentBuilder {
    /// Adds the findings of the initial record.
    pub(crate) fn add_initial(&mut self, initial: &StepJudgment) {
        self.add(initial);
        self.judgment.findings.wrong_steps = 0;
    }

    /// Adds a step, in the order of the steps.
    pub(crate) fn add(&mut self, step: &StepJudgment) {
        for finding in &step.findings {
            self.add_finding(*finding);
        }
        self.judgment.findings.counts += step.further_counts;
        self.judgment.decisions += step.decisions;
        self.judgment.borderline += step.borderline.len() as u64;
        let room = MAX_EXAMPLES.saturating_sub(self.judgment.borderline_examples.len());
        self.judgment.borderline_examples.extend(step.borderline.iter().take(room));
        for (all, new) in self.factors.values_mut().flatten().zip(step.factors.values().flatten()) {
            all.add(new);
        }
        self.judgment.lost_decisions += step.lost_decisions;
        self.judgment.shares.max_with(&step.shares);
        let mut is_wrong = !step.findings.is_empty();
        for (form, place) in [(Form::Course, step.course_form), (Form::Right, step.right_form)] {
            let Some(place) = place else { continue };
            if self.judgment.form == Form::Either {
                self.judgment.form = form;
            } else if self.judgment.form != form {
                is_wrong = true;
                self.add_finding(Finding {
                    step: step.step,
                    frame: step.frame,
                    detail: FindingDetail::MixedForms { place },
                });
            }
        }
        self.judgment.findings.wrong_steps += u64::from(is_wrong);
        for (kind, &calls) in step.identical_polynomials.iter() {
            let approach = kind.polynomial_count() - 1;
            for (number, same) in self.identical_polynomials[kind].iter_mut().enumerate() {
                *same += if number == approach { calls.min(1) } else { calls };
            }
        }
        for claim in step.pending.iter().filter(|pending| pending.cause == PendingCause::Claim) {
            let (kind, number) = claim.place;
            self.claimed_factors[kind][number].add_factor(claim.least_factor.0.midpoint(claim.greatest_factor.0));
        }
        // A polynomial that already fits, or that is judged only in the other form, needs no further check.
        let is_open = |pending: &&PendingPolynomials| {
            let (kind, number) = pending.place;
            let has_other_form = self.judgment.form != Form::Either && !pending.counts_for_form(self.judgment.form);
            // As long as further polynomials may follow, claims do not confirm a claimed factor.
            let is_confirmed = match pending.cause {
                PendingCause::RoundOff => self.factors_of(kind).range().is_some_and(|range| !is_constant(range)),
                _ => self.factors[kind][number].range().is_some() || self.identical_polynomials[kind][number] > 0,
            };
            !has_other_form && (!is_confirmed || self.finding(pending).is_some())
        };
        let open: Vec<StepPending> =
            step.pending.iter().filter(is_open).map(|&polynomials| StepPending { polynomials, is_wrong }).collect();
        self.pending.extend(open);
    }

    /// Returns the finding about pending polynomials if they are wrong with the usual factors of the trace so far.
    /// Usual factors are those that other polynomials show, and 1 for polynomials that are identical to the
    /// reference's. If there are none, the factors that polynomials claim are used, or otherwise 1.
    fn finding(&self, pending: &PendingPolynomials) -> Option<Finding> {
        let (kind, number) = pending.place;
        if pending.cause == PendingCause::RoundOff {
            // A program with one factor for all polynomials of this kind must use it here, too. Other programs may use
            // any factor.
            return pending.finding(self.factors_of(kind).range().filter(|range| is_constant(*range))?);
        }
        let mut factors = self.factors[kind][number];
        factors.add_unit_factors(self.identical_polynomials[kind][number]);
        let usual_range = factors.usual_range().or_else(|| self.claimed_factors[kind][number].usual_range());
        pending.finding(usual_range.unwrap_or([1.0; 2]))
    }

    /// Returns the factors of all polynomials of a kind so far.
    fn factors_of(&self, kind: PairKind) -> FactorStatistics {
        let mut all = FactorStatistics::default();
        for (factors, same) in self.factors[kind].iter().zip(self.identical_polynomials[kind]) {
            all.add(factors);
            all.add_unit_factors(same);
        }
        all
    }

    /// Adds a finding to the judgment.
    pub(crate) fn add_finding(&mut self, finding: Finding) {
        self.judgment.findings.counts.add(finding.kind(), 1);
        self.judgment.findings.keep_first(&finding);
    }

    /// Counts pending polynomials that are wrong with the usual factors of their kind, in the form that the trace uses.
    fn count_wrong_pending(&mut self) {
        let all = std::mem::take(&mut self.pending);
        let fails = |form| {
            all.iter().any(|step| step.polynomials.counts_for_form(form) && self.finding(&step.polynomials).is_some())
        };
        if self.judgment.form == Form::Either && fails(Form::Course) {
            // If nothing else shows the form, missing coefficients may: it is the form in which no relevant coefficient
            // is missing.
            self.judgment.form = if fails(Form::Right) { Form::Course } else { Form::Right };
        }
        let (form, mut last_wrong) = (self.judgment.form, 0);
        for StepPending { polynomials, is_wrong } in all.iter().filter(|step| step.polynomials.counts_for_form(form)) {
            let Some(finding) = self.finding(polynomials) else { continue };
            // Steps are in order, so the polynomials of one step are adjacent.
            self.judgment.findings.wrong_steps += u64::from(!is_wrong && finding.step != last_wrong);
            last_wrong = finding.step;
            // In a step, the findings about polynomials come before those about decisions.
            if self.judgment.findings.first_divergence.is_some_and(|first| is_consequence(&first, &finding)) {
                self.judgment.findings.first_divergence = None;
            }
            if let Some(index) = self.judgment.findings.examples.iter().position(|known| known.kind() == finding.kind())
                && self.judgment.findings.examples[index].step > finding.step
            {
                self.judgment.findings.examples.remove(index);
            }
            self.add_finding(finding);
            self.judgment.findings.counts.add(finding.kind(), polynomials.count - 1);
        }
    }

    /// Returns whether most decisions are borderline and differ from the reference's. A correct program has a few such
    /// decisions, but they are not the majority.
    fn is_undecided(&self) -> bool {
        self.judgment.borderline >= SMALL_SCENE_DECISIONS && self.judgment.borderline > self.judgment.decisions / 2
    }

    /// Records that judging stops before `step`.
    pub(crate) fn stop_judging(&mut self, step: u32) {
        self.judgment.first_unjudged_step = Some(step);
    }

    /// Returns the complete judgment, with its verdict.
    pub(crate) fn conclude(mut self, outcome: &Outcome) -> Judgment {
        if let Some(Stop::Step(StepError::Work { step })) = outcome.stop {
            self.judgment.first_unjudged_step.get_or_insert(step);
        }
        let rejection = if matches!(outcome.stop, Some(Stop::Trace { .. })) {
            Some(FairRejection::Stopped)
        } else if outcome.damage.is_some() {
            Some(FairRejection::Damaged)
        } else if outcome.trailing_bytes {
            Some(FairRejection::TrailingBytes)
        } else {
            self.is_undecided().then_some(FairRejection::Undecided)
        };
        self.judgment.rejection = rejection;
        self.count_wrong_pending();
        let factors = self.factors.values().flatten().filter_map(FactorStatistics::range);
        let factor = factors.reduce(|[low, high], [l, h]| [low.min(l), high.max(h)]);
        let mut judgment = self.judgment;
        judgment.factor = factor.filter(|range| range.iter().any(|factor| (factor - 1.0).abs() > 1e-9));
        judgment.findings.conclude();
        judgment.verdict = if judgment.rejection.is_some() || judgment.findings.counts.total() > 0 {
            FairVerdict::Rejected
        } else if outcome.steps_judged == outcome.steps && judgment.first_unjudged_step.is_none() {
            FairVerdict::Accepted
        } else {
            FairVerdict::None
        };
        judgment
    }
}

/// Returns whether all factors of a range are equal except for rounding errors.
fn is_constant([least, greatest]: [f64; 2]) -> bool {
    greatest - least <= 1e-9 * least
}

/// Returns whether a finding may be a consequence of the finding about a polynomial. Such a finding is about a later
/// step, or about a decision in the same step.
fn is_consequence(finding: &Finding, polynomial: &Finding) -> bool {
    let is_decision = matches!(finding.kind(), FindingKind::TrimmedDecision);
    finding.step > polynomial.step || finding.step == polynomial.step && is_decision
}
