//! Inspects one step in detail: every detection pass, contact and zone, and the calls of findings.
use crate::polynomial_matching::{are_different, match_polynomials};
use fosssim_judge::study::{EndlessSearch, Study};
use fosssim_model::{
    scene::Scene,
    sim::{Decision, Detection, Impulse, Observer, Pair, PairMotion, Pass, ResumeState, State, StepController, Zone},
    trace::{LoggedImpulse, PolynomialLog},
};

/// The maximum number of kept passes of a step, and of numbers in their positions. In large scenes, fewer passes are
/// kept.
const MAX_PASSES: usize = 24;
const MAX_POSITIONS: usize = 12_000;
/// The maximum number of kept pairs of a pass, for each of differing, missing and repeated ones.
const MAX_PAIRS: usize = 256;
/// The maximum number of kept calls of a step. Calls are kept in case the trace has logged a different number of
/// polynomials.
const MAX_CALLS: usize = 1 << 14;
/// The maximum number of wrong or missing calls that are shown without a finding.
const MAX_SHOWN_CALLS: usize = 2;

/// A detection pass of the reference.
#[derive(Debug, Clone, PartialEq)]
pub struct InspectedPass {
    /// The detection pass.
    pub pass: Pass,
    /// The positions at the end of the motion that the pass checks.
    pub q_end: Vec<f64>,
    /// The number of pairs that the pass checks.
    pub calls: usize,
    /// The collisions that the pass finds.
    pub hits: Vec<Impulse>,
    /// The first pairs whose logged polynomials differ by more than a factor.
    pub differing_pairs: Vec<Pair>,
    /// The first pairs without logged polynomials.
    pub missing_pairs: Vec<Pair>,
    /// The first pairs whose polynomials are logged twice.
    pub repeated_pairs: Vec<Pair>,
    /// Whether the trace's polynomials of this pass are known.
    pub is_logged: bool,
}

/// The impact zones after one merge.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MergedZones {
    /// The number of the geometric round, or 0 before the first failsafe.
    pub round: u32,
    /// The particles of each zone, and whether it contains a half-plane.
    pub zones: Vec<(Vec<u32>, bool)>,
}

/// The trace's log of a call.
#[derive(Debug, Clone, PartialEq)]
pub enum CallLog {
    /// The logged polynomials in the order of the reference's, each with the highest power first. A missing polynomial
    /// is empty.
    Polynomials(Vec<Vec<f64>>),
    /// The trace has logged no polynomials of the call.
    Nothing,
    /// The call's polynomials are unknown.
    Unknown,
}

/// A detection call in detail.
#[derive(Debug, Clone, PartialEq)]
pub struct InspectedCall {
    /// The pass of the call.
    pub pass: Pass,
    /// The pair of the call.
    pub pair: Pair,
    /// The reference's own computation of the call.
    pub study: Result<Study, EndlessSearch>,
    /// The number of polynomials that the reference logs for the call, or 0 without continuous-time detection.
    pub polynomials: usize,
    /// The trace's log of the call.
    pub logged: CallLog,
}

/// One step in detail.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct InspectedStep {
    /// The step, from 1.
    pub step: u32,
    /// The expected mid record, given the state that the step starts from.
    pub expected_mid: Option<State>,
    /// The expected end record, given the trace's own mid record, or `None` if the step has no result.
    pub expected_end: Option<State>,
    /// The first detection passes of the reference.
    pub passes: Vec<InspectedPass>,
    /// The number of the reference's passes.
    pub expected_passes: usize,
    /// The number of polynomials that the reference logs.
    pub expected_polynomials: usize,
    /// The number of polynomials that the trace has logged.
    pub actual_polynomials: usize,
    /// The number of logged polynomials without a call of the reference, or `None` if unknown.
    pub surplus_polynomials: Option<usize>,
    /// The responses of the reference.
    pub expected_contacts: Vec<Impulse>,
    /// The impulse list of the trace.
    pub actual_contacts: Vec<LoggedImpulse>,
    /// The impact zones after each merge.
    pub zones: Vec<MergedZones>,
    /// The calls of findings, and several other wrong or missing calls.
    pub calls: Vec<InspectedCall>,
}

