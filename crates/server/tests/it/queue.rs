//! Tests the queue on both engines. No test waits for a clock: leases and times are changed in the table instead.
use crate::support::engines::{Fresh, on_all_engines};
use fosssim_server::{
    db::Database,
    queue::{self, Claim, Claimant, CompletionEffect, FailureEffect, JobKind, JobOwner, Lease, NewJob, QueuePolicy},
    values,
};
use std::{collections::BTreeSet, time::Duration};

on_all_engines!(
    a_job_comes_and_goes_with_its_upload,
    every_job_is_claimed_once_by_many_workers,
    a_late_worker_changes_nothing,
    an_answer_that_got_lost_may_be_repeated,
    a_foreign_key_or_number_changes_nothing,
    giving_back_costs_nothing,
    a_poison_job_is_buried_when_it_has_killed_for_long,
    a_failed_job_waits_longer_each_time,
    students_take_turns,
    uploads_go_before_regrades_but_not_for_ever,
    the_place_in_the_queue_counts_down,
    an_outage_of_the_database_costs_no_try,
    a_lease_is_not_renewed_for_ever,
    a_cancelled_job_is_gone_for_its_worker_too,
);

const POLICY: QueuePolicy = QueuePolicy {
    lease: Duration::from_secs(60),
    max_failures: 3,
    first_wait: Duration::from_secs(1),
    longest_wait: Duration::from_secs(100),
};

/// A duration that is longer than any job.
const MOST: Duration = Duration::from_secs(3600);

async fn enqueue(database: &Database, owner: JobOwner) -> i64 {
    let mut transaction = database.begin().await.expect("a transaction");
    let job = NewJob { kind: JobKind::Grading, submission: None, regrade_id: None, owner, payload: "work" };
    let number = queue::enqueue(&mut transaction, &job).await.expect("a job");
    transaction.commit().await.expect("commit");
    number
}

async fn claim(database: &Database, worker: &str) -> Option<Claim> {
    claim_by(database, Claimant { worker, token_id: None }).await
}

async fn claim_by(database: &Database, claimant: Claimant<'_>) -> Option<Claim> {
    let mut transaction = database.begin().await.expect("a transaction");
    let claim = queue::claim(&mut transaction, &POLICY, JobKind::Grading, claimant).await.expect("a claim");
    transaction.commit().await.expect("commit");
    claim
}

async fn complete(database: &Database, lease: &Lease) -> CompletionEffect {
    let mut transaction = database.begin().await.expect("a transaction");
    let completion = queue::complete(&mut transaction, lease).await.expect("an answer");
    transaction.commit().await.expect("commit");
    completion
}

async fn fail(database: &Database, lease: &Lease) -> FailureEffect {
    let mut transaction = database.begin().await.expect("a transaction");
    let failure = queue::fail(&mut transaction, &POLICY, lease, "it broke", Duration::ZERO).await.expect("an answer");
    transaction.commit().await.expect("commit");
    failure
}

async fn tick(database: &Database) -> queue::Tick {
    let mut transaction = database.begin().await.expect("a transaction");
    let tick = queue::tick(&mut transaction, &POLICY).await.expect("a tick");
    transaction.commit().await.expect("commit");
    tick
}

/// Lets time pass, with regular ticks.
async fn let_pass(database: &Database, time: Duration) {
    let millis = i64::try_from(time.as_millis()).expect("a short time");
    let due = i64::try_from(POLICY.tick_interval().as_millis()).expect("a short time");
    let mut transaction = database.begin().await.expect("a transaction");
    transaction
        .execute(
            "UPDATE job SET rank = rank - ?, run_after = run_after - ?, lease_until = lease_until - ?",
            values![millis, millis, millis],
        )
        .await
        .expect("time");
    transaction.execute("UPDATE pulse SET beat_at = {now} - ?", values![due]).await.expect("a pulse");
    transaction.commit().await.expect("commit");
}

async fn state(database: &Database, job: i64) -> String {
    let mut transaction = database.read().await.expect("a transaction");
    transaction
        .one("SELECT state FROM job WHERE id = ?", values![job])
        .await
        .expect("a row")
        .text("state")
        .expect("text")
}

async fn a_job_comes_and_goes_with_its_upload(fresh: Fresh) {
    let database = &fresh.database;
    let mut transaction = database.begin().await.expect("a transaction");
    let job = NewJob {
        kind: JobKind::Grading,
        submission: None,
        regrade_id: None,
        owner: JobOwner::Student(1),
        payload: "never seen",
    };
    queue::enqueue(&mut transaction, &job).await.expect("a job");
    // The upload fails here, so there is no commit.
    drop(transaction);
    assert_eq!(claim(database, "w").await, None);
    let number = enqueue(database, JobOwner::Student(1)).await;
    let claimed = claim(database, "w").await.expect("a job");
    assert_eq!((claimed.lease.job, claimed.lease.attempt, claimed.failures), (number, 1, 0));
    assert_eq!(claimed.payload, "work");
    assert_eq!(complete(database, &claimed.lease).await, CompletionEffect::Done);
    assert_eq!(claim(database, "w").await, None);
}

