//! A real server as a separate process, and clients that send valid or invalid HTTP requests to it.
use super::engines::Fresh;
use fosssim_server::db::Address;
use std::{
    fs,
    io::{BufRead, BufReader, Read, Write},
    net::TcpStream,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
    process::{Child, ChildStdout, Command, Stdio},
    sync::atomic::{AtomicU32, Ordering},
    time::{Duration, Instant},
};

/// A grader that gives the grade that the submission requests: `#!grade CODE POINTS [SCENE RIGHT-STEPS]`, for two
/// scenes. Next to `grade.json` it writes a report with the content that a hostile program would put there.
const GRADER: &str = r#"#!/bin/sh
if [ "$1" = demo ]; then
    printf '#!grade WA 40\n' > "$3"
    exit 0
fi
if [ "$1 $2" = "suite list" ]; then
    printf '{"schema": 1, "suites": [{"name": "t2m2", "title": "M2", "default": true},
        {"name": "course-2027", "title": "New", "default": false}]}'
    exit 0
fi
if [ "$1" = page ]; then
    printf '<meta http-equiv="Content-Security-Policy" content="default-src %s">' "'none'"
    printf '<strong class="brand">fosssim-oracle</strong>the checker'
    exit 0
fi
if [ "$1 $2" = "suite check" ]; then
    grep -q broken suite.toml || exit 0
    printf 'error: the suite has a problem:\n%s/suite.toml:1:1: it is broken\n' "$PWD" >&2
    exit 2
fi
[ "$1" = grade ] || exit 2
program=$2
rules=of-the-suite
traces=
suite=none
while [ $# -gt 0 ]; do
    case $1 in
        json=*) json=${1#json=} ;;
        text=*) text=${1#text=} ;;
        html=*) html=${1#html=} ;;
        --rules) rules=$2 ;;
        --suite) suite=$2 ;;
        --traces) traces=yes ;;
    esac
    shift
done
# A folder of sources is graded by the program in it, and one of traces by the first of them.
[ "$traces" ] && program=$program/Group/one.bin
[ -d "$program" ] && program=$program/FOSSSim
read -r _ code points scene right < "$program"
[ "$code" = HANG ] && exec sleep 600
if [ "$code" = POISON ]; then
    kill -KILL $PPID
    sleep 60
fi
# Ends when somebody lets it.
if [ "$code" = SLOW ]; then
    echo 3/85 > "$FOSSSIM_PROGRESS"
    while [ ! -e "$0.mended" ]; do sleep 0.1; done
    code=AC
fi
# Fails until somebody has mended it.
if [ "$code" = FAIL ] && [ ! -e "$0.mended" ]; then
    echo "$PWD/suite/suite.toml:5:9: a secret of the machine" >&2
    exit 3
