//! The settings screen.
//!
//! The store keeps what the player chooses here, except the map and the mouse, which a game begins with
//! as the configuration file says. A flag or the configuration file wins over what is kept, and the
//! screen names it beside the value. The program never writes the configuration file.

use std::num::NonZeroU32;
use std::time::Duration;

use super::menu::Menu;
use super::menus::Choice;
use super::{App, Given, MapDisplay, Origin};
use crate::app::store::Preferences;
use crate::color::palette::ColorDepth;
use crate::tui::{Correction, GlyphSet};
use crate::world::Difficulty;

/// A setting on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Setting {
    Difficulty,
    Crosshair,
    Compass,
    Ghost,
    Bell,
    Minimap,
    Mouse,
    Glyphs,
    Colors,
    Correction,
    FrameRate,
}

/// The settings in their order on the screen.
const SETTINGS: [(Setting, &str); 11] = [
    (Setting::Difficulty, "Difficulty"),
    (Setting::Crosshair, "Crosshair"),
    (Setting::Compass, "Compass"),
    (Setting::Ghost, "Ghost of the best run"),
    (Setting::Bell, "Bell when noticed or hurt"),
    (Setting::Minimap, "Map"),
    (Setting::Mouse, "Mouse turns"),
    (Setting::Glyphs, "Characters"),
    (Setting::Colors, "Colours"),
    (Setting::Correction, "Picture"),
    (Setting::FrameRate, "Frames a second"),
];

const FRAME_RATES: [u32; 4] = [15, 30, 60, 120];
pub const GLYPHS: [(GlyphSet, &str); 6] = [
    (GlyphSet::Half, "half blocks"),
    (GlyphSet::Quadrant, "quadrants"),
    (GlyphSet::Sextant, "sextants"),
    (GlyphSet::Octant, "octants"),
    (GlyphSet::Ascii, "ASCII"),
    (GlyphSet::Ramp, "ramp"),
];
pub const COLORS: [(Option<ColorDepth>, &str); 5] = [
    (None, "the terminal's"),
    (Some(ColorDepth::True), "all"),
    (Some(ColorDepth::Indexed256), "256"),
    (Some(ColorDepth::Indexed16), "16"),
    (Some(ColorDepth::Mono), "none"),
];

pub const CORRECTIONS: [(Correction, &str); 3] = [
    (Correction::None, "as it is"),
    (Correction::Contrast, "more contrast"),
    (Correction::RedGreen, "red and green apart"),
];

impl App {
    pub(crate) fn settings_menu(&self) -> Menu<Choice> {
        let menu = Menu::new("settings").line("Enter or left and right change a setting.");
        let menu = if self.detection.ascii_locale.is_some() { menu } else { with_card(menu) };
        let menu = if self.settings.given == Given::default() {
            menu
        } else {
            menu.line("A flag or the file holds again at the next start.")
        };
        SETTINGS.into_iter().fold(menu, |menu, (setting, label)| {
            menu.entry_with(label, self.value_of(setting), Choice::Change(setting))
        })
    }

