//! Blended faces: walls that cover pixels in part, for the area filter.
//!
//! Such a pixel shows the mean, in linear light, of the wall and of the colour that it had before.
//! The weight of the wall is the share of the pixel that it covers.

use std::iter;
use std::ops::Range;

use super::band::Band;
use crate::color::Rgb;
use crate::color::srgb::{from_linear_16, linear_16};
use crate::visibility::{
    Face, FaceColumn, FaceEdges, Faded, Lighting, Projection, Rows, SlopedEdge, TextureStepper,
};

/// The columns of a face, reduced to the rows in which it covers whole pixels, and the top and bottom of each.
#[derive(Clone, Debug, Default)]
pub(crate) struct WholeColumns {
    pub(crate) columns: Vec<FaceColumn>,
    pub(crate) limits: Vec<[SlopedEdge; 2]>,
}

impl WholeColumns {
    /// Finds the whole rows of `face`, whose `columns` have the rows that it covers at least in part.
    pub(crate) fn find(
        &mut self,
        projection: &Projection,
        (face, edges): (&Face, &FaceEdges),
        columns: &[FaceColumn],
    ) {
        let Self { columns: wholes, limits } = self;
        wholes.clear();
        wholes.reserve(projection.columns());
        limits.clear();
        limits.reserve(projection.columns());
        let [tops, bottoms] = [face.top, face.bottom]
            .map(|height| edges.edges_in(projection, height, face.columns.clone()));
        limits.extend(tops.zip(bottoms).map(|(top, bottom)| [top, bottom]));
        let whole = |(column, limits): (&FaceColumn, &[SlopedEdge; 2])| FaceColumn {
            rows: whole_rows(projection, *limits, column.rows),
            ..*column
        };
        wholes.extend(columns.iter().zip(&*limits).map(whole));
    }
}

/// The part of `rows` whose pixels are between a top and a bottom as a whole.
pub(crate) fn whole_rows(projection: &Projection, limits: [SlopedEdge; 2], rows: Rows) -> Rows {
    let [top, bottom] = limits.map(|edge| edge.rows(projection.rows()));
    Rows { start: rows.start.max(top.end), end: rows.end.min(bottom.start) }
}

/// The colours of a column of a face.
pub(crate) enum FaceColors<'a> {
    Color(Rgb),
    Texels { texels: &'a [Rgb], stepper: TextureStepper, lighting: Faded },
}

/// A wall's part of a column that several walls share.
pub(crate) struct SharedPart<'a> {
    /// Its top and its bottom.
    pub(crate) limits: [SlopedEdge; 2],
    /// The share of the column's width that it covers.
    pub(crate) width: f64,
    /// The rows in which it covers this share from top to bottom of the pixel.
    pub(crate) whole: Rows,
    pub(crate) colors: FaceColors<'a>,
}

impl FaceColors<'_> {
    /// The colour in `row`.
    #[inline]
    fn at(&self, row: u32) -> Rgb {
        match self {
            Self::Color(color) => *color,
            Self::Texels { texels, stepper, lighting } => lighting.apply(texels[stepper.at(row)]),
        }
    }
}

/// Blends a column of a face over the pixels that it covers in part: the pixels of `rows` outside
/// `whole`.
pub(crate) fn draw_ends(
    (x, rows): (u32, Range<u32>),
    whole: Rows,
    limits: [SlopedEdge; 2],
    colors: &FaceColors<'_>,
    band: &mut Band<'_>,
) {
    let whole = if whole.is_empty() { rows.end..rows.end } else { whole.start..whole.end };
    let above = rows.start..whole.start.clamp(rows.start, rows.end);
    let below = whole.end.clamp(above.end, rows.end)..rows.end;
    for row in above.chain(below) {
        let share = in_parts_of_whole(covered(limits, row)).min(WHOLE);
        let pixel = band.pixel_mut(x, row);
        let mut light = [0; 3];
        add(&mut light, share, colors.at(row));
        add(&mut light, WHOLE - share, *pixel);
        *pixel = rounded(light);
    }
}

/// Blends the parts of walls that share column `x` over its pixels in `rows`.
pub(crate) fn draw_shared(
    (x, rows): (u32, Range<u32>),
    parts: &[Option<SharedPart<'_>>],
    band: &mut Band<'_>,
) {
    let parts = || parts.iter().flatten();
    for row in rows {
        let pixel = band.pixel_mut(x, row);
        let (mut light, mut left) = ([0; 3], WHOLE);
        let mut last = *pixel;
        for part in parts() {
            let is_whole = part.whole.start <= row && row < part.whole.end;
            let covered = if is_whole { 1.0 } else { covered(part.limits, row) };
            let share = in_parts_of_whole(covered * part.width).min(left);
            last = part.colors.at(row);
            add(&mut light, share, last);
            left -= share;
        }
        // Rounding may leave a small share uncovered.
        let is_covered = left <= parts().count() as u32;
        add(&mut light, left, if is_covered { last } else { *pixel });
        *pixel = rounded(light);
    }
}

/// The share of the pixel in `row` that is between a top and a bottom.
#[inline]
fn covered([top, bottom]: [SlopedEdge; 2], row: u32) -> f64 {
    (top.share_below(row) - bottom.share_below(row)).max(0.0)
}

/// The whole of a pixel.
const WHOLE: u32 = 1 << 16;

/// A share from 0 to 1, in parts of [`WHOLE`].
fn in_parts_of_whole(share: f64) -> u32 {
    (share * f64::from(WHOLE) + 0.5) as u32
}

/// Adds the linear light of `color`, multiplied by `share`, to `sums`.
fn add(sums: &mut [u32; 3], share: u32, color: Rgb) {
    for (sum, light) in iter::zip(sums, linear_16(color)) {
        *sum += share * u32::from(light);
    }
}

/// The colour of the light in `sums`.
fn rounded(sums: [u32; 3]) -> Rgb {
    from_linear_16(sums.map(|sum| ((sum + WHOLE / 2) / WHOLE) as u16))
}
