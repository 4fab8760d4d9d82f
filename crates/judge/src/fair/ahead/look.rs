//! What the calls of a kind should have logged, one call per lane, and what their polynomials decide.
use super::{super::formulas::extent, Known, Likeness, Member, Way, fits::fits};
use crate::calls::{OF_EDGE, OF_TWO};
use fosssim_model::{
    scene::Scene,
    sim::{
        PairKind,
        formulas::{
            EdgeCoefficients, EdgeMotions, particle_edge_and_right_cubic, particle_half_plane, particle_particle,
        },
    },
    trace::PolynomialLog,
};
use fosssim_num::{
    bounded::{Bounded, Bounded2, UNIT_ROUNDOFF},
    certificate::{
        excludes_unit_interval,
        lanes::{excludes_edge, excludes_two, is_small, search_ends},
    },
    lanes::{Lanes, MOST_LANES, Mask, Plane, Simd, Work},
    polynomial::{MAX_COEFFICIENTS, Polynomial},
    tolerances::FAIR_NORM_UNITS,
};

/// All coefficients of a pair with an edge.
const MOST_COEFFICIENTS: usize = 17;

/// What a lane says of a call, as bits of a small number: that the polynomials are the same; that they are right up to
/// a factor, and can be searched; that those of the approach fit the definition, too; that the reference's exclude an
/// impact; that the logged ones do; that these have lost other leading coefficients.
const SAME: u32 = 1;
const ALIKE: u32 = 2;
const RIGHT_FORM: u32 = 4;
const OWN_EXCLUDED: u32 = 8;
const LOGGED_EXCLUDED: u32 = 16;
const LOST: u32 = 32;

/// The calls of a kind.
pub(super) struct Look<'a> {
    pub scene: &'a Scene,
    pub kind: PairKind,
    pub members: &'a [Member],
    pub ways: &'a [Way],
    pub log: &'a PolynomialLog,
    /// The number of the first polynomial of all calls.
    pub index: usize,
    /// The share of the tolerances that is used in any case.
    pub share: f64,
    /// Whether what is found alike will be found so by a close look, too, so that its share of the tolerances is used.
    pub is_certain: bool,
    /// Whether it is tried first if all calls of a block are the same, for which no bounds are needed.
    pub tries_same: bool,
    pub known: &'a mut [Known],
}

/// Numbers of a block of calls, each number of all lanes side by side.
type Block<const COUNT: usize> = [[f64; MOST_LANES]; COUNT];

/// Coefficients of a block of calls, polynomial by polynomial.
type Coefficients = Block<MOST_COEFFICIENTS>;

/// What was logged of a block of calls.
struct Logged {
    /// The coefficients; 0 where they were dropped, NaN where there are too many.
    coefficients: Coefficients,
    /// How many of each polynomial were dropped.
    missing: Block<{ PairKind::MOST_POLYNOMIALS }>,
}

/// What is known of a block of calls.
struct Answers {
    /// The reference's coefficients, 0 where they are dropped.
    own: Coefficients,
    scales: Block<{ PairKind::MOST_POLYNOMIALS }>,
    share: [f64; MOST_LANES],
    /// Sums of the bits above.
    bits: [f64; MOST_LANES],
}

impl Work for Look<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(mut self, simd: S) {
        let width = Lanes::<S>::COUNT;
        let members = self.members;
        let mut logged = Logged {
            coefficients: [[0.0; MOST_LANES]; MOST_COEFFICIENTS],
            missing: [[0.0; MOST_LANES]; PairKind::MOST_POLYNOMIALS],
        };
        let mut answers = Answers {
            own: [[0.0; MOST_LANES]; MOST_COEFFICIENTS],
            scales: [[0.0; MOST_LANES]; PairKind::MOST_POLYNOMIALS],
            share: [0.0; MOST_LANES],
            bits: [0.0; MOST_LANES],
        };
        for block in members.chunks(width) {
            for lane in 0..width {
                // The last lanes repeat the last call.
                let member = &block[lane.min(block.len() - 1)];
                match self.kind {
                    PairKind::ParticleEdge => {
                        if !self.gather::<4, 17>(member, lane, &mut logged, OF_EDGE) {
                            self.gather_edge(member, lane, &mut logged);
                        }
                    }
                    PairKind::ParticleParticle | PairKind::ParticleHalfPlane => {
                        if !self.gather::<2, 5>(member, lane, &mut logged, OF_TWO) {
                            self.gather_two(member, lane, &mut logged);
                        }
                    }
                }
            }
            match self.kind {
                PairKind::ParticleParticle => self.particles(simd, block, &logged, &mut answers),
                PairKind::ParticleEdge => self.edges(simd, block, &logged, &mut answers),
                PairKind::ParticleHalfPlane => self.half_planes(simd, block, &logged, &mut answers),
            }
            for (lane, member) in block.iter().enumerate() {
                let known = match self.kind {
                    PairKind::ParticleEdge => self.conclude(member, lane, &answers, OF_EDGE),
                    _ => self.conclude(member, lane, &answers, OF_TWO),
                };
                self.known[member.call] = known;
                if self.is_certain {
                    self.share = self.share.max(known.share);
                }
            }
        }
    }
}