/// The selection of a pair's calls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum WantedCalls {
    /// The calls of the pair that find a collision.
    Hits,
    /// The call of the pair in one pass.
    InPass(Pass),
    /// All calls of the pair in the step.
    Every,
}

/// A call of the reference, kept in case the trace's list must be matched.
struct ReferenceCall {
    pass: Pass,
    /// The number of the pass in the step.
    number: usize,
    pair: Pair,
    motion: PairMotion,
    first: usize,
    count: usize,
}

/// An observer of one reference step that keeps its details.
pub(crate) struct Inspector<'a> {
    scene: &'a Scene,
    /// The trace's mid record, with which the step continues.
    mid: Option<&'a State>,
    log: Option<&'a PolynomialLog>,
    wanted_calls: &'a [(WantedCalls, Pair)],
    pass: Option<Pass>,
    /// The calls and their polynomials, at most [`MAX_CALLS`].
    reference_calls: Vec<ReferenceCall>,
    right_polynomials: PolynomialLog,
    /// The number in the step of each inspected call, and the index of its first polynomial.
    polynomial_places: Vec<(usize, usize)>,
    /// The number of calls so far.
    calls: usize,
    pub(crate) step: InspectedStep,
}

impl<'a> Inspector<'a> {
    /// Creates the inspector before the step begins. `log` contains the first of the trace's `logged` polynomials in
    /// this step.
    pub(crate) fn new(
        scene: &'a Scene,
        step: u32,
        mid: Option<&'a State>,
        (log, logged): (&'a PolynomialLog, usize),
        wanted: &'a [(WantedCalls, Pair)],
    ) -> Self {
        let step = InspectedStep { step, actual_polynomials: logged, ..InspectedStep::default() };
        // A call whose polynomials were not kept must not look as if they were missing.
        let log = (log.len() == logged && logged > 0).then_some(log);
        let right_polynomials = PolynomialLog::default();
        Self {
            scene,
            mid,
            log,
            wanted_calls: wanted,
            pass: None,
            reference_calls: Vec::new(),
            right_polynomials,
            polynomial_places: Vec::new(),
            calls: 0,
            step,
        }
    }

    fn max_passes(&self) -> usize {
        (MAX_POSITIONS / (2 * self.scene.particles.len()).max(1)).clamp(1, MAX_PASSES)
    }

    /// Returns the inspected step, with the trace's log of each call.
    pub(crate) fn finish(mut self) -> InspectedStep {
        let (expected, actual) = (self.step.expected_polynomials, self.step.actual_polynomials);
        if expected == actual {
            self.step.surplus_polynomials = Some(0);
            for (call, &(_, first)) in self.step.calls.iter_mut().zip(&self.polynomial_places) {
                call.logged = find_log_by_order(self.log, expected, first, call.polynomials);
            }
        } else if self.calls == self.reference_calls.len() {
            match self.log {
                Some(log) => self.assign(log),
                // An empty list can be assigned without any doubt.
                None if actual == 0 => self.assign(&PolynomialLog::default()),
                None => {}
            }
        }
        self.inspect_more_calls();
        self.step
    }

    /// Assigns the polynomials to calls if the trace has a different number of polynomials than the reference.
    fn assign(&mut self, log: &PolynomialLog) {
        let Some(found) = match_polynomials(&self.right_polynomials, log) else { return };
        let mut is_claimed = vec![false; log.len()];
        found.iter().flatten().for_each(|&index| is_claimed[index] = true);
        for pass in &mut self.step.passes {
            pass.differing_pairs.clear();
            pass.is_logged = true;
        }
        let mut fates: Vec<CallLog> = Vec::with_capacity(self.reference_calls.len());
        for call in &self.reference_calls {
            let indices = &found[call.first..call.first + call.count];
            let fate = if indices.iter().all(Option::is_none) {
                CallLog::Nothing
            } else {
                CallLog::Polynomials(
                    indices.iter().map(|index| index.map_or_else(Vec::new, |at| log.get(at).to_vec())).collect(),
                )
            };
            if let Some(pass) = self.step.passes.get_mut(call.number) {
                let is_wrong = |list: &[Vec<f64>]| {
                    list.iter()
                        .zip(call.first..)
                        .any(|(own, index)| own.is_empty() || are_different(own, self.right_polynomials.get(index)))
                };
                match &fate {
                    _ if call.count == 0 => {}
                    CallLog::Nothing => keep_pair(&mut pass.missing_pairs, call.pair),
                    CallLog::Polynomials(list) if is_wrong(list) => keep_pair(&mut pass.differing_pairs, call.pair),
                    _ => {}
                }
            }
            fates.push(fate);
        }
        for (call, &(number, _)) in self.step.calls.iter_mut().zip(&self.polynomial_places) {
            call.logged = fates[number].clone();
        }
        let mut surplus_count = is_claimed.iter().filter(|claimed| !**claimed).count();
        self.step.surplus_polynomials = Some(surplus_count);
        // A polynomial without a call may belong to a call that was made twice. It then follows or precedes the
        // polynomials of its pass.
        let mut index = 0;
        while index < log.len() && surplus_count > 0 {
            if is_claimed[index] {
                index += 1;
                continue;
            }
            let again = |call: &&ReferenceCall| {
                call.count > 0
                    && index + call.count <= log.len()
                    && (0..call.count).all(|k| {
                        !is_claimed[index + k]
                            && !are_different(log.get(index + k), self.right_polynomials.get(call.first + k))
                    })
            };
            let before =
                found.iter().enumerate().filter(|(_, at)| at.is_some_and(|at| at < index)).map(|(own, _)| own).max();
            let number = before.and_then(|own| self.reference_calls.iter().find(|call| call.first + call.count > own));
            let number = number.map_or(0, |call| call.number);
            match self.reference_calls.iter().filter(|call| call.number == number).find(again) {
                Some(call) => {
                    if let Some(pass) = self.step.passes.get_mut(number) {
                        keep_pair(&mut pass.repeated_pairs, call.pair);
                    }
                    index += call.count;
                    surplus_count -= call.count;
                }
                None => (index, surplus_count) = (index + 1, surplus_count - 1),
            }
        }
    }

    /// Inspects wrong or missing calls without a finding.
    fn inspect_more_calls(&mut self) {
        let Some(pass) = self
            .step
            .passes
            .iter()
            .position(|pass| !(pass.differing_pairs.is_empty() && pass.missing_pairs.is_empty()))
        else {
            return;
        };
        let up = &self.step.passes[pass];
        let wrong: Vec<Pair> =
            [up.missing_pairs.first(), up.differing_pairs.first()].into_iter().flatten().copied().collect();
        for pair in wrong.into_iter().take(MAX_SHOWN_CALLS) {
            let is_shown = |call: &InspectedCall| call.pair == pair && call.pass == self.step.passes[pass].pass;
            if self.step.calls.len() >= MAX_SHOWN_CALLS || self.step.calls.iter().any(is_shown) {
                continue;
            }
            let Some(call) = self.reference_calls.iter().find(|call| call.number == pass && call.pair == pair) else {
                continue;
            };
            let logged = if self.step.passes[pass].missing_pairs.contains(&pair) {
                CallLog::Nothing
            } else {
                find_log_by_order(self.log, self.step.expected_polynomials, call.first, call.count)
            };
            let (pass, polynomials) = (call.pass, call.count);
            self.step.calls.push(InspectedCall {
                pass,
                pair,
                study: Study::for_motion(&call.motion),
                polynomials,
                logged,
            });
        }
    }
}

/// Returns the log of a call by its position in the list; unknown if the list's length differs from the reference's.
fn find_log_by_order(log: Option<&PolynomialLog>, expected: usize, first: usize, count: usize) -> CallLog {
    match log {
        Some(log) if log.len() == expected => {
            CallLog::Polynomials((first..first + count).map(|index| log.get(index).to_vec()).collect())
        }
        _ => CallLog::Unknown,
    }
}

fn keep_pair(pairs: &mut Vec<Pair>, pair: Pair) {
    if pairs.len() < MAX_PAIRS {
        pairs.push(pair);
    }
}

impl StepController for Inspector<'_> {
    fn choose_resume_state(&mut self, state: &mut State) -> ResumeState {
        continue_from(self.mid, state)
    }
}

