//! The report on one step of a trace, as text and as JSON.
use super::super::{
    detect::format_polynomial,
    style::{Style, TextStyle},
    table::{Align, Table},
    view::{SCHEMA, to_written_numbers},
};
use fosssim_judge::{PairText, PassText, Role};
use fosssim_model::trace::{Frame, PolynomialLabel};
use fosssim_num::number_format::format_exact;
use serde_json::{Value, json};

/// One of the step's records, as the report shows it.
#[derive(Debug, Clone)]
pub struct ShownRecord {
    /// The index of the record in the trace, counted from 0.
    pub number: u64,
    /// The position of the record in the file, in bytes.
    pub offset: u64,
    /// Whether the record is the step's mid record; otherwise it is the end record.
    pub is_mid: bool,
    /// The record's content.
    pub frame: Frame,
    /// Remarks about unusual properties of the record.
    pub notes: Vec<String>,
}

/// A step of a trace, as the report shows it.
#[derive(Debug, Clone, Copy)]
pub struct ShownStep<'a> {
    /// The number of the step, from 1; 0 is the initial record.
    pub step: u32,
    /// The number of steps of the scene.
    pub steps: u32,
    /// The records of the step.
    pub records: &'a [ShownRecord],
    /// The origins of the reference's polynomials in this step, in the order of the log.
    pub labels: &'a [PolynomialLabel],
}

impl ShownStep<'_> {
    /// Renders the step for people. If both records are equal, only the end record is shown.
    pub fn render_text(&self, style: Style) -> String {
        let heading = match self.step {
            0 => "Initial record".to_owned(),
            step => format!("Step {step} of {}", self.steps),
        };
        let mut text = style.paint(TextStyle::Strong, &heading) + "\n";
        let same = matches!(self.records, [mid, end] if mid.frame.is_same(&end.frame));
        for record in self.records {
            if record.is_mid && same {
                text += &format!(
                    "  frame {} (mid record), byte {}: the same as the end record\n",
                    record.number, record.offset
                );
                continue;
            }
            text += &self.record(record, style);
        }
        text
    }

    fn record(&self, record: &ShownRecord, style: Style) -> String {
        let kind = if record.is_mid {
            "mid record"
        } else if self.step == 0 {
            "initial record"
        } else {
            "end record"
        };
        let mut text = format!("  frame {} ({kind}), byte {}\n", record.number, record.offset);
        for note in &record.notes {
            text += &format!("  {}\n", style.paint(TextStyle::Notice, &format!("odd: {note}")));
        }
        let frame = &record.frame;
        let mut table = Table::new([Align::Right; 5]);
        table.add_heading(["particle", "x", "y", "vx", "vy"]);
        let pairs = frame.state.positions.chunks(2).zip(frame.state.velocities.chunks(2));
        for (particle, (position, velocity)) in pairs.enumerate() {
            let cell =
                |values: &[f64], axis: usize| values.get(axis).copied().map(format_exact).unwrap_or_default().into();
            let (x, y) = (cell(position, 0), cell(position, 1));
            table.add_row([particle.to_string().into(), x, y, cell(velocity, 0), cell(velocity, 1)]);
        }
        text += &table.render(style);
        text += &format!("  impulses: {}\n", frame.impulses.len());
        for impulse in &frame.impulses {
            text += &format!("    {impulse}\n");
        }
        let count = frame.polynomials.len();
        text += &format!("  polynomials: {count}");
        if !record.is_mid && !self.labels.is_empty() && self.labels.len() != count {
            text += &format!("; the reference logs {} here", self.labels.len());
        }
        text += "\n";
        let mut pass = None;
        for (index, coefficients) in frame.polynomials.iter().enumerate() {
            let label = self.labels.get(index);
            if let Some(label) = label
                && pass != Some(label.pass)
            {
                pass = Some(label.pass);
                text += &format!("    {}\n", style.paint(TextStyle::Faint, &PassText(label.pass).to_string()));
            }
            let place = label.map_or_else(String::new, |label| {
                format!("{}, {}: ", PairText(label.pair), Role::from_number(label.pair.kind, label.number))
            });
            text += &format!("    {index}  {place}{}\n", format_polynomial(coefficients, format_exact));
        }
        text
    }

    /// Renders the step for programs: one JSON object, indented, with a line feed at its end.
    pub fn json(&self, scene: &str, trace: &str) -> String {
        let value = json!({
            "schema": SCHEMA,
            "scene": scene,
            "trace": trace,
            "step": self.step,
            "records": self.records.iter().map(|record| self.record_view(record)).collect::<Vec<_>>(),
        });
        format!("{value:#}\n")
    }

    fn record_view(&self, record: &ShownRecord) -> Value {
        let frame = &record.frame;
        let polynomial = |(index, coefficients): (usize, &[f64])| {
            let label = self.labels.get(index);
            json!({
                "index": index,
                "pass": label.map(|label| label.pass),
                "pair": label.map(|label| label.pair),
                "role": label.map(|label| Role::from_number(label.pair.kind, label.number)),
                "coefficients": to_written_numbers(coefficients),
            })
        };
        json!({
            "frame": record.number,
            "offset": record.offset,
            "mid": record.is_mid,
            "positions": to_written_numbers(&frame.state.positions),
            "velocities": to_written_numbers(&frame.state.velocities),
            "impulses": frame.impulses,
            "polynomials": frame.polynomials.iter().enumerate().map(polynomial).collect::<Vec<_>>(),
            "oddities": record.notes,
        })
    }
}
