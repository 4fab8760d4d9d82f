//! Sentences about stages of a step that no known mistake explains.
use super::capitalized;
use crate::view::key;
use fosssim_mistakes::diagnose::{
    Amount, ChangeCause, ChangeRatio, ChangedParticles, ChangedQuantity, LoopEnd, Quantity, Ratios, StageDetail,
    StageFault, WrongChange, WrongDecisions, WrongGeometric, WrongMotion, WrongNumber, WrongPositions, WrongResponses,
    WrongVectors, WrongZoneRounds, WrongZones,
};
use fosssim_model::sim::PairKind;
use fosssim_student::Area;

/// Returns the fault of a stage, with its place in front.
pub(super) fn what(fault: &StageFault) -> String {
    format!("{}: {}.", place(fault), capitalized(&describe_fault(fault)))
}

/// Returns the parts of the assignment in which it may lie, with the kind of pair that alone it concerns.
fn place(fault: &StageFault) -> String {
    let areas: Vec<String> = fault.areas().iter().map(|area| area_name(*area)).collect();
    let areas = match areas.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => areas.concat(),
    };
    let areas = if fault.kind().is_some() { areas.replace("collision response", "response") } else { areas };
    match fault.kind() {
        Some(kind) => format!("{} {areas}", capitalized(kind.name())),
        None => capitalized(&areas),
    }
}

fn area_name(area: Area) -> String {
    let name = match area {
        Area::Decision => "detection",
        Area::ContactVector => "contact vector",
        Area::SimpleDetection => "detection",
        Area::Penalty => "penalty force",
        Area::Response => "collision response",
        Area::ImpulseLoop => "impulse loop",
        Area::ImpactZones => "impact zones",
        Area::Failsafe => "rigid failsafe",
        // No stage lies in the others; their names are good enough.
        _ => return key(&area),
    };
    name.to_owned()
}

fn describe_fault(fault: &StageFault) -> String {
    let fixed = match fault {
        StageFault::Order => "the polynomials are right, but the pairs are tested in another order",
        StageFault::Decisions { wrong, .. } => match wrong {
            WrongDecisions::Missed => "contacts that its polynomials show are not counted",
            WrongDecisions::Superfluous => "contacts are counted that its polynomials do not show",
            WrongDecisions::Both => {
                "the polynomials are right, the decisions are not: contacts are missed, others are superfluous"
            }
        },
        StageFault::Overlaps { wrong, .. } => describe_overlaps(*wrong),
        StageFault::Change(wrong) => return describe_change(wrong),
        StageFault::ContactTimes => "the contacts are right, but not their times of impact",
        StageFault::ContactVectors { wrong, .. } => describe_vectors(*wrong),
        StageFault::Responses { wrong, .. } => return describe_responses(wrong),
        StageFault::ManyContacts => "the contacts are right, but not the state that they lead to",
        StageFault::Unresolved { all: true } => "contacts that the first round's polynomials show change nothing",
        StageFault::Unresolved { all: false } => "some contacts that the first round's polynomials show change nothing",
        StageFault::Rounds(number) => match number {
            WrongNumber::Fewer => "the loop makes fewer rounds than it should",
            WrongNumber::More => "the loop makes more rounds than it should",
            WrongNumber::Other => "the loop makes another number of rounds than it should",
        },
        StageFault::HandedOver { quantity, when, .. } => {
            let what = quantity.map_or("positions and velocities", plural);
            let when = match when {
                Some(LoopEnd::RanOut) => " when they run out",
                Some(LoopEnd::Settled) => " when nothing collides any more",
                None => "",
            };
            return format!("the polynomials of the rounds are right, but not the {what} that they hand over{when}");
        }
        StageFault::FirstRound => "the polynomials of the first round are right, but not where it leads",
        StageFault::LaterRounds => {
            "isolated contacts of the first round are resolved as they should be, but the round as a whole does not lead \
             where it should"
        }
        StageFault::RoundsOfPrediction => {
            "rounds after the first one detect on the predicted positions again, not on those that the round before \
            left"
        }
        StageFault::BehindFirstRound => {
            "the first round is right, as the polynomials of the second one show, but not what follows"
        }
        StageFault::Geometric(WrongGeometric::Left { always: true }) => {
            "when the rounds run out, no geometric pass follows"
        }
        StageFault::Geometric(WrongGeometric::Left { always: false }) => {
            "when the rounds run out, a geometric pass follows in some steps only"
        }
        StageFault::Geometric(WrongGeometric::Superfluous) => {
            "the geometric part runs although a round has found nothing"
        }
        StageFault::ZonePositions(positions) => match positions {
            WrongPositions::Prediction => {
                "the first zones are searched on the predicted positions, not on those that the impulse rounds leave"
            }
            WrongPositions::First => {
                "the first zones are searched on other positions than those that the impulse rounds leave"
            }
            WrongPositions::BeforeFailsafe => "the detection after the failsafe uses the positions before it",
        },
        StageFault::AfterRounds => "the impulse rounds are right, but not what follows them",
        StageFault::ZoneRounds(rounds) => match rounds {
            WrongZoneRounds::Growth => "zones are right in the first round, but not as they grow",
            WrongZoneRounds::Fewer => "the zones make fewer rounds than they should",
            WrongZoneRounds::More => "the zones make more rounds than they should",
            WrongZoneRounds::Later => {
                "the zones are right at first, but not in later rounds, or there are not as many as there should be"
            }
        },
        StageFault::Zones(wrong) => describe_zones(*wrong),
        StageFault::Motion { wrong, .. } if wrong.is_empty() => "zones do not move as they should",
        StageFault::Motion { wrong, .. } => {
            let wrong: Vec<&str> = wrong.iter().map(|wrong| describe_motion(*wrong)).collect();
            return wrong.join("; ");
        }
    };
    fixed.to_owned()
}

