//! Sounds, shown at the edge of the picture: where they come from, what they are, how loud.
//!
//! The edge is a ring around the player as seen from above: a sound ahead is at the top, one from
//! behind at the bottom. A mark is an arrow and one to three characters by the strength; each kind
//! of sound has its own character, so that colours are not needed. A sound of a guard who has
//! noticed the player, or strikes, is also said in a word. Marks that would cover each other move
//! aside: a louder one keeps its place.

use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::Line;

use crate::color::palette::ColorDepth;
use crate::game::{Heard, SoundKind};
use crate::sort;
use crate::tui::canvas::Canvas;
use crate::world::Heading;

/// The most marks that are shown.
const MOST: usize = 8;
/// The rows at the top that other panels use.
const ROWS_ABOVE: u16 = 1;
/// The columns of a picture with room for words.
const COLUMNS_FOR_WORDS: u16 = 40;

/// Draws a mark for each of `heard`, as heard in the direction of view `heading`.
pub fn draw(
    canvas: &mut impl Canvas,
    picture: Rect,
    heard: &[Heard],
    heading: Heading,
    depth: ColorDepth,
) {
    if heard.is_empty() || picture.height <= ROWS_ABOVE + 2 || picture.width < 20 {
        return;
    }
    let ring = Rect { y: picture.y + ROWS_ABOVE, height: picture.height - ROWS_ABOVE, ..picture };
    let mut loudest: Vec<&Heard> = heard.iter().collect();
    sort::by_key(&mut loudest, |heard| (!is_threat(heard.kind), u8::MAX - heard.strength));
    let mut taken: Vec<Rect> = Vec::new();
    for heard in loudest.into_iter().take(MOST) {
        let text = mark(heard, heading, picture.width >= COLUMNS_FOR_WORDS);
        let Some(area) = free_place(ring, angle(heard, heading), &text, &taken) else { continue };
        canvas.draw_widget(Line::raw(text).style(style(heard.kind, depth)), area);
        taken.push(area);
    }
}

/// Whether the sound means that somebody has noticed the player or is about to strike.
fn is_threat(kind: SoundKind) -> bool {
    word(kind).is_some()
}

/// What the guard does from whom the sound comes, if it is a threat to the player.
const fn word(kind: SoundKind) -> Option<&'static str> {
    match kind {
        SoundKind::Wonder => Some("wonders"),
        SoundKind::Shout => Some("shouts"),
        SoundKind::Bell => Some("rings"),
        SoundKind::Bark => Some("barks"),
        SoundKind::Windup => Some("attacks"),
        SoundKind::Draw => Some("aims"),
        SoundKind::Shot => Some("shoots"),
        SoundKind::Swing => Some("strikes"),
        _ => None,
    }
}

/// The character of a kind of sound.
const fn character(kind: SoundKind) -> char {
    match kind {
        SoundKind::Walking => '.',
        SoundKind::Running => ':',
        SoundKind::Landing => '_',
        SoundKind::Splash => '~',
        SoundKind::Door => '+',
        SoundKind::Mechanism => '=',
        SoundKind::Spikes => 'i',
        SoundKind::Knock => 'o',
        SoundKind::Crash => '*',
        SoundKind::Blow => 'x',
        SoundKind::Cry => 'a',
        SoundKind::Fall => 'u',
        SoundKind::Wonder => '?',
        SoundKind::GiveUp => ',',
        SoundKind::Shout => '!',
        SoundKind::Bell => '&',
        SoundKind::Bark => 'w',
        SoundKind::Windup => '/',
        SoundKind::Draw => ')',
        SoundKind::Shot => '-',
        SoundKind::Swing => '\\',
    }
}

/// The angle from the direction of view to the sound, clockwise, from −180 to 180 degrees.
fn angle(heard: &Heard, heading: Heading) -> f64 {
    let clockwise = heard.bearing.degrees() - heading.degrees();
    (clockwise + 540.0).rem_euclid(360.0) - 180.0
}

/// The side of the ring on which a sound at `angle` is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Ahead,
    Right,
    Behind,
    Left,
}

impl Side {
    fn of(angle: f64) -> Self {
        match angle {
            -45.0..=45.0 => Self::Ahead,
            45.0..=135.0 => Self::Right,
            -135.0..=-45.0 => Self::Left,
            _ => Self::Behind,
        }
    }
}

fn mark(heard: &Heard, heading: Heading, has_words: bool) -> String {
    let strength = usize::from(heard.strength.clamp(1, 3));
    let characters: String = std::iter::repeat_n(character(heard.kind), strength).collect();
    let word = word(heard.kind).filter(|_| has_words);
    let characters = match (word, Side::of(angle(heard, heading))) {
        (None, _) => characters,
        (Some(word), Side::Right) => format!("{word} {characters}"),
        (Some(word), _) => format!("{characters} {word}"),
    };
    match Side::of(angle(heard, heading)) {
        Side::Ahead => format!("^{characters}"),
        Side::Right => format!("{characters}>"),
        Side::Behind => format!("v{characters}"),
        Side::Left => format!("<{characters}"),
    }
}

