//! The pass for floor and ceiling: what is above and below the walls.
//!
//! A row of pixels shows one straight line of the floor, at one distance: its shade and its level are
//! found once, and its pixels lie side by side in memory. So it goes by rows, over the spans that no
//! wall hides, and not by columns, which would find out the same again for every pixel. Nor is a row
//! searched for its spans: that takes half as long as laying them. One colour everywhere is simply a
//! fill: at 160×90 pixels that takes less time than asking every column where its wall begins.

use std::ops::Range;

use glam::DVec2;

use super::band::Band;
use super::lay::Layer;
use super::plan::PlaneLoop;
use super::shade::{Faded, Shade};
use super::sky::SkyView;
use super::tally::{Pass, Tally};
use super::track::Track;
use super::{Column, Scene};
use crate::color::Rgb;
use crate::world::{Ceiling, Cell, Covering, Light, TileId};

/// One of the two planes, and what there is to know to draw it.
pub(super) struct Plane<'a> {
    pub(super) scene: Scene<'a>,
    pub(super) kind: PlaneKind,
    /// What shows where a tile of the ceiling is open to the sky.
    pub(super) sky: &'a SkyView<'a>,
    /// How many rows the picture has.
    pub(super) height: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlaneKind {
    Floor,
    Ceiling,
}

/// A row that shows the plane.
#[derive(Clone, Debug)]
pub(super) struct RowOfPlane {
    row: u32,
    track: Track,
    /// Where the span begins that has not ended yet.
    span_start: usize,
}

