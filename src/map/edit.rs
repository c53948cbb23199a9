//! The text of a map while it is being edited: its cells, its definitions, and every step back.
//!
//! - The text is the document, and each operation makes another text. A step is the one range in which two texts differ,
//!   so undoing it restores the text byte for byte, and everything outside the range stays as the author wrote it.
//! - Cells are changed in the text of the grid. Definitions are changed by `toml_edit`.
//! - The text is always TOML with a grid. The map may have any other fault.
//! - Things that a map draws once, such as the start, move when they are drawn again. A thing keeps the floor on which it
//!   is drawn, and turning it turns no other one: if others share its character, it gets a character of its own.
//!
//! Rejected: the tree of `toml_edit` as the document. It writes line ends in its own way, and each step back would be a
//! whole tree.

mod definitions;
mod history;

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use toml_edit::{InlineTable, Value};

pub use self::definitions::Definition;
use self::definitions::line_end;
use self::history::History;
use super::drawing::{MAX_SIDE, PerCharacter, places_of_rows};
use super::keys::{self, CharacterTable};
use super::{MAX_BYTES, no_grid, scene, too_large};
use crate::fault::document::{self, FaultList, entries};
use crate::fault::{Fault, Faults, nearest_or_all, quoted};
use crate::world::Cell;

/// A map that is being edited.
///
/// ```
/// use cellcaster::map::edit::MapDocument;
/// use cellcaster::world::Cell;
///
/// let text = "grid = '''\n#@.#\n'''\n[tiles] # one\n'#' = { wall = 'brick' }\n[things]\n'@' = { start = 0 }\n";
/// let mut map = MapDocument::open(text.to_owned(), "tiny.toml").unwrap();
/// map.draw(&[Cell { column: 2, row: 0 }], '#', false).unwrap();
/// assert_eq!(map.text(), text.replace("#@.#", "#@##"));
/// map.undo();
/// assert_eq!(map.text(), text);
/// ```
#[derive(Clone, Debug)]
pub struct MapDocument {
    map: MapText,
    history: History,
}

/// A step of the history that was undone or done again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HistoryStep {
    /// The first cell that has changed, if the step changed cells.
    pub cell: Option<Cell>,
}

/// The text of a map with the places of its parts.
#[derive(Clone, Debug)]
struct MapText {
    text: String,
    /// The bytes of each row of the grid.
    rows: Vec<Range<usize>>,
    definitions: Vec<Definition>,
}

impl MapDocument {
    /// A document with this text of the map that faults call `name`.
    ///
    /// # Errors
    /// The faults of a text that is not TOML, or has no grid that can be changed.
    pub fn open(text: String, name: &str) -> Result<Self, Faults> {
        if text.len() > MAX_BYTES {
            return Err(too_large(name));
        }
        let faults = FaultList::default();
        match MapText::read(&text, &faults) {
            Some((rows, definitions)) => {
                let map = MapText { text, rows, definitions };
                Ok(Self { map, history: History::default() })
            }
            None => Err(Faults::new(name, &text, faults.take())),
        }
    }

    /// The text of the map.
    pub fn text(&self) -> &str {
        &self.map.text
    }

    /// The numbers of columns and rows. Columns are counted in the longest row.
    pub fn size(&self) -> (u32, u32) {
        let columns = self.rows().map(|row| row.chars().count()).max().unwrap_or_default();
        (columns as u32, self.map.rows.len() as u32)
    }

    /// The rows of the grid, from the north.
    pub fn rows(&self) -> impl Iterator<Item = &str> {
        self.map.rows.iter().map(|row| &self.map.text[row.clone()])
    }

    /// The character in a cell; `None` if the row ends before it.
    pub fn character(&self, cell: Cell) -> Option<char> {
        self.map.character(cell)
    }

    /// The definitions of the tiles and, after them, of the things.
    pub fn definitions(&self) -> &[Definition] {
        &self.map.definitions
    }

    /// The definition of `character`.
    pub fn definition(&self, character: char) -> Option<&Definition> {
        self.map.definition(character)
    }

