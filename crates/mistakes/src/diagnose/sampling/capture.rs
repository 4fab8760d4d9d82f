//! Records the results of the reference in one step, in the form of a trace.
use super::compare::StepRecords;
use fosssim_model::{
    assignments::ImpulseList,
    scene::Collision,
    sim::{Decision, Detection, Impulse, Observer, Pair, Pass, Stage, State, Zone},
    trace::PolynomialLog,
};

/// The observer that keeps the records of a step.
#[derive(Debug, Default)]
pub struct Capture {
    /// Whether the reference's impulses are logged. `hybrid` logs none.
    logs_impulses: bool,
    has_mid: bool,
    pass: Option<Pass>,
    /// The records of the step, which are valid after the step.
    pub records: StepRecords,
    /// The pairs in the order of detection, with the pass and the index of their first polynomial.
    pub detections: Vec<(Pair, Pass, usize)>,
    /// The events of the step, as bits. There are bits for each kind of pair and stage with a collision, for the number
    /// of rounds, and for each kind of zone. The number is zero if nothing collided.
    pub event_bits: u32,
}

impl Capture {
    /// Creates a capture for scenes of a collision type.
    pub fn new(collision: &Collision) -> Self {
        let records = collision.handling().records;
        let logs_impulses = records.impulses != ImpulseList::Empty;
        Self { logs_impulses, has_mid: records.has_polynomials, ..Self::default() }
    }

    /// Returns the pair and the pass of a polynomial, and its number within the pair. Returns `None` if the reference
    /// has no such polynomial.
    pub fn locate_polynomial(&self, index: usize) -> Option<(Pair, Pass, usize)> {
        let after = self.detections.partition_point(|&(_, _, first)| first <= index);
        let &(pair, pass, first) = self.detections.get(after.checked_sub(1)?)?;
        (index < self.records.end.polynomials.len()).then_some((pair, pass, index - first))
    }

    fn record_event(&mut self, bit: u32) {
        self.event_bits |= 1 << bit;
    }
}

impl Observer for Capture {
    fn begin_step(&mut self, _step: u32) {
        let StepRecords { mid, end } = &mut self.records;
        if self.has_mid {
            let mid = mid.get_or_insert_default();
            mid.impulses.clear();
            mid.polynomials.clear();
        }
        end.impulses.clear();
        end.polynomials.clear();
        self.detections.clear();
        self.event_bits = 0;
    }

    fn begin_pass(&mut self, pass: Pass) {
        self.pass = Some(pass);
        match pass.stage {
            Stage::Simple | Stage::ContinuousTime => {}
            Stage::Impulses { round } => {
                if round > 0 {
                    self.record_event(9 + round.min(3));
                }
            }
            Stage::Geometric { round } => self.record_event(13 + round.min(3)),
        }
    }

    fn observe_detection(&mut self, detection: &Detection<'_>) {
        if let Some(pass) = self.pass {
            let log: &mut PolynomialLog = &mut self.records.end.polynomials;
            self.detections.push((detection.pair, pass, log.len()));
            detection.polynomials.iter().for_each(|polynomial| log.push(polynomial.coefficients()));
            if matches!(detection.decision, Decision::Hit { .. }) {
                let stage = match pass.stage {
                    Stage::Simple | Stage::ContinuousTime => 0,
                    Stage::Impulses { .. } => 3,
                    Stage::Geometric { .. } => 6,
                };
                self.record_event(stage + detection.pair.kind.code().unsigned_abs());
            }
        }
    }

    fn observe_impulse(&mut self, impulse: &Impulse) {
        if self.logs_impulses {
            self.records.end.impulses.push((*impulse).into());
        }
    }

    fn observe_synchronization(&mut self, state: &State) {
        let StepRecords { mid: Some(mid), end } = &mut self.records else { return };
        mid.state.clone_from(state);
        mid.impulses.clone_from(&end.impulses);
        mid.polynomials.coefficients.clone_from(&end.polynomials.coefficients);
        mid.polynomials.coefficient_ends.clone_from(&end.polynomials.coefficient_ends);
    }

    fn observe_failsafe(&mut self, _round: u32, zone: &Zone<'_>) {
        self.record_event(17 + 2 * u32::from(zone.half_plane) + u32::from(zone.particles.len() > 2));
    }

    fn observe_zones(&mut self, _round: u32, zones: &[Zone<'_>]) {
        if zones.len() > 1 {
            self.record_event(21);
        }
    }

    fn end_step(&mut self, _step: u32, state: &State) {
        self.records.end.state.clone_from(state);
    }
}
