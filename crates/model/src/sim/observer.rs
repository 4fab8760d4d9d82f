//! Observers receive every detection call, pass, impulse and zone while the simulator computes, and may steer a step.
use super::{pair::Pair, polynomial_bytes::PolynomialBytes, state::State};
use fosssim_num::{polynomial::Polynomial, vector::Vec2};
use serde::{Deserialize, Serialize};

/// Receives the events inside a step. Every method does nothing by default.
///
/// Order within one step: `begin_step`; then, for collision types with a handler, per detection pass `begin_pass`, a
/// `detection` per pair (and, for `simple` and `continuous-time`, an `impulse` right after the detection that caused
/// it), `end_pass`; for `hybrid` the pass's `impulse`s follow its `end_pass`. Then `synchronization` (continuous-time:
/// at the end of the handler; hybrid: after the impulses, before the geometric part). In the geometric part:
/// `begin_pass` .. `end_pass`, then per round a `failsafe` per zone and the next pass; `zones` after each merge. Last
/// `end_step`.
///
/// An observer changes nothing. To continue the step with other values, it returns a [`Steer`].
pub trait Observer {
    /// Receives the begin of a step; steps count from 1.
    fn begin_step(&mut self, _step: u32) {}
    /// Receives the begin of a detection pass.
    fn begin_pass(&mut self, _pass: Pass) {}
    /// Receives the starts and ends of particles (2N each) as the pass begins to see them, right after `begin_pass`.
    fn pass_positions(&mut self, _q_start: &[f64], _q_end: &[f64]) {}
    /// Returns the wishes of this observer about the pass's pairs; called once or more in each pass. Unless it wants
    /// [`WantedPairs::Calls`], `detection` is not called, calls are not steered, and pairs are computed many at a time.
    #[inline]
    fn wanted_pairs(&mut self) -> WantedPairs<'_> {
        WantedPairs::Calls
    }
    /// Returns the steering part of this observer, if it has one.
    #[inline]
    fn steers(&mut self) -> Option<&mut dyn Steer> {
        None
    }
    /// Receives the test of a pair.
    fn detection(&mut self, _detection: &Detection<'_>) {}
    /// Receives a pair that collides: right after its `detection`, which not every observer wants.
    fn hit(&mut self, _pair: Pair) {}
    /// Receives the end of the pass, in which `hits` pairs collide.
    fn end_pass(&mut self, _pass: Pass, _hits: usize) {}
    /// Receives a response that was applied.
    fn impulse(&mut self, _impulse: &Impulse) {}
    /// Receives the synchronization point: the state of the mid record, before it may be replaced.
    fn synchronization(&mut self, _state: &State) {}
    /// Receives the impact zones after the merge of geometric round `round` (0: before the first failsafe).
    fn zones(&mut self, _round: u32, _zones: &[Zone<'_>]) {}
    /// Receives a zone that the rigid failsafe is about to move.
    fn failsafe(&mut self, _round: u32, _zone: &Zone<'_>) {}
    /// Receives the end of the step, with this state.
    fn end_step(&mut self, _step: u32, _state: &State) {}
}

/// Steers a step: the step continues with the values that it sets. Every method changes nothing by default.
pub trait Steer {
    /// Returns the polynomials of a pair, trimmed, are about to be searched for a time of impact. Others may be put in
    /// their place; search, decision and [`Observer::detection`] then go by those. Not called by `simple`, which has
    /// none.
    fn solve(&mut self, _pair: Pair, _q_start: &[f64], _q_end: &[f64], _polynomials: &mut [Polynomial]) {}
    /// Receives the system matrix of an implicit integrator, column by column, before it is solved; once for each solve
    /// of a step. The step continues with the entries that it leaves.
    fn system(&mut self, _matrix: &mut [f64]) {}
    /// Returns the decision about a pair, with which the step continues.
    fn decide(&mut self, _pair: Pair, decision: Decision) -> Decision {
        decision
    }
    /// Receives the synchronization point, after [`Observer::synchronization`]. The step continues with the values that
    /// are written here; the geometric part of `hybrid` starts from the values that the answer names.
    fn synchronize(&mut self, _state: &mut State) -> Resume {
        Resume::Own
    }
}

/// The observer that only steers.
#[derive(Debug, Clone, Copy, Default)]
pub struct Steering<S>(pub S);

impl<S: Steer> Observer for Steering<S> {
    fn steers(&mut self) -> Option<&mut dyn Steer> {
        Some(&mut self.0)
    }
}

/// Passes the state of the synchronization point to an observer, and lets it steer.
pub(super) fn synchronize<O: Observer>(observer: &mut O, state: &mut State) -> Resume {
    observer.synchronization(state);
    observer.steers().map_or(Resume::Own, |steer| steer.synchronize(state))
}

/// The wishes of an observer about the pairs of a detection pass.
#[derive(Debug)]
pub enum WantedPairs<'a> {
    /// Every call, one by one.
    Calls,
    /// The polynomials as a trace holds them, to be appended here.
    Bytes(&'a mut PolynomialBytes),
    /// Nothing.
    Nothing,
}

/// The observer that ignores all events.
impl Observer for () {
    #[inline]
    fn wanted_pairs(&mut self) -> WantedPairs<'_> {
        WantedPairs::Nothing
    }
}

/// Forwards every event to these observers, one after the other.
macro_rules! go_on {
    ($self:ident => $($to:expr),+) => {
        fn begin_step(&mut $self, step: u32) { $($to.begin_step(step);)+ }
        fn begin_pass(&mut $self, pass: Pass) { $($to.begin_pass(pass);)+ }
        fn pass_positions(&mut $self, q_start: &[f64], q_end: &[f64]) { $($to.pass_positions(q_start, q_end);)+ }
        fn detection(&mut $self, detection: &Detection<'_>) { $($to.detection(detection);)+ }
        fn hit(&mut $self, pair: Pair) { $($to.hit(pair);)+ }
        fn end_pass(&mut $self, pass: Pass, hits: usize) { $($to.end_pass(pass, hits);)+ }
        fn impulse(&mut $self, impulse: &Impulse) { $($to.impulse(impulse);)+ }
        fn synchronization(&mut $self, state: &State) { $($to.synchronization(state);)+ }
        fn zones(&mut $self, round: u32, zones: &[Zone<'_>]) { $($to.zones(round, zones);)+ }
        fn failsafe(&mut $self, round: u32, zone: &Zone<'_>) { $($to.failsafe(round, zone);)+ }
        fn end_step(&mut $self, step: u32, state: &State) { $($to.end_step(step, state);)+ }
    };
}

/// A borrowed observer receives the same.
impl<O: Observer + ?Sized> Observer for &mut O {
    go_on!(self => (**self));
    #[inline]
    fn wanted_pairs(&mut self) -> WantedPairs<'_> {
        (**self).wanted_pairs()
    }
    #[inline]
    fn steers(&mut self) -> Option<&mut dyn Steer> {
        (**self).steers()
    }
}

/// Two observers receive the same, the first one first.
impl<A: Observer, B: Observer> Observer for (A, B) {
    go_on!(self => self.0, self.1);
    /// Returns the wish of one observer, if the other wants nothing.
    fn wanted_pairs(&mut self) -> WantedPairs<'_> {
        if matches!(self.1.wanted_pairs(), WantedPairs::Nothing) {
            self.0.wanted_pairs()
        } else if matches!(self.0.wanted_pairs(), WantedPairs::Nothing) {
            self.1.wanted_pairs()
        } else {
            WantedPairs::Calls
        }
    }
    fn steers(&mut self) -> Option<&mut dyn Steer> {
        Some(self)
    }
}

/// The second observer sees a state that the first one sets. The geometric part starts from the synchronized state if
/// one of them requests it.
impl<A: Observer, B: Observer> Steer for (A, B) {
    fn solve(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], polynomials: &mut [Polynomial]) {
        let both = [self.0.steers(), self.1.steers()].into_iter().flatten();
        both.for_each(|steer| steer.solve(pair, q_start, q_end, polynomials));
    }
    fn decide(&mut self, pair: Pair, decision: Decision) -> Decision {
        let both = [self.0.steers(), self.1.steers()].into_iter().flatten();
        both.fold(decision, |decision, steer| steer.decide(pair, decision))
    }
    fn synchronize(&mut self, state: &mut State) -> Resume {
        let both = [self.0.steers(), self.1.steers()].into_iter().flatten();
        both.fold(Resume::Own, |resume, steer| match steer.synchronize(state) {
            Resume::Own => resume,
            Resume::Synchronized => Resume::Synchronized,
        })
    }
}

/// The state from which the geometric part of `hybrid` starts, after the synchronization point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resume {
    /// The simulator's own values, as the original grades (collisions.md 5.4).
    Own,
    /// The state that was put in place.
    Synchronized,
}

/// One detection pass over all pairs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(from = "PassForm", into = "PassForm")]
pub struct Pass {
    /// The part of the handling that makes the call.
    pub stage: Stage,
    /// Number of the pass within the step, from 0.
    pub index: u32,
}

/// The part of collision handling to which a detection pass belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The only pass of `simple`.
    Simple,
    /// The only pass of `continuous-time`.
    ContinuousTime,
    /// An impulse round of `hybrid`, from 0.
    Impulses {
        /// The round.
        round: u32,
    },
    /// A pass of the geometric part of `hybrid`: 0 builds the first zones.
    Geometric {
        /// The round.
        round: u32,
    },
}

/// A pass in its serialized form: the round is 0 in stages that have one pass.
#[derive(Serialize, Deserialize, schemars::JsonSchema)]
struct PassForm {
    /// Number of the pass within the step, from 0.
    index: u32,
    /// The part of collision handling that makes the call.
    stage: StageName,
    /// Round within the stage, from 0.
    round: u32,
}

#[derive(Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum StageName {
    Simple,
    ContinuousTime,
    Impulses,
    Geometric,
}

