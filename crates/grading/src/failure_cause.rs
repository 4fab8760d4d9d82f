//! Finds what the scenes in which a program crashes or exceeds a limit have in common, by spectrum-based fault
//! localization.
//!
//! The spectrum of a scene consists of the features of the reference's run ([`coverage`](crate::coverage)), which are
//! kinds of events and values of their properties. A value is reported under three conditions: every failing scene
//! contains it; no other value is better by Ochiai's measure; and by Fisher's exact test, corrected for the number of
//! values, this is unlikely to be chance. Values that the scenes can't distinguish are reported together.
use super::coverage::{Coverage, FAMILIES};
pub use fosssim_findings::located_failure::{FailureKind, LocatedFailure, SceneFeature};
use fosssim_model::scene::Scene;
use std::collections::{BTreeMap, BTreeSet};

/// A kind of event, or a value of one of its properties, given by indices in [`FAMILIES`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct FeatureIndex {
    /// The index of the kind of event.
    pub family: usize,
    /// The index of the property, and the index of its value; `None` for all events of the kind.
    pub value: Option<(usize, usize)>,
}

/// The features of a scene, which are its spectrum.
pub type Features = BTreeSet<FeatureIndex>;

/// A scene that was run, and the way in which the program failed, if it failed.
#[derive(Debug, Clone, Copy)]
pub struct TriedScene<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// The kind of failure on the scene; `None` if the program did not fail.
    pub failure: Option<FailureKind>,
    /// The number of steps whose records are complete.
    pub steps: u32,
    /// The features of the reference's run of the scene.
    pub features: &'a Features,
}

/// The probability of chance, corrected for the number of values that were tried, from which a result is not reported.
const MAX_CHANCE_PROBABILITY: f64 = 0.01;

impl FeatureIndex {
    /// Returns all features of a scene. The set is empty if the scene can't be simulated to its end.
    pub fn for_scene(scene: &Scene) -> Features {
        let coverage = Coverage::for_scene(scene).unwrap_or_default();
        let values = coverage.values().map(|(family, axis, value)| Self { family, value: Some((axis, value)) });
        let kinds = coverage.values().map(|(family, ..)| Self { family, value: None });
        values.chain(kinds).collect()
    }

    /// Returns the feature with names instead of indices.
    fn to_feature(self) -> SceneFeature {
        let family = &FAMILIES[self.family];
        let value = |(axis, value): (usize, usize)| {
            let axis = &family.axes[axis];
            [axis.name.into(), axis.values[value].into()]
        };
        SceneFeature { family: family.name.into(), value: self.value.map(value) }
    }

    /// Returns the rank of a feature, by which features are sorted. Whole kinds of events come before single values.
    /// Among both, zones come first, then contacts, then whole steps. Pairs that do not collide come last.
    const fn rank(self) -> (bool, usize) {
        let rank = match self.family {
            4 => 0,
            0..=2 => 1,
            5 | 6 => 2,
            _ => 3,
        };
        (self.value.is_some(), rank)
    }
}