impl Look<'_> {
    /// Takes a call's logged coefficients into a lane; complete polynomials have `lengths` of them, `ALL` together.
    /// Whether they are complete; if not, nothing is taken.
    #[inline(always)]
    fn gather<const COUNT: usize, const ALL: usize>(
        &self,
        member: &Member,
        lane: usize,
        logged: &mut Logged,
        lengths: [usize; COUNT],
    ) -> bool {
        let first = self.index + member.polynomial;
        let begin = if first == 0 { 0 } else { self.log.ends[first - 1] };
        let mut is_whole = true;
        let mut end = begin;
        for (number, length) in lengths.iter().enumerate() {
            end += length;
            is_whole &= self.log.ends[first + number] == end;
            logged.missing[number][lane] = 0.0;
        }
        let list = self.log.coefficients[begin..].first_chunk::<ALL>().filter(|_| is_whole);
        let Some(list) = list else { return false };
        for (number, coefficient) in list.iter().enumerate() {
            logged.coefficients[number][lane] = *coefficient;
        }
        true
    }

    /// The same of a pair with an edge, where coefficients were dropped, or there are too many.
    #[inline(never)]
    fn gather_edge(&self, member: &Member, lane: usize, logged: &mut Logged) {
        let first = self.index + member.polynomial;
        self.gather_one::<5>(first, [0, 0], lane, logged);
        self.gather_one::<3>(first, [1, 5], lane, logged);
        self.gather_one::<3>(first, [2, 8], lane, logged);
        self.gather_one::<6>(first, [3, 11], lane, logged);
    }

    /// The same of another pair.
    #[inline(never)]
    fn gather_two(&self, member: &Member, lane: usize, logged: &mut Logged) {
        let first = self.index + member.polynomial;
        self.gather_one::<3>(first, [0, 0], lane, logged);
        self.gather_one::<2>(first, [1, 3], lane, logged);
    }

    /// One polynomial of a call: its number, and the place of its coefficients.
    #[inline(always)]
    fn gather_one<const LENGTH: usize>(
        &self,
        first: usize,
        [number, place]: [usize; 2],
        lane: usize,
        logged: &mut Logged,
    ) {
        let list = self.log.get(first + number);
        let dropped = LENGTH.checked_sub(list.len());
        let mut own = [if dropped.is_some() { 0.0 } else { f64::NAN }; LENGTH];
        let dropped = dropped.unwrap_or(LENGTH);
        own[dropped..].iter_mut().zip(list).for_each(|(place, coefficient)| *place = *coefficient);
        logged.missing[number][lane] = if list.len() > LENGTH { 0.0 } else { dropped as f64 };
        for (place, coefficient) in logged.coefficients[place..place + LENGTH].iter_mut().zip(own) {
            place[lane] = coefficient;
        }
    }

    #[inline(always)]
    fn particles<S: Simd>(&self, simd: S, block: &[Member], logged: &Logged, answers: &mut Answers) {
        let mut numbers = [[0.0; MOST_LANES]; 17];
        for lane in 0..Lanes::<S>::COUNT {
            let [first, second, _] = block[lane.min(block.len() - 1)].particles;
            let (one, two) = (&self.ways[first], &self.ways[second]);
            let radii = [first, second].map(|particle| self.scene.particles[particle].radius);
            let more = [one.size.max(two.size), radii[0] + radii[1], radii[0].abs() + radii[1].abs()];
            place(&mut numbers, 0, lane, &one.numbers);
            place(&mut numbers, 7, lane, &two.numbers);
            place(&mut numbers, 14, lane, &more);
        }
        let [size, value, bound] = loads(simd, &numbers, 14);
        let ([x1, d1], [x2, d2]) = (way(simd, &numbers, 0, size), way(simd, &numbers, 7, size));
        if self.tries_same {
            let (overlap, approach) = particle_particle(values(x1), values(d1), values(x2), values(d2), value);
            if self.are_same_two(simd, &overlap, &approach, logged, answers) {
                return;
            }
        }
        let (overlap, approach) = particle_particle(x1, d1, x2, d2, Bounded { value, bound });
        self.two(simd, &overlap, &approach, logged, answers);
    }

    #[inline(always)]
    fn half_planes<S: Simd>(&self, simd: S, block: &[Member], logged: &Logged, answers: &mut Answers) {
        let mut numbers = [[0.0; MOST_LANES]; 15];
        for lane in 0..Lanes::<S>::COUNT {
            let Member { particles: [first, ..], second, .. } = block[lane.min(block.len() - 1)];
            let (own, half_plane) = (&self.ways[first], &self.scene.half_planes[second]);
            let (point, normal) = (half_plane.point, half_plane.normal);
            let (size, radius) = (own.size.max(extent(point)), self.scene.particles[first].radius);
            let more = [size, radius, point.x, point.y, extent(point), normal.x, normal.y, extent(normal)];
            place(&mut numbers, 0, lane, &own.numbers);
            place(&mut numbers, 7, lane, &more);
        }
        let [size, value] = loads(simd, &numbers, 7);
        let [x, d] = way(simd, &numbers, 0, size);
        let radius = Bounded { value, bound: value.like(0.0) };
        let (point, normal) = (within(loads(simd, &numbers, 9)), within(loads(simd, &numbers, 12)));
        if self.tries_same {
            let own = values(normal);
            let (overlap, approach) =
                particle_half_plane(values(x), values(d), value, values(point), own, own.dot(own));
            if self.are_same_two(simd, &overlap, &approach, logged, answers) {
                return;
            }
        }
        let (overlap, approach) = particle_half_plane(x, d, radius, point, normal, normal.dot(normal));
        self.two(simd, &overlap, &approach, logged, answers);
    }

    /// Whether all pairs with a parabola and a line have logged these coefficients bit for bit; decides about them
    /// then.
    #[inline(always)]
    fn are_same_two<S: Simd>(
        &self,
        simd: S,
        overlap: &[Lanes<S>; 3],
        approach: &[Lanes<S>; 2],
        logged: &Logged,
        answers: &mut Answers,
    ) -> bool {
        let missing: [Lanes<S>; 2] = loads(simd, &logged.missing, 0);
        let (own, dropped) = trimmed(overlap);
        let (own_line, dropped_line) = trimmed(approach);
        let are_same = are_same(&own, &loads(simd, &logged.coefficients, 0))
            & are_same(&own_line, &loads(simd, &logged.coefficients, 3))
            & are_equal(&[dropped, dropped_line], &missing);
        if !are_same.all() {
            return false;
        }
        store(&own, &mut answers.own[..3]);
        store(&own_line, &mut answers.own[3..5]);
        let bits = bit(SAME, are_same) + bit(OWN_EXCLUDED, excludes_two(own, own_line));
        bits.store(&mut answers.bits);
        true
    }

    /// The same of pairs with an edge, and whether their approach fits the definition, too. `right_cubic` is what the
    /// definition gives for t^3.
    #[inline(always)]
    fn are_same_edges<S: Simd>(
        &self,
        simd: S,
        pair: &EdgeCoefficients<Lanes<S>>,
        right_cubic: Lanes<S>,
        logged: &Logged,
        answers: &mut Answers,
    ) -> bool {
        let missing: [Lanes<S>; 4] = loads(simd, &logged.missing, 0);
        let (distance, dropped_0) = trimmed(&pair.distance);
        let (beyond, dropped_1) = trimmed(&pair.beyond_first);
        let (before, dropped_2) = trimmed(&pair.before_second);
        let (approach, dropped_3) = trimmed(&pair.approach);
        let are_same = are_same(&distance, &loads(simd, &logged.coefficients, 0))
            & are_same(&beyond, &loads(simd, &logged.coefficients, 5))
            & are_same(&before, &loads(simd, &logged.coefficients, 8))
            & are_same(&approach, &loads(simd, &logged.coefficients, 11))
            & are_equal(&[dropped_0, dropped_1, dropped_2, dropped_3], &missing);
        if !are_same.all() {
            return false;
        }
        store(&distance, &mut answers.own[..5]);
        store(&beyond, &mut answers.own[5..8]);
        store(&before, &mut answers.own[8..11]);
        store(&approach, &mut answers.own[11..]);
        // A bound is at least as large as its value, so this is within the tolerance with the factor 1.
        let mut sum = pair.approach[0].abs();
        for coefficient in &pair.approach[1..] {
            sum = sum + coefficient.abs();
        }
        let room = (0.25 * FAIR_NORM_UNITS * UNIT_ROUNDOFF) * sum;
        let bits = bit(SAME, are_same)
            + bit(RIGHT_FORM, (right_cubic - pair.approach[2]).abs().le(room))
            + bit(OWN_EXCLUDED, excludes_edge(distance, beyond, before, approach));
        bits.store(&mut answers.bits);
        true
    }

    /// Compares and decides about pairs with a parabola and a line.
    #[inline(always)]
    fn two<S: Simd>(
        &self,
        simd: S,
        overlap: &[Bounded<Lanes<S>>; 3],
        approach: &[Bounded<Lanes<S>>; 2],
        logged: &Logged,
        answers: &mut Answers,
    ) {
        let (parabola, line) =
            (loads::<S, 3, _>(simd, &logged.coefficients, 0), loads::<S, 2, _>(simd, &logged.coefficients, 3));
        let share = Lanes::all(simd, self.share);
        let missing: [Lanes<S>; 2] = loads(simd, &logged.missing, 0);
        let kept @ (own, dropped) = trimmed(&values_of(overlap));
        let kept_line @ (own_line, dropped_line) = trimmed(&values_of(approach));
        let first = fits(overlap, &kept, &parabola, missing[0], share);
        let second = fits(approach, &kept_line, &line, missing[1], share);
        store(&own, &mut answers.own[..3]);
        store(&own_line, &mut answers.own[3..5]);
        store(&[first.scale, second.scale], &mut answers.scales[..2]);
        first.share.max(second.share).store(&mut answers.share);
        let has_kept = dropped.equals(missing[0]) & dropped_line.equals(missing[1]);
        let bits = bit(SAME, has_kept & are_same(&own, &parabola) & are_same(&own_line, &line))
            + bit(ALIKE, first.is_right & second.is_right & search_ends(&parabola) & search_ends(&line))
            + bit(OWN_EXCLUDED, excludes_two(own, own_line))
            + bit(LOGGED_EXCLUDED, excludes_two(parabola, line))
            + bit(LOST, !has_kept);
        bits.store(&mut answers.bits);
    }

    #[inline(always)]
    fn edges<S: Simd>(&self, simd: S, block: &[Member], logged: &Logged, answers: &mut Answers) {
        let mut numbers = [[0.0; MOST_LANES]; 24];
        for lane in 0..Lanes::<S>::COUNT {
            let Member { particles, second, .. } = block[lane.min(block.len() - 1)];
            let [one, two, three] = particles.map(|particle| &self.ways[particle]);
            let radii = [self.scene.particles[particles[0]].radius, self.scene.edges[second].radius];
            let size = one.size.max(two.size).max(three.size);
            let more = [size, radii[0] + radii[1], radii[0].abs() + radii[1].abs()];
            place(&mut numbers, 0, lane, &one.numbers);
            place(&mut numbers, 7, lane, &two.numbers);
            place(&mut numbers, 14, lane, &three.numbers);
            place(&mut numbers, 21, lane, &more);
        }
        let [size, value, bound] = loads(simd, &numbers, 21);
        let [x1, d1] = way(simd, &numbers, 0, size);
        let ([x2, d2], [x3, d3]) = (way(simd, &numbers, 7, size), way(simd, &numbers, 14, size));
        if self.tries_same {
            let motions = EdgeMotions::new(values(x2), values(d2), values(x3), values(d3));
            let (pair, right_cubic) = particle_edge_and_right_cubic(values(x1), values(d1), &motions, value);
            if self.are_same_edges(simd, &pair, right_cubic, logged, answers) {
                return;
            }
        }
        let motions = EdgeMotions::new(x2, d2, x3, d3);
        let (pair, right_cubic) = particle_edge_and_right_cubic(x1, d1, &motions, Bounded { value, bound });
        let distance = loads::<S, 5, _>(simd, &logged.coefficients, 0);
        let (beyond, before) =
            (loads::<S, 3, _>(simd, &logged.coefficients, 5), loads::<S, 3, _>(simd, &logged.coefficients, 8));
        let approach = loads::<S, 6, _>(simd, &logged.coefficients, 11);
        let share = Lanes::all(simd, self.share);
        let missing: [Lanes<S>; 4] = loads(simd, &logged.missing, 0);
        let kept_0 @ (own_distance, dropped_0) = trimmed(&values_of(&pair.distance));
        let kept_1 @ (own_beyond, dropped_1) = trimmed(&values_of(&pair.beyond_first));
        let kept_2 @ (own_before, dropped_2) = trimmed(&values_of(&pair.before_second));
        let kept_3 @ (own_approach, dropped_3) = trimmed(&values_of(&pair.approach));
        let first = fits(&pair.distance, &kept_0, &distance, missing[0], share);
        let second = fits(&pair.beyond_first, &kept_1, &beyond, missing[1], share);
        let third = fits(&pair.before_second, &kept_2, &before, missing[2], share);
        let fourth = fits(&pair.approach, &kept_3, &approach, missing[3], share);
        let mut defined = pair.approach;
        defined[2] = right_cubic;
        // Its share is never asked for.
        let kept = trimmed(&values_of(&defined));
        let has_right_form = fits(&defined, &kept, &approach, missing[3], Lanes::all(simd, 1e100)).is_right;
        store(&own_distance, &mut answers.own[..5]);
        store(&own_beyond, &mut answers.own[5..8]);
        store(&own_before, &mut answers.own[8..11]);
        store(&own_approach, &mut answers.own[11..]);
        store(&[first.scale, second.scale, third.scale, fourth.scale], &mut answers.scales);
        first.share.max(second.share).max(third.share.max(fourth.share)).store(&mut answers.share);
        let has_kept = are_equal(&[dropped_0, dropped_1, dropped_2, dropped_3], &missing);
        let are_right = first.is_right & second.is_right & third.is_right & fourth.is_right;
        let can_be_searched =
            search_ends(&distance) & search_ends(&beyond) & search_ends(&before) & search_ends(&approach);
        let are_same = are_same(&own_distance, &distance)
            & are_same(&own_beyond, &beyond)
            & are_same(&own_before, &before)
            & are_same(&own_approach, &approach);
        let bits = bit(SAME, has_kept & are_same)
            + bit(ALIKE, are_right & can_be_searched)
            + bit(RIGHT_FORM, has_right_form)
            + bit(OWN_EXCLUDED, excludes_edge(own_distance, own_beyond, own_before, own_approach))
            + bit(LOGGED_EXCLUDED, excludes_edge(distance, beyond, before, approach))
            + bit(LOST, !has_kept);
        bits.store(&mut answers.bits);
    }

    /// What is known of a call whose complete polynomials have `lengths` coefficients.
    #[inline(always)]
    fn conclude<const COUNT: usize>(
        &self,
        member: &Member,
        lane: usize,
        answers: &Answers,
        lengths: [usize; COUNT],
    ) -> Known {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a sum of small bits")]
        let bits = answers.bits[lane] as u32;
        let has = |bit: u32| bits & bit != 0;
        let is_same = has(SAME);
        let is_open = !is_same && !has(ALIKE);
        let is_excluded = || {
            (has(OWN_EXCLUDED) || excludes_unit_interval(&own(lane, answers, lengths)))
                && (is_same || has(LOGGED_EXCLUDED) || excludes_unit_interval(&self.logged(member, lengths)))
        };
        if is_open || !is_excluded() {
            return Known::default();
        }
        let hangs_on_form = COUNT > 2 && !has(RIGHT_FORM);
        if is_same {
            return Known { likeness: Likeness::Same, hangs_on_form, ..Known::default() };
        }
        let scales = answers.scales.map(|scale| scale[lane]);
        Known { likeness: Likeness::Alike, hangs_on_form, lost: has(LOST), share: answers.share[lane], scales }
    }

    /// A call's logged polynomials.
    #[inline(never)]
    fn logged<const COUNT: usize>(&self, member: &Member, _: [usize; COUNT]) -> [Polynomial; COUNT] {
        let first = self.index + member.polynomial;
        std::array::from_fn(|number| Polynomial::untrimmed(self.log.get(first + number)))
    }
}

