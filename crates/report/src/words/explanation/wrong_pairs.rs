//! Describes faults in a contest program's search for nearby pairs.
use crate::number::{format_count, group_digits};
use fosssim_findings::PairText;
use fosssim_mistakes::diagnose::{PairCounts, PairTrait, WrongPairs, pair_traits};
use fosssim_model::sim::PairKind;

/// A fault of a search, with the kinds of pairs that it affects.
struct PairFault<'a> {
    kinds: Vec<&'a PairCounts>,
    times: usize,
    share: &'static str,
    traits: Vec<PairTrait>,
}

/// Groups the faults. Kinds of pairs with the same fault and the same properties are reported together.
fn group_faults(wrong: &WrongPairs) -> Vec<PairFault<'_>> {
    let mut all: Vec<PairFault<'_>> = Vec::new();
    for (times, pairs) in [0, 2].iter().flat_map(|&times| wrong.counts_by_kind.iter().map(move |pairs| (times, pairs)))
    {
        if pairs.counts_by_times[times] == 0 {
            continue;
        }
        let traits = pair_traits(pairs, times);
        let descriptions =
            |traits: &[PairTrait]| traits.iter().map(|pair_trait| pair_trait.description.clone()).collect::<Vec<_>>();
        let share = describe_share(pairs, times);
        let is_same = |other: &&mut PairFault<'_>| {
            other.times == times && other.share == share && descriptions(&other.traits) == descriptions(&traits)
        };
        match all.iter_mut().find(is_same) {
            Some(other) => other.kinds.push(pairs),
            None => all.push(PairFault { kinds: vec![pairs], times, share, traits }),
        }
    }
    all
}

/// Describes which pairs are affected, what the fault is, and what the pairs have in common.
pub(super) fn describe(wrong: &WrongPairs) -> String {
    let faults = group_faults(wrong);
    let describe_fault = |fault: &PairFault<'_>| {
        let names = fault.kinds.iter().map(|pairs| kind_name(pairs.kind)).collect::<Vec<_>>().join(" and ");
        let common: Vec<&str> = fault.traits.iter().map(|pair_trait| pair_trait.description.as_str()).collect();
        let sentence = format!("{} {names} are {}", fault.share, describe_times(fault.times));
        if common.is_empty() {
            return sentence;
        }
        let all = if fault.traits.iter().all(|pair_trait| pair_trait.exceptions == 0) { "all" } else { "nearly all" };
        format!("{sentence}. In {all} of these, {}", common.join(", or "))
    };
    let sentences: Vec<String> = faults.iter().map(describe_fault).collect();
    format!("Near pairs: {}.", sentences.join(". Besides, "))
}

/// Returns lines about the first affected pair, the number of pairs, and the exact conditions of their common
/// properties.
pub(super) fn list_details(wrong: &WrongPairs) -> Vec<String> {
    let first = wrong.first.map(|(pair, step)| format!("The first one is in step {step}: {}.", PairText(pair)));
    let list_fault = |fault: &PairFault<'_>| {
        let sum = |times: usize| fault.kinds.iter().map(|pairs| pairs.counts_by_times[times]).sum::<u64>();
        let (wrong, right) = (sum(fault.times), sum(1));
        let numbers = format!(
            "Pairs that are {}: {}. Reported once: {}.",
            describe_times(fault.times),
            group_digits(wrong),
            group_digits(right)
        );
        let traits = fault.traits.iter().map(|pair_trait| {
            let others = format_count(right, "other");
            format!("{}: also in {} of {others}.", pair_trait.exact_condition, group_digits(pair_trait.right_pairs))
        });
        std::iter::once(numbers).chain(traits).collect::<Vec<_>>()
    };
    first.into_iter().chain(group_faults(wrong).iter().flat_map(list_fault)).collect()
}

const fn describe_times(times: usize) -> &'static str {
    if times == 0 { "missing" } else { "reported twice" }
}

/// Returns a word for how many pairs of a kind are reported `times` times, such as `all`.
const fn describe_share(pairs: &PairCounts, times: usize) -> &'static str {
    match pairs.counts_by_times[1] {
        0 => "all",
        right if 20 * right <= pairs.counts_by_times[times] => "nearly all",
        _ => "some",
    }
}

const fn kind_name(kind: PairKind) -> &'static str {
    match kind {
        PairKind::ParticleParticle => "pairs of two particles",
        PairKind::ParticleEdge => "pairs of a particle and an edge",
        PairKind::ParticleHalfPlane => "pairs of a particle and a half-plane",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(kind: PairKind, times: [u64; 3]) -> PairCounts {
        PairCounts { kind, counts_by_times: times, traits: Vec::new() }
    }

    #[test]
    fn each_kind_of_pair_is_reported_with_its_wrong_pairs() {
        let [particles, edges, half_planes] = PairKind::ALL;
        let told = |kinds: [PairCounts; 3]| describe(&WrongPairs { first: None, counts_by_kind: kinds.into() });
        assert_eq!(
            told([pairs(particles, [90, 0, 0]), pairs(edges, [4, 0, 0]), pairs(half_planes, [0; 3])]),
            "Near pairs: all pairs of two particles and pairs of a particle and an edge are missing."
        );
        assert_eq!(
            told([pairs(particles, [3, 5, 0]), pairs(edges, [4, 0, 0]), pairs(half_planes, [0, 1, 30])]),
            "Near pairs: some pairs of two particles are missing. Besides, all pairs of a particle and an edge are \
             missing. Besides, nearly all pairs of a particle and a half-plane are reported twice."
        );
    }
}
