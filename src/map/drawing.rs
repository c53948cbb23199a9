//! The drawing: the text of the grid, with the places of its characters.

use std::collections::BTreeMap;
use std::num::NonZeroU32;
use std::ops::Range;

use crate::fault::Fault;
use crate::fault::document::Entry;
use crate::world::Cell;

/// The largest number of columns, and of rows, of a grid.
pub const MAX_SIDE: u32 = 4096;
const EXAMPLE: &str = "grid = ''' on a line, the rows below it, and ''' again";

/// The grid as it is drawn. Its sides are within the limits; rows may differ in length, and
/// characters may be undefined.
pub(crate) struct Drawing<'a> {
    text: DrawnText<'a>,
    pub(crate) width: NonZeroU32,
    pub(crate) height: NonZeroU32,
    /// The place of the key `grid`.
    pub(crate) key_place: Range<usize>,
    sightings: PerCharacter<Sightings>,
    /// The first byte of each row in the grid's text.
    row_starts: Vec<usize>,
}

/// The occurrences of a character in the grid.
#[derive(Clone, Copy, Default)]
struct Sightings {
    count: usize,
    /// The first two, as bytes from the start of the grid's text.
    places: [usize; 2],
}

impl<'a> Drawing<'a> {
    /// Reads the drawing in `entry` of the map `text`; reports its faults. `None` if it has no
    /// usable width and height.
    pub(crate) fn read(entry: &Entry<'a, '_>, text: &str) -> Option<Self> {
        let value = entry.string(EXAMPLE)?;
        let text = DrawnText::new(value, entry.value_place.clone(), text);
        let (widths, sightings) = text.survey();
        let width = usual_width(&widths);
        let height = NonZeroU32::new(widths.len() as u32);
        let (Some(width), Some(height)) = (width, height) else {
            return entry.reject("the grid is empty", "", "draw at least one row");
        };
        let widest = widths.iter().copied().max().unwrap_or_default();
        if widest > MAX_SIDE || height.get() > MAX_SIDE {
            let message = format!(
                "the grid is {widest}×{height} cells, but at most {MAX_SIDE}×{MAX_SIDE} is allowed"
            );
            entry.faults.push(Fault::new(entry.key_place.clone(), message));
            return None;
        }
        entry.faults.extend(text.ragged_rows(&widths, width));
        let row_starts = text.rows().map(|(start, _)| start).collect();
        let key_place = entry.key_place.clone();
        Some(Self { text, width, height, key_place, sightings, row_starts })
    }

    /// The characters of the grid in their order.
    pub(crate) fn characters(&self) -> impl Iterator<Item = char> {
        let drawn = self.sightings.iter().filter(|(_, sightings)| sightings.count > 0);
        drawn.map(|(character, _)| character)
    }

    /// The number of cells with `character`.
    pub(crate) fn count(&self, character: char) -> usize {
        self.sightings.get(character).count
    }

    /// The places of the first occurrences of `character` in the map, at most two.
    pub(crate) fn first_places(&self, character: char) -> Vec<Range<usize>> {
        let Sightings { count, places } = self.sightings.get(character);
        places.into_iter().take(count).map(|at| self.place(character, at)).collect()
    }

    /// The place in the map of a `character` at byte `at` of the grid's text.
    fn place(&self, character: char, at: usize) -> Range<usize> {
        self.text.place(at..at + character.len_utf8())
    }

    /// The place in the map of a cell.
    pub(crate) fn place_of(&self, cell: Cell) -> Range<usize> {
        let drawn = self.row_starts.get(cell.row as usize).and_then(|&start| {
            let row = &self.text.value[start..];
            let (at, character) = row.char_indices().nth(cell.column as usize)?;
            Some(self.place(character, start + at))
        });
        drawn.unwrap_or_else(|| self.key_place.clone())
    }

