//! Accepts calls whose polynomials are right by a wide margin, judged by the reference's own coefficients without
//! bounds.
use super::Follower;
use crate::fair::{
    compare::{MAX_SAFE_SUM, Match, Similarity},
    formulas::l1_norm,
};
use fosssim_model::{
    scene::Scene,
    sim::{
        Pair, PairKind, PairKindMap,
        formulas::{EdgeMotions, particle_edge_and_right_cubic, particle_half_plane, particle_particle},
    },
};
use fosssim_num::{
    bounded::{BoundedValue, Magnitude, UNIT_ROUNDOFF},
    lanes::Plane,
    polynomial::{MAX_COEFFICIENTS, Polynomial},
    tolerances::FAIR_UNITS,
    vector::{Vec2, vector_at},
};

/// The comparisons of a call's polynomials that are right by a wide margin.
pub(super) type QuickMatches = [Option<Match>; PairKind::MAX_POLYNOMIALS];

/// For each polynomial of a kind of pair, the sum of absolute values above which the polynomial exceeds round-off.
pub(super) type RoundOffFloors = PairKindMap<[f64; PairKind::MAX_POLYNOMIALS]>;

impl Follower<'_> {
    /// Returns the logged polynomials of a call that are right by a wide margin.
    /// [`compare`](crate::fair::compare::compare) accepts them as well.
    #[inline]
    pub(super) fn find_quick_matches(
        &mut self,
        pair: Pair,
        [q_start, q_end]: [&[f64]; 2],
        index: usize,
        own: &[Polynomial],
    ) -> QuickMatches {
        let mut found = [None; PairKind::MAX_POLYNOMIALS];
        // With wider bounds, more coefficients count as round-off, so the floors do not apply.
        if self.sensitivity.is_some() || self.context.computes_all_bounds {
            return found;
        }
        let floors = self.round_off_floors.get_or_insert_with(|| round_off_floors(self.context.scene, q_start, q_end))
            [pair.kind];
        let lengths = pair.kind.coefficient_counts();
        for (number, own) in own.iter().enumerate() {
            let (own, logged) = (own.coefficients(), self.records.end.polynomials.get(index + number));
            if own.len() != logged.len() {
                continue;
            }
            if own.is_empty() {
                found[number] = Some(Match { scale: None, tolerance_share: 0.0 });
                continue;
            }
            let similarity = Similarity::measure(own, logged);
            if similarity.is_clear(own.len() == lengths[number]) && similarity.sum > floors[number] {
                found[number] = Some(similarity.as_match());
            }
        }
        found
    }
}

