//! The gate of the server: admits or refuses connections, and counts and logs their events.
//!
//! # Telling a refused client the reason
//!
//! The client receives the server's version and a message `SSH_MSG_DISCONNECT` (RFC 4253, sections 4.2 and
//! 11.1), which is not encrypted before the key exchange. OpenSSH's client prints its text and exits with
//! status 255. The server does no cryptography for it.
//!
//! In a flood, an explanation must not cost more than closing the connection. Only a few clients get one: at
//! most [`MAX`] within [`EXPLANATION_TIMEOUT`], and at most [`MAX_PER_NETWORK`] in one network. This also limits the
//! number of tasks and sockets, because no explanation lasts longer than [`EXPLANATION_TIMEOUT`]. All other connections
//! are closed silently.
//!
//! Rejected: lines before the version, which the protocol also allows. OpenSSH's client shows them only with `-v`.

use std::collections::{BTreeMap, VecDeque};
use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::{oneshot, watch};
use tokio::time::{Instant, timeout};

use crate::accounts::{AccountKey, AddressPrefix};
use crate::admission::{Admission, Admitted, ConnectionId, Outcome, Refusal};
use crate::config::LiveConfig;
use crate::lock::locked;
use crate::logging::{ConnectionEvent, Throttle};
use crate::metrics::Metrics;
use cellcaster::rng::SplitMix64;

/// The gate of a server.
pub(crate) struct Gate {
    pub(crate) config: LiveConfig,
    pub(crate) metrics: Arc<Metrics>,
    phase: watch::Sender<ShutdownPhase>,
    begun: Instant,
    state: Mutex<State>,
}

/// The phases of a server's shutdown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShutdownPhase {
    Open,
    /// Sessions are told to end, and no client may log in.
    Draining,
    /// Connections are closed.
    Closing,
}

/// An admitted connection.
pub(crate) struct AdmittedConnection {
    pub(crate) visit: ConnectionId,
    pub(crate) peer: SocketAddr,
    /// Receives the sentence for the client, if any, when the connection is displaced.
    pub(crate) displaced: oneshot::Receiver<Option<String>>,
}

struct State {
    admission: Admission,
    chance: SplitMix64,
    explanations: Explanations,
    logged: Throttle,
    /// The open connections, each with its address and the sender that displaces it.
    open: BTreeMap<ConnectionId, (IpAddr, oneshot::Sender<Option<String>>)>,
}

impl Gate {
    pub(crate) fn new(config: LiveConfig, metrics: Arc<Metrics>) -> Self {
        let state = Mutex::new(State {
            admission: Admission::new(config.get().admission()),
            chance: SplitMix64::new(getrandom::u64().unwrap_or_default()),
            explanations: Explanations::default(),
            logged: Throttle::default(),
            open: BTreeMap::new(),
        });
        let phase = watch::Sender::new(ShutdownPhase::Open);
        Self { config, metrics, phase, begun: Instant::now(), state }
    }

    /// Enters the next phase of the shutdown.
    pub(crate) fn enter(&self, phase: ShutdownPhase) {
        self.phase.send_replace(phase);
    }

    /// Waits until clients may no longer log in.
    pub(crate) async fn stopped(&self) {
        _ = self.phase.subscribe().wait_for(|phase| *phase != ShutdownPhase::Open).await;
    }

    /// A receiver of the phases, starting with the current one.
    pub(crate) fn phases(&self) -> watch::Receiver<ShutdownPhase> {
        let mut phases = self.phase.subscribe();
        phases.mark_changed();
        phases
    }

    /// Returns true if connections from `address` begin with a header that names the visitor.
    pub(crate) fn is_proxy(&self, address: IpAddr) -> bool {
        self.config.get().proxies.iter().any(|range| range.contains(address))
    }

    /// Logs the end of a connection from a proxy that sent no valid header. This brings no penalty, because all visitors
    /// come from the proxy's address. Returns the sentence for the client, if the client may be told.
    pub(crate) fn end_without_header(&self, outcome: Outcome, proxy: IpAddr) -> Option<String> {
        let now = self.begun.elapsed();
        let is_told = locked(&self.state, |state| {
            state.logged.log(ConnectionEvent::Ended(outcome), proxy);
            outcome == Outcome::BrokeProtocol
                && state.explanations.allow(AddressPrefix::network_of(proxy), now)
        });
        is_told.then(|| NO_HEADER.to_owned())
    }

