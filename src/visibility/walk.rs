//! The walk: from sector to sector, along the rays of neighbouring columns.
//!
//! A visit is a sector and a range of neighbouring columns whose rays enter the sector through one line. Each
//! column has a clip range: the rows that no nearer surface covers. The [fan](super::fan) finds the faces
//! through which the rays leave the sector. Floor and ceiling reduce the clip range. At each face, the solid
//! parts of the next cell and its gaps divide the remaining rows, and the walk visits the gaps next. There is
//! usually one gap, or two if a roof is seen from below and from above at once. A mirror is a visit to the same
//! sector in another image, with the clip range of the mirror. Sectors and portals follow the Build engine (Ken
//! Silverman, 1995).
//!
//! The walk adds everything that it finds to the draw list, nearer items first. Rejected: following rays from
//! cell to cell, one by one or neighbouring rays together. In a hall, most cells that they cross look alike,
//! and each cell costs time in every column that it covers.

use std::mem;
use std::ops::Range;

use glam::DVec2;

use super::draw_list::{Backdrop, DrawList, Layer, PlaneKind, RayPart, RaySegment};
use super::face::{CellFace, Face, FaceColumn, Facing, Material, Rows, cell_in_front, on_map};
use super::fan::{Border, Fan, FanMemory, RayStarts, SectorEntry};
use super::projection::RelativeHeight;
use super::{FrameContext, WalkStats};
use crate::cast::{Course, Hit, Intersection, MirrorTransform, Ray, from_left, is_from_left};
use crate::world::sprite::builtin;
use crate::world::{
    Camera, Cell, FaceLight, GapObject, Glass, Paint, Pattern, PlaneSide, PlaneSurface, Sector,
    SectorId, Sky, Tile, TileId, TileKind, TileSectors,
};

/// The greatest number of reflections of a ray. The mirror after the last one shows only its tint.
pub(crate) const MAX_BOUNCES: u32 = 8;

/// Memory that walks reuse from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct WalkMemory {
    /// The remaining visits, with their clips and entries.
    visits: Vec<Visit>,
    clips: Vec<Clip>,
    entries: Vec<SectorEntry>,
    fan: FanMemory,
    borders: Vec<Border>,
    /// The passage of each ray of a visit through the cell of an object.
    passages: Vec<Intersection>,
    /// Values of the current visit, by column.
    columns: ColumnMemory,
    /// The next visits: in the lower gap, in the upper gap, and in a mirror.
    next: [PendingVisit; 3],
}

/// A sector, and the columns whose rays enter it.
#[derive(Clone, Debug)]
struct Visit {
    sector: SectorId,
    image: MirrorTransform,
    bounces: u32,
    /// `true` if the rays begin at the camera, in this sector.
    is_at_camera: bool,
    columns: Range<u32>,
    /// The index of the first column's clip, and of the first entry. The others follow.
    first_clip: usize,
    first_entry: usize,
}

/// The clip range of a ray at the beginning of a visit, and the distance from which it applies.
#[derive(Clone, Copy, Debug)]
struct Clip {
    rows: Rows,
    from: f64,
}

/// The values of each column in the current visit.
#[derive(Clone, Debug, Default)]
struct ColumnMemory {
    /// The rows that no nearer surface covers, and the distance from which the rows are open.
    starts: Vec<u32>,
    ends: Vec<u32>,
    from: Vec<f64>,
    /// The distance at which the ray leaves the sector or meets an object in it.
    t: Vec<f64>,
    u: Vec<f64>,
    /// The row of a bottom and the row of a top at this distance.
    bottoms: Vec<u32>,
    tops: Vec<u32>,
}

/// An incomplete visit, which the next face may extend.
#[derive(Clone, Debug, Default)]
struct PendingVisit {
    visit: Option<(Visit, CellFace)>,
    rows: Vec<Rows>,
    entries: Vec<SectorEntry>,
}

/// Neighbouring borders that look alike.
struct BorderGroup {
    /// The indices of the borders.
    borders: Range<usize>,
    columns: Range<u32>,
    /// The face of the first border.
    face: CellFace,
}

/// The light on a face, and its paint if it is the jamb of a door.
type BorderLook = (FaceLight, Option<Paint>);

/// The kind of a next visit.
#[derive(Clone, Copy)]
enum VisitKind {
    Lower,
    Upper,
    Mirror,
}

impl ColumnMemory {
    /// The columns of a face in `range`, with the open rows between `tops` and `bottoms`.
    #[inline]
    fn of_face(&self, range: &Range<u32>) -> impl Iterator<Item = FaceColumn> {
        let indices = range.start as usize..range.end as usize;
        let Self { starts, ends, t, u, bottoms, tops, .. } = self;
        let starts = starts[indices.clone()].iter().zip(&tops[indices.clone()]);
        let ends = ends[indices.clone()].iter().zip(&bottoms[indices.clone()]);
        let places = t[indices.clone()].iter().zip(&u[indices]);
        starts.zip(ends).zip(places).map(|(((start, top), (end, bottom)), (&t, &u))| {
            let rows = Rows { start: *start.max(top), end: *end.min(bottom) };
            FaceColumn { rows, t, u }
        })
    }
}

impl WalkMemory {
    /// Reserves memory for all but extreme maps, in pictures of `width` columns.
    pub(crate) fn make_room(&mut self, width: usize) {
        const OF_A_COLUMN: usize = 8;
        self.visits.clear();
        self.clips.clear();
        self.entries.clear();
        self.visits.reserve(2 * width);
        self.clips.reserve(width * OF_A_COLUMN);
        self.entries.reserve(width * OF_A_COLUMN);
        self.borders.clear();
        self.borders.reserve(width);
        self.passages.clear();
        self.passages.reserve(width);
        self.fan.clear();
        self.fan.reserve(width);
        let columns = &mut self.columns;
        let ColumnMemory { starts, ends, from, t, u, bottoms, tops } = columns;
        for rows in [starts, ends, bottoms, tops] {
            rows.resize(width, 0);
        }
        for distances in [from, t, u] {
            distances.resize(width, 0.0);
        }
        for next in &mut self.next {
            next.rows.resize(width, Rows::NONE);
            next.entries.clear();
            next.entries.reserve(width);
        }
    }
}

