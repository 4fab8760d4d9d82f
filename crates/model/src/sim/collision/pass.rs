//! One detection pass of continuous-time detection over all pairs (collisions.md 1, 2).
//!
//! The pass computes the polynomials of every pair, tells them to the observer, and searches their roots where no
//! certificate excludes an impact within the step. Where the observer wants to hear of no single call,
//! [`super::blocks`] does the same with several pairs at a time.
use super::{
    super::{
        bodies::Bodies,
        observer::{Decision, Detection, Impulse, Observer, Pass, Time, Wanted},
        pair::{Pair, PairKind, pair},
        pairs::{Place, is_end},
        search::{RootSearch, SUBNORMAL_WORK, SearchCounts, have_subnormal_products},
        step_error::StepError,
    },
    blocks::{Blocks, Setting},
    impact::time_of_impact,
    particle_edge::{self, EdgeMotions},
    particle_half_plane, particle_particle,
    two::{Two, two},
};
use fosssim_num::{
    polynomial::Polynomial,
    vector::{Vec2, at, put},
};
use std::ops::Range;

crate::drops_leading!();

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
    /// A pass that takes the counts' work beyond this is the last.
    most_work: u64,
    step: u32,
    passes: u32,
    displacements: Vec<f64>,
    /// The motions of the edges, two at a time.
    edges: Vec<EdgeMotions<Two>>,
    /// Whether pairs may be looked at in blocks.
    has_lanes: bool,
    blocks: Blocks,
}

impl Detector {
    /// A detector that has done nothing yet.
    pub fn new(search: RootSearch) -> Self {
        Self {
            search,
            counts: SearchCounts::default(),
            most_work: u64::MAX,
            step: 0,
            passes: 0,
            displacements: Vec::new(),
            edges: Vec::new(),
            // To search always, or to audit, is a way to check what is done elsewhere.
            has_lanes: search == RootSearch::WhereNeeded,
            blocks: Blocks::default(),
        }
    }

    /// Looks at pairs one by one from now on.
    pub fn forgo_lanes(&mut self) {
        self.has_lanes = false;
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

    /// Bounds the work of all steps together.
    pub fn limit_work(&mut self, most: u64) {
        self.most_work = most;
    }

    /// Counts of root searches, over all steps.
    pub fn counts(&self) -> SearchCounts {
        self.counts
    }

    /// Looks at every pair on the way from `q_start` to `q_end`. On a hit `react` is called, with the end positions,
    /// before the next pair is looked at.
    ///
    /// # Errors
    /// [`StepError::RootSearch`] for a pair whose search would never end, [`StepError::Work`] beyond the work that is
    /// allowed.
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
        observer.pass_positions(q_start, q_end);
        self.passes += 1;
        self.displacements.clear();
        self.displacements.extend(q_end.iter().zip(q_start).map(|(end, start)| end - start));
        let begin = self.counts.work();
        let is_slow = have_subnormal_products(q_start) || have_subnormal_products(&self.displacements);
        let (mut place, mut hits) = (Place::of(0), 0);
        if self.has_lanes && !matches!(observer.wanted(), Wanted::Calls) {
            hits = self.run_in_blocks(bodies, q_start, q_end, observer, &mut react, &mut place)?;
        }
        if place.first < bodies.particles() {
            self.prepare(bodies, q_start);
            let mut way = Way { bodies, q_start, q_end, observer, react, hits, over: 0 };
            while place.first < bodies.particles() {
                let i = place.first;
                let [particles, edges, half_planes] = bodies.objects().row(place);
                self.particles(i, particles, &mut way)?;
                self.edges(i, edges, &mut way)?;
                self.half_planes(i, half_planes, &mut way)?;
                place = Place::of(i + 1);
            }
            hits = way.hits;
            way.observer.end_pass(pass, hits);
        } else {
            observer.end_pass(pass, hits);
        }
        if is_slow {
            self.counts.subnormal += (SUBNORMAL_WORK - 1) * (self.counts.work() - begin);
        }
        if self.counts.work() > self.most_work {
            return Err(StepError::Work { step: self.step });
        }
        Ok(())
    }

    /// Looks at pairs in blocks, as far as that goes. Gives the number of hits.
    fn run_in_blocks<O: Observer>(
        &mut self,
        bodies: &Bodies,
        q_start: &[f64],
        q_end: &mut [f64],
        observer: &mut O,
        react: &mut impl FnMut(&mut O, &Impulse, &mut [f64]) -> Reaction,
        place: &mut Place,
    ) -> Result<usize, StepError> {
        let step = self.step;
        let mut is_on = self.blocks.prepare(Setting { bodies, step, q_start, displacements: &self.displacements });
        let mut hits = 0;
        while is_on {
            let setting = Setting { bodies, step, q_start, displacements: &self.displacements };
            let bytes = match observer.wanted() {
                Wanted::Bytes(bytes) => Some(bytes),
                Wanted::Calls | Wanted::Nothing => None,
            };
            let Some(impulse) = self.blocks.next_hit(setting, place, &mut self.counts, bytes)? else { break };
            hits += 1;
            if react(observer, &impulse, q_end) == Reaction::Moved {
                let moved = self.displace(bodies, impulse.pair, q_start, q_end);
                let setting = Setting { bodies, step, q_start, displacements: &self.displacements };
                is_on = self.blocks.refresh(setting, moved);
            }
        }
        Ok(hits)
    }

