//! Settings as tables. Each row holds a setting's key, a text about it, and a reference to the
//! field with its value.
//!
//! The same row reads and writes the file, fills the settings page, and merges the choices of two
//! running games. The type of a setting's value implements [`Value`], or [`Choice`] if it has a few
//! named values.
//!
//! Rejected: serde. It stops at the first fault in a file, writes no comments, and does not support
//! a settings page.

use std::num::NonZeroU32;

use serde::{Deserialize, Serialize};
use toml::de::DeValue;

use crate::app::controls::Preset;
use crate::color::palette::ColorDepth;
use crate::fault::document::{Entry, toml_string};
use crate::fault::{nearest_or_all, quoted};
use crate::terminal::Fidelity;
use crate::tui::{Correction, GlyphSet};
use crate::world::{Difficulty, FieldOfView};

/// A setting stored in `C`.
pub struct Setting<C: 'static> {
    /// The key in a file.
    pub key: &'static str,
    /// The comment lines in a file that explain the setting, or its label on a settings page.
    pub about: &'static str,
    /// The field with the value.
    pub value: &'static dyn Field<C>,
}

impl<C> Setting<C> {
    pub(crate) const fn new(
        key: &'static str,
        about: &'static str,
        value: &'static dyn Field<C>,
    ) -> Self {
        Self { key, about, value }
    }
}

/// The value of a setting stored in `C`.
pub trait Field<C>: Sync {
    /// Reads the value of `entry` into `into`, or reports a fault.
    fn read(&self, entry: &Entry<'_, '_>, into: &mut C);

    /// The value as TOML.
    fn write(&self, of: &C) -> String;

    /// Returns true if `one` and `other` have different values.
    fn differs(&self, one: &C, other: &C) -> bool;

    /// Copies the value from `from` into `into`.
    fn copy(&self, from: &C, into: &mut C);

    /// Moves to the next value on a settings page, or to the previous one if `forward` is false.
    /// Does nothing if no settings page changes the value.
    fn change(&self, _of: &mut C, _forward: bool) {}

    /// The value as a settings page shows it.
    fn label(&self, of: &C) -> String {
        self.write(of)
    }
}

/// The field of `C` that a function borrows. A value is read from a copy of `C`, so one function
/// per row is enough.
pub struct FieldAt<C, T>(pub fn(&mut C) -> &mut T);

impl<C: Clone, T: Value> FieldAt<C, T> {
    fn get(&self, of: &C) -> T {
        *self.0(&mut of.clone())
    }
}

impl<C: Clone, T: Value> Field<C> for FieldAt<C, T> {
    fn read(&self, entry: &Entry<'_, '_>, into: &mut C) {
        if let Some(value) = T::read(entry) {
            *self.0(into) = value;
        }
    }

    fn write(&self, of: &C) -> String {
        self.get(of).write()
    }

    fn differs(&self, one: &C, other: &C) -> bool {
        self.get(one) != self.get(other)
    }

    fn copy(&self, from: &C, into: &mut C) {
        *self.0(into) = self.get(from);
    }

    fn change(&self, of: &mut C, forward: bool) {
        let value = self.0(of);
        *value = value.after(forward);
    }

    fn label(&self, of: &C) -> String {
        self.get(of).label()
    }
}

/// The value of a setting.
pub trait Value: Copy + PartialEq {
    /// Reads the value of `entry`. Reports a fault if it is not valid.
    fn read(entry: &Entry<'_, '_>) -> Option<Self>;

    /// The value as TOML.
    fn write(self) -> String;

    /// The next value on a settings page, or the previous one if `forward` is false. Returns the
    /// same value if no settings page changes it.
    #[must_use]
    fn after(self, _forward: bool) -> Self {
        self
    }

    /// The value as a settings page shows it.
    fn label(self) -> String {
        self.write()
    }
}

/// A value, its name in files, and its label on a settings page.
type NamedValue<T> = (T, &'static str, &'static str);

