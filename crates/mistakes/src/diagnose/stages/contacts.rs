//! Finds faults in the impulse lists of `continuous-time`: surplus and missing contacts, wrong vectors and times, and a
//! wrong order of pairs.
use super::{
    Explanation, RATIO_TOLERANCE, common_value,
    events::{Hit, StepFacts},
    new_observation, range, ratios,
};
use crate::diagnose::{
    StageDetail, StageFault, WrongDecisions, WrongVectors,
    sampling::{ROUND_OFF, impulse_matches, pair_particles, polynomial_matches},
};
use fosssim_model::{scene::Scene, sim::PairKind, trace::LoggedImpulse};
use fosssim_num::vector::{Vec2, length};
use std::ops::Range;

/// Returns the explanation that the pairs of the first pass are in a different order. All polynomials of the pass must
/// be logged. Returns `None` unless most steps with wrong polynomials show this.
pub(super) fn explain_order(facts: &[StepFacts]) -> Option<Explanation> {
    let wrong: Vec<&StepFacts> = facts.iter().filter(|facts| facts.has_wrong_formula()).collect();
    let permuted_count = wrong.iter().filter(|facts| is_permuted(facts)).count();
    (permuted_count > 0 && 2 * permuted_count > wrong.len())
        .then(|| new_observation(StageFault::Order, vec![StageDetail::Order], permuted_count))
}

/// Returns the explanation that some pairs are not tested. Returns `None` unless the log of at least one step consists
/// of the expected polynomials without those of some pairs.
pub(super) fn explain_skipped_pairs(facts: &[StepFacts]) -> Option<Explanation> {
    let skipped: Vec<Vec<(PairKind, f64)>> =
        facts.iter().filter(|facts| facts.is_wrong).filter_map(find_skipped_pairs).collect();
    let fault = StageFault::Decisions { kind: common_kind(&skipped.concat()), wrong: WrongDecisions::Skipped };
    (!skipped.is_empty()).then(|| new_observation(fault, Vec::new(), skipped.len()))
}

/// Returns the kinds of the pairs of the first pass that the log lacks, if it consists of the other pairs' polynomials.
fn find_skipped_pairs(facts: &StepFacts) -> Option<Vec<(PairKind, f64)>> {
    let logged_count = facts.actual.end.polynomials.len();
    let (mut at, mut skipped) = (0, Vec::new());
    for (kind, block) in split_by_pair(facts, facts.count_certain_polynomials()) {
        if is_logged_at(facts, &block, at, logged_count) {
            at += block.len();
        } else {
            skipped.push((kind, 0.0));
        }
    }
    (at > 0 && at == logged_count && !skipped.is_empty()).then_some(skipped)
}

/// Returns the kind of each pair whose polynomials are among the first `size` expected ones, and the range of their
/// indices.
fn split_by_pair(facts: &StepFacts, size: usize) -> impl Iterator<Item = (PairKind, Range<usize>)> {
    let ends = facts.detections.iter().skip(1).map(|(_, first)| *first).chain([size]);
    let blocks = facts.detections.iter().zip(ends).map(|((pair, first), end)| (pair.kind, *first..end));
    blocks.take_while(move |(_, block)| block.end <= size)
}

/// Returns whether the first `size` logged polynomials contain those of a block, from index `at` on.
fn is_logged_at(facts: &StepFacts, block: &Range<usize>, at: usize, size: usize) -> bool {
    let (ours, theirs) = (&facts.expected.end.polynomials, &facts.actual.end.polynomials);
    let matches = |index: usize| polynomial_matches(ours.get(index), theirs.get(at + index - block.start), &ROUND_OFF);
    at + block.len() <= size && block.clone().all(matches)
}

