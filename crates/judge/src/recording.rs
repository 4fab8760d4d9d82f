//! Judges a trace against a recording instead of the reference simulator: frame by frame, with the same tolerances.
//!
//! Unlike in lock step, errors accumulate: after the first difference the two runs diverge, and later differences prove
//! little. However, the submission's states are not used, so wrong initial states, responses and integrators are found
//! that the original's rules accept (oracle-behavior.md 8.1 to 8.3). Both frames of a step are compared, and the
//! initial record.
use super::{
    finding::{PolynomialPlace, Role},
    outcome::{Outcome, Stop},
    progress::Progress,
    tally::{self, StepResult, Tally, TallyBuffers},
};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{Impulse, Observer, Pair, PairKind, Pairs, Pass, Stage, pairs},
    trace::{Layout, LenientFrame, LenientReader, LoggedImpulse, record_memory},
};
use std::io::Read;

/// The reason why a trace cannot be judged against a recording. The recording is always at fault.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the recording is damaged: frame {frame}, byte {offset}: {message}; record it again")]
pub struct RecordingError {
    /// The number of the frame, from 0.
    pub frame: u64,
    /// The byte offset of the damage.
    pub offset: u64,
    /// A description of the damage.
    pub message: String,
}

/// Judges a trace against the recording of the same scene. The original's messages do not apply, so there are no
/// remarks.
///
/// # Errors
/// Fails if the recording is damaged or cut short.
pub fn judge<T: Read, R: Read>(
    scene: &Scene,
    mut trace: T,
    mut recording: R,
    progress: &mut dyn Progress,
) -> Result<Outcome, RecordingError> {
    compare(scene, &mut trace, &mut recording, progress)
}

/// Compares the frames for [`judge`]. The function is compiled only once for all readers.
fn compare(
    scene: &Scene,
    trace: &mut dyn Read,
    recording: &mut dyn Read,
    progress: &mut dyn Progress,
) -> Result<Outcome, RecordingError> {
    let layout = Layout::for_scene(scene);
    let places = RecordPlaces::for_scene(scene);
    let (mut trace, mut recording) =
        (LenientReader::new(trace, layout).with_limit(record_memory(scene)), LenientReader::new(recording, layout));
    let (mut actual, mut expected) = (LenientFrame::default(), LenientFrame::default());
    let (mut buffers, mut result) = (TallyBuffers::new(scene), StepResult::default());
    let mut outcome = Outcome::empty(layout.steps);
    let mut wrong_step = None;
    for frame in 0..layout.records() {
        recording.next(&mut expected).map_err(|stop| RecordingError {
            frame: stop.error.frame,
            offset: stop.error.offset,
            message: stop.error.what.to_string(),
        })?;
        let step = layout.step_of_record(frame);
        let is_end = step > 0 && !layout.is_mid_record(frame);
        if is_end {
            progress.observe_step_begin(step);
        }
        if let Err(stop) = trace.next(&mut actual) {
            let (offset, what) = (stop.error.offset, stop.error.what);
            outcome.stop = Some(Stop::Trace { frame, step, cause: stop.cause, offset, what });
            break;
        }
        outcome.damage = outcome.damage.or(actual.note.take());
        let damaged = outcome.damage.is_some();
        outcome.damaged_steps += u32::from(damaged && is_end);
        let mut tally = Tally::new((step, frame), &actual, None, true, &mut buffers, &mut result);
        expected.impulses.iter().filter_map(impulse).for_each(|impulse| tally.observe_impulse(&impulse));
        for index in 0..expected.polynomials.len() {
            tally.compare_polynomial(expected.polynomials.get(index), || places.place_at(index));
        }
        tally.finish(&expected.state, layout.has_impulses, layout.has_polynomials);
        tally::add_residuals(&mut outcome.parity.residuals, &result.residuals);
        outcome.parity.findings.counts += result.counts;
        if !damaged {
            result.first_findings.iter().for_each(|first| outcome.parity.findings.keep_first(first));
        }
        // Record 0 is the initial state, not a step.
        if result.counts.total() > 0 && step > 0 && wrong_step != Some(step) && !damaged {
            wrong_step = Some(step);
            outcome.parity.findings.wrong_steps += 1;
        }
        if is_end {
            outcome.steps_judged = step;
            progress.observe_step_end(step, &[]);
        } else if frame == 0 {
            progress.observe_begin();
        }
    }
    outcome.trailing_bytes = outcome.stop.is_none() && trace.has_more();
    outcome.conclude();
    Ok(outcome)
}

/// Returns the impulse that a logged impulse of an undamaged recording describes. Returns `None` if it does not name a
/// pair.
fn impulse(logged: &LoggedImpulse) -> Option<Impulse> {
    Some(Impulse { pair: logged.pair()?, normal: logged.normal, time: logged.time })
}

/// The facts about a scene from which the pass and the pair of each polynomial in a record follow.
struct RecordPlaces {
    pairs: Pairs,
    is_continuous: bool,
}

impl RecordPlaces {
    fn for_scene(scene: &Scene) -> Self {
        Self { pairs: pairs(scene), is_continuous: matches!(scene.collision, Collision::ContinuousTime { .. }) }
    }

    /// Returns the pass, pair and condition of polynomial `index` of a frame. In `hybrid` the recording does not show
    /// where the impulse rounds end, so passes are counted as rounds.
    fn place_at(&self, index: usize) -> PolynomialPlace {
        // A scene without pairs has no recording with polynomials, so this placeholder is never shown.
        let placeholder = (0, Pair { kind: PairKind::ParticleParticle, first: 0, second: 0 }, 0);
        let (number, pair, which) = self.pairs.locate_polynomial(index).unwrap_or(placeholder);
        let round = u32::try_from(number).unwrap_or(u32::MAX);
        let stage = if self.is_continuous { Stage::ContinuousTime } else { Stage::Impulses { round } };
        let pass = Pass { stage, index: round };
        PolynomialPlace { pass, pair, role: Role::from_number(pair.kind, which), index }
    }
}
