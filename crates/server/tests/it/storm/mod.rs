//! Runs storms on both engines: real workers are killed, frozen and disconnected at random moments while submissions
//! arrive. Each accepted submission is graded once, with the same result as without disturbances.
//!
//! Storms are small by default. `scripts/crash-test` runs them at full size and prints the table of
//! docs/server/crash-test.md.

mod arena;
mod deeds;
mod grader;
mod servers;
mod weather;

use arena::{Arena, Expected};
use weather::{Size, Weather};

/// Runs a storm, and checks all conditions that must be true afterwards.
async fn storm(mut arena: Arena, name: &str) {
    let size = Size::from_environment();
    let start = std::time::Instant::now();
    let seen = Weather::new(&mut arena, size).blow().await;
    arena.wait_until_all_is_done().await;
    arena.calm_down();
    let found = arena.inspect().await;
    println!(
        "| {name} | {} | {} | {} | {} | {} | {} | {} | {} | {} of {} | {} | {:.0} s |",
        found.accepted,
        seen.kills,
        seen.freezes,
        seen.cuts,
        seen.outages,
        found.lost.len(),
        found.graded_twice.len(),
        found.wrong.len(),
        found.buried,
        arena.count(Expected::is_judge_error),
        found.late,
        start.elapsed().as_secs_f64()
    );
    println!("tries of the others: {:?}", found.tries);
    assert_eq!(found.accepted, size.submissions);
    assert_eq!(found.lost, Vec::<String>::new(), "accepted, and without a grade");
    assert_eq!(found.graded_twice, Vec::<String>::new(), "more than one grade");
    assert_eq!(found.wrong, Vec::<String>::new(), "another grade than in calm weather");
    assert_eq!(found.buried, arena.count(Expected::is_judge_error), "each poison ends, and nothing else is given up");
    assert_eq!(found.left_behind, Vec::<String>::new(), "left behind by dead workers");
    assert!(seen.kills >= size.kills, "{seen:?}");
}

#[test]
fn on_sqlite() {
    crate::support::engines::run(async { storm(Arena::sqlite().await, "SQLite").await });
}

#[test]
fn on_postgres() {
    crate::support::engines::run(async {
        let Some(arena) = Arena::postgres().await else { return };
        storm(arena, "PostgreSQL").await;
    });
}
