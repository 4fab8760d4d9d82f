//! One step looked at closely: every detection pass, contact and zone, and the calls that findings are about.
use fosssim_judge::study::{NoAnswer, Study};
use fosssim_model::{
    scene::Scene,
    sim::{Decision, Detection, Impulse, Observer, Pair, PairMotion, Pass, Resume, State, Zone},
    trace::{LenientFrame, LoggedImpulse, PolynomialLog},
};

/// So many passes of a step are kept.
const PASSES: usize = 24;
/// So many pairs of a pass are kept as differing.
const DIFFERING: usize = 64;
/// Coefficients may be off by this part of their polynomial's largest one before a call is marked as differing. A mark is no
/// verdict; raised, faint differences get none.
const MARKED: f64 = 1e-9;

/// A detection pass of the reference.
#[derive(Debug, Clone, PartialEq)]
pub struct PassUp {
    /// The pass.
    pub pass: Pass,
    /// Positions at the end of the step as the pass sees them.
    pub q_end: Vec<f64>,
    /// How many pairs it looks at.
    pub calls: usize,
    /// The collisions that it finds.
    pub hits: Vec<Impulse>,
    /// Pairs for which the trace has logged other polynomials, up to a factor; the first ones.
    pub differing: Vec<Pair>,
    /// Whether the trace has logged polynomials for all its calls.
    pub is_logged: bool,
}

/// Impact zones after one merge.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Zones {
    /// The geometric round; 0 before the first failsafe.
    pub round: u32,
    /// The particles of each zone, and whether a half-plane is part of it.
    pub zones: Vec<(Vec<u32>, bool)>,
}

/// A detection call that a finding is about.
#[derive(Debug, Clone, PartialEq)]
pub struct Call {
    /// The pass.
    pub pass: Pass,
    /// The pair.
    pub pair: Pair,
    /// What the reference computes of it.
    pub study: Result<Study, NoAnswer>,
    /// What the trace has logged for it, highest power first; empty where that can't be told.
    pub logged: Vec<Vec<f64>>,
}

/// One step looked at closely.
#[derive(Debug, Clone, PartialEq)]
pub struct CloseUp {
    /// The step, from 1.
    pub step: u32,
    /// What the mid record should hold, given the state that the step starts from.
    pub expected_mid: Option<State>,
    /// What the end record should hold, given the trace's own mid record; `None` where the step has no result.
    pub expected_end: Option<State>,
    /// The reference's detection passes, the first ones.
    pub passes: Vec<PassUp>,
    /// How many passes the reference makes.
    pub expected_passes: usize,
    /// How many polynomials the reference logs.
    pub expected_polynomials: usize,
    /// How many the trace has logged.
    pub actual_polynomials: usize,
    /// The responses of the reference.
    pub expected_contacts: Vec<Impulse>,
    /// The impulse list of the trace.
    pub actual_contacts: Vec<LoggedImpulse>,
    /// Impact zones.
    pub zones: Vec<Zones>,
    /// The calls that findings are about.
    pub calls: Vec<Call>,
}

/// Listens to one step of the reference.
pub(crate) struct Watch<'a> {
    scene: &'a Scene,
    /// The trace's mid record, which the step goes on with, and its polynomials.
    mid: Option<&'a State>,
    log: Option<&'a PolynomialLog>,
    wanted: &'a [(Option<Pass>, Pair)],
    polynomials: usize,
    pass: Option<Pass>,
    pub(crate) close_up: CloseUp,
}

impl<'a> Watch<'a> {
    pub(crate) fn new(
        scene: &'a Scene,
        step: u32,
        mid: Option<&'a State>,
        end: &'a LenientFrame,
        wanted: &'a [(Option<Pass>, Pair)],
    ) -> Self {
        let close_up = CloseUp {
            step,
            expected_mid: None,
            expected_end: None,
            passes: Vec::new(),
            expected_passes: 0,
            expected_polynomials: 0,
            actual_polynomials: end.logged,
            expected_contacts: Vec::new(),
            actual_contacts: end.impulses.clone(),
            zones: Vec::new(),
            calls: Vec::new(),
        };
        let log = (!end.polynomials.is_empty()).then_some(&end.polynomials);
        Self { scene, mid, log, wanted, polynomials: 0, pass: None, close_up }
    }

