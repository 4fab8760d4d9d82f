//! Sentences about wrong terms of the forces.
use super::stages::times;
use fosssim_mistakes::diagnose::{ForceTerm, Ratios, WrongWeight};

/// The terms, and what is wrong with each.
pub(super) fn what(wrong: &[(ForceTerm, WrongWeight)]) -> String {
    let of = |(term, weight): &(ForceTerm, WrongWeight)| format!("{} {}", name(*term), of_weight(*weight));
    format!("Forces: {}.", wrong.iter().map(of).collect::<Vec<_>>().join(", "))
}

/// A term's weight.
pub(super) fn detail(term: ForceTerm, weight: f64) -> String {
    format!("{}: {} what it should be", name(term), times(Ratios::All(weight)))
}

const fn of_weight(weight: WrongWeight) -> &'static str {
    match weight {
        WrongWeight::Zero => "is missing",
        WrongWeight::MinusOne => "has the wrong sign",
        WrongWeight::Two => "is there twice",
        WrongWeight::Half => "is there by half",
        WrongWeight::Other => "carries a factor that does not belong there",
    }
}

const fn name(term: ForceTerm) -> &'static str {
    match term {
        ForceTerm::SpringElastic => "the elastic part of springs",
        ForceTerm::SpringDamping => "the damping of springs",
        ForceTerm::Gravity => "simple gravity",
        ForceTerm::Gravitation => "the gravitational force",
        ForceTerm::Constant => "the constant force",
        ForceTerm::Drag => "drag",
        ForceTerm::Vortex => "the vortex force",
        ForceTerm::PenaltyParticles => "the penalty force between particles",
        ForceTerm::PenaltyEdges => "the penalty force of edges",
        ForceTerm::PenaltyHalfPlanes => "the penalty force of half-planes",
    }
}
