//! Planes: floors, ceilings and the sky, along rows.
//!
//! A span begins or ends at the columns where the rows of the plane change. This takes one step for
//! each span and column, as in Doom's algorithm for the spans of its visplanes (`R_MakeSpans` in
//! `r_plane.c`, id Software 1993). Rejected: searching each row for its spans, which takes half as
//! long as drawing them.
//!
//! A plane with one colour everywhere is filled in whole rows, behind the walls. At 160×90 pixels,
//! this takes less time than reading the rows of the wall in every column.
//!
//! Planes with the same height and the same look are joined before their spans are made. Otherwise
//! a cell with a shape, which is a separate sector, would cut the floor around it into short spans.
//! A floor and a ceiling that are mirror images of each other share their spans.

use std::mem;
use std::ops::Range;

use glam::DVec2;

use super::sky::SkyView;
use super::span::{self, PlaneSpan};
use super::span_pair::SpanPairs;
use super::target::Target;
use crate::cast::MirrorTransform;
use crate::visibility::{
    Backdrop, DrawList, FrameContext, Lighting, Pass, PlaneKind, Rows, SpanMapping, VisiblePlane,
};
use crate::world::{Covering, Light, Paint, Pattern, PlaneSide, PlaneSurface, TileId};

/// Memory for drawing planes, one for each thread.
#[derive(Clone, Debug, Default)]
pub(crate) struct PlaneMemory {
    /// The planes in the order of drawing.
    order: Vec<PlaneKey>,
    /// The rows of a floor and of a ceiling, joined from several planes.
    joined: [JoinedRows; 2],
    spans: SpanMemory,
}

/// Memory for making spans.
#[derive(Clone, Debug, Default)]
struct SpanMemory {
    /// The first column of the current span of each row of the band.
    starts: Vec<usize>,
    /// The light of the columns of a span.
    lights: Vec<LitColumns>,
}

/// The rows of planes with the same look, joined in each column.
#[derive(Clone, Debug, Default)]
struct JoinedRows {
    columns: Range<usize>,
    /// One item for each column of the picture.
    rows: Vec<Rows>,
}

/// Draws the backdrops and the planes of `list`.
pub(crate) fn draw(
    scene: FrameContext<'_>,
    list: &DrawList,
    sky: &SkyView<'_>,
    memory: &mut PlaneMemory,
    target: &mut Target<'_>,
) {
    draw_backdrops(scene, list, sky, target);
    let PlaneMemory { order, joined, spans } = memory;
    spans.begin(target.rows().len(), scene.projection.columns());
    for rows in joined.iter_mut() {
        rows.begin(scene.projection.columns());
    }
    sort(scene, list, order);
    let is_whole = target.rows() == (0..scene.projection.rows());
    // The planes to draw next, together with their mirror image if that follows.
    let mut waiting: Option<PlaneDrawing<'_>> = None;
    let mut rest = order.as_slice();
    while let Some((&(.., first), others)) = rest.split_first() {
        let mut drawing = PlaneDrawing::new(scene, list, &list.planes[first]);
        if let Some(before) = waiting.take_if(|before| before.side == drawing.side) {
            before.draw(sky, joined, spans, target);
        }
        let is_alike = |key: &PlaneKey| drawing.is_alike(&list.planes[key.3]);
        let is_joined = others.first().is_some_and(is_alike);
        rest = others;
        if is_joined {
            let rows = &mut joined[drawing.side as usize];
            rows.clear();
            rows.join(list, first);
            let count = others.iter().take_while(|key| is_alike(key) && rows.join(list, key.3));
            rest = &others[count.count()..];
        }
        drawing.is_joined = is_joined;
        match waiting.take() {
            Some(before) if is_whole && drawing.is_mirror_image(&before, joined) => {
                drawing.draw_with_mirror_image(&before, joined, spans, target);
            }
            Some(before) => {
                before.draw(sky, joined, spans, target);
                waiting = Some(drawing);
            }
            None => waiting = Some(drawing),
        }
    }
    if let Some(last) = waiting {
        last.draw(sky, joined, spans, target);
    }
}

/// The sort key of a plane: the distance of its height from the eye, its image, its side and its
/// index.
type PlaneKey = (u64, usize, u8, usize);

/// Fills `order` with the planes of `list`: planes that may be joined are next to each other, and
/// the planes that may be their mirror images follow.
fn sort(scene: FrameContext<'_>, list: &DrawList, order: &mut Vec<PlaneKey>) {
    order.clear();
    order.reserve(list.planes.capacity());
    let eye = scene.projection.eye();
    order.extend(list.planes.iter().enumerate().map(|(index, plane)| {
        let from_eye = (plane.height - eye).abs().to_bits();
        (from_eye, list.index_of_image(plane.image), plane.kind.side() as u8, index)
    }));
    order.sort_unstable();
}

