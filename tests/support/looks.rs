//! The appearance of a screen's cells, independent of their glyphs.
#![allow(dead_code, reason = "every test file uses its own share of this")]

use vt100::{Color, Screen};

/// The appearance of a cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Look {
    /// The colours of an upper and a lower pixel.
    Pixels([Color; 2]),
    /// A character, its colours, and whether the colours are reversed.
    Text(String, [Color; 2], bool),
}

/// The appearance of all cells of `screen`, row by row.
pub(crate) fn looks(screen: &Screen) -> Vec<Look> {
    let (rows, columns) = screen.size();
    let places =
        (0..rows.get()).flat_map(|row| (0..columns.get()).map(move |column| (row, column)));
    let cells = places.filter_map(|(row, column)| screen.cell(row, column));
    cells
        .map(|cell| {
            let (front, back) = (cell.fgcolor(), cell.bgcolor());
            match cell.contents() {
                _ if cell.inverse() => {
                    Look::Text(cell.contents().trim().to_owned(), [front, back], true)
                }
                "▀" => Look::Pixels([front, back]),
                "▄" => Look::Pixels([back, front]),
                "█" => Look::Pixels([front, front]),
                "" | " " => Look::Pixels([back, back]),
                other => Look::Text(other.to_owned(), [front, back], false),
            }
        })
        .collect()
}