    /// The cells at this place of the text: a cell of the grid, or all cells whose character is defined there.
    pub fn cells_at(&self, place: &Range<usize>) -> Vec<Cell> {
        /// More cells are not told apart.
        const MOST: usize = 4096;
        let at = place.start;
        if let Some(cell) = self.map.cell_at(at) {
            return vec![cell];
        }
        let is_there = |definition: &&Definition| definition.place.contains(&at);
        let found = self.map.definitions.iter().find(is_there);
        let cells =
            found.into_iter().flat_map(|definition| self.map.cells_of(definition.character));
        cells.take(MOST).collect()
    }

    /// Draws `character` in `cells`, as the brush does. With `joins`, this and the last step are one step.
    ///
    /// # Errors
    /// A sentence that says why the character cannot be drawn.
    pub fn draw(&mut self, cells: &[Cell], character: char, joins: bool) -> Result<(), String> {
        let is_thing = self.definition(character).is_some_and(|definition| definition.is_thing);
        if !is_thing {
            let cells: Vec<_> = cells.iter().map(|&cell| (cell, character)).collect();
            return self.write(&cells, joins);
        }
        let mut map = self.map.clone();
        let mut drawn = BTreeMap::new();
        let group = map.drawn_once(character);
        let cells = if group.is_some() { &cells[cells.len().saturating_sub(1)..] } else { cells };
        for other in group.into_iter().flatten() {
            let support = map.floor_below(other);
            drawn.extend(map.cells_of(other).map(|cell| (cell, support)));
        }
        let targets: BTreeSet<Cell> = cells.iter().copied().chain(drawn.keys().copied()).collect();
        let is_elsewhere = map.cells_of(character).any(|cell| !targets.contains(&cell));
        let supports: BTreeMap<Cell, char> = cells
            .iter()
            .filter_map(|&cell| Some((cell, map.floor_below(map.character(cell)?))))
            .collect();
        let mut variants = BTreeMap::new();
        for (&cell, &support) in &supports {
            let variant = if let Some(&variant) = variants.get(&support) {
                variant
            } else {
                let is_taken = is_elsewhere || !variants.is_empty();
                let on = (support != '.').then(|| Value::from(support.to_string()));
                map.variant(character, ("on", on), is_taken)?
            };
            variants.insert(support, variant);
            drawn.insert(cell, variant);
        }
        let drawn: Vec<_> = drawn.into_iter().collect();
        map = map.with_cells(&drawn)?;
        self.commit(map, joins);
        Ok(())
    }

    /// Writes these characters, whatever they mean. A row that ends before a cell is filled with open floor.
    ///
    /// # Errors
    /// A sentence that says why a character cannot be written.
    pub fn write(&mut self, cells: &[(Cell, char)], joins: bool) -> Result<(), String> {
        let map = self.map.with_cells(cells)?;
        self.commit(map, joins);
        Ok(())
    }

    /// Removes what is in `cells`. The floor below a thing stays.
    ///
    /// # Errors
    /// As for [`MapDocument::write`].
    pub fn erase(&mut self, cells: &[Cell]) -> Result<(), String> {
        let floor = |&cell| {
            let character = self.character(cell)?;
            let is_thing = self.definition(character).is_some_and(|definition| definition.is_thing);
            Some((cell, if is_thing { self.map.floor_below(character) } else { '.' }))
        };
        let floors: Vec<_> = cells.iter().filter_map(floor).collect();
        self.write(&floors, false)
    }

    /// Turns the thing in `cell` clockwise, and returns its new heading in degrees.
    ///
    /// # Errors
    /// A sentence that says why it cannot be turned.
    pub fn turn(&mut self, cell: Cell, degrees: f64) -> Result<f64, String> {
        let character = self.character(cell);
        let definition = character.and_then(|character| self.definition(character));
        let (definition, (key, heading)) = definition
            .and_then(|definition| Some((definition, definition.heading()?)))
            .ok_or("nothing here has a heading")?;
        let character = definition.character;
        let heading = (heading + degrees).rem_euclid(360.0);
        let value =
            if heading.fract() == 0.0 { Value::from(heading as i64) } else { heading.into() };
        let mut map = self.map.clone();
        let is_elsewhere = map.cells_of(character).any(|other| other != cell);
        let turned = map.variant(character, (key, Some(value)), is_elsewhere)?;
        map = map.with_cells(&[(cell, turned)])?;
        self.commit(map, false);
        Ok(heading)
    }

