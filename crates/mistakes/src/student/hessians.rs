//! The matrix of the implicit integrators: mass, and the second derivatives of the forces (simulation.md 3 and 4).
use fosssim_model::scene::Force;
use fosssim_num::vector::{at, length, over};

use super::{StepMistake, author::Student, step_failure::StepFailure, world::World};

/// A 2 x 2 block, `block[row][column]`.
type Matrix2 = [[f64; 2]; 2];

const IDENTITY: Matrix2 = [[1.0, 0.0], [0.0, 1.0]];

/// The system matrix `M + h Hv + h^2 Hx`, column by column, with the rows and columns of fixed particles replaced by
/// those of the identity.
pub fn system_matrix(world: &World, x: &[f64], v: &[f64]) -> Result<Vec<f64>, StepFailure> {
    let (size, h) = (x.len(), world.scene.time_step);
    let makes = |mistake: StepMistake| world.student.makes(mistake);
    let mut a = vec![0.0; size * size];
    let scale = |a: &mut [f64], by: f64| a.iter_mut().for_each(|entry| *entry *= by);
    let add_velocities = |a: &mut [f64]| {
        world.scene.forces.iter().for_each(|force| add_velocity_hessian(world, force, x, a));
    };
    for force in &world.scene.forces {
        add_position_hessian(world, force, x, v, &mut a)?;
    }
    if makes(StepMistake::MatrixNoPositions) {
        a.fill(0.0);
    }
    if makes(StepMistake::MatrixVelocitiesSquared) {
        add_velocities(&mut a);
    }
    if !makes(StepMistake::MatrixPositionsOnce) {
        scale(&mut a, h);
    }
    let is_elsewhere =
        [StepMistake::MatrixNoVelocities, StepMistake::MatrixVelocitiesSquared, StepMistake::MatrixVelocitiesUnscaled];
    if !is_elsewhere.into_iter().any(makes) {
        add_velocities(&mut a);
    }
    scale(&mut a, h);
    if makes(StepMistake::MatrixVelocitiesUnscaled) {
        add_velocities(&mut a);
    }
    if makes(StepMistake::MatrixSigns) {
        scale(&mut a, -1.0);
    }
    if !makes(StepMistake::MatrixNoMass) {
        (0..size).for_each(|k| a[k * size + k] += world.masses[k]);
    }
    let keeps_rows = makes(StepMistake::MatrixRowsOfFixed) || makes(StepMistake::IntegratorFixedForgotten);
    for k in (0..size).filter(|k| world.fixed(k / 2) && !keeps_rows) {
        for other in 0..size {
            a[k * size + other] = 0.0;
            a[other * size + k] = 0.0;
        }
        a[k * size + k] = 1.0;
    }
    Ok(a)
}

/// Adds `block` on the diagonal blocks of particles `a` and `b`, and subtracts it beside the diagonal.
fn add_pair(student: Student, matrix: &mut [f64], size: usize, (a, b): (usize, usize), block: &Matrix2) {
    let beside = match () {
        () if student.makes(StepMistake::JacobianDiagonalOnly) => [0.0, 0.0],
        () if student.makes(StepMistake::JacobianOffDiagonalSign) => [1.0, 1.0],
        () if student.makes(StepMistake::JacobianOneHalf) => [-1.0, 0.0],
        () => [-1.0, -1.0],
    };
    let second = if student.makes(StepMistake::JacobianFirstOnly) { 0.0 } else { 1.0 };
    for (row_particle, column_particle, sign) in [(a, a, 1.0), (b, b, second), (a, b, beside[0]), (b, a, beside[1])] {
        for (row, entries) in block.iter().enumerate() {
            for (column, entry) in entries.iter().enumerate() {
                matrix[(2 * column_particle + column) * size + 2 * row_particle + row] += sign * entry;
            }
        }
    }
}

