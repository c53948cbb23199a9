//! The status line below the picture, the statistics about frames, and the format of times for
//! players.
//!
//! The line is rewritten in each frame, into memory that is reused. No change has to be tracked,
//! and nothing is allocated. The line therefore shows the time of the last frame: while nothing
//! moves, no frame is drawn just to show another second.
//!
//! A part that does not fit is left out as a whole, the least important part first. Rejected:
//! cutting the line at its end. In a narrow window, the key for help would be lost.

use std::fmt::{self, Display, Write};
use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::Widget;

use crate::app::controls::{Action, Bindings, Toggles};
use crate::color::palette::ColorDepth;
use crate::game::{Alarm, Game, GuardView, Health, PlayerView, STEP, Share};
use crate::terminal::{Fidelity, Protocol};
use crate::tui::GlyphSet;
use crate::world::Supply;

/// The texts of the line: the player's location and state on the left, progress and help on the
/// right.
#[derive(Clone, Debug, Default)]
pub struct StatusLine {
    texts: [[String; 2]; PARTS],
}

/// The parts of the line, from left to right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The player's health.
    Health,
    /// The guards' alarm.
    Alarm,
    /// The amount of light on the player.
    Light,
    /// The player's supplies.
    Supplies,
    /// The level's title.
    Title,
    /// The level's number.
    Level,
    /// The position in a generated level.
    Site,
    /// The movement modes that are switched on.
    Modes,
    /// The keys that the player carries.
    Keys,
    /// The key that takes time back.
    TakeBack,
    /// The latest notice, or the goal.
    Notice,
    /// The statistics about frames and the link.
    Stats,
    /// The treasure found.
    Treasure,
    /// The share of the level that the player has seen.
    Seen,
    /// The time played.
    Time,
    /// The key that shows the help.
    Help,
}

const PARTS: usize = 16;
/// The first part at the right end of the line.
const FIRST_TO_THE_RIGHT: usize = Part::Stats as usize;

/// The short or the long form of a part. The two forms may be equal.
#[derive(Clone, Copy, Debug)]
enum PartLength {
    Short,
    Long,
}

/// The order in which forms receive space, the most important first.
const PRIORITIES: [(Part, PartLength); 22] = [
    (Part::Help, PartLength::Short),
    (Part::Health, PartLength::Short),
    (Part::Alarm, PartLength::Short),
    (Part::Notice, PartLength::Short),
    (Part::Light, PartLength::Short),
    (Part::Supplies, PartLength::Short),
    (Part::Alarm, PartLength::Long),
    (Part::TakeBack, PartLength::Short),
    (Part::Title, PartLength::Short),
    (Part::Help, PartLength::Long),
    (Part::Keys, PartLength::Short),
    (Part::Treasure, PartLength::Short),
    (Part::Modes, PartLength::Short),
    (Part::Notice, PartLength::Long),
    (Part::Time, PartLength::Short),
    (Part::Treasure, PartLength::Long),
    (Part::Supplies, PartLength::Long),
    (Part::Level, PartLength::Short),
    (Part::Site, PartLength::Short),
    (Part::Level, PartLength::Long),
    (Part::Seen, PartLength::Short),
    (Part::Keys, PartLength::Long),
];
/// The forms that come before [`PRIORITIES`] if the player has switched the statistics on. The
/// statistics take the space of the title and the goal, but not the space of the player's state.
const PRIORITIES_WITH_STATS: [(Part, PartLength); 11] = [
    (Part::Help, PartLength::Short),
    (Part::Health, PartLength::Short),
    (Part::Alarm, PartLength::Short),
    (Part::Light, PartLength::Short),
    (Part::Supplies, PartLength::Short),
    (Part::Modes, PartLength::Short),
    (Part::Keys, PartLength::Short),
    (Part::Treasure, PartLength::Short),
    (Part::Stats, PartLength::Short),
    (Part::Notice, PartLength::Short),
    (Part::Stats, PartLength::Long),
];
/// The number of blank columns between parts.
const GAP: u16 = 2;
/// The minimum widths of the title and the notice when they are cut. Three letters of a title say
/// nothing.
const MIN_TITLE_WIDTH: u16 = 8;
const MIN_NOTICE_WIDTH: u16 = 3;

