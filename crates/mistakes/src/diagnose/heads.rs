//! The explanations that the traces of one program give together.
//!
//! Traces vote for what they say, in the words in which it is told ([`Explanation::said`]): two mistakes with one key
//! are two. A trace votes for all explanations that would do as well as the one that it tells. So the first explanation
//! has been tried on all traces before anything is told beside it.
use super::{
    Explanation,
    about::{About, OfPolynomials},
    explain::is_formula,
    fault::StepStage,
    known::{is_empty_stage, shows, shows_within},
    naming::{as_row, bears_out, bears_out_wholly, is_in_other_words, is_named_in},
};
use crate::{
    assignments::t2m2::Subject,
    student::{Area, CATALOGUE, Row, find},
};
use fosssim_model::scene::Scene;
use std::{
    cell::Cell,
    collections::{BTreeMap, BTreeSet},
};

/// The greatest number of mistakes that are told of a program.
const MOST: usize = 3;

/// The likeliest mistake of a program that left several traces: the one that explains most of them, whether it was told
/// first or as not to be told apart. Ties go to mistakes of the catalogue, then to the one that was told first more
/// often, then to the one that was told earlier. `None` when no trace has an explanation.
///
/// A scene alone often can't tell mistakes apart; several together nearly always can.
#[must_use]
pub fn common<'a>(traces: impl IntoIterator<Item = &'a [Explanation]>) -> Option<Explanation> {
    let traces: Vec<&[Explanation]> = traces.into_iter().collect();
    let votes = votes(&traces);
    // Of a stage, all that is seen says that it is wrong; what most of it says is wrong with it.
    let weight = |vote: &Vote<'_>| (vote.complete.max(vote.kin), vote.traces.max(vote.kin), vote.complete);
    let is_known = |said: &str| find(said).is_some();
    let (said, vote) = votes.iter().filter(|(_, vote)| !vote.is_denied()).max_by(|(said, a), (other, b)| {
        let known = is_known(said).cmp(&is_known(other));
        weight(a).cmp(&weight(b)).then(known).then(a.first.cmp(&b.first)).then(b.order.cmp(&a.order))
    })?;
    // Mistakes that explain the same number of traces as well can't be told apart.
    let is_rival =
        |(other, rival): &(&String, &Vote<'_>)| *other != said && is_known(other) && weight(rival) == weight(vote);
    let same_as = votes.iter().filter(is_rival).map(|(other, _)| other.clone()).collect();
    let shared = vote.shared?;
    let Some(told) = vote.told else {
        return Some(as_row(shared, find(said)?, same_as));
    };
    Some(Explanation { same_as, ..united(told, &traces) })
}

/// An explanation with the polynomials of all traces that say the same of others.
fn united(told: &Explanation, traces: &[&[Explanation]]) -> Explanation {
    let mut told = told.clone();
    let said = told.said();
    // Of what speaks against it, nothing is reproduced.
    let against = traces.iter().filter(|list| list.iter().all(|one| !bears_out(one, &said, Some(&told))));
    let missed: u64 =
        against.flat_map(|list| list.iter()).filter(|one| speaks_against(one, &told)).map(|one| one.samples).sum();
    told.samples += missed;
    if let About::Polynomials { subjects, .. } = &mut told.about {
        for other in traces.iter().copied().flatten().filter(|other| other.said() == said) {
            let About::Polynomials { subjects: theirs, .. } = &other.about else { continue };
            subjects.extend(theirs);
        }
        subjects.sort_unstable();
        subjects.dedup();
    }
    told
}

/// The votes for one explanation.
#[derive(Default)]
struct Vote<'a> {
    traces: usize,
    complete: usize,
    first: usize,
    order: (usize, usize, usize),
    /// Of what is seen of a stage: traces in which the same is wrong, in whatever way.
    kin: usize,
    /// Traces in which the same polynomials are wrong in another way.
    against: usize,
    told: Option<&'a Explanation>,
    shared: Option<&'a Explanation>,
}

