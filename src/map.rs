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
//! A map is read in stages: the TOML, the definitions of the characters, the grid, and the textures
//! that the grid uses. Each stage adds its faults to one list. A stage uses the results of earlier
//! stages, and reports nothing that follows from an earlier fault.
//!
//! Rows of unequal length are a fault. Rejected: padding short rows. A lost character would
//! silently move half a wall.

mod art;
pub mod builtin;
mod checks;
mod definitions;
mod drawing;
#[cfg(feature = "cli")]
pub mod edit;
mod files;
mod keys;
mod legend;
mod picture;
mod plan;
mod reach;
mod scene;
mod surfaces;
mod textures;
mod things;
#[cfg(feature = "cli")]
pub mod tiled;
mod tiles;
mod values;

use std::io::Read;
use std::path::Path;

use crate::color::Rgb;
use crate::fault::document::FaultList;
use crate::fault::{Fault, Faults, document};
use crate::world::scene::Scene;
use crate::world::{
    Ceiling, Covering, Grid, Heights, Mission, Paint, Parts, Sky, Start, Tile, TileId, TileKind,
    World,
};
pub use art::{ArtError, replace_art};
use checks::Cells;
use definitions::Definitions;
pub use drawing::MAX_SIDE;
use drawing::{Drawing, PerCharacter};
pub use files::{Folder, MAX_BYTES, NoFiles, TextureFileError, TextureFiles};
use files::{open, read_text, too_large};
use legend::Meaning;
use plan::{Names, Plan};
use textures::{SurfaceText, Textures};
use things::ThingList;
use tiles::{Common, Faces, TileList};

const DEFAULT_CEILING: Rgb = Rgb::new(0x30, 0x30, 0x30);
const DEFAULT_FLOOR: Rgb = Rgb::new(0x58, 0x58, 0x58);

/// The level that a map describes.
#[derive(Clone, Debug, PartialEq)]
pub enum Level {
    /// A grid of tiles.
    Grid(Box<World>),
    /// Spheres, planes and boxes.
    Space(Scene),
}

/// Parses `text`, a map with a grid, into a world.
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
/// All faults of the map. A map of bodies is a fault too, because it has no grid.
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
/// All faults of the map, in which it is called `map`.
pub fn parse_str(text: &str) -> Result<World, Faults> {
    parse(text, "map", &NoFiles)
}

/// Reads the map file at `path`, which must have a grid. Textures that are not built in are files
/// in its folder or below it.
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
/// The same as for [`load_level`].
pub fn load_level_with(path: &Path, files: &dyn TextureFiles) -> Result<Level, Faults> {
    parse_level(&text_of_file(path)?, &path.display().to_string(), files)
}

/// The text of the map file at `path`.
///
/// # Errors
/// The reason why the file cannot be read.
pub(crate) fn text_of_file(path: &Path) -> Result<String, Faults> {
    let name = path.display().to_string();
    read_text(open(path, &name)?, &name)
}

/// Reads a map of either kind from `input`, which may have up to [`MAX_BYTES`].
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
                let message = format!("{name} is a map of bodies and has no grid");
                Err(Faults::of_whole_file(name, &message, "name a map with a grid"))
            }
        }
    }
}

