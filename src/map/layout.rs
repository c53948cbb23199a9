//! The layout: what the drawing shows, by the definitions of its characters.

use std::ops::Range;

use super::drawing::Drawing;
use super::legend::{Legend, Meaning, Surroundings, Symbol};
use super::per_character::PerCharacter;
use super::textures::Textures;
use crate::fault::Fault;
use crate::world::{Grid, Start, Thing, ThingKind, Tile, TileId, TileKind};

/// The most kinds of tile in a grid, open floor among them.
const MAX_TILES: usize = 255;

/// What a drawing shows.
pub(super) struct Layout {
    pub(super) grid: Grid,
    /// The map's own open floor, then other open floor and then the walls that the grid has, each in
    /// the order of their characters.
    pub(super) tiles: Vec<Tile>,
    pub(super) start: Start,
    pub(super) things: Vec<Thing>,
}

impl Layout {
    /// What `drawing` shows, on open floor like `ground`. `None` where anything is wrong with the map; what is wrong with this
    /// part of it is added to `faults`.
    pub(super) fn of(
        drawing: &Drawing<'_>,
        legend: &Legend<'_>,
        ground: Tile,
        textures: &mut Textures<'_>,
        faults: &mut Vec<Fault>,
    ) -> Option<Self> {
        faults.extend(undefined_characters(drawing, legend));
        faults.extend(wrong_start(drawing, legend));
        let tiles = tiles(drawing, legend, ground, textures, faults);
        if !faults.is_empty() {
            return None;
        }
        let start = start(drawing, legend)?;
        let things = exits(drawing, legend).collect();
        let first_solid = TileId(tiles.open.len() as u8);
        let tiles = [tiles.open, tiles.walls].concat();
        Some(Self { grid: grid(drawing, &tiles, first_solid)?, tiles, start, things })
    }
}

fn undefined_characters(drawing: &Drawing<'_>, legend: &Legend<'_>) -> impl Iterator<Item = Fault> {
    let is_undefined =
        |character: &char| legend.is_complete && !legend.symbols.contains_key(character);
    let undefined = drawing.characters().filter(move |(character, _)| is_undefined(character));
    undefined.filter_map(|(character, sightings)| {
        let &first = sightings.first_places().first()?;
        let place = drawing.place(character, first);
        let fault = if character.is_control() {
            let message = format!("the grid has the control character {character:?} in it");
            Fault::new(place, message).help("draw open floor as '.' or a space")
        } else {
            let message = format!("the grid's character {character:?} is not defined");
            Fault::new(place, message).help(format!(
                "define it under [tiles], such as {:?} = {{ wall = \"brick\" }}, or under [things]",
                character.to_string()
            ))
        };
        Some(match sightings.count - 1 {
            0 => fault,
            others => fault.label(format!("and {others} more")),
        })
    })
}

