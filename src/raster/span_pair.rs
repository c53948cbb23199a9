//! Span pairs: a span of the ceiling and its mirror image, a span of the floor.
//!
//! If both planes have textures of the same size in full light, the indices of the texels are
//! computed once for both. The state that all pairs of two planes share, such as these textures, is
//! found once for the planes. Rejected: finding it for each pair. In small pictures, a span has a
//! dozen pixels, and this took as long as drawing them.

use std::ops::Range;

use super::planes::DrawnPlane;
use super::span::{self, AT_ONCE, PlaneSpan, Sampler, UNROLLED, for_each_block};
use super::target::Target;
use crate::color::Rgb;
use crate::visibility::{FrameContext, Lighting, SpanMapping, TexelPlaces};
use crate::world::texture::{MipLevelByShifts, Texture};
use crate::world::{Light, Paint, Pattern};

/// Draws a ceiling together with a floor that is its mirror image.
pub(crate) struct SpanPairs<'a> {
    scene: FrameContext<'a>,
    /// The ceiling and the floor.
    planes: [DrawnPlane; 2],
    /// The textures of the planes, if both have textures of the same size and the same light.
    textures: Option<TexturePair<'a>>,
}

/// A span of the ceiling and its mirror image, a span of the floor.
struct SpanPair<'m> {
    /// The row of each span. The first row is further up.
    rows: [u32; 2],
    columns: Range<usize>,
    planes: &'m [DrawnPlane; 2],
    mapping: &'m SpanMapping,
}

impl<'m> SpanPair<'m> {
    /// The two spans as separate spans, each with its light.
    fn spans(&self) -> [Option<(PlaneSpan<'m>, Light)>; 2] {
        let [ceiling, floor] = self.planes;
        let [above, below] = self.rows;
        [(above, ceiling), (below, floor)].map(|(row, plane)| {
            let span = PlaneSpan {
                pass: plane.pass,
                row,
                columns: self.columns.clone(),
                covering: plane.covering?,
                mapping: self.mapping,
            };
            Some((span, plane.light))
        })
    }
}

/// Two textures of the same size, on planes with the same light.
struct TexturePair<'a> {
    textures: [&'a Texture; 2],
    /// The number of repeats of the textures in a cell.
    per_cell: f64,
    light: Light,
    /// The levels of the previous pair.
    levels: Option<LevelPair<'a>>,
}

/// Two mip levels of the same size.
#[derive(Clone, Copy)]
struct LevelPair<'a> {
    lod: usize,
    upper: MipLevelByShifts<'a>,
    lower: &'a [Rgb],
}

impl<'a> SpanPairs<'a> {
    /// Prepares to draw these `planes`: a ceiling and a floor.
    pub(crate) fn new(scene: FrameContext<'a>, planes: [DrawnPlane; 2]) -> Self {
        Self { scene, planes, textures: TexturePair::new(scene, &planes) }
    }

    /// Draws `columns` of `row` of the floor, and their mirror image on the ceiling.
    pub(crate) fn draw(
        &mut self,
        (row, columns): (u32, Range<usize>),
        mapping: &SpanMapping,
        target: &mut Target<'_>,
    ) {
        let Self { scene, planes, textures } = self;
        let scene = *scene;
        let rows = [scene.projection.rows() - 1 - row, row];
        let pair = &SpanPair { rows, columns, planes, mapping };
        let drawn = textures.as_mut().and_then(|textures| textures.draw(scene, pair, target));
        if drawn.is_none() {
            for (span, light) in pair.spans().into_iter().flatten() {
                let lighting = Lighting::of_plane(light, scene.world.fog(), mapping.distance);
                lighting.apply_to_all(span::draw(scene, &span, target));
            }
        }
    }
}

