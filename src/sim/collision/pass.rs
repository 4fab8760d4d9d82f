//! One detection pass of continuous-time detection over all pairs (collisions.md 1, 2).
//!
//! The pass computes the polynomials of every pair, tells them to the observer, and searches their roots where no
//! certificate excludes an impact within the step.
use super::{
    super::{
        bodies::Bodies,
        observer::{Decision, Detection, Impulse, Observer, Pair, PairKind, Pass, Time},
        simulation::{RootSearch, SearchCounts, StepError},
    },
    particle_edge::{self, EdgeMotion},
    particle_half_plane, particle_particle,
};
use crate::num::{
    certificate::excludes_unit_interval,
    first_time::first_time,
    polynomial::Polynomial,
    vector::{Vec2, at, put},
};

/// What a pass does about a hit, before it looks at the next pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reaction {
    /// The end positions are as before.
    Kept,
    /// The pair's particles were moved.
    Moved,
}

/// Runs detection passes; owns the values that a pass shares between pairs.
#[derive(Debug, Clone)]
pub(super) struct Detector {
    search: RootSearch,
    counts: SearchCounts,
    step: u32,
    passes: u32,
    displacements: Vec<f64>,
    edges: Vec<EdgeMotion>,
}

impl Detector {
    /// A detector that has done nothing yet.
    pub fn new(search: RootSearch) -> Self {
        Self {
            search,
            counts: SearchCounts::default(),
            step: 0,
            passes: 0,
            displacements: Vec::new(),
            edges: Vec::new(),
        }
    }

    /// Starts counting passes anew.
    pub fn begin_step(&mut self, step: u32) {
        self.step = step;
        self.passes = 0;
    }

    /// Number of passes in this step so far, hence the index of the next one.
    pub fn passes(&self) -> u32 {
        self.passes
    }

    /// Counts of root searches, over all steps.
    pub fn counts(&self) -> SearchCounts {
        self.counts
    }

    /// Looks at every pair on the way from `q_start` to `q_end`. On a hit `react` is called, with the end positions,
    /// before the next pair is looked at.
    ///
    /// # Errors
    /// [`StepError::RootSearch`] for a pair whose search would never end.
    pub fn run<O: Observer>(
        &mut self,
        bodies: &Bodies,
        pass: Pass,
        q_start: &[f64],
        q_end: &mut [f64],
        observer: &mut O,
        mut react: impl FnMut(&mut O, &Impulse, &mut [f64]) -> Reaction,
    ) -> Result<(), StepError> {
        observer.begin_pass(pass);
        self.passes += 1;
        self.prepare(bodies, q_start, q_end);
        let mut hits = 0;
        let particles = bodies.particles();
        for i in 0..particles {
            let x1 = at(q_start, i);
            for j in i + 1..particles {
                let (d1, x2, d2) = (at(&self.displacements, i), at(q_start, j), at(&self.displacements, j));
                let polynomials = particle_particle::polynomials(x1, d1, x2, d2, bodies.radii[i] + bodies.radii[j]);
                let pair = pair(PairKind::ParticleParticle, i, j);
                let decision =
                    self.decide(pair, &polynomials, |t| Some(particle_particle::normal(x1, d1, x2, d2, t)))?;
                observer.detection(&Detection { pair, polynomials: &polynomials, decision, q_start, q_end });
                if let Some(impulse) = hit(pair, decision) {
                    hits += 1;
                    if react(observer, &impulse, q_end) == Reaction::Moved {
                        self.refresh(bodies, pair, q_start, q_end);
                    }
                }
            }
            for (e, &ends) in bodies.edges.iter().enumerate() {
                if ends.contains(&i) {
                    continue;
                }
                let d1 = at(&self.displacements, i);
                let edge = self.edges[e];
                let polynomials = particle_edge::polynomials(x1, d1, &edge, bodies.radii[i] + bodies.edge_radii[e]);
                let pair = pair(PairKind::ParticleEdge, i, e);
                let decision = self.decide(pair, &polynomials, |t| particle_edge::normal(x1, d1, &edge, t))?;
                observer.detection(&Detection { pair, polynomials: &polynomials, decision, q_start, q_end });
                if let Some(impulse) = hit(pair, decision) {
                    hits += 1;
                    if react(observer, &impulse, q_end) == Reaction::Moved {
                        self.refresh(bodies, pair, q_start, q_end);
                    }
                }
            }
            for (h, (&point, &normal)) in bodies.points.iter().zip(&bodies.normals).enumerate() {
                let d1 = at(&self.displacements, i);
                let squared = normal.dot(&normal);
                let polynomials = particle_half_plane::polynomials(x1, d1, bodies.radii[i], point, normal, squared);
                let pair = pair(PairKind::ParticleHalfPlane, i, h);
                let decision = self.decide(pair, &polynomials, |t| {
                    Some(particle_half_plane::normal(x1, d1, point, normal, squared, t))
                })?;
                observer.detection(&Detection { pair, polynomials: &polynomials, decision, q_start, q_end });
                if let Some(impulse) = hit(pair, decision) {
                    hits += 1;
                    if react(observer, &impulse, q_end) == Reaction::Moved {
                        self.refresh(bodies, pair, q_start, q_end);
                    }
                }
            }
        }
        observer.end_pass(pass, hits);
        Ok(())
    }

