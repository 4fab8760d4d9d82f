//! One separate pair: its motion within a step, and the results of detection, identical to those of a pass.
use super::{
    particle_edge::{self, EdgeMotions},
    particle_half_plane, particle_particle,
};
use crate::{
    scene::Scene,
    sim::{
        bodies::Bodies,
        pair::{Pair, PairKind},
    },
};
use fosssim_num::{
    lanes::Plane,
    polynomial::Polynomial,
    vector::{Vec2, vector_at},
};

/// The motion of a point within a step, on a straight line at constant speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointMotion {
    /// The point's position at the start of the step.
    pub start: Vec2,
    /// The point's displacement in the step.
    pub shift: Vec2,
}

impl PointMotion {
    /// Returns the motion of particle `index` between two arrays of positions in trace order.
    pub fn from_positions(q_start: &[f64], q_end: &[f64], index: usize) -> Self {
        let start = vector_at(q_start, index);
        Self { start, shift: vector_at(q_end, index) - start }
    }

    /// Returns the position at `time`, a fraction of the step.
    pub fn position_at(&self, time: f64) -> Vec2 {
        self.start + time * self.shift
    }
}

/// The objects of a pair and their motion within a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PairMotion {
    /// The pair consists of two discs.
    Particles {
        /// The particles' centers.
        centers: [PointMotion; 2],
        /// The particles' radii.
        radii: [f64; 2],
    },
    /// The pair consists of a disc and an edge.
    Edge {
        /// The motion of the disc's center.
        center: PointMotion,
        /// The motions of the edge's endpoints.
        ends: [PointMotion; 2],
        /// The radii of the disc and of the edge.
        radii: [f64; 2],
    },
    /// The pair consists of a disc and a half-plane.
    HalfPlane {
        /// The motion of the disc's center.
        center: PointMotion,
        /// The disc's radius.
        radius: f64,
        /// A point on the half-plane's boundary.
        point: Vec2,
        /// The half-plane's normal as written, of any length.
        normal: Vec2,
    },
}

impl PairMotion {
    /// Returns the motion of a scene's pair between two arrays of positions in trace order.
    ///
    /// # Panics
    /// Panics if the scene or an array lacks one of the objects.
    pub fn from_positions(scene: &Scene, pair: Pair, q_start: &[f64], q_end: &[f64]) -> Self {
        let (first, second) = (pair.first as usize, pair.second as usize);
        let point = |index| PointMotion::from_positions(q_start, q_end, index);
        let radius = scene.particles[first].radius;
        match pair.kind {
            PairKind::ParticleParticle => Self::Particles {
                centers: [point(first), point(second)],
                radii: [radius, scene.particles[second].radius],
            },
            PairKind::ParticleEdge => {
                let edge = &scene.edges[second];
                let ends = [point(edge.first), point(edge.second)];
                Self::Edge { center: point(first), ends, radii: [radius, edge.radius] }
            }
            PairKind::ParticleHalfPlane => {
                let half_plane = &scene.half_planes[second];
                Self::HalfPlane { center: point(first), radius, point: half_plane.point, normal: half_plane.normal }
            }
        }
    }

    /// Returns the kind of the pair.
    pub const fn kind(&self) -> PairKind {
        match self {
            Self::Particles { .. } => PairKind::ParticleParticle,
            Self::Edge { .. } => PairKind::ParticleEdge,
            Self::HalfPlane { .. } => PairKind::ParticleHalfPlane,
        }
    }

    /// Returns the motion of a pair whose particles move by `displacements`.
    #[inline]
    pub(super) fn from_bodies(bodies: &Bodies, pair: Pair, q_start: &[f64], displacements: &[f64]) -> Self {
        let (first, second) = (pair.first as usize, pair.second as usize);
        let point = |index| PointMotion { start: vector_at(q_start, index), shift: vector_at(displacements, index) };
        let radius = bodies.radii[first];
        match pair.kind {
            PairKind::ParticleParticle => {
                Self::Particles { centers: [point(first), point(second)], radii: [radius, bodies.radii[second]] }
            }
            PairKind::ParticleEdge => Self::Edge {
                center: point(first),
                ends: bodies.edges[second].map(point),
                radii: [radius, bodies.edge_radii[second]],
            },
            PairKind::ParticleHalfPlane => {
                let (point_on, normal) = (bodies.points[second], bodies.normals[second]);
                Self::HalfPlane { center: point(first), radius, point: point_on, normal }
            }
        }
    }

    /// Returns the detection polynomials in the order of the trace, with nothing dropped (collisions.md 2).
    pub fn polynomials(&self) -> Vec<Polynomial> {
        self.padded_polynomials()[..self.kind().polynomial_count()].to_vec()
    }