impl StatusLine {
    /// Replaces all texts by the output of `write`.
    pub fn rewrite(&mut self, write: impl FnOnce(&mut Self) -> fmt::Result) {
        self.texts.iter_mut().flatten().for_each(String::clear);
        // Writing to a string never fails.
        _ = write(self);
    }

    /// The text and width of each part in a line of `width` columns. A part without space has width
    /// zero.
    fn fitted(&self, width: u16) -> [(&str, u16); PARTS] {
        let mut fitted = [("", 0); PARTS];
        let mut room = width;
        let has_stats = !self.texts[Part::Stats as usize][0].is_empty();
        let first = if has_stats { &PRIORITIES_WITH_STATS[..] } else { &[] };
        for &(part, form) in first.iter().chain(&PRIORITIES) {
            let text = self.texts[part as usize][form as usize].as_str();
            let (_, taken) = fitted[part as usize];
            let columns = Span::raw(text).width() as u16;
            if columns == 0
                || (taken == 0 && matches!(form, PartLength::Long) && part == Part::Notice)
            {
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

/// The minimum width to which a part can be cut; `None` if it is left out instead.
fn least_cut(part: Part) -> Option<u16> {
    match part {
        Part::Title => Some(MIN_TITLE_WIDTH),
        Part::Notice => Some(MIN_NOTICE_WIDTH),
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

/// Draws a text. Most texts are ASCII, and need no division into graphemes.
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

/// A line that shows a hint in place of the game's state.
pub fn hint(text: &str) -> impl Widget {
    Line::raw(text).centered().style(Style::new().add_modifier(Modifier::REVERSED))
}

impl StatusLine {
    /// Writes the movement modes, the mouse and the lamp, if they are on.
    pub fn write_modes(&mut self, toggles: Toggles, mouse: bool, lamp: bool) -> fmt::Result {
        let modes = [
            (toggles.runs, if toggles.runs_by_default { "walking" } else { "running" }),
            (toggles.ducks, "ducking"),
            (toggles.keeps_walking, "walking on"),
            (mouse, "mouse"),
            (lamp, "lamp"),
        ];
        let modes = modes.into_iter().filter(|(is_on, _)| *is_on);
        self.list(Part::Modes, modes.map(|(_, mode)| mode))
    }

    /// Writes the statistics about frames and the link.
    pub fn write_stats(&mut self, stats: &Stats) -> fmt::Result {
        let [short, long] = self.forms(Part::Stats);
        write!(short, "{}", stats.rates)?;
        write!(long, "{stats}")
    }

    /// Writes the names of the keys that the player carries.
    pub fn write_keys<'k>(&mut self, keys: impl Iterator<Item = &'k str>) -> fmt::Result {
        self.list(Part::Keys, keys.map(|key| fmt::from_fn(move |f| write!(f, "{key} key"))))
    }

    /// Writes items, separated by commas.
    fn list(&mut self, part: Part, items: impl Iterator<Item: Display>) -> fmt::Result {
        for (index, item) in items.enumerate() {
            let comma = if index > 0 { ", " } else { "" };
            self.both(part, format_args!("{comma}{item}"))?;
        }
        Ok(())
    }

    /// Writes the keys that show the help.
    pub fn write_help(&mut self, bindings: &Bindings) -> fmt::Result {
        let [short, long] = &mut self.texts[Part::Help as usize];
        for (index, key) in bindings.keys(Action::ToggleHelp).enumerate() {
            let blank = if index > 0 { " " } else { "" };
            write!(long, "{blank}{key}")?;
        }
        short.push_str(long);
        long.push_str(" help");
        Ok(())
    }

    /// The short and the long form of `part`.
    pub fn forms(&mut self, part: Part) -> &mut [String; 2] {
        &mut self.texts[part as usize]
    }

    /// Appends `text` to both forms of `part`.
    pub fn both(&mut self, part: Part, text: fmt::Arguments) -> fmt::Result {
        self.texts[part as usize].iter_mut().try_for_each(|form| form.write_fmt(text))
    }
}

/// The notation for health.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HealthSigns {
    /// A heart for each point.
    Hearts,
    /// Numbers.
    Digits,
}

/// Below the first visibility the player is in the dark. Below the second the light is dim.
const DARK: u8 = 64;
const DIM: u8 = 144;

impl HealthSigns {
    /// The notation that suits a picture with this glyph set and colour depth.
    pub fn for_picture(glyphs: GlyphSet, depth: ColorDepth) -> Self {
        let has_hearts = glyphs.has_blocks() && depth != ColorDepth::Mono;
        if has_hearts { Self::Hearts } else { Self::Digits }
    }
}

impl StatusLine {
    /// Writes health, alarm, light, supplies and treasure.
    pub fn write_vitals(
        &mut self,
        game: &Game,
        player: &PlayerView,
        signs: HealthSigns,
    ) -> fmt::Result {
        self.write_health(player.health(), signs)?;
        self.write_alarm(game, player)?;
        let light = match player.visibility() {
            0..DARK => "dark",
            DARK..DIM => "dim",
            DIM.. => "lit",
        };
        self.both(Part::Light, format_args!("{light}"))?;
        self.write_supplies(player)?;
        let Share { found, total } = game.treasure();
        if total > 0 {
            let needed = game.world().treasure_needed();
            let [short, long] = self.forms(Part::Treasure);
            write!(long, "{found} of {total} gold")?;
            match needed {
                0 => {}
                _ if found >= needed => long.push_str(", enough"),
                _ if needed == total => long.push_str(", all needed"),
                _ => write!(long, ", {needed} needed")?,
            }
            if found < needed && needed < total {
                write!(short, "{found}/{total} need {needed}")?;
            } else {
                write!(short, "{found}/{total} gold")?;
            }
        }
        Ok(())
    }

    /// Writes the alarm level, and the kind of the nearest guard at that level.
    fn write_alarm(&mut self, game: &Game, player: &PlayerView) -> fmt::Result {
        let alarm = match game.alarm() {
            Alarm::Calm => return Ok(()),
            Alarm::Wary => "wary",
            Alarm::Raised => "ALARM",
        };
        let position = player.position();
        let distance = |guard: &GuardView| guard.position.distance_squared(position);
        let guards = game.guards().filter(|guard| guard.mood.alarm() == game.alarm());
        let nearest = guards.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let [short, long] = self.forms(Part::Alarm);
        short.push_str(alarm);
        match nearest {
            Some(guard) => write!(long, "{alarm}: {}", guard.kind.name()),
            None => long.write_str(alarm),
        }
    }

    fn write_health(&mut self, health: Health, signs: HealthSigns) -> fmt::Result {
        let Health { points, most } = health;
        match signs {
            HealthSigns::Digits => self.both(Part::Health, format_args!("HP {points}/{most}")),
            HealthSigns::Hearts => (0..most).try_for_each(|index| {
                let heart = if index < points { '♥' } else { '♡' };
                self.both(Part::Health, format_args!("{heart}"))
            }),
        }
    }

    /// Writes the player's supplies: counts with first letters in the short form, with names in the
    /// long form.
    fn write_supplies(&mut self, player: &PlayerView) -> fmt::Result {
        let carried = Supply::ALL.map(|supply| (supply.name(), player.supplies(supply)));
        let [short, long] = self.forms(Part::Supplies);
        for (index, (name, count)) in carried.iter().filter(|(_, count)| *count > 0).enumerate() {
            let (blank, comma) = if index > 0 { (" ", ", ") } else { ("", "") };
            let letter = &name[..1];
            let name = if *count == 1 { &name[..name.len() - 1] } else { name };
            write!(short, "{blank}{count}{letter}")?;
            write!(long, "{comma}{count} {name}")?;
        }
        Ok(())
    }
}

/// The current statistics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stats {
    /// The rates of frames and bytes.
    pub rates: Rates,
    /// The time from sending a frame to the terminal's answer; `None` if the terminal does not
    /// answer.
    pub round_trip: Option<Duration>,
    /// The fidelity of frames.
    pub fidelity: Fidelity,
    /// `true` if the link limits the fidelity, so that compression would help.
    pub wants_compression: bool,
}

/// The rates of frames and bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    pub(crate) frames_per_second: f64,
    pub(crate) bytes_per_second: f64,
}

impl Display for Rates {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frames_per_second, bytes_per_second } = self;
        write!(f, "{frames_per_second:.0} fps  {:.0} kB/s", bytes_per_second / 1000.0)
    }
}

