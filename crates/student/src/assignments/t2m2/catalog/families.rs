//! Tests that the catalog is closed under the assignment's symmetries. A mistake with one kind of pair, one end, one
//! position in a list or one quantity exists for the others, or a reason is given here.
use super::CATALOG;
use crate::assignments::{
    all::find,
    rows::{Area, RowKind},
};
use std::collections::BTreeSet;

/// The contents of one cell of a family.
enum FamilyCell {
    /// The row with this id fills the cell.
    Row(&'static str),
    /// The cell is empty for this reason.
    None(&'static str),
}

use FamilyCell::{None as No, Row};

/// Rows that differ in one respect.
struct MistakeFamily {
    /// The names of the columns, in the order of the cells.
    columns: &'static [&'static str],
    /// The mistakes, with one cell per column.
    rows: &'static [(&'static str, &'static [FamilyCell])],
}

const SUPPLIED_APPROACH: FamilyCell = No("the approach of edges is supplied, so students change it as a whole");
const SEPARATE_PRODUCTS: FamilyCell = No("the products of the overlap are separate rows");
const ONE_RADIUS: FamilyCell = No("a half-plane has no radius");
const AT_REST: FamilyCell = No("half-planes do not move");
const ONE_IS_ENOUGH: FamilyCell = No("the row tests a tolerance of the rules, for which one kind of pair is enough");

const PAIR_FAMILY: MistakeFamily = MistakeFamily {
    columns: &["pp-", "pe-", "ph-"],
    rows: &[
        (
            "displacements reversed",
            &[
                Row("pp-displacements-swapped"),
                No("the mistake affects all inputs"),
                No("the mistake affects all \
                inputs"),
            ],
        ),
        ("positions' index", &[Row("pp-position-index"), Row("pe-position-index"), Row("ph-position-index")]),
        ("lowest power first", &[Row("pp-reversed"), Row("pe-reversed"), Row("ph-reversed")]),
        ("polynomials' order", &[Row("pp-swapped"), Row("pe-swapped"), Row("ph-swapped")]),
        ("left empty", &[Row("pp-empty"), Row("pe-empty"), Row("ph-empty")]),
        ("all zero", &[Row("pp-zero"), Row("pe-zero"), Row("ph-zero")]),
        ("end positions", &[Row("pp-end-positions"), Row("pe-end-positions"), Row("ph-end-position")]),
        (
            "ends for displacements",
            &[Row("pp-end-for-displacement"), Row("pe-end-for-displacement"), Row("ph-end-for-displacement")],
        ),
        (
            "first body still",
            &[
                Row("pp-first-still"),
                Row("pe-particle-still"),
                No("without motion only the constant of the polynomial remains"),
            ],
        ),
        ("second body still", &[Row("pp-second-still"), Row("pe-edge-still"), AT_REST]),
        ("radii squared apart", &[Row("pp-radii-squared-apart"), Row("pe-radii-squared-apart"), ONE_RADIUS]),
        (
            "radius not squared",
            &[Row("pp-radius-not-squared"), Row("pe-radius-not-squared"), Row("ph-radius-not-squared")],
        ),
        ("first radius twice", &[Row("pp-first-radius-twice"), Row("pe-particle-radius-twice"), ONE_RADIUS]),
        ("second radius twice", &[Row("pp-second-radius-twice"), Row("pe-edge-radius-twice"), ONE_RADIUS]),
        ("diameters", &[Row("pp-diameters"), Row("pe-diameters"), Row("ph-diameter")]),
        ("first radius forgotten", &[Row("pp-no-first-radius"), Row("pe-no-particle-radius"), Row("ph-no-radius")]),
        ("second radius forgotten", &[Row("pp-one-radius"), Row("pe-no-edge-radius"), ONE_RADIUS]),
        ("another one's radius", &[Row("pp-next-radius"), Row("pe-first-edge-radius"), Row("ph-radius-index")]),
        ("overlap negated", &[Row("pp-overlap-negated"), Row("pe-quartic-negated"), Row("ph-overlap-negated")]),
        (
            "distance not squared",
            &[
                Row("pp-distance-not-squared"),
                No("the overlap of edges has products, no distance"),
                Row("ph-offset-not-squared"),
            ],
        ),
        ("linear sign", &[Row("pp-linear-sign"), SEPARATE_PRODUCTS, Row("ph-linear-sign")]),
        ("linear factor", &[Row("pp-no-two"), Row("pe-linear-one-ab"), Row("ph-no-two")]),
        ("leading sign", &[Row("pp-quadratic-sign"), Row("pe-quartic-plus-fi"), Row("ph-quadratic-sign")]),
        ("leading coefficient missing", &[Row("pp-no-quadratic"), Row("pe-three-terms"), Row("ph-no-quadratic")]),
        ("constant sign", &[Row("pp-constant-sign"), Row("pe-constant-minus-aa"), Row("ph-constant-sign")]),
        ("tiny error", &[Row("pp-tiny-error"), ONE_IS_ENOUGH, ONE_IS_ENOUGH]),
        (
            "one component only",
            &[
                Row("pp-x-only"),
                No("the mistake affects all inputs"),
                No("the mistake affects all \
            inputs"),
            ],
        ),
        ("approach negated", &[Row("pp-approach-negated"), Row("pe-approach-negated"), Row("ph-approach-negated")]),
        ("approach, slope's sign", &[Row("pp-approach-slope-sign"), SUPPLIED_APPROACH, Row("ph-approach-slope-sign")]),
        ("approach, slope twice", &[Row("pp-approach-slope-twice"), SUPPLIED_APPROACH, Row("ph-approach-slope-twice")]),
        (
            "approach, constant's sign",
            &[
                Row("pp-separating"),
                SUPPLIED_APPROACH,
                No("the constant's sign depends on the factor dx.n, which ph-approach-no-speed omits"),
            ],
        ),
        (
            "approach at the start",
            &[Row("pp-approach-at-start"), Row("pe-approach-constant-alpha"), Row("ph-approach-at-start")],
        ),
        ("no approach", &[Row("pp-no-approach"), Row("pe-approach-missing"), Row("ph-no-approach")]),
        ("contact at start", &[Row("pp-contact-at-start"), Row("pe-contact-at-start"), Row("ph-contact-at-start")]),
        ("contact at end", &[Row("pp-contact-at-end"), Row("pe-contact-at-end"), Row("ph-contact-at-end")]),
        ("contact reversed", &[Row("pp-contact-reversed"), Row("pe-contact-reversed"), Row("ph-contact-reversed")]),
        (
            "contact, first body still",
            &[
                Row("pp-contact-first-still"),
                Row("pe-contact-particle-still"),
                No("the same as at the start, where nothing else moves"),
            ],
        ),
        ("contact, added", &[Row("pp-contact-first-added"), Row("pe-contact-particle-added"), Row("ph-contact-added")]),
        (
            "contact, first body at its end",
            &[
                Row("pp-contact-first-at-end"),
                Row("pe-contact-particle-at-end"),
                No("the same as at the end, where nothing else moves"),
            ],
        ),
        ("contact, second body at its end", &[Row("pp-contact-second-at-end"), Row("pe-contact-edge-at-end"), AT_REST]),
        ("contact, second body still", &[Row("pp-contact-second-still"), Row("pe-contact-edge-still"), AT_REST]),
    ],
};

const END_FAMILY: MistakeFamily = MistakeFamily {
    columns: &["first", "second"],
    rows: &[
        ("still", &[Row("pe-first-end-still"), Row("pe-second-end-still")]),
        ("displacement for both", &[Row("pe-one-displacement"), Row("pe-other-displacement")]),
        ("its particle's radius", &[Row("pe-first-end-radius"), Row("pe-second-end-radius")]),
        ("contact vector to it", &[Row("pe-contact-first-end"), Row("pe-contact-second-end")]),
        ("alone in the zone", &[Row("zones-one-endpoint"), Row("zones-other-endpoint")]),
        ("not pushed", &[No("no student forgets only the first end"), Row("response-one-endpoint")]),
    ],
};

const ALPHA_FAMILY: MistakeFamily = MistakeFamily {
    columns: &["low", "high"],
    rows: &[
        ("slope's sign", &[Row("pe-alpha-low-slope-sign"), Row("pe-alpha-high-slope-sign")]),
        ("negated", &[Row("pe-alpha-low-negated"), Row("pe-alpha-high-negated")]),
        ("no quadratic", &[Row("pe-alpha-low-no-quadratic"), Row("pe-alpha-high-no-quadratic")]),
        ("half of the slope", &[Row("pe-alpha-low-half-slope"), Row("pe-alpha-high-half-slope")]),
        ("at the start", &[Row("pe-alpha-low-at-start"), Row("pe-alpha-high-at-start")]),
        ("missing", &[Row("pe-alpha-low-missing"), Row("pe-alpha-high-missing")]),
        ("the other one", &[Row("pe-alpha-low-is-high"), Row("pe-alpha-high-is-low")]),
        ("unscaled", &[No("alpha > 0 has no constant to scale"), Row("pe-alpha-high-unscaled")]),
    ],
};

const PLACE_FAMILY: MistakeFamily = MistakeFamily {
    columns: &["first", "last"],
    rows: &[
        ("contact alone", &[Row("loop-first-only"), Row("loop-last-only")]),
        ("contact left out", &[Row("loop-first-skipped"), Row("loop-last-skipped")]),
        ("contact of a pass alone", &[Row("ct-first-only"), No("contacts are resolved immediately")]),
        ("zone alone", &[Row("geometric-first-zone-only"), Row("geometric-last-zone-only")]),
        ("particle that may stop its zone", &[Row("failsafe-first-fixed-only"), Row("failsafe-last-fixed-only")]),
        ("zone left out", &[Row("geometric-first-zone-skipped"), Row("geometric-last-zone-skipped")]),
        ("half-plane alone", &[Row("pairs-first-half-plane-only"), No("students keep the first object's result")]),
        ("zone's flag alone", &[Row("zones-flag-lost"), Row("zones-flag-overwritten")]),
        ("impulse alone", &[Row("loop-first-only"), Row("loop-last-wins")]),
    ],
};

const QUANTITY_FAMILY: MistakeFamily = MistakeFamily {
    columns: &["position", "velocit"],
    rows: &[
        ("alone changed by contacts", &[Row("response-positions-only"), Row("response-velocities-only")]),
        ("restored by the loop", &[Row("loop-positions-restored"), Row("loop-velocity-restored")]),
        ("of the prediction in each round", &[Row("loop-from-prediction"), Row("loop-predicted-velocities")]),
        ("kept where zones stop", &[Row("failsafe-stop-keeps-position"), Row("failsafe-stop-keeps-velocity")]),
        ("kept where zones move", &[No("identical to an empty failsafe"), Row("failsafe-velocity-kept")]),
    ],
};

const ROUND_FAMILY: MistakeFamily = MistakeFamily {
    columns: &["too few", "too many"],
    rows: &[
        ("impulse rounds", &[Row("loop-one-fewer"), Row("loop-one-more")]),
        ("another number", &[Row("loop-only-one"), Row("loop-double")]),
        ("rounds of zones", &[Row("geometric-one-round"), Row("geometric-extra-pass")]),
        ("passes of continuous-time", &[Row("ct-no-response"), Row("ct-two-passes")]),
        ("the loop's success", &[Row("loop-always-fails"), Row("loop-always-succeeds")]),
    ],
};

const SUM_FAMILY: MistakeFamily = MistakeFamily {
    columns: &["center", "momentum", "angular", "inertia"],
    rows: &[
        (
            "unweighted",
            &[
                Row("failsafe-center-unweighted"),
                Row("failsafe-momentum-unweighted"),
                Row("failsafe-angular-unweighted"),
                Row("failsafe-inertia-unweighted"),
            ],
        ),
        (
            "at the end",
            &[
                Row("failsafe-center-at-end"),
                No("a motion has no end"),
                No("the angular momentum is the same up to round-off, as in the variant momentum-from-end"),
                Row("failsafe-inertia-at-end"),
            ],
        ),
        (
            "of velocities",
            &[
                No("positions are already available"),
                Row("failsafe-momentum-velocity"),
                Row("failsafe-angular-velocity"),
                No("the moment of inertia uses no motion"),
            ],
        ),
        (
            "about the origin",
            &[
                No("the point is the center itself"),
                No("the linear momentum is not about a point"),
                Row("failsafe-about-origin"),
                Row("failsafe-inertia-about-origin"),
            ],
        ),
        (
            "as an integer",
            &[
                No("a vector has no integer type"),
                No("a vector has no integer type"),
                Row("failsafe-angular-integer"),
                Row("failsafe-inertia-integer"),
            ],
        ),
        (
            "left out",
            &[
                Row("failsafe-no-center"),
                Row("failsafe-no-translation"),
                Row("failsafe-no-rotation"),
                Row("failsafe-no-inertia"),
            ],
        ),
    ],
};

const FAMILIES: [&MistakeFamily; 7] =
    [&PAIR_FAMILY, &END_FAMILY, &ALPHA_FAMILY, &PLACE_FAMILY, &QUANTITY_FAMILY, &ROUND_FAMILY, &SUM_FAMILY];

/// The rows that exist for only one kind of pair. Each entry is a prefix of their ids, and the reason.
const SINGLE_KIND_PREFIXES: &[(&str, &str)] = &[
    ("pe-quartic-", "it concerns one product of the quartic"),
    ("pe-cubic-", "it concerns one product of the quartic"),
    ("pe-no-cubic", "a coefficient of the quartic"),
    ("pe-square-", "it concerns one product of the quartic"),
    ("pe-linear-", "it concerns one product of the quartic"),
    ("pe-constant-", "it concerns one product of the quartic"),
    ("pp-contact-displacements-swapped", "only two particles have displacements that look alike"),
    ("pe-radius-unscaled", "only the quartic has a denominator"),
    ("pe-displacements-swapped", "only an edge has two ends"),
    ("pe-endpoints-swapped", "only an edge has two ends"),
    ("pe-approach-", "only the approach of edges is supplied"),
    ("pe-contact-alpha-", "only an edge has alpha"),
    ("pe-contact-other-end", "only an edge has alpha"),
    ("pe-contact-nearest-end", "only an edge has ends"),
    ("pe-radius-index", "it is the radius of another body; the first edge's radius is a separate row"),
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
            assert_eq!(cells.len(), family.columns.len(), "{name}: one cell for each of {:?}", family.columns);
        }
    }
    for (name, side, cell) in cells() {
        match cell {
            Row(id) => assert!(find(id).is_some_and(|row| row.kind == RowKind::Wrong), "{name}, {side}: no row {id}"),
            No(reason) => assert!(reason.contains(' '), "{name}, {side}: the reason for the missing row is empty"),
        }
    }
    for (name, cells) in PAIR_FAMILY.rows {
        for (cell, kind) in cells.iter().zip(PAIR_FAMILY.columns) {
            assert!(!matches!(cell, Row(id) if !id.starts_with(kind)), "{name} has a row of another kind");
        }
    }
}

/// A new row of one kind of pair must belong to a family, together with the rows of the other kinds.
#[test]
fn every_row_of_one_kind_of_pair_belongs_to_a_family() {
    let known: BTreeSet<&str> =
        cells().filter_map(|(.., cell)| if let Row(id) = cell { Some(*id) } else { None }).collect();
    let is_alone = |id: &str| SINGLE_KIND_PREFIXES.iter().any(|(beginning, _)| id.starts_with(beginning));
    let pair_rows = CATALOG.iter().filter(|row| row.kind == RowKind::Wrong && row.pair_kind().is_some());
    let gaps: Vec<&str> = pair_rows
        .filter(|row| row.area <= Area::ContactVector && !known.contains(row.id) && !is_alone(row.id))
        .map(|row| row.id)
        .collect();
    assert!(gaps.is_empty(), "which rows are like these for other kinds of pairs? {gaps:?}");
    let vain: Vec<&str> = SINGLE_KIND_PREFIXES
        .iter()
        .map(|(id, _)| *id)
        .filter(|id| !CATALOG.iter().any(|row| row.id.starts_with(id)))
        .collect();
    assert!(vain.is_empty(), "{vain:?} do not name a row");
}
