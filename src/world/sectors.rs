//! Sectors: the gaps of tiles, grouped by their heights.
//!
//! Neighbouring cells whose gaps have the same bottom and the same top look like one room, whatever their
//! floors look like. There is no face between them, and a ray needs no new clip range from one to the next.
//! Such gaps share one sector, as neighbouring cells would in a map of Doom. A world finds its sectors once.
//!
//! A gap under the sky has no top. In a frame, it ends at the height above which the world is empty, and then
//! has the same sector as a room with a ceiling at that height. A level world that is half roofed is therefore
//! a single sector. If the eye is above that height, the gap has no top in the frame either.

use super::{Ceiling, Covering, Gap, Heights, Light, Tile, TileId, TileKind, World};

/// The sectors of a world, or of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sectors {
    list: Vec<Sector>,
    of_tiles: Vec<TileSectors>,
}

/// A sector, as an index into the sectors of the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SectorId(u16);

/// All gaps with the same bottom, the same top and the same object.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sector {
    pub(crate) bottom: f64,
    /// The height of the top; infinite if there is none.
    pub(crate) top: f64,
    pub(crate) holds: GapObject,
    /// The floor and the ceiling of the first tile in the sector.
    surfaces: [PlaneSurface; 2],
    /// Whether the floors, and whether the ceilings, may differ between cells.
    vary: [bool; 2],
}

/// The sectors of the gaps of a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TileSectors {
    pub(crate) lower: SectorId,
    /// The sector above the roof, if the tile has a room below the roof.
    pub(crate) upper: Option<SectorId>,
}

/// The object that stands at the bottom of a gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum GapObject {
    Nothing,
    /// The leaf of a door, or a shape. It does not fill its cell.
    Standing,
    /// Glass or a mask of this tile. It fills the cell.
    Cube(TileId),
}

/// The floor or the ceiling of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlaneSurface {
    /// The covering; `None` for the sky.
    pub(crate) covering: Option<Covering>,
    pub(crate) light: Light,
}

/// The floor or the ceiling of a sector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PlaneSide {
    Floor,
    Ceiling,
}

/// A height below all others.
const BOTTOMLESS: f64 = -2.0 * Heights::MAX;

impl SectorId {
    /// The sector off the map.
    pub(crate) const BEYOND: Self = Self(0);
    /// The sector of an eye that is in no gap.
    pub(crate) const SOLID: Self = Self(1);
    /// The index of the first sector with cells.
    const FIRST: usize = 2;
}

impl Sectors {
    /// Finds the sectors of `tiles`. The first tile is the map's own floor.
    pub(crate) fn new(tiles: &[Tile]) -> Self {
        // Off the map, there is the map's own floor under the sky, and nothing below it.
        let ground = tiles[0];
        let covering = Some(ground.floor);
        let ground = PlaneSurface { covering, light: ground.light.unwrap_or(Light::FULL) };
        let sky = PlaneSurface { covering: None, light: Light::FULL };
        let off_map = |bottom| Sector {
            bottom,
            top: f64::INFINITY,
            holds: GapObject::Nothing,
            surfaces: [ground, sky],
            vary: [false; 2],
        };
        let mut list = vec![off_map(0.0), off_map(BOTTOMLESS)];
        let of_tiles = (0..).map(TileId).zip(tiles).map(|(id, tile)| {
            let mut gaps = tile.gaps().enumerate().map(|(index, gap)| {
                let surfaces = PlaneSurface::of_gap(tile, gap, index > 0);
                add(&mut list, gap, GapObject::new(id, tile, gap), surfaces)
            });
            let lower = gaps.next().unwrap_or(SectorId::SOLID);
            TileSectors { lower, upper: gaps.next() }
        });
        Self { of_tiles: of_tiles.collect(), list }
    }

