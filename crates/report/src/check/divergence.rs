//! The first divergence: expected and actual values side by side.
use super::super::{
    number::exact,
    style::{Look, Style},
    table::{Align, Cell, Table},
};
use fosssim_judge::{Finding, FindingDetail, PassWords, Power, Rescaled, differing, factor};

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

fn side_by_side(detail: &FindingDetail, style: Style) -> String {
    match detail {
        FindingDetail::MissedCollision { expected } => {
            collision(style, Some((expected.normal.x, expected.normal.y, expected.time)), None)
        }
        FindingDetail::SuperfluousCollision { actual } | FindingDetail::RepeatedCollision { actual } => {
            collision(style, None, Some((actual.normal.x, actual.normal.y, actual.time)))
        }
        FindingDetail::WrongNormal { expected, actual, .. } | FindingDetail::ContactTime { expected, actual } => {
            collision(
                style,
                Some((expected.normal.x, expected.normal.y, expected.time)),
                Some((actual.normal.x, actual.normal.y, actual.time)),
            )
        }
        FindingDetail::PolynomialCount { expected, actual, per_pass } => {
            let mut table = Table::new([Align::Left, Align::Right]);
            table.row(["expected".into(), expected.to_string().into()]);
            table.row(["actual".into(), Cell::looking(Look::Bad, actual.to_string())]);
            table.row(["one pass over all pairs".into(), per_pass.to_string().into()]);
            table.render(style)
        }
        FindingDetail::PolynomialDegree { place, expected, actual_size, actual } => {
            let more = actual_size.saturating_sub(actual.coefficients().len());
            let mut text = logged_by(place);
            text += &polynomials(expected.coefficients(), actual.coefficients(), style);
            if more > 0 {
                text += &format!("  {more} more of the trace are not shown\n");
            }
            text
        }
        FindingDetail::VanishingPolynomial { place, expected, actual } => {
            logged_by(place) + &polynomials(expected.coefficients(), actual.coefficients(), style)
        }
        FindingDetail::Coefficient {
            place, power, expected, rescaled, expected_polynomial, actual_polynomial, ..
        } => {
            let (reference, trace) = (expected_polynomial.coefficients(), actual_polynomial.coefficients());
            let own = reference.iter().rev().nth(*power).copied().unwrap_or(0.0);
            // The factor that the finding was made with.
            let factor = if own == 0.0 { factor(reference, trace) } else { expected / own };
            let mut text = logged_by(place);
            text += &polynomials_with(reference, trace, factor, Some(*power), style);
            if let Some(Rescaled { power, expected, actual, .. }) = rescaled {
                text += &format!(
                    "  (the original rescales by sums of moduli before it compares: {} {}, {})\n",
                    Power(*power),
                    exact(*actual),
                    exact(*expected)
                );
            }
            text
        }
        FindingDetail::Position { expected, actual, .. } | FindingDetail::Velocity { expected, actual, .. } => {
            vectors(*expected, *actual, style)
        }
        FindingDetail::PassCount { expected, actual, .. } => {
            let mut table = Table::new([Align::Left, Align::Right]);
            table.row(["expected passes".into(), expected.to_string().into()]);
            table.row(["actual".into(), Cell::looking(Look::Bad, actual.to_string())]);
            table.render(style)
        }
        FindingDetail::PassPositions { place }
        | FindingDetail::TrimmedDecision { place, .. }
        | FindingDetail::TrimmedTime { place, .. }
        | FindingDetail::MixedForms { place } => logged_by(place),
        _ => String::new(),
    }
}

fn logged_by(place: &fosssim_judge::PolynomialPlace) -> String {
    format!("  number {} in the record's list; {}\n", place.index, PassWords(place.pass))
}

/// Two polynomials by power, marked where they part once the factor on which most coefficients agree is taken out.
fn polynomials(expected: &[f64], actual: &[f64], style: Style) -> String {
    polynomials_with(expected, actual, factor(expected, actual), None, style)
}

/// The same with this factor, which the expected values carry; one power is known to differ.
fn polynomials_with(expected: &[f64], actual: &[f64], factor: f64, wrong: Option<usize>, style: Style) -> String {
    let of = |coefficients: &[f64], power: usize| coefficients.iter().rev().nth(power).copied();
    let powers = expected.len().max(actual.len());
    let is_one = (factor - 1.0).abs() <= 1e-12 || !factor.is_finite();
    let factor = if is_one { 1.0 } else { factor };
    let differing = differing(expected, actual, factor);
    let mut table = Table::new([Align::Left, Align::Right, Align::Right, Align::Left]);
    table.heading(["", "expected", "actual", ""]);
    for power in (0..powers).rev() {
        let is_missing = of(expected, power).is_some() != of(actual, power).is_some();
        let agrees = !is_missing && !differing.contains(&power) && wrong != Some(power);
        let text = |value: Option<f64>| value.map_or_else(|| "none".to_owned(), exact);
        let name = match power {
            0 => "1".to_owned(),
            1 => "t".to_owned(),
            power => format!("t^{power}"),
        };
        let found = text(of(actual, power));
        let found = if agrees { found.into() } else { Cell::looking(Look::Bad, found) };
        let mark = if agrees { "".into() } else { Cell::looking(Look::Bad, "<- differs") };
        table.row([name.into(), text(of(expected, power).map(|value| factor * value)).into(), found, mark]);
    }
    let mut text = table.render(style);
    if !is_one {
        text += &format!("  expected values carry the trace's factor {}; any positive one is right\n", exact(factor));
    }
    text
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
