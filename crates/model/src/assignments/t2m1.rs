//! Theme 2, Milestone 1: collisions at the end of a step, and the penalty force (collisions.md 6, simulation.md 3).
use super::{
    COMMON, CollisionHandling, CollisionType, Definition, ImpulseList, LIBRARY, Library, PairKind, Part, RecordLists,
};

/// The rules of the assignment. No detection logs polynomials, because the course's root finder comes with the next
/// milestone.
pub(super) const DEFINITION: Definition = Definition {
    key: "t2m1",
    title: "Theme 2, Milestone 1",
    handlings: &[
        CollisionHandling {
            collision: CollisionType::Simple,
            records: RecordLists { impulses: ImpulseList::Responses, has_polynomials: false },
            heading: "Simple Collision Handling",
        },
        CollisionHandling {
            collision: CollisionType::Penalty,
            records: RecordLists { impulses: ImpulseList::Absent, has_polynomials: false },
            heading: "Collisions disabled",
        },
    ],
    library: Library {
        collisions: &[CollisionType::None, CollisionType::Simple, CollisionType::Penalty],
        rejects_collisions: true,
        ..LIBRARY
    },
    student: &[
        Part::SimpleDetection(PairKind::ParticleParticle),
        Part::SimpleDetection(PairKind::ParticleEdge),
        Part::SimpleDetection(PairKind::ParticleHalfPlane),
        Part::SimpleResponse(PairKind::ParticleParticle),
        Part::SimpleResponse(PairKind::ParticleEdge),
        Part::SimpleResponse(PairKind::ParticleHalfPlane),
        Part::Penalty(PairKind::ParticleParticle),
        Part::Penalty(PairKind::ParticleEdge),
        Part::Penalty(PairKind::ParticleHalfPlane),
    ],
    ..COMMON
};
