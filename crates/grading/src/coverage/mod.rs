//! The contents of a suite's scenes, measured from the reference's run: kinds of contacts, zones and steps.
//!
//! An event in a step has properties ([`FAMILIES`]): it is a contact, a pair that does not collide, a zone that the
//! failsafe moves, the step as a whole. A suite covers a pair of values of two properties if an event in one of its
//! scenes has both. A mistake that depends on one or two properties therefore occurs in some scene.
mod axes;
mod events;
mod families;
mod watch;

pub use axes::Axis;
pub use families::{FAMILIES, Family};

use fosssim_model::{
    assignments::Assignment,
    scene::Scene,
    sim::{RootSearch, Simulation, StepError},
};
use std::collections::BTreeSet;

/// Two values of two properties of one kind of event, by index. The first property comes before the second in the
/// family's list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pairing {
    /// The kind of event, an index into [`FAMILIES`].
    pub family: usize,
    /// The first property's index and its value's index.
    pub one: (usize, usize),
    /// The second property's index and its value's index.
    pub other: (usize, usize),
}

impl Pairing {
    /// Returns all pairs of values that an event can have.
    pub fn all() -> impl Iterator<Item = Self> {
        FAMILIES
            .iter()
            .enumerate()
            .flat_map(|(family, of)| {
                let values = move || {
                    let axes = of.axes.iter().enumerate();
                    axes.flat_map(|(axis, values)| (0..values.values.len()).map(move |value| (axis, value)))
                };
                let pairs = values().flat_map(move |one| values().map(move |other| (one, other)));
                pairs.filter(|(one, other)| one.0 < other.0).map(move |(one, other)| Self { family, one, other })
            })
            .filter(|pairing| pairing.is_possible())
    }

    fn is_possible(self) -> bool {
        let family = &FAMILIES[self.family];
        let value = |(axis, value): (usize, usize)| (family.axes[axis].name, value);
        let (one, other) = (value(self.one), value(self.other));
        !family.never.iter().any(|never| *never == (one, other) || *never == (other, one))
    }

    /// Returns both values as text, such as `fixed: the first, time: start of the step`.
    #[must_use]
    pub fn describe(self) -> String {
        let value = |(axis, value): (usize, usize)| {
            let axis = &FAMILIES[self.family].axes[axis];
            format!("{}: {}", axis.name, axis.values[value])
        };
        format!("{}, {}", value(self.one), value(self.other))
    }
}

/// The events of some scenes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Coverage {
    seen: BTreeSet<Pairing>,
}

impl Coverage {
    /// Returns the events of one scene; `None` if the scene's collision handling is not that of the assignment.
    ///
    /// # Errors
    ///
    /// Fails if the scene can't be simulated to its end.
    pub fn for_scene(scene: &Scene) -> Result<Self, StepError> {
        let mut coverage = Self::default();
        if scene.assignment() == Assignment::T2M2 {
            let mut watch = watch::Watch::new(scene, &mut coverage);
            let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
            for _ in 0..scene.step_count() {
                simulation.step(&mut watch)?;
            }
        }
        Ok(coverage)
    }

    /// Adds the events of other scenes.
    pub fn add(&mut self, other: &Self) {
        self.seen.extend(&other.seen);
    }

    /// Returns whether no event is recorded.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.seen.is_empty()
    }

    /// Returns whether some event has both values.
    #[must_use]
    pub fn has(&self, pairing: Pairing) -> bool {
        self.seen.contains(&pairing)
    }

    /// Returns the single values that occur, each as the kind of event, the property, and the value.
    pub fn values(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        let values = self
            .seen
            .iter()
            .flat_map(|pairing| [pairing.one, pairing.other].map(|(axis, value)| (pairing.family, axis, value)));
        values.collect::<BTreeSet<_>>().into_iter()
    }

    /// Returns the number of pairs of values that a kind of event has, and the number of possible pairs.
    #[must_use]
    pub fn counts(&self, family: usize) -> (usize, usize) {
        let all = || Pairing::all().filter(|pairing| pairing.family == family);
        (all().filter(|pairing| self.has(*pairing)).count(), all().count())
    }

    /// Returns the pairs of values that are missing.
    pub fn missing(&self) -> impl Iterator<Item = Pairing> {
        Pairing::all().filter(|pairing| !self.has(*pairing))
    }

    /// Records an event.
    fn note(&mut self, (family, values): &families::Event) {
        for (first, &one) in values.iter().enumerate() {
            for (second, &other) in values.iter().enumerate().skip(first + 1) {
                self.seen.insert(Pairing { family: *family, one: (first, one), other: (second, other) });
            }
        }
    }
}

#[cfg(test)]
mod tests;
