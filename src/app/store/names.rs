//! Names of files for any level, and keys for maps.
//!
//! A name holds only lower-case letters, digits, `-` and `_` of the level's key; every other byte
//! is `%` and its two hexadecimal digits. So different keys have different names where upper and
//! lower case are the same, and no name leaves the folder. Device names of Windows, such as `con`,
//! are not reserved with `%` in them, so their first letter is written that way.

use std::fmt::Write;

use super::results::Reached;
use crate::rng;
use crate::world::Difficulty;

/// In bytes. Of a longer name the rest is replaced by a hash.
const LONGEST: usize = 80;
/// Names of devices, with a digit after the last two.
const DEVICES: [&str; 6] = ["con", "prn", "aux", "nul", "com", "lpt"];

/// The key of a map file in the store: its name without the folder, and a hash of its text. The
/// results of a map that has changed do not count for it.
pub fn map_key(file_name: &str, text: &str) -> String {
    let stem = file_name.strip_suffix(".toml").unwrap_or(file_name);
    format!("{stem}-{:016x}", hash(text))
}

/// The name of the map in a [`map_key`]; `None` if `key` is none.
pub fn name_in_map_key(key: &str) -> Option<&str> {
    let (name, hash) = key.rsplit_once('-')?;
    let is_digit = |byte: u8| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
    let is_hash = hash.len() == 16 && hash.bytes().all(is_digit);
    (is_hash && !name.is_empty()).then_some(name)
}

/// The file of the script of a run.
pub(crate) fn of_run(level: &str, difficulty: Difficulty, steps: u64) -> String {
    format!("{}.{}.{steps}.script", escaped(level), difficulty.name())
}

/// The file of the script of a saved game.
pub(crate) fn of_saved(script: &str) -> String {
    format!("{SAVED}.{:016x}.script", hash(script))
}

/// The file of the script of a daily run, once it has reached an exit.
pub(crate) fn of_daily(date: u32, reached: Reached) -> Option<String> {
    Some(format!("daily.{date}.{}.script", figures(reached)?))
}

/// The file of the script of a descent, once it has reached an exit.
pub(crate) fn of_descent(reached: Reached) -> Option<String> {
    Some(format!("descent.{}.script", figures(reached)?))
}

fn figures(Reached { floors, treasure, steps }: Reached) -> Option<String> {
    (floors > 0).then(|| format!("{floors}-{treasure}-{steps}"))
}

/// No level has this name or a descent's: the names of levels end in a difficulty and a number.
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
    if name.len() > LONGEST {
        name.truncate(LONGEST);
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
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::*;

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
