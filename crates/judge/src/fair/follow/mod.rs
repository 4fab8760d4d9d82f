//! The observer that follows a submission through one step, and counts the differences that it cannot follow.
//!
//! `passes` counts detection passes, `polynomials` compares what is logged, `decisions` follows the decisions, and
//! `clearly_right` skips the bounds of polynomials that are clearly right.
mod clearly_right;
mod decisions;
mod passes;
mod polynomials;

use super::{
    contact::{self, Tolerances},
    context::{Context, FollowedDecision, Records},
    formulas::{BoundedPairMotion, ExpectedPolynomials},
    probe::Sensitivity,
    step_judgement::StepJudgement,
    unapplied,
};
use crate::{
    contacts::Contacts,
    finding::{Finding, FindingDetail, Part},
};
use clearly_right::RoundOffFloors;
use decisions::OwnImpact;
use fosssim_model::{
    scene::Collision,
    sim::{
        Decision, Detection, Observer, Pair, PairKind, PairKindMap, Pass, ResumeState, Stage, State, StepController,
        Zone,
    },
};
use fosssim_num::{certificate::exclusion_of, polynomial::Polynomial, vector::same_bits};

/// The initial capacity of the list of decisions.
const DECISIONS_CAPACITY: usize = 1 << 14;

/// Follows one step. The simulation calls it as an observer; [`super::step`] reads the result.
pub(super) struct Follower<'a> {
    context: &'a Context<'a>,
    records: Records<'a>,
    /// The step's sensitivity to round-off, in the second comparison.
    sensitivity: Option<&'a Sensitivity>,
    /// The calls whose borderline decisions are reversed in hybrid scenes, by number.
    flips: &'a [usize],
    /// The judgement of the step so far.
    pub judged: StepJudgement,
    /// All decisions of the step.
    pub decisions: Vec<FollowedDecision>,
    /// Calls of hybrid scenes whose decisions round-off may change, in order (in the second comparison).
    pub borderline: Vec<usize>,
    pass: Pass,
    /// The numbers of passes so far, before and after the mid record.
    passes: [usize; 2],
    /// The numbers of passes in the trace; `None` if its polynomials don't fill whole passes.
    logged_passes: Option<[usize; 2]>,
    /// The index of the pass's next polynomial in the end record's list; `None` if it is not logged.
    next: Option<usize>,
    /// Particles that a response or the failsafe has moved since their last known positions.
    moved: Vec<bool>,
    /// Particles that the responses to the pass's hits will move after the pass.
    moving: Vec<usize>,
    /// Whether the part before the mid record, or the geometric part, has an error that can explain its result.
    tainted: [bool; 2],
    /// Polynomials that were wrong at known positions in this step.
    wrong_formulas: PairKindMap<[bool; PairKind::MAX_POLYNOMIALS]>,
    /// The pairs of the logged impulses.
    contacts: Contacts,
    /// Logged impulses that a decision has used.
    used: Vec<bool>,
    /// The data of the current call.
    call: CurrentCall,
    /// Whether any call was disputed.
    pub has_disputes: bool,
    /// Whether disputed calls are decided like the reference.
    prefers_own: bool,
    /// The floors of round-off for polynomials at the positions of the pass, computed on demand.
    floors: Option<RoundOffFloors>,
}

/// The data of a call between its polynomials and its decision.
#[derive(Debug, Default)]
struct CurrentCall {
    /// The result of the reference's own polynomials, if the logged polynomials are right but different.
    own: Option<OwnImpact>,
    /// Whether right polynomials lead the root finder to a decision that differs from the reference's.
    is_disputed: bool,
    /// Whether the polynomials are right and complete, and the logged ones exclude an impact.
    misses_logged: bool,
    /// The motion of the objects.
    seen: Option<SeenCall>,
}

/// The motion of the objects of a call. The expected polynomials are computed from it, and are rarely needed after the
/// comparison.
#[derive(Debug, Clone, Copy)]
struct SeenCall {
    motion: BoundedPairMotion,
    /// Whether the trace uses the mathematically right approach polynomial instead of the course's.
    has_right_approach: bool,
}

