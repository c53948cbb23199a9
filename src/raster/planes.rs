//! Planes: floors, ceilings and the sky, along rows.
//!
//! A span ends where the next column shows less of the plane, and begins where it shows more, with one
//! step for each span and column, as Doom makes the spans of its visplanes (`R_MakeSpans` in
//! `r_plane.c`, id Software 1993). Rejected: searching each row for its spans, which takes
//! half as long as drawing them. One colour everywhere is a fill: at 160×90 pixels that takes less
//! time than reading the rows of the wall in every column.

use std::mem;
use std::ops::Range;

use glam::DVec2;

use super::sampling::Sampling;
use super::sky::SkyView;
use super::span::{self, PlaneSpan};
use super::span_pair::SpanPairs;
use super::target::Target;
use crate::cast::MirrorTransform;
use crate::visibility::{
    Backdrop, DrawList, Faded, Lighting, Pass, Plane, PlaneKind, PlaneSide, PlaneSurface, Rows,
    Scene, SectorId, SpanMapping,
};
use crate::world::{Covering, Light, Tile, TileId, TileKind};

/// Memory for making spans, one for each thread.
#[derive(Clone, Debug, Default)]
pub(crate) struct PlaneMemory {
    /// The first column of the current span of each row of the band.
    starts: Vec<usize>,
    mappings: RowMappings,
    /// The light of the columns of a span.
    lights: Vec<LitColumns>,
}

/// The mappings of the rows of a band to planes at one height.
#[derive(Clone, Debug, Default)]
struct RowMappings {
    height: f64,
    /// The number of heights so far, which tells a row's mapping from that to another height.
    current: u32,
    rows: Vec<(u32, Option<SpanMapping>)>,
}

/// Draws the backdrops and the planes of `list`.
pub(crate) fn draw<M: Sampling>(
    scene: Scene<'_>,
    list: &DrawList,
    sky: &SkyView<'_>,
    memory: &mut PlaneMemory,
    target: &mut Target<'_>,
) {
    draw_backdrops(scene, list, sky, target);
    let rows = target.rows();
    memory.starts.resize(rows.len(), 0);
    memory.mappings.begin(rows.len());
    memory.lights.clear();
    memory.lights.reserve(scene.projection.columns());
    let PlaneMemory { starts, mappings, lights } = memory;
    let mut pairs = SpanPairs::<M>::new();
    for plane in &list.planes {
        let drawing = PlaneDrawing::new(scene, list, plane);
        mappings.set_height(drawing.height);
        let of_plane = &list.plane_rows[plane.first..][..plane.columns.len()];
        let is_whole = rows == (0..scene.projection.rows());
        match plane.kind {
            PlaneKind::FloorAndCeiling(sector) if is_whole => {
                let planes = [PlaneSide::Ceiling, PlaneSide::Floor]
                    .map(|side| DrawnPlane::new(side, list.sectors.even_surface(sector, side)));
                let first = plane.columns.start as usize;
                for_each_span(first, of_plane.iter().copied(), &rows, starts, |row, columns| {
                    let mapping = mappings.of(scene, row, &rows);
                    pairs.draw(scene, (row, columns), &planes, mapping, target);
                });
            }
            PlaneKind::FloorAndCeiling(sector) => {
                let height = scene.projection.rows();
                let mirrored = of_plane.iter().map(|rows| Rows {
                    start: height - rows.end.max(rows.start),
                    end: height - rows.start.min(rows.end),
                });
                let floor = Plane { kind: PlaneKind::Floor(sector), ..plane.clone() };
                let ceiling = Plane { kind: PlaneKind::Ceiling(sector), ..plane.clone() };
                let floor = PlaneDrawing::new(scene, list, &floor);
                let memory = (&mut starts[..], &mut *mappings, &mut *lights);
                floor.draw::<M>(sky, of_plane.iter().copied(), memory, target);
                let ceiling = PlaneDrawing::new(scene, list, &ceiling);
                mappings.set_height(ceiling.height);
                let memory = (&mut starts[..], &mut *mappings, &mut *lights);
                ceiling.draw::<M>(sky, mirrored, memory, target);
            }
            _ => {
                let memory = (&mut starts[..], &mut *mappings, &mut *lights);
                drawing.draw::<M>(sky, of_plane.iter().copied(), memory, target);
            }
        }
    }
}