    /// What the trace has logged for a call, if its list reaches that far.
    fn logged(&self, first: usize, count: usize) -> Option<impl Iterator<Item = &'a [f64]> + use<'a>> {
        let log = self.log?;
        (first + count <= log.len()).then(|| (first..first + count).map(move |index| log.get(index)))
    }
}

impl Observer for Watch<'_> {
    fn begin_pass(&mut self, pass: Pass) {
        self.pass = Some(pass);
        self.close_up.expected_passes += 1;
        if self.close_up.passes.len() < PASSES {
            let is_logged = self.log.is_some();
            let (q_end, hits, differing) = (Vec::new(), Vec::new(), Vec::new());
            self.close_up.passes.push(PassUp { pass, q_end, calls: 0, hits, differing, is_logged });
        }
    }

    fn detection(&mut self, detection: &Detection<'_>) {
        let Some(pass) = self.pass else { return };
        let first = self.polynomials;
        self.polynomials += detection.polynomials.len();
        self.close_up.expected_polynomials = self.polynomials;
        let logged = self.logged(first, detection.polynomials.len());
        let wanted = self.wanted.iter().any(|(in_pass, pair)| {
            *pair == detection.pair && in_pass.map_or(matches!(detection.decision, Decision::Hit { .. }), |p| p == pass)
        });
        if wanted {
            let motion = PairMotion::between(self.scene, detection.pair, detection.q_start, detection.q_end);
            let logged = logged.map_or_else(Vec::new, |logged| logged.map(<[f64]>::to_vec).collect());
            self.close_up.calls.push(Call { pass, pair: detection.pair, study: Study::of(&motion), logged });
        }
        let differs = match self.logged(first, detection.polynomials.len()) {
            Some(logged) => logged.zip(detection.polynomials).any(|(own, right)| differ(own, right.coefficients())),
            None => false,
        };
        let reaches = self.logged(first, detection.polynomials.len()).is_some();
        if let Some(up) = self.close_up.passes.last_mut().filter(|up| up.pass == pass) {
            if up.calls == 0 {
                up.q_end = detection.q_end.to_vec();
            }
            up.calls += 1;
            up.is_logged &= reaches;
            if let Decision::Hit { time, normal } = detection.decision {
                up.hits.push(Impulse { pair: detection.pair, normal, time });
            }
            if differs && up.differing.len() < DIFFERING {
                up.differing.push(detection.pair);
            }
        }
    }

    fn impulse(&mut self, impulse: &Impulse) {
        self.close_up.expected_contacts.push(*impulse);
    }

    fn synchronise(&mut self, state: &mut State) -> Resume {
        self.close_up.expected_mid = Some(state.clone());
        match self.mid {
            Some(mid) if mid.positions.len() == state.positions.len() => {
                state.clone_from(mid);
                Resume::Synchronised
            }
            _ => Resume::Own,
        }
    }

    fn zones(&mut self, round: u32, zones: &[Zone<'_>]) {
        let zones = zones.iter().map(|zone| (zone.particles.to_vec(), zone.half_plane)).collect();
        self.close_up.zones.push(Zones { round, zones });
    }

    fn end_step(&mut self, _step: u32, state: &State) {
        self.close_up.expected_end = Some(state.clone());
    }
}

/// Whether one polynomial is visibly no positive multiple of the other.
fn differ(own: &[f64], right: &[f64]) -> bool {
    let largest = |list: &[f64]| list.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let (most, scale) = (largest(own), largest(right));
    if scale == 0.0 || most == 0.0 || !most.is_finite() {
        return own.len() != right.len() && (most != 0.0 || scale != 0.0);
    }
    if own.len() != right.len() {
        return true;
    }
    let place = right.iter().position(|c| c.abs() == scale).unwrap_or(0);
    let factor = own[place] / right[place];
    let near = |(own, right): (&f64, &f64)| (own - factor * right).abs() <= MARKED * (factor * scale).abs();
    !(factor > 0.0 && own.iter().zip(right).all(near))
}
