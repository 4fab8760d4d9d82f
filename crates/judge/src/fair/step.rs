//! Judges one step by the fair rules: follows it, looks at its sensitivity where something differs, and tries borderline
//! decisions the other way where they can't be seen.
use super::{
    ahead::Ahead,
    contact,
    follow::Follower,
    formulas::extent,
    judgement::{Borderline, Scales, Shares},
    probe::{Sensitivity, probe},
    reach::Ordinary,
};
use crate::{
    finding::{Detail, Finding, Kind, PolynomialPlace, RecordPart},
    outcome::Counts,
};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{Pair, PairKind, Pass, Simulation, State, StepError, pairs},
    trace::{Layout, LenientFrame},
};
use fosssim_num::{polynomial::MAX_COEFFICIENTS, vector::at};

/// So many borderline decisions of a hybrid step are tried the other way, all combinations of them.
const MOST_FLIPS: usize = 4;

/// What all steps share.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Context<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Polynomials of one detection pass over all pairs (trace-format.md 2).
    pub per_pass: usize,
    /// Pairs of one detection pass.
    pub pairs: usize,
    /// Records of one step.
    pub records_per_step: u32,
    /// States that need no look at the reference's own run.
    pub ordinary: Ordinary,
}

impl<'a> Context<'a> {
    /// The context of a scene.
    pub fn new(scene: &'a Scene) -> Self {
        let pairs = pairs(scene);
        let (per_pass, pairs) = (pairs.polynomials(), pairs.count());
        let records_per_step = Layout::of(scene).records_per_step();
        Self { scene, per_pass, pairs, records_per_step, ordinary: Ordinary::of(scene) }
    }

    /// The particles of a pair: one, two, or three with an edge.
    pub(super) fn particles(&self, pair: Pair) -> [Option<usize>; 3] {
        let (first, second) = (pair.first as usize, pair.second as usize);
        match pair.kind {
            PairKind::ParticleParticle => [Some(first), Some(second), None],
            PairKind::ParticleEdge => {
                let edge = &self.scene.edges[second];
                [Some(first), Some(edge.first), Some(edge.second)]
            }
            PairKind::ParticleHalfPlane => [Some(first), None, None],
        }
    }

    /// The size of the largest position: roundings of positions are of this size.
    pub(super) fn size(&self, state: &State) -> f64 {
        largest(&state.positions)
    }
}

impl Records<'_> {
    /// Whether it starts from states that are nothing out of the ordinary; the geometric part starts from the mid record.
    pub fn start_ordinarily(&self, context: &Context<'_>) -> bool {
        let is_hybrid = matches!(context.scene.collision, Collision::Hybrid { .. });
        let mid = self.mid.filter(|_| is_hybrid);
        context.ordinary.holds(self.before) && mid.is_none_or(|mid| context.ordinary.holds(&mid.state))
    }

    /// The states that the step is about.
    pub fn states(&self) -> impl Iterator<Item = &State> {
        [self.before, &self.end.state].into_iter().chain(self.mid.map(|mid| &mid.state))
    }
}

/// One step of the trace.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Records<'a> {
    /// Its number, from 1.
    pub step: u32,
    /// The number of its end record, from 0.
    pub frame: u64,
    /// The state that it starts from, the trace's own.
    pub before: &'a State,
    /// The mid record, where the layout has one.
    pub mid: Option<&'a LenientFrame>,
    /// The end record.
    pub end: &'a LenientFrame,
}

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
    pub more: Counts,
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
    pub(super) fn also(mut self, records: Records<'_>, detail: Detail) -> Self {
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

    /// Whether it has findings that the step's sensitivity could excuse. Polynomials of known positions are none: their own
    /// bounds are all that counts.
    fn hangs_on_round_off(&self) -> bool {
        self.findings.iter().any(|finding| {
            !matches!(
                finding.kind(),
                Kind::Coefficient
                    | Kind::PolynomialDegree
                    | Kind::WrongNormal
                    | Kind::ContactTime
                    | Kind::RepeatedCollision
                    | Kind::RecordsDiffer
                    | Kind::ImpossibleLog
            )
        })
    }

    /// Whether it has findings that another decision could explain.
    fn hangs_on_decisions(&self) -> bool {
        self.findings.iter().any(|finding| {
            matches!(
                finding.kind(),
                Kind::PolynomialCount | Kind::PassPositions | Kind::Position | Kind::Velocity | Kind::TrimmedDecision
            )
        })
    }
}

/// The size of the largest vector, in whatever directions the axes point.
pub(super) fn largest(vectors: &[f64]) -> f64 {
    let all = (0..vectors.len() / 2).map(|index| extent(at(vectors, index)));
    all.fold(0.0, f64::max)
}

