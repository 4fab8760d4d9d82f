//! Theme 1 and Theme 2, Milestone 1.
use super::{CollisionType, Definition, Dropping, Handling, ImpulseList, Records};

/// No detection logs polynomials; the course's root finder comes with the next milestone.
pub(super) const DEFINITION: Definition = Definition {
    key: "earlier",
    title: "Theme 1 and Theme 2, Milestone 1",
    handlings: &[
        Handling {
            collision: CollisionType::None,
            records: Records { impulses: ImpulseList::Absent, polynomials: false },
            heading: "Collisions disabled",
        },
        Handling {
            collision: CollisionType::Simple,
            records: Records { impulses: ImpulseList::Responses, polynomials: false },
            heading: "Simple Collision Handling",
        },
        Handling {
            collision: CollisionType::Penalty,
            records: Records { impulses: ImpulseList::Absent, polynomials: false },
            heading: "Collisions disabled",
        },
    ],
    pairs: &[],
    dropping: Dropping::Leading,
    version: "Fall 2010 v.A",
};
