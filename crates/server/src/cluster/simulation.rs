//! Three hosts with players, a bus and a database in simulated time. Their links have faults.
//!
//! Players enter rooms, walk, talk and leave. Hosts are cut off from the bus or the database, stand still, drain,
//! or are killed. Their players then connect to other hosts, and some connect twice. Answers and broadcasts are
//! delayed and lost. After each run, all faults except killed hosts are repaired, and nothing breaks for a while.
//! Then:
//!
//! - no epoch has had two sequencers, and no epoch follows a later one in the log;
//! - each host shows the same room as a replay of the log from its beginning, bit for bit;
//! - no checksum has differed on any host;
//! - each player who was let in is in the log once, under a number of their own;
//! - the members who are not away are the players who are present, and each room with members goes on;
//! - a player who has returned is the same member as before, and no connection holds a place that another one has
//!   taken;
//! - nobody takes the place of a player who plays.
//!
//! A failed run prints its seed. `SEED=n cargo test -p cellcaster-server --lib cluster::simulation` repeats
//! it. `CLUSTER_SEEDS=1000` plays a thousand seeds instead of [`SEEDS`].

mod bus;
mod findings;
mod operators;
mod players;
mod world;

use std::array;
use std::env;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::time::Duration;

use tokio::runtime::Builder;
use tokio::time::{Instant, sleep};

use self::players::SimulatedPlayer;
use self::world::{HostLinks, World, notice};
use super::{Cluster, Entrant, SharedRooms};
use crate::line::Line;
use crate::load::{Load, Worker};
use crate::metrics::Metrics;
use crate::rooms::directory::{Recordings, RoomLimits, Rooms, Seeds};
use crate::rooms::room::{Catalog, MemberId, Mode};
use crate::rooms::summary::{RoomId, RoomRequest};
use crate::simulation::{HALL, catalog};
use crate::visitors::Visitors;
use cellcaster::rng::SplitMix64;
use cellcaster::world::Difficulty;

const HOSTS: usize = 3;
const PLAYERS: usize = 5;
/// The time with faults, in milliseconds.
const FAULTS: u64 = 12_000;
/// The time without faults, after which none of their effects is left.
const CALM: Duration = Duration::from_secs(25);
/// Long enough for hosts to apply a configuration, and for a room to end on its host.
const CONFIGURED: Duration = Duration::from_secs(12);
/// The number of seeds in a usual run.
const SEEDS: u64 = 60;

/// A run of one seed.
struct ClusterRun {
    world: World,
    chance: SplitMix64,
    catalog: Arc<Catalog>,
    hosts: Vec<SimulatedHost>,
    players: Vec<SimulatedPlayer>,
    /// All members who were ever let in.
    let_in: Vec<(RoomId, MemberId)>,
    /// How many times players have returned.
    returns: u64,
}

struct SimulatedHost {
    rooms: Rooms,
    shared: SharedRooms,
    visitors: Visitors,
    metrics: Arc<Metrics>,
    /// `true` once it was killed or has ended.
    is_killed: bool,
    /// The time when its faults are over.
    well_at: Instant,
}

impl ClusterRun {
    fn new(seed: u64) -> Self {
        let mut chance = SplitMix64::new(seed);
        let world = World::new(chance.bits(), HOSTS);
        let catalog = Arc::new(catalog(HALL));
        let hosts =
            (0..HOSTS).map(|host| SimulatedHost::new(&world, &catalog, host, chance.bits()));
        let hosts: Vec<SimulatedHost> = hosts.collect();
        let players = (0..PLAYERS).map(SimulatedPlayer::new).collect();
        Self { world, chance, catalog, hosts, players, let_in: Vec::new(), returns: 0 }
    }

    async fn play(&mut self) {
        sleep(Duration::from_millis(200)).await;
        let end = Instant::now() + Duration::from_millis(FAULTS);
        while Instant::now() < end {
            self.disturb();
            for player in 0..PLAYERS {
                self.act(player).await;
            }
            sleep(Duration::from_millis(self.chance.below(120) as u64)).await;
            self.heal(false);
        }
        self.heal(true);
        sleep(CALM).await;
        for player in 0..PLAYERS {
            self.arrive(player).await;
        }
        sleep(Duration::from_millis(500)).await;
        self.assert_nobody_is_displaced().await;
    }

    /// Breaks something now and then.
    fn disturb(&mut self) {
        if !self.chance.one_in(12) {
            return;
        }
        let host = self.chance.below(HOSTS);
        let is_last = self.hosts.iter().filter(|host| !host.is_killed).count() == 1;
        let kind = self.chance.below(12);
        self.world.set(host, |link| match kind {
            0..=2 => link.is_cut = true,
            3 | 4 => link.is_frozen = true,
            5 | 6 => link.has_no_database = true,
            7 | 8 => link.loses_one_in = Some(10),
            9 => link.delay = 80,
            10 => link.is_frozen |= !is_last,
            _ => {}
        });
        if kind == 11 && !is_last && !self.hosts[host].is_killed {
            self.drain(host);
        }
        self.hosts[host].is_killed |= kind >= 10 && !is_last;
        let time = self.chance.below(6_000) as u64;
        self.hosts[host].well_at = Instant::now() + Duration::from_millis(time);
    }

