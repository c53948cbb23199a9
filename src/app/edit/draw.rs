//! The screen of the editor: the plan, the view, and four lines below them.

use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span, Text};

use super::keys::CommandLine;
use super::{Editor, EditorPage};
use crate::app::page::{self, BORDERS, framed, message, wrapped};
use crate::app::picture::{DrawOptions, TerminalLook};
use crate::app::settings::Settings;
use crate::app::text::sentences::{COMPASS, eighth};
use crate::color::Rgb;
use crate::color::palette::ColorDepth;
use crate::fault::printable;
use crate::tui::canvas::Canvas;
use crate::tui::{Correction, color_at};
use crate::world::{Camera, Cell, FieldOfView, Heading};

/// The narrowest window with a view beside the plan.
const MIN_COLUMNS_WITH_VIEW: u16 = 60;
/// The lines below the plan.
const LINES: u16 = 4;

const HELP: &str =
    "hjkl move  Space draw  Tab brush  x erase  v select  u undo  t test  :wq  ? keys";
const HELP_IN_SELECTION: &str = "Space fills the selection  x erases it  y copies it  Esc ends it";
const HELP_FOR_CHARACTER: &str = "type the character to draw, which becomes the brush";

/// The keys of the help page.
const KEYS: [&str; 20] = [
    "hjkl, arrows               move; Home End PgUp PgDn move further",
    "Space, Enter               draw the brush; a drag of the mouse draws, too",
    "Tab, Shift-Tab             next and previous brush",
    "b, right button            take the brush from the map",
    "r CHARACTER                draw this character",
    "x, Del                     erase; the floor below a thing stays",
    "v                          select a rectangle for Space, x and y",
    "y, p                       copy and paste",
    "u, Ctrl-R                  undo and redo, without end",
    "< >                        turn the view, and the thing at the cursor",
    "t                          test from here; Esc comes back",
    "n, N                       next and previous fault",
    "e                          change the definition at the cursor",
    ":tile o wall = \"oak\"       define a tile",
    ":thing g guard = \"warden\"  define a thing",
    ":set title = \"Cellar\"      set a key of the map",
    ":size 40x25                grow or shrink in the east and the south",
    ":w :q :wq                  write, leave, both; with ! in any case",
    "",
    "docs/editor.md and docs/maps.md say more. Any key closes this.",
];

/// The look of the screen.
pub(crate) struct Look<'a> {
    pub(crate) settings: &'a Settings,
    terminal: &'a TerminalLook,
    pub(crate) depth: ColorDepth,
}

impl Editor {
    /// Draws the whole screen.
    pub(crate) fn draw(
        &mut self,
        canvas: &mut impl Canvas,
        settings: &Settings,
        terminal: &TerminalLook,
    ) {
        self.is_stale = false;
        let area = canvas.bounds();
        if page::is_too_small(area) {
            return page::too_small(canvas);
        }
        let look = Look { settings, terminal, depth: settings.depth.unwrap_or(terminal.depth) };
        let panels = Rect { height: area.height.saturating_sub(LINES), ..area };
        let has_view = area.width >= MIN_COLUMNS_WITH_VIEW;
        let width = if has_view { self.plan_width(area.width) } else { area.width };
        let plan = Rect { width, ..panels };
        let view = Rect { x: plan.right(), width: area.width - width, ..panels };
        let eye = self.eye(settings.field_of_view);
        if has_view {
            self.draw_view(canvas, view, eye.as_ref(), &look);
        }
        self.draw_plan(canvas, plan, eye.as_ref(), &look);
        let line = |index: u16| Rect { y: panels.bottom() + index, height: 1, ..area };
        self.draw_palette(canvas, line(0));
        self.draw_lines(canvas, line(1), line(2), line(3), look.depth);
        match self.pages.page() {
            EditorPage::Plan => {}
            EditorPage::Help => message(canvas, area, "keys", Text::from_iter(KEYS)),
            EditorPage::Unsaved | EditorPage::Journal => self.pages.menu.draw(canvas, area),
        }
    }

    /// The width of the plan beside a view: half of the window, or more if the map needs it, up to three fifths.
    fn plan_width(&self, columns: u16) -> u16 {
        let most = columns / 5 * 3;
        let cells = self.document.size().0.min(columns.into()) as u16;
        let needed = [2 * cells, cells].map(|width| width + BORDERS);
        let fitting = needed.into_iter().find(|&width| width <= most).unwrap_or(most);
        fitting.max(columns / 2)
    }

    /// The camera of the view: at the cursor, or at the nearest place behind it that is not inside a wall. `None` before
    /// the map was without faults.
    fn eye(&self, field_of_view: FieldOfView) -> Option<Camera> {
        let world = &self.check.sound.as_deref()?.world;
        let heading = Heading::from_degrees(self.heading)?;
        let behind = |distance: i64| {
            let way = heading.direction() * -(distance as f64);
            let along = |from: u32, by: f64| i64::from(from) + by.round() as i64;
            let (column, row) = (along(self.cursor.column, way.x), along(self.cursor.row, way.y));
            world.grid().tile(column, row)?;
            Some(Cell { column: column as u32, row: row as u32 })
        };
        let is_open = |cell: &Cell| !world.grid().is_solid(cell.column.into(), cell.row.into());
        let cell = (0..).map_while(behind).find(is_open).unwrap_or(world.start().cell);
        Camera::in_cell(cell, heading, field_of_view)
            .with_eye(world.floor_at(cell) + Camera::STANDING)
    }

