//! The smallest scene on which a program is still wrong for the same reason, with the differing values and the
//! computation by hand.
use crate::{
    explain::{ExplanationView, lines},
    foreign::{plain, quote},
    number::format_count,
    style::{Look, Style},
    view::{FindingView, view},
    words::describe_first,
};
use fosssim_findings::{Book, disclosure::DisclosedFinding, smallest::SmallestScene};

/// Returns the size and the origin of the scene, as a sentence.
pub(crate) fn title(small: &SmallestScene) -> String {
    let SmallestScene { bodies, origin, .. } = small;
    let bodies = match bodies {
        0 => "no body".to_owned(),
        1 => "1 body".to_owned(),
        more => format!("{more} bodies"),
    };
    let (steps, runs) = (format_count(small.steps.into(), "step"), format_count(small.runs.into(), "run"));
    let end = if small.is_minimal { "" } else { "; the search was stopped" };
    format!("The smallest scene: {bodies}, {steps} (made from {origin} in {runs}{end})")
}

/// Renders the report for people. `file` is the scene's file, if it was written.
#[must_use]
pub fn text(small: &SmallestScene, file: Option<&str>, style: Style) -> String {
    let heading = |words: &str| format!("{}\n", style.paint(Look::Strong, words));
    let mut parts = vec![heading(&title(small))];
    parts[0].extend(causes(small, style).iter().map(|line| format!("  {line}\n")));
    parts.push(small.xml.clone());
    parts.extend(small.differs.clone());
    parts.extend(small.by_hand.iter().map(|by_hand| heading("By hand") + by_hand));
    let commands = commands(small, file).into_iter().map(|line| format!("  $ {line}\n"));
    let save = if file.is_none() { "  Save the scene as small.xml (--output writes it).\n" } else { "" };
    parts.push(heading("Next") + save + &commands.collect::<String>());
    parts.join("\n")
}

/// Returns the reasons why the program is wrong on the scene, one per line.
fn causes(small: &SmallestScene, style: Style) -> Vec<String> {
    let SmallestScene { note, first, explanations, .. } = small;
    let told = lines(&explanations[..explanations.len().min(1)], style);
    let first = first.as_ref().filter(|_| told.is_empty()).map(describe_first);
    note.iter().cloned().chain(first).chain(told).collect()
}

/// Returns commands that run the program on the scene and show more.
fn commands(small: &SmallestScene, file: Option<&str>) -> Vec<String> {
    let (scene, program) = (quote(file.unwrap_or("small.xml")), quote(&small.program));
    let detect =
        small.detect.as_ref().map(|pair| format!("fosssim-oracle detect --scene {scene} --trace small.bin {pair}"));
    let check = small.note.is_none().then(|| format!("fosssim-oracle check {scene} small.bin --all"));
    let run = format!("{program} -s {scene} -d 0 -o small.bin");
    std::iter::once(run).chain(check).chain(detect).chain([small.again.clone()]).collect()
}

view! {
    /// The smallest scene on which a program is still wrong for the same reason.
    #[schemars(deny_unknown_fields)]
    pub(crate) struct SmallestView from small: SmallestScene {
        /// The name of the original scene.
        origin: String = plain(&small.origin),
        /// The content of the scene file.
        scene: String = small.xml.clone(),
        /// The command that reproduces the scene.
        again: String = plain(&small.again),
        /// The number of times that the program was run.
        runs: u32 = small.runs,
        /// Whether no single change makes the scene smaller; false if the search was stopped early.
        minimal: bool = small.is_minimal,
        /// The end of the program, if it did not end well.
        note: Option<String> = small.note.as_deref().map(plain),
        /// The first fault; null if there is none, or if hints hide it.
        first_divergence: Option<FindingView> = match &small.first {
            Some(DisclosedFinding::Full(finding)) => Some(FindingView::from_finding(Book::Fair, finding)),
            Some(DisclosedFinding::Place { .. }) | None => None,
        },
        /// The likely mistakes, beginning with the cause.
        explanations: Vec<ExplanationView> = small.explanations.iter().map(ExplanationView::from).collect(),
        /// The computation of the first wrong step by hand; null if hints hide it.
        by_hand: Option<String> = small.by_hand.clone(),
    }
}
