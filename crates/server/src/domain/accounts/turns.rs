//! Turns for checking archives, which may occupy a processor for seconds. An account has one turn at a time. The
//! account with the least recent use is first, so that no account has to wait for the bad uploads of another.
use crate::problem::{Problem, ensure};
use std::{
    collections::{BTreeMap, HashMap},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};
use tokio::sync::Notify;

/// The number of archives that are checked in parallel. Each may need about 100 MiB, and a whole processor.
const MAX_RUNNING: usize = 2;

/// The maximum time that an archive waits for a turn.
const WAIT_LIMIT: Duration = Duration::from_secs(60);

/// The number of seconds after which used time counts half.
const HALF_LIFE: f64 = 60.0;

/// The number of accounts above which accounts without recent use are removed from memory.
const MAX_ACCOUNTS: usize = 10_000;

/// The queue of the archives of all accounts.
#[derive(Debug, Default, Clone)]
pub(in crate::domain) struct ArchiveQueue(Arc<TurnParts>);

#[derive(Debug, Default)]
struct TurnParts {
    state: Mutex<TurnState>,
    changed: Notify,
}

#[derive(Debug, Default)]
struct TurnState {
    /// The accounts whose archives are being checked.
    running: Vec<i64>,
    /// The waiting accounts, by the numbers of their tickets.
    waiting: BTreeMap<u64, i64>,
    next: u64,
    /// For each account, the seconds of checking that it used recently, and the time when they were last updated.
    usage: HashMap<i64, (f64, Instant)>,
}

/// A turn, or a position in the queue for one. It ends when this value is dropped.
#[derive(Debug)]
pub struct ArchiveTurn {
    turns: ArchiveQueue,
    account: i64,
    ticket: u64,
    start_time: Option<Instant>,
}

impl TurnState {
    fn used_seconds(&self, account: i64, now: Instant) -> f64 {
        let Some((seconds, at)) = self.usage.get(&account) else { return 0.0 };
        seconds * 0.5_f64.powf(now.saturating_duration_since(*at).as_secs_f64() / HALF_LIFE)
    }

    /// Returns the next ticket, if a turn is free.
    fn first_ticket(&self, now: Instant) -> Option<u64> {
        let ready = self.waiting.iter().filter(|(_, account)| !self.running.contains(account));
        let rank = |(ticket, account): &(&u64, &i64)| (self.used_seconds(**account, now), **ticket);
        let first = ready.min_by(|one, other| rank(one).partial_cmp(&rank(other)).unwrap_or(std::cmp::Ordering::Equal));
        first.map(|(ticket, _)| *ticket).filter(|_| self.running.len() < MAX_RUNNING)
    }
}

impl ArchiveQueue {
    fn state(&self) -> MutexGuard<'_, TurnState> {
        self.0.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for an account's turn.
    pub(in crate::domain) async fn wait(&self, account: i64) -> Result<ArchiveTurn, Problem> {
        let ticket = {
            let mut state = self.state();
            state.next += 1;
            let ticket = state.next;
            state.waiting.insert(ticket, account);
            ticket
        };
        let mut turn = ArchiveTurn { turns: self.clone(), account, ticket, start_time: None };
        let until = tokio::time::Instant::now() + WAIT_LIMIT;
        loop {
            let changed = self.0.changed.notified();
            tokio::pin!(changed);
            // After this line, no notification is missed.
            changed.as_mut().enable();
            {
                let mut state = self.state();
                if state.first_ticket(Instant::now()) == Some(ticket) {
                    state.waiting.remove(&ticket);
                    state.running.push(account);
                    turn.start_time = Some(Instant::now());
                    drop(state);
                    // The turn may now belong to a different account.
                    self.0.changed.notify_waiters();
                    return Ok(turn);
                }
            }
            ensure(
                tokio::time::timeout_at(until, changed).await.is_ok(),
                Problem::unavailable("too many archives are being checked"),
            )?;
        }
    }
}

impl Drop for ArchiveTurn {
    fn drop(&mut self) {
        let mut state = self.turns.state();
        let now = Instant::now();
        state.waiting.remove(&self.ticket);
        if let Some(began) = self.start_time {
            let position = state.running.iter().position(|account| *account == self.account);
            position.map(|place| state.running.swap_remove(place));
            if state.usage.len() > MAX_ACCOUNTS {
                state.usage.retain(|_, (_, at)| now.saturating_duration_since(*at).as_secs_f64() < 10.0 * HALF_LIFE);
            }
            let seconds = state.used_seconds(self.account, now) + now.saturating_duration_since(began).as_secs_f64();
            state.usage.insert(self.account, (seconds, now));
        }
        drop(state);
        self.turns.0.changed.notify_waiters();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn who_took_least_goes_first_and_nobody_has_two_turns() {
        let turns = ArchiveQueue::default();
        let now = Instant::now();
        turns.state().usage.insert(1, (30.0, now));
        let (one, two) = (turns.wait(1).await.expect("a turn"), turns.wait(2).await.expect("a turn"));
        let wait = |account| {
            let turns = turns.clone();
            tokio::spawn(async move { turns.wait(account).await.map(|turn| turn.account) })
        };
        let (again, bomber, other) = (wait(1), wait(1), wait(3));
        while turns.state().waiting.len() < 3 {
            tokio::task::yield_now().await;
        }
        assert_eq!(turns.state().first_ticket(now), None, "all places are taken");
        drop(two);
        assert_eq!(other.await.expect("no panic").expect("a turn"), 3, "the one who came last took least");
        assert!(!again.is_finished() && !bomber.is_finished(), "an account has one turn");
        bomber.abort();
        drop(one);
        assert_eq!(again.await.expect("no panic").expect("a turn"), 1);
        drop(bomber.await);
        assert!(turns.state().running.is_empty() && turns.state().waiting.is_empty());
    }
}
