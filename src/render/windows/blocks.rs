//! Blocks: columns of pixels side by side that are drawn together.

/// What is in each block of `N` columns: of each column its `items`, in their order. Those of a column are
/// together among them, and so are those of a block.
pub(super) fn by_columns<const N: usize, T>(
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
