//! The definitions of tiles and things, and a character for each.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::properties::{CHARACTER, Properties, toml_key};

/// The keys of a tile or a thing, with their values as TOML and the origin of each.
#[derive(Clone, Default)]
pub(crate) struct Definition {
    pub(crate) keys: BTreeMap<String, KeyValue>,
    pub(crate) character: Option<char>,
}

#[derive(Clone)]
pub(crate) struct KeyValue {
    pub(crate) toml: String,
    pub(crate) origin: Rc<str>,
    /// `true` if it belongs to the floor or the ceiling, which a wall hides.
    pub(crate) is_ground: bool,
}

impl Definition {
    pub(crate) fn has(&self, keys: &[&str]) -> bool {
        keys.iter().any(|key| self.keys.contains_key(*key))
    }

    pub(crate) fn set(&mut self, key: &str, toml: String, origin: &Rc<str>) {
        let key_value = KeyValue { toml, origin: origin.clone(), is_ground: false };
        self.keys.insert(key.to_owned(), key_value);
    }

    pub(crate) fn take(&mut self, properties: &Properties, origin: &Rc<str>) {
        for (name, property) in &properties.0 {
            if name != CHARACTER {
                self.set(name, property.to_toml(), origin);
            }
        }
        self.character = properties.character().or(self.character);
    }

    /// The table of the definition. Two definitions are the same if it is.
    fn table(&self) -> String {
        let entries = self.keys.iter().map(|(key, it)| format!("{} = {}", toml_key(key), it.toml));
        format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
    }
}

/// The characters of a map.
pub(crate) struct Characters {
    /// The characters that nothing has yet, the next one last.
    free: Vec<char>,
    /// The characters that definitions ask for.
    reserved: BTreeSet<char>,
    taken: BTreeSet<char>,
    of_tables: BTreeMap<(bool, String, Option<char>), char>,
    /// `true` after there was none left.
    pub(crate) are_exhausted: bool,
}

impl Characters {
    /// Keeps the characters that `definitions` ask for.
    pub(crate) fn reserve<'d>(&mut self, definitions: impl Iterator<Item = &'d Definition>) {
        self.reserved.extend(definitions.filter_map(|definition| definition.character));
    }

    pub(crate) fn of_tile(&mut self, tile: &Definition) -> char {
        self.of(true, tile)
    }

    pub(crate) fn of_thing(&mut self, thing: &Definition) -> char {
        self.of(false, thing)
    }

    fn of(&mut self, is_tile: bool, definition: &Definition) -> char {
        let key = (is_tile, definition.table(), definition.character);
        if let Some(&known) = self.of_tables.get(&key) {
            return known;
        }
        let character = self.of_its_own(Some(definition));
        self.of_tables.insert(key, character);
        character
    }

    /// A character that nothing else has, if possible the character that the definition asks for.
    pub(crate) fn of_its_own(&mut self, definition: Option<&Definition>) -> char {
        let asked = definition.and_then(|definition| definition.character);
        if let Some(asked) = asked.filter(|asked| self.taken.insert(*asked)) {
            return asked;
        }
        let usual = definition.map_or("123456789", |it| {
            let usual = [("wall", "#"), ("door", "+"), ("start", "@"), ("exit", "X")];
            usual.iter().find(|(key, _)| it.has(&[key])).map_or("", |(_, character)| character)
        });
        let is_free = |it: &char| !self.taken.contains(it) && !self.reserved.contains(it);
        let usual = usual.chars().find(is_free);
        let character = usual.or_else(|| {
            loop {
                let next = self.free.pop()?;
                if is_free(&next) {
                    break Some(next);
                }
            }
        });
        self.are_exhausted |= character.is_none();
        let character = character.unwrap_or('.');
        self.taken.insert(character);
        character
    }
}

impl Default for Characters {
    fn default() -> Self {
        let letters =
            ('A'..='Z').chain('a'..='z').chain('0'..='9').chain("%&$=~^*!?:;,|/<>".chars());
        let others = [('\u{c0}', '\u{24f}'), ('\u{400}', '\u{47f}'), ('\u{4e00}', '\u{9fff}')];
        let others = others.into_iter().flat_map(|(first, last)| first..=last);
        let mut free: Vec<char> = letters.chain(others).collect();
        free.reverse();
        Self {
            free,
            reserved: BTreeSet::new(),
            taken: BTreeSet::new(),
            of_tables: BTreeMap::new(),
            are_exhausted: false,
        }
    }
}
