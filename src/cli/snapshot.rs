//! `cellcaster snapshot`: one frame to standard output, no terminal needed.
//!
//! The cells are those that the game shows, made by the same widget. They are made and written a
//! band of rows at a time: the cells of 4096×4096 at once would take most of a gigabyte.

mod ansi;
mod json;
mod png;
mod text;

use std::io::{self, BufWriter, Write};

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;

use super::arguments::{Format, Snapshot};
use super::{Error, level};
use crate::palette;
use crate::tui::{FirstPerson, View};
use crate::world::{Camera, Rgb};

/// Rows of cells that are made at a time: a multiple of the height of the pattern that dithers.
const BAND: u16 = 64;

/// A way of writing cells, row by row from the top.
trait Writer {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()>;

    /// After the last row.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// Writes the frame that `options` ask for.
pub(super) fn run(options: &Snapshot) -> Result<(), Error> {
    let world = level::load(options.map.as_deref())?;
    let camera = match options.camera {
        None => world.start_camera(options.field_of_view),
        Some((position, heading)) => Camera::new(position, heading, options.field_of_view)
            .unwrap_or_else(|| world.start_camera(options.field_of_view)),
    };
    let camera = options.eye.and_then(|eye| camera.with_eye(eye)).unwrap_or(camera);
    let camera = camera.with_pitch(options.pitch);
    let picture = FirstPerson::new(&world, &camera)
        .glyphs(options.glyphs)
        .color_depth(options.depth)
        .cell_aspect(options.cell_aspect)
        .filter(options.filter);
    let output = BufWriter::new(io::stdout().lock());
    if options.explain {
        return explain(&picture, options, output).map_err(|error| Error::of_output(&error));
    }
    write(&picture, options, output).map_err(|error| Error::of_output(&error))
}

/// Writes how the frame is drawn, and what it costs.
fn explain(picture: &FirstPerson, options: &Snapshot, mut output: impl Write) -> io::Result<()> {
    let mut view = View::with_method(options.method.clone());
    if let Some(explanation) = picture.explain(size(options), &mut view) {
        write!(output, "{explanation}")?;
    }
    output.flush()
}

fn size(options: &Snapshot) -> Size {
    Size::new(options.size.columns, options.size.rows)
}

fn write(
    picture: &FirstPerson,
    options: &Snapshot,
    output: impl Write + 'static,
) -> io::Result<()> {
    let size = size(options);
    let mut view = View::with_method(options.method.clone());
    picture.draw(size, &mut view);

    let mut writer = writer(options, size, output)?;
    let mut band = Buffer::default();
    for first_row in (0..size.height).step_by(usize::from(BAND)) {
        let area = Rect::new(0, 0, size.width, BAND.min(size.height - first_row));
        band.resize(area);
        picture.paint(&view, first_row, area, &mut band);
        for cells in band.content.chunks_exact(usize::from(size.width)) {
            writer.write_row(cells)?;
        }
    }
    writer.finish()
}

fn writer(
    options: &Snapshot,
    size: Size,
    output: impl Write + 'static,
) -> io::Result<Box<dyn Writer>> {
    Ok(match options.format {
        Format::Text => Box::new(text::Text::new(output)),
        Format::Ansi => Box::new(ansi::Ansi::new(output)),
        Format::Json => Box::new(json::Json::new(output, size)?),
        Format::Png => Box::new(png::Png::new(output, size, options.cell_aspect)?),
    })
}

/// The colour that stands for `color` outside a terminal; `None` for the terminal's own.
fn rgb(color: Color) -> Option<Rgb> {
    match color {
        Color::Rgb(red, green, blue) => Some(Rgb::new(red, green, blue)),
        Color::Indexed(index) => Some(palette::of_256(index)),
        _ => None,
    }
}
