//! The smallest scene on which a program is still wrong for the same reason: the scene, the values that differ, and the
//! computation by hand.
use crate::{
    case::Case,
    describe::pair_key,
    explain::{ExplanationView, lines},
    number::counted,
    style::{Look, Style},
    view::{FindingView, view},
    words::first_divergence,
};
use fosssim_findings::{Book, disclosure::DisclosedFinding};
use fosssim_model::{
    scene::{self, Scene},
    sim::Pair,
};

/// The smallest scene for a cause, with all that is to be said of it.
#[derive(Debug, Clone)]
pub struct SmallestReport {
    /// The program's run on it. Its scene's name is that of the scene that it was made of.
    pub case: Case,
    /// The scene.
    pub scene: Scene,
    /// How often the program was run.
    pub runs: u32,
    /// Whether no single attempt makes it smaller; else the search was stopped.
    pub is_minimal: bool,
    /// The values that differ, where they may be told.
    pub differs: Option<String>,
    /// The reference's computation for the pair that tells most, where that may be told.
    pub by_hand: Option<(Pair, String)>,
    /// The file with the scene, if it was written.
    pub file: Option<String>,
}

impl SmallestReport {
    /// Returns the size and the origin of the scene, in a sentence.
    #[must_use]
    pub fn title(&self) -> String {
        let bodies = match self.scene.particles.len() {
            1 => "1 body".to_owned(),
            count => format!("{count} bodies"),
        };
        let steps = counted(self.scene.steps().into(), "step");
        let runs = counted(self.runs.into(), "run");
        let end = if self.is_minimal { "" } else { "; the search was stopped" };
        format!("The smallest scene: {bodies}, {steps} (made from {} in {runs}{end})", self.case.scene)
    }

    /// Returns the scene as a file.
    #[must_use]
    pub fn xml(&self) -> String {
        scene::write(&self.scene)
    }

    /// Renders the report for people.
    #[must_use]
    pub fn text(&self, style: Style) -> String {
        let heading = |words: &str| format!("{}\n", style.paint(Look::Strong, words));
        let mut parts = vec![heading(&self.title())];
        parts[0].extend(self.causes().iter().map(|line| format!("  {line}\n")));
        parts.push(self.xml());
        parts.extend(self.differs.clone());
        parts.extend(self.by_hand.iter().map(|(_, text)| format!("{}{text}", heading("By hand"))));
        let commands = self.commands().into_iter().map(|line| format!("  $ {line}\n"));
        parts.push(heading("Next") + &commands.collect::<String>());
        parts.join("\n")
    }

    /// Returns why the program is wrong on it, a line each.
    fn causes(&self) -> Vec<String> {
        let Case { note, first, explanations, .. } = &self.case;
        let told = lines(&explanations[..explanations.len().min(1)]);
        let first = first.as_ref().filter(|_| told.is_empty()).map(first_divergence);
        note.iter().cloned().chain(first).chain(told).collect()
    }

    /// Returns commands that run the program on the scene and look closer.
    fn commands(&self) -> Vec<String> {
        let (scene, program) = (self.file.as_deref().unwrap_or("small.xml"), &self.case.trace);
        let mut all = vec![
            format!("{program} -s {scene} -d 0 -o small.bin"),
            format!("fosssim-oracle check {scene} small.bin --all"),
        ];
        all.extend(self.by_hand.iter().map(|(pair, _)| {
            let pair = pair_key(*pair);
            format!("fosssim-oracle detect --scene {scene} --trace small.bin --step 1 --pair {pair}")
        }));
        if self.file.is_none() {
            all.insert(0, format!("fosssim-oracle shrink {program} --output {scene}"));
        }
        all
    }
}

view! {
    /// The smallest scene on which a program is still wrong for the same reason.
    #[schemars(deny_unknown_fields)]
    pub(crate) struct SmallestView from report: SmallestReport {
        /// The scene that it was made from.
        origin: String = report.case.scene.clone(),
        /// The scene, as a file.
        scene: String = report.xml(),
        /// How often the program was run.
        runs: u32 = report.runs,
        /// Whether no single attempt makes it smaller; false where the search was stopped.
        minimal: bool = report.is_minimal,
        /// How the program ended, where it did not end well.
        note: Option<String> = report.case.note.clone(),
        /// The first thing that is wrong; null where nothing is, and where it may not be told.
        first_divergence: Option<FindingView> = match &report.case.first {
            Some(DisclosedFinding::Full(finding)) => Some(FindingView::by(Book::Fair, finding)),
            Some(DisclosedFinding::Place { .. }) | None => None,
        },
        /// Likely mistakes, the likeliest first.
        explanations: Vec<ExplanationView> = report.case.explanations.iter().map(ExplanationView::from).collect(),
        /// The computation of the pair that tells most, as `detect` prints it; null where it may not be told.
        by_hand: Option<String> = report.by_hand.as_ref().map(|(_, text)| text.clone()),
    }
}
