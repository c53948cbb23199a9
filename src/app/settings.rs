//! Settings: how the game is shown and controlled, the file for them, and the settings page.
//!
//! ```toml
//! preset = "azerty"            # or "qwerty", or "hjkl"
//! colors = "256"
//! minimap = "all"
//!
//! [keys]                       # the keys of an action, in place of the preset's
//! forward = ["z", "up"]
//! toggle-run = "c"
//! ```
//!
//! A [`Configuration`] is the content of such a file. The command line takes precedence over it.
//! All faults in a file are reported in one run, each with its place.
//!
//! - A key that the file binds to an action loses its action in the preset.
//! - A key bound to two actions is a fault.
//! - An empty list leaves an action without a key.
//!
//! A settings page is a table of [`Setting`]s, both at home and in a session on a server. Its owner
//! collects the current values, lets a row change them, and applies the difference.
//!
//! The store keeps the player's choices on this page, apart from the map and the mouse, which start
//! as the configuration file says. A flag or the configuration file overrides a stored choice, and
//! the page says so beside the value. Keys that the player chooses on the page of keys apply over
//! the file, which gives the usual keys. The program never writes the configuration file.

use std::fmt;
use std::num::NonZeroU32;
use std::ops::Range;
use std::time::Duration;

use toml::de::{DeTable, DeValue};

use crate::app::App;
use crate::app::controls::{Action, Bindings, Preset};
use crate::app::page::Menu;
use crate::app::screen;
use crate::app::setting::{
    Choice, FRAME_RATE, Field, FieldAt, MapDisplay, Preferences, Setting, ViewAngle,
};
use crate::color::palette::ColorDepth;
use crate::fault::document::{self, Entry, FaultList, toml_string};
use crate::fault::{Fault, Faults, quoted};
use crate::render::Filter;
use crate::terminal::{Fidelity, Key};
use crate::tui::{CellAspect, GlyphSet};
use crate::world::{Difficulty, FieldOfView};

/// The settings for display and controls.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// The key bindings.
    pub bindings: Bindings,
    /// The time between two frames while something moves.
    pub frame_time: Duration,
    /// The field of view. Keys can change it.
    pub field_of_view: FieldOfView,
    /// The height-to-width ratio of a cell; `None` for the terminal's own.
    pub cell_aspect: Option<CellAspect>,
    /// The glyph set.
    pub glyphs: GlyphSet,
    /// The colour depth; `None` for the terminal's own.
    pub depth: Option<ColorDepth>,
    /// The texture filter.
    pub filter: Filter,
    /// The fidelity of frames; `None` for the highest that the link to the terminal allows.
    pub fidelity: Option<Fidelity>,
    /// `true` to show the statistics about frames and the link in the status line. A key changes
    /// it.
    pub shows_stats: bool,
    /// The difficulty of levels that start without the title; `None` for the player's stored
    /// choice.
    pub difficulty: Option<Difficulty>,
    /// The initial content of the minimap.
    pub minimap: MapDisplay,
    /// `true` if the mouse turns the player from the start.
    pub mouse: bool,
    /// The origins of the settings that the store also keeps.
    pub given: SettingOrigins,
}

/// The origin of each setting that the store also keeps. A setting with an origin overrides the
/// player's stored choice. `None` means that neither a flag nor the configuration file sets it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct SettingOrigins {
    /// The origin of the glyph set.
    pub glyphs: Option<Origin>,
    /// The origin of the colour depth.
    pub depth: Option<Origin>,
    /// The origin of the frame time.
    pub frame_time: Option<Origin>,
    /// The origin of the field of view.
    pub field_of_view: Option<Origin>,
}

/// The source of a setting's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A command-line flag.
    Flag,
    /// The configuration file.
    File,
}

impl Settings {
    /// These settings, with the player's stored choices for every setting without an origin.
    #[must_use]
    pub fn preferring(mut self, preferences: &Preferences) -> Self {
        if let (None, Some(glyphs)) = (self.given.glyphs, preferences.glyphs) {
            self.glyphs = glyphs;
        }
        if let (None, Some(depth)) = (self.given.depth, preferences.colors) {
            self.depth = Some(depth);
        }
        if let (None, Some(frames)) = (self.given.frame_time, preferences.frames_per_second) {
            self.frame_time = Duration::from_secs(1) / frames.get();
        }
        if let (None, Some(angle)) = (self.given.field_of_view, preferences.field_of_view) {
            self.field_of_view = angle.field_of_view();
        }
        self
    }
}

