//! Checks the sentences about stages against the facts: an independent reader of traces, which asks of each sentence
//! whether some step is as it says. For tests and the lab.
mod says;
mod step;

use fosssim_oracle::{
    diagnose::{About, Explanation, LoopEnd, StageFault, WrongGeometric, explain_stages},
    scene::Scene,
    student::{self, Student},
};

/// Whether a sentence about stages is true of the trace; also true for explanations of other things.
#[must_use]
pub fn is_true(scene: &Scene, trace: &[u8], told: &Explanation) -> bool {
    let About::Stage(fault) = &told.about else { return true };
    let steps = step::steps(scene, trace);
    let is_denied = |step: &step::Step| {
        // Faults that are said of all steps.
        let is_always = matches!(fault, StageFault::Geometric(WrongGeometric::Left { always: true }));
        is_always && step.has_right_middle() && step.right_passes().1 > 0 && step.passes().1 > 0
    };
    steps.iter().any(|step| says::is_so(scene, step, fault)) && !steps.iter().any(is_denied)
}

/// The greatest number of polynomials of a step: two mistakes together may make a program that goes on for ever.
pub const MOST: usize = 20_000;

/// The sort of the statement about this program's trace of a scene, with the statement itself if it is false.
#[must_use]
pub fn checked(scene: &Scene, student: Student) -> Option<(String, Option<Explanation>)> {
    let trace = student::trace_within(scene, student, MOST).unwrap_or_else(|(bytes, _)| bytes);
    let told = explain_stages(scene, &trace)?;
    let About::Stage(fault) = &told.about else { return None };
    let sort = sort(fault);
    Some((sort, (!is_true(scene, &trace, &told)).then_some(told)))
}

/// The sort of a sentence: two of one sort differ in the names that they fill in.
#[must_use]
pub fn sort(fault: &StageFault) -> String {
    let variant = |value: &dyn std::fmt::Debug| {
        let text = format!("{value:?}");
        text.split(|letter: char| !letter.is_alphanumeric()).next().unwrap_or("").to_owned()
    };
    match fault {
        StageFault::Decisions { wrong, .. } => format!("Decisions {wrong:?}"),
        StageFault::ContactVectors { wrong, .. } => format!("ContactVectors {wrong:?}"),
        StageFault::Responses { wrong, in_rounds, .. } => {
            format!("Responses {} {}", variant(wrong), if *in_rounds { "in rounds" } else { "alone" })
        }
        StageFault::HandedOver { when, .. } => {
            format!("HandedOver {}", when.map_or_else(String::new, |when: LoopEnd| format!("{when:?}")))
        }
        StageFault::Motion { wrong, .. } => {
            format!("Motion {}", wrong.iter().map(|one| format!("{one:?}")).collect::<Vec<_>>().join("+"))
        }
        other => format!("{other:?}"),
    }
}

#[cfg(test)]
mod tests;