fn block(entry: impl Fn(usize, usize) -> f64) -> Matrix2 {
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

impl Student {
    /// The block with the weight of the first of these mistakes that the student makes.
    fn weighted_block(self, value: Matrix2, weights: &[(StepMistake, f64)]) -> Matrix2 {
        let weight = self.weight(weights);
        block(|r, c| weight * value[r][c])
    }
}

fn add_position_hessian(
    world: &World,
    force: &Force,
    x: &[f64],
    v: &[f64],
    matrix: &mut [f64],
) -> Result<(), StepFailure> {
    let student = world.student;
    match *force {
        Force::Spring { edge, .. } => {
            let edge = world.scene.edges[edge];
            let ends = (edge.first, edge.second);
            add_pair(student, matrix, x.len(), ends, &elastic_block(world, force, x));
            add_pair(student, matrix, x.len(), ends, &damping_block(world, force, x, v));
        }
        Force::Gravitation { first, second, constant } => {
            let d = at(x, second) - at(x, first);
            let r = length(d);
            let n = if student.makes(StepMistake::JacobianGravitationDirection) { d } else { over(d, r) };
            let cube = if student.makes(StepMistake::JacobianGravitationDistance) { r * r } else { r * r * r };
            let scale = constant * world.masses[2 * second] * world.masses[2 * first] / cube;
            let weights =
                [(StepMistake::JacobianGravitationNoThree, 1.0), (StepMistake::JacobianGravitationNoOuter, 0.0)];
            let three = weights.iter().find(|(mistake, _)| student.makes(*mistake)).map_or(3.0, |(_, weight)| *weight);
            let pull = block(|row, column| (IDENTITY[row][column] - three * n[row] * n[column]) * scale);
            let weights =
                [(StepMistake::JacobianGravitationMissing, 0.0), (StepMistake::JacobianGravitationSign, -1.0)];
            let pull = student.weighted_block(pull, &weights);
            add_pair(student, matrix, x.len(), (first, second), &pull);
        }
        Force::Vortex { .. } => return Err(StepFailure::VortexHessian),
        Force::SimpleGravity { .. } | Force::Constant { .. } | Force::Drag { .. } => {}
    }
    Ok(())
}

/// The second derivatives of a spring's elastic part.
fn elastic_block(world: &World, force: &Force, x: &[f64]) -> Matrix2 {
    let Force::Spring { edge, stiffness, rest_length, .. } = *force else { return Matrix2::default() };
    let student = world.student;
    let makes = |mistake: StepMistake| student.makes(mistake);
    let edge = world.scene.edges[edge];
    let d = at(x, edge.second) - at(x, edge.first);
    let l = length(d);
    let is_long = makes(StepMistake::JacobianElasticDirection) || makes(StepMistake::SpringDirectionEverywhere);
    let n = if is_long { d } else { over(d, l) };
    let outer = block(|r, c| n[r] * n[c]);
    let stretch = if makes(StepMistake::JacobianElasticNoRestLength) { l } else { l - rest_length };
    let inverse = if makes(StepMistake::JacobianElasticNoLength) { 1.0 } else { 1.0 / l };
    let removed = if makes(StepMistake::JacobianElasticNoProjection) { Matrix2::default() } else { outer };
    let tangent = student
        .weight(&[(StepMistake::JacobianElasticNoTangent, 0.0), (StepMistake::JacobianElasticTangentSign, -1.0)]);
    let along = student.weight(&[(StepMistake::JacobianElasticNoOuter, 0.0)]);
    let elastic = block(|r, c| {
        (along * outer[r][c] + tangent * (stretch * (IDENTITY[r][c] - removed[r][c]) * inverse)) * stiffness
    });
    let weights = [
        (StepMistake::JacobianElasticMissing, 0.0),
        (StepMistake::JacobianElasticSign, -1.0),
        (StepMistake::JacobianElasticDoubled, 2.0),
    ];
    student.weighted_block(elastic, &weights)
}

/// The derivatives of a spring's damping by positions.
fn damping_block(world: &World, force: &Force, x: &[f64], v: &[f64]) -> Matrix2 {
    let Force::Spring { edge, damping, .. } = *force else { return Matrix2::default() };
    let student = world.student;
    let makes = |mistake: StepMistake| student.makes(mistake);
    let edge = world.scene.edges[edge];
    let (a, b) = (edge.first, edge.second);
    let d = at(x, b) - at(x, a);
    let l = length(d);
    let is_long = makes(StepMistake::JacobianDampingDirection) || makes(StepMistake::SpringDirectionEverywhere);
    let n = if is_long { d } else { over(d, l) };
    let outer = block(|r, c| n[r] * n[c]);
    let w = at(v, b) - at(v, a);
    let mut damped =
        if makes(StepMistake::JacobianDampingNoOuter) { Matrix2::default() } else { block(|r, c| n[r] * w[c]) };
    if !makes(StepMistake::JacobianDampingNoScalar) {
        damped[0][0] += n.dot(&w);
        damped[1][1] += n.dot(&w);
    }
    let factor = if makes(StepMistake::JacobianDampingNoLength) { -damping } else { -damping / l };
    let removed = if makes(StepMistake::JacobianDampingNoProjection) { Matrix2::default() } else { outer };
    let damped = block(|r, c| (damped[r][c] - (damped[r][0] * removed[0][c] + damped[r][1] * removed[1][c])) * factor);
    let weights = [(StepMistake::JacobianDampingMissing, 0.0), (StepMistake::JacobianDampingSign, -1.0)];
    student.weighted_block(block(|r, c| -damped[r][c]), &weights)
}

fn add_velocity_hessian(world: &World, force: &Force, x: &[f64], matrix: &mut [f64]) {
    let student = world.student;
    let makes = |mistake: StepMistake| student.makes(mistake);
    match *force {
        Force::Spring { edge, damping, .. } => {
            let edge = world.scene.edges[edge];
            let d = at(x, edge.second) - at(x, edge.first);
            let is_long =
                makes(StepMistake::JacobianVelocityDirection) || makes(StepMistake::SpringDirectionEverywhere);
            let n = if is_long { d } else { over(d, length(d)) };
            let along = if makes(StepMistake::JacobianVelocityIdentity) {
                block(|r, c| damping * IDENTITY[r][c])
            } else {
                block(|r, c| damping * n[r] * n[c])
            };
            let weights = [(StepMistake::JacobianVelocityMissing, 0.0), (StepMistake::JacobianVelocitySign, -1.0)];
            let along = student.weighted_block(along, &weights);
            add_pair(student, matrix, x.len(), (edge.first, edge.second), &along);
        }
        Force::Drag { coefficient } => {
            let weights = [(StepMistake::JacobianDragMissing, 0.0), (StepMistake::JacobianDragSign, -1.0)];
            let coefficient = coefficient * student.weight(&weights);
            for k in 0..x.len() {
                matrix[k * x.len() + k] += coefficient;
            }
        }
        _ => {}
    }
}
