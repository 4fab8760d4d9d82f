//! Finds the milestones whose programs can run a scene, from the features of their starter libraries.
use super::model::{Collision, CollisionDetection, Scene};
use crate::assignments::{Assignment, CollisionType, ForceKind, Integrator};
use std::fmt;

/// A part of a scene that programs of an assignment do not support.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnknownFeature {
    /// The assignment whose programs lack the feature.
    pub assignment: Assignment,
    /// The unknown part of the scene.
    pub part: UnknownPart,
}

/// The part of a scene that programs of an assignment do not support.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum UnknownPart {
    /// An unknown integrator; programs reject the scene.
    Integrator(Integrator),
    /// An unknown force, which programs ignore.
    Force(ForceKind),
    /// An unknown collision type.
    Collision(CollisionType),
    /// The contest's detection in a scene of another assignment; programs ignore it.
    Contest,
    /// In a scene of the contest: another detection; programs then find no pairs.
    AllPairs,
    /// In a scene of the contest: a thickness of the penalty force other than 0; programs look for pairs without a
    /// layer.
    Thickness(f64),
}

impl UnknownFeature {
    /// Returns whether a program rejects the scene and writes no trace.
    pub const fn is_rejected(&self) -> bool {
        match self.part {
            UnknownPart::Integrator(_) => true,
            UnknownPart::Collision(_) => self.assignment.definition().library.rejects_collisions,
            _ => false,
        }
    }
}

impl fmt::Display for UnknownFeature {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let programs = format!("programs of {}", self.assignment.key().to_uppercase());
        let verb = if self.is_rejected() { "reject" } else { "ignore" };
        match self.part {
            UnknownPart::Integrator(integrator) => write!(formatter, "{programs} {verb} {}", integrator.name()),
            UnknownPart::Force(kind) => write!(formatter, "{programs} {verb} <{}>", kind.element()),
            UnknownPart::Collision(kind) if self.assignment.definition().library.has_contest => {
                write!(formatter, "scenes of {programs} have penalty collisions, not {}", kind.name())
            }
            UnknownPart::Collision(kind) => write!(formatter, "{programs} {verb} collisions of type {}", kind.name()),
            UnknownPart::Contest => write!(formatter, "{programs} {verb} the contest's detection"),
            UnknownPart::AllPairs => write!(formatter, "{programs} find no pairs without <collisiondetection>"),
            UnknownPart::Thickness(thickness) => {
                write!(formatter, "{programs} look for pairs without a layer; the thickness must be 0, not {thickness}")
            }
        }
    }
}

impl Scene {
    /// Returns all parts of the scene that programs of `assignment` do not support, each kind of part once.
    pub fn unknown_features(&self, assignment: Assignment) -> impl Iterator<Item = UnknownFeature> {
        let library = &assignment.definition().library;
        let integrator = Some(self.integrator).filter(|integrator| !library.integrators.contains(integrator));
        let forces = ForceKind::ALL
            .into_iter()
            .filter(|kind| !library.forces.contains(kind) && self.forces.iter().any(|force| force.kind() == *kind));
        let kind = self.collision.kind();
        let collision = if library.collisions.contains(&kind) {
            let contest = CollisionDetection::Contest;
            match self.collision {
                Collision::Penalty { detection, .. } if library.has_contest && detection != contest => {
                    Some(UnknownPart::AllPairs)
                }
                Collision::Penalty { thickness, .. } if library.has_contest && thickness != 0.0 => {
                    Some(UnknownPart::Thickness(thickness))
                }
                Collision::Penalty { detection, .. } if !library.has_contest && detection == contest => {
                    Some(UnknownPart::Contest)
                }
                _ => None,
            }
        } else {
            Some(UnknownPart::Collision(kind))
        };
        let parts = integrator.map(UnknownPart::Integrator).into_iter();
        parts
            .chain(forces.map(UnknownPart::Force))
            .chain(collision)
            .map(move |part| UnknownFeature { assignment, part })
    }

    /// Returns the assignments whose programs can run the scene, in the order of the course.
    pub fn assignments(&self) -> impl Iterator<Item = Assignment> {
        Assignment::ALL.into_iter().filter(|assignment| self.unknown_features(*assignment).next().is_none())
    }

