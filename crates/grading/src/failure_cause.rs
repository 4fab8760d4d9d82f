//! Finds what the scenes in which a program crashes or exceeds a limit have in common, by spectrum-based fault
//! localization.
//!
//! The spectrum of a scene consists of the contents of the reference's run ([`coverage`](crate::coverage)), which are
//! kinds of events and values of their properties. A value is reported under three conditions: every failing scene
//! contains it; no other value is better by Ochiai's measure; and by Fisher's exact test, corrected for the number of
//! values, this is unlikely to be chance. Values that the scenes can't distinguish are reported together.
use super::coverage::{Coverage, FAMILIES};
pub use fosssim_findings::located_failure::{Content, FailureKind, LocatedFailure};
use fosssim_model::scene::Scene;
use std::collections::{BTreeMap, BTreeSet};

/// A kind of event, or a value of one of its properties, given by indices in [`FAMILIES`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct ContentIndex {
    /// The index of the kind of event.
    pub family: usize,
    /// The index of the property, and the index of its value; `None` for all events of the kind.
    pub value: Option<(usize, usize)>,
}

/// The contents of a scene, which are its spectrum.
pub type Contents = BTreeSet<ContentIndex>;

/// A scene that was run, and how the program failed, if it did.
#[derive(Debug, Clone, Copy)]
pub struct TriedScene<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// The way in which the program failed on the scene; `None` if it did not fail.
    pub failure: Option<FailureKind>,
    /// The number of steps whose records are complete.
    pub steps: u32,
    /// The contents of the reference's run of the scene.
    pub contents: &'a Contents,
}

/// The largest probability of chance, over all values that were tried, at which a result is still reported.
const MAX_CHANCE_PROBABILITY: f64 = 0.01;

impl ContentIndex {
    /// Returns everything that a scene contains; empty if it can't be simulated to its end.
    pub fn for_scene(scene: &Scene) -> Contents {
        let coverage = Coverage::for_scene(scene).unwrap_or_default();
        let values = coverage.values().map(|(family, axis, value)| Self { family, value: Some((axis, value)) });
        let kinds = coverage.values().map(|(family, ..)| Self { family, value: None });
        values.chain(kinds).collect()
    }

    /// Returns the content with names instead of indices.
    fn to_content(self) -> Content {
        let family = &FAMILIES[self.family];
        let value = |(axis, value): (usize, usize)| {
            let axis = &family.axes[axis];
            [axis.name.into(), axis.values[value].into()]
        };
        Content { family: family.name.into(), value: self.value.map(value) }
    }

    /// Returns the rank of a content, by which contents are sorted. Contents of zones come first, then those of
    /// contacts, then those of whole steps. Values that mean the absence of something come last.
    const fn rank(self) -> (bool, usize) {
        let place = match self.family {
            4 => 0,
            0..=2 => 1,
            5 | 6 => 2,
            _ => 3,
        };
        (self.value.is_some(), place)
    }
}