impl<'a> Follower<'a> {
    /// Creates an observer of the step in `records`.
    pub fn new(
        context: &'a Context<'a>,
        records: Records<'a>,
        sensitivity: Option<&'a Sensitivity>,
        flips: &'a [usize],
    ) -> Self {
        let judged = StepJudgement { step: records.step, frame: records.frame, ..StepJudgement::default() };
        let mut follower = Self {
            context,
            records,
            sensitivity,
            flips,
            judged,
            decisions: Vec::new(),
            borderline: Vec::new(),
            pass: Pass { stage: Stage::Simple, index: 0 },
            passes: [0; 2],
            logged_passes: None,
            next: None,
            moved: vec![false; context.scene.particles.len()],
            moving: Vec::new(),
            tainted: [false; 2],
            wrong_formulas: PairKindMap::default(),
            contacts: Contacts::from_impulses(&records.end.impulses),
            used: vec![false; records.end.impulses.len()],
            call: CurrentCall::default(),
            has_disputes: false,
            prefers_own: false,
            floors: None,
        };
        follower.count_passes();
        let passes = follower.logged_passes.map_or(1, |[before, after]| before + after);
        follower.decisions.reserve(passes.saturating_mul(context.pairs).min(DECISIONS_CAPACITY));
        follower
    }

    /// Decides disputed calls like the reference.
    pub fn preferring_own(mut self) -> Self {
        self.prefers_own = true;
        self
    }

    /// Returns the logged polynomials of a call, if their root search certainly ends.
    fn searchable_polynomials(&self, index: usize, count: usize) -> Option<[Polynomial; PairKind::MAX_POLYNOMIALS]> {
        let mut found = [Polynomial::default(); PairKind::MAX_POLYNOMIALS];
        for (number, polynomial) in found[..count].iter_mut().enumerate() {
            let logged = self.records.end.polynomials.get(index + number);
            *polynomial = contact::is_searchable(logged).then(|| Polynomial::untrimmed(logged))?;
        }
        Some(found)
    }

    /// Returns the motion of the call's objects, and the expected polynomials.
    fn expected_polynomials(&self) -> Option<(BoundedPairMotion, ExpectedPolynomials)> {
        let SeenCall { motion, has_right_approach } = self.call.seen?;
        let polynomials = motion.polynomials();
        Some((motion, if has_right_approach { polynomials.with_right_approach() } else { polynomials }))
    }

    /// Ends the step, which left the reference in `state`.
    pub fn finish(&mut self, state: &State) {
        self.judged.decisions = self.decisions.len() as u64;
        self.settle_passes();
        self.settle_impulses();
        if !self.tainted[1] {
            self.settle_states(state);
        }
    }

    /// Compares the states at the end of the step. Differences that wrong forces of pairs explain are not counted
    /// again.
    fn settle_states(&mut self, own: &State) {
        let Records { frame, before, end, .. } = self.records;
        let tolerances = Tolerances::from_context(self.context, own, self.sensitivity.map(|known| &known.end));
        let known = matches!(self.context.scene.collision, Collision::Penalty { .. }).then(|| self.judged.clone());
        contact::compare_states(&mut self.judged, frame, own, &end.state, &tolerances);
        let Some(known) = known.filter(|known| known.total() < self.judged.total()) else { return };
        let explained = unapplied::explain(self.context, &tolerances, before, own, &end.state);
        if let Some((pairs, faulty)) = explained {
            self.judged = known;
            pairs.into_iter().for_each(|detail| self.add_finding(detail));
            contact::compare_states(&mut self.judged, frame, &faulty, &end.state, &tolerances);
        }
    }

    fn add_finding(&mut self, detail: FindingDetail) {
        let (step, frame) = (self.records.step, self.records.frame);
        self.judged.add_finding(Finding { step, frame, detail });
    }
}

impl Observer for Follower<'_> {
    fn begin_pass(&mut self, pass: Pass) {
        self.pass = pass;
        self.floors = None;
        for particle in self.moving.drain(..) {
            self.moved[particle] = true;
        }
        if matches!(pass.stage, Stage::Geometric { round: 0 }) {
            // The geometric part starts from the positions of the mid record, which are known.
            self.moved.fill(false);
        }
        let part = self.part();
        let number = self.passes[part];
        self.passes[part] += 1;
        self.next = self.logged_passes.filter(|logged| number < logged[part]).map(|logged| {
            let passes = if part == 0 { number } else { logged[0] + number };
            passes * self.context.per_pass
        });
    }

    fn observe_detection(&mut self, detection: &Detection<'_>) {
        if !detection.decision.collides() {
            return;
        }
        let particles = self.context.particles(detection.pair).into_iter().flatten();
        match self.pass.stage {
            Stage::ContinuousTime => {
                particles.for_each(|particle| self.moved[particle] = true);
                self.floors = None;
            }
            // The responses of a round come after its last detection.
            Stage::Impulses { .. } => self.moving.extend(particles),
            Stage::Simple | Stage::Geometric { .. } => {}
        }
    }

    fn observe_failsafe(&mut self, _round: u32, zone: &Zone<'_>) {
        for &particle in zone.particles {
            self.moved[particle as usize] = true;
        }
    }

    fn as_controller(&mut self) -> Option<&mut dyn StepController> {
        Some(self)
    }
}