/// Reads the level that `text` describes. If `text` is not a map, adds the reasons to `faults`.
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
    let mut textures = Textures::new(faults, files);
    let plain = |color| Some(Covering::from(Paint::Color(color)));
    let floor = match &definitions.floor {
        Some(floor) => floor.covering(&mut textures),
        None => plain(DEFAULT_FLOOR),
    };
    let ceiling = match &definitions.ceiling {
        Some(ceiling) => ceiling.ceiling(&mut textures),
        None => plain(DEFAULT_CEILING).map(Ceiling::Covered),
    };
    let sky = match &definitions.sky {
        Some(sky) => sky.sky(&mut textures),
        None => Some(Sky::default()),
    };
    let Some(grid) = &definitions.grid else {
        faults.push(no_grid());
        return None;
    };
    let drawing = Drawing::read(grid, text)?;
    // If one of the two has a fault, the tiles would only cause further faults.
    let black = Covering::from(Paint::Color(Rgb::BLACK));
    let (floor, ceiling) = (floor.unwrap_or(black), ceiling.unwrap_or(Ceiling::Covered(black)));
    let mut face = |surface: &Option<SurfaceText<'_>>| textures.paint(surface.as_ref()?);
    let faces = Faces { riser: face(&definitions.riser), lintel: face(&definitions.lintel) };
    let map_ceiling = definitions.ceiling_height.unwrap_or(Heights::LEVEL.ceiling());
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
    let plan = Plan { drawing: &drawing, legend: &definitions.legend };
    faults.extend(checks::faults_of_characters(plan));
    let (keys, switches) = (Names::of(plan.locks()), Names::of(plan.driven()));
    let common = Common { ground, faces, keys: &keys, switches: &switches };
    let tile_list = TileList::of(plan, &common, &mut textures);
    if !faults.is_empty() {
        return None;
    }
    let start = start(plan)?;
    let mut grid = draw(plan, &tile_list)?;
    let TileList { tiles, moving, .. } = tile_list;
    let ThingList { things, sprites, notes, .. } =
        ThingList::of(plan, &keys, &switches, &mut textures);
    for thing in things.iter().filter(|thing| sprites[usize::from(thing.sprite.0)].blocks) {
        grid.occupy(thing.cell);
    }
    let guards = things::posts(plan);
    let cells =
        Cells { grid: &grid, tiles: &tiles, moving: &moving, sprites: &sprites, things: &things };
    faults.extend(checks::faults_of_cells(plan, cells, start, &guards));
    if !faults.is_empty() {
        return None;
    }
    let treasure_needed = definitions.treasure_needed;
    if let Some((needed, place)) = &treasure_needed {
        faults.extend(checks::missing_treasure(*needed, place, &things));
    }
    let mission = Mission {
        par: definitions.par,
        treasure_needed: treasure_needed.map_or(0, |(worth, _)| worth),
        notes,
        switches: switches.to_strings(),
        moving_tiles: moving,
        guards,
    };
    Some(Level::from(World::from_parts(Parts {
        title: definitions.title,
        goal: definitions.goal,
        grid,
        tiles,
        textures: textures.into_list(),
        floor,
        ceiling,
        sky: sky?,
        fog: definitions.fog,
        start,
        sprites,
        things,
        keys: keys.to_strings(),
        mission,
    })))
}

/// The start of a plan that has exactly one.
fn start(plan: Plan<'_>) -> Option<Start> {
    let is_start = |meaning: &Meaning<'_>| matches!(meaning, Meaning::Start(_));
    let (cell, character) = plan.drawing.cells_of(|it| plan.means(it, is_start)).next()?;
    match plan.symbol(character)?.meaning {
        Meaning::Start(heading) => Some(Start { cell, heading }),
        _ => None,
    }
}

/// The grid of a plan whose tiles are in `tiles`. Doors are closed.
fn draw(plan: Plan<'_>, tiles: &TileList) -> Option<Grid> {
    let drawing = plan.drawing;
    let tile_of: PerCharacter<u8> = drawing
        .characters()
        .map(|character| {
            let support = plan.symbol(character).and_then(|symbol| symbol.support.as_ref());
            (character, tiles.drawn.get(support.map_or(character, |&(tile, _)| tile)))
        })
        .collect();
    let (width, height) = (drawing.width, drawing.height);
    let mut cells = Vec::with_capacity(width.get() as usize * height.get() as usize);
    for row in drawing.rows() {
        cells.extend(row.chars().map(|character| TileId(tile_of.get(character))));
    }
    Grid::new(width, height, tiles.first_solid, cells)
}

/// The rows of the grid in the map `text`, from north to south. Empty if the map has no grid.
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

#[cfg(test)]
mod tests;
