//! The game over a simulated link: an sshd on this machine, a proxy that delays and limits, and a player at
//! the end of `ssh`. The tests assert frame rates and latencies.
//!
//! They need the programs of OpenSSH, so they have a separate feature.
#![cfg(all(unix, feature = "system-tests"))]

mod bystander;
#[path = "../../../../tests/support/emulator.rs"]
mod emulator;
mod host;
#[path = "../../../../tests/support/player.rs"]
mod player;
mod proxy;
mod server;

use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use cellcaster::terminal::Fidelity;

use self::emulator::{Emulator, Speaks};
use self::host::Host;
use self::player::Player;
use self::proxy::{Link, Proxy};
use self::server::Server;

const WINDOW: (u16, u16) = (120, 40);
const FRAME_END: &[u8] = b"\x1b[?2026l";
/// The escape sequences of keys: a start, the phase (1 for pressed, 3 for released), and an end.
const RIGHT: &str = "\x1b[1;1:";
const RIGHT_END: &str = "C";
const LETTER_END: &str = "u";

/// Plays a level without guards, in which walks can go anywhere.
const PLAY: &str = concat!("play ", env!("CARGO_MANIFEST_DIR"), "/../../tests/maps/citadel.toml");

/// The duration of a walk: about 200 frames and 20 keys on the slow links.
const WALK: Duration = Duration::from_secs(10);

/// A mobile link, as from a phone on a train.
const SLOW: Link = Link {
    delay: Duration::from_millis(50),
    jitter: Duration::ZERO,
    bytes_per_second: Some(1_000_000.0 / 8.0),
};
/// A link on which exact frames are slow even with compression.
const SLOWEST: Link = Link {
    delay: Duration::from_millis(75),
    jitter: Duration::ZERO,
    bytes_per_second: Some(256_000.0 / 8.0),
};
const UNLIMITED: Link =
    Link { delay: Duration::ZERO, jitter: Duration::ZERO, bytes_per_second: None };
/// A link with unlimited bandwidth and high jitter.
const JITTERY: Link = Link {
    delay: Duration::from_millis(20),
    jitter: Duration::from_millis(100),
    bytes_per_second: None,
};

/// The game as played by a guest, behind sshd or on a [`Host`].
struct Guest<S = Server> {
    player: Player,
    proxy: Proxy,
    server: S,
    /// Keeps the tests from running in parallel, because they measure times.
    _alone: MutexGuard<'static, ()>,
}

impl Guest {
    fn connect(link: Link, game: &str) -> Self {
        Self::connect_with(&[], link, game)
    }

    /// Like [`Guest::connect`], with more `options` for `ssh`.
    fn connect_with(options: &[&str], link: Link, game: &str) -> Self {
        Self::connect_in(WINDOW, options, link, game)
    }

    /// Like [`Guest::connect_with`], in a window of this size.
    fn connect_in(window: (u16, u16), options: &[&str], link: Link, game: &str) -> Self {
        let alone = alone();
        let server = Server::start(game);
        let proxy = Proxy::start(server.port(), link);
        let arguments = server.client_arguments(proxy.port());
        let player = ssh(window, options, arguments);
        player.wait_for("? help");
        player.wait_until("asked for releases", |emulator| emulator.modes().key_flags == [0, 1]);
        Self { player, proxy, server, _alone: alone }
    }
}

impl Guest<Host> {
    /// Connects to a host in the same way, and enters its only room.
    fn visit(window: (u16, u16), options: &[&str], link: Link) -> Self {
        let alone = alone();
        let server = Host::start();
        let proxy = Proxy::start(server.port(), link);
        let player = ssh(window, options, host::client_arguments(proxy.port()));
        for page in ["Enter saves it", "Open a room", "Go in"] {
            player.wait_for(page);
            player.send("\r");
        }
        player.wait_for("has joined.");
        Self { player, proxy, server, _alone: alone }
    }
}

fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn ssh(window: (u16, u16), options: &[&str], arguments: Vec<String>) -> Player {
    let options = options.iter().map(|option| (*option).to_owned());
    Player::start(window, Speaks::Kitty, "ssh", options.chain(arguments), &[])
}

impl<S> Guest<S> {
    fn hold_letter(&self, letter: char, held: bool) {
        self.key(&format!("\x1b[{};1:", u32::from(letter)), LETTER_END, held);
    }