/// The content of a configuration file, with defaults for missing settings.
///
/// Its `Display` output is a complete file with comments, which parses to the same configuration:
///
/// ```
/// use cellcaster::app::Configuration;
///
/// let configuration = Configuration::parse("minimap = \"all\"\n[keys]\nleave = \"f10\"", "config.toml")?;
/// let file = configuration.to_string();
/// assert!(file.contains("minimap = \"all\""));
/// assert_eq!(Configuration::parse(&file, "config.toml")?, configuration);
/// # Ok::<(), cellcaster::fault::Faults>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// The preset on which the bindings are based.
    pub preset: Preset,
    /// The key bindings.
    pub bindings: Bindings,
    /// The colour depth; `None` for the terminal's own.
    pub colors: Option<ColorDepth>,
    /// The glyph set; `None` for the best set that the terminal supports.
    pub glyphs: Option<GlyphSet>,
    /// The initial field of view.
    pub field_of_view: FieldOfView,
    /// The maximum frame rate, from 1 to 240 frames per second.
    pub frames_per_second: NonZeroU32,
    /// `true` if the mouse turns the player from the start.
    pub mouse: bool,
    /// The initial content of the minimap.
    pub minimap: MapDisplay,
    /// The fidelity of frames; `None` for the highest that the link to the terminal allows.
    pub fidelity: Option<Fidelity>,
    /// A folder whose pictures replace the built-in ones, relative to the file.
    pub art: Option<String>,
}

impl Default for Configuration {
    fn default() -> Self {
        Self {
            preset: Preset::default(),
            bindings: Bindings::default(),
            colors: None,
            glyphs: None,
            field_of_view: FieldOfView::default(),
            frames_per_second: FRAME_RATE,
            mouse: false,
            minimap: MapDisplay::default(),
            fidelity: None,
            art: None,
        }
    }
}

/// The settings, in the order of the file. The table of keys comes after them.
const SETTINGS: [Setting<Configuration>; 9] = [
    Setting {
        key: "preset",
        about: "the keyboard layout of the default keys: \"qwerty\", \"azerty\" or \"hjkl\"",
        value: &FieldAt(|it: &mut Configuration| &mut it.preset),
    },
    Setting {
        key: "colors",
        about: "the number of colours: \"true\", \"256\", \"16\", \"mono\", or \"auto\" for what\n\
                  the terminal has",
        value: &FieldAt(|it: &mut Configuration| &mut it.colors),
    },
    Setting {
        key: "glyphs",
        about: "the characters that show pixels: \"half\" (two per cell), \"quadrant\" (four),\n\
                  \"sextant\" (six), \"octant\" (eight), \"ascii\", \"ramp\" (by brightness),\n\
                  or \"auto\" for the best that the terminal can show",
        value: &FieldAt(|it: &mut Configuration| &mut it.glyphs),
    },
    Setting {
        key: "fov",
        about: "the field of view in degrees, above 0 and below 180",
        value: &FieldAt(|it: &mut Configuration| &mut it.field_of_view),
    },
    Setting {
        key: "fps",
        about: "the maximum number of frames per second, from 1 to 240",
        value: &FieldAt(|it: &mut Configuration| &mut it.frames_per_second),
    },
    Setting {
        key: "mouse",
        about: "true if the mouse turns the player at the start of the game, false if not",
        value: &FieldAt(|it: &mut Configuration| &mut it.mouse),
    },
    Setting {
        key: "minimap",
        about: "the map in the corner: \"seen\" (the cells that you have seen), \"all\" or \"off\"",
        value: &FieldAt(|it: &mut Configuration| &mut it.minimap),
    },
    Setting {
        key: "fidelity",
        about: "the fidelity of colours while something moves: \"exact\", \"high\", \"low\", a\n\
                  tolerance from 0 to 255, or \"auto\" for the best that the link allows",
        value: &FieldAt(|it: &mut Configuration| &mut it.fidelity),
    },
    Setting {
        key: "art",
        about: "a folder beside this file whose PNG files replace the built-in pictures with\n\
                  the same names; \"\" for none",
        value: &ArtFolder,
    },
];

/// The field [`Configuration::art`].
struct ArtFolder;

impl Field<Configuration> for ArtFolder {
    fn read(&self, entry: &Entry<'_, '_>, into: &mut Configuration) {
        if let Some(folder) = entry.string("art = \"my-art\"") {
            into.art = Some(folder.to_owned()).filter(|folder| !folder.is_empty());
        }
    }

    fn write(&self, of: &Configuration) -> String {
        toml_string(of.art.as_deref().unwrap_or_default())
    }

    fn differs(&self, one: &Configuration, other: &Configuration) -> bool {
        one.art != other.art
    }

    fn copy(&self, from: &Configuration, into: &mut Configuration) {
        into.art.clone_from(&from.art);
    }
}

