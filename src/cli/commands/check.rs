//! `check`: grades a trace.
use super::headroom;
use crate::{
    cli::{
        arguments::{Check, Format},
        console, exit, input,
        output::Output,
    },
    judge::{Rules, Stop, Unreadable, parity},
    report::{self, style::Style},
    sim::{RootSearch, StepError},
};
use anyhow::{Result, bail};

pub(super) fn run(arguments: &Check) -> Result<u8> {
    if let Some(scenes) = &arguments.own {
        return headroom::run(scenes, arguments);
    }
    // The parser has seen to it that both are there.
    let (Some(scene), Some(trace)) = (&arguments.scene, &arguments.trace) else { bail!("name a scene and a trace") };
    let scene = input::scene(scene)?;
    let mut trace = input::trace(trace)?;
    let inputs: Vec<_> = scene.identity.into_iter().chain(trace.identity).collect();
    // An output that can't be written is said before the work is done, not after.
    let target = arguments.output.as_deref().map(|name| Output::create(name, &inputs)).transpose()?;
    let rules: Rules = arguments.rules.into();
    let options = parity::Options {
        threads: arguments.threads.map_or(0, |threads| threads.get().min(8)),
        root_search: if arguments.audit { RootSearch::Audit } else { RootSearch::WhereNeeded },
        fair: rules.ask_fair(),
        ..parity::Options::default()
    };
    let mut bar = console::Bar::new(scene.scene.steps());
    let outcome = parity::judge(&scene.scene, &mut trace.reader, &options, &mut bar);
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
    let (scene, trace) = (scene.name.as_str(), trace.name.as_str());
    let check = report::check::Check { scene, trace, outcome: &outcome, rules, audit: arguments.audit };
    let style = if target.is_some() { Style::Plain } else { console::style() };
    let text = match arguments.format {
        Format::Text => check.text(style),
        Format::Json => check.json(),
    };
    match target {
        Some(target) => target.finish_with(text.as_bytes())?,
        None => console::print(text.as_bytes())?,
    }
    let disagreements = outcome.searches.disagreements;
    if disagreements > 0 {
        bail!("{disagreements} disagreements between certificates and the root finder; please report this");
    }
    Ok(if check.accepted() { exit::ACCEPTED } else { exit::NOT_ACCEPTED })
}
