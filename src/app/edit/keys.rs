//! The keys, the mouse and the commands of the editor.

use std::mem;
use std::time::Duration;

use super::{Choice, Editor, EditorPage};
use crate::app::controls::Bindings;
use crate::app::page::Effect;
use crate::map::edit::HistoryStep;
use crate::sort;
use crate::terminal::{Key, KeyEvent, Modifiers, MouseButton, MouseEvent, MouseEventKind, Phase};
use crate::tui::{HeldKeys, Press};
use crate::world::Cell;

/// The rows by which the page keys move the cursor.
const PAGE: i64 = 10;
/// The angle of a turn, in degrees.
const TURN: f64 = 45.0;
/// The longest command, in characters.
const MAX_COMMAND: usize = 1000;

/// A command that is being typed.
#[derive(Clone, Debug, Default)]
pub(crate) struct CommandLine {
    pub(crate) text: Vec<char>,
    /// The index of the character at the cursor.
    pub(crate) at: usize,
}

impl CommandLine {
    fn of(text: &str) -> Self {
        let text: Vec<char> = text.chars().collect();
        Self { at: text.len(), text }
    }

    fn insert(&mut self, character: char) {
        if self.text.len() < MAX_COMMAND {
            self.text.insert(self.at, character);
            self.at += 1;
        }
    }

    /// Handles a key that edits the line.
    fn press(&mut self, key: Key) {
        match key {
            Key::Left => self.at = self.at.saturating_sub(1),
            Key::Right => self.at = (self.at + 1).min(self.text.len()),
            Key::Home => self.at = 0,
            Key::End => self.at = self.text.len(),
            Key::Backspace if self.at > 0 => {
                self.at -= 1;
                self.text.remove(self.at);
            }
            Key::Delete if self.at < self.text.len() => _ = self.text.remove(self.at),
            _ => {}
        }
    }
}

impl Editor {
    /// Handles a key press, repeat or release.
    pub(crate) fn key(&mut self, event: KeyEvent) {
        if event.phase == Phase::Release
            || matches!(event.key, Key::Shift | Key::Control | Key::Alt)
        {
            return;
        }
        if event.modifiers.alt {
            // Terminals send Escape and a key right after it as that key with Alt.
            let escape = KeyEvent { key: Key::Escape, modifiers: Modifiers::default(), ..event };
            let modifiers = Modifiers { alt: false, ..event.modifiers };
            self.key(escape);
            return self.key(KeyEvent { modifiers, ..event });
        }
        self.is_stale = true;
        match self.pages.page() {
            EditorPage::Plan => {}
            EditorPage::Help => return self.close_page(),
            EditorPage::Unsaved | EditorPage::Journal => return self.press_in_menu(event),
        }
        self.message = None;
        if self.command.is_some() {
            return self.press_in_command(event);
        }
        let letter = letter(event);
        if mem::take(&mut self.awaits_character) {
            if let Some(character) = event.typed() {
                self.brush = character;
                self.draw_brush();
            }
            return;
        }
        if event.modifiers.control {
            if letter == Some('r') {
                self.redo();
            }
            return;
        }
        match event.key {
            Key::Left => self.step(-1, 0),
            Key::Right => self.step(1, 0),
            Key::Up => self.step(0, -1),
            Key::Down => self.step(0, 1),
            Key::Home => self.step(i64::MIN, 0),
            Key::End => self.step(i64::MAX, 0),
            Key::PageUp => self.step(0, -PAGE),
            Key::PageDown => self.step(0, PAGE),
            Key::Tab => self.next_brush(!event.modifiers.shift),
            Key::Enter => self.draw_brush(),
            Key::Delete | Key::Backspace => self.erase(),
            Key::Escape => self.anchor = None,
            _ => letter.into_iter().for_each(|letter| self.press_letter(letter)),
        }
    }

    fn press_letter(&mut self, letter: char) {
        match letter {
            'h' => self.step(-1, 0),
            'l' => self.step(1, 0),
            'k' => self.step(0, -1),
            'j' => self.step(0, 1),
            '0' => self.step(i64::MIN, 0),
            '$' => self.step(i64::MAX, 0),
            ' ' => self.draw_brush(),
            'b' => self.take_brush(),
            'r' => self.awaits_character = true,
            'x' | 'd' => self.erase(),
            'v' => self.anchor = if self.anchor.is_some() { None } else { Some(self.cursor) },
            'y' => self.copy(),
            'p' => self.paste(),
            'u' => self.undo(),
            '<' => self.turn(-TURN),
            '>' => self.turn(TURN),
            'e' => self.edit_definition(),
            'n' => self.next_fault(true),
            'N' => self.next_fault(false),
            't' => self.test_here(),
            ':' => self.command = Some(CommandLine::default()),
            '?' => self.open_page(EditorPage::Help),
            _ => self.say("? shows the keys"),
        }
    }

