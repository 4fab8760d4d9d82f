//! Two traces side by side, the first difference first.
use super::{
    super::{
        number::{count, counted, exact},
        style::{Look, Style},
        table::{Align, Table},
        view::{Number, SCHEMA},
    },
    info::place,
};
use fosssim_model::trace::{Block, Comparison, List, TraceError};
use serde_json::{Value, json};

/// The names under which people know what is compared.
#[derive(Debug, Clone, Copy)]
pub struct TraceNames<'a> {
    /// The scene.
    pub scene: &'a str,
    /// One trace.
    pub left: &'a str,
    /// The other trace.
    pub right: &'a str,
}

/// Whether both traces are complete and the same, with as many bytes behind the last record, which are not compared.
#[must_use]
pub fn same(comparison: &Comparison) -> bool {
    comparison.same() && comparison.left == comparison.right
}

/// For people.
#[must_use]
pub fn diff_text(names: &TraceNames<'_>, comparison: &Comparison, style: Style) -> String {
    let records = counted(comparison.frames, "record");
    let verb = if comparison.frames == 1 { "is" } else { "are" };
    if same(comparison) {
        let mut text = format!("{}: {records} {verb} the same bit for bit\n", style.paint(Look::Good, "SAME"));
        if let Ok(trailing @ 1..) = comparison.left {
            text += &format!("the bytes behind the last record ({} each) were not compared\n", count(trailing));
        }
        return text;
    }
    let head = style.paint(Look::Bad, "DIFFERENT");
    let mut text = match &comparison.first {
        None => format!("{head}: the {records} that both have {verb} the same bit for bit\n"),
        Some(first) => {
            let mid = if first.mid { ", mid record" } else { "" };
            let differing = count(comparison.differing);
            let mut text = format!(
                "{head}: {differing} of {records}, the first in step {} (frame {}{mid})\n",
                first.step, first.frame
            );
            let mut table = Table::new([Align::Left, Align::Right, Align::Right]);
            table.heading(["first difference", names.left, names.right]);
            for (name, left, right) in rows(&first.block) {
                table.row([name.into(), left.into(), right.into()]);
            }
            text += &table.render(style);
            text
        }
    };
    for (name, end) in [(names.left, &comparison.left), (names.right, &comparison.right)] {
        match end {
            Ok(0) => {}
            Ok(trailing) => {
                let follow = if *trailing == 1 { "follows" } else { "follow" };
                text += &format!("{name}: {} {follow} the last record\n", counted(*trailing, "byte"));
            }
            Err(error) => text += &format!("{name}: {error}\n"),
        }
    }
    text
}

/// For programs: one JSON object, indented, with a line feed at its end.
#[must_use]
pub fn diff_json(names: &TraceNames<'_>, comparison: &Comparison) -> String {
    let end = |end: &Result<u64, TraceError>| match end {
        Ok(trailing) => json!({ "trailing_bytes": trailing, "damage": null }),
        Err(error) => json!({ "trailing_bytes": null, "damage": place(error) }),
    };
    let first = comparison.first.map(|first| {
        let (what, left, right) = values(&first.block);
        json!({
            "step": first.step, "frame": first.frame, "mid": first.mid,
            "what": what, "text": first.block.to_string(), "left": left, "right": right,
        })
    });
    let value = json!({
        "schema": SCHEMA,
        "scene": names.scene,
        "left": names.left,
        "right": names.right,
        "same": same(comparison),
        "records": comparison.frames,
        "differing_records": comparison.differing,
        "first_difference": first,
        "left_end": end(&comparison.left),
        "right_end": end(&comparison.right),
    });
    format!("{value:#}\n")
}

/// Rows of a table: what is compared, left, right.
fn rows(block: &Block) -> Vec<(String, String, String)> {
    let numbers = |name: String, left: f64, right: f64| vec![(name, bits(left, right), bits(right, left))];
    let counts = |name: String, left: usize, right: usize| vec![(name, left.to_string(), right.to_string())];
    match *block {
        Block::Coordinate { quantity, particle, axis, left, right } => {
            numbers(format!("{quantity} {axis} of particle {particle}"), left, right)
        }
        Block::Impulse { index, left, right } => {
            let row = |name: &str, left: String, right: String| (format!("impulse {index}, {name}"), left, right);
            vec![
                row("kind", left.kind.to_string(), right.kind.to_string()),
                row("first", left.first.to_string(), right.first.to_string()),
                row("second", left.second.to_string(), right.second.to_string()),
                row("normal x", bits(left.normal.x, right.normal.x), bits(right.normal.x, left.normal.x)),
                row("normal y", bits(left.normal.y, right.normal.y), bits(right.normal.y, left.normal.y)),
                row("time", bits(left.time, right.time), bits(right.time, left.time)),
            ]
        }
        Block::Count { list, left, right } => counts(format!("number of {list}s"), left, right),
        Block::PolynomialSize { index, left, right } => {
            counts(format!("coefficients of polynomial {index}"), left, right)
        }
        Block::Coefficient { index, power, left, right } => {
            numbers(format!("t^{power} of polynomial {index}"), left, right)
        }
    }
}

/// A number; with its bits when the text alone would not tell the two apart.
fn bits(value: f64, other: f64) -> String {
    if value.to_bits() != other.to_bits() && exact(value) == exact(other) {
        format!("{} ({:#018x})", exact(value), value.to_bits())
    } else {
        exact(value)
    }
}

/// The key of what differs, and both values.
fn values(block: &Block) -> (&'static str, Value, Value) {
    match *block {
        Block::Coordinate { quantity, left, right, .. } => (quantity, json!(Number(left)), json!(Number(right))),
        Block::Impulse { left, right, .. } => ("impulse", json!(left), json!(right)),
        Block::Count { list: List::Impulses, left, right } => ("impulse_count", json!(left), json!(right)),
        Block::PolynomialSize { left, right, .. } => ("polynomial_size", json!(left), json!(right)),
        Block::Coefficient { left, right, .. } => ("coefficient", json!(Number(left)), json!(Number(right))),
        Block::Count { list: List::Polynomials, left, right } => ("polynomial_count", json!(left), json!(right)),
    }
}