    /// Looks at particle `i` and these.
    #[inline]
    fn particles<O: Observer, R>(
        &mut self,
        i: usize,
        seconds: Range<usize>,
        way: &mut Way<'_, O, R>,
    ) -> Result<(), StepError>
    where
        R: FnMut(&mut O, &Impulse, &mut [f64]) -> Reaction,
    {
        let Way { bodies, q_start, .. } = *way;
        let x1 = at(q_start, i);
        let mut d1 = at(&self.displacements, i);
        for j in seconds {
            if self.is_passed_over(pair(PairKind::ParticleParticle, i, j), way) {
                continue;
            }
            let (x2, d2) = (at(q_start, j), at(&self.displacements, j));
            let mut polynomials = particle_particle::polynomials(x1, d1, x2, d2, bodies.radii[i] + bodies.radii[j]);
            let normal = |t| Some(particle_particle::normal(x1, d1, x2, d2, t));
            if self.look(pair(PairKind::ParticleParticle, i, j), &mut polynomials, normal, way)? == Reaction::Moved {
                d1 = at(&self.displacements, i);
            }
        }
        Ok(())
    }

    /// Looks at particle `i` and those of these edges that it is no end of.
    #[inline]
    fn edges<O: Observer, R>(
        &mut self,
        i: usize,
        seconds: Range<usize>,
        way: &mut Way<'_, O, R>,
    ) -> Result<(), StepError>
    where
        R: FnMut(&mut O, &Impulse, &mut [f64]) -> Reaction,
    {
        let Way { bodies, q_start, .. } = *way;
        let x1 = at(q_start, i);
        let mut d1 = at(&self.displacements, i);
        let mut polynomials = Default::default();
        for (block, ends) in bodies.edges.chunks(LANES).enumerate().skip(seconds.start / LANES) {
            let radii = both(block, |edge| bodies.radii[i] + bodies.edge_radii[edge], bodies.edges.len());
            let coefficients = |d1: Vec2, edges: &EdgeMotions<Two>| {
                particle_edge::coefficients(two([x1; 2]), two([d1; 2]), edges, Two(radii))
            };
            let mut are_known = false;
            for (lane, &ends) in ends.iter().enumerate() {
                if is_end(ends, i) || !seconds.contains(&(LANES * block + lane)) {
                    continue;
                }
                let pair = pair(PairKind::ParticleEdge, i, LANES * block + lane);
                if self.is_passed_over(pair, way) {
                    continue;
                }
                if !are_known {
                    coefficients(d1, &self.edges[block]).write(&mut polynomials);
                    are_known = true;
                }
                let particles = [i, ends[0], ends[1]];
                let d = particles.map(|particle| at(&self.displacements, particle));
                let normal = |t| particle_edge::normal(particles.map(|particle| at(q_start, particle)), d, t);
                if self.look(pair, &mut polynomials[lane], normal, way)? == Reaction::Moved {
                    d1 = at(&self.displacements, i);
                    are_known = false;
                }
            }
        }
        Ok(())
    }

    /// Looks at particle `i` and these half-planes.
    #[inline]
    fn half_planes<O: Observer, R>(
        &mut self,
        i: usize,
        seconds: Range<usize>,
        way: &mut Way<'_, O, R>,
    ) -> Result<(), StepError>
    where
        R: FnMut(&mut O, &Impulse, &mut [f64]) -> Reaction,
    {
        let Way { bodies, q_start, .. } = *way;
        let x = at(q_start, i);
        let mut d = at(&self.displacements, i);
        for h in seconds {
            let (point, q) = (bodies.points[h], bodies.normals[h]);
            if self.is_passed_over(pair(PairKind::ParticleHalfPlane, i, h), way) {
                continue;
            }
            let squared = q.dot(&q);
            let mut polynomials = particle_half_plane::polynomials(x, d, bodies.radii[i], point, q, squared);
            let normal = |t| Some(particle_half_plane::normal(x, d, point, q, squared, t));
            if self.look(pair(PairKind::ParticleHalfPlane, i, h), &mut polynomials, normal, way)? == Reaction::Moved {
                d = at(&self.displacements, i);
            }
        }
        Ok(())
    }

    /// Whether the observer passes a call over.
    #[inline]
    fn is_passed_over<O: Observer, R>(&mut self, next: Pair, way: &mut Way<'_, O, R>) -> bool {
        if self.search != RootSearch::WhereNeeded {
            return false;
        }
        if way.over == 0 {
            way.over = way.observer.passes_over(next, way.q_start, way.q_end);
            if way.over == 0 {
                return false;
            }
        }
        way.over -= 1;
        self.counts.calls += 1;
        self.counts.excluded += 1;
        true
    }