impl Plane<'_> {
    /// Draws what `band` shows of the plane.
    pub(super) fn draw<T: Tally>(
        &self,
        plan: PlaneLoop,
        memory: &mut Vec<RowOfPlane>,
        band: &mut Band<'_>,
        tally: &mut T,
    ) {
        match plan {
            PlaneLoop::Fill(color) => {
                let pixels = band.rows_mut(band.clip(&self.rows()));
                tally.pixels(self.pass(), pixels.len());
                pixels.fill(color);
            }
            PlaneLoop::FillRows(color) => {
                for row in band.clip(&self.rows()) {
                    let pixels = band.row_mut(row);
                    tally.pixels(self.pass(), pixels.len());
                    pixels.fill(self.fogged(color, row));
                }
            }
            PlaneLoop::Spans => self.draw_spans(memory, band, |track, _, span, pixels| {
                self.lay_default(track, span.start, pixels, tally);
            }),
            PlaneLoop::Tiles => self.draw_spans(memory, band, |track, row, span, pixels| {
                self.draw_by_tile(track, row, span, pixels, tally);
            }),
        }
    }

    /// Calls `draw` for every span of pixels that shows the plane.
    ///
    /// Spans end where the next column shows less of the plane, and begin where it shows more: there
    /// are as many as that, and no row is searched for them.
    fn draw_spans(
        &self,
        rows: &mut Vec<RowOfPlane>,
        band: &mut Band<'_>,
        mut draw: impl FnMut(&Track, u32, Range<usize>, &mut [Rgb]),
    ) {
        let all = self.rows();
        let Range { start, end } = band.clip(&all);
        let row_at = |depth: u32| match self.kind {
            PlaneKind::Floor => end - 1 - depth,
            PlaneKind::Ceiling => start + depth,
        };
        // Rows of the plane that other bands have: those nearer to the edge of the picture show it, too.
        let elsewhere = match self.kind {
            PlaneKind::Floor => all.end - end,
            PlaneKind::Ceiling => start - all.start,
        };
        let visible =
            |column: &Column| self.visible(column, &all).saturating_sub(elsewhere).min(end - start);
        let most = self.scene.columns.iter().map(visible).max().unwrap_or_default();
        rows.clear();
        // However much of it shows later, there is room.
        rows.reserve((end - start) as usize);
        rows.extend((0..most).map(|depth| {
            let row = row_at(depth);
            RowOfPlane { row, track: self.scene.projection.track(row), span_start: 0 }
        }));
        let mut before = 0;
        let columns = self.scene.columns.iter().map(visible).chain([0]);
        for (x, visible) in columns.enumerate() {
            if visible > before {
                let begun = &mut rows[before as usize..visible as usize];
                for row in begun {
                    row.span_start = x;
                }
            } else {
                for row in &rows[visible as usize..before as usize] {
                    let span = row.span_start..x;
                    let pixels = &mut band.row_mut(row.row)[span.clone()];
                    draw(&row.track, row.row, span, pixels);
                }
            }
            before = visible;
        }
    }

    /// Draws a span, each stretch of it as its tile says.
    fn draw_by_tile<T: Tally>(
        &self,
        track: &Track,
        row: u32,
        span: Range<usize>,
        mut pixels: &mut [Rgb],
        tally: &mut T,
    ) {
        let Scene { world, projection, .. } = self.scene;
        let places = track.just_before(projection.origin());
        let grounds = places.cells(span).map(|(corner, columns)| (self.ground_in(corner), columns));
        let mut grounds = grounds.peekable();
        while let Some((ground, mut columns)) = grounds.next() {
            while let Some((_, more)) = grounds.next_if(|&(next, _)| next == ground) {
                columns.end = more.end;
            }
            let (stretch, rest) = pixels.split_at_mut(columns.len());
            pixels = rest;
            let x = columns.start;
            match ground {
                None => self.lay_default(track, x, stretch, tally),
                Some((tile, lamplight)) => {
                    let tile = world.tile(tile);
                    let light = tile.light.unwrap_or(Light::FULL).plus(lamplight);
                    match self.covering(tile.floor, tile.ceiling) {
                        Some(covering) => {
                            self.layer().lay(covering, light, track, x, stretch, tally);
                        }
                        None => self.sky.draw(row, x, stretch, tally),
                    }
                }
            }
        }
    }

    /// Draws a span where nothing but the map says what it is laid with.
    fn lay_default<T: Tally>(&self, track: &Track, x: usize, pixels: &mut [Rgb], tally: &mut T) {
        let world = self.scene.world;
        // A ceiling that is sky is drawn by tile; off the map it is seen by nobody on the map.
        let covering = self.covering(world.floor(), world.ceiling()).unwrap_or(world.floor());
        let light = world.ground().light.unwrap_or(Light::FULL);
        self.layer().lay(covering, light, track, x, pixels, tally);
    }

    /// The one of the two that this plane shows; `None` for the sky.
    fn covering(&self, floor: Covering, ceiling: Ceiling) -> Option<Covering> {
        match (self.kind, ceiling) {
            (PlaneKind::Floor, _) => Some(floor),
            (PlaneKind::Ceiling, Ceiling::Covered(covering)) => Some(covering),
            (PlaneKind::Ceiling, Ceiling::Sky) => None,
        }
    }

    /// The tile of the cell with that north-west corner, and what lamps add to its light; `None` off
    /// the map.
    fn ground_in(&self, corner: DVec2) -> Option<(TileId, Light)> {
        let world = self.scene.world;
        // Casts saturate, and take what is not a number to 0.
        let is_a_place = corner.is_finite();
        let (column, row) = (corner.x as i64, corner.y as i64);
        let tile = is_a_place.then(|| world.grid().tile(column, row)).flatten()?;
        Some((tile, world.lamplight_in(Cell { column: column as u32, row: row as u32 })))
    }

    fn fogged(&self, color: Rgb, row: u32) -> Rgb {
        let distance = self.scene.projection.track(row).distance;
        let faded = Faded::of_plane(Light::FULL, self.scene.world.fog(), distance);
        faded.map_or(color, |faded| faded.apply(color))
    }

    /// The plane's part of the picture.
    fn rows(&self) -> Range<u32> {
        let ground = self.scene.projection.first_row_of_ground();
        match self.kind {
            PlaneKind::Floor => ground..self.height,
            PlaneKind::Ceiling => 0..ground,
        }
    }

    /// How many rows of the plane's part of the picture show it in `column`.
    fn visible(&self, column: &Column, rows: &Range<u32>) -> u32 {
        match self.kind {
            PlaneKind::Floor => column.rows_of_floor(rows.start, rows.end),
            PlaneKind::Ceiling => column.rows_of_ceiling(rows.end),
        }
    }

    fn layer(&self) -> Layer<'_> {
        let Scene { world, filter, .. } = self.scene;
        Layer { world, filter, pass: self.pass() }
    }

    fn pass(&self) -> Pass {
        match self.kind {
            PlaneKind::Floor => Pass::Floor,
            PlaneKind::Ceiling => Pass::Ceiling,
        }
    }
}

/// The stretches of `list`, as long as possible, whose items all are `wanted`.
pub(super) fn spans<T>(
    list: &[T],
    wanted: impl Fn(&T) -> bool,
) -> impl Iterator<Item = Range<usize>> {
    let mut next = 0;
    std::iter::from_fn(move || {
        let start = next + list[next..].iter().position(&wanted)?;
        let rest = list[start..].iter().position(|item| !wanted(item));
        next = rest.map_or(list.len(), |length| start + length);
        Some(start..next)
    })
}