/// A value from a small set of named values.
pub trait Choice: Copy + PartialEq + 'static {
    /// The label for "automatic", where the terminal decides; `None` if settings pages do not offer
    /// that.
    const AUTO: Option<&'static str> = None;
    /// The values in the order of a settings page.
    const ALL: &'static [NamedValue<Self>];

    /// The name in files.
    fn name(self) -> &'static str {
        Self::ALL.iter().find(|(value, ..)| *value == self).map_or("", |(_, name, _)| name)
    }

    /// The next value on a settings page, or the previous one if `forward` is false.
    #[must_use]
    fn neighbour(self, forward: bool) -> Self {
        next(Self::ALL, |(value, ..)| *value == self, forward).0
    }

    /// The value called `name` in files.
    fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, known, _)| *known == name).map(|&(value, ..)| value)
    }
}

impl Choice for GlyphSet {
    const ALL: &'static [NamedValue<Self>] = &[
        (Self::Half, "half", "half blocks"),
        (Self::Quadrant, "quadrant", "quadrants"),
        (Self::Sextant, "sextant", "sextants"),
        (Self::Octant, "octant", "octants"),
        (Self::Ascii, "ascii", "ASCII"),
        (Self::Ramp, "ramp", "ramp"),
    ];
}

impl Choice for ColorDepth {
    const AUTO: Option<&'static str> = Some("the terminal's");
    const ALL: &'static [NamedValue<Self>] = &[
        (Self::True, "true", "all"),
        (Self::Indexed256, "256", "256"),
        (Self::Indexed16, "16", "16"),
        (Self::Mono, "mono", "none"),
    ];
}

impl Choice for Correction {
    const ALL: &'static [NamedValue<Self>] = &[
        (Self::None, "none", "original"),
        (Self::Contrast, "contrast", "more contrast"),
        (Self::RedGreen, "red-green", "red and green apart"),
    ];
}

impl Choice for Difficulty {
    const ALL: &'static [NamedValue<Self>] = &[
        (Self::Easy, "easy", "easy"),
        (Self::Normal, "normal", "normal"),
        (Self::Hard, "hard", "hard"),
    ];
}

/// The content of the minimap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum MapDisplay {
    /// The cells that the player has already seen.
    #[default]
    Seen,
    /// The whole map.
    All,
    /// Nothing at first. If the player switches the map on, the cells already seen.
    Off,
}

impl Choice for MapDisplay {
    const ALL: &'static [NamedValue<Self>] = &[
        (Self::Seen, "seen", "explored area"),
        (Self::All, "all", "all"),
        (Self::Off, "off", "off"),
    ];

    /// Switches between visible and hidden. The map panel decides the content of a visible map.
    fn neighbour(self, _forward: bool) -> Self {
        if self == Self::Off { Self::Seen } else { Self::Off }
    }
}

impl Choice for Preset {
    const ALL: &'static [NamedValue<Self>] = &[
        (Self::Qwerty, "qwerty", "qwerty"),
        (Self::Azerty, "azerty", "azerty"),
        (Self::Hjkl, "hjkl", "hjkl"),
    ];
}

impl<T: Choice> Value for T {
    fn read(entry: &Entry<'_, '_>) -> Option<Self> {
        read_name(entry, &names::<T>().collect::<Vec<_>>()).and_then(T::named)
    }

    fn write(self) -> String {
        toml_string(self.name())
    }

    fn after(self, forward: bool) -> Self {
        self.neighbour(forward)
    }

    fn label(self) -> String {
        T::ALL.iter().find(|(value, ..)| *value == self).map_or("", |(.., label)| label).to_owned()
    }
}

/// The name of the choice to let the terminal decide.
const AUTO: &str = "auto";

