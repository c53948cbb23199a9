//! Reading: from the text of `progress.toml` to a [`Progress`].
//!
//! Of a damaged text, all that can be read is. A result counts only as a whole: if one of its values
//! is damaged, it is none. A last line without an end is dropped, because a number that was cut
//! short would be a better result.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::num::NonZeroU32;

use toml::de::DeValue;

use super::progress::{Daily, Descent, Preferences, Progress, Save, SavedEntry};
use super::results::{Best, Reached};
use super::values::{
    COLORS, CORRECTIONS, GLYPHS, OLDEST, SAVED, SAVED_DESCENT, SAVES, VERSION, named,
};
use crate::fault::Fault;
use crate::fault::document::{self, Entry, FaultList};
use crate::game::{Rank, Rules, Share, Tally};
use crate::world::Difficulty;

/// What a text contains.
#[derive(Debug, PartialEq)]
pub(crate) enum Content {
    Sound(Progress),
    /// What can be read of it.
    Damaged(Progress),
    /// A format of this version, which this program does not know.
    Newer(u64),
}

/// Reads the content of the file.
pub(crate) fn read(content: &[u8]) -> Content {
    let text = String::from_utf8_lossy(content);
    let whole = text.rfind('\n').map_or(0, |end| end + 1);
    let is_cut = whole < text.len() || matches!(text, Cow::Owned(_));
    let faults = FaultList::default();
    let document = document::parse(&text[..whole], &faults);
    let mut progress = Progress::default();
    let mut version = None;
    for entry in document::entries(&document, &faults) {
        match entry.key {
            "version" => version = number(&entry),
            "preferences" => read_preferences(&entry, &mut progress.preferences),
            SAVED | SAVED_DESCENT => saved(&entry).into_iter().for_each(|it| progress.add_save(it)),
            SAVES => read_saves(&entry, &mut progress),
            "descent" => progress.descent = reached(&entry),
            "best" => read_bests(&entry, &mut progress),
            "daily" => read_dailies(&entry, &mut progress),
            _ => damaged(&entry),
        }
    }
    match version {
        Some(newer) if newer > VERSION => Content::Newer(newer),
        Some(OLDEST..=VERSION) if faults.is_empty() && !is_cut => Content::Sound(progress),
        _ => Content::Damaged(progress),
    }
}

