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
//! A floor and a ceiling that are mirror images of each other share their spans if they have textures
//! of the same size in the same light. The texels of both are then found by the same indices.

use std::mem;
use std::ops::Range;

use glam::DVec2;

use super::sky::SkyView;
use super::span::{self, PlaneSpan, Sampler};
use super::target::Target;
use crate::cast::MirrorTransform;
use crate::visibility::{
    Backdrop, DrawList, FrameContext, Lighting, Pass, PlaneKind, Rows, SpanMapping, VisiblePlane,
};
use crate::world::{Covering, Light, Paint, Pattern, PlaneSide, PlaneSurface, Texture, TileId};

/// Memory for drawing planes, one for each thread.
#[derive(Clone, Debug, Default)]
pub(crate) struct PlaneMemory {
    /// The first column of the current span of each row of the band.
    starts: Vec<usize>,
    /// The light of the columns of a span.
    lights: Vec<LitColumns>,
}

/// Neighbouring columns in one light.
type LitColumns = (Range<usize>, Light);

/// Draws the backdrops and the planes of `list`.
pub(crate) fn draw(
    scene: FrameContext<'_>,
    list: &DrawList,
    sky: &SkyView<'_>,
    memory: &mut PlaneMemory,
    target: &mut Target<'_>,
) {
    draw_backdrops(scene, list, sky, target);
    memory.starts.resize(target.rows().len(), 0);
    memory.lights.clear();
    memory.lights.reserve(scene.projection.columns());
    let is_symmetric =
        scene.projection.is_symmetric() && target.rows() == (0..scene.projection.rows());
    let mut planes = list.planes.iter().peekable();
    while let Some(plane) = planes.next() {
        let drawing = PlaneDrawing { scene, list, sky, plane };
        let pair = planes.peek().filter(|_| is_symmetric).and_then(|next| drawing.with(next));
        if let Some(pair) = pair {
            planes.next();
            drawing.draw_pair(&pair, memory, target);
        } else {
            drawing.draw(memory, target);
        }
    }
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
                    sky.draw(row, 0..width, MirrorTransform::default(), target);
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

/// A plane, with the state that its spans share.
#[derive(Clone, Copy)]
struct PlaneDrawing<'a> {
    scene: FrameContext<'a>,
    list: &'a DrawList,
    sky: &'a SkyView<'a>,
    plane: &'a VisiblePlane,
}

impl<'a> PlaneDrawing<'a> {
    fn draw(&self, memory: &mut PlaneMemory, target: &mut Target<'_>) {
        let PlaneMemory { starts, lights } = memory;
        let &VisiblePlane { look, height, image, .. } = self.plane;
        let (first, columns) = self.list.rows_of_plane(self.plane);
        let rows = target.rows();
        for_each_span(first, columns, &rows, starts, |row, columns| {
            if let Some(PlaneSurface { covering: None, .. }) = look {
                self.sky.draw(row, columns, image, target);
                return;
            }
            let direct = self.scene.projection.mapping_at(row, height);
            let mapping = &direct.seen_in_mirrors(image);
            if let Some(PlaneSurface { covering, light }) = look {
                self.draw_span(row, covering, mapping, &[(columns, light)], target);
            } else {
                let lines = direct.before_and_behind(self.scene.projection.origin());
                let lines = lines.map(|line| line.seen_in_mirrors(image));
                self.draw_cells(row, columns, (mapping, lines), lights, target);
            }
        });
    }

