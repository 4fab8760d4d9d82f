//! What the server counts about itself for a monitor (Prometheus): requests, and what its process, disk and connections
//! to the database come to. What the database knows of the queue is asked of it.
use crate::{db::Database, storage::Storage};
use prometheus::{
    Gauge, GaugeVec, HistogramOpts, HistogramVec, IntCounter, IntCounterVec, IntGauge, Opts, Registry, TextEncoder,
    process_collector::ProcessCollector,
};
use std::time::Duration;

/// Upper bounds of the histogram of latencies, in seconds: from a page to an upload over a slow line.
const BUCKETS: [f64; 12] = [0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0];

/// Counts and measures. Cloning it is cheap.
#[derive(Debug, Clone)]
pub struct Instruments {
    registry: Registry,
    requests: IntCounterVec,
    seconds: HistogramVec,
    in_flight: IntGauge,
    connections: GaugeVec,
    most_connections: GaugeVec,
    waiting: IntGauge,
    timeouts: IntCounter,
    free: Gauge,
    size: Gauge,
}

/// A request that is being answered; it counts when it is told what came of it, or is dropped.
#[derive(Debug)]
pub struct InFlight(IntGauge);

impl Drop for InFlight {
    fn drop(&mut self) {
        self.0.dec();
    }
}

impl Instruments {
    /// Instruments that show zero.
    ///
    /// # Errors
    /// When two of them have one name.
    pub fn new() -> Result<Self, prometheus::Error> {
        let of_requests = ["method", "route", "status"];
        let duration = HistogramOpts::new(
            "http_request_duration_seconds",
            "Time from a request's head to the head of its answer, by route.",
        );
        let this = Self {
            registry: Registry::new(),
            requests: IntCounterVec::new(
                Opts::new("http_requests_total", "Requests that were answered."),
                &of_requests,
            )?,
            seconds: HistogramVec::new(duration.buckets(BUCKETS.into()), &of_requests[..2])?,
            in_flight: IntGauge::new("http_requests_in_flight", "Requests that are being answered.")?,
            connections: GaugeVec::new(
                Opts::new("fosssim_database_connections", "Open connections to the database, by pool and state."),
                &["pool", "state"],
            )?,
            most_connections: GaugeVec::new(
                Opts::new("fosssim_database_connections_max", "The most connections that a pool opens."),
                &["pool"],
            )?,
            waiting: IntGauge::new("fosssim_database_waiting", "Transactions that wait for a connection.")?,
            timeouts: IntCounter::new(
                "fosssim_database_timeouts_total",
                "Transactions that were given up because no connection was free in time.",
            )?,
            free: Gauge::new("fosssim_disk_free_bytes", "Free room on the data folder's disk.")?,
            size: Gauge::new("fosssim_disk_size_bytes", "The size of the data folder's disk.")?,
        };
        let build = GaugeVec::new(Opts::new("fosssim_build_info", "The version of the server."), &["version"])?;
        build.with_label_values(&[env!("CARGO_PKG_VERSION")]).set(1.0);
        this.registry.register(Box::new(build))?;
        this.registry.register(Box::new(this.requests.clone()))?;
        this.registry.register(Box::new(this.seconds.clone()))?;
        this.registry.register(Box::new(this.in_flight.clone()))?;
        this.registry.register(Box::new(this.connections.clone()))?;
        this.registry.register(Box::new(this.most_connections.clone()))?;
        this.registry.register(Box::new(this.waiting.clone()))?;
        this.registry.register(Box::new(this.timeouts.clone()))?;
        this.registry.register(Box::new(this.free.clone()))?;
        this.registry.register(Box::new(this.size.clone()))?;
        this.registry.register(Box::new(ProcessCollector::for_self()))?;
        Ok(this)
    }

    /// A request begins.
    #[must_use]
    pub fn begin(&self) -> InFlight {
        self.in_flight.inc();
        InFlight(self.in_flight.clone())
    }

    /// A request was answered. Routes are templates, so that there are as many series as there are routes.
    pub fn answered(&self, method: &str, route: &str, status: u16, took: Duration) {
        self.requests.with_label_values(&[method, route, &status.to_string()]).inc();
        self.seconds.with_label_values(&[method, route]).observe(took.as_secs_f64());
    }

    /// What they show, in Prometheus' text format.
    ///
    /// # Errors
    /// When it can't be written as text.
    pub fn show(&self, database: &Database, storage: &Storage) -> Result<String, prometheus::Error> {
        for pool in database.pools() {
            let of = |state: &str| self.connections.with_label_values(&[pool.name, state]);
            of("idle").set(f64::from(pool.idle));
            of("used").set(f64::from(pool.size.saturating_sub(pool.idle)));
            self.most_connections.with_label_values(&[pool.name]).set(f64::from(pool.most));
        }
        let (waiting, timeouts) = database.waits();
        self.waiting.set(waiting);
        self.timeouts.inc_by(timeouts.saturating_sub(self.timeouts.get()));
        if let Some((free, size)) = storage.disk() {
            self.free.set(free as f64);
            self.size.set(size as f64);
        }
        TextEncoder::new().encode_to_string(&self.registry.gather())
    }
}