    /// Makes the grid this large. Cells are added and removed in the east and in the south.
    ///
    /// # Errors
    /// A sentence that says why the size is not possible.
    pub fn resize(&mut self, columns: u32, rows: u32) -> Result<(), String> {
        let sides = 1..=MAX_SIDE;
        if !sides.contains(&columns) || !sides.contains(&rows) {
            return Err(format!("a grid has 1 to {MAX_SIDE} columns and rows"));
        }
        let length = columns as usize;
        let resized = |row: &str| -> String {
            row.chars().chain(std::iter::repeat('.')).take(length).collect()
        };
        let mut lines: Vec<String> = self.rows().take(rows as usize).map(resized).collect();
        lines.resize_with(rows as usize, || resized(""));
        let (Some(first), Some(last)) = (self.map.rows.first(), self.map.rows.last()) else {
            return Ok(());
        };
        let text = self.text();
        let grid = lines.join(line_end(text));
        let map = MapText::of([&text[..first.start], &grid, &text[last.end..]].concat())?;
        if !map.rows.iter().map(|row| &map.text[row.clone()]).eq(lines.iter()) {
            return Err(UNWRITABLE.to_owned());
        }
        self.commit(map, false);
        Ok(())
    }

    /// Defines `character` as a tile or a thing. `text` is TOML without the braces, such as `wall = "brick"`.
    ///
    /// # Errors
    /// A sentence about a definition that is not TOML.
    pub fn define(&mut self, is_thing: bool, character: char, text: &str) -> Result<(), String> {
        let properties = definitions::properties(text)?;
        let map = self.map.with_definition(is_thing, character, properties)?;
        self.commit(map, false);
        Ok(())
    }

    /// Sets a key of the whole map, such as `title`. `value` is TOML.
    ///
    /// # Errors
    /// A sentence about a key that a map does not have, or a value that is not TOML.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let known: Vec<&str> = keys::MAP
            .iter()
            .copied()
            .filter(|key| !["grid", "tiles", "things"].contains(key))
            .collect();
        if !known.contains(&key) {
            let help = nearest_or_all(key, &known, "the nearest key is", "known keys:");
            return Err(format!("a map has no key {} to set: {help}", quoted(key)));
        }
        let map =
            MapText::of(definitions::with_key(self.text(), key, definitions::value(value)?)?)?;
        self.commit(map, false);
        Ok(())
    }

    /// The value of a key of the whole map, as TOML.
    pub fn value(&self, key: &str) -> Option<String> {
        let document = toml_edit::Document::parse(self.text()).ok()?;
        self.text().get(document.get(key)?.as_value()?.span()?).map(str::to_owned)
    }

    /// Replaces the whole text.
    ///
    /// # Errors
    /// The faults of a text that [`MapDocument::open`] would not open.
    pub fn replace(&mut self, text: String, name: &str) -> Result<(), Faults> {
        let map = Self::open(text, name)?.map;
        self.commit(map, false);
        Ok(())
    }

    /// Undoes the last step. Returns `None` if there is no step.
    pub fn undo(&mut self) -> Option<HistoryStep> {
        let (text, at) = self.history.undo(&self.map.text)?;
        Some(self.show(text, at))
    }

    /// Does the step again that was undone last. Returns as [`MapDocument::undo`] does.
    pub fn redo(&mut self) -> Option<HistoryStep> {
        let (text, at) = self.history.redo(&self.map.text)?;
        Some(self.show(text, at))
    }

    /// Shows another text of the history, which differs from byte `at` on.
    fn show(&mut self, text: String, at: usize) -> HistoryStep {
        if let Ok(map) = MapText::of(text) {
            self.map = map;
        }
        HistoryStep { cell: self.map.cell_at(at) }
    }

    fn commit(&mut self, map: MapText, joins: bool) {
        if map.text != self.map.text {
            self.history.push(&self.map.text, &map.text, joins);
            self.map = map;
        }
    }
}

