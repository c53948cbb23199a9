//! The draw list: what a frame shows, as spans, columns and billboards.
//!
//! Each kind is kept in the form in which it is found: rows of floor and ceiling as what each column
//! leaves open of them, from which spans are made for each band of rows; upright faces as wall columns;
//! what is painted over all that as layers, in the order of painting. A list of finished spans was
//! refused: there may be as many as pixels, and each band needs its own.

use std::ops::Range;

use super::flat::{self, PlaneRow};
use super::portal;
use super::runs::{ColumnRuns, Shown};
use super::stats::Pass;
use super::{Billboard, Column, Facing, Scene, SpanMapping, Surface};
use crate::cast::MirrorTransform;
use crate::color::Rgb;
use crate::world::{Covering, Glass, Light, Paint, Sprite, TextureId};

/// What a frame shows; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(crate) struct DrawList {
    /// What the ray of each column of pixels met.
    pub(crate) columns: Vec<Column>,
    /// Whether the flat way filled any of them.
    pub(super) is_flat: bool,
    /// The columns as the flat way sees them, where the portal way filled some; else they are the same.
    pub(super) flat_columns: Vec<Column>,
    /// The rows of floor, ceiling and sky that the portal way found.
    pub(crate) runs: ColumnRuns,
    /// The wall columns that the portal way found, those of a column of pixels together.
    pub(crate) walls: Vec<WallColumn>,
    /// Masked and translucent columns, in no order: the layers say when each is painted.
    pub(crate) see_through: Vec<SeeThroughColumn>,
    /// What is painted over all else, in that order.
    pub(crate) layers: Vec<Layer>,
    /// What the billboard columns among the layers show.
    pub(crate) billboards: Vec<Billboard>,
    /// The player, as mirrors show them; `None` until there is a mirror.
    pub(crate) player: Option<Sprite>,
}

/// Pixels side by side in a row that show a floor, a ceiling or the sky.
pub(crate) enum Span<'m> {
    /// Whole rows in one colour.
    Fill { pass: Pass, rows: Range<u32>, color: Rgb },
    /// A floor or a ceiling.
    Plane(PlaneSpan<'m>),
    /// The sky, by the mirrors in which it is seen.
    Sky { row: u32, columns: Range<usize>, image: Option<MirrorTransform> },
}

/// A span of a floor or a ceiling, with one covering in one light.
pub(crate) struct PlaneSpan<'m> {
    pub(crate) pass: Pass,
    pub(crate) row: u32,
    pub(crate) columns: Range<usize>,
    pub(crate) covering: Covering,
    pub(crate) light: Light,
    /// Where the row is on the floor or the ceiling.
    pub(crate) mapping: &'m SpanMapping,
}

/// Memory for making spans, one for each thread.
#[derive(Clone, Debug, Default)]
pub(crate) struct SpanMemory {
    pub(super) plane_rows: Vec<PlaneRow>,
    /// The column in which the span of each row begins.
    pub(super) starts: Vec<usize>,
}

/// An upright face as wide as a pixel, as far as it is in view.
#[derive(Clone, Debug)]
pub(crate) struct WallColumn {
    pub(crate) column: u32,
    pub(crate) rows: Range<u32>,
    pub(crate) facing: Facing,
    /// How many cells the ray comes nearer to the face for each unit of `t`.
    pub(crate) slope: f64,
    pub(crate) t: f64,
    pub(crate) u: f64,
    pub(crate) paint: Paint,
    pub(crate) light: Light,
    pub(crate) extent: Extent,
}

/// Something that takes wall columns.
///
/// It is no closure, because each loop over wall columns has to have it inlined.
pub(crate) trait WallSink {
    /// Takes what of `wall` is in `rows`, which are some.
    fn take(&mut self, wall: &WallColumn, rows: Range<u32>);
}

/// A masked or translucent face as wide as a pixel, or the tint of a mirror.
#[derive(Clone, Debug)]
pub(crate) struct SeeThroughColumn {
    pub(crate) column: u32,
    pub(crate) rows: Range<u32>,
    pub(crate) facing: Facing,
    /// As of a [`WallColumn`].
    pub(crate) slope: f64,
    pub(crate) t: f64,
    pub(crate) u: f64,
    pub(crate) light: Light,
    pub(crate) material: Material,
    pub(crate) extent: Extent,
}

/// What is seen through.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Material {
    /// A texture with holes.
    Masked(TextureId),
    /// A tint.
    Translucent(Glass),
}

/// From which height to which a face reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Extent {
    /// From floor to ceiling of a level scene: from 0 to 1.
    Level,
    /// From one height to another.
    Heights { bottom: f64, top: f64 },
}

/// What is painted over what is behind it, as wide as a pixel.
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

impl DrawList {
    /// Forgets the last frame.
    pub(super) fn clear(&mut self) {
        self.columns.clear();
        self.is_flat = false;
        self.flat_columns.clear();
        self.runs.clear();
        self.walls.clear();
        self.see_through.clear();
        self.layers.clear();
        self.billboards.clear();
    }

    /// Makes room for what the portal way finds in all but the strangest maps, so that a camera that turns
    /// towards more of it needs no more memory.
    pub(super) fn make_room_for_portals(&mut self, width: usize) {
        const OF_A_COLUMN: usize = 16;
        self.columns.reserve(width);
        self.flat_columns.reserve(width);
        self.runs.reserve(width);
        self.walls.reserve(width * OF_A_COLUMN);
        self.make_room_for_layers(width * OF_A_COLUMN);
    }

    /// Makes room for that many layers, those that there are included.
    pub(super) fn make_room_for_layers(&mut self, count: usize) {
        self.see_through.reserve(count.saturating_sub(self.see_through.len()));
        self.layers.reserve(count.saturating_sub(self.layers.len()));
    }

    /// Adds a masked or translucent column as the next layer.
    pub(super) fn push_see_through(&mut self, column: SeeThroughColumn) {
        if !column.rows.is_empty() {
            self.layers.push(Layer::SeeThrough(self.see_through.len()));
            self.see_through.push(column);
        }
    }

    /// Hands every span in `rows` to `emit`. `memory` is memory to work with.
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
                self.flat_columns(),
                rows,
                &mut memory.plane_rows,
                &mut emit,
            );
        }
        portal::for_each_span(scene, &self.runs, rows, &mut memory.starts, &mut emit);
    }

    /// Hands every wall column in `rows` to `sink`: neighbours one after the other, as far as possible.
    /// The light is right only where it `is_lit`.
    #[inline]
    pub(crate) fn for_each_wall_column(
        &self,
        scene: Scene<'_>,
        rows: &Range<u32>,
        is_lit: bool,
        sink: &mut impl WallSink,
    ) {
        if self.is_flat {
            flat::for_each_wall_column(scene, self.flat_columns(), rows, is_lit, sink);
        }
        portal::for_each_wall_column(&self.walls, rows, sink);
    }

    /// The columns as the flat way sees them.
    pub(super) fn flat_columns(&self) -> &[Column] {
        if self.flat_columns.is_empty() { &self.columns } else { &self.flat_columns }
    }

    /// What pixel `(x, y)` shows but for what is painted over it; `None` where there is no column `x`.
    pub(crate) fn surface(&self, x: u32, y: u32, ground: u32) -> Option<Surface> {
        let column = self.flat_columns().get(x as usize)?;
        let shown = self.runs.shown(x, y).and_then(Shown::surface);
        Some(shown.unwrap_or_else(|| column.surface(y, ground)))
    }
}
