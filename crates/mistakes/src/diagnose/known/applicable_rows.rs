//! Finds the rows of the catalog whose mistakes can show in a scene. Only these are tried.
use crate::diagnose::student_code::{changed_term, is_written_by_student};
use fosssim_model::{
    assignments::{ForceKind, Integrator, Part},
    scene::{Collision, Scene},
    sim::{PairKindMap, pairs},
};
use fosssim_student::{Area, Mistake, Row, StepMistake, Term, all_rows};

/// The maximum number of pairs in a scene. In larger scenes, penalty forces between distant bodies are not tried.
const MAX_DISTANT_PAIRS: usize = 5_000;

/// Returns the rows that may explain a trace of the scene, in the order of the catalog. They are mistakes in the code
/// that students write in the scene's assignment. Missing records and faults of nearby pairs are found separately
/// ([`near_pairs`](super::super::near_pairs)).
pub(super) fn applicable_rows(scene: &Scene) -> impl Iterator<Item = &'static Row> {
    let is_elsewhere =
        |row: &Row| row.area == Area::NearPairs || matches!(row.mistake, Mistake::LogNoInitial | Mistake::LogNoMid);
    let (counts, assignment) = (pairs(scene).counts(), scene.assignment());
    let is_theirs = move |row: &&Row| is_written_by_student(row, assignment);
    let is_small = counts.iter().map(|(_, count)| count).sum::<usize>() <= MAX_DISTANT_PAIRS;
    let is_cheap = move |row: &&Row| is_small || !checks_distant_pairs(row);
    all_rows()
        .filter(move |row| !is_elsewhere(row))
        .filter(is_theirs)
        .filter(is_cheap)
        .filter(move |row| is_applicable(scene, &counts, row))
}

/// Returns whether a penalty force with this mistake checks all pairs, even distant ones.
fn checks_distant_pairs(row: &Row) -> bool {
    let Mistake::Step(StepMistake::Edit(edit)) = row.mistake else { return false };
    !edit.slip.keeps_distance() && matches!(changed_term(row).row().part, Part::Penalty(_))
}

/// Returns whether the mistake is in forces, integrators, penalties or simple responses.
pub(super) const fn is_state_mistake(row: &Row) -> bool {
    matches!(row.mistake, Mistake::Step(_))
}

/// Returns whether a program with this mistake may write a different trace. A mistake is excluded only if the scene
/// lacks the stage of a step or the kind of pair that it concerns.
pub fn may_change_trace(scene: &Scene, row: &Row) -> bool {
    is_applicable(scene, &pairs(scene).counts(), row)
}

fn is_applicable(scene: &Scene, counts: &PairKindMap<usize>, row: &Row) -> bool {
    if is_state_mistake(row) {
        return may_change_states(scene, counts, row);
    }
    let has_stage = match (&scene.collision, row.area) {
        (_, Area::Trace) => true,
        (Collision::None | Collision::Penalty { .. }, _) => false,
        (Collision::Simple { .. }, area) => area == Area::Decision,
        (Collision::ContinuousTime { .. }, area) => {
            !matches!(area, Area::ImpulseLoop | Area::ImpactZones | Area::Failsafe)
        }
        (Collision::Hybrid { .. }, area) => area != Area::ContinuousTime,
    };
    has_stage && row.pair_kind().is_none_or(|kind| counts[kind] > 0)
}

/// Returns whether a mistake in forces, integrators, penalties or simple responses may show in the scene.
fn may_change_states(scene: &Scene, counts: &PairKindMap<usize>, row: &Row) -> bool {
    let term = changed_term(row);
    let has_penalty = matches!(scene.collision, Collision::Penalty { .. } | Collision::Hybrid { .. });
    if term == Term::Penalty { has_penalty } else { has_effect(scene, counts, term.row().part) }
}

/// Returns whether a part of the student's code, which changes states, may have an effect in the scene.
pub(in crate::diagnose) fn has_effect(scene: &Scene, counts: &PairKindMap<usize>, part: Part) -> bool {
    let has_force = |kind: ForceKind| scene.forces.iter().any(|force| force.kind() == kind);
    let is_implicit = matches!(scene.integrator, Integrator::LinearizedImplicitEuler | Integrator::ImplicitEuler);
    let is_simple = matches!(scene.collision, Collision::Simple { .. });
    let has_penalty = matches!(scene.collision, Collision::Penalty { .. } | Collision::Hybrid { .. });
    match part {
        Part::Force(kind) => has_force(kind),
        Part::Jacobians(kind) => is_implicit && has_force(kind),
        Part::Integrator(integrator) => scene.integrator == integrator,
        Part::Penalty(kind) => has_penalty && counts[kind] > 0,
        Part::SimpleDetection(kind) | Part::SimpleResponse(kind) => is_simple && counts[kind] > 0,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_model::{assignments::Assignment, scene::CollisionDetection};
    use fosssim_student::{Student, assignments::probe_scenes, record_trace};

    /// A mistake that is not tried on a scene would not change the correct trace of the scene.
    #[test]
    fn inapplicable_mistakes_do_not_change_the_trace() {
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
            let right = record_trace(&scene, Student::default()).ok();
            let is_left_out = |row: &&Row| !may_change_trace(&scene, row);
            for row in all_rows().filter(is_left_out) {
                left_out += 1;
                assert!(record_trace(&scene, Student::new(Some(row.mistake))).ok() == right, "{} on {scene:?}", row.id);
            }
        }
        assert!(left_out > 1000, "{left_out}");
    }

    /// A force between distant bodies takes time proportional to the number of pairs.
    #[test]
    fn on_a_large_scene_no_program_looks_at_all_pairs() {
        let balls = |count: u32| {
            let ball = |at: u32| format!(r#"<particle m="1" px="{at}" py="0" vx="0" vy="1" fixed="0" radius="0.1"/>"#);
            let text = format!(
                r#"<scene><duration time="0.1"/><integrator type="symplectic-euler" dt="0.1"/>
                <collision type="penalty" k="100" thickness="0.01"/>{}</scene>"#,
                (0..count).map(ball).collect::<String>()
            );
            fosssim_model::scene::read("balls", text.as_bytes()).expect("a scene").scene
        };
        let of_apart = |count: u32| applicable_rows(&balls(count)).filter(|row| checks_distant_pairs(row)).count();
        assert!(of_apart(10) > 0);
        assert_eq!(of_apart(400), 0);
    }
}