/// Returns whether the log contains the pairs of the first pass, but some of them out of order. A few pairs may be
/// missing, because a pair is not recognized after an earlier contact of the pass has moved it.
fn is_permuted(facts: &StepFacts) -> bool {
    let size = facts.pass_size();
    if facts.actual.end.polynomials.len() < size {
        return false;
    }
    let blocks = split_by_pair(facts, size).enumerate();
    let mut unmatched: Vec<(usize, Range<usize>)> = blocks.map(|(number, (_, block))| (number, block)).collect();
    let pair_count = unmatched.len();
    let (mut at, mut found, mut moved, mut misplaced, mut last) = (0, 0, 0, 0, 0);
    while at < size {
        let is_here = |(_, block): &(usize, Range<usize>)| is_logged_at(facts, block, at, size);
        // The expected pair is tried first, then the following ones, because pairs may be similar.
        let own = unmatched.iter().position(|pair| pair.1.start == at && is_here(pair));
        let later = unmatched.iter().position(|pair| pair.0 >= last && is_here(pair));
        let Some(index) = own.or(later).or_else(|| unmatched.iter().position(is_here)) else {
            at += 1;
            continue;
        };
        let (number, block) = unmatched.remove(index);
        found += 1;
        moved += usize::from(block.start != at);
        misplaced += usize::from(number < last);
        last = number;
        at += block.len();
    }
    let is_spoilt =
        facts.is_continuous() && !facts.hits.is_empty() && 3 * found >= 2 * pair_count && 3 * moved >= found;
    misplaced > 0 && (found == pair_count || is_spoilt)
}

/// The maximum relative error of a contact vector that counts as inaccurate, and not as wrong.
const INEXACT_ERROR: f64 = 1e-5;

/// The contacts of all steps, with those of the reference.
#[derive(Default)]
struct ContactStage {
    /// The kinds and times of impact of right contacts.
    right_contacts: Vec<(PairKind, f64)>,
    missed_contacts: Vec<(PairKind, f64)>,
    superfluous_contacts: Vec<(PairKind, f64)>,
    vectors: Vec<(PairKind, Vec2, Vec2)>,
    times: Vec<(f64, f64)>,
}

/// Returns the fault in the contacts of `continuous-time`, if its polynomials are right.
pub(super) fn explain_detection(facts: &[StepFacts]) -> Option<Explanation> {
    let mut contacts = ContactStage::default();
    facts.iter().filter(|facts| facts.is_continuous()).for_each(|facts| contacts.compare_step(facts));
    // A wrong time may also cause wrong decisions.
    contacts.explain_times().or_else(|| contacts.explain_decisions()).or_else(|| contacts.explain_vectors())
}

/// Returns the fault in contacts that are detected at the end of a step. `steps` contains the reference's contacts and
/// the logged ones of each step. Only the first difference of a step counts, because later ones may follow from it.
/// Returns `None` if there is no clear difference.
pub(super) fn explain_overlaps(
    scene: &Scene,
    steps: &[(Vec<LoggedImpulse>, Vec<LoggedImpulse>)],
) -> Option<Explanation> {
    let particles = |one: &LoggedImpulse| one.pair().map_or_else(Vec::new, |pair| pair_particles(scene, pair));
    let mut contacts = ContactStage::default();
    for (ours, theirs) in steps {
        let first = (0..ours.len().max(theirs.len())).find(|&index| {
            ours.get(index).zip(theirs.get(index)).is_none_or(|(one, other)| !impulse_matches(one, other, &ROUND_OFF))
        });
        let Some(first) = first else { continue };
        // An earlier response of the pass changes velocities, which decide whether its bodies approach others.
        let moved_particles: Vec<usize> = ours[..first].iter().flat_map(particles).collect();
        let differing = ours.get(first).into_iter().chain(theirs.get(first)).flat_map(particles);
        if differing.into_iter().any(|particle| moved_particles.contains(&particle)) {
            continue;
        }
        // A pass tests all pairs of a particle before those of the next one.
        let order = |impulse: &LoggedImpulse| impulse.pair().map(|pair| (pair.first, pair.kind, pair.second));
        let has_pair =
            |list: &[LoggedImpulse], impulse: &LoggedImpulse| list.iter().any(|other| other.pair() == impulse.pair());
        match (ours.get(first), theirs.get(first)) {
            (Some(one), Some(other)) if one.pair() == other.pair() => {
                contacts.vectors.push((one.pair()?.kind, one.normal, other.normal));
            }
            (Some(one), Some(other)) if !has_pair(ours, other) && order(other) < order(one) => {
                contacts.superfluous_contacts.push((other.pair()?.kind, 0.0));
            }
            (Some(one), _) if !has_pair(theirs, one) => contacts.missed_contacts.push((one.pair()?.kind, 0.0)),
            (_, Some(other)) => contacts.superfluous_contacts.push((other.pair()?.kind, 0.0)),
            _ => {}
        }
    }
    let wrong = match (contacts.missed_contacts.is_empty(), contacts.superfluous_contacts.is_empty()) {
        (true, true) => return contacts.explain_vectors(),
        (false, true) => WrongDecisions::Missed,
        (true, false) => WrongDecisions::Superfluous,
        (false, false) => WrongDecisions::Both,
    };
    let listed = [contacts.missed_contacts.as_slice(), &contacts.superfluous_contacts].concat();
    Some(new_observation(StageFault::Overlaps { kind: common_kind(&listed), wrong }, Vec::new(), listed.len()))
}