    fn press_in_menu(&mut self, event: KeyEvent) {
        let press = if event.phase == Phase::Repeat { Press::Repeat } else { Press::Fresh };
        let (bindings, held) = (Bindings::default(), HeldKeys::default());
        let key = match letter(event) {
            Some('j') => Key::Down,
            Some('k') => Key::Up,
            _ => event.key,
        };
        let effect = self.pages.press((key, press), &bindings, &held, Duration::ZERO);
        match effect {
            Effect::Choose => self.pages.menu.choice().into_iter().for_each(|it| self.choose(it)),
            Effect::Other if event.key == Key::Escape => self.choose(Choice::Stay),
            _ => {}
        }
    }

    fn press_in_command(&mut self, event: KeyEvent) {
        let Some(command) = &mut self.command else { return };
        match event.key {
            Key::Escape => self.command = None,
            Key::Backspace if command.text.is_empty() => self.command = None,
            Key::Enter => {
                let text: String = mem::take(&mut command.text).into_iter().collect();
                self.command = None;
                self.run(text.trim());
            }
            key => match event.typed() {
                Some(character) => command.insert(character),
                None => command.press(key),
            },
        }
    }

    /// Moves the cursor within the grid.
    fn step(&mut self, columns: i64, rows: i64) {
        let (width, height) = self.document.size();
        let moved = |from: u32, by: i64, end: u32| {
            i64::from(from).saturating_add(by).clamp(0, i64::from(end.saturating_sub(1))) as u32
        };
        self.cursor.column = moved(self.cursor.column, columns, width);
        self.cursor.row = moved(self.cursor.row, rows, height);
    }

    /// The characters that can be drawn.
    pub(crate) fn brushes(&self) -> Vec<char> {
        let defined = self.document.definitions().iter().map(|it| it.character);
        ['.'].into_iter().chain(defined).collect()
    }

    fn next_brush(&mut self, forward: bool) {
        let brushes = self.brushes();
        let count = brushes.len();
        let at = brushes.iter().position(|&it| it == self.brush);
        let next = match (at, forward) {
            (None, _) => 0,
            (Some(at), true) => (at + 1) % count,
            (Some(at), false) => (at + count - 1) % count,
        };
        self.choose_brush(brushes[next]);
    }

    fn choose_brush(&mut self, brush: char) {
        self.brush = brush;
        self.say(format!("draws {}", self.described(brush)));
    }

    fn take_brush(&mut self) {
        if let Some(character) = self.document.character(self.cursor) {
            self.choose_brush(character);
        }
    }

    /// A character with its definition.
    pub(crate) fn described(&self, character: char) -> String {
        match (self.document.definition(character), character) {
            (Some(definition), _) => format!("{character}  {}", definition.text),
            (None, '.' | ' ') => ".  open floor".to_owned(),
            (None, _) => format!("{character}  is not defined: :tile or :thing defines it"),
        }
    }

    /// The selected cells, or the cell at the cursor: the north-western and the south-eastern one.
    pub(crate) fn selection(&self) -> (Cell, Cell) {
        let (one, other) = (self.cursor, self.anchor.unwrap_or(self.cursor));
        let corner = |of: fn(u32, u32) -> u32| Cell {
            column: of(one.column, other.column),
            row: of(one.row, other.row),
        };
        (corner(u32::min), corner(u32::max))
    }

    fn selected(&self) -> Vec<Cell> {
        let (first, last) = self.selection();
        let rows = first.row..=last.row;
        let row = |row| (first.column..=last.column).map(move |column| Cell { column, row });
        rows.flat_map(row).collect()
    }

    fn draw_brush(&mut self) {
        let cells = self.selected();
        let drawn = self.document.draw(&cells, self.brush, false);
        self.anchor = None;
        self.changed(drawn);
    }

    fn erase(&mut self) {
        let erased = self.document.erase(&self.selected());
        self.anchor = None;
        self.changed(erased);
    }