/// `None` lets the terminal decide.
impl<T: Choice> Value for Option<T> {
    fn read(entry: &Entry<'_, '_>) -> Option<Self> {
        let known: Vec<&str> = [AUTO].into_iter().chain(names::<T>()).collect();
        let name = read_name(entry, &known)?;
        Some(T::named(name))
    }

    fn write(self) -> String {
        toml_string(self.map_or(AUTO, T::name))
    }

    fn after(self, forward: bool) -> Self {
        let auto = T::AUTO.map(|_| None);
        let all: Vec<Self> =
            auto.into_iter().chain(T::ALL.iter().map(|&(value, ..)| Some(value))).collect();
        next(&all, |&value| value == self, forward)
    }

    fn label(self) -> String {
        self.map_or_else(|| T::AUTO.unwrap_or_default().to_owned(), Value::label)
    }
}

impl Value for bool {
    fn read(entry: &Entry<'_, '_>) -> Option<Self> {
        let DeValue::Boolean(boolean) = entry.value else {
            let example = format!("{} = true", entry.key);
            entry.faults.push(entry.wrong_type("true or false", &example));
            return None;
        };
        Some(*boolean)
    }

    fn write(self) -> String {
        self.to_string()
    }

    fn after(self, _: bool) -> Self {
        !self
    }

    fn label(self) -> String {
        if self { "on" } else { "off" }.to_owned()
    }
}

impl Value for FieldOfView {
    fn read(entry: &Entry<'_, '_>) -> Option<Self> {
        let example = format!("{} = {}", entry.key, Self::default().write());
        let Some(degrees) = entry.number() else {
            entry.faults.push(entry.wrong_type("a number of degrees", &example));
            return None;
        };
        Self::from_degrees(degrees)
            .or_else(|| reject_range(entry, "degrees above 0 and below 180", &example))
    }

    fn write(self) -> String {
        self.degrees().to_string()
    }
}

/// A field of view that the settings page offers: whole degrees, from 30 to 120.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub struct ViewAngle(u8);

impl ViewAngle {
    const MIN: u8 = 30;
    const MAX: u8 = 120;
    /// The difference between two values that the settings page offers.
    const STEP: u8 = 6;

    /// The angle that is nearest to `view`.
    pub(crate) fn nearest(view: FieldOfView) -> Self {
        let degrees = view.degrees().round();
        Self(degrees.clamp(Self::MIN.into(), Self::MAX.into()) as u8)
    }

    /// The angle as a field of view.
    pub(crate) fn field_of_view(self) -> FieldOfView {
        FieldOfView::from_degrees(self.0.into()).unwrap_or_default()
    }
}

impl TryFrom<u8> for ViewAngle {
    type Error = &'static str;

    fn try_from(degrees: u8) -> Result<Self, Self::Error> {
        let is_offered = (Self::MIN..=Self::MAX).contains(&degrees);
        is_offered.then_some(Self(degrees)).ok_or("a field of view has 30 to 120 degrees")
    }
}

impl From<ViewAngle> for u8 {
    fn from(angle: ViewAngle) -> Self {
        angle.0
    }
}

/// `None` means the default. The smallest angle follows the largest one.
impl Value for Option<ViewAngle> {
    fn read(entry: &Entry<'_, '_>) -> Option<Self> {
        let view = FieldOfView::read(entry)?;
        Some(Some(ViewAngle::nearest(view)))
    }

    fn write(self) -> String {
        let view = self.unwrap_or(ViewAngle::nearest(FieldOfView::default()));
        view.0.to_string()
    }

    fn after(self, forward: bool) -> Self {
        let ViewAngle(degrees) = self.unwrap_or(ViewAngle::nearest(FieldOfView::default()));
        let (least, most, step) = (ViewAngle::MIN, ViewAngle::MAX, ViewAngle::STEP);
        let after = match forward {
            true if degrees >= most => least,
            true => (degrees + step).min(most),
            false if degrees <= least => most,
            false => (degrees - step).max(least),
        };
        Some(ViewAngle(after))
    }

