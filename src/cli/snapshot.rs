//! `cellcaster snapshot`: one frame on standard output, without a terminal.
//!
//! The game's widget draws the cells. They are made and written in bands of rows, because 4096×4096
//! cells at once would take most of a gigabyte.

mod ansi;
mod camera_remark;
mod json;
mod picture;
mod png;
mod text;
mod watched;

use std::io::{self, BufWriter, IsTerminal, Write};

use glam::DVec2;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;

use super::arguments::{Format, Generated, Snapshot};
use super::{Error, level};
use crate::color::Rgb;
use crate::color::palette;
use crate::game::Game;
use crate::generate::Site;
use crate::map::Level;
use crate::render::{DynCaster, Renderable};
use crate::space::{self, Elevation, Scene};
use crate::tui::View;
use crate::world::{Camera, Heading, World};
use picture::Picture;

/// The number of rows of cells made at a time: a multiple of the height of the dither pattern.
const BAND: u16 = 64;

/// A format for cells, row by row from the top.
trait Writer {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()>;

    /// Writes the part after the last row.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// Writes the frame that `options` request.
pub(crate) fn run(options: Snapshot, caster: &DynCaster) -> Result<(), Error> {
    let is_png = options.format == Format::Png && !options.explain;
    if is_png && options.watches {
        return Err(Error::mistake(
            "a PNG is one picture, and --watch draws several: leave one of them out",
        ));
    }
    if is_png && io::stdout().is_terminal() {
        return Err(no_png_here("snapshot"));
    }
    if options.watches {
        return watched::run(options, caster);
    }
    if let Some(generated) = options.generated {
        let (world, camera) = generated_world(generated, &options)?;
        let view = View::with_caster(caster.clone());
        return output(Picture::new(&world, &camera, view, &options), &options)
            .map_err(|error| Error::of_output(&error));
    }
    draw(&level::load(options.map.as_deref())?, &options, caster)
}

/// The error of `command`, which writes a PNG, if the output is a terminal.
pub fn no_png_here(command: &str) -> Error {
    Error::mistake(format!(
        "a PNG is no text, and standard output is a terminal: redirect it to a file, as in \
         \"cellcaster {command} --format png > picture.png\""
    ))
}

/// Draws the frame of `level`.
fn draw(level: &Level, options: &Snapshot, caster: &DynCaster) -> Result<(), Error> {
    match level {
        Level::Grid(world) => {
            // Guards are figures of a game, and not yet in the world of a map.
            let game = (!world.guards().is_empty()).then(|| Game::new((**world).clone()));
            let world = game.as_ref().map_or(&**world, Game::world);
            let camera = camera(world, options.camera, options);
            let view = View::with_caster(caster.clone());
            output(Picture::new(world, &camera, view, options), options)
        }
        Level::Space(scene) => {
            let camera = scene_camera(scene, options)?;
            output(Picture::new(scene, &camera, View::default(), options), options)
        }
    }
    .map_err(|error| Error::of_output(&error))
}

/// The part of a generated level around the camera, and the camera in it.
fn generated_world(generated: Generated, options: &Snapshot) -> Result<(World, Camera), Error> {
    let Some((position, heading)) = options.camera else {
        let (_, world) = level::generate(generated, generated.start)?;
        let camera = camera(&world, None, options);
        return Ok((world, camera));
    };
    let whole = position.floor();
    let site = Site { column: whole.x as i64, row: whole.y as i64 };
    let (window, world) = level::generate(generated, Some(site))?;
    // This is exact: the sum of a cell's corner in the window and the fraction of the coordinate.
    let corner = window.cell(site).map_or(DVec2::ZERO, |cell| cell.center() - 0.5);
    let camera = camera(&world, Some((corner + (position - whole), heading)), options);
    Ok((world, camera))
}

fn camera(world: &World, place: Option<(DVec2, Heading)>, options: &Snapshot) -> Camera {
    let start = world.start_camera(options.field_of_view);
    let camera =
        place.and_then(|(position, heading)| Camera::new(position, heading, options.field_of_view));
    let camera = camera.unwrap_or(start);
    let camera = options.eye.and_then(|eye| camera.with_eye(eye)).unwrap_or(camera);
    let is_chosen = place.is_some() || options.eye.is_some();
    if let Some(remark) = camera_remark::camera_remark(world, &camera).filter(|_| is_chosen) {
        Error::mistake(remark).warn();
    }
    camera.with_pitch(options.pitch.unwrap_or_default())
}

/// Values that are not given, including the height, are those of the start.
fn scene_camera(scene: &Scene, options: &Snapshot) -> Result<space::Camera, Error> {
    let start = scene.start_camera(options.field_of_view);
    let (position, heading) =
        options.camera.unwrap_or((start.position().truncate(), start.heading));
    let position = position.extend(options.eye.unwrap_or(start.position().z));
    let elevation = options.pitch.and_then(|pitch| Elevation::from_degrees(pitch.degrees()));
    let camera = space::Camera::new(position, heading, options.field_of_view);
    camera.map(|camera| camera.with_elevation(elevation.unwrap_or(start.elevation))).ok_or_else(
        || Error::mistake("--camera or --eye is further away than a map of bodies reaches"),
    )
}

fn output<S: Renderable>(mut picture: Picture<'_, S>, options: &Snapshot) -> io::Result<()> {
    let output = io::stdout().lock();
    if options.explain {
        let mut output = BufWriter::new(output);
        write!(output, "{}", picture.explain(size(options)))?;
        return output.flush();
    }
    picture.draw(size(options));
    write(&picture, options, output)
}

fn size(options: &Snapshot) -> Size {
    options.size.unwrap_or_default().cells()
}

fn write<S: Renderable>(
    picture: &Picture<'_, S>,
    options: &Snapshot,
    output: impl Write + 'static,
) -> io::Result<()> {
    let size = size(options);
    let mut writer = writer(options, size, output)?;
    let mut band = Buffer::default();
    for first_row in (0..size.height).step_by(usize::from(BAND)) {
        let area = Rect::new(0, 0, size.width, BAND.min(size.height - first_row));
        band.resize(area);
        picture.paint(first_row, area, &mut band);
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
        Format::Text => Box::new(text::Text::new(BufWriter::new(output))),
        Format::Ansi => Box::new(ansi::Ansi::new(BufWriter::new(output))),
        Format::Json => Box::new(json::Json::new(BufWriter::new(output), size)?),
        // It has a buffer of its own, and reports no error of one behind it.
        Format::Png => Box::new(png::Png::new(output, size, options.cell_aspect)?),
    })
}

/// The colour that represents `color` outside a terminal; `None` for the terminal's default.
fn rgb(color: Color) -> Option<Rgb> {
    match color {
        Color::Rgb(red, green, blue) => Some(Rgb::new(red, green, blue)),
        Color::Indexed(index) => Some(palette::of_256(index)),
        _ => None,
    }
}
