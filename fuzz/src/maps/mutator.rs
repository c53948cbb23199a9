//! A mutator that knows the structure of a map: a grid between `'''`, and lines of definitions.
//!
//! The TOML parser rejects nearly all inputs with randomly flipped bytes, and the map reader
//! rejects rows of unequal length. Most mutations here produce a readable map.

use cellcaster::rng::SplitMix64;

use super::END;
use super::vocabulary::{DONORS, NUMBERS, PAIRS, USUAL};

const QUOTES: &str = "'''\n";

/// The parts of a map.
struct Parts {
    /// The lines up to the grid, with its opening quotes.
    head: Vec<String>,
    rows: Vec<Vec<char>>,
    /// The lines from the closing quotes on.
    tail: Vec<String>,
    /// The bytes behind the text.
    rest: Vec<u8>,
}

/// Changes the map in `data[..size]` in place, and returns its new size. Returns `None` if a
/// general mutator should change the bytes instead.
pub fn mutate(data: &mut [u8], size: usize, max_size: usize, seed: u32) -> Option<usize> {
    let mut rng = SplitMix64::new(seed.into());
    if rng.one_in(6) {
        return None;
    }
    let mut parts = Parts::of(&data[..size])?;
    for _ in 0..1 + rng.below(4) {
        parts.change(&mut rng);
    }
    let changed = parts.into_bytes();
    let length = changed.len();
    (length <= max_size).then(|| {
        data[..length].copy_from_slice(&changed);
        length
    })
}

impl Parts {
    fn of(data: &[u8]) -> Option<Self> {
        let end = data.iter().position(|&byte| byte == END).unwrap_or(data.len());
        let text = std::str::from_utf8(&data[..end]).ok()?;
        let rest = data[end..].to_vec();
        let lines = |text: &str| text.lines().map(str::to_owned).collect();
        let Some((head, after)) = text.split_once(QUOTES) else {
            return Some(Self { head: Vec::new(), rows: Vec::new(), tail: lines(text), rest });
        };
        let (grid, tail) = after.split_once(QUOTES).unwrap_or((after, ""));
        let rows = grid.lines().map(|row| row.chars().collect()).collect();
        Some(Self { head: lines(head), rows, tail: lines(tail), rest })
    }

    fn into_bytes(self) -> Vec<u8> {
        let mut text = self.head.join("\n");
        if !self.rows.is_empty() {
            text.push_str(QUOTES);
            for row in &self.rows {
                text.extend(row);
                text.push('\n');
            }
            text.push_str(QUOTES);
        }
        text.push_str(&self.tail.join("\n"));
        text.push('\n');
        [text.into_bytes(), self.rest].concat()
    }

    fn change(&mut self, rng: &mut SplitMix64) {
        match rng.below(20) {
            0..4 => self.change_cells(rng),
            4..6 => self.change_rows(rng),
            6..8 => self.change_columns(rng),
            8..10 => self.change_script(rng),
            10 => self.change_lines(rng),
            11..13 => self.add_definition(rng),
            13..15 => self.change_number(rng),
            15..18 => self.change_pair(rng),
            _ => self.move_value(rng),
        }
    }

    fn any_cell(&self, rng: &mut SplitMix64) -> Option<(usize, usize)> {
        let row = some_index(&self.rows, rng)?;
        Some((row, some_index(&self.rows[row], rng)?))
    }

    /// A character of the grid or of a definition, or a usual character.
    fn any_character(&self, rng: &mut SplitMix64) -> char {
        let usual = || USUAL.chars();
        match rng.below(3) {
            0 => self.any_cell(rng).map(|(row, column)| self.rows[row][column]),
            1 => some(&self.tail, rng).and_then(|line| line.chars().nth(1)),
            _ => usual().nth(rng.below(usual().count())),
        }
        .filter(|it| !it.is_control() && *it != '\'')
        .unwrap_or('.')
    }

    fn change_cells(&mut self, rng: &mut SplitMix64) {
        for _ in 0..1 + rng.below(3) {
            let character = self.any_character(rng);
            let Some((row, column)) = self.any_cell(rng) else { return };
            let other = self.any_cell(rng).unwrap_or((row, column));
            if rng.one_in(3) {
                let one = self.rows[row][column];
                self.rows[row][column] = std::mem::replace(&mut self.rows[other.0][other.1], one);
            } else {
                self.rows[row][column] = character;
            }
        }
    }

    fn change_rows(&mut self, rng: &mut SplitMix64) {
        let Some(row) = some_index(&self.rows, rng) else { return };
        let copies = if rng.one_in(20) { 100 } else { 1 };
        match rng.below(4) {
            0 if self.rows.len() > 1 => _ = self.rows.remove(row),
            1 => {
                let other = rng.below(self.rows.len());
                self.rows.swap(row, other);
            }
            _ => {
                let copied: Vec<char> =
                    self.rows[row].iter().map(|&it| if it == '@' { '.' } else { it }).collect();
                let at = rng.below(self.rows.len() + 1);
                self.rows.splice(at..at, vec![copied; copies]);
            }
        }
    }

    fn change_columns(&mut self, rng: &mut SplitMix64) {
        let width = self.rows.iter().map(Vec::len).min().unwrap_or_default();
        if width == 0 {
            return;
        }
        let (column, at) = (rng.below(width), rng.below(width + 1));
        let copies = if rng.one_in(20) { 100 } else { 1 };
        let (removes, is_ragged) = (width > 1 && rng.one_in(3), rng.one_in(20));
        for row in &mut self.rows {
            if removes {
                row.remove(column);
            } else {
                let copied = if row[column] == '@' { '.' } else { row[column] };
                row.splice(at..at, vec![copied; copies]);
            }
            if is_ragged {
                return;
            }
        }
    }