    /// Returns the polynomials, followed by empty ones.
    #[inline]
    pub(super) fn padded_polynomials(&self) -> [Polynomial; PairKind::MAX_POLYNOMIALS] {
        let two = |(overlap, approach): ([f64; 3], [f64; 2])| {
            let none = Polynomial::default();
            [Polynomial::untrimmed(&overlap), Polynomial::untrimmed(&approach), none, none]
        };
        match *self {
            Self::Particles { centers: [one, other], radii } => {
                let [x1, d1, x2, d2] = [one.start, one.shift, other.start, other.shift].map(Plane::from);
                two(particle_particle::coefficients(x1, d1, x2, d2, radii[0] + radii[1]))
            }
            Self::Edge { center, ends: [first, second], radii } => {
                let [x2, d2, x3, d3] = [first.start, first.shift, second.start, second.shift].map(Plane::from);
                let (x1, d1, edge) = (center.start.into(), center.shift.into(), EdgeMotions::new(x2, d2, x3, d3));
                let pair = particle_edge::coefficients(x1, d1, &edge, radii[0] + radii[1]);
                [
                    Polynomial::untrimmed(&pair.distance),
                    Polynomial::untrimmed(&pair.beyond_first),
                    Polynomial::untrimmed(&pair.before_second),
                    Polynomial::untrimmed(&pair.approach),
                ]
            }
            Self::HalfPlane { center, radius, point, normal } => {
                let [x, d, point, normal] = [center.start, center.shift, point, normal].map(Plane::from);
                two(particle_half_plane::coefficients(x, d, radius, point, normal, normal.dot(normal)))
            }
        }
    }

    /// Returns the contact normal at `time`, from the first object to the second, not normalized. Returns `None` (no
    /// hit) if the normal of a particle and an edge is zero.
    pub fn normal(&self, time: f64) -> Option<Vec2> {
        match *self {
            Self::Particles { centers: [one, two], .. } => {
                Some(particle_particle::normal(one.start, one.shift, two.start, two.shift, time))
            }
            Self::Edge { center, ends: [first, second], .. } => {
                let points = [center, first, second];
                particle_edge::normal(points.map(|point| point.start), points.map(|point| point.shift), time)
            }
            Self::HalfPlane { center, point, normal, .. } => {
                let squared = normal.dot(&normal);
                Some(particle_half_plane::normal(center.start, center.shift, point, normal, squared, time))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        scene::original,
        sim::{Decision, Detection, Observer, RootSearch, Simulation},
    };

    const SCENE: &str = r#"<scene>
        <duration time="2"/><integrator type="explicit-euler" dt="0.1"/>
        <collision type="continuous-time" COR="1"/>
        <particle m="1" px="0.1" py="1.3" vx="0.7" vy="-2.1" fixed="0" radius="0.11"/>
        <particle m="1" px="-1.7" py="0.3" vx="0.3" vy="0.5" fixed="0" radius="0.13"/>
        <particle m="1" px="1.9" py="-0.4" vx="-0.2" vy="0.9" fixed="0" radius="0.17"/>
        <particle m="1" px="0.7" py="2.4" vx="-0.2" vy="-1.9" fixed="0" radius="0.17"/>
        <edge i="1" j="2" radius="0.07"/>
        <halfplane px="0.2" py="-1.1" nx="0.3" ny="1.7"/>
    </scene>"#;

    /// Compares the results of a pass for each pair with those of the separate pair.
    struct Compare<'a> {
        scene: &'a Scene,
        calls: usize,
        hits: usize,
    }

    impl Observer for Compare<'_> {
        fn observe_detection(&mut self, detection: &Detection<'_>) {
            let motion = PairMotion::from_positions(self.scene, detection.pair, detection.q_start, detection.q_end);
            assert_eq!(motion.kind(), detection.pair.kind);
            let own = motion.polynomials();
            assert_eq!(own.len(), detection.polynomials.len());
            let bits = |p: &Polynomial| p.coefficients().iter().map(|c| c.to_bits()).collect::<Vec<_>>();
            for (own, logged) in own.iter().zip(detection.polynomials) {
                assert_eq!(bits(&Polynomial::trimmed(own.coefficients())), bits(logged), "{:?}", detection.pair);
            }
            if let Decision::Hit { time, normal } = detection.decision {
                assert_eq!(motion.normal(time), Some(normal), "{:?}", detection.pair);
                self.hits += 1;
            }
            self.calls += 1;
        }
    }

    #[test]
    fn a_pair_on_its_own_is_what_a_pass_computes() {
        let scene = original::read(SCENE.as_bytes()).unwrap().scene;
        let mut compare = Compare { scene: &scene, calls: 0, hits: 0 };
        let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
        for _ in 0..scene.step_count() {
            simulation.step(&mut compare).unwrap();
        }
        assert_eq!(compare.calls, 20 * (6 + 2 + 4));
        assert!(compare.hits >= 3, "{} hits", compare.hits);
    }
}
