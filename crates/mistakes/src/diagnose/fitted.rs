//! Which terms of the forces have a wrong weight, where no mistake that is known explains it.
//!
//! Under the explicit integrators the force on a particle can be read back from the change of its velocity,
//! `m (v1 - v0) / h`. It is a sum of terms that are known from the state before: each kind of force, the elastic part
//! and the damping of springs, the two parts of vortices, the penalty force of each kind of pair. Weights of these
//! terms are fitted by least squares over all kept steps. They are told only if the fit is exact to round-off, the
//! terms can be told apart, and positions follow from velocities as the integrator says.
use super::{
    Detail, Explanation,
    about::About,
    force::{ForceTerm, WrongWeight},
    sampling::{KeptStep, Scan},
};
use crate::student::{Area, Edit, Mistake, Slip, Student, Term, World, force_gradient};
use fosssim_model::{
    scene::{Collision, Force, Integrator, Scene},
    sim::State,
};
use std::{collections::BTreeMap, sync::Arc};

/// Steps that are looked at.
const MOST_STEPS: usize = 24;

/// And particles: the fit takes a row for each coordinate.
const MOST_PARTICLES: usize = 2_000;

/// A force that is read back is known to this many units of the last place of the numbers that it is made of.
const UNITS: f64 = 64.0;

/// Terms are told apart when this share of each is across all others.
const APART: f64 = 1e-4;

/// A weight that is this close to a simple one is that.
const ALIKE: f64 = 1e-7;

/// The terms of these steps whose weight is not 1; nothing where that can't be told.
pub(super) fn explain(scene: &Scene, scan: &Scan) -> Option<Explanation> {
    let is_explicit = matches!(
        scene.integrator,
        Integrator::ExplicitEuler | Integrator::ForwardBackwardEuler | Integrator::SymplecticEuler
    );
    let is_soft = matches!(scene.collision, Collision::None | Collision::Penalty { .. });
    if !is_explicit || !is_soft || scene.particles.len() > MOST_PARTICLES {
        return None;
    }
    // For each term that the scene has, a program with nothing else.
    let programs = programs(scene);
    let steps: Vec<&KeptStep> =
        scan.wrong.iter().take(MOST_STEPS).chain(scan.right.iter().take(MOST_STEPS / 4)).collect();
    // One step is no evidence.
    if scan.wrong.len() < 2 || steps.iter().any(|step| !moves_as_told(scene, step)) {
        return None;
    }
    let mut rows = FitRows { terms: vec![Vec::new(); programs.len()], forces: Vec::new(), bounds: Vec::new() };
    steps.iter().for_each(|step| rows.add(scene, &programs, step));
    let weights = rows.fit()?;
    let of_elements = programs.iter().zip(weights).filter_map(|((term, _), weight)| Some((*term, weight?)));
    let mut of_terms: BTreeMap<ForceTerm, Vec<f64>> = BTreeMap::new();
    of_elements.for_each(|(term, weight)| of_terms.entry(term).or_default().push(weight));
    // A weight that differs from element to element is no factor of the force.
    if of_terms.values().any(|weights| weights.iter().any(|weight| (weight - weights[0]).abs() > ALIKE)) {
        return None;
    }
    let of_terms = of_terms.into_iter().map(|(term, weights)| (term, weights[0]));
    let wrong: Vec<(ForceTerm, f64)> = of_terms.filter(|(_, weight)| (weight - 1.0).abs() > ALIKE).collect();
    if wrong.is_empty() {
        return None;
    }
    let told = wrong.iter().map(|&(term, weight)| (term, simple(weight))).collect();
    let lines = wrong.iter().map(|&(term, weight)| Detail::Force { term, weight });
    let samples = steps.iter().filter(|step| step.difference.is_some()).count() as u64;
    Some(Explanation {
        details: lines.chain([Detail::Look(Area::Forces)]).collect(),
        reproduced: samples,
        samples,
        ..Explanation::about(Explanation::FORCES, About::Forces(told))
    })
}

fn simple(weight: f64) -> WrongWeight {
    let is = |value: f64| (weight - value).abs() <= ALIKE;
    match () {
        () if is(0.0) => WrongWeight::Zero,
        () if is(-1.0) => WrongWeight::MinusOne,
        () if is(2.0) => WrongWeight::Two,
        () if is(0.5) => WrongWeight::Half,
        () => WrongWeight::Other,
    }
}

/// For each term of each element of the scene, a program with nothing else.
fn programs(scene: &Scene) -> Vec<(ForceTerm, World)> {
    let alone = |force: Force| {
        let bare = Scene { forces: vec![force], collision: Collision::None, ..scene.clone() };
        World::new(Arc::new(bare), Student::default())
    };
    let of = |force: &Force| -> Vec<(ForceTerm, Force)> {
        match *force {
            Force::Spring { edge, stiffness, rest_length, damping } => {
                let elastic = Force::Spring { edge, stiffness, rest_length, damping: 0.0 };
                let damped = Force::Spring { edge, stiffness: 0.0, rest_length, damping };
                let parts = [(ForceTerm::SpringElastic, elastic), (ForceTerm::SpringDamping, damped)];
                parts.into_iter().filter(|(term, _)| *term == ForceTerm::SpringElastic || damping != 0.0).collect()
            }
            Force::SimpleGravity { .. } => vec![(ForceTerm::Gravity, *force)],
            Force::Gravitation { .. } => vec![(ForceTerm::Gravitation, *force)],
            Force::Constant { .. } => vec![(ForceTerm::Constant, *force)],
            Force::Drag { .. } => vec![(ForceTerm::Drag, *force)],
            Force::Vortex { .. } => vec![(ForceTerm::Vortex, *force)],
        }
    };
    let forces = scene.forces.iter().flat_map(of).map(|(term, force)| (term, alone(force)));
    let kinds = [
        (ForceTerm::PenaltyParticles, [Term::PenaltyEdges, Term::PenaltyHalfPlanes]),
        (ForceTerm::PenaltyEdges, [Term::PenaltyParticles, Term::PenaltyHalfPlanes]),
        (ForceTerm::PenaltyHalfPlanes, [Term::PenaltyParticles, Term::PenaltyEdges]),
    ];
    let has_penalty = matches!(scene.collision, Collision::Penalty { .. });
    let penalties = kinds.into_iter().filter(|_| has_penalty).map(|(term, others)| {
        let bare = Scene { forces: Vec::new(), ..scene.clone() };
        let without = |term| Some(Mistake::Step(Edit { term, slip: Slip::Missing }.into()));
        let student = others.into_iter().fold(Student::default(), |one, other| one.and(without(other)));
        (term, World::new(Arc::new(bare), student))
    });
    forces.chain(penalties).collect()
}