/// Draws the backdrops: the rows above or below the horizon that show one colour or the sky in all
/// columns.
fn draw_backdrops(
    scene: FrameContext<'_>,
    list: &DrawList,
    sky: &SkyView<'_>,
    target: &mut Target<'_>,
) {
    let projection = scene.projection;
    let (ground, width) = (projection.first_row_of_ground(), projection.columns());
    let halves = [(Pass::Floor, ground..projection.rows()), (Pass::Ceiling, 0..ground)];
    for (backdrop, (pass, rows)) in list.backdrops.into_iter().zip(halves) {
        let rows = target.clip(&rows);
        match backdrop {
            None => {}
            Some(Backdrop::Sky) => {
                for row in rows {
                    sky.draw(row, 0..width, None, target);
                }
            }
            Some(Backdrop::Color { color, light, .. }) if scene.world.fog().is_none() => {
                let color = Lighting::of_plane(light, None, 0.0).apply(color);
                target.whole_rows_mut(pass, rows).fill(color);
            }
            Some(Backdrop::Color { color, light, height }) => {
                for row in rows {
                    let distance = projection.mapping_at(row, height).distance;
                    let lighting = Lighting::of_plane(light, scene.world.fog(), distance);
                    let color = lighting.apply(color);
                    target.whole_rows_mut(pass, row..row + 1).fill(color);
                }
            }
        }
    }
}

impl SpanMemory {
    /// Prepares for the planes of a band of `rows` rows and `columns` columns.
    fn begin(&mut self, rows: usize, columns: usize) {
        self.starts.resize(rows, 0);
        self.lights.clear();
        self.lights.reserve(columns);
    }
}

impl JoinedRows {
    /// Prepares for pictures of this number of `columns`.
    fn begin(&mut self, columns: usize) {
        self.clear();
        self.rows.resize(columns, Rows::NONE);
    }

    /// Removes all rows.
    fn clear(&mut self) {
        let columns = mem::replace(&mut self.columns, 0..0);
        self.rows[columns].fill(Rows::NONE);
    }

    /// The first column, and the rows from there on.
    fn of_columns(&self) -> (usize, &[Rows]) {
        (self.columns.start, &self.rows[self.columns.clone()])
    }

    /// Adds the rows of a plane of `list`. Adds nothing and returns `false` if they do not adjoin
    /// the present rows in some column.
    fn join(&mut self, list: &DrawList, index: usize) -> bool {
        let (first, of_plane) = list.rows_of_plane(&list.planes[index]);
        let columns = first..first + of_plane.len();
        let known = &mut self.rows[columns.clone()];
        let adjoin = |(known, added): (&Rows, &Rows)| {
            let are_both = !known.is_empty() && !added.is_empty();
            !are_both || known.end == added.start || added.end == known.start
        };
        if !known.iter().zip(of_plane).all(adjoin) {
            return false;
        }
        for (known, added) in known.iter_mut().zip(of_plane) {
            *known = match (known.is_empty(), added.is_empty()) {
                (true, _) => *added,
                (_, true) => *known,
                _ => Rows { start: known.start.min(added.start), end: known.end.max(added.end) },
            };
        }
        self.columns = if self.columns.is_empty() {
            columns
        } else {
            self.columns.start.min(columns.start)..self.columns.end.max(columns.end)
        };
        true
    }
}

/// Calls `emit` for each span: a row, and the neighbouring columns in which a plane shows it.
/// `columns` are the rows that the plane shows in each column from `first` on. `rows` are the rows
/// of the band.
#[inline]
fn for_each_span(
    first: usize,
    columns: &[Rows],
    rows: &Range<u32>,
    starts: &mut [usize],
    mut emit: impl FnMut(u32, Range<usize>),
) {
    // A column without the plane has an empty range below all rows, so all spans end.
    let none = rows.end..rows.end;
    let mut before = none.clone();
    let mut x = first;
    let mut change = |before: &Range<u32>, now: &Range<u32>, x: usize| {
        let start_of = |starts: &mut [usize], row: u32| {
            mem::replace(&mut starts[(row - rows.start) as usize], x)
        };
        // The rows that end are above or below the rows of the next column.
        for row in before.start..before.end.min(now.start) {
            emit(row, start_of(starts, row)..x);
        }
        for row in before.start.max(now.end)..before.end {
            emit(row, start_of(starts, row)..x);
        }
        for row in now.start..now.end.min(before.start) {
            starts[(row - rows.start) as usize] = x;
        }
        for row in now.start.max(before.end)..now.end {
            starts[(row - rows.start) as usize] = x;
        }
    };
    for column in columns {
        let now = column.within(rows);
        let now = if now.is_empty() { none.clone() } else { now };
        if now != before {
            change(&before, &now, x);
            before = now;
        }
        x += 1;
    }
    change(&before, &none, x);
}

