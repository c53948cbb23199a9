//! The kinds of tile in the drawing, with the states of those that move.

use std::collections::BTreeSet;

use super::doors::Keys;
use super::drawing::Drawing;
use super::heights::Faces;
use super::legend::{Legend, Meaning, Surroundings, Symbol};
use super::mechanisms::{self, FloorMechanism, MovingWallSymbol};
use super::per_character::PerCharacter;
use super::reader::Reader;
use super::supports;
use super::switches::{SwitchSymbol, Switches};
use super::textures::Surface;
use crate::fault::Fault;
use crate::sort;
use crate::world::{Door, Driver, Heights, MovingTile, Paint, Tile, TileEffect, TileId, TileKind};

/// The largest number of kinds of tile, the map's own floor and the states of moving tiles
/// included.
const MAX_TILES: usize = 255;

/// The kinds of tile that a grid refers to.
pub(crate) struct TileList {
    /// The map's own floor, then other open floor and doorways, then solid tiles, each in the order
    /// of their characters.
    pub(crate) tiles: Vec<Tile>,
    pub(crate) first_solid: TileId,
    pub(crate) moving: Vec<MovingTile>,
    /// The tile of each character; for other characters, the map's own floor.
    drawn: PerCharacter<u8>,
}

/// The definitions that tiles without their own surfaces use, and the names of keys and switches.
pub(crate) struct Common<'l> {
    /// The map's own floor.
    pub(crate) ground: Tile,
    pub(crate) faces: Faces,
    pub(crate) keys: &'l Keys,
    pub(crate) switches: &'l Switches,
}

impl TileList {
    /// The tiles of `drawing`. Reports their faults.
    pub(crate) fn of(
        drawing: &Drawing<'_>,
        legend: &Legend<'_>,
        common: &Common<'_>,
        reader: &mut Reader<'_>,
    ) -> Self {
        let mut builder = Builder::new(common);
        let drawn = drawing.characters().map(|(character, _)| character);
        let stood_on = supports::of(drawing, legend).map(|(_, support)| support.tile);
        for character in sort::gathered::<char, BTreeSet<char>>(drawn.chain(stood_on)) {
            let Some(symbol) = legend.symbols.get(&character) else { continue };
            builder.add(character, symbol, reader);
            if builder.count() > MAX_TILES {
                reader.faults.push(builder.one_too_many(symbol));
                break;
            }
        }
        builder.into_list()
    }

    /// The tile that `character` draws.
    pub(crate) fn drawn(&self, character: char) -> TileId {
        TileId(self.drawn.get(character))
    }
}

/// The place of a tile before the number of open tiles is known.
#[derive(Clone, Copy)]
enum Slot {
    Open(usize),
    Solid(usize),
}

/// Collects tiles, open and solid ones apart.
struct Builder<'l> {
    common: &'l Common<'l>,
    open: Vec<Tile>,
    solid: Vec<Tile>,
    drawn: Vec<(char, Slot)>,
    moving: Vec<(Vec<Slot>, Driver)>,
}

impl<'l> Builder<'l> {
    fn new(common: &'l Common<'l>) -> Self {
        let (solid, drawn, moving) = (Vec::new(), Vec::new(), Vec::new());
        Self { common, open: vec![common.ground], solid, drawn, moving }
    }

    fn count(&self) -> usize {
        self.open.len() + self.solid.len()
    }

    /// Adds the tiles of `character`; nothing if it has a fault or is no tile.
    fn add(&mut self, character: char, symbol: &Symbol<'_>, reader: &mut Reader<'_>) {
        let tile =
            |kind, reader: &mut Reader<'_>| tile(character, kind, symbol, self.common, reader);
        let drawn = match &symbol.meaning {
            Meaning::Floor => {
                tile(TileKind::Open, reader).and_then(|floor| self.add_floor(floor, symbol, reader))
            }
            Meaning::MovingWall(wall) => {
                let kind = reader.paint(&wall.surface).map(TileKind::Wall);
                kind.and_then(|kind| tile(kind, reader)).and_then(|it| self.add_wall(it, wall))
            }
            meaning => solid_kind(meaning, self.common, reader)
                .and_then(|kind| tile(kind, reader))
                .map(|tile| self.add_solid(tile)),
        };
        self.drawn.extend(drawn.map(|slot| (character, slot)));
    }

    fn add_solid(&mut self, tile: Tile) -> Slot {
        if let TileKind::Door(door) = tile.kind {
            self.push(Tile { kind: TileKind::Doorway(door), ..tile });
        }
        self.push(tile)
    }

    fn add_floor(&mut self, floor: Tile, symbol: &Symbol<'_>, reader: &Reader<'_>) -> Option<Slot> {
        let mechanism = &symbol.surroundings.mechanism;
        let floor = Tile { effect: self.effect(mechanism), ..floor };
        let (end, driver) = match (&mechanism.moves_to, &mechanism.crumbles) {
            (Some(end), _) => (end, Driver::Switch(self.switch(mechanism.switch.as_ref())?)),
            (None, Some(end)) => (end, Driver::Weight),
            (None, None) => return Some(self.push(floor)),
        };
        if let Some(fault) = mechanisms::end_fault(floor, end, driver == Driver::Weight) {
            reader.faults.push(fault);
            return None;
        }
        let states = mechanisms::floor_states(floor, end.cells);
        Some(self.add_moving([floor].into_iter().chain(states), driver))
    }

