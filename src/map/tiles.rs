//! The kinds of tile in a plan, and the states of moving tiles.
//!
//! A tile that moves becomes a list of tiles, its states. Successive states differ in height by at
//! most [`STEP`]. The grid draws only the first state.

use std::collections::BTreeSet;

use super::drawing::PerCharacter;
use super::legend::tiles::{Height, TileText, WallText};
use super::legend::{Meaning, Symbol};
use super::plan::{Names, Plan};
use super::textures::{SurfaceText, Textures};
use super::values::Name;
use crate::fault::Fault;
use crate::sort;
use crate::world::{
    Ceiling, Covering, Door, Driver, Heights, KeyId, MovingTile, Paint, Shape, SwitchId, Tile,
    TileEffect, TileId, TileKind,
};

/// The largest number of kinds of tile, the map's own floor and the states of moving tiles
/// included.
const MAX_TILES: usize = 255;
/// The largest difference in height between two states that follow each other, in cells.
const STEP: f64 = 0.125;
/// More states than a map may have tiles.
const MAX_STATES: f64 = 256.0;

/// The kinds of tile that a grid refers to.
pub(crate) struct TileList {
    /// The map's own floor, then other open floor and doorways, then solid tiles, each in the order
    /// of their characters.
    pub(crate) tiles: Vec<Tile>,
    pub(crate) first_solid: TileId,
    pub(crate) moving: Vec<MovingTile>,
    /// The tile of each character; for other characters, the map's own floor.
    pub(crate) drawn: PerCharacter<u8>,
}

/// The surfaces of risers and lintels that the map names for tiles without their own.
#[derive(Clone, Copy)]
pub(crate) struct Faces {
    pub(crate) riser: Option<Paint>,
    pub(crate) lintel: Option<Paint>,
}

impl Faces {
    /// The riser below `floor`: the map's own, or else the surface of the floor.
    pub(crate) fn riser(self, floor: Covering) -> Paint {
        self.riser.unwrap_or(floor.pattern.first_paint())
    }

    /// The lintel above `ceiling`: the map's own, or else the surface of the ceiling.
    pub(crate) fn lintel(self, floor: Covering, ceiling: Ceiling) -> Paint {
        let below = match ceiling {
            Ceiling::Covered(covering) => covering,
            Ceiling::Sky => floor,
        };
        self.lintel.unwrap_or(below.pattern.first_paint())
    }
}

/// The definitions that tiles without their own surfaces use, and the names of keys and switches.
pub(crate) struct Common<'l> {
    /// The map's own floor.
    pub(crate) ground: Tile,
    pub(crate) faces: Faces,
    pub(crate) keys: &'l Names<'l>,
    pub(crate) switches: &'l Names<'l>,
}

impl TileList {
    /// The tiles of `plan`. Reports their faults.
    pub(crate) fn of(plan: Plan<'_>, common: &Common<'_>, textures: &mut Textures<'_>) -> Self {
        let (drawn, moving) = (Vec::new(), Vec::new());
        let tiles = vec![common.ground];
        let mut builder = Builder { common, textures, tiles, drawn, moving };
        let stood_on = plan.symbols().filter_map(|(_, symbol)| symbol.support.as_ref());
        let used = plan.drawing.characters().chain(stood_on.map(|&(tile, _)| tile));
        for character in sort::gathered::<char, BTreeSet<char>>(used) {
            let Some(symbol) = plan.symbol(character) else { continue };
            if let Some(slot) = builder.add(character, symbol) {
                builder.drawn.push((character, slot));
            }
            if builder.tiles.len() > MAX_TILES {
                builder.textures.faults.push(builder.one_too_many(symbol));
                break;
            }
        }
        builder.into_list()
    }
}

/// The index of a tile in a [`Builder`].
type TileIndex = usize;

/// Collects tiles in the order of their characters.
struct Builder<'l, 'm> {
    common: &'l Common<'l>,
    textures: &'l mut Textures<'m>,
    tiles: Vec<Tile>,
    drawn: Vec<(char, TileIndex)>,
    moving: Vec<(Vec<TileIndex>, Driver)>,
}

