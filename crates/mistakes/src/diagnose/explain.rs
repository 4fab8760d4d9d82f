//! Puts the explanations of a trace together.
use super::{
    Detail, Explanation,
    about::About,
    fault::StepStage,
    known::{Known, Sample, is_empty_stage, known_or_open, shows},
    not_finite, polynomial, samples,
    source::Source,
    stages,
};
use crate::student::{Area, CATALOGUE, Row, find};
use fosssim_model::{scene::Scene, sim::pairs, trace::Layout};
use std::collections::BTreeMap;

/// Scenes with more pairs than this are not explained where steps log polynomials: a step of the reference, which explanations keep
/// whole, takes some hundred bytes a pair. Where numbers end is told all the same.
const MOST_PAIRS: usize = 400_000;

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
    explain_source(scene, &|| Source::whole(trace))
}

/// As [`explain`], whatever the trace's records are read from, more than once.
pub(super) fn explain_source<'a>(scene: &Scene, source: &dyn Fn() -> Source<'a>) -> Vec<Explanation> {
    let not_finite = not_finite::of_source(scene, source());
    if Layout::of(scene).polynomials && pairs(scene).count() > MOST_PAIRS {
        return not_finite.into_iter().collect();
    }
    let Known { explanations: mut known, open, denies } = known_or_open(scene, source());
    if known.iter().any(Explanation::is_other_scene) {
        return known;
    }
    let mut polynomials = polynomial::explain(&samples::samples(scene, source()));
    if known.iter().any(|one| find(&one.key).is_some_and(is_empty_stage)) {
        polynomials.retain(|one| !one.is_of_missing());
    }
    let alone = known.len() == 1;
    for explanation in &mut known {
        let is_formula = find(&explanation.key).is_some_and(|row| is_formula(row.area));
        if alone && is_formula && explanation.is_complete() {
            // The same mistake in other words, with its terms and an example of its own.
            for own in std::mem::take(&mut polynomials) {
                if own.is_unexplained() || !own.is_complete() {
                    continue;
                }
                // The remedy stays last. The same mistake by the same name has been said.
                let remedy = explanation.details.len().saturating_sub(1);
                let is_said = explanation.key.ends_with(&own.key);
                let lines = own.details.into_iter().filter(|_| !is_said);
                explanation.details.splice(remedy..remedy, lines);
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
    // Where another mistake keeps it from explaining whole steps, it may still explain all polynomials.
    known.retain(|one| {
        let is_told =
            |other: &Explanation| other.is_complete() && find(&one.key).is_some_and(|row| other.is_in_other_words(row));
        one.is_complete() || !polynomials.iter().any(is_told)
    });
    let stage = open.and_then(|scan| {
        let is_of_numbers = |sample: &&Sample| sample.records.is_finite();
        stages::explain(scene, scan.wrong.iter().chain(&scan.right).filter(is_of_numbers))
    });
    if stage.as_ref().is_some_and(|stage| stage.key == Explanation::ORDER) {
        // Where pairs come in another order, polynomials of one are not those of another.
        polynomials.clear();
    }
    known.iter_mut().for_each(explain_letters);
    polynomials.iter_mut().for_each(explain_letters);
    let mut all: Vec<Explanation> = not_finite.into_iter().chain(known).collect();
    all.append(&mut polynomials);
    all.extend(stage);
    // A stable sort: among equals the known mistake stays first.
    all.sort_by_key(|one| (!one.is_not_finite(), one.is_unexplained(), !one.is_complete()));
    all.iter_mut().for_each(|one| one.denies.clone_from(&denies));
    all
}

/// Says once, behind an explanation's formulas, that their letters are to be explained.
fn explain_letters(explanation: &mut Explanation) {
    if explanation.is_unexplained() {
        return;
    }
    let row = find(&explanation.key);
    let kinds = match &explanation.about {
        About::Mistake => row.and_then(Row::kind_of_pair).into_iter().collect(),
        about => about.kinds(),
    };
    // A known mistake's last line says where to look.
    let end = explanation.details.len() - usize::from(row.is_some());
    if end > 0 {
        explanation.details.insert(end, Detail::Letters(kinds));
    }
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
                vote.complete += usize::from(explanation.is_complete() || explanation.is_of_stage());
                vote.first += usize::from(rank == 0 && place == 0);
                // Of one finding, the words that say most.
                if rank == 0 && vote.told.is_none_or(|told| told.details.is_empty() && !explanation.details.is_empty())
                {
                    vote.told = Some(explanation);
                }
                vote.shared = vote.shared.or(Some(explanation));
            }
        }
    }
    votes.remove(Explanation::UNEXPLAINED);
    votes.remove(Explanation::NEARLY_RIGHT);
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
        None => {
            let key = find(key)?.id.to_owned();
            Some(Explanation { key, about: About::Mistake, same_as, ..shared.clone() })
        }
    }
}

