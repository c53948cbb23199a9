//! Figures about a running server, in Prometheus' text format.
//!
//! [`Metrics`] contains a handle for each figure. Parts of the server update them. [`text`](Metrics::text) writes all
//! of them, and the figures of the process. A responder on an address of its own answers `GET /metrics` with that text.

use std::borrow::Cow;
use std::io;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use prometheus_client::encoding::prometheus_text::{self, CONTENT_TYPE};
use prometheus_client::metrics::counter::{ConstCounter, Counter};
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::{ConstGauge, Gauge};
use prometheus_client::metrics::histogram::Histogram;
use prometheus_client::registry::Registry;
use tokio::net::{TcpListener, TcpStream};
use tokio::runtime::Handle;

use crate::admission::Refusal;
use crate::service::http::{self, Answer};
use crate::service::serve_each;

/// The figures of a server.
#[derive(Debug, Default)]
pub struct Metrics {
    /// The name of the host in a cluster. If it is set, it is a label of every sample.
    pub host: OnceLock<String>,
    /// Open connections.
    pub connections: Gauge,
    /// Visitors with a running session.
    pub sessions: Gauge,
    /// Accepted connections.
    pub accepted: Counter,
    refused: Family<Label, Counter>,
    /// Bytes of frames that wait for clients.
    pub held: Gauge,
    /// Frames that were sent.
    pub frames: Counter,
    /// Their bytes, before compression and encryption.
    pub frame_bytes: Counter,
    /// Open rooms.
    pub rooms: Gauge,
    /// Members of all rooms.
    pub members: Gauge,
    /// Visitors who watch a room.
    pub watchers: Gauge,
    /// Browsers that watch a room.
    pub web_watchers: Gauge,
    /// Pictures that were drawn for browsers.
    pub web_pictures: Counter,
    /// Bytes of pictures that were sent to browsers.
    pub web_bytes: Counter,
    /// Entries in the logs of all rooms.
    pub entries: Counter,
    checks: Family<Label, Counter>,
    /// Steps that rooms took alone while the bus of the cluster did not answer.
    pub steps_alone: Counter,
    /// The delays of the steps of rooms, in seconds.
    pub step_lateness: Seconds,
    /// The time to draw and encode a frame, in seconds.
    pub frame_time: Seconds,
    /// The time from the arrival of a key to the departure of the frame that shows its effect, in seconds.
    pub key_time: Seconds,
    results: Family<Label, Counter>,
    /// Results that wait while the store is unavailable.
    pub results_waiting: Gauge,
    /// Failed calls to the store.
    pub store_errors: Counter,
}

/// A histogram of times.
#[derive(Clone, Debug)]
pub struct Seconds(pub(crate) Histogram);

/// The name and the value of a label.
type Label = [(&'static str, &'static str); 1];

/// The upper bounds of the histograms' buckets, in seconds. A frame takes less than a millisecond, a step of a room
/// lasts 0.016667 s, and above 0.05 s a player feels the delay of a key.
const BOUNDS: [f64; 15] = [
    0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005, 0.01, 0.016_667, 0.025, 0.05, 0.1, 0.25, 0.5,
    1.0, 2.5,
];
const CHECK_RESULTS: [&str; 2] = ["different", "equal"];
const VERDICTS: [&str; 2] = ["refused", "verified"];

impl Metrics {
    /// Refused connections by `reason`, including connections that the server displaced or refused after it had
    /// accepted them.
    pub fn refused(&self, reason: Refusal) -> Counter {
        self.refused.get_or_create_owned(&[("reason", reason.name())])
    }

    /// Results that a replay confirmed or refuted.
    pub(crate) fn results(&self, is_verified: bool) -> Counter {
        self.results.get_or_create_owned(&[("verdict", VERDICTS[usize::from(is_verified)])])
    }

    /// Checksums of rooms that matched another host's, or differed. A difference is a bug.
    pub(crate) fn checks(&self, is_equal: bool) -> Counter {
        self.checks.get_or_create_owned(&[("result", CHECK_RESULTS[usize::from(is_equal)])])
    }

    /// All figures, including the figures of this process.
    pub fn text(&self) -> String {
        let host = self.host.get().map(|host| (Cow::Borrowed("host"), Cow::Owned(host.clone())));
        let mut registry = Registry::with_labels(host.into_iter());
        self.register(registry.sub_registry_with_prefix("cellcaster"));
        register_process(&mut registry);
        let mut text = String::new();
        // Writing to a string cannot fail.
        _ = prometheus_text::encode(&mut text, &registry);
        text
    }

