//! Every page in windows of 80×24 and 40×12 cells, without colours.

use super::*;
use cellcaster::color::palette::ColorDepth;

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
fn a_large_lobby_is_readable() {
    let mut rig = Rig::new(Mode::Tag);
    rig.member("Mara", (80, 24), Speaks::Plain);
    let jon = rig.visitor("Jon", (120, 40), Speaks::Plain);
    rig.press(jon, ENTER);
    insta::assert_snapshot!("lobby_120x40", rig.text(jon));
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

/// A level whose exit is eight cells ahead of the start.
const SHORT: &str = r##"
title = "The Hall"
floor = "#304050"
ceiling = "#202028"
grid = '''
###############
#@.......>....#
#.............#
#.............#
#.............#
###############
'''
[tiles]
"#" = { wall = "#808080" }
[things]
"@" = { start = 0 }
">" = { exit = true }
"##;

/// A race between Mara and Jon, who has this window. Mara starts to run when the play begins.
fn race(size: (u16, u16), depth: ColorDepth) -> (Rig, [usize; 2]) {
    let mut rig = Rig::with(RigOptions { catalog: catalog(SHORT), ..RigOptions::new(Mode::Race) });
    let mara = rig.member("Mara", (80, 24), Speaks::Kitty);
    let jon = rig.visitor_with("Jon", size, Speaks::Kitty, depth);
    (0..3).for_each(|_| rig.press(jon, ENTER));
    (rig, [mara, jon])
}

#[test]
fn a_race_is_readable() {
    for (columns, rows) in [(80, 24), (40, 12)] {
        let (mut rig, [mara, jon]) = race((columns, rows), ColorDepth::Mono);
        let look = |rig: &Rig, name: &str| {
            insta::assert_snapshot!(format!("{name}_{columns}x{rows}"), rig.text(jon));
        };
        look(&rig, "countdown");
        while rig.view().begun.is_none() {
            rig.pump(50);
        }
        rig.pump(300);
        look(&rig, "go");
        let hold = |rig: &Rig, index| rig.send(index, "\x1b[119;1:1u");
        hold(&rig, jon);
        rig.pump(800);
        rig.send(jon, "\x1b[119;1:3u");
        rig.pump(700);
        look(&rig, "race");
        rig.press(jon, "\x1b[9u");
        look(&rig, "places");
        rig.press(jon, "\x1b[9u");
        hold(&rig, jon);
        while rig.view().members[1].finish.is_none() {
            rig.pump(50);
        }
        rig.pump(500);
        look(&rig, "finish");
        hold(&rig, mara);
        while rig.view().standings.is_empty() {
            rig.pump(50);
        }
        rig.pump(3_000);
        look(&rig, "podium");
    }
}

/// The middle of a screen: a letter for each light or red cell, and a dot for the others. Without colours, the
/// text.
fn middle(rig: &Rig, index: usize) -> String {
    let rgb = |color| match color {
        vt100::Color::Rgb(red, green, blue) => Some([red, green, blue].map(i32::from)),
        vt100::Color::Idx(index @ 16..232) => {
            let level = |step: i32| if step == 0 { 0 } else { 55 + 40 * step };
            let cube = i32::from(index) - 16;
            Some([cube / 36, cube / 6 % 6, cube % 6].map(level))
        }
        vt100::Color::Idx(index @ 232..) => Some([8 + 10 * (i32::from(index) - 232); 3]),
        vt100::Color::Idx(index) => {
            let full = if index < 8 { 170 } else { 255 };
            Some([1, 2, 4].map(|bit| if index & bit > 0 { full } else { 0 }))
        }
        vt100::Color::Default => None,
    };
    rig.clients[index].look(|emulator| {
        let cell = |row, column| {
            let cell = emulator.screen().cell(row, column)?;
            let is_blank = cell.contents().trim().is_empty();
            let color = rgb(if is_blank { cell.bgcolor() } else { cell.fgcolor() });
            let Some([red, green, blue]) = color else { return cell.contents().chars().next() };
            Some(match () {
                () if red.min(green) > 200 && blue > 120 => 'W',
                () if red > 150 && red > 2 * green.max(blue) => 'r',
                () => '.',
            })
        };
        let row = |row| (26..54).map(|column| cell(row, column).unwrap_or(' ')).collect::<String>();
        (5..18).map(|number| row(number).trim_end().to_owned() + "\n").collect()
    })
}

#[test]
fn it_is_recognised_by_looks_in_every_colour_depth() {
    let depths =
        [ColorDepth::True, ColorDepth::Indexed256, ColorDepth::Indexed16, ColorDepth::Mono];
    for depth in depths {
        let mut rig = Rig::new(Mode::Tag);
        let [mara, jon] = ["Mara", "Jon"].map(|name| {
            let index = rig.visitor_with(name, (80, 24), Speaks::Plain, depth);
            (0..3).for_each(|_| rig.press(index, ENTER));
            if name == "Mara" {
                (0..14).for_each(|_| rig.press(index, "w"));
                rig.press(index, "b");
            }
            rig.press(index, "m");
            index
        });
        rig.pump(7_000);
        let is_it = |index: usize| rig.text(index).contains("you are it");
        let (it, other) = if is_it(mara) { (mara, jon) } else { (jon, mara) };
        let edge = |index: usize| {
            rig.clients[index].look(|emulator| {
                let cell = |column| emulator.screen().cell(0, column).unwrap().contents() == "#";
                (0..80).filter(|&column| cell(column)).count()
            })
        };
        assert_eq!((edge(it), edge(other)), (80, 0), "{depth:?}: the frame of \"it\"");
        let looks = format!("it:\n{}\nanother:\n{}", middle(&rig, other), middle(&rig, it));
        insta::assert_snapshot!(format!("looks_{depth:?}"), looks);
    }
}

#[test]
fn hidden_players_see_how_near_the_seeker_is() {
    let mut rig = Rig::new(Mode::Hide);
    let ids = ["Mara", "Jon"].map(|name| rig.member(name, (80, 24), Speaks::Plain));
    rig.pump(1_000);
    let text = ids.map(|id| rig.text(id));
    let seeker = usize::from(text[1].contains("you seek"));
    assert!(text[seeker].contains("you seek"), "{text:?}");
    let hidden = ids[1 - seeker];
    let warmth = |rig: &Rig| rig.text(hidden).matches('+').count();
    // Towards the far end of the hall.
    rig.press(hidden, "m");
    for _ in 0..25 {
        rig.press(hidden, "w");
    }
    rig.pump(10_000);
    assert!(!rig.text(ids[seeker]).contains("You can see again"));
    let cold = warmth(&rig);
    for _ in 0..12 {
        rig.press(ids[seeker], "w");
    }
    let warm = warmth(&rig);
    assert!(cold < warm, "{cold} {warm}: {}", rig.text(hidden));
}
