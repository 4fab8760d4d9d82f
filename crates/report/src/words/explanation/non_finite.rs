//! Describes traces with values that are not finite.
use fosssim_mistakes::diagnose::{NanStage, NonFiniteValue};

/// Describes the first step with a value that is not finite, the stage that computes it, and the usual reason.
pub(super) fn describe(found: &NonFiniteValue) -> String {
    let what = if found.is_nan { "NaN (not a number)" } else { "an infinite number" };
    let where_from = match (found.step, found.stage) {
        (_, NanStage::FirstRecord) => "In the first record".to_owned(),
        (Some(step), _) if found.recovers => format!("In step {step}, but not in all steps after it,"),
        (Some(step), _) => format!("From step {step} on"),
        (None, _) if found.recovers => "In some steps".to_owned(),
        (None, _) => "From some step on".to_owned(),
    };
    let (source, divisors) = match found.stage {
        NanStage::FirstRecord => {
            return format!(
                "{where_from} there is {what}: nothing has moved yet, so look at how the trace is written."
            );
        }
        NanStage::Motion => ("the forces or the integrator produce it", "a mass, a distance or a step size"),
        NanStage::ImplicitMotion => {
            return format!(
                "{where_from} there is {what}: the implicit integrator produces it from finite numbers. Wrong second \
                 derivatives or signs are usual causes: Newton's method does not converge with them."
            );
        }
        NanStage::Detection(Some(kind)) => {
            let name = kind.name();
            return sentences(
                &where_from,
                what,
                &format!("the {name} detection produces it"),
                "a length or a step size",
            );
        }
        NanStage::Detection(None) => ("a detection produces it", "a length or a step size"),
        NanStage::ContactVectors => {
            ("a contact vector or its time produces it", "the length of an edge or of a normal")
        }
        NanStage::Responses => ("a collision response produces it", "a mass or the length of a contact vector"),
        NanStage::ImpulseRounds => {
            ("an impulse round produces it", "a mass, or the length of an edge or of a contact vector")
        }
        NanStage::Zones => {
            ("the impact zones or the rigid failsafe produce it", "a mass, a moment of inertia or a step size")
        }
    };
    sentences(&where_from, what, source, divisors)
}

fn sentences(where_from: &str, what: &str, source: &str, divisors: &str) -> String {
    let root = if what.starts_with("NaN") { ", or the root of a negative number" } else { "" };
    format!(
        "{where_from} there is {what}: {source} from finite numbers. The usual cause is a division by {divisors} that \
        is zero{root}."
    )
}
