//! Spans of floors and ceilings: the inner loops for each kind of pattern.

use std::ops::Range;

use super::pieces;
use super::target::Target;
use crate::color::Rgb;
use crate::color::srgb::mean_of_two;
use crate::visibility::{FrameContext, Pass, SpanMapping, TexelPlaces};
use crate::world::texture::{MipLevel, MipLevelByShifts};
use crate::world::{Covering, Paint, Pattern, Texture};

/// Neighbouring pixels of a row that show one covering.
pub(crate) struct PlaneSpan<'m> {
    pub(crate) pass: Pass,
    pub(crate) row: u32,
    pub(crate) columns: Range<usize>,
    pub(crate) covering: Covering,
    /// The mapping from the row to the floor or the ceiling.
    pub(crate) mapping: &'m SpanMapping,
}

/// Draws `span` in full light and without fog. Returns its pixels.
pub(crate) fn draw<'p>(
    scene: FrameContext<'_>,
    span: &PlaneSpan<'_>,
    target: &'p mut Target<'_>,
) -> &'p mut [Rgb] {
    let &PlaneSpan { pass, row, ref columns, covering, mapping } = span;
    let per_cell = 1.0 / covering.scale.cells();
    let sampler = Sampler { scene, mapping, per_cell };
    let color = match covering.pattern {
        Pattern::Checker(paints) | Pattern::Stripes(paints) if sampler.is_blurred() => {
            let [one, other] = paints.map(|paint| sampler.mean(paint));
            mean_of_two(one, other)
        }
        Pattern::Plain(paint) => match sampler.sample(paint) {
            Sample::Color(color) => color,
            Sample::Level(level) => {
                target.count_texels(pass, columns.len());
                let pixels = target.span_mut(pass, row, columns.clone());
                draw_level(level, mapping.places(columns.start, per_cell), pixels);
                return pixels;
            }
        },
        Pattern::Checker(paints) => {
            let samples = paints.map(|it| sampler.sample(it));
            return pieces::draw::<true>(span, &samples, target);
        }
        Pattern::Stripes(paints) => {
            let samples = paints.map(|it| sampler.sample(it));
            return pieces::draw::<false>(span, &samples, target);
        }
    };
    let pixels = target.span_mut(pass, row, columns.clone());
    pixels.fill(color);
    pixels
}

/// Draws `level` on `pixels`.
pub(crate) fn draw_level(level: &MipLevel, places: TexelPlaces, pixels: &mut [Rgb]) {
    let Some(level) = level.by_shifts() else {
        for (pixel, (x, y)) in pixels.iter_mut().zip(places) {
            *pixel = level.at_fraction(x, y);
        }
        return;
    };
    // For the usual numbers of texels, no lookup needs a bounds check.
    match level.texels().len() {
        16384 => draw_texels::<16384>(level, places, pixels),
        4096 => draw_texels::<4096>(level, places, pixels),
        1024 => draw_texels::<1024>(level, places, pixels),
        256 => draw_texels::<256>(level, places, pixels),
        64 => draw_texels::<64>(level, places, pixels),
        16 => draw_texels::<16>(level, places, pixels),
        _ => {
            for (pixel, (x, y)) in pixels.iter_mut().zip(places) {
                *pixel = level.at_index(level.index(x, y));
            }
        }
    }
}

/// Draws two levels of the same size on as many pixels each.
pub(crate) fn draw_two_levels(
    levels: [&MipLevel; 2],
    places: TexelPlaces,
    [above, below]: [&mut [Rgb]; 2],
) {
    let both = levels.map(MipLevel::texels);
    match (levels[0].by_shifts(), both[0].len()) {
        (Some(level), 16384) => draw_both::<16384>(level, both, places, [above, below]),
        (Some(level), 4096) => draw_both::<4096>(level, both, places, [above, below]),
        (Some(level), 1024) => draw_both::<1024>(level, both, places, [above, below]),
        (Some(level), 256) => draw_both::<256>(level, both, places, [above, below]),
        (Some(level), 64) => draw_both::<64>(level, both, places, [above, below]),
        (Some(level), 16) => draw_both::<16>(level, both, places, [above, below]),
        (Some(level), 4) => draw_both::<4>(level, both, places, [above, below]),
        (Some(level), 1) => draw_both::<1>(level, both, places, [above, below]),
        _ => {
            draw_level(levels[0], places.clone(), above);
            draw_level(levels[1], places, below);
        }
    }
}

/// Draws `level`, which has `N` texels, on `pixels`.
fn draw_texels<const N: usize>(
    level: MipLevelByShifts<'_>,
    places: TexelPlaces,
    pixels: &mut [Rgb],
) {
    let Some(texels) = level.texels().first_chunk::<N>() else { return };
    let blocks = pixels.chunks_mut(AT_ONCE).map(|pixels| (pixels.len(), pixels));
    for_each_block(level, places, blocks, |indices, pixels| {
        // The compiler does not unroll this loop by itself.
        let (pixels, rest) = pixels.as_chunks_mut::<UNROLLED>();
        let (indices, rest_of_indices) = indices.split_at(pixels.as_flattened().len());
        for (pixels, indices) in pixels.iter_mut().zip(indices.as_chunks::<UNROLLED>().0) {
            for (pixel, &index) in pixels.iter_mut().zip(indices) {
                *pixel = texels[index as usize % N];
            }
        }
        for (pixel, &index) in rest.iter_mut().zip(rest_of_indices) {
            *pixel = texels[index as usize % N];
        }
    });
}

