//! The matrix of the implicit integrators: mass, and the second derivatives of the forces (simulation.md 3 and 4).
use fosssim_model::scene::Force;
use fosssim_num::vector::{at, length, over};

use super::{step_failure::StepFailure, world::World};

/// A 2 x 2 block, `block[row][column]`.
type Matrix2 = [[f64; 2]; 2];

const IDENTITY: Matrix2 = [[1.0, 0.0], [0.0, 1.0]];

/// The system matrix `M + h Hv + h^2 Hx`, column by column, with the rows and columns of fixed particles replaced by
/// those of the identity.
pub fn system_matrix(world: &World, x: &[f64], v: &[f64]) -> Result<Vec<f64>, StepFailure> {
    let size = x.len();
    let h = world.scene.time_step;
    let mut a = vec![0.0; size * size];
    for force in &world.scene.forces {
        add_position_hessian(world, force, x, v, &mut a)?;
    }
    a.iter_mut().for_each(|entry| *entry *= h);
    for force in &world.scene.forces {
        add_velocity_hessian(world, force, x, &mut a);
    }
    a.iter_mut().for_each(|entry| *entry *= h);
    for k in 0..size {
        a[k * size + k] += world.masses[k];
    }
    for k in (0..size).filter(|k| world.fixed(k / 2)) {
        for other in 0..size {
            a[k * size + other] = 0.0;
            a[other * size + k] = 0.0;
        }
        a[k * size + k] = 1.0;
    }
    Ok(a)
}

/// Adds `block` on the diagonal blocks of particles `a` and `b`, and subtracts it beside the diagonal.
fn add_pair(matrix: &mut [f64], size: usize, (a, b): (usize, usize), block: &Matrix2) {
    for (row_particle, column_particle, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
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

fn add_position_hessian(
    world: &World,
    force: &Force,
    x: &[f64],
    v: &[f64],
    matrix: &mut [f64],
) -> Result<(), StepFailure> {
    match *force {
        Force::Spring { edge, stiffness, rest_length, damping } => {
            let edge = world.scene.edges[edge];
            let (a, b) = (edge.first, edge.second);
            let d = at(x, b) - at(x, a);
            let l = length(d);
            let n = over(d, l);
            let outer = block(|r, c| n[r] * n[c]);
            let stretch = l - rest_length;
            let elastic =
                block(|r, c| (outer[r][c] + stretch * (IDENTITY[r][c] - outer[r][c]) * (1.0 / l)) * stiffness);
            add_pair(matrix, x.len(), (a, b), &elastic);
            let w = at(v, b) - at(v, a);
            let mut damped = block(|r, c| n[r] * w[c]);
            damped[0][0] += n.dot(&w);
            damped[1][1] += n.dot(&w);
            let factor = -damping / l;
            let damped =
                block(|r, c| (damped[r][c] - (damped[r][0] * outer[0][c] + damped[r][1] * outer[1][c])) * factor);
            add_pair(matrix, x.len(), (a, b), &block(|r, c| -damped[r][c]));
        }
        Force::Gravitation { first, second, constant } => {
            let d = at(x, second) - at(x, first);
            let r = length(d);
            let n = over(d, r);
            let scale = constant * world.masses[2 * second] * world.masses[2 * first] / (r * r * r);
            let pull = block(|row, column| (IDENTITY[row][column] - 3.0 * n[row] * n[column]) * scale);
            add_pair(matrix, x.len(), (first, second), &pull);
        }
        Force::Vortex { .. } => return Err(StepFailure::VortexHessian),
        Force::SimpleGravity { .. } | Force::Constant { .. } | Force::Drag { .. } => {}
    }
    Ok(())
}

fn add_velocity_hessian(world: &World, force: &Force, x: &[f64], matrix: &mut [f64]) {
    match *force {
        Force::Spring { edge, damping, .. } => {
            let edge = world.scene.edges[edge];
            let d = at(x, edge.second) - at(x, edge.first);
            let n = over(d, length(d));
            add_pair(matrix, x.len(), (edge.first, edge.second), &block(|r, c| damping * n[r] * n[c]));
        }
        Force::Drag { coefficient } => {
            for k in 0..x.len() {
                matrix[k * x.len() + k] += coefficient;
            }
        }
        _ => {}
    }
}
