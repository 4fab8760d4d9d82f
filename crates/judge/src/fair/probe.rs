//! Measures the sensitivity of a step: the effect of rounding errors in its input on its results and decisions.
//!
//! The step is repeated from perturbed states, each component changed by a few rounding errors in a fixed random
//! pattern. The deviations are a condition estimate by small samples (Kenney and Laub, SIAM J. Sci. Comput. 15, 1994).
//! Grazing contacts, stiff springs, ill-conditioned systems and zones of nearly no extent get the tolerance that they
//! need, and other steps get none.
use super::{
    context::{Context, FollowedDecision, Records},
    formulas::BoundedPairMotion,
};
use fosssim_model::sim::{
    Decision, Detection, ImpactTime, Observer, Pair, Pass, ResumeState, Simulation, Stage, State, StepController,
};
use fosssim_num::{
    bounded::UNIT_ROUNDOFF,
    polynomial::Polynomial,
    tolerances::{FAIR_TIME_SHARE, FAIR_UNITS},
    vector::Vec2,
};

/// The number of perturbed repetitions.
pub(crate) const PERTURBED_RUNS: u64 = 8;

/// The measured sensitivity of a step: the largest deviations, component by component.
#[derive(Debug, Clone)]
pub(super) struct Sensitivity {
    /// The sensitivity of the positions that each detection pass uses: two coordinates per particle.
    pub passes: Vec<Vec<f64>>,
    /// The sensitivity of the state at the synchronization point.
    pub mid: State,
    /// The sensitivity of the state at the end.
    pub end: State,
    /// The indices of the calls whose decisions change.
    pub flipped_decisions: Vec<usize>,
}

/// Returns the sensitivity of a step whose decisions are known, measured by repetitions. If the unperturbed repetition
/// has no result, the sensitivity is unknown and counts as zero, so that only each value's own bounds are used.
pub(super) fn probe(
    context: &Context<'_>,
    simulation: &mut Simulation,
    records: &Records<'_>,
    decisions: &[FollowedDecision],
) -> Sensitivity {
    let zeros = vec![0.0; records.before.positions.len()];
    let zero_state = State { positions: zeros.clone(), velocities: zeros };
    let mut sensitivity =
        Sensitivity { passes: Vec::new(), mid: zero_state.clone(), end: zero_state, flipped_decisions: Vec::new() };
    let Some(base) = run_probe(context, simulation, records, decisions, 0) else { return sensitivity };
    sensitivity.passes = base.passes.iter().map(|q| vec![0.0; q.len()]).collect();
    for seed in 1..=PERTURBED_RUNS {
        let Some(other) = run_probe(context, simulation, records, decisions, seed) else { continue };
        widen_state(&mut sensitivity.mid, &base.mid, &other.mid);
        widen_state(&mut sensitivity.end, &base.end, &other.end);
        for ((own, base), other) in sensitivity.passes.iter_mut().zip(&base.passes).zip(&other.passes) {
            widen(own, base, other);
        }
        for (call, (base, other)) in base.hits.iter().zip(&other.hits).enumerate() {
            if base != other && !sensitivity.flipped_decisions.contains(&call) {
                sensitivity.flipped_decisions.push(call);
            }
        }
    }
    sensitivity
}

fn widen(own: &mut [f64], base: &[f64], other: &[f64]) {
    for ((own, base), other) in own.iter_mut().zip(base).zip(other) {
        let deviation = (base - other).abs();
        if deviation > *own {
            *own = deviation;
        }
    }
}

fn widen_state(own: &mut State, base: &State, other: &State) {
    widen(&mut own.positions, &base.positions, &other.positions);
    widen(&mut own.velocities, &base.velocities, &other.velocities);
}

/// The result of one repetition. If there is no synchronization point, the state in the middle is empty and has no
/// deviations.
#[derive(Default)]
struct ProbeRun {
    passes: Vec<Vec<f64>>,
    mid: State,
    end: State,
    hits: Vec<bool>,
}

fn run_probe(
    context: &Context<'_>,
    simulation: &mut Simulation,
    records: &Records<'_>,
    decisions: &[FollowedDecision],
    seed: u64,
) -> Option<ProbeRun> {
    simulation.state_mut().clone_from(records.before);
    perturb(simulation.state_mut(), seed);
    simulation.set_steps_done(records.step - 1);
    let run = ProbeRun::default();
    let mut probe = PerturbedRun { records, decisions, seed, run, is_stale: true, pass: 0, motion: None, context };
    simulation.step(&mut probe).ok()?;
    Some(ProbeRun { end: simulation.state().clone(), ..probe.run })
}

/// Moves every component up or down by up to [`FAIR_UNITS`] rounding errors. Seed 0 moves nothing.
pub(crate) fn perturb(state: &mut State, seed: u64) {
    if seed == 0 {
        return;
    }
    let mut signs = SignSequence::from_seed(seed);
    for value in state.positions.iter_mut().chain(&mut state.velocities) {
        *value += signs.next() * FAIR_UNITS * UNIT_ROUNDOFF * *value;
    }
}

/// A sequence of random signs, determined by the seed.
struct SignSequence(u64);