/// The height above which there is only sky; infinite if the eye is above it.
pub(crate) fn top_of_sky(scene: FrameContext<'_>) -> f64 {
    let FrameContext { world, projection, .. } = scene;
    let mut top = world.tile_facts().top.max(world.top_of_figures());
    if !world.things().is_empty() {
        top = top.max(world.limit_of_things());
    }
    if world.has_mirrors() {
        top = top.max(projection.eye() - Camera::STANDING + builtin::PLAYER_HEIGHT);
    }
    if projection.eye() < top { top } else { f64::INFINITY }
}

/// Walks from the camera of `scene` to everything in view, and adds it to `list`, whose sectors must be known.
pub(crate) fn walk(
    scene: FrameContext<'_>,
    memory: &mut WalkMemory,
    list: &mut DrawList,
) -> WalkStats {
    let sectors = mem::take(&mut list.sectors);
    let directions = mem::take(&mut list.directions);
    let most_bounces = if scene.world.has_mirrors() { MAX_BOUNCES } else { 0 };
    let fan = Fan::new(scene, &sectors, &directions, most_bounces);
    let has_things = !scene.world.things().is_empty()
        || !scene.world.figures().is_empty()
        || scene.world.has_mirrors();
    let stats = WalkStats::default();
    let mut walk = SectorWalk { scene, fan, has_things, memory, list, stats };
    walk.begin();
    walk.follow_all();
    let WalkStats { rays, cells, looks, .. } = walk.fan.counts.get();
    let stats = WalkStats { rays, cells, looks, ..walk.stats };
    list.sectors = sectors;
    list.directions = directions;
    stats
}

struct SectorWalk<'a> {
    scene: FrameContext<'a>,
    fan: Fan<'a>,
    /// `true` if billboards may show: things, figures, or the player in a mirror.
    has_things: bool,
    memory: &'a mut WalkMemory,
    list: &'a mut DrawList,
    stats: WalkStats,
}