    /// Changes `setting` to its next value, or to the one before if `forward` is false.
    pub(crate) fn change_setting(&mut self, setting: Setting, forward: bool) {
        let before = self.store.preferences();
        let mut preferences = before;
        match setting {
            Setting::Difficulty => {
                preferences.difficulty =
                    after(&Difficulty::ALL, |&one| one == before.difficulty, forward);
            }
            Setting::Crosshair => preferences.crosshair ^= true,
            Setting::Compass => preferences.compass ^= true,
            Setting::Ghost => preferences.ghost ^= true,
            Setting::Bell => preferences.bell ^= true,
            Setting::Minimap => self.map.is_shown ^= true,
            Setting::Mouse => self.pointer.toggle(),
            Setting::Glyphs => {
                let before = self.settings.glyphs;
                let glyphs = after(&GLYPHS, |one| one.0 == before, forward).0;
                self.settings.glyphs = glyphs;
                self.settings.given.glyphs = None;
                preferences.glyphs = Some(glyphs);
            }
            Setting::Colors => {
                let depth = self.settings.depth;
                self.settings.depth = after(&COLORS, |one| one.0 == depth, forward).0;
                self.settings.given.depth = None;
                preferences.colors = self.settings.depth;
                self.depth = self.settings.depth.unwrap_or(self.terminal.depth);
            }
            Setting::Correction => {
                let correction = before.correction;
                preferences.correction = after(&CORRECTIONS, |it| it.0 == correction, forward).0;
            }
            Setting::FrameRate => {
                let rate = self.frame_rate();
                let rate = after(&FRAME_RATES, |&one| one >= rate, forward);
                self.settings.frame_time = Duration::from_secs(1) / rate;
                self.settings.given.frame_time = None;
                preferences.frames_per_second = NonZeroU32::new(rate);
            }
        }
        self.set_preferences(preferences);
        self.renew_menu();
    }

    /// Keeps `preferences`, and follows them.
    pub(crate) fn set_preferences(&mut self, preferences: Preferences) {
        self.store.set_preferences(preferences);
        self.shown = None;
    }

    fn value_of(&self, setting: Setting) -> String {
        let Preferences { crosshair, compass, bell, ghost, difficulty, correction, .. } =
            self.store.preferences();
        let Given { glyphs, depth, frame_time } = self.settings.given;
        match setting {
            Setting::Difficulty => difficulty.name().to_owned(),
            Setting::Crosshair => on_or_off(crosshair),
            Setting::Compass => on_or_off(compass),
            Setting::Ghost => on_or_off(ghost),
            Setting::Bell => on_or_off(bell),
            Setting::Minimap => match (self.map.is_shown, self.settings.minimap) {
                (false, _) => on_or_off(false),
                (true, MapDisplay::All) => "all".to_owned(),
                (true, _) => "what was seen".to_owned(),
            },
            Setting::Mouse => on_or_off(self.pointer.is_on()),
            Setting::Glyphs => given(name(&GLYPHS, self.settings.glyphs), glyphs),
            Setting::Colors => given(name(&COLORS, self.settings.depth), depth),
            Setting::Correction => name(&CORRECTIONS, correction),
            Setting::FrameRate => given(self.frame_rate().to_string(), frame_time),
        }
    }

    fn frame_rate(&self) -> u32 {
        (1.0 / self.settings.frame_time.as_secs_f64().max(1e-3)).round() as u32
    }
}

/// Adds a card that shows which characters the terminal has.
pub fn with_card<C: Copy>(menu: Menu<C>) -> Menu<C> {
    let menu = menu.line("Of these, the last smooth wedge is the best for you:");
    let sets = GLYPHS.into_iter().filter(|(set, _)| set.has_blocks());
    sets.fold(menu, |menu, (set, name)| menu.line(format!("{name:·<12} {}", set.wedge())))
}

/// `value` and where it is given.
fn given(value: String, origin: Option<Origin>) -> String {
    match origin {
        Some(Origin::Flag) => value + " (flag)",
        Some(Origin::File) => value + " (file)",
        None => value,
    }
}

pub fn on_or_off(is_on: bool) -> String {
    if is_on { "on" } else { "off" }.to_owned()
}

pub fn name<T: Copy + PartialEq>(names: &[(T, &str)], value: T) -> String {
    names.iter().find(|(named, _)| *named == value).map_or("", |(_, name)| name).to_owned()
}

/// The value after the one that `is_it`, or before it; from the last, the first.
pub fn after<T: Copy>(values: &[T], is_it: impl Fn(&T) -> bool, forward: bool) -> T {
    let index = values.iter().position(is_it).unwrap_or(0);
    let by = if forward { 1 } else { values.len() - 1 };
    values[(index + by) % values.len()]
}
