//! Clusters: several hosts whose players are in the same rooms.
//!
//! A room is a deterministic state machine with an ordered log (state machine replication, Schneider 1990). Each
//! host that has players in a room keeps a [`Replica`](replica::Replica) of it and draws for its own players:
//! drawing costs hundreds of times as much as a step of a room. The log and the list of rooms are on a [`Bus`];
//! a lease in the database decides which host writes a log.
//!
//! # Rules
//!
//! - **One host writes a room's log**, its sequencer. Each message names the number of the message before it,
//!   and the bus refuses a message that names another. A sequencer that was replaced without noticing it cannot
//!   write.
//! - **An epoch has one sequencer.** An epoch begins with a message, and later messages of an older epoch change
//!   nothing.
//! - **All hosts apply the same messages**, and compare a checksum once a second.
//! - **Any host takes any player.** A room without members runs on no host.
//! - **Limits of connections hold on all hosts together**, and an operator of one host asks all.
//! - **Rooms carry the versions of the format and of the rules.** A host of other versions does not list them.
//!
//! An election among the hosts and a log of our own were refused: the database and the bus provide both, and are
//! tested for it.

mod bus;
mod directory;
#[cfg(fuzzing)]
pub(crate) mod fuzzing;
mod lease_worker;
mod log_message;
mod nats;
mod operators;
mod peer_message;
mod record;
mod replica;
mod room_state;
mod sequencer;
#[cfg(test)]
mod simulation;
mod visits;

use std::fmt;
use std::io;
use std::sync::{Arc, Mutex};

use tokio::sync::watch;
use tokio::time::Instant;

use self::bus::{Bus, Key};
pub(crate) use self::directory::{Entrant, SharedRooms};
use self::lease_worker::LeaseWorker;
use self::nats::NatsBus;
pub(crate) use self::operators::OtherHosts;
use self::record::Record;
use self::room_state::RoomState;
use self::visits::Visits;
pub(crate) use self::visits::{CountedVisit, NewVisit, VisitRefusal};
use crate::accounts::{HostNotice, HostStore};
use crate::lock::locked;
use crate::rooms::directory::{RoomRefusal, Rooms};
use crate::rooms::room::Catalog;
use crate::rooms::summary::{RoomId, RoomWish};
use crate::sessions::load::Load;
use crate::sessions::visitors::Visitors;
use cellcaster::rng::SplitMix64;

/// A place in a cluster, for one host.
pub struct Cluster {
    bus: Box<dyn Bus>,
    leases: LeaseWorker,
    visits: Visits,
    notice: HostNotice,
    /// The seed of join tokens, and of the rooms that this host opens.
    seed: u64,
}

impl Cluster {
    /// The cluster at an address such as `nats://host:4222`. The host of `notice` gets its leases from `leases`, and
    /// is counted in `presence` with its visitors.
    ///
    /// # Errors
    /// A sentence, if the server does not answer, or has no `JetStream`.
    pub async fn join(
        address: &str,
        leases: HostStore,
        presence: HostStore,
        notice: HostNotice,
    ) -> Result<Self, String> {
        let no_thread = |error: io::Error| format!("no thread can be started: {error}");
        // Before anything that may fail: what blocks does so when it is dropped, too.
        let leases = LeaseWorker::start(leases, notice.name.clone()).map_err(no_thread);
        let visits = Visits::start(presence, notice.clone()).map_err(no_thread);
        let (leases, visits) = (leases?, visits?);
        let bus = Box::new(NatsBus::connect(address).await?);
        // Without random numbers from the system there would be no keys, either.
        let seed = getrandom::u64().unwrap_or_default();
        Ok(Self { bus, leases, visits, notice, seed })
    }

    /// The rooms of the cluster, which lobbies see in `rooms`.
    pub(crate) fn rooms(
        self,
        rooms: &Rooms,
        standing: Vec<RoomWish>,
        load: Arc<Load>,
        visitors: Visitors,
    ) -> SharedRooms {
        let Self { bus, leases, visits, notice, seed } = self;
        // A host has one name at most.
        _ = load.metrics().host.set(shown_name(&notice.name).to_owned());
        let context = HostContext {
            begun: Instant::now(),
            bus,
            leases,
            visits,
            notice,
            catalog: Arc::clone(rooms.catalog()),
            load,
            visitors,
            chance: Mutex::new(SplitMix64::new(seed)),
            ending: watch::Sender::new(false),
        };
        SharedRooms::new(Arc::new(context), rooms.clone(), standing)
    }
}

impl fmt::Debug for Cluster {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Cluster").finish_non_exhaustive()
    }
}

/// The name of a host as operators read it, without the number of its start.
fn shown_name(name: &str) -> &str {
    name.split_once(' ').map_or(name, |(shown, _)| shown)
}

/// What the replicas of a host share.
pub(crate) struct HostContext {
    /// When the host was started.
    begun: Instant,
    bus: Box<dyn Bus>,
    leases: LeaseWorker,
    visits: Visits,
    notice: HostNotice,
    catalog: Arc<Catalog>,
    load: Arc<Load>,
    visitors: Visitors,
    chance: Mutex<SplitMix64>,
    /// Whether the host ends.
    ending: watch::Sender<bool>,
}

impl HostContext {
    /// A random number.
    fn chance(&self) -> u64 {
        locked(&self.chance, SplitMix64::bits)
    }

    /// Shows a line to the members of a room who are on this host.
    fn tell(&self, id: RoomId, line: &str) {
        self.visitors.say_in(&id.place(), line);
    }

    /// The state of a room in its newest checkpoint, and its record.
    async fn load_state(&self, id: RoomId) -> Result<(RoomState, Record), RoomRefusal> {
        let record = self.bus.get(Key::Room(id)).await.map_err(|_| RoomRefusal::NotNow)?;
        let record = record.and_then(|bytes| Record::parse(&bytes)).ok_or(RoomRefusal::Gone)?;
        let bytes = self.bus.get(Key::Checkpoint(id)).await.map_err(|_| RoomRefusal::NotNow)?;
        let state = match bytes {
            None => RoomState::new(&self.catalog, record.header.clone()),
            Some(bytes) => match RoomState::restore(&self.catalog, &bytes) {
                Ok(state) => Some(state),
                Err(sentence) => {
                    tracing::error!(room = %id, "a checkpoint of a room: {sentence}");
                    None
                }
            },
        };
        Ok((state.ok_or(RoomRefusal::NoLevel)?, record))
    }
}
