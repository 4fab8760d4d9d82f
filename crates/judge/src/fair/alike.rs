//! What the fair rules say about a step whose records are the reference's but for polynomials that are right.
//!
//! It follows [`Follower`](super::follow::Follower): decisions, states and impulses are the reference's, so what is
//! left is whether each polynomial is right, by which factor, and of which form. Nearly all are right [at
//! once](super::compare::Likeness); a few are looked at closely, and where that is not enough the step goes the long
//! way.
use super::{
    compare::{MOST, Match},
    contact,
    context::Context,
    formulas::{BoundedPairMotion, extent},
    polynomial::{Logged, Said, compare_first},
    step_judgement::StepJudgement,
};
use crate::{
    calls::{Call, Numbers},
    finding::{PolynomialPlace, Role},
    watch::{SeenPass, Watch},
};
use fosssim_model::{
    scene::Scene,
    sim::{
        ByKind, Pair, PairKind, Stage,
        formulas::{EdgeMotions, particle_edge_and_right_cubic, particle_half_plane, particle_particle},
    },
};
use fosssim_num::{
    bounded::{Bounded, Size, UNIT_ROUNDOFF},
    lanes::Plane,
    polynomial::{MAX_COEFFICIENTS, Polynomial},
    tolerances::{FAIR_CLEAR, FAIR_NORM_UNITS, FAIR_TIME, FAIR_UNITS},
    vector::at,
};

/// The number of a particle and an edge's polynomial that has two forms.
const APPROACH: usize = 3;

/// The judgement on such a step so far.
pub(crate) struct AlikeStep<'a> {
    context: &'a Context<'a>,
    judged: StepJudgement,
    /// Expected polynomials whose sums of moduli are above this say something.
    telling: ByKind<[f64; PairKind::MOST_POLYNOMIALS]>,
}

impl<'a> AlikeStep<'a> {
    /// Nothing of the step has been looked at.
    pub fn new(context: &'a Context<'a>, step: u32, watch: &Watch) -> Self {
        let identical = StepJudgement::identical(context, step, watch.bytes.polynomials());
        Self {
            context,
            judged: StepJudgement { same: ByKind::default(), ..identical },
            telling: telling(context.scene, watch),
        }
    }

    /// The judgement, behind the last call.
    pub fn finish(mut self, watch: &Watch) -> Option<StepJudgement> {
        let [.., seen] = watch.passes() else { return Some(self.judged) };
        if matches!(seen.pass.stage, Stage::ContinuousTime) {
            // Behind a first response positions are not known.
            let impulses = &watch.impulses[..];
            if impulses.len() > 1 {
                return None;
            }
            for impulse in impulses {
                let motion = BoundedPairMotion::of(self.context.scene, impulse.pair, &seen.q_start, &seen.q_end);
                let share = contact::normal_share(&motion, *impulse)?;
                self.judged.shares.normal = self.judged.shares.normal.max(share);
            }
        }
        Some(self.judged)
    }

    /// Counts a call whose polynomials are the reference's.
    #[inline]
    pub fn count_same(&mut self, kind: PairKind) {
        self.judged.same[kind] += 1;
    }

    /// Whether it has to be known if the approach polynomial of this pair is of the course's form only.
    #[inline]
    pub fn wants_form(&self, pair: Pair) -> bool {
        pair.kind == PairKind::ParticleEdge && self.judged.course_form.is_none()
    }

    /// Notes the form of a pair's approach polynomial, which is the reference's.
    pub fn form_of_same(&mut self, pair: Pair, index: usize, seen: &SeenPass, approach: &[u8]) -> Option<()> {
        let forms = Forms::of(self.context.scene, pair, seen)?;
        if forms.difference == 0.0 {
            return Some(());
        }
        let approach = Numbers::of(approach);
        let approach = approach.list();
        let room = FAIR_CLEAR * FAIR_NORM_UNITS * UNIT_ROUNDOFF * forms.sum;
        if approach.len() == MAX_COEFFICIENTS && forms.difference <= room {
            return Some(());
        }
        let expected = BoundedPairMotion::of(self.context.scene, pair, &seen.q_start, &seen.q_end).polynomials();
        let place = place(pair, index, seen, APPROACH);
        self.judged.note_course_form(&expected, &Logged { place, number: APPROACH, list: approach });
        Some(())
    }

