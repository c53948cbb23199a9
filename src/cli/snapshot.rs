//! `cellcaster snapshot`: writes one frame to standard output, without a terminal.
//!
//! The game's widget draws the cells. They are created and written in bands of rows, because
//! 4096×4096 cells at once would take most of a gigabyte.

mod format;

use std::io::{self, BufWriter, IsTerminal, Write};

use clap::Args;
use glam::DVec2;
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};

use self::format::SnapshotFormat;
use super::options::{LevelOptions, PictureOptions, replace_art, size, within};
use super::parse::ValidValues;
use super::{Error, level};
use crate::game::Game;
use crate::generate::{Generator, Site};
use crate::map::Level;
use crate::render::Renderable;
use crate::space::{self, Elevation, Scene};
use crate::testing::MAX_CELLS;
use crate::tui::{FirstPerson, View};
use crate::world::{Camera, Cell, FieldOfView, Heading, Pitch, TileKind, World};

/// Write one frame to standard output
///
/// Draws what the game would show. It needs no terminal, and writes the same bytes on every machine. In a map of
/// bodies, --eye and --pitch default to the values of its start.
#[derive(Args, Debug)]
#[command(after_long_help = "\
Examples:
  cellcaster snapshot museum --format ansi
  cellcaster snapshot my.toml --size 120x40 --format png > my.png
  cellcaster snapshot my.toml --camera 2.5,3.5,90 --format json")]
pub(crate) struct Snapshot {
    /// The size of the picture in cells, from 1x1 to 4096x4096
    #[arg(long, value_name = "COLSxROWS", default_value = "80x24", value_parser = size)]
    size: Size,
    /// The position in cells and the heading in degrees: 0 is east, 90 south [default: the map's start]
    #[arg(long, value_name = "X,Y,HEADING", value_parser = position_and_heading)]
    camera: Option<(DVec2, Heading)>,
    /// The height of the eye above floor level, in cells [default: 0.5]
    #[arg(long, value_name = "HEIGHT", value_parser = eye)]
    eye: Option<f64>,
    /// The pitch, from -30 (down) to 30 degrees (up) [default: 0]
    #[arg(long, value_name = "DEG", value_parser = pitch)]
    pitch: Option<Pitch>,
    #[command(flatten)]
    look: PictureOptions,
    /// The output format: characters (text), characters with colours (ansi), a list of cells (json), a text for tests and
    /// reviews (grid; see "compare"), or a picture (png)
    #[arg(long, value_enum, default_value_t)]
    format: SnapshotFormat,
    /// Print how the frame is drawn and what it costs, instead of the frame
    #[arg(long)]
    explain: bool,
    #[command(flatten)]
    place: LevelOptions,
}

impl Snapshot {
    fn field_of_view(&self) -> FieldOfView {
        self.look.view.field_of_view.unwrap_or_default()
    }
}

fn position_and_heading(text: &str) -> Result<(DVec2, Heading), ValidValues> {
    let camera = || {
        let mut numbers = text.split(',').map(|number| number.trim().parse::<f64>().ok());
        let position = DVec2::new(numbers.next()??, numbers.next()??);
        let heading = Heading::from_degrees(numbers.next()??)?;
        (position.is_finite() && numbers.next().is_none()).then_some((position, heading))
    };
    camera().ok_or(ValidValues("X,Y,HEADING, three finite numbers such as 2.5,3.5,90"))
}

fn eye(text: &str) -> Result<f64, ValidValues> {
    within(text, |eye: &f64| eye.is_finite(), "a finite height in cells, such as 0.5")
}

fn pitch(text: &str) -> Result<Pitch, ValidValues> {
    let pitch = text.parse().ok().and_then(Pitch::from_degrees);
    pitch.ok_or(ValidValues("degrees from -30, down, to 30, up"))
}

/// The number of rows of cells in a band: a multiple of the height of the dither pattern.
const BAND: u16 = 64;

/// Writes the frame that `options` describe.
pub(crate) fn run(options: &Snapshot) -> Result<(), Error> {
    let is_png = options.format == SnapshotFormat::Png && !options.explain;
    if is_png && io::stdout().is_terminal() {
        return Err(Error::mistake(
            "standard output is a terminal, which cannot show a PNG: redirect it to a file, as in \
             \"cellcaster snapshot --format png > picture.png\"",
        ));
    }
    let cells = usize::from(options.size.width) * usize::from(options.size.height);
    if options.format == SnapshotFormat::Grid && !options.explain && cells > MAX_CELLS {
        return Err(Error::mistake(format!(
            "a grid has at most {MAX_CELLS} cells, but --size asks for {cells}: choose a smaller size"
        )));
    }
    replace_art(options.look.art.as_deref())?;
    if let Some(generator) = options.place.generate {
        let (world, camera) = generated_world(generator, options)?;
        return output(&world, &camera, View::default(), options)
            .map_err(|error| Error::of_output(&error));
    }
    draw(&level::load(options.place.map.as_deref())?, options)
}

/// Draws the frame of `level`.
fn draw(level: &Level, options: &Snapshot) -> Result<(), Error> {
    match level {
        Level::Grid(world) => {
            // Guards are figures of a game, and not yet part of a map's world.
            let game = (!world.guards().is_empty()).then(|| Game::new((**world).clone()));
            let world = game.as_ref().map_or(&**world, Game::world);
            let camera = camera(world, options.camera, options);
            output(world, &camera, View::default(), options)
        }
        Level::Space(scene) => {
            let camera = scene_camera(scene, options)?;
            output(scene, &camera, View::default(), options)
        }
    }
    .map_err(|error| Error::of_output(&error))
}