    /// Draws `columns` of `row`, with a span for each run of columns that show one covering. The
    /// cell of a pixel is the cell just `before` its point, or the cell just `behind` the point if
    /// the first one is not in the sector.
    fn draw_cells(
        &self,
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
                self.draw_span(row, covering, mapping, lights, target);
                lights.clear();
            }
            covering = look.covering;
            let light = look.light.plus(lamplight);
            match lights.last_mut() {
                Some((lit, of_lit)) if *of_lit == light => lit.end = columns.end,
                _ => lights.push((columns, light)),
            }
        }
        self.draw_span(row, covering, mapping, lights, target);
    }

    /// Draws neighbouring columns of `row`, each range of `lights` in its light.
    fn draw_span(
        &self,
        row: u32,
        covering: Option<Covering>,
        mapping: &SpanMapping,
        lights: &[LitColumns],
        target: &mut Target<'_>,
    ) {
        let ([(first, _), ..], [.., (last, _)]) = (lights, lights) else { return };
        let columns = first.start..last.end;
        let Some(covering) = covering else {
            self.sky.draw(row, columns, self.plane.image, target);
            return;
        };
        let first = columns.start;
        let pass = match self.plane.kind.side() {
            PlaneSide::Floor => Pass::Floor,
            PlaneSide::Ceiling => Pass::Ceiling,
        };
        let span = PlaneSpan { pass, row, columns, covering, mapping };
        let pixels = span::draw(self.scene, &span, target);
        for (columns, light) in lights {
            let lighting = Lighting::of_plane(*light, self.scene.world.fog(), mapping.distance);
            lighting.apply_to_all(&mut pixels[columns.start - first..columns.end - first]);
        }
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
                let side = self.plane.kind.side();
                self.list.sectors.surfaces(world, sector, tile)[side as usize]
            }
            PlaneKind::Top(id) => PlaneSurface::of_top(&world.tiles()[usize::from(id.0)]),
        }
    }

    /// The pair of this floor and `ceiling`, if each row of one is the mirror image of a row of the other,
    /// and both have textures of the same size in the same light.
    fn with(&self, ceiling: &VisiblePlane) -> Option<PlanePair<'a>> {
        let floor = self.plane;
        let texture = |plane: &VisiblePlane| match plane.look?.covering?.pattern {
            Pattern::Plain(Paint::Texture(id)) => Some(self.scene.world.texture(id)),
            _ => None,
        };
        let textures = [texture(ceiling)?, texture(floor)?];
        let [size, other_size] = textures.map(|texture| (texture.width(), texture.height()));
        let PlaneSurface { covering, light } = floor.look?;
        let scale = covering?.scale;
        let has_same = size == other_size
            && ceiling.look.is_some_and(|it| it.light == light)
            && ceiling.look?.covering?.scale == scale
            && floor.kind.side() == PlaneSide::Floor
            && ceiling.kind.side() == PlaneSide::Ceiling
            && floor.height + ceiling.height == 2.0 * self.scene.projection.eye()
            && floor.image == ceiling.image
            && floor.columns == ceiling.columns;
        let height = self.scene.projection.rows();
        let is_mirrored = |(one, other): (&Rows, &Rows)| {
            (one.start + other.end, one.end + other.start) == (height, height)
                || one.is_empty() && other.is_empty()
        };
        let [(_, rows), (_, others)] = [floor, ceiling].map(|it| self.list.rows_of_plane(it));
        let is_pair = has_same && rows.iter().zip(others).all(is_mirrored);
        is_pair.then_some(PlanePair { textures, per_cell: 1.0 / scale.cells(), light })
    }

    /// Draws the plane, a floor, and the ceiling with which it is a pair.
    fn draw_pair(&self, pair: &PlanePair<'_>, memory: &mut PlaneMemory, target: &mut Target<'_>) {
        let &PlanePair { textures, per_cell, light } = pair;
        let scene = self.scene;
        let (first, columns) = self.list.rows_of_plane(self.plane);
        let rows = target.rows();
        for_each_span(first, columns, &rows, &mut memory.starts, |row, columns| {
            let mapping = scene.projection.mapping_at(row, self.plane.height);
            let mapping = &mapping.seen_in_mirrors(self.plane.image);
            let lod = Sampler { scene, mapping, per_cell }.lod_of(textures[0]);
            let places = mapping.places(columns.start, per_cell);
            let pixels = target.two_spans_mut([rows.end - 1 - row, row], &columns);
            let lighting = Lighting::of_plane(light, scene.world.fog(), mapping.distance);
            let [above, below] = pixels;
            span::draw_two_levels(textures.map(|it| it.level(lod)), places, [above, below]);
            lighting.apply_to_all(above);
            lighting.apply_to_all(below);
        });
    }
}

/// What a floor and its mirror image, a ceiling, share.
struct PlanePair<'a> {
    /// The textures of the ceiling and the floor, which have the same size.
    textures: [&'a Texture; 2],
    /// The number of repeats of the textures in a cell.
    per_cell: f64,
    light: Light,
}
