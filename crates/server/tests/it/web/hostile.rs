//! Tests requests of attackers.
use crate::support::{
    engines::{Fresh, on_sqlite, run},
    server::{Answer, Client, JSON, Server, bomb, program},
};
use std::{
    io::{Cursor, Write},
    net::TcpStream,
    time::Duration,
};
use zip::{ZipWriter, write::SimpleFileOptions};

on_sqlite!(words_of_sql_are_words);

const SUBMISSIONS: &str = "/api/v1/courses/physics/assignments/m1/submissions";

async fn start(options: &[&str]) -> (Fresh, Server, Client, Client) {
    let fresh = Fresh::sqlite().await.expect("SQLite");
    let mut server = Server::start(&fresh, options);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    (fresh, server, admin, ada)
}

async fn words_of_sql_are_words(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let name = "Robert'); DROP TABLE submission;-- \\ % _ {now} ? $1";
    let wish = serde_json::json!({"name": name, "role": "student"}).to_string();
    admin.send("PUT", "/api/v1/courses/physics/members/bobby", JSON, wish.as_bytes()).expect(200);
    let members = admin.get("/api/v1/courses/physics/members").expect(200).json();
    assert_eq!(members[0]["name"], name);
    let page = admin.get("/c/physics/members").expect(200).text();
    assert!(page.contains("Robert&#39;); DROP TABLE"), "{page}");
    admin.get("/api/v1/courses/physics'%20OR%20'1'='1/members").expect(404);
    admin.get("/api/v1/courses/physics/assignments/m1'--").expect(404);
    admin.get("/api/v1/courses/physics/submissions/1%20OR%201=1").expect(404);
    admin.get("/api/v1/audit?before=1;DROP").expect(400);
    admin.post_json("/api/v1/courses", r#"{"slug": "a'b", "title": "x"}"#).expect(400);
    admin.send("PUT", "/api/v1/courses/physics/members/a%0d%0ab", JSON, wish.as_bytes()).expect(400);
    let zero = serde_json::json!({"name": "a\u{0}b", "role": "student"}).to_string();
    admin.send("PUT", "/api/v1/courses/physics/members/zero", JSON, zero.as_bytes()).expect(400);
    server.visitor().get("/ready").expect(200);
}

#[test]
fn other_sites_can_change_nothing() {
    run(async {
        let (_fresh, mut server, admin, _) = start(&["--workers", "0"]).await;
        // A session, as in a browser.
        let wish = r#"{"name": "Eve", "role": "student"}"#;
        let link = admin.send("PUT", "/api/v1/courses/physics/members/eve", JSON, wish.as_bytes()).json();
        let link = link["link"].as_str().expect("a link").rsplit('/').next().expect("a secret").to_owned();
        let mut browser = server.visitor().welcome(&link);
        browser.headers.retain(|(name, _)| name == "Cookie");
        let host = server.url.clone();
        let post = |headers: &[(&str, &str)]| {
            let mut all = vec![("Content-Type", "application/x-www-form-urlencoded")];
            all.extend_from_slice(headers);
            let name = format!("name={}", headers.iter().map(|(name, _)| *name).collect::<String>());
            browser.send("POST", "/account/tokens", &all, name.as_bytes()).status
        };
        assert_eq!(post(&[("Sec-Fetch-Site", "same-origin")]), 200);
        assert_eq!(post(&[("Origin", &host)]), 200);
        for headers in [
            &[][..],
            &[("Sec-Fetch-Site", "cross-site")],
            &[("Sec-Fetch-Site", "same-site")],
            &[("Origin", "null")],
            &[("Origin", "http://evil.example")],
            &[("Origin", "http://127.0.0.1:1")],
            // The browser's own header has precedence.
            &[("Sec-Fetch-Site", "cross-site"), ("Origin", &host)],
        ] {
            assert_eq!(post(headers), 403, "{headers:?}");
        }
        // Scripts cannot read the cookie, and the API requires JSON, which no form can send.
        let answer = server.visitor().post_form("/sign-in", "token=fso_wrong").expect(401);
        assert!(answer.header("set-cookie").is_none());
        let own = [("Sec-Fetch-Site", "same-origin"), ("Content-Type", "text/plain")];
        browser.send("POST", "/api/v1/tokens", &own, br#"{"name": "x"}"#).expect(400);
        // After a sign-out, the old cookie is invalid.
        browser.headers.push(("Sec-Fetch-Site".to_owned(), "same-origin".to_owned()));
        browser.get("/account").expect(200);
        browser.post_form("/sign-out", "").expect(303);
        browser.get("/account").expect(303);
        assert!(server.stop().success());
    });
}

#[test]
fn cookies_and_headers_are_as_strict_as_can_be() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let options = ["--workers", "0", "--public-url", "https://grades.example.org/"];
        let mut server = Server::start(&fresh, &options);
        let link = server.first_link();
        let answer = server.visitor().post_form(&format!("/welcome/{link}"), "").expect(303);
        let cookie = answer.header("set-cookie").expect("a cookie");
        assert!(cookie.starts_with("__Host-fosssim="), "{cookie}");
        for word in ["; Path=/", "; HttpOnly", "; SameSite=Lax", "; Secure"] {
            assert!(cookie.contains(word), "{cookie}");
        }
        for (name, part) in [
            ("content-security-policy", "default-src 'none'; script-src 'self'"),
            ("content-security-policy", "frame-ancestors 'none'"),
            ("x-content-type-options", "nosniff"),
            ("referrer-policy", "same-origin"),
            ("cross-origin-opener-policy", "same-origin"),
            ("strict-transport-security", "max-age="),
            ("cache-control", "no-store"),
        ] {
            let page = server.visitor().get("/sign-in").expect(200);
            assert!(page.header(name).is_some_and(|value| value.contains(part)), "{name}: {:?}", page.headers);
        }
        // Over HTTP, the cookie with the other name is ignored.
        let secret = cookie.split(['=', ';']).nth(1).expect("a value").to_owned();
        let plain = Client { url: server.url.clone(), headers: vec![("Cookie".into(), format!("fosssim={secret}"))] };
        plain.get("/account").expect(303);
        let strict = Client {
            url: server.url.clone(),
            headers: vec![("Cookie".into(), format!("a=b; __Host-fosssim={secret}"))],
        };
        strict.get("/account").expect(200);
    });
}