impl StepController for Follower<'_> {
    fn adjust_polynomials(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], polynomials: &mut [Polynomial]) {
        self.call = CurrentCall::default();
        let Some(index) = self.next else { return };
        self.next = Some(index + polynomials.len());
        let records = self.records;
        let logged = |number: usize| records.end.polynomials.get(index + number);
        let mut numbered = polynomials.iter().enumerate();
        let same = numbered.all(|(number, own)| same_bits(own.coefficients(), logged(number)));
        if same {
            self.judged.same[pair.kind] += 1;
            if self.sensitivity.is_some() || !self.is_hybrid() {
                // If the decision is disputed, the effect of round-off must be known.
                let motion = BoundedPairMotion::for_pair(self.context.scene, pair, q_start, q_end);
                self.call.seen = Some(SeenCall { motion, has_right_approach: false });
            }
            self.note_course_form(pair, q_start, q_end, index);
            return;
        }
        let count = polynomials.len();
        let at_once = self.right_at_once(pair, [q_start, q_end], index, polynomials);
        let is_right = self.review(pair, [q_start, q_end], index, &at_once[..count]);
        if is_right {
            let lengths = || polynomials.iter().enumerate().map(|(k, own)| (own.coefficients().len(), logged(k).len()));
            let differ = at_once[..count].contains(&None) && lengths().any(|(own, logged)| logged != own);
            self.judged.lost += u64::from(differ);
            // The root search must also end for the reference's own polynomials.
            self.call.misses_logged = !differ
                && polynomials.iter().all(|own| contact::is_searchable(own.coefficients()))
                && exclusion_of((0..count).map(logged)).is_some();
            if self.call.seen.is_none() && !(self.call.misses_logged && self.is_hybrid()) {
                let motion = BoundedPairMotion::for_pair(self.context.scene, pair, q_start, q_end);
                self.call.seen = Some(SeenCall { motion, has_right_approach: false });
            }
            if self.call.misses_logged {
                return;
            }
            let lost = differ && lengths().any(|(own, logged)| logged < own);
            self.call.own = contact::time_of(polynomials).map(|time| OwnImpact { time, lost });
        }
        let Some(searched) = self.searchable_polynomials(index, count) else { return };
        if let (true, Some(OwnImpact { time, lost: false }), Some(SeenCall { motion, .. })) =
            (is_right, self.call.own, &self.call.seen)
            && let Some(other) = contact::time_of(&searched[..count])
        {
            self.call.is_disputed = (time <= 1.0) != (other <= 1.0);
            self.has_disputes |= self.call.is_disputed;
            if self.call.is_disputed && self.prefers_own || motion.is_moment(time, other) {
                // The submission's own time would change only round-off.
                return;
            }
        }
        // The submission's polynomials decide, even if they are wrong, so that a wrong polynomial is counted only once.
        polynomials.copy_from_slice(&searched[..count]);
    }

    fn adjust_decision(&mut self, pair: Pair, decision: Decision) -> Decision {
        let decision = if self.call.misses_logged { self.resolve_dispute(pair, decision) } else { decision };
        let decision = self.choose_decision(pair, decision);
        self.decisions.push(FollowedDecision { pair, pass: self.pass, decision });
        decision
    }

    fn choose_resume_state(&mut self, state: &mut State) -> ResumeState {
        let Some(mid) = self.records.mid else { return ResumeState::Own };
        if let Some(logged) = self.logged_passes
            && logged[0] != self.passes[0]
            && !self.tainted[0]
        {
            self.add_finding(FindingDetail::PassCount {
                part: Part::Impulses,
                expected: self.passes[0],
                actual: logged[0],
            });
            self.tainted[0] = true;
        }
        if !self.tainted[0] {
            let bounds = self.sensitivity.map(|known| &known.mid);
            let tolerances = Tolerances::from_context(self.context, state, bounds);
            contact::compare_states(&mut self.judged, self.records.frame - 1, state, &mid.state, &tolerances);
        }
        if mid.state.is_finite() {
            state.clone_from(&mid.state);
        }
        ResumeState::Synchronized
    }
}
