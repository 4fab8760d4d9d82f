//! Counts the events inside the steps, with an observer that only adds up.
use crate::{
    scene::Scene,
    sim::{Impulse, Observer, Pair, PairKindMap, Pass, Stage, State, WantedPairs, Zone, pairs},
};
use std::fmt;

/// The numbers of events over all received steps. To use it with other observers, pass a tuple: `(&mut recorder, &mut
/// counts)`.
///
/// It does not request single pairs, because a pass checks every pair of the scene.
///
/// ```
/// use fosssim_model::{scene::original, sim::{RootSearch, Simulation}, trace::EventCounts};
///
/// let xml = br#"<scene><duration time="1"/><integrator type="explicit-euler" dt="0.1"/>
///     <collision type="continuous-time" COR="1"/>
///     <particle m="1" px="0" py="0" vx="0" vy="0" fixed="0"/>
///     <particle m="1" px="9" py="0" vx="0" vy="0" fixed="0"/></scene>"#;
/// let scene = original::read(xml).expect("a scene").scene;
/// let mut simulation = Simulation::new(&scene, RootSearch::default());
/// let mut counts = EventCounts::new(&scene);
/// for _ in 0..scene.step_count() {
///     simulation.step(&mut counts)?;
/// }
/// let calls: u64 = counts.calls.values().sum();
/// assert_eq!((counts.continuous_time_passes, calls, counts.polynomials), (10, 10, 20));
/// # Ok::<(), fosssim_model::sim::StepError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EventCounts {
    /// The number of completed steps.
    pub steps: u64,
    /// The number of passes of `simple`.
    pub simple_passes: u64,
    /// The number of passes of `continuous-time`.
    pub continuous_time_passes: u64,
    /// The number of passes of the impulse stage of `hybrid`.
    pub impulse_passes: u64,
    /// The number of passes of the geometric stage of `hybrid`.
    pub geometric_passes: u64,
    /// The number of detection calls per kind of pair.
    pub calls: PairKindMap<u64>,
    /// The number of calls that found a collision, per kind of pair.
    pub hits: PairKindMap<u64>,
    /// The number of polynomials of all calls.
    pub polynomials: u64,
    /// The number of applied responses.
    pub impulses: u64,
    /// The number of steps with a geometric stage.
    pub geometric_steps: u64,
    /// The number of zones moved as rigid bodies.
    pub failsafes: u64,
    /// The number of particles of the largest moved zone.
    pub largest_zone: u64,
    /// The largest number of zones after a merge.
    pub most_zones: u64,
    /// The number of calls in a pass.
    calls_per_pass: PairKindMap<u64>,
    /// The number of polynomials in a pass that logs any.
    polynomials_per_pass: u64,
}

impl EventCounts {
    /// Creates counts of zero for a simulation of `scene`.
    pub fn new(scene: &Scene) -> Self {
        let pairs = pairs(scene);
        let counts = pairs.counts();
        let calls_per_pass = PairKindMap::from_fn(|kind| counts[kind] as u64);
        Self { calls_per_pass, polynomials_per_pass: pairs.polynomial_count() as u64, ..Self::default() }
    }

    /// Returns the number of passes of all stages.
    pub fn passes(&self) -> u64 {
        self.simple_passes + self.continuous_time_passes + self.impulse_passes + self.geometric_passes
    }
}

impl Observer for EventCounts {
    fn begin_pass(&mut self, pass: Pass) {
        match pass.stage {
            Stage::Simple => self.simple_passes += 1,
            Stage::ContinuousTime => self.continuous_time_passes += 1,
            Stage::Impulses { .. } => self.impulse_passes += 1,
            Stage::Geometric { round } => {
                self.geometric_passes += 1;
                self.geometric_steps += u64::from(round == 0);
            }
        }
    }

    fn wanted_pairs(&mut self) -> WantedPairs<'_> {
        WantedPairs::Nothing
    }

    fn observe_hit(&mut self, pair: Pair) {
        self.hits[pair.kind] += 1;
    }

    fn end_pass(&mut self, pass: Pass, _hits: usize) {
        self.calls_per_pass.iter().for_each(|(kind, calls)| self.calls[kind] += calls);
        if pass.stage != Stage::Simple {
            self.polynomials += self.polynomials_per_pass;
        }
    }

    fn observe_impulse(&mut self, _impulse: &Impulse) {
        self.impulses += 1;
    }

    fn observe_zones(&mut self, _round: u32, zones: &[Zone<'_>]) {
        self.most_zones = self.most_zones.max(zones.len() as u64);
    }

    fn observe_failsafe(&mut self, _round: u32, zone: &Zone<'_>) {
        self.failsafes += 1;
        self.largest_zone = self.largest_zone.max(zone.particles.len() as u64);
    }

    fn end_step(&mut self, _step: u32, _state: &State) {
        self.steps += 1;
    }
}

impl fmt::Display for EventCounts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "steps         {}", self.steps)?;
        writeln!(
            f,
            "passes        {} simple, {} continuous-time, {} impulse, {} geometric",
            self.simple_passes, self.continuous_time_passes, self.impulse_passes, self.geometric_passes
        )?;
        for (name, numbers) in [("calls", self.calls), ("hits", self.hits)] {
            let counts: Vec<String> =
                numbers.iter().map(|(kind, number)| format!("{number} {}", kind.name())).collect();
            writeln!(f, "{name:<13} {}", counts.join(", "))?;
        }
        writeln!(f, "polynomials   {}", self.polynomials)?;
        writeln!(f, "impulses      {}", self.impulses)?;
        writeln!(
            f,
            "geometric     {} steps, {} rigid failsafes, largest zone {} particles, at most {} zones in a round",
            self.geometric_steps, self.failsafes, self.largest_zone, self.most_zones
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{scene::original, sim::PairKind};

    #[test]
    fn events_are_counted_by_stage_and_kind() {
        let ball = "<particle m=\"1\" px=\"0\" py=\"0\" vx=\"0\" vy=\"0\" fixed=\"0\" radius=\"0.1\"/>".repeat(3);
        let xml = format!(
            "<scene><duration time=\"1\"/><integrator type=\"explicit-euler\" dt=\"0.1\"/>{ball}\
             <edge i=\"0\" j=\"1\" radius=\"0.1\"/></scene>"
        );
        let scene = original::read(xml.as_bytes()).expect("a scene").scene;
        let mut counts = EventCounts::new(&scene);
        for round in 0..2 {
            let pass = Pass { stage: Stage::Geometric { round }, index: round };
            counts.begin_pass(pass);
            counts.observe_hit(Pair { kind: PairKind::ParticleEdge, first: 2, second: 0 });
            counts.end_pass(pass, 1);
        }
        let zone = Zone { particles: &[0, 1, 2], half_plane: false };
        counts.observe_zones(0, &[zone]);
        counts.observe_failsafe(0, &zone);
        counts.end_step(1, &State::default());
        assert_eq!((counts.geometric_passes, counts.geometric_steps, counts.passes()), (2, 1, 2));
        assert_eq!((counts.calls, counts.hits), ([6, 2, 0].into(), [0, 2, 0].into()));
        let polynomials =
            2 * (3 * PairKind::ParticleParticle.polynomial_count() + PairKind::ParticleEdge.polynomial_count());
        assert_eq!(counts.polynomials, polynomials as u64);
        assert_eq!((counts.most_zones, counts.failsafes, counts.largest_zone, counts.steps), (1, 1, 3, 1));
    }
}