impl Vote<'_> {
    /// Whether as many traces speak against a guess about polynomials as for it.
    fn is_denied(&self) -> bool {
        self.against > 0 && self.against >= self.complete
    }
}

fn votes<'a>(traces: &[&'a [Explanation]]) -> BTreeMap<String, Vote<'a>> {
    let mut votes: BTreeMap<String, Vote<'a>> = BTreeMap::new();
    for (number, list) in traces.iter().enumerate() {
        for (place, one) in list.iter().enumerate().filter(|(_, one)| one.is_vote()) {
            let all = std::iter::once(one.said()).chain(one.same_as.iter().filter(|key| find(key).is_some()).cloned());
            for (rank, said) in all.enumerate() {
                let order = (number, place, rank);
                let vote = votes.entry(said).or_insert_with(|| Vote { order, ..Vote::default() });
                // Of those in the same words, the one whose exact form says most.
                let rank_of = |one: &Explanation| (one.is_settled(), !one.details.is_empty());
                let says_more = |told: &Explanation| rank_of(told) < rank_of(one);
                if rank == 0 && vote.told.is_none_or(says_more) {
                    vote.told = Some(one);
                }
                vote.shared = vote.shared.or(Some(one));
            }
        }
    }
    for (said, vote) in &mut votes {
        for list in traces {
            let is_kin = |told: &Explanation| list.iter().any(|one| one.is_of_stage() && one.key == told.key);
            vote.kin += usize::from(vote.told.is_some_and(|told| told.is_of_stage() && is_kin(told)));
            let mut named = list.iter().enumerate().filter(|(_, one)| bears_out(one, said, vote.told));
            if let Some((place, one)) = named.next() {
                vote.traces += 1;
                vote.complete += usize::from(bears_out_wholly(one, said, vote.told));
                vote.first += usize::from(place == 0 && one.said() == *said);
            } else if vote.told.is_some_and(|told| list.iter().any(|one| speaks_against(one, told))) {
                vote.against += 1;
            }
        }
    }
    votes
}

/// Whether a trace's explanation, which does not bear it out, speaks against what is told of polynomials: the same
/// ones are wrong.
fn speaks_against(one: &Explanation, told: &Explanation) -> bool {
    let is_of_formula = match &told.about {
        About::Polynomials { found, .. } => matches!(found, OfPolynomials::Guess(_)),
        About::Mistake => find(&told.key).is_some_and(|row| row.kind_of_pair().is_some() && is_formula(row.area)),
        _ => false,
    };
    let subjects = told.subjects();
    is_of_formula && one.subjects().iter().any(|subject| subjects.contains(subject))
}

