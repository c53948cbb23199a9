//! Clusters: several hosts whose players share the same rooms.
//!
//! A room is a deterministic state machine with an ordered log (state machine replication, Schneider 1990). Each host
//! with players in a room keeps a [`Replica`](replica::Replica) of it. A host draws only for its own players, because
//! drawing costs hundreds of times as much as a step of a room. The log and the list of rooms are on a [`Bus`]. A lease
//! in the database decides which host writes a log.
//!
//! # Rules
//!
//! - **One host writes a room's log**, its sequencer. Each message states the number of the message before it, and the
//!   bus refuses a message that states another number. So a sequencer that was replaced cannot write, even before it
//!   notices.
//! - **An epoch has one sequencer.** An epoch begins with a message. Later messages of an older epoch change nothing.
//! - **All hosts apply the same messages**, and compare a checksum once a second.
//! - **Any host takes any player.** A room without members runs on no host.
//! - **Limits on connections hold for all hosts together**, and an operator of one host reaches all hosts.
//! - **Rooms carry the versions of the format and of the rules.** A host with other versions does not list them.
//!
//! Rejected: an election among the hosts, and a log of our own. The database and the bus provide both, and are tested
//! for it.

mod bus;
mod directory;
#[cfg(feature = "fuzzing")]
pub(crate) mod fuzzing;
mod host;
mod leases;
mod message;
mod nats;
mod operators;
mod replica;
mod room_state;
mod sequencer;
#[cfg(test)]
mod simulation;
mod visits;

use std::io;
use std::sync::{Arc, Mutex};

use tokio::sync::watch;

use self::bus::Bus;
pub(crate) use self::directory::{Entrant, SharedRooms};
use self::host::{HostContext, shown_name};
use self::leases::{Leases, MAX_CALLS};
use self::nats::NatsBus;
use self::visits::Visits;
pub(crate) use self::visits::{CountedVisit, NewVisit, VisitRefusal};
use crate::accounts::worker::StoreWorker;
use crate::accounts::{HostNotice, HostStore};
use crate::load::Load;
use crate::rooms::directory::Rooms;
use crate::rooms::summary::RoomRequest;
use crate::visitors::Visitors;
use cellcaster::rng::SplitMix64;

/// The membership of one host in a cluster.
pub struct Cluster {
    bus: Box<dyn Bus>,
    leases: Leases,
    visits: Visits,
    notice: HostNotice,
    /// The seed for join tokens, and for the rooms that this host opens.
    seed: u64,
}

impl Cluster {
    /// Joins the cluster at an address such as `nats://host:4222`. The host of `notice` takes its leases from `leases`.
    /// `presence` stores the host and its visits.
    ///
    /// # Errors
    /// A sentence, if the server does not answer or has no `JetStream`.
    pub async fn join(
        address: &str,
        leases: HostStore,
        presence: HostStore,
        notice: HostNotice,
    ) -> Result<Self, String> {
        let no_thread = |error: io::Error| format!("a thread can't be started: {error}");
        // Start the threads before anything can fail, because dropping a database blocks, too.
        let leases = StoreWorker::start("leases", MAX_CALLS, leases).map_err(no_thread);
        let presence = StoreWorker::start("visits", MAX_CALLS, presence).map_err(no_thread);
        let leases = Leases::new(leases?, notice.name.clone());
        let visits = Visits::new(presence?, notice.clone());
        let bus = Box::new(NatsBus::connect(address).await?);
        // If the system had no random numbers, there would be no keys, either.
        let seed = getrandom::u64().unwrap_or_default();
        Ok(Self { bus, leases, visits, notice, seed })
    }

    /// Starts the rooms of the cluster, which lobbies see in `rooms`.
    pub(crate) fn rooms(
        self,
        rooms: Rooms,
        standing: Vec<RoomRequest>,
        load: Arc<Load>,
        visitors: Visitors,
    ) -> SharedRooms {
        let Self { bus, leases, visits, notice, seed } = self;
        // A host has at most one name.
        _ = load.metrics.host.set(shown_name(&notice.name).to_owned());
        let context = HostContext {
            bus,
            leases,
            visits,
            notice,
            rooms,
            load,
            visitors,
            chance: Mutex::new(SplitMix64::new(seed)),
            ending: watch::Sender::new(false),
        };
        SharedRooms::new(Arc::new(context), standing)
    }
}
