//! Describes the place of an example: the step, the record and the objects.
use fosssim_judge::PairText;
use fosssim_mistakes::diagnose::{ExamplePlace, StepRecord};
use fosssim_model::sim::PairKind;

/// Describes where in its step an example is, and what its numbers mean.
pub(crate) fn describe_place(place: &ExamplePlace) -> String {
    match place {
        ExamplePlace::Given { pair, pass, subject } => {
            format!("{}, pass {}, {} polynomial", PairText(*pair), pass + 1, subject.name())
        }
        ExamplePlace::Polynomial { pair, pass, role } => {
            format!("{}, pass {}, {role} polynomial", PairText(*pair), pass + 1)
        }
        ExamplePlace::NumberedPolynomial(number) => format!("polynomial {number}"),
        ExamplePlace::PolynomialCount => "number of polynomials".to_owned(),
        ExamplePlace::Contact { kind, first, second } => {
            let other = kind.map_or("object of unknown kind", PairKind::second_name);
            format!("contact of particle {first} and {other} {second}, normal and time")
        }
        ExamplePlace::ContactCount => "number of impulses".to_owned(),
        ExamplePlace::Particle { particle, record } => {
            let record = match record {
                StepRecord::Mid => "mid record",
                StepRecord::End => "end record",
            };
            format!("position and velocity of particle {particle}, {record}")
        }
        ExamplePlace::MidParticle(particle) => format!("particle {particle}, mid record"),
        ExamplePlace::MidLists => "lists of the mid record".to_owned(),
    }
}
