//! The report on one detection call, as text and as JSON (`schemas/detect.schema.json`). It contains the polynomials,
//! their zeros, the intervals and the decision.
mod overlap;

pub use overlap::Overlap;

use super::{
    number::{format_exact, format_rounded_or},
    style::{Style, TextStyle},
    table::{Align, Cell, Table},
    view::{WrittenNumber, to_document, to_written_numbers, view},
};
use fosssim_evidence::CallLog;
use fosssim_findings::Role;
use fosssim_judge::{
    PairText, PassText, find_differing_powers, find_factor,
    study::{PairDecision, StudiedPolynomial, Study},
};
use fosssim_model::sim::{Decision, Pair, PairKind, PairMotion, Pass, PointMotion};
use fosssim_num::{interval::Interval, number_serde::WrittenNumbers, polynomial::Polynomial};
use serde::Serialize;

/// The version of the JSON document's schema.
pub const DETECT_SCHEMA: u32 = 1;

/// The place in a scene's run at which a pair was examined.
#[derive(Debug, Clone, Copy)]
pub struct CallPlace<'a> {
    /// The name of the scene, as the user typed it.
    pub scene: &'a str,
    /// The name of the trace, as the user typed it; `None` for the reference's own run.
    pub trace: Option<&'a str>,
    /// The number of the step, from 1.
    pub step: u32,
    /// The pair that is examined.
    pub pair: Pair,
    /// The detection pass; `None` if the scene has no continuous-time detection.
    pub pass: Option<Pass>,
    /// The number of passes that the reference makes in this step.
    pub passes: usize,
    /// The trace's log of the detection call.
    pub logged: &'a CallLog,
}

/// A function that formats numbers, either with all digits or as in a calculation by hand.
pub(crate) type FormatFn = fn(f64) -> String;

/// A detection call, as the report shows it.
#[derive(Debug, Clone, Copy)]
pub struct DetectReport<'a> {
    /// The reference's computation for the pair.
    pub study: &'a Study,
    /// The place in a scene's run at which the pair was examined; `None` if the user typed the numbers.
    pub place: Option<CallPlace<'a>>,
}

