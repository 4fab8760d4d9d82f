//! The observer that follows a submission through one step, and counts the differences that it cannot follow.
//!
//! `passes` counts detection passes, `polynomials` compares what is logged, `decisions` follows the decisions, and
//! `quick_matches` skips the bounds of polynomials that are right by a wide margin.
mod decisions;
mod passes;
mod polynomials;
mod quick_matches;

use super::{
    contact::{self, Tolerances},
    context::{Context, FollowedDecision, Records},
    formulas::{BoundedPairMotion, ExpectedPolynomials},
    probe::Sensitivity,
    step_judgment::StepJudgment,
    unapplied_pairs,
};
use crate::{
    contacts::Contacts,
    finding::{Finding, FindingDetail, Part},
};
use decisions::ReferenceImpact;
use fosssim_model::{
    scene::Collision,
    sim::{
        Decision, Detection, Observer, Pair, PairKind, PairKindMap, Pass, ResumeState, Stage, State, StepController,
        Zone,
    },
};
use fosssim_num::{certificate::find_list_exclusion, polynomial::Polynomial, vector::has_same_bits};
use quick_matches::RoundOffFloors;

/// The initial capacity of the list of decisions.
const DECISIONS_CAPACITY: usize = 1 << 14;

/// The observer of one step. The simulation calls it, and [`super::step`] reads the result.
pub(super) struct Follower<'a> {
    context: &'a Context<'a>,
    records: Records<'a>,
    /// The step's sensitivity to round-off, in the second comparison.
    sensitivity: Option<&'a Sensitivity>,
    /// The numbers of the calls in hybrid scenes whose borderline decisions are reversed.
    flipped_decisions: &'a [usize],
    /// The judgment of the step so far.
    pub judgment: StepJudgment,
    /// All decisions of the step.
    pub decisions: Vec<FollowedDecision>,
    /// The calls of hybrid scenes whose decisions round-off may change, in order. They are known in the second
    /// comparison.
    pub borderline_calls: Vec<usize>,
    pass: Pass,
    /// The numbers of passes so far, before and after the mid record.
    passes: [usize; 2],
    /// The numbers of passes in the trace, or `None` if its polynomials do not fill whole passes.
    logged_passes: Option<[usize; 2]>,
    /// The index of the pass's next polynomial in the end record's list, or `None` if it is not logged.
    next_polynomial: Option<usize>,
    /// The particles that a response or the failsafe has moved since their last known positions.
    moved_particles: Vec<bool>,
    /// The particles that the responses to the pass's hits will move after the pass.
    particles_to_move: Vec<usize>,
    /// Whether each of the step's two parts has an error that can explain the part's result. The first part ends at the
    /// mid record, the second is the geometric part.
    has_error: [bool; 2],
    /// The polynomials that were wrong at known positions in this step.
    wrong_formulas: PairKindMap<[bool; PairKind::MAX_POLYNOMIALS]>,
    /// The pairs of the logged impulses.
    contacts: Contacts,
    /// The logged impulses that a decision has used.
    used_impulses: Vec<bool>,
    /// The data of the current call.
    call: CurrentCall,
    /// Whether any call was disputed.
    pub has_disputes: bool,
    /// Whether disputed calls are decided as in the reference.
    prefers_own: bool,
    /// The floors of round-off for polynomials at the positions of the pass, computed on demand.
    round_off_floors: Option<RoundOffFloors>,
}

/// The data of a call between its polynomials and its decision.
#[derive(Debug, Default)]
struct CurrentCall {
    /// The result of the reference's own polynomials, if the logged polynomials are right but different.
    own: Option<ReferenceImpact>,
    /// Whether right polynomials lead the root finder to a decision that differs from the reference's.
    is_disputed: bool,
    /// Whether the logged polynomials are right and complete, and exclude an impact.
    is_excluded_by_log: bool,
    /// The motion of the pair's objects; `None` if it has not been computed.
    motion: Option<CallMotion>,
}