impl ContactStage {
    /// Compares contacts up to the first unexpected one, because later ones depend on it.
    fn compare_step(&mut self, facts: &StepFacts) {
        let find_detection = |theirs: &LoggedImpulse| {
            let theirs = theirs.pair()?;
            facts.detections.iter().position(|(pair, _)| *pair == theirs)
        };
        // If a pass has more or fewer polynomials than expected, contacts cannot be assigned to polynomials.
        let is_whole = facts.actual.end.polynomials.len() == facts.expected.end.polynomials.len();
        let is_certain = |index: usize| {
            let end = facts.detections.get(index + 1).map_or(facts.expected.end.polynomials.len(), |(_, first)| *first);
            end <= facts.right_polynomials
        };
        let mut theirs = facts.actual.end.impulses.iter().peekable();
        for hit in &facts.hits {
            let next = theirs.peek().map(|theirs| (**theirs, find_detection(theirs)));
            match next {
                Some((impulse, Some(at))) if at == hit.detection_index => {
                    if !is_certain(at) || !self.is_right_hit(hit, &impulse) {
                        return;
                    }
                    theirs.next();
                }
                Some((impulse, Some(at))) if at < hit.detection_index => {
                    if is_whole && is_certain(at) {
                        self.superfluous_contacts.push((facts.detections[at].0.kind, impulse.time));
                    }
                    return;
                }
                Some((_, None)) => return,
                _ => {
                    if is_certain(hit.detection_index) {
                        self.missed_contacts.push((hit.pair.kind, hit.time));
                    }
                    return;
                }
            }
        }
        if let Some(impulse) = theirs.next()
            && let Some(at) = find_detection(impulse).filter(|_| is_whole)
            && is_certain(at)
        {
            self.superfluous_contacts.push((facts.detections[at].0.kind, impulse.time));
        }
    }

    /// Returns whether the vector and the time of a contact are right, and collects the right or wrong values.
    fn is_right_hit(&mut self, hit: &Hit, impulse: &LoggedImpulse) -> bool {
        let kind = hit.pair.kind;
        let expected = LoggedImpulse { normal: hit.normal, time: hit.time, ..*impulse };
        if impulse_matches(&expected, impulse, &ROUND_OFF) {
            self.right_contacts.push((kind, hit.time));
            return true;
        }
        // The contact vector is evaluated at the impact time, so a wrong time implies a wrong vector.
        if impulse_matches(&LoggedImpulse { normal: impulse.normal, ..expected }, impulse, &ROUND_OFF) {
            self.vectors.push((kind, hit.normal, impulse.normal));
        } else {
            self.times.push((hit.time, impulse.time));
        }
        false
    }

