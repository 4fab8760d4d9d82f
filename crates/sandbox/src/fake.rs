//! Simulates runs: those that a test scripts, and those whose outcome is known before anything is started.

use std::{sync::Arc, time::Duration};

use super::{
    job::Job,
    job_files,
    layers::LayerReport,
    outcome::{CapturedOutput, RunEnd, RunOutcome, StartProblem},
    running_program::RunningProgram,
    sandbox_error::SandboxError,
};

/// The result of a simulated run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FakeRun {
    /// The result of the run.
    pub ended: RunEnd,
    /// The trace that the run writes, if the job has a trace. It writes none if this is empty.
    pub trace: Vec<u8>,
    /// The standard output.
    pub stdout: Vec<u8>,
    /// The standard error.
    pub stderr: Vec<u8>,
    /// The processor time of the run, which is also its wall time.
    pub cpu: Duration,
    /// The peak memory in bytes.
    pub peak_memory: u64,
}

impl FakeRun {
    /// Returns a run that ended with `ended` and wrote nothing at all.
    pub fn with_end(ended: RunEnd) -> Self {
        Self { ended, trace: Vec::new(), stdout: Vec::new(), stderr: Vec::new(), cpu: Duration::ZERO, peak_memory: 0 }
    }

    /// Returns a run that exited with code 0 after writing `trace`.
    pub fn with_trace(trace: impl Into<Vec<u8>>) -> Self {
        Self { trace: trace.into(), ..Self::with_end(RunEnd::Exited(0)) }
    }

    /// Returns a run whose program could not be started.
    pub(super) fn with_start_problem(problem: StartProblem) -> Self {
        Self::with_end(RunEnd::CouldNotStart(problem))
    }

    pub(super) fn into_running(self, job: &Job, layers: Arc<[LayerReport]>) -> Result<RunningProgram, SandboxError> {
        if let Some(name) = job.trace.as_ref().filter(|_| !self.trace.is_empty()) {
            job_files::write_file(job, name, &self.trace)?;
        }
        let is_over = self.trace.len() as u64 > job.limits.trace_bytes && self.ended != RunEnd::Canceled;
        let outcome = RunOutcome {
            ended: if is_over { RunEnd::TraceLimit } else { self.ended },
            cpu: self.cpu,
            wall: self.cpu,
            peak_memory: self.peak_memory,
            stdout: CapturedOutput { bytes: self.stdout, truncated: false },
            stderr: CapturedOutput { bytes: self.stderr, truncated: false },
            layers,
        };
        Ok(RunningProgram::from_outcome(outcome, job.folder.clone()))
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;
    use crate::{Backend, Limits};

    #[test]
    fn a_fake_answers_as_scripted_for_each_job() {
        let backend = Backend::fake(|job| match job.trace {
            Some(_) => FakeRun::with_trace(*b"frames"),
            None => FakeRun::with_end(RunEnd::WallLimit),
        });
        let folder = tempfile::tempdir().unwrap();
        let job = Job::new("program", folder.path());
        assert_eq!(backend.start(&job).unwrap().wait().unwrap().ended, RunEnd::WallLimit);
        let (outcome, left) = backend.start(&job.trace("trace.bin")).unwrap().wait_with_folder().unwrap();
        let mut bytes = Vec::new();
        left.regular_file("trace.bin", 6).unwrap().0.read_to_end(&mut bytes).unwrap();
        assert_eq!((outcome.ended, bytes.as_slice()), (RunEnd::Exited(0), &b"frames"[..]));
    }

    #[test]
    fn a_trace_beyond_its_limit_is_one_whoever_ended_first() {
        let folder = tempfile::tempdir().unwrap();
        for (ended, beyond) in [
            (RunEnd::Exited(1), RunEnd::TraceLimit),
            (RunEnd::WallLimit, RunEnd::TraceLimit),
            (RunEnd::Canceled, RunEnd::Canceled),
        ] {
            let ending = ended.clone();
            let backend = Backend::fake(move |_| FakeRun { ended: ending.clone(), ..FakeRun::with_trace(*b"frames") });
            let end = |trace_bytes| {
                let limits = Limits { trace_bytes, ..Limits::default() };
                backend.start(&Job::new("program", folder.path()).trace("t").limits(limits)).unwrap().wait().unwrap()
            };
            assert_eq!(end(5).ended, beyond);
            assert_eq!(end(6).ended, ended);
        }
    }
}
