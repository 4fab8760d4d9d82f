//! One detection pass of continuous-time detection over all pairs (collisions.md 1, 2).
//!
//! The pass computes the polynomials of every pair, passes them to the observer, and searches their roots if no
//! certificate excludes an impact within the step. If the observer does not need single calls, [`super::blocks`]
//! processes several pairs at a time.
use super::{
    super::{
        bodies::Bodies,
        observer::{Decision, Detection, ImpactTime, Impulse, Observer, Pass, WantedPairs},
        pair::{Pair, PairKind, pair},
        pairs::{PassCursor, is_end},
        search::{RootSearch, SUBNORMAL_WORK, SearchCounts, have_subnormal_products},
        step_error::StepError,
    },
    blocks::{Blocks, PassInput},
    impact::time_of_impact,
    motion::PairMotion,
};
use fosssim_num::{
    polynomial::Polynomial,
    vector::{set_vector, vector_at},
};

crate::drops_leading!();

/// The reaction of a pass to a hit, before it checks the next pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reaction {
    /// The end positions are the same as before.
    Kept,
    /// The pair's particles have moved.
    Moved,
}

/// Runs detection passes, and stores the values that all pairs of a pass share.
#[derive(Debug, Clone)]
pub(super) struct Detector {
    search: RootSearch,
    counts: SearchCounts,
    /// The maximum work. A pass that exceeds it is the last.
    max_work: u64,
    step: u32,
    pass_count: u32,
    displacements: Vec<f64>,
    /// Whether pairs may be checked in blocks.
    has_lanes: bool,
    blocks: Blocks,
}

impl Detector {
    /// Creates a detector for a scene with `steps` steps.
    pub fn new(search: RootSearch, steps: u32) -> Self {
        Self {
            search,
            counts: SearchCounts::default(),
            max_work: u64::MAX,
            step: 0,
            pass_count: 0,
            displacements: Vec::new(),
            // The other root search modes exist to check the results of lanes.
            has_lanes: search == RootSearch::OnDemand,
            blocks: Blocks::new(steps),
        }
    }

    /// Checks the following pairs individually, without lanes.
    pub fn disable_lanes(&mut self) {
        self.has_lanes = false;
    }

    /// Resets the number of passes.
    pub fn begin_step(&mut self, step: u32) {
        self.step = step;
        self.pass_count = 0;
    }

    /// Returns the number of passes in this step so far, which is the index of the next pass.
    pub fn pass_count(&self) -> u32 {
        self.pass_count
    }

    /// Limits the total work of all steps.
    pub fn limit_work(&mut self, max_work: u64) {
        self.max_work = max_work;
    }

    /// Returns the counts of root searches, over all steps.
    pub fn counts(&self) -> SearchCounts {
        self.counts
    }

    /// Checks every pair between `q_start` and `q_end`. After a hit, calls `respond` with the end positions before the
    /// next pair is checked.
    ///
    /// # Errors
    /// Fails with [`StepError::RootSearch`] if the root search of a pair would never end, and with [`StepError::Work`]
    /// if the allowed work is exceeded.
    pub fn run<O: Observer>(
        &mut self,
        bodies: &Bodies,
        pass: Pass,
        q_start: &[f64],
        q_end: &mut [f64],
        observer: &mut O,
        mut respond: impl FnMut(&mut O, &Impulse, &mut [f64]) -> Reaction,
    ) -> Result<(), StepError> {
        observer.begin_pass(pass);
        observer.observe_positions(q_start, q_end);
        self.pass_count += 1;
        self.displacements.clear();
        self.displacements.extend(q_end.iter().zip(q_start).map(|(end, start)| end - start));
        let begin = self.counts.work();
        let is_slow = have_subnormal_products(q_start) || have_subnormal_products(&self.displacements);
        let (mut cursor, mut hits) = (PassCursor::from_first(0), 0);
        if self.has_lanes && !matches!(observer.wanted_pairs(), WantedPairs::Calls) {
            hits = self.run_in_blocks(bodies, q_start, q_end, observer, &mut respond, &mut cursor)?;
        }
        let mut context = PassContext { pass, bodies, q_start, q_end, observer, respond, hits };
        while cursor.first < bodies.particle_count() {
            let first = cursor.first;
            for (kind, seconds) in PairKind::ALL.into_iter().zip(bodies.object_counts().remaining_row(cursor)) {
                for second in seconds {
                    if kind != PairKind::ParticleEdge || !is_end(bodies.edges[second], first) {
                        self.detect(pair(kind, first, second), &mut context)?;
                    }
                }
            }
            cursor = PassCursor::from_first(first + 1);
        }
        context.observer.end_pass(pass, context.hits);
        if is_slow {
            self.counts.subnormal += (SUBNORMAL_WORK - 1) * (self.counts.work() - begin);
        }
        if self.counts.work() > self.max_work {
            return Err(StepError::Work { step: self.step });
        }
        Ok(())
    }