impl SectorWalk<'_> {
    /// Stores the visits to the sector of the camera. If the camera is on a grid line or off the map, there is
    /// one visit for each range of columns whose directions have the same signs.
    fn begin(&mut self) {
        let FrameContext { world, projection, .. } = self.scene;
        let (grid, origin) = (world.grid(), projection.origin());
        let edge = DVec2::new(f64::from(grid.width()), f64::from(grid.height()));
        let is_inside = origin.cmpgt(DVec2::ZERO).all() && origin.cmplt(edge).all();
        let is_one_cell = is_inside && origin.fract().cmpne(DVec2::ZERO).all();
        let signs = |column: u32| {
            let DVec2 { x, y } = self.fan.directions.of(column);
            [x > 0.0, x < 0.0, y > 0.0, y < 0.0]
        };
        let width = projection.columns() as u32;
        let mut first = 0;
        while first < width {
            let is_next = |&column: &u32| !is_one_cell && signs(column) != signs(first);
            let end = (first + 1..width).find(is_next).unwrap_or(width);
            self.store_first(first..end);
            first = end;
        }
    }

    /// Stores a visit to the sector of the camera.
    fn store_first(&mut self, columns: Range<u32>) {
        let FrameContext { world, projection, .. } = self.scene;
        let ray = Ray::of_camera(projection.origin(), self.fan.directions.of(columns.start));
        let course = Course::new(world.grid(), &ray);
        let tile = course.cell(world.grid()).map(|(_, tile)| tile);
        let WalkMemory { visits, clips, entries, .. } = &mut *self.memory;
        visits.push(Visit {
            sector: self.fan.sectors.of_eye(tile, projection.eye()),
            image: MirrorTransform::default(),
            bounces: 0,
            is_at_camera: true,
            first_clip: clips.len(),
            first_entry: entries.len(),
            columns: columns.clone(),
        });
        entries.push(SectorEntry { column: columns.start, place: course.place() });
    }

    fn follow_all(&mut self) {
        while let Some(visit) = self.memory.visits.pop() {
            self.follow(&visit);
        }
    }

    fn follow(&mut self, visit: &Visit) {
        self.stats.sectors += 1;
        let WalkMemory { clips, entries, columns, fan, borders, .. } = &mut *self.memory;
        let indices = visit.columns.start as usize..visit.columns.end as usize;
        if visit.is_at_camera {
            columns.starts[indices.clone()].fill(0);
            columns.ends[indices.clone()].fill(self.scene.projection.rows());
            columns.from[indices].fill(0.0);
        } else {
            for (x, clip) in indices.zip(&clips[visit.first_clip..]) {
                columns.starts[x] = clip.rows.start;
                columns.ends[x] = clip.rows.end;
                columns.from[x] = clip.from;
            }
        }
        clips.truncate(visit.first_clip);
        let view = RayStarts {
            sector: visit.sector,
            image: visit.image,
            entries: &entries[visit.first_entry..],
            is_at_camera: visit.is_at_camera,
        };
        self.fan.find(view, visit.columns.clone(), fan, borders);
        let first_place = view.entries[0].place;
        entries.truncate(visit.first_entry);
        let sector = self.fan.sectors.get(visit.sector);
        if sector.holds == GapObject::Standing {
            self.meet_standing(visit, sector, first_place);
        }
        self.find_distances();
        self.close(visit, sector, visit.columns.clone());
        self.pass_borders(visit, sector);
    }

    /// Finds the distances at which the rays leave the sector.
    fn find_distances(&mut self) {
        let origin = self.scene.projection.origin();
        let WalkMemory { borders, columns, .. } = &mut *self.memory;
        for Border { columns: range, face, .. } in &*borders {
            let range = range.start as usize..range.end as usize;
            let offset = face.line() as f64 - origin[face.side as usize];
            let across = &self.fan.directions.across(face.side)[range.clone()];
            for (t, direction) in columns.t[range].iter_mut().zip(across) {
                *t = (offset / direction).abs();
            }
        }
    }

    /// Writes the rows at which the rays of `range` meet `height` to `tops` or `bottoms`.
    fn find_rows(&mut self, height: f64, range: &Range<u32>, is_top: bool) {
        let ColumnMemory { t, bottoms, tops, .. } = &mut self.memory.columns;
        let range = range.start as usize..range.end as usize;
        let rows = if is_top { tops } else { bottoms };
        let rise: RelativeHeight = self.scene.projection.relative_height(height);
        self.scene.projection.rows_of(rise, &t[range.clone()], &mut rows[range]);
    }

    /// Shows the floor and the ceiling of the sector in `range` up to the distances `t`, and removes their rows
    /// from the clip ranges. The rays leave the sector there, or meet an object in it.
    fn close(&mut self, visit: &Visit, sector: &Sector, range: Range<u32>) {
        let projection = self.scene.projection;
        let (eye, ground) = (projection.eye(), projection.first_row_of_ground());
        if self.has_things {
            self.add_part(visit, sector, range.clone(), None);
        }
        // At the height of a plane, the eye sees the point of the plane at its own position.
        let shows_floor = eye >= sector.bottom;
        let shows_ceiling = eye <= sector.top;
        if shows_floor {
            self.find_rows(sector.bottom, &range, false);
        }
        if sector.top == f64::INFINITY {
            // Above the horizon, there is only sky.
            self.memory.columns.tops[range.start as usize..range.end as usize].fill(ground);
        } else if shows_ceiling {
            self.find_rows(sector.top, &range, true);
        }
        let is_everything = visit.is_at_camera
            && range.len() == projection.columns()
            && sector.holds != GapObject::Standing;
        let [floor, ceiling] = self.looks_of_planes(visit, sector, &range);
        let sides =
            [(PlaneSide::Floor, floor, shows_floor), (PlaneSide::Ceiling, ceiling, shows_ceiling)];
        for (side, look, is_shown) in sides {
            if is_shown && !(is_everything && self.show_behind(sector, side, look)) {
                self.add_plane(visit, sector, &range, (side, look));
            }
        }
        if visit.bounces == 0 {
            self.extend_distances(&range);
        }
        let indices = range.start as usize..range.end as usize;
        let ColumnMemory { starts, ends, from, t, bottoms, tops, .. } = &mut self.memory.columns;
        if shows_floor {
            for (end, bottom) in ends[indices.clone()].iter_mut().zip(&bottoms[indices.clone()]) {
                *end = (*end).min(*bottom);
            }
        }
        if shows_ceiling {
            for (start, top) in starts[indices.clone()].iter_mut().zip(&tops[indices.clone()]) {
                *start = (*start).max(*top);
            }
        }
        from[indices.clone()].copy_from_slice(&t[indices]);
    }

    /// Extends the distances of the columns in `range` to `t`, if they have open rows. No billboard behind them
    /// is in view.
    fn extend_distances(&mut self, range: &Range<u32>) {
        let range = range.start as usize..range.end as usize;
        let ColumnMemory { starts, ends, t, .. } = &self.memory.columns;
        let rows = starts[range.clone()].iter().zip(&ends[range.clone()]);
        let distances = self.list.distances[range.clone()].iter_mut().zip(&t[range]);
        for ((distance, &t), (start, end)) in distances.zip(rows) {
            if start < end && t > *distance {
                *distance = t;
            }
        }
    }

    /// Adds the floor or the ceiling of the sector in `range`. Its rows are in `bottoms` or `tops`.
    fn add_plane(
        &mut self,
        visit: &Visit,
        sector: &Sector,
        range: &Range<u32>,
        (side, look): (PlaneSide, Option<PlaneSurface>),
    ) {
        let indices = range.start as usize..range.end as usize;
        let ColumnMemory { starts, ends, bottoms, tops, .. } = &self.memory.columns;
        let clips = starts[indices.clone()].iter().zip(&ends[indices.clone()]);
        match side {
            PlaneSide::Floor => {
                let rows = clips.zip(&bottoms[indices]);
                let rows =
                    rows.map(|((&start, &end), &bottom)| Rows { start: bottom.max(start), end });
                let plane = (PlaneKind::Floor(visit.sector), sector.bottom);
                self.list.add_plane(plane, look, visit.image, range, rows);
            }
            PlaneSide::Ceiling => {
                let rows = clips.zip(&tops[indices]);
                let rows = rows.map(|((&start, &end), &top)| Rows { start, end: top.min(end) });
                let plane = (PlaneKind::Ceiling(visit.sector), sector.top);
                self.list.add_plane(plane, look, visit.image, range, rows);
            }
        }
    }

    /// The looks of the floor and the ceiling along the rays of `range` in the sector, if they are the same in all
    /// cells that the rays may cross. They may differ in cells out of view.
    fn looks_of_planes(
        &self,
        visit: &Visit,
        sector: &Sector,
        range: &Range<u32>,
    ) -> [Option<PlaneSurface>; 2] {
        /// The most cells to compare. In more, the looks count as uneven.
        const MAX_CELLS: i64 = 1024;
        let sides = [PlaneSide::Floor, PlaneSide::Ceiling];
        let sectors = self.fan.sectors;
        let even = sides.map(|side| sectors.even_surface(visit.sector, side));
        if even.iter().all(Option::is_some) {
            return even;
        }
        let world = self.scene.world;
        let grid = world.grid();
        let Some([[west, east], [north, south]]) = self.cells_along(visit, sector, range) else {
            return even;
        };
        let [east, south] = [east.min(grid.width().into()), south.min(grid.height().into())];
        let [west, north] = [west.max(0), north.max(0)];
        if (east - west).saturating_mul(south - north) > MAX_CELLS {
            return even;
        }
        let (mut latest, mut looks) = (None, None);
        let mut are_even = [true; 2];
        let places = (north..south).flat_map(|row| (west..east).map(move |column| (column, row)));
        for (cell, tile) in places.filter_map(|(column, row)| grid.cell(column, row)) {
            let known = (tile, world.lamplight_in(cell));
            if latest.replace(known) == Some(known) || !sectors.of(tile).have(visit.sector) {
                continue;
            }
            let own = sectors.surfaces(world, visit.sector, tile);
            let own = own.map(|it| PlaneSurface { light: it.light.plus(known.1), ..it });
            let known = looks.get_or_insert(own);
            are_even = [0, 1].map(|side| are_even[side] && known[side] == own[side]);
            if are_even == [false; 2] {
                break;
            }
        }
        let look = |side: usize| looks.filter(|_| are_even[side]).map(|looks| looks[side]);
        [0, 1].map(|side| even[side].or_else(|| look(side)))
    }

    /// The columns and the rows of the cells that the rays of `range` may cross from the distances `from` to the
    /// distances `t`: on each axis, the first one and the one after the last. `None` if a distance is extreme.
    fn cells_along(
        &self,
        visit: &Visit,
        sector: &Sector,
        range: &Range<u32>,
    ) -> Option<[[i64; 2]; 2]> {
        /// A coordinate beyond all images of maps.
        const FAR: f64 = 1e9;
        /// Points this near to a cell may be looked up in it.
        const EPSILON: f64 = 1e-6;
        let origin = self.scene.projection.origin();
        let WalkMemory { borders, columns: ColumnMemory { from, t, .. }, .. } = &*self.memory;
        let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut add = |column: u32| {
            let direction = self.fan.directions.of(column);
            for t in [from[column as usize], t[column as usize]] {
                let point = origin + direction * t;
                (least, most) = (least.min(point), most.max(point));
            }
        };
        if sector.holds == GapObject::Standing {
            // The rays begin or end at an object, which may be round.
            range.clone().for_each(add);
        } else {
            // The other rays end on straight lines between these.
            for Border { columns, .. } in borders {
                add(columns.start);
                add(columns.end - 1);
            }
        }
        let are_near = least.cmpgt(DVec2::splat(-FAR)).all() && most.cmplt(DVec2::splat(FAR)).all();
        if !are_near {
            return None;
        }
        let ends = [(least - EPSILON).floor(), (most + EPSILON).floor()];
        let [first, last] = ends.map(|it| visit.image.cell_to_map([it.x as i64, it.y as i64]));
        Some([0, 1].map(|axis| [first[axis].min(last[axis]), first[axis].max(last[axis]) + 1]))
    }

    /// Makes the floor or the ceiling of the camera's sector a backdrop, if it has one colour or is a sky
    /// without texels. Returns whether it does.
    fn show_behind(
        &mut self,
        sector: &Sector,
        side: PlaneSide,
        look: Option<PlaneSurface>,
    ) -> bool {
        let Some(surface) = look else { return false };
        let backdrop = match surface.covering.map(|covering| covering.pattern) {
            Some(Pattern::Plain(Paint::Color(color))) => {
                let height = if side == PlaneSide::Floor { sector.bottom } else { sector.top };
                Some(Backdrop::Color { color, light: surface.light, height })
            }
            None if matches!(self.scene.world.sky(), Sky::Gradient(_)) => Some(Backdrop::Sky),
            _ => None,
        };
        self.list.backdrops[side as usize] = backdrop;
        backdrop.is_some()
    }

    /// Adds the parts of the rays in `range` up to the distances `t`, in which billboards may show.
    fn add_part(
        &mut self,
        visit: &Visit,
        sector: &Sector,
        range: Range<u32>,
        top_below: Option<f64>,
    ) {
        let first_corner = self.list.corners.len();
        if sector.holds == GapObject::Standing {
            // The rays begin or end at an object, which may be round.
            self.list.corners.extend(range.clone());
        } else {
            for Border { columns, .. } in &self.memory.borders {
                self.list.corners.push(columns.start);
                if columns.len() > 1 {
                    self.list.corners.push(columns.end - 1);
                }
            }
        }
        let corners = first_corner..self.list.corners.len();
        let ColumnMemory { starts, ends, from, t, .. } = &self.memory.columns;
        let first = self.list.stretches.len();
        self.list.stretches.extend(range.clone().map(|column| {
            let x = column as usize;
            let rows = Rows { start: starts[x], end: ends[x] };
            RaySegment { rows, from: from[x], to: t[x] }
        }));
        self.list.passed.push(Layer::Part(RayPart {
            columns: range,
            first,
            corners,
            sector: visit.sector,
            top_below,
            image: visit.image,
        }));
    }

    /// Shows the surfaces at the faces through which the rays leave the sector, and stores the visits behind
    /// them.
    fn pass_borders(&mut self, visit: &Visit, sector: &Sector) {
        let mut first = 0;
        while first < self.memory.borders.len() {
            let borders = &self.memory.borders;
            let look = self.look_of_border(visit, &borders[first]);
            let is_other =
                |&index: &usize| !self.continues(visit, (&borders[first], &look), &borders[index]);
            let end = (first + 1..borders.len()).find(is_other).unwrap_or(borders.len());
            let group = &BorderGroup {
                borders: first..end,
                columns: borders[first].columns.start..borders[end - 1].columns.end,
                face: borders[first].face,
            };
            match borders[first].into {
                Some((_, id)) => self.meet(visit, sector, group, id),
                None => self.meet_edge(visit, sector, group),
            }
            first = end;
        }
        for slot in [VisitKind::Lower, VisitKind::Upper, VisitKind::Mirror] {
            self.store(slot);
        }
    }

    /// Returns true if `other` continues the face at `one` to the right: in one line, with the same tile, jamb and
    /// light.
    fn continues(
        &self,
        visit: &Visit,
        (one, (light, jamb)): (&Border, &BorderLook),
        other: &Border,
    ) -> bool {
        let tile = |border: &Border| border.into.map(|(_, tile)| tile);
        let stands = |id: TileId| self.fan.sectors.held_by(id) == GapObject::Standing;
        one.face.is_in_line_with(&other.face)
            && tile(one) == tile(other)
            && !tile(one).is_some_and(stands)
            && light.is_even()
            && self.look_of_border(visit, other) == (*light, *jamb)
    }

    /// The light on the face at `border`, and its paint if it is the jamb of a door.
    fn look_of_border(&self, visit: &Visit, border: &Border) -> BorderLook {
        let has_jambs = self.scene.plan.walls.jambs;
        let jamb = if has_jambs { self.jamb(visit, &border.face) } else { None };
        (self.light_on_face(visit, border), jamb)
    }

    /// Shows the surfaces beyond the edge of the map: the side of the ground if the sector's floor is lower,
    /// the sky, and the ground below the horizon.
    fn meet_edge(&mut self, visit: &Visit, sector: &Sector, group: &BorderGroup) {
        let ground = self.fan.sectors.get(SectorId::BEYOND).bottom;
        let range = &group.columns;
        if ground > sector.bottom {
            self.find_limits(sector, group, ground, f64::NEG_INFINITY);
            let material = Material::Opaque(self.scene.world.ground().riser);
            let heights = (sector.bottom, ground.min(sector.top));
            self.show_face(visit, group, material, heights);
        }
        self.find_limits(sector, group, f64::INFINITY, ground);
        let horizon = self.scene.projection.first_row_of_ground();
        let indices = range.start as usize..range.end as usize;
        let ColumnMemory { starts, ends, bottoms, .. } = &self.memory.columns;
        let ends = || ends[indices.clone()].iter().zip(&bottoms[indices.clone()]);
        let clips =
            || starts[indices.clone()].iter().zip(ends().map(|(end, bottom)| end.min(bottom)));
        let above = clips().map(|(&start, &end)| Rows { start, end: end.min(horizon) });
        let below = clips().map(|(&start, &end)| Rows { start: start.max(horizon), end });
        let sky = (PlaneKind::Ceiling(SectorId::BEYOND), f64::INFINITY);
        let ground = (PlaneKind::Floor(SectorId::BEYOND), ground);
        let look = |side| self.fan.sectors.even_surface(SectorId::BEYOND, side);
        let [look_of_sky, look] = [PlaneSide::Ceiling, PlaneSide::Floor].map(look);
        self.list.add_plane(sky, look_of_sky, visit.image, range, above);
        self.list.add_plane(ground, look, visit.image, range, below);
    }

    /// Shows the solid parts of the cells of the tile `id` behind `group`, and prepares the visits to their
    /// gaps.
    fn meet(&mut self, visit: &Visit, sector: &Sector, group: &BorderGroup, id: TileId) {
        let tile = &self.scene.world.tiles()[usize::from(id.0)];
        let TileSectors { lower, upper } = self.fan.sectors.of(id);
        let gap = self.fan.sectors.get(lower);
        if gap.bottom > sector.bottom {
            self.add_solid_part(visit, sector, group, (tile, gap.bottom));
        }
        if gap.overlaps(sector) {
            self.open(visit, sector, group, (VisitKind::Lower, lower, tile));
        }
        let Some(upper) = upper else { return };
        let above = self.fan.sectors.get(upper);
        let (bottom, top) = (gap.top.max(sector.bottom), above.bottom.min(sector.top));
        if bottom < top {
            self.find_limits(sector, group, above.bottom, gap.top);
            self.show_face(visit, group, Material::Opaque(tile.lintel), (bottom, top));
        }
        if above.overlaps(sector) {
            self.open(visit, sector, group, (VisitKind::Upper, upper, tile));
        }
    }

    /// Writes the rows of `group` between two heights to `tops` and `bottoms`. A height outside `sector` leaves
    /// all rows or none.
    fn find_limits(&mut self, sector: &Sector, group: &BorderGroup, top: f64, bottom: f64) {
        let range = &group.columns;
        let indices = range.start as usize..range.end as usize;
        if sector.is_inside(top) {
            self.find_rows(top, range, true);
        } else {
            let everything = if top >= sector.top { 0 } else { u32::MAX };
            self.memory.columns.tops[indices.clone()].fill(everything);
        }
        if sector.is_inside(bottom) {
            self.find_rows(bottom, range, false);
        } else {
            let everything = if bottom <= sector.bottom { u32::MAX } else { 0 };
            self.memory.columns.bottoms[indices].fill(everything);
        }
    }

    /// Shows the solid part of `tile` up to `top` behind `group`, as a face or as a mirror.
    fn add_solid_part(
        &mut self,
        visit: &Visit,
        sector: &Sector,
        group: &BorderGroup,
        (tile, top): (&Tile, f64),
    ) {
        self.find_limits(sector, group, top, f64::NEG_INFINITY);
        let paint = match tile.kind {
            TileKind::Mirror(tint) if !tint.is_opaque() && visit.bounces < MAX_BOUNCES => {
                self.reflect(visit, group, tint);
                return;
            }
            _ => self.paint_of_rock(visit, group, tile),
        };
        let heights = (sector.bottom, top.min(sector.top));
        self.show_face(visit, group, Material::Opaque(paint), heights);
    }

    /// The paint of the sides of `tile`.
    fn paint_of_rock(&self, visit: &Visit, group: &BorderGroup, tile: &Tile) -> Paint {
        match tile.kind {
            TileKind::Wall(_) if self.scene.plan.walls.jambs => {
                self.jamb(visit, &group.face).unwrap_or(tile.riser)
            }
            _ => tile.riser,
        }
    }

    /// The paint of a wall that faces a door: the door's jamb.
    fn jamb(&self, visit: &Visit, face: &CellFace) -> Option<Paint> {
        let (_, before) = self.cell_before(visit, face)?;
        match self.scene.world.tiles()[usize::from(before.0)].kind {
            TileKind::Door(door) | TileKind::Doorway(door) => Some(door.jamb),
            _ => None,
        }
    }

    /// The cell from which the rays come to `face`, and its tile.
    fn cell_before(&self, visit: &Visit, face: &CellFace) -> Option<(Cell, TileId)> {
        let [column, row] = visit.image.cell_to_map(face.place_before());
        self.scene.world.grid().cell(column, row)
    }

    /// Shows the tint of a mirror, and prepares the visit to the mirror image in the rows of the mirror.
    fn reflect(&mut self, visit: &Visit, group: &BorderGroup, tint: Glass) {
        if !tint.is_clear() {
            let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
            self.show_face(visit, group, Material::Translucent(tint), everywhere);
        }
        let face = group.face;
        let mut image = visit.image;
        _ = image.reflect(face.side, face.line(), 0);
        self.list.add_image(image);
        let ColumnMemory { starts, ends, tops, .. } = &self.memory.columns;
        let rows = &mut self.memory.next[VisitKind::Mirror as usize].rows;
        for x in group.columns.start as usize..group.columns.end as usize {
            rows[x] = Rows { start: starts[x].max(tops[x]), end: ends[x] };
            self.stats.bounces += u64::from(!rows[x].is_empty());
        }
        let bounces = visit.bounces + 1;
        self.extend(VisitKind::Mirror, visit.sector, (image, bounces), group);
    }

    /// Prepares the visit to a gap of the cells of `tile` behind `group`, if it has open rows.
    fn open(
        &mut self,
        visit: &Visit,
        sector: &Sector,
        group: &BorderGroup,
        (slot, id, tile): (VisitKind, SectorId, &Tile),
    ) {
        let gap = self.fan.sectors.get(id);
        self.find_limits(sector, group, gap.top, gap.bottom);
        let ColumnMemory { starts, ends, tops, bottoms, .. } = &self.memory.columns;
        let rows = &mut self.memory.next[slot as usize].rows;
        let mut is_seen = false;
        for x in group.columns.start as usize..group.columns.end as usize {
            rows[x] = Rows { start: starts[x].max(tops[x]), end: ends[x].min(bottoms[x]) };
            is_seen |= !rows[x].is_empty();
        }
        if !is_seen {
            return;
        }
        if let GapObject::Cube(_) = gap.holds {
            self.pass_cube(visit, group, slot, tile);
        }
        self.extend(slot, id, (visit.image, visit.bounces), group);
    }

    /// Shows the face of the glass or the mask behind `group`, in the rows of the next visit.
    fn pass_cube(&mut self, visit: &Visit, group: &BorderGroup, slot: VisitKind, tile: &Tile) {
        let (bottom, top) = (tile.heights.floor(), tile.heights.ceiling());
        let material = match tile.kind {
            TileKind::Glass(glass) if glass.is_clear() => return,
            TileKind::Glass(glass) if glass.is_opaque() => {
                Material::Opaque(Paint::Color(glass.color))
            }
            TileKind::Glass(glass) => Material::Translucent(glass),
            TileKind::Mask(texture) => Material::Masked(texture),
            _ => return,
        };
        self.find_rows(bottom, &group.columns, false);
        self.find_rows(top, &group.columns, true);
        let indices = group.columns.start as usize..group.columns.end as usize;
        let rows = &mut self.memory.next[slot as usize].rows;
        let ColumnMemory { tops, bottoms, .. } = &mut self.memory.columns;
        for x in indices {
            tops[x] = tops[x].max(rows[x].start);
            bottoms[x] = bottoms[x].min(rows[x].end);
            if matches!(material, Material::Opaque(_)) && tops[x] < bottoms[x] {
                rows[x].end = tops[x];
            }
        }
        self.show_face(visit, group, material, (bottom, top));
    }

    /// Adds a face at `group` in the rows between `tops` and `bottoms`.
    fn show_face(
        &mut self,
        visit: &Visit,
        group: &BorderGroup,
        material: Material,
        (bottom, top): (f64, f64),
    ) {
        let BorderGroup { columns: range, face, .. } = group;
        for border in &self.memory.borders[group.borders.clone()] {
            find_texture_coordinates(visit.image, &self.fan, border, &mut self.memory.columns);
        }
        let first = self.list.face_columns.len();
        self.list.face_columns.extend(self.memory.columns.of_face(range));
        self.list.push_face(Face {
            columns: range.clone(),
            first,
            facing: Facing::Side(face.side),
            material,
            light: self.light_on_face(visit, &self.memory.borders[group.borders.start]),
            bottom,
            top,
            image: visit.image,
        });
    }

    /// The light on the face at `border`: the light of its tile if it is solid and has its own, else the light
    /// in the cell in front of the face.
    fn light_on_face(&self, visit: &Visit, border: &Border) -> FaceLight {
        let world = self.scene.world;
        if !self.scene.plan.walls.faded {
            return FaceLight::FULL;
        }
        let tile = border.into.map(|(_, id)| &world.tiles()[usize::from(id.0)]);
        let is_solid = |tile: &&Tile| !matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
        if let Some(own) = tile.filter(is_solid).and_then(|tile| tile.light) {
            return FaceLight::even(own);
        }
        let Some((before, _)) = self.cell_before(visit, &border.face) else {
            return FaceLight::FULL;
        };
        let is_door = tile.is_some_and(|tile| matches!(tile.kind, TileKind::Door(_)));
        match border.into {
            // The step below a door has the same light everywhere, like the door's leaf.
            Some((cell, _)) if !is_door => world.face_light(cell, before),
            _ => FaceLight::even(world.light_in(before)),
        }
    }

    /// Extends the visit in `slot` by the cells behind `group`. If they do not continue that visit, it is
    /// stored and another one begins.
    fn extend(
        &mut self,
        slot: VisitKind,
        sector: SectorId,
        (image, bounces): (MirrorTransform, u32),
        group: &BorderGroup,
    ) {
        let BorderGroup { columns: range, face, .. } = group;
        let holds = self.fan.sectors.get(sector).holds;
        let goes_on = |(visit, of_visit): &(Visit, CellFace)| {
            (visit.sector, visit.image) == (sector, image)
                && visit.columns.end == range.start
                && of_visit.is_in_line_with(face)
                && holds != GapObject::Standing
        };
        if !self.memory.next[slot as usize].visit.as_ref().is_some_and(goes_on) {
            self.store(slot);
        }
        let WalkMemory { next, borders, .. } = &mut *self.memory;
        let PendingVisit { visit, entries, .. } = &mut next[slot as usize];
        entries.extend(
            borders[group.borders.clone()].iter().map(|border| SectorEntry {
                column: border.columns.start,
                place: border.face.place,
            }),
        );
        if let Some((visit, _)) = visit {
            visit.columns.end = range.end;
            return;
        }
        let (columns, is_at_camera) = (range.clone(), false);
        let (first_clip, first_entry) = (0, 0);
        let new = Visit { sector, image, bounces, is_at_camera, columns, first_clip, first_entry };
        *visit = Some((new, *face));
    }

    /// Stores the visit in `slot`, without the columns that have no open rows.
    fn store(&mut self, slot: VisitKind) {
        let WalkMemory { visits, clips, entries, next, columns, .. } = &mut *self.memory;
        let PendingVisit { visit, rows, entries: of_visit } = &mut next[slot as usize];
        let Some((visit, _)) = visit.take() else { return };
        let is_open = |&column: &u32| !rows[column as usize].is_empty();
        let mut rest = visit.columns.clone();
        while let Some(start) = rest.clone().find(is_open) {
            let end = (start..rest.end).find(|column| !is_open(column)).unwrap_or(rest.end);
            rest.start = end;
            let first_clip = clips.len();
            clips.extend(
                (start as usize..end as usize).map(|x| Clip { rows: rows[x], from: columns.t[x] }),
            );
            let first_entry = entries.len();
            let first = of_visit.iter().rposition(|entry| entry.column <= start).unwrap_or(0);
            let here = of_visit[first..].iter().take_while(|entry| entry.column < end);
            entries.extend(here);
            visits.push(Visit { columns: start..end, first_clip, first_entry, ..visit.clone() });
        }
        of_visit.clear();
    }

    /// Shows the object in the cell at `place` along the straight rays. The rows above the object remain open.
    fn meet_standing(&mut self, visit: &Visit, sector: &Sector, place: [i64; 2]) {
        let world = self.scene.world;
        let [column, row] = visit.image.cell_to_map(place);
        let Some((cell, id)) = world.grid().cell(column, row) else { return };
        let tile = &world.tiles()[usize::from(id.0)];
        let WalkMemory { columns, passages, .. } = &mut *self.memory;
        passages.clear();
        passages.extend(visit.columns.clone().map(|column| {
            let direction = self.fan.directions.of(column);
            let ray = on_map(visit.image, self.scene.projection.origin(), direction);
            let passage = Intersection::of_tile(&ray, world, cell, tile.kind);
            // After a reflection in this cell, the ray starts at the mirror. An earlier hit is not on its path.
            let is_before_mirror =
                |hit: Hit| visit.bounces > 0 && hit.t < columns.from[column as usize];
            if passage.hit.is_some_and(is_before_mirror) { Intersection::NONE } else { passage }
        }));
        let first = visit.columns.start;
        let at = |walk: &Self, column: u32| walk.memory.passages[(column - first) as usize];
        let mut rest = visit.columns.clone();
        while let Some(start) = rest.clone().find(|&column| at(self, column).hit.is_some()) {
            let side = at(self, start).hit.map(|hit| hit.side);
            let is_other = |&column: &u32| at(self, column).hit.map(|hit| hit.side) != side;
            let end = (start..rest.end).find(is_other).unwrap_or(rest.end);
            rest.start = end;
            self.meet_side(visit, sector, start..end, (cell, tile));
        }
        let mut rest = visit.columns.clone();
        let is_seen = |walk: &Self, column: u32| {
            let ColumnMemory { starts, ends, from, .. } = &walk.memory.columns;
            let x = column as usize;
            at(walk, column).end.is_some_and(|end| from[x] <= end) && starts[x] < ends[x]
        };
        if self.scene.projection.eye() <= tile.top_of_what_stands() {
            return;
        }
        while let Some(start) = rest.clone().find(|&column| is_seen(self, column)) {
            let end = (start..rest.end).find(|&column| !is_seen(self, column)).unwrap_or(rest.end);
            rest.start = end;
            self.look_down_at(visit, sector, start..end, (id, tile.top_of_what_stands()));
        }
    }

    /// Shows the face of a leaf or a shape that all rays of `range` hit.
    fn meet_side(
        &mut self,
        visit: &Visit,
        sector: &Sector,
        range: Range<u32>,
        (cell, tile): (Cell, &Tile),
    ) {
        let (world, projection) = (self.scene.world, self.scene.projection);
        let first = visit.columns.start;
        let WalkMemory { columns, passages, .. } = &mut *self.memory;
        for column in range.clone() {
            let hit = passages[(column - first) as usize].hit;
            columns.t[column as usize] = hit.map_or(0.0, |hit| hit.t);
        }
        self.close(visit, sector, range.clone());
        let WalkMemory { columns, passages, .. } = &mut *self.memory;
        let hits = range.clone().filter_map(|column| passages[(column - first) as usize].hit);
        let Some(hit) = hits.clone().next() else { return };
        let (paint, facing, before) = match tile.kind {
            // A leaf takes its light from the cell in front, on the side from which the rays come.
            TileKind::Door(door) => {
                let direction = self.fan.directions.of(range.start);
                let direction = visit.image.direction_to_map(direction);
                let before = cell_in_front(world.grid(), direction, &hit);
                (door.leaf, Facing::Side(hit.side), before.map(|(cell, _)| cell))
            }
            // A shape takes its light from its own cell.
            TileKind::Shape(it) => (it.paint, Facing::of_shape(it.outline, cell), Some(cell)),
            _ => return,
        };
        let light = match (self.scene.plan.walls.faded, tile.light, before) {
            (false, ..) | (true, None, None) => FaceLight::FULL,
            (true, Some(own), _) => FaceLight::even(own),
            (true, None, Some(before)) => FaceLight::even(world.light_in(before)),
        };
        let (bottom, top) = (tile.heights.floor(), tile.top_of_what_stands());
        let face = Face {
            columns: range.clone(),
            first: self.list.face_columns.len(),
            facing,
            material: Material::Opaque(paint),
            light,
            bottom,
            top,
            image: visit.image,
        };
        let shown = range.zip(hits).map(|(column, Hit { t, u, .. })| {
            let x = column as usize;
            let above = projection.row_of_height(top, t);
            let start = columns.starts[x].max(above);
            let end = columns.ends[x].min(projection.row_of_height(bottom, t));
            columns.ends[x] = columns.ends[x].min(above);
            FaceColumn { rows: Rows { start, end }, t, u }
        });
        self.list.face_columns.extend(shown);
        self.list.push_face(face);
    }

    /// Shows the top of a pillar of the tile `id`, as the rays of `range` see it from above.
    fn look_down_at(
        &mut self,
        visit: &Visit,
        sector: &Sector,
        range: Range<u32>,
        (id, top): (TileId, f64),
    ) {
        let (world, projection) = (self.scene.world, self.scene.projection);
        let first = visit.columns.start;
        let WalkMemory { columns, passages, .. } = &mut *self.memory;
        for column in range.clone() {
            let end = passages[(column - first) as usize].end;
            columns.t[column as usize] = end.unwrap_or_default();
        }
        // Things on the top are in front of it.
        if self.has_things {
            self.add_part(visit, sector, range.clone(), Some(top));
        }
        if visit.bounces == 0 {
            self.extend_distances(&range);
        }
        let ColumnMemory { starts, ends, from, t, .. } = &mut self.memory.columns;
        let rows = range.clone().map(|column| {
            let x = column as usize;
            from[x] = t[x];
            let end = ends[x];
            ends[x] = projection.row_of_height(top, t[x]).clamp(starts[x], end);
            Rows { start: ends[x], end }
        });
        let look = PlaneSurface::of_top(&world.tiles()[usize::from(id.0)]);
        let look = Some(look).filter(|_| !world.has_lamplight());
        self.list.add_plane((PlaneKind::Top(id), top), look, visit.image, &range, rows);
    }
}

