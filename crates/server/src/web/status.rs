//! A submission's state as it changes, by server-sent events.
use crate::{access::Member, problem::Problem};
use axum::response::{
    IntoResponse, Response,
    sse::{Event, KeepAlive, Sse},
};
use std::{convert::Infallible, time::Duration};

/// How often somebody looks although nobody rang: places in the queue move without a notifier, too.
const LOOK_EVERY: Duration = Duration::from_secs(2);

/// How long somebody waits after the notifier rang before looking: it rings for all, and hundreds may follow theirs.
const PAUSE: Duration = Duration::from_millis(300);

/// Events until the submission is graded: each is its whole state, so that nothing is lost by a broken connection.
pub(super) async fn stream(member: Member, id: i64) -> Result<Response, Problem> {
    // Anybody who may not see it learns so before any event.
    member.submission(id).await?;
    let transfer = member.transfer()?;
    let subscription = member.app.subscribe();
    let state = (member, subscription, String::new(), false, transfer);
    let events =
        futures_util::stream::unfold(state, move |(member, mut subscription, mut last, ended, transfer)| async move {
            if ended {
                return None;
            }
            loop {
                match member.submission(id).await {
                    Ok(submission) => {
                        let text = serde_json::to_string(&submission).unwrap_or_default();
                        if text != last {
                            let ended = !matches!(submission.state.as_str(), "waiting" | "running");
                            let event = Event::default().event("submission").data(&text);
                            last = text;
                            return Some((Ok::<_, Infallible>(event), (member, subscription, last, ended, transfer)));
                        }
                    }
                    // The browser asks again.
                    Err(_) => return None,
                }
                tokio::select! {
                    () = async {
                        if subscription.wait(LOOK_EVERY).await {
                            tokio::time::sleep(PAUSE).await;
                        }
                    } => {}
                    // The browser comes back, to the server's successor.
                    () = member.app.closing() => return None,
                }
            }
        });
    Ok(Sse::new(events).keep_alive(KeepAlive::new().interval(Duration::from_secs(15))).into_response())
}