    /// Counts and logs the refusal of a connection from a proxy before its header is read. Returns the sentence for the
    /// client, if the client may be told.
    pub(crate) fn refuse_early(&self, reason: Refusal, proxy: IpAddr) -> Option<String> {
        let now = self.begun.elapsed();
        locked(&self.state, |state| {
            state.logged.log(ConnectionEvent::Refused(reason), proxy);
            self.explain(state, reason, proxy, now)
        })
    }

    /// Admits a connection.
    ///
    /// # Errors
    /// If the gate refuses the connection: the sentence for its client, or `None` to close it silently.
    pub(crate) fn admit(&self, peer: SocketAddr) -> Result<AdmittedConnection, Option<String>> {
        let (limits, now, address) =
            (self.config.get().admission(), self.begun.elapsed(), peer.ip());
        locked(&self.state, |state| {
            state.admission.set_limits(limits);
            match state.admission.arrive(address, now, &mut state.chance) {
                Ok(Admitted { id: visit, displaced }) => {
                    self.metrics.accepted.inc();
                    state.logged.log(ConnectionEvent::Accepted, address);
                    if let Some((address, connection)) =
                        displaced.and_then(|id| state.open.remove(&id))
                    {
                        let sentence = self.explain(state, Refusal::Startups, address, now);
                        // The connection may just have ended.
                        _ = connection.send(sentence);
                    }
                    let (sender, displaced) = oneshot::channel();
                    state.open.insert(visit, (address, sender));
                    Ok(AdmittedConnection { visit, peer, displaced })
                }
                Err(reason) => {
                    state.logged.log(ConnectionEvent::Refused(reason), address);
                    Err(self.explain(state, reason, address, now))
                }
            }
        })
    }

    /// Counts a refusal; returns the sentence for the client at `address`, if it may be told.
    fn explain(
        &self,
        state: &mut State,
        reason: Refusal,
        address: IpAddr,
        now: Duration,
    ) -> Option<String> {
        self.metrics.refused(reason).inc();
        let is_told = state.explanations.allow(AddressPrefix::network_of(address), now);
        is_told.then(|| self.sentence(reason))
    }

    /// The sentence for a client refused for `reason`.
    pub(crate) fn sentence(&self, reason: Refusal) -> String {
        reason.sentence(&self.config.get().admission())
    }

    /// Counts a connection as authenticated, with `key` or as a guest.
    ///
    /// # Errors
    /// The reason, if the gate refuses the connection after all.
    pub(crate) fn log_in(
        &self,
        visit: ConnectionId,
        key: Option<AccountKey>,
        address: IpAddr,
    ) -> Result<(), Refusal> {
        let now = self.begun.elapsed();
        let logged_in = locked(&self.state, |state| state.admission.log_in(visit, key, now));
        logged_in.inspect_err(|&reason| self.refuse(reason, address))
    }

    /// Counts and logs the refusal of an authenticated connection.
    pub(crate) fn refuse(&self, reason: Refusal, address: IpAddr) {
        self.metrics.refused(reason).inc();
        self.log(ConnectionEvent::Refused(reason), address);
    }

    /// Counts the end of a connection. A proxy's own connections, which check whether the server answers, bring no
    /// penalty.
    pub(crate) fn leave(&self, visit: ConnectionId, peer: IpAddr, outcome: Outcome) {
        let now = self.begun.elapsed();
        let outcome = if self.is_proxy(peer) { Outcome::Served } else { outcome };
        locked(&self.state, |state| {
            state.open.remove(&visit);
            state.admission.leave(visit, outcome, now);
        });
    }

    /// Logs a client's event, at once or in the summary of this second.
    pub(crate) fn log(&self, event: ConnectionEvent, address: IpAddr) {
        locked(&self.state, |state| state.logged.log(event, address));
    }

    /// Logs the summary of the second that has ended.
    pub(crate) fn end_second(&self) {
        locked(&self.state, |state| state.logged.end_second());
    }
}

/// The refused connections that were given the reason in the last [`EXPLANATION_TIMEOUT`].
#[derive(Debug, Default)]
struct Explanations(VecDeque<(Duration, AddressPrefix)>);

