//! Metrics in Prometheus' text format. The server counts its requests, the process and the disk report their state, and
//! the database counts the jobs in the queue. The metrics contain no personal data.
use crate::storage::Storage;
use prometheus::{
    CounterVec, GaugeVec, HistogramOpts, HistogramVec, IntCounterVec, IntGauge, Opts, Registry, TextEncoder,
    process_collector::ProcessCollector,
};
use std::time::Duration;

/// The upper bounds of the histogram of latencies, in seconds. They range from a simple page to an upload over a slow
/// line.
const LATENCY_BUCKETS: [f64; 12] = [0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0];

/// The server's counters. Clones are cheap and share the counters.
#[derive(Debug, Clone)]
pub struct Instruments {
    requests: IntCounterVec,
    seconds: HistogramVec,
    in_flight: IntGauge,
}

/// A request that is being answered. It is counted as active until this value is dropped.
#[derive(Debug)]
pub struct InFlight(IntGauge);

impl Drop for InFlight {
    fn drop(&mut self) {
        self.0.dec();
    }
}

impl Instruments {
    /// Creates the counters, which all start at zero.
    ///
    /// # Errors
    ///
    /// Fails if Prometheus does not allow a metric's name.
    pub fn new() -> Result<Self, prometheus::Error> {
        let labels = ["method", "route", "status"];
        let duration = HistogramOpts::new(
            "http_request_duration_seconds",
            "Time from a request's head to the head of its answer, by route.",
        );
        let requests = Opts::new("http_requests_total", "Requests that were answered.");
        Ok(Self {
            requests: IntCounterVec::new(requests, &labels)?,
            seconds: HistogramVec::new(duration.buckets(LATENCY_BUCKETS.into()), &labels[..2])?,
            in_flight: IntGauge::new("http_requests_in_flight", "Requests that are being answered.")?,
        })
    }

    /// Counts a request as active until the returned value is dropped.
    pub fn begin(&self) -> InFlight {
        self.in_flight.inc();
        InFlight(self.in_flight.clone())
    }

    /// Counts the answer to a request. `route` is the route's template, not the URL, so that the number of series
    /// is limited.
    pub fn count_answer(&self, method: &str, route: &str, status: u16, took: Duration) {
        self.requests.with_label_values(&[method, route, &status.to_string()]).inc();
        self.seconds.with_label_values(&[method, route]).observe(took.as_secs_f64());
    }

    /// Returns all metrics as text. If the database does not answer, the metrics of the queue are missing.
    ///
    /// # Errors
    ///
    /// Fails if the metrics can't be written as text.
    pub fn show(&self, storage: &Storage, queue: Option<&Metrics>) -> Result<String, prometheus::Error> {
        let page = MetricsPage(Registry::new());
        page.0.register(Box::new(self.requests.clone()))?;
        page.0.register(Box::new(self.seconds.clone()))?;
        page.0.register(Box::new(self.in_flight.clone()))?;
        page.0.register(Box::new(ProcessCollector::for_self()))?;
        page.gauge("build_info", "The version of the server.", "version", &[(env!("CARGO_PKG_VERSION"), 1.0)])?;
        if let Some((free, size)) = storage.disk_space() {
            page.write_number("disk_free_bytes", "Free space on the data folder's disk.", free as f64)?;
            page.write_number("disk_size_bytes", "The size of the data folder's disk.", size as f64)?;
        }
        page.write_number("database_up", "Whether the database answers.", queue.is_some().into())?;
        if let Some(queue) = queue {
            page.write_queue(queue)?;
        }
        TextEncoder::new().encode_to_string(&page.0.gather())
    }
}

/// The metrics that the database counts. They contain no personal data.
#[derive(Debug, Clone, Default)]
pub struct Metrics {
    /// The number of jobs in each state.
    pub jobs: Vec<(String, i64)>,
    /// The number of scores for learning platforms in each state.
    pub scores: Vec<(String, i64)>,
    /// The time in milliseconds that the oldest waiting job has waited so far.
    pub longest_wait_ms: i64,
    /// The number of workers that have reported recently.
    pub workers: i64,
    /// The number of slots of all these workers together.
    pub slots: i64,
    /// The number of workers that claim no jobs because they can't grade.
    pub paused_workers: i64,
    /// The number of workers that are grading at present.
    pub busy_workers: i64,
    /// The number of events of each kind that needs attention.
    pub events: Vec<(String, i64)>,
    /// The stored bytes of uploads and reports: of all courses, and of the course with the most bytes.
    pub stored_bytes: [i64; 2],
    /// The number of submissions that the server has ever received.
    pub submissions: i64,
}

