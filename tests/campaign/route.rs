//! Routes: what a player does in a level, in which order, as text.
//!
//! A line has a verb and a place. A place is a character that the map draws once, or a column and a
//! row. `go 12,5` goes there, `open v` opens or pulls what is there, `hop 20,15` jumps there, and
//! `throw 9,9` throws a pebble in that direction. A line that begins with `careful` is left out by
//! a player without care. A `#` begins a comment.

use cellcaster::world::Cell;

/// One thing to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Errand {
    pub(crate) verb: Verb,
    pub(crate) cell: Cell,
    /// Whether a player without care leaves it out.
    pub(crate) is_careful: bool,
}

/// What to do with a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verb {
    /// Go there.
    Go,
    /// Go beside it, and open or pull what is there.
    Open,
    /// Jump there.
    Hop,
    /// Throw a pebble in that direction.
    Throw,
}

/// The errands of the route `text` in a map.
///
/// # Panics
/// If the text is no route in that map.
pub(crate) fn parse(text: &str, map: &str) -> Vec<Errand> {
    let lines = text.lines().map(|line| line.split('#').next().unwrap_or("").trim());
    lines.filter(|line| !line.is_empty()).map(|line| errand(line, map)).collect()
}

fn errand(line: &str, map: &str) -> Errand {
    let mut words = line.split_whitespace().peekable();
    let is_careful = words.next_if_eq(&"careful").is_some();
    let verb = match words.next() {
        Some("go") => Verb::Go,
        Some("open") => Verb::Open,
        Some("hop") => Verb::Hop,
        Some("throw") => Verb::Throw,
        _ => panic!("no verb in {line:?}"),
    };
    let place = words.next().unwrap_or_else(|| panic!("no place in {line:?}"));
    Errand { verb, cell: cell(place, map), is_careful }
}

fn cell(place: &str, map: &str) -> Cell {
    if let Some((column, row)) = place.split_once(',') {
        return Cell { column: column.parse().unwrap(), row: row.parse().unwrap() };
    }
    let grid = map.split("'''").nth(1).expect("a map has a grid").trim_start_matches('\n');
    let drawn = grid.lines().zip(0..).flat_map(|(line, row)| {
        line.chars().zip(0..).map(move |(character, column)| (character, Cell { column, row }))
    });
    let cells: Vec<Cell> = drawn
        .filter(|(character, _)| place.chars().eq([*character]))
        .map(|(_, cell)| cell)
        .collect();
    let [cell] = cells[..] else { panic!("{place:?} is drawn {} times", cells.len()) };
    cell
}
