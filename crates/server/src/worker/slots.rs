//! The slots of a worker. Each slot runs one job at a time.
use super::{
    Grader, GraderFault, JobSource, PROGRESS_FILE, SourceError,
    health::{Health, job_folder},
};
use crate::{
    queue::{Lease, Progress},
    task::{Outcome, OutputFile, Suite},
    wire::ClaimedJob,
};
use std::{
    fs::File,
    io::Read,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};
use tokio_util::sync::CancellationToken;

/// The time that a slot waits for a job before it requests one again.
const JOB_WAIT: Duration = Duration::from_secs(20);

/// The wait after the source did not answer for the first time. It doubles each further time, up to a maximum.
const FIRST_WAIT: Duration = Duration::from_millis(200);
const MAX_WAIT: Duration = Duration::from_secs(5);

/// The maximum number of tries to fetch a job's files while the source does not answer.
const MAX_FETCHES: u32 = 5;

/// The minimum time between two reports of a grading's progress.
const REPORT_INTERVAL: Duration = Duration::from_secs(1);

/// The time between two checks for the first progress, so that it is reported early.
const FIRST_REPORT_INTERVAL: Duration = Duration::from_millis(100);

/// A number of scenes that is larger than that of any suite. Larger numbers in a progress file are ignored.
const MAX_SCENES: u32 = 1_000_000;

/// The name of the subfolder of a job's folder into which the grader may write.
const WORK_FOLDER: &str = "work";

/// Runs jobs, one in each slot, until `stop` is canceled. Unfinished jobs are then given back. The folders of jobs are
/// created in `folder`. The caller must empty this folder afterwards.
///
/// # Errors
///
/// Fails if the source no longer accepts the worker, so that its jobs are lost.
pub async fn work<D: JobSource, G: Grader>(
    source: D,
    grader: G,
    slots: usize,
    folder: PathBuf,
    stop: CancellationToken,
) -> Result<(), SourceError> {
    let health = Health::new(grader, folder);
    let mut running = tokio::task::JoinSet::new();
    for _ in 0..slots {
        running.spawn(run_slot(source.clone(), health.clone(), stop.clone()));
    }
    let ticking = async {
        loop {
            let slots = if health.is_proven() { slots } else { 0 };
            match source.tick(slots, health.fault().as_deref()).await {
                Ok(()) => {}
                Err(SourceError::Dismissed) => return SourceError::Dismissed,
                Err(error) => tracing::warn!(%error, "the worker's report that it is alive failed"),
            }
            tokio::select! {
                () = tokio::time::sleep(source.tick_every()) => {}
                () = health.change.notified() => {}
            }
        }
    };
    tokio::select! {
        error = ticking => Err(error),
        () = async { while running.join_next().await.is_some() {} } => Ok(()),
    }
}

async fn run_slot<D: JobSource, G: Grader>(source: D, health: Health<G>, stop: CancellationToken) {
    let mut wait = FIRST_WAIT;
    while health.wait_until_able(&stop).await {
        match source.claim().await {
            Ok(None) => {
                wait = FIRST_WAIT;
                tokio::select! {
                    () = source.wait(JOB_WAIT) => {}
                    () = stop.cancelled() => {}
                }
            }
            Ok(Some(job)) => {
                wait = FIRST_WAIT;
                // A panic affects only this job, not the worker.
                let lease = job.lease.clone();
                let done = tokio::spawn(run_job(source.clone(), health.clone(), job, stop.clone()));
                if let Err(error) = done.await {
                    tracing::error!(job = lease.job, %error, "the worker failed");
                    report_end(&source, &lease, JobEnd::Failed(format!("the worker failed: {error}")), &stop).await;
                }
            }
            Err(error) => {
                tracing::warn!(%error, "no job could be claimed");
                tokio::select! {
                    () = tokio::time::sleep(wait) => {}
                    () = stop.cancelled() => {}
                }
                wait = (wait * 2).min(MAX_WAIT);
            }
        }
    }
}

