//! The course's assignments: what each assignment's programs detect, log and drop, the features of its starter library,
//! and the parts written by its student.
//!
//! Each [`Definition`] contains this as data, one file per assignment. Everything else that depends on an assignment
//! (suites, the catalog of mistakes, formulas, probe scenes) is in a folder `assignments/<key>` of the crate that
//! needs it. Readers of traces, simulator and judge use the assignment of a scene, which follows from its collision
//! type ([`Assignment::for_collisions`]). This module does not use scenes, states or files.

mod collision_type;
mod force_kind;
mod integrator;
mod pair_kind;
mod part;
mod t2m1;
mod t2m2;
mod t2m3;
mod theme1;

pub use collision_type::CollisionType;
pub use force_kind::ForceKind;
pub use integrator::Integrator;
pub use pair_kind::PairKind;
pub use part::Part;

use serde::{Deserialize, Serialize};

fosssim_num::closed_set! {
    /// An assignment of the course.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    pub enum Assignment {
        /// Theme 1, Milestone 1: explicit Euler and simple gravity.
        T1M1,
        /// Theme 1, Milestone 2: symplectic Euler, springs, gravitation and drag.
        T1M2,
        /// Theme 1, Milestone 3: the implicit integrators.
        T1M3,
        /// Theme 2, Milestone 1: collisions at the end of a step, and the penalty force.
        T2M1,
        /// Theme 2, Milestone 2: continuous-time detection, impulses, impact zones and the rigid failsafe of colliding
        /// bodies.
        T2M2,
        /// Theme 2, Milestone 3: the contest, a penalty force between many bodies.
        T2M3,
    }
}

impl Assignment {
    /// The default assignment.
    pub const DEFAULT: Self = Self::T2M2;

    /// Returns all assignments: the default one, then the others in the order of the course.
    pub fn list_default_first() -> [Self; Self::ALL.len()] {
        let mut all = Self::ALL;
        all.sort_by_key(|assignment| *assignment != Self::DEFAULT);
        all
    }

    /// Returns the rules of the assignment.
    pub const fn definition(self) -> &'static Definition {
        match self {
            Self::T1M1 => &theme1::MILESTONE_1,
            Self::T1M2 => &theme1::MILESTONE_2,
            Self::T1M3 => &theme1::MILESTONE_3,
            Self::T2M1 => &t2m1::DEFINITION,
            Self::T2M2 => &t2m2::DEFINITION,
            Self::T2M3 => &t2m3::DEFINITION,
        }
    }

    /// Returns the assignment that introduced a collision type.
    pub const fn for_collisions(collision: CollisionType) -> Self {
        match collision {
            CollisionType::None => Self::T1M1,
            CollisionType::Simple | CollisionType::Penalty => Self::T2M1,
            CollisionType::ContinuousTime | CollisionType::Hybrid => Self::T2M2,
        }
    }

    /// Returns the assignment's key, which names its suite and its folders.
    pub const fn key(self) -> &'static str {
        self.definition().key
    }

    /// Returns the assignment with the key, or `None` if no assignment has it.
    pub fn from_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|assignment| assignment.key() == key)
    }
}

/// The rules of an assignment.
#[derive(Debug)]
pub struct Definition {
    /// The assignment's key, a word for command lines and folders.
    pub key: &'static str,
    /// The assignment's name in the course.
    pub title: &'static str,
    /// The collision types that the assignment adds, and the handling of each.
    pub handlings: &'static [CollisionHandling],
    /// The kinds of pairs whose polynomials its detections log, in the order of a pass; [`PairKind::polynomial_count`]
    /// is the number of polynomials of each.
    pub pairs: &'static [PairKind],
    /// The rule for dropping coefficients of polynomials.
    pub trimming_rule: TrimmingRule,
    /// The version that the original program shows above a run.
    pub version: &'static str,
    /// The original's name for its verdict on collisions (oracle-behavior.md 6).
    pub verdict: &'static str,
    /// Whether the original prints the time of each step, and writes into `residual.txt` whether collisions passed.
    pub prints_times: bool,
    /// The part of a scene that the starter library supports.
    pub library: Library,
    /// The parts written by the student. Only these parts can contain a student's mistake.
    pub student: &'static [Part],
}

