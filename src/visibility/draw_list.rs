//! The draw list: the contents of a frame, as spans, columns and billboards.
//!
//! Each kind is stored in the form in which it is found: rows of floor and ceiling by column, from
//! which spans are made for each band of rows; upright faces as wall columns; see-through columns
//! and billboards as layers, in the order of painting. Rejected: a list of finished spans. There
//! may be as many as pixels, and each band needs its own.
//!
//! In a block of columns, all layers behind the next translucent one are painted first, then the
//! translucent layers of all columns. This draws neighbours of one tint together, row by row.

use std::ops::Range;

use super::flat::PlaneRow;
use super::runs::{ColumnRuns, Shown};
use super::stats::Pass;
use super::wall_part::WallPart;
use super::{
    Billboard, Column, Material, Scene, SeeThroughColumn, SpanMapping, Surface, WallColumn,
    WallRun, WallSink, flat, portal,
};
use crate::cast::MirrorTransform;
use crate::color::Rgb;
use crate::world::{Covering, Light, Sprite};

/// The contents of a frame, in memory that is reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct DrawList {
    /// The hit of the ray of each column of pixels.
    pub(crate) columns: Vec<Column>,
    /// Whether the flat way filled any column.
    pub(crate) is_flat: bool,
    /// The columns as the flat way sees them, if the portal way filled some; else empty.
    pub(crate) flat_columns: Vec<Column>,
    /// The columns around which planes are drawn, if walls are blended over what is behind them: with the rows
    /// that walls cover as a whole; else empty.
    pub(crate) opaque_columns: Vec<Column>,
    /// The walls of these columns, from left to right.
    pub(crate) parts: Vec<WallPart>,
    /// The rows of floor, ceiling and sky that the portal way found.
    pub(crate) runs: ColumnRuns,
    /// The wall columns that the portal way found, those of a column of pixels together.
    pub(crate) walls: Vec<WallColumn>,
    /// Masked and translucent columns in any order: the layers give the order of painting.
    pub(crate) see_through: Vec<SeeThroughColumn>,
    /// The items that are painted in front of all others, in the order of painting.
    pub(crate) layers: Vec<Layer>,
    /// The billboards of the billboard columns among the layers.
    pub(crate) billboards: Vec<Billboard>,
    /// The player, as seen in mirrors; `None` until there is a mirror.
    pub(crate) player: Option<Sprite>,
}

/// Neighbouring pixels of a row that show a floor, a ceiling or the sky.
pub(crate) enum Span<'m> {
    /// Whole rows in one colour.
    Fill { pass: Pass, rows: Range<u32>, color: Rgb },
    /// A floor or a ceiling.
    Plane(PlaneSpan<'m>),
    /// A ceiling and a floor, with the same columns and the same mapping.
    Pair(SpanPair<'m>),
    /// The sky, directly or in the mirrors of `image`.
    Sky { row: u32, columns: Range<usize>, image: Option<MirrorTransform> },
}

/// A span of a floor or a ceiling, with one covering in one light.
pub(crate) struct PlaneSpan<'m> {
    pub(crate) pass: Pass,
    pub(crate) row: u32,
    pub(crate) columns: Range<usize>,
    pub(crate) covering: Covering,
    pub(crate) light: Light,
    /// The mapping from the row to the floor or the ceiling.
    pub(crate) mapping: &'m SpanMapping,
}

/// A span of the ceiling and its mirror image, a span of the floor.
pub(crate) struct SpanPair<'m> {
    /// The row of each; the first one is further up.
    pub(crate) rows: [u32; 2],
    pub(crate) columns: Range<usize>,
    /// The planes, which are the same for all pairs of a frame.
    pub(crate) planes: &'m [DrawnPlane; 2],
    pub(crate) mapping: &'m SpanMapping,
}

/// A floor or a ceiling with one covering in one light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawnPlane {
    pub(crate) pass: Pass,
    pub(crate) covering: Covering,
    pub(crate) light: Light,
}