#[test]
fn bodies_that_are_too_large_or_too_slow_are_given_up() {
    run(async {
        let (_fresh, server, admin, ada) = start(&["--workers", "0", "--patience", "5"]).await;
        let settings = br#"{"title": "M1", "visible": true, "settings": {"max_bytes": 100000}}"#;
        admin.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, settings).expect(200);
        // With an announced length, and in chunks without one.
        ada.send("POST", SUBMISSIONS, &[], &vec![b'#'; 100_001]).expect(413);
        let token = &ada.headers[0].1;
        let head = |path: &str, more: &str| {
            format!("POST {path} HTTP/1.1\r\nHost: x\r\nConnection: close\r\nAuthorization: {token}\r\n{more}\r\n\r\n")
        };
        let mut stream = connect(&server);
        stream.write_all(head(SUBMISSIONS, "Transfer-Encoding: chunked").as_bytes()).expect("a head");
        let chunk = format!("{:x}\r\n{}\r\n", 60_000, "#".repeat(60_000));
        stream.write_all(chunk.as_bytes()).expect("a chunk");
        stream.write_all(chunk.as_bytes()).expect("a chunk");
        assert_eq!(Answer::read(&mut stream).expect("an answer").status, 413);
        // A form that contains only names, and a form whose file is too large.
        let form = [("Content-Type", "multipart/form-data; boundary=x")];
        let head_only = format!("--x\r\nContent-Disposition: form-data; name=\"{}", "x".repeat(90_000 * 10));
        ada.send("POST", SUBMISSIONS, &form, head_only.as_bytes()).expect(400);
        let file = "--x\r\nContent-Disposition: form-data; name=\"file\"; filename=\"a\"\r\n\r\n";
        let too_large = format!("{file}{}\r\n--x--\r\n", "#".repeat(100_001));
        ada.send("POST", SUBMISSIONS, &form, too_large.as_bytes()).expect(413);
        // JSON has its own limit.
        let long = format!(r#"{{"name": "{}"}}"#, "x".repeat(2 << 20));
        ada.post_json("/api/v1/tokens", &long).expect(413);
        // The server does not wait for clients that stop in the middle of an upload or of JSON. All stop at the same
        // time.
        let stopped: Vec<(&str, TcpStream)> = [
            (SUBMISSIONS, "Content-Length: 1000"),
            ("/api/v1/tokens", "Content-Type: application/json\r\nContent-Length: 1000"),
        ]
        .into_iter()
        .map(|(path, more)| {
            let mut stream = connect(&server);
            stream.write_all(head(path, more).as_bytes()).expect("a head");
            stream.write_all(b"{").expect("a part");
            (path, stream)
        })
        .collect();
        for (path, mut stream) in stopped {
            let answer = Answer::read(&mut stream).expect("an answer");
            assert_eq!(answer.status, 408, "{path}: {}", answer.text());
        }
        // No further files are left behind.
        let left = std::fs::read_dir(server.folder.join("incoming")).expect("a folder").count();
        assert_eq!(left, 0);
        assert_eq!(ada.get(SUBMISSIONS).expect(200).json(), serde_json::json!([]));
    });
}

