//! The explanations of programs whose mistake the catalogue does not have: the measure of explanations where they can't
//! know.
use crate::{
    mutants::{Mutant, mutants},
    runs::{is_accepted, options, trace},
};
use fosssim_oracle::{
    assignments::Assignment,
    diagnose::{About, Explanation, probe_scenes, refuted, several},
    evidence::{Keep, examine},
    report::words::explanation::{details, what},
    scene::Scene,
    student::{self, Area, Student},
};
use rayon::prelude::*;

/// The rating of an explanation of a mistake, from best to worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rating {
    /// Where it is, and what it is.
    Right,
    /// Where it is.
    Partly,
    /// Nothing, or that nothing is known.
    Unknown,
    /// Something else.
    Misleading,
}

/// The explanations of a mutant's program, rated.
#[derive(Debug)]
pub struct Rated {
    /// The mutant's name.
    pub id: &'static str,
    /// The mistake of the program, in words.
    pub what: &'static str,
    /// The rating of the explanations.
    pub rating: Rating,
    /// The explanations, the likeliest first.
    pub told: Vec<Explanation>,
}

/// The explanations of a program after it has run on the probe scenes.
#[must_use]
pub fn told_of(student: Student) -> Vec<Explanation> {
    let (mut explained, mut right): (Vec<(Scene, Vec<Explanation>)>, Vec<Scene>) = (Vec::new(), Vec::new());
    for (_, scene) in probe_scenes(Assignment::DEFAULT) {
        let trace = trace(&scene, student);
        let examined = examine(&scene, &trace[..], Keep::All, &options(true), &mut ());
        if is_accepted(&examined.outcome) {
            right.push(scene.clone());
        } else {
            explained.push((scene.clone(), examined.explain()));
        }
    }
    let wrong: Vec<(&Scene, &[Explanation])> = explained.iter().map(|(scene, list)| (scene, list.as_slice())).collect();
    let refuted = refuted(Some(Assignment::DEFAULT), &wrong, &right.iter().collect::<Vec<_>>());
    several(explained.iter().map(|(_, list)| list.as_slice()), &refuted)
}

/// Asks about mutants that are wanted, by number or by themselves, several at a time. The answers come in the mutants'
/// order.
pub fn rated(wanted: impl Fn(usize, &Mutant) -> bool) -> Vec<Rated> {
    let wanted: Vec<&Mutant> =
        mutants().enumerate().filter(|(number, mutant)| wanted(*number, mutant)).map(|(_, mutant)| mutant).collect();
    let rate = |mutant: &'static Mutant| {
        let told = told_of(Student::default().with_change(&mutant.change));
        Rated { id: mutant.id, what: mutant.what, rating: overall(mutant, &told), told }
    };
    wanted.into_par_iter().map(rate).collect()
}

/// The rating of the best explanation, unless one misleads.
fn overall(mutant: &Mutant, told: &[Explanation]) -> Rating {
    // That NaN is there is true of any mistake that makes it.
    let ratings = || told.iter().filter(|one| !one.is_not_finite()).map(|one| rating(mutant, one));
    match ratings().max() {
        Some(Rating::Misleading) => Rating::Misleading,
        _ => ratings().min().unwrap_or(Rating::Unknown),
    }
}

/// How one explanation stands to the mistake.
fn rating(mutant: &Mutant, told: &Explanation) -> Rating {
    let row = student::find(&told.key);
    let (is_there, kinds) = match (row, &told.about) {
        (Some(row), _) => (row.area == mutant.area, row.kind_of_pair().into_iter().collect()),
        (None, About::Stage(fault)) => (fault.areas().contains(&mutant.area), fault.kind().into_iter().collect()),
        (None, about) => (is_of_polynomials(mutant), about.kinds()),
    };
    let is_of_other_kind = mutant.kind.is_some_and(|kind| !kinds.is_empty() && !kinds.contains(&kind));
    if !is_there || is_of_other_kind {
        return Rating::Misleading;
    }
    let words = format!("{} {}", what(told), details(told).join(" "));
    let is_told = mutant.told_by.iter().any(|word| told.key.contains(word) || words.contains(word));
    if row.is_none() && is_told { Rating::Right } else { Rating::Partly }
}

const fn is_of_polynomials(mutant: &Mutant) -> bool {
    matches!(mutant.area, Area::ParticleParticle | Area::ParticleEdge | Area::ParticleHalfPlane)
}

#[cfg(test)]
mod tests;
