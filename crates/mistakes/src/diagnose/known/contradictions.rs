//! Finds mistakes that a trace contradicts, regardless of other mistakes. For example, a stage that does something is
//! not empty.
use crate::diagnose::sampling::{
    CLEAR_TOLERANCE, KeptStep, LoggedNumbers, ROUND_OFF, Scan, StepDifference, find_state_difference,
};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{PairKind, pairs},
};
use fosssim_num::vector::{length, vector_at};
use fosssim_student::{CATALOG, Mistake, Row};

/// Returns the keys of mistakes with which a program never does something that this trace shows. For example, the
/// program never moves a zone, never makes a pass, or never logs a right polynomial of a kind.
pub(super) fn find_contradicted_keys(scene: &Scene, scan: &Scan) -> Vec<String> {
    let samples = || scan.wrong_steps.iter().chain(&scan.right_steps);
    let kinds: Vec<PairKind> = samples().flat_map(|sample| find_right_kinds(scene, sample)).collect();
    let is_hybrid = matches!(scene.collision, Collision::Hybrid { .. });
    let is_done = |row: &&Row| match row.mistake {
        Mistake::ParticleParticleEmpty
        | Mistake::ParticleEdgeEmpty
        | Mistake::HalfPlaneEmpty
        | Mistake::ParticleParticleZero
        | Mistake::ParticleEdgeZero
        | Mistake::HalfPlaneZero => row.pair_kind().is_some_and(|kind| kinds.contains(&kind)),
        Mistake::ImpulsesEmpty | Mistake::ImpulsesEmptySuccess => is_hybrid && samples().any(has_rounds),
        Mistake::GeometricEmpty => is_hybrid && samples().any(|sample| has_passes(sample) || is_moving(sample)),
        Mistake::FailsafeEmpty => is_hybrid && samples().any(is_moving),
        Mistake::FailsafeAlwaysStops => is_hybrid && samples().any(|sample| is_moving(sample) && leaves_start(sample)),
        _ => false,
    };
    CATALOG.iter().filter(is_done).map(|row| row.id.to_owned()).collect()
}

/// Returns the kinds of pairs with a right polynomial before the first wrong one of the step.
fn find_right_kinds(scene: &Scene, sample: &KeptStep) -> Vec<PairKind> {
    let logged_count = sample.records.end.polynomials.len();
    let right = match sample.difference {
        Some(StepDifference::Polynomial(index)) => index.min(logged_count),
        _ => logged_count,
    };
    let (mut next, mut kinds) = (0, Vec::new());
    for pair in pairs(scene).iter() {
        next += pair.kind.polynomial_count();
        if next > right {
            break;
        }
        // A constant polynomial matches any constant with the same sign, even that of another pair.
        let list = &sample.records.end.polynomials;
        let says_something = (next - pair.kind.polynomial_count()..next).any(|index| list.get(index).len() > 1);
        if says_something && !kinds.contains(&pair.kind) {
            kinds.push(pair.kind);
        }
    }
    kinds
}

fn has_rounds(sample: &KeptStep) -> bool {
    sample.records.mid.as_ref().is_some_and(|mid| !mid.polynomials.is_empty())
}

fn has_passes(sample: &KeptStep) -> bool {
    let (mid, end) = (&sample.records.mid, &sample.records.end);
    mid.as_ref().is_some_and(|mid| end.polynomials.len() > mid.polynomials.len())
}

/// Returns whether the end state of the step differs from its mid state.
fn is_moving(sample: &KeptStep) -> bool {
    let end = &sample.records.end.state;
    let is_sound = end.positions.iter().chain(&end.velocities).all(|value| value.is_finite());
    let is_different = |mid: &LoggedNumbers| find_state_difference(&mid.state, end, &ROUND_OFF).is_some();
    is_sound && sample.records.mid.as_ref().is_some_and(is_different)
}

/// Returns whether the geometric part moves a particle and leaves it away from its start.
fn leaves_start(sample: &KeptStep) -> bool {
    let Some(mid) = &sample.records.mid else { return false };
    let end = &sample.records.end.state.positions;
    let is_different = |ours: &[f64], particle: usize| {
        length(vector_at(ours, particle) - vector_at(end, particle))
            > CLEAR_TOLERANCE.state * (1.0 + length(vector_at(end, particle)))
    };
    (0..end.len() / 2).any(|particle| {
        is_different(&mid.state.positions, particle) && is_different(&sample.before.positions, particle)
    })
}
