//! The spans of a level scene: floor and ceiling around the walls, and the sky.
//!
//! Spans end where the next column shows less of the plane, and begin where it shows more, with one
//! step for each span and column, as Doom makes the spans of its visplanes (`R_MakeSpans` in
//! `r_plane.c`, id Software 1993). Rejected: searching each row for its spans, which takes
//! half as long as drawing them. One colour everywhere is a fill: at 160×90 pixels that takes less
//! time than reading the rows of the wall in every column.

use std::ops::Range;

use glam::DVec2;

use crate::color::Rgb;
use crate::visibility::{
    CeilingLoop, Column, DrawnPlane, Faded, Filter, Lighting, Pass, PlaneLoop, PlaneSpan, Scene,
    SkyLoop, Span, SpanMapping, SpanPair,
};
use crate::world::{Ceiling, Cell, Covering, Light, TileId, TileKind};

/// Passes every span of `columns` in `rows` to `emit`. Later spans are drawn over earlier ones.
pub(crate) fn for_each_span(
    scene: Scene<'_>,
    columns: &[Column],
    rows: &Range<u32>,
    memory: &mut Vec<PlaneRow>,
    emit: &mut impl FnMut(Span<'_>),
) {
    let plane = |kind| Plane { scene, columns, kind };
    if are_mirror_images(scene, columns, rows) {
        let planes =
            &[PlaneKind::Ceiling, PlaneKind::Floor].map(|kind| plane(kind).default_plane());
        let height = rows.end;
        memory.reserve((height as usize / 2).saturating_sub(memory.len()));
        let row_at = |depth, x| PlaneRow::new(scene, depth, x);
        let visible = |column: &Column| column.rows.start;
        for_each_stretch(columns, visible, memory, row_at, |row, columns| {
            let rows = [row.row, height - 1 - row.row];
            emit(Span::Pair(SpanPair { rows, columns, planes, mapping: &row.mapping }));
        });
        return;
    }
    match scene.plan.ceiling {
        CeilingLoop::Sky => sky_overhead(scene, columns, rows, emit),
        CeilingLoop::Plane(ceiling) => {
            plane(PlaneKind::Ceiling).for_each_span(ceiling, rows, memory, emit);
            sky_beyond_edge(scene, columns, rows, emit);
        }
    }
    plane(PlaneKind::Floor).for_each_span(scene.plan.floor, rows, memory, emit);
}

/// Whether each row of the ceiling in `rows` shows the same columns and the same points of the map as
/// the row of the floor that is its mirror image.
fn are_mirror_images(scene: Scene<'_>, columns: &[Column], rows: &Range<u32>) -> bool {
    let Scene { plan, projection, .. } = scene;
    let are_spans = plan.ceiling == CeilingLoop::Plane(PlaneLoop::Spans)
        && plan.floor == PlaneLoop::Spans
        && *rows == (0..projection.rows());
    let is_symmetric =
        |column: &Column| column.hit.is_some() && column.rows.start + column.rows.end == rows.end;
    are_spans && projection.is_symmetric() && columns.iter().all(is_symmetric)
}

/// The floor or the ceiling.
struct Plane<'a> {
    scene: Scene<'a>,
    columns: &'a [Column],
    kind: PlaneKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PlaneKind {
    Floor,
    Ceiling,
}

impl Plane<'_> {
    fn for_each_span(
        &self,
        plan: PlaneLoop,
        rows: &Range<u32>,
        memory: &mut Vec<PlaneRow>,
        emit: &mut impl FnMut(Span<'_>),
    ) {
        let pass = self.pass();
        match plan {
            PlaneLoop::Fill(color) => {
                emit(Span::Fill { pass, rows: common(rows, &self.rows()), color });
            }
            PlaneLoop::FillRows(color) => {
                for row in common(rows, &self.rows()) {
                    emit(Span::Fill { pass, rows: row..row + 1, color: self.fogged(color, row) });
                }
            }
            PlaneLoop::Spans => {
                let plane = self.default_plane();
                self.for_each_visible(rows, memory, |row, columns| {
                    emit(Span::Plane(row.span(columns, plane)));
                });
            }
            PlaneLoop::Tiles if self.scene.plan.filter == Filter::Area => {
                self.for_each_visible(rows, memory, |row, columns| {
                    let ground_at = |corner, x| self.ground_before_walls(corner, (row.row, x));
                    self.cut_by_tile(row, columns, ground_at, emit);
                });
            }
            PlaneLoop::Tiles => self.for_each_visible(rows, memory, |row, columns| {
                self.cut_by_tile(row, columns, |corner, _| self.ground_in(corner), emit);
            }),
        }
    }

    /// Calls `emit` for every stretch of pixels in `rows` that shows the plane.
    fn for_each_visible(
        &self,
        rows: &Range<u32>,
        memory: &mut Vec<PlaneRow>,
        emit: impl FnMut(&PlaneRow, Range<usize>),
    ) {
        let all = self.rows();
        let Range { start, end } = common(rows, &all);
        let row_at = |depth: u32| match self.kind {
            PlaneKind::Floor => end - 1 - depth,
            PlaneKind::Ceiling => start + depth,
        };
        // Rows of the plane in other bands: those nearer to the edge of the picture show it, too.
        let elsewhere = match self.kind {
            PlaneKind::Floor => all.end - end,
            PlaneKind::Ceiling => start - all.start,
        };
        let visible =
            |column: &Column| self.visible(column, &all).saturating_sub(elsewhere).min(end - start);
        // Enough for any later view.
        memory.reserve(((end - start) as usize).saturating_sub(memory.len()));
        let row_at = |depth, x| PlaneRow::new(self.scene, row_at(depth), x);
        for_each_stretch(self.columns, visible, memory, row_at, emit);
    }

    /// Emits a span for each stretch of one tile and light in `columns` of `row`. `ground_at` gives both for a
    /// north-west corner of a cell and the first column that shows it.
    fn cut_by_tile(
        &self,
        row: &PlaneRow,
        columns: Range<usize>,
        ground_at: impl Fn(DVec2, usize) -> Option<(TileId, Light)>,
        emit: &mut impl FnMut(Span<'_>),
    ) {
        let Scene { world, projection, .. } = self.scene;
        let cells = row.mapping.just_before(projection.origin()).cells(columns);
        let mut grounds =
            cells.map(|(corner, columns)| (ground_at(corner, columns.start), columns)).peekable();
        while let Some((ground, mut columns)) = grounds.next() {
            while let Some((_, more)) = grounds.next_if(|&(next, _)| next == ground) {
                columns.end = more.end;
            }
            let Some((tile, lamplight)) = ground else {
                emit(Span::Plane(row.span(columns, self.default_plane())));
                continue;
            };
            let tile = world.tile(tile);
            let light = tile.light.unwrap_or(Light::FULL).plus(lamplight);
            emit(match self.covering(tile.floor, tile.ceiling) {
                Some(covering) => Span::Plane(
                    row.span(columns, DrawnPlane { pass: self.pass(), covering, light }),
                ),
                None => Span::Sky { row: row.row, columns, image: None },
            });
        }
    }

    /// The plane with the covering and the light that hold unless the map has others.
    fn default_plane(&self) -> DrawnPlane {
        let world = self.scene.world;
        // A ceiling that is sky is cut by tile; off the map, it is not visible from on the map.
        let covering = self.covering(world.floor(), world.ceiling()).unwrap_or(world.floor());
        let light = world.ground().light.unwrap_or(Light::FULL);
        DrawnPlane { pass: self.pass(), covering, light }
    }

    /// The covering that this plane shows of the two; `None` for the sky.
    fn covering(&self, floor: Covering, ceiling: Ceiling) -> Option<Covering> {
        match (self.kind, ceiling) {
            (PlaneKind::Floor, _) => Some(floor),
            (PlaneKind::Ceiling, Ceiling::Covered(covering)) => Some(covering),
            (PlaneKind::Ceiling, Ceiling::Sky) => None,
        }
    }

    fn fogged(&self, color: Rgb, row: u32) -> Rgb {
        let distance = self.scene.projection.mapping(row).distance;
        let faded = Faded::of_plane(Light::FULL, self.scene.world.fog(), distance);
        faded.map_or(color, |faded| faded.apply(color))
    }

    /// The rows of the picture that the plane may cover.
    fn rows(&self) -> Range<u32> {
        let ground = self.scene.projection.first_row_of_ground();
        match self.kind {
            PlaneKind::Floor => ground..self.scene.projection.rows(),
            PlaneKind::Ceiling => 0..ground,
        }
    }

    /// The number of these rows that show the plane in `column`.
    fn visible(&self, column: &Column, rows: &Range<u32>) -> u32 {
        match self.kind {
            PlaneKind::Floor => column.rows_of_floor(rows.start, rows.end),
            PlaneKind::Ceiling => column.rows_of_ceiling(rows.end),
        }
    }

    fn pass(&self) -> Pass {
        match self.kind {
            PlaneKind::Floor => Pass::Floor,
            PlaneKind::Ceiling => Pass::Ceiling,
        }
    }
}

/// Emits the sky above all walls.
fn sky_overhead(
    scene: Scene<'_>,
    columns: &[Column],
    rows: &Range<u32>,
    emit: &mut impl FnMut(Span<'_>),
) {
    for row in common(rows, &(0..scene.projection.first_row_of_ground())) {
        match scene.plan.sky {
            // A fill of all rows takes less time than a search for the covered parts.
            SkyLoop::Gradient => emit(Span::Sky { row, columns: 0..columns.len(), image: None }),
            SkyLoop::Panorama => {
                let shows = |column: &Column| row < column.rows.start || column.hit.is_none();
                for columns in stretches(columns, shows) {
                    emit(Span::Sky { row, columns, image: None });
                }
            }
        }
    }
}

/// Emits the sky in columns whose rays left the map, over the ceiling up to the edge.
fn sky_beyond_edge(
    scene: Scene<'_>,
    columns: &[Column],
    rows: &Range<u32>,
    emit: &mut impl FnMut(Span<'_>),
) {
    let leaves = |column: &&Column| column.hit.is_none();
    let first_rows = columns.iter().filter(leaves).map(|column| column.rows.start);
    let Some(first) = first_rows.min() else { return };
    for row in common(rows, &(first..scene.projection.first_row_of_ground())) {
        let shows = |column: &Column| column.hit.is_none() && column.rows.start <= row;
        for columns in stretches(columns, shows) {
            emit(Span::Sky { row, columns, image: None });
        }
    }
}

/// The rows common to both.
fn common(one: &Range<u32>, other: &Range<u32>) -> Range<u32> {
    let Range { start, end } = *one;
    other.start.clamp(start, end)..other.end.clamp(start, end)
}

/// The longest stretches of `list` whose items are all `wanted`.
fn stretches<T>(list: &[T], wanted: impl Fn(&T) -> bool) -> impl Iterator<Item = Range<usize>> {
    let mut next = 0;
    std::iter::from_fn(move || {
        let start = next + list[next..].iter().position(&wanted)?;
        let rest = list[start..].iter().position(|item| !wanted(item));
        next = rest.map_or(list.len(), |length| start + length);
        Some(start..next)
    })
}

/// A row that shows the plane.
#[derive(Clone, Debug)]
pub(crate) struct PlaneRow {
    pub(crate) row: u32,
    pub(crate) mapping: SpanMapping,
    /// The first column of the span that has not ended yet.
    span_start: usize,
}

impl PlaneRow {
    pub(crate) fn new(scene: Scene<'_>, row: u32, span_start: usize) -> Self {
        Self { row, mapping: scene.projection.mapping(row), span_start }
    }

    /// The span of `columns` that shows `plane`.
    pub(crate) fn span(&self, columns: Range<usize>, plane: DrawnPlane) -> PlaneSpan<'_> {
        let DrawnPlane { pass, covering, light } = plane;
        PlaneSpan { pass, row: self.row, columns, covering, light, mapping: &self.mapping }
    }
}

/// Calls `emit` for every stretch of `columns` that shows a row of a plane. A column shows the first
/// `visible` rows, counted from the edge of the picture. `row_at` makes a row with its span's start.
fn for_each_stretch(
    columns: &[Column],
    visible: impl Fn(&Column) -> u32,
    memory: &mut Vec<PlaneRow>,
    row_at: impl Fn(u32, usize) -> PlaneRow,
    mut emit: impl FnMut(&PlaneRow, Range<usize>),
) {
    memory.clear();
    let mut before = 0;
    for (x, column) in columns.iter().enumerate() {
        let visible = visible(column) as usize;
        if visible > before {
            let known = memory.len();
            for row in &mut memory[before..visible.min(known)] {
                row.span_start = x;
            }
            for depth in known..visible {
                memory.push(row_at(depth as u32, x));
            }
        } else {
            for row in &memory[visible..before] {
                emit(row, row.span_start..x);
            }
        }
        before = visible;
    }
    for row in &memory[..before] {
        emit(row, row.span_start..columns.len());
    }
}

impl Plane<'_> {
    /// The tile of the cell with this north-west corner, and the light that lamps add to it; `None`
    /// off the map.
    fn ground_in(&self, corner: DVec2) -> Option<(TileId, Light)> {
        let world = self.scene.world;
        // Casts saturate, and convert NaN to 0.
        let is_a_place = corner.is_finite();
        let (column, row) = (corner.x as i64, corner.y as i64);
        let tile = is_a_place.then(|| world.grid().tile(column, row)).flatten()?;
        Some((tile, world.lamplight_in(Cell { column: column as u32, row: row as u32 })))
    }

    /// The same, where walls are blended over planes: the centre of a pixel at the foot of a wall may be inside
    /// the wall. The pixel that is nearer to the eye by a row then tells the ground.
    fn ground_before_walls(
        &self,
        corner: DVec2,
        (row, x): (u32, usize),
    ) -> Option<(TileId, Light)> {
        let Scene { world, projection, .. } = self.scene;
        let ground = self.ground_in(corner);
        let is_wall = |(tile, _): (TileId, Light)| {
            matches!(world.tiles()[usize::from(tile.0)].kind, TileKind::Wall(_))
        };
        if !ground.is_some_and(is_wall) {
            return ground;
        }
        let nearer = match self.kind {
            PlaneKind::Floor => row + 1,
            PlaneKind::Ceiling => row.saturating_sub(1),
        };
        let point = projection.mapping(nearer).just_before(projection.origin()).point(x);
        self.ground_in(point.floor())
    }
}
