//! One submission at work: staged once, by the first job that has to run it, and until its last scene is done.
use super::{Batch, Submission};
use crate::{
    grade::SceneResult,
    patience::{self, Reason},
    staging::{self, Staged, StagingError},
    verdict::Verdict,
};
use std::{
    path::Path,
    sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError},
    time::Duration,
};

/// What jobs share about a submission.
pub(super) struct Work {
    /// The digest of the program as it lies there; none for what has to be built or copied first.
    digest: OnceLock<Option<blake3::Hash>>,
    staged: Mutex<Option<Arc<Result<Staged, String>>>>,
    progress: Mutex<Progress>,
}

struct Progress {
    /// Verdict and wall time of every scene that is done.
    known: Vec<Option<(Verdict, Duration)>>,
    /// The first scene that is not run any more, and why.
    end: Option<(usize, Reason)>,
}

impl Work {
    /// A submission with so many scenes.
    pub(super) fn new(scenes: usize) -> Self {
        Self {
            digest: OnceLock::new(),
            staged: Mutex::default(),
            progress: Mutex::new(Progress { known: vec![None; scenes], end: None }),
        }
    }

    /// Why this scene is not to be run.
    pub(super) fn given_up(&self, scene: usize) -> Option<Reason> {
        self.progress().end.filter(|&(end, _)| scene >= end).map(|(_, reason)| reason)
    }

    /// Notes a result, and whether it is the end.
    pub(super) fn note(&self, batch: &Batch<'_>, scene: usize, result: &SceneResult) {
        let mut progress = self.progress();
        progress.known[scene] = Some((result.verdict, result.wall));
        if progress.end.is_none_or(|(end, _)| scene < end) {
            let end = patience::end(&batch.plan.patience, batch.options.fail_fast, &progress.known);
            progress.end = end.or(progress.end);
        }
    }

    /// The digest of a program that needs no build and no copy to be known.
    pub(super) fn digest(&self, batch: &Batch<'_>, submission: &Submission) -> Option<blake3::Hash> {
        *self.digest.get_or_init(|| {
            let builds = batch.plan.build.is_some() && submission.program.is_none() && submission.path.is_dir();
            match &submission.program {
                _ if builds => None,
                Some(program) => staging::digest_in(&submission.path, program),
                None => staging::digest(&submission.path),
            }
        })
    }

    /// The staged submission; whoever comes first stages it, the others wait.
    pub(super) fn staged(&self, batch: &Batch<'_>, submission: &Submission) -> Arc<Result<Staged, String>> {
        let mut staged = self.lock();
        staged.get_or_insert_with(|| Arc::new(stage(batch, submission).map_err(|error| error.to_string()))).clone()
    }

    /// Lets go of the staged copy; the last job that uses it removes it.
    pub(super) fn release(&self) -> Option<Arc<Result<Staged, String>>> {
        self.lock().take()
    }

    fn lock(&self) -> MutexGuard<'_, Option<Arc<Result<Staged, String>>>> {
        self.staged.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn progress(&self) -> MutexGuard<'_, Progress> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Submission {
    /// The name of its program's file.
    pub(super) fn called(&self) -> String {
        called(&self.program.as_ref().map_or_else(|| self.path.clone(), |program| self.path.join(program)))
    }
}

/// The name of a program's file.
pub(super) fn called(program: &Path) -> String {
    program.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn stage(batch: &Batch<'_>, submission: &Submission) -> Result<Staged, StagingError> {
    match &batch.plan.build {
        Some(step) if submission.program.is_none() && submission.path.is_dir() => {
            staging::build(&submission.path, step, batch.backend, batch.cancellation)
        }
        _ => match &submission.program {
            Some(program) => staging::program_in(&submission.path, program),
            None => staging::program(&submission.path),
        },
    }
}
