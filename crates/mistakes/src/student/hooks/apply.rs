//! The work of a program at its places: what it should do, or what the author's mutation makes of it.
use super::{Mutation, Operator, Place};
use crate::student::author::Student;
use fosssim_num::vector::Vec2;

impl Student {
    fn operator(self, place: Place) -> Option<Operator> {
        self.mutation.filter(|mutation: &Mutation| mutation.place == place).map(|mutation| mutation.operator)
    }

    /// Whether anything is changed at a place: for what costs something to change.
    pub(in crate::student) fn changes(self, place: Place) -> bool {
        self.operator(place).is_some()
    }

    /// A number.
    pub(in crate::student) fn number(self, place: Place, value: f64) -> f64 {
        match self.operator(place) {
            Some(Operator::Zero) => 0.0,
            Some(Operator::Negated) => -value,
            Some(Operator::Doubled) => 2.0 * value,
            Some(Operator::Halved) => 0.5 * value,
            _ => value,
        }
    }

    /// A vector.
    pub(in crate::student) fn vector(self, place: Place, value: Vec2) -> Vec2 {
        match self.operator(place) {
            Some(Operator::Zero) => Vec2::zeros(),
            Some(Operator::Negated) => -value,
            Some(Operator::Doubled) => 2.0 * value,
            Some(Operator::AxesExchanged) => Vec2::new(value.y, value.x),
            _ => value,
        }
    }

    /// An index among `count`, beside which `other` stands.
    pub(in crate::student) fn index(self, place: Place, value: usize, other: usize, count: usize) -> usize {
        let wrong = match self.operator(place) {
            Some(Operator::Other) => other,
            Some(Operator::AfterOther) => other + 1,
            Some(Operator::Next) => value + 1,
            Some(Operator::Previous) => value.saturating_sub(1),
            Some(Operator::First) => 0,
            _ => value,
        };
        wrong.min(count.saturating_sub(1))
    }

    /// A condition.
    pub(in crate::student) fn holds(self, place: Place, condition: bool) -> bool {
        match self.operator(place) {
            Some(Operator::Always) => true,
            Some(Operator::Never) => false,
            _ => condition,
        }
    }

    /// The entries of a list in the order in which they are gone through.
    pub(in crate::student) fn items<T: Clone>(self, place: Place, mut list: Vec<T>) -> Vec<T> {
        match self.operator(place) {
            Some(Operator::WithoutFirst) if !list.is_empty() => drop(list.remove(0)),
            Some(Operator::WithoutLast) => drop(list.pop()),
            Some(Operator::FirstOnly) => list.truncate(1),
            Some(Operator::LastOnly) => drop(list.drain(..list.len().saturating_sub(1))),
            Some(Operator::Reversed) => list.reverse(),
            Some(Operator::Repeated) => list.extend_from_within(..),
            Some(Operator::Empty) => list.clear(),
            _ => {}
        }
        list
    }

    /// A count.
    pub(in crate::student) fn count(self, place: Place, value: i32) -> i32 {
        match self.operator(place) {
            Some(Operator::OneMore) => value.saturating_add(1),
            Some(Operator::OneLess) => value.saturating_sub(1),
            Some(Operator::Zero) => 0,
            _ => value,
        }
    }

    /// A value, beside which the program has another one at hand.
    pub(in crate::student) fn fresh<T>(self, place: Place, value: T, stale: T) -> T {
        if self.is_stale(place) { stale } else { value }
    }

    /// Whether the other value stands at a place.
    pub(in crate::student) fn is_stale(self, place: Place) -> bool {
        self.operator(place) == Some(Operator::Stale)
    }

    /// Whether a block is left early; `number` is what it computes first.
    pub(in crate::student) fn leaves(self, place: Place, number: impl FnOnce() -> f64) -> bool {
        match self.operator(place) {
            Some(Operator::Skipped) => true,
            Some(Operator::AtZero) => number() == 0.0,
            Some(Operator::NotAfterZero) => number() != 0.0,
            _ => false,
        }
    }
}
