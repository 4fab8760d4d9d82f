//! Sends scores to platforms. Each score is a job in a separate lane, and the server itself runs these jobs.
use super::{
    Lti, ServiceFault,
    client::{ServiceRequest, scope},
    score::{self, ColumnState, ReadyScore, ScoreOrder},
};
use crate::{
    calendar,
    db::{Database, DbError},
    queue::{self, Claim, Claimant, CompletionEffect, FailureEffect, JobKind, Notifier, QueuePolicy},
};
use serde::Deserialize;
use serde_json::json;
use std::{sync::Arc, time::Duration};
use tokio::sync::Semaphore;
use tokio_util::sync::CancellationToken;
use url::Url;

/// The number of scores that are sent in parallel. A hanging platform then delays only a few others.
const MAX_PARALLEL: usize = 4;

/// The time after which the search for jobs is repeated even without a notification.
const SEARCH_INTERVAL: Duration = Duration::from_secs(2);

/// The maximum number of tries while a platform does not answer. With waits of up to an hour, the tries last for more
/// than a day.
const MAX_OUTAGE_TRIES: u32 = 32;

/// The maximum number of tries while a platform rejects scores. There are several, because its configuration may be
/// corrected.
const MAX_REJECTED_TRIES: u32 = 6;

/// The maximum time for sending one score.
const MAX_DURATION: Duration = Duration::from_secs(600);

/// The maximum wait between two tries to send a score.
const MAX_WAIT: Duration = Duration::from_secs(3600);

/// The time for which one caller may create a column while the others wait, in milliseconds. The others check again
/// after the same time.
const COLUMN_CREATION_TIME: i64 = 90_000;
const MAX_POLLS: u32 = 100;
const POLL_INTERVAL: Duration = Duration::from_millis(250);

/// The name under which the server claims the jobs that send scores.
const CLAIMANT: Claimant<'static> = Claimant { worker: "scores", token_id: None };

/// Sends scores until `stop` is canceled. If recording a sent score fails, it is sent again, which changes nothing.
/// Before each claim, `tick` is called, so that jobs of servers that stopped responding are found.
pub async fn run<F: Future<Output = Result<(), DbError>>>(
    database: Database,
    notifier: Notifier,
    policy: QueuePolicy,
    lti: Arc<Lti>,
    tick: impl Fn() -> F,
    stop: CancellationToken,
) {
    let permits = Arc::new(Semaphore::new(MAX_PARALLEL));
    let mut subscription = notifier.subscribe();
    while !stop.is_cancelled() {
        tokio::select! {
            () = stop.cancelled() => return,
            taken = take_job(&database, &policy, &permits, &tick) => match taken {
                Ok(Some((claim, place))) => {
                    let (database, lti) = (database.clone(), lti.clone());
                    tokio::spawn(async move {
                        if let Err(error) = send_claimed(&database, &policy, &lti, &claim).await {
                            tracing::warn!(%error, "the state of a score can't be stored yet");
                        }
                        drop(place);
                    });
                    continue;
                }
                Ok(None) => {}
                Err(error) => tracing::warn!(%error, "no score could be read"),
            },
        }
        tokio::select! {
            () = stop.cancelled() => return,
            _ = subscription.wait(SEARCH_INTERVAL) => {}
        }
    }
}

/// Claims the next job. Also returns a permit, which limits the number of jobs that run in parallel.
async fn take_job<F: Future<Output = Result<(), DbError>>>(
    database: &Database,
    policy: &QueuePolicy,
    room: &Arc<Semaphore>,
    tick: impl Fn() -> F,
) -> Result<Option<(Claim, tokio::sync::OwnedSemaphorePermit)>, DbError> {
    // A server without platforms needs no write transactions here.
    if !queue::is_due(&mut database.read().await?, JobKind::Passback).await? {
        return Ok(None);
    }
    let permit = room.clone().acquire_owned().await.map_err(|error| DbError::Other(error.to_string()))?;
    tick().await?;
    let mut transaction = database.begin().await?;
    let claim = queue::claim(&mut transaction, policy, JobKind::Passback, CLAIMANT).await?;
    transaction.commit().await?;
    Ok(claim.map(|claim| (claim, permit)))
}

