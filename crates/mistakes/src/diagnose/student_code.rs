//! Decides which mistakes a student of a milestone can make. These are the mistakes in the parts that the student
//! writes.
use super::fault::StageFault;
use fosssim_model::{
    assignments::{Assignment, Part},
    scene::Scene,
};
use fosssim_student::{Area, Mistake, Row, StepMistake, Term};

/// Returns whether a student of this milestone writes the code of the mistake, or submits its file. Every student can
/// change the trace's contents.
pub fn is_written_by_student(row: &Row, whose: Assignment) -> bool {
    let is_of = |part: &Part| match (row.area, *part) {
        (Area::Trace, _) | (Area::NearPairs, Part::NearPairs) => true,
        (Area::NearPairs, _) => false,
        _ if matches!(row.mistake, Mistake::Step(_)) => part.file() == changed_term(row).row().part.file(),
        (Area::Response | Area::ImpulseLoop, Part::Impulses) => true,
        (Area::ImpactZones, Part::Zones) | (Area::Failsafe, Part::Failsafe) => true,
        (area, Part::Detection(_)) => ![Area::ImpulseLoop, Area::ImpactZones, Area::Failsafe].contains(&area),
        _ => false,
    };
    whose.definition().student.iter().any(is_of)
}

/// Returns whether the mistake of `row` is in the code that may contain `fault`.
pub(super) fn may_contain(fault: &StageFault, row: &Row) -> bool {
    match (fault, row.mistake) {
        // A row about all kinds of pairs has the part of one of them.
        (StageFault::Change(change), Mistake::Step(_)) if changed_term(row) != Term::Penalty => {
            change.parts.contains(&changed_term(row).row().part)
        }
        _ => fault.areas().contains(&row.area),
    }
}

/// Returns the term that a mistake changes; the row's id begins with its name.
pub(super) fn changed_term(row: &Row) -> Term {
    if let Mistake::Step(StepMistake::Edit(edit)) = row.mistake {
        return edit.term;
    }
    let mut parts = row.id.split('-');
    match (row.area, parts.next().unwrap_or_default(), parts.next().unwrap_or_default()) {
        (Area::Forces, "drag", _) => Term::Drag,
        (Area::Forces, "gravitation", _) => Term::Gravitation,
        (Area::Forces, ..) => Term::Spring,
        (Area::Jacobians, _, "gravitation") => Term::JacobianGravitation,
        (Area::Jacobians, ..) => Term::JacobianSpring,
        (Area::Integrator, "linear", _) => Term::Linear,
        (Area::Integrator, ..) => Term::Implicit,
        (_, "penalty", "both") => Term::PenaltyParticles,
        (_, "penalty", "first") => Term::PenaltyHalfPlanes,
        _ => Term::Penalty,
    }
}

/// Returns the milestone of a submission that runs on `scenes`: the first whose programs accept all of them. Returns
/// `None` if there are no scenes, or if no milestone's programs accept all of them.
pub fn find_milestone<'a>(scenes: impl IntoIterator<Item = &'a Scene>) -> Option<Assignment> {
    let assignments = |scene: &'a Scene| scene.assignments().collect::<Vec<_>>();
    let common = scenes
        .into_iter()
        .map(assignments)
        .reduce(|one, other| one.into_iter().filter(|assignment| other.contains(assignment)).collect::<Vec<_>>());
    common?.first().copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_student::{all_rows, find};

    #[test]
    fn only_the_students_own_code_is_reported() {
        let writes = |id: &str, whose| is_written_by_student(find(id).expect("a row"), whose);
        assert!(writes("explicit-velocities-mass", Assignment::T1M1));
        assert!(!writes("explicit-velocities-mass", Assignment::T1M2));
        assert!(writes("symplectic-velocities-mass", Assignment::T1M2));
        assert!(writes("drag-missing", Assignment::T1M2) && !writes("drag-missing", Assignment::T2M1));
        assert!(writes("penalty-sign", Assignment::T2M1));
        for row in all_rows() {
            // The contest's student writes the search for pairs.
            let is_own = matches!(row.area, Area::NearPairs | Area::Trace);
            assert_eq!(is_written_by_student(row, Assignment::T2M3), is_own, "{}", row.id);
            let is_of_collisions = !matches!(row.mistake, Mistake::Step(_));
            assert_eq!(is_written_by_student(row, Assignment::T2M2), is_of_collisions, "{}", row.id);
        }
    }
}
