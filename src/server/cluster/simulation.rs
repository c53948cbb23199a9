//! Three hosts with players, a bus and a database in simulated time, whose links have faults.
//!
//! Players enter rooms, walk, talk and leave. Hosts are cut off from the bus or the database, stand still,
//! or are killed; answers and what is said are delayed and lost. After each run, everything that was broken and not
//! killed is well again for a while. Then:
//!
//! - no epoch has had two sequencers, and none follows a later one in the log;
//! - what each host shows is what the log gives that is played from its beginning, bit for bit;
//! - no checksum has differed on any host;
//! - each player who was let in is in the log, once, under a number of their own;
//! - the members of rooms are those who are there, and each room with members goes on.
//!
//! A failed run prints its seed; `SEED=n cargo test --features cluster-tests --lib cluster::simulation`
//! repeats it. `CLUSTER_SEEDS=1000` plays a thousand seeds instead of some.

mod bus;
mod findings;
mod world;

use std::array;
use std::env;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::time::Duration;

use tokio::runtime::Builder;
use tokio::task::JoinHandle;
use tokio::time::{Instant, sleep};

use self::world::{Link, World};
use super::{Cluster, SharedRooms};
use crate::game::{Intent, Intents};
use crate::rng::SplitMix64;
use crate::server::line::Line;
use crate::server::load::Load;
use crate::server::room::{Catalog, Command, MemberId, Mode, Queue};
use crate::server::rooms::{Logs, Place, RoomLimits, RoomRefusal, Rooms};
use crate::server::simulation::{HALL, catalog};
use crate::server::summary::{RoomId, RoomWish};
use crate::server::{Metrics, Visitors};
use crate::world::Difficulty;

const HOSTS: usize = 3;
const PLAYERS: usize = 5;
/// The time with faults, in milliseconds.
const FAULTS: u64 = 12_000;
/// The time without, after which nothing of them is left.
const CALM: Duration = Duration::from_secs(25);
/// The seeds of a usual run.
const SEEDS: u64 = 60;

/// A run.
struct Run {
    world: World,
    chance: SplitMix64,
    catalog: Arc<Catalog>,
    hosts: Vec<Host>,
    players: Vec<Player>,
    /// All who were ever let in.
    let_in: Vec<(RoomId, MemberId)>,
}

struct Host {
    rooms: Rooms,
    shared: SharedRooms,
    metrics: Arc<Metrics>,
    is_killed: bool,
    /// When its faults are over.
    well_at: Instant,
}

struct Player {
    host: usize,
    place: Option<Place>,
    entering: Option<JoinHandle<Result<Place, RoomRefusal>>>,
}

impl Run {
    fn new(seed: u64) -> Self {
        let mut chance = SplitMix64::new(seed);
        let world = World::new(chance.bits(), HOSTS);
        let catalog = Arc::new(catalog(HALL));
        let hosts = (0..HOSTS).map(|host| Host::new(&world, &catalog, host, chance.bits()));
        let hosts: Vec<Host> = hosts.collect();
        let player = |_| Player { host: 0, place: None, entering: None };
        let players = (0..PLAYERS).map(player).collect();
        Self { world, chance, catalog, hosts, players, let_in: Vec::new() }
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
    }

    /// Now and then, something breaks.
    fn disturb(&mut self) {
        if !self.chance.one_in(12) {
            return;
        }
        let host = self.chance.below(HOSTS);
        let is_last = self.hosts.iter().filter(|host| !host.is_killed).count() == 1;
        let kind = self.chance.below(11);
        self.world.set(host, |link| match kind {
            0..=2 => link.is_cut = true,
            3 | 4 => link.is_frozen = true,
            5 | 6 => link.has_no_database = true,
            7 | 8 => link.loses_one_in = Some(10),
            9 => link.delay = 80,
            _ => link.is_frozen |= !is_last,
        });
        self.hosts[host].is_killed |= kind == 10 && !is_last;
        let time = self.chance.below(6_000) as u64;
        self.hosts[host].well_at = Instant::now() + Duration::from_millis(time);
    }

    fn heal(&self, all: bool) {
        let now = Instant::now();
        for (index, host) in self.hosts.iter().enumerate() {
            if !host.is_killed && (all || host.well_at <= now) {
                self.world.set(index, |link| *link = Link { delay: 2, ..Link::default() });
            }
        }
    }