    fn copy(&mut self) {
        let (first, last) = self.selection();
        let character = |column, row| self.document.character(Cell { column, row }).unwrap_or('.');
        let row = |row| (first.column..=last.column).map(|column| character(column, row)).collect();
        self.copied = (first.row..=last.row).map(row).collect();
        (self.cursor, self.anchor) = (first, None);
        let (columns, rows) = (last.column - first.column + 1, last.row - first.row + 1);
        self.say(format!("copied {columns}×{rows} cells"));
    }

    fn paste(&mut self) {
        let (width, height) = self.document.size();
        let Cell { column: left, row: top } = self.cursor;
        let rows = self.copied.iter().zip(top..height);
        let cells: Vec<_> = rows
            .flat_map(|(copied, row)| {
                let columns = copied.iter().zip(left..width);
                columns.map(move |(&character, column)| (Cell { column, row }, character))
            })
            .collect();
        if cells.is_empty() {
            return self.say("nothing is copied: y copies");
        }
        let written = self.document.write(&cells, false);
        self.changed(written);
    }

    fn undo(&mut self) {
        let undone = self.document.undo();
        self.follow_history(undone, "nothing to undo");
    }

    fn redo(&mut self) {
        let redone = self.document.redo();
        self.follow_history(redone, "nothing to redo");
    }

    fn follow_history(&mut self, step: Option<HistoryStep>, none: &str) {
        let Some(step) = step else { return self.say(none) };
        self.anchor = None;
        self.cursor = step.cell.unwrap_or(self.cursor);
        self.follow_text();
    }

    /// Turns the thing at the cursor and the view with it, or else only the view.
    fn turn(&mut self, degrees: f64) {
        let character = self.document.character(self.cursor);
        let definition = character.and_then(|character| self.document.definition(character));
        if definition.is_some_and(|definition| definition.heading().is_some()) {
            match self.document.turn(self.cursor, degrees) {
                Ok(heading) => {
                    self.heading = heading;
                    self.follow_text();
                }
                Err(sentence) => self.complain(sentence),
            }
        } else {
            self.heading = (self.heading + degrees).rem_euclid(360.0);
        }
    }

    /// Opens a command with the definition of the character at the cursor, to change it.
    fn edit_definition(&mut self) {
        let character = self.document.character(self.cursor).unwrap_or('.');
        let Some(definition) = self.document.definition(character) else {
            return self.say(self.described(character));
        };
        let command = if definition.is_thing { "thing" } else { "tile" };
        self.command = Some(CommandLine::of(&format!("{command} {character} {}", definition.text)));
    }

    /// Moves the cursor to the next or the previous cell with a fault.
    fn next_fault(&mut self, forward: bool) {
        self.check();
        let mut cells: Vec<Cell> =
            self.check.faults.iter().filter_map(|fault| fault.cells.first().copied()).collect();
        sort::by_key(&mut cells, |cell| (cell.row, cell.column));
        let place = |cell: &Cell| (cell.row, cell.column);
        let here = place(&self.cursor);
        let next = if forward {
            cells.iter().find(|cell| place(cell) > here).or(cells.first())
        } else {
            cells.iter().rev().find(|cell| place(cell) < here).or(cells.last())
        };
        match next {
            Some(&cell) => {
                let (width, height) = self.document.size();
                self.cursor =
                    Cell { column: cell.column.min(width - 1), row: cell.row.min(height - 1) };
            }
            None if self.check.faults.is_empty() => self.say("no faults"),
            None => self.say("the faults are in no cell"),
        }
    }

    /// Handles a mouse event.
    pub(crate) fn mouse(&mut self, event: MouseEvent) {
        if self.pages.page() != EditorPage::Plan || self.command.is_some() {
            return;
        }
        let place = [event.x, event.y].map(|units| (units / MouseEvent::UNITS_PER_CELL) as u16);
        match event.kind {
            MouseEventKind::Pressed(button) => {
                self.is_stale = true;
                self.message = None;
                self.press_mouse(place, button);
            }
            MouseEventKind::Moved => self.drag_to(place),
            MouseEventKind::Released => self.drag = None,
        }
    }