    /// Checks pairs in blocks, if that is possible. Returns the number of hits.
    fn run_in_blocks<O: Observer>(
        &mut self,
        bodies: &Bodies,
        q_start: &[f64],
        q_end: &mut [f64],
        observer: &mut O,
        respond: &mut impl FnMut(&mut O, &Impulse, &mut [f64]) -> Reaction,
        cursor: &mut PassCursor,
    ) -> Result<usize, StepError> {
        let step = self.step;
        let mut is_on = self.blocks.prepare(PassInput { bodies, step, q_start, displacements: &self.displacements });
        let mut hits = 0;
        while is_on {
            let input = PassInput { bodies, step, q_start, displacements: &self.displacements };
            let bytes = match observer.wanted_pairs() {
                WantedPairs::Bytes(bytes) => Some(bytes),
                WantedPairs::Calls | WantedPairs::Nothing => None,
            };
            let Some(impulse) = self.blocks.find_next_hit(input, cursor, &mut self.counts, bytes)? else { break };
            hits += 1;
            observer.observe_hit(impulse.pair);
            if respond(observer, &impulse, q_end) == Reaction::Moved {
                let moved = self.displace(bodies, impulse.pair, q_start, q_end);
                let input = PassInput { bodies, step, q_start, displacements: &self.displacements };
                is_on = self.blocks.refresh(input, moved);
            }
        }
        Ok(hits)
    }

    /// Computes a pair's polynomials, decides the pair, and calls the observer and, on a hit, the response.
    #[inline]
    fn detect<O: Observer, R>(&mut self, pair: Pair, context: &mut PassContext<'_, O, R>) -> Result<(), StepError>
    where
        R: FnMut(&mut O, &Impulse, &mut [f64]) -> Reaction,
    {
        let motion = PairMotion::from_bodies(context.bodies, pair, context.q_start, &self.displacements);
        let mut polynomials = motion.padded_polynomials();
        let polynomials = &mut polynomials[..pair.kind.polynomial_count()];
        polynomials.iter_mut().for_each(Polynomial::trim);
        if let Some(steer) = context.observer.as_controller() {
            steer.adjust_polynomials(pair, context.q_start, context.q_end, polynomials);
        }
        let time = time_of_impact(self.search, &mut self.counts, self.step, pair, polynomials)?;
        let decision = match time {
            ImpactTime::Found(time) if time <= 1.0 => match motion.normal(time) {
                Some(normal) => Decision::Hit { time, normal },
                None => Decision::Miss { time: ImpactTime::Found(time) },
            },
            time => Decision::Miss { time },
        };
        let PassContext { pass, bodies, q_start, ref q_end, ref mut observer, .. } = *context;
        let decision = match observer.wanted_pairs() {
            WantedPairs::Calls => {
                let decision = observer.as_controller().map_or(decision, |steer| steer.adjust_decision(pair, decision));
                observer.observe_detection(&Detection {
                    pass,
                    pair,
                    polynomials,
                    decision,
                    q_start,
                    q_end,
                    velocities: &[],
                });
                decision
            }
            WantedPairs::Bytes(bytes) => {
                polynomials.iter().for_each(|polynomial| bytes.push(polynomial.coefficients()));
                decision
            }
            WantedPairs::Nothing => decision,
        };
        let Decision::Hit { time, normal } = decision else { return Ok(()) };
        context.hits += 1;
        context.observer.observe_hit(pair);
        if (context.respond)(context.observer, &Impulse { pair, normal, time }, context.q_end) == Reaction::Moved {
            self.displace(bodies, pair, q_start, context.q_end);
        }
        Ok(())
    }

    /// Copies the current end positions of a pair's particles. Returns the particles, possibly with repetitions.
    fn displace(&mut self, bodies: &Bodies, pair: Pair, q_start: &[f64], q_end: &[f64]) -> [usize; 3] {
        let moved = bodies.pair_particles(pair);
        for particle in moved {
            set_vector(&mut self.displacements, particle, vector_at(q_end, particle) - vector_at(q_start, particle));
        }
        moved
    }
}

/// The context of a pass: the scene, the start and end of the step, the observer, and the response to hits.
struct PassContext<'a, O, R> {
    pass: Pass,
    bodies: &'a Bodies,
    q_start: &'a [f64],
    q_end: &'a mut [f64],
    observer: &'a mut O,
    respond: R,
    hits: usize,
}