/// The reference's polynomials of a call.
#[inline(never)]
fn own<const COUNT: usize>(lane: usize, answers: &Answers, lengths: [usize; COUNT]) -> [Polynomial; COUNT] {
    let mut numbers = answers.own.iter().map(|lanes| lanes[lane]);
    lengths.map(|length| {
        let mut coefficients = [0.0; MAX_COEFFICIENTS];
        coefficients[..length].iter_mut().zip(&mut numbers).for_each(|(place, number)| *place = number);
        Polynomial::trimmed(&coefficients[..length])
    })
}

/// A particle's start and displacement, of which the numbers from `begin` on tell, with roundings of this size.
#[inline(always)]
fn way<S: Simd, const COUNT: usize>(
    simd: S,
    numbers: &Block<COUNT>,
    begin: usize,
    size: Lanes<S>,
) -> [Bounded2<Lanes<S>>; 2] {
    let [x, y, dx, dy, of_x, of_y, moves] = loads(simd, numbers, begin);
    let both = size + size;
    let shift = Plane {
        x: Bounded { value: dx, bound: moves * (both + of_x) },
        y: Bounded { value: dy, bound: moves * (both + of_y) },
    };
    [within([x, y, size]), shift]
}

/// Puts numbers into a lane, from one on.
#[inline(always)]
fn place<const LENGTH: usize, const COUNT: usize>(
    block: &mut Block<COUNT>,
    begin: usize,
    lane: usize,
    numbers: &[f64; LENGTH],
) {
    let places = &mut block[begin..begin + LENGTH];
    for (place, number) in places.iter_mut().zip(numbers) {
        place[lane] = *number;
    }
}

