//! Describes wrong stages of a step that no known mistake explains.
use super::capitalize;
use crate::number::format_g;
use fosssim_mistakes::diagnose::{
    Amount, ChangedQuantity, GeometricPartError, LoopEnd, Quantity, Ratios, StageDetail, StageFault, WrongChange,
    WrongResponses,
};
use fosssim_model::{assignments::Part, sim::PairKind};

/// The maximum number of parts of an assignment that are named singly.
const MAX_NAMED_PARTS: usize = 2;

/// Describes the fault of a stage. The sentence begins with the place of the fault.
pub(super) fn describe(fault: &StageFault) -> String {
    format!("{}: {}.", name_areas(fault), capitalize(&describe_fault(fault)))
}

/// Names the parts of the assignment that may contain the fault. If the fault concerns only one kind of pair, the kind
/// is named.
fn name_areas(fault: &StageFault) -> String {
    let areas: Vec<String> = match fault {
        StageFault::Change(wrong) if wrong.parts.len() <= MAX_NAMED_PARTS => wrong.part_names(),
        _ => distinct(fault.areas().iter().map(|area| area.name().to_lowercase())),
    };
    let areas = match areas.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        // A result of an earlier version does not name the part.
        None => "state".to_owned(),
        _ => areas.concat(),
    };
    match fault.kind() {
        Some(kind) => format!("{} {}", capitalize(kind.name()), areas.replace("collision response", "response")),
        None => capitalize(&areas),
    }
}

fn describe_fault(fault: &StageFault) -> String {
    let fixed = match fault {
        StageFault::Order => "the polynomials are right, but the pairs are tested in another order",
        StageFault::Decisions { wrong, .. } => wrong.name(),
        StageFault::Overlaps { wrong, .. } => wrong.of_overlaps(),
        StageFault::Change(wrong) => return describe_change(wrong),
        StageFault::ContactTimes => "the contacts are right, but not their times of impact",
        StageFault::ContactVectors { wrong, .. } => wrong.name(),
        StageFault::Responses { wrong, .. } => return describe_responses(wrong),
        StageFault::ManyContacts => "the contacts are right, but not the state after them",
        StageFault::Unresolved { all: true } => "contacts that the first round's polynomials show have no effect",
        StageFault::Unresolved { all: false } => "some contacts that the first round's polynomials show have no effect",
        StageFault::Rounds(number) => number.name(),
        StageFault::HandedOver { quantity, when, .. } => {
            let what = quantity.map_or("positions and velocities", plural);
            let when = match when {
                Some(LoopEnd::RanOut) => " when maxiters rounds have been made",
                Some(LoopEnd::Settled) => " when nothing collides any more",
                None => "",
            };
            return format!("the polynomials of the rounds are right, but not the {what} that they pass on{when}");
        }
        StageFault::FirstRound => "the polynomials of the first round are right, but not the state after it",
        StageFault::LaterRounds => {
            "isolated contacts of the first round are resolved correctly, but the state after the whole round is wrong"
        }
        StageFault::RoundsOfPrediction => {
            "rounds after the first one detect collisions at the predicted positions again, not at the positions \
                after the preceding round"
        }
        StageFault::BehindFirstRound => {
            "the first round is right, as the polynomials of the second one show, but later rounds are wrong"
        }
        StageFault::Geometric(GeometricPartError::Omitted { always: true }) => {
            "after the last allowed round, no geometric pass follows"
        }
        StageFault::Geometric(GeometricPartError::Omitted { always: false }) => {
            "after the last allowed round, a geometric pass follows in some steps only"
        }
        StageFault::Geometric(GeometricPartError::Superfluous) => {
            "the geometric part runs although a round has found nothing"
        }
        StageFault::ZonePositions(positions) => positions.name(),
        StageFault::AfterRounds => "the impulse rounds are right, but the part after them is wrong",
        StageFault::ZoneRounds(rounds) => rounds.name(),
        StageFault::Zones(wrong) => wrong.name(),
        StageFault::Motion { wrong, .. } if wrong.is_empty() => "zones do not move as they should",
        StageFault::Motion { wrong, .. } => {
            let wrong: Vec<&str> = wrong.iter().map(|wrong| wrong.name()).collect();
            return wrong.join("; ");
        }
    };
    fixed.to_owned()
}

/// Describes how states change wrongly.
fn describe_change(wrong: &WrongChange) -> String {
    let (quantity, other) = match wrong.quantity {
        Quantity::Position => ("positions", "velocities are right"),
        Quantity::Velocity if wrong.parts.iter().any(|part| matches!(part, Part::SimpleResponse(_))) => {
            ("velocities", "collisions are detected correctly")
        }
        Quantity::Velocity => ("velocities", "positions are updated correctly from velocities"),
    };
    let axis = match wrong.axis {
        None => "",
        Some(0) => "horizontal ",
        Some(_) => "vertical ",
    };
    let (whose, how) = (wrong.particles.name(), wrong.ratio.name());
    let start = if axis.is_empty() && whose.is_empty() { "but" } else { "and only the" };
    format!("{other}, {start} {axis}{quantity}{whose} {how}")
}

fn describe_responses(wrong: &WrongResponses) -> String {
    match wrong {
        WrongResponses::Nothing => "contacts change nothing".to_owned(),
        WrongResponses::Unchanged(all) => {
            let list: Vec<String> = all
                .iter()
                .map(|change| format!("the {} of {}", singular(change.quantity), name_body(change)))
                .collect();
            format!("unchanged by contacts: {}", list.join(", "))
        }
        WrongResponses::Across(all) => format!("{} also across the contact vector", name_changed_objects(all)),
        WrongResponses::Amount(all) => {
            format!("{} along the contact vector, but not by the right amount", name_changed_objects(all))
        }
    }
}

