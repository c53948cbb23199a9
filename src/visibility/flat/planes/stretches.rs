//! Stretches: the neighbouring columns that show a row of a plane.

use std::ops::Range;

use crate::visibility::{Column, DrawnPlane, PlaneSpan, Scene, SpanMapping};

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
pub(crate) fn for_each_stretch(
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