/// The likely mistakes of a program that left several traces, at most three: greedily, each the one that explains most
/// of what those before leave open ([`common`]). Stages that are still empty count as one, which is told first.
/// `refuted` are keys of mistakes that right traces of the same program speak against. Where numbers end counts as
/// none, and comes first, unless one of the mistakes is the cause.
#[must_use]
pub fn several<'a>(traces: impl IntoIterator<Item = &'a [Explanation]>, refuted: &[String]) -> Vec<Explanation> {
    let traces: Vec<&[Explanation]> = traces.into_iter().collect();
    let not_finite = not_finite(&traces);
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
                named.iter().find(|row| is_in_other_words(explanation, row) && !is_refuted(&row.id.to_owned()))
            {
                return Some(as_row(explanation, row, explanation.same_as.clone()));
            }
            if key == explanation.key {
                return Some(Explanation { same_as, ..explanation.clone() });
            }
            Some(as_row(explanation, find(&key)?, same_as))
        };
        list.iter().filter(|one| one.is_vote() || !one.claims.is_empty()).filter_map(settle).collect()
    };
    let mut open: Vec<Vec<Explanation>> = traces.iter().copied().map(kept).filter(|list| !list.is_empty()).collect();
    let wrong = open.clone();
    keep_earliest_stage(&mut open);
    let mut covered = vec![false; open.len()];
    let mut found: Vec<Explanation> = unfinished(&open).into_iter().collect();
    for row in found.iter().flat_map(|one| &one.same_as).filter_map(|key| find(key)).collect::<Vec<_>>() {
        leave_open(&mut open, &mut covered, row.id, None);
    }
    while found.len() < MOST {
        let Some(next) = common(open.iter().map(Vec::as_slice)) else { break };
        let said = next.said();
        let is_told = found.is_empty()
            || (next.is_settled()
                && is_supported(&open, &covered, &next)
                && !is_said_already(&found, &next, &open, &covered));
        if is_told {
            leave_open(&mut open, &mut covered, &said, Some(&next));
            found.push(next);
        } else {
            open.iter_mut().for_each(|list| list.retain(|one| one.said() != said));
        }
    }
    if let Some(head) = wrong_polynomials(&wrong, &found) {
        // The stages behind a wrong formula are wrong because of it.
        found.retain(|one| !one.is_of_stage());
        found.insert(0, head);
    }
    for one in &mut found {
        if one.is_unfinished() && one.same_as.len() == 1 {
            one.about = About::Mistake;
            one.key = one.same_as.remove(0);
        }
    }
    let ends = traces.iter().filter(|list| list.iter().any(Explanation::is_not_finite)).count();
    let is_cause = |first: &Explanation| traces.iter().filter(|list| is_named_in(first, list)).count() >= ends;
    super::not_finite::with_end(not_finite, found, is_cause)
}

/// Where numbers end, in the stage in which they end in most traces.
fn not_finite(traces: &[&[Explanation]]) -> Option<Explanation> {
    let ends = || traces.iter().filter_map(|list| list.iter().find(|one| one.is_not_finite()));
    let agreeing = |one: &Explanation| ends().filter(|other| other.said() == one.said()).count();
    let likeliest = ends().rev().max_by_key(|one| agreeing(one))?;
    let mut likeliest = likeliest.clone();
    if let About::NotFinite(found) = &mut likeliest.about
        && ends().count() > 1
    {
        found.step = None;
        found.ends = ends().any(|one| matches!(&one.about, About::NotFinite(other) if other.ends));
    }
    Some(likeliest)
}

/// The polynomials that are wrong in most traces, where no exact form holds in most and what comes first says nothing
/// of them: their place, and what most traces say of them without an exact form.
fn wrong_polynomials(traces: &[Vec<Explanation>], found: &[Explanation]) -> Option<Explanation> {
    let mut wrong: BTreeMap<Subject, usize> = BTreeMap::new();
    for list in traces {
        let of_polynomials = list.iter().filter(|one| matches!(one.about, About::Polynomials { .. }));
        let subjects: BTreeSet<Subject> = of_polynomials.flat_map(Explanation::subjects).collect();
        subjects.into_iter().for_each(|subject| *wrong.entry(subject).or_default() += 1);
    }
    let most = wrong.values().copied().max()?;
    let named_in = |one: &Explanation| traces.iter().filter(|list| is_named_in(one, list)).count();
    let is_told = found.iter().any(|one| !one.subjects().is_empty())
        || found.first().is_some_and(|first| named_in(first) >= most);
    // A fault that few traces show may follow from something else.
    if is_told || most * 2 <= traces.len() {
        return None;
    }
    let subjects: Vec<Subject> = wrong.into_iter().filter(|(_, count)| *count == most).map(|(one, _)| one).collect();
    let guesses = traces.iter().flatten().filter_map(|one| match &one.about {
        About::Polynomials { subjects: theirs, found: OfPolynomials::Guess(guess) } if *theirs == subjects => {
            Some(guess)
        }
        _ => None,
    });
    let heads = guesses.map(|guess| Explanation::of_wrong(subjects.clone(), OfPolynomials::Guess(guess.clone())));
    let likeliest = heads.map(|head| (named_in(&head), head)).max_by_key(|(named, _)| *named);
    match likeliest {
        Some((named, head)) if named * 2 > most => Some(head),
        _ => Some(Explanation::of_wrong(subjects, OfPolynomials::Nothing)),
    }
}