/// Returns, for each polynomial, an upper bound of its round-off at the largest positions and displacements. A bound is
/// infinite if it is unknown.
fn round_off_floors(scene: &Scene, q_start: &[f64], q_end: &[f64]) -> RoundOffFloors {
    let (mut size, mut shift) = (0.0_f64, 0.0_f64);
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let mut widen = |position: Vec2| {
        size = size.max(l1_norm(position));
        low = [low[0].min(position.x), low[1].min(position.y)];
        high = [high[0].max(position.x), high[1].max(position.y)];
    };
    for particle in 0..scene.particles.len() {
        let [start, end] = [q_start, q_end].map(|positions| vector_at(positions, particle));
        [start, end].into_iter().for_each(&mut widen);
        shift = shift.max(l1_norm(end - start));
    }
    for half_plane in &scene.half_planes {
        widen(half_plane.point);
    }
    let spread = (high[0] - low[0]).max(high[1] - low[1]);
    let largest =
        |sizes: &mut dyn Iterator<Item = f64>| sizes.fold(0.0_f64, |max_error, size| max_error.max(size.abs()));
    let particle_radius = largest(&mut scene.particles.iter().map(|particle| particle.radius));
    let radius = particle_radius + particle_radius.max(largest(&mut scene.edges.iter().map(|edge| edge.radius)));
    let normal = largest(&mut scene.half_planes.iter().map(|half_plane| l1_norm(half_plane.normal)));
    let both = |value: f64, bound: f64| {
        let number = BoundedValue { value: Magnitude(value), bound: Magnitude(bound) };
        Plane { x: number, y: number }
    };
    // Only differences of positions matter, and they are at most the spread. The bounds contain the positions' whole
    // absolute values.
    let x = both(0.5 * spread, size + size);
    let d = both(shift, 5.0 * size);
    let radii = BoundedValue { value: Magnitude(radius), bound: Magnitude(radius) };
    let largest_errors = |lists: [&[BoundedValue<Magnitude>]; PairKind::MAX_POLYNOMIALS]| {
        lists.map(|list| {
            let norm: f64 = list.iter().map(|c| c.bound.0).sum();
            let max_error = MAX_COEFFICIENTS as f64 * FAIR_UNITS * UNIT_ROUNDOFF * norm;
            if norm < MAX_SAFE_SUM { 1.01 * max_error } else { f64::INFINITY }
        })
    };
    PairKindMap::from_fn(|kind| match kind {
        PairKind::ParticleParticle => {
            let (overlap, approach) = particle_particle(x, d, x, d, radii);
            largest_errors([&overlap, &approach, &[], &[]])
        }
        PairKind::ParticleEdge => {
            let (pair, right_cubic) = particle_edge_and_right_cubic(x, d, &EdgeMotions::new(x, d, x, d), radii);
            let [a, b, c, d, e, f] = pair.approach;
            let approach = [a, b, c, right_cubic, d, e, f];
            largest_errors([&pair.distance, &pair.beyond_first, &pair.before_second, &approach])
        }
        PairKind::ParticleHalfPlane => {
            let normal = both(normal, normal);
            let (overlap, approach) = particle_half_plane(x, d, radii, x, normal, normal.dot(normal));
            largest_errors([&overlap, &approach, &[], &[]])
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{fair::formulas::BoundedPairMotion, samples::scene};
    use fosssim_model::sim::{Detection, Observer, RootSearch, Simulation};

    /// A scene with balls far from the origin, an edge and half-planes.
    const CROWD: &str = r#"<scene>
        <duration time="1"/><integrator type="explicit-euler" dt="0.1"/><collision type="hybrid" COR="0.7"/>
        <particle m="1" px="10" py="0" vx="3" vy="-1" fixed="0" radius="0.1"/>
        <particle m="2" px="11" py="0.1" vx="0.1" vy="13" fixed="0" radius="0.2"/>
        <particle m="1" px="10.4" py="0.5" vx="0.2" vy="-2" fixed="0" radius="0.1"/>
        <particle m="1" px="13" py="7" vx="-0.3" vy="-2" fixed="1" radius="0.1"/>
        <edge i="0" j="1" radius="0.1"/>
        <halfplane px="0" py="-3" nx="1" ny="2"/><halfplane px="2" py="0" nx="1" ny="0"/>
    </scene>"#;

    /// An observer that measures the smallest ratio of a lower limit to the round-off.
    struct Closest<'a>(&'a Scene, f64);

    impl Observer for Closest<'_> {
        fn observe_detection(&mut self, detection: &Detection<'_>) {
            let &Detection { pair, q_start, q_end, .. } = detection;
            let floors = round_off_floors(self.0, q_start, q_end)[pair.kind];
            let expected = BoundedPairMotion::for_pair(self.0, pair, q_start, q_end).polynomials();
            for (number, floor) in floors.into_iter().enumerate().take(pair.kind.polynomial_count()) {
                for list in std::iter::once(expected.polynomial(number)).chain(expected.other_form(number)) {
                    let norm: f64 = list.iter().map(|c| c.bound).sum();
                    let round_off = MAX_COEFFICIENTS as f64 * FAIR_UNITS * UNIT_ROUNDOFF * norm;
                    assert!(round_off <= floor, "{pair:?} {number}");
                    self.1 = self.1.min(floor / round_off);
                }
            }
        }
    }

    /// A polynomial above the lower limit always exceeds round-off, and the limit is not much larger than necessary.
    #[test]
    fn polynomials_above_the_limit_exceed_round_off() {
        let scene = scene(CROWD);
        let mut closest = Closest(&scene, f64::INFINITY);
        let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
        (0..scene.step_count()).for_each(|_| simulation.step(&mut closest).expect("a step"));
        assert!(closest.1 < 10.0, "{}", closest.1);
    }
}