/// The fault that the player starts nowhere, or in several places.
fn wrong_start(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Option<Fault> {
    let mut drawn: Vec<_> = starts(legend)
        .flat_map(|(character, _)| {
            let sightings = drawing.sightings(character);
            sightings.first_places().iter().map(move |&at| (at, character)).collect::<Vec<_>>()
        })
        .collect();
    drawn.sort_unstable();
    match drawn[..] {
        [] => no_start(drawing, legend),
        [_] => None,
        [_, (at, character), ..] => Some(
            Fault::new(drawing.place(character, at), "the player starts in more than one place")
                .label("this is the second")
                .help("leave one start, and draw the others as '.'"),
        ),
    }
}

fn starts(legend: &Legend<'_>) -> impl Iterator<Item = (char, Range<usize>)> {
    let is_start = |symbol: &Symbol<'_>| matches!(symbol.meaning, Meaning::Start(_));
    let starts = legend.symbols.iter().filter(move |(_, symbol)| is_start(symbol));
    starts.map(|(&character, symbol)| (character, symbol.place.clone()))
}

/// The fault that the grid has no start; `None` where a fault already found may be the cause.
fn no_start(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Option<Fault> {
    if let Some((character, place)) = starts(legend).next() {
        let message = format!("the start {character:?} is not drawn in the grid");
        let help = format!("draw one {character:?} where the player starts");
        return Some(Fault::new(place, message).help(help));
    }
    let message = "the player starts nowhere in the grid";
    let help = "under [things] write \"@\" = { start = 0 }, and draw one @ in the grid";
    legend.is_clear().then(|| Fault::new(drawing.key_place.clone(), message).help(help))
}

/// Where the player of a drawing that has one start starts.
fn start(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Option<Start> {
    let (character, heading) = drawing.characters().find_map(|(character, _)| {
        match legend.symbols.get(&character)?.meaning {
            Meaning::Start(heading) => Some((character, heading)),
            _ => None,
        }
    })?;
    let cell = drawing.cells_of(character).next()?;
    Some(Start { cell, heading })
}

fn exits(drawing: &Drawing<'_>, legend: &Legend<'_>) -> impl Iterator<Item = Thing> {
    let is_exit = |symbol: &Symbol<'_>| matches!(symbol.meaning, Meaning::Exit);
    let exits = legend.symbols.iter().filter(move |(_, symbol)| is_exit(symbol));
    let drawn = exits.filter(|&(&character, _)| drawing.sightings(character).count > 0);
    drawn
        .flat_map(|(&character, _)| drawing.cells_of(character))
        .map(|cell| Thing { kind: ThingKind::Exit, cell })
}

/// The kinds of tile in the drawing, open ones first; `ground` is the map's own.
fn tiles(
    drawing: &Drawing<'_>,
    legend: &Legend<'_>,
    ground: Tile,
    textures: &mut Textures<'_>,
    faults: &mut Vec<Fault>,
) -> Tiles {
    let mut tiles = Tiles { open: vec![ground], walls: Vec::new() };
    for (character, _) in drawing.characters() {
        let Some(symbol) = legend.symbols.get(&character) else { continue };
        if !matches!(symbol.meaning, Meaning::Wall(..) | Meaning::Floor(_)) {
            continue;
        }
        if tiles.len() == MAX_TILES {
            let message = format!("the grid has more than {} kinds of tile", MAX_TILES - 1);
            faults.push(Fault::new(symbol.place.clone(), message).label("one too many"));
            break;
        }
        match &symbol.meaning {
            Meaning::Wall(surface, light) => {
                let paint = textures.paint(surface, faults);
                tiles.walls.extend(paint.map(|paint| Tile {
                    character,
                    kind: TileKind::Wall(paint),
                    light: *light,
                    ..ground
                }));
            }
            Meaning::Floor(Surroundings { floor, ceiling, light }) => {
                let floor = floor.as_ref().and_then(|floor| floor.covering(textures, faults));
                let ceiling =
                    ceiling.as_ref().and_then(|ceiling| ceiling.ceiling(textures, faults));
                tiles.open.push(Tile {
                    character,
                    kind: TileKind::Open,
                    floor: floor.unwrap_or(ground.floor),
                    ceiling: ceiling.unwrap_or(ground.ceiling),
                    light: *light,
                });
            }
            _ => {}
        }
    }
    tiles
}

/// Kinds of tile, open ones and solid ones apart.
struct Tiles {
    open: Vec<Tile>,
    walls: Vec<Tile>,
}

impl Tiles {
    fn len(&self) -> usize {
        self.open.len() + self.walls.len()
    }
}

/// The grid of a drawing whose tiles are all in `tiles`, which are solid from `first_solid` on.
fn grid(drawing: &Drawing<'_>, tiles: &[Tile], first_solid: TileId) -> Option<Grid> {
    let mut tile_of = PerCharacter::<u8>::new();
    for (tile, id) in tiles.iter().zip(0..) {
        *tile_of.get_mut(tile.character) = id;
    }
    let (width, height) = (drawing.width, drawing.height);
    let mut cells = Vec::with_capacity(width.get() as usize * height.get() as usize);
    for row in drawing.rows() {
        cells.extend(row.chars().map(|character| TileId(tile_of.get(character))));
    }
    Grid::new(width, height, first_solid, cells)
}
