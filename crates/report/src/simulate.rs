//! The summary that `simulate` prints.
use super::{
    number::{format_count, group_digits},
    style::{Style, TextStyle},
    table::{Align, Table},
    view::SCHEMA,
};
use fosssim_model::trace::{EventCounts, WrittenTrace};
use serde_json::json;

/// The results of simulating a scene.
#[derive(Debug, Clone, Copy)]
pub struct SimulationSummary<'a> {
    /// The name of the scene, as the user typed it.
    pub scene: &'a str,
    /// The name of the trace, as the user typed it; `None` if no trace was written.
    pub output: Option<&'a str>,
    /// The number of steps of the scene.
    pub steps: u32,
    /// The total number of events of each kind, in all steps.
    pub counts: EventCounts,
    /// The size of the trace that was written.
    pub written_trace: WrittenTrace,
}

impl SimulationSummary<'_> {
    /// Renders the report as text.
    pub fn render_text(&self, style: Style) -> String {
        let counts = &self.counts;
        let mut table = Table::new([Align::Left, Align::Right, Align::Left]);
        table.add_row(["steps".into(), group_digits(u64::from(self.steps)).into(), "".into()]);
        let passes: Vec<_> = [
            (counts.simple_passes, "simple"),
            (counts.continuous_time_passes, "continuous-time"),
            (counts.impulse_passes, "impulse"),
            (counts.geometric_passes, "geometric"),
        ]
        .into_iter()
        .filter(|(number, _)| *number > 0)
        .map(|(number, name)| format!("{} {name}", group_digits(number)))
        .collect();
        table.add_row(["detection passes".into(), group_digits(counts.passes()).into(), passes.join(", ").into()]);
        for (kind, &calls) in counts.calls.iter() {
            let hits = counts.hits[kind];
            let hits = if calls > 0 { format!("{} collide", group_digits(hits)) } else { String::new() };
            table.add_row([format!("{} calls", kind.name()).into(), group_digits(calls).into(), hits.into()]);
        }
        table.add_row(["impulses".into(), group_digits(counts.impulses).into(), "".into()]);
        let zones = if counts.failsafes > 0 {
            format!(
                "in {}, largest zone of {}",
                format_count(counts.geometric_steps, "step"),
                format_count(counts.largest_zone, "particle")
            )
        } else {
            String::new()
        };
        table.add_row(["rigid failsafes".into(), group_digits(counts.failsafes).into(), zones.into()]);
        table.add_row(["polynomials".into(), group_digits(counts.polynomials).into(), "".into()]);
        let records = format!("in {}", format_count(self.written_trace.records, "record"));
        table.add_row(["bytes".into(), group_digits(self.written_trace.bytes).into(), records.into()]);
        let end = self.output.map_or_else(|| "; nothing was kept".to_owned(), |name| format!(" into {name}"));
        let heading = format!("Simulated {}{end}", self.scene);
        format!("{}\n{}", style.paint(TextStyle::Strong, &heading), table.render(style))
    }

    /// Renders the report as one JSON object, indented, with a line feed at its end.
    pub fn json(&self) -> String {
        let counts = &self.counts;
        let calls: serde_json::Map<_, _> = counts
            .calls
            .iter()
            .map(|(kind, calls)| (kind.name().to_owned(), json!({ "calls": calls, "hits": counts.hits[kind] })))
            .collect();
        let value = json!({
            "schema": SCHEMA,
            "scene": self.scene,
            "trace": self.output,
            "steps": self.steps,
            "passes": {
                "simple": counts.simple_passes,
                "continuous-time": counts.continuous_time_passes,
                "impulses": counts.impulse_passes,
                "geometric": counts.geometric_passes,
            },
            "pairs": calls,
            "impulses": counts.impulses,
            "geometric_steps": counts.geometric_steps,
            "failsafes": counts.failsafes,
            "largest_zone": counts.largest_zone,
            "polynomials": counts.polynomials,
            "records": self.written_trace.records,
            "bytes": self.written_trace.bytes,
        });
        format!("{value:#}\n")
    }
}