/// Whether a trace that a told mistake explains needs this known one, too: they reproduce it together, and neither does
/// alone.
fn is_needed(next: &Explanation, open: &[Vec<Explanation>], covered: &[bool]) -> bool {
    let said = next.said();
    let mut beside = open.iter().zip(covered).filter(|(_, covered)| **covered);
    beside.any(|(list, _)| list.iter().any(|one| one.is_complete() && one.key == said))
}

/// Whether a further mistake is one that was told, in other words: a program has one formula for a polynomial, and what
/// is seen of a stage may follow from what is told of that one or of one before it.
fn is_said_already(found: &[Explanation], next: &Explanation, open: &[Vec<Explanation>], covered: &[bool]) -> bool {
    let are_needed = is_needed(next, open, covered);
    let subjects = next.subjects();
    let is_said = |one: &Explanation| {
        if are_needed && matches!(one.about, About::Mistake) {
            return false;
        }
        let theirs = one.subjects();
        // Where a trace shows no polynomial of a known mistake, that may be one of which a guess is told.
        let is_guess = matches!(one.about, About::Polynomials { .. });
        let kind = find(&next.key).filter(|row| is_formula(row.area)).and_then(Row::kind_of_pair);
        let in_one_formula = match kind.filter(|_| is_guess && subjects.is_empty()) {
            Some(kind) => theirs.iter().any(|subject| subject.kind() == kind),
            None => !subjects.is_empty() && subjects.iter().all(|subject| theirs.contains(subject)),
        };
        let in_one_stage = match (&one.about, &next.about) {
            (About::Stage(one), About::Stage(next)) => {
                let are_of_two_kinds = one.kind().zip(next.kind()).is_some_and(|(one, next)| one != next);
                one.stage() == next.stage() && !are_of_two_kinds
            }
            (_, About::Stage(fault)) => find(&one.key).is_some_and(|row| {
                fault.areas().contains(&row.area) || stage_of(row.area).is_some_and(|stage| stage <= fault.stage())
            }),
            (About::Stage(fault), _) => find(&next.key).is_some_and(|row| fault.areas().contains(&row.area)),
            _ => false,
        };
        in_one_formula || in_one_stage
    };
    found.iter().any(is_said)
}

