//! Forces and their derivatives, by the formulas of a textbook.
use super::{Arithmetic, Sum};
use fosssim_model::{
    scene::{Collision, CollisionDetection, Force, Scene},
    sim::{PairKind, PenaltyPairs},
};
use fosssim_num::vector::{Vec2, divide, length, vector_at};
use nalgebra::DMatrix;

/// The forces of a scene, in the order and arithmetic of one program.
pub(super) struct ForceTerms<'a> {
    scene: &'a Scene,
    arithmetic: Arithmetic,
    near: Option<PenaltyPairs>,
    drawn: u64,
}

/// Returns the mass of a particle.
pub(super) fn mass(scene: &Scene, particle: usize) -> f64 {
    scene.particles[particle].mass
}

impl<'a> ForceTerms<'a> {
    pub(super) fn new(scene: &'a Scene, arithmetic: Arithmetic) -> Self {
        let near = match scene.collision {
            Collision::Penalty { thickness, detection, .. } => Some(PenaltyPairs::new(scene, thickness, detection)),
            _ => None,
        };
        Self { scene, arithmetic, near, drawn: 1 }
    }

    /// Returns the force on every particle at positions `x` and velocities `v`.
    pub(super) fn evaluate_at(&mut self, x: &[f64], v: &[f64]) -> Vec<f64> {
        let mut terms = Vec::new();
        for force in &self.scene.forces {
            self.add_terms(force, x, v, &mut terms);
        }
        self.add_penalty(x, &mut terms);
        self.sum(terms, x.len())
    }

    fn sum(&mut self, mut terms: Vec<(usize, Vec2)>, size: usize) -> Vec<f64> {
        let (mut sums, mut lost) = (vec![0.0; size], vec![0.0; size]);
        match self.arithmetic.sum {
            Sum::Backward => terms.reverse(),
            Sum::Shuffled => {
                for end in (1..terms.len()).rev() {
                    // Xorshift (Marsaglia, J. Stat. Softw. 8(14), 2003).
                    self.drawn ^= self.drawn << 13;
                    self.drawn ^= self.drawn >> 7;
                    self.drawn ^= self.drawn << 17;
                    terms.swap(end, usize::try_from(self.drawn % (end as u64 + 1)).unwrap_or(0));
                }
            }
            Sum::Compensated => {}
        }
        for (particle, term) in terms {
            for (k, value) in [(2 * particle, term.x), (2 * particle + 1, term.y)] {
                let before = sums[k];
                sums[k] += value;
                if self.arithmetic.sum == Sum::Compensated {
                    let taken = sums[k] - before;
                    lost[k] += (before - (sums[k] - taken)) + (value - taken);
                }
            }
        }
        sums.iter().zip(&lost).map(|(sum, lost)| sum + lost).collect()
    }

    fn add_terms(&self, force: &Force, x: &[f64], v: &[f64], terms: &mut Vec<(usize, Vec2)>) {
        let particles = 0..self.scene.particles.len();
        let mut both = |first: usize, second: usize, on_first: Vec2| {
            terms.extend([(first, on_first), (second, -1.0 * on_first)]);
        };
        match *force {
            Force::Spring { edge, stiffness, rest_length, damping } => {
                let (a, b) = (self.scene.edges[edge].first, self.scene.edges[edge].second);
                let (d, w) = (vector_at(x, b) - vector_at(x, a), vector_at(v, b) - vector_at(v, a));
                let l = length(d);
                both(a, b, stiffness * (1.0 - rest_length / l) * d);
                both(a, b, damping * self.dot(d, w) / (l * l) * d);
            }
            Force::Gravitation { first, second, constant } => {
                let d = vector_at(x, second) - vector_at(x, first);
                let r = length(d);
                both(first, second, constant * mass(self.scene, first) * mass(self.scene, second) / (r * r * r) * d);
            }
            Force::Vortex { first, second, strength, coupling } => {
                let d = vector_at(x, second) - vector_at(x, first);
                let r = length(d);
                let swirl = strength / r * Vec2::new(-d.y, d.x);
                both(first, second, coupling / (r * r) * (vector_at(v, second) - vector_at(v, first) - swirl));
            }
            Force::SimpleGravity { acceleration } => {
                terms.extend(particles.map(|particle| (particle, mass(self.scene, particle) * acceleration)));
            }
            Force::Constant { force } => terms.extend(particles.map(|particle| (particle, force))),
            Force::Drag { coefficient } => {
                terms.extend(particles.map(|particle| (particle, -coefficient * vector_at(v, particle))));
            }
        }
    }