/// Returns the features that all failing scenes have in common; `None` if no scene fails, or if the evidence is weak.
pub fn locate_failure(all_scenes: &[TriedScene<'_>]) -> Option<LocatedFailure> {
    let failed: Vec<&TriedScene<'_>> = all_scenes.iter().filter(|tried| tried.failure.is_some()).collect();
    let first = failed.first()?;
    let mut shared = first.features.clone();
    failed.iter().for_each(|tried| shared.retain(|feature| tried.features.contains(feature)));
    let mut with: BTreeMap<usize, Vec<FeatureIndex>> = BTreeMap::new();
    for feature in shared {
        let scene_count = all_scenes.iter().filter(|tried| tried.features.contains(&feature)).count();
        with.entry(scene_count).or_default().push(feature);
    }
    // Because every failing scene contains the value, Ochiai's measure is the square root of `failed / with`. A value
    // is better if fewer scenes contain it.
    let (with, mut features) = with.into_iter().next()?;
    let looked_at: BTreeSet<Vec<bool>> = all_scenes
        .iter()
        .flat_map(|tried| tried.features)
        .collect::<BTreeSet<_>>()
        .into_iter()
        .map(|feature| all_scenes.iter().map(|tried| tried.features.contains(feature)).collect())
        .collect();
    #[expect(clippy::cast_precision_loss, reason = "numbers of scenes are small")]
    let chance = chance_probability(failed.len(), with, all_scenes.len()) * looked_at.len() as f64;
    if chance >= MAX_CHANCE_PROBABILITY || 2 * failed.len() < with {
        return None;
    }
    features.sort_by_key(|feature| feature.rank());
    // If a whole kind of event is reported, single values of that kind are left out.
    let kinds: Vec<usize> =
        features.iter().filter(|feature| feature.value.is_none()).map(|feature| feature.family).collect();
    features.retain(|feature| feature.value.is_none() || !kinds.contains(&feature.family));
    let failing = failed.iter().filter_map(|one| one.failure).reduce(|one, other| match one == other {
        true => one,
        false => FailureKind::Several,
    })?;
    Some(LocatedFailure {
        failure: failing,
        features: features.into_iter().map(FeatureIndex::to_feature).collect(),
        failed_scenes: failed.len(),
        scenes_with_features: with,
        scenes_without_features: all_scenes.len() - with,
        first_scene: first.scene.to_owned(),
        step: first.steps,
    })
}

/// Returns the probability that `failed` scenes, drawn at random from `all`, are all among `eligible` particular ones.
fn chance_probability(failed: usize, eligible: usize, all: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "numbers of scenes are small")]
    let share = |one: usize| (eligible - one) as f64 / (all - one) as f64;
    (0..failed).map(share).product()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn feature(family: usize, value: Option<(usize, usize)>) -> FeatureIndex {
        FeatureIndex { family, value }
    }

    /// Returns the features of scenes that each have a contact. Some have a zone, and some of these zones touch a
    /// half-plane.
    fn scenes(zones: usize, held: usize, all: usize) -> Vec<Features> {
        let scene = |number: usize| {
            let mut features = Features::from([feature(0, None), feature(0, Some((0, number % 3)))]);
            if number < zones {
                features.extend([
                    feature(4, None),
                    feature(4, Some((1, usize::from(number < held)))),
                    feature(6, Some((1, 1))),
                ]);
            }
            features
        };
        (0..all).map(scene).collect()
    }

    fn located(features: &[Features], fails: impl Fn(usize) -> Option<FailureKind>) -> Option<LocatedFailure> {
        let tried = |(number, features)| TriedScene { scene: "a/b", failure: fails(number), steps: 7, features };
        locate_failure(&features.iter().enumerate().map(tried).collect::<Vec<_>>())
    }

    #[test]
    fn common_features_of_failing_scenes_are_reported_with_counts() {
        let features = scenes(24, 9, 85);
        let found = located(&features, |number| (number < 24).then_some(FailureKind::Crash)).expect("a place");
        assert_eq!(
            (found.failed_scenes, found.scenes_with_features, found.scenes_without_features, found.step),
            (24, 24, 61, 7)
        );
        // Both the kind of event and a property of the step that occurs in the same scenes are reported. The zones' own
        // values are not another feature.
        assert_eq!(found.features, [feature(4, None), feature(6, Some((1, 1)))].map(FeatureIndex::to_feature));
        let narrower = located(&features, |number| (number < 9).then_some(FailureKind::Time)).expect("a place");
        assert_eq!(
            (narrower.features, narrower.scenes_with_features),
            (vec![feature(4, Some((1, 1))).to_feature()], 9)
        );
        let most =
            located(&features, |number| (number < 24 && number != 5).then_some(FailureKind::Crash)).expect("a place");
        assert_eq!((most.failed_scenes, most.scenes_with_features, most.scenes_without_features), (23, 24, 61));
        let mixed = |number: usize| if number.is_multiple_of(2) { FailureKind::Time } else { FailureKind::Memory };
        let found = located(&features, |number| (number < 24).then_some(mixed(number))).expect("a place");
        assert_eq!(found.failure, FailureKind::Several);
    }

    #[test]
    fn weak_evidence_tells_nothing() {
        let features = scenes(24, 9, 85);
        assert_eq!(located(&features, |_| None), None);
        assert_eq!(located(&features, |_| Some(FailureKind::Crash)), None, "what always fails has no place");
        assert_eq!(located(&features, |number| (number == 3).then_some(FailureKind::Crash)), None, "once is nothing");
        assert_eq!(
            located(&features, |number| (number % 8 == 0).then_some(FailureKind::Crash)),
            None,
            "nothing in common"
        );
        assert_eq!(located(&features, |number| (number < 24 || number == 60).then_some(FailureKind::Crash)), None);
        assert_eq!(
            located(&features, |number| (number < 4).then_some(FailureKind::Crash)),
            None,
            "most that contain it do not fail"
        );
        assert_eq!(
            located(&scenes(3, 0, 4), |number| (number < 3).then_some(FailureKind::Crash)),
            None,
            "too few scenes"
        );
    }
}