impl SignSequence {
    fn from_seed(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    /// Returns 1 or -1, the next sign of the sequence.
    fn next(&mut self) -> f64 {
        // Xorshift (Marsaglia, J. Stat. Softw. 8(14), 2003), of which only one bit is used.
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        if self.0 & 0x100 == 0 { 1.0 } else { -1.0 }
    }
}

impl PerturbedRun<'_> {
    /// Returns a hit at a slightly later or earlier time, because no root finder is exact. The normal is the vector to
    /// an edge's line in some runs, and the vector to its nearest point in others. Returns `None` in the unperturbed
    /// run.
    fn decide_at_shifted_time(&self, time: f64) -> Option<Decision> {
        let motion = self.motion.as_ref()?;
        let time = match self.seed {
            0 => return None,
            seed if seed % 2 == 0 => time + FAIR_TIME_SHARE,
            _ => time - FAIR_TIME_SHARE,
        };
        let normal = motion.normal(time);
        let to_line = Vec2::new(normal.x.value, normal.y.value);
        let normal = if self.seed % 4 < 2 { to_line } else { motion.vector_to_nearest_point(time) };
        Some(Decision::Hit { time, normal })
    }
}

/// An observer that follows the known decisions, and records the decisions of the perturbed run.
struct PerturbedRun<'a> {
    records: &'a Records<'a>,
    decisions: &'a [FollowedDecision],
    seed: u64,
    run: ProbeRun,
    /// Whether the positions of the next pass must still be stored.
    is_stale: bool,
    pass: usize,
    /// The motion of the examined pair.
    motion: Option<BoundedPairMotion>,
    context: &'a Context<'a>,
}

impl Observer for PerturbedRun<'_> {
    fn begin_pass(&mut self, pass: Pass) {
        self.pass = pass.index as usize;
        self.is_stale = true;
    }

    fn observe_detection(&mut self, detection: &Detection<'_>) {
        if self.is_stale {
            self.run.passes.resize(self.pass + 1, Vec::new());
            self.run.passes[self.pass].clear();
            self.run.passes[self.pass].extend_from_slice(detection.q_end);
            self.is_stale = false;
        }
        self.is_stale |= detection.decision.collides();
    }

    fn as_controller(&mut self) -> Option<&mut dyn StepController> {
        Some(self)
    }
}

impl StepController for PerturbedRun<'_> {
    fn adjust_polynomials(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], _polynomials: &mut [Polynomial]) {
        self.motion = Some(BoundedPairMotion::for_pair(self.context.scene, pair, q_start, q_end));
    }

    /// Adds a rounding error of a typical entry to each nonzero entry of the matrix. A computed solution is the exact
    /// one of a matrix perturbed like this, so the condition number determines the effect (Wilkinson, J. ACM 8(3),
    /// 1961).
    fn observe_system(&mut self, matrix: &mut [f64]) {
        let squares: f64 = matrix.iter().map(|entry| entry * entry).sum();
        let size = (squares / (matrix.len() as f64).sqrt()).sqrt();
        let mut signs = SignSequence::from_seed(self.seed);
        for entry in matrix.iter_mut().filter(|entry| self.seed > 0 && **entry != 0.0) {
            *entry += signs.next() * FAIR_UNITS * UNIT_ROUNDOFF * size;
        }
    }

    fn adjust_decision(&mut self, pair: Pair, decision: Decision) -> Decision {
        let call = self.run.hits.len();
        self.run.hits.push(decision.collides());
        let Some(known) = self.decisions.get(call).filter(|known| known.pair == pair) else { return decision };
        match (known.decision, decision) {
            (Decision::Hit { .. }, Decision::Hit { time, .. })
                if matches!(known.pass.stage, Stage::Impulses { .. } | Stage::Geometric { .. }) =>
            {
                self.decide_at_shifted_time(time).unwrap_or(decision)
            }
            (Decision::Hit { .. }, _) => known.decision,
            (Decision::Miss { .. }, Decision::Hit { time, .. }) => Decision::Miss { time: ImpactTime::Found(time) },
            (Decision::Miss { .. }, Decision::Miss { .. }) => decision,
        }
    }

    fn choose_resume_state(&mut self, state: &mut State) -> ResumeState {
        self.run.mid.clone_from(state);
        let Some(mid) = self.records.mid else { return ResumeState::Own };
        if mid.state.is_finite() {
            state.clone_from(&mid.state);
            perturb(state, self.seed);
        }
        ResumeState::Synchronized
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each repetition moves about half of all numbers up, in a different selection.
    #[test]
    fn signs_are_mixed() {
        let of = |seed| {
            let mut signs = SignSequence::from_seed(seed);
            std::array::from_fn::<_, 100, _>(|_| signs.next() > 0.0)
        };
        for seed in 1..=PERTURBED_RUNS {
            let up_count = of(seed).iter().filter(|is_up| **is_up).count();
            assert!((30..=70).contains(&up_count), "{up_count} of 100 with seed {seed}");
            assert!((1..seed).all(|other| of(other) != of(seed)), "{seed}");
        }
    }
}
