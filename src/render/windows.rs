//! The passes for what is not level: floors, ceilings and walls of any height, and mirrors.
//!
//! The ray of a column goes from cell to cell with a window of rows that nothing nearer covers. In
//! each cell the floor closes it from below and the ceiling from above; at each line it is shared
//! out among the faces and the gaps of the next cell, and the ray goes on in every gap that is still
//! in view: mostly one, two where a roof is seen from below and above at once. A mirror turns the ray
//! back with the window that its face had.
//!
//! Each of the passes is a file: `look` follows the rays and notes what every pixel shows, `planes`
//! lays floors, ceilings and the sky along rows, `faces` papers what stands upright, `veils` paints
//! over that what is seen through, and `things` what stands between. Where a world is level and has no mirrors the other passes draw
//! the same with less: they need not ask what a pixel shows. Laying a floor at once while its column
//! is followed was refused: by rows its shade and its distance are found once for many pixels.

mod faces;
mod lines;
mod look;
mod notes;
mod planes;
mod sights;
mod standing;
#[cfg(test)]
mod tests;
mod things;
mod veils;

use std::ops::Range;

use super::columns::Surface;
use super::marks::Marks;
use super::plan::WallLoop;
use super::sky::SkyView;
use super::tally::Tally;
use super::{Column, Filter, Frame, Projection};
use crate::cast::{Side, Unfolding};
use crate::world::texture::Level;
use crate::world::{Camera, Texture, Tile, TileId, TileKind, World};
use faces::Face;
use look::{Branch, Look};
use things::{Between, Billboards};
use veils::Veil;

/// There is room for so many images in mirrors from the first frame on.
const IMAGES_AT_ONCE: usize = 64;

/// What the passes hand on to each other; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(super) struct Windows {
    /// What each pixel shows, row by row from the top, each from the left.
    shown: Vec<Shown>,
    width: usize,
    faces: Vec<Face>,
    /// What is seen through: in each column, what is further comes later.
    veils: Vec<Veil>,
    /// Where a ray still has to be followed.
    branches: Vec<Branch>,
    /// Where what is seen is on the map: first as it is, and then in mirrors.
    images: Vec<Unfolding>,
    billboards: Billboards,
    counts: WindowCounts,
}

/// What it cost to follow the rays through their windows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct WindowCounts {
    /// Cells that the rays entered.
    pub cells: u64,
    /// Faces that they met, each as wide as a pixel.
    pub faces: u64,
    /// Stretches of floor, ceiling and sky along a row.
    pub spans: u64,
    /// How often they were reflected.
    pub bounces: u64,
}

/// What a pixel shows behind all that is seen through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shown {
    Sky { reflection: Reflection },
    Face(Side),
    Plane(Piece),
}

/// Something that lies flat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Piece {
    /// `None` for the ground beyond the edge of the map.
    tile: Option<TileId>,
    part: Part,
    reflection: Reflection,
}

/// What lies flat in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// The floor, or the top of a wall.
    Floor,
    Ceiling,
    /// The top of what hangs above the ceiling.
    Roof,
    /// The top of a pillar.
    Top,
}

/// By which mirrors something is seen: an index into the list of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Reflection(u16);

impl Reflection {
    const NONE: Self = Self(0);
}

/// What the passes draw from.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub(super) world: &'a World,
    pub(super) projection: &'a Projection,
    pub(super) filter: Filter,
    /// Above this height there is only sky.
    top: f64,
    /// Whether anything stands anywhere, be it the player before a mirror.
    has_things: bool,
}

impl<'a> Scene<'a> {
    pub(super) fn new(world: &'a World, projection: &'a Projection, filter: Filter) -> Self {
        let has_things = !world.things().is_empty() || world.has_mirrors();
        let tallest_thing =
            if has_things { world.tallest_sprite().max(Camera::STANDING) } else { 0.0 };
        let top_of = |tile: &Tile| match tile.kind {
            TileKind::Open | TileKind::Doorway(_) => tile.heights.floor() + tallest_thing,
            TileKind::Wall(_) | TileKind::Mirror(_) => tile.heights.floor(),
            TileKind::Door(_) | TileKind::Mask(_) | TileKind::Glass(_) | TileKind::Shape(_) => {
                tile.top_of_what_stands()
            }
        };
        let roof_of = |tile: &Tile| tile.gaps().next_back().map_or(0.0, |gap| gap.bottom);
        let tops = world.tiles().iter().map(|tile| top_of(tile).max(roof_of(tile)));
        Self { world, projection, filter, top: tops.fold(0.0, f64::max), has_things }
    }

