//! The letters of colours.
//!
//! Each letter is a family of colours. A colour belongs to the family whose example is nearest by CIE76's ΔE. The table
//! belongs to the format of grids, because letters must not change: a change needs a new version.

use std::collections::HashMap;
use std::fmt;
use std::sync::LazyLock;

use ratatui::style::Color;

use super::CellGrid;
use crate::color::Rgb;
use crate::color::lab::Lab;
use crate::tui::pixels::shown;

/// The colour of each small letter: the colour of more than half of the cells in a family, if there is one.
pub(crate) struct ColorLegend {
    colors: HashMap<char, Color>,
    /// The letters in use.
    used: Vec<char>,
}

impl ColorLegend {
    pub(crate) fn of(grid: &CellGrid) -> Self {
        let mut cells: HashMap<Color, usize> = HashMap::new();
        for color in grid.0.content.iter().flat_map(|cell| [cell.fg, cell.bg]) {
            *cells.entry(color).or_default() += 1;
        }
        let mut families: HashMap<char, Vec<(Color, usize)>> = HashMap::new();
        for (color, count) in cells {
            families.entry(letter(color)).or_default().push((color, count));
        }
        let most = |members: &[(Color, usize)]| {
            let all: usize = members.iter().map(|&(_, count)| count).sum();
            members.iter().find(|&&(_, count)| count * 2 > all).map(|&(color, _)| color)
        };
        let colors =
            families.iter().filter_map(|(&letter, members)| Some((letter, most(members)?)));
        Self { colors: colors.collect(), used: families.keys().copied().collect() }
    }

    /// Reads a line: a letter, a name and, if there is one, the colour. `None` if it is something else.
    pub(crate) fn read(&mut self, line: &str) -> Option<()> {
        let mut words = line.split_whitespace();
        let letter = words.next()?.parse().ok()?;
        if let Some(color) = words.nth(1) {
            self.colors.insert(letter, color_of(color)?);
        }
        Some(())
    }

    /// A letter for each run of a colour, and the colours that are listed.
    pub(crate) fn plane_row(&self, colors: impl Iterator<Item = Color>) -> (String, Vec<String>) {
        let mut listed = Vec::new();
        let mut before = None;
        let columns = colors.map(|color| {
            if before.replace(color) == Some(color) {
                return ' ';
            }
            let letter = letter(color);
            if self.colors.get(&letter) == Some(&color) {
                return letter;
            }
            listed.push(color_text(color));
            letter.to_ascii_uppercase()
        });
        (columns.collect(), listed)
    }

    /// The colours of a row of a plane.
    pub(crate) fn read_row(&self, columns: &str, listed: &[&str]) -> Result<Vec<Color>, String> {
        let mut listed = listed.iter();
        let mut color = None;
        let mut colors = Vec::new();
        for letter in columns.chars() {
            if letter.is_ascii_uppercase() {
                let text = listed.next().ok_or("has more capitals than colours")?;
                color = Some(
                    color_of(text).ok_or_else(|| format!("has {text}, which is not a colour"))?,
                );
            } else if letter != ' ' {
                let listed = self.colors.get(&letter).copied();
                color = Some(listed.ok_or_else(|| format!("has a {letter}, which has no colour"))?);
            }
            colors.push(color.ok_or("does not begin with a letter")?);
        }
        match listed.next() {
            Some(_) => Err("has more colours than capitals".to_owned()),
            None => Ok(colors),
        }
    }
}

impl Default for ColorLegend {
    fn default() -> Self {
        Self { colors: HashMap::from([(DEFAULT, Color::Reset)]), used: Vec::new() }
    }
}

impl fmt::Display for ColorLegend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.used.contains(&DEFAULT) {
            writeln!(f, "{DEFAULT}  default")?;
        }
        for (letter, name, _) in FAMILIES.iter().filter(|(letter, ..)| self.used.contains(letter)) {
            match self.colors.get(letter) {
                Some(&color) => writeln!(f, "{letter}  {name:8} {}", color_text(color))?,
                None => writeln!(f, "{letter}  {name}")?,
            }
        }
        Ok(())
    }
}

/// `#rrggbb`, the number of an indexed colour, or a name.
pub(crate) fn color_text(color: Color) -> String {
    match color {
        Color::Rgb(red, green, blue) => Rgb::new(red, green, blue).to_string(),
        other => other.to_string(),
    }
}

fn color_of(text: &str) -> Option<Color> {
    text.parse().ok()
}

/// The letter of the terminal's default colour.
const DEFAULT: char = '.';

/// The letter, the name and the example of each family.
const FAMILIES: [(char, &str, Rgb); 26] = [
    ('k', "black", Rgb::new(0x00, 0x00, 0x00)),
    ('c', "charcoal", Rgb::new(0x2b, 0x2b, 0x2b)),
    ('d', "dim", Rgb::new(0x55, 0x55, 0x55)),
    ('a', "grey", Rgb::new(0x80, 0x80, 0x80)),
    ('s', "silver", Rgb::new(0xb4, 0xb4, 0xb4)),
    ('w', "white", Rgb::new(0xf4, 0xf4, 0xf4)),
    ('r', "red", Rgb::new(0xd8, 0x28, 0x28)),
    ('h', "maroon", Rgb::new(0x78, 0x14, 0x14)),
    ('o', "orange", Rgb::new(0xe8, 0x88, 0x28)),
    ('n', "brown", Rgb::new(0x80, 0x4c, 0x24)),
    ('u', "umber", Rgb::new(0x40, 0x28, 0x18)),
    ('t', "tan", Rgb::new(0xc8, 0xa0, 0x78)),
    ('y', "yellow", Rgb::new(0xf0, 0xe0, 0x40)),
    ('v', "olive", Rgb::new(0x78, 0x74, 0x20)),
    ('l', "lime", Rgb::new(0x90, 0xe0, 0x40)),
    ('g', "green", Rgb::new(0x28, 0xa0, 0x38)),
    ('f', "forest", Rgb::new(0x14, 0x48, 0x1c)),
    ('j', "jade", Rgb::new(0x40, 0xc0, 0xb0)),
    ('q', "teal", Rgb::new(0x14, 0x58, 0x5c)),
    ('i', "ice", Rgb::new(0xb0, 0xd8, 0xf0)),
    ('z', "azure", Rgb::new(0x38, 0x90, 0xe0)),
    ('b', "blue", Rgb::new(0x28, 0x38, 0xd0)),
    ('x', "navy", Rgb::new(0x14, 0x1c, 0x58)),
    ('p', "purple", Rgb::new(0x80, 0x38, 0xa8)),
    ('e', "plum", Rgb::new(0x3c, 0x18, 0x44)),
    ('m', "magenta", Rgb::new(0xd8, 0x48, 0xc0)),
];

/// The letter of `color`.
fn letter(color: Color) -> char {
    static EXAMPLES: LazyLock<[Lab; FAMILIES.len()]> =
        LazyLock::new(|| FAMILIES.map(|(_, _, example)| example.into()));
    let Some(color) = shown(color).map(Lab::from) else { return DEFAULT };
    let distances = EXAMPLES.map(|example| example.distance(color));
    let nearest =
        distances.iter().zip(FAMILIES).min_by(|(one, _), (other, _)| one.total_cmp(other));
    nearest.map_or(DEFAULT, |(_, (letter, ..))| letter)
}
