//! Simulates a deadline: all students submit within the last seconds before it.
use super::{
    Bench,
    client::Client,
    ladder::UPLOADS,
    measure::{Times, load},
    stage::Stage,
};
use anyhow::{Context, Result};
use axum::{
    body::Bytes,
    http::{Method, StatusCode},
};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// The time before the deadline in which all students submit.
const RUSH: Duration = Duration::from_secs(5);

/// The time for preparations before that.
const BEFORE: Duration = Duration::from_secs(3);

/// Returns the present time in milliseconds since 1970.
fn now() -> Result<u64> {
    Ok(SystemTime::now().duration_since(UNIX_EPOCH)?.as_millis().try_into()?)
}

/// An upload shortly before the deadline, and its answer.
struct RushUpload {
    begun: u64,
    status: StatusCode,
    submission: serde_json::Value,
}

/// Submits once, at the given time.
async fn hand_in(mut client: Client, number: usize, program: Bytes, moment: u64) -> Result<RushUpload> {
    let body = Bytes::from([&program, format!("\n# {number} in a hurry\n").as_bytes()].concat());
    tokio::time::sleep(Duration::from_millis(moment.saturating_sub(now()?))).await;
    let begun = now()?;
    let answer = client.request(Method::POST, UPLOADS, body).await?;
    Ok(RushUpload { begun, status: answer.status, submission: serde_json::from_slice(&answer.body)? })
}

/// Sets a due date, and lets all students submit shortly before it. Reports how many uploads that began in time were
/// rejected or count as late.
pub(super) async fn rush(
    arguments: &Bench,
    stage: &mut Stage,
    students: Vec<(usize, Client)>,
    program: &Bytes,
) -> Result<()> {
    let rush = RUSH.min(Duration::from_secs(arguments.seconds));
    let length = u64::try_from(rush.as_millis())?;
    let due = now()? + u64::try_from(BEFORE.as_millis())? + length;
    let wish = format!(r#"{{"title": "M1", "settings": {{"due_at": {due}, "late_percent": 10}}}}"#);
    stage.done(Method::PUT, "/api/v1/courses/bench/assignments/m1", &wish).await?;
    let all = u64::try_from(students.len())?;
    let running: Vec<_> = (0..)
        .zip(students)
        .map(|(place, (number, client))| {
            tokio::spawn(hand_in(client, number, program.clone(), due - length + length * place / all))
        })
        .collect();
    let (mut times, mut refused, mut late, mut began) = (Times::default(), 0, 0, 0);
    for upload in running {
        let upload = upload.await??;
        if upload.begun >= due {
            continue;
        }
        began += 1;
        if upload.status != StatusCode::CREATED {
            refused += 1;
            continue;
        }
        late += usize::from(!upload.submission["late"].is_null());
        let arrived = upload.submission["created_at"].as_u64().context("a submission has no moment")?;
        times.note("arrival", Duration::from_millis(arrived.saturating_sub(upload.begun)));
    }
    stage.say(&format!(
        "\ndeadline: {began} students hand in within the last {} s; refused {refused}, late {late}; \
         from beginning to arrival {} ms; load average {}",
        rush.as_secs(),
        times.percentiles("arrival"),
        load()
    ));
    Ok(())
}
