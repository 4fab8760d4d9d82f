//! Observers receive every detection call, pass, impulse and zone during a simulation, and may change the values with
//! which a step continues.
use super::{pair::Pair, polynomial_bytes::PolynomialBytes, state::State};
use fosssim_num::{polynomial::Polynomial, vector::Vec2};
use serde::{Deserialize, Serialize};

/// Receives the events inside a step. Every method does nothing by default.
///
/// The order within one step is as follows. `begin_step` comes first. For collision types with a handler, each
/// detection pass then calls `begin_pass`, `observe_positions`, `observe_detection` for each pair, and `end_pass`. In
/// `simple` and `continuous-time`, `observe_impulse` directly follows the detection that caused the impulse; in
/// `hybrid`, the impulses of a pass follow its `end_pass`. `observe_synchronization` comes at the end of the handler in
/// `continuous-time`, and after the impulses in `hybrid`. The geometric part begins with a detection pass. Each round
/// then calls `observe_failsafe` for each zone, and makes the next pass. `observe_zones` follows each merge. `end_step`
/// comes last.
///
/// An observer itself changes nothing. It returns a [`StepController`] to continue the step with other values.
pub trait Observer {
    /// Observes the start of a step; steps count from 1.
    fn begin_step(&mut self, _step: u32) {}
    /// Observes the start of a detection pass.
    fn begin_pass(&mut self, _pass: Pass) {}
    /// Observes the start and end positions of particles (2N each) for the pass, right after `begin_pass`.
    fn observe_positions(&mut self, _q_start: &[f64], _q_end: &[f64]) {}
    /// Returns the pairs whose detections this observer needs; called at least once in each pass. Unless the answer is
    /// [`WantedPairs::Calls`], `observe_detection` is not called, the controller does not receive single calls, and
    /// pairs are computed many at a time.
    #[inline]
    fn wanted_pairs(&mut self) -> WantedPairs<'_> {
        WantedPairs::Calls
    }
    /// Returns the controller of the step, if this observer has one.
    #[inline]
    fn as_controller(&mut self) -> Option<&mut dyn StepController> {
        None
    }
    /// Observes the test of a pair.
    fn observe_detection(&mut self, _detection: &Detection<'_>) {}
    /// Observes a pair that collides, right after its detection, which some observers do not request.
    fn observe_hit(&mut self, _pair: Pair) {}
    /// Observes the end of a pass in which `hits` pairs collide.
    fn end_pass(&mut self, _pass: Pass, _hits: usize) {}
    /// Observes an applied response.
    fn observe_impulse(&mut self, _impulse: &Impulse) {}
    /// Observes the synchronization point with the state of the mid record, before the state may be replaced.
    fn observe_synchronization(&mut self, _state: &State) {}
    /// Observes the impact zones after the merge of geometric round `round` (0: before the first failsafe).
    fn observe_zones(&mut self, _round: u32, _zones: &[Zone<'_>]) {}
    /// Observes a zone before the rigid failsafe moves it.
    fn observe_failsafe(&mut self, _round: u32, _zone: &Zone<'_>) {}
    /// Observes the end of a step with its state.
    fn end_step(&mut self, _step: u32, _state: &State) {}
}

/// Changes values during a step, which continues with the changed values. By default the methods change nothing.
pub trait StepController {
    /// Receives the trimmed polynomials of a pair before the search for a time of impact. They may be replaced; search,
    /// decision and [`Observer::observe_detection`] then use the replacements. `simple` does not call this method,
    /// because it has no polynomials.
    fn adjust_polynomials(&mut self, _pair: Pair, _q_start: &[f64], _q_end: &[f64], _polynomials: &mut [Polynomial]) {}
    /// Receives the system matrix of an implicit integrator, column by column, before each solve of a step. The step
    /// continues with the modified entries.
    fn observe_system(&mut self, _matrix: &mut [f64]) {}
    /// Returns the decision about a pair with which the step continues.
    fn adjust_decision(&mut self, _pair: Pair, decision: Decision) -> Decision {
        decision
    }
    /// Receives the synchronization point, after [`Observer::observe_synchronization`]. The step continues with the
    /// values written here; the returned value selects the state from which the geometric part of `hybrid` starts.
    fn choose_resume_state(&mut self, _state: &mut State) -> ResumeState {
        ResumeState::Own
    }
}

/// An observer that only changes values of a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct SteeringObserver<S>(pub S);

impl<S: StepController> Observer for SteeringObserver<S> {
    fn as_controller(&mut self) -> Option<&mut dyn StepController> {
        Some(&mut self.0)
    }
}

/// Passes the state of the synchronization point to an observer, and lets it change the state.
pub(super) fn pass_on_synchronization<O: Observer>(observer: &mut O, state: &mut State) -> ResumeState {
    observer.observe_synchronization(state);
    observer.as_controller().map_or(ResumeState::Own, |steer| steer.choose_resume_state(state))
}

/// The pairs of a detection pass that an observer needs.
#[derive(Debug)]
pub enum WantedPairs<'a> {
    /// The observer needs every call individually.
    Calls,
    /// The polynomials in the form of a trace, to be appended here.
    Bytes(&'a mut PolynomialBytes),
    /// The observer needs no pairs.
    Nothing,
}

/// The observer that ignores all events.
impl Observer for () {
    #[inline]
    fn wanted_pairs(&mut self) -> WantedPairs<'_> {
        WantedPairs::Nothing
    }
}

/// Forwards every event to the given observers in their order.
macro_rules! forward_all {
    ($self:ident => $($to:expr),+) => {
        fn begin_step(&mut $self, step: u32) { $($to.begin_step(step);)+ }
        fn begin_pass(&mut $self, pass: Pass) { $($to.begin_pass(pass);)+ }
        fn observe_positions(&mut $self, q_start: &[f64], q_end: &[f64]) { $($to.observe_positions(q_start, q_end);)+ }
        fn observe_detection(&mut $self, detection: &Detection<'_>) { $($to.observe_detection(detection);)+ }
        fn observe_hit(&mut $self, pair: Pair) { $($to.observe_hit(pair);)+ }
        fn end_pass(&mut $self, pass: Pass, hits: usize) { $($to.end_pass(pass, hits);)+ }
        fn observe_impulse(&mut $self, impulse: &Impulse) { $($to.observe_impulse(impulse);)+ }
        fn observe_synchronization(&mut $self, state: &State) { $($to.observe_synchronization(state);)+ }
        fn observe_zones(&mut $self, round: u32, zones: &[Zone<'_>]) { $($to.observe_zones(round, zones);)+ }
        fn observe_failsafe(&mut $self, round: u32, zone: &Zone<'_>) { $($to.observe_failsafe(round, zone);)+ }
        fn end_step(&mut $self, step: u32, state: &State) { $($to.end_step(step, state);)+ }
    };
}

/// A borrowed observer receives every event of the observer that it borrows.
impl<O: Observer + ?Sized> Observer for &mut O {
    forward_all!(self => (**self));
    #[inline]
    fn wanted_pairs(&mut self) -> WantedPairs<'_> {
        (**self).wanted_pairs()
    }
    #[inline]
    fn as_controller(&mut self) -> Option<&mut dyn StepController> {
        (**self).as_controller()
    }
}

/// Two observers receive the same events, the first one first.
impl<A: Observer, B: Observer> Observer for (A, B) {
    forward_all!(self => self.0, self.1);
    /// Returns the needs of one observer if the other needs nothing, and every call otherwise.
    fn wanted_pairs(&mut self) -> WantedPairs<'_> {
        if matches!(self.1.wanted_pairs(), WantedPairs::Nothing) {
            self.0.wanted_pairs()
        } else if matches!(self.0.wanted_pairs(), WantedPairs::Nothing) {
            self.1.wanted_pairs()
        } else {
            WantedPairs::Calls
        }
    }
    fn as_controller(&mut self) -> Option<&mut dyn StepController> {
        Some(self)
    }
}

/// The second observer receives the state as the first one sets it. The geometric part starts from the synchronized
/// state if one of them requests it.
impl<A: Observer, B: Observer> StepController for (A, B) {
    fn adjust_polynomials(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], polynomials: &mut [Polynomial]) {
        let both = [self.0.as_controller(), self.1.as_controller()].into_iter().flatten();
        both.for_each(|steer| steer.adjust_polynomials(pair, q_start, q_end, polynomials));
    }
    fn adjust_decision(&mut self, pair: Pair, decision: Decision) -> Decision {
        let both = [self.0.as_controller(), self.1.as_controller()].into_iter().flatten();
        both.fold(decision, |decision, steer| steer.adjust_decision(pair, decision))
    }
    fn choose_resume_state(&mut self, state: &mut State) -> ResumeState {
        let both = [self.0.as_controller(), self.1.as_controller()].into_iter().flatten();
        both.fold(ResumeState::Own, |resume, steer| match steer.choose_resume_state(state) {
            ResumeState::Own => resume,
            ResumeState::Synchronized => ResumeState::Synchronized,
        })
    }
}

/// The state from which the geometric part of `hybrid` starts, after the synchronization point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResumeState {
    /// The simulator's own values, as in the original's grading (collisions.md 5.4).
    Own,
    /// The state that an observer has set.
    Synchronized,
}

/// One detection pass over all pairs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(from = "PassForm", into = "PassForm")]
pub struct Pass {
    /// The part of the handling to which the pass belongs.
    pub stage: Stage,
    /// The number of the pass within the step, from 0.
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
        /// The number of the round.
        round: u32,
    },
    /// A pass of the geometric part of `hybrid`; pass 0 builds the first zones.
    Geometric {
        /// The number of the round.
        round: u32,
    },
}

/// A pass in its serialized form. The round is 0 in stages with one pass.
#[derive(Serialize, Deserialize, schemars::JsonSchema)]
struct PassForm {
    /// The number of the pass within the step, from 0.
    index: u32,
    /// The part of collision handling to which the pass belongs.
    stage: StageName,
    /// The round within the stage, from 0.
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
    /// The pass of the call.
    pub pass: Pass,
    /// The pair that is tested.
    pub pair: Pair,
    /// The polynomials as logged, in the order of the trace; empty for `simple`.
    pub polynomials: &'a [Polynomial],
    /// The decision about the pair.
    pub decision: Decision,
    /// The positions at the start of the step, 2N.
    pub q_start: &'a [f64],
    /// The current positions at the end of the step in this pass, 2N.
    pub q_end: &'a [f64],
    /// The current velocities in this call, 2N; empty if detection uses polynomials.
    pub velocities: &'a [f64],
}

/// The result of a detection call.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Decision {
    /// The objects collide at `time` (fraction of the step) with contact normal `normal`, from the first object to the
    /// second.
    Hit {
        /// The time of impact in [0, 1], or 0 for `simple`.
        time: f64,
        /// The contact normal, not normalized.
        normal: Vec2,
    },
    /// The objects do not collide within the step.
    Miss {
        /// The information about the time of impact.
        time: ImpactTime,
    },
}

