//! A bus in simulated time, with faults.

use std::collections::BTreeMap;
use std::sync::Mutex;

use tokio::sync::{mpsc, oneshot};
use tokio::time::{Instant, sleep};

use super::super::bus::{Bus, BusAnswer, BusFault, HostRequest, Key};
use super::world::{CHECK_INTERVAL, StoredMessage, TIMEOUT, World, WorldState};
use crate::lock::locked;
use crate::rooms::summary::RoomId;

/// The bus of one host.
pub(crate) struct SimulatedBus {
    world: World,
    host: usize,
    revisions: Mutex<BTreeMap<Key, u64>>,
}

impl SimulatedBus {
    pub(crate) fn new(world: World, host: usize) -> Self {
        Self { world, host, revisions: Mutex::default() }
    }

    /// Runs `act` on the bus, unless the way there or back fails.
    fn call<'a, T: Send + 'a>(
        &'a self,
        act: impl FnOnce(&mut WorldState, usize) -> Result<T, BusFault> + Send + 'a,
    ) -> BusAnswer<'a, T> {
        let Self { world, host, .. } = self;
        Box::pin(async move {
            world.pass(*host).await;
            if world.is_lost(*host) {
                sleep(TIMEOUT).await;
                return Err(BusFault::Unknown);
            }
            let answer = world.with(|inner| act(inner, *host));
            world.pass(*host).await;
            if world.is_lost(*host) {
                sleep(TIMEOUT).await;
                return Err(BusFault::Unknown);
            }
            answer
        })
    }

    fn note(&self, key: Key, revision: u64) {
        locked(&self.revisions, |revisions| _ = revisions.insert(key, revision));
    }
}

impl Bus for SimulatedBus {
    fn append(&self, room: RoomId, last: u64, bytes: Vec<u8>) -> BusAnswer<'_, u64> {
        self.call(move |inner, host| {
            let log = inner.logs.entry(room).or_default();
            if log.last().map_or(0, |kept| kept.number) != last {
                return Err(BusFault::Refused);
            }
            inner.messages += 1;
            log.push(StoredMessage { number: inner.messages, host, bytes, at: Instant::now() });
            Ok(inner.messages)
        })
    }

    fn read(&self, room: RoomId, after: u64) -> BusAnswer<'_, Option<(u64, Vec<u8>)>> {
        self.call(move |inner, _| {
            let first = inner.dropped.get(&room).copied().unwrap_or_default().max(after + 1);
            let next = inner.logs.get(&room).into_iter().flatten().find(|it| it.number >= first);
            Ok(next.map(|kept| (kept.number, kept.bytes.clone())))
        })
    }

    fn drop_before(&self, room: RoomId, first: u64) -> BusAnswer<'_, ()> {
        self.call(move |inner, _| {
            let dropped = inner.dropped.entry(room).or_default();
            *dropped = first.max(*dropped);
            Ok(())
        })
    }

    fn drop_log(&self, room: RoomId) -> BusAnswer<'_, ()> {
        self.drop_before(room, u64::MAX)
    }

    fn broadcast(&self, room: RoomId, message: Vec<u8>) -> BusAnswer<'_, ()> {
        let world = self.world.clone();
        self.call(move |inner, _| {
            for (host, _, listener) in inner.listeners.iter().filter(|it| it.1 == room) {
                let (world, host) = (world.clone(), *host);
                let (listener, message) = (listener.clone(), message.clone());
                tokio::spawn(async move {
                    world.pass(host).await;
                    if !world.is_lost(host) {
                        _ = listener.try_send(message);
                    }
                });
            }
            Ok(())
        })
    }

    fn subscribe(&self, room: RoomId) -> BusAnswer<'_, mpsc::Receiver<Vec<u8>>> {
        self.call(move |inner, host| {
            let (listener, message) = mpsc::channel(1_024);
            inner.listeners.retain(|it| !it.2.is_closed());
            inner.listeners.push((host, room, listener));
            Ok(message)
        })
    }

    fn ask_hosts(&self, request: Vec<u8>) -> BusAnswer<'_, mpsc::Receiver<Vec<u8>>> {
        let (world, asking) = (self.world.clone(), self.host);
        self.call(move |inner, _| {
            let (answers, receiver) = mpsc::channel(1_024);
            for (host, listener) in inner.operators.iter().cloned() {
                let (world, answers, bytes) = (world.clone(), answers.clone(), request.clone());
                tokio::spawn(async move {
                    world.pass(host).await;
                    let (reply, answer) = oneshot::channel();
                    if !world.is_lost(host) {
                        _ = listener.try_send(HostRequest { bytes, reply });
                    }
                    let Ok(answer) = answer.await else { return };
                    world.pass(host).await;
                    if !world.is_lost(host) && !world.is_lost(asking) {
                        _ = answers.try_send(answer);
                    }
                });
            }
            Ok(receiver)
        })
    }

    fn host_requests(&self) -> BusAnswer<'_, mpsc::Receiver<HostRequest>> {
        self.call(|inner, host| {
            let (listener, requests) = mpsc::channel(1_024);
            inner.operators.push((host, listener));
            Ok(requests)
        })
    }

    fn next_number(&self) -> BusAnswer<'_, u32> {
        self.call(|inner, _| {
            inner.rooms += 1;
            Ok(inner.rooms)
        })
    }

    fn put(&self, key: Key, value: Vec<u8>) -> BusAnswer<'_, ()> {
        let known = locked(&self.revisions, |it| it.get(&key).copied().unwrap_or_default());
        self.call(move |inner, _| {
            let is_known = inner.revision(&key) == known;
            let revision =
                if is_known { inner.keep(key.clone(), Some(value)) } else { inner.revision(&key) };
            self.note(key, revision);
            is_known.then_some(()).ok_or(BusFault::Refused)
        })
    }

    fn create(&self, key: Key, value: Vec<u8>) -> BusAnswer<'_, ()> {
        self.call(move |inner, _| {
            if inner.values.get(&key).is_some_and(|kept| kept.1.is_some()) {
                return Err(BusFault::Refused);
            }
            let revision = inner.keep(key.clone(), Some(value));
            self.note(key, revision);
            Ok(())
        })
    }

    fn get(&self, key: Key) -> BusAnswer<'_, Option<Vec<u8>>> {
        self.call(move |inner, _| {
            let (revision, value) = inner.values.get(&key).cloned().unwrap_or_default();
            self.note(key, revision);
            Ok(value)
        })
    }

    fn remove(&self, key: Key) -> BusAnswer<'_, ()> {
        self.call(move |inner, _| {
            inner.keep(key, None);
            Ok(())
        })
    }

    fn watch(&self) -> BusAnswer<'_, mpsc::Receiver<(RoomId, Option<Vec<u8>>)>> {
        let (world, host) = (self.world.clone(), self.host);
        self.call(move |_, _| {
            let (changes, receiver) = mpsc::channel(1_024);
            tokio::spawn(async move {
                for index in 0.. {
                    loop {
                        world.pass(host).await;
                        let change = world.with(|inner| inner.changes.get(index).cloned());
                        let Some(change) = change.filter(|_| !world.link(host).is_cut) else {
                            sleep(CHECK_INTERVAL * 5).await;
                            continue;
                        };
                        if changes.send(change).await.is_err() {
                            return;
                        }
                        break;
                    }
                }
            });
            Ok(receiver)
        })
    }
}