    /// The rows, from north to south.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &'a str> {
        self.text.rows().map(|(_, row)| row)
    }

    /// The cells with their characters, row by row from the north.
    pub(crate) fn cells(&self) -> impl Iterator<Item = (Cell, char)> {
        self.rows().zip(0..).flat_map(move |(line, row)| {
            line.chars().zip(0..).map(move |(drawn, column)| (Cell { column, row }, drawn))
        })
    }

    /// The cells whose character `is_wanted`, row by row from the north. If no such character is
    /// drawn, no cell is looked at.
    pub(crate) fn cells_of(
        &self,
        is_wanted: impl Fn(char) -> bool,
    ) -> impl Iterator<Item = (Cell, char)> {
        let wanted = self.characters().filter(|&character| is_wanted(character));
        let wanted: PerCharacter<bool> = wanted.map(|character| (character, true)).collect();
        let is_any_drawn = wanted.iter().any(|(_, is_wanted)| is_wanted);
        let cells = is_any_drawn.then(|| self.cells()).into_iter().flatten();
        cells.filter(move |&(_, character)| wanted.get(character))
    }

    /// For each character that `is_asked`: the first of its cells that `is_such`, and the number of
    /// its other such cells. Leaves out characters without such a cell. One pass over the cells
    /// serves all characters.
    pub(crate) fn first_of_each(
        &self,
        is_asked: impl Fn(char) -> bool,
        is_such: impl Fn(Cell) -> bool,
    ) -> Vec<(Cell, usize)> {
        let mut found = PerCharacter::<Option<(Cell, usize)>>::new();
        for (cell, character) in self.cells_of(is_asked).filter(|&(cell, _)| is_such(cell)) {
            let found = found.get_mut(character);
            *found = Some(found.map_or((cell, 0), |(first, others)| (first, others + 1)));
        }
        found.iter().filter_map(|(_, found)| found).collect()
    }
}

impl Sightings {
    fn record(&mut self, at: usize) {
        if let Some(place) = self.places.get_mut(self.count) {
            *place = at;
        }
        self.count += 1;
    }
}

/// The places of the rows of the grid in `entry` of the map `text`, from the north. `None` if the map writes the grid with
/// escapes, or not as a string.
#[cfg(feature = "cli")]
pub(crate) fn places_of_rows(entry: &Entry<'_, '_>, text: &str) -> Option<Vec<Range<usize>>> {
    let drawn = DrawnText::new(entry.string(EXAMPLE)?, entry.value_place.clone(), text);
    let start = drawn.start?;
    Some(drawn.rows().map(|(at, row)| start + at..start + at + row.len()).collect())
}

/// The text of the grid, with its place in the map.
struct DrawnText<'a> {
    value: &'a str,
    /// The place of the whole TOML string, with its quotes.
    string_place: Range<usize>,
    /// The place of the value's first byte in the map; `None` if the map writes the value with
    /// escapes.
    start: Option<usize>,
}

impl<'a> DrawnText<'a> {
    fn new(value: &'a str, string_place: Range<usize>, map: &str) -> Self {
        let start = value_start(map.get(string_place.clone()).unwrap_or_default(), value)
            .map(|start| string_place.start + start);
        Self { value, string_place, start }
    }

    /// The place of some bytes of the value in the map; the whole string if the map writes it with
    /// escapes.
    fn place(&self, bytes: Range<usize>) -> Range<usize> {
        match self.start {
            Some(start) => start + bytes.start..start + bytes.end,
            None => self.string_place.clone(),
        }
    }