impl DetectReport<'_> {
    /// Returns one line that says what the report is about.
    pub fn title(&self) -> String {
        let Some(place) = &self.place else {
            return match self.study.motion {
                PairMotion::Particles { .. } => "Two particles".to_owned(),
                PairMotion::Edge { .. } => "A particle and an edge".to_owned(),
                PairMotion::HalfPlane { .. } => "A particle and a half-plane".to_owned(),
            };
        };
        render_title(place.pair, place.step, place.trace, place.scene)
    }

    /// Returns the decision as a sentence. `number` formats the numbers in it.
    pub fn describe_decision(&self, number: impl Fn(f64) -> String) -> String {
        let answer = &self.study.answer;
        let time = number(answer.decision.time());
        match answer.decision {
            Decision::Hit { normal, .. } => {
                let (x, y) = (number(normal.x), number(normal.y));
                format!("they collide at time {time} with normal ({x}, {y})")
            }
            Decision::Miss { .. } if answer.decision.time() <= 1.0 => {
                format!("no collision: all polynomials are positive from time {time}, but the normal is zero there")
            }
            Decision::Miss { .. } if answer.decision.time().is_finite() => {
                format!(
                    "no collision in this step: all polynomials are positive from time {time} on, which is after the \
                        step"
                )
            }
            Decision::Miss { .. } => "no collision: at no time from 0 on are all polynomials positive".to_owned(),
        }
    }

    /// Renders the report as text.
    pub fn render_text(&self, style: Style) -> String {
        let study = self.study;
        let mut text = style.paint(TextStyle::Strong, &self.title()) + "\n";
        if let Some(place) = &self.place {
            text += &match place.pass {
                Some(pass) => format!("  pass {} of {}: {}\n", pass.index + 1, place.passes, PassText(pass)),
                None => "  this scene has no continuous-time detection; the motion covers the whole step\n".to_owned(),
            };
        }
        text + &render_motion(&study.motion, format_exact, style) + &self.computation(format_exact, style)
    }

    /// Renders the polynomials of the reference and of the trace, and the decision. `number` formats numbers.
    pub(crate) fn computation(&self, number: FormatFn, style: Style) -> String {
        let study = self.study;
        let mut text = format!(
            "\n{}\n",
            style.paint(TextStyle::Strong, "Polynomials in t, the fraction of the step; each must be positive")
        );
        for curve in &study.curves {
            text += &describe_polynomial(&curve.role.to_string(), curve, number, style);
        }
        if let Some(right) = &study.right_approach {
            text += &describe_polynomial(
                "approach without the slip in t^3 of the course's formula",
                &right.curve,
                number,
                style,
            );
        }
        if let Some(place) = self.place.filter(|place| place.trace.is_some() && place.pass.is_some()) {
            text += &format!("\n{}\n", style.paint(TextStyle::Strong, "What the trace logged"));
            match place.logged {
                CallLog::Polynomials(logged) => {
                    for (number, (curve, own)) in study.curves.iter().zip(logged).enumerate() {
                        let expected = curve.logged.coefficients();
                        // The lists may have different lengths, because the course's library drops small leading
                        // coefficients.
                        text += &if expected.len() != own.len() && study.is_right(number, own) {
                            let mark = "right except for a factor and small leading coefficients, which are allowed";
                            format!(
                                "  {}: {}\n    {}\n",
                                curve.role,
                                style.paint(TextStyle::Right, mark),
                                format_polynomial(own, format_exact)
                            )
                        } else {
                            describe_logged_polynomial(&curve.role.to_string(), expected, own, style)
                        };
                    }
                }
                CallLog::Nothing => {
                    let nothing = "nothing is logged for this pair in this pass";
                    text += &format!("  {}\n", style.paint(TextStyle::Wrong, nothing))
                }
                CallLog::Unknown => {
                    text +=
                        "  the trace logged a different number of polynomials, so this pair's cannot be identified\n";
                }
            }
        }
        text += &format!("\n{}\n", style.paint(TextStyle::Strong, "Decision"));
        text += &format!("  all positive: {}\n", format_intervals(&study.answer.positive_intervals, number));
        let look = if study.answer.decision.collides() { TextStyle::Notice } else { TextStyle::Right };
        text += &format!("  {}\n", style.paint(look, &self.describe_decision(|time| format_rounded_or(time, number))));
        text += match study.certain_decision {
            Some(certain) if certain == study.answer.decision.collides() => "  certain: round-off can't change this\n",
            Some(_) => "  the true answer is the other one: the root finder is misled by rounding\n",
            None => "  borderline: a correct program with other round-off may decide otherwise\n",
        };
        if let Some(right) = &study.right_approach {
            text += &compare_approach(&study.answer, &right.answer, number);
        }
        text
    }

    /// Renders the report as one JSON object, indented, with a line feed at its end.
    pub fn json(&self) -> String {
        let study = self.study;
        let view = DetectView {
            schema: DETECT_SCHEMA,
            place: self.place.as_ref().map(PlaceView::from),
            kind: study.motion.kind(),
            motion: (&study.motion).into(),
            polynomials: study.curves.iter().map(CurveView::from).collect(),
            answer: (&study.answer).into(),
            certain: study.certain_decision,
            right_approach: study
                .right_approach
                .as_ref()
                .map(|right| RightApproachView { polynomial: (&right.curve).into(), answer: (&right.answer).into() }),
            overlap: None,
        };
        to_document(&view)
    }
}

fn render_title(pair: Pair, step: u32, trace: Option<&str>, scene: &str) -> String {
    let run = trace.map_or_else(|| "the reference's run".to_owned(), |trace| format!("the trace {trace}"));
    let title = PairText(pair).to_string();
    let (first, rest) = title.split_at(1);
    format!("{}{rest} in step {step} of {run}, scene {scene}", first.to_uppercase())
}

/// Describes a polynomial of the trace. If it differs from the right one by more than a factor, both are listed power
/// by power.
fn describe_logged_polynomial(role: &str, expected: &[f64], own: &[f64], style: Style) -> String {
    if own.is_empty() && !expected.is_empty() {
        return format!("  {role}: {}\n", style.paint(TextStyle::Wrong, "missing"));
    }
    let factor = find_factor(expected, own);
    let wrong = find_differing_powers(expected, own, factor);
    let same = expected == own;
    let (look, mark) = match wrong.is_empty() {
        true if same => (TextStyle::Right, "the same".to_owned()),
        true if factor == 1.0 => (TextStyle::Right, "the same except for rounding".to_owned()),
        true => (TextStyle::Right, format!("the same except for the factor {}, which is right", format_exact(factor))),
        false => (TextStyle::Wrong, "differs".to_owned()),
    };
    let mut text = format!("  {role}: {}\n    {}\n", style.paint(look, &mark), format_polynomial(own, format_exact));
    if wrong.is_empty() {
        return text;
    }
    let mut table = Table::new([Align::Left, Align::Right, Align::Right, Align::Left]);
    table.add_heading(["", "expected", "logged", ""]);
    for power in (0..expected.len().max(own.len())).rev() {
        let at = |list: &[f64], factor: f64| {
            list.len()
                .checked_sub(power + 1)
                .map_or_else(|| "none".to_owned(), |index| format_exact(list[index] * factor))
        };
        let mark = if wrong.contains(&power) { Cell::with_style(TextStyle::Wrong, "<- differs") } else { "".into() };
        table.add_row([format!("t^{power}").into(), at(expected, factor).into(), at(own, 1.0).into(), mark]);
    }
    text.extend(table.render(style).lines().map(|line| format!("  {line}\n")));
    if factor != 1.0 {
        text += &format!(
            "    expected values are multiplied by the trace's factor {}; any positive factor is right\n",
            format_exact(factor)
        );
    }
    text
}

