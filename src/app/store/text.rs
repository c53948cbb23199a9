//! The text of `progress.toml`: reading and writing a [`Progress`].
//!
//! All readable parts of a damaged text are read. A result counts only as a whole: if one of its
//! values is damaged, the result is left out. A last line without a line end is dropped, because a
//! truncated number would look like a better result.
//!
//! Rejected: serde. It gives up a section at the first damaged value. Its writer escapes characters
//! differently, which would change every existing file.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use toml::de::DeValue;

use super::progress::{Best, Reached};
use super::progress::{Descent, Progress, Save, SavedEntry};
use crate::app::controls::{Action, OwnKeys};
use crate::app::setting::{PREFERENCES, Preferences, toml_string};
use crate::app::settings::toml_keys;
use crate::fault::Fault;
use crate::fault::document::{self, Entry, FaultList};
use crate::game::{Rank, Rules, Share, Tally};
use crate::terminal::Key;
use crate::world::Difficulty;

/// The version of the format. Version 2 added the saved descent, the checksum of saved games, and
/// the preferences about the terminal. Version 3 allows any number of saved games.
const VERSION: u64 = 3;
/// The oldest version that can still be read.
const OLDEST: u64 = 1;
/// The number of preferences in version 1. They are always written. Later preferences are written
/// if they differ from the default.
const OLDEST_PREFERENCES: usize = 5;

/// The key of the number of times that time was taken back, which is left out if it is 0.
const TAKEN_BACK: &str = "taken-back";

/// The table of the keys that the player has chosen.
const KEYS: &str = "keys";
/// The table of saved games. Its sections have numbers, and the newest game has the largest one.
const SAVES: &str = "saves";
/// The sections for the only saved level and the only saved descent in older versions.
const SAVED: &str = "saved";
const SAVED_DESCENT: &str = "saved-descent";

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
            "version" => version = checked(&entry, number(&entry)),
            "preferences" => read_preferences(&entry, &mut progress.preferences),
            KEYS => read_keys(&entry, &mut progress.keys),
            SAVED | SAVED_DESCENT => saved(&entry).into_iter().for_each(|it| progress.add_save(it)),
            SAVES => read_saves(&entry, &mut progress),
            "descent" => progress.descent = reached(&entry),
            "best" => read_bests(&entry, &mut progress),
            "daily" => read_dailies(&entry, &mut progress),
            _ => damaged(&entry),
        }
    }
    match version {
        Some(newer) if newer > VERSION => Err(newer),
        Some(OLDEST..) => Ok((progress, faults.is_empty() && !is_cut)),
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
        let keys = Action::entry(entry.key).zip(keys(&entry));
        if let Some(((name, _), keys)) = checked(&entry, keys) {
            own.insert(name, keys);
        }
    }
}

fn keys(entry: &Entry<'_, '_>) -> Option<Vec<Key>> {
    let DeValue::Array(names) = entry.value else { return None };
    names.iter().map(|name| name.get_ref().as_str()?.parse().ok()).collect()
}

/// Reads the saved games in the order of their numbers.
fn read_saves(section: &Entry<'_, '_>, progress: &mut Progress) {
    let mut saves = BTreeMap::new();
    for entry in inner(section) {
        let number = checked(&entry, entry.key.parse::<u64>().ok());
        if let (Some(number), Some(save)) = (number, saved(&entry)) {
            saves.insert(number, save);
        }
    }
    for save in saves.into_values() {
        progress.add_save(save);
    }
}

fn read_bests(section: &Entry<'_, '_>, progress: &mut Progress) {
    for level in inner(section) {
        for result in inner(&level) {
            let at = checked(&result, Difficulty::named(result.key));
            if let (Some(at), Some(best)) = (at, best(&result)) {
                progress.bests.insert((level.key.to_owned(), at), best);
            }
        }
    }
}

fn read_dailies(section: &Entry<'_, '_>, progress: &mut Progress) {
    for entry in inner(section) {
        let date = checked(&entry, entry.key.parse().ok());
        if let (Some(date), Some(reached)) = (date, reached(&entry)) {
            progress.dailies.insert(date, reached);
        }
    }
}

