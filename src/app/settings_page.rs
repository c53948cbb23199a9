//! The settings page, at home and in a session on a server.
//!
//! A page is a table of [`Setting`]s. Its owner collects the values in force, has a row change them, and takes over
//! the difference.
//!
//! The store keeps what the player chooses here, except the map and the mouse, which a game begins with
//! as the configuration file says. A flag or the configuration file wins over what is kept, and the
//! page names it beside the value. The program never writes the configuration file.

use std::num::NonZeroU32;
use std::time::Duration;

use crate::app::App;
use crate::app::menu::Menu;
use crate::app::screen::Choice;
use crate::app::setting::{At, Choice as _, Setting};
use crate::app::settings::{Given, MapDisplay, Origin, Settings};
use crate::app::store::Preferences;
use crate::tui::GlyphSet;

/// The values that every settings page shows and changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choices {
    /// The choices that are kept from one game to the next.
    pub preferences: Preferences,
    /// Whether the mouse turns the player.
    pub mouse: bool,
    /// The content of the map.
    pub map: MapDisplay,
}

impl AsMut<Self> for Choices {
    fn as_mut(&mut self) -> &mut Self {
        self
    }
}

impl AsMut<Preferences> for Choices {
    fn as_mut(&mut self) -> &mut Preferences {
        &mut self.preferences
    }
}

/// The settings of a game that is played, with their labels.
impl<C: AsMut<Choices> + Clone> Setting<C> {
    /// Whether the mouse turns the player.
    pub const MOUSE: Self =
        Self::new("mouse", "Mouse turns", &At(|it: &mut C| &mut it.as_mut().mouse));
    /// The content of the map.
    pub const MAP: Self = Self::new("minimap", "Map", &At(|it: &mut C| &mut it.as_mut().map));
}

/// The rows in their order on the page.
const ROWS: [Setting<Choices>; 11] = [
    Setting::DIFFICULTY,
    Setting::CROSSHAIR,
    Setting::COMPASS,
    Setting::GHOST,
    Setting::BELL,
    Setting::MAP,
    Setting::MOUSE,
    Setting::GLYPHS,
    Setting::COLORS,
    Setting::CORRECTION,
    Setting::FRAME_RATE,
];

impl App {
    pub(crate) fn settings_menu(&self) -> Menu<Choice> {
        let given = self.settings.given;
        let note = (given != Given::default())
            .then_some("A flag or the file holds again at the next start.");
        let choices = self.choices();
        let rows = ROWS.iter().enumerate().map(|(index, row)| {
            let value = row.value.label(&choices) + origin(given, row.key);
            (row.about, value, Choice::Change(index))
        });
        settings_menu(note, self.detection.ascii_locale.is_none(), rows)
    }

    /// The values in force.
    fn choices(&self) -> Choices {
        Choices {
            preferences: self.settings.in_force(self.store.preferences()),
            mouse: self.pointer.is_on(),
            map: self.map.display(),
        }
    }

    /// Changes the setting in that row to its next value, or to the one before if `forward` is false.
    pub(crate) fn change_setting(&mut self, row: usize, forward: bool) {
        self.change_choices(|choices| ROWS[row].value.change(choices, forward));
    }

    /// Changes the difficulty of new games.
    pub(crate) fn change_difficulty(&mut self, forward: bool) {
        self.change_choices(|choices| {
            let difficulty = &mut choices.preferences.difficulty;
            *difficulty = difficulty.neighbour(forward);
        });
    }

    fn change_choices(&mut self, change: impl FnOnce(&mut Choices)) {
        let before = self.choices();
        let mut after = before;
        change(&mut after);
        self.settings.follow(&before.preferences, &after.preferences);
        self.prefer(|kept| kept.choose(before.preferences, after.preferences));
        self.map.is_shown = after.map != MapDisplay::Off;
        if after.mouse != before.mouse {
            self.pointer.toggle();
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
    let origin = match key {
        "glyphs" => given.glyphs,
        "colors" => given.depth,
        "fps" => given.frame_time,
        _ => None,
    };
    match origin {
        Some(Origin::Flag) => " (flag)",
        Some(Origin::File) => " (file)",
        None => "",
    }
}

/// A settings page with a note, perhaps a card that shows which characters the terminal has, and rows with their
/// labels, values and choices.
pub fn settings_menu<C: Copy>(
    note: Option<&str>,
    has_card: bool,
    rows: impl Iterator<Item = (&'static str, String, C)>,
) -> Menu<C> {
    let menu = Menu::new("settings").line("Enter or left and right change a setting.");
    let menu = note.into_iter().fold(menu, Menu::line);
    let menu = if has_card { with_card(menu) } else { menu };
    rows.fold(menu, |menu, (label, value, choice)| menu.entry_with(label, value, choice))
}

fn with_card<C: Copy>(menu: Menu<C>) -> Menu<C> {
    let menu = menu.line("Of these, the last smooth wedge is the best for you:");
    let sets = GlyphSet::ALL.iter().filter(|(set, ..)| set.has_blocks());
    sets.fold(menu, |menu, (set, _, name)| menu.line(format!("{name:·<12} {}", set.wedge())))
}
