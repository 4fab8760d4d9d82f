//! The report of `explain`. It lists the likely mistakes of a program, for each trace and for all traces together.
use super::{
    case::Case,
    explain::{ExplanationView, explanation_texts},
    number::format_count,
    smallest::{self, SmallestView},
    style::{Style, TextStyle},
    view::{FindingView, to_document, view},
    words::{describe_first_difference, describe_located},
};
use crate::untrusted_text::to_one_line;
use fosssim_findings::{
    Book, disclosure::DisclosedFinding, located_failure::LocatedFailure, smallest_scene::SmallestScene,
};
use fosssim_mistakes::diagnose::{Explanation, is_named_in};
use std::fmt::Write;

/// The version of the JSON report's schema (`schemas/explain.schema.json`).
const SCHEMA: u32 = 3;

/// The report on all traces of a program.
#[derive(Debug, Clone, Default)]
pub struct Diagnosis {
    /// The traces, in the order of the request.
    pub cases: Vec<Case>,
    /// The mistakes that explain several traces, the most frequent first. The list is empty if there is only one trace.
    pub common: Vec<Explanation>,
    /// The common features of the scenes in which the program crashes or exceeds a limit.
    pub located: Option<LocatedFailure>,
    /// The smallest scene for each cause, if the user requested it.
    pub smallest: Vec<SmallestScene>,
}

impl Diagnosis {
    /// Returns whether the fair rules accept every trace.
    pub fn is_accepted(&self) -> bool {
        self.cases.iter().all(|case| case.accepted)
    }

    /// Renders the report as text.
    pub fn render_text(&self, style: Style) -> String {
        let smallest: String =
            self.smallest.iter().map(|scene| format!("\n{}", smallest::render_text(scene, style))).collect();
        match &self.cases[..] {
            [] if smallest.is_empty() => return "No smaller scene shows the same fault.\n".to_owned(),
            [] => return smallest.trim_start().to_owned(),
            [case] => return render_single(case, style) + &smallest,
            _ => {}
        }
        let mut text = String::new();
        let wrong_count = self.cases.iter().filter(|case| !case.accepted).count();
        let verb = if wrong_count == 1 { "is" } else { "are" };
        let traces = format_count(self.cases.len() as u64, "trace");
        let _ = writeln!(text, "{wrong_count} of {traces} {verb} wrong by the fair rules.\n");
        if wrong_count == 0 {
            text += "These scenes show single formulas. A suite has more: fosssim-oracle grade PROGRAM\n\n";
        }
        if let Some(found) = &self.located {
            let heading = style.paint(TextStyle::Strong, "Where it fails");
            let _ = writeln!(text, "{heading}\n  {}\n", to_one_line(&describe_located(found)));
        }
        let mut likely = 0;
        for common in &self.common {
            let explained_count = self.cases.iter().filter(|case| is_named_in(common, &case.explanations)).count();
            likely += usize::from(!common.reports_non_finite_value());
            let traces = format_count(wrong_count as u64, "wrong trace");
            let share = format!("({explained_count} of {traces})");
            let heading = match likely {
                _ if common.reports_non_finite_value() => format!("First value that is not finite {share}"),
                _ if common.is_unexplained() => format!("Most frequent fault {share}"),
                1 if explained_count < wrong_count => format!("Most frequent likely cause {share}"),
                1 if wrong_count == 1 => "Likely cause of the only wrong trace".to_owned(),
                1 => format!("Likely cause of all {traces}"),
                _ => format!("Another likely cause {share}"),
            };
            let _ = writeln!(text, "{}", style.paint(TextStyle::Strong, &heading));
            text += &render_mistakes(std::slice::from_ref(common), style);
            text.push('\n');
        }
        let common: Vec<&Explanation> = self.common.iter().filter(|common| !common.is_unexplained()).collect();
        for (index, case) in self.cases.iter().enumerate() {
            // A note that many traces have, such as a crash, is written once.
            let is_alike = |other: &&Case| {
                case.note.is_some()
                    && case.explanations.is_empty()
                    && other.explanations.is_empty()
                    && case.note == other.note
            };
            if self.cases[..index].iter().any(|earlier| is_alike(&earlier)) {
                continue;
            }
            let more_count = self.cases[index + 1..].iter().filter(is_alike).count();
            let _ = writeln!(text, "{}", render_head(case, more_count, style));
            for other in case.explanations.iter().map(std::slice::from_ref) {
                if !common.iter().any(|common| is_named_in(common, other)) {
                    text += &render_mistakes(other, style);
                }
            }
        }
        text + &smallest
    }

    /// Renders the report as JSON.
    pub fn json(&self) -> String {
        to_document(&DiagnosisView::from(self))
    }
}

/// Renders the line of a trace. The line also represents `more` traces with the same note.
fn render_head(case: &Case, more: usize, style: Style) -> String {
    let verdict =
        if case.accepted { style.paint(TextStyle::Right, "right") } else { style.paint(TextStyle::Wrong, "wrong") };
    let mut line = format!("{verdict}  {}", case.scene);
    if more > 0 {
        let _ = write!(line, " and {}", format_count(more as u64, "more scene"));
    }
    if let Some(note) = &case.note {
        let _ = write!(line, ": {note}");
    }
    if let (Some(first), true) = (&case.first, case.explanations.is_empty()) {
        let _ = write!(line, ": {}", describe_first_difference(first));
    }
    line
}

