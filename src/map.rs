//! The map file: TOML with a grid drawn in characters, read into a [`World`].
//!
//! ```
//! let world = cellcaster::map::parse_str(
//!     r#"
//! grid = '''
//! %%%%
//! %@.%
//! %%%%
//! '''
//! [tiles]
//! "%" = { wall = "brick" }
//! [things]
//! "@" = { start = 0 }
//! "#,
//! )
//! .unwrap();
//! assert_eq!((world.grid().width(), world.grid().height()), (4, 3));
//! ```
//!
//! Reading goes in stages, each of which adds what it finds wrong to one list: the TOML, the
//! definitions of characters, the grid that is drawn with them, and the textures that the grid
//! uses. A stage works with what the earlier ones could make out, and is silent about
//! anything that an earlier one has found fault with. Rows of unequal length are a fault: padding
//! short ones was refused, as a lost character then moves half a wall without a word.

mod air;
pub mod builtin;
mod covering;
mod definitions;
mod doors;
mod drawing;
mod heights;
mod lamps;
mod layout;
mod legend;
mod per_character;
mod picture;
mod scene;
mod see_through;
mod shapes;
mod sprites;
mod supports;
mod textures;

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use crate::color::Rgb;
use crate::fault::{Fault, Faults, document};
use crate::space::Scene;
use crate::world::{Ceiling, Covering, Heights, Paint, Parts, Sky, Tile, TileKind, World};
use definitions::Definitions;
use drawing::Drawing;
use heights::Faces;
pub(crate) use lamps::lamplight;
use layout::Layout;
pub use textures::{Folder, NoFiles, TextureFileError, TextureFiles};
use textures::{Surface, Textures};

/// The largest map file, in bytes. The largest grid, in characters of three bytes, has room.
pub const MAX_BYTES: usize = 64 << 20;
/// The most columns, and the most rows, of a grid.
pub const MAX_SIDE: u32 = 4096;

/// What a map describes: there are two kinds.
#[derive(Clone, Debug, PartialEq)]
pub enum Level {
    /// A grid of tiles.
    Grid(Box<World>),
    /// Spheres, planes and boxes.
    Space(Scene),
}

/// The world that the map `text` describes. Faults call the map `name`; textures that are not
/// built in come from `files`.
///
/// # Errors
/// Everything that is wrong with the map, or that it has no grid but bodies.
pub fn parse(text: &str, name: &str, files: &dyn TextureFiles) -> Result<World, Faults> {
    parse_level(text, name, files)?.into_world(name)
}

/// As [`parse`], for a map of either kind.
///
/// # Errors
/// Everything that is wrong with the map.
pub fn parse_level(text: &str, name: &str, files: &dyn TextureFiles) -> Result<Level, Faults> {
    if text.len() > MAX_BYTES {
        return Err(too_large(name));
    }
    let mut faults = Vec::new();
    match read(text, files, &mut faults) {
        Some(level) if faults.is_empty() => Ok(level),
        _ => Err(Faults::new(name, text, faults)),
    }
}

/// As [`parse`], for a map whose textures are all built in.
///
/// # Errors
/// Everything that is wrong with the map, which they call `map`.
pub fn parse_str(text: &str) -> Result<World, Faults> {
    parse(text, "map", &NoFiles)
}

/// The world that the map file at `path` describes. Textures that are not built in are files in
/// its folder, or in folders within that.
///
/// # Errors
/// Everything that is wrong with the map, or why the file cannot be read.
pub fn load(path: &Path) -> Result<World, Faults> {
    load_level(path)?.into_world(&path.display().to_string())
}

/// As [`load`], for a map of either kind.
///
/// # Errors
/// Everything that is wrong with the map, or why the file cannot be read.
pub fn load_level(path: &Path) -> Result<Level, Faults> {
    load_level_with(path, &Folder::of(path))
}

/// As [`load_level`], with textures from elsewhere than the map's folder.
///
/// # Errors
/// As [`load_level`].
pub fn load_level_with(path: &Path, files: &dyn TextureFiles) -> Result<Level, Faults> {
    let name = path.display().to_string();
    let is_folder = fs::metadata(path).map(|metadata| metadata.is_dir());
    let file = match is_folder {
        Ok(true) => Err(io::ErrorKind::IsADirectory.into()),
        Ok(false) => File::open(path),
        Err(error) => Err(error),
    };
    read_level(file.map_err(|error| unreadable(&name, &error))?, &name, files)
}

/// The level that the map in `input` describes. Faults call the map `name`; textures that are not
/// built in come from `files`. Of an input that is larger than [`MAX_BYTES`], the rest is not read.
///
/// # Errors
/// Everything that is wrong with the map, or why it cannot be read.
pub fn read_level(input: impl Read, name: &str, files: &dyn TextureFiles) -> Result<Level, Faults> {
    parse_level(&read_text(input, name)?, name, files)
}

impl From<World> for Level {
    fn from(world: World) -> Self {
        Self::Grid(Box::new(world))
    }
}

impl From<Scene> for Level {
    fn from(scene: Scene) -> Self {
        Self::Space(scene)
    }
}

impl Level {
    fn into_world(self, name: &str) -> Result<World, Faults> {
        match self {
            Self::Grid(world) => Ok(*world),
            Self::Space(_) => {
                let message = format!("{name} is a map of bodies, and has no grid");
                Err(Faults::of_whole_file(name, message, "name a map with a grid"))
            }
        }
    }
}

