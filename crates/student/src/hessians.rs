//! The matrix of the implicit integrators: the mass, and the second derivatives of the forces (simulation.md 3 and 4).
use fosssim_model::scene::{Force, Integrator};
use fosssim_num::vector::{divide, length, vector_at};

use super::{Slip, StepMistake, Term, step_failure::StepFailure, world::World};

/// A block of two rows and two columns, `block[row][column]`.
type Matrix2 = [[f64; 2]; 2];

const IDENTITY: Matrix2 = [[1.0, 0.0], [0.0, 1.0]];

/// Returns the system matrix `M + h Hv + h² Hx`, column by column, with the rows and columns of fixed particles
/// replaced by those of the identity.
pub fn system_matrix(world: &World, x: &[f64], v: &[f64]) -> Result<Vec<f64>, StepFailure> {
    let (size, h) = (x.len(), world.scene.time_step);
    let is_linear = world.scene.integrator == Integrator::LinearizedImplicitEuler;
    let [whole, mass, position_term, velocity_term] = if is_linear {
        [Term::Linear, Term::LinearMass, Term::LinearHx, Term::LinearHv]
    } else {
        [Term::Implicit, Term::ImplicitMass, Term::ImplicitHx, Term::ImplicitHv]
    };
    let makes = |slip: Slip| world.student.makes_slip(whole, slip);
    let sign = if makes(Slip::MatrixSign) { -1.0 } else { 1.0 };
    let mut matrix = HessianSum { world, size, entries: vec![0.0; size * size], uses_velocities: false, weight: 1.0 };
    for (uses_velocities, term) in [(false, position_term), (true, velocity_term)] {
        (matrix.uses_velocities, matrix.weight) = (uses_velocities, sign * world.weight(term, 1.0));
        for force in &world.scene.forces {
            matrix.add_force(force, x, v)?;
        }
        matrix.entries.iter_mut().for_each(|entry| *entry *= h);
    }
    let mut a = matrix.entries;
    let has_unit_mass = world.student.makes_slip(mass, Slip::Mass(-1));
    let weight = if has_unit_mass { 1.0 } else { world.weight(mass, 1.0) };
    for k in 0..size {
        a[k * size + k] += weight * if has_unit_mass { 1.0 } else { world.masses[k] };
    }
    let keeps_rows = makes(Slip::RowsOfFixed) || makes(Slip::FixedForgotten);
    let clears = if makes(Slip::DiagonalOfFixed) { 0 } else { size };
    for k in (0..size).filter(|k| world.is_fixed(k / 2) && !keeps_rows) {
        for other in 0..clears {
            a[k * size + other] = 0.0;
            a[other * size + k] = 0.0;
        }
        a[k * size + k] = 1.0;
    }
    Ok(a)
}

/// The sum of second derivatives so far.
struct HessianSum<'a> {
    world: &'a World,
    size: usize,
    entries: Vec<f64>,
    /// Whether derivatives with respect to velocities are added instead of those with respect to positions.
    uses_velocities: bool,
    weight: f64,
}