fn read_preferences(section: &Entry<'_, '_>, preferences: &mut Preferences) {
    fn set<T>(value: &mut T, read: Option<T>) {
        if let Some(read) = read {
            *value = read;
        }
    }
    for entry in inner(section) {
        match entry.key {
            "crosshair" => set(&mut preferences.crosshair, boolean(&entry)),
            "compass" => set(&mut preferences.compass, boolean(&entry)),
            "bell" => set(&mut preferences.bell, boolean(&entry)),
            "ghost" => set(&mut preferences.ghost, boolean(&entry)),
            "difficulty" => set(&mut preferences.difficulty, difficulty(&entry)),
            "glyphs" => preferences.glyphs = checked(&entry, name_in(&entry, &GLYPHS)),
            "colors" => preferences.colors = checked(&entry, name_in(&entry, &COLORS)),
            "correction" => {
                set(&mut preferences.correction, checked(&entry, name_in(&entry, &CORRECTIONS)));
            }
            "fps" => {
                let frames = small_number(&entry).filter(|frames| (1..=240).contains(frames));
                preferences.frames_per_second = checked(&entry, frames.and_then(NonZeroU32::new));
            }
            _ => damaged(&entry),
        }
    }
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

fn saved(section: &Entry<'_, '_>) -> Option<SavedEntry> {
    let (mut level, mut file, mut at, mut seed) = (None, None, None, None);
    let (mut descent, mut steps, mut checksum, mut script) = (None, None, None, None);
    for entry in inner(section) {
        match entry.key {
            "level" => level = entry.string(EXAMPLE).map(str::to_owned),
            "file" => file = entry.string(EXAMPLE).map(str::to_owned),
            "steps" => steps = number(&entry),
            "difficulty" => at = difficulty(&entry),
            // TOML's own numbers have one bit less.
            "seed" => seed = checked(&entry, entry.string(EXAMPLE).and_then(|it| it.parse().ok())),
            "script" => script = checked(&entry, entry.string(EXAMPLE).and_then(file_name)),
            "checksum" => {
                let digits = entry.string(EXAMPLE);
                let read = digits.and_then(|digits| u64::from_str_radix(digits, 16).ok());
                checksum = checked(&entry, read);
            }
            "descent" => {
                descent = checked(&entry, entry.string(EXAMPLE).and_then(Descent::named));
            }
            _ => damaged(&entry),
        }
    }
    let complete = || {
        let rules = Rules { difficulty: at?, seed: seed? };
        let save = Save { level: level?, file, rules, descent, steps, checksum };
        let is_whole = section.key != SAVED_DESCENT || save.descent.is_some();
        is_whole.then_some(SavedEntry { save, script: script? })
    };
    checked(section, complete())
}

/// The value in `names` that the entry names.
fn name_in<T: Copy>(entry: &Entry<'_, '_>, names: &[(T, &str)]) -> Option<T> {
    named(names, entry.string(EXAMPLE)?)
}

/// `name`, unless it leaves the folder.
fn file_name(name: &str) -> Option<String> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '.';
    (name.ends_with(".script") && name.chars().all(is_plain)).then(|| name.to_owned())
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

fn best(section: &Entry<'_, '_>) -> Option<Best> {
    let (mut steps, mut treasure, mut secrets) = (None, None, None);
    let (mut alarms, mut deaths, mut stunned, mut rank) = (None, None, None, None);
    for entry in inner(section) {
        match entry.key {
            "steps" => steps = number(&entry),
            "treasure" => treasure = share(&entry),
            "secrets" => secrets = share(&entry),
            "alarms" => alarms = small_number(&entry),
            "deaths" => deaths = small_number(&entry),
            "stunned" => stunned = small_number(&entry),
            "rank" => {
                let name = entry.string(EXAMPLE);
                rank = checked(&entry, name.and_then(Rank::named));
            }
            _ => damaged(&entry),
        }
    }
    let complete = || {
        let tally = Tally {
            steps: steps?,
            treasure: treasure?,
            secrets: secrets?,
            alarms: alarms?,
            deaths: deaths?,
            stunned: stunned?,
        };
        Some(Best { tally, rank: rank? })
    };
    checked(section, complete())
}

fn read_dailies(section: &Entry<'_, '_>, progress: &mut Progress) {
    for entry in inner(section) {
        let date = checked(&entry, entry.key.parse().ok());
        if let (Some(date), Some(reached)) = (date, reached(&entry)) {
            progress.dailies.insert(date, Daily { reached });
        }
    }
}

fn reached(section: &Entry<'_, '_>) -> Option<Reached> {
    let (mut floors, mut treasure, mut steps) = (None, None, None);
    for entry in inner(section) {
        match entry.key {
            "floors" => floors = small_number(&entry),
            "treasure" => treasure = small_number(&entry),
            "steps" => steps = number(&entry),
            _ => damaged(&entry),
        }
    }
    let complete = || Some(Reached { floors: floors?, treasure: treasure?, steps: steps? });
    checked(section, complete())
}

/// The entries of a section; none if it is no section.
fn inner<'a, 't>(section: &Entry<'a, 't>) -> impl Iterator<Item = Entry<'a, 't>> {
    section.table(EXAMPLE).into_iter().flat_map(|table| document::entries(table, section.faults))
}

fn share(entry: &Entry<'_, '_>) -> Option<Share> {
    let [found, total] = entry.pair(EXAMPLE)?;
    Some(Share { found: small_number(&found)?, total: small_number(&total)? })
}

fn small_number(entry: &Entry<'_, '_>) -> Option<u32> {
    checked(entry, number(entry).and_then(|number| u32::try_from(number).ok()))
}

fn number(entry: &Entry<'_, '_>) -> Option<u64> {
    let number = match entry.value {
        DeValue::Integer(digits) => u64::from_str_radix(digits.as_str(), digits.radix()).ok(),
        _ => None,
    };
    checked(entry, number)
}

fn boolean(entry: &Entry<'_, '_>) -> Option<bool> {
    let boolean = match entry.value {
        DeValue::Boolean(boolean) => Some(*boolean),
        _ => None,
    };
    checked(entry, boolean)
}

fn difficulty(entry: &Entry<'_, '_>) -> Option<Difficulty> {
    checked(entry, entry.string(EXAMPLE).and_then(Difficulty::named))
}

/// `value`; reports the entry as damaged if there is none.
fn checked<T>(entry: &Entry<'_, '_>, value: Option<T>) -> Option<T> {
    if value.is_none() {
        damaged(entry);
    }
    value
}

fn damaged(entry: &Entry<'_, '_>) {
    entry.faults.push(Fault::new(entry.value_place.clone(), "this is damaged"));
}

/// Faults of this file are counted, not shown.
const EXAMPLE: &str = "";
