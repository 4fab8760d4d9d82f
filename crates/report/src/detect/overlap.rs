//! The report on a decision of simple collision handling: the overlap, the approach, and the result.
use super::{AnswerView, DETECT_SCHEMA, DetectView, FormatFn, PlaceView, render_motion, render_title};
use crate::{
    number::format_exact,
    style::{Style, TextStyle},
    view::{WrittenNumber, to_document},
};
use fosssim_judge::overlap::OverlapCheck;
use fosssim_model::sim::Pair;
use fosssim_num::{number_serde::WrittenNumbers, vector::Vec2};
use serde::Serialize;

/// An overlap decision, and where in the run of a scene it was made.
#[derive(Debug, Clone, Copy)]
pub struct Overlap<'a> {
    /// The reference's computation for the pair.
    pub study: &'a OverlapCheck,
    /// The name of the scene, as the user typed it.
    pub scene: &'a str,
    /// The name of the trace, as the user typed it; `None` for the reference's own run.
    pub trace: Option<&'a str>,
    /// The number of the step, from 1.
    pub step: u32,
    /// The pair that was examined.
    pub pair: Pair,
    /// Whether the trace logs a collision of the pair; `None` for the reference's own run.
    pub logged: Option<bool>,
}

impl Overlap<'_> {
    /// Renders the report as text.
    pub fn render_text(&self, style: Style) -> String {
        style.paint(TextStyle::Strong, &render_title(self.pair, self.step, self.trace, self.scene))
            + "\n"
            + &self.render_body(format_exact, style)
    }

    /// Renders the report without its title. `number` formats numbers.
    pub(crate) fn render_body(&self, number: FormatFn, style: Style) -> String {
        let study = self.study;
        let heading = |title: &str| format!("\n{}\n", style.paint(TextStyle::Strong, title));
        let vector = |v: Vec2| format!("({}, {})", number(v.x), number(v.y));
        let mut text = "  simple collisions use the positions and velocities at the end of the step\n".to_owned();
        text += &render_motion(&study.motion, number, style);
        text += &heading("At the end of the step");
        if let Some(alpha) = study.alpha {
            let meaning = "the nearest point of the edge, from 0 at its first end to 1 at its second";
            text += &format!("  alpha {}: {meaning}\n", number(alpha));
        }
        let (overlap, approach) = (self.overlaps(), self.approaches());
        text +=
            &format!("  normal {}: from the first object to the nearest point of the second\n", vector(study.normal));
        text += &format!(
            "  distance {}, sum of radii {}: they {}overlap\n",
            number(study.distance()),
            number(study.reach),
            negation_unless(overlap)
        );
        let [one, other] = study.velocities.map(vector);
        text += &format!(
            "  velocities {one} and {other}, their difference times the normal {}: they {}approach\n",
            number(study.approach()),
            negation_unless(approach)
        );
        text += &heading("Decision");
        let (look, decision) = match study.collides {
            true => (TextStyle::Notice, "they collide, and the response changes their velocities"),
            false => (TextStyle::Right, "no collision: objects collide if they overlap and approach each other"),
        };
        text += &format!("  {}\n", style.paint(look, decision));
        text += match study.is_certain {
            true => "  certain: round-off can't change this\n",
            false => "  borderline: a correct program with other round-off may decide otherwise\n",
        };
        if let Some(logged) = self.logged {
            let look = if logged == study.collides { TextStyle::Right } else { TextStyle::Wrong };
            let line = format!("the trace has {} collision of this pair", if logged { "a" } else { "no" });
            text += &format!("  {}\n", style.paint(look, &line));
        }
        text
    }

    /// Renders the report as one JSON object, indented, with a line feed at its end.
    pub fn json(&self) -> String {
        let &Self { study, scene, trace, step, pair, .. } = self;
        let time = WrittenNumber(if study.collides { 0.0 } else { f64::INFINITY });
        let normal = study.collides.then(|| study.normal.to_form());
        to_document(&DetectView {
            schema: DETECT_SCHEMA,
            place: Some(PlaceView { scene, trace, step, pair, pass: None, passes: 1, logged: None }),
            kind: study.motion.kind(),
            motion: (&study.motion).into(),
            polynomials: Vec::new(),
            answer: AnswerView { positive: Vec::new(), collides: study.collides, time, normal },
            certain: study.is_certain.then_some(study.collides),
            right_approach: None,
            overlap: Some(OverlapView {
                alpha: study.alpha.map(WrittenNumber),
                normal: study.normal.to_form(),
                distance: WrittenNumber(study.distance()),
                radii_together: WrittenNumber(study.reach),
                overlaps: self.overlaps(),
                velocities: study.velocities.map(|velocity| velocity.to_form()),
                approach: WrittenNumber(study.approach()),
                approaches: self.approaches(),
                logged: self.logged,
            }),
        })
    }

    fn overlaps(&self) -> bool {
        self.study.distance() < self.study.reach
    }

    fn approaches(&self) -> bool {
        self.study.approach() > 0.0
    }
}

const fn negation_unless(is_true: bool) -> &'static str {
    if is_true { "" } else { "do not " }
}

/// A pair at the end of a step, as simple collision handling checks it.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(super) struct OverlapView {
    /// The place of the nearest point on the edge, from 0 at its first endpoint to 1 at its second; null if there is no
    /// edge.
    alpha: Option<WrittenNumber>,
    /// The vector from the first object to the nearest point of the second, not normalized.
    normal: [WrittenNumber; 2],
    /// The length of the normal.
    distance: WrittenNumber,
    /// The sum of the radii.
    radii_together: WrittenNumber,
    /// Whether the distance is smaller than the sum of the radii.
    overlaps: bool,
    /// The velocity of the first object, and that of the nearest point of the second object.
    velocities: [[WrittenNumber; 2]; 2],
    /// The dot product of the velocities' difference and the normal.
    approach: WrittenNumber,
    /// Whether `approach` is positive, so that the objects come closer.
    approaches: bool,
    /// Whether the trace logs a collision of the pair; null for the reference's own run.
    logged: Option<bool>,
}
