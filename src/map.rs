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
//! Reading has stages: the TOML, the definitions of the characters, the grid, and the textures that
//! the grid uses. Each stage adds its faults to one list. A stage uses what the earlier ones could
//! read, and reports nothing that follows from an earlier fault.
//!
//! Rows of unequal length are a fault. Padding short rows was refused: a lost character would
//! silently move half a wall.

mod air;
pub mod builtin;
mod checks;
mod covering;
mod definitions;
mod doors;
mod drawing;
mod guards;
mod heights;
mod input;
mod items;
mod lamp_budget;
mod layout;
mod legend;
mod mechanisms;
mod per_character;
mod picture;
mod reader;
mod scene;
mod see_through;
mod shapes;
mod sprites;
mod supports;
mod switches;
mod textures;
mod things;
mod tiles;

use std::io::Read;
use std::path::Path;

use crate::color::Rgb;
use crate::fault::document::FaultList;
use crate::fault::{Fault, Faults, document};
use crate::space::Scene;
use crate::world::{Ceiling, Covering, Heights, Mission, Paint, Parts, Sky, Tile, TileKind, World};
use definitions::Definitions;
use drawing::Drawing;
use heights::Faces;
use input::{open, read_text, too_large};
use layout::Layout;
use reader::Reader;
use textures::Surface;
pub use textures::{Folder, NoFiles, TextureFileError, TextureFiles};

/// The largest map file, in bytes: room for the largest grid in characters of three bytes.
pub const MAX_BYTES: usize = 64 << 20;
/// The largest number of columns, and of rows, of a grid.
pub const MAX_SIDE: u32 = 4096;

/// What a map describes.
#[derive(Clone, Debug, PartialEq)]
pub enum Level {
    /// A grid of tiles.
    Grid(Box<World>),
    /// Spheres, planes and boxes.
    Space(Scene),
}

/// Parses the map `text` with a grid into a world.
///
/// Faults call the map `name`. Textures that are not built in come from `files`.
///
/// ```
/// use cellcaster::map::{self, NoFiles};
///
/// let text = r#"
/// grid = '''
/// %%%%
/// %@.%
/// %%%%
/// '''
/// [tiles]
/// "%" = { wall = "brick" }
/// [things]
/// "@" = { start = 0 }
/// "#;
/// let world = map::parse(text, "tiny", &NoFiles).unwrap();
/// assert_eq!((world.grid().width(), world.grid().height()), (4, 3));
///
/// // A character without a definition is a fault.
/// let faults = map::parse(&text.replace('.', "?"), "tiny", &NoFiles).unwrap_err();
/// assert!(faults.to_string().contains("tiny"));
/// ```
///
/// # Errors
/// All faults of the map. A map of bodies, which has no grid, is a fault.
pub fn parse(text: &str, name: &str, files: &dyn TextureFiles) -> Result<World, Faults> {
    parse_level(text, name, files)?.into_world(name)
}

/// Parses a map of either kind, as [`parse`] does.
///
/// # Errors
/// All faults of the map.
pub fn parse_level(text: &str, name: &str, files: &dyn TextureFiles) -> Result<Level, Faults> {
    if text.len() > MAX_BYTES {
        return Err(too_large(name));
    }
    let faults = FaultList::default();
    match read(text, files, &faults) {
        Some(level) if faults.is_empty() => Ok(level),
        _ => Err(Faults::new(name, text, faults.take())),
    }
}

/// Parses a map that uses built-in textures only, as [`parse`] does.
///
/// # Errors
/// All faults of the map, which they call `map`.
pub fn parse_str(text: &str) -> Result<World, Faults> {
    parse(text, "map", &NoFiles)
}

/// Reads the map file at `path`, which has a grid. Textures that are not built in are files in its
/// folder or below it.
///
/// # Errors
/// All faults of the map, or the reason why the file cannot be read.
pub fn load(path: &Path) -> Result<World, Faults> {
    load_level(path)?.into_world(&path.display().to_string())
}