/// The motion of the objects of a call. The expected polynomials are computed from it, and are rarely needed after the
/// comparison.
#[derive(Debug, Clone, Copy)]
struct CallMotion {
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
        let step_judgment = StepJudgment { step: records.step, frame: records.frame, ..StepJudgment::default() };
        let mut follower = Self {
            context,
            records,
            sensitivity,
            flipped_decisions: flips,
            judgment: step_judgment,
            decisions: Vec::new(),
            borderline_calls: Vec::new(),
            pass: Pass { stage: Stage::Simple, index: 0 },
            passes: [0; 2],
            logged_passes: None,
            next_polynomial: None,
            moved_particles: vec![false; context.scene.particles.len()],
            particles_to_move: Vec::new(),
            has_error: [false; 2],
            wrong_formulas: PairKindMap::default(),
            contacts: Contacts::from_impulses(&records.end.impulses),
            used_impulses: vec![false; records.end.impulses.len()],
            call: CurrentCall::default(),
            has_disputes: false,
            prefers_own: false,
            round_off_floors: None,
        };
        follower.count_passes();
        let passes = follower.logged_passes.map_or(1, |[before, after]| before + after);
        follower.decisions.reserve(passes.saturating_mul(context.pair_count).min(DECISIONS_CAPACITY));
        follower
    }

    /// Makes the observer decide disputed calls as the reference does.
    pub fn prefer_own(mut self) -> Self {
        self.prefers_own = true;
        self
    }

    /// Returns the logged polynomials of a call, if their root search provably ends.
    fn searchable_polynomials(&self, index: usize, count: usize) -> Option<[Polynomial; PairKind::MAX_POLYNOMIALS]> {
        let mut found = [Polynomial::default(); PairKind::MAX_POLYNOMIALS];
        for (number, polynomial) in found[..count].iter_mut().enumerate() {
            let logged = self.records.end.polynomials.get(index + number);
            *polynomial = contact::is_searchable(logged).then(|| Polynomial::untrimmed(logged))?;
        }
        Some(found)
    }

    /// Returns the motion of the call's objects, and the expected polynomials, or `None` if the motion has not been
    /// computed.
    fn expected_polynomials(&self) -> Option<(BoundedPairMotion, ExpectedPolynomials)> {
        let CallMotion { motion, has_right_approach } = self.call.motion?;
        let polynomials = motion.polynomials();
        Some((motion, if has_right_approach { polynomials.with_right_approach() } else { polynomials }))
    }

    /// Ends the step: compares what is known only at its end. `state` is the reference's end state.
    pub fn finish(&mut self, state: &State) {
        self.judgment.decisions = self.decisions.len() as u64;
        self.compare_pass_counts();
        self.count_unused_impulses();
        if !self.has_error[1] {
            self.compare_end_states(state);
        }
    }

    /// Compares the states at the end of the step. If omitted or doubled forces of pairs explain differences, these
    /// pairs are reported instead.
    fn compare_end_states(&mut self, own: &State) {
        let Records { frame, before, end, .. } = self.records;
        let tolerances =
            Tolerances::from_context(self.context, own, self.sensitivity.map(|earlier_judgment| &earlier_judgment.end));
        let earlier_judgment =
            matches!(self.context.scene.collision, Collision::Penalty { .. }).then(|| self.judgment.clone());
        contact::compare_states(&mut self.judgment, frame, own, &end.state, &tolerances);
        let Some(earlier_judgment) =
            earlier_judgment.filter(|earlier_judgment| earlier_judgment.total() < self.judgment.total())
        else {
            return;
        };
        let explained = unapplied_pairs::explain_velocities(self.context, &tolerances, before, own, &end.state);
        if let Some((pairs, faulty)) = explained {
            self.judgment = earlier_judgment;
            pairs.into_iter().for_each(|detail| self.add_finding(detail));
            contact::compare_states(&mut self.judgment, frame, &faulty, &end.state, &tolerances);
        }
    }

    fn add_finding(&mut self, detail: FindingDetail) {
        let (step, frame) = (self.records.step, self.records.frame);
        self.judgment.add_finding(Finding { step, frame, detail });
    }
}

impl Observer for Follower<'_> {
    fn begin_pass(&mut self, pass: Pass) {
        self.pass = pass;
        self.round_off_floors = None;
        for particle in self.particles_to_move.drain(..) {
            self.moved_particles[particle] = true;
        }
        if matches!(pass.stage, Stage::Geometric { round: 0 }) {
            // The geometric part starts from the positions of the mid record, which are known.
            self.moved_particles.fill(false);
        }
        let stage = self.stage_index();
        let number = self.passes[stage];
        self.passes[stage] += 1;
        self.next_polynomial = self.logged_passes.filter(|logged| number < logged[stage]).map(|logged| {
            let passes = if stage == 0 { number } else { logged[0] + number };
            passes * self.context.polynomials_per_pass
        });
    }

    fn observe_detection(&mut self, detection: &Detection<'_>) {
        if !detection.decision.collides() {
            return;
        }
        let particles = self.context.particles(detection.pair).into_iter().flatten();
        match self.pass.stage {
            Stage::ContinuousTime => {
                particles.for_each(|particle| self.moved_particles[particle] = true);
                self.round_off_floors = None;
            }
            // The responses of a round come after its last detection.
            Stage::Impulses { .. } => self.particles_to_move.extend(particles),
            Stage::Simple | Stage::Geometric { .. } => {}
        }
    }

    fn observe_failsafe(&mut self, _round: u32, zone: &Zone<'_>) {
        for &particle in zone.particles {
            self.moved_particles[particle as usize] = true;
        }
    }

    fn as_controller(&mut self) -> Option<&mut dyn StepController> {
        Some(self)
    }
}

