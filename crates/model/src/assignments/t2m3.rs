//! Theme 2, Milestone 3: the contest, a penalty force between many bodies that finds its pairs fast (simulation.md 3).
use super::{COMMON, CollisionType, Definition, Integrator, LIBRARY, Library, Part};

/// The rules of the assignment. It adds no collision type: its scenes are `penalty` scenes with the contest's
/// detection.
pub(super) const DEFINITION: Definition = Definition {
    key: "t2m3",
    title: "Theme 2, Milestone 3",
    verdict: "Hybrid Collisions Passed",
    prints_times: true,
    library: Library {
        integrators: &[
            Integrator::ExplicitEuler,
            Integrator::ForwardBackwardEuler,
            Integrator::ImplicitEuler,
            Integrator::LinearizedImplicitEuler,
        ],
        collisions: &[CollisionType::Penalty],
        has_contest: true,
        ..LIBRARY
    },
    student: &[Part::NearPairs],
    ..COMMON
};
