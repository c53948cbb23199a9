//! The text of a map file, and the place in the Tiled map from which each byte was made.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::Range;
use std::rc::Rc;

use super::legend::Definition;
use super::model::{MAP, SheetRegion};
use super::properties::{Properties, toml_key};
use crate::fault::document::toml_string;
use crate::fault::quoted;
use crate::map::keys;

/// The text of a map file, and where it comes from.
#[derive(Default)]
pub(crate) struct Translation {
    pub(crate) text: String,
    /// The pictures that are parts of other files, by name.
    pub(crate) parts: BTreeMap<String, SheetRegion>,
    /// The first byte of each part of the text, with its origin.
    pub(crate) origins: Vec<(usize, Rc<str>)>,
    pub(crate) grid: GridOrigins,
}

/// The cells, with the places of faults.
#[derive(Default)]
pub(crate) struct GridOrigins {
    /// The bytes of the rows in the text.
    pub(crate) place: Range<usize>,
    pub(crate) width: usize,
    pub(crate) stacks: Vec<u32>,
    /// The place of the item on top of each stack.
    pub(crate) tops: Vec<Rc<str>>,
    /// The place of the thing in a cell.
    pub(crate) things: BTreeMap<usize, Rc<str>>,
}

impl Translation {
    /// The layer and cell, the tile or the object from which the byte `at` of the text was made, and
    /// whether the byte belongs to one of its properties.
    pub(crate) fn origin(&self, at: usize) -> (String, bool) {
        if self.grid.place.contains(&at) {
            let before = self.text.get(self.grid.place.start..at);
            return (self.grid.origin(before.unwrap_or_default()), false);
        }
        let after = self.origins.partition_point(|&(start, _)| start <= at);
        (after.checked_sub(1).map_or(MAP, |last| &self.origins[last].1).to_owned(), true)
    }
}

impl GridOrigins {
    /// The origin of the cell after the text `before` of the grid.
    fn origin(&self, before: &str) -> String {
        let cell = before.chars().filter(|it| *it != '\n').count();
        if let Some(origin) = self.things.get(&cell) {
            return (**origin).to_owned();
        }
        let (column, row) = (cell % self.width, cell / self.width);
        let top = self.stacks.get(cell).and_then(|&stack| self.tops.get(stack as usize));
        format!("{}, cell {column},{row}", top.map_or(MAP, |top| top))
    }
}

/// The text of a map file while it is written.
#[derive(Default)]
pub(crate) struct MapWriter {
    pub(crate) text: String,
    pub(crate) origins: Vec<(usize, Rc<str>)>,
    /// The bytes of the rows.
    pub(crate) grid: Range<usize>,
}

impl MapWriter {
    /// Writes the keys of the map, and the grid.
    pub(crate) fn write_map(&mut self, properties: &Properties, rows: &[String]) {
        let map: Rc<str> = MAP.into();
        let place = |key: &str| keys::MAP.iter().position(|it| *it == key);
        let mut entries: Vec<_> = properties.0.iter().collect();
        entries.sort_by_key(|(key, _)| place(key).unwrap_or(usize::MAX));
        for (key, property) in entries {
            self.origins.push((self.text.len(), format!("{map}, property {}", quoted(key)).into()));
            _ = writeln!(self.text, "{} = {}", toml_key(key), property.to_toml());
        }
        self.origins.push((self.text.len(), map));
        if rows.iter().any(|row| row.contains("'''")) {
            _ = writeln!(self.text, "\ngrid = {}", toml_string(&rows.join("\n")));
            return;
        }
        self.text.push_str("\ngrid = '''\n");
        let start = self.text.len();
        for row in rows {
            self.text.push_str(row);
            self.text.push('\n');
        }
        self.grid = start..self.text.len();
        self.text.push_str("'''\n");
    }

    pub(crate) fn write_section(&mut self, name: &str, definitions: &BTreeMap<char, Definition>) {
        _ = writeln!(self.text, "\n{name}");
        for (character, definition) in definitions {
            let first = definition.keys.values().next();
            self.origins.extend(first.map(|key| (self.text.len(), key.origin.clone())));
            _ = write!(self.text, "{} = {{ ", toml_string(&character.to_string()));
            for (number, (key, value)) in definition.keys.iter().enumerate() {
                if number > 0 {
                    self.text.push_str(", ");
                }
                self.origins.push((self.text.len(), value.origin.clone()));
                _ = write!(self.text, "{} = {}", toml_key(key), value.toml);
            }
            self.text.push_str(" }\n");
        }
    }
}
