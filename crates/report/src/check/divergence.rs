//! The first divergence: expected and actual values side by side.
use super::super::{
    number::exact,
    style::{Look, Style},
    table::{Align, Cell, Table},
};
use fosssim_judge::{Detail, Finding, PassWords, Power};
use fosssim_num::tolerances::PARITY_COEFFICIENT;

/// The block about one finding, with a heading and without advice.
pub(super) fn render(finding: &Finding, steps: u32, style: Style) -> String {
    let record = if finding.frame == 2 * u64::from(finding.step) { " (end record)" } else { "" };
    let heading = match finding.step {
        0 => "First divergence: the first record".to_owned(),
        step => format!("First divergence: step {step} of {steps}, frame {}{record}", finding.frame),
    };
    format!("{}\n{}", style.paint(Look::Strong, &heading), block(finding, style))
}

/// One finding in words, and its values side by side.
pub(super) fn block(finding: &Finding, style: Style) -> String {
    format!("  {}\n{}", finding.what(), side_by_side(&finding.detail, style))
}

fn side_by_side(detail: &Detail, style: Style) -> String {
    match detail {
        Detail::MissedCollision { expected } => {
            collision(style, Some((expected.normal.x, expected.normal.y, expected.time)), None)
        }
        Detail::SuperfluousCollision { actual } | Detail::RepeatedCollision { actual } => {
            collision(style, None, Some((actual.normal.x, actual.normal.y, actual.time)))
        }
        Detail::WrongNormal { expected, actual, .. } | Detail::ContactTime { expected, actual } => collision(
            style,
            Some((expected.normal.x, expected.normal.y, expected.time)),
            Some((actual.normal.x, actual.normal.y, actual.time)),
        ),
        Detail::PolynomialCount { expected, actual, per_pass } => {
            let mut table = Table::new([Align::Left, Align::Right]);
            table.row(["expected".into(), expected.to_string().into()]);
            table.row(["actual".into(), Cell::looking(Look::Bad, actual.to_string())]);
            table.row(["one pass over all pairs".into(), per_pass.to_string().into()]);
            table.render(style)
        }
        Detail::PolynomialDegree { place, expected, actual_size, actual } => {
            let more = actual_size.saturating_sub(actual.coefficients().len());
            let mut text = logged_by(place);
            text += &polynomials(expected.coefficients(), actual.coefficients(), style);
            if more > 0 {
                text += &format!("  {more} more of the trace are not shown\n");
            }
            text
        }
        Detail::VanishingPolynomial { place, expected, actual } => {
            logged_by(place) + &polynomials(expected.coefficients(), actual.coefficients(), style)
        }
        Detail::Coefficient { place, power, expected, actual, expected_polynomial, actual_polynomial, .. } => {
            let (reference, trace) = (expected_polynomial.coefficients(), actual_polynomial.coefficients());
            let mut text = logged_by(place);
            text += &polynomials(reference, trace, style);
            let unscaled = reference.iter().rev().nth(*power);
            if unscaled.is_some_and(|value| value.to_bits() != expected.to_bits()) {
                text += &format!(
                    "  compared after rescaling to the trace's magnitude: {} {}, expected {}\n",
                    Power(*power),
                    exact(*actual),
                    exact(*expected)
                );
            }
            text
        }
        Detail::Position { expected, actual, .. } | Detail::Velocity { expected, actual, .. } => {
            vectors(*expected, *actual, style)
        }
        Detail::PassCount { expected, actual, .. } => {
            let mut table = Table::new([Align::Left, Align::Right]);
            table.row(["expected passes".into(), expected.to_string().into()]);
            table.row(["actual".into(), Cell::looking(Look::Bad, actual.to_string())]);
            table.render(style)
        }
        Detail::PassPositions { place } | Detail::TrimmedDecision { place, .. } | Detail::MixedForms { place } => {
            logged_by(place)
        }
        Detail::RecordsDiffer { .. } | Detail::ImpossibleLog => String::new(),
    }
}

fn logged_by(place: &fosssim_judge::PolynomialPlace) -> String {
    format!("  number {} in the record's list; {}\n", place.index, PassWords(place.pass))
}

/// Two polynomials by power, marked where they part.
///
/// The rules rescale before they compare, so one wrong coefficient moves all the others. What is marked is what a
/// person would call wrong: when some coefficients agree as they are, those that do not; else those that do not agree
/// after rescaling.
fn polynomials(expected: &[f64], actual: &[f64], style: Style) -> String {
    let of = |coefficients: &[f64], power: usize| coefficients.iter().rev().nth(power).copied();
    let powers = expected.len().max(actual.len());
    let sum = |coefficients: &[f64]| coefficients.iter().fold(0.0, |sum: f64, c| sum + c.abs());
    let (reference, trace) = (sum(expected), sum(actual));
    let as_it_is = |power| match (of(expected, power), of(actual, power)) {
        (Some(expected), Some(actual)) => !((expected - actual).abs() > 1e-9 * expected.abs()),
        (expected, actual) => expected.is_none() && actual.is_none(),
    };
    let rescaled = |power| match (of(expected, power), of(actual, power)) {
        (Some(expected), Some(actual)) => !((actual - expected * trace / reference).abs() > PARITY_COEFFICIENT),
        (expected, actual) => expected.is_none() && actual.is_none(),
    };
    let some_agree = (0..powers).any(|power| as_it_is(power) && of(expected, power).is_some_and(|c| c != 0.0));
    let all_agree = (0..powers).all(as_it_is);
    let mut table = Table::new([Align::Left, Align::Right, Align::Right, Align::Left]);
    table.heading(["", "expected", "actual", ""]);
    for power in (0..powers).rev() {
        let agrees = if some_agree && !all_agree { as_it_is(power) } else { rescaled(power) };
        let text = |value: Option<f64>| value.map_or_else(|| "none".to_owned(), exact);
        let name = match power {
            0 => "1".to_owned(),
            1 => "t".to_owned(),
            power => format!("t^{power}"),
        };
        let found = text(of(actual, power));
        let found = if agrees { found.into() } else { Cell::looking(Look::Bad, found) };
        let mark = if agrees { "".into() } else { Cell::looking(Look::Bad, "<- differs") };
        table.row([name.into(), text(of(expected, power)).into(), found, mark]);
    }
    table.render(style)
}

/// Contact normal (x, y) and time.
type Contact = (f64, f64, f64);

fn collision(style: Style, expected: Option<Contact>, actual: Option<Contact>) -> String {
    let text = |value: Option<f64>| value.map_or_else(|| "none".to_owned(), exact);
    let mut table = Table::new([Align::Left, Align::Right, Align::Right]);
    table.heading(["", "expected", "actual"]);
    let mut row = |name: &str, part: fn(Contact) -> f64| {
        table.row([name.into(), text(expected.map(part)).into(), text(actual.map(part)).into()]);
    };
    row("normal x", |contact| contact.0);
    row("normal y", |contact| contact.1);
    row("time", |contact| contact.2);
    table.render(style)
}

fn vectors(expected: [f64; 2], actual: [f64; 2], style: Style) -> String {
    let mut table = Table::new([Align::Left, Align::Right, Align::Right]);
    table.heading(["", "expected", "actual"]);
    for (name, (expected, actual)) in ["x", "y"].into_iter().zip(expected.into_iter().zip(actual)) {
        let actual = match expected.to_bits() == actual.to_bits() {
            true => exact(actual).into(),
            false => Cell::looking(Look::Bad, exact(actual)),
        };
        table.row([name.into(), exact(expected).into(), actual]);
    }
    table.render(style)
}
