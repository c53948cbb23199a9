//! A thousand hosts whose clients and links have faults, each repeatable by its seed.
//!
//! A steady member turns all the time. The others send keys and noise, talk, paste, change their
//! windows and rooms, answer late or not at all, read slowly or not at all, are cut off, and come again;
//! in some runs the server drains. After each run:
//!
//! - the steady member has missed no picture;
//! - who does not read was sent at most the frame that waits;
//! - each screen whose terminal answers shows what its session draws on an empty one;
//! - the recording of each room gives its state again, bit for bit;
//! - the members of rooms are those who are connected, fifteen seconds after the last cut;
//! - nothing but printable characters of what one typed has reached another;
//! - no task is left.
//!
//! A failed run prints its seed; `SEED=n cargo test --features serve --lib simulation` repeats it.

use std::env;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::time::Duration;

use tokio::time::Instant;

use super::replay::{assert_same, replayed};
use super::{Conditions, ENTER, HALL, ROOM, Rig, Speaks, Wish, catalog};
use crate::color::palette::ColorDepth;
use crate::rng::SplitMix64;
use crate::server::room::Mode;
use crate::server::simulation::emulator::Emulator;
use crate::server::simulation::looks::looks;

/// The time with faults, in milliseconds.
const FAULTS: u64 = 3_000;
/// The longest time between two pictures of the steady member: three frames of thirty a second.
const LONGEST_PAUSE: Duration = Duration::from_millis(100);
/// The time after which a connection notices that its client is gone, as the configuration has it.
const SILENCE: u64 = 12_000;
/// The most frames that are sent to a client after it has stopped reading: one that it had begun to
/// take, and one that waits.
const MOST_HELD: u64 = 2;
/// The clients at a time, with the steady one.
const CLIENTS: usize = 4;
/// What somebody types to have it obeyed by the terminals of others.
const HOSTILE: &str = "\x1b]0;evil\x07\x1b[2J\u{9b}31m\u{202e}\u{301}";

const KEYS: [&str; 20] = [
    "\x1b[119;1:1u",
    "\x1b[119;1:3u",
    "\x1b[100;1:1u",
    "\x1b[100;1:3u",
    "\x1b[A",
    "\x1b[B",
    "\x1b[13u",
    "\x1b[13u",
    "\r",
    "\x1b[9u",
    "\x1b[27u",
    "\x1b[47u",
    "\x1b[104:72;2u",
    "\x1b[109u",
    "\x1b[63u",
    "\x1b[59u",
    "q",
    "2",
    "3",
    "w",
];

/// The member whose pictures are counted.
const STEADY: usize = 0;

/// A run.
struct Run {
    rig: Rig,
    chance: SplitMix64,
    /// The tasks without clients.
    tasks: usize,
    /// The clients that are connected.
    connected: Vec<usize>,
    /// Those that are cut off, and when their connection notices it.
    cut: Vec<(usize, Instant)>,
    /// The clients that do not read, and the frames that they had been sent before.
    silent: Vec<(usize, u64)>,
    /// The clients whose terminals answer nothing any more.
    mute: Vec<usize>,
    is_draining: bool,
}

impl Run {
    fn new(seed: u64) -> Self {
        let mut chance = SplitMix64::new(seed);
        let mode = [Mode::Roam, Mode::Tag, Mode::Race, Mode::Together][chance.below(4)];
        let store_time = Duration::from_millis([0, 1, 40, 400][chance.below(4)]);
        let mut rig = Rig::with(Wish { mode, map: &hall(), store_time, seed });
        let tasks = rig.tasks();
        // With colours, no two pictures of a wall of bricks are the same.
        let steady = rig.visitor_with("Mara", (24, 7), Speaks::Kitty, ColorDepth::True);
        for _ in 0..3 {
            rig.press(steady, ENTER);
            rig.pump(store_time.as_millis() as u64);
        }
        assert!(rig.member_id(steady).is_some(), "{}", rig.text(steady));
        let (cut, silent, mute) = (Vec::new(), Vec::new(), Vec::new());
        let (connected, is_draining) = (vec![steady], false);
        let mut run = Self { rig, chance, tasks, connected, cut, silent, mute, is_draining };
        (1..CLIENTS).for_each(|_| run.come());
        run
    }

    /// Somebody comes, most of them as far as the room.
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