fn connect(server: &Server) -> TcpStream {
    let stream = TcpStream::connect(server.url.strip_prefix("http://").expect("an address")).expect("a connection");
    stream.set_read_timeout(Some(Duration::from_secs(120))).expect("a socket");
    stream
}

fn zip(files: &[(&str, &[u8], u32)]) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes, mode) in files {
        archive.start_file(*name, SimpleFileOptions::default().unix_permissions(*mode)).expect("an entry");
        archive.write_all(bytes).expect("bytes");
    }
    archive.finish().expect("an archive").into_inner()
}

/// Returns a tar archive with entries of any name and kind, even invalid ones.
fn tar(entries: &[(&str, tar::EntryType, &[u8])]) -> Vec<u8> {
    let mut archive = tar::Builder::new(Vec::new());
    for (name, kind, bytes) in entries {
        let mut header = tar::Header::new_ustar();
        header.as_mut_bytes()[..name.len()].copy_from_slice(name.as_bytes());
        header.set_entry_type(*kind);
        header.set_size(bytes.len() as u64);
        header.set_mode(0o644);
        if matches!(kind, tar::EntryType::Symlink | tar::EntryType::Link) {
            header.set_link_name("/etc/passwd").expect("a link");
        }
        header.set_cksum();
        archive.append(&header, *bytes).expect("an entry");
    }
    archive.into_inner().expect("an archive")
}

