//! What judging one step yields.
use super::context::{Context, Records};
use crate::{
    counts::FindingCounts,
    finding::{Finding, FindingDetail, FindingKind, PolynomialPlace},
};
use fosssim_model::sim::{ByKind, Pair, PairKind, Pass};

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
pub type Scales = ByKind<[Option<[f64; 2]>; PairKind::MOST_POLYNOMIALS]>;

/// Polynomials of a kind that are right if the program's polynomials of that kind have a factor within bounds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pending {
    /// Kind of pair and number of the polynomial in [`Scales`].
    pub place: (PairKind, usize),
    /// How many there are in the step.
    pub count: u64,
    /// The greatest of the least factors that they need, and what is wrong otherwise.
    pub least: (f64, Finding),
    /// The least of the greatest factors that they allow, and what is wrong otherwise.
    pub most: (f64, Finding),
}

impl Pending {
    /// One polynomial with the least and the greatest factor that it may have.
    pub fn new(finding: Finding, place: (PairKind, usize), [least, most]: [f64; 2]) -> Self {
        Self { place, count: 1, least: (least, finding), most: (most, finding) }
    }

    /// What is wrong where the program's factors lie between these.
    pub fn finding(&self, [low, high]: [f64; 2]) -> Option<Finding> {
        // Factors are known but for rounding.
        let room = 1e-9;
        let (least, most) = (self.least, self.most);
        if !(least.0 <= high * (1.0 + room)) {
            return Some(least.1);
        }
        (!(most.0 >= low * (1.0 - room))).then_some(most.1)
    }
}

/// What judging one step yields.
#[derive(Debug, Clone, Default)]
pub(crate) struct StepJudgement {
    /// The step, from 1.
    pub step: u32,
    /// The number of its end record.
    pub frame: u64,
    /// The first finding of each kind, in the order in which they were made.
    pub findings: Vec<Finding>,
    /// How many more there are of each kind.
    pub more: FindingCounts,
    /// Decisions about pairs.
    pub decisions: u64,
    /// Borderline decisions that were followed.
    pub borderline: Vec<Borderline>,
    /// Factors of polynomials.
    pub scales: Scales,
    /// Polynomials that lost other coefficients than the reference's.
    pub lost: u64,
    /// Used shares of tolerances.
    pub shares: Shares,
    /// A polynomial that is of the course's form and not of the right one.
    pub course_form: Option<PolynomialPlace>,
    /// A polynomial that is of the right form and not of the course's.
    pub right_form: Option<PolynomialPlace>,
    /// Polynomials that are right with some factors only: whether the program uses such a one, only the whole trace says.
    pub pending: Vec<Pending>,
    /// The trace's polynomials lead the step into a search without end.
    pub endless: bool,
}

impl StepJudgement {
    /// Of a step whose records are the reference's bit for bit, with so many polynomials in the end record.
    pub fn identical(context: &Context<'_>, step: u32, polynomials: usize) -> Self {
        let frame = u64::from(step) * u64::from(context.records_per_step);
        let passes = polynomials.checked_div(context.per_pass).unwrap_or(0);
        Self { step, frame, decisions: (passes * context.pairs) as u64, ..Self::default() }
    }

    /// Adds a finding.
    pub(super) fn charge(&mut self, finding: Finding) {
        if self.findings.iter().any(|first| first.kind() == finding.kind()) {
            self.more.add(finding.kind(), 1);
        } else {
            self.findings.push(finding);
        }
    }

    /// The same, with one more finding.
    pub(super) fn also(mut self, records: Records<'_>, detail: FindingDetail) -> Self {
        (self.step, self.frame) = (records.step, records.frame);
        self.charge(Finding { step: self.step, frame: self.frame, detail });
        self
    }

    /// Adds a polynomial that hangs on factors.
    pub(super) fn pend(&mut self, new: Pending) {
        let Some(known) = self.pending.iter_mut().find(|known| known.place == new.place) else {
            self.pending.push(new);
            return;
        };
        known.count += new.count;
        if new.least.0 > known.least.0 {
            known.least = new.least;
        }
        if new.most.0 < known.most.0 {
            known.most = new.most;
        }
    }

    /// Notes the factor of a polynomial of this kind and number.
    #[inline]
    pub(super) fn scale(&mut self, kind: PairKind, number: usize, scale: f64) {
        let range = &mut self.scales[kind][number];
        *range = Some(range.map_or([scale; 2], |[low, high]| [f64::min(low, scale), f64::max(high, scale)]));
    }

    /// Notes a borderline decision.
    pub(super) fn borderline(&mut self, pass: Pass, pair: Pair, collides: bool) {
        self.borderline.push(Borderline { step: self.step, pass, pair, collides });
    }

    /// Number of findings.
    pub(super) fn total(&self) -> u64 {
        self.findings.len() as u64 + self.more.total()
    }

    /// Whether it has findings that the step's sensitivity could excuse. Those about polynomials of known
    /// positions are not among them: their own bounds are all that counts.
    pub(super) fn hangs_on_round_off(&self) -> bool {
        self.findings.iter().any(|finding| {
            !matches!(
                finding.kind(),
                FindingKind::Coefficient
                    | FindingKind::PolynomialDegree
                    | FindingKind::WrongNormal
                    | FindingKind::ContactTime
                    | FindingKind::RepeatedCollision
                    | FindingKind::RecordsDiffer
                    | FindingKind::ImpossibleLog
            )
        })
    }

    /// Whether it has findings that another decision could explain.
    pub(super) fn hangs_on_decisions(&self) -> bool {
        self.findings.iter().any(|finding| {
            matches!(
                finding.kind(),
                FindingKind::PolynomialCount
                    | FindingKind::PassPositions
                    | FindingKind::Position
                    | FindingKind::Velocity
                    | FindingKind::TrimmedDecision
            )
        })
    }
}
