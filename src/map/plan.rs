//! The plan of a level: its drawing with the meanings of the characters.

use std::collections::BTreeSet;

use super::drawing::Drawing;
use super::legend::tiles::DoorText;
use super::legend::{Legend, Meaning, Symbol};
use super::values::Name;
use crate::sort;

/// A drawing with its legend.
#[derive(Clone, Copy)]
pub(crate) struct Plan<'l> {
    pub(crate) drawing: &'l Drawing<'l>,
    pub(crate) legend: &'l Legend<'l>,
}

impl<'l> Plan<'l> {
    /// The definition of `character`.
    pub(crate) fn symbol(self, character: char) -> Option<&'l Symbol<'l>> {
        self.legend.symbols.get(&character)
    }

    /// Returns whether the meaning of `character` `is_such`.
    pub(crate) fn means(self, character: char, is_such: impl Fn(&Meaning<'_>) -> bool) -> bool {
        self.symbol(character).is_some_and(|symbol| is_such(&symbol.meaning))
    }

    /// The characters that are drawn and defined, in order, with their definitions.
    pub(crate) fn symbols(self) -> impl Iterator<Item = (char, &'l Symbol<'l>)> {
        let drawn = self.drawing.characters();
        drawn.filter_map(move |character| Some((character, self.symbol(character)?)))
    }

    /// The number of cells whose definition `is_such`, the definition among these that is drawn
    /// most often, and the number of its cells. `None` if no such cell is drawn.
    pub(crate) fn count(
        self,
        is_such: impl Fn(&Symbol<'_>) -> bool,
    ) -> Option<(usize, &'l Symbol<'l>, usize)> {
        let such = || self.symbols().filter(|(_, symbol)| is_such(symbol));
        let (character, most) =
            such().max_by_key(|&(character, _)| self.drawing.count(character))?;
        let count = such().map(|(character, _)| self.drawing.count(character)).sum();
        Some((count, most, self.drawing.count(character)))
    }

    /// The keys of the locked doors that are drawn.
    pub(crate) fn locks(self) -> impl Iterator<Item = &'l Name<'l>> {
        self.symbols().filter_map(|(_, symbol)| match &symbol.meaning {
            Meaning::Door(DoorText { key, .. }) => key.as_ref(),
            _ => None,
        })
    }

    /// The keys that are drawn.
    pub(crate) fn keys(self) -> impl Iterator<Item = &'l Name<'l>> {
        self.symbols().filter_map(|(_, symbol)| match &symbol.meaning {
            Meaning::Key(key) => Some(key),
            _ => None,
        })
    }

    /// The switches of the drawn tiles that move.
    pub(crate) fn driven(self) -> impl Iterator<Item = &'l Name<'l>> {
        self.symbols().filter_map(|(_, symbol)| symbol.driver())
    }

    /// The switches of the drawn levers and plates.
    pub(crate) fn setting(self) -> impl Iterator<Item = &'l Name<'l>> {
        self.symbols().filter_map(|(_, symbol)| symbol.sets())
    }
}

/// The names of keys or of switches, sorted. An id is an index into them.
pub(crate) struct Names<'l>(pub(crate) Vec<&'l str>);

impl<'l> Names<'l> {
    pub(crate) fn of(names: impl Iterator<Item = &'l Name<'l>>) -> Self {
        let names: BTreeSet<&str> = sort::gathered(names.map(|name| name.text));
        Self(names.into_iter().collect())
    }

    /// The id of `name`. It fits a byte, because every name belongs to a kind of tile and the
    /// number of kinds is limited.
    pub(crate) fn id(&self, name: &str) -> Option<u8> {
        u8::try_from(self.0.binary_search(&name).ok()?).ok()
    }

    pub(crate) fn contains(&self, name: &str) -> bool {
        self.0.binary_search(&name).is_ok()
    }

    pub(crate) fn to_strings(&self) -> Vec<String> {
        self.0.iter().map(|&name| name.to_owned()).collect()
    }
}
