//! The measured server, as a separate process with its own folder and a course.
use super::{Bench, client::Client};
use anyhow::{Context, Result, bail};
use axum::{body::Bytes, http::Method};
use std::{fs, net::SocketAddr, os::unix::fs::PermissionsExt, path::Path, process::Stdio};
use tokio::{
    io::{AsyncBufReadExt, BufReader, Lines},
    process::{Child, ChildStdout, Command},
};

/// A grader that answers immediately, so that only the service is measured.
const GRADER: &str = r#"#!/bin/sh
[ "$1" = grade ] || exit 2
for word in "$@"; do
    case $word in
        json=*) json=${word#json=} ;;
        html=*) echo '<p>a report</p>' > "${word#html=}" ;;
    esac
done
echo '{"schema": 4, "version": "1.0",
 "grades": [{"verdict": "wrong", "code": "WA", "points": 50, "max_points": 100, "groups": []}]}' > "$json"
exit 1
"#;

/// A running server with a course.
pub(super) struct Stage {
    server: Child,
    output: Lines<BufReader<ChildStdout>>,
    pub(super) address: SocketAddr,
    pub(super) admin: Client,
    pub(super) folder: tempfile::TempDir,
    /// All lines that were printed so far.
    said: String,
}

impl Stage {
    /// Starts a server, and creates a course.
    pub(super) async fn set(arguments: &Bench, options: &[&str]) -> Result<Self> {
        let folder = tempfile::tempdir()?;
        let (server, output, address) = start(arguments, folder.path(), options).await?;
        let mut stage = Self { server, output, address, admin: Client::new(address, 0), folder, said: String::new() };
        let line = stage.output.next_line().await?.unwrap_or_default();
        let secret = line.rsplit('/').next().unwrap_or_default();
        stage.admin.welcome(secret).await?;
        let course = r#"{"slug": "bench", "title": "The bench"}"#;
        stage.done(Method::POST, "/api/v1/courses", course).await?;
        let assignment = r#"{"title": "M1", "visible": true, "settings": {"per_hour": 0}}"#;
        stage.done(Method::PUT, "/api/v1/courses/bench/assignments/m1", assignment).await?;
        Ok(stage)
    }

    /// Restarts the server on the same data, with other options.
    pub(super) async fn again(&mut self, arguments: &Bench, options: &[&str]) -> Result<()> {
        self.stop().await?;
        let folder = self.folder.path().to_owned();
        (self.server, self.output, self.address) = start(arguments, &folder, options).await?;
        let cookie = self.admin.cookie();
        self.admin = Client::new(self.address, 0);
        self.admin.take(cookie);
        Ok(())
    }

    /// Sends a request as administrator. Fails if the request does not succeed.
    pub(super) async fn done(&mut self, method: Method, path: &str, body: &str) -> Result<Bytes> {
        let answer = self.admin.request(method, path, Bytes::copy_from_slice(body.as_bytes())).await?;
        if !answer.status.is_success() {
            bail!("{path}: {} {}", answer.status, String::from_utf8_lossy(&answer.body));
        }
        Ok(answer.body)
    }

    /// Creates a student, and returns the secret of the sign-in link.
    pub(super) async fn enrol(&mut self, number: usize) -> Result<String> {
        let wish = format!(r#"{{"name": "Student {number}", "role": "student"}}"#);
        let made = self.done(Method::PUT, &format!("/api/v1/courses/bench/members/s{number}"), &wish).await?;
        let made: serde_json::Value = serde_json::from_slice(&made)?;
        let link = made["link"].as_str().context("a new student has no link")?;
        Ok(link.rsplit('/').next().unwrap_or_default().to_owned())
    }

    /// Creates a student, and signs them in.
    pub(super) async fn student(&mut self, number: usize) -> Result<Client> {
        let secret = self.enrol(number).await?;
        let mut client = Client::new(self.address, number);
        client.welcome(&secret).await?;
        Ok(client)
    }

    /// Returns the number of the server's process.
    pub(super) fn process(&self) -> u32 {
        self.server.id().unwrap_or_default()
    }

    /// Prints a line.
    pub(super) fn say(&mut self, line: &str) {
        println!("{line}");
        self.said.push_str(line);
        self.said.push('\n');
    }

    /// Stops the server, and returns all printed lines.
    pub(super) async fn finish(mut self) -> Result<String> {
        self.stop().await?;
        Ok(self.said)
    }

    async fn stop(&mut self) -> Result<()> {
        if let Some(process) = rustix::process::Pid::from_raw(self.process().cast_signed()) {
            rustix::process::kill_process(process, rustix::process::Signal::TERM)?;
        }
        self.server.wait().await?;
        Ok(())
    }
}

async fn start(
    arguments: &Bench,
    folder: &Path,
    options: &[&str],
) -> Result<(Child, Lines<BufReader<ChildStdout>>, SocketAddr)> {
    let grader = match &arguments.grader {
        Some(grader) => std::path::absolute(grader)?,
        None => {
            let grader = folder.join("grader");
            fs::write(&grader, GRADER)?;
            fs::set_permissions(&grader, fs::Permissions::from_mode(0o755))?;
            grader
        }
    };
    let mut command = Command::new(env!("CARGO_BIN_EXE_fosssim-server"));
    command.args(["serve", "--listen", "127.0.0.1:0", "--requests-per-minute", "100000000", "--workers"]);
    command.arg(arguments.workers.to_string()).arg("--grader").arg(&grader).arg("--data").arg(folder.join("data"));
    command.args(options).env("FOSSSIM_LOG", "error").stdin(Stdio::null()).stdout(Stdio::piped()).kill_on_drop(true);
    if let Some(database) = &arguments.database {
        command.env("FOSSSIM_DATABASE", database);
    }
    let mut server = command.spawn()?;
    let output = server.stdout.take().context("the server has no output")?;
    let mut output = BufReader::new(output).lines();
    let line = output.next_line().await?.unwrap_or_default();
    let Some(address) = line.strip_prefix("Listening on http://") else { bail!("the server did not start") };
    Ok((server, output, address.parse()?))
}