/// Describes what the mathematically right approach polynomial would change.
fn compare_approach(course: &PairDecision, right: &PairDecision, number: FormatFn) -> String {
    let result = match (course.decision, right.decision) {
        (Decision::Hit { time, .. }, Decision::Hit { time: other, .. }) if time == other => {
            "the same collision at the same time".to_owned()
        }
        (_, Decision::Hit { time, .. }) => format!("a collision at time {}", format_rounded_or(time, number)),
        (Decision::Miss { .. }, Decision::Miss { .. }) => "no collision either".to_owned(),
        (Decision::Hit { .. }, Decision::Miss { .. }) => "no collision".to_owned(),
    };
    format!("  with the mathematically right approach polynomial: {result}\n")
}

/// Describes the objects of a pair and their motions.
pub(crate) fn render_motion(motion: &PairMotion, number: FormatFn, style: Style) -> String {
    let vector = |x: f64, y: f64| format!("({}, {})", number(x), number(y));
    let mut table = Table::new([Align::Left, Align::Left, Align::Left, Align::Left]);
    table.add_heading(["", "start", "displacement", "radius"]);
    let mut moving = |name: &str, point: PointMotion, radius: Option<f64>| {
        let (start, shift) = (vector(point.start.x, point.start.y), vector(point.shift.x, point.shift.y));
        let radius = radius.map(number).unwrap_or_default();
        table.add_row([name.into(), start.into(), shift.into(), Cell::from(radius)]);
    };
    match *motion {
        PairMotion::Particles { centers: [one, two], radii } => {
            moving("x1, first particle", one, Some(radii[0]));
            moving("x2, second particle", two, Some(radii[1]));
        }
        PairMotion::Edge { center, ends, radii } => {
            moving("x1, particle", center, Some(radii[0]));
            moving("x2, first end", ends[0], Some(radii[1]));
            moving("x3, second end", ends[1], None);
        }
        PairMotion::HalfPlane { center, radius, point, normal } => {
            moving("x, particle", center, Some(radius));
            let (point, normal) = (vector(point.x, point.y), vector(normal.x, normal.y));
            table.add_row(["p, half-plane".into(), point.into(), format!("n = {normal}").into(), "".into()]);
        }
    }
    table.render(style)
}

/// Describes a polynomial, its zeros, and the intervals in which it is positive.
fn describe_polynomial(name: &str, curve: &StudiedPolynomial, number: FormatFn, style: Style) -> String {
    let mut text = format!("  {name}\n    {}\n", format_polynomial(curve.logged.coefficients(), number));
    let all = curve.untrimmed.coefficients();
    let dropped = &all[..all.len() - curve.logged.coefficients().len()];
    if dropped.iter().any(|&coefficient| coefficient != 0.0) {
        let line =
            format!("logged without leading coefficients below 1e-12; with them: {}", format_polynomial(all, number));
        text += &format!("    {}\n", style.paint(TextStyle::Faint, &line));
    }
    let real = curve.real_zeros();
    let complex_count = curve.zeros.len() - real.len();
    let mut zeros = real.iter().map(|&zero| format_rounded_or(zero, number)).collect::<Vec<_>>().join(", ");
    if curve.logged.coefficients().is_empty() {
        zeros = "every time".to_owned();
    } else if zeros.is_empty() {
        zeros = "none real".to_owned();
    }
    if complex_count > 0 {
        zeros += &format!(" ({complex_count} complex)");
    }
    text += &format!("    zeros: {zeros}\n    positive: {}\n", format_intervals(&curve.positive_intervals, number));
    text
}