    /// The rows from the north, each with the place of its first byte in the value.
    fn rows(&self) -> impl Iterator<Item = (usize, &'a str)> + use<'a> {
        let mut next_start = 0;
        self.value.split_inclusive('\n').map(move |line| {
            let start = next_start;
            next_start += line.len();
            let row = line.strip_suffix('\n').unwrap_or(line);
            (start, row.strip_suffix('\r').unwrap_or(row))
        })
    }

    /// The width of each row in cells, and the occurrences of each character.
    fn survey(&self) -> (Vec<u32>, PerCharacter<Sightings>) {
        let mut sightings = PerCharacter::<Sightings>::new();
        let widths = self.rows().map(|(start, row)| {
            let mut width = 0;
            for (at, character) in row.char_indices() {
                sightings.get_mut(character).record(start + at);
                width += 1;
            }
            width
        });
        (widths.collect(), sightings)
    }

    fn ragged_rows(&self, widths: &[u32], usual: NonZeroU32) -> impl Iterator<Item = Fault> {
        let rows = self.rows().zip(widths).zip(1..);
        rows.filter(move |&((_, &width), _)| width != usual.get()).map(
            move |(((start, row), &width), number)| {
                let end = start + row.len();
                let message = format!(
                    "row {number} of the grid has {}, other rows have {usual}",
                    cells(width)
                );
                if width < usual.get() {
                    let label = format!("{} missing", cells(usual.get() - width));
                    return Fault::new(self.place(end..end), message)
                        .label(label)
                        .help("make all rows equally long, and draw open floor as '.'");
                }
                let too_many = row.char_indices().nth(usual.get() as usize);
                let too_many = too_many.map_or(end, |(at, _)| start + at);
                Fault::new(self.place(too_many..end), message)
                    .label(format!("{} too many", cells(width - usual.get())))
                    .help("make all rows equally long")
            },
        )
    }
}

/// The most common of `widths` except 0. If several are equally common, returns the first of them.
fn usual_width(widths: &[u32]) -> Option<NonZeroU32> {
    let widths = widths.iter().copied().filter_map(NonZeroU32::new);
    let mut counts = BTreeMap::<NonZeroU32, usize>::new();
    for width in widths.clone() {
        *counts.entry(width).or_default() += 1;
    }
    let most = counts.values().copied().max()?;
    widths.into_iter().find(|width| counts[width] == most)
}

fn cells(count: u32) -> String {
    if count == 1 { "1 cell".to_owned() } else { format!("{count} cells") }
}

/// The place where `value` starts in `literal`, its TOML string; `None` if the literal has escapes.
fn value_start(literal: &str, value: &str) -> Option<usize> {
    ["'''", "\"\"\"", "'", "\""].into_iter().find_map(|quotes| {
        let inner = literal.strip_prefix(quotes)?.strip_suffix(quotes)?;
        let spelt = if quotes.len() == 3 { without_first_line_break(inner) } else { inner };
        (spelt == value).then(|| quotes.len() + inner.len() - spelt.len())
    })
}

/// Removes a line break right after the opening quotes, which TOML drops.
fn without_first_line_break(inner: &str) -> &str {
    inner.strip_prefix("\r\n").or_else(|| inner.strip_prefix('\n')).unwrap_or(inner)
}

/// A value for each character, initially the default: an array for ASCII, a tree for other
/// characters.
pub(crate) struct PerCharacter<T> {
    ascii: [T; 128],
    others: BTreeMap<char, T>,
}

impl<T: Copy + Default> PerCharacter<T> {
    pub(crate) fn new() -> Self {
        Self { ascii: [T::default(); 128], others: BTreeMap::new() }
    }

    pub(crate) fn get(&self, character: char) -> T {
        match self.ascii.get(character as usize) {
            Some(value) => *value,
            None => self.others.get(&character).copied().unwrap_or_default(),
        }
    }

    pub(crate) fn get_mut(&mut self, character: char) -> &mut T {
        match self.ascii.get_mut(character as usize) {
            Some(value) => value,
            None => self.others.entry(character).or_default(),
        }
    }

    /// The characters and their values, in the order of the characters.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (char, T)> {
        let ascii = (0..).map(|code: u8| char::from(code)).zip(self.ascii);
        ascii.chain(self.others.iter().map(|(&character, &value)| (character, value)))
    }
}

impl<T: Copy + Default> FromIterator<(char, T)> for PerCharacter<T> {
    fn from_iter<I: IntoIterator<Item = (char, T)>>(values: I) -> Self {
        let mut collected = Self::new();
        for (character, value) in values {
            *collected.get_mut(character) = value;
        }
        collected
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_found_in_its_literal() {
        for (literal, start) in [
            ("'''\n##'''", 4),
            ("'''\r\n##'''", 5),
            ("\"\"\"##\"\"\"", 3),
            ("'##'", 1),
            ("\"##\"", 1),
        ] {
            assert_eq!(value_start(literal, "##"), Some(start), "{literal}");
        }
        assert_eq!(value_start(r#""\u0023#""#, "##"), None);
    }

    #[test]
    fn the_usual_width_is_the_most_common_one() {
        assert_eq!(usual_width(&[3, 4, 4]), NonZeroU32::new(4));
        assert_eq!(usual_width(&[3, 4]), NonZeroU32::new(3));
        assert_eq!(usual_width(&[0, 0, 1]), NonZeroU32::new(1));
        assert_eq!(usual_width(&[0, 0]), None);
        assert_eq!(usual_width(&[]), None);
    }

    #[test]
    fn characters_come_in_code_point_order() {
        let mut counts = PerCharacter::<u32>::new();
        for character in "éxaé\u{7f}\u{80}\0".chars() {
            *counts.get_mut(character) += 1;
        }
        let seen: Vec<_> = counts.iter().filter(|&(_, count)| count > 0).collect();
        let expected = [('\0', 1), ('a', 1), ('x', 1), ('\u{7f}', 1), ('\u{80}', 1), ('é', 2)];
        assert_eq!(seen, expected);
        assert_eq!((counts.get('é'), counts.get('b'), counts.get('ß')), (2, 0, 0));
    }
}
