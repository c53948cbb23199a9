//! The text of `progress.toml`: reading and writing a [`Progress`].
//!
//! All readable parts of a damaged text are read. A result counts only as a whole: if one of its
//! values is damaged, the result is left out. A last line without a line end is dropped, because a
//! truncated number would look like a better result.
//!
//! Serde reads one result at a time. Rejected: serde for the whole text. It gives up at the first
//! damaged value.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use toml::Spanned;
use toml::de::ValueDeserializer;

use super::progress::{Best, Descent, Progress, Reached, Save, SavedEntry};
use crate::app::controls::{Action, OwnKeys};
use crate::app::setting::{PREFERENCES, Preferences};
use crate::app::settings::toml_keys;
use crate::fault::Fault;
use crate::fault::document::{self, Entry, FaultList};
use crate::game::Rules;
use crate::terminal::Key;
use crate::world::Difficulty;

/// The version of the format.
const VERSION: u64 = 4;

/// The table of the keys that the player has chosen.
const KEYS: &str = "keys";

/// The saved games and the results, as the text has them.
#[derive(Serialize)]
struct Sections<'a> {
    // A list without games would be a value of the table before it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    saves: Vec<SavedGameText>,
    descent: Option<Reached>,
    best: BTreeMap<&'a str, BTreeMap<&'static str, &'a Best>>,
    daily: BTreeMap<String, Reached>,
}

/// A saved game. The script comes last, because a saved game without it does not count.
#[derive(Serialize, Deserialize)]
struct SavedGameText {
    level: String,
    file: Option<String>,
    difficulty: String,
    /// TOML integers have one bit less.
    seed: String,
    descent: Option<String>,
    steps: u64,
    checksum: String,
    script: String,
}

impl From<&SavedEntry> for SavedGameText {
    fn from(SavedEntry { save, script }: &SavedEntry) -> Self {
        Self {
            level: save.level.clone(),
            file: save.file.clone(),
            difficulty: save.rules.difficulty.name().to_owned(),
            seed: save.rules.seed.to_string(),
            descent: save.descent.map(|descent| descent.name().to_owned()),
            steps: save.steps,
            checksum: format!("{:016x}", save.checksum),
            script: script.clone(),
        }
    }
}

impl SavedGameText {
    /// The saved game; `None` if it is damaged.
    fn entry(self) -> Option<SavedEntry> {
        let Self { level, file, steps, script, .. } = self;
        let difficulty = Difficulty::named(&self.difficulty)?;
        let rules = Rules { difficulty, seed: self.seed.parse().ok()? };
        let descent = match self.descent {
            Some(name) => Some(Descent::named(&name)?),
            None => None,
        };
        let checksum = u64::from_str_radix(&self.checksum, 16).ok()?;
        let save = Save { level, file, rules, descent, steps, checksum };
        // A name could point outside the folder.
        let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '.';
        let is_script = script.ends_with(".script") && script.chars().all(is_plain);
        is_script.then_some(SavedEntry { save, script })
    }
}

/// Reads the content of the file. Returns the readable part, and whether that is all of it.
///
/// # Errors
/// The version of the format, if it is newer than this program.
pub(crate) fn read(content: &[u8]) -> Result<(Progress, bool), u64> {
    let text = String::from_utf8_lossy(content);
    let whole = text.rfind('\n').map_or(0, |end| end + 1);
    let is_cut = whole < text.len() || matches!(text, Cow::Owned(_));
    let faults = FaultList::default();
    let document = document::parse(&text[..whole], &faults);
    let mut progress = Progress::default();
    let mut version = None;
    for entry in document::entries(&document, &faults) {
        match entry.key {
            "version" => version = sound(&entry, value(&entry)),
            "preferences" => read_preferences(&entry, &mut progress.preferences),
            KEYS => read_keys(&entry, &mut progress.keys),
            "saves" => {
                for entry in sound(&entry, entry.list()).unwrap_or_default() {
                    let save = value(&entry).and_then(SavedGameText::entry);
                    if let Some(save) = sound(&entry, save) {
                        progress.add_save(save);
                    }
                }
            }
            "descent" => progress.descent = sound(&entry, value(&entry)),
            "best" => read_bests(&entry, &mut progress),
            "daily" => {
                for entry in inner(&entry) {
                    let daily = sound(&entry, entry.key.parse::<u32>().ok().zip(value(&entry)));
                    progress.dailies.extend(daily);
                }
            }
            _ => damaged(&entry),
        }
    }
    match version {
        Some(newer) if newer > VERSION => Err(newer),
        Some(VERSION) => Ok((progress, faults.is_empty() && !is_cut)),
        _ => Ok((progress, false)),
    }
}

