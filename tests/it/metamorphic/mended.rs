//! The simulator with the mathematically right approach polynomial of a particle and an edge.
//!
//! The course's formula has a wrong letter (numerics.md 1.1), so it does not have the expected properties of
//! collisions.
use fosssim_oracle::{
    num::{
        polynomial::Polynomial,
        vector::{Vec2, vector_at},
    },
    scene::Scene,
    sim::{Detection, Observer, Pair, PairKind, StepController},
};

/// The motion of a particle and an edge within the step, as three quadratics (numerics.md 1.2), lowest power first: the
/// cross product of the edge with the vector to the particle, the edge's squared length, and alpha times this square.
#[derive(Debug, Clone, Copy)]
pub struct Quadratics {
    /// `e x w`, positive to the left of the edge.
    pub cross: [f64; 3],
    /// `e . e`
    pub squared: [f64; 3],
    /// `w . e`
    pub along: [f64; 3],
}

impl Quadratics {
    /// Returns the quadratics of `particle` and the edge between `ends`.
    pub fn of(q_start: &[f64], q_end: &[f64], particle: usize, ends: [usize; 2]) -> Self {
        let relative = |index, to| {
            let start = vector_at(q_start, index) - vector_at(q_start, to);
            [start, vector_at(q_end, index) - vector_at(q_end, to) - start]
        };
        let (w, e) = (relative(particle, ends[0]), relative(ends[1], ends[0]));
        let cross = |a: Vec2, b: Vec2| a.x * b.y - a.y * b.x;
        let product = |f: &dyn Fn(Vec2, Vec2) -> f64, a: [Vec2; 2], b: [Vec2; 2]| {
            [f(a[0], b[0]), f(a[0], b[1]) + f(a[1], b[0]), f(a[1], b[1])]
        };
        let dot = |a: Vec2, b: Vec2| a.dot(&b);
        Self { cross: product(&cross, e, w), squared: product(&dot, e, e), along: product(&dot, w, e) }
    }

    /// Returns the right approach, highest power first: `-q (2 q' g - q g') / 2`, which has degree five.
    pub fn approach(&self) -> [f64; 6] {
        let (q, g) = (self.cross, self.squared);
        let mut inner = [0.0; 4];
        for (i, derived) in [q[1], 2.0 * q[2]].into_iter().enumerate() {
            for (j, factor) in g.into_iter().enumerate() {
                inner[i + j] += 2.0 * derived * factor;
            }
        }
        for (i, derived) in [g[1], 2.0 * g[2]].into_iter().enumerate() {
            for (j, factor) in q.into_iter().enumerate() {
                inner[i + j] -= derived * factor;
            }
        }
        let mut product = [0.0; 6];
        for (i, a) in q.into_iter().enumerate() {
            for (j, b) in inner.into_iter().enumerate() {
                product[5 - i - j] -= 0.5 * a * b;
            }
        }
        product
    }

    /// Returns the value of one of the quadratics.
    pub fn value(quadratic: [f64; 3], time: f64) -> f64 {
        quadratic[0] + time * (quadratic[1] + time * quadratic[2])
    }
}

/// An observer that replaces the course's approach polynomial by the right one; `inner` receives the detections.
pub struct Mended<'s, O> {
    /// The scene, for the ends of its edges.
    pub scene: &'s Scene,
    /// The observer that receives all other events.
    pub inner: O,
}

impl<O: Observer> Observer for Mended<'_, O> {
    fn observe_detection(&mut self, detection: &Detection<'_>) {
        self.inner.observe_detection(detection);
    }
    fn as_controller(&mut self) -> Option<&mut dyn StepController> {
        Some(self)
    }
}

impl<O: Observer> StepController for Mended<'_, O> {
    fn adjust_polynomials(&mut self, pair: Pair, q_start: &[f64], q_end: &[f64], polynomials: &mut [Polynomial]) {
        if pair.kind == PairKind::ParticleEdge {
            let edge = self.scene.edges[pair.second as usize];
            let ends = [edge.first, edge.second];
            let right = Quadratics::of(q_start, q_end, pair.first as usize, ends).approach();
            polynomials[3] = Polynomial::trimmed(&right);
        }
    }
}