/// The end of a job, for the report to the source.
enum JobEnd {
    Finished(Box<Outcome>),
    Failed(String),
    /// The job is given back, because the worker must stop.
    Returned,
    /// The lease is lost, so there is nothing to report.
    Lost,
}

async fn run_job<D: JobSource, G: Grader>(source: D, health: Health<G>, job: ClaimedJob, stop: CancellationToken) {
    let lease_lost = CancellationToken::new();
    let folder = job_folder(&health.folder);
    let progress = folder.as_ref().ok().map(|folder| folder.path().join(WORK_FOLDER).join(PROGRESS_FILE));
    let interval = Duration::from_millis(job.renew_every);
    let renewal = tokio::spawn(renew(source.clone(), job.lease.clone(), interval, progress, lease_lost.clone()));
    let job_end = match folder {
        Err(error) => JobEnd::Failed(format!("the job's folder can't be created: {error}")),
        Ok(folder) => {
            let halt = CancellationToken::new();
            let grading = async {
                match run_task(&source, &health.grader, &job, folder.path(), halt.clone()).await {
                    Ok(outcome) => JobEnd::Finished(Box::new(outcome)),
                    Err(GraderFault::Stopped) => JobEnd::Returned,
                    Err(GraderFault::Failed(fault)) => JobEnd::Failed(fault),
                }
            };
            tokio::pin!(grading);
            let ending = tokio::select! {
                finished = &mut grading => Some(finished),
                () = lease_lost.cancelled() => None,
                () = stop.cancelled() => None,
            };
            match ending {
                Some(ending) => ending,
                None => {
                    // The grader's children end before the result is reported and the folder is removed.
                    halt.cancel();
                    match grading.await {
                        // The grading ended at the same moment as the wait for it.
                        JobEnd::Finished(outcome) if !lease_lost.is_cancelled() => JobEnd::Finished(outcome),
                        _ if lease_lost.is_cancelled() => JobEnd::Lost,
                        _ => JobEnd::Returned,
                    }
                }
            }
        }
    };
    // If the grader failed, the machine may be the cause. In that case it does not count as a failure of the job.
    let job_end = match job_end {
        JobEnd::Failed(fault) if !health.recheck_after_fault(&stop).await => {
            tracing::warn!(job = job.lease.job, fault, "the job goes to another worker");
            JobEnd::Returned
        }
        ending => ending,
    };
    report_end(&source, &job.lease, job_end, &stop).await;
    renewal.abort();
}

/// Renews a lease until it is lost. This happens at the interval that the source requires, and whenever the grading
/// makes progress.
async fn renew<D: JobSource>(
    source: D,
    lease: Lease,
    every: Duration,
    file: Option<PathBuf>,
    lease_lost: CancellationToken,
) {
    let mut last_renewal = tokio::time::Instant::now();
    let mut reported = None;
    loop {
        let pause = if reported.is_none() { FIRST_REPORT_INTERVAL } else { REPORT_INTERVAL };
        tokio::time::sleep(every.min(pause)).await;
        let progress = file.as_deref().and_then(read_progress);
        if progress == reported && last_renewal.elapsed() < every {
            continue;
        }
        last_renewal = tokio::time::Instant::now();
        reported = progress;
        match source.renew(&lease, progress).await {
            Ok(answer) if answer.held => {}
            Ok(_) => {
                tracing::warn!(job = lease.job, attempt = lease.attempt, "the lease is lost");
                return lease_lost.cancel();
            }
            // The grading continues. When it ends, the source decides whether the result still counts.
            Err(error) => tracing::warn!(job = lease.job, %error, "the lease can't be renewed"),
        }
    }
}

