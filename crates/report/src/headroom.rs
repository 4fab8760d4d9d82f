//! How much room the original's rules leave in scenes: a table for people, JSON for programs
//! (`schemas/headroom.schema.json`).
use super::{
    number::{count, general},
    style::{Look, Style},
    table::{Align, Cell, Table},
    view::{FindingView, Number, document},
};
use fosssim_findings::{
    Book,
    headroom::{FAIR_DOUBLINGS, FAIR_ROOM, FirstFailure, Headroom, MOST_DOUBLINGS},
};
use serde::Serialize;

/// The version of the JSON's shape.
const SCHEMA: u32 = 1;

/// A scene's name and its headroom.
pub type Measured = (String, Headroom);

const LEGEND: &str = "
Room: so many units in the last place of the largest coefficient are within the original's bound of 1e-10.
Fails: the reference's own trace is judged while lengths are doubled again and again. Scaled are positions,
velocities, radii, points of half-planes, rest lengths, thicknesses, accelerations, constant forces, G (by
the cube), vortex strength and coupling (by the square); powers of two are exact, so the motion stays.
";

/// The table, and what follows from it.
#[must_use]
pub fn text(measured: &[Measured], style: Style) -> String {
    let mut text = style.paint(Look::Strong, "How much room the original's rules leave") + "\n";
    let mut table = Table::new([Align::Left, Align::Right, Align::Right, Align::Right]);
    table.heading(["scene", "largest coefficient", "room", "fails its own trace at"]);
    for (name, headroom) in measured {
        let look = if headroom.is_fair() { Look::Good } else { Look::Bad };
        let fails = match (headroom.largest, headroom.failure) {
            (None, _) => "never".to_owned(),
            (_, None) => format!("> {} times", factor(MOST_DOUBLINGS)),
            (_, Some(FirstFailure { doublings: 0, .. })) => "its own size".to_owned(),
            (_, Some(failure)) => format!("{} times", factor(failure.doublings)),
        };
        let largest = headroom.largest.map_or_else(|| "none".to_owned(), general);
        let room = if headroom.largest.is_some() { rounded(headroom.room()) } else { String::new() };
        table.row([name.as_str().into(), largest.into(), Cell::looking(look, room), Cell::looking(look, fails)]);
    }
    text += &table.render(style);
    text += LEGEND;
    let unfair: Vec<&str> =
        measured.iter().filter(|(_, headroom)| !headroom.is_fair()).map(|(name, _)| name.as_str()).collect();
    if unfair.is_empty() {
        return text + "\nThe original's rules can grade all of them at this size.\n";
    }
    let heading = format!("The original's rules can't grade {} of {} scenes fairly", unfair.len(), measured.len());
    text += &format!("\n{}:\n", style.paint(Look::Bad, &heading));
    text += &format!(
        "their room is less than {FAIR_ROOM}, or doubled lengths fail; correct programs that round otherwise are off by \
         more.\n"
    );
    for name in unfair {
        text += &format!("  {name}\n");
    }
    text
}

fn factor(doublings: u32) -> String {
    count(1 << doublings)
}

/// A room in few digits.
fn rounded(room: f64) -> String {
    if room < 100.0 { format!("{room:.1}") } else { general(room.round()) }
}

/// One JSON object, indented, with a line feed at its end.
#[must_use]
pub fn json(measured: &[Measured]) -> String {
    document(&HeadroomView {
        schema: SCHEMA,
        largest_factor: 1 << MOST_DOUBLINGS,
        fair_factor: 1 << FAIR_DOUBLINGS,
        fair_room: FAIR_ROOM,
        scenes: measured.iter().map(SceneView::from).collect(),
    })
}

/// The room that the original's rules leave in scenes: parity judges the reference's own traces while all lengths are
/// doubled again and again.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(crate) struct HeadroomView {
    /// The version of this shape.
    #[schemars(extend("const" = SCHEMA))]
    schema: u32,
    /// Lengths were multiplied by powers of two up to this.
    largest_factor: u64,
    /// A scene that fails at this factor or a smaller one can't be graded fairly by the original's rules.
    fair_factor: u64,
    /// A scene with less room can't be graded fairly by the original's rules.
    fair_room: f64,
    /// The scenes.
    scenes: Vec<SceneView>,
}

/// The room in a scene.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct SceneView {
    /// The scene as typed.
    scene: String,
    /// The largest modulus of a coefficient at the scene's own size; null where its traces hold no polynomials, so that
    /// nothing can fail.
    largest_coefficient: Option<Number>,
    /// How many units in the last place of it the original's bound holds.
    room: Option<Number>,
    /// Whether the original's rules can grade it at its own size.
    fair: bool,
    /// The first factor of lengths at which the original's rules fail the reference's own trace; null where none up to
    /// the largest does.
    fails_at_factor: Option<u64>,
    /// The number of findings at that factor.
    findings: u64,
    /// The first one; null where only residuals fail or nothing does.
    first: Option<FindingView>,
}

impl From<&Measured> for SceneView {
    fn from((name, headroom): &Measured) -> Self {
        let failure = headroom.failure.as_ref();
        Self {
            scene: name.clone(),
            largest_coefficient: headroom.largest.map(Number),
            room: headroom.largest.map(|_| Number(headroom.room())),
            fair: headroom.is_fair(),
            fails_at_factor: failure.map(|failure| 1 << failure.doublings),
            findings: failure.map_or(0, |failure| failure.findings),
            first: failure
                .and_then(|FirstFailure { first, .. }| first.as_ref())
                .map(|first| FindingView::by(Book::Parity, first)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured() -> Vec<Measured> {
        let failure = |doublings| Some(FirstFailure { doublings, findings: 12, first: None });
        vec![
            ("a/none".to_owned(), Headroom { largest: None, failure: None }),
            ("a/roomy".to_owned(), Headroom { largest: Some(1.5), failure: None }),
            ("a/tight".to_owned(), Headroom { largest: Some(1e3), failure: failure(1) }),
            ("a/fine".to_owned(), Headroom { largest: Some(1e5), failure: failure(3) }),
            ("a/large".to_owned(), Headroom { largest: Some(3e5), failure: failure(2) }),
            ("a/over".to_owned(), Headroom { largest: Some(1e6), failure: failure(0) }),
        ]
    }

    #[test]
    fn the_table_names_the_scenes_that_can_not_be_graded_fairly() {
        insta::assert_snapshot!("headroom_text", text(&measured(), Style::Plain));
    }

    #[test]
    fn json_says_at_which_factor() {
        let json: serde_json::Value = serde_json::from_str(&json(&measured())).expect("JSON");
        let factors: Vec<_> = (0..4).map(|scene| json["scenes"][scene]["fails_at_factor"].as_u64()).collect();
        assert_eq!(factors, [None, None, Some(2), Some(8)]);
        let fair: Vec<_> = (0..6).map(|scene| json["scenes"][scene]["fair"].as_bool()).collect();
        assert_eq!(fair, [true, true, false, true, false, false].map(Some), "too tight, too little room, neither");
    }
}
