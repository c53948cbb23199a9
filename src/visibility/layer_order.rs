//! The order of layers: translucent columns that are neighbours are grouped.
//!
//! In a block of columns, all layers behind the next translucent one are painted first, then the
//! translucent layers of all columns. This draws neighbours of one tint together, row by row.

use super::{Layer, Material, SeeThroughColumn};

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
