//! The detection polynomials with bounds of their rounding errors (collisions.md 2; numerics.md 1 and 2).
//!
//! Each coefficient has the right value, and a bound for the deviation of a correct program. Every operation and every
//! input adds its absolute value to the bound of the result. The formulas are those of the passes
//! ([`fosssim_model::sim::formulas`]), so values are the reference's own bits.
use fosssim_model::{
    scene::Scene,
    sim::{
        Pair, PairKind,
        formulas::{EdgeMotions, particle_edge_and_right_cubic, particle_half_plane, particle_particle},
    },
};
use fosssim_num::{
    bounded::{BoundedValue, BoundedVector, UNIT_ROUNDOFF},
    decision::are_short,
    polynomial::MAX_COEFFICIENTS,
    tolerances::{FAIR_MOMENT_ROUNDINGS, FAIR_SENSITIVITY_FACTOR, FAIR_UNITS},
    vector::{Vec2, vector_at},
};

/// The motion of a point in a step: the position at the start, and the displacement.
#[derive(Debug, Clone, Copy)]
pub struct BoundedPointMotion {
    /// The position at the start of the step.
    pub start: BoundedVector,
    /// The displacement in the step.
    pub shift: BoundedVector,
}

impl BoundedPointMotion {
    /// Returns the motion between two points. The coordinates may deviate by rounding errors of `size`, because a
    /// program may use rotated or shifted axes. A point that is provably at rest does not deviate.
    fn from_positions([start, end]: [Vec2; 2], size: f64, rests: bool) -> Self {
        let start_position = with_component_errors(start, size);
        let shift = if rests { BoundedVector::default() } else { with_component_errors(end, size) - start_position };
        Self { start: start_position, shift }
    }
}

/// The objects of a pair and their motion.
#[derive(Debug, Clone, Copy)]
pub enum BoundedPairMotion {
    /// The pair consists of two discs. The values are their motions and the sum of their radii.
    Particles([BoundedPointMotion; 2], BoundedValue),
    /// The pair consists of a disc and an edge with two endpoints. The values are the motions of the three points and
    /// the sum of the radii.
    Edge([BoundedPointMotion; 3], BoundedValue),
    /// The pair consists of a disc and a half-plane. The values are the disc's motion and radius, and the point and the
    /// normal of the half-plane as the scene gives them.
    HalfPlane(BoundedPointMotion, BoundedValue, Vec2, Vec2),
}

/// The coefficients of a polynomial, highest power first, with nothing dropped.
pub type BoundedCoefficients = [BoundedValue; MAX_COEFFICIENTS];

/// The polynomials of a pair. Polynomial `number` uses the last `sizes[number]` entries of its array.
#[derive(Debug, Clone, Copy, Default)]
pub struct ExpectedPolynomials {
    polynomials: [BoundedCoefficients; 4],
    sizes: [usize; 4],
    /// The approach polynomial of a particle and an edge without the slip in the course's formula (numerics.md 1.1).
    right_approach: Option<BoundedCoefficients>,
}

impl ExpectedPolynomials {
    /// Returns polynomial `number` of the pair.
    pub fn polynomial(&self, number: usize) -> &[BoundedValue] {
        &self.polynomials[number][MAX_COEFFICIENTS - self.sizes[number]..]
    }

    /// Returns all polynomials. Unused entries are empty.
    pub fn polynomials(&self) -> [&[BoundedValue]; 4] {
        std::array::from_fn(|number| self.polynomial(number))
    }

    /// Returns the other accepted form of polynomial `number`: the mathematically right approach polynomial of a
    /// particle and an edge. Returns `None` for other polynomials, which have only one form.
    pub fn other_form(&self, number: usize) -> Option<&[BoundedValue]> {
        if number == 3 { self.right_approach.as_ref().map(|right| &right[..]) } else { None }
    }

    /// Returns the polynomials with the right approach polynomial of a particle and an edge instead of the course's.
    pub fn with_right_approach(mut self) -> Self {
        if let Some(right) = self.right_approach {
            self.polynomials[3] = right;
        }
        self
    }

    /// Returns the number of polynomials.
    pub fn count(&self) -> usize {
        self.sizes.iter().filter(|&&size| size > 0).count()
    }

    fn set(&mut self, number: usize, coefficients: &[BoundedValue]) {
        self.polynomials[number][MAX_COEFFICIENTS - coefficients.len()..].copy_from_slice(coefficients);
        self.sizes[number] = coefficients.len();
    }
}