fn saved(section: &Entry<'_, '_>) -> Option<SavedEntry> {
    whole(section, |values| {
        let file = values.take("file", |entry| text(entry).map(str::to_owned));
        let steps = values.take("steps", number);
        let checksum = values.take("checksum", |it| u64::from_str_radix(text(it)?, 16).ok());
        let descent = values.take("descent", |entry| Descent::named(text(entry)?));
        if section.key == SAVED_DESCENT && descent.is_none() {
            return None;
        }
        let level = values.take("level", |entry| text(entry).map(str::to_owned))?;
        let difficulty = values.take("difficulty", |entry| Difficulty::named(text(entry)?))?;
        // TOML integers have one bit less.
        let seed = values.take("seed", |entry| text(entry)?.parse().ok())?;
        let script = values.take("script", |entry| file_name(text(entry)?))?;
        let rules = Rules { difficulty, seed };
        Some(SavedEntry { save: Save { level, file, rules, descent, steps, checksum }, script })
    })
}

fn best(section: &Entry<'_, '_>) -> Option<Best> {
    whole(section, |values| {
        let tally = Tally {
            steps: values.take("steps", number)?,
            treasure: values.take("treasure", share)?,
            secrets: values.take("secrets", share)?,
            alarms: values.take("alarms", number)?,
            deaths: values.take("deaths", number)?,
            stunned: values.take("stunned", number)?,
            taken_back: values.take(TAKEN_BACK, number).unwrap_or(0),
        };
        Some(Best { tally, rank: values.take("rank", |entry| Rank::named(text(entry)?))? })
    })
}

fn reached(section: &Entry<'_, '_>) -> Option<Reached> {
    whole(section, |values| {
        Some(Reached {
            floors: values.take("floors", number)?,
            treasure: values.take("treasure", number)?,
            steps: values.take("steps", number)?,
        })
    })
}

/// The values of a section that have not been read yet.
struct Values<'a, 't>(Vec<Entry<'a, 't>>);

impl Values<'_, '_> {
    /// The value of `key`; `None` if it is missing or damaged.
    fn take<T>(&mut self, key: &str, read: impl FnOnce(&Entry<'_, '_>) -> Option<T>) -> Option<T> {
        let index = self.0.iter().position(|entry| entry.key == key)?;
        let entry = self.0.swap_remove(index);
        checked(&entry, read(&entry))
    }
}

/// The content of a section according to `read`. Every value that `read` does not take is damaged.
/// If `read` returns `None`, the section is damaged.
fn whole<T>(
    section: &Entry<'_, '_>,
    read: impl FnOnce(&mut Values<'_, '_>) -> Option<T>,
) -> Option<T> {
    let mut values = Values(inner(section).collect());
    let content = read(&mut values);
    values.0.iter().for_each(damaged);
    checked(section, content)
}

/// The entries of a section; empty if the entry is not a section.
fn inner<'a, 't>(section: &Entry<'a, 't>) -> impl Iterator<Item = Entry<'a, 't>> {
    section.table(EXAMPLE).into_iter().flat_map(|table| document::entries(table, section.faults))
}

fn text<'a>(entry: &Entry<'a, '_>) -> Option<&'a str> {
    entry.string(EXAMPLE)
}

/// `name`, unless it could point outside the folder.
fn file_name(name: &str) -> Option<String> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '.';
    (name.ends_with(".script") && name.chars().all(is_plain)).then(|| name.to_owned())
}

fn share(entry: &Entry<'_, '_>) -> Option<Share> {
    let [found, total] = entry.pair(EXAMPLE)?;
    Some(Share { found: number(&found)?, total: number(&total)? })
}

fn number<T: TryFrom<u64>>(entry: &Entry<'_, '_>) -> Option<T> {
    let DeValue::Integer(digits) = entry.value else { return None };
    u64::from_str_radix(digits.as_str(), digits.radix()).ok()?.try_into().ok()
}

