//! The frame plan: how a frame is drawn, and with which inner loops.
//!
//! It is a small value, made from the world and the camera before anything is drawn, from what each kind
//! of tile consists of. It is matched once a frame, so that what a scene does not have is absent from the
//! loops.

mod display;

use super::{Filter, Projection};
use crate::color::Rgb;
use crate::world::{
    Camera, Ceiling, Covering, Heights, Light, Paint, Pattern, Sky, Tile, TileKind, World,
};

/// How a frame is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FramePlan {
    /// How it is found out what is in view.
    pub visibility: Visibility,
    /// How exact rays go from cell to cell.
    pub rays: RayLoop,
    /// How what is overhead is drawn.
    pub ceiling: CeilingLoop,
    /// How the floor is drawn.
    pub floor: PlaneLoop,
    /// How the sky is drawn, where there is any: in place of a ceiling, or beyond the edge.
    pub sky: SkyLoop,
    /// How the walls are drawn.
    pub walls: WallLoop,
    /// How things are drawn.
    pub things: ThingLoop,
    /// Which level of a texture is read.
    pub filter: Filter,
}

/// How it is found out what is in view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// The flat way: one wall for each column, floor and ceiling around it.
    Flat,
    /// The flat way, and the portal way for the columns whose ray meets what is not level.
    Mixed(WhyPortals),
    /// The portal way: floors, ceilings and walls of any height, and mirrors.
    Portals(WhyPortals),
}

/// Why the flat way does not do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhyPortals {
    /// Floors, ceilings or walls are not all of one height.
    Heights,
    /// There are mirrors.
    Mirrors,
    /// The eye is not between floor and ceiling.
    Eye,
}

/// How exact rays go from cell to cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayLoop {
    /// They cross one line after the other and stop in every cell.
    Cells,
    /// They cross one line after the other, along one axis.
    Lines,
    /// They cross as many lines at once as no wall is near to: the map is mostly empty.
    Leaps,
}

/// How the floor or the ceiling is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaneLoop {
    /// One colour everywhere: a single fill, walls or no walls.
    Fill(Rgb),
    /// One colour, in fog: a fill for each row.
    FillRows(Rgb),
    /// One covering everywhere: the spans of each row that no wall hides.
    Spans,
    /// By tile: the same spans, cut where the tile changes.
    Tiles,
}

/// How what is overhead is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CeilingLoop {
    /// Nothing but sky.
    Sky,
    /// A ceiling, in places at least.
    Plane(PlaneLoop),
}

/// How the sky is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SkyLoop {
    /// One colour a row.
    Gradient,
    /// A texel a pixel, along the spans of each row that nothing hides.
    Panorama,
}

/// How the walls are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WallLoop {
    /// Whether any wall has a texture.
    pub textured: bool,
    /// Whether colours fade, by fog or for want of light.
    pub faded: bool,
    /// Whether a door may be set into them, and show its jamb.
    pub jambs: bool,
}

/// How things are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThingLoop {
    /// Not at all: there are none.
    None,
    /// Those in the cells in view, from far to near.
    Billboards,
}