impl BoundedPairMotion {
    /// Returns the pair's motion in a step.
    pub fn for_pair(scene: &Scene, pair: Pair, q_start: &[f64], q_end: &[f64]) -> Self {
        let (first, second) = (pair.first as usize, pair.second as usize);
        let positions = |particle| [vector_at(q_start, particle), vector_at(q_end, particle)];
        let size = |particles: &[usize]| {
            let all = particles.iter().flat_map(|&particle| positions(particle));
            all.fold(0.0_f64, |maximum, position| maximum.max(l1_norm(position)))
        };
        let way = |particle, size| {
            let [start, end] = positions(particle);
            BoundedPointMotion::from_positions([start, end], size, scene.particles[particle].fixed && start == end)
        };
        let radius = |particle: usize| BoundedValue::from_exact(scene.particles[particle].radius);
        match pair.kind {
            PairKind::ParticleParticle => {
                let size = size(&[first, second]);
                Self::Particles([first, second].map(|particle| way(particle, size)), radius(first) + radius(second))
            }
            PairKind::ParticleEdge => {
                let edge = &scene.edges[second];
                let particles = [first, edge.first, edge.second];
                let size = size(&particles);
                Self::Edge(
                    particles.map(|particle| way(particle, size)),
                    radius(first) + BoundedValue::from_exact(edge.radius),
                )
            }
            PairKind::ParticleHalfPlane => {
                let half_plane = &scene.half_planes[second];
                let size = size(&[first]).max(l1_norm(half_plane.point));
                Self::HalfPlane(way(first, size), radius(first), half_plane.point, half_plane.normal)
            }
        }
    }

    /// Returns the motion with bounds that also cover deviations of the end positions of `particles`. `deviations`
    /// contains two coordinates for each particle of the scene, in the scene's units.
    pub fn widen(mut self, particles: [Option<usize>; 3], deviations: &[f64]) -> Self {
        let widen = |way: &mut BoundedPointMotion, particle: Option<usize>| {
            let Some(particle) = particle else { return };
            if way.shift.x.bound == 0.0 && way.shift.y.bound == 0.0 {
                // The object is provably at rest, independent of other objects.
                return;
            }
            // The comparison multiplies bounds by `2 FAIR_UNITS * UNIT_ROUNDOFF`, so deviations are divided by this
            // number.
            let units = FAIR_SENSITIVITY_FACTOR / (2.0 * FAIR_UNITS * UNIT_ROUNDOFF);
            way.shift.x.bound += units * deviations[2 * particle];
            way.shift.y.bound += units * deviations[2 * particle + 1];
        };
        match &mut self {
            Self::Particles([one, two], _) => {
                widen(one, particles[0]);
                widen(two, particles[1]);
            }
            Self::Edge(ways, _) => ways.iter_mut().zip(particles).for_each(|(way, particle)| widen(way, particle)),
            Self::HalfPlane(way, ..) => widen(way, particles[0]),
        }
        self
    }

    /// Returns whether the second object is an edge.
    pub const fn has_edge(&self) -> bool {
        matches!(self, Self::Edge(..))
    }

