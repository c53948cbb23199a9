//! The layout: the drawing with the meanings of its characters.

use std::ops::Range;

use super::checks::{self, Cells};
use super::doors::{self, Keys};
use super::drawing::Drawing;
use super::guards;
use super::heights::Faces;
use super::legend::{Legend, Meaning, Symbol};
use super::per_character::PerCharacter;
use super::reader::Reader;
use super::supports;
use super::switches::{self, Switches};
use super::things::ThingList;
use super::tiles::{Common, TileList};
use crate::fault::Fault;
use crate::world::{Grid, Mission, Sprite, Start, Thing, Tile, TileId};

/// The contents of a drawing.
pub(crate) struct Layout {
    pub(crate) grid: Grid,
    /// The kinds of tile, as in [`TileList`].
    pub(crate) tiles: Vec<Tile>,
    pub(crate) start: Start,
    pub(crate) sprites: Vec<Sprite>,
    pub(crate) things: Vec<Thing>,
    /// The names of the keys.
    pub(crate) keys: Vec<String>,
    /// What the level asks of the player, without what the whole map defines.
    pub(crate) mission: Mission,
}

impl Layout {
    /// The contents of `drawing`, in a map whose open floor is `ground`. Reports faults,
    /// and returns `None` if the map has any.
    pub(crate) fn of(
        drawing: &Drawing<'_>,
        legend: &Legend<'_>,
        ground: Tile,
        faces: Faces,
        reader: &mut Reader<'_>,
    ) -> Option<Self> {
        reader.faults.extend(undefined_characters(drawing, legend));
        reader.faults.extend(wrong_start(drawing, legend));
        reader.faults.extend(supports::faults(drawing, legend));
        reader.faults.extend(guards::faults(drawing, legend));
        reader.faults.extend(switches::faults(drawing, legend));
        let keys = Keys::of(drawing, legend);
        let switches = Switches::of(drawing, legend);
        let common = Common { ground, faces, keys: &keys, switches: &switches };
        let tile_list = TileList::of(drawing, legend, &common, reader);
        if !reader.faults.is_empty() {
            return None;
        }
        let start = start(drawing, legend)?;
        let mut grid = grid(drawing, legend, &tile_list)?;
        let TileList { tiles, moving, .. } = tile_list;
        reader.faults.extend(supports::low_start(drawing, &grid, &tiles, start));
        let ThingList { things, sprites, notes, .. } =
            ThingList::of(drawing, legend, &keys, &switches, reader);
        let blocks = |thing: &&Thing| sprites[usize::from(thing.sprite.0)].blocks;
        things.iter().filter(blocks).for_each(|thing| grid.occupy(thing.cell));
        let low_things = supports::low_things(&grid, &tiles, &sprites, &things);
        let cells = Cells { grid: &grid, tiles: &tiles, moving: &moving };
        let guards = guards::posts(drawing, legend);
        reader.faults.extend(checks::cramped_guards(drawing, &cells, &guards));
        reader.faults.extend(checks::blind_secrets(drawing, legend, &cells));
        reader.faults.extend(doors::faults(drawing, legend, &cells, start, &low_things));
        if !reader.faults.is_empty() {
            return None;
        }
        let mission = Mission {
            notes,
            switches: switches.into_names(),
            moving_tiles: moving,
            guards,
            ..Mission::default()
        };
        let keys = keys.into_names();
        Some(Self { grid, tiles, start, sprites, things, keys, mission })
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

/// The fault that there is no start, or more than one.
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

/// The fault that there is no start; `None` where an earlier fault may be the reason.
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

/// The start of a drawing that has exactly one.
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

/// The grid of a drawing whose tiles are in `tiles`. Doors are closed.
fn grid(drawing: &Drawing<'_>, legend: &Legend<'_>, tiles: &TileList) -> Option<Grid> {
    let mut tile_of = PerCharacter::<u8>::new();
    for (character, _) in drawing.characters() {
        *tile_of.get_mut(character) = tiles.drawn(character).0;
    }
    for (thing, support) in supports::of(drawing, legend) {
        *tile_of.get_mut(thing) = tiles.drawn(support.tile).0;
    }
    let (width, height) = (drawing.width, drawing.height);
    let mut cells = Vec::with_capacity(width.get() as usize * height.get() as usize);
    for row in drawing.rows() {
        cells.extend(row.chars().map(|character| TileId(tile_of.get(character))));
    }
    Grid::new(width, height, tiles.first_solid, cells)
}
