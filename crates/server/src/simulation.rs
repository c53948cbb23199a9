//! A host in simulated time: real rooms, sequencers, drivers, sessions and store, connected by pipes to
//! clients with terminal emulators.
//!
//! Everything runs on one thread, under a clock that advances only when no task is ready. A run therefore
//! depends on its seed alone, and a simulated minute takes less than a second. Tokio wakes the tasks that
//! wait for a `watch` channel in random order, and only an unstable option seeds that order. No run depends
//! on it: a test plays seeds twice to check. The exception is a slow [worker](Worker), where the order shifts
//! some tasks by a few milliseconds.

mod client;
#[path = "../../../tests/support/emulator.rs"]
pub(crate) mod emulator;
mod logs;
#[path = "../../../tests/support/looks.rs"]
mod looks;
mod seeds;

use std::sync::Arc;
use std::time::Duration;

use tokio::runtime::{Builder, Runtime};
use tokio::time::{Instant, sleep};
use toml::Spanned;

pub(crate) use self::client::{Conditions, SimulatedClient, guest};
pub(crate) use self::emulator::Speaks;
pub(crate) use self::logs::{RoomLogs, replayed};
use crate::accounts::{HostStore, UnixTime};
use crate::config::{Config, LiveConfig, StandingRoom};
use crate::line::Line;
use crate::load::Worker;
use crate::metrics::Metrics;
use crate::rooms::directory::Recordings;
use crate::rooms::directory::Rooms;
use crate::rooms::room::{Catalog, MemberId, Mode, NAME_COLUMNS, RoomView};
use crate::rooms::summary::RoomId;
use crate::sessions::driver::{Setup, Simulated};
use crate::sessions::session::Session;
use crate::ssh::Visitor;
use crate::visitors::Visitors;
use cellcaster::color::palette::ColorDepth;
use cellcaster::map;
use cellcaster::world::Difficulty;

pub(crate) const HALL: &str = r##"
title = "The Hall"
grid = '''
###############
#@............#
#.............#
#.............#
#............>#
###############
'''
[tiles]
"#" = { wall = "#808080" }
[things]
"@" = { start = 0 }
">" = { exit = true }
"##;

/// The number of the standing room.
pub(crate) const ROOM: RoomId = RoomId(1);
pub(crate) const ENTER: &str = "\r";
pub(crate) const ESCAPE: &str = "\x1b";

/// A host and all clients that have connected to it.
pub(crate) struct Rig {
    runtime: Runtime,
    host: Simulated,
    pub(crate) live: LiveConfig,
    pub(crate) visitors: Visitors,
    pub(crate) clients: Vec<SimulatedClient>,
    pub(crate) logs: RoomLogs,
}

/// Options of a simulated server.
pub(crate) struct RigOptions {
    pub(crate) catalog: Catalog,
    /// The level of the standing room.
    pub(crate) level: &'static str,
    pub(crate) mode: Mode,
    /// The duration of each call to the store.
    pub(crate) store_time: Duration,
    pub(crate) worker: Worker,
    pub(crate) seed: u64,
    /// The time at the start.
    pub(crate) time: UnixTime,
    /// The recordings of rooms; `None` for tapes in memory.
    pub(crate) recordings: Option<Recordings>,
}

pub(crate) fn line(text: &str) -> Line {
    Line::of(text, NAME_COLUMNS).unwrap()
}

/// A catalog of two levels with the same map.
pub(crate) fn catalog(map: &str) -> Catalog {
    let mut catalog = Catalog::default();
    for name in ["museum", "hall"] {
        catalog.add(name, map::parse(map, name, &map::NoFiles).unwrap());
    }
    catalog
}

impl RigOptions {
    /// The hall as both levels, and a standing room in one of them.
    pub(crate) fn new(mode: Mode) -> Self {
        let (store_time, worker) = (Duration::ZERO, Worker::default());
        // The time of a store in memory.
        let time = UnixTime::new(1_000_000_000);
        let catalog = catalog(HALL);
        Self { catalog, level: "hall", mode, store_time, worker, seed: 7, time, recordings: None }
    }
}

impl Rig {
    /// A host with a standing room in this mode.
    pub(crate) fn new(mode: Mode) -> Self {
        Self::with(RigOptions::new(mode))
    }

