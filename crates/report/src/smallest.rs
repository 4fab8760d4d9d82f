//! The smallest scene on which a program is still wrong for the same reason, with the differing values and the
//! computation by hand.
use crate::{
    explain::{ExplanationView, explanation_texts},
    number::format_count,
    style::{Style, TextStyle},
    untrusted_text::{quote, strip_control_characters},
    view::{FindingView, view},
    words::describe_first_difference,
};
use fosssim_findings::{Book, disclosure::DisclosedFinding, smallest_scene::SmallestScene};

/// Describes the size of the smallest scene, and the scene from which it was made.
pub(crate) fn title(small: &SmallestScene) -> String {
    let SmallestScene { bodies, origin, .. } = small;
    let noun = if *bodies == 1 { "body" } else { "bodies" };
    let (steps, runs) = (format_count(small.steps.into(), "step"), format_count(small.runs.into(), "run"));
    let end = if small.is_minimal { "" } else { "; the search was stopped" };
    format!("The smallest scene: {bodies} {noun}, {steps} (made from {origin} in {runs}{end})")
}

/// Renders the report as text.
pub fn render_text(small: &SmallestScene, style: Style) -> String {
    let SmallestScene { note, first_finding: first, explanations, .. } = small;
    let heading = |title: &str| format!("{}\n", style.paint(TextStyle::Strong, title));
    let explanation_lines = explanation_texts(&explanations[..explanations.len().min(1)], style);
    let first = first.as_ref().filter(|_| explanation_lines.is_empty()).map(describe_first_difference);
    let causes = note.iter().cloned().chain(first).chain(explanation_lines).map(|line| format!("  {line}\n"));
    let mut parts = vec![heading(&title(small)) + &causes.collect::<String>(), small.xml.clone()];
    parts.extend(small.difference.clone());
    parts.extend(small.calculation.iter().map(|calculation| heading("By hand") + calculation));
    let run = format!("{} -s small.xml -d 0 -o small.bin", quote(&small.program));
    let check = note.is_none().then(|| "fosssim-oracle check small.xml small.bin --all".to_owned());
    let commands = std::iter::once(run).chain(check).chain([small.command.clone()]);
    let save = "  Save the scene as small.xml (shrink --output writes it).\n".to_owned();
    parts.push(heading("Next") + &commands.fold(save, |text, line| text + &format!("  $ {line}\n")));
    parts.join("\n")
}

view! {
    /// The smallest scene that was found on which a program is still wrong for the same reason.
    #[schemars(deny_unknown_fields)]
    pub(crate) struct SmallestView from small: SmallestScene {
        /// The name of the scene from which this scene was made.
        origin: String = strip_control_characters(&small.origin),
        /// The content of the scene file.
        scene: String = small.xml.clone(),
        /// The command that finds this scene again.
        again: String = strip_control_characters(&small.command),
        /// The number of times that the program was run during the search.
        runs: u32 = small.runs,
        /// Whether no single change makes the scene smaller. It is false if the search was stopped early.
        minimal: bool = small.is_minimal,
        /// A note on how the program ended; null if it ended normally.
        note: Option<String> = small.note.as_deref().map(strip_control_characters),
        /// The first fault; null if there is none, or if hints hide it.
        first_divergence: Option<FindingView> = match &small.first_finding {
            Some(DisclosedFinding::Full(finding)) => Some(FindingView::from_finding(Book::Fair, finding)),
            Some(DisclosedFinding::Place { .. }) | None => None,
        },
        /// The likely mistakes. The first one is the cause for which the scene was made.
        explanations: Vec<ExplanationView> = small.explanations.iter().map(ExplanationView::from).collect(),
        /// The computation of the first wrong step by hand; null if the hints hide it.
        by_hand: Option<String> = small.calculation.clone(),
    }
}
