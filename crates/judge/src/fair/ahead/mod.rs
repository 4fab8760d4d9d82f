//! Looks at many calls of a pass at once, before they are followed one by one: nearly all polynomials of a right
//! submission are the expected ones up to a factor and round-off, and exclude an impact. What is said of those is what
//! a close look says, bit for bit; all others get that look.
//!
//! `fits` compares in lanes, `look` computes what is expected and asks the certificate.
mod fits;
mod look;

use super::{context::Context, formulas::extent};
use fosssim_model::{
    scene::Scene,
    sim::{ByKind, Pair, PairKind, Pairs, Stage, pairs},
    trace::PolynomialLog,
};
use fosssim_num::{
    lanes::Instructions,
    tolerances::LANES_LARGEST_INPUT,
    vector::{Vec2, at},
};
use look::Look;

/// The batch size: this number of calls, and the rest of a particle's. Smaller values fill fewer lanes, larger ones
/// take more memory.
const TOGETHER: usize = 4096;

/// A kind of which nearly all calls are open is skipped this number of times.
const PAUSE: u32 = 15;

/// What is known of a call beforehand.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Known {
    /// How its polynomials compare.
    pub likeness: Likeness,
    /// Whether it also has to be known that the trace's approach polynomials are of the course's form.
    pub hangs_on_form: bool,
    /// Whether it has lost other leading coefficients than the reference.
    pub lost: bool,
    /// The largest used share of the tolerances. May be less where other calls looked at beforehand have used more.
    pub share: f64,
    /// The factors of its polynomials; NaN where one tells none.
    pub scales: [f64; PairKind::MOST_POLYNOMIALS],
}

/// How a call's logged polynomials compare with the expected ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Likeness {
    /// That is not known.
    #[default]
    Open,
    /// They are the same bit for bit, and exclude an impact.
    Same,
    /// They are the expected ones up to a factor and round-off, and both exclude an impact.
    Alike,
}

/// A call among those of its kind.
#[derive(Debug, Clone, Copy)]
struct Member {
    /// Its number among the calls that are looked at together.
    call: usize,
    /// Its particles: one, two, or three with an edge; the others repeat the first.
    particles: [usize; 3],
    /// The particle, edge or half-plane.
    second: usize,
    /// The number of its first polynomial among those of these calls.
    polynomial: usize,
}

/// A particle's way as all its calls need it.
#[derive(Debug, Clone, Copy, Default)]
struct Way {
    /// Start (x, y), displacement (x, y), the sums of moduli that the displacement was computed from (x, y); 0 where it
    /// rests for certain, else 1.
    numbers: [f64; 7],
    /// The larger size of its two positions.
    size: f64,
}

/// Looks ahead; keeps its memory, for one scene.
#[derive(Debug)]
pub(crate) struct Ahead {
    instructions: Instructions,
    order: Pairs<'static>,
    /// The particles whose calls are looked at.
    rows: std::ops::Range<usize>,
    pairs: Vec<Pair>,
    members: ByKind<Vec<Member>>,
    polynomials: usize,
    ways: Vec<Way>,
    known: Vec<Known>,
    /// How many times a kind is not looked at.
    pauses: ByKind<u32>,
    /// Whether at least half of the calls of a kind were not the reference's bit for bit.
    are_other: ByKind<bool>,
    /// The next call.
    at: usize,
    /// How many calls were looked at; nothing is known of others.
    seen: usize,
    /// The particle behind those whose calls were looked at in this pass.
    next_row: usize,
}

impl Ahead {
    /// Has looked at nothing yet.
    pub fn new(scene: &Scene) -> Self {
        Self {
            instructions: Instructions::default(),
            order: pairs(scene),
            rows: 0..0,
            pairs: Vec::new(),
            members: ByKind::default(),
            polynomials: 0,
            ways: Vec::new(),
            known: Vec::new(),
            pauses: ByKind::default(),
            are_other: ByKind::default(),
            at: 0,
            seen: 0,
            next_row: 0,
        }
    }

    /// A pass begins.
    pub(super) fn begin_pass(&mut self) {
        (self.at, self.seen, self.next_row) = (0, 0, 0);
    }

    /// A call was made.
    pub(super) fn step_over(&mut self) {
        self.at += 1;
    }

    /// The next call and what is known of it.
    pub(super) fn next(&self) -> Option<(Pair, &Known)> {
        let seen = self.at < self.seen;
        seen.then(|| (self.pairs[self.at], &self.known[self.at]))
    }

