//! A simulated link, the players who share it and their terminals. It has no clock, and its random
//! numbers are seeded, so every run has the same result on every machine.
//!
//! The link carries packets one after another, at a rate that a scenario may change. Each direction
//! has a delay, and jitter that is drawn for each packet. As in TCP, no packet overtakes another.

use std::collections::VecDeque;

use super::super::*;
use crate::rng::SplitMix64;

const TICK: Duration = Duration::from_millis(1);
const FRAME_TIME: Duration = Duration::from_millis(33);
/// The maximum size of a packet, in bytes.
const PACKET: f64 = 1400.0;
/// A rate that no player exhausts, in bytes per second.
pub(crate) const UNLIMITED: f64 = 1e9;

/// The properties of a link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Conditions {
    /// The delay in each direction.
    pub(crate) delay: Duration,
    /// The maximum additional delay of a packet.
    pub(crate) jitter: Duration,
    /// The rate towards the players, in bytes per second.
    pub(crate) rate: f64,
}

/// A link with players at its end.
pub(crate) struct Simulation {
    pub(crate) now: Duration,
    pub(crate) conditions: Conditions,
    pub(crate) players: Vec<Player>,
    /// Packets that wait for the link: the player's number, the bytes, and the frame that ends with
    /// the packet.
    queue: VecDeque<(usize, f64, Option<usize>)>,
    /// The number of bytes of the queue's first packet that the link has already carried.
    carried: f64,
    random: SplitMix64,
}

impl Simulation {
    /// One player for each of `frames`.
    pub(crate) fn new(conditions: Conditions, frames: &[Frames]) -> Self {
        let players = frames.iter().map(|frames| Player::new(Box::new(*frames))).collect();
        Self::of_players(conditions, players)
    }

    /// One player with frames from `source`.
    pub(crate) fn of_source(conditions: Conditions, source: impl FrameSource + 'static) -> Self {
        Self::of_players(conditions, vec![Player::new(Box::new(source))])
    }

    fn of_players(conditions: Conditions, players: Vec<Player>) -> Self {
        let mut simulation = Self {
            now: Duration::ZERO,
            conditions,
            players,
            queue: VecDeque::new(),
            carried: 0.0,
            random: SplitMix64::new(7),
        };
        for player in 0..simulation.players.len() {
            simulation.send(player, 0.0, Fidelity::EXACT);
        }
        simulation
    }

    pub(crate) fn of_one(delay: Duration, rate: f64, frames: Frames) -> Self {
        Self::new(Conditions { delay, jitter: Duration::ZERO, rate }, &[frames])
    }

    /// Simulates this duration. All players move.
    pub(crate) fn walk(&mut self, time: Duration) {
        let until = self.now + time;
        while self.now < until {
            self.carry();
            for player in 0..self.players.len() {
                self.play(player);
            }
            self.now += TICK;
        }
    }

    /// The number of bytes that wait for the link.
    pub(crate) fn queued(&self) -> f64 {
        self.queue.iter().map(|packet| packet.1).sum::<f64>() - self.carried
    }

    fn play(&mut self, number: usize) {
        let now = self.now;
        let player = &mut self.players[number];
        while let Some(&(_, upward)) = player.upward.front().filter(|up| up.0 <= now) {
            player.upward.pop_front();
            player.receive(now, upward);
        }
        self.press_keys(number);
        if self.players[number].flow.probe_is_due(now) {
            self.put(number, 0.0, Fidelity::EXACT, Request::Fence);
        }
        let player = &mut self.players[number];
        if now >= player.due.max(player.flow.budget_opens_at()) && player.flow.may_send(now) {
            let fidelity = player.flow.quality().0;
            let bytes = player.frames.bytes(now, fidelity, self.random.unit());
            self.send(number, bytes, fidelity);
            let player = &mut self.players[number];
            player.flow.sent_motion(bytes as usize, (fidelity, Effort::Search));
            let on_wire = bytes * player.frames.carried(fidelity);
            player.flow.carried(bytes as usize, on_wire as usize);
            player.due = now + FRAME_TIME.max(player.flow.frame_time());
        }
    }

