//! The tileset: the meanings of the characters in chunks, read from a map that draws each of them.
//!
//! The tiles, textures, sprites, sky and fog of a level are therefore parsed and checked as in any
//! other map. The map is read once, and chunks refer to its tiles by number.

use std::num::NonZeroU32;

use crate::fault::Faults;
use crate::map::{self, NoFiles};
use crate::world::{Cell, Grid, SpriteId, Start, Thing, ThingKind, Tile, TileId, TileKind, World};

/// The character of cells outside the areas that terrains fill.
pub(crate) const ROCK: u8 = b'#';

/// The meanings of the characters in chunks.
#[derive(Clone, Debug)]
pub(crate) struct Tileset {
    /// The world of the legend's map.
    world: World,
    /// The meanings, indexed by character. Characters without a meaning are rock.
    meanings: Vec<TilesetEntry>,
    exits: Vec<u8>,
}

#[derive(Clone, Copy, Debug)]
struct TilesetEntry {
    tile: TileId,
    thing: Option<(ThingKind, SpriteId)>,
    /// `true` if the player can walk there. For a door, this means the open door.
    is_walkable: bool,
}

impl Tileset {
    /// The tileset of the map `legend`.
    ///
    /// # Errors
    /// All faults in the map, or a fault if it has no rock.
    pub(crate) fn of(legend: &str) -> Result<Self, Faults> {
        const NAME: &str = "the legend";
        let world = map::parse(legend, NAME, &NoFiles)?;
        let drawn = drawn(&world, legend);
        let is_rock = |&(byte, meaning): &(u8, TilesetEntry)| byte == ROCK && !meaning.is_walkable;
        let Some((_, rock)) = drawn.iter().copied().find(is_rock) else {
            let message = format!("{NAME} shows no wall '#'");
            return Err(Faults::of_whole_file(NAME, &message, "draw one in its grid"));
        };
        let mut meanings = vec![rock; 256];
        let mut exits = Vec::new();
        for (byte, meaning) in drawn {
            meanings[usize::from(byte)] = meaning;
            if matches!(meaning.thing, Some((ThingKind::Exit, _))) {
                exits.push(byte);
            }
        }
        Ok(Self { world, meanings, exits })
    }

    /// A world whose cells can be replaced with [`Self::draw`].
    pub(crate) fn world(&self) -> World {
        self.world.clone()
    }

    /// The character of an exit on the same floor as `character`, or on any floor if there is no
    /// such exit; `None` if the legend has no exit.
    pub(crate) fn exit_on(&self, character: u8) -> Option<u8> {
        let floor = self.meaning(character).tile;
        let fits = |&&exit: &&u8| self.meaning(exit).tile == floor;
        self.exits.iter().find(fits).or(self.exits.first()).copied()
    }

    #[cfg(test)]
    pub(crate) fn is_exit(&self, character: u8) -> bool {
        self.exits.contains(&character)
    }

    /// Returns true if the player can walk on a cell with `character`.
    pub(crate) fn is_walkable(&self, character: u8) -> bool {
        self.meaning(character).is_walkable
    }

    /// Returns true if `character` is floor, with or without a thing on it.
    pub(crate) fn is_floor(&self, character: u8) -> bool {
        matches!(self.world.tile(self.meaning(character).tile).kind, TileKind::Open)
    }

    /// Returns true if `character` is floor without a thing on it.
    pub(crate) fn is_bare(&self, character: u8) -> bool {
        self.is_floor(character) && self.meaning(character).thing.is_none()
    }

    /// Returns true if `character` blocks the view, as a wall or a closed door does.
    pub(crate) fn is_opaque(&self, character: u8) -> bool {
        let kind = self.world.tile(self.meaning(character).tile).kind;
        matches!(kind, TileKind::Wall(_) | TileKind::Mirror(_) | TileKind::Door(_))
    }

    /// Replaces the cells of `world`, which must be a world of this tileset, by `rows`, and closes
    /// all doors. Every row has the length `width`. Also adds `items`, which must neither block the
    /// way nor give light.
    pub(crate) fn draw<'a>(
        &self,
        world: &mut World,
        width: NonZeroU32,
        rows: impl ExactSizeIterator<Item = Vec<u8>> + 'a,
        items: &[Thing],
        start: impl FnOnce(&Grid) -> Start,
    ) {
        let height = NonZeroU32::new(rows.len() as u32).unwrap_or(NonZeroU32::MIN);
        let mut cells = Vec::with_capacity(width.get() as usize * rows.len());
        let mut things = Vec::new();
        for (characters, row) in rows.zip(0..) {
            for (character, column) in characters.into_iter().zip(0..) {
                let TilesetEntry { tile, thing, .. } = self.meaning(character);
                cells.push(tile);
                let cell = Cell { column, row };
                things.extend(thing.map(|(kind, sprite)| Thing {
                    kind,
                    cell,
                    sprite,
                    frame: None,
                }));
            }
        }
        let first_solid = self.world.grid().first_solid();
        let Some(mut grid) = Grid::new(width, height, first_solid, cells) else { return };
        let blocks = |thing: &&Thing| self.world.sprite(thing.sprite).blocks;
        things.iter().filter(blocks).for_each(|thing| grid.occupy(thing.cell));
        let start = start(&grid);
        things.extend(items);
        world.redraw(grid, start, things);
    }

    fn meaning(&self, character: u8) -> TilesetEntry {
        self.meanings[usize::from(character)]
    }
}

/// The characters in the grid of `legend` with their meanings. `world` is the world of `legend`.
fn drawn(world: &World, legend: &str) -> Vec<(u8, TilesetEntry)> {
    let rows = map::rows_of_grid(legend);
    let cells = rows.iter().zip(0..).flat_map(|(line, row)| {
        line.bytes().zip(0..).map(move |(byte, column)| (byte, Cell { column, row }))
    });
    let meaning = |cell: Cell| {
        let tile = world.grid().tile_in(cell)?;
        let thing = world.things_in(cell).first().map(|thing| (thing.kind, thing.sprite));
        let is_free = !world.grid().is_occupied(cell.column.into(), cell.row.into());
        let Tile { kind, .. } = world.tile(tile);
        let is_open = matches!(kind, TileKind::Open | TileKind::Door(_));
        Some(TilesetEntry { tile, thing, is_walkable: is_open && is_free })
    };
    cells.filter_map(|(byte, cell)| Some((byte, meaning(cell)?))).collect()
}