    /// Ends a host as its operator would.
    fn drain(&mut self, host: usize) {
        for player in self.players.iter_mut().filter(|player| player.host == host) {
            player.part();
        }
        let shared = self.hosts[host].shared.clone();
        tokio::spawn(async move { shared.end().await });
    }

    fn heal(&self, all: bool) {
        let now = Instant::now();
        for (index, host) in self.hosts.iter().enumerate() {
            if !host.is_killed && (all || host.well_at <= now) {
                self.world
                    .set(index, |link| *link = HostLinks { delay: 2, ..HostLinks::default() });
            }
        }
    }
}

impl SimulatedHost {
    fn new(world: &World, catalog: &Arc<Catalog>, index: usize, seed: u64) -> Self {
        let limits = RoomLimits {
            most: 8,
            most_watchers: 4,
            closes_after: Duration::from_secs(2),
            standing: Vec::new(),
        };
        let metrics = Arc::<Metrics>::default();
        let load = Arc::new(Load::simulated(Arc::clone(&metrics), Worker::default()));
        let recordings = Recordings::new(|_, _| None);
        let rooms = Rooms::new(
            limits,
            Arc::clone(catalog),
            recordings,
            Arc::clone(&load),
            Seeds { rooms: seed, codes: seed },
        );
        let (bus, leases) = (world.bus(index), world.leases(index));
        let (notice, visits) = (notice(index), world.visits(index));
        let cluster = Cluster { bus, leases, visits, notice, seed };
        let visitors = Visitors::default();
        let shared = cluster.rooms(rooms.clone(), vec![room_request()], load, visitors.clone());
        Self { rooms, shared, visitors, metrics, is_killed: false, well_at: Instant::now() }
    }
}

fn room_request() -> RoomRequest {
    RoomRequest { level: "hall".to_owned(), mode: Mode::Tag, difficulty: Difficulty::Normal }
}

/// Plays a seed. Returns how many checksums were compared, how many steps rooms took alone, and how many times
/// players returned.
fn play(seed: u64) -> [u64; 3] {
    let runtime = Builder::new_current_thread().enable_time().start_paused(true).build().unwrap();
    runtime.block_on(async {
        let mut run = ClusterRun::new(seed);
        run.play().await;
        run.assert_log();
        run.assert_members();
        let sum =
            |figure: fn(&Metrics) -> u64| run.hosts.iter().map(|it| figure(&it.metrics)).sum();
        let checks = sum(|metrics| metrics.checks(true).get());
        [checks, sum(|metrics| metrics.steps_alone.get()), run.returns]
    })
}

#[test]
fn hosts_agree_despite_any_fault() {
    let number = |name| env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let seeds = match number("SEED") {
        Some(seed) => seed..seed + 1,
        None => 0..number("CLUSTER_SEEDS").unwrap_or(SEEDS),
    };
    let mut figures = [0; 3];
    for seed in seeds {
        match catch_unwind(AssertUnwindSafe(|| play(seed))) {
            Ok(more) => figures = array::from_fn(|index| figures[index] + more[index]),
            Err(panic) => {
                eprintln!("SEED={seed} cargo test -p cellcaster-server --lib cluster::simulation");
                resume_unwind(panic);
            }
        }
    }
    // In a single run, it is possible that no two hosts share a room, no room goes on alone, or no host ends.
    let has_all = figures.iter().all(|figure| *figure > 0);
    assert!(has_all || number("SEED").is_some(), "checksums, steps alone and returns: {figures:?}");
}

#[test]
fn a_removed_standing_room_is_listed_until_it_is_empty() {
    let runtime = Builder::new_current_thread().enable_time().start_paused(true).build().unwrap();
    runtime.block_on(async {
        let run = ClusterRun::new(7);
        let listed = |host: usize| run.hosts[host].rooms.summaries().borrow().len();
        sleep(CONFIGURED).await;
        assert_eq!([0, 1, 2].map(listed), [1; 3]);
        let [one, other] = [0, 1].map(|host| &run.hosts[host]);
        let id = one.rooms.summaries().borrow()[0].id;
        let limits = RoomLimits { standing: Vec::new(), ..one.rooms.limits() };
        one.shared.set_limits(limits);
        sleep(CONFIGURED).await;
        // The other hosts still have it in their configurations.
        assert_eq!([0, 1, 2].map(listed), [0, 1, 1]);
        let entrant = Entrant { name: Line::of("ada", 16).unwrap(), key: None };
        let place = other.shared.enter(id, &entrant).await.unwrap();
        sleep(CONFIGURED).await;
        assert_eq!([0, 1, 2].map(listed), [1; 3]);
        drop(place);
        sleep(CONFIGURED).await;
        assert_eq!([0, 1, 2].map(listed), [0, 1, 1]);
    });
}