    fn press_keys(&mut self, number: usize) {
        if self.now >= self.players[number].next_key {
            let pause = Duration::from_millis(300 + (self.random.unit() * 200.0) as u64);
            self.players[number].next_key = self.now + pause;
            self.send_upward(number, self.now, Upward::Key(self.now));
        }
    }

    /// Sends a frame of this number of bytes, and a request after it.
    fn send(&mut self, number: usize, bytes: f64, fidelity: Fidelity) {
        let request = self.players[number].flow.request(self.now, bytes as usize);
        self.put(number, bytes, fidelity, request);
    }

    fn put(&mut self, number: usize, bytes: f64, fidelity: Fidelity, request: Request) {
        let player = &mut self.players[number];
        player.flow.sent(self.now, bytes as usize, request);
        let frame = player.shown.len();
        let keys = if bytes > 0.0 { std::mem::take(&mut player.pressed) } else { Vec::new() };
        let (sent_at, at, bytes) = (self.now, None, bytes as usize);
        player.shown.push(Shown { sent_at, at, fidelity, bytes, keys, request });
        let mut rest = bytes as f64 * player.frames.carried(fidelity);
        while rest > PACKET {
            self.queue.push_back((number, PACKET, None));
            rest -= PACKET;
        }
        self.queue.push_back((number, rest, Some(frame)));
    }

    /// Carries the bytes of one tick.
    fn carry(&mut self) {
        self.carried += self.conditions.rate * TICK.as_secs_f64();
        while let Some(&(number, bytes, frame)) =
            self.queue.front().filter(|packet| packet.1 <= self.carried)
        {
            self.queue.pop_front();
            self.carried -= bytes;
            let arrives_at = self.arrival(number, 1, self.now);
            if let Some(frame) = frame {
                self.show(number, frame, arrives_at);
            }
        }
        if self.queue.is_empty() {
            self.carried = 0.0;
        }
    }

    fn show(&mut self, number: usize, frame: usize, at: Duration) {
        let player = &mut self.players[number];
        let shown = &mut player.shown[frame];
        shown.at = Some(at);
        for &pressed_at in &shown.keys {
            player.latencies.push(Latency { pressed_at, taken: at.saturating_sub(pressed_at) });
        }
        let request = shown.request;
        self.send_upward(number, at, Upward::Answer(request));
    }

    fn send_upward(&mut self, number: usize, at: Duration, upward: Upward) {
        let arrives_at = self.arrival(number, 0, at);
        self.players[number].upward.push_back((arrives_at, upward));
    }

    /// The arrival time of a packet that is sent at `at`. It is never before the arrival of an
    /// earlier packet in the same direction.
    fn arrival(&mut self, number: usize, direction: usize, at: Duration) -> Duration {
        let Conditions { delay, jitter, .. } = self.conditions;
        let last = &mut self.players[number].last[direction];
        *last = (at + delay + jitter.mul_f64(self.random.unit())).max(*last);
        *last
    }
}

/// A player in motion, and the flow control of the game.
pub(crate) struct Player {
    pub(crate) flow: Flow,
    pub(crate) shown: Vec<Shown>,
    /// The times from a key press to the first frame that reflects it, in order of the presses.
    pub(crate) latencies: Vec<Latency>,
    pub(crate) frames: Box<dyn FrameSource>,
    pub(crate) due: Duration,
    pub(crate) next_key: Duration,
    /// Answers and keys on their way to the game, with their arrival times.
    pub(crate) upward: VecDeque<(Duration, Upward)>,
    /// The arrival times of the latest packets, upward and downward.
    pub(crate) last: [Duration; 2],
    /// The keys that the next frame reflects, by the times of their presses.
    pub(crate) pressed: Vec<Duration>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Upward {
    Answer(Request),
    Key(Duration),
}

/// A key press, and the time until a frame showed it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Latency {
    pub(crate) pressed_at: Duration,
    pub(crate) taken: Duration,
}

/// A sent frame.
#[derive(Clone, Debug)]
pub(crate) struct Shown {
    pub(crate) sent_at: Duration,
    /// The time at which it is on the screen. `None` if it has not arrived.
    pub(crate) at: Option<Duration>,
    pub(crate) fidelity: Fidelity,
    pub(crate) bytes: usize,
    pub(crate) keys: Vec<Duration>,
    pub(crate) request: Request,
}

