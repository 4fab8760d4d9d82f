//! Theme 2, Milestone 2 (trace-format.md 2, collisions.md).
use super::{COMMON, CollisionHandling, CollisionType, Definition, ImpulseList, PairKind, Part, RecordLists};

pub(super) const DEFINITION: Definition = Definition {
    key: "t2m2",
    title: "Theme 2, Milestone 2",
    handlings: &[
        CollisionHandling {
            collision: CollisionType::ContinuousTime,
            records: RecordLists { impulses: ImpulseList::Responses, has_polynomials: true },
            heading: "Continuous-Time Collision Handling",
        },
        CollisionHandling {
            collision: CollisionType::Hybrid,
            records: RecordLists { impulses: ImpulseList::Empty, has_polynomials: true },
            heading: "Hybrid Collision Handling",
        },
    ],
    pairs: &PairKind::ALL,
    student: &[
        Part::Detection(PairKind::ParticleParticle),
        Part::Detection(PairKind::ParticleEdge),
        Part::Detection(PairKind::ParticleHalfPlane),
        Part::Impulses,
        Part::Zones,
        Part::Failsafe,
    ],
    ..COMMON
};
