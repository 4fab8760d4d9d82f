//! Workers on a real queue, with graders that only tests have.
use crate::support::engines::{Fresh, run};
use fosssim_server::{
    queue::{self, Bell, Lane, NewJob, Policy, Turn},
    store::Store,
    task::{Form, Input, Suite, Task},
    values,
    worker::{self, Graded, Grader, GraderFault, LocalDesk, Options},
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

/// Notes who runs beside whom.
#[derive(Debug, Clone, Default)]
struct Watchful {
    running: Arc<AtomicUsize>,
    most: Arc<AtomicUsize>,
    beside_the_suspect: Arc<AtomicUsize>,
    done: Arc<AtomicUsize>,
}

impl Grader for Watchful {
    async fn grade(
        &self,
        task: &Task,
        _: &Path,
        _: Option<&Path>,
        _: &Path,
        _: CancellationToken,
    ) -> Result<Graded, GraderFault> {
        let others = self.running.fetch_add(1, Ordering::SeqCst);
        self.most.fetch_max(others + 1, Ordering::SeqCst);
        for _ in 0..20 {
            tokio::time::sleep(Duration::from_millis(2)).await;
            if task.submission.name == "suspect" {
                self.beside_the_suspect.fetch_max(self.running.load(Ordering::SeqCst) - 1, Ordering::SeqCst);
            }
        }
        self.running.fetch_sub(1, Ordering::SeqCst);
        self.done.fetch_add(1, Ordering::SeqCst);
        Ok(Graded {
            verdict: "accepted".to_owned(),
            code: "AC".to_owned(),
            points: None,
            max_points: None,
            summary: String::new(),
            version: "test".to_owned(),
            grader: String::new(),
            essence: String::new(),
            wrong: Vec::new(),
            seconds: "0".to_owned(),
            files: Vec::new(),
        })
    }
}

#[test]
fn a_job_that_may_kill_its_worker_runs_alone() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite").with_tables().await;
        let folder = tempfile::tempdir().expect("a folder");
        let store = Store::folder(&folder.path().join("store")).expect("a store");
        let artefact = store.put(b"a program".to_vec()).await.expect("an artefact");
        let mut transaction = fresh.database.begin().await.expect("a transaction");
        for number in 0..12 {
            let name = if number == 5 { "suspect" } else { "ordinary" };
            let task = Task {
                submission: Input { form: Form::Program, name: name.to_owned(), artefact: artefact.clone() },
                suite: Suite::Named("t2m2".to_owned()),
                rules: None,
                hints: None,
                program: "FOSSSim".to_owned(),
                seconds: 60,
            };
            let payload = serde_json::to_string(&task).expect("JSON");
            let job = NewJob {
                lane: Lane::Grading,
                submission: None,
                campaign: None,
                turn: Turn::Student(number),
                payload: &payload,
            };
            let job = queue::enqueue(&mut transaction, &job).await.expect("a job");
            let failures: i64 = if number == 5 { 2 } else { 0 };
            transaction
                .execute("UPDATE job SET failures = ? WHERE id = ?", values![failures, job])
                .await
                .expect("a row");
        }
        transaction.commit().await.expect("commit");
        let grader = Watchful::default();
        let stop = CancellationToken::new();
        let desk =
            LocalDesk::new(fresh.database.clone(), store, Bell::default(), Policy::default(), "worker".to_owned());
        let options = Options { slots: 3, folder: folder.path().join("work") };
        let working = tokio::spawn(worker::work(desk, grader.clone(), options, stop.clone()));
        while grader.done.load(Ordering::SeqCst) < 12 {
            assert!(!working.is_finished(), "the worker gave up");
            tokio::time::sleep(Duration::from_millis(5)).await;
        }
        stop.cancel();
        working.await.expect("the worker");
        assert!(grader.most.load(Ordering::SeqCst) > 1, "others run side by side");
        assert_eq!(grader.beside_the_suspect.load(Ordering::SeqCst), 0);
        let mut transaction = fresh.database.read().await.expect("a transaction");
        let done = transaction.one("SELECT count(*) AS n FROM job WHERE state = 'done'", values![]).await;
        assert_eq!(done.and_then(|row| row.int("n")).expect("a number"), 12);
    });
}