#[test]
fn archives_can_not_leave_their_folder() {
    run(async {
        let (_fresh, server, _, ada) = start(&["--workers", "0"]).await;
        use tar::EntryType as Kind;
        let refused: Vec<(&str, Vec<u8>, &str)> = vec![
            ("zip ..", zip(&[("a/../../x", b"1", 0o644)]), "with a forbidden name"),
            ("zip absolute", zip(&[("/etc/cron.d/x", b"1", 0o644)]), "with a forbidden name"),
            ("zip backslash", zip(&[("..\\x", b"1", 0o644)]), "with a forbidden name"),
            ("zip drive", zip(&[("C:x", b"1", 0o644)]), "with a forbidden name"),
            ("zip newline", zip(&[("a\r\nb", b"1", 0o644)]), "with a forbidden name"),
            ("tar ..", tar(&[("../x", Kind::Regular, b"1")]), "with a forbidden name"),
            ("tar absolute", tar(&[("/x", Kind::Regular, b"1")]), "with a forbidden name"),
            ("tar symlink", tar(&[("x", Kind::Symlink, b"")]), "neither a file nor a folder"),
            ("tar hard link", tar(&[("x", Kind::Link, b"")]), "neither a file nor a folder"),
            ("tar device", tar(&[("x", Kind::Char, b"")]), "neither a file nor a folder"),
            ("tar fifo", tar(&[("x", Kind::Fifo, b"")]), "neither a file nor a folder"),
            ("twice", tar(&[("x", Kind::Regular, b"1"), ("./x", Kind::Regular, b"2")]), "twice"),
            ("file and folder", tar(&[("x", Kind::Regular, b"1"), ("x/y", Kind::Regular, b"2")]), "twice"),
            ("folder and file", tar(&[("x/y", Kind::Regular, b"1"), ("x", Kind::Regular, b"2")]), "twice"),
            ("cut off", zip(&[("x", &[7; 5000], 0o644)])[..60].to_vec(), "damaged"),
            ("empty", tar(&[]), "expected a program"),
        ];
        // Two entries with the same name, which no library writes.
        let mut doubled = zip(&[("one", b"#!grade AC 1", 0o755), ("two", b"#!grade AC 2", 0o755)]);
        let places: Vec<usize> = (0..doubled.len() - 3).filter(|&at| &doubled[at..at + 3] == b"two").collect();
        places.iter().for_each(|&at| doubled[at..at + 3].copy_from_slice(b"one"));
        assert_eq!(places.len(), 2);
        let refused: Vec<_> = refused.into_iter().chain([("zip twice", doubled, "twice")]).collect();
        for (name, bytes, reason) in &refused {
            let answer = ada.send("POST", SUBMISSIONS, &[], bytes).expect(422);
            assert!(answer.text().contains(reason), "{name}: {}", answer.text());
        }
        // An archive bomb: 300 MiB of zeros in 300 KiB.
        let mut bomb = ZipWriter::new(Cursor::new(Vec::new()));
        let options = SimpleFileOptions::default().compression_method(zip::CompressionMethod::Deflated);
        let zeros = vec![0; 1 << 20];
        bomb.start_file("zeros", options).expect("an entry");
        for _ in 0..300 {
            bomb.write_all(&zeros).expect("bytes");
        }
        let bomb = bomb.finish().expect("an archive").into_inner();
        assert!(bomb.len() < 1 << 20);
        let answer = ada.send("POST", SUBMISSIONS, &[], &bomb).expect(422);
        assert!(answer.text().contains("the unpacked archive has more than"), "{}", answer.text());
        // An archive as students create it.
        let fine = zip(&[("mine/FOSSSim", b"#!grade AC 1\n", 0o755), ("mine/src/main.cpp", b"int main() {}", 0o644)]);
        ada.send("POST", SUBMISSIONS, &[], &fine).expect(201);
        assert_eq!(std::fs::read_dir(server.folder.join("incoming")).expect("a folder").count(), 0);
    });
}

/// Finder and Explorer add their own files. The single folder that the student packed is still the submission.
#[test]
fn archives_of_file_managers_are_graded() {
    run(async {
        let (_fresh, _server, _, ada) = start(&["--workers", "1"]).await;
        let program = b"#!grade AC 77\n".as_slice();
        let mac = zip(&[
            ("project/FOSSSim", program, 0o755),
            ("__MACOSX/project/._FOSSSim", b"attributes", 0o644),
            (".DS_Store", b"windows", 0o644),
            ("project/.DS_Store", b"windows", 0o644),
        ]);
        let windows = zip(&[("project/FOSSSim", program, 0o755), ("desktop.ini", b"", 0o644)]);
        for archive in [mac, windows] {
            let sent = ada.send("POST", SUBMISSIONS, &[], &archive).expect(201).json();
            let graded = ada.wait_for_grade("physics", sent["id"].as_i64().expect("a number"));
            assert_eq!(graded["grade"]["points"], "77", "{graded}");
        }
    });
}