/// Reads a map file of either kind, as [`load`] does.
///
/// # Errors
/// All faults of the map, or the reason why the file cannot be read.
pub fn load_level(path: &Path) -> Result<Level, Faults> {
    load_level_with(path, &Folder::of(path))
}

/// Reads a map file as [`load_level`] does, with textures from `files`.
///
/// # Errors
/// As [`load_level`].
pub fn load_level_with(path: &Path, files: &dyn TextureFiles) -> Result<Level, Faults> {
    let name = path.display().to_string();
    read_level(open(path, &name)?, &name, files)
}

/// Reads a map of either kind from `input`, at most [`MAX_BYTES`] of it.
///
/// Faults call the map `name`. Textures that are not built in come from `files`.
///
/// # Errors
/// All faults of the map, or the reason why it cannot be read.
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
                Err(Faults::of_whole_file(name, &message, "name a map with a grid"))
            }
        }
    }
}

/// The level that `text` describes. Where it is not a map, adds that to `faults`.
fn read(text: &str, files: &dyn TextureFiles, faults: &FaultList) -> Option<Level> {
    let document = document::parse(text, faults);
    let not_toml = faults.take();
    if scene::has_bodies(&document) {
        let scene = scene::read(&document, faults);
        faults.extend_by_broken_lines(not_toml, text);
        return scene.map(Level::Space);
    }
    let definitions = Definitions::read(&document, faults);
    if !not_toml.is_empty() {
        faults.extend_by_broken_lines(not_toml, text);
        return None;
    }
    let mut reader = Reader::new(text, faults, files);
    let floor = definitions.floor.covering(&mut reader);
    let ceiling = definitions.ceiling.ceiling(&mut reader);
    let sky = definitions.sky.as_ref().map(|sky| sky.sky(&mut reader));
    let Some(grid) = &definitions.grid else {
        faults.push(no_grid());
        return None;
    };
    let drawing = Drawing::read(grid, reader.text)?;
    // After a fault in one of the two, tiles would only cause further faults.
    let plain = Covering::from(Paint::Color(Rgb::BLACK));
    let (floor, ceiling) = (floor.unwrap_or(plain), ceiling.unwrap_or(Ceiling::Covered(plain)));
    let mut face = |surface: &Option<Surface<'_>>| reader.paint(surface.as_ref()?);
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
        effect: None,
    };
    let layout = Layout::of(&drawing, &definitions.legend, ground, faces, &mut reader)?;
    if let Some((needed, place)) = &definitions.treasure_needed {
        reader.faults.extend(checks::missing_treasure(*needed, place, &layout.things));
    }
    Some(Level::from(World::from_parts(Parts {
        title: definitions.title,
        goal: definitions.goal,
        grid: layout.grid,
        tiles: layout.tiles,
        textures: reader.textures.into_list(),
        floor: ground.floor,
        ceiling: ground.ceiling,
        sky: sky.unwrap_or_else(|| Some(Sky::default()))?,
        fog: definitions.fog,
        start: layout.start,
        sprites: layout.sprites,
        things: layout.things,
        keys: layout.keys,
        mission: Mission {
            par: definitions.par,
            treasure_needed: definitions.treasure_needed.map_or(0, |(worth, _)| worth),
            ..layout.mission
        },
    })))
}

/// The rows of the grid that the map `text` draws, from the north; none if it has no grid.
pub(crate) fn rows_of_grid(text: &str) -> Vec<String> {
    let faults = FaultList::default();
    let document = document::parse(text, &faults);
    let grid = document::entries(&document, &faults).find(|entry| entry.key == "grid");
    let drawn = grid.and_then(|entry| entry.string(""));
    drawn.unwrap_or_default().lines().map(str::to_owned).collect()
}

fn no_grid() -> Fault {
    Fault::new(0..0, "the map has no grid")
        .label("a grid is missing")
        .help("draw it before [tiles]: grid = ''' on a line, the rows, and ''' again")
}