impl Decision {
    /// Returns whether the pair collides within the step.
    pub const fn collides(self) -> bool {
        matches!(self, Self::Hit { .. })
    }

    /// Returns the time of impact. It is infinite if there is none, or if there was no search for it.
    pub const fn time(self) -> f64 {
        match self {
            Self::Hit { time, .. } | Self::Miss { time: ImpactTime::Found(time) } => time,
            Self::Miss { .. } => f64::INFINITY,
        }
    }
}

/// The information about the time of a pair that does not collide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ImpactTime {
    /// The search for the time was skipped, because a certificate proves that it is not within the step.
    Excluded,
    /// The search found this time (greater than 1 or infinite, or at most 1 with a zero normal).
    Found(f64),
    /// No times exist, because the handling is `simple`.
    None,
}

/// An applied response. In `simple` and `continuous-time` the trace logs it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Impulse {
    /// The pair that collides.
    pub pair: Pair,
    /// The contact normal, not normalized.
    #[serde(with = "fosssim_num::number_serde")]
    pub normal: Vec2,
    /// The time of impact as a fraction of the step.
    #[serde(with = "fosssim_num::number_serde")]
    pub time: f64,
}

/// An impact zone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Zone<'a> {
    /// The zone's particles, ascending.
    pub particles: &'a [u32],
    /// Whether a half-plane is part of the zone.
    pub half_plane: bool,
}