/// Of the explanations of stages, leaves those of the earliest one only: later faults may follow from it. Also drops
/// known mistakes of that stage or a later one that explain fewer traces than show it wrong: they only resemble the
/// fault.
fn keep_earliest_stage(open: &mut Vec<Vec<Explanation>>) {
    let Some(earliest) = open.iter().flatten().filter_map(Explanation::stage).min() else { return };
    let is_of_it = |one: &Explanation| one.stage() == Some(earliest);
    let observed = open.iter().filter(|list| list.iter().any(is_of_it)).count();
    let late = CATALOGUE.iter().filter(|row| stage_of(row.area).is_some_and(|stage| stage >= earliest));
    let explained = |row: &Row| open.iter().filter(|list| names_completely(list, row.id)).count();
    let weak: Vec<&str> = late.filter(|row| explained(row) < observed).map(|row| row.id).collect();
    // An explanation that says what is wrong with the stage speaks for those that only say that something is.
    let is_said = open.iter().flatten().any(|one| is_of_it(one) && !one.is_vague());
    // In another order, polynomials of one pair stand where those of another are looked for.
    let is_misread = |one: &Explanation| find(&one.key).is_none() && one.stage().is_none();
    let has_order = open.iter().flatten().any(|one| one.key == Explanation::ORDER);
    for list in open.iter_mut() {
        list.retain(|one| {
            let is_weak = weak.contains(&one.key.as_str()) || (has_order && is_misread(one));
            !(is_weak || (is_said && one.is_vague())) && one.stage().is_none_or(|stage| stage == earliest)
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

/// Keys of mistakes that [`several`] would tell, or name as what can't be told apart, and that these scenes speak
/// against: the program was right there, and with the mistake it would not have been ([`shows`]).
#[must_use]
pub fn refuted(traces: &[&[Explanation]], right: &[&Scene]) -> Vec<String> {
    let mut refuted: Vec<String> = Vec::new();
    loop {
        let likely = several(traces.iter().copied(), &refuted);
        // An explanation of unfinished work stands for its stages.
        let stages = likely.iter().filter(|one| one.is_unfinished()).flat_map(|one| &one.same_as);
        let mut keys = likely.iter().map(|one| &one.key).chain(stages).filter(|key| !refuted.contains(key));
        match keys.find(|key| right.iter().any(|scene| shows(scene, key))).cloned() {
            Some(key) => refuted.push(key),
            None => {
                let work = Cell::new(0);
                let rivals = likely.iter().filter(|one| one.about == About::Mistake).flat_map(|one| &one.same_as);
                let is_refuted = |key: &&String| right.iter().any(|scene| shows_within(scene, key, &work));
                refuted.extend(rivals.filter(is_refuted).cloned().collect::<Vec<_>>());
                return refuted;
            }
        }
    }
}

/// Among this number of traces, one that looks as if a stage were empty is no evidence.
const MANY: usize = 8;

/// Whether enough of what is left names this further mistake: a trace that nothing explains yet, one that needs it
/// beside a mistake that was told, or two others, where there are several. Traces in which a stage looks wrong count
/// only where nothing explains them, and one alone may follow from what was found before. That polynomials are missing
/// does.
fn is_supported(open: &[Vec<Explanation>], covered: &[bool], next: &Explanation) -> bool {
    let said = next.said();
    let naming = |wanted: bool| {
        let of_sort = open.iter().zip(covered).filter(|(_, covered)| **covered == wanted);
        of_sort.filter(|(list, _)| list.iter().any(|one| bears_out_wholly(one, &said, Some(next)))).count()
    };
    if next.is_of_stage() {
        return naming(false) > 1 && !next.is_vague();
    }
    let is_partner = matches!(next.about, About::Mistake) && is_needed(next, open, covered);
    !next.is_of_missing() && (naming(false) > 0 || is_partner || naming(true) >= open.len().min(2))
}

/// Whether a trace's explanations name a mistake, told or as not to be told apart, that reproduces everything.
fn names_completely(list: &[Explanation], key: &str) -> bool {
    list.iter().any(|one| one.is_complete() && bears_out(one, key, None))
}

/// Leaves what this doesn't explain: of a trace that it explains only what is complete besides.
fn leave_open(open: &mut [Vec<Explanation>], covered: &mut [bool], said: &str, told: Option<&Explanation>) {
    for (list, covered) in open.iter_mut().zip(covered) {
        if list.iter().any(|one| bears_out(one, said, told)) {
            *covered = true;
            list.retain(|one| !bears_out(one, said, told) && one.is_complete());
        }
    }
}
/// All stages that are told to be empty by a trace, or by two where there are [`MANY`], as one explanation; their keys
/// are in [`Explanation::same_as`].
fn unfinished(traces: &[Vec<Explanation>]) -> Option<Explanation> {
    let told: Vec<&Explanation> = traces.iter().flatten().filter(|one| one.is_complete()).collect();
    let naming = |key: &str| traces.iter().filter(|list| names_completely(list, key)).count();
    // A mistake that a trace can't tell from an empty stage may explain more traces than that stage.
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
        reproduced: of_rows().map(|one| one.reproduced).sum(),
        samples: of_rows().map(|one| one.samples).sum(),
        same_as: rows.iter().map(|row| row.id.to_owned()).collect(),
        ..Explanation::about(Explanation::UNFINISHED, About::Unfinished)
    })
}
