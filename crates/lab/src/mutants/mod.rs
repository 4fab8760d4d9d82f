//! Mistakes that the catalogue does not have, for measuring what explanations say of what they can't know.
//!
//! Explanations never try these: a row here must not become a row of the catalogue, or the measure is gone. Each
//! changes one thing at one of the [`Change`]s.
mod coefficients;
mod contacts;
mod motions;

use fosssim_oracle::{
    sim::PairKind,
    student::{Area, hooks::Change},
};

/// A mistake outside of the catalogue.
#[derive(Debug)]
pub struct Mutant {
    /// Its name.
    pub id: &'static str,
    /// Where it is made.
    pub area: Area,
    /// The kind of pair that it is made for; nothing where it is made for all.
    pub kind: Option<PairKind>,
    /// The mistake, in words.
    pub what: &'static str,
    /// The least that a right explanation has to say: one of these words stands in its sentence, its key, or its exact
    /// form.
    pub told_by: &'static [&'static str],
    /// The change that makes it.
    pub change: Change,
}

/// A mutant that does not change anything yet.
const fn mutant(id: &'static str, area: Area, what: &'static str) -> Mutant {
    let kind = match area {
        Area::ParticleParticle => Some(PairKind::ParticleParticle),
        Area::ParticleEdge => Some(PairKind::ParticleEdge),
        Area::ParticleHalfPlane => Some(PairKind::ParticleHalfPlane),
        _ => None,
    };
    Mutant { id, area, kind, what, told_by: &[], change: Change::Limit(|most| most) }
}

impl Mutant {
    const fn at(self, kind: PairKind) -> Self {
        Self { kind: Some(kind), ..self }
    }

    const fn told_by(self, told_by: &'static [&'static str]) -> Self {
        Self { told_by, ..self }
    }

    const fn by(self, change: Change) -> Self {
        Self { change, ..self }
    }
}

/// All mutants.
pub fn mutants() -> impl Iterator<Item = &'static Mutant> {
    coefficients::MUTANTS.iter().chain(contacts::MUTANTS).chain(motions::MUTANTS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_oracle::student::find;
    use std::collections::BTreeSet;

    #[test]
    fn there_are_many_and_none_is_of_the_catalogue() {
        let ids: BTreeSet<&str> = mutants().map(|mutant| mutant.id).collect();
        assert!(ids.len() >= 40 && ids.len() == mutants().count(), "{}", ids.len());
        assert!(ids.iter().all(|id| find(id).is_none()));
    }
}
