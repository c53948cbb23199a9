//! The status line below the picture.
//!
//! It is rewritten in each frame, into memory that is kept: no change must be tracked, and nothing
//! is allocated. Its time is therefore that of the last frame: while nothing moves, no frame is
//! drawn to show another second.
//!
//! Parts that do not fit are left out as a whole, the least important first. Cutting the line at
//! its end was refused: in a narrow window, the key for help would be lost.

mod write;

use std::fmt;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::Widget;

use super::goal::Goal;
use super::levels::LevelNumber;
use super::played::Played;
use super::stats::Stats;
use super::vitals::HealthSigns;
use crate::app::bindings::Bindings;

/// The modes of motion that are switched on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Toggles {
    pub runs: bool,
    pub ducks: bool,
    pub keeps_walking: bool,
}

/// The values that the line shows.
pub(crate) struct StatusValues<'a> {
    pub(crate) game: &'a Played,
    pub(crate) goal: &'a Goal,
    pub(crate) notice: Option<&'a Goal>,
    pub(crate) level: LevelNumber,
    /// The share of the level that has been seen, from 0 to 1, if that is counted.
    pub(crate) share_seen: Option<f64>,
    pub(crate) toggles: Toggles,
    /// Whether the mouse turns the player.
    pub(crate) mouse: bool,
    pub(crate) stats: Option<&'a Stats>,
    pub(crate) bindings: &'a Bindings,
    pub(crate) health_signs: HealthSigns,
}

/// The texts of the line: place and state of the player at the left; progress and help at the
/// right.
#[derive(Clone, Debug, Default)]
pub struct StatusLine {
    texts: [[String; 2]; PARTS],
}

/// The parts of the line, from left to right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    Health,
    Alarm,
    Light,
    Supplies,
    Title,
    Level,
    Site,
    Modes,
    Keys,
    Notice,
    Stats,
    Treasure,
    Seen,
    Time,
    Help,
}

const PARTS: usize = 15;
/// The first part at the right end of the line.
const FIRST_TO_THE_RIGHT: usize = Part::Stats as usize;

/// A part has a short and a long form, which may be equal.
#[derive(Clone, Copy, Debug)]
enum Form {
    Short,
    Long,
}

/// The forms in the order in which they get room, the most important first.
const PRIORITIES: [(Part, Form); 21] = [
    (Part::Help, Form::Short),
    (Part::Health, Form::Short),
    (Part::Alarm, Form::Short),
    (Part::Notice, Form::Short),
    (Part::Light, Form::Short),
    (Part::Supplies, Form::Short),
    (Part::Alarm, Form::Long),
    (Part::Title, Form::Short),
    (Part::Help, Form::Long),
    (Part::Keys, Form::Short),
    (Part::Treasure, Form::Short),
    (Part::Modes, Form::Short),
    (Part::Notice, Form::Long),
    (Part::Time, Form::Short),
    (Part::Treasure, Form::Long),
    (Part::Supplies, Form::Long),
    (Part::Level, Form::Short),
    (Part::Site, Form::Short),
    (Part::Level, Form::Long),
    (Part::Seen, Form::Short),
    (Part::Keys, Form::Long),
];
/// The forms that come before those where the player has asked for stats: the stats take the room of
/// the title and the goal, and yield to the state of the player.
const PRIORITIES_WITH_STATS: [(Part, Form); 11] = [
    (Part::Help, Form::Short),
    (Part::Health, Form::Short),
    (Part::Alarm, Form::Short),
    (Part::Light, Form::Short),
    (Part::Supplies, Form::Short),
    (Part::Modes, Form::Short),
    (Part::Keys, Form::Short),
    (Part::Treasure, Form::Short),
    (Part::Stats, Form::Short),
    (Part::Notice, Form::Short),
    (Part::Stats, Form::Long),
];
/// The number of blank columns of each part.
const GAP: u16 = 2;
/// The least widths to which the title and the notice are cut. Three letters of a title say nothing.
const LEAST_TITLE: u16 = 8;
const LEAST_NOTICE: u16 = 3;

impl StatusLine {
    /// Updates the texts.
    pub(crate) fn update(&mut self, values: &StatusValues) {
        self.rewrite(|line| line.write(values));
    }

    /// Replaces all texts by those that `write` writes.
    pub fn rewrite(&mut self, write: impl FnOnce(&mut Self) -> fmt::Result) {
        self.texts.iter_mut().flatten().for_each(String::clear);
        // Writing to a string never fails.
        _ = write(self);
    }

    /// The text and the width of each part that a line of `width` columns has room for.
    fn fitted(&self, width: u16) -> [(&str, u16); PARTS] {
        let mut fitted = [("", 0); PARTS];
        let mut room = width;
        let has_stats = !self.texts[Part::Stats as usize][0].is_empty();
        let first = if has_stats { &PRIORITIES_WITH_STATS[..] } else { &[] };
        for &(part, form) in first.iter().chain(&PRIORITIES) {
            let text = self.texts[part as usize][form as usize].as_str();
            let (_, taken) = fitted[part as usize];
            let columns = Span::raw(text).width() as u16;
            if columns == 0 || (taken == 0 && matches!(form, Form::Long) && part == Part::Notice) {
                continue;
            }
            let before = if taken == 0 { 0 } else { taken + GAP };
            let free = room + before;
            let granted = if columns + GAP <= free {
                columns
            } else if taken == 0 && least_cut(part).is_some_and(|least| free >= least + GAP) {
                free - GAP
            } else {
                continue;
            };
            fitted[part as usize] = (text, granted);
            room = free - granted - GAP;
        }
        fitted
    }
}

/// The least width to which a part can be cut; `None` if it is left out instead.
fn least_cut(part: Part) -> Option<u16> {
    match part {
        Part::Title => Some(LEAST_TITLE),
        Part::Notice => Some(LEAST_NOTICE),
        _ => None,
    }
}

impl Widget for &StatusLine {
    fn render(self, area: Rect, buffer: &mut Buffer) {
        let fitted = self.fitted(area.width);
        let (left, right) = fitted.split_at(FIRST_TO_THE_RIGHT);
        let shown = |parts: &[(&str, u16)]| parts.iter().filter(|part| part.1 > 0).count();
        let columns: u16 = right.iter().map(|&(_, columns)| columns).sum();
        let gaps = (shown(right) as u16).saturating_mul(GAP);
        let to_the_right = area.right().saturating_sub((columns + gaps).saturating_sub(1));
        for (mut x, parts) in [(area.x + 1, left), (to_the_right, right)] {
            for &(text, width) in parts.iter().filter(|part| part.1 > 0) {
                draw_text(text, Rect { x, width, ..area }, buffer);
                x += width + GAP;
            }
        }
        buffer.set_style(area, Style::new().add_modifier(Modifier::REVERSED));
    }
}

/// Draws a text. Most are ASCII, which needs no division into graphemes.
fn draw_text(text: &str, area: Rect, buffer: &mut Buffer) {
    if !text.bytes().all(|byte| matches!(byte, b' '..=b'~')) {
        return Span::raw(text).render(area, buffer);
    }
    for (x, byte) in (area.left()..area.right()).zip(text.bytes()) {
        if let Some(cell) = buffer.cell_mut((x, area.y)) {
            cell.set_char(byte.into());
        }
    }
}

/// A line with a hint instead of the game's state.
pub fn hint(text: &str) -> impl Widget {
    Line::raw(text).centered().style(Style::new().add_modifier(Modifier::REVERSED))
}

#[cfg(test)]
mod tests;