impl Builder<'_, '_> {
    /// Adds the tiles of `character`; nothing if it has a fault or is no tile.
    fn add(&mut self, character: char, symbol: &Symbol<'_>) -> Option<TileIndex> {
        let kind = match &symbol.meaning {
            Meaning::Floor => TileKind::Open,
            Meaning::Wall(wall) => TileKind::Wall(self.textures.paint(&wall.surface)?),
            Meaning::Door(door) => TileKind::Door(Door {
                leaf: self.textures.paint(&door.leaf)?,
                jamb: self.textures.paint(&SurfaceText::built_in("jamb"))?,
                key: door.key.as_ref().and_then(|key| self.common.keys.id(key.text)).map(KeyId),
                switch: self.switch(door.switch.as_ref()),
            }),
            Meaning::Mask(surface) => self.mask(surface)?,
            Meaning::Glass(glass) => TileKind::Glass(*glass),
            Meaning::Mirror(tint, _) => TileKind::Mirror(*tint),
            Meaning::Shape(shape) => {
                let paint = self.textures.paint(&shape.surface)?;
                TileKind::Shape(Shape { outline: shape.outline, paint, height: shape.height })
            }
            _ => return None,
        };
        let tile = self.tile(character, kind, symbol)?;
        match &symbol.meaning {
            Meaning::Floor => self.add_floor(tile, &symbol.tile),
            Meaning::Wall(wall) if wall.moves() => self.add_moving_wall(tile, wall),
            _ => {
                if let TileKind::Door(door) = kind {
                    self.push(Tile { kind: TileKind::Doorway(door), ..tile });
                }
                Some(self.push(tile))
            }
        }
    }

    /// A wall with holes. A texture without holes is a fault, because otherwise the author would
    /// not know why the wall hides everything behind it.
    fn mask(&mut self, surface: &SurfaceText<'_>) -> Option<TileKind> {
        if let Paint::Texture(id) = self.textures.paint(surface)?
            && self.textures.get(id).has_alpha()
        {
            return Some(TileKind::Mask(id));
        }
        let message = "a mask needs a texture with holes, but this one has none";
        let help = "write { mask = \"grate\" }, or { wall = … } for a wall without holes";
        self.textures.faults.push(Fault::new(surface.place.clone(), message).help(help));
        None
    }