    fn press_mouse(&mut self, [x, y]: [u16; 2], button: MouseButton) {
        if self.screen.palette.contains((x, y).into()) {
            let brush = self.screen.brushes.iter().rev().find(|(column, _)| *column <= x);
            return brush.copied().into_iter().for_each(|(_, brush)| self.choose_brush(brush));
        }
        let Some(cell) = self.screen.plan.cell_at([x, y]) else { return };
        self.anchor = None;
        self.cursor = cell;
        self.step(0, 0);
        match button {
            MouseButton::Left => self.drag = Some((cell, false)),
            _ => self.take_brush(),
        }
    }

    /// Draws from the last cell of the drag to the cell there.
    fn drag_to(&mut self, place: [u16; 2]) {
        let Some((from, has_drawn)) = self.drag else { return };
        let Some(to) = self.screen.plan.cell_at(place).filter(|&to| to != from) else { return };
        self.is_stale = true;
        self.drag = Some((to, true));
        self.cursor = to;
        self.step(0, 0);
        let drawn = self.document.draw(&line(from, to), self.brush, has_drawn);
        self.changed(drawn);
    }

    /// Carries out a command.
    fn run(&mut self, text: &str) {
        let (name, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let rest = rest.trim();
        match name {
            "" => {}
            "w" => _ = self.save(false),
            "w!" => _ = self.save(true),
            "q" => self.leave(true),
            "q!" => self.leave(false),
            "wq" | "x" => {
                if self.save(false) {
                    self.leave(false);
                }
            }
            "tile" => self.define(false, rest),
            "thing" => self.define(true, rest),
            "set" => self.set(rest),
            "size" => match size(rest) {
                Some((columns, rows)) => {
                    let resized = self.document.resize(columns, rows);
                    self.changed(resized);
                }
                None => self.complain("write the columns and the rows, as in :size 40x25"),
            },
            _ => self
                .complain(format!("there is no command {name}: w, q, wq, tile, thing, set, size")),
        }
    }

    /// Defines a character, and takes it as the brush. Without a definition, opens the existing one.
    fn define(&mut self, is_thing: bool, rest: &str) {
        let mut characters = rest.chars();
        let text = characters.clone().skip(1).collect::<String>();
        let Some(character) =
            characters.next().filter(|_| text.is_empty() || text.starts_with(' '))
        else {
            let example =
                if is_thing { "thing g guard = \"warden\"" } else { "tile o wall = \"oak\"" };
            return self
                .complain(format!("write a character and its definition, as in :{example}"));
        };
        if text.trim().is_empty() {
            let known = self.document.definition(character).map_or("", |known| &known.text);
            let command = if is_thing { "thing" } else { "tile" };
            self.command = Some(CommandLine::of(&format!("{command} {character} {known}")));
            return;
        }
        let defined = self.document.define(is_thing, character, text.trim());
        if defined.is_ok() {
            self.choose_brush(character);
        }
        self.changed(defined);
    }

    /// Sets a key of the map. Without a value, opens the existing one.
    fn set(&mut self, rest: &str) {
        let (key, value) = rest.split_once('=').unwrap_or((rest, ""));
        let (key, value) = (key.trim(), value.trim());
        if !value.is_empty() || key.is_empty() {
            let set = self.document.set(key, value);
            return self.changed(set);
        }
        let known = self.document.value(key).unwrap_or_default();
        self.command = Some(CommandLine::of(&format!("set {key} = {known}")));
    }
}

/// The letter that a key types, or would type on a US keyboard if it types another script.
fn letter(event: KeyEvent) -> Option<char> {
    let key = match event.base {
        Some(base) => KeyEvent { key: base, ..event },
        None => event,
    };
    match (key.key, event.modifiers.control) {
        (Key::Char(character), true) => Some(character),
        _ => key.typed(),
    }
}

/// The numbers in `text`, such as `40x25`.
fn size(text: &str) -> Option<(u32, u32)> {
    let (columns, rows) = text.split_once(['x', '×', ' '])?;
    Some((columns.trim().parse().ok()?, rows.trim().parse().ok()?))
}

/// The cells on the way from one cell to another, with both.
fn line(from: Cell, to: Cell) -> Vec<Cell> {
    let along = |from: u32, to: u32| (i64::from(from), i64::from(to) - i64::from(from));
    let ((x, width), (y, height)) = (along(from.column, to.column), along(from.row, to.row));
    let steps = width.abs().max(height.abs()).max(1);
    let at = |start: i64, length: i64, step: i64| {
        (start + (2 * length * step + steps).div_euclid(2 * steps)) as u32
    };
    (0..=steps).map(|step| Cell { column: at(x, width, step), row: at(y, height, step) }).collect()
}