/// Reads the progress from a file that the grader wrote, such as `3/85`.
fn read_progress(file: &Path) -> Option<Progress> {
    let mut text = String::new();
    File::open(file).ok()?.take(64).read_to_string(&mut text).ok()?;
    let (done, all) = text.trim().split_once('/')?;
    let progress = Progress { done: done.parse().ok()?, all: all.parse().ok()? };
    (progress.done <= progress.all && progress.all <= MAX_SCENES).then_some(progress)
}

impl From<SourceError> for GraderFault {
    fn from(error: SourceError) -> Self {
        Self::Failed(error.to_string())
    }
}

/// Fetches a job's files, grades the submission, and stores the reports.
async fn run_task<D: JobSource, G: Grader>(
    source: &D,
    grader: &G,
    job: &ClaimedJob,
    folder: &Path,
    halt: CancellationToken,
) -> Result<Outcome, GraderFault> {
    let start = Instant::now();
    let submission = folder.join("submission");
    retry_request(|| source.fetch(&job.lease, &job.task.submission.artifact.digest, &submission)).await?;
    let suite = match &job.task.suite {
        Suite::Named(_) => None,
        Suite::Archive(digest) => {
            let file = folder.join("suite");
            retry_request(|| source.fetch(&job.lease, digest, &file)).await?;
            Some(file)
        }
    };
    let work = folder.join(WORK_FOLDER);
    std::fs::create_dir(&work).map_err(|error| GraderFault::Failed(format!("cannot create a folder: {error}")))?;
    let graded = grader.grade(&job.task, &submission, suite.as_deref(), &work, halt).await?;
    let mut files = Vec::new();
    for file in &graded.files {
        let artifact = retry_request(|| source.store(&job.lease, &file.path)).await?;
        files.push(OutputFile { name: file.name.clone(), media_type: file.media_type.clone(), artifact });
    }
    let seconds = format!("{:.3}", start.elapsed().as_secs_f64());
    Ok(Outcome { seconds, files, ..graded.outcome })
}

/// Repeats a request while the source does not answer, so that a short failure of the network does not count as a
/// failure of the job.
async fn retry_request<T, F: Future<Output = Result<T, SourceError>>>(send: impl Fn() -> F) -> Result<T, SourceError> {
    let mut wait = FIRST_WAIT;
    for _ in 0..MAX_FETCHES {
        match send().await {
            Err(SourceError::Unavailable(error)) => tracing::warn!(error, "the source can't be reached"),
            answer => return answer,
        }
        tokio::time::sleep(wait).await;
        wait = (wait * 2).min(MAX_WAIT);
    }
    send().await
}

/// Reports the result to the source. The number of tries is not limited, because a lost result would have to be
/// computed again. Only a worker that must stop gives up after a few tries; its lease then expires.
async fn report_end<D: JobSource>(source: &D, lease: &Lease, ending: JobEnd, stop: &CancellationToken) {
    let mut wait = FIRST_WAIT;
    let mut tries_after_stop = 3;
    loop {
        let answer = match &ending {
            JobEnd::Finished(outcome) => source.finish(lease, outcome).await,
            JobEnd::Failed(fault) => {
                tracing::warn!(job = lease.job, fault, "a try failed");
                source.fail(lease, fault).await
            }
            JobEnd::Returned => source.release(lease).await,
            JobEnd::Lost => return,
        };
        match answer {
            Ok(answer) if answer.held => return,
            Ok(_) => return tracing::warn!(job = lease.job, "too late: the lease is lost"),
            Err(error @ (SourceError::Rejected(_) | SourceError::Dismissed)) => {
                return tracing::error!(job = lease.job, %error, "the result is rejected; the lease will expire");
            }
            Err(SourceError::Unavailable(error)) => {
                tracing::warn!(job = lease.job, error, "the result can't be delivered yet")
            }
        }
        if stop.is_cancelled() {
            tries_after_stop -= 1;
            if tries_after_stop == 0 {
                return;
            }
        }
        tokio::time::sleep(wait).await;
        wait = (wait * 2).min(MAX_WAIT);
    }
}
