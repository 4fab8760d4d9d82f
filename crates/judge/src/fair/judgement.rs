//! The fair verdict on one trace.
use super::step::StepJudgement;
use crate::{
    finding::{Detail, Finding, Kind, PolynomialPlace},
    outcome::Counts,
};
use fosssim_model::sim::{Pair, PairKind, Pass};

/// So many examples of borderline decisions are kept.
const EXAMPLES: usize = 8;

/// The verdict of the fair rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Verdict {
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
pub enum Refusal {
    /// It can't be read to its end, or a step of its states has no result.
    Stopped,
    /// It can be read only as the original reads damaged files.
    Damaged,
    /// Bytes follow the last record.
    TrailingBytes,
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

/// A decision that round-off may flip, and that the trace has the other way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Borderline {
    /// The step, from 1.
    pub step: u32,
    /// The detection pass.
    pub pass: Pass,
    /// The pair.
    pub pair: Pair,
    /// Whether the trace takes it for a collision.
    pub collides: bool,
}

/// The largest shares of their tolerances that were used by what is right, 0 to 1; 0 where nothing differed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Shares {
    /// Polynomial coefficients.
    pub coefficient: f64,
    /// Contact normals.
    pub normal: f64,
    /// Positions.
    pub position: f64,
    /// Velocities.
    pub velocity: f64,
}

impl Shares {
    /// The larger one of each.
    pub(super) fn widen(&mut self, other: &Self) {
        self.coefficient = self.coefficient.max(other.coefficient);
        self.normal = self.normal.max(other.normal);
        self.position = self.position.max(other.position);
        self.velocity = self.velocity.max(other.velocity);
    }
}

/// Smallest and largest factor of the polynomials, by kind of pair and number of the polynomial; `None` where no
/// polynomial differs from the reference's bits.
pub type Scales = [[Option<[f64; 2]>; 4]; 3];

/// Everything that the fair rules say about a trace.
#[derive(Debug, Clone, Default)]
pub struct Judgement {
    /// The verdict.
    pub verdict: Verdict,
    /// Why the trace is refused as a whole, whatever its steps hold.
    pub refusal: Option<Refusal>,
    /// Counts per kind of finding.
    pub counts: Counts,
    /// Steps with at least one finding; the initial record is not one.
    pub wrong_steps: u64,
    /// The first finding of each kind that occurred, in the order of [`Kind::ALL`].
    pub examples: Vec<Finding>,
    /// The very first finding.
    pub first_divergence: Option<Finding>,
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
    /// For each polynomial of a pair what hangs on its factor.
    pending: [[Option<Hanging>; 4]; 3],
}

/// Findings that hang on the factor of a program's polynomials.
#[derive(Debug, Clone, Copy)]
struct Hanging {
    /// The first one.
    finding: Finding,
    /// How many there are.
    count: u64,
    /// They are none if the factor lies within these.
    factors: [f64; 2],
}

impl Judgement {
    /// The factor of all polynomials of all kinds as an interval, where it is not 1.
    #[must_use]
    pub fn scale(&self) -> Option<[f64; 2]> {
        let all = self.scales.iter().flatten().flatten();
        let range = all.copied().reduce(|[low, high], [l, h]| [low.min(l), high.max(h)])?;
        (range.iter().any(|factor| (factor - 1.0).abs() > 1e-9)).then_some(range)
    }

    /// Adds what the initial record says.
    pub(crate) fn add_initial(&mut self, initial: &StepJudgement) {
        self.add(initial);
        self.wrong_steps = 0;
    }

    /// Adds a step, in the order of the steps.
    pub(crate) fn add(&mut self, step: &StepJudgement) {
        for finding in &step.findings {
            self.charge(*finding);
        }
        self.counts += step.more;
        self.wrong_steps += u64::from(!step.findings.is_empty());
        self.borderline += step.borderline.len() as u64;
        let room = EXAMPLES.saturating_sub(self.borderline_examples.len());
        self.borderline_examples.extend(step.borderline.iter().take(room));
        for (all, new) in self.scales.iter_mut().flatten().zip(step.scales.iter().flatten()) {
            *all = match (*all, *new) {
                (Some([low, high]), Some([l, h])) => Some([low.min(l), high.max(h)]),
                (known, new) => known.or(new),
            };
        }
        self.lost += step.lost;
        for pending in &step.pending {
            let (row, number) = pending.place;
            let first = Hanging { finding: pending.finding, count: 0, factors: [0.0, f64::INFINITY] };
            let Hanging { count, factors: [low, high], .. } = self.pending[row][number].get_or_insert(first);
            *count += 1;
            *low = low.max(pending.factors[0]);
            *high = high.min(pending.factors[1]);
        }
        if step.endless {
            self.refusal = Some(Refusal::Stopped);
        }
        self.shares.widen(&step.shares);
        for (form, place) in [(Form::Course, step.course_form), (Form::Right, step.right_form)] {
            let Some(place) = place else { continue };
            if self.form == Form::Either {
                self.form = form;
            } else if self.form != form {
                self.mixed(step, place);
            }
        }
    }

    fn mixed(&mut self, step: &StepJudgement, place: PolynomialPlace) {
        if self.counts.get(Kind::MixedForms) == 0 {
            self.wrong_steps += u64::from(step.findings.is_empty());
        }
        self.charge(Finding { step: step.step, frame: step.frame, detail: Detail::MixedForms { place } });
    }

    /// Adds a finding.
    pub(crate) fn charge(&mut self, finding: Finding) {
        self.counts.add(finding.kind(), 1);
        if self.first_divergence.is_none() {
            self.first_divergence = Some(finding);
        }
        if !self.examples.iter().any(|example| example.kind() == finding.kind()) {
            self.examples.push(finding);
        }
    }

    /// Charges what is no round-off with the factors that the trace uses.
    fn settle_pending(&mut self) {
        let all = self.scales.iter().flatten().flatten().copied();
        let all = all.reduce(|[low, high], [l, h]| [low.min(l), high.max(h)]).unwrap_or([1.0; 2]);
        for row in 0..self.pending.len() {
            for number in 0..self.pending[row].len() {
                let Some(Hanging { finding, count, factors }) = self.pending[row][number].take() else { continue };
                let [low, high] = self.scales[row][number].unwrap_or(all);
                let room = 1e-9;
                if !(factors[0] <= high * (1.0 + room) && factors[1] >= low * (1.0 - room)) {
                    self.charge(finding);
                    self.counts.add(finding.kind(), count - 1);
                    self.wrong_steps = self.wrong_steps.max(1);
                }
            }
        }
    }

    /// Draws the verdict.
    pub(crate) fn conclude(&mut self, refusal: Option<Refusal>, complete: bool) {
        self.refusal = self.refusal.or(refusal);
        self.settle_pending();
        self.examples.sort_by_key(Finding::kind);
        self.verdict = if self.refusal.is_some() || self.counts.total() > 0 {
            Verdict::Rejected
        } else if complete {
            Verdict::Accepted
        } else {
            Verdict::None
        };
    }
}

/// The place of a kind of pair in [`Scales`].
#[must_use]
pub(super) const fn row(kind: PairKind) -> usize {
    match kind {
        PairKind::ParticleParticle => 0,
        PairKind::ParticleEdge => 1,
        PairKind::ParticleHalfPlane => 2,
    }
}
