//! What isolated contacts change, body by body.
use super::{
    ALIKE, Explanation, common_value, observation, sentence,
    story::{Facts, Hit},
    times,
};
use crate::diagnose::about::StepStage;
use crate::diagnose::known::{ROUND_OFF, same_impulse};
use fosssim_model::{
    scene::Scene,
    sim::{PairKind, Stage, State},
};
use fosssim_num::vector::{Vec2, at, length, unit};
use std::collections::BTreeMap;

/// The key of what is said of responses.
pub(super) const KEY: &str = "stage-response";

/// Changes below this are round-off (relative to the size of the numbers, and 1).
const SMALL: f64 = 1e-11;

/// Whose what: kind of pair, body, and whether it is the velocity.
type Place = (PairKind, usize, bool);

/// What a contact changed.
#[derive(Debug, Clone, Copy)]
struct Change {
    /// Along the contact vector, over what it should be; none where that is nothing.
    ratio: Option<f64>,
    /// Whether anything across it changed, too.
    across: bool,
    is_right: bool,
}

/// What isolated contacts changed, whose bodies have no other contact in the step.
pub(super) struct Responses {
    changes: BTreeMap<Place, Vec<Change>>,
    contacts: usize,
    /// Contacts of impulse rounds that changed nothing: nobody knows whether they were found.
    unresolved: usize,
}

impl Responses {
    pub(super) fn new(scene: &Scene, facts: &[Facts]) -> Self {
        let mut all = Self { changes: BTreeMap::new(), contacts: 0, unresolved: 0 };
        for facts in facts {
            for (hit, expected, actual) in isolated(scene, facts) {
                let mut changes: Vec<(Place, Change)> = Vec::new();
                for (role, particle) in bodies(scene, hit).into_iter().enumerate() {
                    for is_velocity in [false, true] {
                        let states = [&facts.prediction, expected, actual];
                        let change = change(particle, is_velocity, states, unit(hit.normal));
                        changes.push(((hit.pair.kind, role, is_velocity), change));
                    }
                }
                let is_nothing = |change: &Change| !change.across && change.ratio.is_none_or(|ratio| ratio == 0.0);
                let is_seen = facts.passes.first().is_some_and(|pass| pass.stage == Stage::ContinuousTime);
                if !is_seen && changes.iter().all(|(_, change)| is_nothing(change)) {
                    all.unresolved += 1;
                    continue;
                }
                all.contacts += 1;
                for (place, change) in changes {
                    all.changes.entry(place).or_default().push(change);
                }
            }
        }
        all
    }

    /// Whether an isolated contact of this kind was seen, all of which are right.
    pub(super) fn is_right(&self, kind: PairKind) -> bool {
        let of_kind = || self.changes.iter().filter(|((other, ..), _)| *other == kind);
        of_kind().next().is_some() && of_kind().all(|(_, changes)| changes.iter().all(|change| change.is_right))
    }

    /// What is wrong with responses; nothing when those that can be seen are right.
    pub(super) fn explain(&self, facts: &[Facts]) -> Option<Explanation> {
        let changes = &self.changes;
        let wrong: BTreeMap<Place, Vec<Change>> = changes
            .iter()
            .map(|(place, all)| (*place, all.iter().filter(|change| !change.is_right).copied().collect::<Vec<_>>()))
            .filter(|(_, wrong)| !wrong.is_empty())
            .collect();
        if wrong.is_empty() {
            return of_many(facts).or_else(|| self.unresolved());
        }
        let kinds: Vec<PairKind> = distinct(wrong.keys().map(|(kind, ..)| *kind));
        let place = match kinds[..] {
            [kind] if changes.keys().any(|(other, ..)| *other != kind) => format!("{} response", sentence(kind.name())),
            _ => "Collision response".to_owned(),
        };
        let what = if wrong.values().flatten().all(|change| !change.across && change.ratio == Some(0.0)) {
            let all = wrong.len() == changes.keys().filter(|(kind, ..)| kinds.contains(kind)).count();
            if all { "contacts change nothing".to_owned() } else { unchanged(&wrong) }
        } else if wrong.values().flatten().any(|change| change.across) {
            format!("{} also across the contact vector", subject(&wrong, "change"))
        } else {
            format!("{} along the contact vector, but not by the right amount", subject(&wrong, "change"))
        };
        let details = wrong.iter().map(|(place, wrong)| detail(*place, wrong, changes[place].len())).collect();
        Some(observation(StepStage::Responses, KEY, format!("{place}: {}.", sentence(&what)), details, self.contacts))
    }
}