/// A floor or a ceiling with one covering in one light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DrawnPlane {
    pub(crate) pass: Pass,
    /// `None` for the sky.
    pub(crate) covering: Option<Covering>,
    pub(crate) light: Light,
}

impl DrawnPlane {
    fn new(side: PlaneSide, PlaneSurface { covering, light }: PlaneSurface) -> Self {
        Self { pass: pass_of(side), covering, light }
    }
}

/// A plane, with the state that its spans share.
#[derive(Clone, Copy)]
struct PlaneDrawing<'a> {
    scene: FrameContext<'a>,
    list: &'a DrawList,
    plane: &'a VisiblePlane,
    /// Whether its rows are joined with the rows of other planes.
    is_joined: bool,
    side: PlaneSide,
    /// The look, if it is the same in all cells.
    even: Option<DrawnPlane>,
}

impl<'a> PlaneDrawing<'a> {
    fn new(scene: FrameContext<'a>, list: &'a DrawList, plane: &'a VisiblePlane) -> Self {
        let side = plane.kind.side();
        let even = plane.look.map(|look| DrawnPlane::new(side, look));
        Self { scene, list, plane, is_joined: false, side, even }
    }

    /// Whether `plane` has the same height, side and image, and looks the same in each cell.
    fn is_alike(&self, plane: &'a VisiblePlane) -> bool {
        let VisiblePlane { height, kind, look, image, .. } = *plane;
        (height, kind.side(), look, image)
            == (self.plane.height, self.side, self.plane.look, self.plane.image)
            && (look.is_some() || kind == self.plane.kind)
    }

