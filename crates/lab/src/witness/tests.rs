//! All that is said of the stages of sample programs on the probe scenes is true, and every sort of sentence is said.
use super::{MOST, checked};
use crate::{mutants::mutants, runs::judged};
use fosssim_oracle::{
    assignments::Assignment,
    diagnose::{About, StageFault, StepStage, WrongZoneRounds, explain_stages, probe_scenes},
    judge::FindingDetail,
    scene::Collision,
    sim::Stage,
    student::{self, Area, CATALOGUE, Mistake, Row, RowKind, Student},
};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Sorts of sentences that must be seen; of motions, each of the words. Left out are those that only some pairs of
/// mistakes make, which the lab tries: another number of rounds, positions of no known origin, zones wrong in several
/// ways.
const SORTS: &[&str] = &[
    "AfterRounds",
    "BehindFirstRound",
    "ContactTimes",
    "ContactVectors Direction",
    "ContactVectors Inexact",
    "ContactVectors Length",
    "ContactVectors Perpendicular",
    "ContactVectors Reversed",
    "ContactVectors Zero",
    "Decisions Both",
    "Decisions Missed",
    "Decisions Superfluous",
    "FirstRound",
    "Geometric(Left { always: false })",
    "Geometric(Left { always: true })",
    "Geometric(Superfluous)",
    "HandedOver RanOut",
    "HandedOver Settled",
    "LaterRounds",
    "ManyContacts",
    "Motion Centre",
    "Motion Distances",
    "Motion LessTurn",
    "Motion MoreTurn",
    "Motion NoTurn",
    "Motion Speeds",
    "Motion Turn",
    "Motion TurnBack",
    "Motion Velocities",
    "Order",
    "Responses Across alone",
    "Responses Across in rounds",
    "Responses Amount alone",
    "Responses Amount in rounds",
    "Responses Nothing alone",
    "Responses Unchanged alone",
    "Responses Unchanged in rounds",
    "Rounds(Fewer)",
    "Rounds(More)",
    "RoundsOfPrediction",
    "Unresolved { all: false }",
    "Unresolved { all: true }",
    "ZonePositions(BeforeFailsafe)",
    "ZonePositions(Prediction)",
    "ZoneRounds(Fewer)",
    "ZoneRounds(Growth)",
    "ZoneRounds(More)",
    "Zones(Joined)",
    "Zones(KeepPositions)",
    "Zones(KeepVelocities)",
    "Zones(MoveOn)",
    "Zones(NotMerged)",
    "Zones(Others)",
    "Zones(Partly)",
    "Zones(PartlyStopped)",
    "Zones(Stop)",
    "Zones(Unmoved)",
];

/// Programs with one mistake of a stage, with two, and those that the catalogue does not have.
fn programs() -> Vec<(String, Student)> {
    let is_of_stage =
        |row: &&Row| row.kind == RowKind::Wrong && row.area >= Area::ContactVector && row.area < Area::Trace;
    let rows: Vec<&Row> = CATALOGUE.iter().filter(is_of_stage).collect();
    let one = rows.iter().map(|row| (row.id.to_owned(), Student::new(Some(row.mistake))));
    let two = rows.iter().enumerate().map(|(number, row)| {
        let other = rows[(number * 37 + 11) % rows.len()];
        (format!("{} and {}", row.id, other.id), Student::new(Some(row.mistake)).and(Some(other.mistake)))
    });
    let others = mutants().map(|mutant| (mutant.id.to_owned(), Student::default().with_change(&mutant.change)));
    let find = |id: &str| mutants().find(|mutant| mutant.id == id).expect("a mutant");
    let missed_and_superfluous =
        Student::new(Some(Mistake::DecisionHalfStep)).with_change(&find("root-approach-not-searched").change);
    let both = ("half of the step, whatever approaches".to_owned(), missed_and_superfluous);
    one.chain(two).chain(others).chain([both]).collect()
}

#[test]
fn what_is_said_of_stages_is_true() {
    let scenes = probe_scenes(Assignment::T2M2);
    let cases: Vec<_> =
        programs().into_iter().flat_map(|program| scenes.iter().map(move |scene| (program.clone(), scene))).collect();
    let found: Vec<_> = cases
        .par_iter()
        .filter_map(|((id, student), (name, scene))| {
            checked(scene, *student)
                .map(|(sort, lie)| (sort, lie.map(|lie| format!("{id} on {name}: {:?}", lie.about))))
        })
        .collect();
    let lies: Vec<&String> = found.iter().filter_map(|(_, lie)| lie.as_ref()).collect();
    assert!(lies.is_empty(), "{} of {}: {lies:#?}", lies.len(), found.len());
    let seen: BTreeSet<&str> = found.iter().map(|(sort, _)| sort.as_str()).collect();
    let unseen: Vec<&&str> = SORTS.iter().filter(|sort| !seen.contains(**sort)).collect();
    assert!(unseen.is_empty(), "{unseen:?}; seen: {seen:#?}");
}

/// The first sentence of a report and its likely mistake are of one story: where the judge finds the first
/// difference before the middle of a step, no zone is accused, and no zone that grows where it finds one behind the
/// first failsafe.
#[test]
fn what_is_said_of_stages_does_not_lie_behind_the_first_divergence() {
    let scenes: Vec<_> = probe_scenes(Assignment::T2M2)
        .into_iter()
        .filter(|(_, scene)| matches!(scene.collision, Collision::Hybrid { .. }))
        .collect();
    let cases: Vec<_> = programs()
        .into_iter()
        .enumerate()
        .filter_map(|(number, program)| (number % 5 == 2).then(|| (program, &scenes[number % scenes.len()])))
        .collect();
    let contradictions: Vec<String> = cases
        .par_iter()
        .filter_map(|((id, student), (name, scene))| {
            let trace = student::trace_within(scene, *student, MOST).unwrap_or_else(|(bytes, _)| bytes);
            let told = explain_stages(scene, &trace)?;
            let first = judged(scene, &trace).fair?.findings.first_divergence?;
            let behind_failsafe = match first.detail {
                FindingDetail::PassPositions { place } => place.pass.stage == Stage::Geometric { round: 1 },
                _ => false,
            };
            let grows = matches!(told.about, About::Stage(StageFault::ZoneRounds(WrongZoneRounds::Growth)));
            let is_before_middle = first.frame % 2 == 1;
            let contradicts =
                (is_before_middle && told.stage() == Some(StepStage::Zones)) || (grows && behind_failsafe);
            contradicts.then(|| format!("{id} on {name}: {:?} and {first:?}", told.about))
        })
        .collect();
    assert!(cases.len() > 50 && contradictions.is_empty(), "{contradictions:#?}");
}