    fn draw_view(
        &mut self,
        canvas: &mut impl Canvas,
        area: Rect,
        eye: Option<&Camera>,
        look: &Look<'_>,
    ) {
        let has_faults = !self.check.faults.is_empty();
        let compass = COMPASS[eighth(self.heading)];
        let title =
            if has_faults { format!("{compass}, before the faults") } else { compass.to_owned() };
        let inner = framed(canvas, area, &title);
        let Some((camera, sound)) = eye.zip(self.check.sound.as_ref()) else {
            let lines = wrapped("The view appears when the map has no faults.", inner.width.into());
            return canvas.draw_widget(Text::from_iter(lines), inner);
        };
        let options = DrawOptions {
            glyphs: look.settings.glyphs,
            depth: look.depth,
            shade_ink: look.terminal.shade_ink,
            cell_aspect: look.settings.cell_aspect.or(look.terminal.aspect).unwrap_or_default(),
            filter: look.settings.filter,
            correction: Correction::default(),
            field_of_view: look.settings.field_of_view,
            flash: None,
            marks_middle: false,
        };
        options.draw(sound.game.world(), camera, 0.0, canvas, inner, &mut self.view);
    }

    /// Draws the characters that can be drawn, with the brush reversed.
    fn draw_palette(&mut self, canvas: &mut impl Canvas, area: Rect) {
        const LABEL: &str = "brush ";
        let mut brushes = self.brushes();
        if !brushes.contains(&self.brush) {
            brushes.push(self.brush);
        }
        let label = LABEL.len() as u16;
        let room = usize::from(area.width.saturating_sub(label) / 2).max(1);
        let at = brushes.iter().position(|&it| it == self.brush).unwrap_or_default();
        let skipped = (at + 1).saturating_sub(room);
        let shown = brushes.into_iter().skip(skipped).take(room);
        self.screen.palette = area;
        self.screen.brushes = (0..).map(|index| area.x + label + 2 * index).zip(shown).collect();
        let mut spans = vec![Span::raw(LABEL)];
        for &(_, brush) in &self.screen.brushes {
            let is_chosen = brush == self.brush;
            let style = if is_chosen {
                Style::new().add_modifier(Modifier::REVERSED)
            } else {
                Style::new()
            };
            spans.push(Span::styled(printable(&brush.to_string()), style));
            spans.push(Span::raw(" "));
        }
        canvas.draw_widget(Line::from(spans), area);
    }

    /// Draws the line about the cursor or the last key, the line about faults, and the line with keys or a command.
    fn draw_lines(
        &self,
        canvas: &mut impl Canvas,
        about: Rect,
        faults: Rect,
        keys: Rect,
        depth: ColorDepth,
    ) {
        let red = Style::new().fg(match depth {
            ColorDepth::Mono => Color::Reset,
            ColorDepth::Indexed16 => Color::Indexed(9),
            _ => color_at(depth, Rgb::new(0xff, 0x70, 0x60)),
        });
        let Cell { column, row } = self.cursor;
        let here = self.document.character(self.cursor).map_or_else(
            || "the row ends before this cell".to_owned(),
            |character| self.described(character),
        );
        let line = match &self.message {
            Some(message) if message.is_error => Line::styled(printable(&message.text), red),
            Some(message) => Line::raw(printable(&message.text)),
            None => Line::raw(format!("{column},{row}  {}", printable(&here))),
        };
        canvas.draw_widget(line, about);
        let list = &self.check.faults;
        let line = match list.iter().find(|it| it.cells.contains(&self.cursor)).or(list.first()) {
            Some(fault) if list.len() == 1 => Line::styled(fault.sentence.clone(), red),
            Some(fault) => {
                Line::styled(format!("{} faults (n): {}", list.len(), fault.sentence), red)
            }
            None => Line::raw(self.check.remark.unwrap_or("no faults")).style(Modifier::DIM),
        };
        canvas.draw_widget(line, faults);
        if let Some(command) = &self.command {
            return draw_command(canvas, keys, command);
        }
        let text = match (self.awaits_character, self.anchor) {
            (true, _) => HELP_FOR_CHARACTER,
            (_, Some(_)) => HELP_IN_SELECTION,
            _ => HELP,
        };
        canvas.draw_widget(Line::raw(text).style(Modifier::REVERSED), keys);
    }
}

/// Draws a command with its cursor, which is always in view.
fn draw_command(canvas: &mut impl Canvas, area: Rect, command: &CommandLine) {
    let room = usize::from(area.width.saturating_sub(2)).max(1);
    let skipped = (command.at + 1).saturating_sub(room);
    let mut spans = vec![Span::raw(":")];
    for index in skipped..=command.text.len() {
        let character = command.text.get(index).copied().unwrap_or(' ');
        let is_there = index == command.at;
        let style =
            if is_there { Style::new().add_modifier(Modifier::REVERSED) } else { Style::new() };
        spans.push(Span::styled(printable(&character.to_string()), style));
    }
    canvas.draw_widget(Line::from(spans), area);
}