impl Configuration {
    /// Parses a configuration file. Faults refer to the file as `name`.
    ///
    /// # Errors
    /// All faults in the file.
    pub fn parse(text: &str, name: &str) -> Result<Self, Faults> {
        let faults = FaultList::default();
        let document = document::parse(text, &faults);
        let mut configuration = Self::default();
        if faults.is_empty() {
            configuration.read(&document, &faults);
        }
        if faults.is_empty() {
            Ok(configuration)
        } else {
            Err(Faults::new(name, text, faults.take()))
        }
    }

    fn read(&mut self, document: &DeTable, faults: &FaultList) {
        let mut bound = Bound::default();
        for entry in document::entries(document, faults) {
            if let Some(setting) = SETTINGS.iter().find(|setting| setting.key == entry.key) {
                setting.value.read(&entry, self);
            } else if entry.key == KEYS {
                bound = entry
                    .table("[keys]")
                    .map(|table| Bound::read(&entry, table))
                    .unwrap_or_default();
            } else {
                let known: Vec<&str> = SETTINGS.iter().map(|it| it.key).chain([KEYS]).collect();
                entry.faults.push(entry.unknown_key("the configuration", &known));
            }
        }
        self.bindings = self.preset.bindings().rebound(&bound.actions, bound.keys);
    }

    /// Replaces all bindings by the bindings of `preset`.
    pub fn set_preset(&mut self, preset: Preset) {
        self.preset = preset;
        self.bindings = preset.bindings();
    }
}

/// The name of the table of keys.
const KEYS: &str = "keys";

/// The keys that a file binds to actions.
#[derive(Default)]
struct Bound {
    /// The actions that the table mentions.
    actions: Vec<Action>,
    keys: Vec<(Key, Action)>,
}

impl Bound {
    fn read(owner: &Entry<'_, '_>, table: &DeTable<'_>) -> Self {
        let names = Action::ALL.map(|(name, ..)| name);
        let mut bound = Self::default();
        for entry in owner.entries(table) {
            match Action::named(entry.key) {
                Some(action) => bound.bind(action, &entry),
                None => entry.faults.push(entry.unknown_key("the table of keys", &names)),
            }
        }
        bound
    }

    /// Binds the key or the list of keys in `entry` to `action`.
    fn bind(&mut self, action: Action, entry: &Entry<'_, '_>) {
        self.actions.push(action);
        let values = match entry.value {
            DeValue::Array(values) => {
                values.iter().map(|value| (value.get_ref(), value.span())).collect()
            }
            single => vec![(single, entry.value_place.clone())],
        };
        for (value, place) in values {
            let Some(name) = value.as_str() else {
                let wanted = "the name of a key, or a list of names";
                entry.faults.push(entry.wrong_type(wanted, "forward = [\"z\", \"up\"]"));
                break;
            };
            match name.parse::<Key>() {
                Err(error) => {
                    entry.faults.push(Fault::new(place, error.to_string()).label("unknown key"));
                }
                Ok(key) if self.keys.iter().any(|&(other, to)| other == key && to != action) => {
                    entry.faults.push(bound_twice(key, place));
                }
                Ok(key) => self.keys.push((key, action)),
            }
        }
    }
}

fn bound_twice(key: Key, place: Range<usize>) -> Fault {
    Fault::new(place, format!("the key {} is bound to two actions", quoted(&key.to_string())))
        .label("another action has this key too")
        .help("give each key to one action")
}

impl fmt::Display for Configuration {
    /// Writes a complete file: each setting with its description, its default and its value. Keys
    /// that match the preset are commented out, so that they change with the preset.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let default = Self::default();
        for Setting { key, about, value } in &SETTINGS {
            about.lines().try_for_each(|line| writeln!(f, "# {line}"))?;
            let default = value.write(&default);
            let default = match default.trim_matches('"') {
                "" => "none",
                named => named,
            };
            writeln!(f, "# default: {default}")?;
            writeln!(f, "{key} = {}\n", value.write(self))?;
        }
        writeln!(f, "# The keys of each action. Keys that match the preset are in comments.")?;
        writeln!(f, "# A key is one character or a name, such as \"up\", \"space\", \"f1\".")?;
        writeln!(f, "[{KEYS}]")?;
        let usual = self.preset.bindings();
        for (name, does, action, _) in Action::ALL {
            let keys = list(&self.bindings, action);
            let comment = if keys == list(&usual, action) { "# " } else { "" };
            writeln!(f, "{comment}{name} = {keys}  # {does}")?;
        }
        Ok(())
    }
}