    fn register(&self, page: &mut Registry) {
        // A figure that is still zero must be a sample, too.
        for reason in Refusal::ALL {
            drop(self.refused(reason));
        }
        for is_good in [false, true] {
            drop((self.results(is_good), self.checks(is_good)));
        }
        let alone = "Steps that rooms took while the cluster's bus did not answer";
        for (name, help, counter) in [
            ("connections_accepted", "Accepted connections", &self.accepted),
            ("frames", "Sent frames", &self.frames),
            (
                "frame_bytes",
                "Bytes of frames, before compression and encryption",
                &self.frame_bytes,
            ),
            ("log_entries", "Entries of the logs of all rooms", &self.entries),
            ("room_steps_alone", alone, &self.steps_alone),
            ("store_errors", "Failed calls to the store", &self.store_errors),
            ("web_pictures", "Pictures that were drawn for browsers", &self.web_pictures),
            ("web_bytes", "Bytes of pictures that were sent to browsers", &self.web_bytes),
        ] {
            page.register(name, help, counter.clone());
        }
        for (name, help, family) in [
            ("connections_refused", "Refused connections", &self.refused),
            ("room_checks", "Checksums of rooms, compared with other hosts", &self.checks),
            ("results", "Replayed results, by verdict", &self.results),
        ] {
            page.register(name, help, family.clone());
        }
        for (name, help, gauge) in [
            ("connections", "Open connections", &self.connections),
            ("sessions", "Running sessions", &self.sessions),
            ("held_bytes", "Bytes of frames that wait for slow clients", &self.held),
            ("rooms", "Open rooms", &self.rooms),
            ("members", "Members of all rooms", &self.members),
            ("watchers", "Visitors who watch a room", &self.watchers),
            ("web_watchers", "Browsers that watch a room", &self.web_watchers),
            ("results_waiting", "Results that wait for the store", &self.results_waiting),
        ] {
            page.register(name, help, gauge.clone());
        }
        for (name, help, histogram) in [
            ("step_lateness_seconds", "The lateness of room steps", &self.step_lateness),
            ("frame_seconds", "The time to draw and encode a frame", &self.frame_time),
            (
                "key_seconds",
                "The time from a key to the departure of the next frame",
                &self.key_time,
            ),
        ] {
            page.register(name, help, histogram.0.clone());
        }
        if let Ok(runtime) = Handle::try_current() {
            let help = "Running tasks: a few for the server, and some for each connection and room";
            let tasks = runtime.metrics().num_alive_tasks();
            page.register("tasks", help, ConstGauge::new(tasks as u64));
        }
    }
}

impl Default for Seconds {
    fn default() -> Self {
        Self(Histogram::new(BOUNDS))
    }
}

impl Seconds {
    /// Records a time.
    pub fn observe(&self, time: Duration) {
        self.0.observe(time.as_secs_f64());
    }
}

/// Registers the figures of the process, under the names that Prometheus's own clients use.
fn register_process(page: &mut Registry) {
    if let Some(time) = cpu_time() {
        let time = ConstCounter::new(time.as_secs_f64());
        page.register("process_cpu_seconds", "Processor time of all threads", time);
    }
    if let Some(bytes) = resident_bytes() {
        page.register("process_resident_memory_bytes", "Memory in use", ConstGauge::new(bytes));
    }
}

/// The processor time that all threads of this process have used.
#[cfg(unix)]
pub(crate) fn cpu_time() -> Option<Duration> {
    use rustix::time::{ClockId, clock_gettime};
    Duration::try_from(clock_gettime(ClockId::ProcessCPUTime)).ok()
}

#[cfg(not(unix))]
pub(crate) fn cpu_time() -> Option<Duration> {
    None
}

/// The memory in use, in bytes. `None` if the system does not report it as Linux does.
fn resident_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let size = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kilobytes: u64 = size.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes << 10)
}

const TIMEOUT: Duration = Duration::from_secs(2);

/// Answers `GET /metrics` with the figures until the future is dropped.
pub async fn respond(listener: TcpListener, metrics: Arc<Metrics>) {
    let answer = |stream| answer(stream, Arc::clone(&metrics));
    serve_each(|context| listener.poll_accept(context), TIMEOUT, answer).await;
}

async fn answer(mut stream: TcpStream, metrics: Arc<Metrics>) -> io::Result<()> {
    let (_, request) = http::read(&mut stream).await?;
    let answer = match request.as_ref().map(|it| (it.method.as_str(), it.path())) {
        None => Answer::bad_request(),
        Some(("GET", "/metrics")) => {
            Answer { kind: CONTENT_TYPE, ..Answer::text("200 OK", metrics.text()) }
        }
        Some(("GET", _)) => {
            Answer::text("404 Not Found", "the metrics are at /metrics\n".to_owned())
        }
        Some(_) => Answer::other_method(),
    };
    http::finish(stream, answer).await
}

#[cfg(test)]
mod tests;