    /// The level of a texture that suits a face at `t`, where the ray leads straight at it by `slope`
    /// for each unit of that.
    fn level_on(self, texture: &Texture, t: f64, slope: f64) -> &Level {
        let texels = f64::from(texture.width()) * f64::from(texture.height());
        let area = self.projection.pixel_area_on_wall(t, slope);
        texture.level(self.filter.halvings(area * texels))
    }
}

/// Who looks, and when.
#[derive(Clone, Copy)]
pub(super) struct Viewer<'a> {
    pub(super) camera: &'a Camera,
    pub(super) seconds: f64,
}

/// Draws what there is to see into `frame`, and notes in `columns` how far each ray got. Returns when
/// a thing in view will look different; `None` for never.
pub(super) fn draw<T: Tally>(
    scene: Scene<'_>,
    viewer: Viewer<'_>,
    (plan, sky): (WallLoop, &SkyView<'_>),
    (windows, columns, marks): (&mut Windows, &mut Vec<Column>, &mut Marks),
    frame: &mut Frame,
    tally: &mut T,
) -> Option<f64> {
    windows.begin(frame);
    columns.clear();
    for (x, ray) in scene.projection.rays().enumerate() {
        columns.push(Look::new(scene, x, frame.height(), windows).follow(&ray));
    }
    windows.counts.faces = windows.faces.len() as u64;
    marks.begin(frame.width(), frame.height());
    let (band, marks) = (&mut frame.whole(), &mut marks.whole());
    windows.counts.spans = planes::draw(scene, sky, windows, band, tally);
    faces::draw(scene, plan, &windows.faces, band, tally);

    let Windows { veils, images, billboards, .. } = windows;
    if scene.has_things {
        billboards.find(scene, images, veils, viewer);
    }
    veils::draw(scene, veils, billboards, marks, band, tally);
    if !scene.has_things {
        return None;
    }
    let (considered, drawn) = billboards.counts();
    tally.things(considered as usize, drawn as usize);
    billboards.next_change(scene, viewer.seconds)
}

/// The part of `window` that shows what is between two heights at distance `t`.
fn rows_between(
    projection: &Projection,
    window: &Range<u32>,
    bottom: f64,
    top: f64,
    t: f64,
) -> Range<u32> {
    let Range { mut start, mut end } = *window;
    if top < f64::INFINITY {
        start = start.max(projection.row_of(top, t));
    }
    if bottom > f64::NEG_INFINITY {
        end = end.min(projection.row_of(bottom, t));
    }
    start..end
}

impl Windows {
    /// What pixel `(x, y)` of the last frame shows, which must have been drawn by these passes.
    pub(super) fn surface(&self, x: u32, y: u32) -> Option<Surface> {
        let shown = self.shown.get(y as usize * self.width + x as usize)?;
        Some(match shown {
            Shown::Sky { .. } => Surface::Sky,
            Shown::Face(Side::X) => Surface::WallX,
            Shown::Face(Side::Y) => Surface::WallY,
            Shown::Plane(Piece { part: Part::Ceiling, .. }) => Surface::Ceiling,
            Shown::Plane(Piece { part: Part::Floor | Part::Roof | Part::Top, .. }) => {
                Surface::Floor
            }
        })
    }

    /// What the last frame cost.
    pub(super) fn counts(&self) -> WindowCounts {
        self.counts
    }

    /// Forgets the last frame. There is room for all but the strangest maps, so that a camera that
    /// turns towards more of it needs no more memory.
    fn begin(&mut self, frame: &Frame) {
        const OF_A_RAY: usize = 16;
        const AT_ONCE: usize = 64;
        let width = frame.width() as usize;
        self.width = width;
        self.shown.clear();
        let nothing = Shown::Sky { reflection: Reflection::NONE };
        self.shown.resize(width * frame.height() as usize, nothing);
        self.faces.clear();
        self.faces.reserve(width * OF_A_RAY);
        self.veils.clear();
        self.veils.reserve(width * OF_A_RAY);
        self.branches.clear();
        self.branches.reserve(AT_ONCE);
        self.images.clear();
        self.images.reserve(IMAGES_AT_ONCE);
        self.images.push(Unfolding::default());
        self.counts = WindowCounts::default();
    }

    /// The index of `unfolding`. Of a map with more mirrors in view than there are indices, the last
    /// ones show the places of another.
    fn reflection(&mut self, unfolding: Unfolding) -> Reflection {
        let known = self.images.iter().rposition(|&known| known == unfolding);
        let index = known.unwrap_or_else(|| {
            if u16::try_from(self.images.len()).is_ok() {
                self.images.push(unfolding);
            }
            self.images.len() - 1
        });
        Reflection(index as u16)
    }

    /// Where what is seen by `reflection` is on the map.
    fn unfolding(&self, Reflection(index): Reflection) -> Unfolding {
        self.images[usize::from(index)]
    }
}