/// The rules that most assignments share.
const COMMON: Definition = Definition {
    key: "",
    title: "",
    handlings: &[],
    pairs: &[],
    trimming_rule: TrimmingRule::Leading,
    version: "Fall 2010 v.A",
    verdict: "Collisions Passed",
    prints_times: false,
    library: LIBRARY,
    student: &[],
};

impl Definition {
    /// Returns the assignment's handling of a collision type, or `None` if another assignment adds the type.
    pub fn handling(&self, collision: CollisionType) -> Option<&CollisionHandling> {
        self.handlings.iter().find(|handling| handling.collision == collision)
    }
}

/// The elements of a scene that a starter library reads. Original programs read more: those of Theme 1 are one program.
///
/// The library rejects a scene with another integrator ("Invalid integrator"), and ignores elements of other forces.
#[derive(Debug, Clone, Copy)]
pub struct Library {
    /// The integrators that the library supports.
    pub integrators: &'static [Integrator],
    /// The forces that the library supports.
    pub forces: &'static [ForceKind],
    /// The collision types that scenes of the assignment may have.
    pub collisions: &'static [CollisionType],
    /// Whether the library rejects other collision types. Otherwise it ignores them, or handles them without the
    /// student's code.
    pub rejects_collisions: bool,
    /// Whether scenes select the contest's detection. The penalty force then has no layer: the thickness is 0.
    pub has_contest: bool,
}

/// Every feature that a library can support; each milestone's library supports a part.
const LIBRARY: Library = Library {
    integrators: &[
        Integrator::ExplicitEuler,
        Integrator::ForwardBackwardEuler,
        Integrator::SymplecticEuler,
        Integrator::ImplicitEuler,
        Integrator::LinearizedImplicitEuler,
    ],
    forces: &ForceKind::ALL,
    collisions: &CollisionType::ALL,
    rejects_collisions: false,
    has_contest: false,
};

/// How a program handles a collision type.
#[derive(Debug)]
pub struct CollisionHandling {
    /// The collision type.
    pub collision: CollisionType,
    /// The lists in the program's records.
    pub records: RecordLists,
    /// The original's name for the handling, printed above a run (oracle-behavior.md 3).
    pub heading: &'static str,
}

/// The lists in the records of a step in addition to positions and velocities (trace-format.md 1, 2).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RecordLists {
    /// The list of impulses.
    pub impulses: ImpulseList,
    /// Whether there is a list of polynomials, and a mid record in each step.
    pub has_polynomials: bool,
}

/// The content of a record's list of impulses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImpulseList {
    /// Records have no list of impulses.
    Absent,
    /// Records always have an empty list.
    Empty,
    /// Records list the step's responses.
    Responses,
}

/// The coefficients that are dropped from a polynomial before the search for its zeros, and when a trace is read.
///
/// Code that depends on a rule is marked ([`drops_leading`](crate::drops_leading)).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrimmingRule {
    /// Leading coefficients with `|c| < 1e-12` (root-finder.md 15.1, the dropping build).
    Leading,
}

/// Marks code that depends on the rule that small leading coefficients are dropped. If a second rule is added, the
/// compiler reports all these places.
#[macro_export]
macro_rules! drops_leading {
    () => {
        const _: () = match $crate::assignments::Assignment::T2M2.definition().trimming_rule {
            $crate::assignments::TrimmingRule::Leading => (),
        };
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_collision_type_is_handled_by_the_assignment_that_brings_it_and_by_no_other() {
        for collision in CollisionType::ALL {
            let handles = |assignment: &Assignment| assignment.definition().handling(collision).is_some();
            let all: Vec<Assignment> = Assignment::ALL.into_iter().filter(handles).collect();
            assert_eq!(all, [Assignment::for_collisions(collision)], "{collision:?}");
        }
    }

    #[test]
    fn assignments_are_found_by_their_keys() {
        for assignment in Assignment::ALL {
            assert_eq!(Assignment::from_key(assignment.key()), Some(assignment));
        }
        assert_eq!(Assignment::from_key("t9m9"), None);
    }
}
