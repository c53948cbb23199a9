//! Routes: a player's actions in a level, in order, as text.
//!
//! A line consists of a verb and a place. A place is a character that the map draws once, or a
//! column and a row. `go 12,5` goes there by the shortest way, and `straight 12,5` in a straight
//! line and over edges. `open v` opens or pulls the thing there. `hop 20,15` jumps there, and
//! `hop 20,15,0.5` onto something of that height. `throw 9,9` throws a pebble in that direction. A
//! careless player skips lines that begin with `careful`. A `#` begins a comment.

use cellcaster::world::Cell;

/// One action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Errand {
    pub(crate) verb: Verb,
    pub(crate) cell: Cell,
    /// The height of the thing there, if the target is not the floor.
    pub(crate) height: Option<f64>,
    /// `true` if a careless player skips it.
    pub(crate) is_careful: bool,
}

/// An action on a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verb {
    /// Go there.
    Go,
    /// Go there in a straight line.
    Straight,
    /// Go beside it, and open or pull the thing there.
    Open,
    /// Jump there.
    Hop,
    /// Throw a pebble in that direction.
    Throw,
}

/// The errands of the route `text` in a map.
///
/// # Panics
/// If the text is not a route in that map.
pub(crate) fn parse(text: &str, map: &str) -> Vec<Errand> {
    let lines = text.lines().map(|line| line.split('#').next().unwrap_or("").trim());
    lines.filter(|line| !line.is_empty()).map(|line| errand(line, map)).collect()
}

fn errand(line: &str, map: &str) -> Errand {
    let mut words = line.split_whitespace().peekable();
    let is_careful = words.next_if_eq(&"careful").is_some();
    let verb = match words.next() {
        Some("go") => Verb::Go,
        Some("straight") => Verb::Straight,
        Some("open") => Verb::Open,
        Some("hop") => Verb::Hop,
        Some("throw") => Verb::Throw,
        _ => panic!("no verb in {line:?}"),
    };
    let place = words.next().unwrap_or_else(|| panic!("no place in {line:?}"));
    let (cell, height) = place_of(place, map);
    Errand { verb, cell, height, is_careful }
}

fn place_of(place: &str, map: &str) -> (Cell, Option<f64>) {
    let numbers: Vec<&str> = place.split(',').collect();
    match numbers[..] {
        [column, row] => (cell_at(column, row), None),
        [column, row, height] => (cell_at(column, row), Some(height.parse().unwrap())),
        _ => (drawn_once(place, map), None),
    }
}

fn cell_at(column: &str, row: &str) -> Cell {
    Cell { column: column.parse().unwrap(), row: row.parse().unwrap() }
}

fn drawn_once(place: &str, map: &str) -> Cell {
    let grid = map.split("'''").nth(1).expect("a map has a grid").trim_start_matches('\n');
    let drawn = grid.lines().zip(0..).flat_map(|(line, row)| {
        line.chars().zip(0..).map(move |(character, column)| (character, Cell { column, row }))
    });
    let drawn = drawn.filter(|(character, _)| place.chars().eq([*character]));
    let cells: Vec<Cell> = drawn.map(|(_, cell)| cell).collect();
    let [cell] = cells[..] else { panic!("{place:?} is drawn {} times", cells.len()) };
    cell
}
