//! Measures what a suite's scenes contain, such as kinds of contacts, zones and steps, from the reference's run of each
//! scene.
//!
//! An event is a contact, a pair that does not collide, a zone that the failsafe moves, or a step as a whole. Events
//! have properties ([`FAMILIES`]). A suite covers a pair of values of two properties if an event in one of its scenes
//! has both values. Then a mistake that depends on one or two properties shows in at least one scene.
mod axes;
mod coverage_observer;
mod events;
mod families;

pub use axes::Axis;
pub use families::{FAMILIES, Family};

use fosssim_model::{
    assignments::Assignment,
    scene::Scene,
    sim::{RootSearch, Simulation, StepError},
};
use std::collections::BTreeSet;

/// Two values of two properties of the same kind of event, given by indices. The first property comes before the second
/// one in the list of properties.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pairing {
    /// The kind of event, as an index in [`FAMILIES`].
    pub family: usize,
    /// The index of the first property, and the index of its value.
    pub first: (usize, usize),
    /// The index of the second property, and the index of its value.
    pub second: (usize, usize),
}

impl Pairing {
    /// Returns all pairs of values that can occur in an event.
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
                pairs.filter(|(one, other)| one.0 < other.0).map(move |(one, other)| Self {
                    family,
                    first: one,
                    second: other,
                })
            })
            .filter(|pairing| pairing.is_possible())
    }

    fn is_possible(self) -> bool {
        let family = &FAMILIES[self.family];
        let value = |(axis, value): (usize, usize)| (family.axes[axis].name, value);
        let (one, other) = (value(self.first), value(self.second));
        !family.impossible_pairs.iter().any(|never| *never == (one, other) || *never == (other, one))
    }

    /// Describes both values, such as `fixed: the first, time: start of the step`.
    pub fn describe(self) -> String {
        let value = |(axis, value): (usize, usize)| {
            let axis = &FAMILIES[self.family].axes[axis];
            format!("{}: {}", axis.name, axis.values[value])
        };
        format!("{}, {}", value(self.first), value(self.second))
    }
}

/// The events that occur in one or several scenes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Coverage {
    pairings: BTreeSet<Pairing>,
}

impl Coverage {
    /// Returns the events that occur in a scene. The result is empty if the scene does not belong to assignment T2M2.
    ///
    /// # Errors
    ///
    /// Fails if the scene can't be simulated to its end.
    pub fn for_scene(scene: &Scene) -> Result<Self, StepError> {
        let mut coverage = Self::default();
        if scene.assignment() == Assignment::T2M2 {
            let mut watch = coverage_observer::CoverageObserver::new(scene, &mut coverage);
            let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
            for _ in 0..scene.step_count() {
                simulation.step(&mut watch)?;
            }
        }
        Ok(coverage)
    }

    /// Adds the events that occur in other scenes.
    pub fn add(&mut self, other: &Self) {
        self.pairings.extend(&other.pairings);
    }

    /// Returns whether no event has been recorded.
    pub fn is_empty(&self) -> bool {
        self.pairings.is_empty()
    }

    /// Returns whether any event has both values.
    pub fn contains(&self, pairing: Pairing) -> bool {
        self.pairings.contains(&pairing)
    }

    /// Returns the single values that occur. Each is given by the indices of the kind of event, the property, and the
    /// value.
    pub fn values(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        let values = self
            .pairings
            .iter()
            .flat_map(|pairing| [pairing.first, pairing.second].map(|(axis, value)| (pairing.family, axis, value)));
        values.collect::<BTreeSet<_>>().into_iter()
    }

    /// Returns how many pairs of values occur for a kind of event, and how many are possible.
    pub fn counts(&self, family: usize) -> (usize, usize) {
        let all = || Pairing::all().filter(|pairing| pairing.family == family);
        (all().filter(|pairing| self.contains(*pairing)).count(), all().count())
    }

    /// Returns the possible pairs of values that do not occur.
    pub fn missing(&self) -> impl Iterator<Item = Pairing> {
        Pairing::all().filter(|pairing| !self.contains(*pairing))
    }

    /// Records that an event occurs.
    fn record_event(&mut self, (family, values): &families::Event) {
        for (first, &one) in values.iter().enumerate() {
            for (second, &other) in values.iter().enumerate().skip(first + 1) {
                self.pairings.insert(Pairing { family: *family, first: (first, one), second: (second, other) });
            }
        }
    }
}

#[cfg(test)]
mod tests;