    fn label(self) -> String {
        format!("{}°", self.write())
    }
}

/// The default maximum frame rate, in frames per second.
pub(crate) const FRAME_RATE: NonZeroU32 = NonZeroU32::new(30).unwrap();
/// The frame rates that a settings page offers.
const FRAME_RATES: [u32; 4] = [15, 30, 60, 120];

/// A frame rate, from 1 to 240 frames per second.
impl Value for NonZeroU32 {
    fn read(entry: &Entry<'_, '_>) -> Option<Self> {
        let example = format!("{} = {FRAME_RATE}", entry.key);
        let DeValue::Integer(_) = entry.value else {
            entry.faults.push(entry.wrong_type("a whole number", &example));
            return None;
        };
        let number = entry.number().filter(|number| (1.0..=240.0).contains(number));
        let frames = number.and_then(|number| Self::new(number as u32));
        frames.or_else(|| reject_range(entry, "a whole number from 1 to 240", &example))
    }

    fn write(self) -> String {
        self.to_string()
    }

    fn after(self, forward: bool) -> Self {
        let rate = next(&FRAME_RATES, |&rate| rate >= self.get(), forward);
        Self::new(rate).unwrap_or(self)
    }
}

/// `None` means the default.
impl Value for Option<NonZeroU32> {
    fn read(entry: &Entry<'_, '_>) -> Option<Self> {
        NonZeroU32::read(entry).map(Some)
    }

    fn write(self) -> String {
        self.unwrap_or(FRAME_RATE).write()
    }

    fn after(self, forward: bool) -> Self {
        Some(self.unwrap_or(FRAME_RATE).after(forward))
    }
}

/// `None` lets the link to the terminal decide.
impl Value for Option<Fidelity> {
    fn read(entry: &Entry<'_, '_>) -> Option<Self> {
        let example = format!("{} = \"{AUTO}\"", entry.key);
        let text = match entry.number() {
            Some(number) => number.to_string(),
            None => entry.string(&example)?.to_owned(),
        };
        if text == AUTO {
            return Some(None);
        }
        let wanted = "\"auto\", \"exact\", \"high\", \"low\" or a whole number from 0 to 255";
        text.parse().ok().or_else(|| reject_range(entry, wanted, &example)).map(Some)
    }

    fn write(self) -> String {
        toml_string(&self.map_or(AUTO.to_owned(), |fidelity| fidelity.to_string()))
    }
}

fn names<T: Choice>() -> impl Iterator<Item = &'static str> {
    T::ALL.iter().map(|&(_, name, _)| name)
}

/// The name in `entry` if it is one of `known`; otherwise reports a fault. Numbers, such as 256
/// colours, need no quotes.
fn read_name<'k>(entry: &Entry<'_, '_>, known: &[&'k str]) -> Option<&'k str> {
    let number = entry.number().map(|number| number.to_string());
    let of_number = known.iter().find(|&&name| Some(name) == number.as_deref());
    if let Some(&name) = of_number {
        return Some(name);
    }
    let text = entry.string(&format!("{} = \"{}\"", entry.key, known[0]))?;
    if let Some(name) = known.iter().copied().find(|&name| name == text) {
        return Some(name);
    }
    let help = nearest_or_all(text, known, "the nearest is", "write one of");
    entry.reject(format!("{} is not a value of {}", quoted(text), quoted(entry.key)), "", help)
}

/// Reports that the value of `entry` must be `wanted`. `example` is a complete valid entry.
pub fn reject_range<T>(entry: &Entry<'_, '_>, wanted: &str, example: &str) -> Option<T> {
    let message = format!("{} must be {wanted}", quoted(entry.key));
    entry.reject(message, "", format!("write {example}"))
}

