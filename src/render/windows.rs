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
//! what is seen through over that. Where a world is level and has no mirrors the other passes draw
//! the same with less: they need not ask what a pixel shows. Laying a floor at once while its column
//! is followed was refused: by rows its shade and its distance are found once for many pixels.

mod faces;
mod look;
mod planes;
#[cfg(test)]
mod tests;
mod veils;

use super::columns::Surface;
use super::plan::WallLoop;
use super::sky::SkyView;
use super::tally::Tally;
use super::{Column, Filter, Frame, Projection};
use crate::cast::{Side, Unfolding};
use crate::world::{TileId, World};
use faces::Face;
use look::{Branch, Look};
use veils::Veil;

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
    /// Where on the map is what is seen in mirrors, the map itself first.
    unfoldings: Vec<Unfolding>,
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
}

/// By which mirrors something is seen: an index into the list of unfoldings.
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
}

impl<'a> Scene<'a> {
    pub(super) fn new(world: &'a World, projection: &'a Projection, filter: Filter) -> Self {
        let tops = world.tiles().iter().filter_map(|tile| tile.gaps().next_back());
        let top = tops.map(|gap| gap.bottom).fold(0.0, f64::max);
        Self { world, projection, filter, top }
    }
}

/// Draws what there is to see into `frame`, and notes in `columns` how far each ray got.
pub(super) fn draw<T: Tally>(
    scene: Scene<'_>,
    plan: WallLoop,
    sky: &SkyView<'_>,
    windows: &mut Windows,
    columns: &mut Vec<Column>,
    frame: &mut Frame,
    tally: &mut T,
) {
    windows.begin(frame);
    columns.clear();
    for (x, ray) in scene.projection.rays().enumerate() {
        columns.push(Look::new(scene, x, frame.height(), windows).follow(&ray));
    }
    windows.counts.faces = windows.faces.len() as u64;
    windows.counts.spans = planes::draw(scene, sky, windows, frame, tally);
    faces::draw(scene, plan, &windows.faces, frame, tally);
    veils::draw(scene, &windows.veils, frame, tally);
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
            Shown::Plane(Piece { part: Part::Floor | Part::Roof, .. }) => Surface::Floor,
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
        self.unfoldings.clear();
        self.unfoldings.reserve(AT_ONCE);
        self.unfoldings.push(Unfolding::default());
        self.counts = WindowCounts::default();
    }

    /// The index of `unfolding`. Of a map with more mirrors in view than there are indices, the last
    /// ones show the places of another.
    fn reflection(&mut self, unfolding: Unfolding) -> Reflection {
        let known = self.unfoldings.iter().rposition(|&known| known == unfolding);
        let index = known.unwrap_or_else(|| {
            if u16::try_from(self.unfoldings.len()).is_ok() {
                self.unfoldings.push(unfolding);
            }
            self.unfoldings.len() - 1
        });
        Reflection(index as u16)
    }

    /// Where what is seen by `reflection` is on the map.
    fn unfolding(&self, Reflection(index): Reflection) -> Unfolding {
        self.unfoldings[usize::from(index)]
    }
}
