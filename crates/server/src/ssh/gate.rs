//! The way into the server, for all of its connections: it admits and refuses them, and counts and logs what they do.

use std::collections::BTreeMap;
use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::sync::{oneshot, watch};
use tokio::time::Instant;

use super::explanation::Explanations;
use crate::accounts::{AccountKey, AddressPrefix};
use crate::admission::{Admission, Admitted, Outcome, Refusal, VisitId};
use crate::config::LiveConfig;
use crate::lock::locked;
use crate::logging::{ConnectionEvent, Throttle};
use crate::metrics::Metrics;
use cellcaster::rng::SplitMix64;

/// The way in.
pub(crate) struct Gate {
    pub(crate) config: LiveConfig,
    pub(crate) metrics: Arc<Metrics>,
    phase: watch::Sender<Phase>,
    begun: Instant,
    state: Mutex<State>,
}

/// What the connections of a server may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    Open,
    /// Sessions are told to end.
    Draining,
    /// Connections are closed.
    Closing,
}

/// A connection that was admitted.
pub(crate) struct Entry {
    pub(crate) visit: VisitId,
    pub(crate) peer: SocketAddr,
    /// Tells that the connection is displaced, and the sentence for its client, if any.
    pub(crate) displaced: oneshot::Receiver<Option<String>>,
}

struct State {
    admission: Admission,
    chance: SplitMix64,
    explanations: Explanations,
    logged: Throttle,
    /// The senders that displace connections, with the addresses of these.
    open: BTreeMap<VisitId, (IpAddr, oneshot::Sender<Option<String>>)>,
}

impl Gate {
    pub(crate) fn new(config: LiveConfig, metrics: Arc<Metrics>) -> Self {
        let state = Mutex::new(State {
            admission: Admission::new(config.get().admission),
            chance: SplitMix64::new(seed()),
            explanations: Explanations::default(),
            logged: Throttle::default(),
            open: BTreeMap::new(),
        });
        let phase = watch::Sender::new(Phase::Open);
        Self { config, metrics, phase, begun: Instant::now(), state }
    }

    /// Lets connections do less from now on.
    pub(crate) fn enter(&self, phase: Phase) {
        self.phase.send_replace(phase);
    }

    /// Ready when nobody may log in any more.
    pub(crate) async fn stopped(&self) {
        _ = self.phase.subscribe().wait_for(|phase| *phase != Phase::Open).await;
    }

    /// The phases, the present one first.
    pub(crate) fn phases(&self) -> watch::Receiver<Phase> {
        let mut phases = self.phase.subscribe();
        phases.mark_changed();
        phases
    }

    /// Admits a connection.
    ///
    /// # Errors
    /// The connection is refused: with a sentence for its client, or without a word in a flood.
    pub(crate) fn admit(&self, peer: SocketAddr) -> Result<Entry, Option<String>> {
        let (limits, now, address) = (self.config.get().admission, self.begun.elapsed(), peer.ip());
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
                        // It may have ended just now.
                        _ = connection.send(sentence);
                    }
                    let (sender, displaced) = oneshot::channel();
                    state.open.insert(visit, (address, sender));
                    Ok(Entry { visit, peer, displaced })
                }
                Err(reason) => {
                    state.logged.log(ConnectionEvent::Refused(reason), address);
                    Err(self.explain(state, reason, address, now))
                }
            }
        })
    }

    /// Counts a refusal; returns the sentence for the client at `address`, if it is told why.
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

    /// The sentence for a refused client.
    pub(crate) fn sentence(&self, reason: Refusal) -> String {
        reason.sentence(&self.config.get().admission)
    }

    /// Counts a connection as authenticated, with `key` or as a guest.
    ///
    /// # Errors
    /// The reason why it is refused now.
    pub(crate) fn log_in(
        &self,
        visit: VisitId,
        key: Option<AccountKey>,
        address: IpAddr,
    ) -> Result<(), Refusal> {
        let now = self.begun.elapsed();
        let logged_in = locked(&self.state, |state| state.admission.log_in(visit, key, now));
        logged_in.inspect_err(|&reason| self.refuse(reason, address))
    }

    /// Counts and logs the refusal of a connection that is authenticated.
    pub(crate) fn refuse(&self, reason: Refusal, address: IpAddr) {
        self.metrics.refused(reason).inc();
        self.log(ConnectionEvent::Refused(reason), address);
    }

    /// Counts the end of a connection.
    pub(crate) fn leave(&self, visit: VisitId, outcome: Outcome) {
        let now = self.begun.elapsed();
        locked(&self.state, |state| {
            state.open.remove(&visit);
            state.admission.leave(visit, outcome, now);
        });
    }

    /// Logs an event of a client, at once or with the second.
    pub(crate) fn log(&self, event: ConnectionEvent, address: IpAddr) {
        locked(&self.state, |state| state.logged.log(event, address));
    }

    /// Logs the sums of the second that is over.
    pub(crate) fn end_second(&self) {
        locked(&self.state, |state| state.logged.end_second());
    }
}

/// Unpredictable, so that nobody can time their connections by the chance of a refusal.
fn seed() -> u64 {
    // Without random numbers from the system there would be no keys, either.
    getrandom::u64().unwrap_or_default()
}
