//! The table that `grade --timings` prints. It shows the processor time of each part of a grading.
use crate::{
    cli::console,
    report::{
        style::Style,
        table::{Align, Table},
    },
    sandbox::{ProcessorTimeScope, processor_time},
    suite::timings::{RunPart, Timings},
};

/// Prints the table. The processes of the sandbox must have ended, because their time would be missing otherwise.
pub(super) fn print(timings: &Timings) {
    let own = processor_time(ProcessorTimeScope::Process);
    let others = processor_time(ProcessorTimeScope::Children);
    let (programs, runs) = timings.total(RunPart::Program);
    let mut rows = vec![("programs", programs), ("the sandbox's processes", others.saturating_sub(programs))];
    rows.extend(RunPart::GRADER_PARTS.map(|(part, name)| (name, timings.total(part).0)));
    let rest = own.saturating_sub(rows[2..].iter().map(|(_, time)| *time).sum());
    rows.extend([("reports and the rest", rest), ("together", own + others)]);
    let mut table = Table::new([Align::Left, Align::Right, Align::Right]);
    table.add_heading(["processor time", "seconds", "ms a run"]);
    for (name, time) in rows {
        let seconds = time.as_secs_f64();
        let each = if runs == 0 { String::new() } else { format!("{:.2}", 1000.0 * seconds / f64::from(runs)) };
        table.add_row([name.into(), format!("{seconds:.3}").into(), each.into()]);
    }
    console::print_error(table.render(Style::Plain));
}