fn read_preferences(section: &Entry<'_, '_>, preferences: &mut Preferences) {
    for entry in inner(section) {
        match PREFERENCES.iter().find(|setting| setting.key == entry.key) {
            Some(setting) => setting.value.read(&entry, preferences),
            None => damaged(&entry),
        }
    }
}

fn read_keys(section: &Entry<'_, '_>, own: &mut OwnKeys) {
    for entry in inner(section) {
        let names: Option<Vec<String>> = value(&entry);
        let keys = names.and_then(|names| names.iter().map(|name| name.parse().ok()).collect());
        let keys: Option<(_, Vec<Key>)> = Action::entry(entry.key).map(|(name, _)| name).zip(keys);
        own.extend(sound(&entry, keys));
    }
}

fn read_bests(section: &Entry<'_, '_>, progress: &mut Progress) {
    for level in inner(section) {
        for entry in inner(&level) {
            let best = Difficulty::named(entry.key).zip(value(&entry));
            let best = best.map(|(difficulty, best)| ((level.key.to_owned(), difficulty), best));
            progress.bests.extend(sound(&entry, best));
        }
    }
}

/// The entries of a section; empty if the entry is not a section.
fn inner<'a, 't>(section: &Entry<'a, 't>) -> impl Iterator<Item = Entry<'a, 't>> {
    // The faults of this file are counted and never shown, so they need no example.
    section.table("").into_iter().flat_map(|table| document::entries(table, section.faults))
}

/// The value of `entry`; `None` if it has another form.
fn value<T: DeserializeOwned>(entry: &Entry<'_, '_>) -> Option<T> {
    let value = Spanned::new(entry.value_place.clone(), entry.value.clone());
    T::deserialize(ValueDeserializer::from(value)).ok()
}

/// Returns `value`, and reports the entry as damaged if it is `None`.
fn sound<T>(entry: &Entry<'_, '_>, value: Option<T>) -> Option<T> {
    if value.is_none() {
        damaged(entry);
    }
    value
}

fn damaged(entry: &Entry<'_, '_>) {
    entry.faults.push(Fault::new(entry.value_place.clone(), "this is damaged"));
}

impl fmt::Display for Progress {
    /// Writes the whole file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "# The progress of a player of Cellcaster. The game replaces this file.")?;
        writeln!(f, "version = {VERSION}\n\n[preferences]")?;
        let default = Preferences::default();
        for setting in &PREFERENCES {
            if setting.value.differs(&self.preferences, &default) {
                writeln!(f, "{} = {}", setting.key, setting.value.write(&self.preferences))?;
            }
        }
        writeln!(f, "\n[{KEYS}]")?;
        for (name, keys) in &self.keys {
            writeln!(f, "{name} = {}", toml_keys(keys.iter().copied()))?;
        }
        let mut best: BTreeMap<_, BTreeMap<_, _>> = BTreeMap::new();
        for ((level, difficulty), it) in &self.bests {
            best.entry(level.as_str()).or_default().insert(difficulty.name(), it);
        }
        let sections = Sections {
            saves: self.saves.iter().map(SavedGameText::from).collect(),
            descent: self.descent,
            best,
            daily: self.dailies.iter().map(|(date, it)| (date.to_string(), *it)).collect(),
        };
        write!(f, "\n{}", toml::to_string(&sections).map_err(|_| fmt::Error)?)
    }
}