    /// Trims a pair's polynomials, decides about it, tells the observer and has a hit answered; `normal` gives the
    /// contact normal at a time, or none when it is zero.
    #[inline]
    fn look<O: Observer, R>(
        &mut self,
        pair: Pair,
        polynomials: &mut [Polynomial],
        normal: impl FnOnce(f64) -> Option<Vec2>,
        way: &mut Way<'_, O, R>,
    ) -> Result<Reaction, StepError>
    where
        R: FnMut(&mut O, &Impulse, &mut [f64]) -> Reaction,
    {
        polynomials.iter_mut().for_each(Polynomial::trim);
        way.observer.solve(pair, way.q_start, way.q_end, polynomials);
        let time = time_of_impact(self.search, &mut self.counts, self.step, pair, polynomials)?;
        if let (Time::Found(_), Wanted::Bytes(bytes)) = (time, way.observer.wanted()) {
            bytes.parts(0).1.note(0);
        }
        let decision = match time {
            Time::Found(time) if time <= 1.0 => match normal(time) {
                Some(normal) => Decision::Hit { time, normal },
                None => Decision::Miss { time: Time::Found(time) },
            },
            time => Decision::Miss { time },
        };
        let Way { bodies, q_start, ref q_end, ref mut observer, .. } = *way;
        let decision = match observer.wanted() {
            Wanted::Calls => {
                let decision = observer.decide(pair, decision);
                observer.detection(&Detection { pair, polynomials, decision, q_start, q_end });
                decision
            }
            Wanted::Bytes(bytes) => {
                polynomials.iter().for_each(|polynomial| bytes.push(polynomial.coefficients()));
                decision
            }
            Wanted::Nothing => decision,
        };
        let Decision::Hit { time, normal } = decision else { return Ok(Reaction::Kept) };
        way.hits += 1;
        let reaction = (way.react)(way.observer, &Impulse { pair, normal, time }, way.q_end);
        if reaction == Reaction::Moved {
            self.refresh(bodies, pair, q_start, way.q_end);
        }
        Ok(reaction)
    }

    /// Fills what pairs with edges share.
    fn prepare(&mut self, bodies: &Bodies, q_start: &[f64]) {
        self.edges.clear();
        let blocks = 0..bodies.edges.len().div_ceil(LANES);
        let displacements = &self.displacements;
        self.edges.extend(blocks.map(|block| motions(bodies, block, q_start, displacements)));
    }

    /// Fills the shared values of a pair's particles again, and those of all edges at them.
    #[cold]
    fn refresh(&mut self, bodies: &Bodies, pair: Pair, q_start: &[f64], q_end: &[f64]) {
        let moved = self.displace(bodies, pair, q_start, q_end);
        for (block, ends) in bodies.edges.chunks(LANES).enumerate() {
            if ends.as_flattened().iter().any(|end| moved.contains(end)) {
                self.edges[block] = motions(bodies, block, q_start, &self.displacements);
            }
        }
    }

    /// Takes over where a pair's particles end now. Gives these, some of them more than once.
    fn displace(&mut self, bodies: &Bodies, pair: Pair, q_start: &[f64], q_end: &[f64]) -> [usize; 3] {
        let (first, second) = (pair.first as usize, pair.second as usize);
        let moved = match pair.kind {
            PairKind::ParticleParticle => [first, second, second],
            PairKind::ParticleEdge => [first, bodies.edges[second][0], bodies.edges[second][1]],
            PairKind::ParticleHalfPlane => [first; 3],
        };
        for particle in moved {
            put(&mut self.displacements, particle, at(q_end, particle) - at(q_start, particle));
        }
        moved
    }
}

/// What a pass is about: the scene, the way of the step, who listens and who answers hits.
struct Way<'a, O, R> {
    bodies: &'a Bodies,
    q_start: &'a [f64],
    q_end: &'a mut [f64],
    observer: &'a mut O,
    react: R,
    hits: usize,
    /// The number of calls that are skipped next.
    over: usize,
}

/// The number of edges in a block.
const LANES: usize = 2;

/// A value of each edge in a block; a last block of one edge holds it twice.
#[inline]
fn both<T>(block: usize, value: impl Fn(usize) -> T, edges: usize) -> [T; LANES] {
    [value(LANES * block), value((LANES * block + 1).min(edges - 1))]
}

/// The motions of the edges in a block.
#[inline]
fn motions(bodies: &Bodies, block: usize, q_start: &[f64], displacements: &[f64]) -> EdgeMotions<Two> {
    let of =
        |array: &[f64], end: usize| two(both(block, |edge| at(array, bodies.edges[edge][end]), bodies.edges.len()));
    EdgeMotions::new(of(q_start, 0), of(displacements, 0), of(q_start, 1), of(displacements, 1))
}