impl From<Pass> for PassForm {
    fn from(Pass { stage, index }: Pass) -> Self {
        let (stage, round) = match stage {
            Stage::Simple => (StageName::Simple, 0),
            Stage::ContinuousTime => (StageName::ContinuousTime, 0),
            Stage::Impulses { round } => (StageName::Impulses, round),
            Stage::Geometric { round } => (StageName::Geometric, round),
        };
        Self { index, stage, round }
    }
}

impl From<PassForm> for Pass {
    fn from(PassForm { index, stage, round }: PassForm) -> Self {
        let stage = match stage {
            StageName::Simple => Stage::Simple,
            StageName::ContinuousTime => Stage::ContinuousTime,
            StageName::Impulses => Stage::Impulses { round },
            StageName::Geometric => Stage::Geometric { round },
        };
        Self { stage, index }
    }
}

/// The inputs and the decision of one detection call.
#[derive(Debug, Clone, Copy)]
pub struct Detection<'a> {
    /// The pass.
    pub pass: Pass,
    /// The pair.
    pub pair: Pair,
    /// The polynomials as logged, in the order of the trace; empty for `simple`.
    pub polynomials: &'a [Polynomial],
    /// The decision.
    pub decision: Decision,
    /// Positions at the start of the step, 2N.
    pub q_start: &'a [f64],
    /// Positions at the end of the step as this pass sees them, 2N.
    pub q_end: &'a [f64],
    /// Velocities as this call sees them, 2N; empty if detection uses polynomials.
    pub velocities: &'a [f64],
}

