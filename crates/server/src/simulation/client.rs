//! Clients: a terminal emulator at the far end of a pipe, under conditions that tests can change.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::sync::{Notify, mpsc};
use tokio::time::{Instant, sleep, sleep_until};

use super::emulator::{Emulator, Speaks};
use crate::lock::locked;
use crate::metrics::Metrics;
use crate::sessions::driver::{Simulated, Visiting};
use crate::ssh::{ClientEnd, Parts, Visitor, pipe};
use cellcaster::color::palette::ColorDepth;
use cellcaster::terminal::{Detected, WindowSize};

/// A client, with a handle to its session.
pub(crate) struct SimulatedClient {
    pub(crate) visiting: Visiting,
    end: ClientEnd,
    terminal: Arc<Mutex<Terminal>>,
    conditions_changed: Arc<Notify>,
    sent: mpsc::UnboundedSender<(Instant, Vec<u8>)>,
    metrics: Arc<Metrics>,
}

/// The behaviour of a client and its link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Conditions {
    /// Whether the client reads.
    pub(crate) reads: bool,
    /// Whether the terminal's replies are sent.
    pub(crate) answers: bool,
    /// The latency of everything that the client sends.
    pub(crate) latency: Duration,
    /// The rate at which the client receives, in bytes per second; `None` for no limit.
    pub(crate) rate: Option<u32>,
}

/// A guest with this name, whose connection is compressed.
pub(crate) fn guest(name: &str, (columns, rows): (u16, u16)) -> Visitor {
    Visitor {
        peer: ([192, 0, 2, 1], 22).into(),
        key: None,
        notice: None,
        user: name.to_owned(),
        term: "xterm-256color".to_owned(),
        environment: BTreeMap::new(),
        size: WindowSize::of_cells(columns, rows),
        compresses: true,
    }
}

struct Terminal {
    emulator: Emulator,
    conditions: Conditions,
    arrivals: Vec<ByteArrival>,
}

/// The time of an arrival, and the total number of bytes received by then.
type ByteArrival = (Instant, usize);

impl SimulatedClient {
    /// Connects to a host. Must be called within a runtime.
    pub(crate) fn come(
        host: &Simulated,
        visitor: Visitor,
        speaks: Speaks,
        depth: ColorDepth,
    ) -> Self {
        let WindowSize { columns, rows, .. } = visitor.size;
        let metrics = Arc::<Metrics>::default();
        let (link, end, parts) = pipe(Arc::clone(&metrics));
        let visiting = host.serve(visitor, link, |options| {
            options.color_depth = Detected::Certain(depth);
            options.is_ascii = depth == ColorDepth::Mono;
        });
        let conditions =
            Conditions { reads: true, answers: true, latency: Duration::ZERO, rate: None };
        let emulator = Emulator::new(columns.max(1), rows.max(1), speaks);
        let terminal = Terminal { emulator, conditions, arrivals: Vec::new() };
        let terminal = Arc::new(Mutex::new(terminal));
        let (sent, waiting) = mpsc::unbounded_channel();
        let conditions_changed = Arc::<Notify>::default();
        tokio::spawn(receive(
            parts,
            Arc::clone(&terminal),
            Arc::clone(&conditions_changed),
            sent.clone(),
        ));
        tokio::spawn(deliver(waiting, end.clone()));
        Self { visiting, end, terminal, conditions_changed, sent, metrics }
    }

    /// Sends bytes, which arrive after the latency. Must be called within a runtime.
    pub(crate) fn send(&self, bytes: &[u8]) {
        let latency = locked(&self.terminal, |terminal| terminal.conditions.latency);
        _ = self.sent.send((Instant::now() + latency, bytes.to_vec()));
    }

    pub(crate) fn set(&self, change: impl FnOnce(&mut Conditions)) {
        locked(&self.terminal, |terminal| change(&mut terminal.conditions));
        self.conditions_changed.notify_one();
    }

    /// Resizes the window, possibly to zero cells.
    pub(crate) fn resize(&self, columns: u16, rows: u16) {
        let size = (columns.max(1), rows.max(1));
        locked(&self.terminal, |terminal| terminal.emulator.resize(size.0, size.1));
        self.end.resize(WindowSize::of_cells(columns, rows));
    }

    /// Announces that the server is about to shut down.
    pub(crate) fn drain(&self) {
        self.end.drain();
    }

    /// Cuts the link, as noticed by the connection.
    pub(crate) fn cut(&self) {
        self.end.end();
        self.set(|conditions| conditions.reads = true);
    }

    pub(crate) fn look<T>(&self, look: impl FnOnce(&Emulator) -> T) -> T {
        locked(&self.terminal, |terminal| look(&terminal.emulator))
    }

    /// The number of bytes sent to the client, received or not.
    pub(crate) fn bytes(&self) -> u64 {
        self.metrics.frame_bytes.get()
    }

    /// The number of frames sent to the client, received or not.
    pub(crate) fn frames(&self) -> u64 {
        self.metrics.frames.get()
    }

    /// Returns true if the client has received all bytes sent to it.
    pub(crate) fn has_all(&self) -> bool {
        self.look(|emulator| emulator.bytes().len() as u64 == self.bytes())
    }

    /// The times of all arrivals.
    pub(crate) fn arrivals(&self) -> Vec<Instant> {
        locked(&self.terminal, |it| it.arrivals.iter().map(|arrived| arrived.0).collect())
    }

    /// The bytes that have arrived after `begun`, grouped by time of arrival.
    pub(crate) fn received(&self, begun: Instant) -> Vec<Vec<u8>> {
        locked(&self.terminal, |Terminal { emulator, arrivals, .. }| {
            let first = arrivals.partition_point(|(time, _)| *time <= begun);
            let mut end = first.checked_sub(1).map_or(0, |before| arrivals[before].1);
            let later = arrivals[first..].chunk_by(|one, next| one.0 == next.0);
            later
                .map(|parts| {
                    let start = std::mem::replace(&mut end, parts[parts.len() - 1].1);
                    emulator.bytes()[start..end].to_vec()
                })
                .collect()
        })
    }
}

/// Receives parts of frames as the conditions allow, until the session ends.
async fn receive(
    mut parts: Parts,
    terminal: Arc<Mutex<Terminal>>,
    conditions_changed: Arc<Notify>,
    sent: mpsc::UnboundedSender<(Instant, Vec<u8>)>,
) {
    let conditions = || locked(&terminal, |terminal| terminal.conditions);
    while let Some(part) = parts.next().await {
        while !conditions().reads {
            conditions_changed.notified().await;
        }
        if let Some(rate) = conditions().rate {
            sleep(Duration::from_secs_f64(part.len() as f64 / f64::from(rate))).await;
        }
        let answers = locked(&terminal, |terminal| {
            let answers = terminal.emulator.process(&part);
            terminal.arrivals.push((Instant::now(), terminal.emulator.bytes().len()));
            answers
        });
        drop(part);
        parts.written();
        let Conditions { answers: is_answering, latency, .. } = conditions();
        if is_answering && !answers.is_empty() {
            _ = sent.send((Instant::now() + latency, answers));
        }
    }
}

/// Delivers the client's bytes in order, each when it is due.
async fn deliver(mut waiting: mpsc::UnboundedReceiver<(Instant, Vec<u8>)>, end: ClientEnd) {
    while let Some((due, bytes)) = waiting.recv().await {
        if due > Instant::now() {
            sleep_until(due).await;
        }
        end.send(&bytes).await;
    }
}
