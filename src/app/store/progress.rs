//! Progress: the content of the store's file, and changes to it. A change is applied to the content
//! that the file has at that time.
//!
//! The file name of a script contains the level's key in escaped form. Lower-case letters, digits,
//! `-` and `_` stay; every other byte becomes `%` and two hexadecimal digits. Different keys
//! therefore have different names even on a file system that ignores case, and no name points
//! outside the folder. Windows reserves device names such as `con`, but not with a `%` in them, so
//! the first letter of such a name is escaped too.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::mem;

use serde::{Deserialize, Serialize};

use crate::app::controls::OwnKeys;
use crate::app::setting::Preferences;
use crate::game::{Game, Outcome, Rank, Rules, Script, Tally};
use crate::generate::floors_below;
use crate::rng;
use crate::terminal::Key;
use crate::world::{Difficulty, World};

/// The content of `progress.toml`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub(crate) struct Progress {
    /// The best results, by level key and difficulty.
    pub(crate) bests: BTreeMap<(String, Difficulty), Best>,
    /// The saved games, newest last. No two have the same [`SaveId`].
    pub(crate) saves: Vec<SavedEntry>,
    pub(crate) preferences: Preferences,
    pub(crate) keys: OwnKeys,
    /// The result of the daily run, by date.
    pub(crate) dailies: BTreeMap<u32, Reached>,
    pub(crate) descent: Option<Reached>,
}

/// A saved game without its script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Save {
    /// The level, as named in the header of a script.
    pub level: String,
    /// The absolute path of the map file; `None` if the level is not in a file.
    pub file: Option<String>,
    /// The rules with which the game began.
    pub rules: Rules,
    /// The kind of descent; `None` for a level.
    pub descent: Option<Descent>,
    /// The number of steps played.
    pub steps: u64,
    /// The checksum of the game at the end of the script. If a replay ends with a different
    /// checksum, then the level or the rules have changed since.
    pub checksum: u64,
}

/// A saved game. To continue it, the program replays its script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SavedGame {
    /// The description of the game.
    pub save: Save,
    /// The script up to the point where the player left.
    pub script: String,
}

/// Identifies a saved game. A saved game replaces an earlier one with the same identity: the same
/// level or map file at the same difficulty, or a descent of the same kind and seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SaveId(u64);

/// The reason why a game is not saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotSaved {
    /// There are already [`MAX_SAVES`] other saved games.
    #[error("{MAX_SAVES} other games are saved, which is the maximum")]
    Full,
    /// The script is longer than the longest script that the store reads.
    #[error("it is too long to save")]
    TooLong,
}

/// The maximum number of saved games.
pub const MAX_SAVES: usize = 100;

/// The kind of a descent. A descent begins on its first floor. The seed of a daily run or a
/// practice run is its date.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Descent {
    /// An endless descent.
    Endless,
    /// The daily try that counts.
    Daily,
    /// A later try on the same day.
    Practice,
}

/// A saved game as the file stores it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SavedEntry {
    pub(crate) save: Save,
    /// The file name of the script.
    pub(crate) script: String,
}

impl Progress {
    pub(crate) fn best(&self, level: &str, difficulty: Difficulty) -> Option<&Best> {
        self.bests.get(&(level.to_owned(), difficulty))
    }

    pub(crate) fn saved(&self, id: SaveId) -> Option<&SavedEntry> {
        self.saves.iter().find(|entry| entry.save.id() == id)
    }

    /// Adds a saved game as the newest one. It replaces the saved game with the same identity.
    pub(crate) fn add_save(&mut self, entry: SavedEntry) {
        self.remove_save(entry.save.id());
        self.saves.push(entry);
    }

    fn remove_save(&mut self, id: SaveId) {
        self.saves.retain(|entry| entry.save.id() != id);
    }

    /// The file names of all scripts that the progress refers to.
    pub(crate) fn scripts(&self) -> impl Iterator<Item = String> {
        let runs = self
            .bests
            .iter()
            .map(|((level, difficulty), best)| of_run(level, *difficulty, best.tally.steps));
        let saved = self.saves.iter().map(|entry| entry.script.clone());
        let dailies = self.dailies.iter().filter_map(|(&date, reached)| of_daily(date, *reached));
        runs.chain(saved).chain(dailies).chain(self.descent.and_then(of_descent))
    }
}

