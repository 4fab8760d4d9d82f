//! The random events of a storm.
use super::arena::{Arena, Expected, signal};
use fosssim_server::values;
use std::time::Duration;

/// The size of a storm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Size {
    pub(super) submissions: usize,
    pub(super) kills: usize,
}

impl Size {
    /// Reads the size from `FOSSSIM_STORM=SUBMISSIONS,KILLS`. Without this variable it is small.
    pub(super) fn from_environment() -> Self {
        let Ok(words) = std::env::var("FOSSSIM_STORM") else { return Self { submissions: 48, kills: 24 } };
        let (submissions, kills) = words.split_once(',').expect("FOSSSIM_STORM=SUBMISSIONS,KILLS");
        Self { submissions: submissions.parse().expect("a number"), kills: kills.parse().expect("a number") }
    }
}

/// The number of events of each kind.
#[derive(Debug, Default)]
pub(super) struct Seen {
    pub(super) kills: usize,
    pub(super) freezes: usize,
    pub(super) cuts: usize,
    pub(super) outages: usize,
}

pub(super) struct Weather<'a> {
    arena: &'a mut Arena,
    size: Size,
    seen: Seen,
    random: u64,
}

impl<'a> Weather<'a> {
    pub(super) fn new(arena: &'a mut Arena, size: Size) -> Self {
        let seed = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).expect("a clock").as_nanos();
        Self { arena, size, seen: Seen::default(), random: u64::try_from(seed).expect("a date") | 1 }
    }

    /// Returns a random number below `below`.
    fn random(&mut self, below: usize) -> usize {
        // This is xorshift. Any order of events is sufficient, and none must be reproducible.
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        usize::try_from(self.random >> 33).expect("31 bits") % below
    }

    /// Submits everything gradually, while workers are killed, frozen and disconnected.
    pub(super) async fn blow(mut self) -> Seen {
        let mut handed_in = 0;
        while handed_in < self.size.submissions || self.seen.kills < self.size.kills {
            self.arena.replace_the_dead(3);
            // Submissions advance in proportion to the kills, so that both end together.
            let due = (self.seen.kills + 1) * self.size.submissions / self.size.kills.max(1);
            while handed_in < due.min(self.size.submissions) {
                self.hand_in(handed_in).await;
                handed_in += 1;
            }
            let pause = 100 + self.random(400);
            tokio::time::sleep(Duration::from_millis(u64::try_from(pause).expect("short"))).await;
            self.strike().await;
        }
        self.seen
    }

    /// Submits the next file. Among 24 files, one kills its worker each time, one kills its grader, two freeze their
    /// worker once, and the others are ordinary.
    async fn hand_in(&mut self, number: usize) {
        let name = format!("submission-{number}");
        let (kind, code) = match number % 24 {
            3 => ("poison", "JE"),
            11 => ("crash", "JE"),
            7 | 19 => ("freeze", "AC"),
            n if n % 3 == 0 => ("plain", "WA"),
            n if n % 5 == 0 => ("plain", "TLE"),
            _ => ("plain", "AC"),
        };
        let points = if code == "AC" { "100".to_owned() } else { format!("{}.5", number % 100) };
        let seconds = format!("0.{:02}", self.random(30));
        let expected = Expected { code: code.to_owned(), points: (code != "JE").then(|| points.clone()) };
        self.arena.hand_in(&name, &format!("{kind} {code} {points} {seconds}"), expected).await;
    }

    async fn strike(&mut self) {
        match self.random(20) {
            0 | 1 => self.freeze(),
            2 if self.arena.cluster.is_some() => self.cut().await,
            3 if self.seen.outages * 40 <= self.seen.kills => self.outage(),
            _ => self.kill(),
        }
    }

    fn kill(&mut self) {
        let victim = self.random(self.arena.workers.len());
        signal(&self.arena.workers[victim], libc::SIGKILL);
        self.arena.workers.swap_remove(victim).wait().expect("an end");
        self.seen.kills += 1;
    }

    /// Stops a worker. The arena continues it long after its lease has expired and others have its jobs.
    fn freeze(&mut self) {
        let victim = self.random(self.arena.workers.len());
        signal(&self.arena.workers[victim], libc::SIGSTOP);
        self.seen.freezes += 1;
    }

    /// Cuts all connections to PostgreSQL.
    async fn cut(&mut self) {
        if let Ok(mut transaction) = self.arena.database.begin().await {
            drop(
                transaction
                    .rows(
                        "SELECT CAST(pg_terminate_backend(pid) AS TEXT) AS cut FROM pg_stat_activity
                         WHERE application_name = 'fosssim-server' AND pid <> pg_backend_pid()",
                        values![],
                    )
                    .await,
            );
            self.seen.cuts += 1;
        }
    }

    /// Kills PostgreSQL itself, and starts it again a little later.
    fn outage(&mut self) {
        let pause = self.random(1500);
        if let Some(cluster) = &mut self.arena.cluster {
            cluster.kill();
            std::thread::sleep(Duration::from_millis(u64::try_from(pause).expect("short")));
            cluster.resume();
            self.seen.outages += 1;
        }
    }
}