    /// The first column, and the rows from there on.
    fn rows<'r>(&self, joined: &'r [JoinedRows; 2]) -> (usize, &'r [Rows])
    where
        'a: 'r,
    {
        if self.is_joined {
            joined[self.side as usize].of_columns()
        } else {
            self.list.rows_of_plane(self.plane)
        }
    }

    /// Whether each row of the plane is the mirror image of a row of `other`, and neither is of one
    /// colour.
    fn is_mirror_image(&self, other: &Self, joined: &[JoinedRows; 2]) -> bool {
        let projection = self.scene.projection;
        let height = projection.rows();
        let has_texels = |plane: &Self| {
            let covering = plane.even.and_then(|plane| plane.covering);
            covering.is_some_and(|it| !matches!(it.pattern, Pattern::Plain(Paint::Color(_))))
        };
        let are_mirrored = || {
            let ((first, rows), (first_of_other, of_other)) =
                (self.rows(joined), other.rows(joined));
            let is_mirrored = |(one, other): (&Rows, &Rows)| {
                one.is_empty() && other.is_empty()
                    || (one.start + other.end, one.end + other.start) == (height, height)
            };
            first == first_of_other
                && rows.len() == of_other.len()
                && rows.iter().zip(of_other).all(is_mirrored)
        };
        projection.is_symmetric()
            && self.plane.height + other.plane.height == 2.0 * projection.eye()
            && self.plane.image == other.plane.image
            && self.mirrored().is_none()
            && has_texels(self)
            && has_texels(other)
            && are_mirrored()
    }

    /// Draws the plane, and its mirror image `other`.
    fn draw_with_mirror_image(
        &self,
        other: &Self,
        joined: &[JoinedRows; 2],
        memory: &mut SpanMemory,
        target: &mut Target<'_>,
    ) {
        let (floor, ceiling) =
            if self.side == PlaneSide::Floor { (self, other) } else { (other, self) };
        let (Some(of_floor), Some(of_ceiling)) = (floor.even, ceiling.even) else { return };
        let mut pairs = SpanPairs::new(self.scene, [of_ceiling, of_floor]);
        let rows = target.rows();
        let (first, columns) = floor.rows(joined);
        for_each_span(first, columns, &rows, &mut memory.starts, |row, columns| {
            let mapping = self.scene.projection.mapping_at(row, floor.plane.height);
            pairs.draw((row, columns), &mapping, target);
        });
    }

    fn draw(
        &self,
        sky: &SkyView<'_>,
        joined: &[JoinedRows; 2],
        memory: &mut SpanMemory,
        target: &mut Target<'_>,
    ) {
        let SpanMemory { starts, lights } = memory;
        let (first, columns) = self.rows(joined);
        let rows = target.rows();
        let image = self.mirrored();
        for_each_span(first, columns, &rows, starts, |row, columns| {
            if let Some(DrawnPlane { covering: None, .. }) = self.even {
                sky.draw(row, columns, image, target);
                return;
            }
            let direct = self.scene.projection.mapping_at(row, self.plane.height);
            let mapping = &image.map_or(direct, |image| direct.seen_in_mirrors(image));
            if let Some(DrawnPlane { light, covering, .. }) = self.even {
                lights.clear();
                lights.push((columns, light));
                self.draw_span(sky, row, covering, mapping, lights, target);
            } else {
                let lines = direct.before_and_behind(self.scene.projection.origin());
                let lines = lines.map(|line| line.seen_in_mirrors(self.plane.image));
                self.draw_cells(sky, row, columns, (mapping, lines), lights, target);
            }
        });
    }

    /// Draws `columns` of `row`, with a span for each run of columns that show one covering. The
    /// cell of a pixel is the cell just `before` its point, or the cell just `behind` the point if
    /// the first one is not in the sector.
    fn draw_cells(
        &self,
        sky: &SkyView<'_>,
        row: u32,
        columns: Range<usize>,
        (mapping, [before, behind]): (&SpanMapping, [SpanMapping; 2]),
        lights: &mut Vec<LitColumns>,
        target: &mut Target<'_>,
    ) {
        let world = self.scene.world;
        lights.clear();
        let mut latest = None;
        let mut covering = None;
        let cell_at = |corner: DVec2| {
            let place = || world.grid().cell(corner.x as i64, corner.y as i64);
            corner.is_finite().then(place).flatten()
        };
        for (corner, columns) in before.cells(columns) {
            let place = cell_at(corner).filter(|(_, tile)| self.is_of(*tile));
            let place = place.or_else(|| cell_at(behind.point(columns.start).floor()));
            let (tile, lamplight) = match place {
                Some((cell, tile)) => (tile, world.lamplight_in(cell)),
                None => (TileId(0), Light::NONE),
            };
            let look = match latest {
                Some((of_tile, look)) if of_tile == tile => look,
                _ => latest.insert((tile, self.look_of(tile))).1,
            };
            if !lights.is_empty() && look.covering != covering {
                self.draw_span(sky, row, covering, mapping, lights, target);
                lights.clear();
            }
            covering = look.covering;
            let light = look.light.plus(lamplight);
            match lights.last_mut() {
                Some((lit, of_lit)) if *of_lit == light => lit.end = columns.end,
                _ => lights.push((columns, light)),
            }
        }
        self.draw_span(sky, row, covering, mapping, lights, target);
    }

    /// Draws neighbouring columns of `row`, each range of `lights` in its light.
    fn draw_span(
        &self,
        sky: &SkyView<'_>,
        row: u32,
        covering: Option<Covering>,
        mapping: &SpanMapping,
        lights: &[LitColumns],
        target: &mut Target<'_>,
    ) {
        let ([(first, _), ..], [.., (last, _)]) = (lights, lights) else { return };
        let columns = first.start..last.end;
        let Some(covering) = covering else {
            sky.draw(row, columns, self.mirrored(), target);
            return;
        };
        let first = columns.start;
        let span = PlaneSpan { pass: pass_of(self.side), row, columns, covering, mapping };
        let pixels = span::draw(self.scene, &span, target);
        for (columns, light) in lights {
            let lighting = Lighting::of_plane(*light, self.scene.world.fog(), mapping.distance);
            lighting.apply_to_all(&mut pixels[columns.start - first..columns.end - first]);
        }
    }

    /// The image in mirrors; `None` if the plane is seen directly.
    fn mirrored(&self) -> Option<MirrorTransform> {
        Some(self.plane.image).filter(|image| *image != MirrorTransform::default())
    }

    /// Whether the plane can extend over cells with this tile.
    fn is_of(&self, tile: TileId) -> bool {
        match self.plane.kind {
            PlaneKind::Floor(sector) | PlaneKind::Ceiling(sector) => {
                self.list.sectors.of(tile).have(sector)
            }
            PlaneKind::Top(_) => true,
        }
    }

    /// The look of the plane in a cell with this tile, without lamplight.
    fn look_of(&self, tile: TileId) -> PlaneSurface {
        let world = self.scene.world;
        match self.plane.kind {
            PlaneKind::Floor(sector) | PlaneKind::Ceiling(sector) => {
                self.list.sectors.surfaces(world, sector, tile)[self.side as usize]
            }
            PlaneKind::Top(id) => PlaneSurface::of_top(&world.tiles()[usize::from(id.0)]),
        }
    }
}

/// Neighbouring columns in one light.
type LitColumns = (Range<usize>, Light);

fn pass_of(side: PlaneSide) -> Pass {
    match side {
        PlaneSide::Floor => Pass::Floor,
        PlaneSide::Ceiling => Pass::Ceiling,
    }
}