    /// A tile with the properties that `symbol` defines. The map's own floor supplies the others.
    fn tile(&mut self, character: char, kind: TileKind, symbol: &Symbol<'_>) -> Option<Tile> {
        let own = &symbol.tile;
        let &Common { ground, faces, .. } = self.common;
        let textures = &mut *self.textures;
        let faults_before = textures.faults.len();
        let map_ceiling = ground.heights.ceiling();
        let usual_floor = own.usual_floor();
        let floor = own.floor.as_ref().or(usual_floor.as_ref());
        let floor = floor.and_then(|floor| floor.covering(textures)).unwrap_or(ground.floor);
        let ceiling = own.ceiling.as_ref().and_then(|ceiling| ceiling.ceiling(textures));
        let ceiling = ceiling.unwrap_or(ground.ceiling);
        let mut face = |surface: &Option<SurfaceText<'_>>, otherwise: Paint| {
            surface.as_ref().and_then(|it| textures.paint(it)).unwrap_or(otherwise)
        };
        let riser = match kind {
            TileKind::Wall(paint) => paint,
            TileKind::Mirror(tint) => Paint::Color(tint.color),
            _ => face(&own.riser, faces.riser(floor)),
        };
        let lintel = face(&own.lintel, faces.lintel(floor, ceiling));
        if textures.faults.len() > faults_before {
            return None;
        }
        let heights = match &symbol.meaning {
            Meaning::Wall(WallText { height, .. }) | Meaning::Mirror(_, height) => {
                Heights::new(height.unwrap_or(map_ceiling), map_ceiling, map_ceiling)?
            }
            _ => heights(own, ceiling, map_ceiling)
                .map_err(|fault| textures.faults.push(fault))
                .ok()??,
        };
        let light = match kind {
            // A wall without a light is as bright as the floor that it is seen from.
            TileKind::Wall(_) => own.light,
            _ => own.light.or(ground.light),
        };
        Some(Tile { character, kind, floor, ceiling, light, heights, riser, lintel, effect: None })
    }

    fn add_floor(&mut self, floor: Tile, own: &TileText<'_>) -> Option<TileIndex> {
        let effect = match self.switch(own.plate.as_ref()) {
            Some(switch) => Some(TileEffect::Plate(switch)),
            None => own.water.as_ref().map(|_| TileEffect::Water),
        };
        let floor = Tile { effect, ..floor };
        let (end, driver) = match (&own.moves_to, &own.crumbles) {
            (Some(end), _) => (end, Driver::Switch(self.switch(own.switch.as_ref())?)),
            (None, Some(end)) => (end, Driver::Weight),
            (None, None) => return Some(self.push(floor)),
        };
        if let Some(fault) = end_fault(floor, end, driver == Driver::Weight) {
            self.textures.faults.push(fault);
            return None;
        }
        Some(self.add_moving([floor].into_iter().chain(floor_states(floor, end.cells)), driver))
    }

    fn add_moving_wall(&mut self, wall: Tile, text: &WallText<'_>) -> Option<TileIndex> {
        let driver = match &text.switch {
            None => Driver::Hand,
            switch => Driver::Switch(self.switch(switch.as_ref())?),
        };
        let ground = self.common.ground;
        let light = wall.light.or(ground.light);
        let open = Tile { character: wall.character, kind: TileKind::Open, light, ..ground };
        Some(self.add_moving([wall].into_iter().chain(wall_states(wall)).chain([open]), driver))
    }

    /// Adds a tile that moves through `states`; returns the first.
    fn add_moving(&mut self, states: impl Iterator<Item = Tile>, driver: Driver) -> TileIndex {
        let states: Vec<TileIndex> = states.map(|state| self.push(state)).collect();
        let first = states[0];
        self.moving.push((states, driver));
        first
    }

    fn push(&mut self, tile: Tile) -> TileIndex {
        self.tiles.push(tile);
        self.tiles.len() - 1
    }

    fn switch(&self, name: Option<&Name<'_>>) -> Option<SwitchId> {
        self.common.switches.id(name?.text).map(SwitchId)
    }

    /// The fault of the definition that exceeds [`MAX_TILES`].
    fn one_too_many(&self, symbol: &Symbol<'_>) -> Fault {
        let states: usize = self.moving.iter().map(|(states, _)| states.len()).sum();
        let message = format!("the grid has more than {} kinds of tile", MAX_TILES - 1);
        let fault = Fault::new(symbol.place.clone(), message).label("one too many");
        if states == 0 {
            return fault;
        }
        fault.help(format!(
            "{states} of them are heights of tiles that move, one for each eighth of a cell: let \
             them move less far"
        ))
    }

    fn into_list(self) -> TileList {
        let Self { tiles, drawn, moving, .. } = self;
        let is_open = |tile: &Tile| matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
        let (open, solid): (Vec<TileIndex>, Vec<TileIndex>) =
            (0..tiles.len()).partition(|&slot| is_open(&tiles[slot]));
        let first_solid = TileId(open.len() as u8);
        let order = [open, solid].concat();
        let mut ids = vec![0; tiles.len()];
        for (&slot, id) in order.iter().zip(0..=u8::MAX) {
            ids[slot] = id;
        }
        let moving = moving.into_iter().map(|(states, driver)| {
            let states = states.into_iter().map(|slot| TileId(ids[slot])).collect();
            MovingTile { states, driver }
        });
        TileList {
            moving: moving.collect(),
            tiles: order.iter().map(|&slot| tiles[slot]).collect(),
            first_solid,
            drawn: drawn.into_iter().map(|(character, slot)| (character, ids[slot])).collect(),
        }
    }
}