impl Responses {
    /// Contacts of impulse rounds that are not resolved.
    fn unresolved(&self) -> Option<Explanation> {
        let what = match (self.unresolved, self.contacts) {
            (0, _) => return None,
            (_, 0) => {
                "Collision response or impulse loop: Contacts that the first round's polynomials show change nothing."
            }
            _ => "Impulse loop: Some contacts that the first round's polynomials show change nothing.",
        };
        Some(observation(StepStage::Responses, "stage-unresolved", what.to_owned(), Vec::new(), self.unresolved))
    }
}

/// The contacts of a step whose bodies have no other one, with the expected and the actual state behind them.
fn isolated<'a>(scene: &'a Scene, facts: &'a Facts) -> Vec<(&'a Hit, &'a State, &'a State)> {
    let rounds = facts.passes.iter().filter(|pass| !matches!(pass.stage, Stage::Geometric { .. })).count();
    let hits = || facts.hits.iter().filter(move |hit| hit.pass < rounds);
    let is_alone = |hit: &&Hit| {
        let own = bodies(scene, hit);
        let touches =
            |other: &Hit| other.place != hit.place && bodies(scene, other).iter().any(|one| own.contains(one));
        !hits().any(touches)
    };
    let (expected, actual) = match facts.passes.first().map(|pass| pass.stage) {
        Some(Stage::ContinuousTime) => {
            let (ours, theirs) = (&facts.expected.end.impulses, &facts.actual.end.impulses);
            let same = ours.iter().zip(theirs).all(|(ours, theirs)| same_impulse(ours, theirs, &ROUND_OFF));
            if ours.len() != theirs.len() || !same {
                return Vec::new();
            }
            (&facts.expected.end.state, &facts.actual.end.state)
        }
        Some(Stage::Impulses { .. }) => {
            let Some((expected, actual)) = facts.middles() else { return Vec::new() };
            // What a loop hands over when its rounds run out is another question.
            let ran_out = rounds < facts.passes.len();
            if ran_out || expected.polynomials.len() != actual.polynomials.len() {
                return Vec::new();
            }
            (&expected.state, &actual.state)
        }
        _ => return Vec::new(),
    };
    hits().filter(is_alone).map(|hit| (hit, expected, actual)).collect()
}

/// Steps with several contacts, all of which are right though the state is not.
fn of_many(facts: &[Facts]) -> Option<Explanation> {
    let is_right = |facts: &&Facts| {
        let (ours, theirs) = (&facts.expected.end.impulses, &facts.actual.end.impulses);
        facts.is_wrong
            && facts.passes.first().map(|pass| pass.stage) == Some(Stage::ContinuousTime)
            && !ours.is_empty()
            && ours.len() == theirs.len()
            && facts.right_polynomials >= facts.expected.end.polynomials.len()
            && ours.iter().zip(theirs).all(|(ours, theirs)| same_impulse(ours, theirs, &ROUND_OFF))
    };
    let count = facts.iter().filter(is_right).count();
    let what = "Collision response: The contacts are right, but not the state that they lead to.";
    (count > 0).then(|| observation(StepStage::Responses, KEY, what.to_owned(), Vec::new(), count))
}