/// The likeliest mistakes of a program that left several traces, at most three: greedily, each the one that explains most of
/// what those before leave open ([`common`]). Stages that are still empty count as one, which is told first. `refuted` are
/// keys of mistakes that right traces of the same program speak against.
#[must_use]
pub fn several<'a>(traces: impl IntoIterator<Item = &'a [Explanation]>, refuted: &[String]) -> Vec<Explanation> {
    let traces: Vec<&[Explanation]> = traces.into_iter().collect();
    let named: Vec<&Row> = traces.iter().copied().flatten().filter_map(|one| find(&one.key)).collect();
    // A stage of which one trace shows something is not empty, whatever the others look like.
    let denied: Vec<&String> = traces.iter().copied().flatten().flat_map(|one| &one.denies).collect();
    let is_refuted = |key: &String| refuted.contains(key) || denied.contains(&key);
    let kept = |list: &[Explanation]| -> Vec<Explanation> {
        let settle = |explanation: &Explanation| {
            let mut keys = std::iter::once(&explanation.key).chain(&explanation.same_as).filter(|key| !is_refuted(key));
            let key = keys.next()?.clone();
            let same_as = keys.cloned().collect();
            if let Some(row) =
                named.iter().find(|row| explanation.is_in_other_words(row) && !is_refuted(&row.id.to_owned()))
            {
                let (key, about) = (row.id.to_owned(), About::Mistake);
                return Some(Explanation { key, about, ..explanation.clone() });
            }
            if key == explanation.key {
                return Some(Explanation { same_as, ..explanation.clone() });
            }
            find(&key)?;
            Some(Explanation { key, about: About::Mistake, same_as, ..explanation.clone() })
        };
        list.iter().filter_map(settle).collect()
    };
    let mut open: Vec<Vec<Explanation>> = traces.into_iter().map(kept).filter(|list| !list.is_empty()).collect();
    keep_earliest_stage(&mut open);
    let mut covered = vec![false; open.len()];
    let mut found: Vec<Explanation> = unfinished(&open).into_iter().collect();
    let empty: Vec<String> = found.iter().flat_map(|one| one.same_as.clone()).collect();
    leave_open(&mut open, &mut covered, &empty);
    while found.len() < MOST {
        let Some(next) = common(open.iter().map(Vec::as_slice)) else { break };
        if found.is_empty() || (next.is_complete() && is_supported(&open, &covered, &next.key)) {
            leave_open(&mut open, &mut covered, std::slice::from_ref(&next.key));
            found.push(next);
        } else {
            open.iter_mut().for_each(|list| list.retain(|one| one.key != next.key));
        }
    }
    for one in &mut found {
        if one.is_unfinished() && one.same_as.len() == 1 {
            one.about = About::Mistake;
            one.key = one.same_as.remove(0);
        }
    }
    found
}

/// Leaves of what is said of stages only what concerns the earliest one: what is wrong behind it may follow. And a known mistake
/// of that stage or a later one that explains fewer traces than there are of these is no more than like what is wrong.
fn keep_earliest_stage(open: &mut Vec<Vec<Explanation>>) {
    let Some(earliest) = open.iter().flatten().filter_map(Explanation::stage).min() else { return };
    let is_of_it = |one: &Explanation| one.stage() == Some(earliest);
    let observed = open.iter().filter(|list| list.iter().any(is_of_it)).count();
    let mut weak: Vec<&'static str> = Vec::new();
    for row in CATALOGUE.iter().filter(|row| stage_of(row.area).is_some_and(|stage| stage >= earliest)) {
        if open.iter().filter(|list| names_completely(list, row.id)).count() < observed {
            weak.push(row.id);
        }
    }
    // In another order, polynomials of one pair stand where those of another are looked for.
    let is_misread = |one: &Explanation| find(&one.key).is_none() && one.stage().is_none();
    let has_order = open.iter().flatten().any(|one| one.key == Explanation::ORDER);
    for list in open.iter_mut() {
        list.retain(|one| {
            let is_weak = weak.contains(&one.key.as_str()) || (has_order && is_misread(one));
            !is_weak && one.stage().is_none_or(|stage| stage == earliest)
        });
    }
    open.retain(|list| !list.is_empty());
}