    /// Returns whether every way to evaluate the formulas of a parabola is exact. This is so if all inputs are integers
    /// below two to the power `bits`, times one power of two. Polynomials of a particle and a moving edge have higher
    /// degrees, and their zeros are never exact.
    pub fn is_exact(&self, bits: u32) -> bool {
        let parts = |v: BoundedVector| [v.x.value, v.y.value];
        match self {
            Self::Particles([one, two], radii) => {
                let [a, b, c, d] = [one.start, one.shift, two.start, two.shift].map(parts);
                are_short(&[a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1], radii.value], bits)
            }
            Self::HalfPlane(way, radius, point, q) => {
                let [a, b] = [way.start, way.shift].map(parts);
                are_short(&[a[0], a[1], b[0], b[1], point.x, point.y, q.x, q.y, radius.value], bits)
            }
            Self::Edge([one, ends @ ..], radii) => {
                let inputs =
                    ends.iter().flat_map(|end| parts(end.start)).chain(parts(one.start)).chain(parts(one.shift));
                let inputs: Vec<f64> = inputs.chain([radii.value]).collect();
                ends.iter().all(|end| parts(end.shift) == [0.0; 2]) && are_short(&inputs, bits)
            }
        }
    }

    /// Returns the polynomials by which detection decides about this motion.
    pub fn polynomials(&self) -> ExpectedPolynomials {
        let mut expected = ExpectedPolynomials::default();
        match *self {
            Self::Particles([one, two], radii) => {
                let (overlap, approach) = particle_particle(one.start, one.shift, two.start, two.shift, radii);
                expected.set(0, &overlap);
                expected.set(1, &approach);
            }
            Self::Edge([one, two, three], radii) => {
                let edge = EdgeMotions::new(two.start, two.shift, three.start, three.shift);
                let (pair, right_cubic) = particle_edge_and_right_cubic(one.start, one.shift, &edge, radii);
                expected.set(0, &pair.distance);
                expected.set(1, &pair.beyond_first);
                expected.set(2, &pair.before_second);
                expected.set(3, &pair.approach);
                let mut right = pair.approach;
                right[2] = right_cubic;
                expected.right_approach = Some(right);
            }
            Self::HalfPlane(way, radius, point, q) => {
                let (q, point) = (rotate_axes(q), rotate_axes(point));
                let (overlap, approach) = particle_half_plane(way.start, way.shift, radius, point, q, q.dot(q));
                expected.set(0, &overlap);
                expected.set(1, &approach);
            }
        }
        expected
    }

    /// Returns whether two times within the step are the same moment: the points have the same positions, up to a few
    /// rounding errors of the positions' size.
    pub fn is_same_moment(&self, one: f64, other: f64) -> bool {
        let ways = match self {
            Self::Particles(ways, _) => &ways[..],
            Self::Edge(ways, _) => &ways[..],
            Self::HalfPlane(way, ..) => std::slice::from_ref(way),
        };
        let is_so = |way: &BoundedPointMotion| {
            let (start, shift) = (way.start, way.shift);
            let [x, y] = [shift.x, shift.y].map(|shift| (one - other).abs() * shift.value.abs());
            x.max(y) <= FAIR_MOMENT_ROUNDINGS * UNIT_ROUNDOFF * start.x.bound.min(start.y.bound)
        };
        one <= 1.0 && other <= 1.0 && ways.iter().all(is_so)
    }

    /// Returns the vector to the nearest point of the second object at time `t`. Beyond the ends of an edge it differs
    /// from [`Self::normal`]. Round-off may move a particle that arrives at an end beyond it.
    pub fn vector_to_nearest_point(&self, t: f64) -> Vec2 {
        let position = |way: &BoundedPointMotion| {
            let position = way.start + BoundedValue::from_exact(t) * way.shift;
            Vec2::new(position.x.value, position.y.value)
        };
        let Self::Edge(ways, _) = self else {
            let normal = self.normal(t);
            return Vec2::new(normal.x.value, normal.y.value);
        };
        let [x1, x2, x3] = [0, 1, 2].map(|way| position(&ways[way]));
        let edge = x3 - x2;
        x2 + ((x1 - x2).dot(&edge) / edge.dot(&edge)).clamp(0.0, 1.0) * edge - x1
    }

    /// Returns the contact normal at time `t`, not normalized.
    pub fn normal(&self, t: f64) -> BoundedVector {
        let t = BoundedValue::from_exact(t);
        let position = |way: &BoundedPointMotion| way.start + t * way.shift;
        match self {
            Self::Particles([one, two], _) => position(two) - position(one),
            Self::Edge([one, two, three], _) => {
                let (x1, x2, x3) = (position(one), position(two), position(three));
                let (a, b) = (x1 - x2, x3 - x2);
                x2 + (a.dot(b) / b.dot(b)) * b - x1
            }
            Self::HalfPlane(way, _, point, q) => {
                let q = rotate_axes(*q);
                let w = rotate_axes(*point) - position(way);
                (w.dot(q) / q.dot(q)) * q
            }
        }
    }
}

/// Returns a vector whose components may each deviate by a rounding error of `size`.
fn with_component_errors(v: Vec2, size: f64) -> BoundedVector {
    let component = |value| BoundedValue { value, bound: size };
    BoundedVector { x: component(v.x), y: component(v.y) }
}

/// Returns a vector of the scene whose components have the rounding errors of rotated axes.
fn rotate_axes(v: Vec2) -> BoundedVector {
    with_component_errors(v, l1_norm(v))
}

