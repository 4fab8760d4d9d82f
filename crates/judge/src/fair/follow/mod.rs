//! The observer that follows a submission through one step, and charges what can't be followed.
//!
//! `passes` counts detection passes, `polynomials` compares what is logged, `decisions` follows what was decided,
//! `over` takes over what was seen of calls beforehand.
mod decisions;
mod over;
mod passes;
mod polynomials;

use super::{
    ahead::Ahead,
    contact,
    context::{Context, Followed, Records},
    formulas::{BoundedPairMotion, Expected},
    sensitivity::Sensitivity,
    step_judgement::StepJudgement,
};
use crate::{
    contacts::Contacts,
    finding::{Finding, FindingDetail, Part},
};
use decisions::Own;
use fosssim_model::sim::{ByKind, Decision, Detection, Observer, Pair, PairKind, Pass, Resume, Stage, State, Zone};
use fosssim_num::polynomial::Polynomial;

/// The greatest number of decisions for which room is made at first.
const DECISIONS: usize = 1 << 14;

/// Follows one step; filled in by the simulation, read by [`super::step`].
pub(super) struct Follower<'a> {
    context: &'a Context<'a>,
    records: Records<'a>,
    /// Looks at calls before they are made; on a first look only.
    ahead: Option<&'a mut Ahead>,
    /// What is known of the step's sensitivity to round-off, on a second look.
    sensitivity: Option<&'a Sensitivity>,
    /// Decisions (by number of the call) that are turned round: borderline ones, in hybrid scenes.
    flips: &'a [usize],
    /// What was found.
    pub judged: StepJudgement,
    /// All decisions of the step.
    pub decisions: Vec<Followed>,
    /// Calls of hybrid scenes whose decisions round-off may flip, in order (on a second look).
    pub borderline: Vec<usize>,
    pass: Pass,
    /// Passes so far: before the mid record, and after it.
    passes: [usize; 2],
    /// Passes in the trace; `None` where its polynomials don't come in whole passes.
    logged_passes: Option<[usize; 2]>,
    /// The number in the end record's list of the pass's next polynomial; `None` when it is not logged.
    next: Option<usize>,
    /// Particles that a response or the failsafe has moved since positions were last known.
    moved: Vec<bool>,
    /// Particles that the responses to the pass's hits are about to move, once it is over.
    moving: Vec<usize>,
    /// Whether the part before the mid record, or the geometric part, has an error that its result may follow from.
    spoilt: [bool; 2],
    /// Polynomials that were wrong of known positions in this step.
    wrong_formulas: ByKind<[bool; PairKind::MOST_POLYNOMIALS]>,
    /// The pairs of the logged impulses.
    contacts: Contacts,
    /// Logged impulses that a decision has used.
    used: Vec<bool>,
    /// What the reference's own polynomials say about the call, where the logged ones are right, and others.
    own: Option<Own>,
    /// Whether the call's polynomials are right, and lead the root finder to another decision than the reference's.
    is_disputed: bool,
    /// Whether any call's were so.
    pub has_disputes: bool,
    /// Whether such calls are decided as the reference decides them.
    prefers_own: bool,
    /// How the call's objects move.
    seen: Option<Seen>,
}

/// How the objects of a call move. What its polynomials should be follows, and is seldom asked once they are compared.
#[derive(Debug, Clone, Copy)]
struct Seen {
    motion: BoundedPairMotion,
    /// Whether the trace has the right approach polynomial, and not the course's.
    has_right_approach: bool,
}

impl<'a> Follower<'a> {
    /// Follows the step that `records` hold.
    pub fn new(
        context: &'a Context<'a>,
        records: Records<'a>,
        ahead: Option<&'a mut Ahead>,
        sensitivity: Option<&'a Sensitivity>,
        flips: &'a [usize],
    ) -> Self {
        let judged = StepJudgement { step: records.step, frame: records.frame, ..StepJudgement::default() };
        let mut follower = Self {
            context,
            records,
            ahead,
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
            spoilt: [false; 2],
            wrong_formulas: ByKind::default(),
            contacts: Contacts::of(&records.end.impulses),
            used: vec![false; records.end.impulses.len()],
            own: None,
            is_disputed: false,
            has_disputes: false,
            prefers_own: false,
            seen: None,
        };
        follower.count_passes();
        let passes = follower.logged_passes.map_or(1, |[before, after]| before + after);
        follower.decisions.reserve(passes.saturating_mul(context.pairs).min(DECISIONS));
        follower
    }

    /// Decides calls as the reference does where right polynomials lead the root finder to other decisions.
    pub fn preferring_own(mut self) -> Self {
        self.prefers_own = true;
        self
    }

    /// The time of impact of several logged polynomials from one on; none where the root finder does not end.
    fn logged_time(&self, index: usize, count: usize) -> Option<f64> {
        let mut logged = [Polynomial::default(); PairKind::MOST_POLYNOMIALS];
        for (number, polynomial) in logged[..count].iter_mut().enumerate() {
            *polynomial = Polynomial::untrimmed(self.records.end.polynomials.get(index + number));
        }
        contact::time_of(&logged[..count])
    }

    /// How the call's objects move, and what its polynomials should be.
    fn expected(&self) -> Option<(BoundedPairMotion, Expected)> {
        let Seen { motion, has_right_approach } = self.seen?;
        let polynomials = motion.polynomials();
        Some((motion, if has_right_approach { polynomials.with_right_approach() } else { polynomials }))
    }

