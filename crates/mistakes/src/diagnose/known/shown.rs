//! Which rows of the catalogue a scene can show at all: no others are tried on it.
use crate::student::{Area, CATALOGUE, Mistake, Row, RowKind};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{ByKind, pairs},
};

/// The rows that may explain a trace of this scene, in the order of the catalogue. Records that are missing are looked
/// for elsewhere.
pub(super) fn applicable(scene: &Scene) -> impl Iterator<Item = &'static Row> {
    let is_tried =
        |row: &&Row| row.kind != RowKind::Hostile && !matches!(row.mistake, Mistake::LogNoInitial | Mistake::LogNoMid);
    let counts = pairs(scene).counts();
    CATALOGUE.iter().filter(is_tried).filter(move |row| shows(&scene.collision, &counts, row))
}

/// Whether a program with this row may leave another trace than one without. Only what the scene does not have speaks
/// against it: stages of a step, and kinds of pairs.
pub(super) fn can_show(scene: &Scene, row: &Row) -> bool {
    shows(&scene.collision, &pairs(scene).counts(), row)
}

fn shows(collision: &Collision, counts: &ByKind<usize>, row: &Row) -> bool {
    let has_stage = match (collision, row.area) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        assignments::probe_scenes,
        student::{Student, trace},
    };
    use fosssim_model::{assignments::Assignment, scene::CollisionDetection};

    /// What is not tried on a scene would leave the right trace of it.
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
            for row in CATALOGUE.iter().filter(|row| row.kind != RowKind::Hostile && !can_show(&scene, row)) {
                left_out += 1;
                assert!(trace(&scene, Student::new(Some(row.mistake))).ok() == right, "{} on {scene:?}", row.id);
            }
        }
        assert!(left_out > 1000, "{left_out}");
    }
}
