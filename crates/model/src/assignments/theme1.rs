//! Theme 1: particles, forces and integrators. Its milestones add forces and integrators, not collision types.
use super::{
    COMMON, CollisionHandling, CollisionType, Definition, ForceKind, ImpulseList, Integrator, LIBRARY, Library, Part,
    RecordLists,
};

/// Explicit Euler and simple gravity.
pub(super) const MILESTONE_1: Definition = Definition {
    key: "t1m1",
    title: "Theme 1, Milestone 1",
    handlings: &[CollisionHandling {
        collision: CollisionType::None,
        records: RecordLists { impulses: ImpulseList::Absent, has_polynomials: false },
        heading: "Collisions disabled",
    }],
    library: Library {
        integrators: &[Integrator::ExplicitEuler],
        forces: &[ForceKind::SimpleGravity],
        collisions: &[CollisionType::None],
        ..LIBRARY
    },
    student: &[Part::Integrator(Integrator::ExplicitEuler), Part::Force(ForceKind::SimpleGravity), Part::KineticEnergy],
    ..COMMON
};

/// Symplectic Euler, springs, gravitation and drag.
pub(super) const MILESTONE_2: Definition = Definition {
    key: "t1m2",
    title: "Theme 1, Milestone 2",
    library: Library {
        integrators: &[Integrator::ExplicitEuler, Integrator::SymplecticEuler],
        forces: &[ForceKind::Spring, ForceKind::SimpleGravity, ForceKind::Gravitation, ForceKind::Drag],
        collisions: &[CollisionType::None],
        ..LIBRARY
    },
    student: &[
        Part::Force(ForceKind::Spring),
        Part::Force(ForceKind::Gravitation),
        Part::Force(ForceKind::Drag),
        Part::Integrator(Integrator::SymplecticEuler),
    ],
    ..COMMON
};

/// The implicit integrators, and with them the forces' Jacobians.
pub(super) const MILESTONE_3: Definition = Definition {
    key: "t1m3",
    title: "Theme 1, Milestone 3",
    library: Library {
        integrators: &[
            Integrator::ExplicitEuler,
            Integrator::SymplecticEuler,
            Integrator::ImplicitEuler,
            Integrator::LinearizedImplicitEuler,
        ],
        forces: &[
            ForceKind::Spring,
            ForceKind::SimpleGravity,
            ForceKind::Gravitation,
            ForceKind::Drag,
            ForceKind::Vortex,
        ],
        collisions: &[CollisionType::None],
        ..LIBRARY
    },
    student: &[
        Part::Jacobians(ForceKind::SimpleGravity),
        Part::Jacobians(ForceKind::Spring),
        Part::Jacobians(ForceKind::Gravitation),
        Part::Jacobians(ForceKind::Drag),
        Part::Integrator(Integrator::LinearizedImplicitEuler),
        // The course gives extra credit for this part.
        Part::Integrator(Integrator::ImplicitEuler),
    ],
    ..COMMON
};