/// The server's version, without the line ending.
pub(crate) const VERSION: &str = "SSH-2.0-cellcaster";
/// The longest duration of an explanation. A client closes the connection once it has read the message.
const EXPLANATION_TIMEOUT: Duration = Duration::from_secs(2);
/// The maximum number of explanations within [`EXPLANATION_TIMEOUT`].
const MAX: usize = 64;
/// The maximum number of explanations per network within [`EXPLANATION_TIMEOUT`].
const MAX_PER_NETWORK: usize = 8;
/// The most bytes read from a client during an explanation. Its version and its offer of algorithms take about 2,000.
const MAX_READ: u64 = 16 << 10;

/// The sentence for a client behind a proxy that is not set up.
const NO_HEADER: &str = "This host expects a PROXY header from your address: its operator must switch it on in the \
                         proxy, or remove the address from \"proxies\".";

const DISCONNECT: u8 = 1;
const TOO_MANY_CONNECTIONS: u32 = 12;

impl Explanations {
    /// Returns true if a connection from `network`, refused at `now`, may be told the reason, and counts it.
    fn allow(&mut self, network: AddressPrefix, now: Duration) -> bool {
        while self.0.front().is_some_and(|(at, _)| *at + EXPLANATION_TIMEOUT <= now) {
            self.0.pop_front();
        }
        let of_network = self.0.iter().filter(|(_, other)| *other == network).count();
        let is_allowed = self.0.len() < MAX && of_network < MAX_PER_NETWORK;
        if is_allowed {
            self.0.push_back((now, network));
        }
        is_allowed
    }
}

/// Sends the sentence and closes the connection.
pub(crate) async fn explain(mut socket: TcpStream, sentence: String) {
    let told = async {
        socket.write_all(&message(&sentence)).await?;
        socket.shutdown().await?;
        // Closing a socket with unread data resets the connection, and the client might lose the sentence.
        tokio::io::copy(&mut (&mut socket).take(MAX_READ), &mut tokio::io::sink()).await
    };
    _ = timeout(EXPLANATION_TIMEOUT, told).await;
}

/// The version, and the message as an unencrypted packet (RFC 4253, section 6).
fn message(sentence: &str) -> Vec<u8> {
    let mut payload = vec![DISCONNECT];
    payload.extend(TOO_MANY_CONNECTIONS.to_be_bytes());
    for text in [sentence, ""] {
        payload.extend((text.len() as u32).to_be_bytes());
        payload.extend(text.as_bytes());
    }
    // At least four bytes, and up to a multiple of eight for the whole packet.
    let padding = 4 + (8 - (5 + payload.len() + 4) % 8) % 8;
    let length = 1 + payload.len() + padding;
    let mut message = format!("{VERSION}\r\n").into_bytes();
    message.extend((length as u32).to_be_bytes());
    message.push(padding as u8);
    message.extend(payload);
    message.resize(message.len() + padding, 0);
    message
}

#[cfg(test)]
mod tests {
    use std::net::IpAddr;

    use super::*;

    #[test]
    fn explanations_are_limited_per_network_and_in_total() {
        let mut explanations = Explanations::default();
        let network = |number: u8| AddressPrefix::network_of(IpAddr::from([10, 0, number, 1]));
        let told = |explanations: &mut Explanations, number, at: u64| {
            let now = Duration::from_millis(at);
            (0..1000).filter(|_| explanations.allow(network(number), now)).count()
        };
        assert_eq!(told(&mut explanations, 1, 0), 8);
        assert_eq!(told(&mut explanations, 2, 1000), 8);
        assert_eq!(told(&mut explanations, 1, 1999), 0);
        assert_eq!(told(&mut explanations, 1, 2000), 8);
        let all: usize = (0..=255).map(|number| told(&mut explanations, number, 9000)).sum();
        assert_eq!(all, 64);
        assert!(explanations.0.len() <= MAX);
    }

    #[test]
    fn a_packet_is_well_formed() {
        for length in 0..64 {
            let sentence = "x".repeat(length);
            let message = message(&sentence);
            let packet = message.strip_prefix(b"SSH-2.0-cellcaster\r\n").unwrap();
            assert_eq!(packet.len() % 8, 0);
            let stated = u32::from_be_bytes(*packet.first_chunk().unwrap()) as usize;
            let padding = usize::from(packet[4]);
            assert!(stated == packet.len() - 4 && (4..12).contains(&padding), "{packet:?}");
            let payload = &packet[5..packet.len() - padding];
            assert_eq!(payload.len(), 1 + 4 + 4 + length + 4);
        }
    }
}