/// Draws the texels of two levels of the shape of `level`, `N` each.
fn draw_both<const N: usize>(
    level: MipLevelByShifts<'_>,
    texels: [&[Rgb]; 2],
    places: TexelPlaces,
    [above, below]: [&mut [Rgb]; 2],
) {
    let [Some(upper), Some(lower)] = texels.map(|texels| texels.first_chunk::<N>()) else { return };
    let look_up = |indices: &[u32], above: &mut [Rgb], below: &mut [Rgb]| {
        for ((above, below), &index) in above.iter_mut().zip(below).zip(indices) {
            let index = index as usize % N;
            *above = upper[index];
            *below = lower[index];
        }
    };
    let blocks = above.chunks_mut(AT_ONCE).zip(below.chunks_mut(AT_ONCE));
    let blocks = blocks.map(|(above, below)| (above.len(), [above, below]));
    for_each_block(level, places, blocks, |indices, [above, below]| {
        let (above, rest_above) = above.as_chunks_mut::<UNROLLED>();
        let (below, rest_below) = below.as_chunks_mut::<UNROLLED>();
        let (indices, rest) = indices.split_at(above.as_flattened().len());
        let indices = indices.as_chunks::<UNROLLED>().0;
        for ((above, below), indices) in above.iter_mut().zip(below).zip(indices) {
            look_up(indices, above, below);
        }
        look_up(rest, rest_above, rest_below);
    });
}

/// Passes each of `blocks` to `draw` with the indices of its texels. A block comes with its number
/// of pixels. The loop that computes the indices reads no texel, so the compiler vectorizes it.
#[inline]
fn for_each_block<B>(
    level: MipLevelByShifts<'_>,
    mut places: TexelPlaces,
    blocks: impl Iterator<Item = (usize, B)>,
    mut draw: impl FnMut(&[u32], B),
) {
    let mut indices = [0; AT_ONCE];
    for (count, block) in blocks {
        // A few surplus indices take less time than a remainder that is computed one by one.
        let indices = &mut indices[..count.next_multiple_of(LANES)];
        for (index, (x, y)) in indices.iter_mut().zip(places.clone()) {
            *index = level.index(x, y);
        }
        draw(indices, block);
        places.skip_pixels(AT_ONCE as u64);
    }
}

/// The most pixels that are drawn at once.
const AT_ONCE: usize = 64;
/// A multiple of the number of indices that a processor computes at once.
const LANES: usize = 4;
const UNROLLED: usize = 8;

/// The inputs for sampling the paints of a span.
#[derive(Clone, Copy)]
pub(crate) struct Sampler<'a> {
    pub(crate) scene: FrameContext<'a>,
    pub(crate) mapping: &'a SpanMapping,
    /// The number of repeats of the paints in a cell.
    pub(crate) per_cell: f64,
}

/// A paint at one distance.
pub(crate) enum Sample<'a> {
    Color(Rgb),
    Level(&'a MipLevel),
}

/// The number of texels that a piece of a pattern counts as. A pixel that covers half a piece then
/// covers two texels, at which the first mip level begins, and shows the mean of both paints.
const PIECES_IN_A_PIXEL: f64 = 4.0;

impl<'a> Sampler<'a> {
    /// Whether the pieces of a pattern are too small to be distinguished.
    fn is_blurred(self) -> bool {
        self.lod(PIECES_IN_A_PIXEL) > 0
    }

    /// The mean colour of `paint`, as at infinite distance.
    fn mean(self, paint: Paint) -> Rgb {
        match paint {
            Paint::Color(color) => color,
            Paint::Texture(id) => self.scene.world.texture(id).level(usize::MAX).at_fraction(0, 0),
        }
    }

    /// The sample of `paint` at the distance of the span.
    fn sample(self, paint: Paint) -> Sample<'a> {
        match paint {
            Paint::Color(color) => Sample::Color(color),
            Paint::Texture(id) => {
                let texture = self.scene.world.texture(id);
                Sample::Level(texture.level(self.lod_of(texture)))
            }
        }
    }

    /// The level of detail of `texture`, which fills one repeat.
    #[inline]
    pub(crate) fn lod_of(self, texture: &Texture) -> usize {
        self.lod(texture.area())
    }

    /// The level of detail of a pattern whose pieces count as `texels` texels each.
    #[inline]
    fn lod(self, texels: f64) -> usize {
        let area = self.mapping.pixel_area * self.per_cell * self.per_cell;
        self.scene.plan.filter.lod(area * texels)
    }
}
