//! The command `shrink`, which finds the smallest scene on which a program is still wrong for the same reason.
use super::probes::{Drawing, ExaminedProgram, ProgramUnderTest, describe_end, judge_case, named_tasks, report};
use crate::{
    cli::{
        arguments::{ExplainFormat, ShrinkArguments},
        console, exit,
        output::Output,
    },
    diagnose::{Explanation, ExplanationTopic, is_named_in},
    judge::{Book, Finding, FindingDetail, Rules, replay},
    report::{
        calculation::first_step,
        case::Case,
        check::{Check, StepChoice, WrongSteps},
        diagnosis::Diagnosis,
        page::Card,
        style::Style,
        untrusted_text::quote,
    },
    scene::{self, Scene},
    shrink::{SmallScene, WrongReason, step_starts},
    suite::{
        config::Hints,
        disclosure::DisclosedFinding,
        failure_cause::FailureKind,
        smallest_scene::{
            MAX_BODIES, ShrinkLimits, Shrinker, ShrunkScene, SmallestScene, WrongScene, group_causes, shorten_limits,
        },
    },
    together::disclosure::limit_explanations,
};
use anyhow::{Result, bail};
use std::{path::Path, time::Duration};

pub(super) fn run(arguments: &ShrinkArguments) -> Result<u8> {
    let program = ProgramUnderTest::new(&arguments.program, arguments.suite.as_deref(), arguments.unsafe_no_sandbox)?;
    let (own, suite) = (program.list_tasks(&[])?, program.suite_tasks());
    let task_lists = if arguments.suite.is_some() { [suite, own] } else { [own, suite] };
    // If the chosen scene belongs to the suite or the milestone, all of these scenes are examined, to find the likely
    // mistakes. A scene in a file is examined alone.
    let is_chosen = |name: &str| arguments.scene.as_deref().is_none_or(|scene| Path::new(name) == scene);
    let chosen_tasks = task_lists.into_iter().find(|tasks| tasks.iter().any(|task| is_chosen(&task.name)));
    let mut tasks = match (chosen_tasks, &arguments.scene) {
        (None, Some(scene)) => named_tasks(std::slice::from_ref(scene))?,
        (tasks, _) => tasks.unwrap_or_default(),
    };
    tasks.retain(|task| task.scene.particles.len() <= MAX_BODIES);
    if tasks.is_empty() {
        bail!("`shrink` needs a scene with at most {MAX_BODIES} bodies");
    }
    let is_too_late = |scene: &Scene| arguments.step.is_some_and(|step| step > scene.step_count());
    if let Some(task) = tasks.iter().find(|task| is_chosen(&task.name) && is_too_late(&task.scene)) {
        bail!("the last step of {} is {}", task.name, task.scene.step_count());
    }
    let drawing = Drawing { hints: Hints::Full, has_pictures: false };
    let Some(mut examined) = program.examine(tasks, drawing)? else { return Ok(exit::INTERRUPTED) };
    if examined.diagnosis.cases.iter().all(|case| case.accepted || !is_chosen(&case.scene)) {
        console::report("Nothing is wrong by the fair rules on these scenes.\n")?;
        return Ok(exit::ACCEPTED);
    }
    let (runs, time, step) = (arguments.runs, Duration::from_secs(arguments.seconds.into()), arguments.step);
    let drawing = Drawing { has_pictures: arguments.format == ExplainFormat::Html, ..drawing };
    add_smallest(&program, &mut examined, ShrinkLimits { runs, time, step }, &is_chosen, drawing)?;
    for (small, number) in examined.diagnosis.smallest.iter().zip(1..) {
        let Some(name) = &arguments.output else { break };
        let further = name.with_extension(format!("{number}.xml"));
        Output::create(if number == 1 { name } else { &further }, &[])?.finish_with(small.xml.as_bytes())?;
    }
    if arguments.format != ExplainFormat::Json {
        examined.cards.drain(..examined.diagnosis.cases.len());
        examined.diagnosis = Diagnosis { smallest: examined.diagnosis.smallest, ..Diagnosis::default() };
    }
    report(&examined.diagnosis, &examined.cards, arguments.format, None)?;
    // If the user interrupts the search, the best scene so far has been reported.
    Ok(if program.cancellation.is_canceled() { exit::INTERRUPTED } else { exit::NOT_ACCEPTED })
}