/// Returns |x| + |y|, which bounds the components of a vector in rotated axes. It is at most √2 times the vector's
/// length.
pub(super) fn l1_norm(v: Vec2) -> f64 {
    v.x.abs() + v.y.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two times are the same moment if a point moves by at most two rounding errors between them; other times differ.
    #[test]
    fn a_moment_is_as_long_as_nothing_moves() {
        let point =
            |x: f64, dx: f64| BoundedPointMotion::from_positions([Vec2::new(x, 1.0), Vec2::new(x + dx, 1.0)], x, false);
        let slow = BoundedPairMotion::Particles([point(2.0, 1e-3), point(3.0, 0.0)], BoundedValue::from_exact(0.5));
        let fast = BoundedPairMotion::Particles([point(2.0, 1e-3), point(3.0, 2.0)], BoundedValue::from_exact(0.5));
        let (time, other) = (0.5, 0.5 + 1e-13);
        assert!(slow.is_same_moment(time, other) && !fast.is_same_moment(time, other));
        assert!(fast.is_same_moment(time, 0.5 + 1e-15));
        assert!(!slow.is_same_moment(1.0, 1.0 + f64::EPSILON) && !slow.is_same_moment(0.5, f64::NAN));
    }
    use fosssim_model::{scene::original, sim::Simulation};

    const SCENE: &str = r#"<scene>
        <duration time="1"/><integrator type="explicit-euler" dt="0.5"/>
        <collision type="continuous-time" COR="1"/>
        <particle m="1" px="0.1" py="1.3" vx="0.7" vy="-2.1" fixed="0" radius="0.11"/>
        <particle m="1" px="-1.7" py="0.3" vx="0.3" vy="0.5" fixed="0" radius="0.13"/>
        <particle m="1" px="1.9" py="-0.4" vx="-0.2" vy="0.9" fixed="0" radius="0.17"/>
        <edge i="1" j="2" radius="0.07"/>
        <halfplane px="0.2" py="-1.1" nx="0.3" ny="1.7"/>
    </scene>"#;

    /// The values have the reference's own bits.
    #[test]
    fn values_are_those_of_the_reference() {
        struct Compare<'a>(&'a Scene, usize);
        impl fosssim_model::sim::Observer for Compare<'_> {
            fn observe_detection(&mut self, detection: &fosssim_model::sim::Detection<'_>) {
                let motion = BoundedPairMotion::for_pair(self.0, detection.pair, detection.q_start, detection.q_end);
                let expected = motion.polynomials();
                for (number, polynomial) in detection.polynomials.iter().enumerate() {
                    let own = expected.polynomial(number);
                    assert_eq!(own.len(), polynomial.coefficients().len());
                    for (own, theirs) in own.iter().zip(polynomial.coefficients()) {
                        assert_eq!(own.value.to_bits(), theirs.to_bits());
                        assert!(own.bound >= own.value.abs(), "{own:?}");
                        self.1 += 1;
                    }
                }
            }
        }
        let scene = original::read(SCENE.as_bytes()).expect("a scene").scene;
        let mut compare = Compare(&scene, 0);
        let mut simulation = Simulation::new(&scene, fosssim_model::sim::RootSearch::OnDemand);
        simulation.step(&mut compare).expect("a step");
        assert_eq!(compare.1, 3 * 5 + (5 + 3 + 3 + 6) + 3 * 5);
    }

    /// This is the assignment's own mistake: the definition gives another t³ coefficient (numerics.md 1.1).
    #[test]
    fn the_right_approach_differs_in_its_cubic_coefficient_only() {
        let scene = original::read(SCENE.as_bytes()).expect("a scene").scene;
        let (q_start, q_end) = ([0.1, 1.3, -1.7, 0.3, 1.9, -0.4], [0.45, 0.25, -1.55, 0.55, 1.8, 0.05]);
        let pair = Pair { kind: PairKind::ParticleEdge, first: 0, second: 0 };
        let expected = BoundedPairMotion::for_pair(&scene, pair, &q_start, &q_end).polynomials();
        let (course, right) = (expected.polynomial(3), expected.other_form(3).expect("an edge"));
        let differing: Vec<usize> = (0..6).filter(|&k| course[k].value != right[k].value).collect();
        assert_eq!(differing, [2]);
        // This is -q(2 q' g - q g')/2 with q = e x w, g = e.e (numerics.md 1.2), evaluated at a time by differences of
        // points.
        let at_time = |t: f64| {
            let place = |p: usize| vector_at(&q_start, p) + t * (vector_at(&q_end, p) - vector_at(&q_start, p));
            let speed = |p: usize| vector_at(&q_end, p) - vector_at(&q_start, p);
            let (w, e) = (place(0) - place(1), place(2) - place(1));
            let (dw, de) = (speed(0) - speed(1), speed(2) - speed(1));
            let q = e.x * w.y - e.y * w.x;
            let dq = de.x * w.y + e.x * dw.y - de.y * w.x - e.y * dw.x;
            -q * (2.0 * dq * e.dot(&e) - q * 2.0 * e.dot(&de)) / 2.0
        };
        for t in [0.0, 0.3, 0.7, 1.0] {
            let value = right.iter().fold(0.0, |sum, c| sum * t + c.value);
            assert!((value - at_time(t)).abs() < 1e-12 * value.abs().max(1.0), "at {t}: {value} and {}", at_time(t));
        }
    }
}