async fn every_job_is_claimed_once_by_many_workers(fresh: Fresh) {
    let mut expected = BTreeSet::new();
    for student in 0..40 {
        expected.insert(enqueue(&fresh.database, JobOwner::Student(student)).await);
    }
    let workers: Vec<_> = (0..8)
        .map(|worker| {
            let database = fresh.database.clone();
            tokio::spawn(async move {
                let mut got = Vec::new();
                while let Some(claimed) = claim(&database, &format!("worker {worker}")).await {
                    got.push(claimed.lease.job);
                }
                got
            })
        })
        .collect();
    let mut got = Vec::new();
    for worker in workers {
        got.extend(worker.await.expect("a worker"));
    }
    assert_eq!(got.len(), 40, "no job twice");
    assert_eq!(got.into_iter().collect::<BTreeSet<_>>(), expected);
}

async fn a_late_worker_changes_nothing(fresh: Fresh) {
    let database = &fresh.database;
    let job = enqueue(database, JobOwner::Student(1)).await;
    // Both workers have the same name, as after a restart.
    let frozen = claim(database, "w").await.expect("a job");
    let_pass(database, POLICY.lease * 2).await;
    assert_eq!(tick(database).await.retried, 1);
    assert_eq!(complete(database, &frozen.lease).await, CompletionEffect::Late, "it waits for another worker");
    let_pass(database, POLICY.longest_wait).await;
    let second = claim(database, "w").await.expect("the job again");
    assert_eq!((second.lease.job, second.lease.attempt), (job, 2));
    assert_eq!((second.failures, second.deaths), (0, 1));
    let mut transaction = database.begin().await.expect("a transaction");
    assert!(!queue::renew(&mut transaction, &POLICY, &frozen.lease, None, MOST).await.expect("an answer"));
    assert!(!queue::release(&mut transaction, &frozen.lease).await.expect("an answer"));
    transaction.commit().await.expect("commit");
    assert_eq!(fail(database, &frozen.lease).await, FailureEffect::Late);
    assert_eq!(complete(database, &frozen.lease).await, CompletionEffect::Late);
    assert_eq!(state(database, job).await, "running");
    assert_eq!(complete(database, &second.lease).await, CompletionEffect::Done);
    assert_eq!(complete(database, &frozen.lease).await, CompletionEffect::Late);
}

async fn an_answer_that_got_lost_may_be_repeated(fresh: Fresh) {
    let database = &fresh.database;
    enqueue(database, JobOwner::Student(1)).await;
    let claimed = claim(database, "w").await.expect("a job");
    assert_eq!(complete(database, &claimed.lease).await, CompletionEffect::Done);
    assert_eq!(complete(database, &claimed.lease).await, CompletionEffect::Repeated);
    // A finished result is accepted even if its lease has expired in the meantime.
    enqueue(database, JobOwner::Student(1)).await;
    let slow = claim(database, "w").await.expect("a job");
    let_pass(database, POLICY.lease * 2).await;
    assert_eq!(complete(database, &slow.lease).await, CompletionEffect::Done);
    assert_eq!(tick(database).await, queue::Tick::default());
}

async fn a_foreign_key_or_number_changes_nothing(fresh: Fresh) {
    let database = &fresh.database;
    let job = enqueue(database, JobOwner::Student(1)).await;
    let held = claim(database, "w").await.expect("a job").lease;
    for forged in [
        Lease { key: "00000000000000000000000000000000".to_owned(), ..held.clone() },
        Lease { key: String::new(), ..held.clone() },
        Lease { key: "' OR 1=1 --".to_owned(), ..held.clone() },
        Lease { attempt: held.attempt + 1, ..held.clone() },
        Lease { job: held.job + 1, ..held.clone() },
    ] {
        assert_eq!(complete(database, &forged).await, CompletionEffect::Late, "{forged:?}");
        assert_eq!(fail(database, &forged).await, FailureEffect::Late, "{forged:?}");
    }
    assert_eq!(state(database, job).await, "running");
    assert_eq!(complete(database, &held).await, CompletionEffect::Done);
}

async fn giving_back_costs_nothing(fresh: Fresh) {
    let database = &fresh.database;
    enqueue(database, JobOwner::Student(1)).await;
    for attempt in 1..=10 {
        let claimed = claim(database, "w").await.expect("the job, at once");
        assert_eq!((claimed.lease.attempt, claimed.failures), (attempt, 0));
        let mut transaction = database.begin().await.expect("a transaction");
        assert!(queue::release(&mut transaction, &claimed.lease).await.expect("an answer"));
        transaction.commit().await.expect("commit");
        assert_eq!(complete(database, &claimed.lease).await, CompletionEffect::Late);
    }
}

