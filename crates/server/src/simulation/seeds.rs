//! A thousand simulated hosts with faulty clients and links, each reproducible by its seed.
//!
//! A steady member turns all the time. In every other run, the host has a slow worker and a bystander types a
//! name. The other clients send keys and noise, chat, paste, resize their windows, change rooms, reply late
//! or never, read slowly or not at all, lose their links, and reconnect. In some runs the server drains.
//! After each run:
//!
//! - the steady member has missed no frame;
//! - each of the bystander's keys was answered within a tenth of a second;
//! - a client that does not read was sent no more frames than those already in flight;
//! - each screen whose terminal replies shows the picture that its session would draw on an empty screen;
//! - replaying the recording of each room reproduces its state, bit for bit;
//! - fifteen seconds after the last cut, the members of the rooms are the visitors who are connected;
//! - other visitors have received only the printable characters of a visitor's input;
//! - no task is left over.
//!
//! A failed run prints its seed. `SEED=n cargo test -p cellcaster-server --lib simulation` repeats it: exactly if
//! the worker is not slow, and otherwise to within a few milliseconds.

mod faults;
mod findings;

use std::env;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::time::Duration;

use tokio::time::Instant;

use super::{Conditions, ENTER, HALL, Rig, RigOptions, SimulatedClient, Speaks, catalog};
use crate::load::Worker;
use crate::rooms::room::Mode;
use cellcaster::color::palette::ColorDepth;
use cellcaster::rng::SplitMix64;

/// The duration of the faults, in milliseconds.
const FAULTS: u64 = 3_000;
/// The number of clients at a time, including the steady one.
const CLIENTS: usize = 4;
/// Input that tries to send escape sequences to the terminals of other visitors.
const HOSTILE: &str = "\x1b]0;evil\x07\x1b[2J\u{9b}31m\u{202e}\u{301}";

/// The time between two of the bystander's keys.
const BETWEEN_KEYS: Duration = Duration::from_millis(150);

/// The index of the member whose frames are timed.
const STEADY: usize = 0;

/// A guest who types a letter of a name and deletes it, over and over.
struct Bystander {
    client: usize,
    /// The times at which keys were pressed.
    pressed: Vec<Instant>,
}

/// The state of a run.
struct SeedRun {
    rig: Rig,
    /// The bystander; present only if the worker is slow.
    bystander: Option<Bystander>,
    chance: SplitMix64,
    /// The number of tasks when no client is connected.
    tasks: usize,
    /// The connected clients.
    connected: Vec<usize>,
    /// The clients that are cut off, and the time at which their connections notice it.
    cut: Vec<(usize, Instant)>,
    /// The clients that do not read, and the number of frames that each had been sent before it stopped.
    silent: Vec<(usize, u64)>,
    /// The clients whose terminals no longer reply.
    mute: Vec<usize>,
    is_draining: bool,
}

impl SeedRun {
    fn new(seed: u64) -> Self {
        let mut chance = SplitMix64::new(seed);
        let mode = [Mode::Roam, Mode::Tag, Mode::Race, Mode::Together][chance.below(4)];
        let store_time = Duration::from_millis([0, 1, 40, 400][chance.below(4)]);
        let worker = if is_slow(seed) { Worker::SLOW } else { Worker::default() };
        let catalog = catalog(&hall());
        let mut rig =
            Rig::with(RigOptions { catalog, store_time, worker, seed, ..RigOptions::new(mode) });
        let tasks = rig.tasks();
        // With colours, no two frames of a brick wall are the same.
        let steady = rig.visitor_with("Mara", (24, 7), Speaks::Kitty, ColorDepth::True);
        for _ in 0..3 {
            rig.press(steady, ENTER);
            rig.pump(store_time.as_millis() as u64);
        }
        assert!(rig.member_id(steady).is_some(), "{}", rig.text(steady));
        let bystander = is_slow(seed).then(|| {
            let client = rig.visitor("Jon", (24, 7), Speaks::Kitty);
            rig.pump(store_time.as_millis() as u64);
            Bystander { client, pressed: Vec::new() }
        });
        let (cut, silent, mute) = (Vec::new(), Vec::new(), Vec::new());
        let (connected, is_draining) = (vec![steady], false);
        let mut run =
            Self { rig, bystander, chance, tasks, connected, cut, silent, mute, is_draining };
        (1..CLIENTS).for_each(|_| run.come());
        run
    }