    fn hold_right(&self, held: bool) {
        self.key(RIGHT, RIGHT_END, held);
    }

    fn key(&self, start: &str, end: &str, held: bool) {
        let phase = if held { 1 } else { 3 };
        self.player.send(format!("{start}{phase}{end}"));
    }

    fn frames(&self) -> usize {
        self.player.look(|emulator| {
            emulator.bytes().windows(FRAME_END.len()).filter(|bytes| *bytes == FRAME_END).count()
        })
    }

    /// Walks and turns for `time`, and switches between walking and running now and then.
    fn play(&self, time: Duration) -> Walk {
        self.hold_right(true);
        let (begun, before) = (Instant::now(), self.frames());
        let mut latencies = Vec::new();
        let mut fidelities = Vec::new();
        while begun.elapsed() < time {
            let round = latencies.len();
            self.hold_letter('w', round % 3 != 2);
            thread::sleep(Duration::from_millis(300));
            latencies.push(self.switch_gait());
            fidelities.extend(self.player.look(shown_fidelity));
        }
        let elapsed = begun.elapsed();
        let frames = self.frames() - before;
        self.hold_letter('w', false);
        self.hold_right(false);
        latencies.sort();
        Walk { frames_per_second: frames as f64 / elapsed.as_secs_f64(), latencies, fidelities }
    }

    /// The time from pressing R to a frame that shows the new gait.
    fn switch_gait(&self) -> Duration {
        let runs = |emulator: &Emulator| emulator.text().contains("running");
        let ran = self.player.look(runs);
        let pressed = Instant::now();
        self.hold_letter('r', true);
        self.player.wait_until("ran or walked", |emulator| runs(emulator) != ran);
        let latency = pressed.elapsed();
        self.hold_letter('r', false);
        latency
    }
}

/// The measurements of a walk.
#[derive(Debug)]
struct Walk {
    frames_per_second: f64,
    /// The times from a key to the first frame that reflects it, shortest first.
    latencies: Vec<Duration>,
    /// The fidelities shown in the status line.
    fidelities: Vec<String>,
}

impl Walk {
    /// The latency that a `share` of all keys does not exceed.
    fn latency(&self, share: f64) -> Duration {
        let place = (self.latencies.len() as f64 * share).ceil() as usize;
        self.latencies[place.saturating_sub(1)]
    }

    fn report(&self, link: &str) {
        eprintln!(
            "{link}: {:.1} frames a second; from a key to its frame {:?} in the median, {:?} at the \
             95th percentile of {}; fidelities {:?}",
            self.frames_per_second,
            self.latency(0.5),
            self.latency(0.95),
            self.latencies.len(),
            self.fidelities,
        );
    }
}

fn shown_fidelity(emulator: &Emulator) -> Option<String> {
    let text = emulator.text();
    let (_, after) = text.split_once("fidelity ")?;
    after.split_whitespace().next().map(str::to_owned)
}

#[test]
fn a_slow_link_keeps_its_frame_rate_and_latency() {
    let guest = Guest::connect(SLOW, &format!("{PLAY} --stats"));
    let walk = guest.play(WALK);
    walk.report("1 Mbit/s, 50 ms each way");
    assert!(walk.frames_per_second >= 15.0);
    assert!(walk.latency(0.5) <= Duration::from_millis(350));
    assert!(walk.latency(0.95) <= Duration::from_millis(600));
}

#[test]
fn every_frame_arrives_and_is_exact_on_a_fast_link() {
    let guest = Guest::connect(UNLIMITED, &format!("{PLAY} --stats"));
    let walk = guest.play(WALK);
    walk.report("no limit");
    assert!(walk.frames_per_second >= 28.0);
    assert!(!walk.fidelities.is_empty());
    assert!(walk.fidelities.iter().all(|fidelity| fidelity == "exact"));
}

#[test]
fn a_jittery_link_shows_nearly_exact_frames() {
    let guest = Guest::connect(JITTERY, &format!("{PLAY} --stats"));
    let walk = guest.play(WALK);
    walk.report("no limit, 20 ms and up to 100 ms of jitter each way");
    // On an idle machine they are exact. When jitter was mistaken for a slow link, most were at 48.
    let is_near = |fidelity: &&String| fidelity.parse::<Fidelity>().unwrap() <= Fidelity::HIGH;
    let near = walk.fidelities.iter().filter(is_near).count();
    assert!(near * 2 > walk.fidelities.len());
    assert!(walk.frames_per_second >= 12.0);
}

