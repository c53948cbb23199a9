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

use std::iter::zip;
use std::mem;
use std::ops::Range;

use glam::DVec2;

use super::draw_list::{Backdrop, DrawList, Layer, PlaneKind, RayPart, RaySegment};
use super::face::{CellFace, Face, FaceColumn, Facing, Material, Rows, cell_in_front, on_map};
use super::fan::{Border, Fan, FanMemory, RayStarts, SectorEntry};
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
    columns: Range<usize>,
    /// The index of the first column's clip, and of the first entry. The others follow. A visit at the camera has
    /// no clips, because all rows are open.
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
    /// The row of a top and the row of a bottom at this distance.
    tops: Vec<u32>,
    bottoms: Vec<u32>,
    /// The passage of the ray through the cell of an object.
    passages: Vec<Intersection>,
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
    columns: Range<usize>,
    /// The face of the first border.
    face: CellFace,
    look: BorderLook,
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
    /// The rows of `range` that no nearer surface covers.
    #[inline]
    fn open(&self, range: &Range<usize>) -> impl Iterator<Item = Rows> {
        zip(&self.starts[range.clone()], &self.ends[range.clone()])
            .map(|(&start, &end)| Rows { start, end })
    }

    /// The open rows of `range` between `tops` and `bottoms`.
    #[inline]
    fn shown(&self, range: &Range<usize>) -> impl Iterator<Item = Rows> {
        let limits = zip(&self.tops[range.clone()], &self.bottoms[range.clone()]);
        zip(self.open(range), limits).map(|(open, (&start, &end))| open.and(Rows { start, end }))
    }
}