    /// Connects a client. Most go on as far as the room.
    fn come(&mut self) {
        let Self { rig, chance, connected, .. } = self;
        let speaks =
            [Speaks::Kitty, Speaks::Kitty, Speaks::Plain, Speaks::Nothing][chance.below(4)];
        let name = format!("v{}", rig.clients.len());
        let depth = [ColorDepth::Mono, ColorDepth::True][chance.below(2)];
        let client = rig.arrive(&name, (24, 7), speaks, depth);
        connected.push(client);
        if chance.below(3) == 0 {
            rig.pump(50);
            rig.send(client, HOSTILE);
        }
        for _ in 0..chance.below(5) {
            rig.send(client, ENTER);
            rig.pump(chance.below(200) as u64);
        }
    }

    fn play(&mut self) {
        self.rig.send(STEADY, "\x1b[C\x1b[1;1:1C");
        let begun = self.rig.now();
        let end = begun + Duration::from_millis(FAULTS);
        while self.rig.now() < end {
            self.disturb();
            self.press_key();
            self.rig.pump(self.chance.below(40) as u64);
            self.notice();
        }
        self.assert_steady(begun + Duration::from_millis(200), end);
        self.assert_answered();
        self.rig.send(STEADY, "\x1b[1;1:3C");
        self.assert_replays();
    }

    /// Lets the bystander press the next key if it is due.
    fn press_key(&mut self) {
        let Self { rig, bystander: Some(bystander), .. } = self else { return };
        let now = rig.now();
        if bystander.pressed.last().is_none_or(|last| now - *last >= BETWEEN_KEYS) {
            let key = ["a", "\x7f"][bystander.pressed.len() % 2];
            rig.send(bystander.client, key);
            bystander.pressed.push(now);
        }
    }

    /// Repairs all links and stops all input.
    fn calm_down(&mut self) {
        self.connected.clone().into_iter().for_each(|client| self.wake(client));
        let good = Conditions { reads: true, answers: true, latency: Duration::ZERO, rate: None };
        for &client in &self.connected {
            let answers = !self.mute.contains(&client);
            self.rig.clients[client].set(|link| *link = Conditions { answers, ..good });
        }
        while !self.cut.is_empty() {
            self.rig.pump(500);
            self.notice();
        }
        // Wait long enough for keys to be released: some terminals report no releases, and a short pause
        // counts as a held key.
        self.rig.pump(3_000);
        let is_over = |client: &usize| self.rig.is_over(*client);
        assert!(self.is_draining || !is_over(&STEADY));
        self.connected.retain(|client| !self.rig.is_over(*client));
    }
}

/// Returns true if the host has a slow worker in the run with this seed.
fn is_slow(seed: u64) -> bool {
    seed % 2 == 1
}

/// The hall with brick walls.
fn hall() -> String {
    HALL.replace("#808080", "brick")
}

/// Plays a seed; returns the bytes that each client has received.
fn play(seed: u64) -> Vec<Vec<u8>> {
    let mut run = SeedRun::new(seed);
    run.play();
    run.calm_down();
    run.assert_members();
    run.assert_screens();
    run.assert_replays();
    run.assert_harmless();
    let received = |client: &SimulatedClient| client.look(|emulator| emulator.bytes().to_vec());
    let all = run.rig.clients.iter().map(received).collect();
    run.assert_no_task_left();
    all
}

/// Plays these seeds, or only the one in the environment variable `SEED`.
fn play_all(seeds: std::ops::Range<u64>) {
    let named: Option<u64> = env::var("SEED").ok().and_then(|seed| seed.parse().ok());
    let seeds = named.map_or(seeds, |seed| seed..seed + 1);
    for seed in seeds {
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| play(seed))) {
            eprintln!("SEED={seed} cargo test -p cellcaster-server --lib simulation");
            resume_unwind(panic);
        }
    }
}

#[test]
fn hosts_survive_seeds_from_0() {
    play_all(0..250);
}

#[test]
fn hosts_survive_seeds_from_250() {
    play_all(250..500);
}

#[test]
fn hosts_survive_seeds_from_500() {
    play_all(500..750);
}

#[test]
fn hosts_survive_seeds_from_750() {
    play_all(750..1_000);
}

#[test]
fn a_seed_reproduces_its_run() {
    for seed in (0..16).filter(|&seed| !is_slow(seed)) {
        assert!(play(seed) == play(seed), "seed {seed}");
    }
}