impl Display for Stats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}  ", self.rates)?;
        if let Some(round_trip) = self.round_trip {
            write!(f, "{} ms  ", round_trip.as_millis())?;
        }
        write!(f, "fidelity {}", self.fidelity)?;
        if self.wants_compression { f.write_str("  (ssh -C helps)") } else { Ok(()) }
    }
}

/// Measures the rates while frames follow one another. Pauses between motions do not count, so the
/// statistics need no update when motion ends.
#[derive(Debug, Default)]
pub struct Meter {
    begun: Duration,
    bytes_before: u64,
    frames: u32,
    last: Duration,
}

/// The time between two measurements.
const INTERVAL: Duration = Duration::from_millis(500);
/// The shortest time without frames that counts as a pause.
const MIN_PAUSE: Duration = Duration::from_millis(500);

impl Meter {
    /// Counts a frame that `protocol` has drawn. Returns new statistics when they are due.
    pub fn measure(&mut self, protocol: &Protocol, now: Duration) -> Option<Stats> {
        let rates = self.frame(now, protocol.bytes_drawn())?;
        let (round_trip, fidelity) = (protocol.round_trip(), protocol.fidelity());
        let wants_compression = protocol.is_limited_by_network();
        Some(Stats { rates, round_trip, fidelity, wants_compression })
    }