    /// Something happens to a client that is not the steady one.
    fn disturb(&mut self) {
        let others = &self.connected[1..];
        if others.is_empty() {
            return if self.is_draining { () } else { self.come() };
        }
        let client = others[self.chance.below(others.len())];
        match self.chance.below(24) {
            0 => {
                let [columns, rows] = [60, 20].map(|most| self.chance.below(most) as u16);
                self.rig.clients[client].resize(columns, rows);
            }
            1 => {
                let length = self.chance.below(30);
                let noise: Vec<u8> = (0..length).map(|_| self.chance.below(256) as u8).collect();
                self.rig.send(client, noise);
            }
            2 => {
                let latency = Duration::from_millis(self.chance.below(400) as u64);
                self.rig.clients[client].set(|link| link.latency = latency);
            }
            3 => {
                let rate = [None, Some(2_000), Some(20_000)][self.chance.below(3)];
                self.rig.clients[client].set(|link| link.rate = rate);
            }
            4 => self.stall(client),
            5 => self.wake(client),
            6 => self.mute(client),
            8 => self.cut(client),
            9 => self.leave(client),
            10 if self.connected.len() < 2 * CLIENTS && !self.is_draining => self.come(),
            11 => self.rig.send(client, "/wave ".repeat(self.chance.below(4_000))),
            12 | 13 => self.rig.send(client, format!("/{HOSTILE}hi{HOSTILE}\r")),
            14 => _ = self.rig.visitors.say(&format!("{HOSTILE}all is well")),
            15 if self.chance.below(40) == 0 => self.drain(),
            _ => self.rig.send(client, KEYS[self.chance.below(KEYS.len())]),
        }
    }

    /// The terminal of the client answers nothing any more. It gets no frame after the one that it has
    /// not answered.
    fn mute(&mut self, client: usize) {
        self.rig.clients[client].set(|link| link.answers = false);
        self.mute.push(client);
    }

    /// The client takes nothing any more.
    fn stall(&mut self, client: usize) {
        let Self { rig, silent, .. } = self;
        if silent.iter().all(|(other, _)| *other != client) {
            let client_of = &rig.clients[client];
            client_of.set(|link| link.reads = false);
            silent.push((client, client_of.frames()));
        }
    }

    fn wake(&mut self, client: usize) {
        let Self { rig, silent, .. } = self;
        if let Some(index) = silent.iter().position(|(other, _)| *other == client) {
            let (_, before) = silent.swap_remove(index);
            let held = rig.clients[client].frames() - before;
            assert!(held <= MOST_HELD, "{held} frames");
            rig.clients[client].set(|link| link.reads = true);
        }
    }

    /// The link of a client is cut without a word. Its connection notices that later.
    fn cut(&mut self, client: usize) {
        self.stall(client);
        self.rig.clients[client].set(|link| link.answers = false);
        self.connected.retain(|other| *other != client);
        let notices =
            self.rig.now() + Duration::from_millis(self.chance.below(SILENCE as usize) as u64);
        self.cut.push((client, notices));
    }

    /// The client closes its connection.
    fn leave(&mut self, client: usize) {
        self.connected.retain(|other| *other != client);
        self.silent.retain(|(other, _)| *other != client);
        self.rig.clients[client].cut();
    }

    fn drain(&mut self) {
        self.is_draining = true;
        self.connected.iter().for_each(|&client| self.rig.clients[client].drain());
    }

    /// The connections whose clients are gone for long enough notice it.
    fn notice(&mut self) {
        let now = self.rig.now();
        let due: Vec<usize> = self
            .cut
            .extract_if(.., |(_, notices)| *notices <= now)
            .map(|(client, _)| client)
            .collect();
        due.into_iter().for_each(|client| self.leave(client));
    }

    fn play(&mut self) {
        self.rig.send(STEADY, "\x1b[C\x1b[1;1:1C");
        let begun = self.rig.now();
        let end = begun + Duration::from_millis(FAULTS);
        while self.rig.now() < end {
            self.disturb();
            self.rig.pump(self.chance.below(40) as u64);
            self.notice();
        }
        self.assert_steady(begun + Duration::from_millis(200), end);
        self.rig.send(STEADY, "\x1b[1;1:3C");
        self.assert_replays();
    }

    /// Nothing has delayed the pictures of the steady member.
    fn assert_steady(&self, begun: Instant, end: Instant) {
        let arrivals = self.rig.clients[STEADY].arrivals();
        let times: Vec<Instant> =
            arrivals.into_iter().filter(|time| (begun..end).contains(time)).chain([end]).collect();
        let pauses = times.windows(2).map(|pair| pair[1] - pair[0]);
        let longest = pauses.chain([times[0] - begun]).max();
        assert!(longest <= Some(LONGEST_PAUSE), "{longest:?} without a picture");
    }

    /// The recordings of all rooms that are open give their states again.
    fn assert_replays(&self) {
        let levels = Arc::new(catalog(&hall()));
        for room in self.rig.tapes.rooms() {
            let text = self.rig.tapes.text(room);
            assert!(!text.contains(|it: char| it != '\n' && it.is_control()), "{text:?}");
            if let Some(view) = self.rig.rooms().view(room) {
                assert_same(&view, &replayed(&text, &levels, view.step));
            }
        }
    }