/// Fills the rows above and below the horizon whose colour is the same in all columns.
fn draw_backdrops(scene: Scene<'_>, list: &DrawList, sky: &SkyView<'_>, target: &mut Target<'_>) {
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
                let color = Faded::of_plane(light, None, 0.0).map_or(color, |it| it.apply(color));
                target.whole_rows_mut(pass, rows).fill(color);
            }
            Some(Backdrop::Color { color, light, height }) => {
                for row in rows {
                    let distance = projection.mapping_at(row, height).distance;
                    let faded = Faded::of_plane(light, scene.world.fog(), distance);
                    let color = faded.map_or(color, |faded| faded.apply(color));
                    target.whole_rows_mut(pass, row..row + 1).fill(color);
                }
            }
        }
    }
}

impl RowMappings {
    fn begin(&mut self, rows: usize) {
        if self.rows.len() < rows {
            self.rows.resize(rows, (0, None));
        }
        self.rows.iter_mut().for_each(|row| row.0 = 0);
        (self.current, self.height) = (0, f64::NAN);
    }

    fn set_height(&mut self, height: f64) {
        if height != self.height {
            self.current += 1;
            self.height = height;
        }
    }

    /// The mapping of `row`, one of `rows`.
    #[inline]
    fn of(&mut self, scene: Scene<'_>, row: u32, rows: &Range<u32>) -> &SpanMapping {
        let (number, mapping) = &mut self.rows[(row - rows.start) as usize];
        if *number != self.current {
            *number = self.current;
            *mapping = None;
        }
        mapping.get_or_insert_with(|| scene.projection.mapping_at(row, self.height))
    }
}