/// Formats intervals as text, such as `nowhere`, `(-inf, 0.25) and (0.5, 1.25)`, or `at 0.5 (intervals touch)`.
fn format_intervals(list: &[Interval], number: FormatFn) -> String {
    if list.is_empty() {
        return "nowhere".to_owned();
    }
    let describe = |interval: &Interval| match interval {
        Interval { lo, hi } if lo == hi => format!("at {} (intervals touch)", format_rounded_or(*lo, number)),
        Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY } => "always".to_owned(),
        Interval { lo, hi } => format!("({}, {})", format_rounded_or(*lo, number), format_rounded_or(*hi, number)),
    };
    list.iter().map(describe).collect::<Vec<_>>().join(" and ")
}

/// Formats a polynomial as text, such as `-0.25 t^2 + t - 0.1875`. An empty list is the zero polynomial. Zero
/// coefficients are left out, except for a leading one, which a log should not contain.
pub(crate) fn format_polynomial(coefficients: &[f64], number: FormatFn) -> String {
    if coefficients.is_empty() {
        return "0 (no coefficient)".to_owned();
    }
    let mut text = String::new();
    for (index, &value) in coefficients.iter().enumerate().filter(|(index, value)| *index == 0 || **value != 0.0) {
        text += match (index, value.is_sign_negative()) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => " + ",
            (_, true) => " - ",
        };
        let letter = match coefficients.len() - 1 - index {
            0 => String::new(),
            1 => "t".to_owned(),
            power => format!("t^{power}"),
        };
        let factor = if value.abs() == 1.0 && !letter.is_empty() { String::new() } else { number(value.abs()) };
        text += &[factor, letter].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ");
    }
    text
}

/// One detection call: the reference's computation for a pair, which starts from the pair's motion within a step. Times
/// are fractions of the step.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(crate) struct DetectView<'a> {
    /// The version of the schema.
    #[schemars(extend("const" = DETECT_SCHEMA))]
    schema: u32,
    /// The place in a scene's run at which the pair was examined; null if the user typed the numbers.
    place: Option<PlaceView<'a>>,
    /// The kind of the pair.
    kind: PairKind,
    /// The motion of the pair's bodies within the step.
    motion: MotionView,
    /// The polynomials, in the order in which a trace logs them. The list is empty for scenes with simple collision
    /// handling.
    polynomials: Vec<CurveView>,
    /// The decision by the reference.
    answer: AnswerView,
    /// Whether every correct program decides that the pair collides; null if round-off may change the decision.
    certain: Option<bool>,
    /// The mathematically right approach polynomial of a particle and an edge, and the decision with it; null if the
    /// course's polynomial is the same.
    right_approach: Option<RightApproachView>,
    /// The overlap and the approach at the end of the step, for scenes with simple collision handling; otherwise null.
    overlap: Option<overlap::OverlapView>,
}

view! {
    /// The place in a scene's run at which a pair was examined.
    #[schemars(deny_unknown_fields)]
    struct PlaceView<'a> from place: CallPlace<'a> {
        /// The name of the scene, as the user typed it.
        scene: &'a str = place.scene,
        /// The name of the trace, as the user typed it; null for the reference's own run.
        trace: Option<&'a str> = place.trace,
        /// The number of the step, from 1.
        step: u32 = place.step,
        /// The pair that was examined.
        pair: Pair = place.pair,
        /// The number of the detection pass in the step; null if the scene has no continuous-time detection.
        pass: Option<Pass> = place.pass,
        /// The number of passes that the reference makes in this step.
        passes: usize = place.passes,
        /// The lists that the trace logs for the detection call, in the order of `polynomials`. A missing list is empty
        /// here, and if all are missing, there are no lists. Null for the reference's own run, and if the trace logs
        /// another number of polynomials in the pass, because then its lists can't be assigned to calls.
        logged: Option<Vec<Vec<WrittenNumber>>> = match place.logged {
            CallLog::Polynomials(logged) => Some(logged.iter().map(|list| to_written_numbers(list)).collect()),
            CallLog::Nothing if place.trace.is_some() && place.pass.is_some() => Some(Vec::new()),
            CallLog::Nothing | CallLog::Unknown => None,
        },
    }
}

/// The motion of a pair within a step.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct MotionView {
    /// The moving points of the pair. For two particles, these are both centers; for a particle and an edge, the
    /// particle's center and the edge's endpoints; for a particle and a half-plane, the particle's center.
    points: Vec<PointView>,
    /// The radii of the bodies, in their order. A half-plane has no radius.
    radii: Vec<WrittenNumber>,
    /// The half-plane; null if the pair has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    half_plane: Option<HalfPlaneView>,
}

/// A point that moves along a straight line.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct PointView {
    /// The position of the point at the start of the step.
    start: [WrittenNumber; 2],
    /// The displacement of the point within the step.
    displacement: [WrittenNumber; 2],
}