    /// Takes a call of which a polynomial is not the reference's; `None` where the long way has to be gone.
    #[inline]
    pub fn take(&mut self, call: &Call<'_>, seen: &SeenPass, watch: &Watch) -> Option<()> {
        let &Call { pair, both, alike, .. } = call;
        let kind = pair.kind;
        let mut are_clear = !call.has_lost;
        for (number, both) in both.iter().enumerate() {
            are_clear &= self.is_clear(call, number) | both[0].is_empty();
        }
        if are_clear && self.wants_form(pair) {
            are_clear = self.is_of_both_forms(call, seen)?;
        }
        if are_clear {
            let (factors, share) = (&mut self.judged.scales[kind], &mut self.judged.shares.coefficient);
            for (number, likeness) in alike.iter().enumerate() {
                if both[number][0].is_empty() {
                    continue;
                }
                factors[number].take(likeness.scale);
                let tolerance = likeness.tolerance();
                // Whether the share can be larger is known without a division.
                if likeness.worst > (1.0 - 1e-12) * (*share * tolerance) {
                    *share = share.max(likeness.worst / tolerance);
                }
            }
        } else {
            self.review(call, seen)?;
        }
        if call.has_lost {
            self.judged.lost += 1;
        }
        if call.is_searched || call.has_lost { self.decides_alike(call, seen, watch) } else { Some(()) }
    }

    /// Whether a polynomial of a call is right at once.
    #[inline]
    fn is_clear(&self, call: &Call<'_>, number: usize) -> bool {
        let likeness = &call.alike[number];
        let is_whole = call.both[number][0].len() == 8 * call.lengths[number];
        likeness.is_clear(is_whole) & (likeness.sum > self.telling[call.pair.kind][number])
    }

    /// Whether a pair's approach polynomial, which is right at once, is so by the definition, too.
    fn is_of_both_forms(&self, call: &Call<'_>, seen: &SeenPass) -> Option<bool> {
        let forms = Forms::of(self.context.scene, call.pair, seen)?;
        let likeness = &call.alike[APPROACH];
        let is_whole = call.both[APPROACH][0].len() == 8 * MAX_COEFFICIENTS;
        let room = FAIR_CLEAR * likeness.tolerance() - likeness.worst;
        Some(forms.difference == 0.0 || is_whole && 2.0 * likeness.scale * forms.difference <= room)
    }

    /// Looks closely at a call's polynomials.
    #[inline(never)]
    fn review(&mut self, call: &Call<'_>, seen: &SeenPass) -> Option<()> {
        if !is_still(seen) {
            return None;
        }
        let kind = call.pair.kind;
        let expected = BoundedPairMotion::of(self.context.scene, call.pair, &seen.q_start, &seen.q_end).polynomials();
        let pended = self.judged.pended();
        for number in 0..kind.polynomials() {
            let numbers = Numbers::of(call.both[number][1]);
            let place = place(call.pair, call.index, seen, number);
            let logged = Logged { place, number, list: numbers.list() };
            let first = if self.is_clear(call, number) {
                let likeness = &call.alike[number];
                Ok(Match { scale: Some(likeness.scale), share: likeness.worst / likeness.tolerance() })
            } else {
                compare_first(&self.judged, &expected, &logged)
            };
            if let Said::Wrong(_) = self.judged.note(&expected, &logged, first, true) {
                return None;
            }
        }
        // What a response has led to has its round-off, which the long way looks at.
        (self.judged.pended() == pended || is_first(seen)).then_some(())
    }

    /// Whether what the trace's polynomials decide of a pair is the reference's decision, so that the trace's own,
    /// which is that one, needs no excuse.
    #[inline(never)]
    fn decides_alike(&self, call: &Call<'_>, seen: &SeenPass, watch: &Watch) -> Option<()> {
        let time = |side: usize| {
            let mut polynomials = [Polynomial::default(); PairKind::MOST_POLYNOMIALS];
            for (polynomial, both) in polynomials.iter_mut().zip(call.both) {
                let numbers = Numbers::of(both[side]);
                if !contact::is_searchable(numbers.list()) {
                    return None;
                }
                *polynomial = Polynomial::untrimmed(numbers.list());
            }
            contact::time_of(&polynomials[..call.both.len()])
        };
        // What was not searched is excluded.
        let own = if call.is_searched { time(0)? } else { f64::INFINITY };
        let theirs = time(1)?;
        if own > 1.0 && theirs > 1.0 {
            return Some(());
        }
        if call.has_lost {
            return None;
        }
        if matches!(seen.pass.stage, Stage::ContinuousTime) {
            // Where responses are logged the trace's is the reference's.
            let is_logged = watch.impulses.iter().any(|impulse| impulse.pair == call.pair);
            return (is_logged && own <= 1.0 && theirs <= 1.0 && (own - theirs).abs() <= FAIR_TIME).then_some(());
        }
        let motion = BoundedPairMotion::of(self.context.scene, call.pair, &seen.q_start, &seen.q_end);
        motion.is_moment(own, theirs).then_some(())
    }
}