/// Judges a step. `identical` says that states, impulses and polynomials of both records are the reference's bit for
/// bit; then only what the records say besides is looked at. With `ahead` calls are looked at many at a time; the judgement is
/// the same. The reference has a result; if there is none here, it is what
/// the trace logged that leads to a search without end.
pub(crate) fn judge(
    context: &Context<'_>,
    simulation: &mut Simulation,
    ahead: Option<&mut Ahead>,
    records: Records<'_>,
    identical: bool,
) -> StepJudgement {
    let (step, frame) = (records.step, records.frame);
    let mut judged = if identical {
        StepJudgement::identical(context, step, records.end.polynomials.len())
    } else {
        follow(context, simulation, ahead, records).unwrap_or_else(|_| StepJudgement {
            step,
            frame,
            endless: true,
            ..StepJudgement::default()
        })
    };
    if !judged.endless {
        compare_records(context, records, &mut judged);
    }
    judged
}

/// Compares the first record with the scene.
pub(crate) fn judge_initial(context: &Context<'_>, frame: &LenientFrame) -> StepJudgement {
    let mut judged = StepJudgement::default();
    let mut state = State::default();
    for particle in &context.scene.particles {
        state.positions.extend([particle.position.x, particle.position.y]);
        state.velocities.extend([particle.velocity.x, particle.velocity.y]);
    }
    contact::states(context, &mut judged, 0, &state, &frame.state, None);
    if !frame.impulses.is_empty() || !frame.polynomials.is_empty() {
        let part = if frame.impulses.is_empty() { RecordPart::Polynomials } else { RecordPart::Impulses };
        judged.charge(Finding { step: 0, frame: 0, detail: Detail::RecordsDiffer { part } });
    }
    judged
}

fn follow(
    context: &Context<'_>,
    simulation: &mut Simulation,
    ahead: Option<&mut Ahead>,
    records: Records<'_>,
) -> Result<StepJudgement, StepError> {
    let attempt =
        |simulation: &mut Simulation, ahead: Option<&mut Ahead>, sensitivity: Option<&Sensitivity>, flips: &[usize]| {
            simulation.state_mut().clone_from(records.before);
            simulation.set_steps_done(records.step - 1);
            let mut follower = Follower::new(context, records, ahead, sensitivity, flips);
            simulation.step(&mut follower)?;
            follower.finish(simulation.state());
            Ok::<_, StepError>((follower.judged, follower.decisions, follower.borderline))
        };
    let (first, decisions, _) = attempt(simulation, ahead, None, &[])?;
    if !first.hangs_on_round_off() {
        return Ok(first);
    }
    let sensitivity = probe(context, simulation, &records, &decisions);
    let (second, _, borderline) = attempt(simulation, None, Some(&sensitivity), &[])?;
    if second.total() == 0 || !second.hangs_on_decisions() {
        return Ok(second);
    }
    let borderline = &borderline[..borderline.len().min(MOST_FLIPS)];
    for set in 1_usize..1 << borderline.len() {
        let flips: Vec<usize> =
            borderline.iter().enumerate().filter(|(bit, _)| set >> bit & 1 == 1).map(|(_, call)| *call).collect();
        if let Ok((other, ..)) = attempt(simulation, None, Some(&sensitivity), &flips)
            && other.total() == 0
        {
            return Ok(other);
        }
    }
    Ok(second)
}

/// What both records of a step must agree in (trace-format.md 2), and what no program that uses the course's library
/// can have written.
fn compare_records(context: &Context<'_>, records: Records<'_>, judged: &mut StepJudgement) {
    let Records { step, frame, mid, end, .. } = records;
    let mut charge = |detail| judged.charge(Finding { step, frame, detail });
    if is_impossible(end) || mid.is_some_and(is_impossible) {
        charge(Detail::ImpossibleLog);
    }
    let Some(mid) = mid else { return };
    if mid.impulses.len() != end.impulses.len() || !mid.impulses.iter().zip(&end.impulses).all(same_impulse) {
        charge(Detail::RecordsDiffer { part: RecordPart::Impulses });
    }
    let count = mid.polynomials.len();
    let is_hybrid = matches!(context.scene.collision, Collision::Hybrid { .. });
    let whole = if is_hybrid { count <= end.polynomials.len() } else { count == end.polynomials.len() };
    let same = whole && (0..count).all(|index| same_bits(mid.polynomials.get(index), end.polynomials.get(index)));
    if !same {
        charge(Detail::RecordsDiffer { part: RecordPart::Polynomials });
    }
}

/// Whether the record holds what the course's library does not write: small leading coefficients that were not dropped, or
/// more coefficients than any detection has.
fn is_impossible(frame: &LenientFrame) -> bool {
    let log = &frame.polynomials;
    frame.note.is_none() && !frame.plain || (0..log.len()).any(|index| log.get(index).len() > MAX_COEFFICIENTS)
}

fn same_impulse((a, b): (&fosssim_model::trace::LoggedImpulse, &fosssim_model::trace::LoggedImpulse)) -> bool {
    (a.kind, a.first, a.second) == (b.kind, b.first, b.second)
        && same_bits(&[a.normal.x, a.normal.y, a.time], &[b.normal.x, b.normal.y, b.time])
}

fn same_bits(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}
