//! The draw list: the contents of a frame, as planes, faces and layers.
//!
//! Visibility finds each item once for all of its columns, and stores for each column only the values that
//! differ. Drawing clips the rows to bands. Rejected: a list of finished spans. There may be as many spans as
//! pixels, and each band needs its own list.

use std::ops::Range;

use super::Billboard;
use super::face::{Face, FaceColumn, Material, Rows};
use super::fan::Directions;
use crate::cast::MirrorTransform;
use crate::color::Rgb;
use crate::world::{Light, PlaneSide, PlaneSurface, SectorId, Sectors, Sprite, TileId};

/// The contents of a frame, in memory that is reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct DrawList {
    /// The distance from the camera plane to the end of each column's ray, at a wall or at the edge of the map.
    pub(crate) distances: Vec<f64>,
    /// The directions of the rays of all columns.
    pub(crate) directions: Directions,
    pub(crate) sectors: Sectors,
    /// The images in view, the direct one first.
    pub(crate) images: Vec<MirrorTransform>,
    /// The backdrops below and above the horizon, behind all other items, if they are the same in all columns.
    pub(crate) backdrops: [Option<Backdrop>; 2],
    /// The floors and the ceilings, as visits find them.
    plane_parts: Vec<VisiblePlane>,
    /// The same, joined: planes in the order of drawing. A ceiling that may be the mirror image of a floor
    /// follows it.
    pub(crate) planes: Vec<VisiblePlane>,
    plane_order: Vec<PlaneKey>,
    /// The rows of each column of the planes.
    plane_rows: Vec<Rows>,
    /// The opaque faces.
    pub(crate) faces: Vec<Face>,
    /// The masks and tints.
    pub(crate) see_through: Vec<Face>,
    pub(crate) face_columns: Vec<FaceColumn>,
    /// The items that rays passed, from near to far in each column.
    pub(crate) passed: Vec<Layer>,
    /// The columns of the ray parts in `passed`.
    pub(crate) stretches: Vec<RaySegment>,
    /// The columns at the corners of the ray parts.
    pub(crate) corners: Vec<usize>,
    /// The items in front of all planes and opaque faces, in the order of painting.
    pub(crate) layers: Vec<Layer>,
    pub(crate) billboards: Vec<Billboard>,
    /// The rows of each column of the billboards in `layers`.
    pub(crate) billboard_rows: Vec<Rows>,
    /// The player, as seen in mirrors; `None` until there is a mirror.
    pub(crate) player: Option<Sprite>,
}

/// A floor, a ceiling or a sky without texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Backdrop {
    Color { color: Rgb, light: Light, height: f64 },
    Sky,
}