    /// Counts a frame; `bytes` is the total number of bytes up to now. Returns new rates when they
    /// are due.
    fn frame(&mut self, now: Duration, bytes: u64) -> Option<Rates> {
        let pauses = now.saturating_sub(self.last) > MIN_PAUSE;
        let elapsed = now.saturating_sub(self.begun);
        self.frames += 1;
        self.last = now;
        if !pauses && elapsed < INTERVAL {
            return None;
        }
        let rates = Rates {
            frames_per_second: f64::from(self.frames) / elapsed.as_secs_f64(),
            bytes_per_second: bytes.saturating_sub(self.bytes_before) as f64
                / elapsed.as_secs_f64(),
        };
        *self = Self { begun: now, bytes_before: bytes, frames: 0, last: now };
        (!pauses).then_some(rates)
    }
}

/// Formats a time as minutes and seconds.
pub fn whole_seconds(seconds: f64) -> impl Display {
    let seconds = seconds as u64;
    fmt::from_fn(move |f| write!(f, "{}:{:02}", seconds / 60, seconds % 60))
}

/// Formats a time as minutes, seconds and tenths.
pub fn tenths(seconds: f64) -> String {
    let all = (seconds * 10.0) as u64;
    format!("{}:{:02}.{}", all / 600, all / 10 % 60, all % 10)
}

/// Formats the duration of `steps` steps of a game as minutes, seconds and tenths.
pub fn of_steps(steps: u64) -> String {
    tenths(steps as f64 * STEP)
}

#[cfg(test)]
mod tests;