/// Memory for making spans, one for each thread.
#[derive(Clone, Debug, Default)]
pub(crate) struct SpanMemory {
    plane_rows: Vec<PlaneRow>,
    /// The first column of the current span of each row.
    pub(crate) starts: Vec<usize>,
}

/// An item, as wide as a pixel, that is painted in front of the items before it.
#[derive(Clone, Debug)]
pub(crate) enum Layer {
    /// An index into the masked and translucent columns.
    SeeThrough(usize),
    /// A column of a billboard.
    Billboard(BillboardColumn),
}

/// A column of pixels of a billboard.
#[derive(Clone, Debug)]
pub(crate) struct BillboardColumn {
    pub(crate) column: u32,
    pub(crate) rows: Range<u32>,
    /// An index into the billboards.
    pub(crate) billboard: usize,
}

impl<'m> SpanPair<'m> {
    /// Both spans, each by itself.
    pub(crate) fn spans(&self) -> [PlaneSpan<'m>; 2] {
        let [ceiling, floor] = self.planes;
        let [above, below] = self.rows;
        [(above, ceiling), (below, floor)].map(|(row, plane)| PlaneSpan {
            pass: plane.pass,
            row,
            columns: self.columns.clone(),
            covering: plane.covering,
            light: plane.light,
            mapping: self.mapping,
        })
    }
}

impl DrawList {
    /// Removes the contents of the last frame.
    pub(crate) fn clear(&mut self) {
        self.columns.clear();
        self.is_flat = false;
        self.flat_columns.clear();
        self.opaque_columns.clear();
        self.parts.clear();
        self.runs.clear();
        self.walls.clear();
        self.see_through.clear();
        self.layers.clear();
        self.billboards.clear();
    }

    /// Reserves memory for the portal way in all but extreme maps, so that a turn of the camera
    /// towards more faces allocates nothing.
    pub(crate) fn make_room_for_portals(&mut self, width: usize) {
        const OF_A_COLUMN: usize = 16;
        self.columns.reserve(width);
        self.flat_columns.reserve(width);
        self.runs.reserve(width);
        self.walls.reserve(width * OF_A_COLUMN);
        self.make_room_for_layers(width * OF_A_COLUMN);
    }

    /// Reserves memory for this number of layers in total.
    pub(crate) fn make_room_for_layers(&mut self, count: usize) {
        self.see_through.reserve(count.saturating_sub(self.see_through.len()));
        self.layers.reserve(count.saturating_sub(self.layers.len()));
    }

    /// Adds a masked or translucent column as the next layer.
    pub(crate) fn push_see_through(&mut self, column: SeeThroughColumn) {
        if !column.rows.is_empty() {
            self.layers.push(Layer::SeeThrough(self.see_through.len()));
            self.see_through.push(column);
        }
    }