    /// All links are good again, and nobody touches a key.
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
        // Pauses are taken for keys that are held by a terminal without releases.
        self.rig.pump(3_000);
        let is_over = |client: &usize| self.rig.is_over(*client);
        assert!(self.is_draining || !is_over(&STEADY));
        self.connected.retain(|client| !self.rig.is_over(*client));
    }

    /// The members of rooms are those who are connected and think so.
    fn assert_members(&self) {
        let rooms = self.rig.rooms().summaries().borrow().clone();
        let mut members: Vec<String> =
            rooms.iter().flat_map(|room| room.members.iter().map(ToString::to_string)).collect();
        let name = |&client: &usize| {
            self.rig.session(client, |session, room| {
                let member = session.member()?;
                Some(room?.member(member)?.name.to_string())
            })
        };
        let mut connected: Vec<String> = self.connected.iter().filter_map(name).collect();
        members.sort();
        connected.sort();
        assert_eq!(members, connected);
    }

    /// Each screen shows what its session draws on an empty one.
    fn assert_screens(&mut self) {
        let answering = self.connected.iter().filter(|client| !self.mute.contains(client));
        for client in answering.copied().collect::<Vec<_>>() {
            // While a picture counts seconds down, a new one may be on its way.
            let is_settled = (0..50).any(|_| {
                self.rig.pump(30);
                self.is_settled(client)
            });
            let text = self.rig.text(client);
            let wait = self.rig.session(client, |session, room| session.wait(room));
            assert!(is_settled, "client {client} never shows all ({wait}):\n{text}");
            let (size, shown) = self.rig.clients[client].look(|it| (size(it), looks(it.screen())));
            let bytes = self.rig.session(client, |session, room| session.whole_picture(room));
            let mut empty = Emulator::new(size.0, size.1, Speaks::Nothing);
            empty.process(&bytes);
            let is_same = shown == looks(empty.screen());
            assert!(is_same, "client {client}:\n{text}\nis not\n{}", empty.text());
        }
    }

    fn is_settled(&self, client: usize) -> bool {
        self.rig.session(client, |session, room| session.is_settled(room))
    }

    /// Nothing that somebody typed has reached a terminal but printable characters.
    fn assert_harmless(&self) {
        for client in &self.rig.clients {
            let (title, is_obeyed) = client.look(|emulator| {
                let mut sequences = emulator.bytes().windows(4);
                (emulator.title().to_owned(), sequences.any(|bytes| bytes == b"\x1b]0;"))
            });
            assert!(title.is_empty() && !is_obeyed, "{title:?}");
        }
    }

    /// All leave, and no task is left but those of the host.
    fn assert_no_task_left(mut self) {
        for client in std::mem::take(&mut self.connected) {
            self.leave(client);
        }
        self.rig.pump(100);
        assert_eq!(self.rig.view().members.len(), 0);
        // Rooms that others have opened are closed after a minute.
        self.rig.pump(61_000);
        self.rig.clients.clear();
        self.rig.pump(100);
        assert_eq!(self.rig.tasks(), self.tasks);
        assert_eq!(self.rig.visitors.list().len(), 0);
        assert!(self.rig.rooms().view(ROOM).is_some());
    }
}

/// The hall, with walls of bricks.
fn hall() -> String {
    HALL.replace("#808080", "brick")
}

/// The columns and rows of a screen.
fn size(emulator: &Emulator) -> (u16, u16) {
    let (rows, columns) = emulator.screen().size();
    (columns.get(), rows.get())
}

fn play(seed: u64) {
    let mut run = Run::new(seed);
    run.play();
    run.calm_down();
    run.assert_members();
    run.assert_screens();
    run.assert_replays();
    run.assert_harmless();
    run.assert_no_task_left();
}

/// Plays some of a thousand seeds, or the one that the environment names.
fn play_all(seeds: std::ops::Range<u64>) {
    let named: Option<u64> = env::var("SEED").ok().and_then(|seed| seed.parse().ok());
    let seeds = named.map_or(seeds, |seed| seed..seed + 1);
    for seed in seeds {
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| play(seed))) {
            eprintln!("SEED={seed} cargo test --features serve --lib simulation");
            resume_unwind(panic);
        }
    }
}

#[test]
fn seeds_from_0() {
    play_all(0..250);
}

#[test]
fn seeds_from_250() {
    play_all(250..500);
}

#[test]
fn seeds_from_500() {
    play_all(500..750);
}

#[test]
fn seeds_from_750() {
    play_all(750..1_000);
}
