//! Every page in windows of 80×24 and 40×12 cells, without colours.

use super::*;

fn assert_pages(name: &str, show: impl Fn(&mut Rig, (u16, u16)) -> usize, mode: Mode) {
    for (columns, rows) in [(80, 24), (40, 12)] {
        let mut rig = Rig::new(mode);
        let index = show(&mut rig, (columns, rows));
        insta::assert_snapshot!(format!("{name}_{columns}x{rows}"), rig.text(index));
    }
}

/// Jon, with Mara in front of him, looking at him.
fn face_to_face(rig: &mut Rig, size: (u16, u16)) -> usize {
    let mara = rig.member("Mara", (80, 24), Speaks::Plain);
    for _ in 0..14 {
        rig.press(mara, "w");
    }
    rig.press(mara, "b");
    let jon = rig.member("Jon", size, Speaks::Plain);
    rig.press(jon, "m");
    jon
}

#[test]
fn every_page_is_readable() {
    assert_pages("name", |rig, size| rig.visitor("amber-fox", size, Speaks::Plain), Mode::Roam);
    let lobby = |rig: &mut Rig, size| {
        rig.member("Mara", (80, 24), Speaks::Plain);
        let jon = rig.visitor("Jon", size, Speaks::Plain);
        rig.press(jon, ENTER);
        jon
    };
    assert_pages("lobby", lobby, Mode::Tag);
    let card = |rig: &mut Rig, size| {
        let jon = lobby(rig, size);
        rig.press(jon, ENTER);
        jon
    };
    assert_pages("card", card, Mode::Tag);
}

#[test]
fn a_room_is_readable() {
    assert_pages("room", face_to_face, Mode::Roam);
    let chat = |rig: &mut Rig, size| {
        let jon = face_to_face(rig, size);
        rig.press(0, "/over here\r");
        rig.press(jon, "/I come");
        jon
    };
    assert_pages("chat", chat, Mode::Roam);
    let members = |rig: &mut Rig, size| {
        let jon = face_to_face(rig, size);
        rig.press(jon, "\t");
        jon
    };
    assert_pages("members", members, Mode::Roam);
}

#[test]
fn a_round_is_readable() {
    let tag = |rig: &mut Rig, size| {
        let jon = face_to_face(rig, size);
        rig.pump(6_000);
        jon
    };
    assert_pages("tag", tag, Mode::Tag);
    let standings = |rig: &mut Rig, size| {
        let jon = face_to_face(rig, size);
        rig.pump(187_000);
        jon
    };
    assert_pages("standings", standings, Mode::Tag);
}
