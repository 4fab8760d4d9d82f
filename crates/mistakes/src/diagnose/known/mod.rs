//! Finds the known mistake that reproduces a submission. Steps are simulated again with each mistake of the catalog.
//!
//! A submission's wrong steps are those whose records differ from the reference's by more than round-off. For a diverse
//! selection of them, and for several right steps with events, the second simulator ([`fosssim_student`]) starts from
//! the submission's own state and makes one mistake. The mistake explains the submission if everything that the step
//! logged is reproduced. This includes polynomials up to a positive factor, contacts, and the states in the middle and
//! at the end. The search never judges: a step that no mistake reproduces stays wrong. Correct variants of the
//! catalog are tried as well, and if one of them reproduces the steps, no mistake is named.
//!
//! The mathematics is that of the two simulators; the only tolerances are those of [`sampling`](super::sampling).
mod alignment;
mod applicable_rows;
mod candidates;
mod combinations;
mod contradictions;
mod example;
mod resimulate;
mod trials;
mod visibility;

pub(super) use applicable_rows::has_effect;
pub use applicable_rows::may_change_trace;
pub(super) use combinations::is_empty_stage;
pub use visibility::mistake_is_visible;
pub(super) use visibility::{MistakeEffect, find_effect};

use super::{
    Detail, Explanation,
    sampling::{ROUND_OFF, Reference, Scan, Source, TraceSamples, find_first_difference, sample_trace},
    topic::ExplanationTopic,
};
use candidates::Candidates;
use combinations::RowCombination;
use fosssim_model::{scene::Scene, trace::Layout};
use fosssim_student::{Mistake, Row, RowKind, StepLog, StepMistake, World, find};
use resimulate::{ApproachForm, resimulate};
use trials::Trials;

/// Returns the mistakes of the catalog that explain a trace.
///
/// The result is empty if all steps are right, or if no mistake reproduces at least half of the wrong steps. It is also
/// empty if a correct variant reproduces these steps. Otherwise it holds one explanation, or those of up to three
/// mistakes that reproduce the steps together, in addition to empty stages. Further mistakes that reproduce the same
/// steps are in [`Explanation::same_as`]. An empty stage comes first, otherwise the earliest in the assignment's order:
/// polynomials, contact vectors, decisions, responses, loops, zones, failsafe, trace.
///
/// [`Explanation::samples`] and [`Explanation::reproduced`] count wrong steps. Right steps that the mistake would make
/// wrong exclude it. Traces of any content are accepted. Unreadable parts, damaged records, and bytes after the first
/// 64 MiB are ignored. If the first record belongs to another scene, the only explanation asks whether the trace
/// belongs to this one ([`Explanation::OTHER_SCENE`]).
pub fn find_known(scene: &Scene, trace: &[u8]) -> Vec<Explanation> {
    let TraceSamples { mut reference, scan, .. } = sample_trace(scene, Source::from_trace(trace));
    explain_kept_steps(&mut reference, scene, scan).explanations
}

/// Returns whether a correct program with exactly one of the mistakes `keys` makes all kept wrong steps of a trace.
/// This needs much less work than [`find_known`].
pub fn reproduces(scene: &Scene, trace: &[u8], keys: &[&str]) -> bool {
    let TraceSamples { reference, scan, .. } = sample_trace(scene, Source::from_trace(trace));
    let rows: Vec<&'static Row> = keys.iter().filter_map(|key| find(key)).collect();
    [ApproachForm::Supplied, ApproachForm::RightApproach].into_iter().any(|correct| {
        let trials = Trials::new(&reference, scene, correct);
        let mut programs = rows.iter().map(|row| trials.program(&[row]));
        programs.any(|program| scan.wrong_steps.iter().all(|kept| trials.reproduced_share(&program, kept) >= 1.0))
    })
}