/// Adds to a program's report the smallest scene for each cause, and its card. The scenes are made from those that
/// `is_chosen` selects.
pub(super) fn add_smallest(
    program: &ProgramUnderTest,
    examined: &mut ExaminedProgram,
    limits: ShrinkLimits,
    is_chosen: &dyn Fn(&str) -> bool,
    drawing: Drawing,
) -> Result<()> {
    let ExaminedProgram { diagnosis, cards, tasks, ends } = examined;
    let runs = diagnosis.cases.iter().zip(&*tasks).zip(&*ends);
    let runs = runs.filter(|((case, _), _)| !case.accepted && is_chosen(&case.scene));
    let wrong = runs.map(|((case, task), (ended, _))| WrongScene { task, explanations: &case.explanations, ended });
    let wrong: Vec<WrongScene<'_>> = wrong.collect();
    let (run_limits, name) = (shorten_limits(&program.run_limits()), program.program.display().to_string());
    let (runner, assignment) = (program.runner(&run_limits), program.assignment);
    let shrinker = Shrinker { runner, program: &program.program, assignment, limits };
    let causes = group_causes(&diagnosis.common, &wrong);
    let bar = console::Bar::for_runs(causes.len() as u64);
    let found =
        shrinker.shrink_causes(causes, &|| bar.next_run("making scenes smaller")).map_err(anyhow::Error::msg)?;
    for small in &found {
        let (small, card) = describe(small, &name, &program.suite, drawing);
        diagnosis.smallest.push(small);
        cards.push(card);
    }
    Ok(())
}

/// Describes a smallest scene for a report, and draws its card.
pub(super) fn describe(
    small: &ShrunkScene,
    program: &str,
    suite: &str,
    drawing: Drawing,
) -> (SmallestScene, Option<Card>) {
    let ShrunkScene { reason, origin, scene: SmallScene { scene, step, is_minimal }, observation: seen, .. } = small;
    let note = FailureKind::from_end(&seen.ended).and_then(|_| describe_end(&seen.ended, seen.trace.is_empty(), &[]));
    let names = ("small.xml".to_owned(), program.to_owned());
    let (case, card, _) = judge_case(names, false, scene, &seen.trace[..], note, drawing);
    // The card of a program that does not end normally, but whose steps are right, would show two equal motions.
    let card = card.filter(|_| case.note.is_none() || case.first.is_some());
    let Case { trace: program, note, first, explanations, .. } = case;
    let names = [program.as_str(), origin, suite].map(quote);
    let mut small = SmallestScene {
        origin: origin.clone(),
        command: format!("fosssim-oracle shrink {} {} --step {step} --suite {}", names[0], names[1], names[2]),
        program,
        xml: scene::to_xml(scene),
        bodies: scene.particles.len(),
        steps: scene.step_count(),
        runs: small.runs,
        is_minimal: *is_minimal,
        note,
        first_finding: first,
        explanations: match reason {
            WrongReason::Mistake(cause) if !cause.reports_non_finite_value() => {
                limit_explanations(drawing.hints, vec![add_example(cause, &explanations)])
            }
            _ => explanations,
        },
        ..SmallestScene::default()
    };
    if drawing.hints == Hints::Full {
        let has_example = small.explanations.first().is_some_and(|explanation| explanation.example.is_some());
        small.difference = list_differences(scene, &seen.trace, has_example);
        if let (None, Some(DisclosedFinding::Full(Finding { step, detail, .. }))) = (&small.note, &small.first_finding)
        {
            let single_step =
                step_starts(scene, &seen.trace, &[*step]).into_iter().find(|(_, scene)| scene.step_count() == 1);
            let pair = detail.pair().map(|pair| (pair, detail.pass()));
            small.calculation = single_step.and_then(|(_, scene)| first_step(&scene, pair, *step));
        }
    }
    (small, card)
}

/// Returns the explanation of the cause, but with the example from the smallest scene, and without parts of the cause
/// that this scene does not show.
fn add_example(cause: &Explanation, own: &[Explanation]) -> Explanation {
    let named_explanation = own.iter().find(|explanation| is_named_in(cause, std::slice::from_ref(explanation)));
    let example = named_explanation.or(own.first()).and_then(|explanation| explanation.example.clone());
    // If the cause is unwritten stages, the explanation lists the stages that the scene shows.
    let is_shown = |key: &&String| own.iter().any(|other| other.key == **key || other.same_as.contains(key));
    let same_as = cause.same_as.iter().filter(|key| cause.is_unfinished() && is_shown(key)).cloned().collect();
    let mut topic = cause.topic.clone();
    let details = match (&mut topic, named_explanation) {
        // Many formulas agree with a single wrong polynomial.
        (ExplanationTopic::Polynomials { .. }, _) if cause.samples < 2 => Vec::new(),
        // The numbers that describe a wrong stage are those of this scene.
        (ExplanationTopic::Stage(_), Some(own)) if own.names_stage() => own.details.clone(),
        (ExplanationTopic::Pairs(all), Some(Explanation { topic: ExplanationTopic::Pairs(own), .. })) => {
            all.limit_to(own);
            cause.details.clone()
        }
        _ => cause.details.clone(),
    };
    Explanation { example, topic, details, reproduced: 0, samples: 0, same_as, ..cause.clone() }
}