/// The sentence about a grid that would not be read as it is drawn.
const UNWRITABLE: &str =
    "the quotes around the grid do not allow that: write ''' on lines of their own around it";

impl MapText {
    fn of(text: String) -> Result<Self, String> {
        let faults = FaultList::default();
        match Self::read(&text, &faults) {
            Some((rows, definitions)) if text.len() <= MAX_BYTES => {
                Ok(Self { text, rows, definitions })
            }
            _ => Err(UNWRITABLE.to_owned()),
        }
    }

    /// The rows of the grid in `text` and the definitions. `None` after a fault.
    fn read(text: &str, faults: &FaultList) -> Option<(Vec<Range<usize>>, Vec<Definition>)> {
        let document = document::parse(text, faults);
        if !faults.is_empty() {
            return None;
        }
        if scene::has_bodies(&document) {
            let message = "a map of bodies has no grid to edit";
            faults.push(Fault::new(0..0, message).help("change it in a text editor"));
            return None;
        }
        let Some(grid) = entries(&document, faults).find(|entry| entry.key == "grid") else {
            faults.push(no_grid());
            return None;
        };
        let rows =
            places_of_rows(&grid, text).filter(|rows| rows.iter().any(|row| !row.is_empty()));
        if rows.is_none() && faults.is_empty() {
            let message = "the grid is empty, or written with escapes";
            let help = "draw it between ''' and ''', with at least one row";
            faults.push(Fault::new(grid.value_place.clone(), message).help(help));
        }
        let rows = rows?;
        let longest = rows.iter().map(|row| text[row.clone()].chars().count()).max();
        if rows.len().max(longest.unwrap_or_default()) > MAX_SIDE as usize {
            let message = format!("a grid has at most {MAX_SIDE} columns and rows");
            faults.push(Fault::new(grid.key_place.clone(), message));
            return None;
        }
        Some((rows, definitions::read(text)))
    }

    fn character(&self, cell: Cell) -> Option<char> {
        let row = self.rows.get(cell.row as usize)?;
        self.text[row.clone()].chars().nth(cell.column as usize)
    }

    fn definition(&self, character: char) -> Option<&Definition> {
        self.definitions.iter().find(|definition| definition.character == character)
    }

    /// The cell at a byte of the text, or the cell after a row that ends there.
    fn cell_at(&self, at: usize) -> Option<Cell> {
        let row = self.rows.partition_point(|row| row.end < at);
        let before = self.text.get(self.rows.get(row)?.start..at)?;
        Some(Cell { column: before.chars().count() as u32, row: row as u32 })
    }

    fn cells_of(&self, character: char) -> impl Iterator<Item = Cell> {
        self.rows.iter().zip(0..).flat_map(move |(place, row)| {
            let cells = self.text[place.clone()].chars().zip(0..);
            cells
                .filter(move |(it, _)| *it == character)
                .map(move |(_, column)| Cell { column, row })
        })
    }

    /// The floor that a thing in the cell of `character` stands on.
    fn floor_below(&self, character: char) -> char {
        match self.definition(character) {
            Some(definition) if definition.is_thing => definition.support(),
            Some(definition) if definition.is_floor() => character,
            _ => '.',
        }
    }

    /// The characters that a map draws once instead of each other, if `character` is one: a start, a waypoint, or another
    /// thing on a patrol.
    fn drawn_once(&self, character: char) -> Option<Vec<char>> {
        let definition = self.definition(character)?;
        if definition.properties.contains_key("start") {
            let starts = self.definitions.iter().filter(|it| it.properties.contains_key("start"));
            return Some(starts.map(|start| start.character).collect());
        }
        let is_once = definition.properties.contains_key("waypoint")
            || self.definitions.iter().any(|guard| guard.patrol().contains(character));
        is_once.then(|| vec![character])
    }