    fn explain_decisions(&self) -> Option<Explanation> {
        let wrong = match (self.missed_contacts.is_empty(), self.superfluous_contacts.is_empty()) {
            (true, true) => return None,
            (false, true) => WrongDecisions::Missed,
            (true, false) => WrongDecisions::Superfluous,
            (false, false) => WrongDecisions::Both,
        };
        let listed = [self.missed_contacts.as_slice(), &self.superfluous_contacts].concat();
        let kind = common_kind(&listed);
        let is_rival = |(other, _): &&(PairKind, f64)| kind.is_none_or(|kind| kind == *other);
        let rivals: Vec<(PairKind, f64)> = self.right_contacts.iter().filter(is_rival).copied().collect();
        let impacts = |right: bool, contacts: &[(PairKind, f64)]| {
            let (low, high) = range(contacts.iter().map(|(_, time)| *time));
            StageDetail::Impacts { right, count: contacts.len(), low, high }
        };
        let details = match wrong {
            WrongDecisions::Both | WrongDecisions::Skipped => Vec::new(),
            _ if rivals.is_empty() => vec![impacts(false, &listed)],
            _ => vec![impacts(false, &listed), impacts(true, &rivals)],
        };
        Some(new_observation(StageFault::Decisions { kind, wrong }, details, listed.len()))
    }

    fn explain_vectors(&self) -> Option<Explanation> {
        if self.vectors.is_empty() {
            return None;
        }
        let listed: Vec<(PairKind, f64)> = self.vectors.iter().map(|(kind, ..)| (*kind, 0.0)).collect();
        let vector_ratios: Vec<f64> =
            self.vectors.iter().map(|(_, ours, theirs)| theirs.dot(ours) / ours.dot(ours)).collect();
        let is_off_direction = |(_, ours, theirs): &(PairKind, Vec2, Vec2)| {
            let projection = theirs.dot(ours) / ours.dot(ours) * *ours;
            length(*theirs - projection) > RATIO_TOLERANCE * length(*theirs)
        };
        let is_perpendicular = |(_, ours, theirs): &(PairKind, Vec2, Vec2)| {
            let size = length(*ours) * length(*theirs);
            size > 0.0 && theirs.dot(ours).abs() <= RATIO_TOLERANCE * size
        };
        let part = |(_, ours, theirs): &(PairKind, Vec2, Vec2)| length(*theirs - *ours) / length(*ours);
        let is_zero = |(_, ours, theirs): &(PairKind, Vec2, Vec2)| length(*theirs) <= INEXACT_ERROR * length(*ours);
        let parts = || self.vectors.iter().map(part);
        let wrong = match () {
            () if parts().all(|part| part <= INEXACT_ERROR) => WrongVectors::Inexact,
            () if self.vectors.iter().all(is_zero) => WrongVectors::Zero,
            () if self.vectors.iter().all(is_perpendicular) => WrongVectors::Perpendicular,
            () if self.vectors.iter().any(is_off_direction) => WrongVectors::Direction,
            () if vector_ratios.iter().all(|&ratio| ratio < 0.0) => WrongVectors::Reversed,
            () if vector_ratios.iter().all(|&ratio| ratio > 0.0) => WrongVectors::Length,
            () => WrongVectors::Direction,
        };
        let details = match wrong {
            WrongVectors::Inexact => vec![StageDetail::VectorError(parts().fold(0.0, f64::max))],
            WrongVectors::Zero => Vec::new(),
            _ => vec![StageDetail::Vectors(ratios(&vector_ratios))],
        };
        let fault = StageFault::ContactVectors { kind: common_kind(&listed), wrong };
        Some(new_observation(fault, details, listed.len()))
    }

    fn explain_times(&self) -> Option<Explanation> {
        if self.times.is_empty() {
            return None;
        }
        let shares: Vec<f64> =
            self.times.iter().filter(|(ours, _)| *ours > 0.0).map(|(ours, theirs)| theirs / ours).collect();
        let offsets: Vec<f64> = self.times.iter().map(|(ours, theirs)| theirs - ours).collect();
        let mut details = Vec::new();
        if !shares.is_empty() {
            details.push(StageDetail::Times(ratios(&shares)));
        }
        details.extend(common_value(&offsets).map(StageDetail::TimeError));
        details.push(StageDetail::TimeUse);
        Some(new_observation(StageFault::ContactTimes, details, self.times.len()))
    }
}

/// Returns the kind that all contacts have in common, or `None` if there is none.
fn common_kind(listed: &[(PairKind, f64)]) -> Option<PairKind> {
    let first = listed.first()?.0;
    listed.iter().all(|(kind, _)| *kind == first).then_some(first)
}