/// Continues a step from the trace's mid record, if the record has the scene's size.
pub(crate) fn continue_from(mid: Option<&State>, state: &mut State) -> ResumeState {
    match mid {
        Some(mid) if mid.positions.len() == state.positions.len() => {
            state.clone_from(mid);
            ResumeState::Synchronized
        }
        _ => ResumeState::Own,
    }
}

impl Observer for Inspector<'_> {
    fn begin_pass(&mut self, pass: Pass) {
        self.pass = Some(pass);
        self.step.expected_passes += 1;
        if self.step.passes.len() < self.max_passes() {
            self.step.passes.push(InspectedPass {
                pass,
                q_end: Vec::new(),
                calls: 0,
                hits: Vec::new(),
                differing_pairs: Vec::new(),
                missing_pairs: Vec::new(),
                repeated_pairs: Vec::new(),
                is_logged: self.log.is_some(),
            });
        }
    }

    fn observe_detection(&mut self, detection: &Detection<'_>) {
        let Some(pass) = self.pass else { return };
        let (first, count) = (self.step.expected_polynomials, detection.polynomials.len());
        self.step.expected_polynomials += count;
        self.calls += 1;
        let Detection { pair, q_start, q_end, decision, .. } = *detection;
        let motion = || PairMotion::from_positions(self.scene, pair, q_start, q_end);
        let is_hit = matches!(decision, Decision::Hit { .. });
        let is_wanted = self.wanted_calls.iter().any(|(wanted, wanted_pair)| {
            *wanted_pair == pair
                && match wanted {
                    WantedCalls::Hits => is_hit,
                    WantedCalls::InPass(wanted_pass) => *wanted_pass == pass,
                    WantedCalls::Every => true,
                }
        });
        if is_wanted {
            let study = Study::for_motion(&motion());
            // Only at the end of the step is it known whether the list is as long as the reference's.
            self.step.calls.push(InspectedCall { pass, pair, study, polynomials: count, logged: CallLog::Unknown });
            self.polynomial_places.push((self.calls - 1, first));
        }
        if self.reference_calls.len() < MAX_CALLS {
            let number = self.step.expected_passes - 1;
            self.reference_calls.push(ReferenceCall { pass, number, pair, motion: motion(), first, count });
            detection.polynomials.iter().for_each(|polynomial| self.right_polynomials.push(polynomial.coefficients()));
        }
        let logged = self.log.filter(|log| first + count <= log.len());
        let is_different = logged.is_some_and(|log| {
            (first..).zip(detection.polynomials).any(|(at, right)| are_different(log.get(at), right.coefficients()))
        });
        if let Some(up) = self.step.passes.last_mut().filter(|up| up.pass == pass) {
            if up.calls == 0 {
                up.q_end = q_end.to_vec();
            }
            up.calls += 1;
            up.is_logged &= logged.is_some();
            if let Decision::Hit { time, normal } = decision {
                up.hits.push(Impulse { pair, normal, time });
            }
            if is_different {
                keep_pair(&mut up.differing_pairs, pair);
            }
        }
    }

    fn observe_impulse(&mut self, impulse: &Impulse) {
        self.step.expected_contacts.push(*impulse);
    }

    fn as_controller(&mut self) -> Option<&mut dyn StepController> {
        Some(self)
    }

    fn observe_synchronization(&mut self, state: &State) {
        self.step.expected_mid = Some(state.clone());
    }

    fn observe_zones(&mut self, round: u32, zones: &[Zone<'_>]) {
        let zones = zones.iter().map(|zone| (zone.particles.to_vec(), zone.half_plane)).collect();
        self.step.zones.push(MergedZones { round, zones });
    }

    fn end_step(&mut self, _step: u32, state: &State) {
        self.step.expected_end = Some(state.clone());
    }
}