    /// The character of a thing that differs from `character` by one property: the character itself, if it is not drawn
    /// elsewhere; or another character with this definition; or a new one.
    fn variant(
        &mut self,
        character: char,
        (key, value): (&str, Option<Value>),
        is_elsewhere: bool,
    ) -> Result<char, String> {
        let Some(definition) = self.definition(character) else { return Ok(character) };
        let is_thing = definition.is_thing;
        let properties = definition.with(key, value.clone());
        if definition.means(&properties) {
            return Ok(character);
        }
        if !is_elsewhere {
            let table = table(is_thing);
            let text = definitions::with_property(&self.text, table, character, (key, value))?;
            *self = Self::of(text)?;
            return Ok(character);
        }
        let same = |it: &&Definition| it.is_thing == is_thing && it.means(&properties);
        if let Some(same) = self.definitions.iter().find(same) {
            return Ok(same.character);
        }
        let new = self.free_character(character).ok_or("all letters have a meaning already")?;
        *self = self.with_definition(is_thing, new, properties)?;
        Ok(new)
    }

    /// A character that has no meaning and is not drawn, similar to `character` if possible.
    fn free_character(&self, character: char) -> Option<char> {
        let mut is_taken = PerCharacter::<bool>::new();
        let drawn = self.rows.iter().flat_map(|row| self.text[row.clone()].chars());
        for taken in drawn.chain(self.definitions.iter().map(|definition| definition.character)) {
            *is_taken.get_mut(taken) = true;
        }
        let other_case = character.to_lowercase().chain(character.to_uppercase());
        let letters =
            ('a'..='z').chain('A'..='Z').chain('0'..='9').chain('!'..='~').chain('À'..='ž');
        let unclear = ['.', '\'', '"', '\\', '×', '÷'];
        other_case.chain(letters).find(|it| !is_taken.get(*it) && !unclear.contains(it))
    }

    fn with_definition(
        &self,
        is_thing: bool,
        character: char,
        properties: InlineTable,
    ) -> Result<Self, String> {
        if matches!(character, '.' | ' ') {
            return Err(format!("{character:?} is open floor and cannot be defined"));
        }
        if let Some(other) = self.definition(character).filter(|it| it.is_thing != is_thing) {
            let kind = if other.is_thing { "a thing" } else { "a tile" };
            return Err(format!("{character} is {kind} already: use another character"));
        }
        let table = table(is_thing);
        Self::of(definitions::with_definition(&self.text, table, character, properties)?)
    }

    /// The map in which these cells have these characters.
    fn with_cells(&self, cells: &[(Cell, char)]) -> Result<Self, String> {
        let mut changed: BTreeMap<u32, Vec<char>> = BTreeMap::new();
        for &(Cell { column, row }, character) in cells {
            let Some(place) = self.rows.get(row as usize).filter(|_| column < MAX_SIDE) else {
                continue;
            };
            let line =
                changed.entry(row).or_insert_with(|| self.text[place.clone()].chars().collect());
            let column = column as usize;
            line.resize(line.len().max(column + 1), '.');
            line[column] = character;
        }
        let mut text = String::with_capacity(self.text.len());
        let mut copied = 0;
        for (&row, line) in &changed {
            let place = &self.rows[row as usize];
            text.push_str(&self.text[copied..place.start]);
            text.extend(line);
            copied = place.end;
        }
        text.push_str(&self.text[copied..]);
        let map = Self::of(text)?;
        let is_written = |(row, line): (&u32, &Vec<char>)| {
            let place = map.rows.get(*row as usize);
            place.is_some_and(|place| map.text[place.clone()].chars().eq(line.iter().copied()))
        };
        let is_whole = map.rows.len() == self.rows.len() && changed.iter().all(is_written);
        if is_whole { Ok(map) } else { Err(UNWRITABLE.to_owned()) }
    }
}

fn table(is_thing: bool) -> CharacterTable {
    if is_thing { CharacterTable::Things } else { CharacterTable::Tiles }
}

#[cfg(test)]
mod tests;
