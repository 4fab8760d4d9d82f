//! `check`: grades a trace.
use super::{
    headroom,
    pages::{focus, what_if},
};
use crate::{
    cli::{
        arguments::{Check, CheckFormat},
        console, exit, input,
        output::Output,
    },
    diagnose::{self, Keep, examine},
    evidence::{self, StepRulings},
    judge::{
        Outcome, Overall, Rules, Stop, Unreadable, fair,
        replay::{self, Progress, Remark, WrongStep},
    },
    report::{
        self,
        check::{StepChoice, WrongSteps},
        number::counted,
        page,
        style::Style,
    },
    sim::{RootSearch, StepError},
    suite::config::Hints,
};
use anyhow::{Context, Result, bail};
use std::{io::Read, path::Path};

pub(super) fn run(arguments: &Check) -> Result<u8> {
    if let Some(scenes) = &arguments.own {
        return headroom::run(scenes, arguments);
    }
    // The parser has seen to it that both are there.
    let (Some(scene), Some(name)) = (&arguments.scene, &arguments.trace) else { bail!("name a scene and a trace") };
    let scene = input::scene(scene)?;
    let mut trace = input::trace(name)?;
    let inputs: Vec<_> = scene.identity.into_iter().chain(trace.identity).collect();
    // An output that can't be written is said before the work is done, not after.
    let target = arguments.output.as_deref().map(|name| Output::create(name, &inputs)).transpose()?;
    let rules: Rules = arguments.rules.into();
    let options = replay::Options {
        threads: arguments.threads.map_or(0, |threads| threads.get().min(8)),
        root_search: if arguments.audit { RootSearch::Audit } else { RootSearch::WhereNeeded },
        fair: rules.ask_fair(),
        ..replay::Options::default()
    };
    let steps = scene.scene.steps();
    if let Some(step) = arguments.step.iter().find(|step| **step > steps) {
        bail!("the scene {} has {}; there is no step {step}", scene.name, counted(steps.into(), "step"));
    }
    let shown = if arguments.all {
        StepChoice::All
    } else if arguments.step.is_empty() {
        StepChoice::None
    } else {
        StepChoice::These(arguments.step.clone())
    };
    let mut heard = Heard { bar: console::Bar::new(steps), wrong: WrongSteps::new(shown) };
    let lasting = is_lasting(name);
    let explain = !arguments.no_explain && arguments.step.is_empty();
    let is_page = arguments.format == CheckFormat::Html;
    let pictures = console::pictures().filter(|_| arguments.format == CheckFormat::Text && target.is_none());
    let pictures = pictures.filter(|_| arguments.step.is_empty());
    let draws = is_page || pictures.is_some();
    // A file that is there later, too, is read again if it comes to that: most traces are right.
    let is_short_file = lasting && trace.length.is_some_and(|length| length <= Keep::EXPLAINED.most as u64);
    let is_kept = if explain { !is_short_file } else { draws && !lasting };
    let most = if is_kept { Keep::EXPLAINED.most } else { 0 };
    // The program that writes a pipe may write no more.
    let keep = Keep { most, reads_on: lasting };
    let mut rulings = StepRulings::new(&mut heard);
    let examined = examine(&scene.scene, &mut trace.reader, keep, &options, &mut rulings);
    let outcome = &examined.outcome;
    let rulings = if draws { rulings.into_steps(outcome) } else { Vec::new() };
    let Heard { bar, wrong } = heard;
    drop(bar);
    match &outcome.stop {
        Some(Stop::Step(StepError::VortexHessian { .. })) => bail!(
            "the scene {} has a vortexforce, which has no Hessian: choose an integrator that is not implicit",
            scene.name
        ),
        // Further steps may or may not have been read by then: what failed there is not asked for.
        Some(Stop::Step(_)) => {}
        stop => {
            // Bytes that are missing inside polynomials do not stop the original, but may be missing only here.
            if let Some(message) = trace.failure() {
                let place = match stop {
                    Some(Stop::Trace { cause: Unreadable::Io, offset, .. }) => format!(" at byte {offset}"),
                    _ => String::new(),
                };
                bail!("cannot read the trace {}{place}: {message}", trace.name);
            }
        }
    }
    let content = &scene.scene;
    let mut again = Vec::new();
    let explanations = match explain && is_wrong(outcome) {
        true if is_short_file => {
            let file = input::trace(name)?.reader;
            file.take(Keep::EXPLAINED.most as u64)
                .read_to_end(&mut again)
                .with_context(|| format!("cannot read the trace {} again", trace.name))?;
            diagnose::explain(content, &again)
        }
        true => examined.explain(),
        false => Vec::new(),
    };
    let (scene, shown) = (scene.name.as_str(), trace.name.as_str());
    let check = report::check::Check {
        scene,
        trace: shown,
        outcome,
        explanations: &explanations,
        rules,
        steps: &wrong,
        audit: arguments.audit,
        tables: arguments.tables,
        looks_like: trace.looks_like,
    };
    let style = if target.is_some() { Style::Plain } else { console::style() };
    let evidence = || {
        let (fair, focus, budget) = (outcome.fair.is_some(), focus(outcome), evidence::BUDGET);
        match if lasting { input::trace(name).ok() } else { None } {
            Some(whole) => evidence::gather(content, whole.reader, &rulings, fair, &focus, budget),
            None => evidence::gather(content, examined.trace.beginning(), &rulings, fair, &focus, budget),
        }
    };
    let text = match arguments.format {
        CheckFormat::Text => match pictures {
            Some(columns) if !check.accepted() => {
                let plots = report::check::plots(&evidence(), columns);
                let gap = if plots.is_empty() { "" } else { "\n" };
                check.text(style) + gap + &plots
            }
            _ => check.text(style),
        },
        CheckFormat::Json => check.json(),
        CheckFormat::Github => check.github(),
        CheckFormat::Html => {
            let evidence = evidence();
            let bytes = if is_short_file { again } else { examined.trace.bytes(Keep::EXPLAINED.most) };
            let what_if = explanations.first().and_then(|first| what_if(content, first, &bytes, &evidence));
            let hints = Hints::Full;
            let case = page::Case {
                check,
                scene: content,
                evidence: Some(&evidence),
                what_if: what_if.as_ref(),
                hints,
                has_trace: true,
            };
            page::Page { title: &format!("{}: {scene}", check.verdict()), cases: vec![case] }.html()
        }
    };
    match (target, arguments.format) {
        (Some(target), _) => target.finish_and_tell(text.as_bytes(), is_page)?,
        (None, CheckFormat::Text) => console::report(&text)?,
        (None, _) => console::print(text.as_bytes())?,
    }
    let disagreements = outcome.searches.disagreements;
    if disagreements > 0 {
        bail!("{disagreements} disagreements between certificates and the root finder; please report this");
    }
    Ok(if check.accepted() { exit::ACCEPTED } else { exit::NOT_ACCEPTED })
}

/// Shows how far judging is, and gathers the wrong steps.
struct Heard {
    bar: console::Bar,
    wrong: WrongSteps,
}

impl Progress for Heard {
    fn step_judged(&mut self, step: u32, remarks: &[Remark]) {
        self.bar.step_judged(step, remarks);
    }

    fn step_wrong(&mut self, wrong: &WrongStep<'_>) {
        self.wrong.step_wrong(wrong);
    }
}

/// Whether there is something to explain: the fair rules know better what is a mistake.
fn is_wrong(outcome: &Outcome) -> bool {
    match &outcome.fair {
        Some(fair) => fair.verdict == fair::FairVerdict::Rejected,
        None => outcome.parity.overall != Overall::Passed,
    }
}

/// Whether a trace can be read a second time: then it need not be kept while it is judged.
fn is_lasting(name: &Path) -> bool {
    name != Path::new("-") && !std::fs::metadata(name).is_ok_and(|data| !data.is_file())
}