/// The keys of `action` as a TOML array.
fn list(bindings: &Bindings, action: Action) -> String {
    toml_keys(bindings.keys(action))
}

/// `keys` as a TOML array.
pub(crate) fn toml_keys(keys: impl Iterator<Item = Key>) -> String {
    let keys: Vec<String> = keys.map(|key| toml_string(&key.to_string())).collect();
    format!("[{}]", keys.join(", "))
}

/// The values that every settings page can show and change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choices {
    /// The choices that the store keeps.
    pub preferences: Preferences,
    /// `true` if the mouse turns the player.
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

/// The settings of a running game, with their labels.
impl<C: AsMut<Choices> + Clone> Setting<C> {
    /// Whether the mouse turns the player.
    pub const MOUSE: Self =
        Self::new("mouse", "Mouse turns", &FieldAt(|it: &mut C| &mut it.as_mut().mouse));
    /// The content of the map.
    pub const MAP: Self = Self::new("minimap", "Map", &FieldAt(|it: &mut C| &mut it.as_mut().map));
}

/// The rows, in the order of the page.
const ROWS: [Setting<Choices>; 14] = [
    Setting::DIFFICULTY,
    Setting::RUNS,
    Setting::CROSSHAIR,
    Setting::COMPASS,
    Setting::GHOST,
    Setting::MARKS,
    Setting::BELL,
    Setting::MAP,
    Setting::MOUSE,
    Setting::FIELD_OF_VIEW,
    Setting::GLYPHS,
    Setting::COLORS,
    Setting::CORRECTION,
    Setting::FRAME_RATE,
];

impl App {
    pub(crate) fn settings_menu(&self) -> Menu<screen::MenuChoice> {
        let given = self.settings.given;
        let note = (given != SettingOrigins::default())
            .then_some("A flag or the file holds again at the next start.");
        let choices = self.choices();
        let rows = ROWS.iter().enumerate().map(|(index, row)| {
            let value = row.value.label(&choices) + origin(given, row.key);
            (row.about, value, screen::MenuChoice::Change(index))
        });
        let changed = match self.store.keys().len() {
            0 => "usual".to_owned(),
            count => format!("{count} changed"),
        };
        settings_menu(note, self.detection.ascii_locale.is_none(), rows).entry_with(
            "Keys",
            changed,
            screen::MenuChoice::Open(screen::AppScreen::Keys),
        )
    }

    /// The current values.
    fn choices(&self) -> Choices {
        Choices {
            preferences: self.settings.in_force(self.store.preferences()),
            mouse: self.pointer.is_on(),
            map: self.map.display(),
        }
    }

    /// Moves the setting in row `row` to its next value, or to the previous one if `forward` is
    /// false.
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
    /// `preferences`, with the current values in place of the stored choices.
    fn in_force(&self, preferences: Preferences) -> Preferences {
        let rate = (1.0 / self.frame_time.as_secs_f64().max(1e-3)).round() as u32;
        Preferences {
            glyphs: Some(self.glyphs),
            colors: self.depth,
            frames_per_second: NonZeroU32::new(rate),
            field_of_view: Some(ViewAngle::nearest(self.field_of_view)),
            ..preferences
        }
    }

    /// Applies a choice of the player. From now on it overrides flags and the file.
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
        let angle = after.field_of_view;
        if let Some(angle) = angle.filter(|_| angle != before.field_of_view) {
            self.field_of_view = angle.field_of_view();
            self.given.field_of_view = None;
        }
    }
}

/// A suffix that names the origin of the setting `key`; empty if it has none.
fn origin(given: SettingOrigins, key: &str) -> &'static str {
    let origin = match key {
        "glyphs" => given.glyphs,
        "colors" => given.depth,
        "fps" => given.frame_time,
        "fov" => given.field_of_view,
        _ => None,
    };
    match origin {
        Some(Origin::Flag) => " (flag)",
        Some(Origin::File) => " (file)",
        None => "",
    }
}

/// A settings page with a note, an optional card for comparing the terminal's characters, and rows
/// of label, value and choice.
pub fn settings_menu<C: Copy>(
    note: Option<&str>,
    has_card: bool,
    rows: impl Iterator<Item = (&'static str, String, C)>,
) -> Menu<C> {
    let sets = GlyphSet::ALL.iter().filter(|(set, ..)| has_card && set.has_blocks());
    Menu::new("settings")
        .line("Enter or left and right change a setting.")
        .lines(note)
        .lines(has_card.then_some("Of these, the last smooth wedge is the best for you:"))
        .lines(sets.map(|(set, _, name)| format!("{name:·<12} {}", set.wedge())))
        .entries(rows)
}

#[cfg(test)]
mod tests;
