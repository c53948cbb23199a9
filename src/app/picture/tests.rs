use ratatui::buffer::{Buffer, Cell};
use std::collections::BTreeSet;

use super::*;
use crate::color::blindness::assert_apart;
use crate::render::{FrameSize, PixelAspect};

#[test]
fn a_note_is_shown_whole_if_there_is_room() {
    let note = "The warden sleeps at the third bell.\nThe lamp by the stair is mine: put it out.";
    for (columns, rows) in [(80, 23), (40, 11), (20, 12)] {
        let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
        draw_note(&mut buffer, Rect::new(0, 0, columns, rows), note);
        let text: String = buffer.content().iter().map(Cell::symbol).collect();
        for word in note.split_whitespace() {
            assert!(text.contains(word), "{word} in {columns} by {rows}: {text}");
        }
    }
    for (columns, rows) in [(20, 5), (3, 2), (1, 1)] {
        let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
        draw_note(&mut buffer, Rect::new(0, 0, columns, rows), note);
    }
}

fn heard(degrees: f64, kind: SoundKind, strength: u8) -> Heard {
    Heard { bearing: Heading::from_degrees(degrees).unwrap(), strength, kind, left: 30 }
}

fn shown(heard: &[Heard], heading: f64, (columns, rows): (u16, u16)) -> String {
    let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
    let heading = Heading::from_degrees(heading).unwrap();
    let area = Rect::new(0, 0, columns, rows);
    draw_sounds(&mut buffer, (area, None), (heard, Vec::new()), heading, ColorDepth::Mono);
    let lines = buffer.content().chunks(columns.into());
    lines.flat_map(|line| line.iter().map(Cell::symbol).chain(["\n"])).collect()
}

#[test]
fn sounds_are_shown_where_they_come_from() {
    let all = [
        heard(0.0, SoundKind::Shout, 3),
        heard(30.0, SoundKind::Door, 1),
        heard(90.0, SoundKind::Walking, 2),
        heard(150.0, SoundKind::Knock, 1),
        heard(180.0, SoundKind::Windup, 3),
        heard(270.0, SoundKind::Bark, 2),
    ];
    insta::assert_snapshot!(shown(&all, 0.0, (40, 11)));
    insta::assert_snapshot!(shown(&all, 90.0, (40, 11)));
}

#[test]
fn sounds_from_one_direction_are_side_by_side() {
    for degrees in [0.0, 90.0, 180.0, 270.0] {
        let all = [SoundKind::Shout, SoundKind::Bell, SoundKind::Door, SoundKind::Walking]
            .map(|kind| heard(degrees, kind, 3));
        let text = shown(&all, 0.0, (80, 23));
        for wanted in ["!!!", "&&&", "+++", "..."] {
            assert!(text.contains(wanted), "{wanted} at {degrees}:\n{text}");
        }
    }
}

#[test]
fn a_sound_behind_the_map_is_shown_beside_it() {
    let [picture, map] = [Rect::new(0, 0, 80, 23), Rect::new(50, 0, 30, 20)];
    for degrees in [30.0, 60.0, 90.0, 120.0] {
        let mut buffer = Buffer::empty(picture);
        let heard = [heard(degrees, SoundKind::Shout, 3), heard(degrees, SoundKind::Bell, 2)];
        let places = (picture, Some(map));
        let ahead = Heading::from_degrees(0.0).unwrap();
        draw_sounds(&mut buffer, places, (&heard, Vec::new()), ahead, ColorDepth::Mono);
        let drawn =
            |place: Rect| place.positions().filter(|&it| buffer[it] != Cell::default()).count();
        assert_eq!(drawn(map), 0, "at {degrees}");
        assert!(drawn(picture) > 5, "both sounds at {degrees}");
    }
}

#[test]
fn any_direction_and_window_size_can_be_drawn() {
    for (columns, rows) in [(80, 23), (20, 5), (19, 5), (20, 3), (1, 1)] {
        for tenth in 0..3600 {
            let heading = f64::from(tenth * 7) / 10.0;
            shown(&[heard(f64::from(tenth) / 10.0, SoundKind::Fall, 9)], heading, (columns, rows));
        }
    }
}

