//! Pictures of a room for browsers: what the lobby's live picture shows, and the bytes that carry it.
//!
//! A message holds pictures in the order of their steps. It is compressed with raw DEFLATE, which browsers decompress.
//! Numbers are big-endian:
//!
//! ```text
//! whole picture:  0, step u32, columns u8, rows u8, the cells by rows
//! changes:        1, step u32, count of runs u16, runs of: first cell u16, count u16, the cells
//! cell:           0, upper RGB, lower RGB
//!                 n, n bytes of a character in UTF-8, its RGB, the RGB behind it
//! ```

use std::io::Write as _;

use bytes::Bytes;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::text::Line;

use crate::rooms::room::{Catalog, RoomView};
use crate::sessions::session::draw::with_view;
use crate::sessions::session::lobby::seen_through;
use cellcaster::app::parts::DrawOptions;
use cellcaster::color::palette::{ColorDepth, ShadeInk};
use cellcaster::render::Filter;
use cellcaster::tui::canvas::Canvas;
use cellcaster::tui::{CellAspect, Correction, GlyphSet};
use cellcaster::world::FieldOfView;

/// The size of a picture in cells.
pub(crate) const COLUMNS: u16 = 96;
pub(crate) const ROWS: u16 = 30;
/// The most equal cells between two changes that a run contains, because a new run costs four bytes.
const MAX_GAP: usize = 1;
/// The colours of text.
const TEXT: [Color; 2] = [Color::Rgb(220, 220, 220), Color::Rgb(0, 0, 0)];

type Rgb = [u8; 3];

/// A cell of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cell {
    /// Two pixels, the upper one first.
    Halves([Rgb; 2]),
    /// A character, its colour, and the colour behind it.
    Text(char, [Rgb; 2]),
}

/// Draws what the lobby shows of a room: what a member sees, or the level if nobody may be seen through.
pub(crate) fn draw(room: &RoomView, catalog: &Catalog) -> Vec<Cell> {
    let options = DrawOptions {
        glyphs: GlyphSet::Half,
        depth: ColorDepth::True,
        shade_ink: ShadeInk::default(),
        cell_aspect: CellAspect::default(),
        filter: Filter::default(),
        correction: Correction::default(),
        field_of_view: FieldOfView::default(),
        flash: None,
        marks_middle: false,
    };
    let area = Rect::new(0, 0, COLUMNS, ROWS);
    let mut canvas = Buffer::empty(area);
    if let Some((_, player)) = seen_through(room) {
        let camera = player.camera(options.field_of_view);
        let (world, seconds) = (room.game.world(), room.game.elapsed());
        with_view(|view| options.draw(world, &camera, seconds, &mut canvas, area, view));
    } else {
        // The room's own world might show somebody who hides.
        if let Some(world) = catalog.world(&room.header.level) {
            let camera = world.start_camera(options.field_of_view);
            with_view(|view| options.draw(&*world, &camera, 0.0, &mut canvas, area, view));
        }
        let [text, behind] = TEXT;
        let caption = Line::styled(" nobody is walking ", Style::new().fg(text).bg(behind));
        let width = caption.width() as u16;
        let (x, y) = (area.right() - width, area.bottom() - 1);
        canvas.draw_widget(caption, Rect { x, y, width, height: 1 });
    }
    canvas.content.iter().map(cell).collect()
}

fn cell(cell: &ratatui::buffer::Cell) -> Cell {
    let character = cell.symbol().chars().next().unwrap_or(' ');
    let [fore, back] = [rgb(cell.fg, TEXT[0]), rgb(cell.bg, TEXT[1])];
    match character {
        ' ' => Cell::Halves([back, back]),
        '█' => Cell::Halves([fore, fore]),
        '▀' => Cell::Halves([fore, back]),
        '▄' => Cell::Halves([back, fore]),
        _ => Cell::Text(character, [fore, back]),
    }
}

fn rgb(color: Color, default: Color) -> Rgb {
    match (color, default) {
        (Color::Rgb(red, green, blue), _) | (_, Color::Rgb(red, green, blue)) => [red, green, blue],
        _ => [0; 3],
    }
}

/// A message that is being written.
#[derive(Debug, Default)]
pub(crate) struct Message(Vec<u8>);

impl Message {
    /// Adds a whole picture.
    pub(crate) fn push_whole(&mut self, step: u32, cells: &[Cell]) {
        self.push_head(0, step);
        self.0.extend([COLUMNS as u8, ROWS as u8]);
        for cell in cells {
            push(&mut self.0, *cell);
        }
    }

    /// Adds the changes from one picture to the next, if there are any.
    pub(crate) fn push_changes(&mut self, step: u32, before: &[Cell], after: &[Cell]) {
        let mut runs: Vec<(usize, usize)> = Vec::new();
        for (at, (before, after)) in before.iter().zip(after).enumerate() {
            if before == after {
                continue;
            }
            match runs.last_mut() {
                Some((_, end)) if at <= *end + MAX_GAP => *end = at + 1,
                _ => runs.push((at, at + 1)),
            }
        }
        if runs.is_empty() {
            return;
        }
        self.push_head(1, step);
        self.push_number(runs.len());
        for (start, end) in runs {
            self.push_number(start);
            self.push_number(end - start);
            for cell in &after[start..end] {
                push(&mut self.0, *cell);
            }
        }
    }

    /// The bytes for browsers; `None` if there is no picture. The message is empty again.
    pub(crate) fn take(&mut self) -> Option<Bytes> {
        let bytes = std::mem::take(&mut self.0);
        (!bytes.is_empty()).then(|| compressed(&bytes))
    }

    fn push_head(&mut self, kind: u8, step: u32) {
        self.0.push(kind);
        self.0.extend(step.to_be_bytes());
    }

    fn push_number(&mut self, number: usize) {
        self.0.extend((number as u16).to_be_bytes());
    }
}

fn push(bytes: &mut Vec<u8>, cell: Cell) {
    let colors = match cell {
        Cell::Halves(colors) => {
            bytes.push(0);
            colors
        }
        Cell::Text(character, colors) => {
            let mut buffer = [0; 4];
            let text = character.encode_utf8(&mut buffer);
            bytes.push(text.len() as u8);
            bytes.extend(text.as_bytes());
            colors
        }
    };
    bytes.extend(colors.as_flattened());
}

fn compressed(bytes: &[u8]) -> Bytes {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::fast());
    // Writing into memory cannot fail.
    _ = encoder.write_all(bytes);
    encoder.finish().unwrap_or_default().into()
}