fn read_text(input: impl Read, name: &str) -> Result<String, Faults> {
    let mut bytes = Vec::new();
    let read = input.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes);
    read.map_err(|error| unreadable(name, &error))?;
    if bytes.len() > MAX_BYTES {
        return Err(too_large(name));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..valid].split(|&byte| byte == b'\n').count();
        let message = format!(
            "{name} is not UTF-8 text: line {line} has a byte that is part of no character"
        );
        Faults::of_whole_file(name, message, "save the map in the encoding UTF-8")
    })
}

/// At most `limit` bytes of a file: what lies beyond is not read.
fn read_up_to(path: &Path, limit: usize) -> io::Result<Vec<u8>> {
    if fs::metadata(path)?.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(limit as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn too_large(name: &str) -> Faults {
    let limit = MAX_BYTES >> 20;
    let message = format!("{name} is larger than {limit} MiB, the most that a map may have");
    Faults::of_whole_file(name, message, "")
}

fn unreadable(name: &str, error: &io::Error) -> Faults {
    let (message, help) = match error.kind() {
        io::ErrorKind::NotFound => (format!("there is no file {name}"), ""),
        io::ErrorKind::IsADirectory => {
            (format!("{name} is a folder, not a map"), "name a map file in it")
        }
        kind => (format!("{name} cannot be read: {kind}"), ""),
    };
    Faults::of_whole_file(name, message, help)
}

/// What `text` describes. Where it is not a map, that is added to `faults`.
fn read(text: &str, files: &dyn TextureFiles, faults: &mut Vec<Fault>) -> Option<Level> {
    let document = document::parse(text, faults);
    let not_toml = std::mem::take(faults);
    if scene::has_bodies(&document) {
        let scene = scene::read(&document, faults);
        keep_apart(faults, not_toml, text);
        return scene.map(Level::Space);
    }
    let definitions = Definitions::read(&document, faults);
    if !not_toml.is_empty() {
        keep_apart(faults, not_toml, text);
        return None;
    }
    let mut textures = Textures::new(files);
    let floor = definitions.floor.covering(&mut textures, faults);
    let ceiling = definitions.ceiling.ceiling(&mut textures, faults);
    let sky = definitions.sky.as_ref().map(|sky| sky.sky(&mut textures, faults));
    let Some(grid) = &definitions.grid else {
        faults.push(no_grid());
        return None;
    };
    let drawing = Drawing::read(grid, text, faults)?;
    // Where one of the two has a fault, nothing will come of the tiles but further faults.
    let plain = Covering::from(Paint::Color(Rgb::BLACK));
    let (floor, ceiling) = (floor.unwrap_or(plain), ceiling.unwrap_or(Ceiling::Covered(plain)));
    let mut face = |surface: &Option<Surface<'_>>| textures.paint(surface.as_ref()?, faults);
    let faces = Faces { riser: face(&definitions.riser), lintel: face(&definitions.lintel) };
    let map_ceiling = definitions.ceiling_height;
    let ground = Tile {
        character: '.',
        kind: TileKind::Open,
        floor,
        ceiling,
        light: definitions.light,
        heights: Heights::new(0.0, map_ceiling, map_ceiling)?,
        riser: faces.riser(floor),
        lintel: faces.lintel(floor, ceiling),
    };
    let (legend, textures_mut) = (&definitions.legend, &mut textures);
    let layout = Layout::of(&drawing, legend, ground, faces, textures_mut, faults)?;
    Some(Level::from(World::from_parts(Parts {
        title: definitions.title,
        goal: definitions.goal,
        grid: layout.grid,
        tiles: layout.tiles,
        textures: textures.into_list(),
        floor: ground.floor,
        ceiling: ground.ceiling,
        sky: sky.unwrap_or_else(|| Some(Sky::default()))?,
        fog: definitions.fog,
        start: layout.start,
        lamplight: layout.lamplight,
        sprites: layout.sprites,
        things: layout.things,
        keys: layout.keys,
    })))
}

/// The rows of the grid that the map `text` draws, from the north; none where it draws none.
pub(crate) fn rows_of_grid(text: &str) -> Vec<String> {
    let document = document::parse(text, &mut Vec::new());
    let grid = document::entries(&document).find(|entry| entry.key == "grid");
    let drawn = grid.and_then(|entry| entry.string("", &mut Vec::new()));
    drawn.unwrap_or_default().lines().map(str::to_owned).collect()
}

/// Adds the places that are not TOML to `faults`, and drops what was found in the same lines: the
/// table holds a guess at what they mean.
fn keep_apart(faults: &mut Vec<Fault>, not_toml: Vec<Fault>, text: &str) {
    let line_ends: Vec<_> = text.match_indices('\n').map(|(at, _)| at).collect();
    let line = |fault: &Fault| line_ends.partition_point(|&end| end < fault.start());
    let broken: BTreeSet<_> = not_toml.iter().map(line).collect();
    faults.retain(|fault| !broken.contains(&line(fault)));
    faults.extend(not_toml);
}

fn no_grid() -> Fault {
    Fault::new(0..0, "the map has no grid")
        .label("a grid is missing")
        .help("draw it before [tiles]: grid = ''' on a line, the rows, and ''' again")
}