    fn add_wall(&mut self, wall: Tile, symbol: &MovingWallSymbol<'_>) -> Option<Slot> {
        let driver = match &symbol.switch {
            None => Driver::Hand,
            switch => Driver::Switch(self.switch(switch.as_ref())?),
        };
        let open = mechanisms::floor_of_wall(wall, self.common.ground);
        let states = [wall].into_iter().chain(mechanisms::wall_states(wall)).chain([open]);
        Some(self.add_moving(states, driver))
    }

    /// Adds a tile that moves through `states`; returns the first.
    fn add_moving(&mut self, states: impl Iterator<Item = Tile>, driver: Driver) -> Slot {
        let states: Vec<Slot> = states.map(|state| self.push(state)).collect();
        let first = states[0];
        self.moving.push((states, driver));
        first
    }

    fn push(&mut self, tile: Tile) -> Slot {
        let is_open = matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
        let (list, slot): (_, fn(usize) -> Slot) =
            if is_open { (&mut self.open, Slot::Open) } else { (&mut self.solid, Slot::Solid) };
        list.push(tile);
        slot(list.len() - 1)
    }

    fn switch(&self, symbol: Option<&SwitchSymbol<'_>>) -> Option<crate::world::SwitchId> {
        self.common.switches.id(symbol?.name)
    }

    fn effect(&self, mechanism: &FloorMechanism<'_>) -> Option<TileEffect> {
        let plate = mechanism.plate.as_ref();
        match self.switch(plate) {
            Some(switch) => Some(TileEffect::Plate(switch)),
            None => mechanism.is_water().then_some(TileEffect::Water),
        }
    }

    /// The fault of the definition with which there are more than [`MAX_TILES`].
    fn one_too_many(&self, symbol: &Symbol<'_>) -> Fault {
        let states: usize = self.moving.iter().map(|(states, _)| states.len()).sum();
        let most = MAX_TILES - 1;
        let fault = Fault::new(
            symbol.place.clone(),
            format!("the grid has more than {most} kinds of tile"),
        );
        let fault = fault.label("one too many");
        if states == 0 {
            return fault;
        }
        fault.help(format!(
            "{states} of them are heights of tiles that move, one for each eighth of a cell: let \
             them move less far"
        ))
    }

    fn into_list(self) -> TileList {
        let Self { open, solid, drawn, moving, .. } = self;
        let open_count = open.len();
        let id = |slot: Slot| match slot {
            Slot::Open(index) => TileId(index as u8),
            Slot::Solid(index) => TileId((open_count + index) as u8),
        };
        let mut tile_of = PerCharacter::<u8>::new();
        for (character, slot) in drawn {
            *tile_of.get_mut(character) = id(slot).0;
        }
        let moving = moving.into_iter().map(|(states, driver)| {
            let states = states.into_iter().map(id).collect();
            MovingTile { states, driver }
        });
        TileList {
            tiles: [open, solid].concat(),
            first_solid: TileId(open_count as u8),
            moving: moving.collect(),
            drawn: tile_of,
        }
    }
}

/// A tile with what `symbol` defines, and otherwise like the map's own floor.
fn tile(
    character: char,
    kind: TileKind,
    symbol: &Symbol<'_>,
    common: &Common<'_>,
    reader: &mut Reader<'_>,
) -> Option<Tile> {
    let Surroundings { floor, ceiling, light, heights, .. } = &symbol.surroundings;
    let &Common { ground, faces, .. } = common;
    let faults_before = reader.faults.len();
    let map_ceiling = ground.heights.ceiling();
    let usual_floor = symbol.surroundings.mechanism.usual_floor();
    let floor = floor.as_ref().or(usual_floor.as_ref()).and_then(|floor| floor.covering(reader));
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
        Meaning::Wall(_, height)
        | Meaning::Mirror(_, height)
        | Meaning::MovingWall(MovingWallSymbol { height, .. }) => {
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
fn solid_kind(
    meaning: &Meaning<'_>,
    common: &Common<'_>,
    reader: &mut Reader<'_>,
) -> Option<TileKind> {
    let Common { keys, switches, .. } = common;
    match meaning {
        Meaning::Wall(surface, _) => reader.paint(surface).map(TileKind::Wall),
        Meaning::Door(door) => Some(TileKind::Door(Door {
            leaf: reader.paint(&door.leaf)?,
            jamb: reader.jamb(),
            key: door.key.as_ref().and_then(|key| keys.id(key.name)),
            switch: door.switch.as_ref().and_then(|switch| switches.id(switch.name)),
        })),
        Meaning::Mask(mask) => mask.texture(reader).map(TileKind::Mask),
        Meaning::Glass(glass) => Some(TileKind::Glass(*glass)),
        Meaning::Mirror(tint, _) => Some(TileKind::Mirror(*tint)),
        Meaning::Shape(shape) => shape.shape(reader).map(TileKind::Shape),
        _ => None,
    }
}