async fn a_poison_job_is_buried_when_it_has_killed_for_long(fresh: Fresh) {
    let database = &fresh.database;
    let poison = enqueue(database, JobOwner::Student(1)).await;
    let mut deaths = 0;
    let buried = loop {
        let last = claim(database, "victim").await.expect("the job");
        assert_eq!((last.failures, last.deaths), (0, deaths));
        deaths += 1;
        let_pass(database, POLICY.lease * 2).await;
        let tick = tick(database).await;
        let_pass(database, POLICY.longest_wait).await;
        assert_eq!(tick.retried + tick.given_up.len(), 1);
        if let [buried] = tick.given_up.as_slice() {
            assert_eq!(complete(database, &last.lease).await, CompletionEffect::Late);
            break buried.clone();
        }
    };
    assert!(deaths > 20, "{deaths} deaths, as of a server in a crash loop");
    assert_eq!((buried.job, buried.attempt, buried.worker.as_str()), (poison, deaths, "victim"));
    assert_eq!(state(database, poison).await, "buried");
    assert_eq!(claim(database, "w").await, None);
}

async fn a_failed_job_waits_longer_each_time(fresh: Fresh) {
    let database = &fresh.database;
    enqueue(database, JobOwner::Student(1)).await;
    let first = claim(database, "w").await.expect("a job");
    assert_eq!(fail(database, &first.lease).await, FailureEffect::Retried);
    assert_eq!(claim(database, "w").await, None, "it waits a second");
    let_pass(database, Duration::from_secs(1)).await;
    assert_eq!(claim(database, "w").await, None, "others get it first");
    let second = claim(database, "v").await.expect("a job");
    assert_eq!(fail(database, &second.lease).await, FailureEffect::Retried);
    let_pass(database, Duration::from_secs(1)).await;
    assert_eq!(claim(database, "w").await, None, "it waits four seconds");
    let_pass(database, Duration::from_secs(3)).await;
    let third = claim(database, "w").await.expect("a job");
    assert_eq!(fail(database, &third.lease).await, FailureEffect::GivenUp);
    assert_eq!(fail(database, &third.lease).await, FailureEffect::Late);
}

async fn claim_all(database: &Database) -> Vec<i64> {
    let mut order = Vec::new();
    while let Some(claimed) = claim(database, "w").await {
        order.push(claimed.lease.job);
        assert_eq!(complete(database, &claimed.lease).await, CompletionEffect::Done);
    }
    order
}

async fn students_take_turns(fresh: Fresh) {
    let database = &fresh.database;
    let (busy, calm, third) = (JobOwner::Student(1), JobOwner::Student(2), JobOwner::Student(3));
    let mut own = Vec::new();
    for _ in 0..3 {
        own.push(enqueue(database, busy).await);
    }
    let calm_first = enqueue(database, calm).await;
    let third_first = enqueue(database, third).await;
    let calm_second = enqueue(database, calm).await;
    assert_eq!(claim_all(database).await, [own[0], calm_first, third_first, own[1], calm_second, own[2]]);
    // The earlier jobs of an account without waiting jobs do not delay its next job.
    let again = enqueue(database, busy).await;
    let other = enqueue(database, calm).await;
    assert_eq!(claim_all(database).await, [again, other]);
}

async fn uploads_go_before_regrades_but_not_for_ever(fresh: Fresh) {
    let database = &fresh.database;
    let regrades = [enqueue(database, JobOwner::Regrade(1)).await, enqueue(database, JobOwner::Regrade(1)).await];
    let upload = enqueue(database, JobOwner::Student(1)).await;
    assert_eq!(claim(database, "w").await.map(|claimed| claimed.lease.job), Some(upload));
    // After some time a regrade precedes uploads that have just arrived, but not all its jobs do so together.
    let_pass(database, Duration::from_secs(1801)).await;
    let uploads = [enqueue(database, JobOwner::Student(2)).await, enqueue(database, JobOwner::Student(3)).await];
    assert_eq!(claim_all(database).await, [regrades[0], uploads[0], uploads[1], regrades[1]]);
}