/// The place of `text` on the ring, or the nearest one that is not taken.
fn free_place(ring: Rect, angle: f64, text: &str, taken: &[Rect]) -> Option<Rect> {
    let width = text.chars().count() as u16;
    let place = place(ring, angle, width);
    let along_a_side = matches!(Side::of(angle), Side::Left | Side::Right);
    let moved = |by: i32| {
        let (by_x, by_y) = if along_a_side { (0, by) } else { (by * i32::from(width + 1), 0) };
        let x = u16::try_from(i32::from(place.x) + by_x).ok()?;
        let y = u16::try_from(i32::from(place.y) + by_y).ok()?;
        let moved = Rect { x, y, ..place };
        (ring.intersection(moved) == moved).then_some(moved)
    };
    let nearest = (0..MOST as i32).flat_map(|by| [by, -by]);
    nearest.filter_map(moved).find(|place| taken.iter().all(|other| !other.intersects(*place)))
}

/// The place of a mark `width` columns wide.
fn place(ring: Rect, angle: f64, width: u16) -> Rect {
    let spare = [ring.width - width, ring.height - 1].map(f64::from);
    // From 0 to 1 along the side: from the left to the right, or from the top to the bottom.
    let along = |angle: f64| ((angle + 45.0) / 90.0).clamp(0.0, 1.0);
    let (x, y) = match Side::of(angle) {
        Side::Ahead => (along(angle), 0.0),
        Side::Right => (1.0, along(angle - 90.0)),
        Side::Left => (0.0, 1.0 - along(angle + 90.0)),
        Side::Behind => (1.0 - along(angle - 180.0_f64.copysign(angle)), 1.0),
    };
    Rect {
        x: ring.x + (x * spare[0]).round() as u16,
        y: ring.y + (y * spare[1]).round() as u16,
        width,
        height: 1,
    }
}

fn style(kind: SoundKind, depth: ColorDepth) -> Style {
    let bold = Style::new().add_modifier(Modifier::BOLD);
    match (depth, is_threat(kind)) {
        (ColorDepth::Mono, false) => Style::new().add_modifier(Modifier::REVERSED),
        (ColorDepth::Mono, true) => bold.add_modifier(Modifier::REVERSED),
        (ColorDepth::Indexed16, false) => Style::new().fg(Color::Indexed(14)),
        (ColorDepth::Indexed16, true) => bold.fg(Color::Indexed(9)),
        (ColorDepth::Indexed256, false) => Style::new().fg(Color::Indexed(153)),
        (ColorDepth::Indexed256, true) => bold.fg(Color::Indexed(203)),
        (ColorDepth::True, false) => Style::new().fg(Color::Rgb(0xa8, 0xd0, 0xf0)),
        (ColorDepth::True, true) => bold.fg(Color::Rgb(0xff, 0x60, 0x50)),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use ratatui::buffer::{Buffer, Cell};

    use super::*;

    fn heard(degrees: f64, kind: SoundKind, strength: u8) -> Heard {
        Heard { bearing: Heading::from_degrees(degrees).unwrap(), strength, kind, left: 30 }
    }

    fn shown(heard: &[Heard], heading: f64, (columns, rows): (u16, u16)) -> String {
        let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
        let heading = Heading::from_degrees(heading).unwrap();
        draw(&mut buffer, Rect::new(0, 0, columns, rows), heard, heading, ColorDepth::Mono);
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
    fn any_direction_and_window_is_possible() {
        for (columns, rows) in [(80, 23), (20, 5), (19, 5), (20, 3), (1, 1)] {
            for tenth in 0..3600 {
                let heading = f64::from(tenth * 7) / 10.0;
                shown(
                    &[heard(f64::from(tenth) / 10.0, SoundKind::Fall, 9)],
                    heading,
                    (columns, rows),
                );
            }
        }
    }

    #[test]
    fn each_kind_has_its_own_character() {
        use SoundKind::*;
        let kinds = [
            Walking, Running, Landing, Splash, Door, Mechanism, Spikes, Knock, Crash, Blow, Cry,
            Fall, Wonder, GiveUp, Shout, Bell, Bark, Windup, Draw, Shot, Swing,
        ];
        let characters: BTreeSet<char> = kinds.into_iter().map(character).collect();
        assert_eq!(characters.len(), kinds.len());
        assert!(characters.iter().all(char::is_ascii_graphic));
    }
}
