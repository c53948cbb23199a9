//! The walk of a column of pixels: its ray, followed through the gaps.

use std::ops::Range;

use glam::DVec2;

use super::PortalStart;
use super::billboards::RayPart;
use super::layers::Passed;
use super::met::{AlongFace, Met};
use super::ray_segments::RaySegment;
use super::tile_gaps::{GapId, Holds, TileGaps};
use crate::cast::{Crossed, Hit, MirroredWalk, Ray};
use crate::visibility::facing;
use crate::visibility::projection::Rise;
use crate::visibility::runs::{FlatSurface, ImageId, Part, Shown};
use crate::visibility::{Column, DrawList, Facing, PortalStats, Scene};
use crate::world::{Camera, Cell, Tile, TileId, TileKind};

/// The most reflections of a ray. The mirror after the last one shows only its tint.
pub(super) const MOST_BOUNCES: u32 = 8;

/// The values that all rays of a frame share.
pub(super) struct Surroundings<'a> {
    pub(super) scene: Scene<'a>,
    pub(super) gaps: &'a TileGaps,
    /// The rise above which there is only sky.
    pub(super) top: Rise,
    /// Whether there is any thing or figure, or the player in a mirror.
    pub(super) has_things: bool,
    most_bounces: u32,
}

/// A ray that is followed in one gap.
#[derive(Clone, Debug)]
pub(super) struct PortalRay {
    pub(super) walk: MirroredWalk,
    pub(super) place: Place,
    pub(super) gap: GapId,
    /// The clip range: the rows that no nearer surface covers.
    pub(super) rows: Range<u32>,
    /// The distance at which this part of the ray begins.
    pub(super) from: f64,
    pub(super) image: ImageId,
}

/// The location of a ray: in a cell, or off the map.
pub(super) type Place = Option<(Cell, TileId)>;

/// The results of walks besides the draw list, in memory that is reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(super) struct WalkMemory {
    /// The parts of rays that remain to be followed.
    pub(super) rays: Vec<PortalRay>,
    /// The see-through faces, and the parts in which billboards may show: in each column, further
    /// ones come later.
    pub(super) passed: Vec<Passed>,
    /// The segments of the rays on the map.
    pub(super) segments: Vec<RaySegment>,
    pub(super) stats: PortalStats,
}

/// The walk of one column.
pub(super) struct ColumnWalk<'a> {
    pub(super) surroundings: &'a Surroundings<'a>,
    pub(super) column: u32,
    direction: DVec2,
    pub(super) memory: &'a mut WalkMemory,
    pub(super) list: &'a mut DrawList,
    /// The last hit before a reflection, and the distance that the ray reached.
    pub(super) hit: Option<Hit>,
    pub(super) distance: f64,
}

impl WalkMemory {
    /// Removes the results of the last frame.
    pub(super) fn begin(&mut self) {
        self.passed.clear();
        self.segments.clear();
        self.stats = PortalStats::default();
    }

    /// Reserves memory for all but extreme maps.
    pub(super) fn make_room(&mut self, width: usize) {
        const RAYS_AT_ONCE: usize = 64;
        const OF_A_COLUMN: usize = 16;
        self.begin();
        self.rays.reserve(RAYS_AT_ONCE);
        self.passed.reserve(width * OF_A_COLUMN);
        self.segments.reserve(width * OF_A_COLUMN);
    }
}

impl<'a> Surroundings<'a> {
    pub(super) fn new(scene: Scene<'a>, gaps: &'a TileGaps) -> Self {
        let world = scene.world;
        let has_figures = !world.figures().is_empty();
        let has_things = !world.things().is_empty() || has_figures || world.has_mirrors();
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
        let top = tops.fold(world.top_of_figures(), f64::max);
        let top = scene.projection.rise_to(top);
        let most_bounces = if world.has_mirrors() { MOST_BOUNCES } else { 0 };
        Self { scene, gaps, top, has_things, most_bounces }
    }

    pub(super) fn tile(&self, place: Place) -> Option<&'a Tile> {
        let (_, id) = place?;
        self.scene.world.tiles().get(usize::from(id.0))
    }
}

impl<'a> ColumnWalk<'a> {
    /// The walk of `column` of the picture.
    pub(super) fn new(
        surroundings: &'a Surroundings<'a>,
        column: u32,
        memory: &'a mut WalkMemory,
        list: &'a mut DrawList,
    ) -> Self {
        let direction = surroundings.scene.projection.direction_of(column);
        Self { surroundings, column, direction, memory, list, hit: None, distance: 0.0 }
    }

    /// Follows the column's `ray` from `start` to the end of all its parts. Returns the hit and the
    /// distance that it reached before any reflection.
    pub(super) fn follow(mut self, ray: &Ray, start: PortalStart) -> Column {
        self.memory.stats.rays += 1;
        match start {
            PortalStart::Camera => self.start_at_camera(ray),
            PortalStart::Line { hit, rows } => self.start_at_line(ray, hit, rows),
        }
        while let Some(mut ray) = self.memory.rays.pop() {
            self.follow_one(&mut ray);
        }
        let projection = self.surroundings.scene.projection;
        self.list.runs.end_column(projection.rows());
        let Self { hit, distance, .. } = self;
        let row_of = |height| projection.row_of_height(height, distance);
        Column { hit, distance, rows: row_of(1.0)..row_of(0.0) }
    }

