//! From sockets to visitors.

pub mod admission;
mod client;
mod connection;
mod explanation;
#[cfg(fuzzing)]
pub(crate) mod fuzzing;
mod handler;
mod hello;
pub mod host_key;
mod inbound;
mod key_data;
mod outbox;
#[cfg(test)]
mod pipe;
mod visitor;
mod wire;

use std::collections::BTreeMap;
use std::future::Future;
use std::io;
use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Duration;

use tokio::net::{TcpListener, TcpSocket};
use tokio::sync::{oneshot, watch};
use tokio::task::JoinSet;
use tokio::time::{MissedTickBehavior, interval, sleep, timeout};

use crate::accounts::AddressPrefix;
use crate::lock::locked;
use crate::ops::config::{Config, LiveConfig};
use crate::ops::logging::{ConnectionEvent, events};
use crate::ssh::admission::{Admitted, Refusal, VisitId};
use crate::ssh::host_key::HostKey;
use cellcaster::rng::SplitMix64;
use connection::{Entry, Shared};
use explanation::Explanations;
pub use inbound::{Arrival, Inbound};
pub use key_data::KeyData;
pub use outbox::Outbox;
#[cfg(test)]
pub(crate) use pipe::{FarEnd, Parts, pipe};
pub use visitor::Visitor;

/// What serves visitors: the sessions above the transport.
pub trait Host: Send + Sync + 'static {
    /// Serves `visitor` until they leave, or until `link` has ended.
    ///
    /// The future is dropped five seconds after the link has ended.
    fn serve(&self, visitor: Visitor, link: Link) -> impl Future<Output = Departure> + Send;
}

/// Both directions of a visitor's channel.
#[derive(Debug)]
pub struct Link {
    /// What the visitor sends.
    pub inbound: Inbound,
    /// The frame on its way to the visitor.
    pub outbox: Outbox,
}

/// The end of a session.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Departure {
    /// The exit status that the visitor's `ssh` ends with.
    pub status: u8,
    /// The limit by which the visitor was refused, if they were.
    pub refusal: Option<Refusal>,
}

impl Departure {
    /// That of a visitor who is refused: they have to change something, or to come later.
    pub(crate) const REFUSED: Self = Self { status: 2, refusal: None };
    /// That of a visitor whom the host cannot serve.
    pub(crate) const FAILED: Self = Self { status: 1, refusal: None };
}

/// Counts of connections, for metrics and tests.
#[derive(Debug, Default)]
pub struct Counters {
    /// Connections that are open.
    pub connections: AtomicUsize,
    /// Visitors whose session runs.
    pub sessions: AtomicUsize,
    /// Connections that were accepted so far.
    pub accepted: AtomicU64,
    /// Connections that were refused so far.
    pub refused: AtomicU64,
    /// Bytes of frames that wait for clients.
    pub held: AtomicUsize,
    /// Frames that were sent so far.
    pub frames: AtomicU64,
    /// Their bytes, before compression and encryption.
    pub frame_bytes: AtomicU64,
    /// Those of `refused`, and those that were refused later or displaced, by reason.
    refusals: [AtomicU64; Refusal::ALL.len()],
}

/// A server that listens.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    config: LiveConfig,
    key: HostKey,
    counters: Arc<Counters>,
}

/// What the connections of a server may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Open,
    /// Sessions are told to end.
    Draining,
    /// Connections are closed.
    Closing,
}

/// The pause after a failed `accept`, as when the process has no file descriptors left.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);
/// The time in which events are summed for the log.
const SECOND: Duration = Duration::from_secs(1);
/// In bytes: of a socket, for what the client's system has not acknowledged. That is 640 KB a second on
/// a link with a round trip of 0.2 s.
const SEND_BUFFER: u32 = 128 << 10;
/// The connections that wait to be accepted.
const BACKLOG: u32 = 1024;
/// The time in which a session that ends with the server says its last words.
const LAST_WORDS: Duration = Duration::from_secs(2);
/// The time in which closed connections end.
const CLOSING: Duration = Duration::from_secs(2);

impl Counters {
    /// The connections that were refused for `reason` so far.
    pub fn refused_for(&self, reason: Refusal) -> u64 {
        self.refusals[reason as usize].load(Ordering::Relaxed)
    }

    pub(crate) fn refuse(&self, reason: Refusal) {
        self.refusals[reason as usize].fetch_add(1, Ordering::Relaxed);
    }
}

impl Server {
    /// Listens at the address of `config`.
    ///
    /// # Errors
    /// The address can't be listened at.
    #[expect(clippy::unused_async, reason = "a listener is made within a runtime")]
    pub async fn bind(config: Config, key: HostKey) -> io::Result<Self> {
        let listener = listen(config.listen)?;
        Ok(Self { listener, config: LiveConfig::new(config), key, counters: Arc::default() })
    }

    /// The address that it listens at.
    ///
    /// # Errors
    /// The system does not tell.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Its configuration, which can be replaced while it runs.
    pub fn config(&self) -> LiveConfig {
        self.config.clone()
    }

    /// The counts of its connections.
    pub fn counters(&self) -> Arc<Counters> {
        self.counters.clone()
    }