/// The catalog's explanations of a trace, and the unexplained rest.
#[derive(Debug, Default)]
pub(super) struct KnownMistakes {
    /// The mistakes, the likeliest first.
    pub(super) explanations: Vec<Explanation>,
    /// The kept steps, if no mistake explains all of them.
    pub(super) unexplained: Option<Scan>,
    /// The keys of stages that are not empty, because they are visible in the trace.
    pub(super) contradicted_keys: Vec<String>,
}

/// Returns the catalog's explanations of kept steps, and the steps themselves if no mistake explains all of them.
pub(super) fn explain_kept_steps(reference: &mut Reference<'_>, scene: &Scene, mut scan: Scan) -> KnownMistakes {
    let only = |explanation: Explanation| KnownMistakes { explanations: vec![explanation], ..KnownMistakes::default() };
    if let Some(missing) = alignment::find_missing_record(scene, &scan) {
        return only(missing);
    }
    if scan.outline.belongs_to_other_scene(scene) {
        let (layout, outline) = (Layout::for_scene(scene), &scan.outline);
        let has_length = !outline.is_longer && outline.records.is_none_or(|records| records == layout.records());
        return only(Explanation::for_other_scene(has_length));
    }
    let denies = contradictions::find_contradicted_keys(scene, &scan);
    let (mut explanations, is_settled) = explain_wrong_steps(reference, scene, &mut scan);
    explanations.retain(|explanation| explanation.is_complete() || !denies.contains(&explanation.key));
    if !explanations.is_empty() || scan.outline.padded_records == 0 {
        return KnownMistakes { explanations, unexplained: (!is_settled).then_some(scan), contradicted_keys: denies };
    }
    // The reader drops coefficients that the course's library would have dropped, so padded steps look right.
    let padded =
        find("log-padded").map(|row| row_explanation(row, (scan.outline.padded_records, scan.outline.padded_records)));
    KnownMistakes { explanations: padded.into_iter().collect(), unexplained: None, contradicted_keys: denies }
}

/// Returns the catalog's explanations, and whether they are complete. If no mistake explains the steps, it changes
/// `scan` to a comparison with a program whose approach polynomial is the mathematically right one.
fn explain_wrong_steps(reference: &mut Reference<'_>, scene: &Scene, scan: &mut Scan) -> (Vec<Explanation>, bool) {
    if scan.wrong_steps.is_empty() {
        return (Vec::new(), true);
    }
    let mut partly = None;
    for correct in [ApproachForm::Supplied, ApproachForm::RightApproach] {
        // The fair rules accept the right approach as well; it may hide a mistake of another kind.
        if correct == ApproachForm::RightApproach && !adopt_right_approach(scan, scene) {
            break;
        }
        let (explanation, is_complete) = find_best_mistake(reference, scene, scan, correct);
        if is_complete {
            return (explanation.into_iter().collect(), true);
        }
        if let Some(several) = combinations::find_row_set(reference, scene, scan, correct) {
            return (explain_combination(reference, scene, scan, correct, &several), true);
        }
        partly = partly.or(explanation);
    }
    (partly.into_iter().collect(), scan.wrong_steps.is_empty())
}

/// Compares the steps with a program whose particle-edge approach is mathematically right, which makes many wrong steps
/// right. Returns false if all become right, or if the scene has no edge.
fn adopt_right_approach(scan: &mut Scan, scene: &Scene) -> bool {
    if scene.edges.is_empty() {
        return false;
    }
    let world = World::new(scene.clone(), ApproachForm::RightApproach.with_mistake(None));
    let samples = std::mem::take(&mut scan.wrong_steps).into_iter().chain(std::mem::take(&mut scan.right_steps));
    for mut sample in samples {
        let logged_count = sample.records.end.polynomials.len();
        // A few more polynomials than were logged already show that some are missing; further ones are not needed.
        let guard = |index: usize, _: &[f64]| index < 2 * logged_count + MAX_SURPLUS_POLYNOMIALS;
        let expected = resimulate(&world, &sample.before, &mut StepLog { guard: Some(&guard), ..StepLog::default() });
        let Some(expected) = expected else { continue };
        sample.difference = find_first_difference(&expected, &sample.records, &ROUND_OFF);
        if sample.difference.is_some() { scan.wrong_steps.push(sample) } else { scan.right_steps.push(sample) }
    }
    scan.limit_right_steps();
    !scan.wrong_steps.is_empty()
}

