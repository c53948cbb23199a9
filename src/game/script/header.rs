//! Headers of scripts: the game that a script belongs to.

use std::fmt;
use std::ops::Range;

use super::parse::{trimmed, words};
use crate::fault::{Fault, nearest, quoted};
use crate::game::Rules;
use crate::world::Difficulty;

/// The game that a script belongs to, as far as it says so.
///
/// ```
/// use cellcaster::game::Script;
///
/// let script = Script::parse("level cellar\nseed 7\n2 s forward\n", "walk.script")?;
/// assert_eq!(script.header().level.as_ref().unwrap().as_str(), "cellar");
/// assert_eq!((script.header().difficulty, script.header().seed), (None, Some(7)));
/// # Ok::<(), cellcaster::fault::Faults>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Header {
    /// The level.
    pub level: Option<LevelName>,
    /// The difficulty.
    pub difficulty: Option<Difficulty>,
    /// The seed of the game's chance, and of the descent if the level is a floor. The levels of maps are
    /// played with the seed 0, so that they are the same for all and a route can be learnt.
    pub seed: Option<u64>,
}

/// The name of a level in a header: that of a built-in level, `floor` and a number for a
/// [descent](crate::generate::descent) from that floor on, or the path of a map file. It is one line without `#`, and has no
/// blanks at its ends.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LevelName(String);

/// The words with which the lines of a header begin.
const WORDS: [&str; 3] = [LEVEL, DIFFICULTY, SEED];
const LEVEL: &str = "level";
const DIFFICULTY: &str = "difficulty";
const SEED: &str = "seed";
/// The word before the number of a floor.
const FLOOR: &str = "floor ";

impl LevelName {
    /// The name `name`, if a header can have it.
    pub fn new(name: &str) -> Option<Self> {
        let is_line = !name.is_empty() && name.trim() == name;
        let is_plain = !name.contains(|c: char| c == '#' || c.is_control());
        (is_line && is_plain).then(|| Self(name.to_owned()))
    }

    /// The name of a floor of the descent, counted from 1.
    pub fn of_floor(number: u32) -> Self {
        Self(format!("{FLOOR}{number}"))
    }

    /// The name.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The number of the floor, if it is one.
    pub fn floor(&self) -> Option<u32> {
        let number = self.0.strip_prefix(FLOOR)?.trim_start().parse().ok();
        number.filter(|&number| number > 0)
    }
}

impl fmt::Display for Header {
    /// Writes its lines.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(level) = &self.level {
            writeln!(f, "{LEVEL:<10} {}", level.as_str())?;
        }
        if let Some(difficulty) = self.difficulty {
            writeln!(f, "{DIFFICULTY:<10} {}", difficulty.name())?;
        }
        if let Some(seed) = self.seed {
            writeln!(f, "{SEED:<10} {seed}")?;
        }
        Ok(())
    }
}

impl Header {
    /// The header of a game in `level` with these rules.
    pub fn of(level: Option<LevelName>, rules: Rules) -> Self {
        Self { level, difficulty: Some(rules.difficulty), seed: Some(rules.seed) }
    }

    /// The rules, with defaults where it does not say.
    pub fn rules(&self) -> Rules {
        let Rules { difficulty, seed } = Rules::default();
        Rules { difficulty: self.difficulty.unwrap_or(difficulty), seed: self.seed.unwrap_or(seed) }
    }

    /// Whether it says nothing.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Whether a line that begins with `word` belongs to a header.
    pub(crate) fn has(word: &str) -> bool {
        WORDS.contains(&word)
    }

    /// Reads a line that begins with one of the words.
    pub(crate) fn read_line(&mut self, text: &str, line: Range<usize>) -> Result<(), Fault> {
        let Some(first) = words(text, line.clone()).into_iter().next() else { return Ok(()) };
        let word = &text[first.clone()];
        let value_place = trimmed(text, first.end..line.end);
        let value = &text[value_place.clone()];
        let is_said = match word {
            LEVEL => self.level.is_some(),
            DIFFICULTY => self.difficulty.is_some(),
            _ => self.seed.is_some(),
        };
        if is_said {
            return Err(
                Fault::new(line, format!("{} is set twice", quoted(word))).label("once is enough")
            );
        }
        if value.is_empty() {
            return Err(Fault::new(first, format!("{} has no value", quoted(word)))
                .label("which one?")
                .help(example(word)));
        }
        let is_read = match word {
            LEVEL => {
                self.level = LevelName::new(value);
                self.level.is_some()
            }
            DIFFICULTY => {
                self.difficulty = Difficulty::named(value);
                self.difficulty.is_some()
            }
            _ => {
                self.seed = value.parse().ok();
                self.seed.is_some()
            }
        };
        if is_read { Ok(()) } else { Err(no_value(word, value, value_place)) }
    }
}

fn no_value(word: &str, value: &str, place: Range<usize>) -> Fault {
    let message = match word {
        LEVEL => "a level's name has no control characters".to_owned(),
        DIFFICULTY => format!("there is no difficulty {}", quoted(value)),
        _ => "a seed is a whole number from 0 to 18446744073709551615".to_owned(),
    };
    let names = Difficulty::ALL.map(Difficulty::name);
    let meant = if word == DIFFICULTY { nearest(value, &names) } else { None };
    let help = match meant {
        Some(meant) => format!("the nearest is {}", quoted(meant)),
        None => example(word),
    };
    Fault::new(place, message).label("not valid").help(help)
}

fn example(word: &str) -> String {
    match word {
        LEVEL => "write level cellar, level floor 3 or level my.toml".to_owned(),
        DIFFICULTY => "write difficulty easy, difficulty normal or difficulty hard".to_owned(),
        _ => "write seed 7".to_owned(),
    }
}
