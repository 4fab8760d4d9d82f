//! A pair of objects that detection checks, and values for each kind of pair.
pub use crate::assignments::PairKind;
use serde::{Deserialize, Serialize};
use std::ops::{Index, IndexMut};

/// Two objects that detection checks: a particle, and a particle, edge or half-plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Pair {
    /// The kind of the second object.
    pub kind: PairKind,
    /// The index of the particle.
    pub first: u32,
    /// The index of the second object among its kind.
    pub second: u32,
}

/// Creates a pair of the given kind.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "a scene with 2^32 objects does not fit into memory")]
pub(super) fn pair(kind: PairKind, first: usize, second: usize) -> Pair {
    Pair { kind, first: first as u32, second: second as u32 }
}

/// A value for each kind of pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PairKindMap<T>([T; PairKind::ALL.len()]);

impl<T> PairKindMap<T> {
    /// Creates the values by calling a function for each kind.
    pub fn from_fn(value: impl FnMut(PairKind) -> T) -> Self {
        Self(PairKind::ALL.map(value))
    }

    /// Returns kinds and values, in the order of [`PairKind::ALL`].
    pub fn iter(&self) -> impl Iterator<Item = (PairKind, &T)> {
        PairKind::ALL.into_iter().zip(&self.0)
    }

    /// Returns the values, in the order of [`PairKind::ALL`].
    pub fn values(&self) -> impl Iterator<Item = &T> {
        self.0.iter()
    }

    /// Returns mutable references to the values.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.0.iter_mut()
    }

    /// Returns the values and consumes the map.
    pub fn into_values(self) -> impl Iterator<Item = T> {
        self.0.into_iter()
    }
}

impl<T> From<[T; PairKind::ALL.len()]> for PairKindMap<T> {
    fn from(values: [T; PairKind::ALL.len()]) -> Self {
        Self(values)
    }
}

impl<T> Index<PairKind> for PairKindMap<T> {
    type Output = T;

    #[inline]
    fn index(&self, kind: PairKind) -> &T {
        &self.0[kind.index()]
    }
}

impl<T> IndexMut<PairKind> for PairKindMap<T> {
    #[inline]
    fn index_mut(&mut self, kind: PairKind) -> &mut T {
        &mut self.0[kind.index()]
    }
}