/// Finds the texture coordinates at which the rays meet `border` in this image.
fn find_texture_coordinates(
    image: MirrorTransform,
    fan: &Fan<'_>,
    border: &Border,
    columns: &mut ColumnMemory,
) {
    let Border { columns: range, face, .. } = border;
    let origin = fan.scene.projection.origin();
    let corner = face.corner();
    let is_mirrored = image.is_mirrored_along(face.side);
    let direction = image.direction_to_map(fan.directions.of(range.start));
    let is_from_left = is_from_left(direction, face.side);
    let coordinate = |along: f64| texture_coordinate(along, is_mirrored, is_from_left);
    let indices = range.start as usize..range.end as usize;
    let across = &fan.directions.across(face.side.other())[indices.clone()];
    let ColumnMemory { t, u, .. } = columns;
    let other = face.side.other() as usize;
    let start = -(corner[other] - origin[other]);
    // Even across the largest map, the error is far less than a texel.
    for (u, (t, across)) in u[indices.clone()].iter_mut().zip(t[indices].iter().zip(across)) {
        *u = coordinate(start + t * across);
    }
}

/// The texture coordinate of a point `along` cells from the north or west end of a face, seen along the
/// straight rays.
#[inline]
fn texture_coordinate(along: f64, is_mirrored: bool, is_from_left: bool) -> f64 {
    let along = along.clamp(0.0, 1.0);
    from_left(if is_mirrored { 1.0 - along } else { along }, is_from_left)
}
