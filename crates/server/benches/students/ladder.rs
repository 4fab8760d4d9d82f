//! Repeats the load tests of Artemis: an increasing number of students who never pause, and a deadline at the end.
use super::{
    Bench,
    client::{Answer, Client},
    measure::{Spent, Times, forget_peak, load, peak},
    rush::rush,
    stage::Stage,
};
use anyhow::Result;
use axum::{
    body::Bytes,
    http::{Method, StatusCode},
};
use std::time::{Duration, Instant};

/// The path to which students submit.
pub(super) const UPLOADS: &str = "/api/v1/courses/bench/assignments/m1/submissions?name=FOSSSim";

/// The time between two requests for a submission's state.
const LOOK_EVERY: Duration = Duration::from_millis(500);

/// The maximum time for the queue to become empty between two rungs.
const REST: Duration = Duration::from_secs(120);

/// The steps that each student repeats, in this order.
const STEPS: [&str; 6] = ["sign in", "course", "upload", "status", "verdict", "report"];

pub(super) async fn climb(arguments: &Bench) -> Result<String> {
    let mut stage = Stage::set(arguments, &[]).await?;
    stage.say(&format!(
        "load average at the start: {}; each rung {} s; p50 / p95 / p99 in ms\n",
        load(),
        arguments.seconds
    ));
    stage.say(&format!("| students | {} | errors | jobs in a minute | memory | bound by |", STEPS.join(" | ")));
    stage.say(&format!("|---:|{}---:|---:|---:|---|", "---:|".repeat(STEPS.len())));
    let mut students: Vec<LadderStudent> = Vec::new();
    for &rung in &arguments.students {
        for number in students.len() + 1..=rung {
            let secret = stage.enrol(number).await?;
            students.push(LadderStudent {
                client: Client::new(stage.address, number),
                secret: Some(secret),
                number,
                round: 0,
            });
        }
        forget_peak(stage.process());
        let (before, start) = (Spent::now(stage.process()), Instant::now());
        let until = start + Duration::from_secs(arguments.seconds);
        let program = program(arguments)?;
        let running: Vec<_> =
            students.drain(..).map(|student| tokio::spawn(student.study(until, program.clone()))).collect();
        let mut times = Times::default();
        for student in running {
            let (student, seen) = student.await?;
            students.push(student);
            times.add(seen);
        }
        let took = start.elapsed();
        let spent = Spent::now(stage.process()).since(before);
        let graded = times.by_step.get("verdict").map_or(0, Vec::len) as u64;
        let per_minute = graded * 60_000 / u64::try_from(took.as_millis()).unwrap_or(1).max(1);
        let cells: Vec<String> = STEPS.iter().map(|step| times.percentiles(step)).collect();
        let errors: usize = times.errors.values().sum();
        stage.say(&format!(
            "| {rung} | {} | {errors} | {per_minute} | {} MiB | {} |",
            cells.join(" | "),
            peak(stage.process()),
            spent.bound()
        ));
        for (error, count) in &times.errors {
            stage.say(&format!("<!-- {count} x {error} -->"));
        }
        empty(&mut stage).await?;
    }
    let students = students.into_iter().map(|student| (student.number, student.client)).collect();
    rush(arguments, &mut stage, students, &program(arguments)?).await?;
    stage.say(&format!("\nload average at the end: {}", load()));
    stage.finish().await
}

/// Returns the program that students upload.
fn program(arguments: &Bench) -> Result<Bytes> {
    Ok(match &arguments.program {
        Some(file) => Bytes::from(std::fs::read(file)?),
        None => Bytes::from_static(b"#!/bin/sh\n"),
    })
}

/// Waits until the queue is empty, so that the jobs of one rung do not delay the next one.
async fn empty(stage: &mut Stage) -> Result<()> {
    let start = Instant::now();
    while start.elapsed() < REST {
        let answer = stage.admin.get("/api/v1/queue").await?;
        let queue: serde_json::Value = serde_json::from_slice(&answer.body)?;
        if queue["waiting"] == 0 && queue["running"] == 0 {
            return Ok(());
        }
        tokio::time::sleep(LOOK_EVERY).await;
    }
    stage.say("<!-- the queue was not empty before the next rung -->");
    Ok(())
}

struct LadderStudent {
    client: Client,
    /// The secret of the sign-in link.
    secret: Option<String>,
    number: usize,
    round: usize,
}

impl LadderStudent {
    async fn study(mut self, until: Instant, program: Bytes) -> (Self, Times) {
        let mut times = Times::default();
        while Instant::now() < until {
            if let Err(error) = self.round(until, &program, &mut times).await {
                times.failed("broken", error);
                // Do not send requests without a pause to a server that is down.
                tokio::time::sleep(LOOK_EVERY).await;
            }
        }
        (self, times)
    }

    async fn round(&mut self, until: Instant, program: &Bytes, times: &mut Times) -> Result<()> {
        if let Some(secret) = self.secret.clone() {
            let start = Instant::now();
            self.client.welcome(&secret).await?;
            times.note("sign in", start.elapsed());
            self.secret = None;
        }
        self.see("course", "/c/bench", times).await?;
        // Each program differs, so that each is stored.
        let own = format!("\n# {} {}\n", self.number, self.round);
        self.round += 1;
        let body = Bytes::from([program, own.as_bytes()].concat());
        let start = Instant::now();
        let answer = self.client.request(Method::POST, UPLOADS, body).await?;
        if answer.status != StatusCode::CREATED {
            times.failed("upload", answer.status);
            return Ok(());
        }
        times.note("upload", start.elapsed());
        let submission: serde_json::Value = serde_json::from_slice(&answer.body)?;
        let id = submission["id"].as_i64().unwrap_or_default();
        loop {
            let answer = self.see("status", &format!("/api/v1/courses/bench/submissions/{id}"), times).await?;
            let submission: serde_json::Value = serde_json::from_slice(&answer.body)?;
            if submission["state"] == "done" {
                break;
            }
            // A student who has no grade at the end of the rung does not wait for it.
            if Instant::now() > until {
                return Ok(());
            }
            tokio::time::sleep(LOOK_EVERY).await;
        }
        times.note("verdict", start.elapsed());
        self.see("report", &format!("/c/bench/s/{id}"), times).await?;
        Ok(())
    }

    async fn see(&mut self, step: &'static str, path: &str, times: &mut Times) -> Result<Answer> {
        let start = Instant::now();
        let answer = self.client.get(path).await?;
        if answer.status.is_success() {
            times.note(step, start.elapsed());
        } else {
            times.failed(step, answer.status);
        }
        Ok(answer)
    }
}
