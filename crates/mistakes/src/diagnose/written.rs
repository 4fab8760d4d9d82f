//! Which mistakes a student of a milestone can make: those in the parts that the student writes.
use crate::student::{Area, Mistake, Row};
use fosssim_model::{
    assignments::{Assignment, ForceKind, Part},
    scene::{Integrator, Scene},
};

/// Whether a student of this milestone writes the code in which the mistake is made. Each integrator has a file of its
/// own; what is written to a trace, and how a program ends, may be anybody's.
pub(super) fn is_written(row: &Row, whose: Assignment, integrator: Integrator) -> bool {
    let (is_simple, mut words) = (matches!(row.mistake, Mistake::Step(_)), row.id.split('-'));
    let (first, second) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
    let is_of = |part: &Part| match (row.area, *part) {
        (Area::Trace | Area::Process, _) => true,
        (Area::Forces, Part::Force(kind)) => force_kinds(first).contains(&kind),
        (Area::Jacobians, Part::Jacobians(kind)) => force_kinds(second).contains(&kind),
        (Area::Integrator, Part::Integrator(_)) => part.file() == Part::Integrator(integrator).file(),
        (Area::Penalty, Part::Penalty(_)) | (Area::NearPairs, Part::NearPairs) => true,
        (Area::Decision | Area::Response, Part::SimpleDetection(_) | Part::SimpleResponse(_)) => true,
        (Area::Response | Area::ImpulseLoop, Part::Impulses) => !is_simple,
        (Area::ImpactZones, Part::Zones) | (Area::Failsafe, Part::Failsafe) => true,
        (area, Part::Detection(_)) => {
            let others = [Area::ImpulseLoop, Area::ImpactZones, Area::Failsafe];
            !(is_simple || is_of_states(area) || others.contains(&area))
        }
        _ => false,
    };
    whose.definition().student.iter().any(is_of)
}

const fn is_of_states(area: Area) -> bool {
    matches!(area, Area::Forces | Area::Jacobians | Area::Integrator | Area::Penalty | Area::NearPairs)
}

/// The forces of which a row speaks whose name has this word.
pub(super) const fn force_kinds(word: &str) -> &'static [ForceKind] {
    match word.as_bytes() {
        b"gravity" => &[ForceKind::SimpleGravity],
        b"constant" => &[ForceKind::Constant],
        b"drag" => &[ForceKind::Drag],
        b"gravitation" => &[ForceKind::Gravitation],
        b"vortex" => &[ForceKind::Vortex],
        b"spring" | b"elastic" | b"damping" | b"velocity" => &[ForceKind::Spring],
        _ => &[ForceKind::Spring, ForceKind::Gravitation],
    }
}

/// The milestone of a submission that runs on these scenes: the first one whose programs know all of them.
#[must_use]
pub fn milestone<'a>(scenes: impl IntoIterator<Item = &'a Scene>) -> Option<Assignment> {
    let of_scene = |scene: &'a Scene| scene.assignments().collect::<Vec<_>>();
    let common = scenes
        .into_iter()
        .map(of_scene)
        .reduce(|one, other| one.into_iter().filter(|assignment| other.contains(assignment)).collect::<Vec<_>>());
    common?.first().copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::student::{all_rows, find};

    #[test]
    fn only_the_students_own_code_is_accused() {
        let writes = |id: &str, whose, integrator| is_written(find(id).expect("a row"), whose, integrator);
        let (explicit, symplectic) = (Integrator::ExplicitEuler, Integrator::SymplecticEuler);
        assert!(writes("integrator-no-mass", Assignment::T1M1, explicit));
        assert!(!writes("integrator-no-mass", Assignment::T1M2, explicit));
        assert!(writes("integrator-no-mass", Assignment::T1M2, symplectic));
        assert!(
            writes("drag-missing", Assignment::T1M2, explicit) && !writes("drag-missing", Assignment::T1M3, explicit)
        );
        assert!(!writes("vortex-missing", Assignment::T1M2, symplectic));
        assert!(writes("penalty-missing", Assignment::T2M1, explicit));
        for row in all_rows() {
            // The contest's student writes the search for pairs.
            let is_own = matches!(row.area, Area::NearPairs | Area::Trace | Area::Process);
            assert_eq!(is_written(row, Assignment::T2M3, symplectic), is_own, "{}", row.id);
            let is_of_collisions = !is_of_states(row.area) && !matches!(row.mistake, Mistake::Step(_));
            assert_eq!(is_written(row, Assignment::T2M2, symplectic), is_of_collisions, "{}", row.id);
        }
    }
}
