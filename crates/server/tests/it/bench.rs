//! Runs the benchmark of the service on a short ladder, and checks its table.
use crate::support::engines::{Fresh, run};
use fosssim_server::db::Address;

#[path = "../../benches/students/main.rs"]
mod students;

fn bench(arguments: &[&str]) -> String {
    let words = ["bench"].iter().chain(arguments).map(std::ffi::OsString::from);
    students::run(words).expect("the bench")
}

fn climbs(database: &[&str]) {
    let said = bench(&[&["--students", "2,5", "--seconds", "1"], database].concat());
    for students in ["2", "5"] {
        let row = said.lines().find(|line| line.starts_with(&format!("| {students} |"))).expect("a row");
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        assert_eq!(cells[8], "0", "errors: {said}");
        assert!(said.contains("refused 0, late 0"), "the deadline: {said}");
        assert!(cells[2..8].iter().all(|cell| cell.contains(" / ")), "every step was done: {said}");
    }
}

#[test]
fn the_ladder_is_climbed_on_sqlite() {
    climbs(&[]);
}

#[test]
fn the_ladder_is_climbed_on_postgres() {
    let Some(fresh) = run(Fresh::postgres()) else { return };
    let Address::Postgres(url) = &fresh.address else { panic!("no address of PostgreSQL") };
    climbs(&["--database", url]);
}

#[test]
fn others_are_answered_beside_attacks_and_many_submissions() {
    for (what, more) in [("slow-readers", &[][..]), ("million", &["--count", "2000"])] {
        let said = bench(&[&[what, "--seconds", "1"], more].concat());
        assert!(said.contains("memory") && said.contains("errors {}"), "{what}: {said}");
    }
}