impl FramePlan {
    /// The plan for what `camera` sees of `world`.
    pub fn new(world: &World, camera: &Camera, filter: Filter) -> Self {
        let tiles = world.tiles();
        let is_open = |tile: &&Tile| !matches!(tile.kind, TileKind::Wall(_) | TileKind::Mirror(_));
        let dims = |tile: &Tile| tile.light.is_some_and(|light| light != Light::FULL);
        let open = || tiles.iter().filter(is_open);
        let is_foggy = world.fog().is_some();
        let is_lamplit = world.has_lamplight();
        let floor_varies =
            is_lamplit || open().any(|tile| dims(tile) || tile.floor != world.floor());
        let ceiling_varies =
            is_lamplit || open().any(|tile| dims(tile) || tile.ceiling != world.ceiling());
        let is_textured = |tile: &Tile| matches!(tile.kind, TileKind::Wall(Paint::Texture(_)));
        let is_door = |tile: &Tile| matches!(tile.kind, TileKind::Door(_) | TileKind::Doorway(_));
        let visibility = Visibility::new(world, camera);
        let grid = world.level_grid().unwrap_or(world.grid());
        Self {
            visibility,
            rays: match visibility {
                Visibility::Portals(_) => RayLoop::Cells,
                _ if grid.distance_field().is_measured() => RayLoop::Leaps,
                _ => RayLoop::Lines,
            },
            floor: PlaneLoop::new(world.floor(), floor_varies, is_foggy),
            ceiling: match world.ceiling() {
                Ceiling::Sky if open().all(|tile| tile.ceiling == Ceiling::Sky) => CeilingLoop::Sky,
                Ceiling::Sky => CeilingLoop::Plane(PlaneLoop::Tiles),
                Ceiling::Covered(covering) => {
                    CeilingLoop::Plane(PlaneLoop::new(covering, ceiling_varies, is_foggy))
                }
            },
            sky: match world.sky() {
                Sky::Gradient { .. } => SkyLoop::Gradient,
                Sky::Panorama(_) => SkyLoop::Panorama,
            },
            walls: WallLoop {
                textured: tiles.iter().any(is_textured),
                faded: is_foggy || tiles.iter().any(dims),
                jambs: tiles.iter().any(is_door),
            },
            things: if world.things().is_empty() { ThingLoop::None } else { ThingLoop::Billboards },
            filter,
        }
    }
}

impl FramePlan {
    /// Has a frame of which only a part is level filled by portals, where any cell of `world` is open to the
    /// sky: the flat way takes the sky for a ceiling when it is asked for surfaces.
    pub(crate) fn tell_sky_from_ceilings(&mut self, world: &World) {
        let is_open = |tile: &Tile| tile.ceiling == Ceiling::Sky;
        if let Visibility::Mixed(why) = self.visibility
            && world.tiles().iter().any(is_open)
        {
            self.visibility = Visibility::Portals(why);
        }
    }
}

impl Visibility {
    fn new(world: &World, camera: &Camera) -> Self {
        let why = match (world.is_level(), world.has_mirrors()) {
            (true, false) => None,
            (true, true) => Some(WhyPortals::Mirrors),
            (false, _) => Some(WhyPortals::Heights),
        };
        let level = Heights::LEVEL;
        let is_between = level.floor() < camera.eye() && camera.eye() < level.ceiling();
        match why {
            Some(why) if stands_on_level_floor(world, camera) => Self::Mixed(why),
            Some(why) => Self::Portals(why),
            None if is_between => Self::Flat,
            None => Self::Portals(WhyPortals::Eye),
        }
    }
}

/// Whether `camera` is well inside a cell of level floor, between floor and ceiling: for all rays it is in
/// that cell.
fn stands_on_level_floor(world: &World, camera: &Camera) -> bool {
    /// Far more than is rounded away.
    const HAIR: f64 = 1e-6;
    let (place, eye) = (camera.position(), camera.eye());
    let inside = place - place.floor();
    let is_inside = inside.min_element() > HAIR && inside.max_element() < 1.0 - HAIR;
    let is_between = Projection::is_between_floor_and_ceiling(eye);
    let tile = world.grid().tile(place.x.floor() as i64, place.y.floor() as i64);
    let is_level_floor =
        |tile: Tile| tile.is_level() && matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
    is_inside && is_between && tile.is_some_and(|tile| is_level_floor(world.tile(tile)))
}

impl PlaneLoop {
    fn new(covering: Covering, varies: bool, is_foggy: bool) -> Self {
        match covering.pattern {
            _ if varies => Self::Tiles,
            Pattern::Plain(Paint::Color(color)) if is_foggy => Self::FillRows(color),
            Pattern::Plain(Paint::Color(color)) => Self::Fill(color),
            _ => Self::Spans,
        }
    }
}
