use super::super::tests::{advance, do_now, join, position, room, want};
use super::super::{Command, Mode, Phase};
use super::*;
use cellcaster::game::Intent;

/// A room with two members, of whom the first has an account.
fn room_of_two(mode: Mode) -> (Room, [MemberId; 2]) {
    let mut room = room(mode);
    let members = ["Mara", "Jon"].map(|name| join(&mut room, name));
    do_now(&mut room, members[0], Command::Keep);
    (room, members)
}

fn last_line(room: &Room) -> String {
    room.view().said.last().map(|said| said.text.clone()).unwrap_or_default()
}

#[test]
fn one_who_is_away_stands_still_and_goes_on_from_there() {
    let (mut room, [mara, _]) = room_of_two(Mode::Roam);
    want(&mut room, mara, &[Intent::Forward]);
    advance(&mut room, 20);
    do_now(&mut room, mara, Command::Away);
    assert_eq!(last_line(&room), "Mara is away.");
    advance(&mut room, 60);
    let place = position(&room, mara);
    // What their old host sends late has no effect.
    want(&mut room, mara, &[Intent::Forward]);
    do_now(&mut room, mara, Command::Again);
    advance(&mut room, AWAY - 61);
    assert_eq!(position(&room, mara), place);
    assert!(room.view().member(mara).unwrap().is_away && room.is_away(mara));
    do_now(&mut room, mara, Command::Return { token: 7 });
    assert_eq!((last_line(&room).as_str(), room.is_away(mara)), ("Mara is back.", false));
    assert_eq!(room.kept_place(mara), Some(KeptPlace { token: 7, away: None }));
    want(&mut room, mara, &[Intent::Forward]);
    advance(&mut room, AWAY + 60);
    assert!(position(&room, mara).x > place.x + 1.0 && room.len() == 2);
}

#[test]
fn one_who_is_away_for_too_long_leaves() {
    let (mut room, [mara, jon]) = room_of_two(Mode::Roam);
    do_now(&mut room, mara, Command::Away);
    advance(&mut room, AWAY - 1);
    // It is counted once.
    do_now(&mut room, mara, Command::Away);
    assert_eq!(room.len(), 2);
    advance(&mut room, 1);
    assert_eq!((room.len(), last_line(&room).as_str()), (1, "Mara leaves."));
    do_now(&mut room, mara, Command::Return { token: 7 });
    assert!(room.has_lost(mara) && !room.has_lost(jon) && !room.has_lost(room.next_member()));
}

#[test]
fn a_guest_is_not_away_but_gone() {
    let (mut room, [_, jon]) = room_of_two(Mode::Roam);
    do_now(&mut room, jon, Command::Return { token: 7 });
    assert_eq!(room.kept_place(jon), None);
    do_now(&mut room, jon, Command::Away);
    assert_eq!((room.len(), last_line(&room).as_str()), (1, "Jon leaves."));
}

#[test]
fn a_round_waits_for_nobody_who_is_away() {
    let (mut room, [mara, jon]) = room_of_two(Mode::Roam);
    do_now(&mut room, mara, Command::Again);
    do_now(&mut room, mara, Command::Away);
    assert!(!room.is_over());
    do_now(&mut room, jon, Command::Again);
    assert!(room.is_over());
}

#[test]
fn one_is_away_in_the_next_round_too() {
    let (mut room, [mara, _]) = room_of_two(Mode::Tag);
    do_now(&mut room, mara, Command::Return { token: 7 });
    advance(&mut room, 100);
    assert!(matches!(room.phase(), Phase::Countdown { .. }));
    do_now(&mut room, mara, Command::Away);
    advance(&mut room, 100);
    room.begin_next();
    let kept = KeptPlace { token: 7, away: Some(AWAY - 100) };
    assert_eq!(room.kept_place(mara), Some(kept));
    advance(&mut room, AWAY - 101);
    assert_eq!(room.len(), 2);
    advance(&mut room, 1);
    assert_eq!(room.len(), 1);
}