/// The bodies of a pair, in the order of the assignment.
fn bodies(scene: &Scene, hit: &Hit) -> Vec<usize> {
    let (first, second) = (hit.pair.first as usize, hit.pair.second as usize);
    match hit.pair.kind {
        PairKind::ParticleParticle => vec![first, second],
        PairKind::ParticleEdge => vec![first, scene.edges[second].first, scene.edges[second].second],
        PairKind::ParticleHalfPlane => vec![first],
    }
}

fn change(particle: usize, is_velocity: bool, states: [&State; 3], u: Vec2) -> Change {
    let array = |state: &State| at(if is_velocity { &state.velocities } else { &state.positions }, particle);
    let [before, expected, actual] = states.map(array);
    let (ours, theirs) = (expected - before, actual - before);
    let small = SMALL * (1.0 + length(before) + length(expected));
    let along = theirs.dot(&u);
    Change {
        ratio: (length(ours) > 100.0 * small).then(|| {
            let ratio = along / ours.dot(&u);
            if along.abs() <= small { 0.0 } else { ratio }
        }),
        across: length(theirs - along * u) > small.max(ALIKE * length(ours)),
        is_right: length(theirs - ours) <= small.max(ALIKE * length(ours)),
    }
}

/// The body in words.
fn body((kind, role, _): Place) -> &'static str {
    match (kind, role) {
        (PairKind::ParticleParticle, 0) => "the first particle",
        (PairKind::ParticleParticle, _) => "the second particle",
        (PairKind::ParticleEdge, 1) => "the first endpoint",
        (PairKind::ParticleEdge, 2) => "the second endpoint",
        _ => "the particle",
    }
}

fn quantity((.., is_velocity): Place) -> &'static str {
    if is_velocity { "velocity" } else { "position" }
}

/// Who changes wrongly, in words.
fn subject(wrong: &BTreeMap<Place, Vec<Change>>, verb: &str) -> String {
    let quantities = distinct(wrong.keys().map(|place| quantity(*place)));
    let bodies = distinct(wrong.keys().map(|place| body(*place)));
    let what = match quantities[..] {
        [one] => one.to_owned(),
        _ => "position and velocity".to_owned(),
    };
    match bodies[..] {
        [one] if quantities.len() == 1 => format!("the {what} of {one} {verb}s"),
        [one] => format!("{what} of {one} {verb}"),
        _ if quantities.len() == 1 => format!("{} {verb}", if what == "velocity" { "velocities" } else { "positions" }),
        _ => format!("positions and velocities {verb}"),
    }
}

fn unchanged(wrong: &BTreeMap<Place, Vec<Change>>) -> String {
    let list: Vec<String> = wrong.keys().map(|place| format!("the {} of {}", quantity(*place), body(*place))).collect();
    format!("unchanged by contacts: {}", list.join(", "))
}

fn detail(place: Place, wrong: &[Change], all: usize) -> String {
    let ratios: Vec<f64> = wrong.iter().filter_map(|change| change.ratio).collect();
    let amount = match common_value(&ratios) {
        _ if ratios.is_empty() => "though it should not".to_owned(),
        Some(ratio) if ratio == 1.0 || (ratio - 1.0).abs() <= ALIKE => {
            "as it should along the contact vector".to_owned()
        }
        _ => format!("by {} what it should", times(&ratios)),
    };
    let across = if wrong.iter().any(|change| change.across) { ", and across the contact vector, too" } else { "" };
    let where_ = format!("{}: the {} of {}", sentence(place.0.name()), quantity(place), body(place));
    format!("{where_} changes {amount}{across} (in {} of {all} isolated contacts)", wrong.len())
}

fn distinct<T: PartialEq>(values: impl Iterator<Item = T>) -> Vec<T> {
    let mut list = Vec::new();
    for value in values {
        if !list.contains(&value) {
            list.push(value);
        }
    }
    list
}