/// A floor, a ceiling or a sky in neighbouring columns.
#[derive(Clone, Debug)]
pub(crate) struct VisiblePlane {
    pub(crate) columns: Range<usize>,
    /// The index of the rows of the first column. The others follow.
    pub(crate) first: usize,
    pub(crate) kind: PlaneKind,
    pub(crate) height: f64,
    /// The look, if it is the same in all cells of the plane.
    pub(crate) look: Option<PlaneSurface>,
    /// The image in which it is seen.
    pub(crate) image: MirrorTransform,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PlaneKind {
    Floor(SectorId),
    Ceiling(SectorId),
    /// The top of a pillar of this tile.
    Top(TileId),
}

/// An item in front of the opaque faces.
#[derive(Clone, Debug)]
pub(crate) enum Layer {
    /// A mask or a tint: an index into `see_through`.
    Face(usize),
    /// The parts of rays in a sector, before their billboards are known.
    Part(RayPart),
    Billboard(BillboardPart),
}

/// The parts of neighbouring rays in one sector.
#[derive(Clone, Debug)]
pub(crate) struct RayPart {
    pub(crate) columns: Range<usize>,
    /// The index of the first stretch. The others follow.
    pub(crate) first: usize,
    /// The indices of the columns at the corners of the area that the parts cover on the map. Between two of
    /// them, the ends of the rays are on a straight line.
    pub(crate) corners: Range<usize>,
    pub(crate) sector: SectorId,
    /// The height of a pillar's top below the parts. The top hides everything lower.
    pub(crate) top_below: Option<f64>,
    pub(crate) image: MirrorTransform,
}

/// The part of a ray in one sector: the rows that no nearer surface covers, and the distances of its ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RaySegment {
    pub(crate) rows: Rows,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// Neighbouring columns of a billboard.
#[derive(Clone, Debug)]
pub(crate) struct BillboardPart {
    pub(crate) columns: Range<usize>,
    /// The index of the rows of the first column. The others follow.
    pub(crate) first: usize,
    /// An index into `billboards`.
    pub(crate) billboard: usize,
}

/// The sort key of a plane: the distance of its height from the eye, its image, its side and its index.
type PlaneKey = (u64, usize, u8, usize);

impl VisiblePlane {
    /// Returns true if `other` has the same height, side and image, and looks the same in each cell.
    fn is_alike(&self, other: &Self) -> bool {
        (self.height, self.kind.side(), self.look, self.image)
            == (other.height, other.kind.side(), other.look, other.image)
            && (self.look.is_some() || self.kind == other.kind)
    }
}

/// Adds `added` to the rows `known`, column by column. Adds nothing and returns `false` if they do not adjoin in
/// some column.
fn join_rows(known: &mut [Rows], added: &[Rows]) -> bool {
    let adjoin = |(known, added): (&Rows, &Rows)| {
        let are_both = !known.is_empty() && !added.is_empty();
        !are_both || known.end == added.start || added.end == known.start
    };
    if !known.iter().zip(added).all(adjoin) {
        return false;
    }
    for (known, added) in known.iter_mut().zip(added) {
        *known = match (known.is_empty(), added.is_empty()) {
            (true, _) => *added,
            (_, true) => *known,
            _ => Rows { start: known.start.min(added.start), end: known.end.max(added.end) },
        };
    }
    true
}

impl PlaneKind {
    pub(crate) fn side(self) -> PlaneSide {
        match self {
            Self::Floor(_) | Self::Top(_) => PlaneSide::Floor,
            Self::Ceiling(_) => PlaneSide::Ceiling,
        }
    }
}

impl DrawList {
    /// Removes the contents of the last frame, and reserves memory for all but extreme views of `width`
    /// columns. A turn of the camera towards more faces then allocates nothing.
    pub(crate) fn begin(&mut self, width: usize) {
        const OF_A_COLUMN: usize = 16;
        self.distances.clear();
        self.distances.resize(width, 0.0);
        self.images.clear();
        self.images.push(MirrorTransform::default());
        self.backdrops = [None; 2];
        for planes in [&mut self.plane_parts, &mut self.planes] {
            planes.clear();
            planes.reserve(4 * width);
        }
        self.plane_order.clear();
        self.plane_order.reserve(4 * width);
        self.plane_rows.clear();
        self.plane_rows.reserve(width * OF_A_COLUMN);
        self.faces.clear();
        self.faces.reserve(4 * width);
        self.see_through.clear();
        self.face_columns.clear();
        self.face_columns.reserve(width * OF_A_COLUMN);
        self.passed.clear();
        self.stretches.clear();
        self.corners.clear();
        self.layers.clear();
        self.billboards.clear();
        self.billboard_rows.clear();
    }

    /// Reserves memory for things, masks, glass and mirrors.
    pub(crate) fn make_room_for_layers(&mut self, width: usize, billboards: usize, images: usize) {
        const OF_A_COLUMN: usize = 16;
        self.images.reserve(images);
        self.see_through.reserve(4 * width);
        self.passed.reserve(8 * width);
        self.stretches.reserve(width * OF_A_COLUMN);
        self.corners.reserve(width * OF_A_COLUMN);
        self.layers.reserve(8 * width);
        self.billboards.reserve(billboards);
        self.billboard_rows.reserve(width * OF_A_COLUMN);
    }