    /// A player does something.
    async fn act(&mut self, index: usize) {
        self.arrive(index).await;
        let Self { chance, hosts, players, .. } = self;
        let player = &mut players[index];
        if hosts[player.host].is_killed {
            // They find another host. Their place is gone with the old one, which says nothing more.
            std::mem::forget(player.place.take());
            player.entering = None;
            player.host = chance.below(HOSTS);
            return;
        }
        match &player.place {
            None if player.entering.is_none() => {
                player.host = chance.below(HOSTS);
                let name = Line::of(&format!("p{index}"), 16).expect("a name");
                let (shared, is_own) = (hosts[player.host].shared.clone(), chance.one_in(6));
                let room = hosts[player.host].rooms.summaries().borrow().first().map(|it| it.id);
                player.entering = Some(tokio::spawn(async move {
                    match room.filter(|_| !is_own) {
                        Some(room) => shared.enter(room, &name).await,
                        None => shared.open(&wish(), &name).await,
                    }
                }));
            }
            Some(_) if chance.one_in(60) => player.place = None,
            Some(place) => {
                let command = match chance.below(12) {
                    0 => Command::Say(Line::of("hello", 60).expect("a line")),
                    1 => Command::Again,
                    it => {
                        let intent = [Intent::Forward, Intent::TurnLeft, Intent::TurnRight][it % 3];
                        let intents: Intents = [intent].into_iter().collect();
                        Command::Intents { seen: 0, intents }
                    }
                };
                // What comes too often is refused.
                _ = place.act(command);
            }
            None => {}
        }
    }

    /// Notes if a player was let in.
    async fn arrive(&mut self, index: usize) {
        let player = &mut self.players[index];
        let Some(entering) = player.entering.take_if(|it| it.is_finished()) else { return };
        if self.hosts[player.host].is_killed {
            // Nobody hears it.
            if let Ok(Ok(place)) = entering.await {
                std::mem::forget(place);
            }
            return;
        }
        if let Ok(place) = entering.await.expect("no panic") {
            let member = place.member_id().expect("a member");
            self.let_in.push((place.room(), member));
            player.place = Some(place);
        }
    }
}

impl Host {
    fn new(world: &World, catalog: &Arc<Catalog>, index: usize, seed: u64) -> Self {
        let limits = RoomLimits {
            most: 8,
            most_watchers: 4,
            closes_after: Duration::from_secs(2),
            standing: Vec::new(),
        };
        let metrics = Arc::<Metrics>::default();
        let load = Arc::new(Load::simulated(Arc::clone(&metrics)));
        let logs = Logs::new(|_| Box::<Queue>::default());
        let rooms = Rooms::new(limits, Arc::clone(catalog), logs, Arc::clone(&load), seed);
        let cluster = Cluster { bus: world.bus(index), leases: world.lease_worker(index), seed };
        let shared = cluster.rooms(&rooms, vec![wish()], load, Visitors::default());
        Self { rooms, shared, metrics, is_killed: false, well_at: Instant::now() }
    }
}

fn wish() -> RoomWish {
    RoomWish { level: "hall".to_owned(), mode: Mode::Tag, difficulty: Difficulty::Normal }
}

/// Plays a seed; returns how many checksums were compared, and how many steps rooms have taken alone.
fn play(seed: u64) -> [u64; 2] {
    let runtime = Builder::new_current_thread().enable_time().start_paused(true).build().unwrap();
    runtime.block_on(async {
        let mut run = Run::new(seed);
        run.play().await;
        run.assert_log();
        run.assert_members();
        let sum =
            |figure: fn(&Metrics) -> u64| run.hosts.iter().map(|it| figure(&it.metrics)).sum();
        [sum(|metrics| metrics.checks_equal.get()), sum(|metrics| metrics.steps_alone.get())]
    })
}

#[test]
fn hosts_agree_whatever_breaks() {
    let number = |name| env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let seeds = match number("SEED") {
        Some(seed) => seed..seed + 1,
        None => 0..number("CLUSTER_SEEDS").unwrap_or(SEEDS),
    };
    let mut figures = [0; 2];
    for seed in seeds {
        match catch_unwind(AssertUnwindSafe(|| play(seed))) {
            Ok(more) => figures = array::from_fn(|index| figures[index] + more[index]),
            Err(panic) => {
                eprintln!(
                    "SEED={seed} cargo test --features cluster-tests --lib cluster::simulation"
                );
                resume_unwind(panic);
            }
        }
    }
    // In some runs, no two hosts are in a room together, or no room goes on alone.
    let has_all = figures.iter().all(|figure| *figure > 0);
    assert!(has_all || number("SEED").is_some(), "checksums and steps alone: {figures:?}");
}