/// A half-plane of the scene.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct HalfPlaneView {
    /// A point on the boundary of the half-plane.
    point: [WrittenNumber; 2],
    /// The normal vector of the half-plane.
    normal: [WrittenNumber; 2],
}

view! {
    /// A polynomial, its zeros, and the intervals in which it is positive.
    #[schemars(deny_unknown_fields)]
    struct CurveView from curve: StudiedPolynomial {
        /// The condition that holds while the polynomial is positive.
        role: Role = curve.role,
        /// The coefficients that are logged and passed to the root finder, highest power first. Leading coefficients
        /// below 1e-12 are left out.
        coefficients: Polynomial = curve.logged,
        /// All coefficients, highest power first, including small leading ones.
        untrimmed: Polynomial = curve.untrimmed,
        /// The zeros, each as its real and its imaginary part, in the order in which the reference's root finder
        /// returns them.
        zeros: Vec<[WrittenNumber; 2]> =
            curve.zeros.iter().map(|&(real, imaginary)| [WrittenNumber(real), WrittenNumber(imaginary)]).collect(),
        /// The time intervals in which the polynomial is positive, sorted and disjoint. They are not limited to the
        /// step. An interval may be a single time.
        positive: Vec<[WrittenNumber; 2]> = to_pairs(&curve.positive_intervals),
    }
}

view! {
    /// The decision that follows from a pair's polynomials.
    #[schemars(deny_unknown_fields)]
    struct AnswerView from answer: PairDecision {
        /// The time intervals in which all polynomials are positive together, sorted and disjoint.
        positive: Vec<[WrittenNumber; 2]> = to_pairs(&answer.positive_intervals),
        /// Whether the pair collides in the step.
        collides: bool = answer.decision.collides(),
        /// The earliest time from which all polynomials are positive; inf if there is no such time.
        time: WrittenNumber = WrittenNumber(answer.decision.time()),
        /// The vector from the first object to the second, not normalized; null if the pair does not collide.
        normal: Option<[WrittenNumber; 2]> = match answer.decision {
            Decision::Hit { normal, .. } => Some(normal.to_form()),
            Decision::Miss { .. } => None,
        },
    }
}

/// The mathematically right approach polynomial, and the decision with it.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct RightApproachView {
    /// The mathematically right approach polynomial.
    polynomial: CurveView,
    /// The decision if the right approach polynomial is used.
    answer: AnswerView,
}

fn to_pairs(list: &[Interval]) -> Vec<[WrittenNumber; 2]> {
    list.iter().map(|interval| [interval.lo, interval.hi].to_form()).collect()
}

impl From<&PairMotion> for MotionView {
    fn from(motion: &PairMotion) -> Self {
        let (moving, radii, half_plane) = match *motion {
            PairMotion::Particles { centers, radii } => (centers.to_vec(), radii.to_vec(), None),
            PairMotion::Edge { center, ends, radii } => (vec![center, ends[0], ends[1]], radii.to_vec(), None),
            PairMotion::HalfPlane { center, radius, point, normal } => {
                let half_plane = HalfPlaneView { point: point.to_form(), normal: normal.to_form() };
                (vec![center], vec![radius], Some(half_plane))
            }
        };
        let point =
            |point: PointMotion| PointView { start: point.start.to_form(), displacement: point.shift.to_form() };
        Self { points: moving.into_iter().map(point).collect(), radii: to_written_numbers(&radii), half_plane }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_written_as_in_books() {
        assert_eq!(format_polynomial(&[-0.25, 0.5, -0.1875], format_exact), "-0.25 t^2 + 0.5 t - 0.1875");
        assert_eq!(format_polynomial(&[1.0, 0.0, -1.0, 0.0], format_exact), "t^3 - t");
        assert_eq!(format_polynomial(&[-1.0, 1.0], format_exact), "-t + 1");
        assert_eq!(format_polynomial(&[0.0, 2.0, 0.0], format_exact), "0 t^2 + 2 t");
        assert_eq!(format_polynomial(&[f64::NAN, -0.0], format_exact), "nan t");
        assert_eq!(format_polynomial(&[], format_exact), "0 (no coefficient)");
    }

    #[test]
    fn sets_of_times_are_written_as_in_books() {
        let set = |lo, hi| Interval { lo, hi };
        assert_eq!(format_intervals(&[], format_exact), "nowhere");
        assert_eq!(format_intervals(&[Interval::ALL_TIMES], format_exact), "always");
        assert_eq!(
            format_intervals(&[set(f64::NEG_INFINITY, 0.25), set(0.5, 0.5)], format_exact),
            "(-inf, 0.25) and at 0.5 (intervals touch)"
        );
    }
}