    /// Adds a plane with these rows in `columns`, unless all of them are empty.
    #[inline]
    pub(crate) fn add_plane(
        &mut self,
        (kind, height): (PlaneKind, f64),
        look: Option<PlaneSurface>,
        image: MirrorTransform,
        columns: &Range<usize>,
        rows: impl Iterator<Item = Rows>,
    ) {
        let first = self.plane_rows.len();
        self.plane_rows.extend(rows);
        if self.plane_rows[first..].iter().all(|rows| rows.is_empty()) {
            self.plane_rows.truncate(first);
            return;
        }
        let columns = columns.clone();
        self.plane_parts.push(VisiblePlane { columns, first, kind, height, look, image });
    }

    /// Joins the planes that have the same height, look and image. Otherwise a cell with a shape, which is a
    /// separate sector, would cut the floor around it into short spans.
    pub(crate) fn join_planes(&mut self, eye: f64) {
        let mut order = std::mem::take(&mut self.plane_order);
        order.extend(self.plane_parts.iter().enumerate().map(|(index, plane)| {
            let from_eye = (plane.height - eye).abs().to_bits();
            (from_eye, self.index_of_image(plane.image), plane.kind.side() as u8, index)
        }));
        order.sort_unstable();
        let mut rest = order.as_slice();
        while let Some((&(.., first), others)) = rest.split_first() {
            let plane = &self.plane_parts[first];
            let is_alike = |key: &&PlaneKey| plane.is_alike(&self.plane_parts[key.3]);
            let count = others.iter().take_while(is_alike).count();
            rest = others;
            let mut joined = plane.clone();
            if count > 0 {
                joined.columns = others[..count].iter().fold(joined.columns, |columns, key| {
                    let others = &self.plane_parts[key.3].columns;
                    columns.start.min(others.start)..columns.end.max(others.end)
                });
                joined.first = self.plane_rows.len();
                let end = joined.first + joined.columns.len();
                self.plane_rows.resize(end, Rows::NONE);
                let (rows, of_joined) = self.plane_rows.split_at_mut(joined.first);
                let mut join = |part: &VisiblePlane| {
                    let rows = &rows[part.first..][..part.columns.len()];
                    let first = part.columns.start - joined.columns.start;
                    join_rows(&mut of_joined[first..][..rows.len()], rows)
                };
                join(plane);
                let parts = others[..count].iter().map(|key| &self.plane_parts[key.3]);
                rest = &others[parts.take_while(|part| join(part)).count()..];
            }
            self.planes.push(joined);
        }
        self.plane_order = order;
    }

    /// The first column of `plane`, and its rows from that column on.
    pub(crate) fn rows_of_plane(&self, plane: &VisiblePlane) -> (usize, &[Rows]) {
        (plane.columns.start, &self.plane_rows[plane.first..][..plane.columns.len()])
    }

    /// Adds a face whose columns are at the end of `face_columns`, unless it has no rows in any of them.
    pub(crate) fn push_face(&mut self, face: Face) {
        let first = face.first;
        if self.face_columns[first..].iter().all(|column| column.rows.is_empty()) {
            self.face_columns.truncate(first);
            return;
        }
        if !matches!(face.material, Material::Opaque(_)) {
            self.passed.push(Layer::Face(self.see_through.len()));
            self.see_through.push(face);
            return;
        }
        self.faces.push(face);
    }

    /// Returns true if the sky may be in view.
    pub(crate) fn shows_sky(&self) -> bool {
        let is_of_sky = |plane: &VisiblePlane| {
            plane.kind.side() == PlaneSide::Ceiling
                && plane.look.is_none_or(|look| look.covering.is_none())
        };
        self.backdrops.contains(&Some(Backdrop::Sky)) || self.planes.iter().any(is_of_sky)
    }

    /// The index of `image`, which must be in the list.
    pub(crate) fn index_of_image(&self, image: MirrorTransform) -> usize {
        self.images.iter().position(|&known| known == image).unwrap_or(0)
    }

    /// Adds an image, unless it is in the list already.
    pub(crate) fn add_image(&mut self, image: MirrorTransform) {
        if !self.images.contains(&image) {
            self.images.push(image);
        }
    }
}