/// Archives that contain a build of another machine, and files of other kinds.
#[test]
fn archives_of_all_kinds_are_graded() {
    run(async {
        let (_fresh, _server, _, ada) = start(&["--workers", "1"]).await;
        let (program, cache) = (b"#!grade AC 77\n".as_slice(), b"of another machine".as_slice());
        // As Explorer packs it, without permissions.
        let windows = zip(&[("project/FOSSSim", program, 0), ("project/build/CMakeCache.txt", cache, 0)]);
        let unix = tar(&[("project/FOSSSim", tar::EntryType::Regular, program)]);
        for archive in [windows, unix] {
            let sent = ada.send("POST", SUBMISSIONS, &[], &archive).expect(201).json();
            assert_eq!(sent["form"], "sources");
            let graded = ada.wait_for_grade("physics", sent["id"].as_i64().expect("a number"));
            assert_eq!(graded["grade"]["points"], "77", "{graded}");
        }
        let refused =
            ada.send("POST", SUBMISSIONS, &[], &zip(&[("hw/main.cpp", b"int main() {}", 0)])).expect(422).text();
        assert!(refused.contains("expected the program FOSSSim in the archive"), "{refused}");
        assert!(refused.contains("found hw/main.cpp"), "{refused}");
        for (bytes, found) in [
            (b"MZ\x90\x00\x03".as_slice(), "found a program for Windows"),
            (b"\xcf\xfa\xed\xfe\x0c\x00", "found a program for macOS"),
            (b"Rar!\x1a\x07\x00", "found a RAR archive"),
            (b"7z\xbc\xaf\x27\x1c\x00\x04", "found a 7z archive"),
            (b"\xfd7zXZ\0\0\x04", "found a file compressed by xz"),
            (b"int main() { return 0; }\n", "found text"),
            (b"\x01\x02\x03\x04\x05", "found a file that begins with the bytes 01 02 03 04"),
        ] {
            let refused = ada.send("POST", SUBMISSIONS, &[], bytes).expect(422).text();
            assert!(refused.contains(found) && refused.contains("expected a program for Linux"), "{refused}");
        }
    });
}

#[test]
fn suites_keep_to_themselves() {
    run(async {
        let (_fresh, server, admin, ada) = start(&["--workers", "0"]).await;
        let path = "/api/v1/courses/physics/assignments/m1/suite";
        let send = |suite: &str| admin.send("PUT", path, &[], &zip(&[("suite.toml", suite.as_bytes(), 0o644)]));
        for scene in ["/etc/passwd", "../../fosssim.db", "scenes/../../x"] {
            let suite = format!("schema = 1\n[[group]]\nname = 'a'\nscenes = ['asset:x', '{scene}']\n");
            let answer = send(&suite).expect(422);
            assert!(answer.text().contains("is not in the archive"), "{}", answer.text());
        }
        assert!(send("group = [").expect(422).text().contains("suite.toml can't be read"));
        let without = zip(&[("deeper/suite.toml", b"schema = 1", 0o644)]);
        assert!(admin.send("PUT", path, &[], &without).expect(422).text().contains("no suite.toml"));
        send("schema = 1\n[[group]]\nname = 'a'\nscenes = ['asset:x', 'scenes/*.xml']\n").expect(200);
        ada.send("PUT", path, &[], b"").expect(403);
        assert_eq!(std::fs::read_dir(server.folder.join("incoming")).expect("a folder").count(), 0);
    });
}

