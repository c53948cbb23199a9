//! Runs: rows of a column of pixels that show the same floor, ceiling or sky.
//!
//! Rejected: an entry for each pixel. The writes, and the comparison of neighbours to find spans,
//! took a fifth of a frame.
//!
//! Runs are found in any order. Such items of a column form a chain in one vector, in which each knows
//! the one added before it to the same column. Rejected: a vector for each column, which would allocate
//! memory of its own.

use std::ops::Range;
use std::{iter, mem};

use super::Surface;
use crate::cast::{MirrorTransform, Side};
use crate::world::TileId;

/// The number of images in mirrors for which memory is reserved in advance.
pub(crate) const IMAGES_AT_ONCE: usize = 64;

/// The runs of all columns, in memory that is reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct ColumnRuns {
    /// The runs of each column together, from the top and without gaps.
    runs: Vec<Run>,
    /// The first run of each column, and the end of the last column's runs.
    bounds: Vec<usize>,
    /// The runs of each column, in any order.
    unsorted: Chains<Run>,
    /// Those of the current column.
    current: Vec<Run>,
    /// The transforms of the images to the map: first the direct view, then those in mirrors.
    images: Vec<MirrorTransform>,
}

/// Rows of a column with one content.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub(crate) rows: Range<u32>,
    pub(crate) shown: Shown,
}

/// The content of a pixel behind all layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
    /// The flat way fills the pixel.
    Flat,
    Sky(ImageId),
    /// An upright face.
    Face(Side),
    Plane(FlatSurface),
}

/// A floor, a ceiling, or the top of a wall or a pillar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FlatSurface {
    /// The tile; `None` for the ground beyond the edge of the map.
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
    /// The top of the solid part above the ceiling.
    Roof,
    /// The top of a pillar.
    Top,
}

/// The mirrors in which a surface is seen: an index into the images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ImageId(pub(crate) u16);

impl ImageId {
    /// The direct view.
    pub(crate) const NONE: Self = Self(0);
}

impl Shown {
    /// The kind of surface; `None` if the flat way fills the pixel.
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
    /// Removes the contents of the last frame.
    pub(crate) fn clear(&mut self) {
        self.runs.clear();
        self.bounds.clear();
        self.images.clear();
    }

    /// Reserves memory for the runs of `width` columns in all but extreme maps.
    pub(crate) fn reserve(&mut self, width: usize) {
        const OF_A_COLUMN: usize = 16;
        self.runs.reserve(width * OF_A_COLUMN);
        self.bounds.reserve(width + 1);
        self.unsorted.reserve(width, OF_A_COLUMN);
        self.current.clear();
        self.current.reserve(4 * OF_A_COLUMN);
        self.images.reserve(IMAGES_AT_ONCE);
    }

    /// Starts a frame of `width` columns.
    pub(crate) fn begin(&mut self, width: usize) {
        self.clear();
        self.unsorted.begin(width);
        self.images.push(MirrorTransform::default());
    }

    /// Adds the content of `rows` of `column`.
    #[inline]
    pub(crate) fn show(&mut self, column: u32, rows: Range<u32>, shown: Shown) {
        if !rows.is_empty() {
            self.unsorted.push(column, Run { rows, shown });
        }
    }

    /// Ends a frame of `height` rows. The flat way fills the columns for which `is_filled` does not hold.
    pub(crate) fn end(&mut self, height: u32, is_filled: impl Fn(usize) -> bool) {
        let Self { runs, bounds, unsorted, current, .. } = self;
        bounds.push(0);
        for column in 0..unsorted.width() {
            if is_filled(column) {
                // Most floors are added from the bottom up, so that the latest is mostly the uppermost.
                current.clear();
                for run in unsorted.latest_first(column) {
                    let below = current.iter().rposition(|above| above.rows.start < run.rows.start);
                    current.insert(below.map_or(0, |above| above + 1), run.clone());
                }
                fill_holes(current, height, runs);
            }
            bounds.push(runs.len());
        }
    }

    /// Whether no column has any runs.
    pub(crate) fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// The runs of each column, from left to right.
    pub(crate) fn columns(&self) -> impl ExactSizeIterator<Item = &[Run]> {
        self.bounds.windows(2).map(|bounds| &self.runs[bounds[0]..bounds[1]])
    }

    /// The content of pixel `(x, y)`; `None` if there is no such pixel.
    pub(crate) fn shown(&self, x: u32, y: u32) -> Option<Shown> {
        let &[start, end] = self.bounds.get(x as usize..)?.first_chunk()?;
        let column = &self.runs[start..end];
        let run = column.get(column.partition_point(|run| run.rows.end <= y))?;
        Some(run.shown)
    }

    /// The index of `image`. If more images are in view than there are indices, the last ones share
    /// an index and show the cells of another image.
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

    /// The transform of an image to the map.
    pub(crate) fn image(&self, ImageId(index): ImageId) -> MirrorTransform {
        self.images[usize::from(index)]
    }

    /// The images in view, the direct view first.
    pub(crate) fn images(&self) -> &[MirrorTransform] {
        &self.images
    }
}

/// Adds the runs of a column of `height` rows, which are `sorted`, to `runs`. If rounding puts a shape before
/// its own cell, a row is missing, and shows the sky.
fn fill_holes(sorted: &[Run], height: u32, runs: &mut Vec<Run>) {
    let hole = |rows: Range<u32>| {
        (!rows.is_empty()).then_some(Run { rows, shown: Shown::Sky(ImageId::NONE) })
    };
    let mut above = 0;
    for run in sorted {
        runs.extend(hole(above..run.rows.start));
        above = run.rows.end;
        runs.push(run.clone());
    }
    runs.extend(hole(above..height));
}

/// The items of each column, in memory that is reused from frame to frame.
#[derive(Clone, Debug)]
pub(crate) struct Chains<T> {
    /// Each item, with the index of the one before it in its column.
    links: Vec<(T, u32)>,
    /// The index of the latest item of each column.
    latest: Vec<u32>,
}

/// The index of an item in a column that has none.
const NONE: u32 = u32::MAX;

impl<T> Default for Chains<T> {
    fn default() -> Self {
        Self { links: Vec::new(), latest: Vec::new() }
    }
}

impl<T> Chains<T> {
    /// Removes all items, and begins with `width` columns.
    pub(crate) fn begin(&mut self, width: usize) {
        self.links.clear();
        self.latest.clear();
        self.latest.resize(width, NONE);
    }

    /// Reserves memory for `width` columns with this number of items each.
    pub(crate) fn reserve(&mut self, width: usize, of_a_column: usize) {
        self.begin(0);
        self.links.reserve(width * of_a_column);
        self.latest.reserve(width);
    }

    /// Adds `item` to `column`.
    #[inline]
    pub(crate) fn push(&mut self, column: u32, item: T) {
        let latest = &mut self.latest[column as usize];
        let before = mem::replace(latest, self.links.len() as u32);
        self.links.push((item, before));
    }

    /// The items of `column`, from the last added to the first.
    #[inline]
    pub(crate) fn latest_first(&self, column: usize) -> impl Iterator<Item = &T> {
        let mut index = self.latest[column];
        iter::from_fn(move || {
            let (item, before) = self.links.get(index as usize)?;
            index = *before;
            Some(item)
        })
    }

    /// The number of columns.
    pub(crate) fn width(&self) -> usize {
        self.latest.len()
    }

    /// All items, in the order in which they were added.
    #[cfg(test)]
    pub(crate) fn items(&self) -> impl Iterator<Item = &T> {
        self.links.iter().map(|(item, _)| item)
    }
}