#[test]
fn compressed_frames_are_nearly_exact_on_a_slow_link() {
    let guest = Guest::connect_with(&["-C"], SLOW, &format!("{PLAY} --stats"));
    let walk = guest.play(WALK);
    walk.report("1 Mbit/s, 50 ms each way, with -C");
    // Without compression, hardly any are below 16.
    let is_fine = |fidelity: &&String| matches!(fidelity.as_str(), "exact" | "1" | "2" | "3" | "4");
    let fine = walk.fidelities.iter().filter(is_fine).count();
    assert!(fine * 4 > walk.fidelities.len() * 3);
}

/// With `ssh -C` and on slow links, the server must reach at least 90 % of the frame rate of sshd.
#[track_caller]
fn compares_with_sshd(window: (u16, u16), options: &[&str], link: Link) {
    let name = |server: &str| format!("{server}, {window:?}, {options:?}, {link:?}");
    let sshd = Guest::connect_in(window, options, link, &format!("{PLAY} --stats"));
    let behind_sshd = sshd.play(WALK);
    behind_sshd.report(&name("sshd"));
    drop(sshd);
    let host = Guest::visit(window, options, link);
    host.player.send("i");
    let on_host = host.play(WALK);
    on_host.report(&name("host"));
    assert!(on_host.frames_per_second >= 0.9 * behind_sshd.frames_per_second);
}

#[test]
fn the_server_matches_sshd_compressed_over_a_long_distance() {
    compares_with_sshd((80, 24), &["-C"], Link { delay: 2 * SLOWEST.delay, ..SLOWEST });
}

#[test]
fn the_server_matches_sshd_uncompressed_on_the_slowest_link() {
    compares_with_sshd((80, 24), &[], SLOWEST);
}

#[test]
fn the_server_matches_sshd_compressed_on_the_slowest_link() {
    compares_with_sshd((80, 24), &["-C"], SLOWEST);
}

#[test]
fn the_server_matches_sshd_compressed_in_a_large_window() {
    compares_with_sshd(WINDOW, &["-C"], SLOWEST);
}

/// sshd questions the client every 2 s, and gives up after the third question. A game that keeps sending
/// would keep it from asking.
#[test]
fn a_silently_dead_link_is_noticed() {
    const END: Duration = Duration::from_secs(20);
    let guest = Guest::connect(SLOW, PLAY);
    let game = guest.server.game();
    guest.hold_right(true);
    guest.player.wait_until("turned", |emulator| emulator.bytes().len() > 200_000);
    guest.proxy.die();
    let died = Instant::now();
    while is_alive(game) {
        assert!(died.elapsed() < END, "it lives on with a dead link");
        thread::sleep(Duration::from_millis(50));
    }
    eprintln!("ended {:?} after the link died", died.elapsed());
}

#[test]
fn cutting_the_link_in_mid_frame_leaves_no_process() {
    const END: Duration = Duration::from_secs(5);
    let guest = Guest::connect(SLOW, PLAY);
    let game = guest.server.game();
    assert!(is_alive(game));
    guest.hold_right(true);
    guest.player.wait_until("turned", |emulator| emulator.bytes().len() > 200_000);
    guest.proxy.cut_in_mid_frame();
    let cut = Instant::now();
    while is_alive(game) || guest.server.has_sessions() {
        assert!(cut.elapsed() < END, "it lives on without a link");
        thread::sleep(Duration::from_millis(10));
    }
    eprintln!("ended {:?} after the link was cut", cut.elapsed());
}

#[test]
fn no_terminal_replies_reach_the_shell() {
    let mut guest = Guest::connect(SLOW, PLAY);
    guest.hold_right(true);
    thread::sleep(Duration::from_secs(1));
    // Enter confirms the question.
    guest.hold_letter('q', true);
    guest.hold_letter('\r', true);
    let ending = guest.player.wait_for_end();
    ending.assert_given_back();
    guest.player.wait_for("the shell has read: \"\"");
    assert!(ending.status.success());
}

fn is_alive(process: u32) -> bool {
    Path::new(&format!("/proc/{process}")).exists()
}
