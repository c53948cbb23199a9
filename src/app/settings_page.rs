//! The settings page.
//!
//! The store keeps what the player chooses here, except the map and the mouse, which a game begins with
//! as the configuration file says. A flag or the configuration file wins over what is kept, and the
//! page names it beside the value. The program never writes the configuration file.

use std::num::NonZeroU32;
use std::time::Duration;

use crate::app::App;
use crate::app::menu::Menu;
use crate::app::menus::Choice;
use crate::app::setting::{Choice as _, Setting, Value};
use crate::app::settings::{Given, MapDisplay, Origin, Settings};
use crate::app::store::Preferences;
use crate::app::store::preferences::{
    BELL, COLORS, COMPASS, CORRECTION, CROSSHAIR, DIFFICULTY, FRAME_RATE, GHOST, GLYPHS,
};
use crate::tui::GlyphSet;

/// A row of the page.
enum Row {
    Kept(Setting<Preferences>),
    Map,
    Mouse,
}

/// The rows in their order on the page.
const ROWS: [Row; 11] = [
    Row::Kept(DIFFICULTY),
    Row::Kept(CROSSHAIR),
    Row::Kept(COMPASS),
    Row::Kept(GHOST),
    Row::Kept(BELL),
    Row::Map,
    Row::Mouse,
    Row::Kept(GLYPHS),
    Row::Kept(COLORS),
    Row::Kept(CORRECTION),
    Row::Kept(FRAME_RATE),
];
/// The index of the difficulty, which menus of levels change, too.
pub(crate) const DIFFICULTY_ROW: usize = 0;

impl App {
    pub(crate) fn settings_menu(&self) -> Menu<Choice> {
        let menu = Menu::new("settings").line("Enter or left and right change a setting.");
        let menu = if self.detection.ascii_locale.is_some() { menu } else { with_card(menu) };
        let menu = if self.settings.given == Given::default() {
            menu
        } else {
            menu.line("A flag or the file holds again at the next start.")
        };
        let in_force = self.settings.in_force(self.store.preferences());
        ROWS.iter().enumerate().fold(menu, |menu, (index, row)| {
            let (label, value) = match row {
                Row::Kept(setting) => {
                    let value = setting.value.label(&in_force);
                    (setting.about, value + origin(self.settings.given, setting.key))
                }
                Row::Map => ("Map", self.map_value()),
                Row::Mouse => ("Mouse turns", self.pointer.is_on().label()),
            };
            menu.entry_with(label, value, Choice::Change(index))
        })
    }

    fn map_value(&self) -> String {
        match (self.map.is_shown, self.settings.minimap) {
            (false, _) => false.label(),
            (true, MapDisplay::All) => MapDisplay::All.label(),
            (true, _) => MapDisplay::Seen.label(),
        }
    }

    /// Changes the setting in that row to its next value, or to the one before if `forward` is false.
    pub(crate) fn change_setting(&mut self, row: usize, forward: bool) {
        match &ROWS[row] {
            Row::Map => self.map.is_shown ^= true,
            Row::Mouse => self.pointer.toggle(),
            Row::Kept(setting) => {
                let before = self.settings.in_force(self.store.preferences());
                let mut after = before;
                setting.value.change(&mut after, forward);
                self.settings.follow(&before, &after);
                self.prefer(|kept| setting.value.copy(&after, kept));
            }
        }
        self.renew_menu();
    }
}

impl Settings {
    /// `preferences`, with what is in force in place of what was chosen.
    fn in_force(&self, preferences: Preferences) -> Preferences {
        let rate = (1.0 / self.frame_time.as_secs_f64().max(1e-3)).round() as u32;
        Preferences {
            glyphs: Some(self.glyphs),
            colors: self.depth,
            frames_per_second: NonZeroU32::new(rate),
            ..preferences
        }
    }

    /// Follows a choice of the player, which wins over flags and the file from now on.
    fn follow(&mut self, before: &Preferences, after: &Preferences) {
        if let Some(glyphs) = after.glyphs.filter(|_| after.glyphs != before.glyphs) {
            self.glyphs = glyphs;
            self.given.glyphs = None;
        }
        if after.colors != before.colors {
            self.depth = after.colors;
            self.given.depth = None;
        }
        let rate = after.frames_per_second;
        if let Some(rate) = rate.filter(|_| rate != before.frames_per_second) {
            self.frame_time = Duration::from_secs(1) / rate.get();
            self.given.frame_time = None;
        }
    }
}

/// Says where the setting `key` is given.
fn origin(given: Given, key: &str) -> &'static str {
    let given =
        [(GLYPHS.key, given.glyphs), (COLORS.key, given.depth), (FRAME_RATE.key, given.frame_time)];
    match given.into_iter().find(|(known, _)| *known == key).and_then(|(_, origin)| origin) {
        Some(Origin::Flag) => " (flag)",
        Some(Origin::File) => " (file)",
        None => "",
    }
}

/// Adds a card that shows which characters the terminal has.
pub fn with_card<C: Copy>(menu: Menu<C>) -> Menu<C> {
    let menu = menu.line("Of these, the last smooth wedge is the best for you:");
    let sets = GlyphSet::ALL.iter().filter(|(set, ..)| set.has_blocks());
    sets.fold(menu, |menu, (set, _, name)| menu.line(format!("{name:·<12} {}", set.wedge())))
}