#[test]
fn each_kind_has_its_own_character() {
    use SoundKind::*;
    let kinds = [
        Walking, Running, Landing, Splash, Door, Mechanism, Spikes, Knock, Crash, Blow, Cry, Fall,
        Wonder, GiveUp, Shout, Bell, Bark, Windup, Draw, Shot, Swing,
    ];
    let characters: BTreeSet<char> = kinds.into_iter().map(|kind| sign(kind).0).collect();
    assert_eq!(characters.len(), kinds.len());
    assert!(characters.iter().all(char::is_ascii_graphic));
}

fn hurt(degrees: Option<f64>) -> Flash {
    let bearing = degrees.and_then(Heading::from_degrees);
    Flash { kind: FlashKind::Hurt { bearing }, left: 20 }
}

fn reds(flash: &Flash) -> [u8; 5] {
    let mut frame = Frame::new(FrameSize::new(80, 46).unwrap(), PixelAspect::SQUARE);
    tint(&mut frame, flash, Heading::from_degrees(90.0).unwrap());
    [(40, 2), (77, 23), (40, 43), (2, 23), (40, 23)].map(|(x, y)| frame.pixel(x, y).red())
}

#[test]
fn a_blow_reddens_the_side_that_it_comes_from() {
    for (degrees, side) in [(90.0, 0), (180.0, 1), (270.0, 2), (0.0, 3)] {
        let reds = reds(&hurt(Some(degrees)));
        for other in (0..4).filter(|&other| other != side) {
            assert!(reds[side] > reds[other] + 60, "{degrees}: {reds:?}");
        }
        assert_eq!(reds[4], 0, "the middle stays as it is");
    }
    let around = reds(&hurt(None));
    assert!(around[..4].iter().all(|&red| red == around[0] && red > 0), "{around:?}");
}

#[test]
fn without_colours_characters_mark_the_side() {
    let area = Rect::new(0, 0, 20, 6);
    let mut buffer = Buffer::empty(area);
    draw_edge(&mut buffer, area, &hurt(Some(0.0)), Heading::from_degrees(90.0).unwrap());
    let marked: Vec<_> = buffer.content().iter().map(|cell| cell.symbol() == "#").collect();
    assert!((0..120).all(|index| marked[index] == (index % 20 == 0)), "{buffer:?}");
    let gain = Flash { kind: FlashKind::Gain, left: 3 };
    draw_edge(&mut buffer, area, &gain, Heading::from_degrees(0.0).unwrap());
    assert_eq!(buffer.content().iter().filter(|cell| cell.symbol() == "+").count(), 48);
    draw_edge(&mut buffer, Rect::default(), &gain, Heading::from_degrees(0.0).unwrap());
}

#[test]
fn the_view_direction_is_in_the_middle() {
    let strip = |degrees| strip(Heading::from_degrees(degrees).unwrap(), 31);
    insta::assert_snapshot!([0.0, 45.0, 90.0, 180.0, 262.0, 270.0, 359.9].map(strip).join("\n"));
    for (degrees, letter) in [(0.0, 'E'), (90.0, 'S'), (180.0, 'W'), (270.0, 'N')] {
        assert_eq!(strip(degrees).chars().nth(15), Some(letter));
    }
}

/// The colour of the outermost pixel of a grey picture under `kind` of flash; `None` for no flash.
fn edge(grey: u8, kind: Option<FlashKind>) -> Rgb {
    let mut frame = Frame::new(FrameSize::new(80, 46).unwrap(), PixelAspect::SQUARE);
    frame.rows_mut().for_each(|row| row.fill(Rgb::new(grey, grey, grey)));
    if let Some(kind) = kind {
        tint(&mut frame, &Flash { kind, left: u16::MAX }, Heading::from_degrees(0.0).unwrap());
    }
    frame.pixel(0, 23)
}

#[test]
fn everybody_can_tell_pain_from_gain_and_a_threat_from_a_sound() {
    for grey in [0, 20, 40, 70, 128, 200] {
        let kinds = [None, Some(FlashKind::Hurt { bearing: None }), Some(FlashKind::Gain)];
        let [plain, hurt, gain] = kinds.map(|kind| edge(grey, kind));
        assert_apart(&[("no flash", plain), ("hurt", hurt), ("gain", gain)]);
    }
    let color = |kind| match style(kind, ColorDepth::True).fg {
        Some(Color::Rgb(red, green, blue)) => Rgb::new(red, green, blue),
        other => panic!("{other:?} is not a colour of that depth"),
    };
    assert_apart(&[("sound", color(SoundKind::Walking)), ("threat", color(SoundKind::Shout))]);
}
