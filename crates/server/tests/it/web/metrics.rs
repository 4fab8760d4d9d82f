//! Tests the metrics in Prometheus' text format.
use crate::support::{
    engines::{Fresh, on_sqlite, run},
    server::{Server, program},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    io::Write,
    process::{Command, Stdio},
};

/// Returns the series of a text, by name and labels. Checks that the text follows the format: every family occurs once,
/// has its help and type before its samples, and has a name that ends as the conventions require.
fn read(text: &str) -> BTreeMap<String, f64> {
    let mut families = BTreeMap::new();
    let mut helped = BTreeSet::new();
    let mut series = BTreeMap::new();
    assert!(text.ends_with('\n'));
    let is_name = |name: &str| name.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_') && !name.is_empty();
    for line in text.lines() {
        if let Some(rest) = line.strip_prefix("# HELP ") {
            let (name, help) = rest.split_once(' ').expect("a help");
            assert!(is_name(name) && !help.is_empty() && helped.insert(name.to_owned()), "{line}");
        } else if let Some(rest) = line.strip_prefix("# TYPE ") {
            let (name, kind) = rest.split_once(' ').expect("a type");
            assert!(matches!(kind, "counter" | "gauge" | "histogram"), "{line}");
            assert_eq!(kind == "counter", name.ends_with("_total"), "{line}");
            assert!(!name.contains("milli"), "base units: {line}");
            assert!(helped.contains(name) && families.insert(name.to_owned(), kind.to_owned()).is_none(), "{line}");
        } else {
            let (id, value) = line.rsplit_once(' ').expect("a value");
            let name = id.split('{').next().expect("a name");
            if let Some((_, labels)) = id.split_once('{') {
                let labels = labels.strip_suffix("\"}").expect("labels");
                for label in labels.split("\",") {
                    let (name, _) = label.split_once("=\"").expect("a label");
                    assert!(is_name(name), "{line}");
                }
            }
            let family = ["_bucket", "_sum", "_count"].iter().find_map(|end| name.strip_suffix(end));
            let family = family.filter(|family| families.get(*family).is_some_and(|kind| kind == "histogram"));
            assert!(families.contains_key(family.unwrap_or(name)), "no type before {line}");
            let value = value.parse().expect("a number");
            assert!(series.insert(id.to_owned(), value).is_none(), "twice: {line}");
        }
    }
    series
}

on_sqlite!(a_monitor_sees_requests_queue_process_and_disk);

async fn a_monitor_sees_requests_queue_process_and_disk(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let id = ada.submit("physics", &program("WA", 40));
    ada.wait_for_grade("physics", id);
    let visitor = server.visitor();
    visitor.get("/no/such/secret-page").expect(404);
    visitor.send("BREW", "/health", &[], b"");
    let answer = visitor.get("/metrics").expect(200);
    assert_eq!(answer.header("content-type"), Some("text/plain; version=0.0.4; charset=utf-8"));
    let text = answer.text();
    let seen = read(&text);
    let of = |id: &str| *seen.get(id).unwrap_or_else(|| panic!("no {id} in\n{text}"));
    let route = "/api/v1/courses/{course}/assignments/{assignment}/submissions";
    assert_eq!(of(&format!("http_requests_total{{method=\"POST\",route=\"{route}\",status=\"201\"}}")), 1.0);
    let timed = format!("method=\"POST\",route=\"{route}\"");
    assert_eq!(of(&format!("http_request_duration_seconds_count{{{timed}}}")), 1.0);
    assert_eq!(of(&format!("http_request_duration_seconds_bucket{{{timed},le=\"+Inf\"}}")), 1.0);
    assert_eq!(of("http_requests_total{method=\"GET\",route=\"none\",status=\"404\"}"), 1.0);
    assert_eq!(of("http_requests_in_flight"), 1.0, "this one");
    // Invented addresses and methods do not become separate series.
    assert!(!text.contains("secret-page") && !text.contains("BREW") && !text.contains("ada"), "{text}");
    assert_eq!((of("fosssim_jobs{state=\"done\"}"), of("fosssim_jobs{state=\"waiting\"}")), (1.0, 0.0));
    assert_eq!((of("fosssim_submissions_total"), of("fosssim_events_total{kind=\"graded\"}")), (1.0, 1.0));
    assert_eq!(
        (of("fosssim_database_up"), of("fosssim_workers"), of("fosssim_oldest_waiting_seconds")),
        (1.0, 1.0, 0.0)
    );
    assert!(of("process_cpu_seconds_total") >= 0.0 && of("process_resident_memory_bytes") > 1e6);
    assert!(of("process_open_fds") > 3.0 && of("process_start_time_seconds") > 1e9);
    assert!(of("fosssim_disk_free_bytes") > 0.0 && of("fosssim_disk_size_bytes") > of("fosssim_disk_free_bytes"));
    let by_state =
        ["working", "idle", "aside"].map(|state| of(&format!("fosssim_workers_by_state{{state=\"{state}\"}}")));
    assert_eq!((by_state.iter().sum::<f64>(), by_state[2]), (1.0, 0.0), "{by_state:?}");
    assert_eq!(of(&format!("fosssim_build_info{{version=\"{}\"}}", env!("CARGO_PKG_VERSION"))), 1.0);
    // Check the text with Prometheus' own tool, if it is installed.
    if let Ok(mut promtool) =
        Command::new("promtool").args(["check", "metrics"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()
    {
        promtool.stdin.take().expect("its input").write_all(text.as_bytes()).expect("written");
        let said = promtool.wait_with_output().expect("an answer");
        assert!(said.status.success() && said.stdout.is_empty(), "{}", String::from_utf8_lossy(&said.stdout));
    }
}

#[test]
fn a_judge_error_counts_as_buried_and_not_as_graded() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let mut server = Server::start(&fresh, &["--workers", "1", "--lease", "1", "--tries", "1"]);
        let admin = server.admin();
        server.course(&admin, "physics");
        let ada = server.member(&admin, "physics", "ada", "student");
        // A result that is not a grade.
        let id = ada.submit("physics", b"#!grade WA forty\n");
        assert_eq!(ada.wait_for_grade("physics", id)["state"], "buried");
        let seen = read(&server.visitor().get("/metrics").expect(200).text());
        assert_eq!(seen["fosssim_jobs{state=\"buried\"}"], 1.0);
        assert_eq!(
            (seen["fosssim_events_total{kind=\"graded\"}"], seen["fosssim_events_total{kind=\"buried\"}"]),
            (0.0, 1.0)
        );
    });
}
