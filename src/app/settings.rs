//! Settings: how the game is shown and controlled, and the file for them.
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
//! A [`Configuration`] is the content of such a file; the command line takes precedence. All faults
//! of a file are reported in one run, each with its place.
//!
//! - A key that the file gives to an action is removed from its action in the preset.
//! - A key given to two actions is a fault.
//! - An empty list leaves an action without a key.

use std::fmt;
use std::num::NonZeroU32;
use std::ops::Range;
use std::time::Duration;

use toml::de::{DeTable, DeValue};

use crate::app::bindings::{Action, Bindings, Preset};
use crate::app::setting::{At, Choice, FRAME_RATE, Setting, toml_string};
use crate::app::store::Preferences;
use crate::color::palette::ColorDepth;
use crate::fault::document::{self, Entry, FaultList};
use crate::fault::{Fault, Faults, quoted};
use crate::render::{DynCaster, Filter};
use crate::terminal::{Fidelity, Key};
use crate::tui::{CellAspect, GlyphSet};
use crate::world::{Difficulty, FieldOfView};

/// How the game is shown and controlled.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// The actions of keys.
    pub bindings: Bindings,
    /// The time between two frames while something moves.
    pub frame_time: Duration,
    /// The field of view. Keys change it.
    pub field_of_view: FieldOfView,
    /// The shape of a cell; `None` for the terminal's.
    pub cell_aspect: Option<CellAspect>,
    /// The glyph set.
    pub glyphs: GlyphSet,
    /// The colour depth; `None` for the terminal's.
    pub depth: Option<ColorDepth>,
    /// The caster that finds the walls.
    pub caster: DynCaster,
    /// The texture filter.
    pub filter: Filter,
    /// The fidelity of frames; `None` for the highest that the link to the terminal allows.
    pub fidelity: Option<Fidelity>,
    /// Whether the status line shows the figures of frames and the link. A key changes it.
    pub shows_stats: bool,
    /// The difficulty of levels that are played without the title; `None` for the player's
    /// earlier choice.
    pub difficulty: Option<Difficulty>,
    /// The content of the minimap at first.
    pub minimap: MapDisplay,
    /// Whether the mouse turns the player at first.
    pub mouse: bool,
    /// The origin of the settings that the game keeps.
    pub given: Given,
}

/// The origin of the settings that the game keeps. A given value takes the place of the player's choice
/// in an earlier game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Given {
    /// Of the glyph set.
    pub glyphs: Option<Origin>,
    /// Of the colour depth.
    pub depth: Option<Origin>,
    /// Of the frame time.
    pub frame_time: Option<Origin>,
}

/// Where a setting is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// By a flag of the command line.
    Flag,
    /// By the configuration file.
    File,
}

impl Settings {
    /// These settings, with what the player has chosen in earlier games where nothing is given.
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
        self
    }
}

/// The content of the minimap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum MapDisplay {
    /// The cells that the player has seen so far.
    #[default]
    Seen,
    /// The whole map.
    All,
    /// Nothing, until the player switches it on; then the seen cells.
    Off,
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
    /// The preset that the bindings are based on.
    pub preset: Preset,
    /// The actions of keys.
    pub bindings: Bindings,
    /// The colour depth; `None` for the terminal's.
    pub colors: Option<ColorDepth>,
    /// The glyph set; `None` for the best that the terminal can show.
    pub glyphs: Option<GlyphSet>,
    /// The field of view at first.
    pub field_of_view: FieldOfView,
    /// The most frames per second, from 1 to 240.
    pub frames_per_second: NonZeroU32,
    /// Whether the mouse turns the player at first.
    pub mouse: bool,
    /// The content of the minimap at first.
    pub minimap: MapDisplay,
    /// The fidelity of frames; `None` for the highest that the link to the terminal allows.
    pub fidelity: Option<Fidelity>,
}

impl Choice for MapDisplay {
    const ALL: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Seen, "seen", "what was seen"),
        (Self::All, "all", "all"),
        (Self::Off, "off", "off"),
    ];

    /// Shows the map or hides it. The content of a map that is shown again is its panel's affair.
    fn neighbour(self, _forward: bool) -> Self {
        if self == Self::Off { Self::Seen } else { Self::Off }
    }
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
        }
    }
}