/// Returns the values that differ in the wrong steps, as text, if there are any. With `has_example`, a single
/// coefficient that is compared after scaling is left out, because the example shows the polynomials unscaled.
fn list_differences(scene: &Scene, trace: &[u8], has_example: bool) -> Option<String> {
    let mut steps = WrongSteps::new(StepChoice::All);
    let options = replay::Options { threads: 1, uses_fair_rules: true, ..replay::Options::default() };
    let outcome = &replay::judge(scene, trace, &options, &mut steps);
    let findings = outcome.findings_by(Book::Fair);
    let is_scaled = |finding: &Finding| match &finding.detail {
        FindingDetail::Coefficient { power, expected, expected_polynomial, .. } => {
            expected_polynomial.coefficients().iter().rev().nth(*power) != Some(expected)
        }
        _ => false,
    };
    if has_example && findings.counts.total() == 1 && findings.first_divergence.as_ref().is_some_and(is_scaled) {
        return None;
    }
    let (looks_like, rules, steps) = (None, Rules::Fair, &steps);
    let (scene, trace, explanations) = ("small.xml", "small.bin", &[][..]);
    let check = Check { scene, trace, outcome, explanations, rules, steps, other_file_kind: looks_like };
    check.steps_text(Style::Plain)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        diagnose::{Detail, PairCounts, PolynomialEvidence, StageFault, WrongPairs},
        sim::PairKind,
    };

    /// A scene that shows a single missing pair does not show what all missing pairs have in common.
    #[test]
    fn missing_pairs_are_described_by_all_scenes() {
        let pairs = |times| {
            let counts = PairCounts { kind: PairKind::ParticleParticle, counts_by_times: times, traits: Vec::new() };
            ExplanationTopic::Pairs(WrongPairs { first: None, counts_by_kind: vec![counts] })
        };
        let [cause, own] =
            [[137, 304, 0], [1, 0, 0]].map(|times| Explanation::with_topic(Explanation::PAIRS, pairs(times)));
        assert_eq!(add_example(&cause, &[own]).topic, cause.topic);
        let twice = Explanation::with_topic(Explanation::PAIRS, pairs([1, 304, 2]));
        let shown = Explanation::with_topic(Explanation::PAIRS, pairs([0, 0, 1]));
        assert_eq!(add_example(&twice, &[shown]).topic, pairs([0, 304, 2]));
    }

    #[test]
    fn only_unwritten_stages_that_the_scene_shows_are_listed() {
        let keys = |keys: &[&str]| keys.iter().map(|&key| key.to_owned()).collect::<Vec<String>>();
        let unfinished = Explanation::with_topic(Explanation::UNFINISHED, ExplanationTopic::Unfinished);
        let cause = Explanation { same_as: keys(&["ph-zero", "loop-empty", "failsafe-empty"]), ..unfinished };
        let own = Explanation {
            same_as: keys(&["pp-empty", "loop-empty"]),
            ..Explanation::with_topic("failsafe-empty", ExplanationTopic::Mistake)
        };
        assert_eq!(add_example(&cause, &[own]).same_as, keys(&["loop-empty", "failsafe-empty"]));
    }

    #[test]
    fn what_a_wrong_stage_does_is_measured_in_the_scene() {
        let turned = |ratio: &'static str| Explanation {
            details: vec![Detail::Term(ratio.into())],
            ..Explanation::with_topic("stage", ExplanationTopic::Stage(StageFault::AfterRounds))
        };
        assert_eq!(add_example(&turned("0.9992"), &[turned("0.8967")]).details, turned("0.8967").details);
    }

    #[test]
    fn fits_of_a_single_sample_are_not_shown() {
        let wrong = Explanation::for_wrong_polynomials(Vec::new(), PolynomialEvidence::Nothing);
        let fitted = |samples| Explanation { samples, details: vec![Detail::Term("x".into())], ..wrong.clone() };
        assert_eq!([1, 2].map(|samples| add_example(&fitted(samples), &[]).details.len()), [0, 1]);
    }
}