impl StepController for Follower<'_> {
    fn adjust_polynomials(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], polynomials: &mut [Polynomial]) {
        self.call = CurrentCall::default();
        let Some(index) = self.next_polynomial else { return };
        self.next_polynomial = Some(index + polynomials.len());
        let records = self.records;
        let logged = |number: usize| records.end.polynomials.get(index + number);
        let mut numbered = polynomials.iter().enumerate();
        let is_same = numbered.all(|(number, own)| has_same_bits(own.coefficients(), logged(number)));
        if is_same {
            self.judgment.identical_polynomials[pair.kind] += 1;
            if self.sensitivity.is_some() || !self.is_hybrid() {
                // If the logged decision differs, the motion shows whether round-off can explain it.
                let motion = BoundedPairMotion::for_pair(self.context.scene, pair, q_start, q_end);
                self.call.motion = Some(CallMotion { motion, has_right_approach: false });
            }
            self.record_course_form(pair, q_start, q_end, index);
            return;
        }
        let count = polynomials.len();
        let quick_matches = self.find_quick_matches(pair, [q_start, q_end], index, polynomials);
        let is_right = self.review(pair, [q_start, q_end], index, &quick_matches[..count]);
        if is_right {
            let lengths = || polynomials.iter().enumerate().map(|(k, own)| (own.coefficients().len(), logged(k).len()));
            let differ = quick_matches[..count].contains(&None) && lengths().any(|(own, logged)| logged != own);
            self.judgment.lost_decisions += u64::from(differ);
            // The root search must also end for the reference's own polynomials.
            self.call.is_excluded_by_log = !differ
                && polynomials.iter().all(|own| contact::is_searchable(own.coefficients()))
                && find_list_exclusion((0..count).map(logged)).is_some();
            if self.call.motion.is_none() && !(self.call.is_excluded_by_log && self.is_hybrid()) {
                let motion = BoundedPairMotion::for_pair(self.context.scene, pair, q_start, q_end);
                self.call.motion = Some(CallMotion { motion, has_right_approach: false });
            }
            if self.call.is_excluded_by_log {
                return;
            }
            let has_losses = differ && lengths().any(|(own, logged)| logged < own);
            self.call.own = contact::find_time(polynomials).map(|time| ReferenceImpact { time, has_losses });
        }
        let Some(searched) = self.searchable_polynomials(index, count) else { return };
        if let (true, Some(ReferenceImpact { time, has_losses: false }), Some(CallMotion { motion, .. })) =
            (is_right, self.call.own, &self.call.motion)
            && let Some(other) = contact::find_time(&searched[..count])
        {
            self.call.is_disputed = (time <= 1.0) != (other <= 1.0);
            self.has_disputes |= self.call.is_disputed;
            if self.call.is_disputed && self.prefers_own || motion.is_same_moment(time, other) {
                // The reference's polynomials are kept if they are preferred, or if both times differ only by
                // round-off.
                return;
            }
        }
        // The submission's polynomials decide even if they are wrong, so that a wrong polynomial is counted only once.
        polynomials.copy_from_slice(&searched[..count]);
    }

    fn adjust_decision(&mut self, pair: Pair, decision: Decision) -> Decision {
        let decision = if self.call.is_excluded_by_log { self.resolve_dispute(pair, decision) } else { decision };
        let decision = self.choose_decision(pair, decision);
        self.decisions.push(FollowedDecision { pair, pass: self.pass, decision });
        decision
    }

    fn choose_resume_state(&mut self, state: &mut State) -> ResumeState {
        let Some(mid) = self.records.mid else { return ResumeState::Own };
        if let Some(logged) = self.logged_passes
            && logged[0] != self.passes[0]
            && !self.has_error[0]
        {
            self.add_finding(FindingDetail::PassCount {
                part: Part::Impulses,
                expected: self.passes[0],
                actual: logged[0],
            });
            self.has_error[0] = true;
        }
        if !self.has_error[0] {
            let bounds = self.sensitivity.map(|known| &known.mid);
            let tolerances = Tolerances::from_context(self.context, state, bounds);
            contact::compare_states(&mut self.judgment, self.records.frame - 1, state, &mid.state, &tolerances);
        }
        if mid.state.is_finite() {
            state.clone_from(&mid.state);
        }
        ResumeState::Synchronized
    }
}