/// Returns the features of wrong changes of states.
fn describe_change(wrong: &WrongChange) -> String {
    let (quantity, other) = match wrong.quantity {
        Quantity::Position => ("positions", "velocities are right, but "),
        Quantity::Velocity if wrong.cause == ChangeCause::Response => {
            ("velocities", "collisions are found as they should be, but ")
        }
        Quantity::Velocity => ("velocities", "positions follow from velocities as they should, but "),
    };
    let whose = match wrong.particles {
        ChangedParticles::Any => "",
        ChangedParticles::Fixed => " of fixed particles only",
        ChangedParticles::First => " of the first particle only",
        ChangedParticles::Last => " of the last particle only",
    };
    let axis = match wrong.axis {
        None => "",
        Some(0) => ", in their horizontal component only,",
        Some(_) => ", in their vertical component only,",
    };
    let how = match wrong.ratio {
        ChangeRatio::Nothing => "stay as they were",
        ChangeRatio::Opposite => "change the opposite way",
        ChangeRatio::Factor => "change by a wrong factor, which is always the same",
        ChangeRatio::Other => "change wrongly",
    };
    format!("{other}{quantity}{whose}{axis} {how}")
}

const fn describe_overlaps(wrong: WrongDecisions) -> &'static str {
    match wrong {
        WrongDecisions::Missed => "collisions of bodies that overlap and approach each other are missed",
        WrongDecisions::Superfluous => {
            "collisions are found between bodies that do not overlap, or do not approach each other"
        }
        WrongDecisions::Both => "some collisions are missed, and others are found where there are none",
    }
}

const fn describe_vectors(wrong: WrongVectors) -> &'static str {
    match wrong {
        WrongVectors::Perpendicular => "it is perpendicular to what it should be",
        WrongVectors::Direction => "it has the wrong direction",
        WrongVectors::Zero => "it has no length",
        WrongVectors::Inexact => "it is right except for its last digits",
        WrongVectors::Reversed => "it points the other way round",
        WrongVectors::Length => "it has the right direction, but not the right length",
    }
}

