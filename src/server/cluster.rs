//! Clusters: several hosts whose players are in the same rooms.
//!
//! A room is a deterministic machine with an ordered log. Each host that has players in a room runs it, from
//! the same log, and draws for its own players: drawing is what costs, a step of a room is nothing beside it. The
//! log, and what else hosts keep together, is on a [`Bus`]; which of them writes the log is decided by a lease
//! in the database.
//!
//! # Rules
//!
//! - **One host writes a room's log**, its sequencer. Each message names the one before it, and the bus refuses
//!   one that names another: whoever was replaced writes nothing, whatever they believe.
//! - **An epoch has one sequencer.** It begins with a message, and messages of an older one change nothing.
//! - **All hosts apply the same messages**, and compare a checksum once a second.
//! - **Any host takes any player.** A room that nobody is in runs nowhere.
//! - **Rooms have the versions of the format and of the rules.** A host of other versions does not see them.
//!
//! An election among the hosts was refused, as was a log of our own: the database and the bus do both, and
//! are tested for it.

mod bus;
mod desk;
mod directory;
mod message;
mod nats;
mod office;
mod record;
mod replica;
#[cfg(test)]
mod simulation;
mod station;
mod talk;

use std::fmt;
use std::io;
use std::sync::{Arc, Mutex};

use tokio::sync::watch;

use self::bus::{Bus, Key};
use self::desk::Desk;
pub(super) use self::directory::SharedRooms;
use self::nats::NatsBus;
use self::record::Record;
use self::replica::Replica;
use super::load::Load;
use super::locked;
use super::room::Catalog;
use super::rooms::{RoomRefusal, Rooms};
use super::summary::{RoomId, RoomWish};
use super::visitors::Visitors;
use crate::rng::SplitMix64;
use crate::store::host::Leases;

/// A place in a cluster, for one host.
pub struct Cluster {
    bus: Box<dyn Bus>,
    desk: Desk,
    /// Of tokens and of the rooms that this host opens.
    seed: u64,
}

impl Cluster {
    /// The cluster at an address such as `nats://host:4222`. The host that is called `host`, as no other, gets its
    /// leases from `leases`.
    ///
    /// # Errors
    /// A sentence, if the server does not answer, or has no `JetStream`.
    pub async fn join(
        address: &str,
        leases: Box<dyn Leases>,
        host: String,
    ) -> Result<Self, String> {
        let no_thread = |error: io::Error| format!("no thread can be started: {error}");
        // Before all that may fail: leases block when they are dropped, too.
        let desk = Desk::start(leases, host).map_err(no_thread)?;
        let bus = Box::new(NatsBus::connect(address).await?);
        // Without random numbers from the system there would be no keys, either.
        Ok(Self { bus, desk, seed: getrandom::u64().unwrap_or_default() })
    }

    /// The rooms of the cluster, which lobbies see in `rooms`.
    pub(super) fn rooms(
        self,
        rooms: &Rooms,
        standing: Vec<RoomWish>,
        load: Arc<Load>,
        visitors: Visitors,
    ) -> SharedRooms {
        let Self { bus, desk, seed } = self;
        let company = Company {
            bus,
            desk,
            catalog: Arc::clone(rooms.catalog()),
            load,
            visitors,
            chance: Mutex::new(SplitMix64::new(seed)),
            ending: watch::Sender::new(false),
        };
        SharedRooms::new(Arc::new(company), rooms.clone(), standing)
    }
}

impl fmt::Debug for Cluster {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Cluster").finish_non_exhaustive()
    }
}

/// What the stations of a host have in common.
struct Company {
    bus: Box<dyn Bus>,
    desk: Desk,
    catalog: Arc<Catalog>,
    load: Arc<Load>,
    visitors: Visitors,
    chance: Mutex<SplitMix64>,
    /// Whether the host ends.
    ending: watch::Sender<bool>,
}

impl Company {
    /// A random number.
    fn chance(&self) -> u64 {
        locked(&self.chance, SplitMix64::bits)
    }

    /// Says a line to those of this host who are in a room.
    fn tell(&self, id: RoomId, line: &str) {
        self.visitors.say_in(&id.place(), line);
    }

    /// A room as its newest checkpoint has it, and its record.
    async fn load_replica(&self, id: RoomId) -> Result<(Replica, Record), RoomRefusal> {
        let record = self.bus.get(Key::Room(id)).await.map_err(|_| RoomRefusal::NotNow)?;
        let record = record.and_then(|bytes| Record::parse(&bytes)).ok_or(RoomRefusal::Gone)?;
        let bytes = self.bus.get(Key::Checkpoint(id)).await.map_err(|_| RoomRefusal::NotNow)?;
        let replica = match bytes {
            None => Replica::new(&self.catalog, record.header.clone()),
            Some(bytes) => match Replica::restore(&self.catalog, &bytes) {
                Ok(replica) => Some(replica),
                Err(sentence) => {
                    tracing::error!(room = %id, "a checkpoint of a room: {sentence}");
                    None
                }
            },
        };
        Ok((replica.ok_or(RoomRefusal::NoLevel)?, record))
    }
}