fn render_single(case: &Case, style: Style) -> String {
    let Case { scene, trace, accepted, note, first, explanations } = case;
    let mut text = format!("{trace} on {scene}\n");
    if let Some(note) = note {
        let _ = writeln!(text, "{note}");
    }
    if *accepted {
        let right = "There is nothing to explain: the fair rules accept the trace.";
        return text + &style.paint(TextStyle::Right, right) + "\n";
    }
    if let Some(first) = first {
        let _ = writeln!(text, "{}", describe_first_difference(first));
    }
    if explanations.is_empty() && first.is_none() {
        text += "No known mistake explains the trace.\n";
    } else if explanations.is_empty() {
        text += "No known mistake explains the trace. Start at the first difference: the step starts from the \
         trace's own\n\
                 state, so earlier steps cannot be the cause.\n";
    } else {
        text.push('\n');
        text += &render_mistakes(explanations, style);
    }
    text
}

fn render_mistakes(explanations: &[Explanation], style: Style) -> String {
    explanation_texts(explanations, style).iter().map(|line| format!("  {line}\n")).collect()
}

view! {
    /// The likely mistakes of the program that wrote the traces.
    #[schemars(deny_unknown_fields)]
    pub(crate) struct DiagnosisView<'a> from diagnosis: Diagnosis {
        /// The version of the schema.
        #[schemars(extend("const" = SCHEMA))]
        schema: u32 = SCHEMA,
        /// Whether the fair rules accept every trace.
        accepted: bool = diagnosis.is_accepted(),
        /// The common features of scenes in which the program crashes or exceeds a limit, as text; null if there are no
        /// such scenes.
        located: Option<String> = diagnosis.located.as_ref().map(describe_located),
        /// The mistake that explains most of the wrong traces; null if there is only one trace.
        common: Option<ExplanationView> = diagnosis.common.first().map(ExplanationView::from),
        /// Up to three mistakes that together explain the wrong traces. The first one is `common`. The list is empty if
        /// there is only one trace.
        likely: Vec<ExplanationView> = diagnosis.common.iter().map(ExplanationView::from).collect(),
        /// The traces, in the order of the request.
        traces: Vec<CaseView<'a>> = diagnosis.cases.iter().map(CaseView::from).collect(),
        /// The smallest scene for each cause, if the user requested it and the program can be run.
        smallest: Vec<SmallestView> = diagnosis.smallest.iter().map(SmallestView::from).collect(),
    }
}

view! {
    /// One trace of the program.
    #[schemars(deny_unknown_fields)]
    struct CaseView<'a> from case: Case {
        /// The name of the scene that the trace belongs to.
        scene: &'a str = &case.scene,
        /// The path of the trace file, or of the program that wrote the trace.
        trace: &'a str = &case.trace,
        /// Whether the fair rules accept the trace.
        accepted: bool = case.accepted,
        /// A note on how the program ended; null if it ended normally.
        note: Option<&'a str> = case.note.as_deref(),
        /// The first fault; null if there is none, or if hints hide it.
        first_divergence: Option<FindingView> = match &case.first {
            Some(DisclosedFinding::Full(finding)) => Some(FindingView::from_finding(Book::Fair, finding)),
            Some(DisclosedFinding::Place { .. }) | None => None,
        },
        /// Likely mistakes, the likeliest first.
        explanations: Vec<ExplanationView> = case.explanations.iter().map(ExplanationView::from).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_likeliest_cause_has_its_share_of_the_wrong_traces() {
        let explanation = crate::explain::tests::explanations().swap_remove(0);
        let heading = |explained: usize, wrong: usize| {
            let case = |index| Case {
                scene: format!("scene-{index}"),
                trace: "FOSSSim".to_owned(),
                accepted: index >= wrong,
                note: None,
                first: None,
                explanations: if index < explained { vec![explanation.clone()] } else { Vec::new() },
            };
            let cases = (0..5).map(case).collect();
            let text = Diagnosis { cases, common: vec![explanation.clone()], ..Diagnosis::default() };
            text.render_text(Style::Plain).lines().nth(2).expect("a heading").to_owned()
        };
        assert_eq!(heading(1, 1), "Likely cause of the only wrong trace");
        assert_eq!(heading(4, 4), "Likely cause of all 4 wrong traces");
        assert_eq!(heading(1, 4), "Most frequent likely cause (1 of 4 wrong traces)");
    }

    #[test]
    fn a_crash_in_many_scenes_is_one_line() {
        let case = |scene: &str, note: Option<&str>| Case {
            scene: scene.to_owned(),
            trace: "FOSSSim".to_owned(),
            accepted: note.is_none(),
            note: note.map(str::to_owned),
            first: None,
            explanations: Vec::new(),
        };
        let cases = [("a", Some("no trace")), ("b", None), ("c", Some("no trace")), ("d", None)];
        let cases = cases.map(|(scene, note)| case(scene, note)).to_vec();
        let text = Diagnosis { cases, ..Diagnosis::default() }.render_text(Style::Plain);
        assert_eq!(
            text,
            "2 of 4 traces are wrong by the fair rules.\n\nwrong  a and 1 more scene: no trace\nright  b\nright  d\n"
        );
    }
}
