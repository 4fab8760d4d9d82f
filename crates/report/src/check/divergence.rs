//! Shows the first difference, with the expected and the actual values side by side.
use super::super::{
    number::{format_exact, format_g},
    style::{Style, TextStyle},
    table::{Align, Cell, Table},
};
use fosssim_judge::{Finding, FindingDetail, PowerText, RescaledCoefficient, find_differing_powers, find_factor};
use fosssim_model::trace::LoggedImpulse;

/// Renders the block about one finding, with a heading and without advice.
pub(super) fn render(finding: &Finding, steps: u32, style: Style) -> String {
    format!(
        "{}\n{}",
        style.paint(TextStyle::Strong, &format!("First difference: {}", describe_place(finding, steps))),
        render_finding(finding, style)
    )
}

/// Describes where a finding is in the trace, for a heading.
pub(crate) fn describe_place(finding: &Finding, steps: u32) -> String {
    let record = if finding.frame == 2 * u64::from(finding.step) { " (end record)" } else { "" };
    match finding.step {
        0 => "the first record".to_owned(),
        step => format!("step {step} of {steps}, frame {}{record}", finding.frame),
    }
}

/// Renders one finding as a sentence, with its values side by side.
pub(super) fn render_finding(finding: &Finding, style: Style) -> String {
    format!("  {}\n{}", finding.describe(), side_by_side(&finding.detail).render_text(style))
}

/// One of the values that a finding compares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Value {
    /// No value, because this side has none.
    Nothing,
    /// A number of occurrences.
    Count(usize),
    /// A floating-point number.
    Number(f64),
}

impl Value {
    /// Returns the value as text, with all digits.
    pub(crate) fn exact(self) -> String {
        match self {
            Self::Nothing => "none".to_owned(),
            Self::Count(count) => count.to_string(),
            Self::Number(number) => format_exact(number),
        }
    }
}

/// Two values that a finding compares, and their name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    /// The common name of both values.
    pub(crate) name: &'static str,
    /// The reference's value.
    pub(crate) expected: Value,
    /// The trace's value.
    pub(crate) actual: Value,
    /// Whether the values differ.
    pub(crate) differs: bool,
}

/// The values of a finding side by side, and the remarks above and below them.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ComparedValues {
    /// Lines above the table. They give the position in the trace, for readers who inspect its bytes.
    remarks_before: Vec<String>,
    pub(crate) rows: Vec<Row>,
    pub(crate) remarks_after: Vec<String>,
    /// A line about the values that the original compares, if they differ from those in the table.
    original: Option<String>,
}

impl ComparedValues {
    fn render_text(&self, style: Style) -> String {
        let lines = |lines: &[String]| lines.iter().map(|line| format!("  {line}\n")).collect::<String>();
        let mut table = Table::new([Align::Left, Align::Right, Align::Right, Align::Left]);
        if !self.rows.is_empty() {
            table.add_heading(["", "expected", "actual", ""]);
        }
        for Row { name, expected, actual, differs } in &self.rows {
            let mark = |text: String| if *differs { Cell::with_style(TextStyle::Wrong, text) } else { text.into() };
            let mark_text = if *differs { "<- differs" } else { "" };
            table.add_row([(*name).into(), expected.exact().into(), mark(actual.exact()), mark(mark_text.to_owned())]);
        }
        lines(&self.remarks_before)
            + &table.render(style)
            + &lines(&self.remarks_after)
            + &lines(self.original.as_slice())
    }
}