/// The result of a detection call.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Decision {
    /// The objects collide at `time` (fraction of the step) with contact normal `normal`, from the first object to the
    /// second.
    Hit {
        /// Time of impact in [0, 1]; 0 for `simple`.
        time: f64,
        /// Contact normal, not normalized.
        normal: Vec2,
    },
    /// The objects do not collide within the step.
    Miss {
        /// The knowledge of the time.
        time: Time,
    },
}

impl Decision {
    /// Returns whether the pair collides within the step.
    #[must_use]
    pub const fn collides(self) -> bool {
        matches!(self, Self::Hit { .. })
    }

    /// Returns the time that was found; infinite if there is none, or none was searched.
    #[must_use]
    pub const fn time(self) -> f64 {
        match self {
            Self::Hit { time, .. } | Self::Miss { time: Time::Found(time) } => time,
            Self::Miss { .. } => f64::INFINITY,
        }
    }
}

/// The knowledge of the time of a pair that does not collide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Time {
    /// Nothing was searched: a certificate proves that it is not within the step.
    Excluded,
    /// The search gave this time (greater than 1, infinite; or at most 1 with a zero normal).
    Found(f64),
    /// `simple` knows no times.
    None,
}

/// An applied response; in `simple` and `continuous-time` the trace logs it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Impulse {
    /// The pair.
    pub pair: Pair,
    /// Contact normal, not normalized.
    #[serde(with = "fosssim_num::written")]
    pub normal: Vec2,
    /// Time of impact as a fraction of the step.
    #[serde(with = "fosssim_num::written")]
    pub time: f64,
}

/// An impact zone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Zone<'a> {
    /// The zone's particles, ascending.
    pub particles: &'a [u32],
    /// Whether a half-plane is part of it.
    pub half_plane: bool,
}
