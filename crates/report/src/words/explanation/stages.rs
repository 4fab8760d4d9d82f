//! Describes wrong stages of a step that no known mistake explains.
use super::capitalize;
use crate::number::format_g;
use fosssim_mistakes::diagnose::{ChangeCause, Quantity, StageDetail, StageFault, WrongChange, WrongGeometric};

/// Describes the fault of a stage. The sentence begins with the place of the fault.
pub(super) fn describe(fault: &StageFault) -> String {
    format!("{}: {}.", describe_place(fault), capitalize(&describe_fault(fault)))
}

/// Names the parts of the assignment that may contain the fault. If the fault concerns only one kind of pair, the kind
/// is named.
fn describe_place(fault: &StageFault) -> String {
    let areas: Vec<String> = fault.areas().iter().map(|area| area.name().to_lowercase()).collect();
    let areas = match areas.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => areas.concat(),
    };
    match fault.kind() {
        Some(kind) => format!("{} {areas}", capitalize(kind.name())),
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
        StageFault::Responses => "the contacts are right, but not the state after them",
        StageFault::Rounds(number) => number.name(),
        StageFault::HandedOver => "the polynomials of all rounds are right, but not the state after them",
        StageFault::FirstRound => "the polynomials of the first round are right, but not the state after it",
        StageFault::LaterRounds => {
            "the first round is right, as the polynomials of the second one show, but later rounds are wrong"
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
        StageFault::AfterRounds => "the impulse rounds are right, but the part after them is wrong",
    };
    fixed.to_owned()
}

/// Describes how states change wrongly.
fn describe_change(wrong: &WrongChange) -> String {
    let (quantity, other) = match wrong.quantity {
        Quantity::Position => ("positions", "velocities are right, but "),
        Quantity::Velocity if wrong.cause == ChangeCause::Response => {
            ("velocities", "collisions are detected correctly, but ")
        }
        Quantity::Velocity => ("velocities", "positions are updated correctly from velocities, but "),
    };
    let axis = match wrong.axis {
        None => "",
        Some(0) => ", in their horizontal component only,",
        Some(_) => ", in their vertical component only,",
    };
    let (whose, how) = (wrong.particles.name(), wrong.ratio.name());
    format!("{other}{quantity}{whose}{axis} {how}")
}

/// Renders a line of the exact form.
pub(super) fn describe_detail(detail: &StageDetail) -> String {
    match detail {
        StageDetail::Factor(ratio) => format!("each change is {} what it should be", describe_ratio(*ratio)),
        StageDetail::Order => {
            "per particle: the particles after it, the edges of which it is not an end, the half-planes".to_owned()
        }
        StageDetail::Passes { expected, actual, most } => {
            let passes = if *actual == 1 { "pass" } else { "passes" };
            format!("{actual} detection {passes} instead of {expected}, with maxiters {most}")
        }
    }
}

/// Describes a ratio, such as "1.5 times".
pub(super) fn describe_ratio(ratio: f64) -> String {
    if ratio.abs() >= 1e6 {
        return format!("{} times", format_g(ratio));
    }
    let digits = if (ratio - 1.0).abs() < 5e-5 { 10 } else { 4 };
    let text = format!("{ratio:.digits$}");
    format!("{} times", text.trim_end_matches('0').trim_end_matches('.'))
}
