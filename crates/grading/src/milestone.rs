//! Infers the milestone for which a program was written, from the scenes that it accepts. A starter library exits with
//! an error if it does not support an integrator or a collision type, no matter what its student wrote.
use super::{config::RunLimits, runner::Runner, task::SceneTask};
use fosssim_model::{
    assignments::{Assignment, Integrator},
    scene,
};
use fosssim_sandbox::RunEnd;
use std::{path::Path, time::Duration};

/// The limits of processor time and wall time for a scene with two steps and two bodies. A program needs only a few
/// milliseconds for it.
const TIME_LIMITS: [Duration; 2] = [Duration::from_millis(500), Duration::from_secs(2)];

/// Returns the milestone whose library accepts exactly the scenes that this program accepts; `None` if no milestone
/// fits, or if the program never writes a trace. The program is run six times, on scenes of two bodies that do not
/// meet.
///
/// # Errors
///
/// Fails if the grader or the machine fails. The error is the reason, as text.
pub fn infer_milestone(runner: &Runner<'_>, program: &Path) -> Result<Option<Assignment>, String> {
    let [cpu, wall] = TIME_LIMITS;
    let limits = RunLimits { cpu: runner.limits.cpu.min(cpu), wall: runner.limits.wall.min(wall), ..*runner.limits };
    let runner = Runner { limits: &limits, ..*runner };
    let mut is_traced = false;
    let mut accepts = |integrator: Integrator, collision: &str| -> Result<bool, String> {
        let (trace, outcome) = runner.collect_trace(program, &probe_task(integrator, collision)?, 1)?;
        is_traced |= !trace.is_empty();
        // If the program crashes, it has accepted the scene.
        Ok(!matches!(outcome.ended, RunEnd::Exited(1..)))
    };
    let mut integrators = Vec::new();
    for integrator in Integrator::ALL {
        if accepts(integrator, "")? {
            integrators.push(integrator);
        }
    }
    let accepts_collisions = accepts(Integrator::ExplicitEuler, "<collision type=\"continuous-time\" COR=\"1\"/>")?;
    let is_match = |assignment: &Assignment| {
        let library = &assignment.definition().library;
        let has_integrator = |integrator: &Integrator| library.integrators.contains(integrator);
        library.rejects_collisions != accepts_collisions
            && Integrator::ALL.iter().all(|integrator| has_integrator(integrator) == integrators.contains(integrator))
    };
    Ok(Assignment::list_default_first().into_iter().find(|assignment| is_traced && is_match(assignment)))
}

/// Returns whether the library of the milestone `found` lacks integrators or collision types that scenes of `expected`
/// use.
pub fn lacks(found: Assignment, expected: Assignment) -> bool {
    let (found, expected) = (&found.definition().library, &expected.definition().library);
    expected.integrators.iter().any(|integrator| !found.integrators.contains(integrator))
        || expected.collisions.iter().any(|collision| !found.collisions.contains(collision))
}

/// Creates a scene of two steps with the given integrator and collision element.
fn probe_task(integrator: Integrator, collision: &str) -> Result<SceneTask, String> {
    let xml = format!(
        "<scene><duration time=\"0.02\"/><integrator type=\"{}\" dt=\"0.01\"/>{collision}\
         <particle m=\"1\" px=\"0\" py=\"0\" vx=\"1\" vy=\"0\" fixed=\"0\" radius=\"0.1\"/>\
         <particle m=\"1\" px=\"5\" py=\"0\" vx=\"0\" vy=\"1\" fixed=\"0\" radius=\"0.1\"/></scene>",
        integrator.name()
    );
    let scene = scene::read("milestone", xml.as_bytes()).map_err(|error| error.to_string())?.scene;
    Ok(SceneTask { name: "milestone".to_owned(), xml: xml.into_bytes(), scene, recording: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_knows_more_is_of_no_other_milestone() {
        use Assignment::{T1M1, T1M3, T2M1, T2M2, T2M3};
        for (found, expected) in [(T1M1, T1M3), (T1M3, T2M2), (T1M3, T2M1), (T2M1, T2M2), (T2M3, T2M2)] {
            assert!(lacks(found, expected), "{found:?} for {expected:?}");
        }
        for (found, expected) in [(T2M2, T1M3), (T2M1, T1M3), (T1M3, T1M1), (T2M2, T2M3), (T2M2, T2M2)] {
            assert!(!lacks(found, expected), "{found:?} for {expected:?}");
        }
    }
}