/// Calls `emit` for every stretch of columns, from `first` on, that shows a row of a plane: each column shows these
/// of `rows`.
#[inline]
fn for_each_span(
    first: usize,
    columns: impl Iterator<Item = Rows>,
    rows: &Range<u32>,
    starts: &mut [usize],
    mut emit: impl FnMut(u32, Range<usize>),
) {
    // A column without the plane has an empty range below all others, so that all of their rows end.
    let none = rows.end..rows.end;
    let mut before = none.clone();
    let mut x = first;
    let mut change = |before: &Range<u32>, now: &Range<u32>, x: usize| {
        let start_of = |starts: &mut [usize], row: u32| {
            mem::replace(&mut starts[(row - rows.start) as usize], x)
        };
        // The rows that end are above those of the next column, or below.
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
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawnPlane {
    pub(crate) pass: Pass,
    /// `None` for the sky.
    pub(crate) covering: Option<Covering>,
    pub(crate) light: Light,
}

impl DrawnPlane {
    fn new(side: PlaneSide, surface: Option<PlaneSurface>) -> Self {
        let pass = pass_of(side);
        let (covering, light) =
            surface.map_or((None, Light::FULL), |surface| (surface.covering, surface.light));
        Self { pass, covering, light }
    }
}

/// A plane with what its spans share.
struct PlaneDrawing<'a> {
    scene: Scene<'a>,
    list: &'a DrawList,
    first: usize,
    image: MirrorTransform,
    sector: SectorId,
    side: PlaneSide,
    /// The top of a pillar.
    top: Option<TileId>,
    height: f64,
    /// The look, if it is the same in all cells.
    even: Option<DrawnPlane>,
}

impl<'a> PlaneDrawing<'a> {
    fn new(scene: Scene<'a>, list: &'a DrawList, plane: &Plane) -> Self {
        let (world, sectors) = (scene.world, &list.sectors);
        let of_sector = |sector: SectorId, side: PlaneSide| {
            let surface = sectors.even_surface(sector, side);
            let even = surface.map(|surface| DrawnPlane::new(side, Some(surface)));
            let height = match side {
                PlaneSide::Floor => sectors.get(sector).bottom,
                PlaneSide::Ceiling => sectors.get(sector).top,
            };
            (sector, side, None, height, even)
        };
        let (sector, side, top, height, even) = match plane.kind {
            PlaneKind::Floor(sector) | PlaneKind::FloorAndCeiling(sector) => {
                of_sector(sector, PlaneSide::Floor)
            }
            PlaneKind::Ceiling(sector) => of_sector(sector, PlaneSide::Ceiling),
            PlaneKind::Top(id) => {
                let tile = &world.tiles()[usize::from(id.0)];
                let even = DrawnPlane::new(PlaneSide::Floor, Some(surface_of_top(tile)));
                let even = Some(even).filter(|_| !world.has_lamplight());
                let height = tile.top_of_what_stands();
                (SectorId::SOLID, PlaneSide::Floor, Some(id), height, even)
            }
        };
        let (first, image) = (plane.columns.start as usize, plane.image);
        Self { scene, list, first, image, sector, side, top, height, even }
    }

    fn draw<M: Sampling>(
        &self,
        sky: &SkyView<'_>,
        columns: impl Iterator<Item = Rows>,
        (starts, mappings, lights): (&mut [usize], &mut RowMappings, &mut Vec<LitColumns>),
        target: &mut Target<'_>,
    ) {
        let rows = target.rows();
        let image = self.mirrored();
        for_each_span(self.first, columns, &rows, starts, |row, columns| {
            if let Some(DrawnPlane { covering: None, .. }) = self.even {
                sky.draw(row, columns, image, target);
                return;
            }
            let direct = mappings.of(self.scene, row, &rows);
            let on_map = image.map(|image| direct.seen_in_mirrors(image));
            let mapping = on_map.as_ref().unwrap_or(direct);
            if let Some(DrawnPlane { light, covering, .. }) = self.even {
                lights.clear();
                lights.push((columns, light));
                self.draw_span::<M>(sky, row, covering, mapping, lights, target);
            } else {
                let lines = direct.before_and_behind(self.scene.projection.origin());
                let lines = lines.map(|line| line.seen_in_mirrors(self.image));
                self.draw_cells::<M>(sky, row, columns, (mapping, lines), lights, target);
            }
        });
    }

    /// Draws a span for each stretch of one covering in `columns` of `row`. The cell of a pixel is that `before` its
    /// point, or that `behind` it if only that is in the sector.
    fn draw_cells<M: Sampling>(
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
                self.draw_span::<M>(sky, row, covering, mapping, lights, target);
                lights.clear();
            }
            covering = look.covering;
            let light = look.light.plus(lamplight);
            match lights.last_mut() {
                Some((lit, of_lit)) if *of_lit == light => lit.end = columns.end,
                _ => lights.push((columns, light)),
            }
        }
        self.draw_span::<M>(sky, row, covering, mapping, lights, target);
    }

    /// Draws neighbouring columns of `row`, each stretch of them in its light.
    fn draw_span<M: Sampling>(
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
        let pixels = span::draw::<M>(self.scene, &span, target);
        for (columns, light) in lights {
            let faded = Faded::of_plane(*light, self.scene.world.fog(), mapping.distance);
            if let Some(faded) = faded {
                faded.apply_to_all(&mut pixels[columns.start - first..columns.end - first]);
            }
        }
    }

    /// The image in mirrors; `None` for the direct one.
    fn mirrored(&self) -> Option<MirrorTransform> {
        Some(self.image).filter(|image| *image != MirrorTransform::default())
    }

    /// Whether cells of this tile may have the plane.
    fn is_of(&self, tile: TileId) -> bool {
        self.top.is_some() || self.list.sectors.of(tile).have(self.sector)
    }

    /// The look of the plane in a cell of this tile, without lamplight.
    fn look_of(&self, tile: TileId) -> PlaneSurface {
        let (world, sectors) = (self.scene.world, &self.list.sectors);
        match self.top {
            Some(id) => surface_of_top(&world.tiles()[usize::from(id.0)]),
            None => sectors.surface(world, self.sector, self.side, tile),
        }
    }
}

/// Neighbouring columns in one light.
type LitColumns = (Range<usize>, Light);

/// The surface of the top of a pillar.
fn surface_of_top(tile: &Tile) -> PlaneSurface {
    let paint = match tile.kind {
        TileKind::Shape(shape) => shape.paint,
        _ => tile.riser,
    };
    let light = tile.light.unwrap_or(Light::FULL);
    PlaneSurface { covering: Some(Covering::from(paint)), light }
}

fn pass_of(side: PlaneSide) -> Pass {
    match side {
        PlaneSide::Floor => Pass::Floor,
        PlaneSide::Ceiling => Pass::Ceiling,
    }
}