/// Names the objects whose quantities change wrongly.
fn name_changed_objects(all: &[ChangedQuantity]) -> String {
    let quantities = distinct(all.iter().map(|change| change.quantity));
    let bodies = distinct(all.iter().map(name_body));
    match (&quantities[..], &bodies[..]) {
        ([one], [body]) => format!("the {} of {body} changes", singular(*one)),
        (_, [body]) => format!("position and velocity of {body} change"),
        ([one], _) => format!("{} change", plural(*one)),
        _ => "positions and velocities change".to_owned(),
    }
}

const fn name_body(changed: &ChangedQuantity) -> &'static str {
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

/// Renders a line about the exact form of the fault; `None` if the numbers tell the reader nothing more.
pub(super) fn describe_detail(detail: &StageDetail) -> Option<String> {
    Some(match detail {
        StageDetail::Factor(ratio) => {
            format!("each change is {} the right amount", describe_ratio(Ratios::All(*ratio)))
        }
        StageDetail::Order => {
            "right order for each particle: later particles, edges of which it is not an end, half-planes".to_owned()
        }
        StageDetail::Impacts { right: false, count, low, high } => {
            format!("times of impact of the affected contacts ({count}): {low:.4} to {high:.4}")
        }
        StageDetail::Impacts { right: true, count, low, high } => {
            format!("times of impact of the right contacts ({count}): {low:.4} to {high:.4}")
        }
        StageDetail::Vectors(Ratios::All(ratio)) if is_about(*ratio, 1.0) => return None,
        StageDetail::Vectors(Ratios::All(ratio)) if is_about(*ratio, -1.0) => "it points backwards".to_owned(),
        StageDetail::Vectors(Ratios::Between(..)) => "its length differs from contact to contact".to_owned(),
        StageDetail::Vectors(ratios) => {
            format!("{} the length of the right one, in its direction", describe_ratio(*ratios))
        }
        StageDetail::VectorError(part) => format!("off by at most {part:.1e} of its length"),
        StageDetail::Times(ratios) => format!("{} what they should be", describe_ratio(*ratios)),
        StageDetail::TimeError(offset) => format!("off by {offset:.6}"),
        StageDetail::TimeUse => {
            "the time of impact from the root finder is used unchanged for contact vector and response".to_owned()
        }
        StageDetail::Passes { expected, actual, most } => {
            let passes = if *actual == 1 { "pass" } else { "passes" };
            format!("{actual} detection {passes} instead of {expected}, with maxiters {most}")
        }
        StageDetail::Change { changed, amount, across, wrong, of } => {
            let amount = match amount {
                Amount::Unwanted => "although it should stay the same".to_owned(),
                Amount::Right => "correctly along the contact vector".to_owned(),
                Amount::Ratio(ratios) => format!("by {} the right amount", describe_ratio(*ratios)),
            };
            let across = if *across { ", and across the contact vector, too" } else { "" };
            let (kind, quantity) = (capitalize(changed.kind.name()), singular(changed.quantity));
            let body = name_body(changed);
            format!("{kind}: the {quantity} of {body} changes {amount}{across} (in {wrong} of {of} isolated contacts)")
        }
        StageDetail::ZoneCount { count, of } => format!("in {count} of {of} zones of the first round"),
        StageDetail::StoppedVelocities(Ratios::All(ratio)) if is_about(*ratio, 1.0) => {
            "they keep their earlier velocity".to_owned()
        }
        StageDetail::StoppedVelocities(ratios) => format!("{} their earlier velocity", describe_ratio(*ratios)),
        StageDetail::CenterMotion(Ratios::All(ratio)) if is_about(*ratio, 0.0) => "it does not move".to_owned(),
        StageDetail::CenterMotion(Ratios::Between(..)) => "how far it moves differs from zone to zone".to_owned(),
        StageDetail::CenterMotion(ratios) => format!("it moves {} as far as it should", describe_ratio(*ratios)),
        StageDetail::CenterDirection => "its direction is wrong, too".to_owned(),
        StageDetail::Rotations(Ratios::All(ratio) | Ratios::Between(_, ratio)) if ratio.abs() < 1e-3 => {
            "they hardly turn".to_owned()
        }
        StageDetail::Rotations(Ratios::Between(..)) => "how far they turn differs from zone to zone".to_owned(),
        StageDetail::Rotations(ratios) => format!("they turn {} as far as they should", describe_ratio(*ratios)),
        StageDetail::Velocities(ratios) => {
            format!("{} the displacement divided by the step size", describe_ratio(*ratios))
        }
    })
}

/// Returns whether a measured ratio equals `value`, up to a tolerance.
fn is_about(ratio: f64, value: f64) -> bool {
    (ratio - value).abs() < 1e-9
}

/// Describes ratios: as one number such as "1.5 times" if they agree, otherwise as a range.
pub(super) fn describe_ratio(ratios: Ratios) -> String {
    let shorten = |value: f64| {
        if value.abs() >= 1e6 {
            return format_g(value);
        }
        let digits = if (value - 1.0).abs() < 5e-5 { 10 } else { 4 };
        let text = format!("{value:.digits$}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    match ratios {
        Ratios::All(ratio) => format!("{} times", shorten(ratio)),
        Ratios::Between(low, high) => format!("{} to {} times", shorten(low), shorten(high)),
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
