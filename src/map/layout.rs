//! The layout: what the drawing shows, by the definitions of its characters.

use std::ops::Range;

use super::drawing::Drawing;
use super::legend::{Legend, Meaning, Symbol};
use super::per_character::PerCharacter;
use super::textures::Textures;
use crate::fault::Fault;
use crate::world::{Grid, Start, Thing, ThingKind, Tile, TileId, TileKind};

/// The most kinds of tile in a grid, open floor among them.
const MAX_TILES: usize = 255;
const OPEN: Tile = Tile { character: '.', kind: TileKind::Open };
const OPEN_TILES: u8 = 1;

/// What a drawing shows.
pub(super) struct Layout {
    pub(super) grid: Grid,
    /// Open floor, then the walls that the grid has, in the order of their characters.
    pub(super) tiles: Vec<Tile>,
    pub(super) start: Start,
    pub(super) things: Vec<Thing>,
}

impl Layout {
    /// What `drawing` shows. `None` where anything is wrong with the map; what is wrong with this
    /// part of it is added to `faults`.
    pub(super) fn of(
        drawing: &Drawing<'_>,
        legend: &Legend<'_>,
        textures: &mut Textures<'_>,
        faults: &mut Vec<Fault>,
    ) -> Option<Self> {
        faults.extend(undefined_characters(drawing, legend));
        faults.extend(wrong_start(drawing, legend));
        let tiles = tiles(drawing, legend, textures, faults);
        if !faults.is_empty() {
            return None;
        }
        let start = start(drawing, legend)?;
        let things = exits(drawing, legend).collect();
        Some(Self { grid: grid(drawing, &tiles)?, tiles, start, things })
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

/// The kinds of tile in the drawing.
fn tiles(
    drawing: &Drawing<'_>,
    legend: &Legend<'_>,
    textures: &mut Textures<'_>,
    faults: &mut Vec<Fault>,
) -> Vec<Tile> {
    let mut tiles = vec![OPEN];
    for (character, _) in drawing.characters() {
        let Some(symbol) = legend.symbols.get(&character) else { continue };
        let Meaning::Wall(surface) = &symbol.meaning else { continue };
        if tiles.len() == MAX_TILES {
            let message = format!("the grid has more than {} kinds of wall", MAX_TILES - 1);
            faults.push(Fault::new(symbol.place.clone(), message).label("one too many"));
            break;
        }
        if let Some(paint) = textures.paint(surface, faults) {
            tiles.push(Tile { character, kind: TileKind::Wall(paint) });
        }
    }
    tiles
}

/// The grid of a drawing whose walls are all in `tiles`.
fn grid(drawing: &Drawing<'_>, tiles: &[Tile]) -> Option<Grid> {
    let mut tile_of = PerCharacter::<u8>::new();
    for (tile, id) in tiles.iter().zip(0..) {
        *tile_of.get_mut(tile.character) = id;
    }
    let (width, height) = (drawing.width, drawing.height);
    let mut cells = Vec::with_capacity(width.get() as usize * height.get() as usize);
    for row in drawing.rows() {
        cells.extend(row.chars().map(|character| TileId(tile_of.get(character))));
    }
    Grid::new(width, height, TileId(OPEN_TILES), cells)
}