fn place(pair: Pair, index: usize, seen: &SeenPass, number: usize) -> PolynomialPlace {
    PolynomialPlace { pass: seen.pass, pair, role: Role::of(pair.kind, number), index: index + number }
}

/// Whether all calls of the pass saw the positions that it began with.
fn is_still(seen: &SeenPass) -> bool {
    seen.hits == 0 || !matches!(seen.pass.stage, Stage::ContinuousTime)
}

/// Whether the pass saw positions that no response and no failsafe has moved.
fn is_first(seen: &SeenPass) -> bool {
    matches!(
        seen.pass.stage,
        Stage::Simple | Stage::ContinuousTime | Stage::Impulses { round: 0 } | Stage::Geometric { round: 0 }
    )
}

/// The two forms of an approach polynomial.
struct Forms {
    /// By how much their cubic coefficients differ.
    difference: f64,
    /// The sum of the course's moduli.
    sum: f64,
}

impl Forms {
    /// Of a particle and an edge; `None` where their positions are not known.
    fn of(scene: &Scene, pair: Pair, seen: &SeenPass) -> Option<Self> {
        if !is_still(seen) {
            return None;
        }
        let edge = &scene.edges[pair.second as usize];
        let radii = scene.particles[pair.first as usize].radius + edge.radius;
        let [one, two, three] = [pair.first as usize, edge.first, edge.second].map(|particle| {
            let start = at(&seen.q_start, particle);
            [start, at(&seen.q_end, particle) - start].map(Plane::from)
        });
        let motions = EdgeMotions::new(two[0], two[1], three[0], three[1]);
        let (coefficients, right_cubic) = particle_edge_and_right_cubic(one[0], one[1], &motions, radii);
        let course = coefficients.approach;
        let difference = (right_cubic - course[2]).abs();
        Some(Self { difference, sum: course.iter().map(|c| c.abs()).sum() })
    }
}