    pub(crate) fn with(options: RigOptions) -> Self {
        let runtime =
            Builder::new_current_thread().enable_time().start_paused(true).build().unwrap();
        let level = Spanned::new(0..0, options.level.to_owned());
        let room = StandingRoom { mode: options.mode, level, difficulty: Difficulty::Normal };
        let config =
            Config { message: "Be kind.".to_owned(), standing: vec![room], ..Config::default() };
        let (live, visitors, logs) =
            (LiveConfig::new(config), Visitors::default(), RoomLogs::default());
        let setup = Setup {
            live: live.clone(),
            visitors: visitors.clone(),
            time: options.time,
            catalog: options.catalog,
            recordings: options.recordings.unwrap_or_else(|| logs.recordings()),
            store: HostStore::in_memory(),
            store_time: options.store_time,
            worker: options.worker,
            seed: options.seed,
        };
        let host = runtime.block_on(async {
            let host = Simulated::new(setup);
            // The host prepares the day.
            sleep(options.store_time).await;
            host
        });
        Self { runtime, host, live, visitors, clients: Vec::new(), logs }
    }

    /// Connects a visitor with a monochrome terminal; returns their index.
    pub(crate) fn visitor(&mut self, name: &str, size: (u16, u16), speaks: Speaks) -> usize {
        self.visitor_with(name, size, speaks, ColorDepth::Mono)
    }

    pub(crate) fn visitor_with(
        &mut self,
        name: &str,
        size: (u16, u16),
        speaks: Speaks,
        depth: ColorDepth,
    ) -> usize {
        let index = self.arrive(name, size, speaks, depth);
        self.pump(300);
        index
    }

    /// Connects a guest without letting time pass; returns their index.
    pub(crate) fn arrive(
        &mut self,
        name: &str,
        size: (u16, u16),
        speaks: Speaks,
        depth: ColorDepth,
    ) -> usize {
        self.connect(guest(name, size), speaks, depth)
    }

    /// Connects a visitor without letting time pass; returns their index.
    pub(crate) fn connect(&mut self, visitor: Visitor, speaks: Speaks, depth: ColorDepth) -> usize {
        let Self { runtime, host, .. } = self;
        let client =
            runtime.block_on(async { SimulatedClient::come(host, visitor, speaks, depth) });
        self.clients.push(client);
        self.clients.len() - 1
    }

    /// Connects a visitor and enters the standing room; returns their index.
    pub(crate) fn member(&mut self, name: &str, size: (u16, u16), speaks: Speaks) -> usize {
        let index = self.visitor(name, size, speaks);
        for _ in 0..3 {
            self.press(index, ENTER);
        }
        assert!(self.member_id(index).is_some(), "{}", self.text(index));
        index
    }

    /// Types bytes and lets half a second pass.
    pub(crate) fn press(&mut self, index: usize, bytes: &str) {
        self.send(index, bytes);
        self.pump(500);
    }

    pub(crate) fn send(&self, index: usize, bytes: impl AsRef<[u8]>) {
        let _guard = self.runtime.enter();
        self.clients[index].send(bytes.as_ref());
    }

    /// Lets time pass, in milliseconds.
    pub(crate) fn pump(&mut self, milliseconds: u64) {
        self.runtime.block_on(async { sleep(Duration::from_millis(milliseconds)).await });
    }

    /// The current simulated time.
    pub(crate) fn now(&self) -> Instant {
        let _guard = self.runtime.enter();
        Instant::now()
    }

    /// The text on the visitor's screen.
    pub(crate) fn text(&self, index: usize) -> String {
        self.clients[index].look(|emulator| {
            let screen = emulator.screen();
            let (_, columns) = screen.size();
            let rows = screen.rows(0, columns.get()).map(|row| row.trim_end().to_owned() + "\n");
            rows.collect()
        })
    }

    /// Inspects a running session together with the latest snapshot of its room.
    pub(crate) fn session<T: Send + 'static>(
        &self,
        index: usize,
        look: impl FnOnce(&mut Session, Option<&RoomView>) -> T + Send + 'static,
    ) -> T {
        let looked = self.runtime.block_on(self.clients[index].visiting.look(look));
        looked.expect("the session has ended")
    }

    /// The visitor's number as a member.
    pub(crate) fn member_id(&self, index: usize) -> Option<MemberId> {
        self.session(index, |session, _| session.member())
    }

    pub(crate) fn is_over(&self, index: usize) -> bool {
        self.clients[index].visiting.is_over()
    }

    pub(crate) fn metrics(&self) -> &Metrics {
        self.host.metrics()
    }

    pub(crate) fn rooms(&self) -> &Rooms {
        self.host.rooms()
    }

    /// The latest snapshot of the standing room.
    pub(crate) fn view(&self) -> Arc<RoomView> {
        self.rooms().view(ROOM).expect("the room is there")
    }

    pub(crate) fn position(&self, index: usize) -> glam::DVec2 {
        self.session(index, |session, room| {
            let room = room.expect("a room");
            let member = room.member(session.member().unwrap()).unwrap();
            let player = room.game.seen_by(member.player.unwrap()).unwrap();
            player.position()
        })
    }

    /// The number of tasks of the host and its clients.
    pub(crate) fn tasks(&self) -> usize {
        self.runtime.metrics().num_alive_tasks()
    }
}
