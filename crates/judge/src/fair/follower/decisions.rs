//! Judges a step's decisions and contacts.
use super::Follower;
use crate::{
    contacts::{logged_key, pair_key},
    fair::contact,
    finding::FindingDetail,
};
use fosssim_model::{
    sim::{Decision, ImpactTime, Impulse, Pair, Stage},
    trace::LoggedImpulse,
};
use fosssim_num::vector::Vec2;

/// The result of the reference's own polynomials for a pair whose logged polynomials are right but different.
#[derive(Debug, Clone, Copy)]
pub(super) struct ReferenceImpact {
    /// The objects' time of impact.
    pub time: f64,
    /// Whether the logged polynomials lack leading coefficients that the reference's have.
    pub has_losses: bool,
}

impl Follower<'_> {
    /// Returns the decision with which the step continues. The submission's decision is used if the trace shows it.
    pub(super) fn choose_decision(&mut self, pair: Pair, logged_decision: Decision) -> Decision {
        let call = self.decisions.len();
        let findings = self.judgment.total();
        let own = self.call.own.take();
        if let Some(own) = own {
            self.report_losses(pair, logged_decision, own);
        }
        let decision = match self.pass.stage {
            Stage::Simple | Stage::ContinuousTime => self.follow(pair, logged_decision),
            Stage::Impulses { .. } | Stage::Geometric { .. } if self.flipped_decisions.contains(&call) => {
                self.reverse_decision(logged_decision)
            }
            Stage::Impulses { .. } | Stage::Geometric { .. } => logged_decision,
        };
        let is_expected = match own {
            Some(own) if (own.time <= 1.0) != (logged_decision.time() <= 1.0) => own.time <= 1.0,
            _ => logged_decision.collides(),
        };
        // A decision that is counted as wrong is not also counted as borderline.
        if decision.collides() != is_expected && self.judgment.total() == findings {
            self.judgment.add_borderline(self.pass, pair, decision.collides());
        }
        if self.sensitivity.is_some() && self.is_hybrid() && self.is_borderline(call) {
            self.borderline_calls.push(call);
        }
        decision
    }

    /// Returns the decision about a call whose logged polynomials exclude an impact, and for which the reference's own
    /// polynomials, without losses, give the decision `own_decision`.
    pub(super) fn resolve_dispute(&mut self, pair: Pair, own_decision: Decision) -> Decision {
        let Decision::Hit { time, .. } = own_decision else { return own_decision };
        self.call.own = Some(ReferenceImpact { time, has_losses: false });
        if self.searchable_polynomials(self.call_place(pair).index, pair.kind.polynomial_count()).is_none() {
            return own_decision;
        }
        (self.call.is_disputed, self.has_disputes) = (true, true);
        if self.prefers_own { own_decision } else { Decision::Miss { time: ImpactTime::Excluded } }
    }

    /// Reports a decision or a time of impact that is different because of lost coefficients. Its cause is the
    /// program's factor, not round-off. With some factors the library keeps coefficients that it drops from the
    /// reference's polynomials; then nothing is lost, and the reference's decision is not used.
    fn report_losses(&mut self, pair: Pair, logged_decision: Decision, own: ReferenceImpact) {
        if !own.has_losses {
            return;
        }
        let Some((motion, expected)) = &self.expected_polynomials() else { return };
        let (actual, hits) = (logged_decision.time(), own.time <= 1.0);
        if (actual <= 1.0) != hits {
            if contact::certain_decision(motion, expected) == Some(hits) {
                let place = self.call_place(pair);
                self.add_finding(FindingDetail::TrimmedDecision { place, collides: hits });
            }
        } else if hits && !contact::is_right_time_without_losses(expected, own.time, actual) {
            let (place, expected) = (self.call_place(pair), contact::possible_time(expected));
            self.add_finding(FindingDetail::TrimmedTime { place, expected, actual });
        }
    }

    /// Returns the opposite of a decision that round-off may change.
    fn reverse_decision(&self, decision: Decision) -> Decision {
        match decision {
            Decision::Hit { time, .. } => Decision::Miss { time: ImpactTime::Found(time) },
            Decision::Miss { .. } => self.expected_polynomials().as_ref().map_or(decision, |(motion, expected)| {
                let time = contact::possible_time(expected);
                let normal = motion.normal(time);
                Decision::Hit { time, normal: Vec2::new(normal.x.value, normal.y.value) }
            }),
        }
    }

    /// Returns whether round-off may change, or has changed, the decision of a call. If right polynomials lead the root
    /// finder to a decision that differs from the reference's, the submission may have either decision.
    fn is_borderline(&self, call: usize) -> bool {
        if self.call.is_disputed {
            return true;
        }
        match &self.expected_polynomials() {
            Some((motion, expected)) => contact::is_borderline(motion, expected),
            None => self.sensitivity.is_some_and(|known| known.flipped_decisions.contains(&call)),
        }
    }

    /// Returns the pair's first logged impulse that no decision has used yet, and marks it as used. Returns `None` if
    /// there is none.
    fn logged_impulse(&mut self, pair: Pair) -> Option<LoggedImpulse> {
        let index = self.contacts.indices_of(pair_key(pair)?).find(|index| !self.used_impulses[*index])?;
        self.used_impulses[index] = true;
        Some(self.records.end.impulses[index])
    }

    /// Compares the logged decision about a pair with the decision `own`. Returns the logged one, unless no response
    /// can be computed from it.
    fn follow(&mut self, pair: Pair, own: Decision) -> Decision {
        let call = self.decisions.len();
        let logged = self.logged_impulse(pair);
        match (own, logged) {
            (Decision::Miss { .. }, None) => own,
            (Decision::Hit { time, normal }, Some(actual)) => {
                let own = Impulse { pair, normal, time };
                let expected = self.expected_polynomials();
                let finding =
                    contact::compare_hit(self.records.before, expected.as_ref(), own, &actual, &mut self.judgment);
                finding.into_iter().for_each(|detail| self.add_finding(detail));
                contact::logged_decision(actual).unwrap_or(Decision::Hit { time, normal })
            }
            (Decision::Hit { time, normal }, None) => {
                if !self.is_borderline(call) {
                    self.add_finding(FindingDetail::MissedCollision { expected: Impulse { pair, normal, time } });
                }
                Decision::Miss { time: ImpactTime::Found(time) }
            }
            (Decision::Miss { .. }, Some(actual)) => {
                if self.is_borderline(call) {
                    // Round-off may change whether the pair collides, but not the normal and the time of the collision.
                    let (expected, step_judgment) = (self.expected_polynomials(), &mut self.judgment);
                    let finding = contact::compare_possible_hit(
                        self.context,
                        &self.records,
                        expected.as_ref(),
                        pair,
                        &actual,
                        step_judgment,
                    );
                    finding.into_iter().for_each(|detail| self.add_finding(detail));
                } else {
                    self.add_finding(FindingDetail::SuperfluousCollision { actual });
                }
                contact::logged_decision(actual).unwrap_or(own)
            }
        }
    }

    /// Adds a finding for each logged impulse that no decision has used.
    pub(super) fn count_unused_impulses(&mut self) {
        for index in 0..self.used_impulses.len() {
            if self.used_impulses[index] {
                continue;
            }
            let actual = self.records.end.impulses[index];
            let repeats = self.contacts.indices_of(logged_key(&actual)).next() < Some(index);
            let detail = if repeats && !self.is_hybrid() {
                FindingDetail::RepeatedCollision { actual }
            } else {
                FindingDetail::SuperfluousCollision { actual }
            };
            self.add_finding(detail);
        }
    }
}