impl Shown {
    /// The age of the frame when it is shown, or the maximum if it never is.
    pub(crate) fn age(&self) -> Duration {
        self.at.map_or(Duration::MAX, |at| at.saturating_sub(self.sent_at))
    }
}

impl Player {
    pub(crate) fn new(frames: Box<dyn FrameSource>) -> Self {
        Self {
            flow: Flow::new(true),
            shown: Vec::new(),
            latencies: Vec::new(),
            frames,
            due: Duration::ZERO,
            next_key: Duration::ZERO,
            upward: VecDeque::new(),
            last: [Duration::ZERO; 2],
            pressed: Vec::new(),
        }
    }

    pub(crate) fn receive(&mut self, now: Duration, upward: Upward) {
        self.flow.advance(now);
        match upward {
            Upward::Answer(Request::Status) => self.flow.answered(now),
            Upward::Answer(Request::Fence) => self.flow.fence_answered(now),
            Upward::Answer(Request::Nothing) => {}
            Upward::Key(pressed_at) => {
                self.flow.received_input();
                self.pressed.push(pressed_at);
            }
        }
    }

    /// The frames sent at `time` or later.
    pub(crate) fn shown_since(&self, time: Duration) -> Vec<&Shown> {
        self.shown.iter().filter(|shown| shown.bytes > 0 && shown.sent_at >= time).collect()
    }

    /// The bytes on the wire of the frames that are sent at `time` or later.
    pub(crate) fn on_wire_since(&self, time: Duration) -> f64 {
        let frames = self.shown_since(time).into_iter();
        frames.map(|shown| shown.bytes as f64 * self.frames.carried(shown.fidelity)).sum()
    }

    /// The longest time between two frames that arrive from `begin` until `end`.
    pub(crate) fn longest_freeze(&self, begin: Duration, end: Duration) -> Duration {
        let frames = self.shown.iter().filter(|shown| shown.bytes > 0);
        let arrivals = frames.filter_map(|shown| shown.at);
        let within = arrivals.filter(|at| (begin..end).contains(at));
        let times: Vec<_> = [begin].into_iter().chain(within).chain([end]).collect();
        times.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).max().unwrap_or_default()
    }
}

/// Frames of a player in motion.
pub(crate) trait FrameSource {
    /// The size of a frame that is drawn at `now`, in bytes. `draw` is a random number below 1.
    fn bytes(&mut self, now: Duration, fidelity: Fidelity, draw: f64) -> f64;

    /// The share of a frame's bytes that remains after compression.
    fn carried(&self, fidelity: Fidelity) -> f64;
}

/// The distribution of frame sizes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frames {
    /// The mean size of exact frames, in bytes.
    pub(crate) exact: f64,
    /// The maximum deviation from the mean, as a share of it.
    pub(crate) spread: f64,
    /// The shares of the bytes that remain after compression: of an exact frame, and of a coarse
    /// one.
    pub(crate) compressed: [f64; 2],
}

impl Frames {
    /// The frames of a walk through the citadel at 120×40, as `cellcaster wire` measures them.
    pub(crate) const CITADEL: Self = Self { exact: 27_000.0, spread: 0.6, compressed: [1.0, 1.0] };
    /// The same frames with `ssh -C`.
    pub(crate) const COMPRESSED: Self = Self { compressed: [0.183, 0.225], ..Self::CITADEL };

    pub(crate) fn all_of(bytes: usize) -> Self {
        Self { exact: bytes as f64, spread: 0.0, compressed: [1.0, 1.0] }
    }
}

impl FrameSource for Frames {
    fn bytes(&mut self, _: Duration, fidelity: Fidelity, draw: f64) -> f64 {
        self.exact * (1.0 + self.spread * (2.0 * draw - 1.0)) / saving(fidelity)
    }

    fn carried(&self, fidelity: Fidelity) -> f64 {
        let [exact, coarse] = self.compressed;
        if fidelity == Fidelity::EXACT { exact } else { coarse }
    }
}

/// The factor by which frames are smaller at `fidelity`.
pub(crate) fn saving(fidelity: Fidelity) -> f64 {
    1.0 + f64::from(fidelity.tolerance()) * 0.3
}
