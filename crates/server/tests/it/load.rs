//! Many clients at once: what is uploaded is graded, all of it. How long it took is printed, and held against nobody.
//!
//! Small by default; `scripts/load-test` runs it at full size and prints the table of docs/service.md.
use crate::support::{
    engines::{Fresh, run},
    server::{Client, Server, program},
};
use std::time::{Duration, Instant};

/// What one client saw.
#[derive(Default)]
struct Seen {
    uploads: Vec<Duration>,
    statuses: Vec<Duration>,
    verdicts: Vec<Duration>,
    graded: usize,
}

fn client(client: &Client, number: usize, uploads: usize) -> Seen {
    let mut seen = Seen::default();
    for upload in 0..uploads {
        let points = u32::try_from((number * 31 + upload) % 100).expect("small");
        let start = Instant::now();
        let id = client.submit("physics", &program("WA", points));
        seen.uploads.push(start.elapsed());
        let submission = loop {
            let asked = Instant::now();
            let submission = client.get(&format!("/api/v1/courses/physics/submissions/{id}")).expect(200).json();
            seen.statuses.push(asked.elapsed());
            if matches!(submission["state"].as_str(), Some("done" | "buried")) {
                break submission;
            }
            // As often as a page looks when it hears nothing.
            std::thread::sleep(Duration::from_millis(500));
        };
        seen.verdicts.push(start.elapsed());
        assert_eq!(submission["grade"]["points"], points.to_string(), "{submission}");
        seen.graded += 1;
    }
    seen
}

/// The value that so many percent do not exceed, in milliseconds.
fn percentile(values: &mut [Duration], percent: usize) -> u128 {
    values.sort_unstable();
    values[(values.len() * percent).div_ceil(100).max(1) - 1].as_millis()
}

fn load(fresh: &Fresh, name: &str) {
    let size = std::env::var("FOSSSIM_LOAD").unwrap_or_else(|_| "40,8".to_owned());
    let (uploads, clients) = size.split_once(',').expect("FOSSSIM_LOAD=UPLOADS,CLIENTS");
    let (uploads, clients): (usize, usize) = (uploads.parse().expect("a number"), clients.parse().expect("a number"));
    let mut server = Server::start(fresh, &["--workers", "2", "--requests-per-minute", "100000"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let people: Vec<Client> =
        (0..clients).map(|number| server.member(&admin, "physics", &format!("s{number}"), "student")).collect();
    let start = Instant::now();
    let mut all = Seen::default();
    std::thread::scope(|scope| {
        let running: Vec<_> = people
            .iter()
            .enumerate()
            .map(|(number, person)| scope.spawn(move || client(person, number, uploads / clients)))
            .collect();
        for seen in running {
            let seen = seen.join().expect("a client");
            all.uploads.extend(seen.uploads);
            all.statuses.extend(seen.statuses);
            all.verdicts.extend(seen.verdicts);
            all.graded += seen.graded;
        }
    });
    let took = start.elapsed().as_secs_f64();
    let lines = admin.get("/api/v1/courses/physics/assignments/m1/export?format=jsonl").expect(200).text();
    assert_eq!(
        (all.graded, lines.lines().count()),
        (uploads / clients * clients, all.graded),
        "nothing is lost or doubled"
    );
    #[expect(clippy::cast_precision_loss, reason = "thousands")]
    let per_minute = all.graded as f64 * 60.0 / took;
    println!(
        "| {name} | {} from {clients} | {} / {} ms | {} / {} ms | {} / {} ms | {per_minute:.0} | {} MB |",
        all.graded,
        percentile(&mut all.uploads, 50),
        percentile(&mut all.uploads, 99),
        percentile(&mut all.statuses, 50),
        percentile(&mut all.statuses, 99),
        percentile(&mut all.verdicts, 50),
        percentile(&mut all.verdicts, 99),
        server.peak_memory() >> 20,
    );
}

#[test]
fn on_sqlite() {
    run(async { load(&Fresh::sqlite().await.expect("SQLite").with_tables().await, "SQLite") });
}

#[test]
fn on_postgres() {
    run(async {
        let Some(fresh) = Fresh::postgres().await else { return };
        load(&fresh.with_tables().await, "PostgreSQL");
    });
}