/// Whether the positions at the end of a step follow from the velocities as this integrator says, and fixed particles
/// keep theirs.
fn moves_as_told(scene: &Scene, kept: &KeptStep) -> bool {
    let State { positions, velocities } = &kept.records.end.state;
    let mut pairs = kept.before.velocities.iter().zip(velocities).enumerate();
    if pairs.any(|(k, (before, after))| scene.particles[k / 2].fixed && before.to_bits() != after.to_bits()) {
        return false;
    }
    let used = if scene.integrator == Integrator::ExplicitEuler { &kept.before.velocities } else { velocities };
    kept.before.positions.iter().zip(used).zip(positions).all(|((x, v), end)| {
        let moved = scene.time_step * v;
        (x + moved - end).abs() <= UNITS * f64::EPSILON * (x.abs() + moved.abs())
    })
}

/// The coordinates of the forces on free particles, in units of how well each is known.
struct FitRows {
    /// The terms' own forces, a list of the same length each.
    terms: Vec<Vec<f64>>,
    forces: Vec<f64>,
    /// How well each force is known, newtons.
    bounds: Vec<f64>,
}

impl FitRows {
    fn add(&mut self, scene: &Scene, programs: &[(ForceTerm, World)], kept: &KeptStep) {
        let (x, v) = (&kept.before.positions, &kept.before.velocities);
        let terms: Vec<Vec<f64>> = programs.iter().map(|(_, program)| force_gradient(program, x, v)).collect();
        for k in (0..x.len()).filter(|k| !scene.particles[k / 2].fixed) {
            let per_step = scene.particles[k / 2].mass / scene.time_step;
            let (before, after) = (v[k], kept.records.end.state.velocities[k]);
            let sum: f64 = terms.iter().map(|term| term[k].abs()).sum();
            self.forces.push(per_step * (after - before));
            self.bounds.push(UNITS * f64::EPSILON * (per_step * (before.abs() + after.abs()) + sum));
            self.terms.iter_mut().zip(&terms).for_each(|(list, term)| list.push(-term[k]));
        }
    }

    /// The weights of all terms, none where a term is zero throughout; `None` where no weights fit to round-off, or
    /// terms can't be told apart.
    fn fit(&self) -> Option<Vec<Option<f64>>> {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        // Gram and Schmidt, twice over: each direction with the weights of the terms that make it.
        let mut directions: Vec<(usize, Vec<f64>, Vec<f64>)> = Vec::new();
        for (index, term) in self.terms.iter().enumerate() {
            let size = dot(term, term).sqrt();
            if size == 0.0 {
                continue;
            }
            let mut across: Vec<f64> = term.iter().map(|value| value / size).collect();
            let mut made_of = vec![0.0; self.terms.len()];
            made_of[index] = 1.0 / size;
            for _ in 0..2 {
                for (_, direction, theirs) in &directions {
                    let along = dot(&across, direction);
                    across.iter_mut().zip(direction).for_each(|(value, other)| *value -= along * other);
                    made_of.iter_mut().zip(theirs).for_each(|(value, other)| *value -= along * other);
                }
            }
            let left = dot(&across, &across).sqrt();
            if !left.is_finite() || left < APART {
                return None;
            }
            across.iter_mut().chain(&mut made_of).for_each(|value| *value /= left);
            directions.push((index, across, made_of));
        }
        let mut weights = vec![0.0; self.terms.len()];
        for (_, direction, made_of) in &directions {
            let along = dot(&self.forces, direction);
            weights.iter_mut().zip(made_of).for_each(|(weight, share)| *weight += along * share);
        }
        weights.iter_mut().for_each(|weight| *weight = rounded(*weight));
        let fits = (0..self.forces.len()).all(|row| {
            let sum: f64 = self.terms.iter().zip(&weights).map(|(term, weight)| weight * term[row]).sum();
            (sum - self.forces[row]).abs() <= self.bounds[row]
        });
        let is_there = |index: usize| directions.iter().any(|(own, ..)| *own == index);
        fits.then(|| weights.iter().enumerate().map(|(index, weight)| is_there(index).then_some(*weight)).collect())
    }
}

/// The simple weight that this is but for round-off: halves of whole numbers. Others stay as they are.
fn rounded(weight: f64) -> f64 {
    let simple = (2.0 * weight).round() / 2.0;
    if (weight - simple).abs() <= ALIKE { simple } else { weight }
}