const fn describe_zones(wrong: WrongZones) -> &'static str {
    match wrong {
        WrongZones::Partly => "some of a zone's particles are not moved with it",
        WrongZones::PartlyStopped => "in zones that must stop, some particles do not",
        WrongZones::Unmoved => "some zones that should move do not",
        WrongZones::NotMerged => "zones that share particles are moved one after the other, not as one",
        WrongZones::Joined => "zones that share no particle are moved as one",
        WrongZones::Others => "zones move particles that are not theirs",
        WrongZones::MoveOn => "zones that must stop move on as rigid bodies",
        WrongZones::Stop => "zones stop although nothing in them is fixed",
        WrongZones::KeepPositions => "zones that must stop do not go back to their start",
        WrongZones::KeepVelocities => "zones that must stop do not lose their velocity",
    }
}

const fn describe_motion(wrong: WrongMotion) -> &'static str {
    match wrong {
        WrongMotion::Center => "the center of mass of a zone does not move as it should",
        WrongMotion::Distances => "the particles of a zone do not keep their distances",
        WrongMotion::NoTurn => "zones do not turn",
        WrongMotion::LessTurn => "zones do not turn as far as they should",
        WrongMotion::MoreTurn => "zones turn further than they should",
        WrongMotion::TurnBack => "zones turn the other way round",
        WrongMotion::Turn => "zones do not turn by the angle that they should",
        WrongMotion::Velocities => "velocities in a zone are not those of its motion from start to end",
        WrongMotion::Speeds => "velocities in a zone are not those of its motion from start to end, though along it",
    }
}

fn describe_responses(wrong: &WrongResponses) -> String {
    match wrong {
        WrongResponses::Nothing => "contacts change nothing".to_owned(),
        WrongResponses::Unchanged(all) => {
            let list: Vec<String> =
                all.iter().map(|one| format!("the {} of {}", singular(one.quantity), body(one))).collect();
            format!("unchanged by contacts: {}", list.join(", "))
        }
        WrongResponses::Across(all) => format!("{} also across the contact vector", who_changes(all)),
        WrongResponses::Amount(all) => {
            format!("{} along the contact vector, but not by the right amount", who_changes(all))
        }
    }
}

/// Returns the subject that changes wrongly.
fn who_changes(all: &[ChangedQuantity]) -> String {
    let quantities = distinct(all.iter().map(|one| one.quantity));
    let bodies = distinct(all.iter().map(body));
    match (&quantities[..], &bodies[..]) {
        ([one], [body]) => format!("the {} of {body} changes", singular(*one)),
        (_, [body]) => format!("position and velocity of {body} change"),
        ([one], _) => format!("{} change", plural(*one)),
        _ => "positions and velocities change".to_owned(),
    }
}

const fn body(changed: &ChangedQuantity) -> &'static str {
    match (changed.kind, changed.body) {
        (PairKind::ParticleParticle, 0) => "the first particle",
        (PairKind::ParticleParticle, _) => "the second particle",
        (PairKind::ParticleEdge, 1) => "the first endpoint",
        (PairKind::ParticleEdge, 2) => "the second endpoint",
        _ => "the particle",
    }
}

const fn singular(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Position => "position",
        Quantity::Velocity => "velocity",
    }
}

const fn plural(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Position => "positions",
        Quantity::Velocity => "velocities",
    }
}

