//! Runs that never happened: scripted for tests, or decided before anything was started.

use std::{sync::Arc, time::Duration};

use super::{
    job::Job,
    layers::LayerReport,
    outcome::{Captured, Ended, RunOutcome, StartProblem},
    running::Running,
};

/// The answer of a fake run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FakeRun {
    /// How it ended.
    pub ended: Ended,
    /// The bytes from the trace pipe, if the job has one.
    pub trace: Vec<u8>,
    /// Standard output.
    pub stdout: Vec<u8>,
    /// Standard error.
    pub stderr: Vec<u8>,
    /// Processor time; the clock shows the same.
    pub cpu: Duration,
    /// Peak memory in bytes.
    pub peak_memory: u64,
}

impl FakeRun {
    /// A run that ended like this and wrote nothing.
    #[must_use]
    pub fn ended(ended: Ended) -> Self {
        Self { ended, trace: Vec::new(), stdout: Vec::new(), stderr: Vec::new(), cpu: Duration::ZERO, peak_memory: 0 }
    }

    /// A run that exited with code 0 and wrote this trace.
    #[must_use]
    pub fn wrote(trace: impl Into<Vec<u8>>) -> Self {
        Self { trace: trace.into(), ..Self::ended(Ended::Exited(0)) }
    }

    /// A program that never ran.
    pub(super) fn could_not_start(problem: StartProblem) -> Self {
        Self::ended(Ended::CouldNotStart(problem))
    }

    pub(super) fn into_running(self, job: &Job, layers: Arc<[LayerReport]>) -> Running {
        let outcome = RunOutcome {
            ended: self.ended,
            cpu: self.cpu,
            wall: self.cpu,
            peak_memory: self.peak_memory,
            bytes_written: (self.trace.len() + self.stdout.len() + self.stderr.len()) as u64,
            stdout: Captured { bytes: self.stdout, truncated: false },
            stderr: Captured { bytes: self.stderr, truncated: false },
            layers,
        };
        Running::known(outcome, job.trace_pipe.is_some().then_some(self.trace), job.limits.trace_bytes)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;
    use crate::{Backend, Limits, TraceTooLong};

    #[test]
    fn a_fake_answers_as_scripted_for_each_job() {
        let backend = Backend::fake(|job| match job.trace_pipe {
            Some(_) => FakeRun::wrote(*b"frames"),
            None => FakeRun::ended(Ended::WallLimit),
        });
        let job = Job::new("program", "folder");
        assert_eq!(backend.start(&job).unwrap().wait().unwrap().ended, Ended::WallLimit);
        let mut running = backend.start(&job.trace_pipe("trace.bin")).unwrap();
        let mut bytes = Vec::new();
        running.trace().unwrap().read_to_end(&mut bytes).unwrap();
        assert_eq!(bytes, b"frames");
        assert!(running.trace().is_none(), "the trace is handed out once");
        assert_eq!(running.wait().unwrap().ended, Ended::Exited(0));
    }

    #[test]
    fn a_trace_is_cut_at_its_limit_to_the_byte() {
        let backend = Backend::fake(|_| FakeRun::wrote(*b"frames"));
        let limits = |trace_bytes| Limits { trace_bytes, ..Limits::default() };
        let read = |trace_bytes| {
            let job = Job::new("program", "folder").trace_pipe("t").limits(limits(trace_bytes));
            let mut bytes = Vec::new();
            let result = backend.start(&job).unwrap().trace().unwrap().read_to_end(&mut bytes);
            (bytes, result.err().map(|error| *error.get_ref().unwrap().downcast_ref::<TraceTooLong>().unwrap()))
        };
        assert_eq!(read(6), (b"frames".to_vec(), None));
        assert_eq!(read(5), (b"frame".to_vec(), Some(TraceTooLong { limit: 5 })));
        assert_eq!(read(0), (Vec::new(), Some(TraceTooLong { limit: 0 })));
    }

    #[test]
    fn a_trace_beyond_its_limit_is_one_whoever_ended_first() {
        for ended in [Ended::Exited(0), Ended::Exited(1), Ended::Signalled(13), Ended::CpuLimit, Ended::WallLimit] {
            let ending = ended.clone();
            let backend = Backend::fake(move |_| FakeRun { ended: ending.clone(), ..FakeRun::wrote(*b"frames") });
            let end = |trace_bytes| {
                let limits = Limits { trace_bytes, ..Limits::default() };
                backend.start(&Job::new("program", "folder").trace_pipe("t").limits(limits)).unwrap().wait().unwrap()
            };
            assert_eq!(end(5).ended, Ended::OutputLimit(crate::Stream::Trace), "{ended:?}");
            assert_eq!(end(6).ended, ended);
        }
        let cancelled = Backend::fake(|_| FakeRun { ended: Ended::Cancelled, ..FakeRun::wrote(*b"frames") });
        let job = Job::new("program", "folder").trace_pipe("t").limits(Limits { trace_bytes: 5, ..Limits::default() });
        assert_eq!(cancelled.start(&job).unwrap().wait().unwrap().ended, Ended::Cancelled);
    }

    /// A reader that wants no more than the limit never meets it, whatever lies behind.
    #[test]
    fn the_limit_is_met_only_by_who_reads_on() {
        let backend = Backend::fake(|_| FakeRun::wrote(*b"frames and more"));
        let limits = Limits { trace_bytes: 6, ..Limits::default() };
        let mut running = backend.start(&Job::new("program", "folder").trace_pipe("t").limits(limits)).unwrap();
        let mut trace = running.trace().unwrap();
        let mut buffer = [0; 64];
        assert_eq!(trace.read(&mut buffer).unwrap(), 6);
        drop(trace);
        assert_eq!(running.wait().unwrap().ended, Ended::Exited(0));
    }
}
