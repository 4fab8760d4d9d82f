//! Combines the explanations of a trace.
use super::{
    Detail, Explanation,
    known::{KnownMistakes, explain_kept_steps, is_empty_stage},
    naming::has_same_meaning,
    near_pairs, non_finite, polynomial,
    sampling::{KeptStep, Source, TraceSamples, sample_trace},
    stages,
    topic::ExplanationTopic,
};
use fosssim_judge::kept_trace::KeptTrace;
use fosssim_model::{
    assignments::Assignment,
    scene::Scene,
    sim::{PairKind, pairs},
    trace::Layout,
};
use fosssim_student::{Area, Row, assignments::t2m2::Subject, find};

/// The maximum number of pairs for explanations if steps log polynomials. Explanations keep whole steps of the
/// reference, and a step takes a few hundred bytes per pair. Above the limit, only the first value that is not finite
/// is reported.
const MAX_PAIRS: usize = 400_000;

/// Returns the likely mistakes of the program that wrote the trace, the likeliest first. The list is empty if nothing
/// is wrong, or if no known mistake explains it.
///
/// A known mistake that reproduces all wrong steps comes first, with the details of polynomials that it gets wrong.
/// Otherwise the explanations of polynomials come first: those that reproduce all their samples, then those that
/// reproduce a part. The judge decides whether a trace is right: callers should pass traces that the fair rules reject.
/// Traces of any content are accepted. Bytes after the first 64 MiB, and an incomplete record, are ignored. For a trace
/// that seems to be from another scene, the only explanation asks whether the trace belongs to this one
/// ([`Explanation::is_other_scene`]).
pub fn explain(scene: &Scene, trace: &[u8]) -> Vec<Explanation> {
    explain_source(scene, Source::from_trace(trace))
}

/// Returns the explanations of the kept part of a trace, like [`explain`].
pub fn explain_kept_trace(scene: &Scene, trace: &KeptTrace) -> Vec<Explanation> {
    explain_source(scene, trace.into())
}

/// Returns the explanations of a trace like [`explain`], with records from any source.
fn explain_source(scene: &Scene, source: Source<'_>) -> Vec<Explanation> {
    if Layout::for_scene(scene).has_polynomials && pairs(scene).count() > MAX_PAIRS {
        return non_finite::explain_source(scene, source);
    }
    let TraceSamples { mut reference, non_finite_explanation, scan, detections } = sample_trace(scene, source);
    // In the contest, students write only the search for nearby pairs.
    let is_contest = scene.assignment() == Assignment::T2M3;
    let pairs = if is_contest { near_pairs::explain_pairs(&mut reference, scene, &scan) } else { None };
    let KnownMistakes { explanations: mut known, unexplained: open, contradicted_keys: denies } =
        explain_kept_steps(&mut reference, scene, scan);
    if known.iter().any(Explanation::is_other_scene) {
        return known;
    }
    let mut polynomials = polynomial::explain_polynomials(&detections);
    if known.iter().any(|explanation| find(&explanation.key).is_some_and(is_empty_stage)) {
        polynomials.retain(|explanation| !explanation.reports_missing_polynomials());
    }
    for explanation in &mut known {
        let formula_kind = find(&explanation.key).filter(|row| is_formula_area(row.area)).map(|row| row.pair_kind());
        if let Some(kind) = formula_kind {
            let concerns_kind = |claim: &&String| {
                let kinds = PairKind::ALL.into_iter().filter(|candidate| kind.is_none_or(|kind| kind == *candidate));
                kinds.flat_map(Subject::all_of_kind).any(|subject| claim.starts_with(&format!("{subject:?}/")))
            };
            let claims = polynomials.iter().flat_map(|explanation| &explanation.claims);
            explanation.claims = claims.filter(concerns_kind).cloned().collect();
        }
    }
    if let [explanation] = &mut known[..]
        && find(&explanation.key).is_some_and(|row| is_formula_area(row.area))
        && explanation.is_complete()
    {
        // A guess that explains all samples of its polynomials means the same mistake as the known one. Its terms and
        // its example are added.
        let is_reported = |own: &Explanation| !own.is_unexplained() && own.is_complete();
        for own in std::mem::take(&mut polynomials).into_iter().filter(is_reported) {
            // The hint for a remedy stays last, and a mistake that is already reported is not repeated.
            let remedy_index = explanation.details.len().saturating_sub(1);
            if !explanation.key.ends_with(&own.key) {
                explanation.details.splice(remedy_index..remedy_index, own.details);
            }
            explanation.example = own.example.or(explanation.example.take());
        }
    }
    if known.iter().any(Explanation::is_complete) {
        // The known mistake reproduces whole steps, so other faults of polynomials only follow from it.
        polynomials.clear();
    }
    // A known mistake may explain all polynomials even if another mistake prevents it from explaining whole steps.
    known.retain(|explanation| {
        let is_reported = |other: &Explanation| {
            other.is_complete() && find(&explanation.key).is_some_and(|row| has_same_meaning(other, row))
        };
        explanation.is_complete() || !polynomials.iter().any(is_reported)
    });
    let open = open.filter(|_| !is_contest);
    let stage = open.and_then(|scan| {
        let is_finite = |kept: &&KeptStep| kept.records.is_finite();
        stages::explain(&mut reference, scene, scan.wrong_steps.iter().chain(&scan.right_steps).filter(is_finite))
    });
    if stage.as_ref().is_some_and(Explanation::is_about_pairs) {
        // If pairs are in a different order, or left out, their polynomials cannot be compared.
        polynomials.clear();
    }
    let mut all = known;
    all.append(&mut polynomials);
    all.extend(pairs);
    all.iter_mut().for_each(add_letter_note);
    all.extend(stage);
    // The sort is stable, so a known mistake stays before equally good guesses.
    all.sort_by_key(|explanation| (explanation.is_unexplained(), !explanation.is_complete()));
    all.extend(non_finite_explanation);
    all.iter_mut().for_each(|explanation| explanation.contradicted_keys.clone_from(&denies));
    all
}

/// Adds a note after an explanation's formulas, at most once, so that the report explains their letters.
fn add_letter_note(explanation: &mut Explanation) {
    if explanation.is_unexplained() {
        return;
    }
    let row = find(&explanation.key);
    let kinds = match &explanation.topic {
        ExplanationTopic::Mistake => row.and_then(Row::pair_kind).into_iter().collect(),
        about => about.kinds(),
    };
    // The last line of a known mistake names what to check.
    let end = explanation.details.len() - usize::from(row.is_some());
    if end > 0 {
        explanation.details.insert(end, Detail::Letters(kinds));
    }
}

/// Returns whether mistakes in an area of the assignment are mistakes in polynomials.
pub(super) const fn is_formula_area(area: Area) -> bool {
    matches!(area, Area::ParticleParticle | Area::ParticleEdge | Area::ParticleHalfPlane | Area::Handover)
}