/// Returns the values that a finding compares.
pub(crate) fn side_by_side(detail: &FindingDetail) -> ComparedValues {
    let rows = |rows: Vec<Row>| ComparedValues { rows, ..ComparedValues::default() };
    match detail {
        FindingDetail::MissedCollision { expected } => rows(compare_collisions(Some((*expected).into()), None)),
        FindingDetail::SuperfluousCollision { actual } | FindingDetail::RepeatedCollision { actual } => {
            rows(compare_collisions(None, Some(*actual)))
        }
        FindingDetail::WrongNormal { expected, actual, .. } | FindingDetail::ContactTime { expected, actual } => {
            rows(compare_collisions(Some((*expected).into()), Some(*actual)))
        }
        FindingDetail::PolynomialCount { expected, actual, per_pass } => ComparedValues {
            remarks_after: vec![format!("one pass over all pairs has {per_pass}")],
            ..rows(vec![count_row("polynomials", *expected, *actual)])
        },
        FindingDetail::PolynomialDegree { place, expected, actual_size, actual } => {
            let more = actual_size.saturating_sub(actual.coefficients().len());
            let mut sides = polynomials(place, expected.coefficients(), actual.coefficients());
            if more > 0 {
                sides.remarks_after.push(format!("{more} further coefficients of the trace are not shown"));
            }
            sides
        }
        FindingDetail::VanishingPolynomial { place, expected, actual } => {
            polynomials(place, expected.coefficients(), actual.coefficients())
        }
        FindingDetail::Coefficient {
            place, power, expected, rescaled, expected_polynomial, actual_polynomial, ..
        } => {
            let (reference, trace) = (expected_polynomial.coefficients(), actual_polynomial.coefficients());
            let own = reference.iter().rev().nth(*power).copied().unwrap_or(0.0);
            // The finding was judged with the same factor.
            let factor = if own == 0.0 { find_factor(reference, trace) } else { expected / own };
            let mut sides = compare_with_factor(place, reference, trace, factor, Some(*power));
            sides.original = rescaled.as_ref().map(|RescaledCoefficient { power, expected, actual, .. }| {
                let (power, actual, expected) = (PowerText(*power), format_exact(*actual), format_exact(*expected));
                format!("(after the original's rescaling: {power} {actual}, expected {expected})")
            });
            sides
        }
        FindingDetail::Position { expected, actual, .. } | FindingDetail::Velocity { expected, actual, .. } => {
            rows(vec![number_row("x", expected[0], actual[0]), number_row("y", expected[1], actual[1])])
        }
        FindingDetail::PassCount { expected, actual, .. } => rows(vec![count_row("passes", *expected, *actual)]),
        FindingDetail::PassPositions { place }
        | FindingDetail::TrimmedDecision { place, .. }
        | FindingDetail::TrimmedTime { place, .. }
        | FindingDetail::MixedForms { place } => ComparedValues {
            remarks_before: vec![format!("polynomial {} of the record", place.index)],
            ..ComparedValues::default()
        },
        _ => ComparedValues::default(),
    }
}

fn count_row(name: &'static str, expected: usize, actual: usize) -> Row {
    Row { name, expected: Value::Count(expected), actual: Value::Count(actual), differs: expected != actual }
}

fn number_row(name: &'static str, expected: f64, actual: f64) -> Row {
    let differs = expected.to_bits() != actual.to_bits();
    Row { name, expected: Value::Number(expected), actual: Value::Number(actual), differs }
}

/// Compares two polynomials power by power. Coefficients that differ after division by the common factor are marked.
fn polynomials(place: &fosssim_judge::PolynomialPlace, expected: &[f64], actual: &[f64]) -> ComparedValues {
    compare_with_factor(place, expected, actual, find_factor(expected, actual), None)
}

/// Compares two polynomials power by power. `factor` scales the expected values. The coefficients of the power `wrong`
/// are marked in any case.
fn compare_with_factor(
    place: &fosssim_judge::PolynomialPlace,
    expected: &[f64],
    actual: &[f64],
    factor: f64,
    wrong: Option<usize>,
) -> ComparedValues {
    let coefficient_at = |coefficients: &[f64], power: usize| coefficients.iter().rev().nth(power).copied();
    let powers = expected.len().max(actual.len());
    let is_one = (factor - 1.0).abs() <= 1e-12 || !factor.is_finite();
    let factor = if is_one { 1.0 } else { factor };
    let differing = find_differing_powers(expected, actual, factor);
    let row = |power: usize| {
        let (expected, actual) =
            (coefficient_at(expected, power).map(|value| factor * value), coefficient_at(actual, power));
        let value = |value: Option<f64>| value.map_or(Value::Nothing, Value::Number);
        let is_missing = expected.is_some() != actual.is_some();
        Row {
            name: POWERS.get(power).copied().unwrap_or("higher"),
            expected: value(expected),
            actual: value(actual),
            differs: is_missing || differing.contains(&power) || wrong == Some(power),
        }
    };
    let carried = format!(
        "expected values are multiplied by the trace's factor {}; any positive factor is right",
        format_g(factor)
    );
    ComparedValues {
        remarks_before: vec![format!("polynomial {} of the record", place.index)],
        rows: (0..powers).rev().map(row).collect(),
        remarks_after: if is_one { Vec::new() } else { vec![carried] },
        original: None,
    }
}

/// The names of the powers of t, from 0 on. No polynomial has a higher power.
const POWERS: [&str; 7] = ["1", "t", "t^2", "t^3", "t^4", "t^5", "t^6"];

/// Returns rows with the normals and the times of two logged collisions. A missing collision has no values.
fn compare_collisions(expected: Option<LoggedImpulse>, actual: Option<LoggedImpulse>) -> Vec<Row> {
    let row = |name, part: fn(LoggedImpulse) -> f64| match (expected.map(part), actual.map(part)) {
        (Some(expected), Some(actual)) => number_row(name, expected, actual),
        (expected, actual) => {
            let value = |value: Option<f64>| value.map_or(Value::Nothing, Value::Number);
            Row { name, expected: value(expected), actual: value(actual), differs: false }
        }
    };
    vec![
        row("normal x", |contact| contact.normal.x),
        row("normal y", |contact| contact.normal.y),
        row("time", |contact| contact.time),
    ]
}