/// The part of a generated level around the camera, and the camera in it.
fn generated_world(generator: Generator, options: &Snapshot) -> Result<(World, Camera), Error> {
    let Some((position, heading)) = options.camera else {
        let (_, world) = level::generate(generator, &options.place, options.place.start)?;
        let camera = camera(&world, None, options);
        return Ok((world, camera));
    };
    let whole = position.floor();
    let site = Site { column: whole.x as i64, row: whole.y as i64 };
    let (window, world) = level::generate(generator, &options.place, Some(site))?;
    // This sum is exact, because it adds the corner of a cell in the window and the fraction of the
    // coordinate.
    let corner = window.cell(site).map_or(DVec2::ZERO, |cell| cell.center() - 0.5);
    let camera = camera(&world, Some((corner + (position - whole), heading)), options);
    Ok((world, camera))
}

fn camera(world: &World, place: Option<(DVec2, Heading)>, options: &Snapshot) -> Camera {
    let start = world.start_camera(options.field_of_view());
    let camera = place
        .and_then(|(position, heading)| Camera::new(position, heading, options.field_of_view()));
    let camera = camera.unwrap_or(start);
    let camera = options.eye.and_then(|eye| camera.with_eye(eye)).unwrap_or(camera);
    let is_chosen = place.is_some() || options.eye.is_some();
    if let Some(remark) = camera_remark(world, &camera).filter(|_| is_chosen) {
        Error::mistake(remark).warn();
    }
    camera.with_pitch(options.pitch.unwrap_or_default())
}

/// The camera in `scene`. Values that the options omit, including the height, are taken from the
/// start.
fn scene_camera(scene: &Scene, options: &Snapshot) -> Result<space::Camera, Error> {
    let start = scene.start_camera(options.field_of_view());
    let (position, heading) =
        options.camera.unwrap_or((start.position().truncate(), start.heading));
    let position = position.extend(options.eye.unwrap_or(start.position().z));
    let elevation = options.pitch.and_then(|pitch| Elevation::from_degrees(pitch.degrees()));
    let camera = space::Camera::new(position, heading, options.field_of_view());
    camera
        .map(|camera| camera.with_elevation(elevation.unwrap_or(start.elevation)))
        .ok_or_else(|| Error::mistake("--camera or --eye is outside the range of a map of bodies"))
}

/// Renders the view of `camera` into `scene` once, and converts it to cells band by band.
fn output<S: Renderable>(
    scene: &S,
    camera: &S::Camera,
    mut view: View<S>,
    options: &Snapshot,
) -> io::Result<()> {
    let (size, look) = (options.size, &options.look);
    let aspect = look.cell_aspect.unwrap_or_default();
    let widget = FirstPerson::new(scene, camera)
        .glyphs(look.glyphs.unwrap_or_default())
        .color_depth(look.view.depth.unwrap_or_default())
        .cell_aspect(aspect)
        .filter(look.filter);
    let output = io::stdout().lock();
    if options.explain {
        let mut output = BufWriter::new(output);
        if let Some(explanation) = widget.explain(size, &mut view) {
            write!(output, "{explanation}")?;
        }
        return output.flush();
    }
    widget.draw(size, &mut view);
    let mut writer = options.format.writer(size, aspect, output)?;
    let mut band = Buffer::default();
    for first_row in (0..size.height).step_by(usize::from(BAND)) {
        let area = Rect::new(0, 0, size.width, BAND.min(size.height - first_row));
        band.resize(area);
        widget.paint(&view, first_row, area, &mut band);
        for cells in band.content.chunks_exact(usize::from(size.width)) {
            writer.write_row(cells)?;
        }
    }
    writer.finish()
}

/// A remark on a `camera` that is off the map or inside a solid cell; `None` for any other camera.
/// The picture is drawn anyway, because a camera may be anywhere, but a position inside a wall is
/// probably a mistake.
fn camera_remark(world: &World, camera: &Camera) -> Option<String> {
    let (grid, position) = (world.grid(), camera.position());
    let is_on_map = (0.0..f64::from(grid.width())).contains(&position.x)
        && (0.0..f64::from(grid.height())).contains(&position.y);
    if !is_on_map {
        let (columns, rows) = (grid.width(), grid.height());
        return Some(format!("the camera is outside the map, which has {columns}×{rows} cells"));
    }
    let cell = Cell::at(position);
    let tile = world.tile_in(cell)?;
    let (eye, floor, ceiling) = (camera.eye(), tile.heights.floor(), tile.heights.ceiling());
    if tile.gaps().any(|gap| gap.holds(eye)) {
        return None;
    }
    Some(if matches!(tile.kind, TileKind::Wall(_) | TileKind::Mirror(_)) {
        "the camera is inside a wall".to_owned()
    } else if eye < floor {
        format!(
            "the camera is below the floor: the eye is at a height of {eye}, the floor at {floor}"
        )
    } else {
        format!(
            "the camera is inside the ceiling: the eye is at a height of {eye}, the ceiling at \
             {ceiling}"
        )
    })
}