async fn send_claimed(database: &Database, policy: &QueuePolicy, lti: &Lti, claim: &Claim) -> Result<(), DbError> {
    let sending = send(database, lti, claim);
    tokio::pin!(sending);
    let result = loop {
        tokio::select! {
            sent = &mut sending => break sent,
            () = tokio::time::sleep(policy.renewal_interval()) => {
                let mut transaction = database.begin().await?;
                queue::renew(&mut transaction, policy, &claim.lease, None, MAX_DURATION).await?;
                transaction.commit().await?;
            }
        }
    };
    let mut transaction = database.begin().await?;
    match result {
        Ok(parcel) => {
            // If the lease was lost, the next sender sends the same score with the same time, which changes nothing.
            if queue::complete(&mut transaction, &claim.lease).await? == CompletionEffect::Done
                && let Some(parcel) = parcel
            {
                score::record_sent(&mut transaction, &parcel).await?;
            }
        }
        Err(fault) => {
            let text = fault.to_string();
            tracing::warn!(job = claim.lease.job, fault = text, "a platform rejected a score");
            let (max_tries, min_wait) = match &fault {
                ServiceFault::Unavailable { retry_after, .. } => (MAX_OUTAGE_TRIES, retry_after.unwrap_or_default()),
                ServiceFault::Rejected(_) => (MAX_REJECTED_TRIES, Duration::ZERO),
            };
            let patient_policy = QueuePolicy { max_failures: max_tries, longest_wait: MAX_WAIT, ..*policy };
            let failure = queue::fail(&mut transaction, &patient_policy, &claim.lease, &text, min_wait).await?;
            match (failure, serde_json::from_str::<ScoreOrder>(&claim.payload)) {
                (FailureEffect::GivenUp, _) => {
                    score::record_failure(&mut transaction, &claim.payload, &text).await?;
                }
                (FailureEffect::Retried, Ok(order)) => score::store_fault(&mut transaction, order, &text).await?,
                _ => {}
            }
        }
    }
    transaction.commit().await
}

/// Sends the score of a claimed job and returns it; `None` if there is no score to send.
async fn send(database: &Database, lti: &Lti, claim: &Claim) -> Result<Option<ReadyScore>, ServiceFault> {
    let order: ScoreOrder = serde_json::from_str(&claim.payload)
        .map_err(|error| ServiceFault::Rejected(format!("the job can't be read: {error}")))?;
    let mut transaction = database.begin().await?;
    let score = score::prepare(&mut transaction, order).await?;
    transaction.commit().await?;
    let Some(parcel) = score else { return Ok(None) };
    let line_item = match &parcel.line_item {
        Some(line_item) => line_item.clone(),
        None => line_item(database, lti, &parcel).await?,
    };
    let mut body = parcel.content.clone();
    body["userId"] = json!(parcel.subject);
    body["timestamp"] = json!(calendar::format_iso(parcel.stamp));
    let request = ServiceRequest {
        url: scores_url(&line_item)?,
        accept: "application/json",
        body: Some(("application/vnd.ims.lis.v1.score+json", body.to_string().into_bytes())),
    };
    match lti.client.call(database, &parcel.platform, scope::SCORE_SCOPE, &request).await {
        Ok(_) => Ok(Some(parcel)),
        // The platform already has a newer score (AGS 3.4.8).
        Err(ServiceFault::Rejected(said)) if said.starts_with("409") => Ok(Some(parcel)),
        Err(fault) => Err(fault),
    }
}

