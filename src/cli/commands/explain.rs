//! The command `explain`, which names the likely mistakes of a program, from its trace or by running it.
use super::{
    probes::{Drawing, ExaminedProgram, ProgramUnderTest, judge_case, report},
    shrink,
};
use crate::{
    assignments::Assignment,
    cli::{
        arguments::{ExplainArguments, ExplainFormat},
        console, exit, input,
        output::Output,
    },
    judge::kept_trace::MAX_KEPT_BYTES,
    report::{case::Case, diagnosis::Diagnosis, page::Card},
    suite::smallest_scene::QUICK_LIMITS,
};
use anyhow::{Result, bail};
use std::{
    io::{self, Read},
    path::{Path, PathBuf},
};

pub(super) fn run(arguments: &ExplainArguments) -> Result<u8> {
    let target = arguments.output.as_deref().map(|name| Output::create(name, &[])).transpose()?;
    let (diagnosis, cards) = match (&arguments.program, &arguments.inputs[..]) {
        (Some(program), scenes) => match explain_program(program, scenes, arguments)? {
            Some(explained) => (explained.diagnosis, explained.cards),
            None => return Ok(exit::INTERRUPTED),
        },
        (None, [scene, trace]) => {
            let (case, card) = explain_trace(scene, trace, arguments)?;
            (Diagnosis { cases: vec![case], ..Diagnosis::default() }, vec![card])
        }
        (None, _) => bail!("explain takes a scene and a trace, or --program PROGRAM and any number of scenes"),
    };
    report(&diagnosis, &cards, arguments.format, target)?;
    Ok(if diagnosis.is_accepted() { exit::ACCEPTED } else { exit::NOT_ACCEPTED })
}

/// Runs a program on scenes that make every term of every formula visible, and also on the given scenes. Returns `None`
/// if the user stopped it.
fn explain_program(
    program: &Path,
    scenes: &[PathBuf],
    arguments: &ExplainArguments,
) -> Result<Option<ExaminedProgram>> {
    let suite = arguments.suite.map(Assignment::key);
    let program = ProgramUnderTest::new(program, suite, arguments.unsafe_no_sandbox)?;
    let mut explained = program.examine(program.list_tasks(scenes)?, drawing(arguments))?;
    if let Some(explained) = &mut explained {
        shrink::add_smallest(&program, explained, QUICK_LIMITS, &|_| true, drawing(arguments))?;
    }
    let is_traceless = |(_, steps): &(_, u32)| *steps == 0;
    if suite.is_some() && explained.as_ref().is_some_and(|all| all.ends.iter().all(is_traceless)) {
        console::print_remark(
            "if the program belongs to another milestone, omit --suite: the milestone is then inferred\n",
        );
    }
    Ok(explained)
}

fn drawing(arguments: &ExplainArguments) -> Drawing {
    Drawing { hints: arguments.hints, has_pictures: arguments.format == ExplainFormat::Html }
}

fn explain_trace(scene: &Path, trace: &Path, arguments: &ExplainArguments) -> Result<(Case, Option<Card>)> {
    let scene = input::read_scene(scene)?;
    let mut trace = input::open_trace(trace)?;
    if let Some(kind) = trace.probable_kind {
        bail!("{} is not a trace: it {kind}", trace.name);
    }
    let (case, card, _) =
        judge_case((scene.name, trace.name.clone()), true, &scene.scene, &mut trace.reader, None, drawing(arguments));
    // Bytes after the last step matter only if they cannot be read.
    let _ = io::copy(&mut (&mut trace.reader).take(MAX_KEPT_BYTES as u64), &mut io::sink());
    trace.ensure_not_failed()?;
    Ok((case, card))
}