    fn change_script(&mut self, rng: &mut SplitMix64) {
        if self.rest.is_empty() {
            self.rest.push(END);
        }
        let length = self.rest.len();
        for _ in 0..1 + rng.below(8) {
            let byte = rng.bits() as u8;
            match rng.below(4) {
                0 if length > 1 => {
                    let at = 1 + rng.below(length - 1);
                    self.rest[at] = byte;
                }
                1 if length > 2 => self.rest.truncate(1 + rng.below(length - 1)),
                _ => self.rest.push(if rng.one_in(2) { byte } else { 1 << (byte & 7) }),
            }
            if self.rest.len() != length {
                return;
            }
        }
    }

    fn change_lines(&mut self, rng: &mut SplitMix64) {
        let lines = if rng.one_in(3) { &mut self.head } else { &mut self.tail };
        let Some(line) = some_index(lines, rng) else { return };
        let other = rng.below(lines.len());
        match rng.below(4) {
            0 => _ = lines.remove(line),
            1 => lines.swap(line, other),
            2 => {
                let copied = lines[line].clone();
                lines.insert(other, copied);
            }
            _ => {
                let character = self.any_character(rng);
                let definition = self.tail.get(line).and_then(|line| line.split_once(" = "));
                if let Some((_, definition)) = definition {
                    let renamed = format!("{:?} = {definition}", character.to_string());
                    self.tail.push(renamed);
                }
            }
        }
    }

    /// Adds a line of another map, with its character in the grid.
    fn add_definition(&mut self, rng: &mut SplitMix64) {
        let donor: Vec<&str> = DONORS[rng.below(DONORS.len())].lines().collect();
        let Some(line) = some(&donor, rng) else { return };
        let mut characters = line.chars();
        let quoted = (characters.next(), characters.next(), characters.next());
        let (Some('"'), Some(character), Some('"')) = quoted else {
            if self.rows.is_empty() {
                self.tail.extend([line.to_string()]);
            }
            return;
        };
        let is_thing =
            ["start", "exit", "sprite", "guard", "key =", "note", "treasure", "healing", "spikes"]
                .iter()
                .any(|word| line.contains(word));
        let section = if is_thing { "[things]" } else { "[tiles]" };
        self.tail.retain(|it| it.chars().nth(1) != Some(character));
        let Some(at) = self.tail.iter().position(|it| it == section) else {
            self.tail.extend([section.to_owned(), line.to_string()]);
            return;
        };
        self.tail.insert(at + 1, line.to_string());
        for _ in 0..1 + rng.below(3) {
            let Some((row, column)) = self.any_cell(rng) else { return };
            self.rows[row][column] = character;
        }
    }

    fn change_number(&mut self, rng: &mut SplitMix64) {
        let number = NUMBERS[rng.below(NUMBERS.len())];
        let Some(line) = self.any_line(rng) else { return };
        let digits: Vec<usize> =
            line.char_indices().filter(|(_, it)| it.is_ascii_digit()).map(|(at, _)| at).collect();
        let Some(&at) = some(&digits, rng) else { return };
        let is_of_number = |it: char| it.is_ascii_alphanumeric() || matches!(it, '.' | '-' | '+');
        let start = line[..at].rfind(|it| !is_of_number(it)).map_or(0, |before| before + 1);
        let end = line[at..].find(|it| !is_of_number(it)).map_or(line.len(), |length| at + length);
        if line.is_char_boundary(start) {
            line.replace_range(start..end, number);
        }
    }

    fn change_pair(&mut self, rng: &mut SplitMix64) {
        let (pair, has_grid) = (PAIRS[rng.below(PAIRS.len())], !self.rows.is_empty());
        let Some(line) = self.any_line(rng) else { return };
        if rng.one_in(4) {
            // Removes the last pair.
            if let Some((kept, _)) = line.rsplit_once(", ") {
                *line = format!("{kept} }}");
            }
        } else if let Some(end) = line.rfind('}') {
            line.insert_str(end, &format!(", {pair} "));
        } else if !has_grid || rng.one_in(4) {
            line.push('\n');
            line.push_str(pair);
        }
    }

    /// Replaces the value of a line by the value of another line.
    fn move_value(&mut self, rng: &mut SplitMix64) {
        let Some(other) = self.any_line(rng) else { return };
        let Some((_, value)) = other.split_once(" = ") else { return };
        let value = value.to_owned();
        let Some(line) = self.any_line(rng) else { return };
        let Some(end) = line.find(" = ") else { return };
        line.truncate(end + 3);
        line.push_str(&value);
    }

    fn any_line(&mut self, rng: &mut SplitMix64) -> Option<&mut String> {
        let lines = if rng.one_in(4) { &mut self.head } else { &mut self.tail };
        let line = some_index(lines, rng)?;
        Some(&mut lines[line])
    }
}

fn some_index<T>(list: &[T], rng: &mut SplitMix64) -> Option<usize> {
    (!list.is_empty()).then(|| rng.below(list.len()))
}

fn some<'a, T>(list: &'a [T], rng: &mut SplitMix64) -> Option<&'a T> {
    list.get(some_index(list, rng)?)
}