/// The stage of a step in which mistakes of this part of the assignment are made; nothing for
/// polynomials and for the trace.
const fn stage_of(area: Area) -> Option<StepStage> {
    match area {
        Area::Decision => Some(StepStage::Detection),
        Area::ContactVector => Some(StepStage::ContactVectors),
        Area::Response | Area::ContinuousTime | Area::ImpulseLoop => Some(StepStage::Responses),
        Area::ImpactZones | Area::Failsafe => Some(StepStage::Zones),
        _ => None,
    }
}

/// Keys of mistakes that [`several`] would tell and that these scenes speak against: the program was right there, and with the
/// mistake it would not have been ([`shows`]).
#[must_use]
pub fn refuted(traces: &[&[Explanation]], right: &[&Scene]) -> Vec<String> {
    let mut refuted: Vec<String> = Vec::new();
    loop {
        let likely = several(traces.iter().copied(), &refuted);
        // What is not written yet stands for its stages.
        let stages = likely.iter().filter(|one| one.is_unfinished()).flat_map(|one| &one.same_as);
        let mut keys = likely.iter().map(|one| &one.key).chain(stages).filter(|key| !refuted.contains(key));
        match keys.find(|key| right.iter().any(|scene| shows(scene, key))).cloned() {
            Some(key) => refuted.push(key),
            None => return refuted,
        }
    }
}

/// Among so many traces one that looks as if a stage were empty is no evidence.
const MANY: usize = 8;

/// So many mistakes of a program are told.
const MOST: usize = 3;

/// Whether enough of what is left names this further mistake: a trace that nothing explains yet, or two others, where there
/// are several. That polynomials are missing follows from what was found before.
fn is_supported(open: &[Vec<Explanation>], covered: &[bool], key: &str) -> bool {
    let naming = |wanted: bool| {
        let of_sort = open.iter().zip(covered).filter(|(_, covered)| **covered == wanted);
        of_sort.filter(|(list, _)| names_completely(list, key)).count()
    };
    key != "missing-polynomials" && (naming(false) > 0 || naming(true) >= open.len().min(2))
}

/// Whether a trace's explanations name a mistake, told or as not to be told apart, that reproduces everything.
fn names_completely(list: &[Explanation], key: &str) -> bool {
    list.iter().any(|one| one.is_complete() && (one.key == key || one.same_as.iter().any(|other| other == key)))
}

/// Leaves what these keys don't explain: of a trace that one of them explains only what is complete besides.
fn leave_open(open: &mut [Vec<Explanation>], covered: &mut [bool], keys: &[String]) {
    let names = |one: &Explanation| keys.iter().any(|key| one.key == *key || one.same_as.contains(key));
    for (list, covered) in open.iter_mut().zip(covered) {
        if list.iter().any(names) {
            *covered = true;
            list.retain(|one| !names(one) && one.is_complete());
        }
    }
}

/// All stages that are told to be empty by a trace, or by two where there are [`MANY`], as one explanation; their keys are in [`Explanation::same_as`].
fn unfinished(traces: &[Vec<Explanation>]) -> Option<Explanation> {
    let told: Vec<&Explanation> = traces.iter().flatten().filter(|one| one.is_complete()).collect();
    let naming = |key: &str| traces.iter().filter(|list| names_completely(list, key)).count();
    // What a trace can't tell from an empty stage may explain more traces than that.
    let is_likeliest = |row: &&Row| {
        let rivals = told.iter().filter(|one| one.key == row.id).flat_map(|one| &one.same_as);
        rivals.map(|rival| naming(rival)).max().unwrap_or(0) <= naming(row.id)
    };
    let is_told = |row: &&Row| is_empty_stage(row) && told.iter().any(|one| one.key == row.id);
    // One trace among many may look so for another reason.
    let is_seen_again = |row: &&Row| traces.len() < MANY || naming(row.id) > 1;
    let rows: Vec<&Row> = CATALOGUE.iter().filter(is_told).filter(is_likeliest).filter(is_seen_again).collect();
    let of_rows = || told.iter().filter(|one| rows.iter().any(|row| row.id == one.key));
    (!rows.is_empty()).then(|| Explanation {
        key: Explanation::UNFINISHED.to_owned(),
        about: About::Unfinished,
        details: Vec::new(),
        reproduced: of_rows().map(|one| one.reproduced).sum(),
        samples: of_rows().map(|one| one.samples).sum(),
        example: None,
        same_as: rows.iter().map(|row| row.id.to_owned()).collect(),
        denies: Vec::new(),
    })
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