    /// Makes these the sectors of a frame of `world`, in which gaps under the sky end at `top_of_sky`.
    pub(crate) fn begin(&mut self, world: &World, top_of_sky: f64) {
        let Self { list, of_tiles } = world.sectors();
        self.list.clone_from(list);
        self.of_tiles.clone_from(of_tiles);
        let is_lamplit = world.has_lamplight();
        for sector in &mut self.list {
            sector.top = sector.top.min(top_of_sky);
            sector.vary = sector.vary.map(|varies| varies || is_lamplit);
        }
        for open in SectorId::FIRST..list.len() {
            let Sector { bottom, top, .. } = list[open];
            if top == f64::INFINITY && bottom < top_of_sky && top_of_sky < top {
                self.merge_with_roofed(list, open, top_of_sky);
            }
        }
    }

    /// Merges the sector at index `open`, which is under the sky in the world's own `list`, with the sector that
    /// has a ceiling at `top_of_sky`.
    fn merge_with_roofed(&mut self, list: &[Sector], open: usize, top_of_sky: f64) {
        let Sector { bottom, holds, .. } = list[open];
        let is_it = |it: &Sector| (it.bottom, it.top, it.holds) == (bottom, top_of_sky, holds);
        let roofed = list[SectorId::FIRST..].iter().position(is_it);
        let Some(roofed) = roofed.map(|index| SectorId::FIRST + index) else { return };
        let (kept, merged) = (open.min(roofed), open.max(roofed));
        let differ = list[kept].differs_from(&list[merged]);
        for side in [0, 1] {
            self.list[kept].vary[side] |= differ[side] || list[merged].vary[side];
        }
        let (kept, merged) = (SectorId(kept as u16), SectorId(merged as u16));
        for TileSectors { lower, upper } in &mut self.of_tiles {
            for id in [Some(lower), upper.as_mut()].into_iter().flatten() {
                if *id == merged {
                    *id = kept;
                }
            }
        }
    }

    /// The sectors of the gaps of `tile`.
    #[inline]
    pub(crate) fn of(&self, TileId(tile): TileId) -> TileSectors {
        self.of_tiles[usize::from(tile)]
    }

    /// The object in the lower gap of the cells of `tile`.
    pub(crate) fn held_by(&self, tile: TileId) -> GapObject {
        self.get(self.of(tile).lower).holds
    }

    #[inline]
    pub(crate) fn get(&self, SectorId(id): SectorId) -> &Sector {
        &self.list[usize::from(id)]
    }

    /// Returns true if rays in `sector` continue into a cell of `tile` without meeting anything.
    #[inline]
    pub(crate) fn continues(&self, sector: SectorId, tile: TileId) -> bool {
        match sector {
            SectorId::SOLID => tile == TileId(0),
            _ => self.of(tile).have(sector) && self.get(sector).holds != GapObject::Standing,
        }
    }

    /// The sector of an eye at this height in a cell of `tile`. If the eye is inside something solid, it is the
    /// sector of the map's own floor at this height.
    pub(crate) fn of_eye(&self, tile: Option<TileId>, eye: f64) -> SectorId {
        let holds = |&id: &SectorId| {
            let Sector { bottom, top, .. } = *self.get(id);
            Gap { bottom, top }.holds(eye)
        };
        let Some(tile) = tile else {
            return if eye >= 0.0 { SectorId::BEYOND } else { SectorId::SOLID };
        };
        let in_tile = |tile: TileId| {
            let TileSectors { lower, upper } = self.of(tile);
            [Some(lower), upper].into_iter().flatten().find(holds)
        };
        in_tile(tile).or_else(|| in_tile(TileId(0))).unwrap_or(SectorId::SOLID)
    }

    /// The floor or the ceiling of `sector`, if it looks the same everywhere.
    pub(crate) fn even_surface(&self, sector: SectorId, side: PlaneSide) -> Option<PlaneSurface> {
        let sector = self.get(sector);
        (!sector.vary[side as usize]).then_some(sector.surfaces[side as usize])
    }