impl HessianSum<'_> {
    /// Adds a force's part of the current matrix.
    fn add_force(&mut self, force: &Force, x: &[f64], v: &[f64]) -> Result<(), StepFailure> {
        let world = self.world;
        match *force {
            Force::Spring { edge, .. } => {
                let edge = world.scene.edges[edge];
                let ends = (edge.first, edge.second);
                let l = length(vector_at(x, edge.second) - vector_at(x, edge.first));
                if self.includes_derivative(Term::JacobianSpring, false) {
                    self.add_pair(Term::JacobianElastic, ends, &elastic_block(world, force, x), l);
                    self.add_pair(Term::JacobianDamping, ends, &damping_block(world, force, x, v), l);
                }
                if self.includes_derivative(Term::JacobianVelocity, true) {
                    self.add_pair(Term::JacobianVelocity, ends, &velocity_block(world, force, x), l);
                }
            }
            Force::Gravitation { first, second, .. } if self.includes_derivative(Term::JacobianGravitation, false) => {
                let r = length(vector_at(x, second) - vector_at(x, first));
                self.add_pair(Term::JacobianGravitation, (first, second), &gravitation_block(world, force, x), r);
            }
            Force::Drag { coefficient } if self.includes_derivative(Term::JacobianDrag, true) => {
                for particle in 0..x.len() / 2 {
                    self.add_drag(particle, coefficient);
                }
            }
            Force::Vortex { .. } if !self.uses_velocities => return Err(StepFailure::VortexHessian),
            Force::Gravitation { .. } | Force::Drag { .. } | Force::Vortex { .. } => {}
            Force::SimpleGravity { .. } | Force::Constant { .. } => {}
        }
        Ok(())
    }

    /// Returns whether this student's program adds a derivative to the current matrix.
    fn includes_derivative(&self, term: Term, uses_velocities: bool) -> bool {
        let is_other = self.world.student.makes_slip(term, Slip::OtherMatrix);
        self.uses_velocities == (uses_velocities != is_other)
    }

    /// Adds `block` to the diagonal blocks of particles `a` and `b`, and subtracts it from the two blocks off the
    /// diagonal.
    fn add_pair(&mut self, term: Term, (a, b): (usize, usize), block: &Matrix2, length: f64) {
        let student = self.world.student;
        let has_slips = student.slips(term).next().is_some();
        for (index, (row, column)) in [(a, a), (b, b), (a, b), (b, a)].into_iter().enumerate() {
            let is_left_out = |slip: Slip| match slip {
                Slip::SecondOnly => index == 0,
                Slip::FirstOnly => index == 1,
                Slip::DiagonalOnly => index > 1,
                Slip::OneBlockOffDiagonal => index == 3,
                _ => false,
            };
            if has_slips && student.slips(term).any(is_left_out) {
                continue;
            }
            let is_beside = index > 1;
            let is_other = has_slips && is_beside && student.makes_slip(term, Slip::OffDiagonalSign);
            let sign = if is_beside != is_other { -1.0 } else { 1.0 };
            let slipped = if has_slips { self.world.whole_weight(term, row, length) } else { 1.0 };
            let weight = self.weight * sign * slipped;
            let is_assigned = has_slips && student.makes_slip(term, Slip::Assigned);
            for (r, entries) in block.iter().enumerate() {
                for (c, entry) in entries.iter().enumerate() {
                    let target = &mut self.entries[(2 * column + c) * self.size + 2 * row + r];
                    *target = if is_assigned { weight * entry } else { *target + weight * entry };
                }
            }
        }
    }

    fn add_drag(&mut self, particle: usize, coefficient: f64) {
        let last = self.world.scene.particles.len() - 1;
        for axis in 0..2 {
            let is_left_out = |slip: Slip| match slip {
                Slip::WithoutFirstParticle => particle == 0,
                Slip::WithoutLastParticle => particle == last,
                Slip::OnlyFirstParticle => particle > 0,
                Slip::XOnly => axis == 1,
                Slip::YOnly => axis == 0,
                _ => false,
            };
            let student = self.world.student;
            if student.slips(Term::JacobianDrag).any(is_left_out) {
                continue;
            }
            let value = self.weight * self.world.whole_weight(Term::JacobianDrag, particle, 1.0) * coefficient;
            let entry = &mut self.entries[(2 * particle + axis) * (self.size + 1)];
            *entry = if student.makes_slip(Term::JacobianDrag, Slip::Assigned) { value } else { *entry + value };
        }
    }
}

