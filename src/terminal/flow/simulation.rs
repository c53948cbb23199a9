//! A line, the players who share it, and their terminals: bytes and times in, decisions of the flow
//! out. Nothing here has a clock, and chance is seeded, so a run repeats itself everywhere.
//!
//! The line carries packets one after another, at a rate that a scenario may change. Each way has a
//! delay and jitter, drawn anew for each packet; as in TCP, nothing overtakes what was sent before.

use std::collections::VecDeque;

use super::*;
use crate::rng::SplitMix64;

const TICK: Duration = Duration::from_millis(1);
const FRAME_TIME: Duration = Duration::from_millis(33);
/// The most that travels in one piece.
const PACKET: f64 = 1400.0;
/// What a line carries that nobody can fill: bytes a second.
pub(super) const UNLIMITED: f64 = 1e9;

/// What the line is like.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conditions {
    /// From one end to the other.
    pub(super) delay: Duration,
    /// The most that a packet takes longer than that, each way.
    pub(super) jitter: Duration,
    /// Towards the players, in bytes a second.
    pub(super) rate: f64,
}

/// How large frames are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frames {
    /// The mean of exact ones, in bytes.
    pub(super) exact: f64,
    /// How far one may be from the mean, as a share of it.
    pub(super) spread: f64,
    /// Which share of a frame is left after compression: of an exact one, and of a coarse one.
    pub(super) compressed: [f64; 2],
}

impl Frames {
    /// Those of a walk through the citadel at 120×40, as `cellcaster wire` measures them.
    pub(super) const CITADEL: Self = Self { exact: 27_000.0, spread: 0.6, compressed: [1.0, 1.0] };
    /// The same with `ssh -C`.
    pub(super) const COMPRESSED: Self = Self { compressed: [0.183, 0.225], ..Self::CITADEL };

    pub(super) fn all_of(bytes: usize) -> Self {
        Self { exact: bytes as f64, spread: 0.0, compressed: [1.0, 1.0] }
    }

    fn bytes(&self, fidelity: Fidelity, draw: f64) -> f64 {
        self.exact * (1.0 + self.spread * (2.0 * draw - 1.0)) / saving(fidelity)
    }

    fn carried(&self, fidelity: Fidelity) -> f64 {
        let [exact, coarse] = self.compressed;
        if fidelity == Fidelity::EXACT { exact } else { coarse }
    }
}

/// By how much smaller frames are at `fidelity`.
pub(super) fn saving(fidelity: Fidelity) -> f64 {
    1.0 + f64::from(fidelity.tolerance()) * 0.3
}

/// A line with players at its end.
pub(super) struct Simulation {
    pub(super) now: Duration,
    pub(super) conditions: Conditions,
    pub(super) players: Vec<Player>,
    /// What waits for the line: whose it is, how many bytes, and which frame it ends.
    queue: VecDeque<(usize, f64, Option<usize>)>,
    /// How much of the first in the queue has been carried.
    carried: f64,
    chance: SplitMix64,
}

/// A player in motion, and the game at the other end.
pub(super) struct Player {
    pub(super) flow: Flow,
    pub(super) shown: Vec<Shown>,
    /// From pressing a key to the first frame that reflects it, in order of pressing.
    pub(super) latencies: Vec<Latency>,
    frames: Frames,
    due: Duration,
    next_key: Duration,
    /// On its way to the game: what it is, and when it is there.
    upward: VecDeque<(Duration, Upward)>,
    /// When what was sent last arrives, upward and downward.
    last: [Duration; 2],
    /// Which keys are in the next frame.
    pressed: Vec<Duration>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Upward {
    Answer(Request),
    Key(Duration),
}

/// A key that was pressed, and how long it took to be seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Latency {
    pub(super) pressed_at: Duration,
    pub(super) taken: Duration,
}

/// A frame that was sent.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    pub(super) sent_at: Duration,
    /// When it is on the screen; `None` where it has not arrived.
    pub(super) at: Option<Duration>,
    pub(super) fidelity: Fidelity,
    pub(super) bytes: usize,
    keys: Vec<Duration>,
    request: Request,
}