    /// Passes every span in `rows` to `emit`. `memory` is working memory.
    pub(crate) fn for_each_span(
        &self,
        scene: Scene<'_>,
        rows: &Range<u32>,
        memory: &mut SpanMemory,
        mut emit: impl FnMut(Span<'_>),
    ) {
        if self.is_flat {
            flat::for_each_span(
                scene,
                self.drawn_columns(),
                rows,
                &mut memory.plane_rows,
                &mut emit,
            );
        }
        portal::for_each_span(scene, &self.runs, rows, &mut memory.starts, &mut emit);
    }

    /// Passes every wall column in `rows` that the flat way found to `sink`, from left to right.
    #[inline]
    pub(crate) fn for_each_flat_wall_column(
        &self,
        scene: Scene<'_>,
        rows: &Range<u32>,
        sink: &mut impl WallSink,
    ) {
        if self.has_flat_walls() {
            flat::for_each_wall_column(scene, self.flat_columns(), rows, sink);
        }
    }

    /// Passes the same wall columns in runs to `draw`, from left to right. No shape may be in view.
    #[inline]
    pub(crate) fn for_each_wall_run<'l>(&'l self, scene: Scene<'_>, draw: impl FnMut(WallRun<'l>)) {
        if self.has_flat_walls() {
            flat::for_each_wall_run(scene, self.flat_columns(), draw);
        }
    }

    /// Passes every wall column in `rows` that the portal way found to `sink`, neighbours in succession as
    /// far as possible.
    #[inline]
    pub(crate) fn for_each_portal_wall_column(&self, rows: &Range<u32>, sink: &mut impl WallSink) {
        portal::for_each_wall_column(&self.walls, rows, sink);
    }

    /// Whether the flat way found walls that are drawn as columns.
    fn has_flat_walls(&self) -> bool {
        self.is_flat && self.opaque_columns.is_empty()
    }

    /// Passes every part of a wall to `draw`, from left to right, with the wall column in its middle: the walls of
    /// the flat way, if they are blended over what is behind them. The light is computed only if `is_lit`.
    pub(crate) fn for_each_wall_part<'l>(
        &'l self,
        scene: Scene<'_>,
        is_lit: bool,
        draw: impl FnMut(&'l WallPart, &WallColumn),
    ) {
        flat::for_each_wall_part(scene, &self.parts, is_lit, draw);
    }

    /// The columns around which the flat way draws planes.
    fn drawn_columns(&self) -> &[Column] {
        if self.opaque_columns.is_empty() { self.flat_columns() } else { &self.opaque_columns }
    }

    /// The columns as the flat way sees them.
    pub(crate) fn flat_columns(&self) -> &[Column] {
        if self.flat_columns.is_empty() { &self.columns } else { &self.flat_columns }
    }

    /// The surface of pixel `(x, y)` behind all layers; `None` if there is no column `x`.
    pub(crate) fn surface(&self, x: u32, y: u32, ground: u32) -> Option<Surface> {
        let column = self.flat_columns().get(x as usize)?;
        let shown = self.runs.shown(x, y).and_then(Shown::surface);
        Some(shown.unwrap_or_else(|| column.surface(y, ground)))
    }
}

/// The number of columns that are ordered together.
const BLOCK: usize = 32;

/// Adds the layers `by_column`, those of each column together from far to near, to `layers` in the
/// order of painting.
pub(crate) fn put_in_order(
    by_column: &[Layer],
    see_through: &[SeeThroughColumn],
    layers: &mut Vec<Layer>,
) {
    let column_of = |layer: &Layer| match layer {
        Layer::SeeThrough(index) => see_through[*index].column as usize,
        Layer::Billboard(column) => column.column as usize,
    };
    let is_glass = |layer: &Layer| match layer {
        Layer::SeeThrough(index) => {
            matches!(see_through[*index].material, Material::Translucent(_))
        }
        Layer::Billboard(_) => false,
    };
    for mut columns in by_columns::<BLOCK, _>(by_column, column_of) {
        while columns.iter().any(|column| !column.is_empty()) {
            let mut glass = [const { None }; BLOCK];
            for (column, glass) in columns.iter_mut().zip(&mut glass) {
                let before = column.iter().position(is_glass).unwrap_or(column.len());
                let (behind, rest) = column.split_at(before);
                layers.extend_from_slice(behind);
                (*glass, *column) = (rest.first(), &rest[rest.len().min(1)..]);
            }
            layers.extend(glass.into_iter().flatten().cloned());
        }
    }
}

/// The `items` of each block of `N` columns of pixels, split by column. The items of a column, and
/// those of a block, are contiguous.
fn by_columns<const N: usize, T>(
    items: &[T],
    column_of: impl Fn(&T) -> usize + Copy,
) -> impl Iterator<Item = [&[T]; N]> {
    let blocks = items.chunk_by(move |one, other| column_of(one) / N == column_of(other) / N);
    blocks.map(move |block| {
        let mut columns: [&[T]; N] = [&[]; N];
        for column in block.chunk_by(|one, other| column_of(one) == column_of(other)) {
            columns[column_of(&column[0]) % N] = column;
        }
        columns
    })
}