/// The number of surplus polynomials, compared with the log, after which a step is stopped.
const MAX_SURPLUS_POLYNOMIALS: usize = 10_000;

/// Returns the explanations of several mistakes that reproduce the same steps together. Empty stages come first.
fn explain_combination(
    reference: &mut Reference<'_>,
    scene: &Scene,
    scan: &Scan,
    correct: ApproachForm,
    several: &RowCombination,
) -> Vec<Explanation> {
    let to_explanation = |(row, others): (&&'static Row, &Vec<&'static Row>)| {
        let rivals = several.rival_rows.iter().filter(|_| is_empty_stage(row));
        let same_as = others.iter().chain(rivals).map(|other| other.id.to_owned()).collect();
        Explanation { same_as, ..row_explanation(row, (several.samples, several.samples)) }
    };
    let mut all: Vec<Explanation> = several.rows.iter().zip(&several.equivalent_rows).map(to_explanation).collect();
    if let Some(first) = all.first_mut() {
        first.example = scan.wrong_steps.first().map(|sample| example::find_example(reference, scene, correct, sample));
    }
    all
}

/// Returns the mistake that reproduces most of the kept steps, and whether a row reproduces all of them. The mistake is
/// `None` if no row reproduces enough steps, or if a correct variant reproduces them.
fn find_best_mistake(
    reference: &mut Reference<'_>,
    scene: &Scene,
    scan: &Scan,
    correct: ApproachForm,
) -> (Option<Explanation>, bool) {
    let mut scores = Candidates::new(reference, scene, scan, correct).best_scores();
    scores.sort_by_key(|score| rank_plausibility(score.row));
    let (Some(best), Some(first)) = (scores.first(), scan.wrong_steps.first()) else { return (None, false) };
    let complete = best.reproduced == best.samples;
    if scores.iter().any(|score| score.row.kind == RowKind::Variant) {
        return (None, complete);
    }
    let explanation = Explanation {
        example: Some(example::find_example(reference, scene, correct, first)),
        same_as: scores[1..].iter().map(|score| score.row.id.to_owned()).collect(),
        ..row_explanation(best.row, (best.reproduced, best.samples))
    };
    (Some(explanation), complete)
}

/// Returns a rank among mistakes that a trace cannot distinguish; a smaller rank is likelier. Unwritten functions come
/// first, and mistakes that show only in special scenes come last. Rows of equal rank keep the catalog's order.
fn rank_plausibility(row: &Row) -> u8 {
    match row.mistake {
        Mistake::ParticleParticleEmpty
        | Mistake::ParticleEdgeEmpty
        | Mistake::HalfPlaneEmpty
        | Mistake::ParticleParticleZero
        | Mistake::ParticleEdgeZero
        | Mistake::HalfPlaneZero
        | Mistake::ImpulsesEmpty
        | Mistake::ImpulsesEmptySuccess
        | Mistake::GeometricEmpty
        | Mistake::FailsafeEmpty => 0,
        Mistake::Step(StepMistake::Edit(edit)) if edit.is_empty_function() => 0,
        Mistake::ImpulsesPassWhenZero
        | Mistake::ImpulsesTestWhenZero
        | Mistake::ImpulsesSuccessWhenZero
        | Mistake::ImpulsesOnceWhenZero => 2,
        _ => 1,
    }
}

/// Returns the explanation for a row, without an example.
fn row_explanation(row: &Row, (reproduced, samples): (u64, u64)) -> Explanation {
    Explanation {
        details: vec![Detail::Term(row.id.into()), Detail::SearchArea(row.area)],
        reproduced,
        samples,
        ..Explanation::with_topic(row.id, ExplanationTopic::Mistake)
    }
}

#[cfg(test)]
mod tests;