/// Numbers from one on, of all lanes.
#[inline(always)]
fn loads<S: Simd, const LENGTH: usize, const COUNT: usize>(
    simd: S,
    numbers: &Block<COUNT>,
    begin: usize,
) -> [Lanes<S>; LENGTH] {
    let mut lanes = [Lanes::all(simd, 0.0); LENGTH];
    for (lanes, number) in lanes.iter_mut().zip(&numbers[begin..begin + LENGTH]) {
        *lanes = Lanes::load(simd, number);
    }
    lanes
}

/// A vector whose components may each be off by a rounding of this size.
#[inline(always)]
fn within<S: Simd>([x, y, size]: [Lanes<S>; 3]) -> Bounded2<Lanes<S>> {
    Plane { x: Bounded { value: x, bound: size }, y: Bounded { value: y, bound: size } }
}

/// A vector without its bounds.
#[inline(always)]
fn values<S: Simd>(vector: Bounded2<Lanes<S>>) -> Plane<Lanes<S>> {
    Plane { x: vector.x.value, y: vector.y.value }
}

/// Coefficients without their bounds.
#[inline(always)]
fn values_of<S: Simd, const LENGTH: usize>(coefficients: &[Bounded<Lanes<S>>; LENGTH]) -> [Lanes<S>; LENGTH] {
    let mut values = [coefficients[0].value; LENGTH];
    for (value, coefficient) in values.iter_mut().zip(coefficients) {
        *value = coefficient.value;
    }
    values
}