impl<'a> TexturePair<'a> {
    fn new(scene: FrameContext<'a>, planes: &[DrawnPlane; 2]) -> Option<Self> {
        let [upper, lower] = planes;
        let (covering, light) = (upper.covering?, upper.light);
        let scale = covering.scale;
        let texture = |plane: &DrawnPlane| match plane.covering?.pattern {
            Pattern::Plain(Paint::Texture(id)) => Some(scene.world.texture(id)),
            _ => None,
        };
        let textures = [texture(upper)?, texture(lower)?];
        let [one, other] = textures.map(|texture| (texture.width(), texture.height()));
        let are_alike = one == other && scale == lower.covering?.scale && light == lower.light;
        are_alike.then(|| Self { textures, per_cell: 1.0 / scale.cells(), light, levels: None })
    }

    /// Draws `pair`. Draws nothing and returns `None` if its spans have to be drawn separately.
    fn draw(
        &mut self,
        scene: FrameContext<'_>,
        pair: &SpanPair<'_>,
        target: &mut Target<'_>,
    ) -> Option<()> {
        let (mapping, per_cell) = (pair.mapping, self.per_cell);
        if !Lighting::of_plane(self.light, scene.world.fog(), mapping.distance).is_full() {
            return None;
        }
        let lod = Sampler { scene, mapping, per_cell }.lod_of(self.textures[0]);
        let levels = match self.levels {
            Some(levels) if levels.lod == lod => levels,
            _ => *self.levels.insert(LevelPair::new(self.textures, lod)?),
        };
        let places = mapping.places(pair.columns.start, per_cell);
        match levels.lower.len() {
            16384 => draw_texels::<16384>(levels, places, pair, target),
            4096 => draw_texels::<4096>(levels, places, pair, target),
            1024 => draw_texels::<1024>(levels, places, pair, target),
            256 => draw_texels::<256>(levels, places, pair, target),
            64 => draw_texels::<64>(levels, places, pair, target),
            16 => draw_texels::<16>(levels, places, pair, target),
            4 => draw_texels::<4>(levels, places, pair, target),
            1 => draw_texels::<1>(levels, places, pair, target),
            _ => None,
        }
    }
}

impl<'a> LevelPair<'a> {
    /// The levels of two `textures` of the same size; `None` if a lookup of their texels needs
    /// multiplications.
    fn new(textures: [&'a Texture; 2], lod: usize) -> Option<Self> {
        let [upper, lower] = textures.map(|texture| texture.level(lod).by_shifts());
        Some(Self { lod, upper: upper?, lower: lower?.texels() })
    }
}

/// Draws `pair` from `levels`, which have `N` texels each.
fn draw_texels<const N: usize>(
    levels: LevelPair<'_>,
    places: TexelPlaces,
    pair: &SpanPair<'_>,
    target: &mut Target<'_>,
) -> Option<()> {
    let upper = levels.upper.texels().first_chunk::<N>()?;
    let lower = levels.lower.first_chunk::<N>()?;
    let passes = pair.planes.each_ref().map(|plane| plane.pass);
    let [above, below] = target.two_spans_mut(passes, pair.rows, &pair.columns);
    let blocks = above.chunks_mut(AT_ONCE).zip(below.chunks_mut(AT_ONCE));
    let blocks = blocks.map(|(above, below)| (above.len(), [above, below]));
    for_each_block(levels.upper, places, blocks, |indices, [above, below]| {
        let (above, rest_above) = above.as_chunks_mut::<UNROLLED>();
        let (below, rest_below) = below.as_chunks_mut::<UNROLLED>();
        let (indices, rest) = indices.split_at(above.as_flattened().len());
        let indices = indices.as_chunks::<UNROLLED>().0;
        for ((above, below), indices) in above.iter_mut().zip(below).zip(indices) {
            look_up((upper, lower), indices, (above, below));
        }
        look_up((upper, lower), rest, (rest_above, rest_below));
    });
    Some(())
}

/// Colours the pixels above and below by the indices of their texels. There are at least as many
/// indices as pixels in a row.
#[inline]
fn look_up<const N: usize>(
    (upper, lower): (&[Rgb; N], &[Rgb; N]),
    indices: &[u32],
    (above, below): (&mut [Rgb], &mut [Rgb]),
) {
    for ((above, below), &index) in above.iter_mut().zip(below).zip(indices) {
        // `N` is a power of two: no lookup needs a bounds check.
        let index = index as usize % N;
        *above = upper[index];
        *below = lower[index];
    }
}
