//! Which rows of the catalogue a scene can show at all: no others are tried on it.
use crate::{
    diagnose::written::force_kinds,
    student::{Area, Mistake, Row, RowKind, StepMistake, all_rows},
};
use fosssim_model::{
    scene::{Collision, Integrator, Scene},
    sim::{ByKind, PairKind, pairs},
    trace::Layout,
};

/// The rows that may explain a trace of this scene, in the order of the catalogue. Where steps log polynomials, the
/// course supplies forces and integrators, so that their rows come last. Records that are missing are looked for
/// elsewhere.
pub(super) fn applicable(scene: &Scene) -> impl Iterator<Item = &'static Row> {
    let is_tried =
        |row: &&Row| row.kind != RowKind::Hostile && !matches!(row.mistake, Mistake::LogNoInitial | Mistake::LogNoMid);
    let counts = pairs(scene).counts();
    let mut rows: Vec<_> = all_rows().filter(is_tried).filter(|row| shows(scene, &counts, row)).collect();
    let logs_polynomials = Layout::of(scene).polynomials;
    rows.sort_by_key(|row| logs_polynomials && is_of_states(row));
    rows.into_iter()
}

/// Whether the mistake is one of forces, integrators, penalties or simple responses.
pub(super) const fn is_of_states(row: &Row) -> bool {
    matches!(row.mistake, Mistake::Step(_))
}

/// Whether a program with this row may leave another trace than one without. Only what the scene does not have speaks
/// against it: stages of a step, and kinds of pairs.
#[must_use]
pub fn can_show(scene: &Scene, row: &Row) -> bool {
    shows(scene, &pairs(scene).counts(), row)
}

fn shows(scene: &Scene, counts: &ByKind<usize>, row: &Row) -> bool {
    if is_of_states(row) {
        return shows_in_states(scene, counts, row);
    }
    let has_stage = match (&scene.collision, row.area) {
        (_, Area::Trace | Area::Process) => true,
        (Collision::None | Collision::Penalty { .. }, _) => false,
        (Collision::Simple { .. }, area) => matches!(area, Area::Decision | Area::Response),
        (Collision::ContinuousTime { .. }, area) => {
            !matches!(area, Area::ImpulseLoop | Area::ImpactZones | Area::Failsafe)
        }
        (Collision::Hybrid { .. }, area) => area != Area::ContinuousTime,
    };
    has_stage && row.kind_of_pair().is_none_or(|kind| counts[kind] > 0)
}

/// The same of mistakes of forces, integrators and what follows from them: a row's name begins with what it is about.
fn shows_in_states(scene: &Scene, counts: &ByKind<usize>, row: &Row) -> bool {
    let is_linear = scene.integrator == Integrator::LinearizedImplicitEuler;
    let is_implicit = is_linear || scene.integrator == Integrator::ImplicitEuler;
    let has_force = |name: &str| scene.forces.iter().any(|force| force_kinds(name).contains(&force.kind()));
    let mut words = row.id.split('-');
    let (first, second) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
    let has_kind = |name: &str| match name {
        "particles" => counts[PairKind::ParticleParticle] > 0,
        "edge" | "edges" => counts[PairKind::ParticleEdge] > 0,
        "half" | "normal" => counts[PairKind::ParticleHalfPlane] > 0,
        _ => true,
    };
    match row.area {
        Area::Forces => has_force(first),
        Area::Jacobians => is_implicit && has_force(second),
        Area::Integrator => match (first, row.mistake) {
            ("linear", _) => is_linear,
            ("matrix" | "right", _) | (_, Mistake::Step(StepMistake::ImplicitPositionWithoutChange)) => is_implicit,
            ("implicit", _) => scene.integrator == Integrator::ImplicitEuler,
            (_, Mistake::Step(StepMistake::IntegratorVelocityFirst)) => scene.integrator == Integrator::ExplicitEuler,
            (_, Mistake::Step(StepMistake::IntegratorPositionFirst)) => {
                matches!(scene.integrator, Integrator::SymplecticEuler | Integrator::ForwardBackwardEuler)
            }
            (_, Mistake::Step(mistake)) if is_of_acceleration(mistake) => !is_implicit,
            _ => true,
        },
        Area::Penalty | Area::NearPairs => {
            matches!(scene.collision, Collision::Penalty { .. } | Collision::Hybrid { .. }) && has_kind(second)
        }
        _ => matches!(scene.collision, Collision::Simple { .. }),
    }
}

/// Whether a mistake is made where forces become accelerations, which implicit integrators do in their system.
const fn is_of_acceleration(mistake: StepMistake) -> bool {
    matches!(
        mistake,
        StepMistake::IntegratorForceBehindPositions
            | StepMistake::IntegratorForceSign
            | StepMistake::IntegratorNoMass
            | StepMistake::IntegratorMassMultiplied
            | StepMistake::IntegratorNoStepForVelocities
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        assignments::probe_scenes,
        student::{Student, trace},
    };
    use fosssim_model::{assignments::Assignment, scene::CollisionDetection};

    /// A mistake that is not tried on a scene would leave the right trace of it.
    #[test]
    fn what_a_scene_can_not_show_leaves_its_trace_as_it_is() {
        let mut left_out = 0;
        let mut scenes: Vec<Scene> = probe_scenes(Assignment::T2M2).into_iter().map(|(_, scene)| scene).collect();
        let bare = scenes.iter().step_by(5).cloned();
        let others: Vec<Scene> = bare
            .flat_map(|scene| {
                let collisions = [
                    Collision::None,
                    Collision::Penalty { stiffness: 100.0, thickness: 0.1, detection: CollisionDetection::AllPairs },
                    Collision::Simple { restitution: 0.5 },
                ];
                collisions.map(|collision| Scene { collision, ..scene.clone() })
            })
            .collect();
        scenes.extend(others);
        for scene in scenes {
            let right = trace(&scene, Student::default()).ok();
            let is_left_out = |row: &&Row| row.kind != RowKind::Hostile && !can_show(&scene, row);
            for row in all_rows().filter(is_left_out) {
                left_out += 1;
                assert!(trace(&scene, Student::new(Some(row.mistake))).ok() == right, "{} on {scene:?}", row.id);
            }
        }
        assert!(left_out > 1000, "{left_out}");
    }
}