/// The heights of a tile with the definition `own` below `overhead`, in a map whose ceiling is at
/// `map_ceiling`. Returns a fault if the heights contradict each other.
fn heights(
    own: &TileText<'_>,
    overhead: Ceiling,
    map_ceiling: f64,
) -> Result<Option<Heights>, Fault> {
    let cells = |height: &Option<Height>| height.as_ref().map(|height| height.cells);
    let floor = cells(&own.floor_height).unwrap_or(0.0);
    let ceiling = match overhead {
        Ceiling::Covered(_) => cells(&own.ceiling_height).unwrap_or(map_ceiling),
        Ceiling::Sky => (floor + map_ceiling).min(Heights::MAX),
    };
    let roof = cells(&own.roof_height).unwrap_or(map_ceiling.max(ceiling));
    let fault = |height: &Height, message: &str| Fault::new(height.place.clone(), message);
    let is_open = overhead == Ceiling::Sky;
    Err(match (&own.ceiling_height, &own.floor_height, &own.roof_height) {
        (Some(height), ..) if is_open => fault(height, "a ceiling_height needs a ceiling")
            .label("this tile is open to the sky")
            .help("add a ceiling, such as ceiling = \"wood\", or leave ceiling_height out"),
        (.., Some(height)) if is_open => fault(height, "a roof_height needs a ceiling")
            .label("this tile is open to the sky")
            .help("add a ceiling, such as ceiling = \"wood\", or leave roof_height out"),
        (Some(height), ..) | (None, Some(height), _) if !is_open && floor >= ceiling => {
            fault(height, "a ceiling must be above its floor")
                .label(format!("the floor is at {floor} here, the ceiling at {ceiling}"))
                .help("raise ceiling_height, or write a wall with a height")
        }
        (.., Some(height)) if height.cells < ceiling => {
            fault(height, "a roof must not be below its ceiling")
                .label(format!("the ceiling is at {ceiling}"))
                .help("raise roof_height; what is between the two is solid")
        }
        _ => return Ok(Heights::new(floor, ceiling, roof)),
    })
}

/// The states of the floor `tile` after the first, up or down to the height `end`. [`end_fault`]
/// reports the faults of `end`.
fn floor_states(tile: Tile, end: f64) -> impl Iterator<Item = Tile> {
    let start = tile.heights.floor();
    let over = tile.heights.ceiling() - start;
    heights_between(start, end).filter_map(move |floor| {
        // Under the sky, the objects on the floor move with it, so the ceiling height does too.
        let ceiling = match tile.ceiling {
            Ceiling::Covered(_) => tile.heights.ceiling(),
            Ceiling::Sky => (floor + over).min(Heights::MAX),
        };
        let roof = tile.heights.roof().max(ceiling);
        Some(Tile { heights: Heights::new(floor, ceiling, roof)?, ..tile })
    })
}

/// The fault of a floor that cannot move to the height `end`; `None` if it can.
fn end_fault(tile: Tile, end: &Height, is_crumbling: bool) -> Option<Fault> {
    let fault = |message: &str| Fault::new(end.place.clone(), message);
    let (floor, ceiling) = (tile.heights.floor(), tile.heights.ceiling());
    if is_crumbling && end.cells >= floor {
        let fault = fault("a floor crumbles to a lower height");
        let fault = fault.label(format!("the floor is at {floor}"));
        return Some(fault.help(format!("write, for example, crumbles = {}", floor - 3.0)));
    }
    if end.cells == floor {
        let fault = fault("this floor moves to the height that it already has");
        return Some(fault.help("write another height, or leave moves_to out"));
    }
    if matches!(tile.ceiling, Ceiling::Covered(_)) && end.cells >= ceiling {
        let fault = fault("a ceiling must be above its floor");
        let fault = fault.label(format!("the ceiling is at {ceiling} here"));
        return Some(fault.help("raise ceiling_height, or move the floor by less"));
    }
    None
}

/// The states of `wall` after the first in which it is still a lower wall. After them, it is open.
fn wall_states(wall: Tile) -> impl Iterator<Item = Tile> {
    let (ceiling, roof) = (wall.heights.ceiling(), wall.heights.roof());
    let lower = heights_between(wall.heights.floor(), 0.0).filter(|&top| top > 0.0);
    lower.filter_map(move |top| Some(Tile { heights: Heights::new(top, ceiling, roof)?, ..wall }))
}

/// Equally spaced heights after `start`, up to and including `end`.
fn heights_between(start: f64, end: f64) -> impl Iterator<Item = f64> {
    let way = end - start;
    let count = (way.abs() / STEP).ceil().min(MAX_STATES) as u32;
    (1..=count).map(move |index| {
        if index == count { end } else { start + way * f64::from(index) / f64::from(count) }
    })
}