    /// Serves visitors until `stop` is ready. Then it accepts no more, tells each session that the
    /// server drains, waits for them as long as the configuration says and two seconds more for their last
    /// words, and closes what is left.
    pub async fn run<H: Host>(self, host: H, stop: impl Future<Output = ()> + Send) {
        let Self { listener, config, key, counters } = self;
        let (phase, phases) = watch::channel(Phase::Open);
        let shared = Arc::new(Shared::new(config.clone(), &key, counters, phases));
        let host = Arc::new(host);
        let mut tasks = JoinSet::new();
        let mut gate = Gate::new();
        let mut second = interval(SECOND);
        second.set_missed_tick_behavior(MissedTickBehavior::Delay);
        tokio::pin!(stop);
        loop {
            tokio::select! {
                () = &mut stop => break,
                Some(ended) = tasks.join_next(), if !tasks.is_empty() => gate.forget(ended.ok().flatten()),
                _ = second.tick() => shared.end_second(),
                accepted = listener.accept() => match accepted {
                    Ok((socket, peer)) => match gate.admit(&shared, peer) {
                        Ok(entry) => {
                            // Frames are small, and whole when they are written.
                            _ = socket.set_nodelay(true);
                            let (shared, host) = (shared.clone(), host.clone());
                            tasks.spawn(async move {
                                let visit = entry.visit;
                                connection::serve(shared, host, socket, peer, entry).await;
                                Some(visit)
                            });
                        }
                        Err(Some(sentence)) => {
                            tasks.spawn(async {
                                explanation::explain(socket, sentence).await;
                                None
                            });
                        }
                        Err(None) => {}
                    },
                    Err(error) => {
                        events::fault("accept", error);
                        sleep(ACCEPT_PAUSE).await;
                    }
                },
            }
        }
        drop(listener);
        let drain = config.get().drain;
        events::draining(drain.as_secs());
        let until_end = drain + LAST_WORDS.min(drain);
        for (next, time) in [(Phase::Draining, until_end), (Phase::Closing, CLOSING)] {
            _ = phase.send(next);
            let all = async { while tasks.join_next().await.is_some() {} };
            if timeout(time, all).await.is_ok() {
                break;
            }
        }
        tasks.shutdown().await;
        shared.end_second();
    }
}

fn listen(address: SocketAddr) -> io::Result<TcpListener> {
    let socket = if address.is_ipv4() { TcpSocket::new_v4()? } else { TcpSocket::new_v6()? };
    // As `TcpListener::bind` does: another server may have ended just now.
    #[cfg(unix)]
    socket.set_reuseaddr(true)?;
    // Connections inherit it. The system would keep megabytes for a client that does not read.
    socket.set_send_buffer_size(SEND_BUFFER)?;
    socket.bind(address)?;
    socket.listen(BACKLOG)
}

/// The way in: what decides over connections, and the state of it that only the listener has.
struct Gate {
    chance: SplitMix64,
    explanations: Explanations,
    /// What tells a connection that it is displaced, and where it comes from.
    open: BTreeMap<VisitId, (IpAddr, oneshot::Sender<Option<String>>)>,
}

impl Gate {
    fn new() -> Self {
        Self {
            chance: SplitMix64::new(seed()),
            explanations: Explanations::default(),
            open: BTreeMap::new(),
        }
    }

    /// Admits a connection, or refuses it: with a sentence, or without a word in a flood.
    fn admit(&mut self, shared: &Shared, peer: SocketAddr) -> Result<Entry, Option<String>> {
        let limits = shared.config.get().admission;
        let (admitted, now) = shared.admission(|admission, now| {
            admission.set_limits(limits);
            (admission.arrive(peer.ip(), now, &mut self.chance), now)
        });
        let Counters { accepted, refused, .. } = &*shared.counters;
        let count = if admitted.is_ok() { accepted } else { refused };
        count.fetch_add(1, Ordering::Relaxed);
        match admitted {
            Ok(Admitted { id, displaced }) => {
                shared.log(ConnectionEvent::Accepted, peer.ip());
                if let Some((address, connection)) = displaced.and_then(|id| self.open.remove(&id))
                {
                    let sentence = self.refuse(shared, Refusal::Startups, address, now);
                    // It may have ended just now.
                    _ = connection.send(sentence);
                }
                let (sender, displaced) = oneshot::channel();
                self.open.insert(id, (peer.ip(), sender));
                Ok(Entry { visit: id, displaced })
            }
            Err(reason) => {
                shared.log(ConnectionEvent::Refused(reason), peer.ip());
                Err(self.refuse(shared, reason, peer.ip(), now))
            }
        }
    }

    /// Counts a refusal; returns the sentence for the client at `address`, if it is told why.
    fn refuse(
        &mut self,
        shared: &Shared,
        reason: Refusal,
        address: IpAddr,
        now: Duration,
    ) -> Option<String> {
        shared.counters.refuse(reason);
        let is_told = self.explanations.allow(AddressPrefix::network_of(address), now);
        is_told.then(|| reason.sentence(&shared.config.get().admission))
    }

    /// A connection has ended.
    fn forget(&mut self, visit: Option<VisitId>) {
        if let Some(visit) = visit {
            self.open.remove(&visit);
        }
    }
}

/// Unpredictable, so that nobody can time their connections by the chance of a refusal.
fn seed() -> u64 {
    // Without random numbers from the system there would be no keys, either.
    getrandom::u64().unwrap_or_default()
}