impl Shown {
    /// How old it is when it is seen; for ever where it is not.
    pub(super) fn age(&self) -> Duration {
        self.at.map_or(Duration::MAX, |at| at.saturating_sub(self.sent_at))
    }
}

impl Simulation {
    /// `frames` of each player, who begin one after another.
    pub(super) fn new(conditions: Conditions, frames: &[Frames]) -> Self {
        let players = frames.iter().map(|frames| Player::new(*frames)).collect();
        let mut simulation = Self {
            now: Duration::ZERO,
            conditions,
            players,
            queue: VecDeque::new(),
            carried: 0.0,
            chance: SplitMix64::new(7),
        };
        for player in 0..simulation.players.len() {
            simulation.send(player, 0.0, Fidelity::EXACT);
        }
        simulation
    }

    pub(super) fn of_one(delay: Duration, rate: f64, frames: Frames) -> Self {
        Self::new(Conditions { delay, jitter: Duration::ZERO, rate }, &[frames])
    }

    /// All players move for so long.
    pub(super) fn walk(&mut self, time: Duration) {
        let until = self.now + time;
        while self.now < until {
            self.carry();
            for player in 0..self.players.len() {
                self.play(player);
            }
            self.now += TICK;
        }
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
        if now >= player.due && player.flow.may_send(now) {
            let fidelity = player.flow.fidelity();
            let bytes = player.frames.bytes(fidelity, self.chance.unit());
            self.send(number, bytes, fidelity);
            let player = &mut self.players[number];
            player.flow.showed_motion(bytes as usize, fidelity);
            player.due = now + FRAME_TIME;
        }
    }

    fn press_keys(&mut self, number: usize) {
        if self.now >= self.players[number].next_key {
            let pause = Duration::from_millis(300 + (self.chance.unit() * 200.0) as u64);
            self.players[number].next_key = self.now + pause;
            self.send_upward(number, self.now, Upward::Key(self.now));
        }
    }

    /// Sends a frame of so many bytes, and a request after it.
    fn send(&mut self, number: usize, bytes: f64, fidelity: Fidelity) {
        let request = self.players[number].flow.request(self.now);
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

    /// Carries as much as the line does in a tick.
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

    /// When what is sent now arrives, after all that was sent before in the same direction.
    fn arrival(&mut self, number: usize, direction: usize, at: Duration) -> Duration {
        let Conditions { delay, jitter, .. } = self.conditions;
        let last = &mut self.players[number].last[direction];
        *last = (at + delay + jitter.mul_f64(self.chance.unit())).max(*last);
        *last
    }
}

impl Player {
    fn new(frames: Frames) -> Self {
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

    fn receive(&mut self, now: Duration, upward: Upward) {
        match upward {
            Upward::Answer(Request::Status) => self.flow.answered(now),
            Upward::Answer(Request::Fence) => self.flow.fence_answered(now),
            Upward::Answer(Request::Nothing) => {}
            Upward::Key(pressed_at) => {
                self.flow.heard();
                self.pressed.push(pressed_at);
            }
        }
    }

    /// The frames that were sent after `time`.
    pub(super) fn shown_since(&self, time: Duration) -> Vec<&Shown> {
        self.shown.iter().filter(|shown| shown.bytes > 0 && shown.sent_at >= time).collect()
    }

    /// The longest time between two frames that arrive from `begin` until `end`.
    pub(super) fn longest_freeze(&self, begin: Duration, end: Duration) -> Duration {
        let frames = self.shown.iter().filter(|shown| shown.bytes > 0);
        let arrivals = frames.filter_map(|shown| shown.at);
        let within = arrivals.filter(|at| (begin..end).contains(at));
        let times: Vec<_> = [begin].into_iter().chain(within).chain([end]).collect();
        times.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).max().unwrap_or_default()
    }

    /// The most that was on its way at a time, in bytes.
    pub(super) fn most_in_flight(&self, begin: Duration) -> usize {
        let in_flight = |time| {
            let is_there =
                |shown: &&Shown| shown.sent_at <= time && shown.at.is_none_or(|at| at > time);
            self.shown.iter().filter(is_there).map(|shown| shown.bytes).sum()
        };
        self.shown_since(begin).iter().map(|shown| in_flight(shown.sent_at)).max().unwrap_or(0)
    }
}
