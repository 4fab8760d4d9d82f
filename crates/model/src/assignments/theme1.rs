//! Theme 1: particles, forces and integrators. Its milestones bring forces and integrators, not collision types.
use super::{COMMON, CollisionType, Definition, Handling, ImpulseList, RecordLists};

/// Explicit Euler and simple gravity.
pub(super) const MILESTONE_1: Definition = Definition {
    key: "t1m1",
    title: "Theme 1, Milestone 1",
    handlings: &[Handling {
        collision: CollisionType::None,
        records: RecordLists { impulses: ImpulseList::Absent, polynomials: false },
        heading: "Collisions disabled",
    }],
    ..COMMON
};

/// Symplectic Euler and all other forces.
pub(super) const MILESTONE_2: Definition = Definition { key: "t1m2", title: "Theme 1, Milestone 2", ..COMMON };

/// The implicit integrators, and with them the forces' Jacobians.
pub(super) const MILESTONE_3: Definition = Definition { key: "t1m3", title: "Theme 1, Milestone 3", ..COMMON };