impl Save {
    /// The identity of the saved game.
    pub fn id(&self) -> SaveId {
        let place = self.file.as_deref().unwrap_or(&self.level);
        let kind = self.descent.map_or("level", Descent::name);
        let Rules { difficulty, seed } = self.rules;
        SaveId(hash(&format!("{kind} {} {seed} {place}", difficulty.name())))
    }
}

impl Descent {
    const NAMES: [(Self, &str); 3] =
        [(Self::Endless, "endless"), (Self::Daily, "daily"), (Self::Practice, "practice")];

    pub(crate) fn name(self) -> &'static str {
        Self::NAMES[self as usize].1
    }

    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(_, known)| *known == name).map(|&(kind, _)| kind)
    }
}

/// A change to the progress.
#[derive(Clone, Debug)]
pub(crate) enum Change {
    /// A run reached the exit.
    Won { level: String, difficulty: Difficulty, run: Run },
    /// A game was saved.
    Saved(SavedGame),
    /// A saved game was removed.
    Removed(SaveId),
    /// The player changed the preferences that differ between the two.
    Preferences { before: Preferences, after: Preferences },
    /// The player chose the keys of these actions; `None` for the usual keys.
    Keys(BTreeMap<&'static str, Option<Vec<Key>>>),
    /// The daily run of a date reached this point.
    Daily { date: u32, reached: Reached, script: String },
    /// A descent reached this point.
    Descent { reached: Reached, script: String },
}

impl Change {
    /// The file name and the text of the script that belongs to the change.
    pub(crate) fn written(&self) -> Option<(String, &str)> {
        match self {
            Self::Won { level, difficulty, run } => {
                Some((of_run(level, *difficulty, run.tally.steps), &run.script))
            }
            Self::Saved(game) => Some((of_saved(&game.script), &game.script)),
            Self::Daily { date, reached, script } => Some((of_daily(*date, *reached)?, script)),
            Self::Descent { reached, script } => Some((of_descent(*reached)?, script)),
            Self::Removed(_) | Self::Preferences { .. } | Self::Keys(_) => None,
        }
    }

    /// The text of the script in the file `name`, if it belongs to the change.
    pub(crate) fn script(&self, name: &str) -> Option<&str> {
        self.written().filter(|(own, _)| own == name).map(|(_, text)| text)
    }
}

impl Progress {
    /// Applies a change. The better of two results wins, in whichever order they come.
    pub(crate) fn apply(&mut self, change: &Change) {
        match change {
            Change::Won { level, difficulty, run } => {
                self.add_best((level.clone(), *difficulty), Best::of(run));
            }
            Change::Saved(SavedGame { save, script }) => {
                self.add_save(SavedEntry { save: save.clone(), script: of_saved(script) });
            }
            Change::Removed(id) => self.remove_save(*id),
            Change::Preferences { before, after } => self.preferences.choose(*before, *after),
            Change::Keys(changed) => {
                for (&name, keys) in changed {
                    match keys {
                        Some(keys) => drop(self.keys.insert(name, keys.clone())),
                        None => drop(self.keys.remove(name)),
                    }
                }
            }
            Change::Daily { date, reached, .. } => self.add_daily(*date, *reached),
            Change::Descent { reached, .. } => self.descent = self.descent.max(Some(*reached)),
        }
    }

    /// Restores from `known` the data that a damaged file has lost.
    pub(crate) fn complete(&mut self, known: &Self) {
        known.bests.iter().for_each(|(key, best)| self.add_best(key.clone(), *best));
        known.dailies.iter().for_each(|(date, reached)| self.add_daily(*date, *reached));
        self.descent = self.descent.max(known.descent);
        let readable = mem::replace(&mut self.saves, known.saves.clone());
        for entry in readable {
            self.add_save(entry);
        }
        self.preferences.choose(Preferences::default(), known.preferences);
        self.keys.clone_from(&known.keys);
    }