#[test]
fn addresses_lead_nowhere_else() {
    run(async {
        let (_fresh, server, _, ada) = start(&["--workers", "1"]).await;
        let id = ada.submit("physics", &program("AC", 1));
        ada.wait_for_grade("physics", id);
        for path in [
            format!("/api/v1/courses/physics/submissions/{id}/files/..%2F..%2Ffosssim.db"),
            format!("/api/v1/courses/physics/submissions/{id}/files/%2e%2e"),
            format!("/api/v1/courses/physics/submissions/{id}/files/..%2f..%2f..%2fetc%2fpasswd"),
            "/static/..%2f..%2fCargo.toml".to_owned(),
            "/static/../../etc/passwd".to_owned(),
            "/c/physics%00/members".to_owned(),
            "/c/%ff".to_owned(),
            "//evil.example/".to_owned(),
        ] {
            let answer = ada.get(&path);
            assert!(matches!(answer.status, 400 | 404), "{path}: {}", answer.status);
            assert!(!answer.text().contains("root:"), "{path}");
        }
        // Names of files and all values in headers are converted to plain characters.
        let path = format!("{SUBMISSIONS}?name=a%0d%0aSet-Cookie:%20x=1%22;%20filename=evil.html");
        let sent = ada.send("POST", &path, &[], &program("AC", 2)).expect(201).json();
        assert_eq!(sent["file_name"], "a__Set-Cookie__x_1___filename_evil.html");
        let upload = ada.get(&format!("/api/v1/courses/physics/submissions/{}/upload", sent["id"])).expect(200);
        assert!(upload.header("set-cookie").is_none());
        assert_eq!(upload.header("content-type"), Some("application/octet-stream"));
        // An address cannot write lines into the log.
        ada.get("/nowhere%0aERROR%20forged");
        assert!(!server.log().contains("forged"));
    });
}

#[test]
fn one_account_can_not_flood_the_server() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let mut server = Server::start(&fresh, &["--workers", "0", "--requests-per-minute", "20"]);
        let admin = server.admin();
        let refused = (0..40).map(|_| admin.get("/api/v1/me")).find(|answer| answer.status == 429);
        let refused = refused.expect("a refusal");
        assert!(refused.header("retry-after").is_some());
        // Other people are not hindered, and neither are visitors.
        server.visitor().get("/health").expect(200);
        server.visitor().get("/sign-in").expect(200);
    });
}

#[test]
fn the_page_that_checks_traces_is_the_graders_and_has_a_policy_of_its_own() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let server = Server::start(&fresh, &["--workers", "0"]);
        let page = server.visitor().get("/check").expect(200);
        // Its name is replaced by a link.
        let name = "<strong class=\"brand\">fosssim-oracle</strong>";
        assert!(include_str!("../../../../browser/page/body.html").contains(name));
        assert!(page.text().ends_with("<a href=\"/\">Courses</a>the checker"), "{}", page.text());
        assert_eq!(page.header("content-security-policy"), Some("default-src 'none'"));
        assert_eq!(page.header("x-content-type-options"), Some("nosniff"));
    });
}

/// A bomb is rejected before it is unpacked completely. Programs are accepted meanwhile, and rejected archives are
/// counted.
#[test]
fn bombs_are_refused_and_counted_and_keep_nobody_waiting() {
    run(async {
        let (_fresh, server, admin, ada) = start(&["--workers", "0"]).await;
        let eve = server.member(&admin, "physics", "eve", "student");
        let bomb = bomb(80);
        std::thread::scope(|scope| {
            let sending: Vec<_> = (0..8).map(|_| scope.spawn(|| eve.send("POST", SUBMISSIONS, &[], &bomb))).collect();
            ada.submit("physics", &program("AC", 1));
            for one in sending {
                let text = one.join().expect("an answer").expect(422).text();
                assert!(text.contains("has more than 52428800 bytes"), "{text}");
            }
        });
        let damaged = zip(&[("x", &[7; 5000], 0o644)])[..60].to_vec();
        let refused =
            (0..200).map(|_| eve.send("POST", SUBMISSIONS, &[], &damaged)).find(|answer| answer.status != 422);
        let refused = refused.expect("refused archives count").expect(429).text();
        assert!(refused.contains("more than 30 of your archives were rejected"), "{refused}");
        // Other people's archives are not counted with them.
        ada.send("POST", SUBMISSIONS, &[], &damaged).expect(422);
        assert_eq!(std::fs::read_dir(server.folder.join("incoming")).expect("a folder").count(), 0);
    });
}