/// Coefficients with 0 in the place of small leading ones, and the number of these.
#[inline(always)]
fn trimmed<S: Simd, const LENGTH: usize>(coefficients: &[Lanes<S>; LENGTH]) -> ([Lanes<S>; LENGTH], Lanes<S>) {
    let zero = coefficients[0].like(0.0);
    let (mut trimmed, mut dropped, mut leads) = ([zero; LENGTH], zero, zero.is_zero());
    for (own, coefficient) in trimmed.iter_mut().zip(coefficients) {
        leads = leads & is_small(*coefficient);
        *own = leads.choose(zero, *coefficient);
        dropped = dropped + leads.as_numbers();
    }
    (trimmed, dropped)
}

/// This bit where the mask says yes.
#[inline(always)]
fn bit<S: Simd>(bit: u32, mask: Mask<S>) -> Lanes<S> {
    f64::from(bit) * mask.as_numbers()
}

#[inline(always)]
fn are_equal<S: Simd, const LENGTH: usize>(one: &[Lanes<S>; LENGTH], other: &[Lanes<S>; LENGTH]) -> Mask<S> {
    let mut all = one[0].equals(other[0]);
    for (one, other) in one[1..].iter().zip(&other[1..]) {
        all = all & one.equals(*other);
    }
    all
}

#[inline(always)]
fn are_same<S: Simd, const LENGTH: usize>(one: &[Lanes<S>; LENGTH], other: &[Lanes<S>; LENGTH]) -> Mask<S> {
    let mut all = one[0].is_same(other[0]);
    for (one, other) in one[1..].iter().zip(&other[1..]) {
        all = all & one.is_same(*other);
    }
    all
}

#[inline(always)]
fn store<S: Simd>(numbers: &[Lanes<S>], places: &mut [[f64; MOST_LANES]]) {
    for (lanes, place) in numbers.iter().zip(places) {
        lanes.store(place);
    }
}