/// Returns `value`, and reports the entry as damaged if it is `None`.
fn checked<T>(entry: &Entry<'_, '_>, value: Option<T>) -> Option<T> {
    if value.is_none() {
        damaged(entry);
    }
    value
}

fn damaged(entry: &Entry<'_, '_>) {
    entry.faults.push(Fault::new(entry.value_place.clone(), "this is damaged"));
}

/// The faults of this file are counted and never shown, so they need no example.
const EXAMPLE: &str = "";

impl fmt::Display for Progress {
    /// Writes the whole file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "# The progress of a player of Cellcaster. The game replaces this file.")?;
        writeln!(f, "version = {VERSION}")?;
        write_preferences(f, &self.preferences)?;
        if !self.keys.is_empty() {
            writeln!(f, "\n[{KEYS}]")?;
        }
        for (name, keys) in &self.keys {
            writeln!(f, "{name} = {}", toml_keys(keys.iter().copied()))?;
        }
        for (number, saved) in (1..).zip(&self.saves) {
            write_saved(f, number, saved)?;
        }
        if let Some(reached) = self.descent {
            writeln!(f, "\n[descent]")?;
            write_reached(f, reached)?;
        }
        for ((level, difficulty), best) in &self.bests {
            writeln!(f, "\n[best.{}.{}]", toml_string(level), difficulty.name())?;
            write_best(f, best)?;
        }
        for (date, reached) in &self.dailies {
            writeln!(f, "\n[daily.{date}]")?;
            write_reached(f, *reached)?;
        }
        Ok(())
    }
}

fn write_preferences(f: &mut fmt::Formatter<'_>, preferences: &Preferences) -> fmt::Result {
    let default = Preferences::default();
    writeln!(f, "\n[preferences]")?;
    for (index, setting) in PREFERENCES.iter().enumerate() {
        if index < OLDEST_PREFERENCES || setting.value.differs(preferences, &default) {
            writeln!(f, "{} = {}", setting.key, setting.value.write(preferences))?;
        }
    }
    Ok(())
}

fn write_saved(f: &mut fmt::Formatter<'_>, number: u64, saved: &SavedEntry) -> fmt::Result {
    let SavedEntry { save, script } = saved;
    let Save { level, file, rules: Rules { difficulty, seed }, descent, steps, checksum } = save;
    writeln!(f, "\n[{SAVES}.{number}]\nlevel = {}", toml_string(level))?;
    if let Some(file) = file {
        writeln!(f, "file = {}", toml_string(file))?;
    }
    writeln!(f, "difficulty = \"{}\"\nseed = \"{seed}\"", difficulty.name())?;
    if let Some(descent) = descent {
        writeln!(f, "descent = \"{}\"", descent.name())?;
    }
    if let Some(steps) = steps {
        writeln!(f, "steps = {steps}")?;
    }
    if let Some(checksum) = checksum {
        writeln!(f, "checksum = \"{checksum:016x}\"")?;
    }
    // The script comes last, because a saved game without it does not count. A truncated file
    // therefore never contains a saved game that has lost its checksum.
    writeln!(f, "script = {}", toml_string(script))
}

fn write_best(f: &mut fmt::Formatter<'_>, best: &Best) -> fmt::Result {
    let Best { tally, rank } = best;
    writeln!(f, "steps = {}", tally.steps)?;
    for (name, Share { found, total }) in [("treasure", tally.treasure), ("secrets", tally.secrets)]
    {
        writeln!(f, "{name} = [{found}, {total}]")?;
    }
    writeln!(f, "alarms = {}\ndeaths = {}", tally.alarms, tally.deaths)?;
    if tally.taken_back > 0 {
        writeln!(f, "{TAKEN_BACK} = {}", tally.taken_back)?;
    }
    writeln!(f, "stunned = {}\nrank = \"{}\"", tally.stunned, rank.name())
}

fn write_reached(f: &mut fmt::Formatter<'_>, reached: Reached) -> fmt::Result {
    let Reached { floors, treasure, steps } = reached;
    writeln!(f, "floors = {floors}\ntreasure = {treasure}\nsteps = {steps}")
}