    fn add_best(&mut self, key: (String, Difficulty), best: Best) {
        let known = self.bests.get(&key);
        let best = known.map_or(best, |known| known.and(best));
        self.bests.insert(key, best);
    }

    fn add_daily(&mut self, date: u32, reached: Reached) {
        let known = self.dailies.entry(date).or_insert(reached);
        *known = reached.max(*known);
    }
}

/// A run that reached the exit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    /// The tally of the run.
    pub tally: Tally,
    /// The rank of the run.
    pub rank: Rank,
    /// The script of the run, with a header that names the level.
    pub script: String,
}

/// The best results in a level at one difficulty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Best {
    /// The tally of the fastest run.
    #[serde(flatten)]
    pub tally: Tally,
    /// The highest rank of all runs. If the player has taken time back in the fastest run, then also
    /// in the run with this rank.
    pub rank: Rank,
}

/// The improvements that a run made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Improved {
    /// `true` if the run is the fastest one.
    pub time: bool,
    /// `true` if its rank is higher than any rank before.
    pub rank: bool,
}

/// The result of a descent. More floors are better, then more treasure, then fewer steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Reached {
    /// The number of floors whose exit the player reached.
    pub floors: u32,
    /// The treasure found on these floors.
    pub treasure: u32,
    /// The number of steps that these floors took.
    pub steps: u64,
}

impl Reached {
    /// The result after one more floor with this tally.
    #[must_use]
    pub fn and(self, tally: &Tally) -> Self {
        Self {
            floors: self.floors + 1,
            treasure: self.treasure.saturating_add(tally.treasure.found),
            steps: self.steps + tally.steps,
        }
    }
}

impl Ord for Reached {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let by_value = (self.floors, self.treasure).cmp(&(other.floors, other.treasure));
        by_value.then(other.steps.cmp(&self.steps))
    }
}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Best {
    /// The results of one run.
    pub(crate) fn of(run: &Run) -> Self {
        Self { tally: run.tally, rank: run.rank }
    }

    /// The better value of each. If both runs are equally fast, the tally of `self` stays. The
    /// results of runs without time taken back replace the results of runs with it.
    pub fn and(self, other: Self) -> Self {
        match (self.tally.taken_back, other.tally.taken_back) {
            (0, 1..) => return self,
            (1.., 0) => return other,
            _ => {}
        }
        let fastest = if other.tally.steps < self.tally.steps { other } else { self };
        Self { tally: fastest.tally, rank: self.rank.max(other.rank) }
    }
}

/// A descent after a replay of its script.
pub struct DescentRun {
    /// The game on the last floor.
    pub game: Game,
    /// The result of the descent.
    pub reached: Reached,
}

/// The game at the end of `script`, or at the first exit that the script reaches.
pub fn replayed(world: World, rules: Rules, script: &Script) -> Game {
    let mut game = Game::with_rules(world, rules);
    for (_section, intents) in script.iter() {
        if game.is_finished() {
            break;
        }
        game.step(intents);
    }
    game
}

impl DescentRun {
    /// Replays `script` from `floor` on; `first` is the world of that floor. As during play, the
    /// descent ends with the first death, and finds count only after the exit of their floor is
    /// reached.
    pub fn replayed(floor: u32, first: World, rules: Rules, script: &Script) -> Self {
        let mut game = Game::with_rules(first, rules);
        let mut later = floors_below(rules.seed, floor);
        let mut reached = Reached::default();
        for (_section, intents) in script.iter() {
            if game.outcome() != Outcome::Playing {
                let Some(world) = later.next().filter(|_| game.is_finished()) else { break };
                game = Game::with_rules(world, rules);
            }
            game.step(intents);
            if game.is_finished() {
                reached = reached.and(&game.tally());
            }
        }
        Self { game, reached }
    }
}

/// The length limit of an escaped key, in bytes. The rest of a longer key is replaced by a hash.
const MAX_LENGTH: usize = 80;
/// The reserved names of devices. The last two are followed by a digit.
const DEVICES: [&str; 6] = ["con", "prn", "aux", "nul", "com", "lpt"];

