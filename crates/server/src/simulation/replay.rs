//! Recorded rooms, played again up to a step.

use std::sync::Arc;

use crate::rooms::room::{Catalog, Room, RoomView, parse_log};

/// Plays a recording again up to a step of its last round. Each round must begin as it did.
pub(crate) fn replayed(text: &str, catalog: &Arc<Catalog>, step: u64) -> Room {
    let rounds = parse_log(text).expect("a recording");
    let mut room = Room::new(catalog, rounds[0].0.clone()).expect("a level");
    for (index, (header, entries)) in rounds.iter().enumerate() {
        assert_eq!(room.header(), header);
        let is_last = index + 1 == rounds.len();
        let mut entries = entries.iter().peekable();
        loop {
            if is_last && room.step() == step {
                break;
            }
            if !is_last && room.is_over() {
                room.begin_next();
                break;
            }
            while let Some(entry) = entries.next_if(|entry| entry.step <= room.step()) {
                room.apply(entry);
            }
            room.advance();
        }
        assert!(entries.peek().is_none(), "an entry is of a later step");
    }
    room
}

/// Asserts that two rooms are in the same state, bit for bit.
pub(crate) fn assert_same(room: &RoomView, again: &Room) {
    let other = again.view();
    assert_eq!((room.step, &room.header), (other.step, &other.header));
    assert_eq!(room.game.checksum(), other.game.checksum());
    assert!(room.game == other.game, "the games differ");
    assert_eq!((room.phase, &room.members), (other.phase, &other.members));
    assert_eq!((&room.standings, &room.said), (&other.standings, &other.said));
}
