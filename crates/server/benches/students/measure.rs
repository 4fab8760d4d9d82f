//! Collects the durations of answers, and the resources that the server and the machine used (from `/proc`).
use std::{collections::BTreeMap, fs, time::Duration};

/// The durations of each kind of request, and the number of failures.
#[derive(Default)]
pub(super) struct Times {
    pub(super) by_step: BTreeMap<&'static str, Vec<Duration>>,
    pub(super) errors: BTreeMap<String, usize>,
}

impl Times {
    pub(super) fn note(&mut self, step: &'static str, took: Duration) {
        self.by_step.entry(step).or_default().push(took);
    }

    pub(super) fn failed(&mut self, step: &str, why: impl std::fmt::Display) {
        *self.errors.entry(format!("{step}: {why}")).or_default() += 1;
    }

    pub(super) fn add(&mut self, other: Self) {
        for (step, times) in other.by_step {
            self.by_step.entry(step).or_default().extend(times);
        }
        for (error, count) in other.errors {
            *self.errors.entry(error).or_default() += count;
        }
    }

    /// Returns `p50 / p95 / p99` of a step, in milliseconds.
    pub(super) fn percentiles(&mut self, step: &str) -> String {
        let Some(times) = self.by_step.get_mut(step).filter(|times| !times.is_empty()) else { return "-".to_owned() };
        times.sort_unstable();
        let of = |percent: usize| times[(times.len() * percent).div_ceil(100).max(1) - 1].as_millis();
        format!("{} / {} / {}", of(50), of(95), of(99))
    }
}

/// The processor time that processes and the machine have used, in clock ticks.
#[derive(Clone, Copy)]
pub(super) struct Spent {
    server: u64,
    graders: u64,
    clients: u64,
    busy: u64,
    waiting: u64,
    all: u64,
}

/// Shares of the processors, in percent.
pub(super) struct TimeShares {
    pub(super) server: u64,
    pub(super) graders: u64,
    pub(super) clients: u64,
    pub(super) others: u64,
    pub(super) disk: u64,
}

/// Returns the processor times of a process, and of the children that it has waited for.
fn read_process(name: &str) -> (u64, u64) {
    let text = fs::read_to_string(format!("/proc/{name}/stat")).unwrap_or_default();
    let fields: Vec<u64> =
        text.rsplit(')').next().unwrap_or_default().split(' ').map(|field| field.parse().unwrap_or(0)).collect();
    let at = |index: usize| fields.get(index).copied().unwrap_or(0);
    // Fields 14 to 17. The text after the name begins with a space and field 3.
    (at(12) + at(13), at(14) + at(15))
}

impl Spent {
    pub(super) fn now(server: u32) -> Self {
        let text = fs::read_to_string("/proc/stat").unwrap_or_default();
        let fields: Vec<u64> = text
            .lines()
            .next()
            .unwrap_or_default()
            .split_whitespace()
            .skip(1)
            .map(|field| field.parse().unwrap_or(0))
            .collect();
        let at = |index: usize| fields.get(index).copied().unwrap_or(0);
        let (idle, waiting, all) = (at(3), at(4), fields.iter().take(8).sum::<u64>());
        let (own, graders) = read_process(&server.to_string());
        Self { server: own, graders, clients: read_process("self").0, busy: all - idle - waiting, waiting, all }
    }

    pub(super) fn since(self, before: Self) -> TimeShares {
        let all = (self.all - before.all).max(1);
        let percent = |now: u64, then: u64| now.saturating_sub(then) * 100 / all;
        let (server, graders) = (percent(self.server, before.server), percent(self.graders, before.graders));
        let clients = percent(self.clients, before.clients);
        let busy = percent(self.busy, before.busy);
        let others = busy.saturating_sub(server + graders + clients);
        TimeShares { server, graders, clients, others, disk: percent(self.waiting, before.waiting) }
    }
}

impl TimeShares {
    /// Returns the bottleneck that limited the throughput.
    pub(super) fn bound(&self) -> String {
        let busy = self.server + self.graders + self.clients + self.others;
        let who = format!(
            "server {}, graders {}, clients {}, others {}",
            self.server, self.graders, self.clients, self.others
        );
        match (busy, self.disk) {
            (90.., _) => format!("processors ({who} %)"),
            (_, 20..) => format!("disk (waited for {} % of the time; {who} %)", self.disk),
            _ => format!("waiting ({who} %)"),
        }
    }
}

/// Returns the peak memory of a process since [`forget_peak`], in MiB.
pub(super) fn peak(process: u32) -> u64 {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or_default();
    line.trim().trim_end_matches(" kB").parse::<u64>().unwrap_or(0).div_ceil(1024)
}

/// Resets the kernel's record of a process's peak memory.
pub(super) fn forget_peak(process: u32) {
    if let Err(error) = fs::write(format!("/proc/{process}/clear_refs"), "5") {
        eprintln!("the peak of memory counts from the start: {error}");
    }
}

/// Returns the machine's load average.
pub(super) fn load() -> String {
    fs::read_to_string("/proc/loadavg").unwrap_or_default().split(' ').next().unwrap_or_default().to_owned()
}
