//! Spans of floor and ceiling: inner loops for each kind of pattern and lighting.

use super::pieces;
use super::sampling::Sampling;
use super::target::Target;
use super::texel_runs::TexelRuns;
use crate::color::Rgb;
use crate::color::srgb::mean_of_two;
use crate::visibility::{Faded, FullyLit, Lighting, PlaneSpan, Scene, SpanMapping, TexelPlaces};
use crate::world::texture::{MipLevel, MipLevelByShifts};
use crate::world::{Paint, Pattern, Texture};

/// Draws `span`.
pub(crate) fn draw<M: Sampling>(scene: Scene<'_>, span: &PlaneSpan<'_>, target: &mut Target<'_>) {
    match Faded::of_plane(span.light, scene.world.fog(), span.mapping.distance) {
        None => draw_lit::<M, _>(scene, span, FullyLit, target),
        Some(faded) => draw_lit::<M, _>(scene, span, faded, target),
    }
}

fn draw_lit<M: Sampling, L: Lighting>(
    scene: Scene<'_>,
    span: &PlaneSpan<'_>,
    lighting: L,
    target: &mut Target<'_>,
) {
    let &PlaneSpan { pass, row, ref columns, covering, mapping, .. } = span;
    let x = columns.start;
    let per_cell = 1.0 / covering.scale.cells();
    let sampler = Sampler { scene, mapping, per_cell };
    let count = columns.len();
    match covering.pattern {
        Pattern::Checker(paints) | Pattern::Stripes(paints) if sampler.is_blurred() => {
            let [one, other] = paints.map(|paint| sampler.mean(paint));
            let color = lighting.apply(mean_of_two(one, other));
            target.span_mut(pass, row, columns.clone()).fill(color);
        }
        Pattern::Plain(paint) => match sampler.sample::<M>(paint) {
            Sample::Color(color) => {
                target.span_mut(pass, row, columns.clone()).fill(lighting.apply(color));
            }
            Sample::Level(level) => {
                target.count_texels(pass, count);
                let places = mapping.places(x, per_cell);
                let pixels = target.span_mut(pass, row, columns.clone());
                draw_level(level, lighting, places, pixels);
            }
        },
        Pattern::Checker(paints) => {
            let samples = paints.map(|it| sampler.sample::<M>(it));
            pieces::draw::<true, _>(span, &samples, lighting, target);
        }
        Pattern::Stripes(paints) => {
            let samples = paints.map(|it| sampler.sample::<M>(it));
            pieces::draw::<false, _>(span, &samples, lighting, target);
        }
    }
}

/// Draws `level` on `pixels`.
pub(crate) fn draw_level<L: Lighting>(
    level: &MipLevel,
    lighting: L,
    places: TexelPlaces,
    pixels: &mut [Rgb],
) {
    match level.by_shifts() {
        Some(level) => match TexelRuns::of(level, &places, pixels.len()) {
            Some(runs) => runs.draw(level, lighting, pixels),
            None => draw_by_shifts(level, lighting, places, pixels),
        },
        None => {
            for (pixel, (x, y)) in pixels.iter_mut().zip(places) {
                *pixel = lighting.apply(level.at_fraction(x, y));
            }
        }
    }
}

/// Draws `level` on `pixels`. For the usual numbers of texels, no lookup needs a bounds check.
fn draw_by_shifts<L: Lighting>(
    level: MipLevelByShifts<'_>,
    lighting: L,
    places: TexelPlaces,
    pixels: &mut [Rgb],
) {
    match level.texels().len() {
        16384 => draw_texels::<_, 16384>(level, lighting, places, pixels),
        4096 => draw_texels::<_, 4096>(level, lighting, places, pixels),
        1024 => draw_texels::<_, 1024>(level, lighting, places, pixels),
        256 => draw_texels::<_, 256>(level, lighting, places, pixels),
        64 => draw_texels::<_, 64>(level, lighting, places, pixels),
        16 => draw_texels::<_, 16>(level, lighting, places, pixels),
        _ => {
            for (pixel, (x, y)) in pixels.iter_mut().zip(places) {
                *pixel = lighting.apply(level.at_index(level.index(x, y)));
            }
        }
    }
}

/// Draws `level`, which has `N` texels, on `pixels`.
fn draw_texels<L: Lighting, const N: usize>(
    level: MipLevelByShifts<'_>,
    lighting: L,
    places: TexelPlaces,
    pixels: &mut [Rgb],
) {
    let Some(texels) = level.texels().first_chunk::<N>() else { return };
    let blocks = pixels.chunks_mut(AT_ONCE).map(|pixels| (pixels.len(), pixels));
    for_each_block(level, places, blocks, |indices, pixels| {
        // A compiler does not unroll the loop by itself.
        let (pixels, rest) = pixels.as_chunks_mut::<UNROLLED>();
        let (indices, rest_of_indices) = indices.split_at(pixels.as_flattened().len());
        for (pixels, indices) in pixels.iter_mut().zip(indices.as_chunks::<UNROLLED>().0) {
            for (pixel, &index) in pixels.iter_mut().zip(indices) {
                *pixel = lighting.apply(texels[index as usize % N]);
            }
        }
        for (pixel, &index) in rest.iter_mut().zip(rest_of_indices) {
            *pixel = lighting.apply(texels[index as usize % N]);
        }
    });
}

/// Passes each of `blocks`, of this number of pixels, to `draw` with the indices of its texels. They
/// are computed in a loop that reads no texel, so that a compiler vectorizes it.
#[inline]
pub(crate) fn for_each_block<B>(
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
pub(crate) const AT_ONCE: usize = 64;
/// A multiple of the number of indices that a processor computes at once.
const LANES: usize = 4;
pub(crate) const UNROLLED: usize = 8;

/// The inputs for sampling the paints of a span.
#[derive(Clone, Copy)]
pub(crate) struct Sampler<'a> {
    pub(crate) scene: Scene<'a>,
    pub(crate) mapping: &'a SpanMapping,
    /// The number of repeats of the paints in a cell.
    pub(crate) per_cell: f64,
}

/// A paint at one distance.
pub(crate) enum Sample<'a> {
    Color(Rgb),
    Level(&'a MipLevel),
}

/// A pixel that covers half a piece of a pattern shows the mean of both paints. The number of
/// pieces in a pixel, times this constant, is then the number of texels from which on a texture is
/// halved.
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
    fn sample<M: Sampling>(self, paint: Paint) -> Sample<'a> {
        match paint {
            Paint::Color(color) => Sample::Color(color),
            Paint::Texture(id) => {
                let texture = self.scene.world.texture(id);
                Sample::Level(M::level_on_plane(texture, self.lod_of::<M>(texture)))
            }
        }
    }

    /// The level of detail of `texture`, which is a repeat.
    #[inline]
    pub(crate) fn lod_of<M: Sampling>(self, texture: &Texture) -> M::Lod {
        M::lod_on_plane(self.scene, texture, self.mapping, self.per_cell)
    }

    /// The level of detail of a pattern with `texels` texels in a repeat.
    #[inline]
    fn lod(self, texels: f64) -> usize {
        let area = self.mapping.pixel_area * self.per_cell * self.per_cell;
        self.scene.plan.filter.lod(area * texels)
    }
}