    /// Ends the step, which left the reference in `state`.
    pub fn finish(&mut self, state: &State) {
        self.judged.decisions = self.decisions.len() as u64;
        self.settle_passes();
        self.settle_impulses();
        if !self.spoilt[1] {
            let frame = self.records.frame;
            let bounds = self.sensitivity.map(|known| &known.end);
            contact::states(self.context, &mut self.judged, frame, state, &self.records.end.state, bounds);
        }
    }

    fn charge(&mut self, detail: FindingDetail) {
        let (step, frame) = (self.records.step, self.records.frame);
        self.judged.charge(Finding { step, frame, detail });
    }
}

impl Observer for Follower<'_> {
    fn begin_pass(&mut self, pass: Pass) {
        self.pass = pass;
        if let Some(ahead) = &mut self.ahead {
            ahead.begin_pass();
        }
        for particle in self.moving.drain(..) {
            self.moved[particle] = true;
        }
        if matches!(pass.stage, Stage::Geometric { round: 0 }) {
            // The geometric part starts from the mid record, which is known.
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

    fn passes_over(&mut self, next: Pair, q_start: &[f64], q_end: &[f64]) -> usize {
        self.take_over(next, q_start, q_end)
    }

    fn solve(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], polynomials: &mut [Polynomial]) {
        if let Some(ahead) = &mut self.ahead {
            ahead.step_over();
        }
        self.own = None;
        self.is_disputed = false;
        self.seen = None;
        let Some(index) = self.next else { return };
        self.next = Some(index + polynomials.len());
        let records = self.records;
        let logged = |number: usize| records.end.polynomials.get(index + number);
        let same = polynomials.iter().enumerate().all(|(number, own)| {
            let (own, logged) = (own.coefficients(), logged(number));
            own.len() == logged.len() && own.iter().zip(logged).all(|(own, logged)| own.to_bits() == logged.to_bits())
        });
        if same {
            self.judged.same[pair.kind] += 1;
            if self.sensitivity.is_some() || !self.is_hybrid() {
                // Should the decision be disputed, it must be known how far round-off may reach.
                let motion = BoundedPairMotion::of(self.context.scene, pair, q_start, q_end);
                self.seen = Some(Seen { motion, has_right_approach: false });
            }
            self.note_course_form(pair, q_start, q_end, index);
            return;
        }
        let can_be_searched = (0..polynomials.len()).all(|number| contact::is_searchable(logged(number)));
        if self.review(pair, q_start, q_end, index, polynomials.len()) {
            let lengths =
                || polynomials.iter().enumerate().map(|(number, own)| (own.coefficients().len(), logged(number).len()));
            self.judged.lost += u64::from(lengths().any(|(own, logged)| logged != own));
            let lost = lengths().any(|(own, logged)| logged < own);
            self.own = contact::time_of(polynomials).map(|time| Own { time, lost });
            if let (Some(Own { time, lost: false }), Some(Seen { motion, .. }), true) =
                (self.own, &self.seen, can_be_searched)
                && let Some(other) = self.logged_time(index, polynomials.len())
            {
                self.is_disputed = (time <= 1.0) != (other <= 1.0);
                self.has_disputes |= self.is_disputed;
                if self.is_disputed && self.prefers_own || motion.is_moment(time, other) {
                    // Round-off is all that the submission's own time would bring.
                    return;
                }
            }
        }
        // What the submission solved is what decides, even if it is wrong: a wrong polynomial is charged once.
        if can_be_searched {
            for (number, own) in polynomials.iter_mut().enumerate() {
                *own = Polynomial::untrimmed(logged(number));
            }
        }
    }

    fn decide(&mut self, pair: Pair, decision: Decision) -> Decision {
        let decision = self.settle(pair, decision);
        self.decisions.push(Followed { pair, pass: self.pass, decision });
        decision
    }

    fn detection(&mut self, detection: &Detection<'_>) {
        if !matches!(detection.decision, Decision::Hit { .. }) {
            return;
        }
        let particles = self.context.particles(detection.pair).into_iter().flatten();
        match self.pass.stage {
            Stage::ContinuousTime => particles.for_each(|particle| self.moved[particle] = true),
            // A round's responses come behind its last detection.
            Stage::Impulses { .. } => self.moving.extend(particles),
            Stage::Simple | Stage::Geometric { .. } => {}
        }
    }

    fn failsafe(&mut self, _round: u32, zone: &Zone<'_>) {
        for &particle in zone.particles {
            self.moved[particle as usize] = true;
        }
    }

    fn synchronise(&mut self, state: &mut State) -> Resume {
        let Some(mid) = self.records.mid else { return Resume::Own };
        if let Some(logged) = self.logged_passes
            && logged[0] != self.passes[0]
            && !self.spoilt[0]
        {
            self.charge(FindingDetail::PassCount { part: Part::Impulses, expected: self.passes[0], actual: logged[0] });
            self.spoilt[0] = true;
        }
        if !self.spoilt[0] {
            let bounds = self.sensitivity.map(|known| &known.mid);
            contact::states(self.context, &mut self.judged, self.records.frame - 1, state, &mid.state, bounds);
        }
        let is_finite = mid.state.positions.iter().chain(&mid.state.velocities).all(|value| value.is_finite());
        if is_finite {
            state.positions.copy_from_slice(&mid.state.positions);
            state.velocities.copy_from_slice(&mid.state.velocities);
        }
        Resume::Synchronised
    }
}
