//! Translucent columns: glass, and the tints of mirrors.
//!
//! Glass tints whole areas. Neighbouring columns of one tint are collected and drawn together, row
//! by row. Drawn one column after the other, the tints of mirrors took a fifth of a frame.

use std::ops::Range;

use super::target::Target;
use super::wall_column::lighting_of;
use crate::color::Rgb;
use crate::visibility::{Lighting, Pass, Scene, SeeThroughColumn};
use crate::world::Glass;

/// The most columns that are drawn together.
const COLUMNS_AT_ONCE: usize = 32;

/// Neighbouring columns of one tint that are not drawn yet.
#[derive(Default)]
pub(crate) struct Tints {
    color: Rgb,
    opacity: u8,
    columns: Range<u32>,
    /// The rows of each column, indexed by the column modulo the number of columns.
    rows: [Range<u32>; COLUMNS_AT_ONCE],
}

impl Tints {
    /// Adds `column`, which is made of `glass`. Draws the others first, if it cannot be drawn with
    /// them.
    pub(crate) fn add(
        &mut self,
        scene: Scene<'_>,
        column: &SeeThroughColumn,
        glass: Glass,
        target: &mut Target<'_>,
    ) {
        let rows = target.clip(&column.rows);
        target.count_pixels(Pass::SeeThrough, rows.len());
        let x = column.column;
        let lighting = lighting_of(scene, column.facing, column.light, column.t);
        let (color, opacity) = (lighting.apply(glass.color), glass.opacity);
        let Range { start, end } = self.columns;
        let is_alike = (color, opacity) == (self.color, self.opacity);
        let is_beside = x == end || x + 1 == start;
        if is_alike && is_beside && self.columns.len() < COLUMNS_AT_ONCE {
            self.columns = start.min(x)..end.max(x + 1);
        } else {
            self.draw(target);
            (self.color, self.opacity, self.columns) = (color, opacity, x..x + 1);
        }
        self.rows[x as usize % COLUMNS_AT_ONCE] = rows;
    }

    /// Draws the collected columns, if `column` is one of them, before another layer is painted
    /// over it.
    #[inline]
    pub(crate) fn draw_before(&mut self, column: u32, target: &mut Target<'_>) {
        if self.columns.contains(&column) {
            self.draw(target);
        }
    }

    /// Draws the collected columns.
    pub(crate) fn draw(&mut self, target: &mut Target<'_>) {
        let &mut Self { color, opacity, ref rows, .. } = self;
        let columns = std::mem::take(&mut self.columns);
        let rows_of = |x: u32| &rows[x as usize % COLUMNS_AT_ONCE];
        let start = columns.clone().map(|x| rows_of(x).start).max().unwrap_or_default();
        let end = columns.clone().map(|x| rows_of(x).end).min().unwrap_or_default().max(start);
        let band = target.band_mut();
        for row in start..end {
            let columns = columns.start as usize..columns.end as usize;
            color.paint_over(&mut band.row_mut(row)[columns], opacity);
        }
        for x in columns {
            let Range { start: top, end: bottom } = *rows_of(x);
            for rest in [top..bottom.min(start), top.max(end)..bottom] {
                for pixel in band.column_mut(x, rest) {
                    *pixel = color.over(*pixel, opacity);
                }
            }
        }
    }
}
