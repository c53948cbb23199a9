//! The passes for what is not level: floors, ceilings and walls of any height, and mirrors.
//!
//! The ray of a column goes from cell to cell with a window of rows that nothing nearer covers. In
//! each cell the floor closes it from below and the ceiling from above; at each line it is shared
//! out among the faces and the gaps of the next cell, and the ray goes on in every gap that is still
//! in view: mostly one, two where a roof is seen from below and above at once. A mirror turns the ray
//! back with the window that its face had.
//!
//! All of that is found out first, by `look`, from the `profile` of each tile, and noted column by column;
//! `things` finds what stands in between, and `layers` what is painted over the rest. Then the picture is
//! drawn band by band, by one thread or by several: `planes` lays floors, ceilings and the sky along rows,
//! `faces` papers what stands upright, and `layers` paints what is seen through, the `veils`. Where a world
//! is level and has no mirrors the other passes draw the same with less: they need no notes. Laying a floor
//! at once while its column is followed was refused: by rows its shade and its distance are found once for
//! many pixels.

mod blocks;
mod faces;
mod layers;
mod lines;
mod look;
mod notes;
mod planes;
mod profile;
mod sights;
mod standing;
#[cfg(test)]
mod tests;
mod things;
mod veils;

use std::ops::Range;

use super::coat::Wardrobe;
use super::columns::Surface;
use super::marks::Marks;
use super::plan::WallLoop;
use super::projection::Rise;
use super::sky::SkyView;
use super::tally::Tally;
use super::threads::{Threads, draw_bands};
use super::{Column, Filter, Frame, Projection};
use crate::cast::Side;
use crate::world::texture::Level;
use crate::world::{Camera, Texture, Tile, TileId, TileKind, World};
use faces::Stretch;
use layers::{Layer, Painter};
use look::{Branch, Look};
use notes::{Notes, Shown};
use profile::Profiles;
use things::Billboards;

/// There is room for so many images in mirrors from the first frame on.
const IMAGES_AT_ONCE: usize = 64;

/// What the passes hand on to each other; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(super) struct Windows {
    profiles: Profiles,
    notes: Notes,
    /// Where a ray still has to be followed.
    branches: Vec<Branch>,
    billboards: Billboards,
    layers: Vec<Layer>,
    /// One for each thread.
    workers: Vec<Worker>,
}

/// What the passes for a band hand on to each other; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
struct Worker {
    /// In which column the span begins that each row is in.
    starts: Vec<usize>,
    wardrobe: Wardrobe,
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
    /// Above this there is only sky.
    top: Rise,
    /// Whether anything stands anywhere, be it the player before a mirror.
    has_things: bool,
    walls: WallLoop,
}

impl<'a> Scene<'a> {
    pub(super) fn new(
        world: &'a World,
        projection: &'a Projection,
        filter: Filter,
        walls: WallLoop,
    ) -> Self {
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
        let top = projection.rise_to(tops.fold(0.0, f64::max));
        Self { world, projection, filter, top, has_things, walls }
    }

    /// The part of `window` that shows what is between two heights at distance `t`.
    fn rows_between(self, window: &Range<u32>, stretch: Stretch, t: f64) -> Range<u32> {
        let Stretch { bottom, top } = stretch;
        let row_of = |height| self.projection.row_of_height(height, t);
        window.start.max(row_of(top))..window.end.min(row_of(bottom))
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
    (threads, sky): (Threads, &SkyView<'_>),
    (windows, columns, marks): (&mut Windows, &mut Vec<Column>, &mut Marks),
    frame: &mut Frame,
    tally: &mut T,
) -> Option<f64> {
    windows.look(scene, frame.height(), columns);
    let Windows { profiles, notes, billboards, layers, workers, .. } = windows;
    if scene.has_things {
        billboards.find(scene, notes, viewer);
    }
    layers::lay_out(scene, (profiles, notes), billboards, layers);
    let (notes, billboards, layers) = (&*notes, &*billboards, &*layers);
    draw_bands(threads, (frame, marks), workers, tally, |worker, band, marks| {
        let Worker { starts, wardrobe } = worker;
        let mut spent = T::default();
        planes::draw(scene, sky, notes, starts, band, &mut spent);
        faces::draw(scene, &notes.faces, wardrobe, band, &mut spent);
        let painter = Painter { scene, panes: &notes.panes, billboards };
        painter.paint(layers, marks, band, &mut spent);
        spent
    });
    if !scene.has_things {
        return None;
    }
    let (considered, drawn) = billboards.counts();
    tally.things(considered as usize, drawn as usize);
    billboards.next_change(scene, viewer.seconds)
}

impl Windows {
    /// Follows the ray of each column of a picture of that height, and notes in `columns` how far it got.
    fn look(&mut self, scene: Scene<'_>, height: u32, columns: &mut Vec<Column>) {
        const BRANCHES_AT_ONCE: usize = 64;
        self.profiles.begin(scene);
        self.notes.begin(scene.projection.columns());
        self.branches.reserve(BRANCHES_AT_ONCE);
        columns.clear();
        for (x, ray) in (0..).zip(scene.projection.rays()) {
            columns.push(Look::new(scene, x, height, self).follow(&ray));
        }
        self.notes.counts.faces = self.notes.faces.len() as u64;
    }

    /// What pixel `(x, y)` of the last frame shows, which must have been drawn by these passes.
    pub(super) fn surface(&self, x: u32, y: u32) -> Option<Surface> {
        Some(match self.notes.shown(x, y)? {
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
        self.notes.counts
    }
}