/// The key of a map file in the store: the file's name without its folder, and a hash of its text.
/// Results do not carry over to a changed map.
pub fn map_key(file_name: &str, text: &str) -> String {
    let stem = file_name.strip_suffix(".toml").unwrap_or(file_name);
    format!("{stem}-{:016x}", hash(text))
}

/// The map's name in a [`map_key`]; `None` if `key` is not such a key.
pub fn name_in_map_key(key: &str) -> Option<&str> {
    let (name, hash) = key.rsplit_once('-')?;
    let is_digit = |byte: u8| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
    let is_hash = hash.len() == 16 && hash.bytes().all(is_digit);
    (is_hash && !name.is_empty()).then_some(name)
}

/// The file name for the script of a run.
pub(crate) fn of_run(level: &str, difficulty: Difficulty, steps: u64) -> String {
    format!("{}.{}.{steps}.script", escaped(level), difficulty.name())
}

/// The file name for the script of a saved game.
fn of_saved(script: &str) -> String {
    format!("{SAVED}.{:016x}.script", hash(script))
}

/// The file name for the script of a daily run; `None` before its first exit.
fn of_daily(date: u32, reached: Reached) -> Option<String> {
    Some(format!("daily.{date}.{}.script", figures(reached)?))
}

/// The file name for the script of a descent; `None` before its first exit.
pub(crate) fn of_descent(reached: Reached) -> Option<String> {
    Some(format!("descent.{}.script", figures(reached)?))
}

fn figures(Reached { floors, treasure, steps }: Reached) -> Option<String> {
    (floors > 0).then(|| format!("{floors}-{treasure}-{steps}"))
}

/// The first part of a saved game's file name. It differs from all other names, because the names
/// of levels end in a difficulty and a number, and the names of descents begin differently.
const SAVED: &str = "saved";

fn escaped(key: &str) -> String {
    let is_device = DEVICES.iter().any(|device| {
        key.strip_prefix(device).is_some_and(|rest| rest.is_empty() || rest.len() == 1)
    });
    let is_plain =
        |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || b"-_".contains(&byte);
    let mut name = String::new();
    for (index, byte) in key.bytes().enumerate() {
        if is_plain(byte) && !(is_device && index == 0) {
            name.push(char::from(byte));
        } else {
            _ = write!(name, "%{byte:02x}");
        }
    }
    if name.len() > MAX_LENGTH {
        name.truncate(MAX_LENGTH);
        _ = write!(name, "%%{:016x}", hash(key));
    }
    name
}

pub(crate) fn hash(text: &str) -> u64 {
    let words = text.as_bytes().chunks(8).map(|chunk| {
        let mut word = [0; 8];
        word[..chunk.len()].copy_from_slice(chunk);
        u64::from_le_bytes(word)
    });
    rng::hash(text.len() as u64, words)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    #[test]
    fn names_are_safe_in_every_file_system() {
        let name = |level| of_run(level, Difficulty::Hard, 7);
        assert_eq!(name("cellar"), "cellar.hard.7.script");
        assert_eq!(name("../Etc\\x y"), "%2e%2e%2f%45tc%5cx%20y.hard.7.script");
        assert_eq!(name("con"), "%63on.hard.7.script");
        assert_eq!(name("lpt1"), "%6cpt1.hard.7.script");
        assert_eq!(name("console"), "console.hard.7.script");
        assert_eq!(name(""), ".hard.7.script");
        assert!(name(&"ä".repeat(4000)).len() < 130);
        assert_eq!(map_key("My map.toml", "grid"), "My map-e6ec39ffc58f483c");
    }

    proptest! {
        #[test]
        fn different_levels_have_different_files(keys in prop::collection::vec("(?s).{0,60}", 2..20)) {
            let mut names = BTreeMap::new();
            for key in keys {
                let name = of_run(&key, Difficulty::Easy, 1);
                prop_assert!(name.bytes().all(|byte| byte == b'%' || byte == b'.' || byte == b'-'
                    || byte == b'_' || byte.is_ascii_lowercase() || byte.is_ascii_digit()));
                let other = names.insert(name, key.clone());
                prop_assert!(other.is_none_or(|other| other == key));
            }
        }
    }
}