/// Returns the URL to which a column's scores are sent: the column's URL with `/scores` at the end of the path
/// (AGS 3.4).
fn scores_url(line_item: &str) -> Result<String, ServiceFault> {
    let invalid = || ServiceFault::Rejected("the URL of the grade book's column is invalid".to_owned());
    let mut url = Url::parse(line_item).map_err(|_| invalid())?;
    url.path_segments_mut().map_err(|()| invalid())?.pop_if_empty().push("scores");
    Ok(url.into())
}

#[derive(Deserialize)]
struct LineItem {
    id: String,
    #[serde(rename = "resourceLinkId")]
    link: Option<String>,
}

/// Returns the column for a link without a known column. One caller finds or creates it while the others wait.
async fn line_item(database: &Database, lti: &Lti, score: &ReadyScore) -> Result<String, ServiceFault> {
    let Some(container) = &score.line_items else {
        return Err(ServiceFault::Rejected("the platform's grade book has no column for this link".to_owned()));
    };
    let link = score.order.link;
    for _ in 0..MAX_POLLS {
        let mut transaction = database.begin().await?;
        let column = score::find_column(&mut transaction, link, COLUMN_CREATION_TIME).await?;
        transaction.commit().await?;
        match column {
            ColumnState::Known(url) => return Ok(url),
            ColumnState::Claimed => tokio::time::sleep(POLL_INTERVAL).await,
            ColumnState::Unclaimed => {
                let column = find_or_create(database, lti, score, container).await;
                let mut transaction = database.begin().await?;
                score::keep_column(&mut transaction, link, column.as_deref().ok()).await?;
                transaction.commit().await?;
                return column;
            }
        }
    }
    Err(ServiceFault::from_outage("the column in the grade book is not created yet"))
}

/// Finds the column of a link on a platform, or creates it (AGS 3.2).
async fn find_or_create(
    database: &Database,
    lti: &Lti,
    score: &ReadyScore,
    container: &str,
) -> Result<String, ServiceFault> {
    let unreadable = |error| ServiceFault::Rejected(format!("the grade book's columns can't be read: {error}"));
    let mut url = Url::parse(container).map_err(unreadable)?;
    url.query_pairs_mut().append_pair("resource_link_id", &score.resource);
    let request =
        ServiceRequest { url: url.into(), accept: "application/vnd.ims.lis.v2.lineitemcontainer+json", body: None };
    let answer = lti.client.call(database, &score.platform, scope::LINE_ITEM, &request).await?;
    let found: Vec<LineItem> = answer.read("the list of columns")?;
    if let Some(item) = found.into_iter().find(|item| item.link.as_ref() == Some(&score.resource)) {
        return Ok(item.id);
    }
    let max_points = score.content["scoreMaximum"].as_f64().unwrap_or(100.0);
    let item = json!({
        "scoreMaximum": max_points, "label": score.title, "resourceId": score.slug, "resourceLinkId": score.resource,
    });
    const LINE_ITEM_TYPE: &str = "application/vnd.ims.lis.v2.lineitem+json";
    let request = ServiceRequest {
        url: container.to_owned(),
        accept: LINE_ITEM_TYPE,
        body: Some((LINE_ITEM_TYPE, item.to_string().into_bytes())),
    };
    let answer = lti.client.call(database, &score.platform, scope::LINE_ITEM, &request).await?;
    Ok(answer.read::<LineItem>("the new column")?.id)
}

#[cfg(test)]
mod tests {
    #[test]
    fn scores_lie_below_their_column() {
        for (line_item, scores) in [
            ("https://a/lineitems/1", "https://a/lineitems/1/scores"),
            ("https://a/lineitems/1/", "https://a/lineitems/1/scores"),
            ("https://a/1/lineitem?type_id=2", "https://a/1/lineitem/scores?type_id=2"),
        ] {
            assert_eq!(super::scores_url(line_item).expect("a URL"), scores);
        }
        assert!(super::scores_url("mailto:somebody").is_err());
    }
}
