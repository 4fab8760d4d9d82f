//! Tests that the catalogue is closed under the assignment's symmetries. A mistake with one kind of pair, one end, one
//! place or one quantity exists for the others, or a reason is given here.
use super::CATALOGUE;
use crate::assignments::{
    all::find,
    rows::{Area, RowKind},
};
use std::collections::BTreeSet;

/// The contents of one cell of a family.
enum FamilyCell {
    /// The row with this id fills the cell.
    Is(&'static str),
    /// The cell is empty for this reason.
    None(&'static str),
}

use FamilyCell::{Is, None as No};

/// Rows that differ in one respect.
struct MistakeFamily {
    /// The names of the columns, in the order of the cells.
    sides: &'static [&'static str],
    /// The mistakes, with one cell per column.
    rows: &'static [(&'static str, &'static [FamilyCell])],
}

const SUPPLIED_APPROACH: FamilyCell = No("the approach of edges is supplied, so students change it as a whole");
const SEPARATE_PRODUCTS: FamilyCell = No("the products of the overlap are separate rows");
const ONE_RADIUS: FamilyCell = No("a half-plane has no radius");
const AT_REST: FamilyCell = No("half-planes do not move");
const ONE_IS_ENOUGH: FamilyCell = No("the row tests a tolerance of the rules, for which one kind of pair is enough");

const PAIR_FAMILY: MistakeFamily = MistakeFamily {
    sides: &["pp-", "pe-", "ph-"],
    rows: &[
        (
            "displacements reversed",
            &[
                Is("pp-displacements-swapped"),
                No("the mistake affects all inputs"),
                No("the mistake affects all \
                inputs"),
            ],
        ),
        ("positions' index", &[Is("pp-position-index"), Is("pe-position-index"), Is("ph-position-index")]),
        ("lowest power first", &[Is("pp-reversed"), Is("pe-reversed"), Is("ph-reversed")]),
        ("polynomials' order", &[Is("pp-swapped"), Is("pe-swapped"), Is("ph-swapped")]),
        ("left empty", &[Is("pp-empty"), Is("pe-empty"), Is("ph-empty")]),
        ("all zero", &[Is("pp-zero"), Is("pe-zero"), Is("ph-zero")]),
        ("end positions", &[Is("pp-end-positions"), Is("pe-end-positions"), Is("ph-end-position")]),
        (
            "ends for displacements",
            &[Is("pp-end-for-displacement"), Is("pe-end-for-displacement"), Is("ph-end-for-displacement")],
        ),
        (
            "first body still",
            &[
                Is("pp-first-still"),
                Is("pe-particle-still"),
                No("without motion only the constant of the polynomial remains"),
            ],
        ),
        ("second body still", &[Is("pp-second-still"), Is("pe-edge-still"), AT_REST]),
        ("radii squared apart", &[Is("pp-radii-squared-apart"), Is("pe-radii-squared-apart"), ONE_RADIUS]),
        (
            "radius not squared",
            &[Is("pp-radius-not-squared"), Is("pe-radius-not-squared"), Is("ph-radius-not-squared")],
        ),
        ("first radius twice", &[Is("pp-first-radius-twice"), Is("pe-particle-radius-twice"), ONE_RADIUS]),
        ("second radius twice", &[Is("pp-second-radius-twice"), Is("pe-edge-radius-twice"), ONE_RADIUS]),
        ("diameters", &[Is("pp-diameters"), Is("pe-diameters"), Is("ph-diameter")]),
        ("first radius forgotten", &[Is("pp-no-first-radius"), Is("pe-no-particle-radius"), Is("ph-no-radius")]),
        ("second radius forgotten", &[Is("pp-one-radius"), Is("pe-no-edge-radius"), ONE_RADIUS]),
        ("another one's radius", &[Is("pp-next-radius"), Is("pe-first-edge-radius"), Is("ph-radius-index")]),
        ("overlap negated", &[Is("pp-overlap-negated"), Is("pe-quartic-negated"), Is("ph-overlap-negated")]),
        (
            "distance not squared",
            &[
                Is("pp-distance-not-squared"),
                No("the overlap of edges has products, no distance"),
                Is("ph-offset-not-squared"),
            ],
        ),
        ("linear sign", &[Is("pp-linear-sign"), SEPARATE_PRODUCTS, Is("ph-linear-sign")]),
        ("linear factor", &[Is("pp-no-two"), Is("pe-linear-one-ab"), Is("ph-no-two")]),
        ("leading sign", &[Is("pp-quadratic-sign"), Is("pe-quartic-plus-fi"), Is("ph-quadratic-sign")]),
        ("leading coefficient missing", &[Is("pp-no-quadratic"), Is("pe-three-terms"), Is("ph-no-quadratic")]),
        ("constant sign", &[Is("pp-constant-sign"), Is("pe-constant-minus-aa"), Is("ph-constant-sign")]),
        ("tiny error", &[Is("pp-tiny-error"), ONE_IS_ENOUGH, ONE_IS_ENOUGH]),
        (
            "one component only",
            &[
                Is("pp-x-only"),
                No("the mistake affects all inputs"),
                No("the mistake affects all \
            inputs"),
            ],
        ),
        ("approach negated", &[Is("pp-approach-negated"), Is("pe-approach-negated"), Is("ph-approach-negated")]),
        ("approach, slope's sign", &[Is("pp-approach-slope-sign"), SUPPLIED_APPROACH, Is("ph-approach-slope-sign")]),
        ("approach, slope twice", &[Is("pp-approach-slope-twice"), SUPPLIED_APPROACH, Is("ph-approach-slope-twice")]),
        (
            "approach, constant's sign",
            &[Is("pp-separating"), SUPPLIED_APPROACH, No("its sign is part of a factor: ph-approach-no-speed")],
        ),
        (
            "approach at the start",
            &[Is("pp-approach-at-start"), Is("pe-approach-constant-alpha"), Is("ph-approach-at-start")],
        ),
        ("no approach", &[Is("pp-no-approach"), Is("pe-approach-missing"), Is("ph-no-approach")]),
        ("contact at start", &[Is("pp-contact-at-start"), Is("pe-contact-at-start"), Is("ph-contact-at-start")]),
        ("contact at end", &[Is("pp-contact-at-end"), Is("pe-contact-at-end"), Is("ph-contact-at-end")]),
        ("contact reversed", &[Is("pp-contact-reversed"), Is("pe-contact-reversed"), Is("ph-contact-reversed")]),
        (
            "contact, first body still",
            &[
                Is("pp-contact-first-still"),
                Is("pe-contact-particle-still"),
                No("the same as at the start, where nothing else moves"),
            ],
        ),
        (
            "contact, first body at its end",
            &[
                Is("pp-contact-first-at-end"),
                Is("pe-contact-particle-at-end"),
                No("the same as at the end, where nothing else moves"),
            ],
        ),
        ("contact, second body at its end", &[Is("pp-contact-second-at-end"), Is("pe-contact-edge-at-end"), AT_REST]),
        ("contact, second body still", &[Is("pp-contact-second-still"), Is("pe-contact-edge-still"), AT_REST]),
    ],
};

const END_FAMILY: MistakeFamily = MistakeFamily {
    sides: &["first", "second"],
    rows: &[
        ("still", &[Is("pe-first-end-still"), Is("pe-second-end-still")]),
        ("displacement for both", &[Is("pe-one-displacement"), Is("pe-other-displacement")]),
        ("its particle's radius", &[Is("pe-first-end-radius"), Is("pe-second-end-radius")]),
        ("contact vector to it", &[Is("pe-contact-first-end"), Is("pe-contact-second-end")]),
        ("alone in the zone", &[Is("zones-one-endpoint"), Is("zones-other-endpoint")]),
        ("not pushed", &[No("a student who omits one end omits the last"), Is("response-one-endpoint")]),
    ],
};

const ALPHA_FAMILY: MistakeFamily = MistakeFamily {
    sides: &["low", "high"],
    rows: &[
        ("slope's sign", &[Is("pe-alpha-low-slope-sign"), Is("pe-alpha-high-slope-sign")]),
        ("negated", &[Is("pe-alpha-low-negated"), Is("pe-alpha-high-negated")]),
        ("no quadratic", &[Is("pe-alpha-low-no-quadratic"), Is("pe-alpha-high-no-quadratic")]),
        ("half of the slope", &[Is("pe-alpha-low-half-slope"), Is("pe-alpha-high-half-slope")]),
        ("at the start", &[Is("pe-alpha-low-at-start"), Is("pe-alpha-high-at-start")]),
        ("missing", &[Is("pe-alpha-low-missing"), Is("pe-alpha-high-missing")]),
        ("the other one", &[Is("pe-alpha-low-is-high"), Is("pe-alpha-high-is-low")]),
        ("unscaled", &[No("alpha > 0 has no constant to scale"), Is("pe-alpha-high-unscaled")]),
    ],
};

const PLACE_FAMILY: MistakeFamily = MistakeFamily {
    sides: &["first", "last"],
    rows: &[
        ("contact alone", &[Is("loop-first-only"), Is("loop-last-only")]),
        ("contact left out", &[Is("loop-first-skipped"), Is("loop-last-skipped")]),
        ("contact of a pass alone", &[Is("ct-first-only"), No("contacts are resolved immediately")]),
        ("zone alone", &[Is("geometric-first-zone-only"), Is("geometric-last-zone-only")]),
        ("particle that may stop its zone", &[Is("failsafe-first-fixed-only"), Is("failsafe-last-fixed-only")]),
        ("zone left out", &[Is("geometric-first-zone-skipped"), Is("geometric-last-zone-skipped")]),
        ("half-plane alone", &[Is("pairs-first-half-plane-only"), No("students keep the first object's result")]),
        ("zone's flag alone", &[Is("zones-flag-lost"), Is("zones-flag-overwritten")]),
        ("impulse alone", &[Is("loop-first-only"), Is("loop-last-wins")]),
    ],
};

const QUANTITY_FAMILY: MistakeFamily = MistakeFamily {
    sides: &["position", "velocit"],
    rows: &[
        ("alone changed by contacts", &[Is("response-positions-only"), Is("response-velocities-only")]),
        ("restored by the loop", &[Is("loop-positions-restored"), Is("loop-velocity-restored")]),
        ("of the prediction in each round", &[Is("loop-from-prediction"), Is("loop-predicted-velocities")]),
        ("kept where zones stop", &[Is("failsafe-stop-keeps-position"), Is("failsafe-stop-keeps-velocity")]),
        ("kept where zones move", &[No("identical to an empty failsafe"), Is("failsafe-velocity-kept")]),
    ],
};

const ROUND_FAMILY: MistakeFamily = MistakeFamily {
    sides: &["too few", "too many"],
    rows: &[
        ("impulse rounds", &[Is("loop-one-fewer"), Is("loop-one-more")]),
        ("another number", &[Is("loop-only-one"), Is("loop-double")]),
        ("rounds of zones", &[Is("geometric-one-round"), Is("geometric-extra-pass")]),
        ("passes of continuous-time", &[Is("ct-no-response"), Is("ct-two-passes")]),
        ("the loop's success", &[Is("loop-always-fails"), Is("loop-always-succeeds")]),
    ],
};

const SUM_FAMILY: MistakeFamily = MistakeFamily {
    sides: &["center", "momentum", "angular", "inertia"],
    rows: &[
        (
            "unweighted",
            &[
                Is("failsafe-center-unweighted"),
                Is("failsafe-momentum-unweighted"),
                Is("failsafe-angular-unweighted"),
                Is("failsafe-inertia-unweighted"),
            ],
        ),
        (
            "at the end",
            &[
                Is("failsafe-center-at-end"),
                No("a motion has no end"),
                No("the momentum is the same up to round-off: momentum-from-end"),
                Is("failsafe-inertia-at-end"),
            ],
        ),
        (
            "of velocities",
            &[
                No("positions are already available"),
                Is("failsafe-momentum-velocity"),
                Is("failsafe-angular-velocity"),
                No("the moment of inertia uses no motion"),
            ],
        ),
        (
            "about the origin",
            &[
                No("the point is the center itself"),
                No("the linear momentum is not about a point"),
                Is("failsafe-about-origin"),
                Is("failsafe-inertia-about-origin"),
            ],
        ),
        (
            "as an integer",
            &[
                No("a vector has no integer type"),
                No("a vector has no integer type"),
                Is("failsafe-angular-integer"),
                Is("failsafe-inertia-integer"),
            ],
        ),
        (
            "left out",
            &[
                Is("failsafe-no-center"),
                Is("failsafe-no-translation"),
                Is("failsafe-no-rotation"),
                Is("failsafe-no-inertia"),
            ],
        ),
    ],
};

const FAMILIES: [&MistakeFamily; 7] =
    [&PAIR_FAMILY, &END_FAMILY, &ALPHA_FAMILY, &PLACE_FAMILY, &QUANTITY_FAMILY, &ROUND_FAMILY, &SUM_FAMILY];

/// The prefixes of the ids of rows that exist only for one kind of pair, with the reasons.
const SINGLE_KIND_PREFIXES: &[(&str, &str)] = &[
    ("pe-quartic-", "a product of the quartic"),
    ("pe-cubic-", "a product of the quartic"),
    ("pe-no-cubic", "a coefficient of the quartic"),
    ("pe-square-", "a product of the quartic"),
    ("pe-linear-", "a product of the quartic"),
    ("pe-constant-", "a product of the quartic"),
    ("pe-radius-unscaled", "only the quartic has a denominator"),
    ("pe-displacements-swapped", "only an edge has two ends"),
    ("pe-endpoints-swapped", "only an edge has two ends"),
    ("pe-approach-", "only the quintic is supplied"),
    ("pe-contact-alpha-", "only an edge has alpha"),
    ("pe-contact-other-end", "only an edge has alpha"),
    ("pe-contact-nearest-end", "only an edge has ends"),
    ("pe-radius-index", "the radius of another body; the first edge's is a separate row"),
    ("ph-overlap-signed", "only a half-plane has sides"),
    ("ph-first-half-plane", "the loops over particles and edges already have their indices"),
    ("ph-no-normal-square", "only a half-plane has a normal"),
    ("ph-normal-length", "only a half-plane has a normal"),
    ("ph-no-point", "only a half-plane has a point"),
    ("ph-overlap-to-point", "only a half-plane has a point"),
    ("ph-reversed-offset", "only a half-plane has a point"),
    ("ph-approach-no-speed", "only this approach is a product of two numbers"),
    ("ph-approach-speed-only", "only this approach is a product of two numbers"),
    ("ph-approach-constant-no-speed", "only this approach is a product of two numbers"),
    ("ph-approach-closing-only", "only this approach is a product of two numbers"),
    ("ph-contact-undivided", "only a half-plane has a normal"),
    ("ph-contact-divided-by-length", "only a half-plane has a normal"),
    ("ph-contact-is-normal", "only a half-plane has a normal"),
    ("ph-contact-to-point", "only a half-plane has a point"),
];

fn cells() -> impl Iterator<Item = (&'static str, usize, &'static FamilyCell)> {
    let rows = FAMILIES.into_iter().flat_map(|family| family.rows);
    rows.flat_map(|(name, cells)| cells.iter().enumerate().map(move |(side, cell)| (*name, side, cell)))
}

#[test]
fn every_cell_is_a_row_or_has_its_reason() {
    for family in FAMILIES {
        for (name, cells) in family.rows {
            assert_eq!(cells.len(), family.sides.len(), "{name}: one cell for each of {:?}", family.sides);
        }
    }
    for (name, side, cell) in cells() {
        match cell {
            Is(id) => assert!(find(id).is_some_and(|row| row.kind == RowKind::Wrong), "{name}, {side}: no row {id}"),
            No(reason) => assert!(reason.contains(' '), "{name}, {side}: the reason for the missing row is empty"),
        }
    }
    for (name, cells) in PAIR_FAMILY.rows {
        for (cell, kind) in cells.iter().zip(PAIR_FAMILY.sides) {
            assert!(!matches!(cell, Is(id) if !id.starts_with(kind)), "{name} has a row of another kind");
        }
    }
}

/// A new row of one kind of pair must belong to a family, together with the rows of the other kinds.
#[test]
fn every_row_of_one_kind_of_pair_belongs_to_a_family() {
    let known: BTreeSet<&str> =
        cells().filter_map(|(.., cell)| if let Is(id) = cell { Some(*id) } else { None }).collect();
    let is_alone = |id: &str| SINGLE_KIND_PREFIXES.iter().any(|(beginning, _)| id.starts_with(beginning));
    let of_pairs = CATALOGUE.iter().filter(|row| row.kind == RowKind::Wrong && row.pair_kind().is_some());
    let gaps: Vec<&str> = of_pairs
        .filter(|row| row.area <= Area::ContactVector && !known.contains(row.id) && !is_alone(row.id))
        .map(|row| row.id)
        .collect();
    assert!(gaps.is_empty(), "which rows are like these for other kinds of pairs? {gaps:?}");
    let vain: Vec<&str> = SINGLE_KIND_PREFIXES
        .iter()
        .map(|(id, _)| *id)
        .filter(|id| !CATALOGUE.iter().any(|row| row.id.starts_with(id)))
        .collect();
    assert!(vain.is_empty(), "{vain:?} do not name a row");
}