    /// Looks at the next calls of a pass of this stage, if the last ones are over. `log` holds their polynomials from
    /// number `index` on. Shares of tolerances matter beyond `share` only. Where numbers are too large, nothing is
    /// known.
    pub(super) fn look(
        &mut self,
        context: &Context<'_>,
        stage: Stage,
        (log, index): (&PolynomialLog, usize),
        share: f64,
        [q_start, q_end]: [&[f64]; 2],
    ) {
        if self.at < self.seen {
            return;
        }
        let scene = context.scene;
        (self.at, self.seen) = (0, 0);
        if !self.next_rows(context) || index + self.polynomials > log.len() || !self.find_ways(scene, q_start, q_end) {
            // Nothing more is looked at in this pass.
            self.next_row = usize::MAX;
            return;
        }
        self.seen = self.pairs.len();
        self.known.resize(self.seen, Known::default());
        // Where responses move particles within the pass, what is seen may not be what is compared.
        let is_certain = !matches!(stage, Stage::ContinuousTime);
        for kind in PairKind::ALL {
            let Self { instructions, members, ways, known, pauses, are_other, .. } = self;
            let members = &members[kind];
            if pauses[kind] > 0 {
                pauses[kind] -= 1;
                members.iter().for_each(|member| known[member.call] = Known::default());
                continue;
            }
            let tries_same = !are_other[kind];
            instructions.run(Look { scene, kind, members, ways, log, index, share, is_certain, tries_same, known });
            let count = |asked| members.iter().filter(|member| known[member.call].likeness == asked).count();
            if 4 * count(Likeness::Open) > 3 * members.len() {
                pauses[kind] = PAUSE;
            }
            are_other[kind] = 2 * count(Likeness::Same) < members.len();
        }
    }

    /// Goes on to the next particles with calls; false behind the last.
    fn next_rows(&mut self, context: &Context<'_>) -> bool {
        let particles = context.scene.particles.len();
        let begin = self.next_row;
        if begin == self.rows.start && !self.pairs.is_empty() {
            // The same ones as in the last pass.
            self.next_row = self.rows.end;
            return true;
        }
        self.pairs.clear();
        self.members.values_mut().for_each(Vec::clear);
        self.polynomials = 0;
        while self.next_row < particles && self.pairs.len() < TOGETHER {
            for pair in self.order.of(self.next_row) {
                let [first, others @ ..] = context.particles(pair);
                let first = first.unwrap_or_default();
                let [one, other] = others.map(|particle| particle.unwrap_or(first));
                let member = Member {
                    call: self.pairs.len(),
                    particles: [first, one, other],
                    second: pair.second as usize,
                    polynomial: self.polynomials,
                };
                self.polynomials += pair.kind.polynomials();
                self.members[pair.kind].push(member);
                self.pairs.push(pair);
            }
            self.next_row += 1;
        }
        self.rows = begin..self.next_row;
        !self.pairs.is_empty()
    }

    /// Fills the particles' ways; false where a number is too large or none.
    fn find_ways(&mut self, scene: &Scene, q_start: &[f64], q_end: &[f64]) -> bool {
        self.ways.clear();
        let mut all = true;
        for (index, particle) in scene.particles.iter().enumerate() {
            let (start, end): (Vec2, Vec2) = (at(q_start, index), at(q_end, index));
            let shift = end - start;
            let rests = particle.fixed && start == end;
            let [x, y] = [end.x.abs() + start.x.abs(), end.y.abs() + start.y.abs()];
            let moves = if rests { 0.0 } else { 1.0 };
            let size = extent(start).max(extent(end));
            all &= are_moderate(&[start.x, start.y, end.x, end.y, particle.radius]);
            self.ways.push(Way { numbers: [start.x, start.y, shift.x, shift.y, x, y, moves], size });
        }
        all && scene.edges.iter().all(|edge| are_moderate(&[edge.radius]))
            && scene.half_planes.iter().all(|half_plane| {
                let (point, normal) = (half_plane.point, half_plane.normal);
                are_moderate(&[point.x, point.y, normal.x, normal.y])
            })
    }
}

/// Whether all are numbers that are not too large.
fn are_moderate(numbers: &[f64]) -> bool {
    numbers.iter().all(|number| number.abs() <= LANES_LARGEST_INPUT)
}