/// Returns a line of the exact form; nothing where a number would say nothing.
pub(super) fn detail(detail: &StageDetail) -> Option<String> {
    Some(match detail {
        StageDetail::Factor(ratio) => format!("each change is {} what it should be", times(Ratios::All(*ratio))),
        StageDetail::Order => {
            "per particle: the particles after it, the edges of which it is not an end, the half-planes".to_owned()
        }
        StageDetail::Impacts { right: false, count, low, high } => {
            format!("times of impact of these ({count}): {low:.4} to {high:.4}")
        }
        StageDetail::Impacts { right: true, count, low, high } => {
            format!("of those that are right ({count}): {low:.4} to {high:.4}")
        }
        StageDetail::Vectors(Ratios::All(ratio)) if is(*ratio, 1.0) => return None,
        StageDetail::Vectors(Ratios::All(ratio)) if is(*ratio, -1.0) => "it points the opposite way".to_owned(),
        StageDetail::Vectors(Ratios::Between(..)) => "its length differs from contact to contact".to_owned(),
        StageDetail::Vectors(ratios) => format!("{} as long along the right one", times(*ratios)),
        StageDetail::VectorsOff(part) => format!("off by at most {part:.1e} of its length"),
        StageDetail::Times(ratios) => format!("{} what they should be", times(*ratios)),
        StageDetail::TimesOff(offset) => format!("off by {offset:.6}"),
        StageDetail::TimesUsed => {
            "the time of impact goes into contact vector and response as the root finder returns it".to_owned()
        }
        StageDetail::Passes { expected, actual, most } => {
            let passes = if *actual == 1 { "pass" } else { "passes" };
            format!("{actual} detection {passes} instead of {expected}, with maxiters {most}")
        }
        StageDetail::Change { changed, amount, across, wrong, of } => {
            let amount = match amount {
                Amount::Unwanted => "though it should not".to_owned(),
                Amount::Right => "as it should along the contact vector".to_owned(),
                Amount::Ratio(ratios) => format!("by {} what it should", times(*ratios)),
            };
            let across = if *across { ", and across the contact vector, too" } else { "" };
            let (place, quantity) = (capitalized(changed.kind.name()), singular(changed.quantity));
            let body = body(changed);
            format!("{place}: the {quantity} of {body} changes {amount}{across} (in {wrong} of {of} isolated contacts)")
        }
        StageDetail::OfZones { count, of } => format!("in {count} of {of} zones of the first round"),
        StageDetail::Stopped(Ratios::All(ratio)) if is(*ratio, 1.0) => "they keep the velocity from before".to_owned(),
        StageDetail::Stopped(ratios) => format!("{} their velocity before", times(*ratios)),
        StageDetail::CenterMoves(Ratios::All(ratio)) if is(*ratio, 0.0) => "it does not move".to_owned(),
        StageDetail::CenterMoves(Ratios::Between(..)) => "how far it moves differs from zone to zone".to_owned(),
        StageDetail::CenterMoves(ratios) => format!("it moves {} as far", times(*ratios)),
        StageDetail::CenterDirection => "its direction is wrong, too".to_owned(),
        StageDetail::Turns(Ratios::All(ratio) | Ratios::Between(_, ratio)) if ratio.abs() < 1e-3 => {
            "they hardly turn".to_owned()
        }
        StageDetail::Turns(Ratios::Between(..)) => "how far they turn differs from zone to zone".to_owned(),
        StageDetail::Turns(ratios) => format!("they turn {} as far", times(*ratios)),
        StageDetail::Velocities(ratios) => format!("{} the motion over the step size", times(*ratios)),
    })
}

/// Returns whether a measured ratio is this one.
fn is(ratio: f64, value: f64) -> bool {
    (ratio - value).abs() < 1e-9
}

/// Ratios in words: "1.5 times" where they agree, else their range.
pub(super) fn times(ratios: Ratios) -> String {
    let short = |value: f64| {
        let digits = if (value - 1.0).abs() < 5e-5 { 10 } else { 4 };
        let text = format!("{value:.digits$}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    match ratios {
        Ratios::All(ratio) => format!("{} times", short(ratio)),
        Ratios::Between(low, high) => format!("{} to {} times", short(low), short(high)),
    }
}

fn distinct<T: PartialEq>(values: impl Iterator<Item = T>) -> Vec<T> {
    let mut list = Vec::new();
    for value in values {
        if !list.contains(&value) {
            list.push(value);
        }
    }
    list
}