/// Returns the contents that all failing scenes have in common; `None` if the evidence for them is weak.
pub fn locate_failure(tried: &[TriedScene<'_>]) -> Option<LocatedFailure> {
    let failed: Vec<&TriedScene<'_>> = tried.iter().filter(|one| one.failure.is_some()).collect();
    let first = failed.first()?;
    let mut shared = first.contents.clone();
    failed.iter().for_each(|one| shared.retain(|content| one.contents.contains(content)));
    let mut with: BTreeMap<usize, Vec<ContentIndex>> = BTreeMap::new();
    for content in shared {
        let scenes = tried.iter().filter(|one| one.contents.contains(&content)).count();
        with.entry(scenes).or_default().push(content);
    }
    // Because every failing scene contains the value, Ochiai's measure is the square root of `failed / with`. A value
    // is better if fewer scenes contain it.
    let (with, mut contents) = with.into_iter().next()?;
    let looked_at: BTreeSet<Vec<bool>> = tried
        .iter()
        .flat_map(|one| one.contents)
        .collect::<BTreeSet<_>>()
        .into_iter()
        .map(|content| tried.iter().map(|one| one.contents.contains(content)).collect())
        .collect();
    #[expect(clippy::cast_precision_loss, reason = "numbers of scenes are small")]
    let by_chance = chance_probability(failed.len(), with, tried.len()) * looked_at.len() as f64;
    if by_chance >= MAX_CHANCE_PROBABILITY || 2 * failed.len() < with {
        return None;
    }
    contents.sort_by_key(|content| content.rank());
    // A value that all events of a kind have is left out, because the kind alone says the same.
    let kinds: Vec<usize> =
        contents.iter().filter(|content| content.value.is_none()).map(|content| content.family).collect();
    contents.retain(|content| content.value.is_none() || !kinds.contains(&content.family));
    let failing = failed.iter().filter_map(|one| one.failure).reduce(|one, other| match one == other {
        true => one,
        false => FailureKind::Several,
    })?;
    Some(LocatedFailure {
        failure: failing,
        contents: contents.into_iter().map(ContentIndex::to_content).collect(),
        failed: failed.len(),
        scenes_with_contents: with,
        scenes_without_contents: tried.len() - with,
        first: first.scene.to_owned(),
        step: first.steps,
    })
}

/// Returns the probability that `failed` scenes, drawn at random from `all`, are all among `with` particular ones.
fn chance_probability(failed: usize, with: usize, all: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "numbers of scenes are small")]
    let share = |one: usize| (with - one) as f64 / (all - one) as f64;
    (0..failed).map(share).product()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn content(family: usize, value: Option<(usize, usize)>) -> ContentIndex {
        ContentIndex { family, value }
    }

    /// Scenes by their contents: a contact each; some have a zone, of which some are held by a half-plane.
    fn scenes(zones: usize, held: usize, all: usize) -> Vec<Contents> {
        let scene = |number: usize| {
            let mut contents = Contents::from([content(0, None), content(0, Some((0, number % 3)))]);
            if number < zones {
                contents.extend([
                    content(4, None),
                    content(4, Some((1, usize::from(number < held)))),
                    content(6, Some((1, 1))),
                ]);
            }
            contents
        };
        (0..all).map(scene).collect()
    }

    fn located(contents: &[Contents], fails: impl Fn(usize) -> Option<FailureKind>) -> Option<LocatedFailure> {
        let tried = |(number, contents)| TriedScene { scene: "a/b", failure: fails(number), steps: 7, contents };
        locate_failure(&contents.iter().enumerate().map(tried).collect::<Vec<_>>())
    }

    #[test]
    fn what_all_that_fail_and_no_others_contain_is_told_with_its_counts() {
        let contents = scenes(24, 9, 85);
        let found = located(&contents, |number| (number < 24).then_some(FailureKind::Crash)).expect("a place");
        assert_eq!(
            (found.failed, found.scenes_with_contents, found.scenes_without_contents, found.step),
            (24, 24, 61, 7)
        );
        // The kind of event, and a property of the step that the same scenes have; the zones' own values are no other
        // place.
        assert_eq!(found.contents, [content(4, None), content(6, Some((1, 1)))].map(ContentIndex::to_content));
        let narrower = located(&contents, |number| (number < 9).then_some(FailureKind::Time)).expect("a place");
        assert_eq!(
            (narrower.contents, narrower.scenes_with_contents),
            (vec![content(4, Some((1, 1))).to_content()], 9)
        );
        let most =
            located(&contents, |number| (number < 24 && number != 5).then_some(FailureKind::Crash)).expect("a place");
        assert_eq!((most.failed, most.scenes_with_contents, most.scenes_without_contents), (23, 24, 61));
        let mixed = |number: usize| if number.is_multiple_of(2) { FailureKind::Time } else { FailureKind::Memory };
        let found = located(&contents, |number| (number < 24).then_some(mixed(number))).expect("a place");
        assert_eq!(found.failure, FailureKind::Several);
    }

    #[test]
    fn weak_evidence_tells_nothing() {
        let contents = scenes(24, 9, 85);
        assert_eq!(located(&contents, |_| None), None);
        assert_eq!(located(&contents, |_| Some(FailureKind::Crash)), None, "what always fails has no place");
        assert_eq!(located(&contents, |number| (number == 3).then_some(FailureKind::Crash)), None, "once is nothing");
        assert_eq!(
            located(&contents, |number| (number % 8 == 0).then_some(FailureKind::Crash)),
            None,
            "nothing in common"
        );
        assert_eq!(located(&contents, |number| (number < 24 || number == 60).then_some(FailureKind::Crash)), None);
        assert_eq!(
            located(&contents, |number| (number < 4).then_some(FailureKind::Crash)),
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
