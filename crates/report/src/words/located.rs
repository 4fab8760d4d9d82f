//! Describes what the scenes in which a program crashes or exceeds a limit have in common.
use fosssim_findings::located_failure::{LocatedFailure, SceneFeature};

/// The maximum number of further features that are named if the scenes can't distinguish them from the first one.
const MAX_NAMED_FEATURES: usize = 2;

/// Describes what the failing scenes have in common, with counts, and how the program ended in the first of them.
pub fn describe_located(found: &LocatedFailure) -> String {
    let LocatedFailure {
        failure,
        features,
        failed_scenes: failed,
        scenes_with_features: with,
        scenes_without_features: without,
        first_scene: first,
        step,
    } = found;
    let Some((first_feature, others)) = features.split_first() else { return String::new() };
    let scenes = format!("{with} scenes {}", describe_feature(first_feature));
    let which = if failed == with { format!("All {scenes}") } else { format!("{failed} of the {scenes}") };
    let verb = failure.name();
    let record = match step {
        0 => "is the first one".to_owned(),
        step => format!("belongs to step {step}"),
    };
    let mut text = format!(
        "{which} {verb}, and none of the {without} others. In the scene {first}, the last complete record {record}."
    );
    if !others.is_empty() {
        let (shown, more) = others.split_at(others.len().min(MAX_NAMED_FEATURES));
        let shown: Vec<String> = shown.iter().map(describe_feature).collect();
        let more = if more.is_empty() { String::new() } else { format!("; and {} more", more.len()) };
        text += &format!(" Equally likely: those {}{more}.", shown.join("; those "));
    }
    text
}

/// Describes a feature of a scene as a relative clause, such as `in which the failsafe moves a zone (held by: a
/// half-plane)`.
fn describe_feature(feature: &SceneFeature) -> String {
    let SceneFeature { family, value } = feature;
    let value = value.as_ref().map(|[axis, value]| format!(" ({axis}: {value})"));
    let is_step = family.ends_with(" step");
    format!("{} {family}{}", if is_step { "with" } else { "in which" }, value.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_findings::located_failure::FailureKind;

    #[test]
    fn counts_and_ties_are_reported() {
        let feature = |family: &'static str, value: Option<[&'static str; 2]>| SceneFeature {
            family: family.into(),
            value: value.map(|words| words.map(Into::into)),
        };
        let found = LocatedFailure {
            failure: FailureKind::Crash,
            features: vec![
                feature("the failsafe moves a zone", None),
                feature("a hybrid step", Some(["zones", "one"])),
            ],
            failed_scenes: 24,
            scenes_with_features: 24,
            scenes_without_features: 61,
            first_scene: "GeometricTests/chain".to_owned(),
            step: 14,
        };
        assert_eq!(
            describe_located(&found),
            "All 24 scenes in which the failsafe moves a zone crash, and none of the 61 others. In the scene \
             GeometricTests/chain, the last complete record belongs to step 14. Equally likely: those with a hybrid \
             step (zones: one)."
        );
        let some = LocatedFailure {
            failure: FailureKind::Several,
            features: vec![feature("the failsafe moves a zone", Some(["held by", "a half-plane"]))],
            failed_scenes: 7,
            scenes_with_features: 9,
            step: 0,
            ..found
        };
        assert_eq!(
            describe_located(&some),
            "7 of the 9 scenes in which the failsafe moves a zone (held by: a half-plane) crash or run into a limit, \
             and none of the 61 others. In the scene GeometricTests/chain, the last complete record is the first one."
        );
    }
}
