//! Puts the explanations of a trace together.
use super::{Explanation, known, polynomial, samples};
use crate::{
    plain::formula_in,
    student::{Area, find},
};
use fosssim_model::scene::Scene;
use std::collections::BTreeMap;

/// What is likely wrong with the program that left this trace, the likeliest first; empty when nothing is, or when
/// nothing that is known explains it.
///
/// A known mistake that reproduces all wrong steps comes first, with what is found out about the polynomials that it gets
/// wrong. Else explanations of polynomials come first that reproduce all their samples, then what reproduces a part.
/// Whether the trace is right is for the judge to say: this is asked about traces that the fair rules reject. Traces of
/// any content are accepted; what follows the first 64 MiB is passed over, and so is the record in which a trace breaks off.
/// A trace of another scene yields nothing but that question ([`Explanation::is_other_scene`]).
#[must_use]
pub fn explain(scene: &Scene, trace: &[u8]) -> Vec<Explanation> {
    let mut known = known(scene, trace);
    if known.iter().any(Explanation::is_other_scene) {
        return known;
    }
    let mut polynomials = polynomial::explain(&samples::samples(scene, trace));
    for explanation in &mut known {
        let is_formula = find(&explanation.key).is_some_and(|row| is_formula(row.area));
        if is_formula && explanation.is_complete() {
            // The same mistake in other words, with its terms and an example of its own.
            for own in std::mem::take(&mut polynomials) {
                if own.key == "unexplained" || !own.is_complete() {
                    continue;
                }
                explanation.details.extend(own.details);
                if let Some(example) = own.example {
                    explanation.example = Some(example);
                }
            }
        }
    }
    if known.iter().any(Explanation::is_complete) {
        // It reproduces the polynomials, too: what is said about them besides only follows from it.
        polynomials.clear();
    }
    let mut all = known;
    all.append(&mut polynomials);
    // A stable sort: among equals the known mistake stays first.
    all.sort_by_key(|explanation| (explanation.key == "unexplained", !explanation.is_complete()));
    debug_assert!(all.iter().all(|one| formula_in(&one.what).is_none()), "a sentence gives a formula away: {all:?}");
    all
}

/// Whether mistakes of this part of the assignment are mistakes of polynomials.
const fn is_formula(area: Area) -> bool {
    matches!(area, Area::ParticleParticle | Area::ParticleEdge | Area::ParticleHalfPlane | Area::Handover)
}

/// The likeliest mistake of a program that left several traces: the known one that explains most of them, whether it was
/// told first or as not to be told apart. Ties go to the one that was told first more often, then to the one that was told
/// earlier. `None` when no trace has an explanation.
///
/// A scene alone often can't tell mistakes apart; several together nearly always can.
#[must_use]
pub fn common<'a>(traces: impl IntoIterator<Item = &'a [Explanation]>) -> Option<Explanation> {
    let mut votes: BTreeMap<&str, Vote> = BTreeMap::new();
    for (number, explanations) in traces.into_iter().enumerate() {
        for (place, explanation) in explanations.iter().enumerate() {
            let keys = std::iter::once(&explanation.key).chain(&explanation.same_as);
            for (rank, key) in keys.enumerate() {
                let vote = votes.entry(key).or_insert(Vote { order: (number, place, rank), ..Vote::default() });
                if vote.last == Some(number) {
                    continue;
                }
                vote.last = Some(number);
                vote.traces += 1;
                vote.complete += usize::from(explanation.is_complete());
                vote.first += usize::from(rank == 0 && place == 0);
                if rank == 0 && vote.told.is_none() {
                    vote.told = Some(explanation);
                }
                vote.shared = vote.shared.or(Some(explanation));
            }
        }
    }
    votes.remove("unexplained");
    votes.remove(Explanation::OTHER_SCENE);
    let weight = |vote: &Vote<'_>| (vote.complete, vote.traces);
    let (key, vote) = votes
        .iter()
        .max_by(|(_, a), (_, b)| weight(a).cmp(&weight(b)).then(a.first.cmp(&b.first)).then(b.order.cmp(&a.order)))?;
    // What explains as many traces as well can't be told apart.
    let others =
        votes.iter().filter(|(other, rival)| *other != key && find(other).is_some() && weight(rival) == weight(vote));
    let same_as = others.map(|(other, _)| (*other).to_owned()).collect();
    let shared = vote.shared?;
    match vote.told {
        Some(told) => Some(Explanation { same_as, ..told.clone() }),
        None => Some(Explanation { key: (*key).to_owned(), what: find(key)?.sentence(), same_as, ..shared.clone() }),
    }
}

/// What speaks for a key.
#[derive(Default)]
struct Vote<'a> {
    traces: usize,
    complete: usize,
    first: usize,
    order: (usize, usize, usize),
    last: Option<usize>,
    told: Option<&'a Explanation>,
    shared: Option<&'a Explanation>,
}
