//! Reads a trace once, and collects the data for its explanations. Every step is searched for wrong records, for
//! detections, and for values that are not finite. One budget limits the reference's work for all three.
mod capture;
mod compare;
mod detections;
mod reference;
mod scan;
mod source;

pub use capture::Capture;
pub use compare::{
    CLEAR_TOLERANCE, LoggedNumbers, ROUND_OFF, StepDifference, StepRecords, Tolerance, find_first_difference,
    find_state_difference, formula_matches, impulse_matches, polynomial_matches,
};
pub use detections::{Detections, Sample, pair_particles};
pub use reference::Reference;
pub use scan::{KeptStep, Scan, Scanner};
pub use source::{Source, StepFrames, StepReader};

use super::{Explanation, non_finite::NonFiniteSearch};
use fosssim_model::scene::Scene;

/// The data for explanations.
pub struct TraceSamples<'a> {
    /// The reference, and the rest of its budget.
    pub reference: Reference<'a>,
    /// The explanation of the first value that is not finite.
    pub non_finite_explanation: Option<Explanation>,
    /// The selected wrong and right steps.
    pub scan: Scan,
    /// The detections whose inputs are known.
    pub detections: Vec<Sample>,
}

/// Reads a trace once, and returns what explanations need.
pub fn sample_trace<'a>(scene: &'a Scene, source: Source<'a>) -> TraceSamples<'a> {
    let (mut steps, mut reference) = (StepReader::new(scene, source), Reference::new(scene));
    let (mut first, mut scanner, mut detections) =
        (NonFiniteSearch::default(), Scanner::new(scene), Detections::new(scene));
    first.check_first_record(&steps.frames);
    while let Some(step) = steps.next() {
        first.examine_step(&mut reference, scene, step, &steps.frames);
        scanner.examine_step(&mut reference, step, &steps.frames);
        detections.examine_step(&mut reference, step, &steps.frames);
    }
    TraceSamples {
        non_finite_explanation: first.explain(),
        scan: scanner.into_scan(steps.outline),
        detections: detections.into_samples(),
        reference,
    }
}