async fn the_place_in_the_queue_counts_down(fresh: Fresh) {
    let database = &fresh.database;
    let place = async |job| {
        let mut transaction = database.read().await.expect("a transaction");
        queue::find_queue_position(&mut transaction, &POLICY, JobKind::Grading, job).await.expect("a place")
    };
    let regrade = enqueue(database, JobOwner::Regrade(1)).await;
    let mut jobs = Vec::new();
    for student in 0..4 {
        jobs.push(enqueue(database, JobOwner::Student(student)).await);
    }
    let ahead = async |job| place(job).await.map(|place| place.ahead);
    assert_eq!((ahead(jobs[0]).await, ahead(jobs[3]).await, ahead(regrade).await), (Some(0), Some(3), Some(4)));
    assert_eq!(place(jobs[3]).await.and_then(|place| place.expected), None, "nobody knows how long a job takes");

    // Two slots, and jobs that took ten seconds each: the fourth ends after two rounds.
    let first = claim(database, "w").await.expect("a job");
    assert_eq!(first.lease.job, jobs[0]);
    assert_eq!(ahead(jobs[0]).await, None, "it does not wait any more");
    complete(database, &first.lease).await;
    let mut transaction = database.begin().await.expect("a transaction");
    transaction
        .execute("UPDATE job SET started_at = finished_at - 10000 WHERE state = 'done'", values![])
        .await
        .expect("a duration");
    transaction
        .execute(
            "INSERT INTO worker (name, version, slots, started_at, seen_at)
             VALUES ('w', '1', 2, {now}, {now}), ('gone', '1', 50, 0, 0)",
            values![],
        )
        .await
        .expect("workers");
    transaction.commit().await.expect("commit");
    let last = place(jobs[3]).await.expect("it waits");
    assert_eq!((last.ahead, last.expected), (2, Some(Duration::from_secs(20))));
    assert_eq!(ahead(regrade).await, Some(3));
    // While a job runs, the rest of its time is expected.
    let running = claim(database, "w").await.expect("a job").lease.job;
    let mut transaction = database.read().await.expect("a transaction");
    let mut rest = async |job| queue::find_time_left(&mut transaction, JobKind::Grading, job).await.expect("a time");
    assert!(rest(running).await.is_some_and(|seconds| (5..=10).contains(&seconds)));
    assert_eq!(rest(jobs[3]).await, None, "it does not run");
}

async fn an_outage_of_the_database_costs_no_try(fresh: Fresh) {
    let database = &fresh.database;
    enqueue(database, JobOwner::Student(1)).await;
    let held = claim(database, "w").await.expect("a job");
    let_pass(database, POLICY.lease * 2).await;
    let mut transaction = database.begin().await.expect("a transaction");
    transaction.execute("UPDATE pulse SET beat_at = beat_at - 60000", values![]).await.expect("a long silence");
    transaction.commit().await.expect("commit");
    let found = tick(database).await;
    assert!(found.outage && found.retried == 0, "{found:?}");
    // From here on, the lease runs again.
    let_pass(database, POLICY.lease / 2).await;
    assert_eq!(tick(database).await, queue::Tick::default());
    let_pass(database, POLICY.lease).await;
    assert_eq!(tick(database).await.retried, 1);
    assert_eq!(complete(database, &held.lease).await, CompletionEffect::Late);
}

async fn a_lease_is_not_renewed_for_ever(fresh: Fresh) {
    let database = &fresh.database;
    enqueue(database, JobOwner::Student(1)).await;
    let held = claim(database, "w").await.expect("a job");
    let renew = async |most| {
        let mut transaction = database.begin().await.expect("a transaction");
        let held = queue::renew(&mut transaction, &POLICY, &held.lease, None, most).await.expect("an answer");
        transaction.commit().await.expect("commit");
        held
    };
    assert!(renew(MOST).await);
    let mut transaction = database.begin().await.expect("a transaction");
    transaction.execute("UPDATE job SET started_at = started_at - 3600001", values![]).await.expect("a long time");
    transaction.commit().await.expect("commit");
    assert!(!renew(MOST).await);
    let_pass(database, POLICY.lease * 2).await;
    assert_eq!(tick(database).await.retried, 1, "another worker gets it");
}

async fn a_cancelled_job_is_gone_for_its_worker_too(fresh: Fresh) {
    let database = &fresh.database;
    let (waiting, running) =
        (enqueue(database, JobOwner::Student(1)).await, enqueue(database, JobOwner::Student(2)).await);
    let cancel = async |job| {
        let mut transaction = database.begin().await.expect("a transaction");
        let statement = "UPDATE job SET state = 'cancelled', finished_at = {now}, lease_key = NULL, lease_until = NULL
            WHERE id = ? AND state IN ('waiting', 'running')";
        let gone = transaction.execute(statement, values![job]).await.expect("an answer") > 0;
        transaction.commit().await.expect("commit");
        gone
    };
    assert!(cancel(waiting).await);
    let held = claim(database, "w").await.expect("the other job");
    assert_eq!(held.lease.job, running);
    assert!(cancel(running).await);
    assert!(!cancel(running).await);
    assert_eq!(complete(database, &held.lease).await, CompletionEffect::Late);
    assert_eq!(claim(database, "w").await, None);
}