/// Takes the first columns from `rest`: all up to the first with another `value`. Returns `None` if there is none.
#[inline]
fn next_run<T: PartialEq>(
    rest: &mut Range<usize>,
    value: impl Fn(usize) -> T,
) -> Option<(Range<usize>, T)> {
    let start = rest.next()?;
    let of_run = value(start);
    let end = rest.clone().find(|&x| value(x) != of_run).unwrap_or(rest.end);
    rest.start = end;
    Some((start..end, of_run))
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
        self.fan.clear();
        self.fan.reserve(width);
        let ColumnMemory { starts, ends, from, t, u, tops, bottoms, passages } = &mut self.columns;
        for rows in [starts, ends, tops, bottoms] {
            rows.resize(width, 0);
        }
        for distances in [from, t, u] {
            distances.resize(width, 0.0);
        }
        passages.resize(width, Intersection::NONE);
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
        let mut rest = 0..projection.columns();
        while let Some((columns, _)) = next_run(&mut rest, |x| {
            let DVec2 { x, y } = self.fan.directions.of(x);
            (!is_one_cell).then_some([x > 0.0, x < 0.0, y > 0.0, y < 0.0])
        }) {
            let ray = Ray::of_camera(origin, self.fan.directions.of(columns.start));
            let course = Course::new(grid, &ray);
            let tile = course.cell(grid).map(|(_, tile)| tile);
            let WalkMemory { visits, clips, entries, .. } = &mut *self.memory;
            let (first_clip, first_entry) = (clips.len(), entries.len());
            entries.push(SectorEntry { column: columns.start, place: course.place() });
            visits.push(Visit {
                sector: self.fan.sectors.of_eye(tile, projection.eye()),
                image: MirrorTransform::default(),
                bounces: 0,
                is_at_camera: true,
                columns,
                first_clip,
                first_entry,
            });
        }
    }

    fn follow_all(&mut self) {
        while let Some(visit) = self.memory.visits.pop() {
            self.follow(&visit);
        }
    }

    fn follow(&mut self, visit: &Visit) {
        self.stats.sectors += 1;
        let WalkMemory { clips, entries, columns, fan, borders, .. } = &mut *self.memory;
        let range = &visit.columns;
        if visit.is_at_camera {
            columns.starts[range.clone()].fill(0);
            columns.ends[range.clone()].fill(self.scene.projection.rows());
            columns.from[range.clone()].fill(0.0);
        }
        let rows = zip(&mut columns.starts[range.clone()], &mut columns.ends[range.clone()]);
        let places = zip(rows, &mut columns.from[range.clone()]);
        for (((start, end), from), clip) in zip(places, &clips[visit.first_clip..]) {
            (*start, *end, *from) = (clip.rows.start, clip.rows.end, clip.from);
        }
        clips.truncate(visit.first_clip);
        let view = RayStarts {
            sector: visit.sector,
            image: visit.image,
            entries: &entries[visit.first_entry..],
            is_at_camera: visit.is_at_camera,
        };
        self.fan.find(view, range.clone(), fan, borders);
        let first_place = view.entries[0].place;
        entries.truncate(visit.first_entry);
        let sector = self.fan.sectors.get(visit.sector);
        if sector.holds == GapObject::Standing {
            self.meet_standing(visit, sector, first_place);
        }
        self.find_distances();
        self.close(visit, sector, range);
        self.pass_borders(visit, sector);
    }

    /// Finds the distances at which the rays leave the sector.
    fn find_distances(&mut self) {
        let origin = self.scene.projection.origin();
        let WalkMemory { borders, columns, .. } = &mut *self.memory;
        for Border { columns: range, face, .. } in &*borders {
            let offset = face.line() as f64 - origin[face.side as usize];
            let across = &self.fan.directions.across(face.side)[range.clone()];
            for (t, direction) in zip(&mut columns.t[range.clone()], across) {
                *t = (offset / direction).abs();
            }
        }
    }

    /// Writes the rows at which the rays of `range` meet `height` to `tops`.
    fn find_tops(&mut self, height: f64, range: &Range<usize>) {
        let ColumnMemory { t, tops, .. } = &mut self.memory.columns;
        self.scene.projection.rows_of(height, &t[range.clone()], &mut tops[range.clone()]);
    }

    /// Writes the same rows to `bottoms`.
    fn find_bottoms(&mut self, height: f64, range: &Range<usize>) {
        let ColumnMemory { t, bottoms, .. } = &mut self.memory.columns;
        self.scene.projection.rows_of(height, &t[range.clone()], &mut bottoms[range.clone()]);
    }

    /// Shows the floor and the ceiling of the sector in `range` up to the distances `t`, and removes their rows
    /// from the clip ranges. The rays leave the sector there, or meet an object in it.
    fn close(&mut self, visit: &Visit, sector: &Sector, range: &Range<usize>) {
        let projection = self.scene.projection;
        let eye = projection.eye();
        if self.has_things {
            self.add_part(visit, sector, range, None);
        }
        let is_everything = visit.is_at_camera
            && range.len() == projection.columns()
            && sector.holds != GapObject::Standing;
        let [floor, ceiling] = self.looks_of_planes(visit, sector, range);
        if visit.bounces == 0 {
            self.extend_distances(range);
        }
        // At the height of a plane, the eye sees the point of the plane at its own position.
        if eye >= sector.bottom {
            self.find_bottoms(sector.bottom, range);
            if !(is_everything && self.show_behind(sector, PlaneSide::Floor, floor)) {
                let ColumnMemory { bottoms, .. } = &self.memory.columns;
                let rows = zip(self.memory.columns.open(range), &bottoms[range.clone()]);
                let rows = rows.map(|(open, &row)| Rows { start: open.start.max(row), ..open });
                let plane = (PlaneKind::Floor(visit.sector), sector.bottom);
                self.list.add_plane(plane, floor, visit.image, range, rows);
            }
            let ColumnMemory { ends, bottoms, .. } = &mut self.memory.columns;
            for (end, bottom) in zip(&mut ends[range.clone()], &bottoms[range.clone()]) {
                *end = (*end).min(*bottom);
            }
        }
        if eye <= sector.top {
            if sector.top == f64::INFINITY {
                // Above the horizon, there is only sky.
                self.memory.columns.tops[range.clone()].fill(projection.first_row_of_ground());
            } else {
                self.find_tops(sector.top, range);
            }
            if !(is_everything && self.show_behind(sector, PlaneSide::Ceiling, ceiling)) {
                let ColumnMemory { tops, .. } = &self.memory.columns;
                let rows = zip(self.memory.columns.open(range), &tops[range.clone()]);
                let rows = rows.map(|(open, &row)| Rows { end: open.end.min(row), ..open });
                let plane = (PlaneKind::Ceiling(visit.sector), sector.top);
                self.list.add_plane(plane, ceiling, visit.image, range, rows);
            }
            let ColumnMemory { starts, tops, .. } = &mut self.memory.columns;
            for (start, top) in zip(&mut starts[range.clone()], &tops[range.clone()]) {
                *start = (*start).max(*top);
            }
        }
        let ColumnMemory { from, t, .. } = &mut self.memory.columns;
        from[range.clone()].copy_from_slice(&t[range.clone()]);
    }

    /// Extends the distances of the columns in `range` to `t`, if they have open rows. No billboard behind them
    /// is in view.
    fn extend_distances(&mut self, range: &Range<usize>) {
        let columns = &self.memory.columns;
        let distances = zip(&mut self.list.distances[range.clone()], &columns.t[range.clone()]);
        for ((distance, &t), rows) in zip(distances, columns.open(range)) {
            if !rows.is_empty() && t > *distance {
                *distance = t;
            }
        }
    }

    /// The looks of the floor and the ceiling along the rays of `range` in the sector, if they are the same in all
    /// cells that the rays may cross. They may differ in cells out of view.
    fn looks_of_planes(
        &self,
        visit: &Visit,
        sector: &Sector,
        range: &Range<usize>,
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
        range: &Range<usize>,
    ) -> Option<[[i64; 2]; 2]> {
        /// A coordinate beyond all images of maps.
        const FAR: f64 = 1e9;
        /// Points this near to a cell may be looked up in it.
        const EPSILON: f64 = 1e-6;
        let origin = self.scene.projection.origin();
        let WalkMemory { borders, columns: ColumnMemory { from, t, .. }, .. } = &*self.memory;
        let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut add = |x: usize| {
            let direction = self.fan.directions.of(x);
            for t in [from[x], t[x]] {
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
        range: &Range<usize>,
        top_below: Option<f64>,
    ) {
        let DrawList { corners, stretches, passed, .. } = &mut *self.list;
        let (first_corner, first) = (corners.len(), stretches.len());
        if sector.holds == GapObject::Standing {
            // The rays begin or end at an object, which may be round.
            corners.extend(range.clone());
        } else {
            for Border { columns, .. } in &self.memory.borders {
                corners.push(columns.start);
                if columns.len() > 1 {
                    corners.push(columns.end - 1);
                }
            }
        }
        let columns = &self.memory.columns;
        let ends = zip(&columns.from[range.clone()], &columns.t[range.clone()]);
        let parts = zip(columns.open(range), ends);
        stretches.extend(parts.map(|(rows, (&from, &to))| RaySegment { rows, from, to }));
        passed.push(Layer::Part(RayPart {
            columns: range.clone(),
            first,
            corners: first_corner..corners.len(),
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
                look,
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
        if ground > sector.bottom {
            self.find_limits(sector, group, ground, f64::NEG_INFINITY);
            let material = Material::Opaque(self.scene.world.ground().riser);
            self.show_face(visit, group, material, (sector.bottom, ground.min(sector.top)));
        }
        self.find_limits(sector, group, f64::INFINITY, ground);
        let horizon = self.scene.projection.first_row_of_ground();
        let range = &group.columns;
        let shown = || self.memory.columns.shown(range);
        let above = shown().map(|rows| Rows { end: rows.end.min(horizon), ..rows });
        let below = shown().map(|rows| Rows { start: rows.start.max(horizon), ..rows });
        let sky = (PlaneKind::Ceiling(SectorId::BEYOND), f64::INFINITY);
        let ground = (PlaneKind::Floor(SectorId::BEYOND), ground);
        let look = |side| self.fan.sectors.even_surface(SectorId::BEYOND, side);
        self.list.add_plane(sky, look(PlaneSide::Ceiling), visit.image, range, above);
        self.list.add_plane(ground, look(PlaneSide::Floor), visit.image, range, below);
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
        if sector.is_inside(top) {
            self.find_tops(top, range);
        } else {
            let all = if top >= sector.top { 0 } else { u32::MAX };
            self.memory.columns.tops[range.clone()].fill(all);
        }
        if sector.is_inside(bottom) {
            self.find_bottoms(bottom, range);
        } else {
            let all = if bottom <= sector.bottom { u32::MAX } else { 0 };
            self.memory.columns.bottoms[range.clone()].fill(all);
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
            TileKind::Wall(_) => group.look.1.unwrap_or(tile.riser),
            _ => tile.riser,
        };
        let heights = (sector.bottom, top.min(sector.top));
        self.show_face(visit, group, Material::Opaque(paint), heights);
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
        let mut image = visit.image;
        _ = image.reflect(group.face.side, group.face.line(), 0);
        self.list.add_image(image);
        let rows = &mut self.memory.next[VisitKind::Mirror as usize].rows[group.columns.clone()];
        for (rows, shown) in zip(rows, self.memory.columns.shown(&group.columns)) {
            *rows = shown;
            self.stats.bounces += u64::from(!shown.is_empty());
        }
        let next = (visit.sector, image, visit.bounces + 1);
        self.extend(VisitKind::Mirror, next, group);
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
        let rows = &mut self.memory.next[slot as usize].rows[group.columns.clone()];
        let mut is_seen = false;
        for (rows, shown) in zip(rows, self.memory.columns.shown(&group.columns)) {
            *rows = shown;
            is_seen |= !shown.is_empty();
        }
        if !is_seen {
            return;
        }
        if let GapObject::Cube(_) = gap.holds {
            self.pass_cube(visit, group, slot, tile);
        }
        self.extend(slot, (id, visit.image, visit.bounces), group);
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
        self.find_tops(top, &group.columns);
        self.find_bottoms(bottom, &group.columns);
        let rows = &mut self.memory.next[slot as usize].rows;
        let ColumnMemory { tops, bottoms, .. } = &mut self.memory.columns;
        for x in group.columns.clone() {
            tops[x] = tops[x].max(rows[x].start);
            bottoms[x] = bottoms[x].min(rows[x].end);
            if matches!(material, Material::Opaque(_)) && tops[x] < bottoms[x] {
                rows[x].end = tops[x];
            }
        }
        self.show_face(visit, group, material, (bottom, top));
    }

    /// Adds a face at `group` in the open rows between `tops` and `bottoms`.
    fn show_face(
        &mut self,
        visit: &Visit,
        group: &BorderGroup,
        material: Material,
        (bottom, top): (f64, f64),
    ) {
        let range = &group.columns;
        for border in &self.memory.borders[group.borders.clone()] {
            find_texture_coordinates(visit.image, &self.fan, border, &mut self.memory.columns);
        }
        let first = self.list.face_columns.len();
        let columns = &self.memory.columns;
        let places = zip(&columns.t[range.clone()], &columns.u[range.clone()]);
        let of_face = zip(columns.shown(range), places);
        let of_face = of_face.map(|(rows, (&t, &u))| FaceColumn { rows, t, u });
        self.list.face_columns.extend(of_face);
        self.list.push_face(Face {
            columns: range.clone(),
            first,
            facing: Facing::Side(group.face.side),
            material,
            light: group.look.0,
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
        (sector, image, bounces): (SectorId, MirrorTransform, u32),
        group: &BorderGroup,
    ) {
        let BorderGroup { columns, face, .. } = group;
        let holds = self.fan.sectors.get(sector).holds;
        let goes_on = |(visit, of_visit): &(Visit, CellFace)| {
            (visit.sector, visit.image) == (sector, image)
                && visit.columns.end == columns.start
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
        let new = || {
            let (columns, is_at_camera) = (columns.clone(), false);
            let (first_clip, first_entry) = (0, 0);
            let new =
                Visit { sector, image, bounces, is_at_camera, columns, first_clip, first_entry };
            (new, *face)
        };
        visit.get_or_insert_with(new).0.columns.end = columns.end;
    }

    /// Stores the visit in `slot`, without the columns that have no open rows.
    fn store(&mut self, slot: VisitKind) {
        let WalkMemory { visits, clips, entries, next, columns, .. } = &mut *self.memory;
        let PendingVisit { visit, rows, entries: of_visit } = &mut next[slot as usize];
        let Some((visit, _)) = visit.take() else { return };
        let mut rest = visit.columns.clone();
        while let Some((range, is_open)) = next_run(&mut rest, |x| !rows[x].is_empty()) {
            if !is_open {
                continue;
            }
            let (first_clip, first_entry) = (clips.len(), entries.len());
            let of_range = zip(&rows[range.clone()], &columns.t[range.clone()]);
            clips.extend(of_range.map(|(&rows, &from)| Clip { rows, from }));
            let first = of_visit.iter().rposition(|it| it.column <= range.start).unwrap_or(0);
            entries.extend(of_visit[first..].iter().take_while(|it| it.column < range.end));
            visits.push(Visit { columns: range, first_clip, first_entry, ..visit.clone() });
        }
        of_visit.clear();
    }

    /// Shows the object in the cell at `place` along the straight rays. The rows above the object remain open.
    fn meet_standing(&mut self, visit: &Visit, sector: &Sector, place: [i64; 2]) {
        let world = self.scene.world;
        let [column, row] = visit.image.cell_to_map(place);
        let Some((cell, id)) = world.grid().cell(column, row) else { return };
        let tile = &world.tiles()[usize::from(id.0)];
        let ColumnMemory { passages, from, .. } = &mut self.memory.columns;
        for x in visit.columns.clone() {
            let direction = self.fan.directions.of(x);
            let ray = on_map(visit.image, self.scene.projection.origin(), direction);
            let passage = Intersection::of_tile(&ray, world, cell, tile.kind);
            // After a reflection in this cell, the ray starts at the mirror. An earlier hit is not on its path.
            let is_before_mirror = |hit: Hit| visit.bounces > 0 && hit.t < from[x];
            let is_met = !passage.hit.is_some_and(is_before_mirror);
            passages[x] = if is_met { passage } else { Intersection::NONE };
        }
        let mut rest = visit.columns.clone();
        let side = |walk: &Self, x: usize| walk.memory.columns.passages[x].hit.map(|hit| hit.side);
        while let Some((range, side)) = next_run(&mut rest, |x| side(self, x)) {
            if side.is_some() {
                self.meet_side(visit, sector, &range, (cell, tile));
            }
        }
        let top = tile.top_of_what_stands();
        if self.scene.projection.eye() <= top {
            return;
        }
        let mut rest = visit.columns.clone();
        let is_seen = |walk: &Self, x: usize| {
            let ColumnMemory { starts, ends, from, passages, .. } = &walk.memory.columns;
            passages[x].end.is_some_and(|end| from[x] <= end) && starts[x] < ends[x]
        };
        while let Some((range, is_seen)) = next_run(&mut rest, |x| is_seen(self, x)) {
            if is_seen {
                self.look_down_at(visit, sector, &range, (id, top));
            }
        }
    }

    /// Shows the face of a leaf or a shape that all rays of `range` hit.
    fn meet_side(
        &mut self,
        visit: &Visit,
        sector: &Sector,
        range: &Range<usize>,
        (cell, tile): (Cell, &Tile),
    ) {
        let (world, projection) = (self.scene.world, self.scene.projection);
        let ColumnMemory { t, u, passages, .. } = &mut self.memory.columns;
        let Some(hit) = passages[range.start].hit else { return };
        for x in range.clone() {
            (t[x], u[x]) = passages[x].hit.map_or((0.0, 0.0), |hit| (hit.t, hit.u));
        }
        self.close(visit, sector, range);
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
        let first = self.list.face_columns.len();
        let ColumnMemory { starts, ends, t, u, .. } = &mut self.memory.columns;
        self.list.face_columns.extend(range.clone().map(|x| {
            let above = projection.row_of_height(top, t[x]);
            let start = starts[x].max(above);
            let end = ends[x].min(projection.row_of_height(bottom, t[x]));
            ends[x] = ends[x].min(above);
            FaceColumn { rows: Rows { start, end }, t: t[x], u: u[x] }
        }));
        self.list.push_face(Face {
            columns: range.clone(),
            first,
            facing,
            material: Material::Opaque(paint),
            light,
            bottom,
            top,
            image: visit.image,
        });
    }

    /// Shows the top of a pillar of the tile `id`, as the rays of `range` see it from above.
    fn look_down_at(
        &mut self,
        visit: &Visit,
        sector: &Sector,
        range: &Range<usize>,
        (id, top): (TileId, f64),
    ) {
        let (world, projection) = (self.scene.world, self.scene.projection);
        let ColumnMemory { t, passages, .. } = &mut self.memory.columns;
        for x in range.clone() {
            t[x] = passages[x].end.unwrap_or_default();
        }
        // Things on the top are in front of it.
        if self.has_things {
            self.add_part(visit, sector, range, Some(top));
        }
        if visit.bounces == 0 {
            self.extend_distances(range);
        }
        let ColumnMemory { starts, ends, from, t, .. } = &mut self.memory.columns;
        let rows = range.clone().map(|x| {
            from[x] = t[x];
            let end = ends[x];
            ends[x] = projection.row_of_height(top, t[x]).clamp(starts[x], end);
            Rows { start: ends[x], end }
        });
        let look = PlaneSurface::of_top(&world.tiles()[usize::from(id.0)]);
        let look = Some(look).filter(|_| !world.has_lamplight());
        self.list.add_plane((PlaneKind::Top(id), top), look, visit.image, range, rows);
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
    let other = face.side.other();
    let is_mirrored = image.is_mirrored_along(face.side);
    let direction = image.direction_to_map(fan.directions.of(range.start));
    let is_from_left = is_from_left(direction, face.side);
    let across = &fan.directions.across(other)[range.clone()];
    let origin = fan.scene.projection.origin();
    let start = -(face.corner()[other as usize] - origin[other as usize]);
    let places = zip(&columns.t[range.clone()], across);
    // Even across the largest map, the error is far less than a texel.
    for (u, (t, across)) in zip(&mut columns.u[range.clone()], places) {
        let along = (start + t * across).clamp(0.0, 1.0);
        *u = from_left(if is_mirrored { 1.0 - along } else { along }, is_from_left);
    }
}
