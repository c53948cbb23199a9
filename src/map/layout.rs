//! The layout: the drawing with the meanings of its characters.

use std::collections::BTreeSet;
use std::ops::Range;

use super::doors::{self, Keys};
use super::drawing::Drawing;
use super::heights::Faces;
use super::legend::{Legend, Meaning, Surroundings, Symbol};
use super::per_character::PerCharacter;
use super::reader::Reader;
use super::supports;
use super::textures::Surface;
use crate::fault::Fault;
use crate::world::sprite::builtin;
use crate::world::{
    Door, Grid, Heights, Paint, Sprite, SpriteId, Start, Thing, ThingKind, Tile, TileId, TileKind,
};

/// The largest number of kinds of tile, the map's own floor included.
const MAX_TILES: usize = 255;

/// The contents of a drawing.
pub(super) struct Layout {
    pub(super) grid: Grid,
    /// The map's own floor, then other open floor and doorways, then solid tiles, each in the order
    /// of their characters.
    pub(super) tiles: Vec<Tile>,
    pub(super) start: Start,
    pub(super) sprites: Vec<Sprite>,
    pub(super) things: Vec<Thing>,
    /// The names of the keys.
    pub(super) keys: Vec<String>,
}

impl Layout {
    /// The contents of `drawing`, in a map whose open floor is `ground`. Reports faults,
    /// and returns `None` if the map has any.
    pub(super) fn of(
        drawing: &Drawing<'_>,
        legend: &Legend<'_>,
        ground: Tile,
        faces: Faces,
        reader: &mut Reader<'_>,
    ) -> Option<Self> {
        reader.faults.extend(undefined_characters(drawing, legend));
        reader.faults.extend(wrong_start(drawing, legend));
        reader.faults.extend(supports::faults(drawing, legend));
        let keys = Keys::of(drawing, legend);
        let tiles = tiles(drawing, legend, &keys, ground, faces, reader);
        if !reader.faults.is_empty() {
            return None;
        }
        let start = start(drawing, legend)?;
        let mut grid = grid(drawing, legend, &tiles)?;
        reader.faults.extend(supports::low_start(drawing, &grid, &tiles, start));
        let (things, sprites) = things(drawing, legend, &keys, reader);
        let blocks = |thing: &&Thing| sprites[usize::from(thing.sprite.0)].blocks;
        things.iter().filter(blocks).for_each(|thing| grid.occupy(thing.cell));
        let low_things = supports::low_things(&grid, &tiles, &sprites, &things);
        reader.faults.extend(doors::faults(drawing, legend, &grid, &tiles, start, &low_things));
        if !reader.faults.is_empty() {
            return None;
        }
        let keys = keys.into_names();
        Some(Self { grid, tiles, start, sprites, things, keys })
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

/// The things in the drawing except the start, and their sprites.
fn things(
    drawing: &Drawing<'_>,
    legend: &Legend<'_>,
    keys: &Keys,
    reader: &mut Reader<'_>,
) -> (Vec<Thing>, Vec<Sprite>) {
    let (mut things, mut sprites) = (Vec::new(), Vec::new());
    for (character, _) in drawing.characters() {
        let Some(symbol) = legend.symbols.get(&character) else { continue };
        let of_kind = match &symbol.meaning {
            Meaning::Exit => Some(ThingKind::Exit).zip(builtin::named(builtin::EXIT)),
            Meaning::Key(key) => {
                keys.id(key.name).map(ThingKind::Key).zip(builtin::named(builtin::KEY))
            }
            Meaning::Ornament(sprite) => Some(ThingKind::Ornament).zip(sprite.sprite(reader)),
            _ => None,
        };
        if let Some((kind, look)) = of_kind {
            // There is at most one for each character, far fewer than 65,536.
            let sprite = SpriteId(sprites.len() as u16);
            sprites.push(look);
            things.extend(drawing.cells_of(character).map(|cell| Thing {
                kind,
                cell,
                sprite,
                frame: None,
            }));
        }
    }
    (things, sprites)
}

/// The kinds of tile in the drawing, open ones first. The first is `ground`, the map's own floor.
fn tiles(
    drawing: &Drawing<'_>,
    legend: &Legend<'_>,
    keys: &Keys,
    ground: Tile,
    faces: Faces,
    reader: &mut Reader<'_>,
) -> Vec<Tile> {
    let mut open = vec![ground];
    let mut solid = Vec::new();
    let drawn = drawing.characters().map(|(character, _)| character);
    let stood_on = supports::of(drawing, legend).map(|(_, support)| support.tile);
    for character in drawn.chain(stood_on).collect::<BTreeSet<char>>() {
        let Some(symbol) = legend.symbols.get(&character) else { continue };
        if let Meaning::Floor = symbol.meaning {
            open.extend(tile(character, TileKind::Open, symbol, ground, faces, reader));
        } else if let Some(kind) = solid_kind(&symbol.meaning, keys, reader) {
            let tile = tile(character, kind, symbol, ground, faces, reader);
            if let TileKind::Door(door) = kind {
                open.extend(tile.map(|tile| Tile { kind: TileKind::Doorway(door), ..tile }));
            }
            solid.extend(tile);
        }
        if open.len() + solid.len() > MAX_TILES {
            let message = format!("the grid has more than {} kinds of tile", MAX_TILES - 1);
            reader.faults.push(Fault::new(symbol.place.clone(), message).label("one too many"));
            break;
        }
    }
    open.extend(solid);
    open
}

/// A tile with what `symbol` defines, and otherwise like `ground`.
fn tile(
    character: char,
    kind: TileKind,
    symbol: &Symbol<'_>,
    ground: Tile,
    faces: Faces,
    reader: &mut Reader<'_>,
) -> Option<Tile> {
    let Surroundings { floor, ceiling, light, heights } = &symbol.surroundings;
    let faults_before = reader.faults.len();
    let map_ceiling = ground.heights.ceiling();
    let floor = floor.as_ref().and_then(|floor| floor.covering(reader));
    let ceiling = ceiling.as_ref().and_then(|ceiling| ceiling.ceiling(reader));
    let (floor, ceiling) = (floor.unwrap_or(ground.floor), ceiling.unwrap_or(ground.ceiling));
    let mut face = |surface: &Option<Surface<'_>>, otherwise: Paint| {
        surface.as_ref().and_then(|it| reader.paint(it)).unwrap_or(otherwise)
    };
    let riser = match kind {
        TileKind::Wall(paint) => paint,
        TileKind::Mirror(tint) => Paint::Color(tint.color),
        _ => face(&heights.riser, faces.riser(floor)),
    };
    let lintel = face(&heights.lintel, faces.lintel(floor, ceiling));
    if reader.faults.len() > faults_before {
        return None;
    }
    let heights = match &symbol.meaning {
        Meaning::Wall(_, height) | Meaning::Mirror(_, height) => {
            Heights::new(height.unwrap_or(map_ceiling), map_ceiling, map_ceiling)?
        }
        _ => heights.heights(ceiling, map_ceiling, reader)?,
    };
    let light = match kind {
        // A wall without a light is as bright as the floor that it is seen from.
        TileKind::Wall(_) => *light,
        _ => light.or(ground.light),
    };
    Some(Tile { character, kind, floor, ceiling, light, heights, riser, lintel, effect: None })
}

/// The solid tile that a character means; `None` if it means another thing, or has a fault.
fn solid_kind(meaning: &Meaning<'_>, keys: &Keys, reader: &mut Reader<'_>) -> Option<TileKind> {
    match meaning {
        Meaning::Wall(surface, _) => reader.paint(surface).map(TileKind::Wall),
        Meaning::Door(door) => Some(TileKind::Door(Door {
            leaf: reader.paint(&door.leaf)?,
            jamb: reader.jamb(),
            key: door.key.as_ref().and_then(|key| keys.id(key.name)),
            switch: None,
        })),
        Meaning::Mask(mask) => mask.texture(reader).map(TileKind::Mask),
        Meaning::Glass(glass) => Some(TileKind::Glass(*glass)),
        Meaning::Mirror(tint, _) => Some(TileKind::Mirror(*tint)),
        Meaning::Shape(shape) => shape.shape(reader).map(TileKind::Shape),
        Meaning::Open
        | Meaning::Floor
        | Meaning::Start(_)
        | Meaning::Exit
        | Meaning::Key(_)
        | Meaning::Ornament(_)
        | Meaning::Unclear => None,
    }
}

/// The grid of a drawing whose tiles are all in `tiles`. Doors are closed.
fn grid(drawing: &Drawing<'_>, legend: &Legend<'_>, tiles: &[Tile]) -> Option<Grid> {
    let mut tile_of = PerCharacter::<u8>::new();
    let is_open = |tile: &Tile| matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
    let first_solid = tiles.iter().take_while(|tile| is_open(tile)).count();
    for (tile, id) in tiles.iter().zip(0..) {
        *tile_of.get_mut(tile.character) = id;
    }
    for (thing, support) in supports::of(drawing, legend) {
        *tile_of.get_mut(thing) = tile_of.get(support.tile);
    }
    let (width, height) = (drawing.width, drawing.height);
    let mut cells = Vec::with_capacity(width.get() as usize * height.get() as usize);
    for row in drawing.rows() {
        cells.extend(row.chars().map(|character| TileId(tile_of.get(character))));
    }
    Grid::new(width, height, TileId(first_solid as u8), cells)
}
