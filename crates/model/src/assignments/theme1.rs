//! Theme 1: particles, forces and integrators. Its milestones bring forces and integrators, not collision types.
use super::{CollisionType, Definition, Dropping, Handling, ImpulseList, RecordLists};

const fn milestone(key: &'static str, title: &'static str, handlings: &'static [Handling]) -> Definition {
    Definition {
        key,
        title,
        handlings,
        pairs: &[],
        dropping: Dropping::Leading,
        version: "Fall 2010 v.A",
        verdict: "Collisions Passed",
        tells_times: false,
    }
}

/// Explicit Euler and simple gravity.
pub(super) const MILESTONE_1: Definition = milestone(
    "t1m1",
    "Theme 1, Milestone 1",
    &[Handling {
        collision: CollisionType::None,
        records: RecordLists { impulses: ImpulseList::Absent, polynomials: false },
        heading: "Collisions disabled",
    }],
);

/// Symplectic Euler and all other forces.
pub(super) const MILESTONE_2: Definition = milestone("t1m2", "Theme 1, Milestone 2", &[]);

/// The implicit integrators, and with them the forces' Jacobians.
pub(super) const MILESTONE_3: Definition = milestone("t1m3", "Theme 1, Milestone 3", &[]);
