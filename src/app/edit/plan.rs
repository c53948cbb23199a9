//! The plan of the map: the minimap, with the characters of the grid over it.
//!
//! The minimap needs a map without faults. Where the grid differs from the last one, or there is none, a cell shows its
//! character on black. The buffer of the plan has its colours before they are reduced to 256, because characters are drawn
//! in a colour that contrasts with the ground below them.

use glam::DVec2;
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::style::{Color, Modifier};
use ratatui::text::Span;
use ratatui::widgets::Widget;

use super::draw::Look;
use super::{Editor, SoundMap};
use crate::app::page::framed;
use crate::color::Rgb;
use crate::color::palette::ColorDepth;
use crate::fault::printable;
use crate::game::Game;
use crate::tui::canvas::Canvas;
use crate::tui::{GlyphSet, MapMark, Minimap, color_at, rgb_of};
use crate::world::{Camera, Cell};

/// The area of the plan, and the cells that it shows.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PlanArea {
    pub(crate) area: Rect,
    first: Cell,
    /// The columns for each cell: 1 or 2.
    pub(crate) cell_width: u16,
}

/// The background of the cell at the cursor, of faults and of the selection.
const CURSOR: Rgb = Rgb::new(0xff, 0xf0, 0x50);
const FAULT: Rgb = Rgb::new(0xd0, 0x20, 0x28);
const SELECTED: Rgb = Rgb::new(0x28, 0x58, 0xb8);
/// The color of the player's start.
const START: Rgb = Rgb::new(0x50, 0xd8, 0x78);
/// The opacities of the light and the dark characters of tiles, out of 255.
const LIGHTER: u8 = 110;
const DARKER: u8 = 130;

impl PlanArea {
    /// The cell at a place of the window.
    pub(crate) fn cell_at(&self, [x, y]: [u16; 2]) -> Option<Cell> {
        let Self { area, first, cell_width } = *self;
        area.contains((x, y).into()).then(|| Cell {
            column: first.column + u32::from((x - area.x) / cell_width.max(1)),
            row: first.row + u32::from(y - area.y),
        })
    }

    /// The place of a cell in the window, or `None` if it is not shown.
    fn place_of(&self, cell: Cell) -> Option<(u16, u16)> {
        let column = u16::try_from(cell.column.checked_sub(self.first.column)?).ok()?;
        let row = u16::try_from(cell.row.checked_sub(self.first.row)?).ok()?;
        let (x, y) = (column.checked_mul(self.cell_width)?, row);
        (x < self.area.width && y < self.area.height).then(|| (self.area.x + x, self.area.y + y))
    }

    /// The part of a grid of `columns` and `rows` that `room` shows. It contains `cursor`, and moves as little as possible
    /// from `first`.
    fn around(cursor: Cell, first: Cell, (columns, rows): (u32, u32), room: Rect) -> Self {
        let cell_width = if columns.saturating_mul(2) <= u32::from(room.width) { 2 } else { 1 };
        let along = |cursor: u32, first: u32, count: u32, shown: u32| {
            // The cursor stays away from the edge.
            let margin = shown.saturating_sub(1).min(4) / 2;
            let least = (cursor + margin + 1).saturating_sub(shown);
            let first = first.clamp(least, cursor.saturating_sub(margin).max(least));
            (first.min(count.saturating_sub(shown)), count.min(shown))
        };
        let (column, across) =
            along(cursor.column, first.column, columns, u32::from(room.width / cell_width));
        let (row, down) = along(cursor.row, first.row, rows, u32::from(room.height));
        let size = Size::new(across as u16 * cell_width, down as u16);
        let (x, y) =
            (room.x + (room.width - size.width) / 2, room.y + (room.height - size.height) / 2);
        let area = Rect { x, y, width: size.width, height: size.height };
        Self { area, first: Cell { column, row }, cell_width }
    }

    /// The cells that are shown, row by row.
    fn cells(self) -> impl Iterator<Item = Cell> {
        let (columns, rows) =
            (u32::from(self.area.width / self.cell_width.max(1)), u32::from(self.area.height));
        let Cell { column, row } = self.first;
        (row..row + rows)
            .flat_map(move |row| (column..column + columns).map(move |column| Cell { column, row }))
    }
}

impl Editor {
    /// Draws the plan with a frame. The view from `eye` was drawn before.
    pub(crate) fn draw_plan(
        &mut self,
        canvas: &mut impl Canvas,
        area: Rect,
        eye: Option<&Camera>,
        look: &Look<'_>,
    ) {
        let changed = if self.is_changed() { " *" } else { "" };
        let name = self.file.path().file_name().unwrap_or_default().to_string_lossy();
        let inner = framed(canvas, area, &format!("{}{changed}", printable(&name)));
        let plan =
            PlanArea::around(self.cursor, self.screen.plan.first, self.document.size(), inner);
        self.screen.plan = plan;
        let mut buffer = Buffer::empty(plan.area);
        // With fewer colours than 256, the minimap has its own.
        let has_many_colors = matches!(look.depth, ColorDepth::True | ColorDepth::Indexed256);
        let depth = if has_many_colors { ColorDepth::True } else { look.depth };
        let has_this_size = |sound: &&SoundMap| {
            let grid = sound.world.grid();
            (grid.width(), grid.height()) == self.document.size()
        };
        let sound = self.check.sound.as_deref().filter(has_this_size);
        if let Some((sound, camera)) = sound.zip(eye) {
            self.draw_minimap(&mut buffer, &sound.game, camera, (look.settings.glyphs, depth));
        }
        let rows: Vec<Vec<char>> = self
            .document
            .rows()
            .skip(plan.first.row as usize)
            .take(plan.area.height.into())
            .map(|row| row.chars().collect())
            .collect();
        for cell in plan.cells() {
            let row = rows.get((cell.row - plan.first.row) as usize);
            let character = row.and_then(|row| row.get(cell.column as usize)).copied();
            let drawn =
                sound.and_then(|it| it.rows.get(cell.row as usize)?.get(cell.column as usize));
            let is_drawn = character.is_some() && drawn.copied() == character;
            self.draw_cell(&mut buffer, cell, character, is_drawn, depth);
            self.mark_cell(&mut buffer, cell, self.check.faulty.contains(&cell), depth);
        }
        if look.depth == ColorDepth::Indexed256 {
            for cell in &mut buffer.content {
                let shown = |color| rgb_of(color).map_or(color, |rgb| color_at(look.depth, rgb));
                (cell.fg, cell.bg) = (shown(cell.fg), shown(cell.bg));
            }
        }
        canvas.draw_widget(Copied(&buffer), plan.area);
    }