    /// Decides whether a pair collides; `normal` gives the contact normal at a time, or none when it is zero.
    #[inline]
    fn decide(
        &mut self,
        pair: Pair,
        polynomials: &[Polynomial],
        normal: impl FnOnce(f64) -> Option<Vec2>,
    ) -> Result<Decision, StepError> {
        self.counts.calls += 1;
        let excluded = self.search != RootSearch::Always && excludes_unit_interval(polynomials);
        if excluded {
            self.counts.excluded += 1;
            if self.search == RootSearch::WhereNeeded {
                return Ok(Decision::Miss { time: Time::Excluded });
            }
        }
        self.counts.searched += 1;
        let time = first_time(polynomials).map_err(|_| StepError::RootSearch { step: self.step, pair })?;
        if time <= 1.0 {
            if excluded {
                self.counts.disagreements += 1;
            }
            if let Some(normal) = normal(time) {
                return Ok(Decision::Hit { time, normal });
            }
        }
        Ok(Decision::Miss { time: Time::Found(time) })
    }

    /// Fills the shared values.
    fn prepare(&mut self, bodies: &Bodies, q_start: &[f64], q_end: &[f64]) {
        self.displacements.clear();
        self.displacements.extend(q_end.iter().zip(q_start).map(|(end, start)| end - start));
        self.edges.clear();
        let displacements = &self.displacements;
        self.edges.extend(bodies.edges.iter().map(|&ends| motion(ends, q_start, displacements)));
    }

    /// Fills the shared values of a pair's particles again, and those of all edges at them.
    #[cold]
    fn refresh(&mut self, bodies: &Bodies, pair: Pair, q_start: &[f64], q_end: &[f64]) {
        let (first, second) = (pair.first as usize, pair.second as usize);
        let moved = match pair.kind {
            PairKind::ParticleParticle => [first, second, second],
            PairKind::ParticleEdge => [first, bodies.edges[second][0], bodies.edges[second][1]],
            PairKind::ParticleHalfPlane => [first; 3],
        };
        for particle in moved {
            put(&mut self.displacements, particle, at(q_end, particle) - at(q_start, particle));
        }
        for (edge, &ends) in self.edges.iter_mut().zip(&bodies.edges) {
            if moved.contains(&ends[0]) || moved.contains(&ends[1]) {
                *edge = motion(ends, q_start, &self.displacements);
            }
        }
    }
}

#[inline]
fn motion([first, second]: [usize; 2], q_start: &[f64], displacements: &[f64]) -> EdgeMotion {
    EdgeMotion::new(at(q_start, first), at(displacements, first), at(q_start, second), at(displacements, second))
}

#[inline]
pub(super) fn pair(kind: PairKind, first: usize, second: usize) -> Pair {
    #[expect(clippy::cast_possible_truncation, reason = "a scene with 2^32 objects does not fit into memory")]
    Pair { kind, first: first as u32, second: second as u32 }
}

#[inline]
fn hit(pair: Pair, decision: Decision) -> Option<Impulse> {
    match decision {
        Decision::Hit { time, normal } => Some(Impulse { pair, normal, time }),
        Decision::Miss { .. } => None,
    }
}