/// The sums of moduli above which polynomials of each kind and number say something: more than the round-off of the
/// largest positions and displacements. Infinite, where that is not known.
fn telling(scene: &Scene, watch: &Watch) -> ByKind<[f64; PairKind::MOST_POLYNOMIALS]> {
    let (mut size, mut shift) = (0.0_f64, 0.0_f64);
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let mut widen = |place: fosssim_num::vector::Vec2| {
        size = size.max(extent(place));
        low = [low[0].min(place.x), low[1].min(place.y)];
        high = [high[0].max(place.x), high[1].max(place.y)];
    };
    for seen in watch.passes() {
        if !is_still(seen) && seen.hits > 1 {
            // Responses may have moved particles to and fro.
            return ByKind::from_fn(|_| [f64::INFINITY; PairKind::MOST_POLYNOMIALS]);
        }
        let moved = watch.bytes.mid().filter(|_| !is_still(seen)).map_or(&seen.q_end, |mid| &mid.positions);
        for particle in 0..scene.particles.len() {
            let [start, end, other] = [&seen.q_start, &seen.q_end, moved].map(|places| at(places, particle));
            [start, end, other].into_iter().for_each(&mut widen);
            shift = shift.max(extent(end - start)).max(extent(other - start));
        }
    }
    for half_plane in &scene.half_planes {
        widen(half_plane.point);
    }
    let spread = (high[0] - low[0]).max(high[1] - low[1]);
    let largest = |sizes: &mut dyn Iterator<Item = f64>| sizes.fold(0.0_f64, |most, size| most.max(size.abs()));
    let radius = largest(&mut scene.particles.iter().map(|particle| particle.radius))
        + largest(&mut scene.particles.iter().map(|particle| particle.radius))
            .max(largest(&mut scene.edges.iter().map(|edge| edge.radius)));
    let normal = largest(&mut scene.half_planes.iter().map(|half_plane| extent(half_plane.normal)));
    let both = |value: f64, bound: f64| {
        let number = Bounded { value: Size(value), bound: Size(bound) };
        Plane { x: number, y: number }
    };
    // Only differences of positions matter, which are not larger than the spread; what is too small of their moduli in
    // the bounds is added.
    let x = both(0.5 * spread, size + size);
    let d = both(shift, 5.0 * size);
    let radii = Bounded { value: Size(radius), bound: Size(radius) };
    let of = |lists: [&[Bounded<Size>]; PairKind::MOST_POLYNOMIALS]| {
        lists.map(|list| {
            let norm: f64 = list.iter().map(|c| c.bound.0).sum();
            let most = MAX_COEFFICIENTS as f64 * FAIR_UNITS * UNIT_ROUNDOFF * norm;
            if norm < MOST { 1.01 * most } else { f64::INFINITY }
        })
    };
    ByKind::from_fn(|kind| match kind {
        PairKind::ParticleParticle => {
            let (overlap, approach) = particle_particle(x, d, x, d, radii);
            of([&overlap, &approach, &[], &[]])
        }
        PairKind::ParticleEdge => {
            let (pair, right_cubic) = particle_edge_and_right_cubic(x, d, &EdgeMotions::new(x, d, x, d), radii);
            let [a, b, c, d, e, f] = pair.approach;
            let approach = [a, b, c, right_cubic, d, e, f];
            of([&pair.distance, &pair.beyond_first, &pair.before_second, &approach])
        }
        PairKind::ParticleHalfPlane => {
            let normal = both(normal, normal);
            let (overlap, approach) = particle_half_plane(x, d, radii, x, normal, normal.dot(normal));
            of([&overlap, &approach, &[], &[]])
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::scene;
    use fosssim_model::{
        sim::{RootSearch, Simulation, pairs},
        trace::Layout,
    };

    /// Balls far from the origin, an edge and half-planes.
    const CROWD: &str = r#"<scene>
        <duration time="1"/><integrator type="explicit-euler" dt="0.1"/><collision type="hybrid" COR="0.7"/>
        <particle m="1" px="10" py="0" vx="3" vy="-1" fixed="0" radius="0.1"/>
        <particle m="2" px="11" py="0.1" vx="0.1" vy="13" fixed="0" radius="0.2"/>
        <particle m="1" px="10.4" py="0.5" vx="0.2" vy="-2" fixed="0" radius="0.1"/>
        <particle m="1" px="13" py="7" vx="-0.3" vy="-2" fixed="1" radius="0.1"/>
        <edge i="0" j="1" radius="0.1"/><halfplane px="0" py="-3" nx="1" ny="2"/><halfplane px="2" py="0" nx="1" ny="0"/>
    </scene>"#;

    /// What is above the limit is never round-off; and the limit is no larger than it has to be by much.
    #[test]
    fn what_tells_something_is_above_round_off() {
        let scene = scene(CROWD);
        let mut watch = Watch::new(Layout::of(&scene));
        let mut simulation = Simulation::new(&scene, RootSearch::WhereNeeded);
        let mut closest = f64::INFINITY;
        for _ in 0..scene.steps() {
            simulation.step(&mut watch).expect("a step");
            let telling = telling(&scene, &watch);
            for seen in watch.passes() {
                for pair in pairs(&scene).iter() {
                    let expected = BoundedPairMotion::of(&scene, pair, &seen.q_start, &seen.q_end).polynomials();
                    for number in 0..pair.kind.polynomials() {
                        for list in std::iter::once(expected.polynomial(number)).chain(expected.other_form(number)) {
                            let norm: f64 = list.iter().map(|c| c.bound).sum();
                            let floor = MAX_COEFFICIENTS as f64 * FAIR_UNITS * UNIT_ROUNDOFF * norm;
                            assert!(floor <= telling[pair.kind][number], "{pair:?} {number}");
                            closest = closest.min(telling[pair.kind][number] / floor);
                        }
                    }
                }
            }
        }
        assert!(closest < 10.0, "{closest}");
    }
}