fi
[ "$code" = FAIL ] && code=WA
# The other suite has twice the points.
most=100
[ "$suite" = course-2027 ] && most=200
# By the other rules everything is worth half.
[ "$rules" = parity ] && points=$((points / 2))
printf '<script>alert(1)</script> %s by %s, ' "$(basename "$program")" "$(basename "$suite")" > "$text"
echo "$points points" >> "$text"
visibility=visible
case $scene in Secret/*) visibility=hidden ;; esac
printf '<script>document.title = document.cookie</script><main id="content">\n<h1>Report</h1>\n' > "$html"
printf '<p>%s points</p></main>\n<footer><p>Written by fosssim-oracle VERSION. </p></footer>' "$points" >> "$html"
echo "everything $points points" > "$FOSSSIM_STAFF_PAGE"
if [ $visibility = hidden ]; then
    echo '10.0 points' > "$html"
    echo "published $points points" > "$FOSSSIM_PUBLISHED_PAGE"
fi
cat > "$json" <<END
{"schema": 4, "version": "1.0", "grades": [{"verdict": "in words", "code": "$code", "points": $points,
 "max_points": $most, "wall_seconds": $$.5, "groups": [
 {"name": "Group", "points": 10, "max_points": 10,
  "scenes": [{"scene": "Group/easy", "code": "AC", "verdict": "accepted", "right_steps": 9}]},
 {"name": "=More", "visibility": "$visibility", "points": $points, "max_points": 90,
  "scenes": [{"scene": "${scene:-Group/hard}", "code": "$code", "right_steps": ${right:-$points},
   "summary": "a step is wrong"}]}]}]}
END
[ "$code" = AC ]
"#;

/// Returns a program to which this grader gives the code and the points.
pub(crate) fn program(code: &str, points: u32) -> Vec<u8> {
    format!("#!grade {code} {points}\n").into_bytes()
}

/// A running server.
pub(crate) struct Server {
    child: Child,
    output: BufReader<ChildStdout>,
    /// `http://127.0.0.1:PORT`.
    pub(crate) url: String,
    pub(crate) folder: PathBuf,
    options: Vec<String>,
    database: String,
    _temp: tempfile::TempDir,
}

impl Server {
    /// Starts a server on a database, with further options.
    pub(crate) fn start(fresh: &Fresh, options: &[&str]) -> Self {
        let temp = tempfile::tempdir().expect("a folder");
        let folder = temp.path().join("data");
        Self::start_with(fresh, options, folder, temp)
    }

    /// Starts a server with the given data folder, which the caller must remove.
    pub(crate) fn start_in(fresh: &Fresh, options: &[&str], folder: PathBuf) -> Self {
        Self::start_with(fresh, options, folder, tempfile::tempdir().expect("a folder"))
    }

    fn start_with(fresh: &Fresh, options: &[&str], folder: PathBuf, temp: tempfile::TempDir) -> Self {
        let grader = folder.with_file_name("grader");
        // Another server with this folder may be using the file.
        if !grader.exists() {
            fs::write(&grader, GRADER.replace("VERSION", env!("CARGO_PKG_VERSION"))).expect("a script");
            fs::set_permissions(&grader, fs::Permissions::from_mode(0o755)).expect("permissions");
        }
        let database = match &fresh.address {
            Address::Sqlite(file) => format!("sqlite:{}", file.display()),
            Address::Postgres(url) => url.clone(),
        };
        let options: Vec<String> = options.iter().map(|option| (*option).to_owned()).collect();
        // The server has a separate address, so no other process takes its port during a restart.
        static COUNT: AtomicU32 = AtomicU32::new(1);
        let [_, of_process, high, low] =
            (std::process::id() << 16 | COUNT.fetch_add(1, Ordering::Relaxed)).to_be_bytes();
        let listen = format!("127.{}.{high}.{low}:0", of_process % 250 + 1);
        let (child, output, url) = Self::spawn(&folder, &grader, &database, &listen, &options).expect("a server");
        Self { child, output, url, folder, options, database, _temp: temp }
    }

    fn spawn(
        folder: &Path,
        grader: &Path,
        database: &str,
        listen: &str,
        options: &[String],
    ) -> Result<(Child, BufReader<ChildStdout>, String), String> {
        let log = fs::File::options().create(true).append(true).open(folder.with_file_name("log")).expect("a log");
        let mut child = Command::new(env!("CARGO_BIN_EXE_fosssim-server"))
            .args(["serve", "--listen", listen, "--grader"])
            .arg(grader)
            .arg("--data")
            .arg(folder)
            .args(options)
            .env("FOSSSIM_DATABASE", database)
            .env("FOSSSIM_LOG", "debug")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(log)
            .spawn()
            .expect("the server");
        let mut output = BufReader::new(child.stdout.take().expect("its output"));
        let mut line = String::new();
        output.read_line(&mut line).expect("a line");
        match line.trim().strip_prefix("Listening on ") {
            Some(url) => Ok((child, output, url.to_owned())),
            None => {
                child.wait().expect("wait");
                let log = fs::read_to_string(folder.with_file_name("log")).unwrap_or_default();
                Err(format!("{line:?}: {log}"))
            }
        }
    }

    pub(crate) fn grader(&self) -> PathBuf {
        self.folder.with_file_name("grader")
    }

    /// Returns the server's peak memory in bytes.
    pub(crate) fn peak_memory(&self) -> u64 {
        let status = fs::read_to_string(format!("/proc/{}/status", self.child.id())).expect("its status");
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("its memory");
        let kibibytes: u64 = line.trim().trim_end_matches(" kB").parse().expect("a number");
        kibibytes * 1024
    }

    /// Returns the database's address.
    pub(crate) fn database(&self) -> String {
        self.database.clone()
    }

    pub(crate) fn log(&self) -> String {
        fs::read_to_string(self.folder.with_file_name("log")).unwrap_or_default()
    }

    /// Returns the last word of the next line that the server prints.
    pub(crate) fn next_word(&mut self) -> String {
        let mut line = String::new();
        self.output.read_line(&mut line).expect("a line");
        line.trim().rsplit(' ').next().expect("a word").to_owned()
    }

    /// Returns the link that a fresh server prints next.
    pub(crate) fn first_link(&mut self) -> String {
        self.next_word().rsplit('/').next().expect("a secret").to_owned()
    }

    /// Kills the server with SIGKILL.
    pub(crate) fn kill(&mut self) {
        self.child.kill().expect("kill");
        self.child.wait().expect("wait");
    }

    /// Sends a signal to the server.
    pub(crate) fn signal(&self, signal: i32) {
        // SAFETY: the process is this test's own child, and not reaped.
        unsafe { libc::kill(self.child.id().cast_signed(), signal) };
    }

    /// Stops the server, and returns its exit status.
    pub(crate) fn stop(&mut self) -> std::process::ExitStatus {
        // SAFETY: the process is this test's own child, and not reaped.
        unsafe { libc::kill(self.child.id().cast_signed(), libc::SIGTERM) };
        self.child.wait().expect("wait")
    }

    /// Restarts the ended server with other options. If it ends immediately, returns its log as an error.
    pub(crate) fn start_again_with(&mut self, options: &[&str]) -> Result<(), String> {
        let options: Vec<String> = options.iter().map(|option| (*option).to_owned()).collect();
        let (mut child, mut output, _) =
            Self::spawn(&self.folder, &self.grader(), &self.database, "127.0.0.1:0", &options)?;
        let mut rest = String::new();
        // The output ends with the process, which does not serve requests.
        output.read_to_string(&mut rest).expect("its output");
        if child.wait().expect("wait").success() { Ok(()) } else { Err(self.log()) }
    }

    /// Restarts the server at the same address.
    pub(crate) fn resume(&mut self) {
        let listen = self.url.strip_prefix("http://").expect("an address").to_owned();
        let start = Instant::now();
        let (child, output, _) = loop {
            match Self::spawn(&self.folder, &self.grader(), &self.database, &listen, &self.options) {
                Ok(server) => break server,
                // Another connection may have received the port in the meantime.
                Err(error) => assert!(start.elapsed() < Duration::from_secs(120), "{error}"),
            }
            std::thread::sleep(Duration::from_millis(100));
        };
        (self.child, self.output) = (child, output);
    }

    /// Returns a client without any rights.
    pub(crate) fn visitor(&self) -> Client {
        Client { url: self.url.clone(), headers: Vec::new() }
    }

    /// Returns a client with a token.
    pub(crate) fn with_token(&self, token: &str) -> Client {
        Client { url: self.url.clone(), headers: vec![("Authorization".to_owned(), format!("Bearer {token}"))] }
    }

    /// Signs the first administrator in by the link, and creates a token.
    pub(crate) fn admin(&mut self) -> Client {
        let link = self.first_link();
        let session = self.visitor().welcome(&link);
        let token = session.post_json("/api/v1/tokens", r#"{"name": "tests"}"#).expect(201).json();
        self.with_token(token["token"].as_str().expect("a token"))
    }

    /// Creates a member of a course, and signs the member in with a token.
    pub(crate) fn member(&self, by: &Client, course: &str, login: &str, role: &str) -> Client {
        let wish = format!(r#"{{"name": "The {login}", "role": "{role}"}}"#);
        let link = by.send("PUT", &format!("/api/v1/courses/{course}/members/{login}"), JSON, wish.as_bytes());
        let link = link.expect(200).json()["link"].as_str().expect("a link").to_owned();
        let session = self.visitor().welcome(link.rsplit('/').next().expect("a secret"));
        let token = session.post_json("/api/v1/tokens", r#"{"name": "tests"}"#).expect(201).json();
        self.with_token(token["token"].as_str().expect("a token"))
    }

    /// Creates a course with an assignment that students see.
    pub(crate) fn course(&self, admin: &Client, slug: &str) {
        admin.post_json("/api/v1/courses", &format!(r#"{{"slug": "{slug}", "title": "Course {slug}"}}"#)).expect(201);
        let wish = r#"{"title": "Milestone one", "visible": true,
            "settings": {"per_hour": 0, "forms": ["program", "sources", "traces"]}}"#;
        let path = format!("/api/v1/courses/{slug}/assignments/m1");
        admin.send("PUT", &path, JSON, wish.as_bytes()).expect(200);
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
        if std::thread::panicking() {
            let log = self.log();
            let from = log.len().saturating_sub(4000);
            eprintln!("the end of the server's log:\n{}", log.get(from..).unwrap_or(&log));
        }
    }
}

pub(crate) const JSON: &[(&str, &str)] = &[("Content-Type", "application/json")];

/// A client that sends HTTP requests.
#[derive(Debug, Clone)]
pub(crate) struct Client {
    pub(crate) url: String,
    pub(crate) headers: Vec<(String, String)>,
}

/// The server's answer.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) status: u16,
    pub(crate) headers: Vec<(String, String)>,
    pub(crate) body: Vec<u8>,
}

impl Client {
    /// Sends a request, and reads the answer to its end.
    pub(crate) fn send(&self, method: &str, path: &str, headers: &[(&str, &str)], body: &[u8]) -> Answer {
        self.try_send(method, path, headers, body).expect("an answer")
    }

    /// Sends a request to a server that may have ended.
    pub(crate) fn try_send(
        &self,
        method: &str,
        path: &str,
        headers: &[(&str, &str)],
        body: &[u8],
    ) -> std::io::Result<Answer> {
        let host = self.url.strip_prefix("http://").expect("an address");
        // HTTP/1.0: the answer ends with the connection, and is in one piece.
        let mut request = format!("{method} {path} HTTP/1.0\r\nHost: {host}\r\n");
        let own = self.headers.iter().map(|(name, value)| (name.as_str(), value.as_str()));
        for (name, value) in own.chain(headers.iter().copied()) {
            request.push_str(&format!("{name}: {value}\r\n"));
        }
        if method != "GET" {
            request.push_str(&format!("Content-Length: {}\r\n", body.len()));
        }
        request.push_str("\r\n");
        let mut stream = TcpStream::connect(host)?;
        stream.set_read_timeout(Some(Duration::from_secs(120)))?;
        stream.write_all(request.as_bytes())?;
        // A server may answer before it has received the whole body.
        drop(stream.write_all(body));
        Answer::read(&mut stream)
    }

    pub(crate) fn get(&self, path: &str) -> Answer {
        self.send("GET", path, &[], b"")
    }

    pub(crate) fn post_json(&self, path: &str, body: &str) -> Answer {
        self.send("POST", path, JSON, body.as_bytes())
    }

    /// Sends a form, as a browser does from a page of the server.
    pub(crate) fn post_form(&self, path: &str, body: &str) -> Answer {
        let headers = [("Content-Type", "application/x-www-form-urlencoded"), ("Sec-Fetch-Site", "same-origin")];
        self.send("POST", path, &headers, body.as_bytes())
    }

    /// Opens a link that signs in, and becomes a browser with a session.
    pub(crate) fn welcome(&self, secret: &str) -> Self {
        let answer = self.post_form(&format!("/welcome/{secret}"), "").expect(303);
        let cookie = answer.header("set-cookie").expect("a cookie");
        let cookie = cookie.split(';').next().expect("a value").to_owned();
        let headers = [("Cookie".to_owned(), cookie), ("Sec-Fetch-Site".to_owned(), "same-origin".to_owned())];
        Self { url: self.url.clone(), headers: headers.into() }
    }

    /// Submits a program, and returns the submission's number.
    pub(crate) fn submit(&self, course: &str, program: &[u8]) -> i64 {
        let path = format!("/api/v1/courses/{course}/assignments/m1/submissions?name=FOSSSim");
        self.send("POST", &path, &[], program).expect(201).json()["id"].as_i64().expect("a number")
    }

    /// Waits until a submission is graded.
    pub(crate) fn wait_for_grade(&self, course: &str, id: i64) -> serde_json::Value {
        let start = Instant::now();
        loop {
            let submission = self.get(&format!("/api/v1/courses/{course}/submissions/{id}")).expect(200).json();
            if matches!(submission["state"].as_str(), Some("done" | "buried")) {
                return submission;
            }
            assert!(start.elapsed() < Duration::from_secs(300), "not graded: {submission}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Answer {
    pub(crate) fn read(stream: &mut TcpStream) -> std::io::Result<Self> {
        let mut bytes = Vec::new();
        // A reset after the answer does no harm.
        if let Err(error) = stream.read_to_end(&mut bytes)
            && bytes.is_empty()
        {
            return Err(error);
        }
        let broken = || std::io::Error::from(std::io::ErrorKind::UnexpectedEof);
        let end = bytes.windows(4).position(|four| four == b"\r\n\r\n").ok_or_else(broken)?;
        let head = String::from_utf8_lossy(&bytes[..end]).into_owned();
        let mut lines = head.split("\r\n");
        let status = lines.next().and_then(|line| line.split(' ').nth(1)?.parse().ok()).ok_or_else(broken)?;
        let headers = lines
            .filter_map(|line| line.split_once(": "))
            .map(|(name, value)| (name.to_ascii_lowercase(), value.to_owned()))
            .collect();
        Ok(Self { status, headers, body: bytes[end + 4..].to_vec() })
    }

    #[track_caller]
    pub(crate) fn expect(self, status: u16) -> Self {
        assert_eq!(self.status, status, "{:?}\n{}", self.headers, self.text());
        self
    }

    pub(crate) fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    pub(crate) fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }

    #[track_caller]
    pub(crate) fn json(&self) -> serde_json::Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|error| panic!("{error}: {}", self.text()))
    }
}

/// Returns an archive with this many MiB of zeros.
pub(crate) fn bomb(mebibytes: usize) -> Vec<u8> {
    let mut tar = tar::Builder::new(flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best()));
    let mut header = tar::Header::new_gnu();
    header.set_size((mebibytes as u64) << 20);
    header.set_mode(0o644);
    let zeros = std::io::Read::take(std::io::repeat(0), (mebibytes as u64) << 20);
    tar.append_data(&mut header, "zeros", zeros).expect("an entry");
    tar.into_inner().expect("a tar").finish().expect("an archive")
}