    /// Returns the first assignment of the course whose programs can run the scene. If there is none, returns the
    /// assignment that added the scene's collision type. A scene with the contest's detection belongs to the contest.
    pub fn assignment(&self) -> Assignment {
        match self.collision {
            Collision::Penalty { detection: CollisionDetection::Contest, .. } => Assignment::T2M3,
            collision => self.assignments().next().unwrap_or(Assignment::for_collisions(collision.kind())),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        assignments::{Assignment, Part},
        scene::read,
    };

    /// Returns everything in a scene with these elements that programs of `assignment` do not know.
    fn unknown(assignment: Assignment, integrator: &str, elements: &str) -> Vec<String> {
        let text = format!(
            "<scene><duration time=\"1\"/><integrator type=\"{integrator}\" dt=\"0.5\"/>{elements}\
             <particle m=\"1\" px=\"0\" py=\"0\" vx=\"0\" vy=\"0\" fixed=\"0\" radius=\"1\"/>\
             <particle m=\"1\" px=\"5\" py=\"0\" vx=\"0\" vy=\"0\" fixed=\"0\" radius=\"1\"/></scene>"
        );
        let scene = read("a scene", text.as_bytes()).expect("a sound scene").scene;
        scene.unknown_features(assignment).map(|unknown| unknown.to_string()).collect()
    }

    #[test]
    fn a_scene_beyond_a_starter_library_is_reported() {
        let vortex = "<vortexforce i=\"0\" j=\"1\" kbs=\"1\" kvc=\"1\"/>";
        assert_eq!(unknown(Assignment::T1M2, "symplectic-euler", vortex), ["programs of T1M2 ignore <vortexforce>"]);
        assert!(unknown(Assignment::T1M3, "symplectic-euler", vortex).is_empty());
        let constant = "<constantforce fx=\"1\" fy=\"0\"/>";
        assert_eq!(
            unknown(Assignment::T1M3, "forward-backward-euler", constant),
            ["programs of T1M3 reject forward-backward-euler", "programs of T1M3 ignore <constantforce>"]
        );
        assert!(unknown(Assignment::T2M1, "forward-backward-euler", constant).is_empty());
        let hybrid = "<collision type=\"hybrid\" COR=\"1\" k=\"1\" thickness=\"0.1\" maxiters=\"2\"/>";
        let rejected = "programs of T2M1 reject collisions of type hybrid";
        assert_eq!(unknown(Assignment::T2M1, "explicit-euler", hybrid), [rejected]);
        assert!(unknown(Assignment::T2M2, "explicit-euler", hybrid).is_empty());
        let ignored = "programs of T1M1 ignore collisions of type hybrid";
        assert_eq!(unknown(Assignment::T1M1, "explicit-euler", hybrid), [ignored]);
    }

    #[test]
    fn the_contest_has_a_penalty_force_without_a_layer_and_no_symplectic_euler() {
        let penalty = |thickness: &str, more: &str| {
            format!("<collision type=\"penalty\" k=\"1\" thickness=\"{thickness}\"/>{more}")
        };
        let contest = "<collisiondetection type=\"contest\"/>";
        let of = |integrator, elements: &str| unknown(Assignment::T2M3, integrator, elements);
        assert!(of("explicit-euler", &penalty("0", contest)).is_empty());
        let rejected = "programs of T2M3 reject symplectic-euler";
        assert_eq!(of("symplectic-euler", &penalty("0", contest)), [rejected]);
        let layer = "programs of T2M3 look for pairs without a layer; the thickness must be 0, not 0.05";
        assert_eq!(of("explicit-euler", &penalty("0.05", contest)), [layer]);
        let unused = "programs of T2M3 find no pairs without <collisiondetection>";
        assert_eq!(of("explicit-euler", &penalty("0", "")), [unused]);
        let ignored = "programs of T2M1 ignore the contest's detection";
        assert_eq!(unknown(Assignment::T2M1, "explicit-euler", &penalty("0", contest)), [ignored]);
    }

    #[test]
    fn a_student_writes_only_what_the_library_calls() {
        for assignment in Assignment::ALL {
            let definition = assignment.definition();
            assert!(!definition.student.is_empty(), "{assignment:?}");
            for part in definition.student {
                let is_called = match part {
                    Part::Integrator(integrator) => definition.library.integrators.contains(integrator),
                    Part::Force(kind) | Part::Jacobians(kind) => definition.library.forces.contains(kind),
                    _ => true,
                };
                assert!(is_called && definition.student.contains(part), "{assignment:?}: {part:?}");
            }
        }
        assert!(
            !Assignment::T2M3.definition().student.contains(&Part::Penalty(crate::assignments::PairKind::ParticleEdge))
        );
    }
}