fn build_block(entry: impl Fn(usize, usize) -> f64) -> Matrix2 {
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

fn gravitation_block(world: &World, force: &Force, x: &[f64]) -> Matrix2 {
    let Force::Gravitation { first, second, constant } = *force else { return Matrix2::default() };
    let student = world.student;
    let d = vector_at(x, second) - vector_at(x, first);
    let r = length(d);
    let n = if student.makes(StepMistake::JacobianGravitationDirection) { d } else { divide(d, r) };
    let scale = constant * world.masses[2 * second] * world.masses[2 * first] / (r * r * r);
    let three = if student.makes(StepMistake::JacobianGravitationNoThree) { 1.0 } else { 3.0 };
    let three = world.weight(Term::JacobianGravitationAlong, r) * three;
    let all = world.weight(Term::JacobianGravitationAll, r);
    build_block(|row, column| (all * IDENTITY[row][column] - three * n[row] * n[column]) * scale)
}

/// Returns the second derivatives of a spring's elastic part.
fn elastic_block(world: &World, force: &Force, x: &[f64]) -> Matrix2 {
    let Force::Spring { edge, stiffness, rest_length, .. } = *force else { return Matrix2::default() };
    let makes = |mistake: StepMistake| world.student.makes(mistake);
    let edge = world.scene.edges[edge];
    let d = vector_at(x, edge.second) - vector_at(x, edge.first);
    let l = length(d);
    let is_long = makes(StepMistake::JacobianElasticDirection) || makes(StepMistake::SpringDirectionEverywhere);
    let n = if is_long { d } else { divide(d, l) };
    let outer = build_block(|r, c| n[r] * n[c]);
    let stretch = if makes(StepMistake::JacobianElasticNoRestLength) { l } else { l - rest_length };
    let is_positive = world.student.makes_slip(Term::JacobianElasticAcross, Slip::Absolute);
    let stretch = if is_positive { stretch.abs() } else { stretch };
    let inverse = if makes(StepMistake::JacobianElasticStrain) { 1.0 / rest_length } else { 1.0 / l };
    let removed = if makes(StepMistake::JacobianElasticNoProjection) { Matrix2::default() } else { outer };
    let across_weight = world.weight(Term::JacobianElasticAcross, l);
    let along_weight = world.weight(Term::JacobianElasticAlong, l);
    build_block(|r, c| {
        (along_weight * outer[r][c] + across_weight * (stretch * (IDENTITY[r][c] - removed[r][c]) * inverse))
            * stiffness
    })
}

/// Returns the derivatives of a spring's damping force with respect to positions.
fn damping_block(world: &World, force: &Force, x: &[f64], v: &[f64]) -> Matrix2 {
    let Force::Spring { edge, damping, .. } = *force else { return Matrix2::default() };
    let makes = |mistake: StepMistake| world.student.makes(mistake);
    let edge = world.scene.edges[edge];
    let (a, b) = (edge.first, edge.second);
    let d = vector_at(x, b) - vector_at(x, a);
    let l = length(d);
    let is_long = makes(StepMistake::JacobianDampingDirection) || makes(StepMistake::SpringDirectionEverywhere);
    let n = if is_long { d } else { divide(d, l) };
    let outer = build_block(|r, c| n[r] * n[c]);
    let w = vector_at(v, b) - vector_at(v, a);
    let outer_weight = world.weight(Term::JacobianDampingOuter, l);
    let mut damped = build_block(|r, c| outer_weight * (n[r] * w[c]));
    let scalar = world.weight(Term::JacobianDampingScalar, l) * n.dot(&w);
    damped[0][0] += scalar;
    damped[1][1] += scalar;
    let factor = -damping / l;
    let removed = if makes(StepMistake::JacobianDampingNoProjection) { Matrix2::default() } else { outer };
    build_block(|r, c| -((damped[r][c] - (damped[r][0] * removed[0][c] + damped[r][1] * removed[1][c])) * factor))
}

/// Returns the derivatives of a spring's damping force with respect to velocities.
fn velocity_block(world: &World, force: &Force, x: &[f64]) -> Matrix2 {
    let Force::Spring { edge, damping, .. } = *force else { return Matrix2::default() };
    let edge = world.scene.edges[edge];
    let d = vector_at(x, edge.second) - vector_at(x, edge.first);
    let n = if world.student.makes(StepMistake::SpringDirectionEverywhere) { d } else { divide(d, length(d)) };
    if world.student.makes(StepMistake::JacobianVelocityIdentity) {
        return build_block(|r, c| damping * IDENTITY[r][c]);
    }
    build_block(|r, c| damping * n[r] * n[c])
}