/// The value after the first one for which `is_it` returns true, or the value before it. The values
/// form a cycle.
fn next<T: Copy>(values: &[T], is_it: impl Fn(&T) -> bool, forward: bool) -> T {
    let index = values.iter().position(is_it).unwrap_or(0);
    let by = if forward { 1 } else { values.len() - 1 };
    values[(index + by) % values.len()]
}

/// The player's stored choices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a choice of its own")]
pub struct Preferences {
    /// `true` to mark the middle of the picture with a dot.
    pub crosshair: bool,
    /// `true` to show the compass.
    pub compass: bool,
    /// `true` to ring the terminal's bell when the player is noticed or hurt.
    pub bell: bool,
    /// `true` to show the ghost of the best run.
    pub ghost: bool,
    /// `true` to mark the guards who suspect something.
    pub marks: bool,
    /// The difficulty of new games.
    pub difficulty: Difficulty,
    /// The glyph set; `None` for the best set that the terminal supports.
    pub glyphs: Option<GlyphSet>,
    /// The colour depth; `None` for the terminal's own.
    pub colors: Option<ColorDepth>,
    /// The colour correction for the player's eyes.
    pub correction: Correction,
    /// The maximum frame rate; `None` for the default.
    pub frames_per_second: Option<NonZeroU32>,
    /// `true` to run unless a key asks for walking.
    pub runs: bool,
    /// The field of view; `None` for the default.
    pub field_of_view: Option<ViewAngle>,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            crosshair: false,
            compass: false,
            bell: false,
            ghost: true,
            marks: true,
            difficulty: Difficulty::Normal,
            glyphs: None,
            colors: None,
            correction: Correction::None,
            frames_per_second: None,
            runs: false,
            field_of_view: None,
        }
    }
}

impl AsMut<Self> for Preferences {
    fn as_mut(&mut self) -> &mut Self {
        self
    }
}

impl Preferences {
    /// Applies the differences between `before` and `after` to these preferences.
    pub fn choose(&mut self, before: Self, after: Self) {
        for setting in &PREFERENCES {
            if setting.value.differs(&before, &after) {
                setting.value.copy(&after, self);
            }
        }
    }
}

/// The preferences as settings of any type that contains them: the key in the file, the label on a settings page, and
/// the field.
macro_rules! preferences {
    ($($(#[$doc:meta])* $name:ident: $key:literal, $label:literal, $field:ident;)*) => {
        impl<C: AsMut<Preferences> + Clone> Setting<C> {$(
            $(#[$doc])*
            pub const $name: Self =
                Self::new($key, $label, &FieldAt(|it: &mut C| &mut it.as_mut().$field));
        )*}

        /// The preferences, in the order of the file.
        pub(crate) const PREFERENCES: [Setting<Preferences>; 12] = [$(Setting::$name),*];
    };
}

preferences! {
    /// Whether a dot marks the middle of the picture.
    CROSSHAIR: "crosshair", "Crosshair", crosshair;
    /// Whether the compass is shown.
    COMPASS: "compass", "Compass", compass;
    /// Whether the terminal's bell rings when the player is noticed or hurt.
    BELL: "bell", "Bell when noticed or hurt", bell;
    /// Whether the ghost of the best run is shown.
    GHOST: "ghost", "Ghost of the best run", ghost;
    /// The difficulty of new games.
    DIFFICULTY: "difficulty", "Difficulty", difficulty;
    /// The glyph set.
    GLYPHS: "glyphs", "Characters", glyphs;
    /// The colour depth.
    COLORS: "colors", "Colours", colors;
    /// The colour correction for the player's eyes.
    CORRECTION: "correction", "Picture", correction;
    /// The maximum frame rate.
    FRAME_RATE: "fps", "Frames a second", frames_per_second;
    /// Whether marks show what guards suspect.
    MARKS: "marks", "Marks above guards", marks;
    /// Whether the player runs unless a key asks for walking.
    RUNS: "runs", "Run by default", runs;
    /// The field of view.
    FIELD_OF_VIEW: "fov", "Field of view", field_of_view;
}
