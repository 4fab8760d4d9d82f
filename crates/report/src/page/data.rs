//! The data for the motion viewer: one JSON block per case, and the motions as packed doubles.
use super::{
    Case, markup,
    packed_motions::{PackedMotions, Precision, Rounding},
};
use crate::{
    check::{consequences, first_finding::find_first},
    describe::pair_key,
};
use fosssim_evidence::{Evidence, InspectedPass, InspectedStep, Track};
use fosssim_findings::Hints;
use fosssim_judge::{FindingDetail, PassText};
use fosssim_model::{
    scene::{self, Scene},
    sim::{Impulse, Pair, State},
    trace::LoggedImpulse,
};
use serde_json::{Value, json};
use std::fmt::Write;

/// Returns all data blocks of a case.
pub(super) fn render_blocks(case: &Case<'_>, evidence: &Evidence, key: &str, precision: Precision) -> String {
    // With restricted hints, the page contains only data that the program itself wrote.
    let is_full = case.hints == Hints::Full;
    let reference = is_full.then_some(("reference", &evidence.reference));
    // If the run with the mistake equals the trace bit for bit, its motion is not stored.
    let what = case.mistake_run.filter(|what| is_full && !what.equal).map(|what| ("what", &what.track));
    let tracks: Vec<(&str, &Track)> =
        [("submission", &evidence.submission)].into_iter().chain(reference).chain(what).collect();
    let PackedMotions { blocks, rounded } = PackedMotions::from_evidence(evidence, &tracks, precision);
    let mut out = String::new();
    let data = markup::render_data(&case_data(case, evidence, rounded.as_ref()));
    let _ = writeln!(out, r#"<script type="application/json" id="case-{key}">{data}</script>"#);
    for ((name, _), block) in tracks.iter().zip(blocks) {
        let _ = writeln!(out, r#"<script type="application/octet-stream" id="{name}-{key}">{block}</script>"#);
    }
    out
}

fn case_data(case: &Case<'_>, evidence: &Evidence, rounded: Option<&Rounding>) -> Value {
    let is_full = case.hints == Hints::Full;
    let inspected: &[InspectedStep] = if is_full { &evidence.inspected } else { &[] };
    let Scene { particles, edges, half_planes, .. } = case.scene;
    let forces: Vec<String> = case.scene.forces.iter().map(ToString::to_string).collect();
    let strip: String = evidence.steps.iter().map(|step| step.class.letter()).collect();
    let calls = inspected.iter().flat_map(|up| {
        up.calls.iter().map(|call| {
            let zeros: Vec<f64> = match &call.study {
                Ok(study) => study.curves.iter().flat_map(|curve| curve.real_zeros()).collect(),
                Err(_) => Vec::new(),
            };
            json!({"step": up.step, "pair": pair_key(call.pair), "zeros": zeros})
        })
    });
    let first = find_first(&case.check);
    let particle = first.filter(|_| is_full).and_then(|first| match first.detail {
        FindingDetail::Position { particle, .. } | FindingDetail::Velocity { particle, .. } => Some(particle),
        _ => None,
    });
    json!({
        "scene": markup::replace_invisible_characters(case.check.scene),
        "traceName": case.has_trace.then(|| markup::replace_invisible_characters(case.check.trace)),
        "full": is_full,
        "collision": case.scene.collision.kind().name(),
        "collisionTag": scene::collision_element(case.scene.collision),
        "integrator": scene::integrator_element(case.scene),
        "forces": forces,
        "rounded": rounded.map(|rounded| json!({"unit": rounded.unit, "exact": rounded.exact})),
        "dt": case.scene.time_step,
        "steps": evidence.layout.steps,
        "per": evidence.layout.records_per_step(),
        "n": particles.len(),
        "first": evidence.window.first,
        "last": evidence.window.last,
        "focus": first.map(|first| first.step),
        "particle": particle,
        "radii": particles.iter().map(|particle| particle.radius).collect::<Vec<_>>(),
        "masses": particles.iter().map(|particle| particle.mass).collect::<Vec<_>>(),
        "fixed": particles.iter().map(|particle| particle.fixed).collect::<Vec<_>>(),
        "edges": edges.iter().map(|edge| json!([edge.first, edge.second, edge.radius])).collect::<Vec<_>>(),
        "planes": half_planes.iter()
            .map(|plane| [plane.point.x, plane.point.y, plane.normal.x, plane.normal.y]).collect::<Vec<_>>(),
        "strip": strip,
        "follows": consequences::count_consequences(case.check.outcome) > 0,
        "closeUps": inspected.iter().map(|up| inspected_step(up, evidence)).collect::<Vec<_>>(),
        "calls": calls.collect::<Vec<_>>(),
        "whatIf": case.mistake_run.filter(|_| is_full)
            .map(|what| json!({"id": what.id, "text": what.sentence, "equal": what.equal})),
    })
}

fn inspected_step(inspected: &InspectedStep, evidence: &Evidence) -> Value {
    let step = (inspected.step as usize).checked_sub(1).and_then(|index| evidence.steps.get(index));
    json!({
        "step": inspected.step,
        "mid": inspected.expected_mid.as_ref().map(state_data),
        "end": inspected.expected_end.as_ref().map(state_data),
        "passes": inspected.passes.iter().map(pass_data).collect::<Vec<_>>(),
        "expected": inspected.expected_contacts.iter().map(contact_data).collect::<Vec<_>>(),
        "actual": inspected.actual_contacts.iter().filter_map(encode_logged).take(200).collect::<Vec<_>>(),
        "zones": inspected.zones.iter().map(|zones| json!({
            "round": zones.round,
            "zones": zones.zones.iter()
                .map(|(particles, plane)| json!({"particles": particles, "halfPlane": plane})).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "polynomials": [inspected.expected_polynomials, inspected.actual_polynomials],
        "surplus": inspected.surplus_polynomials,
        "expectedPasses": inspected.expected_passes,
        "actualPasses": step.and_then(|step| step.actual_passes),
    })
}

fn state_data(state: &State) -> Vec<f64> {
    state.positions.iter().chain(&state.velocities).copied().collect()
}

fn pass_data(up: &InspectedPass) -> Value {
    json!({
        "name": PassText(up.pass).to_string(),
        "q": up.q_end,
        "calls": up.calls,
        "hits": up.hits.iter().map(contact_data).collect::<Vec<_>>(),
        "differing": pair_keys(&up.differing_pairs),
        "missing": pair_keys(&up.missing_pairs),
        "repeated": pair_keys(&up.repeated_pairs),
        "logged": up.is_logged,
    })
}

fn pair_keys(pairs: &[Pair]) -> Vec<String> {
    pairs.iter().map(|pair| pair_key(*pair)).collect()
}

fn contact_data(impulse: &Impulse) -> Value {
    json!([pair_key(impulse.pair), impulse.time, impulse.normal.x, impulse.normal.y])
}

fn encode_logged(impulse: &LoggedImpulse) -> Option<Value> {
    let pair = format!("{}:{},{}", impulse.kind()?.short(), impulse.first, impulse.second);
    Some(json!([pair, impulse.time, impulse.normal.x, impulse.normal.y]))
}
