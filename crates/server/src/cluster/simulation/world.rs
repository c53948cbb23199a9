//! The state that the hosts of a simulation share: logs, values, leases, and links with faults.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::sync::mpsc;
use tokio::time::{Instant, sleep};

use super::super::bus::{Bus, HostRequest, Key};
use super::super::leases::Leases;
use super::super::visits::Visits;
use super::bus::SimulatedBus;
use crate::accounts::worker::StoreWorker;
use crate::accounts::{HostNotice, HostStore, StoreFailure};
use crate::lock::locked;
use crate::rooms::summary::RoomId;
use cellcaster::rng::SplitMix64;

pub(crate) const TIMEOUT: Duration = Duration::from_secs(1);
/// The time between two checks whether a fault is over.
pub(crate) const CHECK_INTERVAL: Duration = Duration::from_millis(10);

/// The state that the hosts share, and the faults of their links.
#[derive(Clone)]
pub(crate) struct World(Arc<Mutex<WorldState>>);

pub(crate) struct WorldState {
    pub(crate) chance: SplitMix64,
    /// All messages that were ever appended.
    pub(crate) logs: BTreeMap<RoomId, Vec<StoredMessage>>,
    /// The number before which the messages of a room are dropped.
    pub(crate) dropped: BTreeMap<RoomId, u64>,
    pub(crate) messages: u64,
    pub(crate) rooms: u32,
    pub(crate) values: BTreeMap<Key, (u64, Option<Vec<u8>>)>,
    pub(crate) changes: Vec<(RoomId, Option<Vec<u8>>)>,
    pub(crate) listeners: Vec<(usize, RoomId, mpsc::Sender<Vec<u8>>)>,
    pub(crate) operators: Vec<(usize, mpsc::Sender<HostRequest>)>,
    store: HostStore,
    asked_at: Instant,
    links: Vec<HostLinks>,
}

/// A message of a log.
#[derive(Clone)]
pub(crate) struct StoredMessage {
    pub(crate) number: u64,
    pub(crate) host: usize,
    pub(crate) bytes: Vec<u8>,
    pub(crate) at: Instant,
}

/// The links of a host.
#[derive(Clone, Copy, Default)]
pub(crate) struct HostLinks {
    /// `true` if the host reaches nobody on the bus.
    pub(crate) is_cut: bool,
    /// `true` if the host does not reach the database.
    pub(crate) has_no_database: bool,
    /// `true` if the host stands still.
    pub(crate) is_frozen: bool,
    /// One in this many answers and broadcasts is lost.
    pub(crate) loses_one_in: Option<usize>,
    /// The longest delay, in milliseconds.
    pub(crate) delay: u64,
}

/// A host's information about itself.
pub(crate) fn notice(host: usize) -> HostNotice {
    let (name, address) = (format!("host:{host} 1"), format!("host{host}.example.org:2222"));
    HostNotice { name, version: "0.1.0".to_owned(), address, load: 0 }
}

impl World {
    pub(crate) fn new(seed: u64, hosts: usize) -> Self {
        let good = HostLinks { delay: 2, ..HostLinks::default() };
        Self(Arc::new(Mutex::new(WorldState {
            chance: SplitMix64::new(seed),
            logs: BTreeMap::new(),
            dropped: BTreeMap::new(),
            messages: 0,
            rooms: 0,
            values: BTreeMap::new(),
            changes: Vec::new(),
            listeners: Vec::new(),
            operators: Vec::new(),
            store: HostStore::in_memory(),
            asked_at: Instant::now(),
            links: vec![good; hosts],
        })))
    }

    pub(crate) fn with<T>(&self, act: impl FnOnce(&mut WorldState) -> T) -> T {
        locked(&self.0, act)
    }

    pub(crate) fn bus(&self, host: usize) -> Box<dyn Bus> {
        Box::new(SimulatedBus::new(self.clone(), host))
    }

    /// The leases of a host, by the clock of the database.
    pub(crate) fn leases(&self, host: usize) -> Leases {
        Leases::new(self.worker(host), notice(host).name)
    }

    /// The visits of a host, by the same clock.
    pub(crate) fn visits(&self, host: usize) -> Visits {
        Visits::new(self.worker(host), notice(host))
    }

    /// A task that calls the database for a host, in place of a thread.
    fn worker(&self, host: usize) -> StoreWorker {
        let (worker, mut queue) = StoreWorker::new(256);
        let world = self.clone();
        tokio::spawn(async move {
            while let Some(call) = queue.recv().await {
                world.pass(host).await;
                if world.link(host).has_no_database {
                    sleep(TIMEOUT).await;
                    call(&mut HostStore::failing(StoreFailure::Away("no database".into())));
                    continue;
                }
                world.with(|inner| call(inner.store()));
                world.pass(host).await;
            }
        });
        worker
    }

    pub(crate) fn link(&self, host: usize) -> HostLinks {
        self.with(|inner| inner.links[host])
    }

    pub(crate) fn set(&self, host: usize, change: impl FnOnce(&mut HostLinks)) {
        self.with(|inner| change(&mut inner.links[host]));
    }

    /// All messages that a room's log ever contained.
    pub(crate) fn log(&self, room: RoomId) -> Vec<StoredMessage> {
        self.with(|inner| inner.logs.get(&room).cloned().unwrap_or_default())
    }

    /// The first record of a room.
    pub(crate) fn first_record(&self, room: RoomId) -> Option<Vec<u8>> {
        self.with(|inner| inner.changes.iter().find(|change| change.0 == room)?.1.clone())
    }

    /// Passes through the network with a delay. Waits while the host stands still.
    pub(crate) async fn pass(&self, host: usize) {
        let delay = self.with(|inner| {
            let longest = inner.links[host].delay;
            inner.chance.below(longest as usize + 1)
        });
        sleep(Duration::from_millis(delay as u64)).await;
        while self.link(host).is_frozen {
            sleep(CHECK_INTERVAL).await;
        }
    }

    pub(crate) fn is_lost(&self, host: usize) -> bool {
        self.with(|inner| {
            let link = inner.links[host];
            link.is_cut || link.loses_one_in.is_some_and(|most| inner.chance.one_in(most))
        })
    }
}

impl WorldState {
    /// The database of all hosts, with its clock moved on to now.
    fn store(&mut self) -> &mut HostStore {
        let now = Instant::now();
        self.store.pass(now - self.asked_at);
        self.asked_at = now;
        &mut self.store
    }

    pub(crate) fn keep(&mut self, key: Key, value: Option<Vec<u8>>) -> u64 {
        if let Key::Room(room) = key {
            self.changes.push((room, value.clone()));
        }
        self.messages += 1;
        self.values.insert(key, (self.messages, value));
        self.messages
    }

    pub(crate) fn revision(&self, key: &Key) -> u64 {
        self.values.get(key).map_or(0, |value| value.0)
    }
}