/// The settings in the order of a file. The table of keys follows them.
const SETTINGS: [Setting<Configuration>; 8] = [
    Setting {
        key: "preset",
        about: "the keyboard that keys are for, as a start: \"qwerty\", \"azerty\" or \"hjkl\"",
        value: &At(|it: &mut Configuration| &mut it.preset),
    },
    Setting {
        key: "colors",
        about: "how many colours: \"true\", \"256\", \"16\", \"mono\", or \"auto\" for what the\nterminal has",
        value: &At(|it: &mut Configuration| &mut it.colors),
    },
    Setting {
        key: "glyphs",
        about: "characters for pixels: \"half\" (two a cell), \"quadrant\" (four), \"sextant\" (six),\n\
                  \"octant\" (eight), \"ascii\", \"ramp\" (by brightness), or \"auto\" for what the\n\
                  terminal can show",
        value: &At(|it: &mut Configuration| &mut it.glyphs),
    },
    Setting {
        key: "fov",
        about: "the field of view in degrees, above 0 and below 180",
        value: &At(|it: &mut Configuration| &mut it.field_of_view),
    },
    Setting {
        key: "fps",
        about: "the most frames a second, from 1 to 240",
        value: &At(|it: &mut Configuration| &mut it.frames_per_second),
    },
    Setting {
        key: "mouse",
        about: "whether the mouse turns the player at first: true or false",
        value: &At(|it: &mut Configuration| &mut it.mouse),
    },
    Setting {
        key: "minimap",
        about: "the map in the corner: \"seen\" (what has been seen so far), \"all\" or \"off\"",
        value: &At(|it: &mut Configuration| &mut it.minimap),
    },
    Setting {
        key: "fidelity",
        about: "how exact colours are while something moves: \"exact\", \"high\", \"low\", a\n\
                  tolerance from 0 to 255, or \"auto\" for what the link allows",
        value: &At(|it: &mut Configuration| &mut it.fidelity),
    },
];

impl Configuration {
    /// Parses a configuration file, which faults refer to as `name`.
    ///
    /// # Errors
    /// All faults of the file.
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

    /// Takes the bindings of another preset.
    pub fn set_preset(&mut self, preset: Preset) {
        self.preset = preset;
        self.bindings = preset.bindings();
    }
}

/// The name of the table of keys.
const KEYS: &str = "keys";

/// The keys that a file gives to actions.
#[derive(Default)]
struct Bound {
    /// The actions in the table.
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

    /// Binds the key or the list of keys of `entry` to `action`.
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
        .label("another action has it too")
        .help("give each key to one action")
}

impl fmt::Display for Configuration {
    /// Writes a complete file: each setting with its description, its default and its value. Keys
    /// of the preset are commented out, so that they follow the preset.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let default = Self::default();
        for Setting { key, about, value } in &SETTINGS {
            about.lines().try_for_each(|line| writeln!(f, "# {line}"))?;
            writeln!(f, "# default: {}", value.write(&default).trim_matches('"'))?;
            writeln!(f, "{key} = {}\n", value.write(self))?;
        }
        writeln!(
            f,
            "# The keys of each action, in place of the preset's; those of the preset are comments."
        )?;
        writeln!(f, "# A key is one character or a name, such as \"up\", \"space\", \"f1\".")?;
        writeln!(f, "[{KEYS}]")?;
        let usual = self.preset.bindings();
        for (name, does, action) in Action::ALL {
            let keys = list(&self.bindings, action);
            let comment = if keys == list(&usual, action) { "# " } else { "" };
            writeln!(f, "{comment}{name} = {keys}  # {does}")?;
        }
        Ok(())
    }
}

/// The keys of `action` as a TOML array.
fn list(bindings: &Bindings, action: Action) -> String {
    let keys: Vec<String> =
        bindings.keys(action).map(|key| toml_string(&key.to_string())).collect();
    format!("[{}]", keys.join(", "))
}

#[cfg(test)]
mod tests;
