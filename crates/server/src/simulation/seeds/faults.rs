//! Faults of a run's clients, their links and the server.

use std::time::Duration;

use super::{CLIENTS, HOSTILE, SeedRun};

/// How long a connection takes at most to notice that its client is gone, in milliseconds; the
/// configuration's default.
const SILENCE: u64 = 12_000;
/// The maximum number of frames sent to a client after it stops reading: one partly received, and one waiting.
const MAX_HELD: u64 = 2;
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

impl SeedRun {
    /// Disturbs a random client other than the steady one.
    pub(crate) fn disturb(&mut self) {
        let others = &self.connected[1..];
        if others.is_empty() {
            if !self.is_draining {
                self.come();
            }
            return;
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

    /// Stops the terminal's replies. The client gets no frame after the frame that it has not acknowledged.
    fn mute(&mut self, client: usize) {
        self.rig.clients[client].set(|link| link.answers = false);
        self.mute.push(client);
    }

    /// Stops the client from reading.
    fn stall(&mut self, client: usize) {
        let Self { rig, silent, .. } = self;
        if silent.iter().all(|(other, _)| *other != client) {
            let client_of = &rig.clients[client];
            client_of.set(|link| link.reads = false);
            silent.push((client, client_of.frames()));
        }
    }

    pub(crate) fn wake(&mut self, client: usize) {
        let Self { rig, silent, .. } = self;
        if let Some(index) = silent.iter().position(|(other, _)| *other == client) {
            let (_, before) = silent.swap_remove(index);
            let held = rig.clients[client].frames() - before;
            assert!(held <= MAX_HELD, "{held} frames");
            rig.clients[client].set(|link| link.reads = true);
        }
    }

    /// Cuts a client's link silently. The connection notices it later.
    fn cut(&mut self, client: usize) {
        self.stall(client);
        self.rig.clients[client].set(|link| link.answers = false);
        self.connected.retain(|other| *other != client);
        let notices =
            self.rig.now() + Duration::from_millis(self.chance.below(SILENCE as usize) as u64);
        self.cut.push((client, notices));
    }

    /// Closes the client's connection.
    pub(crate) fn leave(&mut self, client: usize) {
        self.connected.retain(|other| *other != client);
        self.silent.retain(|(other, _)| *other != client);
        self.rig.clients[client].cut();
    }

    fn drain(&mut self) {
        self.is_draining = true;
        self.connected.iter().for_each(|&client| self.rig.clients[client].drain());
    }

    /// Lets connections notice that their clients are gone, where that is due.
    pub(crate) fn notice(&mut self) {
        let now = self.rig.now();
        let due: Vec<usize> = self
            .cut
            .extract_if(.., |(_, notices)| *notices <= now)
            .map(|(client, _)| client)
            .collect();
        for client in due {
            self.leave(client);
        }
    }
}
