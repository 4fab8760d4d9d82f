//! Tests workers on a real queue, with graders for tests.
use crate::support::engines::{Fresh, run};
use fosssim_server::{
    queue::{self, JobKind, JobOwner, NewJob, Notifier, QueuePolicy},
    store::{Artifact, Store},
    task::{Form, Input, Outcome, Suite, Task},
    values,
    worker::{self, Grader, GraderFault, GradingOutput, LocalSource},
};
use std::{
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    },
    time::Duration,
};
use tokio_util::sync::CancellationToken;

/// A grader that accepts every submission.
#[derive(Debug, Clone)]
struct Willing;

impl Grader for Willing {
    async fn check_ability(&self, _: &Path, _: CancellationToken) -> Result<(), String> {
        Ok(())
    }

    async fn grade(
        &self,
        _: &Task,
        _: &Path,
        _: Option<&Path>,
        _: &Path,
        _: CancellationToken,
    ) -> Result<GradingOutput, GraderFault> {
        tokio::time::sleep(Duration::from_millis(2)).await;
        let outcome = Outcome {
            verdict: "accepted".to_owned(),
            code: "AC".to_owned(),
            version: "test".to_owned(),
            seconds: "0".to_owned(),
            ..Outcome::default()
        };
        Ok(GradingOutput { outcome, files: Vec::new() })
    }
}

/// Enqueues jobs.
async fn enqueue(fresh: &Fresh, artifact: &Artifact, jobs: i64) {
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    for number in 0..jobs {
        let task = Task {
            submission: Input { form: Form::Program, name: "program".to_owned(), artifact: artifact.clone() },
            suite: Suite::Named("t2m2".to_owned()),
            rules: None,
            hints: None,
            smallest: false,
            program: "FOSSSim".to_owned(),
            seconds: 60,
        };
        let payload = serde_json::to_string(&task).expect("JSON");
        let job = NewJob {
            kind: JobKind::Grading,
            submission: None,
            regrade_id: None,
            owner: JobOwner::Student(number),
            payload: &payload,
        };
        queue::enqueue(&mut transaction, &job).await.expect("a job");
    }
    transaction.commit().await.expect("commit");
}

/// Returns the number of jobs in a state.
async fn count(fresh: &Fresh, state: &str) -> i64 {
    let mut transaction = fresh.database.read().await.expect("a transaction");
    let row = transaction.one("SELECT count(*) AS n FROM job WHERE state = ?", values![state]).await;
    row.and_then(|row| row.int("n")).expect("a number")
}

/// A grader that fails on every job. It either reports that it can't grade, or only fails.
#[derive(Debug, Clone)]
struct Broken {
    knows: bool,
    tried: Arc<AtomicUsize>,
}

impl Grader for Broken {
    async fn check_ability(&self, _: &Path, _: CancellationToken) -> Result<(), String> {
        if self.knows { Err("it is broken".to_owned()) } else { Ok(()) }
    }

    async fn grade(
        &self,
        _: &Task,
        _: &Path,
        _: Option<&Path>,
        _: &Path,
        _: CancellationToken,
    ) -> Result<GradingOutput, GraderFault> {
        self.tried.fetch_add(1, Ordering::SeqCst);
        Err(GraderFault::Failed("it is broken".to_owned()))
    }
}

/// A worker that can't grade is always free, and must not take all jobs of the queue.
#[test]
fn a_broken_worker_costs_no_job_its_tries() {
    run(async {
        for knows in [true, false] {
            let fresh = Fresh::sqlite().await.expect("SQLite").with_tables().await;
            let folder = tempfile::tempdir().expect("a folder");
            let store = Store::folder(&folder.path().join("store")).expect("a store");
            let artifact = crate::support::put(&store, b"a program").await;
            enqueue(&fresh, &artifact, 30).await;
            let stop = CancellationToken::new();
            let broken = Broken { knows, tried: Arc::default() };
            let policy = QueuePolicy::default();
            let place = |name: &str| folder.path().join(name);
            let source = |name: &str| {
                LocalSource::new(fresh.database.clone(), store.clone(), Notifier::default(), policy, name.to_owned())
            };
            let workers = [
                tokio::spawn(worker::work(source("broken"), broken.clone(), 2, place("broken"), stop.clone())),
                tokio::spawn(worker::work(source("good"), Willing, 2, place("good"), stop.clone())),
            ];
            while count(&fresh, "done").await < 30 {
                assert_eq!(count(&fresh, "buried").await, 0);
                tokio::time::sleep(Duration::from_millis(20)).await;
            }
            stop.cancel();
            for worker in workers {
                worker.await.expect("no panic").expect("a worker");
            }
            let tried = broken.tried.load(Ordering::SeqCst);
            assert!(if knows { tried == 0 } else { tried <= 30 }, "{tried} tries by a broken worker");
        }
    });
}