    /// Stores the ray for later, from the line that `hit` is on, in the part of `rows` behind it.
    fn start_at_line(&mut self, ray: &Ray, hit: Hit, rows: Range<u32>) {
        let &Surroundings { scene, gaps, most_bounces, .. } = self.surroundings;
        let runs = &mut self.list.runs;
        runs.show(0..rows.start, Shown::Flat);
        runs.show(rows.end..scene.projection.rows(), Shown::Flat);
        let Hit { cell, side, t, .. } = hit;
        let grid = scene.world.grid();
        let (walk, crossed) = MirroredWalk::entering(grid, ray, most_bounces, (cell, side));
        let before = facing::cell_before(self.direction, &hit);
        let before = grid
            .tile(before[0], before[1])
            .map(|tile| (Cell { column: before[0] as u32, row: before[1] as u32 }, tile));
        let Some(gap) = gaps.of(before).next() else { return };
        let into = crossed.into;
        let met = self.met_at(crossed, t, before);
        self.distance = t;
        let image = ImageId::NONE;
        let mut ray = PortalRay { walk, place: before, gap, rows, from: t, image };
        if self.cross_line(&mut ray, into, &met) {
            self.memory.rays.push(ray);
        }
    }

    /// The face at a line that is crossed at `t`.
    fn met_at(&self, crossed: Crossed, t: f64, before: Place) -> Met {
        let side = crossed.side;
        let facing = Facing::Side(side);
        let slope = facing.slope(self.direction);
        Met { side, facing, slope, t, u: AlongFace::AtLine(crossed), before }
    }

    /// Stores the ray for later, from the camera on.
    fn start_at_camera(&mut self, ray: &Ray) {
        let &Surroundings { scene, gaps, most_bounces, .. } = self.surroundings;
        let grid = scene.world.grid();
        let eye = scene.projection.eye();
        let walk = MirroredWalk::new(grid, ray, most_bounces);
        let place = walk.cell(grid);
        let gap_in = |place| gaps.of(place).find(|&id| gaps.gap(id).gap.holds(eye));
        // For an eye inside a solid part, the cell counts as the map's own floor.
        let ground = place.map(|(cell, _)| (cell, TileId(0)));
        let (place, gap) = match (gap_in(place), gap_in(ground)) {
            (Some(gap), _) => (place, gap),
            (None, Some(gap)) => (ground, gap),
            (None, None) => (ground, GapId::BOTTOMLESS),
        };
        let rows = 0..scene.projection.rows();
        let image = ImageId::NONE;
        self.memory.rays.push(PortalRay { walk, place, gap, rows, from: 0.0, image });
    }

    /// Follows `ray` to its end, and stores its segment.
    fn follow_one(&mut self, ray: &mut PortalRay) {
        let start = ray.from;
        self.follow_on(ray);
        if self.surroundings.has_things {
            let origin = self.surroundings.scene.projection.origin();
            let transform = ray.walk.transform();
            let end = |t: f64| transform.to_map(origin + self.direction * t);
            self.memory
                .segments
                .push(RaySegment { ends: [start, ray.from].map(end), image: ray.image });
        }
    }

    /// Follows `ray` to its end.
    fn follow_on(&mut self, ray: &mut PortalRay) {
        let grid = self.surroundings.scene.world.grid();
        loop {
            if self.surroundings.gaps.gap(ray.gap).holds == Holds::Standing {
                self.meet_standing(ray);
                if ray.rows.is_empty() {
                    return;
                }
            }
            let crossed = ray.walk.cross(grid);
            self.memory.stats.cells += u64::from(crossed.into.is_some());
            let tile = |(_, tile): (Cell, TileId)| tile;
            if crossed.into.is_some() && crossed.into.map(tile) == ray.place.map(tile) {
                // The next cell has the same heights.
                ray.place = crossed.into;
                continue;
            }
            let t = ray.walk.distance(&crossed);
            self.close(ray, t);
            if ray.rows.is_empty() {
                return;
            }
            let into = crossed.into;
            let met = self.met_at(crossed, t, ray.place);
            if !self.cross_line(ray, into, &met) {
                return;
            }
        }
    }

    /// Shows floor and ceiling of the cell of `ray`, which it leaves at `t`, and removes their rows
    /// from its clip range.
    pub(super) fn close(&mut self, ray: &mut PortalRay, t: f64) {
        self.keep_part(ray, t, None);
        let projection = self.surroundings.scene.projection;
        let (eye, gap) = (projection.eye(), self.surroundings.gaps.gap(ray.gap));
        let Range { start, end } = ray.rows;
        let tile = ray.place.map(|(_, tile)| tile);
        let image = ray.image;
        let surface = |part| Shown::Plane(FlatSurface { tile, part, image });
        let bottom = gap.row_of_bottom(projection, t);
        let top = gap.row_of_top(projection, t);
        if eye > gap.gap.bottom {
            self.list.runs.show(bottom.max(start)..end, surface(gap.below));
        }
        if eye < gap.gap.top && gap.gap.top < f64::INFINITY {
            self.list.runs.show(start..top.min(end), surface(Part::Ceiling));
        }
        ray.rows = start.max(top)..end.min(bottom);
        ray.from = t;
        if image == ImageId::NONE {
            self.distance = self.distance.max(t);
        }
    }

    /// Stores the part of `ray` up to `to`, in which billboards may show, where they are higher than
    /// the top of a pillar below it.
    pub(super) fn keep_part(&mut self, ray: &PortalRay, to: f64, top_below: Option<f64>) {
        if !self.surroundings.has_things {
            return;
        }
        let &PortalRay { ref rows, gap, from, image, .. } = ray;
        let (column, rows) = (self.column, rows.clone());
        let part = RayPart { column, rows, from, to, gap, top_below, image };
        self.memory.passed.push(Passed::Billboards(part));
    }
}