    fn add_penalty(&mut self, x: &[f64], terms: &mut Vec<(usize, Vec2)>) {
        let Collision::Penalty { stiffness, thickness, detection } = self.scene.collision else { return };
        let (scene, Some(near)) = (self.scene, &mut self.near) else { return };
        // The penalty force between two bodies with the vector `n` between their positions and the sum `radii` of their
        // radii.
        let push = |n: Vec2, radii: f64| {
            let distance = length(n);
            let repels = distance < radii + thickness && !(distance == 0.0 && detection == CollisionDetection::Contest);
            repels.then(|| stiffness * (1.0 - (radii + thickness) / distance) * n)
        };
        near.visit_pairs(x, |pair| {
            let (one, other) = (pair.first as usize, pair.second as usize);
            let (place, radius) = (vector_at(x, one), scene.particles[one].radius);
            match pair.kind {
                PairKind::ParticleParticle => {
                    let n = vector_at(x, other) - place;
                    if let Some(force) = push(n, radius + scene.particles[other].radius) {
                        terms.extend([(one, force), (other, -1.0 * force)]);
                    }
                }
                PairKind::ParticleEdge => {
                    let edge = scene.edges[other];
                    let (x2, x3) = (vector_at(x, edge.first), vector_at(x, edge.second));
                    let along = x3 - x2;
                    let alpha = ((place - x2).dot(&along) / along.dot(&along)).clamp(0.0, 1.0);
                    let n = (1.0 - alpha) * x2 + alpha * x3 - place;
                    if let Some(force) = push(n, radius + edge.radius) {
                        terms.extend([
                            (one, force),
                            (edge.first, -(1.0 - alpha) * force),
                            (edge.second, -alpha * force),
                        ]);
                    }
                }
                PairKind::ParticleHalfPlane => {
                    let plane = scene.half_planes[other];
                    let q = divide(plane.normal, length(plane.normal));
                    let n = (plane.point - place).dot(&q) * q;
                    terms.extend(push(n, radius).map(|force| (one, force)));
                }
            }
        });
    }

    fn dot(&self, a: Vec2, b: Vec2) -> f64 {
        self.arithmetic.add_product(a.x * b.x, a.y, b.y)
    }

    /// Returns `M - h dF/dv - h² dF/dx`, with rows and columns of the identity for fixed particles; `None` with a
    /// vortex.
    pub(super) fn system(&self, x: &[f64], v: &[f64]) -> Option<DMatrix<f64>> {
        let (scene, h) = (self.scene, self.scene.time_step);
        let mut matrix = DMatrix::zeros(x.len(), x.len());
        for k in 0..x.len() {
            matrix[(k, k)] = mass(scene, k / 2);
        }
        for force in &scene.forces {
            match *force {
                Force::Spring { edge, stiffness, rest_length, damping } => {
                    let ends = [scene.edges[edge].first, scene.edges[edge].second];
                    let (d, w) =
                        (vector_at(x, ends[1]) - vector_at(x, ends[0]), vector_at(v, ends[1]) - vector_at(v, ends[0]));
                    let l = length(d);
                    let cube = l * l * l;
                    add_block(&mut matrix, ends, |r, c| {
                        let identity = f64::from(u8::from(r == c));
                        let elastic =
                            stiffness * ((1.0 - rest_length / l) * identity + rest_length / cube * d[r] * d[c]);
                        let left = |k: usize| d[r] * w[k] + f64::from(u8::from(r == k)) * self.dot(d, w);
                        let along = self.arithmetic.add_product(left(0) * d.x, left(1), d.y) / (l * l);
                        let damped = damping / (l * l) * (left(c) - along * d[c]);
                        h * (h * (elastic + damped) + damping * d[r] * d[c] / (l * l))
                    });
                }
                Force::Gravitation { first, second, constant } => {
                    let d = vector_at(x, second) - vector_at(x, first);
                    let square = d.dot(&d);
                    let scale = constant * mass(scene, first) * mass(scene, second) / (square * length(d));
                    add_block(&mut matrix, [first, second], |r, c| {
                        h * h * scale * (f64::from(u8::from(r == c)) - 3.0 * d[r] * d[c] / square)
                    });
                }
                Force::Drag { coefficient } => {
                    for k in 0..x.len() {
                        matrix[(k, k)] += h * coefficient;
                    }
                }
                Force::Vortex { .. } => return None,
                Force::SimpleGravity { .. } | Force::Constant { .. } => {}
            }
        }
        for k in (0..x.len()).filter(|k| scene.particles[k / 2].fixed) {
            matrix.row_mut(k).fill(0.0);
            matrix.column_mut(k).fill(0.0);
            matrix[(k, k)] = 1.0;
        }
        Some(matrix)
    }
}

/// Adds a block on the diagonal for each of two particles, and subtracts it between them.
fn add_block(matrix: &mut DMatrix<f64>, ends: [usize; 2], entry: impl Fn(usize, usize) -> f64) {
    for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let sign = if row == column { 1.0 } else { -1.0 };
        for (r, c) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            matrix[(2 * ends[row] + r, 2 * ends[column] + c)] += sign * entry(r, c);
        }
    }
}
