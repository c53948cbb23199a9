//! The conditions that hold after each run.

use std::sync::Arc;
use std::time::Duration;

use tokio::time::Instant;

use super::{BETWEEN_KEYS, Bystander, STEADY, SeedRun, hall};
use crate::sessions::session::Session;
use crate::simulation::emulator::Emulator;
use crate::simulation::logs::{assert_same, replayed};
use crate::simulation::looks::looks;
use crate::simulation::{ROOM, Speaks, catalog};

/// The longest time between two frames of the steady member: three frames at thirty per second.
const MAX_PAUSE: Duration = Duration::from_millis(100);

/// The longest time from the bystander's key to the frame that answers it.
const MAX_ANSWER: Duration = Duration::from_millis(100);

impl SeedRun {
    /// Asserts that the frames of the steady member were never delayed.
    pub(crate) fn assert_steady(&self, begun: Instant, end: Instant) {
        let arrivals = self.rig.clients[STEADY].arrivals();
        let times: Vec<Instant> =
            arrivals.into_iter().filter(|time| (begun..end).contains(time)).chain([end]).collect();
        let pauses = times.windows(2).map(|pair| pair[1] - pair[0]);
        let longest = pauses.chain([times[0] - begun]).max();
        assert!(longest <= Some(MAX_PAUSE), "{longest:?} without a picture");
    }

    /// Asserts that each of the bystander's keys was answered in time.
    pub(crate) fn assert_answered(&mut self) {
        self.rig.pump(BETWEEN_KEYS.as_millis() as u64);
        let Some(Bystander { client, pressed }) = &self.bystander else { return };
        let arrivals = self.rig.clients[*client].arrivals();
        for key in pressed {
            let answer = arrivals.iter().find(|time| *time > key).map(|answer| *answer - *key);
            let is_soon = answer.is_some_and(|time| time <= MAX_ANSWER);
            assert!(is_soon, "a key was answered after {answer:?}");
        }
    }

    /// Asserts that replaying the recordings of all open rooms reproduces their states.
    pub(crate) fn assert_replays(&self) {
        let levels = Arc::new(catalog(&hall()));
        for room in self.rig.logs.rooms() {
            let text = self.rig.logs.text(room);
            assert!(!text.contains(|it: char| it != '\n' && it.is_control()), "{text:?}");
            if let Some(view) = self.rig.rooms().view(room) {
                assert_same(&view, &replayed(&text, &levels, view.step));
            }
        }
    }

    /// Asserts that the members of the rooms are the connected visitors whose sessions are in a room.
    pub(crate) fn assert_members(&self) {
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

    /// Asserts that each screen shows the picture that its session would draw on an empty screen.
    pub(crate) fn assert_screens(&mut self) {
        let answering = self.connected.iter().filter(|client| !self.mute.contains(client));
        for client in answering.copied().collect::<Vec<_>>() {
            // While the picture contains a countdown, a new frame may be in flight.
            let is_settled = (0..50).any(|_| {
                self.rig.pump(30);
                self.is_settled(client)
            });
            if self.rig.is_over(client) {
                assert!(self.is_draining, "the session of client {client} has ended");
                continue;
            }
            let text = self.rig.text(client);
            let wait = self.rig.session(client, |session, room| session.wait(room));
            assert!(is_settled, "client {client} never shows all ({wait}):\n{text}");
            let (size, shown) = self.rig.clients[client].look(|it| (size(it), looks(it.screen())));
            let bytes = self.rig.session(client, Session::whole_picture);
            let mut empty = Emulator::new(size.0, size.1, Speaks::Nothing);
            empty.process(&bytes);
            let is_same = shown == looks(empty.screen());
            assert!(is_same, "client {client}:\n{text}\nis not\n{}", empty.text());
        }
    }

    fn is_settled(&self, client: usize) -> bool {
        self.rig.is_over(client)
            || self.rig.clients[client].has_all()
                && self.rig.session(client, |session, room| session.is_settled(room))
    }

    /// Asserts that no escape sequence in a visitor's input has reached a terminal.
    pub(crate) fn assert_harmless(&self) {
        for client in &self.rig.clients {
            let (title, is_obeyed) = client.look(|emulator| {
                let mut sequences = emulator.bytes().windows(4);
                (emulator.title().to_owned(), sequences.any(|bytes| bytes == b"\x1b]0;"))
            });
            assert!(title.is_empty() && !is_obeyed, "{title:?}");
        }
    }

    /// Disconnects everybody and asserts that only the host's tasks are left.
    pub(crate) fn assert_no_task_left(mut self) {
        let bystander = self.bystander.take().map(|bystander| bystander.client);
        for client in std::mem::take(&mut self.connected).into_iter().chain(bystander) {
            self.leave(client);
        }
        self.rig.pump(100);
        assert_eq!(self.rig.view().members.len(), 0);
        // Rooms opened by visitors close after a minute.
        self.rig.pump(61_000);
        self.rig.clients.clear();
        self.rig.pump(100);
        assert_eq!(self.rig.tasks(), self.tasks);
        assert_eq!(self.rig.visitors.list().len(), 0);
        assert!(self.rig.rooms().view(ROOM).is_some());
    }
}

/// The number of columns and rows of a screen.
fn size(emulator: &Emulator) -> (u16, u16) {
    let (rows, columns) = emulator.screen().size();
    (columns.get(), rows.get())
}