    /// Draws the last map without faults, with its guards and its start.
    fn draw_minimap(
        &self,
        buffer: &mut Buffer,
        game: &Game,
        camera: &Camera,
        (glyphs, depth): (GlyphSet, ColorDepth),
    ) {
        let PlanArea { area, first, cell_width } = self.screen.plan;
        let shown = Size::new(area.width / cell_width, area.height);
        let corner = DVec2::new(first.column.into(), first.row.into());
        let middle = corner + DVec2::new(shown.width.into(), shown.height.into()) / 2.0;
        let guards =
            game.guards().map(|guard| MapMark { position: guard.position, heading: guard.heading });
        let guards: Vec<MapMark> = guards.collect();
        let map = Minimap::new(game.world(), camera)
            .cell_size(cell_width.into(), 1)
            .offset(middle - camera.position())
            .seen(self.view.distances())
            .marks(&guards)
            .showing_all_marks()
            .glyphs(glyphs)
            .color_depth(depth);
        map.paint(area, buffer);
        let start = game.world().start();
        let start = MapMark { position: start.cell.center(), heading: start.heading };
        map.paint_mark(area, buffer, &start, START);
    }

    /// Draws the character of a cell over what the map shows there.
    fn draw_cell(
        &self,
        buffer: &mut Buffer,
        cell: Cell,
        character: Option<char>,
        is_drawn: bool,
        depth: ColorDepth,
    ) {
        let Some((x, y)) = self.screen.plan.place_of(cell) else { return };
        let width = self.screen.plan.cell_width;
        if !is_drawn {
            (x..x + width).for_each(|x| buffer[(x, y)].reset());
        }
        let Some(character) = character else { return };
        let is_thing = self.document.definition(character).is_some_and(|it| it.is_thing);
        if matches!(character, '.' | ' ') && is_drawn {
            return;
        }
        let shown = if Span::raw(character.to_string()).width() == 1 { character } else { '?' };
        let at = &mut buffer[(x, y)];
        at.set_char(shown);
        let ground = rgb_of(at.bg).unwrap_or(Rgb::BLACK);
        let is_light = ground.luma() > 0x70;
        let ink = match (is_thing, is_light) {
            (true, true) => Rgb::BLACK,
            (true, false) => Rgb::WHITE,
            (false, true) => Rgb::BLACK.over(ground, DARKER),
            (false, false) => Rgb::WHITE.over(ground, LIGHTER),
        };
        at.fg = match depth {
            ColorDepth::Mono => Color::Reset,
            ColorDepth::Indexed16 if is_light => Color::Indexed(0),
            ColorDepth::Indexed16 => Color::Indexed(15),
            _ => color_at(depth, ink),
        };
        if is_thing {
            at.modifier.insert(Modifier::BOLD);
        }
    }

    /// Marks a cell with a fault, in the selection, or at the cursor.
    fn mark_cell(&self, buffer: &mut Buffer, cell: Cell, is_faulty: bool, depth: ColorDepth) {
        let Some((x, y)) = self.screen.plan.place_of(cell) else { return };
        let (first, last) = self.selection();
        let is_selected = self.anchor.is_some()
            && (first.column..=last.column).contains(&cell.column)
            && (first.row..=last.row).contains(&cell.row);
        let (ground, ink, of_16) = match (cell == self.cursor, is_faulty, is_selected) {
            (true, ..) => (CURSOR, Rgb::BLACK, [11, 0]),
            (_, true, _) => (FAULT, Rgb::WHITE, [9, 15]),
            (_, _, true) => (SELECTED, Rgb::WHITE, [4, 15]),
            _ => return,
        };
        for x in x..x + self.screen.plan.cell_width {
            let at = &mut buffer[(x, y)];
            if is_faulty && at.symbol() == " " {
                at.set_char('!');
            }
            match depth {
                ColorDepth::Mono => at.modifier.insert(Modifier::REVERSED),
                ColorDepth::Indexed16 => {
                    (at.bg, at.fg) = (Color::Indexed(of_16[0]), Color::Indexed(of_16[1]));
                }
                _ => (at.bg, at.fg) = (color_at(depth, ground), color_at(depth, ink)),
            }
            at.modifier.insert(Modifier::BOLD);
        }
    }
}

/// Cells that were drawn before.
struct Copied<'a>(&'a Buffer);

impl Widget for Copied<'_> {
    fn render(self, area: Rect, buffer: &mut Buffer) {
        for place in area.intersection(self.0.area).positions() {
            buffer[place] = self.0[place].clone();
        }
    }
}