    /// The floor and the ceiling of `sector` in a cell of `tile`.
    pub(crate) fn surfaces(
        &self,
        world: &World,
        sector: SectorId,
        id: TileId,
    ) -> [PlaneSurface; 2] {
        let TileSectors { lower, upper } = self.of(id);
        let tile = &world.tiles()[usize::from(id.0)];
        let gap = match sector {
            _ if sector == lower => tile.gaps().next(),
            _ if upper == Some(sector) => tile.gaps().nth(1),
            // Rounding has put the point into a cell outside the sector.
            _ => None,
        };
        match gap {
            Some(gap) => PlaneSurface::of_gap(tile, gap, sector != lower),
            None => self.get(sector).surfaces,
        }
    }
}

/// Returns the sector of a gap, and adds it to `list` if it is missing.
fn add(
    list: &mut Vec<Sector>,
    gap: Gap,
    holds: GapObject,
    surfaces: [PlaneSurface; 2],
) -> SectorId {
    let Gap { bottom, top } = gap;
    let new = Sector { bottom, top, holds, surfaces, vary: [false; 2] };
    let is_it = |it: &Sector| (it.bottom, it.top, it.holds) == (bottom, top, holds);
    let known = list[SectorId::FIRST..].iter().position(is_it);
    let index = known.map_or(list.len(), |index| SectorId::FIRST + index);
    match list.get_mut(index) {
        Some(sector) => {
            let differ = sector.differs_from(&new);
            sector.vary = [0, 1].map(|side| sector.vary[side] || differ[side]);
        }
        None => list.push(new),
    }
    SectorId(index as u16)
}

impl TileSectors {
    /// Returns true if a gap of the tile belongs to `sector`.
    #[inline]
    pub(crate) fn have(self, sector: SectorId) -> bool {
        self.lower == sector || self.upper == Some(sector)
    }
}

impl Sector {
    /// Returns true if `height` is between its bottom and its top.
    pub(crate) fn is_inside(&self, height: f64) -> bool {
        self.bottom < height && height < self.top
    }

    /// Whether the floors, and whether the ceilings, of the first tiles look different.
    fn differs_from(&self, other: &Self) -> [bool; 2] {
        [0, 1].map(|side| self.surfaces[side] != other.surfaces[side])
    }

    /// Returns true if it has a height in common with `other`.
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        self.bottom.max(other.bottom) < self.top.min(other.top)
    }
}

impl GapObject {
    fn new(id: TileId, tile: &Tile, gap: Gap) -> Self {
        match tile.kind {
            _ if gap.bottom != tile.heights.floor() => Self::Nothing,
            TileKind::Door(_) | TileKind::Shape(_) => Self::Standing,
            TileKind::Mask(_) | TileKind::Glass(_) => Self::Cube(id),
            TileKind::Open | TileKind::Doorway(_) | TileKind::Wall(_) | TileKind::Mirror(_) => {
                Self::Nothing
            }
        }
    }
}

impl PlaneSurface {
    /// The top of a shape in a cell of `tile`, without lamplight.
    pub(crate) fn of_top(tile: &Tile) -> Self {
        let paint = match tile.kind {
            TileKind::Shape(shape) => shape.paint,
            _ => tile.riser,
        };
        let light = tile.light.unwrap_or(Light::FULL);
        Self { covering: Some(Covering::from(paint)), light }
    }

    /// The floor and the ceiling of a gap of `tile`, which may be above its roof.
    fn of_gap(tile: &Tile, gap: Gap, is_roof: bool) -> [Self; 2] {
        let light = tile.light.unwrap_or(Light::FULL);
        let floor = match tile.kind {
            _ if is_roof => Covering::from(tile.lintel),
            TileKind::Wall(_) | TileKind::Mirror(_) => Covering::from(tile.riser),
            _ => tile.floor,
        };
        let ceiling = match tile.ceiling {
            Ceiling::Covered(covering) if gap.top < f64::INFINITY => Some(covering),
            _ => None,
        };
        [Self { covering: Some(floor), light }, Self { covering: ceiling, light }]
    }
}
