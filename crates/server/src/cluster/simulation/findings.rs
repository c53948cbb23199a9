//! The conditions that must hold after a run.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use tokio::time::Instant;

use super::super::message::{LogMessage, Record};
use super::super::room_state::{Position, RoomState};
use super::ClusterRun;
use crate::rooms::directory::{Place, RoomRefusal};
use crate::rooms::room::{Command, Header, MemberId};
use crate::rooms::summary::RoomId;

/// The longest time without a message in a room with members.
const PAUSE: Duration = Duration::from_millis(500);

/// The result of a replay of a room's log.
struct Played {
    state: RoomState,
    /// The checksum of the game, by round and step.
    states: BTreeMap<(u32, u64), u64>,
    /// The members who joined, in the order of the log.
    joined: Vec<MemberId>,
    last_at: Option<Instant>,
}

impl ClusterRun {
    /// Replays each log from its beginning, and compares the result with the rooms that hosts show.
    pub(crate) fn assert_log(&self) {
        for host in &self.hosts {
            assert_eq!(host.metrics.checks(false).get(), 0, "a host differs");
        }
        let rooms: BTreeSet<RoomId> = self.let_in.iter().map(|it| it.0).collect();
        for &room in &rooms {
            let played = self.played(room);
            for (index, host) in self.hosts.iter().enumerate().filter(|(_, it)| !it.is_killed) {
                let Some(view) = host.shared.view(room) else { continue };
                let state = played.states.get(&(view.header.round, view.step));
                assert_eq!(state, Some(&view.game.checksum()), "room {room} on host {index}");
            }
            let joined: BTreeSet<MemberId> = played.joined.iter().copied().collect();
            assert_eq!(joined.len(), played.joined.len(), "a number is used twice");
            for (_, member) in self.let_in.iter().filter(|it| it.0 == room) {
                assert!(joined.contains(member), "{member} is not in the log of room {room}");
            }
        }
        let let_in: BTreeSet<_> = self.let_in.iter().collect();
        assert_eq!(let_in.len(), self.let_in.len(), "two players have the same number");
    }

    /// Asserts that the members who are not away are the players who are present, and that their
    /// rooms go on.
    pub(crate) fn assert_members(&self) {
        let mut there: BTreeMap<RoomId, BTreeSet<MemberId>> = BTreeMap::new();
        for place in self.players.iter().filter_map(|player| player.place.as_ref()) {
            if place.closed().is_some() {
                // Their host was cut off for so long that they were removed, and they were told.
                continue;
            }
            let members = there.entry(place.room()).or_default();
            assert!(members.insert(place.member_id().expect("a member")), "two are one member");
        }
        for player in &self.players {
            for (host, place) in &player.taken {
                let is_killed = self.hosts[*host].is_killed;
                let at = |place: &Place| (place.room(), place.member_id());
                let now = player.place.as_ref().map(at);
                assert!(
                    is_killed || place.closed().is_some(),
                    "{:?} was taken from host {host} and is open; they are {now:?} on host {}",
                    at(place),
                    player.host
                );
            }
        }
        let now = Instant::now();
        for (room, members) in there {
            let played = self.played(room);
            let known = played.state.room.colors().map(|(member, _)| member);
            let known: BTreeSet<MemberId> =
                known.filter(|member| !played.state.room.is_away(*member)).collect();
            assert_eq!(known, members, "the members of room {room}");
            let is_going_on = played.last_at.is_some_and(|at| now.duration_since(at) < PAUSE);
            assert!(is_going_on, "room {room} stands still");
        }
    }

    /// Asserts that nobody can take the place of a player who plays.
    pub(crate) async fn assert_nobody_is_displaced(&self) {
        for player in &self.players {
            let is_there = |place: &&Place| place.closed().is_none();
            let Some(place) = player.place.as_ref().filter(is_there) else { continue };
            let Some(key) = player.entrant.key else { continue };
            let at = (place.room(), place.member_id().expect("a member"));
            for host in self.hosts.iter().filter(|host| !host.is_killed) {
                let refusal = host.shared.resume(key, at).await.expect_err("they play");
                assert_eq!(refusal, RoomRefusal::Taken);
            }
        }
    }

    fn played(&self, room: RoomId) -> Played {
        let header = self.first_header(room);
        let state = RoomState::new(&self.catalog, header).expect("a level");
        let mut played =
            Played { state, states: BTreeMap::new(), joined: Vec::new(), last_at: None };
        let mut hosts = BTreeMap::new();
        let mut epoch = 0;
        played.note();
        for kept in self.world.log(room) {
            let message = LogMessage::parse(&kept.bytes).expect("a message");
            let host = *hosts.entry(message.epoch).or_insert(kept.host);
            assert_eq!(host, kept.host, "epoch {} has two sequencers", message.epoch);
            assert!(message.epoch >= epoch, "epoch {} comes after {epoch}", message.epoch);
            epoch = message.epoch;
            assert_eq!(played.state.position(kept.number, &message), Position::Next);
            played.state.apply(Some(kept.number), &message);
            let joins =
                message.entries.iter().filter(|it| matches!(it.command, Command::Join { .. }));
            played.joined.extend(joins.map(|entry| entry.member));
            played.last_at = Some(kept.at);
            played.note();
        }
        played
    }

    fn first_header(&self, room: RoomId) -> Header {
        let bytes = self.world.first_record(room).expect("a record");
        Record::parse(&bytes).expect("a record").header
    }
}

impl Played {
    fn note(&mut self) {
        let view = self.state.room.view();
        self.states.insert((view.header.round, view.step), view.game.checksum());
    }
}
