//! Runs: rows of a column of pixels that show the same floor, ceiling or sky.
//!
//! An entry for each pixel was refused: writing them, and comparing each with its neighbour to find spans,
//! took a fifth of a frame.

use std::ops::Range;

use super::Surface;
use crate::cast::{MirrorTransform, Side};
use crate::world::TileId;

/// The number of images in mirrors for which there is room from the first frame on.
pub(crate) const IMAGES_AT_ONCE: usize = 64;

/// The runs of all columns; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(crate) struct ColumnRuns {
    /// Those of each column together, from the top, without a hole between them.
    runs: Vec<Run>,
    /// Where those of each column begin; at last, where those of the last one end.
    bounds: Vec<usize>,
    /// Those of the column that is being filled, in no order.
    unsorted: Vec<Run>,
    /// Where what is seen is on the map: first as it is, and then in mirrors.
    images: Vec<MirrorTransform>,
}

/// Rows of a column that show the same.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub(crate) rows: Range<u32>,
    pub(crate) shown: Shown,
}

/// What a pixel shows behind all that is seen through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
    /// What the flat way fills.
    Flat,
    Sky(ImageId),
    /// An upright face.
    Face(Side),
    Plane(FlatSurface),
}

/// A floor, a ceiling, or the top of something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FlatSurface {
    /// `None` for the ground beyond the edge of the map.
    pub(crate) tile: Option<TileId>,
    pub(crate) part: Part,
    pub(crate) image: ImageId,
}

/// The flat parts of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// The floor, or the top of a wall.
    Floor,
    Ceiling,
    /// The top of what hangs above the ceiling.
    Roof,
    /// The top of a pillar.
    Top,
}

/// By which mirrors something is seen: an index into the list of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ImageId(pub(crate) u16);

impl ImageId {
    /// Seen directly.
    pub(crate) const NONE: Self = Self(0);
}

impl Shown {
    /// Its surface; `None` for what the flat way fills.
    pub(crate) fn surface(self) -> Option<Surface> {
        Some(match self {
            Self::Flat => return None,
            Self::Sky(_) => Surface::Sky,
            Self::Face(side) => Surface::of_wall(side),
            Self::Plane(FlatSurface { part: Part::Ceiling, .. }) => Surface::Ceiling,
            Self::Plane(_) => Surface::Floor,
        })
    }
}

impl ColumnRuns {
    /// Forgets the last frame.
    pub(crate) fn clear(&mut self) {
        self.runs.clear();
        self.bounds.clear();
        self.images.clear();
    }

    /// Makes room for the runs of `width` columns in all but the strangest maps.
    pub(crate) fn reserve(&mut self, width: usize) {
        const OF_A_COLUMN: usize = 16;
        self.runs.reserve(width * OF_A_COLUMN);
        self.bounds.reserve(width + 1);
        self.unsorted.reserve(OF_A_COLUMN);
        self.images.reserve(IMAGES_AT_ONCE);
    }

    /// Begins with the first column.
    pub(crate) fn begin(&mut self) {
        self.clear();
        self.bounds.push(0);
        self.images.push(MirrorTransform::default());
    }

    /// Leaves a column without runs: the flat way fills it.
    pub(crate) fn skip_column(&mut self) {
        self.bounds.push(self.runs.len());
    }

    /// Adds what `rows` of the column that is being filled show.
    #[inline]
    pub(crate) fn show(&mut self, rows: Range<u32>, shown: Shown) {
        if !rows.is_empty() {
            self.unsorted.push(Run { rows, shown });
        }
    }

    /// Ends the column that is being filled, which has `height` rows.
    pub(crate) fn end_column(&mut self, height: u32) {
        let Self { runs, bounds, unsorted, .. } = self;
        // Most floors come from the bottom up, so that they are mostly sorted from behind.
        unsorted.reverse();
        unsorted.sort_unstable_by_key(|run| run.rows.start);
        // Where a shape is met before its own cell, by rounding, a row is left out.
        let hole = |rows: Range<u32>| {
            (!rows.is_empty()).then_some(Run { rows, shown: Shown::Sky(ImageId::NONE) })
        };
        let mut above = 0;
        for run in unsorted.drain(..) {
            runs.extend(hole(above..run.rows.start));
            above = run.rows.end;
            runs.push(run);
        }
        runs.extend(hole(above..height));
        bounds.push(runs.len());
    }

    /// Whether no column has any.
    pub(crate) fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// The runs of each column, from left to right.
    pub(crate) fn columns(&self) -> impl ExactSizeIterator<Item = &[Run]> {
        self.bounds.windows(2).map(|bounds| &self.runs[bounds[0]..bounds[1]])
    }

    /// What pixel `(x, y)` shows; `None` where there is no such pixel.
    pub(crate) fn shown(&self, x: u32, y: u32) -> Option<Shown> {
        let &[start, end] = self.bounds.get(x as usize..)?.first_chunk()?;
        let column = &self.runs[start..end];
        let run = column.get(column.partition_point(|run| run.rows.end <= y))?;
        Some(run.shown)
    }

    /// The index of `image`. Of a map with more mirrors in view than there are indices, the last
    /// ones show the places of another.
    pub(crate) fn image_id(&mut self, image: MirrorTransform) -> ImageId {
        let known = self.images.iter().rposition(|&known| known == image);
        let index = known.unwrap_or_else(|| {
            if u16::try_from(self.images.len()).is_ok() {
                self.images.push(image);
            }
            self.images.len() - 1
        });
        ImageId(index as u16)
    }

    /// Where what is seen in an image is on the map.
    pub(crate) fn image(&self, ImageId(index): ImageId) -> MirrorTransform {
        self.images[usize::from(index)]
    }

    /// The images that are in view, the map itself first.
    pub(crate) fn images(&self) -> &[MirrorTransform] {
        &self.images
    }
}