/// The metrics at one time. Names begin with `fosssim_`. An empty label name means that the metric has no label.
struct MetricsPage(Registry);

impl MetricsPage {
    fn gauge(&self, name: &str, help: &str, label: &str, values: &[(&str, f64)]) -> Result<(), prometheus::Error> {
        let labels: Vec<&str> = Some(label).filter(|label| !label.is_empty()).into_iter().collect();
        let series = GaugeVec::new(Opts::new(format!("fosssim_{name}"), help), &labels)?;
        for (of, value) in values {
            series.with_label_values(&[*of][..labels.len()]).set(*value);
        }
        self.0.register(Box::new(series))
    }

    fn write_counter(
        &self,
        name: &str,
        help: &str,
        label: &str,
        values: &[(&str, f64)],
    ) -> Result<(), prometheus::Error> {
        let labels: Vec<&str> = Some(label).filter(|label| !label.is_empty()).into_iter().collect();
        let series = CounterVec::new(Opts::new(format!("fosssim_{name}"), help), &labels)?;
        for (of, value) in values {
            series.with_label_values(&[*of][..labels.len()]).inc_by(*value);
        }
        self.0.register(Box::new(series))
    }

    fn write_number(&self, name: &str, help: &str, value: f64) -> Result<(), prometheus::Error> {
        self.gauge(name, help, "", &[("", value)])
    }

    /// Writes what the database counted about the queue.
    fn write_queue(&self, queue: &Metrics) -> Result<(), prometheus::Error> {
        let count_of = |counts: &'_ [(String, i64)], name: &str| {
            counts.iter().find(|(known, _)| known == name).map_or(0.0, |(_, count)| *count as f64)
        };
        for (name, help, counts) in [
            ("jobs", "Gradings by state.", &queue.jobs),
            ("scores", "Scores for learning platforms by state.", &queue.scores),
        ] {
            let states = ["waiting", "running", "done", "buried", "cancelled"];
            self.gauge(name, help, "state", &states.map(|state| (state, count_of(counts, state))))?;
        }
        let help = "The time that the oldest waiting upload has waited, in seconds.";
        self.write_number("oldest_waiting_seconds", help, queue.longest_wait_ms.max(0) as f64 / 1000.0)?;
        let (busy, paused) = (queue.busy_workers, queue.paused_workers);
        let idle = (queue.workers - busy - paused) as f64;
        let by_state = [("working", busy as f64), ("idle", idle), ("aside", paused as f64)];
        let help = "Workers that were seen recently: they grade, wait for a job, or can't grade.";
        self.gauge("workers_by_state", help, "state", &by_state)?;
        for (name, help, value) in [
            ("workers", "Workers that were seen recently.", queue.workers),
            ("slots", "The slots of these workers.", queue.slots),
            ("workers_aside", "Workers that take no jobs, because they can't grade.", paused),
        ] {
            self.write_number(name, help, value as f64)?;
        }
        let values = [("all", queue.stored_bytes[0] as f64), ("largest course", queue.stored_bytes[1] as f64)];
        self.gauge("kept_bytes", "Stored uploads and reports: of all courses, of the largest course.", "of", &values)?;
        self.write_counter("submissions_total", "Submissions.", "", &[("", queue.submissions as f64)])?;
        let kinds = ["graded", "failed try", "late answer", "buried"];
        let kinds = kinds.map(|kind| (kind.replace(' ', "_"), count_of(&queue.events, kind)));
        let kinds: Vec<(&str, f64)> = kinds.iter().map(|(kind, count)| (kind.as_str(), *count)).collect();
        self.write_counter("events_total", "Results and errors of jobs.", "kind", &kinds)
    }
}
