//! Measures the memory and connections that hostile clients cost, and the latency of other clients at the same time.
use super::{
    Bench,
    client::{Client, connect},
    ladder::UPLOADS,
    measure::{Times, forget_peak, load, peak},
    stage::Stage,
};
use anyhow::{Result, bail};
use axum::{body::Bytes, http::Method};
use std::{
    net::{IpAddr, Ipv4Addr},
    time::{Duration, Instant},
};
use tokio::io::{AsyncReadExt, AsyncWriteExt};

/// The number of connections that read slowly.
const READERS: usize = 40;
const UPLOAD: usize = 120 << 20;
const PACE: usize = 8 << 10;

const HERE: IpAddr = IpAddr::V4(Ipv4Addr::LOCALHOST);

/// Opens connections that request a large upload and read it slowly.
pub(super) async fn slow_readers(arguments: &Bench) -> Result<String> {
    let mut stage = Stage::set(arguments, &[]).await?;
    let mut file = b"#!/bin/sh\n".to_vec();
    file.resize(UPLOAD, b'#');
    let mut requests = Vec::new();
    for number in 1..=2 {
        let mut student = stage.student(number).await?;
        let answer = student.request(Method::POST, UPLOADS, Bytes::from(file.clone())).await?;
        let submission: serde_json::Value = serde_json::from_slice(&answer.body)?;
        let Some(id) = submission["id"].as_i64() else { bail!("the upload was not taken: {}", answer.status) };
        requests.push(format!(
            "GET /api/v1/courses/bench/submissions/{id}/upload HTTP/1.1\r\nHost: x\r\nCookie: {}\r\n\r\n",
            student.cookie()
        ));
    }
    drop(file);
    let readers: Vec<_> = (0..READERS)
        .map(|number| {
            let (request, address) = (requests[number % requests.len()].clone(), stage.address);
            tokio::spawn(async move {
                let mut stream = connect(address, HERE).await?;
                stream.write_all(request.as_bytes()).await?;
                let mut chunk = vec![0; PACE];
                loop {
                    stream.read_exact(&mut chunk).await?;
                    tokio::time::sleep(Duration::from_secs(1)).await;
                }
                #[expect(unreachable_code, reason = "says what kind of error the loop above may end by")]
                Ok::<(), anyhow::Error>(())
            })
        })
        .collect();
    report(
        arguments,
        &mut stage,
        &format!("{READERS} readers of {} MiB, {} KiB in a second", UPLOAD >> 20, PACE >> 10),
    )
    .await?;
    let reading = readers.iter().filter(|reader| !reader.is_finished()).count();
    stage.say(&format!("{reading} of them still read"));
    readers.iter().for_each(tokio::task::JoinHandle::abort);
    stage.finish().await
}

/// Reports the latency of other clients.
pub(super) async fn report(arguments: &Bench, stage: &mut Stage, what: &str) -> Result<()> {
    forget_peak(stage.process());
    let mut times = Times::default();
    others(stage, Instant::now() + Duration::from_secs(arguments.seconds), &mut times).await;
    stage.say(&format!(
        "{what}: memory {} MiB, /health {} ms, course page {} ms (p50 / p95 / p99), errors {:?}, load average {}",
        peak(stage.process()),
        times.percentiles("health"),
        times.percentiles("page"),
        times.errors,
        load()
    ));
    Ok(())
}

/// Requests `/health` and a page by new connections until the given time.
async fn others(stage: &mut Stage, until: Instant, times: &mut Times) {
    let cookie = stage.admin.cookie();
    while Instant::now() < until {
        for (step, path) in [("health", "/health"), ("page", "/c/bench")] {
            let mut client = Client::new(stage.address, usize::MAX);
            client.take(cookie.clone());
            let start = Instant::now();
            match client.get(path).await {
                Ok(answer) if answer.status.is_success() => times.note(step, start.elapsed()),
                Ok(answer) => times.failed(step, answer.status),
                Err(error) => times.failed(step, error),
            }
        }
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
}
