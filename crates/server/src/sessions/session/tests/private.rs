//! Private rooms: entering one by its code, and guessing codes.

use super::*;
use crate::rooms::invitation::RoomCode;
use crate::sessions::session::pages::Page;
use cellcaster::color::palette::ColorDepth;

/// A visitor in the lobby.
pub(crate) fn in_lobby(rig: &mut Rig, name: &str, size: (u16, u16)) -> usize {
    let index = rig.visitor_with(name, size, Speaks::Kitty, ColorDepth::True);
    rig.press(index, ENTER);
    assert_eq!(rig.page(index), Page::Lobby, "{}", rig.text(index));
    index
}

/// Opens a private room; returns its code.
fn open_private(rig: &mut Rig, index: usize) -> String {
    for key in ["2", "2", ENTER, "2", "1"] {
        rig.press(index, key);
    }
    assert_eq!(rig.page(index), Page::Room, "{}", rig.text(index));
    rig.press(index, ESCAPE);
    let text = rig.text(index);
    let (_, after) = text.split_once("with the code ").expect(&text);
    rig.press(index, ESCAPE);
    after[..6].to_owned()
}

fn type_code(rig: &mut Rig, index: usize, code: &str) {
    rig.press(index, "6");
    assert_eq!(rig.page(index), Page::Code, "{}", rig.text(index));
    rig.press(index, &format!("{code}\r"));
}

#[test]
fn only_its_code_leads_into_a_private_room() {
    let mut rig = Rig::new(Mode::Roam);
    let mara = in_lobby(&mut rig, "Mara", (80, 24));
    let jon = in_lobby(&mut rig, "Jon", (120, 40));
    let code = open_private(&mut rig, mara);
    // It is neither listed, nor offered, nor shown, and its level is not named.
    let text = rig.text(jon);
    assert!(!text.contains("Tag") && text.contains("nobody is walking"), "{text}");
    assert!(text.contains("in private"), "{text}");
    type_code(&mut rig, jon, "BCDFGH");
    let text = rig.text(jon);
    assert!(text.contains("No room has the code BCDFGH"), "{text}");
    type_code(&mut rig, jon, &code.to_lowercase());
    assert_eq!(rig.page(jon), Page::Room, "{}", rig.text(jon));
    rig.press(jon, "\t");
    assert!(rig.text(jon).contains(&format!("invitation code {code}")), "{}", rig.text(jon));
    // The code ends with the room.
    for visitor in [jon, mara] {
        rig.press(visitor, "q");
        rig.press(visitor, "q");
    }
    rig.pump(600_000);
    let kim = in_lobby(&mut rig, "Kim", (80, 24));
    type_code(&mut rig, kim, &code);
    assert!(rig.text(kim).contains("No room has the code"), "{}", rig.text(kim));
}

#[test]
fn wrong_codes_are_limited() {
    let mut rig = Rig::new(Mode::Roam);
    let [mara, jon] = ["Mara", "Jon"].map(|name| in_lobby(&mut rig, name, (80, 24)));
    let code = open_private(&mut rig, mara);
    let is_right = |wrong: &&String| RoomCode::parse(wrong) != RoomCode::parse(&code);
    let wrong: Vec<String> = "BCDFGH".chars().map(|it| format!("BCDFG{it}")).collect();
    for wrong in wrong.iter().filter(is_right).take(5) {
        type_code(&mut rig, jon, wrong);
    }
    type_code(&mut rig, jon, &code);
    assert!(rig.text(jon).contains("Too many wrong codes: wait a minute."), "{}", rig.text(jon));
    rig.pump(60_000);
    type_code(&mut rig, jon, &code);
    assert_eq!(rig.page(jon), Page::Room, "{}", rig.text(jon));
}
